/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Regions that separate, or have friction, where other faces are near: plates that are thinner than the reach of nodes,
// and the edges of tools. There a node can be nearer to another face than to the one that the material touches.
// The masses of the nodes on a line show where the material is: nodes behind the face that it touches
// get less. When nodes inside acted along the normal of their nearest face, a narrow punch had 10 to 80 % of its force,
// and a block fell through a plate thinner than a spacing.

#include "walls/fix_mpm_boundary.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_field.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 50;    // steps of this fix between checks

static double mass(Grid &grid, int64_t node)
{
  return node < 0 ? 0.0 : grid.record(node)[3];
}

/* ----------------------------------------------------------------------
   In front of a plane, a node at the distance x from the surface has the mass that its function has over x' > -x.
   If it has more mass than with a surface that is INTO deeper in the wall, then there is material at another face.

   The functions are quadratic ones for all shapes. With linear and cubic ones, too, this holds for all material in front of
   a plane, wherever it is between nodes, and for none behind a plate of .3 to 3 spacings: the shift by INTO is enough for
   their differences.
------------------------------------------------------------------------- */

bool FixMPMBoundary::is_in_front(Grid &grid, const Crossing &c)
{
  constexpr double INTO = 0.3, LITTLE = 1.0e-3;    // in node spacings; share of the mass
  const auto share = [](double x) {
    const double s = std::fabs(x), y = 1.5 - std::min(s, 1.5);
    const double less = s < 0.5 ? 0.5 - 0.75 * s + s * s * s / 3.0 : y * y * y / 6.0;
    return x < 0.0 ? less : 1.0 - less;
  };
  double full = 0.0;
  const double step = std::fabs(c.normal[c.axis]);
  for (int k = c.inside; k < c.n; k++)
    full = std::max(full, mass(grid, c.node[k]) / share(k * step - c.depth + INTO));
  for (int k = 0; k < c.inside; k++)
    if (mass(grid, c.node[k]) > full * (share(k * step - c.depth + INTO) + LITTLE)) return false;
  return full > 0.0;
}

/** Is the mass of nodes in front at most this share of that of nodes behind? */
bool FixMPMBoundary::is_behind(Grid &grid, const Crossing &c, double share)
{
  double in_front = 0.0, behind = 0.0;
  for (int k = 0; k < c.n; k++) {
    double &most = k < c.inside ? behind : in_front;
    most = std::max(most, mass(grid, c.node[k]));
  }
  return in_front <= share * behind;
}

/** Is there material in the region, about a spacing below the surface or deeper, by the mass of the node behind the line? At
 *  most the tails of functions across an inclined line bring it mass of the material in front. */
bool FixMPMBoundary::is_inside(Grid &grid, const Crossing &c)
{
  constexpr double MUCH = 0.1;
  const double there = mass(grid, c.behind);
  if (there <= 0.0) return false;
  double most = 0.0;
  for (int k = 0; k < c.n; k++) most = std::max(most, mass(grid, c.node[k]));
  return there > MUCH * most;
}

/** Does the line act, and not the nodes inside, judged by the masses of nodes? */
bool FixMPMBoundary::holds_line(Grid &grid, const Crossing &c) const
{
  constexpr double AS_MUCH = 1.01;
  switch (c.front) {
    case Crossing::SOUND:
      return !is_inside(grid, c);
    case Crossing::THIN_PLACE:
      // nodes act in material that fills the plate
      return !is_behind(grid, c, holds_surface() ? AS_MUCH : 1.0);
    default:
      return is_in_front(grid, c) || (carrying && goes_through(grid, c));
  }
}

/** Is this a step in which the lists of moving regions have the data for check_width(), and ranks compare their findings? */
bool FixMPMBoundary::looks_at_width() const
{
  return steps % LOOK_EVERY == 1;
}

/* ----------------------------------------------------------------------
   Finds blades or wires that are narrower than the reach of nodes and have material in front of them, and plates with
   material on both sides. Each rank notes the first such place, in a step with several the first one in space
------------------------------------------------------------------------- */

void FixMPMBoundary::check_width(const FieldNodes &list)
{
  constexpr double BOTH =
      0.6;    // ratio of masses in front and behind: smaller if material is behind alone
  const auto now = (double) update->ntimestep;
  if (too_thin.knows(now)) return;
  Grid &grid = list.field->grid;
  const auto note = [&](const Crossing &c) {
    double x[3];
    grid.node_position(c.base, x);
    too_thin.take({now, (double) (&list - nodes.data()), x[0], x[1], x[2]});
  };
  // another rank may know masses of nodes that this one lacks
  const auto judges = [&](const Crossing &c) {
    return comm->nprocs == 1 || std::count(c.node, c.node + c.inside, -1) == 0;
  };
  for (const auto &c : list.looked_at)
    if (mass(grid, c.node[c.inside - 1]) > 0.0 && judges(c) && is_in_front(grid, c)) note(c);
  for (const auto &c : list.crossings)
    if (c.in_plate && judges(c) && !is_in_front(grid, c) && !is_behind(grid, c, BOTH)) note(c);
}

/* ----------------------------------------------------------------------
   Collective: one warning, with the same place for any number of ranks
------------------------------------------------------------------------- */

void FixMPMBoundary::report_width()
{
  std::array<double, 5> first;
  if (!region || !too_thin.tell(world, first)) return;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/boundary {}: its region {} is thinner than 1.5 node spacings of fix mpm {} near "
        "{:.6g} {:.6g} {:.6g}, where material is at its edge or on both sides (step {:.0f}): "
        "its force can be wrong by tens of percent or zero, and material can pass through it. "
        "Make it thicker there, or the spacing smaller; this is said only once",
        id, region_id, nodes[(std::size_t) first[1]].field->id(), first[2], first[3], first[4],
        first[0]);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Separating walls push where the surface of the material has reached them (mpm_wall_gap.cpp), and
// not as soon as nodes feel it. A disk that rolls toward nodes which hold it from a distance of 1.5
// h gets a normal force in front of its center, whose moment is larger than that of the friction:
// it does not spin.

#include "walls/mpm_contact_search.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_stencil.h"
#include "region.h"
#include "update.h"
#include "walls/mpm_line_constraint.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// gap of walls that move and hold, in node spacings, from which on there is a warning; the true gap
// is about twice as large
static constexpr double NOT_TOUCHED = 0.07;
static constexpr double FILLED = 0.4;    // share of the volume in reach of the node in front
// depth in a region [node spacings] from which on it is taken for granted that material touches a
// node
static constexpr double NOT_INSIDE = 0.01;

MPMWallGap::Sums MPMContactSearch::sums(const NodeLine &line) const
{
  MPMWallGap::Sums all;
  for (int k = 0; k < line.n; k++)
    if (line.node[k] >= 0) all.add(line.weight[k], gap.at(line.node[k]));
  return all;
}

void MPMContactSearch::find_contacts(MPMWallNodes &list, double dt, double tolerance)
{
  if (wall.region) return find_region_contacts(list, dt, tolerance);
  MPMField &field = list.field;
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);    // reach of a node
  std::vector<char> near;
  for (auto &face : list.mirrors.faces) {
    near.assign(field.grid.blocks.size(), 0);
    for (const auto &line : face.lines) line.mark_blocks(near);
    for (const auto &column : face.columns)
      if (column.node[0] >= 0) near[column.node[0] / NODES_PER_BLOCK] = 1;
    const double place = face.position(*domain);
    gap.map(field, near, true, (face.cut ? 2.0 : 1.0) * seen, [&](const double *x) {
      return face.inward * (x[face.axis] - place);
    });
    for (auto &line : face.lines) line.touched = sums(line).touches(face.contact, tolerance);
    for (auto &column : face.columns)
      column.touched =
          column.node[0] >= 0 && gap.at(column.node[0]).touches(face.contact, tolerance);
  }
}

/** Maps mean distances of the material from the region to the nodes of lines and single nodes.
 *  Collective. */
void MPMContactSearch::map_region(MPMWallNodes &list, double dt)
{
  MPMField &field = list.field;
  // half width of a function: along the axis it is the reach from the surface to a node, and along
  // all axes the distance is at most sqrt(6) times as large
  const double seen = 0.5 * (stencil_order(field.options.shape) + 1);
  std::vector<char> near(field.grid.blocks.size(), 0);
  for (const auto &node : list.nodes) near[node.node / NODES_PER_BLOCK] = 1;
  list.crossings.mark_blocks(near);
  if (!wall.region_moves()) wall.region->prematch();
  gap.map(field, near, wall.region->nregion == 1, 2.45 * seen,
          wall.distance_from_region(field, dt));
}

/** Lines of a region that moves and holds act as soon as nodes on both sides of the surface see
 *  material, which can be half a node spacing in front. Notes the first such place for a warning.
 *  Collective. */
void MPMContactSearch::check_gaps(MPMWallNodes &list, double dt)
{
  if (first_gap.is_reported()) return;
  map_region(list, dt);
  Grid &grid = list.field.grid;
  const auto now = (double) update->ntimestep;
  const double h = list.field.lattice.h;
  for (const auto &crossing : list.crossings.lines) {
    MPMLineConstraint constraint;
    if (!crossing.is_in_front(grid) || crossing.goes_through(grid) ||
        !constraint.find(wall, list.field, crossing, 1))
      continue;
    // next to a side of the body, lines see corners that need not be held
    const int64_t ahead = crossing.node[crossing.n - 1];
    if (ahead < 0 || gap.at(ahead).volume < FILLED * std::pow(h, list.field.lattice.dim)) continue;
    const double beyond = sums(crossing).beyond(list.crossings.contact(crossing.contact));
    if (!(beyond > NOT_TOUCHED) || !std::isfinite(beyond)) continue;
    double x[3];
    grid.node_position(crossing.base, x);
    x[crossing.axis] = crossing.surface;
    first_gap.take({now, -beyond, x[0], x[1], x[2]});
  }
  std::array<double, 5> first;
  if (!first_gap.report(world, first) || comm->me) return;
  error->warning(
      FLERR,
      "Fix mpm/boundary {}: its region {} holds material near {:.6g} {:.6g} {:.6g} across "
      "a gap from step {:.0f} on, as nodes on both sides see it: with {} forces begin "
      "before the material is touched. Use separate, or start with the region at the "
      "surface of the material; this is said only once",
      wall.id, wall.region_id, first[2], first[3], first[4], first[0],
      wall.kind == MPMWall::STICK ? "stick" : "slip");
}

void MPMContactSearch::find_region_contacts(MPMWallNodes &list, double dt, double tolerance)
{
  const double h = list.field.lattice.h;
  map_region(list, dt);
  for (auto &node : list.nodes) {
    const double depth = -node.distance / h;
    // deep inside, or where the distance is not known
    node.touched = depth > MPMWall::DEEPEST || !(depth > -NOT_INSIDE) ||
        gap.at(node.node).touches(list.crossings.contact_at_depth(depth), tolerance);
  }
  for (auto &line : list.crossings.lines)
    line.touched = sums(line).touches(list.crossings.contact(line.contact), tolerance);
}

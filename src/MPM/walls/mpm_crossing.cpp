/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Regions that separate, or have friction, where other faces are near: plates that are thinner than
// the reach of nodes, and the edges of tools. There a node can be nearer to another face than to
// the one that the material touches. The masses of the nodes on a line show where the material is:
// nodes behind the face that it touches get less. When nodes inside acted along the normal of their
// nearest face, a narrow punch had 10 to 80 % of its force, and a block fell through a plate
// thinner than a spacing.

#include "walls/mpm_crossing.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static double mass(Grid &grid, int64_t node)
{
  return node < 0 ? 0.0 : grid.record(node)[3];
}

/** In front of a plane, a node at the distance x from the surface has the mass that its function
 *  has over x' > -x. If it has more mass than with a surface that is INTO deeper in the wall, then
 *  there is material at another face.
 *
 *  The functions are quadratic ones for all shapes. With linear and cubic ones, too, this holds for
 *  all material in front of a plane, wherever it is between nodes, and for none behind a plate of
 *  .3 to 3 spacings: the shift by INTO is enough for their differences. */
bool MPMCrossing::is_in_front(Grid &grid) const
{
  constexpr double INTO = 0.3, LITTLE = 1.0e-3;    // in node spacings; share of the mass
  const auto share = [](double x) {
    const double s = std::fabs(x), y = 1.5 - std::min(s, 1.5);
    const double less = s < 0.5 ? 0.5 - 0.75 * s + s * s * s / 3.0 : y * y * y / 6.0;
    return x < 0.0 ? less : 1.0 - less;
  };
  double full = 0.0;
  const double step = std::fabs(normal[axis]);
  for (int k = inside; k < n; k++)
    full = std::max(full, mass(grid, node[k]) / share(k * step - depth + INTO));
  for (int k = 0; k < inside; k++)
    if (mass(grid, node[k]) > full * (share(k * step - depth + INTO) + LITTLE)) return false;
  return full > 0.0;
}

bool MPMCrossing::is_behind(Grid &grid, double share) const
{
  double in_front = 0.0, in_region = 0.0;
  for (int k = 0; k < n; k++) {
    double &most = k < inside ? in_region : in_front;
    most = std::max(most, mass(grid, node[k]));
  }
  return in_front <= share * in_region;
}

/** At most the tails of functions across an inclined line bring the node behind the line mass of
 *  the material in front. */
bool MPMCrossing::has_material_inside(Grid &grid) const
{
  constexpr double MUCH = 0.1;
  const double there = mass(grid, behind);
  if (there <= 0.0) return false;
  double most = 0.0;
  for (int k = 0; k < n; k++) most = std::max(most, mass(grid, node[k]));
  return there > MUCH * most;
}

bool MPMCrossing::goes_through(Grid &grid) const
{
  return alone && std::all_of(node, node + n, [&](int64_t node) {
           return grid.record(node)[3] > 0.0;
         });
}

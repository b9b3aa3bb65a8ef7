/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Blocks of nodes next to those that points reach. Lines of nodes through the surface of a region can have nodes that only
   points of another rank reach. A moving region needs different blocks all the time: they are made around its place at that
   time, a bit wider, and made anew when it has moved by that margin.
------------------------------------------------------------------------- */

#include "walls/fix_mpm_boundary.h"

#include "comm.h"
#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "math_extra.h"
#include "region.h"
#include "walls/mpm_region_motion.h"
#include "walls/mpm_region_surface.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double FAR = 1.0e8;    // node spacings
static constexpr double WIDER = 2.0;    // node spacings, around a region that moves

/** Is the place of the region known, so that blocks far from it can be left out? */
bool FixMPMBoundary::knows_place() const
{
  return region->nregion == 1 && (placed || !region_moves());
}

/** Upper bound of the distance that parts of the region in the box have moved since the state then. */
double FixMPMBoundary::way_since(const double *then) const
{
  double shift[3], way = 0.0;
  MathExtra::sub3(past.region, then, shift);
  if (region->rotateflag) {
    const double *const point = MPMRegionMotion::point_of(region);
    double farthest[3];
    for (int d = 0; d < 3; d++)
      farthest[d] =
          std::max(std::fabs(domain->boxlo[d] - point[d]), std::fabs(domain->boxhi[d] - point[d])) +
          std::max(std::fabs(past.region[d]), std::fabs(then[d]));
    way = std::fabs(past.region[3] - then[3]) * MathExtra::len3(farthest);
  }
  return way + MathExtra::len3(shift);
}

void FixMPMBoundary::couple_topology()
{
  if (!region || comm->nprocs == 1 || !placed || !region_moves() || region->nregion != 1 ||
      !acts_across())
    return;
  for (auto &list : nodes)
    if (!list.around.known || !(way_since(list.around.at) <= WIDER * list.field->lattice.h))
      list.field->map->valid = false;
}

/* ----------------------------------------------------------------------
   Lines along several axes share nodes, so blocks all around are needed
------------------------------------------------------------------------- */

void FixMPMBoundary::extend_across(MPMField &field)
{
  if (comm->nprocs == 1 || !acts_across()) return;
  const bool moves = region_moves(), known = knows_place();
  Grid &grid = field.grid;
  const int dim = field.lattice.dim;
  const double h = field.lattice.h,
               reach = (0.5 * grid.side * sqrt((double) dim) + 4.0 + (moves ? WIDER : 0.0)) * h;
  if (!moves) region->prematch();
  if (moves && known) {
    // other users may have evaluated the region since the step before
    for (int k = 0; k < 4; k++) *MPMRegionMotion::of(region)[k] = past.region[k];
    for (auto &list : nodes)
      if (list.field == &field) {
        std::copy_n(past.region, 4, list.around.at);
        list.around.known = true;
      }
  }
  const auto is_near = [&](const int *b) {
    if (!known) return true;
    const int first[3] = {b[0] * grid.side, b[1] * grid.side, b[2] * grid.side};
    double middle[3];
    field.lattice.node_position(first, middle);
    for (int d = 0; d < dim; d++) middle[d] += 0.5 * (grid.side - 1) * h;
    return fabs(surface->distance(middle, FAR * h)) <= reach;
  };
  const auto nblocks = (int) grid.blocks.size();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    if (!is_near(b)) continue;
    const int rings = holds_surface() ? 2 : 1, flat = dim == 3 ? rings : 0;    // see list_knots()
    for (int k = -flat; k <= flat; k++)
      for (int j = -rings; j <= rings; j++)
        for (int i = -rings; i <= rings; i++) {
          const int next[3] = {b[0] + i, b[1] + j, b[2] + k};
          if (is_near(next)) grid.activate(next);
        }
  }
}

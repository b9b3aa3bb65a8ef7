/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Blocks of nodes next to those that points reach. Lines of nodes through the surface of a region
 *  can have nodes that only points of another rank reach. A moving region needs different blocks
 *  all the time: they are made around its place at that time, a bit wider, and made anew when it
 *  has moved by that margin. */

#include "walls/mpm_wall_nodes.h"

#include "field/mpm_field.h"
#include "region.h"
#include "walls/mpm_wall.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double WIDER = 2.0;    // node spacings, around a region that moves

void MPMWallNodes::extend_topology()
{
  mirrors.find_faces();
  const bool several_ranks = wall.has_several_ranks();
  if (several_ranks && (wall.looks_ahead || wall.moves_and_holds)) extend_to_approaches();
  if (!wall.region)
    mirrors.extend_topology();
  else if (several_ranks)
    crossings.extend_topology();
}

bool MPMWallNodes::needs(const Grid::Block &block) const
{
  return wall.region || mirrors.needs(block, wall.looks_ahead ? SOUGHT : 0);
}

bool MPMCrossingLines::needs_topology() const
{
  return !blocks_known || !(wall.way_since(blocks_at) <= WIDER * field.lattice.h);
}

/** Lines along several axes share nodes, so blocks all around are needed. */
void MPMCrossingLines::extend_topology()
{
  if (!wall.acts_across()) return;
  const bool moves = wall.region_moves(), known = wall.knows_place();
  Grid &grid = field.grid;
  const int dim = field.lattice.dim;
  const double h = field.lattice.h,
               reach = (0.5 * grid.side * sqrt((double) dim) + 4.0 + (moves ? WIDER : 0.0)) * h;
  if (!moves) wall.region->prematch();
  if (moves && known) {
    wall.restore_region();
    std::copy_n(wall.state.region, 4, blocks_at);
    blocks_known = true;
  }
  const auto is_near = [&](const int *b) {
    if (!known) return true;
    const int first[3] = {b[0] * grid.side, b[1] * grid.side, b[2] * grid.side};
    double middle[3];
    field.lattice.node_position(first, middle);
    for (int d = 0; d < dim; d++) middle[d] += 0.5 * (grid.side - 1) * h;
    return fabs(wall.surface->distance(middle, MPMWall::FAR * h)) <= reach;
  };
  const auto nblocks = (int) grid.blocks.size();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    if (!is_near(b)) continue;
    const int rings = wall.holds_surface() ? 2 : 1,
              flat = dim == 3 ? rings : 0;    // see MPMCoupledLines
    for (int k = -flat; k <= flat; k++)
      for (int j = -rings; j <= rings; j++)
        for (int i = -rings; i <= rings; i++) {
          const int next[3] = {b[0] + i, b[1] + j, b[2] + k};
          if (is_near(next)) grid.activate(next);
        }
  }
}

/** Ranks that have a node of a line need all nodes between it and the wall, and the next ones
 *  behind it. */
void MPMWallNodes::extend_to_approaches()
{
  Region *const region = wall.region;
  Grid &grid = field.grid;
  const int dim = field.lattice.dim, nblocks = (int) grid.blocks.size(),
            reach = (SOUGHT + grid.side - 1) / grid.side;
  const double h = field.lattice.h;
  const bool known = region && !wall.region_moves() && region->nregion == 1;
  if (known) region->prematch();
  for (int ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    for (const auto &face : mirrors.faces)
      for (int k = -reach; k <= reach; k++) {
        int next[3] = {b[0], b[1], b[2]};
        next[face.axis] += k;
        const auto away = [&](int block) {
          const int first = block * grid.side - face.plane;
          return face.inward > 0 ? first : -first - grid.side + 1;    // of the nearest node
        };
        if (away(b[face.axis]) <= SOUGHT && away(next[face.axis]) <= SOUGHT &&
            away(next[face.axis]) > -2 * grid.side)
          grid.activate(next);
      }
    if (!region) continue;
    double middle[3];
    const int first[3] = {b[0] * grid.side, b[1] * grid.side, b[2] * grid.side};
    field.lattice.node_position(first, middle);
    for (int d = 0; d < dim; d++) middle[d] += 0.5 * (grid.side - 1) * h;
    if (known &&
        std::fabs(wall.surface->distance(middle, MPMWall::FAR * h)) >
            (0.5 * grid.side * std::sqrt((double) dim) + SOUGHT) * h)
      continue;
    const int width = 2 * reach + 1;
    for (int k = 0; k < (dim == 3 ? width * width * width : width * width); k++) {
      const int next[3] = {b[0] + k % width - reach, b[1] + k / width % width - reach,
                           dim == 3 ? b[2] + k / (width * width) - reach : b[2]};
      grid.activate(next);
    }
  }
}

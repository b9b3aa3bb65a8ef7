/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_reach.h"

#include <algorithm>
#include <climits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

std::array<int, 3> LAMMPS_NS::canonical_block(const Grid &grid, const Grid::Block &block,
                                              int corner)
{
  std::array<int, 3> b = {block.b[0], block.b[1], block.b[2]};
  for (int d = 0; d < grid.lattice.dim; d++) {
    const int node = b[d] * grid.side + (corner >> d & 1 ? grid.side - 1 : 0);
    b[d] = grid.lattice.wrap(d, node) >> grid.shift_bits;
  }
  return b;
}

void MPMReach::find(const Grid &grid, MPI_Comm world)
{
  blocks.clear();
  int range[6];    // low, and minus high
  std::fill_n(range, 6, INT_MAX);
  for (const auto &block : grid.blocks)    // an image belongs to one or two on each axis
    for (int corner = 0; corner < 8; corner++)
      blocks.push_back(canonical_block(grid, block, corner));
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (const auto &b : blocks)
    for (int d = 0; d < 3; d++) {
      range[d] = std::min(range[d], b[d]);
      range[3 + d] = std::min(range[3 + d], -b[d]);
    }
  MPI_Allreduce(range, extent, 6, MPI_INT, MPI_MIN, world);
}

void MPMReach::activate_those_of(const MPMReach &other, Grid &grid) const
{
  for (const auto &b : other.blocks) {
    bool inside = true;
    for (int d = 0; d < 3; d++) inside = inside && b[d] >= extent[d] && b[d] <= -extent[3 + d];
    if (inside) grid.activate(b.data());
  }
}

bool MPMReach::may_meet(const MPMReach &other) const
{
  bool meets = true;
  for (int d = 0; d < 3; d++)
    meets = meets && extent[d] <= -other.extent[3 + d] && other.extent[d] <= -extent[3 + d];
  return meets;
}

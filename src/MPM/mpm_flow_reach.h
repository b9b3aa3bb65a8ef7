/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_REACH_H
#define LMP_MPM_FLOW_REACH_H

#include "lattice/grid.h"

namespace LAMMPS_NS {

/** Numbers of the cells with indices base + 0, 1, 2 that a place reaches. */
template <int dim> struct MPMFlowReach {
  const int *slots;
  int block[3][3], inside[3][3];

  void find(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &of, const int base[3])
  {
    slots = of.slot;
    for (int d = 0; d < 3; d++) {
      const int stride = d == 0 ? 9 : (d == 1 ? 3 : 1);
      if (d >= dim) {
        block[d][0] = stride;
        inside[d][0] = 0;
        continue;
      }
      const int step = d == dim - 1 ? 1 : (d == dim - 2 ? grid.side : grid.side * grid.side);
      for (int k = 0; k < 3; k++) {
        const int index = base[d] + k;
        block[d][k] = stride * ((index >> grid.shift_bits) - of.b[d] + 1);
        inside[d][k] = step * (index & (grid.side - 1));
      }
    }
  }
  int64_t number(const int k[3]) const
  {
    const int slot = slots[block[0][k[0]] + block[1][k[1]] + block[2][k[2]]];
    return (int64_t) slot * MPM_NS::NODES_PER_BLOCK + inside[0][k[0]] + inside[1][k[1]] +
        inside[2][k[2]];
  }
};

/** Calls f(number, k) for all cells with index base + k of which the middle or a lower face is reached. These are the cells
 *  with k = 2 along at most one axis. */
template <int dim, class F> void visit(const MPMFlowReach<dim> &reach, const F &f)
{
  int k[3] = {0, 0, 0};
  for (k[0] = 0; k[0] < 3; k[0]++)
    for (k[1] = 0; k[1] < (k[0] == 2 ? 2 : 3); k[1]++) {
      const int n = dim == 2 ? 1 : (k[0] == 2 || k[1] == 2 ? 2 : 3);
      for (k[2] = 0; k[2] < n; k[2]++) f(reach.number(k), k);
    }
}

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_node_system.h"

#include "comm.h"
#include "lammps.h"

using namespace LAMMPS_NS;

void LAMMPS_NS::add_products(const MPM_NS::Grid &grid, int width, int n, const double *const *a,
                             const double *const *b, int64_t offset, double *sums)
{
  const int64_t reals = (int64_t) MPM_NS::NODES_PER_BLOCK * width;
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const uint64_t owned = grid.blocks[slot].owned;
    if (owned == 0) continue;
    for (int k = 0; k < n; k++) {
      const double *const p = a[k] + offset + slot * reals, *const q = b[k] + offset + slot * reals;
      double sum = 0.0;
      if (owned == ~(uint64_t) 0)
        for (int64_t i = 0; i < reals; i++) sum += p[i] * q[i];
      else
        for (int node = 0; node < MPM_NS::NODES_PER_BLOCK; node++)
          if (owned >> node & 1)
            for (int i = node * width; i < (node + 1) * width; i++) sum += p[i] * q[i];
      sums[k] += sum;
    }
  }
}

void LAMMPS_NS::sum_in_order(LAMMPS *lmp, int n, const double *mine, std::vector<double> &room,
                             double *value)
{
  const int nprocs = lmp->comm->nprocs;
  room.resize((std::size_t) n * nprocs);
  MPI_Allgather(mine, n, MPI_DOUBLE, room.data(), n, MPI_DOUBLE, lmp->world);
  for (int k = 0; k < n; k++) {
    value[k] = 0.0;
    for (int rank = 0; rank < nprocs; rank++) value[k] += room[(std::size_t) rank * n + k];
  }
}

void MPMNodeSystem::products(int n, const double *const *a, const double *const *b, double *value)
{
  mine.assign(n, 0.0);
  add_products(grid, width, n, a, b, 0, mine.data());
  sum_in_order(lmp, n, mine.data(), sums_of_ranks, value);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_node_system.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_halo.h"
#include "lammps.h"

#include <climits>
#include <numeric>

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

int MPMLatticeRanks::number() const
{
  return lmp->comm->nprocs;
}

int MPMLatticeRanks::me() const
{
  return lmp->comm->me;
}

void MPMLatticeRanks::sum(double *values, int width)
{
  grid.fold_aliases(values, width, 0, width);
  halo.sum(values, width, 0, width);
  grid.copy_aliases(values, width);
}

const std::vector<char> &MPMLatticeRanks::gather_bytes(const void *mine, std::size_t bytes)
{
  const int nprocs = lmp->comm->nprocs;
  const bigint mine_bytes = bytes;
  bytes_of_ranks.resize(nprocs);
  MPI_Allgather(&mine_bytes, 1, MPI_LMP_BIGINT, bytes_of_ranks.data(), 1, MPI_LMP_BIGINT,
                lmp->world);
  if (std::accumulate(bytes_of_ranks.begin(), bytes_of_ranks.end(), bigint(0)) > INT_MAX)
    lmp->error->all(FLERR,
                    "Solve on the lattice is too large for its coarse levels, which all ranks "
                    "have: use a larger node spacing");
  counts.assign(bytes_of_ranks.begin(), bytes_of_ranks.end());
  return gather_counts(mine);
}

const std::vector<char> &MPMLatticeRanks::gather_sizes(const void *mine,
                                                       const std::vector<int> &sizes)
{
  counts = sizes;
  return gather_counts(mine);
}

const std::vector<char> &MPMLatticeRanks::gather_counts(const void *mine)
{
  const int nprocs = lmp->comm->nprocs;
  first.resize(nprocs + 1);
  for (int p = 0; p < nprocs; p++) first[p + 1] = first[p] + counts[p];
  all.resize(first[nprocs]);
  MPI_Allgatherv(mine, counts[lmp->comm->me], MPI_BYTE, all.data(), counts.data(), first.data(),
                 MPI_BYTE, lmp->world);
  return all;
}

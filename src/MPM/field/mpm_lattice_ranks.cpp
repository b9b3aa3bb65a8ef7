/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_lattice_ranks.h"

#include "comm.h"
#include "error.h"
#include "field/mpm_halo.h"
#include "lammps.h"

#include <climits>
#include <numeric>

using namespace LAMMPS_NS;

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
    lmp->error->all(
        FLERR,
        "Solve on the lattice is too large for its coarse levels, which all ranks have: use a "
        "larger node spacing");
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

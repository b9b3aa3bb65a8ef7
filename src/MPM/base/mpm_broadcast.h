/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BROADCAST_H
#define LMP_MPM_BROADCAST_H

// Data of plain types that ranks send to all others.

#include "lmptype.h"

#include <algorithm>
#include <mpi.h>
#include <numeric>
#include <vector>

namespace LAMMPS_NS {

/** Sends a vector or string of plain data of rank 0 to all ranks, in pieces, as its length may be
 *  more than an int. Collective. */
template <class Data> void broadcast(Data &data, MPI_Comm world)
{
  constexpr std::size_t SIZE = sizeof(typename Data::value_type);
  constexpr bigint PIECE = (1 << 30) / SIZE;
  bigint n = data.size();
  MPI_Bcast(&n, 1, MPI_LMP_BIGINT, 0, world);
  data.resize(n);
  for (bigint k = 0; k < n; k += PIECE)
    MPI_Bcast(data.data() + k, (int) (std::min(PIECE, n - k) * SIZE), MPI_BYTE, 0, world);
}

/** Returns the plain data of all ranks, in the order of ranks. Collective. */
template <class T> std::vector<T> gather_on_all(const std::vector<T> &mine, MPI_Comm world)
{
  int nprocs;
  MPI_Comm_size(world, &nprocs);
  const int n = (int) mine.size();
  std::vector<int> counts(nprocs), starts(nprocs, 0);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  std::vector<T> all((std::size_t) starts.back() + counts.back());
  MPI_Datatype item;    // as the number of bytes may be more than an int
  MPI_Type_contiguous(sizeof(T), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Allgatherv(mine.data(), n, item, all.data(), counts.data(), starts.data(), item, world);
  MPI_Type_free(&item);
  return all;
}

}    // namespace LAMMPS_NS
#endif

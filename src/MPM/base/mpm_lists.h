/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LISTS_H
#define LMP_MPM_LISTS_H

#include "solve/bytes_of.h"

#include <mpi.h>
#include <numeric>
#include <vector>

namespace LAMMPS_NS {

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

using MPM_NS::bytes_of;    // for memory_usage()

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BROADCAST_H
#define LMP_MPM_BROADCAST_H

// Sends data that one rank has read from a file to all ranks.

#include "lmptype.h"

#include <algorithm>
#include <mpi.h>

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

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INPUT_H
#define LMP_MPM_INPUT_H

#include "lmptype.h"
#include "material/material.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <mpi.h>

// Materials and meshes that the input defines, also by files, which rank 0 reads for all.

// Sends data that one rank has read from a file to all ranks.

namespace LAMMPS_NS {
class LAMMPS;

/** Reads the material defined by the words from arg[first] to the last one: "density RHO <parts>"
 *  or "file NAME <more parts>". Errors name the word, or the file and line. caller: for messages,
 *  as "Fix mpm/material". Must be called by all ranks. */
std::unique_ptr<MPM_NS::Material> read_material(LAMMPS *, const std::string &caller, int first,
                                                int narg, char **arg);

/** Reads the elements of a body from a file (see read_mesh()) on all ranks: those of a dimension
 *  and, if part is not empty, of a physical group. Solids are numbered in the positive sense. Stops
 *  with an error of this user that points to its argument iarg. */
MPM_NS::Mesh read_body(LAMMPS *, const std::string &file, const std::string &part, int dimension,
                       const std::string &user, int iarg);

/** Reads all elements of a file, with their groups, on all ranks. Elements of the dimension of the
 *  simulation are numbered in the positive sense. Errors as for read_body(). */
MPM_NS::Mesh read_whole_mesh(LAMMPS *, const std::string &file, const std::string &user, int iarg);

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

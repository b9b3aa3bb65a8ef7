/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INPUT_H
#define LMP_MPM_INPUT_H

// Materials and meshes that the input defines, also by files, which rank 0 reads for all.

#include "material/material.h"
#include "mesh/mesh_file.h"

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

}    // namespace LAMMPS_NS
#endif

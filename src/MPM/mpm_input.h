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

/** The material that the words arg[first], ... to the last one define: "density RHO <parts>" or
 *  "file NAME <more parts>"; errors name the word, or file and line. caller: for messages, as "Fix mpm/material".
 *  To be called by all ranks. */
std::unique_ptr<MPM_NS::Material> read_material(LAMMPS *, const std::string &caller, int first,
                                                int narg, char **arg);

/** The elements of a body in a file (see read_mesh()) on all ranks: those of a dimension and, when not empty, of a physical group; solids
 *  numbered in the positive sense. Stops with an error
 *  of this user, which points to its argument. */
MPM_NS::Mesh read_body(LAMMPS *, const std::string &file, const std::string &part, int dimension,
                       const std::string &user, int iarg);

/** All elements in a file on all ranks, with their groups; those of the dimension of the simulation are numbered in the positive
 *  sense. Errors as for read_body(). */
MPM_NS::Mesh read_whole_mesh(LAMMPS *, const std::string &file, const std::string &user, int iarg);

}    // namespace LAMMPS_NS
#endif

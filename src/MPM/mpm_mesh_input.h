/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_INPUT_H
#define LMP_MPM_MESH_INPUT_H

#include "mesh/gmsh.h"
#include "pointers.h"

namespace LAMMPS_NS {

/** The elements of a body in a Gmsh file on all ranks: those of the dimension of the simulation
 *  and, when not empty, of a physical group, numbered in the positive sense. Stops with an error
 *  of this user, which points to its argument. */
MPM_NS::Mesh read_body(LAMMPS *, const std::string &file, const std::string &part,
                       const std::string &user, int iarg);

}    // namespace LAMMPS_NS
#endif

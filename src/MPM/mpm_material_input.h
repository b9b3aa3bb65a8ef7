/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MATERIAL_INPUT_H
#define LMP_MPM_MATERIAL_INPUT_H

// The definition of a material in an input script or a material file.

#include "material/material.h"

namespace LAMMPS_NS {
class LAMMPS;
}

namespace MPM_NS {

/** The material that the words arg[first], ... to the last one define: "density RHO <parts>" or
 *  "file NAME <more parts>"; errors name the word, or file and line. caller: for messages, as "Fix mpm/material".
 *  To be called by all ranks. */
std::unique_ptr<Material> read_material(LAMMPS_NS::LAMMPS *, const std::string &caller, int first,
                                        int narg, char **arg);

}    // namespace MPM_NS
#endif

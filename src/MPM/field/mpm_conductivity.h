/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONDUCTIVITY_H
#define LMP_MPM_CONDUCTIVITY_H

#include "material/material.h"

namespace LAMMPS_NS {

/** Principal conductivities k of a material at a point with the deformation gradient F [9,
 *  row-major]. The rows of n are their axes, unit vectors in space. All k are the same if the
 *  material is isotropic. */
void principal_conductivities(const MPM_NS::Conduction &, const double *F, double k[3],
                              double n[3][3]);

}    // namespace LAMMPS_NS
#endif

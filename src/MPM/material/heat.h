/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_HEAT_H
#define MPM_MATERIAL_HEAT_H

#include "material/material.h"

namespace MPM_NS {

/** Heat per mass that takes a point of a material that conducts from the temperature which it has at first to that of
 *  this history, with the heat of fusion of what has melted [energy/mass]; negative where it has cooled. */
double heat_since_start(const Material &, const double *history);

}    // namespace MPM_NS
#endif

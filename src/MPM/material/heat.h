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

/** Heat per mass that a point of a conducting material has gained since the start, from its initial
 *  temperature to the temperature in this history, including the heat of fusion of the molten part
 *  [energy/mass]; negative if the point has cooled. */
double heat_since_start(const Material &, const double *history);

/** Does any conductivity of this material depend on temperature? */
bool conductivity_varies_with_temperature(const Material &);

/** As Material::conduction(), but with the conductivities averaged over the temperatures from low
 *  to high. */
Conduction mean_conduction(const Material &, const double *history, double low, double high);

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMAGE_H
#define LMP_MPM_IMAGE_H

#include "domain.h"

#include <cmath>

namespace LAMMPS_NS {

/** Replaces a difference of positions by its shortest periodic image. Domain::minimum_image() has
 *  other arguments in older versions of LAMMPS, and handles differences of at most two boxes. */
inline void nearest_image(const Domain &domain, double *d)
{
  for (int a = 0; a < 3; a++)
    if (domain.periodicity[a]) d[a] -= domain.prd[a] * std::round(d[a] / domain.prd[a]);
}

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MLS_ROTATION_H
#define LMP_MPM_MLS_ROTATION_H

#include <vector>

namespace LAMMPS_NS {
class Fix;
class MPMField;

/** Measure of an error of statics for bodies that have turned while forces use moving least squares
 *  in the updated frame (mpm_mls_rotation.cpp): the rotation of the points of a field [rad],
 *  averaged with the equivalent stress as weight; 0 with other forces. Collective. */
double mls_rotation(const MPMField &);

/** Warns of the first field whose points have turned so far that this error is large. Returns
 *  whether there is one. Collective. */
bool warn_of_mls_rotation(const Fix &, const std::vector<MPMField *> &);

}    // namespace LAMMPS_NS
#endif

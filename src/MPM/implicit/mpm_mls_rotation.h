/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MLS_ROTATION_H
#define LMP_MPM_MLS_ROTATION_H

#include <string>

namespace LAMMPS_NS {
class MPMField;

/** Measure of an error of statics for bodies that have turned while forces use moving least squares
 *  in the updated frame (mpm_mls_rotation.cpp): the rotation of the points of a field [rad],
 *  averaged with the equivalent stress as weight; 0 with other forces. Collective. */
double mls_rotation(const MPMField &);

/** Is this rotation large enough for a warning? */
inline bool is_large_rotation(double rotation)
{
  return rotation > 0.02;
}

/** Text of the warning about it, without its beginning. field: ID of the fix mpm. */
std::string warning_of_mls_rotation(double turn, const std::string &field);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_EXTREMES_H
#define LMP_MPM_POINT_EXTREMES_H

#include <string>

namespace LAMMPS_NS {

/** Part of the summary of a run: the time step as a fraction of the largest stable one, and a line
 *  with the smallest and largest volume ratio det F and the largest speed of the points of a field,
 *  with the IDs of these points. Collective. */
std::string point_extremes(class LAMMPS *lmp, const class MPMField &field);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STRAIN_H
#define LMP_MPM_STRAIN_H

#include "field/mpm_point_map.h"
#include "transfer/kernels.h"

namespace LAMMPS_NS {
class MPMField;

/** Updates strain and stress of n <= BATCH consecutive points of a run. L: their velocity
 *  gradients. */
void update_stress(MPMField &, const MPM_NS::PointRows &, const MPMPointMap::Run &, int first,
                   int n, const double *L, double dt);
/** Gives points without any stress, from first on, the pressure of their equation of state. */
void give_initial_stress(MPMField &, int first = 0);

/** Brings all points of a field to rest, with their affine parts.
 *
 *  Transfers do not lose the kinetic energy of the points: it is taken from the ledger, and added
 *  to taken[0]. taken[1] gets minus half of the work of the forces of this step, except for the
 *  forces of elements. The stress of points follows from the whole displacement, while the work of
 *  forces is counted with the mean of the velocities before and after the step, and the next step
 *  would add the other half. [energy] */
void put_to_rest(MPMField &, double taken[2]);

}    // namespace LAMMPS_NS
#endif

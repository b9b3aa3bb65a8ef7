/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REST_H
#define LMP_MPM_REST_H

namespace LAMMPS_NS {
class MPMField;

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

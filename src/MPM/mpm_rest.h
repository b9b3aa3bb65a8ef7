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

/** All points of a field stop, with their affine parts. What they lose is not lost by transfers: it is taken from the ledger,
 *  and added to taken[0]. taken[1] gets minus half of the work of the forces of this step but for those of elements: the stress of points follows from the whole
 *  displacement, while the work of forces is counted with the mean of the velocities before and after it, of which the next step
 *  would add the other half. [energy] */
void put_to_rest(MPMField &, double taken[2]);

}    // namespace LAMMPS_NS
#endif

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
 *  and added to taken[0]; taken[1] gets minus the work of the forces of this step. That is counted with the velocities of
 *  points at the start of each step (MPMEnergyWatch), a step late, and so would not be. [energy] */
void put_to_rest(MPMField &, double taken[2]);

}    // namespace LAMMPS_NS
#endif

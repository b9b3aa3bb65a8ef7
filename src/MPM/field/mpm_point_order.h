/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_ORDER_H
#define LMP_MPM_POINT_ORDER_H

#include <vector>

namespace LAMMPS_NS {
class LAMMPS;

/** Moves the atoms of this rank into the order of their keys; atoms with equal keys are sorted by
 *  tag. Collective.
 *
 *  key: [nlocal] from 0 to nkeys - 1. Atoms with a negative key come last, in their previous order.
 *  If LAMMPS wants the atoms of a group to be first (atom_modify first), they stay first and are
 *  sorted in the same way among themselves. The vector is overwritten. */
void put_in_order(LAMMPS *, std::vector<int> &key, int nkeys);

}    // namespace LAMMPS_NS
#endif

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

/** Moves the atoms of this rank into the order of their keys, those of equal keys by tag. Collective.
 *
 *  key: [nlocal] from 0 to nkeys - 1; negative: the atom comes behind all that have one, in the order of before. A group
 *  that LAMMPS wants to be first (atom_modify first) stays so, and has the same order in itself. The vector is used up. */
void put_in_order(LAMMPS *, std::vector<int> &key, int nkeys);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTEGRATORS_H
#define LMP_MPM_INTEGRATORS_H

namespace LAMMPS_NS {

/** Stops with an error when material points of the group of a fix, which moves them, are moved by another fix, too. At the
 *  start of a run, by all ranks. */
void refuse_other_integrators(class LAMMPS *, const class Fix &mine);

}    // namespace LAMMPS_NS
#endif

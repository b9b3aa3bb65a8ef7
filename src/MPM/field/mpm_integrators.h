/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INTEGRATORS_H
#define LMP_MPM_INTEGRATORS_H

#include "lmptype.h"

#include <string>

namespace LAMMPS_NS {

/** Stops with an error if another fix, too, moves material points in the group of a fix that moves
 *  them. Called at the start of a run by all ranks. */
void refuse_other_integrators(class LAMMPS *, const class Fix &mine);

/** Warns of material points that no fix moves. A group contains the atoms that existed at the time
 *  of its command, so points that were made later are easily forgotten. style: of the fix that
 *  should move them; lack: the consequence for them. Returns the number of all points. */
bigint warn_of_forgotten_points(class LAMMPS *, const std::string &style, const std::string &lack);

}    // namespace LAMMPS_NS
#endif

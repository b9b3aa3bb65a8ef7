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

/** Stops with an error when material points of the group of a fix, which moves them, are moved by another fix, too. At the
 *  start of a run, by all ranks. */
void refuse_other_integrators(class LAMMPS *, const class Fix &mine);

/** Warns of material points that no fix moves: groups have the atoms that there were at the time of their command, and points
 *  that were made later are easily forgotten. style: of the fix that they should belong to; lack: what becomes of them.
 *  Returns the number of all points. */
bigint warn_of_forgotten_points(class LAMMPS *, const std::string &style, const std::string &lack);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GHOSTS_H
#define LMP_MPM_GHOSTS_H

#include "comm.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "neighbor.h"
#include "pair.h"

#include <algorithm>

namespace LAMMPS_NS {

/** Atoms of other ranks up to this distance are to be ghosts. To be called by init() of a fix or of
 *  a pair style, before LAMMPS sets its communication up. A cutoff of the user that is larger
 *  stays. */
inline void need_ghosts_within(LAMMPS *lmp, double distance)
{
  auto *const comm = lmp->comm;
  const auto *const neighbor = lmp->neighbor;
  if (comm->mode == Comm::SINGLE) {
    // a cutoff that is less than that of a pair style is a warning of LAMMPS
    const auto *const pair = lmp->force->pair;
    if (!pair || distance > pair->cutforce + neighbor->skin)
      comm->cutghostuser = std::max(comm->cutghostuser, distance);
    return;
  }
  // in mode multi each collection of types has a cutoff of its own
  for (int k = 0; k < neighbor->ncollections; k++) {
    const bool known = comm->cutusermulti && comm->ncollections_cutoff == neighbor->ncollections;
    if (!known || comm->cutusermulti[k] < distance)
      lmp->input->one(fmt::format("comm_modify cutoff/multi {} {:.17g}", k + 1, distance));
  }
}

}    // namespace LAMMPS_NS
#endif

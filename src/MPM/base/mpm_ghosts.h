/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_GHOSTS_H
#define LMP_MPM_GHOSTS_H

#include "atom.h"
#include "comm.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "neighbor.h"
#include "pair.h"

#include <algorithm>

namespace LAMMPS_NS {

/** Atoms of other ranks up to this distance are to be ghosts. To be called by init() of a fix, when
 *  the cutoff of the pair style is known and LAMMPS's communication is not set up yet. A cutoff of
 *  the user that is larger stays. */
inline void need_ghosts_within(LAMMPS *lmp, double distance)
{
  auto *const comm = lmp->comm;
  auto *const neighbor = lmp->neighbor;
  // a cutoff that is less than that of a pair style is a warning of LAMMPS
  const auto *const pair = lmp->force->pair;
  const bool is_largest = !pair || distance > pair->cutforce + neighbor->skin;
  // and LAMMPS takes one from the lengths of bonds only where there is none of the user
  if (!pair && comm->cutghostuser == 0.0) distance = std::max(distance, comm->get_comm_cutoff());
  if (comm->mode == Comm::SINGLE) {
    if (is_largest) comm->cutghostuser = std::max(comm->cutghostuser, distance);
    return;
  }
  // in mode multi each collection of types has a cutoff of its own; there are none yet where the
  // input has chosen the mode before it created the box, and then one for each type
  if (neighbor->ncollections == 0) neighbor->ncollections = lmp->atom->ntypes;
  const double before = comm->cutghostuser;
  for (int k = 0; k < neighbor->ncollections; k++) {
    const bool known = comm->cutusermulti && comm->ncollections_cutoff == neighbor->ncollections;
    if (!known || comm->cutusermulti[k] < distance)
      lmp->input->one(fmt::format("comm_modify cutoff/multi {} {:.17g}", k + 1, distance));
  }
  if (!is_largest) comm->cutghostuser = before;
}

}    // namespace LAMMPS_NS
#endif

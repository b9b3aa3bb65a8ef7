/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FREE_BODIES_H
#define LMP_MPM_FREE_BODIES_H

#include "solve/lattice_ranks.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMConstraints;
class MPMSolvedNodes;

/** Statics: is there a body in the first field that no wall holds along the external forces
 *  [node][dim] on it? Returns what is wrong, or nothing. Collective. */
std::string find_free_body(MPMSolvedNodes &, MPMConstraints &, MPM_NS::LatticeRanks &,
                           const std::vector<double> &external);

}    // namespace LAMMPS_NS
#endif

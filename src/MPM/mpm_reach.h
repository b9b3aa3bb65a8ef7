/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REACH_H
#define LMP_MPM_REACH_H

#include "lattice/grid.h"

#include <array>
#include <mpi.h>
#include <vector>

namespace LAMMPS_NS {

/** Blocks in reach of the points of a field, for another field on the same lattice: a rank that has points of either
 *  must know both where they may meet. */
struct MPMReach {
  std::vector<std::array<int, 3>> blocks;    ///< of this rank's points, canonical, sorted
  int extent[6];                             ///< low, and minus high, of these over all ranks

  /** Collective: when the grid has the blocks of the points, and no others yet. */
  void find(const MPM_NS::Grid &, MPI_Comm);
  /** Activate in the grid of this field the blocks of another one that are in its range. */
  void activate_those_of(const MPMReach &other, MPM_NS::Grid &) const;
  /** Do the ranges of both overlap, so that they may have blocks in common? The same on all ranks. */
  bool may_meet(const MPMReach &other) const;
};

/** The canonical block that has a corner of this block, which periodic axes repeat. */
std::array<int, 3> canonical_block(const MPM_NS::Grid &, const MPM_NS::Grid::Block &, int corner);

}    // namespace LAMMPS_NS
#endif

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

/** Blocks in reach of the points of a field, for another field on the same lattice. Where the two
 *  may meet, a rank that has points of either field must know the blocks of both. */
struct MPMReach {
  std::vector<std::array<int, 3>> blocks;    ///< canonical blocks of this rank's points, sorted
  int extent[6];    ///< range of the blocks of all ranks: lowest, and minus highest, indices

  /** Finds the blocks. Call when the grid has the blocks of the points, and no others yet.
   *  Collective. */
  void find(const MPM_NS::Grid &, MPI_Comm);
  /** Activates in the grid of this field those blocks of another field that are in the range of
   *  this field. */
  void activate_those_of(const MPMReach &other, MPM_NS::Grid &) const;
  /** Do the ranges of both fields overlap, so that they may have blocks in common? The same on all
   *  ranks. */
  bool may_meet(const MPMReach &other) const;
};

/** The canonical block that contains a corner of this block, which may be an image along periodic
 *  axes. */
std::array<int, 3> canonical_block(const MPM_NS::Grid &, const MPM_NS::Grid::Block &, int corner);

}    // namespace LAMMPS_NS
#endif

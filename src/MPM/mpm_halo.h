/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HALO_H
#define LMP_MPM_HALO_H

#include "pointers.h"

#include <vector>

namespace MPM_NS {
class Grid;
}

namespace LAMMPS_NS {

/** Sums the node records of blocks that several ranks have active.
 *
 *  Sharers are found by block key through a rendezvous, so that any rank may share with any other.
 *  Each sharer sends its partial sums once to each other sharer, and all add them in the order of
 *  ranks: all sharers hold bitwise the same sums and no second message is needed.
 */
class MPMHalo : protected Pointers {
 public:
  explicit MPMHalo(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Find the sharers of the canonical blocks of the grid, and who owns a block: the lowest rank whose
   *  points reach it, if there is one. */
  void setup(MPM_NS::Grid &);

  int nreached = 0;    ///< set by the caller: that many first blocks are in reach of points

  /** Sum reals [lane, lane+nlane) of all node records of shared blocks. */
  void sum(double *nodes, int nreal, int lane, int nlane);

  bigint bytes_sent = 0;    ///< since the last reset by the caller
  double memory_usage() const;

 private:
  struct Contribution {
    int from;      // index into ranks, -1: this rank
    int offset;    // block position in the buffer of that rank
  };
  std::vector<int> ranks;                     // other sharers, ascending
  std::vector<std::vector<int>> slots;        // [rank] blocks shared with it, in order of key
  std::vector<int> shared;                    // slots that have other sharers
  std::vector<int> first;                     // [shared+1] range in contributions
  std::vector<Contribution> contributions;    // ascending by rank within a block
  std::vector<std::vector<double>> send, recv;
  std::vector<MPI_Request> requests;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HALO_H
#define LMP_MPM_HALO_H

#include "lattice/grid.h"
#include "pointers.h"

#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Sums the records of nodes that several ranks share.
 *
 *  A rank has the nodes in reach of its points (Grid::Block::reached), or whole blocks. Sharers are
 *  found by block key through a rendezvous, so that any rank may share with any other. Each sharer
 *  sends its partial sums once to every other sharer, and all add them in the order of ranks. So
 *  all sharers hold bitwise the same sums, and no second message is needed. */
class MPMHalo : protected Pointers {
 public:
  explicit MPMHalo(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Finds the sharers of the canonical nodes of the grid, and the owner of each node: the lowest
   *  rank whose points reach it, if there is one. A rank gets values of other ranks also at nodes
   *  out of reach of its own points in blocks for which whole() is true. */
  void setup(MPM_NS::Grid &, const std::function<bool(const MPM_NS::Grid::Block &)> &whole);

  /** The same for the nodes that this rank wants, wanted [slot] as bits of each block; these must
   *  include the nodes that its points reach. A node that several ranks reach belongs to the rank
   *  that prefers() returns for its number [slot*64+n], if this rank is one of them. */
  void setup(MPM_NS::Grid &, const std::vector<uint64_t> &wanted,
             const std::function<int(int)> &prefers = nullptr);

  /** Sum reals [lane, lane+nlane) of all records of shared nodes. */
  void sum(double *nodes, int nreal, int lane, int nlane);

  /** Other ranks that share nodes with this one, in ascending order, and the shared nodes
   *  [slot*64+n]. Both ranks list the nodes in the same order. */
  int sharers() const { return (int) peers.size(); }
  int rank_of(int sharer) const { return peers[sharer].rank; }
  const std::vector<int> &shared_with(int sharer) const { return peers[sharer].nodes; }

  bigint bytes_sent = 0, messages_sent = 0;    ///< since the last reset by the caller
  double memory_usage() const;

 private:
  struct Contribution {
    int from;     // index into peers, -1: this rank
    int place;    // index of the node in the buffer of that rank
  };
  struct Peer {    // another sharer
    int rank;
    std::vector<int> nodes;     // slot*64+n of the nodes shared with it, in order of key and n
    std::vector<int> places;    // indices in nodes of those that no third rank shares
    std::vector<double> send, recv;
  };

  std::vector<Peer> peers;                    // ascending by rank
  std::vector<int> several;                   // nodes that more than two ranks share
  std::vector<int> first;                     // [several+1] range in contributions
  std::vector<Contribution> contributions;    // for each of these nodes, ascending by rank
  std::vector<MPI_Request> requests;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_SHARED_NODES_H
#define MPM_SOLVE_SHARED_NODES_H

#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"

#include <vector>

namespace MPM_NS {

/** One order of the nodes of all ranks, which stays when nodes come to other ranks. For vectors that all ranks have whole: these serve as long
 *  as the nodes are the same, whoever owns them. */
class SharedNodes {
 public:
  explicit SharedNodes(LatticeRanks &ranks) : ranks(ranks) {}

  /** A new order. mine: indices of the nodes that this rank has to do with, each owned by one rank; the first owned ones by this one.
   *  Collective. */
  void number(const std::vector<LatticeIndex> &mine, std::size_t owned);
  /** The nodes of this rank are others, and the order stays. False, on all ranks: together they are not those that there were. Then, nothing
   *  is changed. Collective. */
  bool renumber(const std::vector<LatticeIndex> &mine, std::size_t owned);
  void clear();

  /** Nodes of all ranks. */
  std::size_t size() const { return nodes.index.size(); }
  /** The index of each of them. */
  const std::vector<LatticeIndex> &indices() const { return nodes.index; }
  /** The place in the order of each node of this rank. */
  const std::vector<int> &places() const { return place; }
  /** all [size()][width]: what the ranks have of nodes that they own, [owned][width] in the order of those. The same on all ranks, bit by bit.
   *  Collective. */
  void gather(const std::vector<double> &of_owned, int width, std::vector<double> &all);

  double memory_usage() const;

 private:
  LatticeRanks &ranks;
  LatticeNodes nodes;
  std::vector<int> place;       // of nodes of this rank
  std::vector<int> of_ranks;    // of owned nodes, rank by rank
  std::vector<int> counts;      // of these, [rank]
  std::vector<int> sizes;       // the same in bytes of a message

  bool find(const std::vector<LatticeIndex> &mine, std::vector<int> &to) const;
  void take(std::vector<int> &found, std::size_t owned);
};

}    // namespace MPM_NS
#endif

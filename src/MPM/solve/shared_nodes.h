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

/** A common order of the nodes of all ranks, which remains the same when nodes move to other ranks.
 *  It is for vectors that are complete on all ranks: these remain valid as long as the set of nodes
 *  is the same, whichever ranks own them. */
class SharedNodes {
 public:
  explicit SharedNodes(LatticeRanks &ranks) : ranks(ranks) {}

  /** Makes a new order. mine: indices of all nodes that this rank uses, beginning with those that
   *  it owns, owned in number; each node is owned by one rank. Collective. */
  void number(const std::vector<LatticeIndex> &mine, std::size_t owned);
  /** Changes the nodes of this rank and keeps the order. Returns false on all ranks, and changes
   *  nothing, if the set of nodes of all ranks has changed. Collective. */
  bool renumber(const std::vector<LatticeIndex> &mine, std::size_t owned);
  void clear();

  /** Number of nodes of all ranks. */
  std::size_t size() const { return nodes.index.size(); }
  /** The index of each node, in the order. */
  const std::vector<LatticeIndex> &indices() const { return nodes.index; }
  /** The place in the order of each node of this rank. */
  const std::vector<int> &places() const { return place; }
  /** Gathers values of owned nodes, [owned][width] in the order of mine, from all ranks to all
   *  [size()][width], in the common order. The result is the same on all ranks, bit by bit.
   *  Collective. */
  void gather(const std::vector<double> &owned_values, int width, std::vector<double> &all);

  double memory_usage() const
  {
    return nodes.memory_usage() + bytes_of(place, all_places, counts, sizes);
  }

 private:
  LatticeRanks &ranks;
  LatticeNodes nodes;
  std::vector<int> place;         // places of nodes of this rank
  std::vector<int> all_places;    // places of owned nodes, rank by rank
  std::vector<int> counts;        // [rank] number of owned nodes
  std::vector<int> sizes;         // [rank] bytes of a message

  bool find(const std::vector<LatticeIndex> &mine, std::vector<int> &to) const;
  void take(std::vector<int> &found, std::size_t owned);
};

}    // namespace MPM_NS
#endif

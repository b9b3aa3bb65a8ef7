/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_LATTICE_NODES_H
#define MPM_SOLVE_LATTICE_NODES_H

#include "solve/lattice_key.h"

#include <unordered_map>
#include <vector>

namespace MPM_NS {

/** Nodes, found by their index and numbered in the order in which they were added. */
struct LatticeNodes {
  std::vector<LatticeIndex> index;
  std::unordered_map<uint64_t, int> number;

  /** Adds a node, unless it is there already; returns its number. */
  int add(const LatticeIndex &at)
  {
    const auto inserted = number.emplace(lattice_key(at), (int) index.size());
    if (inserted.second) index.push_back(at);
    return inserted.first->second;
  }
  /** The number of a node; -1: it is not there. */
  int find(const LatticeIndex &at) const
  {
    const auto found = number.find(lattice_key(at));
    return found == number.end() ? -1 : found->second;
  }
};

}    // namespace MPM_NS
#endif

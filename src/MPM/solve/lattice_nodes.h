/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_LATTICE_NODES_H
#define MPM_SOLVE_LATTICE_NODES_H

#include "solve/bytes_of.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace MPM_NS {
using LatticeIndex = std::array<int, 3>;

/** One number for the index of a node or cell, each component of which is from -2^20 to 2^20 - 1.
 *  Keys have the same order as indices. */
inline uint64_t lattice_key(const LatticeIndex &index)
{
  uint64_t key = 0;
  for (const int i : index) key = key << 21 | (uint64_t) (i + (1 << 20));
  return key;
}

/** The index of a key. */
inline LatticeIndex lattice_index(uint64_t key)
{
  LatticeIndex index;
  for (int d = 0; d < 3; d++)
    index[d] = (int) (key >> (21 * (2 - d)) & ((1 << 21) - 1)) - (1 << 20);
  return index;
}
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
  double memory_usage() const
  {
    // a node of a hash map: what it has, and a pointer in it and to it
    constexpr double HASHED = sizeof(std::pair<const uint64_t, int>) + 2 * sizeof(void *);
    return bytes_of(index) + number.size() * HASHED;
  }
};

}    // namespace MPM_NS
#endif

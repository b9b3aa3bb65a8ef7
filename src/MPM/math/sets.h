/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_SETS_H
#define MPM_MATH_SETS_H

#include <cstddef>
#include <numeric>
#include <vector>

namespace MPM_NS {

/** Disjoint sets of the items 0 ... n - 1 (union-find with path halving). */
class Sets {
 public:
  explicit Sets(std::size_t n = 0) { begin(n); }

  /** Starts with each item in a set of its own. */
  void begin(std::size_t n)
  {
    parent.resize(n);
    std::iota(parent.begin(), parent.end(), 0);
  }
  /** Merges the sets of i and j. */
  void join(int i, int j) { parent[root(i)] = root(j); }
  /** Representative item of the set of i, the same for all items of the set until the next
   *  join(). */
  int root(int i)
  {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  std::size_t size() const { return parent.size(); }

 private:
  std::vector<int> parent;
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_LATTICE_RANKS_H
#define MPM_SOLVE_LATTICE_RANKS_H

#include "lattice/grid.h"

#include <cstring>
#include <vector>

namespace MPM_NS {

/** What solves on a lattice need of other ranks, and of periodic images. */
class LatticeRanks {
 public:
  virtual ~LatticeRanks() = default;

  virtual int number() const { return 1; }
  virtual int me() const { return 0; }    ///< from 0 on

  /** values: [node][width].  At each node of the Grid: the sum of what its images, and the same node on all ranks, have.  All of
   *  them have the same sum afterwards, bit by bit.  Collective. */
  virtual void sum(double *values, int width) = 0;

  /** What ranks give, in order of ranks.  Valid until the next call.  Collective. */
  virtual const std::vector<char> &gather_bytes(const void *mine, std::size_t bytes) = 0;

  /** The same where ranks give as much as sizes [rank] tells. */
  virtual const std::vector<char> &gather_sizes(const void *mine, const std::vector<int> &sizes)
  {
    return gather_bytes(mine, sizes[me()]);
  }

  /** The same for lists of any plain type. */
  template <class T> void gather(const std::vector<T> &mine, std::vector<T> &all)
  {
    const auto &bytes = gather_bytes(mine.data(), mine.size() * sizeof(T));
    all.resize(bytes.size() / sizeof(T));
    if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
  }
  template <class T> std::vector<T> gather(const std::vector<T> &mine)
  {
    std::vector<T> all;
    gather(mine, all);
    return all;
  }
};

/** There is but one rank. */
class OneRank : public LatticeRanks {
 public:
  explicit OneRank(const Grid &grid) : grid(grid) {}
  void sum(double *values, int width) override
  {
    grid.fold_aliases(values, width, 0, width);
    grid.copy_aliases(values, width);
  }
  const std::vector<char> &gather_bytes(const void *mine, std::size_t bytes) override
  {
    const char *const first = static_cast<const char *>(mine);
    all.assign(first, first + bytes);
    return all;
  }

 private:
  const Grid &grid;
  std::vector<char> all;
};

}    // namespace MPM_NS
#endif

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

/** Communication that solves on a lattice need, with other ranks and with periodic images. */
class LatticeRanks {
 public:
  virtual ~LatticeRanks() = default;

  /** Number of ranks. */
  virtual int number() const { return 1; }
  virtual int me() const { return 0; }    ///< number of this rank, from 0 on

  /** Sums values [node][width] at each node of the Grid over its periodic images and over the ranks
   *  that have it. Afterward all of them have the same sum, bit by bit. Collective. */
  virtual void sum(double *values, int width) = 0;

  /** Concatenates the bytes of all ranks, in order of ranks. Valid until the next call.
   *  Collective. */
  virtual const std::vector<char> &gather_bytes(const void *mine, std::size_t bytes) = 0;

  /** The same if the number of bytes of each rank is known on all ranks: sizes [rank]. */
  virtual const std::vector<char> &gather_sizes(const void *mine, const std::vector<int> &sizes)
  {
    return gather_bytes(mine, sizes[me()]);
  }

  /** The same for lists of any plain type. Collective. */
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

/** The implementation for a single rank. */
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

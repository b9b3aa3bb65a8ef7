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

  /** values: [node][width].  At each node of the Grid: the sum of what its images, and the same node on all ranks, have.  All of
   *  them have the same sum afterwards, bit by bit.  Collective. */
  virtual void sum(double *values, int width) = 0;

  /** What ranks give, one after the other: begin[r] is the first byte of rank r, with the number of all at its end.  Collective. */
  virtual std::vector<char> gather_bytes(const void *mine, std::size_t bytes,
                                         std::vector<std::size_t> &begin) = 0;

  /** The same for lists of any plain type. */
  template <class T> std::vector<T> gather(const std::vector<T> &mine)
  {
    std::vector<std::size_t> begin;
    const auto bytes = gather_bytes(mine.data(), mine.size() * sizeof(T), begin);
    std::vector<T> all(bytes.size() / sizeof(T));
    if (!all.empty()) std::memcpy(all.data(), bytes.data(), bytes.size());
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
  std::vector<char> gather_bytes(const void *mine, std::size_t bytes,
                                 std::vector<std::size_t> &begin) override
  {
    begin = {0, bytes};
    const char *const first = static_cast<const char *>(mine);
    return std::vector<char>(first, first + bytes);
  }

 private:
  const Grid &grid;
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_MATRIX_BLOCK_H
#define MPM_SOLVE_MATRIX_BLOCK_H

#include <cstdint>
#include <vector>

namespace MPM_NS {

/** A block [width][width] of a matrix. */
struct MatrixBlock {
  int row, column;
  double value[9];
};

/** Each function as a weighted sum of functions of a coarser level. */
struct CoarseParts {
  struct Part {
    int node;
    double weight;
  };
  struct Range {
    const Part *from, *to;
    const Part *begin() const { return from; }
    const Part *end() const { return to; }
  };
  std::vector<int> first{0};    // [functions + 1] ranges in parts
  std::vector<Part> parts;

  /** The parts of function i. */
  Range of(int64_t i) const { return {parts.data() + first[i], parts.data() + first[i + 1]}; }
  /** Ends the parts of the current function. */
  void end_function() { first.push_back((int) parts.size()); }

  double memory_usage() const
  {
    return first.capacity() * sizeof(int) + parts.capacity() * sizeof(Part);
  }
};

}    // namespace MPM_NS
#endif

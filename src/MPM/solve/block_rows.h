/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BLOCK_ROWS_H
#define MPM_SOLVE_BLOCK_ROWS_H

#include "solve/lattice_ranks.h"

#include <Eigen/SparseCore>

#include <vector>

namespace MPM_NS {

/** A block [width][width] of a matrix. */
struct MatrixBlock {
  int row, column;
  double value[9];
};

/** What each of many functions has in it of the functions of a coarser level. */
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

  Range of(int64_t i) const { return {parts.data() + first[i], parts.data() + first[i + 1]}; }
  void end_function() { first.push_back((int) parts.size()); }

  double memory_usage() const
  {
    return first.capacity() * sizeof(int) + parts.capacity() * sizeof(Part);
  }
};

/** A symmetric matrix of blocks [width][width], of which each rank has the rows of its own: one range after the other.
 *  Vectors are whole on all ranks. */
class BlockRows {
 public:
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  /** first: [ranks + 1] rows of each rank. lower: blocks of one triangle, row >= column; those of all ranks are added.  Collective. */
  void assemble(LatticeRanks &, int width, const std::vector<int> &first,
                const std::vector<MatrixBlock> &lower);

  int rows() const { return first.empty() ? 0 : first.back(); }
  int begin() const { return first[ranks->me()]; }
  int end() const { return first[ranks->me() + 1]; }
  /** The block of a row of this rank; null: there is none. */
  const double *find(int row, int column) const;
  /** Calls f(column, value) for the blocks of a row of this rank, in ascending order. */
  template <class F> void each(int row, const F &f) const
  {
    const int64_t from = start[row - begin()], to = start[row - begin() + 1];
    for (int64_t k = from; k < to; k++) f(column[k], value.data() + k * width * width);
  }

  /** y = A x.  Collective. */
  void multiply(const double *x, double *y);
  /** mine: [rows of this rank][n].  Those of all ranks, [rows][n].  Collective. */
  std::vector<double> of_all(const std::vector<double> &mine, int n) const;
  /** Blocks of one triangle of P^T A P that rows of this rank give, where functions are these parts P of functions of the next level. */
  std::vector<MatrixBlock> coarsened(const CoarseParts &, int next) const;
  /** All of it.  Collective. */
  Sparse matrix() const;

  double memory_usage() const;

 private:
  LatticeRanks *ranks = nullptr;
  int width = 0;
  std::vector<int> first;
  std::vector<int64_t> start;    // [rows of this rank + 1]
  std::vector<int> column;
  std::vector<double> value;
  std::vector<double> product;
  std::vector<int> bytes;    // [rank] of a product

  template <int W> void multiply_rows(const double *x, double *y) const;
};

}    // namespace MPM_NS
#endif

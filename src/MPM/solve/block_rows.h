/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BLOCK_ROWS_H
#define MPM_SOLVE_BLOCK_ROWS_H

#include "solve/lattice_ranks.h"
#include "solve/node_constraints.h"

#include <Eigen/SparseCore>

#include <vector>

namespace MPM_NS {

/** A symmetric matrix of blocks [width][width]. Each rank has a range of rows, in order of ranks.
 *  Vectors are complete on all ranks. */
class BlockRows {
 public:
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  /** Builds the matrix. first: [ranks + 1], the first row of each rank. lower: blocks of one
   *  triangle, row >= column; the blocks of all ranks are added. Collective. */
  void assemble(LatticeRanks &, int width, const std::vector<int> &first,
                const std::vector<MatrixBlock> &lower);

  int rows() const { return first.empty() ? 0 : first.back(); }
  int begin() const { return first[ranks->me()]; }
  int end() const { return first[ranks->me() + 1]; }
  /** The block at a row of this rank and a column; null: there is none. */
  const double *find(int row, int column) const;
  /** Calls f(column, value) for the blocks in a row of this rank, in ascending order of columns. */
  template <class F> void each(int row, const F &f) const
  {
    const int64_t from = start[row - begin()], to = start[row - begin() + 1];
    for (int64_t k = from; k < to; k++) f(column[k], value.data() + k * width * width);
  }

  /** y = A x.  Collective. */
  void multiply(const double *x, double *y);
  /** Gathers rows of all ranks, [rows][n], from the rows of each rank, mine [rows of this rank][n].
   *  Collective. */
  std::vector<double> gather_rows(const std::vector<double> &mine, int n) const;
  /** Contribution of the rows of this rank to P^T A P, as blocks of one triangle, where P gives the
   *  parts of each function in functions of the next level. next: number of functions of that
   *  level. */
  std::vector<MatrixBlock> coarsened(const CoarseParts &, int next) const;
  /** The whole matrix. Collective. */
  Sparse matrix() const;

  double memory_usage() const { return bytes_of(first, column, bytes, start, value, product); }

 private:
  LatticeRanks *ranks = nullptr;
  int width = 0;
  std::vector<int> first;
  std::vector<int64_t> start;    // [rows of this rank + 1] ranges in column and value
  std::vector<int> column;
  std::vector<double> value;
  std::vector<double> product;
  std::vector<int> bytes;    // [rank] bytes of its part of a product

  template <int W> void multiply_rows(const double *x, double *y) const;
};

}    // namespace MPM_NS
#endif

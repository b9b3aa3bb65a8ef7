/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_ENVELOPE_H
#define MPM_SOLVE_ENVELOPE_H

#include "solve/block_kernels.h"
#include "solve/bytes_of.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace MPM_NS {

/** One triangle of a symmetric matrix in dense blocks, with each row of blocks stored from its
 *  first entry to the diagonal, and its Cholesky factors A = L L^T, which replace it.
 *
 *  The last rows may be left without factors. Then A22 is replaced by A22 - A21 A11^-1 A12 (I.
 *  Schur), which represents the effect of all preceding unknowns. */
class Envelope {
 public:
  Envelope() : kernels(BlockKernels::select()) {}

  /** Starts an empty matrix. inner, rest: number of rows of blocks with and without factors. */
  void start(int inner, int rest);
  /** Notes that a row has an entry at this column, which must not be behind the diagonal block. */
  void reach(int row, int column) { first[row / B] = std::min(first[row / B], column / B); }
  /** The number of reals needed for the entries noted by reach(). */
  int64_t count() const;
  /** The row, in unknowns, up to which half of them are needed. */
  int place_of_half() const;
  /** Makes room for all noted entries and sets them to zero. */
  void clear();
  int64_t size() const { return begin.empty() ? 0 : begin.back(); }
  /** An entry that has been noted by reach(). */
  double &at(int row, int column);
  /** Replaces the matrix by its factors. Returns false if it is not positive definite or not
   *  finite. */
  bool factorize();
  /** Rounds the factors to single precision, in half of the memory. The rounded factors represent a
   *  positive definite matrix as well. From now on only solve_forward() and solve_backward() may be
   *  called, or clear(). */
  void round();

  /** Copies the blocks of the rows without factors, [row][column up to the row], one after the
   *  other. */
  void give_rest(std::vector<double> &blocks) const;
  /** Adds a list of blocks from give_rest(), which must have as many reals as this matrix. */
  void add(const double *blocks);

  /** y1 <- L^-1 y1 for the rows with factors, and y2 <- y2 - L21 y1 for the others. */
  void solve_forward(double *y) const;
  /** y1 <- L^-T (y1 - L21^T y2) for the rows with factors, where y2 belongs to the rows without
   *  factors. */
  void solve_backward(double *y) const;
  double memory_usage() const { return bytes_of(values, rounded, begin, first); }

 private:
  static constexpr int B = FACTOR_BLOCK, BB = B * B;

  const BlockKernels kernels;
  int inner = 0;
  std::vector<int> first;        // [row of blocks] column of its first block
  std::vector<int64_t> begin;    // [row of blocks] start of that block in values
  // columns of FACTOR_BLOCK reals; a diagonal block holds the inverse of that block of L
  std::vector<double> values;
  std::vector<float> rounded;    // the same after round(); values is empty then

  int rows() const { return (int) first.size(); }
  int64_t reals_of(int row) const { return (int64_t) BB * (row - first[row] + 1); }
  /** The start of the block at the diagonal in values. */
  int64_t diagonal(int row) const { return begin[row + 1] - BB; }
  template <class Real> using Products = BlockKernels::WithVector<Real>;
  template <class Real> void forward(const Products<Real> &, const Real *of, double *y) const;
  template <class Real> void backward(const Products<Real> &, const Real *of, double *y) const;
  static bool factorize_block(double *A);
};

}    // namespace MPM_NS
#endif

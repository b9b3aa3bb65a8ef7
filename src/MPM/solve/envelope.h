/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_ENVELOPE_H
#define MPM_SOLVE_ENVELOPE_H

#include "solve/block_kernels.h"

#include <cstdint>
#include <vector>

namespace MPM_NS {

/** One triangle of a symmetric matrix in dense blocks, each row of blocks from its first entry to the diagonal, and its Cholesky
 *  factors A = L L^T in their place.
 *
 *  The last rows may be left without factors: they get A22 - A21 A11^-1 A12 (I. Schur) in the place of A22, which stands for what all
 *  unknowns before them do. */
class Envelope {
 public:
  Envelope() : kernels(BlockKernels::select()) {}

  /** inner, rest: rows of blocks with factors, and without. All of them are empty. */
  void start(int inner, int rest);
  /** There is an entry of a row at this column, which is not behind the diagonal block. */
  void reach(int row, int column);
  /** The number of reals by what has been reached. */
  int64_t count() const;
  /** The column at which half of them have come. */
  int place_of_half() const;
  /** There is room for all that has been reached, with zeros in it. */
  void clear();
  int64_t size() const { return begin.empty() ? 0 : begin.back(); }
  /** An entry, which has been reached. */
  double &at(int row, int column);
  /** False: it is not positive definite, or not finite. */
  bool factorize();

  /** The blocks of the rows without factors, [row][column up to the row], one after the other. */
  void give_rest(std::vector<double> &blocks) const;
  /** Adds such a list, which has as many reals as this one. */
  void add(const double *blocks);

  /** y <- L^-1 y: of rows with factors; of the others y <- y - L21 (that). */
  void solve_forward(double *y) const;
  /** y <- L^-T (y - L21^T y2) of rows with factors, where those without have y2. */
  void solve_backward(double *y) const;
  double memory_usage() const;

 private:
  const BlockKernels kernels;
  int inner = 0;
  std::vector<int> first;        // [row of blocks] its first block
  std::vector<int64_t> begin;    // [row of blocks] that block in values
  std::vector<double>
      values;    // columns of FACTOR_BLOCK reals; at the diagonal the inverse of that block of L

  int rows() const { return (int) first.size(); }
  int64_t reals_of(int row) const;
  const double *diagonal(int row) const;
  static bool factorize_block(double *A);
};

}    // namespace MPM_NS
#endif

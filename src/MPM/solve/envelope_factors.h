/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_ENVELOPE_FACTORS_H
#define MPM_SOLVE_ENVELOPE_FACTORS_H

#include "solve/block_kernels.h"

#include <Eigen/SparseCore>

#include <vector>

namespace MPM_NS {

/** Cholesky factors of a sparse symmetric matrix, A = L L^T.
 *
 *  Unknowns are numbered in layers from one end of a body to the other (E. Cuthill, J. McKee, Proc. 24th ACM Conf. (1969) 157), so that
 *  what a row has stands close to the diagonal, and L is kept from the first entry of a row to the diagonal, in dense blocks: more
 *  entries than with orderings that make them few, but products of blocks run at the speed of the processor.  For systems of
 *  some thousand unknowns this is ten times faster. */
class EnvelopeFactors {
 public:
  EnvelopeFactors() : kernels(BlockKernels::select()) {}

  /** The matrix, both triangles; false: it is not positive definite, or not finite, and factors are of no use. */
  bool compute(const Eigen::SparseMatrix<double> &A);
  /** The same where entries stand in the same places as in the last matrix, in an order that is known already. */
  bool compute_again(const Eigen::SparseMatrix<double> &A);
  /** x = A^-1 b, b and x: [unknowns], which may be the same. */
  void solve(const double *b, double *x);
  int size() const { return unknowns; }
  double memory_usage() const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  const BlockKernels kernels;
  int unknowns = 0;
  std::vector<int> number;       // [unknown] its place
  std::vector<int> first;        // [row of blocks] its first block
  std::vector<int64_t> start;    // [row of blocks] that block in values
  std::vector<double>
      values;    // columns of FACTOR_BLOCK reals; at the diagonal the inverse of that block of L
  std::vector<double> solution;    // of the places

  void put_in_order(const Sparse &);
  void find_envelope(const Sparse &);
  void fill(const Sparse &);
  bool factorize();
  static bool factorize_block(double *A);
};

}    // namespace MPM_NS
#endif

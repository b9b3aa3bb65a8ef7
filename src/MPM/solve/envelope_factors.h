/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_ENVELOPE_FACTORS_H
#define MPM_SOLVE_ENVELOPE_FACTORS_H

#include "solve/envelope.h"
#include "solve/lattice_ranks.h"

#include <Eigen/SparseCore>

#include <vector>

namespace MPM_NS {

/** Cholesky factors of a sparse symmetric matrix, A = L L^T.
 *
 *  Unknowns are numbered in layers from one end of a body to the other (E. Cuthill, J. McKee, Proc. 24th ACM Conf. (1969) 157), so that
 *  what a row has stands close to the diagonal, and L is kept in an envelope: more
 *  entries than with orderings that make them few, but products of blocks run at the speed of the processor.  For systems of
 *  some thousand unknowns this is ten times faster.
 *
 *  Where that is long, a layer in the middle is put last, and both halves are eliminated towards it, each from its end: as many operations, but two
 *  ranks can share them.  The order is the same on any number of ranks, and so is the result. */
class EnvelopeFactors {
 public:
  /** ranks: of which the first two have a half each; all of them call each function with the same matrix and the same vectors, and get
   *  the same.  Null: this one has both.  split: reals in the envelope from which on there are halves. */
  explicit EnvelopeFactors(LatticeRanks *ranks = nullptr, int64_t split = 500000) :
      ranks(ranks), split(split)
  {
  }

  /** The matrix, both triangles; false: it is not positive definite, or not finite, and factors are of no use. */
  bool compute(const Eigen::SparseMatrix<double> &A);
  /** The same where entries stand in the same places as in the last matrix, in an order that is known already. */
  bool compute_again(const Eigen::SparseMatrix<double> &A);
  /** x = A^-1 b, b and x: [unknowns], which may be the same. */
  void solve(const double *b, double *x);
  int size() const { return unknowns; }
  bool has_halves() const { return part[2] > part[1]; }
  double memory_usage() const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  LatticeRanks *const ranks;
  const int64_t split;
  int unknowns = 0;
  std::vector<int> number;           // [unknown] its place
  std::vector<int> queue, layer;     // unknowns in layers, and the layer of each one
  int part[3] = {0, 0, 0};           // places where each of the halves ends, and the middle
  Envelope half[2], middle;          // a half has the rows of the middle as its last ones
  std::vector<int> unused;           // places of no unknown
  std::vector<double> solution;      // of the places
  std::vector<double> of_half[2];    // with those of the middle
  std::vector<double> sent, of_ranks;

  bool is_mine(int which) const;
  void put_in_layers(const Sparse &);
  void put_in_order();
  void cut(const Sparse &, int at);
  int begin_of(int which) const { return which == 0 ? 0 : part[which - 1]; }
  int place_in(int which, int place) const;
  void find_envelopes(const Sparse &);
  void fill(const Sparse &);
  void gather();
  bool factorize();
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_ENVELOPE_FACTORS_H
#define MPM_SOLVE_ENVELOPE_FACTORS_H

#include "solve/envelope.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"

#include <Eigen/SparseCore>

#include <vector>

namespace MPM_NS {

/** Cholesky factors of a sparse symmetric matrix, A = L L^T.
 *
 *  Unknowns are numbered in layers from one end of a body to the other (E. Cuthill, J. McKee, Proc.
 *  24th ACM Conf. (1969) 157), so that the entries of a row are close to the diagonal, and L is
 *  stored in an envelope. This has more entries than orderings that minimize their number, but
 *  products of blocks run at the full speed of the processor. For systems of some thousand unknowns
 *  this is ten times faster.
 *
 *  Layers of a compact body are shells around a corner, with far more unknowns than a plane. Where
 *  the places of unknowns on a lattice are known, planes across the longest axis are layers if that
 *  takes clearly fewer operations.
 *
 *  If the envelope is large, a layer in the middle is put last, and both halves are eliminated
 *  toward it, each from its end. This takes the same number of operations, but two ranks can share
 *  them. The order does not depend on the number of ranks, and neither does the result. */
class EnvelopeFactors {
 public:
  /** How factors are kept. Rounded ones take half of the memory, all of which a solution has to
   *  read. They are those of another matrix, which is positive definite as well: along a vector v
   *  its v^T A v differs by a part of some 1e-7 times the root of the condition of A, at most. This
   *  is for preconditioners. Factors are made and used in double precision. */
  enum Precision { DOUBLE, ROUNDED };
  static constexpr int64_t ENOUGH = 500000;    ///< reals in an envelope that is worth halves

  /** ranks: the first two of them have one half each. All ranks must call each function with the
   *  same matrix and the same vectors, and get the same results. Null: this rank has both halves.
   *  split: number of reals in the envelope from which on there are halves. */
  explicit EnvelopeFactors(LatticeRanks *ranks = nullptr, int64_t split = ENOUGH,
                           Precision precision = DOUBLE) :
      ranks(ranks),
      split(split), precision(precision)
  {
  }

  /** Before compute(): unknowns are at these nodes of a lattice, width of them at each. */
  void set_places(const std::vector<LatticeIndex> &nodes, int width);
  /** Factorizes a matrix, given with both triangles. Returns false if it is not positive definite
   *  or not finite; the factors must not be used then. */
  bool compute(const Eigen::SparseMatrix<double> &A);
  /** The same for a matrix with entries in the same places as in the last matrix, with the known
   *  order. */
  bool compute_again(const Eigen::SparseMatrix<double> &A);
  /** x = A^-1 b, with b and x [unknowns], which may be the same array. */
  void solve(const double *b, double *x);
  int size() const { return unknowns; }
  /** Is the elimination divided into halves? */
  bool has_halves() const { return part[2] > part[1]; }
  double memory_usage() const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  LatticeRanks *const ranks;
  const int64_t split;
  const Precision precision;
  int unknowns = 0;
  std::vector<int> number;             // [unknown] its place in the order
  std::vector<int> queue, layer;       // unknowns in the order of layers, and the layer of each one
  std::vector<LatticeIndex> places;    // of unknowns on a lattice; empty: not known
  bool in_planes = false;              // are layers planes of the lattice?
  int part[3] = {0, 0, 0};         // ends of both halves and of the middle, as places in the order
  Envelope half[2], middle;        // the last rows of a half are those of the middle
  std::vector<int> unused;         // places without an unknown
  std::vector<double> solution;    // [place]
  std::vector<double> of_half[2];    // solutions of each half, with those of the middle
  std::vector<double> own_part, gathered;

  bool is_mine(int which) const
  {
    return !has_halves() || !ranks || ranks->number() == 1 || ranks->me() == which;
  }
  void put_in_layers(const Sparse &);
  void put_in_planes(const Sparse &);
  double operations(const Sparse &) const;
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

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_SPLINE_MULTIGRID_H
#define MPM_SOLVE_SPLINE_MULTIGRID_H

#include "solve/lattice_key.h"
#include "solve/lattice_ranks.h"
#include "solve/linear_system.h"

#include <memory>
#include <vector>

namespace MPM_NS {

/** Multigrid preconditioner for the stiffness of points at nodes of a lattice: A = P^T (K + m) P, with K = sum over points of
 *  G^T C G, masses m of nodes, and a projection P of each node on what constraints leave free.
 *
 *  A B-spline on twice the spacing is a sum of B-splines on the spacing (two-scale relation: along each axis 1/2 [1 2 1] of
 *  linear, 1/4 [1 3 3 1] of quadratic, 1/8 [1 4 6 4 1] of cubic ones).  The next level has these, projected, as functions of
 *  the same points, and so on: each level is a Galerkin operator of all above it.  The finest one is not assembled: there
 *  polynomials of Chebyshev smooth, which need products alone, in the inverse blocks of nodes, and at the surface of a body, where
 *  functions are nearly dependent, in those of chunks (RimFactors).  Coarse levels are assembled, and the coarsest is
 *  factorized.
 *
 *  Symmetric, and positive definite if A is.  Tangents that are not symmetric count by their symmetric part.
 *  The finest level is distributed as the nodes are.  Ranks have rows of the coarse ones (BlockRows) and chunks of the surfaces
 *  each, and vectors of coarse levels whole.  Nothing depends on who has which points, but for round-off. */
class SplineMultigrid {
 public:
  /** width: values of a node, 2 or 3.  order: of the splines, 1 to 3; other functions of points have coarse levels of these all the
   *  same.  few: unknowns of a level that is factorized, 0: what is fast.  all: systems of at most so many unknowns have no levels:
   *  they are factorized as a whole, so that a solution takes hardly more than one iteration. */
  SplineMultigrid(const Grid &, LatticeRanks &, int width, int order, int few = 0, int all = 0);
  ~SplineMultigrid();

  /** Constraints that hold several nodes together: of u = sum P x of a node over itself and others, P [width][width] of one of them. */
  struct Tie {
    int64_t node;
    LatticeIndex other;
    double P[9];
  };
  /** A new operator, for the blocks of nodes that the grid has now.  projection: [node][width][width], P u being free motions of
   *  a node; null where there are no constraints.  blocks: [node][width][width] of K + m at the diagonal, of all ranks,
   *  before constraints.  ties: by node, of those whose projection is not this one but that of the whole of P, with all of their others.
   *  All are copied.  Collective. */
  void begin(const double *projection, const double *blocks, const std::vector<Tie> &ties = {});
  /** The same operator with other stiffnesses and masses: the same nodes, points that reach the same ones of them, and the same projection.
   *  False, on all ranks, where begin() is needed as the system has levels, or none has been finished. */
  bool begin_again();
  /** A point of this rank, which reaches n nodes.  gradient: [n][ngrad] of their functions at the point.  stiffness: [width
   *  ngrad][width ngrad], volume times the change of stress (entry l*width + a) for a change of the gradient of value a along
   *  l, which around an axis may be one more.  Points of the same nodes are best given one after the other. */
  void add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                 const double *stiffness);
  /** What this rank gives to a mean around a node: K gets c b b^T, with b [n][width] the change of a weighted volume by the motion of nodes, and c = s_0/(s_1
   *  s_2), all of which are sums over ranks.  kind: means of the same node that are not the same. */
  void add_mean(int64_t around, int kind, const double sums[3], int n, const int64_t *nodes,
                const double *changes);
  /** mass: [node], of all ranks, times what makes it a stiffness; null where there is none.  system: A, whose product is wanted
   *  here (some ten times) and in precondition() (four times).  Collective. */
  void finish(LinearSystem &system, const double *mass);
  /** z: one cycle for A z = r; r itself if the levels are not usable.  Collective. */
  void precondition(const double *r, double *z);

  /** Could all be factorized? Not where stiffnesses are not finite, or far from positive definite: take another
   *  preconditioner.  The same on all ranks. */
  bool usable() const;
  /** Is all factorized as a whole? The cycle then is the inverse of the operator that it was made of, and needs no product. */
  bool is_whole() const;
  /** Of a system that is factorized as a whole: its nodes, the place of one of them in the system, -1: it is not there, and x = A^-1 b in the
   *  place of b [nodes][width], with the same on all ranks.  Valid until the next operator begins, also where ranks have come to own other ones
   *  of the nodes.  Collective. */
  int nodes_of_whole() const;
  int place_in_whole(const LatticeIndex &) const;
  void solve_whole(double *b);
  int levels() const;
  double largest_eigenvalue() const;    ///< of A relative to the blocks
  double memory_usage() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> on;
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_SPLINE_MULTIGRID_H
#define MPM_SOLVE_SPLINE_MULTIGRID_H

#include "solve/lattice_ranks.h"
#include "solve/linear_system.h"
#include "solve/node_constraints.h"

#include <memory>
#include <vector>

namespace MPM_NS {

/** Multigrid preconditioner for the stiffness of points at the nodes of a lattice: A = P^T (K + m)
 *  P, with K = sum over points of G^T C G, the masses m of nodes, and a projection P of each node
 *  on the motions that constraints leave free.
 *
 *  A B-spline on twice the spacing is a sum of B-splines on the spacing (two-scale relation: along
 *  each axis 1/2 [1 2 1] for linear, 1/4 [1 3 3 1] for quadratic, 1/8 [1 4 6 4 1] for cubic
 *  B-splines). The next level has these coarser B-splines, projected, as functions of the same
 *  points, and so on: each level is a Galerkin operator of the level above. The finest level is not
 *  assembled. Its smoothers are Chebyshev polynomials, which need only products, with the inverse
 *  diagonal blocks of nodes and, at the surface of a body, where functions are nearly dependent,
 *  with the inverses of chunks (RimFactors). Coarse levels are assembled, and the coarsest one is
 *  factorized.
 *
 *  The preconditioner is symmetric, and positive definite if A is. Only the symmetric part of a
 *  tangent counts. The finest level is distributed as the nodes are. Each rank has some of the rows
 *  of coarse levels (BlockRows) and some of the chunks of the surfaces, and complete vectors of
 *  coarse levels. Except for round-off, nothing depends on which rank has which points. */
class SplineMultigrid {
 public:
  /** width: number of values of a node, 2 or 3. order: order of the splines, 1 to 3; the coarse
   *  levels use splines also for points with other functions. few: largest number of unknowns of a
   *  level that is factorized, 0: the fastest choice. all: a system with at most this many unknowns
   *  has no levels; it is factorized as a whole, so that a solution takes hardly more than one
   *  iteration. */
  SplineMultigrid(const Grid &, LatticeRanks &, int width, int order, int few = 0, int all = 0);
  ~SplineMultigrid();

  using Tie = NodeTie;
  /** Starts a new operator, for the present blocks of nodes of the grid. projection:
   *  [node][width][width], such that P u is a free motion of a node; null: no constraints. blocks:
   *  [node][width][width], the diagonal blocks of K + m without constraints, summed over ranks.
   *  ties: sorted by node, for nodes whose projection is given by all of their terms P instead. All
   *  arguments are copied. Collective. */
  void begin(const double *projection, const double *blocks, const std::vector<Tie> &ties = {});
  /** Starts the same operator with other stiffnesses and masses, but the same nodes, the same
   *  projection, and points that reach the same nodes. Returns false on all ranks if begin() is
   *  needed instead, because the system has levels or no operator has been finished. */
  bool begin_again();
  /** Adds a point of this rank that reaches n nodes. gradient: [n][ngrad], gradients of the
   *  functions of the nodes at the point. stiffness: [width ngrad][width ngrad], the volume times
   *  the derivative of stress (entry l*width + a) with respect to the gradient of value a along l.
   *  Around an axis of symmetry, l may have one more value. Points with the same nodes are best
   *  added one after the other. */
  void add_point(int n, const int64_t *nodes, int ngrad, const double *gradient,
                 const double *stiffness);
  /** Adds the contribution of this rank to a mean around a node. K gets the term c b b^T, where b
   *  [n][width] is the change of a weighted volume with the motion of the nodes, and c = s_0/(s_1
   *  s_2). All of these are sums over ranks. kind: distinguishes several means of the same node. */
  void add_mean(int64_t around, int kind, const double sums[3], int n, const int64_t *nodes,
                const double *changes);
  /** Finishes the operator. mass: [node], summed over ranks, times the factor that makes it a
   *  stiffness; null: no masses. system: applies A; its product is used here (some ten times) and
   *  in each precondition() (four times). Returns false, on all ranks, if points reach nodes after
   *  begin_again() that they did not reach before: call begin(), and give all of them again.
   *  Collective. */
  bool finish(LinearSystem &system, const double *mass);
  /** One cycle for A z = r; z = r if the levels are not usable. Collective. */
  void precondition(const double *r, double *z);

  /** Could all factorizations be made? They fail if stiffnesses are not finite, or far from
   *  positive definite; another preconditioner must be used then. The same on all ranks. */
  bool usable() const;
  /** Is the system factorized as a whole? Then the cycle is the inverse of the operator at the time
   *  of finish() and needs no product. */
  bool is_whole() const;
  /** For a system that is factorized as a whole. nodes_of_whole(): number of its nodes.
   *  place_in_whole(): place of a node in the system; -1: it is not there. solve_whole(): replaces
   *  b [nodes][width] by A^-1 b; b must be the same on all ranks. All are valid until the next
   *  operator begins, even if nodes have moved to other ranks. Collective. */
  int nodes_of_whole() const;
  int place_in_whole(const LatticeIndex &) const;
  void solve_whole(std::vector<double> &b);
  int levels() const;
  double largest_eigenvalue() const;    ///< of A relative to the blocks
  double memory_usage() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> on;
};

}    // namespace MPM_NS
#endif

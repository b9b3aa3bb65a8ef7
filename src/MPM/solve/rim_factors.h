/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_RIM_FACTORS_H
#define MPM_SOLVE_RIM_FACTORS_H

#include "solve/envelope_factors.h"
#include "solve/lattice_nodes.h"

#include <Eigen/SparseCore>

#include <memory>

#include <vector>

namespace MPM_NS {

/** [node] Is it in the rim: at the surface of a body, as of those around it, up to reach along each axis, some do not exist, or at an
 *  interface, as stiffnesses (more than zero) around it differ much? period: in nodes, 0: none. */
std::vector<char> rim_of(const LatticeNodes &, const std::vector<double> &stiffness, int dim,
                         int reach, const int *period);

/** Factors of a symmetric matrix with a shift of its diagonal: functions that points cannot tell apart, and free bodies, make it
 *  singular, and more than that where a tangent is not positive definite.  Factors are.  False: no shift makes it so, or it is
 *  not finite; the factors are of no use then.  again: entries stand where those of the last matrix were. */
bool factorize(Eigen::SparseMatrix<double> A, EnvelopeFactors &, bool again = false);

/** An approximate inverse for nodes at the surface of a body, or of what is much stiffer than what is next to it.
 *
 *  There B-splines have little of the body in their support, and those of a corner are nearly dependent: the blocks of
 *  single nodes are no smoother.  Chunks of the surface, which overlap, are factorized, and their solutions added.  They are as large as
 *  factors of them are cheap, and none is much smaller than others: a thin one at an edge would be no smoother either.
 *
 *  Each chunk is with one rank; if there is but one, two ranks share it. */
class RimFactors {
 public:
  /** ranks: which share the work, and all call each function with the same. Null: this one does it. */
  explicit RimFactors(LatticeRanks *ranks = nullptr) : ranks(ranks) {}
  /** Nodes at the surface, the same on all ranks but for their order; width: values of each. */
  void start(const std::vector<LatticeIndex> &nodes, int dim, int width);
  int size() const { return first.empty() ? 0 : (int) first.size() - 1; }
  /** Have two nodes a chunk together? Only then their block of the matrix is wanted. */
  bool together(int a, int b) const;
  /** value: [width][width] of both triangles is added to the matrix, and its transposed if the nodes are not the same. */
  void add(int row, int column, const double *value);
  bool factorize();    ///< false: the factors are of no use.  Collective
  /** x, b: [node][width].  Collective. */
  void solve(const double *b, double *x);
  double memory_usage() const;

 private:
  LatticeRanks *const ranks;
  int width = 0;
  struct Copy {
    int chunk, place;    // place: in the chunk
  };
  std::vector<int> first;    // [node + 1] range in copies
  std::vector<Copy> copies;
  std::vector<int64_t> begin_of;    // [chunk] where the solution begins in those of all ranks
  std::vector<int> bytes;           // [rank] of its solutions

  /** A chunk of this rank. */
  struct Chunk {
    std::vector<int> nodes;
    std::vector<Eigen::Triplet<double>> entries;
    EnvelopeFactors factors;
    explicit Chunk(LatticeRanks *ranks) : factors(ranks) {}
  };
  std::vector<std::unique_ptr<Chunk>> chunks;    // null: that of another rank
  std::vector<double> solutions;

  int number_of_ranks() const { return ranks ? ranks->number() : 1; }
  double share(int node) const;
  void give_to_ranks(const std::vector<std::vector<int>> &nodes, const std::vector<double> &cost);
};

}    // namespace MPM_NS
#endif

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

#include <cmath>
#include <memory>
#include <vector>

namespace MPM_NS {

/** Tells for each node whether it is in the rim. This is so at the surface of a body, where some of
 *  the nodes up to reach along each axis do not exist, and at an interface, where the stiffnesses
 *  (positive) of the nodes around it differ much. period: in nodes; 0: not periodic. */
std::vector<char> rim_of(const LatticeNodes &, const std::vector<double> &stiffness, int dim,
                         int reach, const int *period);

/** Factorizes a symmetric matrix with a shift of its diagonal. The shift is needed because
 *  functions that points cannot distinguish, and free bodies, make the matrix singular, and because
 *  a tangent may not even be positive semi-definite; the factors must be positive definite. Returns
 *  false if no shift is sufficient, or if the matrix is not finite; the factors must not be used
 *  then. again: the entries are in the same places as in the last matrix. */
bool factorize(Eigen::SparseMatrix<double> A, EnvelopeFactors &, bool again = false);
/** The same for a matrix that is stored by rows. */
bool factorize_rows(const Eigen::SparseMatrix<double, Eigen::RowMajor, int> &, EnvelopeFactors &,
                    bool again = false);

/** An approximate inverse for nodes at the surface of a body, or at the surface of a part that is
 *  much stiffer than its surroundings.
 *
 *  B-splines at a surface have little of the body in their support, and those at a corner are
 *  nearly dependent, so that the diagonal blocks of single nodes are not a smoother there. Instead,
 *  overlapping chunks of the surface are factorized, and their solutions are added. Chunks are as
 *  large as their factors remain cheap, and none is much smaller than the others: a thin chunk at
 *  an edge would not be a smoother either.
 *
 *  Each chunk belongs to one rank; a single chunk is shared by two ranks. */
class RimFactors {
 public:
  /** ranks: they share the work, and all of them must make the same calls. Null: this rank does all
   *  the work. */
  explicit RimFactors(LatticeRanks *ranks = nullptr) : ranks(ranks) {}
  /** Starts with these nodes at the surface, which must be the same on all ranks except for their
   *  order. width: number of values per node. */
  void start(const std::vector<LatticeIndex> &nodes, int dim, int width);
  int size() const { return first.empty() ? 0 : (int) first.size() - 1; }
  /** Do two nodes have a chunk in common? Only then is their block of the matrix needed. */
  bool together(int a, int b) const;
  /** Adds the block value [width][width] to the matrix and, if the nodes differ, its transpose at
   *  the transposed place. */
  void add(int row, int column, const double *value);
  bool factorize();    ///< false: the factors must not be used. Collective
  /** Solves for x with the right side b, both [node][width]. Collective. */
  void solve(const double *b, double *x);
  double memory_usage() const;

 private:
  LatticeRanks *const ranks;
  int width = 0;
  struct Copy {
    int chunk, place;    // place: number of the node in the chunk
  };
  std::vector<int> first;    // [node + 1] ranges in copies
  std::vector<Copy> copies;
  std::vector<int64_t> begin_of;    // [chunk] start of its solution in the solutions of all ranks
  std::vector<int> bytes;           // [rank] bytes of its solutions

  /** A chunk of this rank. */
  struct Chunk {
    std::vector<int> nodes;
    std::vector<Eigen::Triplet<double>> entries;
    EnvelopeFactors factors;
    explicit Chunk(LatticeRanks *ranks) :
        factors(ranks, EnvelopeFactors::ENOUGH, EnvelopeFactors::ROUNDED)
    {
    }
  };
  std::vector<std::unique_ptr<Chunk>> chunks;    // null: the chunk of another rank
  std::vector<double> solutions;

  int number_of_ranks() const { return ranks ? ranks->number() : 1; }
  /** Copies of a node share what it has, so that those in many chunks do not get too much. */
  double share(int node) const { return 1.0 / std::sqrt(first[node + 1] - first[node]); }
  void give_to_ranks(const std::vector<std::vector<int>> &nodes, const std::vector<double> &cost);
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_FINE_SMOOTHER_H
#define MPM_SOLVE_FINE_SMOOTHER_H

#include "solve/block_list.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"
#include "solve/linear_system.h"
#include "solve/node_constraints.h"
#include "solve/rim_factors.h"

#include <vector>

namespace MPM_NS {

/** The smoother of the finest level: Chebyshev polynomials with the inverse diagonal blocks of
 *  nodes and, in the rim, that is at surfaces and interfaces, where functions are nearly dependent,
 *  with the inverses of chunks. */
class FineSmoother {
 public:
  FineSmoother(const NodeConstraints &, LatticeRanks &);

  /** everywhere: all nodes, of all ranks, that have a stiffness; in_rim: which of them are in the
   *  rim. Nodes to which others are tied join them. exists: [node], has it a stiffness?
   *  Collective. */
  void find_rim(const LatticeNodes &everywhere, const std::vector<char> &in_rim,
                const std::vector<char> &exists);
  /** Number of a node in the rim; -1: it is not there. */
  int in_rim(int64_t node) const { return number[node]; }
  /** Is the block of two nodes of the rim needed? */
  bool together(int a, int b) const { return factors.together(a, b); }
  /** Adds a block of the rim, with its transposed. */
  void add(int row, int column, const double *K) { blocks.add_lower(row, column, K, nodes.width); }
  /** Sets the diagonal block D of a node, with the mean scale on its diagonal. What a constraint
   *  fixes has unity there, and nothing afterwards. */
  void set_block(int64_t node, const NodeBlock &D, double scale);
  /** Factorizes the rim, with the masses of nodes (null: none). Returns false if that is not
   *  possible. Collective. */
  bool factorize(const double *mass);
  /** Finds largest. Collective. */
  void estimate_largest(LinearSystem &);
  /** Smooths A z = r. Collective. */
  void smooth(LinearSystem &, const double *r, double *z, bool from_zero);

  double largest = 0.0;      ///< eigenvalue of A relative to the blocks
  ConstrainedParts parts;    ///< of nodes of the rim with constraints in those of the rim
  MeanTerms means;           ///< of nodes of the rim
  double memory_usage() const;

 private:
  const NodeConstraints &nodes;
  LatticeRanks &ranks;
  LatticeNodes rim;
  std::vector<int> number;              // [node] in the rim, -1: not in it
  std::vector<int64_t> owned;           // nodes of the rim that this rank owns
  std::vector<int> all_numbers;         // those of all ranks, by their number
  std::vector<MatrixBlock> rim_ties;    // of all ranks: row u, column x of u = P x
  std::vector<MatrixBlock> fixed;       // what stands for what is fixed in the rim, one triangle
  std::vector<double> inverse;          // [node][width][width], 0 in the rim
  BlockList blocks;
  RimFactors factors;
  std::vector<double> rim_x, rim_b, partial, gathered, work[3];

  void apply(const double *r, double *z);
};

}    // namespace MPM_NS
#endif

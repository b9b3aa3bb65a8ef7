/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_WHOLE_SYSTEM_H
#define MPM_SOLVE_WHOLE_SYSTEM_H

#include "solve/block_rows.h"
#include "solve/envelope_factors.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"

#include <algorithm>
#include <vector>

namespace MPM_NS {

/** A system of nodes that has no levels, and is factorized as a whole, on all ranks. */
class WholeSystem {
 public:
  WholeSystem(LatticeRanks &ranks, int width) :
      ranks(ranks), width(width), factors(&ranks, EnvelopeFactors::ENOUGH, EnvelopeFactors::ROUNDED)
  {
  }
  LatticeNodes nodes;          ///< all of its nodes
  std::vector<double> b, x;    ///< [node][width]

  /** The matrix of these nodes. constraints: of nodes that are not free, row u, column x of u = P
   *  x; mine: blocks of this rank, row >= column. Collective. */
  void build(LatticeNodes, const std::vector<MatrixBlock> &constraints,
             const std::vector<MatrixBlock> &mine);
  /** The matrix by other values of blocks; false, on all ranks: these are not in the same places,
   *  and assemble() is needed. Collective. */
  bool refill(const std::vector<MatrixBlock> &mine);
  void assemble();
  /** Were all nodes of the last blocks there in build()? The same on all ranks. */
  bool knows_nodes() const
  {
    return std::all_of(blocks.begin(), blocks.end(), [](const MatrixBlock &b) {
      return b.row >= 0 && b.column >= 0;
    });
  }
  /** same_places: entries are where those of the last matrix were. Returns false if it is not
   *  possible. Collective. */
  bool factorize(bool same_places);
  /** x = A^-1 b. Collective. */
  void solve()
  {
    if (!b.empty()) factors.solve(b.data(), x.data());
  }
  /** Replaces b [node][width] by P A^-1 P^T b. Collective. */
  void solve(std::vector<double> &b);
  double memory_usage() const;

 private:
  LatticeRanks &ranks;
  const int width;
  std::vector<MatrixBlock> constrained, blocks;    // of all ranks
  BlockRows::Sparse matrix;
  std::vector<int> slots;    // places of entries in its values: of one triangle, and of the other
  EnvelopeFactors factors;
};

}    // namespace MPM_NS
#endif

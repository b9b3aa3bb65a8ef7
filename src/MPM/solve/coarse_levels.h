/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_COARSE_LEVELS_H
#define MPM_SOLVE_COARSE_LEVELS_H

#include "solve/block_rows.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"
#include "solve/rim_factors.h"

#include <memory>
#include <vector>

namespace MPM_NS {

/** The coarse levels of SplineMultigrid: Galerkin operators of each other, smoothed as the finest
 *  level is. The coarsest one is factorized. Each rank has some of the rows, and all ranks have
 *  complete vectors. */
class CoarseLevels {
 public:
  /** few: largest number of unknowns of a level that is factorized. */
  CoarseLevels(LatticeRanks &ranks, int width, int order, int dim, int few) :
      ranks(ranks), width(width), order(order), dim(dim), few(few),
      factors(&ranks, EnvelopeFactors::ENOUGH, EnvelopeFactors::ROUNDED)
  {
  }
  /** Builds the levels from the first one on. rows: [ranks + 1], first node of each rank. period:
   *  in nodes, 0: not periodic. blocks: of this rank, row >= column. Collective. */
  void build(LatticeNodes, std::vector<int> rows, const int *period,
             std::vector<MatrixBlock> blocks);
  /** Factorizes the last level; false: the levels must not be used. Collective. */
  bool factorize();
  int size() const { return (int) all.size(); }
  /** Right side and solution of the first level. */
  std::vector<double> &b() { return all[0].b; }
  const std::vector<double> &x() const { return all[0].x; }
  /** One cycle. Collective. */
  void cycle() { cycle(0); }
  double memory_usage() const;

 private:
  struct Level {
    BlockRows A;
    CoarseParts to_next;
    std::vector<double> x, b;
    // smoother, as on the finest level
    std::vector<double> inverse, work[3];    // [node][width][width]
    std::vector<int> rim;                    // nodes of the rim
    std::unique_ptr<RimFactors> rim_factors;
    std::vector<double> rim_b, rim_x;
    double largest = 0.0;

    void apply(int width, const double *r, double *z);
  };

  LatticeRanks &ranks;
  const int width, order, dim, few;
  bool usable = true;
  std::vector<Level> all;
  BlockRows::Sparse last;    // the matrix of the last level, until it is factorized
  EnvelopeFactors factors;

  void make_smoother(Level &, const LatticeNodes &, const int *cells);
  void cycle(std::size_t level);
};

}    // namespace MPM_NS
#endif

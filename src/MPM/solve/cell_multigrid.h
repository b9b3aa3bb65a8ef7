/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_CELL_MULTIGRID_H
#define MPM_SOLVE_CELL_MULTIGRID_H

#include "solve/cell_operator.h"

#include <memory>

namespace MPM_NS {

/** Multigrid preconditioner of a CellOperator, symmetric and positive definite, and treatment of
 *  its closed pools.
 *
 *  A cell of the next level consists of those of the 2^dim cells in a cell twice as large that
 *  faces connect. So two pools on the two sides of a thin wall remain two. It has one pressure for
 *  all of its cells, and half of the sum of their face and outside coefficients, which again is the
 *  discretization with twice the spacing (D. Braess, Computing 55 (1995) 379; for flow H. Shao, L.
 *  Huang, D.L. Michels, ACM Trans. Graph. 41 (2022) 49). The smoother is Gauss-Seidel by colors, in
 *  reverse order after the correction by the next level. From the second level on, the correction
 *  by the next level is made twice. The coarsest level is factorized.
 *
 *  The finest level is distributed as the nodes are. Coarse levels are the same on all ranks, which
 *  gather the residuals of the first coarse level in each cycle. Except for round-off, nothing
 *  depends on which rank has which cells. */
class CellMultigrid {
 public:
  CellMultigrid();
  ~CellMultigrid();

  /** Makes the levels for the present coefficients of the operator. Collective. */
  void setup(const CellOperator &);
  /** One cycle for A z = r. Collective. */
  void precondition(const double *r, double *z);

  /** For a caller that keeps the finest level in vectors of its own: the number of cells of the
   *  next level, called parts here, to which cells of this rank belong. */
  int parts() const;
  /** Part of a cell that this rank owns, given the index of the cell in vectors. */
  int part_of(int64_t place) const;
  /** Replaces the sums of the residuals of the cells of this rank, parts [part], by the corrections
   *  of their x. Collective. */
  void correct(std::vector<double> &parts);

  /** Sets the mean over each closed pool to 0, and cells that are not in the system to 0. This
   *  makes right sides solvable and pressures unique. Returns the largest previous mean by absolute
   *  value. Collective. */
  double project(double *x);
  /** Could the coarsest level be factorized? It cannot if coefficients are negative or not finite;
   *  its correction is then left out. The same on all ranks. */
  bool usable() const;
  /** Number of closed pools on all ranks. */
  int closed_pools() const;
  int levels() const;
  double memory_usage() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> on;
};

}    // namespace MPM_NS
#endif

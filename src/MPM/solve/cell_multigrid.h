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

/** Multigrid preconditioner of a CellOperator, symmetric and positive definite, and its closed pools.
 *
 *  A cell of the next level is what faces join of the 2^dim cells of a cell twice as large: two pools on both sides of a thin
 *  wall stay two.  It has one pressure for all of them, and half of the sum of their faces and outsides, which is the
 *  discretization with twice the spacing again (D. Braess, Computing 55 (1995) 379; for flow H. Shao, L. Huang, D.L. Michels,
 *  ACM Trans. Graph. 41 (2022) 49).  Smoothing is Gauss-Seidel by colors, in reverse order after the correction by
 *  the next level, of which there are two from the second level on.  The coarsest level is factorized.
 *
 *  The finest level is distributed as the nodes are; coarse ones are the same on all ranks, which get the residuals of the
 *  first of them in each cycle.  Nothing depends on who has which cells, but for round-off. */
class CellMultigrid {
 public:
  CellMultigrid();
  ~CellMultigrid();

  /** Levels for the coefficients that the operator has.  Collective. */
  void setup(const CellOperator &);
  /** z: one cycle for A z = r.  Collective. */
  void precondition(const double *r, double *z);

  /** For who has the finest level in vectors of its own: cells of this rank belong to so many of its parts() of cells of the next level. */
  int parts() const;
  /** Part of a cell that this rank owns, by its place in vectors. */
  int part_of(int64_t place) const;
  /** [part] sums of the residuals of the cells of this rank become what is added to their x.  Collective. */
  void correct(std::vector<double> &parts);

  /** Closed pools get the mean of 0, and cells that are not in the system 0: solvable right sides, and pressures that are
   *  unique.  Returns the largest mean that there was, by absolute value.  Collective. */
  double project(double *x);
  /** Could the coarsest level be factorized? Not where coefficients are negative or not finite; its correction is then left
   *  out.  The same on all ranks. */
  bool usable() const;
  /** Closed pools of all ranks. */
  int closed_pools() const;
  int levels() const;
  double memory_usage() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> on;
};

}    // namespace MPM_NS
#endif

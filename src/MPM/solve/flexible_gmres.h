/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_FLEXIBLE_GMRES_H
#define MPM_SOLVE_FLEXIBLE_GMRES_H

#include "solve/krylov.h"

namespace MPM_NS {

/** Flexible generalized minimal residuals (GMRES) with restarts (Y. Saad, SIAM J. Sci. Comput. 14
 *  (1993) 461) for systems that need not be symmetric. The preconditioner acts from the right, so
 *  that residuals are those of the system. It may differ from iteration to iteration, for example
 *  be an iterative solve itself. Two vectors are kept for each iteration of a cycle, after which
 *  the method restarts with the remaining residual. A singular system is solved if its right side
 *  is in the range, unless the Krylov space ends earlier (SINGULAR). x: first guess and solution.
 *  The object keeps its vectors from solve to solve. */
class FlexibleGMRES {
 public:
  /** cycle: number of iterations between restarts. */
  explicit FlexibleGMRES(int cycle = 50) : longest(cycle) {}
  SolveReport solve(LinearSystem &, const double *b, double *x, const SolveGoal &);
  double memory_usage() const;

 private:
  const int longest;
  std::vector<std::vector<double>> v, z;    // basis, and the preconditioned basis
  std::vector<double> h;          // columns of the Hessenberg matrix, rotated to a triangle
  std::vector<double> c, s, g;    // rotations, and the rotated right side
  std::vector<const double *> left, right;    // for products with the vectors of the basis
  std::vector<double> part;

  double *column(int j) { return h.data() + (std::size_t) j * (longest + 2); }
  /** Finds vector j + 1 of the basis. Its components along the other vectors and its length become
   *  column j. */
  void orthogonalize(LinearSystem &, int j, double &largest);
  void update(int n, double *x);
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_MINRES_H
#define MPM_SOLVE_MINRES_H

#include "solve/krylov.h"

namespace MPM_NS {

/** Preconditioned minimal residuals (MINRES; C.C. Paige, M.A. Saunders, SIAM J. Numer. Anal. 12 (1975) 617;
 *  in the form of H.C. Elman, D.J. Silvester, A.J. Wathen, Finite Elements and Fast Iterative Solvers,
 *  Oxford 2014, algorithm 4.1) for symmetric systems that may be indefinite, such as those with Lagrange
 *  multipliers. The preconditioner must be positive definite. The residual in the norm of the
 *  preconditioner decreases with each iteration; its plain norm is reported and compared with the goal. A
 *  singular system is solved if its right side is in the range; otherwise x is a least-squares solution,
 *  and the outcome is SINGULAR. x: first guess and solution. The object keeps its vectors from solve to
 *  solve. */
class MinimalResiduals {
 public:
  SolveReport solve(LinearSystem &, const double *b, double *x, const SolveGoal &);
  double memory_usage() const;

 private:
  std::vector<double> r, Az, v, v_old, z, z_new, w, w_old;

  void cycle(LinearSystem &, double *x, const SolveGoal &, double enough, SolveReport &);
};

}    // namespace MPM_NS
#endif

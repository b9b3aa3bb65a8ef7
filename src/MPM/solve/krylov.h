/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_KRYLOV_H
#define MPM_SOLVE_KRYLOV_H

#include "solve/linear_system.h"

#include <algorithm>
#include <string>
#include <vector>

namespace MPM_NS {

/** Criterion of convergence: |b - A x| <= max(relative |b|, absolute), in the norm of
 *  LinearSystem::products(). With natural, which is for conjugate gradients that start at x = 0,
 *  the norm is that of the preconditioner M, (r . M r)^1/2, which is independent of the units of
 *  single unknowns. */
struct SolveGoal {
  double relative = 1.0e-8;
  double absolute = 0.0;
  int most_iterations = 1000;
  bool natural = false;

  /** The largest residual that meets the criterion for |b|. */
  double enough(double right_side) const { return std::max(relative * right_side, absolute); }
};

/** r = b - A x.  Collective. */
void find_residual(LinearSystem &, const double *b, const double *x, double *r);

/** Result of a solve. */
struct SolveReport {
  enum Outcome {
    CONVERGED,
    TOO_MANY,      ///< the most iterations allowed were not enough
    INDEFINITE,    ///< operator or preconditioner are not positive definite, as the method requires
    SINGULAR,      ///< no further progress: the right side is not in the range of the operator
    NOT_FINITE     ///< a residual is not a number
  };
  Outcome outcome = CONVERGED;
  int iterations = 0;
  double right_side = 0.0;          ///< |b|
  std::vector<double> residuals;    ///< |b - A x| at the start and after each iteration

  bool converged() const { return outcome == CONVERGED; }
  /** Text for messages: the outcome and the history of residuals. */
  std::string describe() const;
};

/** Preconditioned conjugate gradients (M.R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49
 *  (1952) 409) for symmetric systems that are positive definite, or semi-definite with a right side
 *  that is in their range. x: first guess and solution. The object keeps its vectors from solve to
 *  solve. */
class ConjugateGradients {
 public:
  SolveReport solve(LinearSystem &, const double *b, double *x, const SolveGoal &);
  double memory_usage() const
  {
    return (r.capacity() + z.capacity() + p.capacity() + Ap.capacity()) * sizeof(double);
  }

 private:
  std::vector<double> r, z, p, Ap;
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_SPREAD_H
#define LMP_MPM_FLOW_SPREAD_H

#include "flow/mpm_flow_rows.h"
#include "solve/krylov.h"

#include <vector>

namespace LAMMPS_NS {

/** Solves well conditioned equations of cells, for which the diagonal is a sufficient
 *  preconditioner:
 *
 *    diagonal_i x_i - sum over neighbors j of weight_ij x_j = load_i,
 *
 *  symmetric, with a diagonal that is greater than the sum of the weights. Every second unknown
 *  follows from its neighbors. Conjugate gradients for the other half, scaled to a diagonal of one,
 *  need half as many iterations as for all unknowns (J.K. Reid, SIAM J. Numer. Anal. 9 (1972) 325).
 *  Each iteration has one sum over ranks (A.T. Chronopoulos, C.W. Gear, J. Comput. Appl. Math. 25
 *  (1989) 153). */
class MPMFlowSpread {
 public:
  MPMFlowSpread(class LAMMPS *lmp, MPMFlowRows &rows) : lmp(lmp), rows(rows) {}

  /** diagonal, load, x: by places of the rows; weight: [place][side]. The residual is that of the
   *  equations divided by the root of their diagonal. x may be the same array as load.
   *  Collective. */
  MPM_NS::SolveReport solve(const std::vector<double> &diagonal, const std::vector<double> &weight,
                            const double *load, double *x, const MPM_NS::SolveGoal &);

  double memory_usage() const;

 private:
  class LAMMPS *const lmp;
  MPMFlowRows &rows;
  // one over the root of the diagonal; weights of the scaled equations
  std::vector<double> root, factor;
  std::vector<double> right_side, solution, direction, changes, product, sums;

  void scale(const std::vector<double> &diagonal, const std::vector<double> &weight);
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_SPREAD_H
#define LMP_MPM_FLOW_SPREAD_H

#include "mpm_flow_rows.h"
#include "solve/krylov.h"

#include <vector>

namespace LAMMPS_NS {

/** Solves equations of cells that are well conditioned, of which the diagonal is all that a preconditioner needs:
 *
 *    diagonal_i x_i - sum over neighbors j of weight_ij x_j = load_i,
 *
 *  symmetric, with a diagonal that is greater than the sum of the weights. Every second unknown is known by those around it, and conjugate
 *  gradients for the other half, with a diagonal of one, take half as many
 *  iterations as those for all of them (J.K. Reid, SIAM J. Numer. Anal. 9 (1972) 325). Each has one sum over ranks
 *  (A.T. Chronopoulos, C.W. Gear, J. Comput. Appl. Math. 25 (1989) 153). */
class MPMFlowSpread {
 public:
  MPMFlowSpread(class LAMMPS *lmp, MPMFlowRows &rows) : lmp(lmp), rows(rows) {}

  /** By places of the rows; weight: [place][side]. The residual is that of equations over the root of their
   *  diagonal.  x may be load.  Collective. */
  MPM_NS::SolveReport solve(const std::vector<double> &diagonal, const std::vector<double> &weight,
                            const double *load, double *x, const MPM_NS::SolveGoal &);

  double memory_usage() const;

 private:
  class LAMMPS *const lmp;
  MPMFlowRows &rows;
  std::vector<double> root, factor;    // one over that of the diagonal; of the scaled equations
  std::vector<double> right_side, solution, direction, changes, product, sums;

  void scale(const std::vector<double> &diagonal, const std::vector<double> &weight);
};

}    // namespace LAMMPS_NS
#endif

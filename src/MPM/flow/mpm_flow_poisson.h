/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_POISSON_H
#define LMP_MPM_FLOW_POISSON_H

#include "flow/mpm_flow_rows.h"
#include "solve/cell_multigrid.h"
#include "solve/krylov.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowBodies;
class MPMFlowFourier;
class MPMFlowGasRows;

/** The equations of the pressure by places of rows (MPMFlowRows), with a preconditioner: a sweep of
 *  Gauss-Seidel, a correction, and a sweep in reverse order. The correction is by the coarse levels
 *  of a multigrid; then the preconditioner is CellMultigrid::precondition(), except where an odd
 *  period has two neighbors of the same half. Or it is by Fourier transforms of the box around the
 *  water. After a sweep from zero, the residual of odd cells is zero, and that of even cells is the
 *  sum from odd ones. */
class MPMFlowPoisson : public MPM_NS::LinearSystem {
 public:
  MPMFlowPoisson(class LAMMPS *lmp, const MPMFlowLattice &cells, MPMFlowRows &rows) :
      lmp(lmp), cells(cells), rows(rows)
  {
  }

  std::vector<double> diagonal, weight;    ///< [place], [place][side]
  MPM_NS::CellMultigrid multigrid;    ///< for these equations; its closed pools are always needed
  /** for these equations, instead of coarse levels; null: none */
  MPMFlowFourier *fourier = nullptr;
  const MPMFlowBodies *bodies = nullptr;    ///< that the pressure moves; null: none
  MPMFlowGasRows *gas = nullptr;            ///< in pockets; null: none

  void begin();    ///< to be called when all of these are set

  int64_t size() const override { return rows.size(); }
  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
  void products(int n, const double *const *a, const double *const *b, double *value) override;

  double memory_usage() const;

 private:
  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  MPMFlowRows &rows;
  std::vector<int> part;    // [place] part of the multigrid, see CellMultigrid::part_of()
  std::vector<double> inverse, sum, parts, mine, rank_sums;
  std::vector<double> on_cells[2];    // on the lattice

  void correct();
  const double *on_lattice(const double *of, std::vector<double> &to) const;
};

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

  double memory_usage() const
  {
    return MPM_NS::bytes_of(root, factor, right_side, solution, direction, changes, product, sums);
  }

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

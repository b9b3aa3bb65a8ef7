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
#include "solve/linear_system.h"

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

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GAS_ROWS_H
#define LMP_MPM_FLOW_GAS_ROWS_H

#include "mpm_flow_gas.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowRows;

/** Gas in the equations of the pressure of a flow: its pressure in a step is that of the volume in this very step, so that none is
 *  too stiff for a time step.
 *
 *  With psi = dt p/density of a pocket, and v the velocities out of wet cells through its surface,
 *
 *    psi = psi_0 + c (sum area v dt),  v = v* + h w (psi_cell - psi),
 *
 *  where w are weights of the equations at the surface and c is the stiffness of the gas. Without psi of the pocket, equations
 *  A psi = r become (A - f s s^T) psi = r + ..., where s_i are sums of w for a cell and f < 1/sum s: they stay symmetric and positive definite.
 *
 *  Where a pocket has grown by dV in the last step and grows by dV' in this one, its pressure is that of the volume now and of NOW dV' -
 *  BEFORE dV more. With 1/4 for both, an oscillation is stable with any step, of second order, and does not decay (N.M. Newmark, J. Eng. Mech.
 *  Div. 85 (1959) 67). The little that NOW is more takes what swings from step to step. */
class MPMFlowGasRows {
 public:
  MPMFlowGasRows(class LAMMPS *lmp, const MPMFlowLattice &cells, const MPMFlowPressure &water,
                 const MPMFlowGas &gas) :
      lmp(lmp),
      cells(cells), water(water), gas(gas)
  {
  }

  /** A step in which pressures act for a duration. pressure_to_psi: duration/density, in units; tension: psi of surfaces without gas; null: zero. */
  void begin(double duration, double pressure_to_psi, const std::vector<double> *tension);
  /** psi at surfaces, see MPMFlowPressure: before the solve as it would be with the volumes now. */
  const std::vector<double> &at_surface() const { return surface; }

  /** psi of the pocket in which a cell is; zero: it is in none, or in air without gas. */
  double in_cell(int64_t number) const
  {
    const int pocket = gas.pockets.of(number);
    return pocket >= 0 ? psi[pocket] : 0.0;
  }

  /** What gas adds to right sides of cells, with velocities before the solve, where the solution is psi - lift. Collective. */
  void load(const double *velocity, const std::vector<double> &lift,
            std::vector<double> &right_side);
  /** Rows are there. */
  void arrange(const MPMFlowRows &);
  /** y -= f s (s.x), by places of rows. Collective. */
  void add(const double *x, double *y);
  /** Solved. Collective. */
  void end(const double *x);

  /** Integral of psi over the walls that gas touches; the same on all ranks. */
  double at_wall(int axis, int side) const;
  /** Adds the integral of psi over the only region that there is, the share of this rank; positive into it. */
  void add_to_region(double *force) const;
  double memory_usage() const;

 private:
  static constexpr double BEFORE = 0.25, NOW = 0.275;

  struct Entry {
    int wet, pocket;    // in the order of MPMFlowPressure::visit_surface()
    double weight;
  };
  struct Place {
    int place, pocket;
    double weight;
  };
  class LAMMPS *const lmp;
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  const MPMFlowGas &gas;
  const std::vector<double> *tension = nullptr;
  double duration = 0.0;
  std::vector<double> surface, psi;      // of faces, of pockets
  std::vector<double> stiffness, all;    // NOW dpsi/dV; c, what it changes by s.x, and f
  std::vector<Entry> entries;
  std::vector<Place> places;
  std::vector<double> mine, sums, of_ranks;

  void fill();
  const double *sum(const double *x);
};

}    // namespace LAMMPS_NS
#endif

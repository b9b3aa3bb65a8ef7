/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GAS_ROWS_H
#define LMP_MPM_FLOW_GAS_ROWS_H

#include "flow/mpm_flow_gas.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowRows;

/** Gas in the equations for the pressure of a flow. Its pressure is implicit: it belongs to the
 *  volume in the same step, so that no gas is too stiff for a time step.
 *
 *  With psi = dt p/density of a pocket, and v the velocities out of wet cells through its surface,
 *
 *    psi = psi_0 + c (sum area v dt),  v = v* + h w (psi_cell - psi),
 *
 *  where w are weights of the equations at the surface and c is the stiffness of the gas. When psi
 *  of the pocket is eliminated, the equations A psi = r become (A - f s s^T) psi = r + ..., where
 *  s_i are the sums of w of a cell and f < 1/sum s: they stay symmetric and positive definite.
 *
 *  If a pocket has grown by dV in the last step to the volume V, and grows by dV' in this one, its
 *  pressure is that of the volume V + NOW dV' - BEFORE dV. With 1/4 for both, oscillations are
 *  stable for any step, of second order, and do not decay (N.M. Newmark, J. Eng. Mech. Div. 85
 *  (1959) 67). NOW is a little more, to damp what alternates from step to step. */
class MPMFlowGasRows {
 public:
  MPMFlowGasRows(class LAMMPS *lmp, const MPMFlowLattice &cells, const MPMFlowPressure &water,
                 const MPMFlowGas &gas) :
      lmp(lmp),
      cells(cells), water(water), gas(gas)
  {
  }

  /** Start of a step in which pressures act for a duration. pressure_to_psi: duration/density, with
   *  conversion of units; tension: [cell][dim] psi by surface tension, which is added; null:
   *  zero. */
  void begin(double duration, double pressure_to_psi, const std::vector<double> *tension);
  /** [cell][dim] psi at surfaces, see MPMFlowPressure::project(). Before the solve it belongs to
   *  the present volumes. */
  const std::vector<double> &at_surface() const { return surface; }

  /** psi of the pocket that contains a cell; zero if the cell is in no pocket, or in air without
   *  gas. */
  double in_cell(int64_t number) const
  {
    const int pocket = gas.pockets.pocket(number);
    return pocket >= 0 ? psi[pocket] : 0.0;
  }

  /** Adds the terms of the gas to the right sides of cells. velocity: before the solve, whose
   *  solution is psi - lift. Collective. */
  void load(const double *velocity, const std::vector<double> &lift,
            std::vector<double> &right_side);
  /** Finds the places of cells in the rows, which must be arranged. */
  void arrange(const MPMFlowRows &);
  /** y -= f s (s.x), by places of rows. Collective. */
  void add(const double *x, double *y);
  /** After the solve, with its solution x: psi of pockets and surfaces. Collective. */
  void end(const double *x);

  /** Integral of psi over the part of a wall that gas touches; the same on all ranks. */
  double at_wall(int axis, int side) const;
  /** Adds this rank's share of the integral of psi over the surface of a region, if it is the only
   *  one; positive into it. */
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
  std::vector<double> surface, psi;    // of faces, of pockets
  // of pockets: -NOW dpsi/dV; and [3]: change of psi without the solution, and f twice: the change
  // of psi per s.x
  std::vector<double> stiffness, all;
  std::vector<Entry> entries;
  std::vector<Place> places;
  std::vector<double> mine, sums, rank_sums;

  void fill();
  const double *sum(const double *x);
};

}    // namespace LAMMPS_NS
#endif

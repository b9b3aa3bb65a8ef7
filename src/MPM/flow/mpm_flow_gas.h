/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GAS_H
#define LMP_MPM_FLOW_GAS_H

#include "flow/mpm_flow_pockets.h"

#include <cmath>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowRows;

/** Law of a gas: its pressure is p in its initial volume V, and p V^gamma is constant. */
struct MPMFlowGasLaw {
  double p = 0.0, gamma = 1.0;
  double outside = 0.0;    ///< pressure of open air, the zero of pressures of the flow
};

/** Gas in the pockets of a flow. It has no inertia, so that each pocket has one pressure.
 *
 *  A pocket has an amount of gas, given as the volume that it has at the pressure p of the law, and
 *  a volume. The volume changes by the flux of the velocities of the lattice through the surface of
 *  the pocket. This is exact if points move with these velocities, and does not jump when cells
 *  become wet or dry. In addition, the volume slowly follows the volume that points leave empty.
 *  Amounts and volumes of pockets that merge are added; those of a pocket that splits are shared in
 *  proportion to the numbers of cells. */
class MPMFlowGas : protected Pointers {
 public:
  MPMFlowPockets pockets;

  MPMFlowGas(class LAMMPS *, const MPMFlowLattice &, const MPMFlowPressure &,
             const MPMFlowGasLaw &);

  /** Finds the pockets for the cells that are wet now. share: [cell] share of cells that points
   *  fill; velocity: [cell][dim] of faces before the step, for new pockets. Collective. */
  void find(const std::vector<double> &share, const double *velocity);
  bool known() const { return is_known; }    ///< has find() or restart() been called?
  /** Changes the volumes by velocities of faces [cell][dim] in the time dt. Collective. */
  void move(const double *velocity, double dt);

  int n() const { return (int) states.size(); }    ///< number of pockets
  bool has_gas(int pocket) const { return states[pocket].amount > 0.0; }
  /** Pressure of a pocket with its present volume, above the pressure outside. */
  double over(int pocket) const { return pressure(states[pocket]) - law.outside; }
  /** Minus the derivative of the pressure with respect to the volume. */
  double stiffness(int pocket) const;
  /** Rate of change of the volume in the last step [volume/time]. */
  double rate(int pocket) const { return states[pocket].rate; }

  int count() const;         ///< number of pockets with gas
  double highest() const;    ///< highest pressure in these; zero: there are none
  double lowest() const;     ///< lowest pressure in these
  double volume() const;     ///< of all of these
  /** Work of compression from the pressure p, less the work of the air outside
   *  [pressure*volume]. */
  double energy() const;

  /** State for restart files. */
  std::vector<double> restart_data() const;
  /** Returns false if the n data belong to another lattice. */
  bool restart(const double *from, std::size_t n);
  double memory_usage() const
  {
    return pockets.memory_usage() + MPM_NS::bytes_of(states, left, mine, rank_sums);
  }

 private:
  struct State {
    double amount = 0.0, volume = 0.0, rate = 0.0;
    bool open = false;
  };
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  const MPMFlowGasLaw law;
  std::vector<State> states;
  std::vector<double> left, mine, rank_sums;
  bool is_known = false;

  double pressure(const State &of) const
  {
    return of.amount > 0.0 ? law.p * std::pow(of.amount / of.volume, law.gamma) : law.outside;
  }
  void find_left(const std::vector<double> &share);
  std::vector<double> growth(const double *velocity);
  void begin(const std::vector<double> &rates);
  void hand_on(const std::vector<double> &rates);
};

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
  double memory_usage() const
  {
    return MPM_NS::bytes_of(surface, psi, stiffness, all, mine, sums, rank_sums, entries, places);
  }

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

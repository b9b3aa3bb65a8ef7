/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GAS_H
#define LMP_MPM_FLOW_GAS_H

#include "flow/mpm_flow_pockets.h"

#include <vector>

namespace LAMMPS_NS {

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
  double memory_usage() const;

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

  double pressure(const State &) const;
  void find_left(const std::vector<double> &share);
  std::vector<double> growth(const double *velocity);
  void begin(const std::vector<double> &rates);
  void hand_on(const std::vector<double> &rates);
};

}    // namespace LAMMPS_NS
#endif

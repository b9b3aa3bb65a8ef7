/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_GAS_H
#define LMP_MPM_FLOW_GAS_H

#include "mpm_flow_pockets.h"

#include <vector>

namespace LAMMPS_NS {

/** Gas of which the pressure is p in the volume that it has at first, and p V^gamma does not change. */
struct MPMFlowGasLaw {
  double p = 0.0, gamma = 1.0;
  double outside = 0.0;    ///< pressure of open air, from which pressures of the flow count
};

/** Gas in the pockets of a flow. It has no inertia: one pressure in each pocket.
 *
 *  A pocket has an amount, the volume that its gas has with the pressure p of the law, and a volume. That changes by what flows through its surface with velocities
 *  of the lattice, which is exact where points move with these, and does not jump when cells become wet or dry; it follows the volume that points
 *  leave slowly. Amounts and volumes of pockets that meet add up, those of one that splits are shared by cells. */
class MPMFlowGas : protected Pointers {
 public:
  MPMFlowPockets pockets;

  MPMFlowGas(class LAMMPS *, const MPMFlowLattice &, const MPMFlowPressure &,
             const MPMFlowGasLaw &);

  /** Pockets of wet cells as they are now. share: of cells that points fill; velocity: of faces before the step, for pockets that are new. Collective. */
  void find(const std::vector<double> &share, const double *velocity);
  bool known() const { return is_known; }    ///< has find() or restart() been called?
  /** Volumes change in a time by velocities of faces. Collective. */
  void move(const double *velocity, double dt);

  int n() const { return (int) states.size(); }
  bool has_gas(int pocket) const { return states[pocket].amount > 0.0; }
  /** Above that outside, with the volume that a pocket has now. */
  double over(int pocket) const { return pressure(states[pocket]) - law.outside; }
  /** Minus the derivative of the pressure by the volume. */
  double stiffness(int pocket) const;
  /** Change of its volume in a time, in the last step. */
  double rate(int pocket) const { return states[pocket].rate; }

  int count() const;         ///< pockets with gas
  double highest() const;    ///< pressure of these; zero: there are none
  double lowest() const;
  double volume() const;    ///< of all of these
  /** Work that compression from the pressure p has taken, but for that of the air outside (pressure*volume). */
  double energy() const;

  std::vector<double> restart_data() const;
  /** False: of another lattice. */
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
  std::vector<double> left, mine, of_ranks;
  bool is_known = false;

  double pressure(const State &) const;
  void find_left(const std::vector<double> &share);
  std::vector<double> growth(const double *velocity);
  void begin(const std::vector<double> &rates);
  void hand_on(const std::vector<double> &rates);
};

}    // namespace LAMMPS_NS
#endif

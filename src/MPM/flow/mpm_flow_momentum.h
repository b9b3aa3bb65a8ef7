/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_MOMENTUM_H
#define LMP_MPM_FLOW_MOMENTUM_H

#include "flow/mpm_flow_parts.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** The momentum equation of a flow: forces, viscosity, and the pressure that keeps velocities free
 *  of divergence. */
class MPMFlowMomentum : protected Pointers {
 public:
  /** who: the fix, for errors. */
  MPMFlowMomentum(class LAMMPS *, const MPMIncompressibleOptions &, const MPMFlowLiquids &,
                  MPMFlowParts &, MPMFlowFields &, MPMFlowResults &, const std::string &who);

  /** Finds the velocities at the end of a duration, from those at its start in
   *  MPMFlowFields::predicted, and the pressure. Collective. */
  void solve(double duration);
  /** The same for an impulse of the pressure alone. Not with grains, inflow, gas, and bodies.
   *  Collective. */
  void strike();
  /** After solve(): pressures for points, and forces on walls and regions. pressure_to_psi: see
   *  MPMFlowGasRows::begin(). Collective. */
  void find_pressures(double pressure_to_psi);
  /** [cell][dim] share of the gradient of the pressure that changes the velocity of a face; with
   *  grains or inflow. */
  const std::vector<double> &mobilities() const { return mobility; }
  double memory_usage() const
  {
    return MPM_NS::bytes_of(at_surface, before_forces, without_hold, start_of_part,
                            viscous_velocity, by_solids, mobility, potentials, psi_of_parts);
  }

 private:
  const MPMIncompressibleOptions &options;
  const MPMFlowLiquids &liquids;
  MPMFlowParts &parts;
  MPMFlowFields &fields;
  MPMFlowResults &results;
  const std::string who;
  // [cell][dim] psi of free surfaces with tension; velocities before the forces, as they are
  // without the inflow, and at the start of a part of the duration; velocities before the viscous
  // stress
  std::vector<double> at_surface, before_forces, without_hold, start_of_part, viscous_velocity;
  std::vector<double> by_solids;    // [cell][dim] change of velocities by the stress of solids
  std::vector<double> mobility;
  // [cell] psi before the viscous stress; sum over parts
  std::vector<double> potentials, psi_of_parts;

  MPM_NS::SolveReport solve_part(double duration);
  MPM_NS::SolveReport project(double duration, double rounding);
  void add_forces(double dt);
  void add_stress(double dt);
  void add_viscosity(double dt);
  void hold_and_resist(double duration);
  void hold();
  double rounding() const;
  void find_tension(double duration);
  void check_tension() const;
  MPM_NS::SolveReport find_stress(double dt, double rounding);
  const std::vector<double> *surface_psi() const;
  void extend_into_air();
  void extend_stress();
  void find_forces_on_regions(double pressure_to_psi);
  void check_inflow() const;
};

}    // namespace LAMMPS_NS
#endif

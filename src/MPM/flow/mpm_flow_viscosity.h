/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_VISCOSITY_H
#define LMP_MPM_FLOW_VISCOSITY_H

#include "flow/mpm_flow_pressure.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowViscosities;

/** Stress of a viscous fluid on a staggered lattice, 2 mu times the rate of strain. Normal stresses
 *  are at the middle of cells, shear stresses at edges. The stress is zero in dry cells, and at
 *  edges that touch two or more of them, because a free surface has no traction. The volume that
 *  the stress acts on reaches up to the surface, as for the pressure. */
class MPMFlowViscosity {
 public:
  MPMFlowViscosity(const MPMFlowLattice &cells, const MPMFlowPressure &water) :
      cells(cells), water(water)
  {
  }

  /** Half of the largest stable time step for the kinematic viscosity nu. */
  static double stable_dt(double nu, double h, int dim) { return h * h / (4.0 * dim * nu); }

  /** Viscosities of several liquids; null: there is one. */
  const MPMFlowViscosities *viscosities = nullptr;

  /** sum += factor div(2 D) in owned cells. factor: time step times kinematic viscosity, of several
   *  liquids the largest viscosity over the density in psi. velocity: [cell][dim], complete. */
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;

  template <bool several>
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_VISCOSITY_H
#define LMP_MPM_FLOW_VISCOSITY_H

#include "mpm_flow_pressure.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowViscosities;

/** Stress of a viscous fluid on a staggered lattice, 2 mu times the rate of strain. Normal stresses are at the
 *  middle of cells, shear stresses at edges. The stress is zero in dry cells, and at edges that touch two or
 *  more of them, because a free surface has no traction. The volume that the stress acts on reaches up to the
 *  surface, as for the pressure.
 *
 *  Where a drop of a heavy liquid is in a light one, the viscosity of a cell can belong to the former, and the density of a face next
 *  to it to the latter. Stresses on such faces are reduced, so that the stable step is that of the largest kinematic viscosity. At flat
 *  interfaces they are not. */
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
  /** The largest kinematic viscosity of a liquid, over the factor nu of add(). */
  double most = 1.0;

  /** sum += factor div(2 D) in owned cells. factor: time step times kinematic viscosity, of several
   *  liquids the largest viscosity over the density in psi. velocity: [cell][dim], complete. */
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum);

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  std::vector<double> excess;    // [cell][dim] share by which stresses on a face are reduced

  void find_excess();
  template <bool several>
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;
};

}    // namespace LAMMPS_NS
#endif

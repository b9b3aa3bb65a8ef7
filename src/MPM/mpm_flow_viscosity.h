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

/** Stress of a viscous fluid, 2 mu times the rate of strain, on a staggered lattice: normal stresses are in the middle of
 *  cells, shear stresses at edges. There is none in dry cells, and at edges with two or more of them around: a free surface has no
 *  traction. What it acts on reaches up to the surface, as for the pressure. */
class MPMFlowViscosity {
 public:
  MPMFlowViscosity(const MPMFlowLattice &cells, const MPMFlowPressure &water) :
      cells(cells), water(water)
  {
  }

  /** One half of the largest stable step for the kinematic viscosity nu. */
  static double stable_dt(double nu, double h, int dim) { return h * h / (4.0 * dim * nu); }

  /** sum += factor div(2 D) in owned cells, factor: time times kinematic viscosity. Velocities [cell][dim] are complete. */
  void add(double factor, const std::vector<double> &velocity, std::vector<double> &sum) const;

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
};

}    // namespace LAMMPS_NS
#endif

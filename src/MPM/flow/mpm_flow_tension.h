/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_TENSION_H
#define LMP_MPM_FLOW_TENSION_H

#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_wetting.h"

#include <vector>

namespace LAMMPS_NS {

/** Curvature of the free surface of a flow, from the share of each cell that points fill.
 *
 *  The shares are smoothed PASSES times with the weights 1/4, 1/2, 1/4 along each axis, which acts
 *  like a normal distribution with a deviation of sqrt(PASSES/2) spacings and hides steps of the
 *  size of a point. The level sets of a smoothed disk or ball are circles or spheres about the same
 *  center. Their curvature div(n), with the normal n out of the fluid, is that of the surface
 *  between them. A surface wave with the wave number k loses the share k^2 PASSES/4 h^2 of its
 *  curvature. Derivatives are of fourth order. Surfaces meet walls at the contact angle, because
 *  MPMFlowWetting continues the shares into the walls accordingly. */
class MPMFlowTension {
 public:
  static constexpr int PASSES = 4;

  /** angle: contact angle between walls and the surface, measured in the fluid [radians]. */
  MPMFlowTension(const MPMFlowLattice &cells, const MPMFlowPressure &water, double angle);

  /** Stable time step: one over the frequency of the shortest capillary wave (J.U. Brackbill, D.B.
   *  Kothe, C. Zemach, J. Comput. Phys. 100 (1992) 335). tension: surface tension over the density
   *  [length^3/time^2]. */
  static double stable_dt(double tension, double h);

  /** Finds at_faces [cell][dim] for all cells: the curvature times factor where the surface lies
   *  between the cell and the one before it along an axis. */
  void find(const std::vector<double> &share, double factor, std::vector<double> &at_faces);

  double memory_usage() const;

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  MPMFlowWetting wetting;
  std::vector<double> smooth, other, second[3], curvature;

  void find_smooth(const std::vector<double> &share);
  void find_curvature();
};

}    // namespace LAMMPS_NS
#endif

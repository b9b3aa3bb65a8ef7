/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_TENSION_H
#define LMP_MPM_FLOW_TENSION_H

#include "mpm_flow_pressure.h"
#include "mpm_flow_wetting.h"

#include <vector>

namespace LAMMPS_NS {

/** Curvature of the free surface of a flow, by the share of cells that points fill.
 *
 *  Shares are smoothed by PASSES times the weights 1/4, 1/2, 1/4 along each axis, so that steps of the size of a point do not count: a
 *  normal distribution with a deviation of sqrt(PASSES/2) spacings. The level sets of a disk or ball that is smoothed are circles or
 *  spheres about the same middle, whose curvature div(n), with the normal n out of the fluid, is that of the surface between
 *  them; waves of a surface with the number k lose the share k^2 PASSES/4 h^2 of it. Derivatives are of fourth order. Surfaces meet
 *  walls at the contact angle, as what is behind these is made so (MPMFlowWetting). */
class MPMFlowTension {
 public:
  static constexpr int PASSES = 4;

  /** angle: between walls and the surface, in the fluid [radians]. */
  MPMFlowTension(const MPMFlowLattice &cells, const MPMFlowPressure &water, double angle);

  /** One over the frequency of the shortest capillary wave, J.U. Brackbill, D.B. Kothe, C. Zemach, J. Comput. Phys. 100 (1992) 335;
   *  tension: over the density [length^3/time^2]. */
  static double stable_dt(double tension, double h);

  /** at_faces: [cell][dim] curvature times factor where the surface is between the cell and the one before it along an
   *  axis, of all cells. */
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

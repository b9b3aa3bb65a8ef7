/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_AFFINE_MIDPOINT_H
#define LMP_MPM_AFFINE_MIDPOINT_H

#include "implicit/mpm_solved_nodes.h"

#include <vector>

namespace LAMMPS_NS {

/** The end of a step of the mid-point rule for points of affine transfers, so that it keeps their
 *  angular momentum (see mpm_affine_midpoint.cpp). */
class MPMAffineMidpoint {
 public:
  explicit MPMAffineMidpoint(MPMSolvedNodes &nodes) : nodes(nodes) {}

  /** Finds the changes of velocities and matrices of points, where these are before they move in
   *  the step of duration dt. velocity: that they move with; rest: what nodes lack of their
   *  velocity at the end, [node][dim]. Collective. */
  void find_changes(double dt, const std::vector<double> &velocity,
                    const std::vector<double> &rest);
  /** Gives points these changes, after they have moved. */
  void change_points();
  double memory_usage() const
  {
    return (of_nodes.capacity() + of_points.capacity()) * sizeof(double);
  }

 private:
  MPMSolvedNodes &nodes;
  double dt = 0.0;
  std::vector<double> of_nodes;     // [node][2][dim] rest of the velocity, and displacement
  std::vector<double> of_points;    // [n][dim + dim^2] changes of velocities and matrices

  void find_changes(MPMSolvedNodes::Body &);
  void change_points(MPMField &);
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINT_MOTION_H
#define LMP_MPM_POINT_MOTION_H

#include "base/mpm_rows.h"
#include "implicit/mpm_solved_nodes.h"
#include "solve/bytes_of.h"

#include <vector>

namespace LAMMPS_NS {

/** Accelerations that points keep from step to step for the generalized alpha method and that of
 *  Hilber, Hughes, and Taylor, [n][dim]. The acceleration at the start of a step is that at the end
 *  of the step before, which balances forces of no single time. Points keep it, as they keep
 *  velocities: nodes get the mean by the masses of points, and points get the change of what nodes
 *  have. */
struct MPMPointAccelerations {
  MPMRows rows;
  bool known = false;    ///< were they found by an earlier step?

  /** Sets a [node][dim] to the mean of the points around. Collective. */
  void to_nodes(MPMSolvedNodes &, std::vector<double> &a) const;
  /** Adds the values of nodes at the points, which are where they were at the start of the step.
   *  Collective. */
  void add_from_nodes(MPMSolvedNodes &, std::vector<double> &change);
};

/** The end of a step of the mid-point rule for points of affine transfers, so that it keeps their
 *  angular momentum (see mpm_point_motion.cpp). */
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
  double memory_usage() const { return MPM_NS::bytes_of(of_nodes, of_points); }

 private:
  MPMSolvedNodes &nodes;
  double dt = 0.0;
  std::vector<double> of_nodes;     // [node][2][dim] rest of the velocity, and displacement
  std::vector<double> of_points;    // [n][dim + dim^2] changes of velocities and matrices

  void find_changes(MPMSolvedNodes::Body &);
};

}    // namespace LAMMPS_NS
#endif

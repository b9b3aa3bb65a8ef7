/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STAGES_H
#define LMP_MPM_STAGES_H

// The stages of a step, for one field each. mpm_step.cpp defines their order.

#include "field/mpm_point_map.h"
#include "transfer/kernels.h"

#include <functional>

namespace LAMMPS_NS {
class MPMField;
class MPMPlan;

namespace MPMStages {

  /** Makes the list of stages of the scheme of all fields. */
  void make_scheme(MPMPlan &);

  // points to nodes, and the equation of motion there

  /** What points give to nodes: mass, momentum, and force; mass and momentum; or forces, added to
   *  records that have mass and momentum already. */
  enum Content { ALL, MOMENTUM, FORCE };
  /** Sums over this rank's points. */
  void points_to_nodes(MPMField &, Content);
  /** Sums over images and ranks. */
  void sum_nodes(MPMField &, Content);
  /** v = (p + dt f)/m; the old velocity p/m stays in long records. */
  void momentum_equation(MPMField &);
  /** v = p/m. */
  void velocities(MPMField &);
  /** Converts velocities back to momentum, without the changes by node actions, and makes room for
   *  forces. */
  void back_to_momentum(MPMField &);

  // nodes to points

  /** Part of the strain update that is done while points move. */
  enum Strain {
    ELSEWHERE,    ///< none
    FRAME,        ///< what the frame needs of the motion of the points
    GRADIENTS,    ///< also velocity gradients, for MPMLocking::strain()
    STRESS        ///< also stress
  };
  /** Function that is called with batches of n <= BATCH points of a run. L: [n][dim*dim] velocity
   *  gradients of the points, column-major. */
  using UseGradients =
      std::function<void(const MPMPointMap::Run &, int first, int n, const double *L)>;
  /** Updates velocities, affine matrices, and positions of the points. use: not null if physics
   *  calls this early, at AFTER_SOLVE, because it needs the gradients of the motion. It receives
   *  the gradients before the strain, and positions wait until the regular call. */
  void nodes_to_points(MPMField &, Strain, const UseGradients &use = nullptr);
  /** May physics make this early call? If not, it must find gradients by itself. */
  bool can_move_first(const MPMField &);
  /** Moves points and corners to the positions at the end of the step, if these had to wait. */
  void move_points(MPMField &);

  /** Updates the stress of points from the present velocities of the nodes, for a share of a motion
   *  that takes the time dt. shift: see MPMFrame::shift_gradients(), as a share of dt. moves: also
   *  move the points with these velocities, if MPMField::mapped is there. */
  void strain_from_nodes(MPMField &, double dt, double share, double shift, bool moves = false);

  // nodes with almost no mass

  /** Blends the velocities of these nodes, for gradients only. */
  void blend_light_nodes(MPMField &);
  /** Sets affine matrices from the gradients of these velocities. stress: also update the stress
   *  and move the points. */
  void gradients_with_light_nodes(MPMField &, bool stress);

  // more terms of the inverse of the mass matrix

  /** XPIC: applied to the old velocities. */
  void xpic(MPMField &);
  /** FMPM: applied to the new velocities of all fields, with node actions after each term. */
  void fmpm(MPMPlan &);

  /** End of a step: checks for bad points, drift, and time step. */
  void checks(MPMField &);

}    // namespace MPMStages
}    // namespace LAMMPS_NS
#endif

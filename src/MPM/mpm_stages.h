/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STAGES_H
#define LMP_MPM_STAGES_H

// The stages of a step, for one field each. Their order is in mpm_step.cpp.

#include "mpm_point_map.h"
#include "transfer/kernels.h"

#include <functional>

namespace LAMMPS_NS {
class MPMField;
class MPMPlan;

namespace MPMStages {

  // mpm_stage_momentum.cpp: points to nodes, and the equation of motion there

  /** What nodes get of the points: mass, momentum and force; mass and momentum; forces, in records that
   *  have mass and momentum. */
  enum Content { ALL, MOMENTUM, FORCE };
  /** From this rank's points. */
  void points_to_nodes(MPMField &, Content);
  /** Over images and ranks. */
  void sum_nodes(MPMField &, Content);
  /** v = (p + dt f)/m; the old velocity p/m stays in long records. */
  void momentum_equation(MPMField &);
  /** v = p/m. */
  void velocities(MPMField &);
  /** Back from velocities to momentum, free of what node actions did, with room for forces. */
  void back_to_momentum(MPMField &);

  // mpm_stage_points.cpp: nodes to points

  /** What of the strain is made while points move. */
  enum Strain {
    ELSEWHERE,    ///< nothing
    FRAME,        ///< what the frame takes from the motion of the points
    GRADIENTS,    ///< velocity gradients, too, for MPMLocking::strain()
    STRESS        ///< stress, too
  };
  /** Calls of a user with batches of n <= BATCH points of a run. L: [n][dim*dim] their velocity gradients, column-major. */
  using UseGradients =
      std::function<void(const MPMPointMap::Run &, int first, int n, const double *L)>;
  /** Velocities, affine matrices and positions of the points. use: it is done for physics at AFTER_SOLVE, which needs the gradients
   *  of the motion: they are used before the strain, and positions wait until the call that is made in any case. */
  void nodes_to_points(MPMField &, Strain, const UseGradients &use = nullptr);
  /** May physics do that? Else it must find gradients on its own. */
  bool can_move_first(const MPMField &);
  /** Positions and corners of the end of the step, where they had to wait. */
  void move_points(MPMField &);

  /** Stress of points from the present velocities of the nodes, for a share of a motion that takes the
   *  time dt; shift: see MPMFrame::shift_gradients(), as a share of it. moves: with these velocities
   *  points move, too, if MPMField::mapped is there. */
  void strain_from_nodes(MPMField &, double dt, double share, double shift, bool moves = false);
  /** Strain and stress of n <= BATCH consecutive points of a run; L: their velocity gradients. */
  void update_stress(MPMField &, const MPM_NS::PointRows &, const MPMPointMap::Run &, int first,
                     int n, const double *L, double dt);
  /** Points without any stress, from this one on, get the pressure of their equation of state. */
  void give_initial_stress(MPMField &, int first = 0);

  // mpm_stage_light.cpp: nodes with next to no mass

  /** Their velocities, for gradients only. */
  void blend_light_nodes(MPMField &);
  /** Affine matrices by gradients of these velocities. stress: also stress; then points move. */
  void gradients_with_light_nodes(MPMField &, bool stress);

  // mpm_stage_series.cpp: more terms of the inverse of the mass matrix

  /** XPIC: in the old velocities. */
  void xpic(MPMField &);
  /** FMPM: in the new velocities of all fields, with node actions after each term. */
  void fmpm(MPMPlan &);

  /** End of a step: bad points, drift, time step. */
  void checks(MPMField &);

}    // namespace MPMStages
}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_RIGID_BODY_H
#define LMP_MPM_RIGID_BODY_H

namespace LAMMPS_NS {

/** State of a rigid body, as kept in restart files. */
struct MPMRigidMotion {
  double x[3], v[3], L[3];       ///< center, its velocity, angular momentum
  double Q[3][3];                ///< rotation from the frame of the mesh to space
  double omega[3];               ///< angular velocity
  double impulse[6], dt_last;    ///< of the material on the body in the last step
  double collision[6];           ///< impulse and moment of walls and other bodies in that step
  double collision_work;         ///< of these since the start [mass velocity^2]
  /** Of a body in a flow: what the velocity and the angular momentum have gained since the middle
   *  of the last step, by the change in that step; 1: a flow has moved it, else 0. */
  double half_kick[6], in_flow;
};

/** A rigid body, components of whose motion may be held. */
struct MPMRigidBody : MPMRigidMotion {
  double mass = 0.0;
  double body_inertia[3][3];    ///< about the center, in the frame of the mesh
  bool fixed[6] = {false, false, false, false, false, false};    ///< velocities that stay zero

  MPMRigidBody() : MPMRigidMotion() {}

  /** Inertia about the center, in space. */
  void inertia(double out[3][3]) const;
  /** Finds the angular velocity from the angular momentum. What holds an axis takes up the moment
   *  that keeps the angular velocity around it zero. */
  void spin();
  /** Nothing moves along what is held. */
  void hold();
  /** Adds an impulse and its moment about the center [6], except along what is held. */
  void push(const double *J);
  /** Moves center and orientation to the end of the step: rotation by the angular velocity at its
   *  middle, which keeps the angular momentum. */
  void move(double dt);
  /** Moves and turns it besides its motion, by distances and angles [6]. */
  void shift(const double *by);
  /** Change of velocity and angular velocity [6] by an impulse and its moment: [6][6]. */
  void find_mobility(double *mobility);
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_H
#define LMP_MPM_IMPLICIT_H

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_coupled_pressure.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_free_bodies.h"
#include "implicit/mpm_kept_factors.h"
#include "implicit/mpm_motion_system.h"
#include "implicit/mpm_newton.h"
#include "implicit/mpm_step_motion.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** Implicit step of one or more fields. The displacements u of their nodes in a step solve
 *      P^T r(u) = 0,   u = P u + dt w
 *  Its parts are the balance of forces r (MPMForceBalance), the constraints P and w
 *  (MPMConstraints), Newton's method (MPMNewton) with its linear systems (MPMMotionSystem), factors
 *  kept from earlier steps (MPMKeptFactors), a pressure of nodes that is found together with u
 *  (MPMCoupledPressure), and velocities at both ends of the step by a method of time integration
 *  (MPMStepMotion). */
class MPMImplicit {
 public:
  /** Several fields are allowed for static and euler, without multigrid, a pressure of nodes,
   *  elements, and points with domains. The accelerations are those of points, for methods that
   *  keep them. */
  MPMImplicit(class LAMMPS *, const std::vector<MPMField *> &, const MPMImplicitOptions &,
              MPMPointAccelerations &);
  ~MPMImplicit();

  /** Start of a run. */
  void init();
  /** Solves for u, starting from nodes with the velocities of the momentum equation, and gives the
   *  nodes the velocities from which node actions make those of the step, see
   *  MPMStepMotion::end_step(). */
  std::vector<double> step(double dt);
  /** Called after node actions have acted: sets the velocities of the step at the nodes. */
  void set_velocities() { motion.set_velocities(); }
  /** The same, and accounts for works of forces that the ledger does not know. */
  void finish() { motion.finish(); }
  /** Called after points have moved: gives points of affine transfers the difference between their
   *  velocities at the end of the step and the mean velocities that they moved with. */
  void end_motion() { motion.end_motion(); }
  /** Called after points have moved: walls check the new positions. Collective. */
  void check_contacts() { constraints.check_positions(); }
  const MPMImplicitReport &report() const { return now; }
  /** Time of a part of the steps since the start of the run, of this rank [s]. */
  double seconds_of(MPMImplicitTimes::Part which) const { return times.seconds[which]; }
  /** Discards what earlier steps have learned, for steps that must continue as from a restart file,
   *  which does not store it. */
  void forget() { factors.clear(); }
  double memory_usage() const;

 private:
  const MPMImplicitOptions &options;
  double stabilize;    // MPMImplicitOptions::stabilize, or the value that a step has needed
  MPMImplicitReport now;
  MPMImplicitTimes times;
  MPMSolvedNodes nodes;
  MPMForceBalance balance;
  MPMConstraints constraints;
  MPMFreeBodies free_bodies;
  const MPMImplicitParts parts;
  MPMMotionSystem system;
  MPMNewton newton;
  MPMKeptFactors factors;
  MPMStepMotion motion;
  std::unique_ptr<MPMCoupledPressure> pressure;    // null: there is none

  bool find_carried_points();
  bool begin_step(double dt);
  bool can_keep() const;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STEP_MOTION_H
#define LMP_MPM_STEP_MOTION_H

#include "implicit/mpm_point_motion.h"
#include "implicit/mpm_time_method.h"

#include <vector>

namespace LAMMPS_NS {
class MPMConstraints;
class MPMForceBalance;
class MPMNewton;
class MPMSolvedNodes;

/** Velocities and accelerations of nodes at both ends of an implicit step, by its method of time
 *  integration: the predictor at the start, and at the end the velocities that nodes give to
 *  points, with the works that the ledger has to know. */
class MPMStepMotion {
 public:
  MPMStepMotion(MPMSolvedNodes &, MPMForceBalance &, MPMConstraints &, MPMNewton &,
                const MPMTimeMethod &, MPMPointAccelerations &);

  /** Start of a step of duration dt, with constraints: finds the predictor of the balance, and a
   *  first guess of the displacements u. Collective. */
  void begin_step(double dt, std::vector<double> &u);
  /** The motion u has been found: gives nodes the velocities from which node actions make those of
   *  the step, with all the impulses that these take. Returns for each field, in statics, the
   *  fictitious kinetic energy of nodes that this rank owns [mass velocity^2]. Collective. */
  std::vector<double> end_step(const std::vector<double> &u);
  /** Node actions have acted: sets the velocities of the step at the nodes. */
  void set_velocities();
  /** The same, accounts for works of forces that the ledger does not know, and finds what points
   *  get besides the velocities that they move with. Collective. */
  void finish();
  /** Points of affine transfers have moved: they get this, in the mid-point rule. */
  void end_motion() { affine.change_points(); }
  double memory_usage() const;

 private:
  MPMSolvedNodes &nodes;
  MPMForceBalance &balance;
  MPMConstraints &constraints;
  MPMNewton &newton;
  const MPMTimeMethod &time;
  MPMPointAccelerations &kept;
  MPMAffineMidpoint affine;

  double dt = 0.0;
  std::vector<double> start, acceleration;    // at the start, with walls
  std::vector<double> end_acceleration;       // for methods that keep it
  std::vector<double> velocity;               // that points move with
  std::vector<double> impulse;    // that does not come from the forces of the start of the step

  // contact in methods of second order

  bool impacts = false;                   // walls separate, or have friction
  std::vector<double> mapped;             // accelerations that points bring to nodes
  std::vector<double> ending, stopped;    // velocities at the end, before and after walls
  /** Is friction part of the accelerations at both ends? In the first step the friction at its
   *  start is unknown. */
  bool accelerates_by_friction() const
  {
    return impacts && time.keeps_acceleration() && kept.known;
  }
  void set_friction();
  void end_contact(const std::vector<double> &u);

  void find_accelerations();
  void keep_accelerations();
  void set_record(int64_t n, double *record, const std::vector<double> &u);
  void account();
};

}    // namespace LAMMPS_NS
#endif

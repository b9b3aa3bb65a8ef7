/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_REACTION_H
#define LMP_MPM_WALL_REACTION_H

#include "pointers.h"

#include <cstdint>
#include <memory>

namespace LAMMPS_NS {
class MPMField;
class MPMFrictionHeat;
class MPMLedger;
class MPMWall;

/** What the body gets from a wall: sets the velocities of nodes, and sums up the impulse, its
 *  moment, the work, and the heat of friction. Sums are of nodes that this rank owns. */
class MPMWallReaction : protected Pointers {
 public:
  MPMWallReaction(class LAMMPS *, MPMWall &);
  ~MPMWallReaction() override;

  /** Start of a run. */
  void begin_run(const class Fix &user);
  /** Start of a step in which the wall acts for the time dt. */
  void begin_step(double dt);
  /** From now on, the wall acts on the nodes of the field with this index. counting: reactions and
   *  work count. */
  void begin_field(int index, bool counting);
  /** The wall has acted on them. */
  void end_field();

  bool is_counting() const { return counting; }
  /** FLIP share if old velocities are constrained, too; otherwise 0. */
  double old_share() const { return share_of_old; }

  /** Until end_sliding(), the velocities that are set are those of material that slides along a
   *  wall. */
  void begin_sliding(const double *normal) { sliding = heating && counting ? normal : nullptr; }
  void end_sliding() { sliding = nullptr; }
  /** Sets the velocity of a node to v, also the old one unless null, next to a wall with the
   *  velocity V. whole: velocity with which the impulse does work, if it is not v. */
  void set_velocity(int64_t node, const double *V, const double *v, const double *old,
                    const double *whole = nullptr);
  /** Adds an impulse on a node [mass velocity] to what the wall gave it in this step. */
  void add(MPMField &, int64_t node, const double *impulse);
  /** Adds an impulse on a rigid body at x [mass velocity] to what the wall gives in the step that
   *  begins next. Called on all ranks with the same values. It does no work on material. */
  void add_body_impulse(const double *x, const double *push);

  /** Work on the body so far, of all ranks [energy]. Collective. */
  double work() const;
  /** Force of the body on the wall, and torque, in the last step. Collective. */
  double force_on_wall(int component);
  bool heats() const { return heating != nullptr; }
  double memory_usage() const;

 private:
  MPMWall &wall;
  std::unique_ptr<MPMFrictionHeat> heating;    // null: not requested
  double impulse[6] = {};      // on the body, and its moment, in the last step; this rank's share
  double reaction[6] = {};     // force and torque
  double on_bodies[6] = {};    // impulse on rigid bodies in the step that begins
  double dt_last = 0.0;
  bool reaction_known = true;

  // while the wall acts on the nodes of a field

  MPMField *field = nullptr;
  int place = 0;    // index of the field in the list
  bool counting = false;
  MPMLedger *ledger = nullptr;    // null: none; else old velocities are in reals 4..6
  double share_of_old = 0.0;
  double kinetic = 0.0;     // kinetic energy gained by the nodes
  double driven = 0.0;      // part of it that is work by the motion of the wall
  double collided = 0.0;    // ledger: kinetic energy lost where nodes cannot keep their velocity
  const double *sliding = nullptr;    // normal of a wall on which nodes slide and become warm

  void add_moment(const MPMField &, int64_t node, const double *push);
  double slip_work(int64_t node, const double *V, const double *change, const double *v,
                   const double *counted);
};

}    // namespace LAMMPS_NS

#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_ACTION_H
#define LMP_MPM_NODE_ACTION_H

#include "lattice/grid.h"

#include <string>

namespace LAMMPS_NS {

/** Action on the nodes of the fields after the momentum equation: boundaries, contact, ... Fixes
 *  that derive from this class are called by fix mpm in the order of turns, and within a turn in
 *  the order of definition. */
class MPMNodeAction {
 public:
  /** Order of actions. Phases at the same place share their momentum first; then other actions
   *  exchange it between materials. Walls, which hold nodes for good, come after these; otherwise
   *  contact would push points through them. Only inlets pass through walls. Nodes that follow
   *  others come after all of these. */
  enum Turn { PHASES, EXCHANGE, BETWEEN_BODIES, RIGID_BODIES, WALLS, INLETS, TIED_NODES };
  virtual Turn turn() const { return EXCHANGE; }

  /** Checks and prepares the action at the start of a run; called by fix mpm in its init().
   *  Collective. */
  virtual void init_action() {}

  /** Called in each step before fields renew their blocks: calls renew_topology() of fields that
   *  must do so because another field does. */
  virtual void couple_topology() {}

  /** Called when the fields that renew their blocks have found the blocks in reach of points, but
   *  not further blocks yet. */
  virtual void blocks_found() {}

  /** Activates further blocks that the action needs next to those in reach of points. */
  virtual void extend_topology(class MPMField &) {}

  /** Does the action read nodes that no points can reach? Only if an action does, periodic images
   *  of these nodes have the values of their nodes. */
  virtual bool looks_beyond_points() const { return true; }

  /** Does the action read nodes of this block that points of this rank cannot reach, but those of
   *  other ranks can? Only if an action does, this rank gets the values of the other ranks
   *  there. */
  virtual bool looks_at_all(const class MPMField &, const MPM_NS::Grid::Block &) const
  {
    return true;
  }

  /** Called when the blocks of the field are new: lists of nodes must be made again. */
  virtual void topology_changed(class MPMField &) {}

  /** Velocities that the nodes have when an action is called. STEP: those after the momentum
   *  equation, which move points and count for reactions and work. Nothing is counted in the other
   *  stages. START (USF, USAVG): those of the start of the step. MAPPED_BACK (MUSL, USAVG): the new
   *  velocities of the points mapped back, used for the velocity gradient, and also for the motion
   *  unless an action decides_contact() or the frame is total. AGAIN (FMPM): those of STEP that
   *  were changed since. TRIAL: any vectors at nodes before STEP, for a solver that needs the
   *  effect of the action on them; only if is_projection(), or with a trial_contact(). */
  enum Stage { START, STEP, AGAIN, MAPPED_BACK, TRIAL };

  /** Is the effect on velocities v -> P v + w, where P and w are constant through the step, and P
   *  depends only on the masses of nodes and is its own square, or becomes so when it is repeated?
   *  With the masses M, P is an orthogonal projection, M P = P^T M: the forces of the action do no
   *  work on the motions that P leaves. */
  virtual bool is_projection() const { return false; }

  /** Contact that is such a projection once it is known what touches; null: the action is no such
   *  contact. */
  virtual class MPMTrialContact *trial_contact() { return nullptr; }

  /** Does the action decide in STEP which parts of this field are in contact? Velocities that are
   *  mapped back are not accurate enough in this respect to move points, except those whose domains
   *  deform (CPDI). */
  virtual bool decides_contact(const class MPMField &) const { return false; }

  /** Can the field with this ID touch other bodies by this action? */
  virtual bool touches(const std::string & /*field*/) const { return false; }
  /** Does the action keep the nodes of this field at x = 0, an axis of symmetry, from moving along
   *  x? */
  virtual bool holds_axis(const class MPMField &) const { return false; }
  /** Can the action hold points elsewhere than at faces of the box? */
  virtual bool acts_inside() const { return false; }
  /** May this field be without points at the start of a run, because they come later, or because
   *  others need its nodes? */
  virtual bool may_be_empty(const class MPMField &) const { return false; }

  /** Changes the velocities of the nodes of the fields; in STEP, also the old velocities of FLIP
   *  where material is held for good (see mpm_mirror_nodes.cpp). */
  virtual void act(double dt, Stage) = 0;

  /** Called on all actions after another action has changed the velocities of this stage. */
  virtual void has_acted(MPMNodeAction & /*other*/, Stage) {}

 protected:
  ~MPMNodeAction() = default;    // owned and deleted as a Fix, whose destructor may throw
};

}    // namespace LAMMPS_NS
#endif

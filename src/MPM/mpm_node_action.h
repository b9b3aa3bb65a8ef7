/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_ACTION_H
#define LMP_MPM_NODE_ACTION_H

#include "lattice/grid.h"

namespace LAMMPS_NS {

/** What acts on the nodes of the fields after the momentum equation: boundaries, contact, ...
 *  Fixes that derive from this are called by fix mpm in turns, in each in the order of definition. */
class MPMNodeAction {
 public:
  /** Phases that are in the same place share their momentum first, then what else exchanges it between materials, and
   *  walls, which hold nodes for good, have the last word: else contact would push points through them. Only mouths go through
   *  walls. Nodes that follow others come after all of these. */
  enum Turn { PHASES, EXCHANGE, BETWEEN_BODIES, RIGID_BODIES, WALLS, MOUTHS, TIED_NODES };
  virtual Turn turn() const { return EXCHANGE; }

  /** Collective, at the start of a run: check and prepare; called by fix mpm in its init(). */
  virtual void init_action() {}

  /** Each step before fields renew their blocks: renew_topology() of fields that must do so because
   *  another one does. */
  virtual void couple_topology() {}

  /** The fields that renew their blocks have found those in reach of points, others not yet. */
  virtual void blocks_found() {}

  /** Activate further blocks that the action needs next to those in reach of points. */
  virtual void extend_topology(class MPMField &) {}

  /** Does it look at nodes that points cannot reach? Only if one does, periodic images of these have the values
   *  of their nodes. */
  virtual bool looks_beyond_points() const { return true; }

  /** Does it look at nodes of this block that points of this rank cannot reach, but others'? Only if one does, the rank
   *  gets what others have there. */
  virtual bool looks_at_all(const class MPMField &, const MPM_NS::Grid::Block &) const
  {
    return true;
  }

  /** The blocks of the field are new: lists of nodes must be made again. */
  virtual void topology_changed(class MPMField &) {}

  /** Which velocities the nodes have: those after the momentum equation (STEP), which move points
   *  and count for reactions and work; or others, for which nothing is counted: of the start of the
   *  step (START: USF, USAVG) or the new ones of the points mapped back (MAPPED_BACK: MUSL, USAVG),
   *  which serve the velocity gradient, and with MAPPED_BACK the motion unless an action decides_contact() or the
   *  frame is total, or those of STEP that were changed since (AGAIN: FMPM), or any vectors at nodes before STEP, of
   *  which a solver asks what the action would make of them (TRIAL: only where is_projection(), or with a trial_contact()).
   */
  enum Stage { START, STEP, AGAIN, MAPPED_BACK, TRIAL };

  /** Is what it does to velocities v -> P v + w, where P and w are the same all through the step, and P depends on the
   *  masses of nodes only and is its own square, or becomes so when it is repeated? With the masses M it is an orthogonal
   *  projection, M P = P^T M: what it takes away does no work. */
  virtual bool is_projection() const { return false; }

  /** Contact that is such a projection as long as it is known what touches; null: it is not. */
  virtual class MPMTrialContact *trial_contact() { return nullptr; }

  /** Does the action decide in STEP what of this field is in contact? Velocities that are mapped back do not
   *  know this well enough to move points, but for those whose domains deform (CPDI). */
  virtual bool decides_contact(const class MPMField &) const { return false; }

  /** Change the velocities of the nodes of the fields, and in STEP the old ones of FLIP where
   *  material is held for good (see fix_mpm_boundary.cpp). */
  virtual void act(double dt, Stage) = 0;

  /** Another action has changed the velocities of this stage; called on all actions after each of them. */
  virtual void has_acted(MPMNodeAction & /*other*/, Stage) {}

 protected:
  ~MPMNodeAction() = default;    // owned and deleted as a Fix, whose destructor may throw
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRIAL_CONTACT_H
#define LMP_MPM_TRIAL_CONTACT_H

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Contact of which a solver decides. What touches is held along the normal, by a linear projection of the velocities of nodes as long as
 *  it is known what touches (MPMNodeAction::act() in the stage TRIAL), and has the friction

      t = -mu N s/(|s|^2 + eps^2)^(1/2)

 *  with the force N by which it is pressed and the slip s in the step, along the surface, where eps is small: all but Coulomb's law. Acts in
 *  the stage TRIAL sum up the impulses that they would need along the normal, from which the solver tells N; the stage STEP brings
 *  friction to nodes as it was found last. Vectors are [node][dim]; forces are in units of mass times acceleration. */
class MPMTrialContact {
 public:
  /** The start of a step of duration dt, in statics (rests) or dynamics; eps [distance]. Motions from which there is friction are relative to
   *  that of the wall in the time slip_time. Collective. */
  virtual void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) = 0;
  /** Points that a wall takes with it as a whole in this step, as those in a grip: left[point] becomes the share of its volume that is left outside, if there
   *  are any; else it stays empty. Those inside have no part in the balance of forces, which the wall makes use of from now on. Returns whether there may be such, the
   *  same on all ranks. Not called where a solver cannot leave them out. */
  virtual bool find_carried(MPMField &, std::vector<double> &left) = 0;
  /** Forces on nodes by loads on the shares inside, [node][dim], which the wall bears: they must not work on what it leaves free. */
  virtual void bear_carried(MPMField &, double *force) = 0;
  /** From now on, is what is held that was not at the wall at the start of the step brought to it by acts? Else it is held at rest relative to the wall, as
   *  all the rest. Returns whether there is such, on this rank. */
  virtual bool close_gaps(bool yes) = 0;
  /** Points have moved: an error if any has come into the wall. Collective. */
  virtual void check_arrival() = 0;
  virtual bool has_friction() const = 0;
  /** Is friction as above, with a width eps? Else that of what sticks is left to projections, and decide() tells what slides. */
  virtual bool is_regularised() const { return true; }
  /** Is there anything with friction that is no projection, on this rank? It may change with decide(). */
  virtual bool rubs() const { return has_friction(); }
  /** Sums of impulses begin again with zero. */
  virtual void forget_pushes() = 0;
  /** The sums are those of nodes that are at rest: of the motion of walls alone. */
  virtual void take_base() = 0;
  /** The sums are those of forces f/m for velocities, times scale: they become the forces N. */
  virtual void take_forces(double scale) = 0;
  /** Adds friction after the motion u. */
  virtual void add_friction(const double *u, double *force) = 0;
  /** Adds its change for a change of that motion; the sums are those of changes of forces, times scale. */
  virtual void add_friction_change(const double *du, double scale, double *dforce) = 0;
  /** Adds the part of minus that change that nodes have by their own motion, [node][dim][dim]. */
  virtual void add_friction_blocks(double *blocks) = 0;
  /** Adds the same as one number for each node, such that a body that slips as a whole has the stiffness of all. */
  virtual void add_friction_stiffness(double *stiffness) = 0;
  /** The correction du of the motion has been found, of which all or a part will be made. */
  virtual void correct(const double *du) = 0;
  /** Lets go what the wall would pull after the motion u, and holds what went into the wall. Returns whether this changes
   *  anything, on this rank. unbalanced: the share of forces that is not in balance yet; walls wait until it is 0. */
  virtual bool decide(const double *u, double unbalanced) = 0;
  /** Friction is weakened to that of a larger eps for a correction: 0 ends this. */
  virtual void soften(double eps) = 0;
  /** The sums are those of impulses that bring velocities of the end of a step to what is held, and act once: in the stage STEP. */
  virtual void take_stop() {}
  /** Nodes will have these velocities after the stage STEP, in which they get this share of the friction that was found; valid until then. */
  virtual void foresee_velocities(const double *v, double share) = 0;

 protected:
  ~MPMTrialContact() = default;
};

}    // namespace LAMMPS_NS
#endif

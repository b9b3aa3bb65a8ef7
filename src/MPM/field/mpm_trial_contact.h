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

/** Contact that a solver controls. Material that touches is held along the normal, by a linear
 *  projection of the velocities of nodes as long as it is known what touches (MPMNodeAction::act()
 *  in the stage TRIAL). It has the friction
 *
 *    t = -mu N s/(|s|^2 + eps^2)^(1/2)
 *
 *  where N is the force that presses it, and s the slip along the surface in the step. As eps is
 *  small, this is close to Coulomb's law. Acts in the stage TRIAL sum up the impulses that they
 *  would need along the normal, from which the solver finds N. The stage STEP applies the friction
 *  that was found last to the nodes. Vectors are [node][dim]; forces are in units of mass times
 *  acceleration. */
class MPMTrialContact {
 public:
  /** Start of a step of duration dt, in statics (rests) or dynamics; eps: see above [distance].
   *  Slip is the motion relative to that of the wall in the time slip_time. Collective. */
  virtual void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) = 0;
  /** Finds the points that a wall takes with it as a whole in this step, such as those in a grip.
   *  If there may be such points, left[point] becomes the share of its volume outside of the wall;
   *  else left stays empty. The shares inside have no part in the balance of forces, which the wall
   *  uses from now on. Returns whether there may be such points, the same on all ranks. Not called
   *  where a solver cannot leave them out. */
  virtual bool find_carried(MPMField &, std::vector<double> &left) = 0;
  /** force: forces on nodes by loads on the shares inside, [node][dim], which the wall bears.
   *  Redistributes them so that they do no work on motions that the wall leaves free. */
  virtual void constrain_carried(MPMField &, double *force) = 0;
  /** yes: from now on, acts bring to the wall the material that is held but was not at the wall at
   *  the start of the step. Otherwise acts hold it at rest relative to the wall, like all other
   *  material. Returns whether there is such material on this rank. */
  virtual bool close_gaps(bool yes) = 0;
  /** Call after points have moved: stops with an error if any has come into the wall.
   *  Collective. */
  virtual void check_arrival() = 0;
  /** Does this contact have friction? */
  virtual bool has_friction() const = 0;
  /** Does friction have the form above, with a width eps? Otherwise projections hold what sticks,
   *  and decide() finds what slides. */
  virtual bool is_regularised() const { return true; }
  /** Is there friction on this rank that is not a projection? The answer may change with
   *  decide(). */
  virtual bool rubs() const { return has_friction(); }
  /** Sets the sums of impulses to zero. */
  virtual void clear_impulses() = 0;
  /** The sums now are those of nodes at rest, from the motion of walls alone: keeps them as the
   *  base. */
  virtual void take_base() = 0;
  /** The sums now are those of the velocities f/m times scale: converts them to the forces N. */
  virtual void take_forces(double scale) = 0;
  /** Adds the friction after the motion u. */
  virtual void add_friction(const double *u, double *force) = 0;
  /** Adds the change of friction for a change du of that motion. The sums are those of the changes
   *  of forces, times scale. */
  virtual void add_friction_change(const double *du, double scale, double *dforce) = 0;
  /** Adds minus the change of friction at each node due to its own motion, [node][dim][dim]. */
  virtual void add_friction_blocks(double *blocks) = 0;
  /** Adds the same as one number per node, chosen so that a body that slips as a whole has the
   *  stiffness of all its nodes. */
  virtual void add_friction_stiffness(double *stiffness) = 0;
  /** The correction du of the motion has been found; all or a part of it will be made. */
  virtual void correct(const double *du) = 0;
  /** Releases material that the wall would pull after the motion u, and holds material that went
   *  into the wall. Returns whether this changes anything on this rank. unbalanced: the share of
   *  forces that is not in balance yet; walls wait until it is 0. */
  virtual bool decide(const double *u, double unbalanced) = 0;
  /** Weakens friction to that with a larger eps, for a correction; 0 ends this. */
  virtual void soften(double eps) = 0;
  /** The sums now are those of the impulses that bring velocities at the end of a step to what is
   *  held. They act once, in the stage STEP. */
  virtual void take_stop() {}
  /** Nodes will have the velocities v after the stage STEP, in which they get this share of the
   *  friction that was found. Valid until then. */
  virtual void predict_velocities(const double *v, double share) = 0;

 protected:
  ~MPMTrialContact() = default;
};

}    // namespace LAMMPS_NS
#endif

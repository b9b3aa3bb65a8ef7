/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_TRIAL_CONTACT_H
#define LMP_MPM_TRIAL_CONTACT_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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

/** Interface of a node action that is a projection, or converges to one: lists the nodes that it
 *  ties together. */
class MPMLineTies {
 public:
  /** Adds groups of nodes of a field to two lists. Each group is the number of its nodes followed
   *  by the nodes, with -1 for none. others: groups for which the projection node by node serves as
   *  well, unless they share nodes with ties. */
  virtual void list_ties(const MPMField &, std::vector<int64_t> &ties,
                         std::vector<int64_t> &others) const = 0;

 protected:
  ~MPMLineTies() = default;
};

/** Contact between bodies that are fields of their own, for a solver that has the nodes of all
 *  bodies in its vectors [node][dim]. Contacts are rows of constraints, C v = g. The solver makes
 *  an orthogonal projection of them, together with walls; acts in the stage TRIAL do nothing. A row
 *  is known on all ranks whose points reach one of its nodes, and counts in sums on one of them
 *  (its owner). */
class MPMBodyContact : public MPMTrialContact {
 public:
  /** Sets the place of the first node of each body in vectors. To be called before
   *  begin_trials(). */
  virtual void place_bodies(const std::function<int64_t(const MPMField &)> &first) = 0;
  /** Number of rows that this rank knows. */
  virtual std::size_t nrows() const = 0;
  /** Number of rows in a group; the rows of a group are on the same nodes. */
  virtual int rows_of_group() const = 0;
  /** Identifies a group, with the same value on all ranks. */
  using Key = std::array<int, 7>;
  virtual Key key_of(std::size_t group) const = 0;
  /** Does a group count in sums on this rank? */
  virtual bool owns(std::size_t group) const = 0;
  /** Is this row active now? */
  virtual bool holds(std::size_t row) const = 0;
  /** Calls use(k, c) for the entries c of C in a row, k: place in vectors; also for rows that are
   *  not active. */
  virtual void visit_row(std::size_t row,
                         const std::function<void(int64_t k, double c)> &use) const = 0;
  /** Does anything touch, on this rank? */
  virtual bool touches() const = 0;
  /** rows: [row] C v, or C v - g with_gaps if gaps are closed; zero for rows that are not
   *  active. */
  virtual void find_approach(const double *v, bool with_gaps, double *rows) const = 0;
  /** Sums over the rows r that this rank owns: sums[0]: r . D^-1 r with the diagonal D of C P_w
   *  M^-1 C^T; sums[1]: the same with speeds in place of r, those of v at the nodes of the row (v
   *  null: none), and of the closing of gaps. */
  virtual void add_squares(const double *rows, const double *v, double *sums) const = 0;
  /** The symmetric part of add_friction_change(): the direction of friction changes, normal forces
   *  do not. */
  virtual void add_friction_turn(const double *du, double *dforce) = 0;
  /** Adds factor times the impulses of rows to their sums, see MPMTrialContact. */
  virtual void push(double factor, const double *rows) = 0;

 protected:
  ~MPMBodyContact() = default;
};

}    // namespace LAMMPS_NS
#endif

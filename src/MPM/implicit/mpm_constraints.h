/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_CONSTRAINTS_H
#define LMP_MPM_CONSTRAINTS_H

#include "field/mpm_trial_contact.h"
#include "implicit/mpm_implicit_parts.h"
#include "solve/node_constraints.h"

#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class LatticeRanks;
}

namespace LAMMPS_NS {
class MPMBodyContact;
class MPMTies;

/** Constraints of an implicit step: the effect v -> P v + w of all node actions on velocities, and
 *  the contact and friction among them. Walls do no work on motions that P leaves free, so that P^T
 *  r = 0 is what remains to be solved for a residual r, and P^T = M P M^-1 with the masses M.
 *
 *  Bodies that are separate fields touch each other by fix mpm/contact: C v = g where they touch,
 *  with one row of C for each line of nodes through the interface. If walls map velocities to P_w v
 *  + w, P is the orthogonal projection on the motions that both leave free,
 *      P = P_w - P_w M^-1 C^T S^-1 C P_w,   S = C P_w M^-1 C^T
 *  It uses factors of S (MPMTies), which is close to diagonal. */
class MPMConstraints {
 public:
  /** What is wrong where find() fails. */
  static constexpr const char *CONTRADICTION =
      "walls that meet contradict each other: give them the same velocity, or move faces of "
      "regions to planes of nodes";

  explicit MPMConstraints(MPMSolvedNodes &);
  ~MPMConstraints();

  /** Start of a step of duration dt: takes the contacts of node actions. slip_time, slip, rests:
   *  see MPMTrialContact::begin_trials(). Collective. */
  void begin_step(double dt, double slip_time, double slip, bool rests);
  /** Friction enters the balance with this factor, and acts against u plus this addition, unless
   *  that is empty. */
  void set_friction(double factor, std::vector<double> offset);
  /** Finds P, w, and the closing of gaps. False if walls contradict each other. Collective. */
  bool find();

  /** v <- P v + w. Collective. */
  void act(double *v);
  /** x <- P x. Collective. */
  void project(double *x);
  /** f <- P^T f. Collective. */
  void project_forces(double *f);
  /** free <- P^T (residual plus friction after the motion u), with the reactions that contacts have
   *  in it. Collective. */
  void find_free_forces(const std::vector<double> &u, const std::vector<double> &residual,
                        std::vector<double> &free);
  /** dforce <- dforce minus the change of friction for a change du of the motion, when other forces
   *  change by -dforce. Collective. */
  void subtract_friction_change(const double *du, double asymmetry, double *dforce);
  /** Do linear systems keep pressing forces fixed, so that sliding bodies leave them symmetric? The
   *  balance of forces has friction by the present pressing forces. The iterations converge to it
   *  if friction changes these forces by less than they change friction. asymmetry: of the
   *  tangents. */
  bool fixes_pressing_forces(double asymmetry) const
  {
    return bodies && asymmetry <= MPMImplicitReport::SYMMETRIC;
  }
  /** Adds the stiffness of friction to blocks [node][dim][dim], or as one number for each node. */
  void add_friction_blocks(double *blocks) const
  {
    for (auto *contact : contacts) contact->add_friction_blocks(blocks);
  }
  void add_friction_stiffness(double *stiffness) const
  {
    for (auto *contact : contacts) contact->add_friction_stiffness(stiffness);
  }

  /** Moves u to what walls allow after this share of their way in the step. If that is far, u stays
   *  as it is and the way is added to prescribed: true, on all ranks. Collective. */
  bool meet_walls(std::vector<double> &u, double share, std::vector<double> &prescribed);
  /** Updates the active set of contacts after the motion u; unbalanced: see
   *  MPMTrialContact::decide(). Returns whether it has changed, on all ranks; find() must follow.
   *  Collective. */
  bool update_active_set(const std::vector<double> &u, double unbalanced);
  /** The correction du has been found. */
  void correct(const double *du) const
  {
    for (auto *contact : contacts) contact->correct(du);
  }
  /** Regularizes friction with this slip [distance]; 0: with its own. */
  void soften(double slip_width) const
  {
    for (auto *contact : contacts) contact->soften(slip_width);
  }
  /** Points have moved: walls check the new positions. Collective. */
  void check_positions() const
  {
    for (auto *contact : contacts) contact->check_arrival();
  }

  /** Points that walls carry as a whole, see MPMTrialContact::find_carried(); left [point]: share
   *  of their volume outside of walls. True if there may be any, on any rank. */
  bool find_carried_points(std::vector<double> &left) const;
  /** Walls carry these forces on nodes: finds where they do no work on free motions. */
  void carry(double *force) const
  {
    for (auto *contact : contacts) contact->constrain_carried(nodes.field, force);
  }
  /** Sets the velocities that nodes will have when contacts act on them next, with this share of
   *  friction. */
  void set_final_velocities(const double *v, double share) const
  {
    for (auto *contact : contacts) contact->predict_velocities(v, share);
  }
  /** Contacts get the impulses of the last act(), which brought nodes to rest at walls. */
  void take_stop() const
  {
    for (auto *contact : contacts) contact->take_stop();
  }

  bool any() const { return constrained; }
  bool has_contacts() const { return !contacts.empty(); }
  bool has_friction() const { return with_friction; }
  /** Is the friction of one of these a function of the slip? */
  bool has_regularized_friction() const;
  /** Is there friction now that projections do not include? */
  bool rubs() const { return rubbing; }
  bool between_bodies() const { return bodies; }
  /** Are all contacts projections for the whole step, which neither separate nor rub? */
  bool are_bilateral() const { return bilateral; }
  /** w [node][dim], and the norm of it. */
  const std::vector<double> &velocities() const { return wall; }
  double speed() const { return wall_speed; }
  /** Slip above which friction is that of Coulomb [distance]. */
  double slip_width() const { return slip; }
  /** Friction of the last find_free_forces() [node][dim], if rubs(), and its factor in the
   *  balance. */
  const std::vector<double> &friction_forces() const { return friction; }
  double friction_factor() const { return friction_share; }
  double memory_usage() const
  {
    return MPM_NS::bytes_of(wall, gap_closure, velocity_of_walls, slip_offset, slipped, friction,
                            room);
  }

 private:
  MPMSolvedNodes &nodes;
  double dt = 0.0;
  bool constrained = false;
  std::vector<double> wall;
  double wall_speed = 0.0;
  int repeats = 1;                            // of node actions, until they are a projection
  std::vector<MPMTrialContact *> contacts;    // of walls, and between bodies
  bool bilateral = true;
  std::vector<double> gap_closure;    // displacements by which walls close gaps; empty: none

  // between bodies

  MPMBodyContact *bodies = nullptr;
  bool touching = false;
  std::vector<double> velocity_of_walls;    // w of walls alone
  double speed_of_walls = 0.0;
  std::unique_ptr<MPMTies> ties;

  // friction

  bool with_friction = false, rubbing = false;
  double slip = 0.0;
  double reaction_scale = 1.0;    // of the last projection
  double friction_share = 1.0;
  std::vector<double> slip_offset, slipped, friction, room;

  void act_by_walls(double *v);
  void project_by_walls(double *v);
  void find_touching();
  void find_gap_closure();
  bool is_projection();
  template <class Action>
  void apply_linear(double *x, const std::vector<double> &w, double speed, const Action &action);
  const double *slip_of(const std::vector<double> &u);
  void find_friction(const std::vector<double> &u, const std::vector<double> &residual);
};

/** Finds groups of nodes that walls hold together, along lines through surfaces and faces
 *  (MPMLineTies), and the part of P within each group, from unit vectors of one node of each group
 *  at a time. Where lines of several surfaces chain many nodes together along edges, each node has
 *  the part of the nodes near it. The result has the nodes of this rank, in their order.
 *  Collective. */
std::vector<MPM_NS::NodeTie> find_tied_nodes(MPMSolvedNodes &, MPMConstraints &,
                                             MPM_NS::LatticeRanks &);

}    // namespace LAMMPS_NS
#endif

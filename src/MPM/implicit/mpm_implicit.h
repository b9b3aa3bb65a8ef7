/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_H
#define LMP_MPM_IMPLICIT_H

#include "base/mpm_rows.h"
#include "declare/option.h"
#include "field/mpm_lattice_ranks.h"
#include "field/mpm_node_system.h"
#include "implicit/mpm_implicit_memory.h"
#include "implicit/mpm_loose_nodes.h"
#include "implicit/mpm_tangent.h"
#include "solve/flexible_gmres.h"
#include "solve/krylov.h"
#include "solve/shared_nodes.h"
#include "solve/spline_multigrid.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMBodyContact;
class MPMField;
class MPMNodePressure;
class MPMTies;
class MPMTrialContact;

/** Time integration and solver options of fix mpm/implicit. */
struct MPMImplicitOptions {
  enum Time { STATIC, EULER, NEWMARK, MIDPOINT, ALPHA, HHT };
  Time time = STATIC;
  double gamma = 0.5;    ///< of Newmark's method
  double rho = 0.8;      ///< of alpha and hht: share of the highest frequencies that a step leaves
  double tolerance = 1.0e-8;         ///< tolerance of the ratio of forces
  double absolute = 0.0;             ///< sum of unbalanced forces that is accepted, too [force]
  int64_t most_iterations = 50;      ///< iterations of Newton's method in a step
  int64_t most_parts = 64;           ///< parts of a step that does not converge at once
  int64_t most_linear = 10000;       ///< iterations of the linear solver in each Newton iteration
  double least_accuracy = 1.0e-3;    ///< largest relative residual of linear solutions
  enum Preconditioner { BLOCKS, MULTIGRID };
  Preconditioner preconditioner = BLOCKS;
  /** Slip in a step above which friction is that of Coulomb [distance]; 0: a share of the node spacing. */
  double slip = 0.0;
  /** Stiffness of nodes that points barely reach, relative to the modulus. */
  double stabilize = 0.0;
  bool stabilize_is_given = false;
  /** Stabilize from the first step on that finds no balance otherwise. */
  bool stabilize_if_stuck = false;
  static constexpr double ENOUGH_TO_STABILIZE = 1.0;
  bool report = false;    ///< print residuals of each step to the log

  /** Declares the arguments and keywords of fix mpm/implicit. */
  MPM_NS::Options declare();
  /** Does the method keep accelerations from step to step, in balance with a mean of the forces of both ends of
   *  a step? */
  bool keeps_acceleration() const { return time == ALPHA || time == HHT; }
  /** Coefficients of
   *      u = dt v + dt^2 [(1/2 - beta) a0 + beta a1],   v1 = v + dt [(1 - gamma) a0 + gamma a1]
   *  and the shares of the start of the step in
   *      (1 - of_inertia) m a1 + of_inertia m a0 = (1 - of_forces) f1 + of_forces f0
   *  They are those of Newmark's method, where a0 is f0/m; of the generalized alpha method (J. Chung, G.M.
   *  Hulbert, J. Appl. Mech. 60 (1993) 371); and, with of_inertia = 0, of H.M. Hilber, T.J.R. Hughes, R.L.
   *  Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283. */
  struct Coefficients {
    double beta, gamma, of_inertia, of_forces;
  };
  Coefficients coefficients() const;
  /** Ratio of a change of u to the change of dt times the velocity at the end of the step, to which contact
   *  forces belong. */
  double share_of_end() const;
  /** The part of the motion of a step after which forces enter the balance. */
  double part_of_motion() const { return time == MIDPOINT ? 0.5 : 1.0; }
  /** Does the velocity of points at the end of a step differ from the velocity that they move with? */
  bool moves_by_mean() const { return time != STATIC && time != EULER; }
};

/** Implicit step of one or more fields. The displacements u of their nodes in a step of duration dt solve
 *      f_ext + f_int(s u) + f_walls = c m (u - u*),   u = P u + dt w
 *  c, u*, and s depend on the method of time integration: c = 0 in statics; s = 1, or 1/2 in the midpoint rule;
 *  in the alpha methods, forces are means of those at both ends of the step. f_int(u) is that of MPMTangent,
 *  and v -> P v + w is the effect of all node actions on velocities. Walls do no work on motions that P leaves
 *  free. So with the residual r, which is the balance above without the forces of walls, P^T r = 0 is to be
 *  solved. This is done by Newton's method, with conjugate gradients for its linear systems. Vectors are
 *  [node][dim], one field after the other; forces are in units of mass times acceleration.
 *
 *  Bodies that are separate fields touch each other by fix mpm/contact: C v = g where they touch, with one row
 *  of C for each line of nodes through the interface. If walls map velocities to P_w v + w, P is the orthogonal
 *  projection on the motions that both leave free,
 *      P = P_w - P_w M^-1 C^T S^-1 C P_w,   S = C P_w M^-1 C^T
 *  It uses factors of S (MPMTies), which is close to diagonal.
 *
 *  A pressure of nodes (MPMNodePressure) is found together with u by the same iterations
 *  (mpm_implicit_pressure.cpp). */
class MPMImplicit : private MPMNodeSystem {
 public:
  /** Result of a step, and counts over all steps so far. */
  struct Report {
    bool converged = false;
    int iterations = 0, linear = 0, cuts = 0;
    int made = 0;          ///< number of times that levels, or factors, of a tangent were made
    int indefinite = 0;    ///< iterations in which the energy had no minimum along some direction
    int parts = 0;         ///< parts of the step that converged
    /** There was no balance without the stiffness of nodes that points barely reach. */
    bool stuck = false;
    /** Energy of the stiffness of nodes that points barely reach [mass velocity^2]. */
    double stabilizing = 0.0;
    double reached = 0.0;             ///< share of the step that was reached
    double unbalanced = 0.0;          ///< sum of the unbalanced forces [mass acceleration]
    double ratio = 0.0;               ///< ratio of these to all forces
    double water = 0.0;               ///< the same ratio for the equations of a pressure of nodes
    double asymmetry = 0.0;           ///< asymmetry of the tangents
    std::vector<double> residuals;    ///< sums of forces before each iteration of the last part
    std::string failure;
  };

  /** Accelerations of points [n][dim], for methods that keep them. known: were they found by an earlier step?
   *  MPMImplicit changes both. */
  struct Accelerations {
    MPMRows rows;
    bool known = false;
  };

  /** Several fields are allowed for static and euler, without multigrid, a pressure of nodes, elements, and
   *  points with domains. */
  MPMImplicit(class LAMMPS *, const std::vector<MPMField *> &, const MPMImplicitOptions &,
              Accelerations &);
  ~MPMImplicit() override;

  /** Start of a run. */
  void init();
  /** Solves for u, starting from nodes with the velocities of the momentum equation, and gives the nodes the
   *  velocities from which node actions make those of the step, with all the impulses that these bear. Returns
   *  for each field, in statics, the fictitious kinetic energy of nodes that this rank owns [mass velocity^2]. */
  std::vector<double> step(double dt);
  /** Called after node actions have acted: sets the velocities of the step at the nodes. */
  void set_velocities();
  /** The same, and accounts for works of forces that the ledger does not know. */
  void finish();
  /** Called after points have moved: gives points of affine transfers the difference between their velocities
   *  at the end of the step and the mean velocities that they moved with. */
  void end_motion();
  /** Called after points have moved: walls check the new positions. Collective. */
  void check_contacts();
  const Report &report() const { return now; }
  /** Timed parts of a step: forces of trial motions, tangents, preconditioners, and linear systems. Times are
   *  in seconds of this rank since init(). */
  enum Part { FORCES, TANGENTS, PRECONDITIONERS, SYSTEMS, NPARTS };
  double seconds_of(Part which) const { return seconds[which]; }
  /** Discards what earlier steps have learned, for steps that must continue as from a restart file, which does
   *  not store it. */
  void forget()
  {
    memory.clear();
    large = false;
  }
  double memory_usage() const;

 private:
  /** A field and its part of the vectors. */
  struct Member {
    MPMField &field;
    MPMTangent tangent;
    std::unique_ptr<MPMLooseNodes> loose;    // null: loose nodes have no stiffness of their own
    int64_t first = 0;                       // index of the first of its nodes

    Member(class LAMMPS *, MPMField &);
    int64_t end() const;
    bool owns(int64_t n) const;
  };
  static std::vector<std::unique_ptr<Member>> make_members(class LAMMPS *,
                                                           const std::vector<MPMField *> &);

  MPMField &field;    // the first field
  const MPMImplicitOptions &options;
  Accelerations &kept;
  double stabilize;    // MPMImplicitOptions::stabilize, or the value that a step has needed
  const std::vector<std::unique_ptr<Member>> members;
  MPMTangent &tangent;    // tangent of the first field
  MPM_NS::ConjugateGradients solver;
  MPM_NS::FlexibleGMRES general{100};
  MPMLatticeRanks ranks;
  std::unique_ptr<MPM_NS::SplineMultigrid> multigrid;    // null: precondition by blocks of nodes
  bool by_levels = false;                                // is multigrid the preconditioner now?
  /** Are pressures averaged around each point? The system is then asymmetric where moduli of these points
   *  differ. */
  bool averages() const { return field.options.averages_stress(); }
  Report now;
  double seconds[NPARTS] = {};

  /** Adds its lifetime to the time of a part, without the time of other clocks within it. */
  class Clock {
   public:
    Clock(MPMImplicit &, Part);
    ~Clock();

   private:
    MPMImplicit &of;
    const Part which;
    Clock *const outer;
    const double start;
    double within = 0.0;
  };
  Clock *clock = nullptr;    // the running clock

  // of the present step

  double dt = 0.0, inertia = 0.0;    // c
  double part = 1.0;                 // s
  double late = 1.0;                 // share of the forces that belongs to the end of the step
  bool constrained = false;
  double wall_speed = 0.0;                    // largest of w
  std::vector<MPMTrialContact *> contacts;    // of walls, and between bodies
  MPMBodyContact *tied = nullptr;             // contact between bodies
  bool touching = false;                      // do bodies touch?
  std::vector<double> of_walls;               // w of walls alone
  double speed_of_walls = 0.0;
  std::unique_ptr<MPMTies> ties;               // solves the contact equations between bodies
  bool has_friction = false;                   // does one of the contacts have friction?
  bool rubs = false;                           // is there friction that projections do not include?
  double slip = 0.0;                           // slip above which friction is that of Coulomb
  double of_pushes = 1.0;                      // scale of the last projection
  double reached_by_walls = 0.0, aim = 1.0;    // statics: shares of wall motion in this step
  std::vector<double> closing;    // displacements by which walls close gaps; empty: none
  std::vector<double> friction;
  int repeats = 1;             // repetitions of node actions until they are a projection
  std::vector<double> mass;    // [node]
  // nodes with a mass, owned ones first; vectors are zero at all others
  std::vector<int64_t> heavy;
  std::size_t heavy_owned = 0;
  std::vector<double *> heavy_records;    // records of these nodes
  bool by_reach = false;                  // are forces of nodes weighted by reach?
  std::vector<double> reach;              // [node] number of points there, at most 1
  std::vector<double> before, explicit_velocity, outer, inner, from, wall, held;
  std::vector<double> start, acceleration;    // at the start, with walls, for dynamics
  // with late < 1: excess of the forces of the start over outer, times their share
  std::vector<double> early;
  std::vector<double> next;                   // acceleration at the end, for methods that keep it
  std::vector<double> velocity;               // velocity that points move with
  std::vector<double> partial;                // s u
  std::vector<double> of_nodes, of_points;    // for affine points that move with the mean velocity
  std::vector<double> push;    // impulses that do not come from the forces of the start of the step
  std::vector<double> loads,
      more_loads;    // loads that follow points: at the start, and their change at the end
  std::vector<double> loose_forces;    // forces of nodes that points barely reach
  std::vector<double> residual, free, change, correction, trial, blocks, room, allowed;

  // contact in methods of second order (mpm_implicit_impact.cpp)

  bool impacts = false;      // walls separate, or have friction
  double rub_share = 1.0;    // share of the friction by contact forces in the balance
  // addition to motions after which they slip as at the end of the step
  std::vector<double> offset;
  std::vector<double> slide;    // u with this addition
  std::vector<double> mean;     // excess of the accelerations that points bring over those of nodes
  std::vector<double> ending, stopped;    // velocities at the end, before and after walls
  bool accelerates_by_friction() const;
  void begin_impacts();
  const double *slide_of(const std::vector<double> &u);
  double share_of_contact() const;
  void end_impacts(const std::vector<double> &u);

  // bodies that nothing restrains (mpm_implicit_free.cpp)

  int find_bodies(std::vector<int> &body);
  void find_free_bodies();

  // information kept from step to step (mpm_implicit_quasi.cpp)

  MPMImplicitMemory memory;
  MPM_NS::SharedNodes shared{ranks};    // nodes with a mass
  bool large = false;                   // too many unknowns for factors: multigrid levels are used
  std::vector<double> of_ranks, of_owned, of_system, of_everyone, rotations;
  std::vector<double> left, moved, solved, corrected;    // vectors of shared nodes
  // share of the last correction that was made; 0: none that the factors have not learned from yet
  double taken = 0.0;
  // [heavy][dim][dim] rotation of the body since the factors were made; empty: none
  std::vector<double> turns;
  bool can_keep() const;
  void recall();
  bool walls_are_same(const std::vector<double> &walls) const;
  void gather_heavy(const std::vector<double> &of_all, std::vector<double> &of_shared);
  void foresee(std::vector<double> &u);
  void remember(const std::vector<double> &u);
  bool make_factors(const std::vector<double> &u);
  void turn_from_factors();
  void share_forces();
  void find_correction();
  void learn();
  bool go_on(std::vector<double> &u);
  bool go_on_from_before(std::vector<double> &u);

  // with a pressure of nodes

  class Joint;
  std::unique_ptr<Joint> joint;    // null: there is none
  double enough_force = 0.0;       // force that may be left, from the last residual
  bool search_jointly(std::vector<double> &u, double &size);

  std::vector<double> of_rank, of_member;

  int64_t nreals() const { return (int64_t) mass.size() * width; }
  int64_t size() const override { return nreals(); }
  void products(int n, const double *const *a, const double *const *b, double *value) override;
  int64_t first_of(const MPMField &) const;
  template <class Use> void each_record(const Use &use);
  template <class Use> void each_owned(const Use &use) const;
  template <class Use> void each_entry(const Use &use) const;
  void change_of_forces(const double *du, double *dforce);
  bool find_forces(const double *u, double *force, double &carried);
  double linearize(const double *u);
  void take_nodes();
  void give_back_start();
  void begin_loose();
  void account_loose(const std::vector<double> &u);
  void find_heavy();
  void find_reach();
  void find_constraints();
  void act(double *velocities);
  void act_by_walls(double *velocities);
  void take_by_walls(double *velocities);
  void find_touching();
  void project(double *x);
  void find_friction(const std::vector<double> &u);
  bool holds_bounds() const;
  bool find_carried();
  void bear_carried();
  bool decide_contact(std::vector<double> &u, double unbalanced);
  void find_closing();
  bool meet_walls(std::vector<double> &u, double share);
  double negligible_forces(const std::vector<double> &u, double stiffness) const;
  bool close(std::vector<double> &u, const std::vector<double> &du, double &size, double &share);
  void project_forces(double *f);
  double size_of(const std::vector<double> &, bool of_corners = false) const;
  bool find_residual(const std::vector<double> &u, double &size,
                     const std::vector<double> *vector = nullptr, double *along = nullptr);
  bool search(std::vector<double> &u, double slope, double &size);
  void find_blocks();
  void prepare_blocks();
  void prepare_levels();
  void find_ties(std::vector<MPM_NS::SplineMultigrid::Tie> &);
  void fill_levels();
  MPM_NS::SolveReport solve_general(const double *b, double *x, const MPM_NS::SolveGoal &);
  MPM_NS::SolveReport solve(const double *b, double *x, const MPM_NS::SolveGoal &);
  enum Outcome { CONVERGED, FAILED, HOPELESS };    // HOPELESS: parts of the step would fail, too
  Outcome newton(std::vector<double> &u, int most_iterations);
  void approach(std::vector<double> &u);
  void find_loads(const std::vector<double> &u);
  const double *part_of(const std::vector<double> &u);
  void find_end_of_motion();
  void find_end_of_points(Member &);
  void end_motion_of(MPMField &);
  void find_accelerations();
  void keep_accelerations();
  void account();
  std::vector<double> give_back(const std::vector<double> &u);

  void apply(const double *x, double *y) override;
  void precondition(const double *r, double *z) override;
};

}    // namespace LAMMPS_NS
#endif

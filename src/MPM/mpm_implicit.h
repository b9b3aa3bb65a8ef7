/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_IMPLICIT_H
#define LMP_MPM_IMPLICIT_H

#include "declare/option.h"
#include "mpm_implicit_memory.h"
#include "mpm_lattice_ranks.h"
#include "mpm_loose_nodes.h"
#include "mpm_node_system.h"
#include "mpm_rows.h"
#include "mpm_tangent.h"
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

/** How a field is stepped. */
struct MPMImplicitOptions {
  enum Time { STATIC, EULER, NEWMARK, MIDPOINT, ALPHA, HHT };
  Time time = STATIC;
  double gamma = 0.5;           ///< of Newmark's method
  double rho = 0.8;             ///< of alpha and hht: what a step leaves of the highest frequencies
  double tolerance = 1.0e-8;    ///< of the ratio of forces
  double absolute = 0.0;        ///< sum of unbalanced forces that is as good [force]
  int64_t most_iterations = 50;      ///< of Newton's method in a step
  int64_t most_parts = 64;           ///< of a step, where it does not converge at once
  int64_t most_linear = 10000;       ///< of the linear solver in each of these
  double least_accuracy = 1.0e-3;    ///< of linear solutions
  enum Preconditioner { BLOCKS, MULTIGRID };
  Preconditioner preconditioner = BLOCKS;
  double slip =
      0.0;    ///< in a step, from which on friction is that of Coulomb [distance]; 0: a share of the node spacing
  double stabilize = 0.0;    ///< stiffness of nodes that points barely reach, over the modulus
  bool stabilize_is_given = false;
  bool stabilize_if_stuck = false;    ///< from the first step on that finds no balance without
  static constexpr double ENOUGH_TO_STABILIZE = 1.0;
  bool report = false;    ///< residuals of each step go to the log

  MPM_NS::Options declare();
  /** Are accelerations kept from step to step, in balance with a mean of the forces of both ends? */
  bool keeps_acceleration() const { return time == ALPHA || time == HHT; }
  /** The coefficients of u = dt v + dt^2 [(1/2 - beta) a0 + beta a1] and v1 = v + dt [(1 - gamma) a0 + gamma a1], and the shares of the
   *  start of the step in (1 - of_inertia) m a1 + of_inertia m a0 = (1 - of_forces) f1 + of_forces f0: those of Newmark, with which
   *  a0 is f0/m; and of the generalised alpha method (J. Chung, G.M. Hulbert, J. Appl. Mech. 60 (1993) 371) and, with
   *  of_inertia = 0, that of H.M. Hilber, T.J.R. Hughes, R.L. Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283. */
  struct Coefficients {
    double beta, gamma, of_inertia, of_forces;
  };
  Coefficients coefficients() const;
  /** Of a change of u, over that of dt times the velocity that contact forces belong to: that of the end of the step. */
  double share_of_end() const;
  /** The part of the motion of a step after which forces are those of the balance. */
  double part_of_motion() const { return time == MIDPOINT ? 0.5 : 1.0; }
  /** Do points have another velocity at the end of a step than they move with? */
  bool moves_by_mean() const { return time != STATIC && time != EULER; }
};

/** The implicit step of one or more fields: displacements u of their nodes in a step of duration dt for which

      f_ext + f_int(s u) + f_walls = c m (u - u*),   u = P u + dt w

   where c, u*, and s are those of the method of time integration (c = 0: statics; s = 1, or 1/2 in the mid-point rule; in the alpha methods forces are means of
   those of both ends of the step), f_int(u) is that of MPMTangent, and v -> P v
   + w is what all node actions make of velocities. Walls do no work on what P leaves free, so that with the right side
   P^T r = 0 is to be solved for the residual r without them. Newton's method, whose steps are solved for by conjugate
   gradients. Vectors are [node][dim], those of one field after the other; forces are in units of mass times acceleration.

   Bodies that are fields of their own touch each other by fix mpm/contact: C v = g for what touches, with a row of C for each line of nodes through the
   interface. Where walls make P_w v + w of velocities, P is the orthogonal projection on what both leave free,

      P = P_w - P_w M^-1 C^T S^-1 C P_w,   S = C P_w M^-1 C^T

   by factors of S (MPMTies), which is next to diagonal.

   Where there is a pressure of nodes (MPMNodePressure), it is found with u by the same iterations (mpm_implicit_pressure.cpp). */
class MPMImplicit : private MPMNodeSystem {
 public:
  /** What became of a step, and of all steps so far. */
  struct Report {
    bool converged = false;
    int iterations = 0, linear = 0, cuts = 0;
    int made = 0;          ///< levels, or factors, of a tangent
    int indefinite = 0;    ///< iterations in which the energy had no minimum along some way
    int parts = 0;         ///< of the step, that converged
    bool stuck =
        false;    ///< there was no balance without a stiffness of nodes that points barely reach
    double stabilizing = 0.0;    ///< energy of nodes that points barely reach [mass velocity^2]
    double reached = 0.0;        ///< share of the step
    double unbalanced = 0.0;     ///< sum of forces that are left [mass acceleration]
    double ratio = 0.0;          ///< to all forces
    double water = 0.0;          ///< of what a pressure of nodes leaves of its equations, the same
    double asymmetry = 0.0;      ///< of the tangents
    std::vector<double> residuals;    ///< sums of forces before each iteration of the last part
    std::string failure;
  };

  /** Accelerations of points [n][dim], for methods that keep them, and have they been found by a step before? The object changes both. */
  struct Accelerations {
    MPMRows rows;
    bool known = false;
  };

  /** Several fields: static and euler, without multigrid, a pressure of nodes, elements, and points with domains. */
  MPMImplicit(class LAMMPS *, const std::vector<MPMField *> &, const MPMImplicitOptions &,
              Accelerations &);
  ~MPMImplicit() override;

  /** Start of a run. */
  void init();
  /** The nodes have the velocities of the momentum equation: find u, and give them what node actions make the velocities
   *  of the step, with all the impulses that they bear. Returns, in statics, the kinetic energy that there is not, of nodes
   *  that this rank owns [mass velocity^2], for each field. */
  std::vector<double> step(double dt);
  /** Node actions have acted: nodes get the velocities of the step. */
  void set_velocities();
  /** That, and works of forces that the ledger does not know. */
  void finish();
  /** Points have moved: those of affine transfers get what their velocities at the end of the step have more than the mean ones that they
   *  have moved with. */
  void end_motion();
  /** Points have moved: walls look at where they are. Collective. */
  void check_contacts();
  const Report &report() const { return now; }
  /** Parts of a step whose time is taken: forces of trial motions, tangents, what preconditions, and linear systems; seconds of this rank since init(). */
  enum Part { FORCES, TANGENTS, PRECONDITIONERS, SYSTEMS, NPARTS };
  double seconds_of(Part which) const { return seconds[which]; }
  /** Steps to come begin without what those before have told: for those of a restart file, which do not know it. */
  void forget()
  {
    memory.clear();
    large = false;
  }
  double memory_usage() const;

 private:
  /** A field, and its part of the vectors. */
  struct Member {
    MPMField &field;
    MPMTangent tangent;
    std::unique_ptr<MPMLooseNodes> loose;    // null: they have no stiffness of their own
    int64_t first = 0;                       // of its nodes

    Member(class LAMMPS *, MPMField &);
    int64_t end() const;
    bool owns(int64_t n) const;
  };
  static std::vector<std::unique_ptr<Member>> make_members(class LAMMPS *,
                                                           const std::vector<MPMField *> &);

  MPMField &field;    // the first one
  const MPMImplicitOptions &options;
  Accelerations &kept;
  double stabilize;    // MPMImplicitOptions::stabilize, or what a step has needed
  const std::vector<std::unique_ptr<Member>> members;
  MPMTangent &tangent;    // of the first one
  MPM_NS::ConjugateGradients solver;
  MPM_NS::FlexibleGMRES general{100};
  MPMLatticeRanks ranks;
  std::unique_ptr<MPM_NS::SplineMultigrid> multigrid;    // null: blocks of nodes
  bool by_levels = false;                                // does it precondition now?
  /** Are pressures those around each point? The system is not symmetric then, by what moduli of these points differ. */
  bool averages() const { return field.options.averages_stress(); }
  Report now;
  double seconds[NPARTS] = {};

  /** Adds the time of its life to that of a part, which others within do not. */
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
  Clock *clock = nullptr;    // that runs

  // of the present step

  double dt = 0.0, inertia = 0.0;    // c
  double part = 1.0;                 // s
  double late = 1.0;                 // share of the end of the step in forces
  bool constrained = false;
  double wall_speed = 0.0;                    // largest of w
  std::vector<MPMTrialContact *> contacts;    // of walls, and between bodies
  MPMBodyContact *tied = nullptr;             // the latter one
  bool touching = false;                      // does anything touch by that?
  std::vector<double> of_walls;               // w of walls alone
  double speed_of_walls = 0.0;
  std::unique_ptr<MPMTies> ties;               // solves for what they need
  bool has_friction = false;                   // one of them
  bool rubs = false;                           // and has friction that projections do not bear
  double slip = 0.0;                           // from which on it is that of Coulomb
  double of_pushes = 1.0;                      // scale of the last projection
  double reached_by_walls = 0.0, aim = 1.0;    // statics: shares of their way in this step
  std::vector<double> closing;    // what walls bring to them, displacements; empty: nothing
  std::vector<double> friction;
  int repeats = 1;             // of node actions, until they are a projection
  std::vector<double> mass;    // [node]
  std::vector<int64_t>
      heavy;    // nodes with a mass, those that this rank owns first; vectors are zero at all others
  std::size_t heavy_owned = 0;
  std::vector<double *> heavy_records;    // those of these nodes
  bool by_reach = false;                  // do nodes count by what they are for points?
  std::vector<double> reach;              // [node] number of points there, at most 1
  std::vector<double> before, explicit_velocity, outer, inner, from, wall, held;
  std::vector<double> start, acceleration;    // with walls, for dynamics
  std::vector<double>
      early;    // with late < 1: what forces of the start have more than outer, by their share
  std::vector<double> next;                   // acceleration of the end, of methods that keep it
  std::vector<double> velocity;               // that points move with
  std::vector<double> partial;                // s u
  std::vector<double> of_nodes, of_points;    // of affine points that move with the mean velocity
  std::vector<double> push;    // impulses that are not of the forces of the start of the step
  std::vector<double> loads,
      more_loads;    // that follow points: at the start, and what is new at the end
  std::vector<double> loose_forces;    // of nodes that points barely reach
  std::vector<double> residual, free, change, correction, trial, blocks, room, allowed;

  // contact in methods of second order (mpm_implicit_impact.cpp)

  bool impacts = false;          // walls separate, or have friction
  double rub_share = 1.0;        // of friction by the forces that press, in the balance
  std::vector<double> offset;    // what motions have more that slip like the end of the step
  std::vector<double> slide;     // u with this
  std::vector<double> mean;      // accelerations that points bring, which they have more than nodes
  std::vector<double> ending, stopped;    // velocities of the end, before and after walls
  bool accelerates_by_friction() const;
  void begin_impacts();
  const double *slide_of(const std::vector<double> &u);
  double share_of_contact() const;
  void end_impacts(const std::vector<double> &u);

  // bodies that nothing holds (mpm_implicit_free.cpp)

  int find_bodies(std::vector<int> &body);
  void find_free_bodies();

  // from step to step (mpm_implicit_quasi.cpp)

  MPMImplicitMemory memory;
  MPM_NS::SharedNodes shared{ranks};    // those with a mass
  bool large = false;                   // too many unknowns for factors: there are levels
  std::vector<double> of_ranks, of_owned, of_system, of_everyone, rotations;
  std::vector<double> left, moved, solved, corrected;    // of shared nodes
  double taken =
      0.0;    // share of the last correction that was made; 0: none that factors have not learnt from
  std::vector<double> turns;    // [heavy][dim][dim] of the body since the factors; empty: none
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
  double enough_force = 0.0;       // what may be left, of the last residual
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
  enum Outcome { CONVERGED, FAILED, HOPELESS };    // the latter: parts of the step would fail, too
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

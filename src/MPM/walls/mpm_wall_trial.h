/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_TRIAL_H
#define LMP_MPM_WALL_TRIAL_H

#include "field/mpm_trial_contact.h"
#include "pointers.h"
#include "walls/mpm_wall_contact.h"

#include <vector>

namespace LAMMPS_NS {
class MPMWallContactSearch;
class MPMWall;
class MPMWallNodes;
class MPMWallReaction;

/** Contact of a wall that an implicit solver decides, as an active set of constraints. */
class MPMWallTrial : protected Pointers, public MPMTrialContact {
 public:
  MPMWallTrial(class LAMMPS *lmp, MPMWall &wall, std::vector<MPMWallNodes> &fields,
               MPMWallContactSearch &search) :
      Pointers(lmp),
      wall(wall), fields(fields), search(search)
  {
  }

  /** One for each line at a face, crossing, node, and approach, in this order. */
  std::vector<MPMContactConstraint> constraints;

  /** Start of a run, without trials until they begin. */
  void begin_run() { in_trials = is_due = false; }
  /** Does a solver decide the contact of these nodes? */
  bool decides(const MPMWallNodes &) const;
  /** Has a solver begun trials in this run? */
  bool has_begun() const { return in_trials; }
  /** Has a solver found friction that has not acted in this step? True once. */
  bool take_friction()
  {
    const bool was_due = is_due;
    is_due = false;
    return was_due;
  }
  /** The friction acts on the nodes at the end of the step, before walls act. */
  void apply_friction(MPMWallReaction &);
  /** Holds the material that was not at the wall at the start of the step. */
  void act_on_approaches(MPMWallReaction &, MPMWallNodes &);
  double memory_usage() const;

  void begin_trials(MPMField &, double dt, double slip_time, double eps, bool rests) override;
  bool close_gaps(bool yes) override;
  void check_arrival() override;
  bool find_carried(MPMField &, std::vector<double> &) override;
  void constrain_carried(MPMField &, double *force) override;
  bool has_friction() const override;
  void clear_impulses() override
  {
    for (auto &c : constraints) c.impulse = 0.0;
  }
  void take_base() override
  {
    for (auto &c : constraints) c.base = c.impulse;
  }
  void take_forces(double scale) override
  {
    for (auto &c : constraints) c.force = (c.impulse - c.base) / scale;
  }
  void add_friction(const double *u, double *force) override;
  void add_friction_change(const double *du, double scale, double *dforce) override;
  void add_friction_blocks(double *blocks) override;
  void add_friction_stiffness(double *stiffness) override;
  void correct(const double *du) override;
  bool decide(const double *u, double unbalanced) override;
  void soften(double by) override { soft = by; }
  void predict_velocities(const double *v, double share) override
  {
    final_velocity = v;
    friction_share = share;
    is_due = has_friction();
  }

 private:
  MPMWall &wall;
  std::vector<MPMWallNodes> &fields;
  MPMWallContactSearch &search;

  bool in_trials = false, is_due = false;
  MPMField *field = nullptr;                 // of the solver
  const double *final_velocity = nullptr;    // of nodes at the end of the step
  double dt = 0.0, slip_time = 0.0, eps = 0.0, soft = 0.0;
  double friction_share = 1.0;    // share of the friction that nodes get
  int rounds = 0;                 // rounds of decisions in this step
  // lines that are held move to the wall now; else they are at rest relative to it
  bool closes = false;
  std::vector<double> clearance;    // [point][face] from the wall at the start of the step

  MPMWallNodes &nodes();
  void list_constraints(MPMWallNodes &);
  void start_approaches(MPMWallNodes &, bool touched, bool rests);
  void act_on_approach(MPMWallReaction &, MPMWallNodes &, const struct MPMApproach &,
                       MPMContactConstraint &);
  bool is_deep(const MPMWallNodes &, std::size_t node) const;
  void find_clearance(MPMWallNodes &);
  double length(const MPMContactConstraint &) const;
  template <class Use> void visit_rubbing(const Use &use);
  void change_of_direction(const MPMContactConstraint &, const double *slip, double *change) const;
  void find_slip(const MPMContactConstraint &, const double *u, double time, double *slip,
                 double &away) const;
};

}    // namespace LAMMPS_NS

#endif

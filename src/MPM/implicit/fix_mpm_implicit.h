/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/implicit,FixMPMImplicit);
// clang-format on
#else

#ifndef LMP_FIX_MPM_IMPLICIT_H
#define LMP_FIX_MPM_IMPLICIT_H

#include "base/mpm_state.h"
#include "field/mpm_doubts.h"
#include "field/mpm_physics.h"
#include "implicit/mpm_implicit.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** Implicit steps of a field, or of several fields in contact. In place of the explicit momentum
 *  equation, it solves for the velocities of nodes with the stress at the end of the step, with
 *  inertia or as a sequence of equilibrium states. */
class FixMPMImplicit : public FixMPMState, public MPMPhysics, private MPMImplicitOptions {
 public:
  FixMPMImplicit(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_RUN; }
  void init() override;
  void setup(int) override;
  void post_run() override;
  double compute_scalar() override { return last[RATIO]; }
  double compute_vector(int) override;
  double memory_usage() override
  {
    return FixMPMState::memory_usage() + (solver ? solver->memory_usage() : 0.0);
  }
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  bool needs_others() const override { return true; }
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool looks_beyond_points() const override { return false; }
  /** True except for the mid-point rule, which keeps angular momentum with moving least squares. */
  bool brings_to_rest() const override { return time.kind != MPMTimeMethod::MIDPOINT; }
  std::vector<Account> accounts() const override;
  void account(double *values) const override;

 private:
  std::vector<MPMField *> fields;
  std::unique_ptr<MPMImplicit> solver;
  MPMDoubts doubts;
  MPMPointAccelerations kept;    // of points, for methods that need those of the previous step
  enum { STEPS, NEWTON, LINEAR, CUTS, INDEFINITE, MADE, STUCK, NTOTAL };
  double total[NTOTAL] = {};    // counts so far
  enum {
    LAST_NEWTON,
    LAST_LINEAR,
    LAST_CUTS,
    UNBALANCED,
    ASYMMETRY,
    RATIO,
    PARTS,
    LAST_INDEFINITE,
    STABILIZING,
    NLAST
  };
  double last[NLAST] = {};    // of the last step, also in a previous run
  // static: kinetic energy taken from points, and work in a step; this rank's share [energy]
  double taken[2] = {};
  double at_start[NTOTAL] = {};       // total[] at the start of this run
  double seconds = 0.0;               // time spent in the solver in this run
  bool warned_of_rotation = false;    // of bodies that have turned, with stress mls

  /** Does an implicit step of this field solve for a pressure of this physics, too? */
  static bool has_pressure(MPMPhysics *, const MPMField &);
  void check_bodies(const MPMPlan &) const;
  void check_field(const MPMPlan &, MPMField &) const;
  void check_physics(const MPMPlan &) const;
  void check_transfer(MPMField &) const;
  void check_stabilization(const MPMPlan &, MPMField &) const;
  void check_elements(const MPMPlan &, MPMField &) const;
  void check_actions(const MPMPlan &, const MPMField &) const;
  bool may_stabilize(const MPMField &) const;
  void choose_stabilize(const MPMPlan &);
  void step();
  void rest();
};

}    // namespace LAMMPS_NS
#endif
#endif

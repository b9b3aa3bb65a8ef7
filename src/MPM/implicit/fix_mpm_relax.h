/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/relax,FixMPMRelax);
// clang-format on
#else

#ifndef LMP_FIX_MPM_RELAX_H
#define LMP_FIX_MPM_RELAX_H

#include "declare/option.h"
#include "field/mpm_physics.h"
#include "fix.h"
#include "implicit/mpm_kinetic_damping.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/relax. */
struct MPMRelaxOptions {
  double tolerance = 0.0;    ///< for the ratio of unbalanced to carried forces
  int64_t look_every = 10;
  bool stops = true;

  MPM_NS::Options declare();
};

/** Brings all material points to rest in equilibrium by dynamic relaxation with kinetic damping:
 *  velocities are set to zero whenever the kinetic energy has passed a maximum, until the forces on
 *  the nodes are balanced (P.A. Cundall, 1976; M.R. Barnes, Computers and Structures 30, 685-695,
 *  1988). */
class FixMPMRelax : public Fix, public MPMPhysics, private MPMRelaxOptions {
 public:
  FixMPMRelax(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::END_OF_STEP | FixConst::POST_RUN; }
  void init() override;
  void setup(int) override;
  void end_of_step() override;
  void post_run() override;
  double compute_scalar() override { return ratio < 1.0 ? ratio : 1.0; }
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /** Does the run end when equilibrium is reached? */
  bool ends_runs() const { return stops; }

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool brings_to_rest() const override { return true; }
  std::vector<Account> accounts() const override
  {
    return {{"rest", false}, {"work at rest", false, true}};
  }
  void account(double *values) const override
  {
    for (int k = 0; k < 2; k++) values[k] -= taken[k];
  }

 private:
  enum { RUNNING, LAST_STEP, ENDED } state = RUNNING;
  MPMKineticDamping damping;    // by the energy of nodes of all ranks [energy]
  double unbalanced = 0.0;      // sum of forces on nodes, on all ranks [force]
  double carried = 0.0;         // sum of forces on nodes by the stress of points [force]
  double ratio = 0.0;           // unbalanced over carried; UNKNOWN before the first check
  // energies taken so far, this rank's share; in restart files of all ranks: kinetic energy, and
  // work in a step
  double taken[2] = {0.0, 0.0};
  bool falls = false;    // does the kinetic energy fall in this step?
  std::vector<MPMField *> fields;
  bool may_start_by_half = false;
  bool warned_of_rotation = false;    // of bodies that have turned, with stress mls
  /** The last time in this run that the ratio was clearly smaller than ever before. */
  struct {
    double ratio, step, nrests;
  } best = {};
  double start = 0.0, rests_before = 0.0;    // numbers of steps and rests before this run
  double look_at = 0.0;                      // steps of this run
  bool warned_of_stall = false, warned_of_bending = false;
  double length = 0.0, thickness = 0.0;    // of all bodies together, at the start of the run

  void look();
  void rest();
  bool can_start_by_half(const MPMPlan &) const;
  void start_by_half();
  double force_of_stress() const;
  void measure();
  void look_for_bending();
  void look_for_stall();
  bool has_few_points() const;
  bool any_has(bool (*)(const struct MPMFieldOptions &)) const;
  std::string remedy() const;
};

}    // namespace LAMMPS_NS
#endif
#endif

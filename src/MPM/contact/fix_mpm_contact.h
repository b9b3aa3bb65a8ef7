/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/contact,FixMPMContact);
// clang-format on
#else

#ifndef LMP_FIX_MPM_CONTACT_H
#define LMP_FIX_MPM_CONTACT_H

#include "base/mpm_state.h"
#include "contact/mpm_cohesive_interface.h"
#include "contact/mpm_contact_bodies.h"
#include "contact/mpm_contact_search.h"
#include "contact/mpm_contact_solver.h"
#include "contact/mpm_contact_trial.h"
#include "contact/mpm_node_contact.h"
#include "declare/option.h"
#include "field/mpm_coupling.h"
#include "field/mpm_friction_heat.h"
#include "field/mpm_node_action.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
/** Keywords of fix mpm/contact. */
struct MPMContactOptions : MPMContactLaw, MPMContactSearchOptions {
  MPMFrictionHeatOptions heat;
  std::string bonded;    ///< ID of a region; empty: all of the interface

  MPM_NS::Options declare();
};

/** Contact between bodies, each a field (fix mpm), at the nodes that they share on one lattice. */
class FixMPMContact :
    public FixMPMState,
    public MPMNodeAction,
    public MPMRubbing,
    public MPMCoupling,
    private MPMContactOptions {
 public:
  Turn turn() const override { return BETWEEN_BODIES; }
  FixMPMContact(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  double coefficient() const override { return friction.kinetic; }
  bool loses_heat() const override { return friction.kinetic > 0.0 && !heat.said; }
  bool gives_heat() const override { return heat.heats(); }
  void init() override;
  void init_action() override;
  void post_run() override { solver.report_unsolved(id); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override { return report.work(); }
  double compute_array(int row, int column) override { return report.at(row, column); }
  double memory_usage() override;

  void couple_topology() override { bodies.couple_topology(); }
  void blocks_found() override { bodies.blocks_found(); }
  void extend_topology(MPMField &field) override { bodies.extend_topology(field); }
  bool decides_contact(const MPMField &) const override;
  void act(double dt, Stage) override;
  MPMTrialContact *trial_contact() override { return in_implicit_steps ? &trial : nullptr; }

  /** Does this fix treat contact between these two fields (IDs)? */
  bool couples(const std::string &a, const std::string &b) const override;
  /** Is this field (ID) one of the bodies? */
  bool touches(const std::string &name) const override;
  /** Does this fix have the same contact law and parameters as another one? */
  bool has_law_of(const FixMPMContact &) const;

 private:
  std::vector<std::string> names;
  MPMContactBodies bodies;
  MPMContacts contacts;
  MPMContactSearch search;
  MPMContactSolver solver;    // of explicit steps
  MPMContactTrial trial;      // of implicit steps
  MPMContactReport report;
  std::unique_ptr<MPMFrictionHeat> heating;           // null: not requested
  std::unique_ptr<MPMCohesiveInterface> interface;    // null: bodies do not cohere
  bool is_bonded = false;                             // has the first step bonded them?
  bool in_implicit_steps = false;                     // does a solver do the steps of this run?
  bigint steps = 0;                                   // number of steps of this fix in this run

  void find_bodies();
  void check_bodies();
  void check_refined(MPMContactBody &);
  void check_other_contacts() const;
  void refuse_implicit_steps() const;
  void check_cohesion() const;
  double heat_of(const MPMNodeContact &, bool owned);
  void bind_nodes();
  void count(const MPMContacts::Node &, const MPMContactBodies::Velocities &start);
};

}    // namespace LAMMPS_NS
#endif
#endif

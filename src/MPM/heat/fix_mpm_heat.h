/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/heat,FixMPMHeat);
// clang-format on
#else

#ifndef LMP_FIX_MPM_HEAT_H
#define LMP_FIX_MPM_HEAT_H

#include "base/mpm_state.h"
#include "field/mpm_doubts.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_physics.h"
#include "heat/mpm_grain_heat.h"
#include "heat/mpm_heat_flow.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Conduction of heat in points of conducting materials (with a part thermal), heat through faces
 *  of the box, surfaces of regions, and free surfaces, and heat exchange between bodies (fix mpm)
 *  in contact. */
class FixMPMHeat : public FixMPMState, public MPMPhysics, public MPMHeatSink, public MPMRegionUser {
 public:
  FixMPMHeat(class LAMMPS *, int, char **);
  int setmask() override;    // fix mpm calls conduction
  void init() override;
  void post_integrate() override { grain_heat->show(); }
  void post_force(int) override;
  void end_of_step() override { book(MPMHeatFlow::GRAINS, grain_heat->take()); }
  void setup(int) override;
  void post_run() override { flow.report(); }
  double compute_scalar() override { return flow.heat_came(); }
  double compute_vector(int i) override { return flow.powers()[i]; }
  void write_restart(FILE *fp) override { flow.write_restart(fp); }
  void restart(char *buf) override { flow.restart(id, buf); }
  double memory_usage() override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void extend_topology(MPMField &field) override { flow.extend_topology(field); }
  void topology_changed(MPMField &field) override { flow.topology_changed(field); }
  bool looks_beyond_points() const override { return flow.looks_beyond_points(); }
  bool precedes_motion() const override { return true; }    // of an implicit step
  double stable_dt(const MPMField &field, tagint &tag) const override
  {
    return flow.stable_dt(field, tag);
  }
  std::vector<Account> accounts() const override;
  void account(double *values) const override;
  double energy_at_hand() const override;

  bool uses_region(const std::string &name) const override
  {
    return std::any_of(options.surfaces.begin(), options.surfaces.end(), [&](const auto &one) {
      return one.region == name;
    });
  }

  bool conducts(const MPMField &field) const override { return flow.in(field).conducts(); }
  void give(const MPMField &, std::size_t node, double heat, bool counts) override;

  /** Conduction in this field. */
  MPMConduction &of(const MPMField &field) const { return flow.in(field); }

  using Giver = MPMHeatFlow::Giver;
  /** Counts heat [energy] that a source gave to nodes or points of this rank in this step, before
   *  conduction. */
  void book(Giver giver, double heat) { flow.totals.booked[giver] += heat; }

 private:
  MPMHeatOptions options;
  MPMRows gradients;    // [n][dim] of the temperature at points; not with transfer pic and xpic
  MPMHeatFlow flow;
  MPMRows waiting;    // [n][1] heat that points got from grains, see MPMGrainHeat
  std::unique_ptr<MPMGrainHeat> grain_heat;    // null: not requested
  MPMRows rubbing;    // [n][1] power that points get by pair style mpm/penalty in the next step
  std::vector<double> rubbed;                     // [n] heat by this power
  std::vector<class PairMPMPenalty *> rubbers;    // pair styles that give this heat
  MPMDoubts doubts;
  bool losses_known = false;    // was warn_of_friction() called?

  void require_each_step(const char *giver) const;
  void find_rubbers();
  void warn_of_friction();
  void take_rubbing();
  void give_rubbing(double dt);
  void check_temperatures();
  void check_places();
  void conduct();
};

}    // namespace LAMMPS_NS
#endif
#endif

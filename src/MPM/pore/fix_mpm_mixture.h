/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mixture,FixMPMMixture);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MIXTURE_H
#define LMP_FIX_MPM_MIXTURE_H

#include "base/mpm_state.h"
#include "field/mpm_coupling.h"
#include "field/mpm_node_action.h"
#include "field/mpm_physics.h"
#include "pore/mpm_mixture.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Soil and water at the same place, each a field (fix mpm) with its own points and velocity. They
 *  share the volume and the gradient of the water pressure, and exchange momentum by drag. */
class FixMPMMixture :
    public FixMPMState,
    public MPMPhysics,
    public MPMNodeAction,
    public MPMCoupling {
 public:
  FixMPMMixture(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  double compute_scalar() override;
  double compute_vector(int i) override { return mixture.force_on_soil(i); }
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override { return FixMPMState::memory_usage() + mixture.memory_usage(); }

  // of both MPMPhysics and MPMNodeAction

  void extend_topology(MPMField &field) override { mixture.extend_topology(field); }
  void topology_changed(MPMField &field) override { mixture.topology_changed(field); }

  Turn turn() const override { return PHASES; }
  void init_action() override;
  void couple_topology() override { mixture.couple_topology(); }
  void blocks_found() override { mixture.blocks_found(); }
  void act(double dt, Stage stage) override
  {
    if (stage == STEP) mixture.add_drag(dt);
  }
  void has_acted(MPMNodeAction &other, Stage stage) override
  {
    if (stage == STEP) mixture.note_action(other);
  }

  void init_physics(MPMPlan &) override {}
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  double stable_dt(const MPMField &field, tagint &tag) const override
  {
    return mixture.stable_dt(field, tag);
  }
  /** What drag has turned into heat is spent, like work of viscosity. */
  std::vector<Account> accounts() const override { return {{"heat of drag", true}}; }
  void account(double *values) const override { values[0] += mixture.dissipated; }

  /** Is this field (ID) the soil or the water? */
  bool has(const std::string &field) const { return options.has(field); }
  bool couples(const std::string &one, const std::string &other) const override
  {
    return has(one) && has(other);
  }
  const char *soil_field() const { return options.soil_id.c_str(); }    ///< its ID
  const char *water_field() const { return options.water_id.c_str(); }
  double density_of_grains() const { return options.grain_density; }

 private:
  MPMMixtureOptions options;
  MPMMixture mixture;
};

}    // namespace LAMMPS_NS
#endif
#endif

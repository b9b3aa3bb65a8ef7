/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/pore,FixMPMPore);
// clang-format on
#else

#ifndef LMP_FIX_MPM_PORE_H
#define LMP_FIX_MPM_PORE_H

#include "base/mpm_state.h"
#include "field/mpm_forces.h"
#include "field/mpm_physics.h"
#include "pore/mpm_pore_flow.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Pore water in the points of soils, which move with the velocity of the soil: options, calls by
 *  LAMMPS and fix mpm. Treats the flow of the water, without its own inertia (u-p) or with it
 *  (u-v-p), and the water pressure in the forces. */
class FixMPMPore : public FixMPMState, public MPMPhysics, public MPMPorePressure {
 public:
  FixMPMPore(class LAMMPS *, int, char **);
  ~FixMPMPore() override;
  int setmask() override { return FixConst::PRE_FORCE; }    // for setup_pre_force() alone
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void post_run() override { flow.watch.look_at_inertia(); }
  double compute_scalar() override { return flow.volume_came(); }
  double compute_vector(int part) override { return flow.inflow(part); }
  void write_restart(FILE *fp) override { flow.write_restart(fp, has_state); }
  void restart(char *buf) override { has_state = flow.restart(id, buf); }
  double memory_usage() override { return FixMPMState::memory_usage() + flow.memory_usage(); }

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void setup_points() override;
  void extend_topology(MPMField &field) override
  {
    if (flow.in(field).has_water()) flow.in(field).surface.extend_topology();
  }
  void topology_changed(MPMField &) override;
  MPMNodePressure *node_pressure(const MPMField &field) override
  {
    return flow.in(field).has_water() ? &flow.in(field) : nullptr;
  }
  double stable_dt(const MPMField &field, tagint &tag) const override
  {
    return flow.stable_dt(field, tag);
  }
  double wave_speed(const MPMField &field, int i, double c) const override
  {
    return flow.in(field).wave_speed(i, points.pressure[i][0], c);
  }
  const double *pressure_in_forces(const MPMField &field) const override
  {
    return flow.in(field).pressure_in_forces();
  }
  bool surface_force(MPMField &, const std::vector<char> &near,
                     std::vector<double> &force) const override;
  std::vector<Account> accounts() const override
  {
    return {{"energy of pore water", true, true},
            {"energy of water that came in and down", false, true}};
  }
  void account(double *values) const override;
  std::vector<std::string> quantities() const override;
  double quantity(int k, int i) const override;

  void find_forces_below_surface(const MPMField &field, const std::vector<char> &near,
                                 std::vector<double> &of_water,
                                 std::vector<double> &of_all) const override
  {
    flow.in(field).find_forces_below_surface(near, of_water, of_all);
  }
  /** Does the water have inertia of its own (formulation u-v-p)? */
  bool moves() const { return options.formulation == MPMPoreOptions::U_V_P; }
  /** Is there water in the pores of this material (ID of a fix mpm/material)? */
  bool has(const std::string &material) const { return options.has(material); }

 private:
  MPMPoreOptions options;
  MPMPorePoints points;
  MPMPoreFlow flow;
  MPMPoreChecks checks;
  int initial_index = -1;    // index of a variable for initial pressures; -1: none
  double initial_value = 0.0;
  bool has_state = false;    // state of an earlier run: no initial state is set
  std::vector<const class FixMPMRigid *> rigid_bodies;    // rigid bodies that seal what they touch
  std::vector<const class FixMPMBoundary *> walls;    // walls of regions that seal what they touch

  void warn_of_soils();
  void find_seals();
  double distance_to_bodies(const double *x, double far) const;
  std::vector<double> initial_pressures() const;
};

}    // namespace LAMMPS_NS
#endif
#endif

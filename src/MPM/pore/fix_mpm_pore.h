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

#include "base/mpm_gravity.h"
#include "base/mpm_state.h"
#include "declare/option.h"
#include "diffusion/mpm_super_step.h"
#include "field/mpm_forces.h"
#include "field/mpm_physics.h"
#include "pore/mpm_pore.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/pore. */
struct MPMPoreOptions {
  enum Formulation { U_P, U_V_P };

  Formulation formulation = U_P;
  MPMPoreWater water;
  std::vector<MPMPoreSoil> soils;
  MPMPoreSurface::Conditions conditions;
  bool seals = false;              ///< do bodies seal free surfaces that they touch?
  std::string initial = "0.0";     ///< initial pressure of points, a number or v_name
  bool geostatic = false;          ///< initially at rest under the weight
  double K0 = 0.0, table = 0.0;    ///< geostatic: ratio of stresses, and height of the water table
  double most_suction = -1.0;      ///< largest initial suction, positive; negative: no limit
  double relax = 0.4;
  int most_stages = 64;
  static constexpr int AUTO = 0, NOT_GIVEN = -1;
  int every = NOT_GIVEN;    ///< most steps per flow of water, or AUTO

  MPM_NS::Options declare(int dimension);

 private:
  // values that are being read
  MPMPoreSoil next;
  std::pair<double, double> biot = {0.0, 0.0}, growth = {0.0, 0.0};
  bool biot_alone = false, forchheimer_alone = false, growth_alone = false;
  enum Forchheimer { NUMBER, ERGUN } forchheimer = NUMBER;
  double forchheimer_value = 0.0;
  MPMRetention retention;
  std::string without_soil, without_retention;    // keywords that were given too early
};

/** Pore water in the points of soils, which move with the velocity of the soil. Treats the flow of the water,
 *  without its own inertia (u-p) or with it (u-v-p), and the water pressure in the forces. */
class FixMPMPore :
    public FixMPMState,
    public MPMPhysics,
    public MPMPorePressure,
    private MPMPoreOptions {
 public:
  FixMPMPore(class LAMMPS *, int, char **);
  ~FixMPMPore() override;
  int setmask() override { return 0; }    // called by fix mpm
  void init() override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void setup_points() override;
  void extend_topology(MPMField &field) override
  {
    if (of(field).has_water()) of(field).surface.extend_topology();
  }
  void topology_changed(MPMField &) override;
  MPMNodePressure *node_pressure(const MPMField &field) override
  {
    return of(field).has_water() ? &of(field) : nullptr;
  }
  double stable_dt(const MPMField &, tagint &tag) const override;
  double wave_speed(const MPMField &field, int i, double c) const override
  {
    return of(field).wave_speed(i, pressure[i][0], c);
  }
  const double *pressure_in_forces(const MPMField &field) const override
  {
    return of(field).pressure_in_forces();
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
    of(field).find_forces_below_surface(near, of_water, of_all);
  }
  /** Does the water have inertia of its own (formulation u-v-p)? */
  bool moves() const { return formulation == U_V_P; }
  /** Is there water in the pores of this material (ID of a fix mpm/material)? */
  bool has(const std::string &material) const
  {
    return std::any_of(soils.begin(), soils.end(), [&](const MPMPoreSoil &soil) {
      return soil.material == material;
    });
  }

 private:
  MPMRows pressure;    // [n][1+dim] pressure and its gradient
  MPMRows inertia;     // [n][dim] flow with inertia, see MPMPoreMotion
  double *since =
      nullptr;    // [n] J after the last flow, if water does not flow in each step; 0: unknown
  double *warmth = nullptr;     // [n] temperature at the last thermal expansion of grains and water
  double *content = nullptr;    // [n] volume of water, if a soil can dry (MPMPoreSuction)
  int initial_index = -1;       // index of a variable for initial pressures; -1: none
  double initial_value = 0.0;
  bool gradients_known = true;    // false until gradients of given pressures are found
  struct {
    double steps = 0.0, time = 0.0;
  } waited;                     // steps and time since the last flow
  double crossing = 0.0;        // time for waves by the stiffness of the water to cross a cell
  bool coarse = false;          // can sparse points be as stiff as the lattice can be?
  bool step_flows = true;       // does water flow in this step?
  bool shut_known = false;      // was a warning printed about shut pores?
  bool long_known = false;      // was a warning printed about flows that take too much at once?
  bool grains_known = false;    // was check_grains() done?
  double smoothed =
      0.0;    // lost share of pressures that vary over some cells, see MPMPore::Smoothing, in these runs
  bool smooth_known = false;    // was a warning printed about it?
  // u-p, since the first run: energies that the resistance to the flow would have taken by the neglected acceleration
  // (left_out), has taken (flow), and would have taken without the weight of the water (gradient); sum of the magnitudes of
  // changes of the kinetic energy (exchanged)
  struct {
    double left_out = 0.0, flow = 0.0, gradient = 0.0, exchanged = 0.0;
    double most = 0.0;        // largest kinetic energy so far
    MPMPore::Inertia last;    // last values, of all ranks
    double time = 0.0;        // of the last values
    bigint points = -1;       // number of points of the last values; -1: unknown
    bigint flows = 0;         // number of flows in this run
  } watched;
  bool watches_inertia = false;    // is watch_inertia() used in this run?
  bool inertia_known = false;      // was a warning printed about it?
  bool leaks_known = false;        // was look_for_leaks() called?
  bool has_state = false;          // state of an earlier run: no initial state is set
  std::vector<std::unique_ptr<MPMPore>> fields;
  std::vector<MPMPore *> wet;    // fields that have soil with water
  MPMSuperStep steps;            // for the pressures of all fields together
  double gravity[3];             // force per mass
  MPMGravity weight;
  std::vector<const class FixMPMRigid *> rigid_bodies;    // rigid bodies that seal what they touch
  std::vector<const class FixMPMBoundary *> walls;    // walls of regions that seal what they touch
  std::vector<double> formula_values;                 // [n] permeability from variables

  // [part of the surface] volume of water that came in, followed by its energy (pressure times volume), this rank's
  // share: came: so far; in_step: in the last step; present: rate in a stage of a step; flows: rate in the last step,
  // of all ranks
  std::vector<double> came, in_step, present, flows;
  double dt_last = 0.0;
  bool flows_known = true;

  // greatest rates of the last step on all ranks [1/time], so that a run in two parts takes the steps of one
  double conducted = 0.0, exchanged = 0.0;
  double thinned = std::numeric_limits<double>::max();    // see find_thin_layers(); max(): unknown
  bool rates_known = false;

  bool is_implicit = false;                    // is the pressure solved for with the motion?
  bool sets_relax, sets_stages, sets_every;    // keywords that were given

  MPMPore &of(const MPMField &) const;
  const MPMPoreSoil *soil_of(int i) const;
  double pressure_now(int i) const;
  void check_grains();
  void warn_of_contact() const;
  void find_seals();
  double distance_to_bodies(const double *x, double far) const;
  void init_motion(MPMField &);
  void init_implicit() const;
  bool can_dry() const;
  bool warms() const;
  std::vector<double> initial_pressures() const;
  void weigh_points();
  void evaluate_variables();
  void look_for_leaks();
  void look_for_shut_pores();
  bool is_time_to_flow() const;
  /** May water flow in only one of several steps? */
  bool waits() const { return every != 1; }
  /** Could the flow wait for several steps with this formulation and these soils? */
  bool can_wait() const { return formulation == U_P && !can_dry(); }
  bool needs_each_step() const;
  void end_wait();
  double reach_of_stages() const;
  int stages_of(double duration, double limit) const;
  void find_crossing();
  double longest_wait() const;
  void begin_step(bool with_flow);
  void take_off();
  void find_greatest_rates();
  void find_coarse_points(double widest);
  void find_thin_layers();
  void look_for_smoothing(double duration);
  void watch_inertia();
  void look_for_long_flow(double duration, double limit);
  void know_rates();
  void flow();
  void take_solution();
};

}    // namespace LAMMPS_NS
#endif
#endif

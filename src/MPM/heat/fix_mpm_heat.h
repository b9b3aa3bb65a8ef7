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
#include "diffusion/mpm_diffusion_solver.h"
#include "diffusion/mpm_super_step.h"
#include "field/mpm_heat_sink.h"
#include "field/mpm_physics.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_grain_heat.h"
#include "heat/mpm_heat_contact.h"
#include "heat/mpm_heat_levels.h"
#include "heat/mpm_heat_surface.h"
#include "heat/mpm_heat_thin.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/heat. */
struct MPMHeatOptions {
  MPMHeatCondition conditions[MPMHeatFaces::NFACE];
  MPMHeatSurfaces::Conditions surfaces;
  MPMHeatSurfaceCondition surface;    ///< condition that is being read
  std::vector<MPMHeatPair> pairs;
  MPMHeatPair pair;      ///< pair that is being read
  std::string source;    ///< name of a variable, without v_; empty: none
  MPMHeatTransfer transfer;
  int most_stages = 32;
  static constexpr int AUTO = 0;
  int every = AUTO;    // steps of fix mpm per conduction, or AUTO
  MPMDiffusionOptions in_time;
  bool grains = false;
  bool penalty = false;

  MPM_NS::Options declare(int dimension);
};

/** Conduction of heat in points of conducting materials (with a part thermal), heat through faces of the box,
 *  surfaces of regions, and free surfaces, and heat exchange between bodies (fix mpm) in contact. */
class FixMPMHeat :
    public FixMPMState,
    public MPMPhysics,
    public MPMHeatSink,
    private MPMHeatOptions,
    private MPMDiffusion {
 public:
  FixMPMHeat(class LAMMPS *, int, char **);
  int setmask() override;    // fix mpm calls conduction
  void init() override;
  void post_integrate() override { grain_heat->show(); }
  void post_force(int) override;
  void end_of_step() override { book(GRAINS, grain_heat->take()); }
  void setup(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  void extend_topology(MPMField &) override;
  void topology_changed(MPMField &) override;
  bool looks_beyond_points() const override;
  bool precedes_motion() const override { return true; }    // of an implicit step
  double stable_dt(const MPMField &field, tagint &tag) const override;
  std::vector<Account> accounts() const override;
  void account(double *values) const override;
  double energy_at_hand() const override;

  bool conducts(const MPMField &) const override;
  void give(const MPMField &, std::size_t node, double heat, bool counts) override;

  /** Conduction in this field. */
  MPMConduction &of(const MPMField &) const;

  /** Other sources of heat for nodes and points. */
  enum Giver { FRICTION, GRAINS, NGIVER };
  /** Counts heat [energy] that a source gave to nodes or points of this rank in this step, before conduction. */
  void book(Giver giver, double heat) { past.booked[giver] += heat; }

 private:
  using Heats = MPMConduction::Heats;

  MPMRows gradients;    // [n][dim] of the temperature at points; not with transfer pic and xpic
  MPMRows waiting;      // [n][1] heat that points got from grains, see MPMGrainHeat
  std::unique_ptr<MPMGrainHeat> grain_heat;    // null: not requested
  MPMRows rubbing;    // [n][1] power that points get by pair style mpm/penalty in the next step
  std::vector<double> rubbed;                        // [n] heat by this power
  std::vector<class PairMPMPenalty *> rubbers;       // pair styles that give this heat
  bool grains_said = false, penalty_said = false;    // are the keywords given?
  bool rubs = false;                                 // does a fix give heat of friction?
  bool losses_known = false;                         // was warn_of_friction() called?
  std::vector<std::unique_ptr<MPMConduction>> fields;
  bool told_of_layers = false;    // was a warning printed about interfaces without means?
  struct Past {                   // heat so far, this rank's share; in restart files of all ranks
    double through_faces, of_sources;
    double got;                              // heat that points got
    double given[NGIVER], booked[NGIVER];    // up to the last conduction; since then
  };
  static constexpr int GIVERS = MPMHeatFaces::NFACE + 1;    // index of givers in lists of heat

  std::vector<std::unique_ptr<MPMHeatLevels>> refined;    // bodies on several lattices
  std::vector<std::unique_ptr<MPMHeatBody>> bodies;       // fields that have surfaces with heat
  std::vector<std::unique_ptr<MPMHeatContact>> contacts;
  std::vector<std::unique_ptr<MPMHeatSurfaces>> skins;    // surfaces of fields with conditions
  MPMHeatThin thin;      // thin bodies; entries: surfaces, then contacts
  MPMSuperStep steps;    // explicit stages for the temperatures of all fields together
  // implicit solver for the same; null: explicit
  std::unique_ptr<MPMDiffusionSolver> solver;
  std::vector<MPMConduction *> parts;    // fields of the solver in this step
  double fastest = 0.0;                  // bound of all rates, including exchange
  enum { STEPS, NEWTON, LINEAR, NTOTAL };
  double iterations[NTOTAL] = {};    // of this run
  Past past = {};
  // heat of the last conduction, and power in a stage of it, this rank's share; entries: faces, sources, givers,
  // surfaces, contacts
  Heats in_step, present;
  Heats power;
  double dt_last = 0.0;
  struct {                 // in restart files
    double steps, time;    // since the last conduction
    double longest;        // every auto: longest time of a conduction over more than one step
  } waited = {};
  bool each_step = false;    // with every auto: conduction is needed in each step
  bool power_known = true;
  bool leaks_known = false;     // was look_for_leaks() called?
  bool fronts_known = false;    // did warn_of_fronts() print its warning?
  void warn_of_fronts();
  int source_index = -1;
  std::vector<double> source_values;    // [n] values of an atom-style variable

  double sigma() const;
  MPMHeatBody &body_of(const MPMField &);
  bool wait();
  double longest_wait() const;
  bool needs_each_step() const;
  bool has_variables() const;
  void require_each_step(const char *giver) const;
  void find_rubbers();
  void warn_of_friction();
  void take_rubbing();
  void give_rubbing(double dt);
  void find_neighbors();
  void init_contacts();
  void init_levels(const MPMPlan &);
  MPMHeatLevels *levels_of(const MPMConduction &) const;
  int places_of_surfaces() const { return GIVERS + NGIVER; }
  int places_of_contacts() const { return places_of_surfaces() + (int) surfaces.size(); }
  void find_surfaces();
  void report_thin();
  void look_for_leaks();
  void check(MPMHeatCondition &, const std::string &name);
  void check_values() const;
  bool radiates() const;
  void check_temperatures();
  void evaluate_variables();
  /** Of how many kinds of exchange can a node of a field have a part? */
  int exchanges(const MPMConduction &of_field) const;
  int count_stages();
  void find_edges();
  void find_rates() override;
  bool linearize() override;
  void find_changes() override;
  void project(int part, std::vector<double> &change) override;
  void each_term(int part, double dt, const Term &) override;
  void solve();
  void conduct();
};

}    // namespace LAMMPS_NS
#endif
#endif

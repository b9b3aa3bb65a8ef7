/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_FLOW_H
#define LMP_MPM_HEAT_FLOW_H

#include "base/mpm_rows.h"
#include "declare/option.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "heat/mpm_conduction.h"
#include "heat/mpm_heat_body.h"
#include "heat/mpm_heat_levels.h"
#include "heat/mpm_heat_surface.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMPlan;

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

  bool gives_grains = false, gives_penalty = false;    ///< are the keywords given?

  /** Names of the faces of the box. */
  static const char *const FACE_NAME[];

  MPM_NS::Options declare(int dimension);
  /** Calls f(condition, name) for the conditions at all faces and surfaces. */
  template <class F> void each_condition(const F &f)
  {
    for (int face = 0; face < MPMHeatFaces::NFACE; face++) f(conditions[face], FACE_NAME[face]);
    for (auto &[region, condition] : surfaces)
      f(condition, region.empty() ? "surface" : "region " + region);
  }
  /** Is there radiation? */
  bool radiates();
  bool has_variables();
};

/** The flow of heat in all fields together: conduction in bodies, heat through faces, surfaces, and
 *  contacts, in explicit stages or in implicit steps, each for one or several steps of the
 *  motion. */
class MPMHeatFlow : protected Pointers, private MPMDiffusion {
 public:
  /** Other sources of heat for nodes and points. */
  enum Giver { FRICTION, GRAINS, NGIVER };
  /** Heat so far, this rank's share; in restart files of all ranks. */
  struct Totals {
    double through_faces, of_sources;
    double got;                              ///< heat that points got
    double given[NGIVER], booked[NGIVER];    ///< up to the last conduction; since then
  } totals = {};
  std::vector<std::unique_ptr<MPMConduction>> fields;
  bool has_friction = false;    ///< does a fix give heat of friction?

  /** gradients: [n][dim] of the temperature at points, or null. id: of the fix, for messages. */
  MPMHeatFlow(class LAMMPS *, MPMHeatOptions &, const MPMRows &gradients, const std::string &id);

  /** Number of places in lists of heat: faces of the box, sources, givers, surfaces, contacts. */
  int n() const { return contact_places() + (int) options.pairs.size(); }
  void set_size(int n)
  {
    for (auto *heats : {&in_step, &present, &power}) heats->assign(n, 0.0);
  }    ///< sets the length of lists of heat, when options are known

  // start of a run

  void clear();                                           ///< removes all fields
  void add(MPMField &);                                   ///< adds a field
  void init_contacts();                                   ///< finds surfaces and contacts of fields
  void init_levels(const MPMPlan &);                      ///< finds bodies on several lattices
  void init_waits() { each_step = needs_each_step(); }    ///< says that all of these are known
  /** Checks that radiation has temperatures in kelvins, and that variables exist. name: of the
   *  condition, for messages. */
  void check_condition(MPMHeatCondition &, const std::string &name);
  void find_source(int index) { source_index = index; }    ///< variable of the source
  void clear_iterations() { std::fill_n(iterations, (int) NTOTAL, 0.0); }
  void extend_topology(MPMField &);
  void topology_changed(MPMField &);
  bool looks_beyond_points() const;

  // in a step

  /** Counts one more step of fix mpm; true while it is not yet time for the conduction.
   *  Collective. */
  bool wait();
  /** Start of a step with conduction, before others give heat to nodes. Collective. */
  void begin();
  /** Conduction for the time since the last one. Collective. */
  void conduct();
  double stable_dt(const MPMField &, tagint &tag) const;    ///< see MPMPhysics

  /** Conduction in a field. */
  MPMConduction &in(const MPMField &) const;
  double heat_came() const;               ///< heat that has come in so far. Collective
  const std::vector<double> &powers();    ///< power in the last conduction, by places. Collective
  /** Writes the mean numbers of iterations of a run. */
  void report() const;
  void write_restart(FILE *);
  /** Takes the state of the fix with this ID that Fix::restart() gets. */
  void restart(const std::string &id, const char *buf);
  double memory_usage() const;

 private:
  using Heats = MPMConduction::Heats;

  MPMHeatOptions &options;
  const MPMRows &gradients;
  const std::string id;
  static constexpr int GIVERS = MPMHeatFaces::NFACE + 1;    // index of givers in lists of heat
  std::vector<std::unique_ptr<MPMHeatLevels>> refined;      // bodies on several lattices
  std::vector<std::unique_ptr<MPMHeatBody>> bodies;         // fields that have surfaces with heat
  std::vector<std::unique_ptr<MPMHeatContact>> contacts;
  std::vector<std::unique_ptr<MPMHeatSurfaces>> surfaces;    // surfaces of fields with conditions
  MPMHeatThin thin;      // thin bodies; entries: surfaces, then contacts
  MPMSuperStep steps;    // explicit stages for the temperatures of all fields together
  // implicit solver for the same; null: explicit
  std::unique_ptr<MPMDiffusionSolver> solver;
  std::vector<MPMConduction *> parts;    // fields of the solver in this step
  double fastest = 0.0;                  // bound of all rates, including exchange
  double limit = 0.0;                    // explicit limit of this step [time]
  enum { STEPS, NEWTON, LINEAR, NTOTAL };
  double iterations[NTOTAL] = {};    // of this run
  // heat of the last conduction, and power in a stage of it, this rank's share; entries: faces,
  // sources, givers, surfaces, contacts
  Heats in_step, present;
  Heats power;
  double dt_last = 0.0;
  struct {                 // in restart files
    double steps, time;    // since the last conduction
    double longest;        // every auto: longest time of a conduction over more than one step
  } waited = {};
  bool each_step = false;    // with every auto: conduction is needed in each step
  bool power_known = true;
  // was a warning printed about it?
  bool warned_of_layers = false, leaks_known = false, fronts_known = false;
  int source_index = -1;
  std::vector<double> source_values;    // [n] values of an atom-style variable

  double sigma() const;
  static bool weighs_faces(const MPMField &);
  MPMHeatBody &body_in(const MPMField &);
  MPMHeatLevels *levels_with(const MPMConduction &) const;
  int surface_places() const { return GIVERS + NGIVER; }
  int contact_places() const { return surface_places() + (int) options.surfaces.size(); }
  double longest_wait() const;
  bool needs_each_step() const;
  void find_neighbors();
  void find_surfaces();
  void report_thin();
  void look_for_leaks();
  void warn_of_fronts();
  void check_values() const;
  void evaluate_variables();
  /** Of how many kinds of exchange can a node of a field have a part? */
  int exchanges(const MPMConduction &) const;
  int count_stages();
  void find_edges();
  void find_rates() override;
  void exchange(bool changes, Heats &);
  bool linearize() override;
  void find_changes() override;
  void project(int part, std::vector<double> &change) override;
  void each_term(int part, double dt, const Term &) override;
  void add_diagonal(int part, double dt, std::vector<double> &diagonal) override;
  void each_surface_term(const MPMConduction &, double dt, const Term &) const;
  void let_faster_points_go();
  void solve();
  void advance(int stages);
};

}    // namespace LAMMPS_NS
#endif

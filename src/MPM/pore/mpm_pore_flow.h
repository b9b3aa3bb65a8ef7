/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PORE_FLOW_H
#define LMP_MPM_PORE_FLOW_H

#include "base/mpm_gravity.h"
#include "base/mpm_rows.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "pointers.h"
#include "pore/mpm_pore.h"
#include "pore/mpm_pore_options.h"

#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/** What points keep for their pore water. */
struct MPMPorePoints {
  MPMRows pressure;    ///< [n][1+dim] pressure and its gradient
  MPMRows inertia;     ///< [n][dim] flow with inertia, see MPMPoreMotion
  /** [n] J after the last flow, if water does not flow in each step; 0: unknown */
  double *since = nullptr;
  /** [n] temperature at the last thermal expansion of grains and water */
  double *warmth = nullptr;
  double *content = nullptr;    ///< [n] volume of water, if a soil can dry (MPMPoreSuction)
};

class MPMPoreFlow;

/** Looks at the flow of pore water, and warns once of results that are not what they seem. */
class MPMPoreWatch : protected Pointers {
 public:
  /** id: of the fix, for messages. */
  MPMPoreWatch(class LAMMPS *, const MPMPoreOptions &, const MPMPorePoints &, const MPMPoreFlow &,
               const std::string &id);

  /** Start of a run. neglects_inertia: may the acceleration of the water matter, which is left
   *  out? */
  void start(bool neglects_inertia);
  /** Warns of pair styles between points, which do not know the share of the water in a contact. */
  void warn_of_contact() const;
  /** Warns of materials without water that are thinner than the reach of nodes, at the first step,
   *  once. */
  void look_for_leaks();
  /** Warns once of pores that are shut, where the equations hold neither for the soil nor for its
   *  water. */
  void look_for_shut_pores();
  /** Warns once of flow through a surface that is not a face of the box, in a lump that one stage
   *  cannot take. steps: since the last flow; limit: explicit limit of the duration. */
  void look_for_long_flow(double duration, double limit, double steps);
  /** Warns once of pressures that vary over some cells and that points have lost to nodes in long
   *  runs, where the flow itself is too slow for that. duration: of a flow. */
  void look_for_smoothing(double duration);
  /** Measures the neglected acceleration between every fourth flow, see MPMPore::inertia():
   *  relevant motion is slower than waves of the lattice. Collective. */
  void watch_inertia();
  /** End of a run: warns once if the acceleration matters that formulation u-p neglects. */
  void look_at_inertia();

 private:
  const MPMPoreOptions &options;
  const MPMPorePoints &points;
  const MPMPoreFlow &flow;
  const std::string id;
  // lost share of pressures that vary over some cells, see MPMPore::Smoothing, in these runs
  double smoothed = 0.0;
  // u-p, since the first run: energies that the resistance to the flow would have taken by the
  // neglected acceleration (left_out), has taken (flow), and would have taken without the weight of
  // the water (gradient); sum of the magnitudes of changes of the kinetic energy (exchanged)
  struct {
    double left_out = 0.0, flow = 0.0, gradient = 0.0, exchanged = 0.0;
    double most = 0.0;        // largest kinetic energy so far
    MPMPore::Inertia last;    // last values, of all ranks
    double time = 0.0;        // of the last values
    bigint points = -1;       // number of points of the last values; -1: unknown
    bigint flows = 0;         // number of flows in this run
  } watched;
  bool measures_inertia = false;    // is watch_inertia() used in this run?
  // was a warning printed about it?
  bool inertia_known = false, smooth_known = false, long_known = false, shut_known = false;
  bool leaks_known = false;    // was look_for_leaks() called?
};

/** The flow of pore water in all fields: in which steps water flows, for which time, in how many
 *  stages, and how much has come in.
 *
 *  Flow in each step is simple. It may also be in one of several steps, for the duration of all of
 *  them: then it costs less, and the pressure of points between two flows is that of undrained
 *  deformation. */
class MPMPoreFlow : protected Pointers {
 public:
  MPMPoreWatch watch;
  std::vector<std::unique_ptr<MPMPore>> fields;
  std::vector<MPMPore *> wet;    ///< fields that have soil with water
  double gravity[3] = {};        ///< force per mass
  MPMGravity weight;
  bool is_implicit = false;       ///< is the pressure solved for with the motion?
  bool gradients_known = true;    ///< false until gradients of given pressures are found

  MPMPoreFlow(class LAMMPS *, MPMPoreOptions &, MPMPorePoints &, const std::string &id);

  // start of a run

  void clear();                ///< removes all fields
  MPMPore &add(MPMField &);    ///< adds a field
  void add_wet(MPMPore &);     ///< says that this field has water
  /** Must water flow in each step if every is not given? It must with effects that cannot wait,
   *  with input that varies from step to step, and with free surfaces, whose flow is more exact if
   *  less of it comes at once. */
  bool needs_each_step() const;
  /** Finds the time for waves by the stiffness of the water to cross a cell. */
  void find_crossing();
  /** Ends a wait if water flows in each step from now on. */
  void end_wait();
  /** Finds the water of new points from their pressure. */
  void weigh_points();

  // in a step

  void begin_step() { begin(step_flows = is_time_to_flow()); }    ///< before points go to nodes
  /** Formulation u-v-p, before the solve: takes the mass of the water off nodes. */
  void separate_inertia()
  {
    for (auto *field : wet) field->separate_water();
  }
  /** When the velocities of a step are known, where that moves points, too. */
  void take_motion(MPMField &);
  void advance();    ///< flow of the water, if there is any in this step
  /** Takes the pressures at the end of an implicit step, which were solved together with the
   *  motion. */
  void take_solution();

  /** The water of a field. */
  MPMPore &in(const MPMField &) const;
  /** The soil of point i, or null if it has no water. */
  const MPMPoreSoil *soil_of(int i) const;
  /** Pressure of a point, also between two flows. */
  double pressure_now(int i) const;
  double stable_dt(const MPMField &, tagint &tag) const;    ///< see MPMPhysics
  double volume_came() const;    ///< volume of water that has come in so far. Collective
  /** Flow into a part of the surface in the last step [volume/time]. Collective. */
  double inflow(int part);
  /** Energy of water that has come in on this rank [pressure*volume]. */
  double energy_came() const { return came[MPMPoreSurface::ENERGY]; }

  void write_restart(FILE *, bool has_state);
  /** Takes what write_restart() has written, as the fix with this ID gets it; returns has_state. */
  bool restart(const std::string &id, const char *buf);
  double memory_usage() const;

 private:
  MPMPoreOptions &options;
  MPMPorePoints &points;
  struct {
    double steps = 0.0, time = 0.0;
  } waited;                  // steps and time since the last flow
  double crossing = 0.0;     // time for waves by the stiffness of the water to cross a cell
  bool coarse = false;       // can sparse points be as stiff as the lattice can be?
  bool step_flows = true;    // does water flow in this step?
  MPMSuperStep steps;        // for the pressures of all fields together
  std::vector<double> formula_values;    // [n] permeability from variables

  // [part of the surface] volume of water that came in, followed by its energy (pressure times
  // volume), this rank's share: came: so far; in_step: in the last step; present: rate in a stage
  // of a step; flows: rate in the last step, of all ranks
  std::vector<double> came, in_step, present, flows;
  double dt_last = 0.0;
  bool flows_known = true;

  // greatest rates of the last step on all ranks [1/time], so that a run in two parts takes the
  // steps of one
  double conducted = 0.0, exchanged = 0.0;
  double thinned = std::numeric_limits<double>::max();    // see find_thin_layers(); max(): unknown
  bool rates_known = false;

  void evaluate_variables();
  void begin(bool with_flow);
  bool is_time_to_flow() const;
  double longest_wait() const;
  /** Longest flow, in limits of an explicit step. */
  double longest_flow() const
  {
    return options.most_stages < 3 ? 0.5 : MPMSuperStep::reach(options.most_stages);
  }
  int count_stages(double duration, double limit) const;
  void find_greatest_rates();
  void find_thin_layers();
  void find_coarse_points(double widest);
  void find_first_rates();
};

}    // namespace LAMMPS_NS
#endif

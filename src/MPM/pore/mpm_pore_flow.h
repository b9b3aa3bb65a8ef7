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
#include "diffusion/mpm_super_step.h"
#include "pointers.h"
#include "pore/mpm_pore.h"
#include "pore/mpm_pore_options.h"
#include "pore/mpm_pore_watch.h"

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
  void
  find_crossing();    ///< finds the time for waves by the stiffness of the water to cross a cell
  /** Ends a wait if water flows in each step from now on. */
  void end_wait();
  /** Finds the water of new points from their pressure. */
  void weigh_points();

  // in a step

  void begin_step();    ///< before points go to nodes
  void
  separate_inertia();    ///< formulation u-v-p, before the solve: takes the mass of the water off nodes
  void take_motion(
      MPMField &);    ///< when the velocities of a step are known, where that moves points, too
  void advance();     ///< flow of the water, if there is any in this step
  void take_solution();    ///< takes the pressures at the end of an implicit step

  /** The water of a field. */
  MPMPore &in(const MPMField &) const;
  /** The soil of point i, or null if it has no water. */
  const MPMPoreSoil *soil_of(int i) const;
  /** Pressure of a point, also between two flows. */
  double pressure_now(int i) const;
  double stable_dt(const MPMField &, tagint &tag) const;    ///< see MPMPhysics
  double volume_came() const;    ///< volume of water that has come in so far. Collective
  double inflow(
      int part);    ///< flow into a part of the surface in the last step [volume/time]. Collective
  /** Energy of water that has come in on this rank [pressure*volume]. */
  double energy_came() const { return came[MPMPoreSurface::ENERGY]; }

  void write_restart(FILE *, bool has_state);
  /** Takes what write_restart() has written; returns has_state. */
  bool restart(const double *);
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
  double longest_flow() const;
  int count_stages(double duration, double limit) const;
  void find_greatest_rates();
  void find_thin_layers();
  void find_coarse_points(double widest);
  void find_first_rates();
};

}    // namespace LAMMPS_NS
#endif

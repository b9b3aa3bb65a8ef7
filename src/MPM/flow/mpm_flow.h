/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_H
#define LMP_MPM_FLOW_H

#include "base/mpm_rows.h"
#include "base/mpm_stage_list.h"
#include "flow/mpm_flow_checks.h"
#include "flow/mpm_flow_energy.h"
#include "flow/mpm_flow_momentum.h"
#include "flow/mpm_flow_parts.h"

#include <limits>
#include <string>
#include <vector>

namespace LAMMPS_NS {
struct MPMFlowPoints;

/** Incompressible flow with free surfaces: its parts, and its step as a list of stages.
 *
 *  Points give momentum to the faces of a staggered lattice, forces and the pressure change the
 *  velocities of the faces, and points move with these velocities.
 *
 *  The velocities of the lattice are those of the middle of a step (leapfrog): forces act from the
 *  middle of the step before to that of this one, and in the first step for half of it. Velocities
 *  of points go on from there to the end of the step with half of their change. What they have
 *  thereby, *half_kick*, is taken back at the start of the next step. In a flow with grains, whose
 *  velocities are those of the ends of steps, and with implicit viscosity, which is of first
 *  order, forces act for whole steps, and nothing goes on. */
class MPMFlow : protected Pointers {
 public:
  MPMIncompressibleOptions
      options;    ///< transfer, and the share that points keep, change during a run
  MPMFlowLiquids liquids;
  MPMFlowFields fields;
  MPMFlowParts parts;
  MPMFlowResults results;    ///< of the last step
  MPMFlowChecks checks;

  /** groupbit: of the points. id: of the fix, for messages. gradient: [n][flow_slopes(dim)]
   *  gradients of the velocities of points, or null; see has_gradients(). half_kick: [n][dim]. */
  MPMFlow(class LAMMPS *, const MPMIncompressibleOptions &, int groupbit, const std::string &id,
          const MPMRows &gradient, const MPMRows &half_kick);

  /** Do points have gradients of their velocities? */
  bool has_gradients() const;
  /** Start of a run: finds regions, bodies, grains, and inflow. Collective. */
  void init();
  /** Start of a run, after init() and MPMFlowChecks::check_points(): finds cells, and makes the
   *  list of stages. Collective. */
  void start();
  /** A step of duration update->dt. Collective. */
  void step() { stages.run(); }
  /** End of a run. Collective. */
  void end_run();
  /** Are the velocities of the lattice those of the middle of a step? */
  bool is_leapfrog() const { return !parts.grains && !parts.stress; }
  /** The stages of a step. */
  const MPMStageList &plan() const { return stages; }

  /** Largest velocity component on the lattice and of walls after the last step, on all ranks. */
  double largest_velocity() const { return fastest; }
  /** Stable time step of this rank, see FixMPMIncompressible::stable_dt(). */
  double stable_dt(tagint &tag) const;
  /** Energy that spreading has added to the points of this rank so far. */
  double energy_of_spreading() const { return spreading_energy; }

  /** State for restart files: duration of the last step, limit of the next one with its forces, the
   *  share that points keep, halvings, sums over velocities and forces, motion of regions, and gas;
   *  complete on the first rank. Collective. */
  std::vector<double> restart_data();
  /** Takes what restart_data() has given, as the fix with this ID gets it. */
  void restart(const std::string &id, const char *buf);
  double memory_usage() const
  {
    return parts.memory_usage() + fields.memory_usage() + momentum.memory_usage();
  }

 private:
  const int groupbit;
  const std::string id, who;
  const MPMRows &gradient, &half_kick;
  MPMFlowMomentum momentum;
  MPMStageList stages;

  // of this step: its duration, that of forces, and that of the motion before; the share of forces
  // that acts before points move; the share of the change by which velocities go on to the end of
  // the step; do the durations differ, and do points keep a part of their velocities?
  struct {
    double dt, kick, dt_before, part, half_kick_share;
    bool differs, keeps;
  } now = {};
  double dt_before = 0.0;    // duration of the last step; 0: none so far, or velocities are new
  // sum_over_points() of velocities and forces after the last step; infinite: none so far
  double sum_before = std::numeric_limits<double>::infinity(), force_before = sum_before;
  // do points have other velocities than after the last step; do velocities count as those of now,
  // and not as those of a flow that goes on?
  bool is_new = true, begins = true;
  bool first_of_run = true;
  bool running = false;        // is it in a run, after the start of the first step?
  bool was_leapfrog = true;    // is_leapfrog() in the last step
  // last stable_dt() with forces; after a restart, of all ranks; 0: none
  mutable double limit_before = 0.0;
  bool forces_known = false;        // false at the start of a run, when forces are cleared
  bool stiffness_known = false;     // was check_stiffness() done in this run?
  double unseen[2] = {0.0, 0.0};    // MPMFlowUpdate::squares of the last step
  double spreading_energy = 0.0;
  MPMFlowEnergy energy;
  double fastest = 0.0;

  void choose_transfer();
  void make_plan();
  void begin_step();
  void undo_half_kick();
  void find_cells();
  void find_apertures();
  void points_to_faces();
  void find_wet_cells();
  void find_flow();
  void find_paths();
  void find_shift();
  void faces_to_points();
  std::array<double, 7> sum_last_step(bool valid) const;
  bool gains() const;
  void find_share(double unseen, double bend);
  void report_gain();
  MPMFlowPoints points_now(double dt) const;
  double limit_of_motion(double dt, tagint &tag) const;
  void find_velocities();
  void find_inverse_densities();
  void find_filled_volume();
  void find_free_velocities(const MPMFlowPoints &);
  void fit_gradients(const MPMFlowPoints &);
  void find_start();
  double sum_over_points(double **values, double &size) const;
  void find_sums();
  bool continues();
  void check_speed();
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PLAN_H
#define LMP_MPM_PLAN_H

#include "mpm_energy_watch.h"
#include "mpm_node_action.h"
#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMPhysics;

/** The step of all fields as a list of named stages, which is made once at the start of a run. The four
 *  schemes are four such lists, see mpm_step.cpp. A stage tells what it costs. */
class MPMPlan : protected Pointers {
 public:
  using Each = std::function<void(MPMField &)>;
  using Wanted = std::function<bool(const MPMField &)>;

  /** Places in each of the lists where stages of other physics go, in the order of definition. */
  enum Place {
    BEFORE_POINTS_TO_NODES,    ///< positions and forces of the start of the step
    AFTER_POINTS_TO_NODES,    ///< nodes have what points of this rank gave them, not yet summed over ranks and images
    BEFORE_SOLVE,    ///< nodes have mass and momentum, summed over ranks
    AFTER_MOMENTUM,    ///< the momentum equation gave them velocities, which node actions have not seen
    AFTER_ACTIONS,    ///< these have seen them; the ledger has not
    AFTER_SOLVE,      ///< nodes have their new velocities, points are where they were
    BEFORE_STRAIN,    ///< of usl and musl: the same, with the velocities that strain the points
    AFTER_MOTION      ///< the step has ended but for its checks
  };

  std::vector<MPMField *> fields;
  std::vector<MPMNodeAction *> actions;    ///< in the order in which they act
  std::vector<MPMPhysics *> physics;       ///< in the order of definition

  MPMEnergyWatch watch;

  explicit MPMPlan(class LAMMPS *lmp) : Pointers(lmp), watch(lmp, fields) {}

  /** Find all fields, node actions and physics, and make the list. */
  void make();

  /** Append a stage that is run for each field that wants it; without these there is no such stage. */
  void each(const std::string &name, Each run, Wanted wanted = nullptr);
  /** Append a stage that is run once for all fields, if any of them wants it. */
  void together(const std::string &name, const std::function<void()> &run, Wanted wanted = nullptr);
  /** Append node actions on one kind of velocities, if there are any. */
  void node_actions(MPMNodeAction::Stage, Wanted wanted = nullptr);
  /** Append what other physics have at this place. */
  void place(Place);

  /** Start of a run. */
  void start();
  /** A step of LAMMPS: one of the cycle, if it is time for it. */
  void step();
  /** Summary of a run for a field, to screen and log file: state, energy, and cost. */
  void report(const MPMField &, double bytes_per_point) const;

  /** Blocks in reach of points, of all fields whose points have moved in memory or away. */
  void find_blocks();
  /** The same apart from the step. */
  void find_blocks_now();
  /** Do periodic images count that no point can reach? */
  bool keeps_all_images() const;
  /** Are nodes of this block looked at that only points of other ranks can reach? */
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const;
  void act_on_nodes(MPMNodeAction::Stage);

 private:
  struct Stage {
    std::string name;
    Each run;
    std::vector<MPMField *> fields;    // the first one, if it is run once
    bool once;
    std::vector<double> seconds;    // of each of these
  };
  struct Cost {
    std::string stage;
    double time;    // [ns] per step and point of one process
  };
  std::vector<Stage> stages;
  bool physics_looks_beyond() const;
  std::vector<Cost> costs(const MPMField &, double scale) const;
  double wall_start = 0.0, cpu_start = 0.0;    // of the run [s]
};

/** The lists of the schemes. */
void make_usl(MPMPlan &);
void make_usf(MPMPlan &);
void make_musl(MPMPlan &);
void make_usavg(MPMPlan &);

}    // namespace LAMMPS_NS
#endif

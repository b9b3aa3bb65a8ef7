/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PLAN_H
#define LMP_MPM_PLAN_H

#include "base/mpm_stage_list.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "pointers.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMAddedStress;
class MPMField;
class MPMLoad;
class MPMPhysics;
class MPMPorePressure;

/** The step of all fields as a list of stages, which is made once at the start of a run. Each of
 *  the four schemes is one such list, see mpm_step.cpp. */
class MPMPlan : protected Pointers, private MPMStageList {
 public:
  using Each = std::function<void(MPMField &)>;
  using Wanted = std::function<bool(const MPMField &)>;
  using MPMStageList::Data;
  using MPMStageList::list;
  using MPMStageList::observe;
  using MPMStageList::Stage;

  /** Places in each list where other physics can add stages. Physics adds them in the order of
   *  definition. */
  enum Place {
    BEFORE_POINTS_TO_NODES,    ///< positions and forces are those of the start of the step
    AFTER_POINTS_TO_NODES,     ///< nodes have the sums over the points of this rank only
    BEFORE_SOLVE,              ///< nodes have mass and momentum, summed over ranks
    AFTER_MOMENTUM,    ///< nodes have the velocities of the momentum equation, before actions
    AFTER_ACTIONS,     ///< node actions have acted; the ledger has not recorded it
    AFTER_SOLVE,       ///< nodes have their new velocities, points are at their old positions
    BEFORE_STRAIN,     ///< usl and musl: as AFTER_SOLVE, with the velocities that strain the points
    POINTS_HAVE_MOVED,    ///< nothing has looked at them yet
    AFTER_MOTION          ///< the step is complete except for its checks
  };

  std::vector<MPMField *> fields;
  std::vector<MPMNodeAction *> actions;    ///< in the order in which they act
  // in the order of definition
  std::vector<MPMPhysics *> physics;
  std::vector<MPMAddedStress *> added_stresses;
  std::vector<MPMLoad *> loads;
  std::vector<MPMPorePressure *> pore_pressures;

  std::unique_ptr<MPMWatch> watch;    ///< of all fields

  explicit MPMPlan(class LAMMPS *lmp) : Pointers(lmp) {}

  /** Find all fields, node actions, and physics, and make the list of stages with the scheme. */
  void make(const std::function<void(MPMPlan &)> &scheme);

  /** Append a stage that runs for each field for which wanted is true (null: for all). There is no
   *  such stage if no field wants it. */
  void each(const std::string &name, const Data &reads, const Data &writes, Each run,
            Wanted wanted = nullptr);
  /** Append a stage that runs once for all fields, if any field wants it. */
  void together(const std::string &name, const Data &reads, const Data &writes,
                const std::function<void()> &run, Wanted wanted = nullptr);
  /** Append the node actions of one stage, if there are any. */
  void node_actions(MPMNodeAction::Stage, Wanted wanted = nullptr);
  /** Append the stages that other physics has at this place. */
  void place(Place);

  /** Start of a run. */
  void start();
  /** Called in each step of LAMMPS; runs the stages if a step of the cycle is due. */
  void step();
  /** Writes the summary of a run for one field to screen and log file: state (a text), energy, and
   *  cost. */
  void report(const MPMField &, double bytes_per_point, const std::string &state) const;

  /** Find the blocks in reach of points, for all fields whose points have moved in memory or out of
   *  reach. */
  void find_blocks();
  /** The same, for calls outside of the step. */
  void find_blocks_now();
  /** Must periodic images be kept that no point can reach? */
  bool keeps_all_images() const;
  /** Must nodes of this block be known although only points of other ranks can reach them? */
  bool looks_at_all(const MPMField &, const MPM_NS::Grid::Block &) const;
  /** Let all node actions act at this stage, in their order. */
  void act_on_nodes(MPMNodeAction::Stage);

 private:
  struct Cost {
    std::string stage;
    double time;    // [ns] per step and point of one process
  };
  bool physics_looks_beyond() const;
  std::vector<Cost> costs(const MPMField &, double scale) const;
  double wall_start = 0.0, cpu_start = 0.0;    // at the start of the run [s]
};

}    // namespace LAMMPS_NS
#endif

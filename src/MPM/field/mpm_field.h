/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FIELD_H
#define LMP_MPM_FIELD_H

#include "base/mpm_step_limit.h"
#include "field/mpm_field_options.h"
#include "field/mpm_jacobians.h"
#include "field/mpm_ledger.h"
#include "field/mpm_nodes.h"
#include "pointers.h"
#include "transfer/kernels.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class Fix;
class FixMPMMaterial;
class MPMAffine;
class MPMBoxes;
class MPMCpdi;
class MPMEvery;
class MPMFrame;
class MPMGuard;
class MPMInternalForce;
class MPMLocking;
class MPMPhysics;
class MPMPlan;
class MPMPointMap;
class MPMPointState;
class MPMSmoothing;
class MPMStretch;
class MPMTimeLimit;
class MPMTransferHeat;
class MPMVolumeDrift;
class MPMWatch;
class MPMRows;
struct MPMPoints;

/** One velocity field on one lattice: options, points, nodes, and an object for each feature that
 *  only some options need. */
class MPMField : protected Pointers {
  MPMFieldOptions chosen;    // before all that reads them

 public:
  using Options = MPMFieldOptions;
  using Pointers::atom;
  using Pointers::lmp;

  Fix &fix;    ///< the fix mpm: its ID, its group, its requests for new neighbor lists
  const Options &options = chosen;
  MPM_NS::Grid grid;    ///< records of momentum: velocity and mass after the momentum equation
  MPM_NS::Lattice &lattice;    ///< of the grid
  MPMNodes nodes;
  MPMPoints *points;    ///< of the present Atom object, which replicate exchanges: set in init()

  std::vector<FixMPMMaterial *> materials;     ///< all of them, see find_materials()
  std::vector<MPMInternalForce *> elements;    ///< all of them, set in init()
  MPMPlan *plan = nullptr;                     ///< of all fields, set in init()

  /** Nodes with no more than this mass are at rest: where functions end in a plane of nodes,
   *  round-off decides whether these have a mass, which is of second order in it, and a force,
   *  which is of first order. */
  double least_node_mass = MPM_NS::LEAST_MASS;
  const MPM_NS::MPMKernels *kernels = nullptr;
  const MPM_NS::BatchKernels *batch_kernels = nullptr;
  MPM_NS::TransferKernels kernel;    ///< of the step
  MPM_NS::TransferKernels pic;       ///< of other sums over points, with records of 8 reals
  MPM_NS::TransferKernels mapped;    ///< strain and motion of velocities that were mapped back
  std::unique_ptr<MPM_NS::Batch> batch;

  MPMLedger ledger;
  /** [n][dim] gradients on the lattice that other physics keep for points; set by their
   *  init_physics(). */
  std::vector<const MPMRows *> slopes;
  /** Physics that change how points strain; set by their init_physics(). */
  std::vector<MPMStretch *> stretching;
  /** det F of points, for other physics, which ask for it in their topology_changed(). */
  MPMJacobians jacobians;
  /** Are the points at the same places as those of another field, so that their volumes do not add
   *  up to the room? To be set by init_physics(). */
  bool shares_room = false;

  // objects that only some options need; null: not with the present options

  std::unique_ptr<MPMFrame> frame;    ///< never null
  std::unique_ptr<MPMPointMap> map;
  std::unique_ptr<MPMGuard> guard;
  std::unique_ptr<MPMTimeLimit> time_limit;
  std::unique_ptr<MPMWatch> fracture_watch;    ///< set by fix mpm
  std::unique_ptr<MPMAffine> affine;
  std::unique_ptr<MPMBoxes> boxes;
  std::unique_ptr<MPMCpdi> domains;
  std::unique_ptr<MPMEvery> every;
  std::unique_ptr<MPMLocking> locking;
  std::unique_ptr<MPMSmoothing> smoothing;
  std::unique_ptr<MPMTransferHeat> heating;
  std::unique_ptr<MPMVolumeDrift> drift;    ///< never null

  /** Memory that stages share; nothing in it outlives a stage. */
  struct {
    std::vector<double> nodes;              ///< sums over points other than momentum
    std::vector<double> node_velocities;    ///< [node][3] before XPIC and FMPM add terms
    std::vector<double> vectors;      ///< [n][3] vectors that points give to nodes or get from them
    std::vector<double> weights;      ///< [n] weights of the points for this
    std::vector<double> places;       ///< [n][3] unused positions from transfers at rest
    std::vector<double> stress;       ///< [n][6]
    std::vector<double> no_volume;    ///< [n] zero
    std::vector<double> history;      ///< [variable][BATCH]
  } work;

  /** The per-point arrays that the options ask for are declared in state. */
  MPMField(class LAMMPS *, Fix &, double h, const Options &, MPMPointState &state);
  ~MPMField();

  /** The fields of all fix mpm, in order of definition. */
  static std::vector<MPMField *> all(class LAMMPS *);
  /** The field of a fix mpm; null: the fix does not exist or has another style. */
  static MPMField *find(class LAMMPS *, const std::string &id);

  /** Start of a run, before anything reads the options: choose the form of the stress if the input
   *  leaves it open. */
  void choose_stress(const std::vector<MPMPhysics *> &);
  /** Start of a run. */
  void init(MPMPlan *);
  /** List the present materials; also between runs, when materials of the last run may be gone. */
  void find_materials();
  /** Choose the transfers of this run. */
  void choose_kernels();
  /** Check that the lattice fits the box, which may have changed since the last run. */
  void check_box();

  /** ID of the fix mpm. */
  const char *id() const;
  /** Is atom i a material point of this field? */
  bool is_point(int i) const;
  /** Is atom i a node of finite elements, without stress and material of its own? */
  bool is_element_node(int i) const;
  /** The material of atom i; null: it has none. */
  FixMPMMaterial *material_of(int i) const;
  /** [materials] Has any rank points of it, or will a fix mpm/emit bring some? What a run finds out
   *  at its start must not depend on points that come a moment later. Collective. */
  std::vector<signed char> present_materials() const;
  /** Stops with an error if nodes of finite elements have a material that something else wants to
   *  act on: they have no state that it could change. what: about these nodes, and the remedy.
   *  Collective. */
  void refuse_element_nodes(const Fix &user, const std::string &what,
                            const std::function<bool(const FixMPMMaterial *)> &wants) const;

  /** Duration of a step of the cycle. */
  double step_dt() const;
  /** Duration of the step before, which has moved the points to where they are; of this step, if
   *  there was none. */
  double step_dt_before() const { return last_dt > 0.0 ? last_dt : step_dt(); }
  /** Steps of LAMMPS until the next step of the cycle ends, seen from the end of this step. */
  int steps_to_next() const;
  /** The arrays of points as transfers read them. */
  MPM_NS::PointRows rows() const;
  /** f[3]: force on point i without that of elements, which is internal. forces: see rows().f. */
  void outer_force(const double *forces, int i, double *f) const;
  /** Rows for transfers of other values and weights, in which points do not move (the time step is
   *  zero). */
  MPM_NS::PointRows rows_at_rest(double *values, const double *weights);
  /** Data for transfers, with the duration of a step of the cycle or another one. */
  MPM_NS::TransferStep step_data() const { return step_data(step_dt()); }
  MPM_NS::TransferStep step_data(double dt) const;

  // course of a run

  /** Called by fix mpm when the set-up of a run is complete, and at its end. */
  void begin_run() { running = true; }
  void end_run() { running = false; }
  bool is_running() const { return running; }
  /** Counts and time steps of the present run. */
  struct Counts {
    bigint steps = 0;
    double point_steps = 0.0, dt_min = 0.0, dt_max = 0.0;
  };
  void start_counting() { counts_of_run = {0, 0.0, step_dt(), step_dt()}; }
  /** End of a step of the cycle. */
  void count_step();
  const Counts &counts() const { return counts_of_run; }
  /** Duration of the last step of the cycle; 0: none so far. */
  double dt_of_last_step() const { return last_dt; }
  /** The run continues after a step of this duration. */
  void continue_after(double dt) { last_dt = dt; }

  /** From now on in this run, nodes keep the velocities that they had before the momentum equation:
   *  for a node action or physics that reads them. To be called by init_action() or
   *  init_physics(). */
  void keep_old_velocities() { keep_old = true; }
  bool keeps_old_velocities() const { return keep_old; }
  /** The same, or no longer, until the blocks are renewed. To be called by blocks_found(). */
  void keep_old_velocities_now(bool yes);
  bool keeps_old_velocities_now() const { return keep_old_now; }

  /** [n][3] positions of the end of the step, where points move late: valid from the stage that
   *  finds them to the one that moves the points. */
  std::vector<double> &positions_to_come() { return late_positions; }
  /** Has physics already called for the motion of this step, which then only waits for the
   *  positions? */
  bool has_moved() const { return motion_is_done; }
  void set_moved(bool yes) { motion_is_done = yes; }

  double memory_usage() const;

 private:
  bool running = false, motion_is_done = false;
  bool keep_old = false, keep_old_now = false;
  double last_dt = 0.0;
  std::vector<double> late_positions;
  Counts counts_of_run;

  bool has_contact() const;
};

/** Owner of a field. Implemented by fix mpm. */
class MPMFieldOwner : public MPMCycle {
 public:
  std::unique_ptr<MPMField> field;

  int steps_to_next() const override { return field->steps_to_next(); }

 protected:
  ~MPMFieldOwner() = default;    // owned and deleted as a Fix
};

/** Stops with an error if a field violates one of the rules of a fix. In each rule, the keyword is
 *  the property of the field that cannot be used, and the text gives the reason and the remedy. */
void refuse_field(LAMMPS *, const Fix &user, const MPMField &field, const MPM_NS::OptionRules &);
/** The same for a command. */
void refuse_field(LAMMPS *, const std::string &user, const MPMField &field,
                  const MPM_NS::OptionRules &);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FIELD_H
#define LMP_MPM_FIELD_H

#include "lattice/grid.h"
#include "mpm_field_options.h"
#include "mpm_ledger.h"
#include "pointers.h"
#include "transfer/kernels.h"

#include <list>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class Fix;
class FixMPMElements;
class FixMPMMaterial;
class MPMAffine;
class MPMBoxes;
class MPMCpdi;
class MPMEdges;
class MPMEvery;
class MPMFrame;
class MPMGuard;
class MPMHalo;
class MPMLocking;
class MPMPlan;
class MPMPointMap;
class MPMPointState;
class MPMTimeLimit;
struct MPMPoints;

/** One velocity field on one lattice: options, points, nodes, and an object for each thing that only
 *  some options need. */
class MPMField : protected Pointers {
 public:
  using Options = MPMFieldOptions;

  Fix &fix;    ///< the fix mpm: its ID, its group, its requests for new neighbor lists
  const Options options;
  MPM_NS::Grid grid;    ///< records of momentum: velocity and mass after the momentum equation
  MPM_NS::Lattice &lattice;    ///< that of the grid
  const std::unique_ptr<MPMHalo> halo;
  MPMPoints *const points;
  std::list<MPM_NS::NodeField> node_fields;    ///< of other physics, with a width of their own

  std::vector<FixMPMMaterial *> materials;    ///< all of them, set in init()
  std::vector<FixMPMElements *> elements;     ///< all of them, set in init()
  MPMPlan *plan;                              ///< of all fields, set in init()

  const MPM_NS::MPMKernels *kernels;
  const MPM_NS::BatchKernels *batch_kernels;
  MPM_NS::TransferKernels kernel;    ///< of the step
  MPM_NS::TransferKernels pic;       ///< of other sums over points, with records of 8 reals
  std::unique_ptr<MPM_NS::Batch> batch;

  MPMLedger ledger;
  bool keep_old;    ///< a node action reads what nodes had before the momentum equation; set by its
                    ///< init_action()
  bool running;     ///< between the set-up and the end of a run

  // what depends on the options; null: not with these

  std::unique_ptr<MPMFrame> frame;    ///< never null
  std::unique_ptr<MPMPointMap> map;
  std::unique_ptr<MPMGuard> guard;
  std::unique_ptr<MPMTimeLimit> time_limit;
  std::unique_ptr<MPMAffine> affine;
  std::unique_ptr<MPMBoxes> boxes;
  std::unique_ptr<MPMCpdi> domains;
  std::unique_ptr<MPMEvery> every;
  std::unique_ptr<MPMEdges> edges;
  std::unique_ptr<MPMLocking> locking;

  /** Memory that stages share; nothing in it outlives a stage. */
  struct {
    std::vector<double> nodes;              ///< sums over points other than momentum
    std::vector<double> node_velocities;    ///< [node][3] before XPIC and FMPM add terms
    std::vector<double> vectors;            ///< [n][3] what points give to these, or get of them
    std::vector<double> weights;            ///< [n] with which weights
    std::vector<double> stress;             ///< [n][6]
    std::vector<double> no_volume;          ///< [n] zero
    std::vector<double> xnew;    ///< [n][3] positions of the end of the step, when points move late
  } work;

  /** The per-point arrays that the options ask for are declared in state. */
  MPMField(class LAMMPS *, Fix &, double h, const Options &, MPMPointState &state);
  ~MPMField();

  /** The fields of all fix mpm, in order of definition. */
  static std::vector<MPMField *> all(class LAMMPS *);
  /** The field of a fix mpm; null: the fix does not exist or has another style. */
  static MPMField *find(class LAMMPS *, const std::string &id);

  /** Start of a run. */
  void init(MPMPlan *);
  /** Choose the transfers of this run. */
  void choose_kernels();
  /** The lattice must fit the box, which may have changed since the last run. */
  void check_box();

  /** Points without any stress get the pressure of their equation of state. */
  void give_initial_stress();

  const char *id() const;
  LAMMPS *lammps() const { return lmp; }
  bool is_point(int i) const;
  /** Is atom i a node of finite elements, without stress and material of its own? */
  bool is_element_node(int i) const;
  FixMPMMaterial *material_of(int i) const;
  int npoints_local() const;
  /** Where a point is on the lattice. */
  const double *place(int i) const;
  double **positions() const;
  double volume(int i) const;    ///< present volume of a point
  int nmax() const;              ///< room of per-point arrays

  /** Duration of a step of the cycle. */
  double step_dt() const;
  double end_of_step() const;    ///< time at the end of the present step
  /** Steps of LAMMPS until the next step of the cycle ends, seen from the end of this step. */
  int steps_to_next() const;
  /** Nodes along an axis that a position reaches, see MPMStencil. */
  int weights(double t, int &first, double w[4]) const;
  MPM_NS::PointRows rows() const;
  /** Rows for transfers of other values and weights, in which points stay (the time step is zero). */
  MPM_NS::PointRows rows_at_rest(double *values, const double *weights) const;
  MPM_NS::TransferStep step_data() const;
  /** Do positions of the end of the step have to wait until stress is known? */
  bool moves_late() const;

  /** Load the present state of the n <= BATCH points in list, all of one material, into a batch
   *  (for wave speed and stored energy). history: room for nhistory*BATCH reals. */
  void load_state(MPM_NS::Batch &, const int *list, int n, const FixMPMMaterial *,
                  std::vector<double> &history) const;

  /** Room for history variables of a batch. */
  double (*history_batch())[MPM_NS::BATCH];
  int domain_size() const;    ///< reals of a domain

  /** A node field of other physics, with the given number of reals for each node. */
  MPM_NS::NodeField &add_node_field(const std::string &name, int width);
  /** Make room for all nodes; called when the blocks are new. */
  void allocate_nodes();
  /** Add what the edges, periodic images and other ranks hold of reals [lane, lane+nlane). */
  void sum(double *nodes, int nreal, int lane, int nlane) const;
  void sum(MPM_NS::NodeField &) const;
  /** Values of periodic images and edges, before values go to points. */
  void complete(MPM_NS::NodeField &) const;
  /** Velocities of the nodes, also old ones, where interpolation needs them: images and edges. */
  void complete_velocities();

  /** Position of a node. */
  void node_position(const int index[3], double x[3]) const
  {
    for (int d = 0; d < 3; d++)
      x[d] = d < lattice.dim ? lattice.origin[d] + index[d] * lattice.h : 0.0;
  }
  /** Volume of a cell: of the part of a body that belongs to a node. */
  double cell_volume() const
  {
    const double h = lattice.h;
    return lattice.dim == 3 ? h * h * h : h * h;
  }

  /** Of the present run. */
  struct {
    bigint steps;
    double point_steps, dt_min, dt_max;
  } counts;
  void start_counting();
  void count_step();

  double bytes_per_point() const;
  double memory_usage() const;

 private:
  const MPMPointState &state;
  std::vector<double> history;    // of a batch
};

}    // namespace LAMMPS_NS
#endif

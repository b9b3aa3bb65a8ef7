/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm,FixMPM);
// clang-format on
#else

#ifndef LMP_FIX_MPM_H
#define LMP_FIX_MPM_H

#include "fix.h"
#include "lattice/grid.h"
#include "mpm_node_action.h"
#include "transfer/kernels.h"
#include "transfer/polypic.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class FixMPMElements;
class FixMPMMaterial;
class MPMHalo;
struct MPMPoints;

/** Energy spent or gained since the first step with a ledger, this rank's share [energy]. */
struct MPMLedger {
  double external;    ///< work of atom->f (gravity, contact by pair styles, walls, ...)
  double boundary;    ///< work of node actions of kind boundary
  double contact;     ///< work of node actions between fields
  double internal;    ///< work of the internal forces on the nodes, minus sign: done by the body
  double transfer;    ///< kinetic energy gained (mostly lost: negative) by P2G and G2P
  double deleted_kinetic, deleted_stored;    ///< energy of points that were deleted
};

/** One velocity field on one lattice, and the cycle that moves the material points of its group.
 *
 *  The whole step happens in initial_integrate(): there atom->f is complete whatever the order of
 *  fixes, and all state is on one time level at output. The first instance drives all of them.
 */
class FixMPM : public Fix {
 public:
  enum Scheme { USL, USF, MUSL, USAVG };
  enum Extent { NO_SIZE, UNIFORM, CONTIGUOUS, PARALLELEPIPED, CORNERS };
  enum Refinement { LUMPED, XPIC, FMPM };
  enum Locking { NO_CURE, FBAR, PRESSURE, BOTH };    ///< cure for volumetric locking
  enum Policy { ERROR, WARN, DELETE };
  enum Stress { DEFAULT_STRESS, MLS_STRESS, GRADIENT_STRESS };

  FixMPM(class LAMMPS *, int, char **);
  ~FixMPM() override;
  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void setup_pre_neighbor() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_exchange() override;
  void pre_neighbor() override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int) override;
  int maxsize_restart() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  // settings

  MPM_NS::Lattice lattice;
  MPM_NS::Shape shape;    ///< B-spline, or the one that has the stencil: QUADRATIC with a size,
                          ///< LINEAR with a domain
  bool bernstein;         ///< Bernstein polynomials, which have the stencil of QUADRATIC
  Extent extent;          ///< size of points: none, fixed (GIMP), with F (contiguous GIMP); domains
                          ///< with F (CPDI), or corners that move (CPDI2)
  double aspect[3];       ///< edges of an undeformed point of some size; their product is 1
  MPM_NS::Transfer transfer;
  double flip;              ///< FLIP share, 0 for PIC
  bool poly;                ///< bilinear modes of the velocity, too; transfer is APIC then
  Refinement refinement;    ///< of the velocities of the nodes, with transfer FLIP inside
  int order;                ///< terms of the inverse of the mass matrix, 1: lumped
  bool total;               ///< nodes are places of the reference configuration (total Lagrangian)
  double most_distorted;    ///< ratio of stretches that asks for a new reference, 0: never
  bool axisymmetric;        ///< 2d: x is the distance from the axis y, points are rings
  Scheme scheme;
  Stress stress;      ///< how stress acts on nodes, and how these strain the points
  Locking locking;    ///< what is averaged against volumetric locking
  double
      light;    ///< nodes with less than this share of a cell full of material are light; 0: none
  Policy policy;          ///< what to do with a point that goes bad
  bool delete_failed;     ///< remove points whose damage is 1
  bool modified_edges;    ///< functions next to fixed faces need no nodes outside
  int every;              ///< steps of LAMMPS in a step of the cycle
  bool dt_check;          ///< stop when the time step is above the stable limit
  bool watch_volume;      ///< keep volume_rate; set at the start of a run by fix mpm/dt
  bool keep_old;    ///< a node action reads what nodes had before the momentum equation; set by
                    ///< its init_action()

  // state of the step, for node actions and output

  MPM_NS::Grid *grid;                         ///< node records: velocity and mass after the solve
  std::vector<FixMPMMaterial *> materials;    ///< all of them, set in init()
  std::vector<FixMPMElements *> elements;     ///< all of them, set in init()
  double **C;    ///< [n][dim*dim] affine, column-major; null: transfer without
  double **Q;    ///< [n][poly_size(dim)] bilinear modes of the velocity; null: transfer without
  double *
      *corners;    ///< [n][2^dim][dim] CPDI2: from the point, in the order of transfer/cpdi.h, NAN
                   ///< before the first step; null: other shapes
  double **X;      ///< [n][3] reference position, NAN before it is known; null: updated frame
  double **R;      ///< [n][9] F at the last update of the reference, row-major; null: there is none
  double *
      *waiting;    ///< [n][6 or 9] impulse since the last step of the cycle, displacement from the
  ///< place on the lattice, angular impulse if atoms have torques; null: every is 1
  bool ledger_on;    ///< a compute mpm/energy exists; set in init()
  MPMLedger ledger;

  /** Largest |J/J_old - 1|/dt of this rank's points in all steps since it was set to zero, and whose. */
  struct {
    double most;
    tagint tag;
  } volume_rate;

  std::vector<double> ledger_start;    ///< of compute mpm/energy, until the end of the next run

  /** Does the scheme update stress at the start, at the end of the step, or (neither) in between? */
  bool stress_before() const { return scheme == USF || scheme == USAVG; }
  bool stress_after() const { return scheme == MUSL || scheme == USAVG; }
  /** What does the cure for locking average: changes of volume, pressures in the force? */
  bool averages_strain() const { return locking == FBAR || locking == BOTH; }
  bool averages_stress() const { return locking == PRESSURE || locking == BOTH; }
  /** Is the velocity gradient of a point another matrix than the affine one, by the gradients of
   *  the shape functions instead of their moments? */
  bool strains_apart() const
  {
    return stress == GRADIENT_STRESS && MPM_NS::is_mls(kernel_shape(), transfer);
  }
  /** Are the old positions needed after G2P? */
  bool moves_late() const
  {
    return stress_after() || light > 0.0 || (averages_strain() && !stress_before());
  }

  /** Duration of a step of the cycle. */
  double step_dt() const;
  /** Steps of LAMMPS until the next step of the cycle ends, seen from the end of this step. */
  int steps_to_next() const { return waited < every ? every - waited : every; }

  /** True when atom i is a material point of this field. */
  bool is_point(int i) const;
  /** Where a point is on the lattice. */
  const double *place(int i) const;
  /** Angular momentum of the affine motion of a point about itself (mass distance velocity units):
   *  zero without affine matrix, and before the first step. */
  void affine_angmom(int i, double L[3]) const;
  /** Deformation gradient of a point with respect to the places of the lattice (total frame). */
  void lattice_F(int i, double F[9]) const;
  /** Material of a point of this field (null: none). */
  FixMPMMaterial *material_of(int i) const;
  /** True when atom i is a node of finite elements: without stress and material of its own. */
  bool is_node(int i) const;
  /** Number of points of this field on this rank. */
  int npoints_local() const;

  /** Load the present state of the n <= BATCH points in list, all of one material, into a batch
   *  (for wave speed and stored energy). history: room for nhistory*BATCH reals. */
  void load_state(MPM_NS::Batch &, const int *list, int n, const FixMPMMaterial *,
                  std::vector<double> &history) const;

  /** Smallest over this rank's points of h/(c + |v|); the point's tag goes to id. */
  double stable_dt_local(tagint &id, double &wave_speed) const;

  /** The blocks of this field are to be found anew in this step. */
  bool topology_stale() const { return !topology_valid; }
  void renew_topology() { topology_valid = false; }

  /** Length of the circle with radius r around the axis; 1 without axis of symmetry. */
  double circle(double r) const { return axisymmetric ? 6.28318530717958647693 * r : 1.0; }
  /** Of the circle through a node; at the axis and beyond it that of a quarter of a cell from it. */
  double node_circle(int slot, int node) const;

  enum Content { OF_MASS, OF_VOLUME };
  /** At the nodes of blocks that are marked in near (and others): sum_p w_p grad N(x_p) with the
   *  mass or volume w of the points, [node][3]. */
  void map_gradient(Content, const std::vector<char> &near, std::vector<double> &gradient);
  /** At the same nodes: sum_p V_p N(x_p) as share of the volume h^dim of a node, [node]. */
  void map_volume(const std::vector<char> &near, std::vector<double> &share);
  /** At the points, [n]: that share of the volume, which is 1 inside of a body and falls to 0 across
   *  its surface. Points that have failed do not count as volume. A body on a fixed face of the box
   *  has no surface there (updated frame, faces in planes of nodes). Finds the blocks if need be. */
  void volume_at_points(std::vector<double> &share);

  /** Add what periodic images and other ranks hold of reals [lane, lane+nlane) of nodes that are
   *  arranged like those of the grid. */
  void sum_copies(double *nodes, int nreal, int lane, int nlane);
  /** Impulse of a node action to a node, with its energy as contact in the ledger. */
  void push_node(int64_t node, bool owned, const double *impulse);
  /** The energy of an action that has changed the velocity of an owned node, as contact in the ledger. */
  void count_push(const double *record, const double *change);

  /** Nodes along one axis that a position reaches (in node spacings from the origin): their number,
   *  the first one, and the weights. */
  int shape_weights(double t, int &first, double w[4]) const;

  /** Calls f(point, wanted[node], weight, r) for each point and each node that it reaches where wanted
   *  is not negative (wanted: [node]; r: from the node to the point, in node spacings). */
  void visit_points(const std::vector<int> &wanted,
                    const std::function<void(int, int, double, const double *)> &f) const;
  /** Adds up what ranks have of nodes they share: all reals of [node][nreal]. */
  void sum_over_ranks(double *nodes, int nreal) const;

  /** Position of a node. */
  void node_position(const int index[3], double x[3]) const
  {
    for (int d = 0; d < 3; d++)
      x[d] = d < lattice.dim ? lattice.origin[d] + index[d] * lattice.h : 0.0;
  }

 private:
  struct Run {    // consecutive points of one block and material (null: nodes of elements)
    int first, last, slot;
    FixMPMMaterial *material;
  };
  struct ActiveBlock {    // a block with points: its runs, and boxes of base nodes
    int slot, first_run, last_run;
    int box[6], box_apart[6];    // of the last P2G, and of the last sum apart from it
    int low[3], high[3];         // domains: offsets of the first and last blocks that are in reach
  };
  struct Report {    // of the present run
    double t_topology, t_p2g, t_halo, t_nodes, t_g2p, t_sort;
    bigint steps, point_steps, topologies, sorts, references;
    double dt_min, dt_max;
  };

  MPM_NS::Shape kernel_shape() const
  {
    if (bernstein) return MPM_NS::BERNSTEIN;
    constexpr MPM_NS::Shape others[] = {MPM_NS::GIMP, MPM_NS::GIMP, MPM_NS::CPDI, MPM_NS::CPDI2};
    return extent == NO_SIZE ? shape : others[extent - 1];
  }
  bool has_boxes() const { return extent == UNIFORM || extent == CONTIGUOUS; }
  bool has_domains() const { return extent == PARALLELEPIPED || extent == CORNERS; }
  /** Reals that describe a domain. */
  int domain_size() const
  {
    return extent == CORNERS ? lattice.dim << lattice.dim : lattice.dim * lattice.dim;
  }
  /** Reals of a tile, of which there are two. */
  std::size_t tile_reals() const
  {
    return 8 * (has_domains() ? MPM_NS::domain_tile_nodes(lattice.dim) : MPM_NS::MAX_TILE_NODES);
  }
  int affine_size() const { return lattice.dim * lattice.dim; }
  /** Reals that each point has of this fix. */
  int own_size() const
  {
    return (C ? affine_size() : 0) + modes_size() + (X ? 3 : 0) + (R ? 9 : 0) +
        (corners ? domain_size() : 0) + waiting_size();
  }
  int waiting_size() const;
  int modes_size() const { return poly ? MPM_NS::poly_size(lattice.dim) : 0; }

  MPMPoints *points;
  MPMHalo *halo;
  MPM_NS::TransferKernels kernel, pic;    // pic: for sums apart from the step
  MPM_NS::PolyKernels modes;
  const MPM_NS::MPMKernels *kernels;
  const MPM_NS::BatchKernels *batch_kernels;
  std::string isa;                         // wanted instruction set, empty: the best
  std::vector<MPMNodeAction *> actions;    // only in the driving instance
  std::vector<FixMPM *> fields;            // only in the driving instance: all fields
  bool driver;

  std::vector<Run> runs;              // grouped by block
  std::vector<ActiveBlock> active;    // blocks with points
  bool topology_valid;
  bool watch_drift;          // rebuilds of neighbor lists do not bound the drift: check every step
  int drifted;               // a point has left the range of its tile
  bool refer_anew;           // the present configuration is to become the reference
  bool want_sort;            // order of points has decayed since the last sort
  bigint switches;           // neighbours in memory that are in different cells, now
  bigint switches_sorted;    // and right after the last sort
  double *tile, *tile_load;
  std::vector<double> xnew;               // when points move late: position at the end of the step
  std::vector<double> v_apart, lumped;    // XPIC, FMPM: velocities of points and nodes
  int waited;                             // steps of LAMMPS since the last step of the cycle,
  double elapsed;                         // and their duration, if every is above 1
  std::vector<double> mean_force, mean_torque;    // over them
  std::vector<double> gradients;                  // F-bar: velocity gradients of the points
  std::vector<double> tau_averaged;               // stress with averaged pressure
  std::vector<double> hoop;       // axisymmetric: strain around the axis in this step
  std::vector<double> domains;    // CPDI: half edges of the domains, [n][dim][dim]
  std::vector<double>
      corners_late;             // CPDI2, when points move late: corners at the end of the step
  std::vector<double> sizes;    // GIMP: half sizes of points in node spacings, [n][3]
  std::vector<double> history_batch;    // history variables of a batch
  std::vector<double> nodes_apart;      // sums apart from the step,
  std::vector<double> rows_apart;       // and rows of the points for them
  std::vector<double> zero_volume;
  MPM_NS::Batch *batch;
  Report report;
  double before_actions;                // ledger: sum of entries before node actions
  double kinetic_points;                // ledger: at the end of the last step
  std::vector<tagint> bad_points;       // of this step, policies warn and delete
  std::vector<tagint> failed_points;    // of this step, to be deleted
  struct {
    double points, mass, momentum[3];
  } deleted;    // so far, on all ranks
  bigint nbad_total, next_dt_check;
  double clock;
  bool running;           // between setup() and post_run()
  uint64_t velocities;    // hash of those that C belongs to, between runs
  bool velocities_known;

  void find_topology();

  template <class F> void visit_nodes(const MPM_NS::Grid::Block &, int i, const F &f) const;
  template <class F>
  void visit_nodes(const MPM_NS::Grid::Block &, int i, const double *x, double share,
                   const F &f) const;

  // functions next to fixed faces
  struct EdgeNodes {
    int64_t outside, face, inside;    // outside is negative if no point reaches it
  };
  typedef std::vector<EdgeNodes> EdgeLists[3];    // by axis
  EdgeLists edges;                                // empty: functions are the same everywhere
  void check_edges() const;
  bool face_on_nodes(int a, int side, int &plane) const;
  void list_edges(EdgeLists &, bool without_outside) const;
  void fold_edges(double *nodes, int nreal, int lane, int nlane) const;
  void extend_edges(double *nodes, int nreal, int lane, int nlane) const;
  void extend_edges();

  // stages of the step
  bool wait();    // all fields: true when it is not yet time for the cycle
  void add_waiting();
  void end_waiting();
  void update_topology();    // of all fields
  void find_blocks();
  void update_sizes();
  void box_sizes(int i, double *size) const;
  double half_size(int i) const;
  void update_domains();
  void box_domain(int i, double *edge) const;
  void reset_corners(int i);
  void domain_reach(int i, double low[3], double high[3]) const;
  void limit_domain(int i);
  void check_corners();
  double domain_corners(int i, double *x, double *w) const;
  void finish_topology();
  void points_to_grid();
  void stress_first();
  void solve();
  void refine_velocities();    // of all fields
  void filter_old_velocities();
  void swap_old_velocities();
  void save_velocities(int lane);
  void add_term(int lane);
  void grid_to_points();
  bool any_light() const;    // of all fields
  void blend_light_nodes();
  void gradient_with_light_nodes();
  void map_back();
  void stress_last();
  void bookkeeping();

  // their parts
  void act_on_nodes(MPMNodeAction::Stage);
  void check_light_nodes();
  double light_share();
  void map_to_nodes(MPM_NS::P2G);
  void map_run(MPM_NS::P2G, const MPM_NS::PointRows &, const MPM_NS::TransferStep &, const Run &,
               const int base[3], int box[6]);
  template <class Map> void map_apart(const MPM_NS::TransferKernels &, const Map &);
  template <class Gather> void gather_apart(const MPM_NS::TransferKernels &, const Gather &);
  template <class Use>
  void visit_gradients(double *of_all, const Use &, double *corners_new = nullptr);
  template <class Weigh>
  void map_some(const MPM_NS::PointRows &, const MPM_NS::TransferStep &, MPM_NS::P2G,
                const std::vector<char> &near, int lane, int nlane, const Weigh &);
  void average_around_points();
  double volume_change(int i, const double *L, double dt) const;
  void averaged_material(const double *L, double dt);
  void average_pressure();
  void move_points();
  void check_axis();
  double reference_radius(int i) const;
  double total_radius(int i) const;
  double hoop_stiffening(int i) const;
  void note_radii(int first, int last);
  void hoop_of_motion(const MPM_NS::PointRows &, int first, int last);
  void hoop_of_nodes(const MPM_NS::PointRows &, const MPM_NS::TransferStep &, int first, int last,
                     const int base[3], double dt, double shift);
  void add_hoop_force(const MPM_NS::PointRows &, bigint first, int n, double *f) const;
  void tile_base(const ActiveBlock &, int base[3]) const;
  void load_tile(const ActiveBlock &, int base[3]);
  void sum_halo(int lane, int nlane);
  void gradient_and_material(double dt, double shift);
  void material_update(const MPM_NS::PointRows &, const Run &, int first, int n, const double *L,
                       double dt);
  void note_volume_rate(const MPM_NS::Batch &, int first);
  void lap(double &timer);

  uint64_t velocity_hash() const;
  void remember_velocities();
  void check_velocities();
  void set_reference();
  void refer_gradients(int first, int n, double *L) const;
  void stretches(int i, double &smallest, double &largest) const;
  void check_distortion();
  void update_reference();
  void fit_affine();
  void add_torques();
  void process_options(int, char **);
  void check_box();
  bool restart_step() const;
  void check_integrators();
  void check_points();
  void check_neighbors();
  void check_radii();
  void check_inside_box();
  void check_dt();
  double stable_share(double size) const;
  void warn_dt();
  void point_is_bad(int i, const std::string &what,
                    const std::string &cure = "it keeps its previous deformation");
  void handle_bad_points();
  bool may_delete() const { return policy == DELETE || delete_failed; }
  void delete_points(const std::vector<tagint> &, bool warn);
  std::string point_state(int i) const;
  int find_local(tagint) const;

  bool base_node(const double *x, int base[3], double t[3]) const;
  void give_initial_stress();
  void sort_points();
  double current_time() const;    ///< during a step: its end
  double nodal_kinetic_energy(int lane) const;
  double point_kinetic_energy() const;
  double external_work(const double *force_on);
  void account_for_nodes();
  double bytes_per_point() const;
  MPM_NS::PointRows rows() const;
  MPM_NS::PointRows rows_at_rest(double *values, const double *weights) const;
  MPM_NS::TransferStep step_data() const;
};

}    // namespace LAMMPS_NS
#endif
#endif

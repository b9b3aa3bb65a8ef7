/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mesh,FixMPMMesh);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MESH_H
#define LMP_FIX_MPM_MESH_H

#include "base/mpm_state.h"
#include "base/mpm_step_limit.h"
#include "declare/option.h"
#include "field/mpm_point_batches.h"
#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_conditions.h"
#include "meshgrid/mpm_mesh_means.h"
#include "meshgrid/mpm_mesh_ranks.h"

#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
struct Batch;
struct BatchKernels;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class FixMPMMaterial;
class FixMPMMeshContact;
class FixMPMMeshHeat;
struct MPMMeshBodies;
struct MPMPoints;

/** Keywords of fix mpm/mesh. */
struct MPMMeshOptions {
  enum Transfer { FLIP, APIC };

  std::string file, part;
  bool total = false;    ///< nodes belong to the reference configuration
  bool musl = true;      ///< compute strain from velocities that were mapped back
  Transfer transfer = FLIP;
  double flip = 0.99;    ///< share of FLIP; the rest is PIC
  bool fbar = false;     ///< average volume changes and mean stress, against locking
  std::vector<MPMMeshCondition> conditions;

  MPM_NS::Options declare(int dim);

 private:
  MPMMeshCondition next;    // being read
};

/** Material points on a mesh of linear elements of any shape (V.P. Nguyen, A. de Vaucorbeil, S. Bordas, The Material Point
 *  Method, Springer 2023, chapter 5), in place of the lattice of a fix mpm. As in fix mpm, initial_integrate() does the
 *  whole step. */
class FixMPMMesh :
    public FixMPMState,
    public MPMStepLimit,
    public MPMPointOwner,
    private MPMMeshOptions {
 public:
  FixMPMMesh(class LAMMPS *, int, char **);
  ~FixMPMMesh() override;
  int setmask() override { return FixConst::INITIAL_INTEGRATE | FixConst::PRE_NEIGHBOR; }
  void init() override;
  void setup_pre_neighbor() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_neighbor() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double stable_dt(tagint &tag) const override;

  void visit_batches(int group_bits, const BatchVisitor &) override;

 private:
  /** Sums of points at a node. */
  struct Node {
    double mass, momentum[3], force[3], load[3];    // load: external part of the force
  };
  static constexpr int WIDTH = 10;    // number of reals in a Node

  std::unique_ptr<MPM_NS::BackgroundMesh> mesh;
  MPMMeshRanks ranks;
  std::unique_ptr<MPMMeshForces> forces;
  double shortest;    // height of the smallest cell, for artificial viscosity

  // of points

  double *cell = nullptr;    // number of its cell + 1; 0: unknown
  MPMRows X;                 // position in the reference configuration; total frame only
  MPMRows C;                 // velocity gradient of APIC, row-major [9]
  std::vector<MPM_NS::BackgroundMesh::Place> places;
  std::vector<int> order;    // points of this rank, sorted by ID

  // of nodes; with contact, of the nodes of each body in turn

  FixMPMMeshContact *contact = nullptr;
  FixMPMMeshHeat *heat = nullptr;
  std::vector<char> has_node;    // on this rank
  std::vector<Node> sums;
  std::vector<MPM_NS::MeshVector> before, after, mapped;    // velocities

  // present positions of the nodes of the reference configuration, for a follower pressure and for means. They are always kept, as
  // either may be added after a restart. Updated frame: empty

  std::vector<MPM_NS::MeshVector> positions;
  std::vector<char> counts_cell;    // [cell] is this the first rank with points in the cell?

  /** Data of a point in this step for the averages against locking. */
  struct Volumetric {
    int group;        // number of the group of points with means of their own
    double weight;    // weight in the means of this step
    double stress;    // mean Kirchhoff stress for the force
    double own,
        all;    // volume ratio at the start: by the motion of the point; mean; updated frame: 1
    double scale;    // factor on the motion in each direction
  };
  std::unique_ptr<MPMMeshMeans> means;    // null: none
  std::vector<Volumetric> volumetric;

  MPMPoints *points = nullptr;
  std::vector<FixMPMMaterial *> materials;
  const MPM_NS::BatchKernels *kernels = nullptr;
  std::unique_ptr<MPM_NS::Batch> batch;
  std::vector<double> history;    // [variable][BATCH]
  double load_work = 0.0;         // work of external forces on nodes of this rank
  bigint steps = 0;

  bool is_point(int i) const;
  const double *position(int i) const;
  int count_bodies() const;
  std::size_t rows_of(int i) const;
  double mass_of_all(int node) const;
  MPMMeshBodies bodies();
  FixMPMMaterial *material_of(int i) const;
  void check_points();
  void warn_of_locking();
  void warn_of_sides() const;
  void warn_of_flow() const;
  void find_places();
  void find_ranks();
  bool lacks_nodes() const;
  void share_positions();
  void motion_of_nodes(const MPM_NS::BackgroundMesh::Place &, double F[9]) const;
  void find_mean_stress();
  void find_mean_strain(const std::vector<MPM_NS::MeshVector> &velocities);
  void scale_motion(int i, double *L) const;
  void points_to_nodes();
  void find_velocities();
  void map_back();
  void nodes_to_points();
  void move_and_strain();
  void give_initial_stress();
  void check_dt();
  void find_materials();
  void find_contact();
  void find_heat();
  template <class Visit> void for_batches(const std::vector<int> &of, Visit) const;
  void load_state(const int *list, int n, const FixMPMMaterial *) const;
};

}    // namespace LAMMPS_NS
#endif
#endif

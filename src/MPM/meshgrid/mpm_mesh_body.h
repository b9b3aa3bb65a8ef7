/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_BODY_H
#define LMP_MPM_MESH_BODY_H

#include "base/mpm_state.h"
#include "declare/option.h"
#include "field/mpm_point_batches.h"
#include "material/batch_kernels.h"
#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_conditions.h"
#include "meshgrid/mpm_mesh_ranks.h"
#include "pointers.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class FixMPMMaterial;
class FixMPMMeshContact;
class MPMMeshFbar;
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

/** Material points on a mesh, its nodes, and the transfers between them in a step. */
class MPMMeshBody : protected Pointers {
 public:
  MPMMeshBody(class LAMMPS *, const Fix &, const MPMMeshOptions &, const MPM_NS::BackgroundMesh &,
              MPMMeshForces &);
  ~MPMMeshBody();

  const MPM_NS::BackgroundMesh &mesh;
  MPMMeshRanks ranks;
  MPMMeshForces &forces;
  double shortest;    ///< height of the smallest cell, for artificial viscosity

  // of points
  double *cell = nullptr;    ///< number of its cell + 1; 0: unknown
  MPMRows X;                 ///< position in the reference configuration; total frame only
  MPMRows C;                 ///< velocity gradient of APIC, row-major [9]
  std::vector<MPM_NS::BackgroundMesh::Place> places;
  std::vector<int> order;    ///< points of this rank, sorted by ID
  MPMPoints *points = nullptr;
  std::vector<FixMPMMaterial *> materials;
  const MPM_NS::BatchKernels *kernels = nullptr;
  std::unique_ptr<MPM_NS::Batch> batch;

  // of nodes; with contact, of the nodes of each body in turn
  std::vector<char> has_node;    ///< on this rank
  /** Present positions of the nodes of the reference configuration, for a follower pressure and for
   *  means. They are always kept, as either may be added after a restart. Updated frame: empty. */
  std::vector<MPM_NS::MeshVector> positions;
  std::vector<char> counts_cell;    ///< [cell] is this the first rank with points in the cell?
  double load_work = 0.0;           ///< work of external forces on nodes of this rank

  /** Prepares a run; contact: of bodies with their own velocities at the nodes, or null. */
  void begin_run(FixMPMMeshContact *contact);
  void find_materials();
  bool is_point(int i) const;
  FixMPMMaterial *material_of(int i) const;
  /** Position of a point in the mesh. */
  const double *position(int i) const;
  int count_bodies() const;
  /** The row of the first node of the body of a point. */
  std::size_t rows_of(int i) const;
  /** Mass of body b at a node. */
  double mass_of(int b, int node) const { return sums[b * mesh.nodes.size() + node].mass; }
  /** Does this rank count a node that has mass of any body? */
  bool counts_mass_at(int node) const;
  /** Deformation gradient of the nodes at a place; in 2d the part in the plane is set. */
  void motion_of_nodes(const MPM_NS::BackgroundMesh::Place &, double F[9]) const;
  /** Largest time step h/(c + |v|), and the ID of its point; NaN if it is none. */
  double stable_dt(tagint &tag) const;
  /** Calls visit(list, n, material) for batches of n of these points of a material. */
  template <class Visit> void for_batches(const std::vector<int> &of, Visit visit) const;
  /** Fills the batch with the present state of points. */
  void load_state(const int *list, int n, const FixMPMMaterial *) const;
  double memory_usage() const;

  // a step, in this order
  /** Lists the points of this rank, after these have changed. Sums go over points in the order of
   *  their IDs, which does not depend on what was before. Collective. */
  void list_points();
  /** Finds the cells of all points. */
  void find_places();
  /** Are there points in cells whose nodes this rank has not? Collective. */
  bool lacks_nodes() const;
  /** Finds the nodes of this rank. Collective. */
  void find_ranks();
  /** Gives the positions of nodes to all ranks. Collective. */
  void share_positions();
  void points_to_nodes();
  /** Velocities of nodes after forces, contact, and conditions. */
  void find_velocities();
  /** Velocities of points. */
  void nodes_to_points();
  /** MUSL: the velocities of points, once more on the nodes, for the strain. */
  void map_back();
  void move_and_strain();

 private:
  /** Sums of points at a node. */
  struct Node {
    double mass, momentum[3], force[3], load[3];    // load: external part of the force
  };
  static constexpr int WIDTH = 10;    // number of reals in a Node

  double mass_of_all(int node) const;
  void velocity_at(int i, int node, double *u) const;

  const Fix &fix;
  const MPMMeshOptions &options;
  FixMPMMeshContact *contact = nullptr;
  std::vector<Node> sums;
  std::vector<MPM_NS::MeshVector> before, after, mapped;    // velocities
  std::vector<double> history;                              // [variable][BATCH]
  std::unique_ptr<MPMMeshFbar> fbar;                        // null: no means against locking
  friend class MPMMeshFbar;
};

template <class Visit> void MPMMeshBody::for_batches(const std::vector<int> &of, Visit visit) const
{
  for (auto *material : materials) {
    int list[MPM_NS::BATCH], n = 0;
    for (const int i : of) {
      if (material_of(i) != material) continue;
      list[n++] = i;
      if (n < MPM_NS::BATCH) continue;
      visit(list, n, material);
      n = 0;
    }
    if (n) visit(list, n, material);
  }
}

}    // namespace LAMMPS_NS
#endif

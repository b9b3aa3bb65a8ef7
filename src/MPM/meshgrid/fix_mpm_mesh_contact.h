/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mesh/contact,FixMPMMeshContact);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MESH_CONTACT_H
#define LMP_FIX_MPM_MESH_CONTACT_H

#include "contact/mpm_node_contact.h"
#include "declare/option.h"
#include "fix.h"
#include "math/hull_distance.h"
#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_conditions.h"

#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {
class MPMMeshBody;
struct MPMPoints;

/** Keywords of fix mpm/mesh/contact. */
struct MPMMeshContactOptions : MPMContactLaw {
  MPM_NS::Options declare();
};

/** Contact of bodies, groups of points of one fix mpm/mesh, each with its own velocities at the
 *  nodes. */
class FixMPMMeshContact : public Fix, private MPMMeshContactOptions {
 public:
  FixMPMMeshContact(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm/mesh
  void init() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override { return report.work(); }
  double compute_array(int row, int column) override { return report.at(row, column); }
  double memory_usage() override;

  /** ID of its fix mpm/mesh. */
  const std::string &mesh_fix() const { return mesh_id; }
  /** Number of bodies. */
  int count() const { return (int) groups.size(); }
  /** Body of a point with this group mask; -1: none, -2: several. */
  int body_of(int mask) const;

  /** Prepares a run. */
  void begin_run(const MPM_NS::BackgroundMesh &);
  /** Applies impulses between bodies to velocities [row] of nodes where they touch. decided: for
   *  velocities that were mapped back, which are in contact at the same nodes as found earlier in
   *  this step. Collective. */
  void act(MPMMeshBody &, std::vector<MPM_NS::MeshVector> &velocities, bool decided);

  static constexpr int MAX_BODIES = 8;

 private:
  struct Node {               // where bodies touch
    int node, first, last;    // range in pairs
  };
  /** A point of one of two bodies in reach of a node that both have. */
  struct Near {
    int row;    // index of the node among the shared nodes
    bool is_of_b;
    double weight;    // node function at the point
    double r[3];      // vector from the node to the point, in sizes of the node
    int point;
  };
  std::string mesh_id;
  std::vector<int> groups;    // bits
  MPMPoints *points = nullptr;
  std::vector<double> sizes;    // [node] size of the volume that belongs to it
  std::vector<Node> nodes;
  /** Contacts, with normals within the directions that conditions leave free. */
  std::vector<MPMNodeContact> pairs;
  std::vector<std::pair<int, MPMNodeContact>> found;    // with their nodes
  double overlap = 0.0;    // largest overlap in this step, in sizes of points
  bool look = true;        // check for overlap
  MPMContactReport report;

  // of the pair of bodies that is being treated
  std::vector<int> row, node_of_row;    // [node] row, -1: not shared; [row] node
  std::vector<Near> near;
  std::vector<MPM_NS::HullDistance> hulls;
  std::vector<MPM_NS::MeshVector> normals;
  std::vector<double> ends;

  void find(MPMMeshBody &);
  void find_near(MPMMeshBody &, int a, int b);
  void find_normals(MPMMeshBody &);
  void separate_mixed(MPMMeshBody &);
  void find_gaps(MPMMeshBody &, int a, int b);
  void solve(MPMMeshBody &, const Node &, std::vector<MPM_NS::MeshVector> &velocities,
             bool decided);
  void warn_overlap();
};

}    // namespace LAMMPS_NS
#endif
#endif

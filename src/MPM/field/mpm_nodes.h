/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODES_H
#define LMP_MPM_NODES_H

#include "lattice/grid.h"
#include "pointers.h"

#include <algorithm>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {

/** Values of the nodes other than mass and momentum: width reals for each node of a Grid, in the
 *  order of its blocks: node slot*64 + n. */
struct NodeField {
  const std::string name;
  const int width;
  std::vector<double> values;

  double *at(int64_t node) { return values.data() + node * width; }
  const double *at(int64_t node) const { return values.data() + node * width; }
  void zero() { std::fill(values.begin(), values.end(), 0.0); }
};

}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;
class MPMHalo;

/** Nodes at the fixed faces of the box that are planes of nodes, with their neighbors. */
class MPMEdges : protected Pointers {
 public:
  struct Nodes {
    int64_t outside, face, inside;    ///< outside is negative if no point reaches it
  };
  std::vector<Nodes> lists[3];    ///< by axis

  MPMEdges(class LAMMPS *lmp, const MPMField &field) : Pointers(lmp), field(field) {}

  /** Stops with an error if a fixed face is not a plane of nodes. */
  void check() const;
  /** Makes the lists. without_outside: also with nodes whose neighbor outside does not exist. */
  void find(bool without_outside);

  /** For functions that are modified at the faces: moves the sums of this rank at nodes outside to
   *  the nodes at the face and inside, before the sums of other ranks are added. nodes:
   *  [node][nreal], of which the nlane reals from lane on. */
  void fold(double *nodes, int nreal, int lane, int nlane) const;
  /** Sets the values of nodes outside, for interpolation. Where faces meet, the last axis overrides
   *  others. */
  void extend(double *nodes, int nreal, int lane, int nlane) const;
  double memory_usage() const;

 private:
  const MPMField &field;
  bool face_on_nodes(int axis, int side, int &plane) const;
};

/** Values at the nodes of a field. Sums over this rank's points become sums over all ranks here,
 *  with periodic images and edges. Other physics stores its values here. */
class MPMNodes : protected Pointers {
 public:
  const std::unique_ptr<MPMHalo> halo;
  const std::unique_ptr<MPMEdges> edges;    ///< null: the functions next to fixed faces are plain

  MPMNodes(class LAMMPS *, const MPMField &, MPM_NS::Grid &);
  ~MPMNodes();

  /** Adds values of other physics, with this number of reals for each node. */
  MPM_NS::NodeField &add_field(const std::string &name, int width);
  void clear_fields() { fields.clear(); }
  /** Allocates room for all nodes; called when the blocks are new. */
  void allocate(int nreal);

  /** Adds the parts of reals [lane, lane+nlane) that edges, periodic images, and other ranks
   *  hold. */
  void sum(double *values, int nreal, int lane, int nlane) const;
  void sum(MPM_NS::NodeField &of) const { sum(of.values.data(), of.width, 0, of.width); }
  /** Sets the values of periodic images, and the first nlane reals of edges, before values go to
   *  points. */
  void complete(double *values, int nreal, int nlane) const;
  void complete(MPM_NS::NodeField &of) const { complete(of.values.data(), of.width, of.width); }
  /** Completes the velocities of the step, also the old ones. */
  void complete_velocities();

  double memory_usage() const;

 private:
  MPM_NS::Grid &grid;
  std::list<MPM_NS::NodeField> fields;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MIRROR_NODES_H
#define LMP_MPM_MIRROR_NODES_H

#include "field/node_line.h"
#include "walls/mpm_wall_contact.h"
#include "walls/mpm_wall_gap.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class Domain;
class MPMField;
class MPMWall;

/** A line of nodes through a face that cuts cells, in the order along the axis. */
struct MPMFaceLine : NodeLine {
  MPMContactState state = MPMContactState::OPEN;
  bool touched = true;    ///< separate: the surface of the material touches it in this step
};

/** The node in the plane of a face, DEPTH nodes inside, and their mirror images; -1: out of reach
 *  of points. */
struct MPMMirrorColumn {
  static constexpr int DEPTH = 3;    ///< paired nodes on either side of a mirror plane
  static constexpr int LENGTH = 1 + 2 * DEPTH;

  int64_t node[LENGTH];
  MPMContactState state = MPMContactState::OPEN;
  bool touched = true;    ///< as for lines
};

/** A face of the box on the lattice of a field. It lies in a plane of nodes, or cuts cells. */
struct MPMBoxFace {
  int axis;
  int inward;          ///< direction from the face into the box along the axis: 1 or -1
  int plane;           ///< index of its plane of nodes, or the nearest one
  bool cut = false;    ///< lies between planes: nweight nodes from first on make its velocity
  int first = 0, nweight = 0;
  double weight[NodeLine::MOST];
  MPMContactDistance contact;              ///< of material that touches it
  std::vector<MPMFaceLine> lines;          ///< if it cuts cells
  std::vector<MPMMirrorColumn> columns;    ///< else, with friction or separation

  MPMBoxFace(const MPMField &, const Domain &, int face);
  /** Range of nodes along the axis that are treated together. */
  int begin() const { return cut ? first : plane - MPMMirrorColumn::DEPTH; }
  int end() const { return cut ? first + nweight - 1 : plane + MPMMirrorColumn::DEPTH; }
  /** Number of lines or columns. */
  std::size_t size() const { return cut ? lines.size() : columns.size(); }
  /** Position on its axis. */
  double position(const Domain &) const;
  /** Distance of a place from the face, positive in the box. */
  MPMDistanceFrom distance(const Domain &) const;
  /** Adds the line or column through a node, which is the first one of a line, or in the plane. */
  void add_line(const MPMField &, const int *index);

 private:
  MPMContactDistance contact_of(const MPMField &, double x) const;
};

/** Velocities that walls will give to nodes in this step. */
struct MPMPredictedVelocities {
  struct Mirror {              ///< a node and its images
    double mass;               ///< sum over all of these nodes
    double wall[3], odd[3];    ///< velocity of the wall; odd part of velocities relative to it
  };
  std::vector<double> held;     ///< [3*node+d] velocities of nodes that are held
  std::vector<int> mirrored;    ///< [3*node+d] index in mirrors + 1, negative for an image; 0: none
  std::vector<Mirror> mirrors;

  /** Empties all lists, for this number of nodes. */
  void reset(int64_t nnodes);
};

/** The nodes of a field at faces of the box, on which a wall acts together with their mirror
 *  images. */
class MPMMirrorNodes {
 public:
  std::vector<MPMBoxFace> faces;

  MPMMirrorNodes(MPMWall &, MPMField &, const Domain &);

  /** Finds the faces where they are now. */
  void find_faces();
  /** Do both faces of an axis have images inside that are the same nodes? */
  static bool are_near(const std::vector<MPMBoxFace> &, int axis);
  /** Activates the blocks so that a rank with nodes near a mirror plane has the plane and the
   *  images. */
  void extend_topology() const;
  /** Does the wall need this block? Mirrors and cut faces need both sides; ahead: nodes further
   *  inside. */
  bool needs(const MPM_NS::Grid::Block &, int ahead) const;
  /** The blocks of the field are new: lists the nodes. Adds those deep behind faces to a list. */
  void list(std::vector<MPMWallNode> &deep);
  /** Marks the blocks [slot] of nodes where contact is decided. */
  void mark_blocks(std::vector<char> &) const;
  /** Changes the velocities of the nodes. Constraints are those of the lines and columns, face by
   *  face. */
  void act(MPMWallContact &);
  /** Adds the groups of nodes that depend on each other, see MPMLineTies. */
  void list_ties(std::vector<int64_t> &ties, std::vector<int64_t> &others) const;
  /** Sets bit d of held[node] for components of nodes that are prescribed, and bit 3 + d where the
   *  wall mirrors a node outside. */
  void mark_prescribed(std::vector<char> &held) const;
  /** Finds the velocities that nodes will get, from their present ones. near: [block]. */
  void predict(const std::vector<char> &near, MPMPredictedVelocities &) const;
  double memory_usage() const;

 private:
  struct Image {
    int64_t node;
    int sign;
  };
  struct Group {           // a node with all its images: in one face, in two at an edge, ...
    int64_t wall;          // node at the wall where the velocity of the wall is taken
    int64_t inner;         // first node inside; -1: out of reach of points, or also held by a wall
    int first, last;       // range in images
    bool prescribed[3];    // components
    bool fixed;            // lies in the plane of a face
  };
  struct Prescribed {    // velocity that a wall gives to nodes
    double V[3];
    double share[3];    // share of the change to V that nodes take
    double limit[3];    // bound of constrained old velocities, relative to the wall
    bool hold[3];       // are the old velocities constrained?
  };
  using Mirrors = const MPMBoxFace *[3][2];    // [axis][side], null: none

  struct Plane {    // index of a plane of nodes, and sign of the values there
    int index, sign;
  };

  MPMWall &wall;
  MPMField &field;
  const Domain &box;
  std::vector<Image> images;
  std::vector<Group> groups;

  void list_groups(const bool *prescribed, int axis);
  void add_group(const Mirrors &, const int *index, const bool *prescribed,
                 std::vector<Plane> planes[3]);
  bool is_constrained(const Image *, int n, bool fixed) const;
  void project(MPMWallReaction &, const Image *, int n, bool fixed, const Prescribed &);
  void act_on_line(MPMWallContact &, const MPMBoxFace &, MPMFaceLine &, bool last);
  void act_on_column(MPMWallContact &, const MPMBoxFace &, MPMMirrorColumn &);
  void act_on_group(MPMWallReaction &, const Group &);
};

}    // namespace LAMMPS_NS

#endif

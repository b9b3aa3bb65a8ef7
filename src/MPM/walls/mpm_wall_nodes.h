/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_NODES_H
#define LMP_MPM_WALL_NODES_H

#include "walls/mpm_crossing_lines.h"
#include "walls/mpm_mirror_nodes.h"
#include "walls/mpm_wall_contact.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {

/** A line of nodes through the surface of material that is not at the wall yet, in the direction
 *  from the wall to the material, for a solver that decides contact. */
struct MPMApproach : NodeLine {
  double normal[3];    ///< of the wall
  double gap;          ///< between wall and material [distance]
};

/** All nodes of a field on which a wall acts. */
class MPMWallNodes {
 public:
  /** Range of nodes before a wall that is needed to find material that comes to it in implicit
   *  steps. */
  static constexpr int SOUGHT = 6;

  MPMWallNodes(MPMWall &, MPMField &, const Domain &box);

  MPMField &field;
  MPMMirrorNodes mirrors;            ///< faces of the box
  MPMCrossingLines crossings;        ///< lines through the surface of a region
  std::vector<MPMWallNode> nodes;    ///< nodes on their own, deep behind faces or in a region
  std::vector<MPMApproach> approaches;

  /** Activates the blocks that the wall needs. */
  void extend_topology();
  /** Does the wall need this block? */
  bool needs(const MPM_NS::Grid::Block &) const;
  /** The blocks of the field are new: lists the nodes, unless a region moves and they are listed in
   *  each step. */
  void topology_changed();
  /** Lists the nodes for the present state of the region. */
  void list_region();
  /** The motion of a region in this step is known: finds the growth of regions that change their
   *  shape, and takes off nodes that lines do not hand over. */
  void follow_region(double dt);

  /** Number of the constraint of the first crossing, node, and approach. Those of faces come
   *  first. */
  std::size_t first_crossing() const;
  std::size_t first_node() const { return first_crossing() + crossings.lines.size(); }
  std::size_t first_approach() const { return first_node() + nodes.size(); }

  /** Changes the velocities of the nodes, except those of approaches. */
  void act(MPMWallContact &);
  /** Finds the impulse of pore water for act(). */
  void find_water(MPMWallContact &, double dt) const;
  /** Adds the groups of nodes that depend on each other, see MPMLineTies. */
  void list_ties(std::vector<int64_t> &ties, std::vector<int64_t> &others) const;
  /** See MPMMirrorNodes. */
  void mark_prescribed(std::vector<char> &held) const;
  void predict(const std::vector<char> &near, MPMPredictedVelocities &) const;
  double memory_usage() const;

 private:
  MPMWall &wall;

  void extend_to_approaches();
  void hold_at_edges();
  bool find_face_ahead(const MPMWallNode &, const double *u, MPMWallNode &) const;
  std::vector<char> blocks_to_look_at() const;
  template <class Use> void visit_prescribed(const Use &) const;
  void act_on_node(MPMWallContact &, MPMWallNode &);
};

/** Finds the motion of a wall in this step, unless it is known, and the nodes of a region that
 *  moves. */
void update_motion(MPMWall &, std::vector<MPMWallNodes> &, double dt);

}    // namespace LAMMPS_NS

#endif

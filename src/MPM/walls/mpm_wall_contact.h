/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_CONTACT_H
#define LMP_MPM_WALL_CONTACT_H

#include "field/node_line.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMWall;
class MPMWallReaction;

/** What a wall does to a line of nodes, or to a node. */
enum class MPMContactState { OPEN, SLIDING, STUCK };

/** A node on which a wall acts on its own. */
struct MPMWallNode {
  int64_t node;
  double normal[3] = {0.0, 0.0, 0.0};    ///< from the wall to the body; zero: unknown
  double growth = 0.0;      ///< speed of the surface of a region that changes its shape
  double distance = 0.0;    ///< from the surface at the start of the step; for growth and gaps
  double share = 1.0;       ///< share of the change to the velocity of the wall that the node takes
  MPMContactState state = MPMContactState::OPEN;
  bool touched = true;     ///< separate: the surface of the material touches it in this step
  bool at_edge = false;    ///< acts whatever lines hold, see MPMWallNodes::hold_at_edges()
};

/** A contact that a solver decides, see field/mpm_trial_contact.h: the nodes with mass, and their
 *  weights in the motion of the surface of the material, with the sum one. */
struct MPMContactConstraint : NodeLine {
  double normal[3] = {0.0, 0.0, 0.0};    ///< from the wall to the material
  bool possible = true;        ///< the material touches the wall, or may touch it in this step
  bool active = true;          ///< the material is held at the wall
  double gap = 0.0;            ///< between material and wall at the start of the step [distance]
  double impulse = 0.0;        ///< along the normal
  double base = 0.0;           ///< the part of it by the motion of walls
  double force = 0.0;          ///< normal force N
  double coefficient = 0.0;    ///< of friction
  double slip[3] = {0.0, 0.0, 0.0};
  double friction[3] = {0.0, 0.0, 0.0};     ///< force
  double direction[3] = {0.0, 0.0, 0.0};    ///< w, see MPMWallTrial::add_friction_change()
};

/** Decides what touches a wall, what slides on it, and what sticks; and the share of pore water in
 *  this. */
class MPMWallContact {
 public:
  MPMWallContact(MPMWall &wall, MPMWallReaction &reaction) : wall(wall), reaction(reaction) {}

  MPMWall &wall;
  MPMWallReaction &reaction;
  bool decided = false;    ///< contact was decided before in this step (MUSL)
  /** Contact of all lines and nodes, decided by a solver; null: it is decided here. */
  std::vector<MPMContactConstraint> *constraints = nullptr;
  /** That of the line or node on which the wall acts now. */
  MPMContactConstraint *constraint = nullptr;
  double unit = 1.0;    ///< unit of its impulse

  /** From now on, the wall acts on the line or node with this number. */
  void use_constraint(std::size_t k) { constraint = constraints ? &(*constraints)[k] : nullptr; }

  /** Decides what a wall does to n nodes of a line. normal: from the wall to the body; push:
   *  impulse along it; tangential: that along the wall for the material to stick; both over mass.
   *  share: of the latter, what friction gives. Returns false where the wall lets go, and only pore
   *  water pushes; end with MPMWallReaction::end_sliding() otherwise. */
  template <class Line>
  bool holds(MPMField &field, Line &line, const int64_t *node, int n, const double *normal,
             double push, double tangential, double &share, double mass = 1.0)
  {
    return holds(field, line.state, line.touched, node, n, normal, push, tangential, share, mass);
  }
  /** Finds the impulses of pore water on the surface of the body at the nodes of the marked blocks,
   *  in the time dt. */
  void find_water(MPMField &, const std::vector<char> &near, double dt);
  /** There is no water. */
  void clear_water() { water.clear(); }

 private:
  std::vector<double> water;    // [node][3] impulse on the surface of the body; empty: none

  bool holds(MPMField &, MPMContactState &, bool touched, const int64_t *node, int n,
             const double *normal, double push, double tangential, double &share, double mass);
  double tangential_share(MPMContactState &, double friction, double normal, double water,
                          double tangential) const;
  double water_on(const int64_t *node, int n, const double *normal) const;
  void push_by_water(MPMField &, const int64_t *node, int n, const double *normal);
};

}    // namespace LAMMPS_NS

#endif

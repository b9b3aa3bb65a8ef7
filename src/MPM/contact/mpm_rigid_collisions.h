/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_RIGID_COLLISIONS_H
#define LMP_MPM_RIGID_COLLISIONS_H

#include "contact/mpm_impulses.h"
#include "pointers.h"
#include "walls/mpm_obstacle.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class MPMRigidContact;
struct MPMRigidOptions;

/** A rigid body in a step. */
struct MPMRigidMember {
  const char *id;    ///< of its fix
  MPMRigidOptions &body;
  MPMRigidContact &contact;
  bool &warned_of_depth;    ///< has it been said that the body is deep in something?
  double old[6];            ///< velocity and angular velocity at the start of the step
  double shift[6] = {};     ///< out of what it is in, besides its motion [distance, angle]
};

/** Collisions of rigid bodies with walls and with each other.
 *
 *  A body touches where points of its surface come nearer to an obstacle than their neighbors, and
 *  reach it in this step. Velocities after the step are such that no body goes further than to the
 *  surface, or that they are separated with a share of the speed with which they have met. They are
 *  found together with the impulses of the nodes in the bodies. A body that is in an obstacle is
 *  moved out of it without becoming faster. All ranks have the same bodies, and do the same. */
class MPMRigidCollisions : protected Pointers {
 public:
  MPMRigidCollisions(class LAMMPS *lmp, std::vector<MPMRigidMember> &members, double dt);

  /** Acts on bodies, which have their velocities after all loads, and the nodes inside of them.
   *  Collective. */
  void act();

 private:
  struct Near {    // a place of a body near an obstacle
    double x[3], n[3], gap;
  };
  std::vector<MPMRigidMember> &members;
  const double dt;
  double spacing;                                         // of the nodes
  std::vector<std::unique_ptr<MPMObstacle>> obstacles;    // first those of the bodies
  std::vector<double> loaded;                             // [body][6] velocities after loads
  std::vector<int> bodies;    // index in the solver; -1: touches nothing
  MPMImpulses impulses;
  std::vector<double> gaps;               // of the touches
  std::vector<double> rebounds;           // their speeds after a collision; 0: none
  std::vector<const MPMObstacle *> of;    // obstacles of the touches
  std::vector<double> places;             // [touch][3]

  bool is_free(int body) const;
  void place(int body, const double *in_body, double *x) const;
  void find(int body, int obstacle);
  std::vector<Near> look(int body, const MPMObstacle &, double margin) const;
  bool find_touch(int body, std::size_t point, const MPMObstacle &, Near &) const;
  void straighten(int body, std::size_t point, double *n) const;
  static std::vector<Near> outermost(std::vector<Near>);
  void add(int body, int obstacle, const Near &);
  void tell(const MPMRigidMember &, const MPMObstacle &, double depth) const;
  void find_impulses();
  void solve();
  void end();
  void move_out();
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_RIGID_CONTACT_H
#define LMP_MPM_RIGID_CONTACT_H

#include "contact/mpm_rigid_body.h"
#include "declare/option.h"
#include "field/mpm_friction_heat.h"
#include "pointers.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class Grid;
class SurfaceMesh;
class SurfacePoints;
}    // namespace MPM_NS

namespace LAMMPS_NS {
class MPMField;

/** A rigid body, and the keywords of fix mpm/rigid; v and omega are first the initial values. */
struct MPMRigidOptions : MPMRigidBody {
  enum Kind { STICK, SLIP, SEPARATE };

  std::string region_id;
  bool by_mass = false;
  double amount = 0.0;    ///< mass or density
  Kind kind = STICK;
  double friction = 0.0;
  bool collides = true;
  double restitution = 0.0;
  double gravity[3] = {0.0, 0.0, 0.0};
  MPM_NS::NumberOrVariable load[3], moment[3];    ///< force and torque
  MPMFrictionHeatOptions heat;

  MPM_NS::Options declare();
  bool sticks() const { return kind == STICK; }
};

/** Contact of a rigid body with the material at the nodes inside of it. */
class MPMRigidContact : protected Pointers {
 public:
  MPMRigidContact(class LAMMPS *lmp, MPMRigidOptions &body);
  ~MPMRigidContact() override;

  const MPM_NS::SurfaceMesh *mesh = nullptr;    ///< null: the region is of another style, in a flow
  double farthest = 0.0;                        ///< largest distance from the center of the body
  std::unique_ptr<MPMFrictionHeat> heating;     ///< null: not requested
  std::unique_ptr<MPM_NS::SurfacePoints> points;    ///< of the surface, from the center of the body

  /** Gives nodes and body their impulses. Collective. */
  void act();
  /** The parts of act(), for bodies whose velocities others change, too. First: finds nodes.
   *  Collective. */
  void begin();
  /** Finds velocity and angular velocity u[6] of the body with its nodes in their present states,
   *  and unless null, the change of u by an impulse and its moment about the center. Collective. */
  void find_motion(double *u, double (*mobility)[6]) const;
  /** Finds the states of nodes for the motion u. Returns whether they have changed. Collective. */
  bool decide(const double *u);
  /** Gives nodes, and the body, the impulses for the motion u of the body. Collective. */
  void end(const double *u);
  /** Gives velocities that serve the gradient alone those of the body, along what act() has
   *  decided. */
  void repeat();
  /** Signed distance from the surface, negative inside; far if it is larger. */
  double distance(const double *at, double far) const;
  /** Unit normal out of the body; zero where there is none. */
  void normal(const double *at, double *n) const;

 private:
  struct Contact {    // a node inside of the body
    enum State { APART, SLIDES, STICKS };
    MPMField *field;
    int place;         // index of the field in the list of all fields
    double *record;    // node record: velocity and mass
    bool owned;
    State state;
    double r[3];                 // from the center of the body
    double n[3] = {};            // normal out of the body, unless nodes just stick
    double depth = 0.0;          // below the surface of the body
    double water_share = 0.0;    // share of the impulse along n that pore water takes
    double v[3];                 // velocity before contact
    double pull[3] = {};         // impulse of friction on the node, for an impulse of 1 along n

    /** Velocity w of the body at the node, relative to v. u: velocity and angular velocity of the
     *  body. */
    void relative_velocity(const double *u, double *w) const;
  };

  MPMRigidOptions &body;
  std::vector<Contact> contacts;

  void from_center(const double *at, double *r) const;
  bool is_near(const MPM_NS::Grid &, std::size_t slot, double reach) const;
  void find_contacts();
  bool find_normal(const std::array<double, 3> &, Contact &) const;
  void place_in_body(const double *r, std::array<double, 3> &) const;
  bool decide_contacts(const double *u);
  void push_nodes(const double *u);
  void find_water();
  void heat_node(const Contact &, double normal_impulse, const double *u);
};

}    // namespace LAMMPS_NS
#endif

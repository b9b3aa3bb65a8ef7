/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/rigid,FixMPMRigid);
// clang-format on
#else

#ifndef LMP_FIX_MPM_RIGID_H
#define LMP_FIX_MPM_RIGID_H

#include "base/mpm_step_limit.h"
#include "contact/mpm_rigid_body.h"
#include "declare/option.h"
#include "field/mpm_friction_heat.h"
#include "field/mpm_node_action.h"
#include "fix.h"
#include "math_extra.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {
class SurfaceMesh;
}

namespace LAMMPS_NS {
class MPMField;

/** Options; v and omega of MPMRigidMotion are the initial values. */
struct MPMRigidOptions : MPMRigidBody {
  enum Kind { STICK, SLIP, SEPARATE };

  std::string region_id;
  bool by_mass = false;
  double amount = 0.0;    ///< mass or density
  Kind kind = STICK;
  double friction = 0.0;
  double gravity[3] = {0.0, 0.0, 0.0};
  MPM_NS::NumberOrVariable load[3], moment[3];    ///< force and torque
  MPMFrictionHeatOptions heat;

  MPM_NS::Options declare();
};

/** A free rigid body with the shape of a region mpm/mesh, in contact with the material at the nodes
 *  inside of it. Body and nodes get opposite impulses, which are solved for together, so that light
 *  bodies are as stable as heavy ones, and momentum and angular momentum are conserved to
 *  round-off.
 *
 *  In a flow of fix mpm/incompressible for which its region is solid, any bounded region can be the
 *  shape, also in 2d. That fix then moves the body together with the pressure, see
 *  MPMFlowBodies. */
class FixMPMRigid :
    public Fix,
    public MPMNodeAction,
    public MPMRubbing,
    public MPMStepLimit,
    private MPMRigidOptions {
 public:
  Turn turn() const override { return RIGID_BODIES; }
  FixMPMRigid(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  bool loses_heat() const override { return friction > 0.0 && !heat.said; }
  bool gives_heat() const override { return heat.heats(); }
  void init() override;
  void init_action() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_vector(int) override;

  bool decides_contact(const MPMField &) const override { return kind == SEPARATE; }
  void act(double dt, Stage) override;

  /** Signed distance of x from the surface, negative inside; far if it is larger. Not for bodies in
   *  a flow. */
  double distance(const double *x, double far) const;
  /** Largest time step in which no point of the body crosses a cell. tag: 0. */
  double stable_dt(tagint &tag) const override;
  bool makes_steps() const override { return false; }

  // for flows

  /** Is the shape of the body the region with this ID? */
  bool has_region(const std::string &id) const { return id == region_id; }
  /** Center [3], velocity [3], and angular velocity [3]. */
  void motion(double *center, double *velocity, double *angular) const;
  /** Maps a place x of the body to its place in the region, which stays at rest. */
  void place_in_region(const double *x, double *place) const;
  /** Rotates a vector n from the frame of the region to space. */
  void turn_to_space(const double *n, double *turned) const { MathExtra::matvec(Q, n, turned); }
  /** Finds velocity and angular velocity u[6] after loads of this duration, and inverse [6][6],
   *  their change by an impulse and its moment about the center. Does not change the body. */
  void predict(double duration, double *u, double *inverse);
  /** Moves the body by a step with its loads and this impulse and moment [6] of the flow. */
  void go_on(double dt, const double *impulse_of_flow);

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

  const MPM_NS::SurfaceMesh *mesh = nullptr;    // null: the region is of another style, in a flow
  double first[3], farthest;    // center of the body in the region; largest distance from it
  std::vector<Contact> contacts;
  std::unique_ptr<MPMFrictionHeat> heating;    // null: not requested

  void load_impulse(double dt);
  void find_contacts();
  bool find_normal(const std::array<double, 3> &, Contact &) const;
  void place_in_body(const double *r, std::array<double, 3> &) const;
  void solve();
  void solve_system(double *u) const;
  bool decide_contacts(const double *u);
  void push_nodes(const double *u);
  void find_water();
  void heat_node(const Contact &, double normal_impulse, const double *u);
  double speed() const;
  double spacing_of_flow() const;
  void check_motion(double dt) const;
};

}    // namespace LAMMPS_NS
#endif
#endif

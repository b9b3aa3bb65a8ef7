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
#include "contact/mpm_rigid_contact.h"
#include "field/mpm_coupling.h"
#include "field/mpm_doubts.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "fix.h"
#include "math_extra.h"

#include <algorithm>
#include <string>

namespace LAMMPS_NS {
struct MPMRigidMember;

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
    public MPMRegionUser,
    public MPMSolidBody,
    private MPMRigidOptions {
 public:
  Turn turn() const override { return RIGID_BODIES; }
  FixMPMRigid(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // called by fix mpm
  double coefficient() const override { return friction; }
  bool loses_heat() const override { return friction > 0.0 && !heat.said; }
  bool gives_heat() const override { return heat.heats(); }
  void init() override;
  void init_action() override;
  void setup(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_vector(int) override;

  bool decides_contact(const MPMField &) const override { return kind == SEPARATE; }
  bool acts_inside() const override { return true; }
  void act(double dt, Stage) override;

  /** Signed distance of x from the surface, negative inside; far if it is larger. Not for bodies in
   *  a flow. */
  double distance(const double *x, double far) const { return contact.distance(x, far); }
  /** Largest time step in which no point of the body crosses a cell. tag: 0. */
  double stable_dt(tagint &tag) const override;
  bool makes_steps() const override { return false; }

  bool acts_on(const std::string &name) const override;
  bool has_inside(const double *at) const override;

  // for flows
  /** Is the shape of the body the region with this ID? */
  bool has_region(const std::string &id) const { return id == region_id; }
  bool uses_region(const std::string &name) const override { return name == region_id; }
  bool sees_images() const override { return true; }
  /** Center [3], velocity [3], and angular velocity [3]. */
  void motion(double *center, double *velocity, double *angular) const;
  /** Maps a place x of the body to its place in the region, which stays at rest. */
  void place_in_region(const double *x, double *place) const;
  /** Rotates a vector n from the frame of the region to space. */
  void turn_to_space(const double *n, double *turned) const { MathExtra::matvec(Q, n, turned); }
  /** Finds velocity and angular velocity u[6] after loads of this duration, and inverse [6][6],
   *  their change by an impulse and its moment about the center. Does not change the body. */
  void predict(double duration, double *u, double *inverse);
  /** Moves the body by a step of duration dt, with this impulse and moment [6] of the flow and the
   *  loads of a duration kick that ends in the middle of the step. half_kick_share: share of the
   *  change of velocities that belongs to the rest of the step. struck: [6] what strike() gave the
   *  body in this step. */
  void go_on(double dt, double kick, double half_kick_share, const double *impulse_of_flow,
             const double *struck);
  /** Gives the body an impulse and its moment [6]. */
  void strike(const double *J);
  /** Has no flow moved the body so far? */
  bool is_new() const { return in_flow == 0.0; }
  /** The velocities are those of now. */
  void forget() { std::fill_n(half_kick, 6, 0.0); }

 private:
  double first[3];    // center of the body in the region
  MPMRigidContact contact;
  bool warned_of_faces = false, warned_of_depth = false;
  bool weight_given = false;    // is there the keyword gravity?
  MPMDoubts doubts;

  void find_shape();
  void load_impulse(double dt);
  void undo_half_kick();
  double speed() const;
  double spacing_of_flow() const;
  void check_motion(double dt) const;
  void find_points();
  MPMRigidMember begin_step(double dt);
  void end_step(double dt, const MPMRigidMember &);
  void warn_of_faces();
  void check_weight();
};

}    // namespace LAMMPS_NS
#endif
#endif

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

#include "declare/option.h"
#include "fix.h"
#include "mpm_node_action.h"

#include <cstdint>
#include <string>
#include <vector>

namespace MPM_NS {
class SurfaceMesh;
}

namespace LAMMPS_NS {
class MPMField;

struct MPMRigidOptions {
  enum Kind { STICK, SLIP, SEPARATE };

  std::string region_id;
  bool by_mass = false;
  double amount = 0.0;    ///< mass or density
  Kind kind = STICK;
  double friction = 0.0;
  double v[3] = {0.0, 0.0, 0.0}, omega[3] = {0.0, 0.0, 0.0};    ///< at the start
  double gravity[3] = {0.0, 0.0, 0.0};
  MPM_NS::NumberOrVariable load[3], moment[3];                   ///< force and torque
  bool fixed[6] = {false, false, false, false, false, false};    ///< velocities that stay zero

  MPM_NS::Options declare();
};

/** A free rigid body with the shape of a region mpm/mesh, in contact with the material at the nodes
 *  inside of it. Body and nodes take opposite impulses, found together, so that light bodies are as
 *  stable as heavy ones, and momentum and angular momentum are kept to round-off. */
class FixMPMRigid : public Fix, public MPMNodeAction, private MPMRigidOptions {
 public:
  Turn turn() const override { return RIGID_BODIES; }
  FixMPMRigid(class LAMMPS *, int, char **);
  int setmask() override;
  void init() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override;
  double compute_vector(int) override;

  void act(double dt, Stage) override;

 private:
  struct Contact {    // a node inside of the body
    enum State { APART, SLIDES, STICKS };
    MPMField *field;
    int64_t node;
    bool owned;
    State state;
    double r[3];       // from the center of the body
    double n[3];       // out of the body
    double v[3];       // before the contact
    double pull[3];    // impulse of friction on the node, for an impulse of 1 along n

    double *record() const;    ///< of the node: its velocity and mass
    /** Velocity of the body (u: its velocity and angular velocity) at the node, relative to v. */
    void relative_velocity(const double *u, double *w) const;
    /** Impulse on the node (mass m) if it had the velocity w of the body, relative to its own. */
    void impulse(double m, const double *w, double *push) const;
  };

  const MPM_NS::SurfaceMesh *mesh;
  double mass, density;
  double body_inertia[6];    // about the center, in the frame of the mesh

  double x[3], L[3];             // center, angular momentum; v, omega: of now
  double Q[3][3];                // from the frame of the mesh to space
  double impulse[6], dt_last;    // of the material on the body in the last step
  std::vector<Contact> contacts;

  void load_impulse(double dt);
  void find_contacts();
  void solve();
  void move(double dt);
  void inertia(double out[3][3]) const;
  void spin();
};

}    // namespace LAMMPS_NS
#endif
#endif

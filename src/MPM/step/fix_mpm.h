/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm,FixMPM);
// clang-format on
#else

#ifndef LMP_FIX_MPM_H
#define LMP_FIX_MPM_H

#include "base/mpm_integrator.h"
#include "base/mpm_state.h"
#include "field/mpm_field.h"

#include <memory>

namespace LAMMPS_NS {
class MPMField;
class MPMPlan;

/** Fix mpm: one velocity field on one lattice, which moves the material points of its group. It is
 *  the interface of LAMMPS to an MPMField.
 *
 *  The whole step is done in initial_integrate(): at this time atom->f is complete for any order of
 *  fixes, and at output all state is on one time level. The first instance drives all of them.
 */
class FixMPM : public FixMPMState, public MPMFieldOwner {
 public:
  bool rests_dry = false;    ///< did mpm_geostatic give points a stress without pore water?

  FixMPM(class LAMMPS *, int, char **);
  ~FixMPM() override;
  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void setup_pre_neighbor() override;
  void setup_pre_force(int flag) override { pre_force(flag); }
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_exchange() override;
  void pre_neighbor() override;
  void pre_force(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override { return FixMPMState::memory_usage() + field->memory_usage(); }
  void write_restart(FILE *) override;
  void restart(char *) override;

 private:
  std::unique_ptr<MPMPlan> plan;    // only in the driving instance
  MPMSetUp set_up;
  std::unique_ptr<class MPMContinuation> continuation;
  std::unique_ptr<class MPMShapeWatch> shape_watch;
  std::unique_ptr<class MPMRollingWatch> rolling_watch;
  std::unique_ptr<class MPMSetupChecks> checks;

  bool no_torques = false;    // torques of atoms outside of neighbor lists are zero already

  void check_fields() const;
  void check_include() const;
  double bytes_per_point() const;
};

}    // namespace LAMMPS_NS
#endif
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/mesh,FixMPMMesh);
// clang-format on
#else

#ifndef LMP_FIX_MPM_MESH_H
#define LMP_FIX_MPM_MESH_H

#include "base/mpm_integrator.h"
#include "base/mpm_stage_list.h"
#include "base/mpm_state.h"
#include "base/mpm_step_limit.h"
#include "declare/option.h"
#include "field/mpm_coupling.h"
#include "field/mpm_point_batches.h"
#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_body.h"
#include "meshgrid/mpm_mesh_conditions.h"

#include <memory>

namespace LAMMPS_NS {
class FixMPMMeshContact;
class FixMPMMeshHeat;

/** Material points on a mesh of linear elements of any shape (V.P. Nguyen, A. de Vaucorbeil, S.
 *  Bordas, The Material Point Method, Springer 2023, chapter 5), in place of the lattice of a fix
 *  mpm. As in fix mpm, initial_integrate() does the whole step. */
class FixMPMMesh :
    public FixMPMState,
    public MPMStepLimit,
    public MPMPointOwner,
    private MPMMeshOptions {
 public:
  FixMPMMesh(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::INITIAL_INTEGRATE | FixConst::PRE_NEIGHBOR; }
  void init() override;
  void setup_pre_neighbor() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_neighbor() override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double stable_dt(tagint &tag) const override { return body->stable_dt(tag); }

  void visit_batches(int group_bits, const BatchVisitor &) override;

  /** The stages of a step; known from init() on. */
  const MPMStageList &plan() const { return stages; }

 private:
  MPMSetUp set_up;
  std::unique_ptr<MPM_NS::BackgroundMesh> mesh;
  std::unique_ptr<MPMMeshForces> forces;
  std::unique_ptr<MPMMeshBody> body;
  FixMPMMeshContact *contact = nullptr;
  FixMPMMeshHeat *heat = nullptr;
  MPMUncoupled uncoupled;    // other matter in the same box
  MPMStageList stages;
  bigint steps = 0;

  template <class F> F *find_attached(const char *advice) const;
  void make_plan();
  void find_contact();
  void find_heat();
  void check_points();
  void check_dt();
  void give_initial_stress();
  void warn_of_locking();
  void warn_of_sides() const;
  void warn_of_flow() const;
};

}    // namespace LAMMPS_NS
#endif
#endif

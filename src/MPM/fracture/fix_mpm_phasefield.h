/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/phasefield,FixMPMPhaseField);
// clang-format on
#else

#ifndef LMP_FIX_MPM_PHASEFIELD_H
#define LMP_FIX_MPM_PHASEFIELD_H

#include "declare/option.h"
#include "field/mpm_physics.h"
#include "fix.h"
#include "fracture/mpm_phase_field.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/** Keywords of fix mpm/phasefield. */
struct MPMPhaseFieldOptions : MPMPhaseField::Goal {
  int every = 1;    ///< steps from one solution to the next

  MPM_NS::Options declare();
};

/** Finds the phase field of points whose material has damage phasefield. */
class FixMPMPhaseField : public Fix, public MPMPhysics, private MPMPhaseFieldOptions {
 public:
  FixMPMPhaseField(class LAMMPS *, int, char **);
  int setmask() override { return 0; }    // fix mpm calls the stage
  void init() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;
  void write_restart(FILE *) override;
  void restart(char *) override;

  void init_physics(MPMPlan &) override;
  void add_stages(MPMPlan &, MPMPlan::Place) override;
  bool looks_beyond_points() const override { return false; }

 private:
  std::vector<std::unique_ptr<MPMPhaseField>> fields;
  int waited = 0;    // steps since the last solution

  void solve(MPMPhaseField &);
  void check(const MPMField &, const class FixMPMMaterial &,
             const MPM_NS::PhaseFieldCracks &) const;
};

}    // namespace LAMMPS_NS
#endif
#endif

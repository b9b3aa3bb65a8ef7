/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/absorb,FixMPMAbsorb);
// clang-format on
#else

#ifndef LMP_FIX_MPM_ABSORB_H
#define LMP_FIX_MPM_ABSORB_H

#include "declare/option.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_traffic.h"

#include "fix.h"

#include <string>

namespace LAMMPS_NS {
class Region;

/** Keywords of fix mpm/absorb. */
struct MPMAbsorbOptions {
  std::string region_id;
  int look_every = 1;

  MPM_NS::Options declare();
};

/** Removes the material points of its group that are in a region at the end of a step, and sums up
 *  their mass and other quantities. */
class FixMPMAbsorb : public Fix, public MPMRegionUser, private MPMAbsorbOptions {
 public:
  FixMPMAbsorb(class LAMMPS *, int, char **);
  int setmask() override { return FixConst::POST_INTEGRATE | FixConst::PRE_EXCHANGE; }
  void init() override;
  void post_integrate() override;
  void pre_exchange() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double compute_scalar() override { return total.mass; }
  double compute_vector(int) override;
  bool uses_region(const std::string &name) const override { return name == region_id; }
  bool sees_images() const override { return true; }

 private:
  Region *region = nullptr;
  MPMTraffic total;       // of all removed points, on all ranks
  double heat = 0.0;      // of these, above the initial temperature of their material [energy]
  double rate = 0.0;      // removed mass per time since the last check
  double waited = 0.0;    // time since the last check

  bool absorbs(int i) const;
  double heat_of(int i) const;
};

}    // namespace LAMMPS_NS
#endif
#endif

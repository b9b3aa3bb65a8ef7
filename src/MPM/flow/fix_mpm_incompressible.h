/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(mpm/incompressible,FixMPMIncompressible);
// clang-format on
#else

#ifndef LMP_FIX_MPM_INCOMPRESSIBLE_H
#define LMP_FIX_MPM_INCOMPRESSIBLE_H

#include "base/mpm_integrator.h"
#include "base/mpm_state.h"
#include "base/mpm_step_limit.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_point_batches.h"
#include "flow/mpm_flow.h"

#include <algorithm>
#include <memory>
#include <string>

namespace LAMMPS_NS {

/** Flow of an incompressible fluid with free surfaces (MPMFlow): options, calls by LAMMPS, and
 *  output. */
class FixMPMIncompressible :
    public FixMPMState,
    public MPMStepLimit,
    public MPMFluid,
    public MPMRegionUser,
    public MPMPointOwner {
 public:
  FixMPMIncompressible(class LAMMPS *, int, char **);
  int setmask() override
  {
    return FixConst::INITIAL_INTEGRATE | FixConst::PRE_EXCHANGE | FixConst::PRE_NEIGHBOR |
        FixConst::PRE_FORCE;
  }
  void init() override;
  void setup_pre_exchange() override { flow->checks.check_box(); }
  void setup_pre_neighbor() override;
  void setup(int) override { flow->start(); }
  void post_run() override;
  void initial_integrate(int) override;
  void pre_neighbor() override;
  void setup_pre_force(int vflag) override { pre_force(vflag); }
  void pre_force(int) override;
  double compute_scalar() override { return flow->results.iterations; }
  double compute_vector(int) override;
  double memory_usage() override { return FixMPMState::memory_usage() + flow->memory_usage(); }
  void write_restart(FILE *) override;
  void restart(char *buf) override { flow->restart(id, buf); }

  /** Stable time step of this rank: the time in which a point passes one node spacing with its
   *  present velocity and acceleration, or a moving region or wall passes one, or the limit of
   *  explicit viscosity, of solids, or of surface tension. tag: of the limiting point; 0: another
   *  limit. */
  double stable_dt(tagint &tag) const override { return flow->stable_dt(tag); }
  bool uses_region(const std::string &name) const override
  {
    const auto &ids = flow->options.region_ids;
    return std::find(ids.begin(), ids.end(), name) != ids.end();
  }
  double spacing_around(const std::string &region) const override;
  double spacing() const override { return flow->options.h; }
  void visit_batches(int group_bits, const BatchVisitor &) override;
  double density_of_groups(int mask) const override { return flow->liquids.density(mask); }
  void check_density(double fluid, const std::string &who) const override;
  bool is_leapfrog() const override { return flow->is_leapfrog(); }

 private:
  MPMSetUp set_up;
  std::unique_ptr<MPMFlow> flow;
  MPMRows gradient;       // [n][flow_slopes(dim)] of velocities of points, with apic
  MPMRows half_kick;      // [n][dim] what velocities have beyond the middle of the last step
  double travel = 0.0;    // largest distance that points have moved since neighbor lists were made

  double gas_value(int k) const;
};

}    // namespace LAMMPS_NS
#endif
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_VISCOSITY_NEWTONIAN_H
#define LMP_MPM_VISCOSITY_NEWTONIAN_H

#include "mpm_law_kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Newtonian shear viscosity: adds 2 MU dev(D), D the strain rate half-way in the step. */
  struct ViscosityNewtonian : LawDefaults {
    static constexpr const char *name = "newtonian";
    static constexpr const char *meaning = "Newtonian shear viscosity";
    static constexpr StressShare share = DEVIATOR;
    static constexpr Parameter parameters[] = {
        {"", "MU", "pressure time", NOT_NEGATIVE, REQUIRED, "dynamic viscosity"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double twomu = b.dt > 0.0 ? 2.0 * p.value[0] / b.dt : 0.0;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const Sym e = deviator(increment(b, i).strain);
        store_stress(b, i, load_stress(b, i) + twomu * e);
        const double work = 0.5 * (b.J[i] + b.Jold[i]) * twomu * norm2(e);
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    /** Explicit steps with damping: dt = h / (sqrt(c^2 + a^2) + a), a = 4/3 MU / (density h), the
     *  central-difference limit (2/omega)(sqrt(1 + xi^2) - xi) with omega = 2 c/h. */
    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      const double a0 = (4.0 / 3.0) * p.value[0] / (p.density * b.h);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double a = a0 * b.J[i];
        c[i] = std::sqrt(c[i] * c[i] + a * a) + a;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

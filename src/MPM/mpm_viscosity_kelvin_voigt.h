/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_VISCOSITY_KELVIN_VOIGT_H
#define LMP_MPM_VISCOSITY_KELVIN_VOIGT_H

#include "mpm_law_kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Damping of a solid, parallel to its elasticity (Kelvin-Voigt): adds to the Kirchhoff stress
   *
   *    2 ETA dev(D) + BULK tr(D) I,   D: strain rate half-way in the step
   *
   *  A shear oscillation is damped with the retardation time ETA/G. Proportional to the reference
   *  volume, and so to mass: the stable time step does not change with J. */
  struct ViscosityKelvinVoigt : LawDefaults {
    static constexpr const char *name = "kelvin/voigt";
    static constexpr const char *meaning = "damping of solids in shear and volume";
    static constexpr StressShare share = WHOLE_STRESS;
    static constexpr bool uses_speed = false;
    static constexpr Parameter parameters[] = {
        {"", "ETA", "pressure time", NOT_NEGATIVE, REQUIRED, "viscosity in shear"},
        {"bulk", "BULK", "pressure time", NOT_NEGATIVE, 0.0, "viscosity in change of volume"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double shear = 2.0 * p.value[0] * inv_dt, bulk = p.value[1] * inv_dt;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym e = deviator(inc.strain);
        const double volume = trace(inc.strain);
        const Sym tau = add_diagonal(shear * e, bulk * volume);
        store_stress(b, i, load_stress(b, i) + (1.0 / b.J[i]) * tau);
        const double work = shear * norm2(e) + bulk * volume * volume;
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    /** As of ViscosityNewtonian. */
    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      const double a = ((4.0 / 3.0) * p.value[0] + p.value[1]) / (p.density * b.h);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) c[i] = std::sqrt(c[i] * c[i] + a * a) + a;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

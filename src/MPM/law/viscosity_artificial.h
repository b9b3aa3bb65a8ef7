/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_ARTIFICIAL_H
#define MPM_LAW_VISCOSITY_ARTIFICIAL_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Artificial bulk viscosity, in compression only (J. von Neumann, R.D. Richtmyer, J. Appl. Phys.
   *  21 (1950) 232; linear term R. Landshoff, LA-1930, 1955): the pressure rises by
   *
   *    q = density h |tr D| (CQ h |tr D| + CL c),   tr D < 0
   *
   *  with node spacing h, wave speed c. Shocks spread over a few h. */
  struct ViscosityArtificial : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "artificial";
    static constexpr const char *meaning = "artificial bulk viscosity for shocks";
    static constexpr StressShare share = PRESSURE;
    static constexpr Parameter parameters[] = {
        {"", "CQ", "1", NOT_NEGATIVE, REQUIRED, "quadratic coefficient (about 1.5)"},
        {"", "CL", "1", NOT_NEGATIVE, REQUIRED, "linear coefficient (about 0.06)"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double quadratic = p.value[0] * b.h, linear = p.value[1], scale = p.density * b.h;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const double dJ = b.J[i] - b.Jold[i], sum = b.J[i] + b.Jold[i];
        const double rate = max(-2.0 * dJ / sum * inv_dt, 0.0);
        const double q = 2.0 * scale / sum * rate * (quadratic * rate + linear * b.speed[i]);
        subtract_pressure(b, i, q);
        const double work = -q * dJ;
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    /** The linear term only: the quadratic one is left to the fraction of the limit that is run. */
    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      const double xi = p.value[1], factor = std::sqrt(1.0 + xi * xi) + xi;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) c[i] *= factor;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

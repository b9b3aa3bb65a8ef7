/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_H
#define MPM_LAW_VISCOSITY_H

#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** Speed c, raised for the shear viscosity mu and the bulk viscosity zeta. The stable step of
   *  explicit integration with damping is dt = h / (sqrt(c^2 + a^2) + a) with a = (4/3 mu + zeta) /
   *  (density h), the central-difference limit (2/omega)(sqrt(1 + xi^2) - xi) with omega = 2
   *  c/h. */
  MPM_INLINE double damped_speed(const LawParameters &p, const Batch &b, int i, double c, double mu,
                                 double zeta)
  {
    const double a = ((4.0 / 3.0) * mu + zeta) * b.J[i] / (p.density * b.h);
    return std::sqrt(c * c + a * a) + a;
  }

  /** Newtonian viscosity: adds 2 MU dev(D) + ZETA tr(D) I, where D is the strain rate at the middle
   *  of the step. With the elasticity of a solid it forms a Kelvin-Voigt element. */
  struct ViscosityNewtonian : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "newtonian";
    static constexpr const char *meaning = "Newtonian viscosity; damping of solids (Kelvin-Voigt)";
    static constexpr StressShare share = WHOLE_STRESS;
    static constexpr bool uses_speed = false;
    static constexpr Parameter parameters[] = {
        {"", "MU", "pressure time", NOT_NEGATIVE, REQUIRED, "dynamic viscosity"},
        {"bulk", "ZETA", "pressure time", NOT_NEGATIVE, 0.0, "bulk viscosity"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double twomu = 2.0 * p.value[0] * inv_dt, zeta = p.value[1] * inv_dt;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym e = deviator(inc.strain);
        const double tr = trace(inc.strain);
        store_stress(b, i, add_diagonal(load_stress(b, i) + twomu * e, zeta * tr));
        const double work = 0.5 * (b.J[i] + b.Jold[i]) * (twomu * norm2(e) + zeta * tr * tr);
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) c[i] = damped_speed(p, b, i, c[i], p.value[0], p.value[1]);
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double twomu = 2.0 * p.value[0] * inv_dt, zeta = p.value[1] * inv_dt;
      update(p, b, history);
      const StepMotion step(b);
      alignas(64) double change[6][BATCH];
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
          if (t.skips(3 * k + l)) continue;
          const double volume = k == l ? 1.0 : 0.0;
          double *const heat = t.heat[3 * k + l];
          const StepMotion::Columns columns = step.columns(k, l);
          MPM_SIMD
          for (int i = 0; i < b.n; i++) store_rows(change, i, columns(i).strain);
          MPM_SIMD
          for (int i = 0; i < b.n; i++) {
            const double J = b.J[i], all = J + b.Jold[i];
            const Sym strain = step.strain(i), e = deviator(strain);
            const Sym dstrain = load_rows(change, i), de = deviator(dstrain);
            const double tr = trace(strain), dtr = trace(dstrain);
            add_column(t, 3 * k + l, i,
                       J * add_diagonal(twomu * (de + volume * e), zeta * (dtr + volume * tr)));
            heat[i] += 0.5 * volume * J * (twomu * norm2(e) + zeta * tr * tr) +
                all * (twomu * contract(e, de) + zeta * tr * dtr);
          }
        }
    }
  };

  /** Artificial bulk viscosity, in compression only (J. von Neumann, R.D. Richtmyer, J. Appl. Phys.
   *  21 (1950) 232; linear term R. Landshoff, LA-1930, 1955): the pressure rises by
   *
   *    q = density h |tr D| (CQ h |tr D| + CL c),   tr D < 0
   *
   *  with node spacing h and wave speed c. Shocks spread over a few h. */
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

    /** Accounts for the linear term only; the safety factor of the time step covers the quadratic
     *  term. */
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

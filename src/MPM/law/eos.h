/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_H
#define MPM_LAW_EOS_H

// Equations of state without an internal energy.

#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** Range of a lowest pressure: not positive. */
  constexpr Range TENSION{-UNBOUNDED, 0.0, true};

  /** Kernels of an equation of state p(J) without an internal energy.
   *
   *  Eos provides, with the volume ratio J = density_0 / density:
   *    pressure(J)
   *    bulk(J) = -J^2 dp/dJ, the reference density times the square of the sound speed
   *    stored(J) = -integral of p dJ from 1
   *    slope(J), the exact derivative, only if bulk() is not -J^2 dp/dJ
   */
  template <class Eos> struct Barotropic : LawDefaults {
    static constexpr bool uses_F = false;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) subtract_pressure(b, i, eos.pressure(b.J[i]));
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) k[i] += eos.bulk(b.J[i]);
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += eos.stored(b.J[i]);
    }

    /** -J^2 dp/dJ, for the tangent. */
    MPM_INLINE double slope(double J) const { return static_cast<const Eos *>(this)->bulk(J); }

    /** Derivative of the mean Kirchhoff stress: -d(J p)/d ln J. */
    static void tangent(const LawParameters &p, Batch &b, History, Tangent &t)
    {
      const Eos eos(p);
      alignas(64) double mean[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], pressure = eos.pressure(J);
        mean[i] = eos.slope(J) - J * pressure;
        subtract_pressure(b, i, pressure);
      }
      add_mean(b.n, mean, t);
    }
  };

  /** p = K (density/density_0 - 1) = K (1/J - 1): the linear term of the polynomial equation of
   *  state of hydrocodes. Sound speed sqrt(K/density_0) at any density; tension stays below K. */
  struct EosLinear : Barotropic<EosLinear> {
    static constexpr const char *name = "linear";
    static constexpr const char *meaning = "pressure linear in density";
    static constexpr Parameter parameters[] = {BULK_MODULUS};

    double K;

    explicit EosLinear(const LawParameters &p) : K(p.value[0]) {}
    MPM_INLINE double pressure(double J) const { return K * (1.0 - J) / J; }
    MPM_INLINE double bulk(double) const { return K; }
    MPM_INLINE double stored(double J) const { return K * minus1_minus_log(J); }
  };

  /** Tait-Murnaghan liquid: p = K/gamma (J^-gamma - 1), but not below the cavitation pressure (F.D.
   *  Murnaghan, Proc. Natl. Acad. Sci. 30 (1944) 244; J.J. Monaghan, J. Comput. Phys. 110 (1994)
   *  399). Density_0 c^2 = K J^(1-gamma) also in the cavitated state, so that the time step is
   *  small enough when the cavity closes. */
  struct EosTait : Barotropic<EosTait> {
    static constexpr const char *name = "tait";
    static constexpr const char *meaning = "Tait-Murnaghan liquid";
    enum { BULK, GAMMA, CUTOFF };
    static constexpr Parameter parameters[] = {
        {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus at reference density"},
        {"", "GAMMA", "1", POSITIVE, REQUIRED, "exponent (water: 7)"},
        {"cutoff", "PMIN", "pressure", TENSION, -UNBOUNDED,
         "lowest pressure, not positive; the liquid cavitates there"}};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[CUTOFF] != -UNBOUNDED && p.value[CUTOFF] <= -p.value[BULK] / p.value[GAMMA]
          ? "PMIN is never reached: pressure stays above -K/GAMMA; leave cutoff out or raise PMIN"
          : nullptr;
    }

    double K, gamma, pmin;
    /** Factors, in the integral of J^-gamma, of the power and (for gamma = 1) of the logarithm. */
    double inv_a, linear;
    double logJc, Jc, Uc;    ///< start of cavitation: volume ratio and energy

    explicit EosTait(const LawParameters &p) :
        K(p.value[BULK]), gamma(p.value[GAMMA]), pmin(p.value[CUTOFF])
    {
      const double a = 1.0 - gamma;
      const bool one = a < 1e-9 && a > -1e-9;
      inv_a = one ? 0.0 : 1.0 / a;
      linear = one ? 1.0 : 0.0;
      logJc = 709.0;
      Jc = Uc = 0.0;
      if (pmin == -UNBOUNDED) return;
      logJc = -log(1.0 + gamma * pmin / K) / gamma;
      Jc = exp(logJc);
      Uc = liquid_energy(Jc, logJc);
    }

    MPM_INLINE double pressure(double J) const
    {
      const double x = log(J);
      const double p = (K / gamma) * expm1(-gamma * x);
      return x > logJc ? pmin : p;
    }
    MPM_INLINE double bulk(double J) const { return K * exp((1.0 - gamma) * log(J)); }
    /** -J^2 dp/dJ: zero in the cavitated state. */
    MPM_INLINE double slope(double J) const
    {
      const double liquid = bulk(J);
      return log(J) > logJc ? 0.0 : liquid;
    }

    /** Energy without cavitation, -K/gamma [(J^(1-gamma) - 1)/(1-gamma) - (J - 1)]; x = ln J. */
    MPM_INLINE double liquid_energy(double J, double x) const
    {
      const double a = 1.0 - gamma;
      return -(K / gamma) * (inv_a * expm1(a * x) + linear * x - (J - 1.0));
    }
    MPM_INLINE double stored(double J) const
    {
      const double x = log(J);
      const double u = liquid_energy(J, x);
      return x > logJc ? Uc - pmin * (J - Jc) : u;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

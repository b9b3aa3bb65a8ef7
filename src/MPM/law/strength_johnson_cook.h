/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_JOHNSON_COOK_H
#define MPM_LAW_STRENGTH_JOHNSON_COOK_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  enum { JC_G, JC_A, JC_B, JC_N, JC_C, JC_RATE, JC_M, JC_MELT, JC_REF };

  /** Y = (A + B e^N) (1 + C ln max(rate/EPSDOT0, 1)) (1 - T*^M) of plastic strain e, plastic strain
   *  rate and temperature at the end of the step. The temperature rises by the heat of the plastic
   *  work of the step, (Y_start + Y)/2 D with Y_start at the old e and T and the present rate; that
   *  of other heat is of the step before. */
  template <bool THERMAL> struct JohnsonCookFlow {
    static constexpr bool smooth = true;    // kinks are too small to matter
    static constexpr bool goes_on = false;
    double G, A, B, N, C, inv_rate;
    double M, soft, Tref, inv_range;    ///< soft: 1, or 0 without thermal softening
    double warm;                        ///< temperature rise per plastic work
    const double *temperature;

    JohnsonCookFlow(const LawParameters &p, const Batch &b) :
        G(p.value[JC_G]), A(p.value[JC_A]), B(p.value[JC_B]), N(p.value[JC_N]), C(p.value[JC_C]),
        inv_rate(1.0 / max(p.value[JC_RATE] * b.dt, 1e-300)), M(p.value[JC_M]),
        soft(p.value[JC_M] > 0.0 ? 1.0 : 0.0), Tref(p.value[JC_REF]),
        inv_range(1.0 / (p.value[JC_MELT] - p.value[JC_REF])), warm(p.chi * p.warm),
        temperature(MPM_NS::temperature(p, b))
    {
    }

    MPM_INLINE double shear(int) const { return G; }
    MPM_INLINE double homologous(double T) const
    {
      return min(max((T - Tref) * inv_range, 0.0), 1.0);
    }
    MPM_INLINE double start(History history, int i) const
    {
      const double hard = A + B * pow(history[0][i], N);
      return THERMAL ? hard * (1.0 - soft * pow(homologous(temperature[i]), M)) : hard;
    }

    /** Factor of the rate, and its derivative with respect to D. */
    MPM_INLINE double rate(double D, double &slope) const
    {
      const double x = D * inv_rate;
      slope = x > 1.0 ? C / D : 0.0;
      return 1.0 + C * log(max(x, 1.0));
    }

    MPM_INLINE void stress(History history, int i, double start, const TrialState trial, double D,
                           double &y, double &dy) const
    {
      const double e = history[0][i] + D, power = B * pow(e, N);
      const double hard = A + power, dhard = N * power / max(e, 1e-300);
      double dfast;
      const double fast = rate(D, dfast);
      y = hard * fast;
      dy = dhard * fast + hard * dfast;
      if (THERMAL) {
        const double sigma = trial.q - trial.stiff * D;    // is Y at the solution
        const double half = 0.5 * trial.J * warm;
        const double T = temperature[i] + half * (start * fast + sigma) * D;
        const double dT = half * (start * (fast + dfast * D) + sigma - trial.stiff * D);
        const double t = homologous(T);
        const double tm = soft * pow(t, M);
        const double dcold = t > 0.0 && t < 1.0 ? -M * tm / t * inv_range * dT : 0.0;
        dy = dy * (1.0 - tm) + y * dcold;
        y = y * (1.0 - tm);
      }
    }

    MPM_INLINE double begin(double start, double D) const
    {
      double slope;
      return start * rate(D, slope);
    }
  };

  /** Johnson-Cook flow stress (G.R. Johnson, W.H. Cook, Proc. 7th Int. Symp. Ballistics, The Hague,
   *  1983, p. 541). Rates below EPSDOT0 count as EPSDOT0. */
  struct StrengthJohnsonCook : ShearElasticity {
    static constexpr const char *name = "johnson/cook";
    static constexpr const char *meaning = "Johnson-Cook plasticity with rate and temperature";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "A", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress"},
        {"", "B", "pressure", NOT_NEGATIVE, REQUIRED, "hardening B e^N"},
        {"", "N", "1", POSITIVE, REQUIRED, "exponent of the plastic strain e"},
        {"", "C", "1", NOT_NEGATIVE, REQUIRED, "rate coefficient"},
        {"", "EPSDOT0", "1/time", POSITIVE, REQUIRED, "reference plastic strain rate"},
        {"", "M", "1", NOT_NEGATIVE, 0.0, "exponent of the temperature, 0: no thermal softening"},
        {"", "TMELT", "temperature", ANY_NUMBER, 1.0, "melting temperature"},
        {"", "TREF", "temperature", ANY_NUMBER, 0.0, "reference temperature"}};
    static constexpr HistoryDeclaration history[] = {PLASTIC_STRAIN};
    static constexpr bool needs_temperature(const LawParameters &p) { return p.value[JC_M] > 0.0; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[JC_MELT] > p.value[JC_REF] ? nullptr : "TMELT must be above TREF";
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      if (needs_temperature(p))
        RadialReturn<JohnsonCookFlow<true>>::update(p, b, history);
      else
        RadialReturn<JohnsonCookFlow<false>>::update(p, b, history);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_ZERILLI_ARMSTRONG_H
#define MPM_LAW_STRENGTH_ZERILLI_ARMSTRONG_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  enum { ZA_G, ZA_C0, ZA_BCC_C1, ZA_BCC_C3, ZA_BCC_C4, ZA_BCC_C5, ZA_BCC_N };
  enum { ZA_FCC_C2 = ZA_BCC_N + 1, ZA_FCC_C3, ZA_FCC_C4, ZA_MELT, ZA_RATE };

  /** Y = C0 + (C1 + C2 sqrt(e)) exp(-C3 T + C4 T ln(r/RATE)) + C5 e^N of plastic strain e, plastic
   *  strain rate r and temperature T of the end of the step; C2 = 0 (bcc) or C1 = C5 = 0 (fcc). The
   *  exponent is at most 0. T rises by the heat of the plastic work of the step,
   *  (Y_begin + Y)/2 D; that of other heat is of the step before. */
  struct ZerilliArmstrongFlow {
    static constexpr bool smooth = false, goes_on = true;    // kink of the exponent
    double G, C0, C1, C2, C3, C4, C5, N;
    double inv_rate, melt, warm;    ///< warm: temperature rise per plastic work
    const double *temperature;

    ZerilliArmstrongFlow(const LawParameters &p, const Batch &b) :
        G(p.value[ZA_G]), C0(p.value[ZA_C0]), C1(p.value[ZA_BCC_C1]), C2(p.value[ZA_FCC_C2]),
        C3(p.value[ZA_BCC_C3] + p.value[ZA_FCC_C3]), C4(p.value[ZA_BCC_C4] + p.value[ZA_FCC_C4]),
        C5(p.value[ZA_BCC_C5]), N(p.value[ZA_BCC_N]),
        inv_rate(1.0 / max(p.value[ZA_RATE] * b.dt, 1e-300)),
        melt(p.value[ZA_MELT] > 0.0 ? p.value[ZA_MELT] : UNBOUNDED), warm(p.chi * p.warm),
        temperature(MPM_NS::temperature(p, b))
    {
    }
    MPM_INLINE double shear(int) const { return G; }
    MPM_INLINE double start(History history, int i) const
    {
      // rate 0: no thermal stress, except at absolute zero
      const double e = history[0][i], T = temperature[i];
      const double thermal = T * C4 > 0.0 ? 0.0 : (C1 + C2 * std::sqrt(e)) * exp(-C3 * T);
      const double y = C0 + thermal + C5 * pow(e, N);
      return T < melt ? y : 0.0;
    }
    MPM_INLINE void stress(History history, int i, double begin, const TrialState t, double D,
                           double &y, double &dy) const
    {
      const double e = history[0][i] + D, root = std::sqrt(e), power = C5 * pow(e, N);
      const double sigma = t.q - t.stiff * D;    // is Y at the solution
      const double half = 0.5 * t.J * warm;
      const double T = max(temperature[i] + half * (begin + sigma) * D, 0.0);
      const double dT = half * (begin + sigma - t.stiff * D);
      const double slope = C4 * log(max(D * inv_rate, 1e-300)) - C3, x = slope * T;
      const double thermal = (C1 + C2 * root) * exp(min(x, 0.0));
      const double dx = x < 0.0 ? slope * dT + C4 * T / max(D, 1e-300) : 0.0;
      const double solid = temperature[i] < melt ? 1.0 : 0.0;
      y = solid * (C0 + thermal + power);
      dy = solid *
          (thermal * dx + thermal * C2 / max(2.0 * root * (C1 + C2 * root), 1e-300) +
           N * power / max(e, 1e-300));
    }
    MPM_INLINE double begin(double start, double) const { return start; }
  };

  /** Flow stress by thermally activated motion of dislocations (F.J. Zerilli, R.W. Armstrong, J.
   *  Appl. Phys. 61 (1987) 1816, eqs. 9 and 10). At and above the melting temperature, where one is
   *  given, there is no strength. */
  struct StrengthZerilliArmstrong : RadialReturn<ZerilliArmstrongFlow> {
    static constexpr const char *name = "zerilli/armstrong";
    static constexpr const char *meaning = "Zerilli-Armstrong plasticity of bcc and fcc metals";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "C0", "pressure", NOT_NEGATIVE, REQUIRED, "athermal stress, with that of grain size"},
        {"form bcc", "C1", "pressure", NOT_NEGATIVE, 0.0, "thermal stress at absolute zero"},
        {"form bcc", "C3", "1/temperature", NOT_NEGATIVE, 0.0, "decay with temperature"},
        {"form bcc", "C4", "1/temperature", NOT_NEGATIVE, 0.0, "effect of the rate"},
        {"form bcc", "C5", "pressure", NOT_NEGATIVE, 0.0, "hardening C5 e^N"},
        {"form bcc", "N", "1", POSITIVE, 1.0, "exponent of the plastic strain e"},
        {"form fcc", "C2", "pressure", POSITIVE, 0.0, "hardening C2 e^(1/2) at absolute zero"},
        {"form fcc", "C3", "1/temperature", NOT_NEGATIVE, 0.0, "decay with temperature"},
        {"form fcc", "C4", "1/temperature", NOT_NEGATIVE, 0.0, "effect of the rate"},
        {"melt", "TMELT", "temperature", POSITIVE, 0.0, "melting temperature, 0: none"},
        {"rate", "RATE", "1/time", POSITIVE, 1.0, "unit of the plastic strain rate, 1/s"}};
    static constexpr HistoryDeclaration history[] = {PLASTIC_STRAIN};
    static constexpr bool needs_temperature(const LawParameters &) { return true; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[ZA_BCC_C1] > 0.0 || p.value[ZA_BCC_C5] > 0.0 || p.value[ZA_FCC_C2] > 0.0
          ? nullptr
          : "add 'form bcc' or 'form fcc' with constants that are not zero";
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

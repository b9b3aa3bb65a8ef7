/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STRENGTH_J2_H
#define LMP_MPM_STRENGTH_J2_H

#include "mpm_strength_return.h"

namespace MPM_NS::law {
namespace {

  /** Flow stress SIGMAY + H e + B e^N of the plastic strain e. */
  struct J2Flow {
    double sigmay, H, B, N;

    J2Flow(const LawParameters &p, const Batch &) :
        sigmay(p.value[1]), H(p.value[2]), B(p.value[3]), N(p.value[4])
    {
    }
    MPM_INLINE double start(History history, int i) const
    {
      const double e = history[0][i];
      return sigmay + H * e + B * pow(e, N);
    }
    MPM_INLINE void stress(History history, int i, double, const TrialState, double D, double &y,
                           double &dy) const
    {
      const double e = history[0][i] + D, power = B * pow(e, N);
      y = sigmay + H * e + power;
      dy = H + N * power / max(e, 1e-300);
    }
    MPM_INLINE double finish(History history, int i, double start, double D, double y, double) const
    {
      history[0][i] += D;
      return 0.5 * (start + y) * D;
    }
  };

  /** Von Mises plasticity with isotropic hardening; linear hardening is solved in closed form. */
  struct StrengthJ2 : RadialReturn<J2Flow> {
    static constexpr const char *name = "j2";
    static constexpr const char *meaning = "von Mises plasticity with isotropic hardening";
    static constexpr StressShare share = DEVIATOR;
    static constexpr Parameter parameters[] = {
        {"", "G", "pressure", POSITIVE, REQUIRED, "shear modulus"},
        {"", "SIGMAY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in uniaxial tension"},
        {"hardening linear", "H", "pressure", NOT_NEGATIVE, 0.0,
         "slope of flow stress over plastic strain"},
        {"hardening power", "B", "pressure", NOT_NEGATIVE, 0.0, "hardening B e^N"},
        {"hardening power", "N", "1", POSITIVE, 1.0, "exponent of the plastic strain e"}};
    static constexpr HistoryDeclaration history[] = {
        {"eplastic", ZERO, "1", "equivalent plastic strain"}};
    static constexpr int nhistory(const LawParameters &) { return 1; }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      if (p.value[3] > 0.0)
        RadialReturn<J2Flow>::update(p, b, history);
      else
        linear(p, b, history);
    }

   private:
    static MPM_INLINE void linear(const LawParameters &p, Batch &b, History history)
    {
      const double G = p.value[0], sigmay = p.value[1], H = p.value[2];
      const ElasticDeviator elastic{G};
      double plastic = 0.0;
      MPM_SIMD_SUM(plastic)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym s = elastic.trial(b, i, inc);
        const double q = std::sqrt(1.5 * norm2(s));
        const double e = history[0][i], y = sigmay + H * e;
        const double J = b.J[i];
        const double D = max(q - y, 0.0) / (3.0 * G / J + H);
        const double ynew = y + H * D;
        store_stress(b, i, (q > y ? ynew / q : 1.0) * s);
        const double work = 0.5 * (J + b.Jold[i]) * 0.5 * (y + ynew) * D;
        history[0][i] = e + D;
        b.plastic[i] = D;
        b.heat[i] += p.chi * work;
        plastic += work * b.vol0[i];
      }
      b.work[PLASTIC] += plastic;
      b.work[HEAT] += p.chi * plastic;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_LAW_SNOW_H
#define MPM_LAW_SNOW_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** Snow (A. Stomakhin, C. Schroeder, L. Chai, J. Teran, A. Selle, ACM Trans. Graph. 32 (2013) 102):
   *  principal elastic stretches s_a stay between 1 - THETAC and 1 + THETAS, the rest of the motion
   *  is plastic; with JE the product of s_a and JP = J/JE,
   *
   *    w = h [mu sum (s_a - 1)^2 + lambda/2 (JE - 1)^2],  h = exp(XI (1 - JP))
   *    tau_a = h [2 mu s_a (s_a - 1) + lambda JE (JE - 1)]
   *
   *  Elastic energy that hardening adds to the strain that is there is taken from the plastic work.
   *  The box of stretches is no yield surface with associated flow: the plastic work is negative
   *  where snow at THETAS is drawn out under compression from its sides. Clamping the work would
   *  not close the balance of energy, another direction of flow would be another law (nacc). */
  struct LawSnow : PrincipalReturn<LawSnow>, LameModuli {
    static constexpr const char *name = "snow";
    static constexpr const char *meaning = "snow with critical compression and stretch";
    enum { E, NU, THETAC, THETAS, XI };
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at the start"},
        POISSONS_RATIO,
        {"", "THETAC", "1", {0.0, 0.9, true}, REQUIRED, "critical compression"},
        {"", "THETAS", "1", {0.0, 0.9, true}, REQUIRED, "critical stretch"},
        {"", "XI", "1", NOT_NEGATIVE, REQUIRED, "hardening exponent"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY, {"jplastic", ONE, "1", "plastic volume ratio"}};

    double low, high, xi;

    explicit LawSnow(const LawParameters &p) :
        LameModuli(p), low(std::log1p(-p.value[THETAC])), high(std::log1p(p.value[THETAS])),
        xi(p.value[XI])
    {
    }

    MPM_INLINE double hardening(double JP) const { return exp(xi * (1.0 - JP)); }

    /** Energy for h = 1, from the stretches and their product less one. */
    MPM_INLINE double elastic(double s0, double s1, double s2, double dJ) const
    {
      return mu * (s0 * s0 + s1 * s1 + s2 * s2) + 0.5 * lambda * dJ * dJ;
    }

    MPM_INLINE double shear_part(double ds) const { return 2.0 * mu * (1.0 + ds) * ds; }

    MPM_INLINE void map(Batch &b, History history, PrincipalStates &s) const
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double e0 = min(max(s.strain[0][i], low), high), flow0 = s.strain[0][i] - e0;
        const double e1 = min(max(s.strain[1][i], low), high), flow1 = s.strain[1][i] - e1;
        const double e2 = min(max(s.strain[2][i], low), high), flow2 = s.strain[2][i] - e2;
        const double volume = flow0 + flow1 + flow2, m = (1.0 / 3.0) * volume;
        const double JP = history[0][i], JPnew = JP * exp(volume);
        const double h0 = hardening(JP), h = hardening(JPnew);
        // stretches less one; Kirchhoff stresses for h = 1 at start and end
        const double x0 = expm1(s.before[0][i]), x1 = expm1(s.before[1][i]);
        const double x2 = expm1(s.before[2][i]), y0 = expm1(e0), y1 = expm1(e1), y2 = expm1(e2);
        const double dJ = expm1(s.before[0][i] + s.before[1][i] + s.before[2][i]);
        const double dJnew = expm1(e0 + e1 + e2), pv = lambda * (1.0 + dJnew) * dJnew;
        const double t0 = pv + shear_part(y0), t1 = pv + shear_part(y1), t2 = pv + shear_part(y2);
        const double by_old = lambda * (1.0 + dJ) * dJ * volume + shear_part(x0) * flow0 +
            shear_part(x1) * flow1 + shear_part(x2) * flow2;
        const double by_new = t0 * flow0 + t1 * flow1 + t2 * flow2;
        const double w0 = elastic(x0, x1, x2, dJ), w = elastic(y0, y1, y2, dJnew);
        const double square =
            (flow0 - m) * (flow0 - m) + (flow1 - m) * (flow1 - m) + (flow2 - m) * (flow2 - m);
        s.strain[0][i] = e0;
        s.strain[1][i] = e1;
        s.strain[2][i] = e2;
        s.tau[0][i] = h * t0;
        s.tau[1][i] = h * t1;
        s.tau[2][i] = h * t2;
        s.work[i] = 0.5 * (h0 * by_old + h * by_new) - 0.5 * (w0 + w) * (h - h0);
        b.plastic[i] = std::sqrt((2.0 / 3.0) * square);
        history[0][i] = JPnew;
      }
    }

    MPM_INLINE double stored(History history, int i, double e0, double e1, double e2) const
    {
      return hardening(history[0][i]) *
          elastic(expm1(e0), expm1(e1), expm1(e2), expm1(e0 + e1 + e2));
    }

    /** J d sigma_nn / d strain_nn = h (2 mu s_n^2 + lambda JE^2) along a principal axis. */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const LawSnow law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym c = load_rows(history, i);
        const double largest = 1.0 + (1.0 / 3.0) * trace(c) + eigenvalue_bound(deviator(c));
        k[i] += law.hardening(history[ELASTIC_STRAIN_ROWS][i]) *
            (2.0 * law.mu * largest + law.lambda * (1.0 + elastic_volume(c)));
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

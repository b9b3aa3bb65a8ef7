/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef LMP_MPM_LAW_SNOW_H
#define LMP_MPM_LAW_SNOW_H

#include "mpm_law_elastoplastic.h"

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
   *  where snow at THETAS is drawn out under compression from its sides. */
  struct LawSnow : PrincipalReturn<LawSnow> {
    static constexpr const char *name = "snow";
    static constexpr const char *meaning = "snow with critical compression and stretch";
    enum { E, NU, THETAC, THETAS, XI };
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at the start"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio"},
        {"", "THETAC", "1", {0.0, 0.9, true}, REQUIRED, "critical compression"},
        {"", "THETAS", "1", {0.0, 0.9, true}, REQUIRED, "critical stretch"},
        {"", "XI", "1", NOT_NEGATIVE, REQUIRED, "hardening exponent"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY, {"jplastic", ONE, "1", "plastic volume ratio"}};
    static constexpr int nhistory(const LawParameters &) { return ELASTIC_STRAIN_ROWS + 1; }

    double mu, lambda, low, high, xi;

    explicit LawSnow(const LawParameters &p) :
        mu(p.value[E] / (2.0 * (1.0 + p.value[NU]))),
        lambda(p.value[E] * p.value[NU] / ((1.0 + p.value[NU]) * (1.0 - 2.0 * p.value[NU]))),
        low(std::log1p(-p.value[THETAC])), high(std::log1p(p.value[THETAS])), xi(p.value[XI])
    {
    }
    LawSnow(const LawParameters &p, const Batch &) : LawSnow(p) {}

    MPM_INLINE double hardening(double JP) const { return exp(xi * (1.0 - JP)); }

    /** Stress and energy for h = 1. */
    MPM_INLINE double elastic(const double e[3], double tau[3]) const
    {
      const double dJ = expm1(e[0] + e[1] + e[2]);
      double square = 0.0;
      for (int a = 0; a < 3; a++) {
        const double ds = expm1(e[a]);
        tau[a] = 2.0 * mu * (1.0 + ds) * ds + lambda * (1.0 + dJ) * dJ;
        square += ds * ds;
      }
      return mu * square + 0.5 * lambda * dJ * dJ;
    }

    MPM_INLINE void map(Batch &b, History history, PrincipalStates &s) const
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        double e[3], old[3], flow[3], tau[3], tau_old[3];
        double volume = 0.0;
        for (int a = 0; a < 3; a++) {
          old[a] = s.before[a][i];
          e[a] = min(max(s.strain[a][i], low), high);
          flow[a] = s.strain[a][i] - e[a];
          volume += flow[a];
        }
        const double JP = history[0][i], JPnew = JP * exp(volume);
        const double h0 = hardening(JP), h = hardening(JPnew);
        const double w0 = elastic(old, tau_old), w = elastic(e, tau);
        double by_old = 0.0, by_new = 0.0, square = 0.0;
        for (int a = 0; a < 3; a++) {
          by_old += h0 * tau_old[a] * flow[a];
          by_new += h * tau[a] * flow[a];
          square += (flow[a] - (1.0 / 3.0) * volume) * (flow[a] - (1.0 / 3.0) * volume);
          s.strain[a][i] = e[a];
          s.tau[a][i] = h * tau[a];
        }
        s.work[i] = 0.5 * (by_old + by_new) - 0.5 * (w0 + w) * (h - h0);
        b.plastic[i] = std::sqrt((2.0 / 3.0) * square);
        history[0][i] = JPnew;
      }
    }

    MPM_INLINE double stored(History history, int i, const double e[3]) const
    {
      double tau[3];
      return hardening(history[0][i]) * elastic(e, tau);
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

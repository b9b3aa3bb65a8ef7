/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */
#ifndef MPM_LAW_MOHR_COULOMB_H
#define MPM_LAW_MOHR_COULOMB_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** Principal Kirchhoff stresses, largest first. */
  struct Ordered {
    double s1, s2, s3;
  };

  /** Mohr-Coulomb surface s1 - s3 + (s1 + s3) sin(phi) = 2 c cos(phi), with non-associated flow, and
   *  the return to it (E.A. de Souza Neto, D. Peric, D.R.J. Owen, Computational Methods for
   *  Plasticity, 2008, boxes 8.4 to 8.7): to the plane, one of the two edges, or the apex. */
  struct MohrCoulombSurface {
    double K, G, sin_psi;

    /** Left side less right side; s1, s3: largest and smallest stress, sp: sin(phi), cc: c cos(phi). */
    MPM_INLINE double excess(double s1, double s3, double sp, double cc) const
    {
      return s1 - s3 + (s1 + s3) * sp - 2.0 * cc;
    }

    /** at_apex: 1 or 0. The trial state is outside. */
    MPM_INLINE Ordered project(const Ordered &t, double sp, double cc, double &at_apex) const
    {
      const double st = sin_psi, ss = sp * st;
      // change of the three stresses per multiplier of the main plane; of the other two planes it is
      // the same with stresses exchanged
      const double d1 = -2.0 * G * (1.0 + (1.0 / 3.0) * st) - 2.0 * K * st;
      const double d2 = ((4.0 / 3.0) * G - 2.0 * K) * st;
      const double d3 = 2.0 * G * (1.0 - (1.0 / 3.0) * st) - 2.0 * K * st;
      const double a = 4.0 * G * (1.0 + (1.0 / 3.0) * ss) + 4.0 * K * ss;
      const double main = excess(t.s1, t.s3, sp, cc);

      const double m = main / a;
      const double p1 = t.s1 + d1 * m, p2 = t.s2 + d2 * m, p3 = t.s3 + d3 * m;
      // conditions are the sign of a number: combinations of comparisons do not vectorize
      const double plane = min(p1 - p2, p2 - p3);

      // right: s2 = s3, with the plane of s1 and s2; left: s1 = s2, with that of s2 and s3
      const double right = (1.0 - st) * t.s1 - 2.0 * t.s2 + (1.0 + st) * t.s3;
      const double other = right > 0.0 ? excess(t.s1, t.s2, sp, cc) : excess(t.s2, t.s3, sp, cc);
      const double b = right > 0.0 ? 2.0 * G * (1.0 + sp + st - (1.0 / 3.0) * ss) + 4.0 * K * ss
                                   : 2.0 * G * (1.0 - sp - st - (1.0 / 3.0) * ss) + 4.0 * K * ss;
      const double det = 1.0 / ((a - b) * (a + b));
      const double ma = (a * main - b * other) * det, mb = (a * other - b * main) * det;
      const double e1 = t.s1 + d1 * ma + (right > 0.0 ? d1 : d2) * mb;
      const double e2 = t.s2 + d2 * ma + (right > 0.0 ? d3 : d1) * mb;
      const double e3 = t.s3 + d3 * ma + (right > 0.0 ? d2 : d3) * mb;
      const double pair = 0.5 * (e2 + (right > 0.0 ? e3 : e1));    // equal but for round-off
      const double edge = right > 0.0 ? e1 - pair : pair - e3;
      const double k1 = right > 0.0 ? e1 : pair, k3 = right > 0.0 ? pair : e3;

      const double tip = cc / max(sp, 1e-12);
      at_apex = max(plane, edge) >= 0.0 ? 0.0 : 1.0;
      const double c1 = edge >= 0.0 ? k1 : tip, c2 = edge >= 0.0 ? pair : tip;
      const double c3 = edge >= 0.0 ? k3 : tip;
      Ordered r;
      r.s1 = plane >= 0.0 ? p1 : c1;
      r.s2 = plane >= 0.0 ? p2 : c2;
      r.s3 = plane >= 0.0 ? p3 : c3;
      return r;
    }

    /** Equivalent plastic strain of a return, sqrt(2/3 e:e) of its deviator. */
    MPM_INLINE double strain(const Ordered &t, const Ordered &r) const
    {
      const double a = t.s1 - r.s1, b = t.s2 - r.s2, c = t.s3 - r.s3;
      const double ab = a - b, bc = b - c, ca = c - a;
      return std::sqrt((2.0 / 9.0) * (ab * ab + bc * bc + ca * ca)) / (2.0 * G);
    }
  };

  /** Elastic-plastic solid with the Mohr-Coulomb surface in Kirchhoff stress, see
   *  MohrCoulombSurface, and Hencky elasticity. Cohesion and friction angle may soften with the
   *  equivalent plastic strain e (A. Yerro, E.E. Alonso, N.M. Pinyol, Comput. Geotech. 74 (2016) 26):
   *
   *    c = CR + (C - CR) exp(-RATE e),  phi = PHIR + (PHI - PHIR) exp(-RATE e)
   *
   *  at the end of the step: the increment of e that a return makes, as a function of that with which
   *  the strength is taken, has a fixed point, found within a bracket by the secant method (Illinois
   *  variant), a batch at a time. Volume strain at the apex is kept as "gap", see close_gap(). */
  struct LawMohrCoulomb : PrincipalReturn<LawMohrCoulomb>, BulkAndShear {
    static constexpr const char *name = "mohr/coulomb";
    static constexpr const char *meaning = "Mohr-Coulomb plasticity with softening: soil, rock";
    enum { E, NU, PHI, COHESION, PSI, RESIDUAL_C, RESIDUAL_PHI, RATE };
    static constexpr Parameter parameters[] = {
        YOUNGS_MODULUS,
        POISSONS_RATIO,
        {"", "PHI", "degrees", {0.0, 80.0, true}, REQUIRED, "friction angle"},
        {"", "C", "pressure", NOT_NEGATIVE, REQUIRED, "cohesion"},
        {"dilatancy", "PSI", "degrees", {0.0, 80.0, true}, 0.0, "dilatancy angle"},
        {"residual", "CR", "pressure", NOT_NEGATIVE, 0.0, "residual cohesion"},
        {"residual", "PHIR", "degrees", {0.0, 80.0, true}, 0.0, "residual friction angle"},
        {"residual", "RATE", "1", NOT_NEGATIVE, 0.0, "softening per plastic strain"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"gap", ZERO, "1", "logarithmic volume strain between separated parts"}};
    static constexpr const char *check(const LawParameters &p)
    {
      const bool soft = p.value[RATE] > 0.0;
      if (p.value[PSI] > p.value[PHI] || (soft && p.value[PSI] > p.value[RESIDUAL_PHI]))
        return "PSI must not exceed PHI and PHIR, or flow makes energy";
      if (soft && (p.value[RESIDUAL_C] > p.value[COHESION] || p.value[RESIDUAL_PHI] > p.value[PHI]))
        return "CR and PHIR must not exceed C and PHI";
      return nullptr;
    }

    double phi, c, cr, phir, rate, sin_phi, c_cos_phi;
    MohrCoulombSurface surface;

    explicit LawMohrCoulomb(const LawParameters &p) :
        BulkAndShear(p), phi(p.value[PHI] * DEGREES), c(p.value[COHESION]), cr(p.value[RESIDUAL_C]),
        phir(p.value[RESIDUAL_PHI] * DEGREES), rate(p.value[RATE]), sin_phi(std::sin(phi)),
        c_cos_phi(c * std::cos(phi)), surface{K, G, std::sin(p.value[PSI] * DEGREES)}
    {
    }

    /** sin(phi) and c cos(phi) at a plastic strain. */
    template <bool SOFT> MPM_INLINE void strength(double e, double &sp, double &cc) const
    {
      const double left = SOFT ? exp(-rate * e) : 1.0;
      sp = SOFT ? sin(phir + (phi - phir) * left) : sin_phi;
      cc = SOFT ? (cr + (c - cr) * left) * std::sqrt((1.0 - sp) * (1.0 + sp)) : c_cos_phi;
    }

    MPM_INLINE void map(Batch &b, History history, PrincipalStates &s) const
    {
      if (rate > 0.0)
        return_to_surface<true>(b, history, s);
      else
        return_to_surface<false>(b, history, s);
    }

    template <bool SOFT>
    MPM_INLINE void return_to_surface(Batch &b, History history, PrincipalStates &s) const
    {
      alignas(64) double s1[BATCH], s2[BATCH], s3[BATCH], D[BATCH], yields[BATCH];
      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        double gap = history[1][i];
        const double v = s.strain[0][i] + s.strain[1][i] + s.strain[2][i];
        const double shift = (1.0 / 3.0) * (close_gap(v, gap) - v);
        history[1][i] = gap;
        const double pv = (K - (2.0 / 3.0) * G) * (v + 3.0 * shift);
        for (int a = 0; a < 3; a++) {
          s.strain[a][i] += shift;
          s.tau[a][i] = pv + 2.0 * G * s.strain[a][i];
        }
        const double x = s.tau[0][i], y = s.tau[1][i], z = s.tau[2][i];
        s1[i] = max(max(x, y), z);
        s3[i] = min(min(x, y), z);
        s2[i] = max(min(x, y), min(max(x, y), z));
        double sp, cc;
        strength<SOFT>(history[0][i], sp, cc);
        const bool plastic = surface.excess(s1[i], s3[i], sp, cc) > 0.0;
        yields[i] = plastic ? 1.0 : 0.0;
        D[i] = 0.0;
        yielding += yields[i];
      }
      if (yielding == 0.0) {    // what follows would change no bit
        for (int i = 0; i < b.n; i++) s.work[i] = 0.0;
        return;
      }
      if (SOFT) soften(b, history, s1, s2, s3, yields, D);
      // changes of the ordered stresses
      alignas(64) double c1[BATCH], c2[BATCH], c3[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Ordered t = {s1[i], s2[i], s3[i]};
        double sp, cc, at_apex;
        strength<SOFT>(history[0][i] + D[i], sp, cc);
        const Ordered r = surface.project(t, sp, cc, at_apex);
        const double plastic = yields[i], made = plastic * surface.strain(t, r);
        c1[i] = plastic * (r.s1 - t.s1);
        c2[i] = plastic * (r.s2 - t.s2);
        c3[i] = plastic * (r.s3 - t.s3);
        b.plastic[i] = made;
        history[0][i] += made;
        history[1][i] -= at_apex * min((1.0 / 3.0) * (c1[i] + c2[i] + c3[i]), 0.0) / K;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double p_old = s.before[0][i] + s.before[1][i] + s.before[2][i];
        const double mean = (1.0 / 3.0) * (c1[i] + c2[i] + c3[i]);
        double by_old = 0.0, by_new = 0.0;
        for (int a = 0; a < 3; a++) {
          // stresses go back to their axes: equal trial stresses stay equal
          const double x = s.tau[a][i];
          const double lower = x == s3[i] ? c3[i] : c2[i];
          const double change = x == s1[i] ? c1[i] : lower;
          const double tau = x + change, flow = (mean - change) / (2.0 * G) - mean / (3.0 * K);
          by_old += ((K - (2.0 / 3.0) * G) * p_old + 2.0 * G * s.before[a][i]) * flow;
          by_new += tau * flow;
          s.strain[a][i] -= flow;
          s.tau[a][i] = tau;
        }
        s.work[i] = plastic_work(by_old, by_new);
      }
    }

    /** Increment of the plastic strain with which the strength is that at the end of the step. */
    MPM_INLINE void soften(const Batch &b, History history, const double *s1, const double *s2,
                           const double *s3, const double *yields, double *D) const
    {
      constexpr int MAX_ITERATIONS = 60;
      alignas(64) double low[BATCH], high[BATCH], r_low[BATCH], r_high[BATCH], side[BATCH];
      alignas(64) double open[BATCH], d0[BATCH], d1[BATCH], r0[BATCH], r1[BATCH];    // the last two
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        // strain of the return less D: not negative at the low end, and not positive at the high one,
        // where there is no strength in shear
        low[i] = r_low[i] = 0.0;
        high[i] = yields[i] * surface.strain({s1[i], s2[i], s3[i]}, {0.0, 0.0, 0.0});
        r_high[i] = -high[i];
        side[i] = d0[i] = d1[i] = r0[i] = r1[i] = 0.0;
        open[i] = high[i] > 0.0 ? 1.0 : 0.0;
      }
      for (int iteration = 0; iteration < MAX_ITERATIONS; iteration++) {
        // D = 0 comes first, then a step of the fixed-point iteration, which comes close, then the secant of
        // the last two, or now and then, and where that is outside, of the bracket
        const double late = iteration > 1 ? 1.0 : 0.0, free = iteration % 4 != 1 ? 1.0 : 0.0;
        double busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const Ordered t = {s1[i], s2[i], s3[i]};
          const double gap = r_low[i] - r_high[i], width = high[i] - low[i];
          const double chord = low[i] + width * r_low[i] / max(gap, 1e-300);
          const double quick = d1[i] + r1[i] * (d1[i] - d0[i]) / (r0[i] - r1[i]);
          const double fits = free * min(quick - low[i], high[i] - quick);
          const double secant = fits > 0.0 ? quick : chord;
          const double first = min(r_low[i], high[i]), d = first + late * (secant - first);
          double sp, cc, at_apex;
          strength<true>(history[0][i] + d, sp, cc);
          const double r = surface.strain(t, surface.project(t, sp, cc, at_apex)) - d;
          const double on = open[i], up = r > 0.0 ? on : 0.0, down = on - up;
          const double old_high = (side[i] > 0.0 ? 0.5 : 1.0) * r_high[i];
          const double old_low = (side[i] < 0.0 ? 0.5 : 1.0) * r_low[i];
          const double kept_high = up > 0.0 ? old_high : r_high[i];
          const double kept_low = down > 0.0 ? old_low : r_low[i];
          r_high[i] = down > 0.0 ? r : kept_high;
          r_low[i] = up > 0.0 ? r : kept_low;
          low[i] = up > 0.0 ? d : low[i];
          high[i] = down > 0.0 ? d : high[i];
          side[i] = r > 0.0 ? 1.0 : -1.0;
          d0[i] = d1[i];
          r0[i] = r1[i];
          d1[i] = d;
          r1[i] = r;
          D[i] = on > 0.0 ? d : D[i];
          const double rest = min(max(r, -r) - 1e-13 * d, high[i] - low[i] - 1e-14 * high[i]);
          open[i] = rest > 0.0 ? on : 0.0;
          busy += open[i];
        }
        if (busy == 0.0) return;
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      const LawMohrCoulomb law(p);
      hencky_energy(b, law.K, law.G, history, w);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

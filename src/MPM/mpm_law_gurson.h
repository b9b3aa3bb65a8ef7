/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAW_GURSON_H
#define LMP_MPM_LAW_GURSON_H

#include "mpm_law_elastoplastic.h"

namespace MPM_NS::law {
namespace {

  enum {
    GTN_E,
    GTN_NU,
    GTN_Y,
    GTN_F0,
    GTN_E0,
    GTN_N,
    GTN_Q1,
    GTN_Q2,
    GTN_FN,
    GTN_EN,
    GTN_SN,
    GTN_FC,
    GTN_FF
  };

  /** Ductile metal with voids (A.L. Gurson, J. Eng. Mater. Technol. 99 (1977) 2; V. Tvergaard,
   *  A. Needleman, Acta Metall. 32 (1984) 157): with the Cauchy mean stress m, equivalent stress q,
   *  porosity f, and the flow stress y = SIGMAY (1 + e/E0)^N of the matrix at its plastic strain e,
   *
   *    (q/y)^2 + 2 Q1 f* cosh(3/2 Q2 m/y) - 1 - (Q1 f*)^2 = 0
   *    f* = f up to FC, then linear to 1/Q1 at FF, where all stress is lost
   *    df = (1 - f) dv + A(e) de,  A = FN/(SN sqrt(2 pi)) exp[-((e - EN)/SN)^2/2] in tension
   *    (1 - f) y de = plastic work per volume
   *
   *  with associated flow, v: plastic volume strain. Elasticity: Hencky, in Kirchhoff stress.
   *
   *  Return mapping (N. Aravas, Int. J. Numer. Meth. Eng. 24 (1987) 1395), implicit in all variables:
   *  for given y and nucleation the unknown is z = log(f/f0), from which follow v (1 - f = (1 - f0)
   *  exp(-v)), m, and two values of q, by the yield surface and by the direction of flow. Their
   *  difference S changes sign between no volume flow and no mean stress: bracketed first, then
   *  followed by chords while y and nucleation are found by secants of the strain of the matrix.
   *
   *  A point that has failed bears pressure only, after the volume that opened ("gap") has closed. */
  struct LawGurson : HenckyInvariantReturn<LawGurson> {
    static constexpr const char *name = "gurson";
    static constexpr const char *meaning = "Gurson-Tvergaard-Needleman: ductile metal with voids";
    static constexpr Range INSIDE = {0.0, 1.0, false};
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio"},
        {"", "SIGMAY", "pressure", POSITIVE, REQUIRED, "yield stress of the matrix"},
        {"", "F0", "1", {0.0, 0.5, true}, REQUIRED, "initial porosity"},
        {"hardening", "E0", "1", POSITIVE, 1.0, "strain scale of the hardening"},
        {"hardening", "N", "1", FRACTION, 0.0, "exponent of the hardening"},
        {"tvergaard", "Q1", "1", POSITIVE, 1.5, "factor of the porosity"},
        {"tvergaard", "Q2", "1", POSITIVE, 1.0, "factor of the mean stress"},
        {"nucleation", "FN", "1", FRACTION, 0.0, "porosity of all voids that can nucleate"},
        {"nucleation", "EN", "1", NOT_NEGATIVE, 0.3, "mean plastic strain of nucleation"},
        {"nucleation", "SN", "1", POSITIVE, 0.1, "its standard deviation"},
        {"coalescence", "FC", "1", INSIDE, 1.0, "porosity at which voids begin to join"},
        {"coalescence", "FF", "1", INSIDE, 0.0, "porosity at failure"}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        {"eplastic", ZERO, "1", "equivalent plastic strain of the matrix"},
        {"porosity", GTN_F0, "1", "share of voids in the volume"},
        {"damage", ZERO, "1", "f* Q1, share of the flow stress that is lost, 1: failed"},
        {"gap", ZERO, "1", "logarithmic volume strain that opened after failure"}};
    enum { EPLASTIC, POROSITY, FAILED, GAP, NROWS };
    static constexpr int nhistory(const LawParameters &) { return ELASTIC_STRAIN_ROWS + NROWS; }
    static constexpr const char *check(const LawParameters &p)
    {
      const double G = p.value[GTN_E] / (2.0 * (1.0 + p.value[GTN_NU]));
      if (p.value[GTN_FF] > 0.0 && !(p.value[GTN_FF] > p.value[GTN_FC]))
        return "FF must be above FC";
      if (p.value[GTN_FF] > 0.0 && !(p.value[GTN_FC] < 1.0 / p.value[GTN_Q1]))
        return "FC must be below 1/Q1";
      if (!(p.value[GTN_F0] * p.value[GTN_Q1] < 1.0)) return "F0 must be below 1/Q1";
      return p.value[GTN_Y] * p.value[GTN_N] <= 3.0 * G * p.value[GTN_E0]
          ? nullptr
          : "SIGMAY N/E0, the slope of the hardening at its start, must not exceed 3 G";
    }

    static constexpr double LEAST = 1e-12;    ///< porosity of a solid without voids
    static constexpr double CLOSE = 1e-2;     ///< S over y at which a bracket is close enough
    double sigmay, inv_e0, n, q1, q2, fn, en, inv_sn, fc, slope, limit;

    LawGurson(const LawParameters &p, const Batch &) :
        HenckyInvariantReturn(p), sigmay(p.value[GTN_Y]), inv_e0(1.0 / p.value[GTN_E0]),
        n(p.value[GTN_N]), q1(p.value[GTN_Q1]), q2(p.value[GTN_Q2]), fn(p.value[GTN_FN]),
        en(p.value[GTN_EN]), inv_sn(1.0 / p.value[GTN_SN]), fc(p.value[GTN_FC]), slope(1.0),
        limit(1.0 / q1)
    {
      if (p.value[GTN_FF] > 0.0) slope = (limit - fc) / (p.value[GTN_FF] - fc);
    }

    MPM_INLINE double flow_stress(double e) const
    {
      return sigmay * exp(n * log(1.0 + e * inv_e0));
    }
    MPM_INLINE double effective(double f) const
    {
      return min(f > fc ? fc + slope * (f - fc) : f, limit);
    }
    /** Porosity that nucleates between plastic strains e and e + de, by the midpoint rule. */
    MPM_INLINE double nucleated(double e, double de) const
    {
      const double t = (e + 0.5 * de - en) * inv_sn;
      return fn * inv_sn * 0.39894228040143267794 * exp(-0.5 * t * t) * de;
    }

    /** The yield surface at a porosity: values for given mean stress. y: J times flow stress. */
    struct Surface {
      double
          q2;    ///< square of (equivalent stress/y); negative where the mean stress is too large
      double a_sinh;    ///< half the derivative of the yield function by m/y
    };
    MPM_INLINE Surface surface(double f, double m, double y) const
    {
      const double fs = effective(f), b = 1.5 * q2;
      const double x = min(max(b * m / y, -300.0), 300.0);
      const double less = expm1(x), inv = 1.0 / (1.0 + less);
      const double sinh = 0.5 * (less + less * inv), cosh1 = 0.5 * less * less * inv;
      const double rest = (1.0 - q1 * fs) * (1.0 - q1 * fs) - 2.0 * q1 * fs * cosh1;
      return {rest, q1 * fs * b * sinh};
    }

    /** A point on its way: known are trial stresses mt, qt, the porosity f0 with nucleation, y. */
    struct Guess {
      double f, v, m, q, S;    ///< S: difference of the squares of q by surface and flow, over y
    };
    MPM_INLINE Guess guess(double z, double mt, double qt, double f0, double y) const
    {
      Guess g;
      const double grown = f0 * expm1(z);
      g.f = f0 + grown;
      const double v = log1p(grown / (1.0 - g.f)), vmax = mt / K;
      g.v = mt > 0.0 ? min(max(v, 0.0), vmax) : max(min(v, 0.0), vmax);
      g.m = mt - K * g.v;
      const Surface s = surface(g.f, g.m, y);
      g.q = y * std::sqrt(max(s.q2, 0.0));
      // shear flow over volume flow is (q/y)/a_sinh
      const double c = g.v == 0.0 ? 0.0 : 3.0 * G * g.v / max(y * s.a_sinh * g.v, 1e-300) * g.v;
      const double by_flow = qt / (1.0 + c);
      g.S = y * s.q2 - by_flow * by_flow / y;
      return g;
    }

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &s) const
    {
      alignas(64) double mt[BATCH], qt[BATCH], f0[BATCH], y[BATCH], z[BATCH], chord[BATCH];
      alignas(64) double more[BATCH], active[BATCH];    // more: increment of the matrix strain
      double yielding = 0.0;
      MPM_SIMD_SUM(yielding)
      for (int i = 0; i < b.n; i++) {
        const bool failed = history[FAILED][i] >= 1.0;
        double gap = history[GAP][i];
        const double closed = close_gap(s.volume[i], gap);
        const double volume = failed ? closed : s.volume[i];
        history[GAP][i] = failed ? gap : 0.0;
        mt[i] = K * volume;
        qt[i] = 3.0 * G * s.shear[i];
        s.volume[i] = volume;
        f0[i] = max(history[POROSITY][i], LEAST);
        y[i] = b.J[i] * flow_stress(history[EPLASTIC][i]);
        z[i] = 0.0;
        more[i] = chord[i] = 0.0;
        const bool yields = !failed && qt[i] * qt[i] > y[i] * y[i] * surface(f0[i], mt[i], y[i]).q2;
        active[i] = yields ? 1.0 : 0.0;
        yielding += active[i];
        if (failed) {
          const double opened = max(volume, 0.0);
          s.volume[i] = volume - opened;
          s.shear[i] = 0.0;
          s.flow[i] = opened;
          history[GAP][i] = gap + opened;
        }
      }
      if (yielding == 0.0) return;

      alignas(64) double last[BATCH], missed[BATCH], end[BATCH], open[BATCH];
      bracket(b, mt, qt, f0, y, active, z, chord, end, CLOSE);
      for (int i = 0; i < b.n; i++) {
        open[i] = active[i];    // a point that is done stays as it is, whatever the others need
        last[i] = missed[i] = 0.0;
      }
      double busy = 1.0;
      for (int iteration = 0; iteration < 30 && busy > 0.0; iteration++) {
        busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const double low = min(0.0, end[i]), high = max(0.0, end[i]);
          const double first = iteration > 0 ? guess(z[i], mt[i], qt[i], f0[i], y[i]).S : 0.0;
          const double zi = min(max(z[i] - first * chord[i], low), high);
          const Guess g = guess(zi, mt[i], qt[i], f0[i], y[i]);
          const double fall = g.S - first;
          const double slope = max(first, -first) > 1e-9 * y[i] && fall != 0.0 ? (zi - z[i]) / fall
                                                                               : chord[i];
          const double way = slope * chord[i] > 0.0 ? slope : chord[i], rest = g.S * way;

          // increment of the matrix strain by the plastic work, less the one that y stands for
          const double D = (qt[i] - g.q) / (3.0 * G);
          const double work = max((g.m * g.v + g.q * D) / ((1.0 - g.f) * y[i]), 0.0);
          const double r = more[i] - work, change = more[i] - last[i];
          const double secant = iteration > 0 && change != 0.0 ? (r - missed[i]) / change : 1.0;
          const double next = max(more[i] - r / (secant > 0.3 ? secant : 1.0), 0.0);
          const bool here = open[i] > 0.0;
          const bool go = here &&
              (max(r, -r) > 1e-12 * (more[i] + 1e-6) ||
               max(rest, -rest) > 1e-11 * (high - low) + 1e-15);

          const double e = history[EPLASTIC][i], old = max(history[POROSITY][i], LEAST);
          const double born = mt[i] > 0.0 ? nucleated(e, next) : 0.0;
          last[i] = more[i];
          missed[i] = r;
          z[i] = go ? min(max(zi - rest, low), high) : here ? zi : z[i];
          more[i] = go ? next : more[i];
          y[i] = go ? b.J[i] * flow_stress(e + next) : y[i];
          f0[i] = go ? min(old + born, 0.999) : f0[i];
          chord[i] = way;
          open[i] = go ? 1.0 : 0.0;
          busy += open[i];
        }
      }
      // large steps: in what is left y and nucleation stay as they are
      if (busy > 0.0) bracket(b, mt, qt, f0, y, open, z, chord, end, 1e-13);

      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const bool yields = active[i] > 0.0;
        const Guess g = guess(z[i], mt[i], qt[i], f0[i], y[i]);
        const double q = min(g.q, qt[i]), fs = effective(g.f);
        const bool fails = yields && !(fs < limit);
        history[EPLASTIC][i] += yields ? more[i] : 0.0;
        history[POROSITY][i] = yields ? g.f : history[POROSITY][i];
        history[FAILED][i] = yields ? (fails ? 1.0 : min(q1 * fs, 1.0 - 1e-15))
                                    : history[FAILED][i];
        s.shear[i] = yields ? (fails ? 0.0 : q / (3.0 * G)) : s.shear[i];
        const double v = fails ? max(mt[i] / K, 0.0) : g.v;
        s.flow[i] = yields ? v : s.flow[i];
        s.volume[i] = yields ? mt[i] / K - v : s.volume[i];
      }
    }

   private:
    /** z at which S vanishes, between no volume flow (S < 0) and no mean stress (S > 0), until
     *  |S| < close y, and the inverse slope there: false position (Illinois method) with bisections. */
    MPM_INLINE void bracket(const Batch &b, const double *mt, const double *qt, const double *f0,
                            const double *y, const double *active, double *z, double *chord,
                            double *end, double close) const
    {
      alignas(64) double za[BATCH], zb[BATCH], Sa[BATCH], Sb[BATCH], side[BATCH], open[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double far = -expm1(-mt[i] / K) / f0[i] + exp(-mt[i] / K);    // all volume flows
        za[i] = 0.0;
        zb[i] = log(min(max(far, 1e-280), (1.0 - 1e-9) / f0[i]));
        end[i] = zb[i];
        Sa[i] = guess(za[i], mt[i], qt[i], f0[i], y[i]).S;
        Sb[i] = guess(zb[i], mt[i], qt[i], f0[i], y[i]).S;
        z[i] = active[i] > 0.0 ? za[i] : z[i];
        side[i] = 0.0;
        open[i] = active[i];
      }
      for (int iteration = 0; iteration < 60; iteration++) {
        double busy = 0.0;
        const bool halve = iteration % 4 == 3;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const double span = Sb[i] - Sa[i], cut = span > 0.0 ? -Sa[i] / span : 0.5;
          const double t = halve || !(cut > 0.0 && cut < 1.0) ? 0.5 : cut;
          const double next = za[i] + t * (zb[i] - za[i]);
          const double S = guess(next, mt[i], qt[i], f0[i], y[i]).S;
          const bool here = open[i] > 0.0, low = S < 0.0;
          const double repeat = (low ? -1.0 : 1.0) == side[i] ? 0.5 : 1.0;
          const bool go =
              here && max(S, -S) > close * y[i] && max(zb[i] - za[i], za[i] - zb[i]) > 1e-14;
          Sa[i] = low ? S : repeat * Sa[i];
          Sb[i] = low ? repeat * Sb[i] : S;
          za[i] = low ? next : za[i];
          zb[i] = low ? zb[i] : next;
          side[i] = low ? -1.0 : 1.0;
          z[i] = here ? next : z[i];
          open[i] = go ? 1.0 : 0.0;
          busy += open[i];
        }
        if (busy == 0.0) break;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double d = 1e-6 * end[i], up = z[i] + d;
        const double S = guess(z[i], mt[i], qt[i], f0[i], y[i]).S;
        const double S1 = guess(up, mt[i], qt[i], f0[i], y[i]).S;
        chord[i] = S1 != S ? (up - z[i]) / (S1 - S) : 0.0;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

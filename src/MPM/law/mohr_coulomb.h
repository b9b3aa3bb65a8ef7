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

  /** Ordered stresses of a batch: trial stresses s1, s2, s3, and their changes c1, c2, c3 by the
   *  return. */
  struct OrderedStates {
    alignas(64) double s1[BATCH], s2[BATCH], s3[BATCH], c1[BATCH], c2[BATCH], c3[BATCH];
    alignas(64) double at_apex[BATCH];    ///< 1 or 0
    alignas(64) double more[BATCH];       ///< increment of the equivalent plastic strain
    alignas(64) double open[BATCH];       ///< 1: still to return, or 0
  };

  /** sin(phi) and c cos(phi), and their derivatives by the plastic strain. */
  struct MohrCoulombStrength {
    double sp, cc, dsp, dcc;
  };

  /** Stresses on the surface after the return, and their derivatives by the plastic strain on which
   *  the strength depends. */
  struct MohrCoulombReturn {
    double s1, s2, s3, d1, d2, d3;
    double at_apex;    ///< 1 or 0
  };

  /** Mohr-Coulomb surface s1 - s3 + (s1 + s3) sin(phi) = 2 c cos(phi) with non-associated flow, and
   *  the return to its plane, to one of the two edges, or to the apex (E.A. de Souza Neto, D.
   *  Peric, D.R.J. Owen, Computational Methods for Plasticity, 2008, boxes 8.4 to 8.7). */
  struct MohrCoulombSurface {
    double K, G, sin_psi;

    /** Left side minus right side; s1, s3: largest and smallest stress. */
    MPM_INLINE double excess(double s1, double s3, const MohrCoulombStrength &f) const
    {
      return s1 - s3 + (s1 + s3) * f.sp - 2.0 * f.cc;
    }
    /** Derivative of excess() by the plastic strain. */
    MPM_INLINE double slope(double s1, double s3, const MohrCoulombStrength &f) const
    {
      return (s1 + s3) * f.dsp - 2.0 * f.dcc;
    }

    /** Excess per multiplier of the plane. */
    MPM_INLINE double stiffness(double sp) const
    {
      return 4.0 * G + ((4.0 / 3.0) * G + 4.0 * K) * sin_psi * sp;
    }

    /** Projects a trial state t outside the surface onto it. Derivatives are computed only with
     *  SLOPES. */
    template <bool SLOPES>
    MPM_INLINE MohrCoulombReturn project(const Ordered &t, const MohrCoulombStrength &f) const
    {
      const double st = sin_psi, ss = f.sp * st;
      // change of the three stresses per multiplier of the main plane; for the other two planes it
      // is the same with stresses exchanged
      const double d1 = -2.0 * G * (1.0 + (1.0 / 3.0) * st) - 2.0 * K * st;
      const double d2 = ((4.0 / 3.0) * G - 2.0 * K) * st;
      const double d3 = 2.0 * G * (1.0 - (1.0 / 3.0) * st) - 2.0 * K * st;
      const double a = stiffness(f.sp), main = excess(t.s1, t.s3, f);

      // right: s2 = s3, with the plane of s1 and s2; left: s1 = s2, with that of s2 and s3
      const double right = (1.0 - st) * t.s1 - 2.0 * t.s2 + (1.0 + st) * t.s3;
      const double upper = right > 0.0 ? t.s1 : t.s2, lower = right > 0.0 ? t.s2 : t.s3;
      const double other = excess(upper, lower, f);
      const double b = right > 0.0 ? 2.0 * G * (1.0 + f.sp + st - (1.0 / 3.0) * ss) + 4.0 * K * ss
                                   : 2.0 * G * (1.0 - f.sp - st - (1.0 / 3.0) * ss) + 4.0 * K * ss;
      const double b1 = right > 0.0 ? d1 : d2, b2 = right > 0.0 ? d3 : d1;
      const double b3 = right > 0.0 ? d2 : d3;
      const double det = (a - b) * (a + b), inv = 1.0 / (a * det);

      // conditions are the sign of a number, because combinations of comparisons do not vectorize
      const double m = main * det * inv;
      const double p1 = t.s1 + d1 * m, p2 = t.s2 + d2 * m, p3 = t.s3 + d3 * m;
      const double plane = min(p1 - p2, p2 - p3);
      const double ma = (a * main - b * other) * (a * inv), mb = (a * other - b * main) * (a * inv);
      const double e1 = t.s1 + d1 * ma + b1 * mb, e2 = t.s2 + d2 * ma + b2 * mb;
      const double e3 = t.s3 + d3 * ma + b3 * mb;
      const double pair = 0.5 * (e2 + (right > 0.0 ? e3 : e1));    // equal except for round-off
      const double k1 = right > 0.0 ? e1 : pair, k3 = right > 0.0 ? pair : e3;
      // the difference of k1 and k3 from the surface, because that of the stresses may be round-off
      const double edge = 2.0 * f.cc - (k1 + k3) * f.sp, tip = f.cc / f.sp;
      const double c1 = edge >= 0.0 ? k1 : tip, c2 = edge >= 0.0 ? pair : tip;
      const double c3 = edge >= 0.0 ? k3 : tip;
      MohrCoulombReturn r;
      r.at_apex = max(plane, edge) >= 0.0 ? 0.0 : 1.0;
      r.s1 = plane >= 0.0 ? p1 : c1;
      r.s2 = plane >= 0.0 ? p2 : c2;
      r.s3 = plane >= 0.0 ? p3 : c3;
      r.d1 = r.d2 = r.d3 = 0.0;
      if (SLOPES) {
        const double da = ((4.0 / 3.0) * G + 4.0 * K) * st * f.dsp;
        const double db0 = (-(2.0 / 3.0) * G + 4.0 * K) * st;
        const double db = (right > 0.0 ? db0 + 2.0 * G : db0 - 2.0 * G) * f.dsp;
        const double dmain = slope(t.s1, t.s3, f), dother = slope(upper, lower, f);
        const double dm = (dmain - m * da) * det * inv;
        const double ra = dmain - da * ma - db * mb, rb = dother - db * ma - da * mb;
        const double dma = (a * ra - b * rb) * (a * inv), dmb = (a * rb - b * ra) * (a * inv);
        const double de1 = d1 * dma + b1 * dmb, de2 = d2 * dma + b2 * dmb;
        const double de3 = d3 * dma + b3 * dmb, dtip = (f.dcc - tip * f.dsp) / f.sp;
        const double x1 = edge >= 0.0 ? de1 : dtip, x2 = edge >= 0.0 ? de2 : dtip;
        const double x3 = edge >= 0.0 ? de3 : dtip;
        r.d1 = plane >= 0.0 ? d1 * dm : x1;
        r.d2 = plane >= 0.0 ? d2 * dm : x2;
        r.d3 = plane >= 0.0 ? d3 * dm : x3;
      }
      return r;
    }

    /** Equivalent plastic strain of a change of stress: sqrt(2/3 e:e) of the deviator e of the
     *  strain. */
    MPM_INLINE double strain(double a, double b, double c) const
    {
      const double ab = a - b, bc = b - c, ca = c - a;
      return std::sqrt((2.0 / 9.0) * (ab * ab + bc * bc + ca * ca)) / (2.0 * G);
    }
    /** Derivative of strain(); x, y, z: derivatives of a, b, c. */
    MPM_INLINE double strain_slope(double a, double b, double c, double x, double y, double z,
                                   double strain) const
    {
      const double sum = (a - b) * (x - y) + (b - c) * (y - z) + (c - a) * (z - x);
      return (2.0 / 9.0) * sum / (4.0 * G * G * max(strain, 1e-300));
    }
    /** Strain per multiplier of a return to the plane. */
    MPM_INLINE double strain_per_multiplier() const
    {
      return (2.0 / 3.0) * std::sqrt(3.0 + sin_psi * sin_psi);
    }
  };

  /** Elastic-plastic solid with the Mohr-Coulomb surface in Kirchhoff stress (see
   *  MohrCoulombSurface) and Hencky elasticity. Cohesion and friction angle may soften with the
   *  equivalent plastic strain e (A. Yerro, E.E. Alonso, N.M. Pinyol, Comput. Geotech. 74 (2016)
   *  26):
   *
   *    c = CR + (C - CR) exp(-RATE e),  phi = PHIR + (PHI - PHIR) exp(-RATE e)
   *
   *  at the end of the step. The increment of e caused by the return is a function of the increment
   *  used for the strength; its fixed point is the solution. Newton's method finds it, in one or
   *  two steps if the strength changes little in a step. The secant method (Illinois variant)
   *  within a bracket finds the remaining points. Both work on a batch at a time. Volume strain at
   *  the apex is stored as "gap", see close_gap(). */
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

    /** Lower limit of sin(phi). A material without any strength then bears no tension. */
    static constexpr double LEAST = 1e-15;
    double phi, c, cr, phir, rate, sin_phi, c_cos_phi;
    MohrCoulombSurface surface;

    explicit LawMohrCoulomb(const LawParameters &p) :
        BulkAndShear(p), phi(p.value[PHI] * DEGREES), c(p.value[COHESION]), cr(p.value[RESIDUAL_C]),
        phir(p.value[RESIDUAL_PHI] * DEGREES), rate(p.value[RATE]),
        sin_phi(max(std::sin(phi), LEAST)),
        c_cos_phi(c * std::cos(phi)), surface{K, G, std::sin(p.value[PSI] * DEGREES)}
    {
    }

    /** Strength at a plastic strain. */
    template <bool SOFT> MPM_INLINE MohrCoulombStrength strength(double e) const
    {
      if (!SOFT) return {sin_phi, c_cos_phi, 0.0, 0.0};
      const double left = exp(-rate * e), angle = (phi - phir) * left, more = (c - cr) * left;
      const double sine = sin(phir + angle), sp = max(sine, LEAST);
      const double cos_phi = std::sqrt((1.0 - sp) * (1.0 + sp)), cohesion = cr + more;
      return {sp, cohesion * cos_phi, sine > LEAST ? -rate * angle * cos_phi : 0.0,
              rate * (cohesion * sp * angle - cos_phi * more)};
    }

    MPM_INLINE bool stay_elastic(Batch &b, History history, const Tensors &strain) const
    {
      return rate > 0.0 ? stay_below<true>(b, history + ELASTIC_STRAIN_ROWS, strain)
                        : stay_below<false>(b, history + ELASTIC_STRAIN_ROWS, strain);
    }

    /** Checks against the inner cone of the surface, which is enough for most points, and computes
     *  the elastic stresses. */
    template <bool SOFT>
    MPM_INLINE bool stay_below(Batch &b, History history, const Tensors &strain) const
    {
      double outside = 0.0;
      MPM_SIMD_SUM(outside)
      for (int i = 0; i < b.n; i++) {
        const Sym e = load_rows(strain.row, i), s = (2.0 * G) * deviator(e);
        const double v = trace(e);
        const MohrCoulombStrength f = strength<SOFT>(history[0][i]);
        const double most = std::sqrt((2.0 + (2.0 / 3.0) * f.sp * f.sp) * norm2(s));
        const double below = f.cc + f.cc - 2.0 * K * v * f.sp - (1.0 + 1e-10) * most;
        const double closes = history[1][i] > 0.0 ? -v : 0.0;
        outside += min(below, -closes) >= 0.0 ? 0.0 : 1.0;
        store_stress(b, i, (1.0 / b.J[i]) * add_diagonal(s, K * v));
      }
      return outside == 0.0;
    }

    MPM_INLINE void map(Batch &b, History history, PrincipalStates &s) const
    {
      if (rate > 0.0)
        return_to_surface<true>(b, history, s);
      else
        return_to_surface<false>(b, history, s);
    }

    /** Returns the points of a batch to the surface; SOFT: with softening. */
    template <bool SOFT>
    MPM_INLINE void return_to_surface(Batch &b, History history, PrincipalStates &s) const
    {
      OrderedStates o;
      const double per_plane = surface.strain_per_multiplier();
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
        const double s1 = max(max(x, y), z), s3 = min(min(x, y), z);
        o.s1[i] = s1;
        o.s3[i] = s3;
        o.s2[i] = max(min(x, y), min(max(x, y), z));
        const MohrCoulombStrength f = strength<SOFT>(history[0][i]);
        const double excess = surface.excess(s1, s3, f), plastic = excess > 0.0 ? 1.0 : 0.0;
        // first guess: return to the plane, with the slope of the strength at the start
        const double a = surface.stiffness(f.sp), slope = surface.slope(s1, s3, f);
        const double guess = per_plane * excess / max(a - per_plane * slope, 0.5 * a);
        o.more[i] = SOFT ? plastic * guess : 0.0;
        o.c1[i] = o.c2[i] = o.c3[i] = o.at_apex[i] = 0.0;
        o.open[i] = plastic;
        yielding += plastic;
      }
      if (yielding == 0.0) {    // the rest would not change a bit
        for (int i = 0; i < b.n; i++) s.work[i] = 0.0;
        return;
      }
      if (SOFT) {
        yielding = newton(b, history, o);
        if (yielding > 0.0) search(b, history, o);
      }
      if (yielding > 0.0) {
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const Ordered t = {o.s1[i], o.s2[i], o.s3[i]};
          const MohrCoulombStrength f = strength<SOFT>(history[0][i] + o.more[i]);
          const MohrCoulombReturn r = surface.project<false>(t, f);
          const double a = r.s1 - t.s1, c = r.s2 - t.s2, d = r.s3 - t.s3, here = o.open[i];
          o.c1[i] = here > 0.0 ? a : o.c1[i];
          o.c2[i] = here > 0.0 ? c : o.c2[i];
          o.c3[i] = here > 0.0 ? d : o.c3[i];
          o.at_apex[i] = here > 0.0 ? r.at_apex : o.at_apex[i];
          o.more[i] = here > 0.0 ? surface.strain(a, c, d) : o.more[i];
        }
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double p_old = s.before[0][i] + s.before[1][i] + s.before[2][i];
        const double mean = (1.0 / 3.0) * (o.c1[i] + o.c2[i] + o.c3[i]);
        double by_old = 0.0, by_new = 0.0;
        for (int a = 0; a < 3; a++) {
          // stresses go back to their axes: equal trial stresses stay equal
          const double x = s.tau[a][i];
          const double lower = x == o.s3[i] ? o.c3[i] : o.c2[i];
          const double change = x == o.s1[i] ? o.c1[i] : lower;
          const double tau = x + change, flow = (mean - change) / (2.0 * G) - mean / (3.0 * K);
          by_old += ((K - (2.0 / 3.0) * G) * p_old + 2.0 * G * s.before[a][i]) * flow;
          by_new += tau * flow;
          s.strain[a][i] -= flow;
          s.tau[a][i] = tau;
        }
        s.work[i] = plastic_work(by_old, by_new);
        b.plastic[i] = o.more[i];
        history[0][i] += o.more[i];
        history[1][i] -= o.at_apex[i] * min(mean, 0.0) / K;
      }
    }

    /** Solves (strain of the return with D) = D for the increment D of the plastic strain that
     *  determines the strength, from a guess and without a safeguard. The change of D in the last
     *  step is added to the stresses through their derivatives. Closes the points that are solved;
     *  returns the number of the others. */
    MPM_INLINE double newton(const Batch &b, History history, OrderedStates &o) const
    {
      constexpr int MAX_ITERATIONS = 6;
      double busy = 1.0;
      for (int iteration = 0; iteration < MAX_ITERATIONS && busy > 0.0; iteration++) {
        busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const Ordered t = {o.s1[i], o.s2[i], o.s3[i]};
          const double d = o.more[i], here = o.open[i];
          const MohrCoulombStrength f = strength<true>(history[0][i] + d);
          const MohrCoulombReturn r = surface.project<true>(t, f);
          const double c1 = r.s1 - t.s1, c2 = r.s2 - t.s2, c3 = r.s3 - t.s3;
          const double made = surface.strain(c1, c2, c3);
          const double steep = surface.strain_slope(c1, c2, c3, r.d1, r.d2, r.d3, made);
          const double step = (made - d) / (1.0 - steep), size = max(step, -step);
          // bound of the relative change of the derivatives
          const double bend = 4.0 * rate * size;
          const double rest = bend * size * max(max(r.d1, -r.d1), max(r.d3, -r.d3));
          const double off = max(rest - 1e-14 * G * (1.0 - steep) * made, bend - 0.1);
          const double left = off <= 0.0 ? 0.0 : here;    // not a number: stays open
          o.c1[i] = here > 0.0 ? c1 + step * r.d1 : o.c1[i];
          o.c2[i] = here > 0.0 ? c2 + step * r.d2 : o.c2[i];
          o.c3[i] = here > 0.0 ? c3 + step * r.d3 : o.c3[i];
          o.at_apex[i] = here > 0.0 ? r.at_apex : o.at_apex[i];
          o.more[i] = here > 0.0 ? max(d + step, 0.0) : d;
          o.open[i] = left;
          busy += left;
        }
      }
      return busy;
    }

    /** The safe method for the points that are still open. */
    [[gnu::noinline]] void search(const Batch &b, History history, OrderedStates &o) const
    {
      constexpr int MAX_ITERATIONS = 60;
      alignas(64) double low[BATCH], high[BATCH], r_low[BATCH], r_high[BATCH], side[BATCH];
      alignas(64) double open[BATCH], d0[BATCH], d1[BATCH], r0[BATCH],
          r1[BATCH];    // of the last two iterations
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        // strain of the return minus D: not negative at the low end and not positive at the high
        // end, where there is no strength in shear
        low[i] = r_low[i] = 0.0;
        high[i] = o.open[i] * surface.strain(o.s1[i], o.s2[i], o.s3[i]);
        r_high[i] = -high[i];
        side[i] = d0[i] = d1[i] = r0[i] = r1[i] = 0.0;
        open[i] = high[i] > 0.0 ? 1.0 : 0.0;
        o.more[i] = o.open[i] > 0.0 ? 0.0 : o.more[i];
      }
      for (int iteration = 0; iteration < MAX_ITERATIONS; iteration++) {
        // D = 0 comes first, then a step of the fixed-point iteration, which comes close, then the
        // secant of the last two iterations, or (every fourth iteration, and if that secant lies
        // outside) the secant of the bracket
        const double late = iteration > 1 ? 1.0 : 0.0, free = iteration % 4 != 1 ? 1.0 : 0.0;
        double busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const Ordered t = {o.s1[i], o.s2[i], o.s3[i]};
          const double gap = r_low[i] - r_high[i], width = high[i] - low[i];
          const double chord = low[i] + width * r_low[i] / max(gap, 1e-300);
          const double quick = d1[i] + r1[i] * (d1[i] - d0[i]) / (r0[i] - r1[i]);
          const double fits = free * min(quick - low[i], high[i] - quick);
          const double secant = fits > 0.0 ? quick : chord;
          const double first = min(r_low[i], high[i]), d = first + late * (secant - first);
          const MohrCoulombStrength f = strength<true>(history[0][i] + d);
          const MohrCoulombReturn p = surface.project<false>(t, f);
          const double r = surface.strain(p.s1 - t.s1, p.s2 - t.s2, p.s3 - t.s3) - d;
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
          o.more[i] = on > 0.0 ? d : o.more[i];
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

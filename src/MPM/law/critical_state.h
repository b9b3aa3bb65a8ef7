/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_CRITICAL_STATE_H
#define MPM_LAW_CRITICAL_STATE_H

#include "law/elastoplastic.h"

namespace MPM_NS::law {
namespace {

  /** State before plastic flow: pressure and hardening variable, or functions of these. */
  struct CriticalTrial {
    double p, hard;
  };

  /** Pressure and size of the yield surface after the plastic volume strain x (positive in
   *  compression). */
  struct Compressed {
    double p, dp;      ///< pressure, and its derivative with respect to x
    double p0, dp0;    ///< compressive strength, and its derivative
  };

  /** Bracket of the plastic volume strain x. strong: positive if some strength is left at the
   *  end. */
  struct CriticalBracket {
    double start, end, strong;
  };

  /** Return mapping of laws with an elliptic yield surface in pressure p and equivalent stress q,
   *  which hardens with plastic volume strain, and associated flow (K.H. Roscoe, J.B. Burland, in:
   *  Engineering Plasticity, Cambridge, 1968, p. 535; with tensile strength BETA p0 as in J. Gaume
   *  et al., Nat. Commun. 9 (2018) 3047):
   *
   *    q^2 (1 + 2 BETA) + M^2 (p + BETA p0) (p - p0) <= 0
   *
   *  With center p_m, half axes a and b = a M_b, M_b = M/sqrt(1 + 2 BETA), and u = (p - p_m)/a, the
   *  direction of flow is (x, shear) = (u, sqrt(1 - u^2)/M_b). For a plastic volume strain x the
   *  flow rule gives q/b = s = q_trial u/(b u + 3 G x/M_b), and the yield surface is s^2 + u^2 = 1.
   *  x lies between 0 and the value at which u = 0. Because 1 - 1/sqrt(s^2 + u^2) is nearly linear
   *  in x, Newton's iteration within a bracket finds the root, a batch at a time.
   *
   *  Law provides, in addition to Base:
   *    G, Mb (M_b), beta
   *    begin(history, i, volume)
   *    compress(trial, x)
   *    bracket(trial, p - p_m, p_m), the bracket of x
   *    finish(history, i, trial, x, increment of shear)
   */
  template <class Law, class Base> struct CriticalStateReturn : Base {
    using Base::Base;
    static constexpr int MAX_ITERATIONS = 100;

    MPM_INLINE void solve(Batch &b, History history, InvariantStates &t) const
    {
      const Law &law = static_cast<const Law &>(*this);
      const double G = law.G, Mb = law.Mb, beta = law.beta, c = 3.0 * G / Mb;
      const double center = 0.5 * (1.0 - beta), half_axis = 0.5 * (1.0 + beta);
      alignas(64) double x[BATCH], from[BATCH], to[BATCH], sign[BATCH], p[BATCH], hard[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const CriticalTrial state = law.begin(history, i, t.volume[i]);
        p[i] = state.p;
        hard[i] = state.hard;
      }
      double yielding = 0.0, searched = 0.0;
      MPM_SIMD_SUM(yielding, searched)
      for (int i = 0; i < b.n; i++) {
        const CriticalTrial state = {p[i], hard[i]};
        const Compressed k = law.compress(state, 0.0);
        const double a = half_axis * k.p0, q = 3.0 * G * t.shear[i];
        const double up = k.p + beta * k.p0, down = k.p0 - k.p;    // a (1 + u), a (1 - u)
        // conditions are signs of numbers, because combinations of comparisons do not vectorize
        const double out = max(q * q - Mb * Mb * up * down, max(-up, -down));
        const double plastic = out > 0.0 ? 1.0 : 0.0, above = k.p - center * k.p0;
        const CriticalBracket at = law.bracket(state, above, center * k.p0);
        // without strength, x goes to the end, where the stress vanishes, unless the point yields
        // in shear alone
        const double search = min(out, max(at.strong, min(-above, up))) > 0.0 ? 1.0 : 0.0;
        // where the surface has zero size at the start, the first guess lies inside the bracket
        const double guess = a > 0.0 ? at.start : 0.5 * (at.start + at.end);
        const double first = search > 0.0 ? guess : at.end;
        sign[i] = above > 0.0 ? 1.0 : -1.0;
        x[i] = plastic > 0.0 ? first : 0.0;
        from[i] = at.start;
        to[i] = search > 0.0 ? at.end : at.start;
        yielding += plastic;
        searched += search;
      }
      if (yielding == 0.0) return;
      for (int iteration = 0; searched > 0.0 && iteration < MAX_ITERATIONS; iteration++) {
        double busy = 0.0;
        MPM_SIMD_SUM(busy)
        for (int i = 0; i < b.n; i++) {
          const CriticalTrial state = {p[i], hard[i]};
          const Compressed k = law.compress(state, x[i]);
          const double a = max(half_axis * k.p0, 1e-100), inv = 1.0 / a;
          const double q = 3.0 * G * t.shear[i];
          const double u = (k.p - center * k.p0) * inv;
          const double du = (k.dp - (center + u * half_axis) * k.dp0) * inv;
          const double bb = Mb * a, db = Mb * half_axis * k.dp0;
          const double D = bb * u + c * x[i];
          const double invD = D == 0.0 ? 0.0 : 1.0 / D;
          const double s = q * u * invD;
          const double ds = q * (du * c * x[i] - u * (u * db + c)) * invD * invD;
          const double w = (k.p + beta * k.p0) * inv * ((k.p0 - k.p) * inv);    // 1 - u^2
          const double f = s * s - w, df = 2.0 * (s * ds + u * du);
          const double root = std::sqrt(max(1.0 + f, 1e-300));
          const double inside = u * sign[i], here = x[i], first = from[i], last = to[i];
          const double r = inside > 0.0 ? f / (root * (1.0 + root)) : -1.0;
          const double slope = 0.5 * df / (root * root * root);
          const double active = first != last ? 1.0 : 0.0;
          const double side = active * r, new_last = side > 0.0 ? last : here;
          const double begin = side > 0.0 ? here : first, end = active > 0.0 ? new_last : last;
          const double newton = here - r / slope, half = 0.5 * (begin + end);
          const double low = min(begin, end), high = max(begin, end);
          const double fits = min(inside, min(newton - low, high - newton));
          const double next = fits > 0.0 ? newton : half;
          const double size = s * s + max(w, -w);
          const double more = max(f, -f) - 1e-14 * size;
          const double go = inside > 0.0 ? more : 1.0, on = go <= 0.0 ? 0.0 : active;
          const double step = on > 0.0 ? next - here : 0.0, moved = here + step;
          x[i] = moved;
          from[i] = begin;
          to[i] = go <= 0.0 ? begin : end;
          busy += step * step > 1e-30 * moved * moved ? 1.0 : 0.0;
        }
        if (busy == 0.0) break;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const CriticalTrial state = {p[i], hard[i]};
        const Compressed k = law.compress(state, x[i]);
        const double yield = Mb * std::sqrt(max((k.p + beta * k.p0) * (k.p0 - k.p), 0.0));
        const double shear = min(yield / (3.0 * G), t.shear[i]);
        law.finish(history, i, state, x[i], t.shear[i] - shear);
        t.volume[i] += x[i];
        t.shear[i] = shear;
        t.flow[i] = -x[i];
      }
    }
  };

  enum { CC_G, CC_M, CC_LAMBDA, CC_KAPPA, CC_E0, CC_P0, CC_PC };

  /** Modified Cam-Clay (K.H. Roscoe, J.B. Burland, in: Engineering Plasticity, Cambridge, 1968, p.
   *  535) at finite strain (R.I. Borja, C. Tamagnini, Comput. Methods Appl. Mech. Eng. 155 (1998)
   *  73): in Kirchhoff stress, with the elastic volume strain v and kappa* = KAPPA/(1 + E0),
   *
   *    q^2/M^2 + p (p - pc) <= 0,  p = P0 exp(-v/kappa*),  q = 3 G shear,
   *    ln pc grows by plastic compression over (lambda* - kappa*)
   *
   *  so that lines of isotropic compression and swelling are straight in ln J over ln p (R.
   *  Butterfield, Geotechnique 29 (1979) 469). P0 is the pressure of the material when it is
   *  created; its energy in this state is defined as zero. Flow is associated, see
   *  CriticalStateReturn. */
  struct LawCamClay : CriticalStateReturn<LawCamClay, InvariantReturn<LawCamClay>> {
    static constexpr const char *name = "camclay";
    static constexpr const char *meaning = "modified Cam-Clay";
    static constexpr Parameter parameters[] = {
        SHEAR_MODULUS,
        {"", "M", "1", POSITIVE, REQUIRED, "slope of the critical state line"},
        {"", "LAMBDA", "1", POSITIVE, REQUIRED,
         "slope of the compression line, void ratio over ln p"},
        {"", "KAPPA", "1", POSITIVE, REQUIRED, "slope of swelling lines"},
        {"", "E0", "1", NOT_NEGATIVE, REQUIRED, "initial void ratio", OF_NEW_POINTS},
        {"", "P0", "pressure", POSITIVE, REQUIRED, "initial pressure", OF_NEW_POINTS},
        {"", "PC", "pressure", POSITIVE, REQUIRED, "initial preconsolidation pressure",
         OF_NEW_POINTS}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"preconsolidation", CC_PC, "pressure", "preconsolidation pressure (Kirchhoff)"}};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[CC_LAMBDA] <= p.value[CC_KAPPA] ? "LAMBDA must be above KAPPA"
          : p.value[CC_PC] < p.value[CC_P0]          ? "PC must not be below P0"
                                                     : nullptr;
    }

    double G, Mb, inv_kappa, inv_plastic, swell, P0, logP0;
    static constexpr double beta = 0.0, LARGEST = 300.0;    // largest exponent

    explicit LawCamClay(const LawParameters &p) :
        G(p.value[CC_G]), Mb(p.value[CC_M]), inv_kappa((1.0 + p.value[CC_E0]) / p.value[CC_KAPPA]),
        inv_plastic((1.0 + p.value[CC_E0]) / (p.value[CC_LAMBDA] - p.value[CC_KAPPA])),
        swell(1.0 / (inv_kappa + inv_plastic)), P0(p.value[CC_P0]), logP0(std::log(p.value[CC_P0]))
    {
    }

    /** -v/kappa*, limited to the largest exponent. */
    MPM_INLINE double growth(double v) const { return max(min(-v * inv_kappa, LARGEST), -LARGEST); }
    MPM_INLINE double pressure(double v) const { return P0 * exp(growth(v)); }
    MPM_INLINE double volume_energy(double v) const { return P0 / inv_kappa * expm1(growth(v)); }

    /** Logarithms of p and pc. */
    MPM_INLINE CriticalTrial begin(History history, int i, double v) const
    {
      return {logP0 - v * inv_kappa, log(max(history[1][i], 1e-250))};
    }

    MPM_INLINE Compressed compress(const CriticalTrial &s, double x) const
    {
      const double p = exp(max(min(s.p - x * inv_kappa, LARGEST), -LARGEST));
      const double pc = exp(max(min(s.hard + x * inv_plastic, LARGEST), -LARGEST));
      return {p, -inv_kappa * p, pc, inv_plastic * pc};
    }

    /** p = pc/2 where x (1/kappa* + 1/(lambda* - kappa*)) = ln(2 p/pc). */
    MPM_INLINE CriticalBracket bracket(const CriticalTrial &s, double, double) const
    {
      return {0.0, swell * (s.p - s.hard + 0.69314718055994530942), 1.0};
    }

    MPM_INLINE void finish(History history, int i, const CriticalTrial &s, double x, double D) const
    {
      history[0][i] += D;
      history[1][i] = x == 0.0 ? history[1][i]
                               : exp(max(min(s.hard + x * inv_plastic, LARGEST), -LARGEST));
    }

    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const LawCamClay law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double pressure = law.pressure(0.5 * log1p(elastic_volume(load_rows(history, i))));
        const Sym s = deviator(load_stress(b, i));
        k[i] += hencky_modulus(pressure * law.inv_kappa, law.G, b.J[i],
                               add_diagonal(s, -pressure / b.J[i]));
      }
    }
  };

  /** Cohesive Cam-Clay (J. Gaume, T. Gast, J. Teran, A. van Herwijnen, C. Jiang, Nat. Commun. 9
   *  (2018) 3047; J. Wolper et al., ACM Trans. Graph. 38 (2019) 119): elliptic yield surface with
   *  tensile strength BETA p0 and hardening
   *
   *    p0 = K sinh(XI max(-alpha, 0)),  alpha = ln of the plastic volume ratio
   *
   *  Here the elasticity is Hencky's, and the flow is associated with an implicit return, see
   *  CriticalStateReturn. For alpha >= 0 no strength is left: broken material is free of stress
   *  until it has been compressed again to alpha < 0. */
  struct LawNacc : CriticalStateReturn<LawNacc, HenckyInvariantReturn<LawNacc>> {
    static constexpr const char *name = "nacc";
    static constexpr const char *meaning = "cohesive Cam-Clay: snow, wet sand, soft rock";
    enum { E, NU, M, BETA, XI, ALPHA };
    static constexpr Parameter parameters[] = {
        YOUNGS_MODULUS,
        POISSONS_RATIO,
        {"", "M", "1", POSITIVE, REQUIRED, "slope of the critical state line for BETA = 0"},
        {"", "BETA", "1", FRACTION, REQUIRED, "tensile strength over compressive strength"},
        {"", "XI", "1", POSITIVE, REQUIRED, "hardening factor"},
        {"",
         "ALPHA0",
         "1",
         {-UNBOUNDED, 0.0, true},
         REQUIRED,
         "initial value of alpha",
         OF_NEW_POINTS}};
    static constexpr HistoryDeclaration history[] = {
        MPM_ELASTIC_STRAIN_HISTORY,
        PLASTIC_STRAIN,
        {"alpha", ALPHA, "1", "logarithm of the plastic volume ratio"}};

    double Mb, beta, xi;

    explicit LawNacc(const LawParameters &p) :
        CriticalStateReturn(p), Mb(p.value[M] / std::sqrt(1.0 + 2.0 * p.value[BETA])),
        beta(p.value[BETA]), xi(p.value[XI])
    {
    }

    MPM_INLINE CriticalTrial begin(History history, int i, double v) const
    {
      return {-K * v, history[1][i]};
    }

    MPM_INLINE Compressed compress(const CriticalTrial &s, double x) const
    {
      const double z = min(xi * max(x - s.hard, 0.0), 200.0);
      const double grow = expm1(z), shrink = -grow / (1.0 + grow);    // exp(z) - 1, exp(-z) - 1
      return {s.p - K * x, -K, 0.5 * K * (grow - shrink),
              z > 0.0 ? 0.5 * K * xi * (2.0 + grow + shrink) : 0.0};
    }

    /** The pressure vanishes at x = p/K, the strength at x = alpha. */
    MPM_INLINE CriticalBracket bracket(const CriticalTrial &s, double above, double center) const
    {
      const double strong = s.p - K * s.hard;
      return {min(above, strong) > 0.0 ? max(s.hard, 0.0) : 0.0,
              max(above, -strong) > 0.0 ? s.p / K : max((s.p - center) / K, s.hard), strong};
    }

    MPM_INLINE void finish(History history, int i, const CriticalTrial &s, double x, double D) const
    {
      history[0][i] += D;
      history[1][i] = s.hard - x;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_H
#define MPM_LAW_DAMAGE_H

#include "law/kinematics.h"
#include "math/random.h"

namespace MPM_NS::law {
namespace {

// Parameters that all damages have at the end, and history variables that all have at the
// beginning, in this order. These are macros because lists of declarations cannot be joined.
#define MPM_AFTER_PARAMETERS after_none, after_pressure, after_friction
#define MPM_DAMAGE_HISTORY damaged, shear_energy, rest_energy

  constexpr Parameter after_none = {"after none", "NONE", FLAG,
                                    FRACTION,     0.0,    "failed points bear no stress at all"};
  constexpr Parameter after_pressure = {
      "after pressure", "PRESSURE", FLAG, FRACTION, 0.0, "failed points bear pressure (default)"};
  constexpr Parameter after_friction = {
      "after friction", "MU", "1",
      NOT_NEGATIVE,     0.0,  "failed points bear pressure and friction, coefficient"};

  enum { DAMAGED, SHEAR_ENERGY, REST_ENERGY, NDAMAGE };
  constexpr HistoryDeclaration damaged = {"damage", ZERO, "1",
                                          "share of the stress that is lost, 1: failed"};
  constexpr HistoryDeclaration shear_energy = {
      "shear_energy", ZERO, "pressure", "energy of the undamaged stress deviator, per volume"};
  constexpr HistoryDeclaration rest_energy = {
      "rest_energy", ZERO, "pressure",
      "energy of the equation of state without tension, per volume"};

  /** Undamaged stress at the end of a step, from which a law computes the damage. */
  struct Intact {
    Sym s;          ///< deviator
    double mean;    ///< mean stress of the equation of state, positive in tension
  };

  /** Isotropic damage D (L.M. Kachanov 1958; J. Lemaitre, A Course on Damage Mechanics, 1996, ch.
   *  1) on top of any equation of state and strength, which see the undamaged stress. It reduces
   *  the deviator, and the mean stress in tension only:
   *
   *    sigma = (1 - D) s + [(1 - D) max(m, 0) + min(m, 0)] I,   s, m: undamaged
   *    w = (1 - D) (w_s + w_t) + w_0
   *
   *  w_s is the energy of the strength, w_0 that of the equation of state when its pressure was
   *  last zero or positive, and w_t the rest of the energy of the equation of state. The released
   *  energy (w_s + w_t) dD is counted as the work FRACTURE; plastic work and its heat are 1 - D
   *  times those of the undamaged material. Viscous stress is not damaged. A failed point (D = 1)
   *  bears shear only by friction, sqrt(s:s/2) <= MU p.
   *
   *  Sums over a step use mean values of its two ends: the energy balance has an error of third
   *  order in a step, and none for a step at whose end everything is lost.
   *
   *  Law provides:
   *    Law(parameters, batch)
   *    grow(batch, history, i, intact): returns the new D of a point that has not failed (a value
   *      below the old D means no change) and updates the law's own history
   *    AFTER, an enum value: the index of after_none in its parameters
   */
  template <class Law> struct ScalarDamage : LawDefaults {
    static constexpr bool uses_F = false;

    static void prepare(const LawParameters &, Batch &b, History history)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double D = history[DAMAGED][i];
        const double kept = D < 1.0 ? 1.0 - D : 1.0, scale = 1.0 / kept;
        const Sym all = load_stress(b, i);
        const double mean = (1.0 / 3.0) * trace(all);
        store_stress(b, i, add_diagonal(scale * deviator(all), mean > 0.0 ? scale * mean : mean));
        b.kept[i] = kept;
      }
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Law law(p, b);
      // conditions are numbers, 0 or 1, because combinations of comparisons do not vectorize
      const double none = p.value[Law::AFTER] > 0.0 ? 1.0 : 0.0;
      const double friction = p.value[Law::AFTER + 2];
      double less_plastic = 0.0, less_heat = 0.0, fracture = 0.0;
      MPM_SIMD_SUM(less_plastic, less_heat, fracture)
      for (int i = 0; i < b.n; i++) {
        const Sym all = load_stress(b, i);
        const double total = (1.0 / 3.0) * trace(all);
        const Intact intact = {add_diagonal(all, -total), total - b.viscous_mean[i]};
        const double mean = intact.mean, ws = b.shear_energy[i], we = b.volume_energy[i];

        const double D0 = history[DAMAGED][i];
        const double grown = law.grow(b, history, i, intact);
        const double D = D0 < 1.0 ? min(max(grown, D0), 1.0) : 1.0;
        const double had_failed = D0 < 1.0 ? 0.0 : 1.0, failed = D < 1.0 ? 0.0 : 1.0;

        // deviator: share kept before and after, and share of its energy kept after
        const double tau = std::sqrt(0.5 * norm2(intact.s)), hold = friction * max(-mean, 0.0);
        const double slip = tau > hold ? hold / tau : 1.0;
        const double kept0 = b.kept[i], kept = failed > 0.0 ? slip : 1.0 - D;
        const double stored = failed > 0.0 ? slip * slip : 1.0 - D;
        // the energy of a strength that is kept as a sum can fall below zero by its rounding
        const double between = std::sqrt(max(ws * history[SHEAR_ENERGY][i], 0.0));
        const double shear = (kept - stored) * ws + (kept0 - kept) * between;
        history[SHEAR_ENERGY][i] = failed > 0.0 ? stored * ws : ws;

        // tension: its energy at the start follows from that at the end and the work of the step
        const double rest = mean > 0.0 ? min(history[REST_ENERGY][i], we) : we;
        const double wt = we - rest, dJ = b.J[i] - b.Jold[i];
        const double tension = (D - D0) * max(wt - 0.5 * max(mean, 0.0) * dJ, 0.0);
        history[REST_ENERGY][i] = rest;

        // additional loss if a failed point bears no stress at all
        const double gone = none * failed, now = gone * (1.0 - had_failed);
        const double pressed = now > 0.0 ? rest - 0.5 * min(mean, 0.0) * dJ : 0.0;
        const double press = gone > 0.0 ? 0.0 : min(mean, 0.0);
        store_stress(
            b, i,
            add_diagonal(kept * intact.s, (1.0 - D) * max(mean, 0.0) + press + b.viscous_mean[i]));
        history[DAMAGED][i] = D;
        fracture += (shear + tension + pressed) * b.vol0[i];
        b.heat[i] += p.broken * (shear + tension + pressed);

        const double work = b.plastic_work[i],
                     share = had_failed > 0.0 ? kept : 0.5 * (kept0 + kept);
        less_plastic += (1.0 - share) * work * b.vol0[i];
        less_heat += (1.0 - p.chi * share) * work * b.vol0[i];
        b.heat[i] += p.chi * (share - kept0) * work;
      }
      b.work[PLASTIC] -= less_plastic;
      b.work[HEAT] += p.broken * fracture - less_heat;
      b.work[FRACTURE] += fracture;
    }

    static void energy(const LawParameters &p, const Batch &b, History history, double *w)
    {
      const bool none = p.value[Law::AFTER] > 0.0;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double D = history[DAMAGED][i];
        const double wt = max(w[i] - history[REST_ENERGY][i], 0.0);
        const double damaged = w[i] - D * wt + (D < 1.0 ? 1.0 - D : 1.0) * history[SHEAR_ENERGY][i];
        w[i] = none && !(D < 1.0) ? 0.0 : damaged;
      }
    }
  };

  MPM_INLINE double principal(const Intact &intact)
  {
    return intact.mean + largest_eigenvalue(intact.s);
  }

  /** Brittle failure at the largest principal stress (W.J.M. Rankine 1858), either at once or with
   *  the fracture energy GC of a crack that is one cell wide (Z.P. Bazant, B.H. Oh, Mater. Struct.
   *  16 (1983) 155). Let w be the energy w_s + w_t that damage may release (see ScalarDamage), and
   *  w_1 its value when sigma_1 reaches the strength. After that the stress drops linearly with the
   *  largest r = sqrt(w/w_1) reached in tension:
   *
   *    D = 1 - (r_f - r) / [r (r_f - 1)],   r_f = GC / (h w_1)
   *
   *  The work of damage, integral of w dD, is w_1 r_f = GC/h in any state of stress. A point with
   *  w_1 > GC/h would spend more than that; instead it fails at once when it has stored GC/h.
   *
   *  With weibull, the strengths of points of reference volume V have the distribution function
   *
   *    P = 1 - exp[-(V/V0) (sigma/SIGMA)^M]    (W. Weibull, J. Appl. Mech. 18 (1951) 293)
   */
  struct DamageRankine : ScalarDamage<DamageRankine> {
    static constexpr const char *name = "rankine";
    static constexpr const char *meaning = "brittle failure at the largest principal stress";
    enum { STRENGTH_, GC, M, V0, SEED, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "SIGMA", "pressure", POSITIVE, REQUIRED, "tensile strength, with weibull its scale"},
        {"soften energy", "GC", "pressure*length", POSITIVE, 0.0, "fracture energy per area"},
        {"weibull", "M", "1", POSITIVE, 0.0, "Weibull modulus", OF_NEW_POINTS},
        {"weibull", "V0", "volume", POSITIVE, 1.0, "reference volume (in 2d per thickness)",
         OF_NEW_POINTS},
        {"weibull", "SEED", "1", NOT_NEGATIVE, 0.0, "seed of the random numbers", OF_NEW_POINTS},
        MPM_AFTER_PARAMETERS};
    static constexpr HistoryDeclaration history[] = {
        MPM_DAMAGE_HISTORY,
        {"random", ZERO, "1", "uniform random number of the point, if weibull is given"},
        {"opening", ZERO, "1", "largest r since the crack began"},
        {"ductility", ZERO, "1", "r at which all stress is lost, 0: no crack yet"}};
    enum { RANDOM = NDAMAGE, OPENING, DUCTILITY, NRANKINE };
    /** random is stored only with weibull or GC, opening and ductility only with GC. */
    static constexpr int nhistory(const LawParameters &p)
    {
      return p.value[GC] > 0.0 ? NRANKINE : p.value[M] > 0.0 ? OPENING : RANDOM;
    }

    /** Draws the random number of a point from its position, independent of the number of
     *  processes. */
    static void initialize(const LawParameters &p, const double *x, double *history)
    {
      if (!(p.value[M] > 0.0)) return;
      uint64_t state = RANDOM_STEP;
      for (const double value : {p.value[SEED], x[0], x[1], x[2]})    // adding 0.0 makes 0 of -0
        state = mix_bits(state + to_bits(value + 0.0) + RANDOM_STEP);
      history[RANDOM] = (static_cast<double>(state >> 11) + 0.5) * 0x1p-53;
    }

    double strength, inv_m, inv_v0, crack;
    bool scatter;

    DamageRankine(const LawParameters &p, const Batch &b) :
        strength(p.value[STRENGTH_]), inv_m(p.value[M] > 0.0 ? 1.0 / p.value[M] : 1.0),
        inv_v0(1.0 / p.value[V0]), crack(p.value[GC] / b.h), scatter(p.value[M] > 0.0)
    {
    }

    MPM_INLINE double inverse_strength(const Batch &b, History history, int i) const
    {
      if (!scatter) return 1.0 / strength;
      const double weakness = b.vol0[i] * inv_v0 / -log(1.0 - history[RANDOM][i]);
      return min(pow(weakness, inv_m), 1e60) / strength;
    }

    MPM_INLINE double grow(const Batch &b, History history, int i, const Intact &intact) const
    {
      const double r = principal(intact) * inverse_strength(b, history, i);
      if (!(crack > 0.0)) return r >= 1.0 ? 1.0 : 0.0;

      const double tension = max(b.volume_energy[i] - history[REST_ENERGY][i], 0.0);
      const double w = b.shear_energy[i] + (intact.mean > 0.0 ? tension : 0.0);
      const double ratio = crack * r * r / max(w, 1e-300);    // r_f if the crack began now
      const double least = ratio > 1.0 ? r - 1.0 : min(r - 1e-300, w - crack);
      const double begins = least >= 0.0 ? 1.0 : 0.0;
      const double old = history[DUCTILITY][i];
      const double rf = old > 0.0 ? old : begins > 0.0 ? max(ratio, 1.0) : 0.0;
      const double now = r > 0.0 ? std::sqrt(w * rf / crack) : 0.0;
      const double largest = max(history[OPENING][i], now);
      history[DUCTILITY][i] = rf;
      history[OPENING][i] = largest;
      const double softened = 1.0 - (rf - largest) / max(largest * (rf - 1.0), 1e-300);
      const double lost = max(largest - rf, 1.0 - rf) >= 0.0 ? 1.0 : softened;
      return rf > 0.0 ? lost : 0.0;
    }
  };

  /** Dynamic fragmentation (D.E. Grady, M.E. Kipp, Int. J. Rock Mech. Min. Sci. 17 (1980) 147): K
   *  e^M flaws per volume grow with velocity CG at the tensile strain e = sigma_1/E,
   *
   *    d(D^(1/3))/dt = (M + 3)/3 alpha^(1/3) e^(M/3),
   *    alpha = 8 pi CG^3 K / [(M + 1) (M + 2) (M + 3)]
   *
   *  At constant strain rate D = alpha rate^M t^(M+3), and fragments have the size 6 CG t/(M + 2),
   *  where t is the time under tension until D = 1 (also H.J. Melosh, E.V. Ryan, E. Asphaug, J.
   *  Geophys. Res. 97 (1992) 14735). The strain is that at the end of the step. */
  struct DamageGradyKipp : ScalarDamage<DamageGradyKipp> {
    static constexpr const char *name = "grady/kipp";
    static constexpr const char *meaning = "dynamic fragmentation by growing flaws";
    enum { K, M, CG, E, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "K", "1/volume", POSITIVE, REQUIRED, "flaws per volume at unit strain"},
        {"", "M", "1", POSITIVE, REQUIRED, "exponent of the strain"},
        {"", "CG", "velocity", POSITIVE, REQUIRED, "velocity at which cracks grow"},
        YOUNGS_MODULUS,
        MPM_AFTER_PARAMETERS};
    static constexpr HistoryDeclaration history[] = {
        MPM_DAMAGE_HISTORY,
        {"fragment", ZERO, "length", "size of fragments, final when the point has failed"}};
    enum { FRAGMENT = NDAMAGE };

    double inv_E, exponent, log_growth, size;

    DamageGradyKipp(const LawParameters &p, const Batch &b) :
        inv_E(1.0 / p.value[E]), exponent(p.value[M] / 3.0)
    {
      // logarithms, because K may be as large as 1e60
      const double m = p.value[M], pi = 3.14159265358979323846;
      const double alpha = log(8.0 * pi / ((m + 1.0) * (m + 2.0) * (m + 3.0))) + log(p.value[K]) +
          3.0 * log(p.value[CG]);
      log_growth = (1.0 / 3.0) * alpha + log(max((m + 3.0) / 3.0 * b.dt, 1e-300));
      size = 6.0 * p.value[CG] * b.dt / (m + 2.0);
    }

    MPM_INLINE double grow(const Batch &, History history, int i, const Intact &intact) const
    {
      const double strain = max(principal(intact), 0.0) * inv_E, D = history[DAMAGED][i];
      const double more = exp(log_growth + exponent * log(max(strain, 1e-300)));
      const double side = pow(D, 1.0 / 3.0) + (strain > 0.0 ? min(more, 1.0) : 0.0);
      history[FRAGMENT][i] += min(strain, 1.0 - D) > 0.0 ? size : 0.0;
      return side * side * side;
    }
  };

  // A ductile law measures the used share of its ductility (row USED of its history, 1: all). The
  // effect of this share on the stress is the same for all ductile laws.

  constexpr Parameter soften_from = {
      "soften from",    "START", "1",
      {0.0, 1.0, true}, 1.0,     "used share of the ductility at which the stress begins to drop"};
  constexpr Parameter soften_energy = {
      "soften energy", "GC", "pressure*length",
      POSITIVE,        0.0,  "plastic work per area of crack, after all ductility is used"};
  enum { USED = NDAMAGE };
  constexpr HistoryDeclaration ductility_used = {"used", ZERO, "1",
                                                 "share of the ductility that is used"};

  /** Stress as a function of the used share of the ductility. The stress is lost at once when the
   *  share reaches 1; or linearly from START on; or, from 1 on, linearly with the plastic work of
   *  one cell, which adds up to GC per area. The crack is one cell wide whatever the spacing h of
   *  the nodes (A. Hillerborg, M. Modeer, P.-E. Petersson, Cem. Concr. Res. 6 (1976) 773; Z.P.
   *  Bazant, B.H. Oh, Mater. Struct. 16 (1983) 155). */
  struct Ductile {
    double start, inv_range, per_work;

    Ductile(const LawParameters &p, const Batch &b, int soften) :
        start(p.value[soften]), inv_range(1.0 / max(1.0 - start, 1e-12)),
        per_work(p.value[soften + 1] > 0.0 ? 0.5 * b.h / p.value[soften + 1] : 0.0)
    {
    }

    /** Adds more to the used share of the ductility; returns the damage. */
    MPM_INLINE double use(const Batch &b, History history, int i, double more) const
    {
      const double used = min(history[USED][i] + more, 1.0);
      history[USED][i] = used;
      const double direct = used >= 1.0 ? 1.0 : (used - start) * inv_range;
      const double by_work = used >= 1.0 ? history[DAMAGED][i] + per_work * b.plastic_work[i] : 0.0;
      return per_work > 0.0 ? by_work : direct;
    }
  };

  /** Johnson-Cook failure (G.R. Johnson, W.H. Cook, Eng. Fract. Mech. 21 (1985) 31, eq. 7, 8):
   *
   *    used = sum de/e_f
   *    e_f = [D1 + D2 exp(D3 m/q)] [1 + D4 ln max(rate/EPSDOT0, 1)] [1 + D5 T*]
   *
   *  with plastic strain e, undamaged mean stress m and equivalent stress q. The triaxiality m/q is
   *  limited to 1.5, where according to the citation the formula ends. If e_f is below EFMIN, EFMIN
   *  is used in its place; fits with D1 < 0 reach values of zero or below at high triaxiality. */
  struct DamageJohnsonCook : ScalarDamage<DamageJohnsonCook> {
    static constexpr const char *name = "johnson/cook";
    static constexpr const char *meaning = "Johnson-Cook failure strain";
    enum { D1, D2, D3, D4, RATE, D5, MELT, REF, EFMIN, SOFTEN, ENERGY, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "D1", "1", ANY_NUMBER, REQUIRED, "failure strain at high triaxiality"},
        {"", "D2", "1", NOT_NEGATIVE, REQUIRED, "part of it that depends on the triaxiality"},
        {"", "D3", "1", ANY_NUMBER, REQUIRED, "exponent of the triaxiality, commonly negative"},
        {"rate", "D4", "1", ANY_NUMBER, 0.0, "coefficient of the logarithm of the rate"},
        {"rate", "EPSDOT0", "1/time", POSITIVE, 1.0, "reference plastic strain rate"},
        {"temperature", "D5", "1", ANY_NUMBER, 0.0, "coefficient of the temperature"},
        {"temperature", "TMELT", "temperature", ANY_NUMBER, 1.0, "melting temperature"},
        {"temperature", "TREF", "temperature", ANY_NUMBER, 0.0, "reference temperature"},
        {"minimum", "EFMIN", "1", NOT_NEGATIVE, 0.0, "lower limit of the failure strain"},
        soften_from,
        soften_energy,
        MPM_AFTER_PARAMETERS};
    static constexpr HistoryDeclaration history[] = {MPM_DAMAGE_HISTORY, ductility_used};
    static constexpr bool needs_temperature(const LawParameters &p) { return p.value[D5] != 0.0; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MELT] > p.value[REF] ? nullptr : "TMELT must be above TREF";
    }

    double d1, d2, d3, d4, inv_rate, d5, Tref, inv_range, efmin;
    const double *temperature;
    Ductile ductile;

    DamageJohnsonCook(const LawParameters &p, const Batch &b) :
        d1(p.value[D1]), d2(p.value[D2]), d3(p.value[D3]), d4(p.value[D4]),
        inv_rate(1.0 / max(p.value[RATE] * b.dt, 1e-300)), d5(p.value[D5]), Tref(p.value[REF]),
        inv_range(1.0 / (p.value[MELT] - p.value[REF])), efmin(max(p.value[EFMIN], 1e-300)),
        temperature(d5 != 0.0 ? MPM_NS::temperature(p, b) : b.plastic), ductile(p, b, SOFTEN)
    {
    }

    MPM_INLINE double grow(const Batch &b, History history, int i, const Intact &intact) const
    {
      const double de = b.plastic[i];
      const double triaxiality = min(intact.mean / max(equivalent(intact.s), 1e-300), 1.5);
      const double fast = 1.0 + d4 * log(max(de * inv_rate, 1.0));
      const double T = min(max((temperature[i] - Tref) * inv_range, 0.0), 1.0);
      const double limit = (d1 + d2 * exp(min(d3 * triaxiality, 300.0))) * fast * (1.0 + d5 * T);
      return ductile.use(b, history, i, de / max(limit, efmin));
    }
  };

  /** Ductile failure by the work of the largest principal stress (M.G. Cockcroft, D.J. Latham,
   *  J. Inst. Met. 96 (1968) 33):
   *
   *    used = (1/WC) sum max(sigma_1, 0) de,   e: equivalent plastic strain */
  struct DamageCockcroftLatham : ScalarDamage<DamageCockcroftLatham> {
    static constexpr const char *name = "cockcroft/latham";
    static constexpr const char *meaning = "plastic work of the largest principal stress";
    enum { WC, SOFTEN, ENERGY, AFTER };
    static constexpr Parameter parameters[] = {
        {"", "WC", "pressure", POSITIVE, REQUIRED, "critical work per volume"},
        soften_from,
        soften_energy,
        MPM_AFTER_PARAMETERS};
    static constexpr HistoryDeclaration history[] = {MPM_DAMAGE_HISTORY, ductility_used};

    double inv_work;
    Ductile ductile;

    DamageCockcroftLatham(const LawParameters &p, const Batch &b) :
        inv_work(1.0 / p.value[WC]), ductile(p, b, SOFTEN)
    {
    }

    MPM_INLINE double grow(const Batch &b, History history, int i, const Intact &intact) const
    {
      return ductile.use(b, history, i, inv_work * max(principal(intact), 0.0) * b.plastic[i]);
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

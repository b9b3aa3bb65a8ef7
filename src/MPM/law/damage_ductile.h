/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_DUCTILE_H
#define MPM_LAW_DAMAGE_DUCTILE_H

#include "law/damage.h"

namespace MPM_NS::law {
namespace {

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

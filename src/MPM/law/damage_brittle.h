/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_BRITTLE_H
#define MPM_LAW_DAMAGE_BRITTLE_H

#include "law/damage.h"
#include "math/random.h"

namespace MPM_NS::law {
namespace {

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

    /** Inverse of the stress at which point i fails. */
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

}    // namespace
}    // namespace MPM_NS::law
#endif

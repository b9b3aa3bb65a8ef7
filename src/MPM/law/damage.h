/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_DAMAGE_H
#define MPM_LAW_DAMAGE_H

#include "law/kinematics.h"

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
   *    below the old D means no change) and updates the law's own history AFTER, an enum value: the
   *    index of after_none in its parameters
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
        const double shear =
            (kept - stored) * ws + (kept0 - kept) * std::sqrt(ws * history[SHEAR_ENERGY][i]);
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

  /** Largest principal undamaged stress. */
  MPM_INLINE double principal(const Intact &intact)
  {
    return intact.mean + largest_eigenvalue(intact.s);
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

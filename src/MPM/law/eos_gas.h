/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_GAS_H
#define MPM_LAW_EOS_GAS_H

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** Loops of a gas with p + PINF = (GAMMA - 1) e / J, e = E - PINF J, where E is the internal
   *  energy per reference volume; PINF = 0 for an ideal gas.
   *
   *  Along an isentrope e ~ J^(1 - GAMMA), which the update follows exactly for any increment of J,
   *  so that no expansion makes the energy negative. Half of the heat of a step comes before and
   *  half of it after the change of volume: second order. */
  struct Gas {
    double g;    ///< GAMMA - 1
    double pinf;
    double pmin;    ///< lowest pressure, which does the work when it acts

    enum { ENERGY, HEATED };

    /** Energy of the reference state at a pressure. */
    double energy_at(double pressure) const { return (pressure + pinf) / g + pinf; }

    MPM_INLINE double pressure(double J, double E) const
    {
      return max(g * (E - pinf * J) / J - pinf, pmin);
    }

    void update(Batch &b, History history) const
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], half = 0.5 * b.heat[i];
        const double Eold = history[ENERGY][i];
        const double ratio = exp(g * log(Jold / J));
        const double e = (Eold - pinf * Jold + half) * ratio + half;
        const double p = g * e / J - pinf;
        const double mean = 0.5 * (pressure(Jold, Eold) + pmin);
        const bool below = p < pmin;
        subtract_pressure(b, i, below ? pmin : p);
        history[ENERGY][i] = below ? Eold - mean * (J - Jold) + 2.0 * half : e + pinf * J;
        history[HEATED][i] += b.heat[i];
      }
    }

    /** -J^2 dp/dJ = GAMMA (p + PINF) J */
    void modulus(const Batch &b, History history, double *k) const
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i];
        k[i] += (g + 1.0) * (pressure(J, history[ENERGY][i]) + pinf) * J;
      }
    }

    /** Internal energy less the dissipated part, which counts as plastic and viscous work. */
    static void energy(const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[ENERGY][i] - history[HEATED][i];
    }
  };

  /** Ideal gas of constant specific heats, p = (GAMMA - 1) density e (for instance E.F. Toro,
   *  Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, ch. 1). The pressure is
   *  absolute and positive from the start: points have the stress -P0 before the first step. */
  struct EosIdealGas : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "ideal/gas";
    static constexpr const char *meaning = "ideal gas";
    enum { GAMMA, P0, E0 };
    static constexpr Parameter parameters[] = {
        {"", "GAMMA", "1", {1.0, UNBOUNDED, false}, REQUIRED, "ratio of specific heats"},
        {"pressure", "P0", "pressure", POSITIVE, 0.0, "initial pressure"},
        {"energy", "E0", "energy/mass", POSITIVE, 0.0, "initial internal energy per mass"}};
    static constexpr HistoryDeclaration history[] = {
        {"energy", INITIALIZED, "pressure", "internal energy per reference volume"},
        {"heat", ZERO, "pressure", "part of it that was dissipated"}};
    static constexpr int nhistory(const LawParameters &) { return 2; }
    static constexpr const char *check(const LawParameters &p)
    {
      return (p.value[P0] > 0.0) == (p.value[E0] > 0.0)
          ? "give the initial state by either 'pressure P0' or 'energy E0'"
          : nullptr;
    }
    static Gas gas(const LawParameters &p) { return {p.value[GAMMA] - 1.0, 0.0, 0.0}; }
    static void initialize(const LawParameters &p, const double *, double *history)
    {
      history[0] = gas(p).energy_at(p.value[P0]) + p.heat_density * p.value[E0];
    }

    static void update(const LawParameters &p, Batch &b, History h) { gas(p).update(b, h); }
    static void modulus(const LawParameters &p, const Batch &b, History h, double *k)
    {
      gas(p).modulus(b, h, k);
    }
    static void energy(const LawParameters &, const Batch &b, History h, double *w)
    {
      Gas::energy(b, h, w);
    }
  };

  /** Stiffened gas p = (GAMMA - 1) density e - GAMMA PINF for liquids and solids under high
   *  pressure (F.H. Harlow, A.A. Amsden, LA-4700, 1971; R. Menikoff, B.J. Plohr, Rev. Mod. Phys. 61
   *  (1989) 75). */
  struct EosStiffenedGas : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "stiffened/gas";
    static constexpr const char *meaning = "stiffened gas";
    enum { GAMMA, PINF, P0, CUTOFF };
    static constexpr Parameter parameters[] = {
        {"", "GAMMA", "1", {1.0, UNBOUNDED, false}, REQUIRED, "ratio of specific heats"},
        {"", "PINF", "pressure", POSITIVE, REQUIRED, "pressure that is added"},
        {"pressure", "P0", "pressure", NOT_NEGATIVE, 0.0, "initial pressure"},
        {"cutoff", "PMIN", "pressure", TENSION, -UNBOUNDED, "lowest pressure, not positive"}};
    static constexpr HistoryDeclaration history[] = {
        {"energy", INITIALIZED, "pressure", "internal energy per reference volume"},
        {"heat", ZERO, "pressure", "part of it that was dissipated"}};
    static constexpr int nhistory(const LawParameters &) { return 2; }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[CUTOFF] != -UNBOUNDED && p.value[CUTOFF] <= -p.value[PINF]
          ? "PMIN is never reached: pressure stays above -PINF; leave cutoff out or raise PMIN"
          : nullptr;
    }
    static Gas gas(const LawParameters &p)
    {
      return {p.value[GAMMA] - 1.0, p.value[PINF], max(p.value[CUTOFF], -p.value[PINF])};
    }
    static void initialize(const LawParameters &p, const double *, double *history)
    {
      history[0] = gas(p).energy_at(p.value[P0]);
    }

    static void update(const LawParameters &p, Batch &b, History h) { gas(p).update(b, h); }
    static void modulus(const LawParameters &p, const Batch &b, History h, double *k)
    {
      gas(p).modulus(b, h, k);
    }
    static void energy(const LawParameters &, const Batch &b, History h, double *w)
    {
      Gas::energy(b, h, w);
    }
  };

}    // namespace
}    // namespace MPM_NS::law

#endif

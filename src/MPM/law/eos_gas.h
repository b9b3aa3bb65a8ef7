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

  /** Gas with p + PINF = (GAMMA - 1) e / J, e = E - PINF J, where E is the internal energy per
   *  reference volume; PINF = 0 for an ideal gas. */
  struct Gas {
    double g;    ///< GAMMA - 1
    double pinf;
    double pmin;    ///< lowest pressure, which does the work when it acts

    /** Energy of the reference state at a pressure. */
    double energy_at(double pressure) const { return (pressure + pinf) / g + pinf; }

    MPM_INLINE double pressure(double J, double E) const
    {
      return max(g * (E - pinf * J) / J - pinf, pmin);
    }
  };

  /** Loops of a gas. Law has: gas(parameters).
   *
   *  Along an isentrope e ~ J^(1 - GAMMA), which the update follows exactly for any increment of J,
   *  so that no expansion makes the energy negative. Half of the heat of a step comes before and
   *  half of it after the change of volume: second order. */
  template <class Law> struct GasLaw : InternalEnergy {
    static constexpr HistoryDeclaration history[] = {internal_energy(INITIALIZED), dissipated};

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Gas gas = Law::gas(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], half = 0.5 * b.heat[i];
        const double Eold = history[ENERGY][i];
        const double ratio = exp(gas.g * log(Jold / J));
        const double e = (Eold - gas.pinf * Jold + half) * ratio + half;
        const double end = gas.g * e / J - gas.pinf;
        const double mean = 0.5 * (gas.pressure(Jold, Eold) + gas.pmin);
        const bool below = end < gas.pmin;
        subtract_pressure(b, i, below ? gas.pmin : end);
        history[ENERGY][i] = below ? Eold - mean * (J - Jold) + 2.0 * half : e + gas.pinf * J;
        history[HEATED][i] += b.heat[i];
      }
    }

    /** -J^2 dp/dJ = GAMMA (p + PINF) J */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const Gas gas = Law::gas(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i];
        k[i] += (gas.g + 1.0) * (gas.pressure(J, history[ENERGY][i]) + gas.pinf) * J;
      }
    }
  };

  /** Ideal gas of constant specific heats, p = (GAMMA - 1) density e (for instance E.F. Toro,
   *  Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, ch. 1). The pressure is
   *  absolute and positive from the start: points have the stress -P0 before the first step. */
  struct EosIdealGas : GasLaw<EosIdealGas> {
    static constexpr const char *name = "ideal/gas";
    static constexpr const char *meaning = "ideal gas";
    enum { GAMMA, P0, E0 };
    static constexpr Parameter parameters[] = {
        {"", "GAMMA", "1", {1.0, UNBOUNDED, false}, REQUIRED, "ratio of specific heats"},
        {"pressure", "P0", "pressure", POSITIVE, 0.0, "initial pressure"},
        {"energy", "E0", "energy/mass", POSITIVE, 0.0, "initial internal energy per mass"}};
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
  };

  /** Stiffened gas p = (GAMMA - 1) density e - GAMMA PINF for liquids and solids under high
   *  pressure (F.H. Harlow, A.A. Amsden, LA-4700, 1971; R. Menikoff, B.J. Plohr, Rev. Mod. Phys. 61
   *  (1989) 75). */
  struct EosStiffenedGas : GasLaw<EosStiffenedGas> {
    static constexpr const char *name = "stiffened/gas";
    static constexpr const char *meaning = "stiffened gas";
    enum { GAMMA, PINF, P0, CUTOFF };
    static constexpr Parameter parameters[] = {
        {"", "GAMMA", "1", {1.0, UNBOUNDED, false}, REQUIRED, "ratio of specific heats"},
        {"", "PINF", "pressure", POSITIVE, REQUIRED, "pressure that is added"},
        {"pressure", "P0", "pressure", NOT_NEGATIVE, 0.0, "initial pressure"},
        cutoff};
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
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

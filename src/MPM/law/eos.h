/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_H
#define MPM_LAW_EOS_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Loops of an equation of state p(J) without energy.
   *
   *  Eos has, with the volume ratio J = density_0 / density: pressure(J), bulk(J) = -J^2 dp/dJ (the
   *  reference density times the square of the sound speed), stored(J) = -integral of p dJ from 1.
   */
  template <class Eos> struct Barotropic : LawDefaults {
    static constexpr bool uses_F = false;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) subtract_pressure(b, i, eos.pressure(b.J[i]));
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) k[i] += eos.bulk(b.J[i]);
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const Eos eos(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += eos.stored(b.J[i]);
    }
  };

  /** What equations of state with an internal energy E share: its declaration (initial: as in
   *  HistoryDeclaration) and that of its dissipated part. */
  constexpr HistoryDeclaration internal_energy(int initial)
  {
    return {"energy", initial, "pressure", "internal energy per reference volume"};
  }
  constexpr HistoryDeclaration dissipated = {"heat", ZERO, "pressure",
                                             "part of it that was dissipated"};
  struct InternalEnergy : LawDefaults {
    static constexpr bool uses_F = false;
    enum { ENERGY, HEATED };

    /** Internal energy less the dissipated part, which counts as plastic and viscous work. */
    static void energy(const LawParameters &, const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[ENERGY][i] - history[HEATED][i];
    }
  };

  constexpr Range TENSION{-UNBOUNDED, 0.0, true};
  constexpr Parameter cutoff = {"cutoff", "PMIN",     "pressure",
                                TENSION,  -UNBOUNDED, "lowest pressure, not positive"};
  constexpr Parameter spall = {"spall",
                               "PSPALL",
                               "pressure",
                               TENSION,
                               -UNBOUNDED,
                               "pressure, not positive, below which the material breaks and "
                               "bears no tension any more"};
  constexpr HistoryDeclaration spalled = {"spalled", ZERO, "1", "1 when the material has broken"};

  /** Tension that an equation of state bears: all, a pressure of at least PMIN, or, when the
   *  pressure has fallen below PMIN once, none (spall). */
  struct Tension {
    double pmin;     ///< lowest pressure, minus infinity without limit
    double after;    ///< pressure instead of one that would be lower
    bool spall;

    /** Values of the options; minus infinity: not given. */
    Tension(double cutoff, double spalls) :
        pmin(max(cutoff, spalls)), after(spalls > -UNBOUNDED ? 0.0 : cutoff),
        spall(spalls > -UNBOUNDED)
    {
    }
  };

  /** Loops of an equation of state p = cold(J) + gamma(J) E, with the internal energy E per
   *  reference volume.
   *
   *  Eos has cold(J), gamma(J), slope(J, E) = -dp/dJ at constant E, and least, the smallest
   *  density_0 (sound speed)^2 that is believed; CUTOFF and SPALL are the indices of its parameters
   *  cutoff and spall. E follows from
   *
   *    E = E_old - (p_old + p)/2 (J - J_old) + heat
   *
   *  solved together with p: second order in the strain increment, and one step from the reference
   *  state lands exactly on the Hugoniot. A pressure that is limited by tension is the one that
   *  does the work. History: internal_energy, dissipated, and with spall a mark, spalled. */
  template <class Eos> struct LinearInEnergy : InternalEnergy {
    enum { SPALLED = HEATED + 1 };
    static constexpr int nhistory(const LawParameters &p)
    {
      return p.value[Eos::SPALL] > -UNBOUNDED ? 3 : 2;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[Eos::CUTOFF] > -UNBOUNDED && p.value[Eos::SPALL] > -UNBOUNDED
          ? "cutoff and spall exclude each other: leave one of them out"
          : nullptr;
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Eos eos(p);
      const Tension tension(p.value[Eos::CUTOFF], p.value[Eos::SPALL]);
      if (tension.spall)
        loop<true>(eos, tension, b, history);
      else
        loop<false>(eos, tension, b, history);
    }

    /** Isentropic -J^2 dp/dJ = J^2 (-(dp/dJ)_E + gamma p). */
    static void modulus(const LawParameters &p, const Batch &b, History history, double *k)
    {
      const Eos eos(p);
      const Tension tension(p.value[Eos::CUTOFF], p.value[Eos::SPALL]);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], E = history[ENERGY][i], gamma = eos.gamma(J);
        const double pressure = max(eos.cold(J) + gamma * E, tension.pmin);
        k[i] += max(J * J * (eos.slope(J, E) + gamma * pressure), eos.least);
      }
    }

   private:
    template <bool SPALL>
    static MPM_INLINE void loop(const Eos &eos, const Tension &tension, Batch &b, History history)
    {
      const double after = tension.after;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], dJ = J - Jold;
        const double Eold = history[ENERGY][i];
        const bool broken = SPALL && history[SPALLED][i] > 0.0;
        const double lowest = broken ? 0.0 : tension.pmin;
        const double cold = eos.cold(J), gamma = eos.gamma(J);
        const double pold = max(eos.cold(Jold) + eos.gamma(Jold) * Eold, lowest);
        const double E =
            (Eold - 0.5 * (pold + cold) * dJ + b.heat[i]) / max(1.0 + 0.5 * gamma * dJ, 0.1);
        const double pressure = cold + gamma * E;
        const bool below = pressure < lowest;
        subtract_pressure(b, i, below ? after : pressure);
        history[ENERGY][i] = below ? Eold - 0.5 * (pold + after) * dJ + b.heat[i] : E;
        history[HEATED][i] += b.heat[i];
        if (SPALL) history[SPALLED][i] = broken || below ? 1.0 : 0.0;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

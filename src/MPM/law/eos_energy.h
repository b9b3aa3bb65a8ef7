/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_ENERGY_H
#define MPM_LAW_EOS_ENERGY_H

// Equations of state with an internal energy.

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** Declaration of the internal energy E; initial: as in HistoryDeclaration. */
  constexpr HistoryDeclaration internal_energy(int initial)
  {
    return {"energy", initial, "pressure", "internal energy per reference volume"};
  }
  constexpr HistoryDeclaration dissipated = {"heat", ZERO, "pressure",
                                             "part of it that was dissipated"};
  struct InternalEnergy : LawDefaults {
    static constexpr bool uses_F = false, expands = true;
    enum { ENERGY, HEATED };

    /** Internal energy without the dissipated part, which is counted as plastic and viscous
     *  work. */
    static void energy(const LawParameters &, const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[ENERGY][i] - history[HEATED][i];
    }
  };

  /** Adds the derivative of -J p to the tangent. by_J, by_heat: derivatives of p with respect to J
   *  and to the heat of the step. */
  inline void add_pressure(const Batch &b, const double *p, const double *by_J,
                           const double *by_heat, Tangent &t)
  {
    for (int k = 0; k < 9; k++) {
      if (t.skips(k)) continue;
      const double volume = k % 4 == 0 ? 1.0 : 0.0;
      const double *const heat = t.heat[k];
      double *const xx = t.stress[0][k], *const yy = t.stress[1][k], *const zz = t.stress[2][k];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i];
        const double change = J * (volume * (p[i] + J * by_J[i]) + by_heat[i] * heat[i]);
        xx[i] -= change;
        yy[i] -= change;
        zz[i] -= change;
      }
    }
  }

  /** Energy at the end of a step whose final pressure is p = cold + gamma E: E = E_old - (p_old +
   *  p)/2 dJ + heat. */
  struct EndOfStep {
    double gamma, dJ, pold,
        limited;    ///< limited: 1 + gamma dJ/2, but at least 0.1 (violent compression)

    /** gamma: at the end of the step; dJ = J - J_old; pold: pressure at the start of the step. */
    MPM_INLINE EndOfStep(double gamma, double dJ, double pold) :
        gamma(gamma), dJ(dJ), pold(pold), limited(max(1.0 + 0.5 * gamma * dJ, 0.1))
    {
    }
    MPM_INLINE double energy(double cold, double Eold, double heat) const
    {
      return (Eold - 0.5 * (pold + cold) * dJ + heat) / limited;
    }
    /** dp/dJ = -slope + gamma dE/dJ with dE/dJ = [-(p_old + p)/2 + slope dJ/2]/limited; slope:
     *  -dp/dJ at constant E. */
    MPM_INLINE double by_J(double p, double slope) const
    {
      return gamma / limited * 0.5 * (slope * dJ - pold - p) - slope;
    }
    MPM_INLINE double by_heat() const { return gamma / limited; }
  };

  // options that limit the tension of an equation of state
  constexpr Parameter limits[] = {
      {"cutoff", "PMIN", "pressure", TENSION, -UNBOUNDED, "lowest pressure, not positive"},
      {"spall", "PSPALL", "pressure", TENSION, -UNBOUNDED,
       "pressure, not positive, below which the material breaks and bears no tension any more"}};
  constexpr Parameter cutoff = limits[0], spall = limits[1];
  constexpr HistoryDeclaration spalled = {"spalled", ZERO, "1", "1 when the material has broken"};

  /** Limit of the tension of an equation of state: no limit; a pressure of at least PMIN; or
   *  (spall) no tension any more once the pressure has fallen below PSPALL. */
  struct Tension {
    double pmin;     ///< lowest pressure; minus infinity: no limit
    double after;    ///< pressure that replaces a lower one
    bool spall;

    /** cutoff, spalls: values of the options; minus infinity: not given. */
    Tension(double cutoff, double spalls) :
        pmin(max(cutoff, spalls)), after(spalls > -UNBOUNDED ? 0.0 : cutoff),
        spall(spalls > -UNBOUNDED)
    {
    }
  };

  /** Kernels of an equation of state p = cold(J) + gamma(J) E, with the internal energy E per
   *  reference volume.
   *
   *  Eos provides:
   *    cold(J), gamma(J)
   *    slope(J, E) = -dp/dJ at constant E
   *    exact_slope(J, E), the exact derivative, only if slope() differs from it
   *    least, the lower limit of density_0 (sound speed)^2
   *    CUTOFF and SPALL, the indices of its parameters cutoff and spall
   *
   *  E follows from
   *
   *    E = E_old - (p_old + p)/2 (J - J_old) + heat
   *
   *  solved together with p. This is of second order in the strain increment, and one step from the
   *  reference state ends exactly on the Hugoniot. If the tension limit changes the pressure, the
   *  limited pressure does the work. History: internal_energy, dissipated, and, with spall, the
   *  flag spalled. */
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

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const Eos eos(p);
      const Tension tension(p.value[Eos::CUTOFF], p.value[Eos::SPALL]);
      alignas(64) double pressure[BATCH], by_J[BATCH], by_heat[BATCH], broken[BATCH];
      for (int i = 0; i < b.n; i++) broken[i] = tension.spall ? history[SPALLED][i] : 0.0;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], dJ = J - Jold, Eold = history[ENERGY][i];
        const double lowest = broken[i] > 0.0 ? 0.0 : tension.pmin;
        const double cold = eos.cold(J), gamma = eos.gamma(J);
        const double pold = max(eos.cold(Jold) + eos.gamma(Jold) * Eold, lowest);
        const EndOfStep step(gamma, dJ, pold);
        const double E = step.energy(cold, Eold, b.heat[i]), end = cold + gamma * E;
        const double flat = end < lowest ? 0.0 : 1.0;
        pressure[i] = end < lowest ? tension.after : end;
        by_J[i] = flat * step.by_J(end, eos.exact_slope(J, E));
        by_heat[i] = flat * step.by_heat();
      }
      update(p, b, history);
      add_pressure(b, pressure, by_J, by_heat, t);
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

    /** -dp/dJ at constant E, for the tangent. */
    MPM_INLINE double exact_slope(double J, double E) const
    {
      return static_cast<const Eos *>(this)->slope(J, E);
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
        const double E = EndOfStep(gamma, dJ, pold).energy(cold, Eold, b.heat[i]);
        const double pressure = cold + gamma * E;
        const bool below = pressure < lowest;
        subtract_pressure(b, i, below ? after : pressure);
        history[ENERGY][i] = below ? Eold - 0.5 * (pold + after) * dJ + b.heat[i] : E;
        history[HEATED][i] += b.heat[i];
        if (SPALL) history[SPALLED][i] = broken || below ? 1.0 : 0.0;
      }
    }
  };

  /** Mie-Gruneisen with the shock Hugoniot U_s = C0 + S u_p (M.H. Rice, R.G. McQueen, J.M. Walsh,
   *  Solid State Physics 6 (1958) 1; M.L. Wilkins, Computer Simulation of Dynamic Phenomena, 1999),
   *  with density * Gruneisen parameter constant. With eta = 1 - J, E the internal energy per
   *  reference volume and K = density_0 C0^2:
   *
   *    compression  p = p_H (1 - GAMMA0 eta / 2) + GAMMA0 E,   p_H = K eta / (1 - S eta)^2
   *    tension      p = K (1/J - 1) + GAMMA0 E
   *
   *  1 - S eta is kept at 0.05 or more, which corresponds to a pressure of hundreds of K. */
  struct EosShock : LinearInEnergy<EosShock> {
    static constexpr const char *name = "shock";
    static constexpr const char *meaning = "Mie-Gruneisen with linear shock Hugoniot";
    enum { C0, S, GAMMA0, CUTOFF, SPALL };
    static constexpr Parameter parameters[] = {
        {"", "C0", "velocity", POSITIVE, REQUIRED, "bulk sound speed at reference density"},
        {"", "S", "1", NOT_NEGATIVE, REQUIRED, "slope dU_s/du_p of the Hugoniot"},
        {"", "GAMMA0", "1", NOT_NEGATIVE, REQUIRED, "Gruneisen parameter at reference density"},
        cutoff,
        spall};
    static constexpr HistoryDeclaration history[] = {internal_energy(ZERO), dissipated, spalled};

    double K, s, gamma0, least;

    explicit EosShock(const LawParameters &p) :
        K(p.density * p.value[C0] * p.value[C0]), s(p.value[S]), gamma0(p.value[GAMMA0]),
        least(LEAST_MODULUS * K)
    {
    }

    /** 1 - S eta, at least 0.05. */
    MPM_INLINE double gap(double eta) const { return max(1.0 - s * eta, 0.05); }
    MPM_INLINE double gamma(double) const { return gamma0; }

    MPM_INLINE double cold(double J) const
    {
      const double eta = 1.0 - J, g = gap(eta);
      return K * eta * (J < 1.0 ? (1.0 - 0.5 * gamma0 * eta) / (g * g) : 1.0 / J);
    }

    MPM_INLINE double slope(double J, double) const
    {
      const double eta = 1.0 - J, g = gap(eta);
      const double ph = K * eta / (g * g);
      const double dph = K * (1.0 + s * eta) / (g * g * g);
      const double squeezed = dph * (1.0 - 0.5 * gamma0 * eta) - 0.5 * gamma0 * ph;
      return J < 1.0 ? squeezed : K / (J * J);
    }
    /** -dp/dJ at constant E, also where 1 - S eta is limited. */
    MPM_INLINE double exact_slope(double J, double E) const
    {
      const double eta = 1.0 - J, g = gap(eta), free = slope(J, E);
      return 1.0 - s * eta < g ? K * (1.0 - gamma0 * eta) / (g * g) : free;
    }
  };

  /** Polynomial in mu = density/density_0 - 1, with the internal energy E per reference volume: the
   *  linear polynomial of hydrocodes (J.O. Hallquist, LS-DYNA Theory Manual, 2006, chapter on
   *  equations of state), with separate coefficients in tension as in AUTODYN:
   *
   *    compression  p = A1 mu + A2 mu^2 + A3 mu^3 + (B0 + B1 mu) E
   *    tension      p = T1 mu + T2 mu^2 + B0 E
   */
  struct EosPolynomial : LinearInEnergy<EosPolynomial> {
    static constexpr const char *name = "polynomial";
    static constexpr const char *meaning = "polynomial in density, linear in energy";
    enum { A1, A2, A3, B0, B1, T1, T2, E0, CUTOFF, SPALL };
    static constexpr Parameter parameters[] = {
        {"", "A1", "pressure", POSITIVE, REQUIRED, "bulk modulus"},
        {"", "A2", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the square in compression"},
        {"", "A3", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the cube in compression"},
        {"", "B0", "1", NOT_NEGATIVE, REQUIRED, "coefficient of the energy"},
        {"", "B1", "1", ANY_NUMBER, REQUIRED, "coefficient of mu times energy in compression"},
        {"", "T1", "pressure", NOT_NEGATIVE, 0.0, "linear coefficient in tension, 0: A1"},
        {"", "T2", "pressure", ANY_NUMBER, 0.0, "coefficient of the square in tension"},
        {"energy", "E0", "pressure", NOT_NEGATIVE, 0.0, "initial energy per reference volume",
         OF_NEW_POINTS},
        cutoff,
        spall};
    static constexpr HistoryDeclaration history[] = {internal_energy(E0), dissipated, spalled};

    double a1, a2, a3, b0, b1, t1, t2, least;

    explicit EosPolynomial(const LawParameters &p) :
        a1(p.value[A1]), a2(p.value[A2]), a3(p.value[A3]), b0(p.value[B0]), b1(p.value[B1]),
        t1(p.value[T1] > 0.0 ? p.value[T1] : a1), t2(p.value[T2]), least(LEAST_MODULUS * a1)
    {
    }

    MPM_INLINE double gamma(double J) const { return b0 + b1 * max((1.0 - J) / J, 0.0); }

    MPM_INLINE double cold(double J) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (a2 + mu * a3), stretched = t1 + mu * t2;
      return mu * (J < 1.0 ? squeezed : stretched);
    }

    MPM_INLINE double slope(double J, double E) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (2.0 * a2 + 3.0 * mu * a3) + b1 * E;
      const double stretched = t1 + 2.0 * mu * t2;
      return (J < 1.0 ? squeezed : stretched) / (J * J);
    }
  };

  /** Gas with p + PINF = (GAMMA - 1) e / J, e = E - PINF J, where E is the internal energy per
   *  reference volume; PINF = 0 for an ideal gas. */
  struct Gas {
    double g;    ///< GAMMA - 1
    double pinf;
    double pmin;    ///< lowest pressure; where it applies, it does the work

    /** Energy per reference volume of the reference state at this pressure. */
    double energy_at(double pressure) const { return (pressure + pinf) / g + pinf; }

    MPM_INLINE double pressure(double J, double E) const
    {
      return max(g * (E - pinf * J) / J - pinf, pmin);
    }
  };

  /** Kernels of a gas. Law provides gas(parameters).
   *
   *  Along an isentrope e ~ J^(1 - GAMMA). The update follows this exactly for any increment of J,
   *  so that no expansion makes the energy negative. Half of the heat of a step is added before the
   *  change of volume and half after it, which is of second order. */
  template <class Law> struct GasLaw : InternalEnergy {
    static constexpr HistoryDeclaration history[] = {internal_energy(INITIALIZED), dissipated};

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Gas gas = Law::gas(p);
      const bool warms = Law::finds_temperature && p.warm > 0.0 && p.temperature >= 0;
      double energy[BATCH];
      for (int i = 0; warms && i < b.n; i++) energy[i] = history[ENERGY][i];
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
      if (warms) follow_energy(p, b, energy, history);
    }

    /** The temperature with a thermal part changes with the energy, by work as by heat; the thermal
     *  part adds the heat of the step. before: energy at its start. */
    static void follow_energy(const LawParameters &p, Batch &b, const double *before,
                              History history)
    {
      double *const T = temperature(p, b);
      for (int i = 0; i < b.n; i++) T[i] += p.warm * (history[ENERGY][i] - before[i] - b.heat[i]);
    }

    /** The half of the heat that is added last is not compressed. */
    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const Gas gas = Law::gas(p);
      alignas(64) double pressure[BATCH], by_J[BATCH], by_heat[BATCH];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], Jold = b.Jold[i], half = 0.5 * b.heat[i];
        const double ratio = exp(gas.g * log(Jold / J));
        const double before = (history[ENERGY][i] - gas.pinf * Jold + half) * ratio;
        const double end = gas.g * (before + half) / J - gas.pinf;
        const double flat = end < gas.pmin ? 0.0 : 1.0;
        pressure[i] = end < gas.pmin ? gas.pmin : end;
        by_J[i] = -flat * gas.g * (gas.g * before + before + half) / (J * J);
        by_heat[i] = flat * 0.5 * gas.g * (ratio + 1.0) / J;
      }
      update(p, b, history);
      add_pressure(b, pressure, by_J, by_heat, t);
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
   *  absolute and positive from the start: points have the mean stress -P0 before the first
   *  step. */
  struct EosIdealGas : GasLaw<EosIdealGas> {
    static constexpr const char *name = "ideal/gas";
    static constexpr const char *meaning = "ideal gas";
    static constexpr bool finds_temperature = true;
    enum { GAMMA, P0, E0 };
    static constexpr Parameter parameters[] = {
        {"", "GAMMA", "1", {1.0, UNBOUNDED, false}, REQUIRED, "ratio of specific heats"},
        {"pressure", "P0", "pressure", POSITIVE, 0.0, "initial pressure", OF_NEW_POINTS},
        {"energy", "E0", "energy/mass", POSITIVE, 0.0, "initial internal energy per mass",
         OF_NEW_POINTS}};
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
        {"pressure", "P0", "pressure", NOT_NEGATIVE, 0.0, "initial pressure", OF_NEW_POINTS},
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

  /** Detonation products after Jones, Wilkins and Lee (E.L. Lee, H.C. Hornig, J.W. Kury,
   *  UCRL-50422, 1968), with programmed burn (M.L. Wilkins, UCRL-7322, 1963; E.L. Giroux, HEMP
   *  User's Manual, UCRL-51079, 1973). With the internal energy E per reference volume:
   *
   *    p = f [A (1 - OMEGA/(R1 J)) exp(-R1 J) + B (1 - OMEGA/(R2 J)) exp(-R2 J) + OMEGA E / J]
   *    f = D (t - t_light) / (WIDTH h) within 0 and 1, never decreasing
   *
   *  The detonation reaches a point at t_light: the minimum over all detonation points of the time
   *  of the detonation point plus its distance over D, for the position at which the material point
   *  is created. Without detonation points everything has burnt from the start. E starts from E0
   *  and changes only by the work of the pressure and by heat: the chemical energy is released
   *  once. */
  struct EosJWL : InternalEnergy {
    static constexpr const char *name = "jwl";
    static constexpr const char *meaning = "Jones-Wilkins-Lee detonation products";
    static constexpr bool finds_temperature = true;
    enum { A, B, R1, R2, OMEGA, E0, D, WIDTH };
    static constexpr Parameter parameters[] = {
        {"", "A", "pressure", NOT_NEGATIVE, REQUIRED, "coefficient of the first exponential"},
        {"", "B", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the second exponential"},
        {"", "R1", "1", POSITIVE, REQUIRED, "rate of the first exponential"},
        {"", "R2", "1", POSITIVE, REQUIRED, "rate of the second exponential"},
        {"", "OMEGA", "1", POSITIVE, REQUIRED, "Gruneisen parameter of the products"},
        {"", "E0", "pressure", POSITIVE, REQUIRED, "chemical energy per reference volume",
         OF_NEW_POINTS},
        {"", "D", "velocity", POSITIVE, REQUIRED, "detonation velocity"},
        {"width", "WIDTH", "1", POSITIVE, 3.0, "width of the burn in node spacings"}};
    static constexpr const char *term = "detonate";
    static constexpr Parameter term_parameters[] = {
        {"detonate", "X", "length", ANY_NUMBER, REQUIRED, "detonation point", OF_NEW_POINTS},
        {"detonate", "Y", "length", ANY_NUMBER, REQUIRED, "detonation point", OF_NEW_POINTS},
        {"detonate", "Z", "length", ANY_NUMBER, REQUIRED, "detonation point", OF_NEW_POINTS},
        {"detonate", "T", "time", ANY_NUMBER, REQUIRED, "time of its detonation", OF_NEW_POINTS}};
    static constexpr HistoryDeclaration history[] = {
        internal_energy(E0),
        dissipated,
        {"burn", INITIALIZED, "1", "burn fraction"},
        {"lighting", INITIALIZED, "time", "time at which the detonation arrives"}};
    enum { BURN = HEATED + 1, LIGHTING };
    /** Sets the time at which the detonation arrives, and the burn fraction. */
    static void initialize(const LawParameters &p, const double *x, double *history)
    {
      for (int k = 0; k < p.nterms; k++) {
        const double *d = p.term[k];
        const double r2 = (x[0] - d[0]) * (x[0] - d[0]) + (x[1] - d[1]) * (x[1] - d[1]) +
            (x[2] - d[2]) * (x[2] - d[2]);
        const double light = d[3] + std::sqrt(r2) / p.value[D];
        history[LIGHTING] = k == 0 ? light : min(history[LIGHTING], light);
      }
      history[BURN] = p.nterms ? 0.0 : 1.0;
    }

    double a, b, r1, r2, omega;

    explicit EosJWL(const LawParameters &p) :
        a(p.value[A]), b(p.value[B]), r1(p.value[R1]), r2(p.value[R2]), omega(p.value[OMEGA])
    {
    }

    /** Pressure of the products at zero internal energy. */
    MPM_INLINE double cold(double J) const
    {
      return a * (1.0 - omega / (r1 * J)) * exp(-r1 * J) +
          b * (1.0 - omega / (r2 * J)) * exp(-r2 * J);
    }
    /** -d cold/dJ. */
    MPM_INLINE double slope(double J) const
    {
      const double w = omega / J;
      return a * (r1 - w - w / (r1 * J)) * exp(-r1 * J) +
          b * (r2 - w - w / (r2 * J)) * exp(-r2 * J);
    }

    /** Energy of the products at zero temperature: integral of A exp(-R1 J) + B exp(-R2 J) from J
     *  to infinity. */
    MPM_INLINE double cold_energy(double J) const
    {
      return a / r1 * exp(-r1 * J) + b / r2 * exp(-r2 * J);
    }

    /** Temperature with a thermal part: that of the products is (E - cold energy)/(density_0 CP),
     *  which falls along an isentrope as J^-OMEGA; unburnt material keeps its own temperature.
     *  before, E: burn fraction and internal energy at the start of the step. The heat of the step
     *  is subtracted because the new internal energy contains it and the thermal part adds it
     *  again. */
    static void find_temperature(const LawParameters &p, const EosJWL &eos, const double *before,
                                 const double *E, Batch &batch, History history)
    {
      double *const T = temperature(p, batch);
      for (int i = 0; i < batch.n; i++) {
        const double old = p.warm * (E[i] - eos.cold_energy(batch.Jold[i]));
        const double now = p.warm * (history[ENERGY][i] - eos.cold_energy(batch.J[i]));
        const double burn = history[BURN][i];
        const double fresh = before[i] < 1.0 ? (T[i] - before[i] * old) / (1.0 - before[i]) : 0.0;
        if (burn > 0.0) T[i] = burn * now + (1.0 - burn) * fresh - p.warm * batch.heat[i];
      }
    }

    static void update(const LawParameters &p, Batch &batch, History history)
    {
      const EosJWL eos(p);
      double was[BATCH], energy[BATCH];
      const bool warms = p.warm > 0.0 && p.temperature >= 0;
      for (int i = 0; warms && i < batch.n; i++) {
        was[i] = history[BURN][i];
        energy[i] = history[ENERGY][i];
      }
      const double time = batch.time, rate = p.value[D] / (p.value[WIDTH] * batch.h);
      MPM_SIMD
      for (int i = 0; i < batch.n; i++) {
        const double J = batch.J[i], Jold = batch.Jold[i], dJ = J - Jold;
        const double Eold = history[ENERGY][i], before = history[BURN][i];
        const double burn = min(max((time - history[LIGHTING][i]) * rate, before), 1.0);
        const double cold = burn * eos.cold(J), gamma = burn * eos.omega / J;
        const double pold = max(before * (eos.cold(Jold) + eos.omega / Jold * Eold), 0.0);
        const double E = EndOfStep(gamma, dJ, pold).energy(cold, Eold, batch.heat[i]);
        const double pressure = cold + gamma * E;
        const bool below = pressure < 0.0;
        subtract_pressure(batch, i, below ? 0.0 : pressure);
        history[ENERGY][i] = below ? Eold - 0.5 * pold * dJ + batch.heat[i] : E;
        history[HEATED][i] += batch.heat[i];
        history[BURN][i] = burn;
      }
      if (warms) find_temperature(p, eos, was, energy, batch, history);
    }

    /** As in LinearInEnergy. */
    static void tangent(const LawParameters &p, Batch &batch, History history, Tangent &t)
    {
      const EosJWL eos(p);
      alignas(64) double pressure[BATCH], by_J[BATCH], by_heat[BATCH];
      const double time = batch.time, rate = p.value[D] / (p.value[WIDTH] * batch.h);
      MPM_SIMD
      for (int i = 0; i < batch.n; i++) {
        const double J = batch.J[i], Jold = batch.Jold[i], dJ = J - Jold;
        const double Eold = history[ENERGY][i], before = history[BURN][i];
        const double burn = min(max((time - history[LIGHTING][i]) * rate, before), 1.0);
        const double cold = burn * eos.cold(J), gamma = burn * eos.omega / J;
        const double pold = max(before * (eos.cold(Jold) + eos.omega / Jold * Eold), 0.0);
        const EndOfStep step(gamma, dJ, pold);
        const double E = step.energy(cold, Eold, batch.heat[i]), end = cold + gamma * E;
        const double flat = end < 0.0 ? 0.0 : 1.0;
        pressure[i] = flat * end;
        by_J[i] = flat * step.by_J(end, burn * eos.slope(J) + gamma / J * E);
        by_heat[i] = flat * step.by_heat();
      }
      update(p, batch, history);
      add_pressure(batch, pressure, by_J, by_heat, t);
    }

    /** Isentropic -J^2 dp/dJ. While the explosive burns, at least density_0 D^2: the wave is not
     *  slower than the detonation front, and the pressure is still to rise. */
    static void modulus(const LawParameters &p, const Batch &batch, History history, double *k)
    {
      const EosJWL eos(p);
      const double front = p.density * p.value[D] * p.value[D];
      MPM_SIMD
      for (int i = 0; i < batch.n; i++) {
        const double J = batch.J[i], E = history[ENERGY][i], burn = history[BURN][i];
        const double gamma = eos.omega / J, pressure = max(burn * (eos.cold(J) + gamma * E), 0.0);
        const double slope = eos.slope(J) + gamma / J * E + gamma * pressure;
        k[i] += max(burn * J * J * slope, burn < 1.0 ? front : 0.0);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

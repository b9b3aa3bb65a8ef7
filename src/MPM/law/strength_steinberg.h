/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_STEINBERG_H
#define MPM_LAW_STRENGTH_STEINBERG_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  enum { SCG_G0, SCG_Y0, SCG_BETA, SCG_N, SCG_YMAX, SCG_A, SCG_B, SCG_PRE };
  enum { SCG_MELT = SCG_PRE + 1, SCG_MELT_A, SCG_MELT_GAMMA, SCG_TREF };

  /** G = G0 f and Y = min(Y0 (1 + BETA (e + EPSI))^N, YMAX) f with
   *
   *    f = 1 + A P J^(1/3) - B (T - TREF)
   *
   *  of pressure P and temperature T at the end of the last step, J = density_0/density, and no
   *  strength at and above the melting temperature
   *  TM = TM0 exp(2 MA (1 - J)) J^(-2 (MGAMMA - MA - 1/3)). f is kept above LEAST. */
  struct SteinbergState {
    static constexpr double LEAST = 0.01;
    double A, B, melt, a, power, tref;
    const double *temperature;    ///< null: at TREF

    SteinbergState(const LawParameters &p, const Batch &b) :
        A(p.value[SCG_A]), B(p.value[SCG_B]),
        melt(p.value[SCG_MELT] > 0.0 ? p.value[SCG_MELT] : UNBOUNDED), a(p.value[SCG_MELT_A]),
        power(-2.0 * (p.value[SCG_MELT_GAMMA] - p.value[SCG_MELT_A] - 1.0 / 3.0)),
        tref(p.value[SCG_TREF]), temperature(MPM_NS::temperature(p, b))
    {
    }
    MPM_INLINE double factor(double pressure, double J, double T) const
    {
      return max(1.0 + A * pressure * exp((1.0 / 3.0) * log(J)) - B * (T - tref), LEAST);
    }
    MPM_INLINE bool molten(double J, double T) const
    {
      return T >= melt * exp(2.0 * a * (1.0 - J) + power * log(J));
    }
    MPM_INLINE double T(int i) const { return temperature ? temperature[i] : tref; }
  };

  struct SteinbergFlow {
    static constexpr bool smooth = false;    // kink at YMAX
    static constexpr bool goes_on = true;    // when f falls
    double G0, Y0, beta, n, ymax, pre;
    alignas(64) double G[BATCH], strong[BATCH];    ///< strong: f, or 0 when molten

    SteinbergFlow(const LawParameters &p, const Batch &b) :
        G0(p.value[SCG_G0]), Y0(p.value[SCG_Y0]), beta(p.value[SCG_BETA]), n(p.value[SCG_N]),
        ymax(p.value[SCG_YMAX]), pre(p.value[SCG_PRE])
    {
      const SteinbergState state(p, b);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double T = state.T(i), J = b.Jold[i];
        const double f = state.factor((-1.0 / 3.0) * trace(load_stress(b, i)), J, T);
        G[i] = G0 * f;
        strong[i] = state.molten(J, T) ? 0.0 : f;
      }
    }
    MPM_INLINE double shear(int i) const { return G[i]; }
    MPM_INLINE double start(History history, int i) const
    {
      return strong[i] * min(Y0 * pow(1.0 + beta * (history[0][i] + pre), n), ymax);
    }
    MPM_INLINE void stress(History history, int i, double, const TrialState, double D, double &y,
                           double &dy) const
    {
      const double x = 1.0 + beta * (history[0][i] + D + pre), hard = Y0 * pow(x, n);
      y = strong[i] * min(hard, ymax);
      dy = hard < ymax ? strong[i] * n * beta * hard / x : 0.0;
    }
    MPM_INLINE double begin(double start, double) const { return start; }
  };

  /** Strength at high pressure (D.J. Steinberg, S.G. Cochran, M.W. Guinan, J. Appl. Phys. 51 (1980)
   *  1498, eqs. 1, 2 and 4; D.J. Steinberg, UCRL-MA-106439, 1996). In rate form with the present
   *  shear modulus: the elastic energy is then what the stress has stored, a history variable. */
  struct StrengthSteinberg : RadialReturn<SteinbergFlow> {
    static constexpr const char *name = "steinberg";
    static constexpr const char *meaning = "Steinberg-Cochran-Guinan plasticity, with pressure";
    static constexpr Parameter parameters[] = {
        {"", "G0", "pressure", POSITIVE, REQUIRED, "shear modulus at reference"},
        {"", "Y0", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress at reference"},
        {"", "BETA", "1", NOT_NEGATIVE, REQUIRED, "factor of the plastic strain"},
        {"", "N", "1", NOT_NEGATIVE, REQUIRED, "exponent of hardening"},
        {"", "YMAX", "pressure", POSITIVE, REQUIRED, "limit of hardening, at reference"},
        {"", "A", "1/pressure", NOT_NEGATIVE, REQUIRED, "effect of pressure, G'_P/G0"},
        {"", "B", "1/temperature", NOT_NEGATIVE, REQUIRED, "effect of temperature, -G'_T/G0"},
        {"prestrain", "EPSI", "1", NOT_NEGATIVE, 0.0, "plastic strain before the start"},
        {"melt", "TM0", "temperature", POSITIVE, 0.0, "melting temperature at reference, 0: none"},
        {"melt", "MA", "1", NOT_NEGATIVE, 0.0, "change of the Gruneisen parameter with volume"},
        {"melt", "MGAMMA", "1", NOT_NEGATIVE, 0.0, "Gruneisen parameter at reference"},
        {"tref", "TREF", "temperature", NOT_NEGATIVE, 300.0, "reference temperature"}};
    static constexpr HistoryDeclaration history[] = {
        PLASTIC_STRAIN, {"shear_energy", ZERO, "pressure", "elastic energy of the deviator"}};
    static constexpr bool needs_temperature(const LawParameters &p)
    {
      return p.value[SCG_B] > 0.0 || p.value[SCG_MELT] > 0.0;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[SCG_YMAX] >= p.value[SCG_Y0] ? nullptr : "YMAX must not be below Y0";
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      alignas(64) double before[BATCH], stiff[BATCH];
      const SteinbergState state(p, b);
      const double G0 = p.value[SCG_G0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym old = load_stress(b, i);
        before[i] = b.Jold[i] * b.Jold[i] * norm2(deviator(old));
        stiff[i] = G0 * state.factor((-1.0 / 3.0) * trace(old), b.Jold[i], state.T(i));
      }
      RadialReturn<SteinbergFlow>::update(p, b, history);
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        history[1][i] +=
            (b.J[i] * b.J[i] * norm2(load_stress(b, i)) - before[i]) / (4.0 * stiff[i]);
    }

    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const SteinbergState state(p, b);
      const double G0 = p.value[SCG_G0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym s = load_stress(b, i);
        const double G = G0 * state.factor((-1.0 / 3.0) * trace(s), b.J[i], state.T(i));
        k[i] += (4.0 / 3.0) * G + b.J[i] * eigenvalue_bound(deviator(s));
      }
    }

    static void energy(const LawParameters &, const Batch &b, History history, double *w)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) w[i] += history[1][i];
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

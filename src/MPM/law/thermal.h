/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_THERMAL_H
#define MPM_LAW_THERMAL_H

#include "law/axes.h"
#include "law/heat_curve.h"
#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  constexpr Parameter SPECIFIC_HEAT = {"",       "CP",     "energy/(mass temperature)",
                                       POSITIVE, REQUIRED, "specific heat"};
  constexpr Parameter FIRST_TEMPERATURE = {
      "",         "T0",     "temperature",
      ANY_NUMBER, REQUIRED, "initial temperature, absolute with gruneisen"};
  constexpr Parameter HEAT_SHARE = {"",       "CHI", "1",
                                    FRACTION, 0.9,   "share of the plastic work that becomes heat"};
  constexpr Parameter GRUNEISEN = {
      "gruneisen", "GAMMA", "1", NOT_NEGATIVE, 0.0, "Gruneisen parameter at reference density"};
  constexpr Parameter MELTING_POINT = {"melt",     "TMELT", "temperature",
                                       ANY_NUMBER, 0.0,     "melting temperature"};
  constexpr Parameter HEAT_OF_FUSION = {"melt",   "LATENT", "energy/mass",
                                        POSITIVE, 0.0,      "heat of fusion, 0: none"};
  constexpr Parameter EXPANSION = {"expansion", "ALPHA", "1/temperature",
                                   ANY_NUMBER,  0.0,     "coefficient of linear expansion from T0"};
  constexpr Parameter CONSISTENT_GRUNEISEN = {
      "gruneisen consistent",
      "CONSISTENT",
      FLAG,
      FRACTION,
      0.0,
      "GAMMA = 3 K ALPHA/(density CP), with the bulk modulus K and ALPHA at T0"};
  constexpr Parameter FRACTURE_SHARE = {
      "fracture", "SHARE", "1", FRACTION, 0.0, "share of the work of damage that becomes heat"};

  constexpr Parameter MELTING_RANGE = {
      "over",       "DT", "temperature",
      NOT_NEGATIVE, 0.0,  "range of temperatures in which it melts, from TMELT on"};

  /** Temperature of a point from its own heat:
   *
   *    density_0 CP dT = dq - density_0 CP GAMMA T dJ
   *
   *  with the heat dq of the step per reference volume: the share CHI of the plastic work (G.I.
   *  Taylor, H. Quinney, Proc. R. Soc. London A 143 (1934) 307), and all viscous work. The second
   *  term is the change along an isentrope if density * Gruneisen parameter is constant, T ~
   *  exp(GAMMA (1 - J)). Strengths use the temperature at the end of the step.
   *
   *  With melting, the temperature stays at TMELT until the molten fraction f, LATENT df = CP dT,
   *  has gone from 0 to 1 (on cooling, back to 0), or it rises from TMELT to TMELT + DT meanwhile.
   *  In the latter case, and if CP depends on temperature, the temperature follows from the
   *  enthalpy (HeatCurve).
   *
   *  With expansion, the second term is applied before the stress of the step, which depends on it.
   *  A GAMMA that follows from the expansion is that of the given CP and varies as the inverse of
   *  the specific heat: dp/dT at constant volume, 3 K ALPHA, stays constant.
   *
   *  MORE: number of parameters between T0 and CHI. */
  template <int MORE> struct ThermalByWork : LawDefaults {
    static constexpr bool uses_F = false;
    enum { CP, T0, CHI = 2 + MORE, GAMMA, TMELT, LATENT, ALPHA, CONSISTENT, BREAKS, OVER };
    static constexpr HistoryDeclaration history[] = {
        {"temperature", T0, "temperature", "temperature"},
        {"molten", ZERO, "1", "molten fraction"}};
    static constexpr int nhistory(const LawParameters &p) { return p.value[LATENT] > 0.0 ? 2 : 1; }
    static constexpr const char *check(const LawParameters &p)
    {
      if (p.value[CONSISTENT] > 0.0 && p.value[ALPHA] == 0.0)
        return "'gruneisen consistent' follows from the expansion: add 'expansion ALPHA'";
      if ((p.value[CONSISTENT] > 0.0 || p.value[GAMMA] > 0.0) && !(p.value[T0] > 0.0))
        return "'gruneisen' needs absolute temperatures: T0 above zero";
      if (p.value[OVER] > 0.0 && !(p.value[LATENT] > 0.0))
        return "'over DT' is a range of melting: add 'melt TMELT LATENT'";
      return nullptr;
    }
    /** Material that starts above its melting temperature is molten. */
    static void initialize(const LawParameters &p, const double *, double *history)
    {
      const HeatCurve curve = curve_of(p);
      if (nhistory(p) == 2 && history[0] > p.value[TMELT]) history[1] = curve.molten_at(history[0]);
    }
    static double heat_share(const LawParameters &p) { return p.value[CHI]; }
    static double warming(const LawParameters &p) { return 1.0 / (p.heat_density * p.value[CP]); }
    static double fracture_share(const LawParameters &p) { return p.value[BREAKS]; }
    static double expansion(const LawParameters &p) { return p.value[ALPHA]; }
    static constexpr int gruneisen = GAMMA;
    static bool consistent(const LawParameters &p) { return p.value[CONSISTENT] > 0.0; }
    /** Enthalpy curve of the parameters. */
    static MPM_INLINE HeatCurve curve_of(const LawParameters &p)
    {
      return {p, p.value[TMELT], p.value[LATENT], p.value[OVER]};
    }

    /** Applies the change of temperature by compression. */
    static MPM_INLINE void compress(const LawParameters &p, Batch &b, History history)
    {
      const double gamma = p.value[GAMMA];
      double *const T = history[0];
      if (gamma == 0.0) return;
      if (consistent(p) && p.curved) {
        const HeatCurve curve = curve_of(p);
        for (int i = 0; i < b.n; i++) {
          const double g = gamma * p.value[CP] * (b.J[i] - b.Jold[i]);
          const double middle = T[i] * exp(-0.5 * g / curve.capacity(T[i]));
          T[i] *= exp(-g / curve.capacity(middle));
        }
        return;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) T[i] += T[i] * expm1(-gamma * (b.J[i] - b.Jold[i]));
    }

    static void prepare(const LawParameters &p, Batch &b, History history)
    {
      if (p.value[ALPHA] != 0.0) compress(p, b, history);
    }

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const double warm = p.warm;
      double *const T = history[0];
      if (p.value[ALPHA] == 0.0) compress(p, b, history);
      if (p.curved) {
        const HeatCurve curve = curve_of(p);
        double *const molten = nhistory(p) == 2 ? history[1] : nullptr;
        for (int i = 0; i < b.n; i++)
          curve.warm(warm * p.value[CP] * b.heat[i], T[i], molten ? molten + i : nullptr);
        return;
      }
      MPM_SIMD
      for (int i = 0; i < b.n; i++) T[i] += warm * b.heat[i];
      if (nhistory(p) == 1) return;
      const Melting melting = {p.value[TMELT], p.value[LATENT] / p.value[CP]};
      double *const molten = history[1];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) melting.settle(T[i], molten[i]);
    }
  };

  /** Temperature without conduction of heat. */
  struct ThermalAdiabatic : ThermalByWork<0> {
    static constexpr const char *name = "adiabatic";
    static constexpr const char *meaning = "temperature by dissipation, without conduction";
    static constexpr Parameter parameters[] = {
        SPECIFIC_HEAT,  FIRST_TEMPERATURE, HEAT_SHARE,           GRUNEISEN,      MELTING_POINT,
        HEAT_OF_FUSION, EXPANSION,         CONSISTENT_GRUNEISEN, FRACTURE_SHARE, MELTING_RANGE};
  };

  /** As ThermalAdiabatic, for points between which fix mpm/heat conducts heat. */
  struct ThermalConducting : ThermalByWork<1> {
    enum { K = 2, K2 = OVER + 1, K3, A1, THETA = A1 + 6 };
    static constexpr const char *name = "conducting";
    static constexpr const char *meaning = "temperature by dissipation and conduction";
    static constexpr Parameter parameters[] = {
        SPECIFIC_HEAT,
        FIRST_TEMPERATURE,
        {"", "K", "energy/(time length temperature)", POSITIVE, REQUIRED, "thermal conductivity"},
        HEAT_SHARE,
        GRUNEISEN,
        MELTING_POINT,
        HEAT_OF_FUSION,
        EXPANSION,
        CONSISTENT_GRUNEISEN,
        FRACTURE_SHARE,
        MELTING_RANGE,
        {"orthotropic", "K2", "energy/(time length temperature)", POSITIVE, 0.0,
         "conductivity along axis 2, with K along axis 1"},
        {"orthotropic", "K3", "energy/(time length temperature)", POSITIVE, 0.0,
         "conductivity along axis 3"},
        MPM_AXES_PARAMETERS};
    static const char *check(const LawParameters &p)
    {
      const double *const v = p.value, *const a = v + A1, *const b = a + 3;
      if (const char *wrong = ThermalByWork<1>::check(p)) return wrong;
      if (const char *wrong = check_axes(a, b)) return wrong;
      const bool plain = a[0] == 1.0 && a[1] == 0.0 && a[2] == 0.0 && b[0] == 0.0 && b[1] == 1.0 &&
          b[2] == 0.0 && v[THETA] == 0.0;
      return v[K2] == 0.0 && !plain ? "axes and angle are those of 'orthotropic K2 K3': add it"
                                    : nullptr;
    }
    static Conduction conduction(const LawParameters &p)
    {
      Conduction c = {};
      c.capacity = p.value[CP];
      c.conductivity = p.value[K];
      c.melting = {p.value[TMELT], p.value[LATENT] / p.value[CP]};
      c.by_enthalpy = p.curved;
      c.orthotropic = p.value[K2] > 0.0;
      if (c.orthotropic) {
        c.across[0] = p.value[K2];
        c.across[1] = p.value[K3];
        orthonormal_axes(p.value + A1, p.value + A1 + 3, p.value[THETA], c.axis);
      }
      return c;
    }
  };

  /** Constant temperature. */
  struct ThermalConstant : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "constant";
    static constexpr const char *meaning = "constant temperature";
    static constexpr Parameter parameters[] = {
        {"", "T0", "temperature", ANY_NUMBER, REQUIRED, "temperature"}};
    static constexpr HistoryDeclaration history[] = {
        {"temperature", 0, "temperature", "temperature"}};
    static double heat_share(const LawParameters &) { return 1.0; }
    static double warming(const LawParameters &) { return 0.0; }
    static void update(const LawParameters &, Batch &, History) {}
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

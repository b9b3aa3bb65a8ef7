/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_H
#define MPM_LAW_VISCOSITY_H

#include "law/tangent.h"

namespace MPM_NS::law {
namespace {

  /** Speed c, raised for the shear viscosity mu and the bulk viscosity zeta. The stable step of
   *  explicit integration with damping is dt = h / (sqrt(c^2 + a^2) + a) with a = (4/3 mu + zeta) /
   *  (density h), the central-difference limit (2/omega)(sqrt(1 + xi^2) - xi) with omega = 2
   *  c/h. */
  MPM_INLINE double damped_speed(const LawParameters &p, const Batch &b, int i, double c, double mu,
                                 double zeta)
  {
    const double a = ((4.0 / 3.0) * mu + zeta) * b.J[i] / (p.density * b.h);
    return std::sqrt(c * c + a * a) + a;
  }

  /** Newtonian viscosity: adds 2 MU dev(D) + ZETA tr(D) I, where D is the strain rate at the middle
   *  of the step. With the elasticity of a solid it forms a Kelvin-Voigt element. */
  struct ViscosityNewtonian : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "newtonian";
    static constexpr const char *meaning = "Newtonian viscosity; damping of solids (Kelvin-Voigt)";
    static constexpr StressShare share = WHOLE_STRESS;
    static constexpr bool uses_speed = false;
    static constexpr Parameter parameters[] = {
        {"", "MU", "pressure time", NOT_NEGATIVE, REQUIRED, "dynamic viscosity"},
        {"bulk", "ZETA", "pressure time", NOT_NEGATIVE, 0.0, "bulk viscosity"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double twomu = 2.0 * p.value[0] * inv_dt, zeta = p.value[1] * inv_dt;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym e = deviator(inc.strain);
        const double tr = trace(inc.strain);
        store_stress(b, i, add_diagonal(load_stress(b, i) + twomu * e, zeta * tr));
        const double work = 0.5 * (b.J[i] + b.Jold[i]) * (twomu * norm2(e) + zeta * tr * tr);
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) c[i] = damped_speed(p, b, i, c[i], p.value[0], p.value[1]);
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double twomu = 2.0 * p.value[0] * inv_dt, zeta = p.value[1] * inv_dt;
      update(p, b, history);
      const StepMotion step(b);
      alignas(64) double change[6][BATCH];
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
          if (t.skips(3 * k + l)) continue;
          const double volume = k == l ? 1.0 : 0.0;
          double *const heat = t.heat[3 * k + l];
          const StepMotion::Columns columns = step.columns(k, l);
          MPM_SIMD
          for (int i = 0; i < b.n; i++) store_rows(change, i, columns(i).strain);
          MPM_SIMD
          for (int i = 0; i < b.n; i++) {
            const double J = b.J[i], all = J + b.Jold[i];
            const Sym strain = step.strain(i), e = deviator(strain);
            const Sym dstrain = load_rows(change, i), de = deviator(dstrain);
            const double tr = trace(strain), dtr = trace(dstrain);
            add_column(t, 3 * k + l, i,
                       J * add_diagonal(twomu * (de + volume * e), zeta * (dtr + volume * tr)));
            heat[i] += 0.5 * volume * J * (twomu * norm2(e) + zeta * tr * tr) +
                all * (twomu * contract(e, de) + zeta * tr * dtr);
          }
        }
    }
  };

  /** Artificial bulk viscosity, in compression only (J. von Neumann, R.D. Richtmyer, J. Appl. Phys.
   *  21 (1950) 232; linear term R. Landshoff, LA-1930, 1955): the pressure rises by
   *
   *    q = density h |tr D| (CQ h |tr D| + CL c),   tr D < 0
   *
   *  with node spacing h and wave speed c. Shocks spread over a few h. */
  struct ViscosityArtificial : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "artificial";
    static constexpr const char *meaning = "artificial bulk viscosity for shocks";
    static constexpr StressShare share = PRESSURE;
    static constexpr Parameter parameters[] = {
        {"", "CQ", "1", NOT_NEGATIVE, REQUIRED, "quadratic coefficient (about 1.5)"},
        {"", "CL", "1", NOT_NEGATIVE, REQUIRED, "linear coefficient (about 0.06)"}};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      const double quadratic = p.value[0] * b.h, linear = p.value[1], scale = p.density * b.h;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const double dJ = b.J[i] - b.Jold[i], sum = b.J[i] + b.Jold[i];
        const double rate = max(-2.0 * dJ / sum * inv_dt, 0.0);
        const double q = 2.0 * scale / sum * rate * (quadratic * rate + linear * b.speed[i]);
        subtract_pressure(b, i, q);
        const double work = -q * dJ;
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    /** Accounts for the linear term only; the safety factor of the time step covers the quadratic
     *  term. */
    static void raise_speed(const LawParameters &p, const Batch &b, History, double *c)
    {
      const double xi = p.value[1], factor = std::sqrt(1.0 + xi * xi) + xi;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) c[i] *= factor;
    }
  };

  /** History of a generalized Newtonian fluid; parameter: index of the viscosity at rest. */
  constexpr HistoryDeclaration apparent_viscosity(int parameter)
  {
    return {"viscosity", parameter, "pressure time", "apparent viscosity"};
  }

  /** Kernels of a generalized Newtonian fluid (R.B. Bird, R.C. Armstrong, O. Hassager, Dynamics of
   *  Polymeric Liquids 1, 1987, ch. 4): adds 2 eta dev(D), where the apparent viscosity eta depends
   *  on the shear rate sqrt(2 dev(D):dev(D)) and D is the strain rate at the middle of the step.
   *
   *  Fluid provides:
   *    Fluid(parameters)
   *    apparent(rate), the viscosity at a shear rate
   *    slope(rate), the derivative of apparent()
   *    steepness, a bound of the slope of stress over rate, in units of the apparent viscosity
   *
   *  History: the apparent viscosity of the last step, for the stable time step and for output. */
  template <class Fluid> struct GeneralizedNewtonian : LawDefaults {
    static constexpr StressShare share = DEVIATOR;
    static constexpr bool uses_speed = false, uses_F = false;

    static void update(const LawParameters &p, Batch &b, History history)
    {
      const Fluid fluid(p);
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0;
      double viscous = 0.0;
      MPM_SIMD_SUM(viscous)
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Sym D = inv_dt * deviator(inc.strain);
        const double D2 = norm2(D);
        const double eta = fluid.apparent(std::sqrt(2.0 * D2));
        store_stress(b, i, load_stress(b, i) + 2.0 * eta * D);
        const double work = (b.J[i] + b.Jold[i]) * eta * D2 * b.dt;
        history[0][i] = eta;
        b.heat[i] += work;
        viscous += work * b.vol0[i];
      }
      b.work[VISCOUS] += viscous;
    }

    static void raise_speed(const LawParameters &p, const Batch &b, History history, double *c)
    {
      const double steepness = Fluid(p).steepness;
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        c[i] = damped_speed(p, b, i, c[i], steepness * history[0][i], 0.0);
    }

    static void tangent(const LawParameters &p, Batch &b, History history, Tangent &t)
    {
      const Fluid fluid(p);
      const double inv_dt = b.dt > 0.0 ? 1.0 / b.dt : 0.0, dt = b.dt;
      update(p, b, history);
      const StepMotion step(b);
      alignas(64) double change[6][BATCH],
          slope[BATCH];    // of the strain; of the viscosity by D:dD
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double rate = std::sqrt(2.0 * norm2(inv_dt * deviator(step.strain(i))));
        const double s = 2.0 * fluid.slope(rate) / max(rate, 1e-300);
        slope[i] = rate > 0.0 ? s : 0.0;
      }
      for (int k = 0; k < 9; k++) {
        if (t.skips(k)) continue;
        const StepMotion::Columns columns = step.columns(k / 3, k % 3);
        const double volume = k % 4 == 0 ? 1.0 : 0.0;
        double *const heat = t.heat[k];
        MPM_SIMD
        for (int i = 0; i < b.n; i++) store_rows(change, i, columns(i).strain);
        MPM_SIMD
        for (int i = 0; i < b.n; i++) {
          const Sym D = inv_dt * deviator(step.strain(i));
          const Sym dD = inv_dt * deviator(load_rows(change, i));
          const double J = b.J[i], all = J + b.Jold[i], D2 = norm2(D), both = contract(D, dD);
          const double eta = history[0][i], deta = slope[i] * both;
          add_column(t, k, i, (2.0 * J * eta) * dD + (2.0 * J * (deta + volume * eta)) * D);
          heat[i] += (volume * J * eta * D2 + all * (deta * D2 + 2.0 * eta * both)) * dt;
        }
      }
    }
  };

  /** Bingham fluid (E.C. Bingham, Fluidity and Plasticity, 1922), in the bi-viscous form of E.J.
   *  O'Donovan, R.I. Tanner, J. Non-Newtonian Fluid Mech. 15 (1984) 75: at the shear rate g the
   *  equivalent shear stress is
   *
   *    tau = min(MUMAX g, TAUY + MU g)
   *
   *  Below TAUY MUMAX / (MUMAX - MU) the material creeps with the viscosity MUMAX. */
  struct ViscosityBingham : GeneralizedNewtonian<ViscosityBingham> {
    static constexpr const char *name = "bingham";
    static constexpr const char *meaning = "Bingham fluid, bi-viscous";
    enum { MU, TAUY, MUMAX };
    static constexpr Parameter parameters[] = {
        {"", "MU", "pressure time", NOT_NEGATIVE, REQUIRED, "plastic viscosity"},
        {"", "TAUY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in shear"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "viscosity below yield"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MUMAX] > p.value[MU] ? nullptr : "MUMAX must be above MU";
    }

    double mu, tauy, mumax;
    static constexpr double steepness = 1.0;

    explicit ViscosityBingham(const LawParameters &p) :
        mu(p.value[MU]), tauy(p.value[TAUY]), mumax(p.value[MUMAX])
    {
    }
    MPM_INLINE double apparent(double rate) const
    {
      return min(mu + tauy / max(rate, 1e-300), mumax);
    }
    MPM_INLINE double slope(double rate) const
    {
      const double inv = 1.0 / max(rate, 1e-150);
      return mu + tauy * inv < mumax ? -tauy * inv * inv : 0.0;
    }
  };

  constexpr Parameter CONSISTENCY = {"", "K", "pressure time^N", POSITIVE, REQUIRED, "consistency"};

  /** Viscous stress with a power of the shear rate; K and N are the first two parameters. */
  struct PowerOfRate {
    double k, n, steepness;

    explicit PowerOfRate(const LawParameters &p) :
        k(p.value[0]), n(p.value[1]), steepness(max(n, 1.0))
    {
    }

    /** Apparent viscosity for the stress yield + K rate^N. */
    MPM_INLINE double viscosity(double rate, double yield) const
    {
      const double g = max(rate, 1e-100);
      return (yield + k * pow(g, n)) / g;
    }
    /** Derivative of viscosity() with respect to the rate. */
    MPM_INLINE double slope_of_viscosity(double rate, double yield) const
    {
      const double g = max(rate, 1e-100);
      return ((n - 1.0) * k * pow(g, n) - yield) / (g * g);
    }
  };

  /** Herschel-Bulkley fluid (W.H. Herschel, R. Bulkley, Kolloid-Z. 39 (1926) 291), with a largest
   *  viscosity as in the Bingham fluid: tau = min(MUMAX g, TAUY + K g^N). */
  struct ViscosityHerschelBulkley : GeneralizedNewtonian<ViscosityHerschelBulkley>, PowerOfRate {
    static constexpr const char *name = "herschel/bulkley";
    static constexpr const char *meaning = "Herschel-Bulkley fluid, bi-viscous";
    enum { K, N, TAUY, MUMAX };
    static constexpr Parameter parameters[] = {
        CONSISTENCY,
        {"", "N", "1", POSITIVE, REQUIRED, "exponent of the shear rate"},
        {"", "TAUY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in shear"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "largest viscosity, that below yield"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};

    double tauy, mumax;

    explicit ViscosityHerschelBulkley(const LawParameters &p) :
        PowerOfRate(p), tauy(p.value[TAUY]), mumax(p.value[MUMAX])
    {
    }
    MPM_INLINE double apparent(double rate) const { return min(viscosity(rate, tauy), mumax); }
    MPM_INLINE double slope(double rate) const
    {
      const double here = slope_of_viscosity(rate, tauy);
      return viscosity(rate, tauy) < mumax ? here : 0.0;
    }
  };

  /** Power-law fluid of Ostwald and de Waele (W. Ostwald, Kolloid-Z. 36 (1925) 99): the apparent
   *  viscosity at the shear rate g is K g^(N-1), within MUMIN and MUMAX. */
  struct ViscosityPower : GeneralizedNewtonian<ViscosityPower>, PowerOfRate {
    static constexpr const char *name = "power";
    static constexpr const char *meaning = "power-law fluid";
    enum { K, N, MUMIN, MUMAX };
    static constexpr Parameter parameters[] = {
        CONSISTENCY,
        {"", "N", "1", POSITIVE, REQUIRED, "exponent, below 1: thins with the shear rate"},
        {"", "MUMIN", "pressure time", NOT_NEGATIVE, REQUIRED, "smallest viscosity"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "largest viscosity"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MUMAX] >= p.value[MUMIN] ? nullptr : "MUMAX must not be below MUMIN";
    }

    double mumin, mumax;

    explicit ViscosityPower(const LawParameters &p) :
        PowerOfRate(p), mumin(p.value[MUMIN]), mumax(p.value[MUMAX])
    {
    }
    MPM_INLINE double apparent(double rate) const
    {
      return min(max(viscosity(rate, 0.0), mumin), mumax);
    }
    MPM_INLINE double slope(double rate) const
    {
      const double eta = viscosity(rate, 0.0), here = slope_of_viscosity(rate, 0.0);
      return eta > mumin && eta < mumax ? here : 0.0;
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

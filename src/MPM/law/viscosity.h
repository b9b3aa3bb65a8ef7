/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_H
#define MPM_LAW_VISCOSITY_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Speed c raised for a shear and a bulk viscosity. Explicit steps with damping:
   *  dt = h / (sqrt(c^2 + a^2) + a), a = (4/3 mu + zeta) / (density h), the central-difference limit
   *  (2/omega)(sqrt(1 + xi^2) - xi) with omega = 2 c/h. */
  MPM_INLINE double damped_speed(const LawParameters &p, const Batch &b, int i, double c, double mu,
                                 double zeta)
  {
    const double a = ((4.0 / 3.0) * mu + zeta) * b.J[i] / (p.density * b.h);
    return std::sqrt(c * c + a * a) + a;
  }

  /** Declarations and viscous stress of fluids with a power of the shear rate. */
  constexpr Parameter CONSISTENCY = {"", "K", "pressure time^N", POSITIVE, REQUIRED, "consistency"};
  struct PowerOfRate {
    double k, n, steepness;

    PowerOfRate(double k, double n) : k(k), n(n), steepness(max(n, 1.0)) {}

    /** Apparent viscosity of the stress yield + K rate^N. */
    MPM_INLINE double viscosity(double rate, double yield) const
    {
      const double g = max(rate, 1e-100);
      return (yield + k * pow(g, n)) / g;
    }
  };

  /** History of a generalized Newtonian fluid; at rest it has the viscosity of this parameter. */
  constexpr HistoryDeclaration apparent_viscosity(int parameter)
  {
    return {"viscosity", parameter, "pressure time", "apparent viscosity"};
  }

  /** Loops of a generalized Newtonian fluid (R.B. Bird, R.C. Armstrong, O. Hassager, Dynamics of
   *  Polymeric Liquids 1, 1987, ch. 4): adds 2 eta dev(D) with an apparent viscosity eta of the
   *  shear rate sqrt(2 dev(D):dev(D)), D the strain rate half-way in the step.
   *
   *  Fluid is made from the parameters and has apparent(rate), the viscosity at a rate, and steepness,
   *  a bound of the slope of stress over rate in units of the apparent viscosity. History: the
   *  apparent viscosity of the last step, which the stable time step needs, and for output. */
  template <class Fluid> struct GeneralizedNewtonian : LawDefaults {
    static constexpr StressShare share = DEVIATOR;
    static constexpr bool uses_speed = false, uses_F = false;
    static constexpr int nhistory(const LawParameters &) { return 1; }

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
  };

}    // namespace
}    // namespace MPM_NS::law

#endif

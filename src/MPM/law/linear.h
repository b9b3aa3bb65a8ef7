/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_LINEAR_H
#define MPM_LAW_LINEAR_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Isotropic hypoelasticity: Jaumann rate of the Kirchhoff stress tau = J sigma,
   *
   *    tau^J = 2 mu dev(D) + K tr(D) I,   the integral of tr(D) over a step being ln(J/J_old)
   *
   *  The rate of tau, not of sigma, makes tau_m^2/(2 K) + dev(tau):dev(tau)/(4 mu) a stored energy
   *  whose change is the stress power on any path. Small strain: Hooke's law. Old stress is kept.
   */
  struct LawLinear : LawDefaults, BulkAndShear {
    static constexpr bool uses_F = false;
    static constexpr const char *name = "linear";
    static constexpr const char *meaning = "isotropic linear elastic, rate form";
    static constexpr StressShare share = WHOLE_STRESS;
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using BulkAndShear::BulkAndShear;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawLinear law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const double J = b.J[i], Jold = b.Jold[i];
        const Sym tau = jaumann(inc, Jold * load_stress(b, i), 2.0 * law.G * deviator(inc.strain));
        store_stress(b, i, (1.0 / J) * add_diagonal(tau, law.K * log(J / Jold)));
      }
    }

    /** J d sigma_nn / d epsilon_nn = lambda + 2 mu - tau_nn; bound of -tau_nn over directions n. In
     *  strong expansion it is negative: the law then has no waves at all. */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const LawLinear law(p);
      const double rest = law.K + (4.0 / 3.0) * law.G, least = LEAST_MODULUS * rest;
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym tau = b.J[i] * load_stress(b, i);
        k[i] += max(rest - (1.0 / 3.0) * trace(tau) + eigenvalue_bound(deviator(tau)), least);
      }
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawLinear law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Sym tau = b.J[i] * load_stress(b, i);
        const double mean = (1.0 / 3.0) * trace(tau);
        w[i] += mean * mean / (2.0 * law.K) + norm2(deviator(tau)) / (4.0 * law.G);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

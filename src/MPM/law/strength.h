/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_H
#define MPM_LAW_STRENGTH_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Elastic deviator that all strengths share: hypoelastic, see LawLinear. */
  struct ElasticDeviator {
    double G;

    /** Cauchy stress deviator at the end of the step if the step is elastic. */
    MPM_INLINE Sym trial(const Batch &b, int i, const Increment &inc) const
    {
      const Sym old = b.Jold[i] * deviator(load_stress(b, i));
      return (1.0 / b.J[i]) * jaumann(inc, old, 2.0 * G * deviator(inc.strain));
    }
  };

  /** Wave speed and energy of a strength whose first parameter is the shear modulus. */
  struct ShearElasticity : LawDefaults {
    static constexpr bool uses_F = false;
    static constexpr StressShare share = DEVIATOR;

    /** J ds_nn / d epsilon_nn = 4/3 G - J s_nn */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const double G = p.value[0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        k[i] += (4.0 / 3.0) * G + b.J[i] * eigenvalue_bound(deviator(load_stress(b, i)));
    }

    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const double G = p.value[0];
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i];
        w[i] += J * J * norm2(deviator(load_stress(b, i))) / (4.0 * G);
      }
    }
  };

  /** Elastic shear without yield. */
  struct StrengthElastic : ShearElasticity {
    static constexpr const char *name = "elastic";
    static constexpr const char *meaning = "elastic shear, no yield";
    static constexpr Parameter parameters[] = {SHEAR_MODULUS};

    static void update(const LawParameters &p, Batch &b, History)
    {
      const ElasticDeviator elastic{p.value[0]};
      MPM_SIMD
      for (int i = 0; i < b.n; i++) store_stress(b, i, elastic.trial(b, i, increment(b, i)));
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

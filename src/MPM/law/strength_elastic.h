/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STRENGTH_ELASTIC_H
#define MPM_LAW_STRENGTH_ELASTIC_H

#include "law/strength.h"

namespace MPM_NS::law {
namespace {

  /** Elastic shear without yield. */
  struct StrengthElastic : ShearElasticity {
    static constexpr const char *name = "elastic";
    static constexpr const char *meaning = "elastic shear, no yield";
    static constexpr StressShare share = DEVIATOR;
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

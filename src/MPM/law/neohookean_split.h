/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_NEOHOOKEAN_SPLIT_H
#define MPM_LAW_NEOHOOKEAN_SPLIT_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Neo-Hookean solid with change of volume uncoupled from change of shape, in the form that most
   *  finite element programs use (P.J. Flory, Trans. Faraday Soc. 57 (1961) 829; R.W. Ogden,
   *  Non-Linear Elastic Deformations, 1984, ch. 7.4):
   *
   *    w = G/2 (I1 - 3) + K/2 (J - 1)^2,   I1 = tr b*,  b* = J^(-2/3) b
   *    J sigma = G dev(b*) + K J (J - 1) I
   *
   *  The energy is finite at J = 0: for compression beyond about one half take another law. */
  struct LawNeoHookeanSplit : IsotropicHyperelastic<LawNeoHookeanSplit>, BulkAndShear {
    static constexpr const char *name = "neohookean/split";
    static constexpr const char *meaning = "neo-Hookean, volume change uncoupled";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at small strain"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio at small strain"}};

    using BulkAndShear::BulkAndShear;

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double u = expm1(shape.logJ);
      return add_diagonal(G * deviator(shape.z), K * (1.0 + u) * u);
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double u = expm1(shape.logJ);
      return 0.5 * G * shape.first() + 0.5 * K * u * u;
    }

    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const LawNeoHookeanSplit law(p);
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        respond_ogden(law.G, 2.0, r, i);
        const double J = exp(r.logJ[i]);
        respond_mean(law.K * J * (J - 1.0), law.K * J * (2.0 * J - 1.0), r, i);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

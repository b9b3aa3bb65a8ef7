/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_HENCKY_H
#define MPM_LAW_HENCKY_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Hyperelastic solid that is linear in the logarithmic (Hencky) strain e = ln(b)/2
   *  (H. Hencky, Z. Techn. Phys. 9 (1928) 215; L. Anand, J. Appl. Mech. 46 (1979) 78):
   *
   *    w = G dev(e):dev(e) + K/2 ln^2 J,   J sigma = 2 G dev(e) + K ln J I
   */
  struct LawHencky : IsotropicHyperelastic<LawHencky>, BulkAndShear {
    static constexpr const char *name = "hencky";
    static constexpr const char *meaning = "hyperelastic, linear in logarithmic strain";
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using BulkAndShear::BulkAndShear;

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Displacement H = displacement(b, i);
      Spectral s = spectral(left_strain(H));
      const double logJ = log_volume(H), mean = (1.0 / 3.0) * logJ;
      for (int a = 0; a < 3; a++) s.value[a] = 2.0 * G * (log_strain(s.value[a]) - mean) + K * logJ;
      return recompose(s, s.value);
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Displacement H = displacement(b, i);
      const Spectral s = spectral(left_strain(H));
      const double logJ = log_volume(H), mean = (1.0 / 3.0) * logJ;
      double square = 0.0;
      for (int a = 0; a < 3; a++) {
        const double d = log_strain(s.value[a]) - mean;
        square += d * d;
      }
      return G * square + 0.5 * K * logJ * logJ;
    }

    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const LawHencky law(p);
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        for (int a = 0; a < 3; a++) {
          r.tau[a][i] = 2.0 * law.G * (r.e[a][i] - (1.0 / 3.0) * r.logJ[i]);
          r.A[a][i] = (4.0 / 3.0) * law.G;
          r.A[a + 3][i] = -(2.0 / 3.0) * law.G;
        }
        respond_mean(law.K * r.logJ[i], law.K, r, i);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_NEOHOOKEAN_H
#define MPM_LAW_NEOHOOKEAN_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Compressible neo-Hookean solid in the logarithmic form (J. Simo, K. Pister, Comput. Methods
   *  Appl. Mech. Eng. 46 (1984) 201; J. Bonet, R. Wood, Nonlinear Continuum Mechanics, eq. 6.27):
   *
   *    w = mu/2 (tr b - 3 - 2 ln J) + lambda/2 ln^2 J
   *    sigma = [mu (b - I) + lambda ln J I] / J
   */
  struct LawNeoHookean : LawDefaults, LameModuli {
    static constexpr const char *name = "neohookean";
    static constexpr const char *meaning = "compressible neo-Hookean hyperelastic";
    static constexpr Parameter parameters[] = {
        {"", "E", "pressure", POSITIVE, REQUIRED, "Young's modulus at small strain"},
        {"", "NU", "1", POISSON_RATIO, REQUIRED, "Poisson's ratio at small strain"}};

    using LameModuli::LameModuli;

    static void update(const LawParameters &p, Batch &b, History)
    {
      const LawNeoHookean law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const double J = b.J[i], inv = 1.0 / J;
        const Sym bb = left_cauchy_green(b, i);
        store_stress(b, i, add_diagonal(law.mu * inv * bb, (law.lambda * log(J) - law.mu) * inv));
      }
    }

    /** Acoustic tensor: J rho c^2 = mu n.b.n + mu + lambda (1 - ln J), largest along the longest
     *  principal stretch. */
    static void modulus(const LawParameters &p, const Batch &b, History, double *k)
    {
      const LawNeoHookean law(p);
      const double least = LEAST_MODULUS * (law.lambda + 2.0 * law.mu);
      MPM_SIMD
      for (int i = 0; i < b.n; i++)
        k[i] += max(law.mu * (largest_principal(left_cauchy_green(b, i)) + 1.0) +
                        law.lambda * (1.0 - log(b.J[i])),
                    least);
    }

    /** With H = F - I and det F - 1 = tr H + minors + det H, the terms of first order in H are
     *  taken out of tr b - 3 - 2 ln J by hand: small strains keep full relative precision. */
    static void energy(const LawParameters &p, const Batch &b, History, double *w)
    {
      const LawNeoHookean law(p);
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Displacement H = displacement(b, i);
        const double square = H.xx * H.xx + H.xy * H.xy + H.xz * H.xz + H.yx * H.yx + H.yy * H.yy +
            H.yz * H.yz + H.zx * H.zx + H.zy * H.zy + H.zz * H.zz;
        const double J = b.J[i], logJ = log(J);
        w[i] += 0.5 * law.mu *
                (square - 2.0 * (H.minors() + H.determinant()) + 2.0 * minus1_minus_log(J)) +
            0.5 * law.lambda * logJ * logJ;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_STVENANT_KIRCHHOFF_H
#define MPM_LAW_STVENANT_KIRCHHOFF_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Second Piola-Kirchhoff stress linear in the Green-Lagrange strain E = (F^T F - I)/2
   *  (R.W. Ogden, Non-Linear Elastic Deformations, 1984, ch. 4.4):
   *
   *    w = lambda/2 tr^2(E) + mu E:E,   J sigma = F [lambda tr(E) I + 2 mu E] F^T
   *
   *  with F E F^T = (b^2 - b)/2. It softens in compression, and under uniaxial compression below a
   *  stretch of 1/sqrt(3) the stress falls. */
  struct LawStVenantKirchhoff : IsotropicHyperelastic<LawStVenantKirchhoff>, LameModuli {
    static constexpr const char *name = "stvenant/kirchhoff";
    static constexpr const char *meaning = "hyperelastic, linear in Green-Lagrange strain";
    static constexpr Parameter parameters[] = {YOUNGS_MODULUS, POISSONS_RATIO};

    using LameModuli::LameModuli;

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Sym g = left_strain(displacement(b, i));    // b - I; b^2 - b = b g = g + g^2
      const double t = 0.5 * lambda * trace(g);
      return add_diagonal((t + mu) * g + mu * square(g), t);
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Sym e = green_lagrange(displacement(b, i));
      const double t = trace(e);
      return 0.5 * lambda * t * t + mu * norm2(e);
    }

    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const LawStVenantKirchhoff law(p);
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        const double x = exp(2.0 * r.e[0][i]), y = exp(2.0 * r.e[1][i]);
        const double z = exp(2.0 * r.e[2][i]), t = 0.5 * law.lambda * (x + y + z - 3.0);
        // second Piola-Kirchhoff stresses
        const double Sx = t + law.mu * (x - 1.0), Sy = t + law.mu * (y - 1.0);
        const double Sz = t + law.mu * (z - 1.0), M = law.lambda + 2.0 * law.mu;
        r.tau[0][i] = x * Sx;
        r.tau[1][i] = y * Sy;
        r.tau[2][i] = z * Sz;
        r.A[0][i] = x * (2.0 * Sx + M * x);
        r.A[1][i] = y * (2.0 * Sy + M * y);
        r.A[2][i] = z * (2.0 * Sz + M * z);
        r.A[3][i] = law.lambda * x * y;
        r.A[4][i] = law.lambda * x * z;
        r.A[5][i] = law.lambda * y * z;
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_MOONEY_RIVLIN_H
#define MPM_LAW_MOONEY_RIVLIN_H

#include "law/hyperelastic.h"

namespace MPM_NS::law {
namespace {

  /** Rubber after M. Mooney, J. Appl. Phys. 11 (1940) 582, and R.S. Rivlin, Phil. Trans. R. Soc. A
   *  241 (1948) 379, with change of volume uncoupled from change of shape:
   *
   *    w = C10 (I1 - 3) + C01 (I2 - 3) + K/4 (J^2 - 1 - 2 ln J)
   *
   *  I1, I2: traces of b* = J^(-2/3) b and of its inverse. With z = b* - I,
   *
   *    J sigma = dev[2 C10 z + 2 C01 ((1 + tr z) z - z^2)] + K/2 (J^2 - 1) I
   *
   *  Shear modulus at small strain: 2 (C10 + C01). */
  struct LawMooneyRivlin : IsotropicHyperelastic<LawMooneyRivlin> {
    static constexpr const char *name = "mooney/rivlin";
    static constexpr const char *meaning = "rubber with two invariants, compressible";
    static constexpr Parameter parameters[] = {
        {"", "C10", "pressure", POSITIVE, REQUIRED, "coefficient of the first invariant"},
        {"", "C01", "pressure", NOT_NEGATIVE, REQUIRED, "coefficient of the second invariant"},
        {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus"}};

    double C10, C01;
    VolumeEnergy volume;

    explicit LawMooneyRivlin(const LawParameters &p) :
        C10(p.value[0]), C01(p.value[1]), volume{p.value[2]}
    {
    }

    MPM_INLINE Sym kirchhoff(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double c = 2.0 * C10 + 2.0 * C01 * (1.0 + shape.first());
      return add_diagonal(deviator(c * shape.z + (-2.0 * C01) * square(shape.z)),
                          volume.stress(shape.logJ));
    }

    MPM_INLINE double stored(const Batch &b, int i) const
    {
      const Isochoric shape(b, i);
      const double first = shape.first();
      // det(I + z) = 1: trace of the inverse = 3 + 2 tr(z) + minors(z)
      const double second = 2.0 * first + minors(shape.z);
      return C10 * first + C01 * second + volume.stored(shape.logJ);
    }

    static void respond(const LawParameters &p, int n, PrincipalResponse &r)
    {
      const LawMooneyRivlin law(p);
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        respond_ogden(2.0 * law.C10, 2.0, r, i);
        respond_ogden(-2.0 * law.C01, -2.0, r, i);
        const double logJ = r.logJ[i];
        respond_mean(law.volume.stress(logJ), law.volume.derivative(logJ), r, i);
      }
    }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

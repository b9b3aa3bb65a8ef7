/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_POLYNOMIAL_H
#define MPM_LAW_EOS_POLYNOMIAL_H

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** Polynomial in mu = density/density_0 - 1, with the internal energy E per reference volume: the
   *  linear polynomial of hydrocodes (J.O. Hallquist, LS-DYNA Theory Manual, 2006, chapter on
   *  equations of state) with coefficients of its own in tension, as in AUTODYN:
   *
   *    compression  p = A1 mu + A2 mu^2 + A3 mu^3 + (B0 + B1 mu) E
   *    tension      p = T1 mu + T2 mu^2 + B0 E
   */
  struct EosPolynomial : LinearInEnergy<EosPolynomial> {
    static constexpr const char *name = "polynomial";
    static constexpr const char *meaning = "polynomial in density, linear in energy";
    enum { A1, A2, A3, B0, B1, T1, T2, E0, CUTOFF, SPALL };
    static constexpr Parameter parameters[] = {
        {"", "A1", "pressure", POSITIVE, REQUIRED, "bulk modulus"},
        {"", "A2", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the square in compression"},
        {"", "A3", "pressure", ANY_NUMBER, REQUIRED, "coefficient of the cube in compression"},
        {"", "B0", "1", NOT_NEGATIVE, REQUIRED, "coefficient of the energy"},
        {"", "B1", "1", ANY_NUMBER, REQUIRED, "coefficient of mu times energy in compression"},
        {"", "T1", "pressure", NOT_NEGATIVE, 0.0, "linear coefficient in tension, 0: A1"},
        {"", "T2", "pressure", ANY_NUMBER, 0.0, "coefficient of the square in tension"},
        {"energy", "E0", "pressure", NOT_NEGATIVE, 0.0, "initial energy per reference volume"},
        {"cutoff", "PMIN", "pressure", TENSION, -UNBOUNDED, "lowest pressure, not positive"},
        {"spall", "PSPALL", "pressure", TENSION, -UNBOUNDED,
         "pressure, not positive, below which the material breaks and bears no tension any more"}};
    static constexpr HistoryDeclaration history[] = {
        {"energy", E0, "pressure", "internal energy per reference volume"},
        {"heat", ZERO, "pressure", "part of it that was dissipated"},
        {"spalled", ZERO, "1", "1 when the material has broken"}};
    static constexpr int nhistory(const LawParameters &p)
    {
      return p.value[SPALL] > -UNBOUNDED ? 3 : 2;
    }
    static constexpr const char *check(const LawParameters &p)
    {
      return Tension::check(p.value[CUTOFF], p.value[SPALL]);
    }

    double a1, a2, a3, b0, b1, t1, t2, least;
    Tension tension;

    explicit EosPolynomial(const LawParameters &p) :
        a1(p.value[A1]), a2(p.value[A2]), a3(p.value[A3]), b0(p.value[B0]), b1(p.value[B1]),
        t1(p.value[T1] > 0.0 ? p.value[T1] : a1), t2(p.value[T2]), least(LEAST_MODULUS * a1),
        tension(p.value[CUTOFF], p.value[SPALL])
    {
    }

    MPM_INLINE double gamma(double J) const { return b0 + b1 * max((1.0 - J) / J, 0.0); }

    MPM_INLINE double cold(double J) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (a2 + mu * a3), stretched = t1 + mu * t2;
      return mu * (J < 1.0 ? squeezed : stretched);
    }

    MPM_INLINE double slope(double J, double E) const
    {
      const double mu = (1.0 - J) / J;
      const double squeezed = a1 + mu * (2.0 * a2 + 3.0 * mu * a3) + b1 * E;
      const double stretched = t1 + 2.0 * mu * t2;
      return (J < 1.0 ? squeezed : stretched) / (J * J);
    }
  };

}    // namespace
}    // namespace MPM_NS::law

#endif

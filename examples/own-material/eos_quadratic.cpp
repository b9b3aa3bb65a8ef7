/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// An equation of state that is not part of the package: everything that it takes.

#include "law/plugin.h"

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** p = K u + K2 u^2 with u = density/density_0 - 1. */
  struct EosQuadratic : Barotropic<EosQuadratic> {
    static constexpr const char *name = "quadratic";
    static constexpr const char *meaning = "pressure quadratic in density";
    static constexpr Parameter parameters[] = {
        {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus"},
        {"", "K2", "pressure", NOT_NEGATIVE, REQUIRED, "coefficient of the square"}};

    double K, K2;
    explicit EosQuadratic(const LawParameters &p) : K(p.value[0]), K2(p.value[1]) {}
    MPM_INLINE double pressure(double J) const
    {
      const double u = (1.0 - J) / J;
      return u * (K + K2 * u);
    }
    // - J dp/dJ * J, at least a small part of K where the liquid is torn apart
    MPM_INLINE double bulk(double J) const { return max(K + 2.0 * K2 * (1.0 - J) / J, 0.01 * K); }
    // integral of p from J to 1
    MPM_INLINE double stored(double J) const
    {
      return K * minus1_minus_log(J) - K2 * (J - 1.0 / J - 2.0 * log(J));
    }
  };

}    // namespace
}    // namespace MPM_NS::law

MPM_LAW_PLUGIN(MPM_LAW(EOS, EosQuadratic))

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_EOS_LINEAR_H
#define MPM_LAW_EOS_LINEAR_H

#include "law/eos.h"

namespace MPM_NS::law {
namespace {

  /** p = K (density/density_0 - 1) = K (1/J - 1): the linear term of the polynomial equation of
   *  state of hydrocodes. Sound speed sqrt(K/density_0) at any density; tension stays below K. */
  struct EosLinear : Barotropic<EosLinear> {
    static constexpr const char *name = "linear";
    static constexpr const char *meaning = "pressure linear in density";
    static constexpr Parameter parameters[] = {
        {"", "K", "pressure", POSITIVE, REQUIRED, "bulk modulus"}};

    double K;

    explicit EosLinear(const LawParameters &p) : K(p.value[0]) {}
    MPM_INLINE double pressure(double J) const { return K * (1.0 - J) / J; }
    MPM_INLINE double bulk(double) const { return K; }
    MPM_INLINE double stored(double J) const { return K * minus1_minus_log(J); }
  };

}    // namespace
}    // namespace MPM_NS::law
#endif

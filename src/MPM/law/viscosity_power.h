/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_POWER_H
#define MPM_LAW_VISCOSITY_POWER_H

#include "law/viscosity.h"

namespace MPM_NS::law {
namespace {

  /** Power-law fluid of Ostwald and de Waele (W. Ostwald, Kolloid-Z. 36 (1925) 99): the apparent
   *  viscosity at the shear rate g is K g^(N-1), within MUMIN and MUMAX. */
  struct ViscosityPower : GeneralizedNewtonian<ViscosityPower> {
    static constexpr const char *name = "power";
    static constexpr const char *meaning = "power-law fluid";
    enum { K, N, MUMIN, MUMAX };
    static constexpr Parameter parameters[] = {
        CONSISTENCY,
        {"", "N", "1", POSITIVE, REQUIRED, "exponent, below 1: thins with the shear rate"},
        {"", "MUMIN", "pressure time", NOT_NEGATIVE, REQUIRED, "smallest viscosity"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "largest viscosity"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MUMAX] >= p.value[MUMIN] ? nullptr : "MUMAX must not be below MUMIN";
    }

    PowerOfRate power;
    double mumin, mumax, steepness;

    explicit ViscosityPower(const LawParameters &p) :
        power(p.value[K], p.value[N]), mumin(p.value[MUMIN]), mumax(p.value[MUMAX]),
        steepness(power.steepness)
    {
    }
    MPM_INLINE double apparent(double rate) const
    {
      return min(max(power.viscosity(rate, 0.0), mumin), mumax);
    }
  };

}    // namespace
}    // namespace MPM_NS::law

#endif

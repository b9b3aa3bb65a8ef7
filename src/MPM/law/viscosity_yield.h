/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_VISCOSITY_YIELD_H
#define MPM_LAW_VISCOSITY_YIELD_H

#include "law/viscosity.h"

namespace MPM_NS::law {
namespace {

  /** Bingham fluid (E.C. Bingham, Fluidity and Plasticity, 1922), in the bi-viscous form of
   *  E.J. O'Donovan, R.I. Tanner, J. Non-Newtonian Fluid Mech. 15 (1984) 75: at the shear rate g the
   *  equivalent shear stress is
   *
   *    tau = min(MUMAX g, TAUY + MU g)
   *
   *  Below TAUY MUMAX / (MUMAX - MU) the material creeps with the viscosity MUMAX. */
  struct ViscosityBingham : GeneralizedNewtonian<ViscosityBingham> {
    static constexpr const char *name = "bingham";
    static constexpr const char *meaning = "Bingham fluid, bi-viscous";
    enum { MU, TAUY, MUMAX };
    static constexpr Parameter parameters[] = {
        {"", "MU", "pressure time", NOT_NEGATIVE, REQUIRED, "plastic viscosity"},
        {"", "TAUY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in shear"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "viscosity below yield"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};
    static constexpr const char *check(const LawParameters &p)
    {
      return p.value[MUMAX] > p.value[MU] ? nullptr : "MUMAX must be above MU";
    }

    double mu, tauy, mumax, steepness;

    explicit ViscosityBingham(const LawParameters &p) :
        mu(p.value[MU]), tauy(p.value[TAUY]), mumax(p.value[MUMAX]), steepness(1.0)
    {
    }
    MPM_INLINE double apparent(double rate) const
    {
      return min(mu + tauy / max(rate, 1e-300), mumax);
    }
  };

  /** Herschel-Bulkley fluid (W.H. Herschel, R. Bulkley, Kolloid-Z. 39 (1926) 291), with a largest
   *  viscosity as in the Bingham fluid: tau = min(MUMAX g, TAUY + K g^N). */
  struct ViscosityHerschelBulkley : GeneralizedNewtonian<ViscosityHerschelBulkley> {
    static constexpr const char *name = "herschel/bulkley";
    static constexpr const char *meaning = "Herschel-Bulkley fluid, bi-viscous";
    enum { K, N, TAUY, MUMAX };
    static constexpr Parameter parameters[] = {
        CONSISTENCY,
        {"", "N", "1", POSITIVE, REQUIRED, "exponent of the shear rate"},
        {"", "TAUY", "pressure", NOT_NEGATIVE, REQUIRED, "yield stress in shear"},
        {"", "MUMAX", "pressure time", POSITIVE, REQUIRED, "largest viscosity, that below yield"}};
    static constexpr HistoryDeclaration history[] = {apparent_viscosity(MUMAX)};

    PowerOfRate power;
    double tauy, mumax, steepness;

    explicit ViscosityHerschelBulkley(const LawParameters &p) :
        power(p.value[K], p.value[N]), tauy(p.value[TAUY]), mumax(p.value[MUMAX]),
        steepness(power.steepness)
    {
    }
    MPM_INLINE double apparent(double rate) const
    {
      return min(power.viscosity(rate, tauy), mumax);
    }
  };

}    // namespace
}    // namespace MPM_NS::law

#endif

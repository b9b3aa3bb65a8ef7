/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_LIST_H
#define MPM_LAW_LIST_H

// All constitutive laws by family. A new law is a struct in a header and one entry here. The kernels
// of a family are compiled on their own, once for each instruction set (MPM_ISA: base, v3, v4, with
// the matching -march): the build writes a file with MPM_LAW_FAMILY(family) for each family.

#include "law/critical_state.h"
#include "law/damage_brittle.h"
#include "law/damage_ductile.h"
#include "law/elastic.h"
#include "law/eos_energy.h"
#include "law/granular.h"
#include "law/gurson.h"
#include "law/mohr_coulomb.h"
#include "law/orthotropic.h"
#include "law/rubber.h"
#include "law/strength_j2.h"
#include "law/strength_thermal.h"
#include "law/thermal.h"
#include "law/viscosity.h"
#include "law/viscosity_generalized.h"
#include "law/viscosity_maxwell.h"
#include "transfer/isa.h"

namespace MPM_NS::law {
namespace {

  /** Laws for one place in a material that are compiled in one file. */
  template <Part PART, class... Laws> struct Family {
    static constexpr Part part = PART;
    static constexpr int size = sizeof...(Laws);
    static constexpr LawKernels table[size + 1] = {
        kernels<Laws>()...};    // there is no empty array
  };

  using elastic =
      Family<CLOSED, LawLinear, LawNeoHookean, LawNeoHookeanSplit, LawStVenantKirchhoff, LawHencky,
             LawMooneyRivlin, LawOgden, LawTransverselyIsotropic, LawOrthotropic>;
  using viscoelastic = Family<VISCOSITY, ViscosityMaxwell>;
  using soil =
      Family<CLOSED, LawDruckerPrager, LawMohrCoulomb, LawCamClay, LawNacc, LawMuI, LawSnow>;
  using porous = Family<CLOSED, LawGurson>;
  using eos = Family<EOS, EosLinear, EosShock, EosTait, EosPolynomial, EosIdealGas, EosStiffenedGas,
                     EosJWL>;
  using strength = Family<STRENGTH, StrengthElastic, StrengthJ2, StrengthJohnsonCook,
                          StrengthSteinberg, StrengthZerilliArmstrong>;
  using viscosity = Family<VISCOSITY, ViscosityNewtonian, ViscosityArtificial, ViscosityBingham,
                           ViscosityHerschelBulkley, ViscosityPower>;
  using damage =
      Family<DAMAGE, DamageJohnsonCook, DamageCockcroftLatham, DamageRankine, DamageGradyKipp>;
  using thermal = Family<THERMAL, ThermalAdiabatic, ThermalConstant>;

}    // namespace
}    // namespace MPM_NS::law

// in the order in which laws are listed in messages
#define MPM_LAW_FAMILIES(X) \
  X(elastic) X(viscoelastic) X(soil) X(porous) X(eos) X(strength) X(viscosity) X(damage) X(thermal)

/** Defines mpm_laws_<family>_<isa>(), which returns the kernels of the family in the order of its list. */
#define MPM_LAW_FAMILY(family)                         \
  namespace MPM_NS {                                   \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)(); \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)()  \
    {                                                  \
      return law::family::table;                       \
    }                                                  \
  }

#endif

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
// the matching -march): the build writes a file with MPM_LAW_FAMILY(family) for each family. It defines
// MPM_ONE_FAMILY and MPM_LAWS_<family>, so that it does not depend on the laws of the others.

#include "law/law.h"
#include "transfer/isa.h"

#ifndef MPM_ONE_FAMILY
#define MPM_LAWS_elastic
#define MPM_LAWS_viscoelastic
#define MPM_LAWS_frictional
#define MPM_LAWS_soil
#define MPM_LAWS_porous
#define MPM_LAWS_eos
#define MPM_LAWS_strength
#define MPM_LAWS_impact
#define MPM_LAWS_viscosity
#define MPM_LAWS_damage
#define MPM_LAWS_thermal
#endif

namespace MPM_NS::law {
namespace {

  /** Laws for one place in a material that are compiled in one file. */
  template <Part PART, class... Laws> struct Family {
    static constexpr Part part = PART;
    static constexpr int size = sizeof...(Laws);
    static constexpr LawKernels table[size + 1] = {
        kernels<Laws>()...};    // there is no empty array
  };

}    // namespace
}    // namespace MPM_NS::law

#ifdef MPM_LAWS_elastic
#include "law/elastic.h"
#include "law/orthotropic.h"
#include "law/rubber.h"
namespace MPM_NS::law {
namespace {
  using elastic =
      Family<CLOSED, LawLinear, LawNeoHookean, LawNeoHookeanSplit, LawStVenantKirchhoff, LawHencky,
             LawMooneyRivlin, LawOgden, LawTransverselyIsotropic, LawOrthotropic>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_viscoelastic
#include "law/viscosity_maxwell.h"
namespace MPM_NS::law {
namespace {
  using viscoelastic = Family<VISCOSITY, ViscosityMaxwell>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_frictional
#include "law/granular.h"
#include "law/mohr_coulomb.h"
namespace MPM_NS::law {
namespace {
  using frictional = Family<CLOSED, LawDruckerPrager, LawMohrCoulomb>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_soil
#include "law/critical_state.h"
#include "law/granular.h"
namespace MPM_NS::law {
namespace {
  using soil = Family<CLOSED, LawCamClay, LawNacc, LawMuI, LawSnow>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_porous
#include "law/gurson.h"
namespace MPM_NS::law {
namespace {
  using porous = Family<CLOSED, LawGurson>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_eos
#include "law/eos_energy.h"
namespace MPM_NS::law {
namespace {
  using eos = Family<EOS, EosLinear, EosShock, EosTait, EosPolynomial, EosIdealGas, EosStiffenedGas,
                     EosJWL>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_strength
#include "law/strength_j2.h"
namespace MPM_NS::law {
namespace {
  using strength = Family<STRENGTH, StrengthElastic, StrengthJ2>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_impact
#include "law/strength_thermal.h"
namespace MPM_NS::law {
namespace {
  using impact = Family<STRENGTH, StrengthJohnsonCook, StrengthSteinberg, StrengthZerilliArmstrong>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_viscosity
#include "law/viscosity.h"
#include "law/viscosity_generalized.h"
namespace MPM_NS::law {
namespace {
  using viscosity = Family<VISCOSITY, ViscosityNewtonian, ViscosityArtificial, ViscosityBingham,
                           ViscosityHerschelBulkley, ViscosityPower>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_damage
#include "law/damage_brittle.h"
#include "law/damage_ductile.h"
namespace MPM_NS::law {
namespace {
  using damage =
      Family<DAMAGE, DamageJohnsonCook, DamageCockcroftLatham, DamageRankine, DamageGradyKipp>;
}
}    // namespace MPM_NS::law
#endif

#ifdef MPM_LAWS_thermal
#include "law/thermal.h"
namespace MPM_NS::law {
namespace {
  using thermal = Family<THERMAL, ThermalAdiabatic, ThermalConducting, ThermalConstant>;
}
}    // namespace MPM_NS::law
#endif

// in the order in which laws are listed in messages
#define MPM_LAW_FAMILIES(X) \
  X(elastic)                \
  X(viscoelastic)           \
  X(frictional) X(soil) X(porous) X(eos) X(strength) X(impact) X(viscosity) X(damage) X(thermal)

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

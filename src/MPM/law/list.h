/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_LIST_H
#define MPM_LAW_LIST_H

// All constitutive laws by family. A new law is a struct in a header and one entry here. The
// kernels of a family are compiled on their own, once for each instruction set (MPM_ISA: base, v3,
// v4, with the matching -march): the build writes a file with MPM_LAW_FAMILY(family) for each
// family. It defines MPM_ONE_FAMILY and MPM_LAWS_<family>, so that it does not depend on the laws
// of the others.

#include "law/law.h"
#include "transfer/isa.h"

namespace MPM_NS::law {
namespace {

  /** Laws for one place in a material that are compiled together in one file. */
  template <Part PART, class... Laws> struct Family {
    static constexpr Part part = PART;
    static constexpr int size = sizeof...(Laws);
    static constexpr LawKernels table[size + 1] = {
        kernels<Laws>()...};    // there is no empty array
  };

}    // namespace
}    // namespace MPM_NS::law

/** Defines a family: its place in a material and the structs of its laws. */
#define MPM_FAMILY(name, ...)           \
  namespace MPM_NS::law {               \
    namespace {                         \
      using name = Family<__VA_ARGS__>; \
    }                                   \
  }

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_elastic)
#include "law/elastic.h"
#include "law/orthotropic.h"
#include "law/rubber.h"
#include "law/woven.h"
MPM_FAMILY(elastic, CLOSED, LawLinear, LawNeoHookean, LawNeoHookeanSplit, LawStVenantKirchhoff,
           LawHencky, LawCorotated, LawMooneyRivlin, LawOgden, LawTransverselyIsotropic,
           LawOrthotropic, LawWoven)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_viscoelastic)
#include "law/viscosity_maxwell.h"
MPM_FAMILY(viscoelastic, VISCOSITY, ViscosityMaxwell)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_frictional)
#include "law/granular.h"
#include "law/mohr_coulomb.h"
MPM_FAMILY(frictional, CLOSED, LawDruckerPrager, LawMohrCoulomb)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_soil)
#include "law/critical_state.h"
#include "law/granular.h"
MPM_FAMILY(soil, CLOSED, LawCamClay, LawNacc, LawMuI, LawSnow)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_porous)
#include "law/gurson.h"
MPM_FAMILY(porous, CLOSED, LawGurson)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_eos)
#include "law/eos_energy.h"
MPM_FAMILY(eos, EOS, EosLinear, EosShock, EosTait, EosPolynomial, EosIdealGas, EosStiffenedGas,
           EosJWL)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_strength)
#include "law/strength_j2.h"
MPM_FAMILY(strength, STRENGTH, StrengthElastic, StrengthJ2)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_impact)
#include "law/strength_thermal.h"
MPM_FAMILY(impact, STRENGTH, StrengthJohnsonCook, StrengthSteinberg, StrengthZerilliArmstrong)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_viscosity)
#include "law/viscosity.h"
MPM_FAMILY(viscosity, VISCOSITY, ViscosityNewtonian, ViscosityArtificial, ViscosityBingham,
           ViscosityHerschelBulkley, ViscosityPower)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_damage)
#include "law/damage.h"
#include "law/phase_field.h"
MPM_FAMILY(damage, DAMAGE, DamageJohnsonCook, DamageCockcroftLatham, DamageRankine, DamageGradyKipp,
           DamagePhaseField)
#endif

#if !defined(MPM_ONE_FAMILY) || defined(MPM_LAWS_thermal)
#include "law/thermal.h"
MPM_FAMILY(thermal, THERMAL, ThermalAdiabatic, ThermalConducting, ThermalConstant)
#endif

// families in the order in which messages list their laws
#define MPM_LAW_FAMILIES(X) \
  X(elastic)                \
  X(viscoelastic)           \
  X(frictional) X(soil) X(porous) X(eos) X(strength) X(impact) X(viscosity) X(damage) X(thermal)

/** Defines mpm_laws_<family>_<isa>(), which returns the kernels of the laws of a family in their
 *  order. */
#define MPM_LAW_FAMILY(family)                         \
  namespace MPM_NS {                                   \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)(); \
    const LawKernels *MPM_OF_ISA(mpm_laws_##family)()  \
    {                                                  \
      return law::family::table;                       \
    }                                                  \
  }

#endif

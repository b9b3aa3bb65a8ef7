/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_LIST_H
#define MPM_LAW_LIST_H

// All constitutive laws. A new law is one header and one entry here.

#include "law/camclay.h"
#include "law/damage_cockcroft_latham.h"
#include "law/damage_grady_kipp.h"
#include "law/damage_johnson_cook.h"
#include "law/damage_rankine.h"
#include "law/drucker_prager.h"
#include "law/eos_gas.h"
#include "law/eos_jwl.h"
#include "law/eos_linear.h"
#include "law/eos_polynomial.h"
#include "law/eos_shock.h"
#include "law/eos_tait.h"
#include "law/gurson.h"
#include "law/hencky.h"
#include "law/linear.h"
#include "law/mohr_coulomb.h"
#include "law/mooney_rivlin.h"
#include "law/mui.h"
#include "law/nacc.h"
#include "law/neohookean.h"
#include "law/neohookean_split.h"
#include "law/ogden.h"
#include "law/orthotropic.h"
#include "law/snow.h"
#include "law/strength_elastic.h"
#include "law/strength_j2.h"
#include "law/strength_johnson_cook.h"
#include "law/strength_steinberg.h"
#include "law/strength_zerilli_armstrong.h"
#include "law/stvenant_kirchhoff.h"
#include "law/thermal.h"
#include "law/viscosity_artificial.h"
#include "law/viscosity_maxwell.h"
#include "law/viscosity_newtonian.h"
#include "law/viscosity_power.h"
#include "law/viscosity_yield.h"

namespace MPM_NS::law {
namespace {

  /** Laws for one place in a material that are compiled in one file, laws_<family>_isa.cpp. */
  template <Part PART, class... Laws> struct Family {
    static constexpr Part part = PART;
    static constexpr int size = sizeof...(Laws);
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

// in the order in which laws are listed in messages
#define MPM_LAW_FAMILIES(X) \
  X(elastic) X(viscoelastic) X(soil) X(porous) X(eos) X(strength) X(viscosity) X(damage) X(thermal)

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAW_LIST_H
#define LMP_MPM_LAW_LIST_H

// All constitutive laws. A new law is one header and one entry here.

#include "mpm_damage_cockcroft_latham.h"
#include "mpm_damage_grady_kipp.h"
#include "mpm_damage_johnson_cook.h"
#include "mpm_damage_rankine.h"
#include "mpm_eos_gas.h"
#include "mpm_eos_jwl.h"
#include "mpm_eos_linear.h"
#include "mpm_eos_polynomial.h"
#include "mpm_eos_shock.h"
#include "mpm_eos_tait.h"
#include "mpm_law_camclay.h"
#include "mpm_law_drucker_prager.h"
#include "mpm_law_gurson.h"
#include "mpm_law_hencky.h"
#include "mpm_law_linear.h"
#include "mpm_law_mohr_coulomb.h"
#include "mpm_law_mooney_rivlin.h"
#include "mpm_law_mui.h"
#include "mpm_law_nacc.h"
#include "mpm_law_neohookean.h"
#include "mpm_law_neohookean_split.h"
#include "mpm_law_ogden.h"
#include "mpm_law_orthotropic.h"
#include "mpm_law_snow.h"
#include "mpm_law_stvenant_kirchhoff.h"
#include "mpm_strength_elastic.h"
#include "mpm_strength_j2.h"
#include "mpm_strength_johnson_cook.h"
#include "mpm_strength_steinberg.h"
#include "mpm_strength_zerilli_armstrong.h"
#include "mpm_thermal.h"
#include "mpm_viscosity_artificial.h"
#include "mpm_viscosity_maxwell.h"
#include "mpm_viscosity_newtonian.h"
#include "mpm_viscosity_power.h"
#include "mpm_viscosity_yield.h"

namespace MPM_NS::law {
namespace {

  /** Laws for one place in a material that are compiled in one file, mpm_laws_<family>_isa.cpp. */
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

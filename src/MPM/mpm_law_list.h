/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAW_LIST_H
#define LMP_MPM_LAW_LIST_H

// All constitutive laws. A new law is one header and one entry here.

#include "mpm_eos_linear.h"
#include "mpm_eos_shock.h"
#include "mpm_eos_tait.h"
#include "mpm_law_linear.h"
#include "mpm_law_neohookean.h"
#include "mpm_strength_elastic.h"
#include "mpm_strength_j2.h"
#include "mpm_strength_johnson_cook.h"
#include "mpm_viscosity_artificial.h"
#include "mpm_viscosity_newtonian.h"

namespace MPM_NS::law {
namespace {

  template <class... Laws> struct List {
  };

  using ClosedLaws = List<LawLinear, LawNeoHookean>;
  using EosLaws = List<EosLinear, EosShock, EosTait>;
  using StrengthLaws = List<StrengthElastic, StrengthJ2, StrengthJohnsonCook>;
  using ViscosityLaws = List<ViscosityNewtonian, ViscosityArtificial>;

}    // namespace
}    // namespace MPM_NS::law
#endif

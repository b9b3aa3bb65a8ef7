/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_checks.h"

#include "base/mpm_options.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "input.h"
#include "material/material.h"
#include "material/material_point.h"
#include "modify.h"
#include "variable.h"

#include <cmath>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMPoreChecks::check_soils() const
{
  std::set<std::string> known;
  for (const auto &soil : options.soils) {
    auto *const fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!fix)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore soil: there is no fix mpm/material {}",
                 soil.material);
    if (!known.insert(soil.material).second)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore has soil {} twice", soil.material);
    fix->mass_varies = true;
    const double grains = fix->material->density() - soil.porosity * options.water.density;
    if (soil.retention.can_dry() && !(grains > 0.0))
      error->all(FLERR, Error::NOLASTLINE,
                 "The density of fix mpm/material {} is below that of the water in its pores: fix "
                 "mpm/pore takes it for that of the soil with full pores",
                 soil.material);
    if (soil.warms && fix->temperature() < 0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore expansion: soil {} has no temperature: its material needs a thermal "
                 "part",
                 soil.material);
    if (!soil.warms && fix->material->is_thermoelastic())
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/pore: the stress of soil {} changes with its temperature, and so would the "
          "pressure of the water, as if grains and water did not expand: use expansion with "
          "what both do, three times that of the material for the grains",
          soil.material);
    if (soil.law != MPMPoreSoil::FORMULA) continue;
    const int index = input->variable->find(soil.formula.c_str() + 2);
    if (index < 0 || !input->variable->atomstyle(index))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/pore soil {} {}",
                 soil.formula.substr(2), soil.material,
                 index < 0 ? "does not exist" : "is not atom-style");
  }
}

/** Bulk modulus of the soil without its water, for new points: by a compression that is small, and
 *  slow for any viscosity. */
static double bulk_modulus(const Material &material)
{
  constexpr double SMALL = 1.0e-6, LONG = 1.0e12;
  const double A[9] = {-SMALL, 0.0, 0.0, 0.0, -SMALL, 0.0, 0.0, 0.0, -SMALL};
  MaterialPoint point(material);
  const double before = point.pressure();
  point.move(A, LONG);
  return (point.pressure() - before) / (1.0 - point.batch.J[0]);
}

/** Checks soils with grains that are not rigid. The moduli of grains and soil give the coefficient
 *  of Biot, 1 - K/Ks. No arrangement of grains is stiffer than their share of the volume (Voigt),
 *  so this coefficient is not below the porosity. */
void MPMPoreChecks::check_grains()
{
  constexpr double CLOSE = 0.1, ROUNDED = 1.001;    // coefficients of Biot; numbers of few digits
  if (grains_known) return;
  for (const auto &soil : options.soils) {
    const auto *const fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!(soil.grains > 0.0)) continue;
    const double K = bulk_modulus(*fix->material), most = (1.0 - soil.porosity) * soil.grains;
    if (K > most * ROUNDED)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore biot: grains with the bulk modulus {:.6g} make no soil with that of "
                 "fix mpm/material {}, {:.6g}, but with at most (1 - n0) Ks = {:.6g}: Ks is that "
                 "of the mineral",
                 soil.grains, soil.material, K, most);
    const double alpha = 1.0 - K / soil.grains;
    if (comm->me == 0 && fabs(alpha - soil.biot) > CLOSE)
      error->warning(FLERR,
                     "Fix mpm/pore: soil {} has the coefficient of Biot {:.4g}, but its bulk "
                     "modulus at first, {:.4g}, and that of its grains, {:.4g}, make 1 - K/Ks = "
                     "{:.4g}: pressures and settlements go by the former",
                     soil.material, soil.biot, K, soil.grains, alpha);
  }
  grains_known = true;
}

void MPMPoreChecks::warn_of_soils(const std::vector<int> &here, bool has_weight) const
{
  std::vector<int> anywhere(here.size(), 0);
  MPI_Allreduce(here.data(), anywhere.data(), (int) here.size(), MPI_INT, MPI_MAX, world);
  for (std::size_t k = 0; k < options.soils.size() && comm->me == 0; k++) {
    const auto &soil = options.soils[k];
    const auto *const fix =
        dynamic_cast<const FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!fix) continue;    // init() reports this
    const double density = fix->material->density(), water = soil.porosity * options.water.density;
    if (!anywhere[k])
      error->warning(FLERR,
                     "Fix mpm/pore {} has no points of soil {}: only points of the fix "
                     "mpm/material that soil names have water",
                     id, soil.material);
    else if (has_weight && density <= water)
      error->warning(FLERR,
                     "Fix mpm/pore {}: soil {} has the density {:.6g}, which is not more than "
                     "that of the water in its pores, {:.6g}, so that grains have a weight "
                     "below zero: it must be that of saturated soil",
                     id, soil.material, density, water);
  }
}

void MPMPoreChecks::check_implicit() const
{
  const auto refuse = [&](bool broken, const char *what, const char *remedy) {
    if (broken)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore {} cannot be used with fix mpm/implicit: {}", what, remedy);
  };
  refuse(options.formulation == MPMPoreOptions::U_V_P, "formulation u-v-p",
         "slow flow has no inertia of its own, use formulation u-p, or explicit steps");
  refuse(options.sets_relax, "relax", "it is of the waves of explicit steps, remove it");
  refuse(options.sets_stages, "stages", "the flow of an implicit step has none, remove it");
  refuse(options.sets_every && options.waits(), "every",
         "soil and water are solved for together, remove it");
  for (const auto &soil : options.soils) {
    refuse(soil.retention.can_dry(), "retention",
           "use explicit steps, or leave it out where pores stay full");
    refuse(soil.of_grains != 0.0 || soil.of_water != 0.0, "expansion", "use explicit steps");
    refuse(!soil.is_linear(), "forchheimer", "use explicit steps, or leave it out for slow flow");
  }
}

void MPMPoreChecks::check_motion(const Fix &fix, MPMField &field) const
{
  refuse_field(
      lmp, fix, field,
      {{field.options.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
        "formulation u-v-p takes a part off the mass of nodes: use apic, aflip, or flip"}});
  for (const auto *material : field.materials)
    for (const auto &soil : options.soils)
      if (soil.material == material->id &&
          material->material->density() <= soil.porosity * options.water.density)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/pore formulation u-v-p: soil {} has the density {}, which is not more "
                   "than that of the water in its pores, {}: it must be that of saturated soil",
                   soil.material, material->material->density(),
                   soil.porosity * options.water.density);
}

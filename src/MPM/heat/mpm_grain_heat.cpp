/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The step of LAMMPS with grains and points:

     initial_integrate   fix mpm moves points and conducts; nodes get what waits
     post_integrate      temperatures of points to atom->temperature
     pre_force           fix heat/flow sends temperatures to ghosts, and clears atom->heatflow
     force               the pair style adds the power between two that touch to atom->heatflow
     final_integrate     fix heat/flow brings home what ghosts got; new temperatures of grains
     end_of_step         heat dt * heatflow of points: it waits

   so that what leaves grains and what comes to points is the same number, also when the time step
   changes.
------------------------------------------------------------------------- */

#include "heat/mpm_grain_heat.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "fix.h"
#include "force.h"
#include "heat/mpm_conduction.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

// LAMMPS may be built without its package GRANULAR
#if __has_include(<pair_granular.h>)
#include <gran_sub_mod_heat.h>
#include <granular_model.h>
#include <pair_granular.h>
#endif

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Has a pair style a model for heat? Only data of its classes are used, which LAMMPS may lack. */
static bool has_heat([[maybe_unused]] const MPMPairStyle &style)
{
#if __has_include(<pair_granular.h>)
  if (style.name != "granular") return false;
  auto *const pair = static_cast<PairGranular *>(style.pair);
  return std::any_of(pair->models_list, pair->models_list + pair->nmodels, [](const auto *model) {
    return model->heat_model && model->heat_model->name != "none";
  });
#else
  return false;
#endif
}

void MPMGrainHeat::init()
{
  if (!atom->temperature_flag || !atom->heatflow_flag)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat grains: atoms have no temperature and heat flow: define fix ID all "
               "property/atom temperature heatflow ghost yes");
  const auto movers = modify->get_fix_by_style("^heat/flow$");
  if (movers.empty())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/heat grains: nothing moves the temperatures of grains: define a fix heat/flow "
        "for their group");
  fields = MPMField::all(lmp);
  for (const auto *mover : movers) {
    int mine[2] = {0, 0}, any[2];    // points, atoms without a radius
    for (int i = 0; i < atom->nlocal; i++) {
      if (!(atom->mask[i] & mover->groupbit)) continue;
      if (atom->vfrac[i] > 0.0)
        mine[0] = 1;
      else if (!atom->radius || !(atom->radius[i] > 0.0))
        mine[1] = 1;
    }
    MPI_Allreduce(mine, any, 2, MPI_INT, MPI_MAX, world);
    if (any[1])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat grains: fix heat/flow {} has atoms without a radius in its group: "
                 "points exchange heat with grains, and none with atoms of molecular dynamics: "
                 "give it the group of the grains, or drop the keyword",
                 mover->id);
    if (any[0])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat grains: fix heat/flow {} has material points in its group, whose "
                 "temperatures belong to fix mpm/heat: give it the group of the grains",
                 mover->id);
  }
  const auto pairs = MPMPairStyle::all(*force);
  if (std::none_of(pairs.begin(), pairs.end(), has_heat) &&
      find_fixes(lmp, {"^wall/gran", "^add/heat$"}).empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat grains: no heat goes through contacts: give pair_coeff of pair style "
               "granular the keyword heat, or drop the keyword grains");
  warn_of_set();
  show();
}

/** Of a point; null: none, or the atom is no point. */
const FixMPMMaterial *MPMGrainHeat::material_of(int i) const
{
  if (!(atom->vfrac[i] > 0.0)) return nullptr;
  for (const auto *field : fields)
    if (field->is_point(i)) return field->material_of(i);
  return nullptr;
}

/** Of the command set, which gives temperatures to the atoms, while the material has those of
 *  points. */
void MPMGrainHeat::warn_of_set()
{
  constexpr double ROUND_OFF = 1.0e-9;
  bigint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++) {
    const auto *const material = material_of(i);
    const int column = material ? material->temperature() : -1;
    if (column < 0 || atom->temperature[i] == 0.0) continue;
    const double T = material->history[i][column];
    mine += std::fabs(atom->temperature[i] - T) > ROUND_OFF * std::fabs(T);
  }
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/heat grains: {} points have the temperature of their material, not "
                   "the one that they were given as atoms (set ... temperature), which is "
                   "replaced: give that of the start in their fix mpm/material",
                   all);
}

void MPMGrainHeat::show()
{
  for (int i = 0; i < atom->nlocal; i++) {
    const auto *const material = material_of(i);
    const int column = material ? material->temperature() : -1;
    if (column >= 0) atom->temperature[i] = material->history[i][column];
  }
}

void MPMGrainHeat::note_step()
{
  dt = update->dt;
}

double MPMGrainHeat::take()
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0) || atom->heatflow[i] == 0.0) continue;
    const auto *const material = material_of(i);
    if (!material || !material->material->conducts())
      error->one(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/heat grains: heat flows to point {}, whose material does not conduct: give "
          "it a part thermal conducting, or pairs of its type no conductance",
          atom->tag[i]);
    const double heat = dt * atom->heatflow[i];
    waiting[i][0] += heat;
    sum += heat;
  }
  return sum;
}

double MPMGrainHeat::sum_waiting() const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++) sum += waiting[i][0];
  return sum;
}

void MPMGrainHeat::give(MPMConduction &conduction)
{
  clear_points(energy, atom);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!conduction.field.is_point(i)) continue;
    energy[i] = waiting[i][0];
    waiting[i][0] = 0.0;
  }
  conduction.give(energy);
}

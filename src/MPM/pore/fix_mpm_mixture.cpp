/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/fix_mpm_mixture.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "contact/fix_mpm_contact.h"
#include "contact/pair_mpm_penalty.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "material/material.h"
#include "modify.h"
#include "pore/fix_mpm_pore.h"

#include <algorithm>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

FixMPMMixture::FixMPMMixture(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), mixture(lmp, options, id)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/mixture acts on nodes, which have no group: use group all; soil and water "
               "are the fields that are named");
  Options declared = options.declare();
  read_options(lmp, declared, narg, arg, 3);
  if (options.soil_id == options.water_id)
    error->all(FLERR, 4,
               "Fix mpm/mixture needs two fields: define a fix mpm for the soil and another one "
               "for the water");
  options.viscosity *= force->ftm2v / force->nktv2p;
  scalar_flag = vector_flag = 1;
  size_vector = 6;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
}

/** Missing fields are found here; with them, they call init_action() */
void FixMPMMixture::init()
{
  for (const auto &name : {options.soil_id, options.water_id})
    if (!MPMField::find(lmp, name))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/mixture {}: {} is not the ID of a fix mpm: define one fix mpm for the "
                 "soil and one for the water",
                 id, name);
}

void FixMPMMixture::init_action()
{
  FixMPMMixture::init();
  mixture.soil.field = MPMField::find(lmp, options.soil_id);
  mixture.water.field = MPMField::find(lmp, options.water_id);
  const auto &a = mixture.soil.field->lattice, &b = mixture.water.field->lattice;
  const auto &os = mixture.soil.field->options, &ow = mixture.water.field->options;
  if (a.h != b.h || os.shape != ow.shape || !std::equal(a.origin, a.origin + 3, b.origin))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mixture {}: fields {} and {} must have the same lattice (node spacing and "
               "origin) and shape function",
               id, options.soil_id, options.water_id);
  for (auto *field : {mixture.soil.field, mixture.water.field}) {
    const auto &o = field->options;
    field->shares_room = true;
    refuse_field(
        lmp, *this, *field,
        {{o.shape != QUADRATIC && o.shape != CUBIC, "this shape", "use shape quadratic or cubic"},
         {o.total, "frame total", "its nodes are not where the soil is: use frame updated"},
         {o.axisymmetric, "axisymmetric", "use a plane or 3d"},
         {o.modified_edges, "edges modified", "use edges plain"},
         {o.has_light_nodes(), "light", "leave it out: it is for shape linear"},
         {o.stress_before(), "scheme usf and usavg",
          "these strain the water before the soil has moved: use usl or musl"},
         {o.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
          "use apic, aflip, or flip"}});
  }
  refuse_field(lmp, *this, *mixture.water.field,
               {{ow.averages_strain(), "locking fbar and both",
                 "the soil changes the volume of the water, too: use smooth"}});

  bigint mine[2] = {0, 0}, all[2];
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    if ((atom->mask[i] & mixture.soil.field->fix.groupbit) &&
        mixture.grains(i) > (1.0 - MPMMixture::LEAST) * atom->vfrac[i])
      mine[0]++;
    if (!(atom->mask[i] & mixture.water.field->fix.groupbit)) continue;
    const auto *material = mixture.water.field->material_of(i);
    if (material && !material->material->is_barotropic()) mine[1]++;
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[1])
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/mixture {}: {} points of the water (fix mpm {}) are no fluid whose pressure "
        "depends on its density alone: use eos tait or linear, without strength and history "
        "variables, of which the temperature of thermal conducting is one",
        id, all[1], options.water_id);
  if (all[0])
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/mixture {}: {} points of the soil (fix mpm {}) have no pores: their density "
        "must be that of dry soil, the share of the grains times the density of these, {}",
        id, all[0], options.soil_id, options.grain_density);

  for (auto *other : modify->get_fix_by_style("^mpm/mixture$")) {
    if (other == this) continue;
    const auto *second = dynamic_cast<FixMPMMixture *>(other);
    for (const auto &name : {options.soil_id, options.water_id})
      if (second->has(name))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/mixture {} and {} have the field {} in common: there can be only one "
                   "soil and one water in a mixture",
                   id, other->id, name);
  }
  for (auto *other : modify->get_fix_by_style("^mpm/contact$"))
    if (dynamic_cast<FixMPMContact *>(other)->couples(options.soil_id, options.water_id))
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/mixture {}: fix mpm/contact {} keeps the water out of the soil: leave one "
          "of these fields out there",
          id, other->id);
  auto *const penalty = dynamic_cast<PairMPMPenalty *>(force->pair_match("mpm/penalty", 0));
  if (penalty && penalty->couples(options.soil_id, options.water_id))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/mixture {}: pair style mpm/penalty keeps the water out of the soil: give "
               "the types of {} and {} a pair_coeff with modulus 0",
               id, options.soil_id, options.water_id);
  for (auto *other : modify->get_fix_by_style("^mpm/pore$")) {
    const auto *pore = dynamic_cast<FixMPMPore *>(other);
    for (const auto *material : mixture.soil.field->materials)
      if (pore->has(material->id) && mixture.shares_points(*material))
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/mixture {}: fix mpm/pore {} has water in the pores of {} already: leave "
            "this soil out there, or drop fix mpm/mixture",
            id, other->id, material->id);
  }
  mixture.lists_valid = false;
}

void FixMPMMixture::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::BEFORE_SOLVE)
    plan.together(
        "pressure of the mixture",
        {Data::POSITION, Data::DEFORMATION, Data::STRESS, Data::NODES, Data::BLOCKS, Data::OWN},
        {Data::NODES, Data::OWN}, [this]() {
          mixture.share_pressure();
        });
  // before the energy of nodes is found
  if (place == MPMPlan::AFTER_ACTIONS)
    plan.together("drag at walls", {Data::NODES, Data::BLOCKS, Data::OWN}, {Data::NODES, Data::OWN},
                  [this]() {
                    mixture.correct_drag_at_walls();
                  });
  if (place == MPMPlan::AFTER_SOLVE)
    plan.together("work in the mixture", {Data::NODES, Data::BLOCKS, Data::OWN}, {Data::OWN},
                  [this]() {
                    mixture.account_for_work();
                  });
  if (place == MPMPlan::BEFORE_STRAIN)
    plan.together("volume of the mixture",
                  {Data::POSITION, Data::DEFORMATION, Data::NODES, Data::BLOCKS, Data::OWN},
                  {Data::DEFORMATION, Data::NODES, Data::OWN}, [this]() {
                    mixture.share_strain();
                  });
}

/** Energy that drag has turned into heat so far. */
double FixMPMMixture::compute_scalar()
{
  double all;
  MPI_Allreduce(&mixture.dissipated, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixMPMMixture::write_restart(FILE *fp)
{
  keep_totals(world, &mixture.dissipated, 1);
  if (comm->me) return;
  const double list[2] = {mixture.dissipated, mixture.meets ? 1.0 : 0.0};
  write_state(fp, list, sizeof(list));
}

void FixMPMMixture::restart(char *buf)
{
  double list[2];
  memcpy(list, read_state(lmp, id, buf, sizeof(list)), sizeof(list));
  if (comm->me == 0) mixture.dissipated = list[0];
  mixture.meets = mixture.pores_known = list[1] != 0.0;
}

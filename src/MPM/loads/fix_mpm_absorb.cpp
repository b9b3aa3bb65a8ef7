/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/fix_mpm_absorb.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_options.h"
#include "base/mpm_region_image.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_coupling.h"
#include "field/mpm_field.h"
#include "field/mpm_guard.h"
#include "field/mpm_setup_checks.h"
#include "material/material.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "region.h"
#include "update.h"

#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

/** fix ID group mpm/absorb region REG keyword value ... */
Options MPMAbsorbOptions::declare()
{
  using namespace option;
  Options o("fix mpm/absorb");
  o.add("region", {text(region_id, "region-ID", "ID of the region in which points are removed")})
      .once()
      .standard("none, must be given");
  o.add("every",
        {integer(look_every, "N", POSITIVE, "look for points to remove every this many steps")});
  o.refuse([=] {
    return OptionRules{{region_id.empty(), "", "needs the keyword region"}};
  });
  return o;
}

FixMPMAbsorb::FixMPMAbsorb(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (!atom->style_match("mpm"))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/absorb needs atom_style mpm, alone or in atom_style hybrid, but the atom style "
        "is {}",
        atom->atom_style);
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);
  if (!domain->get_region_by_id(region_id))
    error->all(FLERR, options.where("region") + 1, "Fix mpm/absorb region {} does not exist",
               region_id);

  nevery = look_every;
  force_reneighbor = 1;
  next_reneighbor = -1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = MPMTraffic::NREAL + 2;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
}

void FixMPMAbsorb::init()
{
  region = domain->get_region_by_id(region_id);
  if (!region)
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/absorb {} does not exist",
               region_id, id);
  for (const auto *other :
       find_fixes(lmp, {"^mpm/elements$", "^mpm/mixture$", "^mpm/handshake$"})) {
    // the group of fix mpm/handshake is that of its atoms; its points are those of a field
    int group_bits = other->groupbit;
    if (const auto *coupling = dynamic_cast<const MPMCoupling *>(other))
      for (const auto *field : MPMField::all(lmp))
        if (coupling->couples(field->id(), other->id)) group_bits = field->fix.groupbit;
    if (points_in_both(lmp, groupbit, group_bits))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/absorb {} cannot remove points of fix {} (style {}), which needs all of "
                 "them: give it another group",
                 id, other->id, other->style);
  }
  for (const auto *field : MPMField::all(lmp)) {
    const bool mine =
        field->options.every > 1 && points_in_both(lmp, groupbit, field->fix.groupbit) > 0;
    refuse_field(
        lmp, *this, *field,
        {{mine, "every", "points would go in between two steps of the cycle: use every 1"}});
  }
}

bool FixMPMAbsorb::absorbs(int i) const
{
  return (atom->mask[i] & groupbit) && atom->vfrac[i] > 0.0 &&
      matches_with_images(*domain, *region, atom->x[i]);
}

/** Heat of a point whose material conducts it, 0 of others: what warmed it from the temperature
 *  that it has at first. */
double FixMPMAbsorb::heat_of(int i) const
{
  const auto *const field = field_of(lmp, i);
  const auto *const fix = field ? field->material_of(i) : nullptr;
  if (!fix || !fix->material->conducts()) return 0.0;
  return atom->rmass[i] * heat_since_start(*fix->material, fix->history[i]);
}

/** The points go with the exchange of this step. */
void FixMPMAbsorb::post_integrate()
{
  waited += update->dt;
  if (update->ntimestep % nevery) return;
  region->prematch();
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal && !mine; i++) mine = absorbs(i);
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) {
    next_reneighbor = update->ntimestep;
    return;
  }
  rate = waited = 0.0;
}

void FixMPMAbsorb::pre_exchange()
{
  if (next_reneighbor != update->ntimestep) return;
  double mine = 0.0, all;
  for (int i = 0; i < atom->nlocal; i++)
    if (absorbs(i)) mine += heat_of(i);
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  heat += all;
  const MPMTraffic gone = remove_points(
      lmp,
      [this](int i) {
        return absorbs(i);
      },
      true);
  total.add(gone);
  rate = gone.mass / waited;
  waited = 0.0;
}

void FixMPMAbsorb::write_restart(FILE *fp)
{
  if (comm->me) return;
  std::vector<double> list(total.reals(), total.reals() + MPMTraffic::NREAL);
  list.insert(list.end(), {rate, waited, heat});
  write_state(fp, list.data(), list.size() * sizeof(double));
}

void FixMPMAbsorb::restart(char *buf)
{
  double list[MPMTraffic::NREAL + 3];
  memcpy(list, read_state(lmp, id, buf, sizeof(list)), sizeof(list));
  std::copy_n(list, MPMTraffic::NREAL, total.reals());
  rate = list[MPMTraffic::NREAL];
  waited = list[MPMTraffic::NREAL + 1];
  heat = list[MPMTraffic::NREAL + 2];
}

/** scalar: mass that has gone; vector: points, mass, momentum, kinetic and stored energy of these,
 *  mass per time, and heat. */
double FixMPMAbsorb::compute_vector(int k)
{
  if (k < MPMTraffic::NREAL) return total.reals()[k];
  return k == MPMTraffic::NREAL ? rate : heat;
}

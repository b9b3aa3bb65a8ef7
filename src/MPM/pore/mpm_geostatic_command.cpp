/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_geostatic_command.h"

#include "base/mpm_gravity.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "field/mpm_field.h"
#include "pore/fix_mpm_mixture.h"
#include "pore/mpm_geostatic.h"
#include "pore/mpm_geostatic_water.h"
#include "step/fix_mpm.h"

#include "comm.h"
#include "error.h"
#include "force.h"
#include "modify.h"

#include <cstring>
#include <string>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   mpm_geostatic fix-ID K0
------------------------------------------------------------------------- */

void MPMGeostaticCommand::command(int narg, char **arg)
{
  const int iarg = 0;
  std::string id;
  double K0 = 0.0;
  Options options("mpm_geostatic");
  options.argument(option::text(id, "fix-ID"));
  options.argument(option::number(K0, "K0", NOT_NEGATIVE));
  read_options(lmp, options, narg, arg, 0);

  MPMField *const field = MPMField::find(lmp, id);
  if (!field)
    error->all(FLERR, iarg, "Mpm_geostatic: there is no fix mpm with the ID {}: define it first",
               id);
  check_fixes();
  check_field(*field);
  lmp->init();

  double gravity[3];
  MPMGravity(lmp, "Mpm_geostatic").find(gravity);
  const auto *const mixture = mixture_of(*field);
  MPMGeostatic ground(lmp, *field, gravity, "Mpm_geostatic");
  std::vector<double> carried;
  if (mixture) carried = MPMGeostaticWater(lmp, ground, *mixture, "Mpm_geostatic").set_pressure();
  const auto none = [](int) {
    return 0.0;
  };
  ground.set_stress(K0, none, carried);
  dynamic_cast<FixMPM *>(modify->get_fix_by_id(id))->rests_dry =
      true;    // fix mpm/pore may come later
  const auto &where = ground.ground();
  if (comm->me == 0)
    utils::logmesg(lmp, "Level ground at rest: {:.6g} high, weight {:.6g} per mass, K0 {:.6g}\n",
                   where.top - where.floor, where.weight, K0);
}

/* ----------------------------------------------------------------------
   the water of these changes what is in equilibrium
------------------------------------------------------------------------- */

void MPMGeostaticCommand::check_fixes()
{
  if (!modify->get_fix_by_style("^mpm/pore$").empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Mpm_geostatic does not know pore water: use keyword geostatic of fix mpm/pore");
}

/** That of which the field is the soil, or null. */
const FixMPMMixture *MPMGeostaticCommand::mixture_of(const MPMField &field)
{
  for (auto *fix : modify->get_fix_by_style("^mpm/mixture$")) {
    const auto *const mixture = dynamic_cast<FixMPMMixture *>(fix);
    if (!mixture->has(field.id())) continue;
    if (strcmp(mixture->soil_field(), field.id()) != 0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Mpm_geostatic: fix mpm {} is the water of fix mpm/mixture {}: name that of the "
                 "soil, {}, and the water gets its pressure, too",
                 field.id(), fix->id, mixture->soil_field());
    check_field(*MPMField::find(lmp, mixture->water_field()));
    return mixture;
  }
  return nullptr;
}

void MPMGeostaticCommand::check_field(const MPMField &field)
{
  const auto &o = field.options;
  refuse_field(
      lmp, "Mpm_geostatic", field,
      {{o.shape != QUADRATIC && o.shape != CUBIC, "this shape", "use shape quadratic or cubic"},
       {o.total, "frame total", "use frame updated"},
       {o.axisymmetric, "axisymmetric", "use a plane or 3d"},
       {o.modified_edges, "edges modified", "use edges plain"},
       {o.averages_stress() || o.averages_volume() || o.averages_strain(), "locking",
        "its averages have other forces: use locking none"}});
}

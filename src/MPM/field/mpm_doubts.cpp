/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_doubts.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "base/mpm_gravity.h"
#include "base/mpm_region_image.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"
#include "material/softening.h"
#include "math_extra.h"
#include "region.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double INF = std::numeric_limits<double>::infinity();

/** Ratios from low to high are doubtful; text: what follows from them, and the remedy. */
struct Doubt {
  double low, high;
  const char *text;
};

// in the order of MPMDoubts::Kind
static const Doubt table[] = {
    {0.0, 0.1,
     "a liquid is as stiff as the skeleton or much stiffer, and this one carries next to no load: "
     "is its bulk modulus in the units of pressure of the input?"},
    {0.05, 1.0,
     "grains would have a mass below zero: it must be that of saturated soil, grains and water "
     "together"},
    {50.0, INF, "are both in the units of density of the input?"},
    {0.0, 1.0e-8,
     "nothing flows: is the coefficient a hydraulic conductivity, in the units of velocity of the "
     "input, and the weight of the water per volume?"},
    {1.0, 1.0, "it is meant for atoms: use timestep, or fix mpm/dt where steps are not implicit"},
    {1.5, INF, "no heat goes there before material comes: is it the right face?"},
    {1.0, INF,
     "the inside of a region is a wall for heat, which goes through its surface only: use a region "
     "that touches the body from outside, or side out"},
    {1.0e-30, 0.35, "radiation needs kelvins: is this one in degrees Celsius?"},
    {1.0e-30, 0.2,
     "is the one in degrees Celsius, and the other in kelvins? Give both in the same units"},
    {1.0, INF,
     "this material has no strength: use a lower initial temperature, or give the melting "
     "temperature in the same units"},
    {1.0, INF,
     "material that gets as warm has no strength: is this meant, and in the units of the melting "
     "temperature?"},
    {1.0e-30, 0.5,
     "it is pressed flat where it stands: are modulus, density, and gravity in the units of the "
     "input?"},
    {1.0, 1.0, "no heat goes there before material comes: is it the right region?"}};

void MPMDoubts::check(Kind kind, double ratio, const std::string &who, const std::string &what)
{
  const Doubt &doubt = table[kind];
  if (told >> kind & 1 || !(ratio >= doubt.low && ratio <= doubt.high)) return;
  told |= 1u << kind;
  if (comm->me == 0) error->warning(FLERR, "{}: {}: {}", who, what, doubt.text);
}

/** Reduced units have no default for atoms of a certain kind, and a pair style may need it. */
void MPMDoubts::check_time_step(const std::string &who)
{
  if (!update->dt_default || force->pair || strcmp(update->unit_style, "lj") == 0 ||
      !find_fixes(lmp, {"^mpm/dt$", "^dt/reset"}).empty())
    return;
  check(TIME_STEP, 1.0, who,
        fmt::format("the time step {:.3g} is the default of units {}, which no command has changed",
                    update->dt, update->unit_style));
}

void MPMDoubts::check_regions()
{
  const auto regions = domain->get_region_list();
  const auto at_low_end = [](const Region &r, int d) {
    return d == 0 ? r.extent_xlo : d == 1 ? r.extent_ylo : r.extent_zlo;
  };
  const auto users = find_fixes<MPMRegionImages>(lmp);
  for (const auto *region : regions) {
    const bool sees = std::any_of(users.begin(), users.end(), [&](const auto *user) {
      return user->sees_images(region->id);
    });
    if (sees) continue;
    for (int d = 0; d < domain->dimension; d++) {
      const double shift = image_shift(*domain, *region, d), least = 1.0e-6 * domain->prd[d];
      if (shift == 0.0) continue;
      const bool has_image = std::any_of(regions.begin(), regions.end(), [&](const Region *other) {
        return image_shift(*domain, *other, d) == -shift &&
            fabs(at_low_end(*other, d) - at_low_end(*region, d) - shift) < least;
      });
      if (has_image || !told_of.insert(region->id).second || comm->me) continue;
      error->warning(FLERR,
                     "Region {} reaches across the periodic face {}{}, and has no image at the "
                     "other end of the box: there it is no wall, body, or surface; {} shifted by "
                     "{:.8g} along {}",
                     region->id, (char) ('x' + d), shift > 0.0 ? "lo" : "hi",
                     region->dynamic
                         ? "add the same fix with a region that moves as it does, and is"
                         : "use a union of it and a region that is",
                     shift, (char) ('x' + d));
    }
  }
}

void MPMDoubts::look_at_regions()
{
  if (--countdown > 0) return;
  countdown = STEPS;
  const auto regions = domain->get_region_list();
  if (std::any_of(regions.begin(), regions.end(), [](const Region *r) {
        return r->dynamic;
      }))
    check_regions();
}

void MPMDoubts::check_temperatures(const MPMField &field)
{
  for (const auto *of : field.materials) {
    const auto range = softening_range(*of->material);
    const int column = of->temperature();
    if (!range || column < 0) continue;
    double mine[2] = {INF, INF}, all[2];    // least, and minus the largest
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field.is_point(i) || field.material_of(i) != of) continue;
      mine[0] = std::min(mine[0], of->history[i][column]);
      mine[1] = std::min(mine[1], -of->history[i][column]);
    }
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MIN, world);
    if (all[0] == INF) continue;
    const std::string who = fmt::format("Fix mpm/material {}", of->id);
    if (range->reference > 0.0)
      check(COLD_METAL, all[0] / range->reference, who,
            fmt::format("the temperature {:.6g} of points is far below the reference temperature "
                        "{:.6g} of their strength",
                        all[0], range->reference));
    if (range->melting > 0.0)
      check(MOLTEN, -all[1] / range->melting, who,
            fmt::format("points begin with the temperature {:.6g}, and their strength ends at the "
                        "melting temperature {:.6g}",
                        -all[1], range->melting));
  }
}

void MPMDoubts::check_weight(const MPMField &field)
{
  double g[3];
  MPMGravity(lmp).find(g);
  const double strength = MathExtra::len3(g);
  if (!(strength > 0.0)) return;
  for (const auto *of : field.materials) {
    if (of->material->is_of_surfaces()) continue;
    const double modulus = MPMRestModuli(*of->material).compression;
    double mine[2] = {-INF, -INF}, all[2];    // highest, and minus the lowest
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field.is_point(i) || field.material_of(i) != of) continue;
      const double height = -MathExtra::dot3(atom->x[i], g) / strength;
      mine[0] = std::max(mine[0], height);
      mine[1] = std::max(mine[1], -height);
    }
    MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
    if (all[0] == -INF) continue;
    const double weight = of->material->density() * strength * (all[0] + all[1]) * force->nktv2p;
    check(SOFT_SOLID, modulus / weight, fmt::format("Fix mpm/material {}", of->id),
          fmt::format("the modulus {:.4g} of this solid is less than the pressure of its own "
                      "weight, {:.4g}",
                      modulus, weight));
  }
}

bool LAMMPS_NS::is_ideal_gas(const Material &material)
{
  return material.describe().find("eos ideal/gas") != std::string::npos;
}

MPMRestModuli::MPMRestModuli(const Material &material)
{
  if (!material.is_solid() || !material.has_tangent()) return;
  MaterialPoint point(material);
  const auto tangent = std::make_unique<Tangent>();
  for (auto &row : point.batch.A) row[0] = 0.0;
  point.batch.Jold[0] = point.batch.J[0];
  material.update_with_tangent(point.batch, *tangent);
  compression = tangent->stress[0][0][0];
  lambda = tangent->stress[0][4][0];
  shear = tangent->stress[3][1][0];
}

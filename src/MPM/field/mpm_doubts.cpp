/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_doubts.h"

#include "atom.h"
#include "base/mpm_find_fixes.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"
#include "material/softening.h"
#include "region.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double INFINITE = 1.0e19;    // LAMMPS has 1e20 for INF in regions
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
     "temperature?"}};

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
  const auto extent = [](const Region &r, int d) {
    const double lo[] = {r.extent_xlo, r.extent_ylo, r.extent_zlo},
                 hi[] = {r.extent_xhi, r.extent_yhi, r.extent_zhi};
    return std::array<double, 2>{lo[d], hi[d]};
  };
  const auto is_known = [](const Region *r) {
    return r->bboxflag && r->interior && !r->dynamic && r->nregion <= 1;
  };
  for (const auto *region : regions) {
    if (!is_known(region)) continue;
    for (int d = 0; d < domain->dimension; d++) {
      const auto [lo, hi] = extent(*region, d);
      const double length = domain->prd[d], least = 1.0e-6 * length;
      const bool below = (lo < domain->boxlo[d] - least), above = (hi > domain->boxhi[d] + least);
      // one that is as long as the box needs no images, and INF means the face of the box
      if (!domain->periodicity[d] || below == above || hi - lo > length - least || lo < -INFINITE ||
          hi > INFINITE || hi < domain->boxlo[d] || lo > domain->boxhi[d])
        continue;
      const double shift = below ? length : -length;
      const bool has_image = std::any_of(regions.begin(), regions.end(), [&](const Region *other) {
        if (!is_known(other)) return false;
        const auto [low, high] = extent(*other, d);
        return fabs(low - lo - shift) < least && fabs(high - hi - shift) < least;
      });
      if (has_image || !told_of.insert(region->id).second || comm->me) continue;
      error->warning(FLERR,
                     "Region {} reaches across the periodic face {}{}, and has no image at the "
                     "other end of the box: there it is no wall, body, or surface; use a union of "
                     "it and a region that is shifted by {:.8g} along {}",
                     region->id, (char) ('x' + d), below ? "lo" : "hi", shift, (char) ('x' + d));
    }
  }
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

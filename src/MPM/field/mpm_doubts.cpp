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
#include "base/mpm_points.h"
#include "base/mpm_region_image.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_node_action.h"
#include "force.h"
#include "material/material.h"
#include "material/material_point.h"
#include "material/softening.h"
#include "math_extra.h"
#include "modify.h"
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
static constexpr double ALONE = 1.5;    // distance of gas from the end of the box [node spacings]
static constexpr double ROUND_OFF = 1.0e-6;    // of depths in walls [node spacings]

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
    {1.0, 1.0, "no heat goes there before material comes: is it the right region?"},
    {0.5, INF,
     "they are kept from going deeper, but not pushed out: create points outside of it only "
     "(region intersect, with one of side out), or use stick to hold them"},
    {1.0, 1.0, "use its keyword gravity, with zeros if it shall have no weight"},
    {1.0, 1.0,
     "it is the divisor of hydraulic conductivities, density times gravity in the units of "
     "pressure over length"},
    {100.0, INF,
     "drag hardly couples them: is the coefficient a hydraulic conductivity, in the units of "
     "velocity of the input, and the weight of the water per volume?"},
    {1.0, 1.0,
     "it expands into the empty part of the box as into vacuum: if air is there, use fix "
     "mpm/traction with free pressure, or a wall at its surface"}};

void MPMDoubts::check(Kind kind, double ratio, const std::string &who, const std::string &what)
{
  const Doubt &doubt = table[kind];
  if (warned >> kind & 1 || !(ratio >= doubt.low && ratio <= doubt.high)) return;
  warned |= 1u << kind;
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

/** Adds a region and its parts, and those of these. */
static void add_parts(Region *region, std::set<const Region *> &parts)
{
  parts.insert(region);
  for (int k = 0; region->nregion > 1 && k < region->nregion; k++)
    add_parts(region->reglist[k], parts);
}

/** Regions may be there for groups, variables, and commands that make points, too, or for
 *  nothing. */
void MPMDoubts::check_regions()
{
  std::set<const Region *> used, seen;    // seen: with their images
  const auto regions = domain->get_region_list();
  for (auto *region : regions)
    for (const auto *user : find_fixes<MPMRegionUser>(lmp))
      if (user->uses_region(region->id)) add_parts(region, user->sees_images() ? seen : used);
  const auto at_low_end = [](const Region &r, int d) {
    return d == 0 ? r.extent_xlo : d == 1 ? r.extent_ylo : r.extent_zlo;
  };
  for (const auto *region : regions) {
    if (!used.count(region) || seen.count(region)) continue;
    for (int d = 0; d < domain->dimension; d++) {
      const double shift = image_shift(*domain, *region, d), least = 1.0e-6 * domain->prd[d];
      if (shift == 0.0) continue;
      const bool has_image = std::any_of(regions.begin(), regions.end(), [&](const Region *other) {
        return used.count(other) && image_shift(*domain, *other, d) == -shift &&
            fabs(at_low_end(*other, d) - at_low_end(*region, d) - shift) < least;
      });
      if (has_image || !warned_of.insert(region->id).second || comm->me) continue;
      error->warning(FLERR,
                     "Region {} reaches across the periodic face {}{}, and has no image at the "
                     "other end of the box: there it is no wall, body, or surface; {} shifted by "
                     "{:.8g} along {}",
                     region->id, (char) ('x' + d), shift > 0.0 ? "lo" : "hi",
                     region->dynamic
                         ? "add the same fix with a region that moves as it does, and is"
                         : region->openflag    // a union of open regions has no inside
                         ? "add the same fix with a region that is"
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
    const bool solid = of->material->is_solid();
    if (!solid && is_ideal_gas(*of->material)) continue;    // it is compressed by its weight
    const double c = solid ? 0.0 : MaterialPoint(*of->material).wave_speed();
    const double modulus = solid ? MPMRestModuli(*of->material).compression
                                 : of->material->density() * c * c * force->mvv2e * force->nktv2p;
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
    check(SOFT_BODY, modulus / weight, fmt::format("Fix mpm/material {}", of->id),
          fmt::format(
              "the {} {:.4g} of this {} is less than the pressure of its own weight, {:.4g}",
              solid ? "modulus" : "bulk modulus", modulus, solid ? "solid" : "liquid", weight));
  }
}

/** Other fixes that may hold a gas have surfaces that are not known here. */
static bool may_hold_gas(const Fix *fix)
{
  const auto *const action = dynamic_cast<const MPMNodeAction *>(fix);
  static const std::set<std::string> others = {"mpm/traction", "mpm/elements", "mpm/airbag",
                                               "mpm/emit",     "mpm/mesh",     "mpm/dashpot",
                                               "mpm/pml"};
  return (action && action->acts_inside()) || others.count(fix->style);
}

void MPMDoubts::check_gas(const std::vector<MPMField *> &fields)
{
  const auto &fixes = modify->get_fix_list();
  if (std::any_of(fixes.begin(), fixes.end(), may_hold_gas)) return;
  double h = 0.0, end[6], ends[6];             // low ends, and minus high ends
  double sums[3] = {0.0, 0.0, 0.0}, all[3];    // energies of pressure and motion, volume
  std::fill_n(end, 6, INF);
  std::vector<char> is_gas(atom->nlocal, 0);
  for (const auto *field : fields)
    for (const auto *of : field->materials) {
      if (!is_ideal_gas(*of->material)) continue;
      h = std::max(h, field->lattice.h);
      for (int i = 0; i < atom->nlocal; i++) {
        if (!field->is_point(i) || field->material_of(i) != of) continue;
        is_gas[i] = 1;
        const double *const tau = field->points->tau[i], J = field->points->jacobian(i);
        const double pressure = -(tau[0] + tau[1] + tau[2]) / (3.0 * J);
        sums[0] += pressure * J * atom->vfrac[i] / force->nktv2p;
        sums[1] += 0.5 * atom->rmass[i] * MathExtra::lensq3(atom->v[i]) * force->mvv2e;
        sums[2] += J * atom->vfrac[i];
        for (int d = 0; d < 3; d++) {
          end[d] = std::min(end[d], atom->x[i][d]);
          end[3 + d] = std::min(end[3 + d], -atom->x[i][d]);
        }
      }
    }
  MPI_Allreduce(end, ends, 6, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(sums, all, 3, MPI_DOUBLE, MPI_SUM, world);
  if (!(all[0] > all[1])) return;    // none, or what flies apart anyway
  for (int d = 0; d < domain->dimension; d++) {
    const double lo = ends[d], hi = -ends[3 + d];
    double empty[2] = {lo - domain->boxlo[d], domain->boxhi[d] - hi};
    if (domain->periodicity[d]) empty[0] = empty[1] = empty[0] + empty[1];
    int mine[2] = {0, 0}, others[2];
    for (int i = 0; i < atom->nlocal; i++) {
      if (is_gas[i]) continue;
      mine[0] |= atom->x[i][d] < lo + h;
      mine[1] |= atom->x[i][d] > hi - h;
    }
    MPI_Allreduce(mine, others, 2, MPI_INT, MPI_MAX, world);
    for (int side = 0; side < 2; side++) {
      const bool fits = domain->boundary[d][side] > 1;    // the box ends where points do
      if (fits || others[side] || (domain->periodicity[d] && others[1 - side]) ||
          !(empty[side] > ALONE * h))
        continue;
      return check(GAS_ALONE, 1.0, "Fix mpm",
                   fmt::format("the pressure of gas is absolute, {:.4g} on average, and nothing is "
                               "next to its end at {} = {:.6g}",
                               all[0] / all[2] * force->nktv2p, (char) ('x' + d),
                               side == 0 ? lo : hi));
    }
  }
}

/** Half a spacing is allowed: bodies of whole points end in steps at inclined and curved
 *  surfaces. */
void MPMDoubts::check_inside(const std::string &who, const std::string &which,
                             const std::vector<MPMField *> &fields,
                             const std::function<double(const double *x, double far)> &distance)
{
  for (const auto *field : fields) {
    const double h = field->lattice.h, least = table[BEGINS_INSIDE].low;
    // the distance is not always known where it is large
    const auto is_deep = [&](const double *x) {
      bool deep = true;
      for (int d = 0; d < field->lattice.dim; d++)
        for (const double way : {-least * h, least * h}) {
          double at[3];
          MathExtra::copy3(x, at);
          at[d] += way;
          deep = deep && distance(at, h) < 0.0;
        }
      return deep;
    };
    bigint mine = 0, all;
    double deepest = 0.0, of_all;
    tagint tag = 0, example;
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      const double depth = -distance(atom->x[i], h) / h;
      if (!(depth > least + ROUND_OFF) || (depth >= 1.0 && !is_deep(atom->x[i]))) continue;
      mine++;
      deepest = std::max(deepest, depth);
      tag = std::max(tag, atom->tag[i]);
    }
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (all == 0) continue;
    MPI_Allreduce(&deepest, &of_all, 1, MPI_DOUBLE, MPI_MAX, world);
    MPI_Allreduce(&tag, &example, 1, MPI_LMP_TAGINT, MPI_MAX, world);
    check(BEGINS_INSIDE, of_all, who,
          fmt::format("{} points of fix mpm {} begin in {}, more than half a node spacing deep, "
                      "for instance point {}",
                      all, field->id(), which, example));
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

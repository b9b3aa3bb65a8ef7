/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_checks.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_gravity.h"
#include "field/mpm_setup_checks.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

static const char *const STYLE = "mpm/incompressible";
// ratio of the volume of a point to that of a cell that is too large
static constexpr double LARGEST_POINT = 1.01;
// kinematic viscosity from which on a fluid keeps surfaces of solids steady, over the spacing and
// the speed of shear waves: blocks in water at rest were steady at 0.4, and disturbances of one of
// them grew at 0.2
static constexpr double STEADY = 0.4;

MPMFlowChecks::MPMFlowChecks(LAMMPS *lmp, const MPMIncompressibleOptions &options,
                             MPMFlowLiquids &liquids, const MPMFlowParts &parts,
                             const std::string &id) :
    Pointers(lmp),
    uncoupled(lmp), options(options), liquids(liquids), parts(parts), id(id),
    who(fmt::format("Fix {} {}", STYLE, id)), doubts(lmp)
{
}

void MPMFlowChecks::check_box() const
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (!parts.cells.is_point(i)) continue;
    for (int d = 0; d < domain->dimension; d++)
      if (!domain->periodicity[d] &&
          !(atom->x[i][d] >= domain->boxlo[d] && atom->x[i][d] <= domain->boxhi[d]))
        error->one(FLERR, Error::NOLASTLINE,
                   "Point {} of fix {} is outside of the box, whose fixed faces are walls",
                   atom->tag[i], STYLE);
  }
}

void MPMFlowChecks::check_points()
{
  bigint mine[2] = {0, 0}, all[2];    // points, and those larger than a cell
  // those of another density: of none of the liquids, each of them, and solids
  std::vector<bigint> others(options.liquids.size() + 2, 0);
  if (parts.solids) check_solids();
  check_laws();
  check_loads();
  for (int i = 0; i < atom->nlocal; i++) {
    if (!parts.cells.is_point(i)) continue;
    const double mass = density(i) * atom->vfrac[i];
    if (!(atom->rmass[i] > 0.0)) atom->rmass[i] = mass;
    mine[0]++;
    if (std::fabs(atom->rmass[i] / mass - 1.0) > MPMFlowLiquids::SAME_DENSITY)
      (is_solid(i) ? others.back() : others[liquids.liquid(atom->mask[i]) + 1])++;
    if (atom->vfrac[i] > LARGEST_POINT * parts.cells.lattice.cell_volume()) mine[1]++;
    for (int d = 0; d < domain->dimension; d++)
      if (!std::isfinite(atom->v[i][d]) || !std::isfinite(atom->x[i][d]))
        error->one(FLERR, Error::NOLASTLINE,
                   "Fix {}: point {} has a position or velocity that is not a number", STYLE,
                   atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[0] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "{} has no material points in its group: make some with create_points", who);
  check_masses(others);
  if (all[1] && comm->me == 0 && !warned_of_size)
    error->warning(FLERR,
                   "{}: {} points are larger than a cell, and leave others empty when they move: "
                   "use points with a spacing of at most {:.6g}, better {:.6g}",
                   who, all[1], options.h, 0.5 * options.h);
  warned_of_size = all[1] > 0;
  check_liquids();
}

/** mine: number of points of this rank whose mass does not fit, see check_points(). */
void MPMFlowChecks::check_masses(const std::vector<bigint> &mine) const
{
  std::vector<bigint> all(mine.size());
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_LMP_BIGINT, MPI_SUM, world);
  const std::size_t nliquid = options.liquids.size();
  for (std::size_t k = 0; k < all.size(); k++)
    if (all[k])
      error->all(
          FLERR, Error::NOLASTLINE,
          "{}: {} points have another mass than {} times their volume: points keep the mass that "
          "they have; give the density of that, by keyword liquid or solid for a group, or "
          "set their mass",
          who, all[k],
          k == 0            ? fmt::format("density {}", options.density)
              : k > nliquid ? "the density of their solid"
                            : fmt::format("density {} of liquid {}", options.liquids[k - 1].density,
                                          options.liquids[k - 1].group));
}

/** Checks the groups of liquids. They have the points that there were at the time of their command;
 *  an empty group is no liquid. */
void MPMFlowChecks::check_liquids()
{
  std::vector<int> mine(options.liquids.size(), 0), all(options.liquids.size(), 0);
  for (std::size_t k = 0; k < options.liquids.size(); k++)
    for (int i = 0; i < atom->nlocal; i++)
      if (parts.cells.is_point(i) && atom->mask[i] & liquids.bits[k]) mine[k] = 1;
  for (const auto *inlet : modify->get_fix_by_style("^mpm/emit$"))    // its points are yet to come
    for (std::size_t k = 0; k < options.liquids.size(); k++)
      if (inlet->groupbit & liquids.bits[k]) mine[k] = 1;
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_INT, MPI_MAX, world);
  for (std::size_t k = 0; k < options.liquids.size(); k++)
    if (!all[k] && comm->me == 0 && !warned_of_liquids)
      error->warning(FLERR,
                     "{}: the group {} of keyword liquid has no points of this fix: put some into "
                     "it, with keyword group of create_points, or with the group command after it",
                     who, options.liquids[k].group);
  warned_of_liquids = true;
}

/** Checks solids, which have laws and perhaps other densities. */
void MPMFlowChecks::check_solids()
{
  parts.solids->check_points();
  double mine[2] = {options.density, -options.density}, all[2];    // greatest, and minus the least
  for (int i = 0; i < atom->nlocal; i++) {
    if (!parts.cells.is_point(i)) continue;
    mine[0] = std::max(mine[0], density(i));
    mine[1] = std::max(mine[1], -density(i));
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
  liquids.least_density = -all[1];
  liquids.has_several_densities =
      all[0] > (1.0 + MPMFlowLiquids::SAME_DENSITY) * liquids.least_density;
}

/** Warns of laws that fluid would have, if it were that of a fix mpm. */
void MPMFlowChecks::check_laws()
{
  for (const auto *law : modify->get_fix_by_style("^mpm/material$")) {
    bigint mine = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
      mine += parts.cells.is_point(i) && atom->mask[i] & law->groupbit &&
          !(parts.solids && parts.solids->holds(i));
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (!all || warned_of_laws) continue;
    warned_of_laws = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "{}: the law of fix mpm/material {} does not act on {} points of fluid, which "
                     "have the density and viscosity of fix {}: give it a group without them, or "
                     "name their group with keyword solid if they are elastic",
                     who, law->id, all, STYLE);
  }
}

/** Warns of loads and surfaces that have points of the flow alone, on which they do not act. */
void MPMFlowChecks::check_loads()
{
  for (const auto *load : find_fixes(lmp, {"^mpm/traction$", "^mpm/surface$"})) {
    bigint mine[2] = {0, 0}, all[2];    // points of the flow, and others
    for (int i = 0; i < atom->nlocal; i++)
      if (atom->mask[i] & load->groupbit) mine[!parts.cells.is_point(i)]++;
    MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
    if (!all[0] || all[1] || warned_of_loads) continue;
    warned_of_loads = true;
    if (comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} {} acts on points of fix mpm, and does nothing here, as all {} "
                     "points of its group are in the flow: remove it, or give it another group",
                     who, load->style, load->id, all[0]);
  }
}

double MPMFlowChecks::density(int i) const
{
  return is_solid(i) ? parts.solids->density_of(i) : liquids.density(atom->mask[i]);
}

bool MPMFlowChecks::is_solid(int i) const
{
  return parts.solids && parts.solids->holds(i);
}

void MPMFlowChecks::check_gas()
{
  const char *const other = parts.bodies           ? "bodies of fix mpm/rigid"
      : parts.regions && parts.regions->any_move() ? "regions that move"
      : parts.grains                               ? "grains of fix mpm/immersed"
      : parts.inflow                               ? "points of fix mpm/emit"
                                                   : nullptr;
  if (other)
    error->all(FLERR, Error::NOLASTLINE,
               "{}: gas cannot be used with {}: remove these, or the keyword gas", who, other);
  if (!parts.regions) return;
  parts.gas->pockets.find_solid(parts.regions.get());
  if (parts.regions->n() > 1 && comm->me == 0 && !warned_of_regions)
    error->warning(FLERR,
                   "{}: forces on its regions are those of the water alone, without the gas, as "
                   "there are several: use a union of them as one region if you need these forces",
                   who);
  warned_of_regions = true;
}

void MPMFlowChecks::look()
{
  uncoupled.look();
  doubts.look_at_regions();
  if (!has_gravity) MPMGravity{lmp};    // has it a direction?
  has_gravity = true;
}

void MPMFlowChecks::check_others(const Fix &mine)
{
  for (const auto *other : modify->get_fix_by_style("^mpm/incompressible$"))
    if (other->id != id)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fluids of fixes {} and {} (style {}) would go through each other: give their "
                 "points to one of these fixes",
                 id, other->id, STYLE);
  uncoupled.begin_run(mine);
  doubts.check_regions();
  if (modify->get_fix_by_style("^mpm$").empty())    // fix mpm would warn of these itself
    warn_of_forgotten_points(lmp, STYLE, "the flow goes through them");
}

void MPMFlowChecks::check_time_step()
{
  doubts.check_time_step(who);
}

void MPMFlowChecks::check_depths() const
{
  bigint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++)
    if (parts.cells.is_point(i) &&
        parts.regions->depth(atom->x[i], 2.0 * options.h) > 0.5 * options.h)
      mine++;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all)
    error->all(FLERR, Error::NOLASTLINE,
               "{}: {} points are in a region, which is solid: create them outside of it", who,
               all);
}

void MPMFlowChecks::check_stiffness()
{
  tagint tag;
  const double mine = std::sqrt(2.0) * parts.solids->stable_dt(tag);
  double most;
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MIN, world);
  if (update->dt > most * (1.0 + 1.0e-9))
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the time step {:.6g} is too large for the stiffness of its solids, which "
               "allows {:.6g}; reduce it, or let fix mpm/dt set it",
               who, update->dt, most);

  // most is sqrt(2) h/(c sqrt(2 dim)), with the speed c of shear waves

  const double h = options.h, speed = h / (most * std::sqrt((double) parts.cells.lattice.dim)),
               enough = STEADY * speed * h;
  if (warned_of_interfaces || liquids.largest_kinematic_viscosity() >= enough) return;
  int mine_fluid = 0, fluid;
  for (int i = 0; i < atom->nlocal && !mine_fluid; i++)
    mine_fluid = parts.cells.is_point(i) && !parts.solids->holds(i);
  MPI_Allreduce(&mine_fluid, &fluid, 1, MPI_INT, MPI_MAX, world);
  if (!fluid) return;
  warned_of_interfaces = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "{}: surfaces of solids this stiff are not stable in a fluid of so little "
        "viscosity: disturbances grow by a factor of e in some {:.2g} time units, until "
        "points leave the solid; give it a viscosity of {:.3g}, or use fix mpm for both, "
        "with fix mpm/contact",
        who, 8.0 * h / speed, enough / liquids.acceleration_per_stress());
}

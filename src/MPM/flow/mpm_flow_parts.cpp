/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_parts.h"

#include "flow/mpm_flow_fourier.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "math_const.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// with surface tension, see MPMFlowPressure::nearest
static constexpr double NEAREST_SURFACE = 1.0e-4;

static const char *const STYLE = "mpm/incompressible";

static MPM_NS::Lattice lattice_of(LAMMPS *lmp, double h)
{
  return {lmp->domain->dimension, h, {0.0, 0.0, 0.0}, {}, {1, 1, 1}};
}

MPMFlowParts::MPMFlowParts(LAMMPS *lmp, const MPMIncompressibleOptions &options,
                           MPMFlowLiquids &liquids, const MPMFlowFields &fields, int groupbit) :
    cells(lmp, lattice_of(lmp, options.h), groupbit)
{
  for (int d = 0; d < cells.lattice.dim; d++)
    for (int s = 0; s < 2; s++) cells.walls[d][s] = options.walls[d][s];
  cells.check_box(STYLE);
  check_walls(lmp, options);
  if (!lmp->atom->tag_enable)
    lmp->error->all(FLERR,
                    "Fix mpm/incompressible tells points from each other by their IDs: remove "
                    "atom_modify id no");

  pressure = std::make_unique<MPMFlowPressure>(lmp, cells);
  if (options.solver == MPMIncompressibleOptions::FOURIER && !MPMFlowFourier::is_there())
    lmp->error->all(FLERR,
                    "Fix mpm/incompressible solver fourier: this program was built without FFTW; "
                    "install it (libfftw3-dev) and build again, or use solver multigrid");
  if (options.solver == MPMIncompressibleOptions::FOURIER) pressure->use_fourier();
  air = std::make_unique<MPMFlowAir>(cells);
  if (options.implicit && liquids.largest_viscosity == 0.0)
    lmp->error->all(
        FLERR,
        "Fix mpm/incompressible implicit yes is about the viscosity: add the keyword viscosity");
  if (options.implicit) {
    stress = std::make_unique<MPMFlowStress>(lmp, cells, *pressure);
    stress->inverse_density = options.liquids.empty() ? nullptr : &fields.inverse_density;
    cells.wants_around = true;
  } else if (liquids.largest_viscosity > 0.0) {
    viscosity = std::make_unique<MPMFlowViscosity>(cells, *pressure);
    cells.wants_around = true;
  }
  if (options.has_several_viscosities())
    viscosities = std::make_unique<MPMFlowViscosities>(cells, options.viscosity);
  for (auto it = options.region_ids.begin(); it != options.region_ids.end(); ++it)
    if (std::count(options.region_ids.begin(), it, *it))
      lmp->error->all(FLERR, "Fix mpm/incompressible has region {} twice: give it once", *it);
  if (!options.region_ids.empty()) {
    regions = std::make_unique<MPMFlowRegions>(lmp, cells, options.region_ids);
    pressure->regions = regions.get();
    cells.wants_around = true;
  }
  if (options.sticks) {
    stick = std::make_unique<MPMFlowStick>(cells, *regions);
    stress->stick = stick.get();
  }
  if (options.tension > 0.0) {
    tension =
        std::make_unique<MPMFlowTension>(cells, *pressure, options.angle * MathConst::DEG2RAD);
    pressure->nearest = NEAREST_SURFACE;
    cells.wants_more = MPMFlowTension::PASSES;
    cells.wants_around = true;
    cells.overlap = MPMFlowWetting::overlap(regions != nullptr);
  }
  liquids.find_groups();
  for (std::size_t k = 0; viscosities && k < options.liquids.size(); k++)
    viscosities->add(liquids.bits[k], options.viscosity_of(options.liquids[k]));
  if (viscosities && stress) stress->viscosities = viscosities.get();
  if (viscosities && viscosity) viscosity->viscosities = viscosities.get();
  if (!options.solid_groups.empty()) add_solids(lmp, options);
  if (options.has_gas) add_gas(lmp, options);
}

void MPMFlowParts::check_walls(LAMMPS *lmp, const MPMIncompressibleOptions &options) const
{
  for (int d = 0; d < cells.lattice.dim; d++)
    for (int s = 0; s < 2; s++) {
      const auto name = std::string(1, (char) ('x' + d)) + (s ? "hi" : "lo");
      if (options.walls[d][s].named && cells.lattice.periodic[d])
        lmp->error->all(
            FLERR, "Fix mpm/incompressible wall {} is a periodic face: use boundary f for a wall",
            name);
      if (options.walls[d][s].v[d] != 0.0)
        lmp->error->all(FLERR,
                        "Fix mpm/incompressible wall {} cannot move out of its plane: its velocity "
                        "along {} must be zero",
                        name, (char) ('x' + d));
    }
}

void MPMFlowParts::add_solids(LAMMPS *lmp, const MPMIncompressibleOptions &options)
{
  int bits = 0;
  for (const auto &one : options.solid_groups) {
    const int igroup = lmp->group->find(one);
    if (igroup < 0)
      lmp->error->all(FLERR, "Fix mpm/incompressible solid: group {} does not exist", one);
    bits |= lmp->group->bitmask[igroup];
  }
  solids = std::make_unique<MPMFlowSolids>(lmp, cells, bits);
}

void MPMFlowParts::add_gas(LAMMPS *lmp, const MPMIncompressibleOptions &options)
{
  const int dim = cells.lattice.dim;
  for (int d = 0; d < dim; d++)
    for (int s = 0; s < 2; s++)
      if (options.open[d][s] && cells.lattice.periodic[d])
        lmp->error->all(FLERR,
                        "Fix mpm/incompressible open {}{}: the box is periodic there, and has no "
                        "such face: use boundary f",
                        (char) ('x' + d), s ? "hi" : "lo");
  gas = std::make_unique<MPMFlowGas>(lmp, cells, *pressure, options.gas_law);
  for (int d = 0; d < dim; d++) std::copy_n(options.open[d], 2, gas->pockets.open[d]);
  gas_rows = std::make_unique<MPMFlowGasRows>(lmp, cells, *pressure, *gas);
  pressure->nearest = NEAREST_SURFACE;
  cells.wants_around = true;
}

void MPMFlowParts::init(LAMMPS *lmp, const MPMIncompressibleOptions &options, int groupbit,
                        const std::string &id, const std::vector<double> &mobility)
{
  const auto who = fmt::format("Fix {} {}", STYLE, id);
  cells.check_box(STYLE);
  if (regions) init_bodies(lmp, options, who);
  grains = std::make_unique<MPMFlowGrains>(lmp, cells, id, options.density);
  if (!grains->any()) grains.reset();
  if (grains && (options.reflect > 0.0 || options.implicit))
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: {} cannot be used with grains of fix mpm/immersed: remove it", who,
                    options.implicit ? "implicit yes" : "reflect");
  inflow = std::make_unique<MPMFlowInflow>(lmp, cells, groupbit);
  if (!inflow->any()) inflow.reset();
  if (options.sharp && (grains || inflow))
    lmp->error->all(FLERR, Error::NOLASTLINE, "{}: sharp cannot be used with {}: remove it", who,
                    grains ? "grains of fix mpm/immersed" : "points of fix mpm/emit");
  if (inflow && options.reflect > 0.0)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: reflect cannot be used with points of fix mpm/emit: remove it", who);
  if (inflow) inflow->clamps = options.implicit;
  if (stress) stress->mobility = inflow ? &mobility : nullptr;
  if ((grains && !options.liquids.empty()) || ((grains || inflow) && solids))
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: {} need a flow of one density: remove the keyword {}", who,
                    grains ? "grains of fix mpm/immersed" : "points of fix mpm/emit",
                    solids ? "solid" : "liquid");
  if (solids) solids->init(who);
  pressure->sources = inflow ? &inflow->sources() : nullptr;
}

void MPMFlowParts::init_bodies(LAMMPS *lmp, const MPMIncompressibleOptions &options,
                               const std::string &who)
{
  regions->init(who);
  bodies = std::make_unique<MPMFlowBodies>(lmp, cells, *regions, options.density);
  bodies->init();
  if (!bodies->any()) bodies.reset();
  pressure->bodies = bodies.get();
  if (bodies && solids)
    lmp->error->all(
        FLERR, Error::NOLASTLINE,
        "{}: bodies of fix mpm/rigid need a flow without solids: remove the keyword solid", who);
  if (bodies && stick)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: bodies of fix mpm/rigid feel the pressure alone, and not the viscosity of "
                    "a flow that sticks to them: use the keyword region, without viscosity",
                    who);
  if (bodies && options.reflect > 0.0)
    lmp->error->all(FLERR, Error::NOLASTLINE,
                    "{}: reflect cannot be used with bodies of fix mpm/rigid: remove it", who);
}

double MPMFlowParts::memory_usage() const
{
  double bytes = cells.memory_usage() + pressure->memory_usage() + air->memory_usage();
  const auto add = [&bytes](const auto &...part) {
    ((bytes += part ? part->memory_usage() : 0.0), ...);
  };
  add(regions, stick, grains, inflow, solids, tension, gas, gas_rows, stress, viscosities);
  return bytes;
}

double MPMFlowFields::memory_usage() const
{
  return bytes_of(sums, filled, predicted, initial, start, velocity, known, change, pressures,
                  shift, paths, inverse_density, face_volumes, solid_forces);
}

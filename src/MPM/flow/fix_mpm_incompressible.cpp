/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/fix_mpm_incompressible.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_integrators.h"
#include "flow/mpm_flow_air.h"
#include "flow/mpm_flow_bodies.h"
#include "flow/mpm_flow_gas_rows.h"
#include "flow/mpm_flow_grains.h"
#include "flow/mpm_flow_inflow.h"
#include "flow/mpm_flow_pressure.h"
#include "flow/mpm_flow_regions.h"
#include "flow/mpm_flow_solids.h"
#include "flow/mpm_flow_stick.h"
#include "flow/mpm_flow_stress.h"
#include "flow/mpm_flow_tension.h"
#include "flow/mpm_flow_transfer.h"
#include "flow/mpm_flow_viscosities.h"
#include "flow/mpm_flow_viscosity.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "math_const.h"
#include "math_extra.h"
#include "modify.h"
#include "neighbor.h"
#include "output.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

// layers of faces in the air with velocities of the water: those that a point just below the surface
// reaches, also from its place after half a step
static constexpr int AIR_LAYERS = 3;
// what quadratic splines add to a velocity component along its own axis, over its second difference
static constexpr double SMOOTHED = 0.125;
// residuals that are as small as this share of speed/spacing are rounding
static constexpr double ROUNDING = 1.0e-14;
// relative change of the time step from which on there are two
// solves: a smaller one changes the pressure as little
static constexpr double DIFFERENT_DT = 0.01;
// relative difference of densities that counts as none
static constexpr double SAME_DENSITY = 1.0e-9;
// ratio of the volume of a point to that of a cell that is too large
static constexpr double LARGEST_POINT = 1.01;
// with surface tension, see MPMFlowPressure::nearest
static constexpr double NEAREST_SURFACE = 1.0e-4;
// longest explicit step with several viscosities, over that of fraction 1: drops of a few points in a fluid that is a
// thousand times lighter were stable at 1.8 and unstable at 1.9, where one liquid is stable up to 2
static constexpr double MOST_OF_SEVERAL = 1.5;
// tolerance of the spreading of points, which shows only with other numbers of processes
static constexpr double SPREAD_TOLERANCE = 1.0e-8;
// share of the inflow that may have no room, because of the tolerance of the pressure
static constexpr double NOT_IN = 0.05;
// accelerations over that by gravity that limit the first step of a fluid at rest: the pressure causes
// them at the edges of a block of water that is released
static constexpr double FIRST_FALL = 4.0;
// share of FLIP by default in a flow with solids or bodies: apic alone smooths velocities at their
// surfaces in each step, which brakes sinking and swaying bodies in proportion to the number of steps
static constexpr double FLIP_OF_BODIES = 0.98;
// transfer auto: share that is kept of the part of velocities that the lattice does not see, if this
// part is below SMOOTH times h^2 d2v_c/dx_c^2 (root mean squares); nothing is kept above NOISY.
// Vortices, waves, and oscillating drops with 16 cells or more in a wave have 0.03 to 0.06; remains of
// flow in a fluid at rest, and fluid that falls or splashes, have 0.2 to 3
static constexpr double FLIP_OF_SMOOTH = 0.98, SMOOTH = 0.08, NOISY = 0.16;
// entries of the vector with gas; entries about parts of steps, at its end
static constexpr int GAS_VALUES = 5, PART_VALUES = 2;
// passes that fit the gradients of velocities with which points
// begin: a pass leaves up to 0.58 of what is missing
static constexpr int FITS = 30;

/* ----------------------------------------------------------------------
   fix ID group mpm/incompressible H DENSITY keyword value ...
------------------------------------------------------------------------- */

Options MPMIncompressibleOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/incompressible");
  o.argument(number(h, "node spacing", POSITIVE, "distance"));
  o.argument(number(density, "density", POSITIVE, "density"));
  o.add("viscosity", {number(viscosity, "mu", NOT_NEGATIVE, "pressure*time", "dynamic viscosity")});
  o.add("implicit", {yes_no(implicit)},
        "solve for viscous stresses together with the pressure, so that they do not limit the time "
        "step");
  o.add("tension",
        {number(tension, "sigma", NOT_NEGATIVE, "pressure*distance", "surface tension")});
  o.add("angle",
        {number(angle, "theta", {20.0, 160.0, true, true}, "degrees",
                "contact angle between surfaces and walls, measured in the fluid")});
  o.add("transfer",
        {word(transfer,
              {{"auto", AUTO,
                "*aflip* with a share of 0.98 while the flow is smooth, down to 0 while it is not"},
               {"apic", APIC, "points carry the gradient of the velocity"},
               {"flip",
                FLIP,
                "points keep this share of the part of their velocity that the lattice does not "
                "represent",
                {number(flip, "share", FRACTION, "1", "1: FLIP, 0: PIC")}},
               {"aflip",
                AFLIP,
                "both *apic* and *flip*",
                {number(flip, "share", FRACTION, "1", "1: AFLIP, 0: APIC")}},
               {"pic", PIC, "points take the velocity of the lattice"}})})
      .then([this] {
        transfer_is_given = true;
      })
      .once()
      .standard("auto (aflip 0.98 with solid, or a region of fix mpm/rigid)");
  o.add("reflect",
        {number(reflect, "R", FRACTION, "1",
                "share of the velocity change by the pressure that points get a second time")});
  std::vector<OptionWord> faces;
  for (int d = 0; d < dim; d++)
    for (int s = 0; s < 2; s++)
      faces.push_back({std::string(1, (char) ('x' + d)) + (s ? "hi" : "lo"), 2 * d + s,
                       2 * d + s == 2 * dim - 1 ? "this face of the box" : ""});
  std::vector<OptionWord> kinds = {
      {"slip", 0, "without friction"},
      {"stick",
       1,
       "without slip",
       {optional(axes(wall.v, dim, "vx vy vz", ANY_NUMBER, "velocity", "velocity of the wall"))}}};
  o.add("wall",
        {word(
             [this] {
               return 2 * axis + side;
             },
             [this](int k) {
               axis = k / 2;
               side = k % 2;
               std::fill_n(wall.v, 3, 0.0);
             },
             faces),
         word(
             [this] {
               return wall.sticks ? 1 : 0;
             },
             [this](int k) {
               wall.sticks = k == 1;
             },
             kinds)})
      .then([this] {
        wall.named = true;
        wall_is_twice |= walls[axis][side].named;
        walls[axis][side] = wall;
      })
      .standard("slip, all faces that are not periodic");
  o.add("region",
        {text(region_id, "region-ID",
              "region whose inside is solid, without friction; can be given more than once")})
      .then([this] {
        region_ids.push_back(region_id);
      })
      .standard("none");
  o.add("stick",
        {text(region_id, "region-ID",
              "region whose inside is solid, without slip; can be given more than once")})
      .then([this] {
        region_ids.push_back(region_id);
        sticks = true;
      })
      .standard("none");
  o.add("liquid",
        {text(liquid.group, "group-ID", "group of the points of a separate liquid"),
         number(liquid.density, "rho", POSITIVE, "density", "density of this liquid"),
         optional(number(liquid.viscosity, "mu", NOT_NEGATIVE, "pressure*time",
                         "dynamic viscosity of this liquid; that of *viscosity* if left out"))},
        "can be given more than once")
      .then([this] {
        liquids.push_back(liquid);
        liquid.viscosity = -1.0;    // for the next one
      })
      .standard("none");
  o.add("solid",
        {text(solid_group, "group-ID",
              "group of points that are elastic solids, with the law and density of their fix "
              "mpm/material; can be given more than once")})
      .then([this] {
        solid_groups.push_back(solid_group);
      })
      .standard("none");
  o.add("gas",
        {number(gas_law.p, "p", POSITIVE, "pressure",
                "absolute pressure of the gas in closed pockets when the flow begins"),
         number(gas_law.gamma, "gamma", {1.0, 10.0, true, true}, "1",
                "ratio of specific heats; 1: constant temperature")})
      .then([this] {
        has_gas = true;
        if (!outside_is_given) gas_law.outside = gas_law.p;
      })
      .once()
      .standard("none");
  o.add("outside",
        {number(gas_law.outside, "p", POSITIVE, "pressure",
                "absolute pressure of open air, to which pressures of the flow are relative")})
      .then([this] {
        outside_is_given = true;
      })
      .once()
      .standard("pressure of *gas*");
  std::vector<OptionWord> open_faces = faces;
  o.add("open",
        {word(
            [this] {
              return open_face;
            },
            [this](int k) {
              open_face = k;
            },
            open_faces)},
        "face next to which air is open; can be given more than once")
      .then([this] {
        open[open_face / 2][open_face % 2] = has_open = true;
      })
      .standard("none: all pockets are closed");
  o.add("sharp", {yes_no(sharp)},
        "points move with velocities that are not smoothed by their interpolation");
  o.add("spread",
        {number(spread, "S", FRACTION, "1",
                "share of the excess of points in a cell that is moved elsewhere in a step")});
  o.add("solver",
        {word(solver,
              {{"multigrid", MULTIGRID, "coarser lattices help to find the pressure"},
               {"fourier", FOURIER,
                "Fourier transforms do, which are faster where the fluid fills a box"}})});
  o.add("tolerance",
        {number(tolerance, "tol", {0.0, 1.0e-2, false, true}, "1",
                "remaining divergence, relative to the divergence before the solution")});
  o.add("iterations",
        {integer(most_iterations, "N", POSITIVE,
                 "largest number of iterations of the solvers for the pressure and for implicit "
                 "viscosity")});
  o.add("parts",
        {integer(most_parts, "N", POSITIVE,
                 "a step whose implicit viscosity does not converge is divided into parts, down to "
                 "1/N of the step")})
      .then([this] {
        parts_are_given = true;
      });
  o.refuse([this] {
    const bool is_viscous = largest_viscosity() > 0.0;
    return OptionRules{
        {wall_is_twice, "wall", "has the same face twice: give each face once"},
        {is_viscous, "region",
         "has no friction, and cannot be used with viscosity: use the keyword stick instead, or "
         "leave "
         "viscosity out"},
        {!implicit && parts_are_given, "parts",
         "is about implicit viscosity, as the other equations are those of any time step: add the "
         "keywords viscosity and implicit yes, or remove it"},
        {!implicit || !is_viscous, "stick",
         "is about viscosity, in an implicit step, as an explicit one would be bound by the least "
         "distance of "
         "a face to a wall: add the keywords viscosity and implicit yes, or use the keyword region "
         "instead"},
        {tension > 0.0, "region",
         "cannot be used with tension, as a fluid that slips along it without friction never comes "
         "to rest: use the keyword stick "
         "with implicit viscosity instead, or walls of the box, or leave tension out"},
        {!liquids.empty() && tension > 0.0, "tension",
         "is that of one liquid, and cannot be used with liquid: leave one of them out"},
        {!solid_groups.empty() && tension > 0.0, "tension",
         "would act on the surfaces of solids, too, and cannot be used with solid: leave one of "
         "them out"},
        {!solid_groups.empty() && has_several_viscosities(), "solid",
         "is in fluids of one viscosity: leave out the viscosity of keyword liquid"},
        {!solid_groups.empty() && implicit, "solid",
         "cannot be used with implicit yes: use explicit viscosity, or leave solid out"},
        {!solid_groups.empty() && reflect > 0.0, "reflect",
         "would count forces of solids twice, and cannot be used with solid: leave it out"},
        {sharp && (!region_ids.empty() || !solid_groups.empty()), "sharp",
         "is for flows between walls of the box, and cannot be used with region, stick, or solid: "
         "leave it out"},
        {tension == 0.0, "angle", "is about surfaces with a tension: add the keyword tension"},
        {!has_gas, "outside", "is about the gas in pockets: add the keyword gas"},
        {!has_gas, "open", "is about the gas in pockets: add the keyword gas"},
        {has_gas && implicit, "gas",
         "cannot be used with implicit yes: use explicit viscosity, or leave gas out"},
        {has_gas && reflect > 0.0, "gas", "cannot be used with reflect: leave one of them out"},
        {has_gas && !liquids.empty(), "gas",
         "is next to one liquid, and cannot be used with liquid: leave one of them out"},
        {has_gas && !solid_groups.empty(), "gas",
         "cannot be used with solid: leave one of them out"}};
  });
  return o;
}

double MPMIncompressibleOptions::largest_viscosity() const
{
  double most = viscosity;
  for (const auto &one : liquids) most = std::max(most, viscosity_of(one));
  return most;
}

bool MPMIncompressibleOptions::has_several_viscosities() const
{
  return std::any_of(liquids.begin(), liquids.end(), [this](const Liquid &one) {
    return viscosity_of(one) != viscosity;
  });
}

static MPM_NS::Lattice lattice_of(LAMMPS *lmp, int narg, char **arg)
{
  if (narg < 5) utils::missing_cmd_args(FLERR, "fix mpm/incompressible", lmp->error);
  if (!MPMPoints::get(lmp->atom))
    lmp->error->all(
        FLERR,
        "Fix mpm/incompressible requires material points: use atom_style mpm, or hybrid "
        "with mpm");
  if (!lmp->domain->box_exist)
    lmp->error->all(FLERR,
                    "Fix mpm/incompressible needs the simulation box: define it with create_box "
                    "before");
  const double h = utils::numeric(FLERR, arg[3], false, lmp);
  return {lmp->domain->dimension, h, {0.0, 0.0, 0.0}, {}, {1, 1, 1}};
}

FixMPMIncompressible::FixMPMIncompressible(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), cells(lmp, lattice_of(lmp, narg, arg), groupbit)
{
  const int dim = domain->dimension;
  auto options = declare(dim);
  read_options(lmp, options, narg, arg, 3);
  if (!solid_groups.empty() && !transfer_is_given) {
    transfer = AFLIP;
    flip = FLIP_OF_BODIES;
  }
  for (int d = 0; d < dim; d++)
    for (int s = 0; s < 2; s++) cells.walls[d][s] = walls[d][s];
  cells.check_box(style);
  for (int d = 0; d < dim; d++)
    for (int s = 0; s < 2; s++) {
      const auto name = std::string(1, (char) ('x' + d)) + (s ? "hi" : "lo");
      if (walls[d][s].named && cells.lattice.periodic[d])
        error->all(FLERR,
                   "Fix mpm/incompressible wall {} is a periodic face: use boundary f for a wall",
                   name);
      if (walls[d][s].v[d] != 0.0)
        error->all(FLERR,
                   "Fix mpm/incompressible wall {} cannot move out of its plane: its velocity "
                   "along {} must "
                   "be zero",
                   name, (char) ('x' + d));
    }
  if (!atom->tag_enable)
    error->all(FLERR,
               "Fix mpm/incompressible tells points from each other by their IDs: remove "
               "atom_modify id no");

  pressure = std::make_unique<MPMFlowPressure>(lmp, cells);
  if (solver == FOURIER && !MPMFlowFourier::is_there())
    error->all(
        FLERR,
        "Fix mpm/incompressible solver fourier: this program was built without FFTW; install "
        "it (libfftw3-dev) and build again, or use solver multigrid");
  if (solver == FOURIER) pressure->use_fourier();
  air = std::make_unique<MPMFlowAir>(cells);
  thickest = largest_viscosity();
  if (implicit && thickest == 0.0)
    error->all(FLERR,
               "Fix mpm/incompressible implicit yes is about the viscosity: add the keyword "
               "viscosity");
  if (implicit) {
    stress = std::make_unique<MPMFlowStress>(lmp, cells, *pressure);
    stress->lightness = liquids.empty() ? nullptr : &lightness;
    cells.wants_around = true;
  } else if (thickest > 0.0) {
    viscous = std::make_unique<MPMFlowViscosity>(cells, *pressure);
    cells.wants_around = true;
  }
  if (has_several_viscosities())
    viscosities = std::make_unique<MPMFlowViscosities>(cells, viscosity);
  for (auto it = region_ids.begin(); it != region_ids.end(); ++it)
    if (std::count(region_ids.begin(), it, *it))
      error->all(FLERR, "Fix mpm/incompressible has region {} twice: give it once", *it);
  if (!region_ids.empty()) {
    regions = std::make_unique<MPMFlowRegions>(lmp, cells, region_ids);
    pressure->regions = regions.get();
    cells.wants_around = true;
    last.regions.assign(3 * region_ids.size(), 0.0);
  }
  if (sticks) {
    stick = std::make_unique<MPMFlowStick>(cells, *regions);
    stress->stick = stick.get();
  }
  if (tension > 0.0) {
    curved = std::make_unique<MPMFlowTension>(cells, *pressure, angle * MathConst::DEG2RAD);
    pressure->nearest = NEAREST_SURFACE;
    cells.wants_more = MPMFlowTension::PASSES;
    cells.wants_around = true;
    cells.overlap = MPMFlowWetting::overlap(regions != nullptr);
  }
  for (const auto &one : liquids) {
    const int igroup_of = group->find(one.group);
    if (igroup_of < 0)
      error->all(FLERR, "Fix mpm/incompressible liquid: group {} does not exist", one.group);
    liquid_bits.push_back(group->bitmask[igroup_of]);
    if (viscosities) viscosities->add(liquid_bits.back(), viscosity_of(one));
  }
  if (!solid_groups.empty()) {
    int bits = 0;
    for (const auto &one : solid_groups) {
      const int igroup_of = group->find(one);
      if (igroup_of < 0)
        error->all(FLERR, "Fix mpm/incompressible solid: group {} does not exist", one);
      bits |= group->bitmask[igroup_of];
    }
    solids = std::make_unique<MPMFlowSolids>(lmp, cells, bits);
  }
  if (has_gas) {
    for (int d = 0; d < dim; d++)
      for (int s = 0; s < 2; s++)
        if (open[d][s] && cells.lattice.periodic[d])
          error->all(FLERR,
                     "Fix mpm/incompressible open {}{}: the box is periodic there, and has no such "
                     "face: use boundary f",
                     (char) ('x' + d), s ? "hi" : "lo");
    gas = std::make_unique<MPMFlowGas>(lmp, cells, *pressure, gas_law);
    for (int d = 0; d < dim; d++) std::copy_n(open[d], 2, gas->pockets.open[d]);
    gas_rows = std::make_unique<MPMFlowGasRows>(lmp, cells, *pressure, *gas);
    pressure->nearest = NEAREST_SURFACE;
    cells.wants_around = true;
  }
  if (transfer == AUTO || transfer == APIC || transfer == AFLIP)
    state.declare(gradient, "mpm/incompressible:gradient", flow_slopes(dim));

  time_integrate = 1;
  dynamic_group_allow = 0;
  scalar_flag = vector_flag = 1;
  size_vector = 15 + 3 * region_ids.size() + (gas ? GAS_VALUES : 0) + PART_VALUES;
  global_freq = 1;
  extscalar = extvector = 0;
  several = !liquids.empty();
  least_density = density;
  for (const auto &one : liquids) least_density = std::min(least_density, one.density);
  if (viscosities && stress) stress->viscosities = viscosities.get();
  if (viscosities && viscous) viscous->viscosities = viscosities.get();
  restart_global = 1;
  keep_arrays();
}

FixMPMIncompressible::~FixMPMIncompressible() = default;

int FixMPMIncompressible::setmask()
{
  return INITIAL_INTEGRATE | PRE_EXCHANGE | PRE_NEIGHBOR | PRE_FORCE;
}

/* ---------------------------------------------------------------------- */

void FixMPMIncompressible::init()
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/incompressible requires run_style verlet");
  if (update->whichflag == 2)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/incompressible cannot be used with minimize: minimize before the fix is "
               "defined");
  if (domain->box_change_size || domain->box_change_shape)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/incompressible requires a box of constant size and shape: remove the fix "
               "that changes it");
  cells.check_box(style);
  if (regions) {
    regions->init(fmt::format("Fix {} {}", style, id));
    bodies = std::make_unique<MPMFlowBodies>(lmp, cells, *regions, density);
    bodies->init();
    if (!bodies->any()) bodies.reset();
    if (solid_groups.empty() && !transfer_is_given) {    // bodies can come and go between runs
      transfer = bodies ? AFLIP : AUTO;
      flip = bodies ? FLIP_OF_BODIES : 0.0;
    }
    pressure->bodies = bodies.get();
    if (bodies && solids)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {} {}: bodies of fix mpm/rigid need a flow without solids: remove the "
                 "keyword solid",
                 style, id);
    if (bodies && stick)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix {} {}: bodies of fix mpm/rigid feel the pressure alone, and not the viscosity of a "
          "flow that sticks to them: use the keyword region, without viscosity",
          style, id);
    if (bodies && reflect > 0.0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {} {}: reflect cannot be used with bodies of fix mpm/rigid: remove it", style,
                 id);
  }
  grains = std::make_unique<MPMFlowGrains>(lmp, cells, id, density);
  if (!grains->any()) grains.reset();
  if (grains && (reflect > 0.0 || implicit))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: {} cannot be used with grains of fix mpm/immersed: remove it", style, id,
               implicit ? "implicit yes" : "reflect");
  inflow = std::make_unique<MPMFlowInflow>(lmp, cells, *this);
  if (!inflow->any()) inflow.reset();
  if (sharp && (grains || inflow))
    error->all(FLERR, Error::NOLASTLINE, "Fix {} {}: sharp cannot be used with {}: remove it",
               style, id, grains ? "grains of fix mpm/immersed" : "points of fix mpm/emit");
  if (inflow && reflect > 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: reflect cannot be used with points of fix mpm/emit: remove it", style,
               id);
  if (inflow) inflow->clamps = implicit;
  if (stress) stress->mobility = inflow ? &mobility : nullptr;
  if ((grains && !liquids.empty()) || ((grains || inflow) && solids))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: {} need a flow of one density: remove the keyword {}", style, id,
               grains ? "grains of fix mpm/immersed" : "points of fix mpm/emit",
               solids ? "solid" : "liquid");
  if (gas) check_gas();
  if (solids) solids->init(fmt::format("Fix {} {}", style, id));
  pressure->sources = inflow ? &inflow->sources() : nullptr;
  force_reneighbor = neighbor->includegroup ? 1 : 0;
  next_reneighbor = -1;
  forces_known = false;

  // points need no ghosts, see FixMPM::init()

  const double nothing = 1.0e-8 * h;
  if (!force->pair && comm->cutghostuser == 0.0) comm->cutghostuser = nothing;
  if (force->pair && comm->cutghostuser == nothing) comm->cutghostuser = 0.0;
  atom->sortfreq = 0;
}

void FixMPMIncompressible::setup_pre_exchange()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (!cells.is_point(i)) continue;
    for (int d = 0; d < domain->dimension; d++)
      if (!domain->periodicity[d] &&
          !(atom->x[i][d] >= domain->boxlo[d] && atom->x[i][d] <= domain->boxhi[d]))
        error->one(FLERR, Error::NOLASTLINE,
                   "Point {} of fix {} is outside of the box, whose fixed faces are walls",
                   atom->tag[i], style);
  }
}

void FixMPMIncompressible::setup_pre_neighbor()
{
  check_points();
  cells.sort();
  gone = 0.0;
}

/** Gives a mass to points that have none yet, and checks for other fixes that move points. */
void FixMPMIncompressible::check_points()
{
  bigint mine[3] = {0, 0, 0},
         all[3];    // points, those of another density, and those larger than a cell
  if (solids) check_solids();
  for (int i = 0; i < atom->nlocal; i++) {
    if (!cells.is_point(i)) continue;
    const double mass = density_of(i) * atom->vfrac[i];
    if (!(atom->rmass[i] > 0.0)) atom->rmass[i] = mass;
    mine[0]++;
    if (std::fabs(atom->rmass[i] / mass - 1.0) > SAME_DENSITY) mine[1]++;
    if (atom->vfrac[i] > LARGEST_POINT * cells.lattice.cell_volume()) mine[2]++;
    for (int d = 0; d < domain->dimension; d++)
      if (!std::isfinite(atom->v[i][d]) || !std::isfinite(atom->x[i][d]))
        error->one(FLERR, Error::NOLASTLINE,
                   "Fix {}: point {} has a position or velocity that is not a number", style,
                   atom->tag[i]);
  }
  MPI_Allreduce(mine, all, 3, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all[0] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {} has no material points in its group: make some with create_points", style,
               id);
  if (all[1])
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} {}: {} points have another mass than density {} times their volume; there is one "
        "density but for points of keywords liquid and solid",
        style, id, all[1], density);
  if (all[2] && comm->me == 0 && !told_of_large)
    error->warning(FLERR,
                   "Fix {} {}: {} points are larger than a cell, and leave others empty when they "
                   "move: use points with a spacing of at most {:.6g}, better {:.6g}",
                   style, id, all[2], h, 0.5 * h);
  told_of_large = all[2] > 0;
  check_liquids();
  refuse_other_integrators(lmp, *this);
  check_others();
}

/** Checks the groups of liquids. They have the points that there were at the time of their command; an empty
 *  group is no liquid. */
void FixMPMIncompressible::check_liquids()
{
  std::vector<int> mine(liquids.size(), 0), all(liquids.size(), 0);
  for (std::size_t k = 0; k < liquids.size(); k++)
    for (int i = 0; i < atom->nlocal; i++)
      if (cells.is_point(i) && atom->mask[i] & liquid_bits[k]) mine[k] = 1;
  for (const auto *inlet : modify->get_fix_by_style("^mpm/emit$"))    // its points are yet to come
    for (std::size_t k = 0; k < liquids.size(); k++)
      if (inlet->groupbit & liquid_bits[k]) mine[k] = 1;
  MPI_Allreduce(mine.data(), all.data(), (int) mine.size(), MPI_INT, MPI_MAX, world);
  for (std::size_t k = 0; k < liquids.size(); k++)
    if (!all[k] && comm->me == 0 && !told_of_liquids)
      error->warning(
          FLERR,
          "Fix {} {}: the group {} of keyword liquid has no points of this fix: put some into it, "
          "with keyword group of create_points, or with the group command after it",
          style, id, liquids[k].group);
  told_of_liquids = true;
}

/** Checks solids, which have laws and perhaps other densities. */
void FixMPMIncompressible::check_solids()
{
  solids->check_points();
  double mine[2] = {density, -density}, all[2];    // greatest, and minus the least
  for (int i = 0; i < atom->nlocal; i++) {
    if (!cells.is_point(i)) continue;
    mine[0] = std::max(mine[0], density_of(i));
    mine[1] = std::max(mine[1], -density_of(i));
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
  least_density = -all[1];
  several = all[0] > (1.0 + SAME_DENSITY) * least_density;
}

double FixMPMIncompressible::density_of(int i) const
{
  return solids && solids->holds(i) ? solids->density_of(i) : density_of_groups(atom->mask[i]);
}

double FixMPMIncompressible::density_of_groups(int mask) const
{
  double of = density;
  for (std::size_t k = 0; k < liquids.size(); k++)
    if (mask & liquid_bits[k]) of = liquids[k].density;
  return of;
}

/** Densities of faces, from the mass and the volume that points give them. */
void FixMPMIncompressible::find_lightness(const MPMFlowPoints &points)
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  give_volumes_to_faces(cells, points, face_volumes);
  cells.sum(face_volumes.data(), 2 * dim);
  lightness.assign(cells.size() * dim, 1.0);
  for (int64_t k = 0; k < cells.size(); k++)
    for (int c = 0; c < dim; c++) {
      const double mass = sums[k * width + dim + c];
      if (mass > 0.0) lightness[k * dim + c] = density * face_volumes[2 * k * dim + dim + c] / mass;
    }
  pressure->lightness = &lightness;
}

/** Refuses what the volume of a pocket, which follows from the flow through its surface, does not account
 *  for. */
void FixMPMIncompressible::check_gas() const
{
  const char *const other = bodies     ? "bodies of fix mpm/rigid"
      : regions && regions->any_move() ? "regions that move"
      : grains                         ? "grains of fix mpm/immersed"
      : inflow                         ? "points of fix mpm/emit"
                                       : nullptr;
  if (other)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: gas cannot be used with {}: remove these, or the keyword gas", style, id,
               other);
  if (!regions) return;
  gas->pockets.find_solid(regions.get());
  if (regions->n() > 1 && comm->me == 0 && !told_of_walls)
    error->warning(
        FLERR,
        "Fix {} {}: forces on its regions are those of the water alone, without the gas, "
        "as there are several: use a union of them as one region if you need these forces",
        style, id);
  told_of_walls = true;
}

double FixMPMIncompressible::value_of_gas(int k) const
{
  if (k == 0) return gas->count();
  if (k == 1) return gas->highest();
  if (k == 2) return gas->lowest();
  return (k == 3 ? gas->volume() : gas->energy() / force->nktv2p);
}

/** Checks for other fixes in the same box whose points this flow would go through. */
void FixMPMIncompressible::check_others() const
{
  for (const auto *other : modify->get_fix_by_style("^mpm/incompressible$"))
    if (other != this)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fluids of fixes {} and {} (style {}) would go through each other: give their "
                 "points to one "
                 "of these fixes",
                 id, other->id, style);
  for (const auto *other : modify->get_fix_by_style("^mpm$"))
    if (comm->me == 0 && !told_of_bodies)
      error->warning(
          FLERR,
          "Points of fix {} (style {}) go through those of fix {} (style {}), as neither feels "
          "the other",
          id, style, other->id, other->style);
  told_of_bodies = true;
  if (modify->get_fix_by_style("^mpm$").empty())    // fix mpm would warn of these itself
    warn_of_forgotten_points(lmp, style, "the flow goes through them");
}

void FixMPMIncompressible::setup(int)
{
  if (!(update->dt > 0.0))
    error->all(FLERR, Error::NOLASTLINE, "Fix {} requires a positive time step: {}", style,
               update->dt);
  stiffness_known = false;
  if (grains) grains->list();
  cells.find_cells();
  if (regions) {
    regions->start_run();
    regions->find(0.0);
    if (stick) stick->find(true);
    check_depths();
  }
  fit_gradients();
  give_to_cells(cells, points_now(0.0), sums);
  cells.sum(sums.data(), 3 * cells.lattice.dim + 1);
  find_velocities();
  pressure->find_wet(share);
  if (gas && !gas->known()) gas->find(share, star.data());
  note_filling();
  forces_known = true;
}

/** Refuses points that begin deep in a wall. Points near its surface are moved out of it in the first step. */
void FixMPMIncompressible::check_depths()
{
  bigint mine = 0, all;
  for (int i = 0; i < atom->nlocal; i++)
    if (cells.is_point(i) && regions->depth(atom->x[i], 2.0 * h) > 0.5 * h) mine++;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (all)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: {} points are in a region, which is solid: create them outside of it",
               style, id, all);
}

/** Notes the volume that points fill. */
void FixMPMIncompressible::note_filling()
{
  last.wet = (double) pressure->nwet();
  last.filled = 0.0;
  for (const auto &cell : cells.cells)
    last.filled += std::min(1.0, share[cell.number]) * (regions ? regions->room(cell.number) : 1.0);
  last.filled *= cells.lattice.cell_volume();
}

/* ----------------------------------------------------------------------
   Points that begin with a velocity get its gradient, too, because the lattice would otherwise get a mean
   over a cell. Points that continue keep what they had.
------------------------------------------------------------------------- */

void FixMPMIncompressible::fit_gradients()
{
  if (!gradient) return;
  const int n = flow_slopes(cells.lattice.dim);
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal && !mine; i++)
    if (cells.is_point(i))
      mine = std::any_of(gradient[i], gradient[i] + n, [](double g) {
        return g != 0.0;
      });
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) return;
  for (int pass = 0; pass < FITS; pass++) {
    give_to_cells(cells, points_now(0.0), sums);
    cells.sum(sums.data(), 3 * cells.lattice.dim + 1);
    find_velocities();
    get_gradients(cells, points_now(0.0), star.data());
  }
}

/* ----------------------------------------------------------------------
   Called after exchange and borders. The order of points must not depend on an earlier order, so that a run
   that continues from a restart file sums in the same order.
------------------------------------------------------------------------- */

void FixMPMIncompressible::pre_neighbor()
{
  cells.sort();
  gone = 0.0;
}

void FixMPMIncompressible::setup_pre_force(int vflag)
{
  pre_force(vflag);
}

/** LAMMPS has set to zero only the forces of atoms in the neighbor lists (neigh_modify include), see
 *  FixMPM::pre_force(). */
void FixMPMIncompressible::pre_force(int)
{
  if (!neighbor->includegroup) return;
  for (int i = atom->nfirst; i < atom->nlocal; i++)
    if (cells.is_point(i)) MathExtra::zero3(atom->f[i]);
}

/* ---------------------------------------------------------------------- */

double FixMPMIncompressible::acceleration_of_stress() const
{
  return force->ftm2v / (force->nktv2p * density);
}

/** The largest kinematic viscosity, which limits explicit steps. */
double FixMPMIncompressible::largest_nu() const
{
  if (!viscosities) return thickest * acceleration_of_stress() * density / least_density;
  double most = viscosity / density;
  for (const auto &one : liquids) most = std::max(most, viscosity_of(one) / one.density);
  return most * density * acceleration_of_stress();
}

/** dt p/density of free surfaces by their tension and by gas; null: they have none. */
const std::vector<double> *FixMPMIncompressible::surface_psi() const
{
  if (gas) return &gas_rows->at_surface();
  return curved ? &at_surface : nullptr;
}

/** Force per mass by all fix gravity, in units of forces. */
void FixMPMIncompressible::weight(double *g) const
{
  MathExtra::zero3(g);
  for (auto *gravity : modify->get_fix_by_style("^gravity")) {
    int width;
    const auto *const of_fix = (const double *) gravity->extract("gvec", width);
    for (int d = 0; d < cells.lattice.dim; d++) g[d] += of_fix[d];
  }
}

MPMFlowPoints FixMPMIncompressible::points_now(double dt) const
{
  return {atom->x, atom->v, atom->f, atom->rmass, atom->vfrac, gradient, dt};
}

/* ----------------------------------------------------------------------
   Forces act for the duration of this step, in two parts: 1/(1 + R) before points move, and R/(1 + R) in what
   comes once more. The pressure has to remove the divergence that the motion in the step before has made,
   within 1/(1 + R) of the duration of that step. Where the two durations differ, there is one solve for the
   velocities, and one with the forces of the former duration. The latter gives the pressure and, in
   proportion to the durations, what comes once more.
------------------------------------------------------------------------- */

void FixMPMIncompressible::initial_integrate(int)
{
  const double dt = update->dt, before = dt_before > 0.0 ? dt_before : dt;
  const double part = 1.0 / (1.0 + reflect);
  const bool differ = std::fabs(dt - before) > DIFFERENT_DT * dt;
  dt_before = dt;
  const MPMFlowPoints points = points_now(dt);
  double of_last[4];
  sum_last_step(cells.valid && (!grains || cells.visitors_in_reach()), of_last);
  cells.valid = of_last[0] == 0.0;
  if (transfer == AUTO) {
    const double rest = std::sqrt(of_last[1]), smooth = std::sqrt(of_last[2]);
    flip = smooth > 0.0
        ? FLIP_OF_SMOOTH * std::clamp((NOISY - rest / smooth) / (NOISY - SMOOTH), 0.0, 1.0)
        : 0.0;
  }
  if (grains && !cells.valid) grains->list();
  cells.find_cells();
  if (regions) regions->find(dt);
  if (stick) stick->find(false);
  if (inflow) inflow->find(regions.get());

  give_to_cells(cells, points, sums);
  cells.sum(sums.data(), 3 * cells.lattice.dim + 1);
  find_velocities();
  const bool keeps = flip > 0.0 || transfer == AUTO;
  if (keeps || reflect > 0.0 || differ) old = star;
  if (several) find_lightness(points);
  if (viscosities) viscosities->find(atom->x, atom->vfrac, atom->mask);
  if (solids) {
    if (!stiffness_known) check_stiffness();
    solids->give_forces(elastic);
  }
  pressure->find_wet(share);
  if (gas) gas->find(share, star.data());

  find_flow(part * (differ ? before : dt));
  find_pressures(part * (differ ? before : dt) * acceleration_of_stress());
  if (reflect > 0.0) {
    const double again = reflect * (differ ? dt / before : 1.0);
    more.resize(velocity.size());
    for (std::size_t k = 0; k < velocity.size(); k++) more[k] = again * (velocity[k] - old[k]);
  }
  if (differ) {
    star = old;
    find_flow(part * dt);
  }
  check_speed();
  if (gas) gas->move(velocity.data(), dt);
  if (grains) grains->end(velocity);
  if (grains || inflow) pressure->set_mobility(nullptr);    // points also spread among grains

  if (sharp) find_paths();
  if (spread > 0.0) find_shift();
  if (bodies) bodies->move(dt);

  double of_shift[2] = {0.0, 0.0};
  const MPMFlowUpdate update_points = {flip,
                                       keeps ? old.data() : nullptr,
                                       reflect,
                                       reflect > 0.0 ? more.data() : nullptr,
                                       spread > 0.0 ? shift.data() : nullptr,
                                       regions.get(),
                                       inflow.get(),
                                       solids.get(),
                                       transfer == AUTO ? unseen : nullptr,
                                       of_shift,
                                       sharp ? paths.data() : nullptr,
                                       thickest,
                                       viscosities.get()};
  if (solids) solids->deform(velocity.data(), dt, viscosity);
  cells.valid = get_from_cells(cells, points, velocity.data(), update_points, pressures.data(),
                               MPMPoints::get(atom)->tau);
  energy_of_spread += force->mvv2e * of_shift[0] - of_shift[1];

  note_filling();
}

/** Sums over all ranks: number of ranks whose cells are not those of their points, MPMFlowUpdate::squares of
 *  the last step, and the energy of spreading. */
void FixMPMIncompressible::sum_last_step(bool valid, double *all) const
{
  const double mine[4] = {valid ? 0.0 : 1.0, unseen[0], unseen[1], energy_of_spread};
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
}

/* ----------------------------------------------------------------------
   Velocities at the end of a duration, from those at its start in star, and the pressure.

   Where implicit viscosity does not converge, the duration is halved, because its equations contain dt
   nu/h^2. The rest is done in parts of this length, each from the velocities at the end of the part before.
   Points and the lattice stay as they are until the last part is done, and then move with its velocities. All
   other equations are independent of the duration: if these do not converge, parts would not help. Potentials
   add up to those of the mean pressure.
------------------------------------------------------------------------- */

void FixMPMIncompressible::find_flow(double duration)
{
  double done = 0.0, part = 1.0;    // sums of powers of 1/2, which are exact
  last.parts = 0.0;
  while (done < 1.0) {
    if (stress) start_of_part = star;
    const auto report = find_part(part * duration);
    if (!report.converged()) {
      part *= 0.5;
      if (report.outcome == SolveReport::NOT_FINITE || part * most_parts < 1.0)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix {} {}: the implicit viscosity {} at step {}{}; allow more iterations, a "
                   "larger tolerance, or take smaller time steps",
                   style, id, report.describe(), update->ntimestep,
                   part < 0.5 ? fmt::format(", in parts of 1/{} of it, too", (int) (0.5 / part))
                              : "");
      halvings++;
      star = start_of_part;
      continue;
    }
    if (part < 1.0) {
      if (done == 0.0) psi_of_parts.assign(pressure->psi.size(), 0.0);
      for (std::size_t k = 0; k < psi_of_parts.size(); k++) psi_of_parts[k] += pressure->psi[k];
      star = velocity;
    }
    done += part;
    last.parts++;
  }
  if (part == 1.0) return;
  pressure->psi = psi_of_parts;
  if (curved) find_tension(duration);
}

/** The same for a duration in one part. Returns the outcome of the implicit viscosity; if it has not
 *  converged, the velocities are of no use. */
SolveReport FixMPMIncompressible::find_part(double duration)
{
  if (grains) before_forces = star;
  if (viscous) add_viscosity(duration);
  add_forces(duration * force->ftm2v);
  if (grains) {
    grains->begin(duration, sums, share, before_forces, star);
    mobility = grains->mobility();
  } else if (inflow)
    mobility.assign(star.size(), 1.0);
  if (inflow) {
    without_hold = star;
    inflow->hold(star, &mobility);
  }
  if (grains || inflow) pressure->set_mobility(&mobility);

  velocity.assign(star.size(), 0.0);
  known.assign(star.size(), 0.0);
  double most[1] = {0.0}, most_all[1];
  for (const double v : star) most[0] = std::max(most[0], std::fabs(v));
  MPI_Allreduce(most, most_all, 1, MPI_DOUBLE, MPI_MAX, world);
  const double cells_of_all = (double) atom->natoms;
  const double rounding = ROUNDING * most_all[0] * std::sqrt(cells_of_all);
  if (curved) {
    const double most = MPMFlowTension::stable_dt(tension * acceleration_of_stress(), h);
    if (update->dt > most * (1.0 + 1.0e-9))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix {} {}: the time step {:.6g} is too large for the surface tension, which "
                 "allows {:.6g}; reduce it, or let fix mpm/dt set it",
                 style, id, update->dt, most);
    find_tension(duration);
  }
  if (gas)
    gas_rows->begin(duration, duration * acceleration_of_stress(), curved ? &at_surface : nullptr);
  if (bodies) {
    double g[3];
    weight(g);
    MathExtra::scale3(force->ftm2v, g);
    bodies->begin(duration, g, *pressure);
  }
  const auto report =
      pressure->project(star.data(), velocity.data(), known.data(),
                        {tolerance, rounding / h, most_iterations}, surface_psi(), gas_rows.get());
  if (!report.converged())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} {}: the pressure {} at step {}; allow more iterations, or a larger tolerance: "
        "its equations are those of any time step",
        style, id, report.describe(), update->ntimestep);
  if (bodies) bodies->end(pressure->psi.data());
  SolveReport of_stress;
  if (stress) {
    of_stress = find_stress(duration, rounding);
    if (!of_stress.converged()) return of_stress;
  }
  if (inflow) star.swap(without_hold);    // next to mouths, held velocities do not fall, either
  go_on_into_air();
  if (inflow) {
    inflow->hold(velocity, nullptr);
    check_inflow();
  }
  last.iterations = report.iterations;
  last.residual = report.right_side > 0.0 ? report.residuals.back() / report.right_side : 0.0;
  last.divergence = pressure->largest_divergence(velocity.data());
  return of_stress;
}

/** dt p/density of surfaces by their tension. */
void FixMPMIncompressible::find_tension(double duration)
{
  curved->find(share, duration * acceleration_of_stress() * tension, at_surface);
}

/* ----------------------------------------------------------------------
   Viscous stresses, with what they add to the pressure, at the end of a step without them. The effect
   of the place of a surface is left to the pressure alone, so that a fluid at rest stays at rest.
------------------------------------------------------------------------- */

SolveReport FixMPMIncompressible::find_stress(double dt, double rounding)
{
  potentials = pressure->psi;
  const auto report = stress->step(dt * thickest * acceleration_of_stress() / (h * h), velocity,
                                   potentials, {tolerance, rounding, most_iterations});
  if (!report.converged()) return report;
  last.of_stress = report.iterations;
  viscous_velocity.swap(velocity);
  velocity.assign(viscous_velocity.size(), 0.0);
  const auto again = pressure->project(viscous_velocity.data(), velocity.data(), known.data(),
                                       {tolerance, rounding / h, most_iterations});
  if (!again.converged())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: the pressure after implicit viscosity {} at step {}; allow more "
               "iterations, or a larger tolerance: its equations are those of any time step",
               style, id, again.describe(), update->ntimestep);
  for (std::size_t k = 0; k < potentials.size(); k++) pressure->psi[k] += potentials[k];
  return report;
}

/** Velocities of faces from the momentum of points, and filled shares; both are complete. */
void FixMPMIncompressible::find_velocities()
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  const double per_cell = 1.0 / cells.lattice.cell_volume();
  star.resize(cells.size() * dim);
  share.resize(cells.size());
  for (int64_t k = 0; k < cells.size(); k++) {
    const double *const from = sums.data() + k * width;
    for (int c = 0; c < dim; c++)
      star[k * dim + c] = from[dim + c] > 0.0 ? from[c] / from[dim + c] : 0.0;
    share[k] = per_cell * from[3 * dim];
  }
  cells.reflect_velocities(star.data());
  cells.reflect_cells(share.data());
  if (regions) regions->normalize(share);
}

/** Adds what forces change; walls take their share. */
void FixMPMIncompressible::add_forces(double dt)
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  for (int64_t k = 0; k < cells.size(); k++) {
    const double *const from = sums.data() + k * width;
    for (int c = 0; c < dim; c++)
      if (from[dim + c] > 0.0) star[k * dim + c] += dt * from[2 * dim + c] / from[dim + c];
  }
  for (int64_t k = 0; k < cells.size() && solids; k++)
    for (int c = 0; c < dim; c++) {
      const double mass = sums[k * width + dim + c];
      if (mass > 0.0) star[k * dim + c] += dt * elastic[k * dim + c] / mass;
    }
  cells.reflect_velocities(star.data());
}

/** Called in the first step of a run, as fix mpm/dt checks all others. */
void FixMPMIncompressible::check_stiffness()
{
  tagint tag;
  const double mine = std::sqrt(2.0) * solids->stable_dt(tag);
  double most;
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MIN, world);
  if (update->dt > most * (1.0 + 1.0e-9))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix {} {}: the time step {:.6g} is too large for the stiffness of its solids, which "
        "allows {:.6g}; reduce it, or let fix mpm/dt set it",
        style, id, update->dt, most);
  stiffness_known = true;
}

void FixMPMIncompressible::add_viscosity(double dt)
{
  const int dim = cells.lattice.dim;
  const double nu = thickest * acceleration_of_stress(),
               most = (viscosities ? MOST_OF_SEVERAL : 2.0) *
      MPMFlowViscosity::stable_dt(largest_nu(), h, dim);
  if (update->dt > most * (1.0 + 1.0e-9))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: the time step {:.6g} is too large for the viscosity, which allows "
               "{:.6g}; reduce it, or let fix mpm/dt set it",
               style, id, update->dt, most);
  shift.assign(star.size(), 0.0);
  viscous->add(dt * nu, star, shift);
  cells.publish(shift.data(), dim);
  for (std::size_t k = 0; k < shift.size() && several; k++) shift[k] *= lightness[k];
  for (std::size_t k = 0; k < star.size(); k++) star[k] += shift[k];
  cells.reflect_velocities(star.data());
}

/* ----------------------------------------------------------------------
   Forces on walls, and pressures for points, such that these interpolate zero at the surface and the pressure
   of walls at walls.
------------------------------------------------------------------------- */

void FixMPMIncompressible::find_pressures(double pressure_to_psi)
{
  for (int d = 0; d < cells.lattice.dim; d++)
    for (int s = 0; s < 2; s++) {
      last.walls[d][s] = pressure->at_wall(d, s) / (pressure_to_psi * force->nktv2p);
      if (gas && comm->me == 0)
        last.walls[d][s] += gas_rows->at_wall(d, s) / (pressure_to_psi * force->nktv2p);
      if (grains) last.walls[d][s] += grains->at_wall(d, s, before_forces, velocity) / force->ftm2v;
    }
  if (regions) {
    std::fill(last.regions.begin(), last.regions.end(), 0.0);
    const double duration = pressure_to_psi / acceleration_of_stress();
    const int dim = cells.lattice.dim, width = 3 * dim + 1;
    regions->add_forces(
        pressure->psi.data(),
        [this](int64_t number) {
          return pressure->is_wet(number);
        },
        [&](const MPMFlowLattice::Cell &cell,
            double *push) {    // change by forces, at the faces of the cell
          for (int c = 0; c < dim; c++) {
            double force_of_points = 0.0, mass = 0.0;
            for (const int64_t k : {(int64_t) cell.number, (int64_t) cell.near[2 * c + 1]}) {
              force_of_points += sums[k * width + 2 * dim + c];
              mass += sums[k * width + dim + c];
            }
            push[c] = mass > 0.0 ? duration * force->ftm2v * force_of_points / mass : 0.0;
          }
          return pressure->density_in(cell);
        },
        1.0 / (1.0 + reflect), last.regions.data());
    if (gas && regions->n() == 1) gas_rows->add_to_region(last.regions.data());
    for (double &f : last.regions) f /= pressure_to_psi * force->nktv2p;
  }
  pressure->extend_into_air(pressures, surface_psi(), gas_rows.get());
  for (double &p : pressures) p /= pressure_to_psi;
  cells.extrapolate_cells(pressures.data(), [this](int64_t number) {
    return pressure->is_wet(number);
  });
}

/* ----------------------------------------------------------------------
   Faces in the air to which points give momentum keep it, together with what the pressure changes at the
   water next to them. Points that are about to fall into the water, or fly off, do not get its velocity
   before, and a drop that spins goes on spinning.
------------------------------------------------------------------------- */

void FixMPMIncompressible::go_on_into_air()
{
  const int dim = cells.lattice.dim, width = 3 * dim + 1;
  // changes by viscosity go on into the air, too: otherwise the layer of points at a surface would fall freely
  if (viscous)
    for (std::size_t k = 0; k < star.size(); k++) star[k] -= shift[k];
  for (std::size_t k = 0; k < velocity.size(); k++)
    if (known[k] > 0.0) velocity[k] -= star[k];
  air->extend(AIR_LAYERS, velocity, known);
  for (const auto &cell : cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t face = (int64_t) cell.number * dim + c;
      const bool solved = pressure->is_next_to_water(cell, c);
      if (solved ||
          (pressure->open(cell.number, c) > 0.0 &&
           sums[(int64_t) cell.number * width + dim + c] > 0.0)) {
        velocity[face] += star[face];
        known[face] = 1.0;
      } else
        velocity[face] = known[face] = 0.0;
    }
  cells.keep_owned(velocity.data(), dim);
  cells.keep_owned(known.data(), dim);
  air->extend(AIR_LAYERS, velocity, known);
  if (stick)
    stick->hold(velocity);
  else if (regions)
    regions->hold(velocity);
  cells.reflect_velocities(velocity.data());
}

/* ----------------------------------------------------------------------
   Interpolation with quadratic splines adds h^2/8 of its second derivative along its own axis to a component.
   Here as much of the second differences along all axes is taken from all components, which keeps a field
   without divergence free of divergence. Where a neighbor has no velocity, far out in the air, there is no
   such difference.
------------------------------------------------------------------------- */

void FixMPMIncompressible::find_paths()
{
  const int dim = cells.lattice.dim;
  paths.assign(velocity.size(), 0.0);
  for (const auto &cell : cells.cells)
    for (int c = 0; c < dim; c++) {
      const int64_t face = (int64_t) cell.number * dim + c;
      double second = 0.0;
      for (int d = 0; d < dim; d++) {
        const int64_t lower = (int64_t) cell.near[2 * d] * dim + c,
                      upper = (int64_t) cell.near[2 * d + 1] * dim + c;
        const bool have_lower = known[lower] > 0.0 || cell.walls >> 2 * d & 1,
                   have_upper = known[upper] > 0.0 || cell.walls >> (2 * d + 1) & 1;
        if (have_lower && have_upper)
          second += velocity[lower] - 2.0 * velocity[face] + velocity[upper];
      }
      paths[face] = velocity[face] - SMOOTHED * second;
    }
  cells.publish(paths.data(), dim);
  cells.reflect_paths(paths.data());
}

/** Finds displacements by which points that are too close spread again. */
void FixMPMIncompressible::find_shift()
{
  shift.resize(star.size());
  known.assign(star.size(), 0.0);
  shift.assign(star.size(), 0.0);
  const auto report =
      pressure->spread(spread, shift.data(), known.data(),
                       {SPREAD_TOLERANCE, std::numeric_limits<double>::min(), most_iterations});
  if (!report.converged())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: the spreading of points {} at step {}; allow more iterations", style, id,
               report.describe(), update->ntimestep);
  air->extend(AIR_LAYERS, shift, known);
  if (regions) regions->hold(shift, false);
  cells.reflect_velocities(shift.data(), false);
}

/** Checks that what comes in has a way out, or a surface that rises: otherwise the pressure has no solution,
 *  and the one found is that of less inflow. */
void FixMPMIncompressible::check_inflow() const
{
  double mine[2] = {0.0, 0.0}, all[2];
  pressure->add_balance(velocity.data(), mine, mine + 1);
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  if (all[1] > 0.0 && std::fabs(all[0]) > NOT_IN * all[1])
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: at step {} there is no room for what fix mpm/emit brings: leave a free "
               "surface, or let fix mpm/absorb take as much away",
               style, id, update->ntimestep);
}

void FixMPMIncompressible::check_speed()
{
  const int dim = cells.lattice.dim;
  double most[1] = {0.0}, all[1];
  const auto look_at = [&](double v) {
    if (!std::isfinite(v)) most[0] = std::numeric_limits<double>::infinity();
    most[0] = std::max(most[0], std::fabs(v));
  };

  // the velocity of a moving wall is between those of faces next to it and of images beyond, which are
  // twice as fast, but move nothing

  for (const auto &cell : cells.cells)
    for (int c = 0; c < dim; c++) look_at(velocity[(int64_t) cell.number * dim + c]);
  for (int d = 0; d < dim; d++)
    for (const auto &wall : walls[d])
      for (int c = 0; c < dim; c++)
        if (wall.sticks) look_at(wall.v[c]);
  MPI_Allreduce(most, all, 1, MPI_DOUBLE, MPI_MAX, world);

  // with lists of grains alone, LAMMPS does not see how far points go, which must be less than a period

  gone += all[0] * update->dt;
  for (int d = 0; d < dim; d++)
    if (neighbor->includegroup && domain->periodicity[d] && gone > 0.25 * domain->prd[d])
      next_reneighbor = update->ntimestep;
  if (all[0] * update->dt <= MPMFlowLattice::MOST_MOTION * h) return;
  // what hits a wall flat is several times faster after the step: no limit by earlier speeds can foresee that

  const bool is_set = !modify->get_fix_by_style("^mpm/dt$").empty();
  error->all(FLERR, Error::NOLASTLINE,
             "Fix {} {}: at step {} the velocity {:.6g} is more than {} node spacings in a time "
             "step of {:.6g}; {}",
             style, id, update->ntimestep, all[0], MPMFlowLattice::MOST_MOTION, update->dt,
             is_set ? "where water hits a wall or water it is several times faster after one step: "
                      "give fix mpm/dt a smaller fraction, such as 0.4, or a smaller max"
                    : "reduce it, or let fix mpm/dt set it");
}

void FixMPMIncompressible::check_density(double of_fluid, const std::string &who) const
{
  if (std::fabs(of_fluid / density - 1.0) > SAME_DENSITY)
    error->all(FLERR, Error::NOLASTLINE,
               "{}: the density of the fluid is {}, but that of fix {} (style {}) is {}", who,
               of_fluid, id, style, density);
}

void FixMPMIncompressible::visit_batches(int group_bits, const BatchVisitor &visit)
{
  if (solids) solids->visit_batches(group_bits, visit);
}

double FixMPMIncompressible::spacing_around(const std::string &region) const
{
  return std::count(region_ids.begin(), region_ids.end(), region) ? h : 0.0;
}

/* ---------------------------------------------------------------------- */

double FixMPMIncompressible::stable_dt(tagint &tag) const
{
  double dt = std::numeric_limits<double>::max();
  tag = 0;
  if (thickest > 0.0 && !implicit)
    dt = MPMFlowViscosity::stable_dt(largest_nu(), h, cells.lattice.dim);
  if (solids) {
    tagint stiffest = 0;
    const double shear = solids->stable_dt(stiffest);
    if (shear < dt) {
      dt = shear;
      tag = stiffest;
    }
  }
  if (tension > 0.0)
    dt = std::min(dt, MPMFlowTension::stable_dt(tension * acceleration_of_stress(), h));

  // At the start of a run there are no forces yet. Those at the end of the last run count by the limit that
  // they gave, also if that run has written the restart file; at the start of the first run, gravity counts

  double g[3] = {0.0, 0.0, 0.0};
  if (!forces_known && limit_before > 0.0)
    dt = std::min(dt, limit_before);
  else if (!forces_known)
    weight(g);
  const double least = FIRST_FALL * MathExtra::len3(g) * force->ftm2v;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!cells.is_point(i)) continue;
    double square = 0.0, force_square = 0.0;
    for (int d = 0; d < cells.lattice.dim; d++) {
      square += atom->v[i][d] * atom->v[i][d];
      force_square += atom->f[i][d] * atom->f[i][d];
    }
    const double a = std::max(least, std::sqrt(force_square) * force->ftm2v / atom->rmass[i]);
    const double speed = 0.5 * (std::sqrt(square) + std::sqrt(square + 4.0 * a * h));
    if (speed * dt > h) {
      dt = h / speed;
      tag = atom->tag[i];
    } else if (!std::isfinite(speed)) {
      tag = atom->tag[i];
      return 0.0;
    }
  }
  double moving = regions ? regions->largest_speed() : 0.0;    // points next to it move with it
  for (const auto &axis_walls : walls)
    for (const auto &face : axis_walls)
      if (face.sticks && thickest > 0.0) moving = std::max(moving, MathExtra::len3(face.v));
  if (moving * dt > h) {
    dt = h / moving;
    tag = 0;
  }
  if (forces_known) limit_before = dt;
  return dt;
}

/* ----------------------------------------------------------------------
   scalar: number of iterations; vector: this number, what is left of the divergence (relative), largest |div
   v|, volume that points fill, number of wet cells, kinetic energy, largest speed, force on the six walls,
   iterations of the implicit viscosity, force on the regions, and energy that spreading has added; with gas:
   number of pockets that have some, highest and lowest pressure, volume, and energy; parts of the last step,
   and halvings so far
------------------------------------------------------------------------- */

double FixMPMIncompressible::compute_scalar()
{
  return last.iterations;
}

double FixMPMIncompressible::compute_vector(int k)
{
  double mine = 0.0, all;
  if (k == 0) return last.iterations;
  if (k == 1) return last.residual;
  if (k == 2 || k == 6) {
    if (k == 2) mine = last.divergence;
    for (int i = 0; k == 6 && i < atom->nlocal; i++)
      if (cells.is_point(i)) mine = std::max(mine, MathExtra::len3(atom->v[i]));
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, world);
    return all;
  }
  if (k == 3) mine = last.filled;
  if (k == 4) mine = last.wet;
  if (k == 5)
    for (int i = 0; i < atom->nlocal; i++)
      if (cells.is_point(i))
        mine += 0.5 * force->mvv2e * atom->rmass[i] * MathExtra::lensq3(atom->v[i]);
  if (k == 13) return last.of_stress;
  const int of_parts = size_vector - PART_VALUES, of_gas = of_parts - (gas ? GAS_VALUES : 0);
  if (k >= of_parts) return k == of_parts ? last.parts : halvings;
  if (k >= of_gas) return value_of_gas(k - of_gas);
  if (k == of_gas - 1)
    mine = energy_of_spread;
  else if (k > 13)
    mine = last.regions[k - 14];
  else if (k > 6)
    mine = last.walls[(k - 7) / 2][(k - 7) % 2];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** Writes the duration of the last step, the limit of the next one with its forces, the share that points
 *  keep, halvings, motion of regions, and gas. */
void FixMPMIncompressible::write_restart(FILE *fp)
{
  tagint tag;
  double mine = stable_dt(tag), limit;
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  double of_last[4];
  sum_last_step(true, of_last);
  if (comm->me) return;
  std::vector<double> state = {dt_before,  limit,    of_last[1], of_last[2],
                               of_last[3], halvings, 0.0,        0.0};
  if (regions) {
    const auto motion = regions->motion();
    state[6] = (double) motion.size();
    state.insert(state.end(), motion.begin(), motion.end());
  }
  if (gas) {
    const auto of_gas = gas->restart_data();
    state[7] = (double) of_gas.size();
    state.insert(state.end(), of_gas.begin(), of_gas.end());
  }
  const int size = state.size() * sizeof(double);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(state.data(), size, 1, fp);
}

void FixMPMIncompressible::restart(char *buf)
{
  double state[8];
  memcpy(state, buf, sizeof(state));
  dt_before = state[0];
  limit_before = state[1];
  for (int k = 0; k < 2; k++) unseen[k] = comm->me ? 0.0 : state[2 + k];
  energy_of_spread = comm->me ? 0.0 : state[4];
  halvings = state[5];
  std::vector<double> motion((std::size_t) state[6]);
  memcpy(motion.data(), buf + sizeof(state), motion.size() * sizeof(double));
  if (regions) regions->set_motion(motion);
  std::vector<double> of_gas((std::size_t) state[7]);
  memcpy(of_gas.data(), buf + sizeof(state) + motion.size() * sizeof(double),
         of_gas.size() * sizeof(double));
  if (gas && !gas->restart(of_gas.data(), of_gas.size()))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix {} {}: the gas in the restart file is that of a lattice with another node "
               "spacing: use the same one",
               style, id);
}

double FixMPMIncompressible::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + cells.memory_usage() + pressure->memory_usage() +
      air->memory_usage() + (regions ? regions->memory_usage() : 0.0) +
      (stick ? stick->memory_usage() : 0.0) + (grains ? grains->memory_usage() : 0.0) +
      (inflow ? inflow->memory_usage() : 0.0) + (solids ? solids->memory_usage() : 0.0);
  if (curved) bytes += curved->memory_usage();
  if (gas) bytes += gas->memory_usage() + gas_rows->memory_usage();
  if (stress) bytes += stress->memory_usage();
  if (viscosities) bytes += viscosities->memory_usage();
  for (const auto *list : {&lightness,
                           &face_volumes,
                           &paths,
                           &elastic,
                           &at_surface,
                           &potentials,
                           &viscous_velocity,
                           &before_forces,
                           &mobility,
                           &sums,
                           &share,
                           &old,
                           &star,
                           &more,
                           &velocity,
                           &known,
                           &pressures,
                           &shift,
                           &without_hold,
                           &start_of_part,
                           &psi_of_parts})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

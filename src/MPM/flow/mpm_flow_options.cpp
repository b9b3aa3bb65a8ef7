/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_options.h"

#include "error.h"
#include "force.h"
#include "group.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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
  o.add("open",
        {word(
            [this] {
              return open_face;
            },
            [this](int k) {
              open_face = k;
            },
            faces)},
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
         "leave viscosity out"},
        {!implicit && parts_are_given, "parts",
         "is about implicit viscosity, as the other equations are those of any time step: add the "
         "keywords viscosity and implicit yes, or remove it"},
        {!implicit || !is_viscous, "stick",
         "is about viscosity, in an implicit step, as an explicit one would be bound by the least "
         "distance of a face to a wall: add the keywords viscosity and implicit yes, or use the "
         "keyword region instead"},
        {tension > 0.0, "region",
         "cannot be used with tension, as a fluid that slips along it without friction never comes "
         "to rest: use the keyword stick with implicit viscosity instead, or walls of the box, or "
         "leave tension out"},
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
/* ---------------------------------------------------------------------- */

MPMFlowLiquids::MPMFlowLiquids(LAMMPS *lmp, const MPMIncompressibleOptions &options) :
    Pointers(lmp), largest_viscosity(options.largest_viscosity()), least_density(options.density),
    has_several_densities(!options.liquids.empty()), options(options)
{
  for (const auto &one : options.liquids) least_density = std::min(least_density, one.density);
}

void MPMFlowLiquids::find_groups()
{
  for (const auto &one : options.liquids) {
    const int igroup = group->find(one.group);
    if (igroup < 0)
      error->all(FLERR, "Fix mpm/incompressible liquid: group {} does not exist", one.group);
    bits.push_back(group->bitmask[igroup]);
  }
}

int MPMFlowLiquids::liquid(int mask) const
{
  int found = -1;
  for (std::size_t k = 0; k < bits.size(); k++)
    if (mask & bits[k]) found = (int) k;
  return found;
}

double MPMFlowLiquids::density(int mask) const
{
  const int k = liquid(mask);
  return k < 0 ? options.density : options.liquids[k].density;
}

double MPMFlowLiquids::acceleration_per_stress() const
{
  return force->ftm2v / (force->nktv2p * options.density);
}

double MPMFlowLiquids::largest_kinematic_viscosity() const
{
  if (!options.has_several_viscosities())
    return largest_viscosity * acceleration_per_stress() * options.density / least_density;
  double most = options.viscosity / options.density;
  for (const auto &one : options.liquids)
    most = std::max(most, options.viscosity_of(one) / one.density);
  return most * options.density * acceleration_per_stress();
}

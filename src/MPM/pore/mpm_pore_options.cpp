/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_options.h"

#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "input.h"
#include "material/material.h"
#include "material/material_point.h"
#include "math_extra.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

const char *const MPMPoreOptions::PART_NAME[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi", "free"};

Options MPMPoreOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/pore");
  o.argument(number(water.bulk, "K", POSITIVE, "pressure", "bulk modulus of the water"));
  o.argument(number(water.density, "RHO", POSITIVE, "mass/volume", "density of the water"));
  o.argument(number(water.resistance, "G", POSITIVE, "",
                    "divisor of permeabilities: unit weight of the water (pressure/length), or its "
                    "viscosity (pressure time)"));
  const auto value = [this](const std::string &meaning) {
    return std::vector<OptionValue>{number(next.permeability, "k", NOT_NEGATIVE, "", meaning)};
  };
  o.add("soil",
        {text(next.material, "ID", "ID of the fix mpm/material of the soil"),
         number(next.porosity, "n0", {0.0, 1.0, false}, "1", "initial porosity"),
         word(next.law,
              {{"constant", MPMPoreSoil::CONSTANT, "constant permeability k",
                value("permeability (velocity, or area with a viscosity)")},
               {"kozeny", MPMPoreSoil::KOZENY,
                "k times the ratio of n^3/(1-n)^2 to its initial value (Kozeny, Carman)",
                value("initial permeability")},
               {"squared", MPMPoreSoil::SQUARED,
                "k times the square of the ratio of present to initial volume",
                value("initial permeability")},
               {"formula",
                MPMPoreSoil::FORMULA,
                "",
                {text(next.formula, "v_name",
                      "permeability of each point, an atom-style variable")}}})},
        "pores of a material; given once for each soil")
      .then([this] {
        soils.push_back(next);
        next = {};
      })
      .standard("none");
  o.add("biot",
        {number(biot.first, "alpha", {0.0, 1.0, false, true}, "1", "coefficient of Biot"),
         number(biot.second, "Ks", POSITIVE, "pressure", "bulk modulus of the grains")},
        "grains that are not rigid, in the soil before this keyword")
      .then([this] {
        biot_alone = soils.empty();
        if (biot_alone) return;
        soils.back().biot = biot.first;
        soils.back().grains = biot.second;
      })
      .standard("1, rigid grains");
  const auto coefficient = [this](const std::string &name, const std::string &unit,
                                  const std::string &meaning) {
    return std::vector<OptionValue>{number(forchheimer_value, name, POSITIVE, unit, meaning)};
  };
  o.add("forchheimer",
        {word(forchheimer,
              {{"number", NUMBER, "",
                coefficient("b", "pressure time^2/length^3",
                            "pressure gradient per square of the flow")},
               {"ergun", ERGUN, "",
                coefficient(
                    "d", "distance",
                    "diameter of packed spheres, from which Ergun's law gives the coefficient")}})},
        "drag with the square of the flow, in addition to Darcy's law, in the soil before this "
        "keyword")
      .then([this] {
        forchheimer_alone = soils.empty();
        if (forchheimer_alone) return;
        soils.back().quadratic = forchheimer == NUMBER ? forchheimer_value : 0.0;
        soils.back().diameter = forchheimer == ERGUN ? forchheimer_value : 0.0;
      })
      .standard("none");
  o.add("expansion",
        {number(growth.first, "BS", ANY_NUMBER, "1/temperature",
                "volumetric thermal expansion coefficient of the grains: three times the linear "
                "coefficient"),
         number(growth.second, "BW", ANY_NUMBER, "1/temperature",
                "volumetric thermal expansion coefficient of the water")},
        "thermal expansion of grains and water of the soil before this keyword")
      .then([this] {
        growth_alone = soils.empty();
        if (growth_alone) return;
        soils.back().warms = true;
        soils.back().of_grains = growth.first;
        soils.back().of_water = growth.second;
      })
      .standard("none");
  o.add("formulation",
        {word(formulation,
              {{"u-p", U_P, "the water has no inertia relative to the soil: slow flow"},
               {"u-v-p", U_V_P,
                "the water has inertia relative to the soil: fast loads, and soils of high "
                "permeability"}})});
  const auto has_soil = [this](const char *keyword, bool with_retention) {
    if (soils.empty())
      without_soil = keyword;
    else if (with_retention && !soils.back().retention.can_dry())
      without_retention = keyword;
    else
      return true;
    return false;
  };
  const auto per_pressure = [this]() {
    return number(retention.alpha, "alpha", POSITIVE, "1/pressure",
                  "rate at which suction empties the pores");
  };
  o.add("retention",
        {word(
            retention.law,
            {{"vangenuchten",
              MPMRetention::VAN_GENUCHTEN,
              "(1 + (alpha s)^n)^(1/n - 1) at the suction s (van Genuchten)",
              {per_pressure(), number(retention.n, "n", {1.0, UNBOUNDED, false}, "1", "exponent")}},
             {"gardner", MPMRetention::GARDNER, "exp(-alpha s) (Gardner)", {per_pressure()}}})},
        "effective saturation of the soil before this keyword, which can lose its water")
      .then([this, has_soil] {
        if (!has_soil("retention", false)) return;
        auto &r = soils.back().retention;
        r.law = retention.law;
        r.alpha = retention.alpha;
        r.n = retention.n;
      })
      .standard("none: pores are always full");
  o.add("saturation",
        {number(retention.least, "Sr", {0.0, 1.0, true, false}, "1", "residual saturation"),
         number(retention.most, "Ss", {0.0, 1.0, false, true}, "1", "saturation without suction")},
        "range of the saturation of the soil before this keyword")
      .then([this, has_soil] {
        if (!has_soil("saturation", true)) return;
        soils.back().retention.least = retention.least;
        soils.back().retention.most = retention.most;
      })
      .standard("0 1");
  o.add("relative",
        {word(retention.flow,
              {{"mualem", MPMRetention::MUALEM, "model of Mualem, for vangenuchten"},
               {"power",
                MPMRetention::POWER,
                "",
                {number(retention.power, "e", NOT_NEGATIVE, "1",
                        "power of the effective saturation")}}})},
        "relative permeability of the soil before this keyword")
      .then([this, has_soil] {
        if (!has_soil("relative", true)) return;
        soils.back().retention.flow = retention.flow;
        soils.back().retention.power = retention.power;
      })
      .standard("mualem for vangenuchten, power 1 for gardner");
  o.add("bishop",
        {word(
            [this] {
              return retention.bishop_effective ? 1 : 0;
            },
            [this](int value) {
              retention.bishop_effective = value;
            },
            {{"saturation", 0, "the saturation"}, {"effective", 1, "the effective saturation"}})},
        "share of the water pressure in the effective stress of the soil before this keyword")
      .then([this, has_soil] {
        if (has_soil("bishop", true))
          soils.back().retention.bishop_effective = retention.bishop_effective;
      })
      .standard("saturation");
  for (int part = 0; part < MPMPoreSurface::NPART; part++) {
    MPMPoreCondition &c = conditions[part];
    const bool free = part == MPMPoreSurface::FREE;
    const auto of = [&c](const std::string &name, const std::string &unit,
                         const std::string &meaning) {
      return std::vector<OptionValue>{
          variables(&c.value, 1, name, unit, meaning + ", can be a variable")};
    };
    o.add(PART_NAME[part],
          {word(c.kind,
                {{"closed", MPMPoreCondition::CLOSED,
                  std::string("no water goes through ") +
                      (free ? "free surfaces of the soil" : "this face of the box")},
                 {"pressure", MPMPoreCondition::PRESSURE, "water outside has a pressure",
                  of("p", "pressure", "pressure of the water outside")},
                 {"head", MPMPoreCondition::HEAD, "water outside stands at rest up to a height",
                  of("z", "distance",
                     "height of the water table outside, measured against the direction of fix "
                     "gravity")},
                 {"flux", MPMPoreCondition::FLUX, "water flows in",
                  of("q", "velocity", "volume of water that flows in per area and time")},
                 {"rain", MPMPoreCondition::RAIN,
                  "rain falls; water that the soil does not take runs off",
                  of("q", "velocity", "volume of water that falls per area and time")},
                 {"seepage", MPMPoreCondition::SEEPAGE,
                  "water leaves where its pressure is above the pressure of the air, and no water "
                  "comes in"}})})
        .once();
  }
  o.add("bodies",
        {word(seals,
              {{"open", false, "the conditions of the free surface remain"},
               {"closed", true, "no water goes through the surface there"}})},
        "free surfaces of the soil that a body of fix mpm/rigid, or a region of fix mpm/boundary, "
        "touches")
      .standard("open");
  o.add("initial",
        {text(initial, "p",
              "initial pressure of the points; v_name: an atom-style variable, for points that "
              "exist when the fix is defined")});
  o.add("geostatic",
        {number(K0, "K0", NOT_NEGATIVE, "1", "ratio of horizontal to vertical effective stress"),
         number(table, "z", ANY_NUMBER, "distance",
                "height of the water table, measured against the direction of fix gravity")},
        "level ground and its water are initially at rest under their weight")
      .then([this] {
        geostatic = true;
      })
      .standard("none");
  o.add("suction",
        {number(most_suction, "s", NOT_NEGATIVE, "pressure",
                "largest suction of points above the water table of geostatic")})
      .standard("suction of water at rest");
  o.add("relax",
        {number(relax, "R", NOT_NEGATIVE, "1",
                "rate at which points approach the pressure of the nodes, relative to the rate at "
                "which waves cross a cell")});
  o.add(
      "stages",
      {integer(most_stages, "N", POSITIVE, "largest number of stages of the flow in a time step")});
  o.add(
       "every",
       {steps_or_auto(
           every,
           "largest number of steps after which water flows once, for the time of all of them",
           "as many steps as waves, a single stage of the flow, and thin layers of points permit")})
      .standard("auto where several steps can share one flow, otherwise 1");
  o.refuse([=] {
    const bool dries = std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
      return soil.retention.can_dry();
    });
    OptionRules rules = {{biot_alone, "biot", "needs a soil before it"},
                         {growth_alone, "expansion", "needs a soil before it"},
                         {forchheimer_alone, "forchheimer", "needs a soil before it"},
                         {formulation == U_V_P, "stages",
                          "is for formulation u-p: with u-v-p waves alone limit the time step"},
                         {formulation == U_V_P && every != 1 && every != NOT_GIVEN, "every",
                          "is for formulation u-p: with u-v-p water moves in each step"},
                         {dries && every != 1 && every != NOT_GIVEN, "every",
                          "does not go with retention: pores fill and empty in each step"},
                         {geostatic && initial != "0.0", "geostatic",
                          "gives points their pressure: leave out initial"},
                         {most_suction >= 0.0 && !geostatic, "suction", "needs geostatic"},
                         {most_suction >= 0.0 && !dries, "suction", "needs a soil with retention"},
                         {!without_soil.empty(), without_soil, "needs a soil before it"},
                         {!without_retention.empty(), without_retention,
                          "needs the retention of the soil before it"}};
    for (int part = 0; part < MPMPoreSurface::NPART; part++)
      rules.push_back({formulation == U_V_P &&
                           (conditions[part].kind == MPMPoreCondition::RAIN ||
                            conditions[part].kind == MPMPoreCondition::SEEPAGE),
                       PART_NAME[part],
                       "rain and seepage are for formulation u-p: use flux or pressure"});
    for (int face = 4; face < 6; face++)
      rules.push_back({dim == 2 && conditions[face].kind != MPMPoreCondition::CLOSED,
                       PART_NAME[face], "does not exist in 2d"});
    for (const auto &soil : soils) {
      rules.push_back({soil.biot < soil.porosity, "biot",
                       "must not be below the porosity of the soil: {biot}"});
      const auto &r = soil.retention;
      rules.push_back({r.can_dry() && (soil.biot < 1.0 || soil.grains > 0.0), "retention",
                       "needs rigid grains: leave out biot for this soil"});
      rules.push_back({r.can_dry() && soil.warms, "retention",
                       "does not go with expansion: leave one of them out for this soil"});
      rules.push_back({r.can_dry() && formulation == U_V_P, "retention",
                       "is for formulation u-p: with u-v-p pores are always full"});
      rules.push_back({r.can_dry() && !soil.is_linear(), "retention",
                       "does not go with forchheimer: leave one of them out for this soil"});
      rules.push_back({r.least >= r.most, "saturation", "must have Sr below Ss"});
      rules.push_back({r.law == MPMRetention::GARDNER && r.flow == MPMRetention::MUALEM, "relative",
                       "mualem is for retention vangenuchten: use power with gardner"});
      rules.push_back({soil.law == MPMPoreSoil::FORMULA && soil.formula.compare(0, 2, "v_") != 0,
                       "soil", "needs a variable, v_name, for its formula"});
    }
    return rules;
  });
  return o;
}

bool MPMPoreOptions::warms() const
{
  return std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.warms;
  });
}

bool MPMPoreOptions::can_dry() const
{
  return std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.retention.can_dry();
  });
}

bool MPMPoreOptions::has(const std::string &material) const
{
  return std::any_of(soils.begin(), soils.end(), [&](const MPMPoreSoil &soil) {
    return soil.material == material;
  });
}

void MPMPoreChecks::check_soils() const
{
  std::set<std::string> known;
  for (const auto &soil : options.soils) {
    auto *const fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!fix)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore soil: there is no fix mpm/material {}",
                 soil.material);
    if (!known.insert(soil.material).second)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore has soil {} twice", soil.material);
    fix->mass_varies = true;
    const double grains = fix->material->density() - soil.porosity * options.water.density;
    if (soil.retention.can_dry() && !(grains > 0.0))
      error->all(FLERR, Error::NOLASTLINE,
                 "The density of fix mpm/material {} is below that of the water in its pores: fix "
                 "mpm/pore takes it for that of the soil with full pores",
                 soil.material);
    if (soil.warms && fix->temperature() < 0)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore expansion: soil {} has no temperature: its material needs a thermal "
                 "part",
                 soil.material);
    if (!soil.warms && fix->material->is_thermoelastic())
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/pore: the stress of soil {} changes with its temperature, and so would the "
          "pressure of the water, as if grains and water did not expand: use expansion with "
          "what both do, three times that of the material for the grains",
          soil.material);
    if (soil.law != MPMPoreSoil::FORMULA) continue;
    const int index = input->variable->find(soil.formula.c_str() + 2);
    if (index < 0 || !input->variable->atomstyle(index))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/pore soil {} {}",
                 soil.formula.substr(2), soil.material,
                 index < 0 ? "does not exist" : "is not atom-style");
  }
}

/** Bulk modulus of the soil without its water, for new points: by a compression that is small, and
 *  slow for any viscosity. */
static double bulk_modulus(const Material &material)
{
  constexpr double SMALL = 1.0e-6, LONG = 1.0e12;
  const double A[9] = {-SMALL, 0.0, 0.0, 0.0, -SMALL, 0.0, 0.0, 0.0, -SMALL};
  MaterialPoint point(material);
  const double before = point.pressure();
  point.move(A, LONG);
  return (point.pressure() - before) / (1.0 - point.batch.J[0]);
}

/** Checks soils with grains that are not rigid. The moduli of grains and soil give the coefficient
 *  of Biot, 1 - K/Ks. No arrangement of grains is stiffer than their share of the volume (Voigt),
 *  so this coefficient is not below the porosity. */
void MPMPoreChecks::check_grains()
{
  constexpr double CLOSE = 0.1, ROUNDED = 1.001;    // coefficients of Biot; numbers of few digits
  if (grains_known) return;
  for (const auto &soil : options.soils) {
    const auto *const fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!(soil.grains > 0.0)) continue;
    const double K = bulk_modulus(*fix->material), most = (1.0 - soil.porosity) * soil.grains;
    if (K > most * ROUNDED)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore biot: grains with the bulk modulus {:.6g} make no soil with that of "
                 "fix mpm/material {}, {:.6g}, but with at most (1 - n0) Ks = {:.6g}: Ks is that "
                 "of the mineral",
                 soil.grains, soil.material, K, most);
    const double alpha = 1.0 - K / soil.grains;
    if (comm->me == 0 && fabs(alpha - soil.biot) > CLOSE)
      error->warning(FLERR,
                     "Fix mpm/pore: soil {} has the coefficient of Biot {:.4g}, but its bulk "
                     "modulus at first, {:.4g}, and that of its grains, {:.4g}, make 1 - K/Ks = "
                     "{:.4g}: pressures and settlements go by the former",
                     soil.material, soil.biot, K, soil.grains, alpha);
  }
  grains_known = true;
}

MPMPoreChecks::Extent::Extent()
{
  std::fill_n(lo, 3, std::numeric_limits<double>::max());
  std::fill_n(hi, 3, -std::numeric_limits<double>::max());
}

void MPMPoreChecks::Extent::take(const double *x)
{
  for (int d = 0; d < 3; d++) {
    lo[d] = std::min(lo[d], x[d]);
    hi[d] = std::max(hi[d], x[d]);
  }
}

double MPMPoreChecks::Extent::largest(int dim) const
{
  double size = 0.0;
  for (int d = 0; d < dim; d++) size = std::max(size, hi[d] - lo[d]);
  return size;
}

/** The weight of water per volume is the divisor of hydraulic conductivities. With permeabilities
 *  in units of area it is a viscosity, which may be anything but these numbers. */
void MPMPoreChecks::compare_weight(const double *gravity)
{
  constexpr double SAME = 0.02, THOUSAND = 1000.0;
  const MPMPoreWater &water = options.water;
  const double g = MathExtra::len3(gravity), weight = water.density * g * force->nktv2p;
  if (!(weight > 0.0)) return;
  const auto is_near = [&](double other) {
    return fabs(water.resistance - other) < SAME * other;
  };
  const bool right = water.resistance > 0.5 * weight && water.resistance < 2.0 * weight;
  const bool wrong = !right &&
      (is_near(g) || is_near(water.density) || is_near(THOUSAND * weight) ||
       is_near(weight / THOUSAND));
  doubts.check(MPMDoubts::WATER_WEIGHT, wrong ? 1.0 : 0.0, "Fix mpm/pore " + id,
               fmt::format("the weight of the water per volume is {:.6g}, and its density {:.6g} "
                           "times gravity {:.6g} is {:.6g}",
                           water.resistance, water.density, g, weight));
}

/** Any way of pressure may be meant, but not one that is nothing on the lattice, and not a drag
 *  that is nothing for waves across all of the soil. */
void MPMPoreChecks::compare_flow(const MPMPoreSoil &soil, const Material &material, double size,
                                 const Scene &scene)
{
  if (soil.law == MPMPoreSoil::FORMULA || !(soil.permeability > 0.0)) return;
  const std::string who = fmt::format("Fix mpm/pore {}: soil {}", id, soil.material);
  const double mobility = soil.permeability / options.water.resistance;
  double stiffness = MPMRestModuli(material).compression;
  if (!(stiffness > 0.0)) stiffness = bulk_modulus(material);
  if (!(stiffness > 0.0)) return;
  const double spread = mobility * stiffness * scene.duration;
  if (scene.duration > 0.0)
    doubts.check(MPMDoubts::NO_FLOW, spread / (scene.h * scene.h), who,
                 fmt::format("in the time {:.6g} of the run, pressure spreads by {:.3g}",
                             scene.duration, sqrt(spread)));
  const double units = force->nktv2p * force->mvv2e,
               speed = sqrt(stiffness / (material.density() * units));
  const double waits = mobility * material.density() * units, crosses = size / speed;
  if (crosses > 0.0)
    doubts.check(MPMDoubts::FREE_FLOW, waits / crosses, who,
                 fmt::format("water and grains take the time {:.3g} to move together, and waves "
                             "{:.3g} to cross the soil",
                             waits, crosses));
}

void MPMPoreChecks::compare_soil(const MPMPoreSoil &soil, const Material &material, bool has_weight,
                                 double size, const Scene &scene)
{
  const std::string who = fmt::format("Fix mpm/pore {}: soil {}", id, soil.material);
  const MPMPoreWater &water = options.water;
  const double all = material.density(), wet = soil.porosity * water.density;
  const double grains = (all - wet) / (1.0 - soil.porosity);
  if (!has_weight)
    doubts.check(MPMDoubts::LIGHT_SOIL, all / wet, who,
                 fmt::format("the density {:.6g} is below that of the water in its pores, {:.6g}",
                             all, wet));
  doubts.check(
      MPMDoubts::HEAVY_GRAINS, grains / water.density, who,
      fmt::format("grains have the density {:.6g}, the water {:.6g}", grains, water.density));
  compare_flow(soil, material, size, scene);
  const double stiffness = MPMRestModuli(material).compression;
  if (!(stiffness > 0.0) || soil.retention.can_dry()) return;
  doubts.check(MPMDoubts::SOFT_WATER, water.bulk / (soil.porosity * stiffness), who,
               fmt::format("the water has the bulk modulus {:.6g}, and the skeleton the stiffness "
                           "{:.6g}",
                           water.bulk, stiffness));
}

void MPMPoreChecks::warn_of_soils(const std::vector<Extent> &extents, bool has_weight,
                                  const Scene &scene)
{
  compare_weight(scene.gravity);
  for (std::size_t k = 0; k < options.soils.size(); k++) {
    const auto &soil = options.soils[k];
    const auto *const fix =
        dynamic_cast<const FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!fix) continue;    // init() reports this
    Extent all;
    MPI_Allreduce(extents[k].lo, all.lo, 3, MPI_DOUBLE, MPI_MIN, world);
    MPI_Allreduce(extents[k].hi, all.hi, 3, MPI_DOUBLE, MPI_MAX, world);
    const bool is_there = all.hi[0] >= all.lo[0];
    if (is_there)
      compare_soil(soil, *fix->material, has_weight, all.largest(domain->dimension), scene);
    if (comm->me) continue;
    const double density = fix->material->density(), water = soil.porosity * options.water.density;
    if (!is_there)
      error->warning(FLERR,
                     "Fix mpm/pore {} has no points of soil {}: only points of the fix "
                     "mpm/material that soil names have water",
                     id, soil.material);
    else if (has_weight && density <= water)
      error->warning(FLERR,
                     "Fix mpm/pore {}: soil {} has the density {:.6g}, which is not more than "
                     "that of the water in its pores, {:.6g}, so that grains have a weight "
                     "below zero: it must be that of saturated soil",
                     id, soil.material, density, water);
  }
}

void MPMPoreChecks::check_implicit() const
{
  const auto refuse = [&](bool broken, const char *what, const char *remedy) {
    if (broken)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore {} cannot be used with fix mpm/implicit: {}", what, remedy);
  };
  refuse(options.formulation == MPMPoreOptions::U_V_P, "formulation u-v-p",
         "slow flow has no inertia of its own, use formulation u-p, or explicit steps");
  refuse(options.sets_relax, "relax", "it is of the waves of explicit steps, remove it");
  refuse(options.sets_stages, "stages", "the flow of an implicit step has none, remove it");
  refuse(options.sets_every && options.waits(), "every",
         "soil and water are solved for together, remove it");
  for (const auto &soil : options.soils) {
    refuse(soil.retention.can_dry(), "retention",
           "use explicit steps, or leave it out where pores stay full");
    refuse(soil.of_grains != 0.0 || soil.of_water != 0.0, "expansion", "use explicit steps");
    refuse(!soil.is_linear(), "forchheimer", "use explicit steps, or leave it out for slow flow");
  }
}

void MPMPoreChecks::check_motion(const Fix &fix, MPMField &field) const
{
  refuse_field(
      lmp, fix, field,
      {{field.options.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
        "formulation u-v-p takes a part off the mass of nodes: use apic, aflip, or flip"}});
  for (const auto *material : field.materials)
    for (const auto &soil : options.soils)
      if (soil.material == material->id &&
          material->material->density() <= soil.porosity * options.water.density)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/pore formulation u-v-p: soil {} has the density {}, which is not more "
                   "than that of the water in its pores, {}: it must be that of saturated soil",
                   soil.material, material->material->density(),
                   soil.porosity * options.water.density);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_pore_options.h"

#include "base/mpm_options.h"

#include <algorithm>

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

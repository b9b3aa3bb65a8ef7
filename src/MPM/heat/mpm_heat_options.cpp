/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "heat/mpm_heat_flow.h"

#include "base/mpm_options.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

const char *const MPMHeatOptions::FACE_NAME[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};

/** fix ID all mpm/heat keyword values ... */
Options MPMHeatOptions::declare(int dim)
{
  using namespace option;
  using Condition = MPMHeatCondition;
  Options o("fix mpm/heat");
  const auto with = [](const char *name, int kind, const OptionValue &value) {
    return OptionWord{name, kind, "", {value}};
  };
  const auto words = [with](Condition &c, const std::string &where) {
    const auto values = [&c](int n, const std::string &names, const std::string &unit,
                             const std::string &meaning, int first = 0) {
      return variables(c.value + first, n, names, unit, meaning + ", can be a variable");
    };
    const OptionValue outside = values(1, "Tout", "temperature", "temperature outside", 1);
    return word(
        c.kind,
        {{"insulated", Condition::INSULATED, "no heat goes through " + where},
         with("temperature", Condition::TEMPERATURE,
              values(1, "T", "temperature", "temperature of the material there")),
         with("flux", Condition::FLUX,
              values(1, "q", "power/area",
                     "heat that flows into the material there, per area and time")),
         {"convection",
          Condition::CONVECTION,
          "",
          {values(1, "H", "power/(area temperature)", "heat transfer coefficient"), outside}},
         {"radiation", Condition::RADIATION, "", {values(1, "EPS", "1", "emissivity"), outside}}});
  };
  for (int face = 0; face < MPMHeatFaces::NFACE; face++)
    o.add(FACE_NAME[face], {words(conditions[face], "this face of the box")}).once();
  o.add("region",
        {text(surface.region, "REG",
              "ID of a region, through whose surface heat flows to material that touches it from "
              "outside"),
         words(surface.condition, "this surface")})
      .standard("none")
      .then([this] {
        surfaces.push_back(surface);
        surface = {};
      });
  o.add("surface", {words(surface.condition, "free surfaces")})
      .standard("insulated")
      .once()
      .then([this] {
        surface.region.clear();
        surfaces.push_back(surface);
        surface = {};
      });
  enum { CONDUCTANCE };
  o.add("contact",
        {text(pair.field[0], "F1",
              "IDs of the fix mpm of two bodies that exchange heat where they touch"),
         text(pair.field[1], "F2"),
         word(
             [] {
               return (int) CONDUCTANCE;
             },
             [](int) {
             },
             {with("conductance", CONDUCTANCE,
                   variables(&pair.conductance, 1, "H", "power/(area temperature)",
                             "heat per area, time, and temperature difference, can be a "
                             "variable"))})})
      .standard("none")
      .then([this] {
        pairs.push_back(pair);
      });
  o.add("source", {text(source, "v_name", "power per volume, an equal- or atom-style variable")})
      .standard("none")
      .once();
  o.add(
      "transfer",
      {word(
          transfer.kind,
          {{"relax",
            MPMHeatTransfer::RELAX,
            "points get the temperature change of the nodes",
            {number(transfer.relax, "R", NOT_NEGATIVE, "1",
                    "rate at which points approach the temperature of the nodes, relative to the "
                    "rate at which heat crosses a cell")}},
           {"pic", MPMHeatTransfer::PIC, "points get the temperature of the nodes"},
           {"affine", MPMHeatTransfer::AFFINE,
            "points get the temperature of the nodes, and its gradient"},
           {"xpic",
            MPMHeatTransfer::XPIC,
            "points get the change of the nodes, and keep the part of their own temperature that "
            "nodes can represent",
            {integer(
                transfer.order, "order", {1, 100, true},
                "number of terms in the series for the inverse of the matrix of capacities")}}})});
  o.add("stages",
        {integer(most_stages, "N", POSITIVE,
                 "largest number of stages of the conduction in a time step")});
  o.add(
      "every",
      {steps_or_auto(
          every, "number of steps after which heat is conducted once, for the time of all of them",
          "as many steps as possible while the state changes little, up to 10")});
  o.add(
      "time",
      {word(
          in_time.time,
          {{"explicit", MPMDiffusionOptions::EXPLICIT, "in stages (RKL2), of second order in time"},
           {"euler", MPMDiffusionOptions::EULER, "backward Euler: implicit, first order in time"},
           {"sdirk2", MPMDiffusionOptions::SDIRK2,
            "two implicit stages, of second order in time"}})});
  o.add(
      "tolerance",
      {number(
          in_time.tolerance, "R", {0.0, 1.0, false, false}, "",
          "for implicit steps: imbalance of heat at the nodes, relative to the heat of the step")});
  o.add("grains", {yes_no(grains)},
        "exchange heat between points and grains, with the temperatures and heat flows of atoms");
  o.add("penalty", {yes_no(penalty)},
        "convert the energy lost by friction and damping of pair style mpm/penalty into heat of "
        "the points");
  o.refuse([=] {
    const bool is_explicit = in_time.time == MPMDiffusionOptions::EXPLICIT;
    OptionRules rules = {
        {!source.empty() && source.compare(0, 2, "v_") != 0, "source",
         "must be a variable, v_name: {source}"},
        {!is_explicit, "stages", "is of explicit steps: remove it, or use time explicit"},
        {is_explicit, "tolerance", "is of implicit steps: remove it, or use time euler or sdirk2"}};
    for (std::size_t k = 0; k < pairs.size(); k++) {
      const auto &[F, H, now] = pairs[k];
      const std::string bodies = F[0] + " " + F[1];
      rules.push_back({F[0] == F[1], "contact", "needs two different bodies: " + bodies});
      rules.push_back({H.variable.empty() && !(H.value >= 0.0), "contact",
                       "needs a conductance that is not negative: " + bodies});
      for (std::size_t j = 0; j < k; j++) {
        const auto &other = pairs[j].field;
        const bool same = F[0] == other[0] && F[1] == other[1];
        rules.push_back({same || (F[0] == other[1] && F[1] == other[0]), "contact",
                         "is given twice for the same bodies: " + bodies});
      }
    }
    const auto refuse = [&](const Condition &c, const std::string &keyword) {
      const auto below = [&](int k, double least) {
        return k < c.nvalue() && c.value[k].variable.empty() && !(c.value[k].value >= least);
      };
      rules.push_back({c.kind >= Condition::CONVECTION && below(0, 0.0), keyword,
                       "needs a coefficient that is not negative"});
      rules.push_back(
          {c.kind == Condition::RADIATION && c.value[0].variable.empty() && c.value[0].value > 1.0,
           keyword, "needs an emissivity that is not above 1"});
      rules.push_back({c.kind == Condition::RADIATION && below(1, 0.0), keyword,
                       "needs an absolute temperature outside, not below 0"});
    };
    for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
      rules.push_back({dim == 2 && face >= 4, FACE_NAME[face], "does not exist in 2d"});
      refuse(conditions[face], FACE_NAME[face]);
    }
    for (std::size_t k = 0; k < surfaces.size(); k++) {
      const auto &[region, condition] = surfaces[k];
      refuse(condition, region.empty() ? "surface" : "region");
      for (std::size_t j = 0; j < k; j++)
        rules.push_back({!region.empty() && surfaces[j].region == region, "region",
                         "is given twice for the same region: " + surfaces[k].region});
    }
    return rules;
  });
  return o;
}

bool MPMHeatOptions::radiates()
{
  bool any = false;
  each_condition([&](const MPMHeatCondition &c, const std::string &) {
    any = any || c.kind == MPMHeatCondition::RADIATION;
  });
  return any;
}

bool MPMHeatOptions::has_variables()
{
  bool any = !source.empty();
  each_condition([&](const MPMHeatCondition &c, const std::string &) {
    for (int k = 0; k < c.nvalue(); k++) any = any || !c.value[k].variable.empty();
  });
  for (const auto &p : pairs) any = any || !p.conductance.variable.empty();
  return any;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/fix_mpm_pore.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "base/mpm_steps_or_auto.h"
#include "comm.h"
#include "contact/fix_mpm_rigid.h"
#include "contact/mpm_leaks.h"
#include "contact/pair_mpm_penalty.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "force.h"
#include "implicit/fix_mpm_implicit.h"
#include "implicit/fix_mpm_relax.h"
#include "input.h"
#include "material/material.h"
#include "material/material_point.h"
#include "math_const.h"
#include "modify.h"
#include "pore/mpm_geostatic.h"
#include "step/fix_mpm.h"
#include "update.h"
#include "variable.h"
#include "walls/fix_mpm_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   fix ID all mpm/pore K RHO G keyword values ...
------------------------------------------------------------------------- */

static const char *const PART_NAME[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi", "free"};

// longest wait for the next flow: node spacings that waves travel, and explicit limits of the flow
static constexpr double MOST_SPACINGS = 2.5, MOST_LIMITS = 10.0;
// points that are farther apart than this many node spacings are as stiff as a lattice can be; their waves have the frequency 2/crossing
static constexpr double FINE = 0.6;
// root of the mean square of slopes of points in layers (MPMPore::Layers), equal to the frequency of their waves times crossing;
// the lattice damps waves up to this frequency in MOST_SPACINGS
static constexpr double SLOW = 1.45;
// longest wait with auto, over the time in which flow crosses a layer that is so thin that the pressure changes across it by all of its
// range: in explicit limits it is 6 THIN times the square of the thickness in node spacings
static constexpr double THIN = 0.02;
// factor within which times are equal on paper, as sums of ranks differ by round-off
static constexpr double NEARLY = 1.0 + 1.0e-6;

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
  const auto of_soil = [this](const char *keyword, bool of_retention) {
    if (soils.empty())
      without_soil = keyword;
    else if (of_retention && !soils.back().retention.can_dry())
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
      .then([this, of_soil] {
        if (!of_soil("retention", false)) return;
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
      .then([this, of_soil] {
        if (!of_soil("saturation", true)) return;
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
      .then([this, of_soil] {
        if (!of_soil("relative", true)) return;
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
      .then([this, of_soil] {
        if (of_soil("bishop", true))
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

FixMPMPore::FixMPMPore(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1, "Fix mpm/pore acts on all points of its soils: use group all");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  sets_relax = options.given("relax");
  sets_stages = options.given("stages");
  sets_every = options.given("every");
  if (sets_every && waits() && sets_relax)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/pore relax has no meaning with every {}, where points take the pressure of "
               "the nodes in each flow: remove it",
               every == AUTO ? "auto" : std::to_string(every));
  if (soils.empty())
    error->all(FLERR, narg - 1,
               "Fix mpm/pore needs a soil: use soil with the ID of a fix mpm/material, its "
               "porosity, and permeability");
  initial_index = -1;
  if (initial.compare(0, 2, "v_") == 0) {
    initial_index = input->variable->find(initial.c_str() + 2);
    if (initial_index < 0 || !input->variable->atomstyle(initial_index))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/pore initial {}",
                 initial.substr(2), initial_index < 0 ? "does not exist" : "is not atom-style");
  } else {
    initial_value = utils::numeric(FLERR, initial, false, lmp);
  }
  state.declare(pressure, "mpm/pore:pressure", 1 + domain->dimension, [this](int, double *row) {
    row[0] = initial_value;
  });
  // declared even if water does not wait now: a run that continues from a restart file may have other conditions
  if (can_wait()) state.declare(since, "mpm/pore:since");
  if (formulation == U_V_P) state.declare(inertia, "mpm/pore:flow", domain->dimension);
  if (can_dry())
    state.declare(content, "mpm/pore:water", [](int, double *row) {
      row[0] = -1.0;
    });
  if (warms())
    state.declare(warmth, "mpm/pore:temperature", [](int, double *row) {
      row[0] = MPMPore::UNKNOWN;
    });
  const auto at_first = initial_pressures();    // may end with an error: before there are callbacks
  keep_arrays();
  scalar_flag = vector_flag = 1;
  size_vector = MPMPoreSurface::NPART;
  for (auto *list : {&came, &in_step, &present, &flows})
    list->assign(MPMPoreSurface::NPART + 1, 0.0);
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  for (std::size_t i = 0; i < at_first.size(); i++) pressure[i][0] = at_first[i];
  if (initial_index >= 0) gradients_known = false;
  for (const auto &soil : soils)
    if (auto *fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material)))
      fix->mass_varies = true;
}

FixMPMPore::~FixMPMPore()
{
  for (const auto &soil : soils)
    if (auto *fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material)))
      fix->mass_varies = false;
}

/* ----------------------------------------------------------------------
   initial pressures of the present points; a restart file has others
------------------------------------------------------------------------- */

std::vector<double> FixMPMPore::initial_pressures() const
{
  if (initial_index < 0) return {};
  std::vector<double> values(atom->nmax);
  input->variable->compute_atom(initial_index, igroup, values.data(), 1, 0);
  values.resize(atom->nlocal);
  for (int i = 0; i < atom->nlocal; i++)
    if (!std::isfinite(values[i]))
      error->one(FLERR, "Variable {} for fix mpm/pore initial is {} at point {}", initial.substr(2),
                 values[i], atom->tag[i]);
  return values;
}

/* ---------------------------------------------------------------------- */

void FixMPMPore::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "one has all soils, each with a keyword soil");
  std::set<std::string> known;
  for (const auto &soil : soils) {
    auto *const fix = dynamic_cast<FixMPMMaterial *>(modify->get_fix_by_id(soil.material));
    if (!fix)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore soil: there is no fix mpm/material {}",
                 soil.material);
    if (!known.insert(soil.material).second)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore has soil {} twice", soil.material);
    fix->mass_varies = true;
    const double grains = fix->material->density() - soil.porosity * water.density;
    if (soil.retention.can_dry() && !(grains > 0.0))
      error->all(FLERR, Error::NOLASTLINE,
                 "The density of fix mpm/material {} is below that of the water in its pores: fix "
                 "mpm/pore takes it for that of the soil with full pores",
                 soil.material);
    if (soil.warms && fix->find_history("temperature") < 0)
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
  check_grains();
  weight = MPMGravity(lmp, "Fix mpm/pore");
  for (int part = 0; part < MPMPoreSurface::NPART; part++) {
    auto &c = conditions[part];
    if (c.kind == MPMPoreCondition::CLOSED) continue;
    if (part < MPMPoreSurface::NFACE && domain->periodicity[part / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore face {} belongs to a periodic axis: use boundary f there",
                 PART_NAME[part]);
    if (c.kind == MPMPoreCondition::HEAD && weight.empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore {} head needs a fix gravity of group all, which tells where up is",
                 PART_NAME[part]);
    find_variable(lmp, c.value, std::string("fix mpm/pore ") + PART_NAME[part]);
  }
}

/** Bulk modulus of the soil without its water, for new points: by a compression that is small, and slow for any viscosity. */
static double bulk_modulus(const Material &material)
{
  constexpr double SMALL = 1.0e-6, LONG = 1.0e12;
  const double A[9] = {-SMALL, 0.0, 0.0, 0.0, -SMALL, 0.0, 0.0, 0.0, -SMALL};
  MaterialPoint point(material);
  const double before = point.pressure();
  point.move(A, LONG);
  return (point.pressure() - before) / (1.0 - point.batch.J[0]);
}

/** Checks soils with grains that are not rigid. The moduli of grains and soil give the coefficient of Biot, 1 - K/Ks. No arrangement of
 *  grains is stiffer than their share of the volume (Voigt), so this coefficient is not below the porosity. */
void FixMPMPore::check_grains()
{
  constexpr double CLOSE = 0.1, ROUNDED = 1.001;    // coefficients of Biot; numbers of few digits
  if (grains_known) return;
  for (const auto &soil : soils) {
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

/** Warns of pair styles between points, which do not know the share of the water in a contact. */
void FixMPMPore::warn_of_contact() const
{
  if (comm->me || wet.empty()) return;
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const penalty = dynamic_cast<const PairMPMPenalty *>(style.pair);
    if (penalty ? penalty->has_friction() : style.name.compare(0, 4, "gran") == 0)
      error->warning(
          FLERR,
          "Pair style {}: any friction on soils of fix mpm/pore {} is that of the total stress, "
          "with "
          "the pressure of the water: use fix mpm/contact, fix mpm/boundary with a region, or fix "
          "mpm/rigid, which know what water bears",
          style.name, id);
  }
}

/** Finds bodies that close the free surface where they touch it. */
void FixMPMPore::find_seals()
{
  rigid_bodies.clear();
  walls.clear();
  if (!seals) return;
  if (conditions[MPMPoreSurface::FREE].kind == MPMPoreCondition::CLOSED)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/pore bodies closed needs a free surface that is open elsewhere: use free, "
               "or leave it out");
  for (const auto *body : find_fixes<FixMPMRigid>(lmp)) rigid_bodies.push_back(body);
  for (const auto *wall : find_fixes<FixMPMBoundary>(lmp))
    if (wall->is_region()) walls.push_back(wall);
  if (rigid_bodies.empty() && walls.empty())
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/pore bodies closed: there is no fix mpm/rigid, and no fix mpm/boundary with "
        "a region");
}

double FixMPMPore::distance_to_bodies(const double *x, double far) const
{
  double least = far;
  for (const auto *body : rigid_bodies) least = std::min(least, body->distance(x, far));
  for (const auto *wall : walls) least = std::min(least, wall->distance(x, far));
  return least;
}

/** Warns of soils without points, as with the ID of another material, where the ground stays dry, and of soils that are lighter than their
 *  water, whose grains have a negative weight; without gravity, this is a way to allow longer steps. here: which soils have points on
 *  this rank. */
static void warn_of_soils(LAMMPS *lmp, const std::string &id, const std::vector<MPMPoreSoil> &soils,
                          const std::vector<int> &here, const MPMPoreWater &water, bool has_weight)
{
  std::vector<int> anywhere(here.size(), 0);
  MPI_Allreduce(here.data(), anywhere.data(), (int) here.size(), MPI_INT, MPI_MAX, lmp->world);
  for (std::size_t k = 0; k < soils.size() && lmp->comm->me == 0; k++) {
    const auto &soil = soils[k];
    const auto *const fix =
        dynamic_cast<const FixMPMMaterial *>(lmp->modify->get_fix_by_id(soil.material));
    if (!fix) continue;    // init() reports this
    const double density = fix->material->density(), of_water = soil.porosity * water.density;
    if (!anywhere[k])
      lmp->error->warning(FLERR,
                          "Fix mpm/pore {} has no points of soil {}: only points of the fix "
                          "mpm/material that soil names have water",
                          id, soil.material);
    else if (has_weight && density <= of_water)
      lmp->error->warning(FLERR,
                          "Fix mpm/pore {}: soil {} has the density {:.6g}, which is not more than "
                          "that of the water in its pores, {:.6g}, so that grains have a weight "
                          "below zero: it must be that of saturated soil",
                          id, soil.material, density, of_water);
  }
}

void FixMPMPore::init_physics(MPMPlan &plan)
{
  if (moves() && !find_fixes<FixMPMRelax>(lmp).empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/relax cannot bring water with inertia to rest: use formulation u-p of fix "
               "{} {} until bodies are at rest",
               style, id);
  fields.clear();
  wet.clear();
  steps.clear();
  steps.add(in_step, present);
  find_seals();
  if (!sets_every) every = needs_each_step() ? 1 : AUTO;
  for (auto *field : plan.fields) {
    fields.push_back(std::make_unique<MPMPore>(lmp, *field, water, conditions, gravity, relax,
                                               formulation == U_V_P));
    auto &mine = *fields.back();
    if (seals)
      mine.surface.distance_to_seals = [this](const double *x, double far) {
        return distance_to_bodies(x, far);
      };
    if (waits()) mine.wait_with(since);
    mine.init(soils, content, warmth);
    if (!mine.has_water()) continue;
    wet.push_back(&mine);
    if (formulation == U_V_P) init_motion(*field);
    const auto &o = field->options;
    refuse_field(
        lmp, *this, *field,
        {{o.shape != QUADRATIC && o.shape != CUBIC, "this shape", "use shape quadratic or cubic"},
         {o.scheme != MPMFieldOptions::USL, "this scheme", "use scheme usl"},
         {o.total, "frame total", "use frame updated"},
         {o.axisymmetric, "axisymmetric", "use a plane or 3d"},
         {o.modified_edges, "edges modified", "use edges plain"},
         {o.averages_stress() || o.averages_volume() || o.averages_strain(), "locking",
          "the pressure of the water is an average already: use locking none"}});
    steps.add(mine.nodes.value, mine.nodes.rate);
  }
  std::vector<int> here(soils.size(), 0);
  for (int i = 0; i < atom->nlocal; i++) {
    const auto *const of_point = atom->vfrac[i] > 0.0 ? soil_of(i) : nullptr;
    for (std::size_t k = 0; k < soils.size() && of_point; k++)
      if (soils[k].material == of_point->material) here[k] = 1;
  }
  warn_of_soils(lmp, id, soils, here, water, !MPMGravity(lmp, "Fix mpm/pore").empty());
  find_crossing();
  warn_of_contact();
  is_implicit = !wet.empty() && !find_fixes<FixMPMImplicit>(lmp).empty();
  if (!waits()) end_wait();
  watched.points = -1;    // velocities may have been set since the last run
  watched.flows = 0;
  // soils that dry have no other formulation, and bodies that relax to rest have no motion of their own
  watches_inertia = !inertia_known && formulation == U_P && !is_implicit && !can_dry() &&
      find_fixes<FixMPMRelax>(lmp).empty();
  if (is_implicit) init_implicit();
}

/** Ends a wait if water flows in each step from now on. The run before, or that of a restart file, may have ended between two flows:
 *  then points get all of their pressure, and the next flow also covers the time of the wait. */
void FixMPMPore::end_wait()
{
  for (int i = 0; i < atom->nlocal && can_wait(); i++) {
    const bool changed = waited.steps > 0.0 && since[i] > 0.0 && atom->vfrac[i] > 0.0;
    const MPMPoreSoil *const soil = changed ? soil_of(i) : nullptr;
    if (soil) pressure[i][0] += soil->undrained(since[i], MPMPoints::get(atom)->jacobian(i), water);
    since[i] = 0.0;
  }
  waited.steps = 0.0;
  if (!is_implicit) return;
  // explicit steps that follow start afresh
  waited.time = 0.0;
  rates_known = false;
  thinned = std::numeric_limits<double>::max();
}

void FixMPMPore::find_crossing()
{
  crossing = std::numeric_limits<double>::max();
  const double unit = force->mvv2e * force->nktv2p;
  for (const auto *mine : wet)
    for (const auto *fix : mine->field.materials)
      for (const auto &soil : soils) {
        if (soil.material != fix->id) continue;
        const double stiff = soil.storage_at(1.0, water) * fix->material->density() * unit;
        crossing = std::min(crossing, mine->field.lattice.h * sqrt(stiff) / soil.biot);
      }
}

/** Checks options that implicit steps cannot have: their equations are linear in the pressure of nodes. */
void FixMPMPore::init_implicit() const
{
  const auto refuse = [&](bool broken, const char *what, const char *remedy) {
    if (broken)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore {} cannot be used with fix mpm/implicit: {}", what, remedy);
  };
  refuse(formulation == U_V_P, "formulation u-v-p",
         "slow flow has no inertia of its own, use formulation u-p, or explicit steps");
  refuse(sets_relax, "relax", "it is of the waves of explicit steps, remove it");
  refuse(sets_stages, "stages", "the flow of an implicit step has none, remove it");
  refuse(sets_every && waits(), "every", "soil and water are solved for together, remove it");
  for (const auto &soil : soils) {
    refuse(soil.retention.can_dry(), "retention",
           "use explicit steps, or leave it out where pores stay full");
    refuse(soil.of_grains != 0.0 || soil.of_water != 0.0, "expansion", "use explicit steps");
    refuse(!soil.is_linear(), "forchheimer", "use explicit steps, or leave it out for slow flow");
  }
}

/** Checks that the mass that moves by itself is less than all mass, and that nodes have accelerations. */
void FixMPMPore::init_motion(MPMField &field)
{
  field.keep_old = true;
  refuse_field(
      lmp, *this, field,
      {{field.options.series != MPMFieldOptions::LUMPED, "transfer xpic and fmpm",
        "formulation u-v-p takes a part off the mass of nodes: use apic, aflip, or flip"}});
  for (const auto *fix : field.materials)
    for (const auto &soil : soils)
      if (soil.material == fix->id && fix->material->density() <= soil.porosity * water.density)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/pore formulation u-v-p: soil {} has the density {}, which is not more "
                   "than that of the water in its pores, {}: it must be that of saturated soil",
                   soil.material, fix->material->density(), soil.porosity * water.density);
}

MPMPore &FixMPMPore::of(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore does not know fix mpm {}", field.id());
  return *fields[0];
}

void FixMPMPore::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place == MPMPlan::BEFORE_POINTS_TO_NODES)
    plan.together("pore pressure", [this]() {
      step_flows = is_time_to_flow();
      begin_step(step_flows);
    });
  if (place == MPMPlan::BEFORE_SOLVE && formulation == U_V_P)
    plan.together("inertia of pore water", [this]() {
      take_off();
    });
  if (place == MPMPlan::AFTER_SOLVE && !is_implicit) {
    const auto move = [this](MPMField &field) {
      if (step_flows) of(field).take_motion(waited.time + field.step_dt());
    };
    plan.each("nodes to points with material", move, [this](const MPMField &field) {
      return of(field).moves_first();
    });
    plan.together("flow of pore water", [this]() {
      flow();
    });
  }
  // at this point, fix mpm/implicit has left the velocities of the step on nodes
  if (place == MPMPlan::BEFORE_STRAIN && is_implicit)
    plan.together("flow of pore water", [this]() {
      take_solution();
    });
}

/* ----------------------------------------------------------------------
   pores of soils without retention are full of water, also above the water table, where suction holds it
------------------------------------------------------------------------- */

void FixMPMPore::setup_points()
{
  const bool at_rest = geostatic && !has_state;
  for (const auto *mine : wet) {
    const auto *const fix = dynamic_cast<FixMPM *>(modify->get_fix_by_id(mine->field.id()));
    if (fix && fix->rests_dry && !geostatic && !has_state)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pore: points of fix mpm {} have the stress of mpm_geostatic, which does "
                 "not know pore water: use keyword geostatic of fix mpm/pore in its place",
                 mine->field.id());
  }
  has_state = true;
  if (!at_rest) {
    weigh_points();
    return;
  }
  if (fields.size() != 1)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore geostatic needs one fix mpm, not {}",
               fields.size());
  weight.find(gravity);
  MPMGeostatic ground(lmp, fields[0]->field, gravity, "Fix mpm/pore geostatic");
  const auto &where = ground.ground();
  if (table > where.top + 0.01 * fields[0]->field.lattice.h)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/pore geostatic: the water table {} is above the surface of the soil, {:.6g}: "
        "water on the soil changes no effective stress, use the height of the surface",
        table, where.top);
  const double slope = water.density * where.weight * force->nktv2p;
  for (int i = 0; i < atom->nlocal; i++) {
    std::fill_n(pressure[i], 1 + domain->dimension, 0.0);
    const MPMPoreSoil *const soil = soil_of(i);
    if (!soil) continue;
    pressure[i][0] = slope * (table - ground.height(i));
    pressure[i][1 + where.axis] = -slope * where.up;
    if (most_suction < 0.0 || pressure[i][0] >= -most_suction || !soil->retention.can_dry())
      continue;
    pressure[i][0] = -most_suction;
    pressure[i][1 + where.axis] = 0.0;
  }
  weigh_points();
  ground.set_stress(K0, [&](int i) {
    const auto *const soil = soil_of(i);
    if (!soil) return 0.0;
    return soil->biot * soil->retention.at(pressure[i][0]).bishop * pressure[i][0];
  });
}

/** Finds the water of new points from their pressure. */
void FixMPMPore::weigh_points()
{
  if (!can_dry()) return;
  for (const auto &mine : fields) mine->weigh_points(pressure);
}

void FixMPMPore::evaluate_variables()
{
  weight.find(gravity);
  const bool formulas = std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.law == MPMPoreSoil::FORMULA;
  });
  bool any = formulas;
  for (const auto &c : conditions) any = any || !c.value.variable.empty();
  evaluate_in_step(lmp, any, [&] {
    for (auto &c : conditions) {
      c.now = evaluate(lmp, c.value);
      if (c.kind == MPMPoreCondition::RAIN && c.now < 0.0)
        error->all(FLERR, Error::NOLASTLINE, "Fix mpm/pore {} rain is {}: it must not be negative",
                   PART_NAME[&c - conditions.data()], c.now);
    }
    if (!formulas) return;
    formula_values.assign(atom->nmax, 0.0);
    std::vector<double> values(atom->nmax);
    for (const auto &soil : soils) {
      if (soil.law != MPMPoreSoil::FORMULA) continue;
      const int index = input->variable->find(soil.formula.c_str() + 2);
      input->variable->compute_atom(index, igroup, values.data(), 1, 0);
      for (int i = 0; i < atom->nlocal; i++) {
        const auto *const of_point = soil_of(i);
        if (!of_point || of_point->material != soil.material) continue;
        if (!(values[i] >= 0.0) || !std::isfinite(values[i]))
          error->one(FLERR, "Variable {} for fix mpm/pore soil {} is {} at point {}",
                     soil.formula.substr(2), soil.material, values[i], atom->tag[i]);
        formula_values[i] = values[i];
      }
    }
  });
}

/** Warns of materials without water that are thinner than the reach of nodes, at the first step, once. */
void FixMPMPore::look_for_leaks()
{
  if (leaks_known) return;
  leaks_known = true;
  for (auto *mine : wet) {
    const auto &all = mine->field.materials;
    if (std::all_of(all.begin(), all.end(), [&](const auto *material) {
          return has(material->id);
        }))
      continue;
    const auto leaks = find_leaks(mine->field, world, [&](const FixMPMMaterial *material) {
      return has(material->id);
    });
    if (leaks.nodes && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/pore: material without water is so thin that water leaks through it, at {} "
          "nodes "
          "of fix mpm {}, one of them at {:.6g} {:.6g} {:.6g}: let it have three node spacings",
          leaks.nodes, mine->field.id(), leaks.first[0], leaks.first[1], leaks.first[2]);
  }
}

/** Warns once of pores that are shut, where the equations hold neither for the soil nor for its water. */
void FixMPMPore::look_for_shut_pores()
{
  if (shut_known) return;
  tagint mine = MAXTAGINT, lowest;
  for (const auto *field : wet) mine = std::min(mine, field->shut_point());
  MPI_Allreduce(&mine, &lowest, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  if (lowest == MAXTAGINT) return;
  shut_known = true;
  double here[2] = {0.0, 0.0}, of_all[2];
  for (int i = 0; mine == lowest && i < atom->nlocal; i++)
    if (atom->tag[i] == lowest) {
      here[0] = MPMPoints::get(atom)->jacobian(i);
      here[1] = soil_of(i)->shut();
    }
  MPI_Allreduce(here, of_all, 2, MPI_DOUBLE, MPI_MAX, world);
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore: the pores of point {} are shut: it has {:.4g} of its initial volume, while "
        "the "
        "grains alone have {:.4g}, 1 - n0: use a law that becomes stiff before pores close, or "
        "check n0, the stiffness of the soil, and its load",
        lowest, of_all[0], of_all[1]);
}

/** Must water flow in each step if every is not given? It must with effects that cannot wait, with input that varies from step to step,
 *  and with free surfaces, whose flow is more exact if less of it comes at once. */
bool FixMPMPore::needs_each_step() const
{
  const bool differs = std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.law == MPMPoreSoil::FORMULA || !soil.is_linear();
  });
  const bool varies = std::any_of(conditions.begin(), conditions.end(), [](const auto &c) {
    return !c.value.variable.empty();
  });
  return formulation == U_V_P || can_dry() || warms() || sets_relax || differs || varies ||
      conditions[MPMPoreSurface::FREE].kind != MPMPoreCondition::CLOSED ||
      !find_fixes<FixMPMImplicit>(lmp).empty();
}

/** Is there flow in the step that begins? With auto, flow takes one stage, which costs least and is as exact as flow in each step
 *  even where the soil is soft compared with its water and drains through a curved surface. */
bool FixMPMPore::is_time_to_flow() const
{
  if (!waits() || !rates_known || (every != AUTO && waited.steps + 1.0 >= every)) return true;
  const double limit = MPMSuperStep::explicit_limit(conducted + exchanged);
  double most = std::min(longest_wait(), std::min(MOST_LIMITS, reach_of_stages()) * limit);
  if (every == AUTO) most = std::min({most, limit, thinned > 0.0 ? THIN / thinned : limit});
  return waited.time + 2.0 * fields[0]->field.step_dt() > most * NEARLY;
}

/** Flow that starts and stops makes waves, whose length is the distance that waves travel in between. The lattice damps those of up to
 *  some node spacings; longer ones grow with each flow. In between, points have pressures of their own, of which a flow keeps only what
 *  nodes see. A wave that nodes do not see grows if it has turned by more than half of its period by then. For points that are a
 *  node spacing apart its frequency is 2/crossing; with closer points none is above 1.4/crossing, for which the former bound is enough,
 *  together with the damping of such waves by transfers of velocities. */
double FixMPMPore::longest_wait() const
{
  if (!coarse) return MOST_SPACINGS * crossing;
  const double dt = fields[0]->field.step_dt();
  const double turns = 2.0 * asin(std::min(1.0, dt / crossing));    // in a step
  return dt * std::floor(MathConst::MY_PI / turns * NEARLY);
}

/** Longest flow, in limits of an explicit step. */
double FixMPMPore::reach_of_stages() const
{
  return most_stages < 3 ? 0.5 : MPMSuperStep::reach(most_stages);
}

/** Number of stages. One is enough up to the explicit limit if steps of the motion are shorter than half of it (see mpm_pore.cpp). */
int FixMPMPore::stages_of(double duration, double limit) const
{
  const bool one = duration <= 0.5 * limit || (waited.steps > 0.0 && duration <= limit * NEARLY);
  return one ? 1 : std::max(3, MPMSuperStep::count(duration, limit, most_stages));
}

void FixMPMPore::begin_step(bool with_flow)
{
  look_for_leaks();
  if (with_flow || !gradients_known) evaluate_variables();
  const double *const formula = formula_values.empty() ? nullptr : formula_values.data();
  for (auto *field : wet) {
    if (field->motion) field->motion->begin_step(inertia);
    if (!gradients_known) field->find_gradients(pressure, formula);
    if (with_flow) field->begin_step(pressure, inertia, formula, waited.steps > 0.0);
    if (!with_flow) field->begin_wait(pressure);
  }
  if (with_flow) watch_inertia();
  if (with_flow) look_for_shut_pores();
  gradients_known = true;
}

void FixMPMPore::take_off()
{
  for (auto *field : wet) field->take_off();
}

void FixMPMPore::topology_changed(MPMField &field)
{
  if (of(field).has_water()) field.jacobians.ask();
}

void FixMPMPore::find_greatest_rates()
{
  double mine[3] = {0.0, 0.0, 0.0}, all[3];
  for (const auto *field : wet) {
    mine[0] = std::max(mine[0], field->conduction_rate());
    mine[1] = std::max(mine[1], field->exchange_rate());
    mine[2] = std::max(mine[2], field->widest_spacing());
  }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_MAX, world);
  conducted = all[0];
  exchanged = all[1];
  if (waits()) find_coarse_points(all[2]);
  rates_known = true;
}

/** Finds how thin layers are from the pressures after a flow, see THIN. */
void FixMPMPore::find_thin_layers()
{
  MPMPore::Slopes mine, all;
  for (const auto *field : wet) field->add_slopes(pressure, mine);
  MPI_Allreduce(&mine, &all, sizeof(mine) / sizeof(double), MPI_DOUBLE, MPI_MAX, world);
  const double range = all.highest + all.less;
  thinned = range > 0.0 ? all.steepest / (range * range) : 0.0;
}

/** Finds whether points are coarse: wide, or in layers that are a node spacing apart along one axis and close along
 *  another. */
void FixMPMPore::find_coarse_points(double widest)
{
  coarse = widest > FINE;
  for (const auto *field : wet) {
    const auto &soils_here = field->layers_of_points();
    std::vector<double> mine, all;
    for (const auto &soil : soils_here) {
      mine.push_back(soil.volume);
      mine.insert(mine.end(), soil.steep, soil.steep + 3);
    }
    all.resize(mine.size());
    MPI_Allreduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM,
                  world);
    for (std::size_t k = 0; k < all.size(); k += 4)
      for (int d = 1; d <= 3 && all[k] > 0.0; d++)
        coarse = coarse || all[k + d] > SLOW * SLOW * all[k];
  }
}

/** Warns once of flow through a surface that is not a face of the box, in a lump that one stage cannot take. */
void FixMPMPore::look_for_long_flow(double duration, double limit)
{
  if (long_known || every == AUTO || waited.steps == 0.0 || duration <= limit * NEARLY ||
      conditions[MPMPoreSurface::FREE].kind == MPMPoreCondition::CLOSED)
    return;
  long_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore every {}: {} steps have one flow, for {:.3g} times its explicit "
                   "limit: curved surfaces of soft soil drain too fast then, by 1 to 2 % of the "
                   "pressure: use every auto",
                   every, waited.steps + 1.0, duration / limit);
}

/** Warns once of pressures that vary over some cells and that points have lost to nodes in long runs, where the flow itself is too slow
 *  for that. */
void FixMPMPore::look_for_smoothing(double duration)
{
  constexpr double MUCH = 0.02, OF_FLOW = 0.2;
  if (smooth_known) return;
  MPMPore::Smoothing most = {0.0, 0.0};
  for (const auto *mine : wet) {
    const auto here = mine->smoothing(duration);
    if (here.share * here.over_flow > most.share * most.over_flow) most = here;
  }
  smoothed += most.share;
  if (smoothed < MUCH || most.over_flow < OF_FLOW) return;
  smooth_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/pore {}: pressures that vary over {} node spacings have lost {:.0f} % "
                   "to {}, {:.2g} times what flow has taken, and become too even in a long run: "
                   "use {}, a smaller spacing, or fix mpm/implicit",
                   id, MPMPore::Smoothing::WAVELENGTH, 100.0 * smoothed,
                   waits() ? "every" : "relax", most.over_flow,
                   waits() ? "every 1 and a small relax" : "a smaller relax");
}

/** Measures the neglected acceleration between every fourth flow, see MPMPore::inertia(): relevant motion is slower than waves of the
 *  lattice. */
void FixMPMPore::watch_inertia()
{
  constexpr int EACH = 4;
  if (!watches_inertia || watched.flows++ % EACH) return;
  MPMPore::Inertia mine, all;
  for (const auto *field : wet) mine.add(field->inertia(pressure));
  const double here[4] = {mine.velocity, mine.flow, mine.gradient, mine.kinetic};
  double sum[4];
  MPI_Allreduce(here, sum, 4, MPI_DOUBLE, MPI_SUM, world);
  all = {sum[0], sum[1], sum[2], sum[3]};
  const double now = update->atime + (update->ntimestep - update->atimestep) * update->dt,
               passed = now - watched.time;
  if (watched.points == atom->natoms && passed > 0.0) {
    const double rate = (sqrt(all.velocity) - sqrt(watched.last.velocity)) / passed;
    watched.left_out += rate * rate * passed;
    watched.flow += 0.5 * (all.flow + watched.last.flow) * passed;
    watched.gradient += 0.5 * (all.gradient + watched.last.gradient) * passed;
    watched.exchanged += fabs(all.kinetic - watched.last.kinetic);
  }
  watched.most = std::max(watched.most, all.kinetic);
  watched.last = all;
  watched.time = now;
  watched.points = atom->natoms;
}

/* ----------------------------------------------------------------------
   does the acceleration matter that u-p neglects? It does if its part in the energy that the flow has dissipated is not
   small, and not small relative to the energy of the motion. Waves of a load that comes at once satisfy the latter,
   too, but slow flow then dissipates far more in the end. Ground that nearly rests has small accelerations relative
   to that of its weight, and runs that end before the motion has come to rest for the first time do not allow a
   judgment yet. Warns once
------------------------------------------------------------------------- */

void FixMPMPore::post_run()
{
  constexpr double OF_FLOW = 0.03, OF_MOTION = 0.02, OF_WEIGHT = 1.0e-4, UP_AND_DOWN = 1.5,
                   FALLEN = 0.5;
  const double part = watched.left_out;
  const bool has_swung = watched.exchanged > UP_AND_DOWN * watched.most ||
      watched.last.kinetic < FALLEN * watched.most;
  if (inertia_known || !has_swung || !(part > OF_FLOW * watched.flow) ||
      !(part > OF_MOTION * watched.exchanged) || !(part > OF_WEIGHT * watched.gradient))
    return;
  inertia_known = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/pore {}: formulation u-p leaves out the acceleration of the water, which in these "
        "runs is {:.0f} % of what drives its flow, in the root of the mean square: waves fade too "
        "fast, and fast flow is wrong: use formulation u-v-p",
        id, std::min(999.0, 100.0 * sqrt(part / watched.flow)));
}

/** Finds the rates before the very first step. */
void FixMPMPore::know_rates()
{
  if (rates_known) return;
  auto *const plan = fields[0]->field.plan;
  plan->find_blocks_now();
  begin_step(true);
  find_greatest_rates();
  for (auto *field : plan->fields) field->map->valid = false;    // the step finds its own blocks
}

void FixMPMPore::flow()
{
  const double dt = waited.time + fields[0]->field.step_dt();
  if (!step_flows) {
    waited.steps++;
    waited.time = dt;
    return;
  }
  for (auto *field : wet) {
    if (!field->moves_first()) field->take_motion(dt);
    field->move_water();
  }
  // with inertia, flow is a part of waves, and these limit the step
  if (formulation == U_P) find_greatest_rates();
  const double limit = MPMSuperStep::explicit_limit(conducted + exchanged);
  const int stages = stages_of(dt, limit);
  if (formulation == U_P) look_for_long_flow(dt, limit);
  look_for_smoothing(dt);
  waited = {};
  if (stages > most_stages)
    error->all(FLERR, Error::NOLASTLINE,
               "The time step {:.6g} is {:.4g} times the explicit limit {:.4g} of the flow of pore "
               "water, which needs more than {} stages: use fix mpm/dt, a smaller timestep, or fix "
               "mpm/pore ... stages{}",
               dt, dt / limit, limit, most_stages,
               can_dry()
                   ? "; where the last pores fill in a soil with retention, use a smaller bulk "
                     "modulus of the water, K"
                   : "");
  std::fill(in_step.begin(), in_step.end(), 0.0);
  steps.advance(stages, dt, [this]() {
    std::fill(present.begin(), present.end(), 0.0);
    for (auto *field : wet) field->find_rates(present);
  });
  for (auto *field : wet) field->end_step(pressure, dt);
  if (waits()) find_thin_layers();
  for (std::size_t k = 0; k < came.size(); k++) came[k] += in_step[k];
  dt_last = dt;
  flows_known = false;
}

/** Takes the pressures at the end of an implicit step, which were solved together with the motion. */
void FixMPMPore::take_solution()
{
  const double dt = fields[0]->field.step_dt();
  std::fill(present.begin(), present.end(), 0.0);
  for (auto *field : wet) field->take_solution(present);
  for (auto *field : wet) field->end_step(pressure, dt);
  for (std::size_t k = 0; k < came.size(); k++) came[k] += in_step[k] = dt * present[k];
  dt_last = dt;
  flows_known = false;
}

bool FixMPMPore::surface_force(MPMField &field, const std::vector<char> &near,
                               std::vector<double> &force) const
{
  const MPMPore &mine = of(field);
  if (mine.has_water()) mine.find_surface_force(pressure, near, force);
  return mine.has_water();
}

double FixMPMPore::stable_dt(const MPMField &field, tagint &tag) const
{
  if (formulation == U_V_P) return std::numeric_limits<double>::max();
  const_cast<FixMPMPore *>(this)->know_rates();
  const double rate = of(field).conduction_rate(pressure, tag);
  if (rate < 0.0) return std::numeric_limits<double>::max();
  const double limit = MPMSuperStep::explicit_limit(std::max(rate, conducted) + exchanged);
  return reach_of_stages() * limit;
}

/* ----------------------------------------------------------------------
   volume of water that has come in so far, and the flow (volume per time) in the last step
------------------------------------------------------------------------- */

double FixMPMPore::compute_scalar()
{
  double mine = 0.0, all;
  for (int part = 0; part < size_vector; part++) mine += came[part];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMPore::compute_vector(int i)
{
  if (!flows_known) {
    MPI_Allreduce(in_step.data(), flows.data(), size_vector, MPI_DOUBLE, MPI_SUM, world);
    for (double &flow : flows) flow /= dt_last;
    flows_known = true;
  }
  return flows[i];
}

/* ----------------------------------------------------------------------
   the energy that the water stores, and the part of its kinetic energy that mass and velocity of points do not include,
   for compute mpm/energy and the energy watch
------------------------------------------------------------------------- */

void FixMPMPore::account(double *values) const
{
  double sum = 0.0, moving = 0.0;
  const auto *const points = MPMPoints::get(atom);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->vfrac[i] > 0.0)) continue;
    const MPMPoreSoil *const soil = soil_of(i);
    if (!soil) continue;
    const double J = points->jacobian(i), p = pressure_now(i);
    sum += J * atom->vfrac[i] * MPMPoreMoisture::energy(*soil, J, p, water);
    if (!inertia) continue;
    const double pores = J * soil->pores_at(J);
    for (int d = 0; d < domain->dimension; d++)
      moving += atom->vfrac[i] * inertia[i][d] * (atom->v[i][d] + 0.5 * inertia[i][d] / pores);
  }
  values[0] += sum / force->nktv2p + water.density * moving * force->mvv2e;
  values[1] += came[MPMPoreSurface::ENERGY] / force->nktv2p;
}

void FixMPMPore::write_restart(FILE *fp)
{
  write_totals(fp, world, came,
               {gradients_known ? 1.0 : 0.0, has_state ? 1.0 : 0.0, rates_known ? 1.0 : 0.0,
                conducted, exchanged, coarse ? 1.0 : 0.0, waited.steps, waited.time, thinned});
}

void FixMPMPore::restart(char *buf)
{
  const auto *const list = (const double *) buf, *const same = list + came.size();
  if (comm->me == 0) std::copy_n(list, came.size(), came.begin());
  gradients_known = same[0] != 0.0;
  has_state = same[1] != 0.0;
  rates_known = same[2] != 0.0;
  conducted = same[3];
  exchanged = same[4];
  coarse = same[5] != 0.0;
  waited = {same[6], same[7]};
  thinned = same[8];
}

/** Pressure of a point between two flows. */
double FixMPMPore::pressure_now(int i) const
{
  if (waited.steps == 0.0) return pressure[i][0];
  for (const auto *mine : wet)
    if (mine->field.is_point(i)) return pressure[i][0] + mine->undrained(i);
  return pressure[i][0];
}

const MPMPoreSoil *FixMPMPore::soil_of(int i) const
{
  for (const auto *mine : wet)
    if (mine->field.is_point(i)) return mine->soil_of(i);
  return nullptr;
}

bool FixMPMPore::warms() const
{
  return std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.warms;
  });
}

bool FixMPMPore::can_dry() const
{
  return std::any_of(soils.begin(), soils.end(), [](const auto &soil) {
    return soil.retention.can_dry();
  });
}

std::vector<std::string> FixMPMPore::quantities() const
{
  std::vector<std::string> names = {"pore", "porosity", "saturation"};
  for (int d = 0; formulation == U_V_P && d < domain->dimension; d++)
    names.push_back(std::string("flow_") + (char) ('x' + d));
  return names;
}

double FixMPMPore::quantity(int k, int i) const
{
  const MPMPoreSoil *const soil = soil_of(i);
  if (!soil) return 0.0;
  if (k == 0) return pressure_now(i);
  if (k == 2) return soil->retention.at(pressure[i][0]).saturation;
  const double J = MPMPoints::get(atom)->jacobian(i);
  return k == 1 ? std::max(0.0, soil->porosity_at(J)) : inertia[i][k - 3] / J;
}

double FixMPMPore::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + steps.memory_usage() +
      formula_values.capacity() * sizeof(double);
  for (const auto &field : fields) bytes += field->memory_usage();
  return bytes;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "heat/fix_mpm_heat.h"

#include "atom.h"
#include "base/mpm_clear.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_steps_or_auto.h"
#include "comm.h"
#include "contact/fix_mpm_contact.h"
#include "contact/mpm_leaks.h"
#include "contact/pair_mpm_penalty.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "force.h"
#include "implicit/fix_mpm_implicit.h"
#include "input.h"
#include "modify.h"
#include "refine/fix_mpm_refine.h"
#include "refine/mpm_two_scale.h"
#include "region.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace LAMMPS_NS;
using namespace FixConst;
using namespace MPM_NS;

static const char *const FACE_NAME[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};

/* ----------------------------------------------------------------------
   fix ID all mpm/heat keyword values ...
------------------------------------------------------------------------- */

Options MPMHeatOptions::declare(int dim)
{
  using namespace option;
  using Condition = MPMHeatCondition;
  Options o("fix mpm/heat");
  const auto words = [](Condition &c, const std::string &where) {
    const auto values = [&c](int n, const std::string &names, const std::string &unit,
                             const std::string &meaning, int first = 0) {
      return variables(c.value + first, n, names, unit, meaning + ", can be a variable");
    };
    const OptionValue outside = values(1, "Tout", "temperature", "temperature outside", 1);
    return word(
        c.kind,
        {{"insulated", Condition::INSULATED, "no heat goes through " + where},
         {"temperature",
          Condition::TEMPERATURE,
          "",
          {values(1, "T", "temperature", "temperature of the material there")}},
         {"flux",
          Condition::FLUX,
          "",
          {values(1, "q", "power/area",
                  "heat that flows into the material there, per area and time")}},
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
  o.add(
       "contact",
       {text(pair.field[0], "F1",
             "IDs of the fix mpm of two bodies that exchange heat where they touch"),
        text(pair.field[1], "F2"),
        word(
            [] {
              return (int) CONDUCTANCE;
            },
            [](int) {
            },
            {{"conductance",
              CONDUCTANCE,
              "",
              {variables(&pair.conductance, 1, "H", "power/(area temperature)",
                         "heat per area, time, and temperature difference, can be a variable")}}})})
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
      rules.push_back({F[0] == F[1], "contact", "needs two different bodies: {contact}"});
      rules.push_back({H.variable.empty() && !(H.value >= 0.0), "contact",
                       "needs a conductance that is not negative: {contact}"});
      for (std::size_t j = 0; j < k; j++) {
        const auto &other = pairs[j].field;
        const bool same = F[0] == other[0] && F[1] == other[1];
        rules.push_back({same || (F[0] == other[1] && F[1] == other[0]), "contact",
                         "is given twice for the same bodies: {contact}"});
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
                         "is given twice for the same region: {region}"});
    }
    return rules;
  });
  return o;
}

FixMPMHeat::FixMPMHeat(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/heat acts on all points whose material has a part thermal conducting: use "
               "group all");
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = places_of_contacts() + (int) pairs.size();
  for (auto *heats : {&in_step, &present, &power}) heats->assign(size_vector, 0.0);
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  if (transfer.has_slopes()) state.declare(gradients, "mpm/heat:gradient", domain->dimension);
  grains_said = options.given("grains");
  penalty_said = options.given("penalty");
  if (penalty) state.declare(rubbing, "mpm/heat:rubbing", 1);
  if (grains) {
    state.declare(waiting, "mpm/heat:waiting", 1);
    grain_heat = std::make_unique<MPMGrainHeat>(lmp, waiting);
    nevery = 1;
  }
  keep_arrays();
}

int FixMPMHeat::setmask()
{
  const int report = in_time.time == MPMDiffusionOptions::EXPLICIT ? 0 : (int) POST_RUN;
  return report | (grains ? POST_INTEGRATE | POST_FORCE | END_OF_STEP : 0) |
      (penalty ? (int) POST_FORCE : 0);
}

/* ----------------------------------------------------------------------
   constant of Stefan and Boltzmann in the units of the input; 0 where these have no kelvins
------------------------------------------------------------------------- */

double FixMPMHeat::sigma() const
{
  struct {
    const char *name;
    double energy, time, length;    // in SI units
  } const units[] = {{"si", 1.0, 1.0, 1.0},
                     {"cgs", 1.0e-7, 1.0, 1.0e-2},
                     {"micro", 1.0e-15, 1.0e-6, 1.0e-6},
                     {"nano", 1.0e-21, 1.0e-9, 1.0e-9},
                     {"metal", 1.602176634e-19, 1.0e-12, 1.0e-10},
                     {"real", 4184.0 / 6.02214076e23, 1.0e-15, 1.0e-10},
                     {"electron", 4.3597447222071e-18, 1.0e-15, 0.529177210903e-10}};
  for (const auto &u : units)
    if (!strcmp(update->unit_style, u.name))
      return 5.670374419e-8 * u.time * u.length * u.length / u.energy;
  return 0.0;
}

/* ---------------------------------------------------------------------- */

void FixMPMHeat::init()
{
  require_field(lmp, *this);
  if (grains) require_each_step("grains yes");
  if (penalty) require_each_step("penalty yes");
  refuse_second(lmp, *this, "one acts on all points and faces");
  if (grains)
    grain_heat->init();
  else if (atom->heatflow_flag && !grains_said)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/heat: atoms have heat flows, of which material points would know nothing: say "
        "grains yes, or grains no if they exchange none with points");
  find_rubbers();
  warn_of_friction();
  const auto materials = find_fixes<FixMPMMaterial>(lmp);
  if (std::none_of(materials.begin(), materials.end(), [](auto *fix) {
        return fix->material->conducts();
      }))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat: no material conducts heat: give a fix mpm/material the part "
               "'thermal conducting' with specific heat, temperature, and conductivity");
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) {
    if (conditions[face].kind == MPMHeatCondition::INSULATED) continue;
    if (domain->periodicity[face / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat face {} belongs to a periodic axis: use boundary f there",
                 FACE_NAME[face]);
    check(conditions[face], FACE_NAME[face]);
  }
  if (!source.empty()) {
    source_index = input->variable->find(source.c_str() + 2);
    if (source_index < 0 ||
        !(input->variable->equalstyle(source_index) || input->variable->atomstyle(source_index)))
      error->all(FLERR, Error::NOLASTLINE, "Variable {} for fix mpm/heat source {}",
                 source.substr(2),
                 source_index < 0 ? "does not exist" : "is not equal-style or atom-style");
  }
}

/** Refuses every > 1 if other atoms give heat to nodes in each step. */
void FixMPMHeat::require_each_step(const char *giver) const
{
  if (every > 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} every {}: {} gives heat to nodes in each step: use every 1", id,
               every, giver);
}

/** Finds pair styles between bodies; their init() has been called before. */
void FixMPMHeat::find_rubbers()
{
  rubbers.clear();
  if (!penalty) return;
  for (const auto &style : MPMPairStyle::all(*force)) {
    auto *const pair = dynamic_cast<PairMPMPenalty *>(style.pair);
    if (!pair || !pair->takes_energy()) continue;
    pair->make_heat();
    rubbers.push_back(pair);
  }
  if (rubbers.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat penalty: there is no pair style mpm/penalty with friction or damping: "
               "give its pair_coeff one of these, or drop the keyword");
}

bool FixMPMHeat::conducts(const MPMField &field) const
{
  return of(field).conducts();
}

void FixMPMHeat::give(const MPMField &field, std::size_t node, double heat, bool counts)
{
  auto &given = of(field).given;
  if (given.empty()) given.resize(field.grid.nnodes(), 0.0);
  given[node] += heat;
  if (counts) book(FRICTION, heat);
}

/** Warns once of friction whose heat is lost, unless the input says that this is intended. */
void FixMPMHeat::warn_of_friction()
{
  if (losses_known) return;
  losses_known = true;
  if (comm->me) return;
  for (auto *rubbing : find_fixes<MPMRubbing>(lmp)) {
    const auto *const fix = dynamic_cast<Fix *>(rubbing);
    if (rubbing->loses_heat())
      error->warning(
          FLERR,
          "Fix {} {}: what its friction takes is lost, and warms nothing of fix mpm/heat "
          "{}: give it heat yes, or heat no if that is meant",
          fix->style, fix->id, id);
  }
  for (const auto &style : MPMPairStyle::all(*force)) {
    const auto *const pair = dynamic_cast<PairMPMPenalty *>(style.pair);
    if (pair && pair->takes_energy() && !penalty_said)
      error->warning(FLERR,
                     "Pair style {}: what its friction and damping take is lost, and warms nothing "
                     "of fix mpm/heat {}: give that penalty yes, or penalty no if this is meant",
                     style.name, id);
    if (!pair && style.name.compare(0, 4, "gran") == 0 && !grains_said)
      error->warning(FLERR,
                     "Pair style {}: what its friction and damping take is lost, and warms nothing "
                     "of fix mpm/heat {}: give that grains no or yes if this is meant",
                     style.name, id);
  }
}

/* ----------------------------------------------------------------------
   forces of pair styles act in the next step, and so does the heat of their friction
------------------------------------------------------------------------- */

void FixMPMHeat::setup(int)
{
  std::fill_n(iterations, (int) NTOTAL, 0.0);
  take_rubbing();
  check_temperatures();
}

/** Is there radiation? It needs kelvins: negative temperatures of points show that they are in degrees Celsius. Collective. */
bool FixMPMHeat::radiates() const
{
  const auto does = [](const MPMHeatCondition &c) {
    return c.kind == MPMHeatCondition::RADIATION;
  };
  return std::any_of(conditions, conditions + MPMHeatFaces::NFACE, does) ||
      std::any_of(surfaces.begin(), surfaces.end(), [&](const auto &s) {
           return does(s.condition);
         });
}

void FixMPMHeat::check_temperatures()
{
  if (!radiates()) return;
  for (const auto &of : fields)
    for (const auto *material : of->field.materials) {
      const int column = material->find_history("temperature");
      if (!material->material->conducts()) continue;
      for (int i = 0; i < atom->nlocal; i++)
        if ((atom->mask[i] & material->groupbit) && of->field.is_point(i) &&
            !(material->history[i][column] >= 0.0))
          error->one(FLERR, Error::NOLASTLINE,
                     "Fix mpm/heat {} radiation needs absolute temperatures, but point {} has the "
                     "temperature {:.6g}: give all temperatures in kelvins",
                     id, atom->tag[i], material->history[i][column]);
    }
}

void FixMPMHeat::post_force(int)
{
  if (grains) grain_heat->note_step();
  take_rubbing();
}

void FixMPMHeat::take_rubbing()
{
  if (!penalty) return;
  for (int i = 0; i < atom->nlocal; i++) {
    rubbing[i][0] = 0.0;
    for (const auto *pair : rubbers) rubbing[i][0] += pair->heating(i);
  }
}

void FixMPMHeat::give_rubbing(double dt)
{
  double sum = 0.0;
  for (auto &of : fields) {
    if (!of->conducts()) continue;
    clear_points(rubbed, atom);
    for (int i = 0; i < atom->nlocal; i++)
      if (of->field.is_point(i)) sum += rubbed[i] = dt * rubbing[i][0];
    of->give(rubbed);
  }
  book(FRICTION, sum);
}

/** Do faces of the box take their weights from the surface that nodes have (MPMHeatBody)? */
static bool weighs_faces(const MPMField &field)
{
  return field.options.shape != LINEAR && field.options.shape != BERNSTEIN;
}

/** Checks that radiation has temperatures in kelvins, and that variables exist. */
void FixMPMHeat::check(MPMHeatCondition &c, const std::string &name)
{
  if (c.kind == MPMHeatCondition::RADIATION && sigma() == 0.0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {} radiation needs temperatures in kelvins, which units {} do not "
               "have: use units si, cgs, micro, nano, metal, real, or electron",
               name, update->unit_style);
  for (int k = 0; k < c.nvalue(); k++) find_variable(lmp, c.value[k], "fix mpm/heat " + name);
}

void FixMPMHeat::init_physics(MPMPlan &plan)
{
  // fix mpm calls this before init() of this fix
  const auto all = find_fixes<MPMRubbing>(lmp);
  rubs = std::any_of(all.begin(), all.end(), [](const auto *fix) {
    return fix->gives_heat();
  });
  fields.clear();
  steps.clear();
  solver.reset();
  if (in_time.time != MPMDiffusionOptions::EXPLICIT) {
    MPMDiffusion &equations = *this;
    solver = std::make_unique<MPMDiffusionSolver>(lmp, equations, in_time);
  }
  steps.add(in_step, present);
  for (auto *field : plan.fields) {
    const auto &o = field->options;
    refuse_field(lmp, *this, *field,
                 {{o.modified_edges, "edges modified", "use edges plain"},
                  {o.axisymmetric && domain->boxlo[0] <= 1.0e-6 * field->lattice.h &&
                       conditions[0].kind != MPMHeatCondition::INSULATED,
                   "a condition at xlo, which is the axis of symmetry", "leave xlo insulated"}});
    const bool touches = std::any_of(pairs.begin(), pairs.end(), [&](const auto &p) {
      return p.field[0] == field->id() || p.field[1] == field->id();
    });
    refuse_field(lmp, *this, *field,
                 {{o.total && touches, "frame total with contact",
                   "its nodes are not where the body is, and do not know where bodies touch: use "
                   "frame updated"}});
    if (gradients) field->slopes.push_back(&gradients);
    fields.push_back(std::make_unique<MPMConduction>(lmp, *field, transfer, conditions));
    fields.back()->init(sigma(), !surfaces.empty() || !pairs.empty(), told_of_layers);
    if (solver) fields.back()->faces.hold_exactly();
    if (fields.back()->conducts()) steps.add(fields.back()->temperature, fields.back()->rate);
  }
  init_contacts();
  init_levels(plan);
  each_step = needs_each_step();
}

/* ----------------------------------------------------------------------
   bodies on several lattices: conduction on the nodes of each lattice alone would be wrong at the rims
------------------------------------------------------------------------- */

void FixMPMHeat::init_levels(const MPMPlan &plan)
{
  refined.clear();
  for (const auto *fix : find_fixes<FixMPMRefine>(lmp)) {
    std::vector<MPMHeatLevels::Pair> lattices;
    int count = 0, all = 0;
    for (auto *field : plan.fields) {
      if (!fix->has(field->id())) continue;
      all++;
      count += of(*field).conducts();
    }
    if (count == 0) continue;
    if (count < all)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat {}: the fields of fix mpm/refine {} are one body, but the materials "
                 "of some of them conduct heat and those of others do not: give all of them the "
                 "part 'thermal conducting'",
                 id, fix->id);
    const auto refuse = [&](bool broken, const std::string &what, const std::string &remedy) {
      if (broken)
        error->all(
            FLERR, Error::NOLASTLINE,
            "Fix mpm/heat {}: {} does not go with bodies on several lattices, fix mpm/refine "
            "{}: {}",
            id, what, fix->id, remedy);
    };
    refuse(solver != nullptr, "time euler and sdirk2", "use time explicit");
    refuse(transfer.kind == MPMHeatTransfer::XPIC, "transfer xpic", "use relax, affine, or pic");
    refuse(!surfaces.empty(), "heat through surfaces and regions",
           "use conditions on faces of the box, or a source");
    refuse(grains, "grains yes", "leave it out");
    refuse(penalty, "penalty yes", "leave it out");
    refuse(every > 1 && rubs, "every with heat of friction", "use every 1");
    refuse(std::any_of(pairs.begin(), pairs.end(),
                       [fix](const auto &p) {
                         return fix->has(p.field[0]) || fix->has(p.field[1]);
                       }),
           "contact",
           "leave it out, as heat goes from one body to another one at nodes of one lattice");
    for (const auto &two : fix->lattices()) {
      auto &coarse = of(two->coarse), &fine = of(two->fine);
      const bool weighs = coarse.faces.any() && weighs_faces(two->coarse);
      lattices.push_back({two.get(), &coarse, &fine, weighs ? &body_of(two->coarse) : nullptr,
                          weighs ? &body_of(two->fine) : nullptr});
    }
    refined.push_back(std::make_unique<MPMHeatLevels>(lmp, lattices));
  }
}

MPMHeatLevels *FixMPMHeat::levels_of(const MPMConduction &one) const
{
  for (const auto &levels : refined)
    if (levels->has(one)) return levels.get();
  return nullptr;
}

MPMHeatBody &FixMPMHeat::body_of(const MPMField &field)
{
  for (auto &body : bodies)
    if (&body->field == &field) return *body;
  auto &conduction = of(field);
  bodies.push_back(std::make_unique<MPMHeatBody>(lmp, conduction.field,
                                                 conduction.conducts() ? &conduction : nullptr));
  return *bodies.back();
}

/** Does a field have points that conduct, on any rank? */
static bool conducts(const MPMField &field, MPI_Comm world)
{
  const Atom &atom = *field.atom;
  int any = 0, all;
  for (int i = 0; i < atom.nlocal && !any; i++) {
    const auto *const fix = field.is_point(i) ? field.material_of(i) : nullptr;
    any = fix && fix->material->conducts();
  }
  MPI_Allreduce(&any, &all, 1, MPI_INT, MPI_MAX, world);
  return all;
}

/** Finds bodies that touch: they hide free surfaces of each other, even if they do not conduct. */
void FixMPMHeat::find_neighbors()
{
  if (std::none_of(surfaces.begin(), surfaces.end(), [](const auto &s) {
        return s.region.empty();
      }))
    return;
  const auto contacts = find_fixes<FixMPMContact>(lmp);
  for (auto &skin : skins)
    for (auto &field : fields) {
      const auto &mine = skin->body.field, &other = field->field;
      if (std::any_of(contacts.begin(), contacts.end(), [&](auto *fix) {
            return fix->couples(mine.id(), other.id());
          }))
        skin->neighbors.push_back(&body_of(other));
    }
}

void FixMPMHeat::init_contacts()
{
  for (auto &one : surfaces) {
    check(one.condition, one.region.empty() ? "surface" : "region " + one.region);
    if (one.region.empty()) continue;
    auto *region = domain->get_region_by_id(one.region);
    if (!region)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat region {} does not exist", one.region);
    if (MPMRegionSurface(region, domain->dimension).is_open())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: open faces have no inside", one.region);
    if (region->dynamic_check() && region->nregion > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat cannot use region {}: a union or intersection must not move; use "
                 "its parts one by one",
                 one.region);
  }
  for (auto &p : pairs) {
    const auto contacts = find_fixes<FixMPMContact>(lmp);
    if (std::none_of(contacts.begin(), contacts.end(), [&](auto *fix) {
          return fix->couples(p.field[0], p.field[1]);
        }))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/heat contact {} {}: there is no contact between two fix mpm with these "
                 "IDs: define a fix mpm/contact {} {}",
                 p.field[0], p.field[1], p.field[0], p.field[1]);
    find_variable(lmp, p.conductance, "fix mpm/heat contact");
  }
  bodies.clear();
  contacts.clear();
  skins.clear();
  for (auto &field : fields)
    if (!surfaces.empty() && field->conducts())
      skins.push_back(
          std::make_unique<MPMHeatSurfaces>(lmp, body_of(field->field), surfaces, sigma()));
  find_neighbors();
  for (auto &field : fields)
    if (field->conducts() && field->faces.any() && weighs_faces(field->field))
      body_of(field->field);
  for (const auto &p : pairs) {
    MPMHeatBody *body[2];
    for (int k = 0; k < 2; k++) {
      auto *const of = MPMField::find(lmp, p.field[k]);
      if (!of)
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: there is no fix mpm with the ID {}", p.field[0],
                   p.field[1], p.field[k]);
      body[k] = &body_of(*of);
      if (!conducts(body[k]->field, world))
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/heat contact {} {}: no material of fix mpm {} conducts heat: give it "
                   "the part 'thermal conducting', or remove the contact",
                   p.field[0], p.field[1], p.field[k]);
    }
    contacts.push_back(std::make_unique<MPMHeatContact>(lmp, *body[0], *body[1], p));
  }
}

void FixMPMHeat::extend_topology(MPMField &field)
{
  of(field).extend_topology();
  for (auto &skin : skins)
    if (&skin->body.field == &field) skin->extend_topology();
  for (auto &contact : contacts) contact->extend_topology(field);
}

void FixMPMHeat::topology_changed(MPMField &field)
{
  of(field).faces.topology_changed();
  of(field).find_points(bodies.empty() && !levels_of(of(field)));
  for (auto &body : bodies) body->topology_changed();
  for (auto &skin : skins) skin->topology_changed();
  for (auto &contact : contacts) contact->topology_changed();
}

/** Are nodes needed that no point reaches? Conduction alone needs none, but lines through surfaces do. */
bool FixMPMHeat::looks_beyond_points() const
{
  return !bodies.empty() || std::any_of(fields.begin(), fields.end(), [](const auto &field) {
    return field->has_materials() && (field->faces.any() || field->looks_beyond_points());
  });
}

MPMConduction &FixMPMHeat::of(const MPMField &field) const
{
  for (const auto &mine : fields)
    if (&mine->field == &field) return *mine;
  error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat does not know fix mpm {}", field.id());
  return *fields[0];
}

void FixMPMHeat::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  // points strain at the end of a step with their temperatures at that time: an implicit step must know these before
  const bool is_implicit = !find_fixes<FixMPMImplicit>(lmp).empty();
  if (place == (is_implicit ? MPMPlan::BEFORE_SOLVE : MPMPlan::AFTER_SOLVE))
    plan.together("conduction of heat", [this]() {
      conduct();
    });
}

/* ---------------------------------------------------------------------- */

/** Checks the values of variables by the same rules as numbers in the input. */
void FixMPMHeat::check_values() const
{
  const auto refuse = [&](bool wrong, const std::string &where, const MPM_NS::NumberOrVariable &v,
                          double now, const char *needed) {
    if (wrong)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/heat {}: {} = {:.6g}, but it must {}", where,
                 v.variable.empty() ? "the value" : "variable " + v.variable, now, needed);
  };
  const bool absolute = radiates();
  const auto check = [&](const MPMHeatCondition &c, const std::string &where) {
    const int T = c.kind == MPMHeatCondition::TEMPERATURE ? 0
        : c.kind == MPMHeatCondition::CONVECTION          ? 1
                                                          : -1;
    if (absolute && T >= 0)
      refuse(!(c.now[T] >= 0.0), where, c.value[T], c.now[T],
             "be an absolute temperature, not below 0, where something radiates");
    if (c.kind < MPMHeatCondition::CONVECTION) return;
    refuse(!(c.now[0] >= 0.0), where, c.value[0], c.now[0], "not be negative");
    if (c.kind != MPMHeatCondition::RADIATION) return;
    refuse(c.now[0] > 1.0, where, c.value[0], c.now[0], "not be above 1");
    refuse(!(c.now[1] >= 0.0), where, c.value[1], c.now[1],
           "be an absolute temperature, not below 0");
  };
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) check(conditions[face], FACE_NAME[face]);
  for (const auto &[region, c] : surfaces)
    check(c, region.empty() ? "surface" : "region " + region);
  for (const auto &p : pairs)
    refuse(!(p.now >= 0.0), fmt::format("contact {} {}", p.field[0], p.field[1]), p.conductance,
           p.now, "not be negative");
}

bool FixMPMHeat::has_variables() const
{
  bool any = !source.empty();
  for (const auto &c : conditions)
    for (int k = 0; k < c.nvalue(); k++) any = any || !c.value[k].variable.empty();
  for (const auto &[region, c] : surfaces)
    for (int k = 0; k < c.nvalue(); k++) any = any || !c.value[k].variable.empty();
  for (const auto &p : pairs) any = any || !p.conductance.variable.empty();
  return any;
}

void FixMPMHeat::evaluate_variables()
{
  evaluate_in_step(lmp, has_variables(), [&] {
    for (auto &c : conditions)
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    for (auto &[region, c] : surfaces)
      for (int k = 0; k < c.nvalue(); k++) c.now[k] = evaluate(lmp, c.value[k]);
    for (auto &p : pairs) p.now = evaluate(lmp, p.conductance);
    check_values();
    if (source.empty()) return;
    source_values.resize(atom->nmax);
    if (input->variable->atomstyle(source_index))
      input->variable->compute_atom(source_index, igroup, source_values.data(), 1, 0);
    else
      std::fill(source_values.begin(), source_values.end(),
                evaluate(lmp, {0.0, source.substr(2), true, source_index}));
  });
}

/* ----------------------------------------------------------------------
   called before temperatures go to nodes, as surfaces have sums over points of their own
------------------------------------------------------------------------- */

void FixMPMHeat::find_surfaces()
{
  for (auto &body : bodies) body->begin_step();
  for (auto &body : bodies)
    if (body->conduction) body->conduction->faces.mark_near(body->near);
  for (auto &contact : contacts) contact->mark_near();
  for (auto &skin : skins) skin->mark_near();
  if (!skins.empty())
    for (auto &body : bodies)
      if (!body->conduction) body->want_all();
  for (auto &body : bodies)
    if (!body->conduction || !levels_of(*body->conduction)) body->find_surface();
  for (auto &levels : refined) levels->find_surface();
  const bool looks = (!skins.empty() || !contacts.empty()) &&
      thin.looks((int) (surfaces.size() + contacts.size()));
  for (std::size_t k = 0; k < contacts.size(); k++)
    contacts[k]->find_contacts(looks ? &thin : nullptr, (int) (surfaces.size() + k));
  for (auto &skin : skins) skin->find_lines(looks ? &thin : nullptr);
  if (looks) report_thin();
}

/** One warning, with the same place for any number of ranks. Collective. */
void FixMPMHeat::report_thin()
{
  MPMHeatThin::Found found;
  if (!thin.tell(world, found) || comm->me) return;
  const int nsurface = (int) surfaces.size();
  std::string what = "surface";
  if (found.entry >= nsurface)
    what = fmt::format("contact {} {}", pairs[found.entry - nsurface].field[0],
                       pairs[found.entry - nsurface].field[1]);
  else if (!surfaces[found.entry].region.empty())
    what = "region " + surfaces[found.entry].region;
  error->warning(FLERR,
                 "Fix mpm/heat {}: more than 5 % of the area of {} belongs to material that is "
                 "thinner than 3 node spacings (4 with shape cubic), first at {:.6g} {:.6g} "
                 "{:.6g} in step {}: heat is missing there, up to 16 % with 2 spacings and half of "
                 "it with 1. Make the spacing of fix mpm smaller; this is said only once",
                 id, what, found.x[0], found.x[1], found.x[2], update->ntimestep);
}

int FixMPMHeat::exchanges(const MPMConduction &of_field) const
{
  return (int) contacts.size() + !skins.empty() + of_field.faces.axes_that_follow();
}

/* ----------------------------------------------------------------------
   temperatures of nodes, and the number of stages that all fields need for their step
------------------------------------------------------------------------- */

/** Finds lines of surfaces and contacts that cross others at edges, when all lines of the step are known. Collective. */
void FixMPMHeat::find_edges()
{
  for (auto &body : bodies)
    if (body->conduction) body->begin_edges();
  for (auto &contact : contacts) contact->note_edges();
  for (auto &skin : skins) skin->note_edges();
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->conduction->faces.note_edges(*body);
    body->end_edges();
  }
}

/** Warns of materials that do not conduct and are thinner than the reach of nodes, at the first step, once. */
void FixMPMHeat::look_for_leaks()
{
  if (leaks_known) return;
  leaks_known = true;
  const auto conducts = [](const FixMPMMaterial *fix) {
    return fix->material->conducts();
  };
  for (const auto &of : fields) {
    const auto &all = of->field.materials;
    if (!of->conducts() || std::all_of(all.begin(), all.end(), conducts)) continue;
    const auto leaks = find_leaks(of->field, world, conducts);
    if (leaks.nodes && comm->me == 0)
      error->warning(
          FLERR,
          "Fix mpm/heat {}: material that does not conduct is so thin that heat leaks through it, "
          "at "
          "{} nodes of fix mpm {}, one of them at {:.6g} {:.6g} {:.6g}: let it have three node "
          "spacings",
          id, leaks.nodes, of->field.id(), leaks.first[0], leaks.first[1], leaks.first[2]);
  }
}

int FixMPMHeat::count_stages()
{
  static constexpr int NRATE =
      4;    // rates of a field: of its conduction, and of its faces normal to each axis
  look_for_leaks();
  std::vector<double> mine(NRATE * fields.size(), 0.0), all;
  find_surfaces();
  for (auto &levels : refined) {
    const double bound = levels->points_to_nodes(gradients, !solver);
    for (std::size_t k = 0; k < fields.size(); k++)
      if (levels->has(*fields[k])) mine[NRATE * k] = bound;
  }
  for (std::size_t k = 0; k < fields.size(); k++) {
    auto &field = *fields[k];
    if (!field.conducts()) continue;
    if (!levels_of(field)) mine[NRATE * k] = field.points_to_nodes(gradients, !solver);
    if (field.faces.any())
      field.faces.begin_step(field.face_capacity(), field.node_volume(),
                             weighs_faces(field.field) ? &body_of(field.field) : nullptr,
                             field.face_gradient(), field.temperature, &mine[NRATE * k + 1]);
  }
  for (auto &contact : contacts) mine.push_back(contact->begin_step());
  for (auto &skin : skins) mine.push_back(skin->begin_step());
  all.resize(mine.size());
  MPI_Allreduce(mine.data(), all.data(), (int) all.size(), MPI_DOUBLE, MPI_MAX, world);
  double greatest = 0.0;
  for (std::size_t k = 0; k < fields.size(); k++) {
    fields[k]->keep_rate(all[NRATE * k]);
    greatest = std::max(greatest, all[NRATE * k]);
  }

  // a node can be at faces, in contacts with several bodies, and at a surface; nodes of different fields are separate. Exchange
  // that needs no stage needs no limit
  static constexpr double BELOW_ONE_STEP = 0.95;
  int most_at_a_node = 0;
  for (auto &field : fields) most_at_a_node = std::max(most_at_a_node, exchanges(*field));
  const double dt = waited.time,
               cap = std::max(greatest, BELOW_ONE_STEP / (dt * std::max(most_at_a_node, 1)));
  const double *rates = all.data() + NRATE * fields.size();
  const bool has_lines = !contacts.empty() || !skins.empty();
  if (has_lines) find_edges();
  double most = 0.0;
  for (std::size_t k = 0; k < fields.size(); k++) {
    for (auto &body : bodies)
      if (has_lines && body->conduction == fields[k].get())
        fields[k]->faces.slow_down_at_edges(*body, fields[k]->rate_at_edges());
    const double rate =
        fields[k]->faces.limit(cap, fields[k]->rate_at_edges(), &all[NRATE * k + 1]);
    most = std::max(most, rate);
  }
  greatest += most;
  for (auto &contact : contacts) {
    contact->limit(cap);
    greatest += std::min(cap, *rates++);
  }
  most = 0.0;
  for (auto &skin : skins) {
    skin->limit(cap, skin->body.conduction->rate_at_edges());
    most = std::max(most, std::min(cap, *rates++));
  }
  greatest += most;
  fastest = greatest;
  if (solver) return 0;

  const double limit = MPMSuperStep::explicit_limit(greatest);
  const int stages = MPMSuperStep::count(dt, limit, most_stages);
  if (stages > most_stages)
    error->all(FLERR, Error::NOLASTLINE,
               "The time step {:.6g} is {:.4g} times the explicit limit {:.4g} of the conduction "
               "of heat, which needs more than {} stages: use fix mpm/dt, a smaller timestep{}, "
               "fix mpm/heat ... stages, or implicit steps, fix mpm/heat ... time sdirk2",
               dt, dt / limit, limit, most_stages, every > 1 ? " or fix mpm/heat ... every" : "");
  return stages;
}

void FixMPMHeat::find_rates()
{
  std::fill(present.begin(), present.end(), 0.0);
  for (auto &field : fields)
    if (field->conducts())
      field->find_rates(source.empty() ? nullptr : source_values.data(), present);
  for (auto &levels : refined) levels->sum_rates();
  for (auto &field : fields) {
    if (!field->conducts()) continue;
    field->add_given();
    field->faces.add_rates(field->temperature, field->rate, present);
  }
  for (auto &levels : refined) levels->rates_from_parents();
  if (contacts.empty() && skins.empty()) return;
  for (auto &body : bodies)
    if (body->conduction) body->begin_stage();
  for (std::size_t k = 0; k < contacts.size(); k++)
    contacts[k]->exchange(present[places_of_contacts() + k]);
  for (const auto &skin : skins) skin->exchange(present.data() + places_of_surfaces());
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->end_stage();
    body->conduction->faces.hold_rates(body->conduction->rate, present);
  }
}

/* ----------------------------------------------------------------------
   the same equations in implicit steps
------------------------------------------------------------------------- */

bool FixMPMHeat::linearize()
{
  int mine = 1, all;
  for (auto *part : parts) mine &= part->faces.linearize(part->temperature);
  for (const auto &contact : contacts) mine &= contact->is_symmetric();
  for (auto &skin : skins) mine &= skin->linearize();
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, world);
  return all;
}

void FixMPMHeat::find_changes()
{
  for (auto *part : parts) {
    part->find_changes();
    part->faces.add_changes(part->temperature, part->rate);
  }
  if (contacts.empty() && skins.empty()) return;
  Heats nowhere(MPMHeatFaces::NFACE + 1);
  double between = 0.0;
  for (auto &body : bodies)
    if (body->conduction) body->begin_stage();
  for (const auto &contact : contacts) contact->exchange(between);
  for (const auto &skin : skins) skin->exchange_changes();
  for (auto &body : bodies) {
    if (!body->conduction) continue;
    body->end_stage();
    body->conduction->faces.hold_rates(body->conduction->rate, nowhere);
  }
}

void FixMPMHeat::project(int part, std::vector<double> &change)
{
  Heats nowhere(MPMHeatFaces::NFACE + 1);
  parts[part]->faces.hold_rates(change, nowhere);
}

void FixMPMHeat::each_term(int k, double dt, const Term &use)
{
  const auto &part = *parts[k];
  part.each_term(use);
  part.faces.each_term(std::max(part.bound_of_rates(), 1.0 / dt), use);
  for (const auto &body : bodies) {
    if (body->conduction != &part) continue;
    for (const auto &contact : contacts) contact->each_term(*body, use);
    for (const auto &skin : skins)
      if (&skin->body == body.get()) skin->each_term(use);
  }
}

void FixMPMHeat::solve()
{
  solver->clear();
  solver->add(in_step, present);
  parts.clear();
  double greatest = 0.0;
  for (auto &field : fields) {
    if (!field->conducts()) continue;
    parts.push_back(field.get());
    solver->add(field->field, field->scalar);
    greatest = std::max(greatest, field->bound_of_rates());
  }
  const auto &report = solver->advance(dt_last, greatest, fastest);
  iterations[STEPS]++;
  iterations[NEWTON] += report.newton;
  iterations[LINEAR] += report.linear;
  if (!report.converged)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/heat {}: no solution for the temperatures in step {} after {} iterations "
               "of Newton's method and {} of the linear solver: {}. Use a smaller timestep, a "
               "larger tolerance, or time explicit",
               id, update->ntimestep, report.newton, report.linear, report.failure);
}

void FixMPMHeat::post_run()
{
  const double n = iterations[STEPS];
  if (comm->me || n == 0.0 || update->nsteps == 0) return;
  utils::logmesg(lmp,
                 "Fix mpm/heat {}: {:.2f} Newton iterations in a step, {:.1f} of the linear solver "
                 "in each\n",
                 id, iterations[NEWTON] / n,
                 iterations[LINEAR] / std::max(1.0, iterations[NEWTON]));
}

void FixMPMHeat::conduct()
{
  if (wait()) return;
  evaluate_variables();
  std::fill(in_step.begin(), in_step.end(), 0.0);
  for (auto &field : fields)
    if (grains && field->conducts()) grain_heat->give(*field);
  if (penalty) give_rubbing(fields[0]->field.step_dt());
  for (auto &field : fields) field->duration = waited.time;
  const int stages = count_stages();
  for (auto &field : fields)
    if (field->conducts()) field->faces.hold(field->temperature, in_step);
  for (auto &levels : refined) {
    levels->look_for_thin_skins();
    levels->temperatures_from_parents();
  }
  dt_last = waited.time;
  waited = {};
  if (solver)
    solve();
  else
    steps.advance(stages, dt_last, [this]() {
      find_rates();
    });
  for (auto &field : fields) {
    if (field->conducts()) past.got += field->nodes_to_points(gradients);
    field->given.clear();
  }
  for (int face = 0; face < MPMHeatFaces::NFACE; face++) past.through_faces += in_step[face];
  for (int k = places_of_surfaces(); k < places_of_contacts(); k++)
    past.through_faces += in_step[k];
  past.of_sources += in_step[MPMConduction::SOURCES];
  for (int k = 0; k < NGIVER; k++) past.given[k] += in_step[GIVERS + k] = past.booked[k];
  std::fill_n(past.booked, NGIVER, 0.0);
  power_known = false;
  if (every == AUTO) waited.longest = longest_wait();
  warn_of_fronts();
}

/** Warns of long conductions with fronts: points take the heat of fusion at their end, which cools or warms the material beyond a front
 *  too much. */
void FixMPMHeat::warn_of_fronts()
{
  static constexpr double LONG = 4.0;    // in explicit limits
  const double limits = dt_last / MPMSuperStep::explicit_limit(fastest);
  if (fronts_known || !(limits > LONG)) return;
  const bool melts = std::any_of(fields.begin(), fields.end(), [](const auto &field) {
    return field->conducts() && field->melts();
  });
  if (!melts) return;
  int mine = 0, any;
  for (const auto &field : fields) mine |= field->conducts() && field->has_front();
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  if (!any) return;
  fronts_known = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/heat {}: material melts or freezes, and conduction in a step of {:.4g} "
                   "is {:.4g} of its explicit limits long: points take the heat of fusion at the "
                   "end of it, so that the front may be some 5 % off its place with 3 limits, 15 % "
                   "with 12: use steps of at most {:.4g}, or see that shorter ones change nothing",
                   id, dt_last, limits, dt_last / limits);
}

double FixMPMHeat::stable_dt(const MPMField &field, tagint &tag) const
{
  // other exchange is at most as fast as conduction
  if (solver) return std::numeric_limits<double>::max();
  const auto &conduction = of(field);
  const double rate = conduction.greatest_rate_of_points(tag);
  const double others = (double) contacts.size() + (skins.empty() ? 0.0 : 1.0);
  return MPMSuperStep::reach(most_stages) *
      MPMSuperStep::explicit_limit(
             (1.0 + others) * rate +
             conduction.faces.expected_rate(rate, conduction.least_capacity)) /
      std::max(every, 1);
}

/* ----------------------------------------------------------------------
   heat that has come in so far, and the power in the last conduction
------------------------------------------------------------------------- */

double FixMPMHeat::compute_scalar()
{
  double mine = past.through_faces + past.of_sources, all;
  for (int k = 0; k < NGIVER; k++) mine += past.given[k] + past.booked[k];
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMHeat::compute_vector(int i)
{
  if (!power_known) {
    MPI_Allreduce(in_step.data(), power.data(), size_vector, MPI_DOUBLE, MPI_SUM, world);
    for (double &p : power) p /= dt_last;
    power_known = true;
  }
  return power[i];
}

/* ----------------------------------------------------------------------
   entries of compute mpm/energy. The heat of points is a sum over points, separate from the heat that nodes were given
------------------------------------------------------------------------- */

std::vector<MPMPhysics::Account> FixMPMHeat::accounts() const
{
  return {{"conducted heat", true},
          {"heat through faces", false},
          {"heat of sources", false},
          {"heat of friction", false},
          {"heat of grains", false}};
}

void FixMPMHeat::account(double *values) const
{
  values[0] += past.got;
  if (grains) values[0] += grain_heat->sum_waiting();
  values[1] += past.through_faces;
  values[2] += past.of_sources;
  for (int k = 0; k < NGIVER; k++) values[3 + k] += past.given[k] + past.booked[k];
}

double FixMPMHeat::energy_at_hand() const
{
  double heat = 0.0;
  for (const auto &of : fields)
    if (of->conducts()) heat += of->heat_of_points();
  return heat;
}

/* ---------------------------------------------------------------------- */

void FixMPMHeat::write_restart(FILE *fp)
{
  keep_totals(world, &past.through_faces, sizeof(Past) / sizeof(double));
  compute_vector(0);
  if (comm->me) return;
  const int size = sizeof(Past) + sizeof(waited) + (1 + size_vector) * sizeof(double);
  const double length = size_vector;
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&past, sizeof(Past), 1, fp);
  fwrite(&waited, sizeof(waited), 1, fp);
  fwrite(&length, sizeof(double), 1, fp);
  fwrite(power.data(), sizeof(double), size_vector, fp);
}

/** The power is that of the last conduction until the next one; with other surfaces or contacts, it belongs to the old ones. */
void FixMPMHeat::restart(char *buf)
{
  if (comm->me == 0) memcpy(&past, buf, sizeof(Past));
  buf += sizeof(Past);
  memcpy(&waited, buf, sizeof(waited));
  buf += sizeof(waited);
  double length;
  memcpy(&length, buf, sizeof(double));
  if (length == size_vector)
    memcpy(power.data(), buf + sizeof(double), size_vector * sizeof(double));
}

double FixMPMHeat::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + steps.memory_usage() +
      (source_values.capacity() + rubbed.capacity()) * sizeof(double);
  if (grains) bytes += grain_heat->memory_usage();
  if (solver) bytes += solver->memory_usage();
  for (const auto &field : fields) bytes += field->memory_usage();
  for (const auto &body : bodies) bytes += body->memory_usage();
  for (const auto &contact : contacts) bytes += contact->memory_usage();
  for (const auto &skin : skins) bytes += skin->memory_usage();
  return bytes;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Parameters of a material that differ between points: random ones, and those that depend on
// temperature.

#include "law/damage.h"
#include "material/composed_material.h"
#include "material/random_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace MPM_NS;

namespace {

/** The density of a material, as its laws declare their parameters. */
constexpr Parameter DENSITY = {"", "density", "density", POSITIVE, REQUIRED, "reference density"};

/** Of the specific heats at the limits of a formula. */
constexpr double MOST_RATIO = 1e3;

}    // namespace

// values at a point

ComposedMaterial::LocalParameters::LocalParameters(const ComposedMaterial &material,
                                                   const UsedLaw &law) :
    material(material),
    law(law), p(law.parameters)
{
  if (material.random_heat) heat = material.thermal->parameters;
}

const LawParameters &ComposedMaterial::LocalParameters::at(const double *history, int stride)
{
  const int row = material.stress_temperature >= 0 ? material.stress_temperature
      : material.thermal                           ? material.thermal->history
                                                   : -1;
  return at(history, stride, row < 0 ? 0.0 : history[row * stride]);
}

const LawParameters &ComposedMaterial::LocalParameters::at(const double *history, int stride,
                                                           double temperature)
{
  replace(law, p, history, stride, temperature);
  if (const auto &r = material.random_density) {
    p.density = law.parameters.density * history[r->row * stride];
    p.heat_density = law.parameters.heat_density * history[r->row * stride];
  }
  if (material.random_heat) {
    replace(*material.thermal, heat, history, stride, temperature);
    heat.heat_density = p.heat_density;
    share_heat(*material.thermal->info, heat, law.heats_alone, p);
  }
  return p;
}

void ComposedMaterial::LocalParameters::replace(const UsedLaw &law, LawParameters &p,
                                                const double *history, int stride,
                                                double temperature)
{
  for (const auto &w : law.varying) w.of(p) = w.of(law.parameters);
  for (const auto &r : law.random) r.of(p) = r.of(law.parameters) * history[r.row * stride];
  for (const auto &w : law.varying) w.of(p) *= w.factor.at(temperature);
}

void ComposedMaterial::initialize(const double *x, double *history) const
{
  for (size_t k = 0; k < variables.size(); k++) history[k] = variables[k].initial;
  if (random_density) set_factor(*random_density, DENSITY, rho, x, history);
  for (const auto &law : laws)
    for (const auto &r : law.random) {
      const Parameter &declared = r.declaration(*law.info);
      const double mean = r.of(law.parameters);
      set_factor(r, declared, mean, x, history);
      for (const auto &w : law.varying)
        for (const double T : w.factor.knots())
          if (w == r) check_range(declared, mean * history[r.row] * w.factor.at(T));
    }
  if (stress_temperature >= 0) history[stress_temperature] = first_temperature(history, 1);
  for (const auto &law : laws)
    if (law.varies) {
      LocalParameters local(*this, law);
      initialize(law, local.at(history, 1), x, history);
    } else if (law.info->initialize) {
      law.info->initialize(law.parameters, x, history + law.history);
    }
  if (solid >= 0) history[solid] = 1.0 - history[molten];
  for (int k = 0; k < nheated; k++) history[heated + k] = history[thermal->history + k];
  if (damage && eos->info->expands)
    history[damage->history + law::REST_ENERGY] = internal_energy(history, 1);
}

double ComposedMaterial::internal_energy(const double *history, int stride) const
{
  const double *const energy = history + stride * eos->history;
  return energy[0] - energy[stride];
}

void ComposedMaterial::initialize(const UsedLaw &law, const LawParameters &p, const double *x,
                                  double *history)
{
  if (const char *wrong = law.info->check(p))
    throw std::runtime_error(std::string("with the random parameters of a point, ") +
                             law.info->name + ": " + wrong);
  for (int k = 0; k < law.info->count_history(p); k++)
    if (law.info->history[k].initial >= 0)
      history[law.history + k] = p.value[law.info->history[k].initial];
  if (law.info->initialize) law.info->initialize(p, x, history + law.history);
}

void ComposedMaterial::set_factor(const RandomParameter &r, const Parameter &declared, double mean,
                                  const double *x, double *history)
{
  const double g = r.field->value(x);    // standard normal deviate
  const double s2 = std::log1p(r.variation * r.variation);
  history[r.row] = r.lognormal ? std::exp(std::sqrt(s2) * g - 0.5 * s2) : 1.0 + r.variation * g;
  check_range(declared, mean * history[r.row]);
}

void ComposedMaterial::check_range(const Parameter &declared, double value)
{
  if (!declared.range.contains(value))
    throw std::runtime_error(std::string("random ") + declared.name + " is " + number(value) +
                             " at a point, which is out of range: use lognormal, or a smaller "
                             "coefficient of variation");
}

void ComposedMaterial::initialized() const
{
  if (random_density) random_density->field->release();
  for (const auto &law : laws)
    for (const auto &r : law.random) r.field->release();
}

// what a definition gives

UsedLaw *ComposedMaterial::find_parameter(const std::string &wanted, ParameterPlace &place,
                                          std::string &choice, const std::string &what, int word,
                                          const Fits &fits)
{
  UsedLaw *owner = nullptr;
  const auto consider = [&](UsedLaw &law, int term, int k) {
    const LawInfo &info = *law.info;
    const std::string name = term < 0 ? std::string(info.parameters[k].name)
                                      : info.term_parameters[k].name + std::to_string(term + 1);
    const std::string of_part = std::string(part_name[law.part]) + "." + name;
    const std::string of_law = std::string(info.name) + "." + name;
    const bool by_law = law.part == CLOSED || law.part == VISCOSITY;
    if (fits(law, (term < 0 ? info.parameters : info.term_parameters)[k]))
      choice += (choice.empty() ? "" : ", ") + (by_law ? of_law : of_part);
    if (wanted != name && wanted != of_part && !(by_law && wanted == of_law)) return;
    if (owner)
      throw MaterialError(word, what + ": several laws of this material have it: choose " + choice);
    owner = &law;
    place = {term, k};
  };
  for (auto &law : laws) {
    for (int k = 0; k < law.info->nparameters; k++) consider(law, -1, k);
    for (int term = 0; term < law.parameters.nterms; term++)
      for (int k = 0; k < law.info->nterm_parameters; k++) consider(law, term, k);
  }
  return owner;
}

void ComposedMaterial::add(const UsedRandom &random)
{
  const std::string what = "random " + random.name;
  const auto refuse = [&](const std::string &why) {
    throw MaterialError(random.word, what + ": " + why);
  };
  RandomParameter r = {random, {-1, -1}, static_cast<int>(variables.size()), nullptr};
  std::string choice = "density";
  const auto all = [](const UsedLaw &, const Parameter &) {
    return true;
  };
  UsedLaw *const owner = find_parameter(random.name, r, choice, what, random.word, all);
  const bool of_density = random.name == "density";
  if (!owner && !of_density) refuse("no such parameter: choose one of " + choice);
  const double mean = of_density ? rho : r.of(owner->parameters);
  if (mean == 0.0 || !std::isfinite(mean))
    refuse("its value is " + number(mean) +
           ", which a factor does not change: give it another one");
  bool twice = of_density && random_density;
  if (owner)
    for (const auto &other : owner->random) twice = twice || other == r;
  if (twice) refuse("is given twice");
  r.field = std::make_shared<const RandomField>(random.length, random.seed);
  if (of_density)
    random_density = std::make_unique<const RandomParameter>(r);
  else
    owner->random.push_back(r);
  variables.push_back({"random/" + random.name, 1.0});
  text += ", " + what + (random.lognormal ? " lognormal " : " normal ") + number(random.variation) +
      " " + number(random.length) + " " + std::to_string(random.seed);
}

void ComposedMaterial::add(const UsedVary &vary, std::vector<Varied> &varied)
{
  const std::string what = "vary " + vary.name;
  const auto refuse = [&](const std::string &why) {
    throw MaterialError(vary.word, what + ": " + why);
  };
  VaryingParameter w = {{-1, -1}, vary.factor};
  std::string choice;
  UsedLaw *const owner = find_parameter(vary.name, w, choice, what, vary.word, can_vary);
  if (!owner) refuse("no such parameter: choose one of " + choice);
  const LawInfo &info = *owner->info;
  const Parameter &declared = w.declaration(info);
  const bool of_capacity = owner->part == THERMAL && is_capacity(declared);
  const bool of_conduction = owner->part == THERMAL && is_conductivity(declared);
  if (owner->part == THERMAL && !can_vary(*owner, declared))
    refuse("of a thermal part, only CP, CHI, SHARE, the conductivities, and the coefficient of "
           "expansion can vary");
  if (declared.of_new_points)
    refuse("it is about the state of new points, which no temperature changes later: choose one "
           "of " +
           choice);
  const double given = w.of(owner->parameters);
  if (given == 0.0 || !std::isfinite(given) || !strcmp(declared.unit, FLAG))
    refuse("its value is " + number(given) +
           ", which a factor does not change: give it another one");
  for (const auto &other : owner->varying)
    if (other == w) refuse("is given twice");
  if (of_capacity) {
    if (capacity_factor) refuse("is given twice");
    if (info.term) refuse("this law cannot have a specific heat that varies");
    for (const auto &law : laws)
      if (law.part == EOS && law.info->finds_temperature)
        refuse("the temperature follows from the internal energy of '" + title(law) +
               "', with a constant CP: leave 'vary' out");
    if (vary.factor.is_table() &&
        static_cast<int>(vary.factor.knots().size()) + law::HeatCurve::MORE >
            LawParameters::MAX_TERMS)
      refuse("a table of the specific heat can have " +
             std::to_string(LawParameters::MAX_TERMS - law::HeatCurve::MORE) + " entries");
    capacity_factor = std::make_unique<const TemperatureFactor>(vary.factor);
  } else if (of_conduction) {
    const VaryingConductivity k = {std::max(declared.name[1] - '1', 0), vary.factor};
    for (const auto &other : conducting)
      if (other.axis == k.axis) refuse("is given twice");
    conducting.push_back(k);
  } else {
    owner->varying.push_back(w);
  }
  for (const double T : vary.factor.knots()) {
    const double value = given * vary.factor.at(T);
    if ((of_capacity || of_conduction) && !declared.range.contains(value))
      refuse("it is " + number(value) + " at the temperature " + number(T) +
             ", which is out of range");
  }
  if (of_capacity && !vary.factor.is_table()) {
    const double low = vary.factor.at(vary.factor.knots().front()),
                 high = vary.factor.at(vary.factor.knots().back());
    if (high > MOST_RATIO * low || low > MOST_RATIO * high)
      refuse("this formula changes the specific heat too much between its limits");
  }
  text += ", " + what + vary.text;
  varied.push_back({vary, owner, w});
}

void ComposedMaterial::check(const Varied &v)
{
  const LawInfo &info = *v.owner->info;
  const auto refuse = [&](const std::string &why) {
    throw MaterialError(v.given.word, "vary " + v.given.name + ": " + why);
  };
  for (const double T : temperatures_to_check(*v.owner)) {
    LawParameters p = v.owner->parameters;
    for (const auto &other : v.owner->varying) other.of(p) *= other.factor.at(T);
    const double value = v.place.of(p);
    if (!std::isfinite(value) || !v.place.declaration(info).range.contains(value))
      refuse("it is " + number(value) + " at the temperature " + number(T) +
             ", which is out of range");
    if (const char *const wrong = info.check(p))
      refuse("at the temperature " + number(T) + ", " + info.name + ": " + wrong);
  }
}

bool ComposedMaterial::is_conductivity(const Parameter &declared)
{
  const char *const name = declared.name;
  return name[0] == 'K' && (name[1] == '\0' || name[1] == '2' || name[1] == '3');
}

bool ComposedMaterial::is_share(const Parameter &declared)
{
  return !strcmp(declared.name, "CHI") || !strcmp(declared.option, "fracture");
}

bool ComposedMaterial::can_vary(const UsedLaw &law, const Parameter &declared)
{
  if (declared.of_new_points || !strcmp(declared.unit, FLAG)) return false;
  return law.part != THERMAL || is_capacity(declared) || is_conductivity(declared) ||
      is_share(declared) || !strcmp(declared.option, "expansion");
}

std::vector<double> ComposedMaterial::temperatures_to_check(const UsedLaw &law)
{
  constexpr int BETWEEN = 16;
  std::vector<double> all;
  for (const auto &w : law.varying)
    all.insert(all.end(), w.factor.knots().begin(), w.factor.knots().end());
  std::sort(all.begin(), all.end());
  const std::size_t n = all.size();
  for (std::size_t k = 1; k < n; k++)
    for (int j = 1; j < BETWEEN; j++)
      all.push_back(all[k - 1] + (all[k] - all[k - 1]) * j / BETWEEN);
  return all;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// A material of its definition: rows of history, kernels, and what parts take from each other.

#include "material/composed_material.h"

#include <algorithm>

using namespace MPM_NS;

ComposedMaterial::ComposedMaterial(const MaterialDefinition &definition, const LawTable *table) :
    rho(definition.density), table(table)
{
  for (const auto &part : definition.laws) laws.insert(laws.end(), part.begin(), part.end());
  text = "density " + number(rho);
  for (auto &law : laws) {
    add(law);
    shape_matters = shape_matters || law.info->uses_F;
    speed_matters = speed_matters || (law.part == VISCOSITY && law.info->uses_speed);
  }
  for (const auto &r : definition.random) add(r);
  std::vector<Varied> varied;
  for (const auto &v : definition.vary) add(v, varied);
  for (const auto &v : varied) check(v);
  depend_on_temperature();
  melt_and_solidify();
  expand_by_conducted_heat();
  expand_by_heat_of_fracture();
  for (const auto &range : definition.ranges) add(range);
  if (definition.shares_stress()) {
    viscous = variables.size();
    for (const char *name : {"xx", "yy", "zz", "xy", "xz", "yz"})
      variables.push_back({std::string("viscous_") + name, 0.0});
  }
  ComposedMaterial::bind(1.0, 1.0);
}

bool ComposedMaterial::configure(const char *isa, double pressure_scale, double energy_scale)
{
  const LawTable *wanted = LawTable::select(isa);
  if (!wanted) return false;
  table = wanted;
  bind(pressure_scale, energy_scale);
  return true;
}

void ComposedMaterial::add(UsedLaw &law)
{
  const LawInfo &info = *law.info;
  const LawParameters &p = law.parameters;
  law.history = variables.size();
  const auto declare = [&](const HistoryDeclaration &h, const std::string &suffix) {
    const double initial = h.initial >= 0 ? p.value[h.initial] : h.initial == ONE ? 1.0 : 0.0;
    variables.push_back({h.name + suffix, initial});
  };
  for (int k = 0; k < info.count_history(p); k++) declare(info.history[k], "");
  for (int term = 0; term < p.nterms; term++)
    for (int k = 0; k < info.nterm_history; k++)
      declare(info.term_history[k], std::to_string(term + 1));

  text += ", " + title(law);
  for (int k = 0; k < info.nparameters; k++)
    if (p.value[k] != info.parameters[k].standard)
      text += !strcmp(info.parameters[k].unit, FLAG)
          ? std::string(" ") + info.parameters[k].option
          : std::string(" ") + info.parameters[k].name + "=" + number(p.value[k]);
  for (int term = 0; term < p.nterms; term++) {
    text += std::string(" ") + info.term;
    for (int k = 0; k < info.nterm_parameters; k++) text += " " + number(p.term[term][k]);
  }
  if (law.liquid) text += " liquid";
}

void ComposedMaterial::add(const UsedRange &range)
{
  int from = range.quantity == "pressure" ? UsedRange::PRESSURE_OF_STRESS
      : range.quantity == "rate"          ? UsedRange::STRAIN_RATE
      : range.quantity == "density"       ? UsedRange::DENSITY_OF_J
                                          : static_cast<int>(variables.size());
  std::string choice = "pressure, rate, density";
  for (size_t k = 0; k < variables.size(); k++) {
    choice += ", " + variables[k].name;
    if (from >= 0 && variables[k].name == range.quantity) from = k;
  }
  if (from == static_cast<int>(variables.size()))
    throw MaterialError(range.word,
                        "range: this material has no '" + range.quantity + "': choose " + choice);
  for (const auto &other : valid)
    if (other.quantity == range.quantity)
      throw MaterialError(range.word, "range: '" + range.quantity + "' is given twice");
  valid.push_back(range);
  source.push_back(from);
  text += ", range " + range.quantity + " " + number(range.low) + " " + number(range.high);
}

// what parts take from each other

void ComposedMaterial::bind(double pressure_scale, double energy_scale)
{
  rho_pressure = rho * pressure_scale;
  base = eos = damage = thermal = nullptr;
  const UsedLaw **const place[NPARTS] = {&base, &eos, &base, nullptr, &damage, &thermal};
  for (auto &law : laws) {
    if (place[law.part]) *place[law.part] = &law;
    law.parameters.heat_density = rho * energy_scale;
  }
  for (auto &law : laws)
    if (&law == thermal) make_heat_curve(law);
  if (conducts()) mean_conduction = thermal->info->conduction(thermal->parameters);
  random_heat = thermal && random_heats();
  for (auto &law : laws) {
    LawParameters &p = law.parameters;
    law.kernels = &table->kernels(law.part, law.index);
    law.heats_alone = damage && law.part == STRENGTH;
    law.varies = !law.random.empty() || !law.varying.empty() || random_density || random_heat;
    p.density = rho_pressure;
    p.chi = 1.0;
    p.broken = p.warm = 0.0;
    p.temperature = thermal ? thermal->history : -1;
    if (thermal) share_heat(*thermal->info, thermal->parameters, law.heats_alone, p);
  }
  if (expands) find_consistent_coupling();
}

void ComposedMaterial::share_heat(const LawInfo &info, const LawParameters &t, bool heats_alone,
                                  LawParameters &p)
{
  const double chi = info.heat_share(t), warm = info.warming(t);
  p.chi = heats_alone ? 1.0 : chi;
  p.broken = info.fracture_share ? info.fracture_share(t) : 0.0;
  p.warm = heats_alone ? warm * chi : warm;
}

bool ComposedMaterial::random_heats() const
{
  if (random_density) return true;
  const LawInfo &info = *thermal->info;
  for (const auto &w : thermal->varying)
    if (is_share(w.declaration(info))) return true;
  for (const auto &r : thermal->random) {
    LawParameters p = thermal->parameters;
    r.of(p) *= 0.5;
    if (info.heat_share(p) != info.heat_share(thermal->parameters) ||
        info.warming(p) != info.warming(thermal->parameters) ||
        (info.fracture_share && info.fracture_share(p) != info.fracture_share(thermal->parameters)))
      return true;
  }
  return false;
}

bool ComposedMaterial::is_viscous() const
{
  return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
    return law.part == VISCOSITY;
  });
}

bool ComposedMaterial::is_solid() const
{
  return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
    return law.part == CLOSED || law.part == STRENGTH;
  });
}

bool ComposedMaterial::is_of_surfaces() const
{
  return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
    return law.info->of_surfaces;
  });
}

int ComposedMaterial::outside(const Batch &b, int k, double *value) const
{
  switch (source[k]) {
    case UsedRange::PRESSURE_OF_STRESS:
      table->mean_stress(b, value);
      for (int i = 0; i < b.n; i++) value[i] = -value[i];
      break;
    case UsedRange::STRAIN_RATE:
      table->strain_rate(b, value);
      break;
    case UsedRange::DENSITY_OF_J:
      for (int i = 0; i < b.n; i++) value[i] = rho / b.J[i];
      if (random_density)
        for (int i = 0; i < b.n; i++) value[i] *= b.history[random_density->row][i];
      break;
    default:
      std::copy(b.history[source[k]], b.history[source[k]] + b.n, value);
  }
  return std::count_if(value, value + b.n, [&range = valid[k]](double x) {
    return x < range.low || x > range.high;
  });
}

std::unique_ptr<Material> MPM_NS::compose(const MaterialDefinition &definition,
                                          const LawTable *table)
{
  return std::make_unique<ComposedMaterial>(definition, table);
}

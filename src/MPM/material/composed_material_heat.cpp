/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What depends on temperature in a material: heat for internal energies, thermal expansion, and the
// enthalpy of its thermal part.

#include "law/damage.h"
#include "material/composed_material.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace MPM_NS;

// conduction

Conduction ComposedMaterial::conduction(const double *history) const
{
  Conduction c = mean_conduction;
  if (!history) return c;
  const double T = history[thermal->history];
  if (!thermal->random.empty()) {
    LocalParameters local(*this, *thermal);
    c = thermal->info->conduction(local.at(history, 1));
  }
  for (const auto &k : conducting) k.of(c) *= k.factor.at(T);
  if (is_curved()) c.capacity = heat_curve().capacity(T);
  return c;
}

Conduction ComposedMaterial::conduction(const double *history, double low, double high) const
{
  Conduction c = conduction(history);
  const double T = history[thermal->history];
  for (const auto &k : conducting) k.of(c) *= k.factor.mean(low, high) / k.factor.at(T);
  return c;
}

void ComposedMaterial::warm(double *history, double heat) const
{
  double *const T = history + thermal->history;
  heat_curve().warm(heat, *T, melting.latent > 0.0 ? T + 1 : nullptr);
}

double ComposedMaterial::heat_of(const double *history) const
{
  LocalParameters local(*this, *thermal);
  const LawParameters &p = thermal->random.empty() ? thermal->parameters : local.at(history, 1);
  const bool melts = thermal->info->count_history(p) > 1;
  double first[2] = {first_temperature(history, 1), 0.0};
  if (melts) thermal->info->initialize(p, nullptr, first);
  const double *const now = history + thermal->history;
  return heat_between(thermal->info->conduction(p), first[0], first[1], now[0],
                      melts ? now[1] : 0.0);
}

// heat for an internal energy

const UsedLaw *ComposedMaterial::heating_of_energy() const
{
  const UsedLaw *heating = nullptr;
  bool expands = false;
  for (const auto &law : laws) {
    if (law.part == THERMAL) heating = &law;
    if (law.part == EOS) expands = law.info->expands;
  }
  return expands ? heating : nullptr;
}

void ComposedMaterial::expand_by_conducted_heat()
{
  const UsedLaw *const heating = heating_of_energy();
  if (!heating || !heating->info->conduction) return;
  heated = variables.size();
  nheated = heating->info->count_history(heating->parameters);
  for (int k = 0; k < nheated; k++) {
    const HistoryVariable &of = variables[heating->history + k];
    variables.push_back({"energy_" + of.name, of.initial});
  }
}

void ComposedMaterial::expand_by_heat_of_fracture()
{
  const UsedLaw *const heating = heating_of_energy();
  if (!heating || !heating->info->fracture_share) return;
  if (!(heating->info->fracture_share(heating->parameters) > 0.0)) return;
  unspent_heat = variables.size();
  variables.push_back({"unspent_heat", 0.0});
}

void ComposedMaterial::spend_heat(Batch &b, double *brought) const
{
  const History history = rows(b, *damage);
  double *const rest = b.history[unspent_heat], stored[BATCH] = {};
  add_energy(eos, b, stored);
  for (int i = 0; i < b.n; i++) {
    const bool tension = stored[i] > history[law::REST_ENERGY][i];
    if (history[law::DAMAGED][i] >= 1.0 || !tension) {
      rest[i] += brought[i];
      brought[i] = 0.0;
    }
    if (tension) continue;
    brought[i] = rest[i];
    rest[i] = 0.0;
  }
}

void ComposedMaterial::find_conducted_heat(const Batch &b, double *heat) const
{
  const History now = b.history + thermal->history, before = b.history + heated;
  const bool melts = nheated > 1, differs = !thermal->random.empty() || random_density;
  LocalParameters local(*this, *thermal);
  double density = thermal->parameters.heat_density;
  Conduction c = mean_conduction;
  for (int i = 0; i < b.n; i++) {
    if (differs) {
      const LawParameters &p = local.at(&b.history[0][i], BATCH);
      density = p.heat_density;
      c = thermal->info->conduction(p);
    }
    const double f = melts ? now[1][i] : 0.0, old = melts ? before[1][i] : 0.0;
    heat[i] = density * heat_between(c, before[0][i], old, now[0][i], f);
  }
}

double ComposedMaterial::heat_between(const Conduction &c, double T0, double f0, double T,
                                      double f) const
{
  if (is_curved()) return heat_curve().enthalpy(T, f) - heat_curve().enthalpy(T0, f0);
  return c.capacity * (T - T0 + c.melting.range * (f - f0));
}

void ComposedMaterial::remember_heat(Batch &b) const
{
  for (int k = 0; k < nheated; k++)
    std::copy_n(b.history[thermal->history + k], b.n, b.history[heated + k]);
}

// stress by temperature

void ComposedMaterial::depend_on_temperature()
{
  const auto part = std::find_if(laws.begin(), laws.end(), [](const auto &law) {
    return law.part == THERMAL;
  });
  const bool varies = std::any_of(laws.begin(), laws.end(), [](const auto &law) {
    return law.part != THERMAL && !law.varying.empty();
  });
  if (part == laws.end()) return;    // nothing varies, as the parser checks
  expands = part->info->expansion && part->info->expansion(part->parameters) != 0.0;
  if (!expands && !varies) return;
  stress_temperature = variables.size();
  variables.push_back(
      {"stress_temperature", part->parameters.value[part->info->history[0].initial]});
}

double ComposedMaterial::first_temperature(const double *history, int stride) const
{
  const ParameterPlace T0 = {-1, thermal->info->history[0].initial};
  double T = T0.of(thermal->parameters);
  for (const auto &r : thermal->random)
    if (r == T0) T *= history[r.row * stride];
  return T;
}

ThermalStretch ComposedMaterial::stretch_of(const Batch &b, const double *before,
                                            const double *now) const
{
  ThermalStretch s;
  const bool varies = !thermal->random.empty() || !thermal->varying.empty();
  const double alpha = thermal->info->expansion(thermal->parameters);
  const double T0 = varies ? 0.0 : first_temperature(nullptr, 0);
  for (int i = 0; i < b.n; i++) {
    s.now[i] = std::exp(alpha * (T0 - now[i]));
    s.before[i] = before == now ? s.now[i] : std::exp(alpha * (T0 - before[i]));
    s.change[i] = alpha * (now[i] - before[i]);
  }
  if (!varies) return s;
  LocalParameters local(*this, *thermal);
  for (int i = 0; i < b.n; i++) {
    const double *const history = &b.history[0][i];
    const double start = first_temperature(history, BATCH);
    const double old =
        (before[i] - start) * thermal->info->expansion(local.at(history, BATCH, before[i]));
    const double here =
        (now[i] - start) * thermal->info->expansion(local.at(history, BATCH, now[i]));
    s.before[i] = std::exp(-old);
    s.now[i] = std::exp(-here);
    s.change[i] = here - old;
  }
  return s;
}

void ComposedMaterial::update_by_temperature(Batch &b, Tangent *t) const
{
  double *const T = b.history[thermal->history], *const at = b.history[stress_temperature];
  if (thermal->kernels->prepare) call(thermal->kernels->prepare, *thermal, b);
  double before[BATCH], mean[BATCH], work[BATCH] = {};
  bool changes = false;
  for (int i = 0; i < b.n; i++) {
    before[i] = at[i];
    at[i] = T[i];
    changes = changes || at[i] != before[i];
  }
  if (!expands) {
    make_stress(b, t);
    if (changes) add_energy_of_warming(b, before, nullptr, work);
  } else {
    const ThermalStretch s = stretch_of(b, before, at);
    table->mean_stress(b, mean);
    for (int i = 0; i < b.n; i++) work[i] = 1.5 * s.change[i] * b.Jold[i] * mean[i];
    for (int i = 0; i < b.n; i++) b.heat[i] /= s.volume(i);
    {
      const ElasticMotion motion(b, s, shape_matters);
      make_stress(b, t);
      if (changes) add_energy_of_warming(b, before, &s, work);
    }
    // J sigma is theta^3 J_e sigma, and theta is one of this temperature, not of the motion
    for (int l = 0; t && l < 9; l++)
      for (int k = 0; k < 6 && !t->skips(l); k++)
        for (int i = 0; i < b.n; i++) t->stress[k][l][i] *= s.volume(i);
    table->mean_stress(b, mean);
    for (int i = 0; i < b.n; i++) {
      work[i] += 1.5 * s.change[i] * b.J[i] * mean[i];
      b.heat[i] *= s.volume(i);
    }
  }
  for (int i = 0; i < b.n; i++) b.work[THERMOELASTIC] += b.vol0[i] * work[i];
  find_temperature(b);
}

void ComposedMaterial::add_energy_of_warming(Batch &b, const double *before,
                                             const ThermalStretch *s, double *work) const
{
  double now[BATCH], old[BATCH], T[BATCH], *const at = b.history[stress_temperature];
  energy_of_laws(b, now);
  std::copy(now, now + b.n, old);
  if (std::any_of(laws.begin(), laws.end(), [](const auto &law) {
        return law.part != THERMAL && !law.varying.empty();
      })) {
    std::copy(at, at + b.n, T);
    // a damage keeps the energy of the strength, which goes with that of the stress
    double *const kept = damage ? b.history[damage->history + law::SHEAR_ENERGY] : nullptr;
    double shear[BATCH], cold[BATCH] = {}, warm[BATCH] = {};
    if (kept) {
      std::copy(kept, kept + b.n, shear);
      add_energy(base, b, warm);
    }
    std::copy(before, before + b.n, at);
    if (kept) {
      add_energy(base, b, cold);
      for (int i = 0; i < b.n; i++)
        if (warm[i] > 0.0) kept[i] *= cold[i] / warm[i];
    }
    energy_of_laws(b, old);
    if (kept) std::copy(shear, shear + b.n, kept);
    std::copy(T, T + b.n, at);
  }
  for (int i = 0; i < b.n; i++)
    work[i] += s ? old[i] / std::pow(s->before[i], 3) - s->volume(i) * now[i] : old[i] - now[i];
}

void ComposedMaterial::expanded_speed(const Batch &state, double *c) const
{
  Batch b = state;
  const ThermalStretch s = stretch_of(b);
  {
    const ElasticMotion motion(b, s, shape_matters);
    plain_speed(b, c);
  }
  const LawInfo &info = *thermal->info;
  LocalParameters local(*this, *thermal);
  for (int i = 0; i < b.n; i++) {
    const LawParameters &p = local.at(&b.history[0][i], BATCH);
    const double T = b.history[stress_temperature][i];
    double gamma = info.gruneisen < 0 ? 0.0 : p.value[info.gruneisen];
    if (is_curved() && info.consistent && info.consistent(p))
      gamma /= info.warming(p) * p.heat_density * heat_curve().capacity(T);
    // d ln J_e = (1 + 3 ALPHA GAMMA T J) d ln J
    const double stiffer = 1.0 + std::max(3.0 * info.expansion(p) * gamma * T * b.J[i], 0.0);
    c[i] *= std::sqrt(stiffer) * std::sqrt(s.volume(i));
  }
}

// Gruneisen parameter

void ComposedMaterial::find_consistent_coupling()
{
  const LawInfo &info = *thermal->info;
  if (!info.consistent || !info.consistent(thermal->parameters)) return;
  std::vector<double> initial;
  for (const auto &v : variables) initial.push_back(v.initial);
  const double gamma = consistent_gruneisen(initial);
  const auto refuse_if_it_changes = [&](const RandomParameter &r) {
    std::vector<double> other = initial;
    other[r.row] = 0.5;
    if (consistent_gruneisen(other) != gamma)
      throw MaterialError(r.word,
                          "random " + r.name +
                              ": 'gruneisen consistent' is one Gruneisen parameter for all "
                              "points, which this changes: give 'gruneisen GAMMA' instead");
  };
  if (random_density) refuse_if_it_changes(*random_density);
  for (const auto &law : laws)
    for (const auto &r : law.random) refuse_if_it_changes(r);
  laws[thermal - laws.data()].parameters.value[info.gruneisen] = gamma;
}

double ComposedMaterial::consistent_gruneisen(std::vector<double> initial) const
{
  initial[stress_temperature] = first_temperature(initial.data(), 1);
  LocalParameters local(*this, *thermal);
  const LawParameters &p = local.at(initial.data(), 1);
  return 3.0 * bulk_modulus(initial) * thermal->info->expansion(p) * thermal->info->warming(p);
}

double ComposedMaterial::bulk_modulus(std::vector<double> initial) const
{
  constexpr double STRAIN = 1e-5;
  std::vector<double> storage(variables.size() * BATCH);
  const double x[3] = {0.0, 0.0, 0.0};
  for (const auto &law : laws)
    if (law.info->initialize) law.info->initialize(law.parameters, x, initial.data() + law.history);
  Batch b = {};
  b.n = 3;
  b.dt = b.h = 1.0;
  b.history = reinterpret_cast<History>(storage.data());
  for (int i = 0; i < b.n; i++) {
    for (std::size_t k = 0; k < initial.size(); k++) b.history[k][i] = initial[k];
    const double stretch = 1.0 - i * STRAIN;
    for (int k = 0; k < 9; k += 4) {
      b.F[k][i] = stretch;
      b.A[k][i] = stretch - 1.0;
    }
    b.J[i] = stretch * stretch * stretch;
    b.Jold[i] = b.vol0[i] = 1.0;
  }
  run(base, b);
  run(eos, b);
  double mean[BATCH], shear = 0.0;
  table->mean_stress(b, mean);
  for (int k = 0; k < 6; k++)
    shear = std::max(shear, std::fabs(b.stress[k][2] - (k < 3 ? mean[2] : 0.0)));
  const double K = -(4.0 * (mean[1] - mean[0]) - (mean[2] - mean[0])) / (6.0 * STRAIN);
  if (!(K > 0.0) || shear > 1e-3 * std::fabs(mean[2] - mean[0]))
    throw MaterialError(
        thermal->word,
        "gruneisen consistent: this material has no bulk modulus at rest, or is not "
        "isotropic: give 'gruneisen GAMMA' instead");
  return K;
}

// enthalpy

double ComposedMaterial::thermal_value(const char *name) const
{
  for (int k = 0; k < thermal->info->nparameters; k++)
    if (!strcmp(thermal->info->parameters[k].name, name)) return thermal->parameters.value[k];
  return 0.0;
}

void ComposedMaterial::make_heat_curve(UsedLaw &of)
{
  melting = {thermal_value("TMELT"), thermal_value("LATENT"), thermal_value("DT")};
  if (of.info->term || (!capacity_factor && !(melting.range > 0.0))) return;
  for (const auto &r : of.random)
    for (const char *name : {"CP", "TMELT", "LATENT", "DT"})
      if (!strcmp(r.declaration(*of.info).name, name))
        throw MaterialError(r.word,
                            std::string("random ") + name +
                                ": not with melting over a range or a specific heat that varies");
  const double cp = thermal_value("CP");
  const TemperatureFactor *const f = capacity_factor.get();
  const bool by_formula = f && !f->is_table();
  const auto c = [=](double T) {
    return f ? cp * f->at(T) : cp;
  };
  // a formula: such that the heat from one temperature to the next is exact
  const auto begin = [=](double T1, double T2) {
    constexpr int PARTS = 8;
    if (!by_formula) return c(T1);
    const double width = (T2 - T1) / PARTS;
    double mean = 0.0;
    for (int k = 0; k < PARTS; k++) mean += f->mean(T1 + k * width, T1 + (k + 1) * width) / PARTS;
    return cp * mean - 0.5 * (c(T2) - c(T1));
  };
  constexpr int MOST = LawParameters::MAX_TERMS - law::HeatCurve::MORE;
  law::HeatCurve::make(of.parameters,
                       by_formula ? f->spread(MOST)
                           : f    ? f->knots()
                                  : std::vector<double>(),
                       c, begin, melting.point, melting.latent, melting.range);
}

law::HeatCurve ComposedMaterial::heat_curve() const
{
  return {thermal->parameters, melting.point, melting.latent, melting.range};
}

std::optional<SofteningRange> ComposedMaterial::softening() const
{
  for (const auto &law : laws) {
    const LawInfo &info = *law.info;
    if (&law == thermal || !info.needs_temperature || !info.needs_temperature(law.parameters))
      continue;
    const auto value = [&](std::initializer_list<const char *> names) {
      for (int k = 0; k < info.nparameters; k++)
        for (const char *name : names)
          if (strcmp(info.parameters[k].name, name) == 0) return law.parameters.value[k];
      return 0.0;
    };
    const double melting = value({"TMELT", "TM0"});
    const SofteningRange range = {value({"TREF"}), melting > 0.0 ? melting : UNBOUNDED};
    if (melting > 0.0 || range.reference > 0.0) return range;
  }
  return {};
}

std::optional<SofteningRange> MPM_NS::softening_range(const Material &material)
{
  return static_cast<const ComposedMaterial &>(material).softening();
}

double MPM_NS::heat_since_start(const Material &material, const double *history)
{
  return static_cast<const ComposedMaterial &>(material).heat_of(history);
}

bool MPM_NS::conductivity_varies_with_temperature(const Material &material)
{
  return static_cast<const ComposedMaterial &>(material).conductivity_varies();
}

Conduction MPM_NS::mean_conduction(const Material &material, const double *history, double low,
                                   double high)
{
  return static_cast<const ComposedMaterial &>(material).conduction(history, low, high);
}

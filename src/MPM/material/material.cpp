/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Composition of a material from laws: the order in which they work on a batch, what they are told
// of each other, their rows of history, and their parameters where these differ from point to point.

#include "material/material.h"

#include "law/damage.h"
#include "law/heat_curve.h"
#include "material/elastic_motion.h"
#include "material/heat.h"
#include "material/mean_conduction.h"
#include "material/melting_solid.h"
#include "material/parts.h"
#include "material/random_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

using namespace MPM_NS;

namespace {

/** The density of a material, as its laws declare their parameters. */
constexpr Parameter DENSITY = {"", "density", "density", POSITIVE, REQUIRED, "reference density"};

/** Of the specific heats at the limits of a formula. */
constexpr double MOST_RATIO = 1e3;

class ComposedMaterial : public Material {
 public:
  ComposedMaterial(const MaterialDefinition &definition, const LawTable *table) :
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

  bool configure(const char *isa, double pressure_scale, double energy_scale) override
  {
    const LawTable *wanted = LawTable::select(isa);
    if (!wanted) return false;
    table = wanted;
    bind(pressure_scale, energy_scale);
    return true;
  }

  double density() const override { return rho; }
  double density(const double *history) const override
  {
    return random_density ? rho * history[random_density->row] : rho;
  }
  const std::vector<HistoryVariable> &history() const override { return variables; }
  bool uses_F() const override { return shape_matters; }
  bool is_barotropic() const override { return eos && !base && !damage && variables.empty(); }
  bool is_viscous() const override
  {
    return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
      return law.part == VISCOSITY;
    });
  }
  bool is_solid() const override
  {
    return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
      return law.part == CLOSED || law.part == STRENGTH;
    });
  }
  bool is_of_surfaces() const override
  {
    return std::any_of(laws.begin(), laws.end(), [](const auto &law) {
      return law.info->of_surfaces;
    });
  }
  std::string describe() const override { return text; }

  void initialize(const double *x, double *history) const override
  {
    for (size_t k = 0; k < variables.size(); k++) history[k] = variables[k].initial;
    if (random_density) set_factor(*random_density, DENSITY, rho, x, history);
    for (const auto &law : laws)
      for (const auto &r : law.random) {
        const Parameter &declared = r.declaration(*law.info);
        const double mean = r.of(law.parameters);
        set_factor(r, declared, mean, x, history);
        for (const auto &w : law.warm)
          for (const double T : w.factor.knots())
            if (w == r) check_range(declared, mean * history[r.row] * w.factor.at(T));
      }
    if (seen >= 0) history[seen] = first_temperature(history, 1);
    for (const auto &law : laws)
      if (law.varies) {
        LocalParameters local(*this, law);
        initialize(law, local.at(history, 1), x, history);
      } else if (law.info->initialize) {
        law.info->initialize(law.parameters, x, history + law.history);
      }
    if (solid >= 0) history[solid] = 1.0 - history[molten];
    for (int k = 0; k < nheated; k++) history[heated + k] = history[thermal->history + k];
  }

  bool is_thermoelastic() const override { return seen >= 0; }
  bool conducts() const override { return thermal && thermal->info->conduction; }
  bool conduction_varies() const override
  {
    return conducts() && (!thermal->random.empty() || !conducting.empty() || is_curved());
  }
  Conduction conduction(const double *history) const override
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
  /** For mean_conduction(). */
  bool conductivity_varies() const { return conducts() && !conducting.empty(); }
  Conduction conduction(const double *history, double low, double high) const
  {
    Conduction c = conduction(history);
    const double T = history[thermal->history];
    for (const auto &k : conducting) k.of(c) *= k.factor.mean(low, high) / k.factor.at(T);
    return c;
  }
  void warm(double *history, double heat) const override
  {
    double *const T = history + thermal->history;
    heat_curve().warm(heat, *T, melting.latent > 0.0 ? T + 1 : nullptr);
  }

  /** See heat_since_start(). */
  double heat_of(const double *history) const
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

  void initialized() const override
  {
    if (random_density) random_density->field->release();
    for (const auto &law : laws)
      for (const auto &r : law.random) r.field->release();
  }

  void initial_stress(Batch &b) const override
  {
    b.dt = 0.0;
    for (int i = 0; i < b.n; i++) {
      b.heat[i] = b.plastic[i] = 0.0;
      b.Jold[i] = b.J[i];
    }
    for (auto &row : b.A) std::fill(row, row + b.n, 0.0);
    clear_stress(b);
    if (eos && eos->info->finds_temperature) {
      // what had burnt from the start is warm without that anything has been conducted
      run_eos(b, nullptr);
      remember_heat(b);
      return;
    }
    if (!expands) {
      run(eos, b);
      return;
    }
    const ElasticMotion motion(b, stretch_of(b), shape_matters);
    run(eos, b);
  }

  void update(Batch &b) const override { update(b, nullptr); }

  bool has_tangent() const override
  {
    if (damage || solid >= 0) return false;
    // a compression that warms, and so expands
    const int gruneisen = expands ? thermal->info->gruneisen : -1;
    if (gruneisen >= 0 && thermal->parameters.value[gruneisen] != 0.0) return false;
    return std::all_of(laws.begin(), laws.end(), [](const auto &law) {
      return law.part == THERMAL || law.kernels->tangent;
    });
  }

  void update_with_tangent(Batch &b, Tangent &t) const override
  {
    for (int l = 0; l < 9; l++) {
      if (t.skips(l)) continue;
      for (auto &component : t.stress) std::fill_n(component[l], b.n, 0.0);
      std::fill_n(t.heat[l], b.n, 0.0);
    }
    update(b, &t);
  }

  const std::vector<ValidRange> &ranges() const override { return valid; }

  int outside(const Batch &b, int k, double *value) const override
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

  void wave_speed(const Batch &state, double *c) const override
  {
    Batch copy;
    const Batch &b = without_viscous_stress(state, copy);
    if (expands)
      expanded_speed(b, c);
    else
      plain_speed(b, c);
    for (const auto &law : laws) {
      if (!law.kernels->raise_speed) continue;
      double solid_speed[BATCH];
      if (law.liquid) std::copy(c, c + b.n, solid_speed);
      call(law.kernels->raise_speed, law, b, c);
      for (int i = 0; law.liquid && i < b.n; i++)
        if (b.history[solid][i] >= 1.0) c[i] = solid_speed[i];
    }
  }

  void stored_energy(const Batch &state, double *w) const override
  {
    if (!expands) {
      energy_of_laws(state, w);
      return;
    }
    Batch b = state;
    const ThermalStretch s = stretch_of(b);
    const ElasticMotion motion(b, s, shape_matters);
    energy_of_laws(b, w);
    for (int i = 0; i < b.n; i++) w[i] *= s.volume(i);
  }

 private:
  double rho;
  double rho_pressure;    ///< density in units of pressure over velocity^2, as the laws need it
  const LawTable *table;
  std::vector<UsedLaw> laws;                                ///< in the order of their parts
  const UsedLaw *base;                                      ///< closed law or strength, or null
  const UsedLaw *eos, *damage, *thermal;                    ///< or null
  std::unique_ptr<const RandomParameter> random_density;    ///< when it differs from point to point
  bool shape_matters = false;                               ///< does a law look at F?
  bool speed_matters = false;    ///< does a viscosity look at batch.speed?
  bool random_heat = false;      ///< does what the thermal part tells the others?
  /** First of six history variables with what viscosities added to the stress in the last step, for
   *  a closed law or strength that builds on that stress and must not see it; -1 when not needed. */
  int viscous = -1;
  /** History variable with the temperature to which the stress belongs, when stress depends on it by
   *  expansion or by parameters: conduction and heat may have changed the temperature since. Else -1. */
  int seen = -1;
  bool expands = false;                        ///< does it have thermal expansion?
  std::vector<WarmConductivity> conducting;    ///< those that depend on the temperature
  Conduction mean_conduction = {};             ///< without what differs from point to point
  std::unique_ptr<const TemperatureFactor> capacity_factor;    ///< of the specific heat; or null
  struct {
    double point, latent, range;
  } melting = {};    ///< TMELT, LATENT, and DT of a thermal part
  /** First of nheated history variables with the temperature, and the molten fraction, that the internal
   *  energy of an equation of state knows of: conduction may have changed them since. -1: not needed. */
  int heated = -1, nheated = 0;
  /** History variable with heat of a damaged point that its temperature has, and its internal energy has not got yet;
   *  -1: not needed. */
  int unspent = -1;
  /** History variable with the solid share to which the stress belongs, when what melts becomes a liquid with
   *  a viscosity of its own; else -1. molten: the one with the molten fraction. */
  int solid = -1, molten = -1;
  std::vector<HistoryVariable> variables;
  std::vector<ValidRange> valid;
  std::vector<int> source;    ///< of the quantities of these, as in UsedRange
  std::string text;

  /** A step, and its tangent if t is not null. */
  void update(Batch &b, Tangent *t) const
  {
    if (seen >= 0) {
      update_by_temperature(b, t);
      return;
    }
    make_stress(b, t);
    find_temperature(b);
  }

  /** Stress and history at the end of the step, and heat per reference volume, but not what heat
   *  does to the temperature. */
  void make_stress(Batch &b, Tangent *t) const
  {
    double outside[BATCH];
    for (int i = 0; i < b.n; i++) {
      outside[i] = b.heat[i];
      b.heat[i] = b.plastic[i] = 0.0;
    }
    for (double &w : b.work) w = 0.0;

    if (damage) call(damage->kernels->prepare, *damage, b);
    take_viscous_stress(b);
    if (speed_matters) plain_speed(b, b.speed);
    if (!base) clear_stress(b);
    if (solid < 0)
      run(base, b, t);
    else
      run_solid(b);
    if (damage) account_of_strength(b);
    for (int i = 0; i < b.n; i++) {
      b.heat[i] += outside[i];
      b.work[VISCOUS] += b.vol0[i] * outside[i];
    }
    // what viscosities add: stress after them minus stress before them
    with_viscous_stress(b, [](double stress, double &added) {
      added = -stress;
    });
    for (const auto &law : laws)
      if (law.liquid)
        run_liquid(law, b);
      else if (law.part == VISCOSITY)
        run(&law, b, t);
    with_viscous_stress(b, [](double stress, double &added) {
      added += stress;
    });
    if (damage) table->mean_stress(b, b.viscous_mean);
    run_eos(b, t);
    if (damage) add_energy(eos, b, b.volume_energy);
    run_damage(b);
  }

  /** The thermal part, after all others. */
  void find_temperature(Batch &b) const
  {
    run(thermal, b);
    remember_heat(b);
  }

  /** What an internal energy knows of, see heated. */
  void remember_heat(Batch &b) const
  {
    for (int k = 0; k < nheated; k++)
      std::copy_n(b.history[thermal->history + k], b.n, b.history[heated + k]);
  }

  /* ------------------------------------------------------------------ heat for an internal energy */

  /** The thermal part of a material with an internal energy, or null. */
  const UsedLaw *heating_of_energy() const
  {
    const UsedLaw *heating = nullptr;
    bool expands = false;
    for (const auto &law : laws) {
      if (law.part == THERMAL) heating = &law;
      if (law.part == EOS) expands = law.info->expands;
    }
    return expands ? heating : nullptr;
  }

  /** A material with an internal energy, to which fix mpm/heat brings heat. */
  void expand_by_conducted_heat()
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

  /** A material with an internal energy and a damage, whose work is heat. */
  void expand_by_heat_of_fracture()
  {
    const UsedLaw *const heating = heating_of_energy();
    if (!heating || !heating->info->fracture_share) return;
    if (!(heating->info->fracture_share(heating->parameters) > 0.0)) return;
    unspent = variables.size();
    variables.push_back({"unspent_heat", 0.0});
  }

  /** The damage. An internal energy gets the heat of it in the next step: had it got that in this one, its pressure would
   *  not be the one that has done the work. */
  void run_damage(Batch &b) const
  {
    if (unspent < 0) {
      run(damage, b);
      return;
    }
    double before[BATCH], *const rest = b.history[unspent];
    std::copy_n(b.heat, b.n, before);
    run(damage, b);
    for (int i = 0; i < b.n; i++) rest[i] += b.heat[i] - before[i];
  }

  /** Adds what a damage has left for the internal energy. In tension, which a damaged point does not bear, that has the work
   *  of the undamaged material, and takes it back on the way to compression. Less would come back if heat came on the way,
   *  and the energy keep work that nobody has done: so this heat, and what is conducted to a failed point, waits. */
  void spend_heat(Batch &b, double *brought) const
  {
    const History history = rows(b, *damage);
    double *const rest = b.history[unspent], stored[BATCH] = {};
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

  /** The equation of state. Its internal energy gets what conduction has brought since the last step, and what the
   *  damage has left for it, too, as heat of this one, which the temperature knows of already. */
  void run_eos(Batch &b, Tangent *t) const
  {
    if (heated < 0 && unspent < 0) {
      run(eos, b, t);
      return;
    }
    double own[BATCH], brought[BATCH] = {};
    if (heated >= 0) find_conducted_heat(b, brought);
    if (unspent >= 0) spend_heat(b, brought);
    if (eos->info->finds_temperature) {
      // the temperature at the start, which has this heat, belongs to the energy at the start
      double *const energy = b.history[eos->history], *const heat = b.history[eos->history + 1];
      for (int i = 0; i < b.n; i++) {
        energy[i] += brought[i];
        heat[i] += brought[i];
      }
      run(eos, b, t);
      return;
    }
    std::copy_n(b.heat, b.n, own);
    for (int i = 0; i < b.n; i++) b.heat[i] += brought[i];
    run(eos, b, t);
    std::copy_n(own, b.n, b.heat);
  }

  /** Heat per reference volume. */
  void find_conducted_heat(const Batch &b, double *heat) const
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

  /** Heat per mass from one temperature and molten fraction to another. */
  double heat_between(const Conduction &c, double T0, double f0, double T, double f) const
  {
    if (is_curved()) return heat_curve().enthalpy(T, f) - heat_curve().enthalpy(T0, f0);
    return c.capacity * (T - T0 + c.melting.range * (f - f0));
  }

  /** Energy per reference volume that the laws have stored, those of a batch without thermal stretch. */
  void energy_of_laws(const Batch &state, double *w) const
  {
    Batch copy;
    const Batch &b = without_viscous_stress(state, copy);
    for (int i = 0; i < b.n; i++) w[i] = 0.0;
    for (const auto &law : laws)
      if (law.part == STRENGTH && solid >= 0)
        add_energy_of_solid(b, w);
      else if (!(damage && law.part == STRENGTH))
        add_energy(&law, b, w);
  }

  /* ------------------------------------------------------------------ stress by temperature */

  /** A material whose stress depends on the temperature, by expansion or by parameters. */
  void depend_on_temperature()
  {
    const auto part = std::find_if(laws.begin(), laws.end(), [](const auto &law) {
      return law.part == THERMAL;
    });
    const bool varies = std::any_of(laws.begin(), laws.end(), [](const auto &law) {
      return law.part != THERMAL && !law.warm.empty();
    });
    if (part == laws.end()) return;    // the parser has seen to it that nothing varies
    expands = part->info->expansion && part->info->expansion(part->parameters) != 0.0;
    if (!expands && !varies) return;
    seen = variables.size();
    variables.push_back(
        {"stress_temperature", part->parameters.value[part->info->history[0].initial]});
  }

  /** Initial temperature of a point, at which it has no thermal strain. */
  double first_temperature(const double *history, int stride) const
  {
    const ParameterPlace T0 = {-1, thermal->info->history[0].initial};
    double T = T0.of(thermal->parameters);
    for (const auto &r : thermal->random)
      if (r == T0) T *= history[r.row * stride];
    return T;
  }

  /** Thermal stretch at the temperatures now and before, of the points of a batch. */
  ThermalStretch stretch_of(const Batch &b, const double *before, const double *now) const
  {
    ThermalStretch s;
    const bool varies = !thermal->random.empty() || !thermal->warm.empty();
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

  /** The one to which the stress belongs. */
  ThermalStretch stretch_of(const Batch &b) const
  {
    return stretch_of(b, b.history[seen], b.history[seen]);
  }

  /** A step of a material whose stress depends on the temperature. The temperature is that of the end of the
   *  step but for the heat that the step makes. What stress loses or gains by the change of temperature
   *  is the work THERMOELASTIC: that of the stress on the thermal strain, and, at the same stress or
   *  deformation gradient, whatever a law keeps, the change of the stored energy. */
  void update_by_temperature(Batch &b, Tangent *t) const
  {
    double *const T = b.history[thermal->history], *const at = b.history[seen];
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

  /** Adds the stored energy with the temperatures before minus that with those of now, in the elastic state
   *  of now. */
  void add_energy_of_warming(Batch &b, const double *before, const ThermalStretch *s,
                             double *work) const
  {
    double now[BATCH], old[BATCH], T[BATCH], *const at = b.history[seen];
    energy_of_laws(b, now);
    std::copy(now, now + b.n, old);
    if (std::any_of(laws.begin(), laws.end(), [](const auto &law) {
          return law.part != THERMAL && !law.warm.empty();
        })) {
      std::copy(at, at + b.n, T);
      std::copy(before, before + b.n, at);
      energy_of_laws(b, old);
      std::copy(T, T + b.n, at);
    }
    for (int i = 0; i < b.n; i++)
      work[i] += s ? old[i] / std::pow(s->before[i], 3) - s->volume(i) * now[i] : old[i] - now[i];
  }

  /** Wave speed with thermal expansion, which a compression that warms makes faster. */
  void expanded_speed(const Batch &state, double *c) const
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
      const double T = b.history[seen][i];
      double gamma = info.gruneisen < 0 ? 0.0 : p.value[info.gruneisen];
      if (is_curved() && info.consistent && info.consistent(p))
        gamma /= info.warming(p) * p.heat_density * heat_curve().capacity(T);
      // d ln J_e = (1 + 3 ALPHA GAMMA T J) d ln J
      const double stiffer = 1.0 + std::max(3.0 * info.expansion(p) * gamma * T * b.J[i], 0.0);
      c[i] *= std::sqrt(stiffer) * std::sqrt(s.volume(i));
    }
  }

  /** Gruneisen parameter 3 K ALPHA/(density CP) of a thermal part that asks for it: an elastic body that
   *  expands when it is warmed is warmed when it is compressed (M.A. Biot, J. Appl. Phys. 27 (1956) 240). */
  void find_consistent_coupling()
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

  /** The same of a point with the initial values of its history variables, at its first temperature. */
  double consistent_gruneisen(std::vector<double> initial) const
  {
    initial[seen] = first_temperature(initial.data(), 1);
    LocalParameters local(*this, *thermal);
    const LawParameters &p = local.at(initial.data(), 1);
    return 3.0 * bulk_modulus(initial) * thermal->info->expansion(p) * thermal->info->warming(p);
  }

  /** Bulk modulus without stress, from two small compressions. */
  double bulk_modulus(std::vector<double> initial) const
  {
    constexpr double STRAIN = 1e-5;
    std::vector<double> storage(variables.size() * BATCH);
    const double x[3] = {0.0, 0.0, 0.0};
    for (const auto &law : laws)
      if (law.info->initialize)
        law.info->initialize(law.parameters, x, initial.data() + law.history);
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

  /* ------------------------------------------------------------------ solids that melt */

  void melt_and_solidify()
  {
    if (std::none_of(laws.begin(), laws.end(), [](const auto &law) {
          return law.liquid;
        }))
      return;
    solid = variables.size();
    molten = std::find_if(variables.begin(), variables.end(),
                          [](const auto &variable) {
                            return variable.name == "molten";
                          }) -
        variables.begin();
    variables.push_back({"solid", 1.0});
  }

  /** The strength of the solid part of the points. The elastic energy of shear that melts or is diluted is
   *  heat, and counts as plastic work. */
  void run_solid(Batch &b) const
  {
    double *const was = b.history[solid];
    const MeltingSolid part(b, was, b.history[molten]);
    if (part.complete) {
      run(base, b);
      return;
    }
    double lost[BATCH] = {}, rest[BATCH] = {};
    if (part.changes) add_energy_of_solid(b, lost);
    for (int i = 0; i < b.n; i++) was[i] = part.share[i];
    for (auto &row : b.stress)
      for (int i = 0; i < b.n; i++) row[i] *= part.to_solid(i);
    // what is left of the history when a share of it is kept
    const LawInfo &info = *base->info;
    const int first = base->history,
              last = first + info.count_history(base->parameters) +
        info.nterm_history * base->parameters.nterms;
    const auto keep = [&](int i, double share) {
      for (int k = first; k < last; k++) {
        double &h = b.history[k][i];
        h = variables[k].initial + share * (h - variables[k].initial);
      }
    };
    if (part.changes) {
      for (int i = 0; i < b.n; i++) keep(i, part.kept(i));
      add_energy(base, b, rest);
      for (int i = 0; i < b.n; i++) {
        lost[i] -= part.share[i] * rest[i];
        b.work[PLASTIC] += b.vol0[i] * lost[i];
        b.work[HEAT] += b.vol0[i] * lost[i];
      }
    }
    {
      const ShareOfVolume volume(b, part.share);
      run(base, b);
    }
    for (int i = 0; i < b.n; i++)
      if (part.share[i] == 0.0) keep(i, 0.0);
    for (auto &row : b.stress)
      for (int i = 0; i < b.n; i++) row[i] *= part.share[i];
    for (int i = 0; i < b.n; i++) b.heat[i] = part.share[i] * b.heat[i] + lost[i];
  }

  /** Energy of the strength, which only the solid part stores. */
  void add_energy_of_solid(const Batch &state, double *w) const
  {
    const double *const share = state.history[solid];
    Batch b = state;
    double whole[BATCH] = {};
    for (auto &row : b.stress)
      for (int i = 0; i < b.n; i++) row[i] = share[i] > 0.0 ? row[i] / share[i] : 0.0;
    add_energy(base, b, whole);
    for (int i = 0; i < b.n; i++) w[i] += share[i] * whole[i];
  }

  /** A viscosity of the molten part of the points. */
  void run_liquid(const UsedLaw &law, Batch &b) const
  {
    double share[BATCH], heat[BATCH], stress[6][BATCH];
    bool any = false;
    for (int i = 0; i < b.n; i++) {
      share[i] = 1.0 - b.history[solid][i];
      any = any || share[i] > 0.0;
    }
    if (!any) return;
    std::copy(b.heat, b.heat + b.n, heat);
    memcpy(stress, b.stress, sizeof(stress));
    {
      const ShareOfVolume volume(b, share);
      run(&law, b);
    }
    for (int i = 0; i < b.n; i++) b.heat[i] = heat[i] + share[i] * (b.heat[i] - heat[i]);
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < b.n; i++)
        b.stress[k][i] = stress[k][i] + share[i] * (b.stress[k][i] - stress[k][i]);
  }

  /* ------------------------------------------------------------------ parts */

  /** Stress of a material without strength. */
  static void clear_stress(Batch &b)
  {
    for (auto &row : b.stress) std::fill(row, row + b.n, 0.0);
  }

  /** Calls work with the stress and what viscosities added to it, when that is kept apart. */
  template <class Work> void with_viscous_stress(Batch &b, Work work) const
  {
    for (int k = 0; viscous >= 0 && k < 6; k++)
      for (int i = 0; i < b.n; i++) work(b.stress[k][i], b.history[viscous + k][i]);
  }

  void take_viscous_stress(Batch &b) const
  {
    with_viscous_stress(b, [](double &stress, double added) {
      stress -= added;
    });
  }

  const Batch &without_viscous_stress(const Batch &b, Batch &copy) const
  {
    if (viscous < 0) return b;
    copy = b;
    take_viscous_stress(copy);
    return copy;
  }

  static History rows(const Batch &b, const UsedLaw &law)
  {
    return b.history ? b.history + law.history : nullptr;
  }

  /** The rows of a batch but A, F, stress, and history. */
  static constexpr double (Batch::*single_rows[])[BATCH] = {&Batch::J,
                                                            &Batch::Jold,
                                                            &Batch::vol0,
                                                            &Batch::heat,
                                                            &Batch::plastic,
                                                            &Batch::speed,
                                                            &Batch::kept,
                                                            &Batch::plastic_work,
                                                            &Batch::viscous_mean,
                                                            &Batch::shear_energy,
                                                            &Batch::volume_energy};
  static_assert(sizeof(Batch) < (9 + 9 + 6 + std::size(single_rows) + 1) * BATCH * sizeof(double),
                "all rows are listed");

  /** Parameters of a law at one point after the other. */
  class LocalParameters {
   public:
    LocalParameters(const ComposedMaterial &material, const UsedLaw &law) :
        material(material), law(law), p(law.parameters)
    {
      if (material.random_heat) heat = material.thermal->parameters;
    }
    LocalParameters(const LocalParameters &) = delete;

    /** At the point with the values history[0], history[stride], ... of its history variables, and the
     *  temperature to which its stress belongs, or, of shares of heat alone, that of now. */
    const LawParameters &at(const double *history, int stride)
    {
      const int row = material.seen >= 0 ? material.seen
          : material.thermal             ? material.thermal->history
                                         : -1;
      return at(history, stride, row < 0 ? 0.0 : history[row * stride]);
    }
    const LawParameters &at(const double *history, int stride, double temperature)
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

   private:
    const ComposedMaterial &material;
    const UsedLaw &law;
    LawParameters p, heat;

    static void replace(const UsedLaw &law, LawParameters &p, const double *history, int stride,
                        double temperature)
    {
      for (const auto &w : law.warm) w.of(p) = w.of(law.parameters);
      for (const auto &r : law.random) r.of(p) = r.of(law.parameters) * history[r.row * stride];
      for (const auto &w : law.warm) w.of(p) *= w.factor.at(temperature);
    }
  };

  /** Update by a law, if there is one. */
  void run(const UsedLaw *law, Batch &b) const
  {
    if (law) call(law->kernels->update, *law, b);
  }

  /** The same, and its tangent if t is not null. */
  void run(const UsedLaw *law, Batch &b, Tangent *t) const
  {
    if (!t) {
      run(law, b);
    } else if (law && !law->varies) {
      law->kernels->tangent(law->parameters, b, rows(b, *law), *t);
    } else if (law) {
      Tangent own;
      own.plane = t->plane;
      const auto copy = [](const Tangent &from, int i, Tangent &to, int j) {
        for (int l = 0; l < 9; l++) {
          if (from.skips(l)) continue;
          for (int k = 0; k < 6; k++) to.stress[k][l][j] = from.stress[k][l][i];
          to.heat[l][j] = from.heat[l][i];
        }
      };
      one_by_one(*law, b, [&](const LawParameters &p, Batch &one, History history, int i) {
        copy(*t, i, own, 0);
        law->kernels->tangent(p, one, history, own);
        copy(own, 0, *t, i);
        take_back(one, i, b);
      });
    }
  }

  /** A kernel that changes a batch. */
  void call(void (*kernel)(const LawParameters &, Batch &, History), const UsedLaw &law,
            Batch &b) const
  {
    if (!law.varies) {
      kernel(law.parameters, b, rows(b, law));
      return;
    }
    one_by_one(law, b, [&](const LawParameters &p, Batch &one, History history, int i) {
      kernel(p, one, history);
      take_back(one, i, b);
    });
  }

  /** What a kernel has changed in the batch of point i of another one. */
  static void take_back(const Batch &one, int i, Batch &b)
  {
    for (int k = 0; k < 6; k++) b.stress[k][i] = one.stress[k][0];
    for (const auto row : single_rows) (b.*row)[i] = (one.*row)[0];
    for (int k = 0; k < NWORK; k++) b.work[k] += one.work[k];
  }

  /** A kernel that adds to values of the points. */
  void call(void (*kernel)(const LawParameters &, const Batch &, History, double *),
            const UsedLaw &law, const Batch &b, double *value) const
  {
    if (!law.varies)
      kernel(law.parameters, b, rows(b, law), value);
    else
      one_by_one(law, b, [&](const LawParameters &p, const Batch &one, History history, int i) {
        kernel(p, one, history, value + i);
      });
  }

  /** Calls work for each point in a batch of its own, with its own parameters. The history is not
   *  copied: its rows are those of the batch, beginning with the point. */
  template <class Work> void one_by_one(const UsedLaw &law, const Batch &b, Work work) const
  {
    Batch one;
    one.n = 1;
    one.dt = b.dt;
    one.h = b.h;
    one.time = b.time;
    LocalParameters local(*this, law);
    for (int i = 0; i < b.n; i++) {
      for (int k = 0; k < 9; k++) one.A[k][0] = b.A[k][i];
      for (int k = 0; k < 9; k++) one.F[k][0] = b.F[k][i];
      for (int k = 0; k < 6; k++) one.stress[k][0] = b.stress[k][i];
      for (double &w : one.work) w = 0.0;
      for (const auto row : single_rows) (one.*row)[0] = (b.*row)[i];
      one.history = reinterpret_cast<History>(&b.history[0][i]);
      work(local.at(&b.history[0][i], BATCH), one, one.history + law.history, i);
    }
  }

  /** Factor of a parameter at x; it must keep the parameter in the range that it is declared with. */
  static void set_factor(const RandomParameter &r, const Parameter &declared, double mean,
                         const double *x, double *history)
  {
    const double g = r.field->value(x);    // standard normal deviate
    const double s2 = std::log1p(r.variation * r.variation);
    history[r.row] = r.lognormal ? std::exp(std::sqrt(s2) * g - 0.5 * s2) : 1.0 + r.variation * g;
    check_range(declared, mean * history[r.row]);
  }

  static void check_range(const Parameter &declared, double value)
  {
    if (!declared.range.contains(value))
      throw std::runtime_error(std::string("random ") + declared.name + " is " + number(value) +
                               " at a point, which is out of range: use lognormal, or a smaller "
                               "coefficient of variation");
  }

  /** History of a law at a new point with these parameters. */
  static void initialize(const UsedLaw &law, const LawParameters &p, const double *x,
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

  // of a thermal part

  double thermal_value(const char *name) const
  {
    for (int k = 0; k < thermal->info->nparameters; k++)
      if (!strcmp(thermal->info->parameters[k].name, name)) return thermal->parameters.value[k];
    return 0.0;
  }
  /** Does heat give the temperature by the enthalpy? */
  bool is_curved() const { return thermal && thermal->parameters.curved; }
  void make_heat_curve(UsedLaw &of)
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
  law::HeatCurve heat_curve() const
  {
    return {thermal->parameters, melting.point, melting.latent, melting.range};
  }

  /** What a thermal part with parameters t tells another law. With a damage all plastic work goes to
   *  batch.heat, for account_of_strength(). */
  static void share_heat(const LawInfo &info, const LawParameters &t, bool heats_alone,
                         LawParameters &p)
  {
    const double chi = info.heat_share(t), warm = info.warming(t);
    p.chi = heats_alone ? 1.0 : chi;
    p.broken = info.fracture_share ? info.fracture_share(t) : 0.0;
    p.warm = heats_alone ? warm * chi : warm;
  }

  /** Kernels of all parts, and what they are told of each other. */
  void bind(double pressure_scale, double energy_scale)
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
      law.varies = !law.random.empty() || !law.warm.empty() || random_density || random_heat;
      p.density = rho_pressure;
      p.chi = 1.0;
      p.broken = p.warm = 0.0;
      p.temperature = thermal ? thermal->history : -1;
      if (thermal) share_heat(*thermal->info, thermal->parameters, law.heats_alone, p);
    }
    if (expands) find_consistent_coupling();
  }

  /** Does what share_heat() tells differ from point to point? */
  bool random_heats() const
  {
    if (random_density) return true;
    const LawInfo &info = *thermal->info;
    for (const auto &w : thermal->warm)
      if (is_share(w.declaration(info))) return true;
    for (const auto &r : thermal->random) {
      LawParameters p = thermal->parameters;
      r.of(p) *= 0.5;
      if (info.heat_share(p) != info.heat_share(thermal->parameters) ||
          info.warming(p) != info.warming(thermal->parameters) ||
          (info.fracture_share &&
           info.fracture_share(p) != info.fracture_share(thermal->parameters)))
        return true;
    }
    return false;
  }

  /** Energy stored by one law, added to w. */
  void add_energy(const UsedLaw *law, const Batch &b, double *w) const
  {
    if (law && law->kernels->energy) call(law->kernels->energy, *law, b, w);
  }

  /** What the strength has done, for a damage; heat that the equation of state shall have. */
  void account_of_strength(Batch &b) const
  {
    for (int i = 0; i < b.n; i++) {
      b.plastic_work[i] = b.heat[i];
      b.heat[i] *= damage->parameters.chi * b.kept[i];
      b.shear_energy[i] = b.volume_energy[i] = 0.0;
    }
    if (random_heat) {
      LocalParameters local(*this, *damage);
      for (int i = 0; i < b.n; i++)
        b.heat[i] = local.at(&b.history[0][i], BATCH).chi * b.kept[i] * b.plastic_work[i];
    }
    add_energy(base, b, b.shear_energy);
  }

  void add(UsedLaw &law)
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

  /** A parameter by its name, NAME or LAW.NAME, where LAW is the name of the part or of the closed law or, of
   *  viscosities, as there may be several, that of the law. Parameters of terms are NAME1, NAME2, ...
   *  Null: there is none with this name. choice: adds all names that fit; what, word: for the error message. */
  template <class Fits>
  UsedLaw *find_parameter(const std::string &wanted, ParameterPlace &place, std::string &choice,
                          const std::string &what, int word, const Fits &fits)
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
        throw MaterialError(word,
                            what + ": several laws of this material have it: choose " + choice);
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

  /** density or a parameter */
  void add(const UsedRandom &random)
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
    text += ", " + what + (random.lognormal ? " lognormal " : " normal ") +
        number(random.variation) + " " + number(random.length) + " " + std::to_string(random.seed);
  }

  /** A parameter that was added and depends on the temperature. */
  struct Varied {
    const UsedVary &given;
    const UsedLaw *owner;
    ParameterPlace place;
  };

  /** A parameter that depends on the temperature; a thermal one is in range at all temperatures. */
  void add(const UsedVary &vary, std::vector<Varied> &varied)
  {
    const std::string what = "vary " + vary.name;
    const auto refuse = [&](const std::string &why) {
      throw MaterialError(vary.word, what + ": " + why);
    };
    WarmParameter w = {{-1, -1}, vary.factor};
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
    for (const auto &other : owner->warm)
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
      const WarmConductivity k = {std::max(declared.name[1] - '1', 0), vary.factor};
      for (const auto &other : conducting)
        if (other.axis == k.axis) refuse("is given twice");
      conducting.push_back(k);
    } else {
      owner->warm.push_back(w);
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

  /** It is in its range, and its law can be with all that varies, at all temperatures. */
  static void check(const Varied &v)
  {
    const LawInfo &info = *v.owner->info;
    const auto refuse = [&](const std::string &why) {
      throw MaterialError(v.given.word, "vary " + v.given.name + ": " + why);
    };
    for (const double T : temperatures_to_check(*v.owner)) {
      LawParameters p = v.owner->parameters;
      for (const auto &other : v.owner->warm) other.of(p) *= other.factor.at(T);
      const double value = v.place.of(p);
      if (!std::isfinite(value) || !v.place.declaration(info).range.contains(value))
        refuse("it is " + number(value) + " at the temperature " + number(T) +
               ", which is out of range");
      if (const char *const wrong = info.check(p))
        refuse("at the temperature " + number(T) + ", " + info.name + ": " + wrong);
    }
  }

  static bool is_capacity(const Parameter &declared) { return !strcmp(declared.name, "CP"); }
  static bool is_conductivity(const Parameter &declared)
  {
    const char *const name = declared.name;
    return name[0] == 'K' && (name[1] == '\0' || name[1] == '2' || name[1] == '3');
  }
  /** Is it a share of work that becomes heat? */
  static bool is_share(const Parameter &declared)
  {
    return !strcmp(declared.name, "CHI") || !strcmp(declared.option, "fracture");
  }
  /** Can a parameter depend on the temperature? */
  static bool can_vary(const UsedLaw &law, const Parameter &declared)
  {
    if (declared.of_new_points || !strcmp(declared.unit, FLAG)) return false;
    return law.part != THERMAL || is_capacity(declared) || is_conductivity(declared) ||
        is_share(declared) || !strcmp(declared.option, "expansion");
  }

  /** Knots of all factors of a law, and some temperatures between them: what parameters must be
   *  together need not hold between knots because it holds there. */
  static std::vector<double> temperatures_to_check(const UsedLaw &law)
  {
    constexpr int BETWEEN = 16;
    std::vector<double> all;
    for (const auto &w : law.warm)
      all.insert(all.end(), w.factor.knots().begin(), w.factor.knots().end());
    std::sort(all.begin(), all.end());
    const std::size_t n = all.size();
    for (std::size_t k = 1; k < n; k++)
      for (int j = 1; j < BETWEEN; j++)
        all.push_back(all[k - 1] + (all[k] - all[k - 1]) * j / BETWEEN);
    return all;
  }

  void add(const UsedRange &range)
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

  void plain_speed(const Batch &b, double *c) const
  {
    double k[BATCH] = {};
    for (const auto &law : laws) {
      if (!law.kernels->modulus) continue;
      if (law.part != STRENGTH || solid < 0) {
        call(law.kernels->modulus, law, b, k);
        continue;
      }
      double strong[BATCH] = {};
      call(law.kernels->modulus, law, b, strong);
      for (int i = 0; i < b.n; i++) k[i] += b.history[solid][i] * strong[i];
    }
    table->speed(b.n, rho_pressure, k, c);
    if (random_density)
      for (int i = 0; i < b.n; i++) c[i] /= std::sqrt(b.history[random_density->row][i]);
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

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

std::unique_ptr<Material> MPM_NS::compose(const MaterialDefinition &definition,
                                          const LawTable *table)
{
  return std::make_unique<ComposedMaterial>(definition, table);
}

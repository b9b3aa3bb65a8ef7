/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Composition of a material from laws: the order in which they work on a batch, what they are told
// of each other, their rows of history, and their parameters where these differ from point to point.

#include "material/material.h"

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
  std::string describe() const override { return text; }

  void initialize(const double *x, double *history) const override
  {
    for (size_t k = 0; k < variables.size(); k++) history[k] = variables[k].initial;
    if (random_density) set_factor(*random_density, DENSITY, rho, x, history);
    for (const auto &law : laws)
      for (const auto &r : law.random) {
        const LawInfo &info = *law.info;
        set_factor(r, (r.term < 0 ? info.parameters : info.term_parameters)[r.parameter],
                   r.of(law.parameters), x, history);
      }
    for (const auto &law : laws)
      if (law.varies) {
        LocalParameters local(*this, law);
        initialize(law, local.at(history, 1), x, history);
      } else if (law.info->initialize) {
        law.info->initialize(law.parameters, x, history + law.history);
      }
  }

  bool conducts() const override { return thermal && thermal->info->conduction; }
  bool conduction_varies() const override { return conducts() && !thermal->random.empty(); }
  Conduction conduction(const double *history) const override
  {
    const auto &of = thermal->info->conduction;
    if (!history || !conduction_varies()) return of(thermal->parameters);
    LocalParameters local(*this, *thermal);
    return of(local.at(history, 1));
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
    run(eos, b);
  }

  void update(Batch &b) const override
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
    run(base, b);
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
      if (law.part == VISCOSITY) run(&law, b);
    with_viscous_stress(b, [](double stress, double &added) {
      added += stress;
    });
    if (damage) table->mean_stress(b, b.viscous_mean);
    run(eos, b);
    if (damage) add_energy(eos, b, b.volume_energy);
    run(damage, b);
    run(thermal, b);
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
    plain_speed(b, c);
    for (const auto &law : laws)
      if (law.kernels->raise_speed) call(law.kernels->raise_speed, law, b, c);
  }

  void stored_energy(const Batch &state, double *w) const override
  {
    Batch copy;
    const Batch &b = without_viscous_stress(state, copy);
    for (int i = 0; i < b.n; i++) w[i] = 0.0;
    for (const auto &law : laws)
      if (!(damage && law.part == STRENGTH)) add_energy(&law, b, w);
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
  bool random_heat = false;      ///< does what the thermal part tells the others, too?
  /** First of six history variables with what viscosities added to the stress in the last step, for
   *  a closed law or strength that builds on that stress and must not see it; -1 when not needed. */
  int viscous = -1;
  std::vector<HistoryVariable> variables;
  std::vector<ValidRange> valid;
  std::vector<int> source;    ///< of the quantities of these, as in UsedRange
  std::string text;

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

    /** At the point with the values history[0], history[stride], ... of its history variables. */
    const LawParameters &at(const double *history, int stride)
    {
      replace(law, p, history, stride);
      if (const auto &r = material.random_density) {
        p.density = law.parameters.density * history[r->row * stride];
        p.heat_density = law.parameters.heat_density * history[r->row * stride];
      }
      if (material.random_heat) {
        replace(*material.thermal, heat, history, stride);
        heat.heat_density = p.heat_density;
        share_heat(*material.thermal->info, heat, law.heats_alone, p);
      }
      return p;
    }

   private:
    const ComposedMaterial &material;
    const UsedLaw &law;
    LawParameters p, heat;

    static void replace(const UsedLaw &law, LawParameters &p, const double *history, int stride)
    {
      for (const auto &r : law.random) r.of(p) = r.of(law.parameters) * history[r.row * stride];
    }
  };

  /** Update by a law, if there is one. */
  void run(const UsedLaw *law, Batch &b) const
  {
    if (law) call(law->kernels->update, *law, b);
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
      for (int k = 0; k < 6; k++) b.stress[k][i] = one.stress[k][0];
      for (const auto row : single_rows) (b.*row)[i] = (one.*row)[0];
      for (int k = 0; k < NWORK; k++) b.work[k] += one.work[k];
    });
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
    const double value = mean * history[r.row];
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

  /** What a thermal part with parameters t tells another law. With a damage all plastic work goes to
   *  batch.heat, for account_of_strength(). */
  static void share_heat(const LawInfo &info, const LawParameters &t, bool heats_alone,
                         LawParameters &p)
  {
    const double chi = info.heat_share(t), warm = info.warming(t);
    p.chi = heats_alone ? 1.0 : chi;
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
    random_heat = thermal && random_heats();
    for (auto &law : laws) {
      LawParameters &p = law.parameters;
      law.kernels = &table->kernels(law.part, law.index);
      law.heats_alone = damage && law.part == STRENGTH;
      law.varies = !law.random.empty() || random_density || random_heat;
      p.density = rho_pressure;
      p.chi = 1.0;
      p.warm = 0.0;
      p.temperature = thermal ? thermal->history : -1;
      if (thermal) share_heat(*thermal->info, thermal->parameters, law.heats_alone, p);
    }
  }

  /** Does what share_heat() tells differ from point to point? */
  bool random_heats() const
  {
    if (random_density) return true;
    const LawInfo &info = *thermal->info;
    for (const auto &r : thermal->random) {
      LawParameters p = thermal->parameters;
      r.of(p) *= 0.5;
      if (info.heat_share(p) != info.heat_share(thermal->parameters) ||
          info.warming(p) != info.warming(thermal->parameters))
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
  }

  /** density, NAME, or LAW.NAME, where LAW is the name of the part or of the closed law or, of
   *  viscosities, as there may be several, that of the law. Parameters of terms are NAME1, NAME2, ... */
  void add(const UsedRandom &random)
  {
    const std::string what = "random " + random.name;
    const auto refuse = [&](const std::string &why) {
      throw MaterialError(random.word, what + ": " + why);
    };
    UsedLaw *owner = nullptr;
    RandomParameter r = {random, -1, -1, static_cast<int>(variables.size()), nullptr};
    std::string choice = "density";
    const auto consider = [&](UsedLaw &law, int term, int k) {
      const LawInfo &info = *law.info;
      const std::string name = term < 0 ? std::string(info.parameters[k].name)
                                        : info.term_parameters[k].name + std::to_string(term + 1);
      const std::string of_part = std::string(part_name[law.part]) + "." + name;
      const std::string of_law = std::string(info.name) + "." + name;
      const bool by_law = law.part == CLOSED || law.part == VISCOSITY;
      choice += ", " + (by_law ? of_law : of_part);
      if (random.name != name && random.name != of_part && !(by_law && random.name == of_law))
        return;
      if (owner) refuse("several laws of this material have it: choose " + choice);
      owner = &law;
      r.term = term;
      r.parameter = k;
    };
    for (auto &law : laws) {
      for (int k = 0; k < law.info->nparameters; k++) consider(law, -1, k);
      for (int term = 0; term < law.parameters.nterms; term++)
        for (int k = 0; k < law.info->nterm_parameters; k++) consider(law, term, k);
    }
    const bool of_density = random.name == "density";
    if (!owner && !of_density) refuse("no such parameter: choose one of " + choice);
    const double mean = of_density ? rho : r.of(owner->parameters);
    if (mean == 0.0 || !std::isfinite(mean))
      refuse("its value is " + number(mean) +
             ", which a factor does not change: give it another one");
    bool twice = of_density && random_density;
    if (owner)
      for (const auto &other : owner->random)
        twice = twice || (other.term == r.term && other.parameter == r.parameter);
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
    for (const auto &law : laws)
      if (law.kernels->modulus) call(law.kernels->modulus, law, b, k);
    table->speed(b.n, rho_pressure, k, c);
    if (random_density)
      for (int i = 0; i < b.n; i++) c[i] /= std::sqrt(b.history[random_density->row][i]);
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

std::unique_ptr<Material> MPM_NS::compose(const MaterialDefinition &definition,
                                          const LawTable *table)
{
  return std::make_unique<ComposedMaterial>(definition, table);
}

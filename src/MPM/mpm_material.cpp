/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Composition of materials, and the parser of their definition:
//
//   density RHO
//   one closed law:      linear ... | neohookean ... | ogden ...
//   or an eos:           eos linear | shock | tait ...
//     with at most one   strength elastic | j2 | johnson/cook ...
//   any number of        viscosity newtonian | artificial | maxwell ...
//   at most one          damage ...
//   at most one          thermal adiabatic | constant ...
//   any number of        range QUANTITY LOW HIGH
//   any number of        random PARAMETER lognormal | normal COV LENGTH SEED
//
// in any order. What follows the name of a law is in the declaration of its parameters.

#include "mpm_material.h"

#include "mpm_law.h"
#include "mpm_random_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

using namespace MPM_NS;

namespace {

const char *const part_name[NPARTS] = {"", "eos", "strength", "viscosity", "damage", "thermal"};

/* ---------------------------------------------------------------------- composition */

/** A parameter that differs from point to point: its value is the mean times a factor, which is a
 *  history variable. */
struct RandomParameter {
  int parameter;    ///< in the declaration of its law
  int row;          ///< of the factor in the history of the material
  bool lognormal;
  double variation;    ///< standard deviation over mean
  std::shared_ptr<const RandomField> field;

  /** Factor with mean 1 from a standard normal deviate. */
  double factor(double g) const
  {
    if (!lognormal) return 1.0 + variation * g;
    const double s2 = std::log1p(variation * variation);
    return std::exp(std::sqrt(s2) * g - 0.5 * s2);
  }
};

/** A random parameter in a definition. */
struct UsedRandom {
  int word;    ///< of the name in the definition
  std::string name;
  bool lognormal;
  double variation, length;
  long seed;
};

/** A law with its parameters in a material. */
struct UsedLaw {
  const LawInfo *info;
  int index;    ///< in its list
  int word;     ///< of its name in the definition
  LawParameters parameters;
  int history;                  ///< first row of its history
  const LawKernels *kernels;    ///< for the instruction set that runs
  std::vector<RandomParameter> random;
};

bool in_range(const Range &range, double value)
{
  return range.closed ? value >= range.low && value <= range.high
                      : value > range.low && value < range.high;
}

std::string number(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

std::string title(Part part, const LawInfo &info)
{
  return std::string(part_name[part]) + (part == CLOSED ? "" : " ") + info.name;
}

/** A range of validity in a definition. */
struct UsedRange : ValidRange {
  int word;    ///< of its quantity in the definition
  /** How the quantity is found: one of these, or a row of history. */
  int source;
  enum { PRESSURE_OF_STRESS = -3, STRAIN_RATE = -2, DENSITY_OF_J = -1 };
};

/** Does a viscosity add to that share of the stress on which a law builds in the next step? */
bool shares_stress(const std::vector<UsedLaw> (&laws)[NPARTS])
{
  for (const Part part : {CLOSED, STRENGTH})
    for (const auto &law : laws[part])
      for (const auto &viscosity : laws[VISCOSITY])
        if (law.info->share & viscosity.info->share) return true;
  return false;
}

class ComposedMaterial : public Material {
 public:
  ComposedMaterial(double density, std::vector<UsedLaw> used[NPARTS],
                   const std::vector<UsedRange> &ranges, const std::vector<UsedRandom> &random,
                   const LawTable *table) :
      rho(density),
      table(table)
  {
    for (int part = 0; part < NPARTS; part++) laws[part] = std::move(used[part]);
    text = "density " + number(rho);
    for (int part = 0; part < NPARTS; part++)
      for (auto &law : laws[part]) add(static_cast<Part>(part), law);
    for (const auto &r : random) add(r);
    for (const auto &range : ranges) add(range);
    viscous = -1;
    if (shares_stress(laws)) {
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
  const std::vector<HistoryVariable> &history() const override { return variables; }
  std::string describe() const override { return text; }

  void initialize(const double *x, double *history) const override
  {
    for (size_t k = 0; k < variables.size(); k++) history[k] = variables[k].initial;
    for (const auto &part : laws)
      for (const auto &law : part)
        if (law.random.empty()) {
          if (law.info->initialize) law.info->initialize(law.parameters, x, history + law.history);
        } else {
          initialize_random(law, x, history);
        }
  }

  void initialized() const override
  {
    for (const auto &part : laws)
      for (const auto &law : part)
        for (const auto &r : law.random) r.field->release();
  }

  void initial_stress(Batch &b) const override
  {
    b.dt = 0.0;
    for (int i = 0; i < b.n; i++) {
      b.heat[i] = b.plastic[i] = 0.0;
      b.Jold[i] = b.J[i];
      for (auto &row : b.A) row[i] = 0.0;
    }
    table->clear_stress(b);
    for (const auto &law : laws[EOS]) call(law.kernels->update, law, b);
  }

  void update(Batch &b) const override
  {
    for (int i = 0; i < b.n; i++) b.heat[i] = b.plastic[i] = 0.0;
    for (double &w : b.work) w = 0.0;

    const auto run = [&b](const UsedLaw &law) {
      call(law.kernels->update, law, b);
    };
    if (damage) call(damage->kernels->prepare, *damage, b);
    if (viscous >= 0) take_viscous_stress(b);
    for (const auto &law : laws[VISCOSITY])
      if (law.info->uses_speed) {
        plain_speed(b, b.speed);
        break;
      }
    if (base)
      run(*base);
    else
      table->clear_stress(b);
    if (damage) account_of_strength(b);
    if (viscous >= 0) begin_viscous_stress(b);
    for (const auto &law : laws[VISCOSITY]) run(law);
    if (viscous >= 0) end_viscous_stress(b);
    if (damage) table->mean_stress(b, b.viscous_mean);
    for (const auto &law : laws[EOS]) run(law);
    if (damage) {
      add_energy(EOS, b, b.volume_energy);
      run(*damage);
    }
    for (const auto &law : laws[THERMAL]) run(law);
  }

  const std::vector<ValidRange> &ranges() const override { return valid; }

  int outside(const Batch &b, int k, double *value) const override
  {
    const double *v = value;
    switch (source[k]) {
      case UsedRange::PRESSURE_OF_STRESS:
        table->pressure(b, value);
        break;
      case UsedRange::STRAIN_RATE:
        table->strain_rate(b, value);
        break;
      case UsedRange::DENSITY_OF_J:
        for (int i = 0; i < b.n; i++) value[i] = rho / b.J[i];
        break;
      default:
        v = b.history[source[k]];
        std::copy(v, v + b.n, value);
    }
    return table->outside(b.n, v, valid[k].low, valid[k].high);
  }

  void wave_speed(const Batch &state, double *c) const override
  {
    Batch copy;
    const Batch &b = without_viscous_stress(state, copy);
    plain_speed(b, c);
    for (const auto &law : laws[VISCOSITY])
      if (law.kernels->raise_speed) call(law.kernels->raise_speed, law, b, c);
  }

  void stored_energy(const Batch &state, double *w) const override
  {
    Batch copy;
    const Batch &b = without_viscous_stress(state, copy);
    for (int i = 0; i < b.n; i++) w[i] = 0.0;
    for (int part = 0; part < NPARTS; part++)
      if (!damage || part != STRENGTH) add_energy(static_cast<Part>(part), b, w);
  }

 private:
  double rho;
  double rho_pressure;    ///< density in units of pressure over velocity^2, as the laws need it
  const LawTable *table;
  std::vector<UsedLaw> laws[NPARTS];
  const UsedLaw *base;      ///< closed law or strength, or null
  const UsedLaw *damage;    ///< or null
  /** First of six history variables with what viscosities added to the stress in the last step, for
   *  a closed law or strength that builds on that stress and must not see it; -1 when not needed. */
  int viscous;
  std::vector<HistoryVariable> variables;
  std::vector<ValidRange> valid;
  std::vector<int> source;    ///< of the quantities of these, as in UsedRange
  std::string text;

  void take_viscous_stress(Batch &b) const
  {
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < b.n; i++) b.stress[k][i] -= b.history[viscous + k][i];
  }

  // around the viscosities: stress after them minus stress before them
  void begin_viscous_stress(Batch &b) const
  {
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < b.n; i++) b.history[viscous + k][i] = -b.stress[k][i];
  }

  void end_viscous_stress(Batch &b) const
  {
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < b.n; i++) b.history[viscous + k][i] += b.stress[k][i];
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

  /** A kernel that changes a batch. */
  static void call(void (*kernel)(const LawParameters &, Batch &, History), const UsedLaw &law,
                   Batch &b)
  {
    if (law.random.empty()) {
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
  static void call(void (*kernel)(const LawParameters &, const Batch &, History, double *),
                   const UsedLaw &law, const Batch &b, double *value)
  {
    if (law.random.empty())
      kernel(law.parameters, b, rows(b, law), value);
    else
      one_by_one(law, b, [&](const LawParameters &p, const Batch &one, History history, int i) {
        kernel(p, one, history, value + i);
      });
  }

  /** Calls work for each point in a batch of its own, with its own parameters. The history is not
   *  copied: its rows are those of the batch, beginning with the point. */
  template <class Work> static void one_by_one(const UsedLaw &law, const Batch &b, Work work)
  {
    Batch one;
    one.n = 1;
    one.dt = b.dt;
    one.h = b.h;
    one.time = b.time;
    LawParameters p = law.parameters;
    for (int i = 0; i < b.n; i++) {
      for (const auto &r : law.random)
        p.value[r.parameter] = law.parameters.value[r.parameter] * b.history[r.row][i];
      for (int k = 0; k < 9; k++) one.A[k][0] = b.A[k][i];
      for (int k = 0; k < 9; k++) one.F[k][0] = b.F[k][i];
      for (int k = 0; k < 6; k++) one.stress[k][0] = b.stress[k][i];
      for (double &w : one.work) w = 0.0;
      for (const auto row : single_rows) (one.*row)[0] = (b.*row)[i];
      one.history = reinterpret_cast<History>(&b.history[0][i]);
      work(p, one, one.history + law.history, i);
    }
  }

  /** Factors of a new point, and the history of its law, which may depend on the parameters. */
  static void initialize_random(const UsedLaw &law, const double *x, double *history)
  {
    LawParameters p = law.parameters;
    for (const auto &r : law.random) {
      const double factor = history[r.row] = r.factor(r.field->value(x));
      const Parameter &declared = law.info->parameters[r.parameter];
      p.value[r.parameter] *= factor;
      if (!in_range(declared.range, p.value[r.parameter]))
        throw std::runtime_error(std::string("random ") + declared.name + " is " +
                                 number(p.value[r.parameter]) +
                                 " at a point, which is out of range: use lognormal, or a smaller "
                                 "coefficient of variation");
    }
    if (const char *wrong = law.info->check(p))
      throw std::runtime_error(std::string("with the random parameters of a point, ") +
                               law.info->name + ": " + wrong);
    for (int k = 0; k < law.info->nhistory(p); k++)
      if (law.info->history[k].initial >= 0)
        history[law.history + k] = p.value[law.info->history[k].initial];
    if (law.info->initialize) law.info->initialize(p, x, history + law.history);
  }

  /** Kernels of all parts, and what they are told of each other. */
  void bind(double pressure_scale, double energy_scale)
  {
    rho_pressure = rho * pressure_scale;
    base = nullptr;
    for (const Part part : {CLOSED, STRENGTH})
      if (!laws[part].empty()) base = laws[part].data();
    damage = laws[DAMAGE].empty() ? nullptr : laws[DAMAGE].data();

    LawParameters shared;
    shared.chi = 1.0;
    shared.warm = 0.0;
    shared.temperature = -1;
    for (auto &law : laws[THERMAL]) {
      law.parameters.heat_density = rho * energy_scale;
      shared.chi = law.info->heat_share(law.parameters);
      shared.warm = law.info->warming(law.parameters);
      shared.temperature = law.history;
    }
    for (int part = 0; part < NPARTS; part++)
      for (auto &law : laws[part]) {
        law.kernels = &table->kernels(static_cast<Part>(part), law.index);
        law.parameters.density = rho_pressure;
        law.parameters.heat_density = rho * energy_scale;
        law.parameters.chi = shared.chi;
        law.parameters.warm = shared.warm;
        law.parameters.temperature = shared.temperature;
        // with a damage all plastic work goes to batch.heat, for account_of_strength()
        if (damage && part == STRENGTH) {
          law.parameters.chi = 1.0;
          law.parameters.warm *= shared.chi;
        }
      }
  }

  /** Energy stored by one part, added to w. */
  void add_energy(Part part, const Batch &b, double *w) const
  {
    for (const auto &law : laws[part])
      if (law.kernels->energy) call(law.kernels->energy, law, b, w);
  }

  /** What the strength has done, for a damage; heat that the equation of state shall have. */
  void account_of_strength(Batch &b) const
  {
    for (int i = 0; i < b.n; i++) {
      b.plastic_work[i] = b.heat[i];
      b.heat[i] *= damage->parameters.chi * b.kept[i];
      b.shear_energy[i] = b.volume_energy[i] = 0.0;
    }
    add_energy(STRENGTH, b, b.shear_energy);
  }

  void add(Part part, UsedLaw &law)
  {
    const LawInfo &info = *law.info;
    const LawParameters &p = law.parameters;
    law.history = variables.size();
    const auto declare = [&](const HistoryDeclaration &h, const std::string &suffix) {
      const double initial = h.initial >= 0 ? p.value[h.initial] : h.initial == ONE ? 1.0 : 0.0;
      variables.push_back({h.name + suffix, initial});
    };
    for (int k = 0; k < info.nhistory(p); k++) declare(info.history[k], "");
    for (int term = 0; term < p.nterms; term++)
      for (int k = 0; k < info.nterm_history; k++)
        declare(info.term_history[k], std::to_string(term + 1));

    text += ", " + title(part, info);
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

  /** NAME or LAW.NAME, where LAW is the name of the part or of the closed law. */
  void add(const UsedRandom &random)
  {
    const std::string what = "random " + random.name;
    UsedLaw *owner = nullptr;
    int parameter = -1;
    std::string choice;
    for (int part = 0; part < NPARTS; part++)
      for (auto &law : laws[part])
        for (int k = 0; k < law.info->nparameters && part != THERMAL; k++) {
          const std::string name = law.info->parameters[k].name;
          const std::string full =
              std::string(part == CLOSED ? law.info->name : part_name[part]) + "." + name;
          choice += (choice.empty() ? "" : ", ") + full;
          if (random.name != name && random.name != full) continue;
          if (owner)
            throw MaterialError(random.word,
                                what +
                                    ": several laws of this material have it: "
                                    "choose " +
                                    choice);
          owner = &law;
          parameter = k;
        }
    if (!owner)
      throw MaterialError(random.word, what + ": no such parameter: choose one of " + choice);
    const double mean = owner->parameters.value[parameter];
    if (mean == 0.0 || !std::isfinite(mean))
      throw MaterialError(random.word,
                          what + ": its value is " + number(mean) +
                              ", which a factor does not change: give it another one");
    for (const auto &other : owner->random)
      if (other.parameter == parameter) throw MaterialError(random.word, what + ": is given twice");
    RandomParameter r;
    r.parameter = parameter;
    r.row = variables.size();
    r.lognormal = random.lognormal;
    r.variation = random.variation;
    r.field = std::make_shared<const RandomField>(random.length, random.seed);
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
    for (const auto &part : laws)
      for (const auto &law : part)
        if (law.kernels->modulus) call(law.kernels->modulus, law, b, k);
    table->speed(b.n, rho_pressure, k, c);
  }
};

/* ---------------------------------------------------------------------- parser */

bool looks_numeric(const std::string &word)
{
  return !word.empty() && strchr("+-.0123456789", word[0]) != nullptr;
}

/** Words separated by blanks. */
std::vector<std::string> split(const std::string &text)
{
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ' ')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

std::string join(const std::vector<std::string> &words, const char *between)
{
  std::string text;
  for (const auto &word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> names(const LawList &laws)
{
  std::vector<std::string> list;
  for (const auto &info : laws) list.emplace_back(info.name);
  return list;
}

int find(const LawList &laws, const std::string &name)
{
  for (size_t k = 0; k < laws.size(); k++)
    if (name == laws[k].name) return k;
  return -1;
}

std::string describe_range(const Range &range)
{
  const std::string less = range.closed ? " <= " : " < ";
  std::string text = "VALUE";
  if (range.low != -UNBOUNDED) text = number(range.low) + less + text;
  if (range.high != UNBOUNDED) text += less + number(range.high);
  return text;
}

class Parser {
 public:
  Parser(const std::vector<std::string> &words, const char *isa) : words(words), next(0), isa(isa)
  {
  }

  std::unique_ptr<Material> parse()
  {
    while (!at_end()) {
      const int here = next;
      const std::string keyword = words[next++];
      if (keyword == "density")
        parse_density(here);
      else if (keyword == "range")
        parse_range();
      else if (keyword == "random")
        parse_random(here);
      else if (find(declared_laws(CLOSED), keyword) >= 0)
        parse_law(CLOSED, here);
      else if (const int part = find_part(keyword))
        parse_law(static_cast<Part>(part), next++);
      else
        fail(here,
             "unknown keyword '" + keyword + "': expected density, " +
                 join(names(declared_laws(CLOSED)), ", ") +
                 ", eos, strength, viscosity, damage, thermal, range or random");
    }
    check();
    const LawTable *table = LawTable::select(isa);
    if (!table) {
      const char *name = isa ? isa : getenv("MPM_ISA");
      fail(0,
           std::string("MPM_ISA=") + (name ? name : "") +
               ": not one of reference, baseline, avx2, avx512, or this CPU cannot run it");
    }
    return std::unique_ptr<Material>(new ComposedMaterial(density, used, ranges, random, table));
  }

 private:
  const std::vector<std::string> &words;
  int next;
  const char *isa;
  double density = 0.0;
  std::vector<UsedLaw> used[NPARTS];
  std::vector<UsedRange> ranges;
  std::vector<UsedRandom> random;

  bool at_end() const { return next >= static_cast<int>(words.size()); }

  /** The part that a keyword introduces, 0 (closed laws have no such keyword): none. */
  static int find_part(const std::string &keyword)
  {
    for (int part = NPARTS - 1; part > 0; part--)
      if (keyword == part_name[part]) return part;
    return 0;
  }

  [[noreturn]] static void fail(int word, const std::string &message)
  {
    throw MaterialError(word, message);
  }

  /** The next word as a number in a range; what: the name of its owner. */
  double parse_number(const std::string &what, const char *name, const char *unit,
                      const char *meaning, const Range &range)
  {
    const std::string full = what + ": " + name;
    if (at_end()) fail(next, full + " is missing (" + meaning + ")");
    const std::string &word = words[next];
    char *end = nullptr;
    const double value = strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(value))
      fail(next, full + " must be a number (" + meaning + ", " + unit + "), not '" + word + "'");
    if (!in_range(range, value))
      fail(next,
           full + " = " + word + " (" + meaning + ") is out of range: " + describe_range(range));
    next++;
    return value;
  }

  void parse_density(int here)
  {
    if (density > 0.0) fail(here, "density is given twice");
    density = parse_number("density", "RHO", "density", "reference density", POSITIVE);
  }

  /** range QUANTITY LOW HIGH, where LOW may be -INF and HIGH may be INF */
  void parse_range()
  {
    UsedRange range;
    range.word = next;
    if (at_end()) fail(next, "range: name of the quantity is missing");
    range.quantity = words[next++];
    const std::string what = "range " + range.quantity;
    const auto limit = [&](const char *name, const char *infinite, double value) {
      if (at_end() || words[next] != infinite)
        return parse_number(what, name, "units of the quantity", "limit of validity, or INF",
                            {-UNBOUNDED, UNBOUNDED, false});
      next++;
      return value;
    };
    range.low = limit("LOW", "-INF", -UNBOUNDED);
    range.high = limit("HIGH", "INF", UNBOUNDED);
    if (!(range.low < range.high)) fail(next - 1, what + ": LOW must be less than HIGH");
    ranges.push_back(range);
  }

  /** random PARAMETER lognormal | normal COV LENGTH SEED */
  void parse_random(int here)
  {
    if (!RandomField::available())
      fail(
          here,
          "random: this program was built without FFTW; install it (libfftw3-dev) and build again");
    UsedRandom r;
    r.word = next;
    if (at_end()) fail(next, "random: name of the parameter is missing");
    r.name = words[next++];
    const std::string what = "random " + r.name;
    if (at_end() || (words[next] != "lognormal" && words[next] != "normal"))
      fail(next, what + ": the distribution must be lognormal or normal");
    r.lognormal = words[next++] == "lognormal";
    r.variation = parse_number(what, "COV", "1", "coefficient of variation", POSITIVE);
    r.length = parse_number(what, "LENGTH", "length", "correlation length", POSITIVE);
    const double seed = parse_number(what, "SEED", "1", "seed", {1.0, 2147483647.0, true});
    r.seed = static_cast<long>(seed);
    if (r.seed != seed) fail(next - 1, what + ": SEED must be an integer");
    random.push_back(r);
  }

  /** here: word of the law's name; next is behind it. */
  void parse_law(Part part, int here)
  {
    const auto &laws = declared_laws(part);
    const std::string choice = "choose " + join(names(laws), ", ");
    if (here >= static_cast<int>(words.size()))
      fail(here, std::string(part_name[part]) + ": name is missing, " + choice);
    UsedLaw law;
    law.index = find(laws, words[here]);
    law.word = here;
    if (law.index < 0)
      fail(here, std::string("unknown ") + part_name[part] + " '" + words[here] + "': " + choice);
    law.info = &laws[law.index];
    if (part != VISCOSITY && !used[part].empty())
      fail(here,
           "'" + title(part, *law.info) + "': the material has '" +
               title(part, *used[part][0].info) + "' already");
    for (const auto &other : used[part])
      if (other.index == law.index) fail(here, "'" + title(part, *law.info) + "' is given twice");
    parse_parameters(title(part, *law.info), *law.info, law.parameters);
    const char *wrong = law.info->check(law.parameters);
    if (wrong) fail(here, title(part, *law.info) + ": " + wrong);
    used[part].push_back(law);
  }

  void parse_parameters(const std::string &what, const LawInfo &info, LawParameters &parameters)
  {
    double *const value = parameters.value;
    parameters.nterms = 0;
    for (int k = 0; k < info.nparameters; k++) value[k] = info.parameters[k].standard;

    bool tail = true;    // read the positional parameters that have a default?
    bool first = true;
    for (int k = 0; k < info.nparameters; k++) {
      const Parameter &p = info.parameters[k];
      if (*p.option) continue;
      if (!std::isnan(p.standard) && first) {
        first = false;
        tail = !at_end() && looks_numeric(words[next]);
      }
      if (tail) value[k] = parse_number(what, p.name, p.unit, p.meaning, p.range);
    }

    std::vector<std::string> given;    // first words of the options so far
    while (!at_end() &&
           (parse_term(what, info, parameters) || parse_option(what, info, value, given))) {}
    if (!at_end() && looks_numeric(words[next]))
      fail(next, what + ": too many values, '" + words[next] + "' is not expected");
  }

  /** Reads the option of the law that may be given several times, false when the next word is not
   *  that. */
  bool parse_term(const std::string &what, const LawInfo &info, LawParameters &parameters)
  {
    if (!info.term || words[next] != info.term) return false;
    if (parameters.nterms == LawParameters::MAX_TERMS)
      fail(next,
           what + ": more than " + std::to_string(LawParameters::MAX_TERMS) + " of '" + info.term +
               "'");
    next++;
    double *const term = parameters.term[parameters.nterms++];
    for (int k = 0; k < info.nterm_parameters; k++) {
      const Parameter &p = info.term_parameters[k];
      term[k] = parse_number(what + " " + info.term, p.name, p.unit, p.meaning, p.range);
    }
    return true;
  }

  /** Reads one option of the law, false when the next word is none. */
  bool parse_option(const std::string &what, const LawInfo &info, double *value,
                    std::vector<std::string> &given)
  {
    const int here = next;
    std::vector<std::string> choices;
    int match = -1;
    for (int k = 0; k < info.nparameters; k++) {
      if (!*info.parameters[k].option) continue;
      const auto option = split(info.parameters[k].option);
      if (option[0] != words[here]) continue;
      if (option.size() == 1) {
        if (match < 0) match = k;
      } else {
        if (choices.empty() || choices.back() != option[1]) choices.push_back(option[1]);
        if (here + 1 < static_cast<int>(words.size()) && option[1] == words[here + 1] && match < 0)
          match = k;
      }
    }
    if (match < 0 && choices.empty()) return false;
    if (match < 0)
      fail(here + 1, what + ": '" + words[here] + "' must be followed by " + join(choices, " or "));
    for (const auto &word : given)
      if (word == words[here]) fail(here, what + ": '" + words[here] + "' is given twice");
    given.push_back(words[here]);

    const char *option = info.parameters[match].option;
    next += split(option).size();
    for (int k = match; k < info.nparameters; k++) {
      const Parameter &p = info.parameters[k];
      if (!strcmp(p.option, option) && !strcmp(p.unit, FLAG))
        value[k] = 1.0;
      else if (!strcmp(p.option, option))
        value[k] = parse_number(what + " " + option, p.name, p.unit, p.meaning, p.range);
    }
    return true;
  }

  /** Parts that do not go together. */
  void check() const
  {
    const int end = words.size();
    if (density <= 0.0) fail(end, "density is missing: add 'density RHO'");
    if (!used[CLOSED].empty()) {
      const std::string name = used[CLOSED][0].info->name;
      for (const Part part : {EOS, STRENGTH, DAMAGE})
        if (!used[part].empty())
          fail(used[part][0].word,
               "'" + title(part, *used[part][0].info) + "': '" + name +
                   "' is a complete law; use either '" + name + "' or eos and strength");
    } else if (used[EOS].empty()) {
      if (!used[STRENGTH].empty())
        fail(used[STRENGTH][0].word,
             "'" + title(STRENGTH, *used[STRENGTH][0].info) +
                 "' makes the stress deviator only: add an equation of state, such as "
                 "'eos linear K' with the bulk modulus");
      fail(end,
           "no law: add " + join(names(declared_laws(CLOSED)), ", ") +
               ", or eos with strength or viscosity");
    }
    if (!used[DAMAGE].empty() && used[STRENGTH].empty())
      fail(used[DAMAGE][0].word,
           "'" + title(DAMAGE, *used[DAMAGE][0].info) +
               "' reduces the stress of a solid: add a strength, such as 'strength elastic G'");
    for (const auto &part : used)
      for (const auto &law : part)
        if (law.info->needs_temperature(law.parameters) && used[THERMAL].empty())
          fail(law.word,
               std::string("'") + law.info->name +
                   "' with these parameters depends on the temperature: add 'thermal adiabatic' "
                   "with the specific heat, or 'thermal constant'");
    if (!used[DAMAGE].empty() && shares_stress(used))
      fail(used[DAMAGE][0].word,
           "'" + title(DAMAGE, *used[DAMAGE][0].info) +
               "' does not go with a viscosity that adds to the stress on which a strength or law "
               "builds in the next step: leave out the viscosity, or use viscosity artificial with "
               "eos and strength");
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

std::unique_ptr<Material> Material::create(const std::vector<std::string> &words, const char *isa)
{
  return Parser(words, isa).parse();
}

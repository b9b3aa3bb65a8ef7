/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Composition of materials, and the parser of their definition:
//
//   density RHO
//   one closed law:      linear ... | neohookean ...
//   or an eos:           eos linear | shock | tait ...
//     with at most one   strength elastic | j2 | johnson/cook ...
//   any number of        viscosity newtonian | artificial ...
//
// in any order. What follows the name of a law is in the declaration of its parameters.

#include "mpm_material.h"

#include "mpm_law_list.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace MPM_NS;

namespace {

/* ---------------------------------------------------------------------- declarations */

template <class Law> LawInfo declaration()
{
  LawInfo info;
  info.name = Law::name;
  info.meaning = Law::meaning;
  info.share = Law::share;
  info.parameters = Law::parameters;
  info.nparameters = sizeof(Law::parameters) / sizeof(Parameter);
  info.history = Law::history;
  info.nhistory = Law::nhistory;
  info.check = Law::check;
  static_assert(sizeof(Law::parameters) / sizeof(Parameter) <= LawParameters::MAX);
  return info;
}

template <class... Laws> std::vector<LawInfo> declarations(law::List<Laws...>)
{
  return {declaration<Laws>()...};
}

const char *const part_name[NPARTS] = {"", "eos", "strength", "viscosity"};

/* ---------------------------------------------------------------------- composition */

/** A law with its parameters in a material. */
struct UsedLaw {
  const LawInfo *info;
  int index;    ///< in its list
  int word;     ///< of its name in the definition
  LawParameters parameters;
  int history;    ///< first row of its history
};

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

class ComposedMaterial : public Material {
 public:
  ComposedMaterial(double density, std::vector<UsedLaw> used[NPARTS], const LawTable *table) :
      rho(density), rho_pressure(density), table(table), base(nullptr), eos(nullptr)
  {
    for (int part = 0; part < NPARTS; part++) laws[part] = std::move(used[part]);
    text = "density " + number(rho);
    for (int part = 0; part < NPARTS; part++)
      for (auto &law : laws[part]) add(static_cast<Part>(part), law);
  }

  bool configure(const char *isa, double pressure_scale) override
  {
    const LawTable *wanted = LawTable::select(isa);
    if (!wanted) return false;
    table = wanted;
    rho_pressure = rho * pressure_scale;
    for (int part = 0; part < NPARTS; part++)
      for (auto &law : laws[part]) bind(static_cast<Part>(part), law);
    return true;
  }

  double density() const override { return rho; }
  const std::vector<HistoryVariable> &history() const override { return variables; }
  std::string describe() const override { return text; }

  void update(Batch &b) const override
  {
    double heat[BATCH] = {};
    alignas(64) double c[BATCH];
    for (double &w : b.work) w = 0.0;
    if (!laws[VISCOSITY].empty()) plain_speed(b, c);

    if (base)
      base->update(base_law().parameters, b, rows(b, base_law()), heat);
    else
      table->clear_stress(b);
    for (const auto &law : laws[VISCOSITY])
      table->viscosity[law.index].update(law.parameters, b, c, heat);
    if (eos) eos->update(laws[EOS][0].parameters, b, rows(b, laws[EOS][0]), heat);
  }

  void wave_speed(const Batch &b, double *c) const override
  {
    plain_speed(b, c);
    for (const auto &law : laws[VISCOSITY])
      table->viscosity[law.index].raise_speed(law.parameters, b, c);
  }

  void stored_energy(const Batch &b, double *w) const override
  {
    for (int i = 0; i < b.n; i++) w[i] = 0.0;
    if (base) base->energy(base_law().parameters, b, rows(b, base_law()), w);
    if (eos) eos->energy(laws[EOS][0].parameters, b, rows(b, laws[EOS][0]), w);
  }

 private:
  double rho;
  double rho_pressure;    ///< density in units of pressure over velocity^2, as the laws need it
  const LawTable *table;
  std::vector<UsedLaw> laws[NPARTS];
  const LawKernels *base;    ///< closed law or strength, or null
  const LawKernels *eos;     ///< or null
  std::vector<HistoryVariable> variables;
  std::string text;

  const UsedLaw &base_law() const
  {
    return laws[CLOSED].empty() ? laws[STRENGTH][0] : laws[CLOSED][0];
  }
  static History rows(const Batch &b, const UsedLaw &law)
  {
    return b.history ? b.history + law.history : nullptr;
  }

  void bind(Part part, UsedLaw &law)
  {
    if (part == CLOSED) base = table->closed + law.index;
    if (part == STRENGTH) base = table->strength + law.index;
    if (part == EOS) eos = table->eos + law.index;
    law.parameters.density = rho_pressure;
  }

  void add(Part part, UsedLaw &law)
  {
    const LawInfo &info = *law.info;
    const double *value = law.parameters.value;
    bind(part, law);
    law.history = variables.size();
    for (int k = 0; k < info.nhistory(value); k++) {
      const int initial = info.history[k].initial;
      variables.push_back({info.history[k].name, initial < 0 ? 0.0 : value[initial]});
    }

    text += ", " + title(part, info);
    for (int k = 0; k < info.nparameters; k++)
      if (value[k] != info.parameters[k].standard)
        text += std::string(" ") + info.parameters[k].name + "=" + number(value[k]);
  }

  void plain_speed(const Batch &b, double *c) const
  {
    double k[BATCH] = {};
    if (base) base->modulus(base_law().parameters, b, rows(b, base_law()), k);
    if (eos) eos->modulus(laws[EOS][0].parameters, b, rows(b, laws[EOS][0]), k);
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

std::vector<std::string> names(const std::vector<LawInfo> &laws)
{
  std::vector<std::string> list;
  for (const auto &info : laws) list.emplace_back(info.name);
  return list;
}

int find(const std::vector<LawInfo> &laws, const std::string &name)
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
      else if (find(declared_laws(CLOSED), keyword) >= 0)
        parse_law(CLOSED, here);
      else if (keyword == "eos")
        parse_law(EOS, next++);
      else if (keyword == "strength")
        parse_law(STRENGTH, next++);
      else if (keyword == "viscosity")
        parse_law(VISCOSITY, next++);
      else
        fail(here,
             "unknown keyword '" + keyword + "': expected density, " +
                 join(names(declared_laws(CLOSED)), ", ") + ", eos, strength or viscosity");
    }
    check();
    const LawTable *table = LawTable::select(isa);
    if (!table) {
      const char *name = isa ? isa : getenv("MPM_ISA");
      fail(0,
           std::string("MPM_ISA=") + (name ? name : "") +
               ": not one of reference, baseline, avx2, avx512, or this CPU cannot run it");
    }
    return std::unique_ptr<Material>(new ComposedMaterial(density, used, table));
  }

 private:
  const std::vector<std::string> &words;
  int next;
  const char *isa;
  double density = 0.0;
  std::vector<UsedLaw> used[NPARTS];

  bool at_end() const { return next >= static_cast<int>(words.size()); }

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
    const bool above = range.closed ? value >= range.low : value > range.low;
    const bool below = range.closed ? value <= range.high : value < range.high;
    if (!above || !below)
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
    parse_parameters(title(part, *law.info), *law.info, law.parameters.value);
    const char *wrong = law.info->check(law.parameters.value);
    if (wrong) fail(here, title(part, *law.info) + ": " + wrong);
    used[part].push_back(law);
  }

  void parse_parameters(const std::string &what, const LawInfo &info, double *value)
  {
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
    while (!at_end() && parse_option(what, info, value, given)) {}
    if (!at_end() && looks_numeric(words[next]))
      fail(next, what + ": too many values, '" + words[next] + "' is not expected");
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
        match = k;
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
      if (!strcmp(p.option, option))
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
      for (const Part part : {EOS, STRENGTH})
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
    for (const Part part : {CLOSED, STRENGTH})
      for (const auto &law : used[part])
        for (const auto &viscosity : used[VISCOSITY])
          if (law.info->share & viscosity.info->share)
            fail(viscosity.word,
                 "'" + title(VISCOSITY, *viscosity.info) + "' does not go with '" +
                     title(part, *law.info) + "', which builds on the last step's stress" +
                     (part == CLOSED ? ": use eos and strength elastic instead" : ""));
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

const std::vector<LawInfo> &MPM_NS::declared_laws(Part part)
{
  using namespace law;
  static const std::vector<LawInfo> laws[NPARTS] = {
      declarations(ClosedLaws()), declarations(EosLaws()), declarations(StrengthLaws()),
      declarations(ViscosityLaws())};
  return laws[part];
}

std::unique_ptr<Material> Material::create(const std::vector<std::string> &words, const char *isa)
{
  return Parser(words, isa).parse();
}

/* ----------------------------------------------------------------------
   the transfer kernels decide which instruction set runs
------------------------------------------------------------------------- */

namespace MPM_NS {
const LawTable *mpm_laws_base();
const LawTable *mpm_laws_v3();
const LawTable *mpm_laws_v4();
}    // namespace MPM_NS

const LawTable *LawTable::select(const char *isa)
{
  const MPMKernels *chosen = MPMKernels::select(isa);
  if (!chosen) return nullptr;
#ifdef MPM_HAVE_V4
  if (strcmp(chosen->isa, "AVX-512") == 0) return mpm_laws_v4();
#endif
#ifdef MPM_HAVE_V3
  if (strcmp(chosen->isa, "AVX2") == 0) return mpm_laws_v3();
#endif
  return mpm_laws_base();
}

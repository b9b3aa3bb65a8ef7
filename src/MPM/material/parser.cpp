/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Parser of the definition of a material:
//
//   density RHO
//   one closed law:      linear ... | neohookean ... | ogden ...
//   or an eos:           eos linear | shock | tait ...
//     with at most one   strength elastic | j2 | johnson/cook ...
//   any number of        viscosity newtonian | artificial | maxwell ... [liquid]
//   at most one          damage ...
//   at most one          thermal adiabatic | conducting | constant ...
//   any number of        range QUANTITY LOW HIGH
//   any number of        random PARAMETER lognormal | normal COV LENGTH SEED
//   any number of        vary PARAMETER table T F ... | linear | ... (see TemperatureFactor)
//
// in any order. What follows the name of a law is in the declaration of its parameters.

#include "material/parts.h"
#include "material/random_field.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <set>
#include <sstream>

using namespace MPM_NS;

namespace {

bool looks_numeric(const std::string &word)
{
  return !word.empty() && strchr("+-.0123456789", word[0]) != nullptr;
}

/** Words separated by blanks. */
std::vector<std::string> split(const std::string &text)
{
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
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
      // closed laws have no keyword in front of their name
      const int part = std::find(part_name + 1, part_name + NPARTS, keyword) - part_name;
      if (keyword == "density")
        parse_density(here);
      else if (keyword == "range")
        parse_range();
      else if (keyword == "random")
        parse_random(here);
      else if (keyword == "vary")
        parse_vary();
      else if (find(declared_laws(CLOSED), keyword) >= 0)
        parse_law(CLOSED, here);
      else if (part < NPARTS)
        parse_law(static_cast<Part>(part), next++);
      else
        fail(here,
             "unknown keyword '" + keyword + "': expected density, " +
                 join(names(declared_laws(CLOSED)), ", ") +
                 ", eos, strength, viscosity, damage, thermal, range, random or vary");
    }
    check();
    const LawTable *table = LawTable::select(isa);
    if (!table) {
      const char *name = isa ? isa : getenv("MPM_ISA");
      fail(0,
           std::string("MPM_ISA=") + (name ? name : "") +
               ": not one of reference, baseline, avx2, avx512, or this CPU cannot run it");
    }
    return compose(material, table);
  }

 private:
  const std::vector<std::string> &words;
  int next;
  const char *isa;
  MaterialDefinition material;

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
    if (!range.contains(value))
      fail(next,
           full + " = " + word + " (" + meaning + ") is out of range: " + describe_range(range));
    next++;
    return value;
  }

  void parse_density(int here)
  {
    if (material.density > 0.0) fail(here, "density is given twice");
    material.density = parse_number("density", "RHO", "density", "reference density", POSITIVE);
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
    material.ranges.push_back(range);
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
    material.random.push_back(r);
  }

  /** vary PARAMETER table T1 F1 T2 F2 ... | FORMULA C TREF LOW HIGH */
  void parse_vary()
  {
    static const char *const formulas[] = {"linear", "power", "exponential", "arrhenius"};
    const int word = next;
    if (at_end()) fail(next, "vary: name of the parameter is missing");
    const std::string name = words[next++], what = "vary " + name;
    const int from = next;
    const std::string kind = at_end() ? "" : words[next++];
    const auto number_of = [&](const char *symbol, const char *unit, const char *meaning) {
      return parse_number(what + " " + kind, symbol, unit, meaning, {-UNBOUNDED, UNBOUNDED, false});
    };
    const auto text = [&]() {
      std::string text;
      for (int k = from; k < next; k++) text += " " + words[k];
      return text;
    };
    if (kind == "table") {
      std::vector<double> T, factor;
      while (T.size() < 2 || (!at_end() && looks_numeric(words[next]))) {
        T.push_back(number_of("T", "temperature", "temperature of an entry of the table"));
        if (T.size() > 1 && !(T.back() > T[T.size() - 2]))
          fail(next - 1, what + ": the temperatures of a table must increase");
        factor.push_back(number_of("F", "1", "factor of the parameter at this temperature"));
      }
      const TemperatureFactor table(T, factor);
      material.vary.push_back({word, name, text(), table});
      return;
    }
    const auto *const formula = std::find(std::begin(formulas), std::end(formulas), kind);
    if (formula == std::end(formulas))
      fail(from, what + ": expected table, linear, power, exponential or arrhenius");
    const auto index = static_cast<TemperatureFactor::Formula>(formula - formulas);
    const bool absolute = index == TemperatureFactor::POWER ||
        index == TemperatureFactor::ARRHENIUS;
    static const char *const units[] = {"1/temperature", "1", "1/temperature", "temperature"};
    const double c = number_of("C", units[index], "coefficient of the formula");
    const int behind = next;
    const double reference = number_of("TREF", "temperature", "temperature at which it is one");
    const double low = number_of("TLOW", "temperature", "lower limit of the formula");
    const double high = number_of("THIGH", "temperature", "upper limit of the formula");
    if (!(low < high)) fail(next - 1, what + ": TLOW must be less than THIGH");
    if (absolute && !(reference > 0.0 && low > 0.0))
      fail(behind, what + ": " + kind + " needs absolute temperatures: TREF and TLOW above zero");
    material.vary.push_back(
        {word, name, text(), TemperatureFactor(index, c, reference, low, high)});
  }

  /** here: word of the law's name; next is behind it. */
  void parse_law(Part part, int here)
  {
    const auto &laws = declared_laws(part);
    const std::string choice = "choose " + join(names(laws), ", ");
    if (here >= static_cast<int>(words.size()))
      fail(here, std::string(part_name[part]) + ": name is missing, " + choice);
    UsedLaw law;
    law.part = part;
    law.index = find(laws, words[here]);
    law.word = here;
    if (law.index < 0)
      fail(here, std::string("unknown ") + part_name[part] + " '" + words[here] + "': " + choice);
    law.info = &laws[law.index];
    if (part != VISCOSITY && !material.laws[part].empty())
      fail(here,
           "'" + title(law) + "': the material has '" + title(material.laws[part][0]) +
               "' already");
    for (const auto &other : material.laws[part])
      if (other.index == law.index) fail(here, "'" + title(law) + "' is given twice");
    parse_parameters(title(law), *law.info, law.parameters);
    if (part == VISCOSITY && !at_end() && words[next] == "liquid") {
      law.liquid = true;
      if (law.info->nterm_history > 0)
        fail(next, title(law) + ": a melt forgets: use another viscosity for the liquid");
      next++;
    }
    const char *wrong = law.info->check(law.parameters);
    if (wrong) fail(here, title(law) + ": " + wrong);
    material.laws[part].push_back(law);
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

    std::set<std::string> given;    // first words of the options so far
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
                    std::set<std::string> &given)
  {
    const int here = next;
    std::vector<std::string> choices;
    int match = -1, length = 0;
    for (int k = 0; k < info.nparameters; k++) {
      if (!*info.parameters[k].option) continue;
      const auto option = split(info.parameters[k].option);
      if (option[0] != words[here]) continue;
      const bool fits = option.size() == 1 ||
          (here + 1 < static_cast<int>(words.size()) && option[1] == words[here + 1]);
      if (fits && static_cast<int>(option.size()) > length) {
        match = k;
        length = option.size();
      }
      if (option.size() > 1 && (choices.empty() || choices.back() != option[1]))
        choices.push_back(option[1]);
    }
    if (match < 0 && choices.empty()) return false;
    if (match < 0)
      fail(here + 1, what + ": '" + words[here] + "' must be followed by " + join(choices, " or "));
    if (!given.insert(words[here]).second)
      fail(here, what + ": '" + words[here] + "' is given twice");

    const char *option = info.parameters[match].option;
    next += split(option).size();
    for (int k = match; k < info.nparameters; k++) {
      const Parameter &p = info.parameters[k];
      if (strcmp(p.option, option) != 0) continue;
      const bool flag = !strcmp(p.unit, FLAG);
      value[k] = flag ? 1.0 : parse_number(what + " " + option, p.name, p.unit, p.meaning, p.range);
    }
    return true;
  }

  /** Was an option of the law given a value of its own? */
  static bool has_option(const UsedLaw &law, const char *option)
  {
    for (int k = 0; k < law.info->nparameters; k++) {
      const Parameter &p = law.info->parameters[k];
      if (!strcmp(p.option, option) && law.parameters.value[k] != p.standard) return true;
    }
    return false;
  }

  /** Parts that do not go together. */
  void check() const
  {
    const int end = words.size();
    const auto has = [&](Part part) {
      return !material.laws[part].empty();
    };
    const auto refuse = [&](Part part, const std::string &why) {
      const UsedLaw &law = material.laws[part][0];
      fail(law.word, "'" + title(law) + "'" + why);
    };
    const auto gives = [&](Part part, const char *option) {
      return has(part) && has_option(material.laws[part][0], option);
    };
    if (material.density <= 0.0) fail(end, "density is missing: add 'density RHO'");
    if (has(CLOSED)) {
      const std::string name = title(material.laws[CLOSED][0]);
      for (const Part part : {EOS, STRENGTH, DAMAGE})
        if (has(part))
          refuse(part,
                 ": '" + name + "' is a complete law; use either '" + name +
                     "' or eos and strength");
    } else if (!has(EOS)) {
      if (has(STRENGTH))
        refuse(STRENGTH,
               " makes the stress deviator only: add an equation of state, such as "
               "'eos linear K' with the bulk modulus");
      fail(end,
           "no law: add " + join(names(declared_laws(CLOSED)), ", ") +
               ", or eos with strength or viscosity");
    }
    if (has(DAMAGE) && !has(STRENGTH))
      refuse(DAMAGE,
             " reduces the stress of a solid: add a strength, such as 'strength elastic G'");
    if (has(DAMAGE) && gives(EOS, "spall"))
      refuse(DAMAGE,
             ": spall and damage both take the tension of a point, and its energy: leave one of "
             "them out; 'damage rankine' breaks at a tensile stress, too");
    if (gives(DAMAGE, "after friction") && gives(STRENGTH, "kinematic"))
      refuse(DAMAGE,
             ": after friction is not for kinematic hardening, whose energy would be released "
             "again in each step of a slip: leave 'after friction' out");
    for (const auto &part : material.laws)
      for (const auto &law : part)
        if (law.info->needs_temperature(law.parameters) && !has(THERMAL))
          fail(law.word,
               std::string("'") + law.info->name +
                   "' with these parameters depends on the temperature: add 'thermal adiabatic' "
                   "with the specific heat, or 'thermal constant'");
    for (const auto &law : material.laws[VISCOSITY]) {
      if (!law.liquid) continue;
      const std::string what = "'" + title(law) + " liquid'";
      if (!has(THERMAL) || !has_option(material.laws[THERMAL][0], "melt"))
        fail(law.word, what + " is for what has molten: add 'melt TMELT LATENT' to a thermal part");
      if (!has(STRENGTH))
        fail(law.word,
             what +
                 " is for a solid that melts and forgets its shear: use an eos with a strength, or "
                 "leave 'liquid' out");
      if (has(DAMAGE))
        refuse(DAMAGE, ": a solid that melts cannot have a damage: leave out one of the two");
    }
    if (!material.vary.empty() && !has(THERMAL))
      fail(material.vary[0].word,
           "vary " + material.vary[0].name +
               ": without a thermal part there is no temperature: add 'thermal adiabatic' with the "
               "specific heat, or 'thermal constant'");
    if (has(EOS) && has(THERMAL)) {
      const UsedLaw &thermal = material.laws[THERMAL][0], &eos = material.laws[EOS][0];
      const bool expands =
          thermal.info->expansion && thermal.info->expansion(thermal.parameters) != 0.0;
      if (expands && has(DAMAGE) && has_option(material.laws[DAMAGE][0], "weibull"))
        refuse(DAMAGE,
               ": 'weibull' does not go with 'expansion', which would change the volume to which a "
               "strength belongs: use 'random SIGMA'");
      if (eos.info->finds_temperature &&
          (has_option(thermal, "gruneisen") || has_option(thermal, "melt")))
        refuse(THERMAL,
               ": the temperature follows from the internal energy of '" + title(eos) +
                   "': use it without 'gruneisen' and 'melt'");
      if (eos.info->finds_temperature && thermal.info->name == std::string("constant"))
        refuse(THERMAL,
               ": nothing brings or takes the heat that would keep the temperature of '" +
                   title(eos) +
                   "', whose pressure would be that without it: use 'thermal conducting' with "
                   "fix mpm/heat, whose walls keep the gas at their temperature");
      if (expands && eos.info->expands)
        refuse(THERMAL,
               ": 'expansion' does not go with '" + title(eos) +
                   "', whose internal energy makes it expand already: leave it out, or use eos "
                   "linear or tait");
    }
    if (has(THERMAL) && !has(DAMAGE)) {
      const UsedLaw &thermal = material.laws[THERMAL][0];
      if (thermal.info->fracture_share && thermal.info->fracture_share(thermal.parameters) > 0.0)
        refuse(THERMAL,
               ": 'fracture' is the share of the work of a damage that becomes heat: add a part "
               "damage, or leave it out");
    }
    if (has(DAMAGE) && material.shares_stress())
      refuse(DAMAGE,
             " does not go with a viscosity that adds to the stress on which a strength or law "
             "builds in the next step: leave out the viscosity, or use viscosity artificial with "
             "eos and strength");
  }
};

}    // namespace

std::unique_ptr<Material> Material::create(const std::vector<std::string> &words, const char *isa)
{
  return Parser(words, isa).parse();
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "declare/option.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

using namespace MPM_NS;

namespace {

using Strings = std::vector<std::string>;

std::string format(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

template <class Integer> std::string format(Integer n)
{
  return std::to_string(n);
}

std::string format(const NumberOrVariable &v)
{
  if (!v.given) return "NULL";
  return v.variable.empty() ? format(v.value) : "v_" + v.variable;
}

Strings split(const std::string &text, char separator)
{
  Strings parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

std::string join(const Strings &parts, const std::string &separator)
{
  std::string text;
  for (const auto &part : parts)
    if (!part.empty()) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::string sentence(std::string text)
{
  text[0] = static_cast<char>(toupper(text[0]));
  return text;
}

/** What a number must be, for messages. */
std::string required(const Range &r)
{
  if (r.low == -UNBOUNDED && r.high == UNBOUNDED) return "must be finite";
  if (r.low == 0.0 && r.high == UNBOUNDED)
    return r.closed ? "must not be negative" : "must be positive";
  if (r.low != -UNBOUNDED && r.high != UNBOUNDED && r.closed && r.closed_above)
    return "must be within " + format(r.low) + " and " + format(r.high);
  Strings parts;
  if (r.low != -UNBOUNDED) parts.push_back((r.closed ? "at least " : "above ") + format(r.low));
  if (r.high != UNBOUNDED)
    parts.push_back((r.closed_above ? "at most " : "below ") + format(r.high));
  return "must be " + join(parts, " and ");
}

/** A word in the place of a number is mostly the next keyword, and the number is missing. */
int next_number(OptionReader &r, const std::string &name, const std::string &kind)
{
  const int iarg = r.next();
  const std::string word = r.input.arg[iarg];
  const auto is_part = [](unsigned char c) {
    return isalpha(c) || c == '/';
  };
  if (word.size() > 3 && !name.empty() && std::all_of(word.begin(), word.end(), is_part))
    throw OptionError{iarg,
                      sentence(r.what + " " + name) + " is missing: expected " + kind +
                          " parameter instead of '" + word + "'"};
  return iarg;
}

void take(OptionReader &r, const std::string &name, const Range &range, double &to)
{
  const int iarg = next_number(r, name, "floating point");
  to = r.input.number(iarg);
  if (!std::isfinite(to) || !range.contains(to))
    r.fail(iarg, name, required(range) + ": " + r.input.arg[iarg]);
}

template <class Integer>
void take(OptionReader &r, const std::string &name, const Range &range, Integer &to)
{
  const int iarg = next_number(r, name, "integer");
  const int64_t value = r.input.integer(iarg);
  to = static_cast<Integer>(value);
  if (to != value || !range.contains(static_cast<double>(value)))
    r.fail(iarg, name, (to != value ? "is too large" : required(range)) + ": " + r.input.arg[iarg]);
}

bool is_number(const OptionReader &r, int iarg)
{
  if (iarg >= r.input.narg) return false;
  const std::string word = r.input.arg[iarg];
  char *end = nullptr;
  strtod(word.c_str(), &end);
  return word.compare(0, 2, "v_") == 0 || (end != word.c_str() && *end == '\0');
}

/** Present values of n variables. */
template <class T> std::function<std::string()> writer(const T *from, int n)
{
  return [=] {
    Strings parts;
    for (int k = 0; k < n; k++) parts.push_back(format(from[k]));
    return join(parts, " ");
  };
}

/** The k-th of n names; that of a single value may have blanks. */
std::string name_of(const std::string &names, int k, int n)
{
  return n == 1 ? names : split(names, ' ')[k];
}

/** What to say of a number in the place of a keyword, after the values of an option: in 2d some
 *  have fewer than in 3d. */
std::string too_many(const Option *option, const std::string &found)
{
  if (!option || found.find_first_of("0123456789") > 1) return "";
  Strings usage;
  for (const auto &value : option->values)
    if (!value.usage.empty()) usage.push_back(value.usage);
  return usage.empty() ? "" : "; the values of " + option->keyword + " are " + join(usage, " ");
}

/** Present values, as in the input. */
std::string text_of(const std::vector<OptionValue> &values)
{
  Strings parts;
  for (const auto &value : values) parts.push_back(value.text());
  return join(parts, " ");
}

/** Names of values, or the words that can be in the place of one. */
std::string usage_of(const OptionValue &value)
{
  if (!value.words) return value.usage;
  Strings words;
  for (const auto &word : *value.words) words.push_back(word.word);
  return "one of " + join(words, " ");
}

/** Reads values that are not optional. Where the command ends too soon, the message says what it
 *  needs. */
void read_values(const std::vector<OptionValue> &values, OptionReader &r)
{
  const std::string what = r.what;
  try {
    for (const auto &value : values)
      if (!value.optional || is_number(r, r.iarg)) value.read(r);
  } catch (const OptionError &e) {
    if (!e.missing) throw;
    Strings needs;
    for (const auto &value : values)
      if (!value.optional) needs.push_back(usage_of(value));
    throw OptionError{
        -1, "Illegal " + what + " command: missing argument(s), needs " + join(needs, " ")};
  }
}

}    // namespace

// ---------------------------------------------------------------------- reading

int OptionReader::next()
{
  if (iarg >= input.narg) throw OptionError{-1, command, true};
  return iarg++;
}

void OptionReader::fail(int at, const std::string &name, const std::string &text) const
{
  throw OptionError{at, sentence(join({what, several ? name : "", text}, " "))};
}

// ---------------------------------------------------------------------- kinds of values

OptionValue option::numbers(OptionNumber first, int n, const std::string &names, const Range &range,
                            const std::string &unit, const std::string &meaning)
{
  const std::vector<OptionNote> notes = {{names, meaning, unit, range}};
  const auto value_of = [&](auto *to) {
    const auto read = [=](OptionReader &r) {
      for (int k = 0; k < n; k++) take(r, name_of(names, k, n), range, to[k]);
    };
    return OptionValue{names, n, read, writer(to, n), notes};
  };
  return std::visit(value_of, first);
}

OptionValue option::axes(double *to, int dim, const std::string &names, const Range &range,
                         const std::string &unit, const std::string &meaning)
{
  OptionValue value = numbers(to, dim, names, range, unit, meaning);
  value.usage += " (in 2d: " + names.substr(0, names.rfind(' ')) + ")";
  return value;
}

OptionValue option::one_or_axes(OptionNumber first, int dim, const std::string &names,
                                const Range &range, const std::string &unit,
                                const std::string &meaning, const std::string &meaning_each)
{
  const Strings all = split(names, ' ');
  const std::string each = join(Strings(all.begin() + 1, all.end()), " ");
  const std::string usage = all[0] + " or " + each + " (in 2d: " + all[1] + " " + all[2] + ")";
  const std::vector<OptionNote> notes = {{all[0], meaning, unit, range}, {each, meaning_each}};
  const auto value_of = [&](auto *to) {
    const auto read = [=](OptionReader &r) {
      int n = 0;
      while (is_number(r, r.iarg + n)) n++;
      if (r.iarg >= r.input.narg) r.next();
      const std::string d = std::to_string(dim);
      if (n != 1 && n != dim)
        r.fail(r.iarg - 1, "",
               "expects 1 or " + d + " numbers in a " + d + "d simulation, not " +
                   std::to_string(n));
      for (int k = 0; k < n; k++) take(r, all[0], range, to[k]);
      for (int k = n; k < dim; k++) to[k] = to[0];
    };
    return OptionValue{usage, 2, read, writer(to, dim), notes};
  };
  return std::visit(value_of, first);
}

OptionValue option::yes_no(bool &to)
{
  const auto read = [&to](OptionReader &r) {
    to = r.input.yes(r.next());
  };
  const auto text = [&to] {
    return to ? "yes" : "no";
  };
  return {"*yes* or *no*", 1, read, text};
}

OptionValue option::text(std::string &to, const std::string &name, const std::string &meaning)
{
  const auto read = [&to](OptionReader &r) {
    to = r.input.arg[r.next()];
  };
  const auto text = [&to] {
    return to;
  };
  return {name, 1, read, text, {{name, meaning}}};
}

OptionValue option::variables(NumberOrVariable *to, int n, const std::string &names,
                              const std::string &unit, const std::string &meaning, bool null)
{
  const auto read = [=](OptionReader &r) {
    for (int k = 0; k < n; k++) {
      to[k] = NumberOrVariable();
      const std::string word = r.iarg < r.input.narg ? r.input.arg[r.iarg] : "";
      to[k].given = !(null && word == "NULL");
      if (word.compare(0, 2, "v_") == 0) to[k].variable = word.substr(2);
      if (!to[k].given || !to[k].variable.empty())
        r.next();
      else
        take(r, name_of(names, k, n), ANY_NUMBER, to[k].value);
    }
  };
  return {names, n, read, writer(to, n), {{names, meaning, unit}}};
}

OptionValue option::word(std::function<int()> get, std::function<void(int)> set,
                         const std::vector<OptionWord> &words, const std::string &name)
{
  const auto read = [=](OptionReader &r) {
    const int iarg = r.next();
    std::string known;
    for (const auto &w : words) {
      known += " " + w.word;
      if (w.word != r.input.arg[iarg]) continue;
      set(w.value);
      r.what += " " + w.word;
      r.several = true;
      return read_values(w.values, r);
    }
    throw OptionError{iarg,
                      "Unknown " + join({r.what, name, r.input.arg[iarg]}, " ") +
                          ": must be one of" + known};
  };
  const auto text = [=] {
    const int present = get();
    for (const auto &w : words)
      if (w.value == present) return join({w.word, text_of(w.values)}, " ");
    return std::string();
  };
  return {"", 1, read, text, {}, std::make_shared<const std::vector<OptionWord>>(words)};
}

OptionValue option::any_of(bool *to, const std::vector<std::string> &words,
                           const std::string &meaning)
{
  const auto read = [=](OptionReader &r) {
    const int first = r.iarg;
    for (; r.iarg < r.input.narg; r.iarg++) {
      const auto found = std::find(words.begin(), words.end(), r.input.arg[r.iarg]);
      if (found == words.end()) break;
      to[found - words.begin()] = true;
    }
    if (r.iarg == first) r.fail(first - 1, "", "needs one or more of " + join(words, " "));
  };
  const auto text = [=] {
    Strings parts;
    for (std::size_t k = 0; k < words.size(); k++)
      if (to[k]) parts.push_back(words[k]);
    return join(parts, " ");
  };
  return {"one or more of " + join(words, " "), 2, read, text, {{"", meaning}}};
}

OptionValue option::optional(OptionValue value)
{
  value.optional = true;
  return value;
}

// ---------------------------------------------------------------------- all options

Option &Options::add(const std::string &keyword, std::vector<OptionValue> values,
                     const std::string &meaning)
{
  Option option;
  option.keyword = keyword;
  option.meaning = meaning;
  option.values = std::move(values);
  option.preset = text_of(option.values);
  options.push_back(option);
  return options.back();
}

const Option *Options::find(const std::string &keyword) const
{
  for (const auto &option : options)
    if (option.keyword == keyword) return &option;
  return nullptr;
}

int Options::where(const std::string &keyword) const
{
  const Option *option = find(keyword);
  return option ? option->where : -1;
}

int Options::read(const OptionInput &input, int iarg, const std::string &last)
{
  OptionReader first{input, iarg, command, command, true};
  for (const auto &value : arguments) {
    read_values({value}, first);
    first.what = command;
  }
  iarg = first.iarg;
  const Option *last_read = nullptr;
  while (iarg < input.narg && (last.empty() || last != input.arg[iarg])) {
    const std::string keyword = input.arg[iarg];
    auto *option = const_cast<Option *>(find(keyword));
    if (!option)
      throw OptionError{
          iarg, "Unknown " + command + " keyword: " + keyword + too_many(last_read, keyword)};
    const std::string full = command + " " + keyword;
    if (option->single && option->where >= 0)
      throw OptionError{iarg, sentence(full + " is given twice")};
    option->where = iarg;
    OptionReader reader{input, iarg + 1, full, full, option->values.size() > 1};
    read_values(option->values, reader);
    if (option->after) option->after();
    iarg = reader.iarg;
    last_read = option;
  }
  for (const auto &rule : refusals ? refusals() : OptionRules())
    if (rule.broken && (rule.keyword.empty() || given(rule.keyword)))
      throw OptionError{where(rule.keyword), message(rule)};
  return iarg;
}

std::string Options::message(const OptionRule &rule) const
{
  std::string text = join({command, rule.keyword, rule.text}, " ");
  for (const auto &option : options) {
    const std::string name = "{" + option.keyword + "}";
    const auto at = text.find(name);
    if (at != std::string::npos) text.replace(at, name.size(), text_of(option.values));
  }
  return sentence(text);
}

std::vector<std::string> Options::warnings() const
{
  Strings all;
  for (const auto &rule : doubts ? doubts() : OptionRules())
    if (rule.broken) all.push_back(message(rule));
  return all;
}

std::string Options::text() const
{
  Strings parts;
  for (const auto &option : options) {
    const std::string text = text_of(option.values);
    if (!text.empty()) parts.push_back(option.keyword + " " + text);
  }
  return join(parts, " ");
}

std::string Options::kept() const
{
  std::string all;
  for (const auto &option : options)
    if (option.kept && (!option.keeps || option.keeps()))
      all += option.keyword + " " + text_of(option.values) + "\n";
  return all;
}

std::string Options::differences(const std::string &kept_then) const
{
  Strings parts;
  for (const auto &line : split(kept_then, '\n')) {
    const Strings then = split(line, ' ');
    const Option *option = find(then[0]);
    if (!option || then.size() < 2) continue;
    const Strings now = split(text_of(option->values), ' ');
    if (!now.empty() && now[0] != then[1])
      parts.push_back(then[0] + " " + then[1] + " (now " + now[0] + ")");
  }
  return join(parts, ", ");
}

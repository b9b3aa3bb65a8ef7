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

void take(OptionReader &r, const std::string &name, const Range &range, double &to)
{
  const int iarg = r.next();
  to = r.input.number(iarg);
  if (!std::isfinite(to) || !range.contains(to))
    r.fail(iarg, name, required(range) + ": " + r.input.arg[iarg]);
}

template <class Integer>
void take(OptionReader &r, const std::string &name, const Range &range, Integer &to)
{
  const int iarg = r.next();
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

OptionValue make(const std::string &name, const std::string &usage, int count,
                 std::function<void(OptionReader &)> read, std::function<std::string()> text)
{
  OptionValue value;
  value.name = name;
  value.usage = usage;
  value.count = count;
  value.read = std::move(read);
  value.text = std::move(text);
  return value;
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

template <class Number>
OptionValue option::numbers(Number *to, int n, const std::string &names, const Range &range,
                            const std::string &unit, const std::string &meaning)
{
  const auto read = [=](OptionReader &r) {
    for (int k = 0; k < n; k++) take(r, name_of(names, k, n), range, to[k]);
  };
  OptionValue value = make(names, names, n, read, writer(to, n));
  value.notes = {{names, meaning, unit, range}};
  return value;
}

OptionValue option::axes(double *to, int dim, const std::string &names, const Range &range,
                         const std::string &unit, const std::string &meaning)
{
  OptionValue value = numbers(to, dim, names, range, unit, meaning);
  value.usage += " (in 2d: " + names.substr(0, names.rfind(' ')) + ")";
  return value;
}

template <class Number>
OptionValue option::one_or_axes(Number *to, int dim, const std::string &names, const Range &range,
                                const std::string &unit, const std::string &meaning,
                                const std::string &meaning_each)
{
  const Strings all = split(names, ' ');
  const std::string each = join(Strings(all.begin() + 1, all.end()), " ");
  const auto read = [=](OptionReader &r) {
    int n = 0;
    while (is_number(r, r.iarg + n)) n++;
    if (r.iarg >= r.input.narg) r.next();
    const std::string d = std::to_string(dim);
    if (n != 1 && n != dim)
      r.fail(r.iarg - 1, "",
             "expects 1 or " + d + " numbers in a " + d + "d simulation, not " + std::to_string(n));
    for (int k = 0; k < n; k++) take(r, all[0], range, to[k]);
    for (int k = n; k < dim; k++) to[k] = to[0];
  };
  OptionValue value =
      make(all[0], all[0] + " or " + each + " (in 2d: " + all[1] + " " + all[2] + ")", 2, read,
           writer(to, dim));
  value.notes = {{all[0], meaning, unit, range}, {each, meaning_each}};
  return value;
}

template OptionValue option::numbers(double *, int, const std::string &, const Range &,
                                     const std::string &, const std::string &);
template OptionValue option::numbers(int *, int, const std::string &, const Range &,
                                     const std::string &, const std::string &);
template OptionValue option::numbers(int64_t *, int, const std::string &, const Range &,
                                     const std::string &, const std::string &);
template OptionValue option::one_or_axes(double *, int, const std::string &, const Range &,
                                         const std::string &, const std::string &,
                                         const std::string &);
template OptionValue option::one_or_axes(int *, int, const std::string &, const Range &,
                                         const std::string &, const std::string &,
                                         const std::string &);

OptionValue option::yes_no(bool &to)
{
  const auto read = [&to](OptionReader &r) {
    to = r.input.yes(r.next());
  };
  return make("", "*yes* or *no*", 1, read, [&to] {
    return to ? "yes" : "no";
  });
}

OptionValue option::text(std::string &to, const std::string &name, const std::string &meaning)
{
  const auto read = [&to](OptionReader &r) {
    to = r.input.arg[r.next()];
  };
  OptionValue value = make(name, name, 1, read, [&to] {
    return to;
  });
  value.notes = {{name, meaning}};
  return value;
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
  OptionValue value = make(names, names, n, read, writer(to, n));
  value.notes = {{names, meaning, unit}};
  return value;
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
      for (const auto &value : w.values)
        if (!value.optional || is_number(r, r.iarg)) value.read(r);
      return;
    }
    throw OptionError{iarg,
                      "Unknown " + join({r.what, name, r.input.arg[iarg]}, " ") +
                          ": must be one of" + known};
  };
  const auto text = [=] {
    const int present = get();
    for (const auto &w : words) {
      if (w.value != present) continue;
      Strings parts = {w.word};
      for (const auto &value : w.values) parts.push_back(value.text());
      return join(parts, " ");
    }
    return std::string();
  };
  OptionValue value = make(name, "", 1, read, text);
  value.words = words;
  return value;
}

OptionValue option::any_of(bool *to, const std::vector<std::string> &words,
                           const std::string &meaning)
{
  const auto read = [=](OptionReader &r) {
    const int first = r.iarg;
    for (bool more = true; more && r.iarg < r.input.narg;) {
      const auto found = std::find(words.begin(), words.end(), r.input.arg[r.iarg]);
      more = found != words.end();
      if (more) to[found - words.begin()] = true;
      r.iarg += more;
    }
    if (r.iarg == first) r.fail(first - 1, "", "needs one or more of " + join(words, " "));
  };
  const auto text = [=] {
    Strings parts;
    for (std::size_t k = 0; k < words.size(); k++)
      if (to[k]) parts.push_back(words[k]);
    return join(parts, " ");
  };
  OptionValue value = make("", "one or more of " + join(words, " "), 2, read, text);
  value.notes = {{"", meaning}};
  return value;
}

OptionValue option::optional(OptionValue value)
{
  value.optional = true;
  return value;
}

// ---------------------------------------------------------------------- one option

Option &Option::keep()
{
  kept = true;
  return *this;
}

Option &Option::once()
{
  single = true;
  return *this;
}

Option &Option::then(std::function<void()> f)
{
  after = std::move(f);
  return *this;
}

Option &Option::standard(const std::string &text)
{
  preset = text;
  return *this;
}

std::string Option::text() const
{
  Strings parts;
  for (const auto &value : values) parts.push_back(value.text());
  return join(parts, " ");
}

// ---------------------------------------------------------------------- all options

Options::Options(std::string command_in) : command(std::move(command_in)) {}

void Options::argument(OptionValue value)
{
  arguments.push_back(std::move(value));
}

Option &Options::add(const std::string &keyword, std::vector<OptionValue> values,
                     const std::string &meaning)
{
  Option option;
  option.keyword = keyword;
  option.meaning = meaning;
  option.values = std::move(values);
  option.preset = option.text();
  options.push_back(option);
  return options.back();
}

void Options::refuse(std::function<OptionRules()> rules)
{
  refusals = std::move(rules);
}

void Options::warn(std::function<OptionRules()> rules)
{
  doubts = std::move(rules);
}

const Option *Options::find(const std::string &keyword) const
{
  for (const auto &option : options)
    if (option.keyword == keyword) return &option;
  return nullptr;
}

bool Options::has(const std::string &keyword) const
{
  return find(keyword) != nullptr;
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
    value.read(first);
    first.what = command;
  }
  iarg = first.iarg;
  while (iarg < input.narg && (last.empty() || last != input.arg[iarg])) {
    const std::string keyword = input.arg[iarg];
    auto *option = const_cast<Option *>(find(keyword));
    if (!option) throw OptionError{iarg, "Unknown " + command + " keyword: " + keyword};
    const std::string full = command + " " + keyword;
    if (option->single && option->where >= 0)
      throw OptionError{iarg, sentence(full + " is given twice")};
    option->where = iarg;
    OptionReader reader{input, iarg + 1, full, full, option->values.size() > 1};
    for (const auto &value : option->values)
      if (!value.optional || is_number(reader, reader.iarg)) value.read(reader);
    if (option->after) option->after();
    iarg = reader.iarg;
  }
  check();
  return iarg;
}

std::string Options::message(const OptionRule &rule) const
{
  std::string text = join({command, rule.keyword, rule.text}, " ");
  for (const auto &option : options) {
    const std::string name = "{" + option.keyword + "}";
    const auto at = text.find(name);
    if (at != std::string::npos) text.replace(at, name.size(), option.text());
  }
  return sentence(text);
}

void Options::check() const
{
  if (!refusals) return;
  for (const auto &rule : refusals())
    if (rule.broken && (rule.keyword.empty() || given(rule.keyword)))
      throw OptionError{where(rule.keyword), message(rule)};
}

std::vector<std::string> Options::warnings() const
{
  Strings all;
  if (doubts)
    for (const auto &rule : doubts())
      if (rule.broken) all.push_back(message(rule));
  return all;
}

std::string Options::text() const
{
  Strings parts;
  for (const auto &option : options) {
    const std::string text = option.text();
    if (!text.empty()) parts.push_back(option.keyword + " " + text);
  }
  return join(parts, " ");
}

std::string Options::kept() const
{
  std::string all;
  for (const auto &option : options)
    if (option.kept) all += option.keyword + " " + option.text() + "\n";
  return all;
}

std::string Options::differences(const std::string &kept_then) const
{
  Strings parts;
  for (const auto &line : split(kept_then, '\n')) {
    const Strings then = split(line, ' ');
    const Option *option = find(then[0]);
    if (!option || then.size() < 2) continue;
    const Strings now = split(option->text(), ' ');
    if (!now.empty() && now[0] != then[1])
      parts.push_back(then[0] + " " + then[1] + " (now " + now[0] + ")");
  }
  return join(parts, ", ");
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_DECLARE_OPTION_H
#define MPM_DECLARE_OPTION_H

// The options of a style, declared once: keyword, values, unit, range, default, meaning, and what
// they exclude with the remedy. The parser with its error messages, the refusals, the comparison with
// a restart file, the echo in the log, and the block of keywords in the manual all come from this
// declaration. Knows nothing of LAMMPS: mpm_options.h connects the two.
//
//   Options MPMDtOptions::declare()
//   {
//     using namespace option;
//     Options o("fix mpm/dt");
//     o.argument(number(fraction, "fraction", {0.0, 2.0, false, true}));
//     o.add("every", {integer(look_every, "N", POSITIVE, "set the time step every this many steps")});
//     o.add("min", {number(dt_min, "dt", POSITIVE, "time", "smallest time step")}).standard("none");
//     o.add("max", {number(dt_max, "dt", POSITIVE, "time", "largest time step")}).standard("none");
//     o.refuse([=] { return OptionRules{{dt_max < dt_min, "min", "{min} is above max {max}"}}; });
//     return o;
//   }
//
// A declaration refers to the variables that it reads into, and so must not outlive them.

#include "declare/range.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace MPM_NS {

/** A mistake in the input. */
struct OptionError {
  int iarg;            ///< the argument that is wrong, or -1: it is none in particular
  std::string text;    ///< what is wrong; when missing: the command that ends too soon
  bool missing = false;
};

/** The words of a command, and how they become values, which in LAMMPS is the same everywhere. */
struct OptionInput {
  int narg;
  const char *const *arg;
  std::function<double(int iarg)> number;
  std::function<int64_t(int iarg)> integer;
  std::function<bool(int iarg)> yes;
};

/** A number, or an equal-style variable that gives it in each step, or NULL. */
struct NumberOrVariable {
  double value = 0.0;
  std::string variable;    ///< its name, empty: a number
  bool given = true;       ///< not NULL
  int index = -1;          ///< of the variable, for who evaluates it
};

/** Where in the input a value is read, and how messages name it. */
struct OptionReader {
  const OptionInput &input;
  int iarg;               ///< the next argument
  std::string command;    ///< with the keyword
  std::string what;       ///< the same, with the words that followed
  bool several;           ///< the option has several values: messages have their names, too

  /** Takes an argument. */
  int next();
  [[noreturn]] void fail(int iarg, const std::string &name, const std::string &text) const;
};

/** What the manual says of values: their names, separated by blanks, and what they mean. */
struct OptionNote {
  std::string names, meaning, unit = "";
  Range range = ANY_NUMBER;
};

struct OptionWord;

/** A value after a keyword: made by the functions in namespace option. */
struct OptionValue {
  std::string usage;    ///< as it is written in the manual; empty: one of the words
  int count;            ///< numbers or words of it
  std::function<void(OptionReader &)> read;
  std::function<std::string()> text;    ///< present value, as in the input
  std::vector<OptionNote> notes = {};
  std::shared_ptr<const std::vector<OptionWord>> words = nullptr;    ///< null: any other value
  bool optional = false;
};

/** One of the words that a value can be. */
struct OptionWord {
  std::string word;
  int value;
  std::string meaning = "";                ///< empty: that of the next word is for both
  std::vector<OptionValue> values = {};    ///< that follow this word
};

/** What options exclude. The message is the command, the keyword, and the text, in which {name} is the
 *  present value of that keyword. */
struct OptionRule {
  bool broken;
  std::string keyword;    ///< that is to blame, or empty
  std::string text;       ///< what is wrong, with the remedy
};
using OptionRules = std::vector<OptionRule>;

/** The kinds of values. Names are those in the manual and in messages; units are kinds of units, such
 *  as velocity, "1" for none that has no unit, "" for what needs no mention. */
namespace option {

  using OptionNumber = std::variant<double *, int *, int64_t *>;

  /** n numbers with one meaning, from the first on; their names are separated by blanks. */
  OptionValue numbers(OptionNumber, int n, const std::string &names, const Range &,
                      const std::string &unit = "", const std::string &meaning = "");
  inline OptionValue number(double &to, const std::string &name, const Range &range,
                            const std::string &unit = "", const std::string &meaning = "")
  {
    return numbers(&to, 1, name, range, unit, meaning);
  }
  template <class Integer>
  OptionValue integer(Integer &to, const std::string &name, const Range &range,
                      const std::string &meaning = "")
  {
    return numbers(&to, 1, name, range, "", meaning);
  }
  /** One for each axis; names are those in 3d. */
  OptionValue axes(double *, int dim, const std::string &names, const Range &,
                   const std::string &unit = "", const std::string &meaning = "");
  /** One for each axis or one for all of them, which has the first of the names. */
  OptionValue one_or_axes(OptionNumber, int dim, const std::string &names, const Range &,
                          const std::string &unit, const std::string &meaning,
                          const std::string &meaning_each);
  OptionValue yes_no(bool &);
  /** Any word, such as an ID. */
  OptionValue text(std::string &, const std::string &name, const std::string &meaning = "");
  /** Numbers or equal-style variables; null: words NULL leave values free. */
  OptionValue variables(NumberOrVariable *, int n, const std::string &names,
                        const std::string &unit, const std::string &meaning, bool null = false);
  /** One of several words; name: in messages about a word that is none of them. */
  OptionValue word(std::function<int()> get, std::function<void(int)> set,
                   const std::vector<OptionWord> &, const std::string &name = "");
  template <class Enum>
  OptionValue word(Enum &to, const std::vector<OptionWord> &words, const std::string &name = "")
  {
    return word(
        [&to] {
          return static_cast<int>(to);
        },
        [&to](int value) {
          to = static_cast<Enum>(value);
        },
        words, name);
  }
  /** One or more of n words, each of which sets its entry. */
  OptionValue any_of(bool *, const std::vector<std::string> &words,
                     const std::string &meaning = "");
  /** The value may be left out; it is there when a number follows. */
  OptionValue optional(OptionValue);

}    // namespace option

/** A keyword with its values. */
class Option {
 public:
  /** Another value than in the restart file is an error: of several words, another first one. */
  Option &keep() { return set(kept, true); }
  /** The same, where this holds when the file is written. */
  Option &keep(const std::function<bool()> &f)
  {
    keeps = f;
    return keep();
  }
  /** Must not be given twice. */
  Option &once() { return set(single, true); }
  /** Called after each time the values have been read: they may be given again, for another one. */
  Option &then(const std::function<void()> &f) { return set(after, f); }
  /** What the manual says of the default, instead of the value. */
  Option &standard(const std::string &text) { return set(preset, text); }

  std::string keyword, meaning, preset;
  std::vector<OptionValue> values;

 private:
  friend class Options;
  bool kept = false, single = false;
  int where = -1;    // the argument with the keyword, as given last
  std::function<void()> after;
  std::function<bool()> keeps;

  template <class T> Option &set(T &member, const T &value)
  {
    member = value;
    return *this;
  }
};

/** All options of a style. */
class Options {
 public:
  /** command: in messages, for example fix mpm/dt. */
  explicit Options(std::string command) : command(std::move(command)) {}

  /** A value that must be given: these come first, in the order of their declaration. */
  void argument(const OptionValue &value) { arguments.push_back(value); }
  /** A keyword. meaning: lines for the manual, in addition to those of the values. */
  Option &add(const std::string &keyword, std::vector<OptionValue>,
              const std::string &meaning = "");

  /** The rules, evaluated when the values are read, that the input must not break; those without the
   *  keyword of a rule in the input are not looked at. */
  void refuse(const std::function<OptionRules()> &rules) { refusals = rules; }
  /** The rules of warnings(). */
  void warn(const std::function<OptionRules()> &rules) { doubts = rules; }

  /** Reads arguments from iarg on, up to the end or the word last, whose index is returned, and
   *  applies the refusals; throws OptionError. */
  int read(const OptionInput &, int iarg, const std::string &last = "");

  /** Is this word a keyword; the index of its argument, -1 when it was not given. */
  bool has(const std::string &keyword) const { return find(keyword) != nullptr; }
  int where(const std::string &keyword) const;
  bool given(const std::string &keyword) const { return where(keyword) >= 0; }

  /** What can be run but is likely to be a mistake. */
  std::vector<std::string> warnings() const;

  /** All keywords with their present values, in one line. */
  std::string text() const;
  /** Those that a restart file keeps. */
  std::string kept() const;
  /** Where these differ from what kept() returned when the file was written; empty: nowhere. */
  std::string differences(const std::string &kept_then) const;

  const std::vector<Option> &all() const { return options; }

 private:
  std::string command;
  std::vector<OptionValue> arguments;
  std::vector<Option> options;
  std::function<OptionRules()> refusals, doubts;

  const Option *find(const std::string &keyword) const;
  std::string message(const OptionRule &) const;
};

}    // namespace MPM_NS
#endif

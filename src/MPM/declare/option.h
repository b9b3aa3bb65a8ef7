/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_DECLARE_OPTION_H
#define MPM_DECLARE_OPTION_H

// The options of a style, declared once: keyword, values, unit, range, default, meaning, and the
// combinations that are refused, with the remedy. The parser with its error messages, the refusals,
// the comparison with a restart file, the echo in the log, and the block of keywords in the manual
// are all made from this declaration. Knows nothing of LAMMPS: mpm_options.h connects the two.
//
//   Options MPMDtOptions::declare()
//   {
//     using namespace option;
//     Options o("fix mpm/dt");
//     o.argument(number(fraction, "fraction", {0.0, 2.0, false, true}));
//     o.add("every", {integer(look_every, "N", POSITIVE, "number of steps between changes")});
//     o.add("min", {number(dt_min, "dt", POSITIVE, "time", "shortest step")}).standard("none");
//     o.add("max", {number(dt_max, "dt", POSITIVE, "time", "longest step")}).standard("none");
//     o.refuse([=] { return OptionRules{{dt_max < dt_min, "min", "{min} is above max {max}"}}; });
//     return o;
//   }
//
// A declaration refers to the variables into which it reads values, and must not outlive them.

#include "declare/range.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace MPM_NS {

/** An error in the input. */
struct OptionError {
  int iarg;                ///< the wrong argument; -1: none in particular
  std::string text;        ///< the message; if missing: the command that ends too soon
  bool missing = false;    ///< arguments are missing at the end
};

/** The words of a command, and the functions of LAMMPS that convert word iarg to a value. */
struct OptionInput {
  int narg;
  const char *const *arg;
  std::function<double(int iarg)> number;
  std::function<int64_t(int iarg)> integer;
  std::function<bool(int iarg)> yes;
};

/** A number, an equal-style variable that is evaluated in each step, or NULL. */
struct NumberOrVariable {
  double value = 0.0;
  std::string variable;    ///< name of the variable; empty: a number
  bool given = true;       ///< false: NULL
  int index = -1;          ///< index of the variable, for the code that evaluates it
};

/** The place in the input where a value is read, and its name in messages. */
struct OptionReader {
  const OptionInput &input;
  int iarg;               ///< the next argument
  std::string command;    ///< command and keyword
  std::string what;       ///< command, keyword, and the words after it so far
  bool several;           ///< the option has several values, so that messages name the value, too

  /** Index of the next argument, which is taken; throws OptionError if there is none. */
  int next();
  /** Throws OptionError for an argument; name: name of the value, used if there are several. */
  [[noreturn]] void fail(int iarg, const std::string &name, const std::string &text) const;
};

/** Text of the manual about values: their names, separated by blanks, meaning, unit, and range. */
struct OptionNote {
  std::string names, meaning, unit = "";
  Range range = ANY_NUMBER;
};

struct OptionWord;

/** A value after a keyword, made by the functions in namespace option. */
struct OptionValue {
  std::string usage;    ///< as written in the manual; empty: one of the words
  int count;            ///< how many numbers or words it consists of
  std::function<void(OptionReader &)> read;
  std::function<std::string()> text;    ///< present value, as it is written in the input
  std::vector<OptionNote> notes = {};
  std::shared_ptr<const std::vector<OptionWord>> words = nullptr;    ///< null: other kinds of value
  bool optional = false;                                             ///< may be left out
};

/** One of the words that are possible for a value. */
struct OptionWord {
  std::string word;
  int value;
  std::string meaning = "";                ///< empty: the meaning of the next word is for both
  std::vector<OptionValue> values = {};    ///< values that follow this word
};

/** A rule that options must not break. The message consists of the command, the keyword, and the
 *  text, in which {name} stands for the present value of that keyword. */
struct OptionRule {
  bool broken;
  std::string keyword;    ///< the keyword that is wrong, or empty
  std::string text;       ///< what is wrong, and the remedy
};
using OptionRules = std::vector<OptionRule>;

/** The kinds of values. Names are those in the manual and in messages. Units are kinds of units,
 *  such as velocity; "1" for dimensionless values, "" for values whose unit need not be
 *  mentioned. */
namespace option {

  using OptionNumber = std::variant<double *, int *, int64_t *>;

  /** n numbers with one meaning, read into an array; their names are separated by blanks. */
  OptionValue numbers(OptionNumber, int n, const std::string &names, const Range &,
                      const std::string &unit = "", const std::string &meaning = "");
  /** One real number. */
  inline OptionValue number(double &to, const std::string &name, const Range &range,
                            const std::string &unit = "", const std::string &meaning = "")
  {
    return numbers(&to, 1, name, range, unit, meaning);
  }
  /** One integer. */
  template <class Integer>
  OptionValue integer(Integer &to, const std::string &name, const Range &range,
                      const std::string &meaning = "")
  {
    return numbers(&to, 1, name, range, "", meaning);
  }
  /** One number for each axis; names are those in 3d. */
  OptionValue axes(double *, int dim, const std::string &names, const Range &,
                   const std::string &unit = "", const std::string &meaning = "");
  /** One number for all axes, which has the first of the names, or one for each axis. */
  OptionValue one_or_axes(OptionNumber, int dim, const std::string &names, const Range &,
                          const std::string &unit, const std::string &meaning,
                          const std::string &meaning_each);
  /** The word yes or no. */
  OptionValue yes_no(bool &);
  /** Any word, such as an ID. */
  OptionValue text(std::string &, const std::string &name, const std::string &meaning = "");
  /** n numbers or equal-style variables; null: also NULL, for values that are not given. */
  OptionValue variables(NumberOrVariable *, int n, const std::string &names,
                        const std::string &unit, const std::string &meaning, bool null = false);
  /** One of several words; name: name of the value in messages about an unknown word. */
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
  /** One or more of the words; each word given sets its entry to true. */
  OptionValue any_of(bool *, const std::vector<std::string> &words,
                     const std::string &meaning = "");
  /** Makes a value optional: it is read only if a number or a variable follows. */
  OptionValue optional(OptionValue);

}    // namespace option

/** A keyword with its values. */
class Option {
 public:
  /** A value that differs from the one in the restart file is an error; of several words only the
   *  first is compared. */
  Option &keep() { return set(kept, true); }
  /** The same, but only if f() is true when the restart file is written. */
  Option &keep(const std::function<bool()> &f)
  {
    keeps = f;
    return keep();
  }
  /** The keyword must not be given twice. */
  Option &once() { return set(single, true); }
  /** Sets a function that is called each time the values have been read, as a keyword may be given
   *  again for another object. */
  Option &then(const std::function<void()> &f) { return set(after, f); }
  /** Text of the manual for the default, instead of the initial value. */
  Option &standard(const std::string &text) { return set(preset, text); }

  std::string keyword, meaning, preset;
  std::vector<OptionValue> values;

 private:
  friend class Options;
  bool kept = false, single = false;
  int where = -1;    // index of the argument with the keyword, given last
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
  /** command: name of the command in messages, for example fix mpm/dt. */
  explicit Options(std::string command) : command(std::move(command)) {}

  /** Adds a required value. Required values come before all keywords, in the order of their
   *  declaration. */
  void argument(const OptionValue &value) { arguments.push_back(value); }
  /** Adds a keyword. meaning: lines for the manual, in addition to those of the values. */
  Option &add(const std::string &keyword, std::vector<OptionValue>,
              const std::string &meaning = "");

  /** Sets the rules that the input must not break, evaluated after all values have been read. A
   *  rule with a keyword is ignored if this keyword is not in the input. */
  void refuse(const std::function<OptionRules()> &rules) { refusals = rules; }
  /** Sets the rules for warnings(). */
  void warn(const std::function<OptionRules()> &rules) { doubts = rules; }

  /** Reads arguments from iarg up to the end or the word last, and applies the refusals. Returns
   *  the index at which it stopped; throws OptionError. */
  int read(const OptionInput &, int iarg, const std::string &last = "");

  /** Is this word a keyword? */
  bool has(const std::string &keyword) const { return find(keyword) != nullptr; }
  /** Index of the argument with this keyword, or -1 if it was not given. */
  int where(const std::string &keyword) const;
  /** Was this keyword given? */
  bool given(const std::string &keyword) const { return where(keyword) >= 0; }

  /** Messages about valid input that is probably a mistake. */
  std::vector<std::string> warnings() const;

  /** All keywords with their present values, in one line. */
  std::string text() const;
  /** The keywords that a restart file keeps with their present values, one per line. */
  std::string kept() const;
  /** Differences from the text that kept() returned when the restart file was written; empty:
   *  none. */
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

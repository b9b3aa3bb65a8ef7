// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_OPTION_MANUAL_H
#define MPM_TEST_OPTION_MANUAL_H

// Parts of the manual made from declared options: table of keywords, sentence about defaults.

#include "declare/option.h"

#include <algorithm>
#include <cstdio>

namespace MPM_TEST {

using MPM_NS::Option;
using MPM_NS::OptionNote;
using MPM_NS::Options;
using MPM_NS::OptionValue;
using MPM_NS::OptionWord;
using MPM_NS::Range;
using MPM_NS::UNBOUNDED;
using Strings = std::vector<std::string>;

inline std::string format(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

inline std::string join(const Strings &parts, const std::string &separator)
{
  std::string text;
  for (const auto &part : parts)
    if (!part.empty()) text += (text.empty() ? "" : separator) + part;
  return text;
}

/** A range in words: "0 to 1", or "> 0 and <= 1"; empty if unbounded. */
inline std::string interval(const Range &r)
{
  if (r.low != -UNBOUNDED && r.high != UNBOUNDED && r.closed && r.closed_above)
    return format(r.low) + " to " + format(r.high);
  Strings parts;
  if (r.low != -UNBOUNDED) parts.push_back((r.closed ? ">= " : "> ") + format(r.low));
  if (r.high != UNBOUNDED) parts.push_back((r.closed_above ? "<= " : "< ") + format(r.high));
  return join(parts, " and ");
}

/** "name = meaning (unit, interval)" */
inline std::string explain(const OptionNote &note)
{
  const std::string units =
      note.unit.empty() ? "" : (note.unit == "1" ? "unitless" : note.unit + " units");
  const std::string remark = join({units, interval(note.range)}, ", ");
  std::string names = note.names;
  std::replace(names.begin(), names.end(), ' ', ',');
  return names + (names.empty() ? "" : " = ") + note.meaning +
      (remark.empty() ? "" : " (" + remark + ")");
}

inline std::vector<OptionWord> words(const OptionValue &value)
{
  return value.words ? *value.words : std::vector<OptionWord>();
}

/** The form of a value: its name, or the words to choose from; optional ones are in brackets. */
inline std::string usage(const OptionValue &value)
{
  std::string text = value.usage;
  for (const auto &w : words(value)) {
    text += (text.empty() ? "*" : " or *") + w.word + "*";
    for (const auto &inner : w.values) text += " " + usage(inner);
  }
  return value.optional ? "[" + text + "]" : text;
}

/** The lines that explain a value and its words. */
inline Strings lines(const OptionValue &value)
{
  Strings lines_of, together;
  for (const auto &note : value.notes)
    if (!note.meaning.empty()) lines_of.push_back(explain(note));
  for (const auto &w : words(value)) {
    together.push_back("*" + w.word + "*");
    if (!w.meaning.empty()) {
      lines_of.push_back(join(together, ", ") + " = " + w.meaning);
      together.clear();
    }
    for (const auto &inner : w.values)
      for (const auto &line : lines(inner)) {
        const std::string indented = (w.meaning.empty() ? "" : "  ") + line;
        if (std::find(lines_of.begin(), lines_of.end(), indented) == lines_of.end())
          lines_of.push_back(indented);
      }
  }
  return lines_of;
}

/** The lines of an option in the table, after its keyword. */
inline Strings lines(const Option &option)
{
  int count = 0;
  Strings usages, all = {""};
  for (const auto &value : option.values) {
    count += value.count;
    usages.push_back(usage(value));
  }
  all[0] = std::string(" value") + (count > 1 ? "s" : "") + " = " + join(usages, " ");
  if (!option.meaning.empty()) all.push_back("  " + option.meaning);
  for (const auto &value : option.values)
    for (const auto &line : lines(value)) all.push_back("  " + line);
  return all;
}

/** The table of keywords in the syntax of a command. */
inline std::string table(const Options &declared)
{
  const auto &options = declared.all();
  std::string text, line = "* keyword =";
  for (const auto &option : options) {
    const std::string next = (&option == &options.front() ? " *" : " or *") + option.keyword + "*";
    if (line.size() + next.size() > 100) {
      text += line + "\n";
      line = " ";
    }
    line += next;
  }
  text += line + "\n\n  .. parsed-literal::\n\n";
  std::string names;    // of successive options with the same values, which are explained once
  for (std::size_t k = 0; k < options.size(); k++) {
    const Strings mine = lines(options[k]);
    names += (names.empty() ? "*" : ",\\ *") + options[k].keyword + "*";
    if (k + 1 < options.size() && lines(options[k + 1]) == mine) continue;
    for (const auto &one : mine)
      text += "       " + (&one == &mine.front() ? names : "") + one + "\n";
    names.clear();
  }
  return text;
}

/** The sentence about the defaults. */
inline std::string defaults(const Options &declared)
{
  Strings parts;
  for (const auto &option : declared.all())
    if (!option.preset.empty()) parts.push_back("*" + option.keyword + "* = " + option.preset);
  std::string text = parts.size() > 1 ? "The option defaults are" : "The option default is";
  for (std::size_t k = 0; k < parts.size(); k++) {
    const std::string next = " " + std::string(k > 0 && k + 1 == parts.size() ? "and " : "") +
        parts[k] + (k + 1 == parts.size() ? "." : (parts.size() > 2 ? "," : ""));
    const auto start = text.rfind('\n') + 1;    // start of the line; 0 for the first line
    if (text.size() - start + next.size() > 100)
      text += "\n" + next.substr(1);
    else
      text += next;
  }
  return text + "\n";
}

}    // namespace MPM_TEST
#endif

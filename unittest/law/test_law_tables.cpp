// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit docs

// The tables of parameters and history variables in the manual, doc/src/laws/PART_NAME.inc, are
// made from the declarations of the laws. The test compares them with the files; with MPM_WRITE=1
// in the environment it writes the files. That each has its page is tested in test_docs.py.

#include "declare/table_testing.h"
#include "law/law.h"

#include <cctype>
#include <cmath>
#include <cstring>

using namespace MPM_NS;

const char *const PART_NAME[NPARTS] = {"closed",    "eos",    "strength",
                                       "viscosity", "damage", "thermal"};

std::string number(double x)
{
  char text[32];
  snprintf(text, sizeof(text), "%.15g", x);
  return text;
}

/** Text as it is, also when it has characters that mean something to Sphinx. */
std::string plain(const std::string &text)
{
  std::string safe;
  for (const char c : text) {
    if (strchr("\\*`|_", c)) safe += '\\';
    safe += c;
  }
  return safe;
}

std::string allowed(const Range &range)
{
  const std::string equal = range.closed ? "= " : " ";
  if (range.low == -UNBOUNDED && range.high == UNBOUNDED) return "any";
  std::string text;
  if (range.low != -UNBOUNDED) text = ">" + equal + number(range.low);
  if (range.high != UNBOUNDED)
    text += (text.empty() ? "" : " and ") + ("<" + equal + number(range.high));
  return text;
}

std::string unit(const char *kind)
{
  if (strcmp(kind, FLAG) == 0) return "no value";
  if (strcmp(kind, "degrees") == 0) return kind;
  return strcmp(kind, "1") == 0 ? "unitless" : std::string(kind) + " units";
}

/** A list-table; the first row is the header. */
std::string table(const std::vector<std::vector<std::string>> &rows)
{
  std::string text = ".. list-table::\n   :header-rows: 1\n   :widths: auto\n\n";
  for (const auto &row : rows)
    for (size_t k = 0; k < row.size(); k++) {
      std::string line = (k == 0 ? "   * -" : "     -");
      if (!row[k].empty()) line += " " + row[k];
      text += line + "\n";
    }
  return text;
}

std::string parameters(const Parameter *p, int n)
{
  bool options = false, defaults = false;
  for (int k = 0; k < n; k++) {
    options = options || *p[k].option;
    defaults = defaults || !std::isnan(p[k].standard);
  }
  const auto row = [&](const std::string &option, const std::vector<std::string> &others,
                       const std::string &standard) {
    std::vector<std::string> all;
    if (options) all.push_back(option);
    all.insert(all.end(), others.begin(), others.end());
    if (defaults) all.insert(all.end() - 1, standard);
    return all;
  };
  std::vector<std::vector<std::string>> rows = {
      row("keyword", {"value", "units", "range", "meaning"}, "default")};
  for (int k = 0; k < n; k++) {
    const bool optional = !std::isnan(p[k].standard), flag = strcmp(p[k].unit, FLAG) == 0;
    rows.push_back(row(*p[k].option ? "*" + plain(p[k].option) + "*" : "",
                       {flag ? "" : plain(p[k].name), plain(unit(p[k].unit)),
                        flag ? "" : allowed(p[k].range), plain(p[k].meaning)},
                       flag                            ? "off"
                           : !optional                 ? "required"
                           : std::isinf(p[k].standard) ? "none"
                                                       : number(p[k].standard)));
  }
  return table(rows);
}

std::string initial(const LawInfo &info, const HistoryDeclaration &h)
{
  if (h.initial == ZERO) return "0";
  if (h.initial == ONE) return "1";
  if (h.initial == INITIALIZED) return "see above";
  return plain(info.parameters[h.initial].name);
}

std::string history(const LawInfo &info)
{
  std::vector<std::vector<std::string>> rows = {{"name", "units", "initial value", "meaning"}};
  const auto add = [&](const HistoryDeclaration &h, const std::string &suffix) {
    rows.push_back({"*" + plain(h.name) + suffix + "*", plain(unit(h.unit)), initial(info, h),
                    plain(h.meaning)});
  };
  for (int k = 0; k < info.ndeclared; k++) add(info.history[k], "");
  for (int k = 0; k < info.nterm_history; k++) add(info.term_history[k], "K");
  return table(rows);
}

/** What is included in the page of a law. */
std::string contents(const LawInfo &info)
{
  std::string text = ".. made from the declaration of the law by test_law_tables\n\n";
  if (info.nparameters > 0) text += parameters(info.parameters, info.nparameters) + "\n";
  if (info.term)
    text += "*" + plain(info.term) + "* can be given several times, each time with\n\n" +
        parameters(info.term_parameters, info.nterm_parameters) + "\n";
  if (info.nparameters == 0 && !info.term) text += "This law has no parameters.\n\n";
  if (info.ndeclared > 0 || info.nterm_history > 0) {
    text += "History variables";
    if (info.nterm_history > 0)
      text += " (*K* is the number of the *" + plain(info.term) + "*, from 1 on)";
    text += ":\n\n" + history(info);
  } else {
    text += "This law has no history variables.\n";
  }
  return text;
}

/** All files: name without folder, contents. */
std::map<std::string, std::string> files()
{
  std::map<std::string, std::string> all;
  for (int part = 0; part < NPARTS; part++)
    for (const auto &info : declared_laws(static_cast<Part>(part))) {
      std::string name = std::string(PART_NAME[part]) + "_" + info.name + ".inc";
      for (char &c : name)
        if (c == '/') c = '_';
      all[name] = contents(info);
    }
  return all;
}

TEST(LawTables, AreUpToDate)
{
  MPM_TEST::expect_up_to_date("laws", files());
}

// units and meanings are given, in the same words for the same thing

TEST(LawTables, DeclarationsAreComplete)
{
  const std::set<std::string> words = {"1",     "pressure", "density", "velocity", "energy",
                                       "mass",  "time",     FLAG,      "length",   "temperature",
                                       "angle", "force",    "volume",  "degrees",  "N"};
  const auto known = [&](const std::string &unit) {    // products, quotients, powers of these
    std::string word;
    for (const char c : unit + " ") {
      if (isalpha(c) || (c == '1' && word.empty())) {
        word += c;
        continue;
      }
      if (!word.empty() && !words.count(word)) return false;
      word.clear();
      if (!strchr(" */()^-0123456789", c)) return false;
    }
    return !unit.empty();
  };
  for (int part = 0; part < NPARTS; part++)
    for (const auto &info : declared_laws(static_cast<Part>(part))) {
      const std::string law = std::string(PART_NAME[part]) + " " + info.name;
      const auto check = [&](const auto *declared, int n) {
        for (int k = 0; k < n; k++) {
          const auto &d = declared[k];
          EXPECT_GT(strlen(d.name), 0) << law;
          EXPECT_GT(strlen(d.meaning), 0) << law << ": " << d.name;
          EXPECT_TRUE(known(d.unit)) << law << ": " << d.name << " has unit '" << d.unit << "'";
        }
      };
      EXPECT_GT(strlen(info.meaning), 0) << law;
      check(info.parameters, info.nparameters);
      check(info.term_parameters, info.nterm_parameters);
      check(info.history, info.ndeclared);
      check(info.term_history, info.nterm_history);
      for (int k = 0; k < info.nparameters; k++)
        EXPECT_LT(info.parameters[k].range.low, info.parameters[k].range.high) << law << " " << k;
    }
}

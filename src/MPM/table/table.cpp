/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Which reader is for a file; tables in text: comma-separated values, and XYZ.

#include "table/table.h"

#include "table/regular_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

using namespace MPM_NS;

namespace {

constexpr char BLANKS[] = " \t";

/** A file line by line, its words, and its mistakes. */
class Lines {
 public:
  Lines(const std::string &text, const std::string &name) : text(text), name(name) {}

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error(name + ": " + what);
  }
  [[noreturn]] void fail_here(const std::string &what) const
  {
    fail("line " + std::to_string(number) + ": " + what);
  }

  /** The next line, without its end. */
  bool next(std::string &line)
  {
    if (at >= text.size()) return false;
    auto end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    line = text.substr(at, end - at);
    at = end + 1;
    number++;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  }

 private:
  const std::string &text;
  const std::string name;
  std::size_t at = 0;
  int64_t number = 0;
};

/** Words between separators, without blanks and quotes around them; a blank stands for any number
 *  of blanks, and a separator between quotes for itself. */
std::vector<std::string> split(const std::string &line, char separator)
{
  std::vector<std::string> words;
  const std::string ends = separator == ' ' ? BLANKS : std::string(1, separator);
  for (std::size_t at = 0;;) {
    if (separator == ' ') at = std::min(line.find_first_not_of(BLANKS, at), line.size());
    if (separator == ' ' && at == line.size()) return words;
    const auto begin = line.find_first_not_of(BLANKS, at);
    const auto closing = begin != std::string::npos && line[begin] == '"'
        ? line.find('"', begin + 1)
        : std::string::npos;
    const auto end = std::min(line.find_first_of(ends, closing == std::string::npos ? at : closing),
                              line.size());
    std::string word = line.substr(at, end - at);
    const auto from = word.find_first_not_of(BLANKS);
    word = from == std::string::npos ? ""
                                     : word.substr(from, word.find_last_not_of(BLANKS) + 1 - from);
    if (word.size() > 1 && word.front() == '"' && word.back() == '"')
      word = word.substr(1, word.size() - 2);
    words.push_back(word);
    if (end == line.size()) return words;
    at = end + 1;
  }
}

bool is_number(const std::string &word, double &value)
{
  char *end;
  value = strtod(word.c_str(), &end);
  return !word.empty() && *end == '\0';
}

/** Appends a row to the table. Words are for the column of types only. */
class Rows {
 public:
  Rows(Table &table, const Lines &lines) : table(table), lines(lines)
  {
    std::set<std::string> seen;
    for (const auto &column : table.names) {
      if (column.empty()) lines.fail("column " + std::to_string(seen.size() + 1) + " has no name");
      if (!seen.insert(column).second) lines.fail("two columns have the name " + column);
    }
  }

  void add(const std::vector<std::string> &words)
  {
    const auto &names = table.names;
    if (words.size() != names.size())
      lines.fail_here("has " + std::to_string(words.size()) + " values, but there are " +
                      std::to_string(names.size()) + " columns");
    for (std::size_t k = 0; k < words.size(); k++) {
      double value;
      if (!is_number(words[k], value)) {
        if (names[k] != "type" || words[k].empty())
          lines.fail_here("'" + words[k] + "' in column " + names[k] + " is no number");
        const auto found = known.emplace(words[k], (int) known.size());
        if (found.second) table.words.push_back(words[k]);
        value = -1.0 - found.first->second;
      } else if (!std::isfinite(value) || (names[k] == "type" && value < 0.0))
        lines.fail_here("column " + names[k] + " is " + words[k]);
      table.values.push_back(value);
    }
  }

 private:
  Table &table;
  const Lines &lines;
  std::map<std::string, int> known;
};

}    // namespace

/** A line of names, which may begin with #, and a line for each point. */
static Table read_csv(const std::string &text, const std::string &columns, const std::string &name)
{
  Lines lines(text, name);
  Table table;
  std::string line, comment;
  std::vector<std::string> words;
  char separator = ' ';
  bool some = false;
  while (!some && lines.next(line)) {
    if (line.find_first_not_of(BLANKS) == std::string::npos) continue;
    some = line[0] != '#';
    if (!some) comment = line.substr(1);    // numpy.savetxt writes the names in this way
  }
  if (!some) lines.fail("has no lines but comments");
  for (const char c : {',', ';'})
    if (separator == ' ' && line.find(c) != std::string::npos) separator = c;
  words = split(line, separator);
  double value;
  const bool named = std::none_of(words.begin(), words.end(), [&](const auto &w) {
    return is_number(w, value);
  });

  if (named) {
    if (!columns.empty())
      lines.fail(
          "names its columns itself: leave the keyword columns out, and rename some by data");
    table.names = words;
  } else if (!columns.empty())
    table.names = split(columns, ',');
  else if (split(comment, separator).size() == words.size())
    table.names = split(comment, separator);
  else
    lines.fail(
        "does not name its columns: begin it with a line of names, or use the keyword columns");

  Rows rows(table, lines);
  if (!named) rows.add(words);
  while (lines.next(line))
    if (line.find_first_not_of(BLANKS) != std::string::npos && line[0] != '#')
      rows.add(split(line, separator));
  if (table.values.empty()) lines.fail("has names of columns, but no points");
  return table;
}

/** The number of points, a line that may name the columns as extended XYZ does, and a line for
 *  each point. */
/** Properties=species:S:1:pos:R:3:..., in extended XYZ: name, kind, and number of columns of
 *  each. */
static std::vector<std::string> xyz_columns(const std::string &line, const Lines &lines)
{
  const std::string key = "Properties=";
  const auto at = line.find(key);
  if (at == std::string::npos) return {"type", "x", "y", "z"};
  std::string list = line.substr(at + key.size());
  std::replace(list.begin(), list.end(), '"', ' ');
  const auto words = split(list, ' ');
  const auto parts = split(words.empty() ? "" : words[0], ':');
  if (parts.size() % 3) lines.fail("has Properties that are not triples of name, kind, and number");
  std::vector<std::string> names;
  for (std::size_t k = 0; k < parts.size(); k += 3) {
    const int n = atoi(parts[k + 2].c_str());
    if (n < 1 || n > 100) lines.fail("has Properties with " + parts[k + 2] + " columns");
    const std::string name = parts[k] == "pos" ? "Points"
        : parts[k] == "velo"                   ? "velocity"
        : parts[k] == "species"                ? "type"
                                               : parts[k];
    for (int c = 0; c < n; c++) names.push_back(n == 1 ? name : name + ":" + std::to_string(c));
  }
  return names;
}

static Table read_xyz(const std::string &text, const std::string &columns, const std::string &name)
{
  Lines lines(text, name);
  Table table;
  std::string line;
  do lines.next(line);
  while (line.find_first_not_of(BLANKS) == std::string::npos);
  const long long count = strtoll(line.c_str(), nullptr, 10);
  if (!lines.next(line)) lines.fail("ends after its first line");
  table.names = columns.empty() ? xyz_columns(line, lines) : split(columns, ',');
  Rows rows(table, lines);
  long long n = 0;
  while (lines.next(line)) {
    if (line.find_first_not_of(BLANKS) == std::string::npos) continue;
    if (n++ == count)
      lines.fail_here("there is more than the " + std::to_string(count) +
                      " points of the first line: give one frame in a file");
    rows.add(split(line, ' '));
  }
  if (count == 0 && n == 0) lines.fail("has no points");
  if (n < count)
    lines.fail("has " + std::to_string(n) + " points of " + std::to_string(count) + ", it was cut");
  return table;
}

Table MPM_NS::read_table(const std::string &file, const std::string &columns)
{
  if (is_no_file(file)) throw std::runtime_error(file + ": is no file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) throw std::runtime_error(file + ": cannot be read to its end");
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);    // byte order mark of UTF-8
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) throw std::runtime_error(file + ": is empty");

  if (text[first] == '<') {
    if (!columns.empty())
      throw std::runtime_error(file + ": names its columns itself: leave the keyword columns out");
    return read_vtk_points(text, file);
  }
  if (text.find('\0') != std::string::npos)
    throw std::runtime_error(file +
                             ": is no text: expected comma-separated values, XYZ, or a VTK file of "
                             "points (.vtp)");
  if (text.compare(first, 14, "# vtk DataFile") == 0)
    throw std::runtime_error(file + ": is a legacy file of VTK: save it as .vtp");

  // the number of atoms stands alone in the first line of XYZ

  const std::string line = text.substr(first, text.find_first_of("\r\n", first) - first);
  const auto end = line.find_last_not_of(" \t");
  if (line.substr(0, end + 1).find_first_not_of("0123456789") == std::string::npos)
    return read_xyz(text, columns, file);
  return read_csv(text, columns, file);
}

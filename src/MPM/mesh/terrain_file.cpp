/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/terrain_file.h"

#include "mesh/surface_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

using namespace MPM_NS;
using Point = std::array<double, 3>;

static constexpr double MISSING = std::numeric_limits<double>::quiet_NaN();
static constexpr double SAME = 1.0e-6;    // of the width of the terrain: round-off of coordinates

static std::string end_of(const std::string &name)
{
  return name.size() < 4 ? "" : lower_case(name.substr(name.size() - 4));
}

[[noreturn]] static void fail(const std::string &name, const std::string &what)
{
  throw std::runtime_error("File " + name + what);
}

namespace {

/** Heights at the crossings of columns and rows. */
struct Heights {
  std::vector<double> x, y;    // of columns and rows, ascending
  std::vector<double> z;       // [column][row], MISSING where there is none

  double at(std::size_t column, std::size_t row) const { return z[column * y.size() + row]; }
  std::vector<Point> triangles() const;
};

std::vector<Point> Heights::triangles() const
{
  std::vector<Point> soup;
  for (std::size_t i = 0; i + 1 < x.size(); i++)
    for (std::size_t j = 0; j + 1 < y.size(); j++) {
      std::vector<Point> corners;    // counterclockwise from above
      for (const auto &[k, l] : {std::pair(i, j), {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
        if (!std::isnan(at(k, l))) corners.push_back({x[k], y[l], at(k, l)});
      if (corners.size() < 3) continue;
      const bool whole = corners.size() == 4;
      if (whole &&
          std::fabs(corners[1][2] - corners[3][2]) < std::fabs(corners[0][2] - corners[2][2]))
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      soup.insert(soup.end(), {corners[0], corners[1], corners[2]});
      if (whole) soup.insert(soup.end(), {corners[0], corners[2], corners[3]});
    }
  return soup;
}

/** An ESRI ASCII grid: a head of keys with numbers, and heights in rows from north to south. */
class GridReader {
 public:
  GridReader(const std::string &bytes, const std::string &name) :
      at(bytes.c_str()), most(bytes.size()), name(name)
  {
  }
  Heights read();

 private:
  const char *at;
  const std::size_t most;    // numbers that a file of this length can have
  const std::string &name;
  std::map<std::string, double> head;

  void read_head();
  double value(const std::string &key, const std::string &other = "") const;
  std::vector<double> places(char axis) const;
};

void GridReader::read_head()
{
  constexpr const char *KEYS[] = {"ncols",     "nrows",       "xllcorner", "yllcorner",
                                  "xllcenter", "yllcenter",   "cellsize",  "dx",
                                  "dy",        "nodata_value"};
  for (;;) {
    while (isspace((unsigned char) *at)) at++;
    const char *end = at;
    while (*end && !isspace((unsigned char) *end)) end++;
    const std::string key = lower_case(std::string(at, end));
    if (key.empty() || !isalpha((unsigned char) key[0]) || key == "nan") return;
    if (!std::count(std::begin(KEYS), std::end(KEYS), key))
      fail(name, ": '" + key.substr(0, 40) + "' is no key of the head of an ESRI ASCII grid");
    char *after;
    head[key] = strtod(end, &after);
    if (after == end || !std::isfinite(head[key])) fail(name, ": " + key + " needs a number");
    at = after;
  }
}

/** The value of a key, or of another one in its place. */
double GridReader::value(const std::string &key, const std::string &other) const
{
  for (const auto &word : {key, other})
    if (const auto found = head.find(word); found != head.end()) return found->second;
  fail(name, " has no " + key + (other.empty() ? "" : " and no " + other) + " in its head");
}

/** Of columns (x) or rows (y). */
std::vector<double> GridReader::places(char axis) const
{
  const std::string key = axis == 'x' ? "ncols" : "nrows", lower = axis + std::string("llcorner"),
                    center = axis + std::string("llcenter");
  const double n = value(key), cell = value("cellsize", std::string("d") + axis);
  if (!(n >= 2.0 && n <= (double) most) || n != std::floor(n))
    fail(name, ": " + key + " must be two or more, and not more than there are heights");
  if (!(cell > 0.0)) fail(name, ": the size of cells must be positive");
  const double first = value(lower, center) + (head.count(lower) ? 0.5 * cell : 0.0);
  std::vector<double> list((std::size_t) n);
  for (std::size_t k = 0; k < list.size(); k++) list[k] = first + (double) k * cell;
  return list;
}

Heights GridReader::read()
{
  constexpr double NODATA = -9999.0;
  read_head();
  Heights heights = {places('x'), places('y'), {}};
  const std::size_t columns = heights.x.size(), rows = heights.y.size();
  const double none = head.count("nodata_value") ? head.at("nodata_value") : NODATA;
  if (columns > most / rows) fail(name, " is too short for ncols times nrows heights");
  heights.z.resize(columns * rows);
  for (std::size_t j = rows; j-- > 0;)
    for (std::size_t i = 0; i < columns; i++) {
      char *after;
      const double z = strtod(at, &after);
      if (after == at || (*after && !isspace((unsigned char) *after)) || std::isinf(z)) {
        std::ostringstream text;
        text << ": height " << i + 1 << " of row " << rows - j << " (from the north) is "
             << (*at ? "no finite number"
                     : "missing: there are fewer heights than ncols times nrows");
        fail(name, text.str());
      }
      heights.z[i * rows + j] = z == none ? MISSING : z;
      at = after;
    }
  while (isspace((unsigned char) *at)) at++;
  if (*at) fail(name, " has more heights than ncols times nrows");
  return heights;
}

/** Lines of x, y, z in any order. */
class ColumnReader {
 public:
  ColumnReader(const std::string &bytes, const std::string &name) : in(bytes), name(name) {}
  Heights read();

 private:
  std::istringstream in;
  const std::string &name;
  std::vector<Point> points;

  void read_points();
  std::vector<double> places(int axis) const;
};

void ColumnReader::read_points()
{
  std::string text;
  for (int line = 1; std::getline(in, text); line++) {
    text.erase(std::min(text.find('#'), text.size()));
    for (auto &c : text)
      if (c == ',' || c == ';' || c == '\r') c = ' ';
    if (text.find_first_not_of(" \t") == std::string::npos) continue;
    const char *at = text.c_str();
    Point x;
    bool good = true;
    for (double &coordinate : x) {
      char *after;
      coordinate = strtod(at, &after);
      good = good && after != at && std::isfinite(coordinate);
      at = after;
    }
    if (!good || *(at + strspn(at, " \t")))
      fail(name, " line " + std::to_string(line) + ": needs three finite numbers, x, y, and z");
    points.push_back(x);
  }
}

/** The different coordinates along an axis, apart from round-off. */
std::vector<double> ColumnReader::places(int axis) const
{
  std::vector<double> all;
  for (const auto &x : points) all.push_back(x[axis]);
  std::sort(all.begin(), all.end());
  const double same = SAME * (all.back() - all.front());
  std::vector<double> list;
  for (const double x : all)
    if (list.empty() || x - list.back() > same) list.push_back(x);
  return list;
}

Heights ColumnReader::read()
{
  constexpr std::size_t SPARSE = 4;    // places for each height, at most
  read_points();
  if (points.empty()) fail(name, " has no heights");
  Heights heights = {places(0), places(1), {}};
  const std::size_t columns = heights.x.size(), rows = heights.y.size();
  if (columns < 2 || rows < 2) fail(name, ": heights must be in two columns and rows at least");
  if (columns > SPARSE * points.size() / rows) {
    std::ostringstream text;
    text << ": its " << points.size() << " heights have " << columns << " different x and " << rows
         << " different y, so that they are not at the crossings of columns and rows: make "
            "triangles of them elsewhere, and use an STL file";
    fail(name, text.str());
  }
  heights.z.assign(columns * rows, MISSING);
  const auto index = [](const std::vector<double> &list, double x) {
    const double same = SAME * (list.back() - list.front());
    return (std::size_t)(std::lower_bound(list.begin(), list.end(), x - same) - list.begin());
  };
  for (const auto &x : points) {
    double &z = heights.z[index(heights.x, x[0]) * rows + index(heights.y, x[1])];
    if (!std::isnan(z) && z != x[2]) {
      std::ostringstream text;
      text << " has two heights at " << x[0] << " " << x[1] << ": " << z << " and " << x[2];
      fail(name, text.str());
    }
    z = x[2];
  }
  return heights;
}

}    // namespace

bool MPM_NS::is_terrain(const std::string &name)
{
  return end_of(name) == ".asc" || end_of(name) == ".xyz";
}

std::vector<Point> MPM_NS::read_terrain(const std::string &bytes, const std::string &name)
{
  const Heights heights = end_of(name) == ".asc" ? GridReader(bytes, name).read()
                                                 : ColumnReader(bytes, name).read();
  auto soup = heights.triangles();
  if (soup.empty()) fail(name, " has no three heights next to each other");
  return soup;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/surface_file.h"

#include "mesh/terrain_file.h"
#include "mesh/vector3.h"

#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

using namespace MPM_NS;
using namespace MPM_NS::vector3;
using Point = std::array<double, 3>;

[[noreturn]] static void fail(const std::string &name, const std::string &what)
{
  throw std::runtime_error("File " + name + what);
}

std::string MPM_NS::lower_case(std::string text)
{
  for (auto &c : text) c = (char) tolower((unsigned char) c);
  return text;
}

static std::vector<Point> read_stl(const std::string &bytes, const std::string &name)
{
  std::vector<Point> soup;
  constexpr std::size_t HEAD = 84, EACH = 50;
  uint32_t n = 0;
  const bool has_head = bytes.size() >= HEAD;
  if (has_head) memcpy(&n, bytes.data() + 80, 4);
  if (has_head && bytes.size() == HEAD + EACH * (std::size_t) n) {
    soup.reserve(3 * (std::size_t) n);
    for (std::size_t t = 0; t < n; t++)
      for (int c = 0; c < 3; c++) {
        float x[3];
        memcpy(x, bytes.data() + HEAD + EACH * t + 12 * (c + 1), 12);
        soup.push_back({x[0], x[1], x[2]});
      }
    return soup;
  }
  const bool is_text = lower_case(bytes.substr(0, 5)) == "solid";
  const auto fail_as_binary = [&]() {
    std::ostringstream text;
    text << " is no STL file: it "
         << (is_text ? "begins with 'solid' but has no vertex" : "does not begin with 'solid'")
         << ", and its length is not that of a binary one";
    if (has_head)
      text << ", which has " << HEAD + EACH * (uint64_t) n << " bytes for the " << n
           << " triangles of its head, and not " << bytes.size();
    fail(name, text.str());
  };
  if (!is_text) fail_as_binary();
  std::istringstream in(bytes);
  std::string word;
  bool ended = false;
  while (in >> word) {
    word = lower_case(word);
    ended = ended || word == "endsolid";
    if (word != "vertex") continue;
    ended = false;
    Point x;
    if (!(in >> x[0] >> x[1] >> x[2]))
      fail(name, ": vertex " + std::to_string(soup.size() + 1) + " has no three coordinates");
    soup.push_back(x);
  }
  if (soup.empty() && !ended) fail_as_binary();
  if (soup.size() % 3 != 0) fail(name, ": the last triangle has no three corners");
  if (!ended) fail(name, " ends without 'endsolid', it may have been cut short");
  return soup;
}

namespace {

/** One line of an OBJ file at a time. */
class ObjReader {
 public:
  ObjReader(const std::string &bytes, const std::string &name) : in(bytes), name(name) {}

  std::vector<Point> read()
  {
    std::string text, more;
    while (std::getline(in, text)) {
      line++;
      while (!text.empty() && (text.back() == '\r' || text.back() == '\\')) {
        const bool goes_on = text.back() == '\\';
        text.pop_back();
        if (goes_on && std::getline(in, more)) {
          line++;
          text += more;
        }
      }
      std::istringstream words(text.substr(0, text.find('#')));
      std::string word;
      if (!(words >> word)) continue;
      if (word == "v")
        vertex(words);
      else if (word == "f")
        face(words);
      else if (!is_known(word))
        fail("'" + word + "' is no statement of an OBJ file");
    }
    return soup;
  }

 private:
  std::istringstream in;
  std::string name;
  int line = 0;
  std::vector<Point> vertices, soup;

  [[noreturn]] void fail(const std::string &what) const
  {
    throw std::runtime_error("File " + name + " line " + std::to_string(line) + ": " + what);
  }

  /** What is no part of a surface of polygons, or says how it is drawn. */
  static bool is_known(const std::string &word)
  {
    for (const char *known : {"vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "l", "p", "mg"})
      if (word == known) return true;
    return false;
  }

  void vertex(std::istringstream &words)
  {
    Point x;
    for (auto &value : x) {
      std::string word;
      char *end = nullptr;
      if (words >> word) value = strtod(word.c_str(), &end);
      if (!end || *end || !std::isfinite(value)) fail("a vertex needs three finite coordinates");
    }
    vertices.push_back(x);
  }

  void face(std::istringstream &words)
  {
    std::vector<Point> polygon;
    std::string word;
    while (words >> word) {    // vertex/texture/normal
      char *end;
      const long long k = strtoll(word.c_str(), &end, 10), n = (long long) vertices.size();
      if (end == word.c_str() || (*end && *end != '/')) fail("'" + word + "' is no vertex");
      const long long index = k < 0 ? n + k : k - 1;    // from the last one backward, or from one
      if (index < 0 || index >= n)
        fail("there is no vertex " + std::to_string(k) + ", the file has " + std::to_string(n) +
             " so far");
      polygon.push_back(vertices[index]);
    }
    if (polygon.size() < 3) fail("a face needs three vertices at least");
    triangulate(polygon);
  }

  /** All triangles around a corner, if there is one from which all look to the side of the
   *  polygon. */
  void triangulate(const std::vector<Point> &p)
  {
    const std::size_t n = p.size();
    Point all = {0.0, 0.0, 0.0};
    for (std::size_t k = 1; k + 1 < n; k++) all = all + cross(p[k] - p[0], p[k + 1] - p[0]);
    for (std::size_t first = 0; first < n; first++) {
      const auto at = [&](std::size_t k) {
        return p[(first + k) % n];
      };
      bool same = true;
      for (std::size_t k = 1; k + 1 < n && n > 3; k++)
        same = same && dot(cross(at(k) - at(0), at(k + 1) - at(0)), all) >= 0.0;
      if (!same) continue;
      for (std::size_t k = 1; k + 1 < n; k++)
        for (const auto &x : {at(0), at(k), at(k + 1)}) soup.push_back(x);
      return;
    }
    fail("the polygon is not convex: triangulate it where the file is made");
  }
};

}    // namespace

std::vector<Point> MPM_NS::read_surface(const std::string &bytes, const std::string &name)
{
  const std::string end = name.size() < 4 ? "" : lower_case(name.substr(name.size() - 4));
  if (bytes.empty()) fail(name, " is empty");
  if (is_terrain(name)) return read_terrain(bytes, name);
  auto soup = end == ".obj" ? ObjReader(bytes, name).read() : read_stl(bytes, name);
  if (soup.empty()) fail(name, " has no triangles");
  return soup;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/surface_mesh.h"

#include "math/sets.h"
#include "mesh/surface_file.h"
#include "mesh/vector3.h"
#include "mesh/winding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

using namespace MPM_NS;
using namespace MPM_NS::vector3;
using Point = SurfaceMesh::Point;

static double square_of_distance(const Point &x, const Point &lo, const Point &hi)
{
  double sum = 0.0;
  for (int d = 0; d < 3; d++) {
    const double out = std::max(0.0, std::max(lo[d] - x[d], x[d] - hi[d]));
    sum += out * out;
  }
  return sum;
}

namespace {

std::string describe(const Point &x)
{
  std::ostringstream text;
  text << x[0] << " " << x[1] << " " << x[2];
  return text.str();
}

/** Farther than anything, and its square is still a number. */
constexpr double FAR_AWAY = 1.0e150;
/** Sets with numbers, in the order in which they are asked for. */
struct NumberedSets : Sets {
  std::map<int, int> numbers;

  using Sets::Sets;
  int number(int i) { return numbers.emplace(root(i), (int) numbers.size()).first->second; }
};
}    // namespace

SurfaceMesh::SurfaceMesh(const std::string &bytes, const std::string &name, double scale,
                         const Point &shift, const SurfaceOptions &options)
{
  std::vector<Point> soup = read_surface(bytes, name);
  for (auto &x : soup) {
    Point turned = {0.0, 0.0, 0.0};
    for (int d = 0; d < 3; d++)
      for (int e = 0; e < 3; e++) turned[d] += options.turn[d][e] * x[e];
    x = scale * turned + shift;
    if (!std::isfinite(x[0] + x[1] + x[2]))
      throw std::runtime_error("File " + name + " has a corner that is not finite");
  }
  lo = hi = soup[0];
  for (const auto &x : soup) include(x, lo, hi);
  weld(soup, name);
  if (triangles.empty())
    throw std::runtime_error(
        "File " + name +
        " has no triangles but slivers: all have corners closer than 1e-6 of the "
        "distance between the farthest ones");
  if (options.leaky)
    patch();
  else
    check_edges(name, options.open);
  open = !rim.empty();
  integrate();
  if (open) {    // encloses nothing
    volume = NAN;
    center.fill(NAN);
    std::fill_n(inertia, 6, NAN);
  } else if (volume < 0.0) {    // turned inside out
    for (auto &t : triangles) std::swap(t.corner[1], t.corner[2]);
    integrate();
  }
  normals();
  if (options.leaky) {
    for (auto &t : triangles) t.part = 0;
    nparts = 1;
    find_winding(name);
  } else
    find_parts();
  tree.reserve(2 * triangles.size());
  build(0, (int) triangles.size());
  if (!options.leaky) {
    around.resize(corners.size());
    for (int i = 0; i < (int) triangles.size(); i++)
      for (const int c : triangles[i].corner) around[c].push_back(i);
    if (!open) check_shells(name);
  }
  make_coarse();
}

SurfaceMesh::~SurfaceMesh() = default;

std::array<Point, 3> SurfaceMesh::places(const Triangle &t) const
{
  return {corners[t.corner[0]], corners[t.corner[1]], corners[t.corner[2]]};
}

std::vector<std::array<Point, 3>> SurfaceMesh::soup() const
{
  std::vector<std::array<Point, 3>> all;
  for (const auto &t : triangles) all.push_back(places(t));
  return all;
}

/** As a surface without boundary, with which volume and winding numbers are those of a body. */
void SurfaceMesh::patch()
{
  std::vector<std::array<int, 3>> numbers;
  for (const auto &t : triangles) numbers.push_back(t.corner);
  holes = patch_surface(corners, numbers);
  triangles.assign(numbers.size(), Triangle());
  for (std::size_t i = 0; i < numbers.size(); i++) triangles[i].corner = numbers[i];
}

void SurfaceMesh::find_winding(const std::string &name)
{
  double area = 0.0;
  for (const auto &[a, b, c] : soup()) area += 0.5 * norm(cross(b - a, c - a));
  if (!(2.0 * volume > near * area))
    throw std::runtime_error("The surface of file " + name +
                             " has no volume inside of it, also with patches on its holes");
  winding = std::make_unique<WindingNumber>(soup());
}

/** Corners at the same place become one; triangles without area go. */
void SurfaceMesh::weld(const std::vector<Point> &soup, const std::string &name)
{
  near = 1.0e-6 * norm(hi - lo);
  if (!(near > 0.0)) throw std::runtime_error("File " + name + ": all corners are at one place");

  std::unordered_map<uint64_t, std::vector<int>> places;    // corners by cells of the size near
  const auto key = [&](const Point &x, const int *step) {
    uint64_t k = 0;    // 1e6 cells and a margin: 21 bits an axis
    for (int d = 0; d < 3; d++)
      k = k << 21 | (uint64_t) (std::floor((x[d] - lo[d]) / near) + step[d] + 1);
    return k;
  };
  std::vector<int> number(soup.size());
  for (std::size_t i = 0; i < soup.size(); i++) {
    int found = -1;
    for (int c = 0; c < 27 && found < 0; c++) {
      const int step[3] = {c / 9 - 1, c / 3 % 3 - 1, c % 3 - 1};
      const auto there = places.find(key(soup[i], step));
      if (there == places.end()) continue;
      for (const int k : there->second) {
        const Point d = corners[k] - soup[i];
        if (dot(d, d) <= near * near) found = k;
      }
    }
    if (found < 0) {
      const int step[3] = {0, 0, 0};
      found = (int) corners.size();
      corners.push_back(soup[i]);
      places[key(soup[i], step)].push_back(found);
    }
    number[i] = found;
  }
  for (std::size_t i = 0; i + 2 < number.size(); i += 3) {
    Triangle t;
    const auto &[a, b, c] = t.corner = {number[i], number[i + 1], number[i + 2]};
    if (a != b && b != c && c != a) triangles.push_back(t);
  }
}

/** Each edge must belong to two triangles that run along it in opposite directions, or, at the rim
 *  of an open surface, to one. */
void SurfaceMesh::check_edges(const std::string &name, bool may_be_open)
{
  std::map<std::pair<int, int>, int> edges;
  for (const auto &t : triangles)
    for (int c = 0; c < 3; c++) edges[{t.corner[c], t.corner[(c + 1) % 3]}]++;
  std::size_t wrong = 0;
  Point example = {0.0, 0.0, 0.0};
  for (const auto &[ends, times] : edges) {
    const auto back = edges.find({ends.second, ends.first});
    const Point middle = 0.5 * (corners[ends.first] + corners[ends.second]);
    if (times == 1 && back != edges.end() && back->second == 1) continue;
    if (times == 1 && back == edges.end() && may_be_open) {
      rim.push_back(middle);
      continue;
    }
    wrong++;
    example = middle;
  }
  if (!wrong) return;
  const std::string which = std::to_string(wrong) + " of " + std::to_string(edges.size()) +
      " edges, one of them at " + describe(example) + "; ";
  if (may_be_open)
    throw std::runtime_error(
        "The surface of file " + name +
        " has neighbors that look to different sides, or edges of more than two triangles: " +
        which +
        "turn the triangles to one side where the mesh is made, or, of a region that is filled "
        "with points and is no wall, fill it as it is (surface leaky)");
  throw std::runtime_error(
      "The surface of file " + name +
      " is not closed, or its triangles do not all look outward: " + which +
      "close the mesh, or use it as terrain that has matter behind it (surface open), or, of a "
      "region that is filled with points and is no wall, fill it as it is (surface leaky)");
}

/** Volume, center, inertia: sums over the tetrahedra of the triangles and one point. */
void SurfaceMesh::integrate()
{
  const Point origin = 0.5 * (lo + hi);
  double first[3] = {0.0, 0.0, 0.0}, second[3][3] = {{0.0}};
  volume = 0.0;
  for (const auto &t : triangles) {
    auto p = places(t);
    for (auto &x : p) x = x - origin;
    const double V = dot(p[0], cross(p[1], p[2])) / 6.0;
    volume += V;
    for (int i = 0; i < 3; i++) {
      const double sum = p[0][i] + p[1][i] + p[2][i];
      first[i] += V * sum / 4.0;
      for (int j = 0; j < 3; j++) {
        double products = sum * (p[0][j] + p[1][j] + p[2][j]);
        for (int c = 0; c < 3; c++) products += p[c][i] * p[c][j];
        second[i][j] += V * products / 20.0;
      }
    }
  }
  Point c;
  for (int i = 0; i < 3; i++) c[i] = first[i] / volume;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) second[i][j] -= volume * c[i] * c[j];
  center = origin + c;
  for (int i = 0; i < 3; i++) {
    inertia[i] = second[(i + 1) % 3][(i + 1) % 3] + second[(i + 2) % 3][(i + 2) % 3];
    inertia[3 + i] = -second[i == 2 ? 1 : 0][i == 0 ? 1 : 2];
  }
}

void SurfaceMesh::normals()
{
  corner_normals.assign(corners.size(), {0.0, 0.0, 0.0});
  for (auto &t : triangles) {
    const auto p = places(t);
    const Point n = cross(p[1] - p[0], p[2] - p[0]);
    const double length = norm(n);
    t.normal = (length > 0.0 ? 1.0 / length : 0.0) * n;
    for (int c = 0; c < 3; c++) {
      const Point a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
      const double angle = std::atan2(norm(cross(a, b)), dot(a, b));
      auto &corner = corner_normals[t.corner[c]];
      corner = corner + angle * t.normal;
    }
  }
}

/** Normals of edges, and parts of the surface that hang together, without crossing a sharp edge or
 *  at all. */
void SurfaceMesh::find_parts()
{
  const double sharp = std::sqrt(0.5);
  NumberedSets parts(triangles.size()), shells(triangles.size());
  std::map<std::pair<int, int>, int> edges;
  for (int i = 0; i < (int) triangles.size(); i++)
    for (int c = 0; c < 3; c++)
      edges[{triangles[i].corner[c], triangles[i].corner[(c + 1) % 3]}] = i;
  for (int i = 0; i < (int) triangles.size(); i++)
    for (int c = 0; c < 3; c++) {
      auto &t = triangles[i];
      const auto across = edges.find({t.corner[(c + 1) % 3], t.corner[c]});
      if (across == edges.end()) {    // the rim of an open surface
        t.edge_normal[c] = t.normal;
        continue;
      }
      const int j = across->second;
      t.edge_normal[c] = t.normal + triangles[j].normal;
      if (dot(t.normal, triangles[j].normal) > sharp) parts.join(i, j);
      shells.join(i, j);
    }
  for (int i = 0; i < (int) triangles.size(); i++) {
    triangles[i].part = parts.number(i);
    shell_of.resize(parts.numbers.size());
    shell_of[triangles[i].part] = shells.number(i);
  }
  nparts = (int) parts.numbers.size();
}

std::vector<SurfaceMesh::Shell> SurfaceMesh::find_shells() const
{
  const Point origin = 0.5 * (lo + hi);
  std::vector<Shell> shells(1 + *std::max_element(shell_of.begin(), shell_of.end()));
  for (int i = 0; i < (int) triangles.size(); i++) {
    Shell &shell = shells[shell_of[triangles[i].part]];
    const auto p = places(triangles[i]);
    if (shell.triangles.empty()) shell.lo = shell.hi = p[0];
    for (const auto &x : p) include(x, shell.lo, shell.hi);
    const Point out = cross(p[1] - p[0], p[2] - p[0]);
    shell.volume += dot(p[0] - origin, out) / 6.0;
    shell.area += 0.5 * norm(out);
    shell.triangles.push_back(i);
  }
  return shells;
}

/** Volumes add up, and the sign of the closest triangle tells inside from outside, only if closed
 *  parts do not reach into each other and look outward, or inward as the walls of cavities. */
void SurfaceMesh::check_shells(const std::string &name) const
{
  const auto shells = find_shells();
  for (const auto &shell : shells) {
    const auto at = describe(corners[triangles[shell.triangles[0]].corner[0]]);
    if (!(2.0 * std::fabs(shell.volume) > near * shell.area))
      throw std::runtime_error("The surface of file " + name +
                               " has a closed part without volume, at " + at);
    int depth = 0;    // in others that look outward, less those that look inward
    for (const auto &other : shells)
      if (&other != &shell && is_inside(shell, other, name)) depth += other.volume > 0.0 ? 1 : -1;
    if (depth == (shell.volume > 0.0 ? 0 : 1)) continue;
    throw std::runtime_error("The surface of file " + name + " has a closed part, at " + at +
                             (shell.volume > 0.0
                                  ? ", that is inside of another one and looks outward"
                                  : ", that looks inward and is not the wall of a cavity") +
                             ": turn its triangles, remove it, or fill what winds around places "
                             "(surface leaky)");
  }
}

/** Is a closed part inside of another one? Its edges are followed in steps as long as the distance.
 *  What is known of a corner, a distance that it has at least, with the sign, tells of edges that
 *  are shorter. */
bool SurfaceMesh::is_inside(const Shell &shell, const Shell &other, const std::string &name) const
{
  const auto elsewhere = [&](const Point &low, const Point &high) {
    for (int d = 0; d < 3; d++)
      if (low[d] > other.hi[d] || high[d] < other.lo[d]) return true;
    return false;
  };
  if (elsewhere(shell.lo, shell.hi)) return false;
  const int number = shell_of[triangles[other.triangles[0]].part];
  const auto skip = [&](int part) {
    return shell_of[part] != number;
  };
  const double least_step = 1.0e3 * near;
  std::unordered_map<int, double> known;
  bool inside = false, outside = false;
  for (const int i : shell.triangles)
    for (int c = 0; c < 3; c++) {
      const int first = triangles[i].corner[c], last = triangles[i].corner[(c + 1) % 3];
      if (first > last) continue;    // the triangle on the other side has it
      const Point &a = corners[first], &b = corners[last];
      Point low = a, high = a, closest;
      include(b, low, high);
      const double length = norm(b - a);
      if (elsewhere(low, high)) {
        outside = true;
        continue;
      }
      double &at_a = known[first], &at_b = known[last];
      const double rest_a = std::fabs(at_a) - length, rest_b = std::fabs(at_b) - length;
      if (rest_a > std::fabs(at_b)) at_b = std::copysign(rest_a, at_a);
      if (rest_b > std::fabs(at_a)) at_a = std::copysign(rest_b, at_b);
      if (rest_a > 0.0 || rest_b > 0.0) continue;
      for (double t = 0.0;;) {
        const Point x = a + (t / length) * (b - a);
        const double d =
            (other.volume > 0.0 ? 1.0 : -1.0) * distance_to(x, FAR_AWAY, closest, skip);
        inside = inside || d < -near;
        outside = outside || d > near;
        if (inside && outside)
          throw std::runtime_error(
              "The surface of file " + name +
              " has closed parts that reach into each other, near " + describe(x) +
              ": unite them to one where the mesh is made, or fill both (surface leaky)");
        if (t == 0.0) at_a = d;
        if (t == length) at_b = d;
        if (t == length) break;
        t = std::min(length, t + std::max(std::fabs(d), least_step));
      }
    }
  return inside;
}

/** Tree of boxes over the triangles [first,last), halves by the longest axis of their centers. */
int SurfaceMesh::build(int first, int last)
{
  constexpr int LEAF = 4;
  const int me = (int) tree.size();
  tree.push_back(Node());
  const auto center_of = [&](const Triangle &t) {    // times 3
    return corners[t.corner[0]] + corners[t.corner[1]] + corners[t.corner[2]];
  };
  Node node;
  Point low = center_of(triangles[first]), high = low;
  node.lo = node.hi = corners[triangles[first].corner[0]];
  for (int i = first; i < last; i++) {
    include(center_of(triangles[i]), low, high);
    for (const int c : triangles[i].corner) include(corners[c], node.lo, node.hi);
  }
  node.first = first;
  node.last = last;
  node.part = triangles[first].part;
  for (int i = first; i < last; i++)
    if (triangles[i].part != node.part) node.part = -1;
  if (last - first > LEAF) {
    const int middle = halve(triangles, first, last, low, high, center_of);
    node.last = -1;
    node.child[0] = build(first, middle);
    node.child[1] = build(middle, last);
  }
  tree[me] = node;
  return me;
}

/** Closest point of a triangle (a, b, c) to x; feature: 0 face, 1 to 3 edges ab, bc, ca, 4 to 6
 *  corners. The regions of the plane are told apart by the signs of barycentric products. */
Point SurfaceMesh::closest_on(const Triangle &t, const Point &x, int &feature) const
{
  const Point &a = corners[t.corner[0]], &b = corners[t.corner[1]], &c = corners[t.corner[2]];
  const Point ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = dot(ab, ax), d2 = dot(ac, ax), d3 = dot(ab, bx), d4 = dot(ac, bx),
               d5 = dot(ab, cx), d6 = dot(ac, cx);
  feature = 4;
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  feature = 5;
  if (d3 >= 0.0 && d4 <= d3) return b;
  feature = 6;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  feature = 1;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;
  feature = 2;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  feature = 3;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;
  feature = 0;
  const double inverse = 1.0 / (va + vb + vc);
  return a + (vb * inverse) * ab + (vc * inverse) * ac;
}

/** Calls visit(triangle, its closest point, feature, square of its distance) for triangles in boxes
 *  whose square of the distance is below limit, near ones first, but not for those of parts where
 *  skip(part) is true; visit() may lower the limit. */
template <class Skip, class Visit>
void SurfaceMesh::search(const Point &x, double &limit, Skip &&skip, Visit &&visit) const
{
  const auto to_box = [&](const Node &node) {
    return square_of_distance(x, node.lo, node.hi);
  };
  int stack[64], depth = 0;
  stack[depth++] = 0;
  while (depth) {
    const Node &node = tree[stack[--depth]];
    if (to_box(node) >= limit || (node.part >= 0 && skip(node.part))) continue;
    if (node.last < 0) {
      const bool swap = to_box(tree[node.child[0]]) < to_box(tree[node.child[1]]);
      stack[depth++] = node.child[swap];    // the nearer one is looked at first
      stack[depth++] = node.child[!swap];
      continue;
    }
    for (int i = node.first; i < node.last; i++) {
      const Triangle &t = triangles[i];
      if (skip(t.part)) continue;
      int feature;
      const Point p = closest_on(t, x, feature);
      const Point r = x - p;
      const double square = dot(r, r);
      if (square < limit) visit(t, p, feature, square);
    }
  }
}

/** Normal for the sign of a distance from a face, edge, or corner: its length has no meaning. */
const Point &SurfaceMesh::mean_normal(const Triangle &t, int feature) const
{
  return feature == 0 ? t.normal
      : feature < 4   ? t.edge_normal[feature - 1]
                      : corner_normals[t.corner[feature - 4]];
}

static const auto no_part = [](int) {
  return false;
};

/** limit: the square of the distance is known to be less. */
template <class Skip>
double SurfaceMesh::distance_to(const Point &x, double limit, Point &closest, Skip &&skip) const
{
  double smallest = limit, side = 1.0;
  search(x, smallest, skip, [&](const Triangle &t, const Point &p, int feature, double square) {
    smallest = square;
    closest = p;
    side = dot(x - p, mean_normal(t, feature));
  });
  return side < 0.0 ? -std::sqrt(smallest) : std::sqrt(smallest);
}

double SurfaceMesh::distance(const Point &x, Point &closest) const
{
  const double limit = most(x);
  return distance_to(x, limit * limit, closest, no_part);
}

double SurfaceMesh::distance_within(const Point &x, double cutoff, Point &closest, int &start) const
{
  const double known = bound(x);
  if (std::fabs(known) >= cutoff) return std::copysign(cutoff, known);
  double smallest = cutoff * cutoff;
  if (start >= 0) {
    int unused;
    const Point r = x - closest_on(triangles[start], x, unused);
    // the tree comes to this triangle again, unless another one is closer
    smallest = std::min(smallest, dot(r, r) * (1.0 + 1.0e-9) + 1.0e-3 * near * near);
  }
  bool found = false;
  double side = known;
  search(x, smallest, no_part, [&](const Triangle &t, const Point &p, int feature, double square) {
    found = true;
    smallest = square;
    closest = p;
    start = (int) (&t - triangles.data());
    side = dot(x - p, mean_normal(t, feature));
  });
  if (!found && side == 0.0) {
    Point unused;
    side = distance(x, unused);
  }
  const double d = found ? std::sqrt(smallest) : cutoff;
  return side < 0.0 ? -d : d;
}

double SurfaceMesh::distance_and_normal(const Point &x, Point &normal) const
{
  struct Candidate {
    const Triangle *triangle;
    Point point;
    double square;
  };
  static std::vector<Candidate> candidates;    // no memory is asked for at each call
  candidates.clear();
  const double farthest = most(x);
  double smallest = FAR_AWAY * FAR_AWAY, side = 1.0;
  double limit = (farthest + near) * (farthest + near);
  search(x, limit, no_part, [&](const Triangle &t, const Point &p, int feature, double square) {
    if (square < smallest) {
      smallest = square;
      side = dot(x - p, mean_normal(t, feature)) < 0.0 ? -1.0 : 1.0;
      limit = (std::sqrt(square) + near) * (std::sqrt(square) + near);
    }
    candidates.push_back({&t, p, square});
  });

  const double d = std::sqrt(smallest);
  std::vector<Point> found;
  normal = {0.0, 0.0, 0.0};
  for (const auto &c : candidates) {
    if (!(c.square < limit)) continue;
    Point out = d > near ? side * (x - c.point) : c.triangle->normal;
    const double size = norm(out);
    if (!(size > 0.0)) continue;    // a sliver
    out = (1.0 / size) * out;
    // triangles of one face, or with a common edge or corner
    if (std::any_of(found.begin(), found.end(), [&](const Point &other) {
          return dot(out - other, out - other) < 1.0e-12;
        }))
      continue;
    found.push_back(out);
    normal = normal + out;
  }
  const double length = norm(normal), least = 1.0e-3 * (double) found.size();
  normal = (length > least ? 1.0 / length : 0.0) * normal;
  return side * d;
}

/** Is no triangle at this edge or corner of t closer to x than that is? */
bool SurfaceMesh::is_closest_around(const Point &x, const Triangle &t, int feature,
                                    double square) const
{
  if (feature == 0) return true;
  const int c = t.corner[(feature - 1) % 3], other = feature < 4 ? t.corner[feature % 3] : c;
  for (const int k : around[c]) {
    const auto &corner = triangles[k].corner;
    if (std::count(corner.begin(), corner.end(), other) == 0) continue;
    int unused;
    const Point r = x - closest_on(triangles[k], x, unused);
    if (dot(r, r) < square * (1.0 - 1.0e-9)) return false;
  }
  return true;
}

int SurfaceMesh::closest_points(const Point &x, double cutoff, ClosestPoint *list, int most) const
{
  int n = 0;
  double side = 0.0;        // not known yet
  std::vector<int> done;    // parts
  const auto skip = [&](int part) {
    return std::find(done.begin(), done.end(), part) != done.end();
  };
  while (n < most && (int) done.size() < nparts) {
    double smallest = cutoff * cutoff;
    const Triangle *triangle = nullptr;
    ClosestPoint closest;
    int at = 0;
    search(x, smallest, skip, [&](const Triangle &t, const Point &p, int feature, double square) {
      const double out = dot(x - p, mean_normal(t, feature));
      if (n > 0 && !(side * out > 0.0)) return;    // the far side of a plate
      if (n == 0) side = out < 0.0 ? -1.0 : 1.0;
      smallest = square;
      triangle = &t;
      at = feature;
      closest = {p, side * std::sqrt(square), t.part};
    });
    if (!triangle) break;
    done.push_back(triangle->part);
    bool is_new = is_closest_around(x, *triangle, at, smallest);
    for (int k = 0; k < n; k++) {    // a common edge or corner
      const Point r = closest.point - list[k].point;
      if (dot(r, r) <= near * near) is_new = false;
    }
    if (is_new) list[n++] = closest;
  }
  return n;
}

/** Coarse grid over the box of the body. */
void SurfaceMesh::make_coarse()
{
  constexpr int CELLS = 32;    // along the longest axis
  cell = 0.0;
  for (int d = 0; d < 3; d++) cell = std::max(cell, (hi[d] - lo[d]) / CELLS);
  for (int d = 0; d < 3; d++) ncells[d] = 1 + (int) ((hi[d] - lo[d]) / cell);
  coarse.resize((std::size_t) ncells[0] * ncells[1] * ncells[2]);
  std::size_t n = 0;
  for (int i = 0; i < ncells[0]; i++)
    for (int j = 0; j < ncells[1]; j++)
      for (int k = 0; k < ncells[2]; k++) {
        Point closest;
        const Point c = {lo[0] + (i + 0.5) * cell, lo[1] + (j + 0.5) * cell,
                         lo[2] + (k + 0.5) * cell};
        // the center before is a cell away
        const double limit = k ? 1.001 * (std::abs((double) coarse[n - 1]) + cell) : FAR_AWAY;
        double d = distance_to(c, limit * limit, closest, no_part);
        // the surface is farther from the center before than that is from this one
        const bool same = k && std::fabs((double) coarse[n - 1]) > 1.001 * cell;
        if (winding && same) d = std::copysign(d, (double) coarse[n - 1]);
        if (winding && !same) {
          const double turns = (*winding)(c);
          overlaps = overlaps || turns > 1.5 || turns < -0.5;
          d = turns > 0.5 ? -std::fabs(d) : std::fabs(d);
        }
        coarse[n++] = (float) d;
      }
}

int SurfaceMesh::coarse_cell(const Point &x, Point &center) const
{
  int index = 0;
  for (int d = 0; d < 3; d++) {
    const double t = (x[d] - lo[d]) / cell;
    if (!(t >= 0.0 && t < ncells[d])) return -1;
    const int i = (int) t;
    center[d] = lo[d] + (i + 0.5) * cell;
    index = index * ncells[d] + i;
  }
  return index;
}

double SurfaceMesh::bound(const Point &x) const
{
  Point c;
  const int index = coarse_cell(x, c);
  // outside of the grid: not closer than the box of the body; an open surface has both sides there
  if (index < 0) return open ? 0.0 : std::sqrt(square_of_distance(x, lo, hi));
  // single precision in the grid
  const double known = std::abs((double) coarse[index]) * (1.0 - 1.0e-6) - norm(x - c);
  if (known <= 0.0) return 0.0;
  return coarse[index] < 0.0f ? -known : known;
}

/** Upper bound of the distance, without a search; FAR_AWAY: unknown. */
double SurfaceMesh::most(const Point &x) const
{
  Point c;
  const int index = coarse_cell(x, c);
  if (index < 0) return FAR_AWAY;
  return (std::abs((double) coarse[index]) + norm(x - c)) * (1.0 + 1.0e-6) + near;
}

bool SurfaceMesh::inside(const Point &x) const
{
  const double known = bound(x);
  if (known != 0.0) return known < 0.0;
  if (winding) return (*winding)(x) > 0.5;
  Point closest;
  return distance(x, closest) <= 0.0;
}

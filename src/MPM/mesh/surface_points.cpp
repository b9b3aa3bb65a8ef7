/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/surface_points.h"

#include "mesh/vector3.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

static constexpr double SMOOTH = 0.866;    // cosine of the angle of normals at edges: 30 degrees
static constexpr double LEAST_ANGLE = 2.0e-3;    // between adjacent corners; less: plane
static constexpr double LEAST_LENGTH = 0.05;     // of the part of a unit vector across such lines
static constexpr int CLUSTER = 24;               // points

using Edge = std::pair<int, int>;

static Edge edge(int a, int b)
{
  return {std::min(a, b), std::max(a, b)};
}

static Vector unit(const Vector &a)
{
  const double length = norm(a);
  return length > 0.0 ? (1.0 / length) * a : a;
}

SurfacePoints::SurfacePoints(const std::vector<std::array<Point, 3>> &soup, double spacing)
{
  auto triangles = merge(soup);
  corner.assign(places.size(), 1);
  find_curved(triangles);
  divide(triangles, spacing);
  link(triangles);
  sort();
}

std::vector<SurfacePoints::Triangle>
SurfacePoints::merge(const std::vector<std::array<Point, 3>> &soup)
{
  std::map<Point, int> index;
  std::vector<Triangle> triangles;
  for (const auto &corners : soup) {
    Triangle t;
    for (int k = 0; k < 3; k++) {
      const auto [at, is_new] = index.insert({corners[k], (int) places.size()});
      if (is_new) places.push_back(corners[k]);
      t[k] = at->second;
    }
    triangles.push_back(t);
  }
  return triangles;
}

/** Triangles at a corner that are joined by smooth edges are one part of the surface, unless this
 *  goes round to other directions, as at the tip of a cone, which is sharp. */
void SurfacePoints::find_curved(const std::vector<Triangle> &triangles)
{
  std::vector<Point> normals;
  std::vector<std::vector<int>> around(places.size());
  for (const auto &t : triangles) {
    for (const int at : t) around[at].push_back((int) normals.size());
    normals.push_back(unit(cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]])));
  }
  for (std::size_t i = 0; i < places.size(); i++) {
    first_curved.push_back((int) curved.size());
    auto &left = around[i];
    while (!left.empty()) {
      std::vector<int> part = {left.back()}, ends;
      left.pop_back();
      Curved c = {};
      for (std::size_t k = 0; k < part.size(); k++) {
        const auto &t = triangles[part[k]];
        Vector leg[2];
        int n = 0;
        for (const int other : t)
          if (other != (int) i) {
            leg[n++ & 1] = unit(places[other] - places[i]);
            ends.push_back(other);
          }
        const double angle = std::acos(std::max(-1.0, std::min(1.0, dot(leg[0], leg[1]))));
        c.normal = c.normal + angle * normals[part[k]];
        for (std::size_t m = 0; m < left.size();) {
          const auto &other = triangles[left[m]];
          const auto shared = std::count_if(other.begin(), other.end(), [&](int at) {
            return std::find(t.begin(), t.end(), at) != t.end();
          });
          if (shared >= 2 && dot(normals[left[m]], normals[part[k]]) > SMOOTH) {
            part.push_back(left[m]);
            left.erase(left.begin() + m);
          } else
            m++;
        }
      }
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      c.normal = unit(c.normal);
      const bool smooth = std::all_of(part.begin(), part.end(), [&](int t) {
        return dot(normals[t], c.normal) > SMOOTH;
      });
      if (smooth && fit(c, places[i], ends)) curved.push_back(c);
    }
  }
  first_curved.push_back((int) curved.size());
}

/** The normal N and the curvature S with d.S.d = -2 N.d for the vectors d to adjacent corners,
 *  which is exact for chords of circles if d has its whole length along the surface. False: it is
 *  plane or concave. */
bool SurfacePoints::fit(Curved &c, const Point &at, const std::vector<int> &around) const
{
  constexpr int ROUNDS = 3;    // for the directions along the surface
  const int n = (int) around.size();
  Eigen::MatrixXd A(n, 5), along(n, 2);
  Eigen::VectorXd b(n), s;
  Vector e[2];
  for (int round = 0; round < ROUNDS; round++) {
    const Vector N = c.normal;
    int least = 0;
    for (int d = 1; d < 3; d++)
      if (std::fabs(N[d]) < std::fabs(N[least])) least = d;
    Vector axis = {0.0, 0.0, 0.0};
    axis[least] = 1.0;
    e[0] = unit(cross(N, axis));
    e[1] = cross(N, e[0]);
    for (int k = 0; k < n; k++) {
      const Vector d = places[around[k]] - at;
      double x = dot(d, e[0]), y = dot(d, e[1]);
      const double across = std::hypot(x, y), whole = norm(d);
      A.row(k) << x * x, 2.0 * x * y, y * y, 2.0 * x, 2.0 * y;
      A.row(k).head(3) *= whole * whole / std::max(across * across, 1.0e-20 * whole * whole);
      A.row(k) /= whole * whole;
      b(k) = -2.0 * dot(N, d) / (whole * whole);
      along.row(k) << x, y;
    }
    s = A.completeOrthogonalDecomposition().solve(b);
    if (std::hypot(s(3), s(4)) > 0.2) break;    // too few corners to tell
    c.normal = unit(N + s(3) * e[0] + s(4) * e[1]);
  }
  Eigen::Matrix2d S;
  S << s(0), s(1), s(1), s(2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(S);
  bool any = false;
  for (int k = 0; k < 2; k++) {
    const Eigen::Vector2d v = principal.eigenvectors().col(k);
    c.axis[k] = v(0) * e[0] + v(1) * e[1];
    c.axis[k] = unit(c.axis[k] - dot(c.axis[k], c.normal) * c.normal);
    c.reach[k] = (along * v).cwiseAbs().maxCoeff();
    const double curvature = principal.eigenvalues()(k);
    const bool bends = curvature * c.reach[k] > LEAST_ANGLE;
    c.radius[k] = bends ? 1.0 / curvature : 0.0;
    any = any || bends;
  }
  return any;
}

bool SurfacePoints::farthest(std::size_t i, const Point &direction, Point &x) const
{
  x = places[i];
  for (int k = first_curved[i]; k < first_curved[i + 1]; k++) {
    const auto &c = curved[k];
    Vector d = direction;    // without its part along straight lines of the surface
    for (int a = 0; a < 2; a++)
      if (c.radius[a] == 0.0) d = d - dot(d, c.axis[a]) * c.axis[a];
    if (norm(d) < LEAST_LENGTH) continue;
    d = unit(d);
    Vector way = {0.0, 0.0, 0.0};
    bool within = dot(d, c.normal) > 0.5;
    double drop = 0.0;
    for (int a = 0; a < 2; a++) {
      const double angle = dot(d, c.axis[a]), along = c.radius[a] * angle;
      within = within && std::fabs(along) <= c.reach[a];
      way = way + along * c.axis[a];
      drop += along * angle;
    }
    if (!within) continue;    // beyond an edge of the part
    x = x + way - (drop / (1.0 + dot(d, c.normal))) * c.normal;
    return true;
  }
  return false;
}

/** Halves all edges that are too long, until there are none. */
void SurfacePoints::divide(std::vector<Triangle> &triangles, double spacing)
{
  for (bool divided = true; divided;) {
    std::map<Edge, int> middle;
    for (const auto &t : triangles)
      for (int k = 0; k < 3; k++) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (norm(places[a] - places[b]) <= spacing) continue;
        const auto [at, is_new] = middle.insert({edge(a, b), (int) places.size()});
        if (is_new) places.push_back(0.5 * (places[a] + places[b]));
      }
    divided = !middle.empty();
    std::vector<Triangle> parts;
    for (Triangle t : triangles) {
      int m[3], n = 0;
      const auto find = [&] {
        n = 0;
        for (int k = 0; k < 3; k++) {
          const auto at = middle.find(edge(t[k], t[(k + 1) % 3]));
          m[k] = at == middle.end() ? -1 : at->second;
          n += m[k] >= 0;
        }
      };
      find();
      // an edge that stays comes last, one that alone is halved first
      for (int k = 0; k < 2 && ((n == 1 && m[0] < 0) || (n == 2 && m[2] >= 0)); k++) {
        t = {t[1], t[2], t[0]};
        find();
      }
      if (n == 0)
        parts.push_back(t);
      else if (n == 1) {
        parts.push_back({t[0], m[0], t[2]});
        parts.push_back({m[0], t[1], t[2]});
      } else if (n == 2) {
        parts.push_back({m[0], t[1], m[1]});
        parts.push_back({t[0], m[0], m[1]});
        parts.push_back({t[0], m[1], t[2]});
      } else {
        parts.push_back({t[0], m[0], m[2]});
        parts.push_back({m[0], t[1], m[1]});
        parts.push_back({m[2], m[1], t[2]});
        parts.push_back({m[0], m[1], m[2]});
      }
    }
    triangles.swap(parts);
  }
}

void SurfacePoints::link(const std::vector<Triangle> &triangles)
{
  std::vector<Edge> pairs;
  for (const auto &t : triangles)
    for (int k = 0; k < 3; k++) {
      pairs.push_back({t[k], t[(k + 1) % 3]});
      pairs.push_back({t[(k + 1) % 3], t[k]});
    }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first.assign(places.size() + 1, 0);
  for (const auto &[a, b] : pairs) {
    first[a + 1]++;
    neighbors.push_back(b);
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
}

void SurfacePoints::split(std::vector<int> &order, int from, int to)
{
  Point lo = places[order[from]], hi = lo;
  for (int k = from; k < to; k++) include(places[order[k]], lo, hi);
  if (to - from <= CLUSTER) {
    Cluster c = {from, to, 0.5 * (lo + hi), 0.0};
    for (int k = from; k < to; k++)
      c.radius = std::max(c.radius, norm(places[order[k]] - c.center));
    groups.push_back(c);
    return;
  }
  const int middle = halve(order, from, to, lo, hi, [&](int i) {
    return places[i];
  });
  split(order, from, middle);
  split(order, middle, to);
}

/** Brings the points in the order of clusters. */
void SurfacePoints::sort()
{
  const int n = (int) places.size();
  std::vector<int> order(n), now(n), count = {0}, list, parts = {0};
  std::iota(order.begin(), order.end(), 0);
  split(order, 0, n);
  std::vector<Point> sorted;
  std::vector<Curved> sorted_parts;
  std::vector<char> sorted_corner;
  corner.resize(n, 0);
  first_curved.resize(n + 1, (int) curved.size());
  for (int k = 0; k < n; k++) now[order[k]] = k;
  for (const int old : order) {
    sorted.push_back(places[old]);
    sorted_corner.push_back(corner[old]);
    for (int k = first[old]; k < first[old + 1]; k++) list.push_back(now[neighbors[k]]);
    for (int k = first_curved[old]; k < first_curved[old + 1]; k++)
      sorted_parts.push_back(curved[k]);
    count.push_back((int) list.size());
    parts.push_back((int) sorted_parts.size());
  }
  places.swap(sorted);
  corner.swap(sorted_corner);
  neighbors.swap(list);
  first.swap(count);
  curved.swap(sorted_parts);
  first_curved.swap(parts);
}

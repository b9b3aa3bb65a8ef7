/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/surface_holes.h"

#include "math/sets.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

namespace {

using Corners = std::vector<Vector>;
using Triangles = std::vector<std::array<int, 3>>;

/** An edge, whichever way it is run along. */
uint64_t key_of(int a, int b)
{
  return (uint64_t) std::min(a, b) << 32 | (uint32_t) std::max(a, b);
}

double area_of(const Corners &corners, const std::array<int, 3> &t)
{
  return 0.5 * norm(cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]));
}

/** Begin with the smallest number: the same triangle twice is the same then, and one turned is
 *  not. */
std::array<int, 3> rotated(std::array<int, 3> t)
{
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::size_t drop_repeated(Triangles &triangles)
{
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (int i = 0; i < (int) triangles.size(); i++) sorted.emplace_back(rotated(triangles[i]), i);
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> again(triangles.size(), 0);
  for (std::size_t k = 1; k < sorted.size(); k++)
    again[sorted[k].second] = sorted[k].first == sorted[k - 1].first;
  std::size_t n = 0;
  for (std::size_t i = 0; i < triangles.size(); i++)
    if (!again[i]) triangles[n++] = triangles[i];
  const std::size_t dropped = triangles.size() - n;
  triangles.resize(n);
  return dropped;
}

/** Edges of all triangles, the same ones next to each other. */
std::vector<std::pair<uint64_t, int>> edges_of(const Triangles &triangles)
{
  std::vector<std::pair<uint64_t, int>> edges;
  edges.reserve(3 * triangles.size());
  for (int i = 0; i < (int) triangles.size(); i++)
    for (int c = 0; c < 3; c++)
      edges.emplace_back(key_of(triangles[i][c], triangles[i][(c + 1) % 3]), i);
  std::sort(edges.begin(), edges.end());
  return edges;
}

/** Does a triangle run along an edge from a to b? */
bool runs(const std::array<int, 3> &t, int a, int b)
{
  return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
}

/** From one triangle to the next over edges that two of them have, to find those that hang together
 *  and look to one side, up to the sign of all. */
std::size_t turn_around(const Corners &corners, Triangles &triangles)
{
  std::vector<std::array<int, 3>> next(triangles.size(), {-1, -1, -1});    // over each edge
  const auto edges = edges_of(triangles);
  for (std::size_t k = 0, end; k < edges.size(); k = end) {
    for (end = k; end < edges.size() && edges[end].first == edges[k].first;) end++;
    if (end - k != 2) continue;
    for (std::size_t m : {k, k + 1}) {
      const int i = edges[m].second, j = edges[2 * k + 1 - m].second;
      for (int c = 0; c < 3; c++)
        if (key_of(triangles[i][c], triangles[i][(c + 1) % 3]) == edges[k].first) next[i][c] = j;
    }
  }

  std::size_t turned = 0;
  std::vector<int> sign(triangles.size(), 0), members;
  for (int start = 0; start < (int) triangles.size(); start++) {
    if (sign[start]) continue;
    sign[start] = 1;
    members.assign(1, start);
    double agree = 0.0;
    for (std::size_t m = 0; m < members.size(); m++) {
      const int i = members[m];
      agree += sign[i] * area_of(corners, triangles[i]);
      for (int c = 0; c < 3; c++) {
        const int a = triangles[i][c], b = triangles[i][(c + 1) % 3];
        const int j = next[i][c];
        if (j < 0 || sign[j]) continue;
        sign[j] = runs(triangles[j], a, b) ? -sign[i] : sign[i];
        members.push_back(j);
      }
    }
    const int wrong = agree < 0.0 ? 1 : -1;
    for (const int i : members)
      if (sign[i] == wrong) {
        std::swap(triangles[i][1], triangles[i][2]);
        turned++;
      }
  }
  return turned;
}

}    // namespace

/** The edges that triangles run along more often in one direction than in the other are the
 *  boundary of the surface, which has none itself: a cone over each part of it closes the surface,
 *  whatever it looks like. */
SurfaceHoles MPM_NS::patch_surface(Corners &corners, Triangles &triangles)
{
  SurfaceHoles found;
  found.repeated = drop_repeated(triangles);
  found.turned = turn_around(corners, triangles);

  double area = 0.0;
  for (const auto &t : triangles) area += area_of(corners, t);
  struct Open {
    int a, b, times;
  };
  std::vector<Open> open;
  const auto edges = edges_of(triangles);
  for (std::size_t k = 0, end; k < edges.size(); k = end) {
    const int low = (int) (edges[k].first >> 32), high = (int) (edges[k].first & 0xffffffff);
    int times = 0;    // upward, less downward
    for (end = k; end < edges.size() && edges[end].first == edges[k].first; end++)
      times += runs(triangles[edges[end].second], low, high) ? 1 : -1;
    if (times > 0) open.push_back({low, high, times});
    if (times < 0) open.push_back({high, low, -times});
  }
  found.edges = open.size();

  // holes: edges that hang together
  Sets connected(corners.size());
  for (const auto &edge : open) connected.join(edge.a, edge.b);
  struct Hole {
    Vector lo, hi, sum = {0.0, 0.0, 0.0};
    double length = 0.0;
    int center = -1;
  };
  std::map<int, Hole> holes;
  for (const auto &edge : open) {
    const Vector &a = corners[edge.a], &b = corners[edge.b];
    const auto [place, is_new] = holes.emplace(connected.root(edge.a), Hole());
    Hole &hole = place->second;
    if (is_new) hole.lo = hole.hi = a;
    include(a, hole.lo, hole.hi);
    include(b, hole.lo, hole.hi);
    const double length = norm(b - a);
    hole.length += length;
    hole.sum = hole.sum + (0.5 * length) * (a + b);
  }
  found.holes = holes.size();
  for (auto &[first, hole] : holes) {
    hole.center = (int) corners.size();
    corners.push_back(hole.length > 0.0 ? (1.0 / hole.length) * hole.sum : hole.lo);
    const double width = norm(hole.hi - hole.lo);
    if (width <= found.widest) continue;
    found.widest = width;
    found.at = corners.back();
  }
  double patches = 0.0;
  for (const auto &edge : open)
    for (int k = 0; k < edge.times; k++) {
      triangles.push_back({edge.b, edge.a, holes[connected.root(edge.a)].center});
      patches += area_of(corners, triangles.back());
    }
  found.area = area > 0.0 ? patches / area : 0.0;
  return found;
}

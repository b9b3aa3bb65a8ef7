/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/winding.h"

#include "mesh/vector3.h"

#include <algorithm>
#include <utility>

using namespace MPM_NS;
using namespace MPM_NS::vector3;
using Point = WindingNumber::Point;

static constexpr double PI = 3.14159265358979323846;

WindingNumber::WindingNumber(std::vector<std::array<Point, 3>> of) : triangles(std::move(of))
{
  tree.reserve(triangles.size());
  if (!triangles.empty()) build(0, (int) triangles.size());
}

/** Halves by the longest axis of the centers of the triangles [first,last). */
int WindingNumber::build(int first, int last)
{
  constexpr int LEAF = 8;
  const int me = (int) tree.size();
  tree.emplace_back();
  const auto center_of = [](const std::array<Point, 3> &t) {
    return (1.0 / 3.0) * (t[0] + t[1] + t[2]);
  };
  Node node = {};
  node.first = first;
  node.last = last;

  double size = 0.0;
  Point low = center_of(triangles[first]), high = low;
  for (int i = first; i < last; i++) {
    const auto &t = triangles[i];
    const Point c = center_of(t), area = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
    include(c, low, high);
    node.center = node.center + norm(area) * c;
    node.area = node.area + area;
    size += norm(area);
  }
  node.center = size > 0.0 ? (1.0 / size) * node.center : low;
  for (int i = first; i < last; i++) {
    const auto &t = triangles[i];
    const Point r = center_of(t) - node.center, area = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) node.moment[a][b] += area[a] * r[b];
    for (const auto &x : t)
      node.square = std::max(node.square, dot(x - node.center, x - node.center));
  }

  if (last - first > LEAF) {
    const int middle = halve(triangles, first, last, low, high, center_of);
    node.last = -1;
    node.child[0] = build(first, middle);
    node.child[1] = build(middle, last);
  }
  tree[me] = node;
  return me;
}

/** Solid angle of a triangle: A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983)
 *  125. */
static double solid_angle(const std::array<Point, 3> &t, const Point &x)
{
  const Point a = t[0] - x, b = t[1] - x, c = t[2] - x;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return 2.0 *
      std::atan2(dot(a, cross(b, c)),
                 la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/** Far away, the field r/r^3 of a dipole to first order in the places of the triangles. */
double WindingNumber::operator()(const Point &x) const
{
  constexpr double FAR = 4.0;    // in largest distances from the center of a box
  if (tree.empty()) return 0.0;
  double angle = 0.0;
  int stack[64], depth = 0;
  stack[depth++] = 0;
  while (depth) {
    const Node &node = tree[stack[--depth]];
    const Point r = node.center - x;
    const double square = dot(r, r);
    if (square > FAR * FAR * node.square) {
      const double inverse = 1.0 / std::sqrt(square), cube = inverse * inverse * inverse;
      double trace = 0.0, along = 0.0;
      for (int a = 0; a < 3; a++) {
        trace += node.moment[a][a];
        for (int b = 0; b < 3; b++) along += r[a] * node.moment[a][b] * r[b];
      }
      angle += cube * (dot(r, node.area) + trace - 3.0 * along / square);
    } else if (node.last < 0) {
      stack[depth++] = node.child[0];
      stack[depth++] = node.child[1];
    } else {
      for (int i = node.first; i < node.last; i++) angle += solid_angle(triangles[i], x);
    }
  }
  return angle / (4.0 * PI);
}

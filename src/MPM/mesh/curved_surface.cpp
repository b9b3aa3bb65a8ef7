/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/curved_surface.h"

#include "math/matrix.h"
#include "mesh/gmsh.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

namespace {

constexpr double SHARP = 0.5;    // cosine of an angle that is no curvature any more

/** The angle of a smooth edge, with a factor that makes sharp ones none; slope: its derivative by
 *  the angle. */
double smooth_angle(double s, double c, double *slope)
{
  const double angle = std::atan2(s, c), q = (1.0 - c) / (1.0 - SHARP);
  *slope = 0.0;
  if (q >= 1.0) return 0.0;
  const double rest = 1.0 - q * q * q * q;
  *slope = rest * rest - 8.0 * angle * rest * q * q * q * s / (1.0 - SHARP);
  return angle * rest * rest;
}

/** g += factor a. */
void add(double factor, const double *a, double *g)
{
  for (int d = 0; d < 3; d++) g[d] += factor * a[d];
}

double volume_of_corner(const double (*x)[3], double factor, double (*gradient)[3])
{
  double t[2][3], l[2], slope;
  for (int k = 0; k < 2; k++) {
    difference(x[k + 1], x[k], t[k]);
    l[k] = std::hypot(t[k][0], t[k][1]);
    for (double &c : t[k]) c /= l[k];
  }
  const double angle = smooth_angle(t[0][0] * t[1][1] - t[0][1] * t[1][0],
                                    t[0][0] * t[1][0] + t[0][1] * t[1][1], &slope),
               size = (l[0] * l[0] + l[1] * l[1]) / 24.0;
  for (int k = 0; k < 2 && gradient; k++) {
    const double across[2] = {-t[k][1], t[k][0]};
    for (int d = 0; d < 2; d++) {
      const double turns = factor * slope * size * across[d] / l[k],
                   stretches = factor * angle * l[k] * t[k][d] / 12.0;
      gradient[2 * k][d] += turns + (k == 0 ? -stretches : stretches);
      gradient[1][d] -= turns + (k == 0 ? -stretches : stretches);
    }
  }
  return factor * angle * size;
}

double volume_of_edge(const double (*x)[3], double factor, double (*gradient)[3])
{
  double e[3], to[2][3], n[2][3], A[2], slope, normals[3];
  difference(x[1], x[0], e);
  for (int k = 0; k < 2; k++) difference(x[2 + k], x[0], to[k]);
  cross(e, to[0], n[0]);
  cross(to[1], e, n[1]);
  const double l = norm(e);
  for (int k = 0; k < 2; k++) {
    A[k] = 0.5 * norm(n[k]);
    for (double &c : n[k]) c /= 2.0 * A[k];
  }
  cross(n[0], n[1], normals);
  const double angle = smooth_angle(dot(normals, e) / l, dot(n[0], n[1]), &slope),
               size = (A[0] * A[0] - A[0] * A[1] + A[1] * A[1]) / (3.0 * l);
  if (!gradient || (angle == 0.0 && slope == 0.0)) return factor * angle * size;

  for (int k = 0; k < 2; k++) {
    // the angle: a node that rises makes it smaller
    const double turns = factor * slope * size * l / (2.0 * A[k]), along = dot(to[k], e) / (l * l);
    add(-turns, n[k], gradient[2 + k]);
    add((1.0 - along) * turns, n[k], gradient[0]);
    add(along * turns, n[k], gradient[1]);

    // areas: half of the normal times the side across from a node
    const double grows = factor * angle * (2.0 * A[k] - A[1 - k]) / (6.0 * l);
    const int corner[3] = {k, 1 - k, 2 + k};
    for (int m = 0; m < 3; m++) {
      double side[3], rate[3];
      difference(x[corner[(m + 2) % 3]], x[corner[(m + 1) % 3]], side);
      cross(n[k], side, rate);
      add(grows, rate, gradient[corner[m]]);
    }
  }
  const double longer = factor * angle * size / (l * l);
  add(longer, e, gradient[0]);
  add(-longer, e, gradient[1]);
  return factor * angle * size;
}

/** Area of a triangle with the angles at its edges, the one across from each node, over its flat
 *  area: that of the surface of second order above it, and the strips between these at edges. */
double area_of_triangle(const double (*p)[2], const double *angle)
{
  const double area =
      0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));
  double xx = 0.0, yy = 0.0, xy = 0.0, rise[3], strips = 0.0, square = 0.0, slope[2] = {0.0, 0.0};
  for (int i = 0; i < 3; i++) {
    const double *const a = p[(i + 1) % 3], *const b = p[(i + 2) % 3];
    const double x = b[1] - a[1], y = a[0] - b[0],
                 part = 0.5 * angle[i] / (area * std::hypot(x, y));
    xx += part * x * x;
    yy += part * y * y;
    xy += part * x * y;
  }
  for (int i = 0; i < 3; i++) {    // of the middle of an edge above it
    const double *const a = p[(i + 1) % 3], *const b = p[(i + 2) % 3];
    const double x = b[0] - a[0], y = b[1] - a[1];
    rise[i] = (xx * x * x + 2.0 * xy * x * y + yy * y * y) / 8.0;
    strips += rise[i] * angle[i] * std::hypot(x, y) / 3.0;
  }
  // w = sum of 4 rise_i L_j L_k; slopes at the middles of edges, where the mean of squares is exact
  for (int i = 0; i < 3; i++) {
    slope[0] = slope[1] = 0.0;
    for (int r = 0; r < 3; r++) {
      const int j = (r + 1) % 3, k = (r + 2) % 3;
      const double Lj = j == i ? 0.0 : 0.5, Lk = k == i ? 0.0 : 0.5;
      const auto add_gradient = [&](int of, double times) {
        const double *const a = p[(of + 1) % 3], *const b = p[(of + 2) % 3];
        slope[0] += times * (a[1] - b[1]) / (2.0 * area);
        slope[1] += times * (b[0] - a[0]) / (2.0 * area);
      };
      add_gradient(j, 4.0 * rise[r] * Lk);
      add_gradient(k, 4.0 * rise[r] * Lj);
    }
    square += (slope[0] * slope[0] + slope[1] * slope[1]) / 3.0;
  }
  return 1.0 + 0.5 * square + strips / area;
}

}    // namespace

double MPM_NS::curved_volume(int dim, const double (*x)[3], double factor, double (*gradient)[3])
{
  return dim == 2 ? volume_of_corner(x, factor, gradient) : volume_of_edge(x, factor, gradient);
}

std::vector<double> MPM_NS::curved_areas(int dim, const Mesh &mesh,
                                         const std::function<void(int, int, double *)> &to)
{
  // angles at edges and corners, or those that lines have on the way, by their nodes
  std::map<std::pair<int, int>, double> angles;
  double slope;
  for (const auto &e : mesh.elements) {
    double x[4][3] = {{0.0}}, a[3], b[3], c[3];
    if (e.type == ElementType::CORNER) {
      to(e.node[0], e.node[1], a);
      to(e.node[1], e.node[2], b);
      const double la = norm(a), lb = norm(b),
                   angle = smooth_angle((a[0] * b[1] - a[1] * b[0]) / (la * lb),
                                        dot(a, b) / (la * lb), &slope);
      angles[{e.node[1], e.node[1]}] = 2.0 * angle / (la + lb);    // a curvature
    }
    if (e.type != ElementType::EDGE) continue;
    for (int m = 1; m < 4; m++) to(e.node[0], e.node[m], x[m]);
    cross(x[1], x[2], a);
    cross(x[3], x[1], b);
    cross(a, b, c);
    const double scale = norm(a) * norm(b);
    angles[std::minmax(e.node[0], e.node[1])] =
        smooth_angle(dot(c, x[1]) / (scale * norm(x[1])), dot(a, b) / scale, &slope);
  }
  const auto angle_at = [&](int a, int b) {
    const auto found = angles.find(std::minmax(a, b));
    return found == angles.end() ? 0.0 : found->second;
  };
  std::vector<double> all(mesh.elements.size(), 1.0);
  for (std::size_t k = 0; k < mesh.elements.size(); k++) {
    const auto &e = mesh.elements[k];
    double a[3], b[3];
    if (e.type == ElementType::LINE && dim == 2) {
      to(e.node[0], e.node[1], a);
      const double turn =
          0.5 * norm(a) * (angle_at(e.node[0], e.node[0]) + angle_at(e.node[1], e.node[1]));
      all[k] = 1.0 + turn * turn / 24.0;
    }
    if (e.type != ElementType::TRIANGLE) continue;
    to(e.node[0], e.node[1], a);
    to(e.node[0], e.node[2], b);
    const double l = norm(a), along = dot(a, b) / l,
                 p[3][2] = {{0.0, 0.0},
                            {l, 0.0},
                            {along, std::sqrt(std::max(0.0, dot(b, b) - along * along))}},
                 angle[3] = {angle_at(e.node[1], e.node[2]), angle_at(e.node[2], e.node[0]),
                             angle_at(e.node[0], e.node[1])};
    all[k] = area_of_triangle(p, angle);
  }
  return all;
}

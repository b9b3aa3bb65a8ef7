// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_MESH_STL_TESTING_H
#define MPM_MESH_STL_TESTING_H

// Surfaces of triangles for tests, and their files in STL and OBJ format.

#include "mesh/surface_mesh.h"
#include "mpm_lammps.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace MPM_TEST {

using Point = MPM_NS::SurfaceMesh::Point;

/** Triangles by their corners. */
using Soup = std::vector<std::array<Point, 3>>;

/** The triangles as an STL file of text. */
inline std::string text_of(const Soup &soup)
{
  std::string s = "solid test\n";
  for (const auto &t : soup) {
    s += "facet normal 0 0 0\nouter loop\n";
    for (const auto &x : t) s += strprintf("vertex %.9g %.9g %.9g\n", x[0], x[1], x[2]);
    s += "endloop\nendfacet\n";
  }
  return s + "endsolid test\n";
}

/** The triangles as a binary STL file. */
inline std::string binary_of(const Soup &soup)
{
  std::string s(84, ' ');
  const uint32_t n = soup.size();
  memcpy(&s[80], &n, 4);
  for (const auto &t : soup) {
    float row[12] = {0.0f};
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) row[3 + 3 * c + d] = (float) t[c][d];
    s.append((const char *) row, 48);
    s.append(2, '\0');
  }
  return s;
}

inline Soup box(const Point &lo, const Point &hi)
{
  Soup soup;
  for (int a = 0; a < 3; a++)
    for (int side = 0; side < 2; side++) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      Point p[4];
      for (int k = 0; k < 4; k++) {
        p[k][a] = side ? hi[a] : lo[a];
        p[k][b] = (k == 1 || k == 2) ? hi[b] : lo[b];
        p[k][c] = k >= 2 ? hi[c] : lo[c];
      }
      if (!side) std::swap(p[1], p[3]);
      soup.push_back({p[0], p[1], p[2]});
      soup.push_back({p[0], p[2], p[3]});
    }
  return soup;
}

/** The surface with x moved by share times z, y by half of that: its inertia has all components. */
inline Soup sheared(Soup soup, double share)
{
  for (auto &t : soup)
    for (auto &x : t) {
      x[0] += share * x[2];
      x[1] += 0.5 * share * x[2];
    }
  return soup;
}

/** Torus about z, with major radius R and minor radius r: it is not convex and has a hole. */
inline Soup torus(double R, double r, int n)
{
  const auto at = [&](int i, int j) {
    const double u = 2.0 * PI * (i % n) / n, v = 2.0 * PI * (j % n) / n;
    return Point{(R + r * cos(v)) * cos(u), (R + r * cos(v)) * sin(u), r * sin(v)};
  };
  Soup soup;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      soup.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return soup;
}

/** The surface with its inside and outside exchanged. */
inline Soup inverted(Soup soup)
{
  for (auto &t : soup) std::swap(t[1], t[2]);
  return soup;
}

inline Soup both(Soup soup, const Soup &other)
{
  soup.insert(soup.end(), other.begin(), other.end());
  return soup;
}

/** Ball of this radius: an icosahedron whose triangles are divided into four this many times. */
inline Soup ball(double radius, int divisions)
{
  const auto onto = [](Point x) {
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    return Point{x[0] / r, x[1] / r, x[2] / r};
  };
  const double g = 0.5 * (1.0 + sqrt(5.0));
  const Point v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                       {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  Soup soup;
  for (const auto &f : faces) soup.push_back({onto(v[f[0]]), onto(v[f[1]]), onto(v[f[2]])});
  for (int n = 0; n < divisions; n++) {
    Soup finer;
    for (const auto &[a, b, c] : soup) {
      const auto middle = [&](const Point &p, const Point &q) {
        return onto({p[0] + q[0], p[1] + q[1], p[2] + q[2]});
      };
      const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto &t : Soup{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(t);
    }
    soup.swap(finer);
  }
  for (auto &t : soup)
    for (auto &x : t)
      for (auto &value : x) value *= radius;
  return soup;
}

/** Prism over a polygon, from z = 0 to height. cut: triangles of the polygon, by corners. */
inline Soup prism(const std::vector<std::array<double, 2>> &p, double height,
                  const std::vector<std::array<int, 3>> &cut)
{
  Soup soup;
  const auto at = [&](std::size_t k, double z) {
    return Point{p[k % p.size()][0], p[k % p.size()][1], z};
  };
  for (std::size_t k = 0; k < p.size(); k++) {
    soup.push_back({at(k, 0.0), at(k + 1, 0.0), at(k + 1, height)});
    soup.push_back({at(k, 0.0), at(k + 1, height), at(k, height)});
  }
  for (const auto &[a, b, c] : cut) {
    soup.push_back({at(a, height), at(b, height), at(c, height)});
    soup.push_back({at(a, 0.0), at(c, 0.0), at(b, 0.0)});
  }
  return soup;
}

inline Soup l_prism()
{
  return prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1.0,
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

inline Soup cylinder(int n, double height)
{
  std::vector<std::array<double, 2>> p;
  std::vector<std::array<int, 3>> cut;
  for (int k = 0; k < n; k++) {
    p.push_back({cos(2.0 * PI * k / n), sin(2.0 * PI * k / n)});
    if (k > 1) cut.push_back({0, k - 1, k});
  }
  return prism(p, height, cut);
}

/** A body whose volume, principal moments of inertia (unit density), and number of lattice sites
 *  inside are known. size: spacing of the sites; sites = 0: number not known. */
struct Solid {
  const char *name;
  Soup soup;
  double volume, moment[3];
  double size;
  int sites;
};

inline std::vector<Solid> solids()
{
  return {
      {"tetrahedron",
       {{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
        {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
        {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
       1.0 / 6.0,
       {1.0 / 96.0, 1.0 / 96.0, 1.0 / 60.0},
       0.0,
       0},
      {"L", l_prism(), 5.0, {2.23333333, 5.83333333, 7.23333333}, 0.1, 5000},
      {"cylinder", cylinder(64, 2.0), 6.2730969811, {3.13151404, 3.65678935, 3.65678935}, 0.0, 0},
      {"ball", ball(1.0, 3), 4.1527408171, {1.65155743, 1.65155743, 1.65155743}, 0.05, 33208},
      {"hollow cube",
       both(box({0, 0, 0}, {1, 1, 1}), inverted(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}))),
       0.875,
       {0.16145833, 0.16145833, 0.16145833},
       0.0,
       0},
      {"hollow ball",
       both(ball(1.0, 3), inverted(ball(0.6, 3))),
       3.2557488006,
       {1.52313232, 1.52313232, 1.52313232},
       0.05,
       26000}};
}

/** The triangles as an OBJ file, every other one by negative numbers, from the last corner back. */
inline std::string obj_of(const Soup &soup)
{
  std::string s = "# a comment\no thing\n";
  bool backward = false;
  int n = 0;
  for (const auto &t : soup) {
    for (const auto &x : t) s += strprintf("v %.9g %.9g %.9g\n", x[0], x[1], x[2]);
    n += 3;
    s += backward ? "f -3//1 -2//1 -1//1\n" : strprintf("f %d %d/2 %d/2/1\n", n - 2, n - 1, n);
    backward = !backward;
  }
  return s;
}

}    // namespace MPM_TEST
#endif

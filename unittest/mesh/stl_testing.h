// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_STL_TESTING_H
#define MPM_STL_TESTING_H

// Surfaces of triangles for tests, and the bytes of their STL files.

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

using Soup = std::vector<std::array<Point, 3>>;

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

/** The box with x moved by this share of z and y by half of it: its inertia has all components. */
inline Soup sheared(Soup soup, double share)
{
  for (auto &t : soup)
    for (auto &x : t) {
      x[0] += share * x[2];
      x[1] += 0.5 * share * x[2];
    }
  return soup;
}

/** Torus about z: not convex, and with a hole. */
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

}    // namespace MPM_TEST
#endif

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_STL_TESTING_H
#define MPM_STL_TESTING_H

// Surfaces of triangles for tests, as text of STL files.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** A ball of radius 1 made of triangles, with n steps from pole to pole and 2 n around. */
inline std::string ball_stl(int n)
{
  const auto corner = [&](int i, int j) {
    const double theta = M_PI * i / n, phi = M_PI * j / n;
    return strprintf("vertex %.9g %.9g %.9g\n", std::sin(theta) * std::cos(phi),
                     std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  std::string text = "solid ball\n";
  const auto triangle = [&](const std::string &a, const std::string &b, const std::string &c) {
    text += "facet normal 0 0 0\nouter loop\n" + a + b + c + "endloop\nendfacet\n";
  };
  for (int i = 0; i < n; i++)
    for (int j = 0; j < 2 * n; j++) {
      const int next = (j + 1) % (2 * n);
      if (i > 0) triangle(corner(i, j), corner(i + 1, next), corner(i, next));
      if (i < n - 1) triangle(corner(i, j), corner(i + 1, j), corner(i + 1, next));
    }
  return text + "endsolid ball\n";
}

}    // namespace MPM_TEST

#endif

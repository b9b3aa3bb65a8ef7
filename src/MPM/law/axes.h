/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_AXES_H
#define MPM_LAW_AXES_H

// Axes of a material in the reference configuration, from the vectors and the angle that the user
// gives.

#include <cmath>

namespace MPM_NS::law {
namespace {

// Parameters of a law for orthonormal_axes(). This is a macro because lists cannot be joined.
#define MPM_AXES_PARAMETERS                                                              \
  {"axes", "A1X", "1", ANY_NUMBER, 1.0, "axis 1, of any length"},                        \
      {"axes", "A1Y", "1", ANY_NUMBER, 0.0, "axis 1"},                                   \
      {"axes", "A1Z", "1", ANY_NUMBER, 0.0, "axis 1"},                                   \
      {"axes", "A2X", "1", ANY_NUMBER, 0.0, "vector in the plane 12"},                   \
      {"axes", "A2Y", "1", ANY_NUMBER, 1.0, "vector in the plane 12"},                   \
      {"axes", "A2Z", "1", ANY_NUMBER, 0.0, "vector in the plane 12"},                   \
  {                                                                                      \
    "angle", "THETA", "degrees", ANY_NUMBER, 0.0, "then turns axes 1 and 2 about axis 3" \
  }

  /** Orthonormal axes from two vectors: axis 1 along a, axis 2 in the plane of a and b, axis 3
   *  normal to both. Axes 1 and 2 are then turned about axis 3 by an angle in degrees. axis: the
   *  three unit vectors, [axis][component]. */
  inline void orthonormal_axes(const double *a, const double *b, double degrees, double axis[3][3])
  {
    const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    double one[3], two[3], along = 0.0, rest = 0.0;
    for (int k = 0; k < 3; k++) one[k] = a[k] / length;
    for (int k = 0; k < 3; k++) along += b[k] * one[k];
    for (int k = 0; k < 3; k++) two[k] = b[k] - along * one[k];
    for (int k = 0; k < 3; k++) rest += two[k] * two[k];
    rest = std::sqrt(rest);
    const double angle = degrees * (3.14159265358979323846 / 180.0);
    const double c = std::cos(angle), s = std::sin(angle);
    for (int k = 0; k < 3; k++) {
      two[k] /= rest;
      axis[0][k] = c * one[k] + s * two[k];
      axis[1][k] = c * two[k] - s * one[k];
    }
    for (int k = 0; k < 3; k++) {
      const int m = (k + 1) % 3, n = (k + 2) % 3;
      axis[2][k] = one[m] * two[n] - one[n] * two[m];
    }
  }

  /** Error message if two vectors cannot define axes because they are parallel or zero; otherwise
   *  null. */
  inline const char *check_axes(const double *a, const double *b)
  {
    double cross2 = 0.0, aa = 0.0, bb = 0.0;
    for (int k = 0; k < 3; k++) {
      const int m = (k + 1) % 3, n = (k + 2) % 3;
      const double c = a[m] * b[n] - a[n] * b[m];
      cross2 += c * c;
      aa += a[k] * a[k];
      bb += b[k] * b[k];
    }
    return cross2 > 1e-12 * aa * bb ? nullptr : "axes must be two vectors that are not parallel";
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

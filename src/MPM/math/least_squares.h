/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_LEAST_SQUARES_H
#define MPM_MATH_LEAST_SQUARES_H

#include <cmath>

namespace MPM_NS {

/** Of all x that make |A x - b| smallest the shortest one, with n <= N unknowns and equations; a[j]: column j of A,
 *  which is overwritten. Rotations of pairs of columns make these orthogonal (M.R. Hestenes, J. Soc. Indust.
 *  Appl. Math. 6 (1958) 51); those that are zero but for rounding count for nothing. */
template <int N> void least_squares(int n, double (*a)[N], const double *b, double *x)
{
  const auto dot = [n](const double *u, const double *w) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += u[i] * w[i];
    return sum;
  };
  const auto rotate = [n](double *u, double *w, double c, double s) {
    for (int i = 0; i < n; i++) {
      const double old = u[i];
      u[i] = c * old - s * w[i];
      w[i] = s * old + c * w[i];
    }
  };
  constexpr double ROUNDING = 1e-15;
  double v[N][N] = {};    // A times column j of the rotations is a[j]
  for (int j = 0; j < n; j++) v[j][j] = 1.0;
  bool turned = true;
  for (int sweep = 0; turned && sweep < 60; sweep++) {
    turned = false;
    for (int j = 0; j < n; j++)
      for (int k = j + 1; k < n; k++) {
        const double jj = dot(a[j], a[j]), kk = dot(a[k], a[k]), jk = dot(a[j], a[k]);
        if (!(std::fabs(jk) > ROUNDING * std::sqrt(jj * kk))) continue;
        turned = true;
        const double z = (kk - jj) / (2.0 * jk);
        const double t = (z < 0.0 ? -1.0 : 1.0) / (std::fabs(z) + std::sqrt(1.0 + z * z));
        const double c = 1.0 / std::sqrt(1.0 + t * t);
        rotate(a[j], a[k], c, c * t);
        rotate(v[j], v[k], c, c * t);
      }
  }

  double largest = 0.0;
  for (int j = 0; j < n; j++) largest = std::fmax(largest, dot(a[j], a[j]));
  for (int i = 0; i < n; i++) x[i] = 0.0;
  for (int j = 0; j < n; j++) {
    const double square = dot(a[j], a[j]);
    if (!(square > n * n * ROUNDING * ROUNDING * largest)) continue;
    const double y = dot(a[j], b) / square;
    for (int i = 0; i < n; i++) x[i] += y * v[j][i];
  }
}

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What no polynomial of an order has at some nodes.

#include "mesh/bending.h"

#include <cmath>

using namespace MPM_NS;

namespace {

// of a polynomial that is left without those before, below which it is one of these; square of what
// is left of a node
constexpr double SAME = 1.0e-6, NONE = 0.01;

/** Take the parts along unit vectors off, twice for round-off; returns the length that is left. */
double reduce(const double (*unit)[PATCH_NODES], int nunit, int n, double *v)
{
  for (int again = 0; again < 2; again++)
    for (int u = 0; u < nunit; u++) {
      double part = 0.0;
      for (int k = 0; k < n; k++) part += unit[u][k] * v[k];
      for (int k = 0; k < n; k++) v[k] -= part * unit[u][k];
    }
  double square = 0.0;
  for (int k = 0; k < n; k++) square += v[k] * v[k];
  return std::sqrt(square);
}

}    // namespace

int MPM_NS::above_polynomials(int order, const double (*at)[2], int n, int most, double (*s)[4])
{
  double center[2] = {0.0, 0.0}, size = 0.0, unit[12][PATCH_NODES];
  for (int k = 0; k < n; k++)
    for (int d = 0; d < 2; d++) center[d] += at[k][d] / n;
  for (int k = 0; k < n; k++)
    size += (std::pow(at[k][0] - center[0], 2) + std::pow(at[k][1] - center[1], 2)) / n;
  size = std::sqrt(size);
  int nunit = 0, found = 0;
  for (int degree = 0; degree <= order; degree++)
    for (int b = 0; b <= degree; b++) {
      double *const v = unit[nunit], square = 0.0;
      for (int k = 0; k < n; k++) {
        v[k] = std::pow((at[k][0] - center[0]) / size, degree - b) *
            std::pow((at[k][1] - center[1]) / size, b);
        square += v[k] * v[k];
      }
      const double left = reduce(unit, nunit, n, v);
      if (left <= SAME * std::sqrt(square)) continue;
      for (int k = 0; k < n; k++) v[k] /= left;
      nunit++;
    }

  // the node of which most is left, again and again

  for (; found < most; found++) {
    double largest = NONE;
    int best = -1;
    for (int k = 0; k < n; k++) {
      double left = 1.0;
      for (int u = 0; u < nunit; u++) left -= unit[u][k] * unit[u][k];
      if (left <= largest) continue;
      largest = left;
      best = k;
    }
    if (best < 0) break;
    double *const v = unit[nunit];
    for (int k = 0; k < n; k++) v[k] = k == best;
    const double left = reduce(unit, nunit, n, v);
    for (int k = 0; k < n; k++) s[k][found] = v[k] /= left;
    nunit++;
  }
  return found;
}

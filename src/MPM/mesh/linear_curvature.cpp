/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// How the curvature of a surface changes within a triangle, from values at its nodes and those
// around it.

#include "mesh/bending.h"

#include <cmath>

using namespace MPM_NS;

namespace {

// pivot, in parts of the diagonal, below which nodes do not tell a surface of second order
constexpr double DEGENERATE = 1.0e-4;
// weight of a node at the distance r, in mean lengths of the edges at the corner: (NEAR + r^2)^-4
constexpr double NEAR = 0.3;

double distance(const double *a, const double *b)
{
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/** Cholesky's factors of a symmetric matrix, of which the lower half is given, in its place. False:
 *  it is singular. */
bool factorize(double (*A)[5])
{
  for (int i = 0; i < 5; i++) {
    const double diagonal = A[i][i];
    for (int j = 0; j <= i; j++) {
      for (int k = 0; k < j; k++) A[i][j] -= A[i][k] * A[j][k];
      if (j < i)
        A[i][j] /= A[j][j];
      else if (A[i][i] <= DEGENERATE * diagonal)
        return false;
      else
        A[i][i] = std::sqrt(A[i][i]);
    }
  }
  return true;
}

void solve(const double (*A)[5], double *v)
{
  for (int i = 0; i < 5; i++) {
    for (int k = 0; k < i; k++) v[i] -= A[i][k] * v[k];
    v[i] /= A[i][i];
  }
  for (int i = 4; i >= 0; i--) {
    for (int k = i + 1; k < 5; k++) v[i] -= A[k][i] * v[k];
    v[i] /= A[i][i];
  }
}

/** Slopes along x and y at a corner, as sums over the values at nodes: those of the surface of
 *  second order through the corner that is nearest to the other nodes, the more so the closer they
 *  are. False: the nodes do not tell such a surface. */
bool find_slopes(const double (*at)[2], int n, int corner, double (*slope)[PATCH_NODES])
{
  double P[PATCH_NODES][5], weight[PATCH_NODES], A[5][5] = {{0.0}}, size = 0.0;
  for (int k = 0; k < 3; k++) size += 0.5 * distance(at[corner], at[k]);
  for (int a = 0; a < n; a++) {
    const double x = (at[a][0] - at[corner][0]) / size, y = (at[a][1] - at[corner][1]) / size,
                 values[5] = {x, y, 0.5 * x * x, 0.5 * y * y, x * y};
    weight[a] = a == corner ? 0.0 : std::pow(NEAR + x * x + y * y, -4);
    for (int i = 0; i < 5; i++) {
      P[a][i] = values[i];
      for (int j = 0; j <= i; j++) A[i][j] += weight[a] * values[i] * values[j];
    }
  }
  if (!factorize(A)) return false;
  for (int d = 0; d < 2; d++) {
    double v[5] = {0.0};
    v[d] = 1.0;
    solve(A, v);
    slope[d][corner] = 0.0;
    for (int a = 0; a < n; a++) {
      if (a == corner) continue;
      double sum = 0.0;
      for (int i = 0; i < 5; i++) sum += v[i] * P[a][i];
      slope[d][a] = weight[a] * sum / size;
      slope[d][corner] -= slope[d][a];
    }
  }
  return true;
}

}    // namespace

bool MPM_NS::linear_curvatures(const double (*at)[2], int n, double (*rows)[6])
{
  // at corners, and at the middles of the edges across from these, where the slope across is the
  // mean of those at the ends, and that along the edge is that of a cubic

  double slope[6][2][PATCH_NODES], g[3][2];
  for (int k = 0; k < 3; k++)
    if (!find_slopes(at, n, k, slope[k])) return false;
  const double twice =
      (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[2][0] - at[0][0]) * (at[1][1] - at[0][1]);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double l = distance(at[j], at[k]),
                 u[2] = {(at[k][0] - at[j][0]) / l, (at[k][1] - at[j][1]) / l};
    g[i][0] = (at[j][1] - at[k][1]) / twice;
    g[i][1] = (at[k][0] - at[j][0]) / twice;
    for (int a = 0; a < n; a++) {
      const double mean[2] = {0.5 * (slope[j][0][a] + slope[k][0][a]),
                              0.5 * (slope[j][1][a] + slope[k][1][a])},
                   chord = ((a == k) - (a == j)) / l,
                   more = 1.5 * (chord - mean[0] * u[0] - mean[1] * u[1]);
      for (int d = 0; d < 2; d++) slope[3 + i][d][a] = mean[d] + more * u[d];
    }
  }

  // curvatures at corners, of slopes that are of second order in the triangle

  const double scale = std::sqrt(LINEAR_PART / 12.0);
  for (int a = 0; a < n; a++) {
    double c[3][3];
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      double b[2][2];
      for (int d = 0; d < 2; d++)
        for (int e = 0; e < 2; e++)
          b[d][e] = 3.0 * g[i][e] * slope[i][d][a] - g[j][e] * slope[j][d][a] -
              g[k][e] * slope[k][d][a] + 4.0 * g[j][e] * slope[3 + k][d][a] +
              4.0 * g[k][e] * slope[3 + j][d][a];
      c[i][0] = b[0][0];
      c[i][1] = b[1][1];
      c[i][2] = 0.5 * (b[0][1] + b[1][0]);
    }
    for (int m = 0; m < 3; m++) {
      rows[a][m] = scale * (c[0][m] - c[1][m]) / std::sqrt(2.0);
      rows[a][3 + m] = scale * (c[0][m] + c[1][m] - 2.0 * c[2][m]) / std::sqrt(6.0);
    }
  }
  return true;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/element.h"

#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

void MPM_NS::cube_functions(int dim, const double *xi, double *N, double (*dN)[3])
{
  for (int k = 0; k < 1 << dim; k++) {
    double f[3] = {1.0, 1.0, 1.0};
    for (int d = 0; d < dim; d++) f[d] = 0.5 * (1.0 + CUBE_CORNER[k][d] * xi[d]);
    N[k] = f[0] * f[1] * f[2];
    for (int d = 0; d < 3; d++) {
      dN[k][d] = d < dim ? 0.5 * CUBE_CORNER[k][d] : 0.0;
      for (int e = 0; e < dim; e++)
        if (e != d) dN[k][d] *= f[e];
    }
  }
}

namespace {

/** Line, triangle, or tetrahedron with one point. */
ElementRule simplex(int dim)
{
  ElementRule r = {};
  r.dim = dim;
  r.nnode = dim + 1;
  r.npoint = 1;
  r.weight[0] = dim == 1 ? 1.0 : dim == 2 ? 0.5 : 1.0 / 6.0;
  for (int k = 0; k <= dim; k++) {
    r.N[0][k] = 1.0 / (dim + 1);
    for (int d = 0; d < dim; d++) r.dN[0][k][d] = k == 0 ? -1.0 : (k == d + 1 ? 1.0 : 0.0);
  }
  return r;
}

/** Quadrangle or hexahedron with two points along each axis. */
ElementRule cube(int dim)
{
  ElementRule r = {};
  r.dim = dim;
  r.nnode = r.npoint = 1 << dim;
  for (int q = 0; q < r.npoint; q++) {
    r.weight[q] = 1.0;
    double xi[3];
    for (int d = 0; d < 3; d++) xi[d] = CUBE_CORNER[q][d] / sqrt(3.0);
    cube_functions(dim, xi, r.N[q], r.dN[q]);
  }
  return r;
}

/** Without points: bending is not integrated. */
ElementRule bending(int nnode)
{
  ElementRule r = {};
  r.nnode = nnode;
  return r;
}

}    // namespace

const ElementRule &ElementRule::of(ElementType type)
{
  static const ElementRule rules[8] = {simplex(2), cube(2),     simplex(3), cube(3),
                                       simplex(1), bending(12), bending(3), bending(4)};
  return rules[static_cast<int>(type)];
}

/** With the Jacobian matrix J_ab = dx_a/dxi_b: g = J^-T dN. */
double ElementRule::gradients(int q, const double (*x)[3], double (*g)[3]) const
{
  const double(*d)[3] = dN[q];
  double J[3][3] = {{0.0}};
  for (int k = 0; k < nnode; k++)
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) J[a][b] += x[k][a] * d[k][b];

  if (dim == 2) {
    const double det = J[0][0] * J[1][1] - J[0][1] * J[1][0], inv = 1.0 / det;
    for (int k = 0; k < nnode; k++) {
      g[k][0] = inv * (J[1][1] * d[k][0] - J[1][0] * d[k][1]);
      g[k][1] = inv * (J[0][0] * d[k][1] - J[0][1] * d[k][0]);
      g[k][2] = 0.0;
    }
    return weight[q] * det;
  }

  const double *const m = J[0];
  const double C[9] = MPM_COFACTORS(m);
  const double det = dot(m, C), inv = 1.0 / det;
  for (int k = 0; k < nnode; k++)
    for (int a = 0; a < 3; a++) g[k][a] = inv * dot(C + 3 * a, d[k]);
  return weight[q] * det;
}

/** With the metric M = J^T J: g = J M^-1 dN. */
double ElementRule::gradients_along(int q, const double (*x)[3], double (*g)[3]) const
{
  const double(*d)[3] = dN[q];
  double J[2][3] = {{0.0}};    // columns
  for (int k = 0; k < nnode; k++)
    for (int b = 0; b < dim; b++)
      for (int a = 0; a < 3; a++) J[b][a] += x[k][a] * d[k][b];

  const double m00 = dot(J[0], J[0]);
  if (dim == 1) {
    for (int k = 0; k < nnode; k++)
      for (int a = 0; a < 3; a++) g[k][a] = J[0][a] * d[k][0] / m00;
    return weight[q] * sqrt(m00);
  }
  const double m01 = dot(J[0], J[1]), m11 = dot(J[1], J[1]);
  const double det = m00 * m11 - m01 * m01, inv = 1.0 / det;
  for (int k = 0; k < nnode; k++) {
    const double a0 = inv * (m11 * d[k][0] - m01 * d[k][1]),
                 a1 = inv * (m00 * d[k][1] - m01 * d[k][0]);
    for (int a = 0; a < 3; a++) g[k][a] = a0 * J[0][a] + a1 * J[1][a];
  }
  return weight[q] * sqrt(std::max(0.0, det));
}

/** In space: trigonometric form of the cubic equation. */
double ElementRule::largest_eigenvalue(const double (*g)[3]) const
{
  double G[3][3] = {{0.0}};
  for (int k = 0; k < nnode; k++)
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) G[a][b] += g[k][a] * g[k][b];
  if (G[2][2] == 0.0) {    // all are in the plane
    const double mean = 0.5 * (G[0][0] + G[1][1]);
    return mean + hypot(0.5 * (G[0][0] - G[1][1]), G[0][1]);
  }
  const double mean = (G[0][0] + G[1][1] + G[2][2]) / 3.0;
  const double a = G[0][0] - mean, b = G[1][1] - mean, c = G[2][2] - mean;
  const double off = G[0][1] * G[0][1] + G[0][2] * G[0][2] + G[1][2] * G[1][2];
  const double p = sqrt((a * a + b * b + c * c + 2.0 * off) / 6.0);
  if (!(p > 0.0)) return mean;
  const double det = a * b * c + 2.0 * G[0][1] * G[0][2] * G[1][2] - a * G[1][2] * G[1][2] -
      b * G[0][2] * G[0][2] - c * G[0][1] * G[0][1];
  const double r = std::max(-1.0, std::min(1.0, 0.5 * det / (p * p * p)));
  return mean + 2.0 * p * cos(acos(r) / 3.0);
}

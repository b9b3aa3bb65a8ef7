/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/shared_strain.h"

#include "math/matrix.h"
#include "mesh/bending.h"

#include <cmath>

using namespace MPM_NS;

static constexpr int NODES[2][3] = {{0, 1, 2}, {1, 0, 3}};

void SharedStrain::define(const double (*X)[3])
{
  double edge[3], normal[2][3], height[2];
  for (int d = 0; d < 3; d++) edge[d] = X[1][d] - X[0][d];
  const double l = std::sqrt(dot(edge, edge));
  for (int side = 0; side < 2; side++) {
    double to[3];
    for (int d = 0; d < 3; d++) to[d] = X[2 + side][d] - X[0][d];
    if (side == 0)
      cross(edge, to, normal[side]);
    else
      cross(to, edge, normal[side]);
    const double twice = std::sqrt(dot(normal[side], normal[side]));
    for (double &c : normal[side]) c /= twice;
    height[side] = twice / l;

    // axes along the edge and toward the first triangle

    const double along = dot(to, edge) / l, up = side == 0 ? height[side] : -height[side];
    const double p[2][2] = {{0.0, 0.0}, {l, 0.0}};
    const double at[3][2] = {{p[NODES[side][0]][0], 0.0}, {p[NODES[side][1]][0], 0.0}, {along, up}};
    const double inverse = 1.0 / twice;
    for (int k = 0; k < 3; k++) {
      const double *const a = at[(k + 1) % 3], *const b = at[(k + 2) % 3];
      g[side][k][0] = inverse * (a[1] - b[1]);
      g[side][k][1] = inverse * (b[0] - a[0]);
    }
  }
  const double first = 0.5 * l * height[0], second = 0.5 * l * height[1];
  weight = is_smooth(normal[0], normal[1]) ? PART * first * second / (3.0 * (first + second)) : 0.0;
}

double SharedStrain::energy(double K, double nu, const double (*x)[3], double (*f)[3]) const
{
  if (weight == 0.0) return 0.0;
  double a[2][2][3] = {{{0.0}}}, strain[2][3],
         square = 0.0;    // of each side: along the axes; xx, yy, xy
  for (int side = 0; side < 2; side++) {
    for (int k = 0; k < 3; k++)
      for (int c = 0; c < 2; c++)
        for (int d = 0; d < 3; d++) a[side][c][d] += g[side][k][c] * x[NODES[side][k]][d];
    double *const e = strain[side];
    e[0] = 0.5 * (dot(a[side][0], a[side][0]) - 1.0);
    e[1] = 0.5 * (dot(a[side][1], a[side][1]) - 1.0);
    e[2] = 0.5 * dot(a[side][0], a[side][1]);
    square += 0.5 * (e[0] * e[0] + e[1] * e[1] + 2.0 * e[2] * e[2]);
  }
  const double part = 1.0 - square / (SMALL * SMALL);
  if (part <= 0.0) return 0.0;
  const double *const e = strain[0], *const o = strain[1];
  const double xx = e[0] - o[0], yy = e[1] - o[1], xy = e[2] - o[2];
  const double stress[3] = {K * (xx + nu * yy), K * (yy + nu * xx), K * (1.0 - nu) * xy};
  const double all = 0.5 * (stress[0] * xx + stress[1] * yy + 2.0 * stress[2] * xy);
  const double scale = weight * part * part, change = -2.0 * weight * part * all / (SMALL * SMALL);
  for (int side = 0; side < 2; side++) {
    double S[3];
    for (int c = 0; c < 3; c++)
      S[c] = (side == 0 ? scale : -scale) * stress[c] + change * strain[side][c];
    for (int k = 0; k < 3; k++) {
      const double *const h = g[side][k];
      const double u = S[0] * h[0] + S[2] * h[1], v = S[2] * h[0] + S[1] * h[1];
      for (int d = 0; d < 3; d++) f[NODES[side][k]][d] += u * a[side][0][d] + v * a[side][1][d];
    }
  }
  return -scale * all;
}

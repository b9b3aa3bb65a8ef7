/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/bending.h"

#include "math/matrix.h"
#include "mesh/gmsh.h"
#include "mesh/rims.h"
#include "mesh/vector3.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace MPM_NS;
using namespace MPM_NS::vector3;

/** Unit normal of the first three nodes, and with g also the gradients of their functions; returns
 *  the area. */
static double normal_of(const double (*x)[3], double *n, double (*g)[3] = nullptr)
{
  double a[3], b[3];
  difference(x[1], x[0], a);
  difference(x[2], x[0], b);
  cross(a, b, n);
  const double twice = norm(n);
  for (int d = 0; d < 3; d++) n[d] /= twice;
  for (int k = 0; k < 3 && g; k++) {
    double edge[3];
    difference(x[(k + 2) % 3], x[(k + 1) % 3], edge);
    cross(n, edge, g[k]);
    for (int d = 0; d < 3; d++) g[k][d] /= twice;
  }
  return 0.5 * twice;
}

/** Take the curvature across rims without moment that makes it none: the energy is least for
 *  that. */
void BentTriangle::relax(double nu, double *change) const
{
  double M[2] = {0.0, 0.0}, coupling = 0.0;
  for (int r = 0; r < nfree; r++) {
    const double xx = m[r][0] * m[r][0], yy = m[r][1] * m[r][1], xy = m[r][0] * m[r][1];
    M[r] =
        (xx + nu * yy) * change[0] + (yy + nu * xx) * change[1] + 2.0 * (1.0 - nu) * xy * change[2];
  }
  if (nfree == 2) {
    const double c = m[0][0] * m[1][0] + m[0][1] * m[1][1];
    coupling = c * c + nu * (1.0 - c * c);
  }
  const double factor = 1.0 / (1.0 - coupling * coupling);
  for (int r = 0; r < nfree; r++) {
    const double k = factor * (M[r] - coupling * M[1 - r]);
    change[0] -= k * m[r][0] * m[r][0];
    change[1] -= k * m[r][1] * m[r][1];
    change[2] -= k * m[r][0] * m[r][1];
  }
}

double BentTriangle::bend(double D, double nu, const double (*x)[3], double (*f)[3]) const
{
  double normal[3], g[3][3], up[PATCH_NODES], force[PATCH_NODES] = {0.0}, change[MOST],
                                              moment[MOST], turn[3] = {0.0}, energy = 0.0;
  normal_of(x, normal, g);
  for (int k = 0; k < n; k++) up[k] = dot(x[k], normal);
  for (int c = 0; c < nrow; c++) {
    change[c] = -rest[c];
    for (int k = 0; k < n; k++) change[c] += h[c * n + k] * up[k];
  }
  if (nfree) relax(nu, change);
  for (int c = 0; c < ncurvature; c += 3) {
    moment[c] = change[c] + nu * change[c + 1];
    moment[c + 1] = change[c + 1] + nu * change[c];
    moment[c + 2] = 2.0 * (1.0 - nu) * change[c + 2];
  }
  for (int c = ncurvature; c < nrow; c++) moment[c] = change[c];
  for (int c = 0; c < nrow; c++) {
    moment[c] *= area * D;
    energy += 0.5 * moment[c] * change[c];
    for (int k = 0; k < n; k++) force[k] += moment[c] * h[c * n + k];
  }

  // what turns the normal
  for (int k = 0; k < n; k++)
    for (int d = 0; d < 3; d++) turn[d] += force[k] * x[k][d];
  for (int k = 0; k < 3; k++) force[k] -= dot(turn, g[k]);

  for (int k = 0; k < n; k++)
    for (int d = 0; d < 3; d++) f[k][d] -= force[k] * normal[d];
  return energy;
}

void BentTriangle::stiffness_sums(double nu, double *sum) const
{
  double size[MOST / 3][PATCH_NODES], wave[PATCH_NODES], all[MOST / 3] = {0.0}, waves = 0.0;
  for (int k = 0; k < n; k++) {
    double square = 0.0;
    for (int c = ncurvature; c < nrow; c++) square += h[c * n + k] * h[c * n + k];
    for (int t = 0; t < ncurvature / 3; t++) {
      const double *const of = h + 3 * t * n + k;
      size[t][k] = std::sqrt(of[0] * of[0] + of[n] * of[n] + 2.0 * of[2 * n] * of[2 * n]);
      all[t] += size[t][k];
    }
    wave[k] = std::sqrt(square);
    waves += wave[k];
  }
  for (int k = 0; k < n; k++) {
    double curvatures = 0.0;
    for (int t = 0; t < ncurvature / 3; t++) curvatures += size[t][k] * all[t];
    sum[k] = area * ((1.0 + std::fabs(nu)) * curvatures + wave[k] * waves);
  }
}

/** Unit vectors along both lines and their lengths, and the angle; u: the directions to which each
 *  would turn the other. */
static double angle_of(int dim, const double (*x)[3], double *l, double (*u)[3])
{
  double t[2][3];
  for (int k = 0; k < 2; k++) {
    difference(x[k + 1], x[k], t[k]);
    l[k] = norm(t[k]);
    for (double &c : t[k]) c /= l[k];
  }
  const double c = dot(t[0], t[1]);
  if (dim == 2) {
    for (int k = 0; k < 2; k++) {
      u[k][0] = -t[k][1];
      u[k][1] = t[k][0];
      u[k][2] = 0.0;
    }
    return std::atan2(t[0][0] * t[1][1] - t[0][1] * t[1][0], c);
  }
  double n[3];
  cross(t[0], t[1], n);
  const double s = norm(n);
  for (int d = 0; d < 3; d++) {
    u[0][d] = s > 0.0 ? (t[1][d] - c * t[0][d]) / s : 0.0;
    u[1][d] = s > 0.0 ? (c * t[1][d] - t[0][d]) / s : 0.0;
  }
  return std::atan2(s, c);
}

void BentLine::define(int dim, const double (*X)[3])
{
  double u[2][3];
  rest = angle_of(dim, X, length, u);
}

double BentLine::bend(double D, int dim, const double (*x)[3], double (*f)[3]) const
{
  double l[2], u[2][3];
  const double change = angle_of(dim, x, l, u) - rest, moment = D * change / mean();
  for (int d = 0; d < 3; d++) {
    const double a = moment * u[0][d] / l[0], b = moment * u[1][d] / l[1];
    f[0][d] -= a;
    f[1][d] += a + b;
    f[2][d] -= b;
  }
  return 0.5 * moment * change;
}

void BentLine::stiffness_sums(double *sum) const
{
  const double a = 1.0 / length[0], b = 1.0 / length[1];
  const double size[3] = {a, a + b, b};
  for (int k = 0; k < 3; k++) sum[k] = size[k] * 2.0 * (a + b) / mean();
}

static constexpr int NODES[2][3] = {{0, 1, 2}, {1, 0, 3}};

void SharedStrain::define(const double (*X)[3])
{
  double edge[3], normal[2][3], height[2];
  difference(X[1], X[0], edge);
  const double l = norm(edge);
  for (int side = 0; side < 2; side++) {
    double to[3];
    difference(X[2 + side], X[0], to);
    cross(side == 0 ? edge : to, side == 0 ? to : edge, normal[side]);
    const double twice = norm(normal[side]);
    for (double &c : normal[side]) c /= twice;
    height[side] = twice / l;

    // axes along the edge and toward the first triangle
    const double along = dot(to, edge) / l, up = side == 0 ? height[side] : -height[side];
    const double at[3][2] = {{side == 0 ? 0.0 : l, 0.0}, {side == 0 ? l : 0.0, 0.0}, {along, up}};
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

/** What bends: triangles with their neighbors, or pairs of lines. */
void Mesh::add_bending()
{
  const auto n = elements.size();
  Rims rims = find_rims(*this);
  std::vector<char> at_rim(this->nodes.size(), 0);
  for (const auto &[nodes, parts] : rims)
    if (parts.size() == 1) at_rim[nodes.first] = at_rim[nodes.second] = 1;
  for (std::size_t e = 0; e < n; e++) {
    const MeshElement element = elements[e];    // a copy, as the list grows
    if (element.type == ElementType::LINE) continue;
    MeshElement patch = element;
    patch.type = ElementType::PATCH;
    std::fill(patch.node + 3, patch.node + PATCH_NODES, patch.node[0]);
    // node across the edge of a triangle, node 0 if there is none
    const auto across = [&](std::size_t from, int a, int b, std::size_t *to = nullptr) {
      for (const auto &[other, opposite] : rims[std::minmax(a, b)])
        if (other != from) {
          if (to) *to = other;
          return elements[other].node[opposite];
        }
      return patch.node[0];
    };
    for (int k = 0; k < 3; k++) {
      const int a = element.node[(k + 1) % 3], b = element.node[(k + 2) % 3];
      std::size_t next = e;
      patch.node[3 + k] = across(e, a, b, &next);
      if (next == e) continue;
      patch.node[6 + 2 * k] = across(next, a, patch.node[3 + k]);
      patch.node[7 + 2 * k] = across(next, patch.node[3 + k], b);
    }
    patch.inside = std::none_of(patch.node, patch.node + PATCH_NODES, [&](int k) {
      return at_rim[k];
    });
    elements.push_back(patch);
  }
  add_edges(*this, rims);
}

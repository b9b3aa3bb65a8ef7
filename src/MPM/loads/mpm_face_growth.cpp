/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/mpm_face_growth.h"

#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// least variance of the places of points along the surface, in squares of node spacings: fewer than
// three points have less
static constexpr double LEAST_SPREAD = 1.0e-4;

/* ----------------------------------------------------------------------
   Displacements U = u + (A - 1) (X - X0) with the scatter C = <(X - X0) (X - X0)^T> of places and B
   = <(U - u) (X - X0)^T> have A = 1 + B C^-1. Each node has those around itself, relative to its
   own means, so that they do not depend on an origin; a point takes the mean of its nodes. What
   points of one layer tell of the derivative along the normal does not matter for the area |cof(A)
   n|, and it is made nothing by a large scatter along the normal.
------------------------------------------------------------------------- */

void MPMFaceGrowth::find(MPMField &field, const std::function<Member(int)> &member,
                         const std::function<void(int, double)> &use)
{
  const int dim = field.lattice.dim, square = dim * dim;
  const double h = field.lattice.h;
  // of nodes: weight, displacement, place, and their products
  const int U = 1, X = U + dim, UX = X + dim, XX = UX + square, width = XX + square;
  const MPMStencil stencil(field);
  struct Found {
    int i, slot;
    Member is;
  };
  std::vector<Found> found;
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const Member is = member((int) i);
      if (is.layer >= 0) found.push_back({(int) i, run.slot, is});
    }

  for (int layer = 0; layer < LAYERS; layer++) {
    sums.assign((std::size_t) field.grid.nnodes() * width, 0.0);
    for (const auto &point : found) {
      if (point.is.layer != layer) continue;
      const double *const u = point.is.moved;
      stencil.visit(field.grid.blocks[point.slot], point.i, [&](const MPMStencil::Node &node) {
        double *const sum = &sums[node.number * width];
        const double w = node.weight;
        sum[0] += w;
        for (int a = 0; a < dim; a++) {
          const double place = h * node.r[a] - u[a];
          sum[U + a] += w * u[a];
          sum[X + a] += w * place;
          for (int b = 0; b < dim; b++) {
            sum[UX + dim * b + a] += w * u[b] * place;
            sum[XX + dim * b + a] += w * (h * node.r[b] - u[b]) * place;
          }
        }
      });
    }
    field.nodes.sum(sums.data(), width, 0, width);
    field.nodes.complete(sums.data(), width, width);

    for (const auto &point : found) {
      if (point.is.layer != layer) continue;
      double C[9] = {0.0}, B[9] = {0.0}, total = 0.0;
      stencil.visit(field.grid.blocks[point.slot], point.i, [&](const MPMStencil::Node &node) {
        const double *const sum = &sums[node.number * width], w = node.weight;
        if (!(sum[0] > 0.0)) return;
        total += w * sum[0];
        for (int a = 0; a < dim; a++)
          for (int b = 0; b < dim; b++) {
            B[3 * a + b] += w * (sum[UX + dim * a + b] - sum[U + a] * sum[X + b] / sum[0]);
            C[3 * a + b] += w * (sum[XX + dim * a + b] - sum[X + a] * sum[X + b] / sum[0]);
          }
      });
      if (!(total > 0.0)) continue;
      const double *const n = point.is.normal, unit = 1.0 / (total * h * h);
      for (int k = 0; k < 9; k++) {
        B[k] *= unit;
        C[k] = unit * C[k] + n[k / 3] * n[k % 3];
      }
      if (dim == 2) C[8] = 1.0;
      const double spread = determinant(C);
      if (!(spread > (dim == 2 ? LEAST_SPREAD : LEAST_SPREAD * LEAST_SPREAD))) continue;
      const double inverse[9] = MPM_COFACTORS(C);    // times the determinant; C is symmetric
      double A[9];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          A[3 * a + b] = a == b ? 1.0 : 0.0;
          for (int k = 0; k < 3; k++) A[3 * a + b] += B[3 * a + k] * inverse[3 * k + b] / spread;
        }
      if (field.options.axisymmetric) {
        const double r = field.frame->places()[point.i][0], before = r - point.is.moved[0];
        if (before > 0.0) A[8] = r / before;
      }
      const double cofactors[9] = MPM_COFACTORS(A);
      double area = 0.0;
      for (int a = 0; a < 3; a++) {
        const double component = dot(cofactors + 3 * a, n);
        area += component * component;
      }
      if (area > 0.0) use(point.i, std::sqrt(area));
    }
  }
}

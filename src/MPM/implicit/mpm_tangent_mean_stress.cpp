/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Pressures that points have besides the stress of their material: averages of it around points
   (locking pressure), and that of nodes. Averages S p of the mean stress p take the place of that
   of the points, P <- P + c J G with c = S p - p and G = F^-T. Their derivative is that with c as
   it is, which is in the tangents, and J G (S dp - dp), which points around have a part in.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "implicit/mpm_tangent_gather.h"
#include "material/batch_kernels.h"
#include "math/matrix.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** J G of F [9] of the places. */
void MPMTangent::find_volume_gradient(const double *F, double *g) const
{
  const double f[9] = {F[0], F[1], F[2], F[3], F[4], F[5], F[6], F[7], F[8]};
  const double cofactors[9] = MPM_COFACTORS(f);
  for (int k = 0; k < nL; k++) g[k] = cofactors[3 * (k % dim) + k / dim];
  if (nH > nL) g[nL] = cofactors[8];
}

/** Points of each material take the average S p of the mean stress, see MPMLocking. */
void MPMTangent::average(const MPMNodeScalar::TakeValues &take)
{
  for (const auto *material : field.materials) {
    means.points_to_nodes(
        [&](const MPMPointMap::Run &run, int first, int n, MPMNodeScalar::Points &points) {
          if (run.material != material) return false;
          for (int p = 0; p < n; p++) {
            points.row[p][3] = mean_stress[first + p];
            points.capacity[p] = volumes[first + p];
          }
          return true;
        },
        false);
    means.values_to_points(take);
  }
}

void MPMTangent::add_averages(const double *u)
{
  std::fill(added.begin(), added.end(), 0.0);
  average([&](const MPMPointMap::Run &, int first, int n, const double *mean) {
    for (int p = 0; p < n; p++) added[first + p] = mean[p] - mean_stress[first + p];
  });
  add_to_stress(u);
}

/** P <- P + c J G */
void MPMTangent::add_to_stress(const double *u)
{
  gather(u, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    double F[9 * BATCH], g[10];
    deform(first, n, H);
    lattice_F(first, n, H, F);
    for (int p = 0; p < n; p++) {
      const bigint i = first + p;
      if (nH > nL) F[9 * p + 8] = 1.0 + H[nH * p + nL];
      find_volume_gradient(F + 9 * p, g);
      const double scale = added[i] * batch->J[p] / determinant(F + 9 * p);
      for (int k = 0; k < nL; k++) P[nL * i + k] += scale * g[k];
      if (nH > nL) hoop_stress[i] += scale * g[nL];
    }
  });
}

void MPMTangent::differentiate_added(int first, int n, const double *H)
{
  double F[9 * BATCH], low[10], high[10];
  deform(first, n, H);
  lattice_F(first, n, H, F);
  for (int p = 0; p < n; p++) {
    const bigint i = first + p;
    double *const f = F + 9 * p, *const g = &volume_gradients[nH * i];
    if (nH > nL) f[8] = 1.0 + H[nH * p + nL];
    // J over that of the places does not change with H
    const double ratio = batch->J[p] / determinant(f);
    find_volume_gradient(f, g);
    for (int k = 0; k < nH; k++) g[k] *= ratio;
    for (int k = 0; k < nH; k++) {    // cofactors are linear in each entry
      double &entry = f[k < nL ? 3 * (k % dim) + k / dim : 8];
      const double value = entry;
      entry = value - 0.5;
      find_volume_gradient(f, low);
      entry = value + 0.5;
      find_volume_gradient(f, high);
      entry = value;
      for (int l = 0; l < nH; l++)
        tangents[i * nH * nH + nH * k + l] += added[i] * ratio * (high[l] - low[l]);
    }
  }
}

/** Of a change of motion whose changes of the mean stress are known. */
void MPMTangent::average_changes()
{
  average([&](const MPMPointMap::Run &, int first, int n, const double *mean) {
    for (int p = 0; p < n; p++) {
      const bigint i = first + p;
      const double change = mean[p] - mean_stress[i], *const g = &volume_gradients[nH * i];
      for (int k = 0; k < nL; k++) P[nL * i + k] += change * g[k];
      if (nH > nL) hoop_stress[i] += change * g[nL];
    }
  });
}

void MPMTangent::volume_changes(const double *u, double *dV)
{
  gather(u, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    for (int p = 0; p < n; p++)
      dV[first + p] = field.points->jacobian(first + p) * atom->vfrac[first + p] *
          field.frame->volume_change(first + p, H + nH * p, 1.0);
  });
}

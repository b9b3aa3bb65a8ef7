/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// What acts on points besides the stress of their material: loads that follow their deformation,
// averages of the pressure around them, and the pressure of nodes.

#include "implicit/mpm_tangent.h"

#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_plan.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ----------------------------------------------------------------------
   Loads (MPMLoad::follow()): the pressure on a surface that becomes larger and turns in the step.
   Their forces on points depend on H as stress does, but not as derivatives of an energy of these
   points: systems are not symmetric.
------------------------------------------------------------------------- */

bool MPMTangent::follows(int first, int n) const
{
  if (!loaded) return false;
  const auto &all = field.plan->loads;
  return std::any_of(all.begin(), all.end(), [&](const auto *load) {
    return load->follows(field, first, first + n);
  });
}

/** Start of a step: which loads are there? */
void MPMTangent::find_loads()
{
  loaded = true;    // for follows()
  int mine = 0, any = 0;
  for (const auto &run : field.map->runs)
    if (run.material && !mine) mine = follows((int) run.first, (int) (run.last - run.first));
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  loaded = any != 0 || between.size() > nelements;
  const std::size_t nmax = atom->nmax;
  load_forces.assign(loaded ? 3 * nmax : 0, 0.0);
  load_tangents.assign(loaded ? 3 * nmax * nH : 0, 0.0);
}

/** Loads on n points from first on after H [n][nH]: their P [n][nH], and forces, in load_forces. */
void MPMTangent::load_points(int first, int n, const double *H, double *stress)
{
  double F[9 * BATCH], tau[6 * BATCH + 8] = {0.0};
  deform(first, n, H);
  for (int p = 0; p < n; p++)
    for (int c = 0; c < 9; c++) F[9 * p + c] = batch->F[c][p];
  double *const push = &load_forces[3 * (bigint) first];
  std::fill_n(push, 3 * n, 0.0);
  for (const auto *load : field.plan->loads) load->follow(field, first, n, F, push, tau);
  find_piola(first, n, H, tau, stress);
}

/** Adds dP/dH of the loads to that of the material. */
void MPMTangent::differentiate_loads(int first, int n, const double *H)
{
  double other[10 * BATCH], low[10 * BATCH + 8], high[10 * BATCH + 8], push[3 * BATCH];
  std::copy_n(H, nH * n, other);
  const bigint i = first;
  for (int k = 0; k < nH; k++) {
    for (int p = 0; p < n; p++) other[nH * p + k] = H[nH * p + k] - DIFFERENCE;
    load_points(first, n, other, low);
    std::copy_n(&load_forces[3 * i], 3 * n, push);
    for (int p = 0; p < n; p++) other[nH * p + k] = H[nH * p + k] + DIFFERENCE;
    load_points(first, n, other, high);
    for (int p = 0; p < n; p++) {
      const double step = (H[nH * p + k] + DIFFERENCE) - (H[nH * p + k] - DIFFERENCE);
      double *const column = &tangents[(i + p) * nH * nH + nH * k];
      for (int l = 0; l < nH; l++) column[l] += (high[nH * p + l] - low[nH * p + l]) / step;
      for (int d = 0; d < 3; d++)
        load_tangents[3 * nH * (i + p) + 3 * k + d] =
            (load_forces[3 * (i + p) + d] - push[3 * p + d]) / step;
      other[nH * p + k] = H[nH * p + k];
    }
  }
}

double MPMTangent::asymmetry_of_loads() const
{
  const auto step = field.step_data();
  double mine[2] = {0.0, 0.0}, all[2];
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double V = step.stress_scale * atom->vfrac[i] / field.lattice.h;
      for (int k = 0; k < nH * nH; k++)
        mine[0] = std::max(mine[0], V * std::fabs(tangents[i * nH * nH + k]));
      for (int k = 0; k < 3 * nH; k++)
        mine[1] = std::max(mine[1], step.force_scale * std::fabs(load_tangents[3 * nH * i + k]));
    }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_MAX, world);
  return all[0] > 0.0 ? all[1] / all[0] : 0.0;
}

void MPMTangent::loads(const double *u, double *force)
{
  clear_stress();
  std::fill(load_forces.begin(), load_forces.end(), 0.0);
  gather(u, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    if (!follows(first, n)) return;
    double stresses[10 * BATCH + 8];
    load_points(first, n, H, stresses);
    keep_stress(first, n, stresses);
  });
  double sizes = 0.0;
  add_between(nelements, u, sizes);
  scatter(sum_forces.data(), force);
}

/* ----------------------------------------------------------------------
   Pressures. Averages S p of the mean stress p take the place of that of the points, P <- P + c J G
   with c = S p - p and G = F^-T. Their derivative is that with c as it is, which is in the
   tangents, and J G (S dp - dp), which points around have a part in.
------------------------------------------------------------------------- */

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

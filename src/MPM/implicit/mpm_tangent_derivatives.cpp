/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Derivatives of the stress of points, and the product of all of them with a motion. By the tangent
   of the material: with F that of the places, dP = (dtau - tau l^T) F^-T, and for a change of H_rc,
   of which l has the row r of dF F^-1, l_rs = (F^-1)_cs. Materials without a tangent have central
   differences.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "field/fix_mpm_material.h"
#include "field/mpm_interfaces.h"
#include "math/matrix.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMTangent::take_differences(const MPMPointMap::Run &run, int first, int n, const double *H,
                                  double dt)
{
  double other[10 * BATCH], low[10 * BATCH + 8], high[10 * BATCH + 8];
  std::copy_n(H, nH * n, other);
  for (int k = 0; k < nH; k++) {
    for (int p = 0; p < n; p++) other[nH * p + k] = H[nH * p + k] - DIFFERENCE;
    stress(run, first, n, other, dt, low);
    double mean[BATCH];
    if (averages) std::copy_n(&mean_stress[first], n, mean);
    for (int p = 0; p < n; p++) other[nH * p + k] = H[nH * p + k] + DIFFERENCE;
    stress(run, first, n, other, dt, high);
    for (int p = 0; p < n; p++) {
      // the difference of the numbers as they are, not of those that were meant
      const double step = (H[nH * p + k] + DIFFERENCE) - (H[nH * p + k] - DIFFERENCE);
      double *const column = &tangents[((bigint) first + p) * nH * nH + nH * k];
      for (int l = 0; l < nH; l++) column[l] = (high[nH * p + l] - low[nH * p + l]) / step;
      if (averages)
        mean_tangents[nH * ((bigint) first + p) + k] = (mean_stress[first + p] - mean[p]) / step;
      other[nH * p + k] = H[nH * p + k];
    }
  }
}

void MPMTangent::differentiate(const MPMPointMap::Run &run, int first, int n, const double *H,
                               double dt)
{
  static constexpr int COMPONENT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  double P[10 * BATCH + 8], F[9 * BATCH];
  tangent->plane = dim == 2;
  stress(run, first, n, H, dt, P, tangent.get());
  lattice_F(first, n, H, F);
  const Batch &b = *batch;
  // what laws give has points side by side, and so have all sums here
  double cofactor[9][BATCH], det[BATCH], l[3][BATCH], d[3][3][BATCH], trace[BATCH];
  for (int p = 0; p < n; p++) {
    double *const f = F + 9 * p;
    if (nH > nL) f[8] = 1.0 + H[nH * p + nL];    // around the axis
    const double cofactors[9] = MPM_COFACTORS(f);
    for (int c = 0; c < 9; c++) cofactor[c][p] = cofactors[c];
    det[p] = determinant(f);
  }
  for (int k = 0; k < nH; k++) {
    const int r = k < nL ? k % dim : 2, c = k < nL ? k / dim : 2;
    for (int s = 0; s < 3; s++)
      for (int p = 0; p < n; p++) l[s][p] = cofactor[3 * s + c][p] / det[p];
    std::fill_n(trace, n, 0.0);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        double *const sum = d[i][j];
        std::fill_n(sum, n, 0.0);
        for (int s = 0; s < 3; s++) {
          if (tangent->skips(3 * r + s)) continue;
          const double *const change = tangent->stress[COMPONENT[i][j]][3 * r + s],
                              *const stress = b.stress[COMPONENT[i][s]];
          for (int p = 0; p < n; p++) sum[p] += change[p] * l[s][p];
          for (int p = 0; p < n && i == j; p++) trace[p] += change[p] * l[s][p];
          for (int p = 0; p < n && j == r; p++) sum[p] -= b.J[p] * stress[p] * l[s][p];
        }
      }
    for (int p = 0; p < n && averages; p++)
      mean_tangents[nH * ((bigint) first + p) + k] =
          trace[p] / (3.0 * b.J[p]) - mean_stress[first + p] * l[r][p];
    for (int m = 0; m < nH; m++) {
      const int row = m < nL ? m % dim : 2, column = m < nL ? m / dim : 2;
      double *const K = &tangents[(bigint) first * nH * nH + nH * k + m];
      for (int p = 0; p < n; p++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++) sum += d[row][j][p] * cofactor[3 * j + column][p];
        K[nH * nH * p] = sum / det[p];
      }
    }
  }
}

double MPMTangent::linearize(const double *u, double dt)
{
  tangents.resize((std::size_t) atom->nmax * nH * nH);
  if (keeps_stress) stress_tangents.resize(tangents.size());
  if (averages) mean_tangents.resize((std::size_t) atom->nmax * nH);
  if (adds()) volume_gradients.resize((std::size_t) atom->nmax * nH);
  double sum = 0.0, all;
  gather(u, [&](const MPMPointMap::Run &run, int first, int n, const double *H) {
    if (keeps_deformations) keep_deformations(first, n, H);
    if (!run.material)
      std::fill_n(&tangents[(bigint) first * nH * nH], n * nH * nH, 0.0);
    else if (run.material->material->has_tangent())
      differentiate(run, first, n, H, dt);
    else
      take_differences(run, first, n, H, dt);
    for (int p = 0; p < n; p++) {
      const double *const K = &tangents[((bigint) first + p) * nH * nH];
      double most = 0.0;
      for (int k = 0; k < nH * nH; k++) most = std::max(most, std::fabs(K[k]));
      sum += atom->vfrac[first + p] * most;
    }
    if (keeps_stress) {
      const std::size_t begin = (std::size_t) first * nH * nH;
      std::copy_n(&tangents[begin], (std::size_t) n * nH * nH, &stress_tangents[begin]);
    }
    if (adds()) differentiate_added(first, n, H);
    if (follows(first, n)) differentiate_loads(first, n, H);
  });
  for (const auto &[i, share] : carried) {
    for (int k = 0; k < nH * nH; k++) tangents[nH * nH * i + k] *= share;
    for (int k = 0; k < 3 * nH && loaded; k++) load_tangents[3 * nH * i + k] *= share;
  }
  sum *= field.step_data().stress_scale / field.lattice.h;
  if (!between.empty()) move_points(u);
  for (auto *forces : between)
    sum += field.step_data().force_scale * forces->differentiate(point_motion.data());
  MPI_Allreduce(&sum, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** P = K H of n points, [n][N][N] with a column for each entry of H. */
template <int N> static void multiply(int n, const double *K, const double *H, double *P)
{
  for (int p = 0; p < n; p++, K += N * N, H += N, P += N) {
    double sum[N] = {0.0};
    for (int k = 0; k < N; k++)
      for (int l = 0; l < N; l++) sum[l] += K[N * k + l] * H[k];
    for (int l = 0; l < N; l++) P[l] = sum[l];
  }
}

void MPMTangent::change_of_forces(const double *du, double *dforce, const double *dp, double *dV)
{
  gather(du, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    const double *const K = &present()[(bigint) first * nH * nH];
    double *const stress = &P[(bigint) nL * first];
    if (nH == 4)
      multiply<4>(n, K, H, stress);
    else if (nH == 9)
      multiply<9>(n, K, H, stress);
    else
      for (int p = 0; p < n; p++) {
        double sum[5];
        multiply<5>(1, K + 25 * p, H + 5 * p, sum);
        std::copy_n(sum, nL, stress + nL * p);
        hoop_stress[first + p] = sum[nL];
      }
    for (int p = 0; p < n && dp; p++) {
      const bigint i = first + p;
      const double *const g = &volume_gradients[nH * i], *const h = H + nH * p;
      double change = 0.0;
      for (int k = 0; k < nH; k++) change += g[k] * h[k];
      dV[i] = atom->vfrac[i] * change;
      for (int k = 0; k < nL; k++) P[nL * i + k] -= dp[i] * g[k];
    }
    for (int p = 0; p < n && (averages || loaded); p++) {
      const double *const h = H + nH * p;
      if (averages) {
        double change = 0.0;
        for (int k = 0; k < nH; k++) change += mean_tangents[nH * ((bigint) first + p) + k] * h[k];
        mean_stress[first + p] = change;
      }
      for (int d = 0; d < 3 && loaded; d++) {
        const double *const G = &load_tangents[3 * nH * ((bigint) first + p)];
        double change = 0.0;
        for (int k = 0; k < nH; k++) change += G[3 * k + d] * h[k];
        load_forces[3 * ((bigint) first + p) + d] = change;
      }
    }
  });
  if (averages) average_changes();
  if (!between.empty()) {
    sum_forces = loaded ? load_forces : no_force;
    move_points(du);
    for (auto *forces : between) forces->add_change(point_motion.data(), sum_forces.data());
    return scatter(sum_forces.data(), dforce);
  }
  scatter(loaded ? load_forces.data() : no_force.data(), dforce);
}

double MPMTangent::asymmetry() const
{
  double mine[3] = {0.0, 0.0, 0.0}, all[3];
  for (const auto *forces : between) mine[2] = std::max(mine[2], forces->asymmetry());
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &tangents[i * nH * nH];
      for (int k = 0; k < nH; k++)
        for (int l = 0; l <= k; l++) {
          mine[0] = std::max(mine[0], std::fabs(K[nH * k + l] - K[nH * l + k]));
          mine[1] = std::max(mine[1], std::fabs(K[nH * k + l]));
        }
    }
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_MAX, world);
  const double of_stress = std::max(all[1] > 0.0 ? all[0] / all[1] : 0.0, all[2]);
  return loaded ? std::max(of_stress, asymmetry_of_loads()) : of_stress;
}

void MPMTangent::find_moduli(std::vector<double> &moduli) const
{
  moduli.assign(atom->nmax, 0.0);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &tangents[i * nH * nH];
      for (int d = 0; d < dim; d++) moduli[i] += K[(nH + 1) * (dim + 1) * d] / dim;
    }
}

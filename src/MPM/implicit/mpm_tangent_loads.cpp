/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Loads that follow the deformation of points (MPMLoad::follow()), with their derivatives: the
// pressure on a surface that becomes larger and turns in the step. Forces of such loads on points
// depend on H as stress does, but not as derivatives of an energy of these points: systems are not
// symmetric.

#include "implicit/mpm_tangent.h"

#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_plan.h"
#include "implicit/mpm_tangent_gather.h"
#include "material/batch_kernels.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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
  std::fill(P.begin(), P.end(), 0.0);
  std::fill(hoop_stress.begin(), hoop_stress.end(), 0.0);
  std::fill(load_forces.begin(), load_forces.end(), 0.0);
  gather(u, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    if (!follows(first, n)) return;
    double stresses[10 * BATCH + 8];
    load_points(first, n, H, stresses);
    for (int p = 0; p < n; p++) {
      std::copy_n(stresses + nH * p, nL, &P[(bigint) nL * (first + p)]);
      if (nH > nL) hoop_stress[first + p] = stresses[nH * p + nL];
    }
  });
  sum_forces = load_forces;
  if (between.size() > nelements) move_points(u);
  for (std::size_t k = nelements; k < between.size(); k++) {
    double sizes = 0.0;
    point_forces.resize(3 * (std::size_t) atom->nmax);
    between[k]->forces_after(point_motion.data(), point_forces.data(), sizes);
    const double *const before = between[k]->forces();
    for (std::size_t j = 0; j < 3 * (std::size_t) atom->nlocal; j++)
      sum_forces[j] += point_forces[j] - before[j];
  }
  scatter(sum_forces.data(), force);
}

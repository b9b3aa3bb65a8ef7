/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The forces of a trial motion are those of the total frame whose reference is where points are at
   the start of the step: f_i = -sum_p V_p P dN_ip/dX, so that kernels of that frame serve. With the
   gradients of the same transfer in both directions they are the derivatives of the stored energy
   by u, as far as there is one, and the matrix of second derivatives is never made: its product
   with a vector is a way from nodes to points and back.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "base/mpm_points.h"
#include "elements/fix_mpm_elements.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_plan.h"
#include "field/mpm_time_limit.h"
#include "math/matrix.h"
#include "solve/bytes_of.h"

#include "force.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMTangent::MPMTangent(LAMMPS *lmp, MPMField &field) :
    MPMTrialMotion(lmp, field), tangent(new Tangent()), means(field),
    averages(field.options.averages_stress())
{
}

MPMTangent::~MPMTangent() noexcept = default;

void MPMTangent::init()
{
  MPMTrialMotion::init();
  between.assign(field.elements.begin(), field.elements.end());
  if (averages) means.init(false, false);
  nelements = between.size();
  for (auto *load : field.plan->loads)
    if (auto *const forces = load->trial_forces(field)) between.push_back(forces);
  int nhistory = 1;
  for (const auto *material : field.materials) nhistory = std::max(nhistory, material->nhistory);
  history.assign((std::size_t) nhistory * BATCH, 0.0);
}

/** In sum_forces: those of loads that follow, and the change since the start of the step of those
 *  between points, from number from on. False, on this rank, where they are not finite. */
bool MPMTangent::add_between(std::size_t from, const double *u, double &size)
{
  bool good = true;
  sum_forces = loaded ? load_forces : no_force;
  if (from < between.size()) move_points(u);
  point_forces.resize(3 * (std::size_t) atom->nmax);
  for (; from < between.size(); from++) {
    auto &forces = *between[from];
    if (!forces.forces_after(point_motion.data(), point_forces.data(), size)) good = false;
    const double *const before = forces.forces();
    for (std::size_t k = 0; k < 3 * (std::size_t) atom->nlocal; k++)
      sum_forces[k] += point_forces[k] - before[k];
  }
  return good;
}

/** P [n][DIM*DIM] of the stress in a batch, whose F is that of the places of the lattice; or that
 *  is unity and H, where this is given. */
template <int DIM> static void piola_of_batch(const Batch &b, int n, const double *H, double *P)
{
  constexpr int SIZE = DIM * DIM;
  for (int p = 0; p < n; p++) {
    double f[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    for (int r = 0; r < DIM; r++)
      for (int c = 0; c < DIM; c++)
        f[3 * r + c] = H ? (r == c) + H[SIZE * p + DIM * c + r] : b.F[3 * r + c][p];
    const double cofactors[9] = MPM_COFACTORS(f), J = b.J[p];
    const double scale = J / (f[0] * cofactors[0] + f[1] * cofactors[1] + f[2] * cofactors[2]);
    const double xx = scale * b.stress[0][p], yy = scale * b.stress[1][p],
                 zz = scale * b.stress[2][p], xy = scale * b.stress[3][p],
                 xz = scale * b.stress[4][p], yz = scale * b.stress[5][p];
    double *const to = P + SIZE * p;
    for (int j = 0; j < DIM; j++) {
      const double x = cofactors[j], y = cofactors[3 + j], z = cofactors[6 + j];
      if constexpr (DIM == 2) {
        to[2 * j] = xx * x + xy * y;
        to[2 * j + 1] = xy * x + yy * y;
      } else {
        to[3 * j] = xx * x + xy * y + xz * z;
        to[3 * j + 1] = xy * x + yy * y + yz * z;
        to[3 * j + 2] = xz * x + yz * y + zz * z;
      }
    }
  }
}

/* ----------------------------------------------------------------------
   stress of n points from first on after H [n][nH]: P [n][nH], and J
------------------------------------------------------------------------- */

bool MPMTangent::stress(const MPMPointMap::Run &run, int first, int n, const double *H, double dt,
                        double *stress, Tangent *tangent)
{
  Batch &b = *batch;
  const FixMPMMaterial *const material = run.material;
  if (!material) {    // nodes of elements
    std::fill_n(stress, nH * n, 0.0);
    return true;
  }
  deform(first, n, H);
  b.dt = dt;
  b.time = elapsed_time(*update);
  b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
  if (material->nhistory)
    field.batch_kernels->load_history(
        b, material->nhistory, &material->history[0][0] + material->nhistory * (bigint) first);
  std::fill_n(b.heat, n, 0.0);
  if (tangent)
    material->material->update_with_tangent(b, *tangent);
  else
    material->material->update(b);

  bool good = true;
  for (int p = 0; p < n; p++) good &= b.J[p] > 0.0;
  const bool total = field.frame->is_total();
  if (nH == nL && !(total && field.frame->refers())) {
    (dim == 2 ? piola_of_batch<2> : piola_of_batch<3>) (b, n, total ? nullptr : H, stress);
  } else {
    double tau[6 * BATCH + 8];
    for (int p = 0; p < n; p++)
      for (int c = 0; c < 6; c++) tau[6 * p + c] = b.J[p] * b.stress[c][p];
    find_piola(first, n, H, tau, stress);
  }
  // finite ones times zero are zero, and all others are not
  double zero[2] = {0.0, 0.0};
  for (int k = 0; k + 1 < nH * n; k += 2) {
    zero[0] += 0.0 * stress[k];
    zero[1] += 0.0 * stress[k + 1];
  }
  good = good && zero[0] == 0.0 && zero[1] == 0.0 && std::isfinite(stress[nH * n - 1]);
  if (averages)
    for (int p = 0; p < n; p++)
      mean_stress[first + p] = (b.stress[0][p] + b.stress[1][p] + b.stress[2][p]) / 3.0;
  return good;
}

/** sum of V |s| of n points with stresses s [n][N] */
template <int N> static double sum_of_sizes(int n, const double *s, const double *V)
{
  double sum = 0.0;
  for (int p = 0; p < n; p++, s += N) {
    double square = 0.0;
    for (int k = 0; k < N; k++) square += s[k] * s[k];
    sum += V[p] * std::sqrt(square);
  }
  return sum;
}

/* ---------------------------------------------------------------------- */

void MPMTangent::external_forces(double *force)
{
  const std::size_t nlocal = atom->nlocal;
  P.assign(nlocal * nL, 0.0);
  no_force.resize(3 * nlocal, 0.0);
  if (nH > nL) hoop_stress.assign(nlocal, 0.0);
  find_loads();
  if (averages) {
    mean_stress.assign(nlocal, 0.0);
    volumes.resize(nlocal);
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++)
        volumes[i] = atom->vfrac[i] * field.points->jacobian((int) i);
  }
  if (adds()) added.assign(nlocal, 0.0);
  const double *const f = field.rows().f;
  scatter(f, force);
}

void MPMTangent::forces_on_carried(double *force)
{
  std::vector<double> forces(no_force.size(), 0.0);
  const double *const f = field.rows().f;
  for (const auto &[i, share] : carried)
    for (int d = 0; d < 3; d++) forces[3 * i + d] = (1.0 - share) * f[3 * i + d];
  clear_stress();
  scatter(forces.data(), force);
}

/** Of n points with stresses [n][nH]. */
void MPMTangent::keep_stress(int first, int n, const double *stresses)
{
  if (nH == nL) {
    std::copy_n(stresses, nL * n, &P[(bigint) nL * first]);
    return;
  }
  for (int p = 0; p < n; p++) {
    std::copy_n(stresses + nH * p, nL, &P[(bigint) nL * (first + p)]);
    hoop_stress[first + p] = stresses[nH * p + nL];
  }
}

void MPMTangent::reduce_carried()
{
  for (const auto &[i, share] : carried) {
    for (int k = 0; k < nL; k++) P[nL * i + k] *= share;
    if (nH > nL) hoop_stress[i] *= share;
    for (int d = 0; d < 3 && loaded; d++) load_forces[3 * i + d] *= share;
  }
}

bool MPMTangent::forces(const double *u, double dt, double *force, double &size)
{
  int bad = 0, any;
  double sum = 0.0, stresses[10 * BATCH + 8];
  gather(u, [&](const MPMPointMap::Run &run, int first, int n, const double *H) {
    if (!stress(run, first, n, H, dt, stresses)) bad = 1;
    if (keeps_deformations) keep_deformations(first, n, H);
    const auto sizes = nH == 4 ? sum_of_sizes<4> : nH == 5 ? sum_of_sizes<5> : sum_of_sizes<9>;
    sum += sizes(n, stresses, atom->vfrac + first);
    for (int p = 0; p < n && pressure; p++)
      sum += atom->vfrac[first + p] * std::fabs(pressure[first + p]);
    if (follows(first, n)) {
      double more[10 * BATCH + 8];
      load_points(first, n, H, more);
      for (int k = 0; k < nH * n; k++) stresses[k] += more[k];
    }
    keep_stress(first, n, stresses);
  });
  size = sum * field.step_data().stress_scale / field.lattice.h;
  if (!between.empty()) {
    double sizes = 0.0;
    if (!add_between(0, u, sizes)) bad = 1;
    size += sizes * field.step_data().force_scale;
  }
  MPI_Allreduce(&bad, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) return false;
  if (averages) add_averages(u);
  if (pressure) {
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) added[i] = -pressure[i];
    add_to_stress(u);
  }
  reduce_carried();
  scatter(!between.empty() ? sum_forces.data()
              : loaded     ? load_forces.data()
                           : no_force.data(),
          force);
  return true;
}

double MPMTangent::memory_usage() const
{
  return MPMTrialMotion::memory_usage() + means.memory_usage() +
      bytes_of(history, tangents, no_force, load_forces, load_tangents, stress_tangents,
               mean_stress, mean_tangents, added, volumes, volume_gradients, point_forces,
               sum_forces);
}

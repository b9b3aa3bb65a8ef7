/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The forces of a trial motion are those of the total frame whose reference is where points are at the start of the step:
   f_i = -sum_p V_p P dN_ip/dX, so that kernels of that frame serve. With the gradients of the same transfer in both
   directions they are the derivatives of the stored energy by u, as far as there is one, and the matrix of second
   derivatives is never made: its product with a vector is a way from nodes to points and back.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "base/mpm_points.h"
#include "elements/fix_mpm_elements.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_frame.h"
#include "field/mpm_internal_force.h"
#include "field/mpm_passes.h"
#include "field/mpm_physics.h"
#include "field/mpm_plan.h"
#include "field/mpm_stencil.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "material/batch.h"
#include "math/matrix.h"
#include "update.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

MPMTangent::MPMTangent(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), field(field), with(), batch(new Batch()), tangent(new Tangent()),
    dim(field.lattice.dim), nL(dim * dim), nH(nL + field.options.axisymmetric), means(field),
    averages(field.options.averages_stress())
{
}

MPMTangent::~MPMTangent() noexcept = default;

void MPMTangent::init()
{
  const auto &options = field.options;
  // forces and gradients are those of these two, which are fast in the total frame, too
  mls = is_mls(options.shape, options.transfer) && !options.strains_by_gradient();
  const Transfer transfer = mls ? APIC : (has_domain(options.shape) ? options.transfer : PIC);
  with = field.kernels->transfer_total(dim, options.shape, transfer, true);
  // there are no fast ones for what fix mpm has in the updated frame only
  if (!with.p2g_force)
    with = MPMKernels::select("reference")->transfer_total(dim, options.shape, transfer, true);
  between.assign(field.elements.begin(), field.elements.end());
  if (averages) means.init(false, false);
  nelements = between.size();
  for (auto *load : field.plan->loads)
    if (auto *const forces = load->trial_forces(field)) between.push_back(forces);
  *batch = {};
  batch->h = field.lattice.h;
  int nhistory = 1;
  for (const auto *material : field.materials) nhistory = std::max(nhistory, material->nhistory);
  history.assign((std::size_t) nhistory * BATCH, 0.0);
}

/* ----------------------------------------------------------------------
   from points to nodes: P and hoop_stress, and other forces on points
------------------------------------------------------------------------- */

void MPMTangent::scatter(const double *forces_of_points, double *force)
{
  PointRows rows = field.rows();
  rows.P = P.data();
  rows.F = nullptr;
  rows.f = forces_of_points;
  if (nH > nL) {    // hoop stress is a force on points, in units of force
    forces_on_points.resize(3 * (std::size_t) atom->nmax);
    const double unit = 1.0 / this->force->nktv2p;
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        std::copy_n(forces_of_points + 3 * i, 3, &forces_on_points[3 * i]);
        forces_on_points[3 * i] -=
            unit * rows.vol0[i] * hoop_stress[i] / field.frame->radius((int) i, rows.x[3 * i]);
      }
    rows.f = forces_on_points.data();
  }
  const TransferStep step = field.step_data();
  points_to(nodes, field, with, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    with.p2g_force(rows, step, run.first, run.last, base, field.map->tile, box);
  });
  field.nodes.sum(nodes.data(), with.nreal, 4, 4);
  const auto take = [&](auto constant) {
    constexpr int D = decltype(constant)::value;
    const double *record = nodes.data() + 4;
    const int64_t end = D * field.grid.nnodes();
    for (int64_t k = 0; k < end; k += D, record += with.nreal) std::copy_n(record, D, force + k);
  };
  if (dim == 2)
    take(std::integral_constant<int, 2>());
  else
    take(std::integral_constant<int, 3>());
}

/** use(run, first, n, H): H [n][nH] of up to BATCH points. */
template <class Use> void MPMTangent::gather(const double *u, const Use &use)
{
  // all but the motion stays zero
  const std::size_t nreals = field.grid.nnodes() * with.nreal;
  if (motion_nodes.size() != nreals) motion_nodes.assign(nreals, 0.0);
  const auto give = [&](auto constant) {
    constexpr int D = decltype(constant)::value;
    double *record = motion_nodes.data();
    const int64_t end = D * field.grid.nnodes();
    for (int64_t k = 0; k < end; k += D, record += with.nreal) std::copy_n(u + k, D, record);
  };
  if (dim == 2)
    give(std::integral_constant<int, 2>());
  else
    give(std::integral_constant<int, 3>());
  field.nodes.complete(motion_nodes.data(), with.nreal, 3);
  PointRows rows = field.rows();
  rows.P = P.data();
  rows.F = nullptr;
  const TransferStep step = field.step_data();
  double L[9 * BATCH], H[10 * BATCH], motion[3 * BATCH];
  points_from(motion_nodes, field, with, [&](const MPMPointMap::Run &run, const int *base) {
    for (int i = run.first; i < run.last; i += BATCH) {
      const int n = std::min(BATCH, run.last - i);
      PointRows b = rows_from(field, rows, i);
      b.P = P.data() + (bigint) nL * i;
      if (nH > nL) b.velocity = motion;
      with.g2p_gradient(b, step, 0, n, base, field.map->tile_load, L);
      if (nH == nL) {
        use(run, i, n, L);
        continue;
      }
      for (int p = 0; p < n; p++) {
        std::copy_n(L + nL * p, nL, H + nH * p);
        H[nH * p + nL] = motion[3 * p] / field.frame->radius(i + p, b.x[3 * p]);
      }
      use(run, i, n, H);
    }
  });
}

/** Displacements of points by the motion u. */
void MPMTangent::move_points(const double *u)
{
  nodes.assign(field.grid.nnodes() * with.nreal, 0.0);
  for (int64_t n = 0; n < field.grid.nnodes(); n++)
    for (int d = 0; d < dim; d++) nodes[with.nreal * n + d] = u[dim * n + d];
  field.nodes.complete(nodes.data(), with.nreal, 3);
  point_motion.assign(3 * (std::size_t) atom->nmax, 0.0);
  PointRows rows = field.rows();
  rows.P = P.data();
  rows.F = nullptr;
  const TransferStep step = field.step_data();
  double L[9 * BATCH];
  points_from(nodes, field, with, [&](const MPMPointMap::Run &run, const int *base) {
    for (int i = run.first; i < run.last; i += BATCH) {
      const int n = std::min(BATCH, run.last - i);
      PointRows b = rows_from(field, rows, i);
      b.P = P.data() + (bigint) nL * i;
      b.velocity = &point_motion[3 * (bigint) i];
      with.g2p_gradient(b, step, 0, n, base, field.map->tile_load, L);
    }
  });
  for (std::size_t i = 0; i < (std::size_t) atom->nmax && dim == 2; i++)
    point_motion[3 * i + 2] = 0.0;
}

/** In sum_forces: those of loads that follow, and the change since the start of the step of those between points. False, on this rank,
 *  where they are not finite. */
bool MPMTangent::add_between(const double *u, double &carried)
{
  bool good = true;
  sum_forces = loaded ? load_forces : no_force;
  move_points(u);
  point_forces.resize(3 * (std::size_t) atom->nmax);
  for (auto *forces : between) {
    if (!forces->forces_after(point_motion.data(), point_forces.data(), carried)) good = false;
    const double *const before = forces->forces();
    for (std::size_t k = 0; k < 3 * (std::size_t) atom->nlocal; k++)
      sum_forces[k] += point_forces[k] - before[k];
  }
  return good;
}

/* ----------------------------------------------------------------------
   deformation of the places of the lattice after H [n][nH] of n points from first on, as in MPMFrame
------------------------------------------------------------------------- */

void MPMTangent::lattice_F(int first, int n, const double *H, double *F) const
{
  const bool total = field.frame->is_total();
  if (!total)
    for (int p = 0; p < n; p++)
      for (int k = 0; k < 9; k++) F[9 * p + k] = k % 4 == 0;
  else if (!field.frame->refers())    // that of the points
    std::copy_n(field.points->F[first], 9 * n, F);
  else
    for (int p = 0; p < n; p++)
      field.frame->lattice_F(first + p, reinterpret_cast<double(*)[3]>(F + 9 * p));
  const auto add = [&](auto width) {
    constexpr int D = decltype(width)::value;
    for (int p = 0; p < n; p++, F += 9, H += nH)
      for (int r = 0; r < D; r++)
        for (int c = 0; c < D; c++) F[3 * r + c] += H[D * c + r];
  };
  if (dim == 2)
    add(std::integral_constant<int, 2>());
  else
    add(std::integral_constant<int, 3>());
}

/** Kinematics of n points from first on after H [n][nH], in the batch. */
void MPMTangent::deform(int first, int n, const double *H)
{
  const auto &batches = *field.batch_kernels;
  const auto &frame = *field.frame;
  const bigint row = first;
  if (nH == nL && !frame.refers()) {
    (frame.is_total() ? batches.load_total
                      : batches.load)(*batch, n, 1.0, H, field.points->F[0] + 9 * row,
                                      field.points->tau[0] + 6 * row, atom->vfrac + row, nullptr);
    return;
  }
  double L[9 * BATCH], hoop[BATCH];
  for (int p = 0; p < n; p++) {
    std::copy_n(H + nH * p, nL, L + nL * p);
    if (nH > nL) hoop[p] = H[nH * p + nL];
  }
  frame.refer_gradients(first, n, L);
  (frame.is_total() ? batches.load_total : batches.load)(
      *batch, n, 1.0, L, field.points->F[0] + 9 * row, field.points->tau[0] + 6 * row,
      atom->vfrac + row, nH > nL ? hoop : nullptr);
}

/** P [n][DIM*DIM] of the stress in a batch, whose F is that of the places of the lattice; or that is unity and H, where this is given. */
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

/** P [n][nH] of the Kirchhoff stress tau [n][6] after H. */
void MPMTangent::find_piola(int first, int n, const double *H, const double *tau,
                            double *stress) const
{
  // with entries of a step before that may not be finite, where this one has not set them
  double F[9 * BATCH + 8], plane[9 * BATCH + 8];
  lattice_F(first, n, H, F);
  field.batch_kernels->first_piola(n, F, tau, nH > nL ? plane : stress);
  if (nH > nL)
    for (int p = 0; p < n; p++) {
      std::copy_n(plane + nL * p, nL, stress + nH * p);
      stress[nH * p + nL] = tau[6 * p + 2] / (1.0 + H[nH * p + nL]);
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

void MPMTangent::forces_on_rest(double *force)
{
  std::vector<double> forces(no_force.size(), 0.0);
  const double *const f = field.rows().f;
  for (const auto &[i, share] : parts)
    for (int d = 0; d < 3; d++) forces[3 * i + d] = (1.0 - share) * f[3 * i + d];
  std::fill(P.begin(), P.end(), 0.0);
  std::fill(hoop_stress.begin(), hoop_stress.end(), 0.0);
  scatter(forces.data(), force);
}

void MPMTangent::take_parts()
{
  for (const auto &[i, share] : parts) {
    for (int k = 0; k < nL; k++) P[nL * i + k] *= share;
    if (nH > nL) hoop_stress[i] *= share;
    for (int d = 0; d < 3 && loaded; d++) load_forces[3 * i + d] *= share;
  }
}

bool MPMTangent::forces(const double *u, double dt, double *force, double &carried)
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
    if (nH == nL) std::copy_n(stresses, nL * n, &P[(bigint) nL * first]);
    for (int p = 0; p < n && nH > nL; p++) {
      std::copy_n(stresses + nH * p, nL, &P[(bigint) nL * (first + p)]);
      hoop_stress[first + p] = stresses[nH * p + nL];
    }
  });
  carried = sum * field.step_data().stress_scale / field.lattice.h;
  if (!between.empty()) {
    double sizes = 0.0;
    if (!add_between(u, sizes)) bad = 1;
    carried += sizes * field.step_data().force_scale;
  }
  MPI_Allreduce(&bad, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) return false;
  if (averages) add_averages(u);
  if (pressure) {
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) added[i] = -pressure[i];
    add_to_stress(u);
  }
  take_parts();
  scatter(!between.empty() ? sum_forces.data()
              : loaded     ? load_forces.data()
                           : no_force.data(),
          force);
  return true;
}

/* ----------------------------------------------------------------------
   locking pressure: averages S p of the mean stress p in place of that of the points, P <- P + c J G with c = S p - p and
   G = F^-T. Their derivative is that with c as it is, which is in the tangents, and J G (S dp - dp), which points around have a part in
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

/* ---------------------------------------------------------------------- */

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

/* ---------------------------------------------------------------------- */

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

/* ----------------------------------------------------------------------
   by the tangent of the material: with F that of the places, dP = (dtau - tau l^T) F^-T, and for a change of H_rc, of
   which l has the row r of dF F^-1, l_rs = (F^-1)_cs
------------------------------------------------------------------------- */

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
  for (const auto &[i, share] : parts) {
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

void MPMTangent::volume_changes(const double *u, double *dV)
{
  gather(u, [&](const MPMPointMap::Run &, int first, int n, const double *H) {
    for (int p = 0; p < n; p++)
      dV[first + p] = field.points->jacobian(first + p) * atom->vfrac[first + p] *
          field.frame->volume_change(first + p, H + nH * p, 1.0);
  });
}

/** The rotation in the deformation F, of dim times dim, in its place; in the plane, in that of its parts c and s. Unity where there is none. */
static void take_rotation(int dim, double *F)
{
  if (dim == 2) {
    const double c = F[0], s = F[1], size = std::hypot(c, s);
    const bool good = size > 0.0 && std::isfinite(size);
    F[0] = F[3] = good ? c / size : 1.0;
    F[2] = good ? s / size : 0.0;
    F[1] = -F[2];
    return;
  }
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Map<Matrix> of(F);
  const Eigen::JacobiSVD<Matrix> parts(of, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix R = parts.matrixU() * parts.matrixV().transpose();
  if (!(of.determinant() > 0.0) || !R.allFinite()) R.setIdentity();
  of = R;
}

/** As forces on points. In the plane, a rotation is the direction of F_xx + F_yy and F_yx - F_xy; in space there is one force for each row of F. */
void MPMTangent::keep_deformations(int first, int n, const double *H)
{
  double F[9 * BATCH];
  lattice_F(first, n, H, F);
  const std::size_t nlocal = atom->nlocal;
  for (int p = 0; p < n; p++) {
    const std::size_t i = first + p;
    const double V = atom->vfrac[i], *const f = F + 9 * p;
    if (dim == 2) {
      deformations[3 * i] = V * (f[0] + f[4]);
      deformations[3 * i + 1] = V * (f[3] - f[1]);
      continue;
    }
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) deformations[3 * (nlocal * r + i) + c] = V * f[3 * r + c];
  }
}

void MPMTangent::keep_deformations(bool keeps)
{
  keeps_deformations = keeps;
  if (keeps) deformations.assign(3 * (std::size_t) atom->nlocal * (dim == 2 ? 1 : 3), 0.0);
}

void MPMTangent::mean_rotations(const std::vector<int64_t> &of, std::vector<double> &rotations)
{
  std::fill(P.begin(), P.end(), 0.0);
  std::fill(hoop_stress.begin(), hoop_stress.end(), 0.0);
  rotations.resize(of.size() * nL);
  std::vector<double> row(field.grid.nnodes() * dim);
  for (int r = 0; r < (dim == 2 ? 1 : 3); r++) {
    scatter(deformations.data() + 3 * (std::size_t) atom->nlocal * r, row.data());
    for (std::size_t k = 0; k < of.size(); k++)
      std::copy_n(&row[of[k] * dim], dim, &rotations[k * nL + dim * r]);
  }
  for (std::size_t k = 0; k < of.size(); k++) take_rotation(dim, &rotations[k * nL]);
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

/* ---------------------------------------------------------------------- */

/** Gradients of moving least squares are weights times distances [node spacings] times minus this. */
double MPMTangent::mls_moment() const
{
  return mls ? shape_constants[field.options.shape].inv_moment / field.lattice.h : 0.0;
}

/** The nodes of point i, each of them once, by their numbers where corners of a domain see one of them together. */
static void collect(const MPMStencil &stencil, const MPMField &field, int slot, int i,
                    std::vector<MPMStencil::Node> &nodes)
{
  nodes.clear();
  stencil.visit(field.grid.blocks[slot], i, [&](const MPMStencil::Node &node) {
    nodes.push_back(node);
  });
  if (!field.domains) return;
  std::sort(nodes.begin(), nodes.end(), [](const auto &a, const auto &b) {
    return a.number < b.number;
  });
  std::size_t n = 0;
  for (const auto &node : nodes) {
    if (n == 0 || nodes[n - 1].number != node.number) {
      nodes[n++] = node;
      continue;
    }
    nodes[n - 1].weight += node.weight;
    for (int d = 0; d < 3; d++) nodes[n - 1].gradient[d] += node.gradient[d];
  }
  nodes.resize(n);
}

void MPMTangent::each_point(const UsePoint &use) const
{
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale, moment = mls_moment();
  const int ngrad = nH > nL ? dim + 1 : dim, size = dim * ngrad;
  std::vector<MPMStencil::Node> reached;
  std::vector<int64_t> nodes;
  std::vector<double> gradients, stiffness((std::size_t) size * size, 0.0);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &present()[i * nH * nH], V = scale * atom->vfrac[i];
      const double around =
          nH > nL ? 1.0 / field.frame->radius((int) i, field.frame->places()[i][0]) : 0.0;
      nodes.clear();
      gradients.clear();
      collect(stencil, field, run.slot, (int) i, reached);
      for (const auto &node : reached) {
        nodes.push_back(node.number);
        for (int d = 0; d < dim; d++)
          gradients.push_back(mls ? -moment * node.weight * node.r[d] : node.gradient[d]);
        if (ngrad > dim) gradients.push_back(around * node.weight);
      }
      for (int k = 0; k < nH; k++)
        for (int l = 0; l < nH; l++) stiffness[size * l + k] = V * K[nH * k + l];
      if (averages && run.material)    // its pressure is that of each_mean()
        for (int k = 0; k < nH; k++)
          for (int l = 0; l < nH; l++)
            stiffness[size * l + k] -= V * volume_gradients[nH * i + l] * mean_tangents[nH * i + k];
      use((int) nodes.size(), nodes.data(), ngrad, gradients.data(), stiffness.data());
    }
}

/** A mean pressure p_I = sum_p N_Ip v_p dp_p/v_I works with the change of volume sum_p N_Ip V_p J G_p . H_p around its node. */
void MPMTangent::each_mean(const UseMean &use) const
{
  struct Mean {
    double sums[3] = {0.0, 0.0, 0.0};    // N v M, N v, N V
    std::vector<int64_t> nodes;
    std::vector<double> changes;    // [nodes][dim] of the volume by their motion
  };
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale, moment = mls_moment();
  std::vector<MPMStencil::Node> reached;
  std::vector<double> change;
  for (std::size_t number = 0; averages && number < field.materials.size(); number++) {
    const auto *const material = field.materials[number];
    std::unordered_map<int64_t, Mean> at;
    std::vector<int64_t> order;
    for (const auto &run : field.map->runs) {
      if (run.material != material) continue;
      for (bigint i = run.first; i < run.last; i++) {
        const double *const g = &volume_gradients[nH * i], *const m = &mean_tangents[nH * i];
        const double V = scale * atom->vfrac[i],
                     around = nH > nL
            ? 1.0 / field.frame->radius((int) i, field.frame->places()[i][0])
            : 0.0;
        double gm = 0.0, gg = 0.0;
        for (int k = 0; k < nH; k++) {
          gm += g[k] * m[k];
          gg += g[k] * g[k];
        }
        collect(stencil, field, run.slot, (int) i, reached);
        change.assign(reached.size() * dim, 0.0);
        for (std::size_t j = 0; j < reached.size(); j++) {
          const auto &node = reached[j];
          for (int l = 0; l < dim; l++) {
            const double gradient = mls ? -moment * node.weight * node.r[l] : node.gradient[l];
            for (int a = 0; a < dim; a++) change[dim * j + a] += V * g[dim * l + a] * gradient;
          }
          if (nH > nL) change[dim * j] += V * g[nL] * around * node.weight;
        }
        for (const auto &node : reached) {
          if (!(node.weight > 0.0)) continue;
          if (!at.count(node.number)) order.push_back(node.number);
          auto &mean = at[node.number];
          mean.sums[0] += node.weight * volumes[i] * gm / gg;
          mean.sums[1] += node.weight * volumes[i];
          mean.sums[2] += node.weight * V;
          for (std::size_t j = 0; j < reached.size(); j++) {
            const auto found = std::find(mean.nodes.begin(), mean.nodes.end(), reached[j].number);
            const std::size_t k = found - mean.nodes.begin();
            if (found == mean.nodes.end()) {
              mean.nodes.push_back(reached[j].number);
              mean.changes.resize(mean.changes.size() + dim, 0.0);
            }
            for (int a = 0; a < dim; a++)
              mean.changes[dim * k + a] += node.weight * change[dim * j + a];
          }
        }
      }
    }
    for (const int64_t node : order) {
      const auto &mean = at[node];
      use(node, (int) number, mean.sums, (int) mean.nodes.size(), mean.nodes.data(),
          mean.changes.data());
    }
  }
}

/** Adds to the block [DIM][DIM] of a node minus its force by its own motion: g: gradient of its function at a point with the tangents K;
 *  turn: H_zz for a unit of u_r; V: volume. */
template <int DIM, int NH>
static void add_block(const double *K, const double *g, double turn, double V, double *block)
{
  constexpr int NL = DIM * DIM;
  for (int b = 0; b < DIM; b++) {
    double sum[NH] = {0.0};    // change of P for a unit of u_b
    for (int m = 0; m < DIM; m++)
      for (int l = 0; l < NH; l++) sum[l] += K[NH * (DIM * m + b) + l] * g[m];
    if (NH > NL && b == 0)
      for (int l = 0; l < NH; l++) sum[l] += K[NH * (NH - 1) + l] * turn;
    for (int a = 0; a < DIM; a++) {
      double force = 0.0;
      for (int j = 0; j < DIM; j++) force += sum[DIM * j + a] * g[j];
      if (NH > NL && a == 0) force += sum[NH - 1] * turn;
      block[DIM * a + b] += V * force;
    }
  }
}

void MPMTangent::diagonal(std::vector<double> &blocks)
{
  const Grid &grid = field.grid;
  const MPMStencil stencil(field);
  const double scale = field.step_data().stress_scale, moment = mls_moment();
  const double *const place = &field.frame->places()[0][0];
  blocks.assign(grid.nnodes() * nL, 0.0);
  std::vector<MPMStencil::Node> reached;
  const auto add = nH > nL ? add_block<2, 5> : dim == 2 ? add_block<2, 4> : add_block<3, 9>;
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const K = &present()[i * nH * nH], V = scale * atom->vfrac[i];
      const double around = nH > nL ? 1.0 / field.frame->radius((int) i, place[3 * i]) : 0.0;
      collect(stencil, field, run.slot, (int) i, reached);
      for (const auto &node : reached) {
        double g[3];
        for (int d = 0; d < dim; d++)
          g[d] = mls ? -moment * node.weight * node.r[d] : node.gradient[d];
        add(K, g, around * node.weight, V, &blocks[node.number * nL]);
      }
    }
  if (!between.empty()) {    // points that elements join have no other part in this
    std::vector<double> of_points((std::size_t) atom->nmax * nL, 0.0);
    for (auto *forces : between) forces->add_blocks(of_points.data());
    const double unit = field.step_data().force_scale;
    for (const auto &run : field.map->runs)
      for (bigint i = run.first; i < run.last; i++) {
        collect(stencil, field, run.slot, (int) i, reached);
        for (const auto &node : reached)
          for (int k = 0; k < nL; k++)
            blocks[node.number * nL + k] +=
                unit * node.weight * node.weight * of_points[nL * (std::size_t) i + k];
      }
  }
  field.nodes.sum(blocks.data(), nL, 0, nL);
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

double MPMTangent::memory_usage() const
{
  double bytes = sizeof(Batch) + means.memory_usage();
  for (const auto *list : {&nodes,
                           &motion_nodes,
                           &history,
                           &P,
                           &hoop_stress,
                           &tangents,
                           &no_force,
                           &forces_on_points,
                           &load_forces,
                           &load_tangents,
                           &stress_tangents,
                           &deformations,
                           &mean_stress,
                           &mean_tangents,
                           &added,
                           &volumes,
                           &volume_gradients,
                           &point_motion,
                           &point_forces,
                           &sum_forces})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

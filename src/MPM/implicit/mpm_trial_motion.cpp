/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_trial_motion.h"

#include "base/mpm_points.h"
#include "field/mpm_interfaces.h"
#include "math/matrix.h"
#include "solve/bytes_of.h"

#include "atom.h"
#include "force.h"

#include <Eigen/Dense>

#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMTrialMotion::MPMTrialMotion(LAMMPS *lmp, MPMField &field) :
    Pointers(lmp), field(field), dim(field.lattice.dim), nL(dim * dim),
    nH(nL + field.options.axisymmetric), batch(new Batch()), with()
{
}

MPMTrialMotion::~MPMTrialMotion() noexcept = default;

void MPMTrialMotion::init()
{
  const auto &options = field.options;
  // forces and gradients are those of these two, which are fast in the total frame, too
  mls = is_mls(options.shape, options.transfer) && !options.strains_by_gradient();
  mls_moment = shape_constants[options.shape].inv_moment / field.lattice.h;
  const Transfer transfer = mls ? APIC : (has_domain(options.shape) ? options.transfer : PIC);
  with = field.kernels->transfer_total(dim, options.shape, transfer, true);
  // there are no fast ones for what fix mpm has in the updated frame only
  if (!with.p2g_force)
    with = MPMKernels::select("reference")->transfer_total(dim, options.shape, transfer, true);
  *batch = {};
  batch->h = field.lattice.h;
}

void MPMTrialMotion::scatter(const double *forces_of_points, double *force)
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

void MPMTrialMotion::move_points(const double *u)
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

void MPMTrialMotion::clear_stress()
{
  std::fill(P.begin(), P.end(), 0.0);
  std::fill(hoop_stress.begin(), hoop_stress.end(), 0.0);
}

void MPMTrialMotion::lattice_F(int first, int n, const double *H, double *F) const
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

void MPMTrialMotion::deform(int first, int n, const double *H)
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

void MPMTrialMotion::find_piola(int first, int n, const double *H, const double *tau,
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

/* ---------------------------------------------------------------------- */

/** The rotation in the deformation F, of dim times dim, in its place; in the plane, in that of its
 *  parts c and s. Unity where there is none. */
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

/** Deformations are kept as forces on points. In the plane, a rotation is the direction of F_xx +
 *  F_yy and F_yx - F_xy; in space there is one force for each row of F. */
void MPMTrialMotion::keep_deformations(int first, int n, const double *H)
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

void MPMTrialMotion::keep_deformations(bool keeps)
{
  keeps_deformations = keeps;
  if (keeps) deformations.assign(3 * (std::size_t) atom->nlocal * (dim == 2 ? 1 : 3), 0.0);
}

void MPMTrialMotion::mean_rotations(const std::vector<int64_t> &of, std::vector<double> &rotations)
{
  clear_stress();
  rotations.resize(of.size() * nL);
  std::vector<double> row(field.grid.nnodes() * dim);
  for (int r = 0; r < (dim == 2 ? 1 : 3); r++) {
    scatter(deformations.data() + 3 * (std::size_t) atom->nlocal * r, row.data());
    for (std::size_t k = 0; k < of.size(); k++)
      std::copy_n(&row[of[k] * dim], dim, &rotations[k * nL + dim * r]);
  }
  for (std::size_t k = 0; k < of.size(); k++) take_rotation(dim, &rotations[k * nL]);
}

double MPMTrialMotion::memory_usage() const
{
  return sizeof(Batch) +
      bytes_of(P, hoop_stress, point_motion, nodes, motion_nodes, forces_on_points, deformations);
}

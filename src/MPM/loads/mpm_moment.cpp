/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/mpm_moment.h"

#include "atom.h"
#include "domain.h"
#include "error.h"

#include <Eigen/Dense>

#include <cmath>

using namespace LAMMPS_NS;

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

static constexpr double FLAT = 1.0e-10;    // of the largest part of T: there is no extent

MPMMoment::MPMMoment(LAMMPS *lmp, std::string name, std::function<double(int)> weight) :
    Pointers(lmp), name(std::move(name)), weight(std::move(weight))
{
}

MPMMoment::Place MPMMoment::place(int i, const double *u) const
{
  Place p;
  domain->unmap(atom->x[i], atom->image[i], p.x);
  for (int d = 0; d < 3 && u; d++) p.x[d] += u[3 * i + d];
  return p;
}

void MPMMoment::Spin::load(const double *x, double *force) const
{
  double r[3];
  for (int d = 0; d < 3; d++) r[d] = x[d] - center[d];
  for (int d = 0; d < 3; d++) {
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    force[d] = omega[a] * r[b] - omega[b] * r[a];
  }
}

/** After the displacements u (null: none); false where the points have no extent that bears the
 *  moment. Collective. */
bool MPMMoment::find(const double *u, Spin &spin) const
{
  double mine[6] = {0.0}, all[6];
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i);
    if (w == 0.0) continue;
    const Place p = place(i, u);
    mine[0] += w;
    for (int d = 0; d < 3; d++) mine[1 + d] += w * p.x[d];
  }
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  for (int d = 0; d < 3; d++) spin.center[d] = all[1 + d] / all[0];

  // in the plane only the entry zz, by x and y, counts

  const int dim = domain->dimension;
  Matrix sums = Matrix::Zero(), T;
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i);
    if (w == 0.0) continue;
    const Place p = place(i, u);
    Vector r;
    for (int d = 0; d < 3; d++) r[d] = d < dim ? p.x[d] - spin.center[d] : 0.0;
    sums += w * r * r.transpose();
  }
  MPI_Allreduce(sums.data(), T.data(), 9, MPI_DOUBLE, MPI_SUM, world);
  T = Matrix(T.trace() * Matrix::Identity() - T);
  Eigen::Map<Matrix> inverse(&spin.inverse[0][0]);
  inverse.setZero();
  Eigen::Map<Vector> omega(spin.omega);
  const Eigen::Map<const Vector> M(moment);
  if (dim == 2) {
    if (!(T(2, 2) > 0.0)) return false;
    inverse(2, 2) = 1.0 / T(2, 2);
  } else {
    // a thin surface has none about one axis, which is good as long as the moment has no part along
    // it
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(T);
    const double most = axes.eigenvalues()[2];
    if (!(most > 0.0)) return false;
    for (int k = 0; k < 3; k++)
      if (axes.eigenvalues()[k] > FLAT * most)
        inverse += axes.eigenvectors().col(k) * axes.eigenvectors().col(k).transpose() /
            axes.eigenvalues()[k];
  }
  omega = inverse * M;
  spin.size = omega.norm();
  return std::isfinite(spin.size) && (T * omega - M).norm() <= 1.0e-6 * M.norm();
}

void MPMMoment::set(const double *value)
{
  for (int d = 0; d < 3; d++) moment[d] = value[d];
  if (!find(nullptr, present))
    error->all(FLERR, Error::NOLASTLINE,
               "{} moment {:.6g} {:.6g} {:.6g}: its points have no extent across an axis of this "
               "moment: choose a larger group, or a smaller spacing of points",
               name, moment[0], moment[1], moment[2]);
}

bool MPMMoment::forces_after(const double *u, double *force, double &carried)
{
  const bool good = find(u, trial);
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i);
    double *const f = force + 3 * (std::size_t) i, load[3] = {0.0, 0.0, 0.0};
    if (w != 0.0) trial.load(place(i, u).data(), load);
    for (int d = 0; d < 3; d++) f[d] = w * load[d];
    carried += std::fabs(w) * std::sqrt(load[0] * load[0] + load[1] * load[1] + load[2] * load[2]);
  }
  return good;
}

const double *MPMMoment::forces() const
{
  at_start.assign(3 * (std::size_t) atom->nmax, 0.0);
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i);
    double *const f = &at_start[3 * (std::size_t) i];
    if (w == 0.0) continue;
    load(i, f);
    for (int d = 0; d < 3; d++) f[d] *= w;
  }
  return at_start.data();
}

double MPMMoment::differentiate(const double *u)
{
  find(u, trial);
  places.assign(3 * (std::size_t) atom->nmax, 0.0);
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i);
    if (w == 0.0) continue;
    const Place p = place(i, u);
    double square = 0.0;
    for (int d = 0; d < domain->dimension; d++) {
      const double r = places[3 * (std::size_t) i + d] = p.x[d] - trial.center[d];
      square += r * r;
    }
    sum += std::fabs(w) * trial.size * std::sqrt(square);
  }
  return sum;
}

/** d(omega) = -T^-1 dT omega, dT = sum w (2 r.dr 1 - dr r - r dr); a motion of the center changes
 *  nothing in T, as sum w r = 0. */
void MPMMoment::add_change(const double *du, double *dforce)
{
  double mine[13] = {0.0}, all[13];    // sum w, sum w du, sum w dr r
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i), *const r = &places[3 * (std::size_t) i],
                 *const dr = du + 3 * (std::size_t) i;
    if (w == 0.0) continue;
    mine[0] += w;
    for (int a = 0; a < domain->dimension; a++) {
      mine[1 + a] += w * dr[a];
      for (int b = 0; b < 3; b++) mine[4 + 3 * a + b] += w * dr[a] * r[b];
    }
  }
  MPI_Allreduce(mine, all, 13, MPI_DOUBLE, MPI_SUM, world);
  const Eigen::Map<const Matrix> sums(all + 4);
  const Matrix change = 2.0 * sums.trace() * Matrix::Identity() - sums - sums.transpose();
  const Vector omega = Eigen::Map<const Vector>(trial.omega),
               turn = -(Eigen::Map<const Matrix>(&trial.inverse[0][0]) * (change * omega));
  for (int i = 0; i < atom->nlocal; i++) {
    const double w = weight(i), *const x = &places[3 * (std::size_t) i];
    if (w == 0.0) continue;
    const Vector r(x[0], x[1], x[2]);
    Vector dr = Vector::Zero();
    for (int d = 0; d < domain->dimension; d++)
      dr[d] = du[3 * (std::size_t) i + d] - all[1 + d] / all[0];
    const Vector df = w * (turn.cross(r) + omega.cross(dr));
    for (int d = 0; d < 3; d++) dforce[3 * (std::size_t) i + d] += df[d];
  }
}

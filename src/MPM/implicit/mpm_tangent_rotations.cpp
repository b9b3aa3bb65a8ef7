/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_tangent.h"

#include "atom.h"
#include "field/mpm_field.h"
#include "material/batch_kernels.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

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

/** As forces on points. In the plane, a rotation is the direction of F_xx + F_yy and F_yx - F_xy;
 *  in space there is one force for each row of F. */
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

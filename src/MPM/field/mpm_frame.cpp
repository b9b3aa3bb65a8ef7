/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_frame.h"

#include "base/mpm_points.h"
#include "material/batch_kernels.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

TransferKernels MPMFrame::kernels(Transfer transfer, bool split) const
{
  const auto make = is_total() ? field.kernels->transfer_total : field.kernels->transfer;
  return make(field.lattice.dim, field.options.shape, transfer, split);
}

void MPMFrame::load(Batch &b, int first, int n, double dt, const double *L, const double *F,
                    const double *tau, const double *vol0) const
{
  const auto &batches = *field.batch_kernels;
  (is_total() ? batches.load_total : batches.load)(b, n, dt, L, F, tau, vol0, hoop_strain(first));
}

/** USF takes the gradient of the velocity that has brought the points to where they are, with
 *  respect to these positions: dx = (I - dt L)^-1 dx_old. Laws expect dx = (I + dt L') dx_old, so
 *  L' = L (I - dt L)^-1. For USAVG, which goes half of the way with each of two gradients, the
 *  Cayley transform has I + dt/2 L (I + dt/4 L)^-1 and I + dt/2 L (I - 3 dt/4 L)^-1. */
void MPMFrame::shift_gradients(int n, double dt, double *gradients) const
{
  if (field.lattice.dim == 2) {    // by Cayley-Hamilton
    for (double *L = gradients; n > 0; n--, L += 4) {
      const double shift = dt * (L[0] * L[3] - L[1] * L[2]);
      const double inv = 1.0 / (1.0 - dt * (L[0] + L[3]) + dt * shift);
      L[0] = inv * (L[0] - shift);
      L[1] = inv * L[1];
      L[2] = inv * L[2];
      L[3] = inv * (L[3] - shift);
    }
    return;
  }
  for (double *L = gradients; n > 0; n--, L += 9) {    // 3x3, order of storage does not matter
    double M[9], LM[9];
    for (int c = 0; c < 9; c++) M[c] = (c % 4 == 0 ? 1.0 : 0.0) - dt * L[c];
    const double cofactors[9] = MPM_COFACTORS(M);    // M^-1 transposed, times det M
    const double det = dot(M, cofactors);
    for (int c = 0; c < 9; c++) LM[c] = dot(L + 3 * (c / 3), cofactors + 3 * (c % 3)) / det;
    memcpy(L, LM, sizeof(LM));
  }
}

/** det(I + dt L) - 1 without the loss of digits of that difference. */
double MPMFrame::volume_change(int, const double *L, double dt) const
{
  return field.lattice.dim == 2 ? growth<2>(L, dt) : growth<3>(L, dt);
}

void MPMFrame::begin_strain()
{
  if (field.lattice.dim == 2 && field.options.changes_thickness()) across.resize(atom->nmax);
}

/** What is stretched is I + dt L or, in the total frame, F + dt L. */
void MPMFrame::stretch(int i, double more, double dt, double *L)
{
  static const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const int dim = field.lattice.dim;
  const double *const F = is_total() ? field.points->F[i] : unit;
  for (int c = 0; c < dim * dim; c++) L[c] = (1.0 + more) * L[c];
  for (int r = 0; r < dim; r++)
    for (int c = 0; c < dim; c++) L[dim * c + r] += more / dt * F[3 * r + c];
  if (!across.empty()) across[i] = more;
}

void MPMFrame::lattice_F(int i, double F[3][3]) const
{
  memcpy(F, field.points->F[i], 9 * sizeof(double));
}

double MPMFrame::speed(int i, double &c, double /*known*/) const
{
  return c + sqrt(dot(atom->v[i], atom->v[i]));
}

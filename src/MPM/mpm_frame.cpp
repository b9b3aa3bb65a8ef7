/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_frame.h"

#include "atom.h"
#include "material/batch.h"
#include "mpm_field.h"
#include "mpm_frame_axisymmetric.h"
#include "mpm_frame_total.h"
#include "mpm_points.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

std::unique_ptr<MPMFrame> MPMFrame::create(LAMMPS *lmp, MPMField &field, MPMPointState &state)
{
  const auto &options = field.options;
  if (options.axisymmetric && options.total)
    return std::make_unique<MPMFrameAxisymmetric<MPMFrameTotal>>(lmp, field, state);
  if (options.axisymmetric) return std::make_unique<MPMFrameAxisymmetric<MPMFrame>>(lmp, field);
  if (options.total) return std::make_unique<MPMFrameTotal>(lmp, field, state);
  return std::make_unique<MPMFrame>(lmp, field);
}

/* ---------------------------------------------------------------------- */

double **MPMFrame::places() const
{
  return atom->x;
}

TransferKernels MPMFrame::kernels(const MPMKernels &all, Transfer transfer, bool split) const
{
  return all.transfer(field.lattice.dim, field.options.shape, transfer, split);
}

void MPMFrame::load(Batch &b, int, int n, double dt, const double *L, const double *F,
                    const double *tau, const double *vol0) const
{
  field.batch_kernels->load(b, n, dt, L, F, tau, vol0, nullptr);
}

/* ----------------------------------------------------------------------
   USF takes the gradient of the velocity that has brought the points to where they are, with
   respect to these positions: dx = (I - dt L)^-1 dx_old. Laws expect dx = (I + dt L') dx_old, so
   L' = L (I - dt L)^-1. With L itself, a body that turns by an angle a in a step would seem to grow
   by 2 a^2 in area and shrink in answer to that, by 2.4 % per revolution of 3300 steps.

   USAVG goes half of the way with each of two gradients. Half of the motion I + dt L is, to third
   order and as an exact rotation for a spin, the Cayley transform of half of the mid-step gradient:
   I + dt/2 L (I + dt/4 L)^-1, and with the gradient at the end I + dt/2 L (I - 3 dt/4 L)^-1. So all
   of these are L (I - shift L)^-1, and the time steps of the law add up to dt.
------------------------------------------------------------------------- */

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
    double M[9], inv[9], LM[9];
    for (int c = 0; c < 9; c++) M[c] = (c % 4 == 0 ? 1.0 : 0.0) - dt * L[c];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        inv[3 * i + j] = M[3 * a + c] * M[3 * b + d] - M[3 * a + d] * M[3 * b + c];
      }
    const double det = M[0] * inv[0] + M[1] * inv[3] + M[2] * inv[6];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        LM[3 * i + j] =
            (L[3 * i] * inv[j] + L[3 * i + 1] * inv[3 + j] + L[3 * i + 2] * inv[6 + j]) / det;
    for (int c = 0; c < 9; c++) L[c] = LM[c];
  }
}

/* ----------------------------------------------------------------------
   det(I + A) - 1 without the loss of digits of that difference
------------------------------------------------------------------------- */

static double dilatation(int dim, const double *A)
{
  if (dim == 2) return A[0] + A[3] + (A[0] * A[3] - A[1] * A[2]);
  const double minors =
      A[0] * A[4] - A[1] * A[3] + A[0] * A[8] - A[2] * A[6] + A[4] * A[8] - A[5] * A[7];
  return A[0] + A[4] + A[8] + minors + MPMPoints::det(A);
}

double MPMFrame::volume_change(int, const double *L, double dt) const
{
  const int dim = field.lattice.dim;
  double A[9];
  for (int c = 0; c < dim * dim; c++) A[c] = dt * L[c];
  return dilatation(dim, A);
}

void MPMFrame::stretch(int, double more, double dt, double *L)
{
  const int dim = field.lattice.dim;
  for (int c = 0; c < dim * dim; c++) L[c] = (1.0 + more) * L[c];
  for (int r = 0; r < dim; r++)
    for (int c = 0; c < dim; c++) L[dim * c + r] += more / dt * (r == c);
}

bool MPMFrame::is_plane() const
{
  return field.lattice.dim == 2;
}

/* ---------------------------------------------------------------------- */

void MPMFrame::lattice_F(int i, double F[9]) const
{
  memcpy(F, field.points->F[i], 9 * sizeof(double));
}

double MPMFrame::lattice_jacobian(int i) const
{
  return field.points->jacobian(i);
}

double MPMFrame::speed(int i, double &c) const
{
  const double *v = atom->v[i];
  return c + sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double MPMFrame::section(int i) const
{
  return atom->vfrac[i];
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   The reference configuration of the total frame, and its updates.

   With reference update S, the present configuration becomes the reference one when the ratio of the
   principal stretches of some point since the last time is above S: X = x and R = F, the deformation
   gradient then. What happens on the lattice knows the deformation since then only, F_R = F R^-1,
   while laws see all of F. As V0 is that of the undeformed body,

     f_i = -sum V0 tau F_R^-T grad N,   F <- F + dt (grad v) R

   are the equations of a body with the initial volume V0 det R and the deformation gradient F_R. The
   affine matrix C, the gradient with respect to X, becomes C F_R^-1. Stress, velocities, and energies
   of points do not change.
------------------------------------------------------------------------- */

#include "fix_mpm.h"

#include "atom.h"
#include "error.h"
#include "math_extra.h"
#include "mpm_points.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int CHECK_EVERY = 10;    // steps between looks at the distortion

/* ----------------------------------------------------------------------
   the reference position of a point is where it is at the start of its first run, so that commands
   which place or displace points can be used before
------------------------------------------------------------------------- */

void FixMPM::set_reference()
{
  if (!X) return;
  tagint deformed = 0, deformed_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i) || !std::isnan(X[i][0])) continue;
    memcpy(X[i], atom->x[i], 3 * sizeof(double));
    if (R) memcpy(R[i], points->F[i], 9 * sizeof(double));
    for (int c = 0; c < 9 && !R; c++)
      if (fabs(points->F[i][c] - (c % 4 == 0)) > 1.0e-12)
        deformed = std::max(deformed, atom->tag[i]);
  }
  MPI_Allreduce(&deformed, &deformed_all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (deformed_all)
    error->all(
        FLERR,
        "Fix mpm {} frame total: points have no reference position but are deformed already, "
        "for instance point {}: use frame total from the first run on, and the same fix ID "
        "after read_restart, or reference update",
        id, deformed_all);
}

/* ----------------------------------------------------------------------
   deformation gradient with respect to the reference configuration, row-major
------------------------------------------------------------------------- */

void FixMPM::lattice_F(int i, double *F) const
{
  if (!R) {
    memcpy(F, points->F[i], 9 * sizeof(double));
    return;
  }
  double f[3][3], r[3][3], inverse[3][3], product[3][3];
  memcpy(f, points->F[i], sizeof(f));
  memcpy(r, R[i], sizeof(r));
  MathExtra::invert3(r, inverse);
  MathExtra::times3(f, inverse, product);
  memcpy(F, product, sizeof(product));
}

/* ----------------------------------------------------------------------
   gradients with respect to X, column-major, of the points first ... become those with respect to
   the undeformed body: L <- L R
------------------------------------------------------------------------- */

void FixMPM::refer_gradients(int first, int n, double *L) const
{
  const int dim = lattice.dim;
  for (int i = first; i < first + n; i++, L += dim * dim) {
    double product[9];
    for (int c = 0; c < dim; c++)
      for (int r = 0; r < dim; r++) {
        product[dim * c + r] = 0.0;
        for (int k = 0; k < dim; k++) product[dim * c + r] += L[dim * k + r] * R[i][3 * k + c];
      }
    memcpy(L, product, dim * dim * sizeof(double));
  }
}

/* ----------------------------------------------------------------------
   largest eigenvalue of a symmetric matrix, by the trigonometric form of the cubic equation
------------------------------------------------------------------------- */

static double largest_eigenvalue(double B[3][3])
{
  const double mean = (B[0][0] + B[1][1] + B[2][2]) / 3.0;
  double p = 0.0;
  for (int i = 0; i < 3; i++) {
    B[i][i] -= mean;
    for (int j = 0; j < 3; j++) p += B[i][j] * B[i][j];
  }
  p = sqrt(p / 6.0);
  const double r = p > 0.0 ? 0.5 * MathExtra::det3(B) / (p * p * p) : 1.0;
  return mean + 2.0 * p * cos(acos(std::max(-1.0, std::min(1.0, r))) / 3.0);
}

/* ----------------------------------------------------------------------
   smallest and largest principal stretch of a point since its reference configuration: singular
   values of F, in 2d of its part in the plane; not eigenvalues, which tell nothing when the body
   has turned. 3d: the roots of the largest eigenvalues of (F F^T)^-1 and F F^T
------------------------------------------------------------------------- */

void FixMPM::stretches(int i, double &smallest, double &largest) const
{
  double F[9];
  lattice_F(i, F);
  if (lattice.dim == 2) {
    largest = 0.5 * (hypot(F[0] + F[4], F[3] - F[1]) + hypot(F[0] - F[4], F[3] + F[1]));
    smallest = fabs(F[0] * F[4] - F[1] * F[3]) / largest;
    return;
  }
  double f[3][3], g[3][3], B[3][3], inverse[3][3];
  memcpy(f, F, sizeof(f));
  MathExtra::invert3(f, g);
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) {
      B[j][k] = f[j][0] * f[k][0] + f[j][1] * f[k][1] + f[j][2] * f[k][2];
      inverse[j][k] = g[0][j] * g[0][k] + g[1][j] * g[1][k] + g[2][j] * g[2][k];
    }
  largest = sqrt(largest_eigenvalue(B));
  smallest = 1.0 / sqrt(largest_eigenvalue(inverse));
}

/* ----------------------------------------------------------------------
   is it time for a new reference configuration? It is taken where points have just been sorted to
   ranks, in this step. The steps of this look do not depend on when the run has started.
------------------------------------------------------------------------- */

void FixMPM::check_distortion()
{
  if (update->ntimestep % CHECK_EVERY >= every) return;
  double worst = 0.0, worst_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    double smallest, largest;
    stretches(i, smallest, largest);
    worst = std::max(worst, largest / smallest);
  }
  MPI_Allreduce(&worst, &worst_all, 1, MPI_DOUBLE, MPI_MAX, world);
  refer_anew = worst_all > most_distorted;
  if (refer_anew) next_reneighbor = update->ntimestep;
}

/* ---------------------------------------------------------------------- */

void FixMPM::update_reference()
{
  const int dim = lattice.dim;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    if (C) {
      double F[9], f[3][3], g[3][3], product[9];
      lattice_F(i, F);
      memcpy(f, F, sizeof(f));
      MathExtra::invert3(f, g);
      for (int c = 0; c < dim; c++)
        for (int r = 0; r < dim; r++) {
          product[dim * c + r] = 0.0;
          for (int k = 0; k < dim; k++) product[dim * c + r] += C[i][dim * k + r] * g[k][c];
        }
      memcpy(C[i], product, dim * dim * sizeof(double));
    }
    memcpy(X[i], atom->x[i], 3 * sizeof(double));
    memcpy(R[i], points->F[i], 9 * sizeof(double));
  }
  refer_anew = false;
  report.references++;
}

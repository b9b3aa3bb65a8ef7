/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* With reference update S, the present configuration becomes the reference one when the ratio of
 *  the principal stretches of some point since the last time is above S: X = x, R = F. Nodes know
 *  the deformation F_R = F R^-1 since then, while laws see all of F:
 *
 *    f_i = -sum V0 tau F_R^-T grad N,   F <- F + dt (grad v) R
 *
 *  The affine matrix C, a gradient with respect to X, becomes C F_R^-1. */

#include "field/mpm_frame.h"

#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "error.h"
#include "field/mpm_affine.h"
#include "fix.h"
#include "material/batch_kernels.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int CHECK_EVERY = 10;    // steps between looks at the distortion

MPMFrameTotal::MPMFrameTotal(LAMMPS *lmp, MPMField &field, MPMPointState &state) :
    MPMFrame(lmp, field)
{
  state.declare(X, "mpm:X", 3, [this](int i, double *row) {
    memcpy(row, atom->x[i], 3 * sizeof(double));
    if (!this->field.is_running()) row[0] = NAN;    // not known, for setup()
  });
  if (field.options.most_distorted > 0.0)
    state.declare(R, "mpm:R", 9, [](int, double *row) {
      row[0] = row[4] = row[8] = 1.0;
    });
}

/** The reference position of a point is where it is at the start of its first run, so that commands
 *  which place or displace points can be used before. */
void MPMFrameTotal::setup()
{
  tagint deformed = 0, deformed_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i) || !std::isnan(X[i][0])) continue;
    const double *const F = field.points->F[i];
    memcpy(X[i], atom->x[i], 3 * sizeof(double));
    if (R) memcpy(R[i], F, 9 * sizeof(double));
    for (int c = 0; c < 9 && !R; c++)
      if (fabs(F[c] - (c % 4 == 0)) > 1.0e-12) deformed = std::max(deformed, atom->tag[i]);
  }
  MPI_Allreduce(&deformed, &deformed_all, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  if (deformed_all)
    error->all(FLERR,
               "Fix mpm {} frame total: points have no reference position but are deformed "
               "already, for instance point {}: use frame total from the first run on, and the "
               "same fix ID after read_restart, or reference update",
               field.id(), deformed_all);
}

/** The first Piola-Kirchhoff stress is made here, a batch at a time: to read F and tau costs less
 *  than to write and read another matrix. */
void MPMFrameTotal::forces(PointRows &rows, int first, int n, ForceRows &room) const
{
  double F[BATCH][3][3];
  for (int p = 0; p < n && R; p++) lattice_F(first + p, F[p]);
  field.batch_kernels->first_piola(n, R ? &F[0][0][0] : rows.F, rows.tau, room.P);
  rows.P = room.P;
}

void MPMFrameTotal::lattice_F(int i, double F[3][3]) const
{
  if (!R) return MPMFrame::lattice_F(i, F);
  using Rows = const double(*)[3];
  double inverse[3][3];
  MathExtra::invert3((Rows) R[i], inverse);
  MathExtra::times3((Rows) field.points->F[i], inverse, F);
}

/** As the deformation gradient has it. */
double MPMFrameTotal::radius(int i, double) const
{
  return X[i][0] * field.points->F[i][8] / (R ? R[i][8] : 1.0);
}

/** A <- A M, for A column-major with dim*dim and M row-major with 3*3 reals. */
static void multiply(int dim, double *A, const double *M)
{
  double product[9];
  for (int c = 0; c < dim; c++)
    for (int r = 0; r < dim; r++) {
      product[dim * c + r] = 0.0;
      for (int k = 0; k < dim; k++) product[dim * c + r] += A[dim * k + r] * M[3 * k + c];
    }
  memcpy(A, product, dim * dim * sizeof(double));
}

/** Gradients with respect to X, column-major, of the points first ... become those with respect to
 *  the undeformed body: L <- L R, with the mean motion that nodes do not have. */
void MPMFrameTotal::refer_gradients(int first, int n, double *L) const
{
  const int dim = field.lattice.dim;
  for (int p = 0; p < n && R; p++) multiply(dim, L + dim * dim * p, R[first + p]);
  for (int p = 0; p < n && mean_rate; p++, L += dim * dim)
    for (int c = 0; c < dim; c++)
      for (int r = 0; r < dim; r++) L[dim * c + r] += mean_rate[3 * r + c];
}

/** The change of volume of I + A = (F + dt L) F^-1. */
double MPMFrameTotal::volume_change(int i, const double *L, double dt) const
{
  const double *F = field.points->F[i];
  double A[9];
  if (field.lattice.dim == 2) {
    const double scale = dt / (F[0] * F[4] - F[1] * F[3]);
    for (int r = 0; r < 2; r++) {
      A[r] = scale * (L[r] * F[4] - L[2 + r] * F[3]);
      A[2 + r] = scale * (L[2 + r] * F[0] - L[r] * F[1]);
    }
    return MPMFrame::volume_change(i, A, 1.0);
  }
  const double scale = dt / field.points->jacobian(i);
  const double cofactors[9] = MPM_COFACTORS(F);    // F^-1 transposed, times det F
  for (int c = 0; c < 9; c++) A[c] = scale * product(cofactors, L, c / 3, c % 3);
  return MPMFrame::volume_change(i, A, 1.0);
}

/** Takes the mean of its eigenvalues from a symmetric matrix. Returns p; the largest one is at most
 *  mean + 2 p. */
static double to_deviator(double B[3][3], double &mean)
{
  mean = (B[0][0] + B[1][1] + B[2][2]) / 3.0;
  double p = 0.0;
  for (int i = 0; i < 3; i++) {
    B[i][i] -= mean;
    for (int j = 0; j < 3; j++) p += B[i][j] * B[i][j];
  }
  return sqrt(p / 6.0);
}

/** Largest eigenvalue of a symmetric matrix, by the trigonometric form of the cubic equation. */
static double largest_eigenvalue(double B[3][3])
{
  double mean;
  const double p = to_deviator(B, mean);
  const double r = p > 0.0 ? 0.5 * MathExtra::det3(B) / (p * p * p) : 1.0;
  return mean + 2.0 * p * cos(acos(std::max(-1.0, std::min(1.0, r))) / 3.0);
}

/** Smallest and largest principal stretch of a point since its reference configuration: singular
 *  values of F, in 2d of its part in the plane; not eigenvalues, which tell nothing when the body
 *  has turned. 3d: the roots of the largest eigenvalues of (F F^T)^-1 and F F^T. */
void MPMFrameTotal::stretches(int i, double &smallest, double &largest) const
{
  double f[3][3], g[3][3], B[3][3], inverse[3][3];
  lattice_F(i, f);
  if (field.lattice.dim == 2) {
    largest = 0.5 *
        (hypot(f[0][0] + f[1][1], f[1][0] - f[0][1]) + hypot(f[0][0] - f[1][1], f[1][0] + f[0][1]));
    smallest = fabs(f[0][0] * f[1][1] - f[0][1] * f[1][0]) / largest;
    return;
  }
  MathExtra::invert3(f, g);
  MathExtra::times3_transpose(f, f, B);
  MathExtra::transpose_times3(g, g, inverse);
  largest = sqrt(largest_eigenvalue(B));
  smallest = 1.0 / sqrt(largest_eigenvalue(inverse));
}

/** Points stay where they are on the lattice, but waves cross it faster where it is compressed: a
 *  plane wave with wave vector K there has k = F^-T K in space, |k| <= |K|/s with the smallest
 *  singular value s of F. */
double MPMFrameTotal::speed(int i, double &c, double known) const
{
  double least, most;
  if (field.lattice.dim ==
      3) {    // most points do not limit the time step, as a bound tells at less cost
    double f[3][3], g[3][3], inverse[3][3], mean;
    lattice_F(i, f);
    MathExtra::invert3(f, g);
    MathExtra::transpose_times3(g, g, inverse);
    const double p = to_deviator(inverse, mean), bound = c * sqrt(mean + 2.0 * p);
    if (bound <= known) return bound;
  }
  stretches(i, least, most);
  return c / least;
}

/** Is it time for a new reference configuration? It is taken where points have just been sorted to
 *  ranks, in this step. The steps of this look do not depend on when the run has started. */
void MPMFrameTotal::end_of_step()
{
  if (!R || update->ntimestep % CHECK_EVERY >= field.options.every) return;
  double worst = 0.0, worst_all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double smallest, largest;
    stretches(i, smallest, largest);
    worst = std::max(worst, largest / smallest);
  }
  MPI_Allreduce(&worst, &worst_all, 1, MPI_DOUBLE, MPI_MAX, world);
  refer_anew = worst_all > field.options.most_distorted;
  if (refer_anew) field.fix.next_reneighbor = update->ntimestep;
}

bool MPMFrameTotal::renew_places()
{
  if (!refer_anew) return false;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    if (field.affine || !field.slopes.empty()) {
      const int dim = field.lattice.dim;
      double F[3][3], inverse[3][3];
      lattice_F(i, F);
      MathExtra::invert3(F, inverse);
      if (field.affine) multiply(dim, field.affine->C[i], inverse[0]);
      for (const auto *rows : field.slopes) {
        double *const g = (*rows)[i], old[3] = {g[0], g[1], dim == 3 ? g[2] : 0.0};
        for (int d = 0; d < dim; d++)
          g[d] = old[0] * inverse[0][d] + old[1] * inverse[1][d] + old[2] * inverse[2][d];
      }
    }
    memcpy(X[i], atom->x[i], 3 * sizeof(double));
    memcpy(R[i], field.points->F[i], 9 * sizeof(double));
  }
  refer_anew = false;
  nupdate++;
  return true;
}

std::string MPMFrameTotal::report() const
{
  return nupdate ? fmt::format("  {} updates of the reference configuration\n", nupdate) : "";
}

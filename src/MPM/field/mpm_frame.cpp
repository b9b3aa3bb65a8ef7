/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_frame.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_affine.h"
#include "field/mpm_node_action.h"
#include "field/mpm_point_map.h"
#include "fix.h"
#include "force.h"
#include "material/batch_kernels.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "update.h"

#include <algorithm>
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

/* With reference update S, the present configuration becomes the reference one when the ratio of
 *  the principal stretches of some point since the last time is above S: X = x, R = F. Nodes know
 *  the deformation F_R = F R^-1 since then, while laws see all of F:
 *
 *    f_i = -sum V0 tau F_R^-T grad N,   F <- F + dt (grad v) R
 *
 *  The affine matrix C, a gradient with respect to X, becomes C F_R^-1. */

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

/* Bodies of revolution in 2d: x is the distance r from the axis, points are rings, and zz is the
 *  direction around it (D. Sulsky, H.L. Schreyer, Comput. Methods Appl. Mech. Eng. 139 (1996) 409;
 *  points of finite size: J.A. Nairn, J.E. Guilkey, Int. J. Numer. Methods Eng. 101 (2015) 127).
 *  Beyond plane strain there are a strain rate and a force, conjugate to each other,
 *
 *    L_zz = sum_i N_ip v_ir / r_p,   f_ir = ... - sum_p V_p sigma_zz N_ip / r_p */

// a box that begins nearer than this to the axis, in node spacings, has the axis for a face
static constexpr double AT_AXIS = 1.0e-6;

namespace {

/** An axis of symmetry in a frame of plane strain. */
template <class Plane> class MPMFrameAxisymmetric : public Plane {
 public:
  using Plane::Plane;

  /** Nodes beyond the axis mirror those inside. */
  void check() const override
  {
    Plane::check();
    if (domain->boxlo[0] > AT_AXIS * field.lattice.h) return;
    for (const auto *action : find_fixes<MPMNodeAction>(this->lmp))
      if (action->holds_axis(field)) return;
    this->error->all(FLERR,
                     "Fix mpm {} axisymmetric: the face of the box at x = 0 is the axis of "
                     "symmetry, where nothing moves along x: use fix mpm/boundary xlo slip",
                     field.id());
  }

  /** External forces of the points, and what hoop stress adds, in units of force. */
  bool changes_forces() const override { return true; }
  void forces(PointRows &rows, int first, int n, MPMFrame::ForceRows &room) const override
  {
    Plane::forces(rows, first, n, room);
    const double unit = 1.0 / this->force->nktv2p;
    std::copy_n(rows.f, 3 * n, room.f);
    for (int p = 0; p < n; p++) {
      const double radius = this->radius(first + p, rows.x[3 * p]);
      room.f[3 * p] -= unit * rows.vol0[p] * rows.tau[6 * p + 2] / radius;
    }
    rows.f = room.f;
  }

  // strain around the axis in this step from the motion, exactly that of the radius. Total frame:
  // dv of F_zz = r/R is relative to R
  void begin_strain() override { hoop.resize(atom->nmax); }
  void before_motion(int first, int last) override
  {
    for (int i = first; i < last; i++) hoop[i] = atom->x[i][0];
  }
  void after_motion(const PointRows &rows, int first, int last) override
  {
    for (bigint i = first; i < last; i++)
      hoop[i] = (rows.xnew[3 * i] - hoop[i]) / this->radius((int) i, hoop[i]);
  }

  /** The same from the velocities of the nodes, for the schemes that update stress apart from the
   *  motion; shift: see MPMFrame::shift_gradients(). */
  void strain_of_nodes(const PointRows &r, int first, int last, const int *base, double dt,
                       double shift) override
  {
    field.work.vectors.resize(3 * (std::size_t) atom->nmax);
    const PointRows rows = field.rows_at_rest(field.work.vectors.data(), r.mass);
    field.pic.g2p(rows, field.step_data(0.0), first, last, base, field.map->tile_load, nullptr);
    if (this->is_total()) shift = 0.0;
    for (bigint i = first; i < last; i++) {
      const double rate = field.work.vectors[3 * i] / this->radius((int) i, atom->x[i][0]);
      hoop[i] = dt * rate / (1.0 - shift * rate);
    }
  }

  double volume_change(int i, const double *L, double dt) const override
  {
    const double plane = Plane::volume_change(i, L, dt);
    return plane + hoop[i] + plane * hoop[i];
  }
  void stretch(int i, double more, double dt, double *L) override
  {
    Plane::stretch(i, more, dt, L);
    hoop[i] += more * (1.0 + hoop[i]);
  }

  /** Hoop stress can raise the greatest frequency where no wall makes v_r odd: that of a ring alone
   *  is c/r, that of the lattice in the plane 2c/h, and squares add up. */
  double speed(int i, double &c, double known) const override
  {
    const double h = field.lattice.h;
    if (domain->boxlo[0] > AT_AXIS * h) {
      const double ratio = 0.5 * h / field.frame->places()[i][0];
      c *= sqrt(1.0 + ratio * ratio);
    }
    return Plane::speed(i, c, known);
  }

  double circle(double r) const override { return 6.28318530717958647693 * r; }
  double node_circle(int slot, int node) const override
  {
    const auto &grid = field.grid;
    const int index = grid.side * grid.blocks[slot].b[0] + node / grid.side;
    return circle(std::max(0.25 * grid.lattice.h, grid.lattice.origin[0] + index * grid.lattice.h));
  }
  /** The distance from the axis before deformation is x/F_zz. */
  double section(int i) const override
  {
    return atom->vfrac[i] / circle(atom->x[i][0] / field.points->F[i][8]);
  }

  double memory_usage() const override { return hoop.capacity() * sizeof(double); }
  double bytes_per_point() const override { return sizeof(double); }

 protected:
  const double *hoop_strain(int first) const override { return &hoop[first]; }

 private:
  using Plane::atom, Plane::domain, Plane::field;
  std::vector<double> hoop;    // [n] strain around the axis in this step
};

}    // namespace

std::unique_ptr<MPMFrame> MPMFrame::create(LAMMPS *lmp, MPMField &field, MPMPointState &state)
{
  const auto &options = field.options;
  if (options.axisymmetric && options.total)
    return std::make_unique<MPMFrameAxisymmetric<MPMFrameTotal>>(lmp, field, state);
  if (options.axisymmetric) return std::make_unique<MPMFrameAxisymmetric<MPMFrame>>(lmp, field);
  if (options.total) return std::make_unique<MPMFrameTotal>(lmp, field, state);
  return std::make_unique<MPMFrame>(lmp, field);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "material/material_point.h"

#include "math/matrix.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

using namespace MPM_NS;

MaterialPoint::MaterialPoint(const Material &material, int n, double h) :
    material(material), storage(material.history().size() * BATCH)
{
  batch.n = n;
  batch.h = h;
  batch.history = reinterpret_cast<double(*)[BATCH]>(storage.data());
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 9; k++) batch.F[k][i] = k % 4 == 0 ? 1.0 : 0.0;
    batch.J[i] = batch.Jold[i] = batch.vol0[i] = 1.0;
  }
  const double x[3] = {0.0, 0.0, 0.0};
  std::vector<double> initial(material.history().size());
  material.initialize(x, initial.data());
  for (std::size_t k = 0; k < initial.size(); k++)
    for (int i = 0; i < n; i++) batch.history[k][i] = initial[k];
  material.initial_stress(batch);
}

MaterialPoint::MaterialPoint(const MaterialPoint &other) :
    material(other.material), batch(other.batch), storage(other.storage), time(other.time),
    power(other.power)
{
  memcpy(work, other.work, sizeof(work));
  memcpy(rotation, other.rotation, sizeof(rotation));
  memcpy(guess, other.guess, sizeof(guess));
  batch.history = reinterpret_cast<double(*)[BATCH]>(storage.data());
}

/** First Piola-Kirchhoff stress of the first point, sigma cof F. */
static void first_piola(const Batch &b, double *P)
{
  double F[9], s[9];
  for (int k = 0; k < 9; k++) F[k] = b.F[k][0];
  static constexpr int voigt[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
  for (int k = 0; k < 9; k++) s[k] = b.stress[voigt[k]][0];
  const double cof[9] = MPM_COFACTORS(F);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) P[3 * i + j] = product(s, cof, i, j);
}

/** With G = dt L, the motion is F_new = (I + A) F, A = (I - G/2)^-1 G. */
void MaterialPoint::step(const double *L, double dt)
{
  double M[9], A[9];    // I - G/2 and A
  for (int k = 0; k < 9; k++) M[k] = (k % 4 == 0 ? 1.0 : 0.0) - 0.5 * dt * L[k];
  const double det = determinant(M);
  const double cof[9] = MPM_COFACTORS(M);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      A[3 * i + j] = dt / det * (cof[i] * L[j] + cof[3 + i] * L[3 + j] + cof[6 + i] * L[6 + j]);
  move(A, dt);
}

double MaterialPoint::internal_energy() const
{
  return stored_energy() + work[PLASTIC] + work[VISCOUS] + work[FRACTURE];
}

void MaterialPoint::move(const double *A, double dt, double heat)
{
  double before[9], after[9], dF[9];
  first_piola(batch, before);

  batch.dt = dt;
  batch.time = time + dt;
  for (int p = 0; p < batch.n; p++) {
    double F[9];
    for (int k = 0; k < 9; k++) F[k] = batch.F[k][p];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) dF[3 * i + j] = product(A, F, i, j);
    for (int k = 0; k < 9; k++) {
      batch.A[k][p] = A[k];
      batch.F[k][p] = F[k] += dF[k];
    }
    batch.Jold[p] = batch.J[p];
    batch.J[p] = determinant(F);
  }
  std::fill_n(batch.heat, batch.n, heat);
  material.update(batch);

  first_piola(batch, after);
  for (int k = 0; k < 9; k++) power += 0.5 * (before[k] + after[k]) * dF[k];
  for (int k = 0; k < NWORK; k++) work[k] += batch.work[k] / batch.n;
  time += dt;
}

// mixed control

namespace {

constexpr int VOIGT[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/** exp(X) - I with full relative precision for small X: Taylor series, then doubling of X by
 *  exp(2 X) - I = E (E + 2 I). Where it is too large to be a number, it is none. */
Matrix3 exp_minus_identity(Matrix3 X)
{
  int doublings = 0;
  double size = X.norm();
  if (!std::isfinite(size)) return Matrix3::Constant(NAN);
  for (; size > 0.1; size *= 0.5) doublings++;
  X *= std::ldexp(1.0, -doublings);
  Matrix3 term = X, E = X;
  for (int k = 2; k < 14; k++) {
    term = term * X / k;
    E += term;
  }
  for (int k = 0; k < doublings; k++) E = E * E + 2.0 * E;
  return E;
}

Matrix3 stress_matrix(const Batch &b, int i)
{
  Matrix3 s;
  for (int k = 0; k < 6; k++)
    s(VOIGT[k][0], VOIGT[k][1]) = s(VOIGT[k][1], VOIGT[k][0]) = b.stress[k][i];
  return s;
}

/** One step tried with several motions at once: each point of a batch makes another one. */
class Trial {
 public:
  Trial(const MaterialPoint &p, const MixedControl &control, double dt, const double *rotation) :
      p(p), control(control), dt(dt), R0(p.rotation), R1(rotation)
  {
    for (int k = 0; k < 6; k++)
      if (control.stress_given[k]) free[n++] = k;
    history.resize(p.storage.size());
    b.history = reinterpret_cast<double(*)[BATCH]>(history.data());
  }

  int n = 0;      ///< number of unknowns
  int free[6];    ///< their components

  /** A of the step, F_new = (I + A) F, for these strain increments. */
  Matrix3 motion(const double *x) const
  {
    Matrix3 X = Eigen::Map<const Matrix3>(control.L) * dt;
    for (int j = 0; j < n; j++) {
      const int a = VOIGT[free[j]][0], c = VOIGT[free[j]][1];
      X(a, c) += x[j];
      if (a != c) X(c, a) += x[j];
    }
    const Matrix3 E = exp_minus_identity(X);
    // R1 (I + E) R0^T - I, without loss of digits where the frame does not rotate
    return R1 * E * R0.transpose() + (R1 - R0) * R0.transpose();
  }

  /** r[m][j]: excess of the stress of unknown j when motion m, of count, has increments x[m]. */
  void evaluate(int count, const double (*x)[6], double (*r)[6])
  {
    const Batch &start = p.batch;
    b.n = count;
    b.dt = dt;
    b.h = start.h;
    b.time = p.time + dt;
    for (int m = 0; m < count; m++) {
      const Matrix3 A = motion(x[m]);
      Matrix3 F;
      for (int k = 0; k < 9; k++) F(k / 3, k % 3) = start.F[k][0];
      F += (A * F).eval();
      for (int k = 0; k < 9; k++) {
        b.A[k][m] = A(k / 3, k % 3);
        b.F[k][m] = F(k / 3, k % 3);
      }
      b.J[m] = F.determinant();
      b.Jold[m] = start.J[0];
      b.vol0[m] = 1.0;
      for (int k = 0; k < 6; k++) b.stress[k][m] = start.stress[k][0];
      for (std::size_t k = 0; k < history.size() / BATCH; k++)
        b.history[k][m] = start.history[k][0];
    }
    std::fill_n(b.heat, b.n, 0.0);
    p.material.update(b);
    scale = 0.0;
    for (int m = 0; m < count; m++) {
      const Matrix3 s = R1.transpose() * stress_matrix(b, m) * R1;
      if (m == 0) scale = s.cwiseAbs().maxCoeff();
      for (int j = 0; j < n; j++)
        r[m][j] = s(VOIGT[free[j]][0], VOIGT[free[j]][1]) - control.stress[free[j]];
    }
  }

  double scale;    ///< largest component of the stress of the first motion

 private:
  const MaterialPoint &p;
  const MixedControl &control;
  double dt;
  Eigen::Map<const Matrix3> R0, R1;
  std::vector<double> history;
  Batch b = {};
};

double norm(int n, const double *r)
{
  double sum = 0.0;
  for (int j = 0; j < n; j++) sum += r[j] * r[j];
  return std::isfinite(sum) ? std::sqrt(sum) : INFINITY;
}

}    // namespace

/** Newton iteration for the unknown strain increments with a numerical tangent; steps that do
 *  not help are shortened, all lengths tried at once. */
int MaterialPoint::step(const MixedControl &control, double dt, const double *new_rotation)
{
  static constexpr int MAX_ITERATIONS = 60, LENGTHS = 12;
  // points of a batch with the same motion may differ by that, as do tries of it among others
  static constexpr double ROUNDING = 1e-14;
  double R1[9];
  memcpy(R1, new_rotation ? new_rotation : rotation, sizeof(R1));
  Trial trial(*this, control, dt, R1);
  const int n = trial.n;

  double x[6] = {}, known = 0.0;
  for (int j = 0; j < n; j++) x[j] = dt * guess[trial.free[j]];
  // laws need not cope with what is no number
  if (!trial.motion(x).allFinite()) throw std::runtime_error("the motion is not finite");
  for (double l : control.L) known = std::max(known, dt * std::fabs(l));

  int iterations = 0;
  for (bool done = n == 0; !done; iterations++) {
    // residual, and its derivatives by differences
    double xs[LENGTHS][6], rs[LENGTHS][6], largest = known;
    for (int j = 0; j < n; j++) largest = std::max(largest, std::fabs(x[j]));
    const double delta = std::max(1e-6 * largest, 1e-9);
    for (int m = 0; m <= n; m++) {
      std::copy(x, x + n, xs[m]);
      if (m > 0) xs[m][m - 1] += delta;
    }
    trial.evaluate(n + 1, xs, rs);
    double r[6];
    std::copy(rs[0], rs[0] + n, r);
    const double size = norm(n, r);
    if (!(size < INFINITY)) throw std::runtime_error("the stress is not finite");
    Eigen::MatrixXd tangent(n, n);
    Eigen::VectorXd rhs(n);
    for (int j = 0; j < n; j++) {
      rhs[j] = -r[j];
      for (int m = 0; m < n; m++) tangent(j, m) = (rs[m + 1][j] - r[j]) / delta;
    }
    // what rounding leaves: of the stress, of the motion, and of F, which is about 1
    double scale = trial.scale;
    for (int j = 0; j < n; j++) scale = std::max(scale, std::fabs(control.stress[trial.free[j]]));
    const double modulus = tangent.cwiseAbs().maxCoeff();
    scale += largest * modulus;
    if (size <= ROUNDING * scale) break;

    const Eigen::VectorXd dx = tangent.completeOrthogonalDecomposition().solve(rhs);
    for (int m = 0; m < LENGTHS; m++)
      for (int j = 0; j < n; j++) xs[m][j] = x[j] + std::ldexp(dx[j], -m);
    trial.evaluate(LENGTHS, xs, rs);
    int best = 0;
    for (int m = 1; m < LENGTHS; m++)
      if (norm(n, rs[m]) < norm(n, rs[best])) best = m;
    const double next = norm(n, rs[best]);
    if (next < size) std::copy(xs[best], xs[best] + n, x);
    const bool last = iterations == MAX_ITERATIONS;
    // only rounding is left
    done = (next > 0.5 * size || last) && size <= 1e-10 * scale + ROUNDING * modulus;
    if (!done && (next >= size || last)) {
      char text[100];
      snprintf(text, sizeof(text),
               "no motion gives the prescribed stress (off by %.3g of the stress)", size / scale);
      throw std::runtime_error(text);
    }
  }

  for (int j = 0; j < n; j++) guess[trial.free[j]] = x[j] / dt;
  const Matrix3 A = trial.motion(x);
  memcpy(rotation, R1, sizeof(R1));
  move(A.data(), dt);
  return iterations;
}

void MaterialPoint::step_uniaxial_stress(double rate, double dt)
{
  MixedControl control;
  control.L[0] = rate;
  control.stress_given[1] = control.stress_given[2] = true;
  step(control, dt);
}

void MaterialPoint::frame_state(double *F, double *stress) const
{
  const Eigen::Map<const Matrix3> R(rotation);
  Eigen::Map<Matrix3> f(F);
  for (int k = 0; k < 9; k++) f(k / 3, k % 3) = batch.F[k][0];
  f = (R.transpose() * f).eval();
  const Matrix3 s = R.transpose() * stress_matrix(batch, 0) * R;
  for (int k = 0; k < 6; k++) stress[k] = s(VOIGT[k][0], VOIGT[k][1]);
}

double MaterialPoint::density() const
{
  std::vector<double> row(material.history().size());
  for (std::size_t k = 0; k < row.size(); k++) row[k] = history(k);
  return material.density(row.data());
}

double MaterialPoint::vonmises() const
{
  const double p = pressure();
  double sum = 0.0;
  for (int k = 0; k < 3; k++) {
    sum += (stress(k) + p) * (stress(k) + p);
    sum += 2.0 * stress(k + 3) * stress(k + 3);
  }
  return std::sqrt(1.5 * sum);
}

double MaterialPoint::wave_speed() const
{
  double c[BATCH];
  material.wave_speed(batch, c);
  return c[0];
}

double MaterialPoint::stored_energy() const
{
  double w[BATCH];
  material.stored_energy(batch, w);
  return w[0];
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_material_point.h"

#include <cmath>
#include <cstring>

using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

MaterialPoint::MaterialPoint(const Material &material, int n, double h) :
    material(material), batch(), storage(material.history().size() * BATCH), time(0.0), power(0.0),
    work()
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
}

/* ---------------------------------------------------------------------- */

MaterialPoint::MaterialPoint(const MaterialPoint &other) :
    material(other.material), batch(other.batch), storage(other.storage), time(other.time),
    power(other.power)
{
  memcpy(work, other.work, sizeof(work));
  batch.history = reinterpret_cast<double(*)[BATCH]>(storage.data());
}

/* ----------------------------------------------------------------------
   first Piola-Kirchhoff stress of the first point, sigma cof F
------------------------------------------------------------------------- */

static void first_piola(const Batch &b, double *P)
{
  double F[9], s[9];
  for (int k = 0; k < 9; k++) F[k] = b.F[k][0];
  static constexpr int voigt[9] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
  for (int k = 0; k < 9; k++) s[k] = b.stress[voigt[k]][0];
  const double cof[9] = {
      F[4] * F[8] - F[5] * F[7], F[5] * F[6] - F[3] * F[8], F[3] * F[7] - F[4] * F[6],
      F[2] * F[7] - F[1] * F[8], F[0] * F[8] - F[2] * F[6], F[1] * F[6] - F[0] * F[7],
      F[1] * F[5] - F[2] * F[4], F[2] * F[3] - F[0] * F[5], F[0] * F[4] - F[1] * F[3]};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      P[3 * i + j] = s[3 * i] * cof[j] + s[3 * i + 1] * cof[3 + j] + s[3 * i + 2] * cof[6 + j];
}

static double determinant(const double *F)
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
      F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* ----------------------------------------------------------------------
   with G = dt L, the motion is F_new = (I + A) F, A = (I - G/2)^-1 G
------------------------------------------------------------------------- */

void MaterialPoint::step(const double *L, double dt)
{
  double M[9], A[9];    // I - G/2 and A
  for (int k = 0; k < 9; k++) M[k] = (k % 4 == 0 ? 1.0 : 0.0) - 0.5 * dt * L[k];
  const double det = determinant(M);
  const double adj[9] = {
      M[4] * M[8] - M[5] * M[7], M[2] * M[7] - M[1] * M[8], M[1] * M[5] - M[2] * M[4],
      M[5] * M[6] - M[3] * M[8], M[0] * M[8] - M[2] * M[6], M[2] * M[3] - M[0] * M[5],
      M[3] * M[7] - M[4] * M[6], M[1] * M[6] - M[0] * M[7], M[0] * M[4] - M[1] * M[3]};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      A[3 * i + j] =
          dt / det * (adj[3 * i] * L[j] + adj[3 * i + 1] * L[3 + j] + adj[3 * i + 2] * L[6 + j]);
  move(A, dt);
}

/* ---------------------------------------------------------------------- */

void MaterialPoint::move(const double *A, double dt)
{
  double before[9], after[9], dF[9];
  first_piola(batch, before);

  batch.dt = dt;
  batch.time = time + dt;
  for (int p = 0; p < batch.n; p++) {
    double F[9];
    for (int k = 0; k < 9; k++) F[k] = batch.F[k][p];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        dF[3 * i + j] = A[3 * i] * F[j] + A[3 * i + 1] * F[3 + j] + A[3 * i + 2] * F[6 + j];
    for (int k = 0; k < 9; k++) {
      batch.A[k][p] = A[k];
      batch.F[k][p] = F[k] += dF[k];
    }
    batch.Jold[p] = batch.J[p];
    batch.J[p] = determinant(F);
  }
  material.update(batch);

  first_piola(batch, after);
  for (int k = 0; k < 9; k++) power += 0.5 * (before[k] + after[k]) * dF[k];
  for (int k = 0; k < NWORK; k++) work[k] += batch.work[k] / batch.n;
  time += dt;
}

/* ----------------------------------------------------------------------
   lateral strain rate by the secant method
------------------------------------------------------------------------- */

void MaterialPoint::step_uniaxial_stress(double rate, double dt)
{
  const auto gradient = [rate](double lateral, double *L) {
    for (int k = 0; k < 9; k++) L[k] = 0.0;
    L[0] = rate;
    L[4] = L[8] = lateral;
  };
  double L[9];
  const auto residual = [&](double lateral) {
    MaterialPoint trial(*this);
    gradient(lateral, L);
    trial.step(L, dt);
    return trial.stress(1);
  };
  double r0 = -0.25 * rate, r1 = -0.45 * rate, f0 = residual(r0), f1 = residual(r1);
  const double scale = std::fabs(f1 - f0);
  for (int it = 0; it < 100 && f1 != f0 && std::fabs(f1) > 1e-15 * scale; it++) {
    const double r2 = r1 - f1 * (r1 - r0) / (f1 - f0);
    r0 = r1;
    f0 = f1;
    r1 = r2;
    f1 = residual(r1);
  }
  gradient(r1, L);
  step(L, dt);
}

/* ---------------------------------------------------------------------- */

double MaterialPoint::pressure() const
{
  return -(stress(0) + stress(1) + stress(2)) / 3.0;
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

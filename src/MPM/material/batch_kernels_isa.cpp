/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Compiled once for each instruction set (MPM_ISA: base, v3, v4), see material/batch_kernels.cpp.
// Rows of LAMMPS arrays to columns of a batch and back: four points at a time by transposing
// 4x4 pieces in registers, the last few one by one.

#include "material/batch_kernels.h"
#include "math/matrix.h"
#include "transfer/isa.h"
#include "transfer/vector.h"

#include <cmath>

using namespace MPM_NS;

namespace {

using Column = double[BATCH];

/** The first COLUMNS columns of the points p..p+3 from rows of WIDTH reals, times scale. */
template <int WIDTH, int COLUMNS = WIDTH>
MPM_INLINE void rows_to_columns(const double *row, Column *column, int p, double scale)
{
  for (int c = 0; c + 4 <= COLUMNS; c += 4) {
    Vec<4> r[4];
    for (int k = 0; k < 4; k++) r[k] = scale * Vec<4>::load(row + WIDTH * (p + k) + c);
    transpose(r);
    for (int k = 0; k < 4; k++) r[k].store(column[c + k] + p);
  }
  for (int c = COLUMNS / 4 * 4; c < COLUMNS; c++)
    for (int k = p; k < p + 4; k++) column[c][k] = scale * row[WIDTH * k + c];
}

template <int WIDTH, int COLUMNS = WIDTH>
MPM_INLINE void columns_to_rows(const Column *column, double *row, int p)
{
  for (int c = 0; c + 4 <= COLUMNS; c += 4) {
    Vec<4> r[4];
    for (int k = 0; k < 4; k++) r[k] = Vec<4>::load(column[c + k] + p);
    transpose(r);
    for (int k = 0; k < 4; k++) r[k].store(row + WIDTH * (p + k) + c);
  }
  for (int c = COLUMNS / 4 * 4; c < COLUMNS; c++)
    for (int k = p; k < p + 4; k++) row[WIDTH * k + c] = column[c][k];
}

/** Columns of the stress that change. */
template <int DIM> constexpr int NTAU = DIM == 3 ? 6 : 4;

/** Columns of F in plane strain that change: the 2x2 block. */
constexpr int planar[4] = {0, 1, 3, 4};

/** The rows of the points p..p+3 as columns; A: column-major. */
template <int DIM>
MPM_INLINE void load_four(Batch &batch, Column *A, int p, double dt, const double *L,
                          const double *F, const double *tau)
{
  rows_to_columns<DIM * DIM>(L, A, p, dt);
  rows_to_columns<6, NTAU<DIM>>(tau, batch.stress, p, 1.0);
  if constexpr (DIM == 3) {
    rows_to_columns<9>(F, batch.F, p, 1.0);
  } else {
    Vec<4> r[4];
    for (int k = 0; k < 4; k++) {
      const double *row = F + 9 * (p + k);
      r[k] = shuffle<0, 1, 4, 5>(Vec<4>::load(row), Vec<4>::load(row + 3));
      batch.F[8][p + k] = row[8];
    }
    transpose(r);
    for (int c = 0; c < 4; c++) r[c].store(batch.F[planar[c]] + p);
  }
}

template <int DIM>
MPM_INLINE void load_one(Batch &batch, Column *A, int p, double dt, const double *L,
                         const double *F, const double *tau)
{
  for (int c = 0; c < DIM * DIM; c++) A[c][p] = dt * L[DIM * DIM * p + c];
  for (int c = 0; c < 9; c++) batch.F[c][p] = F[9 * p + c];
  for (int c = 0; c < 6; c++) batch.stress[c][p] = tau[6 * p + c];
}

template <int DIM, bool TOTAL, bool HOOP>
void load(Batch &batch, int n, double dt, const double *L, const double *F, const double *tau,
          const double *vol0, const double *hoop)
{
  batch.n = n;
  batch.dt = dt;
  for (int k = 0; k < n; k++) batch.vol0[k] = vol0[k];

  alignas(64) double A[DIM * DIM][BATCH];

  int p = 0;
  for (; p + 4 <= n; p += 4) load_four<DIM>(batch, A, p, dt, L, F, tau);
  for (; p < n; p++) load_one<DIM>(batch, A, p, dt, L, F, tau);

  if constexpr (DIM == 3) {
#pragma omp simd
    for (int q = 0; q < n; q++) {
      double a[9], f[9], g[9];
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
          a[3 * i + j] = A[3 * j + i][q];
          f[3 * i + j] = batch.F[3 * i + j][q];
        }
      const double Jold = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
          f[2] * (f[3] * f[7] - f[4] * f[6]);
      if constexpr (TOTAL) {
        const double c[9] = MPM_COFACTORS(f);
        const double scale = 1.0 / Jold;
        double b[9];
        for (int i = 0; i < 3; i++)
          for (int j = 0; j < 3; j++) {
            g[3 * i + j] = f[3 * i + j] + a[3 * i + j];
            b[3 * i + j] = scale *
                (a[3 * i] * c[3 * j] + a[3 * i + 1] * c[3 * j + 1] + a[3 * i + 2] * c[3 * j + 2]);
          }
        for (int k = 0; k < 9; k++) a[k] = b[k];
      } else {
        for (int i = 0; i < 3; i++)
          for (int j = 0; j < 3; j++)
            g[3 * i + j] =
                f[3 * i + j] + a[3 * i] * f[j] + a[3 * i + 1] * f[3 + j] + a[3 * i + 2] * f[6 + j];
      }
      for (int c = 0; c < 9; c++) {
        batch.A[c][q] = a[c];
        batch.F[c][q] = g[c];
      }
      batch.Jold[q] = Jold;
      batch.J[q] = g[0] * (g[4] * g[8] - g[5] * g[7]) - g[1] * (g[3] * g[8] - g[5] * g[6]) +
          g[2] * (g[3] * g[7] - g[4] * g[6]);
      const double inv = 1.0 / Jold;
      for (int c = 0; c < 6; c++) batch.stress[c][q] *= inv;
    }
  } else {
#pragma omp simd
    for (int q = 0; q < n; q++) {
      double xx = A[0][q], yx = A[1][q], xy = A[2][q], yy = A[3][q];
      const double Fxx = batch.F[0][q], Fxy = batch.F[1][q], Fyx = batch.F[3][q],
                   Fyy = batch.F[4][q], Fzz = batch.F[8][q];
      double gxx, gxy, gyx, gyy;
      const double Jold = Fzz * (Fxx * Fyy - Fxy * Fyx);
      if constexpr (TOTAL) {
        gxx = Fxx + xx;
        gxy = Fxy + xy;
        gyx = Fyx + yx;
        gyy = Fyy + yy;
        const double scale = Fzz / Jold;    // inverse of the determinant in the plane
        const double x = scale * (xx * Fyy - xy * Fyx), y = scale * (yx * Fyy - yy * Fyx);
        xy = scale * (xy * Fxx - xx * Fxy);
        yy = scale * (yy * Fxx - yx * Fxy);
        xx = x;
        yx = y;
      } else {
        gxx = Fxx + xx * Fxx + xy * Fyx;
        gxy = Fxy + xx * Fxy + xy * Fyy;
        gyx = Fyx + yx * Fxx + yy * Fyx;
        gyy = Fyy + yx * Fxy + yy * Fyy;
      }
      batch.A[0][q] = xx;
      batch.A[1][q] = xy;
      batch.A[3][q] = yx;
      batch.A[4][q] = yy;
      batch.F[0][q] = gxx;
      batch.F[1][q] = gxy;
      batch.F[3][q] = gyx;
      batch.F[4][q] = gyy;
      batch.Jold[q] = Jold;
      if constexpr (HOOP) {
        // a point that would cross the axis is a bad one, also when it turns over in the plane
        const double around = 1.0 + hoop[q], gzz = Fzz * around;
        batch.A[8][q] = hoop[q];
        batch.F[8][q] = gzz;
        const double J = gzz * (gxx * gyy - gxy * gyx);
        batch.J[q] = around > 0.0 ? J : -1.0;
      } else
        batch.J[q] = Fzz * (gxx * gyy - gxy * gyx);
      const double inv = 1.0 / Jold;
      for (int c = 0; c < 4; c++) batch.stress[c][q] *= inv;
      batch.stress[4][q] = batch.stress[5][q] = 0.0;
    }
  }
}

template <int DIM> void forget_shape(Batch &b)
{
  constexpr double LIMIT = BatchKernels::FORGET * BatchKernels::FORGET;
  const int n = b.n;
  alignas(64) double far[BATCH];    // positive: |F|^2 is above LIMIT J^(2/DIM), with J in the plane
  int nfar = 0;
#pragma omp simd reduction(+ : nfar)
  for (int p = 0; p < n; p++) {
    double square = b.F[0][p] * b.F[0][p] + b.F[1][p] * b.F[1][p] + b.F[3][p] * b.F[3][p] +
        b.F[4][p] * b.F[4][p];
    if constexpr (DIM == 3) {
      square += b.F[2][p] * b.F[2][p] + b.F[5][p] * b.F[5][p] + b.F[6][p] * b.F[6][p] +
          b.F[7][p] * b.F[7][p] + b.F[8][p] * b.F[8][p];
      far[p] = square * square * square - LIMIT * LIMIT * LIMIT * b.J[p] * b.J[p];
    } else
      far[p] = square * b.F[8][p] - LIMIT * b.J[p];
    nfar += far[p] > 0.0;
  }
  if (nfar == 0) return;

  for (int p = 0; p < n; p++) {
    if (!(far[p] > 0.0 && b.J[p] > 0.0)) continue;    // store() knows what to do with bad points
    const double scale = DIM == 3 ? std::cbrt(b.J[p]) : std::sqrt(b.J[p] / b.F[8][p]);
    for (int c = 0; c < (DIM == 3 ? 9 : 5); c++) b.F[c][p] = c % 4 == 0 ? scale : 0.0;
  }
}

/** Writes the points p..p+3; tau: columns. */
template <int DIM, bool HOOP>
MPM_INLINE void store_four(const Batch &batch, const Column *tau_columns, int p, double *F,
                           double *tau)
{
  columns_to_rows<6, NTAU<DIM>>(tau_columns, tau, p);
  if constexpr (DIM == 3) {
    columns_to_rows<9>(batch.F, F, p);
  } else {
    Vec<4> r[4];
    for (int c = 0; c < 4; c++) r[c] = Vec<4>::load(batch.F[planar[c]] + p);
    transpose(r);
    for (int k = 0; k < 4; k++) {
      double *row = F + 9 * (p + k);
      half<0>(r[k]).store(row);
      half<1>(r[k]).store(row + 3);
      if constexpr (HOOP) row[8] = batch.F[8][p + k];
    }
  }
}

template <int DIM, bool HOOP> int store(const Batch &batch, double *F, double *tau)
{
  alignas(64) double tau_columns[NTAU<DIM>][BATCH];
  const int n = batch.n;
  int bad = 0;
#pragma omp simd reduction(+ : bad)
  for (int p = 0; p < n; p++) {
    bad += !(batch.J[p] > 0.0);
    for (int c = 0; c < NTAU<DIM>; c++) tau_columns[c][p] = batch.J[p] * batch.stress[c][p];
  }

  int p = 0;
  if (bad == 0)
    for (; p + 4 <= n; p += 4) store_four<DIM, HOOP>(batch, tau_columns, p, F, tau);
  for (; p < n; p++) {
    if (bad && !(batch.J[p] > 0.0)) continue;
    for (int c = 0; c < 9; c++) F[9 * p + c] = batch.F[c][p];
    for (int c = 0; c < NTAU<DIM>; c++) tau[6 * p + c] = tau_columns[c][p];
  }
  return bad;
}

/** P = tau F^-T = tau cof(F)/J, rows in and out. */
template <int DIM> void first_piola(int n, const double *F, const double *tau, double *P)
{
  constexpr int SIZE = DIM * DIM;
  alignas(64) double f[9][BATCH], s[6][BATCH], c[SIZE][BATCH];

  int p = 0;
  for (; p + 4 <= n; p += 4) {
    rows_to_columns<9, DIM == 3 ? 9 : 8>(F, f, p, 1.0);
    rows_to_columns<6, NTAU<DIM>>(tau, s, p, 1.0);
  }
  for (; p < n; p++) {
    for (int k = 0; k < 9; k++) f[k][p] = F[9 * p + k];
    for (int k = 0; k < 6; k++) s[k][p] = tau[6 * p + k];
  }

  if constexpr (DIM == 3) {
#pragma omp simd
    for (int q = 0; q < n; q++) {
      const double g[9] = {f[0][q], f[1][q], f[2][q], f[3][q], f[4][q],
                           f[5][q], f[6][q], f[7][q], f[8][q]};
      const double cof[9] = MPM_COFACTORS(g);
      const double inv = 1.0 / (g[0] * cof[0] + g[1] * cof[1] + g[2] * cof[2]);
      const double xx = inv * s[0][q], yy = inv * s[1][q], zz = inv * s[2][q], xy = inv * s[3][q],
                   xz = inv * s[4][q], yz = inv * s[5][q];
      for (int j = 0; j < 3; j++) {
        c[3 * j][q] = xx * cof[j] + xy * cof[3 + j] + xz * cof[6 + j];
        c[3 * j + 1][q] = xy * cof[j] + yy * cof[3 + j] + yz * cof[6 + j];
        c[3 * j + 2][q] = xz * cof[j] + yz * cof[3 + j] + zz * cof[6 + j];
      }
    }
  } else {
#pragma omp simd
    for (int q = 0; q < n; q++) {
      const double Fxx = f[0][q], Fxy = f[1][q], Fyx = f[3][q], Fyy = f[4][q];
      const double inv = 1.0 / (Fxx * Fyy - Fxy * Fyx);
      const double xx = inv * s[0][q], yy = inv * s[1][q], xy = inv * s[3][q];
      c[0][q] = xx * Fyy - xy * Fxy;
      c[1][q] = xy * Fyy - yy * Fxy;
      c[2][q] = xy * Fxx - xx * Fyx;
      c[3][q] = yy * Fxx - xy * Fyx;
    }
  }

  for (p = 0; p + 4 <= n; p += 4) columns_to_rows<SIZE>(c, P, p);
  for (; p < n; p++)
    for (int k = 0; k < SIZE; k++) P[SIZE * p + k] = c[k][p];
}

/** From the rows of points to the columns of a batch, or the way back; a row has any width. */
template <bool BACK, class Rows> MPM_INLINE void move_history(const Batch &b, int width, Rows *rows)
{
  const auto move = [&](int p, int c) {
    if constexpr (BACK)
      rows[width * p + c] = b.history[c][p];
    else
      b.history[c][p] = rows[width * p + c];
  };
  const int n = b.n;
  int c = 0;
  for (; c + 4 <= width; c += 4) {
    int p = 0;
    for (; p + 4 <= n; p += 4) {
      Vec<4> r[4];
      for (int k = 0; k < 4; k++)
        r[k] = Vec<4>::load(BACK ? b.history[c + k] + p : rows + width * (p + k) + c);
      transpose(r);
      for (int k = 0; k < 4; k++)
        if constexpr (BACK)
          r[k].store(rows + width * (p + k) + c);
        else
          r[k].store(b.history[c + k] + p);
    }
    for (; p < n; p++)
      for (int k = c; k < c + 4; k++) move(p, k);
  }
  for (; c < width; c++)
    for (int p = 0; p < n; p++) move(p, c);
}

void load_history(Batch &b, int width, const double *rows)
{
  move_history<false>(b, width, rows);
}

void store_history(const Batch &b, int width, double *rows)
{
  move_history<true>(b, width, rows);
}

void add_kirchhoff(const Batch &b, const double *J, double (*sum)[BATCH])
{
  const int n = b.n;
  for (int c = 0; c < 6; c++) {
#pragma omp simd
    for (int p = 0; p < n; p++) sum[c][p] += J[p] * b.stress[c][p];
  }
}

double stress_work(const Batch &b, const double (*twice_tau)[BATCH])
{
  const int n = b.n;
  double work = 0.0;
#pragma omp simd reduction(+ : work)
  for (int p = 0; p < n; p++) {
    const double a[9] = {b.A[0][p], b.A[1][p], b.A[2][p], b.A[3][p], b.A[4][p],
                         b.A[5][p], b.A[6][p], b.A[7][p], b.A[8][p]};
    const double mid[9] = {1.0 + 0.5 * a[0], 0.5 * a[1],       0.5 * a[2],
                           0.5 * a[3],       1.0 + 0.5 * a[4], 0.5 * a[5],
                           0.5 * a[6],       0.5 * a[7],       1.0 + 0.5 * a[8]};
    const double cof[9] = MPM_COFACTORS(mid);
    const double det = mid[0] * cof[0] + mid[1] * cof[1] + mid[2] * cof[2];
    // A times the transpose of the cofactors, its symmetric part
    const auto row = [&](int i, int j) {
      return a[3 * i] * cof[3 * j] + a[3 * i + 1] * cof[3 * j + 1] + a[3 * i + 2] * cof[3 * j + 2];
    };
    const double rate = twice_tau[0][p] * row(0, 0) + twice_tau[1][p] * row(1, 1) +
        twice_tau[2][p] * row(2, 2) + twice_tau[3][p] * (row(0, 1) + row(1, 0)) +
        twice_tau[4][p] * (row(0, 2) + row(2, 0)) + twice_tau[5][p] * (row(1, 2) + row(2, 1));
    const double mine = 0.5 * b.vol0[p] * rate / det;
    work += b.J[p] > 0.0 ? mine : 0.0;
  }
  return work;
}

void jacobians(const Column *F, int n, double *J)
{
#pragma omp simd
  for (int p = 0; p < n; p++)
    J[p] = F[0][p] * (F[4][p] * F[8][p] - F[5][p] * F[7][p]) -
        F[1][p] * (F[3][p] * F[8][p] - F[5][p] * F[6][p]) +
        F[2][p] * (F[3][p] * F[7][p] - F[4][p] * F[6][p]);
}

template <int DIM, bool HOOP>
const BatchKernels kernels = {load<DIM, false, HOOP>, load<DIM, true, HOOP>, forget_shape<DIM>,
                              first_piola<DIM>,       add_kirchhoff,         stress_work,
                              load_history,           store_history,         jacobians,
                              store<DIM, HOOP>};

}    // namespace

namespace MPM_NS {
const BatchKernels *MPM_OF_ISA(mpm_batch)(int dim, bool hoop);
}

const BatchKernels *MPM_NS::MPM_OF_ISA(mpm_batch)(int dim, bool hoop)
{
  return dim == 3 ? &kernels<3, false> : hoop ? &kernels<2, true> : &kernels<2, false>;
}

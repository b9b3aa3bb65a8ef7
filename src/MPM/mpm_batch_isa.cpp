/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */


// Compiled once for each instruction set (MPM_ISA: base, v3, v4), see mpm_batch.cpp.
// Rows of LAMMPS arrays to columns of a batch and back: four points at a time by transposing
// 4x4 pieces in registers, the last few one by one.

#include "mpm_batch.h"
#include "mpm_vector.h"

#define MPM_CONCAT2(a, b) a##b
#define MPM_CONCAT(a, b) MPM_CONCAT2(a, b)
#ifndef MPM_ISA
#define MPM_ISA base
#endif

using namespace MPM_NS;

namespace {

using Column = double[BATCH];

MPM_INLINE void transpose(Vec<4> r[4])
{
  const Vec<4> a = shuffle<0, 4, 2, 6>(r[0], r[1]), b = shuffle<1, 5, 3, 7>(r[0], r[1]);
  const Vec<4> c = shuffle<0, 4, 2, 6>(r[2], r[3]), d = shuffle<1, 5, 3, 7>(r[2], r[3]);
  r[0] = shuffle<0, 1, 4, 5>(a, c);
  r[1] = shuffle<0, 1, 4, 5>(b, d);
  r[2] = shuffle<2, 3, 6, 7>(a, c);
  r[3] = shuffle<2, 3, 6, 7>(b, d);
}

/** Four columns of the points p..p+3 from rows of WIDTH reals, times scale. */
template <int WIDTH> MPM_INLINE void rows_to_columns(const double *row, Column *column, int p,
                                                     double scale)
{
  Vec<4> r[4];
  for (int k = 0; k < 4; k++) r[k] = scale * Vec<4>::load(row + WIDTH * (p + k));
  transpose(r);
  for (int k = 0; k < 4; k++) r[k].store(column[k] + p);
}

template <int WIDTH> MPM_INLINE void columns_to_rows(const Column *column, double *row, int p)
{
  Vec<4> r[4];
  for (int k = 0; k < 4; k++) r[k] = Vec<4>::load(column[k] + p);
  transpose(r);
  for (int k = 0; k < 4; k++) r[k].store(row + WIDTH * (p + k));
}

/** row-major position of entry k of a column-major 3x3 matrix */
constexpr int transposed[9] = {0, 3, 6, 1, 4, 7, 2, 5, 8};

void load(Batch &batch, int n, double dt, const double *L, const double *F, const double *stress,
          const double *vol0)
{
  batch.n = n;
  batch.dt = dt;
  // one line of eight points now and then is too little for the prefetcher of the CPU
  for (int k = 0; k < BATCH; k += 8) __builtin_prefetch(vol0 + BATCH + k);
  for (int k = 0; k < n; k++) batch.vol0[k] = vol0[k];

  alignas(64) double A[9][BATCH];    // column-major

  int p = 0;
  for (; p + 4 <= n; p += 4) {
    rows_to_columns<9>(L, A, p, dt);
    rows_to_columns<9>(L + 4, A + 4, p, dt);
    rows_to_columns<9>(F, batch.F, p, 1.0);
    rows_to_columns<9>(F + 4, batch.F + 4, p, 1.0);
    rows_to_columns<6>(stress, batch.stress, p, 1.0);
    for (int k = p; k < p + 4; k++) {
      A[8][k] = dt * L[9 * k + 8];
      batch.F[8][k] = F[9 * k + 8];
      batch.stress[4][k] = stress[6 * k + 4];
      batch.stress[5][k] = stress[6 * k + 5];
    }
  }
  for (; p < n; p++) {
    for (int c = 0; c < 9; c++) {
      A[c][p] = dt * L[9 * p + c];
      batch.F[c][p] = F[9 * p + c];
    }
    for (int c = 0; c < 6; c++) batch.stress[c][p] = stress[6 * p + c];
  }

#pragma omp simd
  for (int q = 0; q < n; q++) {
    double a[9], f[9], g[9];
    for (int c = 0; c < 9; c++) {
      a[c] = A[transposed[c]][q];
      f[c] = batch.F[c][q];
    }
    batch.Jold[q] = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
        f[2] * (f[3] * f[7] - f[4] * f[6]);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        g[3 * i + j] =
            f[3 * i + j] + a[3 * i] * f[j] + a[3 * i + 1] * f[3 + j] + a[3 * i + 2] * f[6 + j];
    for (int c = 0; c < 9; c++) {
      batch.A[c][q] = a[c];
      batch.F[c][q] = g[c];
    }
    batch.J[q] = g[0] * (g[4] * g[8] - g[5] * g[7]) - g[1] * (g[3] * g[8] - g[5] * g[6]) +
        g[2] * (g[3] * g[7] - g[4] * g[6]);
  }
}

int store(const Batch &batch, double *F, double *stress, double *vol)
{
  const int n = batch.n;
  int bad = 0;
  for (int p = 0; p < n; p++) bad += !(batch.J[p] > 0.0);

  int p = 0;
  if (bad == 0) {
    for (; p + 4 <= n; p += 4) {
      columns_to_rows<9>(batch.F, F, p);
      columns_to_rows<9>(batch.F + 4, F + 4, p);
      columns_to_rows<6>(batch.stress, stress, p);
      for (int k = p; k < p + 4; k++) {
        F[9 * k + 8] = batch.F[8][k];
        stress[6 * k + 4] = batch.stress[4][k];
        stress[6 * k + 5] = batch.stress[5][k];
        vol[k] = batch.vol0[k] * batch.J[k];
      }
    }
  }
  for (; p < n; p++) {
    if (bad && !(batch.J[p] > 0.0)) continue;
    for (int c = 0; c < 9; c++) F[9 * p + c] = batch.F[c][p];
    for (int c = 0; c < 6; c++) stress[6 * p + c] = batch.stress[c][p];
    vol[p] = batch.vol0[p] * batch.J[p];
  }
  return bad;
}

}    // namespace

namespace MPM_NS {
const BatchKernels *MPM_CONCAT(mpm_batch_, MPM_ISA)();
}

const BatchKernels *MPM_NS::MPM_CONCAT(mpm_batch_, MPM_ISA)()
{
  static const BatchKernels kernels = {load, store};
  return &kernels;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Products of dense blocks, see BlockKernels; compiled once for each instruction set.

#include "solve/block_kernels.h"
#include "transfer/kernels_isa.h"

namespace MPM_NS {
BlockKernels MPM_OF_ISA(mpm_kernels_blocks)();
}

#if !defined(MPM_HAVE_VECTORS)

namespace {

using namespace MPM_NS;

void subtract(double *S, const double *a, const double *b, int64_t n)
{
  for (int64_t k = 0; k < n; k++)
    for (int c = 0; c < FACTOR_BLOCK; c++)
      for (int r = 0; r < FACTOR_BLOCK; r++)
        S[FACTOR_BLOCK * c + r] -= a[FACTOR_BLOCK * k + r] * b[FACTOR_BLOCK * k + c];
}

template <class Real> void subtract_from_rows(double *y, const Real *a, const double *x, int64_t n)
{
  for (int64_t k = 0; k < n; k++)
    for (int r = 0; r < FACTOR_BLOCK; r++) y[r] -= a[FACTOR_BLOCK * k + r] * x[k];
}

template <class Real>
void subtract_from_columns(double *y, const Real *a, const double *x, int64_t n)
{
  for (int64_t k = 0; k < n; k++)
    for (int r = 0; r < FACTOR_BLOCK; r++) y[k] -= a[FACTOR_BLOCK * k + r] * x[r];
}

}    // namespace

#else

#include "transfer/vector.h"

namespace {

using namespace MPM_NS;

constexpr int B = FACTOR_BLOCK;
using V = Vec<REGISTER>;

/** Registers of sums: rows of two registers, and as many columns as there is room for. */
constexpr int ROWS = 2 * REGISTER, COLUMNS = REGISTER == 8 ? 8 : 4;

void subtract(double *S, const double *a, const double *b, int64_t n)
{
  for (int row = 0; row < B; row += ROWS)
    for (int column = 0; column < B; column += COLUMNS) {
      V sum[COLUMNS][2] = {};
      const double *left = a + row, *right = b + column;
      for (int64_t k = 0; k < n; k++, left += B, right += B) {
        const V low = V::load(left), high = V::load(left + REGISTER);
        MPM_UNROLL
        for (int c = 0; c < COLUMNS; c++) {
          const V factor = V::all(right[c]);
          sum[c][0] += low * factor;
          sum[c][1] += high * factor;
        }
      }
      MPM_UNROLL
      for (int c = 0; c < COLUMNS; c++) {
        double *const to = S + B * (column + c) + row;
        (V::load(to) - sum[c][0]).store(to);
        (V::load(to + REGISTER) - sum[c][1]).store(to + REGISTER);
      }
    }
}

template <class Real> void subtract_from_rows(double *y, const Real *a, const double *x, int64_t n)
{
  // two sums of each row, as one waits for the last addition
  constexpr int PARTS = B / REGISTER;
  V sum[2][PARTS] = {};
  for (int64_t k = 0; k < n; k += 2, a += 2 * B) {
    MPM_UNROLL
    for (int i = 0; i < PARTS; i++) {
      sum[0][i] += V::load(a + REGISTER * i) * x[k];
      sum[1][i] += V::load(a + B + REGISTER * i) * x[k + 1];
    }
  }
  MPM_UNROLL
  for (int i = 0; i < PARTS; i++)
    (V::load(y + REGISTER * i) - (sum[0][i] + sum[1][i])).store(y + REGISTER * i);
}

template <class Real>
void subtract_from_columns(double *y, const Real *a, const double *x, int64_t n)
{
  using Four = Vec<4>;
  Four from[B / 4];
  MPM_UNROLL
  for (int i = 0; i < B / 4; i++) from[i] = Four::load(x + 4 * i);
  for (int64_t k = 0; k < n; k += 4, a += 4 * B) {
    Four sum[4];
    MPM_UNROLL
    for (int c = 0; c < 4; c++) {
      sum[c] = from[0] * Four::load(a + B * c);
      MPM_UNROLL
      for (int i = 1; i < B / 4; i++) sum[c] += from[i] * Four::load(a + B * c + 4 * i);
    }
    const Four low = shuffle<0, 4, 2, 6>(sum[0], sum[1]) + shuffle<1, 5, 3, 7>(sum[0], sum[1]);
    const Four high = shuffle<0, 4, 2, 6>(sum[2], sum[3]) + shuffle<1, 5, 3, 7>(sum[2], sum[3]);
    (Four::load(y + k) - (shuffle<0, 1, 4, 5>(low, high) + shuffle<2, 3, 6, 7>(low, high)))
        .store(y + k);
  }
}

}    // namespace

#endif

MPM_NS::BlockKernels MPM_NS::MPM_OF_ISA(mpm_kernels_blocks)()
{
  return {subtract,
          {subtract_from_rows<double>, subtract_from_columns<double>},
          {subtract_from_rows<float>, subtract_from_columns<float>}};
}

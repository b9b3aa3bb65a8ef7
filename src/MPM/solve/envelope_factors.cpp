/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/envelope_factors.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

static constexpr int B = FACTOR_BLOCK, BB = B * B;

/* ----------------------------------------------------------------------
   Unknowns in layers: those that are as many entries away from the first one. That is one that is far from another one
------------------------------------------------------------------------- */

void EnvelopeFactors::put_in_order(const Sparse &A)
{
  const int n = unknowns;
  std::vector<int> queue;
  queue.reserve(n);
  number.assign(n, -1);
  // from a given one: the queue has all that are joined to it, in layers, behind those that it has already
  const auto visit = [&](int seed) {
    std::size_t next = queue.size();
    queue.push_back(seed);
    number[seed] = 0;
    for (; next < queue.size(); next++)
      for (Sparse::InnerIterator it(A, queue[next]); it; ++it)
        if (const int to = (int) it.row(); number[to] < 0) {
          number[to] = 0;
          queue.push_back(to);
        }
  };
  for (int seed = 0; seed < n; seed++) {
    if (number[seed] >= 0) continue;
    const std::size_t begin = queue.size();
    int from = seed;
    for (int turn = 0; turn < 3; turn++) {
      for (std::size_t k = begin; k < queue.size(); k++) number[queue[k]] = -1;
      queue.resize(begin);
      visit(from);
      from = queue.back();
    }
  }
  // backwards, as the envelope then is smaller (A. George, Stanford report STAN-CS-71-208, 1971)
  for (int k = 0; k < n; k++) number[queue[k]] = n - 1 - k;
}

/** The places of all blocks. */
void EnvelopeFactors::find_envelope(const Sparse &A)
{
  const int rows = (unknowns + B - 1) / B;
  first.resize(rows);
  start.resize(rows + 1);
  for (int i = 0; i < rows; i++) first[i] = i;
  for (int c = 0; c < unknowns; c++)
    for (Sparse::InnerIterator it(A, c); it; ++it) {
      int &low = first[number[it.row()] / B];
      low = std::min(low, number[c] / B);
    }
  start[0] = 0;
  for (int i = 0; i < rows; i++) start[i + 1] = start[i] + (int64_t) BB * (i - first[i] + 1);
}

/** The entries of the matrix in the blocks; behind the last row, unity. */
void EnvelopeFactors::fill(const Sparse &A)
{
  const int rows = (int) first.size();
  values.assign(start[rows], 0.0);
  for (int c = 0; c < unknowns; c++)
    for (Sparse::InnerIterator it(A, c); it; ++it) {
      const int row = number[it.row()], column = number[c];
      if (column / B > row / B) continue;
      const int i = row / B;
      values[start[i] + (int64_t) B * (column - B * first[i]) + row % B] = it.value();
    }
  for (int k = unknowns; k < B * rows; k++)
    values[start[rows] - BB + (B + 1) * (int64_t) (k % B)] = 1.0;
}

/** The inverse of the factor L of A = L L^T, in place of A, columns; false: it has none. */
bool EnvelopeFactors::factorize_block(double *A)
{
  double L[B][B];
  for (int i = 0; i < B; i++)
    for (int j = 0; j <= i; j++) {
      double sum = A[B * j + i];
      for (int k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
      if (i == j && !(sum > 0.0 && std::isfinite(sum))) return false;
      L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
  for (int c = 0; c < B; c++) {
    double *const column = A + B * c;
    for (int i = 0; i < c; i++) column[i] = 0.0;
    for (int i = c; i < B; i++) {
      double sum = i == c;
      for (int k = c; k < i; k++) sum -= L[i][k] * column[k];
      column[i] = sum / L[i][i];
    }
  }
  return true;
}

/* ---------------------------------------------------------------------- */

bool EnvelopeFactors::compute(const Sparse &A)
{
  unknowns = (int) A.rows();
  put_in_order(A);
  find_envelope(A);
  fill(A);
  return factorize();
}

bool EnvelopeFactors::compute_again(const Sparse &A)
{
  fill(A);
  return factorize();
}

bool EnvelopeFactors::factorize()
{
  double S[BB];
  for (int i = 0; i < (int) first.size(); i++) {
    double *const row = values.data() + start[i];
    for (int j = first[i]; j <= i; j++) {
      double *const block = row + (int64_t) BB * (j - first[i]);
      const double *const other = values.data() + start[j];
      const int from = std::max(first[i], first[j]);
      kernels.subtract(block, row + (int64_t) BB * (from - first[i]),
                       other + (int64_t) BB * (from - first[j]), (int64_t) B * (j - from));
      if (j == i) {
        if (!factorize_block(block)) return false;
      } else {
        // times the transposed inverse of the block at the diagonal
        for (int k = 0; k < BB; k++) S[k] = -block[k];
        std::fill_n(block, BB, 0.0);
        kernels.subtract(block, S, other + (int64_t) BB * (j - first[j]), B);
      }
    }
  }
  return true;
}

void EnvelopeFactors::solve(const double *b, double *x)
{
  const int rows = (int) first.size();
  solution.assign((std::size_t) B * rows, 0.0);
  double *const y = solution.data();
  for (int k = 0; k < unknowns; k++) y[number[k]] = b[k];
  double rest[B];
  const auto diagonal = [this](int i) {
    return values.data() + start[i + 1] - BB;
  };
  for (int i = 0; i < rows; i++) {
    double *const mine = y + B * i;
    kernels.subtract_from_rows(mine, values.data() + start[i], y + B * first[i],
                               (int64_t) B * (i - first[i]));
    for (int k = 0; k < B; k++) rest[k] = -mine[k];
    std::fill_n(mine, B, 0.0);
    kernels.subtract_from_rows(mine, diagonal(i), rest, B);
  }
  for (int i = rows - 1; i >= 0; i--) {
    double *const mine = y + B * i;
    for (int k = 0; k < B; k++) rest[k] = -mine[k];
    std::fill_n(mine, B, 0.0);
    kernels.subtract_from_columns(mine, diagonal(i), rest, B);
    kernels.subtract_from_columns(y + B * first[i], values.data() + start[i], mine,
                                  (int64_t) B * (i - first[i]));
  }
  for (int k = 0; k < unknowns; k++) x[k] = y[number[k]];
}

double EnvelopeFactors::memory_usage() const
{
  return (values.capacity() + solution.capacity()) * sizeof(double) +
      start.capacity() * sizeof(int64_t) + (number.capacity() + first.capacity()) * sizeof(int);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/envelope.h"

#include <algorithm>
#include <cmath>

using namespace MPM_NS;

void Envelope::start(int inner_rows, int rest)
{
  inner = inner_rows;
  first.resize(inner + rest);
  for (int i = 0; i < rows(); i++) first[i] = std::min(i, inner);
  begin.clear();
}

int64_t Envelope::count() const
{
  int64_t all = 0;
  for (int i = 0; i < rows(); i++) all += reals_of(i);
  return all;
}

int Envelope::place_of_half() const
{
  const int64_t enough = count() / 2;
  int row = 0;
  for (int64_t so_far = 0; row < rows() && so_far < enough; row++) so_far += reals_of(row);
  return B * row;
}

void Envelope::clear()
{
  begin.resize(rows() + 1);
  begin[0] = 0;
  for (int i = 0; i < rows(); i++) begin[i + 1] = begin[i] + reals_of(i);
  values.assign(size(), 0.0);
  rounded.clear();
}

double &Envelope::at(int row, int column)
{
  const int i = row / B;
  return values[begin[i] + (int64_t) B * (column - B * first[i]) + row % B];
}

/** The inverse of the factor L of A = L L^T, in place of A, columns; false: it has none. */
bool Envelope::factorize_block(double *A)
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

bool Envelope::factorize()
{
  double S[BB];
  for (int i = 0; i < rows(); i++) {
    double *const row = values.data() + begin[i];
    for (int j = first[i]; j <= i; j++) {
      double *const block = row + (int64_t) BB * (j - first[i]);
      const double *const other = values.data() + begin[j];
      const int from = std::max(first[i], first[j]), to = std::min(j, inner);
      if (from < to)
        kernels.subtract(block, row + (int64_t) BB * (from - first[i]),
                         other + (int64_t) BB * (from - first[j]), (int64_t) B * (to - from));
      if (j >= inner) continue;
      if (j == i) {
        if (!factorize_block(block)) return false;
      } else {
        // times the transposed inverse of the block at the diagonal
        for (int k = 0; k < BB; k++) S[k] = -block[k];
        std::fill_n(block, BB, 0.0);
        kernels.subtract(block, S, values.data() + diagonal(j), B);
      }
    }
  }
  return true;
}

void Envelope::give_rest(std::vector<double> &blocks) const
{
  for (int i = inner; i < rows(); i++) {
    const double *const of = values.data() + begin[i] + (int64_t) BB * (inner - first[i]);
    blocks.insert(blocks.end(), of, of + (int64_t) BB * (i - inner + 1));
  }
}

void Envelope::add(const double *blocks)
{
  for (int64_t k = 0; k < size(); k++) values[k] += blocks[k];
}

void Envelope::round()
{
  rounded.assign(values.begin(), values.end());
  std::vector<double>().swap(values);
}

template <class Real>
void Envelope::forward(const Products<Real> &products, const Real *of, double *y) const
{
  double rest[B];
  for (int i = 0; i < rows(); i++) {
    double *const mine = y + B * i;
    products.subtract_from_rows(mine, of + begin[i], y + B * first[i],
                                (int64_t) B * (std::min(i, inner) - first[i]));
    if (i >= inner) continue;
    for (int k = 0; k < B; k++) rest[k] = -mine[k];
    std::fill_n(mine, B, 0.0);
    products.subtract_from_rows(mine, of + diagonal(i), rest, B);
  }
}

template <class Real>
void Envelope::backward(const Products<Real> &products, const Real *of, double *y) const
{
  double rest[B];
  for (int i = rows() - 1; i >= 0; i--) {
    double *const mine = y + B * i;
    if (i < inner) {
      for (int k = 0; k < B; k++) rest[k] = -mine[k];
      std::fill_n(mine, B, 0.0);
      products.subtract_from_columns(mine, of + diagonal(i), rest, B);
    }
    products.subtract_from_columns(y + B * first[i], of + begin[i], mine,
                                   (int64_t) B * (std::min(i, inner) - first[i]));
  }
}

void Envelope::solve_forward(double *y) const
{
  if (rounded.empty())
    forward(kernels.of_doubles, values.data(), y);
  else
    forward(kernels.of_floats, rounded.data(), y);
}

void Envelope::solve_backward(double *y) const
{
  if (rounded.empty())
    backward(kernels.of_doubles, values.data(), y);
  else
    backward(kernels.of_floats, rounded.data(), y);
}

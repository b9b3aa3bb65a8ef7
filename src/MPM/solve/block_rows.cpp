/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/block_rows.h"

#include <algorithm>
#include <cstring>

using namespace MPM_NS;

void BlockRows::assemble(LatticeRanks &ranks_in, int width_in, const std::vector<int> &first_in,
                         const std::vector<MatrixBlock> &lower)
{
  ranks = &ranks_in;
  width = width_in;
  first = first_in;
  const int from = begin(), to = end(), w = width, ww = w * w;
  const auto is_mine = [&](int row) {
    return row >= from && row < to;
  };

  // all ranks get what is not of one of them alone, and have it in the same order, so that both
  // triangles have the same sums

  std::vector<MatrixBlock> given, shared;
  if (ranks->number() > 1) {
    for (const auto &b : lower)
      if (!is_mine(b.row) || !is_mine(b.column)) given.push_back(b);
    ranks->gather(given, shared);
  }
  const auto each_block = [&](const auto &f) {
    for (const auto &b : lower)
      if (is_mine(b.row) && is_mine(b.column)) f(b);
    for (const auto &b : shared) f(b);
  };

  // rows with all that was given, then in the order of columns, each of which there is once

  struct Place {
    int column;
    const MatrixBlock *of;
    bool turned;
  };
  std::vector<int64_t> end_of(to - from + 1, 0);
  const auto each_place = [&](const auto &f) {
    each_block([&](const MatrixBlock &b) {
      if (is_mine(b.row)) f(b.row - from, Place{b.column, &b, false});
      if (is_mine(b.column) && b.row != b.column) f(b.column - from, Place{b.row, &b, true});
    });
  };
  each_place([&](int row, const Place &) {
    end_of[row + 1]++;
  });
  for (int row = 0; row < to - from; row++) end_of[row + 1] += end_of[row];
  std::vector<Place> places(end_of.back());
  auto next = end_of;
  each_place([&](int row, const Place &place) {
    places[next[row]++] = place;
  });
  start.assign(1, 0);
  column.clear();
  for (int row = 0; row < to - from; row++) {
    std::stable_sort(places.begin() + end_of[row], places.begin() + end_of[row + 1],
                     [](const Place &a, const Place &b) {
                       return a.column < b.column;
                     });
    for (int64_t k = end_of[row]; k < end_of[row + 1]; k++)
      if (k == end_of[row] || places[k].column != places[k - 1].column)
        column.push_back(places[k].column);
    start.push_back(column.size());
  }
  value.assign(column.size() * ww, 0.0);
  double *at = value.data() - ww;
  for (int row = 0; row < to - from; row++)
    for (int64_t k = end_of[row]; k < end_of[row + 1]; k++) {
      const Place &place = places[k];
      if (k == end_of[row] || place.column != places[k - 1].column) at += ww;
      for (int a = 0; a < w; a++)
        for (int b = 0; b < w; b++)
          at[a * w + b] += place.of->value[place.turned ? b * w + a : a * w + b];
    }
  product.resize((std::size_t)(to - from) * w);
  bytes.resize(ranks->number());
  for (int p = 0; p < ranks->number(); p++)
    bytes[p] = (first[p + 1] - first[p]) * w * (int) sizeof(double);
}

const double *BlockRows::find(int row, int wanted) const
{
  const auto from = column.begin() + start[row - begin()],
             to = column.begin() + start[row - begin() + 1];
  const auto found = std::lower_bound(from, to, wanted);
  if (found == to || *found != wanted) return nullptr;
  return value.data() + (found - column.begin()) * width * width;
}

template <int W> void BlockRows::multiply_rows(const double *x, double *y) const
{
  const int n = end() - begin();
  const double *v = value.data();
  for (int row = 0; row < n; row++) {
    double sum[W] = {};
    for (int64_t k = start[row]; k < start[row + 1]; k++, v += W * W) {
      const double *const from = x + (std::size_t) column[k] * W;
      for (int a = 0; a < W; a++)
        for (int b = 0; b < W; b++) sum[a] += v[a * W + b] * from[b];
    }
    for (int a = 0; a < W; a++) y[row * W + a] = sum[a];
  }
}

void BlockRows::multiply(const double *x, double *y)
{
  static constexpr void (BlockRows::*table[])(const double *, double *)
      const = {nullptr, &BlockRows::multiply_rows<1>, &BlockRows::multiply_rows<2>,
               &BlockRows::multiply_rows<3>};
  const auto of_rows = table[width];
  if (ranks->number() == 1) {
    (this->*of_rows)(x, y);
    return;
  }
  (this->*of_rows)(x, product.data());
  const auto &all = ranks->gather_sizes(product.data(), bytes);
  if (!all.empty()) std::memcpy(y, all.data(), all.size());
}

std::vector<double> BlockRows::gather_rows(const std::vector<double> &mine, int n) const
{
  std::vector<int> sizes(ranks->number());
  for (int p = 0; p < ranks->number(); p++)
    sizes[p] = (first[p + 1] - first[p]) * n * (int) sizeof(double);
  const auto &all = ranks->gather_sizes(mine.data(), sizes);
  std::vector<double> values(all.size() / sizeof(double));
  if (!all.empty()) std::memcpy(values.data(), all.data(), all.size());
  return values;
}

std::vector<MatrixBlock> BlockRows::coarsened(const CoarseParts &P, int next) const
{
  const int ww = width * width, n = end() - begin();

  // A P, and which rows each coarse function has

  std::vector<int64_t> row_of{0};
  std::vector<int> columns, place(next, -1);
  std::vector<double> values;
  std::vector<int> children_of(next + 1, 0);
  for (int row = 0; row < n; row++) {
    const int64_t from = columns.size();
    each(row + begin(), [&](int fine, const double *block) {
      for (const auto &part : P.of(fine)) {
        if (place[part.node] < from) {
          place[part.node] = (int) columns.size();
          columns.push_back(part.node);
          values.resize(values.size() + ww, 0.0);
        }
        double *const to = values.data() + (std::size_t) place[part.node] * ww;
        for (int ab = 0; ab < ww; ab++) to[ab] += part.weight * block[ab];
      }
    });
    row_of.push_back(columns.size());
    for (const auto &part : P.of(row + begin())) children_of[part.node + 1]++;
  }
  for (int node = 0; node < next; node++) children_of[node + 1] += children_of[node];
  std::vector<CoarseParts::Part> children(children_of.back());
  auto at = children_of;
  for (int row = 0; row < n; row++)
    for (const auto &part : P.of(row + begin())) children[at[part.node]++] = {row, part.weight};

  // P^T of it

  std::vector<MatrixBlock> lower;
  std::vector<int64_t> block_of(next, -1);
  for (int node = 0; node < next; node++) {
    const int64_t from = lower.size();
    for (int child = children_of[node]; child < children_of[node + 1]; child++)
      for (int64_t k = row_of[children[child].node]; k < row_of[children[child].node + 1]; k++) {
        if (columns[k] > node) continue;
        if (block_of[columns[k]] < from) {
          block_of[columns[k]] = (int64_t) lower.size();
          lower.push_back({node, columns[k], {}});
        }
        double *const to = lower[block_of[columns[k]]].value;
        for (int ab = 0; ab < ww; ab++)
          to[ab] += children[child].weight * values[(std::size_t) k * ww + ab];
      }
  }
  return lower;
}

BlockRows::Sparse BlockRows::matrix() const
{
  const int n = rows(), w = width;
  std::vector<int> mine;
  for (std::size_t row = 0; row + 1 < start.size(); row++)
    mine.push_back((int) (start[row + 1] - start[row]));
  const auto sizes = ranks->gather(mine), columns = ranks->gather(column);
  const auto values = ranks->gather(value);
  Sparse A(n * w, n * w);
  A.resizeNonZeros((Eigen::Index) values.size());
  int *outer = A.outerIndexPtr(), *inner = A.innerIndexPtr();
  double *entry = A.valuePtr();
  std::size_t k = 0;
  for (int row = 0; row < n; k += sizes[row++])
    for (int a = 0; a < w; a++) {
      *outer++ = (int) (inner - A.innerIndexPtr());
      for (std::size_t i = k; i < k + sizes[row]; i++)
        for (int b = 0; b < w; b++) {
          *inner++ = columns[i] * w + b;
          *entry++ = values[(i * w + a) * w + b];
        }
    }
  *outer = (int) values.size();
  return A;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BLOCK_LIST_H
#define MPM_SOLVE_BLOCK_LIST_H

#include "solve/block_rows.h"
#include "solve/bytes_of.h"
#include "solve/lattice_nodes.h"
#include "solve/lattice_ranks.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace MPM_NS {
/** A number at random that depends on the place alone. */
inline double place_noise(const LatticeIndex &index, int a)
{
  uint64_t seed = lattice_key(index) + 77 * a;
  for (int k = 0; k < 3; k++) {
    seed ^= seed >> 29;
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  }
  return (double) (seed >> 33) / (1u << 30) - 1.0;
}

/** A block of a node. */
using NodeBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

/** Inverse of a symmetric matrix; directions without stiffness have a little. */
inline NodeBlock inverse_of(const NodeBlock &A)
{
  const double scale = A.trace() / A.rows();
  Eigen::SelfAdjointEigenSolver<NodeBlock> modes(A);
  Eigen::VectorXd values = modes.eigenvalues();
  for (int a = 0; a < values.size(); a++) values[a] = 1.0 / std::max(values[a], 1.0e-6 * scale);
  return modes.eigenvectors() * values.asDiagonal() * modes.eigenvectors().transpose();
}
/** A value [width] of a node. */
struct NodeValue {
  int node;
  double value[3];
};

/** Blocks in the order in which they came. A row has some ten of them, which are looked through. */
struct BlockList {
  std::vector<MatrixBlock> list;

  MatrixBlock &at(int row, int column)
  {
    if (row >= (int) rows.size()) rows.resize(row + 1);
    for (const auto &[other, k] : rows[row])
      if (other == column) return list[k];
    rows[row].emplace_back(column, (int) list.size());
    list.push_back({row, column, {}});
    return list.back();
  }
  /** Adds a block to the one at its place. */
  void add(const MatrixBlock &block, int width)
  {
    double *const to = at(block.row, block.column).value;
    for (int ab = 0; ab < width * width; ab++) to[ab] += block.value[ab];
  }
  /** The same for K [width][width] at any place, in the lower triangle. */
  void add_lower(int row, int column, const double *K, int width)
  {
    const bool lower = row >= column;
    double *const to = (lower ? at(row, column) : at(column, row)).value;
    for (int a = 0; a < width; a++)
      for (int b = 0; b < width; b++)
        to[a * width + b] += lower ? K[a * width + b] : K[b * width + a];
  }
  /** c b b^T of the values b [width] of nodes, the lower triangle. */
  void add_products(const NodeValue *begin, const NodeValue *end, double c, int width)
  {
    for (const NodeValue *row = begin; row < end; row++) {
      if (row->node >= (int) rows.size()) rows.resize(row->node + 1);
      if (rows.size() > place.size()) place.resize(rows.size(), -1);
      auto &columns = rows[row->node];
      for (const auto &[column, k] : columns) place[column] = k;
      for (const NodeValue *column = begin; column < end; column++) {
        if (column->node > row->node) continue;
        int &k = place[column->node];
        if (k < 0) {
          k = (int) list.size();
          columns.emplace_back(column->node, k);
          list.push_back({row->node, column->node, {}});
        }
        double *const to = list[k].value;
        for (int a = 0; a < width; a++)
          for (int b = 0; b < width; b++) to[a * width + b] += c * row->value[a] * column->value[b];
      }
      for (const auto &[column, k] : columns) place[column] = -1;
    }
  }
  /** The same blocks, without values. */
  void zero()
  {
    for (auto &block : list) std::fill_n(block.value, 9, 0.0);
  }
  double memory_usage() const
  {
    double bytes = bytes_of(list, rows, place);
    for (const auto &row : rows) bytes += bytes_of(row);
    return bytes;
  }

 private:
  std::vector<std::vector<std::pair<int, int>>> rows;    // columns, and places in the list
  std::vector<int> place;                                // of the columns of a row, -1: none
};

/** Means around nodes of which several ranks may have a part: sums that make their stiffness, and
 *  values of nodes, one mean after the other. */
struct MeanTerms {
  struct Head {
    uint64_t around;
    int kind, count;    // count: of values
    double sums[3];
  };
  std::vector<Head> heads;
  std::vector<NodeValue> values;

  void clear()
  {
    heads.clear();
    values.clear();
  }
  /** Calls f(begin, end, c) with the values of all ranks for each mean that no rank before this one
   *  has a part in. Collective. */
  template <class F> void each_of_all(LatticeRanks &ranks, const F &f) const
  {
    const auto counts = ranks.gather(std::vector<int>{(int) heads.size()});
    const auto all = ranks.gather(heads);
    const auto values_of_all = ranks.gather(values);
    struct Part {
      int head, rank;
      std::size_t first;
    };
    std::vector<Part> parts;
    std::size_t first = 0;
    for (int p = 0; p < (int) counts.size(); p++)
      for (int k = 0; k < counts[p]; k++) {
        parts.push_back({(int) parts.size(), p, first});
        first += all[parts.back().head].count;
      }
    const auto before = [&](const Part &a, const Part &b) {
      const Head &x = all[a.head], &y = all[b.head];
      return x.around != y.around ? x.around < y.around : x.kind < y.kind;
    };
    std::stable_sort(parts.begin(), parts.end(), before);
    std::vector<NodeValue> joined;
    for (std::size_t begin = 0, end; begin < parts.size(); begin = end) {
      for (end = begin + 1; end < parts.size() && !before(parts[begin], parts[end]);) end++;
      if (parts[begin].rank != ranks.me()) continue;
      double sums[3] = {0.0, 0.0, 0.0};
      joined.clear();
      for (std::size_t k = begin; k < end; k++) {
        const Head &head = all[parts[k].head];
        for (int i = 0; i < 3; i++) sums[i] += head.sums[i];
        for (int i = 0; i < head.count; i++) {
          const NodeValue &value = values_of_all[parts[k].first + i];
          auto found = k == begin
              ? joined.end()
              : std::find_if(joined.begin(), joined.end(), [&](const NodeValue &other) {
                  return other.node == value.node;
                });
          if (found == joined.end())
            joined.push_back(value);
          else
            for (int a = 0; a < 3; a++) found->value[a] += value.value[a];
        }
      }
      if (sums[0] > 0.0 && sums[1] > 0.0 && sums[2] > 0.0)
        f(joined.data(), joined.data() + joined.size(), sums[0] / (sums[1] * sums[2]));
    }
  }
  double memory_usage() const { return bytes_of(heads, values); }
};

}    // namespace MPM_NS
#endif

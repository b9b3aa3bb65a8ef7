/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/fine_smoother.h"

#include "solve/chebyshev.h"

#include <algorithm>

using namespace MPM_NS;

FineSmoother::FineSmoother(const NodeConstraints &nodes, LatticeRanks &ranks) :
    nodes(nodes), ranks(ranks), number(nodes.grid.nnodes(), -1),
    inverse(nodes.grid.nnodes() * nodes.width * nodes.width, 0.0), factors(&ranks)
{
}

void FineSmoother::find_rim(const LatticeNodes &everywhere, const std::vector<char> &in_rim,
                            const std::vector<char> &exists)
{
  const auto &grid = nodes.grid;
  const int w = nodes.width, dim = grid.lattice.dim;
  for (std::size_t k = 0; k < in_rim.size(); k++)
    if (in_rim[k]) rim.add(everywhere.index[k]);
  std::vector<LatticeIndex> others;
  for (const auto &tie : nodes.ties) others.push_back(tie.other);
  for (const auto &index : ranks.gather(others))
    if (everywhere.find(index) >= 0) rim.add(index);
  factors.start(rim.index, dim, w);
  std::vector<int> list;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const auto found = exists[node] ? rim.number.find(lattice_key(nodes.index_of(node)))
                                    : rim.number.end();
    if (found == rim.number.end()) continue;
    number[node] = found->second;
    if (!grid.owns(node)) continue;
    owned.push_back(node);
    list.push_back(found->second);
  }
  all_numbers = ranks.gather(list);
  std::vector<MatrixBlock> mine_tied;
  for (const auto &tie : nodes.ties) {
    const int other = rim.find(tie.other);
    if (!grid.owns(tie.node) || number[tie.node] < 0 || other < 0) continue;
    mine_tied.push_back({number[tie.node], other, {}});
    std::copy_n(tie.P, w * w, mine_tied.back().value);
  }
  rim_ties = ranks.gather(mine_tied);
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    if (number[node] >= 0 && !nodes.plain[node])
      nodes.each_source(node, [&](const LatticeIndex &index, const double *P) {
        const int at = nodes.tied[node] ? rim.find(index) : number[node];
        if (at < 0) return;
        parts.parts.push_back({at, {}});
        std::copy_n(P, w * w, parts.parts.back().W);
      });
    parts.end_row();
  }
}

void FineSmoother::set_block(int64_t node, const NodeBlock &D, double scale)
{
  const int w = nodes.width;
  if (nodes.plain[node]) {
    if (number[node] < 0)
      Eigen::Map<NodeBlock>(inverse.data() + node * w * w, w, w) = inverse_of(D);
    return;
  }
  if (number[node] >= 0) {
    if (nodes.grid.owns(node))
      parts.each_fixed(w, node, number[node], scale, [&](const MatrixBlock &block) {
        fixed.push_back(block);
      });
    return;
  }
  const NodeBlock P = Eigen::Map<const NodeBlock>(nodes.projection_of(node), w, w);
  const NodeBlock rest = NodeBlock::Identity(w, w) - P,
                  fixed_part = scale * rest.transpose() * rest;
  const NodeBlock free = P.transpose() * D * P + fixed_part;
  const NodeBlock inverted = P * inverse_of(free) * P.transpose();
  Eigen::Map<NodeBlock>(inverse.data() + node * w * w, w, w) = inverted;
}

bool FineSmoother::factorize(const double *mass)
{
  const int w = nodes.width;
  for (const int64_t node : owned) {
    const int k = number[node];
    auto &to = blocks.at(k, k);
    if (!mass) continue;
    if (nodes.plain[node])
      for (int a = 0; a < w; a++) to.value[a * w + a] += mass[node];
    else
      parts.each_pair(node, [&](const auto &i, const auto &j) {
        if (factors.together(i.node, j.node))
          add_product(w, i.W, j.W, mass[node], blocks.at(i.node, j.node).value);
      });
  }
  const auto add_known = [&](const MatrixBlock &block) {
    if (factors.together(block.row, block.column)) blocks.add(block, w);
  };
  for (const auto &block : fixed) add_known(block);
  means.each_of_all(ranks, [&](const NodeValue *begin, const NodeValue *end, double c) {
    BlockList more;
    more.add_products(begin, end, c, w);
    for (const auto &block : more.list) add_known(block);
  });
  means.clear();
  const auto gathered = ranks.gather(blocks.list);
  blocks = {};
  for (const auto &b : gathered) factors.add(b.row, b.column, b.value);
  const bool usable = factors.factorize();
  rim_b.resize(rim.index.size() * w);
  rim_x.resize(rim.index.size() * w);
  return usable;
}

void FineSmoother::apply(const double *r, double *z)
{
  const int w = nodes.width;
  const auto &grid = nodes.grid;
  for (int64_t node = 0; node < grid.nnodes(); node++)
    for (int a = 0; a < w; a++) {
      double sum = 0.0;
      for (int b = 0; b < w; b++) sum += inverse[(node * w + a) * w + b] * r[node * w + b];
      z[node * w + a] = sum;
    }
  if (rim.index.empty()) return;
  partial.resize(owned.size() * w);
  for (std::size_t k = 0; k < owned.size(); k++)
    if (nodes.tied[owned[k]])
      std::copy_n(r + owned[k] * w, w, partial.data() + k * w);
    else
      nodes.project(owned[k], r + owned[k] * w, true, partial.data() + k * w);
  ranks.gather(partial, gathered);
  for (std::size_t k = 0; k < all_numbers.size(); k++)
    for (int a = 0; a < w; a++) rim_b[all_numbers[k] * w + a] = gathered[k * w + a];
  apply_constraints(w, rim_ties, true, rim_b);
  factors.solve(rim_b.data(), rim_x.data());
  apply_constraints(w, rim_ties, false, rim_x);
  for (int64_t node = 0; node < grid.nnodes(); node++)
    if (number[node] >= 0 && nodes.tied[node])
      std::copy_n(rim_x.data() + number[node] * w, w, z + node * w);
    else if (number[node] >= 0)
      nodes.project(node, rim_x.data() + number[node] * w, false, z + node * w);
}

void FineSmoother::estimate_largest(LinearSystem &system)
{
  const int64_t n = nodes.grid.nnodes() * nodes.width;
  std::vector<double> start(n);
  for (int64_t i = 0; i < n; i++)
    start[i] = place_noise(nodes.index_of(i / nodes.width), i % nodes.width);
  largest = largest_eigenvalue_of(
      n, std::move(start),
      [&](const double *x, double *y) {
        system.apply(x, y);
      },
      [&](const double *x, double *y) {
        apply(x, y);
      },
      [&](const double *x, const double *y) {
        return system.product(x, y);
      });
}

void FineSmoother::smooth(LinearSystem &system, const double *r, double *z, bool from_zero)
{
  chebyshev(
      nodes.grid.nnodes() * nodes.width, largest, r, z, from_zero, work,
      [&](const double *x, double *y) {
        system.apply(x, y);
      },
      [&](const double *x, double *y) {
        apply(x, y);
      });
}

double FineSmoother::memory_usage() const
{
  return factors.memory_usage() + blocks.memory_usage() + means.memory_usage() +
      parts.memory_usage() + rim.memory_usage() +
      bytes_of(rim_ties, fixed, owned, number, all_numbers, inverse, rim_x, rim_b, partial,
               gathered, work[0], work[1], work[2]);
}

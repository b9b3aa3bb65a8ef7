/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "solve/coarse_levels.h"

#include "solve/block_list.h"
#include "solve/chebyshev.h"
#include "solve/spline_transfer.h"

#include <algorithm>
#include <numeric>
#include <utility>

using namespace MPM_NS;

void CoarseLevels::build(LatticeNodes level, std::vector<int> rows, const int *period,
                         std::vector<MatrixBlock> sent)
{
  int cells[3];
  std::copy_n(period, 3, cells);
  all.emplace_back();
  while (true) {
    auto &now = all.back();
    now.A.assemble(ranks, width, rows, sent);
    std::vector<MatrixBlock>().swap(sent);
    const int nodes = now.A.rows();
    now.x.resize((std::size_t) nodes * width);
    now.b.resize((std::size_t) nodes * width);

    // the nodes of the next level belong to those who have the first of their parts
    int half[3];
    for (int d = 0; d < 3; d++) half[d] = (cells[d] + 1) / 2;
    LatticeNodes next;
    std::vector<int> next_rows{0};
    if (nodes * width > few)
      for (int p = 0; p < ranks.number(); p++) {
        for (int k = rows[p]; k < rows[p + 1]; k++) {
          each_parent(order, dim, level.index[k], half,
                      [&](const LatticeIndex &parent, double weight) {
                        now.to_next.parts.push_back({next.add(parent), weight});
                      });
          now.to_next.end_row();
        }
        next_rows.push_back((int) next.index.size());
      }
    if (nodes * width <= few || (int) next.index.size() >= nodes) {
      last = now.A.matrix();
      now.A = {};
      return;
    }
    make_smoother(now, level, cells);
    sent = now.A.coarsened(now.to_next, (int) next.index.size());
    all.emplace_back();
    level = std::move(next);
    rows = std::move(next_rows);
    std::copy_n(half, 3, cells);
  }
}

/** The blocks of nodes and of chunks of the rim of an assembled level. */
void CoarseLevels::make_smoother(Level &level, const LatticeNodes &nodes, const int *cells)
{
  const int w = width, ww = w * w, nnodes = nodes.index.size();
  auto &A = level.A;
  std::vector<double> own;
  for (int node = A.begin(); node < A.end(); node++) {
    const double *const D = A.find(node, node);
    own.push_back(0.0);
    for (int a = 0; D && a < w; a++) own.back() += D[a * w + a];
  }
  const auto in_rim = rim_of(nodes, A.gather_rows(own, 1), dim, order + 1, cells);
  std::vector<int> number(nnodes, -1);
  std::vector<LatticeIndex> rim_nodes;
  for (int node = 0; node < nnodes; node++)
    if (in_rim[node]) {
      number[node] = rim_nodes.size();
      rim_nodes.push_back(nodes.index[node]);
      level.rim.push_back(node);
    }
  level.rim_factors.reset(new RimFactors(&ranks));
  level.rim_factors->start(rim_nodes, dim, w);
  own.assign((std::size_t)(A.end() - A.begin()) * ww, 0.0);
  std::vector<MatrixBlock> of_rim;
  for (int node = A.begin(); node < A.end(); node++) {
    if (const double *const D = A.find(node, node); D && number[node] < 0) {
      const NodeBlock given = Eigen::Map<const NodeBlock>(D, w, w);
      if (given.trace() > 0.0)
        Eigen::Map<NodeBlock>(own.data() + (std::size_t)(node - A.begin()) * ww, w, w) =
            inverse_of(given);
    }
    if (number[node] < 0) continue;
    A.each(node, [&](int other, const double *value) {
      if (other > node || number[other] < 0 ||
          !level.rim_factors->together(number[node], number[other]))
        return;
      of_rim.push_back({number[node], number[other], {}});
      std::copy_n(value, ww, of_rim.back().value);
    });
  }
  level.inverse = A.gather_rows(own, ww);
  for (const auto &b : ranks.gather(of_rim)) level.rim_factors->add(b.row, b.column, b.value);
  usable = level.rim_factors->factorize() && usable;
  if (!usable) return;
  level.rim_b.resize(level.rim.size() * w);
  level.rim_x.resize(level.rim.size() * w);

  const int64_t n = (int64_t) nnodes * w;
  std::vector<double> start(n);
  for (int64_t i = 0; i < n; i++) start[i] = place_noise(nodes.index[i / w], i % w);
  level.largest = largest_eigenvalue_of(
      n, std::move(start),
      [&](const double *x, double *y) {
        A.multiply(x, y);
      },
      [&](const double *x, double *y) {
        level.apply(w, x, y);
      },
      [&](const double *x, const double *y) {
        return std::inner_product(x, x + n, y, 0.0);
      });
}

void CoarseLevels::Level::apply(int w, const double *r, double *z)
{
  const int n = A.rows() * w;
  for (int i = 0; i < n; i++) {
    double sum = 0.0;
    const int node = i / w;
    for (int b = 0; b < w; b++) sum += inverse[(std::size_t) i * w + b] * r[node * w + b];
    z[i] = sum;
  }
  if (rim.empty()) return;
  for (std::size_t k = 0; k < rim.size(); k++) std::copy_n(r + rim[k] * w, w, rim_b.data() + k * w);
  rim_factors->solve(rim_b.data(), rim_x.data());
  for (std::size_t k = 0; k < rim.size(); k++) std::copy_n(rim_x.data() + k * w, w, z + rim[k] * w);
}

bool CoarseLevels::factorize()
{
  usable = usable && factorize_rows(last, factors);
  last = BlockRows::Sparse();
  return usable;
}

/** x of a coarse level from its b. */
void CoarseLevels::cycle(std::size_t which)
{
  auto &level = all[which];
  if (which + 1 == all.size()) {
    if (!level.b.empty()) factors.solve(level.b.data(), level.x.data());
    return;
  }
  const auto smooth_level = [&](bool from_zero) {
    chebyshev(
        level.b.size(), level.largest, level.b.data(), level.x.data(), from_zero, level.work,
        [&](const double *x, double *y) {
          level.A.multiply(x, y);
        },
        [&](const double *x, double *y) {
          level.apply(width, x, y);
        });
  };
  auto &next = all[which + 1];
  std::fill(level.x.begin(), level.x.end(), 0.0);
  smooth_level(true);
  auto &rest = level.work[0];
  level.A.multiply(level.x.data(), rest.data());
  std::fill(next.b.begin(), next.b.end(), 0.0);
  const int w = width;
  for (int node = 0; node < level.A.rows(); node++)
    for (const auto &part : level.to_next.of(node))
      for (int a = 0; a < w; a++)
        next.b[part.node * w + a] += part.weight * (level.b[node * w + a] - rest[node * w + a]);
  cycle(which + 1);
  for (int node = 0; node < level.A.rows(); node++)
    for (const auto &part : level.to_next.of(node))
      for (int a = 0; a < w; a++) level.x[node * w + a] += part.weight * next.x[part.node * w + a];
  smooth_level(false);
}

double CoarseLevels::memory_usage() const
{
  double bytes = factors.memory_usage();
  for (const auto &level : all) {
    bytes += level.A.memory_usage() + level.to_next.memory_usage() +
        bytes_of(level.x, level.b, level.rim, level.inverse, level.work[0], level.work[1],
                 level.work[2], level.rim_b, level.rim_x);
    if (level.rim_factors) bytes += level.rim_factors->memory_usage();
  }
  return bytes;
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// What ranks share of the levels of a multigrid: rows of matrices, and chunks of surfaces.

#include "thread_ranks.h"

#include "solve/block_rows.h"
#include "solve/rim_factors.h"

#include "gtest/gtest.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace MPM_NS;

/** Blocks that rank me of n gives, some to rows of others, some of a place that it has given. */
std::vector<MatrixBlock> blocks_of(int me, int n, int rows, int width)
{
  std::vector<MatrixBlock> list;
  for (int row = 0; row < rows; row++)
    for (int column = 0; column <= row; column++)
      for (int part = 0; part < 2; part++) {
        if ((row * 7 + column * 3 + part) % n != me || (row + 2 * column) % 4 == 1) continue;
        list.push_back({row, column, {}});
        for (int a = 0; a < width; a++)
          for (int b = 0; b < width; b++)
            list.back().value[a * width + b] = row == column
                ? 3.0 + (a == b)
                : std::sin(1.0 + row + 2.0 * column + 0.3 * a + 0.7 * b + part);
      }
  return list;
}

Eigen::MatrixXd dense(const std::vector<std::vector<MatrixBlock>> &lists, int rows, int width)
{
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows * width, rows * width);
  for (const auto &list : lists)
    for (const auto &block : list)
      for (int a = 0; a < width; a++)
        for (int b = 0; b < width; b++) {
          const int i = block.row * width + a, j = block.column * width + b;
          A(i, j) += block.value[a * width + b];
          if (block.row != block.column) A(j, i) += block.value[a * width + b];
        }
  return A;
}

// Products, blocks, the next level, and the matrix on ranks, one without rows: the dense matrix.
TEST(BlockRows, AreThoseOfTheMatrix)
{
  constexpr int ROWS = 13, NEXT = 5;
  CoarseParts P;
  for (int row = 0; row < ROWS; row++) {
    P.parts.push_back({row / 3, 0.75});
    if (row % 2) P.parts.push_back({(row / 3 + 2) % NEXT, 0.25});
    P.end_row();
  }
  for (const int width : {1, 2, 3})
    for (const auto &first : {std::vector<int>{0, 13}, {0, 6, 13}, {0, 5, 5, 13}}) {
      const int nranks = (int) first.size() - 1;
      std::vector<std::vector<MatrixBlock>> given;
      for (int me = 0; me < nranks; me++) given.push_back(blocks_of(me, nranks, ROWS, width));
      const Eigen::MatrixXd A = dense(given, ROWS, width);
      Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(ROWS * width, NEXT * width);
      for (int row = 0; row < ROWS; row++)
        for (const auto &part : P.of(row))
          for (int a = 0; a < width; a++)
            parts(row * width + a, part.node * width + a) = part.weight;
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(ROWS * width, -1.0, 2.0);
      std::vector<Eigen::VectorXd> product(nranks, x);
      std::vector<Eigen::MatrixXd> matrix(nranks);
      std::vector<std::vector<MatrixBlock>> next(nranks);
      std::vector<double> wrong(nranks, 0.0), bytes(nranks);
      on_ranks(nranks, [&](ThreadRank &rank) {
        const int me = rank.me();
        BlockRows rows;
        rows.assemble(rank, width, first, given[me]);
        rows.multiply(x.data(), product[me].data());
        matrix[me] = rows.matrix();
        next[me] = rows.coarsened(P, NEXT);
        bytes[me] = rows.memory_usage();
        for (int row = rows.begin(); row < rows.end(); row++)
          for (int column = 0; column < ROWS; column++) {
            const double *const block = rows.find(row, column);
            for (int a = 0; a < width; a++)
              for (int b = 0; b < width; b++)
                wrong[me] = std::max(wrong[me],
                                     std::abs((block ? block[a * width + b] : 0.0) -
                                              A(row * width + a, column * width + b)));
          }
      });
      double all_bytes = 0.0;
      for (int me = 0; me < nranks; me++) {
        EXPECT_LT(wrong[me], 1e-14);
        EXPECT_LT((product[me] - A * x).norm(), 1e-13 * (A * x).norm());
        EXPECT_EQ((product[me] - product[0]).norm(), 0.0);
        EXPECT_LT((matrix[me] - A).norm(), 1e-14 * A.norm());
        EXPECT_EQ((matrix[me] - matrix[me].transpose()).norm(), 0.0);
        all_bytes += bytes[me];
      }
      // each has its own rows
      if (nranks == 2) EXPECT_LT(bytes[0], 0.6 * all_bytes);
      const Eigen::MatrixXd expected = parts.transpose() * A * parts;
      EXPECT_LT((dense(next, NEXT, width) - expected).norm(), 1e-13 * expected.norm());
    }
}

// A surface of many chunks, or of one: ranks have a part each, and the sums are those of one rank.
TEST(RimFactors, AreTheSameOnRanks)
{
  for (const int n : {12, 70}) {
    // a cube's surface, three nodes thick, with springs between neighbors
    std::vector<LatticeIndex> nodes;
    LatticeNodes all;
    const auto inside = [n](int i) {
      return i >= 3 && i < n - 3;
    };
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        for (int k = 0; k < 12; k++)
          if (!(inside(i) && inside(j) && k >= 3 && k < 9)) nodes.push_back({i, j, k});
    for (const auto &index : nodes) all.add(index);
    constexpr int W = 2;
    const auto solution_of = [&](LatticeRanks *ranks, bool good, double *bytes) {
      RimFactors factors(ranks);
      factors.start(nodes, 3, W);
      for (int node = 0; node < (int) nodes.size(); node++) {
        const double cross = good || node > 0 ? 0.5 : std::numeric_limits<double>::quiet_NaN();
        const double own[] = {7.0, cross, cross, 8.0};
        factors.add(node, node, own);
        for (int d = 0; d < 3; d++) {
          auto next = nodes[node];
          next[d]--;
          const int other = all.find(next);
          const double value[] = {-1.0, 0.1 * d, -0.2, -1.0};
          if (other >= 0 && factors.together(node, other)) factors.add(node, other, value);
        }
      }
      std::vector<double> x;
      if (factors.factorize() != good) return x;
      if (!good) return std::vector<double>{1.0};
      std::vector<double> b;
      for (std::size_t i = 0; i < nodes.size() * W; i++) b.push_back(std::sin(0.1 * i));
      x.resize(b.size());
      factors.solve(b.data(), x.data());
      if (bytes) *bytes = factors.memory_usage();
      return x;
    };
    double bytes_of_one = 0.0;
    const auto one = solution_of(nullptr, true, &bytes_of_one);
    ASSERT_FALSE(one.empty());
    const Eigen::Map<const Eigen::VectorXd> expected(one.data(), one.size());
    for (const int nranks : {2, 3}) {
      std::vector<std::vector<double>> of_rank(nranks), bad(nranks);
      std::vector<double> bytes(nranks);
      on_ranks(nranks, [&](ThreadRank &rank) {
        of_rank[rank.me()] = solution_of(&rank, true, &bytes[rank.me()]);
        // what is no number in one chunk is told by all ranks
        bad[rank.me()] = solution_of(&rank, false, nullptr);
      });
      for (int me = 0; me < nranks; me++) {
        ASSERT_EQ(of_rank[me].size(), one.size());
        const Eigen::Map<const Eigen::VectorXd> x(of_rank[me].data(), one.size());
        EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm());
        EXPECT_EQ(of_rank[me], of_rank[0]);
        EXPECT_EQ(bad[me].size(), 1u);
        if (n == 70) EXPECT_LT(bytes[me], (nranks == 2 ? 0.65 : 0.5) * bytes_of_one);
      }
    }
  }
}

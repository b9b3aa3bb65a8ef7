// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The matrix between nodes of a lattice: its products against the sums over points that it stands
// for, G K (G^T x), with points anywhere in blocks, at their sides, and where blocks are missing.

#include "solve/node_matrix.h"

#include "gtest/gtest.h"

#include <cmath>
#include <random>

using namespace MPM_NS;

class NodeMatrixOf : public ::testing::TestWithParam<std::pair<int, int>> {};

TEST_P(NodeMatrixOf, MultipliesAsTheSumOverPoints)
{
  const int dim = GetParam().first, reach = GetParam().second;
  Lattice lattice;
  lattice.dim = dim;
  lattice.h = 0.5;
  for (int d = 0; d < 3; d++) {
    lattice.origin[d] = 0.0;
    lattice.periodic[d] = false;
    lattice.ncell[d] = 1;
  }
  Grid grid(lattice);
  const auto activate = [&](int x, int y, int z) {
    const int b[3] = {x, y, dim == 3 ? z : 0};
    grid.activate(b);
  };
  for (int x = -1; x < 2; x++)
    for (int y = 0; y < 2; y++)
      for (int z = -1; z < 1; z++)
        if (x < 1 || y < 1) activate(x, y, z);
  activate(9, 9, 9);    // far from all points
  grid.finish();

  std::mt19937 random(7 * dim + reach);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto numbers = [&](std::size_t n) {
    std::vector<double> list(n);
    for (double &v : list) v = number(random);
    return list;
  };
  const auto x = numbers(grid.nnodes());
  std::vector<double> expected(grid.nnodes(), 0.0), diagonal(expected), found(grid.nnodes(), 99.0);
  NodeMatrix matrix;
  for (int again = 0; again < 2; again++) {    // the second matrix has nothing of the first one
    std::fill(expected.begin(), expected.end(), 0.0);
    std::fill(diagonal.begin(), diagonal.end(), 0.0);
    matrix.begin(grid, reach);
    for (int point = 0; point < 1000; point++) {
      std::uniform_int_distribution<int> any(-grid.side, 2 * grid.side - 1);
      const int first[3] = {any(random), any(random), dim == 3 ? any(random) : 0};
      std::vector<int64_t> nodes;
      bool all = true;    // are the blocks of all of its nodes there?
      for (int i = 0; i <= reach; i++)
        for (int j = 0; j <= reach; j++)
          for (int k = 0; k <= (dim == 3 ? reach : 0); k++) {
            const int index[3] = {first[0] + i, first[1] + j, first[2] + k};
            nodes.push_back(grid.locate(index));
            all = all && nodes.back() >= 0;
          }
      if (!all) continue;
      const int n = (int) nodes.size(), npoint = 1 + point % 3;    // some with the same nodes
      for (int p = 0; p < npoint; p++) {
        auto G = numbers((std::size_t) n * dim);
        const auto K = numbers(dim * dim);
        for (int d = 0; d < dim; d++) {
          double sum = 0.0;
          for (int i = 0; i < n; i++) sum += G[dim * i + d];
          for (int i = 0; i < n; i++) G[dim * i + d] -= sum / n;
        }
        matrix.add_point(n, nodes.data(), dim, G.data(), K.data());
        double gradient[3] = {}, flux[3] = {};
        for (int i = 0; i < n; i++)
          for (int d = 0; d < dim; d++) gradient[d] += G[dim * i + d] * x[nodes[i]];
        for (int d = 0; d < dim; d++)
          for (int e = 0; e < dim; e++) flux[d] += K[dim * d + e] * gradient[e];
        for (int i = 0; i < n; i++)
          for (int d = 0; d < dim; d++) {
            expected[nodes[i]] += G[dim * i + d] * flux[d];
            for (int e = 0; e < dim; e++)
              diagonal[nodes[i]] += G[dim * i + d] * K[dim * d + e] * G[dim * i + e];
          }
      }
    }
    matrix.finish();
    matrix.multiply(x.data(), found.data());
    double largest = 0.0;
    for (double v : expected) largest = std::max(largest, std::fabs(v));
    EXPECT_GT(largest, 1.0);
    for (std::size_t k = 0; k < found.size(); k++) {
      EXPECT_NEAR(found[k], expected[k], 1.0e-13 * largest);
      EXPECT_NEAR(matrix.diagonal(k), diagonal[k], 1.0e-13 * largest);
    }
    // nothing flows where all values are the same
    matrix.multiply(std::vector<double>(grid.nnodes(), 1.0 / 3.0).data(), found.data());
    for (const double v : found) EXPECT_EQ(v, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, NodeMatrixOf,
                         ::testing::Values(std::make_pair(2, 1), std::make_pair(2, 2),
                                           std::make_pair(2, 3), std::make_pair(3, 1),
                                           std::make_pair(3, 2), std::make_pair(3, 3)));

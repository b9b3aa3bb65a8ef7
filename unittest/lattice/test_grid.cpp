// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The block-sparse lattice alone: indices, neighbours, periodic images, memory.

#include "lattice/grid.h"

#include "gtest/gtest.h"

using namespace MPM_NS;

static Lattice make_lattice(int dim, int n, bool periodic)
{
  Lattice lattice;
  lattice.dim = dim;
  lattice.h = 0.5;
  for (int d = 0; d < 3; d++) {
    lattice.origin[d] = -1.0;
    lattice.periodic[d] = periodic && d < dim;
    lattice.ncell[d] = d < dim ? n : 1;
  }
  return lattice;
}

static int activate(Grid &grid, int x, int y, int z)
{
  const int b[3] = {x, y, z};
  return grid.activate(b);
}

TEST(Grid, NodeIndexAndLocateAreInverse)
{
  for (int dim : {2, 3}) {
    Grid grid(make_lattice(dim, 10, false));
    const int blocks[][3] = {{0, 0, 0}, {-1, 3, 0}, {-7, -2, 0}, {1000, -1000, 0}};
    for (auto &b : blocks) grid.activate(b);
    grid.finish();
    for (int slot = 0; slot < 4; slot++)
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        int index[3];
        grid.node_index(grid.blocks[slot], n, index);
        EXPECT_EQ(grid.locate(index), slot * NODES_PER_BLOCK + n);
      }
    const int elsewhere[3] = {500, 500, 0};
    EXPECT_EQ(grid.locate(elsewhere), -1);
  }
}

TEST(Grid, BlockKeyKeepsSignsAndCoordinates)
{
  Grid grid(make_lattice(3, 10, false));
  const int b[4][3] = {
      {-1048576, 1048575, -3}, {1048575, -1048576, -3}, {-1048576, 1048575, 3}, {-3, 1048575, -3}};
  for (int slot = 0; slot < 4; slot++) EXPECT_EQ(grid.activate(b[slot]), slot);
  for (int slot = 0; slot < 4; slot++)
    EXPECT_EQ(grid.find(Grid::block_key(grid.blocks[slot])), slot);
}

TEST(Grid, NeighbourTable)
{
  Grid grid(make_lattice(3, 10, false));
  for (int x = 0; x < 3; x++)
    for (int y = 0; y < 3; y++) activate(grid, x, y, 5);
  grid.finish();
  const int middle[3] = {1, 1, 5};
  const auto &block = grid.blocks[grid.find(middle)];
  for (int dx = -1; dx <= 1; dx++)
    for (int dy = -1; dy <= 1; dy++)
      for (int dz = -1; dz <= 1; dz++) {
        const int slot = block.slot[9 * (dx + 1) + 3 * (dy + 1) + dz + 1];
        if (dz) {
          EXPECT_EQ(slot, -1);
        } else {
          EXPECT_EQ(grid.blocks[slot].b[0], 1 + dx);
          EXPECT_EQ(grid.blocks[slot].b[1], 1 + dy);
        }
      }
}

// any number of cells along a period: multiples of the block side and not, fewer than a block
TEST(Grid, PeriodicImagesFoldOntoOneCanonicalNode)
{
  for (int dim : {2, 3})
    for (int n : {1, 2, 3, 5, 8, 11, 16}) {
      Grid grid(make_lattice(dim, n, true));
      const int nb = n / grid.side + 1;
      for (int x = -1; x <= nb; x++)
        for (int y = -1; y <= nb; y++)
          for (int z = -1; z <= nb; z++) activate(grid, x, y, dim == 3 ? z : 0);
      grid.close_periodic();
      grid.finish();
      grid.allocate(4);

      // each node gets 1: a canonical node must end with the number of its images
      for (int64_t k = 0; k < grid.nnodes(); k++) grid.nodes()[4 * k + 2] = 1.0;
      grid.fold_aliases(grid.nodes(), 4, 2, 1);
      const auto for_nodes = [&](const auto &act) {
        for (std::size_t s = 0; s < grid.blocks.size(); s++)
          for (int k = 0; k < NODES_PER_BLOCK; k++) act(s, k, grid.blocks[s].owned >> k & 1);
      };
      double total = 0.0;
      int64_t all_owned = 0;
      for_nodes([&](std::size_t s, int k, bool owned) {
        if (owned) total += grid.record(s, k)[2];
        all_owned += owned;
      });
      EXPECT_EQ(total, (double) grid.nnodes()) << "dim " << dim << " n " << n;
      // owned nodes are the nodes of one period, each once
      EXPECT_EQ(all_owned, dim == 3 ? n * n * n : n * n) << "dim " << dim << " n " << n;

      // and images get the canonical record back
      const auto canonical = [&](const auto &block, int k) {
        int index[3];
        grid.node_index(block, k, index);
        double value = 0.0;
        for (int d = 0; d < dim; d++) value = 100.0 * value + grid.lattice.wrap(d, index[d]);
        return value;
      };
      for_nodes([&](std::size_t s, int k, bool owned) {
        if (owned) grid.record(s, k)[0] = canonical(grid.blocks[s], k);
      });
      grid.copy_aliases();
      for_nodes([&](std::size_t s, int k, bool) {
        EXPECT_EQ(grid.record(s, k)[0], canonical(grid.blocks[s], k));
      });
      const std::vector<int64_t> itself = grid.canonical();
      for_nodes([&](std::size_t s, int k, bool) {
        const int64_t node = itself[s * NODES_PER_BLOCK + k];
        EXPECT_TRUE(grid.owns(node));
        EXPECT_EQ(grid.record(node)[0], canonical(grid.blocks[s], k));
      });
    }
}

TEST(Grid, NodesBetweenIndices)
{
  const int ranges[][2][3] = {{{0, 0, 0}, {7, 7, 7}},       {{-2, 1, 5}, {0, 3, 6}},
                              {{-9, -9, -9}, {20, 20, 20}}, {{2, -3, 1}, {2, 9, 1}},
                              {{3, 3, 3}, {2, 7, 7}},       {{40, 0, 0}, {50, 9, 9}}};
  for (int dim : {2, 3}) {
    Grid grid(make_lattice(dim, 10, false));
    for (int k = 0; k < 8; k++) activate(grid, k % 2, k / 2 % 2 - 1, dim == 3 ? k / 4 : 0);
    for (const auto &range : ranges)
      for (const auto &block : grid.blocks) {
        const uint64_t bits = grid.nodes_between(block, range[0], range[1]);
        for (int n = 0; n < NODES_PER_BLOCK; n++) {
          int index[3];
          grid.node_index(block, n, index);
          bool in = true;
          for (int d = 0; d < dim; d++)
            in = in && index[d] >= range[0][d] && index[d] <= range[1][d];
          EXPECT_EQ(bits >> n & 1, in) << dim << " " << n;
        }
      }
  }
}

// what points reach at an image they reach at the node that it is an image of
TEST(Grid, NodesAreReachedThroughImages)
{
  for (int dim : {2, 3}) {
    Grid grid(make_lattice(dim, 12, true));
    const int low[3] = {-1, -2, 3}, high[3] = {1, 0, 5};
    for (int k = 0; k < 8; k++) {
      const int slot = activate(grid, k % 2 - 1, k / 2 % 2 - 1, dim == 3 ? k / 4 : 0);
      grid.blocks[slot].reached = grid.nodes_between(grid.blocks[slot], low, high);
    }
    grid.close_periodic();
    grid.finish();
    int nodes = 0;
    for (const auto &block : grid.blocks)
      nodes += __builtin_popcountll(block.reached & ~block.alias);
    EXPECT_EQ(nodes, dim == 3 ? 27 : 9);
    const int image[3] = {-1, -2, dim == 3 ? 4 : 0}, node[3] = {11, 10, image[2]};
    for (const int *index : {image, node}) {
      const int64_t at = grid.locate(index);
      ASSERT_GE(at, 0);
      EXPECT_TRUE(grid.blocks[at / NODES_PER_BLOCK].reached >> (at % NODES_PER_BLOCK) & 1);
    }
  }
}

// images beyond the reach of points have no part in sums and copies
TEST(Grid, ImagesOutOfReachHaveNoPart)
{
  for (int dim : {2, 3}) {
    Grid grid(make_lattice(dim, 1, true));
    for (int x = -1; x <= 0; x++)
      for (int y = -1; y <= 0; y++)
        for (int z = -1; z <= 0; z++) activate(grid, x, y, dim == 3 ? z : 0);
    for (int d = 0; d < dim; d++) {
      grid.reach_low[d] = -2;
      grid.reach_high[d] = 1 + d;
    }
    grid.close_periodic();
    grid.finish();
    grid.allocate(4);
    const auto is_reached = [&](const auto &block, int k) {
      int index[3];
      grid.node_index(block, k, index);
      for (int d = 0; d < dim; d++)
        if (index[d] < -2 || index[d] > 1 + d) return false;
      return true;
    };
    const auto for_nodes = [&](const auto &act) {
      for (std::size_t s = 0; s < grid.blocks.size(); s++)
        for (int k = 0; k < NODES_PER_BLOCK; k++)
          act(grid.record(s, k), is_reached(grid.blocks[s], k), grid.blocks[s].owned >> k & 1);
    };

    int owned_nodes = 0;
    for_nodes([](double *record, bool, bool) {
      record[2] = 1.0;
    });
    grid.fold_aliases(grid.nodes(), 4, 2, 1);
    for_nodes([&](const double *record, bool, bool owned) {
      EXPECT_EQ(record[2], owned ? (dim == 3 ? 4 * 5 * 6 : 4 * 5) : 1.0);
      owned_nodes += owned;
    });
    EXPECT_EQ(owned_nodes, 1);
    for_nodes([](double *record, bool, bool owned) {
      record[0] = owned ? 7.0 : 0.0;
    });
    grid.copy_aliases();
    for_nodes([](const double *record, bool reached, bool) {
      EXPECT_EQ(record[0], reached ? 7.0 : 0.0);
    });
    grid.clear();
    EXPECT_LT(grid.reach_low[0], -1000000);
  }
}

TEST(Grid, MemoryFollowsBlocksNotTheBox)
{
  Grid small(make_lattice(3, 16, false)), large(make_lattice(3, 100000, false));
  for (auto *grid : {&small, &large}) {
    for (int x = 0; x < 10; x++) activate(*grid, x, 0, 0);
    grid->finish();
    grid->allocate(4);
  }
  EXPECT_EQ(small.memory_usage(), large.memory_usage());
}

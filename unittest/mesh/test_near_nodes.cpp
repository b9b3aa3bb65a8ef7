// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: unit

// Nodes that are near each other along a surface.

#include "mesh/near_nodes.h"

#include "gtest/gtest.h"

using namespace MPM_NS;

// a row of nodes that meets itself at one end: paths along it, not distances, and the shorter way where there are two
TEST(NearNodes, ByPaths)
{
  const NearNodes open(6, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 3, 1.0}, {3, 4, 1.0}, {4, 5, 1.0}}, 2.5);
  const NearNodes ring(
      6, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 3, 1.0}, {3, 4, 1.0}, {4, 5, 1.0}, {5, 0, 0.6}}, 2.5);
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) {
      EXPECT_EQ(open.near(i, j), std::abs(i - j) < 2.5) << i << j;
      EXPECT_EQ(open.near(i, j), open.near(j, i));
      const double one = std::abs(i - j), other = 5.6 - one;
      EXPECT_EQ(ring.near(i, j), std::min(one, other) < 2.5) << i << j;
    }
}

// a path of short steps beats one long edge; what is not joined is not near
TEST(NearNodes, ShortestPaths)
{
  const NearNodes nodes(5, {{0, 1, 3.0}, {0, 2, 0.5}, {2, 1, 0.5}, {3, 4, 0.1}}, 2.0);
  EXPECT_TRUE(nodes.near(0, 1));
  EXPECT_TRUE(nodes.near(3, 4));
  EXPECT_TRUE(nodes.near(2, 2));
  EXPECT_FALSE(nodes.near(1, 3));
  const NearNodes fine(5, {{0, 1, 0.3}, {1, 2, 0.3}, {2, 3, 0.3}, {3, 4, 0.3}}, 1.0);
  for (int i = 0; i < 5; i++) EXPECT_EQ(fine.near(0, i), i < 4);
  EXPECT_GT(nodes.memory(), 0.0);
}

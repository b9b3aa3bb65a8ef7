// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Nodes that are near each other along a surface, what fits between them, and what goes through.

#include "mesh/near_nodes.h"
#include "mesh/passages.h"
#include "mesh/triangle_gap.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace MPM_NS;

// a row of nodes that meets itself at one end: paths along it, not distances, the shorter of two
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

// the place in a triangle that is farthest from its corners, by a search and for known triangles
TEST(TriangleGap, FarthestFromCorners)
{
  EXPECT_NEAR(triangle_gap(1.0, 1.0, 1.0), 1.0 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(triangle_gap(3.0, 5.0, 4.0), 2.5, 1e-12);
  EXPECT_NEAR(triangle_gap(1.0, 1.0, 2.0), 0.5, 1e-12);
  EXPECT_NEAR(triangle_gap(1.0, 3.0, 2.0), 1.0, 1e-12);
  std::mt19937 random(1);
  for (int k = 0; k < 20; k++) {
    std::array<double, 2> x[3];
    for (auto &corner : x)
      for (double &c : corner) c = random() * 0x1p-32;
    const auto from = [&](int i, double px, double py) {
      return std::hypot(px - x[i][0], py - x[i][1]);
    };
    double farthest = 0.0;
    const int n = 400;
    for (int i = 0; i <= n; i++)
      for (int j = 0; j <= n - i; j++) {
        const double u = (double) i / n, v = (double) j / n;
        const double px = x[0][0] + u * (x[1][0] - x[0][0]) + v * (x[2][0] - x[0][0]),
                     py = x[0][1] + u * (x[1][1] - x[0][1]) + v * (x[2][1] - x[0][1]);
        farthest =
            std::max(farthest, std::min({from(0, px, py), from(1, px, py), from(2, px, py)}));
      }
    const double a = from(0, x[1][0], x[1][1]), b = from(1, x[2][0], x[2][1]),
                 c = from(2, x[0][0], x[0][1]);
    EXPECT_NEAR(triangle_gap(a, b, c), farthest, 0.005);
    EXPECT_EQ(triangle_gap(a, b, c), triangle_gap(b, c, a));
  }
}

// above, below, beyond an edge, within the margin, and too far away
TEST(Passages, SideOfAFace)
{
  const double p[3][3] = {{1, 1, 2}, {3, 1, 2}, {1, 3, 2}}, *const at[3] = {p[0], p[1], p[2]};
  const struct {
    double x[3];
    int side;
    bool within;
  } cases[] = {{{1.5, 1.5, 2.1}, 1, true},  {{1.5, 1.5, 1.9}, -1, true},
               {{1.5, 1.5, 2.3}, 0, true},  {{1.5, 0.9, 2.1}, 1, false},
               {{1.5, 0.7, 2.1}, 0, false}, {{2.05, 2.05, 1.9}, -1, false},
               {{2.4, 2.4, 1.9}, 0, false}, {{0.9, 2.0, 2.0}, 1, false}};
  for (const auto &c : cases) {
    bool within;
    EXPECT_EQ(side_of_face(3, at, c.x, 0.2, 0.1, within), c.side) << c.x[0] << " " << c.x[1];
    if (c.side) EXPECT_EQ(within, c.within) << c.x[0] << " " << c.x[1];
  }
  const double left[3] = {2, 1.1, 0}, right[3] = {2.9, 0.9, 0}, off[3] = {3.1, 1.1, 0};
  bool within;
  EXPECT_EQ(side_of_face(2, at, left, 0.2, 0.1, within), 1);
  EXPECT_EQ(side_of_face(2, at, right, 0.2, 0.1, within), -1);
  EXPECT_EQ(side_of_face(2, at, off, 0.2, 0.1, within), 1);
  EXPECT_FALSE(within);
}

// a change of side tells a passage, but not where a node was not seen, or stays beyond an edge
TEST(Passages, Looks)
{
  using Sight = Passages::Sight;
  Passages passages;
  EXPECT_EQ(passages.look({{5, 0, 2, 1, 1}, {4, 0, 2, 1, 0}, {5, 0, 3, 1, 0}}), nullptr);
  EXPECT_EQ(passages.look({{5, 0, 2, 1, 1}, {4, 0, 2, -1, 0}, {5, 1, 2, -1, 1}}), nullptr);
  EXPECT_EQ(passages.look({{6, 0, 2, -1, 1}}), nullptr);
  EXPECT_EQ(passages.look({{7, 0, 1, 1, 1}, {5, 0, 2, -1, 1}, {9, 0, 2, 1, 1}}), nullptr);
  const Sight *const found = passages.look({{9, 0, 2, -1, 0}, {5, 0, 2, -1, 1}});
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->node, 9);

  // what is known of faces that another rank has now goes there, and is found there
  const auto others = passages.take_others({{0, 1}, {0, 2}});
  EXPECT_TRUE(others.empty());
  const auto of_face_2 = passages.take_others({{0, 1}, {1, 2}});
  EXPECT_EQ(of_face_2.size(), 2u);
  Passages there;
  there.add(of_face_2);
  EXPECT_EQ(passages.look({{5, 0, 2, 1, 1}}), nullptr);
  EXPECT_NE(there.look({{5, 0, 2, 1, 1}}), nullptr);
}

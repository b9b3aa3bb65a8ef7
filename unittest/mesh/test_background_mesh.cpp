// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Meshes as the grid under points: cells of points, shape functions, sides, divided elements; and
// which nodes and faces of a surface are near.

#include "mesh/background_mesh.h"
#include "mesh/face_contact.h"
#include "mesh/near_nodes.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

using namespace MPM_NS;
using ::testing::HasSubstr;

/** n cells along each axis of a unit square or cube, distorted smoothly: kind 0: quadrangles or
 *  hexahedra, 1: each divided into triangles or tetrahedra. The side x = 0 is the group "left". */
Mesh block(int dim, int n, bool simplices, double distortion = 0.1)
{
  Mesh mesh;
  const auto number = [&](int i, int j, int k) {
    return (k * (n + 1) + j) * (n + 1) + i;
  };
  for (int k = 0; k <= (dim == 3 ? n : 0); k++)
    for (int j = 0; j <= n; j++)
      for (int i = 0; i <= n; i++) {
        const double x = (double) i / n, y = (double) j / n, z = (double) k / n;
        const double bump =
            distortion * sin(M_PI * x) * sin(M_PI * y) * (dim == 3 ? sin(M_PI * z) : 1.0);
        mesh.nodes.push_back({x + bump, y - bump, dim == 3 ? z + 0.5 * bump : 0.0});
      }
  int64_t label = 0;
  const auto add = [&](ElementType type, int physical, std::vector<int> node) {
    MeshElement e = {type, physical, ++label, {}};
    std::copy(node.begin(), node.end(), e.node);
    mesh.elements.push_back(e);
  };
  static const int tetrahedra[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                       {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int k = 0; k < (dim == 3 ? n : 1); k++)
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) {
        const std::vector<int> q = {number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k),
                                    number(i, j + 1, k)};
        if (dim == 2) {
          if (simplices) {
            add(ElementType::TRIANGLE, 1, {q[0], q[1], q[2]});
            add(ElementType::TRIANGLE, 1, {q[0], q[2], q[3]});
          } else
            add(ElementType::QUAD, 1, q);
          if (i == 0) add(ElementType::LINE, 2, {q[0], q[3]});
          continue;
        }
        std::vector<int> h = q;
        for (const int node : q) h.push_back(node + (n + 1) * (n + 1));
        if (simplices)
          for (const auto &t : tetrahedra)
            add(ElementType::TETRAHEDRON, 1, {h[t[0]], h[t[1]], h[t[2]], h[t[3]]});
        else
          add(ElementType::HEXAHEDRON, 1, h);
        if (i == 0 && simplices) {
          add(ElementType::TRIANGLE, 2, {h[0], h[3], h[7]});
          add(ElementType::TRIANGLE, 2, {h[0], h[7], h[4]});
        } else if (i == 0)
          add(ElementType::QUAD, 2, {h[0], h[3], h[7], h[4]});
      }
  mesh.groups[{dim, 1}] = "body";
  mesh.groups[{dim - 1, 2}] = "left";
  mesh.orient(dim);
  return mesh;
}

struct Case {
  int dim;
  bool simplices;
};
class Kinds : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, Kinds,
                         ::testing::Values(Case{2, true}, Case{2, false}, Case{3, true},
                                           Case{3, false}));

std::string failure(const std::function<void()> &f)
{
  try {
    f();
  } catch (const std::runtime_error &e) {
    return e.what();
  }
  return "";
}

// Functions sum to one and give back linear functions, from any hint; gradients are derivatives
TEST_P(Kinds, FunctionsAreLinearlyComplete)
{
  const auto [dim, simplices] = GetParam();
  const BackgroundMesh mesh(block(dim, 4, simplices), dim, "");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.02, 0.98);
  for (int n = 0; n < 500; n++) {
    const double x[3] = {uniform(random), uniform(random), dim == 3 ? uniform(random) : 0.0};
    BackgroundMesh::Place place, hinted;
    mesh.find(x, -1, place);
    mesh.find(x, (int) (random() % mesh.cells.size()), hinted);
    ASSERT_GE(place.cell, 0);
    EXPECT_EQ(place.cell, hinted.cell);
    EXPECT_EQ(place.outside, 0.0);
    const auto &cell = mesh.cells[place.cell];
    double sum = 0.0, at[3] = {0.0, 0.0, 0.0}, slope[3][3] = {{0.0}};
    for (int k = 0; k < cell.nnode; k++) {
      EXPECT_GE(place.N[k], -1e-14);
      sum += place.N[k];
      for (int a = 0; a < dim; a++) {
        at[a] += place.N[k] * mesh.nodes[cell.node[k]][a];
        for (int b = 0; b < dim; b++) slope[a][b] += mesh.nodes[cell.node[k]][a] * place.g[k][b];
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-13);
    for (int a = 0; a < dim; a++) {
      EXPECT_NEAR(at[a], x[a], 1e-12);
      for (int b = 0; b < dim; b++) EXPECT_NEAR(slope[a][b], a == b, 1e-11);
    }

    // of one node, by differences within the cell

    const double step = 1e-6;
    for (int b = 0; b < dim; b++) {
      BackgroundMesh::Place plus, minus;
      double y[3] = {x[0], x[1], x[2]};
      y[b] += step;
      mesh.find(y, place.cell, plus);
      y[b] -= 2 * step;
      mesh.find(y, place.cell, minus);
      if (plus.cell == place.cell && minus.cell == place.cell)
        EXPECT_NEAR((plus.N[0] - minus.N[0]) / (2 * step), place.g[0][b], 2e-8);
    }
  }
}

// Neighbors know each other; sides of a closed surface sum to nothing, their moments to the volume
TEST_P(Kinds, SidesAndNeighbors)
{
  const auto [dim, simplices] = GetParam();
  const int n = 3;
  const BackgroundMesh mesh(block(dim, n, simplices), dim, "body");
  int open = 0;
  for (int c = 0; c < (int) mesh.cells.size(); c++)
    for (int s = 0; s < mesh.cells[c].nface; s++) {
      const int other = mesh.cells[c].neighbor[s];
      open += other < 0;
      if (other < 0) continue;
      const auto &back = mesh.cells[other].neighbor;
      EXPECT_EQ(std::count(back, back + mesh.cells[other].nface, c), 1);
    }
  EXPECT_EQ(open, dim == 2 ? 4 * n : 6 * n * n * (simplices ? 2 : 1));

  const auto left = mesh.faces_of("left");
  double all[3] = {0.0, 0.0, 0.0}, shares = 0.0;
  for (const auto &face : left) {
    double normal[3], share[4];
    mesh.area(face, mesh.nodes, normal, share);
    EXPECT_LT(normal[0], 0.0);    // outward
    for (int d = 0; d < 3; d++) all[d] += normal[d];
    for (int k = 0; k < face.nnode; k++) shares += share[k];
  }
  EXPECT_NEAR(all[0], -1.0, 1e-13);
  EXPECT_NEAR(all[1], 0.0, 1e-13);
  EXPECT_NEAR(all[2], 0.0, 1e-13);
  EXPECT_NEAR(shares, (double) left.size(), 1e-12);
  EXPECT_EQ((int) mesh.nodes_of("left").size(), dim == 2 ? n + 1 : (n + 1) * (n + 1));
  EXPECT_EQ(mesh.nodes_of("body").size(), mesh.nodes.size());
}

// A point that is a little outside has the functions of the rim; one far away is in no cell
TEST_P(Kinds, Outside)
{
  const auto [dim, simplices] = GetParam();
  const BackgroundMesh mesh(block(dim, 4, simplices, 0.0), dim, "");
  BackgroundMesh::Place place;
  const double near[3] = {0.3, -0.005, dim == 3 ? 0.2 : 0.0};    // by 2 % of a cell
  mesh.find(near, 7, place);
  ASSERT_GE(place.cell, 0);
  EXPECT_GT(place.outside, 0.005);
  EXPECT_LT(place.outside, 0.05);
  double sum = 0.0, y = 0.0;
  for (int k = 0; k < mesh.cells[place.cell].nnode; k++) {
    EXPECT_GE(place.N[k], 0.0);
    sum += place.N[k];
    y += place.N[k] * mesh.nodes[mesh.cells[place.cell].node[k]][1];
  }
  EXPECT_NEAR(sum, 1.0, 1e-14);
  EXPECT_NEAR(y, 0.0, 1e-14);
  const double far[3] = {0.3, -3.0, dim == 3 ? 0.2 : 0.0};
  mesh.find(far, -1, place);
  EXPECT_TRUE(place.cell < 0 || place.outside > 0.1);
}

// A walk around a corner: in a mesh with a notch the straight way leaves the mesh
TEST(BackgroundMesh, FindsPointsBehindANotch)
{
  Mesh all = block(2, 20, true, 0.0);
  std::vector<MeshElement> kept;
  for (const auto &e : all.elements) {
    double x = 0.0, y = 0.0;
    for (int k = 0; k < 3; k++) {
      x += all.nodes[e.node[k]][0] / 3.0;
      y += all.nodes[e.node[k]][1] / 3.0;
    }
    if (e.type == ElementType::TRIANGLE && !(x > 0.4 && x < 0.6 && y > 0.2)) kept.push_back(e);
  }
  all.elements.swap(kept);
  const BackgroundMesh mesh(all, 2, "");
  const double from[3] = {0.1, 0.9, 0.0}, to[3] = {0.9, 0.9, 0.0};
  BackgroundMesh::Place a, b;
  mesh.find(from, -1, a);
  mesh.find(to, a.cell, b);
  EXPECT_EQ(b.outside, 0.0);
  const auto &cell = mesh.cells[b.cell];
  EXPECT_GT(cell.low[0], 0.6);
}

TEST(BackgroundMesh, WhatIsNoGrid)
{
  EXPECT_THAT(failure([] {
                BackgroundMesh(block(2, 2, true), 3, "");
              }),
              HasSubstr("no elements of dimension 3"));
  EXPECT_THAT(failure([] {
                BackgroundMesh(block(2, 2, true), 2, "core");
              }),
              HasSubstr("no elements in a physical group or set 'core'; it has: left body"));
  Mesh folded = block(2, 2, false, 0.0);
  folded.nodes[4] = {1.4, 1.4, 0.0};
  EXPECT_THAT(failure([&] {
                BackgroundMesh(folded, 2, "");
              }),
              HasSubstr("is folded"));
  Mesh twice = block(2, 2, true);
  twice.elements.push_back(twice.elements[0]);
  twice.elements.push_back(twice.elements[0]);
  EXPECT_THAT(failure([&] {
                BackgroundMesh(twice, 2, "");
              }),
              HasSubstr("belongs to two others"));
  const BackgroundMesh good(block(2, 2, true), 2, "");
  EXPECT_THAT(failure([&] {
                good.faces_of("body");
              }),
              HasSubstr("is not the side of a cell"));
  EXPECT_THAT(failure([&] {
                good.nodes_of("top");
              }),
              HasSubstr("no elements in a physical group or set 'top'"));
  Mesh inner = block(2, 2, false, 0.0);
  MeshElement line = {ElementType::LINE, 3, 99, {1, 4}};
  inner.elements.push_back(line);
  const BackgroundMesh cut(inner, 2, "");
  EXPECT_THAT(failure([&] {
                cut.faces_of("3");
              }),
              HasSubstr("is between two cells"));
}

// Children share straight elements evenly and have all of bent ones, unfolded, where parents were
TEST_P(Kinds, Halves)
{
  const auto [dim, simplices] = GetParam();
  Mesh mesh = block(dim, 2, simplices);
  Mesh cells = mesh;
  cells.keep(dim);
  const auto before = cells;
  cells.data = {{"number", false, 1, {}}};
  for (std::size_t k = 0; k < cells.elements.size(); k++)
    cells.data[0].values.push_back((double) k);
  cells.halve_elements();
  const std::size_t n = 1u << dim;
  ASSERT_EQ(cells.elements.size(), n * before.elements.size());
  ASSERT_EQ(cells.data[0].values.size(), cells.elements.size());
  for (std::size_t k = 0; k < before.elements.size(); k++) {
    double sum = 0.0;
    for (std::size_t c = 0; c < n; c++) {
      const auto &child = cells.elements[n * k + c];
      const double size = cells.size(child);
      EXPECT_GT(size, 0.0) << k << " " << c;
      if (simplices) EXPECT_NEAR(size * n, before.size(before.elements[k]), 1e-14);
      sum += size;
      EXPECT_EQ(child.label, before.elements[k].label);
      EXPECT_EQ(cells.data[0].values[n * k + c], (double) k);
    }
    EXPECT_NEAR(sum, before.size(before.elements[k]), 1e-14);
  }
}

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

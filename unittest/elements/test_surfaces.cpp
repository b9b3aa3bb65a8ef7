// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Surfaces that are curved between the nodes of triangles and lines: volumes, areas, and gradients.
// Contact with the faces of a surface: what each place feels of them.

#include "math/matrix.h"
#include "mesh/curved_surface.h"
#include "mesh/face_contact.h"
#include "mesh/gmsh.h"
#include "mesh/rims.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

using namespace MPM_NS;

using Place = std::array<double, 3>;
const double PI = std::acos(-1.0);

/** Area and volume, of the triangles and of the curved surface. */
struct Sizes {
  double area, volume, curved_area, curved_volume;
};

static Sizes sizes_of(Mesh mesh, int dim = 3)
{
  Sizes s = {};
  add_edges(mesh, find_rims(mesh));
  const auto areas = curved_areas(dim, mesh, [&](int a, int b, double *to) {
    for (int d = 0; d < 3; d++) to[d] = mesh.nodes[b][d] - mesh.nodes[a][d];
  });
  for (std::size_t k = 0; k < mesh.elements.size(); k++) {
    const auto &e = mesh.elements[k];
    double x[4][3] = {{0.0}}, a[3], b[3], n[3];
    for (int m = 0; m < element_nodes(e.type); m++)
      std::copy_n(mesh.nodes[e.node[m]].data(), 3, x[m]);
    if (e.type == ElementType::EDGE || e.type == ElementType::CORNER) {
      s.curved_volume += curved_volume(dim, x, 1.0, nullptr);
      continue;
    }
    double area, volume;
    for (int d = 0; d < 3; d++) {
      a[d] = x[1][d] - x[0][d];
      b[d] = x[2][d] - x[0][d];
    }
    if (dim == 2) {
      area = std::hypot(a[0], a[1]);
      volume = 0.5 * (x[0][0] * a[1] - x[0][1] * a[0]);
    } else {
      cross(a, b, n);
      area = 0.5 * std::sqrt(dot(n, n));
      volume = dot(n, x[0]) / 6.0;
    }
    s.area += area;
    s.volume += volume;
    s.curved_area += areas[k] * area;
  }
  s.curved_volume += s.volume;
  return s;
}

/** An octahedron whose triangles are divided, on a sphere of radius 1 or with its flat sides. */
static Mesh octahedron(int divisions, bool round)
{
  Mesh mesh;
  auto &x = mesh.nodes;
  x = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<int, 3>> f = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < divisions; k++) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto found = middles.find(key);
      if (found != middles.end()) return found->second;
      Place m;
      for (int d = 0; d < 3; d++) m[d] = 0.5 * (x[a][d] + x[b][d]);
      const double size = round ? std::sqrt(dot(m.data(), m.data())) : 1.0;
      for (double &c : m) c /= size;
      x.push_back(m);
      return middles[key] = (int) x.size() - 1;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto &t : f) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    f.swap(finer);
  }
  for (const auto &t : f)
    mesh.elements.push_back({ElementType::TRIANGLE, 0, 1, {t[0], t[1], t[2]}});
  return mesh;
}

// a sphere: errors of the triangles are of second order, those of the curved surface less than a
// tenth and a twentieth, and of higher order
TEST(CurvedSurface, Spheres)
{
  double error[3][2];
  for (int k = 2; k < 5; k++) {
    const Sizes s = sizes_of(octahedron(k, true));
    const double V = 4.0 / 3.0 * PI, A = 4.0 * PI;
    error[k - 2][0] = s.curved_volume / V - 1.0;
    error[k - 2][1] = s.curved_area / A - 1.0;
    EXPECT_LT(std::fabs(error[k - 2][0]), (k == 2 ? 0.1 : 0.05) * (1.0 - s.volume / V));
    EXPECT_LT(std::fabs(error[k - 2][1]), (k == 2 ? 0.1 : 0.05) * (1.0 - s.area / A));
  }
  for (int what = 0; what < 2; what++)
    for (int k = 0; k < 2; k++)
      EXPECT_LT(std::fabs(error[k + 1][what]), 0.2 * std::fabs(error[k][what])) << what << k;
}

// flat sides with sharp edges have nothing between them, which is exact
TEST(CurvedSurface, BodiesWithSharpEdges)
{
  const Sizes s = sizes_of(octahedron(2, false));
  EXPECT_NEAR(s.volume, 4.0 / 3.0, 1e-14);
  EXPECT_NEAR(s.curved_volume, s.volume, 1e-14);
  EXPECT_NEAR(s.curved_area, s.area, 1e-14);
}

// a can whose side is n pairs of triangles: its lids are flat, and its rims sharp
TEST(CurvedSurface, Cylinders)
{
  double error[2];
  for (const int n : {16, 32}) {
    Mesh mesh;
    const int rows = n / 8;
    for (int j = 0; j <= rows; j++)
      for (int i = 0; i < n; i++)
        mesh.nodes.push_back(
            {std::cos(2.0 * PI * i / n), std::sin(2.0 * PI * i / n), (double) j / rows});
    mesh.nodes.push_back({0, 0, 0});
    mesh.nodes.push_back({0, 0, 1});
    for (int i = 0; i < n; i++) {
      const int next = (i + 1) % n, top = rows * n, low = (rows + 1) * n;
      for (int j = 0; j < rows; j++) {
        mesh.elements.push_back(
            {ElementType::TRIANGLE, 0, 1, {j * n + i, j * n + next, j * n + n + next}});
        mesh.elements.push_back(
            {ElementType::TRIANGLE, 0, 1, {j * n + i, j * n + n + next, j * n + n + i}});
      }
      mesh.elements.push_back({ElementType::TRIANGLE, 0, 1, {next, i, low}});
      mesh.elements.push_back({ElementType::TRIANGLE, 0, 1, {top + i, top + next, low + 1}});
    }
    const Sizes s = sizes_of(mesh);
    error[n == 32] = std::fabs(s.curved_volume / PI - 1.0);
    EXPECT_LT(error[n == 32], 0.03 * (1.0 - s.volume / PI));
    // of the sides; lids are polygons
    const double lids = n * std::sin(2.0 * PI / n);
    EXPECT_NEAR(s.curved_area - lids, 2.0 * PI, 0.03 * (2.0 * PI - s.area + lids));
  }
  EXPECT_LT(error[1], 0.1 * error[0]);
}

// a circle of lines in 2d that are not equally long, and a square
TEST(CurvedSurface, Circles)
{
  for (const bool square : {false, true}) {
    Mesh mesh;
    const int n = 24;
    for (int i = 0; i < n; i++) {
      const double angle = 2.0 * PI * (i + 0.2 * std::sin(5.0 * i)) / n, side = 4.0 * i / n;
      const int k = (int) side;
      const double t = side - k;
      if (square)
        mesh.nodes.push_back({k == 0       ? t
                                  : k == 1 ? 1
                                  : k == 2 ? 1 - t
                                           : 0,
                              k == 0       ? 0
                                  : k == 1 ? t
                                  : k == 2 ? 1
                                           : 1 - t,
                              0.0});
      else
        mesh.nodes.push_back({std::cos(angle), std::sin(angle), 0.0});
      mesh.elements.push_back({ElementType::LINE, 0, 1, {i, (i + 1) % n}});
    }
    const Sizes s = sizes_of(mesh, 2);
    if (square) {
      EXPECT_NEAR(s.curved_volume, 1.0, 1e-14);
      EXPECT_NEAR(s.curved_area, 4.0, 1e-14);
    } else {
      EXPECT_LT(std::fabs(s.curved_volume / PI - 1.0), 0.03 * (1.0 - s.volume / PI));
      EXPECT_LT(std::fabs(s.curved_area / (2.0 * PI) - 1.0), 0.015 * (1.0 - s.area / (2.0 * PI)));
    }
  }
}

TEST(CurvedSurface, Gradients)
{
  const double edge[4][3] = {{0.1, 0, 0}, {1, 0.2, 0.1}, {0.4, 0.9, -0.1}, {0.5, -0.6, -0.2}},
               corner[3][3] = {{0, 0, 0}, {1, 0.2, 0}, {1.7, 0.9, 0}};
  for (const int dim : {2, 3}) {
    double x[4][3] = {{0.0}}, g[4][3] = {{0.0}};
    const int n = dim + 1;
    std::copy_n(dim == 2 ? corner[0] : edge[0], 3 * n, x[0]);
    EXPECT_GT(std::fabs(curved_volume(dim, x, 2.0, g)), 1e-3);
    for (int k = 0; k < n; k++)
      for (int d = 0; d < dim; d++) {
        double side[2];
        for (int s = 0; s < 2; s++) {
          x[k][d] += s ? 2e-6 : -1e-6;
          side[s] = curved_volume(dim, x, 2.0, nullptr);
        }
        x[k][d] -= 1e-6;
        EXPECT_NEAR(g[k][d], (side[1] - side[0]) / 2e-6, 1e-9) << dim << k << d;
      }
  }
}

TEST(CurvedSurface, Refuses)
{
  Mesh squares;
  squares.nodes.resize(4);
  squares.elements.push_back({ElementType::QUAD, 0, 7, {0, 1, 2, 3}});
  EXPECT_THROW(find_rims(squares), std::runtime_error);
  Mesh book;
  book.nodes.resize(5);
  for (int k = 2; k < 5; k++) book.elements.push_back({ElementType::TRIANGLE, 0, k, {0, 1, k}});
  EXPECT_THROW(find_rims(book), std::runtime_error);
}

constexpr double D = 0.9;

/** Energy (D - d)^2/2 of what is at x by all faces with these nodes. */
static double energy(int dim, const std::vector<std::array<double, 3>> &nodes,
                     const std::vector<std::array<int, 3>> &faces, const double *x)
{
  double sum = 0.0;
  const auto add = [&](double share, double distance) {
    if (distance < D) sum += 0.5 * share * (D - distance) * (D - distance);
  };
  std::vector<ContactFace> close;
  for (const auto &f : faces) {
    const double *at[3];
    for (int m = 0; m < dim; m++) at[m] = nodes[f[m]].data();
    FacePlace place;
    place.find_plane(dim, at, x);
    if (!place.within) place.find_rim(dim, at, x);
    if (place.distance >= D) continue;
    add(1.0, place.distance);
    close.push_back({{f[0], f[1], f[2]}, 1.0, 2.0});
  }
  std::vector<ContactPart> parts;
  find_common_parts(dim, close, parts);
  for (const auto &part : parts) {
    EXPECT_NEAR(part.share, part.stiffness, 1e-13);
    EXPECT_NEAR(2.0 * part.share, part.damping, 1e-13);
    const auto &a = nodes[part.node[0]], &b = nodes[part.node[1]];
    const double s = part.node[0] == part.node[1] ? 0.0 : place_on_line(a.data(), b.data(), x);
    double square = 0.0;
    for (int d = 0; d < 3; d++) {
      const double way = x[d] - a[d] - s * (b[d] - a[d]);
      square += way * way;
    }
    add(part.share, std::sqrt(square));
  }
  return sum;
}

/** 5 x 5 nodes in no order around whole numbers, with a shape z(x, y). */
template <class Shape>
static void make_sheet(std::vector<std::array<double, 3>> &nodes,
                       std::vector<std::array<int, 3>> &faces, Shape shape)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-0.25, 0.25);
  for (int j = 0; j < 5; j++)
    for (int i = 0; i < 5; i++) {
      nodes.push_back({i + any(random), j + any(random), 0.0});
      nodes.back()[2] = shape(nodes.back()[0], nodes.back()[1]);
    }
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) {
      const int a = 5 * j + i;
      if ((i + j) % 2) {
        faces.push_back({a, a + 1, a + 5});
        faces.push_back({a + 6, a + 5, a + 1});
      } else {
        faces.push_back({a, a + 1, a + 6});
        faces.push_back({a + 6, a + 5, a});
      }
    }
}

// above a plane the energy is that of the height, wherever edges and nodes are, and over a ridge
// that of the distance; in 2d so, too
TEST(FaceContact, IsThatOfTheDistanceOnce)
{
  std::vector<std::array<double, 3>> nodes;
  std::vector<std::array<int, 3>> faces;
  make_sheet(nodes, faces, [](double, double) {
    return 0.0;
  });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(1.3, 2.7), height(-D, D);
  for (int n = 0; n < 500; n++) {
    const double x[3] = {place(random), place(random), height(random)}, gap = std::fabs(x[2]);
    EXPECT_NEAR(energy(3, nodes, faces, x), 0.5 * (D - gap) * (D - gap), 1e-12);
  }
  const std::vector<std::array<double, 3>> roof = {{0, 0, 0}, {2, 0, 0}, {1, 2, -1}, {1, -2, -1}};
  const std::vector<std::array<int, 3>> two = {{0, 1, 2}, {1, 0, 3}};
  const double over[3] = {1.0, 0.1, 0.4};
  EXPECT_NEAR(energy(3, roof, two, over), 0.5 * std::pow(D - std::hypot(0.1, 0.4), 2), 1e-12);
  const std::vector<std::array<double, 3>> bend = {{0, 0, 0}, {1, 0, 0}, {2, -1, 0}};
  const double above[3] = {1.1, 0.5, 0.0};
  EXPECT_NEAR(energy(2, bend, {{{0, 1, 0}}, {{1, 2, 0}}}, above),
              0.5 * std::pow(D - std::hypot(0.1, 0.5), 2), 1e-12);
}

// it has no jump anywhere around a bent surface: steps of 1e-4 change it by the force of some faces
TEST(FaceContact, HasNoJumps)
{
  std::vector<std::array<double, 3>> nodes;
  std::vector<std::array<int, 3>> faces;
  make_sheet(nodes, faces, [](double x, double y) {
    return 0.8 * std::sin(1.3 * x) * std::cos(1.1 * y);
  });
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n = 0; n < 40; n++) {
    double x[3] = {2.0 + 2.0 * any(random), 2.0 + 2.0 * any(random), any(random)}, way[3];
    for (double &w : way) w = any(random);
    const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    double before = energy(3, nodes, faces, x);
    for (int s = 0; s < 2000; s++) {
      for (int d = 0; d < 3; d++) x[d] += 1e-4 * way[d] / length;
      const double now = energy(3, nodes, faces, x);
      EXPECT_LT(std::fabs(now - before), 1e-4 * 4.0 * D);
      before = now;
    }
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Contact with the faces of a surface: what each place feels of them together.

#include "mesh/face_contact.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace MPM_NS;

namespace {

constexpr double D = 0.9;

/** Energy (D - d)^2/2 of what is at x by all faces with these nodes. */
double energy(int dim, const std::vector<std::array<double, 3>> &nodes,
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
void make_sheet(std::vector<std::array<double, 3>> &nodes, std::vector<std::array<int, 3>> &faces,
                Shape shape)
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

}    // namespace

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

// it has no jump anywhere around a bent surface, inside of folds neither: steps of 1e-4 change it
// by no more than the force of some faces
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

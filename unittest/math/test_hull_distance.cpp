// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The shortest way between convex hulls, from the points that are farthest along a direction.

#include "math/hull_distance.h"

#include "gtest/gtest.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace MPM_NS;
using Points = std::vector<std::array<double, 3>>;

static double along(const double *x, const std::array<double, 3> &p)
{
  return x[0] * p[0] + x[1] * p[1] + x[2] * p[2];
}

static int search(const Points &a, const Points &b, HullDistance &hull)
{
  int rounds = 0;
  for (; !hull.done && rounds < HullDistance::ROUNDS; rounds++) {
    const double *pa = a[0].data(), *pb = b[0].data();
    for (const auto &p : a)
      if (along(hull.x, p) > hull.x[0] * pa[0] + hull.x[1] * pa[1] + hull.x[2] * pa[2])
        pa = p.data();
    for (const auto &p : b)
      if (along(hull.x, p) < hull.x[0] * pb[0] + hull.x[1] * pb[1] + hull.x[2] * pb[2])
        pb = p.data();
    hull.advance(pa, pb);
  }
  return rounds;
}

// Rows of points that end somewhere: at right angles to them, to the last digit
TEST(HullDistance, OfRows)
{
  Points a, b;
  for (int i = 0; i < 9; i++) a.push_back({0.25 * i - 1.0, -0.125, 0.0});
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 2; j++) b.push_back({0.25 * i + 0.07, 0.125 + 0.25 * j, 0.0});
  HullDistance hull;
  search(a, b, hull);
  EXPECT_TRUE(hull.done);
  EXPECT_NEAR(hull.x[0], 0.0, 1e-14);
  EXPECT_NEAR(hull.x[1], 0.25, 1e-14);
}

// No plane at right angles to a way that is too long or has another direction leaves all points
// behind it: for any points, the distance along it is its length, and hulls that overlap have none
TEST(HullDistance, OfAnyPoints)
{
  std::mt19937 random(7481);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int apart = 0, together = 0;
  for (const int dim : {2, 3})
    for (int trial = 0; trial < 2000; trial++) {
      Points a(1 + trial % 17), b(1 + trial % 13);
      const double shift = 1.5 * u(random);
      for (auto *points : {&a, &b})
        for (auto &p : *points)
          p = {u(random) + (points == &b ? shift : 0.0), u(random), dim == 3 ? u(random) : 0.0};
      HullDistance hull;
      search(a, b, hull);
      ASSERT_TRUE(hull.done) << trial;
      const double square = along(hull.x, {hull.x[0], hull.x[1], hull.x[2]});
      double gap = 1e300;
      for (const auto &p : a)
        for (const auto &q : b) gap = std::min(gap, along(hull.x, q) - along(hull.x, p));
      if (square > 0.0) {
        EXPECT_NEAR(gap / square, 1.0, 1e-9) << trial;
        apart++;
        continue;
      }
      together++;
      for (int k = 0; k < 200; k++) {    // no direction in which they are apart
        const double d[3] = {u(random), u(random), dim == 3 ? u(random) : 0.0};
        double least = 1e300;
        for (const auto &p : a)
          for (const auto &q : b) least = std::min(least, along(d, q) - along(d, p));
        EXPECT_LT(least, 1e-7);
      }
    }
  EXPECT_GT(apart, 500);
  EXPECT_GT(together, 500);
}

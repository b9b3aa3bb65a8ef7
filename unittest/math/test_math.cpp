// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Small tools of numerical mathematics: iterations that converge faster, distances of hulls, sets.

#include "math/aitken.h"
#include "math/hull_distance.h"
#include "math/sets.h"
#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

using namespace MPM_NS;

/** Iterations until f changes x by less than 1e-13 of its size. */
template <class F> int iterations(std::vector<double> &x, bool helped, const F &f)
{
  Aitken series;
  series.begin(x);
  for (int it = 1; it <= 100000; it++) {
    const auto before = x;
    const bool smooth = f(x);
    double change = 0.0, size = 0.0;
    for (std::size_t i = 0; i < x.size(); i++) {
      change = std::max(change, std::fabs(x[i] - before[i]));
      size = std::max(size, std::fabs(x[i]));
    }
    if (change <= 1e-13 * size) return it;
    if (helped) series.advance(x, change, smooth);
  }
  return 0;
}

// Two nodes that share a light body: one number tells how the rest goes down
TEST(Aitken, OneSlowDirectionTakesAFewIterations)
{
  for (const double s : {0.9, 0.99, 0.999}) {
    const auto step = [s](std::vector<double> &x) {    // solution (2, 1)
      x[0] = 2 - std::sqrt(s) * (x[1] - 1);
      x[1] = 1 - std::sqrt(s) * (x[0] - 2);
      return true;
    };
    std::vector<double> plain = {0, 0}, helped = plain;
    const int n = iterations(plain, false, step);
    EXPECT_GT(n, 100);
    EXPECT_LE(iterations(helped, true, step), 8) << s;    // rounding asks for a second time
    EXPECT_NEAR(helped[0], 2, 1e-12 / (1 - s));
    EXPECT_NEAR(helped[1], 1, 1e-12 / (1 - s));
  }
}

// Several of them, as of three bodies in a row, and with bounds that become active on the way
TEST(Aitken, SeveralDirectionsAndBoundsComeToTheSame)
{
  const double weight[4] = {1, 1, 1.05, 1.1}, load[4] = {1, -0.2, 0.5, 0.3};
  const auto step = [&](std::vector<double> &x) {
    bool same = true;
    for (int i = 0; i < 4; i++) {
      const double left = i ? x[i - 1] : 0.0, right = i < 3 ? x[i + 1] : 0.0;
      const double now = std::max(0.0, (load[i] + 0.5 * (left + right)) / weight[i]);
      same = same && (now > 0) == (x[i] > 0);
      x[i] = now;
    }
    return same;
  };
  std::vector<double> plain(4, 0.0), helped = plain;
  const int n = iterations(plain, false, step);
  EXPECT_GT(n, 0);
  const int m = iterations(helped, true, step);
  EXPECT_GT(m, 0);
  EXPECT_LT(m, n);
  for (int i = 0; i < 4; i++) EXPECT_NEAR(helped[i], plain[i], 1e-11);
}

// Where the changes follow no series it must not keep them from converging
TEST(Aitken, IsLeftWhereItDoesNotHelp)
{
  // a rotation that shrinks: the factor from one change to the next turns, too
  const auto step = [](std::vector<double> &x) {
    const double c = 0.97 * std::cos(0.1), s = 0.97 * std::sin(0.1);
    x = {c * x[0] - s * x[1] + 1, s * x[0] + c * x[1]};
    return true;
  };
  std::vector<double> plain = {0, 0}, helped = plain;
  EXPECT_GT(iterations(plain, false, step), 0);
  EXPECT_GT(iterations(helped, true, step), 0);
  for (int i = 0; i < 2; i++) EXPECT_NEAR(helped[i], plain[i], 1e-10);
}

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

// numbers that differ by a multiple of 7 are joined by steps of 14 and 21, in both directions
TEST(Sets, AreThoseOfJoinedThings)
{
  constexpr int n = 1000, modulus = 7;
  Sets sets(n);
  for (int i = n - 1; i >= 14; i--) sets.join(i, i - 14);
  for (int i = 21; i < n; i++) sets.join(i - 21, i);
  std::set<int> roots;
  for (int i = 0; i < n; i++) {
    EXPECT_EQ(sets.root(i), sets.root(i % modulus));
    EXPECT_EQ(sets.root(i) % modulus, i % modulus);
    roots.insert(sets.root(i));
  }
  EXPECT_EQ((int) roots.size(), modulus);
}

TEST(Sets, BeginAgain)
{
  Sets sets(3);
  sets.join(0, 2);
  EXPECT_EQ(sets.root(0), sets.root(2));
  sets.begin(5);
  EXPECT_EQ(sets.size(), 5u);
  for (int i = 0; i < 5; i++) EXPECT_EQ(sets.root(i), i);
}

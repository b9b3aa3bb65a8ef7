// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Iterations that converge slowly, and what helps them.

#include "math/aitken.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>

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

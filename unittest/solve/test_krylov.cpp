// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Krylov methods on small systems whose solutions are known.

#include "small_systems.h"
#include "solve/krylov.h"

#include "gtest/gtest.h"

#include <cmath>
#include <vector>

using namespace MPM_NS;

// A load on each node of a rod: x_i = i (n + 1 - i)/2 in n/2 iterations, by symmetry.
TEST(ConjugateGradients, RodUnderItsWeight)
{
  const int n = 50;
  System system(n, rod(n, true));
  const std::vector<double> b(n, 1.0);
  std::vector<double> x(n, 0.0);
  const auto report = ConjugateGradients().solve(system, b.data(), x.data(), {1e-12, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  EXPECT_LE(report.iterations, n / 2);
  for (int i = 0; i < n; i++) EXPECT_NEAR(x[i], 0.5 * (i + 1) * (n - i), 1e-9 * n * n);
}

// A free rod with forces that balance moves as a whole by nothing: the null space gets nothing.
TEST(ConjugateGradients, FreeRod)
{
  const int n = 40;
  System system(n, rod(n, false));
  std::vector<double> b(n, 0.0), x(n, 0.0);
  b[0] = -1.0;
  b[n - 1] = 1.0;
  const auto report = ConjugateGradients().solve(system, b.data(), x.data(), {1e-12, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  for (int i = 0; i < n; i++) EXPECT_NEAR(x[i], i - 0.5 * (n - 1), 1e-9);
}

// Stiffnesses over 12 decades: hopeless without the diagonal, which solves it at once.
TEST(ConjugateGradients, Diagonal)
{
  const int n = 60;
  const auto k = [](int i) {
    return std::pow(10.0, -6.0 + 0.2 * i);
  };
  const auto A = [&](const double *x, double *y) {
    for (int i = 0; i < n; i++) y[i] = k(i) * x[i];
  };
  const auto inverse = [&](const double *r, double *z) {
    for (int i = 0; i < n; i++) z[i] = r[i] / k(i);
  };
  const std::vector<double> b(n, 1.0);
  std::vector<double> x(n, 0.0);
  System plain(n, A), scaled(n, A, inverse);
  auto report = ConjugateGradients().solve(plain, b.data(), x.data(), {1e-8, 0.0, 50});
  EXPECT_EQ(report.outcome, SolveReport::TOO_MANY);
  x.assign(n, 0.0);
  report = ConjugateGradients().solve(scaled, b.data(), x.data(), {1e-8, 0.0, 50});
  EXPECT_TRUE(report.converged());
  EXPECT_EQ(report.iterations, 1);
  for (int i = 0; i < n; i++) EXPECT_NEAR(k(i) * x[i], 1.0, 1e-12);
}

// A first guess changes the way, not the answer; a right side of zero is solved by zero.
TEST(ConjugateGradients, FirstGuess)
{
  const int n = 30;
  System system(n, rod(n, true));
  std::vector<double> b(n, 1.0), x(n, 3.0);
  ConjugateGradients solver;
  ASSERT_TRUE(solver.solve(system, b.data(), x.data(), {1e-12, 0.0, 100}).converged());
  for (int i = 0; i < n; i++) EXPECT_NEAR(x[i], 0.5 * (i + 1) * (n - i), 1e-8);
  const auto again = solver.solve(system, b.data(), x.data(), {1e-10, 0.0, 100});
  EXPECT_EQ(again.iterations, 0);
  b.assign(n, 0.0);
  x.assign(n, 0.0);
  EXPECT_EQ(solver.solve(system, b.data(), x.data(), {}).iterations, 0);
}

// What conjugate gradients cannot solve is told.
TEST(ConjugateGradients, Failures)
{
  const int n = 2;
  std::vector<double> b{1.0, 1.0}, x(n, 0.0);
  System saddle(n, [](const double *x, double *y) {
    y[0] = x[0];
    y[1] = -2.0 * x[1];
  });
  auto report = ConjugateGradients().solve(saddle, b.data(), x.data(), {});
  EXPECT_EQ(report.outcome, SolveReport::INDEFINITE);
  EXPECT_NE(report.describe().find("is not positive definite"), std::string::npos);
  x.assign(n, 0.0);
  b[0] = NAN;
  System one(n, [](const double *x, double *y) {
    std::copy_n(x, 2, y);
  });
  EXPECT_EQ(ConjugateGradients().solve(one, b.data(), x.data(), {}).outcome,
            SolveReport::NOT_FINITE);
}

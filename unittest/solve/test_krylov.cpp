// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Krylov methods, for definite, indefinite, and unsymmetric systems, and what pairs of motions and
// forces tell of a matrix: known solutions, iterations from theory.

#include "small_systems.h"
#include "solve/krylov.h"
#include "solve/quasi_newton.h"
#include "gtest/gtest.h"

#include <Eigen/Dense>
#include <cmath>
#include <deque>
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

System::Operator diagonal(const std::vector<double> &d)
{
  return [=](const double *x, double *y) {
    for (std::size_t i = 0; i < d.size(); i++) y[i] = d[i] * x[i];
  };
}

/** A rod of n springs, its loads, and m forces that hold every third node: [K B^T; B 0]. */
class HeldRod {
 public:
  static constexpr int n = 30, m = 10;
  static int held(int k) { return 3 * k + 1; }
  static System::Operator matrix()
  {
    return [K = rod(n, true)](const double *x, double *y) {
      K(x, y);
      for (int k = 0; k < m; k++) {
        y[held(k)] += x[n + k];
        y[n + k] = x[held(k)];
      }
    };
  }
  /** K^-1 by the formula for a force at one node. */
  static void solve_rod(const double *f, double *u)
  {
    for (int i = 0; i < n; i++) {
      u[i] = 0.0;
      for (int j = 0; j < n; j++)
        u[i] += (std::min(i, j) + 1.0) * (n - std::max(i, j)) / (n + 1.0) * f[j];
    }
  }
  /** S^-1 with S = B K^-1 B^T, by elimination. */
  static void solve_forces(const double *g, double *p)
  {
    double S[m][m + 1], unit[n], u[n];
    for (int k = 0; k < m; k++) {
      std::fill_n(unit, n, 0.0);
      unit[held(k)] = 1.0;
      solve_rod(unit, u);
      for (int l = 0; l < m; l++) S[l][k] = u[held(l)];
    }
    for (int k = 0; k < m; k++) S[k][m] = g[k];
    for (int k = 0; k < m; k++)
      for (int l = k + 1; l < m; l++) {
        const double factor = S[l][k] / S[k][k];
        for (int j = k; j <= m; j++) S[l][j] -= factor * S[k][j];
      }
    for (int k = m - 1; k >= 0; k--) {
      p[k] = S[k][m];
      for (int j = k + 1; j < m; j++) p[k] -= S[k][j] * p[j];
      p[k] /= S[k][k];
    }
  }
  /** Displacements of unit loads: 1 between nodes that are held, 1/2 at the ends. */
  static void expect_solution(const std::vector<double> &x, double tolerance)
  {
    for (int i = 0; i < n; i++) {
      // free are node 0, pieces of two nodes, and node 29
      const double u = i % 3 == 1 ? 0.0 : i == 0 || i == n - 1 ? 0.5 : 1.0;
      EXPECT_NEAR(x[i], u, tolerance) << i;
    }
  }
  static std::vector<double> loads()
  {
    std::vector<double> b(n + m, 1.0);
    std::fill_n(b.begin() + n, m, 0.0);
    return b;
  }
};

/** Steady convection and diffusion, upwind: -u'' + 2c u' between fixed ends, spacing 1. */
System::Operator convection(int n, double c)
{
  return [=](const double *x, double *y) {
    for (int i = 0; i < n; i++) {
      const double left = i ? x[i - 1] : 0.0, right = i < n - 1 ? x[i + 1] : 0.0;
      y[i] = 2.0 * x[i] - left - right + 2.0 * c * (x[i] - left);
    }
  };
}

/** For a load of 1: x_i = (i - (n+1) (r^i - 1)/(r^(n+1) - 1))/2c with r = 1 + 2c. */
double convection_solution(int n, double c, int i)
{
  const double r = 1.0 + 2.0 * c;
  return (i - (n + 1) * std::expm1(i * std::log(r)) / std::expm1((n + 1) * std::log(r))) /
      (2.0 * c);
}

// In full it needs as many iterations as the minimal polynomial has roots.
TEST(FlexibleGMRES, DegreeOfMinimalPolynomial)
{
  const int n = 30;
  std::vector<double> d(n), b(n, 1.0), x(n, 0.0);
  for (int i = 0; i < n; i++) d[i] = 1.0 + i % 4;
  // eigenvalues 1 to 4, not normal: the first of each pair is fed by the second, of another one
  System system(n, [&](const double *x, double *y) {
    for (int i = 0; i < n; i++) y[i] = d[i] * x[i] + (i % 2 == 0 ? 5.0 * x[i + 1] : 0.0);
  });
  const auto report = FlexibleGMRES().solve(system, b.data(), x.data(), {1e-10, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  EXPECT_EQ(report.iterations, 4);
  for (int i = 0; i < n; i++) {
    const double odd = i % 2 == 0 ? b[i + 1] / d[i + 1] : 0.0;
    EXPECT_NEAR(x[i], (b[i] - 5.0 * odd) / d[i], 1e-9);
  }
}

// Convection against diffusion, in cycles of any length, also where the first guess is far off.
TEST(FlexibleGMRES, ConvectionWithRestarts)
{
  const int n = 60;
  const double c = 0.2;
  System system(n, convection(n, c));
  const std::vector<double> b(n, 1.0);
  int before = 0;
  for (const int cycle : {80, 20, 5}) {
    std::vector<double> x(n, -10.0);
    FlexibleGMRES solver(cycle);
    const auto report = solver.solve(system, b.data(), x.data(), {1e-10, 0.0, 5000});
    EXPECT_TRUE(report.converged()) << cycle << " " << report.describe();
    EXPECT_GE(report.iterations, before);
    before = report.iterations;
    if (cycle > n) { EXPECT_LE(report.iterations, n); }
    for (int i = 0; i < n; i++)
      EXPECT_NEAR(x[i], convection_solution(n, c, i + 1), 1e-6) << cycle << " " << i;
    const auto again = solver.solve(system, b.data(), x.data(), {1e-9, 0.0, 5000});
    EXPECT_EQ(again.iterations, 0);
  }
}

// A cycle of n nodes that hand their value on: nothing in n - 1 iterations, all in the last one.
TEST(FlexibleGMRES, CyclicShift)
{
  const int n = 12;
  System system(n, [](const double *x, double *y) {
    for (int i = 0; i < n; i++) y[i] = x[(i + 1) % n];
  });
  std::vector<double> b(n, 0.0), x(n, 0.0);
  b[0] = 1.0;
  auto report = FlexibleGMRES(n).solve(system, b.data(), x.data(), {1e-12, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  EXPECT_EQ(report.iterations, n);
  EXPECT_NEAR(report.residuals[n - 1], 1.0, 1e-12);
  EXPECT_NEAR(x[1], 1.0, 1e-12);
  x.assign(n, 0.0);
  report = FlexibleGMRES(n - 1).solve(system, b.data(), x.data(), {1e-12, 0.0, 100});
  EXPECT_EQ(report.outcome, SolveReport::TOO_MANY);
  EXPECT_NEAR(report.residuals.back(), 1.0, 1e-12);
}

// The triangular preconditioner of a saddle point gives two iterations (Murphy, Golub, Wathen).
TEST(FlexibleGMRES, SaddlePoint)
{
  const int n = HeldRod::n, m = HeldRod::m;
  const auto triangular = [&](const double *r, double *z) {
    std::vector<double> rest(r, r + n);
    HeldRod::solve_forces(r + n, z + n);
    for (int k = 0; k < m; k++) z[n + k] = -z[n + k];
    for (int k = 0; k < m; k++) rest[HeldRod::held(k)] -= z[n + k];
    HeldRod::solve_rod(rest.data(), z);
  };
  System system(n + m, HeldRod::matrix(), triangular);
  const auto b = HeldRod::loads();
  std::vector<double> x(n + m, 0.0);
  const auto report = FlexibleGMRES().solve(system, b.data(), x.data(), {1e-10, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  EXPECT_LE(report.iterations, 2);
  HeldRod::expect_solution(x, 1e-9);
}

// A preconditioner that differs from iteration to iteration: a few iterations of the same method.
TEST(FlexibleGMRES, SolveWithinASolve)
{
  const int n = 80;
  const double c = 0.1;
  System inner(n, convection(n, c));
  int solves = 0;
  FlexibleGMRES inner_solver(8);
  System outer(n, convection(n, c), [&](const double *r, double *z) {
    std::fill_n(z, n, 0.0);
    inner_solver.solve(inner, r, z, {1e-1, 0.0, 4 + 4 * (solves++ % 2)});
  });
  const std::vector<double> b(n, 1.0);
  std::vector<double> x(n, 0.0), y(n, 0.0);
  const auto report = FlexibleGMRES().solve(outer, b.data(), x.data(), {1e-10, 0.0, 200});
  ASSERT_TRUE(report.converged()) << report.describe();
  EXPECT_EQ(report.iterations, solves);
  for (int i = 0; i < n; i++) EXPECT_NEAR(x[i], convection_solution(n, c, i + 1), 1e-6);
  EXPECT_LT(report.iterations,
            FlexibleGMRES().solve(inner, b.data(), y.data(), {1e-10, 0.0, 2000}).iterations / 2);
}

// Singular systems: solved if they can be, told if not.
TEST(FlexibleGMRES, Singular)
{
  const int n = 30;
  System system(n, rod(n, false));
  std::vector<double> b(n, 0.0), x(n, 0.0);
  b[0] = -1.0;
  b[n - 1] = 1.0;
  auto report = FlexibleGMRES().solve(system, b.data(), x.data(), {1e-10, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  for (int i = 0; i < n; i++) EXPECT_NEAR(x[i], i - 0.5 * (n - 1), 1e-7);

  // diag(1, 0): the second equation has no solution
  System two(2, diagonal({1.0, 0.0}));
  b = {1.0, 0.5};
  x.assign(2, 0.0);
  report = FlexibleGMRES().solve(two, b.data(), x.data(), {1e-10, 0.0, 100});
  EXPECT_EQ(report.outcome, SolveReport::SINGULAR) << report.describe();
  EXPECT_NEAR(x[0], 1.0, 1e-12);
  EXPECT_NEAR(report.residuals.back(), 0.5, 1e-12);
  EXPECT_NE(report.describe().find("is singular"), std::string::npos);
}

TEST(FlexibleGMRES, Failures)
{
  std::vector<double> b{1.0, 2.0}, x(2, 0.0);
  System bad(2, diagonal({1.0, NAN}));
  EXPECT_EQ(FlexibleGMRES().solve(bad, b.data(), x.data(), {}).outcome, SolveReport::NOT_FINITE);
  System late(2, diagonal({1.0, 2.0}), diagonal({1.0, INFINITY}));
  x.assign(2, 0.0);
  EXPECT_EQ(FlexibleGMRES().solve(late, b.data(), x.data(), {}).outcome, SolveReport::NOT_FINITE);
  b.assign(2, 0.0);
  x.assign(2, 0.0);
  const auto report = FlexibleGMRES().solve(late, b.data(), x.data(), {});
  EXPECT_TRUE(report.converged());
  EXPECT_EQ(report.iterations, 0);
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

/** A symmetric matrix with eigenvalues from 1 to most. */
MatrixXd matrix(int n, double most, unsigned seed)
{
  std::srand(seed);
  const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(n, n)).householderQ();
  return Q * VectorXd::LinSpaced(n, 1.0, most).asDiagonal() * Q.transpose();
}

struct Pair {
  VectorXd s, y;
};

/** H f by pairs, the oldest one first (J. Nocedal, Math. Comput. 35 (1980) 773). */
VectorXd recursion(const std::deque<Pair> &pairs, const MatrixXd &H0, VectorXd f)
{
  std::vector<double> along(pairs.size());
  for (std::size_t k = pairs.size(); k-- > 0;) {
    along[k] = pairs[k].s.dot(f) / pairs[k].s.dot(pairs[k].y);
    f -= along[k] * pairs[k].y;
  }
  VectorXd d = H0 * f;
  for (std::size_t k = 0; k < pairs.size(); k++)
    d += (along[k] - pairs[k].y.dot(d) / pairs[k].s.dot(pairs[k].y)) * pairs[k].s;
  return d;
}

// more pairs than there is room for, parts of corrections, several sequences with other forces
TEST(QuasiNewton, IsTheRecursion)
{
  QuasiNewton method;    // the same for systems that grow
  for (const int n : {3, 37, 64}) {
    const MatrixXd A = matrix(n, 4.0, 1), H0 = matrix(n, 1.5, 2).inverse();
    for (int again = 0; again < 2; again++) {    // start() forgets
      method.start(n);
      std::deque<Pair> pairs;
      VectorXd d(n), z;
      for (int sequence = 0; sequence < 12; sequence++) {
        VectorXd f = VectorXd::Random(n), s, last;
        for (int k = 0; k < 4; k++) {
          z = H0 * f;
          if (k > 0) {
            method.moved(s.data());
            pairs.push_back({s, last - f});
          }
          if ((int) pairs.size() > QuasiNewton::MOST) pairs.pop_front();
          if (k == 3) {
            method.settle(f.data(), z.data());
            break;
          }
          method.correct(f.data(), z.data(), d.data());
          const VectorXd exact = recursion(pairs, H0, f);
          EXPECT_LT((d - exact).norm() / exact.norm(), 1e-8) << n;
          EXPECT_EQ(method.pairs(), (int) pairs.size());
          s = (k == 1 ? 0.5 : 1.0) * d;
          last = f;
          f -= A * s;
        }
      }
    }
  }
}

// the last motion is H times its change of forces; what has no positive curvature is no pair
TEST(QuasiNewton, KnowsItsLastMotion)
{
  const int n = 21;
  const MatrixXd A = matrix(n, 4.0, 3), H0 = MatrixXd::Identity(n, n);
  QuasiNewton method;
  method.start(n);
  VectorXd f = VectorXd::Random(n), d(n), y(n);
  for (int k = 0; k < 5; k++) {
    method.correct(f.data(), f.data(), d.data());
    y = A * d;
    f -= y;
    method.moved(d.data());
  }
  const VectorXd s = d;
  method.settle(f.data(), f.data());
  method.correct(y.data(), y.data(), d.data());
  EXPECT_LT((d - s).norm(), 1e-12 * s.norm());

  const int before = method.pairs();
  method.moved(s.data());
  const VectorXd grown = y + A * s;    // forces against the motion become larger
  method.settle(grown.data(), grown.data());
  EXPECT_EQ(method.pairs(), before);
}

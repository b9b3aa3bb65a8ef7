// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Pairs of motions and forces for a matrix: against Nocedal's recursion and the secant equation.

#include "solve/quasi_newton.h"

#include "gtest/gtest.h"

#include <Eigen/Dense>

#include <deque>

using namespace MPM_NS;

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
  for (const int n : {3, 37, 64}) {
    const MatrixXd A = matrix(n, 4.0, 1), H0 = matrix(n, 1.5, 2).inverse();
    QuasiNewton method;
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

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: unit

// The shortest least-squares solution against Eigen's, for regular and for singular matrices.

#include "math/least_squares.h"

#include "gtest/gtest.h"

#include <Eigen/Dense>

#include <random>

using namespace MPM_NS;

TEST(LeastSquares, AgreesWithEigen)
{
  std::mt19937 random(7);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 300; trial++) {
    const int n = 1 + trial % 6, rank = trial % 3 ? n : n / 2;
    Eigen::MatrixXd left(n, rank), right(rank, n);
    Eigen::VectorXd b(n);
    for (int i = 0; i < n; i++) {
      b[i] = number(random);
      for (int k = 0; k < rank; k++) {
        left(i, k) = number(random);
        right(k, i) = number(random);
      }
    }
    const Eigen::MatrixXd A = 1e9 * left * right;
    double columns[6][6], x[6];
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) columns[j][i] = A(i, j);
    least_squares<6>(n, columns, b.data(), x);
    const Eigen::VectorXd mine = Eigen::Map<Eigen::VectorXd>(x, n);
    const Eigen::VectorXd theirs = A.completeOrthogonalDecomposition().solve(b);
    const Eigen::VectorXd sizes = A.jacobiSvd().singularValues();
    const double condition = rank ? sizes[0] / sizes[rank - 1] : 1.0;
    EXPECT_LE((mine - theirs).norm(), 1e-13 * condition * theirs.norm()) << "trial " << trial;
  }
}

TEST(LeastSquares, ZeroMatrix)
{
  double zero[3][3] = {}, b[3] = {1.0, 2.0, 3.0}, x[3];
  least_squares<3>(3, zero, b, x);
  for (double value : x) EXPECT_EQ(value, 0.0);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Multigrid for the stiffness of B-splines: symmetry, exact solutions, iterations for any size.

#include "long_case.h"
#include "solid_scenes.h"
#include "thread_ranks.h"

#include "solve/envelope_factors.h"
#include "solve/rim_factors.h"
#include "solve/shared_nodes.h"

#include "gtest/gtest.h"

#include <Eigen/Dense>

#include <array>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

using namespace MPM_NS;

void clamp(double (*P)[3])
{
  for (int a = 0; a < 3; a++) P[a][a] = 0.0;
}

/** A square (or cube) of side 1 that is held at its left side, with n spacings along it. */
SolidScene block(int dim, int n)
{
  SolidScene scene{dim, 1.0 / n, {0.0, 0.0, 0.0}, {1.0, 1.0, dim == 3 ? 1.0 : 0.0}};
  scene.hold = [](const double *x, double(*P)[3]) {
    if (x[0] < 1e-9) clamp(P);
  };
  return scene;
}

double weight(const double *, int a)
{
  return a == 1 ? -1.0 : 0.0;
}

/** Products that conjugate gradients need for two decades, from those for eight; true solutions. */
double products(SolidSystem &system)
{
  system.setup();
  const auto b = system.forces(weight);
  auto x = system.zeros(), Ax = system.zeros();
  system.napply = 0;
  const auto report = system.solve(b, x, {1e-8, 0.0, 400});
  EXPECT_TRUE(report.converged()) << report.describe();
  const double needed = system.napply / 4.0;
  system.apply(x.data(), Ax.data());
  for (std::size_t k = 0; k < b.size(); k++) Ax[k] -= b[k];
  EXPECT_LT(std::sqrt(system.product(Ax.data(), Ax.data())), 2e-8 * report.right_side);
  return needed;
}

double products(const SolidScene &scene)
{
  SolidSystem system(scene);
  return products(system);
}

/** A plane with a slope of 3/4, on which nodes slide, up to a stop. */
SolidScene slope(int n)
{
  SolidScene scene = block(2, n);
  scene.inside = [](const double *x) {
    return x[1] > 0.75 * x[0];
  };
  scene.hold = [](const double *x, double(*P)[3]) {
    const double normal[2] = {-0.6, 0.8};
    if (x[1] - 0.75 * x[0] < 0.05)
      for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) P[a][b] = (a == b) - normal[a] * normal[b];
    if (x[0] > 0.95 && x[1] < 0.9) {
      clamp(P);
      P[0][1] = P[1][0] = 0.0;
    }
  };
  return scene;
}

// Symmetric and positive definite, with constraints off the axes, masses, an odd period, in 3d.
TEST(SplineMultigrid, IsSymmetric)
{
  auto ring = block(2, 13);
  ring.periodic[1] = true;
  auto heavy = slope(12);
  heavy.density = 30.0;
  auto whole = heavy, whole_ring = ring, whole_cube = block(3, 3);
  for (auto *scene : {&whole, &whole_ring, &whole_cube}) scene->all = 12000;
  for (const auto &scene : {slope(20), heavy, ring, block(3, 3), whole, whole_ring, whole_cube}) {
    SolidSystem system(scene);
    system.setup();
    const auto noise = [&](int seed) {
      auto a = system.forces([&](const double *x, int d) {
        return std::sin(seed + 37.0 * x[0] + 51.0 * x[1] + 17.0 * x[2] * seed + d);
      });
      return a;
    };
    const auto a = noise(1), b = noise(2);
    auto Ma = system.zeros(), Mb = Ma, PMa = Ma;
    system.precondition(a.data(), Ma.data());
    system.precondition(b.data(), Mb.data());
    const double aa = system.product(a.data(), Ma.data());
    EXPECT_GT(aa, 0.0);
    EXPECT_NEAR(system.product(a.data(), Mb.data()), system.product(b.data(), Ma.data()),
                1e-10 * aa);
    // what is held stays
    system.project(Ma.data(), PMa.data());
    double size = 0.0;
    for (const double value : Ma) size = std::max(size, std::fabs(value));
    for (std::size_t k = 0; k < Ma.size(); k++) EXPECT_NEAR(PMa[k], Ma[k], 1e-12 * size);
  }
}

// Constraints that differ from none by round-off alone: what they make of coarse levels is the
// same.
TEST(SplineMultigrid, ConstraintsThatHoldNothing)
{
  for (const int dim : {2, 3}) {
    auto scene = block(dim, dim == 2 ? 12 : 3), same = scene;
    scene.density = same.density = 0.5;
    same.hold = [hold = scene.hold](const double *x, double(*P)[3]) {
      hold(x, P);
      if (x[0] < 1e-9 || x[1] < 0.4) return;
      for (int a = 0; a < 3; a++) P[a][a] = 1.0 - 1e-15;
    };
    SolidSystem plain(scene), held(same);
    plain.setup();
    held.setup();
    const auto b = plain.forces([](const double *x, int a) {
      return std::sin(1.0 + 37.0 * x[0] + 51.0 * x[1] + 17.0 * x[2] + a);
    });
    auto x = plain.zeros(), y = x;
    plain.precondition(b.data(), x.data());
    held.precondition(b.data(), y.data());
    double size = 0.0;
    for (const double value : x) size = std::max(size, std::fabs(value));
    for (std::size_t k = 0; k < x.size(); k++) EXPECT_NEAR(y[k], x[k], 1e-11 * size) << dim;
  }
}

// A bar pulled by its own weight, without lateral strain: u' = g (1 - x)/M, exact.
TEST(SplineMultigrid, BarUnderItsWeight)
{
  auto scene = block(2, 24);
  scene.periodic[1] = true;
  // spans of quadratic functions end between nodes
  scene.low[0] = -0.5 / 24;
  scene.high[0] = 1.0 - 0.5 / 24;
  scene.hold = [](const double *x, double(*P)[3]) {
    if (x[0] < -1e-9) clamp(P);
  };
  SolidSystem system(scene);
  system.setup();
  const auto b = system.forces([](const double *, int a) {
    return a == 0 ? 1.0 : 0.0;
  });
  auto x = system.zeros();
  ASSERT_TRUE(system.solve(b, x, {1e-12, 0.0, 200}).converged());
  const double M = (1.0 - 0.3) / (1.3 * 0.4);
  // displacement of the free end less that of the middle: (1/8)/M, within the square of the spacing
  double u[2] = {0.0, 0.0};
  for (std::size_t p = 0; p < system.npoints(); p++) {
    const auto &point = system.points[p];
    for (int k = 0; k < 2; k++) {
      const double place = k ? 1.0 - 0.75 / 24 : 0.5 - 0.75 / 24;
      if (std::fabs(point.x[0] - place) > 1e-9 || point.x[1] > 0.25 / 24) continue;
      for (int i = 0; i < system.nnodes; i++)
        u[k] += system.weights[p * system.nnodes + i] * x[2 * system.nodes[p * system.nnodes + i]];
    }
  }
  // places 0.25 spacings from the free end, at 1 - 0.5/24
  const auto exact = [&](double place) {
    const double from_end = 1.0 - 0.5 / 24 - place;
    return -0.5 * from_end * from_end / M;
  };
  EXPECT_NEAR(u[1] - u[0], exact(1.0 - 0.75 / 24) - exact(0.5 - 0.75 / 24), 1.0 / (24 * 24 * M));
}

// Products with the matrix for two decades: at most 25 (each is one pass from points to nodes, for
// which this is the bound that the solver was built for), and as many for 64 times as many points.
TEST(SplineMultigrid, ProductsDoNotGrow)
{
  double coarsest = 0.0;
  for (const int n : {8, 16, 32, 64}) {
    const double needed = products(block(2, n));
    if (n == 8) coarsest = needed;
    EXPECT_LE(needed, 25.0) << n;
    EXPECT_LE(needed, 1.3 * coarsest) << n;
  }
}

// The same with five levels, in 3d with three: coarse levels have the smoother of the finest one.
TEST(SplineMultigrid, ManyLevels)
{
  auto many = block(2, 64);
  many.few = 50;
  SolidSystem system(many);
  EXPECT_LE(products(system), 25.0);
  EXPECT_GE(system.multigrid->levels(), 5);
  auto ring = block(2, 33);
  ring.periodic[1] = true;
  ring.few = 50;
  EXPECT_LE(products(ring), 25.0);
  auto cube = block(3, 4);
  cube.few = 250;
  SolidSystem solid(cube);
  EXPECT_LE(products(solid), 25.0);
  EXPECT_EQ(solid.multigrid->levels(), 3);
}

TEST(SplineMultigrid, ProductsOfHardCases)
{
  // stiffnesses in a ratio from place to place: interfaces are factorized like surfaces
  const auto patches = [](int dim, int n, double ratio) {
    auto scene = block(dim, n);
    scene.young = [ratio](const double *x) {
      return ((int) (4.0 * x[0]) + (int) (4.0 * x[1]) + (int) (4.0 * x[2])) % 2 ? ratio : 1.0;
    };
    return products(scene);
  };
  EXPECT_LE(patches(2, 16, 10.0), 25.0);
  EXPECT_LE(patches(2, 16, 100.0), 20.0);
  EXPECT_LE(patches(2, 48, 1e4), std::min(22.0, 1.3 * patches(2, 16, 1e4)));
  if (!MPM_TEST::is_quick()) EXPECT_LE(patches(3, 11, 1e4), 25.0);    // takes long
  // cells that the surface cuts anywhere: a disk that is held in its middle
  auto disk = block(2, 22);
  disk.inside = [](const double *x) {
    return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.45;
  };
  disk.hold = [](const double *x, double(*P)[3]) {
    if (std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.1) clamp(P);
  };
  EXPECT_LE(products(disk), 25.0);
  EXPECT_LE(products(slope(24)), 25.0);
  // strips two spacings thick
  for (const int n : {40, 120}) {
    auto strip = block(2, n);
    strip.high[1] = 2.0 / n;
    EXPECT_LE(products(strip), 25.0) << n;
  }
  // time steps: what is heavy needs less
  auto heavy = block(2, 20);
  heavy.density = 1e4;
  EXPECT_LE(products(heavy), 10.0);
  auto linear = block(2, 20);
  linear.order = 1;
  EXPECT_LE(products(linear), 25.0);
  EXPECT_LE(products(block(3, 3)), 25.0);
}

// Levels of multigrid change the way and not the answer. Blocks of nodes as preconditioner need
// many times the products. Energies are compared, as no point sees some motions of nodes.
TEST(SplineMultigrid, SameSolutionAsBlocks)
{
  SolidSystem system(slope(16));
  const double needed = products(system);
  const auto b = system.forces(weight);
  auto x = system.zeros(), y = system.zeros();
  ASSERT_TRUE(system.solve(b, x, {1e-11, 0.0, 400}).converged());
  system.preconditioner = SolidSystem::BLOCKS;
  const auto report = system.solve(b, y, {1e-11, 0.0, 4000});
  ASSERT_TRUE(report.converged());
  const double energy = system.product(b.data(), y.data());
  EXPECT_NEAR(system.product(b.data(), x.data()), energy, 1e-9 * energy);
  EXPECT_GT(report.iterations, 3 * needed);
}

// Nothing holds a body: forces that balance only deform it, and are solved for.
TEST(SplineMultigrid, FreeBody)
{
  auto scene = block(2, 16);
  scene.hold = [](const double *, double(*)[3]) {
  };
  SolidSystem system(scene);
  system.setup();
  const auto b = system.forces([](const double *x, int a) {
    return a == 0 ? x[0] - 0.5 : 0.0;
  });
  auto x = system.zeros();
  const auto report = system.solve(b, x, {1e-8, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
}

// Systems of few unknowns are factorized as a whole: one iteration and what the shift of the
// diagonal costs, with slopes, masses, periodic axes, cut cells, and ratios of stiffness.
TEST(SplineMultigrid, FactorsOfAll)
{
  auto heavy = slope(12), patches = block(2, 16), ring = block(2, 13), cubic = block(2, 12);
  heavy.density = 30.0;
  patches.young = [](const double *x) {
    return ((int) (4.0 * x[0]) + (int) (4.0 * x[1])) % 2 ? 1e4 : 1.0;
  };
  ring.periodic[1] = true;
  cubic.order = 3;
  for (auto scene : {block(2, 16), slope(20), heavy, patches, ring, cubic, block(3, 3)}) {
    scene.all = 12000;
    SolidSystem system(scene);
    // those of eight decades, one of them before the first iteration
    EXPECT_LE(4.0 * products(system), 3.0);
    EXPECT_EQ(system.multigrid->levels(), 1);
  }
  auto large = block(2, 16);
  large.all = 2 * 18 * 18 - 1;
  SolidSystem system(large);
  system.setup();
  EXPECT_GT(system.multigrid->levels(), 1);
}

// Factors in an envelope against a dense matrix: any block, parts, and instruction sets.
TEST(EnvelopeFactors, SolveLikeDenseOnes)
{
  for (const char *isa : {"baseline", "avx2", "avx512"})
    for (const int n : {1, 2, 15, 16, 17, 48, 133}) {
      setenv("MPM_ISA", isa, 1);
      EnvelopeFactors factors;
      unsetenv("MPM_ISA");
      Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
      for (int k = 0; k < n; k++)
        for (const int l : {(7 * k + 4) % n, (k + 2) % n, (k + 12) % n}) {
          // two parts, of even and odd unknowns
          if (l == k || (k + l) % 2) continue;
          const double value = 1.0 + std::sin(k + 2.0 * l);
          A(k, l) -= value;
          A(l, k) -= value;
          A(k, k) += value;
          A(l, l) += value;
        }
      Eigen::VectorXd b(n), x(n);
      for (int k = 0; k < n; k++) b[k] = std::cos(3.0 * k);
      ASSERT_TRUE(factors.compute(A.sparseView())) << isa << ' ' << n;
      EXPECT_EQ(factors.size(), n);
      factors.solve(b.data(), x.data());
      EXPECT_LT((A * x - b).norm(), 1e-13 * A.norm() * b.norm()) << isa << ' ' << n;
      // in place
      Eigen::VectorXd same = b;
      factors.solve(same.data(), same.data());
      EXPECT_EQ((same - x).norm(), 0.0);
      A(n / 2, n / 2) = -1.0;
      EXPECT_FALSE(factors.compute(A.sparseView())) << isa << ' ' << n;
    }
}

/** A matrix on n by m points in pieces of so many columns, a shift apart from singular. */
Eigen::SparseMatrix<double> springs(int n, int m, int piece, double shift = 0.01)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto join = [&](int a, int b, double k) {
    for (const auto &[i, j, sign] :
         {std::array<int, 3>{a, a, 1}, {b, b, 1}, {a, b, -1}, {b, a, -1}})
      entries.emplace_back(i, j, sign * k);
  };
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) {
      entries.emplace_back(i * m + j, i * m + j, shift);
      if (j + 1 < m) join(i * m + j, i * m + j + 1, 1.0 + 0.5 * std::sin(i + 2.0 * j));
      if (i + 1 < n && (i + 1) % piece) join(i * m + j, (i + 1) * m + (j + 1) % m, 1.0);
    }
  Eigen::SparseMatrix<double> A(n * m, n * m);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

// Halves that are eliminated towards the middle: the same on any number of ranks, bit by bit, each
// with a half of the factors, and right in one piece, in pieces, and with small halves.
TEST(EnvelopeFactors, HalvesOnRanks)
{
  for (const auto &[n, m, piece] : {std::array<int, 3>{60, 9, 1000},
                                    {60, 16, 1000},    // as many in the middle as rows of a block
                                    {60, 9, 7},
                                    {40, 3, 1},
                                    {1, 1, 1},
                                    {2, 1, 5},
                                    {25, 25, 30}}) {
    const auto A = springs(n, m, piece);
    Eigen::VectorXd b(n * m), x(n * m);
    for (int k = 0; k < n * m; k++) b[k] = std::cos(3.0 * k);
    EnvelopeFactors one(nullptr, 0);
    ASSERT_TRUE(one.compute(A));
    ASSERT_TRUE(one.has_halves());
    one.solve(b.data(), x.data());
    EXPECT_LT((A * x - b).norm(), 1e-13 * b.norm()) << n << ' ' << m << ' ' << piece;
    auto other = A;
    other.coeffRef(n * m / 2, n * m / 2) = -1.0;
    EXPECT_FALSE(EnvelopeFactors(nullptr, 0).compute(other));
    EXPECT_FALSE(EnvelopeFactors(nullptr, 1000000).compute(other));

    for (const int nranks : {1, 2, 3}) {
      Threads team(nranks);
      std::vector<Eigen::VectorXd> of_ranks(nranks, b);
      std::vector<double> bytes(nranks);
      std::vector<char> good(nranks, 0);
      std::vector<std::thread> threads;
      for (int me = 0; me < nranks; me++)
        threads.emplace_back([&, me] {
          ThreadRank rank(team, me);
          EnvelopeFactors factors(&rank, 0);
          good[me] = factors.compute(A);
          bytes[me] = factors.memory_usage();
          // in place, and again
          factors.solve(of_ranks[me].data(), of_ranks[me].data());
          good[me] = good[me] && factors.compute_again(A) && !factors.compute_again(other);
        });
      for (auto &thread : threads) thread.join();
      for (int me = 0; me < nranks; me++) {
        EXPECT_TRUE(good[me]) << me << " of " << nranks;
        EXPECT_EQ((of_ranks[me] - x).norm(), 0.0) << me << " of " << nranks;
        if (nranks > 1 && n > 20) EXPECT_LT(bytes[me], 0.8 * one.memory_usage());
      }
    }
  }
}

// Where places are known, a compact body is put in planes, with halves or without, on any number of
// ranks; a slender one keeps its order.
TEST(EnvelopeFactors, PlanesOfCompactBodies)
{
  const auto cells = [](int nx, int ny, int nz, std::vector<LatticeIndex> &nodes) {
    std::vector<Eigen::Triplet<double>> entries;
    LatticeNodes all;
    for (int i = 0; i < nx; i++)
      for (int j = 0; j < ny; j++)
        for (int k = 0; k < nz; k++) all.add({i, j, k});
    for (int c = 0; c < (int) all.index.size(); c++)
      for (int d = 0; d < 125; d++) {
        const auto &at = all.index[c];
        const int other = all.find({at[0] + d / 25 - 2, at[1] + d / 5 % 5 - 2, at[2] + d % 5 - 2});
        if (other >= 0) entries.emplace_back(other, c, other == c ? 130.0 : -1.0);
      }
    nodes = all.index;
    Eigen::SparseMatrix<double> A(nodes.size(), nodes.size());
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
  };
  const auto check = [&](int nx, int ny, int nz, double most_memory) {
    std::vector<LatticeIndex> nodes;
    const auto A = cells(nx, ny, nz, nodes);
    Eigen::VectorXd b(A.rows()), x(A.rows());
    for (int k = 0; k < A.rows(); k++) b[k] = std::cos(3.0 * k);
    for (const int64_t split : {(int64_t) 0, (int64_t) 100000000}) {
      EnvelopeFactors layers(nullptr, split), planes(nullptr, split);
      planes.set_places(nodes, 1);
      ASSERT_TRUE(layers.compute(A) && planes.compute(A));
      EXPECT_EQ(planes.has_halves(), split == 0);
      EXPECT_LT(planes.memory_usage(), most_memory * layers.memory_usage()) << nx << ' ' << split;
      planes.solve(b.data(), x.data());
      EXPECT_LT((A * x - b).norm(), 1e-12 * b.norm()) << nx << ' ' << split;
    }
    Threads team(2);
    std::vector<Eigen::VectorXd> of_ranks(2, b);
    EnvelopeFactors one(nullptr, 0);
    one.set_places(nodes, 1);
    ASSERT_TRUE(one.compute(A));
    one.solve(b.data(), x.data());
    std::vector<std::thread> threads;
    for (int me = 0; me < 2; me++)
      threads.emplace_back([&, me] {
        ThreadRank rank(team, me);
        EnvelopeFactors factors(&rank, 0);
        factors.set_places(nodes, 1);
        if (factors.compute(A)) factors.solve(of_ranks[me].data(), of_ranks[me].data());
      });
    for (auto &thread : threads) thread.join();
    for (int me = 0; me < 2; me++) EXPECT_EQ((of_ranks[me] - x).norm(), 0.0) << me;
  };
  check(14, 14, 14, 0.8);
  check(3, 40, 4, 1.2);
  // planes are those across the longest axis, whichever it is
  const auto memory = [&](int nx, int ny, int nz) {
    std::vector<LatticeIndex> nodes;
    const auto A = cells(nx, ny, nz, nodes);
    EnvelopeFactors factors(nullptr, 100000000);
    factors.set_places(nodes, 1);
    EXPECT_TRUE(factors.compute(A));
    return factors.memory_usage();
  };
  const double first = memory(16, 11, 8);
  for (const double other : {memory(8, 16, 11), memory(11, 8, 16), memory(8, 11, 16)})
    EXPECT_NEAR(other, first, 0.01 * first);
}

// Factors in single precision are those of a matrix that is near along every direction, soft ones,
// too, in half of the memory: with halves or without, and with all instruction sets.
TEST(EnvelopeFactors, RoundedOnes)
{
  constexpr int N = 60, M = 9;
  for (const char *isa : {"baseline", "avx2", "avx512"})
    for (const int64_t split : {(int64_t) 0, EnvelopeFactors::ENOUGH})
      for (const double shift : {1.0, 1e-10}) {
        setenv("MPM_ISA", isa, 1);
        EnvelopeFactors whole(nullptr, split), rounded(nullptr, split, EnvelopeFactors::ROUNDED);
        unsetenv("MPM_ISA");
        const auto A = springs(N, M, 1000, shift);
        ASSERT_TRUE(whole.compute(A));
        ASSERT_TRUE(rounded.compute(A));
        EXPECT_LT(rounded.memory_usage(), 0.6 * whole.memory_usage());
        for (const double waves : {0.0, 1.0, 17.3}) {
          Eigen::VectorXd b(N * M), x(N * M), other(N * M);
          for (int k = 0; k < N * M; k++) b[k] = std::cos(waves * k);
          whole.solve(b.data(), x.data());
          rounded.solve(b.data(), other.data());
          // b^T A^-1 b
          EXPECT_LT(std::abs(b.dot(other) / b.dot(x) - 1.0), 0.01) << isa << ' ' << shift;
          if (shift == 1.0) {
            EXPECT_LT((A * other - b).norm(), 1e-6 * b.norm()) << isa << ' ' << waves;
            EXPECT_GT((A * other - b).norm(), 1e-11 * b.norm()) << isa << ' ' << waves;
          }
        }
        // again from doubles
        ASSERT_TRUE(rounded.compute_again(A));
        Eigen::VectorXd b = Eigen::VectorXd::Ones(N * M), x = b;
        rounded.solve(x.data(), x.data());
        EXPECT_LT(std::abs(b.dot(x) * shift / (N * M) - 1.0), 0.01) << isa << ' ' << shift;
      }
}

// Nodes come to other ranks, which know some, and keep their places; not if one is missing or new.
TEST(SharedNodes, KeepTheirOrder)
{
  constexpr int NRANKS = 3, N = 20, NONE = -1;
  // the rank that owns node i, before and after
  const auto before = [](int i) {
    return i * NRANKS / N;
  };
  const auto after = [](int i) {
    return (i * i + 1) % NRANKS;
  };
  const auto lost = [&](int i) {
    return i == 7 ? NONE : after(i);
  };
  Threads team(NRANKS);
  std::vector<std::string> wrong(NRANKS);
  std::vector<std::thread> threads;
  for (int me = 0; me < NRANKS; me++)
    threads.emplace_back([&, me] {
      ThreadRank rank(team, me);
      SharedNodes shared(rank);
      std::vector<double> values, first, all;
      const auto list = [&](const auto &owner, int shift) {
        std::vector<LatticeIndex> mine, others;
        values.clear();
        for (int i = 0; i < N; i++) {
          const LatticeIndex index{i % 5, i / 5, i == 3 ? shift : 0};
          if (owner(i) == me) {
            mine.push_back(index);
            values.insert(values.end(), {10.0 * i, 10.0 * i + 1.0});
          } else if (owner(i) != NONE && i % 2)
            others.push_back(index);
        }
        const std::size_t owned = mine.size();
        mine.insert(mine.end(), others.begin(), others.end());
        return std::make_pair(mine, owned);
      };
      const auto expect = [&](bool good, const char *what) {
        if (!good) wrong[me] += what;
      };
      const auto begin = list(before, 0);
      shared.number(begin.first, begin.second);
      expect(shared.size() == N, "size ");
      shared.gather(values, 2, first);
      for (const auto &[owner, shift, same] :
           {std::make_tuple(std::function<int(int)>(after), 0, true),
            {lost, 0, false},
            {after, 1, false}}) {
        const auto now = list(owner, shift);
        expect(shared.renumber(now.first, now.second) == same, "renumber ");
        if (!same) continue;
        shared.gather(values, 2, all);
        expect(all == first, "gather ");
        for (std::size_t k = 0; k < now.first.size(); k++)
          expect(shared.indices()[shared.places()[k]] == now.first[k], "places ");
      }
    });
  for (auto &thread : threads) thread.join();
  for (int me = 0; me < NRANKS; me++) EXPECT_EQ(wrong[me], "") << me;
}

// Matrices that are not positive definite have factors with a shift, if they are not far from it.
TEST(RimFactors, AreThereOrSaySo)
{
  const auto factors_of = [](double diagonal, double other) {
    Eigen::SparseMatrix<double> A(2, 2);
    const std::vector<Eigen::Triplet<double>> entries = {
        {0, 0, diagonal}, {1, 1, diagonal}, {0, 1, other}, {1, 0, other}};
    A.setFromTriplets(entries.begin(), entries.end());
    EnvelopeFactors factors;
    const bool there = factorize(A, factors);
    if (there) {
      // what is factorized is positive definite, in all directions
      for (double angle = 0.0; angle < 3.14; angle += 0.1) {
        const double b[2] = {std::cos(angle), std::sin(angle)};
        double x[2];
        factors.solve(b, x);
        EXPECT_GT(x[0] * b[0] + x[1] * b[1], 0.0);
      }
      EXPECT_GE(factors.memory_usage(), 3 * sizeof(double));
    }
    return there;
  };
  EXPECT_TRUE(factors_of(1.0, 0.5));
  EXPECT_TRUE(factors_of(1.0, 1.0));
  EXPECT_TRUE(factors_of(1.0, 3.0));
  EXPECT_FALSE(factors_of(1.0, 1e9));
  EXPECT_FALSE(factors_of(1.0, std::numeric_limits<double>::quiet_NaN()));
}

// Points whose stiffness is not finite: levels are of no use, and it is said.
TEST(SplineMultigrid, IsUsableOrSaysSo)
{
  for (const double E : {2.0, std::numeric_limits<double>::infinity()}) {
    auto scene = block(2, 16);
    scene.young = [E](const double *x) {
      return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.1 ? E : 1.0;
    };
    SolidSystem system(scene);
    system.setup();
    EXPECT_EQ(system.multigrid->usable(), std::isfinite(E));
    // what it holds at least: factors and blocks of all nodes
    EXPECT_GT(system.multigrid->memory_usage(), 8.0 * system.size() * 4.0);
  }
}

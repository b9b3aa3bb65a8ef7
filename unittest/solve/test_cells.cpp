// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Poisson's equation on cells and its multigrid: equations as written, exact pressures, iterations.

#include "cell_scenes.h"

#include "gtest/gtest.h"

#include <limits>

using namespace MPM_NS;

double largest_difference(const CellSystem &system, const std::vector<double> &a,
                          const std::vector<double> &b)
{
  double largest = 0.0;
  for (int64_t node = 0; node < system.size(); node++)
    largest = std::max(largest, std::fabs(a[node] - b[node]));
  return largest;
}

/** An odd shape: fractional faces, an odd period, indices below 0, and three dimensions. */
CellScene odd_scene(int dim)
{
  CellScene scene{dim, 11};
  scene.wet = [dim](const double *x) {
    return x[1] < 0.6 + 0.2 * std::cos(6.28 * x[0]) && (dim == 2 || x[2] + x[0] < 1.3);
  };
  scene.open = [](const int *i, int d) {
    return 0.3 + 0.1 * ((3 * i[0] + 5 * i[1] + 7 * i[2] + 2 * d + 1000) % 17);
  };
  scene.periodic[0] = true;
  scene.shift[1] = -5;
  scene.shift[2] = -3;
  return scene;
}

// A x is what the equations say, written down by index; faces that images have, too, count once.
TEST(CellOperator, IsTheEquations)
{
  for (const int dim : {2, 3}) {
    CellSystem system(odd_scene(dim));
    const auto &scene = system.scene;
    const auto value = [&](const int *i) {
      int c[3] = {i[0], i[1], i[2]};
      for (int d = 0; d < dim; d++) c[d] = system.grid.lattice.wrap(d, c[d]);
      return scene.is_wet(c) ? CellSystem::noise_at(c, 3) : 0.0;
    };
    const auto x = system.values(value);
    auto y = system.zeros();
    system.apply(x.data(), y.data());
    const auto expected = system.values([&](const int *i) {
      double sum = 0.0;
      if (!scene.is_wet(i)) return sum;
      for (int d = 0; d < dim; d++)
        for (int side = -1; side <= 1; side += 2) {
          int other[3] = {i[0], i[1], i[2]};
          other[d] += side;
          sum += scene.face(side < 0 ? other : i, d) * (value(i) - value(other));
        }
      return sum;
    });
    EXPECT_LT(largest_difference(system, y, expected), 1e-13) << dim;
  }
}

// A sweep comes to each cell once: all have a color, that of the sum of their index.
TEST(CellGraph, EachCellHasAColor)
{
  CellGraph graph;
  for (int n = 0; n < 27; n++) {
    for (const int i : {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}) graph.index.push_back(i);
    graph.where.push_back(n);
  }
  graph.color();
  EXPECT_EQ(graph.colored[0].size(), 13u);
  EXPECT_EQ(graph.colored[1].size(), 14u);
  for (const int color : {0, 1})
    for (const int n : graph.colored[color]) EXPECT_EQ((n / 9 + n / 3 % 3 + n % 3 + 3) & 1, color);
}

// Conjugate gradients need a symmetric and positive definite preconditioner, also for odd periods.
TEST(CellMultigrid, IsSymmetric)
{
  for (const int dim : {2, 3})
    for (const int n : {11, 23, 58}) {
      auto scene = odd_scene(dim);
      scene.n = n;
      if (dim == 3 && n > 11) continue;
      CellSystem system(scene);
      auto a = system.noise(1), b = system.noise(2), Ma = system.zeros(), Mb = system.zeros();
      system.precondition(a.data(), Ma.data());
      system.precondition(b.data(), Mb.data());
      const double ab = system.product(a.data(), Mb.data()),
                   ba = system.product(b.data(), Ma.data());
      const double aa = system.product(a.data(), Ma.data());
      EXPECT_NEAR(ab, ba, 1e-12 * aa);
      EXPECT_GT(aa, 0.0);
    }
}

// Iterations to 1e-8 are at most 1.5 times those of conjugate gradients that are preconditioned by
// cosine transforms of the box. With levels that are discretizations of the same equation they do
// not depend on the number of cells: 64 times as many are allowed two more.
TEST(CellMultigrid, Iterations)
{
  struct Shape {
    const char *name;
    std::function<bool(const double *)> wet;
    int transforms[4];
  };
  const Shape shapes[] = {{"sloping", sloping, {14, 18, 22, 31}},
                          {"disk", disk, {15, 19, 25, 33}},
                          {"splash", splash(), {28, 39, 53, 73}}};
  for (const auto &shape : shapes) {
    int coarsest = 0;
    for (int k = 0; k < 4; k++) {
      CellScene scene{2, 32 << k};
      scene.wet = shape.wet;
      CellSystem system(scene);
      const int iterations = system.iterations();
      EXPECT_LE(iterations, 1.5 * shape.transforms[k]) << shape.name << " " << scene.n;
      if (k == 0) coarsest = iterations;
      EXPECT_LE(iterations, coarsest + 2) << shape.name << " " << scene.n;
      RecordProperty(shape.name + std::to_string(scene.n), iterations);
    }
  }
}

// With the diagonal alone they are those of plain conjugate gradients: 116 and 231 for the tank.
TEST(CellOperator, IterationsWithTheDiagonal)
{
  CellScene scene{2, 32};
  scene.wet = sloping;
  CellSystem coarse(scene);
  scene.n = 64;
  CellSystem fine(scene);
  for (auto *system : {&coarse, &fine}) system->preconditioner = CellSystem::DIAGONAL;
  EXPECT_NEAR(coarse.iterations(), 116, 12);
  EXPECT_NEAR(fine.iterations(), 231, 23);
}

// Iterations in 3d, with densities that differ by 1 to 1e4 from place to place, and in a labyrinth.
// There are no reference values for these: 21 and 27 are 1.5 times those by cosine transforms in
// the sloping tank of 32 and of 64 cells, to which part O7 of the reference values binds that tank,
// and 1.45 is the growth that it allows when spacings are halved. Measured are 11, 11, and 1.2, and
// 14 in the labyrinth, where conjugate gradients alone take as many as its way is long.
TEST(CellMultigrid, IterationsOfHardCases)
{
  CellScene ball{3, 24};
  ball.wet = [](const double *x) {
    return std::hypot(x[0] - 0.5, x[1] - 0.5, x[2] - 0.5) < 0.4;
  };
  EXPECT_LE(CellSystem(ball).iterations(), 21);

  int least = 1000, most = 0;
  for (const double jump : {1.0, 1e1, 1e2, 1e3, 1e4}) {
    CellScene tank{2, 64};
    tank.wet = sloping;
    tank.open = [=](const int *i, int d) {
      const auto density = [&](int j, int k) {
        return (j / 8 + k / 8) % 2 ? jump : 1.0;
      };
      return 2.0 / (density(i[0], i[1]) + density(i[0] + (d == 0), i[1] + (d == 1)));
    };
    const int iterations = CellSystem(tank).iterations();
    least = std::min(least, iterations);
    most = std::max(most, iterations);
  }
  EXPECT_LE(most, 27);
  EXPECT_LE(most, 1.45 * least);

  // walls between cells, with gaps at ends in turns: large cells must not join both sides
  CellScene labyrinth{2, 64};
  labyrinth.open = [](const int *i, int d) {
    return d == 1 && i[1] % 3 == 0 && (i[1] % 2 ? i[0] > 0 : i[0] < 63) ? 0.0 : 1.0;
  };
  CellSystem winding(labyrinth);
  EXPECT_EQ(winding.multigrid.closed_pools(), 1);
  EXPECT_LE(winding.iterations(), 60);
}

// A tank under gravity, open at the top: pressure is the depth, exactly, also with shares of faces.
TEST(CellMultigrid, WaterAtRest)
{
  for (const int dim : {2, 3}) {
    CellScene tank{dim, dim == 2 ? 37 : 13};
    tank.wet = [&](const double *x) {
      return x[1] < 0.7;
    };
    tank.open = [](const int *i, int d) {
      return d == 1 ? 0.4 + 0.3 * (i[0] % 3) : 1.0;
    };
    CellSystem system(tank);
    const int top = (int) std::ceil(0.7 * tank.n - 0.5);    // first dry row
    const auto exact = system.values([&](const int *i) {
      return std::max(0.0, (double) top - i[1]);
    });
    auto b = system.zeros(), x = system.zeros();
    system.apply(exact.data(), b.data());
    for (int64_t node = 0; node < system.size(); node++) {
      int i[3];
      system.grid.node_index(node, i);
      // flows balance but at the bottom, where there is no face for the gradient of the pressure
      if (system.scene.is_wet(i) && i[1] > 0) { EXPECT_NEAR(b[node], 0.0, 1e-12); }
    }
    const auto report = system.solve(b, x, {1e-12, 0.0, 100});
    EXPECT_TRUE(report.converged()) << report.describe();
    EXPECT_LT(largest_difference(system, x, exact), 1e-9 * top);

    // a first guess changes nothing of the answer
    auto again = system.noise(7);
    EXPECT_TRUE(system.solve(b, again, {1e-12, 0.0, 100}).converged());
    EXPECT_LT(largest_difference(system, again, exact), 1e-9 * top);
  }
}

// A pool without a surface between thin walls, next to one with a surface: they share larger cells,
// and no water. 30 iterations to 1e-12 are 1.5 times the 14 by cosine transforms to 1e-8.
TEST(CellMultigrid, Pools)
{
  CellScene two{2, 30};
  two.wet = [](const double *x) {
    return x[0] < 0.5 || x[1] < 0.45;
  };
  two.open = [](const int *i, int d) {
    return d == 0 && i[0] == 14 ? 0.0 : 1.0;
  };
  CellSystem system(two);
  EXPECT_EQ(system.multigrid.closed_pools(), 1);
  const auto left = [](const int *i) {
    return i[0] <= 14;
  };
  auto exact = system.noise(4), b = system.zeros(), x = system.zeros();
  system.multigrid.project(exact.data());
  system.apply(exact.data(), b.data());
  double mean = 0.0;
  for (int64_t node = 0; node < system.size(); node++) {
    int i[3];
    system.grid.node_index(node, i);
    if (left(i)) mean += exact[node];
  }
  EXPECT_NEAR(mean, 0.0, 1e-11);
  auto report = system.solve(b, x, {1e-12, 0.0, 100});
  EXPECT_TRUE(report.converged()) << report.describe();
  EXPECT_LE(report.iterations, 30);
  EXPECT_LT(largest_difference(system, x, exact), 1e-9);

  // a source that a closed pool cannot have is taken out there, and only there
  auto source = system.values([&](const int *i) {
    return system.scene.is_wet(i) ? 0.25 : 0.0;
  });
  EXPECT_NEAR(system.multigrid.project(source.data()), 0.25, 1e-14);
  for (int64_t node = 0; node < system.size(); node++) {
    int i[3];
    system.grid.node_index(node, i);
    if (system.scene.in_box(i)) {
      EXPECT_NEAR(source[node], system.scene.is_wet(i) && !left(i) ? 0.25 : 0.0, 1e-14);
    }
  }
  report = system.solve(source, x);
  EXPECT_TRUE(report.converged()) << report.describe();
}

// Cells of their own: with a surface (4 p = b), within walls (not in the system); and a box that is
// closed and periodic, where 15 iterations are about those by cosine transforms in the sloping tank
// (14); 10 are measured.
TEST(CellMultigrid, CellsOfTheirOwn)
{
  CellScene drops{2, 9};
  drops.wet = [](const double *x) {
    const int i = (int) (9 * x[0]), j = (int) (9 * x[1]);
    return j == 4 && (i == 2 || i == 6);
  };
  drops.open = [](const int *i, int) {
    return std::abs(i[0] - 6) <= 1 ? 0.0 : 1.0;
  };
  CellSystem system(drops);
  auto b = system.noise(2), x = system.zeros();
  system.multigrid.project(b.data());
  EXPECT_TRUE(system.solve(b, x).converged());
  const int one[3] = {2, 4, 0}, other[3] = {6, 4, 0};
  EXPECT_NEAR(x[system.grid.locate(one)], 0.25 * CellSystem::noise_at(one, 2), 1e-14);
  EXPECT_EQ(x[system.grid.locate(other)], 0.0);
  EXPECT_EQ(system.multigrid.closed_pools(), 0);

  CellScene full{2, 25};
  full.periodic[0] = full.periodic[1] = true;
  CellSystem closed(full);
  EXPECT_EQ(closed.multigrid.closed_pools(), 1);
  EXPECT_LE(closed.iterations(), 15);

  CellScene nothing{2, 8};
  nothing.wet = [](const double *) {
    return false;
  };
  CellSystem dry(nothing);
  EXPECT_EQ(dry.iterations(), 0);
}

// An air bubble of pressure 3 in a tank that has no other surface: the pressure is 3 everywhere.
TEST(CellMultigrid, BubbleWithPressure)
{
  CellScene tank{2, 48};
  tank.wet = [](const double *x) {
    return !disk(x);
  };
  CellSystem system(tank);
  EXPECT_EQ(system.multigrid.closed_pools(), 0);
  auto b = system.zeros(), x = system.zeros();
  for (int64_t node = 0; node < system.size(); node++) b[node] = 3.0 * system.A.outside[node];
  EXPECT_TRUE(system.solve(b, x, {1e-12, 0.0, 100}).converged());
  for (int64_t node = 0; node < system.size(); node++) {
    int i[3];
    system.grid.node_index(node, i);
    EXPECT_NEAR(x[node], system.scene.is_wet(i) ? 3.0 : 0.0, 1e-9);
  }
}

// A column of water that is released: pressures of benchmark O6, by a series, with surfaces where
// cells end. Half a spacing from there the distance to them is half as long.
TEST(CellMultigrid, ReleasedColumn)
{
  double error[2];
  for (int k = 0; k < 2; k++) {
    const int n = 32 << k;
    CellScene column{2, n};
    CellSystem closed(column);
    auto &A = closed.A;
    // right and top are surfaces
    for (int i = 0; i < n; i++) {
      const int right[3] = {n - 1, i, 0}, top[3] = {i, n - 1, 0};
      A.outside[closed.grid.locate(right)] += 2.0;
      A.outside[closed.grid.locate(top)] += 2.0;
    }
    A.finish();
    closed.multigrid.setup(A);
    // acceleration -1 in each face along y but walls: div a = grad p balance at the bottom row
    auto b = closed.values([&](const int *i) {
      return i[1] == 0 ? 1.0 / n : 0.0;
    });
    auto x = closed.zeros();
    ASSERT_TRUE(closed.solve(b, x, {1e-11, 0.0, 100}).converged());
    // to the corner, linearly along y with slope -1 and evenly along x
    const int corner[3] = {0, 0, 0};
    error[k] = std::fabs(x[closed.grid.locate(corner)] + 0.5 / n - 0.675314);
  }
  EXPECT_LT(error[0], 0.01 * 0.675314);
  EXPECT_GT(std::log2(error[0] / error[1]), 0.9);
}

// What is known outside counts infinitely, without factors: the next level is left out then.
TEST(CellMultigrid, IsUsableOrSaysSo)
{
  CellSystem system(CellScene{2, 32});
  const int top[3] = {7, 31, 0};
  auto &outside = system.A.outside[system.grid.locate(top)];
  for (const double coefficient : {2.0, std::numeric_limits<double>::infinity()}) {
    outside = coefficient;
    system.A.finish();
    system.multigrid.setup(system.A);
    EXPECT_EQ(system.multigrid.usable(), std::isfinite(coefficient));
  }
  auto b = system.noise(1), z = system.zeros();
  const int inside[3] = {20, 3, 0};
  system.precondition(b.data(), z.data());
  EXPECT_TRUE(std::isfinite(z[system.grid.locate(inside)]));
}

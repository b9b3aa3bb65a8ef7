// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Transfers of one number: all instruction sets against the plain loops, sums, and linear fields.

#include "material/batch_kernels.h"
#include "transfer/kernel_testing.h"
#include "transfer/scalar.h"

using namespace MPM_NS;
using namespace MPM_TEST;

constexpr Shape SHAPES[] = {LINEAR, QUADRATIC, CUBIC, GIMP, BERNSTEIN};

/** Points of a batch anywhere in the range of a tile, and a tile with a number at each node. */
struct Scene {
  int dim, n, stride_x, stride_y;
  TransferStep step = random_step();
  int base[3] = {2 * integer(-20, 20), 2 * integer(-20, 20), 2 * integer(-20, 20)};
  Reals x, size, tile, q, slopes, values, factors;
  int width = integer(1, 3);    // of values
  PointRows rows = {};

  Scene(int dim, Shape shape, bool crowded) : dim(dim), n(integer(1, BATCH)), q(4 * n)
  {
    const int order = stencil_order(shape);
    stride_x = tile_stride_x(dim, order);
    stride_y = tile_stride_y(dim, order);
    tile.resize(tile_nodes(dim, order) + 8);
    fill(tile);
    fill(q);
    slopes.resize(dim * n);
    values.resize(width * n);
    factors.resize(n);
    for (Reals *const list : {&slopes, &values, &factors}) fill(*list);
    const double shift = shape_constants[shape].shift;
    const double range = crowded ? 1.0 : block_side(dim) + (shape == BERNSTEIN ? 0.0 : 2.0);
    x.resize(3 * n);
    size.resize(3 * n);
    for (int p = 0; p < 3 * n; p++) {
      x[p] = step.origin[p % 3] + (uniform(0.0, range) + shift + base[p % 3]) * step.h;
      size[p] = uniform(0.05, 0.5);
    }
    rows.x = x.data();
    rows.size = size.data();
    rows.guarded = 0;
  }
  ScalarSource source(int dim) const
  {
    return {slopes.data(), dim, values.data(), width, factors.data()};
  }
  ScalarStencil stencil(const ScalarKernels &kernels, SlopeKind kind, int *box = nullptr)
  {
    ScalarStencil made;
    kernels.prepare(rows, step, n, base, kind, made, box);
    return made;
  }
};

/** Room for rows of this width of n points. */
Reals rows(int width, int n)
{
  return Reals(width * (n + SPARE_ROWS), 0.0);
}

/** Calls f(kernels, plain, dim, shape) for all instruction sets that run here. */
template <class F> void for_all(const F &f)
{
  const MPMKernels &reference = *MPMKernels::select("reference");
  for (const char *isa : {"baseline", "avx2", "avx512"}) {
    const MPMKernels *const set = MPMKernels::select(isa);
    if (!set) continue;
    for (const int dim : {2, 3})
      for (const Shape shape : SHAPES)
        for (int repeat = 0; repeat < 6; repeat++) {
          SCOPED_TRACE(std::string(isa) + " " + std::to_string(dim) + "d shape " +
                       std::to_string(shape));
          f(ScalarKernels::select(*set, dim, shape), ScalarKernels::select(reference, dim, shape),
            dim, shape);
        }
  }
}

TEST(Scalar, IsThatOfThePlainLoops)
{
  for_all([](const ScalarKernels &kernels, const ScalarKernels &plain, int dim, Shape shape) {
    Scene scene(dim, shape, integer(0, 1));
    for (const SlopeKind kind : {GRADIENT_SLOPES, DISTANCE_SLOPES, FIT_SLOPES, ABSOLUTE_SLOPES}) {
      int box[2][6] = {{127, 127, 127, -127, -127, -127}, {127, 127, 127, -127, -127, -127}};
      const ScalarStencil fast = scene.stencil(kernels, kind, box[0]),
                          slow = scene.stencil(plain, kind, box[1]);
      for (int k = 0; k < 6; k++)
        if (k % 3 < dim) EXPECT_EQ(box[0][k], box[1][k]);
      Reals one = scene.tile, two = scene.tile;
      kernels.add(fast, scene.q.data(), one.data());
      plain.add(slow, scene.q.data(), two.data());
      EXPECT_LT(difference(one, two), 1e-13);
      kernels.add_values(fast, scene.q.data(), one.data());
      plain.add_values(slow, scene.q.data(), two.data());
      EXPECT_LT(difference(one, two), 1e-13);
      const ScalarSource from = scene.source(dim);
      kernels.add_times(fast, from, one.data());
      plain.add_times(slow, from, two.data());
      EXPECT_LT(difference(one, two), 1e-13);
      Reals a = rows(4, scene.n), b = a;
      kernels.get(fast, scene.tile.data(), a.data());
      plain.get(slow, scene.tile.data(), b.data());
      a.resize(4 * scene.n), b.resize(4 * scene.n);
      EXPECT_LT(difference(a, b), 1e-13);
      a = rows(1, scene.n), b = a;
      kernels.get_values(fast, scene.tile.data(), a.data());
      plain.get_values(slow, scene.tile.data(), b.data());
      a.resize(scene.n), b.resize(scene.n);
      EXPECT_LT(difference(a, b), 1e-13);
      if (kind != GRADIENT_SLOPES) continue;
      // the same without any slopes
      const ScalarStencil bare = scene.stencil(kernels, NO_SLOPES);
      b = rows(1, scene.n);
      kernels.get_values(bare, scene.tile.data(), b.data());
      b.resize(scene.n);
      EXPECT_EQ(a, b);
      Reals three = scene.tile, four = scene.tile;
      kernels.add_values(bare, scene.q.data(), three.data());
      kernels.add_values(fast, scene.q.data(), four.data());
      EXPECT_EQ(three, four);
    }
  });
}

// nodes without weight get nothing, whatever is there
TEST(Scalar, IsDividedByWeights)
{
  for_all([](const ScalarKernels &kernels, const ScalarKernels &plain, int, Shape) {
    const int n = integer(0, 40);
    Reals sums(n), weights(n);
    fill(sums);
    for (double &w : weights) w = integer(0, 2) ? uniform(1.0e-300, 2.0) : 0.0;
    Reals fast = sums, slow = sums;
    kernels.divide(fast.data(), weights.data(), n);
    plain.divide(slow.data(), weights.data(), n);
    EXPECT_EQ(fast, slow);
    for (int k = 0; k < n; k++) EXPECT_EQ(slow[k], weights[k] > 0.0 ? sums[k] / weights[k] : 0.0);
  });
}

// times a factor is as with rows that are: the same sums in another order
TEST(Scalar, IsThatOfRowsTimesFactors)
{
  for_all([](const ScalarKernels &kernels, const ScalarKernels &, int dim, Shape shape) {
    Scene scene(dim, shape, integer(0, 1));
    const ScalarStencil stencil = scene.stencil(kernels, DISTANCE_SLOPES);
    const ScalarSource from = scene.source(dim);
    Reals times = scene.tile, rows = scene.tile, q(4 * scene.n, 0.0);
    for (int p = 0; p < scene.n; p++) {
      for (int d = 0; d < dim; d++) q[4 * p + d] = scene.factors[p] * scene.slopes[dim * p + d];
      q[4 * p + 3] = scene.factors[p] * scene.values[scene.width * p];
    }
    kernels.add_times(stencil, from, times.data());
    kernels.add(stencil, q.data(), rows.data());
    EXPECT_LT(difference(times, rows), 1e-13);
  });
}

// slopes of a fit: a linear field has its gradient
TEST(Scalar, FitsLinearFields)
{
  for_all([](const ScalarKernels &kernels, const ScalarKernels &, int dim, Shape shape) {
    if (shape != QUADRATIC && shape != CUBIC) return;
    Scene scene(dim, shape, integer(0, 1));
    const ScalarStencil stencil = scene.stencil(kernels, FIT_SLOPES);
    const double slope = uniform(-1.0, 1.0), h = scene.step.h;
    for (std::size_t k = 0; k < scene.tile.size(); k++)
      scene.tile[k] = slope * (int) (k / scene.stride_x) * h;
    Reals got = rows(4, scene.n);
    kernels.get(stencil, scene.tile.data(), got.data());
    for (int p = 0; p < scene.n; p++) {
      EXPECT_NEAR(got[4 * p], slope, 1e-11);
      for (int d = 1; d < dim; d++) EXPECT_NEAR(got[4 * p + d], 0.0, 1e-11);
    }
  });
}

// values are kept, slopes have no sum, a linear field has its gradient, and both ways are adjoint
TEST(Scalar, KeepsSumsAndLinearFields)
{
  for_all([](const ScalarKernels &kernels, const ScalarKernels &, int dim, Shape shape) {
    Scene scene(dim, shape, integer(0, 1));
    const ScalarStencil stencil = scene.stencil(kernels, GRADIENT_SLOPES),
                        moments = scene.stencil(kernels, DISTANCE_SLOPES);
    Reals to(scene.tile.size(), 0.0), got = rows(4, scene.n);
    kernels.add(stencil, scene.q.data(), to.data());
    kernels.add(moments, scene.q.data(), to.data());
    double points = 0.0, nodes = 0.0;
    for (int p = 0; p < scene.n; p++) points += 2.0 * scene.q[4 * p + 3];
    for (const double a : to) nodes += a;
    EXPECT_NEAR(nodes, points, 1e-11 * scene.n * (1.0 + 1.0 / scene.step.h));

    std::fill(to.begin(), to.end(), 0.0);
    kernels.add(stencil, scene.q.data(), to.data());
    kernels.get(stencil, scene.tile.data(), got.data());
    double there = 0.0, back = 0.0;
    for (std::size_t k = 0; k < to.size(); k++) there += to[k] * scene.tile[k];
    for (int k = 0; k < 4 * scene.n; k++)
      if (k % 4 == 3 || k % 4 < dim) back += got[k] * scene.q[k];
    EXPECT_NEAR(there, back, 1e-11 * scene.n * (1.0 + 1.0 / scene.step.h));

    const double B[3] = {uniform(-1.0, 1.0), uniform(-1.0, 1.0),
                         dim == 3 ? uniform(-1.0, 1.0) : 0.0};
    const double h = scene.step.h;
    for (std::size_t k = 0; k < scene.tile.size(); k++) {
      const int n = (int) k, i = n / scene.stride_x, rest = n % scene.stride_x;
      const int j = dim == 3 ? rest / scene.stride_y : rest, l = rest % scene.stride_y;
      scene.tile[k] = 3.0 + B[0] * (scene.base[0] + i) * h + B[1] * (scene.base[1] + j) * h +
          (dim == 3 ? B[2] * (scene.base[2] + l) * h : 0.0);
    }
    kernels.get(stencil, scene.tile.data(), got.data());
    for (int p = 0; p < scene.n; p++) {
      double value = 3.0;
      for (int d = 0; d < dim; d++) {
        value += B[d] * (scene.x[3 * p + d] - scene.step.origin[d]);
        EXPECT_NEAR(got[4 * p + d], B[d], 1e-11 / h * (1.0 + h));
      }
      EXPECT_NEAR(got[4 * p + 3], value, 1e-11 * (1.0 + h));
    }
  });
}

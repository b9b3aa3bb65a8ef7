// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_KERNEL_TESTING_H
#define MPM_KERNEL_TESTING_H

// Random numbers, comparisons, and combinations for tests of kernels; standard headers they need.

#include "transfer/kernels.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace MPM_TEST {

using Reals = std::vector<double>;

/** Is this a build with sanitizers (test_sanitize.sh)? Then tests repeat less often. */
#if defined(MPM_SANITIZED)
constexpr bool SANITIZED = true;
#else
constexpr bool SANITIZED = false;
#endif

inline std::mt19937 generator(20260704);

inline double uniform(double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(generator);
}
inline int integer(int low, int high)
{
  return std::uniform_int_distribution<int>(low, high)(generator);
}
inline void fill(Reals &a, double size = 1.0)
{
  for (double &x : a) x = uniform(-size, size);
}

/** Largest difference between a and b, relative to the largest value of b. */
inline double difference(const Reals &a, const Reals &b)
{
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double diff = 0.0, scale = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < a.size(); i++) {
    if (!(std::abs(a[i] - b[i]) <= diff)) diff = std::abs(a[i] - b[i]);
    scale = std::max(scale, std::abs(b[i]));
  }
  return diff / scale;
}

/** A step with random parameters. */
inline MPM_NS::TransferStep random_step()
{
  MPM_NS::TransferStep step;
  step.h = uniform(0.1, 2.0);
  step.inv_h = 1.0 / step.h;
  step.dt = uniform(0.01, 0.1) * step.h;
  step.flip = uniform(0.0, 1.0);
  step.force_scale = uniform(0.5, 2.0);
  step.stress_scale = uniform(0.5, 2.0);
  for (double &o : step.origin) o = uniform(-5.0, 5.0);
  return step;
}

/** Lowest and highest tile indices of base nodes, and their values before the first call of P2G. */
using Box = std::array<int, 6>;
constexpr Box NO_BOX = {1000, 1000, 1000, -1000, -1000, -1000};

/** Transfers the points [first,last) of a test to a tile, and back. p2g returns the widened box. */
template <class Points> Box p2g(MPM_NS::P2G kernel, Points &points, double *tile, Box box = NO_BOX)
{
  kernel(points.rows(), points.step, points.first, points.last, points.base, tile, box.data());
  return box;
}
template <class Points>
int g2p(MPM_NS::G2P kernel, Points &points, const double *tile, double *L = nullptr)
{
  return kernel(points.rows(), points.step, points.first, points.last, points.base, tile, L);
}

/** A tile and its shape. margin: nodes in front; last: largest base node; reach: nodes behind. */
struct TileShape {
  int dim, stride_x, stride_y, margin, last, reach;
  double *tile;
  int reals;
};

/** Expects prefetch, flush, load, load_mean to move random boxes of a tile to blocks and back. */
inline void expect_box_moves(const MPM_NS::TransferKernels &kernels, const TileShape &t)
{
  const int side = MPM_NS::block_side(t.dim), shift = side - t.margin, nreal = kernels.nreal;
  const auto block = [=](int node) {    // 0, 1, or 2 along an axis
    return (node + shift) / side;
  };
  for (int trial = 0; trial < (SANITIZED ? 10 : 60); trial++) {
    int box[6], slot[27];
    for (int a = 0; a < 3; a++) {
      box[a] = integer(0, t.last);
      box[3 + a] = integer(box[a], t.last);
    }
    // blocks that the box touches have slots in a random order; the others do not exist
    for (int i = 0; i < 27; i++) slot[i] = i;
    std::shuffle(slot, slot + 27, generator);
    for (int i = 0; i < 27; i++) {
      const int b[3] = {i / 9, i / 3 % 3, i % 3};
      for (int a = 0; a < 3; a++)
        if (a < t.dim ? b[a] < block(box[a]) || b[a] > block(box[3 + a] + t.reach) : b[a] != 1)
          slot[i] = -1000000;
    }
    const auto for_box = [&](auto act) {    // all reals of the box, in the tile and in the store
      const int depth = t.dim == 3 ? box[5] + t.reach : 0;
      for (int i = box[0]; i <= box[3] + t.reach; i++)
        for (int j = box[1]; j <= box[4] + t.reach; j++)
          for (int k = t.dim == 3 ? box[2] : 0; k <= depth; k++) {
            const int n[3] = {i, j, k};
            int s = 0, index = 0;
            for (int a = 0; a < 3; a++) s = 3 * s + (a < t.dim ? block(n[a]) : 1);
            for (int a = 0; a < t.dim; a++) index = side * index + (n[a] + shift) % side;
            for (int r = 0; r < nreal; r++)
              act(nreal * (i * t.stride_x + j * t.stride_y + k) + r,
                  nreal * (64 * slot[s] + index) + r);
          }
    };

    std::fill(t.tile, t.tile + t.reals, 0.0);
    Reals store(27 * 64 * nreal);
    fill(store);
    const Reals before = store;
    Reals expected = store;
    for_box([&](int in_tile, int in_store) {
      t.tile[in_tile] = uniform(-1.0, 1.0);
      expected[in_store] += t.tile[in_tile];
    });
    const Reals values(t.tile, t.tile + t.reals);
    kernels.prefetch(t.tile, store.data(), slot, box);
    ASSERT_EQ(store, before);
    ASSERT_EQ(Reals(t.tile, t.tile + t.reals), values);
    kernels.flush(t.tile, store.data(), slot, box);
    ASSERT_EQ(store, expected);
    ASSERT_EQ(Reals(t.tile, t.tile + t.reals), Reals(t.reals, 0.0));
    kernels.load(t.tile, store.data(), slot, box);
    ASSERT_EQ(store, expected);
    bool loaded = true;
    for_box([&](int in_tile, int in_store) {
      loaded = loaded && t.tile[in_tile] == store[in_store];
    });
    ASSERT_TRUE(loaded);
    ASSERT_EQ(kernels.load_mean != nullptr, nreal == 8);
    if (nreal == 4) continue;
    kernels.load_mean(t.tile, store.data(), slot, box);
    ASSERT_EQ(store, expected);
    for_box([&](int in_tile, int in_store) {
      const double *const mine = store.data() + in_store;
      loaded = loaded && (in_tile % 8 > 2 || t.tile[in_tile] == 0.5 * (mine[0] + mine[4]));
    });
    ASSERT_TRUE(loaded);
  }
}

/** A choice of kernels. */
struct Case {
  const char *isa;
  int dim;
  MPM_NS::Shape shape;
  MPM_NS::Transfer transfer;
  bool split;
};

/** Whether merged records are sufficient for this transfer. */
inline bool may_be_merged(MPM_NS::Transfer transfer)
{
  return transfer == MPM_NS::APIC || transfer == MPM_NS::TPIC;
}

inline bool any_case(const Case &)
{
  return true;
}
inline bool is_not_reference(const Case &c)
{
  return std::string(c.isa) != "reference";
}

/** Cases with these shapes for all instruction sets, as far as they are wanted. */
inline auto all_cases(const std::vector<MPM_NS::Shape> &shapes,
                      bool wanted(const Case &) = any_case)
{
  using namespace MPM_NS;
  std::vector<Case> cases;
  for (const char *isa : {"reference", "baseline", "avx2", "avx512"})
    for (int dim : {2, 3})
      for (Shape shape : shapes)
        for (Transfer transfer : {PIC, FLIP, APIC, AFLIP, TPIC})
          for (bool split : {true, false})
            if ((split || may_be_merged(transfer)) && wanted({isa, dim, shape, transfer, split}))
              cases.push_back({isa, dim, shape, transfer, split});
  return ::testing::ValuesIn(cases);
}

inline std::string case_name(const ::testing::TestParamInfo<Case> &info)
{
  static const char *const shapes[] = {"",     "linear", "quadratic", "cubic",
                                       "gimp", "cpdi",   "cpdi2",     "bernstein"};
  static const char *const transfers[] = {"pic", "flip", "apic", "aflip", "tpic"};
  const Case &c = info.param;
  return std::string(c.isa) + "_" + std::to_string(c.dim) + "d_" + shapes[c.shape] + "_" +
      transfers[c.transfer] + (may_be_merged(c.transfer) ? (c.split ? "_split" : "_merged") : "");
}

/** The kernels of a case, and the reference kernels. */
class KernelTest : public ::testing::TestWithParam<Case> {
 protected:
  int dim = 0, nreal = 0;
  const MPM_NS::MPMKernels *table;
  MPM_NS::TransferKernels kernels, reference;

  void SetUp() override
  {
    using MPM_NS::MPMKernels;
    const Case &c = GetParam();
    table = MPMKernels::select(c.isa);
    if (!table) GTEST_SKIP() << "the CPU does not have it, or the compiler does not know it";
    dim = c.dim;
    kernels = table->transfer(dim, c.shape, c.transfer, c.split);
    reference = MPMKernels::select("reference")->transfer(dim, c.shape, c.transfer, c.split);
    nreal = kernels.nreal;
    generator.seed(1);
  }
};

}    // namespace MPM_TEST
#endif

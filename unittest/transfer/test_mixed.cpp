/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// labels: mpi physics
// mpi: 1 3
// timeout: 600

// Mixed precision: transfers against those in double precision, for every instruction set; what must
// be exact to double precision all the same; physics, ranks, and what is refused. Its errors against
// exact solutions are in test_physics_mms.cpp.

#include "mpm_lammps.h"
#include "transfer/kernel_testing.h"
#include "transfer/kernels.h"

#include "gtest/gtest.h"

#include <cmath>
#include <cstdlib>
#include <random>

using namespace MPM_TEST;
using namespace MPM_NS;

namespace {

/** Points in the middle of a tile, and their way to the nodes of 27 blocks and back. */
struct Trip {
  int n;
  TransferStep step;
  int base[3] = {-3, 5, 7}, slot[27];
  Reals x, v, f, C, tau, vol0, mass, from, P, L, nodes;
  Reals sums;                                        ///< nodes before the momentum equation
  std::function<void(Reals &, int)> change_nodes;    ///< after it

  Trip(int dim, Shape shape, int n, bool sorted) :
      n(n), x(3 * n), v(3 * n), f(3 * n), C(9 * n), tau(6 * n), vol0(n), mass(n), P(9 * n), L(9 * n)
  {
    std::mt19937 generator(n);
    auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator);
    };
    step = {0.1, 10.0, {0.3, -0.2, 0.1}, 1.0e-5, 0.9, 1.0, 1.0};
    const double range = block_side(dim) + 2;
    for (int p = 0; p < n; p++)
      for (int a = 0; a < 3; a++) {
        const double t = sorted ? 3 + p / 7 % 3 + uniform(0.01, 0.99) : uniform(0.0, range);
        x[3 * p + a] = step.origin[a] + (t + 0.5 * (shape - 1) + base[a]) * step.h;
      }
    for (auto *rows : {&v, &f, &C, &tau, &P})
      for (double &a : *rows) a = uniform(-1.0, 1.0);
    for (double &a : vol0) a = uniform(0.5e-3, 1.5e-3);
    for (double &a : mass) a = uniform(0.5e-20, 1.5e-20);    // whatever the units
    for (double &a : f) a *= 1.0e-20;
    for (double &a : tau) a *= 1.0e-20;
    for (double &a : P) a *= 1.0e-20;
    from = x;
    for (int i = 0; i < 27; i++) slot[i] = 26 - i;
  }

  /** All n points, with or without memory behind them; to the nodes, momentum equation, and back. */
  void go(const TransferKernels &k, bool guarded)
  {
    Reals room(8 * MAX_TILE_NODES + 8, 0.0);
    double *tile = room.data();
    while (reinterpret_cast<size_t>(tile) % 64) tile++;
    PointRows rows = {x.data(),    v.data(),    f.data(), C.data(), tau.data(),
                      vol0.data(), mass.data(), x.data(), nullptr,  guarded ? n - 1 : 0,
                      from.data(), P.data()};
    int box[6] = {127, 127, 127, -127, -127, -127};
    const int first = 0, last = guarded ? n - 1 : n;
    nodes.assign(27 * 64 * k.nreal, 0.0);
    k.p2g(rows, step, first, last, base, tile, box);
    k.flush(tile, nodes.data(), slot, box);
    for (const double a : room) EXPECT_EQ(a, 0.0);
    sums = nodes;
    MPMKernels::select("reference")->solve_nodes(nodes.data(), 27 * 64, k.nreal, step.dt);
    if (change_nodes) change_nodes(nodes, k.nreal);
    k.load(tile, nodes.data(), slot, box);
    Reals gradient(L.size());
    k.g2p_gradient(rows, step, first, last, base, tile, gradient.data());
    k.g2p(rows, step, first, last, base, tile, L.data());
    for (std::size_t i = 0; i < L.size(); i++) EXPECT_NEAR(L[i], gradient[i], 2.0e-4);
  }
};

struct Case {
  const char *isa;
  int dim;
  Shape shape;
  Transfer transfer;
  bool split, total;
};

std::vector<Case> all_cases()
{
  std::vector<Case> cases;
  for (const char *isa : {"baseline", "avx2", "avx512"})
    for (int dim : {2, 3})
      for (Shape shape : {LINEAR, QUADRATIC, CUBIC})
        for (Transfer transfer : {PIC, FLIP, APIC})
          for (bool split : {true, false})
            for (bool total : {false, true})
              if (split || transfer == APIC)
                cases.push_back({isa, dim, shape, transfer, split, total});
  return cases;
}

std::string case_name(const ::testing::TestParamInfo<Case> &info)
{
  const Case &c = info.param;
  return strprintf("%s_%dd_order%d_transfer%d%s%s", c.isa, c.dim, (int) c.shape, (int) c.transfer,
                   c.split ? "_split" : "", c.total ? "_total" : "");
}

class MixedKernels : public ::testing::TestWithParam<Case> {
 protected:
  TransferKernels mixed, full;
  void SetUp() override
  {
    const Case &c = GetParam();
    const MPMKernels *table = MPMKernels::select(c.isa);
    if (!table) GTEST_SKIP() << "the CPU does not have it, or the compiler does not know it";
    mixed = table->transfer_mixed(c.dim, c.shape, c.transfer, c.split, c.total);
    const auto choose = c.total ? table->transfer_total : table->transfer;
    full = choose(c.dim, c.shape, c.transfer, c.split);
    ASSERT_NE(mixed.p2g, nullptr);
    ASSERT_EQ(mixed.nreal, full.nreal);
  }
};

}    // namespace

// sums on nodes, positions, velocities, affine matrices, gradients; bodies that move fast

TEST_P(MixedKernels, AgreeWithDouble)
{
  const Case &c = GetParam();
  const double speed = 100.0;
  for (const int n : {2, 3, 4, 5, 6, 9, 18, 34, 101})
    for (const bool guarded : {true, false})
      for (const bool sorted : {true, false}) {
        Trip a(c.dim, c.shape, n, sorted);
        for (int i = 0; i < 3 * n; i++) a.v[i] += speed;
        Trip b = a;
        a.go(mixed, guarded);
        b.go(full, guarded);
        for (int r = 0; r < mixed.nreal; r++) {
          Reals u, w;
          for (std::size_t k = r; k < a.sums.size(); k += mixed.nreal) {
            u.push_back(a.sums[k]);
            w.push_back(b.sums[k]);
          }
          ASSERT_LT(difference(u, w), 2.0e-6) << n << " points, real " << r;
        }
        // of velocities, which differ by 1 within the tile; forces change them by 0.1 at the most
        ASSERT_LT(difference(a.v, b.v) * speed, 5.0e-6) << n << " points";
        ASSERT_LT(difference(a.x, b.x), 1.0e-8) << n << " points";
        ASSERT_LT(difference(a.C, b.C), 5.0e-5) << n << " points";
        for (std::size_t k = 0; k < a.L.size(); k++)
          ASSERT_NEAR(a.L[k], b.L[k], 2.0e-4) << n << " points";
      }
}

// what all points have in common is kept in double precision

TEST_P(MixedKernels, UniformMotionIsExact)
{
  const Case &c = GetParam();
  Trip trip(c.dim, c.shape, 101, true);
  const Reals x = trip.x;
  for (auto *rows : {&trip.f, &trip.C, &trip.tau, &trip.P})
    std::fill(rows->begin(), rows->end(), 0.0);
  for (int i = 0; i < 303; i++) trip.v[i] = i % 3 == 2 && c.dim == 2 ? 0.0 : 1234.5678 + i % 3;
  const Reals v = trip.v;
  trip.go(mixed, true);
  for (int i = 0; i < 300; i++) {
    ASSERT_NEAR(trip.v[i], v[i], 1.0e-12 * 1234.0);
    if (i % 3 < c.dim) { ASSERT_NEAR(trip.x[i], x[i] + trip.step.dt * v[i], 1.0e-14); }
  }
  for (const double l : trip.L) ASSERT_NEAR(l, 0.0, 1.0e-8);
}

// FLIP adds changes of velocity that single precision does not resolve next to the velocities

TEST_P(MixedKernels, SmallChangesSurviveFlip)
{
  const Case &c = GetParam();
  if (c.transfer != FLIP) return;
  Trip trip(c.dim, c.shape, 101, true);
  const Reals v = trip.v;
  trip.step.flip = 1.0;
  const double change = 1.0e-9;
  trip.change_nodes = [&](Reals &nodes, int nreal) {
    for (std::size_t k = 0; k < nodes.size(); k += nreal)
      for (int d = 0; d < c.dim; d++) nodes[k + d] = nodes[k + 4 + d] + change;
  };
  trip.go(mixed, true);
  for (int i = 0; i < 300; i++)
    if (i % 3 < c.dim) { ASSERT_NEAR(trip.v[i] - v[i], change, 1.0e-5 * change); }
}

INSTANTIATE_TEST_SUITE_P(All, MixedKernels, ::testing::ValuesIn(all_cases()), case_name);

// ---------------------------------------------------------------------- runs

static const char *const options_mixed[] = {
    "precision mixed", "precision mixed transfer flip 1.0 scheme musl",
    "precision mixed shape cubic", "precision mixed frame total transfer flip 1.0"};

// a velocity of 10 that gravity changes by 1e-9 in a step: single precision resolves 1e-6

TEST(MixedRuns, FreeFallWithTinySteps)
{
  for (auto *options : options_mixed) {
    Scene run;
    run.commands(
        strprintf("units si\nboundary p p p\natom_style mpm\nneighbor 0.3 bin\n"
                  "region box block 0 8 0 8 0 8\ncreate_box 1 box\nfix grid all mpm 1.0 %s\n"
                  "region body block 2.1 5.1 2.2 5.2 2.3 5.3\n"
                  "create_points 1 region body ppc 2\n"
                  "fix m all mpm/material density 1000 neohookean 1.0e6 0.3\n"
                  "fix g all gravity 10 vector 0 0 -1\nthermo 1000\ntimestep 1.0e-10\n"
                  "velocity all set 10 -7 3\nrun 200\n",
                  options));
    for (int i = 0; i < run.n(); i++) {
      EXPECT_NEAR(run.v()[i][0], 10.0, 1.0e-13);
      EXPECT_NEAR(run.v()[i][2] - 3.0, -200 * 1.0e-9, 1.0e-13) << options;
    }
  }
}

// A free body that spins and vibrates, against double precision; over more steps: see the manual. What a
// point gives and gets in a step is rounded some ten times, each time by up to 2^-24 = 6e-8 of the
// differences of velocity within a block, 15 here (3 m at 5/s): at random about 3 x 6e-8 x 15 = 2.7e-6.
// Rounding that favors no direction adds up over N = 1536 points and n = 200 steps as their root, so that
// momentum over mass changes by 2.7e-6 (n/N)^1/2 = 1e-6; if all had the same sign, it would be 5e-4

TEST(MixedRuns, Invariants)
{
  if (nranks() > 1) GTEST_SKIP() << "sums are those of one rank";
  for (auto *options : options_mixed) {
    auto fly = [&](const std::string &text) {
      auto run = std::make_unique<Scene>();
      run->commands("units si\nboundary p p p\natom_style mpm\nneighbor 0.3 bin\n"
                    "region box block -5 15 -5 15 -5 15\ncreate_box 1 box\nfix grid all mpm 0.5 " +
                    text +
                    "\nregion body block 0.1 4.1 0.2 3.2 0.0 2.0\n"
                    "create_points 1 region body ppc 2\n"
                    "fix m all mpm/material density 1000 neohookean 1.0e6 0.3\nthermo 100000\n");
      run->set_velocity([](const double *x, double *v) {
        v[0] = 3.0 - 4.0 * x[1] + 2.0 * x[2];
        v[1] = -2.0 + 5.0 * x[0];
        v[2] = 1.0 - 2.0 * x[0] + x[1];
      });
      run->commands("run 0\n");
      return run;
    };
    auto mixed = fly(options), full = fly(replaced(options, "precision mixed", "precision double"));
    const auto start = mixed->sums();
    for (auto *run : {mixed.get(), full.get()}) run->commands("timestep 1.0e-3\nrun 200\n");
    const auto a = mixed->sums(), b = full->sums();
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(measured("momentum over mass", (a.p[d] - start.p[d]) / start.mass), 0.0, 1.0e-6);
      EXPECT_NEAR(measured("angular momentum", a.L[d] / b.L[d] - 1.0), 0.0, 1e-6) << options;
    }
    EXPECT_NEAR(measured("kinetic energy", a.kinetic / b.kinetic - 1.0), 0.0, 1e-6);
    EXPECT_LT(measured("all states", difference(mixed->gather(), full->gather())), 3e-5);
  }
}

TEST(MixedRuns, RanksAgree)
{
  for (auto *options : options_mixed) {
    OnRanks run(replaced(two_bodies, "MPM_OPTIONS", options), "run 100\n");
    EXPECT_LT(measured(std::string(options) + ", other ranks", run.difference()), 1e-5);
  }
}

TEST(MixedRuns, RefusedWhere)
{
  const Mistake cases[] = {
      {"precision single", "must be one of double mixed"},
      {"precision mixed shape gimp", "Fix mpm precision mixed needs shape linear"},
      {"precision mixed transfer tpic", "Fix mpm precision mixed needs shape linear"},
      {"precision mixed transfer xpic 2", "Fix mpm precision mixed needs shape linear"},
      {"precision mixed stress gradient", "Fix mpm precision mixed needs shape linear"},
      {"precision mixed kernels reference", "kernels reference has no precision mixed"},
  };
  for (const auto &bad : cases)
    EXPECT_THAT(error_of(replaced(two_bodies, "MPM_OPTIONS", bad.lines) + "run 1\n"),
                ::testing::HasSubstr(bad.message));
}

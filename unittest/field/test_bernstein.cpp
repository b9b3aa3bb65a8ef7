// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: mpi physics
// mpi: 1 3
// timeout: 600

// Bernstein polynomials as shape functions of the total frame: kernels of every instruction set
// against the reference, exact fields, ranks, and what is refused. The functions themselves are in
// transfer/test_shape.cpp, convergence is in test_physics_mms.cpp.

#include "mpm_lammps.h"
#include "transfer/kernel_testing.h"
#include "transfer/kernels.h"

#include <random>

using namespace MPM_TEST;
using namespace MPM_NS;

TEST(BernsteinKernels, AgreeWithReference)
{
  std::mt19937 generator(3);
  auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  for (const char *isa : {"baseline", "avx2", "avx512"}) {
    const MPMKernels *table = MPMKernels::select(isa);
    if (!table) continue;
    for (int dim : {2, 3})
      for (Transfer transfer : {PIC, FLIP, APIC})
        for (bool split : {true, false})
          for (int shift : {-1, 0})
            for (int n : {1, 2, 3, 8, 33}) {
              if (!split && transfer != APIC) continue;
              const auto fast = table->transfer_total(dim, BERNSTEIN, transfer, split);
              const auto plain =
                  MPMKernels::select("reference")->transfer_total(dim, BERNSTEIN, transfer, split);
              ASSERT_NE(fast.p2g, nullptr);
              ASSERT_EQ(fast.gradient_in_C, transfer == APIC);
              const int side = block_side(dim),
                        base[3] = {3 * side + shift, shift, -2 * side + shift};
              const TransferStep step = {0.5, 2.0, {0.3, -0.2, 0.1}, 0.01, 0.9, 1.3, 0.7};
              Reals x(3 * n), v(3 * n), f(3 * n), C(9 * n), vol0(n, 0.3), mass(n, 0.7), P(9 * n);
              for (int p = 0; p < n; p++)
                for (int a = 0; a < 3; a++)
                  x[3 * p + a] = step.origin[a] + step.h * (base[a] - shift + uniform(0.0, side));
              for (auto *rows : {&v, &f, &C, &P})
                for (double &r : *rows) r = uniform(-1.0, 1.0);
              const Reals from = x;
              Reals tile[2], L[2], out[2];
              int box[2][6];
              const TransferKernels *kernels[2] = {&fast, &plain};
              for (int k : {0, 1}) {
                for (int i = 0; i < 6; i++) box[k][i] = i < 3 ? 127 : -127;
                tile[k].assign(8 * MAX_TILE_NODES, 0.0);
                L[k].assign(9 * n, 0.0);
                Reals xk = x, vk = v, Ck = C;
                const PointRows rows = {xk.data(), vk.data(),   f.data(),    Ck.data(),
                                        nullptr,   vol0.data(), mass.data(), xk.data(),
                                        nullptr,   0,           from.data(), P.data()};
                kernels[k]->p2g(rows, step, 0, n, base, tile[k].data(), box[k]);
                const Reals sums = tile[k];
                table->solve_nodes(tile[k].data(), MAX_TILE_NODES * 8 / fast.nreal, fast.nreal,
                                   step.dt, MPM_NS::LEAST_MASS);
                kernels[k]->g2p(rows, step, 0, n, base, tile[k].data(), L[k].data());
                tile[k] = sums;
                out[k] = xk;
                out[k].insert(out[k].end(), vk.begin(), vk.end());
                out[k].insert(out[k].end(), Ck.begin(), Ck.end());
              }
              ASSERT_LT(difference(tile[0], tile[1]), 1e-14);
              ASSERT_LT(difference(out[0], out[1]), 1e-11);
              ASSERT_LT(difference(L[0], L[1]), 1e-11);
              for (int i = 0; i < 6; i++)
                if (i % 3 < dim) {
                  ASSERT_EQ(box[0][i], box[1][i]);
                  ASSERT_EQ((box[0][i] + base[i % 3]) % 2, 0);    // even nodes
                }
            }
  }
}

// a point that rounding puts into the cell before its block, of which the tile has one node only
TEST(BernsteinKernels, PointsOnFacesOfBlocks)
{
  for (const char *isa : {"reference", "baseline", "avx2", "avx512"}) {
    const MPMKernels *table = MPMKernels::select(isa);
    if (!table) continue;
    for (int dim : {2, 3}) {
      const auto kernels = table->transfer_total(dim, BERNSTEIN, APIC, true);
      const int n = 5, side = block_side(dim), base[3] = {3 * side - 1, -1, -2 * side - 1};
      const TransferStep step = {0.5, 2.0, {0.3, -0.2, 0.1}, 0.01, 0.9, 1.3, 0.7};
      Reals x(3 * n), v(3 * n), f(3 * n), C(9 * n), vol0(n, 0.3), mass(n, 0.7), P(9 * n);
      for (int p = 0; p < n; p++)
        for (int a = 0; a < 3; a++)
          x[3 * p + a] = step.origin[a] + step.h * (base[a] + 1) - 1e-15 * p;
      Reals tile(8 * MAX_TILE_NODES, 0.0);
      int box[6] = {127, 127, 127, -127, -127, -127};
      const PointRows rows = {x.data(),    v.data(), f.data(), C.data(), nullptr,  vol0.data(),
                              mass.data(), x.data(), nullptr,  0,        x.data(), P.data()};
      kernels.p2g(rows, step, 0, n, base, tile.data(), box);
      for (int a = 0; a < dim; a++) {
        EXPECT_EQ(box[a], 1) << isa;
        EXPECT_EQ(box[3 + a], 1) << isa;
      }
      double sum = 0.0;
      for (int k = 3; k < 8 * MAX_TILE_NODES; k += kernels.nreal) sum += tile[k];
      EXPECT_NEAR(sum, n * 0.7, 1e-14);
    }
  }
}

// the same in a run: a bar with points on faces of cells, and of which some are those of blocks;
// none of its last ones, which would have nodes without mass
SERIAL_TEST(Bernstein, PointsOnFacesOfCells)
{
  for (const double origin : {0.9625, 0.9375, 0.8625, 0.8375, 0.7625, 0.7375, 0.6625, 0.6375}) {
    Scene run(plane("lj", "f p", "0 1.5 0 0.2", 1, 0.005) +
              "region bar block 0 1 INF INF INF INF\ncreate_points 1 region bar spacing 0.025\n" +
              strprintf("fix grid all mpm 0.05 origin %g 0 frame total shape bernstein\n", origin) +
              "fix m all mpm/material density 1.0 eos linear 1e-6 thermal conducting 1 1 1\n"
              "fix heat all mpm/heat\ntimestep 1e-4\nrun 0\n");
    const auto before = run.gather();
    run.commands("run 20\n");
    const auto after = run.gather();
    EXPECT_EQ(before.size(), after.size());
    EXPECT_NEAR(Totals(after).mass, 0.2, 1e-12);
    const auto *const m = run.material();
    const int T = m->find_history("temperature");
    for (int i = 0; i < run.n(); i++) EXPECT_NEAR(m->history[i][T], 1.0, 1e-12);
  }
}

// a block between a wall and a grip, as in test_total, and a patch: affine velocities are exact
SERIAL_TEST(Bernstein, AffineFieldsAreExact)
{
  for (int dim : {2, 3})
    for (auto *options : {"transfer apic", "transfer flip 1.0", "transfer flip 1.0 scheme musl"}) {
      Scene run(box(dim, "lj", "f f f", "0 12 0 12 0 12") +
                body(strprintf("block 1 11 1 11 %s", dim == 3 ? "4 7" : "INF INF"),
                     "density 1.0 linear 1.0e-9 0.0",
                     strprintf("1.0 frame total shape bernstein %s", options)) +
                "timestep 0.01\n");
      run.set_reference();
      run.set_velocity([&](const double *x, double *v) {
        v[0] = 0.1 + 0.02 * x[0] - 0.05 * x[1];
        v[1] = -0.2 + 0.03 * x[0] + 0.01 * x[1];
        v[2] = dim == 3 ? 0.04 * x[2] - 0.02 * x[0] : 0.0;
      });
      run.commands("run 10\n");
      for (int i = 0; i < run.n(); i++) {
        const double *X = run.reference(i);
        const double *F = run.points().F[i];
        // nodes at the border of the body see points on one side: only APIC knows the field there
        const bool inside = X[0] > 4.0 && X[0] < 8.0 && X[1] > 4.0 && X[1] < 8.0;
        if (std::string(options) != "transfer apic" && (!inside || dim == 3)) continue;
        EXPECT_NEAR(F[0], 1.0 + 0.1 * 0.02, 1e-11) << options;
        EXPECT_NEAR(F[1], -0.1 * 0.05, 1e-13) << options;
        EXPECT_NEAR(run.x()[i][0], X[0] + 0.1 * (0.1 + 0.02 * X[0] - 0.05 * X[1]), 1e-9) << options;
      }
    }
}

TEST(Bernstein, RanksAgree)
{
  for (auto *options : {"transfer apic", "transfer flip 1.0 scheme musl", "locking fbar"}) {
    OnRanks run(
        replaced(two_bodies, "MPM_OPTIONS", std::string("frame total shape bernstein ") + options) +
            "timestep 0.02\n",
        "run 100\n");
    EXPECT_LT(measured(options, run.difference()), 1e-12);
  }
}

// a wave in a bar that spans the periodic box: images of nodes keep their parity
SERIAL_TEST(Bernstein, PeriodicTranslation)
{
  auto wave = [](double shift) {
    Scene run(plane("lj", "p p", strprintf("%g %g 0 2", shift, shift + 8.0)) +
              body("box", "density 1.0 neohookean 10.0 0.3",
                   "1.0 frame total shape bernstein origin 0 0") +
              "timestep 0.02\n");
    run.set_velocity([=](const double *x, double *v) {
      v[0] = 0.5 * sin(0.25 * 3.14159265358979323846 * x[0]);
    });
    run.commands("run 300\n");
    double kinetic = run.sums().kinetic;
    return std::array<double, 2>{kinetic, run.stored_energy()};
  };
  const auto a = wave(0.0), b = wave(2.0), c = wave(3.0);
  EXPECT_NEAR(a[0] / b[0], 1.0, 1e-11);
  EXPECT_NEAR(a[1] / c[1], 1.0, 1e-11);
  EXPECT_GT(a[1], 0.1);
}

TEST(Bernstein, RefusedWhere)
{
  expect_options_refused({
      {"shape bernstein", "needs frame total"},
      {"shape bernstein frame total transfer aflip 1.0",
       "use B-splines with transfer apic or flip"},
  });
  expect_error(space("lj", "p p p", "0 9 0 8 0 8") +
                   "fix grid all mpm 1.0 frame total shape bernstein\n",
               "9 spacings along periodic axis x: use an even number");
}

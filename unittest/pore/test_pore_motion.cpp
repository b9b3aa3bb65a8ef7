// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 400

// Fix mpm/pore with formulation u-v-p: pore water with inertia of its own in the points.

#include "pore/pore_mode_testing.h"

using namespace MPM_TEST;

const std::string MOVES = "formulation u-v-p ";

/** Frequency and decay of the fast mode in a signal with a slow one of known root: a best fit. */
std::array<double, 2> fast_mode(const std::vector<double> &t, const std::vector<double> &y,
                                std::array<double, 2> fast, const std::array<double, 2> &slow)
{
  const auto misfit = [&](double omega, double decay) {
    double A[4][5] = {};
    const auto terms = [&](double at, double *f) {
      const double a = std::exp(-decay * at), b = std::exp(-slow[1] * at);
      f[0] = a * std::cos(omega * at);
      f[1] = a * std::sin(omega * at);
      f[2] = b * std::cos(slow[0] * at);
      f[3] = b * std::sin(slow[0] * at);
    };
    double f[4], c[4], sum = 0.0;
    for (std::size_t k = 0; k < t.size(); k++) {
      terms(t[k], f);
      for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) A[i][j] += f[i] * f[j];
        A[i][4] += f[i] * y[k];
      }
    }
    for (int i = 0; i < 4; i++)
      for (int j = i + 1; j < 4; j++) {
        const double by = A[j][i] / A[i][i];
        for (int k = i; k < 5; k++) A[j][k] -= by * A[i][k];
      }
    for (int i = 3; i >= 0; i--) {
      c[i] = A[i][4];
      for (int j = i + 1; j < 4; j++) c[i] -= A[i][j] * c[j];
      c[i] /= A[i][i];
    }
    for (std::size_t k = 0; k < t.size(); k++) {
      terms(t[k], f);
      const double d = y[k] - c[0] * f[0] - c[1] * f[1] - c[2] * f[2] - c[3] * f[3];
      sum += d * d;
    }
    return sum;
  };
  double best = misfit(fast[0], fast[1]);
  for (double step = 0.02 * fast[0]; step > 1e-6 * fast[0]; step *= 0.5)
    for (bool better = true; better;) {
      better = false;
      for (const auto &d :
           {std::array<double, 2>{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
        const double now = misfit(fast[0] + d[0], fast[1] + d[1]);
        if (now >= best) continue;
        best = now;
        fast = {fast[0] + d[0], fast[1] + d[1]};
        better = true;
      }
    }
  return fast;
}

// Tabulated roots of u-v-p for the fast wave of a sealed column; the slow motion has its own
struct Roots {
  Mode mode;
  std::array<double, 2> fast, slow;    // frequency, decay
};
PARAMETER_TEST(
    Modes, HaveTheRootsOfBothVelocities, Roots,
    Values(
        Roots{{2.2e8, 1e-2, "transfer aflip 1.0"}, {1842.0038, 44.120719}, {113.42695, 201.43777}},
        Roots{{2.2e8, 1e-3, "transfer aflip 1.0"}, {1690.4476, 58.346773}, {0.0, 13.263593}},
        Roots{{2.2e8, 1e-5, "transfer aflip 1.0"}, {1671.6909, 0.63573861}, {0.0, 0.13219773}},
        Roots{{2.2e9, 1e-2, "transfer aflip 1.0"}, {5830.3905, 48.118564}, {119.94661, 197.43993}},
        Roots{{2.2e9, 1e-3, "transfer aflip 1.0"}, {5589.5412, 313.72956}, {0.0, 13.556821}},
        Roots{{2.2e9, 1e-5, "transfer aflip 1.0"}, {5229.2709, 6.7964008}, {0.0, 0.13510267}},
        Roots{{2.2e8, 1e-3, ""}, {1690.4476, 58.346773}, {0.0, 13.263593}},
        Roots{{2.2e9, 1e-2, ""}, {5830.3905, 48.118564}, {119.94661, 197.43993}},
        Roots{{2.2e9, 1e-3, ""}, {5589.5412, 313.72956}, {0.0, 13.556821}}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &[mode, fast, slow] = GetParam();
  std::vector<double> t, y;
  vibrate(mode, MOVES, 3.2, t, y);
  const auto mine = frequency_and_decay(t, y), theory = frequency_and_decay(t, exact(mode, t));
  EXPECT_NEAR(measured(strprintf("Kf %g, k %g, frequency", mode.K, mode.k), mine[0] / theory[0]),
              1.0, 0.005);
  EXPECT_NEAR(measured("decay", mine[1] / theory[1]), 1.0, 0.02);
  // where the slow motion is a real root it is hardly there
  if (slow[0] == 0.0) return;
  const auto root = fast_mode(t, y, fast, slow);
  EXPECT_NEAR(measured("fast root, frequency", root[0] / fast[0]), 1.0, 0.005);
  EXPECT_NEAR(measured("decay", root[1] / fast[1]), 1.0, 0.02);
}

// u-p damps the same wave by its own root, -131 instead of -58
SERIAL_TEST(Formulations, DifferInDamping)
{
  const Mode mode = {2.2e8, 1e-3, "transfer aflip 1.0"};
  double decay[2];
  for (const bool moves : {false, true}) {
    std::vector<double> t, y;
    vibrate(mode, moves ? MOVES : "", 3.2, t, y);
    decay[moves] = frequency_and_decay(t, y)[1];
    EXPECT_NEAR(decay[moves] / frequency_and_decay(t, exact(mode, t, moves))[1], 1.0, 0.006);
  }
  EXPECT_GT(measured("decay of u-p over that of u-v-p", decay[0] / decay[1]), 2.0);
}

// Terzaghi's column at T = 0.2, as without inertia
SERIAL_TEST(Consolidation, Terzaghi)
{
  LONG_CASE();
  for (const double Kf : first_of(1, {2.2e8, 2.2e9})) {
    const auto result = consolidate(20, MOVES + "yhi pressure 0", 1.0, 0.0, Kf);
    EXPECT_LT(measured(strprintf("Kf %g, rms", Kf), result.rms), 0.01);
    EXPECT_NEAR(measured("U", result.U) / 0.504088, 1.0, 0.01);
  }
  const auto result = consolidate(20, MOVES + "free pressure 0", 1.2, 0.3, 2.2e9);
  EXPECT_LT(measured("free, rms", result.rms), 0.01);
  EXPECT_NEAR(measured("U", result.U) / 0.504088, 1.0, 0.01);
}

// of an order above one, as without inertia of the water
SERIAL_TEST(Consolidation, Converges)
{
  LONG_CASE();
  double rms[2];
  for (const bool fine : {false, true})
    rms[fine] = measured(
        fine ? "20 cells, rms" : "10 cells, rms",
        consolidate(fine ? 20 : 10, MOVES + "yhi pressure 0", 1.0, 0.0, 2.2e8, 10.0, 80.0).rms);
  EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 0.9);
}

// the same in three dimensions, where the surface is anywhere in a cell, with either shape
SERIAL_TEST(Consolidation, InThreeDimensions)
{
  LONG_CASE();
  for (const char *shape : {"quadratic", "cubic"})
    EXPECT_LT(terzaghi_in_space(shape, 0.2, 2.2e9, MOVES), 0.01);
}

// Where water has no time to flow through a cell, the pressure below the drained top is even
SERIAL_TEST(Undrained, PressureIsEven)
{
  LONG_CASE();
  for (const double Kf : {2.2e8, 2.2e9})
    for (const double k : {1e-3, 1e-4, 1e-6, 1e-8})
      EXPECT_LT(scatter_of_pressure(Kf, k, MOVES), 0.01);
}

// what a sealed column under a load has in its water: p/q = (K/n)/(M + K/n)
SERIAL_TEST(Undrained, StepLoad)
{
  for (const double Kf : {2.2e8, 2.2e9}) {
    const int n = 20;
    Scene run(column(n, strprintf("%g 1000 9810 soil m 0.4 constant 1e-8 ", Kf) + MOVES, SOIL) +
              load(n, LOAD, 0.03) + "fix dt all mpm/dt 0.5\n");
    Water water(run);
    run.commands("run 600\n");
    EXPECT_GT(run.time(), 0.001);
    // waves that the load excites go on without drag
    double sum = 0.0, all = 0.0;
    while (run.time() < 0.1) {
      run.commands("run 20\n");
      if (run.time() < 0.03) continue;
      const double window = std::pow(std::sin(PI * (run.time() - 0.03) / 0.07), 2);
      sum += window * water.mean(0.0, 1.0) / LOAD;
      all += window;
    }
    // the load is a quarter of a cell below the surface
    EXPECT_NEAR(measured("p/q", sum / all / (1.0 - 0.25 / n)) * (1.0 + MODULUS * N / Kf), 1.0,
                2e-5);
  }
}

// what comes to points is what comes through the surface, as volume of water and as mass
TEST(Water, IsKept)
{
  expect_water_is_kept_by("kozeny 1e-2", MOVES);
}

// a wave in highly permeable soil gains no energy, and the ledger closes
SERIAL_TEST(Energy, Wave)
{
  for (const double k : {1e-3, 1e-1}) {
    Scene run(replaced(column(20, strprintf("2.2e8 1000 9810 soil m 0.4 constant %g ", k) + MOVES,
                              "density 1990 linear 1e7 0.3", 1.0, 0.0, "ylo yhi"),
                       "origin", "transfer aflip 1.0 gain error 0.01 origin"));
    run.set_velocity([](const double *x, double *v) {
      v[1] = 1e-2 * std::sin(PI * x[1]);
    });
    run.commands("compute e all mpm/energy\nfix dt all mpm/dt 0.1\nrun 0\n");
    const double before = run.compute_scalar();
    EXPECT_NEAR(before / (0.5 * 1990 * 1e-4 * 0.5 * 0.2), 1.0, 1e-12);
    double most = 0.0, last = before;
    for (int part = 0; part < 20; part++) {
      run.commands("run 100\n");
      const double now = run.compute_scalar();
      most = std::max(most, (now - last) / before);
      last = now;
    }
    EXPECT_LT(measured(strprintf("k %g, greatest gain in a while", k), most), 0.003);
    EXPECT_LT(measured(strprintf("k %g, energy", k), last / before), 0.99);
    EXPECT_NEAR(measured("residual", run.compute_vector()[10] / before), 0.0, 1e-12);
  }
}

// flow through a column under its weight: flux, effective stress, and what the floor bears
SERIAL_TEST(Flow, SeepageChangesTheEffectiveStress)
{
  for (const double i : first_of(1, {0.9, -0.5})) {
    Scene run(seeping_column(i, 1e-2, MOVES));
    expect_seepage(run, i, 1e-2);
    // total weight, less the pressure at the floor that is outside
    EXPECT_NEAR(measured("floor", -run.fix_vector("floor", 3)[1] / (0.4 * 1990.0 * 9.81)), 1.0,
                0.001);
  }
}

// Soil and water together keep their momentum: two blocks collide. Water that goes from point to
// point takes the velocity of where it comes to, and is counted here
SERIAL_TEST(Momentum, IsKept)
{
  Scene run(blocks("initial v_p " + MOVES) + "compute w all mpm/atom flow_x flow_y\n");
  std::map<tagint, double> mass;
  double start[2], now[2], moved[2], carried[2] = {}, most = 0.0;
  run.each_step([&](double **) {
    auto *compute = run.per_atom("w");
    for (int d = 0; d < 2; d++) {
      now[d] = moved[d] = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double V = run.points().jacobian(i) * run.lmp->atom->vfrac[i];
        const auto before = mass.find(run.lmp->atom->tag[i]);
        if (before != mass.end()) carried[d] += (run.mass()[i] - before->second) * run.v()[i][d];
        moved[d] += 0.5 * V * compute->array_atom[i][d];
        now[d] += run.mass()[i] * run.v()[i][d];
      }
      now[d] += moved[d];
      if (mass.empty()) start[d] = now[d];
      grow(most, now[d] - start[d] - carried[d]);
    }
    for (int i = 0; i < run.n(); i++) mass[run.lmp->atom->tag[i]] = run.mass()[i];
  });
  run.commands("run 400\n");
  for (int d = 0; d < 2; d++) {
    measured("momentum of the water's own motion", moved[d]);
    measured("carried", carried[d]);
  }
  EXPECT_LT(measured("change", most), 1e-11);
}

// the time step is that of a wave of water and soil without drag, and it is stable just below
SERIAL_TEST(TimeStep, IsThatOfTheFastWave)
{
  const double Kf = 2.2e8, E = MODULUS, S = N / Kf, rho = 1990.0, rhof = 1000.0;
  const double a = rho * rhof / N - rhof * rhof,
               b = (E + 1.0 / S) * rhof / N + rho / S - 2.0 * rhof / S;
  const double c = std::sqrt((b + std::sqrt(b * b - 4.0 * a * E / S)) / (2.0 * a));
  Scene run(replaced(column(20, "2.2e8 1000 9810 soil m 0.4 constant 1.0 " + MOVES,
                            "density 1990 linear 1e7 0.3", 1.0, 0.0, "ylo yhi"),
                     "origin", "transfer aflip 1.0 origin") +
            "run 0\n");
  EXPECT_NEAR(run.stable_dt() / (0.05 / c), 1.0, 1e-12);
  // frequency of the mode without drag
  EXPECT_NEAR(c * PI, 1842.0 * 1.01, 40.0);
  run.set_velocity([](const double *x, double *v) {
    v[1] = 1e-4 * std::sin(PI * x[1]) + 1e-5 * std::sin(17.0 * x[1] * x[1]);
  });
  run.commands("fix dt all mpm/dt 0.9\nrun 3000\n");
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) grow(most, run.v()[i][1]);
  EXPECT_LT(measured("fastest", most), 2e-4);
}

TEST(Ranks, Agree)
{
  expect_same_on_ranks(blocks("initial v_p " + MOVES), 1e-10);
  expect_same_on_ranks(
      between_walls(blocks(MOVES + "initial v_p xlo pressure 1.0 free pressure 0 ylo flux 0.01")),
      1e-10);
  // nodes with hardly any area, next to a body without water, took all of what comes through it
  expect_same_on_ranks(
      plane("lj", "f f", "0 14 0 12", 2, 0.5) +
          "region wet block 2 6 2 6 INF INF\nregion dry block 8 11 3 6 INF INF\n"
          "fix grid all mpm 1 shape cubic\n"
          "create_points 1 region wet ppc 2\ncreate_points 2 region dry ppc 2\n"
          "group one type 1\ngroup two type 2\n"
          "fix m one mpm/material density 1.0 linear 10.0 0.3\n"
          "fix n two mpm/material density 1.0 linear 20.0 0.3\nfix water all mpm/pore "
          "20.0 0.25 1.0 soil m 0.4 constant 0.1 free flux 1e-2 " +
          MOVES + "\ntimestep 0.02\n",
      1e-10);
}

TEST(Restart, Continues)
{
  expect_continues(blocks("free pressure 0 initial v_p " + MOVES), OF_BLOCKS);
}

// level ground is at rest, with water that could move
SERIAL_TEST(Geostatic, StaysAtRest)
{
  Scene run(replaced(column(20, "2.2e8 1000 9810 soil m 0.4 constant 1e-2 geostatic 0.5 1 " + MOVES,
                            SOIL, 1.2, 0.3),
                     "fix water", "fix g all gravity 9.81 vector 0 -1 0\nfix water") +
            "timestep 4e-5\nrun 500\n");
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) grow(most, run.v()[i][1]);
  EXPECT_LT(measured("velocity over that of free fall", most / (9.81 * 500 * 4e-5)), 1e-10);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = plane("si", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0 MPM_OPTIONS\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density DENSITY linear 1e7 0.3\ntimestep 1e-5\n"
      "fix water all mpm/pore 2e7 1000 9810 soil m 0.4 constant 1e-5 formulation FORM\nrun 1\n";
  const auto with = [&](const std::string &options, const std::string &density,
                        const std::string &form) {
    return replaced(replaced(replaced(scene, "MPM_OPTIONS", options), "DENSITY", density), "FORM",
                    form);
  };
  expect_error(with("", "2000", "u-w"), "must be one of u-p u-v-p");
  expect_error(with("", "2000", "u-v-p stages 5"), "is for formulation u-p");
  expect_error(with("", "400", "u-v-p"), "that of saturated soil");
  expect_error(with("transfer xpic 2", "2000", "u-v-p"), "use apic, aflip, or flip");
}

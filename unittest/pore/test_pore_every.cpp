// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4
// timeout: 400

// Fix mpm/pore every: water flows in fewer steps than soil moves.

#include "pore/pore_mode_testing.h"

using namespace MPM_TEST;

// Terzaghi's column at T = 0.2, drained at a face or at a free surface, also far above the limit
SERIAL_TEST(Consolidation, Terzaghi)
{
  LONG_CASE();
  for (const double Kf : {2.2e8, 2.2e9})
    for (const char *options : {"yhi pressure 0 every 5", "free pressure 0 every 5",
                                "yhi pressure 0 every auto", "free pressure 0 every auto"}) {
      const bool free = options[0] == 'f';
      const auto result = consolidate(20, options, free ? 1.2 : 1.0, free ? 0.3 : 0.0, Kf);
      EXPECT_LT(measured(strprintf("Kf %g, %s, rms", Kf, options), result.rms), 0.002);
      EXPECT_NEAR(measured("U", result.U) / 0.504088, 1.0, 0.01);
    }
}

SERIAL_TEST(Consolidation, Converges)
{
  double rms[2];
  for (const bool fine : {false, true})
    rms[fine] = measured(
        fine ? "20 cells, rms" : "10 cells, rms",
        consolidate(fine ? 20 : 10, "yhi pressure 0 every 5", 1.0, 0.0, 2.2e8, 10.0, 80.0).rms);
  EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 0.9);
}

// Flow that starts and stops makes waves: with more than some node spacings between two flows these
// would be 2 to 19 % of the load, and however many steps are asked for, there are no more
SERIAL_TEST(Undrained, PressureIsEven)
{
  for (const double Kf : {2.2e8, 2.2e9})
    for (const double k : first_of(2, {1e-4, 1e-8, 1e-3, 1e-5, 1e-6}))
      EXPECT_LT(scatter_of_pressure(Kf, k, "every 20"), 0.01);
}

// Points a node spacing apart have pressures stiffer than those of nodes: waits are shorter then,
// or noise grows; so with points that are close along one axis alone
SERIAL_TEST(Waits, AreShortWithFewPoints)
{
  const struct {
    const char *ppc;
    std::vector<const char *> every;
  } cases[] = {
      {"1", {"every auto", "every 2", "every 4"}}, {"1 3", {"every 4"}}, {"4 1", {"every 4"}}};
  for (const auto &one : cases)
    for (const char *transfer : {"apic", "aflip 1.0"})
      for (const double crossed : {0.5, 0.7, 0.9})
        for (const char *every : one.every) {
          Scene run(
              plane("lj", "p p", "0 24 0 4", 1, 0.3) +
              strprintf("fix grid all mpm 1.0 transfer %s\ncreate_points 1 box ppc %s\n", transfer,
                        one.ppc) +
              "fix m all mpm/material density 1.0 linear 0.01 0.0\n"
              "fix water all mpm/pore 0.4 0.5 1.0 soil m 0.4 constant 1e-9 " +
              every +
              "\nvelocity all create 1e-8 4711 dist gaussian\nvelocity all set NULL NULL 0\n" +
              strprintf("timestep %g\nrun 0\n", crossed));
          const auto energy = [&] {
            double sum = 0.0;
            for (int i = 0; i < run.n(); i++)
              for (int d = 0; d < 2; d++) sum += run.v()[i][d] * run.v()[i][d];
            return sum;
          };
          const double before = energy();
          run.commands("run 800\n");
          EXPECT_LT(measured(strprintf("ppc %s, %s, %s, %g spacings in a step", one.ppc, transfer,
                                       every, crossed),
                             energy() / before),
                    1.0);
        }
}

// with auto, flows are for as many steps as waves allow, or for fewer that one stage reaches
TEST(Auto, WaitsForTheFlow)
{
  for (const double k : {1e-6, 1.8e-4}) {
    // at rest, with a pressure that varies over all of the column
    Scene run(replaced(column(10,
                              strprintf("2.2e8 1000 9810 soil m 0.4 constant %g geostatic 0.5 1 "
                                        "ylo flux 1e-6 every auto",
                                        k),
                              SOIL),
                       "fix water", "fix g all gravity 9.81 vector 0 -1 0\nfix water") +
              "timestep 4e-5\nrun 0\n");
    std::vector<int> flows;
    double before = run.fix("water")->compute_scalar();
    for (int step = 1; step <= 60; step++) {
      run.commands("run 1\n");
      const double now = run.fix("water")->compute_scalar();
      if (now != before) flows.push_back(step);
      before = now;
    }
    ASSERT_GT(flows.size(), 3u);
    const double storage = 0.4 / 2.2e8, spacing = 0.1;
    const double crossing = spacing * std::sqrt(storage * 1870.0);
    const double limit = 0.98 * 2.0 * spacing * spacing * storage / (6.0 * k / 9810.0);
    const int waves = (int) (2.5 * crossing / 4e-5), one = (int) (limit / 4e-5);
    const int steps = std::min(one, waves);
    for (std::size_t j = 2; j < flows.size(); j++)
      EXPECT_NEAR(measured("steps of a flow", flows[j] - flows[j - 1]), steps, 1);
    EXPECT_GT(steps, 1);
  }
}

// Without every, water waits where it can: not while a pressure changes within thin layers, where
// it flows as with every 1, to the last bit, not with free surfaces or what varies
TEST(Default, WaitsWhereItCan)
{
  const auto pores = [](double k, const std::string &more, int steps) {
    Scene run(replaced(column(10, strprintf("2.2e8 1000 9810 soil m 0.4 constant %g ", k) + more,
                              SOIL, 1.2, 0.2),
                       "fix water",
                       "variable p atom 1e3*(1-y)\nvariable w equal 10*step\nfix water") +
              strprintf("timestep 4e-5\ncompute pore all mpm/atom pore\nrun %d\n", steps));
    auto *const compute = run.per_atom("pore");
    return std::vector<double>(compute->vector_atom, compute->vector_atom + run.n());
  };
  const std::string thin = "initial 1e3 ylo pressure 0 ", even = "initial v_p ylo pressure 1e3 ";
  EXPECT_EQ(pores(2e-4, thin, 5), pores(2e-4, thin + "every 1", 5));
  EXPECT_EQ(pores(1e-5, even, 40), pores(1e-5, even + "every auto", 40));
  EXPECT_NE(pores(1e-5, even, 40), pores(1e-5, even + "every 1", 40));
  for (const std::string in_each : {"free pressure 0 ", "yhi pressure v_w "})
    EXPECT_EQ(pores(1e-5, even + in_each, 40), pores(1e-5, even + in_each + "every 1", 40));
}

// flows beyond the limit through a free surface are told once; not others, nor those with auto
SERIAL_TEST(Told, LongFlowThroughAFreeSurface)
{
  const auto told = [](const char *k, const char *options) {
    return times_said(
        column(10, strprintf("2.2e8 1000 9810 soil m 0.4 constant %s %s", k, options), SOIL) +
            "timestep 4e-5\nrun 20\nrun 20\n",
        "curved surfaces of soft soil drain too fast");
  };
  EXPECT_EQ(told("1e-3", "free pressure 0 every 5"), 1);
  EXPECT_EQ(told("1e-5", "free pressure 0 every 5"), 0);
  EXPECT_EQ(told("1e-3", "ylo pressure 0 every 5"), 0);
  EXPECT_EQ(told("1e-3", "free pressure 0 every auto"), 0);
  EXPECT_EQ(told("1e-3", "free pressure 0"), 0);
}

// a column that vibrates between closed ends: frequency and damping of u-p
SERIAL_TEST(Modes, FrequencyAndDamping)
{
  for (const auto &mode : {Mode{2.2e8, 1e-3, ""}, Mode{2.2e8, 1e-5, "transfer aflip 1.0"},
                           Mode{2.2e9, 1e-5, "transfer aflip 1.0"}}) {
    std::vector<double> t, y;
    vibrate(mode, "every 5", 3.2, t, y);
    const auto mine = frequency_and_decay(t, y),
               theory = frequency_and_decay(t, exact(mode, t, false));
    EXPECT_NEAR(measured(strprintf("Kf %g, k %g, frequency", mode.K, mode.k), mine[0] / theory[0]),
                1.0, 0.005);
    EXPECT_NEAR(measured("decay", mine[1] / theory[1]), 1.0, 0.005);
  }
}

// load of half of the modulus, see LargeStrain of test_pore.cpp
SERIAL_TEST(LargeStrain, Consolidation)
{
  const int n = 20;
  Scene run(column(n, "200 1e-9 1.0 soil m 0.5 squared 1.0 free pressure 0 every 5",
                   "density 1e-3 linear 1.0 0.0") +
            load(n, 0.5, 0.004));
  Water water(run);
  run_until(run, 0.202);
  double volume = 0.0;
  for (int i = 0; i < run.n(); i++) volume += run.points().jacobian(i) * run.lmp->atom->vfrac[i];
  EXPECT_NEAR(measured("settlement", 1.0 - volume * n / 4.0) / 0.183627, 1.0, 0.02);
  EXPECT_NEAR(measured("pressure at the base", 2.0 * water.mean(0.0, 0.5 / n)) / 0.742959, 1.0,
              0.005);
}

// between flows water stays where it is, and what compresses a point raises its pressure at once
TEST(Water, WaitsForTheFlow)
{
  Scene run(column(10, "2.2e8 1000 9810 soil m 0.4 constant 1e-6 ylo flux 1e-6 every 4", SOIL) +
            load(10, LOAD, 1e-4) + "timestep 1e-5\n");
  Water water(run);
  const double before = water.mass();
  run.commands("run 1\nrun 2\n");
  EXPECT_EQ(run.fix("water")->compute_scalar(), 0.0);
  EXPECT_EQ(water.mass(), before);
  const double *const p = water.pressures();
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) most = std::max(most, p[i]);
  EXPECT_GT(over_ranks(most, MPI_MAX), 1.0);
  run.commands("run 1\n");
  EXPECT_NEAR(run.fix("water")->compute_scalar() / (0.4 * 1e-6 * 4e-5), 1.0, 1e-12);
}

TEST(Water, IsKept)
{
  expect_water_is_kept_by("kozeny 1e-3", "every 4 ");
}

// level ground stays at rest
SERIAL_TEST(Geostatic, StaysAtRest)
{
  const double dt = 4e-5;
  Scene run(replaced(column(20, "2.2e8 1000 9810 soil m 0.4 constant 1e-3 geostatic 0.5 1 every 5",
                            SOIL, 1.2, 0.3),
                     "fix water", "fix g all gravity 9.81 vector 0 -1 0\nfix water") +
            strprintf("timestep %g\nrun 501\n", dt));
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) grow(most, run.v()[i][1]);
  EXPECT_LT(measured("velocity", most / (9.81 * 501 * dt)), 1e-12);
}

TEST(Ranks, Agree)
{
  const auto scene = blocks("initial v_p xlo pressure 1.0 free pressure 0 ylo flux 0.01 every 3");
  for (const auto &one :
       {blocks("initial v_p every 3"), blocks("initial v_p every auto"), between_walls(scene)})
    expect_same_on_ranks(one, 1e-10);
}

// a restart file between two flows
TEST(Restart, Continues)
{
  for (const char *every : {"7", "auto"})
    expect_continues(blocks(std::string("free pressure 0 initial v_p every ") + every), OF_BLOCKS);
}

// After a file from between two flows water may flow in each step, or implicitly
TEST(Restart, GoesOnWithOtherConditions)
{
  const auto fixes = [](const std::string &more) {
    return "fix grid all mpm 0.1 origin 0 0\nfix m all mpm/material " + std::string(SOIL) +
        "\nfix floor all mpm/boundary ylo slip\nfix water all mpm/pore 2.2e8 1000 9810 soil m 0.4 "
        "constant 1e-6 " +
        more + "\ntimestep 4e-5\n";
  };
  const std::string scene = column(10, "2.2e8 1000 9810 soil m 0.4 constant 1e-6 every 4", SOIL) +
      "variable v atom -0.01*y\nvelocity all set NULL v_v NULL\n";
  const auto range = [](Scene &run) {
    double most = 0.0;
    for (const auto &point : water_of_points(run)) grow(most, point.p);
    return most;
  };
  const auto mean = [](Scene &run) {
    double sum = 0.0;
    for (const auto &point : water_of_points(run)) sum += point.p;
    return sum;
  };
  const ScratchFile file("other");
  Scene before(scene + PORE + "timestep 4e-5\nrun 11\n");    // two steps after a flow
  before.commands("write_restart " + file.name + "\n");
  Scene same("read_restart " + file.name + "\nneighbor 0.03 bin\n" + fixes("every 4") + PORE +
             "run 1\n");
  for (const std::string more : {"every 1", "relax 0.4", "yhi pressure 0 every 3",
                                 "free pressure 0", "\nfix solve all mpm/implicit euler"}) {
    Scene other("read_restart " + file.name + "\nneighbor 0.03 bin\n" + fixes(more) + PORE +
                "run 0\n");
    EXPECT_LT(measured(more, water_difference(before, other) / range(before)), 1e-12);
    other.commands("run 1\n");
    if (more != "every 1") continue;
    EXPECT_NEAR(measured("mean a step later", mean(other) / mean(same)), 1.0, 1e-3);
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = column(4, "2e7 1000 9810 soil m 0.4 constant 1e-5", SOIL);
  const std::string plain = scene.substr(0, scene.find("fix water")),
                    water = "fix water all mpm/pore 2e7 1000 9810 soil m 0.4 constant 1e-5 every ";
  expect_refused(
      plain,
      {{water + "0", "every"},
       {water + "1.5", "every"},
       {water + "2 relax 0.1", "relax has no meaning with every 2"},
       {water + "auto relax 0.1", "relax has no meaning with every auto"},
       {water + "2 formulation u-v-p", "every is for formulation u-p"},
       {water + "2 retention gardner 1e-3", "every does not go with retention"},
       {water + "2\nfix solve all mpm/implicit static", "every cannot be used with fix mpm/imp"}},
      "timestep 1e-5\nrun 1\n");
}

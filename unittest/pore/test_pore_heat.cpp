// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// Soil with pore water that is heated and expands; material without water, into which none leaks.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

constexpr double GRAINS = 3e-5, WATER = 2e-4, STIFF = 2.2e8 / 0.4;

/** Undrained soil, a cube of 0.4 m, that is heated evenly by 10 K in 20 ms. axes: of the box. */
std::string heated(const std::string &axes, const std::string &box, const std::string &options)
{
  return space("si", axes, box, 1, 0.03) + "region soil block 0 0.4 0 0.4 0 0.4\n" +
      "fix grid all mpm 0.1\ncreate_points 1 region soil spacing 0.05\nfix m all mpm/material "
      "density 2000 linear 1e7 0.3 thermal conducting 1000 293 2.0 expansion 1e-5\nfix water all "
      "mpm/pore 2.2e8 1000 9810 soil m 0.4 constant 1e-9 " +
      options +
      "\nvariable q equal 2000*1000*10/0.02*(time<0.02)\nfix heat all mpm/heat source v_q\n";
}
/** For each K of what the soil was heated, in the mean over points and a time. */
double pressure(const std::string &scene)
{
  Scene run(scene + "compute T all mpm/atom temperature\n");
  Water water(run);
  run_until(run, 0.02);
  double sum = 0.0, n = 0.0, before = water.mass();
  run.each_step([&](double **) {
    for (int i = 0; i < run.n(); i++) sum += water.pressures()[i];
    n += run.n();
  });
  run_until(run, 0.03);
  EXPECT_NEAR(water.mass() / before, 1.0, 1e-13);
  auto *const T = run.per_atom("T");
  double warmth = 0.0;
  for (int i = 0; i < run.n(); i++) warmth += (T->vector_atom[i] - 293.0) / run.n();
  return sum / n / warmth;
}

// no room to expand: water and grains press on each other; free to expand: water leaves the pores
SERIAL_TEST(Undrained, PressureByHeat)
{
  for (const char *formulation : {"", " formulation u-v-p"}) {
    const auto options = strprintf("expansion %g %g", GRAINS, WATER) + formulation;
    EXPECT_NEAR(measured("confined",
                         pressure(heated("p p p", "0 0.4 0 0.4 0 0.4", options)) /
                             ((0.6 * GRAINS + 0.4 * WATER) * STIFF)),
                1.0, 1e-10);
    if (formulation[0]) continue;
    const double soft = 1.0 / STIFF + 3.0 * 0.4 / 1e7;
    EXPECT_NEAR(measured("free",
                         pressure(heated("f f f", "-0.2 0.6 -0.2 0.6 -0.2 0.6", options)) /
                             (0.4 * (WATER - GRAINS) / soft)),
                1.0, 0.05);
  }
  const double alike = pressure(
      heated("f f f", "-0.2 0.6 -0.2 0.6 -0.2 0.6", strprintf("expansion %g %g", GRAINS, GRAINS)));
  EXPECT_LT(std::fabs(measured("as grains", alike)), 10.0);
}

TEST(Heated, RanksAndRestart)
{
  const std::string variables = std::string(OF_BLOCKS) + "variable s equal 50.0\n";
  const std::string scene =
      replaced(colliding(variables,
                         "20.0 0.5 2.0 soil m 0.4 kozeny 0.1 soil n 0.3 constant 0.01 expansion "
                         "0.003 0.01 free pressure 0 initial v_p"),
               "eos linear 30.0 strength j2 8.0 0.4",
               "eos linear 30.0 strength j2 8.0 0.4 thermal conducting 1.0 300.0 0.5 expansion "
               "0.001") +
      "fix heat all mpm/heat source v_s\n";
  expect_same_on_ranks(scene, 1e-10);
  expect_continues(scene, variables);
}

/** A wall that does not conduct, or is dry, of this half width between two soils. */
static std::string leaking(bool heat, double a)
{
  return plane("si", "f p", "-1 1 0 0.4", 2, 0.03) +
      strprintf("region left block INF %g INF INF INF INF\n", -a) +
      strprintf("region right block %g INF INF INF INF INF\n", a) +
      strprintf("region wall block %g %g INF INF INF INF\n", -a, a) +
      "create_points 1 region left spacing 0.05\ncreate_points 1 region right spacing 0.05\n"
      "create_points 2 region wall spacing 0.05\ngroup soil type 1\ngroup dry type 2\n"
      "fix grid all mpm 0.1\nfix m soil mpm/material density 2000 linear 1e7 0.3" +
      (heat ? " thermal conducting 1000 293 2\nfix heat all mpm/heat\n"
            : "\nfix water all mpm/pore 2.2e7 1000 1 soil m 0.4 constant 1e-7\n") +
      "fix b dry mpm/material density 2000 linear 1e7 0.3\ntimestep 1e-6\nrun 1\n";
}

// nodes of a thin wall belong to both soils, those a tenth of a cell inside of a thick one to a
// soil on one side
TEST(Wall, LeaksAreTold)
{
  for (const bool heat : {false, true}) {
    const std::string words = heat ? "so thin that heat leaks through it"
                                   : "so thin that water leaks through it";
    for (const double cells : {1.0, 2.0, 3.0})
      EXPECT_EQ(times_said(leaking(heat, 0.05 * cells), words), cells < 3.0 ? 1 : 0);
    EXPECT_EQ(times_said(replaced(leaking(heat, 0.2), "mpm 0.1", "mpm 0.1 origin 0.01 0"), words),
              0);
  }
}

// and where they are: the only plane of nodes in this wall is in its middle, and the first of them
// at 0
TEST(Wall, PlaceOfALeak)
{
  const auto said = lines_that_say(leaking(true, 0.05), "so thin that heat leaks through it");
  ASSERT_EQ(said.size(), 1u);
  double x[3] = {1.0, 1.0, 1.0};
  const auto at = said[0].find("one of them at ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(sscanf(said[0].c_str() + at, "one of them at %lg %lg %lg", &x[0], &x[1], &x[2]), 3);
  for (const double place : x) EXPECT_NEAR(place, 0.0, 1e-12);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const auto scene = [](const char *options) {
    return heated("p p p", "0 0.4 0 0.4 0 0.4", options) + "timestep 1e-6\nrun 0\n";
  };
  expect_error(scene(""), "use expansion with what both do");
  expect_error(scene("expansion 1e-5"), "missing argument");
  expect_error(scene("expansion 1e-5 wet"), "floating point");
  expect_error(scene("expansion 3e-5 2e-4 retention gardner 1e-4"), "does not go with expansion");
  expect_error(replaced(scene("expansion 3e-5 2e-4"),
                        "soil m 0.4 constant 1e-9 expansion 3e-5 2e-4",
                        "expansion 3e-5 2e-4 soil m 0.4 constant 1e-9"),
               "needs a soil before it");
  expect_error(replaced(replaced(scene("expansion 3e-5 2e-4"),
                                 " thermal conducting 1000 293 2.0 expansion 1e-5", ""),
                        "fix heat all mpm/heat source v_q\n", ""),
               "has no temperature");
}

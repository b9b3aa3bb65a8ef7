// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4

// Walls that separate and have friction in implicit steps newmark, midpoint, alpha, and hht.

#include "mpm_lammps.h"

using namespace MPM_TEST;

constexpr double SPEED = 0.01;

/** A bar of length 1 and 20 cells, c = 1, comes to a wall that it all but touches. */
static std::string bar(const std::string &options, const std::string &implicit, double crossed)
{
  const double h = 0.05;
  return plane("lj", "f p", "0 2 0 0.2", 1, 0.3 * h) +
      body("block 0 1 INF INF INF INF", "density 1 linear 1 0.0", strprintf("%g ", h) + options) +
      strprintf("displace_atoms all move %g 0 0\nvelocity all set %g 0 0\n", 0.01 * h, -SPEED) +
      "fix wall all mpm/boundary xlo separate\ncompute energy all mpm/energy\n"
      "fix solve all mpm/implicit " +
      implicit + strprintf(" solver multigrid\ntimestep %.17g\n", crossed * h);
}

/** A block of rubber at rest on a floor; then gravity has a part along it. */
static std::string block(const std::string &floor, const std::string &implicit, double along,
                         double speed, double dt)
{
  return plane("si", "f f", "-0.5 2.5 -0.25 1", 1, 0.01) +
      body("block 0.5 1.5 0.02 0.52 INF INF", "density 1000 neohookean 1e6 0.3",
           std::string("0.0625") + (implicit == "midpoint" ? "" : " transfer flip 1.0")) +
      "region ground block INF INF INF 0.02 INF INF\nfix floor all mpm/boundary region ground " +
      floor +
      "\nfix g all gravity 10 vector 0 -1 0\n"
      "fix solve all mpm/implicit euler solver multigrid\ntimestep 0.1\nrun 6\n"
      "unfix solve\nunfix g\n" +
      strprintf("velocity all set %g NULL NULL\nfix g all gravity 10 vector %g -1 0\n", speed,
                along) +
      "fix solve all mpm/implicit " + implicit + strprintf(" solver multigrid\ntimestep %g\n", dt);
}

static double mean_speed(Scene &run, int d)
{
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) sum += run.v()[i][d] / run.n();
  return sum;
}

static const char *const flip = "transfer flip 1.0";

// the wall pushes for the time of two passages of a wave, with twice the momentum, less that of the
// half cell at the wall; energy never grows. Explicit steps: impulse 0.9603
SERIAL_TEST(Bar, BouncesOffAWall)
{
  struct Case {
    const char *implicit, *options;
    double crossed, impulse, kept;
  };
  for (const auto &c :
       {Case{"newmark", flip, 0.5, 0.9603, 0.92}, Case{"newmark", flip, 2.0, 0.952, 0.90},
        Case{"midpoint", "", 0.5, 0.969, 0.92}, Case{"alpha", flip, 0.5, 0.9603, 0.92},
        Case{"hht", flip, 0.5, 0.9603, 0.92}, Case{"newmark gamma 0.6", flip, 0.5, 0.953, 0.88}}) {
    Scene run(bar(c.options, c.implicit, c.crossed));
    const double dt = 0.05 * c.crossed, mass = 0.2;
    const double first = 0.5 * mass * SPEED * SPEED;
    double impulse = 0.0, last = 0.0, held = first;
    for (int k = 0; k < 2.6 / dt; k++) {
      run.commands("run 1 post no\n");
      const double push = -run.fix("wall")->compute_vector(0);
      impulse += push * dt;
      if (push > 1e-9) last = (k + 1) * dt;
      EXPECT_GE(push, -1e-12) << k;
      const double *const energy = run.compute_vector("energy");
      const double now = energy[0] + energy[1];
      EXPECT_LE(now, (1.0 + 1e-6) * first) << k;
      held = now;
    }
    const std::string name = std::string(c.implicit) + strprintf(", %g cells: ", c.crossed);
    EXPECT_NEAR(measured(name + "impulse", impulse / (2.0 * mass * SPEED)), c.impulse, 0.003);
    // alpha and hht have accelerations that are not those of the forces of the same step alone
    EXPECT_NEAR(
        measured(name + "momentum over impulse", mass * (mean_speed(run, 0) + SPEED) / impulse),
        1.0, c.implicit[0] == 'a' || c.implicit[0] == 'h' ? 1e-3 : 1e-7);
    EXPECT_GE(measured(name + "energy", held / first), c.kept);
    EXPECT_NEAR(measured(name + "duration", last), 2.0, 0.11);
  }
}

// a column under its weight, which is there at once, on a floor that it never leaves
SERIAL_TEST(Column, IsOfSecondOrder)
{
  for (const char *implicit : {"newmark", "midpoint", "alpha", "hht"}) {
    double place[3];
    for (int k = 0; k < 3; k++) {
      Scene run(
          plane("lj", "p f", "0 0.2 0 1.5", 1, 0.02) +
          body("block INF INF 0 1 INF INF", "density 1 linear 1 0.0", "0.1 transfer flip 1.0") +
          "fix floor all mpm/boundary ylo slip friction 0.1\nfix g all gravity 0.02 vector 0 -1 0\n"
          "fix solve all mpm/implicit " +
          implicit + " tolerance 1e-11 solver multigrid\n" +
          strprintf("timestep %g\nrun %d\n", 0.08 / (1 << k), 20 << k));
      place[k] = 0.0;
      for (int i = 0; i < run.n(); i++) place[k] += run.x()[i][1] / run.n();
    }
    EXPECT_GT(measured(std::string(implicit) + ": order",
                       std::log2((place[0] - place[1]) / (place[1] - place[2]))),
              1.7);
  }
}

// down a slope with g (sin - mu cos), and below the angle of friction it stays
SERIAL_TEST(Block, SlidesAndSticks)
{
  for (const char *floor : first_of(1, {"separate friction 0.3", "slip friction 0.3"}))
    for (const char *implicit : {"newmark gamma 0.8", "hht rho 0.5"}) {
      const std::string name = std::string(floor) + ", " + implicit + ": ";
      const double dt = 0.025, g = 10.0 / std::sqrt(1.25);
      Scene run(block(floor, implicit, 0.5, 0.0, dt) + "run 8\n");
      const double before = mean_speed(run, 0);
      run.commands("run 16\n");
      EXPECT_NEAR(measured(name + "acceleration over that of Coulomb",
                           (mean_speed(run, 0) - before) / (16 * dt * g * 0.2)),
                  1.0, 6e-3);
      EXPECT_NEAR(run.fix("floor")->compute_vector(0) / -run.fix("floor")->compute_vector(1), 0.3,
                  1e-3);
      if ((floor[1] == 'e') != (*implicit == 'n')) continue;
      Scene rests(block(floor, implicit, 0.12, 0.0, dt) + "run 24\n");
      rests.set_reference();
      rests.commands("run 24\n");
      double way = 0.0;
      for (int i = 0; i < rests.n(); i++)
        way += (rests.x()[i][0] - rests.reference(i)[0]) / rests.n();
      EXPECT_NEAR(measured(name + "creep in node spacings", way / 0.0625), 0.0, 0.01);
    }
}

// from 1 m/s it stops after v^2/(2 mu g)
SERIAL_TEST(Block, Stops)
{
  for (const char *implicit : {"newmark", "midpoint", "hht rho 0.5"}) {
    Scene run(block("separate friction 0.3", implicit, 0.0, 1.0, 0.02));
    run.set_reference();
    run.commands("run 25\n");
    double way = 0.0;
    for (int i = 0; i < run.n(); i++) way += (run.x()[i][0] - run.reference(i)[0]) / run.n();
    EXPECT_NEAR(measured(std::string(implicit) + ": way", way * 6.0), 1.0, 0.03);
    EXPECT_NEAR(measured("speed", mean_speed(run, 0)), 0.0, 0.05);
  }
}

TEST(Impact, RanksAndRestart)
{
  for (const char *implicit : {"newmark", "hht", "midpoint"}) {
    const auto scene = plane("si", "f f", "-0.5 2.5 -0.25 1", 1, 0.01) +
        body("block 0.5 1.5 0.02 0.52 INF INF", "density 1000 neohookean 1e6 0.3",
             std::string("0.0625") + (*implicit == 'm' ? "" : " transfer flip 1.0")) +
        "region ground block INF INF INF 0.015 INF INF\n"
        "fix floor all mpm/boundary region ground separate friction 0.3\n"
        "fix g all gravity 10 vector 0.5 -1 0\nfix solve all mpm/implicit " +
        implicit + " tolerance 1e-11\ntimestep 0.005\n";
    Twins(scene + "velocity all set 0.2 -1 0\n", 3, lines_again(scene), 3, 1e-9);
  }
}

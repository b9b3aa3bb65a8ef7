// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi input
// mpi: 1 4

// Walls with friction and separation in the implicit steps of fix mpm/implicit.

#include "mpm_lammps.h"

using namespace MPM_TEST;

namespace {

/** A block of rubber, 1 m by 0.5 m, on a floor at its place along y, with its weight of 5000 N/m and a part of that along x. */
std::string block(const std::string &floor, const std::string &options, double y, double along,
                  const std::string &implicit)
{
  return plane("si", "f f", "-0.5 3 -0.25 1", 1, 0.01) +
      body(strprintf("block 0.5 1.5 %g %g INF INF", y, y + 0.5), "density 1000 neohookean 1e6 0.3",
           "0.0625 " + options) +
      "region ground block INF INF INF " + strprintf("%g", y) + " INF INF\n" +
      "fix floor all mpm/boundary " + floor + "\n" +
      strprintf("fix g all gravity 10 vector %g -1 0\n", along) + "fix solve all mpm/implicit " +
      implicit + "\ntimestep 1.0\n";
}

}    // namespace

// a wall pushes a block over a floor: mu N, wherever the floor is in a cell
SERIAL_TEST(Block, IsPushed)
{
  struct Case {
    const char *floor, *options, *implicit;
    double y;
  };
  for (const auto &c :
       {Case{"region ground slip friction 0.3", "frame total", "static solver multigrid", 0.0},
        Case{"region ground slip friction 0.3", "", "static solver multigrid", 0.02},
        Case{"region ground separate friction 0.3", "", "static solver multigrid", 0.02},
        Case{"region ground separate friction 0.3", "shape cubic", "static", 0.04},
        Case{"region ground slip friction 0.3", "shape linear frame total transfer pic", "static",
             0.0}}) {
    Scene run(block(c.floor, c.options, c.y, 0.0, c.implicit) +
              "region piston block INF 0.5 INF INF INF INF\n"
              "fix push all mpm/boundary region piston slip velocity 0.01 0 0\nrun 4\n");
    const double weight = -run.fix("floor")->compute_vector(1);
    EXPECT_NEAR(measured("weight", weight) / 5000.0, 1.0, 1e-6) << c.options;
    EXPECT_NEAR(measured(std::string(c.floor) + " " + c.options + ": friction over normal force",
                         run.fix("floor")->compute_vector(0) / weight),
                0.3, 0.3 * 1e-3);
    EXPECT_NEAR(run.fix("push")->compute_vector(0), -run.fix("floor")->compute_vector(0), 0.1);
  }
}

// on a slope of a smaller angle than that of friction it sticks, on one of a larger one there is no equilibrium
SERIAL_TEST(Block, SticksOnASlope)
{
  const auto scene = [](double along, const char *implicit) {
    return block("region ground slip friction 0.3", "frame total", 0.0, along,
                 std::string("static solver multigrid ") + implicit);
  };
  Scene run(scene(0.29, "") + "run 1\n");
  run.set_reference();
  run.commands("run 1\n");
  const double g = 10.0 / std::sqrt(1.0 + 0.29 * 0.29);
  EXPECT_NEAR(run.fix("floor")->compute_vector(0) / (500.0 * g * 0.29), 1.0, 1e-5);
  double creep = 0.0;
  for (int i = 0; i < run.n(); i++)
    creep = std::max(creep, std::fabs(run.x()[i][0] - run.reference(i)[0]));
  EXPECT_LT(measured("creep in a step, in node spacings", creep / 0.0625), 2e-4);
  expect_error(scene(0.35, "parts 1 iterations 20") + "run 1\n", "no equilibrium");
}

// with inertia it slides down by (sin - mu cos) g
SERIAL_TEST(Block, SlidesDown)
{
  Scene run(
      replaced(block("region ground slip friction 0.3", "", 0.02, 0.5, "euler solver multigrid"),
               "timestep 1.0", "timestep 0.01") +
      "run 20\n");
  const double g = 10.0 / std::sqrt(1.25);
  const auto speed = [&]() {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += run.v()[i][0] / run.n();
    return sum;
  };
  const auto ratio = [&]() {
    return measured("friction over normal force",
                    run.fix("floor")->compute_vector(0) / -run.fix("floor")->compute_vector(1));
  };
  EXPECT_NEAR(ratio(), 0.3, 0.3 * 1e-3);
  // the first step begins without stress, and the block settles
  const double settled = speed();
  run.commands("run 20\n");
  EXPECT_NEAR(
      measured("acceleration over that of Coulomb", (speed() - settled) / (0.2 * g * (0.5 - 0.3))),
      1.0, 1e-3);
}

// a block between a floor that separates and a lid that presses, and then pulls
SERIAL_TEST(Lid, LetsGo)
{
  for (const char *floor : {"separate", "separate friction 0.2", "slip friction 0.2"}) {
    Scene run(plane("si", "f f", "0 1 0 1", 1, 0.03) +
              body("box", "density 1e-3 linear 1e6 0", "0.125") +
              "fix floor all mpm/boundary ylo " + floor +
              "\nfix sides all mpm/boundary xlo xhi slip\n"
              "variable v equal 0.01-0.03*(step<2)\n"
              "fix lid all mpm/boundary yhi stick velocity 0 v_v 0\n"
              "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n");
    EXPECT_NEAR(run.fix("floor")->compute_vector(1) / (1e6 * std::log(0.98) / 0.98), 1.0, 1e-3)
        << floor;
    run.commands("run 1\n");
    EXPECT_NEAR(run.fix("floor")->compute_vector(1) / (1e6 * std::log(0.99) / 0.99), 1.0, 2e-2)
        << floor;
    run.commands("run 2\n");
    const double force = measured(floor, run.fix("floor")->compute_vector(1) / (1e6 * 0.01));
    if (floor[1] == 'e') {
      EXPECT_EQ(force, 0.0);
    } else {
      EXPECT_GT(force, 0.9);
    }
  }
}

TEST(Contact, Ranks)
{
  for (const char *floor :
       {"region ground slip friction 0.3", "region ground separate friction 0.3"}) {
    OnRanks run(block(floor, "", 0.02, 0.2, "static tolerance 1e-10"), "run 2\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-9);
  }
}

SERIAL_TEST(Contact, BadInput)
{
  const auto scene = block("region ground slip friction 0.3", "", 0.0, 0.0, "static");
  const auto frictionless = replaced(scene, "slip friction 0.3", "slip");
  expect_error(replaced(scene, "static", "static slip 0"), "slip");
  expect_error(replaced(scene, "static", "static slip -1"), "slip");
  expect_error(replaced(frictionless, "static", "static slip 1e-6") + "run 1\n", "there are none");
  expect_error(replaced(scene, "static", "midpoint") + "run 1\n", "use static or euler");
  expect_error(
      replaced(replaced(scene, "static", "newmark"), "0.0625 ", "0.0625 transfer flip 1.0") +
          "run 1\n",
      "use static or euler");
}

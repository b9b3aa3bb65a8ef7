// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input
// mpi: 1 4

// Walls with friction and separation in the implicit steps of fix mpm/implicit.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** A block of rubber, 1 m by 0.5 m, on a floor at its place along y, with its weight of 5000 N/m
 *  and a part of that along x. */
static std::string block(const std::string &floor, const std::string &options, double y,
                         double along, const std::string &implicit)
{
  return plane("si", "f f", "-0.5 3 -0.25 1", 1, 0.01) +
      body(strprintf("block 0.5 1.5 %g %g INF INF", y, y + 0.5), "density 1000 neohookean 1e6 0.3",
           "0.0625 " + options) +
      "region ground block INF INF INF " + strprintf("%g", y) + " INF INF\n" +
      "fix floor all mpm/boundary " + floor + "\n" +
      strprintf("fix g all gravity 10 vector %g -1 0\n", along) + "fix solve all mpm/implicit " +
      implicit + "\ntimestep 1.0\n";
}

/** A block of rubber of 0.5 by 0.5 at this many node spacings above the floor or hill below it. */
static std::string above(const std::string &floor, double gap, const std::string &options,
                         double low)
{
  const double h = 0.0625;
  return plane("si", "f f", strprintf("0 1 %.17g 1", floor[0] == 'y' ? low : low - 0.25), 1,
               0.3 * h) +
      body("block 0.25 0.75 0.25 0.75 INF INF", "density 1000 neohookean 1e6 0.3",
           "0.0625 " + options) +
      strprintf("displace_atoms all move 0 %.17g 0\n", low + gap * h - 0.25) +
      strprintf("region ground block INF INF INF %.17g INF INF\n", low) +
      strprintf("region hill cylinder z 0.5 %.17g 1.0 INF INF\n", low - 1.0) +
      strprintf("region bowl cylinder z 0.5 %.17g 2.0 INF INF side out\n", low + 2.0) +
      "fix floor all mpm/boundary " + floor + "\n";
}

static double mean_height(Scene &run)
{
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) sum += run.x()[i][1] / run.n();
  return sum;
}

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
                0.3, 0.3 * 1e-4);
    EXPECT_NEAR(run.fix("push")->compute_vector(0), -run.fix("floor")->compute_vector(0), 1e-3);
  }
}

// on a slope below the angle of friction it sticks, on a steeper one there is no equilibrium
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
  EXPECT_NEAR(run.fix("floor")->compute_vector(0) / (500.0 * g * 0.29), 1.0, 2e-6);
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
  EXPECT_NEAR(ratio(), 0.3, 0.3 * 1e-5);
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
    EXPECT_NEAR(run.fix("floor")->compute_vector(1) / (1e6 * std::log(0.98) / 0.98), 1.0, 1e-4)
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

// 20 times its weight pushes a block to a floor from up to 2.5 spacings, in one step as in many
SERIAL_TEST(Block, ComesFromAfar)
{
  struct Case {
    const char *floor, *options;
    double low;
  };
  for (const auto &c : {Case{"ylo separate", "", 0.0}, Case{"ylo separate", "", 0.02},
                        Case{"ylo separate friction 0.3", "shape cubic", 0.0},
                        Case{"region ground separate", "", 0.04},
                        Case{"ylo separate", "shape linear transfer pic", 0.0},
                        Case{"region bowl separate", "", 0.0}})
    for (const double gap : first_of(1, {2.5, 0.3, 1.0, 2.0})) {
      const bool rubs = std::string(c.floor).find("friction") != std::string::npos;
      const bool bowl = std::string(c.floor).find("bowl") != std::string::npos;
      double force[2] = {0.0, 5e4}, mean[2];
      for (const int many : {0, 1}) {
        if (many && rubs) break;    // bounces
        Scene run(above(c.floor, gap, c.options, c.low) +
                  "fix g all gravity 200 vector 0 -1 0\n"
                  "fix solve all mpm/implicit euler solver multigrid\n" +
                  (many       ? "timestep 0.005\nrun 400\n"
                       : bowl ? "timestep 0.02\nrun 200\n"
                              : "timestep 10\nrun 1\n"));
        force[many] = -run.fix("floor")->compute_vector(1);
        mean[many] = mean_height(run);
        if (!many) measured("iterations", run.fix("solve")->compute_vector(0));
      }
      const std::string name = strprintf("%s %s from %g: ", c.floor, c.options, gap);
      EXPECT_NEAR(measured(name + "force over load", force[0] / 5e4), 1.0, 5e-5);
      EXPECT_NEAR(measured(name + "the same, many steps", force[1] / 5e4), 1.0, 1e-5);
      if (rubs) continue;
      // of small steps, the last ones come to rest within NEXT_TO of the floor
      EXPECT_NEAR(measured(name + "mean height, in spacings", (mean[0] - mean[1]) / 0.0625), 0.0,
                  0.08);
    }
}

/** A block of 1 by 1 of rubber (100 and Poisson's number) on a smooth floor, and a region plate
 *  that moves by a way along y. */
static std::string press(double nu, const std::string &way, const std::string &plate,
                         const std::string &kind, const std::string &options = "",
                         const std::string &extent = "-2 2 0 2.4")
{
  return plane("lj", "f f", extent, 1, 0.1) +
      body("block -0.5 0.5 0 1 INF INF", strprintf("density 1 neohookean 100 %g", nu),
           "0.1 stress gradient " + options) +
      "variable way equal " + way + "\nregion plate block " + plate +
      " INF INF move NULL v_way NULL\nfix floor all mpm/boundary ylo slip\n"
      "fix press all mpm/boundary region plate " +
      kind + "\nfix solve all mpm/implicit static\n";
}

/** The force on the plate when the block has this height. free: its sides are, whose width b is
 *  that of mu (b^2 - 1) + lambda log J = 0. */
static double force_at(double height, double nu, bool free)
{
  const double mu = 50.0 / (1.0 + nu), lambda = 100.0 * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  double low = 1.0, high = free ? 1.2 : 1.0;
  while (high - low > 1e-12) {
    const double wide = 0.5 * (low + high);
    (mu * (wide * wide - 1.0) + lambda * std::log(wide * height) < 0.0 ? low : high) = wide;
  }
  return -(mu * (height * height - 1.0) + lambda * std::log(low * height)) / height;
}

// a plate presses a block, in steps longer and shorter than cells: material goes from node to node
SERIAL_TEST(Block, IsPressed)
{
  for (const double gap : {0.0, 0.03, 0.05})
    for (const int steps : first_of(3, {1, 7, 50, 200})) {
      Scene run(press(0.3, "-0.16*time", strprintf("-1.5 1.5 %.17g 2.2", 1.0 + gap), "separate") +
                strprintf("timestep %.17g\nrun %d\n", 1.0 / steps, steps));
      EXPECT_NEAR(measured(strprintf("from %g in %d steps: force over that of theory", gap, steps),
                           run.fix("press")->compute_vector(1) / force_at(0.84 + gap, 0.3, true)),
                  1.0, 1.5e-2);
    }
}

// the same by a plate that holds what it touches, with a free side, and with one that cannot move
SERIAL_TEST(Block, IsPressedByAPlateThatHolds)
{
  struct Case {
    const char *kind, *options;
    double nu;
    bool free;
  };
  for (const auto &c :
       first_of(4,
                {Case{"slip", "", 0.3, true}, Case{"slip", "", 0.3, false},
                 Case{"stick", "", 0.0, true}, Case{"slip friction 0.3", "", 0.0, true},
                 Case{"stick", "", 0.3, false}, Case{"stick", "shape cubic", 0.0, true}})) {
    for (const int steps : c.free ? first_of(2, {1, 10, 100}) : std::vector<int>{50}) {
      Scene run(press(c.nu, "-0.16*time", "INF INF 1 2.2", c.kind, c.options,
                      c.free ? "-2 2 0 2.4" : "-0.5 0.5 0 2.4") +
                (c.free ? "" : "fix sides all mpm/boundary xlo xhi slip\n") +
                strprintf("timestep %.17g\nrun %d\n", 1.0 / steps, steps));
      EXPECT_NEAR(measured(strprintf("%s %s, %s side, %d steps: force over that of theory", c.kind,
                                     c.options, c.free ? "free" : "fixed", steps),
                           run.fix("press")->compute_vector(1) / force_at(0.84, c.nu, c.free)),
                  1.0, 2.5e-3);
    }
  }
}

// two grips that move apart hold the material inside of them: a bar between them has the length
// that they leave free, wherever they are on the lattice and among points
SERIAL_TEST(Bar, IsPulledByGrips)
{
  struct Case {
    const char *options;
    double length;
    int steps;
  };
  for (const auto &c : {Case{"", 1.0, 10}, Case{"", 1.01, 1}, Case{"", 1.03, 10}, Case{"", 1.05, 1},
                        Case{"", 1.07, 1}, Case{"", 1.099, 10}, Case{"shape cubic", 1.03, 1},
                        Case{"shape cubic", 1.07, 1}, Case{"shape linear", 1.03, 1},
                        Case{"shape linear", 1.07, 1}}) {
    Scene run(
        plane("lj", "f f", "-0.8 2.4 -0.2 1.2", 1, 0.1) +
        body("block -0.5 1.5 0 1 INF INF", "density 1 neohookean 100 0.0",
             std::string("0.1 stress gradient ") + c.options) +
        "variable way equal 0.016*time\nvariable back equal -0.016*time\n" +
        strprintf("region grip block %g 2.3 INF INF INF INF move v_way NULL NULL\n", c.length) +
        "region other block -0.7 0 INF INF INF INF move v_back NULL NULL\n"
        "fix pull all mpm/boundary region grip stick\n"
        "fix hold all mpm/boundary region other stick\nfix solve all mpm/implicit static\n" +
        strprintf("timestep %.17g\nrun %d\n", 1.0 / c.steps, c.steps));
    const double stretch = 1.0 + 0.032 / c.length,
                 exact = -50.0 * (stretch * stretch - 1.0) / stretch,
                 force = run.fix("pull")->compute_vector(0);
    EXPECT_NEAR(measured(strprintf("%s at %g in %d steps: force over that of theory", c.options,
                                   c.length, c.steps),
                         force / exact),
                1.0, *c.options ? 2e-3 : 2e-5);
    EXPECT_NEAR(run.fix("hold")->compute_vector(0) / force, -1.0, 1e-6);
  }
}

// a bar hangs from a grip, which bears all of its weight; its free part gives its length
SERIAL_TEST(Bar, HangsFromAGrip)
{
  for (const char *solve : {"static", "euler"})
    for (const double length : {1.0, 1.03, 1.07}) {
      Scene run(plane("si", "f f", "-0.5 0.5 -1.6 0.6", 1, 0.05) +
                body("block -0.2 0.2 -1 0.4 INF INF", "density 1000 linear 1e8 0.0",
                     "0.1 stress gradient") +
                "variable way equal 0.0*time\n" +
                strprintf("region grip block INF INF %.17g INF INF INF move NULL v_way NULL\n",
                          length - 1.0) +
                "fix hold all mpm/boundary region grip stick\nfix g all gravity 10 vector 0 -1 0\n"
                "fix solve all mpm/implicit " +
                solve + "\ntimestep 1.0\n");
      run.set_reference();
      run.commands("run 2\n");
      double sag = 0.0, n = 0.0;
      for (int i = 0; i < run.n(); i++) {
        if (run.reference(i)[1] > -0.96) continue;
        sag += run.reference(i)[1] - run.x()[i][1];
        n += 1.0;
      }
      EXPECT_NEAR(run.fix("hold")->compute_vector(1) / (0.4 * 1.4 * 1e4), -1.0, 1e-5);
      EXPECT_NEAR(
          measured(strprintf("%s, %g: way of the last points over that of theory", solve, length),
                   sag / n / (0.5 * 1e-4 * (length * length - 0.025 * 0.025))),
          1.0, 2e-3);
    }
}

// a disk between a rim and a hub that turns, a part of the disk or in a hole: torque of theory
SERIAL_TEST(Disk, IsTurnedByAHubInIt)
{
  for (const bool hole : {false, true}) {
    Scene run(
        "variable angle equal 0.1*time\n" + plane("lj", "f f", "-1.2 1.2 -1.2 1.2", 1, 0.05) +
        "region disk cylinder z 0 0 1 INF INF\n"
        "region free cylinder z 0 0 0.4 INF INF side out\nregion ring intersect 2 disk free\n" +
        "create_points 1 region " + (hole ? "ring" : "disk") +
        " spacing 0.05\nfix grid all mpm 0.1 stress gradient\n"
        "fix m all mpm/material density 1 neohookean 100 0.3\n"
        "region rim cylinder z 0 0 0.9 INF INF side out\n"
        "region hub cylinder z 0 0 0.4 INF INF rotate v_angle 0 0 0 0 0 1\n"
        "fix rim all mpm/boundary region rim stick\n"
        "fix hub all mpm/boundary region hub stick\n"
        "fix solve all mpm/implicit static\ntimestep 0.5\nrun 2\n");
    const double a = 0.16, b = 0.81, exact = -4.0 * PI * 100.0 / 2.6 * a * b / (b - a) * 0.1;
    EXPECT_NEAR(
        measured(hole ? "in a hole: torque over that of theory" : "torque over that of theory",
                 run.fix("hub")->compute_vector(5) / exact),
        1.0, 0.02);
  }
}

// a slip grip holds whole nodes: a gauge of ten spacings is off by 0.65 of one at most
SERIAL_TEST(Bar, IsPulledByAGripThatSlips)
{
  for (const double length : {1.0, 1.03, 1.07}) {
    Scene run(
        plane("lj", "f f", "0 2.4 -0.2 1.2", 1, 0.1) +
        body("block 0 1.5 0 1 INF INF", "density 1 neohookean 100 0.0", "0.1 stress gradient") +
        "variable way equal 0.16*time\n" +
        strprintf("region grip block %g 2.3 INF INF INF INF move v_way NULL NULL\n", length) +
        "fix end all mpm/boundary xlo slip\nfix pull all mpm/boundary region grip slip\n"
        "fix solve all mpm/implicit static\ntimestep 0.1\nrun 10\n");
    const double stretch = 1.0 + 0.16 / length, exact = -50.0 * (stretch * stretch - 1.0) / stretch,
                 force = run.fix("pull")->compute_vector(0);
    EXPECT_NEAR(measured(strprintf("at %g: force over that of theory", length), force / exact), 1.0,
                0.065);
    EXPECT_NEAR(run.fix("end")->compute_vector(0) / force, -1.0, 1e-6);
  }
}

// a plate holds as soon as nodes on both sides of its surface see material: a warning tells of gaps
SERIAL_TEST(Block, IsHeldAcrossAGap)
{
  for (const char *kind : {"stick", "slip"})
    for (const double gap : {0.0, 0.05}) {
      const auto said = lines_that_say(
          press(0.0, "-0.0075*step", strprintf("INF INF %g 2.2", 1.0 + gap), kind) + "run 2\n",
          "Fix mpm/boundary press: its region plate holds material near");
      EXPECT_EQ(said.size(), gap > 0.0 ? 1u : 0u) << kind << gap;
    }
  EXPECT_TRUE(lines_that_say(press(0.3, "-0.01*step", "INF INF 1 2.2", "stick") + "run 14\n",
                             "across a gap")
                  .empty());
}

// linear functions in the updated frame are told
SERIAL_TEST(Shape, LinearIsTold)
{
  for (const char *options : {"shape linear", "shape linear frame total", "shape quadratic"}) {
    const auto said = lines_that_say(
        plane("lj", "f f", "-2 2 0 2.4", 1, 0.05) +
            body("block -0.5 0.5 0 1 INF INF", "density 1 neohookean 100 0.0",
                 std::string("0.1 ") + options) +
            "fix floor all mpm/boundary ylo slip\nfix solve all mpm/implicit static\nrun 0\n",
        "forces jump when points go from cell to cell");
    EXPECT_EQ(said.size(), std::string(options) == "shape linear" ? 1u : 0u) << options;
  }
}

// what comes from farther away is an error
SERIAL_TEST(Block, ComesFromTooFar)
{
  for (const char *floor : {"ylo separate", "region ground separate"})
    for (const double gap : {2.5, 3.0, 4.0}) {
      const std::string scene = above(floor, gap, "", 0.0) +
          strprintf("velocity all set 0 %.17g 0\n", -gap * 0.0625 - 0.04) +
          "fix solve all mpm/implicit euler solver multigrid\ntimestep 1.0\n";
      if (gap > 2.5)
        expect_error(scene + "run 1\n", "within 2.5 node spacings");
      else
        Scene run(scene + "run 1\n");
    }
}

// a block that falls comes to rest where it does in small steps
SERIAL_TEST(Block, Falls)
{
  for (const double gap : first_of(1, {2.5, 0.3, 1.0, 2.0})) {
    double force[2], mean[2];
    for (const int many : {0, 1}) {
      const double dt = many ? 0.005 : 0.1, speed = (gap * 0.0625 + 0.02) / 0.1;
      Scene run(above("ylo separate", gap, "", 0.0) +
                strprintf("velocity all set 0 %.17g 0\nfix g all gravity 10 vector 0 -1 0\n"
                          "fix solve all mpm/implicit euler solver multigrid\n"
                          "compute e all mpm/energy\nthermo_style custom step c_e[10]\n"
                          "timestep %g\nrun %d\n",
                          -speed, dt, many ? 800 : 40));
      force[many] = -run.fix("floor")->compute_vector(1);
      mean[many] = mean_height(run);
    }
    const std::string name = strprintf("from %g: ", gap);
    EXPECT_NEAR(measured(name + "force over weight", force[0] / 2500.0), 1.0, 1e-5);
    EXPECT_NEAR(measured(name + "force over weight, small steps", force[1] / 2500.0), 1.0, 1e-5);
    // of small steps, the last ones come to rest within NEXT_TO of the floor
    EXPECT_NEAR(measured(name + "mean height, in spacings", (mean[0] - mean[1]) / 0.0625), 0.0,
                0.06);
  }
}

TEST(Contact, Ranks)
{
  for (const char *kind : {"stick", "slip"}) {
    OnRanks run(above("ylo slip", 0.0, "", 0.0) +
                    "variable way equal -0.03*time\n"
                    "region plate block INF INF 0.5 0.9 INF INF move NULL v_way NULL\n"
                    "fix press all mpm/boundary region plate " +
                    kind + "\nfix solve all mpm/implicit static tolerance 1e-10\ntimestep 0.5\n",
                "run 4\n", "processors * 1 1\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-9) << kind;
  }
  {
    OnRanks run(above("ylo slip", 0.0, "", 0.0) +
                    "fix g all gravity 100 vector 1 0 0\nvariable way equal 0.02*time\n"
                    "region grip block INF INF 0.37 0.9 INF INF move NULL v_way NULL\n"
                    "fix pull all mpm/boundary region grip stick\n"
                    "fix solve all mpm/implicit static tolerance 1e-10\ntimestep 0.5\n",
                "run 3\n", "processors 1 * 1\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-9) << "grip";
  }
  for (const char *floor :
       {"region ground slip friction 0.3", "region ground separate friction 0.3"}) {
    OnRanks run(block(floor, "", 0.02, 0.2, "static tolerance 1e-10"), "run 2\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-9);
  }
  for (const char *floor : {"ylo separate", "region ground separate", "region hill separate"})
    for (const double gap : {1.0, 2.5}) {
      OnRanks run(above(floor, gap, "", 0.0) +
                      "velocity all set 0.1 -1.7 0\n"
                      "fix solve all mpm/implicit euler tolerance 1e-10\ntimestep 0.1\n",
                  "run 2\n", "processors 1 * 1\n");
      EXPECT_LT(measured("difference", run.difference()), 1e-9) << floor << gap;
    }
}

SERIAL_TEST(Contact, BadInput)
{
  const auto scene = block("region ground slip friction 0.3", "", 0.0, 0.0, "static");
  const auto frictionless = replaced(scene, "slip friction 0.3", "slip");
  expect_error(replaced(scene, "static", "static slip 0"), "slip");
  expect_error(replaced(scene, "static", "static slip -1"), "slip");
  expect_error(replaced(frictionless, "static", "static slip 1e-6") + "run 1\n", "there are none");
}

// where another wall holds a node, it bears the friction of the first one, in any order of the two:
// each energy is counted once
SERIAL_PARAMETER_TEST(Corner, LedgerCloses, const char *,
                      Values("midpoint", "newmark", "euler", "static"))
{
  const std::string implicit = GetParam();
  const char *const walls[][2] = {{"xlo slip", "ylo separate friction 0.3"},
                                  {"ylo separate friction 0.3", "xlo slip"},
                                  {"xlo slip friction 0.2", "ylo slip friction 0.3"},
                                  {"region left slip", "region low separate friction 0.3"}};
  for (const auto &[first, second] : walls)
    for (const char *transfer : {"flip 1.0", "apic"}) {
      if (implicit == (strcmp(transfer, "apic") == 0 ? "newmark" : "static")) continue;
      const double at = first[0] == 'r' ? 2.0 : 0.0;
      Scene run(
          plane("lj", "f f", "0 12 0 10", 1, 0.3) +
          strprintf("fix grid all mpm 1 transfer %s\nregion body block %g %g %g %g INF INF\n"
                    "region left block INF %g INF INF INF INF\n"
                    "region low block INF INF INF %g INF INF\n",
                    transfer, at, at + 4, at, at + 4, at, at) +
          "create_points 1 region body ppc 2\n"
          "fix m all mpm/material density 1 neohookean 4.5 0.4\n" +
          strprintf("fix w1 all mpm/boundary %s\nfix w2 all mpm/boundary %s\n", first, second) +
          "fix g all gravity 0.045 vector 0 -1 0\nfix solve all mpm/implicit " + implicit +
          "\ncompute e all mpm/energy\nthermo_style custom step c_e\ntimestep 0.167\nrun 8\n");
      const double *const e = run.compute_vector("e");
      double scale = 0.0;
      for (int k = 0; k < 10; k++) scale = std::max(scale, std::fabs(e[k]));
      EXPECT_LT(measured(strprintf("%s, %s, %s, %s", implicit.c_str(), transfer, first, second),
                         std::fabs(e[10]) / scale),
                1e-12);
    }
}

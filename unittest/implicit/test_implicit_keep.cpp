// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks
// mpi: 1 4

// Fix mpm/implicit: what steps with inertia keep for the next ones.

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** A clamped beam of 10 by 1, 4 cells deep, falls from rest and swings by half of its length. */
static std::string swing(const std::string &options, const std::string &implicit, double cfl)
{
  const double h = 0.025, c = std::sqrt(0.7e6 / 0.52 / 1000.0);
  return plane("si", "f f", "0 1.2 -0.9 0.4", 1, 0.3 * h) +
      body("block 0 1 0 0.1 INF INF", "density 1000 neohookean 1e6 0.3", "0.025 " + options) +
      "fix clamp all mpm/boundary xlo stick\nfix g all gravity 1.9 vector 0 -1 0\n" +
      "fix solve all mpm/implicit " + implicit + strprintf("\ntimestep %.17g\n", cfl * h / c);
}

// factors of a tangent serve several steps, and lead to where conjugate gradients do
SERIAL_TEST(Keep, FactorsServeSeveralSteps)
{
  struct Case {
    const char *options, *method;
    double cfl;
    int steps;
    double made, iterations;    // at most: factors, iterations in a step
  };
  for (const auto &c : {Case{"frame total transfer flip 1.0", "newmark", 20.0, 60, 6.0, 9.0},
                        Case{"frame total transfer flip 1.0", "newmark", 100.0, 16, 4.0, 12.5},
                        Case{"frame total transfer flip 1.0", "alpha rho 0.5", 50.0, 30, 5.0, 10.5},
                        Case{"frame total", "euler", 50.0, 30, 6.0, 8.5}}) {
    std::vector<double> x[2];
    for (const bool keeps : {false, true}) {
      Scene run(swing(c.options,
                      std::string(c.method) + " tolerance 1e-10 solver " +
                          (keeps ? "multigrid" : "blocks"),
                      c.cfl) +
                strprintf("run %d\n", c.steps));
      x[keeps] = places(run);
      const double made = solved(run, 10), iterations = solved(run, 5) / c.steps;
      if (!keeps) {
        EXPECT_EQ(made, 0.0);
        continue;
      }
      const auto name = strprintf("%s, CFL %g: ", c.method, c.cfl);
      EXPECT_LE(measured(name + "factors", made), c.made);
      EXPECT_LE(measured(name + "iterations in a step", iterations), c.iterations);
      EXPECT_GE(made, 1.0);
    }
    EXPECT_LT(measured("difference", largest_difference(x[0], x[1])), 1e-6);
  }
}

// where points come to other cells, nothing that was kept for the nodes before is of use
SERIAL_TEST(Keep, OnlyWhileNodesAreTheSame)
{
  for (const char *method : {"midpoint", "euler"}) {
    std::vector<double> x[2];
    for (const bool keeps : {false, true}) {
      Scene run(replaced(swing("",
                               std::string(method) + " tolerance 1e-10 solver " +
                                   (keeps ? "multigrid" : "blocks"),
                               10.0),
                         "gravity 1.9", "gravity 1.0") +
                "run 30\n");
      x[keeps] = places(run);
      if (keeps) EXPECT_GE(measured("factors", solved(run, 10)), 15.0);
    }
    EXPECT_LT(measured("difference", largest_difference(x[0], x[1])), 1e-6) << method;
  }
}

// points of a beam that bends come to other ranks, and its nodes with them: what is kept goes along
TEST(Keep, NodesMayChangeRanks)
{
  for (const char *processors : {"processors * 1 1\n", "processors 1 * 1\n"}) {
    Scene run(processors +
              swing("frame total transfer flip 1.0", "newmark solver multigrid", 50.0) +
              "run 24\n");
    EXPECT_LE(measured("factors", solved(run, 10)), 2.0);
    EXPECT_LE(measured("iterations in a step", solved(run, 5) / 24.0), 8.0);
  }
}

// of a wall that moves, and begins to in the run
SERIAL_TEST(Keep, WallsMayMove)
{
  std::vector<double> x[2];
  for (const bool keeps : {false, true}) {
    Scene run(replaced(swing("frame total transfer flip 1.0",
                             std::string("newmark tolerance 1e-10 solver ") +
                                 (keeps ? "multigrid" : "blocks"),
                             20.0),
                       "fix clamp all mpm/boundary xlo stick\n",
                       "variable shake equal 0.3*sin(5*time)\nfix clamp all mpm/boundary xlo stick "
                       "velocity 0 v_shake 0\n") +
              "run 20\n");
    x[keeps] = places(run);
    if (keeps) EXPECT_LE(measured("factors", solved(run, 10)), 6.0);
  }
  EXPECT_LT(measured("difference", largest_difference(x[0], x[1])), 1e-6);
}

// four ranks do what one does; a run goes on from a restart file to the last bit
TEST(Keep, RanksAndRestart)
{
  for (const std::string method : {"newmark", "alpha rho 0.5"}) {
    const auto scene =
        swing("frame total transfer flip 1.0", method + " tolerance 1e-11 solver multigrid", 50.0);
    const auto fixes = lines_again(scene);
    Twins(scene, 6, fixes, 6, 1e-9);

    const ScratchFile file("keep.restart");
    Scene whole(scene + "restart 6 " + file.name + " " + file.name + "\nrun 10\n");
    Scene again("read_restart " + file.name + "\n" + fixes + "run 4\n");
    EXPECT_TRUE(identical(whole.gather(), again.gather())) << method;
  }
}

// statics of a body that nothing holds is told at once, of two bodies, and along a slope
SERIAL_TEST(Free, BodiesAreToldAtOnce)
{
  const std::string two = plane("si", "f f", "0 2 0 2", 1, 0.02) +
      "fix grid all mpm 0.1\nregion a block 0 0.5 0 0.5 INF INF\nregion b block 1 1.5 1 1.5 INF "
      "INF\n"
      "create_points 1 region a ppc 2\ncreate_points 1 region b ppc 2\n"
      "fix m all mpm/material density 1000 neohookean 1e6 0.3\ngroup free region b\n"
      "fix floor all mpm/boundary ylo stick\nfix solve all mpm/implicit static\ntimestep 1.0\n";
  expect_error(two + "fix g free gravity 1.0 vector 0 -1 0\nrun 1\n",
               "the body around (1.25, 1.25, 0) is held by no wall along the force (0, -250, 0)");
  Scene rests(two + "fix g all gravity 0.0 vector 0 -1 0\nrun 1\n");

  const auto slides = [](const char *along) {
    return plane("si", "p f", "0 1 0 2", 1, 0.02) +
        body("block INF INF 0 1 INF INF", "density 1000 neohookean 1e6 0.3", "0.1") +
        "fix floor all mpm/boundary ylo slip\nfix g all gravity 1.0 vector " + along +
        "\nfix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n";
  };
  expect_error(slides("1 -1 0"), "along the force (707.1, 0, 0)");
  Scene pressed(slides("0 -1 0"));

  // components that have different signs do not make the forces small
  expect_error(
      space("si", "f f f", "0 1 0 1 0 1") +
          body("block 0.25 0.75 0.25 0.75 0.25 0.75", "density 1000 neohookean 1e6 0.3", "0.25") +
          "fix g all gravity 1.0 vector 0 1 -1\nfix solve all mpm/implicit static\n"
          "timestep 1.0\nrun 1\n",
      "along the force (0, 88.39, -88.39)");
}

// A rigid motion that walls leave free has no stiffness: of all solutions the one without it is
// found, between frictionless platens, in a bar, and in a periodic cell that is heated
TEST(Free, MotionsAreNotMade)
{
  const auto solve = [](const std::string &solver) {
    return "fix solve all mpm/implicit static tolerance 1e-8 solver " + solver +
        "\ntimestep 1.0\nrun 3\n";
  };
  const auto mean = [](Scene &run, int d) {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += run.x()[i][d];
    double all;
    MPI_Allreduce(&sum, &all, 1, MPI_DOUBLE, MPI_SUM, run.lmp->world);
    return all / run.lmp->atom->natoms;
  };
  for (const char *solver : {"multigrid", "blocks"})
    for (const char *frame : {"frame total", ""}) {
      SCOPED_TRACE(std::string(solver) + frame);
      Scene platens(plane("si", "f f", "0 1.2 -2 2", 1, 0.03) +
                    body("block 0 1.2 0.2 1.05 INF INF", "density 1000 neohookean 1e6 0.3",
                         std::string("0.1 ") + frame) +
                    "fix one all mpm/boundary xlo slip\nfix two all mpm/boundary xhi slip velocity "
                    "-0.01 0 0\n" +
                    solve(solver));
      EXPECT_NEAR(mean(platens, 1), 0.625, 1e-9);
      if (!*frame) {    // one that moves, with which contact is decided
        Scene press(plane("si", "f f", "0 1.2 -2 2", 1, 0.03) +
                    body("block 0 1.2 0.2 1.05 INF INF", "density 1000 neohookean 1e6 0.3", "0.1") +
                    "fix one all mpm/boundary xlo slip\nvariable way equal -0.01*step\nregion two "
                    "plane 1.2 0 0 1 0 0 move v_way NULL NULL\nfix two all mpm/boundary region two "
                    "slip\n" +
                    solve(solver));
        EXPECT_NEAR(mean(press, 1), 0.625, 1e-9);
      }

      Scene bar(space("si", "f f f", "0 0.6 -1 1 -1 1", 1, 0.03) +
                body("block 0 0.6 0 0.4 0 0.4",
                     "density 1000 orthotropic 1e6 1e6 1e6 0.45 0.05 0.1 4e5 4e5 4e5",
                     std::string("0.1 ") + frame) +
                "fix one all mpm/boundary xlo slip\nfix two all mpm/boundary xhi slip velocity "
                "-0.02 0 0\n" +
                solve(solver));
      double turned = 0.0;
      for (int i = 0; i < bar.n(); i++) turned += bar.points().F[i][5] - bar.points().F[i][7];
      EXPECT_NEAR(measured("turned", turned / bar.lmp->atom->natoms), 0.0, 1e-9);
      EXPECT_NEAR(mean(bar, 1), 0.2, 1e-9);
      EXPECT_NEAR(mean(bar, 2), 0.2, 1e-9);
    }
}

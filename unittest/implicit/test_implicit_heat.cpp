// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// Fix mpm/implicit with fix mpm/heat: thermal stress in steps of any length.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** A quantity of compute mpm/atom of all points. */
static std::vector<double> quantity(Scene &run, const std::string &name)
{
  run.commands("compute q all mpm/atom " + name + "\nthermo_style custom step\n");
  auto *const compute = run.lmp->modify->get_compute_by_id("q");
  compute->compute_peratom();
  std::vector<double> values(compute->vector_atom, compute->vector_atom + run.n());
  run.commands("uncompute q\n");
  return values;
}

/** A bar of length 1 between two walls, free at its sides: E = 1e9, nu = 0.25, alpha = 1e-5. */
static std::string bar_between_walls(const std::string &grid, const std::string &heat,
                                     const std::string &solve)
{
  return plane("si", "f f", "0 1 -0.3 0.5", 1, 0.01) +
      "region bar block 0 1 0 0.2 INF INF\ncreate_points 1 region bar spacing 0.025\n"
      "fix grid all mpm 0.05 " +
      grid +
      "\nfix m all mpm/material density 1000 linear 1e9 0.25 thermal conducting 1000 0 50 "
      "expansion 1e-5\nfix left all mpm/boundary xlo slip\nfix right all mpm/boundary xhi slip\n"
      "fix middle all mpm/boundary ylo slip\n"
      "fix heat all mpm/heat " +
      heat + "\nfix solve all mpm/implicit " + solve + "\n";
}

/** A tube with the radii 1 and 2, plane strain, at T = 100 at its bore and 0 outside. */
static std::string tube(int n, const std::string &solve, const std::string &time, double dt,
                        const std::string &shape = "quadratic")
{
  const double h = 1.0 / n;
  return plane("si", "f p", strprintf("1 2 0 %.17g", 2 * h), 1, 0.3 * h) +
      strprintf("fix grid all mpm %.17g frame total axisymmetric yes shape %s\n", h,
                shape.c_str()) +
      "create_points 1 box ppc 2\n"
      "fix m all mpm/material density 1000 linear 1e9 0.25 thermal conducting 1000 0 50 "
      "expansion 1e-8\n"
      "fix heat all mpm/heat xlo temperature 100 xhi temperature 0 " +
      time + "\nfix solve all mpm/implicit " + solve + strprintf("\ntimestep %g\n", dt);
}

/** Stresses of a free tube in plane strain with the steady temperature 100 ln(2/r)/ln 2 (S.P.
 *  Timoshenko, J.N. Goodier, Theory of Elasticity, 3rd ed., 1970, art. 151). */
static void tube_stress(double r, double &radial, double &hoop)
{
  const double a = 1.0, b = 2.0, E = 1e9, nu = 0.25, alpha = 1e-8, all = std::log(b / a),
               factor = E * alpha * 100.0 / (2.0 * (1.0 - nu) * all),
               part = a * a / (b * b - a * a) * all;
  radial = factor * (-std::log(b / r) - part * (1.0 - b * b / (r * r)));
  hoop = factor * (1.0 - std::log(b / r) - part * (1.0 + b * b / (r * r)));
}

// heated by a source, in one step and in several: sigma = -E alpha T/(1 - nu) in plane strain
PARAMETER_TEST(Bar, HasThermalStress, const char *, Values("frame total", ""))
{
  const std::string grid = GetParam();
  for (const int steps : {1, 4}) {
    Scene run("variable s atom 1e8\n" + bar_between_walls(grid, "source v_s time euler", "static") +
              strprintf("timestep %.17g\nrun %d\n", 1.0 / steps, steps));
    const double T = 100.0, exact = -1e9 * 1e-5 * T / 0.75;
    EXPECT_NEAR(Warm(run).T(0), T, 0.1);    // a power per present volume, which grows by 0.1 %
    const auto xx = quantity(run, "stress/xx"), yy = quantity(run, "stress/yy");
    double sum = 0.0, most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      sum += xx[i] / run.n();
      most = std::max(most, std::fabs(yy[i]));
    }
    EXPECT_NEAR(measured(strprintf("%d steps, stress", steps), sum / exact), 1.0,
                grid.empty() ? 0.01 : 0.003);
    EXPECT_LT(most, 1e-5 * std::fabs(exact));
    EXPECT_NEAR(measured("wall", run.fix("left")->compute_vector(0) / (exact * 0.2)), 1.0, 0.01);
    EXPECT_NEAR(run.fix("right")->compute_vector(0) / (exact * 0.2), -1.0, 0.01);
  }
}

// the steady state of a tube in steps of 1e9 s. With quadratic functions the stress of single
// points alternates in a cell, and the error is one of first order, 3.2 % with 16 cells. Surfaces
// along the lattice are those where stress mls is the better one
SERIAL_PARAMETER_TEST(Tube, HasThermalStress, const char *, Values("cubic stress mls", "cubic"))
{
  const bool mls = std::string(GetParam()) != "cubic";
  double error[2];
  for (int k = 0; k < 2; k++) {
    Scene run(tube(8 << k, "static", "time euler", 1e9, GetParam()) + "run 3\n");
    const auto rr = quantity(run, "stress/xx"), tt = quantity(run, "stress/zz");
    double sum = 0.0, all = 0.0;
    for (int i = 0; i < run.n(); i++) {
      double radial, hoop;
      tube_stress(run.x()[i][0], radial, hoop);
      sum += (rr[i] - radial) * (rr[i] - radial) + (tt[i] - hoop) * (tt[i] - hoop);
      all += radial * radial + hoop * hoop;
    }
    error[k] = measured(strprintf("%d cells, rms error of stresses", 8 << k), std::sqrt(sum / all));
  }
  EXPECT_LT(error[1], mls ? 0.002 : 0.0027);
  EXPECT_GT(measured("order", std::log2(error[0] / error[1])), mls ? 1.5 : 1.4);
}

// each step is in equilibrium with the temperatures of its end, whatever the way
SERIAL_TEST(Tube, DoesNotDependOnSteps)
{
  double outer[2];
  for (int k = 0; k < 2; k++) {
    Scene run(tube(8, "static tolerance 1e-11", "time sdirk2", k ? 2e3 : 2e5) +
              strprintf("run %d\n", k ? 300 : 3));
    outer[k] = 0.0;
    for (int i = 0; i < run.n(); i++) outer[k] = std::max(outer[k], run.x()[i][0]);
    // a strain of 1e-6 is known to 2e-10 of itself
    EXPECT_LT(run.fix("solve")->compute_scalar(), 1e-9);
  }
  // the displacement of the outer surface is alpha T b (1 + nu) times about a half
  EXPECT_NEAR(measured("difference", (outer[0] - outer[1]) / 1e-6), 0.0, 2e-3);
}

// with inertia, and explicit conduction, too
SERIAL_TEST(Bar, WithInertia)
{
  for (const char *time : {"time sdirk2", "stages 16"}) {
    Scene run("variable s atom 1e8\n" +
              bar_between_walls("frame total", std::string("source v_s ") + time, "euler") +
              "timestep 0.1\nrun 10\n");
    const double exact = -1e9 * 1e-5 * 100.0 / 0.75;
    const auto xx = quantity(run, "stress/xx");
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += xx[i] / run.n();
    EXPECT_NEAR(measured("stress", sum / exact), 1.0, 0.003);
  }
}

TEST(Heat, RanksAndRestart)
{
  const auto scene = tube(8, "static tolerance 1e-11", "time sdirk2 tolerance 1e-12", 2e3);
  Twins(scene, 3, lines_again(scene), 3, 1e-9);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 3 4

// Implicit viscosity of fix mpm/incompressible: honey, in steps far beyond the explicit limit.

#include "mpm_lammps.h"

using namespace MPM_TEST;

enum { DIVERGENCE = 2, KINETIC = 5, FASTEST = 6 };

/** The longest step of explicit viscosity. */
double explicit_dt(double h, double nu, int dim)
{
  return h * h / (2.0 * dim * nu);
}

/** Slow vortices of Taylor and Green on n x n cells: amplitude at t, over exp(-2 nu k^2 t). */
double vortices_left(int n, double t, int steps)
{
  Scene run(
      plane("si", "p p", "0 1 0 1", 1, 0.02) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 / n) +
      "variable vx atom -1e-6*cos(2*PI*x)*sin(2*PI*y)\n"
      "variable vy atom 1e-6*sin(2*PI*x)*cos(2*PI*y)\nvelocity all set v_vx v_vy 0.0\n" +
      strprintf("fix w all mpm/incompressible %.17g 1.0 viscosity 1 implicit yes\n", 1.0 / n) +
      strprintf("timestep %.17g\nrun %d\n", t / steps, steps));
  return std::sqrt(4e12 * run.fix("w")->compute_vector(KINETIC)) / std::exp(-8.0 * PI * PI * t);
}

/** A sheet of length 4, 0.4 thick across its middle, is stretched: u = U sin(pi x/4). */
std::string sheet(double h, double offset, double nu)
{
  return plane("si", "p p", "-2.6 2.6 -0.6 0.6", 1, 0.02) +
      strprintf("region b block -2 2 %.17g %.17g INF INF\n", offset - 0.2, offset + 0.2) +
      strprintf("create_points 1 region b spacing %.17g\n", 0.5 * h) +
      "variable vx atom 1e-3*sin(PI*x/4)\n" +
      strprintf("variable vy atom -1e-3*(y-%.17g)*PI/4*cos(PI*x/4)\n", offset) +
      "velocity all set v_vx v_vy 0\n" +
      strprintf("fix w all mpm/incompressible %.17g 1 viscosity %g implicit yes\n", h, nu);
}

// H2: from rest to an unsteady time, of first order in the step, and to steady flow in any steps
SERIAL_TEST(Plates, CouetteAndPoiseuille)
{
  const auto at_half = [](Scene &scene) {
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < scene.n(); i++) {
      if (std::fabs(scene.x()[i][1] - 0.5) > 1.01 / 20) continue;
      sum += scene.v()[i][0];
      weight += 1.0;
    }
    return sum / weight;
  };
  const auto plates = plane("si", "p f", "0 0.2 0 1", 1, 0.02) +
      "create_points 1 box spacing 0.025\nfix w all mpm/incompressible 0.05 1 viscosity 1 "
      "implicit yes wall ylo stick ";
  constexpr double slow = 1e-6;
  for (const bool force : {false, true}) {
    const auto scene = plates +
        (force ? "wall yhi stick\nfix g all gravity 8e-6 vector 1 0 0\n"
               : "wall yhi stick 1e-6 0\n");
    const double exact = force ? 0.615353 : 0.262756;
    double error[3];
    for (const int k : {0, 1, 2}) {
      const int steps = 20 << k;
      Scene run(scene + strprintf("timestep %.17g\nrun %d\n", 0.1 / steps, steps));
      error[k] = at_half(run) / (slow * exact) - 1.0;
    }
    const double limit = 2.0 * error[2] - error[1];    // without that of the first order
    measured("error with 40 steps", error[1]);
    EXPECT_LT(std::fabs(measured("error for short steps", limit)), 0.01);
    EXPECT_NEAR(measured("order", std::log2((error[0] - error[1]) / (error[1] - error[2]))), 1.0,
                0.1);
    Scene steady(scene + "timestep 1000\nrun 2\n");
    // the mean of the parabola over the points that are looked at
    EXPECT_NEAR(measured("steady", at_half(steady) / slow), force ? 1.0 : 0.5, 0.005);
  }
}

// a hundred times the explicit limit, 0.67 in a step; backward Euler: 1/(1 + 2 nu k^2 dt)
SERIAL_TEST(Vortices, DecayWithLongSteps)
{
  const int n = 64;
  const double dt = 100.0 * explicit_dt(1.0 / n, 1.0, 2), rate = 8.0 * PI * PI;
  double error[3];
  for (const int k : {0, 1, 2}) {
    const double step = dt / (1 << k), left = vortices_left(n, dt, 1 << k);
    const double euler = std::pow(1.0 + rate * step, -(1 << k)) * std::exp(rate * dt);
    EXPECT_NEAR(measured("amplitude over that of Euler", left / euler), 1.0, 0.002);
    error[k] = left - 1.0;
  }
  measured("error of one step", error[0]);
  EXPECT_GT(measured("order", std::log2(error[1] / error[2])), 0.8);
  EXPECT_LT(error[2], error[1]);
}

// Trouton: a sheet resists its stretching with 4 mu. Its velocity decays with 4 nu k^2, however
// long steps are. Without the pressure that belongs to viscous stress: 2 mu
SERIAL_TEST(Sheet, Trouton)
{
  constexpr double t = 0.2, rate = 4.0 * (PI / 4) * (PI / 4);
  // of the rate of decay; steps, cells across half of the sheet, distance of its middle from a face
  const auto error = [&](int steps, int n, double offset) {
    const double h = 0.2 / n;
    Scene run(sheet(h, offset * h, 1.0) + strprintf("timestep %.17g\nrun %d\n", t / steps, steps));
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double mode = std::sin(PI * run.x()[i][0] / 4);
      sum += run.v()[i][0] * mode;
      weight += 1e-3 * mode * mode;
    }
    const double euler = std::pow(1.0 + rate * t / steps, -steps);
    return measured(strprintf("%d steps, %d cells, %g: error", steps, 2 * n, offset),
                    std::fabs(std::log(sum / weight) / std::log(euler) - 1.0));
  };
  for (const int steps : {2, 10}) {
    EXPECT_LT(error(steps, 4, 0.0), 0.02);
    for (const double offset : {0.26, 0.5}) EXPECT_LT(error(steps, 4, offset), 0.05);
  }
  EXPECT_LT(error(2, 16, 0.5), 0.02);
}

// a film on a floor: the shear stress is zero at the surface, wherever this is in a cell
SERIAL_TEST(Film, SurfaceAnywhere)
{
  for (const int dim : {2, 3})
    for (const int rows : {40, 41, 42, 43}) {
      const double H = 0.0125 * rows, g = 1e-5;
      Scene run(box(dim, "si", "p f p", "0 0.1 0 1 0 0.1", 1, 0.02) +
                strprintf("region w block INF INF 0 %.17g INF INF\n", H + 1e-6) +
                "create_points 1 region w spacing 0.0125\nfix w all mpm/incompressible 0.025 1 "
                "viscosity 1 implicit yes wall ylo stick\n" +
                strprintf("fix g all gravity %.17g vector 1 -3 0\n", g * std::sqrt(10.0)) +
                "timestep 100\nrun 2\n");
      double sum = 0.0, exact = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double y = run.x()[i][1];
        sum += run.v()[i][0];
        exact += g * (y * H - 0.5 * y * y);
      }
      EXPECT_NEAR(
          measured(strprintf("%dd, depth %g: flow over that of theory", dim, H), sum / exact), 1.0,
          8e-4);
    }
}

// nothing moves in a tank whose walls stick, and it carries its weight
SERIAL_TEST(Tank, AtRest)
{
  for (const double depth : {0.5, 0.525, 0.53}) {
    Scene run(plane("si", "f f", "0 1 0 1", 1, 0.02) +
              strprintf("region w block INF INF 0 %.17g INF INF\n", depth) +
              "create_points 1 region w spacing 0.025\nfix w all mpm/incompressible 0.05 1000 "
              "viscosity 1000 implicit yes wall ylo stick wall xlo stick wall xhi stick tolerance "
              "1e-11\nfix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\nrun 100\n");
    EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 1e-12);
    EXPECT_NEAR(run.fix("w")->compute_vector(9) / (9810 * 0.5), depth / 0.5, 0.03);
  }
}

// rigid rotation is without stress: honey turns as without viscosity, and momentum stays
SERIAL_TEST(Blob, TurnsRigidly)
{
  for (const int dim : {2, 3}) {
    double left[2];
    for (const int k : {0, 1}) {
      Scene run(box(dim, "si", "p p p", "-0.5 0.5 -0.5 0.5 -0.5 0.5", 1, 0.02) +
                "region b block -0.31 0.27 -0.2 0.17 " + (dim == 3 ? "-0.2 0.2" : "INF INF") +
                "\n" +
                "create_points 1 region b spacing 0.03125\n"
                "variable vx atom -0.5*(y-0.0003)+0.03\nvariable vy atom 0.5*(x+0.02)\n"
                "velocity all set v_vx v_vy 0\nfix w all mpm/incompressible 0.0625 1000 " +
                std::string(k ? "viscosity 1e5 implicit yes" : "") + "\ntimestep 0.02\nrun 0\n");
      const auto before = run.sums();
      const double energy = run.fix("w")->compute_vector(KINETIC);
      run.commands(dim == 3 ? "run 10\n" : "run 50\n");
      const auto after = run.sums();
      left[k] = after.L[2] / before.L[2];
      measured(strprintf("%dd: angular momentum that is left", dim), left[k]);
      measured("energy that is left", run.fix("w")->compute_vector(KINETIC) / energy);
      for (int d = 0; d < 2; d++)
        EXPECT_NEAR(after.p[d] / before.p[0], before.p[d] / before.p[0], 0.02);
      EXPECT_NEAR(left[k], 1.0, 0.003);
    }
  }
}

// one step changes neither momentum nor angular momentum of a blob that is stretched and sheared
SERIAL_TEST(Blob, KeepsMomentaInAStep)
{
  double change[2];
  for (const int k : {0, 1}) {
    Scene run(plane("si", "p p", "-0.5 0.5 -0.5 0.5", 1, 0.02) +
              "region b block -0.25 0.25 -0.1875 0.1875 INF INF\n"
              "create_points 1 region b spacing 0.015625\n"
              "variable vx atom 0.5*x+0.2*y+3*x*y\nvariable vy atom -0.5*y+0.7*x-1.5*y*y\n"
              "velocity all set v_vx v_vy 0\nfix w all mpm/incompressible 0.03125 1000 spread 0 " +
              std::string(k ? "viscosity 1e5 implicit yes" : "") + "\ntimestep 0.001\nrun 0\n");
    const auto before = run.sums();
    run.commands("run 1\n");
    change[k] = run.sums().L[2] / before.L[2] - 1.0;
    measured("change of angular momentum", change[k]);
  }
  EXPECT_LT(std::fabs(change[1]), 0.01);
}

// energy never grows, whatever flows, and however long steps are
SERIAL_TEST(Blob, EnergyNeverGrows)
{
  for (const int dim : {2, 3})
    for (const double mu : {1.0, 1e2, 1e4}) {
      Scene run(
          box(dim, "si", "f f f", "0 1 0 1 0 0.25", 1, 0.02) +
          "region b block 0.2 0.8 INF 0.7 INF INF\ncreate_points 1 region b spacing 0.03125\n"
          "variable vx atom 0.1*sin(20*y)+0.2*cos(31*x)\nvariable vy atom 0.3*sin(17*x+9*y)\n"
          "velocity all set v_vx v_vy 0\nfix w all mpm/incompressible 0.0625 1000 wall ylo stick "
          "implicit yes viscosity " +
          std::to_string(mu) + "\ntimestep 0.02\n");
      double energy = 1e300, most = 0.0;
      run.each_step([&](double **) {
        double now = 0.0;
        for (int i = 0; i < run.n(); i++)
          for (int d = 0; d < dim; d++) now += run.v()[i][d] * run.v()[i][d];
        most = std::max(most, now / energy);
        energy = now;
      });
      run.commands(dim == 3 ? "run 5\n" : "run 30\n");
      EXPECT_LT(measured(strprintf("%dd, viscosity %g: largest growth in a step", dim, mu), most),
                1.0 + 1e-9);
    }
}

// in all units: the decay of a sheet's velocity by the same number nu dt/h^2
SERIAL_TEST(Units, Viscosity)
{
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene run(plane(units, "p f", "0 4 0 10", 1, 0.3) + "create_points 1 box spacing 0.5\n");
    const double nu = 3.0 * run.lmp->force->ftm2v / (run.lmp->force->nktv2p * 2.0),
                 g = 1e-6 * nu * nu;
    run.commands("fix w all mpm/incompressible 1 2.0 viscosity 3.0 implicit yes wall ylo stick "
                 "wall yhi stick\n" +
                 strprintf("fix g all gravity %.17g vector 1 0 0\n", g / run.lmp->force->ftm2v) +
                 strprintf("timestep %.17g\nrun 2\n", 1000.0 / nu));
    double sum = 0.0, exact = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double y = run.x()[i][1];
      sum += run.v()[i][0];
      exact += g * y * (10.0 - y) / (2.0 * nu);
    }
    EXPECT_NEAR(sum / exact, 1.0, 0.02) << units;
  }
}

// a block of honey on four ranks, balanced; and the same to the last bit from a restart file
TEST(Block, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const auto scene = box(dim, "si", "f f p", "0 1 0 1 0 0.4", 1, 0.02) +
        "region water block INF 0.4 0 0.61 INF INF\n" +
        strprintf("create_points 1 region water spacing %g\n", dim == 3 ? 0.05 : 0.025);
    const auto fixes =
        strprintf("fix w all mpm/incompressible %g 1000 viscosity 50 implicit yes wall ylo stick ",
                  dim == 3 ? 0.1 : 0.05) +
        "wall xlo stick reflect 0.5 tolerance 1e-11\nfix g all gravity 9.81 vector 0 -1 0\n"
        "fix dt all mpm/dt 0.2 max 0.05 every 2\n";
    const std::string first = "timestep 0.005\n";    // what goes on has that of the restart file
    OnRanks run(scene + fixes + first, "run 20\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-10);
    Continued again(scene + fixes + first, 8, "neighbor 0.02 bin\n" + fixes, 14);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

// a step whose viscosity does not converge, as iterations are few, is gone in parts. It has the
// mean velocity between plates that backward Euler has with so many steps, whatever else flows
// there, and the weight on its walls; the same on all ranks
TEST(Parts, EndsAsShorterSteps)
{
  constexpr double dt = 0.005, g = 1e-4;
  const auto mean_of_euler = [](int steps) {
    double sum = 0.0;
    for (int m = 1; m < 2000; m += 2) {
      const double rate = (m * PI) * (m * PI);
      sum += 8.0 / rate * g / rate * (1.0 - std::pow(1.0 + rate * dt / steps, -steps));
    }
    return sum;
  };
  for (const auto &[iterations, parts] : {std::pair(10000, 1), {71, 2}, {62, 4}}) {
    OnRanks run(plane("si", "p f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.025\n" +
                    "variable vx atom 1e-6*sin(6*PI*x)*cos(17*y)\n"
                    "variable vy atom 1e-6*cos(4*PI*x)*sin(9*y)\nvelocity all set v_vx v_vy 0\n" +
                    strprintf("fix w all mpm/incompressible 0.05 1 viscosity 1 implicit yes wall "
                              "ylo stick wall yhi stick iterations %d\n",
                              iterations) +
                    strprintf("fix g all gravity %.17g vector 1 -3 0\ntimestep %.17g\n",
                              g * std::sqrt(10.0), dt),
                "run 1\n");
    double sum = 0.0;
    for (const auto &point : run.serial.gather()) sum += point.v[0] / (40 * 40);
    EXPECT_NEAR(
        measured(strprintf("%d parts: flow over that of Euler", parts), sum / mean_of_euler(parts)),
        1.0, 2e-3);
    for (auto *scene : {&run.serial, &run.parallel}) {
      auto *const fix = scene->fix("w");
      EXPECT_EQ(fix->compute_vector(15), parts);
      EXPECT_EQ(fix->compute_vector(16), std::log2(parts));
      EXPECT_NEAR(
          measured("weight", (fix->compute_vector(9) - fix->compute_vector(10)) / (3.0 * g)), 1.0,
          1e-12);
    }
    EXPECT_LT(measured("difference", run.difference()), 1e-9);
  }
}

// honey that falls, with two solves in steps of other durations than those before, a region, and
// tension: halvings on all ranks, and those of a restart file go on
TEST(Parts, RanksAndRestart)
{
  const auto scene = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region water block INF 0.4 0 0.61 INF INF\ncreate_points 1 region water spacing 0.025\n";
  const std::string fixes =
      "region stone sphere 0.6 0 0 0.15\n"
      "fix w all mpm/incompressible 0.05 1000 viscosity 500 tension 1 implicit yes wall ylo stick "
      "wall xlo stick stick stone tolerance 1e-11 iterations 99\n"
      "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.2 max 0.05 every 5\n";
  OnRanks run(scene + fixes + "timestep 0.005\n", "run 12\n");
  const double many = run.serial.fix("w")->compute_vector(19);
  EXPECT_GT(measured("halvings", many), 5.0);
  EXPECT_EQ(run.parallel.fix("w")->compute_vector(19), many);
  EXPECT_LT(measured("difference", run.difference()), 1e-10);
  Continued again(scene + fixes + "timestep 0.005\n", 4, "neighbor 0.02 bin\n" + fixes, 8);
  EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  EXPECT_EQ(again.whole.fix("w")->compute_vector(19), again.again.fix("w")->compute_vector(19));
}

SERIAL_TEST(Stress, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.05\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "implicit yes", "add the keyword viscosity"},
                  {fix + "viscosity 0 implicit yes", "add the keyword viscosity"},
                  {fix + "viscosity 1 implicit maybe", "maybe"},
                  {fix + "viscosity 1 implicit", "implicit"},
                  {"variable u atom 0.01*sin(PI*y)\nvelocity all set v_u 0 0\n" + fix +
                       "viscosity 1e3 implicit yes iterations 3",
                   "in parts of 1/64 of it, too; allow more iterations"},
                  {"variable u atom 0.01*sin(PI*y)\nvelocity all set v_u 0 0\n" + fix +
                       "viscosity 1e3 implicit yes iterations 3 parts 1",
                   "implicit viscosity did not converge after 3 iterations, residuals "},
                  {fix + "viscosity 1 parts 2", "parts is about implicit viscosity"},
                  {fix + "viscosity 1 implicit yes parts 0", "parts"}},
                 "timestep 0.01\nrun 1\n");
}

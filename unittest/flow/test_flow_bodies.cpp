// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Bodies of fix mpm/rigid in a flow of fix mpm/incompressible: they fall, rise, float, and heel.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Entries of the vector of fix mpm/rigid. */
enum { CENTER = 0, VELOCITY = 3, OMEGA = 6, FORCE = 9, MATRIX = 15 };

double body(Scene &run, int k)
{
  return run.fix("body")->compute_vector(k);
}

/** A cylinder or sphere of radius 0.2 in a full container of radius 0.47, released in gravity. */
std::string gap(int dim, int n, double density, const char *units, double g, double g_body)
{
  const char *const center = dim == 3 ? "0.503 0.511 0.49" : "0.503 0.511 0";
  return box(dim, units, "f f f", "0 1 0 1 0 1", 1, 0.02) +
      strprintf("region out sphere %s 0.47 side out\nregion in sphere %s 0.2\n", center, center) +
      strprintf("region a sphere %s 0.2 side out\nregion b sphere %s 0.47\n", center, center) +
      "region fluid intersect 2 a b\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 / n) +
      strprintf("fix body all mpm/rigid in density %g slip gravity 0 %.17g 0\n", density, -g_body) +
      strprintf("fix w all mpm/incompressible %.17g 1000 spread 0 tolerance 1e-10 region out "
                "region in\n",
                1.0 / n) +
      strprintf("fix g all gravity %.17g vector 0 -1 0\n", g);
}

/** Water 0.4 deep in a tank of 2 x 0.8, a box of 0.4 x 0.2 of half its density off the nodes. */
std::string boat(double h, double density, double y, const std::string &options)
{
  const auto hull = strprintf("block 0.8137 1.2137 %.17g %.17g INF INF", y - 0.1, y + 0.1);
  return plane("si", "f f", "0 2 0 0.8", 1, 0.5 * h) + "region hull " + hull + "\nregion dry " +
      hull +
      " side out\nregion low block INF INF INF 0.4 INF INF\nregion fluid intersect 2 low dry\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 * h) +
      strprintf("fix body all mpm/rigid hull density %g slip gravity 0 -9.81 0 ", density) +
      options + strprintf("\nfix w all mpm/incompressible %.17g 1000 region hull\n", h) +
      "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\n";
}

// also what is lighter or heavier than water sets it in motion: mass and added mass; it is where
// this motion leads, which would be 10 % farther if the first forces acted for a whole step
SERIAL_TEST(Body, IsReleased)
{
  constexpr double a = 0.2, b = 0.47, g = 9.81;
  for (const int dim : {2, 3})
    for (const double density : {1.0, 500.0, 7800.0}) {
      const double a3 = a * a * a, b3 = b * b * b;
      const double added = dim == 3 ? 500.0 * (b3 + 2.0 * a3) / (b3 - a3)
                                    : 1000.0 * (b * b + a * a) / (b * b - a * a);
      const double exact = (1000.0 - density) / (density + added) * g;
      Scene run(gap(dim, dim == 2 ? 40 : 20, density, "si", g, g) + "timestep 1e-4\nrun 0\n");
      const double before = body(run, 1);
      run.commands("run 10\n");
      EXPECT_NEAR(measured(strprintf("%dd, density %g: way over theory", dim, density),
                           (body(run, 1) - before) / (0.5e-6 * exact)),
                  1.0, dim == 2 ? 0.01 : 0.03);
      EXPECT_NEAR(measured(strprintf("%dd, density %g: acceleration over theory", dim, density),
                           body(run, VELOCITY + 1) / (1e-3 * exact)),
                  1.0, dim == 2 ? 0.01 : 0.03);
      EXPECT_LT(std::fabs(body(run, VELOCITY) / (1e-3 * g)), 2e-4);
    }
}

// a body that is held at first, and then is another one that is free, begins to fall at this time
SERIAL_TEST(Body, IsDefinedAnew)
{
  const std::string body_of = "fix body all mpm/rigid hull density 500 slip gravity 0 -9.81 0 ";
  Scene run(plane("si", "f f", "0 2 0 2", 1, 0.02) +
            "region hull sphere 0.6 1.6 0 0.2\nregion low block INF INF INF 0.1 INF INF\n"
            "create_points 1 region low spacing 0.05\n" +
            body_of +
            "hold x y\nfix w all mpm/incompressible 0.1 1000 region hull\n"
            "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\nrun 3\nunfix body\n" +
            body_of + "velocity 0.3 0 0 omega 0 0 2\nrun 4\n");
  EXPECT_NEAR(body(run, VELOCITY + 1), -0.04 * 9.81, 1e-12);
  EXPECT_NEAR(body(run, VELOCITY), 0.3, 1e-12);
  EXPECT_NEAR(body(run, 1), 1.6 - 0.5 * 0.04 * 0.04 * 9.81, 1e-12);
  EXPECT_NEAR(body(run, OMEGA + 2), 2.0, 1e-12);
}

// in all units: the same motion, and the force that belongs to it
SERIAL_TEST(Units, IsReleased)
{
  constexpr double a = 0.2, b = 0.47, g = 0.02;
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene probe(plane(units, "f f", "0 1 0 1", 1, 0.02));
    const double now = g * probe.lmp->force->ftm2v, dt = 1e-3 / std::sqrt(now);
    Scene run(gap(2, 20, 500.0, units, g, now) + strprintf("timestep %.17g\nrun 10\n", dt));
    const double exact = 500.0 / (500.0 + 1000.0 * (b * b + a * a) / (b * b - a * a)) * now;
    EXPECT_NEAR(body(run, VELOCITY + 1) / (10 * dt * exact), 1.0, 0.004) << units;
    const double mass = 500.0 * PI * a * a;
    EXPECT_NEAR(body(run, FORCE + 1) / (mass * (g + exact / probe.lmp->force->ftm2v)), 1.0, 0.002)
        << units;
  }
}

// a spin is shared with water at rest by the moments of inertia, that of the body and the added
// one, which does not depend on its density; near that of an ellipse, pi rho (a^2 - b^2)^2/8
SERIAL_TEST(Body, SharesItsSpin)
{
  constexpr double a = 0.2, b = 0.05;
  double first = 0.0;
  for (const double density : {1e5, 1000.0, 10.0}) {
    Scene run(
        plane("si", "f f", "0 1 0 1", 1, 0.02) +
        "region hull block 0.303 0.703 0.461 0.561 INF INF\n"
        "region fluid block 0.303 0.703 0.461 0.561 INF INF side out\n"
        "create_points 1 region fluid spacing 0.0125\n" +
        strprintf("fix body all mpm/rigid hull density %g slip omega 0 0 1 hold x y\n", density) +
        "fix w all mpm/incompressible 0.025 1000 spread 0 tolerance 1e-10 region hull\n"
        "timestep 1e-5\nrun 1\n");
    const double inertia = density * 4.0 * a * b * 4.0 * (a * a + b * b) / 12.0,
                 added = measured("added moment of inertia",
                                  inertia * (1.0 / body(run, OMEGA + 2) - 1.0));
    if (first == 0.0) first = added;
    EXPECT_NEAR(added / first, 1.0, 1e-4) << density;
    EXPECT_NEAR(added / (PI * 1000.0 * std::pow(a * a - b * b, 2) / 8.0), 1.0, 0.5);
  }
}

// what is pushed goes on, whatever the number of steps; apic took 15 and 38 % here
SERIAL_TEST(Body, GoesOn)
{
  for (const int nsteps : {100, 400}) {
    auto scene = gap(2, 20, 500.0, "si", 0.0, 0.0);
    scene = replaced(scene, "gravity 0 -0 0", "velocity 0.1 0 0") + "timestep 1e-4\nrun 2\n";
    Scene run(scene);
    const double before = body(run, VELOCITY);
    run.commands(strprintf("run %d\n", nsteps));
    EXPECT_GT(measured(strprintf("%d steps: velocity over that before", nsteps),
                       body(run, VELOCITY) / before),
              0.9);
  }
}

// Archimedes: its weight is that of the water, with 1.5 and 3 cells in its depth
SERIAL_TEST(Boat, Floats)
{
  for (const double h : first_of(1, {0.04, 0.02})) {
    const double depth = 0.06, level = (0.8 - 0.4 * (0.4 - 0.3337) + 0.4 * depth) / 2.0;
    Scene run(boat(h, 300.0, 0.4337, "hold x rz") + "run 200\n");
    double sum = 0.0, lift = 0.0;
    int n = 0;
    run.each_step([&](double **) {
      sum += body(run, CENTER + 1);
      lift += run.fix("w")->compute_vector(15);    // the flow has the same force on its region
      n++;
    });
    run.commands("run 200\n");
    EXPECT_NEAR(measured("depth over theory", (level - (sum / n - 0.1)) / depth), 1.0, 0.02);
    EXPECT_NEAR(measured("force on the region over weight", lift / n / (300.0 * 0.08 * 9.81)), 1.0,
                0.02);
  }
}

// A torque heels it: m g (GM + tan^2/2 BM) sin of a box, with GM = BM + KB - KG
SERIAL_TEST(Boat, Heels)
{
  constexpr double angle = 0.1, B = 0.4, depth = 0.1, BM = B * B / (12.0 * depth);
  const double righting = 1000.0 * 9.81 * B * depth * std::sin(angle) *
      (BM + 0.5 * depth - 0.1 + 0.5 * BM * std::pow(std::tan(angle), 2));
  Scene run("variable M equal " + strprintf("%.17g*(time<3)*(1-cos(PI*time/3))/2", righting) +
            strprintf("+%.17g*(time>=3)\n", righting) +
            boat(0.05, 500.0, 0.413, "torque 0 0 v_M hold x") + "run 400\n");
  double sum = 0.0;
  int n = 0;
  run.each_step([&](double **) {
    sum += std::asin(body(run, MATRIX + 3));
    n++;
  });
  run.commands("run 200\n");
  EXPECT_NEAR(measured("angle over theory", sum / n / angle), 1.0, 0.05);
}

// a body that is dropped on water with a spin, on four ranks, and from restart files
TEST(Body, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const std::string shape = dim == 2 ? "block 0.3313 0.7092 0.4127 0.6319 INF INF"
                                       : "block 0.3313 0.7092 0.4127 0.6319 0.0711 0.3077";
    const auto scene = box(dim, "si", "f f p", "0 1 0 1 0 0.4", 1, 0.02) + "region dry " + shape +
        " side out\nregion water block INF INF INF 0.53 INF INF\n" +
        "region fluid intersect 2 water dry\n" +
        strprintf("create_points 1 region fluid spacing %g\n", 0.5 * h);
    const auto fixes = "region shape " + shape +
        "\nfix body all mpm/rigid shape density 400 slip " +
        "gravity 0 -9.81 0 velocity 0.1 0 0 omega 0 0 0.7\n" +
        strprintf("fix w all mpm/incompressible %g 1000 ", h) +
        "region shape tolerance 1e-12\nfix g all gravity 9.81 vector 0 -1 0\ntimestep 0.004\n";
    OnRanks run(scene + fixes, "run 20\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    for (int k = 0; k < 9; k++)
      EXPECT_NEAR(run.parallel.fix("body")->compute_vector(k),
                  run.serial.fix("body")->compute_vector(k), 1e-12);
    Continued again(scene + fixes, 12, "neighbor 0.02 bin\n" + fixes, 20);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    for (int k = 0; k < 9; k++)
      EXPECT_EQ(again.whole.fix("body")->compute_vector(k),
                again.again.fix("body")->compute_vector(k));
  }
}

// no point comes into a body, wherever this goes
SERIAL_TEST(Body, KeepsPointsOut)
{
  Scene run(boat(0.025, 300.0, 0.413, "omega 0 0 4"));
  int inside = 0;
  run.each_step([&](double **) {
    const double c = body(run, MATRIX), s = body(run, MATRIX + 3);
    for (int i = 0; i < run.n(); i++) {
      const double dx = run.x()[i][0] - body(run, CENTER),
                   dy = run.x()[i][1] - body(run, CENTER + 1);
      if (std::fabs(c * dx + s * dy) < 0.2 && std::fabs(c * dy - s * dx) < 0.1) inside++;
    }
  });
  run.commands("run 100\n");
  EXPECT_EQ(inside, 0);
  EXPECT_GT(std::fabs(body(run, MATRIX + 3)), 0.01);
}

// a stone that comes to the floor goes on, and two that meet go through each other, which a warning
// tells, but once; a piston that is in a wall from the start is one
SERIAL_TEST(Body, WarnsOfWhatItTouches)
{
  const std::string say = "touch neither each other nor walls",
                    water = plane("si", "f f", "0 1 0 1", 1, 0.02),
                    rest =
                        "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.4 every 1 max "
                        "0.005\nrun 20\nrun 20\n";
  const auto scene = [&](const std::string &low, const std::string &high, double speed) {
    return water + "region a " + low + "\nregion b " + high + "\nregion na " + low +
        " side out\nregion nb " + high +
        " side out\nregion top block INF INF INF 0.9 INF INF\nregion w intersect 3 na nb top\n"
        "create_points 1 region w spacing 0.025\n" +
        strprintf("fix one all mpm/rigid a density 3000 slip velocity 0 %g 0\n", -speed) +
        strprintf("fix two all mpm/rigid b density 3000 slip velocity 0 %g 0\n", speed) +
        "fix w all mpm/incompressible 0.05 1000 region a region b\n" + rest;
  };
  const std::string up = "sphere 0.51 0.71 0 0.12";
  EXPECT_EQ(times_said(scene("sphere 0.51 0.4 0 0.12", up, 0.3), say), 0);
  const auto floor = lines_that_say(scene("sphere 0.51 0.24 0 0.12", up, 3.0), say);
  ASSERT_EQ(floor.size(), 2u);
  EXPECT_NE(floor[0].find("fix one goes through wall ylo"), std::string::npos);
  EXPECT_NE(floor[1].find("fix two goes through wall yhi"), std::string::npos);
  EXPECT_EQ(times_said(scene("block 0.38 0.62 -0.1 0.3 INF INF", up, 0.3), say), 0);
  EXPECT_EQ(times_said(scene("sphere 0.51 0.44 0 0.12", up, -0.5), say), 2);    // each
  // held in a wall from the start, where water comes later
  EXPECT_EQ(
      times_said(
          plane("si", "f f", "0 2 0 1", 1, 0.02) +
              "region water block 0 0.5 0 0.6 INF INF\ncreate_points 1 region water spacing 0.025\n"
              "region body block 1.5 2.1 -0.1 0.2 INF INF\n"
              "fix b all mpm/rigid body density 3000 slip hold x y rz\n"
              "fix w all mpm/incompressible 0.05 1000 region body\n"
              "fix g all gravity 9.81 vector 0 -1 0\nfix d all mpm/dt 0.5 every 1 max 0.01\nrun "
              "100\n",
          say),
      0);
}

SERIAL_TEST(Body, BadInput)
{
  const auto plain = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region s sphere 0.51 0.51 0 0.001\ncreate_points 1 box spacing 0.05\n";
  const std::string flow = "fix w all mpm/incompressible 0.1 1000 region s",
                    rigid = "fix body all mpm/rigid s density 500 ";
  expect_refused(
      plain,
      {{rigid + "stick\n" + flow, "no friction and does not part from it: use slip"},
       {rigid + "separate\n" + flow, "use slip"},
       {rigid + "slip friction 0.2\n" + flow, "use slip"},
       {rigid + "slip\n" + flow + " reflect 0.5", "reflect cannot be used with bodies"},
       {rigid + "slip\nfix w all mpm/incompressible 0.1 1000", "requires 3d"},
       {rigid + "slip velocity 0 0 1\n" + flow, "in 2d"},
       {rigid + "slip omega 1 0 0\n" + flow, "in 2d"},
       {rigid + "slip hold z\n" + flow, "in 2d"},
       {"fix body all mpm/rigid none density 500 slip\n" + flow, "region none does not exist"},
       {"region p plane 0.5 0.1 0 0 -1 0\nfix body all mpm/rigid p density 500 slip\n" + flow,
        "that is bounded"},
       {"region q sphere 0.5 0.5 0 0.1 side out\nfix body all mpm/rigid q density 500 slip\n" +
            flow,
        "with side in"},
       {"variable d equal 0.0\nregion q sphere 0.5 0.5 0 0.1 move v_d NULL NULL\nfix body all "
        "mpm/rigid q density 500 slip\n" +
            flow,
        "at rest"}},
      "timestep 0.001\nrun 1\n");
}

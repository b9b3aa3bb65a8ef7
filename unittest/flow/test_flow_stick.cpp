// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Viscous flow of fix mpm/incompressible between regions without slip: cylinders, floors, bowls.

#include "mpm_lammps.h"

using namespace MPM_TEST;

enum { FILLED = 3, KINETIC = 5, ITERATIONS = 13 };

/** Root mean square of the error of velocities between a cylinder of radius 0.2 that turns and one
 *  of radius 0.45, over that of the velocities (Couette), after four long steps. */
double error_of_cylinders(int n)
{
  Scene run(plane("si", "f f", "0 1 0 1", 1, 0.01) +
            "variable angle equal 1e-3*step*0.2\nregion out sphere 0.503 0.511 0 0.45 side out\n"
            "region in sphere 0.503 0.511 0 0.2 rotate v_angle 0.503 0.511 0 0 0 1\n"
            "region a sphere 0.503 0.511 0 0.2 side out\nregion b sphere 0.503 0.511 0 0.45\n"
            "region fluid intersect 2 a b\n" +
            strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 / n) +
            strprintf("fix w all mpm/incompressible %.17g 1 viscosity 1 implicit yes stick out "
                      "stick in tolerance 1e-7\n",
                      1.0 / n) +
            "timestep 0.2\nrun 4\n");
  constexpr double a = 0.2, b = 0.45, A = -1e-3 * a * a / (b * b - a * a);
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double x = run.x()[i][0] - 0.503, y = run.x()[i][1] - 0.511, r = std::hypot(x, y);
    const double u = A * r - A * b * b / r;
    sum += std::pow(run.v()[i][0] + u * y / r, 2) + std::pow(run.v()[i][1] - u * x / r, 2);
    square += u * u;
  }
  return measured(strprintf("%d cells: error", n), std::sqrt(sum / square));
}

/** Slow flow by a weight through a square array of cylinders, which fill 0.05: mean velocity over
 *  that of A.S. Sangani, A. Acrivos, Int. J. Multiphase Flow 8 (1982) 193, drag 15.56 mu u. */
double flow_through_cylinders(int n)
{
  constexpr double filled = 0.05, speed = 0.01;
  const double drag = 4.0 * PI /
      (-0.5 * std::log(filled) - 0.738 + filled - 0.887 * filled * filled +
       2.039 * std::pow(filled, 3));
  Scene run(
      plane("si", "p p", "0 1 0 1", 1, 0.01) +
      strprintf("region cylinder sphere 0.503 0.497 0 %.17g\nregion fluid sphere 0.503 0.497 0 "
                "%.17g side out\ncreate_points 1 region fluid spacing %.17g\n",
                std::sqrt(filled / PI), std::sqrt(filled / PI), 0.5 / n) +
      strprintf("fix w all mpm/incompressible %.17g 1 viscosity 1 implicit yes stick cylinder "
                "tolerance 1e-6\nfix g all gravity %.17g vector 1 0 0\n",
                1.0 / n, drag * speed) +
      "timestep 0.01\nrun 60\n");
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) sum += run.v()[i][0];
  return measured(strprintf("%d cells: mean velocity over theory", n),
                  sum / run.n() * (1.0 - filled) / speed);
}

/** A block of honey that falls into a bowl or, in 3d, onto an inclined plane. */
std::string honey(int dim, double h)
{
  return box(dim, "si", "f f p", "0 1 0 1 0 0.4", 1, 0.02) +
      (dim == 3 ? "region bowl plane 0.5 0.25 0 0.3 -1 0\nregion in plane 0.5 0.251 0 -0.3 1 0\n"
                : "region bowl sphere 0.503 0.511 0 0.45 side out\n"
                  "region in sphere 0.503 0.511 0 0.449\n") +
      "region low block INF 0.6 INF 0.711 INF INF\nregion fluid intersect 2 in low\n" +
      strprintf("create_points 1 region fluid spacing %g\n", 0.5 * h);
}

std::string fixes(double h)
{
  return strprintf("fix w all mpm/incompressible %g 1000 viscosity 100 implicit yes stick bowl "
                   "tolerance 1e-12\n",
                   h) +
      "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5 max 0.02\n";
}

// plates with a slope of 1:2 in a periodic box: drag of oblique walls, 8 and 16 cells between them
SERIAL_TEST(Stick, InclinedPlates)
{
  const double a = 0.193,
               period =
                   2.0 / std::sqrt(5.0);    // half the gap; distance of plates and their images
  std::string regions;
  const auto plane_at = [&](const std::string &name, double s, int sign) {
    regions += strprintf("region %s plane %.17g %.17g 0 %d %d 0\n", name.c_str(),
                         -s / std::sqrt(5.0), 2.0 * s / std::sqrt(5.0), -sign, 2 * sign);
  };
  plane_at("a1", a, 1);
  plane_at("a2", period - a, -1);
  plane_at("b1", -a, -1);
  plane_at("b2", a - period, 1);
  plane_at("c1", a, -1);
  plane_at("c2", -a, 1);
  plane_at("high", period - a, 1);
  plane_at("low", a - period, -1);
  regions += "region a intersect 2 a1 a2\nregion b intersect 2 b1 b2\nregion c intersect 2 c1 c2\n"
             "region fluid union 3 c high low\n";
  for (const auto &[n, bound] : {std::pair(20, 0.02), {40, 0.012}}) {
    Scene run(
        plane("si", "p p", "0 2 0 1", 1, 0.01) + regions +
        strprintf("create_points 1 region fluid spacing %.17g cut yes outside ignore\n"
                  "fix w all mpm/incompressible %.17g 1 viscosity 1 implicit yes stick a stick b\n",
                  0.5 / n, 1.0 / n) +
        "fix g all gravity 1 vector 2 1 0\ntimestep 0.5\nrun 6\n");
    double flow = 0.0, mass = 0.0;
    for (int i = 0; i < run.n(); i++) {
      flow += run.lmp->atom->rmass[i] * (2.0 * run.v()[i][0] + run.v()[i][1]) / std::sqrt(5.0);
      mass += run.lmp->atom->rmass[i];
    }
    EXPECT_NEAR(measured(strprintf("%d cells: mean velocity", n), flow / mass / (a * a / 3.0)), 1.0,
                bound);
  }
}

// a gap of 8 cells at 45 degrees, at four places in a cell: the drag is not that of stairs
SERIAL_TEST(Stick, PlatesAtFortyFiveDegrees)
{
  constexpr double gap = 8.0, period = 16.0 * 0.70710678118654752;    // in cells
  for (const double shift : {0.0, 0.13, 0.31, 0.47}) {
    std::string regions, names;
    for (int k = -2; k < 3; k++) {
      const auto plane_at = [&](const std::string &name, double s, int sign) {
        s *= 0.70710678118654752;
        regions += strprintf("region %s%d plane %.17g %.17g 0 %d %d 0\n", name.c_str(), k, -s, s,
                             -sign, sign);
      };
      const double middle = shift + k * period;
      plane_at("a", middle + 0.5 * gap, 1);
      plane_at("b", middle + period - 0.5 * gap, -1);
      plane_at("c", middle - 0.5 * gap, 1);
      plane_at("d", middle + 0.5 * gap, -1);
      regions += strprintf("region wall%d intersect 2 a%d b%d\nregion flow%d intersect 2 c%d d%d\n",
                           k, k, k, k, k, k);
      names += strprintf(" stick wall%d", k);
    }
    Scene run(plane("si", "p p", "0 16 0 16", 1, 0.3) + regions +
              "region fluid union 5 flow-2 flow-1 flow0 flow1 flow2\n"
              "create_points 1 region fluid spacing 0.5 cut yes outside ignore\n"
              "fix w all mpm/incompressible 1 1 viscosity 1 implicit yes" +
              names + "\nfix g all gravity 1e-6 vector 1 1 0\ntimestep 128\nrun 4\n");
    double flow = 0.0, mass = 0.0;
    for (int i = 0; i < run.n(); i++) {
      flow += run.lmp->atom->rmass[i] * (run.v()[i][0] + run.v()[i][1]) * 0.70710678118654752;
      mass += run.lmp->atom->rmass[i];
    }
    EXPECT_NEAR(
        measured(strprintf("%g: mean velocity", shift), flow / mass / (1e-6 * gap * gap / 12.0)),
        1.0, 0.02);
  }
}

// slow flow in a pipe with a radius of 4 cells, anywhere in a cell (Hagen-Poiseuille)
SERIAL_TEST(Stick, Pipe)
{
  for (const auto &[x, y] : {std::pair(6.0, 6.0), {6.13, 6.31}}) {
    const auto pipe = strprintf("cylinder z %g %g 4 INF INF", x, y);
    Scene run(box(3, "si", "p p p", "0 12 0 12 0 2", 1, 0.3) + "region wall " + pipe +
              " side out\nregion fluid " + pipe +
              "\ncreate_points 1 region fluid spacing 0.5 cut yes outside ignore\n"
              "fix w all mpm/incompressible 1 1 viscosity 1 implicit yes stick wall\n"
              "fix g all gravity 1e-6 vector 0 0 1\ntimestep 32\nrun 4\n");
    double flow = 0.0, mass = 0.0;
    for (int i = 0; i < run.n(); i++) {
      flow += run.lmp->atom->rmass[i] * run.v()[i][2];
      mass += run.lmp->atom->rmass[i];
    }
    EXPECT_NEAR(measured(strprintf("%g: mean velocity", x), flow / mass / (1e-6 * 16.0 / 8.0)), 1.0,
                0.02);
  }
}

// between balls, one of which turns: cells behind small openings do not take many iterations
SERIAL_TEST(Stick, IterationsBetweenBalls)
{
  Scene run(
      box(3, "si", "p p p", "0 15 0 15 0 15", 1, 0.3) +
      "variable angle equal 1e-6*time\nregion in sphere 7.63 7.81 7.7 2 rotate v_angle 7.63 "
      "7.81 7.7 0.2 0.3 1\nregion out sphere 7.63 7.81 7.7 5 side out\n"
      "region a sphere 7.63 7.81 7.7 2 side out\nregion b sphere 7.63 7.81 7.7 5\n"
      "region fluid intersect 2 a b\ncreate_points 1 region fluid spacing 0.5\n"
      "fix w all mpm/incompressible 1 1 viscosity 1 implicit yes stick in stick out tolerance "
      "1e-7\ntimestep 50\nrun 2\n");
  EXPECT_LT(measured("iterations", run.fix("w")->compute_vector(ITERATIONS)), 1200);
}

// of second order, with two and four cells in the radius
SERIAL_TEST(Stick, ArrayOfCylinders)
{
  const double coarse = flow_through_cylinders(16) - 1.0, fine = flow_through_cylinders(32) - 1.0;
  EXPECT_LT(std::fabs(coarse), 0.06);
  EXPECT_LT(std::fabs(fine), 0.015);
}

// walls that are curved and at any place in their cells: second order
SERIAL_TEST(Stick, CylinderThatTurns)
{
  const double coarse = error_of_cylinders(20), fine = error_of_cylinders(40);
  EXPECT_LT(coarse, 0.05);    // 5 cells in the gap
  EXPECT_LT(fine, 0.013);
  EXPECT_GT(measured("order", std::log2(coarse / fine)), 1.5);
}

// a film that flows over a floor anywhere in a cell
SERIAL_TEST(Stick, Film)
{
  for (const int rows : {48, 49})
    for (const double bottom : {0.113, 0.125, 0.137}) {
      const double top = bottom + 0.0125 * rows, H = top - bottom;
      Scene run(plane("si", "p f", "0 0.1 0 1", 1, 0.02) +
                strprintf("region floor block INF INF INF %.17g INF INF\n", bottom) +
                strprintf("region w block INF INF %.17g %.17g INF INF\n", bottom, top - 1e-6) +
                "create_points 1 region w spacing 0.0125\n"
                "fix w all mpm/incompressible 0.025 1 viscosity 1 implicit yes stick floor\n"
                "fix g all gravity 1e-5 vector 1 -3 0\ntimestep 50\nrun 2\n");
      double most = 0.0, flow = 0.0, exact = 0.0;
      for (int i = 0; i < run.n(); i++) most = std::max(most, run.x()[i][1]);
      const double height = most + 0.00625 - bottom;
      for (int i = 0; i < run.n(); i++) {
        const double y = run.x()[i][1] - bottom;
        flow += run.v()[i][0];
        exact += 1e-5 / std::sqrt(10.0) * (y * height - 0.5 * y * y);
      }
      EXPECT_NEAR(height, H, 0.002);
      EXPECT_NEAR(measured(strprintf("floor %g: flow over that of theory", bottom), flow / exact),
                  1.0, 0.002);
    }
}

// honey in a bowl comes to rest, keeps its volume, and never has more energy than its fall gives
SERIAL_TEST(Stick, Bowl)
{
  Scene run(honey(2, 0.05) + fixes(0.05) + "run 0\n");
  const double volume = run.fix("w")->compute_vector(FILLED);
  double before = 1e9, most = 0.0;
  run.each_step([&](double **) {
    const auto s = run.sums();
    const double now = s.kinetic + 9.81 * s.mass * s.x[1];
    most = std::max(most, now / before - 1.0);
    before = now;
  });
  run.commands("run 150\n");
  EXPECT_LT(measured("largest growth of the energy in a step", most), 1e-9);
  EXPECT_LT(measured("kinetic energy", run.fix("w")->compute_vector(KINETIC)), 0.01);
  EXPECT_NEAR(measured("volume", run.fix("w")->compute_vector(FILLED) / volume), 1.0, 0.02);
}

// what turns with its container is at rest in it: 3d, an axis in any direction
SERIAL_TEST(Stick, BallThatTurns)
{
  Scene run(box(3, "si", "f f f", "0 1 0 1 0 1", 1, 0.02) +
            "variable angle equal 0.01*time\nregion out sphere 0.503 0.511 0.49 0.45 side out "
            "rotate v_angle 0.503 0.511 0.49 0.2 0.3 1\nregion fluid sphere 0.503 0.511 0.49 0.45\n"
            "create_points 1 region fluid spacing 0.05\nfix w all mpm/incompressible 0.1 1000 "
            "viscosity 1e5 implicit yes stick out\ntimestep 0.1\nrun 3\n");
  const double w = 0.01 / std::sqrt(1.13), spin[3] = {0.2 * w, 0.3 * w, w};
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double x[3] = {run.x()[i][0] - 0.503, run.x()[i][1] - 0.511, run.x()[i][2] - 0.49};
    for (int d = 0; d < 3; d++) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      const double u = spin[e] * x[f] - spin[f] * x[e];
      sum += std::pow(run.v()[i][d] - u, 2);
      square += u * u;
    }
  }
  // without strain equations are exact; what is left is of points at the wall, here half of all
  EXPECT_LT(measured("error", std::sqrt(sum / square)), 0.05);
}

// on four ranks, balanced; and the same to the last bit from a restart file
TEST(Stick, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const std::string first = "timestep 0.005\n";
    const auto bowl = std::string(dim == 3 ? "region bowl plane 0.5 0.25 0 0.3 -1 0\n"
                                           : "region bowl sphere 0.503 0.511 0 0.45 side out\n");
    OnRanks run(honey(dim, h) + fixes(h) + first, "run 15\n",
                "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-11);
    Continued again(honey(dim, h) + fixes(h) + first, 6, "neighbor 0.02 bin\n" + bowl + fixes(h),
                    12);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

SERIAL_TEST(Stick, BadInput)
{
  const auto plain = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "create_points 1 box spacing 0.05\nregion b sphere 0.5 0.5 0 0.001\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(
      plain,
      {{fix + "viscosity 1 implicit yes stick", "missing"},
       {fix + "viscosity 1 implicit yes stick none", "region none does not exist"},
       {fix + "viscosity 1 stick b", "add the keywords viscosity and implicit yes"},
       {fix + "stick b", "add the keywords viscosity and implicit yes"},
       {fix + "viscosity 1 implicit yes stick b region b", "use the keyword stick"},
       {"fix r all mpm/rigid b density 500 slip\n" + fix + "viscosity 1 implicit yes stick b",
        "feel the pressure alone"}},
      "timestep 0.001\nrun 1\n");
}

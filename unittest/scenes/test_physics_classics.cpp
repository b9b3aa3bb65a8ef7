// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 300

// Classical problems of the mechanics of solids and soil that have solutions in closed form.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// Simple shear between rough plates of a metal with linear hardening, to a shear of 0.75. Elastic
// strain is small, and so are the normal stresses of simple shear:
//   tau = (SIGMAY/sqrt(3) + H gamma/3)/(1 + H/(3 G))
// The mean over the last fifth, which is longer than waves need to cross ten times.
TEST(SimpleShear, OfAHardeningMetal)
{
  const double G = 7.7e7, yield = 1.0e6, H = 2.0e6;
  for (double h : {0.01, 0.005}) {
    Scene run(plane("si", "p f", "0 0.04 0 0.1", 1, 0.5 * h) +
              body("box",
                   strprintf("density 2000 eos linear 1.67e8 strength j2 %.17g %.17g hardening "
                             "linear %.17g",
                             G, yield, H),
                   strprintf("%.17g", h)) +
              "variable rate equal 2.0*(1-exp(-time/0.01))\nfix lo all mpm/boundary ylo stick\n"
              "fix hi all mpm/boundary yhi stick velocity v_rate 0 0\n"
              "fix step all mpm/dt 0.5 until 0.0475\n");
    double tau = 0.0, expected = 0.0;
    run.each_step([&](double **) {
      const double t = run.time();
      if (t < 0.038) return;
      const double gamma = 20.0 * (t - 0.01 * (1.0 - exp(-t / 0.01)));
      tau += 0.5 * (run.fix_vector("hi", 3)[0] - run.fix_vector("lo", 3)[0]) / 0.04;
      expected += (yield / sqrt(3.0) + H * gamma / 3.0) / (1.0 + H / (3.0 * G));
    });
    run.commands("run 1000000\n");
    EXPECT_NEAR(measured("simple shear, stress over exact", std::abs(tau) / expected), 1.0, 5e-3);
  }
}

// A column under its own weight (A. G. Greenhill, Proc. Camb. Phil. Soc. 4, 65 (1881)) buckles at
//   rho g A L^3/(E I) = 7.837
// and vibrates below that with a frequency whose square falls with g in proportion, but for a
// percent of that without weight. Plane strain, E/(1 - nu^2), a tenth as thick, four cells across.
static std::vector<std::array<double, 2>> sway(double share, double until)
{
  const double E = 2e7 / (1.0 - 0.09), g = share * 7.837 * E * 0.01 / 12.0 / 1000.0;
  Scene run(plane("si", "f f", "-0.6 0.6 0 1.2", 1, 0.0125) +
            body("block -0.05 0.05 0 1 INF INF", "density 1000 neohookean 2e7 0.3",
                 "0.025 transfer aflip 1.0") +
            strprintf("variable vx atom 0.02*y*y\nvelocity all set v_vx 0 0\n"
                      "fix base all mpm/boundary ylo stick\nfix g all gravity %.17g vector 0 -1 0\n"
                      "fix step all mpm/dt 0.5 until %.17g\n",
                      g, until));
  std::vector<std::array<double, 2>> path;
  run.each_step(
      [&](double **) {
        double x = 0.0;
        for (int i = 0; i < run.n(); i++) x += run.x()[i][0] / run.n();
        path.push_back({run.time(), x});
      },
      20);
  run.commands("run 1000000\n");
  return path;
}

static double half_period(const std::vector<std::array<double, 2>> &path)
{
  std::vector<double> zeros;
  for (std::size_t k = 2; k < path.size(); k++) {
    const auto &a = path[k - 1], &b = path[k];
    if (a[1] * b[1] < 0.0) zeros.push_back(a[0] - a[1] * (b[0] - a[0]) / (b[1] - a[1]));
  }
  EXPECT_GE(zeros.size(), 2u);
  return zeros.size() < 2 ? 0.0 : zeros[1] - zeros[0];
}

TEST(Column, BucklesUnderItsWeight)
{
  LONG_CASE();
  const double free = half_period(sway(0.0, 0.48)), half = half_period(sway(0.5, 0.68));
  EXPECT_NEAR(measured("column, share of the squared frequency at half the critical weight",
                       free * free / (half * half)),
              0.5, 0.015);
  const double w = 1.87510407 * 1.87510407 * sqrt(2e7 / 0.91 * 0.01 / 12.0 / 1000.0);
  EXPECT_NEAR(
      measured("column, frequency without weight over that of a slender beam", PI / free / w), 1.0,
      0.02);    // shear and rotation of the section: 0.8 %
  // beyond the critical weight it goes on and on
  const auto falls = sway(1.3, 0.6);
  EXPECT_GT(measured("column, sway beyond the critical weight over that of before",
                     falls.back()[1] / 5e-4),
            5.0);
}

// A silo (H. A. Janssen, Z. Ver. Dtsch. Ing. 39, 1045 (1895)): walls with friction carry a part of
// the sand. In a plane bin of the width w, filled to the height H, the floor carries
//   rho g l w (1 - exp(-H/l)),  l = w/(2 mu K)
// with the ratio K of horizontal to vertical stress, which the run tells. Weight comes slowly.
TEST(Silo, WallsCarryAPart)
{
  LONG_CASE();
  const double w = 0.2, H = 0.8, mu = 0.3, rho = 1600.0, g = 9.81;
  double K[2];
  int k = 0;
  for (double h : {0.04, 0.02}) {
    Scene run(plane("si", "f f", "0 0.2 0 1.0", 1, 0.5 * h) +
              body("block 0 0.2 0 0.8 INF INF", "density 1600 drucker/prager 5e6 0.3 30 plane",
                   strprintf("%.17g", h)) +
              "fix side all mpm/boundary xlo xhi separate friction 0.3\n"
              "fix floor all mpm/boundary ylo slip\n"
              "variable g equal 9.81*(time>0.4)+9.81*(time<=0.4)*(0.5-0.5*cos(PI*time/0.4))\n"
              "fix g all gravity v_g vector 0 -1 0\nfix step all mpm/dt 0.5 until 0.6\n");
    double floor = 0.0, side = 0.0;
    int n = 0;
    run.each_step([&](double **) {
      if (run.time() < 0.5) return;
      floor -= run.fix_vector("floor", 3)[1];
      side -= run.fix_vector("side", 3)[1];
      n++;
    });
    run.commands("run 1000000\n");
    double across = 0.0, along = 0.0;
    for (const auto &s : run.gather())
      if (s.x[1] < 0.7) {
        across += s.stress[0];
        along += s.stress[1];
      }
    K[k] = across / along;
    const double l = w / (2.0 * mu * K[k++]);
    const double exact = rho * g * l * w * (1.0 - exp(-H / l));
    EXPECT_NEAR(measured("silo, weight on floor and sides", (floor + side) / n), rho * g * w * H,
                1e-3 * rho * g * w * H);
    EXPECT_NEAR(measured("silo, weight on the floor over that of Janssen", floor / n / exact), 1.0,
                0.02);
    EXPECT_LT(floor, 0.65 * (floor + side));
  }
  EXPECT_NEAR(K[0], K[1], 0.01);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Surface tension and contact angles of fix mpm/incompressible: drops, capillary waves, menisci.

#include "wave_testing.h"

using namespace MPM_TEST;

enum { KINETIC = 5, FASTEST = 6, WALLS = 7 };

/** A drop of radius, density, and tension 1, n cells in its radius. r = c (1 + eps cos 2 theta). */
std::string drop(int dim, int n, double eps, double x, double y, double mu)
{
  const double h = 1.0 / n, c = 1.0 / std::sqrt(1.0 + 0.5 * eps * eps);
  const auto where = strprintf("sqrt((x-(%.17g))^2+(y-(%.17g))^2)", x, y);
  const auto two = strprintf("((x-(%.17g))^2-(y-(%.17g))^2)", x, y);
  return box(dim, "lj", "p p p", "-1.5 1.5 -1.5 1.5 -1.5 1.5", 1, 0.5 * h) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 * h) +
      (dim == 3 ? strprintf("variable out atom sqrt((x-(%.17g))^2+(y-(%.17g))^2+z^2)>1\n", x, y)
                : "variable out atom " + where + strprintf(">%.17g*(1+%.17g*", c, eps) + two +
               "/(" + where + "^2+1e-20))\n") +
      "group out variable out\ndelete_atoms group out compress no\n" +
      strprintf("fix w all mpm/incompressible %.17g 1 tension 1 viscosity %.17g\n", h, mu) +
      "fix dt all mpm/dt 0.8 every 1 max 0.05 until ";
}

double pressure_inside(Scene &run)
{
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *const x = run.x()[i];
    if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > 0.25) continue;
    sum -= run.points().tau[i][0];
    n += 1.0;
  }
  return sum / n;
}

/** Extrema, by time and value. */
std::vector<std::array<double, 2>> peaks_of(const std::vector<double> &t,
                                            const std::vector<double> &m)
{
  std::vector<std::array<double, 2>> peaks;
  for (std::size_t k = 6; k + 1 < m.size(); k++)
    if ((m[k] - m[k - 1]) * (m[k + 1] - m[k]) < 0.0) peaks.push_back({t[k], m[k]});
  return peaks;
}

// O3: the pressure is sigma/R, in 3d twice that; what is left of flow and drift, anywhere in a cell
SERIAL_TEST(Drop, AtRest)
{
  const double mu = 1.0 / std::sqrt(12000.0);
  for (const int n : {8, 16})
    for (const double offset : {0.0, 0.31}) {
      Scene run(drop(2, n, 0.0, offset / n, 0.5 * offset / n, mu) + (n == 8 ? "3" : "1") +
                "\nrun 100000\n");
      EXPECT_NEAR(measured(strprintf("%d cells, %g: pressure", n, offset), pressure_inside(run)),
                  1.0, n == 8 ? 0.05 : 0.02);
      EXPECT_LT(measured("capillary number", mu * run.fix("w")->compute_vector(FASTEST)), 1e-3);
      double middle[2] = {0.0, 0.0};
      for (int i = 0; i < run.n(); i++)
        for (int d = 0; d < 2; d++) middle[d] += run.x()[i][d] / run.n();
      EXPECT_LT(measured("drift", std::hypot(middle[0] - offset / n, middle[1] - 0.5 * offset / n)),
                0.01);
    }
  Scene ball(drop(3, 8, 0.0, 0.01, 0.02, mu) + "0.2\nrun 100000\n");
  EXPECT_NEAR(measured("3d: pressure", pressure_inside(ball)), 2.0, 0.1);
  EXPECT_LT(measured("capillary number", mu * ball.fix("w")->compute_vector(FASTEST)), 1e-3);
}

// O4: zeros of the second moment of a drop that swings with eps = 0.1, Oh = 0.01, and its decay
SERIAL_TEST(Drop, Swings)
{
  std::vector<double> t, Q;
  Scene run(drop(2, 16, 0.1, 0.013, 0.007, 0.01) + "3.6\n");
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++)
      sum += run.x()[i][0] * run.x()[i][0] - run.x()[i][1] * run.x()[i][1];
    t.push_back(run.time());
    Q.push_back(sum);
  });
  run.commands("run 100000\n");
  const auto zeros = zeros_of(t, Q);
  ASSERT_EQ(zeros.size(), 3u);
  constexpr double exact[3] = {0.64661, 1.93824, 3.23103};
  for (int k = 0; k < 3; k++)
    EXPECT_NEAR(measured("zero over that of theory", zeros[k] / exact[k]), 1.0, 0.02);
  const auto peaks = peaks_of(t, Q);
  ASSERT_EQ(peaks.size(), 2u);
  const double decay = std::log(-peaks[0][1] / peaks[1][1]) / (peaks[1][0] - peaks[0][0]);
  EXPECT_NEAR(measured("decay over theory", decay / 0.0381478), 1.0, 0.2);
  double spin = 0.0, inertia = 0.0;
  for (int i = 0; i < run.n(); i++) {
    spin += run.x()[i][0] * run.v()[i][1] - run.x()[i][1] * run.v()[i][0];
    inertia += run.x()[i][0] * run.x()[i][0] + run.x()[i][1] * run.x()[i][1];
  }
  EXPECT_LT(measured("spin", std::fabs(spin / inertia)), 1e-3);
}

// O5: half a capillary wave between walls that it meets at a right angle, as deep as long
SERIAL_TEST(Wave, BetweenWalls)
{
  const int n = 40;    // cells in a wave
  std::vector<double> t, m;
  Scene run(plane("lj", "f f", "0 0.5 0 1.5", 1, 0.01) + "region w block INF INF 0 1 INF INF\n" +
            strprintf("create_points 1 region w spacing %.17g\n", 0.5 / n) +
            strprintf("variable s equal %.17g\n", std::exp(2 * PI) - std::exp(-2 * PI)) +
            "variable up atom 0.02*cos(2*PI*x)*(exp(2*PI*y)-exp(-2*PI*y))/v_s\n"
            "variable side atom -0.02*sin(2*PI*x)*(exp(2*PI*y)+exp(-2*PI*y))/v_s\n"
            "displace_atoms all move v_side v_up 0\n" +
            strprintf("fix w all mpm/incompressible %.17g 1 tension 1 viscosity 0.01\n", 1.0 / n) +
            "timestep 0.0008\n");
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += std::cos(2 * PI * run.x()[i][0]) * run.x()[i][1];
    t.push_back(run.time());
    m.push_back(sum / run.n());
  });
  run.commands("run 1400\n");
  const auto zeros = zeros_of(t, m);
  ASSERT_GT(zeros.size(), 4u);
  const double omega = PI * (zeros.size() - 1) / (zeros.back() - zeros.front());
  // smoothing takes k^2 h^2 of the force
  const double k = 2 * PI / n;
  EXPECT_NEAR(measured("frequency over theory", omega / 15.662275), std::sqrt(1.0 - k * k), 0.002);
  const auto peaks = peaks_of(t, m);
  const auto &first = peaks.front(), &last = peaks.back();
  const double decay = std::log(std::fabs(first[1] / last[1])) / (last[0] - first[0]);
  EXPECT_NEAR(measured("decay over theory", decay / 0.7000615), 1.0, 0.15);
}

// the pressure in all units
SERIAL_TEST(Units, Pressure)
{
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene run(
        plane(units, "p p", "-12 12 -12 12", 1, 0.3) + "region d sphere 0 0 0 8\n" +
        "create_points 1 region d spacing 0.5\nfix w all mpm/incompressible 1 2.0 tension 0.8\n"
        "timestep 1e-6\nrun 2\n");
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++) {
      if (std::hypot(run.x()[i][0], run.x()[i][1]) > 4.0) continue;
      sum -= run.points().tau[i][0];
      n += 1.0;
    }
    EXPECT_NEAR(sum / n / 0.1, 1.0, 5e-4) << units;
  }
}

// a drop that swings across faces of the box, on four ranks, balanced, and from a restart file
TEST(Drop, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const auto scene = box(dim, "lj", "p f p", "0 2 0 2 0 1", 1, 0.02) +
        "region d block 1.2 1.8 INF 0.9 " + (dim == 3 ? "0.2 0.8" : "INF INF") + "\n" +
        strprintf("create_points 1 region d spacing %g\n", dim == 3 ? 0.1 : 0.05) +
        "variable u atom 0.5+y\nvelocity all set v_u 0 0\n";
    const auto fixes = strprintf("fix w all mpm/incompressible %g 1 viscosity 0.01 tension 0.5 ",
                                 dim == 3 ? 0.2 : 0.1) +
        "tolerance 1e-11\nfix dt all mpm/dt 0.5 max 0.05 every 2\ntimestep 0.005\n";
    OnRanks run(scene + fixes, "run 20\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    Continued again(scene + fixes, 8, "neighbor 0.02 bin\n" + fixes, 14);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

SERIAL_TEST(Tension, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.05\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "tension -1", "tension"},
                  {fix + "tension", "tension"},
                  {fix + "tension nan", "nan"},
                  {fix + "tension 1000", "too large for the surface tension"}},
                 "timestep 0.05\nrun 1\n");
}

/** A drop of radius 1 on a floor, a segment of a disk, with n cells in the radius. It begins as
 *  this, or as half a disk, on a wall at y = 0 or a region with that height and slope. */
struct Sessile {
  double angle, n;
  bool is_segment;
  double time;
  bool is_region = false;
  double tilt = 0.0, height = 0.0;

  double rad() const { return angle * PI / 180.0; }
  double area() const { return rad() - std::sin(rad()) * std::cos(rad()); }

  std::string scene() const
  {
    const double h = 1.0 / n, r = is_segment ? 1.0 : std::sqrt(2.0 * area() / PI),
                 up = is_segment ? -std::cos(rad()) : 0.0, s = std::sin(tilt), c = std::cos(tilt);
    const auto floor = strprintf("0 %.17g 0 %.17g %.17g 0", height, -s, c);
    std::string text = plane("lj", "f f", is_region ? "-2 2 0 3" : "-2 2 0 2", 1, 0.5 * h) +
        strprintf("region disk sphere %.17g %.17g 0 %.17g\n", 0.013 - up * s, height + up * c, r);
    if (is_region)
      text += "region floor plane " + floor + " side out\nregion air plane " + floor +
          "\nregion drop intersect 2 disk air\n";
    text += strprintf("create_points 1 region %s spacing %.17g outside ignore\n",
                      is_region ? "drop" : "disk", 0.5 * h) +
        strprintf("fix w all mpm/incompressible %.17g 1 tension 1 viscosity 0.3 angle %g %s\n", h,
                  angle, is_region ? "implicit yes stick floor tolerance 1e-6" : "") +
        strprintf("fix dt all mpm/dt 0.8 every 1 max 0.05 until %g\nrun 100000\n", time);
    return text;
  }

  /** Heights, widths, and pressure over those of the segment with the area of the points. */
  struct Shape {
    double height, width, pressure;
  };
  Shape of(Scene &run) const
  {
    const double s = std::sin(tilt), c = std::cos(tilt);
    double x = 0.0, y = 0.0, xx = 0.0, p = 0.0, inside = 0.0;
    const auto place = [&](int i) {
      const double a = run.x()[i][0], b = run.x()[i][1] - height;
      return std::array<double, 2>{c * a + s * b, c * b - s * a};
    };
    for (int i = 0; i < run.n(); i++) {
      x += place(i)[0] / run.n();
      y += place(i)[1] / run.n();
    }
    for (int i = 0; i < run.n(); i++) {
      const auto at = place(i);
      xx += std::pow(at[0] - x, 2) / run.n();
      if (std::fabs(at[0] - x) > 0.3 || at[1] < 0.1 || at[1] > 0.6 * (1.0 - std::cos(rad())))
        continue;
      p -= run.points().tau[i][0];
      inside += 1.0;
    }
    const double radius = std::sqrt(0.25 * run.n() / (n * n * area()));
    double A = 0.0, first = 0.0, second = 0.0;    // of the segment of radius one
    for (int k = 0; k < 10000; k++) {
      const double at = (k + 0.5) * 1e-4 * (1.0 - std::cos(rad())),
                   w = std::sqrt(std::max(0.0, 1.0 - std::pow(at + std::cos(rad()), 2)));
      A += 2.0 * w;
      first += 2.0 * w * at;
      second += 2.0 / 3.0 * w * w * w;
    }
    return {y * A / (first * radius), std::sqrt(xx * A / second) / radius, p / inside * radius};
  }
};

/** Height over the middle at so many places from the middle to the wall, of water between walls
 *  with the distance W and the contact angle; density, gravity, and tension are one. Integrates
 *  dy/dx = tan phi, d sin(phi)/dx = c + y. */
std::vector<double> meniscus(double W, double angle, int places)
{
  constexpr int STEPS = 200;
  const double end = std::sin(PI / 2 - angle);
  std::vector<double> y;
  double low = -3.0, high = 3.0;
  for (int k = 0; k < 60; k++) {
    const double c = 0.5 * (low + high), dx = 0.5 * W / (places * STEPS);
    double s = 0.0, now = 0.0;
    y.assign(1, 0.0);
    for (int i = 0; i < places * STEPS && std::fabs(s) < 1.0; i++) {
      const double half = s + 0.5 * dx * (c + now);
      now += dx * half / std::sqrt(std::max(1e-9, 1.0 - half * half));
      s = half + 0.5 * dx * (c + now);
      if ((i + 1) % STEPS == 0) y.push_back(now);
    }
    (s > end ? high : low) = c;
  }
  return y;
}

// drops come to rest as segments of disks with the angle, and the pressure of their radius
SERIAL_TEST(Sessile, OnWallOfTheBox)
{
  for (const double angle : first_of(2, {60.0, 120.0, 90.0})) {
    const Sessile drop = {angle, 8, false, 6.0};
    Scene run(drop.scene());
    const auto shape = drop.of(run);
    EXPECT_NEAR(measured(strprintf("%g degrees, 8 cells: height", angle), shape.height), 1.0, 0.02);
    EXPECT_NEAR(measured("width", shape.width), 1.0, 0.02);
    EXPECT_NEAR(measured("pressure", shape.pressure), 1.0, 0.05);
    measured("speed", run.fix("w")->compute_vector(FASTEST));
  }
  if (is_quick()) return;    // the fine ones take long
  for (const double angle : {60.0, 120.0}) {
    const Sessile drop = {angle, 16, true, 4.0};    // at rest
    Scene run(drop.scene());
    const auto shape = drop.of(run);
    EXPECT_NEAR(measured(strprintf("%g degrees, 16 cells: height", angle), shape.height), 1.0,
                0.01);
    EXPECT_NEAR(measured("width", shape.width), 1.0, 0.01);
    EXPECT_NEAR(measured("pressure", shape.pressure), 1.0, 0.02);
    EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 0.01);
  }
}

// the same on regions, at any height in a cell and inclined
SERIAL_TEST(Sessile, OnRegion)
{
  for (const double angle : {60.0, 120.0})
    for (const double tilt : first_of(1, {0.4, 0.0})) {
      const Sessile drop = {angle, 8, angle < 90.0, 4.0, true, tilt, 0.937};
      Scene run(drop.scene());
      const auto shape = drop.of(run);
      EXPECT_NEAR(measured(strprintf("%g degrees, slope %g: height", angle, tilt), shape.height),
                  1.0, 0.05);
      EXPECT_NEAR(measured("width", shape.width), 1.0, 0.05);
      EXPECT_NEAR(measured("pressure", shape.pressure), 1.0, 0.1);
    }
}

// water that was flat rises or falls at both walls, as the balance of weight and tension has it
SERIAL_TEST(Meniscus, BetweenPlates)
{
  constexpr double W = 4.0;
  constexpr int n = 8, columns = 16;
  for (const double angle : {60.0, 120.0}) {
    Scene run(plane("lj", "f f", "0 4 0 2", 1, 0.05) +
              "region d block INF INF INF 1 INF INF\ncreate_points 1 region d spacing 0.0625\n" +
              strprintf("fix w all mpm/incompressible 0.125 1 tension 1 viscosity 0.3 angle %g\n",
                        angle) +
              "fix g all gravity 1 vector 0 -1 0\nfix dt all mpm/dt 0.8 every 1 max 0.05 until 7\n"
              "run 100000\n");
    // tops of points over those of theory, least squares, both around their means
    const auto y = meniscus(W, angle * PI / 180.0, columns);
    std::vector<double> top(columns, 0.0), exact(columns);
    for (int i = 0; i < run.n(); i++) {
      const double from_middle = std::fabs(run.x()[i][0] - 0.5 * W);
      double &highest = top[std::min((int) (from_middle * n), columns - 1)];
      highest = std::max(highest, run.x()[i][1]);
    }
    double mean = 0.0, of_exact = 0.0, sum = 0.0, square = 0.0;
    for (int k = 0; k < columns; k++) {
      exact[k] = 0.5 * (y[k] + y[k + 1]);
      mean += top[k] / columns;
      of_exact += exact[k] / columns;
    }
    for (int k = 0; k < columns; k++) {
      sum += (top[k] - mean) * (exact[k] - of_exact);
      square += std::pow(exact[k] - of_exact, 2);
    }
    EXPECT_NEAR(measured(strprintf("%g degrees: rise over theory", angle), sum / square), 1.0, 0.1);
  }
}

// on four ranks, balanced; and the same to the last bit from a restart file
TEST(Sessile, RanksAndRestart)
{
  for (const int dim : {2, 3})
    for (const bool region : {false, true}) {
      const double h = dim == 2 ? 0.05 : 0.1;
      const auto scene = box(dim, "lj", "f f p", "0 1 0 1 0 0.4", 1, 0.02) +
          "region up plane 0.5 0.21 0 0.2 1 0\nregion part block INF 0.63 INF 0.5 INF INF\n"
          "region d intersect 2 up part\n" +
          strprintf("create_points 1 region %s spacing %g\n", region ? "d" : "part", 0.5 * h);
      const auto fixes = "region floor plane 0.5 0.21 0 0.2 1 0 side out\n" +
          strprintf("fix w all mpm/incompressible %g 1 viscosity 0.1 tension 1 angle 50 tolerance "
                    "1e-11 ",
                    h) +
          (region ? "implicit yes stick floor" : "") + "\nfix dt all mpm/dt 0.5 max 0.05 every 2\n";
      OnRanks run(scene + fixes + "timestep 0.001\n", "run 10\n",
                  "fix b all balance 5 1.05 shift xy 10 1.05\n");
      EXPECT_LT(measured("difference", run.difference()), 1e-10);
      if (dim == 3 && region) continue;
      Continued again(scene + fixes + "timestep 0.001\n", 6, "neighbor 0.02 bin\n" + fixes, 12);
      EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    }
}

SERIAL_TEST(Sessile, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) +
      "create_points 1 box spacing 0.05\nregion b sphere 0.5 0.5 0 0.001\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "angle 60", "add the keyword tension"},
                  {fix + "tension 1 angle", "angle"},
                  {fix + "tension 1 angle 10", "10"},
                  {fix + "tension 1 angle 180", "180"},
                  {fix + "tension 1 angle nan", "nan"},
                  {fix + "tension 1 region b", "use the keyword stick"}},
                 "timestep 0.001\nrun 1\n");
}

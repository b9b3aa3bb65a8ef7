// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// fix mpm axisymmetric: patch tests, closed forms of elasticity (Lame's thick-walled cylinder,
// vibrations of a cylinder and of a sphere), conservation, and what is refused. Ranks and restarts
// are in test_parallel.cpp and test_restart.cpp, the Taylor bar in test_taylor_bar.py.

#include "elements/thin_testing.h"

using namespace MPM_TEST;

/** A box from the axis on, and the lattice. */
static std::string start(double radius, double height, double h, const std::string &options)
{
  return plane("lj", "f f", strprintf("0 %g 0 %g", radius, height), 1, 0.3 * h) +
      strprintf("fix grid all mpm %.17g axisymmetric yes %s\n"
                "fix axis all mpm/boundary xlo slip\n",
                h, options.c_str());
}

/** Next: a body of one material. */
static std::string points(const std::string &region, const std::string &material)
{
  return "region body " + region + "\ncreate_points 1 region body ppc 2\nfix m all mpm/material " +
      material + "\n";
}

// volumes are those of rings: a cylinder has its own
TEST(Axisymmetric, VolumesAreThoseOfRings)
{
  Scene run(start(6, 6, 0.5, "") +
            replaced(points("block 1 3 1 5 INF INF", "density 2.0 neohookean 10.0 0.3"), "ppc 2",
                     "ppc 3") +
            "run 0\n");
  EXPECT_NEAR(run.sums().mass, 2.0 * PI * (9.0 - 1.0) * 4.0, 1e-11);
}

// points that were there before the fix have areas in the place of volumes: there is a warning
SERIAL_TEST(Axisymmetric, PointsOfThePlaneAreTold)
{
  const std::string fix =
      "fix grid all mpm 0.5 axisymmetric yes\nfix axis all mpm/boundary xlo slip\n";
  const std::string rest =
      "fix m all mpm/material density 2.0 neohookean 10.0 0.3\ntimestep 1e-3\nrun 0\n";
  const std::string start = plane("lj", "f f", "0 6 0 6", 1, 0.15);
  const std::string words = "same volume at all radii";
  for (const char *radii : {"1 3", "1 2", "5 5.5"}) {
    const auto body = strprintf(
        "region body block %s 1 5 INF INF\ncreate_points 1 region body spacing 0.25\n", radii);
    EXPECT_EQ(lines_that_say(start + body + fix + rest, words).size(), 1u) << radii;
    EXPECT_EQ(lines_that_say(start + fix + body + rest, words).size(), 0u) << radii;
  }
}

// v = (a r, b z) is reproduced everywhere, at the axis and at surfaces: strain and stress are
// uniform to round-off, and equal around the axis and across it
TEST(Axisymmetric, UniformExpansionIsExact)
{
  const double a = 0.3, b = -0.2, dt = 0.01;
  for (const char *shape :
       {"linear", "quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2", "bernstein"})
    for (const char *rest :
         {"apic", "polypic", "tpic", "apic scheme musl", "tpic scheme usf", "apic locking both",
          "apic scheme musl locking fbar", "apic frame total", "apic frame total scheme musl",
          "apic frame total locking both"}) {
      const std::string options = std::string("shape ") + shape + " transfer " + rest;
      const bool size = options.find("gimp") + 1 || options.find("cpdi") + 1;
      const bool total = options.find("total") + 1, poly = options.find("polypic") + 1;
      if (size && total) continue;
      if (options.find("bernstein") + 1 && !total) continue;
      if (poly && options.find("quadratic") + options.find("cubic") + 2 == 0) continue;
      Scene run(start(8, 8, 1.0, options) +
                points("block 0 4 1 5 INF INF", "density 1.0 linear 1.0 0.3") +
                strprintf("timestep %.17g\n", dt));
      run.set_velocity([=](const double *x, double *v) {
        v[0] = a * x[0];
        v[1] = b * x[1];
      });
      run.commands("run 1\n");
      const auto points = run.gather();
      const bool other_scheme = std::string(rest).find("us") != std::string::npos;
      for (const auto &p : points) {
        ASSERT_NEAR(p.F[0], p.F[8], 1e-13) << options;
        ASSERT_NEAR(p.F[8], points[0].F[8], 1e-13) << options;
        ASSERT_NEAR(p.F[4], points[0].F[4], 1e-13) << options;
        if (!other_scheme) { ASSERT_NEAR(p.F[8], 1.0 + a * dt, 1e-14) << options; }
        for (int c = 0; c < 6; c++) ASSERT_NEAR(p.stress[c], points[0].stress[c], 1e-13) << options;
      }
      EXPECT_NEAR(points[0].F[8], 1.0 + a * dt, 2e-5) << options;
      EXPECT_GT(points[0].stress[2], 1e-3) << options;
    }
}

// a point's F_zz is its radius over that of the start, however it got there
PARAMETER_TEST(AxisymmetricStrain, IsThatOfTheRadius, const char *,
               Values("transfer apic", "shape cubic transfer flip 1.0",
                      "shape cpgimp transfer aflip 0.9", "transfer xpic 3", "transfer fmpm 3",
                      "shape linear frame total transfer flip 1.0", "frame total transfer apic",
                      "frame total transfer apic reference update 1.05",
                      "shape gimp locking pressure", "shape cpdi", "shape cpdi transfer flip 1.0",
                      "shape linear transfer apic light 0.5",
                      "shape linear transfer flip 1.0 light 0.5", "transfer polypic",
                      "shape cubic transfer polypic", "transfer flip 1.0 edges modified",
                      "shape cpdi2", "shape cpdi2 transfer flip 1.0", "shape bernstein frame total",
                      "shape bernstein frame total transfer flip 1.0"))
{
  const char *options = GetParam();
  Scene run(start(10, 10, 1.0, options) +
            points("block 0 4 2 8 INF INF", "density 1.0 neohookean 10.0 0.3") + "timestep 0.02\n");
  run.set_reference();
  run.set_velocity([=](const double *x, double *v) {
    v[0] = 0.2 * x[0];
    v[1] = 0.6 * sin(x[0]);
  });
  run.commands("run 300\n");
  double worst = 0.0, strain = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double stretch = run.x()[i][0] / run.reference(i)[0];
    worst = std::max(worst, std::abs(run.points().F[i][8] / stretch - 1.0));
    strain = std::max(strain, std::abs(stretch - 1.0));
  }
  EXPECT_LT(worst, 1e-12) << options;
  EXPECT_GT(strain, 0.05) << options;
}

// a body under uniform pressure in a closed vessel: no forces inside, as the sum over points of r
// dN/dr + N is zero for functions that are wholly inside. Those that the axis cuts have the error
// of the midpoint rule if r N is a cubic of r
struct Spurious {    // acceleration times h density/pressure
  double at_axis, inside;
};

static Spurious spurious(const std::string &options)
{
  Scene run(start(10, 10, 1.0, options) +
            "create_points 1 box ppc 2\nfix m all mpm/material density 1.0 linear 1.0 0.0\n"
            "fix vessel all mpm/boundary xhi ylo yhi slip\ntimestep 0.01\n");
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 3; c++) run.points().tau[i][c] = -1.0;
  run.commands("run 1\n");
  Spurious worst = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) {
    const double *x = run.x()[i], a = std::hypot(run.v()[i][0], run.v()[i][1]) / 0.01;
    if (x[0] < 3.0) worst.at_axis = std::max(worst.at_axis, a);
    if (x[0] > 3.0 && x[0] < 7.0 && x[1] > 3.0 && x[1] < 7.0)
      worst.inside = std::max(worst.inside, a);
  }
  measured(options + ": acceleration under uniform pressure at the axis", worst.at_axis);
  return worst;
}

TEST(Axisymmetric, UniformPressureMakesNoForce)
{
  const struct {
    const char *options;
    double at_axis, inside;
  } rows[] = {{"shape linear transfer tpic", 1e-13, 1e-13},
              {"shape gimp transfer tpic", 1e-13, 1e-13},
              {"shape cpgimp transfer pic", 1e-13, 1e-13},
              {"shape quadratic transfer tpic", 0.025, 1e-13},
              {"shape quadratic transfer apic", 0.006, 1e-13},
              {"shape cubic transfer apic", 0.0025, 1e-13},
              {"shape quadratic transfer flip 1.0", 0.025, 1e-13},
              {"shape quadratic transfer flip 1.0 edges modified", 0.025, 1e-13},
              {"shape cpdi2 transfer apic", 1e-13, 1e-13},
              // r N is a cubic in each cell, and the errors of two cells do not cancel: as 1/r
              {"shape bernstein frame total", 0.04, 0.02 / 3.0}};
  for (const auto &row : rows) {
    const auto found = spurious(row.options);
    EXPECT_LT(found.inside, row.inside) << row.options;
    EXPECT_LT(found.at_axis, row.at_axis) << row.options;
  }
}

// Lame: a cylinder of radii 1 and 2 in plane strain, its bore widened by d, outside free:
// u = A r + B/r with A + B = d and sigma_rr = 0 outside; found by damping
static double lame_error(int n, const std::string &options)
{
  const double d = 1.0e-5, E = 1.0, nu = 0.3, h = 1.0 / n;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  const double c = sqrt(lambda + 2 * mu), dt = 0.4 * h / c;
  // sigma_rr = 2 (lambda + mu) A - 2 mu B/r^2 = 0 at r = 2, A + B = d
  const double ratio = 4.0 * (lambda + mu) / mu, A = d / (1.0 + ratio), B = ratio * A;
  Scene run(plane("lj", "f p", strprintf("1 3 0 %.17g", 2.0 * h), 1, 0.3 * h) +
            body("block 1 2 INF INF INF INF", strprintf("density 1.0 linear %g %g", E, nu),
                 strprintf("%.17g axisymmetric yes %s", h, options.c_str())) +
            strprintf("fix bore all mpm/boundary xlo slip velocity v_push 0 0\n"
                      "variable push equal %.17g*(step<=100)\ntimestep %.17g\n",
                      d / (100.0 * dt), dt));
  run.set_reference();
  const double damping = 2.0 * c / 1.0;
  run.each_step([&](double **f) {
    for (int i = 0; i < run.n(); i++) f[i][0] = -damping * run.mass()[i] * run.v()[i][0];
  });
  run.commands(strprintf("run %d\n", 100 + (int) std::lround(20.0 / (c * dt))));
  double sum = 0.0, norm = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double r = run.reference(i)[0], V = run.mass()[i];
    const auto sigma = run.cauchy(i);
    const double rr = 2 * (lambda + mu) * A - 2 * mu * B / (r * r);
    const double tt = 2 * (lambda + mu) * A + 2 * mu * B / (r * r);
    sum += V * (std::pow(sigma[0] - rr, 2) + std::pow(sigma[2] - tt, 2));
    norm += V * (rr * rr + tt * tt);
  }
  return measured(strprintf("Lame, %d cells, %s: error of stress", n, options.c_str()),
                  sqrt(sum / norm));
}

TEST(Axisymmetric, LameConverges)
{
  for (const char *options :
       {"shape quadratic transfer apic", "shape cubic transfer tpic", "shape linear transfer apic",
        "frame total transfer apic", "shape cpgimp transfer flip 1.0 scheme musl"}) {
    const double coarse = lame_error(5, options), fine = lame_error(20, options);
    const double order = measured("order", log(coarse / fine) / log(4.0));
    EXPECT_LT(fine, 0.03) << options;
    EXPECT_GT(order, 0.9) << options;
  }
}

// free vibrations. Cylinder in plane strain: radial motion J1(k r) with
// (k R) J0(k R) = (1 - 2 nu)/(1 - nu) J1(k R), k = omega/c. Sphere (H. Lamb, 1881): tan(x)/x =
// 1/(1 - x^2 c^2/(4 cs^2)), x = omega R/c; both begin with v proportional to r
/** Root of f between a and b. */
template <class F> static double root(double a, double b, F f)
{
  for (int k = 0; k < 100; k++) {
    const double m = 0.5 * (a + b);
    ((f(a) < 0.0) == (f(m) < 0.0) ? a : b) = m;
  }
  return a;
}

/** Frequency from the sum of m r.v, fitted through the times when it is zero; 8 half periods. */
static double frequency(Scene &run, double dt, bool sphere, double center, double guess)
{
  std::vector<double> zeros;
  double last = 0.0;
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++)
      sum += run.mass()[i] *
          (run.x()[i][0] * run.v()[i][0] + sphere * (run.x()[i][1] - center) * run.v()[i][1]);
    const double t = run.time();
    if (last != 0.0 && (sum < 0.0) != (last < 0.0)) zeros.push_back(t - dt * sum / (sum - last));
    last = sum;
  });
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, (int) (8.8 * PI / guess / dt)));
  EXPECT_GE(zeros.size(), 8u);
  return PI * (zeros.size() - 1.0) / (zeros.back() - zeros.front());
}

static double cylinder_frequency(int n, const std::string &options)
{
  const double nu = 0.3, E = 1.0, h = 1.0 / n;
  const double c = sqrt(E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)));
  const double x = root(1.0, 2.3, [&](double x) {
    return x * std::cyl_bessel_j(0, x) - (1 - 2 * nu) / (1 - nu) * std::cyl_bessel_j(1, x);
  });
  Scene run(start(2, 2.0 * h, h, options) +
            points("block 0 1 INF INF INF INF", "density 1.0 linear 1.0 0.3") +
            "fix ends all mpm/boundary ylo yhi slip\n");
  run.set_velocity([=](const double *r, double *v) {
    v[0] = 1e-5 * std::cyl_bessel_j(1, x * r[0]);
  });
  const double found = frequency(run, 0.3 * h / c, false, 0.0, x * c);
  return measured(options + ": frequency of the cylinder, error", found / (x * c) - 1.0);
}

TEST(AxisymmetricVibration, Cylinder)
{
  for (const char *options :
       {"shape quadratic transfer apic", "shape cubic transfer flip 1.0",
        "shape cpgimp transfer apic", "frame total transfer apic", "transfer flip 1.0 scheme musl",
        "transfer apic scheme usf", "transfer polypic", "shape cpdi2 transfer apic",
        "transfer flip 1.0 scheme musl edges modified",
        "shape bernstein frame total transfer apic"}) {
    const double coarse = cylinder_frequency(8, options), fine = cylinder_frequency(16, options);
    EXPECT_LT(std::abs(fine), 0.0015) << options;
    const double order = measured("order", log2(coarse / fine));
    if (!strstr(options,
                "bernstein"))    // whose sum over points has an error of its own, see above
      EXPECT_NEAR(order, 2.0, 0.2) << options;
  }
}

TEST(AxisymmetricVibration, Sphere)
{
  const double nu = 0.3, c = sqrt((1 - nu) / ((1 + nu) * (1 - 2 * nu)));
  const double shear2 = (1 - 2 * nu) / (2 * (1 - nu));    // (cs/c)^2
  const double x = root(2.0, 3.0, [&](double x) {
    return tan(x) * (1.0 - x * x / (4.0 * shear2)) - x;
  });
  const double R = 1.0, h = R / 16;
  for (const char *options : {"transfer apic", "frame total shape cubic transfer flip 1.0"}) {
    Scene run(start(2, 4, h, options) + points("sphere 0 2 0 1", "density 1.0 linear 1.0 0.3"));
    run.set_velocity([](const double *r, double *v) {
      const double y = r[1] - 2.0;
      v[0] = 1e-5 * r[0];
      v[1] = 1e-5 * y;
    });
    const double found = frequency(run, 0.3 * h / c, true, 2.0, x * c);
    EXPECT_NEAR(
        measured(std::string(options) + ": frequency of the sphere over exact", found / (x * c)),
        1.0, 0.007);
  }
}

// a ball falls, spreads, and oscillates: momentum along the axis is that of gravity
PARAMETER_TEST(AxisymmetricBall, MomentumAndEnergy, const char *,
               Values("transfer apic", "shape cubic transfer flip 1.0 scheme musl",
                      "shape gimp transfer aflip 0.99", "shape cpgimp transfer tpic",
                      "transfer xpic 3", "transfer fmpm 2", "transfer flip 1.0 scheme usavg",
                      "transfer apic scheme usf", "shape cpdi transfer apic",
                      "shape cpdi transfer flip 1.0 scheme musl", "transfer apic locking both",
                      "frame total transfer apic",
                      "frame total transfer flip 1.0 scheme musl locking both",
                      "shape linear transfer apic light 0.5",
                      "shape linear transfer flip 1.0 light 0.5",
                      "shape linear transfer apic scheme musl light 0.5 locking both",
                      "transfer polypic", "transfer flip 1.0 scheme musl edges modified",
                      "shape cubic transfer flip 1.0 scheme musl edges modified",
                      "shape cubic transfer polypic scheme musl locking both",
                      "shape cpdi2 transfer apic", "shape cpdi2 transfer flip 1.0 scheme musl",
                      "shape bernstein frame total locking pressure",
                      "shape bernstein frame total transfer flip 1.0 scheme musl locking both"))
{
  const char *options = GetParam();
  Scene run(start(10, 20, 0.5, options) +
            points("sphere 0 14 0 2.5", "density 1.0 neohookean 10.0 0.3") +
            "fix g all gravity 0.1 vector 0 -1 0\ncompute e all mpm/energy\n"
            "thermo_style custom step c_e[*]\ntimestep 0.02\n");
  run.set_velocity([](const double *x, double *v) {
    v[0] = 0.3 * x[0];
    v[1] = -0.3 * (x[1] - 14.0);
  });
  run.commands("run 0\n");
  const auto before = run.sums();
  run.commands("run 400\n");
  const auto after = run.sums();
  const double impulse = -0.1 * before.mass * 400 * 0.02;
  EXPECT_NEAR(after.p[1] - before.p[1], impulse, 1e-12 * before.mass) << options;
  const double *e = run.compute_vector();
  EXPECT_NEAR(e[10], 0.0, 1e-10 * before.kinetic) << options;
  // force and strain of the hoop are conjugate: what one takes, the other one gives. FLIP: motion
  // that nodes see but points do not is lost in one entry and found in the other
  // Light nodes: stress works on another gradient than force, but no energy comes of it in all
  const std::string words = options;
  const bool flip = words.find("flip 1.0") != std::string::npos;
  const double error = e[9] + (flip ? e[8] : 0.0);
  measured(words + ": error of energy, relative", error / before.kinetic);
  if (words.find("light") != std::string::npos)
    EXPECT_LT(e[8] + e[9], 0.0) << options;
  else if (words.find("pm ") == std::string::npos && words.find("xpic") == std::string::npos) {
    EXPECT_LT(std::abs(error), 0.06 * before.kinetic) << options;
  }
}

// water in a glass: the pressure depends on the depth only, also at the axis
TEST(Axisymmetric, Hydrostatics)
{
  for (const char *options : {"shape quadratic transfer apic", "shape cpgimp transfer apic"}) {
    Scene run;
    const double g = 0.01, H = 4.0;
    run.commands(
        start(4, 6, 0.5, options) +
        points("block 0 4 0 4 INF INF", "density 1.0 eos linear 100.0 viscosity newtonian 2.0") +
        "fix glass all mpm/boundary xhi ylo slip\nfix g all gravity 0.01 vector 0 -1 0\n"
        "timestep 0.01\n");
    run.commands("run 3000\n");
    double worst = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const auto s = run.cauchy(i);
      const double p = -(s[0] + s[1] + s[2]) / 3.0;
      worst = std::max(worst, std::abs(p - g * (H - run.x()[i][1])) / (g * H));
    }
    EXPECT_LT(measured(std::string(options) + ": error of pressure, largest", worst), 0.06);
  }
}

// Boxes of points end at the axis and at walls. Where round-off decided whether they reach a node
// beyond, the same in units of another length differed by 2e-5 of the velocity
TEST(Axisymmetric, BoxesDoNotReachOverTheAxis)
{
  const auto end = [](const char *axis, double unit) {
    Scene run(plane("si", "f f", strprintf("0 %.17g 0 %.17g", 0.14 * unit, 0.12 * unit), 1,
                    0.005 * unit) +
              strprintf("fix grid all mpm %.17g shape cpgimp transfer tpic scheme musl smooth 0.5 "
                        "axisymmetric %s\n",
                        0.01 * unit, axis) +
              strprintf("region body block 0 %.17g %.17g %.17g INF INF\n", 0.04 * unit, 0.02 * unit,
                        0.06 * unit) +
              "create_points 1 region body ppc 2\n" +
              strprintf("fix m all mpm/material density 1000 eos linear 5e6 viscosity newtonian "
                        "%.17g\n",
                        10.0 * unit) +
              "fix axis all mpm/boundary xlo slip\nvelocity all set 3 2 0\n" +
              strprintf("fix step all mpm/dt 0.2 max %.17g\nrun 12\n", 3e-5 * unit));
    auto points = run.gather();
    for (auto &p : points) p.mass = p.vol = p.x[0] = p.x[1] = 0.0;
    return points;
  };
  for (const char *axis : {"yes", "no"})
    for (const double unit : {0.7, 10.0})
      EXPECT_LT(measured(strprintf("axisymmetric %s, %g", axis, unit),
                         difference(end(axis, 1.0), end(axis, unit))),
                1e-11);
}

// a cylinder that swells in a sleeve pushes it outward and does not get into it; momentum along the
// axis is conserved. Then the same along the axis: of two equal cylinders that collide, the one
// that was at rest goes on
static std::string two_bodies_of_revolution(const std::string &one, const std::string &two)
{
  return plane("lj", "f f", "0 8 0 16", 2, 0.15) +
      fields({{"one", "block " + one + " INF INF"}, {"two", "block " + two + " INF INF"}},
             "0.5 axisymmetric yes") +
      "fix m all mpm/material density 1.0 neohookean 10.0 0.3\n"
      "fix axis all mpm/boundary xlo slip\nfix c all mpm/contact F1 F2\n"
      "compute e all mpm/energy\nthermo_style custom step c_e[*]\ntimestep 0.02\n";
}

TEST(Axisymmetric, Contact)
{
  Scene sleeve(two_bodies_of_revolution("0 2 4 8", "2 3 4 8"));
  sleeve.set_velocity([](const double *x, double *v) {
    v[0] = x[0] < 2.0 ? 0.3 * x[0] : 0.0;
  });
  sleeve.commands("run 100\n");
  double inner = 0.0, outer = 100.0, stretch = 0.0;
  for (int i = 0; i < sleeve.n(); i++) {
    const double r = sleeve.x()[i][0];
    if (sleeve.lmp->atom->type[i] == 1)
      inner = std::max(inner, r);
    else {
      outer = std::min(outer, r);
      stretch = std::max(stretch, sleeve.points().F[i][8]);
    }
  }
  EXPECT_GT(measured("distance of the bodies", outer - inner), 0.1);
  EXPECT_GT(measured("stretch of the sleeve", stretch), 1.01);
  EXPECT_NEAR(sleeve.sums().p[1], 0.0, 1e-11);

  double velocity[2];
  for (const bool round : {false, true}) {
    // without lateral strain, a bar of revolution does what one in the plane does
    auto scene = replaced(two_bodies_of_revolution("0 2 2 5", "0 2 6 9"), "10.0 0.3", "10.0 0.0");
    if (!round) scene = replaced(scene, "axisymmetric yes", "axisymmetric no");
    Scene axial(scene);
    axial.set_velocity([](const double *x, double *v) {
      v[1] = x[1] < 5.5 ? 0.3 : 0.0;
    });
    const auto before = axial.sums();
    axial.commands("run 600\n");
    const double mass = axial.sums(2).mass;
    EXPECT_NEAR(axial.sums().p[1], before.p[1], 1e-11 * mass);
    velocity[round] = measured("velocity of the second body", axial.sums(2).p[1] / mass);
    EXPECT_NEAR(axial.compute_vector()[10], 0.0, 1e-10 * before.kinetic);
  }
  EXPECT_GT(velocity[1], 0.25);
  EXPECT_NEAR(velocity[1], velocity[0], 0.006);    // edges
}

// a cylinder is drawn off another one: as these have no lateral strain, the pull per area of the
// circle is that per width of two bars in the plane, up to what nodes at the sides and at the axis
// make of it with four cells in the radius
static double pull(bool round)
{
  const double area = round ? PI * 2.0 * 2.0 : 2.0, strength = 0.2;
  Scene run(plane("lj", "f f", "0 2 0 16", 2, 0.15) +
            fields({{"one", "block 0 2 4 8 INF INF"}, {"two", "block 0 2 8 12 INF INF"}},
                   strprintf("0.5 axisymmetric %s", round ? "yes" : "no")) +
            strprintf("fix m all mpm/material density 1.0 neohookean 50.0 0.0\n"
                      "fix sides all mpm/boundary xlo xhi slip\n"
                      "fix c all mpm/contact F1 F2 law adhesive %g %g 0.02\n"
                      "region low block INF INF 0 4.6 INF INF\n"
                      "fix hold all mpm/boundary region low stick field F1\n"
                      "region high block INF INF 11.4 16 INF INF\n"
                      "fix pull all mpm/boundary region high stick velocity 0 0.02 0 field F2\n"
                      "velocity two set 0 0.02 0\ntimestep 0.02\n"
                      "thermo_style custom step f_c[1][2]\n",
                      strength, strength));
  double largest = 0.0;
  for (int k = 0; k < 90; k++) {
    run.commands("run 10 post no\n");
    largest = std::max(largest, std::abs(run.evaluate("f_c[1][2]")) / area);
  }
  return measured("largest pull/strength", largest / strength);
}

TEST(Axisymmetric, AdhesionActsOnTheWholeCircle)
{
  const double plane = pull(false);
  EXPECT_NEAR(plane, 1.0, 0.003);
  EXPECT_NEAR(pull(true), 1.0, 0.06);
}

// in a box that begins at r > 0 rings are stiffer than the plane: the limit of the time step is
// h/(c [1 + (h/2r)^2]^1/2) at the innermost points
TEST(Axisymmetric, TimeStepOfRings)
{
  const double nu = 0.3, c = sqrt((1 - nu) / ((1 + nu) * (1 - 2 * nu)));
  for (const double inner : {0.0, 0.5, 4.0})
    for (const double h : {1.0, 1e-6}) {    // also of a millionth of the unit of length
      Scene run(plane("lj", "f p", strprintf("%g %g 0 %g", inner * h, 8 * h, 4 * h), 1, 0.3 * h) +
                body("box", "density 1.0 linear 1.0 0.3", strprintf("%g axisymmetric yes", h)) +
                "fix axis all mpm/boundary xlo slip\nfix dt all mpm/dt 0.5\nrun 0\n");
      const double ratio = inner > 0.0 ? 0.5 / (inner + 0.25) : 0.0;
      EXPECT_NEAR(run.lmp->update->dt / h * c * sqrt(1.0 + ratio * ratio), 0.5, 1e-12)
          << inner << " " << h;
    }
}

// averages in cells are over the volume of the ring that a cell is
TEST(Axisymmetric, Cells)
{
  Scene run(start(4, 3, 0.5, "") +
            "create_points 1 box ppc 3\nfix m all mpm/material density 2.0 neohookean 10.0 0.3\n"
            "fix cells all mpm/cells grid\nrun 0\n");
  auto *cells = run.fix("cells");
  for (const char *name : {"density", "fraction"}) {
    int ncolumn;
    const int index = cells->get_griddata_by_name(0, name, ncolumn);
    auto *value = (double **) cells->get_griddata_by_index(index);
    for (int y = 0; y < 6; y++)
      for (int x = 0; x < 8; x++)
        EXPECT_NEAR(value[y][x], name[0] == 'd' ? 2.0 : 1.0, 1e-12) << name;
  }
}

static std::string crooked_mesh(double left, double right, double low, double high, int n)
{
  ThinMesh mesh;
  for (int j = 0; j <= n; j++)
    for (int i = 0; i <= n; i++) {
      const double inside = i > 0 && i < n && j > 0 && j < n ? 0.2 / n : 0.0;
      mesh.x.push_back({left + (right - left) * ((double) i / n + inside * sin(7.0 * i + 3.0 * j)),
                        low + (high - low) * ((double) j / n + inside * cos(5.0 * i - 2.0 * j)),
                        0.0});
      const int c = i + j * (n + 1);
      if (i < n && j < n) mesh.elements.push_back({c, c + 1, c + n + 2, c + n + 1});
    }
  return mesh.text();
}

TEST(Axisymmetric, ElementsOfAMeshAreRings)
{
  const double a = 0.3, b = -0.2, dt = 0.01;
  for (const double bore : {0.0, 1.5}) {
    const ScratchFile mesh("rings.msh", crooked_mesh(bore, 4.0, 1.0, 4.0, 7));
    Scene run(start(6, 6, 1.0, "shape cpdi2") + "create_points 1 elements " + mesh.name +
              "\nfix m all mpm/material density 2.0 neohookean 10.0 0.3\n" +
              strprintf("timestep %g\n", dt));
    run.set_velocity([=](const double *x, double *v) {
      v[0] = a * x[0];
      v[1] = b * x[1];
    });
    run.commands("run 1\n");
    EXPECT_NEAR(run.sums().mass, 2.0 * PI * (16.0 - bore * bore) * 3.0, 1e-11);
    for (const auto &p : run.gather()) {
      EXPECT_NEAR(p.F[0], 1.0 + a * dt, 1e-13);
      EXPECT_NEAR(p.F[4], 1.0 + b * dt, 1e-13);
      EXPECT_NEAR(p.F[8], 1.0 + a * dt, 1e-13);
    }
  }
  const ScratchFile mesh("rings.msh", crooked_mesh(-0.1, 4.0, 1.0, 4.0, 7));
  const std::string scene = start(6, 6, 1.0, "shape cpdi2");
  expect_error(scene + "create_points 1 elements " + mesh.name + "\n", "reaches below x = 0");
  expect_error(scene + "create_points 1 mesh " + mesh.name + "\n",
               "use create_points elements or region");
}

// F-bar changes volumes: of the motion of a point it keeps everything else, around the axis, too
TEST(Axisymmetric, LockingChangesTheVolumeOnly)
{
  const auto one_step = [](const std::string &locking) {
    Scene run(start(8, 8, 1.0, "transfer flip 1.0 scheme musl" + locking) +
              points("block 1 5 1 6 INF INF", "density 1.0 neohookean 10.0 0.45") +
              "velocity all ramp vx 0.0 0.5 y 1 6\nvelocity all ramp vy -0.3 0.3 x 1 5\ntimestep "
              "0.02\nrun 1\n");
    return run.gather();
  };
  const auto own = one_step(""), averaged = one_step(" locking fbar");
  ASSERT_EQ(own.size(), averaged.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < own.size(); k++) {
    const double stretch = cbrt(MPMPoints::det(averaged[k].F) / MPMPoints::det(own[k].F));
    for (int c = 0; c < 9; c++) EXPECT_NEAR(averaged[k].F[c], stretch * own[k].F[c], 1e-14);
    largest = std::max(largest, std::abs(stretch - 1.0));
  }
  EXPECT_GT(largest, 1e-4);    // the strain of the motion is not uniform
}

TEST(Axisymmetric, Refused)
{
  const std::string head = "units lj\nboundary f f MPM_Z\natom_style mpm\n"
                           "region box block MPM_LOW 4 0 4 -0.5 0.5\n";
  const auto box = [&](const char *z, const char *low) {
    return replaced(replaced(head, "MPM_Z", z), "MPM_LOW", low);
  };
  expect_error(box("f", "0") + "create_box 1 box\nfix grid all mpm 0.5 axisymmetric yes\n",
               "needs dimension 2");
  expect_error("dimension 2\n" + box("p", "-1") +
                   "create_box 1 box\nfix grid all mpm 0.5 axisymmetric yes\n",
               "must not reach below x = 0");
  const std::string scene = "dimension 2\n" + box("p", "0") +
      "create_box 1 box\nfix grid all mpm 0.5 axisymmetric yes\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 1.0 linear 1.0 0.3\n";
  expect_refused(
      scene,
      {{"", "use fix mpm/boundary xlo slip"},
       {"fix axis all mpm/boundary xhi slip", "use fix mpm/boundary xlo slip"},
       {"fix axis all mpm/boundary xlo separate", "use fix mpm/boundary xlo slip"},
       {"fix axis all mpm/boundary xlo slip velocity 1 0 0", "use fix mpm/boundary xlo slip"},
       {"fix axis all mpm/boundary xlo slip\nfix plane all mpm 0.5",
        "must be axisymmetric, or none"}},
      "run 0\n");
  const std::string grains =
      replaced(replaced(scene, "atom_style mpm", "atom_style hybrid sphere mpm"), "create_box 1",
               "create_box 2") +
      "set type 1 diameter 0.3\ncreate_atoms 2 single 2 3.9 0\nset type 2 diameter 0.5 "
      "density/disc 1\n"
      "group grains type 2\nfix move grains nve/sphere disc\nfix axis all mpm/boundary xlo slip\n"
      "comm_modify vel yes\npair_style granular\npair_coeff * * hooke 10 0 tangential "
      "linear_nohistory 0 0\n";
  expect_error(grains + "run 0\n", "a grain would be a ring");
  expect_error(grains + "fix skin all mpm/surface\nrun 0\n", "a grain would be a ring");
  const ScratchFile file("rings.bin");
  expect_error(scene + "fix axis all mpm/boundary xlo slip\nrun 1\nwrite_restart " + file.name +
                   "\nclear\nread_restart " + file.name + "\nfix grid all mpm 0.5\n",
               "axisymmetric yes (now no)");
}

// points as wide as cells: their size is known before deformation, not asked again later
TEST(Axisymmetric, FullCellsGoOn)
{
  for (const char *options : {"shape cpgimp transfer flip 1.0 scheme musl",
                              "shape gimp locking fbar", "shape gimp every 30 dtcheck no"}) {
    Scene run(start(8, 8, 1.0, options) +
              replaced(points("block 0 4 2 6 INF INF", "density 1.0 neohookean 10.0 0.3"), "ppc 2",
                       "ppc 1") +
              "velocity all ramp vx 0 -0.3 x 0 4\ntimestep 0.05\nrun 20\n");
    EXPECT_EQ(run.error("run 5\n"), "") << options;
    // new points that are too large are refused as before
    expect_error(
        run, "region more block 5 8 3 6 INF INF\ncreate_points 1 region more spacing 1.5\nrun 1\n",
        "larger than the cells");
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Bars in closed form: in 2d (plane strain) with Poisson's ratio 0, one cell across, periodic.

#include "wave_testing.h"

using namespace MPM_TEST;

/** A bar with E = 100, density 1, wave speed 10, along x. */
struct Bar {
  double h, lo, hi;         // node spacing, ends of the bar
  double boxlo, boxhi;      // ends of the box
  std::string options;      // of fix mpm
  std::string more = "";    // further input, before the run
  double E = 100.0;
  std::string law = "linear";
  int ppc = 2;
};

static void setup(Scene &run, const Bar &bar)
{
  run.commands(plane("si", "f p", strprintf("%.17g %.17g 0 %.17g", bar.boxlo, bar.boxhi, bar.h), 2,
                     0.4 * bar.h) +
               strprintf("fix grid all mpm %.17g %s\nregion bar block %.17g %.17g INF INF INF INF\n"
                         "create_points 1 region bar ppc %d 1\n"
                         "fix elastic all mpm/material density 1 %s %.17g 0\n%s",
                         bar.h, bar.options.c_str(), bar.lo, bar.hi, bar.ppc, bar.law.c_str(),
                         bar.E, bar.more.c_str()));
  run.set_reference();
}

static void run_steps(Scene &run, double dt, int n)
{
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, n));
}

// A1: one point in one cell, node 1 fixed: the time integrator alone. v = 0.1 cos(2 pi t) exactly,
// since the log strain e of the law `linear' obeys e' = v, v' = -E e (N2/m2 = 1/M cancels).
class SinglePoint : public ::testing::TestWithParam<const char *> {
 protected:
  double error_v, energy_min, energy_max, period;
  double error_usl;    // against the recursion of USL, see TenPeriods

  void simulate(double dt)
  {
    Scene run;
    setup(run,
          {1.0, 0.0, 1.0, 0.0, 2.0,
           std::string("shape linear transfer flip 1.0 scheme ") + GetParam(),
           "fix node1 all mpm/boundary xlo stick\n", 4.0 * PI * PI, "linear", 1});
    ASSERT_EQ(run.n(), 1);
    ASSERT_DOUBLE_EQ(run.mass()[0], 1.0);
    run.v()[0][0] = 0.1;
    error_v = energy_max = 0.0;
    energy_min = 1.0e300;
    Crossings crossings;
    const double E = 4.0 * PI * PI;
    double v_usl = 0.1, strain = 0.0;
    error_usl = 0.0;
    run.each_step([&](double **) {
      const double t = run.time();
      const double v = run.v()[0][0];
      grow(error_usl, v - v_usl);
      const double a = -E * strain;
      const double L = v_usl + dt * a / run.x()[0][0];    // N = x
      strain += dt * L / (1.0 + 0.5 * dt * L);            // logarithmic, to third order
      v_usl += dt * a;
      grow(error_v, v - 0.1 * cos(2.0 * PI * t));
      crossings.add(t, v);
      const double energy = (run.sums().kinetic + run.stored_energy()) / 0.005;
      energy_min = std::min(energy_min, energy);
      energy_max = std::max(energy_max, energy);
    });
    run_steps(run, dt, std::lround(10.0 / dt));
    period = crossings.period();
  }
};

TEST_P(SinglePoint, TenPeriods)
{
  simulate(1.0e-3);
  const double coarse = error_v;
  measured("A1 max |dv|/v0", error_v / 0.1);
  measured("A1 min E/E0", energy_min);
  measured("A1 max E/E0", energy_max);
  measured("A1 period - 1", period - 1.0);
  if (GetParam() == std::string("usl")) {
    // the strain follows the node, whose velocity changes by 1/N = 2 times that of the point: this
    // damps, e' = v - (1/N - 1) dt E e, E/E0 = exp(-(1/N - 1) dt E t) = 0.674 after ten periods.
    // The velocity is off by 18 %: what must be is the recursion of these two numbers, to the third
    // order of the strain of a step, 1e-4, times 1e4 steps
    EXPECT_LT(measured("A1 error against the recursion of USL", error_usl / 0.1), 1.0e-8);
    EXPECT_NEAR(energy_min, exp(-1.0e-3 * 4.0 * PI * PI * 10.0), 0.01);
    EXPECT_LT(energy_max, 1.0 + 1.3 * 0.00315);
    EXPECT_NEAR(period - 1.0, 0.0, 1.0e-5);
  } else {
    // bounds: 1.3 times what an independent code gives at this time step; leap-frog period
    EXPECT_LT(error_v / 0.1, 1.3 * 3.1e-3);
    EXPECT_GT(energy_min, 1.0 - 1.3 * 0.00313);
    EXPECT_LT(energy_max, 1.0 + 1.3 * 0.00315);
    EXPECT_NEAR(period - 1.0, -pow(2.0 * PI * 1.0e-3, 2) / 24.0, 1.0e-11);
  }

  // first order in dt
  simulate(0.5e-3);
  EXPECT_NEAR(measured("A1 error ratio for dt/2", coarse / error_v), 2.0, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Scheme, SinglePoint, ::testing::Values("usl", "usf", "musl"));

// A2: first mode of a bar of length 25, fixed at one end. Period 10, energy constant.
struct Vibration {
  double period, energy;    // relative to the exact ones
};

/** wall: the fixed end is held by a wall; otherwise by symmetry, with a bar twice as long. */
static Vibration vibrate(const std::string &options, int cells, int ppc, bool wall,
                         double cfl = 0.2)
{
  const double h = 25.0 / cells, v0 = 1.0e-3;    // small: the laws are linear there
  Scene run;
  setup(run,
        {h, wall ? 0.0 : -25.0, 25.0, wall ? 0.0 : -25.0 - 4.0 * h, 25.0 + 4.0 * h, options,
         wall ? "fix wall all mpm/boundary xlo stick\n" : "", 100.0, "linear", ppc});
  EXPECT_EQ(run.n(), cells * ppc * (wall ? 1 : 2));
  run.set_velocity([=](const double *x, double *v) {
    v[0] = v0 * sin(PI * x[0] / 50.0);
  });
  const double start = run.sums().kinetic;
  EXPECT_NEAR(start / (0.25 * 25.0 * v0 * v0 * h * (wall ? 1.0 : 2.0)), 1.0, 1.0e-3);
  Crossings crossings;
  run.each_step([&](double **) {
    double p = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][0] > 0.0) p += run.mass()[i] * run.v()[i][0];
    crossings.add(run.time(), p);
  });
  const double dt = cfl * h / 10.0;
  run_steps(run, dt, std::lround(100.0 / dt));
  const std::string name = strprintf("A2 %s, %d cells, ppc %d, cfl %g%s: ", options.c_str(), cells,
                                     ppc, cfl, wall ? ", wall" : "");
  return {measured(name + "T/T1", crossings.period() / 10.0),
          measured(name + "E/E0", (run.sums().kinetic + run.stored_energy()) / start)};
}

/** The same bar in a code of its own, one-dimensional and linear: points stay where they are, nodes
 *  in rows, from -25 to 25 instead of a wall. Splines of the order, usl or musl; transfers flip
 *  1.0; apic with C = B/D and the force of the same moment, but for order 1; tpic with the gradient
 *  of the functions in both. mode: of vibration, until: the end. Period, and energy at the end, of
 *  the points' velocities and strains, over those of the continuum and of the start. */
static Vibration independent(int order, const std::string &transfer, bool musl, int cells,
                             int mode = 1, double until = 100.0)
{
  const double h = 25.0 / cells, E = 100.0, dt = 0.2 * h / 10.0, D = order == 2 ? 0.25 : 1.0 / 3.0;
  const int n = 4 * cells, nodes = 2 * cells + 9, reach = order + 1;
  const bool flip = transfer == "flip", gradient = transfer != "apic" || order == 1;
  const double beta = (2 * mode - 1) * PI / 50.0;
  struct Point {
    double x, v, C, strain;
    int node[4];
    double w[4], g[4], r[4];    // function, gradient for strain and force, distance
  };
  std::vector<Point> points(n);
  for (int p = 0; p < n; p++) {
    auto &q = points[p];
    q.x = (p + 0.5) * 0.5 * h - 25.0;
    q.v = sin(beta * q.x);
    q.C = flip ? 0.0 : beta * cos(beta * q.x);
    q.strain = 0.0;
    const double s = q.x / h;
    const int first = (int) std::floor(s - 0.5 * (order - 1));
    for (int k = 0; k < reach; k++) {
      const double r = first + k - s;
      q.node[k] = first + k + cells + 4;
      q.r[k] = r * h;
      q.w[k] = bspline(order, -r);
      q.g[k] = gradient ? bspline_slope(order, -r) / h : q.w[k] * q.r[k] / (D * h * h);
    }
  }
  const auto energy = [&]() {
    double sum = 0.0;
    for (const auto &q : points) sum += q.v * q.v + E * q.strain * q.strain;
    return sum;
  };
  const double start = energy();
  std::vector<double> m(nodes, 0.0), v(nodes), f(nodes), old(nodes);
  for (const auto &q : points)
    for (int k = 0; k < reach; k++) m[q.node[k]] += q.w[k];
  const auto to_nodes = [&]() {
    std::fill(v.begin(), v.end(), 0.0);
    for (const auto &q : points)
      for (int k = 0; k < reach; k++) v[q.node[k]] += q.w[k] * (q.v + (flip ? 0.0 : q.C * q.r[k]));
    for (int i = 0; i < nodes; i++) v[i] = m[i] > 0.0 ? v[i] / m[i] : 0.0;
  };
  const auto steps = std::lround(until / dt);
  Crossings crossings;
  for (long step = 0; step < steps; step++) {
    double sum = 0.0;
    for (const auto &q : points) sum += q.v * sin(beta * q.x);
    crossings.add(step * dt, sum);
    to_nodes();
    old = v;
    std::fill(f.begin(), f.end(), 0.0);
    for (const auto &q : points)
      for (int k = 0; k < reach; k++) f[q.node[k]] -= E * q.strain * q.g[k];
    for (int i = 0; i < nodes; i++)
      if (m[i] > 0.0) v[i] += dt * f[i] / m[i];
    for (auto &q : points) {
      double in = 0.0, before = 0.0;
      q.C = 0.0;
      for (int k = 0; k < reach; k++) {
        in += q.w[k] * v[q.node[k]];
        before += q.w[k] * old[q.node[k]];
        q.C += q.g[k] * v[q.node[k]];
      }
      q.v = flip ? q.v + in - before : in;
    }
    if (musl) to_nodes();
    for (auto &q : points)
      for (int k = 0; k < reach; k++) q.strain += dt * q.g[k] * v[q.node[k]];
  }
  return {crossings.period() * 10.0 * beta / (2.0 * PI), energy() / start};
}

struct VibrationCase {
  const char *options;
  int cells, ppc;
  double period, period_tolerance;    // of T/10; 0: not oscillating
  double energy, energy_tolerance;    // E/E0 after 10 periods
  friend void PrintTo(const VibrationCase &c, std::ostream *out)
  {
    *out << c.options << ", " << c.cells << " cells";
  }
};

// Linear: an independent code, to 10 % of the period's deviation and 0.002 of the energy (FLIP
// 0.99: 0.01). Others: the everyday gate of 0.5 % and 1 %, but for cubic APIC and TPIC, which pay
// per step for what the affine field of a point does not hold: the code above, which has nothing of
// the package, has lost more than 1 % after 3200 steps. Of splines, that number is asked, to a
// tenth of the gate. The transfers alone of a wave with kh = 0.098, 2 points per cell and without
// forces, take 2.2e-6 (APIC) and 3.0e-6 (TPIC) of the amplitude of the velocity per step: 0.9929
// and 0.9905; USL takes the rest.
static const VibrationCase vibrating_bar_cases[] = {
    {"shape linear transfer flip 1.0 scheme usl", 16, 2, 1.00133, 1.3e-4, .9962, .002},
    {"shape linear transfer flip 1.0 scheme musl", 16, 2, 1.00133, 1.3e-4, .9984, .002},
    {"shape linear transfer flip 0.99 scheme musl", 16, 2, 1.00132, 1.3e-4, .9426, .01},
    {"shape linear transfer pic", 16, 2, 0.0, 0.0, .0031, .002},
    {"shape linear transfer apic", 16, 2, 1.00041, 4e-5, .9995, .002},
    {"shape linear transfer flip 1.0 scheme musl", 13, 1, 1.00245, 2.5e-4, .9965, .002},
    {"shape linear transfer apic", 13, 1, 1.00061, 6e-5, .9991, .002},
    {"shape quadratic transfer flip 1.0 scheme usl", 16, 2, 1.0, .005, 1.0, .01},
    {"shape quadratic transfer flip 1.0 scheme musl", 16, 2, 1.0, .005, 1.0, .01},
    {"shape quadratic transfer apic", 16, 2, 1.0, .005, 1.0, .011},
    {"shape quadratic transfer pic", 16, 2, 0.0, 0.0, .01, .01},
    {"shape cubic transfer flip 1.0 scheme musl", 16, 2, 1.0, .005, 1.0, .01},
    {"shape cubic transfer apic", 16, 2, 1.0, .005, 0.0, 0.0},
    {"shape gimp aspect 1 2 transfer flip 1.0 scheme musl", 16, 2, 1.0, .005, 1.0, .01},
    {"shape cpgimp aspect 1 2 transfer flip 1.0 scheme musl", 16, 2, 1.0, .005, 1.0, .01},
    {"shape cpgimp aspect 1 2 transfer apic", 16, 2, 1.0, .005, 1.0, .011},
    {"shape quadratic transfer aflip 1.0", 16, 2, 1.0, .005, 1.0, .01},
    {"shape quadratic transfer tpic", 16, 2, 1.0, .005, 0.0, 0.0}};

PARAMETER_TEST(VibratingBar, TenPeriods, VibrationCase, ValuesIn(vibrating_bar_cases))
{
  LONG_AFTER(3);
  const auto &c = GetParam();
  const auto v = vibrate(c.options, c.cells, c.ppc, true);
  if (c.energy > 0.0) { EXPECT_NEAR(v.energy, c.energy, c.energy_tolerance); }
  const std::string options = c.options;
  const auto has = [&](const char *word) {
    return options.find(word) != std::string::npos;
  };
  Vibration expected = {0.0, 0.0};
  if (!has("linear") && !has("gimp") && !has("pic") && !has("aflip")) {
    expected = independent(has("cubic") ? 3 : 2, "flip", has("musl"), c.cells);
  } else if (!has("linear") && !has("gimp") && (has("apic") || has("tpic"))) {
    expected = independent(has("cubic") ? 3 : 2, has("tpic") ? "tpic" : "apic", false, c.cells);
  }
  if (expected.energy > 0.0) {
    EXPECT_NEAR(v.energy, measured("A2 independent code: E/E0", expected.energy), 1.0e-4);
    EXPECT_NEAR(v.period, measured("A2 independent code: T/T1", expected.period), 1.0e-4);
  }
  if (c.period > 0.0) { EXPECT_NEAR(v.period, c.period, c.period_tolerance); }
}

// A2, mode 10 in 64 cells, 6.7 cells in a wave, over 38 periods, by another code: period and energy
// over the exact ones, 1.0295 and .958 (FLIP with MUSL), 1.0083 and 1.053 (APIC). Of the period, a
// tenth of the deviation; the energy of a leapfrog scheme is 1 +- omega dt/2 = 1 +- .047 by its
// phase, and a tenth of the deviation, over 38 periods, is any phase. The code above: four digits.
TEST(VibratingBarModeTen, PeriodAndEnergy)
{
  const double h = 25.0 / 64, beta = 19.0 * PI / 50.0, v0 = 1.0e-5, dt = 0.02 * h;
  for (const bool apic : {false, true}) {
    const std::string options =
        std::string("shape linear transfer ") + (apic ? "apic" : "flip 1.0 scheme musl");
    Scene run;
    setup(run,
          {h, 0.0, 25.0, 0.0, 25.0 + 4.0 * h, options, "fix wall all mpm/boundary xlo stick\n"});
    run.set_velocity([=](const double *x, double *v) {
      v[0] = v0 * sin(beta * x[0]);
    });
    run.commands("run 0\n");
    for (int i = 0; i < run.n() && apic; i++)
      run.affine()[i][0] = v0 * beta * cos(beta * run.x()[i][0]);
    const double start = run.sums().kinetic;
    Crossings crossings;
    run.each_step([&](double **) {
      double q = 0.0;
      for (int i = 0; i < run.n(); i++) q += run.v()[i][0] * sin(beta * run.reference(i)[0]);
      crossings.add(run.time(), q);
    });
    run_steps(run, dt, std::lround(20.0 / dt));
    const std::string name = "A2 mode 10, " + options + ": ";
    const double period = measured(name + "T/T10", crossings.period() * 10.0 * beta / (2.0 * PI));
    const double energy =
        measured(name + "E/E0", (run.sums().kinetic + run.stored_energy()) / start);
    const double deviation = apic ? .0083 : .0295;
    EXPECT_NEAR(period - 1.0, deviation, 0.1 * deviation);
    EXPECT_NEAR(energy, apic ? 1.053 : .958, .002 + 0.5 * 10.0 * beta * dt);
    const auto other = independent(1, apic ? "apic" : "flip", !apic, 64, 10, 20.0);
    EXPECT_NEAR(period, measured("A2 independent code: T/T10", other.period), 1.0e-6);
    EXPECT_NEAR(energy, measured("A2 independent code: E/E0", other.energy), 1.0e-5);
  }
}

// a wall is the same thing as symmetry
TEST(VibratingBarAtWall, AgainstSymmetry)
{
  for (auto *transfer : {"apic", "flip 1.0 scheme musl", "flip 0.98"})
    for (auto *shape : {"linear", "quadratic", "cubic"}) {
      const std::string options = strprintf("shape %s transfer %s", shape, transfer);
      const auto wall = vibrate(options, 16, 2, true), symmetry = vibrate(options, 16, 2, false);
      EXPECT_NEAR(wall.energy, symmetry.energy, 2.0e-5);
      EXPECT_NEAR(wall.period, symmetry.period, 1.0e-6);
    }
}

/* ----------------------------------------------- A3: impact of two bars, elementary wave theory */

// The bars touch at a node from the start, and are looked at until they separate: in a single
// velocity field they would then hold together until there is a cell or two between them, and L v/c
// is half a cell here (fields of their own, coupled by contact, are another matter).
struct Impact {
  double length2, E2;           // second bar: length, modulus (density 1)
  double v1, v2;                // velocities before
  double v1_after, v2_after;    // of the centres of mass
  double until;                 // end of contact, or before
  double plateau;               // interface stress, -Z1 Z2 (v1 - v2)/(Z1 + Z2)
  bool equal;
};

// Linear functions: a point that goes through a face of a cell changes the forces on the nodes by
// up to half of its stress (A4), so that 2 % cannot be asked where bars move by cells. Unequal bars
// do, by 1.5 cells; at a tenth of the velocities, with the same answer, no point crosses a face.
static void collide(const std::string &options, Impact c)
{
  SCOPED_TRACE(strprintf("second bar: length %g, modulus %g", c.length2, c.E2));
  if (options.find("linear") != std::string::npos && !c.equal)
    for (double *v : {&c.v1, &c.v2, &c.v1_after, &c.v2_after, &c.plateau}) *v *= 0.1;
  const double h = 0.01;    // bar 1 from -1 to 0, then bar 2
  Scene run;
  setup(run, {h, -1.0, 0.0, -1.5, c.length2 + 0.5, options});
  run.commands(strprintf("region second block 0 %.17g INF INF INF INF\n"
                         "create_points 2 region second ppc 2 1\ngroup one type 1\n"
                         "group two type 2\nunfix elastic\n"
                         "fix m1 one mpm/material density 1 linear 100 0\n"
                         "fix m2 two mpm/material density 1 linear %.17g 0\n"
                         "velocity one set %.17g 0 0\nvelocity two set %.17g 0 0\n",
                         c.length2, c.E2, c.v1, c.v2));
  const double speed = std::abs(c.v1 - c.v2), v_after[3] = {0.0, c.v1_after, c.v2_after};
  const double start = run.sums().kinetic;
  double p_start = 0.0, drift = 0.0, lowest = 0.0, stress = 0.0, worst = 0.0;
  int samples = 0;
  run.each_step(
      [&](double **) {
        const auto all = run.sums();
        const double t = run.time();
        if (t == 0.0) p_start = all.p[0];
        grow(drift, all.p[0] - p_start);
        // equal bars: KE/KE0 = 1 - ct/L, then ct/L - 1
        grow(worst, all.kinetic / start - std::abs(1.0 - 10.0 * t));
        if (t < 0.06 || t > 0.12) return;
        // plateau: the waves have passed this region, the reflected ones have not come back
        double sum = 0.0;
        int n = 0;
        for (int i = 0; i < run.n(); i++)
          if (std::abs(run.x()[i][0]) < 0.3) {
            sum += run.points().tau[i][0] / run.points().jacobian(i);
            // where moduli meet, points of one material have strain of the other
            if (c.E2 == 100.0 || std::abs(run.x()[i][0]) > 2.0 * h)
              lowest = std::min(lowest, run.points().tau[i][0] / run.points().jacobian(i));
            n++;
          }
        stress += sum / n;
        samples++;
      },
      10);
  const double dt = 2.0e-4;
  run_steps(run, dt, std::lround(c.until / dt));
  const double scale = std::abs(run.sums(1).mass * c.v1) + std::abs(run.sums(2).mass * c.v2);
  const std::string name = "A3 " + options + ": ";
  EXPECT_LT(measured(name + "momentum error", drift / scale), 1.0e-12);
  for (const int type : {1, 2}) {
    const auto body = run.sums(type);
    measured(name + strprintf("v%d after (exact %g)", type, v_after[type]), body.p[0] / body.mass);
    EXPECT_NEAR(body.p[0] / body.mass / speed, v_after[type] / speed, 0.02);
  }
  EXPECT_NEAR(measured(name + "interface stress/exact", stress / samples / c.plateau), 1.0, 0.02);
  // 15 %, without viscosity, is for APIC. FLIP damps nothing: a step in a chain of masses and
  // springs is an integral of the Airy function, maximum 1.2743 however fine it is
  const double overshoot = measured(name + "extreme stress of a point/exact", lowest / c.plateau);
  EXPECT_LT(overshoot, name.find("apic") == std::string::npos ? 1.2743 : 1.15);
  if (c.equal) {
    // kinetic energy of points: APIC has a part of it, within the width of the fronts, in C
    EXPECT_LT(measured(name + "error of KE/KE0", worst),
              name.find("apic") == std::string::npos ? 0.02 : 0.03);
  }
}

PARAMETER_TEST(Bars, Collide, const char *,
               Values("shape linear transfer flip 1.0 scheme musl", "shape quadratic transfer apic",
                      "shape quadratic transfer flip 1.0 scheme musl", "shape cubic transfer apic"))
{
  LONG_AFTER(1);
  collide(GetParam(), {1.0, 100.0, 0.05, -0.05, -0.05, 0.05, 0.2, -0.5, true});
  collide(GetParam(), {2.0, 100.0, 0.05, 0.0, 0.0, 0.025, 0.3, -0.25, false});    // twice as long
  // Z1 = 10, Z2 = 20, the waves return at the same time 2 L1/c1 = 2 L2/c2: bar 1 is then free of
  // stress with velocity 2 v_i - v1 and bar 2 with 2 v_i, v_i = v1/3
  collide(GetParam(), {2.0, 400.0, 0.06, 0.0, -0.02, 0.04, 0.2, -0.4, false});
}

// A4: free-free bar of length 1 in its first mode while it flies through the grid with velocity V.
// The error must not depend on V: linear shape functions fail, smooth ones must not.
// u = 0.01 cos(pi X) cos(10 pi t) + V t for a law with P = E (F - 1). The laws here are not linear
// at strains of 3 %; the truth is a fine total-Lagrangian solution for P = E/2 (F - 1/F), which is
// neohookean with Poisson's ratio 0, from the same initial state.
static constexpr double GALILEAN_A = 0.01, GALILEAN_E = 100.0;

/** Displacements of a free bar at times k dt, k = 0 .. steps, by linear finite elements. */
class FineBar {
  static constexpr int N = 800;
  std::vector<std::vector<double>> u;

 public:
  double energy = 0.0;    // at the start, stored or kinetic, per cross-section

  /** moving: from the undeformed bar, with the velocity of a quarter of a period before. */
  FineBar(double dt, int steps, bool moving)
  {
    const double H = 1.0 / N;
    std::vector<double> now(N + 1), v(N + 1, 0.0), f(N + 1);
    for (int k = 0; k <= N; k++)
      (moving ? v : now)[k] = GALILEAN_A * cos(PI * k * H) * (moving ? 10.0 * PI : 1.0);
    for (int k = 0; k <= N && moving; k++)
      energy += 0.5 * v[k] * v[k] * (k == 0 || k == N ? 0.5 * H : H);
    for (int k = 0; k < N; k++) {
      const double F = 1.0 + (now[k + 1] - now[k]) / H;
      energy += H * 0.5 * GALILEAN_E * (0.5 * (F * F - 1.0) - log(F));
    }
    const int sub = std::ceil(dt / (0.5 * H / 10.0));
    const double tau = dt / sub;
    u.push_back(now);
    for (int s = 1; s <= steps; s++) {
      for (int q = 0; q < sub; q++) {
        std::fill(f.begin(), f.end(), 0.0);
        for (int k = 0; k < N; k++) {
          const double F = 1.0 + (now[k + 1] - now[k]) / H;
          const double P = 0.5 * GALILEAN_E * (F - 1.0 / F);
          f[k] += P;
          f[k + 1] -= P;
        }
        // the first half step makes it the leap-frog form of velocity Verlet
        const double step = s == 1 && q == 0 ? 0.5 * tau : tau;
        for (int k = 0; k <= N; k++) v[k] += step * f[k] / (k == 0 || k == N ? 0.5 * H : H);
        for (int k = 0; k <= N; k++) now[k] += tau * v[k];
      }
      u.push_back(now);
    }
  }
  double displacement(int step, double X) const
  {
    const double s = X * N;
    const int k = std::min((int) s, N - 1);
    return u[step][k] + (s - k) * (u[step][k + 1] - u[step][k]);
  }
};

struct Galilean {
  double error, energy;    // max over time of the rms error, relative; energy/exact at the end
};

static Galilean galilean_bar(const std::string &options, int cells, double V)
{
  // one time step for all V: dissipation per step must not look like an effect of V
  const double A = GALILEAN_A, h = 1.0 / cells, dt = 0.2 * h / (10.0 + 5.0);
  const int steps = std::lround(1.0 / dt);
  const bool moving = options.find("total") != std::string::npos;    // which must begin undeformed
  static std::map<std::pair<int, bool>, FineBar> exact;
  if (!exact.count({cells, moving}))
    exact.emplace(std::make_pair(cells, moving), FineBar(dt, steps, moving));
  const FineBar &fine = exact.at({cells, moving});

  Scene run;
  setup(run, {h, 0.0, 1.0, -0.5, 6.5, options, "", GALILEAN_E, "neohookean"});
  for (int i = 0; i < run.n(); i++) {
    const double X = run.x()[i][0], F = 1.0 - A * PI * sin(PI * X);
    if (moving) {
      run.v()[i][0] = V + A * 10.0 * PI * cos(PI * X);
      continue;
    }
    run.x()[i][0] += A * cos(PI * X);
    run.v()[i][0] = V;
    run.points().F[i][0] = F;
    run.points().tau[i][0] = 0.5 * GALILEAN_E * (F * F - 1.0);
    // the other normal stresses of this law are zero with Poisson's ratio 0
  }
  double worst = 0.0, energy = 0.0;
  int step = 0;
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double X = run.reference(i)[0];
      sum += pow(run.x()[i][0] - X - V * run.time() - fine.displacement(step, X), 2);
    }
    worst = std::max(worst, sqrt(sum / run.n()));
    const auto all = run.sums();
    energy = all.kinetic - 0.5 * all.mass * V * V + run.stored_energy();
    step++;
  });
  run_steps(run, dt, steps);
  const std::string name = strprintf("A4 %s, %d cells, V = %g: ", options.c_str(), cells, V);
  return {measured(name + "error", worst / (A / sqrt(2.0))),
          measured(name + "E/E0", energy / (fine.energy * h))};
}

TEST(FineBar, IsNearTheLinearSolution)
{
  FineBar bar(0.05, 20, false);
  EXPECT_NEAR(bar.energy, 0.25 * pow(GALILEAN_A * 10.0 * PI, 2), 0.02 * bar.energy);
  for (const int step : {0, 1, 2, 3, 4}) {
    const double exact = GALILEAN_A * cos(PI * 0.3) * cos(10.0 * PI * 0.05 * step);
    EXPECT_NEAR(bar.displacement(step, 0.3), exact, 0.1 * GALILEAN_A);
  }
}

PARAMETER_TEST(GalileanBar, ErrorDoesNotDependOnVelocity, const char *,
               Values("shape quadratic transfer flip 1.0 scheme musl",
                      "shape quadratic transfer apic", "shape cubic transfer flip 1.0 scheme musl",
                      "shape cubic transfer apic",
                      "shape gimp aspect 1 2 transfer flip 1.0 scheme musl",
                      "shape cpgimp aspect 1 2 transfer flip 1.0 scheme musl",
                      "shape cpgimp aspect 1 2 transfer apic",
                      "shape cpdi aspect 1 2 transfer flip 1.0 scheme musl",
                      "shape cpdi2 aspect 1 2 transfer apic", "shape quadratic transfer aflip 1.0",
                      "shape quadratic transfer tpic",
                      "shape linear transfer flip 1.0 scheme musl frame total",
                      "shape quadratic transfer flip 1.0 scheme musl frame total",
                      "shape quadratic transfer apic frame total"))
{
  LONG_AFTER(1);
  const auto at_rest = galilean_bar(GetParam(), 40, 0.0);
  const auto slow = galilean_bar(GetParam(), 40, 1.0);
  const auto fast = galilean_bar(GetParam(), 40, 5.0);
  EXPECT_LT(at_rest.error, 0.06);
  EXPECT_LT(slow.error, 1.15 * at_rest.error);
  EXPECT_LT(fast.error, 1.15 * at_rest.error);
  for (const auto &g : {at_rest, slow, fast}) EXPECT_NEAR(g.energy, 1.0, 0.006);
}

TEST(GalileanBarLinear, ShowsTheDefect)
{
  const auto slow = galilean_bar("shape linear transfer flip 1.0 scheme musl", 40, 1.0);
  const auto smooth = galilean_bar("shape quadratic transfer flip 1.0 scheme musl", 40, 1.0);
  EXPECT_GT(slow.error, 3.0 * smooth.error);
}

// speed of a pulse: sqrt(E/rho) in a bar, sqrt((lambda + 2 mu)/rho) between slipping walls
struct PulseCase {
  const char *options, *law;
  double nu;
  friend void PrintTo(const PulseCase &c, std::ostream *out)
  {
    *out << c.options << ", " << c.law << ", nu = " << c.nu;
  }
};

// resolved to 0.3/h = 30 cells: what is left is the dispersion of the shape functions, O(h^2)
static const PulseCase pulse_cases[] = {
    {"shape linear transfer flip 1.0 scheme musl", "linear", 0.0},
    {"shape quadratic transfer apic", "linear", 0.0},
    {"shape quadratic transfer apic", "neohookean", 0.3},
    {"shape linear transfer flip 1.0", "linear", 0.3},
    {"shape cubic transfer flip 1.0 scheme musl", "neohookean", 0.3}};

PARAMETER_TEST(Pulse, WaveSpeed, PulseCase, ValuesIn(pulse_cases))
{
  LONG_AFTER(3);
  const auto &c = GetParam();
  const double h = 0.01, width = 0.3, A = 1.0e-5, E = 100.0;
  const double modulus = E * (1.0 - c.nu) / ((1.0 + c.nu) * (1.0 - 2.0 * c.nu));
  const double lambda = E * c.nu / ((1.0 + c.nu) * (1.0 - 2.0 * c.nu));
  const double speed = sqrt(modulus);
  Scene run(plane("si", "f f", strprintf("-0.2 3.2 0 %.17g", h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g %s\nregion bar block 0 3 INF INF INF INF\n"
                      "create_points 1 region bar ppc 2\n"
                      "fix elastic all mpm/material density 1 %s %.17g %.17g\n"
                      "fix sides all mpm/boundary ylo yhi slip\n",
                      h, c.options, c.law, E, c.nu));
  for (int i = 0; i < run.n(); i++) {
    const double X = run.x()[i][0], g = exp(-pow((X - 0.9) / width, 2));
    const double strain = -2.0 * A * (X - 0.9) / (width * width) * g;
    run.x()[i][0] += A * g;
    run.v()[i][0] = -speed * strain;
    run.points().F[i][0] += strain;
    const double J = 1.0 + strain;
    run.points().tau[i][0] = J * modulus * strain;
    run.points().tau[i][1] = run.points().tau[i][2] = J * lambda * strain;
  }
  // centre of the kinetic energy
  double position = 0.0, start = 0.0, energy = 0.0;
  run.each_step([&](double **) {
    position = energy = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double e = 0.5 * run.mass()[i] * pow(run.v()[i][0], 2);
      energy += e;
      position += e * run.x()[i][0];
    }
    position /= energy;
    if (run.time() == 0.0) start = position;
  });
  const double dt = 0.3 * h / speed;
  const int n = std::lround(1.2 / speed / dt);
  run_steps(run, dt, n);
  const double ratio = (position - start) / (n * dt) / speed;
  EXPECT_NEAR(
      measured(strprintf("wave speed / exact, %s, %s, nu = %g", c.options, c.law, c.nu), ratio),
      1.0, 0.01);
}

// J5: the same bar at rest, 20 cells, over 5e4 steps, 250 periods: FLIP 1 with MUSL keeps its
// energy with B-splines and in the total frame; USL may only lose. The numbers of an independent
// code are given as a comment: E/E0 after 5e4 steps. With leapfrog, whose velocities are those of
// half a step before, the energy is 1 +- omega dt/2 = 1 +- 0.0157, depending on the phase, for a
// linear bar; here a tenth of that more.
struct LongBar {
  const char *options;
  double least, most;
  friend void PrintTo(const LongBar &c, std::ostream *out) { *out << c.options; }
};

static constexpr double PHASE = 1.1 * 0.0157;

static const LongBar galilean_bar_at_rest_cases[] = {
    {"shape quadratic transfer flip 1.0 scheme musl", 1.0 - PHASE, 1.019 + PHASE},    // 1.019
    {"shape linear transfer flip 1.0 scheme musl frame total", 1.0 - PHASE,
     1.0 + PHASE},    // 1.006
    {"shape quadratic transfer flip 1.0 scheme musl frame total", 1.0 - PHASE,
     1.0 + PHASE},                                                        // 0.996
    {"shape quadratic transfer flip 1.0", 0.713 * (1.0 - PHASE), 1.0},    // 0.713
    {"shape cpgimp aspect 1 2 transfer flip 1.0", 0.75, 1.0}};            // 0.893

PARAMETER_TEST(GalileanBarAtRest, KeepsItsEnergy, LongBar, ValuesIn(galilean_bar_at_rest_cases))
{
  LONG_AFTER(1);
  const double A = GALILEAN_A, h = 0.05;
  Scene run;
  setup(run, {h, 0.0, 1.0, -0.5, 1.5, GetParam().options, "", GALILEAN_E, "neohookean"});
  run.set_velocity([=](const double *x, double *v) {
    v[0] = -A * 10.0 * PI * cos(PI * x[0]);
  });
  run.commands("run 0\n");
  const double start = run.sums().kinetic, momentum = run.sums().p[0];
  double least = 1.0e300, most = 0.0, end = 0.0;
  for (int k = 0; k < 50; k++) {
    run_steps(run, 0.2 * h / 10.0, 1000);
    end = (run.sums().kinetic + run.stored_energy()) / start;
    least = std::min(least, end);
    most = std::max(most, end);
  }
  const std::string name = strprintf("J5 %s: ", GetParam().options);
  measured(name + "energy at the end", end);
  EXPECT_GT(measured(name + "smallest energy", least), GetParam().least);
  EXPECT_LT(measured(name + "largest energy", most), GetParam().most);
  EXPECT_NEAR(run.sums().p[0], momentum, 1.0e-13);
}

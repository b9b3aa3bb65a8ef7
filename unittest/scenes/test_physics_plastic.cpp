// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Metals beyond yield, soil in motion (slopes, collapse of a column, flow on an incline), and
// standing waves in damped solids, one cell across.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// E1(f): a bar in uniaxial strain hits a wall at 100 m/s. An elastic precursor, then the plastic
// wave. J2, E = 70 GPa, nu = 0.33, yield stress 0.3 GPa; velocities in the frame of the bar.
TEST(PlasticWave, TwoWaveStructure)
{
  const double E = 70e9, nu = 0.33, sigmay = 0.3e9, rho = 2700.0, up = 100.0;
  const double K = E / (3.0 * (1.0 - 2.0 * nu)), G = E / (2.0 * (1.0 + nu));
  const int cells = 400;
  const double L = 0.4, h = L / cells;

  // small strain, and both waves for finite strain: stress over volume ratio J behind them
  const double hel = sigmay * (1.0 - nu) / (1.0 - 2.0 * nu), cl = sqrt((K + 4.0 / 3.0 * G) / rho);
  EXPECT_NEAR(hel, 591.176e6, 1.0e3);
  double strain = sigmay / (2.0 * G);
  for (int i = 0; i < 50; i++) strain = sigmay * exp(-strain) / (2.0 * G);
  const double J1 = exp(-strain), s1 = K * (1.0 / J1 - 1.0) + 2.0 / 3.0 * sigmay;
  const double C1 = sqrt(s1 / (rho * (1.0 - J1))), u1 = s1 / (rho * C1);
  double low = 0.9, high = J1;    // rho (up - u1)^2 = (s2 - s1) (J1 - J2)
  double J2 = 0.0, s2 = 0.0;
  for (int i = 0; i < 60; i++) {
    J2 = 0.5 * (low + high);
    s2 = K * (1.0 / J2 - 1.0) + 2.0 / 3.0 * sigmay;
    ((s2 - s1) * (J1 - J2) > rho * (up - u1) * (up - u1) ? low : high) = J2;
  }
  const double C2 = (up - u1) / (J1 - J2);
  EXPECT_NEAR(s2, 1471.52e6, 0.02 * 1471.52e6);
  EXPECT_NEAR(C1, 6197.82, 0.01 * 6197.82);

  Scene run(plane("si", "f p", strprintf("0 %.17g 0 %.17g", L + 10 * h, h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer apic\n"
                      "region bar block 0 %.17g INF INF INF INF\ncreate_points 1 region bar ppc 2\n"
                      "fix m all mpm/material density %.17g eos linear %.17g strength j2 %.17g "
                      "%.17g viscosity artificial 1.5 0.06\n"
                      "velocity all set -%.17g 0 0\nfix wall all mpm/boundary xlo slip\n",
                      h, L, rho, K, G, sigmay, up));
  run.set_reference();
  const double time = 0.75 * L / cl, dt = 0.4 * h / cl;
  const int steps = (int) std::lround(time / dt);
  run.commands(strprintf("timestep %.17g\nrun %d\n", time / steps, steps));

  // means over parts of the plateaus, and positions where the stress is half-way
  double mean[2] = {0.0, 0.0}, speed = 0.0, front[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  const double X2 = C2 * time, X1 = C1 * time;
  std::vector<std::array<double, 3>> profile;
  for (int i = 0; i < run.n(); i++) {
    const auto sigma = run.cauchy(i);
    const double X = run.reference(i)[0], s = -sigma[0];
    const int k = X < 0.9 * X2 && X > 0.3 * X2                 ? 0
        : X > X2 + 0.3 * (X1 - X2) && X < X2 + 0.8 * (X1 - X2) ? 1
                                                               : -1;
    if (k >= 0) {
      mean[k] += s;
      count[k]++;
    }
    if (k == 1) speed += run.v()[i][0] + up;
    profile.push_back({X, s, 0.0});
  }
  std::sort(profile.begin(), profile.end());
  for (size_t i = 1; i < profile.size(); i++)
    for (int k = 0; k < 2; k++) {
      const double half = k == 0 ? 0.5 * (s1 + s2) : 0.5 * s1;
      const double a = profile[i - 1][1], b = profile[i][1];
      if (a > half && b <= half)
        front[k] = profile[i - 1][0] + (a - half) / (a - b) * (profile[i][0] - profile[i - 1][0]);
    }
  EXPECT_NEAR(measured("E1f stress behind the plastic wave, MPa", mean[0] / count[0] / 1e6),
              s2 / 1e6, 0.02 * s2 / 1e6);
  EXPECT_NEAR(measured("E1f stress of the precursor, MPa", mean[1] / count[1] / 1e6), s1 / 1e6,
              0.02 * s1 / 1e6);
  EXPECT_NEAR(measured("E1f velocity behind the precursor", speed / count[1]), u1, 0.02 * u1);
  EXPECT_NEAR(measured("E1f speed of the plastic wave", front[0] / time), C2, 0.01 * C2);
  EXPECT_NEAR(measured("E1f speed of the precursor", front[1] / time), C1, 0.01 * C1);
}

// Thick-walled tube under internal pressure, plane strain, ideally plastic (R. Hill, The
// Mathematical Theory of Plasticity, 1950, ch. V): plastic for r < c with
//   p = k [2 ln(c/a) + 1 - c^2/b^2],  k = SIGMAY/sqrt(3)  (von Mises, exact for nu = 1/2)
// and at the outer surface u = 2 (1 - nu^2) k c^2/(E b). A quarter, points on circles.
struct Tube {
  double outer, plastic;    // displacement of the outer surface, radius of the plastic zone
};

static Tube tube(double h, double p, double nu, double yield)
{
  const double a = 1.0, b = 2.0, G = 1.0, K = 2.0 * G * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
  const double d = 0.5 * h;
  const int nr = std::lround((b - a) / d), nt = std::lround(0.5 * PI * 1.5 / d);
  const double time = 100.0, c = sqrt(K + 4.0 / 3.0 * G);
  Scene run(plane("lj", "f f", strprintf("0 %.17g 0 %.17g", 2.0 + 4 * h, 2.0 + 4 * h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer apic\n"
                      "region strip block 0 %.17g 0 %.17g INF INF\n"
                      "create_points 1 region strip spacing %.17g %.17g outside ignore\n"
                      "fix m all mpm/material density 1 eos linear %.17g strength j2 %.17g %.17g\n"
                      "fix walls all mpm/boundary xlo ylo slip\ncompute e all mpm/atom eplastic\n",
                      h, nr * 0.01, nt * 0.01, 0.01, 0.01, K, G, yield));
  EXPECT_EQ(run.n(), nr * nt);
  auto *atom = run.lmp->atom;
  for (int i = 0; i < run.n(); i++) {
    const int ir = atom->x[i][0] / 0.01, it = atom->x[i][1] / 0.01;
    const double r = a + (ir + 0.5) * (b - a) / nr, t = (it + 0.5) * 0.5 * PI / nt;
    atom->x[i][0] = r * cos(t);
    atom->x[i][1] = r * sin(t);
    atom->vfrac[i] = r * (b - a) / nr * 0.5 * PI / nt;
    atom->rmass[i] = atom->vfrac[i];
  }
  run.set_reference();
  run.each_step([&](double **force) {
    const double s = std::min(1.0, run.time() / (0.8 * time)), ramp = s * s * (3.0 - 2.0 * s);
    for (int i = 0; i < run.n(); i++) {
      const double *X = run.reference(i), R = sqrt(X[0] * X[0] + X[1] * X[1]);
      if (R > a + 0.9 * (b - a) / nr) continue;
      const double *x = run.x()[i], r = sqrt(x[0] * x[0] + x[1] * x[1]);
      for (int k = 0; k < 2; k++) force[i][k] = ramp * p * a * 0.5 * PI / nt * x[k] / r;
    }
  });
  const double dt = 0.4 * h / c;
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, (int) (time / dt)));
  Tube t = {0.0, 0.0};
  int n = 0;
  auto *eplastic = run.per_atom("e");
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i), *x = run.x()[i];
    const double R = sqrt(X[0] * X[0] + X[1] * X[1]), u = sqrt(x[0] * x[0] + x[1] * x[1]) - R;
    if (eplastic->vector_atom[i] > 0.0) t.plastic = std::max(t.plastic, R);
    if (R < b - (b - a) / nr) continue;
    t.outer += u;
    n++;
  }
  t.outer /= n;
  return t;
}

TEST(Tube, InternalPressure)
{
  LONG_CASE();
  const double k = 0.005, b = 2.0;
  for (const double nu : {0.3, 0.45}) {
    const double E = 2.0 * (1.0 + nu), factor = 2.0 * (1.0 - nu * nu) * b / E;
    // elastic
    const double half = 0.5 * k;
    const Tube elastic = tube(0.1, half, nu, k * sqrt(3.0));
    EXPECT_EQ(elastic.plastic, 0.0);
    EXPECT_NEAR(
        measured("tube elastic u(b)/exact", elastic.outer / (factor * half / (b * b - 1.0))), 1.0,
        0.04);
    // plastic up to the middle, at 90 % of the limit load 2 k ln(b/a)
    const double c = 1.5, p = k * (2.0 * log(c) + 1.0 - c * c / b / b);
    double error[2];
    for (int level = 0; level < 2; level++) {
      const double h = level ? 0.05 : 0.1;
      const Tube t = tube(h, p, nu, k * sqrt(3.0));
      const double ratio = t.outer / (factor * k * c * c / (b * b));
      measured(strprintf("tube nu %g h %g u(b)/exact", nu, h), ratio);
      EXPECT_NEAR(measured("radius of the plastic zone", t.plastic), c, h);
      error[level] = std::abs(ratio - 1.0);
    }
    EXPECT_LT(error[0], 0.06);
    EXPECT_LT(error[1], 0.03);
    EXPECT_LT(error[1], 0.7 * error[0]);
  }
}

// E4: Taylor bar of the steel 42CrMo4 (O. Pantale, DynELA), 32.4 mm long, radius 3.2 mm, 287 m/s,
// 80 microseconds, Johnson-Cook with heating; a quarter of it. Axisymmetric finite elements (own,
// 16 x 160, frictionless): length 26.525 mm, diameter 11.237 mm, plastic strain 1.884, 608 C;
// DynELA and Abaqus in 3d: 26.52 to 26.55, 11.18 to 11.22, 1.84, 597.
TEST(TaylorBar, SteelThatHeats)
{
  LONG_CASE();
  const double h = 0.0004, d = 0.25 * h;    // d: half the spacing of points
  Scene run(
      space("si", "f f f", strprintf("0 %.17g 0 %.17g 0 %.17g", 19 * h, 19 * h, 86 * h), 1,
            0.5 * h) +
      strprintf(
          "fix grid all mpm %.17g\nregion bar cylinder z 0 0 0.0032 0 0.0324\n"
          "create_points 1 region bar ppc 2 outside ignore\n"
          "fix steel all mpm/material density 7830 eos linear 172.41667e9 strength johnson/cook "
          "79.5769e9 806e6 614e6 0.168 0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9\n"
          "velocity all set 0 0 -287\nfix anvil all mpm/boundary zlo xlo ylo slip\n"
          "fix step all mpm/dt 0.5\nvariable t equal time\n"
          "fix end all halt 1 v_t > 8.0e-5 error continue\n"
          "compute p all mpm/atom eplastic temperature\nrun 20000\n",
          h));
  EXPECT_NEAR(run.time(), 8.0e-5, 1.0e-7);
  auto *history = run.per_atom("p");
  double top = 0.0, foot = 0.0, eplastic = 0.0, temperature = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *x = run.x()[i];
    top = std::max(top, x[2]);
    foot = std::max(foot, sqrt(x[0] * x[0] + x[1] * x[1]));
    eplastic = std::max(eplastic, history->array_atom[i][0]);
    temperature = std::max(temperature, history->array_atom[i][1]);
  }
  EXPECT_NEAR(measured("E4 length", 1.0e3 * (top + d)), 26.525, 0.005 * 26.525);
  EXPECT_NEAR(measured("E4 diameter", 2.0e3 * (foot + d)), 11.237, 0.03 * 11.237);
  EXPECT_NEAR(measured("E4 plastic strain", eplastic), 1.86, 0.05 * 1.86);
  EXPECT_NEAR(measured("E4 temperature", temperature), 600.0, 0.05 * 600.0);
}

constexpr double DEG = M_PI / 180.0, g = 9.81;

/** A layer on a rough plane with an angle; gravity comes slowly, so that it does not bounce. */
std::string layer(double depth, double h, int cells, double angle, double ramp,
                  const std::string &material, const std::string &velocity)
{
  return plane("si", "p f", strprintf("0 %.17g 0 %.17g -0.1 0.1", cells * h, depth + 4.0 * h), 1,
               0.5 * h) +
      strprintf("fix grid all mpm %.17g\nregion layer block INF INF 0 %.17g INF INF\n"
                "create_points 1 region layer ppc 2\n",
                h, depth) +
      "fix soil all mpm/material " + material + "\n" + velocity +
      strprintf("fix floor all mpm/boundary ylo stick\n"
                "variable g equal %.17g*(1-(time<%.17g)*(1-time/%.17g))\n"
                "fix g all gravity v_g vector %.17g %.17g 0\nfix step all mpm/dt 0.4\n"
                "variable t equal time\n",
                g, ramp, ramp, std::sin(angle), -std::cos(angle));
}

// G2: mu(I) on an incline, u(y) = 2/3 I_theta/d sqrt(fraction g cos) (h^1.5 - (h-y)^1.5) (L.E.
// Silbert et al., Phys. Rev. E 64 (2001) 051302; P. Jop et al., J. Fluid Mech. 541 (2005) 167)
struct Incline {
  double surface, rms;    ///< velocity at the surface, and error of the profile, over the exact u_s
  double fastest;
};

Incline flow(double degrees, int cells, double start, double time)
{
  const double depth = 0.01, d = 5.0e-4, fraction = 0.6, I0 = 0.279;
  const double mus = std::tan(20.9 * DEG), mu2 = std::tan(32.76 * DEG), a = degrees * DEG;
  const double I = I0 * (std::tan(a) - mus) / (mu2 - std::tan(a));
  const auto exact = [&](double y) {
    return 2.0 / 3.0 * I / d * std::sqrt(fraction * g * std::cos(a)) *
        (std::pow(depth, 1.5) - std::pow(std::max(depth - y, 0.0), 1.5));
  };
  const double us = exact(depth);
  Scene run(layer(depth, depth / cells, 4, a, 0.02,
                  strprintf("density 1500 mui 1.5e5 0.3 %.17g %.17g %.17g %.17g fraction 0.6", mus,
                            mu2, I0, d),
                  strprintf("variable u atom %.17g*(1-(1-y/%.17g)^1.5)\nvelocity all set v_u 0 0\n",
                            start, depth)) +
            strprintf("fix end all halt 10 v_t > %.17g error continue\nrun 1000000\n", time));
  Incline result{0.0, 0.0, 0.0};
  double n = 0.0, top = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double y = run.x()[i][1], u = run.v()[i][0];
    result.rms += (u - exact(y)) * (u - exact(y)) / run.n() / (us * us);
    grow(result.fastest, u);
    if (y > 0.9 * depth) {    // there the profile is flat
      top += u / exact(y);
      n++;
    }
  }
  result.rms = std::sqrt(result.rms);
  result.surface = top / n;
  return result;
}

TEST(GranularFlow, BagnoldProfile)
{
  LONG_CASE();
  const Incline at24 = flow(24.0, 20, 0.22, 1.2);
  EXPECT_NEAR(measured("G2 surface velocity at 24 degrees", at24.surface), 1.0, 0.03);
  EXPECT_LT(measured("G2 rms of the profile", at24.rms), 0.03);
}

TEST(GranularFlow, StopsBelowTheStaticAngle)
{
  EXPECT_LT(measured("G2 velocity at 20 degrees", flow(20.0, 10, 0.05, 0.6).fastest), 1e-4);
}

// G3: infinite slope without cohesion. Flow keeps the volume: strength on a plane of sliding tan =
// sin(phi) (E.H. Davis, in: Soil Mechanics, Butterworths, 1968, p. 341).
TEST(InfiniteSlope, SlidesWhenTooSteep)
{
  const double depth = 0.5, h = 0.05, phi = 30.0 * DEG;
  for (const char *law : {"drucker/prager 1e7 0.3 30 plane", "mohr/coulomb 1e7 0.3 30 0"})
    for (const double angle : {26.0 * DEG, 32.0 * DEG}) {
      SCOPED_TRACE(law);
      Scene run(layer(depth, h, 4, angle, 0.3, std::string("density 1600 ") + law, "") +
                "fix end all halt 10 v_t > 0.8 error continue\nrun 100000\n");
      double ratio = 0.0, speed = 0.0, n = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const auto s = run.cauchy(i);
        ratio += std::abs(s[3] / s[1]);
        grow(speed, run.v()[i][0]);
        n++;
      }
      ratio /= n;
      if (std::tan(angle) > std::sin(phi)) {
        EXPECT_NEAR(measured("G3 friction of a sliding slope", ratio), std::sin(phi), 5e-4);
        EXPECT_GT(measured("G3 velocity of a sliding slope", speed), 0.4);
      } else {
        EXPECT_NEAR(measured("G3 friction of a slope at rest", ratio), std::tan(angle), 5e-3);
        EXPECT_LT(measured("G3 velocity of a slope at rest", speed), 5e-4);
      }
    }
}

// The acceleration of such a layer. On a floor with friction mu: g (sin - mu cos), whatever the
// transfer. On a rough floor the layer slides in the material: mu = sin(phi). The strength is
// reached at all depths at once, so that only the mean velocity is determined, by the force at the
// floor, and it is a small difference: 1 % of the force is 4 % of the acceleration. Shape functions
// cannot follow the jump of velocity at the floor: up to half a cell stays behind with it, h/(2
// depth) of the mean. What transfers take at the jump comes on top: apic is 20 % too slow with 10
// cells in the depth and 12 % with 20 (and more with smaller time steps), which is why it is not
// here: its error, of first order in h as well, is that of a viscosity.
double slide(double h, double angle, const std::string &options, const std::string &floor)
{
  std::string scene =
      layer(0.5, h, 4, angle, 0.3, "density 1600 drucker/prager 1e7 0.3 30 plane", "");
  scene = replaced(scene, "ylo stick", "ylo " + floor);
  scene = replaced(scene, strprintf("fix grid all mpm %.17g", h),
                   strprintf("fix grid all mpm %.17g transfer %s", h, options.c_str()));
  Scene run(scene +
            "variable v equal vcm(all,x)\n"
            "fix end all halt 1 v_t > 0.4 error continue\nrun 100000\nunfix end\n");
  const double v = run.variable("v"), t = run.time();
  run.commands("fix end all halt 1 v_t > 0.8 error continue\nrun 100000\n");
  return (run.variable("v") - v) / (run.time() - t);
}

TEST(InfiniteSlope, Acceleration)
{
  const double angle = 32.0 * DEG, phi = 30.0 * DEG, depth = 0.5;
  for (const char *options : {"apic", "aflip 1.0", "flip 1.0"})
    for (const char *wall : {"slip", "separate"}) {
      const double exact = g * (std::sin(angle) - 0.3 * std::cos(angle));
      const double a = slide(0.05, angle, options, strprintf("%s friction 0.3", wall));
      EXPECT_NEAR(measured(strprintf("G3 %s, %s with friction: acceleration/exact", options, wall),
                           a / exact),
                  1.0, 1e-4);
    }
  const double exact = g * (std::sin(angle) - std::sin(phi) * std::cos(angle));
  for (const char *options : {"aflip 1.0", "flip 1.0"})
    for (const double h : {0.05, 0.025}) {
      const double a = slide(h, angle, options, "stick");
      const double ratio = measured(
          strprintf("G3 %s, rough floor, h %g: acceleration/exact", options, h), a / exact);
      EXPECT_GT(ratio, 1.0 - 0.5 * h / depth - 0.01);
      EXPECT_LT(ratio, 1.0);
    }
}

// G1: run-out of a planar column, (L - L0)/L0 = 1.2 a for a < 2.3 (G. Lube et al., Phys. Rev. E 72
// (2005) 041301). Friction coefficient 0.577: sin(phi) where flow keeps the volume, see above.
TEST(ColumnCollapse, RunOut)
{
  LONG_CASE();
  const double L0 = 0.1, h = 0.00625;
  struct {
    const char *law;
    double a;
  } cases[] = {{"drucker/prager 1e6 0.3 35.26 plane", 1.0},
               {"drucker/prager 1e6 0.3 35.26 plane", 2.0},
               {"mui 1e6 0.3 0.577 0.8 0.3 1e-3", 2.0}};
  for (const auto &k : cases) {
    Scene run(plane("si", "f f", "0 0.5 0 0.25 -0.1 0.1", 1, 0.5 * h) +
              strprintf("fix grid all mpm %.17g\nregion column block 0 %.17g 0 %.17g INF INF\n"
                        "create_points 1 region column ppc 2\n"
                        "fix sand all mpm/material density 1600 %s\n"
                        "fix wall all mpm/boundary xlo slip\nfix floor all mpm/boundary ylo stick\n"
                        "fix g all gravity 9.81 vector 0 -1 0\nfix step all mpm/dt 0.4\n"
                        "variable t equal time\nfix end all halt 10 v_t > %.17g error continue\n"
                        "run 1000000\n",
                        h, L0, k.a * L0, k.law, 3.0 * std::sqrt(2.0 * k.a * L0 / g)));
    double front = 0.0, fastest = 0.0, volume = 0.0;
    for (int i = 0; i < run.n(); i++) {
      front = std::max(front, run.x()[i][0] + 0.25 * h);
      grow(fastest, run.v()[i][0]);
      volume += run.points().jacobian(i) * run.lmp->atom->vfrac[i];
    }
    EXPECT_NEAR(measured("G1 run-out over aspect ratio", (front - L0) / (k.a * L0)), 1.2, 0.24);
    EXPECT_LT(measured("G1 speed at the end", fastest), 0.05);
    EXPECT_NEAR(measured("G1 volume", volume / (k.a * L0 * L0)), 1.0, 0.03);
  }
}

// Transfers with an affine matrix create no energy at rough walls. The matrix of a single grain
// near the floor and its velocity are together projected on the fields that vanish there, v + C d =
// 0 at the depth d: with the kinetic energy v^2 + D C^2 that leaves v s/(1 + s), s = d^2/D.
TEST(RoughFloor, StopsAGrain)
{
  for (const char *shape : {"quadratic", "cubic"})
    for (const char *transfer : {"apic", "aflip 1.0", "aflip 0.9"})
      for (const double d : {0.1, 0.3}) {
        SCOPED_TRACE(strprintf("%s %s, %g cells", shape, transfer, d));
        Scene run(plane("lj", "p f", "0 20 0 8 -0.5 0.5", 1, 0.3) +
                  strprintf("fix grid all mpm 1.0 shape %s transfer %s\n"
                            "region one block 1 1.5 0 0.5 INF INF\n"
                            "create_points 1 region one ppc 2\ndisplace_atoms all move 0 %.17g 0\n"
                            "fix sand all mpm/material density 1 drucker/prager 1e3 0.3 25 plane\n"
                            "fix floor all mpm/boundary ylo stick\nvelocity all set 1 0 0\n"
                            "compute e all mpm/energy\nthermo_style custom step c_e\n"
                            "fix step all mpm/dt 0.4\nrun 3\n",
                            shape, transfer, d - 0.25));
        const double s = d * d * (strcmp(shape, "cubic") == 0 ? 3.0 : 4.0);
        EXPECT_NEAR(run.v()[0][0] * (1.0 + s) / s, 1.0, 1e-7);
        run.commands("run 100\n");
        EXPECT_LT(run.v()[0][0] * (1.0 + s) / s, 1.001);
        const double *e = run.compute_vector();
        EXPECT_LT(e[8] + e[9], 0.01 * 0.5 * run.lmp->atom->rmass[0]);
      }
}

TEST(RoughFloor, ColumnGainsNoEnergy)
{
  const double L = 0.3, h = 0.02;
  for (const char *shape : {"quadratic", "cubic"}) {
    Scene run(plane("si", "f f", "0 4 0 1 -0.1 0.1", 1, 0.5 * h) +
              strprintf("fix grid all mpm %.17g shape %s transfer aflip 1.0\n"
                        "region column block 0 %.17g 0 %.17g INF INF\n"
                        "create_points 1 region column ppc 2\n"
                        "fix sand all mpm/material density 1600 drucker/prager 1e6 0.3 25 plane\n"
                        "fix wall all mpm/boundary xlo slip\nfix floor all mpm/boundary ylo stick\n"
                        "fix g all gravity 9.81 vector 0 -1 0\nfix step all mpm/dt 0.4\n"
                        "compute e all mpm/energy\nthermo_style custom step c_e[*]\n"
                        "variable t equal time\nfix end all halt 10 v_t > 0.95 error continue\n"
                        "run 1000000\n",
                        h, shape, L, L));
    const double *e = run.compute_vector();
    EXPECT_LT(measured("energy created in sand over work of gravity", (e[8] + e[9]) / e[5]), 0.0);
    double fastest = 0.0;
    for (int i = 0; i < run.n(); i++) grow(fastest, run.v()[i][0]);
    EXPECT_LT(measured("speed of sand at the end", fastest), 1.0);
  }
}

/** Displacement u, velocity v, strains q of Maxwell elements of the mode exp(i k x): density v' =
 *  -k^2 (M u + eta v + sum 4/3 G q), q' = v - q/tau, by the classical Runge-Kutta method. */
struct Mode {
  double M, eta, G[2], tau[2], k;
  double y[4] = {0.0, 1.0, 0.0, 0.0};

  void slope(const double *y, double *d) const
  {
    d[0] = y[1];
    d[1] = -k * k * (M * y[0] + eta * y[1] + 4.0 / 3.0 * (G[0] * y[2] + G[1] * y[3]));
    for (int e = 0; e < 2; e++) d[2 + e] = y[1] - y[2 + e] / tau[e];
  }
  void advance(double dt)
  {
    double a[4], b[4], c[4], d[4], z[4];
    slope(y, a);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * dt * a[i];
    slope(z, b);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * dt * b[i];
    slope(z, c);
    for (int i = 0; i < 4; i++) z[i] = y[i] + dt * c[i];
    slope(z, d);
    for (int i = 0; i < 4; i++) y[i] += dt / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  }
};

struct Case {
  const char *name, *law;    // density 1, length 1; M = 100 without damping
  double eta, G[2], tau[2];
  friend void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }
};

static const Case cases[] = {
    {"elastic", "hencky 100 0", 0.0, {0.0, 0.0}, {1.0, 1.0}},
    {"KelvinVoigt", "linear 100 0 viscosity newtonian 0.15 bulk 0.1", 0.3, {0.0, 0.0}, {1.0, 1.0}},
    {"newtonian", "neohookean 100 0 viscosity newtonian 0.15", 0.2, {0.0, 0.0}, {1.0, 1.0}},
    {"Maxwell",
     "hencky 100 0 viscosity maxwell term 30 0.02 term 15 0.003",
     0.0,
     {30, 15},
     {0.02, 0.003}},
    {"MaxwellLinear",
     "linear 100 0 viscosity maxwell term 30 0.02 term 15 0.003",
     0.0,
     {30, 15},
     {0.02, 0.003}},
};

PARAMETER_TEST(StandingWave, AmplitudeAndEnergy, Case, ValuesIn(cases))
{
  const Case &c = GetParam();
  const double h = 1.0 / 96.0, k = 2.0 * PI, v0 = 1.0e-3;
  Scene run(plane("si", "p p", strprintf("0 1 0 %.17g", h), 2, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer flip 1.0 scheme musl\n"
                      "create_points 1 box ppc 2\nfix solid all mpm/material density 1 %s\n",
                      h, c.law));
  run.set_reference();
  const int n = run.n();
  for (int i = 0; i < n; i++) run.v()[i][0] = v0 * std::sin(k * run.x()[i][0]);
  const double energy0 = run.sums().kinetic;

  Mode mode{100.0, c.eta, {c.G[0], c.G[1]}, {c.tau[0], c.tau[1]}, k};
  double worst = 0.0;
  const double dt = 1.0e-4;
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += 2.0 / n * run.v()[i][0] / v0 * std::sin(k * run.x()[i][0]);
    grow(worst, sum - mode.y[1]);
    mode.advance(dt);
  });
  run.commands(strprintf("timestep %.17g\nrun 2000\n", dt));
  measured(std::string(c.name) + " amplitude left", std::hypot(mode.y[1], 10.0 * k * mode.y[0]));
  EXPECT_LT(measured(std::string(c.name) + " error of the amplitude", worst), 0.02);

  const auto *material = run.material("solid");
  const double left = run.sums().kinetic + run.stored_energy(),
               viscous = material->work[MPM_NS::VISCOUS];
  measured(std::string(c.name) + " viscous work", viscous / energy0);
  EXPECT_NEAR((left + viscous) / energy0, 1.0, 0.01);
}

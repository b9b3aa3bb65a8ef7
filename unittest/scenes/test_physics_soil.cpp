// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Soil in motion: slopes, flow of grains on an incline, collapse of a column.

#include "mpm_lammps.h"

using namespace MPM_TEST;

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
    result.fastest = std::max(result.fastest, std::abs(u));
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
        speed = std::max(speed, std::abs(run.v()[i][0]));
        n++;
      }
      ratio /= n;
      if (std::tan(angle) > std::sin(phi)) {
        EXPECT_NEAR(measured("G3 friction of a sliding slope", ratio), std::sin(phi), 2e-3);
        EXPECT_GT(measured("G3 velocity of a sliding slope", speed), 0.4);
      } else {
        EXPECT_NEAR(measured("G3 friction of a slope at rest", ratio), std::tan(angle), 5e-3);
        EXPECT_LT(measured("G3 velocity of a slope at rest", speed), 2e-3);
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
                  1.0, 0.01);
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
      fastest = std::max(fastest, std::abs(run.v()[i][0]));
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
        EXPECT_NEAR(run.v()[0][0] * (1.0 + s) / s, 1.0, 1e-3);
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
    for (int i = 0; i < run.n(); i++) fastest = std::max(fastest, std::abs(run.v()[i][0]));
    EXPECT_LT(measured("speed of sand at the end", fastest), 1.0);
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Volumetric locking and its cures: keyword locking of fix mpm.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// Cook's membrane: corners (0,0), (48,44), (48,60), (0,44), clamped on the left, a shear force
// F = 100 on the right edge; neo-Hookean, plane strain. Displacements of the middle of the right
// edge by finite elements of order 2 with pressures of order 1, converged: E = 240.565, nu = .4999:
// 6.953; E = 70, nu = 1/3: 19.337.
struct Cook {
  double u;         // displacement of (48,52)
  double ripple;    // rms of pressure minus its mean over the points of a cell, by rms of pressure
};

static Cook cook(const char *options, double h, double nu, double cfl = 0.75)
{
  const double E = nu > 0.4 ? 240.565 : 70.0;
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
  const double dt = cfl * h / sqrt(lambda + 2.0 * mu), F = 100.0;
  const double u_expected = nu > 0.4 ? 7.0 : 19.0;
  const double omega = sqrt(F / u_expected / 400.0), ramp = 4.0 / omega, end = 12.0 / omega;
  Scene run(plane("si", "f f", "0 60 0 90", 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g %s dtcheck no\nregion lower plane 0 0 0 -44 48 0\n"
                      "region upper plane 0 44 0 16 -48 0\nregion span block 0 48 0 60 INF INF\n"
                      "region plate intersect 3 span lower upper\n"
                      "create_points 1 region plate ppc 2\n"
                      "fix m all mpm/material density 1 neohookean %.17g %.17g\n"
                      "fix clamp all mpm/boundary xlo stick\n",
                      h, options, E, nu));
  run.set_reference();
  double edge = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.reference(i)[0] > 48.0 - 0.5 * h) edge += run.mass()[i];
  run.each_step([&](double **force) {
    const double f = F * std::min(1.0, run.time() / ramp) / edge;
    for (int i = 0; i < run.n(); i++) {
      const double m = run.mass()[i];
      for (int d = 0; d < 2; d++) force[i][d] = -1.6 * omega * m * run.v()[i][d];
      if (run.reference(i)[0] > 48.0 - 0.5 * h) force[i][1] += m * f;
    }
  });
  run.commands(strprintf("timestep %.17g\nrun %ld\n", dt, std::lround(end / dt)));

  // the last two columns of points, next to y = 52, extrapolated
  double u[2] = {0.0, 0.0}, n[2] = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i);
    if (std::abs(X[1] - 52.0) > 0.5 * h || X[0] < 48.0 - h) continue;
    const int k = X[0] < 48.0 - 0.5 * h;
    u[k] += run.x()[i][1] - X[1];
    n[k]++;
  }
  Cook out;
  out.u = 1.5 * u[0] / n[0] - 0.5 * u[1] / n[1];

  // pressures in the cells that the points began in, away from the singular corners
  std::vector<std::array<double, 3>> cells(100 * 100, {0.0, 0.0, 0.0});
  double square = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i);
    if (X[0] < 8.0 || X[0] > 40.0) continue;
    const auto s = run.cauchy(i);
    const double p = -(s[0] + s[1] + s[2]) / 3.0;
    auto &cell = cells[100 * (int) (X[0] / h) + (int) (X[1] / h)];
    cell[0] += 1.0;
    cell[1] += p;
    cell[2] += p * p;
    square += p * p;
  }
  double scatter = 0.0;
  for (const auto &cell : cells)
    if (cell[0] > 1.0) scatter += cell[2] - cell[1] * cell[1] / cell[0];
  out.ripple = sqrt(scatter / square);
  const std::string name = strprintf("Cook, nu = %g, h = %g, %s: ", nu, h, options);
  measured(name + "displacement/reference", out.u / (nu > 0.4 ? 6.953 : 19.337));
  measured(name + "pressure ripple", out.ripple);
  return out;
}

TEST(CookMembrane, LocksWithoutCure)
{
  LONG_CASE();
  const Cook without = cook("", 2.0, 0.4999), with = cook("locking fbar", 2.0, 0.4999);
  EXPECT_LT(without.u / 6.953, 0.91);
  EXPECT_NEAR(with.u / 6.953, 1.0, 0.04);
  EXPECT_LT(with.ripple, 0.6 * without.ripple);
}

// as asked: 3 % at h = 1
TEST(CookMembrane, FineIsNearTheReference)
{
  LONG_CASE();
  EXPECT_NEAR(cook("locking fbar", 1.0, 0.4999).u / 6.953, 1.0, 0.03);
}

// both cures have the same stiffness, as long as the bulk modulus is uniform
TEST(CookMembrane, PressureAgrees)
{
  const Cook fbar = cook("locking fbar", 4.0, 0.4999),
             pressure = cook("locking pressure", 4.0, 0.4999);
  EXPECT_NEAR(pressure.u / fbar.u, 1.0, 2e-4);
  EXPECT_NEAR(fbar.u / 6.953, 1.0, 0.08);
}

TEST(CookMembrane, CompressibleStays)
{
  const double none = cook("", 2.0, 1.0 / 3.0).u;
  EXPECT_NEAR(none / 19.337, 1.0, 0.02);
  EXPECT_NEAR(cook("locking pressure", 2.0, 1.0 / 3.0).u / 19.337, 1.0, 0.03);

  // averages make the panel a little softer, in the updated frame by as much as in the total one,
  // where they are always over the same points. When the averaged volumes parted from the motion
  // while points vibrated over the lattice, it crept: 2.9 % softer
  const double total = cook("frame total", 2.0, 1.0 / 3.0).u;
  const double softer = cook("frame total locking fbar", 2.0, 1.0 / 3.0).u / total;
  EXPECT_NEAR(cook("locking fbar", 2.0, 1.0 / 3.0).u / none, softer, 0.01);
}

TEST(CookMembrane, CompressibleDoesNotCreepInTheTotalFrame)
{
  const double none = cook("frame total", 4.0, 1.0 / 3.0).u;
  const double fbar = cook("frame total locking fbar", 4.0, 1.0 / 3.0).u;
  const double small = cook("frame total locking fbar", 4.0, 1.0 / 3.0, 0.3).u;
  EXPECT_NEAR(fbar / none, 1.011, 0.002);
  EXPECT_NEAR(small / fbar, 1.0, 0.004);
}

// Limit load of a rough rigid punch of half-width 1 on a half-space that flows at constant volume
// (von Mises, perfectly plastic, plane strain): (2 + pi) sigma_y/sqrt(3) by L. Prandtl. On the
// lattice, the edge of the punch is half a cell beyond its last node.
static double punch(const std::string &options)
{
  const double h = 0.1, dt = 0.4 * h / 37.0;
  Scene run(plane("si", "f f", "0 5 -3 1", 1, 0.04) +
            body("block 0 5 -3 0 INF INF", "density 1 eos linear 833.33 strength j2 384.6 1.0",
                 strprintf("%g %s", h, options.c_str())) +
            strprintf("fix sides all mpm/boundary xlo xhi slip\n"
                      "fix floor all mpm/boundary ylo stick\n"
                      "region punch block -1 1.001 -0.001 1 INF INF\n"
                      "fix punch all mpm/boundary region punch stick velocity 0 -0.04 0\n"
                      "fix slow all viscous %g\ntimestep %.17g\nrun %ld\n",
                      0.75 * h * h, dt, std::lround(0.9 / dt)));
  const double exact = (2.0 + 3.14159265358979) / sqrt(3.0) * (1.0 + 0.5 * h);
  return measured("punch, " + options + ": force/limit load",
                  std::abs(run.fix_vector("punch", 3)[1]) / exact);
}

TEST(Punch, LimitLoad)
{
  LONG_CASE();
  for (const std::string shape :
       {"shape quadratic ", "shape linear transfer flip 0.99 scheme musl ",
        "shape linear transfer apic scheme musl light 0.5 "}) {
    const double without = punch(shape + "locking none");
    for (const char *cure : {"locking fbar", "locking pressure", "locking both"}) {
      const double with = punch(shape + cure);
      EXPECT_GT(with, 0.97) << shape << cure;    // asked: +8/-3 %
      EXPECT_LT(with, 1.08) << shape << cure;
      EXPECT_LT(with, without - 0.03) << shape << cure;
    }
  }
}

// A body whose velocity is linear in position deforms uniformly in a step, averaged or not.
PARAMETER_TEST(Uniform, StretchIsExact, const char *,
               Values("locking fbar", "locking pressure", "locking both",
                      "locking fbar shape cubic", "locking fbar scheme musl",
                      "locking fbar scheme usf", "locking fbar frame total"))
{
  for (int dim : {2, 3}) {
    Scene run(box(dim, "lj", "f f p", "-5 5 -5 5 -5 5", 2) +
              strprintf("fix grid all mpm 0.5 %s\nregion body block -1.1 1.2 -1.3 1 %s\n"
                        "create_points 1 region body ppc 2\n"
                        "region half block 0.1 INF INF INF INF INF\nset region half type 2\n"
                        "group one type 1\ngroup two type 2\n"
                        "fix m1 one mpm/material density 1 neohookean 1e-14 0.3\n"
                        "fix m2 two mpm/material density 1 linear 1e-14 0.3\ntimestep 0.2\n",
                        GetParam(), dim == 2 ? "INF INF" : "-1 1"));
    const double G[3][3] = {{0.3, 0.1, -0.2}, {0.4, -0.2, 0.1}, {0.1, -0.3, 0.5}};
    for (int step = 0; step < 5; step++) {
      run.set_velocity([&](const double *x, double *v) {
        for (int i = 0; i < dim; i++) {
          v[i] = 0.0;
          for (int j = 0; j < dim; j++) v[i] += G[i][j] * x[j];
        }
      });
      run.commands("run 1\n");
    }
    double worst = 0.0, change = 0.0;
    for (int i = 0; i < run.n(); i++)
      for (int c = 0; c < 9; c++)
        worst = std::max(worst, std::abs(run.points().F[i][c] - run.points().F[0][c]));
    for (int i = 0; i < run.n(); i++)
      change = std::max(change, std::abs(run.points().jacobian(i) - 1.0));
    EXPECT_GT(change, 0.05);
    EXPECT_LT(measured(strprintf("%dd: spread of F", dim), worst), 1.0e-12);
  }
}

// Averages change volumes of points, but not their sum. F-bar in the updated frame: after some
// steps it is that of the motion, which is the same without averages as the stress is next to
// nothing. Averages of the changes in a step: the sum follows that of the motion one step later.
struct Volumes {
  double mean, largest;    // of J
};

static Volumes after_five_steps(int dim, const std::string &options, bool last_averaged)
{
  Scene run(box(dim, "si", "f f p", "-5 5 -5 5 -5 5") +
            body(strprintf("block -1 1 -1 1 %s", dim == 2 ? "INF INF" : "-1 1"),
                 "density 1 neohookean 1e-10 0.3", "0.5 " + options) +
            "timestep 0.05\n");
  run.set_velocity([&](const double *x, double *v) {
    v[0] = sin(x[0] + 2.0 * x[1]);
    v[1] = sin(x[1] - x[0]) * cos(x[1]);
    v[2] = dim == 3 ? cos(x[0]) * sin(x[2] + x[1]) : 0.0;
  });
  run.commands("run 4\n");
  if (!last_averaged) run.switch_locking_off();
  run.commands("run 1\n");
  Volumes volumes = {0.0, 0.0};
  for (int i = 0; i < run.n(); i++) {
    const double J = run.points().jacobian(i);
    volumes.mean += J / run.n();
    volumes.largest = std::max(volumes.largest, J);
  }
  return volumes;
}

static void expect_same_volume(const Volumes &averaged, const Volumes &own, double tolerance)
{
  EXPECT_GT(std::abs(averaged.mean - 1.0), 0.01);
  EXPECT_GT(std::abs(averaged.largest - own.largest), 0.001);
  EXPECT_NEAR(averaged.mean, own.mean, tolerance);
}

PARAMETER_TEST(Volume, SumIsThatOfTheMotion, const char *,
               Values("", "transfer flip 1.0 scheme musl", "scheme usf", "shape gimp"))
{
  const std::string options = GetParam();
  for (int dim : {2, 3})
    expect_same_volume(after_five_steps(dim, options + " locking fbar", true),
                       after_five_steps(dim, options, true), 1.0e-10);
}

PARAMETER_TEST(VolumeOfStep, SumFollowsTheMotion, const char *,
               Values("locking both", "locking fbar frame total"))
{
  const std::string options = GetParam();
  for (int dim : {2, 3})
    expect_same_volume(after_five_steps(dim, options, true), after_five_steps(dim, options, false),
                       1.0e-13);
}

// Half of a bar of metal with linear hardening, L long and W wide, or a quarter of one with a
// square section, which a grip pulls: plastic flow at constant volume, no neck, as the metal
// hardens faster than the section shrinks. With c = 1, in plane strain 2/sqrt(3), the stress along
// the bar is s = c (Y + H c e), e the plastic part of the logarithmic strain, c e the equivalent
// plastic strain. Where the bar is narrow at the grip, within less than W, it is strained less, and
// so it is strained by at least what is uniform along L, at most what is uniform along L - W. In
// the second half of the way, when the waves of the start are over, the force must stay within 2 %
// of this in every step, while the grip crosses 3 to 5 planes of nodes.
struct Tension {
  double force, strain;    // by that of the uniform bar; largest plastic strain
};

static Tension uniform_tension(int dim, double pulled, double L, double W)
{
  const double K = 170.0e9, G = 80.0e9, Y = 300.0e6, H = 1.0e9;
  const double E = 9.0 * K * G / (3.0 * K + G), nu = 0.5 * E / G - 1.0;
  const double c = dim == 3 ? 1.0 : 2.0 / sqrt(3.0), stiff = dim == 3 ? E : E / (1.0 - nu * nu);
  const double strain = log(1.0 + pulled / L);
  const double stress = c * (Y + H * c * strain) / (1.0 + c * c * H / stiff);
  return {stress * exp(-strain) * (dim == 3 ? W * W : W), c * (strain - stress / stiff)};
}

static Tension tension(int dim, double h, const std::string &options)
{
  const double L = 5.0e-3, W = dim == 3 ? 4.0e-4 : 1.0e-3, pulled = 1.2e-3;
  const std::string wide = strprintf("0 %g", W + 2.0 * h);
  Scene run(
      box(dim, "si", dim == 3 ? "f f f" : "f f p", "0 0.0085 " + wide + " " + wide, 1, 0.5 * h) +
      body(strprintf("block 0 0.007 0 %g %s", W,
                     dim == 3 ? strprintf("0 %g", W).c_str() : "INF INF"),
           "density 7850 eos linear 170e9 strength j2 80e9 300e6 hardening linear 1e9",
           strprintf("%g %s", h, options.c_str())) +
      strprintf("variable s equal 12*(time-1e-5*(1-exp(-time/1e-5)))\n"
                "region grip block %g INF INF INF INF INF move v_s NULL NULL\n"
                "fix grip all mpm/boundary region grip stick\n"
                "fix symmetry all mpm/boundary xlo ylo %s slip\nfix step all mpm/dt 0.5\n"
                "fix end all halt 1 v_s > %g error continue\n"
                "compute p all mpm/atom eplastic\n",
                L, dim == 3 ? "zlo" : "", pulled));
  run.set_reference();
  Tension out = {0.0, 0.0};
  double low = 1.0, high = 1.0;    // force by the bounds
  run.each_step([&](double **) {
    const double way = 12.0 * (run.time() - 1.0e-5 * (1.0 - exp(-run.time() / 1.0e-5)));
    out.force = -run.fix_vector("grip", 1)[0];
    if (way < 0.5 * pulled) return;
    low = std::min(low, out.force / uniform_tension(dim, way, L, W).force);
    high = std::max(high, out.force / uniform_tension(dim, way, L - W, W).force);
  });
  run.commands("run 100000\n");
  auto *eplastic = run.lmp->modify->get_compute_by_id("p");
  eplastic->compute_peratom();
  for (int i = 0; i < run.n(); i++)
    if (run.reference(i)[0] < 0.8 * L) out.strain = std::max(out.strain, eplastic->vector_atom[i]);
  const std::string name = strprintf("tension, %dd, h = %g, %s: ", dim, h, options.c_str());
  const Tension least = uniform_tension(dim, pulled, L, W),
                most = uniform_tension(dim, pulled, L - W, W);
  measured(name + "force/uniform", out.force / least.force);
  measured(name + "strain/uniform", out.strain / least.strain);
  EXPECT_GT(measured(name + "smallest force by lower bound", low), 0.98);
  EXPECT_LT(measured(name + "largest force by upper bound", high), 1.02);
  EXPECT_GT(out.strain, least.strain);
  EXPECT_LT(out.strain, 1.05 * most.strain);
  return out;
}

PARAMETER_TEST(Tension2d, NoFalseNeck, const char *,
               Values("locking fbar", "locking fbar shape cubic", "locking fbar transfer tpic",
                      "locking fbar transfer aflip 0.98",
                      "locking fbar transfer flip 0.99 scheme musl",
                      "locking fbar shape gimp transfer flip 0.99", "locking both",
                      "locking both shape gimp transfer flip 0.99", "locking pressure",
                      "locking none", "locking none shape gimp transfer flip 0.99"))
{
  tension(2, 2.0e-4, GetParam());
}

TEST(Tension, ResolutionsAgree)
{
  LONG_CASE();
  const Tension coarse = tension(2, 2.5e-4, "locking fbar"),
                fine = tension(2, 1.25e-4, "locking fbar");
  EXPECT_NEAR(coarse.force / fine.force, 1.0, 0.015);
}

TEST(Tension, NoFalseNeckIn3d)
{
  LONG_CASE();
  tension(3, 2.0e-4, "locking fbar");
}

TEST(Tension, ForceIsSmoothWithoutCure)
{
  LONG_CASE();
  tension(2, 1.25e-4, "locking none");
}

// A pressure that is the same everywhere is its own average, however much points are compressed.
TEST(AveragedPressure, KeepsAUniformOne)
{
  std::vector<Scene::State> states[2];
  for (const int averaged : {0, 1}) {
    Scene run(plane("si", "f f", "-5 5 -5 5") +
              body("block -1 1 -1 1 INF INF", "density 1 linear 1.0 0.3",
                   averaged ? "0.5 locking pressure" : "0.5") +
              "timestep 0.01\n");
    for (int i = 0; i < run.n(); i++) {
      const double J = 1.0 + 0.3 * sin(3.0 * run.x()[i][0] + 5.0 * run.x()[i][1]);
      run.points().F[i][4] = J;
      for (int c = 0; c < 3; c++) run.points().tau[i][c] = -2.0 * J;
    }
    run.commands("run 1\n");
    states[averaged] = run.gather();
  }
  double speed = 0.0;
  for (std::size_t i = 0; i < states[0].size(); i++)
    for (int d = 0; d < 2; d++) {
      speed = std::max(speed, std::abs(states[0][i].v[d]));
      EXPECT_NEAR(states[1][i].v[d], states[0][i].v[d], 1.0e-14);
    }
  EXPECT_GT(speed, 0.01);
}

// Free oscillation of a bar in uniaxial strain, fixed at one end: v = v0 sin(k X) cos(w t) with
// w = k sqrt((lambda + 2 mu)/rho), k = pi/2. There is nothing to cure, so averages only lower the
// frequency, by (kh)^2/8 of the part of the bulk modulus in lambda + 2 mu.
PARAMETER_TEST(Bar, ConfinedOscillation, const char *,
               Values("locking none", "locking fbar", "locking pressure", "locking both"))
{
  const double h = 0.05, E = 1.0, nu = 0.4999, k = 0.5 * 3.14159265358979, v0 = 1.0e-2;
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
  const double speed = sqrt(lambda + 2.0 * mu), omega = k * speed;
  const int steps = 4000, periods = 8;
  Scene run(plane("si", "f f", "0 0.2 0 1.5", 1, 0.5 * h) +
            strprintf("fix grid all mpm %.17g transfer flip 1.0 scheme musl %s\n"
                      "region bar block INF INF 0 1 INF INF\ncreate_points 1 region bar ppc 2\n"
                      "fix m all mpm/material density 1 neohookean %.17g %.17g\n"
                      "fix sides all mpm/boundary xlo xhi ylo slip\n"
                      "compute e all mpm/energy\ntimestep %.17g\n",
                      h, GetParam(), E, nu, periods * 4.0 * k / omega / steps));
  run.set_reference();
  run.set_velocity([&](const double *x, double *v) {
    v[1] = v0 * sin(k * x[1]);
  });
  run.commands(strprintf("run 0\n"));
  const double start = run.evaluate("c_e");
  run.commands(strprintf("run %d\n", steps));
  double u = 0.0, norm = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i), mode = sin(k * X[1]);
    u += mode * (run.x()[i][1] - X[1]);
    norm += mode * mode;
  }
  const std::string name = std::string("bar, ") + GetParam() + ": ";
  const double late = asin(-u / norm * omega / v0) / (periods * 4.0 * k);
  EXPECT_LT(std::abs(measured(name + "period, relative error", late)), 0.004);
  EXPECT_LT(std::abs(measured(name + "residual of the ledger", run.evaluate("c_e[11]") / start)),
            1.0e-12);

  // laws see what points do on their own if only the pressure in the force is averaged
  const double integration = measured(name + "integration", run.evaluate("c_e[10]") / start);
  if (std::string(GetParam()) == "locking pressure")
    EXPECT_LT(std::abs(integration), 0.15);
  else {
    EXPECT_LT(std::abs(integration), 0.01);
    EXPECT_NEAR(measured(name + "energy after 8 periods", run.evaluate("c_e") / start), 1.0, 0.01);
  }
}

// Free oscillation of a block in plane strain, nu = 0.4999. With APIC, the energy that is left
// after some time tells whether the block moves like one of nu = 0.49, which does not lock yet.
struct Oscillation {
  double energy, spread, residual;    // by the energy at the start; of J, from smallest to largest
};

static Oscillation block(const std::string &options, double nu)
{
  Scene run(plane("si", "f f", "-1 1 -1 1", 1, 0.05) +
            body("block -0.5 0.5 -0.5 0.5 INF INF", strprintf("density 1 neohookean 1 %g", nu),
                 "0.1 " + options) +
            "compute e all mpm/energy\ntimestep 0.001\n");
  run.set_velocity([&](const double *x, double *v) {
    v[0] = 0.1 * x[0];
    v[1] = -0.1 * x[1];
  });
  run.commands("run 0\n");
  const double start = run.evaluate("c_e");
  run.commands("run 10000\n");
  double least = 1.0, most = 1.0;
  for (int i = 0; i < run.n(); i++) {
    least = std::min(least, run.points().jacobian(i));
    most = std::max(most, run.points().jacobian(i));
  }
  const std::string name = strprintf("block, nu = %g, %s: ", nu, options.c_str());
  return {measured(name + "energy left", run.evaluate("c_e") / start),
          measured(name + "spread of J", most - least),
          measured(name + "residual of the ledger", run.evaluate("c_e[11]") / start)};
}

TEST(Block, MovesAsWithoutLocking)
{
  const double reference = block("locking none", 0.49).energy;
  const Oscillation without = block("locking none", 0.4999);
  EXPECT_GT(without.energy / reference, 2.0);
  for (const char *cure : first_of(1, {"locking fbar", "locking both"})) {
    const Oscillation with = block(cure, 0.4999);
    EXPECT_NEAR(with.energy / reference, 1.0, 0.25);
    EXPECT_LT(with.spread, 0.3 * without.spread);
    EXPECT_LT(std::abs(with.residual), 1.0e-12);
  }
}

// F-bar with averaged pressure does as much work as the law says, also when points move over the
// lattice. With F-bar alone this is so while they stay in their cells
TEST(Block, EnergyWithoutDamping)
{
  const std::string flip = "transfer flip 1.0 scheme musl locking ";
  EXPECT_NEAR(block(flip + "both", 0.4999).energy, 1.0, 4e-4);
  EXPECT_NEAR(block(flip + "fbar", 0.4999).energy, 1.0, 0.05);
}

// Points of solids that keep their volume lock without a cure, which is said once: not of ones that
// give way, of fluids, nor of materials that have no points
TEST(Told, Locking)
{
  const auto warnings = [](const std::string &material, const std::string &options = "",
                           const char *words = "points lock") {
    return lines_that_say(plane("si", "f f", "0 4 0 4", 1, 0.3) +
                              "region body block 1 3 1 3 INF INF\nfix grid all mpm 0.5 " + options +
                              "\ncreate_points 1 region body ppc 2\ngroup none empty\n"
                              "fix m all mpm/material density 1 " +
                              material +
                              "\nfix n none mpm/material density 1 linear 1 0.4999\n"
                              "timestep 1e-3\nrun 1\nrun 1\n",
                          words)
        .size();
  };
  EXPECT_EQ(warnings("neohookean 1 0.499"), 1u);
  EXPECT_EQ(warnings("linear 1 0.4999", "frame total"), 1u);
  EXPECT_EQ(warnings("neohookean 1 0.499", "locking fbar"), 0u);
  EXPECT_EQ(warnings("neohookean 1 0.499", "locking pressure"), 0u);
  EXPECT_EQ(warnings("neohookean 1 0.49"), 0u);
  EXPECT_EQ(warnings("eos linear 1 viscosity newtonian 0.01"), 0u);

  // a cure of what does not lock makes it too soft
  const char *const free = "averages what does not lock";
  EXPECT_EQ(warnings("neohookean 1 0.3", "locking pressure", free), 1u);
  EXPECT_EQ(warnings("linear 1 0.3", "locking fbar", free), 1u);
  EXPECT_EQ(warnings("neohookean 1 0.3", "", free), 0u);
  EXPECT_EQ(warnings("neohookean 1 0.45", "locking pressure", free), 0u);
  EXPECT_EQ(warnings("eos linear 1 strength j2 0.5 0.01", "locking pressure", free), 0u);
}

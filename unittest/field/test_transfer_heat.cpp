// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm heat yes: the kinetic energy that transfers lose becomes heat of the points.

#include "mpm_lammps.h"

#include "error.h"

using namespace MPM_TEST;

/** Kinetic energy of the affine fields of points about these, m/2 C D C^T, D = h^2/4 or h^2/3. */
static double affine_energy(Scene &run, double D)
{
  if (!run.affine()) return 0.0;
  const int n = run.dim() * run.dim();
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    for (int k = 0; k < n; k++)
      sum += 0.5 * run.mass()[i] * D * run.affine()[i][k] * run.affine()[i][k];
  return over_ranks(sum);
}

/** A gas with much motion that nodes do not resolve; it flies across the lattice. */
static std::string gas(const std::string &options)
{
  return plane("lj", "p p", "0 8 0 8", 1, 0.4) +
      body("box", "density 1.0 eos ideal/gas 1.4 pressure 1.0 viscosity artificial 2.0 1.0",
           "1.0 heat yes " + options) +
      "variable u atom 0.7+0.4*sin(PI*x)*cos(1.7*y)\n"
      "variable v atom 0.3*cos(1.3*x*y)\nvelocity all set v_u v_v 0\n"
      "compute e all mpm/energy\nthermo_style custom step c_e[*]\nthermo_modify norm no\n"
      "timestep 0.02\n";
}

// What transfers do to the kinetic energy of points, and what they give back as heat, differ by
// what the affine fields of the points have got: on periodic axes nothing is lost, to round-off
PARAMETER_TEST(Balance, NothingIsLost, const char *,
               Values("", "shape cubic", "transfer pic", "transfer pic shape gimp",
                      "transfer pic shape cpdi", "transfer pic shape linear scheme musl",
                      "scheme musl", "stress gradient", "shape cubic scheme musl stress gradient",
                      "locking pressure", "locking fbar", "frame total", "every 3"))
{
  const std::string options = GetParam();
  const double D = options.find("cubic") == std::string::npos ? 0.25 : 1.0 / 3.0;
  Scene run(gas(options) + "run 0\n");
  const double affine = affine_energy(run, D);
  run.commands("run 150\n");
  const double transfer = run.compute_vector()[8], heat = run.compute_vector()[3];
  const double gained = affine_energy(run, D) - affine;
  EXPECT_GT(measured(options + ", viscous work and heat", heat), 1.0);
  EXPECT_NEAR(transfer / heat, -gained / heat, 1e-12);
  EXPECT_NEAR(run.compute_vector()[10] / heat, 0.0, 1e-11);    // residual
}

TEST(Balance, RanksAgree)
{
  for (const char *options : {"", "shape cubic scheme musl", "transfer pic"}) {
    OnRanks run(gas(options), "run 60\n");
    EXPECT_LT(run.difference(), 1e-12) << options;
  }
}

TEST(Balance, GoesOnAfterRestart)
{
  Continued run(gas(""), 20, lines_again(gas("")), 20);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

// a solid without viscosity is warmer by all of what transfers lose, in any units
TEST(Solid, BecomesWarm)
{
  for (const char *units : {"lj", "metal"}) {
    SCOPED_TRACE(units);
    const bool metal =
        !strcmp(units, "metal");    // pressure and energy have other units than m v^2
    const std::string material = metal
        ? "density 2.7 eos linear 8.0e5 strength elastic 3.0e5 thermal adiabatic 6.0e-5 300"
        : "density 1.0 eos linear 10.0 strength elastic 5.0 thermal adiabatic 2.0 300";
    Scene run(
        space(units, "p p p", "0 8 0 8 0 8", 1, 0.4) +
        body("sphere 4 4 4 2.6", material, "1.0 heat yes") +
        strprintf("variable v atom %g*sin(1.9*x)*cos(2.1*y*z)\nvelocity all set v_v 0 0\n"
                  "compute e all mpm/energy\nthermo_modify norm no\nthermo_style custom step c_e\n"
                  "timestep %g\nrun 0\n",
                  metal ? 3.0 : 0.3, metal ? 1.0e-3 : 0.05));
    const double affine = affine_energy(run, 0.25), kinetic = run.compute_vector()[0];
    run.commands("run 40\n");
    double warm = 0.0;
    const auto *material_of = run.material();
    const int T = material_of->find_history("temperature");
    for (int i = 0; i < run.n(); i++)
      warm += run.mass()[i] * (metal ? 6.0e-5 : 2.0) * (material_of->history[i][T] - 300.0);
    warm = over_ranks(warm);
    const double mvv2e = run.lmp->force->mvv2e, heat = run.compute_vector()[3];
    EXPECT_GT(measured("heat/kinetic energy at the start", heat / kinetic), 0.1);
    EXPECT_NEAR(warm / heat, 1.0, 1e-11);
    const double gained = mvv2e * (affine_energy(run, 0.25) - affine);
    EXPECT_NEAR(run.compute_vector()[8] / heat, -gained / heat, 1e-13);
  }
}

// W.F. Noh, J. Comput. Phys. 72 (1987) 78, gamma = 5/3: density 4 and pressure 4/3 behind a shock
// of speed 1/3. Without heat, APIC loses energy in the shock, at each spacing and the more, the
// more steps there are: a shock is always as wide as a few cells. Asked: energy and density to 1 %,
// as of the plateau of Sod's problem
struct Noh {
  double energy, density, pressure;    // relative to exact ones
};

static Noh noh(const std::string &options, int cells, double dt)
{
  const double h = 1.0 / cells, t = 0.6;
  Scene run(plane("si", "f p", strprintf("0 1.1 0 %.17g", h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g %s\nregion gas block 0 1 INF INF INF INF\n"
                      "create_points 1 region gas ppc 3 1\nvelocity all set -1 0 0\n"
                      "fix gas all mpm/material density 1 eos ideal/gas %.17g pressure 1e-6 "
                      "viscosity artificial 2 1\nfix wall all mpm/boundary xlo slip\n"
                      "compute e all mpm/energy\nthermo_style custom step c_e\n"
                      "timestep %.17g\nrun 0\n",
                      h, options.c_str(), 5.0 / 3, dt * h));
  const double start = run.compute_scalar();
  run.commands(strprintf("run %ld\n", std::lround(t / (dt * h))));
  double rho = 0.0, p = 0.0, n = 0.0;
  for (const auto &s : run.gather())
    if (s.x[0] > 0.06 && s.x[0] < 0.16) rho += s.mass / s.vol, p += s.pressure(), n++;
  const double *e = run.compute_vector();
  const std::string name = strprintf("Noh, %s, %d cells, dt %g h: ", options.c_str(), cells, dt);
  measured(name + "transfer", e[8] / start);
  measured(name + "integration", e[9] / start);
  measured(name + "boundary", e[6] / start);
  return {measured(name + "energy", run.compute_scalar() / start),
          measured(name + "density", rho / n / 4.0), measured(name + "pressure", p / n * 0.75)};
}

SERIAL_TEST(Noh, ConvergesWithHeat)
{
  for (const char *options : {"heat yes", "shape cubic heat yes", "scheme musl heat yes"})
    for (const int cells : first_of(1, {100, 200}))
      for (const double dt : {0.05, 0.0125}) {
        if (dt < 0.05 && (*options != 'h' || cells > 100)) continue;
        const Noh now = noh(options, cells, dt);
        EXPECT_NEAR(now.energy, 1.0, 0.01);
        EXPECT_NEAR(now.density, 1.0, 0.01);
        EXPECT_NEAR(now.pressure, 1.0, 0.01);
      }
}

// The same shock by a piston, a region that moves: its work, 4/3 times the way of 0.5, is the
// energy of the gas. The place of its surface is known to a node spacing, which is 2 h of the way
SERIAL_TEST(Noh, Piston)
{
  for (const std::string kind : {"slip", "separate"})
    for (const int cells : {100, 200}) {
      const double h = 1.0 / cells, exact = 4.0 / 3 * 0.5 * h;
      Scene run(
          plane("si", "f p", strprintf("-0.1 1.1 0 %.17g", h), 1, 0.4 * h) +
          body("block 0 1 INF INF INF INF",
               strprintf("density 1 eos ideal/gas %.17g pressure 1e-6 viscosity artificial 2 1",
                         5.0 / 3),
               strprintf("%.17g heat yes", h), "3 1") +
          "variable x equal time\nregion piston plane 0 0 0 -1 0 0 move v_x NULL NULL\n"
          "fix piston all mpm/boundary region piston " +
          kind + "\ncompute e all mpm/energy\nthermo_style custom step c_e\n" +
          strprintf("fix step all mpm/dt 0.2 max %.17g until 0.5\nrun 100000\n", 0.1 * h));
      double rho = 0.0, p = 0.0, n = 0.0;
      for (const auto &s : run.gather())
        if (s.x[0] > 0.56 && s.x[0] < 0.62) rho += s.mass / s.vol, p += s.pressure(), n++;
      const std::string name = strprintf("piston, %s, %d cells: ", kind.c_str(), cells);
      EXPECT_NEAR(measured(name + "density", rho / n / 4.0), 1.0, 2.0 * h);
      EXPECT_NEAR(measured(name + "pressure", p / n * 0.75), 1.0, 2.0 * h);
      EXPECT_NEAR(measured(name + "work", run.compute_vector()[6] / exact), 1.0, 2.0 * h);
      EXPECT_NEAR(measured(name + "energy", run.compute_scalar() / exact), 1.0, 2.0 * h);
    }
}

// what the manual says of the others
SERIAL_TEST(Noh, WithoutHeat)
{
  const Noh coarse = noh("", 100, 0.05), fine = noh("", 200, 0.05), small = noh("", 100, 0.0125);
  EXPECT_LT(coarse.energy, 0.95);
  EXPECT_LT(fine.energy, 0.95);
  EXPECT_LT(small.energy, 0.9);
  EXPECT_LT(noh("transfer tpic", 100, 0.05).energy, 0.95);
  EXPECT_GT(noh("transfer aflip 1.0", 100, 0.05).energy, 1.02);    // it creates energy in shocks
  const Noh flip = noh("transfer flip 1.0 scheme musl", 100, 0.05);
  EXPECT_NEAR(flip.energy, 1.0, 0.003);
  EXPECT_NEAR(flip.density, 1.0, 0.01);
}

TEST(BadInput, IsRefused)
{
  const std::string transfers = "needs transfer pic, or apic with shape quadratic or cubic",
                    schemes = "needs scheme usl or musl";
  expect_options_refused({{"heat yes transfer flip 1.0", transfers},
                          {"heat yes transfer aflip 0.5", transfers},
                          {"heat yes transfer tpic", transfers},
                          {"heat yes transfer polypic", transfers},
                          {"heat yes transfer xpic 2", transfers},
                          {"heat yes shape linear light 0.5", transfers},
                          {"heat yes shape gimp", transfers},
                          {"heat yes shape cpdi", transfers},
                          {"heat yes scheme usf", schemes},
                          {"heat yes scheme usavg", schemes}});
}

TEST(BadInput, NothingTakesHeat)
{
  Scene none(replaced(two_bodies, "MPM_OPTIONS", "heat yes") + "run 0\n"),
      gases(gas("") + "run 0\n");
  EXPECT_EQ(over_ranks(none.lmp->error->get_numwarn()), 1.0);
  EXPECT_EQ(over_ranks(gases.lmp->error->get_numwarn()), 0.0);
}

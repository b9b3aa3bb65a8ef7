// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Grains of fix mpm/immersed in fix mpm/incompressible: drag, buoyancy, suspensions, beds.

#include "mpm_lammps.h"

#include "group.h"

#include <complex>

using namespace MPM_TEST;

/** A box of cells of size 1 that is full of points of type 1, and grains of type 2. */
std::string full(int dim, const std::string &extent, const std::string &faces,
                 const std::string &grains, const std::string &units = "lj")
{
  return replaced(box(dim, units, faces, extent, 2, 0.3), "atom_style mpm",
                  "atom_style hybrid sphere mpm") +
      "comm_modify vel yes\ncreate_points 1 box spacing 0.5\n" + grains +
      "group water type 1\ngroup grains type 2\nneigh_modify exclude type 1 1 exclude type 1 2\n"
      "pair_style zero 0.5\npair_coeff * *\nthermo_modify norm no\n";
}

/** The fluid, of density 1, and its laws. */
std::string flow(const std::string &options, const std::string &laws)
{
  return "fix w water mpm/incompressible 1.0 1.0 " + options +
      "\nfix drag grains mpm/immersed w 1.0 " + laws + "\n";
}

/** Drag on a sphere (Schiller and Naumann) of diameter d and velocity v in a fluid of density 1. */
double schiller(double d, double v, double mu)
{
  return 3.0 * PI * mu * d * v * (1.0 + 0.15 * std::pow(v * d / mu, 0.687));
}

/** Gradient of the pressure of spheres per superficial velocity w, by Ergun. */
double ergun(double d, double w, double mu, double solid)
{
  const double cube = std::pow(1.0 - solid, 3);
  return solid * (150.0 * mu * solid / (d * d) + 1.75 * w / d) * w / cube;
}

/** Velocity of viscous fluid at a point force F along z that moves with v in a periodic box for a
 *  time t (C.W. Oseen), spread by quadratic splines along z and hats along x and y. */
double dragged_along(double F, double v, double mu, double t, const double *box)
{
  const auto sinc = [](double k) {
    return k == 0.0 ? 1.0 : std::sin(0.5 * k) / (0.5 * k);
  };
  double sum = 0.0;
  const int n = 24;
  for (int a = -n; a <= n; a++)
    for (int b = -n; b <= n; b++)
      for (int c = -n; c <= n; c++) {
        const double k[3] = {2.0 * PI * a / box[0], 2.0 * PI * b / box[1], 2.0 * PI * c / box[2]};
        const double across = k[0] * k[0] + k[1] * k[1], all = across + k[2] * k[2];
        if (across == 0.0) continue;
        const std::complex<double> rate(mu * all, v * k[2]);
        sum += std::pow(sinc(k[0]) * sinc(k[1]), 4.0) * std::pow(sinc(k[2]), 6.0) * across / all *
            ((1.0 - std::exp(-rate * t)) / rate).real();
      }
  return F / (box[0] * box[1] * box[2]) * sum;
}

const std::string discs = "fix move grains nve/sphere disc\nfix flat all enforce2d\n";

/** n discs in a square array that fills all of x and a part of y. */
std::string array(int n, const std::string &y, double d, double density,
                  const std::string &units = "lj")
{
  return strprintf(
             "lattice sq %g origin 0.5 0.5 0\nregion bed block INF INF %s INF INF units box\n",
             units == "lj" ? n * n : 1.0 / n, y.c_str()) +
      strprintf("create_atoms 2 region bed\nset type 2 diameter %.17g density/disc %.17g\n", d,
                density);
}

// A single sphere sinks with the velocity of the law, and with what it drags along of the fluid in
// its own cells; in steps that are longer than its time of relaxation, too
SERIAL_TEST(Grain, SinksWithTheTerminalVelocity)
{
  struct Case {
    double diameter, viscosity, dt;
    bool before;    // the fix that moves the grain comes before that of the flow
  };
  for (const auto &c :
       {Case{0.2, 1.0, 0.01, false}, Case{0.5, 0.1, 0.05, true}, Case{0.2, 0.01, 0.05, false}}) {
    const double d = c.diameter, mu = c.viscosity, weight = 2.0 * PI / 6.0 * d * d * d;
    const double law = root_of(0.0, 100.0, [&](double v) {
      return schiller(d, v, mu) - weight;
    });
    const std::string move = "fix move grains nve/sphere\n",
                      fluid = flow(strprintf("viscosity %g", mu),
                                   strprintf("%g drag schiller gravity 0 0 -1", mu));
    const double span = c.dt < 0.02 ? 0.4 : 4.0;
    Scene run(full(3, "0 6 0 6 0 8", "p p p",
                   "create_atoms 2 single 3.1 3.2 5.3\n" +
                       strprintf("set type 2 diameter %g density 3.0\n", d)) +
              (c.before ? move + fluid : fluid + move) +
              "fix g grains gravity 1.0 vector 0 0 -1\n" +
              strprintf("timestep %.17g\nrun %d\n", c.dt, (int) (span / c.dt)));
    const double start = run.evaluate("xcm(grains,z)");
    run.commands("run 10\n");
    const double v = (start - run.evaluate("xcm(grains,z)")) / (10 * c.dt);
    const double boxed[3] = {6.0, 6.0, 8.0};
    const double more = dragged_along(weight, law, mu, span, boxed) / law;
    measured("fluid dragged along / law", more);
    measured(strprintf("terminal velocity / law at Re %.3g", law * d / mu), v / law);
    EXPECT_GT(v / law, 0.999);
    EXPECT_LT(v / law, 1.001 + more);
    EXPECT_NEAR(run.fix_vector("drag", 6)[2] / weight, 1.0, 0.01);
  }
}

// In a closed column discs settle with the terminal velocity times eps^4.65 in slow flow
// (Richardson and Zaki; the exponent is that of Wen and Yu)
SERIAL_TEST(Suspension, IsHindered)
{
  const double d = 0.05, mu = 0.1, g = 1.0;
  for (const int n : {4, 8}) {
    const double solid = n * n * 0.25 * PI * d * d;
    Scene run(
        full(2, "0 3 0 16", "p f", array(n, "0.5 15", d, 3.0)) +
        flow(strprintf("viscosity %g", mu), strprintf("%g drag gidaspow gravity 0 -1 0", mu)) +
        discs + strprintf("fix g grains gravity %g vector 0 -1 0\n", g) +
        "region middle block INF INF 4 11 INF INF units box\ngroup zone region middle\n"
        "group middle intersect zone grains\ntimestep 0.05\nrun 20\n");
    const double start = run.evaluate("xcm(middle,y)");
    run.commands("run 20\n");
    const double v = start - run.evaluate("xcm(middle,y)");    // in the time 1
    const double single = (3.0 - 1.0) * g * d * d / (18.0 * mu);
    const double law = single * std::pow(1.0 - solid, 4.65);
    measured("share of volume", solid);
    EXPECT_NEAR(measured("velocity / Richardson and Zaki", v / law), 1.0, 0.01);
  }
}

// A bed in half of a periodic column, driven by a force on the fluid: Ergun's law for the flux
SERIAL_TEST(Bed, HasThePressureDropOfErgun)
{
  const double d = 0.25, pull = 0.5, solid = 12.25 * 0.25 * PI * d * d;
  for (const double mu : {0.01, 0.0001})
    for (const double dt : {0.02, 0.2}) {
      Scene run(
          full(2, "0 4 0 16", "p p",
               "lattice sq 12.25 origin 0.5 0.5 0\nregion bed block 0 4 4 12 INF INF units box\n"
               "create_atoms 2 region bed\nset type 2 diameter 0.25 density/disc 3.0\n"
               "group bed type 2\ndisplace_atoms bed random 0.025 0.025 0 4711 units box\n") +
          flow("", strprintf("%g drag ergun", mu)) +
          strprintf("fix g water gravity %g vector 0 1 0\ntimestep %g\nrun %d\n", pull, dt,
                    (int) (6.0 / dt)));
      const double w = run.evaluate("vcm(water,y)");
      EXPECT_NEAR(measured(strprintf("pressure drop / Ergun at Re %.3g, dt %g", w * d / mu, dt),
                           16.0 * pull / (8.0 * ergun(d, w, mu, solid))),
                  1.0, 0.02);
      EXPECT_NEAR(run.fix_vector("drag", 6)[1], 64.0 * pull, 4e-5 * 64.0 * pull);
    }
}

// Steps of any length give the same steady flow
SERIAL_TEST(Bed, DoesNotDependOnTheStep)
{
  double flux[2];
  for (const int k : {0, 1}) {
    Scene run(full(2, "0 4 0 8", "p p", array(4, "2 6", 0.2, 3.0)) +
              flow("", "0.001 drag gidaspow") + "fix g water gravity 0.5 vector 0 1 0\n" +
              (k ? "timestep 0.5\nrun 40\n" : "timestep 0.02\nrun 500\n"));
    flux[k] = run.evaluate("vcm(water,y)");
  }
  EXPECT_NEAR(measured("flux in long steps / in short ones", flux[1] / flux[0]), 1.0, 1e-12);
}

// In water at rest a grain feels the weight of what it displaces, and the floor bears both
SERIAL_TEST(Tank, BearsTheBuoyancy)
{
  const double d = 0.3, g = 9.81, area = 0.25 * PI * d * d;
  std::string rows;
  for (const char *y : {"0.13", "0.4", "3.71", "5.2"})
    for (int k = 0; k < 4; k++) rows += strprintf("create_atoms 2 single %d.2 %s 0\n", k, y);
  Scene run(replaced(full(2, "0 4 0 12", "p f",
                          rows + strprintf("set type 2 diameter %.17g density/disc 1.0\n", d)),
                     "create_points 1 box",
                     "region low block INF INF 0 8.2 INF INF\ncreate_points 1 region low") +
            replaced(flow("tolerance 1e-12", strprintf("0.01 gravity 0 %.17g 0", -g)),
                     "fix w water", "fix w all") +    // which moves no grains
            strprintf("fix g water gravity %.17g vector 0 -1 0\ntimestep 0.1\nrun 100\n", g));
  EXPECT_EQ(run.evaluate("f_drag"), 16.0);
  EXPECT_NEAR(measured("buoyancy / weight of the displaced water",
                       run.fix_vector("drag", 6)[4] / (16.0 * area * g)),
              1.0, 1e-12);
  EXPECT_LT(measured("drag", std::fabs(run.fix_vector("drag", 6)[1])), 1e-12 * area * g);
  EXPECT_LT(measured("speed", run.fix("w")->compute_vector(6)), 1e-12);
  const double water = run.evaluate("count(water)") * 0.25;
  EXPECT_NEAR(measured("force on the floor / weights",
                       run.fix("w")->compute_vector(9) / (g * (water + 16.0 * area))),
              1.0, 1e-12);
}

// Grains with the density of the fluid go along with it, when it accelerates, too, without drag
SERIAL_TEST(Grain, GoesWithFluidThatAccelerates)
{
  Scene run(full(2, "0 4 0 4", "p p", array(1, "0 4", 0.3, 1.0)) + flow("", "0.0 drag none") +
            discs +
            "variable a equal 0.075*cos(2*time)\nfix a water addforce v_a 0 0\n"
            "timestep 0.05\nrun 30\n");
  EXPECT_GT(run.evaluate("vcm(water,x)"), 0.01);
  EXPECT_NEAR(
      measured("velocity of the grain / of the fluid", run.evaluate("vcm(grains,x)/vcm(water,x)")),
      1.0, 1e-12);
}

// What grains get the fluid loses, to round-off in the first step, as points are even
SERIAL_TEST(Grain, KeepsMomentum)
{
  for (const int dim : {2, 3})
    for (const std::string laws : {"0.1 drag gidaspow", "0.01 drag schiller gravity 0 -0.2 0",
                                   "1.0e5 drag stokes", "0.1 drag none gravity 0 -0.2 0"}) {
      std::string grains;
      for (int k = 0; k < 60; k++)
        grains += strprintf("create_atoms 2 single %.2f %.2f %s\n", std::fmod(0.37 * k, 8.0),
                            std::fmod(1.23 * k, 8.0),
                            dim == 3 ? strprintf("%.2f", std::fmod(0.71 * k, 4.0)).c_str() : "0");
      Scene run(
          full(dim, "0 8 0 8 0 4", "p p p",
               grains + "set type 2 diameter 0.4 density" + (dim == 2 ? "/disc" : "") + " 3.0\n") +
          "velocity water set 0.3 -0.2 0 units box\nvelocity grains create 0.5 4711 loop geom\n"
          "velocity grains set 0.4 0.2 0 sum yes units box\nvelocity grains set " +
          (dim == 2 ? "NULL NULL 0" : "NULL NULL NULL") + "\n" + flow("", laws) +
          (dim == 2 ? discs : "fix move grains nve/sphere\n") + "timestep 0.05\nrun 0\n");
      const auto start = run.sums(), of_grains = run.sums(2);
      run.commands("run 1\n");
      const auto now = run.sums(), later = run.sums(2);
      double scale = 0.0, most = 0.0, given = 0.0;
      for (int d = 0; d < dim; d++) {
        scale += std::fabs(of_grains.p[d]);
        grow(most, now.p[d] - start.p[d]);
        grow(given, later.p[d] - of_grains.p[d]);
      }
      EXPECT_LT(measured(strprintf("%dd, %s: momentum", dim, laws.c_str()), most / scale), 1e-12);
      EXPECT_GT(measured("given", given / scale), 1e-3);
    }
}

/** A wave between a suspension, 5 % of discs, and the water above or below it in a closed tank with
 *  n cells: frequency over that of liquids, one of density rho + (rho_s - rho) phi. */
double wave_of_suspension(int n, double density, const std::string &options)
{
  const bool heavy = density > 1.0;
  const double solid = 0.05, k = PI / n, other = 1.0 + (density - 1.0) * solid,
               w = std::sqrt(k * std::fabs(other - 1.0) / (other + 1.0) * std::tanh(0.5 * n * k)),
               a = 0.025 * n / (2.0 * std::sinh(0.5 * n * k)), dt = 0.3;
  Scene run(
      full(2, strprintf("0 %d 0 %d", n, n), "f f",
           array(2, heavy ? strprintf("0 %d", n / 2) : strprintf("%d %d", n / 2, n),
                 std::sqrt(solid / PI), density) +
               strprintf("variable low atom y<%d\nvariable z atom v_low*y+(1-v_low)*(%d-y)\n",
                         n / 2, n) +
               strprintf("variable up atom %.17g*cos(%.17g*x)*(exp(%.17g*v_z)-exp(-%.17g*v_z))\n",
                         a, k, k, k) +
               strprintf("variable side atom "
                         "%.17g*sin(%.17g*x)*(1-2*v_low)*(exp(%.17g*v_z)+exp(-%.17g*v_z))\n",
                         a, k, k, k) +
               "displace_atoms all move v_side v_up 0 units box\n") +
      flow("", "10 drag stokes gravity 0 -1 0 " + options) + discs +
      "fix g all gravity 1.0 vector 0 -1 0\n" + strprintf("timestep %g\n", dt));
  const int bit = run.lmp->group->bitmask[run.lmp->group->find("grains")];
  double before = 0.0, time = 0.0;
  run.each_step([&](double **) {
    double now = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->mask[i] & bit) now += run.x()[i][1] * std::cos(k * run.x()[i][0]);
    if (now * before < 0.0 && time == 0.0) time = run.time() - dt * now / (now - before);
    before = now;
  });
  run.commands(strprintf("run %d\n", (int) (0.6 * PI / w / dt)));
  return measured(
      strprintf("%d cells, density %g %s: frequency over theory", n, density, options.c_str()),
      0.5 * PI / time / w);
}

// grains weigh what they do in the fluid: of first order, by the thickness of the mapping of grains
SERIAL_TEST(Suspension, WeighsWhatItDoes)
{
  EXPECT_GT(wave_of_suspension(16, 3.0, ""), 1.1);    // the miss that the manual tells of
  const double coarse = 1.0 - wave_of_suspension(16, 3.0, "displace yes"),
               fine = 1.0 - wave_of_suspension(32, 3.0, "displace yes");
  EXPECT_LT(std::fabs(coarse), 0.08);
  EXPECT_GT(measured("order", std::log2(coarse / fine)), 0.8);
  EXPECT_NEAR(wave_of_suspension(16, 0.2, "displace yes"), 1.0, 0.08);
}

// Grains that the flow carries, light and stiff ones, do not make it viscous: a shear wave decays
SERIAL_TEST(Suspension, IsNotViscousByItself)
{
  double left[2];
  for (const int with : {0, 1}) {
    Scene run(full(2, "0 8 0 8", "p p", array(4, "0 8", 0.02, 1.0)) +
              "variable u atom 0.1*sin(2*PI*y/8)\nvelocity all set v_u 0 0\n" +
              flow("", with ? "0.01 drag stokes" : "0.0 drag none") + discs +
              "timestep 0.1\nrun 0\n");
    const double before = run.fix("w")->compute_vector(5);
    run.commands("run 50\n");
    left[with] = run.fix("w")->compute_vector(5) / before;
  }
  EXPECT_NEAR(measured("energy that is left without drag", left[0]), 1.0, 2e-4);
  EXPECT_NEAR(measured("energy with grains / without", left[1] / left[0]), 1.0, 2e-4);
}

// Above the surface there is no force
SERIAL_TEST(Grain, EndsAtTheSurface)
{
  for (const double y : {4.0, 5.2, 5.8, 6.7}) {
    Scene run(replaced(full(2, "0 4 0 8", "p f",
                            strprintf("create_atoms 2 single 1.3 %g 0\n", y) +
                                "set type 2 diameter 0.2 density/disc 1.0\n"),
                       "create_points 1 box",
                       "region low block INF INF 0 5 INF INF\ncreate_points 1 region low") +
              flow("", "0.01 gravity 0 -1 0") +
              "fix g water gravity 1.0 vector 0 -1 0\ntimestep 0.01\nrun 2\n");
    const double share = run.fix_vector("drag", 6)[4] / (0.01 * PI);
    // filled by the depth s below the surface: 1/2 + s - s^2/2, interpolated
    measured(strprintf("buoyancy at %g", y), share);
    if (y < 5.0) EXPECT_NEAR(share, 1.0, 0.01);    // the fluid begins to sink with what it bears
    if (y > 5.0 && y < 6.0) EXPECT_LT(share, 0.9);
    if (y > 6.5) EXPECT_EQ(share, 0.0);
  }
}

// In all units: the drag of the law on grains in a stream, and buoyancy
SERIAL_TEST(Units, HaveTheForces)
{
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene probe(plane(units, "p p", "0 4 0 4", 1, 0.3));
    const double to_mass = probe.lmp->force->ftm2v, pressure = to_mass / probe.lmp->force->nktv2p;
    const double mu = 0.01, d = 0.2, w = 0.7 * mu * pressure / d, g = 0.3 * w * w,
                 area = 0.25 * PI * d * d;
    Scene run(
        full(2, "0 4 0 4", "p p", array(2, "0 4", d, 3.0, units), units) +
        flow("", strprintf("%.17g drag stokes gravity 0 %.17g 0", mu, -g)) +
        strprintf("velocity water set %.17g 0 0 units box\ntimestep %.17g\nrun 1\n", w, 1e-6 / w));
    const double drag = 64.0 * 3.0 * PI * mu * pressure * d * w * 1.5 / d / to_mass;
    EXPECT_NEAR(run.fix_vector("drag", 6)[0] / drag, 1.0, 5e-5) << units;
    EXPECT_NEAR(run.fix_vector("drag", 6)[4] * (1.0 + 4.0 * area) / (64.0 * area * g / to_mass),
                1.0,
                2e-5)
        << units;    // as all of the fluid is pushed down
  }
}

// A suspension with contacts that falls through a surface: on four ranks, from restart files, and
// with grains alone in the lists of neighbors
std::string falling(int dim)
{
  std::string grains;
  for (int k = 0; k < 40; k++)
    grains += strprintf("create_atoms 2 single %.2f %.2f %s\n", 0.3 + 0.7 * (k % 10),
                        3.1 + 0.73 * (k / 10),
                        dim == 3 ? strprintf("%.2f", 0.4 + std::fmod(0.71 * k, 3.0)).c_str() : "0");
  return replaced(
      full(dim, "0 8 0 8 0 4", "p f p",
           grains + "set type 2 diameter 0.4 density" + (dim == 2 ? "/disc" : "") + " 3.0\n"),
      "create_points 1 box", "region low block INF INF 0 5 INF INF\ncreate_points 1 region low");
}

std::string falling_fixes(int dim)
{
  return flow("viscosity 0.01 tolerance 1e-13",
              std::string("0.01 drag difelice gravity 0 -1 0") +
                  (dim == 3 ? " displace yes" : "")) +
      (dim == 2 ? discs : "fix move grains nve/sphere\n") +
      "fix g all gravity 1.0 vector 0 -1 0\nneigh_modify exclude type 1 1 exclude type 1 2\n"
      "pair_style gran/hooke 50.0 NULL 0.5 NULL 0.5 1\npair_coeff * *\ntimestep 0.05\n";
}

TEST(Suspension, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    OnRanks run(falling(dim) + falling_fixes(dim), "run 25\n",
                "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    for (int k = 0; k < 6; k++)
      EXPECT_NEAR(run.parallel.fix("drag")->compute_vector(k),
                  run.serial.fix("drag")->compute_vector(k), 1e-11);
    EXPECT_GT(std::fabs(run.serial.fix("drag")->compute_vector(1)), 0.01);
    Continued again(falling(dim) + falling_fixes(dim), 12,
                    "neighbor 0.3 bin\ncomm_modify vel yes\n" + falling_fixes(dim), 20);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

// A rank that has grains and no points knows the fluid around them, also where they get between two
// searches for neighbors
TEST(Grain, AreSeenByOtherRanks)
{
  for (const bool falls : {false, true}) {
    const auto scene =
        replaced(full(2, "0 4 0 32", "p f",
                      strprintf("create_atoms 2 single 1.3 %g 0\n", falls ? 14.2 : 8.2) +
                          "set type 2 diameter 0.2 density/disc 3.0\n"),
                 "create_points 1 box",
                 "region low block INF INF 0 8 INF INF\ncreate_points 1 region low") +
        flow("tolerance 1e-13", "0.1 gravity 0 -1 0") +
        (falls ? discs +
                 "neigh_modify delay 1000 every 1000 check no\nvelocity grains set 0 -60 0 units "
                 "box\n"
               : "") +
        "timestep 0.01\n";
    OnRanks run(scene, falls ? "run 11\n" : "run 2\n", "processors 1 * 1\n");
    const double serial = run.serial.fix("drag")->compute_vector(4);
    EXPECT_GT(std::fabs(serial), 0.005);
    EXPECT_NEAR(run.parallel.fix("drag")->compute_vector(4), serial, 1e-13);
  }
}

TEST(Suspension, NeedsNoPointsInNeighborLists)
{
  Scene all(falling(2) + falling_fixes(2) + "run 60\n"),
      grains(falling(2) + falling_fixes(2) +
             "atom_modify first grains\nneigh_modify include grains\ncomm_modify group grains\nrun "
             "60\n");
  EXPECT_LT(difference(all.gather(), grains.gather()), 1e-12);
}

// Points that go round a periodic box while the lists of grains that are held never change
SERIAL_TEST(Bed, IsPassedForEver)
{
  Scene run(full(2, "0 4 0 4", "p p",
                 "create_atoms 2 single 1.3 2.2 0\nset type 2 diameter 0.1 density/disc 1.0\n") +
            flow("", "0.0 drag none") +
            "velocity water set 1.0 0 0 units box\natom_modify first grains\n"
            "neigh_modify include grains\ncomm_modify group grains\ntimestep 0.5\nrun 60\nrun 1\n");
  EXPECT_NEAR(measured("displacement", run.evaluate("xcm(water,x)")), 2.0 + 30.5, 1e-10);
}

SERIAL_TEST(Grain, BadInput)
{
  const auto scene = full(2, "0 4 0 4", "p p",
                          "create_atoms 2 single 1.3 2.2 0\ncreate_atoms 2 single 3.3 2.2 0\nset "
                          "type 2 diameter 0.1 density/disc 1.0\n");
  const std::string w = "fix w water mpm/incompressible 1.0 1.0 ",
                    d = "\nfix d grains mpm/immersed w ";
  expect_refused(
      scene,
      {{w + d + "2.0 0.1", "the density of the fluid is 2, but that of fix w"},
       {w + "reflect 0.5" + d + "1.0 0.1", "reflect cannot be used with grains"},
       {w + "sharp yes" + d + "1.0 0.1", "sharp cannot be used with grains"},
       {w + "viscosity 1.0 implicit yes" + d + "1.0 0.1",
        "implicit yes cannot be used with grains"},
       {w + "\nfix d all mpm/immersed w 1.0 0.1", "are material points: use a group of grains"},
       {w + "\nfix d grains mpm/immersed other 1.0 0.1", "there is no fix mpm other"},
       {w + d + "1.0 0.1\nfix e grains mpm/immersed w 1.0 0.1",
        "have 2 grains and the field in common"},
       {w + d + "1.0 0.1\nfix r grains rigid/nve single", "use single spheres"},
       {w + d + "1.0 0.1 displace maybe", "maybe"},
       {"fix w water mpm 1.0\nfix m water mpm/material density 1 eos linear 100" + d +
            "1.0 0.1 displace yes",
        "displace yes needs a fluid of fix mpm/incompressible"}},
      "timestep 0.001\nrun 1\n");

  // weight without buoyancy: a mistake, unless nothing moves the grains, or buoyancy is no matter
  const std::string g = "\nfix g all gravity 1.0 vector 0 -1 0\n", run = "timestep 0.001\nrun 1\n",
                    move = "fix move grains nve/sphere disc\n", say = "their buoyancy is that of";
  for (const auto &[law, mover, warned] :
       {std::tuple{"1.0 0.1", move, 1u}, std::tuple{"1.0 0.1 gravity 0 -1 0", move, 0u},
        std::tuple{"1.0 0.1 gravity 0 1 0", move, 1u}, std::tuple{"1.0 0.1", std::string(), 0u}})
    EXPECT_EQ(times_said(scene + w + d + law + g + mover + run, say), warned) << law;
  EXPECT_EQ(
      times_said(scene + "set type 2 density/disc 1000.0\n" + w + d + "1.0 0.1" + g + move + run,
                 say),
      0);

  // weights of groups of grains are one of all; one that varies is none before the first forces
  const std::string fits = scene + w + d + "1.0 0.1 gravity 0 -1 0",
                    left = "region left block INF 2 INF INF INF INF\n"
                           "group left region left\ngroup right subtract all left\n";
  EXPECT_EQ(
      times_said(
          fits + "\n" + left +
              "fix g left gravity 1.0 vector 0 -1 0\nfix g2 right gravity 1.0 vector 0 -1 0\n" +
              move + run,
          say),
      0);
  EXPECT_EQ(
      times_said(fits + "\n" + left + "fix g right gravity 2.0 vector 0 -1 0\n" + move + run, say),
      1);
  EXPECT_EQ(times_said(fits + "\nvariable g equal 2*time\nfix g all gravity v_g vector 0 -1 0\n" +
                           move + run + "run 1\n",
                       say),
            0);
}

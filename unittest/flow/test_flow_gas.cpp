// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Gas in pockets of fix mpm/incompressible: springs of gas, bubbles, pockets that split and join.

#include "wave_testing.h"

using namespace MPM_TEST;

enum { KINETIC = 5, WALLS = 7 };
/** From the end of the vector, at which there are two entries about parts of steps. */
enum { COUNT = -7, HIGHEST, LOWEST, VOLUME, ENERGY };

double gas(Scene &run, int which)
{
  auto *fix = run.fix("w");
  return fix->compute_vector(fix->size_vector + which);
}

/** Water of density 1 and length 0.4 in a closed tube of length 1, n cells in its width of 0.2. */
std::string slug(int dim, int n, double offset, const std::string &units = "lj")
{
  const double h = 0.2 / n;
  return box(dim, units, "f f f", "0 1 0 0.2 0 0.2", 1, 0.5 * h) +
      strprintf("region w block %.17g %.17g INF INF INF INF\n", 0.3 + offset * h,
                0.7 + offset * h) +
      strprintf("create_points 1 region w spacing %.17g outside ignore\n", 0.5 * h);
}

/** Water between the radii 1 and 2, gas inside and open air outside, blown up at first. */
std::string shell(int dim, int n)
{
  const double h = 1.0 / n;
  const std::string third = dim == 3 ? "+z^2" : "", up = dim == 3 ? "v_uz" : "NULL";
  std::string text = box(dim, "lj", "f f f", "-2.5 2.5 -2.5 2.5 -2.5 2.5", 1, 0.5 * h) +
      "region o sphere 0.013 0.007 0 2\nregion i sphere 0.013 0.007 0 1 side out\n"
      "region w intersect 2 o i\n" +
      strprintf("create_points 1 region w spacing %.17g outside ignore\n", 0.5 * h) +
      "variable f atom 0.02*((x-0.013)^2+(y-0.007)^2" + third + strprintf(")^(-%g)\n", 0.5 * dim) +
      "variable ux atom v_f*(x-0.013)\nvariable uy atom v_f*(y-0.007)\nvariable uz atom v_f*z\n"
      "velocity all set v_ux v_uy " +
      up + "\n";
  return text + strprintf("fix w all mpm/incompressible %.17g 1 gas 1 1.4 open xlo open yhi\n", h);
}

/** A letter U, 1.2 high, its right arm closed; heights of water; n cells in the width of an arm. */
std::string tube(int n, double left, double right)
{
  const double h = 0.4 / n;
  return plane("si", "f f", "0 1 0 1.2", 1, 0.5 * h) +
      "region wall block 0.4 0.6 0.3 INF INF INF\nregion roof block 0.59 INF 0.8 INF INF INF\n"
      "region a block 0.4 0.6 0.3 INF INF INF side out\n"
      "region b block 0.59 INF 0.8 INF INF INF side out\n" +
      strprintf("region left block INF 0.4 INF %.17g INF INF\n", left) +
      strprintf("region right block 0.4 INF INF %.17g INF INF\n", right) +
      "region low union 2 left right\nregion w intersect 3 low a b\n" +
      strprintf("create_points 1 region w spacing %.17g\n", 0.5 * h) +
      strprintf("fix w all mpm/incompressible %.17g 1000 gas 1e4 1.4 open yhi region wall region "
                "roof\n",
                h) +
      "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5 max 0.005\n" +
      strprintf("fix drag all viscous %.17g\n", 750.0 * h * h);
}

/** Half of a box of water that falls to its floor in a closed box, and splashes. */
std::string splash(const std::string &gas_of)
{
  return plane("si", "f f", "0 1 0 0.6", 1, 0.01) +
      "region w block INF 0.3 INF 0.5 INF INF\ncreate_points 1 region w spacing 0.02\n"
      "fix w all mpm/incompressible 0.04 1000 " +
      gas_of + "\nfix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.4 max 0.01\n";
}

// omega^2 = gamma p A (1/l + 1/l) / m, of second order; energy lost: 0.07 omega dt per period
SERIAL_TEST(Slug, Swings)
{
  const double exact = std::sqrt(1.4 * 10.0 * (2.0 / 0.3) / 0.4);
  for (const int dim : {2, 3})
    for (const int n : {4, 8}) {
      if (dim == 3 && n == 8) continue;
      Crossings crossings;
      Scene run(
          slug(dim, n, 0.3) + "velocity all set 0.06 0 0\n" +
          strprintf("fix w all mpm/incompressible %.17g 1 gas 10 1.4\ntimestep 0.004\nrun 1\n",
                    0.2 / n));
      double fastest = 0.0;    // in the last period
      const double volume = gas(run, VOLUME);
      run.each_step([&](double **) {
        crossings.add(run.time(), run.v()[0][0]);
        if (run.time() > 0.75) grow(fastest, run.v()[0][0]);
      });
      run.commands("run 300\n");
      const auto what = strprintf("%dd, %d cells: ", dim, n);
      EXPECT_NEAR(measured(what + "frequency over theory", crossings.frequency() / exact), 1.0,
                  0.01);
      EXPECT_NEAR(measured("speed over that before", fastest / 0.06), 0.983, 0.01);
      EXPECT_EQ(gas(run, COUNT), 2.0);
      EXPECT_NEAR(gas(run, VOLUME), volume, 1e-10 * volume);
    }
}

// steps of five times the period over 2 pi: nothing grows
SERIAL_TEST(Slug, LongSteps)
{
  Scene run(slug(2, 4, 0.3) +
            "velocity all set 0.06 0 0\nfix w all mpm/incompressible 0.05 1 gas 1000 1.4\n"
            "timestep 0.033\nrun 1\n");
  const double before = run.fix("w")->compute_vector(KINETIC) + gas(run, ENERGY);
  run.commands("run 300\n");
  EXPECT_LT(measured("energy over that before",
                     (run.fix("w")->compute_vector(KINETIC) + gas(run, ENERGY)) / before),
            1e-9);
  EXPECT_NEAR(gas(run, HIGHEST), 1000.0, 3e-4);
}

// pressures of gas and of water that it pushes, energies in all units; constant temperature
SERIAL_TEST(Slug, Units)
{
  for (const char *units : {"si", "metal", "real", "lj"})
    for (const double gamma : {1.0, 1.4}) {
      Scene run(slug(2, 4, 0.0, units) +
                strprintf("fix w all mpm/incompressible 0.05 2 gas 10 %g outside 4\n", gamma) +
                "timestep 1e-6\nrun 2\n");
      const double nktv2p = run.lmp->force->nktv2p;
      for (int wall = 0; wall < 2; wall++)
        EXPECT_NEAR(run.fix("w")->compute_vector(WALLS + wall), 6.0 * 0.2 / nktv2p, 1e-11) << units;
      for (int wall = 2; wall < 4; wall++)
        EXPECT_NEAR(run.fix("w")->compute_vector(WALLS + wall), 6.0 / nktv2p, 1e-6 / nktv2p)
            << units;
      EXPECT_NEAR(-run.points().tau[0][0], 6.0, 1e-11) << units;
      EXPECT_NEAR(gas(run, HIGHEST), 10.0, 1e-11);
      EXPECT_NEAR(gas(run, VOLUME), 0.12, 1e-12);
    }
  // all of the work of a piston of water: that of the law, and that against the pressure outside
  for (const double gamma : {1.0, 1.4}) {
    Scene run(slug(2, 4, 0.0) + "velocity all set 1 0 0\n" +
              strprintf("fix w all mpm/incompressible 0.05 1 gas 10 %g outside 4\n", gamma) +
              "timestep 0.0005\nrun 1\n");
    const double before = run.fix("w")->compute_vector(KINETIC) + gas(run, ENERGY);
    run.commands("run 120\n");
    EXPECT_GT(gas(run, ENERGY), 0.1 * before);
    EXPECT_NEAR(measured("energy over that before",
                         (run.fix("w")->compute_vector(KINETIC) + gas(run, ENERGY)) / before),
                1.0, 0.01);
  }
}

// a region feels the gas, wherever in a cell it begins, and next to water the water
SERIAL_TEST(Slug, OnRegion)
{
  for (const double place : {0.9, 0.92, 0.93, 0.72}) {
    Scene run(slug(2, 4, 0.0) + strprintf("region end block %g INF INF INF INF INF\n", place) +
              "fix w all mpm/incompressible 0.05 1 gas 10 1.4 outside 4 region end\n"
              "timestep 1e-6\nrun 2\n");
    auto *fix = run.fix("w");
    EXPECT_NEAR(measured(strprintf("at %g: force over pressure times area", place),
                         fix->compute_vector(14) / 1.2),
                1.0, 1e-12);
    EXPECT_NEAR(fix->compute_vector(15), 0.0, 1e-12);
    if (place > 0.8) EXPECT_NEAR(gas(run, VOLUME), 0.2 * (0.3 + place - 0.7), 1e-3);
  }
}

// omega^2 = 2 gamma p / (rho a^2 ln(b/a)) in 2d, 3 gamma p / (rho a^2 (1 - a/b)) in 3d
SERIAL_TEST(Bubble, InAShell)
{
  for (const int dim : first_of(1, {2, 3}))
    for (const int n : first_of(1, {8, 16})) {
      if (dim == 3 && n == 16) continue;
      const double exact = dim == 2 ? std::sqrt(2.8 / std::log(2.0)) : std::sqrt(4.2 / 0.5);
      Crossings crossings;
      Scene run(shell(dim, dim == 2 ? n : 6) + "timestep 0.05\n");
      run.each_step([&](double **) {
        double sum = 0.0;
        for (int i = 0; i < run.n(); i++)
          for (int d = 0; d < dim; d++) sum += run.v()[i][d] * run.x()[i][d];
        crossings.add(run.time(), sum);
      });
      run.commands(dim == 2 ? "run 120\n" : "run 50\n");
      EXPECT_NEAR(measured(strprintf("%dd, %d cells: frequency over theory", dim, dim == 2 ? n : 6),
                           crossings.frequency() / exact),
                  1.0, dim == 2 ? 0.01 : 0.02);
      EXPECT_EQ(gas(run, COUNT), 1.0);
    }
}

// with a tension the pressure in a bubble is higher by sigma/R than around it
SERIAL_TEST(Bubble, Tension)
{
  Scene run(
      plane("lj", "p p", "-2 2 -2 2", 1, 0.05) +
      "region w sphere 0.01 0.02 0 1 side out\ncreate_points 1 region w spacing 0.0625 outside "
      "ignore\nfix w all mpm/incompressible 0.125 1 tension 1 viscosity 0.1 gas 10 1.4 outside 8\n"
      "timestep 0.002\nrun 50\n");
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (std::hypot(run.x()[i][0], run.x()[i][1]) > 1.5) {
      sum -= run.points().tau[i][0];
      n += 1.0;
    }
  EXPECT_NEAR(measured("pressure around", sum / n), gas(run, HIGHEST) - 8.0 - 1.0, 0.01);
}

// at rest: p V^gamma as before, and a head of p - p_0
SERIAL_TEST(Tube, AtRest)
{
  double x = 0.0;    // by which the water of the arms moves
  for (double step = 0.05; step > 1e-12; step *= 0.5)
    if (1e4 * (std::pow(0.12 / (0.12 - 0.4 * (x + step)), 1.4) - 1.0) <
        9810.0 * (0.2 - 2.0 * (x + step)))
      x += step;
  const double exact = 1e4 * std::pow(0.12 / (0.12 - 0.4 * x), 1.4);
  for (const int n : first_of(1, {8, 16})) {
    Scene run(tube(n, 0.7, 0.5) + "run 1000\n");
    const double p = gas(run, HIGHEST);
    EXPECT_NEAR(measured(strprintf("%d cells: pressure over theory", n), p / exact), 1.0, 0.001);
    EXPECT_EQ(gas(run, COUNT), 1.0);
    EXPECT_NEAR(p * std::pow(gas(run, VOLUME) / 0.12, 1.4), 1e4, 1e-8);
    EXPECT_NEAR(measured("volume over theory", gas(run, VOLUME) / (0.12 - 0.4 * x)), 1.0, 0.001);
  }
}

// at rest: the head between the levels in and around a bell, and its lift, of gas and walls
SERIAL_TEST(Bell, Lift)
{
  Scene run(
      plane("si", "f f", "0 1 0 1", 1, 0.01) +
      "region l block 0.3 0.36 0.2 0.66 INF INF\nregion r block 0.64 0.7 0.2 0.66 INF INF\n"
      "region t block 0.3 0.7 0.6 0.66 INF INF\nregion bell union 3 l r t\n"
      "region in block 0.3 0.7 0.2 0.66 INF INF side out\n"
      "region below block 0.36 0.64 INF 0.3 INF INF\nregion low block INF INF INF 0.8 INF INF\n"
      "region out intersect 2 in low\nregion water union 2 out below\n"
      "create_points 1 region water spacing 0.01\n"
      "fix w all mpm/incompressible 0.02 1000 gas 1e4 1.4 open yhi region bell\n"
      "fix g all gravity 9.81 vector 0 -1 0\nfix drag all viscous 0.5\n"
      "fix dt all mpm/dt 0.5 max 0.005\nrun 400\n");
  const double V = gas(run, VOLUME), z = 0.6 - V / 0.28, level = 0.8 - 0.28 * (z - 0.3);
  EXPECT_NEAR(
      measured("pressure over that of the head", gas(run, HIGHEST) / (1e4 + 9810.0 * (level - z))),
      1.0, 0.01);
  EXPECT_NEAR(measured("lift over the weight of water",
                       run.fix("w")->compute_vector(15) / (9810.0 * (0.072 + V))),
              1.0, 0.04);
}

// a point of spray has the pressure of the air in which it is, closed in or open
SERIAL_TEST(Spray, HasThePressureOfItsPocket)
{
  for (const char *const faces : {"", " open yhi"}) {
    Scene run(plane("si", "f f", "0 1 0 1", 1, 0.01) +
              "region low block INF INF INF 0.3 INF INF\n"
              "region drop block 0.5 0.525 0.8 0.825 INF INF\nregion w union 2 low drop\n"
              "create_points 1 region w spacing 0.025\n"
              "fix w all mpm/incompressible 0.05 1000 gas 1.5e5 1.4 outside 1e5" +
              std::string(faces) +
              "\nfix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5 max 0.005\n"
              "compute p all mpm/atom pressure\nthermo_style custom step\nrun 20\n");
    const double exact = *faces ? 0.0 : gas(run, HIGHEST) - 1e5;
    auto *pressure = run.per_atom("p");
    const double *const p = pressure->vector_atom;
    int spray = 0;
    for (int i = 0; i < run.n(); i++) {
      if (run.x()[i][1] < 0.5) continue;
      spray++;
      EXPECT_NEAR(measured("pressure of spray", p[i]), exact, 1e-7);
    }
    EXPECT_EQ(spray, 1);
  }
}

// pockets come and go, and the gas of a closed box stays what it was
SERIAL_TEST(Splash, KeepsGas)
{
  Scene run(splash("gas 1e5 1.4"));
  double most = 0.0, wrong = 0.0;
  run.each_step([&](double **) {
    most = std::max(most, gas(run, COUNT));
    grow(wrong, gas(run, VOLUME) / 0.45 - 1.0);
  });
  run.commands("run 700\n");
  EXPECT_GT(measured("most pockets", most), 1.0);
  EXPECT_LT(measured("volume over that of the box without water, minus one", wrong), 0.005);
  // in the mean the amount of gas is what it was
  EXPECT_NEAR(measured("pressure", gas(run, LOWEST)), 1e5, 1e3);
  EXPECT_NEAR(gas(run, HIGHEST), 1e5, 1e3);
}

// a lid of water falls on two columns: open air between them has the pressure outside
SERIAL_TEST(Pocket, TakesAirFromOutside)
{
  Scene run(plane("lj", "f f", "0 1 0 1.2", 1, 0.02) +
            "region low block INF INF INF 0.2 INF INF\nregion l block INF 0.3 INF 0.6 INF INF\n"
            "region r block 0.7 INF INF 0.6 INF INF\nregion lid block INF INF 0.7 0.9 INF INF\n"
            "region w union 4 low l r lid\ncreate_points 1 region w spacing 0.025\n"
            "group lid region lid\nvelocity lid set 0 -1 0\n"
            "fix w all mpm/incompressible 0.05 1 gas 20 1.4 outside 10 open xlo open yhi\n"
            "fix dt all mpm/dt 0.3 every 1 max 0.005\nrun 0\n");
  EXPECT_EQ(gas(run, COUNT), 0.0);
  double most = 0.0;
  run.each_step([&](double **) {
    most = std::max(most, gas(run, HIGHEST));
  });
  run.commands("run 50\n");
  EXPECT_EQ(gas(run, COUNT), 1.0);
  EXPECT_GT(measured("highest pressure", most), 10.5);
  const double at_first = gas(run, VOLUME) * std::pow(gas(run, HIGHEST) / 10.0, 1.0 / 1.4);
  // a gap of less than a cell counts as closed
  EXPECT_NEAR(measured("volume of the air with the pressure outside", at_first), 0.19, 0.035);
}

// water is shot out of a tube between two rooms with gas of different pressures: the pocket that
// they become has the gas of both, p V^gamma of which is what it was
SERIAL_TEST(Pocket, OfSeveralHasTheirGas)
{
  for (const double gamma : {1.0, 1.4}) {
    Scene run(plane("lj", "f f", "0 1 0 0.4", 1, 0.02) +
              "region l block 0.3 0.6 INF 0.1 INF INF\nregion u block 0.3 0.6 0.3 INF INF INF\n"
              "region walls union 2 l u\nregion w block 0.4 0.5 0.1 0.3 INF INF\n"
              "create_points 1 region w spacing 0.025\nvelocity all set 1 0 0\n" +
              strprintf("fix w all mpm/incompressible 0.05 1 gas 0.3 %g region walls\n", gamma) +
              "timestep 0.005\nrun 1\n");
    const double before = gas(run, VOLUME);
    EXPECT_EQ(gas(run, COUNT), 2.0);
    double ratio = 1.0;
    for (int k = 0; k < 100 && gas(run, COUNT) == 2.0; k++) {
      ratio = gas(run, HIGHEST) / gas(run, LOWEST);
      run.commands("run 1\n");
    }
    EXPECT_GT(measured("ratio of pressures", ratio), 1.3);
    EXPECT_EQ(gas(run, COUNT), 1.0);
    EXPECT_NEAR(
        measured("gas over that before",
                 gas(run, VOLUME) * std::pow(gas(run, HIGHEST) / 0.3, 1.0 / gamma) / before),
        1.0, 1e-9);
  }
}

// on four ranks, balanced; and the same to the last bit from a restart file
TEST(Gas, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const auto scene = box(dim, "lj", "f f p", "0 1 0 1 0 0.5", 1, 0.02) +
        "region air sphere 0.5 0.4 0.25 0.2 side out\nregion low block INF INF INF 0.8 INF INF\n"
        "region post block 0.87 INF INF INF INF INF\n"
        "region free block 0.87 INF INF INF INF INF side out\nregion d intersect 3 air low free\n" +
        strprintf("create_points 1 region d spacing %g\n", 0.5 * h) + "velocity all set 1 0 0\n";
    const auto fixes =
        strprintf("fix w all mpm/incompressible %g 1 tolerance 1e-12 gas 20 1.4 outside 10 open "
                  "yhi region post\n",
                  h) +
        "fix g all gravity 4 vector 0 -1 0\nfix dt all mpm/dt 0.3 every 1 max 0.01\n"
        "timestep 0.002\n";
    OnRanks run(scene + fixes, "run 20\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    EXPECT_EQ(gas(run.serial, COUNT), gas(run.parallel, COUNT));
    EXPECT_NEAR(gas(run.serial, HIGHEST), gas(run.parallel, HIGHEST), 1e-11);
    Continued again(scene + fixes, 9,
                    "neighbor 0.02 bin\nregion post block 0.87 INF INF INF INF INF\n" + fixes, 14);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    EXPECT_EQ(gas(again.whole, HIGHEST), gas(again.again, HIGHEST));
    EXPECT_EQ(gas(again.whole, VOLUME), gas(again.again, VOLUME));
  }
}

SERIAL_TEST(Gas, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) +
      "region l block INF INF INF 0.5 INF INF\ncreate_points 1 region l spacing 0.05\n"
      "variable s equal 0.01*time\nregion lid block 0.2 0.4 0.7 0.9 INF INF move v_s NULL NULL\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "gas", "gas"},
                  {fix + "gas 1e5", "gas"},
                  {fix + "gas 0 1.4", "gas"},
                  {fix + "gas -1e5 1.4", "gas"},
                  {fix + "gas 1e5 0.9", "gas"},
                  {fix + "gas 1e5 nan", "nan"},
                  {fix + "gas 1e5 1.4 gas 1e5 1.4", "gas"},
                  {fix + "gas 1e5 1.4 outside 0", "outside"},
                  {fix + "outside 1e5", "add the keyword gas"},
                  {fix + "open yhi", "add the keyword gas"},
                  {fix + "gas 1e5 1.4 open top", "open"},
                  {fix + "gas 1e5 1.4 open xlo", "use boundary f"},
                  {fix + "gas 1e5 1.4 viscosity 1 implicit yes", "leave gas out"},
                  {fix + "gas 1e5 1.4 reflect 0.5", "leave one of them out"},
                  {fix + "gas 1e5 1.4 liquid all 900", "leave one of them out"},
                  {fix + "gas 1e5 1.4 region lid", "cannot be used with regions that move"}},
                 "run 1\n");
}

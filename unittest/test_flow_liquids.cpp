// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Liquids of several densities in fix mpm/incompressible: layers at rest, waves between them, and layers that turn over.

#include "mpm_lammps.h"

#include "group.h"

using namespace MPM_TEST;

namespace {

enum { ITERATIONS = 0, FILLED = 3, FASTEST = 6, YLO = 9 };

/** A closed square of two layers, whose interface has the shape a cos(pi x); the lower one has the density below. */
std::string layers(int n, double below, double above, double a)
{
  const double s = 2.0 * std::sinh(PI / 2);
  return plane("si", "f f", "0 1 0 1", 1, 0.01) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 / n) +
      "region low block INF INF INF 0.5 INF INF\ngroup low region low\ngroup high subtract all "
      "low\nvariable low atom y<0.5\nvariable z atom v_low*y+(1-v_low)*(1-y)\n" +
      strprintf("variable up atom %.17g*cos(PI*x)*(exp(PI*v_z)-exp(-PI*v_z))\n", a / s) +
      strprintf("variable side atom %.17g*sin(PI*x)*(1-2*v_low)*(exp(PI*v_z)+exp(-PI*v_z))\n",
                a / s) +
      "displace_atoms all move v_side v_up 0\n" +
      strprintf("fix w all mpm/incompressible %.17g %.17g reflect 0.8 liquid high %.17g\n", 1.0 / n,
                below, above) +
      "fix g all gravity 9.81 vector 0 -1 0\n";
}

/** Circular frequency of the interface; imaginary, if the heavy liquid is above. */
double frequency(double below, double above)
{
  return std::sqrt(9.81 * PI * std::fabs(below - above) / (below + above) * std::tanh(PI / 2));
}

double amplitude(Scene &run)    // of the lower liquid
{
  const int low = run.lmp->group->bitmask[run.lmp->group->find("low")];
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.lmp->atom->mask[i] & low) sum += run.x()[i][1] * std::cos(PI * run.x()[i][0]);
  return sum;
}

/** Frequency of a wave over theory, from two times at which it is flat. */
double wave(int n, double below, double above)
{
  const double w = frequency(below, above), dt = 2.0 * PI / (200.0 * w);
  Scene run(layers(n, below, above, 0.02) + strprintf("timestep %.17g\n", dt));
  std::vector<double> zeros;
  double before = 0.0;
  run.each_step([&](double **) {
    const double now = amplitude(run);
    if (before * now < 0.0) zeros.push_back(run.time() - dt * now / (now - before));
    before = now;
  });
  run.commands("run 165\n");
  EXPECT_EQ(zeros.size(), 2u);
  return measured(strprintf("%d cells, %g to %g: frequency over theory", n, below, above),
                  PI / (zeros.back() - zeros.front()) / w);
}

}    // namespace

// oil over water at rest, with a free surface: what both weigh is on the floor
SERIAL_TEST(Liquids, AtRest)
{
  for (const int dim : {2, 3}) {
    Scene run(box(dim, "si", dim == 3 ? "f f p" : "f f", dim == 3 ? "0 1 0 1 0 0.2" : "0 1 0 1", 1,
                  0.01) +
              "region d block INF INF INF 0.8375 INF INF\ncreate_points 1 region d spacing 0.025\n"
              "region high block INF INF 0.43 INF INF INF\ngroup oil region high\n"
              "fix w all mpm/incompressible 0.05 1000 liquid oil 850 tolerance 1e-12\n"
              "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.01\n" +
              std::string(dim == 2 ? "run 300\n" : "run 3\n"));
    double top = 0.0;
    for (int i = 0; i < run.n(); i++) top = std::max(top, run.x()[i][1]);
    const double weight = 9.81 * (1000.0 * 0.425 + 850.0 * (top + 0.0125 - 0.425));
    EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 1e-10);
    EXPECT_NEAR(run.fix("w")->compute_vector(YLO) / (weight * (dim == 3 ? 0.2 : 1.0)), 1.0, 1e-9);
  }
}

// waves between two layers: the interface is as thick as a cell, an error of first order
SERIAL_TEST(Liquids, Waves)
{
  const double coarse = 1.0 - wave(20, 1000.0, 850.0), fine = 1.0 - wave(40, 1000.0, 850.0);
  EXPECT_LT(std::fabs(coarse), 0.05);
  EXPECT_GT(measured("order", std::log2(coarse / fine)), 0.9);
  EXPECT_NEAR(wave(20, 1000.0, 1.0), 1.0, 0.02);
  EXPECT_NEAR(wave(20, 1.0, 1e-3), 1.0, 0.02);    // of any unit
}

// Rayleigh and Taylor: a heavy liquid above a light one, growth as long as the amplitude is small
SERIAL_TEST(Liquids, TurnOver)
{
  const double w = frequency(1.0, 3.0);
  Scene run(layers(20, 1.0, 3.0, 0.005) + strprintf("timestep %.17g\n", 0.01 / w));
  const double before = amplitude(run);
  run.commands("run 200\n");
  EXPECT_NEAR(measured("rate over theory", std::acosh(amplitude(run) / before) / 2.0), 1.0, 0.05);
}

// a column of water collapses under a fluid that is a thousand times lighter: its energy never grows
SERIAL_TEST(Liquids, LightAndHeavy)
{
  Scene run(plane("si", "f f", "0 1 0 1", 1, 0.02) +
            "create_points 1 box spacing 0.025\nregion low block INF 0.4 INF 0.6 INF INF\n"
            "group low region low\ngroup air subtract all low\n"
            "fix w all mpm/incompressible 0.05 1000 liquid air 1\n"
            "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.4 max 0.01\nrun 0\n");
  double before = 1e30, most = 0.0, iterations = 0.0;
  run.each_step([&](double **) {
    double now = 0.0;
    for (int i = 0; i < run.n(); i++)
      now += run.lmp->atom->rmass[i] *
          (0.5 * (std::pow(run.v()[i][0], 2) + std::pow(run.v()[i][1], 2)) + 9.81 * run.x()[i][1]);
    most = std::max(most, now / before - 1.0);
    before = now;
    iterations = std::max(iterations, run.fix("w")->compute_vector(ITERATIONS));
  });
  run.commands("run 150\n");
  EXPECT_LT(measured("largest growth of the energy in a step", most), 0.002);
  EXPECT_NEAR(measured("volume", run.fix("w")->compute_vector(FILLED)), 1.0, 0.03);
  EXPECT_LT(measured("iterations", iterations), 40.0);
  EXPECT_LT(measured("speed", run.fix("w")->compute_vector(FASTEST)), 20.0);
}

// on four ranks, balanced; and the same to the last bit from a restart file
TEST(Liquids, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const auto scene = box(dim, "si", dim == 3 ? "f f p" : "f f",
                           dim == 3 ? "0 1 0 1 0 0.4" : "0 1 0 1", 1, 0.02) +
        "region d block INF INF INF 0.81 INF INF\n" +
        strprintf("create_points 1 region d spacing %g\n", 0.5 * h) +
        "region low block INF 0.4 INF 0.6 INF INF\ngroup low region low\ngroup high subtract all "
        "low\n";
    const auto fixes = strprintf("fix w all mpm/incompressible %g 1000 tolerance 1e-11 liquid high "
                                 "100\n",
                                 h) +
        "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.003\n";
    OnRanks run(scene + fixes, "run 15\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-9);
    Continued again(scene + fixes, 6, "neighbor 0.02 bin\n" + fixes, 12);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

SERIAL_TEST(Liquids, BadInput)
{
  const auto plain = plane("si", "p f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.05\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(plain,
                 {{fix + "liquid", "liquid"},
                  {fix + "liquid all", "liquid"},
                  {fix + "liquid none 800", "group none does not exist"},
                  {fix + "liquid all 0", "0"},
                  {fix + "liquid all nan", "nan"},
                  {fix + "liquid all 800 viscosity 1", "leave one of them out"},
                  {fix + "liquid all 800 tension 1", "leave one of them out"}},
                 "timestep 0.001\nrun 1\n");

  // a group that is empty, as its points were made later, is told of once; one that has some is not
  const std::string last = " 800\ntimestep 0.001\nrun 1\nrun 1\n",
                    say = "keyword liquid has no points of this fix";
  EXPECT_EQ(lines_that_say(plain + "group oil empty\n" + fix + "liquid oil" + last, say).size(),
            1u);
  EXPECT_EQ(lines_that_say(plain + "group oil id 1\n" + fix + "liquid oil" + last, say).size(), 0u);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 200

// Fix mpm/pore with drag that has the square of the flow.

#include "grains/mpm_drag.h"
#include "pore/pore_testing.h"

using namespace MPM_TEST;

constexpr double A =
    1e7;    // Darcy: pressure gradient per flow, k = 1e-3 with a unit weight of 1e4

/** Flow with i = A w + b w^2, with the sign of i. */
double flow_by(double i, double b)
{
  return 2.0 * i / (A + std::sqrt(A * A + 4.0 * b * std::fabs(i)));
}

/** A column between two pressures whose soil is too heavy to move. */
std::string stiff(const std::string &options, double bottom, double top, double offset)
{
  return column(
             10,
             strprintf("2.2e7 1000 1e4 soil m 0.4 constant 1e-3 yhi pressure %g ylo pressure %g ",
                       top, bottom) +
                 options,
             "density 2e16 linear 1e12 0.0", 1.0, offset, "ylo yhi") +
      "timestep 4e-4\n";
}

// steady flow solves the quadratic equation, up and down, with and without inertia
SERIAL_TEST(Steady, IsTheRoot)
{
  for (const char *form : {"u-p", "u-v-p"})
    for (const double p : first_of(2, {1e4, -1e4, 3e2}))
      for (const double offset : first_of(1, {0.3, 0.0})) {
        Scene run(
            stiff(std::string("forchheimer number 1e10 formulation ") + form, p, 0.0, offset));
        run.commands("run 4000\n");
        const double *const flows = run.fix_vector("water", 7), w = flow_by(p, 1e10);
        // between nodes, surfaces of u-p are where sums over points see them
        const double error = offset > 0.0 && form[2] == 'p' ? 1e-3 : 1e-6;
        EXPECT_NEAR(
            measured(strprintf("%s, p %g, offset %g, in", form, p, offset), flows[2] / (0.4 * w)),
            1.0, error);
        EXPECT_NEAR(flows[3] / (0.4 * w), -1.0, error);
      }
}

// a soil that can dry and touches no face changes nothing; the sides of a body lack some area
SERIAL_TEST(Steady, BesideSoilThatDries)
{
  for (const double b : first_of(1, {1e10, 1e8})) {
    double in[2], out[2];
    for (const bool other : {false, true}) {
      const std::string dry = "soil o 0.4 constant 1e-3 retention vangenuchten 1e-4 1.6 ";
      Scene run(plane("si", "p f", "0 1.2 0 1", 1, 0.03) +
                "region soil block 0 0.4 0 1 INF INF\nregion other block 0.7 0.9 0.3 0.7 INF INF\n"
                "create_points 1 region soil spacing 0.05\ngroup soil region soil\n"
                "create_points 1 region other spacing 0.05\ngroup other region other\n"
                "fix grid all mpm 0.1\nfix m soil mpm/material density 2e16 linear 1e12 0.0\n"
                "fix o other mpm/material density 2e16 linear 1e12 0.0\n"
                "fix floor all mpm/boundary ylo yhi slip\n" +
                strprintf("fix water all mpm/pore 2.2e7 1000 1e4 soil m 0.4 constant 1e-3 "
                          "forchheimer number %g ",
                          b) +
                (other ? dry : "") + "yhi pressure 0 ylo pressure 1e4\ntimestep 4e-4\nrun 4000\n");
      const double *const flows = run.fix_vector("water", 7);
      in[other] = flows[2];
      out[other] = flows[3];
    }
    EXPECT_NEAR(measured(strprintf("b %g, flow", b), in[1] / (0.4 * flow_by(1e4, b))), 1.0, 0.01);
    EXPECT_NEAR(measured("in, over that without", in[1] / in[0]), 1.0, 1e-12);
    EXPECT_NEAR(measured("out, over that without", out[1] / out[0]), 1.0, 1e-12);
  }
}

// the coefficient of Ergun's law is that of the drag on spheres in fix mpm/mixture and mpm/immersed
SERIAL_TEST(Steady, Ergun)
{
  const double d = 2e-3, n = 0.4, mu = 1e-3;
  const MPM_NS::SphereDrag law = {MPM_NS::SphereDrag::ERGUN, 1000.0, mu};
  const double number = 6.0 * (1.0 - n) / (PI * d * d * d), w = 0.05;
  const double b = MPM_NS::SphereDrag::bed_inertia(1000.0, d, n);
  EXPECT_NEAR(number * law.on_sphere(d, w, n, 1.0) * w /
                  (150.0 * mu * (1 - n) * (1 - n) / (n * n * n * d * d) * w + b * w * w),
              1.0, 1e-13);
  Scene run(stiff("forchheimer ergun 2e-8", 2e4, 0.0, 0.0));
  run.commands("timestep 1e-3\nrun 10000\n");
  EXPECT_NEAR(measured("Ergun", run.fix_vector("water", 7)[2] / (0.4 * flow_by(2e4, b * 1e5))), 1.0,
              2e-7);
}

// the weight of water drives as a gradient of pressure does
SERIAL_TEST(Steady, Weight)
{
  Scene run(replaced(
      column(10,
             "2.2e7 1000 1e4 soil m 0.4 constant 1e-3 yhi pressure 0 ylo pressure 0 initial v_p "
             "forchheimer number 1e10",
             "density 2000 linear 1e9 0.0", 1.0, 0.2, "ylo yhi"),
      "fix water", "fix g all gravity 10.0 vector 0 -1 0\nvariable p atom 1e4*(1-y)\nfix water"));
  run_until(run, 0.4);
  EXPECT_NEAR(measured("flow", run.fix_vector("water", 7)[2] / (0.4 * flow_by(-1e4, 1e10))), 1.0,
              1e-3);
}

// water is kept, also while the flow changes
SERIAL_TEST(Water, IsKept)
{
  for (const char *form : {"u-p", "u-v-p"})
    expect_water_is_kept(column(10,
                                std::string("2.2e8 1000 9810 soil m 0.4 kozeny 1e-2 forchheimer "
                                            "ergun 1e-4 free pressure 0 formulation ") +
                                    form,
                                SOIL, 1.2, 0.2),
                         3000, 1e-6);
}

// units in which mass, energy, and pressure do not fit together
SERIAL_TEST(Units, Metal)
{
  LONG_CASE();
  const double unit = 1.0364269e-4 * 1.6021765e6, d = 270.0, k = 0.1, p = 2e3;
  for (const char *form : {"u-p", "u-v-p"}) {
    Scene run(plane("metal", "p f", "0 20 0 100 -2.5 2.5", 1, 1.5) +
              "region soil block 0 20 0 100 INF INF\ncreate_points 1 region soil spacing 2.5\n"
              "fix grid all mpm 5.0\nfix m all mpm/material density 1e12 linear 1e9 0.0\n"
              "fix floor all mpm/boundary ylo yhi slip\n"
              "fix water all mpm/pore 2e5 0.5 1.0 soil m 0.4 constant 0.1 ylo pressure 2e3 "
              "yhi pressure 0 forchheimer ergun 270 formulation " +
              form + "\ntimestep 0.05\nrun 12000\n");
    const double b = 1.75 * 0.5 * unit * 0.6 / (d * 0.064), i = p / 100.0;
    const double w = 2.0 * i * k / (1.0 + std::sqrt(1.0 + 4.0 * b * i * k * k));
    EXPECT_GT(measured("quadratic part", b * w * w / i), 0.2);
    EXPECT_NEAR(measured(form, run.fix_vector("water", 7)[2] / (20.0 * w)), 1.0, 1e-8);
  }
}

const char *const FREE = "initial v_p free pressure 0 forchheimer number 50 ",
                  *const MOVES = "formulation u-v-p ";

TEST(Ranks, Agree)
{
  OnRanks run(blocks(FREE) + PORE, "run 300\n");
  EXPECT_LT(run.difference(), 1e-11);
  expect_same_on_ranks(
      between_walls(blocks(std::string(FREE) + MOVES + "xlo pressure 1.0 ylo flux 0.01")), 1e-10);
}

// two soils of different drag, which touch
TEST(Restart, Continues)
{
  for (const char *formulation : {"", MOVES})
    expect_continues(blocks(std::string(FREE) + formulation), OF_BLOCKS);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string plain = plane("si", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 2000 linear 1e7 0.3\ntimestep 1e-5\n";
  const std::string water = "fix water all mpm/pore 2e7 1000 9810 ",
                    soil = "soil m 0.4 constant 1e-5 ";
  expect_refused(plain,
                 {{water + "forchheimer number 1 " + soil, "needs a soil before it"},
                  {water + soil + "forchheimer 1", "must be one of number ergun"},
                  {water + soil + "forchheimer number -1", "b"},
                  {water + soil + "forchheimer ergun 0", "d"}},
                 "run 1\n");
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 200

// Fix mpm/pore in soils of different permeability that share a lattice.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

struct Layer {
  std::string region;
  std::string law;    ///< of its permeability
};

/** Soil of length 1 along x that is too heavy to move, whose pores store 1, between pressures of 1
 *  and 0 at its ends; n cells long. offset: of its ends from nodes, in cells. */
std::string plate(int n, const std::vector<Layer> &layers, double width, double offset,
                  const std::string &water = "xlo pressure 1.0 xhi pressure 0.0 stages 100")
{
  const double h = 1.0 / n;
  std::string text =
      plane("lj", "f p", strprintf("0 1 0 %.17g", width), (int) layers.size(), 0.1 * h);
  std::string materials, soils;
  for (std::size_t k = 0; k < layers.size(); k++) {
    const int type = (int) k + 1;
    text +=
        strprintf("region r%d %s\ncreate_points %d region r%d spacing %.17g\ngroup g%d type %d\n",
                  type, layers[k].region.c_str(), type, type, 0.5 * h, type, type);
    materials += strprintf("fix m%d g%d mpm/material density 1e12 linear 1.0 0.0\n", type, type);
    soils += strprintf("soil m%d 0.4 %s ", type, layers[k].law.c_str());
  }
  return text + strprintf("fix grid all mpm %.17g origin %.17g 0\n", h, -offset * h) + materials +
      "fix water all mpm/pore 0.4 1.0 1.0 " + soils + water + "\n";
}

/** Flow through the plate in its steady state. */
double flow(Scene &run, double dt, double end)
{
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, (int) std::ceil(end / dt)));
  const double *const flows = run.fix_vector("water", 7);
  EXPECT_NEAR(flows[0] / flows[1], -1.0, 1e-4);
  return flows[0];
}

// layers of a tenth and a hundredth of the permeability in a row: the resistance of all
SERIAL_TEST(Layers, InSeries)
{
  for (const double most : {1.0, 10.0})
    for (const double offset : first_of(1, {0.25, 0.0, 0.5})) {
      double error[2];
      for (const int n : {10, 20}) {
        Scene run(plate(n,
                        {{"block 0 0.5 INF INF INF INF", strprintf("constant %g", most)},
                         {"block 0.5 1 INF INF INF INF", "constant 0.1"}},
                        4.0 / n, offset));
        const double q = flow(run, 5.0 / (n * n) / most, 4.0) * n / 4.0 * (0.5 / most + 5.0);
        error[n == 20] = std::fabs(
            measured(strprintf("ratio %g, offset %g, %d cells", 10.0 * most, offset, n), q) - 1.0);
      }
      EXPECT_LT(error[0], 0.01);
      EXPECT_LT(error[1], 0.005);
    }
}

// the same with the inertia of the water, with drag by the square of the flow (in one layer, in
// both, and both laws alike but for it), and with soils that can dry, whose pores are full here
SERIAL_TEST(Layers, InSeriesWithOtherLaws)
{
  struct Case {
    const char *name, *first, *second, *more;
    double dt, end;    // time step for 10 cells
    double exact;
  };
  // 0.5 (w/k + b w^2) of both is 1
  const auto root = [](double a, double b) {
    return 2.0 / (a + std::sqrt(a * a + 4.0 * b));
  };
  const double drag = 0.5 * (10.0 + 100.0);
  const Case cases[] = {
      {"u-v-p", "constant 0.2", "constant 0.02", "formulation u-v-p", 0.03, 60.0, 2.0 / drag},
      {"forchheimer", "constant 0.1 forchheimer number 1000", "constant 0.01", "stages 100", 1.0,
       80.0, root(drag, 500.0)},
      {"both", "constant 0.1 forchheimer number 100", "constant 0.1 forchheimer number 2000",
       "stages 100", 1.0, 130.0, root(10.0, 1050.0)},
      {"u-v-p and forchheimer", "constant 0.2 forchheimer number 1000", "constant 0.02",
       "formulation u-v-p", 0.03, 60.0, root(0.5 * drag, 500.0)},
      {"retention", "constant 0.1 retention gardner 1.0", "constant 0.01 retention gardner 1.0",
       "stages 100 initial 0.1", 0.1, 80.0, 1.0 / drag},
  };
  for (const auto &c : cases)
    for (const double offset : first_of(1, {0.3, 0.0, 0.5})) {
      double error[2];
      for (const int n : first_of(1, {10, 20})) {
        Scene run(plate(
            n,
            {{"block 0 0.5 INF INF INF INF", c.first}, {"block 0.5 1 INF INF INF INF", c.second}},
            4.0 / n, offset, std::string("xlo pressure 1.0 xhi pressure 0.0 ") + c.more));
        const double q = flow(run, c.dt * 10.0 / n, c.end) * n / 4.0 / c.exact;
        error[n == 20] =
            std::fabs(measured(strprintf("%s, offset %g, %d cells", c.name, offset, n), q) - 1.0);
      }
      EXPECT_LT(error[0], 0.005);
      if (!is_quick()) EXPECT_LT(error[1], 0.0025);
    }
}

// beside each other, each lets through what it does alone
SERIAL_TEST(Layers, InParallelWithOtherLaws)
{
  for (const char *more : first_of(1, {"stages 100", "formulation u-v-p"}))
    for (const double offset : first_of(1, {0.5, 0.0})) {
      Scene run(plate(12,
                      {{"block INF INF 0 0.5 INF INF", "constant 0.1 forchheimer number 1000"},
                       {"block INF INF 0.5 1 INF INF", "constant 0.01"}},
                      1.0, offset, std::string("xlo pressure 1.0 xhi pressure 0.0 ") + more));
      const double exact = 0.5 * (2.0 / (10.0 + std::sqrt(100.0 + 4.0 * 1000.0)) + 0.01);
      EXPECT_NEAR(measured(strprintf("%s, offset %g", more, offset),
                           flow(run, more[0] == 's' ? 0.5 : 0.025, 200.0) / exact),
                  1.0, 1e-3);
    }
}

// the same as values of a variable in one soil, and with one that no water goes through
SERIAL_TEST(Layers, OfAFormula)
{
  const int n = 10;
  const double offset = 0.25, dt = 5.0 / (n * n);
  const auto with = [&](const char *k) {
    return replaced(plate(n, {{"whole", "formula v_k"}}, 4.0 / n, offset), "fix grid",
                    strprintf("variable k atom %s\nfix grid", k));
  };
  const auto layered = [&](const std::string &scene) {
    return replaced(scene, "region r1 whole", "region r1 block 0 1 INF INF INF INF");
  };
  Scene run(layered(with("1.0-0.9*(x>0.5)")));
  EXPECT_NEAR(measured("flow", flow(run, dt, 15.0) * n / 4.0 * 5.5), 1.0, 0.01);
  Scene closed(layered(with("(x<0.5)")));
  closed.commands(strprintf("timestep %.17g\nrun 1000\n", 0.1 * dt));
  // points next to it take the pressure of nodes at a fifth of the rate of waves of speed 1e-6
  EXPECT_NEAR(measured("closed", closed.fix_vector("water", 7)[0] * n / 4.0), 0.0, 0.2 * 1e-6);
}

// layers beside each other let through what each of them does
SERIAL_TEST(Layers, InParallel)
{
  for (const double offset : {0.0, 0.5}) {
    Scene run(plate(12,
                    {{"block INF INF 0 0.5 INF INF", "constant 10"},
                     {"block INF INF 0.5 1 INF INF", "constant 1"}},
                    1.0, offset));
    EXPECT_NEAR(measured("flow", flow(run, 0.005, 2.0)) / 5.5, 1.0, 5e-5);
  }
}

// a plate whose ends are off the faces: water goes in and out at its ends, through its length
SERIAL_TEST(Plate, EndsOffTheFaces)
{
  const int n = 12;
  for (const double offset : {0.0, 0.25, 0.5})
    for (const double off : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
      Scene run(replaced(plate(n, {{"block 0 1 INF INF INF INF", "constant 1"}}, 4.0 / n, offset),
                         "fix grid",
                         strprintf("displace_atoms all move %.17g 0 0\nfix grid", off / n)));
      const double q = flow(run, 0.002, 2.0) * n / 4.0;
      EXPECT_NEAR(measured(strprintf("nodes at %g, off the faces by %g cells", offset, off), q),
                  1.0, 0.005);
    }
}

// a checkerboard of 1 and 10 has the mean root of 10 (J. B. Keller, J. Math. Phys. 5 (1964) 548)
SERIAL_TEST(Layers, Checkerboard)
{
  const int n = 16;
  Scene run(plate(n,
                  {{"block 0 0.25 0 0.5 INF INF", "constant 1"},
                   {"block 0.25 0.75 0 0.5 INF INF", "constant 10"},
                   {"block 0.75 1 0 0.5 INF INF", "constant 1"},
                   {"block 0 0.25 0.5 1 INF INF", "constant 10"},
                   {"block 0.25 0.75 0.5 1 INF INF", "constant 1"},
                   {"block 0.75 1 0.5 1 INF INF", "constant 10"}},
                  1.0, 0.0));
  EXPECT_NEAR(measured("flow", flow(run, 10.0 / (n * n), 1.0) / std::sqrt(10.0)), 1.0, 0.04);
}

// seepage down through two layers under the weight of the water: it drives the flow as a gradient
// of the pressure does, in space and at an interface that is not along the axes
SERIAL_TEST(Layers, UnderWeight)
{
  for (const bool oblique : {false, true}) {
    const int n = 16;
    const char *const low = oblique ? "plane 0.501 0.501 0 -1 -1 0" : "block 0 0.5 INF INF INF INF",
                      *const high = oblique ? "plane 0.501 0.501 0 1 1 0"
                                            : "block 0.5 1 INF INF INF INF";
    const auto scene = [&](const char *more, const char *ends) {
      return replaced(
          replaced(plate(n, {{low, "constant 1"}, {high, "constant 0.1"}}, 1.0, 0.0, ends),
                   "fix grid", std::string(more) + "fix grid"),
          "boundary f p", "boundary f f");
    };
    Scene pushed(scene("", "xlo pressure 1.0 xhi pressure 0.0 stages 100")),
        falls(scene("fix g all gravity 1.0 vector 1 0 0\nvariable f atom -mass\nfix hold all "
                    "addforce v_f 0 0\n",
                    "xlo pressure 0 xhi pressure 0 stages 100"));
    const double dt = 5.0 / (n * n), one = flow(pushed, dt, 15.0), two = flow(falls, dt, 15.0);
    EXPECT_NEAR(measured("weight over pressure", two / one), 1.0, 3e-4);
    if (!oblique) EXPECT_NEAR(measured("flow", one * 5.5), 1.0, 2e-4);
  }
}

// water of a closed body is kept where layered soil moves across the lattice, on any ranks, also
// with inertia and drag by the square of its flow
TEST(Ranks, Agree)
{
  for (const auto &[wall, ball, more] :
       {std::array{"constant 1", "kozeny 20", ""},
        {"constant 0.1 forchheimer number 100", "constant 2.0", "formulation u-v-p "}}) {
    const std::string scene =
        plate(16, {{"block 0 0.3 0 1 INF INF", wall}, {"sphere 0.6 0.5 0 0.25", ball}}, 1.0, 0.3,
              strprintf("xlo pressure 1.0 %sinitial v_p", more)) +
        "velocity g2 set -0.4 0.1 0\ntimestep 1e-3\n" + PORE;
    OnRanks run(replaced(scene, "fix water", "variable p atom y\nfix water"), "run 60\n");
    EXPECT_LT(run.difference(), 1e-12) << more;
    EXPECT_LT(water_difference(run.serial, run.parallel), 1e-11) << more;
  }
}

TEST(Water, IsKept)
{
  Scene run(replaced(
      plate(16, {{"sphere 0.5 1 0 0.4", "constant 50"}, {"intersect 2 whole around", "kozeny 0.5"}},
            2.0, 0.2, "initial v_p"),
      "region r1 sphere",
      "region whole block 0 1 0 2 INF INF\nregion around sphere 0.5 1 0 0.4 side out\n"
      "variable p atom x<0.4\nregion r1 sphere"));
  Water water(run);
  const auto stored = [&]() {
    const double *const p = water.pressures();
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++)
      sum += run.points().jacobian(i) * run.lmp->atom->vfrac[i] * p[i];
    return over_ranks(sum);
  };
  run.commands("run 0\n");
  const double mass = water.mass(), before = stored();
  run.commands("timestep 1e-5\nrun 200\n");
  EXPECT_NEAR(water.mass() / mass, 1.0, 1e-14);
  EXPECT_NEAR(stored() / before, 1.0, 1e-12);
}

// a soil without points in this field changes no bit
TEST(Unused, ChangesNothing)
{
  const std::string scene =
      plate(12, {{"block 0 1 INF INF INF INF", "constant 1"}}, 4.0 / 12, 0.3) + "timestep 1e-3\n";
  Scene plain(scene + "run 30\n");
  Scene run(replaced(replaced(scene, "fix water",
                              "group none empty\nfix m3 none mpm/material density 1e12 linear 1.0 "
                              "0.0\nfix water"),
                     "soil m1", "soil m3 0.4 constant 0.01 soil m1") +
            "run 30\n");
  Water a(plain), b(run);
  ASSERT_EQ(run.n(), plain.n());
  const double *const p = a.pressures(), *const q = b.pressures();
  for (int i = 0; i < run.n(); i++) ASSERT_EQ(p[i], q[i]);
}

// points that store little next to permeable soil limit the time step, and the flow is stable
SERIAL_TEST(TimeStep, IsThatOfTheInterface)
{
  const auto layers = [](const char *slow) {
    return replaced(plate(16,
                          {{"block 0 0.5 INF INF INF INF", "constant 20"},
                           {"block 0.5 1 INF INF INF INF", slow}},
                          0.25, 0.3, "xlo pressure 1.0 xhi pressure 0.0 stages 1"),
                    "m2 0.4", "m2 0.12");
  };
  Scene run(layers("constant 1") + "fix dt all mpm/dt 0.99\nrun 400\n");
  // shorter than that of either soil: the mean of both over the smaller storage
  Scene fast(plate(16, {{"block 0 1 INF INF INF INF", "constant 20"}}, 0.25, 0.3,
                   "xlo pressure 1.0 xhi pressure 0.0 stages 1") +
             "fix dt all mpm/dt 0.99\nrun 10\n");
  EXPECT_LT(
      measured("time step over that of the soil alone", run.lmp->update->dt / fast.lmp->update->dt),
      0.99);
  Water water(run);
  const double *const p = water.pressures();
  for (int i = 0; i < run.n(); i++) {
    EXPECT_GT(p[i], -0.01);
    EXPECT_LT(p[i], 1.01);
  }
}

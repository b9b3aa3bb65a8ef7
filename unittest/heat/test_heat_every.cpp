// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4

// Fix mpm/heat every: conduction in fewer steps than the motion.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** A bar with its left end at the temperature 1, and a source. */
static std::string warmed(const std::string &options)
{
  return bar(20, "xlo temperature 1.0 xhi convection 2.0 0.0 source v_s " + options) +
      "variable s atom 3*x\n";
}

/** Step of disk() with a keyword every: with auto several are a tenth of the explicit limit. */
static std::string step(const std::string &every)
{
  return every == "every auto" ? "timestep 0.004\n" : "timestep 0.02\n";
}

// at rest, five steps that wait for one conduction are one of five times the length
PARAMETER_TEST(Bar, HasLongerSteps, const char *,
               Values("", "transfer xpic 3", "time sdirk2 tolerance 1e-12"))
{
  Scene few(warmed(std::string("every 5 ") + GetParam())),
      one(warmed(std::string("every 1 ") + GetParam()));
  few.commands("timestep 0.001\nrun 4\n");
  EXPECT_EQ(few.fix("heat")->compute_scalar(), 0.0);
  few.commands("run 18\n");
  one.commands("timestep 0.005\nrun 4\n");
  const double heat = one.fix("heat")->compute_scalar();
  EXPECT_NEAR(few.fix("heat")->compute_scalar() / heat, 1.0, 1e-12);
  EXPECT_NEAR(few.fix("heat")->compute_vector(0) / one.fix("heat")->compute_vector(0), 1.0, 1e-12);
  Warm a(few), b(one);
  for (int i = 0; i < few.n(); i++) EXPECT_NEAR(a.T(i), b.T(i), 1e-12);
}

// heat of the flow between two cold walls, as with conduction in each step: (T - T0) k/(mu U^2) in
// the middle. What shears is warmed in each step, and the heat of four leaves at once
SERIAL_TEST(Couette, IsWarmInTheMiddle)
{
  const auto middle = [](const std::string &every) {
    const double h = 0.05;
    Scene run(plane("lj", "p f", strprintf("0 %.17g 0 1", 4 * h), 1, 0.2 * h) +
              strprintf("fix grid all mpm %.17g\ncreate_points 1 box ppc 2\n", h) +
              "fix m all mpm/material density 1.0 eos linear 100.0 viscosity newtonian 1.0 "
              "thermal conducting 1.0 0.0 1.0\n"
              "fix low all mpm/boundary ylo stick\n"
              "fix high all mpm/boundary yhi stick velocity 1 0 0\n"
              "variable v atom y\nvelocity all set v_v 0 0\n"
              "fix heat all mpm/heat ylo temperature 0 yhi temperature 0 " +
              every + "\ncompute e all mpm/energy\ntimestep 0.000125\nrun 800\n");
    // the heat in the ledger is what the points have
    EXPECT_NEAR(run.compute_vector()[14] / run.fix("heat")->compute_scalar(), 1.0, 1e-11);
    // the mean of the two cells in the middle is less by h^2/12
    return Warm(run).at(0.1, 0.5, h) + h * h / 12.0;
  };
  const double exact = 0.0769191;    // at t = 0.1
  const double each = measured("every step", middle("every 1")) / exact,
               fourth = measured("every fourth", middle("every 4")) / exact;
  EXPECT_NEAR(each, 1.0, 0.005);
  EXPECT_NEAR(fourth, each, 0.002);
  EXPECT_NE(each, fourth);
}

// bodies that fly, turn, and yield: heat is kept, nearly as with conduction in each step
PARAMETER_TEST(EveryClosed, KeepsHeat, const char *, Values("every 4", "every auto"))
{
  const std::string every = GetParam();
  const std::string steps = step(every) + (every == "every auto" ? "run 500\n" : "run 100\n");
  Scene each(disk("every 1") + steps), run(disk(every));
  expect_disk_keeps_heat(run, steps);
  // temperatures are between 0.7 and 2
  const double difference = measured("difference", temperature_difference(each, run));
  EXPECT_GT(difference, 1e-6);
  EXPECT_LT(difference, 0.02);
}

// two bodies, periodic along x, one of which slides on the other: what friction takes is there at
// once, in the right body, and is conducted as in each step
TEST(Friction, HeatsBothBodies)
{
  const auto text = [](const std::string &every) {
    return plane("lj", "p f", "0 4 -2 2.5", 2, 0.2) +
        fields({{"low", "block INF INF -2 0 INF INF"}, {"top", "block INF INF 0 2 INF INF"}},
               "0.25 origin 0 0") +
        "fix m low mpm/material density 1.0 neohookean 400 0.3 thermal conducting 2.0 0.0 0.2\n"
        "fix n top mpm/material density 1.0 neohookean 400 0.3 thermal conducting 1.0 0.0 0.1\n"
        "fix floor all mpm/boundary ylo stick\n"
        "fix touch all mpm/contact F1 F2 law coulomb 0.3 heat yes\n"
        "fix push top gravity 0.5 vector 0 -1 0\nvelocity top set 2 0 0\n"
        "fix heat all mpm/heat " +
        every + "\ntimestep 0.002\ncompute e all mpm/energy\n";
  };
  const auto hottest = [](Scene &run, const char *id) {
    return Warm(run, id).range()[1];
  };
  Scene each(text("every 1") + "run 400\n"), fourth(text("every 4") + "run 2\n");
  const double m0 = Warm(fourth, "m").heat();
  EXPECT_GT(m0, 0.0);    // before any conduction
  EXPECT_NEAR((m0 + Warm(fourth, "n").heat()) / fourth.fix("heat")->compute_scalar(), 1.0, 1e-11);
  fourth.commands("run 398\n");
  const double *const e = fourth.compute_vector();
  EXPECT_NEAR(e[10], 0.0, 1e-11);    // residual
  for (const char *id : {"m", "n"}) {
    const double one = Warm(each, id).heat(), other = Warm(fourth, id).heat();
    EXPECT_GT(one, 0.05);
    EXPECT_NEAR(measured(std::string("heat of ") + id, other) / one, 1.0, 1e-11);
    EXPECT_NEAR(measured(std::string("hottest of ") + id, hottest(fourth, id)) / hottest(each, id),
                1.0, 0.01);
  }
  OnRanks run(text("every 4"), "run 50\n");
  EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-12);
}

PARAMETER_TEST(Ranks, Agree, const char *, Values("every 4", "every auto"))
{
  OnRanks run(disk(GetParam()) + step(GetParam()), "run 50\n");
  EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-12);
}

// a restart file between two conductions
PARAMETER_TEST(EveryRestart, Continues, const char *, Values("every 4", "every auto"))
{
  expect_disk_continues(disk(GetParam()) + step(GetParam()), 33);
}

// between two conductions the power is that of the last one, also after a restart file
TEST(EveryRestart, KeepsThePower)
{
  const std::string scene =
      bar(20, "every 10 xlo temperature 1.0 source v_s") + "variable s atom 3*x\ntimestep 2e-6\n";
  Continued run(scene, 15, lines_again(scene), 3);
  for (const int k : {0, 6}) {
    const double power = run.whole.fix("heat")->compute_vector(k);
    EXPECT_GT(power, 0.0);
    EXPECT_NEAR(run.again.fix("heat")->compute_vector(k) / power, 1.0, 1e-12);
  }
}

/** Of each of n steps: has it conducted heat? That of a bar with a flux through its left end. */
static std::vector<int> conductions(Scene &run, int n)
{
  std::vector<int> steps;
  double before = run.fix("heat")->compute_scalar();
  for (int k = 1; k <= n; k++) {
    run.commands("run 1\n");
    const double heat = run.fix("heat")->compute_scalar();
    if (heat != before) steps.push_back(k);
    before = heat;
  }
  return steps;
}

// a bar of 20 cells is heated suddenly, explicit limit 8.1e-4: few steps wait first, ten later on
TEST(Auto, WaitsWhereLittleChanges)
{
  Scene run(bar(20, "every auto xlo temperature 1.0 xhi flux 0.01"));
  run.commands("timestep 2e-6\nrun 0\n");
  const auto first = conductions(run, 40);
  ASSERT_GT(first.size(), 6u);
  for (int k = 0; k < 6; k++) EXPECT_EQ(first[k], k + 1);
  run.commands("run 2000\n");
  const auto later = conductions(run, 41);
  ASSERT_GE(later.size(), 4u);
  for (std::size_t k = 1; k < later.size(); k++) EXPECT_EQ(later[k] - later[k - 1], 10);
  // three tenths of the explicit limit, 0.98/3 h^2 (SHARE)
  run.commands("run 9959\ntimestep 6.3e-5\nrun 10\n");
  const auto share = conductions(run, 12);
  ASSERT_GE(share.size(), 3u);
  for (std::size_t k = 1; k < share.size(); k++) EXPECT_EQ(share[k] - share[k - 1], 3);
  // and none waits near the limit
  run.commands("timestep 1.5e-4\nrun 3\n");
  EXPECT_EQ(conductions(run, 5).size(), 5u);
}

// the error against the exact temperatures is that of conduction in each step
TEST(Auto, IsAsExact)
{
  const double t = 0.05;
  const auto error = [&](const std::string &every, double *power) {
    Scene run(bar(20, "xlo temperature 1.0 " + every));
    run_to(run, t, 1.0e-5);
    *power = run.fix("heat")->compute_scalar() / (4.0 / 20.0);
    return Warm(run).rms([&](const double *x) {
      double T = 1.0;
      for (int k = 0; k < 60; k++) {
        const double b = (k + 0.5) * PI;
        T -= 2.0 / b * std::sin(b * x[0]) * std::exp(-b * b * t);
      }
      return T;
    });
  };
  double heat[2];
  const double each = measured("every step", error("every 1", heat)),
               few = measured("auto", error("every auto", heat + 1));
  EXPECT_LT(each, 2e-3);
  EXPECT_LT(few, each);
  const double exact = 2.0 * std::sqrt(t / PI);
  EXPECT_NEAR(measured("heat", heat[0]) / exact, 1.0, 0.005);
  EXPECT_NEAR(measured("heat, auto", heat[1]) / heat[0], 1.0, 0.001);
}

// what an input has that does not say how many
SERIAL_TEST(Auto, IsTheDefault)
{
  const auto scene = [](const std::string &every) {
    return disk(every) + step("every auto") + "run 100\n";
  };
  Scene one(scene("every 1")), run(scene("every auto")), plain(scene(""));
  EXPECT_GT(temperature_difference(one, run), 0.0);
  EXPECT_EQ(temperature_difference(plain, run), 0.0);
}

// what changes from step to step, is fast, or near the limit, is as with every 1, bit by bit
PARAMETER_TEST(Auto, DoesNotWait, const char *,
               Values("xlo temperature v_hot", "xhi convection v_hot 0.0", "source v_hot",
                      "region wall temperature 1.0", "time sdirk2"))
{
  const std::string more = "variable hot equal 1.0+100*time\nvariable way equal 1e-3*step\n"
                           "region wall block -0.2 0.0 INF INF INF INF move v_way NULL NULL\n";
  const auto scene = [&](const std::string &every) {
    std::string text = bar(10, std::string(GetParam()) + " " + every, 0.0, "", 0.5);
    return text.insert(text.find("fix heat"), more) + "timestep 1e-5\nrun 25\n";
  };
  Scene each(scene("every 1")), run(scene("every auto"));
  Warm a(each), b(run);
  for (int i = 0; i < run.n(); i++) EXPECT_EQ(a.T(i), b.T(i));
  EXPECT_EQ(each.fix("heat")->compute_scalar(), run.fix("heat")->compute_scalar());
}

// friction needs conduction in each step where not all materials conduct; no input says so
TEST(Auto, KnowsMaterialsThatDoNotConduct)
{
  const auto scene = [](const std::string &every) {
    return replaced(disk(every), "boundary p p p", "boundary p f p") +
        "fix wall all mpm/boundary ylo slip friction 0.1 heat yes\ntimestep 0.002\nrun 30\n";
  };
  Scene each(scene("every 1")), run(scene("every auto"));
  EXPECT_EQ(temperature_difference(each, run), 0.0);
}

// steps of the motion are as much shorter than those of the conduction
SERIAL_TEST(Step, IsLimited)
{
  const auto dt = [](const std::string &every) {
    Scene run(bar(20, "stages 5 " + every) + "fix dt all mpm/dt 0.9\nrun 1\n");
    return run.lmp->update->dt;
  };
  EXPECT_NEAR(dt("every 1") / dt("every 10"), 10.0, 1e-9);
  Scene run(bar(20, "stages 5 every 10", 0.0, "dtcheck no"));
  expect_error(run, strprintf("timestep %g\nrun 10\n", 0.73 * 0.98 * 2.0 / (6.0 * 400.0)),
               "a smaller timestep or fix mpm/heat ... every");
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = bar(4, "");
  const std::string plain = scene.substr(0, scene.find("fix heat"));
  const std::string heat = "fix heat all mpm/heat every ";
  expect_refused(
      plain,
      {{heat + "0", "every"},
       {heat + "1.5", "every"},
       {heat + "2 penalty yes", "penalty yes gives heat to nodes in each step: use every 1"},
       {heat + "2 grains yes", "grains yes gives heat to nodes in each step: use every 1"}},
      "timestep 1e-4\nrun 1\n");
  // the mass of a node tells how its heat is shared
  expect_error(replaced(disk("every 2"), "boundary p p p", "boundary p f p") +
                   "fix wall all mpm/boundary ylo slip friction 0.1 heat yes\nrun 1\n",
               "all materials of fix mpm grid conduct: use every 1");
}

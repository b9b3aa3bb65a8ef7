// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/relax: dynamic relaxation with kinetic damping.

#include "meshgrid/mesh_grid_testing.h"

using namespace MPM_TEST;

/** A column of soil, 1 m high, of n cells, which gets its weight at once. */
static std::string column(int n, const std::string &options, const std::string &relax)
{
  const double h = 1.0 / n;
  return plane("si", "p f", strprintf("0 %.17g 0 1.2", 4 * h), 1, 0.3 * h) +
      "region soil block INF INF 0 1 INF INF\n" +
      strprintf("create_points 1 region soil spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g ", h) + options +
      "\nfix m all mpm/material density 1600 linear 1e7 0.3\n"
      "fix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
      "fix rest all mpm/relax " +
      relax + strprintf("\ntimestep %g\n", 0.5 * h / 110.0);
}
constexpr double MODULUS = 1e7 * 0.7 / (1.3 * 0.4);

static double settlement(Scene &run, double h)
{
  double top = 0.0;
  for (int i = 0; i < run.n(); i++) top = std::max(top, run.x()[i][1]);
  return 1.0 - 0.25 * h - top;
}

/** A beam of length 1 and depth 0.1, clamped at x = 0, n cells deep, under its weight. */
static std::string beam(int n, const std::string &relax, const std::string &options = "")
{
  const double h = 0.1 / n;
  return plane("si", "f f", "0 1.2 -0.3 0.4", 1, 0.3 * h) +
      "region beam block 0 1 0 0.1 INF INF\n" +
      strprintf("create_points 1 region beam spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g ", h) + options +
      "\nfix m all mpm/material density 1000 linear 1e8 0\nfix clamp all mpm/boundary xlo stick\n"
      "fix g all gravity 1 vector 0 -1 0\nfix rest all mpm/relax " +
      relax + strprintf("\ntimestep %g\n", 0.6 * h / 316.3);
}

// stress is the weight above, the settlement elastic; energy that is taken is no numerical error
SERIAL_TEST(Column, ComesToRest)
{
  for (const char *options :
       {"gain error 0.01", "transfer flip 1.0 gain error 0.01", "scheme musl gain error 0.01",
        "shape cubic gain error 0.01", "transfer polypic", "frame total"}) {
    const int n = 20;
    Scene run(column(n, options, "1e-8") +
              "compute e all mpm/energy\nthermo_style custom step c_e\n"
              "run 20000\n");
    EXPECT_LT(measured(std::string(options) + ": steps", run.lmp->update->ntimestep), 2000);
    EXPECT_LE(run.fix("rest")->compute_scalar(), 1e-8);
    double most = 0.0;
    for (int i = 0; i < run.n(); i++) {
      for (int d = 0; d < 3; d++) EXPECT_EQ(run.v()[i][d], 0.0);
      const double depth = 1.0 - run.x()[i][1];
      const auto sigma = run.cauchy(i);
      if (depth > 0.1 && depth < 0.9)
        most = std::max(most, std::fabs(sigma[1] + 1600 * 9.81 * depth));
    }
    EXPECT_LT(measured("stress over the weight of a cell", most * n / (1600 * 9.81)), 0.2);
    EXPECT_NEAR(settlement(run, 1.0 / n) / (1600 * 9.81 / (2.0 * MODULUS)), 1.0, 3e-3);
  }
}

// Critical damping of the slowest mode, with a coefficient from theory, takes 21.6 n steps of half
// the limit until the forces of a hanging bar of n cells have fallen by 1e6; without any input from
// users it may be half as much again.
SERIAL_TEST(Bar, ComesToRestInFewSteps)
{
  for (const int n : {25, 100})
    for (const char *options : {"", "transfer flip 1.0"}) {
      Scene run(replaced(column(n, options, "1e-14 every 1 stop no"), "9.81", "0.0981") +
                "run 1\n");
      const auto forces = [&]() {
        return run.fix("rest")->compute_vector(0);
      };
      const double first = forces();
      while (forces() > 1e-6 * first && run.lmp->update->ntimestep < 100 * n)
        run.commands(strprintf("run %d pre no post no\n", n / 5));
      EXPECT_LE(measured("steps for each cell", run.lmp->update->ntimestep / (double) n), 32.4)
          << n << options;
      const double tip = settlement(run, 1.0 / n);
      run.commands(strprintf("run %d\n", 40 * n));
      EXPECT_NEAR(tip / settlement(run, 1.0 / n), 1.0, 1e-6);
    }
}

// What does not come to rest is told, and ends: a soft half on a stiff one, whose steps are those
// of the stiff one, and a body that nothing holds.
SERIAL_TEST(Bar, TellsThatItMoves)
{
  const auto bar = replaced(column(20, "frame total", "1e-6"), "9.81", "1e-4") + "run 2000\n";
  EXPECT_EQ(lines_that_say(bar, "before forces are balanced").size(), 0u);
  const auto soft =
      replaced(bar, "fix m all mpm/material density 1600 linear 1e7 0.3",
               "region top block INF INF 0.5 INF INF INF\ngroup top region top\n"
               "group low subtract all top\nfix m low mpm/material density 1600 linear 1e7 0.3\n"
               "fix n top mpm/material density 1600 linear 10 0.3");
  EXPECT_EQ(lines_that_say(soft, "before forces are balanced").size(), 1u);
  EXPECT_EQ(lines_that_say(replaced(bar, "fix floor all mpm/boundary ylo slip", ""),
                           "before forces are balanced")
                .size(),
            1u);
}

// the slowest mode, that of bending, is found without a coefficient; at two resolutions
SERIAL_TEST(Beam, BendsUnderItsWeight)
{
  const double inertia = 1e-3 / 12.0, weight = 1000 * 0.1,
               tip = weight / (8.0 * 1e8 * inertia) + weight / (2.0 * 5.0 / 6.0 * 5e7 * 0.1);
  double error[2];
  for (const int n : {4, 8}) {
    Scene run(beam(n, "1e-7") + "compute u all displace/atom\ncompute low all reduce min c_u[2]\n" +
              "thermo_style custom step c_low\nrun 20000\n");
    EXPECT_LE(run.fix("rest")->compute_scalar(), 1e-7);
    auto *const low = run.lmp->modify->get_compute_by_id("low");
    // of the last points, a quarter of a cell from the end
    error[n / 8] = -low->compute_scalar() / (tip * (1.0 - 4.0 / 3.0 * 0.25 * 0.1 / n)) - 1.0;
    measured(strprintf("%d cells", n), error[n / 8]);
  }
  EXPECT_LT(std::fabs(error[1]), 0.01);
  EXPECT_GT(error[0] / error[1], 3.0);
}

// Forces of stress mls pull at surfaces that are inclined to the lattice: a beam that bends by 8
// degrees comes to rest too far down, after ten times as many steps, of which a warning tells while
// it turns; others are where the total frame has them, and a column turns nowhere
SERIAL_TEST(Beam, TellsThatMlsBendsItTooFar)
{
  const auto bent = [](const std::string &options) {
    return replaced(replaced(beam(4, "1e-5", options), "gravity 1", "gravity 100"), "-0.3 0.4",
                    "-1.1 0.4") +
        "compute u all displace/atom\ncompute low all reduce min c_u[2]\n"
        "thermo_style custom step c_low\n";
  };
  const auto warnings = [](const std::string &scene) {
    return lines_that_say(scene, "with stress mls in the updated frame bodies").size();
  };
  EXPECT_EQ(warnings(bent("stress mls") + "run 3000\n"), 1u);
  EXPECT_EQ(warnings(bent("") + "run 3000\n"), 0u);
  EXPECT_EQ(warnings(column(10, "stress mls", "1e-6") + "run 3000\n"), 0u);
  double low[2];
  for (const bool total : {false, true}) {
    Scene run(bent(total ? "frame total" : "") + "run 20000\n");
    EXPECT_LE(run.fix("rest")->compute_scalar(), 1e-5);
    low[total] = run.compute_scalar("low");
  }
  EXPECT_NEAR(measured("default, stress gradient, over frame total", low[0] / low[1]), 1.0, 0.015);
}

// Stress is that of gradients by default while the fix is there, wherever it is defined: to the
// last bit what a run that asks for it has. A run without the fix has moving least squares again,
// and restart files know of none that the input has not
SERIAL_TEST(Beam, StressByDefaultIsThatOfGradients)
{
  const auto scene = [](const std::string &options) {
    return replaced(beam(4, "1e-9", options), "gravity 1", "gravity 100");
  };
  const auto low = [](Scene &run) {
    double y = 1.0;
    for (int i = 0; i < run.n(); i++) y = std::min(y, run.x()[i][1]);
    return y;
  };
  const std::string relax = "fix rest all mpm/relax 1e-9\n", text = scene("");
  Scene given(scene("stress gradient") + "run 300\n"), mls(scene("stress mls") + "run 300\n");
  EXPECT_NE(low(mls), low(given));
  const ScratchFile at_rest("relax-default.restart"), later("relax-default-later.restart");
  Scene after(text + "run 300\n");
  EXPECT_EQ(low(after), low(given));
  Scene before(replaced(replaced(text, relax, ""), "fix grid", relax + "fix grid") + "run 300\n");
  EXPECT_EQ(low(before), low(given));

  const auto lines = [](const std::string &commands) {
    return lines_that_say(commands, "Fix mpm grid: stress").size();
  };
  EXPECT_EQ(lines(text + "run 1\nrun 1\n"), 1u) << "once";
  EXPECT_EQ(lines(text + "run 1\nunfix rest\nrun 1\nrun 1\n"), 2u) << "and of moving least squares";
  EXPECT_EQ(lines(replaced(text, relax, "") + "run 1\n"), 0u);
  for (const char *options : {"stress mls", "stress gradient", "frame total", "transfer flip 1.0"})
    EXPECT_EQ(lines(scene(options) + "run 1\n"), 0u) << options;

  // the motion that follows is that of what the input gives
  after.commands("write_restart " + at_rest.name + "\nunfix rest\nrun 50\nwrite_restart " +
                 later.name + "\n");
  const auto go_on = [&](const std::string &file, const std::string &options,
                         const std::string &rest) {
    const std::string all = scene(options), fixes = all.substr(all.find("fix grid"));
    return "read_restart " + file + "\nneighbor 0.0075 bin\n" + replaced(fixes, relax, rest) +
        "run 50\n";
  };
  Scene explicit_run(go_on(at_rest.name, "", "")), same(go_on(at_rest.name, "stress mls", "")),
      other(go_on(at_rest.name, "stress gradient", ""));
  EXPECT_EQ(low(explicit_run), low(same));
  EXPECT_NE(low(explicit_run), low(other));
  EXPECT_NEAR(low(explicit_run), low(after), 1e-12);
  Scene refused;
  expect_error(refused, go_on(later.name, "stress gradient", ""), "stress mls (now gradient)");
}

// Stops add nothing to vibrations that come to their maximum in two or three steps: those of a bar
// of one cell across grew by 10 % with each rest when nothing else was left, and those of linear
// functions so that points got lost. The ledger has this
SERIAL_TEST(Bar, VibrationsOfFewStepsDecay)
{
  for (const char *options : {"0.5 apic", "0.7 apic", "0.5 apic shape linear"}) {
    const std::string dt = std::string(options, std::string(options).find(' '));
    Scene run(plane("lj", "p p", "-8 16 -4 6", 1, 0.5) +
              "fix grid all mpm 1.0 gain error 0.02 transfer" + (options + dt.size()) +
              "\nregion b block 0 8 0 1 INF INF\ncreate_points 1 region b ppc 2\n"
              "fix m all mpm/material density 2 linear 1000 0.3\n"
              "region c block INF 2 INF INF INF INF\nfix hold all mpm/boundary region c stick\n"
              "fix g all gravity 0.3 vector 1 0 0\nfix dt all mpm/dt " +
              dt +
              "\nfix rest all mpm/relax 1e-9 stop no\ncompute e all mpm/energy\n"
              "thermo_style custom step c_e[11]\nthermo_modify norm no\n");
    EXPECT_EQ(run.error("run 900\n"), "") << options;
    EXPECT_LT(measured(std::string(options) + ": ratio", run.fix("rest")->compute_scalar()), 2e-3);
    EXPECT_LT(std::fabs(run.evaluate("c_e[11]")), 1e-14);    // of 0.025
  }
}

// A bar of elements that hangs from a wall: what elements put on their nodes at a rest is no work
// of loads, which would be missing by 8 % of the energy in play
SERIAL_TEST(Bar, OfElementsGainsNothing)
{
  const ScratchFile mesh("bar.msh", gmsh(QUADS, {8, 1, 0}, [](double x, double y, double) {
                           return std::array<double, 3>{8.0 * x, y, 0.0};
                         }));
  for (const char *transfer : {"apic", "flip 1.0"}) {
    Scene run(plane("lj", "p p", "-8 16 -4 6", 1, 0.5) +
              "fix grid all mpm 1.0 gain error 0.01 transfer " + transfer +
              "\ncreate_points 1 mesh " + mesh.name +
              "\nfix m all mpm/material density 2 neohookean 1000 0.3\nfix e all mpm/elements " +
              mesh.name +
              "\nregion c block INF 2 INF INF INF INF\nfix hold all mpm/boundary region c stick\n"
              "fix g all gravity 0.3 vector 1 0 0\nfix dt all mpm/dt 0.5\n"
              "fix rest all mpm/relax 1e-9 stop no\n");
    EXPECT_EQ(run.error("run 300\n"), "") << transfer;
    EXPECT_GE(run.fix("rest")->compute_vector(3), 3.0);
  }
}

// what never comes to rest is told, with what helps, and what is on its way is not
SERIAL_TEST(Relax, TellsOfForcesThatStayUnbalanced)
{
  const auto soft = [](const std::string &options, int points, int n = 4) {
    auto scene = replaced(beam(n, "1e-5", options), "linear 1e8 0", "neohookean 1e6 0.3");
    scene = replaced(scene, "-0.3 0.4", "-1.2 0.4");
    scene = replaced(scene, strprintf("spacing %.17g", 0.05 / n),
                     strprintf("spacing %g", 0.1 / n / points));
    return replaced(scene, "timestep ", "thermo 100000\nfix dt all mpm/dt 0.6\n#");
  };
  const std::string words = "forces get no more balanced",
                    usl = "scheme usl, which takes far fewer";
  const auto told = [&](const std::string &scene, int steps, const std::string &what) {
    return times_said(scene + strprintf("run %d\n", steps), what);
  };
  EXPECT_EQ(told(soft("transfer fmpm 2", 2), 6000, "give fix mpm the transfer apic"), 1);
  EXPECT_EQ(told(soft("transfer apic", 2), 6000, words), 0);
  EXPECT_EQ(told(soft("", 1, 2), 3000, "use two points per cell"), 1);
  EXPECT_EQ(told(soft("scheme musl", 2), 3000, usl), 1);
  EXPECT_EQ(told(soft("", 2), 1000, "): run more steps"), 1);
}

// a strip a hundred times as long as thick bends more slowly than anybody waits for; one that is
// pulled along itself does not
SERIAL_TEST(Relax, TellsOfThinBodiesThatBend)
{
  const auto strip = [](const char *gravity, double length) {
    return plane("si", "f f", strprintf("0 %g -0.2 0.2", length + 0.02), 1, 0.0015) +
        strprintf("region strip block 0 %g 0 0.01 INF INF\n", length) +
        "fix grid all mpm 0.005 frame total\ncreate_points 1 region strip ppc 2\n"
        "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
        "fix clamp all mpm/boundary xlo stick\nthermo 100000\nfix dt all mpm/dt 0.6\n"
        "fix g all gravity 0.001 vector " +
        gravity + "\nfix rest all mpm/relax 1e-5\n";
  };
  const auto told = [&](const char *gravity, double length) {
    return times_said(replaced(strip(gravity, length), "1e-5", "1e-13") + "run 2000\nrun 1\n",
                      "use fix mpm/implicit static in its place");
  };
  EXPECT_EQ(told("0 -1 0", 0.6), 1);
  EXPECT_EQ(told("1 0 0", 0.6), 0);
  EXPECT_EQ(told("0 -1 0", 0.3), 0);
  // the remedy
  Scene run(replaced(replaced(strip("0 -1 0", 0.6), "mpm/relax 1e-5", "mpm/implicit static"),
                     "fix dt all mpm/dt 0.6\n", "timestep 1\n"));
  EXPECT_EQ(run.error("run 1\n"), "");
}

// forces are those of LAMMPS's units: bodies in free fall, and under pressure
SERIAL_TEST(Forces, HaveUnits)
{
  for (const char *units : {"si", "metal", "real", "lj"}) {
    Scene run(
        plane(units, "p p", "0 8 0 8", 1, 0.3) + "create_points 1 box spacing 0.5\n" +
        "fix grid all mpm 1.0\nfix m all mpm/material density 2.0 eos ideal/gas 1.4 pressure 3\n"
        "fix g all gravity 0.25 vector 0 -1 0\nfix rest all mpm/relax 1e-3 every 1\n"
        "timestep 1e-6\nrun 1\n");
    auto *const fix = run.fix("rest");
    EXPECT_NEAR(fix->compute_vector(0) / (64.0 * 2.0 * 0.25), 1.0, 1e-12) << units;
    EXPECT_NEAR(fix->compute_vector(1) * run.lmp->force->nktv2p / (64.0 * std::sqrt(3.0) * 3.0),
                1.0, 1e-12)
        << units;
  }
}

// of a cube on the lower face along any axis
SERIAL_TEST(Forces, AreTheSameAlongAllAxes)
{
  const auto ratio = [](char axis) {
    Scene run(space("lj", "f f f", "0 2 0 2 0 2") +
              body("block 0 1 0 1 0 1", "density 1 linear 10 0.3", "0.25") +
              strprintf("fix floor all mpm/boundary %clo slip\n", axis) +
              strprintf("fix g all gravity 1 vector %d %d %d\n", -(axis == 'x'), -(axis == 'y'),
                        -(axis == 'z')) +
              "fix rest all mpm/relax 1e-8\ntimestep 0.01\nrun 40\n");
    return run.fix("rest")->compute_scalar();
  };
  const double first = ratio('x');
  EXPECT_GT(first, 1e-3);
  for (const char axis : {'y', 'z'}) EXPECT_NEAR(ratio(axis), first, 1e-12) << axis;
}

// nothing acts on a body in free flight: what round-off does to velocities is no force
SERIAL_TEST(Forces, AreZeroInFreeFlight)
{
  Scene run(plane("lj", "f p", "0 14 0 12", 1, 0.3) +
            "region body block 2 6 2 6 INF INF\n"
            "create_points 1 region body spacing 0.5 jitter 0.2 4711\nvelocity all set 0.6 0.4 0\n"
            "fix grid all mpm 1.0\nfix m all mpm/material density 2.0 linear 33.0 0.3\n"
            "timestep 0.05\nrun 60\nfix rest all mpm/relax 1e-6 stop no\nrun 1\n");
  auto *const fix = run.fix("rest");
  EXPECT_GT(fix->compute_vector(1), 0.0);    // stress of round-off
  EXPECT_EQ(fix->compute_vector(3), 1.0);    // balanced, and put to rest
}

// a run goes on with a new load, and does not stop when it shall not
SERIAL_TEST(Column, GoesOn)
{
  Scene run(column(10, "", "1e-6") + "run 20000\n");
  const double first = settlement(run, 0.1);
  const auto step = run.lmp->update->ntimestep;
  run.commands("run 20000\n");
  EXPECT_LE(run.lmp->update->ntimestep - step, 25);    // in balance as before
  EXPECT_NEAR(settlement(run, 0.1), first, 1e-5 * first);
  run.commands("fix g all gravity 4.905 vector 0 -1 0\nrun 20000\n");
  EXPECT_NEAR(settlement(run, 0.1) / first, 0.5, 1e-3);
  run.commands("unfix rest\nfix rest all mpm/relax 1e-2 stop no\nrun 500\n");
  EXPECT_LT(run.fix("rest")->compute_scalar(), 1e-9);
}

// what relaxation takes and what water stores are each counted once, in either order
SERIAL_TEST(Column, EnergiesOfTwoPhysics)
{
  const auto rest = column(10, "", "1e-5");
  const std::string water = "fix water all mpm/pore 2e7 500 9810 soil m 0.4 constant 1e-9\n";
  std::vector<std::string> said[2];
  for (const bool first : {true, false}) {
    said[first] = lines_that_say(
        (first ? replaced(rest, "fix rest", water + "fix rest") : rest + water) + "run 1000\n",
        "energy at the end");
    ASSERT_EQ(said[first].size(), 1u);
  }
  EXPECT_EQ(said[0], said[1]);
}

TEST(Column, RanksAndRestart)
{
  const auto scene = column(10, "", "1e-6");
  OnRanks run(scene, "run 60\n");
  EXPECT_LT(run.difference(), 1e-11);
  Continued again(scene, 20, lines_again(scene), 30);
  EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  for (int k = 0; k < 4; k++)
    EXPECT_EQ(again.whole.fix("rest")->compute_vector(k),
              again.again.fix("rest")->compute_vector(k));
}

SERIAL_TEST(Relax, BadInput)
{
  const auto plain = replaced(column(10, "", "1e-6"), "fix rest all mpm/relax 1e-6", "");
  expect_refused(
      plain,
      {{"fix rest all mpm/relax", "missing argument"},
       {"fix rest all mpm/relax 0", "ratio of forces"},
       {"fix rest all mpm/relax nan", "nan"},
       {"fix rest all mpm/relax 1.5", "needs a ratio below 1"},
       {"fix rest all mpm/relax 1e-6 every 0", "every"},
       {"fix rest all mpm/relax 1e-6 stop perhaps", "perhaps"},
       {"fix rest all mpm/relax 1e-6 damp 0.5", "damp"},
       {"group some id 1\nfix rest some mpm/relax 1e-6", "use group all"},
       {"fix rest all mpm/relax 1e-6\nfix water all mpm/pore 2e7 500 9810 soil m 0.4 constant "
        "1e-3 formulation u-v-p",
        "use formulation u-p"},
       {"fix rest all mpm/relax 1e-6\nfix more all mpm/relax 1e-6", "remove one"},
       {"unfix floor\nunfix m\nunfix grid\nfix rest all mpm/relax 1e-6", "needs a fix mpm"}},
      "run 1\n");
}

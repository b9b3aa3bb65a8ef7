// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Points that fix mpm/emit adds to a flow of fix mpm/incompressible, or fix mpm/absorb takes away.

#include "mpm_lammps.h"

using namespace MPM_TEST;

enum { DIVERGENCE = 2, FLOOR = 9 };    // of the vector of the flow

/** A channel along an axis, 20 x 8 (x 8) cells of size 1, which flows towards this side. */
std::string channel(int dim, int axis, int side, const std::string &options,
                    const std::string &more)
{
  const char *const flow = side ? "0 2.3" : "17.7 20", *const out = side ? "17.6 INF" : "INF 2.4",
                    *const inside = side ? "2.3 17.6" : "2.4 17.7";
  const auto along = [&](const char *range, const char *across) {
    std::string text;
    for (int d = 0; d < 3; d++)
      text += std::string(" ") + (d == axis ? range : d < dim ? across : "INF INF");
    return text;
  };
  std::string extent, faces, velocity;
  for (int d = 0; d < dim; d++) {
    extent += d == axis ? "0 20 " : dim == 3 ? "0 4 " : "0 8 ";
    faces += d ? " f" : "f";
  }
  for (int d = 0; d < 3; d++) velocity += d == axis ? (side ? " 0.37" : " -0.37") : " 0";
  extent.pop_back();
  const char *const all = dim == 3 ? "0 4" : "0 8";
  return box(dim, "si", faces, extent, 1, 0.3) + "region inlet block" + along(flow, all) +
      "\nregion out block" + along(out, "INF INF") + "\nregion water block" + along(inside, all) +
      "\ncreate_points 1 region water spacing 0.5\nfix in all mpm/emit 1 region inlet velocity" +
      velocity + more + "\nfix w all mpm/incompressible 1.0 1000 " + options +
      "\nfix out all mpm/absorb region out\ntimestep 0.8\n";
}

/** Water 0.6 deep in a tank of 1 x 1 m, which rises by what comes from an inlet in it or above. */
std::string filled(double h, const char *inlet, const char *velocity,
                   const std::string &options = "")
{
  return plane("si", "f f", "0 1 0 1", 1, 0.02) + "region inlet block " + inlet +
      " INF INF\nregion dry block " + inlet +
      " INF INF side out\nregion low block INF INF 0 0.4 INF INF\nregion water intersect 2 low "
      "dry\n" +
      strprintf("create_points 1 region water spacing %.17g\n", 0.5 * h) +
      "fix in all mpm/emit 1 region inlet velocity " + velocity +
      strprintf("\nfix w all mpm/incompressible %.17g 1000 ", h) + options +
      "\nfix g all gravity 9.81 vector 0 -1 0\n";
}

// An inflow that grows with time: all points have its velocity, and are where it has brought them
SERIAL_TEST(Channel, FlowsFaster)
{
  Scene run(
      plane("si", "f f", "0 2 0 0.4", 1, 0.02) +
      "region inlet block 0 0.2 0 0.4 INF INF\nregion rest block 0.2 1.8 INF INF INF INF\n"
      "create_points 1 region rest spacing 0.025\nregion drain block 1.8 INF INF INF INF INF\n"
      "variable U equal 0.5*time\n"
      "fix in all mpm/emit 1 region inlet velocity v_U 0 0 normal 1 0 0 spacing 0.025\n"
      "fix out all mpm/absorb region drain\nfix w all mpm/incompressible 0.05 1000\n"
      "timestep 0.02\nrun 0\n");
  const double before = run.x()[0][0];
  const tagint tag = run.lmp->atom->tag[0];
  run.commands("run 7\n");
  const double t = run.time();
  for (const auto &s : run.gather()) {
    EXPECT_NEAR(s.v[0], 0.5 * t, 1e-9);
    if (s.tag == tag) EXPECT_NEAR(s.x[0] - before, 0.25 * t * t, 1e-9);
  }
}

// A channel as wide as its inlet: all points have the velocity of the inflow, in all directions
SERIAL_TEST(Channel, IsSteady)
{
  for (const int dim : {2, 3})
    for (int axis = 0; axis < dim; axis++)
      for (const int k : {0, 1, 2, 3}) {
        if (dim == 3 && axis != 2) continue;
        const int side = k % 2;
        Scene run(channel(dim, axis, side, k < 2 ? "" : "viscosity 4000 implicit yes", "") +
                  "run 60\n");
        const double before = run.evaluate("mass(all)"), in = run.evaluate("f_in");
        run.commands("run 60\n");
        const double section = dim == 3 ? 16.0 : 8.0, layer = 500.0 * section;
        EXPECT_NEAR(run.evaluate("mass(all)"), before, 1.01 * layer);
        EXPECT_NEAR(run.evaluate("f_in") - in, 1000.0 * section * 0.37 * 48.0, 1.01 * layer);
        double worst = 0.0;
        for (const auto &s : run.gather())
          for (int d = 0; d < dim; d++)
            grow(worst, s.v[d] - (d == axis ? (side ? 0.37 : -0.37) : 0.0));
        EXPECT_LT(
            measured(strprintf("%dd, axis %d, side %d: worst velocity", dim, axis, side), worst),
            1e-12);
      }
}

// An inlet that covers 5.5 of 8 cells: behind it, the mean velocity is less by as much at once
SERIAL_TEST(Channel, IsWiderThanItsInlet)
{
  Scene run(
      plane("si", "f f", "0 20 0 8", 1, 0.3) +
      "region inlet block 0 2.3 0.6 6.1 INF INF\nregion dry block 0 2.3 0.6 6.1 INF INF side out\n"
      "region out block 17.6 INF INF INF INF INF\nregion inside block 0 17.6 0 8 INF INF\n"
      "region water intersect 2 inside dry\ncreate_points 1 region water spacing 0.5\n"
      "fix in all mpm/emit 1 region inlet velocity 0.4 0 0\nfix w all mpm/incompressible 1.0 1000\n"
      "fix out all mpm/absorb region out\ntimestep 0.2\nrun 4\n");
  double sum = 0.0, n = 0.0;
  for (const auto &s : run.gather())
    if (s.x[0] > 11.0 && s.x[0] < 14.0) {
      sum += s.v[0];
      n++;
    }
  EXPECT_NEAR(measured("mean velocity / inflow", sum / n / (0.4 * 5.5 / 8.0)), 1.0, 6e-6);
  EXPECT_LT(measured("divergence", run.fix("w")->compute_vector(DIVERGENCE)), 1e-9);
}

// A channel between regions that cut cells in the middle: as much flows as comes
SERIAL_TEST(Channel, BetweenRegions)
{
  Scene run(
      plane("si", "f f", "0 20 0 12", 1, 0.3) +
      "region low block INF INF INF 1.5 INF INF\nregion high block INF INF 9.5 INF INF INF\n"
      "region inlet block 0 2.3 1.5 9.5 INF INF\nregion out block 17.6 INF INF INF INF INF\n"
      "region water block 2.3 17.6 1.5 9.5 INF INF\ncreate_points 1 region water spacing 0.5\n"
      "fix in all mpm/emit 1 region inlet velocity 0.37 0 0\nfix w all mpm/incompressible 1.0 "
      "1000 region low region high\nfix out all mpm/absorb region out\ntimestep 0.8\nrun 40\n");
  double sum = 0.0, n = 0.0;
  for (const auto &s : run.gather())
    if (s.x[0] > 6.0 && s.x[0] < 14.0) {
      sum += s.v[0];
      n++;
    }
  EXPECT_NEAR(measured("mean velocity / inflow", sum / n / 0.37), 1.0, 1e-10);
}

// With friction at its walls, the flow in the channel becomes Poiseuille's, of the rate that comes
SERIAL_TEST(Channel, BecomesPoiseuille)
{
  for (const char *viscosity : {"400.0", "1e6 implicit yes"}) {
    Scene run(replaced(channel(2, 0, 1,
                               std::string("wall ylo stick wall yhi stick tolerance 1e-7 "
                                           "viscosity ") +
                                   viscosity,
                               ""),
                       "timestep 0.8", "timestep 0.3") +
              "run 160\n");
    double moment = 0.0, square = 0.0;
    for (const auto &s : run.gather()) {
      if (s.x[0] < 11.0 || s.x[0] > 14.0) continue;
      const double y = s.x[1] / 8.0, shape = 6.0 * y * (1.0 - y);
      moment += s.v[0] * shape;
      square += shape * shape;
    }
    // points interpolate the profile of 8 cells by hats, which cut off 1/64
    EXPECT_NEAR(measured("flow of the profile / inflow", moment / square / 0.37), 1.0 - 1.0 / 64.0,
                0.01);
  }
}

// What comes out of an inlet, at a wall, amid the water, or from above, makes it rise by its volume
SERIAL_TEST(Tank, Rises)
{
  struct Case {
    const char *name, *inlet, *velocity;
    double area;
  };
  for (const auto &c : {Case{"at a wall", "0 0.133 0.213 0.391", "0.3 0 0", 0.178},
                        Case{"in the water", "0.308 0.429 0.113 0.291", "0.3 0 0", 0.178},
                        Case{"from above", "0.413 0.541 0.8 1.0", "0 -0.8 0", 0.128}})
    for (const double h : {0.05, 0.04}) {
      Scene run(filled(h, c.inlet, c.velocity) +
                "fix dt all mpm/dt 0.8 every 1 max 0.02 until 2.5\nrun 1000\n");
      const double speed = c.velocity[0] == '0' && c.velocity[1] == ' ' ? 0.8 : 0.3;
      const double in = run.evaluate("f_in");
      double mean = 0.0, n = 0.0;
      const bool above = speed == 0.8;
      for (const auto &s : run.gather())
        if (!above || std::fabs(s.x[0] - 0.477) > 0.15) {    // not the jet
          mean += s.x[1];
          n++;
        }
      // exact inflow, but for a layer
      const double start = above                   ? 0.2 * 0.128
          : c.inlet[0] == '0' && c.inlet[1] == ' ' ? 0.133 * 0.178
                                                   : 0.121 * 0.178;
      EXPECT_NEAR(in / 1000.0, start + c.area * speed * run.time(), 0.51 * h * c.area);
      const double level = run.evaluate("mass(all)") / 1000.0;
      if (!above)
        EXPECT_NEAR(measured(strprintf("%s, h = %g: height over that of the volume", c.name, h),
                             2.0 * mean / n / level),
                    1.0, 0.01);
      // what is in cells
      EXPECT_GT(measured("volume in cells / volume", run.fix("w")->compute_vector(3) / level),
                0.95);
    }
}

// A jet from above brings its momentum and its weight
SERIAL_TEST(Tank, BearsWhatIsPoured)
{
  Scene run(
      filled(0.05, "0.413 0.541 0.8 1.0", "0 -0.8 0") +
      "fix dt all mpm/dt 0.4 every 1 max 0.01 until 1.5\nrun 1000\n"
      "fix dt all mpm/dt 0.4 every 1 max 0.01 until 3\n"
      "variable impulse equal f_w[10]*dt\nfix sum all ave/time 1 1 1 v_impulse ave running\n");
  double sum = 0.0;
  const double start = run.evaluate("mass(all)*vcm(all,y)"), t = run.time();
  double weight = 0.0, last = t;
  run.each_step([&](double **) {
    const double now = run.time(), dt = now - last;
    sum += run.fix("w")->compute_vector(FLOOR) * dt;
    double m = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][1] < 0.8) m += run.lmp->atom->rmass[i];
    weight += m * 9.81 * dt;
    last = now;
  });
  run.commands("run 1000\n");
  const double momentum = 128.0 * 0.8 * 0.8 * (run.time() - t),
               end = run.evaluate("mass(all)*vcm(all,y)");
  EXPECT_NEAR(measured("impulse on the floor / weight and momentum",
                       sum / (weight + momentum - (start - end))),
              1.0, 0.02);
}

// A sheet of honey hangs from its inlet: what came at the time s bears its weight, and stretches by
// 4 mu (Trouton), so that it is 1/(1 - b s (t - s)) times as long at t, b = rho g U/(4 mu)
SERIAL_TEST(Sheet, HangsFromItsInlet)
{
  constexpr double t = 40.0, U = 1.0, mu = 1000.0, b = 7.5e-4;
  for (const int cells : {4, 8}) {
    const double h = 8.0 / cells;
    Scene run(
        plane("si", "p f", "0 16 0 64", 1, 0.3) +
        strprintf("region inlet block 4.3 12.3 %.17g 64 INF INF\n", 64.0 - 2.0 * h) +
        strprintf("fix in all mpm/emit 1 region inlet velocity 0 %.17g 0\n", -U) +
        strprintf("fix w all mpm/incompressible %.17g 1.0 viscosity %g implicit yes\n", h, mu) +
        strprintf("fix g all gravity %.17g vector 0 -1 0\n", 4.0 * mu * b / U) +
        strprintf("timestep 0.25\nrun %d\n", (int) (t / 0.25)));
    double lowest = 64.0, exact = 0.0;
    for (const auto &s : run.gather()) lowest = std::min(lowest, s.x[1]);
    for (int k = 0; k < 1000; k++) {
      const double s = t * (k + 0.5) / 1000;
      exact += U * t / 1000 / (1.0 - b * s * (t - s));
    }
    const double length = 64.0 - 2.0 * h - lowest + 0.25 * h;
    EXPECT_GT(exact, 1.2 * U * t);
    EXPECT_NEAR(measured(strprintf("%d cells: stretch over that of theory", cells),
                         (length / (U * t) - 1.0) / (exact / (U * t) - 1.0)),
                1.0, 0.1);
  }
}

// It comes when and as fast as a variable says, and stops
SERIAL_TEST(Channel, FollowsTheInflow)
{
  Scene run("variable v equal 0.4*(time<8)\n" +
            replaced(channel(2, 0, 1, "", " normal 1 0 0"), "velocity 0.37", "velocity v_v") +
            "run 20\n");
  EXPECT_NEAR(run.evaluate("f_in"), 8000.0 * (2.3 + 0.4 * 8.0), 4400.0);
  for (const auto &s : run.gather()) EXPECT_LT(std::fabs(s.v[0]), 1e-9);
}

TEST(Tank, RanksAndRestart)
{
  for (const std::string options :
       {"tolerance 1e-12", "tolerance 1e-12 viscosity 50 implicit yes"}) {
    const std::string last = "timestep 0.01\n";
    const auto scene = filled(0.05, "0.413 0.541 0.5 0.7", "0 -0.8 0", options) +
        "region out block 0.8 INF INF 0.1 INF INF\nfix out all mpm/absorb region out\n" + last;
    OnRanks run(scene, "run 40\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-12);
    EXPECT_EQ(run.serial.fix("in")->compute_scalar(), run.parallel.fix("in")->compute_scalar());
    const auto text = filled(0.05, "0.413 0.541 0.5 0.7", "0 -0.8 0", options);
    const auto fixes = text.substr(text.find("fix in"));
    const std::string out =
        "region out block 0.8 INF INF 0.1 INF INF\nfix out all mpm/absorb region out\n";
    Continued again(scene, 13,
                    "neighbor 0.02 bin\nregion inlet block 0.413 0.541 0.5 0.7 INF INF\n" + fixes +
                        out + last,
                    30);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
  }
}

SERIAL_TEST(Channel, BadInput)
{
  const auto plain = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region low block INF INF 0 0.4 INF INF\ncreate_points 1 region low spacing 0.025\n"
      "region inlet block 0.4 0.6 0.7 0.9 INF INF\nregion short block 0.4 0.6 0 0.03 INF INF\n";
  const std::string flow = "fix w all mpm/incompressible 0.05 1000 ",
                    emit = "\nfix in all mpm/emit 1 region inlet velocity 0 -1 0";
  expect_refused(
      plain,
      {{flow + "reflect 0.5" + emit, "reflect cannot be used with points of fix mpm/emit"},
       {flow + "sharp yes" + emit, "sharp cannot be used with points of fix mpm/emit"},
       {flow + emit + " move 1 0 0", "move cannot be used with fix w"},
       {flow + emit + " temperature 3", "temperature cannot be used with fix w"},
       {flow +
            "\nregion a plane 0.3 0.7 0 3 4 0\nregion b plane 0.36 0.78 0 -3 -4 0\n"
            "region c plane 0.3 0.7 0 4 -3 0\nregion d plane 0.332 0.676 0 -4 3 0\n"
            "region around block 0.3 0.392 0.676 0.78 INF INF\n"
            "region slant intersect 5 a b c d around\n"
            "fix in all mpm/emit 1 region slant velocity 0.6 0.8 0",
        "must come along an axis of the box, not along 0.6 0.8 0:"},
       {flow + "\nfix in all mpm/emit 1 region short velocity 0 1 0 spacing 0.01",
        "less than a cell"}},
      "timestep 0.001\nrun 1\n");
  // no surface, no way out
  const auto full = plane("si", "f f", "0 1 0 0.4", 1, 0.02) +
      "region water block 0.2 1 INF INF INF INF\ncreate_points 1 region water spacing 0.025\n"
      "region inlet block 0 0.2 0 0.4 INF INF\nfix in all mpm/emit 1 region inlet velocity 0.1 0 "
      "0\nfix w all mpm/incompressible 0.05 1000\n";
  expect_refused(full, {{"timestep 0.01", "no room for what fix mpm/emit brings"}}, "run 2\n");
}

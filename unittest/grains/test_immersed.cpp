// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics restart
// mpi: 1 4

// Fix mpm/immersed: drag and buoyancy of grains in a fluid.

#include "mpm_lammps.h"

#include "group.h"

#include <complex>

using namespace MPM_TEST;

static std::string head(const std::string &box, const std::string &boundary = "p p p",
                        const std::string &grid = "transfer apic")
{
  return "units lj\nboundary " + boundary +
      "\natom_style hybrid sphere mpm\nneighbor 0.3 bin\ncomm_modify vel yes\n"
      "region box block " +
      box + "\ncreate_box 2 box\nfix grid all mpm 1.0 " + grid + "\n";
}

static std::string flat(const std::string &box, const std::string &boundary = "p p p",
                        const std::string &grid = "transfer apic")
{
  return replaced(head(box + " -0.5 0.5", boundary, grid), "units lj", "units lj\ndimension 2");
}
static const std::string move_discs = "fix move grains nve/sphere disc\nfix flat all enforce2d\n";

// the fluid of density 1 and the grains; no contact between them
static std::string rest(const std::string &fix, const std::string &fluid = "eos tait 500.0 7")
{
  return "group water type 1\ngroup grains type 2\nfix drag grains mpm/immersed grid 1.0 " + fix +
      "\nfix fluid water mpm/material density 1.0 " + fluid +
      "\nneigh_modify exclude type 1 1 exclude type 1 2\npair_style zero 0.5\npair_coeff * *\n"
      "thermo_modify norm no\n";
}

/** Pressure of fluid over its height along an axis, in a part of a column of a periodic length. */
struct Pressure {
  double height = 0.0, mean = 0.0, slope = 0.0;

  Pressure(Scene &run, int axis, double low, double high, double length)
  {
    double n = 0.0, xx = 0.0, xp = 0.0;
    for (const auto &s : run.gather()) {
      const double x = fmod(s.x[axis], length);
      if (s.type != 1 || x < low || x > high) continue;
      n++;
      height += x;
      mean += s.pressure();
      xx += x * x;
      xp += x * s.pressure();
    }
    height /= n;
    mean /= n;
    slope = (xp / n - height * mean) / (xx / n - height * height);
  }
};

/** Pressure gradient inside of a bed from 4 to 12 of a column of 16, and pressure drop over it, of
 *  fluid that is driven through it by a force per mass. */
struct Drop {
  double gradient, all;

  Drop(Scene &run, int axis, double force)
  {
    const Pressure before(run, axis, 1.0, 2.5, 16.0), after(run, axis, 13.5, 15.0, 16.0);
    gradient = force - Pressure(run, axis, 5.5, 10.5, 16.0).slope;
    all = before.mean - after.mean + force * (after.height - before.height);
  }
};

static double count(Scene &run, const char *group)
{
  return run.lmp->group->count(run.lmp->group->find(group));
}

/** Forces of drag per volume of a sphere: diameter d, relative velocity w, porosity eps. */
static double drag_per_volume(const std::string &law, double mu, double d, double w, double eps)
{
  const double Re = w * d / mu;
  // coefficients for the area of the sphere and the superficial velocity
  const double single = Re < 1000.0 ? 24.0 / Re * (1.0 + 0.15 * pow(Re, 0.687)) : 0.44;
  const double square = 0.75 * w * w / d;
  if (law == "stokes") return 18.0 * mu * w / (d * d);
  if (law == "schiller") return square * single;
  if (law == "difelice")
    return square * pow(0.63 + 4.8 / sqrt(Re), 2.0) / eps *
        pow(eps, -(3.7 - 0.65 * exp(-0.5 * pow(1.5 - log10(Re), 2.0))));
  if (law == "gidaspow" && eps > 0.8)    // Wen and Yu with the gradient of pressure: / eps
    return square * single * pow(eps, -4.65);
  // gradient of pressure over the share of grains in a volume
  return (150.0 * mu * (1.0 - eps) * w / (d * d) + 1.75 * w * w / d) / (eps * eps * eps);
}

/** Velocity of viscous fluid at a point force F which moves with the velocity v in a periodic box
 *  for a time t, linear in it (C.W. Oseen), where quadratic shape functions spread the force and
 *  interpolate the velocity. Spacing and density are 1. */
static double dragged_along(double F, double v, double mu, double t, const double *box)
{
  const auto square = [](double k) {
    return k == 0.0 ? 1.0 : pow(sin(0.5 * k) / (0.5 * k), 6.0);
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
        sum += square(k[0]) * square(k[1]) * square(k[2]) * across / all *
            ((1.0 - std::exp(-rate * t)) / rate).real();
      }
  return F / (box[0] * box[1] * box[2]) * sum;
}

// Terminal velocity of a single sphere, by the law of Schiller and Naumann. A grain drags along the
// fluid of its own cells, so that it sinks faster, by that velocity at the most: the viscosity of
// the transfers is added to that of the fluid there.
SERIAL_TEST(Immersed, SinksWithTheTerminalVelocity)
{
  struct Case {
    double diameter, viscosity;
    bool before;    // the fix that moves the grain comes before fix mpm
    int every = 1;
  };
  // in the first two, a time step is longer than the time of relaxation
  for (const auto &c :
       first_of(4,
                {Case{0.2, 1.0, false}, Case{0.2, 1.0, true}, Case{0.5, 0.1, false},
                 Case{0.2, 0.01, false}, Case{0.2, 1.0, false, 10}, Case{0.2, 1.0, true, 10}})) {
    const double d = c.diameter, mu = c.viscosity, weight = 2.0 * PI / 6.0 * d * d * d;
    double low = 0.0, high = 100.0;
    for (int k = 0; k < 80; k++) {
      const double v = 0.5 * (low + high);
      const bool above = 3.0 * PI * mu * d * v * (1.0 + 0.15 * pow(v * d / mu, 0.687)) > weight;
      (above ? high : low) = v;
    }
    const std::string move = "fix move grains nve/sphere\n",
                      start_of_box = head("0 8 0 8 0 12", "p p p",
                                          strprintf("transfer apic every %d", c.every));
    Scene run((c.before
                   ? replaced(start_of_box, "fix grid", "group grains type 2\n" + move + "fix grid")
                   : start_of_box) +
              "create_points 1 box ppc 2\ncreate_atoms 2 single 4.1 4.2 8.3\n" +
              strprintf("set type 2 diameter %g density 3.0\n", d) +
              rest(strprintf("%g drag schiller gravity 0 0 -1", mu),
                   strprintf("eos tait 500.0 7 viscosity newtonian %g", mu)) +
              (c.before ? "" : move) + "fix g grains gravity 1.0 vector 0 0 -1\n" +
              strprintf("timestep %.17g\nrun %d\n", 0.01 / c.every, 350 * c.every));
    const double start = run.evaluate("xcm(grains,z)");
    run.commands(strprintf("run %d\n", 50 * c.every));
    const double v = (start - run.evaluate("xcm(grains,z)")) / 0.5 + run.evaluate("vcm(water,z)");
    const double box[3] = {8.0, 8.0, 12.0};
    const double most = dragged_along(weight, low, mu, 4.0, box) / low;
    measured("fluid dragged along / law", most);
    measured(strprintf("terminal velocity / law at Re %.3g", low * d / mu), v / low);
    EXPECT_GT(v / low, 0.999);
    EXPECT_LT(v / low, 1.0 + std::min(most, 0.05));
    if (!c.before && c.every == 1) {    // the velocity in output is that of the motion
      const double place = run.evaluate("xcm(grains,z)");
      run.commands("run 1\n");
      const double moved = (place - run.evaluate("xcm(grains,z)")) / 0.01;
      EXPECT_NEAR(measured("velocity / displacement", -run.evaluate("vcm(grains,z)") / moved), 1.0,
                  8.0e-5);
    }
    EXPECT_NEAR(run.fix_vector("drag", 6)[2] / weight, 1.0, 0.01);
  }
}

// With every 10, drag acts once in ten steps, and its law has the mean velocity of these: a light
// grain, which relaxes within them, sinks as fast as with every 1
SERIAL_TEST(Immersed, SinksAsFastWithEvery)
{
  double speed[2];
  for (const int every : {1, 10}) {
    Scene run(head("0 4 0 4 0 4", "p p p", strprintf("transfer apic every %d", every)) +
              "create_points 1 box ppc 2\ncreate_atoms 2 single 2.1 2.2 2.3\n"
              "set type 2 diameter 0.2 density 3.0\n" +
              rest("1.0 drag stokes gravity 0 0 -1", "eos tait 500.0 7 viscosity newtonian 1.0") +
              "fix move grains nve/sphere\nfix g grains gravity 1.0 vector 0 0 -1\n" +
              strprintf("timestep %.17g\nrun %d\n", 0.01 / every, 40 * every));
    const double start = run.evaluate("xcm(grains,z)");
    run.commands(strprintf("run %d\n", 20 * every));
    speed[every > 1] = measured(strprintf("every %d: speed", every),
                                (start - run.evaluate("xcm(grains,z)")) / 0.2);
  }
  EXPECT_NEAR(measured("of that with every 1", speed[1] / speed[0]), 1.0, 1e-3);
}

SERIAL_TEST(Immersed, TellsOfTheOrderOfFixes)
{
  const std::string move = "group grains type 2\nfix move grains nve/sphere\n",
                    start = head("0 8 0 8 0 12", "p p p", "transfer apic"),
                    end = "create_points 1 box ppc 2\ncreate_atoms 2 single 4.1 4.2 8.3\n"
                          "set type 2 diameter 0.2 density 3.0\n" +
      rest("0.1 drag schiller gravity 0 0 -1", "eos tait 500.0 7 viscosity newtonian 0.1"),
                    run = "timestep 0.01\nrun 1\nrun 1\n";
  const std::string words = "fix move moves grains before fix";
  EXPECT_EQ(times_said(start + end + move + run, words), 0);
  EXPECT_EQ(times_said(replaced(start, "fix grid", move + "fix grid") + end + run, words), 1);
}

/** Two grains as dense as water stay where they are; mean: of their buoyancy and of their drag. */
static void expect_buoyancy(Scene &run, int axis, double volume, const double *mean)
{
  const double slope = Pressure(run, axis, 3.0, 11.0, 20.0).slope;    // in the middle of the column
  const double buoyancy = 0.5 * mean[0], all = buoyancy + 0.5 * mean[1];
  EXPECT_NEAR(measured("buoyancy / (volume * gradient of pressure)", -buoyancy / (slope * volume)),
              1.0, 0.02);
  EXPECT_NEAR(measured("buoyancy / weight of the displaced water", buoyancy / volume), 1.0, 0.01);
  EXPECT_NEAR(measured("the same with drag", all / volume), 1.0, 0.002);
  for (const auto &s : run.gather())
    if (s.type == 2) {
      EXPECT_NEAR(measured("height", s.x[axis]), s.x[0] < 2.0 ? 7.2 : 5.4, 0.1);
      EXPECT_LT(fabs(s.v[axis]), 0.002);
    }
}

// A column of water at rest under gravity: the force on a grain is its volume times the gradient of
// pressure, also at the floor; a grain of the density of water stays where it is
SERIAL_TEST(Immersed, BuoyancyIsTheGradientOfPressure)
{
  Scene run(
      replaced(head("0 4 0 4 0 20", "p p f", "transfer pic"), "create_box 2", "create_box 3") +
      "region water block 0 4 0 4 0 14\ncreate_points 1 region water ppc 2\n"
      "create_atoms 2 single 1.1 1.3 7.2\ncreate_atoms 2 single 3.2 2.9 5.4\n"
      "create_atoms 3 single 2.3 1.2 0.4\n"
      "set type 2*3 diameter 0.6 density 1.0\ngroup low type 3\n" +
      rest("0.5 drag stokes gravity 0 0 -1", "eos tait 2000.0 7") +
      "neigh_modify exclude type 1 3\nfix low low mpm/immersed grid 1.0 0.5 drag stokes gravity 0 "
      "0 -1\n"
      "fix floor all mpm/boundary zlo slip\nfix move grains nve/sphere\n"
      "fix g all gravity 1.0 vector 0 0 -1\ntimestep 0.008\nrun 2500\n"
      "fix mean all ave/time 1 500 500 f_drag[6] f_drag[3] f_low[6] f_low[3]\nrun 500\n");
  const double volume = PI / 6.0 * 0.6 * 0.6 * 0.6;
  const double *const mean = run.fix_vector("mean", 4);
  expect_buoyancy(run, 2, volume, mean);
  EXPECT_NEAR(measured("the same of a grain that is held at the floor, where nodes are held",
                       mean[2] / volume),
              1.0, 1.0e-10);
  EXPECT_NEAR(measured("its drag", mean[3] / volume), 0.0, 0.02);
}

// Fluid that accelerates pushes grains by Archimedes: what is as dense goes along without drag
SERIAL_TEST(Immersed, ArchimedesInFluidThatAccelerates)
{
  for (const char *scheme : {"transfer apic", "transfer flip 1.0 scheme musl",
                             "transfer apic scheme usf", "transfer xpic 2"}) {
    Scene run(head("0 6 0 6 0 6", "p p p", scheme) +
              "create_points 1 box ppc 2\ncreate_atoms 2 single 2.1 2.2 3.3\n"
              "create_atoms 2 single 5.1 5.3 1.7\nset type 2 diameter 0.5 density 1.0\n"
              "set atom 1730 density 4.0\n" +
              rest("1.0 drag none gravity 0 0 -1") +
              "fix move grains nve/sphere\nfix push water gravity 0.5 vector 1 0 0\n"
              "fix g all gravity 1.0 vector 0 0 -1\ntimestep 0.01\nrun 1\n");
    // what a grain takes from the fluid slows down the fluid around it, by its share of the nodes
    const double volume = PI / 6.0 * 0.125;
    const auto squares = [](double x) {
      double sum = 0.0;
      for (int n = -1; n < 8; n++) sum += pow(bspline(2, x - n), 2.0);
      return sum;
    };
    for (const auto &s : run.gather())
      if (s.type == 2) {
        const double ratio =
            volume / s.mass;    // fluid falls freely in a periodic box: no buoyancy
        const double share = volume *
            (s.tag < 1729.5 ? squares(2.1) * squares(2.2) * squares(3.3)
                            : squares(5.1) * squares(5.3) * squares(1.7));
        EXPECT_NEAR(s.v[0], 0.005 * ratio / (1.0 + share), 1.0e-12) << scheme;
        EXPECT_NEAR(s.v[2], -0.01, 1.0e-12) << scheme;
      }
    run.commands("run 200\n");
    const double vx = run.evaluate("vcm(water,x)");
    for (const auto &s : run.gather())
      if (s.type == 2)
        EXPECT_NEAR(
            measured("velocity / that of the fluid * density", s.v[0] * s.mass / volume / vx), 1.0,
            0.01);
  }
}

// Drag on held grains in a lattice, in fluid that moves past them
SERIAL_TEST(Immersed, LawsOfDrag)
{
  const double d = 0.5, w = 1.0, volume = PI / 6.0 * d * d * d;
  struct Case {
    const char *law;
    double viscosity, cell;
  };
  for (const auto &c :
       {Case{"stokes", 1.0, 0.625}, Case{"schiller", 0.01, 1.0}, Case{"schiller", 1.0e-4, 1.0},
        Case{"ergun", 0.05, 0.625}, Case{"ergun", 1.0e-3, 0.5}, Case{"ergun", 0.05, 5.0 / 12.0},
        Case{"gidaspow", 0.05, 0.625}, Case{"gidaspow", 0.05, 1.0}, Case{"gidaspow", 1.0e-4, 1.0},
        Case{"difelice", 1.0, 1.0}, Case{"difelice", 0.02, 0.625},
        Case{"difelice", 1.0e-4, 0.625}}) {
    const double mu = c.viscosity;
    const double eps =
        std::max(0.26, 1.0 - volume / pow(c.cell, 3.0));    // not below dense packing
    const double force = volume * drag_per_volume(c.law, mu, d, w, eps);
    Scene run(head("0 5 0 5 0 5") + "create_points 1 box ppc 2\n" +
              strprintf("lattice sc %.10g\ncreate_atoms 2 box\n", 1.0 / pow(c.cell, 3.0)) +
              strprintf("set type 2 diameter %g density 3\n", d) +
              rest(strprintf("%g drag %s", mu, c.law)) +
              "velocity water set 0 1 0 units box\ntimestep 1.0e-6\nrun 1\n");
    EXPECT_NEAR(measured(strprintf("drag %s, Re %g, porosity %.2f", c.law, w * d / mu, eps),
                         run.fix_vector("drag", 6)[1] / (count(run, "grains") * force)),
                1.0, 0.002);
  }
}

// Grains at random places have the drag of the mean porosity, but for the scatter of the mapped one
static void random_places(const std::string &box, const std::string &density, int grains, double d,
                          double volume, double share)
{
  Scene run(box + "create_points 1 box ppc 2\n" +
            strprintf("create_atoms 2 random %d 4711 NULL\nset type 2 diameter %g %s 3\n", grains,
                      d, density.c_str()) +
            rest("0.1 drag difelice") +
            "velocity water set 0 1 0 units box\ntimestep 1.0e-5\nrun 1\n");
  const double force = volume * drag_per_volume("difelice", 0.1, d, 1.0, 1.0 - share);
  EXPECT_NEAR(measured("drag", run.fix_vector("drag", 6)[1] / (grains * force)), 1.0, 0.06);
}

SERIAL_TEST(Immersed, RandomPlacesAreNoEndsOfBeds)
{
  const double d = 0.4, volume = PI / 6.0 * d * d * d;
  random_places(head("0 10 0 10 0 10"), "density", 3000, d, volume, 3000 * volume / 1000.0);
}

// Above the surface of the fluid, buoyancy falls with the mass around the grain
SERIAL_TEST(Immersed, EndsAtTheSurface)
{
  const double volume = PI / 6.0 * 0.125;
  for (double z : {5.4, 7.0, 7.3, 7.9, 8.6, 10.2}) {
    Scene run(head("0 4 0 4 0 20", "p p f") +
              "region water block 0 4 0 4 0 7\ncreate_points 1 region water ppc 2\n" +
              strprintf("create_atoms 2 single 2.1 1.7 %g\n", z) +
              "set type 2 diameter 0.5 density 1.0\n" + rest("0.5 drag none gravity 0 0 -1") +
              "timestep 1.0e-3\nrun 1\n");
    double mass = 0.0;    // of full space
    for (int n = 0; n < 20; n++)
      for (int k = 0; k < 14; k++) mass += 0.5 * bspline(2, z - n) * bspline(2, 0.25 + 0.5 * k - n);
    const double *const f = run.fix_vector("drag", 6);
    EXPECT_NEAR(measured(strprintf("buoyancy at %g", z), f[5] / volume), std::min(1.0, 2.0 * mass),
                z < 6.0 ? 0.02 : 1.0e-10);
  }
}

// A dense suspension at rest as a whole: drag carries what the weight of its grains is above that
// of displaced fluid, though the fluid carries the rest, too
SERIAL_TEST(Immersed, SuspensionSettlesWithTheLaw)
{
  const double d = 0.5, volume = PI / 6.0 * d * d * d, cell = 0.625, density = 3.0, mu = 0.1;
  const double solid = volume / (cell * cell * cell), eps = 1.0 - solid;
  Scene run(head("0 5 0 5 0 5") + "create_points 1 box ppc 2\n" +
            strprintf("lattice sc %.10g\ncreate_atoms 2 box\n", 1.0 / (cell * cell * cell)) +
            strprintf("set type 2 diameter %g density %g\n", d, density) +
            rest(strprintf("%g gravity 0 0 -1", mu)) +
            "fix move grains nve/sphere\nfix g all gravity 1.0 vector 0 0 -1\n" +
            strprintf("fix lift water gravity %.15g vector 0 0 1\n", 1.0 + density * solid) +
            "timestep 0.01\nrun 100\n");
  const double start = run.evaluate("xcm(grains,z)");
  run.commands("run 50\n");
  const double slip = run.evaluate("vcm(water,z)") + (start - run.evaluate("xcm(grains,z)")) / 0.5;
  const double drag =
      PI / 6.0 * d / (eps * eps * eps) * (150.0 * mu * solid + 1.75 * d * slip) * slip;
  EXPECT_NEAR(measured("drag of the law / weight less buoyancy", drag / (volume * (density - 1.0))),
              1.0, 0.0015);
  EXPECT_NEAR(measured("buoyancy / weight of displaced water",
                       run.fix_vector("drag", 6)[5] / (512.0 * volume)),
              1.0, 8.0e-4);
}

/** Flow through a bed that fills half of a periodic column, driven by a force on the fluid: its
 *  pressure falls as Ergun's equation has it for the flux, inside and over all of it. */
static void flow_through_a_bed(int dim, double mu, double d, const std::string &box,
                               const std::string &grains, double volume)
{
  const double pull = 0.5, wide = pow(4.0, dim - 1);    // across the column
  const int axis = dim - 1;
  Scene run(box + "create_points 1 box ppc 2\n" + grains + rest(strprintf("%g drag ergun", mu)) +
            strprintf("fix g water gravity %g vector 0 %s\ntimestep 0.01\nrun 800\n", pull,
                      dim == 3 ? "0 1" : "1 0"));
  const double flux = run.evaluate(dim == 3 ? "vcm(water,z)" : "vcm(water,y)");
  const Drop drop(run, axis, pull);
  const double solid = count(run, "bed") * volume / (8.0 * wide), eps = 1.0 - solid;
  if (dim == 3) {
    EXPECT_NEAR(measured("share of volume of the grains", solid), PI / 6.0, 1.0e-12);
  } else {
    ASSERT_EQ(count(run, "bed"), 14 * 28);
  }
  const double ergun = solid * drag_per_volume("ergun", mu, d, flux, eps);
  const auto at = strprintf(" / Ergun at Re %.3g", flux * d / mu);
  EXPECT_NEAR(measured("pressure gradient in the bed" + at, drop.gradient / ergun), 1.0, 0.02);
  EXPECT_NEAR(measured("pressure drop over the bed" + at, drop.all / (8.0 * ergun)), 1.0, 0.05);
  // in the end all of the force on the fluid is on the bed
  const double *const on_bed = run.fix_vector("drag", 6);
  EXPECT_NEAR(
      measured("force on the bed", (on_bed[axis] + on_bed[3 + axis]) / (16.0 * wide * pull)), 1.0,
      0.001);
}

SERIAL_TEST(Immersed, PressureDropOfABedIsErgun)
{
  const double d = 0.5;
  for (const double mu : {0.01, 0.0001})
    flow_through_a_bed(
        3, mu, d, head("0 4 0 4 0 16"),
        "lattice sc 8.0 origin 0.5 0.5 0.5\nregion bed block 0 4 0 4 4 12 units box\n"
        "create_atoms 2 region bed\nset type 2 diameter 0.5 density 3.0\n"
        "group bed type 2\ndisplace_atoms bed random 0.1 0.1 0.1 4711 units box\n",
        PI / 6.0 * d * d * d);
}

// single ones: their tags do not depend on the number of ranks
static std::string cloud()
{
  std::string text = "create_points 1 region blob ppc 2\n";
  for (int k = 0; k < 125; k++)
    text +=
        strprintf("create_atoms 2 single %d.1 %d.2 %d.3\n", 2 + k % 5, 2 + k / 5 % 5, 2 + k / 25);
  return text +
      "set type 2 diameter 0.5 density 3.0\ngroup cloud type 2\n"
      "displace_atoms cloud random 0.3 0.3 0.3 4711 units box\n"
      "velocity cloud create 0.5 4711 loop geom\n"
      "velocity cloud set 0.4 0.2 -0.3 sum yes units box\n";
}
static const std::string blob = "region blob block 1 9 1 8 1 8\n";

static std::string cloud_with(const std::string &law, const std::string &grid = "transfer apic")
{
  return head("0 10 0 10 0 10", "p p p", grid) + blob + cloud() + rest(law) +
      "fix move grains nve/sphere\ntimestep 0.01\n";
}

/** Momentum of fluid and grains together stays, and stiff drag leaves no slip. */
static void keeps_momentum(Scene &run, const std::string &name)
{
  const auto start = run.sums(), grains = run.sums(2);
  double scale = 0.0, worst = 0.0;
  for (int d = 0; d < 3; d++) scale += fabs(grains.p[d]);
  for (int k = 0; k < 20;
       k++) {    // at the end of steps: grains get a half of their impulses there
    run.commands("run 5 post no\n");
    const auto now = run.sums();
    for (int d = 0; d < 3; d++) worst = std::max(worst, fabs(now.p[d] - start.p[d]) / scale);
    EXPECT_LT(now.kinetic, 1.05 * start.kinetic);
  }
  EXPECT_LT(measured("momentum, " + name, worst), 1.0e-12);
  EXPECT_GT(fabs(run.sums(1).p[0]), 0.01 * scale);    // the fluid has got some of it
}

/** What the grains do to the fluid is in the ledger of its energy. */
static void closes_the_ledger(Scene &run)
{
  const double *e = run.compute_vector();
  EXPECT_GT(fabs(e[7]), 0.01);
  EXPECT_LT(fabs(measured("imbalance", e[10])), 1.0e-12);
}

SERIAL_TEST(Immersed, KeepsMomentum)
{
  for (const std::string law :
       {"0.1 drag gidaspow", "0.1 drag difelice", "0.01 drag schiller gravity 0 0 -0.2",
        "1.0e5 drag ergun", "1.0e5 drag stokes"})
    for (const char *grid : {"transfer apic", "transfer flip 1.0 scheme musl"}) {
      Scene run(cloud_with(law, grid));
      keeps_momentum(run, law + ", " + grid);
    }
}

/** On one rank and on several, and when it goes on after a restart, with what no restart has. */
static void expect_the_same(const std::string &scene, const std::string &again)
{
  Twins run(scene, 30, "comm_modify vel yes\nfix grid all mpm 1.0 transfer apic\n" + again, 30,
            1.0e-10);
  for (int k = 0; k < 6; k++)
    EXPECT_NEAR(run.serial.fix_vector("drag", 6)[k], run.whole.fix_vector("drag", 6)[k], 1.0e-10);
}

TEST(Immersed, IsTheSameOnAnyNumberOfRanksAndAfterARestart)
{
  const std::string law = "0.1 drag gidaspow gravity 0 0 -0.2";
  expect_the_same(cloud_with(law), rest(law) + "fix move grains nve/sphere\ntimestep 0.01\n");
}

// By whole cells: fluid and grains are on both sides of all faces then
TEST(Immersed, IsTheSameAcrossPeriodicFaces)
{
  const std::string scene = cloud_with("0.1 drag gidaspow gravity 0 0 -0.2");
  Scene inside(scene + "run 30\n"), across(scene + "displace_atoms all move 5 6 7\nrun 30\n");
  EXPECT_GT(fabs(inside.fix_vector("drag", 6)[0]), 1.0e-3);
  for (int k = 0; k < 6; k++)
    EXPECT_NEAR(inside.fix_vector("drag", 6)[k], across.fix_vector("drag", 6)[k], 1.0e-12);
}

// Neighbor lists and messages of grains alone; LAMMPS then sets only their forces to zero
TEST(Immersed, NeedsNoPointsInNeighborLists)
{
  const std::string
      law = "0.1 drag gidaspow gravity 0 0 -0.2",
      lists = "atom_modify first grains\nneigh_modify include grains\ncomm_modify group grains\n",
      last = "pair_style gran/hooke 20.0 NULL 0.5 NULL 0.5 1\npair_coeff * *\n"
             "fix g all gravity 0.2 vector 0 0 -1\nrun 60\n";
  Scene all(cloud_with(law) + last), grains(cloud_with(law) + lists + last);
  EXPECT_LT(difference(all.gather(), grains.gather()), 1.0e-10);
}

SERIAL_TEST(Immersed, ClosesTheLedger)
{
  Scene run(cloud_with("0.1 drag gidaspow gravity 0 0 -0.2") +
            "compute e all mpm/energy\nrun 100\n");
  closes_the_ledger(run);
}

// Fluid as a whole streams through grains that are held, one in each cell: there is nothing but its
// kinetic energy, and drag takes it, in steps as short and as long as the time in which it comes to
// rest. No part of it is a loss of the transfer
SERIAL_TEST(Immersed, WorkOfDragIsTheKineticEnergy)
{
  for (const double dt : {0.01, 0.5}) {
    Scene run(head("0 4 0 4 0 4") +
              "region all block INF INF INF INF INF INF\ncreate_points 1 region all ppc 2\n"
              "lattice sc 1.0 origin 0.5 0.5 0.5\ncreate_atoms 2 region all\n"
              "set type 2 diameter 0.2 density 3.0\n" +
              rest("1.0 drag stokes", "eos tait 1.0e-3 7") +
              "velocity water set 1.0 0.0 0.0\ncompute e all mpm/energy\ntimestep " +
              strprintf("%g", dt) + "\n");
    const double start = run.sums(1).kinetic;
    run.commands("run 2\n");
    const double *e = run.compute_vector(), lost = run.sums(1).kinetic - start;
    EXPECT_LT(lost, -0.01 * start);
    EXPECT_LT(measured("work of drag", fabs(e[7] / lost - 1.0)), 1.0e-12);
    // to the watch of energies it is work from outside
    const auto &ledger = MPMField::find(run.lmp, "grid")->ledger;
    EXPECT_LT(measured("from outside", fabs(ledger.driven / lost - 1.0)), 1.0e-12);
    EXPECT_LT(measured("loss in transfers", fabs(e[8] / lost)), 1.0e-11);
    EXPECT_LT(measured("imbalance", fabs(e[10] / lost)), 1.0e-12);
  }
}

SERIAL_TEST(Immersed, RefusesBadInput)
{
  const std::string start = head("0 4 0 4 0 4", "p p f", "GRID") +
      "create_points 1 box ppc 2\ncreate_atoms 2 single 2 2 2\ncreate_atoms 2 single 1 2 2\n"
      "set type 2 diameter 0.5 density 3.0\ngroup g type 2\ngroup w type 1\nfix m w mpm/material "
      "density 1.0 neohookean 30.0 0.3\n"
      "pair_style zero 1.0\npair_coeff * *\n";
  const std::string fix = "fix d g mpm/immersed grid ";
  expect_refused(replaced(start, "GRID", ""),
                 {{fix + "1.0", "missing argument"},
                  {fix + "-1.0 1.0", "density of the fluid must be positive"},
                  {fix + "1.0 -1.0", "viscosity must not be negative"},
                  {fix + "1.0 0.0", "needs a positive viscosity"},
                  {fix + "1.0 1.0 drag newton", "Unknown fix mpm/immersed drag newton"},
                  {fix + "1.0 1.0 drag", "missing argument"},
                  {fix + "1.0 1.0 gravity 0 0", "missing argument"},
                  {fix + "1.0 1.0 lift yes", "Unknown fix mpm/immersed keyword: lift"}});
  const std::string good = fix + "1.0 1.0\n";
  expect_refused(
      replaced(start, "GRID", ""),
      {{"fix d g mpm/immersed other 1.0 1.0", "there is no fix mpm other"},
       {"fix d all mpm/immersed grid 1.0 1.0", "are material points: use a group of grains"},
       {good + "group one id 513\nfix d2 one mpm/immersed grid 1.0 1.0",
        "Fix mpm/immersed d and d2 have 1 grains and the field in common"},
       {good + "fix r g rigid/nve single", "use single spheres"}},
      "run 0\n");
  expect_refused(replaced(start, "GRID", "frame total"), {{good, "use frame updated"}}, "run 0\n");
  expect_refused(replaced(start, "GRID", "transfer fmpm 2"), {{good, "use xpic"}}, "run 0\n");
  expect_refused(replaced(start, "GRID", "transfer flip 1.0 edges modified"),
                 {{good, "use edges plain"}}, "run 0\n");
  expect_error("units lj\natom_style mpm\nregion box block 0 4 0 4 0 4\ncreate_box 1 box\n"
               "fix grid all mpm 1.0\n" +
                   fix.substr(0, 6) + "all mpm/immersed grid 1.0 1.0\n",
               "use atom_style hybrid sphere mpm");
}

// 2d: a grain is a disc of unit depth, with the drag of spheres of its diameter and volume
/** Square array of discs that are held, per disc. */
static double drag_on_disc(double cell, double diameter, const std::string &law, double speed)
{
  Scene run(flat("0 5 0 5") + "create_points 1 box ppc 2\n" +
            strprintf("lattice sq %.10g\ncreate_atoms 2 box\n", 1.0 / (cell * cell)) +
            strprintf("set type 2 diameter %.10g density/disc 3\n", diameter) + rest(law) +
            strprintf("velocity water set 0 %g 0 units box\ntimestep 1e-10\nrun 1\n", speed));
  return run.fix_vector("drag", 6)[1] / count(run, "grains");
}

SERIAL_TEST(ImmersedPlane, LawsOfDrag)
{
  const double d = 0.5, w = 1.0, area = 0.25 * PI * d * d;
  // the last one is denser than any packing
  for (const double cell : {1.0, 0.625, 5.0 / 9.0, 5.0 / 11.0})
    for (const double mu : {1.0, 0.05, 1.0e-4}) {
      const double eps = std::max(1.0 - PI / sqrt(12.0), 1.0 - area / (cell * cell));
      for (const char *law : {"stokes", "schiller", "ergun", "gidaspow", "difelice"})
        EXPECT_NEAR(drag_on_disc(cell, d, strprintf("%g drag %s", mu, law), w) /
                        (area * drag_per_volume(law, mu, d, w, eps)),
                    1.0, 0.002)
            << law << ", cell " << cell << ", viscosity " << mu;
    }
}

// That of Ergun is not far from what cylinders across slow flow feel: A.S. Sangani, A. Acrivos,
// Int. J. Multiphase Flow 8 (1982) 193, table 1, force / (viscosity velocity)
SERIAL_TEST(ImmersedPlane, ErgunIsNearCylindersInSlowFlow)
{
  const struct {
    double solid, force, error;
  } rows[] = {{0.2, 51.53, 0.13}, {0.3, 102.90, 0.01}, {0.4, 217.89, 0.01}, {0.5, 532.55, 0.14}};
  for (const auto &row : rows) {
    const double cell = 0.625, mu = 10.0, speed = 1.0e-4;
    const double force = drag_on_disc(cell, cell * sqrt(4.0 * row.solid / PI),
                                      strprintf("%g drag ergun", mu), speed);
    EXPECT_NEAR(
        measured(strprintf("table / drag at %g", row.solid), row.force * mu * speed / force), 1.0,
        row.error);
  }
}

// The force on a disc in water at rest is its volume times the gradient of pressure
SERIAL_TEST(ImmersedPlane, BuoyancyIsTheGradientOfPressure)
{
  Scene run(flat("0 8 0 20", "p f p", "transfer pic") +
            "region water block 0 8 0 14 INF INF\ncreate_points 1 region water ppc 2\n"
            "create_atoms 2 single 1.1 7.2 0\ncreate_atoms 2 single 3.2 5.4 0\n"
            "set type 2 diameter 0.3 density/disc 1.0\n" +
            rest("0.5 drag stokes gravity 0 -1 0", "eos tait 2000.0 7") + move_discs +
            "fix floor all mpm/boundary ylo slip\nfix g all gravity 1.0 vector 0 -1 0\n"
            "timestep 0.008\nrun 2500\n"
            "fix mean all ave/time 1 500 500 f_drag[5] f_drag[2]\nrun 500\n");
  const double volume = 0.25 * PI * 0.3 * 0.3;
  expect_buoyancy(run, 1, volume, run.fix_vector("mean", 2));
}

SERIAL_TEST(ImmersedPlane, PressureDropOfABedIsErgun)
{
  const double d = 0.25;
  for (const double mu : {0.01, 0.0001})
    flow_through_a_bed(
        2, mu, d, flat("0 4 0 16"),
        "lattice sq 12.25 origin 0.5 0.5 0\nregion bed block 0 4 4 12 INF INF units box\n"
        "create_atoms 2 region bed\nset type 2 diameter 0.25 density/disc 3.0\n"
        "group bed type 2\ndisplace_atoms bed random 0.025 0.025 0 4711 units box\n",
        0.25 * PI * d * d);
}

// Discs at random places have no ends of beds among them
SERIAL_TEST(ImmersedPlane, RandomPlacesAreNoEndsOfBeds)
{
  const double d = 0.1, area = 0.25 * PI * d * d;
  random_places(flat("0 30 0 30"), "density/disc", 16000, d, area, 16000 * area / 900.0);
}

static std::string plane_cloud(const std::string &law, const std::string &grid = "transfer apic")
{
  std::string text = flat("0 10 0 10", "p p p", grid) +
      "region blob block 1 9 1 8 INF INF\ncreate_points 1 region blob ppc 2\n";
  for (int k = 0; k < 64; k++)
    text +=
        strprintf("create_atoms 2 single %.1f %.1f 0\n", 1.6 + 0.9 * (k % 8), 1.7 + 0.9 * (k / 8));
  return text +
      "set type 2 diameter 0.5 density/disc 3.0\ngroup cloud type 2\n"
      "displace_atoms cloud random 0.3 0.3 0 4711 units box\nvelocity cloud create 0.5 4711 loop "
      "geom\n"
      "velocity cloud set 0.4 0.2 0 sum yes units box\nvelocity all set NULL NULL 0\n" +
      rest(law) + move_discs + "compute e all mpm/energy\ntimestep 0.01\n";
}

SERIAL_TEST(ImmersedPlane, KeepsMomentumAndTheLedger)
{
  for (const std::string law :
       {"0.1 drag gidaspow", "0.01 drag schiller gravity 0 -0.2 0", "1e5 drag ergun"})
    for (const char *grid :
         {"transfer apic", "transfer flip 1.0 scheme musl", "shape cubic transfer apic"}) {
      Scene run(plane_cloud(law, grid));
      keeps_momentum(run, law + ", " + grid);
      closes_the_ledger(run);
    }
}

TEST(ImmersedPlane, IsTheSameOnAnyNumberOfRanksAndAfterARestart)
{
  const std::string law = "0.1 drag gidaspow gravity 0 -0.2 0";
  expect_the_same(plane_cloud(law),
                  rest(law) + move_discs + "compute e all mpm/energy\ntimestep 0.01\n");
}

SERIAL_TEST(ImmersedPlane, RefusesBadInput)
{
  const std::string fix = "group g type 2\nfix d g mpm/immersed grid 1.0 1.0";
  expect_error(flat("0 4 0 4") + fix + " gravity 0 0 -1\n", "x and y in 2d");
  expect_error(flat("0 4 0 4", "f f p", "axisymmetric yes") +
                   "create_points 1 box ppc 2\nfix w all mpm/boundary xlo slip\n"
                   "fix m all mpm/material density 1.0 neohookean 30.0 0.3\n" +
                   fix + "\nrun 0\n",
               "would be a ring");
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input
// mpi: 1 4

// Bodies in fields of their own that touch by fix mpm/contact, in steps of fix mpm/implicit.

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** Two bodies in fields F1 (low) and F2 (up), of rubber, the lower one stiffer. */
static std::string two_bodies_in(const std::string &low, const std::string &up,
                                 const std::string &grid = "0.1",
                                 const std::string &low_density = "1000")
{
  return fields({{"low", "block " + low}, {"up", "block " + up}}, grid) +
      "fix ma up mpm/material density 1000 neohookean 1e6 0.3\nfix mb low mpm/material density " +
      low_density + " neohookean 3e6 0.3\n";
}

/** Two blocks of linear elastic material on each other in a box of 0.8 by 1, the upper one with E =
 *  1 MPa, the lower one with another; the interface is at this height, and rises by this slope. */
static std::string blocks(const std::string &contact, double height, double slope, double E,
                          double nu, const std::string &box = "0 0.8 0 1",
                          const std::string &implicit = "static")
{
  return plane("si", "f f", box, 2, 0.02) + "region body block 0 0.8 0 1 INF INF\n" +
      strprintf("region below plane 0.4 %.17g 0 %.17g -1 0\n", height, slope) +
      strprintf("region above plane 0.4 %.17g 0 %.17g 1 0\n", height, -slope) +
      fields({{"low", "intersect 2 body below"}, {"up", "intersect 2 body above"}}, "0.1") +
      strprintf("fix ma up mpm/material density 1000 linear 1e6 %g\n", nu) +
      strprintf("fix mb low mpm/material density 1000 linear %g %g\n", E, nu) +
      "fix touch all mpm/contact F2 F1 " + contact + "\nfix solve all mpm/implicit " + implicit +
      "\ntimestep 1.0\n";
}
/** Smooth walls below, above, and at the left; the lid, and a right one if it moves, push. */
static std::string walls(const char *right = "")
{
  return "fix left all mpm/boundary xlo slip\nfix floor all mpm/boundary ylo slip\n" +
      std::string(*right ? "fix right all mpm/boundary xhi slip velocity " : "") + right +
      "\nfix lid all mpm/boundary yhi slip velocity 0 -0.01 0\n";
}
static const char *const PUSHED = "-0.008 0 0";

/** Largest difference of the stress of points of the mean, along this axis, over its mean. */
static double scatter(Scene &run, int axis)
{
  double mean = 0.0, most = 0.0;
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < run.n(); i++) {
      const auto stress = run.cauchy(i);
      if (pass)
        most = std::max(most, std::fabs(stress[axis] - mean) / std::fabs(mean));
      else
        mean += stress[axis] / run.n();
    }
  return most;
}

/** Force of the contact along x, y, or z, or (3) on the nodes that touch. */
static double touch(Scene &run, int column)
{
  return run.fix("touch")->compute_array(0, column);
}

/** Mean of a component of positions or velocities of the bodies of a type. */
static double mean(Scene &run, double **of, int type, int d)
{
  double sum = 0.0;
  int n = 0;
  for (int i = 0; i < run.n(); i++)
    if (run.lmp->atom->type[i] == type) {
      sum += of[i][d];
      n++;
    }
  return sum / n;
}

// blocks that are pressed together have uniform stress, wherever the interface is between nodes
SERIAL_TEST(Blocks, ArePressed)
{
  for (const char *contact : {"", "law stick", "law coulomb 0.3", "gap no"})
    for (const double height : {0.5, 0.55}) {
      Scene run(blocks(contact, height, 0.0, 1e6, 0.3, "0 1 0 1") + walls() + "run 1\n");
      EXPECT_LT(
          measured(strprintf("%s at %g: scatter of stress", contact, height), scatter(run, 1)),
          1e-5);
      // plane strain, logarithmic strain, over the present width
      const double strain = std::log(0.99), force = touch(run, 1);
      const double exact =
          1e6 / (1.0 - 0.09) * strain * 0.8 / 0.99 * std::exp(-0.3 / 0.7 * strain) * 0.99;
      EXPECT_NEAR(measured("force over that of theory", force / exact), 1.0, 1e-2);
      EXPECT_NEAR(run.fix("floor")->compute_vector(1) / force, 1.0, 1e-7);
      EXPECT_NEAR(run.fix("lid")->compute_vector(1) / -force, 1.0, 1e-6);
    }

  // layers without an end, whichever node is the first one
  for (const std::string origin : {"0 0", "-0.1 0.3"}) {
    Scene run(plane("si", "p f", "0 0.8 0 1", 2, 0.02) +
              two_bodies_in("0 0.8 0 0.5 INF INF", "0 0.8 0.5 1 INF INF", "0.1 origin " + origin) +
              "fix touch all mpm/contact F1 F2\n"
              "fix floor all mpm/boundary ylo slip\n"
              "fix lid all mpm/boundary yhi slip velocity 0 -0.01 0\n"
              "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n");
    EXPECT_LT(measured("layers, origin " + origin + ": scatter of stress", scatter(run, 1)), 1e-5);
  }
}

// a soft block on one that is ten times as stiff: each has its own strain, up to the interface
SERIAL_TEST(Blocks, OfTwoMaterials)
{
  for (const double height : {0.5, 0.55}) {
    Scene run(blocks("", height, 0.0, 1e7, 0.0) +
              "fix sides all mpm/boundary xlo xhi slip\n"
              "fix floor all mpm/boundary ylo slip\n"
              "fix lid all mpm/boundary yhi slip velocity 0 -0.01 0\nrun 1\n");
    EXPECT_LT(measured(strprintf("%g: scatter of stress", height), scatter(run, 1)), 1e-6);
    // E ln(l) / l of both is the same
    double low = 0.0, high = 0.01;
    const double H = 1.0 - height;
    for (int k = 0; k < 60; k++) {
      const double d = 0.5 * (low + high), l = 1.0 - d / H, m = 1.0 - (0.01 - d) / height;
      (std::log(l) / l * 1e6 < std::log(m) / m * 1e7 ? high : low) = d;
    }
    const double l = 1.0 - low / H;
    EXPECT_NEAR(measured("force over that of theory", touch(run, 1) / (0.8e6 * std::log(l) / l)),
                1.0, 1e-4);
  }
}

// an interface that is inclined, under the same pressure from all sides: the stress is uniform and
// the force is that on a plane one, though points in a lattice make steps along it
SERIAL_TEST(Blocks, WithAnInclinedInterface)
{
  for (const char *contact : {"", "law stick"}) {
    double force[2];
    for (const double slope : {0.0, 0.4}) {
      Scene run(blocks(contact, slope == 0.0 ? 0.5 : 0.51, slope, 1e6, 0.2) + walls(PUSHED) +
                "run 1\n");
      force[slope > 0.0] = touch(run, 1);
      for (const int axis : {0, 1})
        EXPECT_LT(measured(strprintf("%s slope %g: scatter of stress", contact, slope),
                           scatter(run, axis)),
                  slope == 0.0 ? 1e-5 : 0.03);
    }
    EXPECT_NEAR(measured("force over that on a level interface", force[1] / force[0]), 1.0, 3e-4);
  }
}

// where friction is large, nothing slides: as with law stick, on any slope
SERIAL_TEST(Blocks, StickOnAnySlope)
{
  for (const double slope : first_of(2, {0.5, 1.5, 0.2, 0.8, 1.1})) {
    double force[2];
    for (const int friction : {0, 1}) {
      Scene run(blocks(friction ? "law coulomb 2.0" : "law stick", 0.51, slope, 1e6, 0.2) +
                walls(PUSHED) + "run 1\n");
      force[friction] = touch(run, 1);
    }
    EXPECT_NEAR(
        measured(strprintf("slope %g: force over that of law stick", slope), force[1] / force[0]),
        1.0, 1e-6);
  }
}

// what is pulled parts, and touches again where it has parted
SERIAL_TEST(Blocks, Part)
{
  Scene run(blocks("", 0.55, 0.0, 1e6, 0.0) +
            "fix sides all mpm/boundary xlo xhi slip\nfix floor all mpm/boundary ylo stick\n"
            "variable v equal 0.01-0.03*(step<2)\n"
            "fix lid all mpm/boundary yhi stick velocity 0 v_v 0\nrun 1\n");
  EXPECT_LT(touch(run, 1), -1e4);
  run.commands("run 3\n");
  EXPECT_NEAR(touch(run, 1), 0.0, 1e-9);
  EXPECT_EQ(touch(run, 3), 0.0);
  EXPECT_NEAR(run.fix("floor")->compute_vector(1), 0.0, 1e-6);
}

/** Blocks that are this many node spacings apart, of which a load pushes the upper one down. */
static std::string blocks_apart(double gap)
{
  return blocks("", 0.5, 0.0, 1e6, 0.0, "0 0.8 0 1.2", "static") +
      strprintf("displace_atoms up move 0 %.17g 0\n", gap * 0.1) +
      "fix sides all mpm/boundary xlo xhi slip\nfix floor all mpm/boundary ylo stick\n"
      "fix load up addforce 0 -200 0\n";
}

// a block above the other one by parts of a node spacing comes to it in the step, and not nearer
SERIAL_TEST(Blocks, ComeTogether)
{
  for (const double gap : {0.1, 0.35}) {
    Scene run(blocks_apart(gap) + "run 1\n");
    const double force = -200.0 * run.evaluate("count(up)");
    EXPECT_NEAR(touch(run, 1) / force, 1.0, 1e-6);
    EXPECT_NEAR(run.fix("floor")->compute_vector(1) / force, 1.0, 1e-6);
    // the lower block bears all of it, the upper one its share
    const double s = force / 0.8e6, exact_low = 0.25 * (1.0 + s),
                 exact_up = 0.5 * (1.0 + s) + 0.25 + s / 6.0;
    EXPECT_NEAR(
        measured("lower block, in node spacings", (mean(run, run.x(), 1, 1) - exact_low) / 0.1),
        0.0, 0.02);
    EXPECT_NEAR(measured("upper block", (mean(run, run.x(), 2, 1) - exact_up) / 0.1), 0.0, 0.03);
  }
}

// from 0.4 node spacings on nothing tells where it would come to rest
SERIAL_TEST(Blocks, AreTooFarApart)
{
  expect_error(blocks_apart(0.6) + "run 1\n", "no equilibrium");
}

// sides along a line of nodes through the interface, whose slope is round-off, are not part of it:
// the same for a lattice that is moved by round-off
SERIAL_TEST(Block, RoundOffOfASideIsNoSlope)
{
  const auto run = [](double origin) {
    const auto lattice = strprintf("mpm 1 shape cubic origin %g %g\n", origin, origin);
    Scene run(plane("lj", "f f", "0 14 0 12", 2) + R"(
region left block 1 5 2 6 INF INF
region right block 5 9 3 6 INF INF
create_points 1 region left spacing 0.5
create_points 2 region right spacing 0.5
group left type 1
group right type 2
velocity left set 0.3 0.1 0
)" + "fix F1 left " +
              lattice + "fix F2 right " + lattice + R"(
fix m1 left mpm/material density 2 linear 4.5 0.25
fix m2 right mpm/material density 1 linear 4.5 0.3
fix touch all mpm/contact F1 F2
fix solve all mpm/implicit euler tolerance 1e-11
timestep 0.1
run 1
)");
    return run.gather();
  };
  for (const double origin : {3e-15, -3e-15})
    EXPECT_LT(measured("difference", difference(run(0.0), run(origin))), 1e-12);
}

// a block of rubber on another one sticks on a slope below the coefficient of friction
SERIAL_TEST(Block, SticksOnAnotherOne)
{
  const auto scene = [](double along, const std::string &implicit, const std::string &law) {
    return plane("si", "f f", "0 1.5 0 0.8", 2, 0.02) +
        replaced(two_bodies_in("0 1.5 0 0.25 INF INF", "0.3 1.1 0.25 0.65 INF INF"), "ppc 2",
                 "spacing 0.05") +
        "fix touch all mpm/contact F1 F2 " + law + "\nfix floor all mpm/boundary ylo stick\n" +
        strprintf("fix g all gravity 10 vector %g -1 0\n", along) + "fix solve all mpm/implicit " +
        implicit + "\ntimestep 1.0\n";
  };
  const double mass = 0.8 * 0.4 * 1000.0;
  {
    Scene run(scene(0.2, "static", "law coulomb 0.3") + "run 1\n");
    const double g = 10.0 / std::sqrt(1.04);
    EXPECT_NEAR(measured("weight", touch(run, 1) / (mass * g)), 1.0, 1e-8);
    EXPECT_NEAR(measured("shear force over normal force", touch(run, 0) / -touch(run, 1)), 0.2,
                1e-8);
  }
  {
    Scene run(scene(0.5, "euler", "law coulomb 0.3") + "timestep 0.02\nrun 2\n");
    EXPECT_NEAR(measured("of what slides", touch(run, 0) / -touch(run, 1)), 0.3, 0.3 * 1e-2);
    EXPECT_LT(run.fix("touch")->compute_scalar(), 0.0);
  }
}

/** A block on a base in 3d, which begins to slide down a slope; place: of the block along x. */
static std::string block_on_base(const std::string &transfer, double mu, double slope,
                                 const std::string &solve, double place = 0.3)
{
  return space("si", "f f f", "0 2 0 1 0 1.2", 2, 0.02) +
      two_bodies_in("0.1 1.7 0.1 0.9 0 0.2", "0.3 1.1 0.2 0.8 0.2 0.8", "0.1" + transfer) +
      strprintf("displace_atoms up move %.17g 0 0 units box\n", place - 0.3) +
      strprintf("fix touch all mpm/contact F1 F2 law coulomb %g\n", mu) +
      "fix floor all mpm/boundary zlo stick\n" +
      strprintf("fix g all gravity 10 vector %g 0 -1\n", slope) + "fix solve all mpm/implicit " +
      solve + "\ntimestep 0.01\n";
}

// a block that slides on another one in 3d: iterations find the direction of friction of each line
// of nodes, also in short steps, and what sticks, slides, and parts
SERIAL_TEST(Block, SlidesIn3d)
{
  struct Case {
    const char *scheme, *transfer;
    double mu, slope, iterations, place = 0.3;
  };
  for (const Case &c :
       first_of(2,
                {Case{"newmark", " transfer flip 1.0", 0.1, 0.5, 45.0},
                 Case{"euler", "", 0.6, 1.2, 45.0}, Case{"euler", "", 0.1, 0.5, 45.0},
                 Case{"newmark", " transfer flip 1.0", 0.6, 1.2, 45.0},
                 Case{"euler", "", 1.5, 2.0, 75.0}, Case{"euler", "", 0.3, 0.5, 75.0, 0.335}})) {
    Scene run(block_on_base(c.transfer, c.mu, c.slope, strprintf("%s parts 1", c.scheme), c.place) +
              "run 3\n");
    const std::string name = strprintf("%s, friction %g: ", c.scheme, c.mu);
    EXPECT_LT(measured(name + "iterations in three steps", solved(run, 5)), c.iterations);
    // the front of the block bears most where friction is large, and its rear sticks or parts
    if (c.mu < 0.2) {
      EXPECT_NEAR(measured(name + "of what slides", touch(run, 0) / -touch(run, 2)), c.mu,
                  0.02 * c.mu);
    }
    EXPECT_NEAR(measured(name + "force across", touch(run, 1) / touch(run, 2)), 0.0, 1e-6);
  }
}

// with law stick, nodes would be pulled while they stick, and go into the other body: they slip
SERIAL_TEST(Block, SticksIn3d)
{
  for (const char *scheme : first_of(1, {"static", "euler"})) {
    const std::string scene =
        replaced(block_on_base("", 2.0, 0.5, strprintf("%s parts 1", scheme), 0.36),
                 "law coulomb 2", "law stick") +
        "timestep 0.1\n";
    const ScratchFile log("said.log");
    Scene run("log " + log.name + "\n" + scene + "run 3\nlog none\n");
    const std::string words = "of nodes between bodies slip without friction in step",
                      text = file_text(log.name);
    EXPECT_NE(text.find(words), std::string::npos);
    EXPECT_EQ(text.find(words), text.rfind(words));    // once
    const std::string name = strprintf("%s: ", scheme);
    EXPECT_LT(measured(name + "iterations in three steps", solved(run, 5)), 60.0);
    if (*scheme == 'e') continue;    // still in motion
    // gravity of 10 m/s^2 is inclined by 1:2
    const double weight = 0.8 * 0.6 * 0.6 * 1000.0 * 10.0;
    EXPECT_NEAR(measured(name + "force up", touch(run, 2) / weight), std::sqrt(0.8), 1e-5);
    EXPECT_NEAR(measured(name + "force along", touch(run, 0) / weight), -std::sqrt(0.2), 1e-5);
    EXPECT_NEAR(measured(name + "force across", touch(run, 1) / weight), 0.0, 1e-6);
  }
}

/** How much the upper of two bodies settles under their weight, over that of one body of both. */
static double settlement(const std::string &low, const std::string &up, double h)
{
  double down[2];
  for (const int contact : {0, 1}) {
    const std::string two = two_bodies_in(low, up, strprintf("%g", h)),
                      one = replaced(replaced(replaced(two, "fix F1 low mpm", "fix F1 all mpm"),
                                              strprintf("fix F2 up mpm %g\n", h), ""),
                                     "fix F2", "fix F1");
    Scene run(space("si", "f f f", "0 1.8 0 1.2 0 0.9", 2, 0.2 * h) + (contact ? two : one) +
              (contact ? "fix touch all mpm/contact F1 F2 law stick\n" : "") +
              "fix floor all mpm/boundary zlo stick\nfix g all gravity 10 vector 0 0 -1\n"
              "fix solve all mpm/implicit static parts 1\ntimestep 1\nrun 0\n");
    const double before = mean(run, run.x(), 2, 2);
    run.commands("run 1\n");
    down[contact] = before - mean(run, run.x(), 2, 2);
  }
  return down[1] / down[0];
}

// bodies bear each other up to their edges: a block on a wider base, and bars that cross
SERIAL_TEST(Block, BearsUpToItsEdges)
{
  const std::string base = "0.1 1.7 0.1 1.1 0 0.2", block = "0.3 1.1 0.3 0.9 0.2 0.8";
  EXPECT_NEAR(measured("block of 6 cells", settlement(base, block, 0.1)), 1.0, 0.08);
  if (is_quick()) return;    // these take long
  EXPECT_NEAR(measured("bars", settlement("0.1 1.5 0.5 0.9 0 0.4", "0.6 1 0.1 1.1 0.4 0.8", 0.1)),
              1.0, 0.4);
}
SERIAL_TEST(Block, BearsUpToItsEdgesOnAFineLattice)
{
  LONG_CASE();
  const double ratio = settlement("0.1 1.7 0.1 1.1 0 0.2", "0.3 1.1 0.3 0.9 0.2 0.8", 0.05);
  EXPECT_NEAR(measured("block of 12 cells", ratio), 1.0, 0.025);
}

// the same without inertia: a wall holds a block, under which the base is drawn away. Friction
// holds the block, but for lines at the wall
SERIAL_TEST(Block, IsHeldWhileItsBaseSlidesIn3d)
{
  LONG_CASE();
  for (const double mu : {0.1, 0.6, 1.5}) {
    Scene run(space("si", "f f f", "0 1.2 0 1 0 1", 2, 0.02) +
              two_bodies_in("0.1 1.1 0.1 0.9 0 0.2", "0 0.4 0.3 0.7 0.2 0.6") +
              strprintf("fix touch all mpm/contact F1 F2 law coulomb %g\n", mu) +
              "fix floor all mpm/boundary zlo stick velocity -0.02 0 0\n"
              "fix wall all mpm/boundary xlo slip\nfix g all gravity 10 vector 0 0 -1\n"
              "fix solve all mpm/implicit static parts 1\ntimestep 1\nrun 1\n");
    const std::string name = strprintf("friction %g: ", mu);
    EXPECT_NEAR(measured(name + "weight", std::fabs(touch(run, 2))), 640.0, 1e-3);
    EXPECT_NEAR(measured(name + "force over N", std::fabs(touch(run, 0) / touch(run, 2))), mu,
                0.02);
  }
}

// a block that slides on another one comes to rest after v^2/(2 mu g), and friction has its energy
SERIAL_TEST(Block, SlidesToRest)
{
  for (const char *scheme : first_of(1, {"newmark", "euler", "midpoint"})) {
    const double mu = 0.3, g = 10.0, v = 0.6, mass = 0.8 * 0.4 * 1000.0;
    const std::string contact = strprintf("fix touch all mpm/contact F1 F2 law coulomb %g\n", mu);
    Scene run(plane("si", "f f", "0 2 0 0.9", 2, 0.02) +
              two_bodies_in("0 2 0 0.2 INF INF", "0.3 1.1 0.2 0.6 INF INF",
                            *scheme == 'e' ? "0.1" : "0.1 transfer flip 1.0") +
              contact + "fix floor all mpm/boundary ylo stick\n" +
              strprintf("fix g all gravity %g vector 0 -1 0\n", g) +
              // its weight is borne first: else, gravity works on what sinks, and it swings
              "fix solve all mpm/implicit euler\ntimestep 0.05\nrun 20\nunfix solve\n"
              "unfix touch\n" +
              contact + strprintf("velocity all set 0 0 0\nvelocity up set %g 0 0\n", v) +
              "fix solve all mpm/implicit " + scheme + "\ntimestep 2e-3\n");
    run.commands("run 0\n");
    const double begin = mean(run, run.x(), 2, 0);
    run.commands("run 200\n");
    EXPECT_NEAR(measured(strprintf("%s: way over that of theory", scheme),
                         (mean(run, run.x(), 2, 0) - begin) / (v * v / (2.0 * mu * g))),
                1.0, 0.03);
    EXPECT_NEAR(measured("work of friction over the energy",
                         run.fix("touch")->compute_scalar() / (0.5 * mass * v * v)),
                -1.0, 0.04);
    EXPECT_LT(std::fabs(measured("velocity in the end", mean(run, run.v(), 2, 0))), 0.06 * v);
  }
}

// Lame: two rings of different stiffness with a pressure in the bore
SERIAL_TEST(Rings, PressOnEachOther)
{
  double error[2];
  for (const int fine : first_of(1, {0, 1})) {
    Scene run(
        plane("si", "f f", "0 2.5 0 2.5", 2, 0.03) +
        "region outer cylinder z 0 0 2 INF INF\nregion mid cylinder z 0 0 1.5 INF INF\n"
        "region beyond cylinder z 0 0 1.5 INF INF side out\n"
        "region bore cylinder z 0 0 1 INF INF side out\n" +
        replaced(fields({{"one", "intersect 2 mid bore"}, {"two", "intersect 2 outer beyond"}},
                        fine ? "0.0625" : "0.125"),
                 "ppc 2", "ppc 2 outside ignore cut yes") +
        "fix ma one mpm/material density 1000 linear 1e6 0.3\n"
        "fix mb two mpm/material density 1000 linear 4e6 0.3\n"
        "fix touch all mpm/contact F1 F2\nfix walls all mpm/boundary xlo ylo slip\n"
        "fix gas one mpm/traction region bore pressure 1e4 area $(PI/2)\n"
        "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n");
    const double exact = 5045.045;    // thick tubes with the same displacement at r = 1.5
    for (const int d : {0, 1}) {
      error[fine] = measured("pressure between the rings", touch(run, d) / 1.5 / exact) - 1.0;
      EXPECT_LT(std::fabs(error[fine]), fine ? 0.02 : 0.03);
    }
  }
}

/** Two free bodies that collide. */
static std::string colliding(const std::string &implicit, const std::string &grid = "0.1")
{
  return plane("si", "p p", "0 3 0 1", 2, 0.02) +
      replaced(two_bodies_in("0.5 1.2 0.2 0.8 INF INF", "1.23 1.8 0.1 0.6 INF INF", grid, "2000"),
               "ppc 2", "spacing 0.05") +
      "fix touch all mpm/contact F2 F1 law coulomb 0.2\nvelocity low set 1.0 0.3 0\n"
      "fix solve all mpm/implicit " +
      implicit + "\ntimestep 2e-3\n";
}

SERIAL_TEST(Bodies, KeepTheirMomentum)
{
  Scene run(colliding("euler tolerance 1e-12"));
  const auto start = run.sums();
  double energy = start.kinetic, push = 0.0;
  for (int k = 0; k < 15; k++) {
    run.commands("run 2\n");
    const auto now = run.sums();
    EXPECT_NEAR(now.p[0] / start.p[0], 1.0, 1e-10);
    EXPECT_NEAR(now.p[1] / start.p[1], 1.0, 1e-10);
    EXPECT_LT(now.kinetic, energy * (1.0 + 1e-6));
    energy = std::max(now.kinetic, 0.6 * start.kinetic);
    push = std::max(push, touch(run, 3));
  }
  EXPECT_GT(push, 0.0);
  EXPECT_LT(measured("kinetic energy over that of the start", run.sums().kinetic / start.kinetic),
            0.95);
}

// two equal bars press on each other by rho c v A for two passages, then swap velocities
SERIAL_TEST(Bars, Collide)
{
  for (const char *scheme : {"newmark", "midpoint"}) {
    Scene run(plane("si", "f p", "-2 2.5 0 0.1", 2, 0.02) +
              fields({{"l", "block -1 0 INF INF INF INF"}, {"r", "block 0.001 1 INF INF INF INF"}},
                     "0.05 transfer flip 1.0") +
              "fix m all mpm/material density 1000 linear 1e6 0.0\n"
              "velocity l set 0.5 0 0\nvelocity r set -0.5 0 0\n"
              "fix touch all mpm/contact F1 F2\ncompute e all mpm/energy\n"
              "thermo_style custom step c_e[1] c_e[2]\n"
              "fix solve all mpm/implicit " +
              std::string(scheme) + "\ntimestep 0.0015823\n");
    const double c = std::sqrt(1e6 / 1000.0), start = 0.5 * 200.0 * 0.25;
    double most = 0.0, impulse = 0.0, force = 0.0, v[2] = {0.0, 0.0};
    for (int k = 0; k < 60; k++) {
      run.commands("run 1\n");
      const double now = touch(run, 0);
      impulse += 0.0015823 * now;
      if (k == 20) force = now;
      const double *const energy = run.compute_vector();
      most = std::max(most, energy[0] + energy[1]);
    }
    for (int i = 0; i < run.n(); i++)
      v[run.lmp->atom->type[i] - 1] += run.mass()[i] * run.v()[i][0] / 100.0;
    EXPECT_NEAR(measured(strprintf("%s: force over rho c v A", scheme), force / (1e3 * c * 0.05)),
                1.0, 0.03);
    EXPECT_LT(measured("largest energy over that of the start", most / start), 1.0);
    EXPECT_NEAR(v[0] + v[1], 0.0, 1e-12);
    EXPECT_NEAR(measured("velocity after the impact", v[1]), 0.5, 0.05);
    EXPECT_NEAR(measured("impulse over the change of momentum", impulse / (100.0 * (v[1] + 0.5))),
                1.0, 1e-9);
  }
}

TEST(Blocks, OnRanks)
{
  OnRanks run(blocks("", 0.53, 0.1, 3e6, 0.3, "0 1 0 1", "static tolerance 1e-11") + walls(),
              "run 2\n");
  EXPECT_LT(measured("difference", run.difference()), 1e-7);
}

// in 3d, where lines of nodes at the edges of bodies have several that are equally full
TEST(Block, OnRanksIn3d)
{
  OnRanks run(block_on_base(" transfer flip 1.0", 0.1, 0.5, "euler tolerance 1e-11", 0.35),
              "run 1\n");
  EXPECT_LT(measured("difference", run.difference()), 1e-7);
}

TEST(Blocks, Restart)
{
  const auto scene = blocks("", 0.53, 0.0, 3e6, 0.3, "0 1 0 1") + walls();
  Continued run(scene, 1, lines_again(scene), 2);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

// in methods of second order, too, through an impact in which bodies slide along each other
TEST(Bodies, RanksAndRestart)
{
  for (const std::string scheme : {"newmark", "midpoint"}) {
    const std::string scene = colliding(scheme + " tolerance 1e-11", "0.1 transfer flip 1.0");
    Twins(scene, 20, lines_again(scene), 20, 1e-9);
  }
}

TEST(BadInput, IsRefused)
{
  struct Case {
    const char *contact, *implicit, *walls, *message;
  };
  const char *const floor = "fix floor all mpm/boundary ylo slip\n";
  for (const auto &c :
       {Case{"law adhesive 1e3 1e3 1", "static", floor, "law adhesive"},
        Case{"law coulomb 0.2 0.3", "static", floor, "static friction"},
        Case{"normal volume", "static", floor, "remove normal"},
        Case{"", "newmark", floor, "use transfer flip 1.0"},
        Case{"", "alpha", floor, "use newmark or midpoint"},
        Case{"", "static solver multigrid", floor, "use solver blocks"},
        Case{"", "static slip 0.1", floor, "walls with friction"},
        Case{"law coulomb 0.2", "static slip 0.1", floor, "walls with friction"},
        Case{"", "static", "fix floor all mpm/boundary ylo separate\n", "use stick or slip"},
        Case{"", "static", "fix floor all mpm/boundary ylo slip friction 0.1\n",
             "use stick or slip"},
        Case{"", "static", "unfix touch\nfix floor all mpm/boundary ylo slip\n",
             "name all of them in one fix mpm/contact"}})
    expect_error(blocks(c.contact, 0.5, 0.0, 1e6, 0.3, "0 1 0 1", c.implicit) + c.walls + "run 0\n",
                 c.message);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input physics

// Matter of two kinds in one box: what does not feel each other is told when it meets, once, with
// what couples it. What the messages name is run here, too, and does couple.

#include "mpm_lammps.h"
#include "stl_testing.h"

using namespace MPM_TEST;

const std::string MEETS = "go through each other, as nothing couples them";

/** A mesh of lines along x from 0.2 to 0.8, or of one row of 6 squares, at this height. */
static std::string mesh_text(bool squares, double y)
{
  const int n = 6, rows = squares ? 2 : 1;
  std::string text =
      strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", rows * (n + 1));
  for (int k = 0; k < rows; k++)
    for (int i = 0; i <= n; i++)
      text += strprintf("%d %.17g %.17g 0\n", k * (n + 1) + i + 1, 0.2 + 0.1 * i, y + 0.1 * k);
  text += strprintf("$EndNodes\n$Elements\n%d\n", n);
  for (int i = 1; i <= n; i++)
    text += squares ? strprintf("%d 3 2 0 1 %d %d %d %d\n", i, i, i + 1, i + n + 2, i + n + 1)
                    : strprintf("%d 1 2 0 1 %d %d\n", i, i, i + 1);
  return text + "$EndElements\n";
}

/** A box for two bodies, which fall onto each other: groups low and high. */
static std::string start()
{
  return plane("si", "f f", "0 1 0 1", 2, 0.02) +
      "group low empty\ngroup high empty\nregion low block 0.2 0.8 0.1 0.4 INF INF\n"
      "region high block 0.2 0.8 0.6 0.8 INF INF\n";
}

const std::string SOLID = "fix m all mpm/material density 1000 linear 1e5 0.3\n",
                  FALL = "velocity high set 0 -2 0\nfix step all mpm/dt 0.4\n",
                  TWO_FIELDS = "fix A low mpm 0.05\nfix B high mpm 0.05\n"
                               "create_points 1 region low ppc 2 fix A group low\n"
                               "create_points 2 region high ppc 2 fix B group high\n";

/** Times that a scene says that matter meets, in runs of these lengths. */
static int told(const std::string &scene, const std::string &runs = "run 120\n")
{
  return times_said(scene + runs, MEETS);
}

SERIAL_TEST(Coupled, TwoFields)
{
  const auto scene = start() + TWO_FIELDS + SOLID + FALL;
  EXPECT_EQ(told(scene, "run 5\n"), 0);    // not near each other yet
  EXPECT_EQ(told(scene, "run 120\nrun 10\n"), 1);
  EXPECT_EQ(told(scene + "velocity high set 0 2 0\n", "run 5\n"), 0);    // they part
  const auto words = lines_that_say(scene + "run 120\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("fix mpm/contact with A and B"));
  EXPECT_EQ(told(scene + "fix c all mpm/contact A B law coulomb 0.1\n"), 0);
  const std::string penalty = "pair_style mpm/penalty\npair_coeff * * 1e6\n";
  EXPECT_EQ(told(scene + penalty), 0);
  EXPECT_EQ(told(scene + "pair_style zero 0.05\npair_coeff * *\n"), 1);
  EXPECT_EQ(told(scene + replaced(penalty, "1e6", "0")), 1);

  // total frame: contact is refused there, so that another remedy is named
  const auto total =
      lines_that_say(replaced(scene, "mpm 0.05", "mpm 0.05 frame total") + "run 120\n", MEETS);
  ASSERT_EQ(total.size(), 1u);
  EXPECT_THAT(total[0], HasSubstr("pair_style mpm/penalty"));
  // one body on two lattices that nothing joins
  const std::string apart = replaced(start(), "0.6 0.8 INF", "0.4 0.6 INF") +
      replaced(TWO_FIELDS, "fix B high mpm 0.05", "fix B high mpm 0.025 origin 0.0125 0.0125") +
      SOLID + "fix step all mpm/dt 0.4\n";
  const auto joined = lines_that_say(apart + "run 2\n", MEETS);
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_THAT(joined[0], HasSubstr("fix mpm/refine with A and B"));
  EXPECT_EQ(told(apart + "fix r all mpm/refine A B\n", "run 2\n"), 0);
}

// the remedies hold the upper body: its lowest point stays above the middle of the lower one
SERIAL_TEST(Coupled, RemediesHold)
{
  const auto scene = start() + TWO_FIELDS + SOLID + "fix floor all mpm/boundary ylo slip\n" + FALL;
  const auto lowest = [](const std::string &text) {
    Scene run(text + "run 170\n");
    return run.evaluate("bound(high,ymin)-bound(low,ymin)");
  };
  EXPECT_LT(lowest(scene), 0.01);
  EXPECT_GT(lowest(scene + "fix c all mpm/contact A B law coulomb 0.1\n"), 0.15);
  EXPECT_GT(lowest(scene + "pair_style mpm/penalty\npair_coeff * * 1e6\n"), 0.15);
}

SERIAL_TEST(Coupled, FlowAndOthers)
{
  const ScratchFile lines("lines.msh", mesh_text(false, 0.6)),
      squares("squares.msh", mesh_text(true, 0.6));
  const std::string flow = "create_points 1 region low spacing 0.025 group low\n"
                           "fix w low mpm/incompressible 0.05 1000\n",
                    solid = "fix m high mpm/material density 1000 linear 1e5 0.3\n";
  const auto membrane = start() + flow + "create_points 2 mesh " + lines.name +
      " thickness 0.01 group high\n" + solid + "fix e high mpm/elements " + lines.name +
      " thickness 0.01\nfix nve high nve\n" + replaced(FALL, "0.4", "0.3 max 1e-2");
  EXPECT_EQ(told(membrane, "run 2\n"), 0);
  const auto words = lines_that_say(membrane + "run 80\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("eos tait for the fluid"));
  // the same with the flow defined last
  const std::string fix = "fix w low mpm/incompressible 0.05 1000\n";
  EXPECT_EQ(
      told(replaced(membrane, {{fix, ""}, {"fix nve high nve\n", "fix nve high nve\n" + fix}}),
           "run 80\n"),
      1);

  const auto mesh = start() + flow + "group low type 1\nfix F high mpm/mesh " + squares.name +
      "\ncreate_points 2 elements " + squares.name + " halve 1 group high\n" + solid +
      "velocity low set 0 2 0\nfix step all mpm/dt 0.4\n";
  const auto other = lines_that_say(mesh + "run 100\n", MEETS);
  ASSERT_EQ(other.size(), 1u);
  EXPECT_THAT(other[0], HasSubstr("keyword solid"));

  const auto field = start() + flow +
      "fix B high mpm 0.05\n"
      "create_points 2 region high ppc 2 fix B group high\n" +
      solid + FALL;
  EXPECT_EQ(told(field, "run 120\n"), 1);
}

// nodes that no fix mpm moves, and a field; the remedy of the message holds the membrane
SERIAL_TEST(Coupled, ElementsAndField)
{
  const ScratchFile lines("line.msh", mesh_text(false, 0.5));
  const auto scene = [&](const std::string &mover, const std::string &fields) {
    return start() + fields + "create_points 1 region low ppc 2 fix A group low\n" +
        "create_points 2 mesh " + lines.name + " thickness 0.02 group high\n" + SOLID +
        "fix e high mpm/elements " + lines.name + " thickness 0.02\n" + mover +
        "fix floor all mpm/boundary ylo slip field A\n" + FALL;
  };
  const auto free = scene("fix nve high nve\n", "fix A low mpm 0.05\n");
  EXPECT_EQ(told(free, "run 100\n"), 1);
  const auto held = scene("fix c all mpm/contact A B gap no normal volume\n",
                          "fix A low mpm 0.05\nfix B high mpm 0.05\n");
  EXPECT_EQ(told(held, "run 100\n"), 0);
  Scene through(free + "run 100\n"), on_top(held + "run 100\n");
  EXPECT_LT(through.evaluate("bound(high,ymin)-bound(low,ymax)"), -0.05);
  EXPECT_GT(on_top.evaluate("bound(high,ymin)-bound(low,ymax)"), -0.05);
}

/** A block of points on a floor, and a grain that falls onto it. granular: atom style and pairs. */
static std::string grain_and(const std::string &points, const std::string &more = "")
{
  return replaced(start(), "atom_style mpm", "atom_style hybrid sphere mpm") + points +
      "create_atoms 2 single 0.5 0.6 0\nset type 2 diameter 0.2 density 2500\ngroup high type 2\n"
      "velocity high set 0 -2 0\nfix move high nve/sphere disc\nfix flat high enforce2d\n" +
      more;
}

const std::string BLOCK = "fix A low mpm 0.05\ncreate_points 1 region low ppc 2 fix A group low\n"
                          "fix m low mpm/material density 1000 linear 1e5 0.3\n"
                          "fix floor all mpm/boundary ylo slip\n",
                  STEPS = "fix step all mpm/dt 0.4 max 1e-3\n";

SERIAL_TEST(Coupled, GrainAndField)
{
  const auto free = grain_and(BLOCK, STEPS);
  EXPECT_EQ(told(free, "run 5\n"), 0);    // not there yet
  EXPECT_EQ(told(free, "run 200\nrun 20\n"), 1);
  EXPECT_EQ(told(free + "velocity high set 0 0 0\n", "run 100\n"), 0);    // beside each other
  EXPECT_EQ(told(free + "velocity high set 2 0 0\n", "run 100\n"), 0);
  EXPECT_EQ(told(free + "pair_style zero 0.3\npair_coeff * *\n"), 1);
  const auto words = lines_that_say(free + "run 200\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("grains of fix move (style nve/sphere)"));
  EXPECT_THAT(words[0], HasSubstr("pair_style granular and fix mpm/surface"));
  // the remedy holds the grain
  const std::string pairs = "comm_modify vel yes\npair_style granular\n"
                            "pair_coeff * * hooke 2e4 50 tangential linear_nohistory 0 0\n"
                            "fix skin low mpm/surface\n";
  const auto held = grain_and(BLOCK, pairs + STEPS);
  EXPECT_EQ(told(held, "run 200\n"), 0);
  const auto above = [](const std::string &text) {
    Scene run(text + "run 200\n");
    return run.evaluate("bound(high,ymin)-xcm(low,y)");
  };
  EXPECT_LT(above(free), 0.0);
  EXPECT_GT(above(held), 0.1);
  // grains of another type that feel nothing are told, too
  EXPECT_EQ(
      told(replaced(held,
                    {{"pair_style granular", "pair_style hybrid granular"},
                     {"* * hooke", "2 2 granular hooke"},
                     {"fix skin low mpm/surface\n", "pair_coeff 1 1 none\npair_coeff 1 2 none\n"}}),
           "run 200\n"),
      1);
}

// grains that come during a run, and small ones
SERIAL_TEST(Coupled, GrainsBelowCells)
{
  const std::string water = replaced(BLOCK, "linear 1e5 0.3", "eos tait 1e5 7");
  const auto free = replaced(grain_and(water, STEPS), "diameter 0.2", "diameter 0.01");
  const std::string immersed = "fix drag high mpm/immersed A 1000 1e-3\n";
  EXPECT_EQ(told(free, "run 200\n"), 1);
  EXPECT_EQ(told(free + immersed, "run 200\n"), 0);
  const auto later = replaced(free, "create_atoms 2 single 0.5 0.6 0\n", "") +
      "run 50\n"
      "create_atoms 2 single 0.5 0.3 0\nset type 2 diameter 0.01 density 2500\ngroup high type 2\n";
  EXPECT_EQ(told(later, "run 20\n"), 1);
  EXPECT_EQ(told(later + immersed, "run 20\n"), 0);
}

SERIAL_TEST(Coupled, GrainAndFlow)
{
  const std::string flow = "create_points 1 region low spacing 0.025 group low\n";
  const auto free = replaced(grain_and(flow, "fix w low mpm/incompressible 0.05 1000\n" + STEPS),
                             "diameter 0.2", "diameter 0.04");
  const auto words = lines_that_say(free + "run 200\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("use fix mpm/immersed with w"));
  EXPECT_EQ(told(free + "fix drag high mpm/immersed w 1000 1e-3\n", "run 200\n"), 0);
}

// a membrane that finite elements and fix nve move, and a grain; the remedy holds the grain
SERIAL_TEST(Coupled, GrainAndElements)
{
  const ScratchFile lines("net.msh", mesh_text(false, 0.3));
  const std::string membrane = "create_points 1 mesh " + lines.name +
      " thickness 0.01 group low\nfix m low mpm/material density 1000 linear 1e6 0.3\n"
      "fix e low mpm/elements " +
      lines.name + " thickness 0.01\nfix nve low nve\n";
  const auto free = grain_and(membrane, "timestep 1e-4\n");
  const auto words = lines_that_say(free + "run 2000\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("pair_style granular, and set ... diameter"));
  const auto held = grain_and(membrane,
                              "timestep 1e-4\nset type 1 diameter 0.1\n"
                              "comm_modify vel yes\npair_style granular\n"
                              "pair_coeff 1 1 hooke 0 0 tangential linear_nohistory 0 "
                              "0\npair_coeff 2 2 hooke 0 0 tangential linear_nohistory 0 0\n"
                              "pair_coeff 1 2 hooke 1e5 0 tangential linear_nohistory 0 0\n");
  EXPECT_EQ(told(held, "run 2000\n"), 0);
  const auto above = [](const std::string &text) {
    Scene run(text + "run 2000\n");
    return run.evaluate("xcm(high,y)-xcm(low,y)");
  };
  EXPECT_LT(above(free), 0.0);
  EXPECT_GT(above(held), 0.0);
}

// a rigid body goes through what no fix mpm moves; with the remedy it carries the membrane along
SERIAL_TEST(Coupled, RigidBodyAndMembrane)
{
  std::string mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n81\n";
  for (int k = 0; k < 81; k++) mesh += strprintf("%d %d %d 0\n", k + 1, k % 9 - 4, k / 9 - 4);
  mesh += "$EndNodes\n$Elements\n128\n";
  for (int k = 0, n = 0; k < 72; k++)
    if (k % 9 < 8)
      for (int half = 0; half < 2; half++)
        mesh += strprintf("%d 2 2 0 1 %d %d %d\n", ++n, k + 1, half ? k + 11 : k + 2,
                          half ? k + 10 : k + 11);
  const ScratchFile net("net.msh", mesh + "$EndElements\n"), ball("ball.stl", ball_stl(6));
  const auto scene = [&](const std::string &mover, const std::string &speed = "-10") {
    return space("si", "f f f", "-6 6 -6 6 -6 6", 2, 0.5) +
        "group low empty\ngroup high empty\nfix A low mpm 1\n"
        "region lay block -6 -5 -6 -5 -6 -5\n"
        "create_points 2 region lay ppc 2 fix A group low\ncreate_points 1 mesh " +
        net.name + " thickness 0.1 group high\n" + mover +
        "fix m all mpm/material density 1000 linear 1e6 0.3\nfix skin high mpm/elements " +
        net.name + " thickness 0.1\nregion r mpm/mesh " + ball.name +
        " 1.5 0 0 3\nfix R all mpm/rigid r density 1000 separate gravity 0 0 0 velocity 0 0 " +
        speed + "\ntimestep 1e-3\n";
  };
  const std::string nve = "fix nve high nve\n";
  EXPECT_EQ(told(scene(nve), "run 100\n"), 0);          // not there yet
  EXPECT_EQ(told(scene(nve, "10"), "run 200\n"), 0);    // away from it
  const auto words = lines_that_say(scene(nve) + "run 500\nrun 20\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("Points of fix skin (style mpm/elements) and the body of fix R"));
  EXPECT_THAT(words[0], HasSubstr("use a fix mpm for these points"));
  const auto held = scene("fix B high mpm 1\n");
  EXPECT_EQ(told(held, "run 500\n"), 0);
  Scene through(scene(nve) + "run 500\n"), on(held + "run 500\n");
  EXPECT_NEAR(through.evaluate("f_R[6]"), -10.0, 1e-12);
  EXPECT_GT(on.evaluate("f_R[6]"), -9.0);
  EXPECT_LT(on.evaluate("vcm(high,z)"), -0.1);
}

// grains in a rigid body; spheres of fix rigid that hold them are another matter
SERIAL_TEST(Coupled, RigidBodyAndGrains)
{
  const ScratchFile ball("ball.stl", ball_stl(6));
  const auto scene = [&](const std::string &place) {
    return replaced(space("si", "f f f", "-6 6 -6 6 -6 6", 2, 0.5), "atom_style mpm",
                    "atom_style hybrid sphere mpm") +
        "group low empty\nfix A low mpm 1\nregion lay block -6 -5 -6 -5 -6 -5\n"
        "create_points 2 region lay ppc 2 fix A group low\n"
        "fix m all mpm/material density 1000 linear 1e6 0.3\ncreate_atoms 1 single " +
        place +
        "\nset type 1 diameter 0.5 density 1000\ngroup high type 1\nfix move high nve/sphere\n"
        "region r mpm/mesh " +
        ball.name +
        " 1.5 0 0 3\nfix R all mpm/rigid r density 1000 "
        "separate gravity 0 0 0 velocity 0 0 -10\ntimestep 1e-3\n";
  };
  const auto words = lines_that_say(scene("0 0 0") + "run 400\n", MEETS);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("Grains of fix move (style nve/sphere) and the body of fix R"));
  EXPECT_EQ(told(scene("3 0 0"), "run 400\n"), 0);    // it passes by
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks input
// mpi: 1 3
// timeout: 900

// Surfaces inside of one field: pieces that part, slide, and meet again; cracks that open and
// close; shapes that must not come apart.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Two blocks of 8 by 8 cells in one field, GAP apart, turned by ANGLE degrees, with the
 *  velocities -+(UX, UY)/2 along and across the line from the first one to the second one. Fields
 *  of their own: see two_fields(). */
static const std::string blocks = plane("si", "f f", "-30 30 -30 30", 2, 0.5) + R"(
variable c equal cos(ANGLE*PI/180)
variable s equal sin(ANGLE*PI/180)
region A block -8 0 -4 4 INF INF
region B block 0 8 -4 4 INF INF
FIELDS
group A type 1
group B type 2
displace_atoms A move $(-0.37*GAP) 0.1 0
displace_atoms B move $(0.63*GAP) 0.1 0
displace_atoms all rotate 0 0 0 0 0 1 ANGLE
fix m all mpm/material density 1.0 neohookean 1500.0 0.25
CONTACT
velocity A set $(-0.5*(UX*v_c-UY*v_s)) $(-0.5*(UX*v_s+UY*v_c)) 0
velocity B set $(0.5*(UX*v_c-UY*v_s)) $(0.5*(UX*v_s+UY*v_c)) 0
timestep 0.006
compute e all mpm/energy
variable vx equal vcm(B,x)-vcm(A,x)
variable vy equal vcm(B,y)-vcm(A,y)
variable parting equal v_vx*v_c+v_vy*v_s
variable sliding equal v_vy*v_c-v_vx*v_s
variable px equal vcm(all,x)
variable along atom x*v_c+y*v_s
compute lo B reduce min v_along
compute hi A reduce max v_along
variable gap equal c_lo-c_hi-0.5
)";

static std::string two_blocks(const std::string &options, double gap, double ux, double uy,
                              double angle = 0.0)
{
  return replaced(blocks,
                  {{"FIELDS",
                    "fix grid all mpm 1.0 " + options +
                        " apart ignore\ncreate_points 1 region A ppc 2\n"
                        "create_points 2 region B ppc 2 overlap yes"},
                   {"CONTACT", "fix cracks all mpm/fracture surface yes"},
                   {"GAP", strprintf("%g", gap)},
                   {"UX", strprintf("%g", ux)},
                   {"UY", strprintf("%g", uy)},
                   {"ANGLE", strprintf("%g", angle)}});
}

/** The same in two fields. */
static std::string two_fields(const std::string &one, const std::string &contact)
{
  std::string two = replaced(one, "fix cracks all mpm/fracture surface yes", contact);
  const auto at = two.find("fix grid all"), end = two.find('\n', at);
  const std::string line = two.substr(at, end - at);
  two.replace(at, end - at,
              "group A type 1\ngroup B type 2\n" + replaced(line, "grid all", "FA A") + "\n" +
                  replaced(line, "grid all", "FB B"));
  return replaced(
      two,
      {{"region A ppc 2", "region A ppc 2 fix FA"}, {"region B ppc 2", "region B ppc 2 fix FB"}});
}

// Pieces that part keep their speed, whatever is between them: in one field without sides .14 of it
// is left with half a cell
SERIAL_PARAMETER_TEST(Parting, KeepsTheSpeed, std::string,
                      Values("transfer apic", "transfer aflip 0.99", "shape cubic transfer apic",
                             "shape gimp transfer flip 0.99", "stress gradient"))
{
  LONG_AFTER(2);
  for (const double gap : {0.1, 0.5, 1.5}) {
    Scene run(two_blocks(GetParam(), gap, 1.0, 0.0) + "run 500\n");
    EXPECT_NEAR(measured(strprintf("gap %g: speed", gap), run.variable("parting")), 1.0, 1.0e-3);
    EXPECT_NEAR(run.variable("gap"), gap + 3.0, 0.01);
    EXPECT_NEAR(run.variable("px"), 0.0, 1.0e-13);
  }
}

SERIAL_PARAMETER_TEST(AtAnAngle, KeepsTheSpeed, double, Values(22.5, 45.0))
{
  for (const double gap : {0.25, 1.0})
    for (const bool slides : {false, true}) {
      Scene run(
          two_blocks("transfer apic", gap, slides ? 0.0 : 1.0, slides ? 1.0 : 0.0, GetParam()) +
          "run 500\n");
      EXPECT_NEAR(measured(strprintf("gap %g: %s", gap, slides ? "sliding" : "parting"),
                           run.variable(slides ? "sliding" : "parting")),
                  1.0, 1.0e-3);
      EXPECT_NEAR(run.variable("px"), 0.0, 1.0e-13);
    }
}

SERIAL_PARAMETER_TEST(Sliding, KeepsTheSpeed, std::string,
                      Values("transfer apic", "transfer aflip 0.99", "shape cubic transfer apic"))
{
  LONG_AFTER(1);
  for (const double gap : {0.25, 1.0}) {
    Scene run(two_blocks(GetParam(), gap, 0.0, 1.0) + "run 500\n");
    EXPECT_NEAR(measured(strprintf("gap %g: speed", gap), run.variable("sliding")), 1.0, 1.0e-3);
    EXPECT_NEAR(run.variable("px"), 0.0, 1.0e-13);
  }
}

// Two blocks that meet are those of two fields with fix mpm/contact gap yes: the same gap when they
// touch, the same speed after it; and energy is what it was but for what transfers and contact take
SERIAL_PARAMETER_TEST(Meeting, IsThatOfTwoFields, double, Values(0.0, 22.5, 45.0))
{
  const std::string one = two_blocks("transfer aflip 0.999", 1.5, -1.0, 0.0, GetParam());
  double least[2] = {10.0, 10.0}, speed[2];
  for (const int k : {0, 1}) {
    Scene run((k == 0 ? one : two_fields(one, "fix touch all mpm/contact FA FB gap yes")) +
              "run 0\n");
    const double energy = run.compute_scalar();
    for (int n = 0; n < 60; n++) {
      run.commands("run 10 post no\n");
      least[k] = std::min(least[k], run.variable("gap"));
    }
    speed[k] = run.variable("parting");
    EXPECT_NEAR(run.variable("px"), 0.0, 1.0e-13);
    const double *e = run.compute_vector();
    EXPECT_NEAR(measured("residual", e[13]), 0.0, 0.002 * energy);
    if (k == 0) EXPECT_NEAR(e[7], -run.evaluate("f_cracks[2]"), 1e-12 * energy);
  }
  EXPECT_NEAR(measured("least gap", least[0]), measured("of two fields", least[1]), 0.02);
  EXPECT_GT(measured("speed", speed[0]), 0.0);
  EXPECT_NEAR(speed[0], measured("of two fields", speed[1]), 0.01 * speed[1]);
}

// Nodes keep their old velocities for an account of energy only; sides do so always
SERIAL_TEST(Meeting, WorkIsTheSameWithoutAnAccount)
{
  const std::string scene =
      replaced(two_blocks("transfer apic", 0.5, -1.0, 0.4), "fracture surface yes",
               "fracture surface yes law coulomb 0.3");
  Scene with(scene + "run 200\n"),
      without(replaced(scene, "compute e all mpm/energy\n", "") + "run 200\n");
  const double work = measured("work", with.evaluate("f_cracks[2]"));
  EXPECT_GT(work, 0.1);
  EXPECT_NEAR(without.evaluate("f_cracks[2]"), work, 1e-12 * work);
}

// Cubes in space
SERIAL_TEST(Cubes, PartAndMeet)
{
  for (const double speed : {1.0, -1.0}) {
    Scene run(space("si", "f f f", "-16 16 -10 10 -10 10", 2, 0.5) + R"(
region A block -5.5 -0.5 -2.5 2.5 -2.5 2.5
region B block 0.5 5.5 -2.5 2.5 -2.5 2.5
fix grid all mpm 1.0 transfer aflip 0.999 apart ignore origin -0.5 0.5 0.5
create_points 1 region A ppc 2
create_points 2 region B ppc 2 overlap yes
group A type 1
group B type 2
fix m all mpm/material density 1.0 neohookean 1500.0 0.25
fix cracks all mpm/fracture surface yes
variable v equal vcm(B,x)-vcm(A,x)
)" +
              strprintf("velocity A set %g 0 0\nvelocity B set %g 0 0\ntimestep 0.006\nrun 300\n",
                        -0.5 * speed, 0.5 * speed));
    const double after = measured("speed", run.variable("v"));
    if (speed > 0.0)
      EXPECT_NEAR(after, 1.0, 1.0e-3);
    else
      EXPECT_GT(after, 0.7);
    EXPECT_NEAR(run.sums().p[0], 0.0, 1.0e-11);
  }
}

// A block that slides on a floor in the same field is slowed down by friction
SERIAL_TEST(Friction, SlowsDownABlock)
{
  for (const double mu : {0.0, 0.3}) {
    Scene run(plane("si", "f f", "-16 16 -4 8", 2, 0.5) + R"(
region floor block -14 14 -4 -1 INF INF
region body block -10 -4 0 3 INF INF
fix grid all mpm 1.0
create_points 1 region floor ppc 2
create_points 2 region body ppc 2
group body type 2
displace_atoms body move 0 -1 0
fix m all mpm/material density 1.0 neohookean 3000.0 0.0
fix g all gravity 1.0 vector 0 -1 0
fix bed all mpm/boundary ylo stick
timestep 0.006
variable v equal vcm(body,x)
)" + strprintf("fix cracks all mpm/fracture surface group body law coulomb %g\n", mu) +
              "fix damp all viscous 2.0\nrun 300\nunfix damp\nvelocity body set 3.0 NULL NULL\n"
              "run 50\n");
    const double v = run.variable("v"), t = run.time();
    run.commands("run 500\n");
    const double slower = measured("deceleration", (v - run.variable("v")) / (run.time() - t));
    EXPECT_NEAR(slower, mu, mu > 0.0 ? 0.03 * mu : 1.0e-3);
  }
}

// A block, thin strips, a ring, a corner, and the end of a notch that spin have no sides
SERIAL_PARAMETER_TEST(
    Shapes, StayWhole, std::string,
    Values("body block -6 6 -6 6 INF INF", "body block -12 12 -1 1 INF INF",
           "body block -12 12 -1.5 1.5 INF INF", "body cylinder z 0 0 8 INF INF",
           "a block -8 8 -3 3 INF INF\nregion b block -8 -2 -8 3 INF INF\nregion body union 2 a b"))
{
  LONG_AFTER(3);
  Scene run(plane("si", "f f", "-20 20 -20 20", 1, 0.5) + "region " + GetParam() +
            "\nfix grid all mpm 1.0\ncreate_points 1 region body ppc 2\n"
            "fix m all mpm/material density 1.0 neohookean 1500.0 0.25\n"
            "fix cracks all mpm/fracture surface yes\n"
            "variable vx atom -0.3*y\nvariable vy atom 0.3*x\nvelocity all set v_vx v_vy NULL\n"
            "timestep 0.006\n");
  for (int k = 0; k < 20; k++) {
    run.commands("run 25 post no\n");
    EXPECT_EQ(run.evaluate("f_cracks"), 0.0) << k;
  }
}

/** A strip of 24 by 6 cells, turned by ANGLE degrees, whose middle band of one cell breaks as soon
 *  as it is pulled. */
static const std::string strip = plane("si", "f f", "-20 20 -20 20", 2, 0.5) +
    R"(
variable c equal cos(ANGLE*PI/180)
variable s equal sin(ANGLE*PI/180)
region strip block -12 12 -3 3 INF INF
fix grid all mpm 1.0 OPTIONS apart ignore
create_points 1 region strip ppc 2
region left block EDGE 0.0 EDGE EDGE INF INF
region right block 0.0 EDGE EDGE EDGE INF INF
region band block -0.5 0.5 EDGE EDGE INF INF
group left region left
group right region right
set region band type 2
group band type 2
group solid type 1
displace_atoms all rotate 0 0 0 0 0 1 ANGLE
fix m solid mpm/material density 1.0 eos linear 1000.0 strength elastic 600.0
)"
    "fix weak band mpm/material density 1.0 eos linear 1000.0 strength elastic 600.0 "
    "damage rankine STRENGTH\n"
    R"(CRACKS
timestep 0.006
velocity left set $(-0.5*SPEED*v_c) $(-0.5*SPEED*v_s) 0
velocity right set $(0.5*SPEED*v_c) $(0.5*SPEED*v_s) 0
compute e all mpm/energy
variable speed equal (vcm(right,x)-vcm(left,x))*v_c+(vcm(right,y)-vcm(left,y))*v_s
variable px equal vcm(all,x)
)";

static std::string broken_strip(const std::string &cracks, double speed, double angle = 0.0,
                                const std::string &options = "", double strength = 0.01)
{
  return replaced(strip,
                  {{"CRACKS", cracks},
                   {"EDGE", "INF"},
                   {"OPTIONS", options},
                   {"STRENGTH", strprintf("%g", strength)},
                   {"SPEED", strprintf("%g", speed)},
                   {"ANGLE", strprintf("%g", angle)}});
}

// The halves of a body that has broken fly apart with the speed that they have had; without sides
// they hold each other
SERIAL_PARAMETER_TEST(BrokenStrip, FliesApart, double, Values(0.0, 22.5, 45.0))
{
  double speed[2];
  for (const int k : {0, 1}) {
    Scene run(broken_strip(k ? "" : "fix cracks all mpm/fracture", 1.0, GetParam()) + "run 800\n");
    speed[k] = measured(k ? "without sides" : "speed", run.variable("speed"));
    EXPECT_NEAR(run.variable("px"), 0.0, 1.0e-13);
  }
  EXPECT_GT(speed[0], 0.97);
  EXPECT_LT(speed[1], 0.9);
}

// A crack that is open by a small part of a cell bears no pressure until it is closed, and bears
// all of it then
SERIAL_TEST(Crack, ClosesWhereItHasOpened)
{
  Scene run(broken_strip("fix cracks all mpm/fracture", 0.5, 0.0, "transfer aflip 0.999") +
            "variable w equal xcm(right,x)-xcm(left,x)\nrun 0\n");
  const double whole = run.variable("w");
  run.commands("run 40\n");
  const double open = measured("open", run.variable("w") - whole);
  EXPECT_GT(open, 0.05);
  EXPECT_LT(open, 0.2);
  run.commands("velocity left set 0.25 0 0\nvelocity right set -0.25 0 0\n");
  double least = 1.0, before = 1.0;
  for (int n = 0; n < 100; n++) {
    run.commands("run 2 post no\n");
    const double w = run.variable("w") - whole;
    if (run.variable("speed") > -0.45) before = std::min(before, w);
    least = std::min(least, w);
  }
  EXPECT_LT(measured("gap at which they begin to push", before), 0.0);
  EXPECT_GT(before, -0.1);
  EXPECT_GT(measured("least gap", least), -0.2);
  EXPECT_GT(measured("speed", run.variable("speed")), 0.3);
}

// Where nothing is damaged, and no body has a marked surface, the fix changes no bit
SERIAL_TEST(Undamaged, NoBitChanges)
{
  const std::string scene = broken_strip("CRACKS", -1.0, 0.0, "", 1.0e6);
  Scene with(replaced(scene, "CRACKS", "fix cracks all mpm/fracture") + "run 200\n");
  Scene without(replaced(scene, "CRACKS", "") + "run 200\n");
  EXPECT_TRUE(identical(with.gather(), without.gather()));
}

TEST(Sides, RanksAgreeAlsoAfterARestart)
{
  const std::string scene =
      replaced(two_blocks("transfer aflip 0.99", 1.0, -1.0, 0.4, 22.5), "fracture surface yes",
               "fracture surface yes law coulomb 0.3");
  Twins run(scene, 220, lines_again(scene), 80, 1e-10);
  EXPECT_GT(run.whole.evaluate("f_cracks[2]"), 0.0);
  EXPECT_EQ(run.whole.evaluate("f_cracks[2]"), run.again.evaluate("f_cracks[2]"));
  EXPECT_NEAR(run.whole.evaluate("f_cracks[2]"), run.serial.evaluate("f_cracks[2]"), 1e-9);
}

// Bodies across periodic faces, of regular arrays of points, for which several axes are alike
TEST(Sides, AreNotAMatterOfRounding)
{
  const std::string scene = space("metal", "p p f", "0 48 0 24 -40 20", 2, 2.0) + R"(
region a block 20 48 4 20 -8 0
region b block 0 14 4 20 -8 0
region c block 10 30 2 22 1 8
fix grid all mpm 2.0 transfer aflip 0.99 apart ignore
create_points 1 region a ppc 2
create_points 1 region b ppc 2
create_points 2 region c ppc 2
group c type 2
fix m all mpm/material density 2.0 neohookean 1.0e5 0.25
fix cracks all mpm/fracture surface yes law coulomb 0.2
velocity c set 3.0 2.0 -3.0
velocity all set 1.0 0.5 0 sum yes
fix step all mpm/dt 0.4
fix bal all balance 20 1.1 shift xy 10 1.1
)";
  Twins run(scene, 14, lines_again(scene), 16, 1e-11);
  EXPECT_GT(run.whole.evaluate("f_cracks[2]"), 0.0);
}

TEST(BrokenStrip, IsTheSameOnRanksAndAfterARestart)
{
  const std::string scene = broken_strip("fix cracks all mpm/fracture", 1.0, 22.5);
  Twins run(scene, 60, lines_again(scene), 200, 1e-10);
}

SERIAL_TEST(BadInput, NothingThatCanBreakIsToldOf)
{
  const std::string scene = two_blocks("transfer apic", 1.0, 1.0, 0.0) + "run 0\n";
  EXPECT_EQ(times_said(replaced(scene, "surface yes", ""), "finds no surfaces"), 1);
  EXPECT_EQ(times_said(scene, "WARNING"), 0);
}

TEST(BadInput, IsRefused)
{
  const std::string scene = replaced(two_blocks("transfer apic", 1.0, 1.0, 0.0),
                                     "fix cracks all mpm/fracture surface yes\n", "");
  expect_refused(
      scene,
      {
          {"fix cracks A mpm/fracture", "use group all"},
          {"fix cracks all mpm/fracture separable 0", "must be above 0 and at most 1: 0"},
          {"fix cracks all mpm/fracture separable 1.1", "must be above 0 and at most 1: 1.1"},
          {"fix cracks all mpm/fracture separable nan", "separable"},
          {"fix cracks all mpm/fracture separable", "Illegal fix mpm/fracture separable"},
          {"fix cracks all mpm/fracture surface maybe", "surface maybe"},
          {"fix cracks all mpm/fracture surface group", "Illegal fix mpm/fracture surface group"},
          {"fix cracks all mpm/fracture surface group C", "Group C for fix mpm/fracture cracks"},
          {"fix cracks all mpm/fracture law glue", "law glue"},
          {"fix cracks all mpm/fracture law adhesive 1 1 1", "law adhesive"},
          {"fix cracks all mpm/fracture law coulomb -0.1", "must not be negative"},
          {"fix cracks all mpm/fracture law coulomb 0.3 0.2", "must not be below that of friction"},
          {"fix cracks all mpm/fracture opening 1", "Unknown fix mpm/fracture keyword: opening"},
          {"fix cracks all mpm/fracture\nfix more all mpm/fracture", "one acts on all bodies"},
          {"fix cracks all mpm/fracture\nuncompute e\nunfix m\nunfix grid", "mpm"},
      },
      "run 1\n");
}

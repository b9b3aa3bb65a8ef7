// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks input
// mpi: 1 3
// timeout: 900

// Cracks by a phase field: their energy, their strength, and what must not break.

#include "law/phase_field.h"
#include "material/material_point.h"
#include "material/phase_field.h"

#include "mpm_lammps.h"

using namespace MPM_TEST;
using MPM_NS::law::Degradation;
using MPM_NS::law::PhaseField;

// Strain of a homogeneous bar over that at its strength, with E = GC = 1, l = .05, and strengths of
// 1 and 2: reference values of the equation of equilibrium, -g' w_p = GC/(c0 l) w'
SERIAL_TEST(HomogeneousBar, StrainIsThatOfACohesiveCrack)
{
  struct Row {
    double strength, d, strain;
  };
  for (const Row &row : {Row{1, .1, 3.22916}, Row{1, .5, 9.79930}, Row{1, .9, 12.61507},
                         Row{2, .1, 1.41479}, Row{2, .5, 2.63732}, Row{2, .9, 3.16127}}) {
    const PhaseField f = PhaseField::cohesive();
    const double k = f.toughness(1.0, 0.05, 0.0), s = row.strength;
    const double a = 2.0 * f.xi * k / (s * s);
    const Degradation g(row.d, a);
    const double energy = -k * f.slope(row.d) / g.slope;    // E strain^2/2
    EXPECT_NEAR(std::sqrt(2.0 * energy) / s, row.strain, 1.0e-5);
    // and the stress is (1 - d)^2 of the strength
    EXPECT_NEAR(g.value * std::sqrt(2.0 * energy) / s, std::pow(1.0 - row.d, 2), 1.0e-12);
  }
}

// Its largest stress: (9/16) sqrt(E GC/(3 l)) with AT2, sqrt(3 E GC/(8 l)) with AT1
SERIAL_TEST(HomogeneousBar, StrengthFollowsFromTheLength)
{
  const PhaseField at1 = PhaseField::at1(), at2 = PhaseField::at2();
  const auto stress = [](const PhaseField &f, double d) {
    const Degradation g(d, PhaseField::SQUARE);
    return g.value * std::sqrt(-2.0 * f.toughness(1.0, 0.05, 0.0) * f.slope(d) / g.slope);
  };
  EXPECT_NEAR(stress(at1, 0.0), 2.7386128, 1.0e-7);
  EXPECT_NEAR(stress(at2, 0.25), 1.4523688, 1.0e-7);
  EXPECT_GT(stress(at2, 0.25), std::max(stress(at2, 0.24), stress(at2, 0.26)));
}

// The law of a cohesive crack is that of the stress at which it has begun, whatever comes after. A
// crack that comes to a point while this is compressed gets its law in the first tension
SERIAL_TEST(CohesiveCrack, KeepsItsLaw)
{
  const auto material =
      MPM_NS::Material::create({"density", "1", "eos", "linear", "50", "strength", "elastic", "40",
                                "damage", "phasefield", "1", "0.1", "model", "cohesive", "1"});
  const auto cracks = MPM_NS::phase_field_cracks(*material);
  ASSERT_TRUE(cracks);
  const auto stretch = [&](MPM_NS::MaterialPoint &p, double x, double y) {
    const double A[9] = {x, 0, 0, 0, y, 0, 0, 0, 0};
    p.move(A, 1.0);
    return p.history(cracks->shape);
  };
  MPM_NS::MaterialPoint p(*material, 1, 0.1), compressed(*material, 1, 0.1);
  const double in_tension = stretch(p, 0.005, 0.0);
  // uniaxial strain: a = 4 M GC/(pi l sigma^2), M = K + 4 G/3, and GC over 1 + h/(pi l)
  const double M = 50.0 + 4.0 * 40.0 / 3.0, GC = 1.0 / (1.0 + 1.0 / M_PI);
  EXPECT_NEAR(in_tension, 4.0 * M * GC / (M_PI * 0.1), 0.01 * in_tension);
  EXPECT_LT(stretch(p, 0.0, -0.004), 0.9 * in_tension);    // before the crack it follows
  EXPECT_NEAR(stretch(p, 0.0, 0.004), in_tension, 0.01 * in_tension);
  p.batch.history[cracks->phase][0] = 0.3;
  const double now = p.history(cracks->shape);
  EXPECT_EQ(stretch(p, 0.0, -0.004), now);
  EXPECT_EQ(stretch(p, -0.02, -0.02), now);

  stretch(compressed, -0.01, 0.0);
  compressed.batch.history[cracks->phase][0] = 0.3;
  EXPECT_EQ(stretch(compressed, -0.001, 0.0), PhaseField::LEAST);
  for (int step = 0; step < 16; step++) stretch(compressed, 0.001, 0.0);
  EXPECT_NEAR(compressed.history(cracks->shape), in_tension, 0.05 * in_tension);
}

/** A strip of E = 10 GPa and GC = 50 J/m2, LENGTH by WIDTH mm and turned by ANGLE degrees, that
 *  heavy grips pull apart; a band of 2 mm in its middle has .95 of its strength of 5 MPa. */
static const std::string pulled_strip = R"lmp(
units si
dimension 2
boundary f FACES p
atom_style mpm
variable h equal 1.0e-3*SPACING
neighbor $(0.5*v_h) bin
variable B equal 16.0e-3
region box block -${B} ${B} -SIDE SIDE $(-0.5*v_h) $(0.5*v_h)
create_box 3 box
variable c equal cos(ANGLE*PI/180)
variable s equal sin(ANGLE*PI/180)
variable a equal 0.5e-3*LENGTH
variable e equal v_a+4.0e-3
variable w equal 0.5e-3*WIDTH
region plo plane $(-v_e*v_c) $(-v_e*v_s) 0 ${c} ${s} 0
region phi plane $(v_e*v_c) $(v_e*v_s) 0 $(-v_c) $(-v_s) 0
region slo plane $(v_w*v_s) $(-v_w*v_c) 0 $(-v_s) ${c} 0
region shi plane $(-v_w*v_s) $(v_w*v_c) 0 ${s} $(-v_c) 0
region strip intersect 4 plo phi slo shi
fix grid all mpm ${h} OPTIONS apart ignore gain ignore
create_points 1 region strip ppc 2
variable along atom x*v_c+y*v_s
variable isgrip atom "abs(v_along)>v_a"
variable isweak atom "abs(v_along)<1.0e-3"
variable ismid atom "abs(v_along)<0.5*v_a && abs(v_along)>1.0e-3"
group grips variable isgrip
group weak variable isweak
group mid variable ismid
group bulk subtract all grips weak
variable elastic string "eos linear 5.5555556e9 strength elastic 4.1666667e9"
fix grips grips mpm/material density 2.0e9 ${elastic}
fix bulk bulk mpm/material density 2000 ${elastic} damage phasefield 50 LLL model cohesive 5.0e6
fix weak weak mpm/material density 2000 ${elastic} damage phasefield 50 LLL model cohesive 4.75e6
fix cracks all mpm/phasefield FIX
variable u atom "SPEED*(v_along/v_a*(abs(v_along)<v_a)+(v_along>=v_a)-(v_along<=-v_a))"
variable ux atom v_u*v_c
variable uy atom v_u*v_s
velocity all set v_ux v_uy 0.0
fix step all mpm/dt 0.4
compute e all mpm/energy
variable energy equal c_e[12]/(50.0*1.0e-3*WIDTH)
compute d all mpm/atom phase stress/xx stress/yy stress/xy
variable normal atom "c_d[2]*v_c*v_c+c_d[3]*v_s*v_s+2*c_d[4]*v_c*v_s"
compute stress mid reduce ave v_normal
variable free atom "c_d[2]*v_s*v_s+c_d[3]*v_c*v_c-2*c_d[4]*v_c*v_s"
compute across mid reduce max v_free
compute most all reduce max c_d[1]
compute total all reduce sum c_d[1]
thermo_style custom step time v_energy c_stress c_most c_total f_cracks f_cracks[1] f_cracks[2]
variable t equal time
)lmp";

struct PulledStrip {
  double spacing = 1.0, l = 2.0, angle = 0.0, length = 16.0, width = 6.0, speed = 0.05;
  std::string options, fix, faces = "f", side = "${B}", model = "model cohesive 5.0e6",
                            weak = "model cohesive 4.75e6";

  std::string scene() const
  {
    return replaced(replaced(replaced(pulled_strip, "model cohesive 5.0e6", model),
                             "model cohesive 4.75e6", weak),
                    {{"SPACING", strprintf("%g", spacing)},
                     {"LLL", strprintf("%g", 1.0e-3 * l)},
                     {"ANGLE", strprintf("%g", angle)},
                     {"LENGTH", strprintf("%g", length)},
                     {"WIDTH", strprintf("%g", width)},
                     {"SPEED", strprintf("%g", speed)},
                     {"SIDE", side},
                     {"FACES", faces},
                     {"OPTIONS", options},
                     {"FIX", fix}});
  }
  /** The same as a bar: two cells wide, with periodic faces. */
  PulledStrip bar() const
  {
    PulledStrip one = *this;
    one.faces = "p";
    one.width = 2.0 * spacing;
    one.side = strprintf("%g", 1.0e-3 * spacing);
    return one;
  }
};

/** Pulls until 1.5 times the opening, 2 GC/strength, at which a cohesive crack in the weak band is
 *  free of stress. Returns the largest stress. */
static double pull_apart(Scene &run, double speed, double opening = 3.0 * 50.0 / 4.75e6)
{
  double largest = 0.0;
  run.commands("variable more equal v_t<" + strprintf("%g", 0.5 * opening / speed) + "\n");
  while (run.variable("more") > 0.0) {
    run.commands("run 50 post no\n");
    largest = std::max(largest, run.compute_scalar("stress"));
  }
  return largest;
}

// A bar breaks at its strength, and with the energy GC, whatever the length of the phase field and
// the spacing of the nodes
SERIAL_PARAMETER_TEST(Bar, BreaksAtItsStrengthWithTheEnergyGC, std::vector<double>,
                      Values(std::vector<double>{1.0, 1.0}, std::vector<double>{1.0, 2.0},
                             std::vector<double>{0.5, 1.0}, std::vector<double>{0.5, 2.0}))
{
  LONG_AFTER(2);
  PulledStrip bar;
  bar.spacing = GetParam()[0];
  bar.l = GetParam()[1];
  bar.speed = 0.1;
  Scene run(bar.bar().scene());
  const double stress = pull_apart(run, bar.speed);
  EXPECT_NEAR(measured("largest stress", stress / 4.75e6), 1.0, 0.04);
  EXPECT_NEAR(measured("energy", run.variable("energy")), 1.0, 0.05);
  EXPECT_GT(run.compute_scalar("most"), 0.95);
  EXPECT_LT(measured("stress left", run.compute_scalar("stress") / 4.75e6), 0.06);
}

// The energy of a crack hardly depends on its direction; a band of cells that soften spends 1.6 to
// 2.5 times GC
SERIAL_PARAMETER_TEST(TurnedStrip, BreaksWithTheEnergyGC, double, Values(0.0, 22.5, 45.0))
{
  PulledStrip strip;
  strip.angle = GetParam();
  strip.speed = 0.1;
  Scene run(strip.scene());
  pull_apart(run, strip.speed);
  EXPECT_NEAR(measured("energy", run.variable("energy")), 1.0, 0.1);
  const double *const e = run.compute_vector();
  EXPECT_NEAR(e[10] / e[11], 0.0, 1.0e-9);    // residual
  EXPECT_NEAR(measured("integration", e[9] / e[11]), 0.0, 0.02);
}

// The region of a solution is another one, as blocks of nodes are smaller in space
SERIAL_TEST(Bar, BreaksInSpaceAsInThePlane)
{
  PulledStrip bar;
  bar.speed = 0.1;
  const std::string plane = bar.bar().scene();
  Scene flat(plane),
      solid(replaced(
          plane, {{"dimension 2", "dimension 3"}, {"$(-0.5*v_h) $(0.5*v_h)", "$(-v_h) $(v_h)"}}));
  const double stress = pull_apart(flat, bar.speed), same = pull_apart(solid, bar.speed);
  EXPECT_NEAR(same / stress, 1.0, 1.0e-4);
  EXPECT_NEAR(solid.variable("energy") / (2.0e-3 * flat.variable("energy")), 1.0, 0.01);
}

// A long notch in a strip whose long edges are moved apart: the energy M (u/H)^2 H/2 that the strip
// has ahead of it is free when it has passed. It begins to grow when this is GC (A.A. Griffith,
// Philos. Trans. A 221 (1921) 163; R.S. Rivlin, A.G. Thomas, J. Polym. Sci. 10 (1953) 291)
SERIAL_TEST(NotchedStrip, BreaksWhenTheEnergyThatIsReleasedIsGC)
{
  Scene run(R"lmp(
units si
dimension 2
boundary f f p
atom_style mpm
neighbor 0.0005 bin
region box block -0.004 0.052 -0.016 0.016 -0.0005 0.0005
create_box 1 box
fix grid all mpm 0.001 apart ignore gain ignore
region plate block 0 0.048 -0.013 0.013 INF INF
region notch block INF 0.022 -0.0015 0.0015 INF INF side out
region body intersect 2 plate notch
create_points 1 region body ppc 2
variable isgrip atom "abs(y)>0.01"
group grips variable isgrip
group bulk subtract all grips
variable elastic string "eos linear 5.5555556e9 strength elastic 4.1666667e9"
fix grips grips mpm/material density 2.0e9 ${elastic}
fix bulk bulk mpm/material density 2000 ${elastic} damage phasefield 50 0.002 model cohesive 10.0e6
fix cracks all mpm/phasefield
variable speed internal 0.04
variable vy atom "v_speed*(y/0.01*(abs(y)<=0.01)+(y>0.01)-(y<-0.01))"
velocity all set 0 v_vy 0
fix step all mpm/dt 0.4
compute d all mpm/atom phase
variable tip atom x*(c_d>0.9)
compute tip all reduce max v_tip
compute high all reduce max y
thermo_style custom step c_tip c_high
variable release equal 0.5*1.1111111e10*(2.0*(c_high-0.01275)/0.02)^2*0.02/50
run 0
)lmp");
  const auto pull_until = [&](double release) {
    do run.commands("run 10 post no\n");
    while (run.variable("release") < release && run.compute_scalar("tip") < 0.0245);
  };
  pull_until(0.7);
  run.commands("variable speed internal 0.01\nvelocity all set 0 v_vy 0\n");    // without a jolt
  pull_until(2.0);    // or until the crack is two cells long
  EXPECT_NEAR(measured("energy released over GC", run.variable("release")), 1.0, 0.05);
}

// AT1 has a strength that follows from its length, here 6.99 MPa with 4 mm, and the same energy.
// The bar breaks next to a grip, where the stress is larger by some percent
SERIAL_TEST(Bar, WithAT1BreaksAtTheStrengthOfItsLength)
{
  PulledStrip bar;
  bar.l = 4.0;
  bar.length = 16.0;
  bar.model = bar.weak = "model at1";
  bar.speed = 0.1;
  Scene run(bar.bar().scene());
  const double E = 1.0e10 / (1.0 - 0.04);    // plane strain
  const double strength = std::sqrt(3.0 * E * 50.0 / (8.0 * 4.0e-3));
  EXPECT_NEAR(measured("largest stress", pull_apart(run, bar.speed) / strength), 1.0, 0.06);
  EXPECT_NEAR(measured("energy", run.variable("energy")), 1.0, 0.05);
}

// Periodic faces may be where the bar breaks, or within reach of its crack: in the middle of a
// block of nodes, which is the last one before the face
SERIAL_PARAMETER_TEST(BarAtPeriodicFaces, BreaksAsElsewhere, double, Values(16.0, -12.0))
{
  PulledStrip bar;
  bar.speed = 0.1;
  const std::string scene = bar.bar().scene();
  const auto moved = [&](double by, const std::string &faces) {
    return replaced(scene,
                    {{"boundary f p p", "boundary " + faces},
                     {"fix step all",
                      "displace_atoms all move " + strprintf("%ge-3", by) + " 0 0\nfix step all"}});
  };
  // as far from the block's middle
  Scene whole(moved(GetParam() == 16.0 ? 0.0 : -4.0, "f p p")), across(moved(GetParam(), "p p p"));
  for (auto *run : {&whole, &across}) pull_apart(*run, bar.speed);
  EXPECT_EQ(across.evaluate("f_cracks"), whole.evaluate("f_cracks"));
  EXPECT_NEAR(across.variable("energy"), whole.variable("energy"), 1.0e-9);
}

// Below the strength nothing happens, not even to the last bit
SERIAL_TEST(BelowItsStrength, ABodyIsAsWithoutDamage)
{
  PulledStrip strip;
  strip.angle = 22.5;
  strip.speed = 0.1;
  const std::string with = strip.scene();
  Scene run(with);
  run.commands("run 150\n");
  EXPECT_GT(run.compute_scalar("stress"), 1.0e6);
  EXPECT_EQ(run.compute_scalar("total"), 0.0);
  EXPECT_EQ(run.variable("energy"), 0.0);
}

// What is compressed does not break, at several times the stress at which it breaks in tension, and
// though its sides are free, where waves bring some tension across
SERIAL_PARAMETER_TEST(Compression, BreaksNothing, std::string,
                      Values("model cohesive 5.0e6", "model at1"))
{
  PulledStrip strip;
  strip.angle = 22.5;
  strip.speed = -0.2;
  strip.model = strip.weak = GetParam();
  Scene run(strip.scene());
  double largest = 0.0;
  do {
    run.commands("run 50 post no\n");
    largest = std::max(largest, run.compute_scalar("across"));
  } while (run.compute_scalar("stress") > -5.0 * 4.75e6);
  EXPECT_GT(largest, 0.05e6);
  EXPECT_EQ(run.compute_scalar("total"), 0.0);
}

// A crack that is closed again stays as it is
SERIAL_TEST(ClosedCrack, DoesNotHeal)
{
  PulledStrip bar;
  bar.speed = 0.1;
  Scene run(bar.bar().scene());
  run.commands("run 500\n");
  const double total = run.compute_scalar("total"), most = run.compute_scalar("most");
  EXPECT_GT(most, 0.2);
  EXPECT_LT(most, 0.9);
  run.commands("variable ux atom -v_u\nvelocity all set v_ux 0 0\n");
  double least = total;
  for (int n = 0; n < 10; n++) {
    run.commands("run 50 post no\n");
    least = std::min(least, run.compute_scalar("total"));
  }
  EXPECT_GE(least, total);
  EXPECT_LT(run.compute_scalar("stress"), 0.0);
}

// With split nodes both sides of the crack are free, and fly apart
SERIAL_TEST(SplitStrip, HasNoStressLeft)
{
  double stress[2], energy[2];
  for (const int k : {0, 1}) {
    PulledStrip strip;
    strip.angle = 22.5;
    strip.speed = 0.1;
    Scene run(strip.scene() + (k ? "" : "fix sides all mpm/fracture separable 0.95\n"));
    pull_apart(run, strip.speed, 40.0e-6);
    stress[k] =
        measured(k ? "stress, whole" : "stress, split", run.compute_scalar("stress") / 4.75e6);
    energy[k] = measured(k ? "energy, whole" : "energy, split", run.variable("energy"));
  }
  EXPECT_LT(std::fabs(stress[0]), 0.02);
  EXPECT_NEAR(energy[0], energy[1], 0.06);
}

TEST(PhaseField, RanksAgreeAlsoAfterARestart)
{
  PulledStrip strip;
  strip.angle = 22.5;
  strip.speed = 0.2;
  strip.fix = "every 3";
  const std::string scene = strip.scene();
  Twins run(scene, 350, lines_again(scene), 100, 1e-10);
  EXPECT_GT(run.whole.evaluate("c_most"), 0.1);
  Scene balanced(scene + "fix bal all balance 40 1.05 shift xy 10 1.1\nrun 350\nrun 100\n");
  EXPECT_LT(difference(run.serial.gather(), balanced.gather()), 1e-10);
}

SERIAL_TEST(PhaseFieldInput, IsToldOf)
{
  PulledStrip strip;
  EXPECT_EQ(times_said(strip.scene() + "run 0\n", "below two node spacings"), 0);
  strip.l = 1.5;
  EXPECT_EQ(times_said(strip.scene() + "run 0\n", "below two node spacings"), 2);
  // what cannot break may be on a coarser lattice
  EXPECT_EQ(times_said(plane("si", "f f", "0 30 0 20", 2) + R"(
group a empty
group b empty
fix A a mpm 1.0
fix B b mpm 4.0
region a block 2 12 2 8 INF INF
region b block 16 28 2 8 INF INF
create_points 1 region a ppc 2 fix A group a
create_points 2 region b ppc 2 fix B group b
fix m a mpm/material density 1 eos linear 55 strength elastic 41 damage phasefield 0.1 2.0 model at1
fix n b mpm/material density 1 neohookean 100 0.3
fix cracks all mpm/phasefield
timestep 0.01
run 1
)",
                       "is below"),
            0);
  EXPECT_EQ(times_said(plane("si", "f f", "0 4 0 4") +
                           "region all block INF INF INF INF INF INF\nfix grid all mpm 1.0\n"
                           "create_points 1 region box ppc 2\nfix m all mpm/material density 1.0 "
                           "neohookean 1.0 0.2\nfix c all mpm/phasefield\nrun 0\n",
                       "has nothing to do"),
            1);
}

TEST(PhaseFieldInput, IsRefused)
{
  const std::string scene = plane("si", "f f", "0 8 0 8") + R"(
fix grid all mpm 1.0
create_points 1 region box ppc 2
)";
  const std::string law =
      "fix m all mpm/material density 1.0 eos linear 1.0 strength elastic 1.0 damage phasefield ";
  const std::string fix = "\nfix cracks all mpm/phasefield";
  expect_refused(
      scene,
      {
          {law + "1.0 2.0" + fix, "it needs a model"},
          {law + "0.0 2.0 model at1" + fix, "GC = 0.0"},
          {law + "nan 2.0 model at1" + fix, "GC"},
          {law + "1.0 -2.0 model at1" + fix, "L = -2.0"},
          {law + "1.0 2.0 model cohesive 0.0" + fix, "SIGMA = 0.0"},
          {law + "1.0 2.0 model cohesive" + fix, "model cohesive"},
          {law + "1.0 2.0 model at3" + fix, "model"},
          {law + "1.0 2.0 model at1 model at2" + fix, "model"},
          {law + "1.0 0.9 model at1" + fix, "is below the node spacing 1 of fix mpm grid"},
          {law + "1.0 2.0 model cohesive 2.0" + fix, "is too large for a cohesive crack"},
          {law + "1.0 2.0 model at1 random L lognormal 0.1 4.0 1" + fix,
           "must be the same everywhere"},
          {law + "1.0 2.0 model at1", "no cracks would grow without fix mpm/phasefield"},
          {law + "1.0 2.0 model at1\ngroup some id 1\nfix cracks some mpm/phasefield",
           "use group all"},
          {"mpm_point NULL uniaxial/stress 1.0 strain 0.1 material density 1.0 eos linear 1.0 "
           "strength elastic 1.0 damage phasefield 1.0 2.0 model at1",
           "a point alone has none"},
          {law + "1.0 2.0 model at1" + fix + " every 0", "every"},
          {law + "1.0 2.0 model at1" + fix + " every 2.5", "every"},
          {law + "1.0 2.0 model at1" + fix + " tolerance 0", "must be above 0"},
          {law + "1.0 2.0 model at1" + fix + " tolerance nan", "tolerance"},
          {law + "1.0 2.0 model at1" + fix + " iterations 0", "iterations"},
          {law + "1.0 2.0 model at1" + fix + " solver cg",
           "Unknown fix mpm/phasefield keyword: solver"},
          {law + "1.0 2.0 model at1" + fix + "\nfix more all mpm/phasefield",
           "one acts on all bodies"},
      },
      "run 1\n");
}

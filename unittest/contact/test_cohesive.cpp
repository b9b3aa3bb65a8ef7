// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart ranks input
// mpi: 1 3
// timeout: 900

// Bonds between bodies: strength and energy of an interface, and what it does under loads that
// come and go.

#include "contact/mpm_node_contact.h"

#include "mpm_lammps.h"

using namespace MPM_TEST;

static MPMCohesiveLaw cohesion(MPMCohesiveLaw::Softening softening, double stiffness)
{
  MPMCohesiveLaw law;
  law.strengths[0] = 2.0;
  law.strengths[1] = 3.0;
  law.energies[0] = 0.5;
  law.energies[1] = 1.5;
  law.mixing = 2.0;
  law.softening = softening;
  law.stiffness = stiffness;
  return law;
}

/** Traction at an opening that is the largest so far. */
static double traction(const MPMCohesiveLaw &law, double opening, double share)
{
  const double damage = law.damage(opening, share);
  return damage < 1.0 ? opening / law.compliance(damage, share) : 0.0;
}

// The area below the curve is the energy, its top the strength, in each mode and in mixed mode
SERIAL_TEST(CohesiveLaw, HasTheStrengthAndTheEnergy)
{
  for (const auto softening : {MPMCohesiveLaw::LINEAR, MPMCohesiveLaw::EXPONENTIAL})
    for (const double stiffness : {0.0, 20.0})
      for (const double share : {0.0, 0.3, 1.0}) {
        const auto law = cohesion(softening, stiffness);
        constexpr int N = 200000;
        const double last = 5.0, step = last / N;
        double area = 0.0, top = 0.0;
        for (int k = 0; k < N; k++) {
          const double t = traction(law, (k + 0.5) * step, share);
          area += t * step;
          top = std::max(top, t);
        }
        EXPECT_NEAR(area / law.energy(share), 1.0,
                    softening == MPMCohesiveLaw::LINEAR ? 1e-7 : 2e-4);
        EXPECT_NEAR(top / law.strength(share), 1.0, 2e-4);
      }
}

// Benzeggagh and Kenane: a part of the difference of the modes, by a power of the share of shear
SERIAL_TEST(CohesiveLaw, MixesModes)
{
  const auto law = cohesion(MPMCohesiveLaw::LINEAR, 0.0);
  EXPECT_DOUBLE_EQ(law.energy(0.0), 0.5);
  EXPECT_DOUBLE_EQ(law.energy(1.0), 1.5);
  EXPECT_DOUBLE_EQ(law.energy(0.6), 0.5 + 1.0 * 0.36);
  EXPECT_DOUBLE_EQ(law.strength(0.6), std::sqrt(4.0 + 5.0 * 0.36));
  EXPECT_DOUBLE_EQ(MPMCohesiveLaw::share_of_shear(3.0, 4.0), 0.64);
  EXPECT_EQ(MPMCohesiveLaw::share_of_shear(-3.0, 4.0), 1.0);
  EXPECT_EQ(MPMCohesiveLaw::share_of_shear(0.0, 0.0), 0.0);
  EXPECT_EQ(law.damage(law.opening(0.4, 0.6), 0.6), 0.4);
}

/** A node of two bodies with a bond, whose tensile strength is 2 and shear strength 3. */
struct BondedNode {
  double a[4] = {0.0, 0.0, 0.0, 2.0}, b[4] = {0.0, 0.0, 0.0, 6.0};    // velocity and mass
  MPMNodeContact contact = {};
  MPMContactLaw law;
  MPMNodeBond bond = {};

  /** vx, vy: velocity at which b goes away from a. */
  BondedNode(double vx, double vy, double damage, double opening, double sliding, double mu = 0.0)
  {
    law.law = MPMContactLaw::COHESIVE;
    law.cohesion = cohesion(MPMCohesiveLaw::LINEAR, 0.0);
    law.friction = {mu, mu};
    b[0] = vx;
    b[1] = vy;
    bond.damage = bond.reached = damage;
    bond.opening[0] = opening;
    bond.opening[1] = sliding;
    contact.ra = a;
    contact.rb = b;
    contact.n[0] = 1.0;
    contact.area = 0.5;
    contact.bond = &bond;
    contact.begin({}, {});
    contact.iterate(law, 2, 1, DT, false);
    contact.push(2);
  }
  double traction(int d) const { return -contact.impulse(d) / (contact.area * DT); }
  double velocity(int d) const { return b[d] - a[d]; }

  static constexpr double DT = 1.0e-3;
};

SERIAL_TEST(BondedNode, HoldsUpToTheStrength)
{
  const double weak = 1.9 * 0.5 * BondedNode::DT / 1.5;    // impulse over the reduced mass
  const BondedNode holds(weak, 0.0, 0.0, 0.0, 0.0), opens(1.0, 0.0, 0.0, 0.0, 0.0),
      slides(0.0, 1.0, 0.0, 0.0, 0.0), mixed(1.0, 1.0, 0.0, 0.0, 0.0);
  EXPECT_NEAR(holds.traction(0), 1.9, 1e-13);
  EXPECT_NEAR(holds.velocity(0), 0.0, 1e-16);
  EXPECT_NEAR(opens.traction(0), 2.0, 1e-13);
  EXPECT_NEAR(slides.traction(1), 3.0, 1e-13);
  EXPECT_NEAR(std::hypot(mixed.traction(0), mixed.traction(1)), std::sqrt(4.0 + 5.0 * 0.25), 1e-13);
  EXPECT_NEAR(mixed.traction(0), mixed.traction(1), 1e-13);
}

// with damage: the largest opening is .5 * .4 = .2, the traction there 2 * .6, and half of it at .1
SERIAL_TEST(BondedNode, GoesBackToZeroWithItsOpening)
{
  EXPECT_NEAR(BondedNode(1.0, 0.0, 0.4, 0.2, 0.0).traction(0), 1.2, 1e-13);
  EXPECT_NEAR(BondedNode(0.0, 0.0, 0.4, 0.1, 0.0).traction(0), 0.6, 1e-5);
  EXPECT_NEAR(BondedNode(-1e-3, 0.0, 0.4, 0.1, 0.0).traction(0), 0.6, 1e-4);
  // closed: contact, and friction where the bond has broken
  const BondedNode closed(-1.0, 0.0, 0.4, 0.0, 0.0), nearly(-1.0, 0.0, 1.0, 4e-4, 0.0);
  EXPECT_NEAR(closed.velocity(0), 0.0, 1e-15);
  EXPECT_NEAR(nearly.velocity(0), -0.4, 1e-15);
  const BondedNode rubs(-1.0, 1.0, 1.0, 0.0, 0.0, 0.3);
  EXPECT_NEAR(rubs.contact.tangential[1] / rubs.contact.normal, -0.3, 1e-13);
  EXPECT_EQ(BondedNode(1.0, 1.0, 1.0, 0.1, 0.0, 0.3).contact.tangential[1], 0.0);
}

/** Strip of 20 x 10 cells of 1 mm, bonded in the middle, turned by an angle [degrees], the end of
 *  which moves along the axis v and across it vt [m/s]: strength 5 MPa, energy 50 J/m^2. */
static std::string strip(double angle, double v, double vt, const std::string &options = "",
                         const std::string &law = "cohesive 5e6 5e6 50 50")
{
  const double c = std::cos(angle * PI / 180.0), s = std::sin(angle * PI / 180.0);
  const auto side = [&](const char *name, double along, double across, double nx, double ny) {
    return strprintf("region %s plane %.15g %.15g 0 %.15g %.15g 0\n", name, along * c - across * s,
                     along * s + across * c, nx * c - ny * s, nx * s + ny * c);
  };
  return replaced(plane("si", "p p", "-0.02 0.02 -0.012 0.018", 2, 5e-4), "atom_style mpm",
                  "processors 1 * 1\natom_style mpm") +    // three ranks share the interface
      side("low", -0.01, 0, 1, 0) +
      side("high", 0.01, 0, -1, 0) + side("below", 0, -0.005, 0, 1) +
      side("above", 0, 0.005, 0, -1) + side("left", 0, 0, -1, 0) + side("right", 0, 0, 1, 0) +
      side("held", -0.008, 0, -1, 0) + side("drawn", 0.008, 0, 1, 0) +
      "region one intersect 5 low high below above left\n"
      "region two intersect 5 low high below above right\n"
      "group one type 1\ngroup two type 2\nfix F1 one mpm 1e-3\nfix F2 two mpm 1e-3\n"
      "create_points 1 region one ppc 2 fix F1\ncreate_points 2 region two ppc 2 fix F2\n"
      "group one type 1\ngroup two type 2\n"
      "fix m all mpm/material density 1000 linear 1e10 0.0\n"
      "fix c all mpm/contact F1 F2 law " +
      law + " " + options +
      "\n"
      "fix hold all mpm/boundary region held stick field F1\n"
      "timestep 1e-7\n" +
      strprintf("variable ux equal %.15g*v_sign\nvariable uy equal %.15g*v_sign\n", v * c - vt * s,
                v * s + vt * c) +
      "variable sign equal 1\n"
      "fix pull all mpm/boundary region drawn stick velocity v_ux v_uy 0 field F2\n" +
      strprintf("variable fn equal (f_c[1][1]*%.15g+f_c[1][2]*%.15g)/0.01\n", c, s) +
      "variable w equal f_c/0.01\nvariable p equal 0\n";
}

// The largest stress is the strength, and the work the energy, at any angle to the lattice
TEST(Interface, HasStrengthAndEnergy)
{
  for (const double angle : {0.0, 22.5, 45.0}) {
    Scene run(strip(angle, 0.05, 0.0));
    double largest = 0.0;
    for (int k = 0; k < 110; k++) {
      run.commands("run 50 post no\n");
      largest = std::max(largest, -run.evaluate("v_fn"));
    }
    EXPECT_NEAR(measured("stress/strength", largest / 5e6), 1.0, angle == 45.0 ? 0.03 : 0.01);
    EXPECT_NEAR(measured("work/energy", -run.evaluate("v_w") / 50.0), 1.0,
                angle == 45.0 ? 0.035 : 0.01);    // its ends are steps of points
    EXPECT_EQ(run.evaluate("v_fn"), 0.0);
  }
}

// In shear the other energy counts
TEST(Interface, HasAnEnergyOfShear)
{
  Scene run(strip(0.0, 0.0, 0.1, "", "cohesive 2e7 5e6 200 100") + "run 8000\n");
  EXPECT_NEAR(measured("work/energy", -run.evaluate("v_w") / 100.0), 1.0, 0.01);
}

// Exponential softening, stiff bonds, other shapes and transfers: the same energy
SERIAL_TEST(Interface, HasTheSameEnergyWithOtherOptions)
{
  LONG_CASE();
  for (const char *options : {"softening exponential", "stiffness 1e12",
                              "softening exponential "
                              "stiffness 1e12"}) {
    Scene run(strip(22.5, 0.05, 0.0, options) + "run 12000\n");
    EXPECT_NEAR(measured(options, -run.evaluate("v_w") / 50.0), 1.0, 0.01);
  }
  for (const char *grid : {"shape cubic", "shape gimp transfer flip 0.99", "shape cpdi",
                           "transfer flip 0.99", "transfer tpic"}) {
    Scene run(replaced(strip(22.5, 0.05, 0.0), "mpm 1e-3", std::string("mpm 1e-3 ") + grid) +
              "run 5000\n");
    EXPECT_NEAR(measured(grid, -run.evaluate("v_w") / 50.0), 1.0, 0.015);
  }
}

// Opened by a part, closed, pressed, and opened again: contact where it is closed, and on the way
// back the traction that it had; what has come back is no numerical error
SERIAL_TEST(Interface, RemembersItsDamage)
{
  Scene run(
      replaced(strip(0.0, 0.025, 0.0), "sign equal 1", "sign equal 1-2*(step>=4000)*(step<10000)") +
      "compute e all mpm/energy\ncompute D all reduce max f_c[1]\n"
      "thermo_style custom step c_e[1] c_D\nrun 4000\n");
  const double before = run.evaluate("v_fn");
  EXPECT_EQ(log_of(run, "run 4000 post no\n").find("Numerical errors"), std::string::npos);
  EXPECT_NEAR(run.evaluate("v_fn") / before, 0.0, 0.01);
  // linear softening, and a traction in proportion to the opening: G D is gone
  EXPECT_NEAR(measured("work/(G D)", -run.evaluate("v_w") / (50.0 * run.evaluate("c_D"))), 1.0,
              0.01);
  run.commands("run 2000 post no\n");
  // by 5 um over 16 to 17 mm
  EXPECT_NEAR(measured("pressure", run.evaluate("v_fn") / 3.03e6), 1.0, 0.1);
  run.commands("run 6000 post no\n");
  EXPECT_NEAR(measured("stress again", run.evaluate("v_fn") / before), 1.0, 0.02);
  run.commands("run 4500 post no\n");
  EXPECT_NEAR(measured("work/energy", -run.evaluate("v_w") / 50.0), 1.0, 0.01);
}

// A strip that is bonded on half of its width takes half of the energy
SERIAL_TEST(Interface, IsBondedInARegion)
{
  Scene run("", MPI_COMM_SELF);
  run.commands(replaced(strip(0.0, 0.05, 0.0, "bonded half"), "fix c all",
                        "region half block INF INF 0 INF INF INF\nfix c all") +
               "run 1 post no\ncompute damage all reduce max f_c[1]\nrun 1\n");
  EXPECT_EQ(run.evaluate("c_damage"), 1.0);
  run.commands("run 6000\n");
  EXPECT_NEAR(measured("work/energy", -run.evaluate("v_w") / 25.0), 1.0, 0.01);
}

/** Two bars that part with .05 each, as drawn in test_contact: c = 10, rho c = 10; the strength is
 *  less than rho c v, so that the bond opens between waves that leave it. */
static const std::string parting = plane("si", "p p", "-0.3 2.6 0 0.08 -0.05 0.05", 2) +
    fields({{"one", "block 0 1 0 0.08 -0.05 0.05"}, {"two", "block 1 2 0 0.08 -0.05 0.05"}},
           "0.02") +
    "fix m all mpm/material density 1 linear 100 0\n"
    "velocity one set -0.05 0 0\nvelocity two set 0.05 0 0\n"
    "fix c all mpm/contact F1 F2 law cohesive 0.4 0.4 8e-4 8e-4\n"
    "timestep 2e-4\nvariable fx equal f_c[1][1]/0.08\nvariable w equal f_c/0.08\n";

// With linear softening, rho c (v - d'/2) = s (1 - d/d_1) has the solution
// d = (A/B) (exp(B t) - 1),  A = 2 (v - s/rho c),  B = 2 s/(rho c d_1),  until d = d_1. Here, d_1
// is a tenth, then a fifth of a cell
TEST(Interface, IsOpenedByWavesInTime)
{
  for (const double energy : {4e-4, 8e-4}) {
    const double A = 2.0 * (0.05 - 0.04), last = 5.0 * energy, B = 2.0 * 0.4 / (10.0 * last);
    const double exact = std::log(1.0 + B * last / A) / B;
    Scene run(replaced(parting, "8e-4", strprintf("%g", energy)));
    double t = 0.0;
    do {
      run.commands("run 1 post no\n");
      t = run.evaluate("time");
    } while (run.evaluate("v_fx") < 0.0 && t < 0.2);
    EXPECT_NEAR(measured("time/exact time", t / exact), 1.0, 0.03);
    EXPECT_NEAR(measured("work/energy", -run.evaluate("v_w") / energy), 1.0,
                energy < 6e-4 ? 0.02 : 0.03);
  }
}

// in axial symmetry the area is that of the circle
SERIAL_TEST(Interface, IsACircleInAxialSymmetry)
{
  Scene run(plane("lj", "f f", "0 2 0 16", 2, 0.15) +
            fields({{"one", "block 0 2 4 8 INF INF"}, {"two", "block 0 2 8 12 INF INF"}},
                   "0.5 axisymmetric yes") +
            "fix m all mpm/material density 1.0 neohookean 50.0 0.0\n"
            "fix sides all mpm/boundary xlo xhi slip\n"
            "fix c all mpm/contact F1 F2 law cohesive 0.2 0.2 0.01 0.01\n"
            "region low block INF INF 0 4.6 INF INF\n"
            "fix hold all mpm/boundary region low stick field F1\n"
            "region high block INF INF 11.4 16 INF INF\n"
            "fix pull all mpm/boundary region high stick velocity 0 0.02 0 field F2\n"
            "velocity two set 0 0.02 0\ntimestep 0.02\n");
  double largest = 0.0;
  for (int k = 0; k < 90; k++) {
    run.commands("run 10 post no\n");
    largest = std::max(largest, std::abs(run.evaluate("f_c[1][2]")) / (PI * 4.0));
  }
  EXPECT_NEAR(measured("pull/strength", largest / 0.2), 1.0, 0.015);
  EXPECT_NEAR(measured("work/energy", -run.evaluate("f_c") / (PI * 4.0 * 0.01)), 1.0, 0.01);
}

// In 3d, the same in each row of cells
SERIAL_TEST(Interface, IsTheSameIn3d)
{
  const auto bars = [](const char *first, int dim) {
    return std::string(first) +
        strprintf("fix m all mpm/material density 1 linear 100 0\n"
                  "velocity one set -0.05 0 0\nvelocity two set 0.05 0 0\n"
                  "fix c all mpm/contact F1 F2 law cohesive 0.4 0.4 8e-4 8e-4\ntimestep 1e-3\n"
                  "variable fx equal f_c[1][1]/%g\nrun 60\n",
                  dim == 3 ? 0.08 * 0.08 : 0.08);
  };
  Scene flat(bars(
      (plane("si", "p p", "-0.3 2.6 0 0.08", 2) +
       fields({{"one", "block 0 1 0 0.08 INF INF"}, {"two", "block 1 2 0 0.08 INF INF"}}, "0.02"))
          .c_str(),
      2)),
      solid(bars(
          (box(3, "si", "p p p", "-0.3 2.6 0 0.08 0 0.08", 2) +
           fields({{"one", "block 0 1 0 0.08 0 0.08"}, {"two", "block 1 2 0 0.08 0 0.08"}}, "0.02"))
              .c_str(),
          3));
  EXPECT_LT(flat.evaluate("v_fx"), -0.1);
  EXPECT_NEAR(solid.evaluate("v_fx") / flat.evaluate("v_fx"), 1.0, 1e-9);
}

/** A block of 1 x .4 m and 400 kg on a floor, bonded by next to nothing, that has been pushed. */
static const std::string pushed = plane("si", "p f", "0 6 0 1.5", 2) +
    fields({{"one", "block 0 6 0 0.4 INF INF"}, {"two", "block 1 2 0.4 0.8 INF INF"}}, "0.05") +
    "fix m all mpm/material density 1000 linear 1e7 0.3\n"
    "fix c all mpm/contact F1 F2 law cohesive 2e3 2e3 2 2 0.3\n"
    "fix floor all mpm/boundary ylo stick\nfix g all gravity 10 vector 0 -1 0\n"
    "velocity two set 3 0 0\ntimestep 1.6e-4\nvariable v equal vcm(two,x)\n";

// When the bond has broken, the block slides with friction. Sides of the interface that have slid
// along each other are no history of each other any more: they would plough
SERIAL_TEST(Interface, SlidesWhenItHasBroken)
{
  Scene run(pushed + "run 1250\n");
  EXPECT_NEAR(measured("speed/(v - mu g t)", run.evaluate("v_v") / (3.0 - 0.3 * 10.0 * 0.2)), 1.0,
              0.01);
}

// Parts of a body that are too narrow to fill nodes are not left out without a word
SERIAL_TEST(Interface, TellsWhatItDoesNotBond)
{
  const std::string ribs = plane("si", "p p", "-10 40 -10 20", 2, 0.5) +
      fields({{"one", "block 0 30 0 5 INF INF"}, {"two", "RIBS"}}, "1.0") +
      "fix m all mpm/material density 1 linear 1e3 0.3\n"
      "fix c all mpm/contact F1 F2 law cohesive 1 1 0.1 0.1 MORE\ntimestep 1e-3\nrun 1\n";
  const auto said = [&](const std::string &more) {
    return times_said(replaced(ribs,
                               {{"region two RIBS",
                                 "region wide block 2 12 5 10 INF INF\n"
                                 "region rib block 20 22 5 10 INF INF\n"
                                 "region two union 2 wide rib"},
                                {"MORE", more}}),
                      "that are as near to another body");
  };
  EXPECT_EQ(said(""), 1);
  EXPECT_EQ(said("gap yes 0.6"), 0);
}

// Any number of ranks, and a run that goes on from a restart file
TEST(Interface, GoesOnFromARestartFile)
{
  const ScratchFile file("restart");
  const std::string scene = strip(22.5, 0.05, 0.0);
  Scene whole(scene + "run 2200\nwrite_restart " + file.name + "\n"),
      serial(scene + "run 2200\n", MPI_COMM_SELF);
  const double work = serial.evaluate("v_w");
  EXPECT_LT(work, -10.0);
  EXPECT_GT(work, -45.0);
  EXPECT_NEAR(measured("work on all ranks/on one - 1", whole.evaluate("v_w") / work - 1.0), 0.0,
              1e-12);
  Scene again("read_restart " + file.name + "\n" + lines_again(scene) + "run 0\n");
  EXPECT_EQ(again.evaluate("v_w"), whole.evaluate("v_w"));
  for (Scene *run : {&whole, &again}) run->commands("run 300\n");
  EXPECT_NEAR(again.evaluate("v_w") / whole.evaluate("v_w"), 1.0, 1e-12);
  EXPECT_LT(whole.evaluate("v_w"), work - 5.0);
}

// Double cantilever beam, plane strain, E 70 GPa, arms of 2 mm, crack of 20 mm, .5 N/mm, 20 MPa. By
// finite elements of .25 mm, P is 6.665 N/mm at most; 5.970 and 5.170 at openings of 1.5 and 2 mm.
// Here four cells of .5 mm in each arm (with 1 mm: 6.77, 6.04, and 5.38); lengths in mm
SERIAL_TEST(DoubleCantilever, HasTheLoadOfFiniteElements)
{
  LONG_CASE();
  Scene run(plane("si", "p p", "-4 64 -8 8", 2, 0.25) +
            fields({{"one", "block 0 60 -2 0 INF INF"}, {"two", "block 0 60 0 2 INF INF"}}, "0.5") +
            "fix m all mpm/material density 2.7e-9 linear 70e3 0.3\n"
            "region bond block 20 INF INF INF INF INF\n"
            "fix c all mpm/contact F1 F2 law cohesive 20 20 0.5 0.5 stiffness 1e4 bonded bond\n"
            "region low block -1 0.3 -1.3 -0.7 INF INF\nregion high block -1 0.3 0.7 1.3 INF INF\n"
            "variable opening equal 2.5*(time/0.004)^2\n"
            "variable up equal 2.5*time/0.004^2\nvariable down equal -v_up\n"
            "fix low all mpm/boundary region low stick velocity NULL v_down NULL field F1\n"
            "fix high all mpm/boundary region high stick velocity NULL v_up NULL field F2\n"
            "fix calm all viscous 8.4375e-8\ntimestep 4.2e-8\n"
            "fix P all ave/time 1 200 200 f_high[2]\n");
  double most = 0.0, at[2] = {0.0, 0.0};
  while (run.evaluate("v_opening") < 2.05) {
    run.commands("run 200 post no\n");
    const double P = -run.evaluate("f_P"), opening = run.evaluate("v_opening");
    most = std::max(most, P);
    if (opening < 1.5) at[0] = P;
    if (opening < 2.0) at[1] = P;
  }
  EXPECT_NEAR(measured("P/6.665", most / 6.665), 1.0, 0.03);
  EXPECT_NEAR(measured("P/5.970", at[0] / 5.970), 1.0, 0.03);
  EXPECT_NEAR(measured("P/5.170", at[1] / 5.170), 1.0, 0.03);
}

SERIAL_TEST(BadInput, OfBondsIsRefused)
{
  const std::string scene = replaced(
      strip(0.0, 0.05, 0.0), "fix c all mpm/contact F1 F2 law cohesive 5e6 5e6 50 50 \n", "");
  const auto contact = [](const std::string &law) {
    return "fix c all mpm/contact F1 F2 law " + law;
  };
  expect_refused(
      scene,
      {{contact("cohesive 5e6 5e6 50"), "Illegal fix mpm/contact law"},
       {contact("cohesive 0 5e6 50 50"), "must be positive"},
       {contact("cohesive 5e6 5e6 -1 50"), "must be positive"},
       {contact("cohesive 5e6 5e6 50 nan"), "nan"},
       {contact("cohesive 5e6 5e6 50 50 gap no"), "must know where bodies touch: drop gap no"},
       {contact("cohesive 5e6 5e6 50 50 normal mass"), "use normal volume or colinear"},
       {contact("cohesive 5e6 5e6 50 50 heat yes"), "is not known to law cohesive"},
       {contact("cohesive 5e6 5e6 50 50 softening bilinear"), "softening bilinear"},
       {contact("cohesive 5e6 5e6 50 50 mixing 0"), "must be positive"},
       {contact("cohesive 5e6 5e6 50 50 stiffness 1e11"), "is spent before the strength"},
       {contact("cohesive 5e6 5e6 50 50 bonded nowhere"), "Region nowhere for fix mpm/contact c"},
       {contact("cohesive 5e6 5e6 5000 50"), "raise the strength or the node spacing"},
       {contact("coulomb 0.3 softening exponential"), "belongs to law cohesive"},
       {contact("coulomb 0.3 stiffness 1e12"), "belongs to law cohesive"},
       {contact("coulomb 0.3 mixing 2"), "belongs to law cohesive"},
       {contact("coulomb 0.3 bonded one"), "belongs to law cohesive"},
       {"region far block 1 2 1 2 INF INF\n" + contact("cohesive 5e6 5e6 50 50 bonded far"),
        "fill no node in region far"},
       {"displace_atoms two move 0.002 0 0\n" + contact("cohesive 5e6 5e6 50 50"),
        "bonds no points"}},
      "run 1\n");
  expect_error(
      replaced(strip(0.0, 0.05, 0.0), "mpm 1e-3", "mpm 1e-3 scheme musl transfer flip 1.0") +
          "run 1\n",
      "law cohesive needs scheme usl");
}

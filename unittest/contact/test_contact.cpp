// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input restart
// mpi: 1 3
// timeout: 900

// Contact between bodies on one lattice.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Bars of length 1 at a distance of 2.5 node spacings, each with speed 0.05; c = 10. */
static const std::string bars = plane("si", "f p", "-0.3 2.6 0 0.08 -0.05 0.05", 2) +
    fields({{"one", "block 0 1 0 0.08 -0.05 0.05"}, {"two", "block 1.05 2.05 0 0.08 -0.05 0.05"}},
           "0.02 OPTIONS") +
    R"(
fix m1 one mpm/material density 1 linear 100 0
fix m2 two mpm/material density RHO2 linear E2 0
velocity one set 0.05 0 0
velocity two set -0.05 0 0
fix c all mpm/contact F1 F2 CONTACT
timestep 2e-4
compute e all mpm/energy
variable gap equal (bound(two,xmin)-bound(one,xmax)-0.01)/0.02
variable v1 equal vcm(one,x)
variable v2 equal vcm(two,x)
variable p equal v_v1*mass(one)+v_v2*mass(two)
)";

static std::string two_bars(const std::string &options, const std::string &contact,
                            const std::string &rho2 = "1", const std::string &E2 = "100")
{
  return replaced(bars, {{"OPTIONS", options}, {"RHO2", rho2}, {"E2", E2}, {"CONTACT", contact}});
}

/** The same bars side by side, with these velocities. */
static std::string touching_bars(const std::string &options, const std::string &contact,
                                 const std::string &one, const std::string &two,
                                 const std::string &rho2 = "1", const std::string &E2 = "100")
{
  return replaced(two_bars(options, contact, rho2, E2),
                  {{"block 1.05 2.05", "block 1 2"},
                   {"one set 0.05 0 0", "one set " + one},
                   {"two set -0.05 0 0", "two set " + two}});
}

// A3(a): interface stress rho c v, contact for 2 L/c, rebound with the same speed; momentum exact
SERIAL_TEST(Contact, EqualBars)
{
  LONG_CASE();
  for (const char *options :
       {"transfer flip 1.0 scheme musl", "transfer apic", "shape cubic transfer flip 1.0"}) {
    SCOPED_TRACE(options);
    Scene run(two_bars(options, ""));
    double first = -1.0, last = 0.0, mean = 0.0, worst = 0.0, touch = 0.0;
    int n = 0;
    for (int k = 0; k < 100; k++) {
      run.commands("run 50 post no\n");
      const double t = run.evaluate("time"), f = run.evaluate("f_c[1][1]") / 0.08;
      worst = std::max(worst, std::fabs(run.evaluate("v_p")));
      if (f <= 0.05) continue;
      if (first < 0.0) first = t, touch = run.evaluate("v_gap");
      last = t;
      if (t > 0.53 && t < 0.67) mean += f, n++;
    }
    EXPECT_LT(worst, 1e-13 * 0.08 * 0.05);
    EXPECT_NEAR(first, 0.5, 0.011);
    EXPECT_LT(std::fabs(touch), 0.05);    // contact begins where the bars touch
    EXPECT_NEAR(last - first, 0.2, 0.025);
    EXPECT_NEAR(mean / n, 0.5, 0.02 * 0.5);
    const double speed = options == std::string("transfer apic") ? 0.042 : 0.046;
    EXPECT_LT(run.evaluate("v_v1"), -speed);
    EXPECT_NEAR(run.evaluate("v_v1"), -run.evaluate("v_v2"), 1e-13);
    EXPECT_GT(run.evaluate("v_gap"), 1.0);    // they let go of each other
    EXPECT_EQ(run.evaluate("f_c[1][4]"), 0.0);
  }
}

// bodies that are placed next to each other touch from the first step on: round-off does not decide
SERIAL_TEST(Contact, TouchingIsNotAMatterOfRounding)
{
  for (const char *options :
       {"shape linear transfer flip 1.0", "transfer apic", "shape cubic", "shape gimp"})
    for (const double shift : {0.0, 0.0031, 0.01, 0.0173}) {
      double force[3];
      for (const int k : {0, 1, 2}) {
        Scene run(
            replaced(two_bars(options, ""), "block 1.05 2.05", "block 1 2") +
            strprintf("displace_atoms all move %g 0 0\ndisplace_atoms two move %g 0 0\nrun 1\n",
                      shift, (k - 1) * 1.0e-13));
        force[k] = run.evaluate("f_c[1][1]");
      }
      EXPECT_GT(force[1], 0.0) << options << " " << shift;
      for (const int k : {0, 2})
        EXPECT_NEAR(force[k] / force[1], 1.0, 1.0e-9) << options << " " << shift;
    }
}

// bodies that slide along each other without any approach are free of each other, whatever rounding
// makes of the velocity across, and with any common velocity
SERIAL_TEST(Contact, SlidingIsNotAMatterOfRounding)
{
  for (const char *const law : {"law stick", "law coulomb 0.3"})
    for (const double speed : {0.0, 0.1, 0.3, 0.7}) {
      Scene run(touching_bars("transfer apic scheme musl", law, strprintf("%.17g 0.5 0", speed),
                              strprintf("%.17g -0.1 0", speed)) +
                "run 6\n");
      EXPECT_NEAR(run.evaluate("vcm(one,y)"), 0.5, 1.0e-12) << speed;
      EXPECT_EQ(run.evaluate("f_c[1][4]"), 0.0) << speed;
    }
}

// bodies that touch and move apart do not hold each other
SERIAL_TEST(Contact, DoesNotPull)
{
  for (const char *contact : {"", "law coulomb 0.3", "law stick", "gap no"}) {
    Scene run(touching_bars("transfer apic", contact, "-0.05 0 0", "0.05 0.02 0") + "run 1\n");
    EXPECT_EQ(run.evaluate("f_c[1][1]"), 0.0) << contact;
    EXPECT_EQ(run.evaluate("f_c[1][4]"), 0.0) << contact;
    EXPECT_NEAR(run.evaluate("v_v1"), -0.05, 1e-13) << contact;
    EXPECT_NEAR(run.evaluate("v_v2"), 0.05, 1e-13) << contact;
  }
}

// without the gap rule bodies feel each other more than a node spacing apart
SERIAL_TEST(Contact, WithoutTheGapRuleContactIsEarly)
{
  Scene run(two_bars("transfer flip 1.0 scheme musl", "gap no"));
  double touch = 0.0;
  for (int k = 0; k < 150 && touch == 0.0; k++) {
    run.commands("run 20 post no\n");
    if (run.evaluate("f_c[1][1]") / 0.08 > 0.05) touch = run.evaluate("v_gap");
  }
  EXPECT_GT(touch, 1.0);
  EXPECT_LT(touch, 2.5);
}

// between walls without friction, half of the volume of the nodes at a wall is outside: bars touch
// there as they do where they are continued periodically
SERIAL_TEST(Contact, BarsBetweenWalls)
{
  LONG_CASE();
  for (const char *options :
       {"transfer apic", "shape cubic", "shape gimp", "transfer flip 1.0 scheme musl",
        "transfer flip 1.0 edges modified"}) {
    SCOPED_TRACE(options);
    double v[2], f[2];
    for (int k = 0; k < 2; k++) {
      std::string text = replaced(two_bars(options, ""), "timestep 2e-4", "timestep 4e-4");
      if (k)
        text = replaced(text, "boundary f p p", "boundary f f p") +
            "fix walls all mpm/boundary ylo yhi slip\n";
      Scene run(text + "run 1500\n");
      v[k] = measured("speed", run.evaluate("v_v1"));
      f[k] = measured("force", run.evaluate("f_c[1][1]"));
    }
    EXPECT_NEAR(v[1], v[0], (strstr(options, "edges") ? 0.02 : 0.01) * 0.05);
    EXPECT_NEAR(f[1], f[0], 0.01 * 0.04);
  }
}

// A3(c): Z = 10 and 40: stress Z1 Z2/(Z1 + Z2) (v1 - v2)
SERIAL_TEST(Contact, DifferentImpedances)
{
  Scene run(two_bars("transfer flip 1.0 scheme musl", "", "4", "400"));
  double mean = 0.0;
  int n = 0;
  for (int k = 0; k < 66; k++) {
    run.commands("run 50 post no\n");
    const double t = run.evaluate("time");
    if (t > 0.54 && t < 0.66) mean += run.evaluate("f_c[1][1]") / 0.08, n++;
  }
  ASSERT_GT(n, 5);
  EXPECT_NEAR(mean / n, 10.0 * 40.0 / 50.0 * 0.1, 0.004 * 0.8);
}

/** A block or a disk on a plane, gravity tilted by 30 degrees; F2 of the literature. */
static const std::string incline = plane("si", "f f", "0 3 0 2 -0.05 0.05", 2) +
    fields({{"plane", "block 0 3 0 0.5 -0.05 0.05"}, {"body", "BODY"}},
           "SPACING transfer TRANSFER") +
    R"(
fix m1 plane mpm/material density 1000 neohookean 4.2e7 0.4
fix m2 body mpm/material density 1000 neohookean 4.2e6 0.4
fix floor all mpm/boundary ylo stick field F1
fix sides all mpm/boundary xlo xhi slip field F1
fix c all mpm/contact F1 F2 law coulomb FRICTION
fix g body gravity 9.81 vector 0.5 -0.8660254037844386 0
fix dt all mpm/dt 0.5
compute e all mpm/energy
variable x equal xcm(body,x)
variable v equal vcm(body,x)
)";

static std::string on_incline(const std::string &body, const std::string &spacing,
                              const std::string &transfer, double mu)
{
  return replaced(incline,
                  {{"BODY", body},
                   {"SPACING", spacing},
                   {"TRANSFER", transfer},
                   {"FRICTION", std::to_string(mu)}});
}

/** The block has settled on the plane, damped and stuck, and is let go with this friction. */
static std::string settled(const std::string &transfer, const std::string &friction)
{
  return on_incline("block 0.5 1.5 0.5 1.0 -0.05 0.05", "0.1", transfer, 0.0) +
      "unfix c\nfix c all mpm/contact F1 F2 law stick\nfix damp body viscous 750\n"
      "run 500\nunfix damp\nunfix c\nfix c all mpm/contact F1 F2 law coulomb " +
      friction + "\n";
}

/** Places, and work of friction, at three times. */
struct Slide {
  double t[3], x[3], work[3];

  explicit Slide(Scene &run)
  {
    for (int k = 0; k < 3; k++) {
      if (k) run.commands("run 450 post no\n");
      t[k] = run.evaluate("time");
      x[k] = run.evaluate("v_x");
      work[k] = run.evaluate("f_c");
    }
  }
  double acceleration() const
  {
    return 2.0 * ((x[2] - x[1]) / (t[2] - t[1]) - (x[1] - x[0]) / (t[1] - t[0])) / (t[2] - t[0]);
  }
};

// With friction from zero across the limit of sticking, tan(30 degrees) = 0.577
SERIAL_TEST(Friction, BlockSlidesOrSticks)
{
  const double g = 9.81, sine = 0.5, cosine = std::sqrt(0.75);
  for (const char *transfer : first_of(1, {"apic", "flip 1.0"}))
    for (const double mu : first_of(3, {0.3, 0.55, 0.6, 0.0, 0.1})) {
      SCOPED_TRACE(std::string(transfer) + " " + std::to_string(mu));
      Scene run(settled(transfer, std::to_string(mu)) + "run 900 post no\n");
      const Slide slide(run);
      const double exact = std::max(0.0, g * (sine - mu * cosine)), way = slide.x[2] - slide.x[0];
      if (exact > 0.0) {
        EXPECT_NEAR(
            measured(strprintf("%s, mu = %g: acceleration", transfer, mu), slide.acceleration()),
            exact, 0.005 * g);
        // the work of friction is friction times the way
        const double friction = mu * 1000 * 0.5 * g * cosine;
        EXPECT_NEAR(measured("work", slide.work[2] - slide.work[0]), -friction * way,
                    0.01 * friction * way + 1e-12);
      } else
        EXPECT_NEAR(
            measured(strprintf("%s, mu = %g: creep", transfer, mu), slide.x[2] - slide.x[1]), 0.0,
            5e-4);
    }
}

SERIAL_TEST(Friction, DiskRollsOrSlips)
{
  const double g = 9.81, sine = 0.5, cosine = std::sqrt(0.75);
  for (const double mu : first_of(1, {0.3, 0.1, 0.17, 0.22})) {    // it rolls from 0.192 on
    SCOPED_TRACE(mu);
    Scene run(on_incline("cylinder z 0.7 1.0 0.5 -0.05 0.05", "0.05", "apic", mu) + "run 4000\n");
    const double t = run.evaluate("time");
    const bool rolls = std::tan(M_PI / 6) <= 3 * mu;
    const double a = rolls ? 2.0 / 3.0 * g * sine : g * (sine - mu * cosine);
    const double ratio = measured(strprintf("mu = %g: way/exact", mu),
                                  (run.evaluate("v_x") - 0.7) / (0.5 * a * t * t));
    EXPECT_NEAR(ratio, 1.0, mu == 0.1 || mu == 0.3 ? 0.02 : 0.03);
  }
}

static const std::string disks = plane("lj", "p p", "0 24 0 12", 2) +
    fields({{"one", "cylinder z 3.1 6.2 2.5 INF INF"}, {"two", "cylinder z 20.9 5.3 2.5 INF INF"}},
           "0.5") +
    R"(
fix m all mpm/material density 1 neohookean 50 0.3
fix c all mpm/contact F1 F2 law coulomb 0.3
velocity one set -0.5 0.02 0
velocity two set 0.5 0 0
timestep 0.01
)";

// A block slides without friction on a plane at an angle to the lattice: what normals are worth.
static const std::string tilted = plane("si", "f f", "0 4 0 3 -0.05 0.05", 2) + R"(
variable s equal sin(ANGLE*PI/180)
variable c equal cos(ANGLE*PI/180)
)" +
    fields({{"plane", "block 0.6 3.4 0.8 1.3 -0.05 0.05"},
            {"body", "block 0.9 1.4 1.3 1.7 -0.05 0.05"}},
           "0.1") +
    R"(
displace_atoms all rotate 2 1.3 0 0 0 1 -ANGLE units box
region hold plane $(2-0.25*v_s) $(1.3-0.25*v_c) 0 $(-v_s) $(-v_c) 0
fix m1 plane mpm/material density 1000 neohookean 4.2e7 0.4
fix m2 body mpm/material density 1000 neohookean 4.2e6 0.4
fix hold all mpm/boundary region hold stick field F1
fix c all mpm/contact F1 F2 normal NORMAL
fix g body gravity 9.81 vector 0 -1 0
fix dt all mpm/dt 0.5
variable v equal vcm(body,x)*v_c-vcm(body,y)*v_s
run 1400
)";

SERIAL_TEST(Normals, LogisticRegressionFindsAnInclinedPlane)
{
  for (const int angle : {20, 35}) {
    double others = 1.0;    // the better of the two
    for (const char *normal : {"colinear", "volume", "logistic"}) {
      Scene run(replaced(tilted, {{"ANGLE", std::to_string(angle)}, {"NORMAL", normal}}));
      const double exact = 9.81 * std::sin(angle * M_PI / 180.0) * run.evaluate("time");
      const double ratio =
          measured(std::to_string(angle) + " degrees, " + normal, run.evaluate("v_v") / exact);
      const double error = std::fabs(ratio - 1.0);
      if (std::string(normal) == "logistic") {
        EXPECT_LT(error, 0.004);
        EXPECT_LT(error, 0.25 * others);
      } else {
        EXPECT_LT(error, 0.03);
        others = std::min(others, error);
      }
    }
  }
}

// in space, periodic across, as in the plane, up to the ridge of the regression, which has another
// weight among more points
SERIAL_TEST(Normals, LogisticRegressionInSpace)
{
  double v[2];
  for (const int dim : {2, 3}) {
    Scene run(replaced(tilted,
                       {{"ANGLE", "20"},
                        {"NORMAL", "logistic"},
                        {"run 1400", "run 200"},
                        {"dimension 2", strprintf("dimension %d", dim)},
                        {"-0.05 0.05", dim == 2 ? "-0.05 0.05" : "-0.2 0.2"}}));
    v[dim - 2] = run.evaluate("v_v") / run.evaluate("time");
  }
  EXPECT_NEAR(measured("in space over in the plane", v[1] / v[0]), 1.0, 3e-4);
}

TEST(Normals, LogisticRegressionIsTheSameOnAnyNumberOfRanks)
{
  OnRanks run(replaced(tilted, {{"ANGLE", "20"}, {"NORMAL", "logistic"}, {"run 1400", ""}}),
              "run 400\n");
  EXPECT_LT(run.difference(), 1e-10);
  OnRanks periodic(replaced(disks, "coulomb 0.3", "coulomb 0.3 normal logistic"), "run 300\n");
  EXPECT_LT(periodic.difference(), 1e-10);
}

// The impulse at a node is along the sums over the points of both bodies of volume or mass times
// the gradient of its function, or along the difference of their directions. Gradients are those of
// splines or, with affine matrices, of moving least squares
// where one body reaches nodes inside of the other one, whose gradient is round-off there: the same
// for a lattice that is moved by round-off
SERIAL_TEST(Normals, RoundOffIsNoDirection)
{
  const auto run = [](double origin) {
    const auto lattice = strprintf("mpm 1 shape cpdi2 origin %g %g\n", origin, origin);
    Scene run(plane("lj", "f f", "0 14 0 12", 2) + R"(
region left block 1 5 2 6 INF INF
region right block 5 9 3 6 INF INF
create_points 1 region left spacing 0.5
create_points 2 region right spacing 0.5
group left type 1
group right type 2
velocity left set 0.09 0.03 0
velocity right set -0.09 0.03 0
)" + "fix F1 left " +
              lattice + "fix F2 right " + lattice + R"(
fix m1 left mpm/material density 2 linear 4.5 0.25
fix m2 right mpm/material density 1 linear 4.5 0.3
fix touch all mpm/contact F1 F2 law coulomb 0.3
timestep 0.1
run 30
)");
    return run.gather();
  };
  EXPECT_LT(measured("difference", difference(run(0.0), run(3e-15))), 3e-10);
}

SERIAL_TEST(Normals, AreThoseOfVolumesOrMassesOrColinear)
{
  const std::vector<std::string> kinds = {"colinear", "volume", "mass"};
  for (const bool affine : {false, true})
    for (std::size_t kind = 0; kind < kinds.size(); kind++) {
      Scene run(plane("lj", "f f", "0 16 0 14", 2) +
                replaced(fields({{"one", "cylinder z 6 6 3 INF INF"},
                                 {"two", "cylinder z 10.9 8.1 2.2 INF INF"}},
                                affine ? "1.0 transfer apic" : "1.0 transfer flip 1.0"),
                         "two ppc 2", "two ppc 3") +
                R"(
fix m1 one mpm/material density 1 neohookean 50 0.3
fix m2 two mpm/material density 5 neohookean 50 0.3
velocity one set 0.5 0 0
velocity two set -0.5 0 0
timestep 0.01
fix c all mpm/contact F1 F2 gap no normal )" +
                kinds[kind] + "\nrun 0\n");
      const auto points = run.gather();
      run.commands("run 1\n");
      int pushed = 0, differ = 0;
      const auto look = [&](const Scene::Node &node) {
        const double *other = run.node(node.index, "F2");
        if (node.mass == 0.0 || !other) return;
        double g[3][2][2] = {};    // colinear, volume, mass; of one and two
        for (const auto &p : points) {
          const double u = p.x[0] - node.x[0], v = p.x[1] - node.x[1];
          const double N = bspline(2, u) * bspline(2, v);
          const double slope[2] = {affine ? -4.0 * u * N : bspline_slope(2, u) * bspline(2, v),
                                   affine ? -4.0 * v * N : bspline(2, u) * bspline_slope(2, v)};
          for (int d = 0; d < 2; d++) {
            g[1][(int) p.type - 1][d] += p.vol * slope[d];
            g[2][(int) p.type - 1][d] += p.mass * slope[d];
          }
        }
        double n[3][2];
        for (int k = 0; k < 3; k++) {
          for (int b = 0; b < 2; b++)
            for (int d = 0; d < 2 && k == 0; d++)
              g[0][b][d] = g[1][b][d] / std::hypot(g[1][b][0], g[1][b][1]);
          for (int d = 0; d < 2; d++) n[k][d] = g[k][0][d] - g[k][1][d];
          const double length = std::hypot(n[k][0], n[k][1]);
          for (double &x : n[k]) x /= length;
        }
        // they approach each other with 1 along x
        const double J = node.mass * other[3] / (node.mass + other[3]) * std::max(0.0, n[kind][0]);
        for (int d = 0; d < 2; d++) {
          const double v0 = d == 0 ? 0.5 : 0.0;
          EXPECT_NEAR(node.v[d], v0 - J * n[kind][d] / node.mass, 1e-10) << kinds[kind];
          EXPECT_NEAR(other[d], -v0 + J * n[kind][d] / other[3], 1e-10) << kinds[kind];
        }
        pushed += J > 0.0;
        bool apart = J > 0.0;
        for (std::size_t k = 0; k < 3; k++)
          apart =
              apart && (k == kind || std::hypot(n[k][0] - n[kind][0], n[k][1] - n[kind][1]) > 0.05);
        differ += apart;
      };
      run.each_node(look, "F1");
      EXPECT_GT(pushed, 8);
      EXPECT_GT(differ, 4) << kinds[kind];
    }
}

// One step of bodies without stress that touch and approach each other obliquely. A node with the
// reduced mass m takes the impulses J_n = m u_n, and J_t = m times the sliding that friction stops;
// what is left of the sliding u_t - J_t/m does the work of friction, and the inelastic collision
// costs (J_n^2 + J_t^2)/(2 m).
TEST(Energy, OfACollision)
{
  const double normal = 0.1, along = 0.05;    // relative velocity
  const std::pair<const char *, double> laws[] = {
      {"law frictionless", 0.0}, {"law coulomb 0.2", 0.2 * normal}, {"law stick", along}};
  for (const char *options :
       {"transfer apic", "transfer flip 1.0", "transfer flip 1.0 scheme musl"})
    for (const auto &[law, stopped] : laws) {
      SCOPED_TRACE(std::string(options) + " " + law);
      Scene run(touching_bars(options, law, "0.05 0.03 0", "-0.05 -0.02 0", "4", "400") +
                "run 0\n");
      const double start = run.compute_vector()[0];
      EXPECT_NEAR(start, 0.5 * 0.08 * (0.0025 + 0.0009) + 0.5 * 0.32 * (0.0025 + 0.0004), 1e-15);
      run.commands("run 1\n");
      double sums[2] = {
          0.0};    // reduced mass; kinetic energy of the nodes, where they kept their velocity
      const auto look = [&](const Scene::Node &node) {
        const double *other = run.node(node.index, "F2");
        if (!node.owned || node.alias || node.mass == 0.0 || !other) return;
        sums[0] += node.mass * other[3] / (node.mass + other[3]);
        // with MUSL, of what was mapped back
        for (int d = 0; d < (stopped == along ? 2 : 1); d++)
          EXPECT_NEAR(node.v[d], other[d], 1e-14);
      };
      run.each_node(look, "F1");
      for (const char *id : {"F1", "F2"}) {
        const auto add = [&](const Scene::Node &node) {
          for (int d = 0; d < 2 && node.owned; d++)
            sums[1] += 0.5 * node.mass * node.v[d] * node.v[d];
        };
        run.each_node(add, id);
      }
      const double m = over_ranks(sums[0]), kinetic = over_ranks(sums[1]);
      const double work = -m * stopped * (along - stopped);
      const double loss = 0.5 * m * (normal * normal + stopped * stopped), tiny = 1e-12 * start;
      EXPECT_GT(loss, 0.005 * start);
      const double *e = run.compute_vector();
      enum { KINETIC, STORED, CONTACT = 7, TRANSFER, INTEGRATION, RESIDUAL };
      EXPECT_NEAR(e[CONTACT], work, tiny);
      EXPECT_NEAR(run.fix("c")->compute_scalar(), work, tiny);
      // with MUSL nodes have the velocities of the points once more
      if (!strstr(options, "musl")) { EXPECT_NEAR(kinetic, start + work - loss, tiny); }
      // nothing but contact and the transfers did anything, as there was no stress
      EXPECT_NEAR(e[TRANSFER], e[KINETIC] - start - work, tiny);
      EXPECT_NEAR(e[INTEGRATION], e[STORED], tiny);
      EXPECT_NEAR(e[RESIDUAL], 0.0, tiny);
    }
}

static const std::string corner = plane("lj", "p p", "0 16 0 16", 3) +
    fields({{"one", "block 2 8 2 8 -0.5 0.5"},
            {"two", "block 8 14 2 8 -0.5 0.5"},
            {"three", "block 5 11 8 14 -0.5 0.5"}}) +
    R"(
fix m all mpm/material density 1 neohookean 100 0.3
velocity one set 0.3 0.1 0
velocity two set -0.2 0.2 0
velocity three set 0.1 -0.5 0
fix c all mpm/contact FIELDS law coulomb 0.4
timestep 0.01
variable px equal vcm(all,x)*mass(all)
variable py equal vcm(all,y)*mass(all)
)";

TEST(ManyBodies, OrderOfNamesDoesNotMatter)
{
  std::vector<Scene::State> reference;
  for (const char *names : {"F1 F2 F3", "F3 F1 F2", "F2 F3 F1"}) {
    Scene run(replaced(corner, "FIELDS", names) + "run 0\n");
    const double px = run.evaluate("v_px"), py = run.evaluate("v_py");
    run.commands("run 200\n");
    EXPECT_NEAR(run.evaluate("v_px"), px, 1e-11);
    EXPECT_NEAR(run.evaluate("v_py"), py, 1e-11);
    const auto state = run.gather();
    if (reference.empty()) reference = state;
    for (std::size_t i = 0; i < state.size(); i++)
      for (int d = 0; d < 2; d++) {
        EXPECT_NEAR(state[i].x[d], reference[i].x[d], 1e-10);
        EXPECT_NEAR(state[i].v[d], reference[i].v[d], 1e-12);
      }
  }
}

// Ten blocks in a row, the first of which hits the others: one fix for all of them does what one
// fix for each pair of neighbors does, and keeps the momentum. A node has two bodies at most
TEST(ManyBodies, OneFixIsAsManyAsThereAreNeighbors)
{
  constexpr int MANY = 10;
  std::vector<Body> blocks;
  std::string all, pairs;
  for (int k = 0; k < MANY; k++) {
    const int low = 2 + 5 * k;
    blocks.push_back({strprintf("b%d", k), strprintf("block %d %d 2 6 -0.5 0.5", low, low + 5)});
    all += strprintf(" F%d", k + 1);
    if (k > 0) pairs += strprintf("fix c%d all mpm/contact F%d F%d law coulomb 0.4\n", k, k, k + 1);
  }
  for (const char *normal : {"colinear", "logistic"}) {
    std::vector<Scene::State> reference;
    for (const std::string &fixes : {pairs, "fix c all mpm/contact" + all + " law coulomb 0.4\n"}) {
      Scene run(plane("lj", "f p", "0 60 0 8", MANY) + fields(blocks) +
                "fix m all mpm/material density 1 neohookean 100 0.3\nvelocity b0 set 0.3 0.1 0\n" +
                replaced(fixes, "law", strprintf("normal %s law", normal)) +
                "timestep 0.02\nvariable p equal vcm(all,x)*mass(all)\nrun 0\n");
      const double p = run.evaluate("v_p");
      run.commands("run 80\n");
      EXPECT_GT(run.evaluate("vcm(b2,x)"), 0.001);    // the blow has come there
      EXPECT_NEAR(run.evaluate("v_p"), p, 1e-12 * p);
      const auto state = run.gather();
      if (reference.empty()) reference = state;
      for (std::size_t i = 0; i < state.size(); i++)
        for (int d = 0; d < 2; d++) EXPECT_NEAR(state[i].v[d], reference[i].v[d], 1e-12);
    }
  }
}

// Iterations that come to no end are told, once and with the same place for any number of ranks
TEST(ManyBodies, TellsWhatIsNotSolved)
{
  const ScratchFile log("log");
  {
    Scene run("log " + log.name + "\n" + replaced(corner, "FIELDS", "F1 F2 F3") +
              "run 3\nrun 60\nrun 60\n");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string text = file_text(log.name), told = "200 iterations were not enough";
  const auto at = text.find(told), end = text.find(':', at);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.substr(at, end - at),
            told + " to find what bodies give to each other at the node at 9 8 0 in step 1");
  EXPECT_EQ(text.find(told, at + 1), std::string::npos);
}

// a plate of half a cell between two bars that close in on it: after contact no two of the three
// approach each other, at any node, and their momentum is what it was
SERIAL_TEST(ManyBodies, NoneApproaches)
{
  const auto scene = replaced(corner,
                              {{"block 2 8 2 8", "block 2 8 0 16"},
                               {"block 8 14 2 8", "block 8.5 14 0 16"},
                               {"block 5 11 8 14", "block 8 8.5 0 16"},
                               {"FIELDS law coulomb 0.4", "F1 F2 F3 gap no"},
                               {"three set 0.1 -0.5 0", "three set 0.1 0.3 0"}});
  const std::string material = "fix m all mpm/material density 1 neohookean 100 0.3\n";
  for (const double density : {1.0, 0.001}) {    // of the plate
    Scene run(
        replaced(scene, material,
                 "group bars type 1 2\nfix m bars mpm/material density 1 neohookean 100 0.3\n" +
                     strprintf("fix p three mpm/material density %g neohookean %g 0.3\n", density,
                               100 * density)) +
        "run 1\n");
    int all = 0;
    const auto look = [&](const Scene::Node &node) {
      if (node.alias) return;
      std::vector<const double *> row;    // from left to right
      for (const char *id : {"F1", "F3", "F2"})
        if (const double *there = run.node(node.index, id)) row.push_back(there);
      for (std::size_t k = 1; k < row.size(); k++)
        EXPECT_LT(row[k - 1][0] - row[k][0], 1e-11) << node.index[0];
      all += row.size() == 3;
    };
    run.each_node(look, "F1");
    EXPECT_GT(all, 0);
  }
}

TEST(Parallel, RanksAgreeAcrossAPeriodicFaceAndAfterARestart)
{
  Twins run(disks, 120, lines_again(disks), 180, 1e-11);
  run.serial.commands("variable v equal vcm(one,x)\n");
  EXPECT_GT(run.serial.evaluate("v_v"), -0.25);    // they have met through the face
  const double work = run.whole.evaluate("f_c");
  EXPECT_NE(work, 0.0);
  EXPECT_NEAR(run.again.evaluate("f_c"), work, 1e-12 * std::fabs(work));
}

// the work of friction until the file is written is there again, once, on any number of ranks
TEST(Restart, WorkOfFrictionGoesOn)
{
  const ScratchFile file("restart");
  Scene whole(disks + "run 200\nwrite_restart " + file.name + "\n");
  const double work = whole.evaluate("f_c");
  EXPECT_LT(work, -1e-6);
  const std::string next = "read_restart " + file.name + "\n" + lines_again(disks) + "run 0\n";
  Scene again(next), serial(next, MPI_COMM_SELF);
  for (Scene *run : {&again, &serial}) {
    EXPECT_NEAR(run->evaluate("f_c"), work, 1e-14 * std::fabs(work));
    EXPECT_NEAR(run->evaluate("f_c[1][5]"), work, 1e-14 * std::fabs(work));
  }
  for (Scene *run : {&whole, &again, &serial}) run->commands("run 20\n");
  const double later = whole.evaluate("f_c");
  EXPECT_LT(later, 1.01 * work);
  for (Scene *run : {&again, &serial})
    EXPECT_NEAR(run->evaluate("f_c"), later, 1e-12 * std::fabs(later));
}

// Bodies that meet next to a wall: walls have the last word, wherever they are defined.
SERIAL_TEST(Order, WallsActAfterContact)
{
  const std::string contact = "fix c all mpm/contact F1 F2 law coulomb 0.3\n";
  const std::string wall = "fix w all mpm/boundary ylo slip\n";
  const std::string body =
      replaced(disks,
               {{"cylinder z 20.9 5.3 2.5 INF INF", "block 5.8 10 0 6 -0.5 0.5"},
                {"boundary p p p", "boundary p f p"},
                {"cylinder z 3.1 6.2 2.5 INF INF", "block 2 5.6 0 5 -0.5 0.5"},
                {contact, ""}}) +
      "displace_atoms all ramp x 0 3 y 0 6 units box\n";    // an inclined interface
  const std::string go = "velocity one set 0.5 -0.1 0\nvelocity two set -0.5 -0.1 0\nrun 60\n";
  Scene before(body + contact + wall + go), after(body + wall + contact + go);
  EXPECT_TRUE(identical(before.gather(), after.gather()));
  before.commands("variable v equal vcm(one,x)\n");
  EXPECT_LT(before.evaluate("v_v"), 0.3);    // they have met

  // friction between the bodies pushes nodes at the wall up and down: the wall does not let them
  int both = 0;
  for (const std::string id : {"F1", "F2"}) {
    const auto look = [&](const Scene::Node &node) {
      if (node.index[1] != 0 || node.mass == 0.0) return;
      both += after.node(node.index, id == "F1" ? "F2" : "F1") != nullptr;
      EXPECT_EQ(node.v[1], 0.0) << id << " " << node.index[0];
    };
    after.each_node(look, id);
  }
  EXPECT_GT(both, 0);
  EXPECT_GT(after.evaluate("f_c[1][4]"), 0.0);    // they push now
}

TEST(Restart, RefusesAnotherNumberOfBodies)
{
  const ScratchFile file("restart");
  Scene whole(disks + "run 10\nwrite_restart " + file.name + "\n");
  expect_refused(
      "read_restart " + file.name + "\nneighbor 0.3 bin\n",
      {{"group three empty\nfix F1 one mpm 0.5\nfix F2 two mpm 0.5\nfix F3 three mpm 0.5\n"
        "fix m all mpm/material density 1 neohookean 50 0.3\n"
        "fix c all mpm/contact F1 F2 F3 law coulomb 0.3",
        "another number of fields"},
       {"fix F1 one mpm 0.5\nfix F2 two mpm 0.5\n"
        "fix m all mpm/material density 1 neohookean 50 0.3\n"
        "fix c all mpm/contact F2 F1 law coulomb 0.3",
        "was between F1 F2 when the restart file was written, not F2 F1"}});
}

// friction at rest may be larger: the block stays where it would slide with the other one, and
// slides with that when it moves. (At the ends of the block the pull is a multiple of the mean.)
SERIAL_TEST(Friction, StaticAndKinetic)
{
  for (const double v : {0.0, 0.2}) {
    Scene run(settled("apic", v > 0.0 ? "0.3 0.9" : "0.3 5.0") +
              strprintf("velocity body set %g NULL NULL sum yes\nrun 450 post no\n", v));
    const Slide slide(run);
    if (v > 0.0)
      EXPECT_NEAR(measured("acceleration", slide.acceleration()),
                  9.81 * (0.5 - 0.3 * std::sqrt(0.75)), 0.005 * 9.81);
    else
      EXPECT_NEAR(measured("creep", slide.x[2] - slide.x[1]), 0.0, 5e-4);
  }
}

// Two lobes of one field approach and slide, without an end across. They act on each other from
// where they have nodes in common, two cells apart with quadratic functions, as if the material
// went on between them, and do not slide freely. Two fields touch where they are, and slide
static const std::string lobes = plane("lj", "p p", "0 16 0 4", 2) + R"(
group one type 1
group two type 2
FIELDS
)" +
    bodies({{"one", "block 2 7 0 4 -0.5 0.5"}, {"two", "block 9 14 0 4 -0.5 0.5"}},
           "ppc 2 fix F1") +
    R"(
group both type 1 2
fix m all mpm/material density 1 neohookean 50 0.3
velocity one set 0.2 0.2 0
velocity two set -0.2 -0.2 0
timestep 0.01
variable slide equal vcm(one,y)-vcm(two,y)
variable gap equal bound(two,xmin)-bound(one,xmax)-0.25
)";

SERIAL_TEST(SelfContact, LobesStick)
{
  double slide[2], gap[2] = {100.0, 100.0}, touch[2] = {-1.0, -1.0};    // gaps in cells
  for (int k = 0; k < 2; k++) {
    const std::string fields = k
        ? "fix F1 one mpm 0.5\nfix F2 two mpm 0.5\nfix c all mpm/contact F1 F2"
        : "group both type 1 2\nfix F1 both mpm 0.5";
    Scene run(replaced(lobes, "FIELDS", fields));
    for (int n = 0; n < 80; n++) {
      run.commands("run 10 post no\n");
      gap[k] = std::min(gap[k], run.evaluate("v_gap/0.5"));
      if (touch[k] < 0.0 && run.evaluate("vcm(one,x)") < 0.99 * 0.2)
        touch[k] = run.evaluate("v_gap/0.5");
    }
    slide[k] = run.evaluate("v_slide/0.4");
    const std::string name = k ? "two fields: " : "one field: ";
    measured(name + "gap when they begin to push", touch[k]);
    measured(name + "smallest gap", gap[k]);
    measured(name + "sliding in the end", slide[k]);
  }
  EXPECT_NEAR(touch[0], 2.0, 0.1);
  EXPECT_GT(gap[0], 1.0);
  EXPECT_LT(slide[0], 0.0);    // sheared, and back
  EXPECT_NEAR(touch[1], 0.0, 0.05);
  EXPECT_GT(gap[1], -0.05);
  EXPECT_NEAR(slide[1], 1.0, 1e-12);
}

// two bars that touch: the left end of one is held, the other one has the given velocity
static std::string drawn_bars(const std::string &law, const std::string &velocity)
{
  return replaced(two_bars("transfer apic", law),
                  {{"block 1.05 2.05", "block 1.0 2.0"},
                   {"velocity one set 0.05 0 0",
                    "region left block -1 0.1 0 0.08 -0.05 0.05\n"
                    "fix hold all mpm/boundary region left stick field F1"},
                   {"velocity two set -0.05 0 0",
                    "region right block 1.9 3 0 0.08 -0.05 0.05\n"
                    "fix pull all mpm/boundary region right stick velocity " +
                        velocity + " field F2\nvelocity two set " + velocity}});
}

// a bar is drawn off one that is held: pull is strength times area, work that of release times area
SERIAL_TEST(Adhesion, StrengthAndWork)
{
  Scene run(drawn_bars("law adhesive 0.02 1.0 2e-4 gap yes", "0.02 0 0"));
  double largest = 0.0, after = 0.0, work = 0.0;
  for (int k = 0; k < 300; k++) {
    run.commands("run 20 post no\n");
    const double f = -run.evaluate("f_c[1][1]") / 0.08;
    work += f * 20 * 2e-4 * 0.02;
    largest = std::max(largest, f);
    after = f;
  }
  EXPECT_NEAR(measured("pull/strength", largest / 0.02), 1.0, 0.01);
  EXPECT_EQ(after, 0.0);
  // it is summed up in 125 parts, the first and the last of which are not whole
  EXPECT_NEAR(measured("work/release work", work / 2e-4), 1.0, 0.03);
}

// the same bars drawn along each other: strength in shear times area, however far they slide
SERIAL_TEST(Adhesion, Shear)
{
  Scene run(drawn_bars("law adhesive 0.2 0.01 2e-3", "0 0.01 0") + "run 5000\n");
  for (int k = 0; k < 5; k++) {
    run.commands("run 200 post no\n");
    EXPECT_NEAR(
        measured("shear force/strength", std::fabs(run.evaluate("f_c[1][2]")) / 0.08 / 0.01), 1.0,
        8e-8);
  }
  EXPECT_LT(run.evaluate("f_c"), 0.0);
}

TEST(BadInput, IsRefused)
{
  const std::string scene = replaced(disks, "fix c all mpm/contact F1 F2 law coulomb 0.3\n", "");
  expect_refused(
      scene,
      {
          {"fix c all mpm/contact F1", "needs the IDs of two or more"},
          {"fix c all mpm/contact F1 F1", "named twice"},
          {"fix c all mpm/contact F1 F9", "F9 is not the ID of a fix mpm"},
          {"fix c all mpm/contact F1 m", "is not the ID of a fix mpm"},
          {"fix c one mpm/contact F1 F2", "use group all"},
          {"fix c all mpm/contact F1 F2 law glue", "Unknown fix mpm/contact law glue"},
          {"fix c all mpm/contact F1 F2 law", "Illegal fix mpm/contact law"},
          {"fix c all mpm/contact F1 F2 law coulomb", "Illegal fix mpm/contact law"},
          {"fix c all mpm/contact F1 F2 law coulomb -0.1", "must not be negative"},
          {"fix c all mpm/contact F1 F2 law coulomb 0.3 0.2", "must not be below that of friction"},
          {"fix c all mpm/contact F1 F2 law adhesive 1 1 0", "positive normal strength"},
          {"fix c all mpm/contact F1 F2 law adhesive 1 1 0.1 gap no", "how far bodies are apart"},
          {"fix c all mpm/contact F1 F2 law adhesive 1 1 0.1 normal mass", "area of the interface"},
          {"fix c all mpm/contact F1 F2 law adhesive 1 1 10", "more than the node spacing"},
          {"fix c all mpm/contact F1 F2 normal up", "Unknown fix mpm/contact normal up"},
          {"fix c all mpm/contact F1 F2 gap maybe", "must be one of no yes"},
          {"fix c all mpm/contact F1 F2 gap yes 1.5", "must be within 0.5 and 1: 1.5"},
          {"fix c all mpm/contact F1 F2 friction 0.3", "friction is not the ID"},
          {"fix c all mpm/contact F1 F2 law stick fast", "Unknown fix mpm/contact keyword: fast"},
          {"fix c all mpm/contact F1 F2\nfix d all mpm/contact F2 F1", "counted twice"},
          {"unfix F2\nfix F2 two mpm 0.25\nfix c all mpm/contact F1 F2",
           "must have the same lattice"},
          {"unfix F2\nfix F2 two mpm 0.5 shape cubic\nfix c all mpm/contact F1 F2",
           "must have the same lattice"},
          {"unfix F1\nunfix F2\nfix F1 one mpm 0.5 scheme usf transfer flip 1.0\n"
           "fix F2 two mpm 0.5 scheme usf transfer flip 1.0\nfix c all mpm/contact F1 F2",
           "cannot be used with scheme usf"},
      },
      "run 1\n");
}

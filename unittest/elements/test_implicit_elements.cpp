// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi input
// mpi: 1 4

// Fix mpm/implicit with finite elements whose nodes are points.

#include "elements/thin_testing.h"
#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** Two bars of half span 1 that rise by a, of EA = 1e4: benchmark P6. Bars of neohookean have the
 *  force EA (l - 1/l)/2 for the stretch l, of corotated that of the benchmark, EA (l - 1). */
static std::string truss(double a, const ScratchFile &file, const std::string &law,
                         const std::string &options)
{
  return plane("si", "f f", "-1.5 1.5 -3 2", 1, 0.1) + "fix grid all mpm 0.1 " + options +
      "\ncreate_points 1 mesh " + file.name + " thickness 0.01\n" +
      "fix m all mpm/material density 1000 " + law + " 1e6 0\nfix e all mpm/elements " + file.name +
      " thickness 0.01\nregion left block INF -0.7 INF INF INF INF\n"
      "region right block 0.7 INF INF INF INF INF\nregion ends union 2 left right\n"
      "fix hold all mpm/boundary region ends stick\nregion middle block -0.5 0.5 INF INF INF INF\n"
      "group apex region middle\ncompute u all displace/atom\ncompute w apex reduce ave c_u[2]\n"
      "thermo_style custom step c_w\nfix solve all mpm/implicit static\ntimestep 1.0\n";
}

static std::string truss_mesh(double a)
{
  return gmsh(1, {{-1.0, 0.0, 0.0}, {0.0, a, 0.0}, {1.0, 0.0, 0.0}}, {{0, 1}, {1, 2}});
}
static std::string ball(int divisions, double R)
{
  return octahedron(divisions, R).text();
}

/** Force that presses the apex down by w, over EA. */
static double bears(double a, double w, const std::string &law)
{
  const double l0 = std::sqrt(1.0 + a * a), l = std::sqrt(1.0 + (a - w) * (a - w)),
               stretch = l / l0;
  const double N = law == "corotated" ? 1.0 - stretch : 0.5 * (1.0 / stretch - stretch);
  return 2.0 * N * (a - w) / l;
}

// pushed by a wall the force has its maximum; under a load that grows the truss jumps
SERIAL_TEST(Truss, SnapsThrough)
{
  struct Case {
    double a, load, at, jump;    // of the benchmark, bars of N = EA (l0 - l)/l0
    const char *law, *options;
  };
  const Case cases[] = {{0.1, 0.00038109, 0.042360, 0.215566, "neohookean", "frame total"},
                        {0.1, 0.00038109, 0.042360, 0.215566, "neohookean", ""},
                        {0.5, 0.03838374, 0.222120, 1.088544, "neohookean", "frame total"},
                        {1.0, 0.18740328, 0.490175, 2.229740, "neohookean", "frame total"},
                        {0.1, 0.00038109, 0.042360, 0.215566, "corotated", "frame total"},
                        {0.5, 0.03838374, 0.222120, 1.088544, "corotated", "frame total"},
                        {1.0, 0.18740328, 0.490175, 2.229740, "corotated", ""},
                        {1.0, 0.18740328, 0.490175, 2.229740, "corotated", "frame total"}};
  for (const auto &c : cases) {
    const ScratchFile file("truss", truss_mesh(c.a));
    const bool is_benchmark = c.law == std::string("corotated");
    const std::string name = strprintf("%s, a = %g %s: ", c.law, c.a, c.options);
    // of the law
    double most = 0.0, at = 0.0;
    for (double w = 0.0; w < c.a; w += 1e-5)
      if (bears(c.a, w, c.law) > most) {
        most = bears(c.a, w, c.law);
        at = w;
      }
    measured(name + "largest load of the law over that of the benchmark", most / c.load);
    const int steps = 100;
    Scene pushed(truss(c.a, file, c.law, c.options) +
                 "region top block -0.35 0.35 INF INF INF INF\n"
                 "fix push all mpm/boundary region top stick velocity 0 " +
                 strprintf("%.17g 0\n", -c.a / steps));
    double force = 0.0, place = 0.0;
    for (int k = 0; k < 60; k++) {
      pushed.commands("run 1\n");
      const double now = pushed.fix("push")->compute_vector(1) / 1e4;
      EXPECT_NEAR(now, bears(c.a, -pushed.compute_scalar("w"), c.law), 1e-9 * most) << name << k;
      if (now > force) {
        force = now;
        place = -pushed.compute_scalar("w");
      }
    }
    EXPECT_NEAR(measured(name + "largest force over exact", force / most), 1.0, 5e-4);
    EXPECT_NEAR(measured(name + "its place over exact", place / at), 1.0, 0.03);
    if (is_benchmark || c.a == 0.1) { EXPECT_NEAR(force / c.load, 1.0, 5e-3); }

    Scene loaded(truss(c.a, file, c.law, c.options) +
                 strprintf("variable f equal -%.17g*(0.99+0.002*(step+1))\n", most * 1e4) +
                 "fix load apex addforce 0 v_f 0\n");
    double w = 0.0;
    int step = 0;
    for (; step < 10 && w < c.a; step++) {
      loaded.commands("run 1\n");
      w = -loaded.compute_scalar("w");
      if (w < c.a) EXPECT_LT(w, at);
    }
    const double load = 0.99 + 0.002 * step;
    EXPECT_GT(measured(name + "load of the jump over the largest", load), 0.999);
    EXPECT_LT(load, 1.005);
    EXPECT_NEAR(bears(c.a, w, c.law) / (load * most), 1.0, 2e-7) << "on the other side";
    measured(name + "jump to, over that of the benchmark", w / c.jump);
    if (is_benchmark) { EXPECT_NEAR(w / c.jump, 1.0, 1e-3); }
    EXPECT_GT(solved(loaded, 9), 0.0);
  }
}

// a strip of one element that walls pull so far, in one step, that its law may have no state
// without stress across: fix mpm/implicit sees this when it tries the motion, and says so, and the
// element is not asked for the stress of a motion that it does not have
SERIAL_TEST(Strip, HasNoStateWhenWallsPullItFar)
{
  const ScratchFile file("bar", gmsh(1, {{-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {{0, 1}}));
  int none = 0;
  for (int k = 0; k <= 8; k++) {
    const auto scene = plane("si", "f f", "-1.5 2.5 -1 1", 1, 0.1) +
        "fix grid all mpm 0.1 frame total\ncreate_points 1 mesh " + file.name +
        " thickness 0.01\nfix m all mpm/material density 1000 stvenant/kirchhoff 1e6 0.45\n"
        "fix e all mpm/elements " +
        file.name +
        " thickness 0.01\nregion left block INF -0.7 INF INF INF INF\n"
        "region right block -0.3 0.3 INF INF INF INF\nfix hold all mpm/boundary region left "
        "stick\n" +
        strprintf("fix pull all mpm/boundary region right stick velocity %g 0 0\n",
                  0.6 + 0.05 * k) +
        "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n";
    const auto message = error_of(scene);
    EXPECT_THAT(message, testing::Not(HasSubstr("no state without stress"))) << k;
    none += message.find("no equilibrium in step 1") != std::string::npos;
  }
  EXPECT_GT(none, 0);
}

/** A balloon of neohookean whose pressure grows in five steps to that of a stretch of 1.2. */
static std::string balloon(const ScratchFile &file, const std::string &gas,
                           const std::string &implicit, const std::string &more = "")
{
  return MPM_TEST::box(3, -0.2, 0.2, 0.02, "frame total") +
      thin_body(file.name, "thickness 0.001", "neohookean 1e5 0.3", more) +
      "variable p equal (step+1)/5*0.844962*1e5/2.6*0.01\nfix p all mpm/airbag e " + gas +
      "\nfix solve all mpm/implicit " + implicit +
      "\nvariable r atom sqrt(x*x+y*y+z*z)\ncompute r all reduce ave v_r\n"
      "compute most all reduce max v_r\nthermo_style custom step c_r c_most\ntimestep 1.0\n";
}

// the stretch of 1.2 of benchmark R2, in quadratically converging steps
SERIAL_TEST(Balloon, IsBlownUp)
{
  const ScratchFile file("ball", ball(3, 0.1));
  Scene run(balloon(file, "pressure v_p", "static"));
  for (int step = 1; step <= 5; step++) {
    run.commands("run 1\n");
    EXPECT_LE(solved(run, 0), 5.0);
  }
  const double r = run.compute_scalar("r");
  EXPECT_NEAR(measured("stretch", (r / 0.1 - 1.0) / 0.2), 1.0, 0.025);
  EXPECT_LT(measured("sphericity", run.compute_scalar("most") / r - 1.0), 0.01);
}

// a cable between two clamps (H.M. Irvine, Cable Structures (1981)), sag .39978: it swings to rest
// in steps of backward Euler, and is then in equilibrium. Two straight halves without tension have
// no stiffness across them, which is an error in statics, and no equilibrium
SERIAL_TEST(Cable, IsACatenary)
{
  const double h = 0.02;
  const ScratchFile file("cable", hanging(50, 0.5, 1));
  const auto scene = MPM_TEST::box(2, -0.7, 0.7, h, "frame total") +
      thin_body(file.name, "thickness 0.001", "neohookean 1e6 0", "compression no") +
      strprintf("region a sphere 0 0 0 %g\nregion b sphere 0.5 0 0 %g\n", 2.2 * h, 2.2 * h) +
      "fix a all mpm/boundary region a stick\nfix b all mpm/boundary region b stick\n"
      "fix g all gravity 9.81 vector 0 -1 0\ncompute low all reduce min y\n"
      "thermo_style custom step c_low\n";
  expect_error(scene +
                   "fix solve all mpm/implicit static linear 300 parts 1\ntimestep 1.0\nrun 1\n",
               "no equilibrium");
  Scene run(scene +
            "fix solve all mpm/implicit euler\ntimestep 0.02\nrun 40\nunfix solve\n"
            "fix solve all mpm/implicit static\nrun 1\n");
  EXPECT_NEAR(measured("sag over exact", run.compute_scalar("low") / -0.39978), 1.0, 0.002);
  EXPECT_LT(run.fix("solve")->compute_scalar(), 1e-8);
}

TEST(Balloon, Ranks)
{
  const ScratchFile file("ranks", ball(3, 0.1));
  OnRanks run(balloon(file, "pressure v_p", "static tolerance 1e-11"), "run 2\n");
  EXPECT_LT(measured("difference", run.difference()), 1e-9);
}

TEST(Truss, Ranks)
{
  const ScratchFile file("ranks", truss_mesh(0.5));
  OnRanks run(replaced(truss(0.5, file, "neohookean", "frame total"), "implicit static",
                       "implicit static tolerance 1e-11"),
              "variable f equal -100*(step+1)\nfix load apex addforce 0 v_f 0\nrun 3\n");
  EXPECT_LT(measured("difference", run.difference()), 1e-9);
}

SERIAL_TEST(Elements, BadInput)
{
  const ScratchFile file("bad", truss_mesh(0.5));
  const auto scene = truss(0.5, file, "neohookean", "frame total");
  expect_error(replaced(scene, "implicit static", "implicit static solver multigrid") + "run 1\n",
               "use solver blocks");
  expect_error(replaced(scene, "thickness 0.01\nregion", "thickness 0.01 bending yes\nregion") +
                   "run 1\n",
               "use explicit steps");
  const ScratchFile bag("bag", ball(2, 0.1));
  expect_error(balloon(bag, "gas 102325 1.4 outside 101325", "static") + "run 1\n",
               "use fix mpm/airbag pressure");
  expect_error(balloon(bag, "pressure v_p", "static", "curved yes") + "run 1\n", "use curved no");
}

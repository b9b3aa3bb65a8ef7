// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/implicit: Newton's method on the nodes of a field, in statics and dynamics.

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** A cell of one point, fixed at x = 0, with rollers; nodes at x = 1 get half of a force. */
static std::string cell(const std::string &options)
{
  return space("lj", "f f f", "0 4 0 1 0 1", 1, 0.3) +
      body("block 0 1 0 1 0 1", "density 1000 neohookean 1e6 0.3", "1.0 " + options, "1") +
      "fix wall all mpm/boundary xlo stick\nfix sides all mpm/boundary ylo yhi zlo zhi slip\n"
      "fix load all addforce 2e6 0 0\n"
      "fix solve all mpm/implicit static tolerance 1e-14 accuracy 1e-10 report yes\n"
      "timestep 1.0\n";
}

/** Cook's membrane, 11 cells along its clamped side, in steps of a traction on its end. */
static std::string membrane(const std::string &options, const std::string &implicit, int ppc,
                            int steps)
{
  return cooks_membrane(4.0, options, "neohookean 70 0.333333333333", steps, std::to_string(ppc)) +
      "fix solve all mpm/implicit static solver multigrid tolerance 1e-6 " + implicit +
      "\nregion tip block 44 49 50 54 INF INF\ngroup tip region tip\n"
      "compute u all displace/atom\ncompute low tip reduce ave c_u[2]\n"
      "compute e all mpm/energy\nthermo_style custom step c_low c_e\n";
}

// one cell under a traction larger than its stiffness: an exact tangent goes this way, no other
SERIAL_TEST(Cell, NewtonGoesTheExactWay)
{
  for (const char *options :
       {"shape linear frame total transfer pic", "shape linear transfer pic"}) {
    const auto steps = residuals(cell(options) + "run 1\n");
    ASSERT_EQ(steps.size(), 1u);
    double F = 1.0;
    for (std::size_t k = 0; k < 5; k++) {
      const double P = nominal_stress(F);
      ASSERT_LT(k, steps[0].size());
      EXPECT_NEAR(steps[0][k], std::fabs(P - 1e6), 1e-9 * 1e6) << options << k;
      F -= (P - 1e6) / (MU * (1.0 + 1.0 / (F * F)) + LAMBDA * (1.0 - std::log(F)) / (F * F));
    }
    EXPECT_NEAR(F, 2.458004779, 1e-9);
    EXPECT_LE(steps[0].size(), 7u);
    Scene run(cell(options) + "run 1\n");
    EXPECT_NEAR(run.points().F[0][0], 2.458004779, 1e-9);
    EXPECT_EQ(solved(run, 0), steps[0].size() - 1);
  }
}

// all shapes and transfers find a uniform strain exactly; a wall bears the force of the law
SERIAL_TEST(Patch, UniformStrain)
{
  for (const char *options :
       {"", "transfer pic", "shape cubic", "shape cubic transfer pic", "shape gimp transfer pic",
        "shape linear transfer pic", "frame total", "frame total shape cubic transfer pic",
        "stress gradient", "transfer tpic", "transfer polypic"})
    expect_uniform_strain(2, options);
}

// in statics the time step has no meaning, and is no source of errors where it is large
SERIAL_TEST(Patch, TimeHasNoMeaning)
{
  double F[2][2];
  for (const bool late : {false, true}) {
    Scene run(
        plane("si", "p f", "0 0.4 0 1", 1, 0.03) +
        body("box", "density 1e-3 neohookean 1e6 0.3", "0.1") +
        "fix floor all mpm/boundary ylo stick\n" +
        strprintf("fix push all mpm/boundary yhi stick velocity 0 %g NULL\n", late ? -1e-6 : -0.1) +
        "fix g all gravity 1e7 vector 0 -1 0\nfix solve all mpm/implicit static tolerance 1e-12\n" +
        strprintf("timestep %g\nrun 1\n", late ? 1e5 : 1.0));
    for (int i = 0; i < run.n(); i++)
      for (const int side : {0, 1})
        if (run.lmp->atom->tag[i] == (side ? run.n() : 1)) F[late][side] = run.points().F[i][4];
  }
  for (const int side : {0, 1}) EXPECT_NEAR(F[0][side], F[1][side], 1e-10);
  EXPECT_GT(std::fabs(F[0][0] - F[0][1]), 1e-3);
}

// of the exact solution for large strain: benchmark D1; second order
SERIAL_TEST(Bar, HangsUnderItsWeight)
{
  struct Case {
    double g, tip, gate;
    const char *options;
  };
  for (const auto &c : {Case{100.0, 0.0409620211, 5e-3, "frame total"},
                        Case{500.0, 0.252068853, 5e-3, "frame total"},
                        Case{1000.0, 0.644446356, 5e-3, "frame total shape cubic"},
                        Case{500.0, 0.252068853, 5e-3, "frame total shape linear transfer pic"},
                        Case{100.0, 0.0409620211, 5e-3, ""}}) {
    double error[2];
    for (const int n : {10, 20}) {
      Scene run(hanging(n, c.options, 1050, c.g, 2) + "run 2\n");
      // of the last points, a quarter of a cell from the end, where there is next to no stress
      error[n / 20] = -run.compute_scalar("low") / c.tip - 1.0;
      measured(strprintf("g %g %s, %d cells", c.g, c.options, n), error[n / 20]);
    }
    EXPECT_LT(std::fabs(error[1]), c.gate) << c.options;
    EXPECT_TRUE(std::fabs(error[0] / error[1]) > 3.4 || std::fabs(error[1]) < 5e-4) << c.options;
  }
}

// the deflection of theory, at two resolutions; the wall bears the weight, and energies close
SERIAL_TEST(Beam, BendsUnderItsWeight)
{
  const double inertia = 1e-3 / 12.0, weight = 1000 * 0.1,
               tip = weight / (8.0 * 1e8 * inertia) + weight / (2.0 * 5.0 / 6.0 * 5e7 * 0.1);
  for (const char *options : {"", "frame total", "shape cubic", "transfer pic"}) {
    double error[2];
    for (const int n : {4, 8}) {
      Scene run(beam(n, options, 1.0, "static", "linear 1e8 0") + "run 1\n");
      error[n / 8] = -run.compute_scalar("low") / (tip * (1.0 - 4.0 / 3.0 * 0.25 * 0.1 / n)) - 1.0;
      measured(strprintf("%s %d cells", options, n), error[n / 8]);
      EXPECT_NEAR(run.fix("clamp")->compute_vector(1), -weight, 1e-6 * weight);
      const double *const e = run.compute_vector();
      EXPECT_LT(std::fabs(e[10]), 1e-12 * e[5]) << "residual";
      EXPECT_NEAR(e[1] / e[5], 0.5, 1e-4)
          << "stored: half of the work of a load that is there at once";
      for (int i = 0; i < run.n(); i++)
        for (int d = 0; d < 3; d++) EXPECT_EQ(run.v()[i][d], 0.0);
    }
    EXPECT_LT(std::fabs(error[1]), 0.01) << options;
    EXPECT_GT(error[0] / error[1], 2.5) << options;
  }
}

// Stress mls pulls at nodes next to surfaces that are inclined to the lattice, and beams give way
// in each step, of which a warning tells when points have turned; stress gradient, which is the
// default, has the end of the first step under the same load, and that of the total frame
SERIAL_TEST(Beam, StaysWhereItIs)
{
  const auto scene = [](const char *options) {
    return beam(4, options, 100.0, "static");
  };
  for (const char *options :
       {"stress mls", "shape cubic stress mls", "", "shape cubic", "frame total", "transfer pic"}) {
    const bool turns = std::string(options).find("mls") != std::string::npos;
    EXPECT_EQ(lines_that_say(scene(options) + "run 2\n",
                             "with stress mls in the updated frame bodies whose surfaces")
                  .size(),
              turns ? 1u : 0u)
        << options;
  }
  // nor where nothing turns, and in the first step, which begins along the lattice
  EXPECT_TRUE(
      lines_that_say(hanging(8, "stress mls", 1050, 300.0, 4) + "run 4\n", "with stress mls")
          .empty());
  EXPECT_TRUE(lines_that_say(scene("stress mls") + "run 1\n", "with stress mls").empty());

  Scene total(scene("frame total") + "run 1\n");
  const double exact = total.compute_scalar("low");
  for (const char *options : first_of(2, {"", "shape cubic", "stress gradient"})) {
    Scene run(scene(options) + "run 1\n");
    const double once = run.compute_scalar("low");
    EXPECT_NEAR(measured(strprintf("%s: over that of the total frame", options), once / exact), 1.0,
                0.01);
    run.commands("run 20\n");
    EXPECT_NEAR(
        measured(strprintf("%s: after 20 steps more", options), run.compute_scalar("low") / once),
        1.0, 0.003);
  }
}

// nodes that points barely reach stop Newton's method where surfaces are inclined, which the error
// tells, and make bodies soft; with a stiffness of their own they do neither
SERIAL_TEST(Stabilize, InclinedSurfaces)
{
  expect_error(membrane("", "stabilize 0", 4, 40) + "run 8\n", "use stabilize 1");
  for (const int ppc : {2, 4}) {
    Scene total(membrane("frame total", "", ppc, 5) + "run 5\n"),
        run(membrane("", "stabilize 1", ppc, 5) + "run 5\n");
    EXPECT_NEAR(measured(strprintf("%d points, 5 steps, over the total frame", ppc),
                         run.compute_scalar("low") / total.compute_scalar("low")),
                1.0, 0.004);
    EXPECT_GT(solved(run, 11), 0.0);
    EXPECT_LT(measured("energy of a step, over all that is stored",
                       solved(run, 11) / run.compute_vector("e")[1]),
              1e-2);
  }
  Scene total(membrane("frame total", "", 4, 40) + "run 40\n"),
      run(membrane("", "stabilize 1", 4, 40) + "run 40\n");
  EXPECT_NEAR(
      measured("4 points, 40 steps", run.compute_scalar("low") / total.compute_scalar("low")), 1.0,
      0.002);
}

// by default from the first step that finds no balance: as if given for this step
SERIAL_TEST(Stabilize, FromTheStepThatNeedsIt)
{
  const std::string scene = membrane("", "", 4, 40);
  Continued run(scene, 8, lines_again(scene), 2);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
  EXPECT_EQ(solved(run.whole, 11), solved(run.again, 11));
  EXPECT_GT(solved(run.again, 11), 0.0);
  EXPECT_LT(solved(run.again, 0), 10.0);

  EXPECT_EQ(lines_that_say(scene + "run 10\n", "step 8 found its balance only with").size(), 1u);
  for (const std::string method : {"static", "euler"}) {
    const auto steps =
        replaced(replaced(replaced(scene, "implicit static", "implicit " + method),
                          "tolerance 1e-6", "tolerance 1e-10"),
                 "timestep 1.0", method == "euler" ? "timestep 1e4" : "timestep 1.0");
    Scene eight(steps + "run 8\n"), seven(steps + "run 7\n");
    EXPECT_EQ(solved(seven, 11), 0.0);
    EXPECT_GT(solved(eight, 11), 0.0);
    // of works of the first seven steps, whose loose nodes go far
    const double *const e = eight.compute_vector("e");
    EXPECT_LT(std::fabs(measured(method + ": residual", e[10])),
              1e-10 * std::max({e[1], -e[8], std::fabs(e[9])}));
    seven.commands("unfix solve\nfix solve all mpm/implicit " + method +
                   " solver multigrid tolerance 1e-10 stabilize 1\nrun 1\n");
    const auto a = eight.gather(), b = seven.gather();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); k++)
      for (int d = 0; d < 2; d++) {
        EXPECT_NEAR(a[k].x[d], b[k].x[d], 1e-9);
        EXPECT_NEAR(a[k].v[d], b[k].v[d], 1e-12);
      }
  }
}

// linear motions are free of it, also with nodes that see a thousandth of a cell
SERIAL_TEST(Stabilize, LinearMotionsAreFree)
{
  for (const char *shape : {"quadratic", "cubic"}) {
    const auto scene = [&](const char *implicit) {
      return plane("si", "f f", "0 1.2 0 1", 1, 0.03) +
          body("block 0 0.551 0 1 INF INF", "density 1000 neohookean 1e6 0",
               std::string("0.1 shape ") + shape) +
          "fix sides all mpm/boundary xlo ylo slip\n"
          "fix push all mpm/boundary yhi slip velocity 0 -0.05 0\n"
          "fix solve all mpm/implicit static tolerance 1e-11 " +
          implicit + "\ntimestep 1.0\nrun 1\n";
    };
    Scene without(scene("")), with(scene("stabilize 1"));
    const auto a = without.gather(), b = with.gather();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); k++)
      for (int d = 0; d < 2; d++) EXPECT_NEAR(a[k].x[d], b[k].x[d], 9e-11);
    EXPECT_LT(solved(with, 11), 1e-10 * 0.551 * 0.5 * 1e6 * 0.01);
  }
}

// factors and levels have it: solutions with factors are exact, and those of steps before serve
SERIAL_TEST(Stabilize, IsInTheFactors)
{
  for (const std::string method : {"static", "euler"}) {
    Scene run(replaced(replaced(membrane("", "stabilize 1", 4, 40), "implicit static",
                                "implicit " + method),
                       "timestep 1.0", method == "euler" ? "timestep 1e4" : "timestep 1.0") +
              "run 8\n");
    EXPECT_LE(measured(method + ": Newton iterations", solved(run, 0)), 12.0);
    EXPECT_LE(linear_in_each(run), 8.0);
  }
}

// what it takes is in the ledger as a loss of transfers, not of the integration of laws
SERIAL_TEST(Stabilize, Ledger)
{
  for (const std::string method : {"static", "euler"}) {
    double integration[2], transfer[2];
    for (const int with : {0, 1}) {
      Scene run(beam(4, "", 100.0, method + (with ? " stabilize 1" : "") + " tolerance 1e-10") +
                (method == "euler" ? "timestep 0.01\n" : "") + "run 5\n");
      integration[with] = run.compute_vector("e")[9];
      transfer[with] = run.compute_vector("e")[8];
      EXPECT_LT(std::fabs(run.compute_vector("e")[10]), 1e-10 * run.compute_scalar("e")) << method;
    }
    measured(method + ": integration", integration[1] / integration[0]);
    measured(method + ": transfer", transfer[1] - transfer[0]);
    EXPECT_LT(transfer[1], transfer[0]) << method;
  }
}

// the log tells what parts of a step take, which are parts of all of it
SERIAL_TEST(Beam, TellsOfItsTime)
{
  for (const char *solver : {"static", "static solver multigrid", "euler solver multigrid"}) {
    const auto lines =
        lines_that_say(beam(4, "frame total", 100.0, solver) + "run 3\n", " ms a step (");
    ASSERT_EQ(lines.size(), 1u);
    double all = 0.0;
    for (const char *part :
         {" % forces", " % tangents", " % preconditioners", " % linear systems"}) {
      const auto end = lines[0].find(part);
      ASSERT_NE(end, std::string::npos) << lines[0];
      const auto begin = lines[0].find_last_of(" (", end - 1) + 1;
      all += std::stod(lines[0].substr(begin, end - begin));
    }
    EXPECT_GT(measured("sum of shares, percent", all), 10.0) << lines[0];
    EXPECT_LE(all, 102.0) << lines[0];
  }
}

// of Newton's method, with a load that bends the beam by half of its length in one step: the last
// corrections; and an elastic material does not remember one load step more
SERIAL_TEST(Beam, ConvergesQuadratically)
{
  const auto scene =
      beam(2, "frame total", 300.0, "static tolerance 1e-13 accuracy 1e-9 report yes");
  expect_quadratic("beam", scene + "run 1\n");
  Scene one(scene + "run 1\n"),
      two(replaced(scene, "fix g all gravity 300", "fix g all gravity 150") +
          "run 1\nfix g all gravity 300 vector 0 -1 0\nrun 1\n");
  EXPECT_LT(measured("tip", one.compute_scalar("low")), -0.3);
  EXPECT_NEAR(one.compute_scalar("low"), two.compute_scalar("low"), 4e-11);
}

// the change of forces in a direction against differences of forces, and the diagonal of the same
// matrix, for all kinds of laws and frames
SERIAL_TEST(Tangent, IsThatOfTheForces)
{
  for (const std::string material :
       {"linear 1e6 0.3", "neohookean 1e6 0.3", "neohookean/split 1e6 0.45", "hencky 1e6 0.3",
        "corotated 1e6 0.3", "stvenant/kirchhoff 1e6 0.3", "mooney/rivlin 1e5 3e4 1e6",
        "eos linear 1e6 strength elastic 4e5", "eos linear 1e6 strength j2 4e5 2e3",
        "eos tait 1e5 7 viscosity newtonian 10", "drucker/prager 1e6 0.3 30 cohesion 2e4",
        "mohr/coulomb 1e6 0.3 30 2e4"})
    for (const std::string options : {"", "frame total", "axisymmetric yes", "3d"}) {
      Scene run;
      ASSERT_EQ(run.error(block_of_3(material, options)), "") << material;
      distort(run, 0.05, options == "axisymmetric yes");
      expect_tangent(run, material + " " + options,
                     material.find("tait") != std::string::npos ? 0.02 : 0.05, 1e-3, 37);
    }
}

// frequency and damping of each method, which are its own and known: benchmark P4
SERIAL_TEST(Vibration, HasTheNumbersOfTheMethod)
{
  struct Case {
    const char *options, *implicit;
    double omega_dt, frequency, factor;
  };
  const char *const total = "frame total transfer flip 1.0";
  for (const auto &c : {Case{total, "newmark", 0.5, 0.979915, 1.0},
                        Case{total, "newmark", 1.0, 0.927295, 1.0},
                        Case{total, "newmark", 2.0, 0.785398, 1.0},
                        Case{"transfer flip 1.0", "newmark", 1.0, 0.927295, 1.0},
                        Case{total, "midpoint", 0.5, 0.979915, 1.0},
                        Case{total, "midpoint", 2.0, 0.785398, 1.0},
                        Case{"", "midpoint", 1.0, 0.927295, 1.0},
                        Case{"shape cubic", "midpoint", 1.0, 0.927295, 1.0},
                        Case{total, "euler", 0.5, 0.0, 0.894427},
                        Case{total, "euler", 1.0, 0.0, 0.707107},
                        Case{total, "alpha", 0.5, 0.978834, 0.999960},
                        Case{total, "alpha", 1.0, 0.923700, 0.999475},
                        Case{total, "alpha", 2.0, 0.777058, 0.995286},
                        Case{"transfer flip 1.0", "alpha", 1.0, 0.923700, 0.999475},
                        Case{total, "alpha rho 1", 2.0, 0.785398, 1.0},
                        Case{total, "alpha rho 0", 1.0, 0.801641, 0.906563},
                        Case{total, "hht", 1.0, 0.912438, 0.993363},
                        Case{total, "hht rho 0.5", 2.0, 0.737602, 0.937132},
                        Case{"", "euler", 1.0, 0.0, 0.707107},
                        Case{"shape cubic", "euler", 2.0, 0.0, 0.447214}})
    expect_vibration(c.options, c.implicit, c.omega_dt,
                     c.frequency > 0.0 ? c.frequency : std::atan(c.omega_dt) / c.omega_dt,
                     c.factor);
}

// what is far beyond the time step is gone after some steps, and what is slow stays
SERIAL_TEST(Vibration, LosesWhatIsFast)
{
  const auto left = [](const char *implicit, double omega_dt, int steps) {
    const auto mode = vibration("frame total transfer flip 1.0",
                                std::string(implicit) + " tolerance 1e-12", omega_dt, steps);
    return measured(
        implicit, std::hypot(mode[steps][0], mode[steps][1]) / std::hypot(mode[0][0], mode[0][1]));
  };
  EXPECT_LT(left("alpha rho 0.5", 200.0, 40), 1e-7);    // 40^2/2^40 is 1e-9
  EXPECT_LT(left("hht rho 0.5", 200.0, 80), 1e-7);
  EXPECT_NEAR(left("alpha rho 0.5", 0.05, 40), 1.0, 1e-3);
  EXPECT_NEAR(left("newmark", 200.0, 40), 1.0, 0.2);
}

// a free body that turns in large steps keeps its momentum
SERIAL_TEST(Disk, KeepsItsMomentum)
{
  for (const std::string implicit : {"newmark", "euler", "alpha"}) {
    Scene run;
    spin(run, "frame total transfer flip 1.0", implicit + " tolerance 1e-13", 0.005);
    const auto before = run.sums();
    run.commands("run 40\n");
    const auto after = run.sums();
    for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d] / before.p[d], 1.0, 1e-10);
    measured(implicit + ": angular momentum", after.L[2] / before.L[2]);
    measured("kinetic energy", after.kinetic / before.kinetic);
  }
}

// the mid-point rule with affine points keeps angular momentum, too, in steps of 50 times the limit
// of explicit ones and more, in which the disk turns by a twentieth of a turn
SERIAL_TEST(Disk, KeepsItsAngularMomentum)
{
  for (const std::string options : {"", "shape cubic"})
    for (const double dt : {0.005, 0.03}) {
      Scene run;
      spin(run, options, "midpoint tolerance 1e-13", dt);
      const auto before = run.sums();
      run.commands("run 20\n");
      const auto after = run.sums();
      for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d] / before.p[d], 1.0, 1e-10);
      EXPECT_NEAR(measured(options + ": angular momentum", after.L[2] / before.L[2]), 1.0, 1e-10);
      measured("kinetic energy", after.kinetic / before.kinetic);
    }
}

// a vibration by a third of a turn: orders one and two in time, by differences of three steps
SERIAL_TEST(Vibration, HasTheOrderOfTheMethod)
{
  LONG_CASE();
  struct Case {
    const char *options, *implicit;
    double order;
  };
  for (const auto &c :
       {Case{"frame total transfer flip 1.0", "euler", 1.0},
        Case{"frame total transfer flip 1.0", "newmark", 2.0},
        Case{"frame total transfer flip 1.0", "alpha", 2.0}, Case{"transfer flip 1.0", "hht", 2.0},
        Case{"frame total transfer flip 1.0", "midpoint", 2.0}, Case{"", "midpoint", 2.0}}) {
    const auto end = [&](int steps) {
      const auto mode =
          vibration(c.options, std::string(c.implicit) + " tolerance 1e-12", 2.0 / steps, steps);
      return mode[steps];
    };
    const auto a = end(16), b = end(32), d = end(64);
    const double first = std::hypot(a[0] - b[0], a[1] - b[1]),
                 second = std::hypot(b[0] - d[0], b[1] - d[1]);
    EXPECT_NEAR(
        measured(std::string(c.implicit) + " " + c.options + ": order", std::log2(first / second)),
        c.order, 0.25);
  }
}

// the ledger closes in statics with steps of any length
SERIAL_TEST(Bar, LedgerInLongSteps)
{
  struct {
    const char *units, *dt, *frame;
  } const cases[] = {{"si", "1e-3", "updated"},
                     {"si", "1e-3", "total"},
                     {"si", "1e6", "updated"},
                     {"si", "1e6", "total"},
                     {"metal", "1e-3", "updated"}};    // energies are not masses times squares
  for (const auto &[units, dt, frame] : cases) {
    Scene run(plane(units, "f f", "0 1 0 0.4", 1, 0.02) +
              body("box", "density 7850 linear 200e9 0.3", std::string("0.1 frame ") + frame) +
              "fix sides all mpm/boundary xlo ylo yhi slip\n"
              "variable u equal -1e-3*(1+0.001*step)\n"
              "fix end all mpm/boundary xhi slip displacement v_u 0 0\n"
              "fix solve all mpm/implicit static\ncompute e all mpm/energy\ntimestep " +
              dt + "\nrun 3\n");
    const double *const e = run.compute_vector("e");
    EXPECT_LT(measured(strprintf("%s, %s, %s", units, dt, frame), std::fabs(e[10] / e[1])), 1e-10);
    EXPECT_NEAR(e[6] / (2.0 * e[1]), 1.0, 0.01) << "work of the wall, with the force of the end";
  }
}

// A body that is shifted as a whole loses nothing in transfers: what nodes have on the way is given
// to points and taken at rest again
SERIAL_TEST(Bar, LedgerOfAShift)
{
  const double dt = 0.01, u = 0.001;
  for (const char *units : {"si", "metal"}) {
    Scene run(plane(units, "f f", "0 1 0 0.4", 1, 0.02) +
              body("block 0.2 0.6 INF INF INF INF", "density 7850 linear 200e9 0.3", "0.1") +
              "fix sides all mpm/boundary ylo yhi slip\n"
              "region grip block INF 0.4 INF INF INF INF\n" +
              strprintf("fix grip all mpm/boundary region grip stick displacement %g 0 0\n", u) +
              "fix solve all mpm/implicit static\ncompute e all mpm/energy\n" +
              strprintf("timestep %g\nrun 3\n", dt));
    const double *const e = run.compute_vector("e");
    const double kinetic = 0.5 * run.sums().mass * u * u / (dt * dt) * run.lmp->force->mvv2e;
    EXPECT_LT(measured(units, std::fabs(e[8]) / kinetic), 1e-14);
  }
}

// the ledger closes in dynamics, and knows what backward Euler takes
SERIAL_TEST(Beam, EnergiesOfDynamics)
{
  for (const std::string &method : first_of<std::string>(
           3, {"euler", "newmark", "midpoint apic", "midpoint", "alpha", "hht rho 0.5"})) {
    const bool affine = method == "midpoint apic";
    const auto implicit = affine ? "midpoint" : method;
    Scene run(replaced(beam(4, affine ? "" : "transfer flip 1.0", 1.0,
                            implicit + " tolerance 1e-10", "linear 1e8 0"),
                       "timestep 1.0", "timestep 0.002") +
              "run 50\n");
    const double *const e = run.compute_vector();
    measured(std::string(implicit) + " residual", e[10] / e[5]);
    EXPECT_LT(std::fabs(e[10]), 1e-10 * e[5]);
    // newmark and midpoint keep the energy of a linear law, alpha and hht damp short waves only
    const double lost = std::fabs(measured("integration", e[9] / e[5]));
    const bool keeps = implicit == "newmark" || implicit == "midpoint";
    if (implicit != "euler") EXPECT_LT(lost, keeps ? 1e-7 : 1e-3);
    measured("transfer", e[8] / e[5]);
    measured("steps of the explicit limit", 0.002 / run.stable_dt());
  }
}

// levels of cells change the way of the linear solver, and not where it comes to: frames, shapes,
// an axis, walls that move at an angle, periodic faces, and inertia
SERIAL_TEST(Multigrid, ComesToTheSame)
{
  struct Case {
    const char *name;
    std::string scene;
    double fewer;    // iterations in statics, at least
  };
  const auto block = [](int dim) {
    return box(dim, "si", dim == 3 ? "p f f" : "p f p", "-0.8 0.8 -0.1 1.5 0 0.8", 1, 0.02) +
        body("block INF INF 0 1 0 0.8", "density 1000 neohookean 1e6 0.3", "0.1") +
        "fix floor all mpm/boundary ylo stick\nregion ball cylinder z 0.013 1.37 0.4 INF INF\n"
        "fix push all mpm/boundary region ball slip velocity 0.01 -0.01 0\n";
  };
  const std::string tube = plane("si", "f f", "0 2.5 0 0.8", 1, 0.01) +
      body("block 1 2 INF INF INF INF", "density 1000 neohookean 1e6 0.3",
           "0.05 axisymmetric yes") +
      "fix axis all mpm/boundary xlo ylo yhi slip\nregion bore block INF 1.0001 INF INF INF INF\n"
      "fix push all mpm/boundary region bore stick velocity 0.02 NULL NULL\n";
  const auto slender = [](const char *options) {
    return beam(4, options, 20.0, "", "linear 1e8 0");
  };
  for (const auto &c :
       first_of(4,
                {Case{"beam", slender("frame total"), 8.0},
                 Case{"linear", slender("shape linear transfer pic frame total"), 4.0},
                 Case{"ball", block(2), 1.0}, Case{"tube", tube, 1.0},
                 Case{"cubic", slender("frame total shape cubic"), 4.0},
                 Case{"updated", slender(""), 4.0},
                 Case{"gimp", slender("shape gimp transfer pic"), 2.0},
                 Case{"ball in space", block(3), 1.0}}))
    for (const std::string method : {"static", "euler"})
      expect_same_with_levels(c.name, c.scene, method, method == "static" ? c.fewer : 0.0);
}

// Points that reach new nodes while levels are used again: these must be made for all nodes

SERIAL_TEST(Multigrid, SeesNewNodes)
{
  std::vector<Scene::State> states[2];
  for (const bool multigrid : {false, true}) {
    Scene run(
        plane("lj", "f f", "0 14 0 12", 2, 0.5) + "fix g all mpm 1 shape gimp transfer apic\n" +
        bodies({{"left", "block 2 6 2 6 INF INF"}, {"right", "block 8 11 3 6 INF INF"}}, "ppc 2") +
        "velocity left set 0.03 0.02 0\nvelocity right set -0.03 0.01 0\n"
        "fix m1 left mpm/material density 2 corotated 0.5 0.3\n"
        "fix m2 right mpm/material density 1 neohookean 0.5 0.3\n"
        "fix solve all mpm/implicit euler tolerance 1e-11 solver " +
        (multigrid ? "multigrid" : "blocks") + "\ntimestep 10\nrun 12\n");
    states[multigrid] = run.gather();
  }
  double difference = 0.0;
  for (std::size_t p = 0; p < states[0].size(); p++)
    for (int d = 0; d < 2; d++)
      difference = std::max(difference, std::fabs(states[0][p].v[d] - states[1][p].v[d]));
  EXPECT_LT(measured("difference of velocities", difference), 1e-11);
}

// a block at angles to the lattice in a corner of two slopes, which hold lines of nodes together:
// levels take some of what is free in these for held, and linear systems went on to the largest
// number of iterations, in which nothing was gained
SERIAL_TEST(Multigrid, SlipOnSlopes)
{
  const double c = std::cos(0.3), s = std::sin(0.3);
  const auto side = [](const char *name, double x, double y, double nx, double ny) {
    return strprintf("region %s plane %.17g %.17g 0 %.17g %.17g 0\n", name, x, y, nx, ny);
  };
  for (const char *frame : {"updated", "total"}) {
    const auto scene = [&](const std::string &method) {
      return plane("lj", "f f", "-3 3 -1 4", 1, 0.02) +
          strprintf("fix grid all mpm 0.0625 frame %s\n", frame) + side("a", 0, 0, -s, c) +
          side("b", 0, 0, c, s) + side("d", c - s, s + c, -c, -s) + side("e", c - s, s + c, s, -c) +
          "region block intersect 4 a b d e\ncreate_points 1 region block ppc 2 outside ignore\n"
          "fix m all mpm/material density 1 neohookean 100 0.3\n" +
          side("floor", 0, 0, s, -c) + side("wall", 0, 0, -c, -s) +
          "fix f all mpm/boundary region floor slip\nfix w all mpm/boundary region wall slip\n"
          "fix g all gravity 5 vector 0 -1 0\n"
          "fix solve all mpm/implicit " +
          method + " stabilize 1 tolerance 1e-10\ntimestep 1.0\n";
    };
    Scene levels(scene("static solver multigrid")), blocks(scene("static solver blocks"));
    for (int step = 0; step < 3; step++) {
      levels.commands("run 1\n");
      blocks.commands("run 1\n");
      EXPECT_LE(measured(std::string(frame) + ": linear iterations", solved(levels, 1)), 100.0);
    }
    const auto a = levels.gather(), b = blocks.gather();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); k++)
      for (int d = 0; d < 2; d++) EXPECT_NEAR(a[k].x[d], b[k].x[d], 1e-10);
    double up = 0.0, mass = 0.0;
    for (const char *id : {"f", "w"}) up += levels.fix(id)->compute_vector(1);
    for (int i = 0; i < levels.n(); i++) mass += levels.lmp->atom->rmass[i];
    EXPECT_NEAR(up, -5.0 * mass, 1e-9 * mass);

    // of the factors that steps with inertia keep
    Scene euler(replaced(scene("euler solver multigrid"), "timestep 1.0", "timestep 0.05"));
    euler.commands("run 3\n");
    EXPECT_LE(measured("euler: iterations in a step", solved(euler, 0)), 25.0);
  }
}

// a block at angles to the lattice in a corner of three slopes, as factors (6 cells) and levels
// (12), which had a projection of each node by itself: 47 iterations, and no end within minutes
SERIAL_TEST(Multigrid, SlipOnThreeSlopes)
{
  LONG_CASE();
  // columns of a rotation
  const double turn[3][3] = {{0.85544984656975998, 0.44459629529311562, -0.2655930989604417},
                             {-0.374252615653694, 0.8851906773023972, 0.27635564856411371},
                             {0.35796723269056713, -0.13700948517734188, 0.92362755550670816}};
  for (const int cells : {6, 12}) {
    std::string scene = space("lj", "f f f", "-1 2 -1 2 -1 2", 1, 0.3 / cells), sides, walls;
    for (int d = 0; d < 3; d++) {
      const double *const e = turn[d];
      scene += strprintf("region low%d plane 0 0 0 %.17g %.17g %.17g\n", d, e[0], e[1], e[2]) +
          strprintf("region high%d plane %.17g %.17g %.17g %.17g %.17g %.17g\n", d, e[0], e[1],
                    e[2], -e[0], -e[1], -e[2]);
      sides += strprintf(" low%d high%d", d, d);
      walls += strprintf("region slope%d plane 0 0 0 %.17g %.17g %.17g\n", d, -e[0], -e[1], -e[2]) +
          strprintf("fix slope%d all mpm/boundary region slope%d slip\n", d, d);
    }
    Scene run(scene + "region block intersect 6" + sides +
              strprintf("\nfix grid all mpm %.17g frame total\n", 1.0 / cells) +
              "create_points 1 region block ppc 2 outside ignore\n"
              "fix m all mpm/material density 1 neohookean 100 0.3\n" +
              walls +
              "fix g all gravity 2 vector 0.1 -1 0.1\n"
              "fix solve all mpm/implicit static solver multigrid tolerance 1e-6 stabilize 1\n"
              "timestep 1.0\nrun 1\n");
    EXPECT_LE(linear_in_each(run), 10.0) << cells;
    double mass = 0.0, up = 0.0;
    for (int i = 0; i < run.n(); i++) mass += run.lmp->atom->rmass[i];
    for (const char *id : {"slope0", "slope1", "slope2"}) up += run.fix(id)->compute_vector(1);
    EXPECT_NEAR(up, -2.0 / std::sqrt(1.02) * mass, 1e-4 * mass);
  }
}

// faces at 0.3 of a cell beyond nodes hold lines of nodes together: factors know these
SERIAL_TEST(Multigrid, FacesBetweenNodes)
{
  for (const char *kind : {"slip", "stick"}) {
    Scene run(
        plane("lj", "f f", "0 8 0 2", 1, 0.0375) +
        strprintf("fix grid all mpm 0.125 frame total transfer flip 1.0 origin -0.0375 -0.0375\n"
                  "region body block 0 5 0 1 INF INF\ncreate_points 1 region body spacing 0.0625\n"
                  "fix m all mpm/material density 1 neohookean 1000 0.3\n"
                  "fix w all mpm/boundary xlo ylo %s\nfix g all gravity 2 vector -0.3 -1 0\n"
                  "fix solve all mpm/implicit newmark solver multigrid\ntimestep 0.05\nrun 20\n",
                  kind));
    EXPECT_LE(measured(std::string(kind) + ": iterations in 20 steps", solved(run, 5)), 110.0);
  }
}

// where three faces meet that a body may leave, they hold more nodes together than have a unit
// vector each: factors know these, too
SERIAL_TEST(Multigrid, CornerOfThreeFaces)
{
  Scene run(space("lj", "f f f", "0 1.5 0 1.5 0 1.5", 1, 0.0375) +
            body("block 0 0.5 0 0.5 0 0.5", "density 1 neohookean 1000 0.3", "0.125") +
            "fix w all mpm/boundary xlo ylo zlo separate\nfix g all gravity 2 vector -1 -2 -2\n"
            "fix solve all mpm/implicit static solver multigrid\ntimestep 1.0\nrun 1\n");
  EXPECT_LE(linear_in_each(run), 3.0);
  const double *const f = run.fix_vector("w", 3), exact[3] = {-1.0, -2.0, -2.0};
  for (int d = 0; d < 3; d++) EXPECT_NEAR(f[d], exact[d] * 2.0 / 3.0 * 0.125, 1e-4);
}

// of a slender body, iterations do not grow with the number of cells
SERIAL_TEST(Multigrid, IterationsDoNotGrow)
{
  LONG_CASE();
  double iterations[2];
  for (const int n : {2, 8}) {
    Scene run(
        beam(n, "frame total", 1e-4, "static tolerance 1e-11 solver multigrid", "linear 1e8 0") +
        "run 1\n");
    iterations[n / 8] = linear_in_each(run);
  }
  EXPECT_LE(iterations[1], 1.3 * iterations[0] + 1.0);
}

TEST(Implicit, RanksAndRestart)
{
  for (const std::string implicit :
       {"static", "euler", "static solver multigrid", "midpoint", "alpha", "static stabilize 1",
        "euler stabilize 1 solver multigrid"}) {
    const auto scene = replaced(beam(4, implicit == "alpha" ? "transfer flip 1.0" : "", 20.0,
                                     implicit + " tolerance 1e-11"),
                                "timestep 1.0", "timestep 0.01");
    Twins(scene, 2, lines_again(scene), 2, 1e-9);
  }
}

// a step in parts, and again with a stiffness of barely reached nodes, with a rank without points
TEST(Implicit, RanksWithoutPoints)
{
  OnRanks run(membrane("", "", 4, 40), "run 8\n", "processors 1 * 1\n");
  EXPECT_GT(solved(run.parallel, 11), 0.0);
  EXPECT_LT(measured("difference", run.difference()), 1e-9);
}

TEST(Implicit, RanksWithMovingWallsAndPeriodicFaces)
{
  for (const char *material :
       {"neohookean 1e8 0.3", "eos linear 1e8 strength j2 5e7 1e5 hardening linear 1e7"}) {
    OnRanks run(plane("si", "p f", "0 0.4 0 1", 1, 0.03) +
                    body("box", std::string("density 1000 ") + material, "0.05") +
                    "fix floor all mpm/boundary ylo stick\n"
                    "fix push all mpm/boundary yhi stick velocity 0.01 -0.01 NULL\n"
                    "fix solve all mpm/implicit static tolerance 1e-13\ntimestep 1.0\n",
                "run 3\n");
    EXPECT_LT(measured(std::string(material) + ": difference", run.difference()), 1e-9);
  }
}

// Functions that end in a plane of nodes reach these nodes or not, as round-off decides, and a node
// of no mass would still make the stress next to it zero. So it must be left alone: a block that
// has been moved by a few units in the last place has the same stresses

struct Ends {
  const char *shape;
  int ppc;
};

SERIAL_PARAMETER_TEST(Implicit, RoundOffMakesNoNodes, Ends,
                      Values(Ends{"gimp", 2}, Ends{"quadratic", 1}))
{
  const auto [shape, ppc] = GetParam();
  std::vector<std::array<double, 6>> stress[2];
  double most = 0.0, difference = 0.0;
  for (const double shift : {0.0, 3e-17, -3e-17}) {
    Scene run(plane("si", "f f", "0 0.12 0 0.12", 1, 0.005) + "fix g all mpm 0.01 shape " + shape +
              "\nregion b block 0.02 0.06 0.02 0.06 INF INF\n" +
              strprintf("create_points 1 region b ppc %d fix g\n", ppc) +
              strprintf("displace_atoms all move %g %g 0\n", shift, shift) +
              "velocity all ramp vx 1 -1 x 0.02 0.06\n"
              "fix m all mpm/material density 1000 neohookean 1e6 0.3\n"
              "fix solve all mpm/implicit euler tolerance 1e-11\ntimestep 1e-4\nrun 2\n");
    auto &here = stress[shift != 0.0];
    here.clear();
    for (const auto &s : run.gather()) {
      here.emplace_back();
      std::copy_n(s.stress, 6, here.back().begin());
    }
    for (std::size_t p = 0; p < here.size(); p++)
      for (int k = 0; k < 6; k++) {
        most = std::max(most, std::fabs(stress[0][p][k]));
        difference = std::max(difference, std::fabs(here[p][k] - stress[0][p][k]));
      }
  }
  EXPECT_LT(measured("difference of stress", difference / most), 1e-10);
}

// the derivative of a plastic law where there is no stress yet, with moduli of metals in Pa
SERIAL_TEST(Implicit, MetalsBeginWithoutStress)
{
  const double K = 68.6e9, G = 26.3e9, strain = 1e-4;
  for (const char *frame : {"", " frame total"}) {
    Scene run(plane("si", "f f", "0 1 0 1", 1, 0.03) +
              body("box", "density 2700 eos linear 68.6e9 strength j2 26.3e9 100e6",
                   std::string("0.1") + frame) +
              "fix sides all mpm/boundary xlo xhi ylo slip\n"
              "fix push all mpm/boundary yhi slip velocity 0 -1e-4 0\n"
              "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n");
    for (const auto &p : run.gather())
      EXPECT_NEAR(p.stress[1] / (-(K + 4.0 / 3.0 * G) * strain), 1.0, 1e-3);
  }
}

SERIAL_TEST(Implicit, BadInput)
{
  expect_refused(
      beam(2, "", 1.0, "", "linear 1e8 0"),
      {{"fix s all mpm/implicit", "missing argument"},
       {"fix s all mpm/implicit backward", "backward"},
       {"group some id 1\nfix s some mpm/implicit static", "use group all"},
       {"fix s all mpm/implicit static tolerance 0", "tolerance"},
       {"fix s all mpm/implicit static tolerance 1", "tolerance"},
       {"fix s all mpm/implicit static tolerance nan", "nan"},
       {"fix s all mpm/implicit static absolute -1", "absolute"},
       {"fix s all mpm/implicit static iterations 0", "iterations"},
       {"fix s all mpm/implicit static linear 0", "linear"},
       {"fix s all mpm/implicit static parts 0", "parts"},
       {"fix s all mpm/implicit static accuracy 2", "accuracy"},
       {"fix s all mpm/implicit static report perhaps", "perhaps"},
       {"fix s all mpm/implicit static stabilize -1", "stabilize"},
       {"fix s all mpm/implicit newmark stabilize 1", "static and euler"},
       {"fix s all mpm/implicit static damping 0.1", "damping"},
       {"fix s all mpm/implicit static solver magic", "magic"},
       {"fix s all mpm/implicit newmark gamma 0.4", "gamma"},
       {"fix s all mpm/implicit static gamma 0.6", "gamma"},
       {"fix s all mpm/implicit newmark", "use transfer flip 1.0"},
       {"fix s all mpm/implicit alpha", "use transfer flip 1.0"},
       {"fix s all mpm/implicit alpha rho 1.1", "rho"},
       {"fix s all mpm/implicit alpha gamma 0.6", "use newmark"},
       {"fix s all mpm/implicit hht rho 0.4", "use alpha"},
       {"fix s all mpm/implicit newmark rho 0.9", "use alpha or hht"},
       {"fix s all mpm/implicit midpoint gamma 0.6", "gamma"},
       {"fix s all mpm/implicit static\nfix t all mpm/implicit euler", "remove one"},
       {"fix s all mpm/implicit static\nfix dt all mpm/dt 0.5", "use timestep"},
       {"fix s all mpm/implicit static\nfix rest all mpm/relax 1e-5", "remove one"},
       {"unfix clamp\nfix s all mpm/implicit static", "hold bodies"},
       {"fix s all mpm/implicit static iterations 1", "smaller steps"},
       {"fix s all mpm/implicit static linear 3", "linear system"},
       {"fix g all gravity 1e6 vector 0 -1 0\nfix s all mpm/implicit static", "smaller steps"},
       {"fix g all gravity 1e6 vector 0 -1 0\nfix s all mpm/implicit static", "frame total"},
       {"unfix m\nunfix clamp\nunfix grid\nfix s all mpm/implicit static", "needs a fix mpm"}},
      "run 1\n");
  for (const char *options :
       {"frame total", "shape linear", "stress gradient", "transfer pic", "transfer flip 0.9"})
    expect_error(beam(4, options, 1.0, "midpoint") + "run 1\n", "use transfer flip 1.0");
  for (const char *options : {"shape linear", "shape cpdi", "shape gimp"})
    expect_error(beam(4, options, 1.0, "static stabilize 1") + "run 1\n", "stabilize is for");
  for (const char *options : {"scheme musl", "transfer xpic 2", "locking fbar", "locking both",
                              "every 2", "transfer flip 1.0", "transfer flip 0.99 edges modified"})
    expect_error(beam(4, options, 1.0, "static") + "run 1\n", "mpm/implicit");
}

// Newton's method goes past the critical load of Euler's column, both ends clamped, with shear
SERIAL_TEST(Column, Buckles)
{
  const double h = 0.05 / 4, L = 1.0 - 0.5 * h, EI = 1e8 * 0.05 * 0.05 * 0.05 / 12.0,
               euler = 4.0 * PI * PI * EI / (L * L),
               load = euler / (1.0 + euler / (5.0 / 6.0 * 5e7 * 0.05));
  Scene run(plane("si", "f f", "0 1.2 -0.5 0.5", 1, 0.01) +
            body("block 0 1 0 0.05 INF INF", "density 1000 neohookean 1e8 0",
                 strprintf("%.17g frame total", h)) +
            "fix clamp all mpm/boundary xlo stick\n" +
            strprintf("region end block %.17g INF INF INF INF INF\n", L) +
            "fix push all mpm/boundary region end stick velocity -0.002 0 NULL\n"
            "fix g all gravity 0.01 vector 0 -1 0\nfix solve all mpm/implicit static\n"
            "compute u all displace/atom\ncompute low all reduce min c_u[2]\n"
            "thermo_style custom step c_low\ntimestep 1.0\nrun 3\n");
  EXPECT_LT(run.fix("push")->compute_vector(0), 0.8 * load);
  EXPECT_GT(run.compute_scalar("low"), -1e-4);
  run.commands("run 5\n");
  EXPECT_NEAR(measured("load over Euler's", run.fix("push")->compute_vector(0) / load), 1.0, 0.01);
  // the ends come nearer by the bow: a cosine of amplitude w is shorter by (pi w)^2 / (4 L)
  const double nearer = 8 * 0.002 - load / (1e8 * 0.05), bow = 2.0 / PI * std::sqrt(nearer * L);
  EXPECT_NEAR(measured("bow", -run.compute_scalar("low") / bow), 1.0, 0.03);
}

// a thick-walled cylinder of a perfectly plastic metal, radii 1 and 2, plane strain: benchmark P3
SERIAL_TEST(Cylinder, BecomesPlastic)
{
  LONG_CASE();
  const int n = 16;
  const double h = 1.0 / n, v = 5e-5;
  Scene run(plane("si", "f p", strprintf("0 2.5 0 %.17g", 2 * h), 1, 0.3 * h) +
            body("block 1 2 INF INF INF INF",
                 "density 1000 eos linear 833.333333333 strength j2 384.615384615 1",
                 strprintf("%.17g frame total axisymmetric yes", h)) +
            "fix axis all mpm/boundary xlo slip\nregion bore block INF 1.0001 INF INF INF INF\n" +
            strprintf("fix push all mpm/boundary region bore stick velocity %g NULL NULL\n", v) +
            "fix solve all mpm/implicit static\ntimestep 1.0\n");
  const double reference[3][2] = {{0.5, 0.97223}, {0.6, 1.28674}, {0.7, 1.82421}};
  double before = 0.0, most = 0.0;
  int found = 0;
  for (int step = 1; step <= 40; step++) {
    run.commands("run 1\n");
    const double p = -run.fix("push")->compute_vector(0) / (2.0 * PI * 2.0 * h);
    most = std::max(most, solved(run, 0));
    while (found < 3 && p >= reference[found][0]) {
      const double u = v * (step - (p - reference[found][0]) / (p - before)) * 1000.0;
      EXPECT_NEAR(measured(strprintf("p %g: u", reference[found][0]), u) / reference[found][1], 1.0,
                  0.02);
      found++;
    }
    before = p;
  }
  EXPECT_EQ(found, 3);
  EXPECT_LE(most, 6.0);
}

/** A hollow sphere of a perfectly plastic metal around an axis of symmetry, with pressure in its
 *  bore: benchmark P3, a = 1, b = 2. Strains are 1e-6, as the solutions are those of small ones. */
struct HollowSphere {
  static constexpr double E = 1e6, YIELD = 1.0;
  Scene run;
  double p = 0.0;

  HollowSphere(const char *options, int ppc, double h = 0.1) :
      run(plane("si", "f f", "0 2.4 0 2.4", 1, 0.03) +
          strprintf("fix grid all mpm %g axisymmetric yes frame total ", h) + options +
          "\nregion outer sphere 0 0 0 2\nregion bore sphere 0 0 0 1 side out\n"
          "region shell intersect 2 outer bore\n" +
          strprintf("create_points 1 region shell ppc %d outside ignore\n", ppc) +
          "fix m all mpm/material density 1000 eos linear 833333.333333 strength j2 "
          "384615.384615 1\nfix walls all mpm/boundary xlo ylo slip\nvariable p equal 0.0\n"
          "fix gas all mpm/traction region bore pressure v_p area $(2*PI)\n"
          "fix solve all mpm/implicit static solver multigrid\ntimestep 1.0\n")
  {
    run.set_reference();
  }

  /** Pressure grows to this one in equal steps. Returns the largest number of iterations in one. */
  double load(double next, int steps)
  {
    double most = 0.0;
    for (int k = 1; k <= steps; k++) {
      run.commands(strprintf("variable p equal %.17g\nrun 1\n", p + (next - p) * k / steps));
      most = std::max(most, solved(run, 0));
    }
    p = next;
    return most;
  }

  /** At the bore, R^2 times displacement times E over the yield stress, or hoop stress over the
   *  yield stress, by a straight line through the points next to it. */
  double at_bore(bool stress)
  {
    double s[5] = {};
    for (int i = 0; i < run.n(); i++) {
      const double *const X = run.reference(i), *const x = run.x()[i], R = std::hypot(X[0], X[1]),
                          d = R - 1.0;
      if (d > 0.25) continue;
      const auto sigma = run.cauchy(i);
      const double value = stress ? sigma[2] / YIELD : (std::hypot(x[0], x[1]) - R) * R * R * E;
      const double w[5] = {1.0, d, d * d, value, value * d};
      for (int k = 0; k < 5; k++) s[k] += w[k];
    }
    return (s[3] * s[2] - s[4] * s[1]) / (s[0] * s[2] - s[1] * s[1]);
  }
};

// displacement of the bore by R. Hill for plastic zones to the radius c, also after unloading
SERIAL_TEST(Sphere, BecomesPlastic)
{
  HollowSphere sphere("", 4);
  struct Case {
    double p, u, c;
  };
  for (const auto &at : {Case{0.5, 0.4, 1.0}, Case{0.887310, 0.854676, 1.2},
                         Case{1.110944, 1.476422, 1.4}, Case{1.265341, 2.361064, 1.6}}) {
    EXPECT_LE(sphere.load(at.p, 3), 6.0);
    EXPECT_NEAR(measured(strprintf("c = %g: u(a) over exact", at.c), sphere.at_bore(false) / at.u),
                1.0, 0.02);
    if (at.c != 1.4) continue;
    sphere.load(0.0, 1);
    EXPECT_NEAR(measured("residual hoop stress over exact", sphere.at_bore(true) / -0.904476), 1.0,
                0.05);
    sphere.load(at.p, 1);
  }
}

// at 0.978 of the limit load, 10 and 20 cells give 2.8 and 2.1 % too much, 30 are within 2 %
SERIAL_TEST(Sphere, IsAlmostAllPlastic)
{
  LONG_CASE();
  for (const double h : {0.1, 1.0 / 30.0}) {
    HollowSphere sphere("", 4, h);
    sphere.load(1.110944, 5);
    sphere.load(1.356240, 5);
    EXPECT_NEAR(measured(strprintf("h = %g: u(a) over exact", h), sphere.at_bore(false) / 3.539904),
                1.0, h < 0.1 ? 0.02 : 0.03);
  }
}

// the same sphere bears 2 ln(b/a) and no more, to +2 % and -1 %, with averages of the pressure
SERIAL_TEST(Sphere, BearsTheLimitLoad)
{
  LONG_CASE();
  HollowSphere sphere("locking pressure", 4);
  const double limit = 2.0 * std::log(2.0);
  sphere.load(0.99 * limit, 4);
  const auto said = sphere.run.error("unfix solve\nfix solve all mpm/implicit static solver "
                                     "multigrid iterations 20 parts 1 linear "
                                     "500\n" +
                                     strprintf("variable p equal %.17g\nrun 1\n", 1.02 * limit));
  EXPECT_NE(said.find("no equilibrium"), std::string::npos) << said;
}

// forces are those of LAMMPS's units: a column sinks by a hundredth of its length
SERIAL_TEST(Forces, HaveUnits)
{
  for (const char *units : {"si", "metal", "real", "micro", "lj"}) {
    const double M = 1000.0 * 0.75 / (1.25 * 0.5);
    Scene run(
        space(units, "f f f", "0 2 0 2 -2 10", 1, 0.3) +
        body("block 0 2 0 2 0 10", "density 2.0 linear 1000 0.25", "1.0 frame total") +
        "fix top all mpm/boundary zhi stick\nfix sides all mpm/boundary xlo xhi ylo yhi slip\n");
    const double weight = 0.002 * M * 4.0 / run.lmp->force->nktv2p;
    run.commands(strprintf("fix load all addforce 0 0 %.17g\n", -weight / run.n()) +
                 "fix solve all mpm/implicit static\ncompute u all displace/atom\n"
                 "compute low all reduce min c_u[3]\nthermo_style custom step c_low\n"
                 "timestep 0.1\nrun 1\n");
    EXPECT_NEAR(run.compute_scalar("low"), -0.01, 5e-5) << units;
    EXPECT_NEAR(run.fix("top")->compute_vector(2) / -weight, 1.0, 1e-6) << units;
    EXPECT_LT(solved(run, 3) / weight, 1e-6) << units;
  }
}

// a smooth cylinder that is pushed into rubber, at any place: the floor bears it, energies close
SERIAL_TEST(Indenter, IsInBalanceWithTheFloor)
{
  for (const char *options : {"", "frame total", "shape cubic", "shape linear transfer pic"}) {
    Scene run(
        plane("si", "p f", "-1 1 0 1.5", 1, 0.02) +
        body("block INF INF 0 1 INF INF", "density 1000 neohookean 1e6 0.3",
             std::string("0.05 ") + options) +
        "fix floor all mpm/boundary ylo stick\nregion ball cylinder z 0.013 1.37 0.4 INF INF\n"
        "fix push all mpm/boundary region ball slip velocity 0.01 -0.01 0\n"
        "fix solve all mpm/implicit static tolerance 1e-10\ncompute e all mpm/energy\n"
        "thermo_style custom step c_e\ntimestep 1.0\nrun 3\n");
    const double push[2] = {run.fix("push")->compute_vector(0), run.fix("push")->compute_vector(1)};
    EXPECT_GT(push[1], 2e4) << options;
    for (int d = 0; d < 2; d++)
      EXPECT_NEAR(run.fix("floor")->compute_vector(d), -push[d], 1e-8 * push[1]) << options;
    const double *const e = run.compute_vector();
    EXPECT_LT(std::fabs(e[10]), 1e-9 * e[6]) << options;
    EXPECT_GT(e[6], e[1]) << "work of the last force of each step is more than what is stored";
  }
}

// Cook's membrane, compressible rubber under a dead shear force: benchmark P2b, with the
// displacement of the middle of its free side by finite elements of order 2, nine iterations in a
// step, and the same end in one load step and in two
SERIAL_TEST(Cook, ConvergesQuadratically)
{
  LONG_CASE();
  const auto scene = [](double h, int steps, const char *options) {
    return cooks_membrane(h, "frame total", "neohookean 70 $(1/3)", steps) +
        "fix solve all mpm/implicit static solver multigrid tolerance 1e-10 report yes " + options +
        "\n";
  };
  const auto end = [](Scene &run, double h) {
    // the last two columns of points, next to y = 52, extrapolated
    double u[2] = {0.0, 0.0}, n[2] = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++) {
      const double *const X = run.reference(i);
      if (std::abs(X[1] - 52.0) > 0.5 * h || X[0] < 48.0 - h) continue;
      const int k = X[0] < 48.0 - 0.5 * h;
      u[k] += run.x()[i][1] - X[1];
      n[k]++;
    }
    return 1.5 * u[0] / n[0] - 0.5 * u[1] / n[1];
  };
  for (const double h : {4.0, 2.0, 1.0}) {
    double u[2];
    for (const int steps : {1, 2}) {
      Scene run(scene(h, steps, ""));
      run.set_reference();
      run.commands(strprintf("run %d\n", steps));
      u[steps - 1] = end(run, h);
      if (steps == 1) EXPECT_LE(measured("iterations", solved(run, 0)), 9.0);
    }
    EXPECT_NEAR(measured(strprintf("h = %g: u over that of finite elements", h), u[0] / 19.3132),
                1.0, 0.0045 * h);
    EXPECT_LT(measured("one step or two", std::fabs(u[1] / u[0] - 1.0)), 1e-8);
  }
  // in five steps, solved exactly: the last two iterations before rounding errors
  const auto steps = residuals(scene(2.0, 5, "accuracy 1e-10") + "run 5\n");
  ASSERT_EQ(steps.size(), 5u);
  for (std::size_t k = 1; k < 5; k++) {
    auto f = steps[k];
    while (f.size() > 4 && f.back() < 1e-12 * *std::max_element(f.begin(), f.end())) f.pop_back();
    const auto n = f.size();
    ASSERT_GE(n, 4u);
    EXPECT_LE(steps[k].size(), 7u);
    EXPECT_GT(measured("order", std::log(f[n - 1] / f[n - 2]) / std::log(f[n - 2] / f[n - 3])),
              1.8);
  }
}

// a slender cantilever with a force at its tip that keeps its direction, a load step of P L^2 / EI
// = 1 in each solve: benchmark P1, with the values of plane strain. N layers of points have a
// second moment of the depth that is 1/N^2 too small: with 4 cells, its gate of 1 % needs more
// points than 2 x 2 in a cell, with which w is 1.0 and u 2.1 % too large
SERIAL_TEST(Elastica, BendsAsFarAsTheory)
{
  LONG_CASE();
  for (const auto &[n, ppc] : {std::pair{4, "2"}, {8, "2"}, {4, "4"}}) {
    const bool coarse = n == 4 && *ppc == '2';
    Scene run(elastica(n, DEAD_LOAD, "frame total", ppc) + "run 1\n");
    const std::string name = strprintf("%d cells, ppc %s", n, ppc);
    expect_tip(run, name, 0.30188, 0.05634, coarse ? 0.0105 : 0.003, coarse ? 0.022 : 0.006);
    run.commands("run 4\n");
    expect_tip(run, name, 0.71582, 0.38796, coarse ? 0.0035 : 0.0015, coarse ? 0.009 : 0.003);
  }
}

// a force that stays normal to the tip: benchmark P1b, of a beam that does not stretch or shear. 1
// % as of a dead load, but with 4 cells and 2 x 2 points in each
SERIAL_TEST(Elastica, FollowsItsTip)
{
  LONG_CASE();
  for (const auto &[n, ppc] : {std::pair{4, "2"}, {8, "2"}, {4, "4"}}) {
    const bool coarse = n == 4 && *ppc == '2';
    Scene run(elastica(n,
                       "region top plane 0 0.05 0 0 -1 0\nvariable p equal -v_force/v_h\n"
                       "fix load tip mpm/traction region top pressure v_p area $(v_h)",
                       "frame total", ppc));
    for (const auto &[steps, w, u] : {std::array<double, 3>{1, 0.320642, 0.064354},
                                      std::array<double, 3>{1, 0.573839, 0.232638},
                                      std::array<double, 3>{3, 0.780690, 0.827722}}) {
      run.commands(strprintf("run %g\n", steps));
      expect_tip(run, strprintf("%d cells, ppc %s", n, ppc), w, u, coarse ? 0.0125 : 0.005,
                 coarse ? 0.025 : 0.0085);
      EXPECT_EQ(solved(run, 8), 1.0) << "no parts";
    }
  }
}

// tests CSM1 and CSM2 of S. Turek and J. Hron (Lect. Notes Comput. Sci. Eng. 53 (2006) 371),
// benchmark D4: their flag at rest under its weight, clamped on a cylinder, by the nodes in this: a
// clamp that is off by a part of a cell. The gate is 5 %; what is wrong is of first order, and 0.8
// and 0.5 % (along, across) with 32 cells
SERIAL_TEST(TurekHron, FlagAtRest)
{
  LONG_CASE();
  for (const auto &[E, along, down] : {std::array<double, 3>{1.4e6, -7.187e-3, -66.10e-3},
                                       std::array<double, 3>{5.6e6, -0.4690e-3, -16.97e-3}})
    for (const int n : {8, 16}) {
      const double h = 0.02 / n, spacing = h / 4;
      Scene run(
          plane("si", "f f", "-0.02 0.4 -0.1 0.04", 1, 0.3 * h) +
          body("block -0.015 0.35 0 0.02 INF INF",
               strprintf("density 1000 stvenant/kirchhoff %g 0.4", E),
               strprintf("%.17g frame total", h), "4") +
          "region cylinder sphere -0.05 0.01 0 0.05\n"
          "fix clamp all mpm/boundary region cylinder stick\n"
          "fix g all gravity 2 vector 0 -1 0\n"
          "fix solve all mpm/implicit static solver multigrid\ncompute u all displace/atom\n" +
          strprintf("region last block %.17g INF INF INF INF INF\ngroup last region last\n"
                    "region two block %.17g INF INF INF INF INF\ngroup two region two\n",
                    0.35 - spacing, 0.35 - 2.0 * spacing) +
          "compute x last reduce ave c_u[1]\ncompute y last reduce ave c_u[2]\n"
          "compute xx two reduce ave c_u[1]\ncompute yy two reduce ave c_u[2]\n"
          "thermo_style custom step c_x c_y c_xx c_yy\ntimestep 1.0\nrun 1\n");
      // columns of points are at 1/2 and 1 spacing from the end in the mean
      const auto end = [&](const std::string &of) {
        return 2.0 * run.compute_scalar(of) - run.compute_scalar(of + of);
      };
      const std::string name = strprintf("%d cells, E = %g: ", n, E);
      EXPECT_NEAR(measured(name + "x over that of the benchmark", end("x") / along), 1.0,
                  n == 8 ? 0.042 : 0.017);
      EXPECT_NEAR(measured(name + "y over that of the benchmark", end("y") / down), 1.0,
                  n == 8 ? 0.025 : 0.01);
    }
}

// a step that does not converge at once, as iterations are few, is gone in parts, and ends in the
// same state: loads, and a wall that moves; the ledger and reactions know nothing of parts
SERIAL_TEST(Parts, LeadToTheSameEnd)
{
  const auto load = beam(2, "frame total", 300.0, "static tolerance 1e-11 SHORT"),
             wall = replaced(replaced(load, "gravity 300", "gravity 0.001"), "fix solve",
                             "region end block 0.95 INF INF INF INF INF\n"
                             "fix push all mpm/boundary region end stick velocity -0.1 -0.35 NULL\n"
                             "fix solve");
  for (const auto &scene : {load, wall}) {
    Scene whole(replaced(scene, "SHORT", "") + "run 1\n"),
        parts(replaced(scene, "SHORT", "iterations 6") + "run 1\n");
    EXPECT_EQ(solved(whole, 8), 1.0);
    EXPECT_GT(measured("parts", solved(parts, 8)), 2.0);
    EXPECT_LT(parts.fix("solve")->compute_scalar(), 1e-11);
    EXPECT_LT(measured("difference", difference(whole.gather(), parts.gather())), 1e-8);
    EXPECT_NEAR(whole.fix("clamp")->compute_vector(1), parts.fix("clamp")->compute_vector(1),
                1e-9 * std::fabs(whole.fix("clamp")->compute_vector(1)));
    const double *const e = whole.compute_vector(), *const f = parts.compute_vector();
    for (const int k : {5, 6, 10})
      EXPECT_NEAR(e[k], f[k], 1e-7 * (std::fabs(e[5]) + std::fabs(e[6])));
    expect_error(replaced(scene, "SHORT", "iterations 6 parts 1") + "run 1\n",
                 "0 % were reached, in 0 parts");
  }
}

// parts become larger again where the way is easier: a beam that hangs down in the end needs one of
// less than 1/8 at first, and less than eight of them
SERIAL_TEST(Parts, GrowAgain)
{
  const auto scene = beam(2, "frame total", 1000.0, "static tolerance 1e-11 iterations 12 parts N");
  expect_error(replaced(scene, "parts N", "parts 8") + "run 1\n", "no equilibrium in step 1");
  Scene run(replaced(scene, "parts N", "parts 16") + "run 1\n");
  EXPECT_GE(solved(run, 8), 5.0) << "1/16 and three that are twice as long each, and the rest";
  EXPECT_LT(measured("parts", solved(run, 8)), 8.0);
  EXPECT_LT(run.compute_scalar("low"), -0.7);
}

// a bar of Hencky's law in uniaxial strain bears M/e: the message tells where loads had come to
SERIAL_TEST(Limit, IsReported)
{
  const double M = 1e6 * 0.7 / (1.3 * 0.4);
  const auto scene =
      replaced(replaced(cell("shape linear frame total transfer pic"), "neohookean", "hencky"),
               "fix load all addforce 2e6 0 0",
               strprintf("variable f equal %.17g*(step+1)\nfix load all addforce v_f 0 0",
                         0.2 * M));    // half of it comes to the free nodes
  Scene run;
  const auto said = run.error(scene + "run 10\n");
  ASSERT_NE(said.find("no equilibrium in step 4"), std::string::npos) << said;
  // of hundreds of sums of forces the first and the last
  const auto from = said.find("sums of forces:"), to = said.find("; ratio", from);
  ASSERT_NE(to, std::string::npos) << said;
  EXPECT_LT(to - from, 250u) << said;
  const auto at = said.find("in this step ");
  ASSERT_NE(at, std::string::npos);
  const double share = std::stod(said.substr(at + 13)) / 100.0;
  EXPECT_NEAR(measured("load over M", 0.1 * (3.0 + share)) * std::exp(1.0), 1.0, 5e-3);
}

// a shallow arch of two bars snaps through where it bears no more: pushed down by a wall its force
// has a maximum, and under a load that grows it jumps from next to this to the other side, which
// the number of tangents that are not positive definite tells
SERIAL_TEST(Arch, SnapsThrough)
{
  LONG_CASE();
  const std::string arch = plane("si", "f f", "-0.5 0.4 0 1", 1, 0.004) +
      "fix grid all mpm 0.02 frame total\nregion bar prism 0 0.08 0 1 -1 1 0.15 0 0\n"
      "create_points 1 region bar ppc 2\n"
      "fix m all mpm/material density 1000 neohookean 1e8 0.0\n"
      "fix clamp all mpm/boundary ylo stick\nfix middle all mpm/boundary yhi slip\n"
      "region tip block INF INF 0.98 INF INF INF\ngroup tip region tip\n"
      "variable n equal count(tip)\ncompute u tip displace/atom\n"
      "compute w tip reduce ave c_u[1]\nthermo_style custom step c_w\n"
      "fix solve all mpm/implicit static solver multigrid\ntimestep 1.0\n";
  Scene pushed(arch +
               "region hold block INF INF 0.98001 INF INF INF\n"
               "fix push all mpm/boundary region hold stick velocity -0.004 NULL NULL\n");
  double limit = 0.0, at = 0.0, force = 0.0, before = 0.0;
  for (int step = 0; step < 30; step++) {
    pushed.commands("run 1\n");
    before = force;
    force = pushed.fix("push")->compute_vector(0);
    if (force > limit) {
      limit = force;
      at = pushed.compute_scalar("w");
    }
  }
  EXPECT_LT(force, before);
  measured("largest force", limit);
  measured("there, displacement", at);

  Scene loaded(arch + strprintf("variable f equal -%.17g*(0.9+0.005*(step+1))/v_n\n", limit) +
               "fix load tip addforce v_f 0 0\n");
  double w = 0.0, jump = 0.0;
  int step = 0;
  for (; step < 40 && jump > -0.1; step++) {
    loaded.commands("run 1\n");
    jump = step == 0 ? 0.0 : loaded.compute_scalar("w") - w;
    w = loaded.compute_scalar("w");
  }
  EXPECT_NEAR(measured("load of the jump over the largest force", 0.9 + 0.005 * step), 1.0, 0.01);
  EXPECT_GT(solved(loaded, 9), 0.0);
  EXPECT_LT(measured("displacement after the jump", w), -0.15) << "below its supports";
}

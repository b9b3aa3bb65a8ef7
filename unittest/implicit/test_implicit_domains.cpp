// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4

// Fix mpm/implicit with points that have domains (shapes cpdi and cpdi2).

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

static const char *const SHAPES[] = {"shape cpdi", "shape cpdi2"};

/** The displacement of the material at the height Y of the end of the bar that hangs. */
static double hangs(double g, double Y)
{
  const int n = 2000;
  double sum = 0.0, F = 1.0;
  for (int k = n - 1; k >= 0; k--) {
    const double y = Y + (1.0 - Y) * (k + 0.5) / n, load = 1000.0 * g * y;
    for (int turn = 0; turn < 20; turn++)
      F -= (nominal_stress(F) - load) /
          (MU * (1.0 + 1.0 / (F * F)) + LAMBDA * (1.0 - std::log(F)) / (F * F));
    sum += (F - 1.0) * (1.0 - Y) / n;
  }
  return sum;
}

// the change of forces in a direction against differences of forces, with domains that are no boxes
// any more, and its diagonal, in which each node counts once however many corners see it
SERIAL_TEST(Tangent, IsThatOfTheForces)
{
  for (const std::string shape : SHAPES)
    for (const std::string options : {"", " axisymmetric yes", " locking pressure", " 3d"}) {
      Scene run(block_of_3("neohookean 1e6 0.3", shape + options));
      distort(run, 0.15, options == " axisymmetric yes");
      expect_tangent(run, shape + options, 0.05, 1.0, options == " locking pressure" ? 0 : 5);
    }
}

// any uniform strain is found exactly, and walls bear the force of the law
SERIAL_TEST(Patch, UniformStrain)
{
  for (const int dim : {2, 3})
    for (const char *shape : SHAPES)
      for (const char *transfer : {"apic", "pic"})
        expect_uniform_strain(dim, strprintf("%s transfer %s", shape, transfer));
}

// exact for large strains, stretch up to 2.9 in the last case, where other shapes come apart
SERIAL_TEST(Bar, HangsUnderItsWeight)
{
  for (const char *shape : SHAPES)
    for (const double g : {100.0, 500.0, 1500.0}) {
      double error[2];
      for (const int n : {10, 20}) {
        Scene run(hanging(n, shape, 1000, g, 4) + "run 4\n");
        const double exact = hangs(g, 0.25 / n);
        error[n / 20] = -run.compute_scalar("low") / exact - 1.0;
        measured(strprintf("g %g %s, %d cells: exact %g, error", g, shape, n, exact),
                 error[n / 20]);
      }
      EXPECT_LT(std::fabs(error[1]), 5e-4) << shape;
      EXPECT_GT(error[0] / error[1], 3.4) << shape;
    }
}

// a beam that bends by more than a third of its length, in the updated frame, in which points with
// other functions find no balance: as in the total frame; the wall bears the weight
SERIAL_TEST(Beam, BendsFar)
{
  Scene total(beam(4, "frame total", 300.0, "static solver multigrid") + "run 1\n");
  const double tip = total.compute_scalar("low");
  for (const char *shape : SHAPES) {
    Scene run(
        replaced(beam(4, shape, 300.0, "static solver multigrid"), "gravity 300", "gravity v_g") +
        "variable g equal 30*(step+1)\nrun 10\n");
    EXPECT_NEAR(measured(std::string(shape) + ": tip over that in the total frame",
                         run.compute_scalar("low") / tip),
                1.0, 0.006);
    EXPECT_NEAR(run.fix("clamp")->compute_vector(1) / -3e4, 1.0, 1e-6) << shape;
    EXPECT_GE(solved(run, 5), 30.0);
  }
}

// forces out of balance fall as their square, for a block that sinks and leans by a tenth
SERIAL_TEST(Block, ConvergesQuadratically)
{
  for (const std::string shape : SHAPES)
    expect_quadratic(
        shape,
        plane("si", "p f", "0 1.5 0 1.5", 1, 0.03) +
            body("block 0.2 0.8 0 0.713 INF INF", "density 1000 neohookean 1e6 0.3",
                 "0.1 " + shape) +
            "fix floor all mpm/boundary ylo stick\nfix g all gravity 200 vector 0.3 -1 0\n"
            "fix solve all mpm/implicit static tolerance 1e-14 accuracy 1e-10 report yes\n"
            "timestep 1.0\nrun 1\n",
        8);
}

// the elastica with P L^2/EI = 1, 3, in as many steps
SERIAL_TEST(Cantilever, IsAnElastica)
{
  for (const int n : {4, 8}) {
    Scene run(elastica(n, DEAD_LOAD, "shape cpdi2"));
    for (const auto &[steps, w, u] : {std::array<double, 3>{1, 0.301721, 0.056433},
                                      std::array<double, 3>{2, 0.603254, 0.254422}}) {
      run.commands(strprintf("run %g\n", steps));
      expect_tip(run, strprintf("%d cells", n), w, u, n == 4 ? 0.0125 : 0.005,
                 n == 4 ? 0.025 : 0.0085);
    }
  }
}

// where explicit steps of the same scene come to rest
SERIAL_TEST(Block, IsWhereExplicitStepsEnd)
{
  for (const char *shape : SHAPES)
    for (const int dim : {2, 3}) {
      const auto scene = box(dim, "si", dim == 3 ? "p p f" : "p f p",
                             dim == 3 ? "0 0.4 0 0.4 0 1" : "0 1 0 1 0 0", 1, 0.02) +
          body(dim == 3 ? "block INF INF INF INF 0 0.713" : "block 0.2 0.8 0 0.713 INF INF",
               "density 1000 neohookean 1e6 0.3", strprintf("0.1 %s transfer pic", shape)) +
          strprintf("fix floor all mpm/boundary %slo stick\n", dim == 3 ? "z" : "y") +
          strprintf("fix g all gravity 50 vector 0 %s\n", dim == 3 ? "0 -1" : "-1 0") +
          strprintf("compute u all displace/atom\ncompute low all reduce min c_u[%d]\n", dim) +
          "thermo_style custom step c_low\n";
      Scene rests(scene + "fix solve all mpm/implicit static\ntimestep 1.0\nrun 1\n"),
          moves(scene + "fix rest all mpm/relax 1e-6\nfix dt all mpm/dt 0.5\nrun 100000\n");
      const double low = moves.compute_scalar("low");
      EXPECT_NEAR(measured(strprintf("%s %dd: %g, over that", shape, dim, low),
                           rests.compute_scalar("low") / low),
                  1.0, 0.003);
    }
}

// levels change the way of the linear solver, and not where it comes to
SERIAL_TEST(Multigrid, ComesToTheSame)
{
  for (const std::string shape : SHAPES)
    for (const std::string options : {"", " axisymmetric yes", " 3d"}) {
      const bool space = options == " 3d";
      expect_same_with_levels(
          shape + options,
          box(space ? 3 : 2, "si", "f f f", "0 2.5 0 0.8 0 0.8", 1, 0.02) +
              body("block 1.013 2.013 INF INF INF INF", "density 1000 neohookean 1e6 0.3",
                   "0.1 " + shape + (space ? "" : options)) +
              "fix sides all mpm/boundary xlo slip\nfix floor all mpm/boundary ylo stick\n"
              "fix g all gravity 20 vector 0.3 -1 0\n",
          "static", 4.0);
    }
}

// the lowest vibration of a bar in the plane: the frequency and the damping of the method
SERIAL_TEST(Vibration, HasTheNumbersOfTheMethod)
{
  for (const std::string shape : SHAPES) {
    expect_vibration(shape + " transfer flip 1.0", "newmark", 0.5, 0.979915, 1.0);
    expect_vibration(shape + " transfer flip 1.0", "euler", 0.5, std::atan(0.5) / 0.5, 0.894427);
    expect_vibration(shape + " transfer flip 1.0", "alpha", 0.5, 0.978834, 1.0);
  }
}

// a free body that turns in large steps keeps its momentum, and its ledger closes
SERIAL_TEST(Disk, KeepsItsMomentum)
{
  for (const std::string shape : SHAPES)
    for (const std::string implicit : {"newmark", "euler"}) {
      Scene run;
      spin(run, shape + " transfer flip 1.0", implicit + " tolerance 1e-12", 0.005);
      const auto before = run.sums();
      run.commands("run 20\n");
      const auto after = run.sums();
      for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d] / before.p[d], 1.0, 1e-10);
      const auto name = shape + " " + implicit;
      measured(name + ": angular momentum", after.L[2] / before.L[2]);
      const double *const e = run.compute_vector();
      EXPECT_LT(measured(name + ": residual", std::fabs(e[10]) / before.kinetic), 1e-10);
    }
}

TEST(Domains, RanksAndRestart)
{
  for (const char *shape : SHAPES)
    for (const std::string implicit : {"static", "euler solver multigrid"}) {
      const auto scene = replaced(beam(4, shape, 20.0, implicit + " tolerance 1e-11"),
                                  "timestep 1.0", "timestep 0.01");
      Twins(scene, 2, lines_again(scene), 2, 1e-9);
    }
}

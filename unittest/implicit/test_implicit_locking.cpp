// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/implicit with averages of the pressure over neighboring points (locking pressure).

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

/** Half of a strip footing of width 2 that is pushed into clay of shear strength 1e4, on n cells
 *  below each half: rough and rigid, its edge between the last node that it holds and the next. */
static std::string footing(int n, const std::string &options, double settlement, int steps)
{
  const double h = 1.0 / (n + 0.5), E = 1e7, nu = 0.49;
  return plane("si", "f f", strprintf("0 %.17g %.17g 1", h * (5 * n + 2), -3.0 * n * h), 1,
               0.3 * h) +
      body("block INF INF INF 0 INF INF",
           strprintf("density 1000 eos linear %.17g strength j2 %.17g %.17g",
                     E / (3.0 * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu)), std::sqrt(3.0) * 1e4),
           strprintf("%.17g frame total ", h) + options) +
      "fix base all mpm/boundary ylo stick\nfix sides all mpm/boundary xlo xhi slip\n" +
      strprintf("region foot block INF 1 %.17g INF INF INF\n", -0.01 * h) +
      strprintf("fix push all mpm/boundary region foot stick velocity 0 %.17g NULL\n",
                -2.0 * settlement / steps) +
      "fix solve all mpm/implicit static solver multigrid\ncompute e all mpm/energy\n"
      "thermo_style custom step c_e\ntimestep 1.0\n";
}

/** Cook's membrane of rubber, whose clamped side has 44/h cells. */
static std::string membrane(double h, const char *rubber, int steps)
{
  return cooks_membrane(h, "frame total locking pressure", std::string("neohookean ") + rubber,
                        steps) +
      "fix solve all mpm/implicit static solver multigrid\n" +
      strprintf("region tip block %.17g 49 %.17g %.17g INF INF\n", 48.0 - h, 52.0 - 0.5 * h,
                52.0 + 0.5 * h) +
      "group tip region tip\ncompute u all displace/atom\ncompute up tip reduce ave c_u[2]\n" +
      strprintf("thermo_style custom step c_up\nrun %d\n", steps);
}

// the change of forces in a direction, of all points around each, against differences of forces
SERIAL_TEST(Tangent, IsThatOfTheForces)
{
  for (const std::string law : {"neohookean 1e6 0.45", "eos linear 1e6 strength j2 4e5 2e3",
                                "drucker/prager 1e6 0.3 30 cohesion 2e4"})
    for (const std::string options : {"", "frame total", "axisymmetric yes", "3d"}) {
      Scene run(block_of_3(law, "locking pressure " + options));
      distort(run, 0.05, options == "axisymmetric yes");
      expect_tangent(run, law + " " + options, 0.05, 1e-3, 0);
    }
}

// uniform strain is found exactly, with the force of the law on the wall
SERIAL_TEST(Patch, UniformStrain)
{
  for (const char *options :
       {"", "frame total", "shape cubic", "frame total shape linear transfer pic"})
    expect_uniform_strain(2, std::string("locking pressure ") + options);
}

// bearing capacity of a strip footing on clay, by L. Prandtl (1920): (2 + pi) c. Without averages
// points ask for more than nodes can give, and the force goes on growing
SERIAL_TEST(Footing, BearsPrandtlsLoad)
{
  double growth[2];
  for (const bool cure : {false, true}) {
    Scene run(footing(4, cure ? "locking pressure" : "", 0.02, 20) + "run 15\n");
    const double before = run.fix("push")->compute_vector(1) / 1e4;
    run.commands("run 5\n");
    const double load = run.fix("push")->compute_vector(1) / 1e4;
    growth[cure] = load / before - 1.0;
    measured(std::string(cure ? "averages" : "none") + ": load over c", load);
    measured("growth in the last quarter", growth[cure]);
    if (cure) EXPECT_NEAR(load / (2.0 + PI), 1.0, 0.03);
    const double *const e = run.compute_vector();
    EXPECT_LT(std::fabs(e[10]), 1e-9 * std::fabs(e[6])) << "residual of the ledger";
  }
  EXPECT_LT(growth[true], 0.01);
  EXPECT_GT(growth[false], 3.0 * growth[true]);
}

// D5: deflection of the middle of the free side by mixed finite elements, to 3 % with 44 cells, and
// half of the error with twice as many cells. Preconditioners know the averages, so that nearly
// incompressible rubber takes some ten iterations in each of Newton's method
SERIAL_TEST(Cook, RubberThatBends)
{
  const auto error = [](double h, const char *rubber, int steps, double exact) {
    Scene run(membrane(h, rubber, steps));
    EXPECT_LT(linear_in_each(run), 40.0);
    return measured(strprintf("%s, %g cells", rubber, 44.0 / h),
                    run.compute_scalar("up") / exact - 1.0);
  };
  const double coarse = error(4.0, "240.565 0.4999", 10, 6.953),
               fine = error(2.0, "240.565 0.4999", 10, 6.953);
  EXPECT_LT(std::fabs(fine), 0.6 * std::fabs(coarse));
  if (is_quick()) return;    // the finest one takes long
  EXPECT_NEAR(error(1.0, "70 0.499", 5, 18.515), 0.0, 0.03);
}

// an average whose points are with several ranks is one for preconditioners
TEST(Cook, TakesTheSameIterationsOnRanks)
{
  Scene run(membrane(4.0, "240.565 0.4999", 4));
  EXPECT_LT(linear_in_each(run), 18.0);
}

TEST(Locking, RanksAndRestart)
{
  for (const char *options : {"locking pressure", "locking pressure shape cubic"}) {
    const auto scene = replaced(footing(2, options, 0.01, 10), "static", "static tolerance 1e-12");
    Twins(scene, 3, lines_again(scene), 3, 1e-9);
  }
}

SERIAL_TEST(Locking, BadInput)
{
  for (const char *options : {"locking fbar", "locking both"})
    expect_error(footing(2, options, 0.01, 10) + "run 1\n", "use locking pressure");
}

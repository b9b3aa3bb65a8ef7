// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/implicit with averages of the pressure over neighboring points (locking pressure).

#include "mpm_lammps.h"

#include "field/mpm_plan.h"
#include "implicit/mpm_tangent.h"

using namespace MPM_TEST;

namespace {

/** Half of a strip footing of width 2 that is pushed into clay of shear strength 1e4, on n cells below each half: rough and rigid,
 *  its edge in the middle between the last node that it holds and the next one. */
std::string footing(int n, const std::string &options, double settlement, int steps)
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

/** Cook's membrane (48 x 44 to 60, of rubber), whose clamped side has 44/h cells, under a shear force of 100 at its free side. */
std::string membrane(double h, double E, double nu, int steps)
{
  return plane("si", "f f", "0 60 0 90", 1, 0.4) +
      strprintf("fix grid all mpm %.17g frame total locking pressure\n", h) +
      "region lower plane 0 0 0 -44 48 0\nregion upper plane 0 44 0 16 -48 0\n"
      "region span block 0 48 0 60 INF INF\nregion plate intersect 3 span lower upper\n"
      "create_points 1 region plate ppc 2 outside ignore\n" +
      strprintf("fix m all mpm/material density 1 neohookean %.17g %.17g\n", E, nu) +
      "fix clamp all mpm/boundary xlo stick\nregion edge plane 48 0 0 -1 0 0\n" +
      strprintf("variable t equal 100/16*(step+1)/%d\n", steps) +
      "fix load all mpm/traction region edge traction 0 v_t 0 area 16\n"
      "fix solve all mpm/implicit static solver multigrid\n" +
      strprintf("region tip block %.17g 49 %.17g %.17g INF INF\n", 48.0 - h, 52.0 - 0.5 * h,
                52.0 + 0.5 * h) +
      "group tip region tip\ncompute u all displace/atom\ncompute up tip reduce ave c_u[2]\n"
      "thermo_style custom step c_up\ntimestep 1.0\n" +
      strprintf("run %d\n", steps);
}

}    // namespace

// the change of forces in a direction, of all points around each, against differences of forces
SERIAL_TEST(Tangent, IsThatOfTheForces)
{
  for (const char *law : {"neohookean 1e6 0.45", "eos linear 1e6 strength j2 4e5 2e3",
                          "drucker/prager 1e6 0.3 30 cohesion 2e4"})
    for (const char *options : {"", "frame total", "axisymmetric yes", "3d"}) {
      const int dim = std::string(options) == "3d" ? 3 : 2;
      const bool axis = std::string(options) == "axisymmetric yes";
      Scene run(box(dim, "si", "f f f", "0 6 0 6 0 6", 1, 0.3) +
                (axis ? "fix axis all mpm/boundary xlo slip\n" : "") +
                body(dim == 3 ? "block 1 4 1 4 1 4" : "block 1 4 1 4 INF INF",
                     std::string("density 1000 ") + law,
                     std::string("1.0 locking pressure ") + (dim == 3 ? "" : options)) +
                "timestep 1e-3\nrun 0\n");
      for (int i = 0; i < run.n(); i++)
        for (int c = 0; c < 9; c++)
          if (dim == 3 || c == 0 || c == 1 || c == 3 || c == 4 || (axis && c == 8))
            run.points().F[i][c] += 0.05 * std::sin(1.3 * (9 * i + c));
      auto *const field = MPMField::find(run.lmp, "grid");
      field->plan->find_blocks_now();
      MPMTangent tangent(run.lmp, *field);
      tangent.init();
      const std::size_t n = field->grid.nnodes() * dim;
      std::vector<double> u(n), du(n), f(n), low(n), high(n), df(n);
      tangent.external_forces(f.data());
      for (std::size_t k = 0; k < n; k++) {
        u[k] = 0.05 * std::sin(1.7 * k);
        du[k] = std::sin(2.9 * k + 1.0);
      }
      field->nodes.complete(u.data(), dim, dim);
      const double dt = 1e-3, eps = 1e-6;
      double carried;
      ASSERT_TRUE(tangent.forces(u.data(), dt, f.data(), carried));
      tangent.linearize(u.data(), dt);
      tangent.change_of_forces(du.data(), df.data());
      auto shifted = u;
      for (std::size_t k = 0; k < n; k++) shifted[k] = u[k] + eps * du[k];
      tangent.forces(shifted.data(), dt, high.data(), carried);
      for (std::size_t k = 0; k < n; k++) shifted[k] = u[k] - eps * du[k];
      tangent.forces(shifted.data(), dt, low.data(), carried);
      double worst = 0.0, most = 0.0;
      for (std::size_t k = 0; k < n; k++) {
        worst = std::max(worst, std::fabs((high[k] - low[k]) / (2.0 * eps) - df[k]));
        most = std::max(most, std::fabs(df[k]));
      }
      EXPECT_LT(measured(std::string(law) + " " + options, worst / most), 1e-6);
    }
}

// uniform strain is found exactly, with the force of the law on the wall
SERIAL_TEST(Patch, UniformStrain)
{
  for (const char *options :
       {"", "frame total", "shape cubic", "frame total shape linear transfer pic"}) {
    Scene run(plane("si", "p f", "0 0.4 0 1", 1, 0.03) +
              body("box", "density 1000 neohookean 1e6 0.3",
                   std::string("0.1 locking pressure ") + options) +
              "fix floor all mpm/boundary ylo stick\n"
              "fix push all mpm/boundary yhi stick velocity 0.05 -0.1 NULL\n"
              "fix solve all mpm/implicit static tolerance 1e-12\ntimestep 1.0\nrun 1\n");
    const double mu = 1e6 / 2.6, lambda = 1e6 * 0.3 / 1.3 / 0.4;
    for (int i = 0; i < run.n(); i++) EXPECT_NEAR(run.points().F[i][4], 0.9, 1e-9) << options;
    EXPECT_NEAR(run.fix("push")->compute_vector(1) / 0.4,
                -(mu * (0.9 - 1.0 / 0.9) + lambda * std::log(0.9) / 0.9), 1e-3)
        << options;
  }
}

// bearing capacity of a strip footing on clay, by L. Prandtl (1920): (2 + pi) c. Without averages points ask for more than nodes can
// give, and the force goes on growing
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

// D5: deflection of the middle of the free side by mixed finite elements, to 3 % with 44 cells, and half of the error with twice as many cells.
// Preconditioners know the averages, so that nearly incompressible rubber takes some ten iterations in each of Newton's method
SERIAL_TEST(Cook, RubberThatBends)
{
  const auto error = [](double h, double E, double nu, int steps, double exact) {
    Scene run(membrane(h, E, nu, steps));
    const double wrong = run.compute_scalar("up") / exact - 1.0;
    measured(strprintf("nu %g, %g cells", nu, 44.0 / h), wrong);
    EXPECT_LT(measured("linear iterations in each",
                       run.fix("solve")->compute_vector(1) / run.fix("solve")->compute_vector(0)),
              40.0);
    return wrong;
  };
  const double coarse = error(4.0, 240.565, 0.4999, 10, 6.953),
               fine = error(2.0, 240.565, 0.4999, 10, 6.953);
  EXPECT_LT(std::fabs(fine), 0.6 * std::fabs(coarse));
  EXPECT_NEAR(error(1.0, 70.0, 0.499, 5, 18.515), 0.0, 0.03);
}

// an average whose points are with several ranks is one for preconditioners
TEST(Cook, TakesTheSameIterationsOnRanks)
{
  Scene run(membrane(4.0, 240.565, 0.4999, 4));
  EXPECT_LT(measured("linear iterations in each",
                     run.fix("solve")->compute_vector(1) / run.fix("solve")->compute_vector(0)),
            18.0);
}

TEST(Locking, RanksAndRestart)
{
  for (const char *options : {"locking pressure", "locking pressure shape cubic"}) {
    const auto scene = replaced(footing(2, options, 0.01, 10), "static", "static tolerance 1e-12");
    const double h = 1.0 / 2.5;
    const auto next = strprintf("neighbor %.17g bin\n", 0.3 * h) +
        replaced(replaced(scene.substr(scene.find("fix grid")),
                          "create_points 1 region body ppc 2\n", ""),
                 "region body block INF INF INF 0 INF INF\n", "");
    Twins(scene, 3, next, 3, 1e-9);
  }
}

SERIAL_TEST(Locking, BadInput)
{
  for (const char *options : {"locking fbar", "locking both"})
    expect_error(footing(2, options, 0.01, 10) + "run 1\n", "use locking pressure");
}

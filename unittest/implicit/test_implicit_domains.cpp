// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4

// Fix mpm/implicit with points that have domains (shapes cpdi and cpdi2).

#include "mpm_lammps.h"

#include "field/mpm_plan.h"
#include "implicit/mpm_tangent.h"

using namespace MPM_TEST;

namespace {

const char *const SHAPES[] = {"shape cpdi", "shape cpdi2"};

/** A bar of length 1 that hangs from the top of the box, of n cells, with rollers at its sides; its weight g in equal steps. */
std::string hanging(int n, const std::string &options, double g, int steps)
{
  const double h = 1.0 / n;
  return plane("si", "f f", strprintf("0 %.17g -3.2 1", 2 * h), 1, 0.3 * h) +
      body("block INF INF 0 1 INF INF", "density 1000 neohookean 1e6 0.3",
           strprintf("%.17g ", h) + options) +
      "fix top all mpm/boundary yhi stick\nfix sides all mpm/boundary xlo xhi slip\n" +
      strprintf("variable g equal %.17g*(step+1)/%d\n", g, steps) +
      "fix g all gravity v_g vector 0 -1 0\ncompute u all displace/atom\n"
      "compute low all reduce min c_u[2]\nfix solve all mpm/implicit static\ntimestep 1.0\n"
      "thermo_style custom step c_low\n";
}

/** The displacement of the material at the height Y of the end of that bar. */
double hangs(double g, double Y)
{
  const double mu = 1e6 / 2.6, lambda = 1e6 * 0.3 / 1.3 / 0.4;
  const int n = 2000;
  double sum = 0.0, F = 1.0;
  for (int k = n - 1; k >= 0; k--) {
    const double y = Y + (1.0 - Y) * (k + 0.5) / n, load = 1000.0 * g * y;
    for (int turn = 0; turn < 20; turn++)
      F -= (mu * (F - 1.0 / F) + lambda * std::log(F) / F - load) /
          (mu * (1.0 + 1.0 / (F * F)) + lambda * (1.0 - std::log(F)) / (F * F));
    sum += (F - 1.0) * (1.0 - Y) / n;
  }
  return sum;
}

/** A beam of length 1 and depth 0.1, clamped at x = 0, of n cells in its depth, under its weight. */
std::string beam(int n, const std::string &options, double g, const std::string &implicit)
{
  const double h = 0.1 / n;
  return plane("si", "f f", "0 1.2 -1.1 0.4", 1, 0.3 * h) +
      body("block 0 1 0 0.1 INF INF", "density 1000 neohookean 1e8 0.3",
           strprintf("%.17g ", h) + options) +
      "fix clamp all mpm/boundary xlo stick\n" +
      strprintf("fix g all gravity %g vector 0 -1 0\n", g) + "fix solve all mpm/implicit " +
      implicit +
      "\ncompute u all displace/atom\ncompute low all reduce min c_u[2]\n"
      "compute e all mpm/energy\nthermo_style custom step c_low c_e\ntimestep 1.0\n";
}

}    // namespace

// the change of forces in a direction against differences of forces, with domains that are no boxes any more, and its diagonal, in which
// each node counts once however many corners see it
SERIAL_TEST(Tangent, IsThatOfTheForces)
{
  for (const char *shape : SHAPES)
    for (const char *options : {"", " axisymmetric yes", " locking pressure", " 3d"}) {
      const int dim = std::string(options) == " 3d" ? 3 : 2;
      const bool axis = std::string(options) == " axisymmetric yes";
      Scene run(box(dim, "si", "f f f", "0 6 0 6 0 6", 1, 0.3));
      if (axis) run.commands("fix axis all mpm/boundary xlo slip\n");
      run.commands(body(dim == 3 ? "block 1 4 1 4 1 4" : "block 1 4 1 4 INF INF",
                        "density 1000 neohookean 1e6 0.3",
                        std::string("1.0 ") + shape + (dim == 3 ? "" : options)) +
                   "timestep 1e-3\nrun 0\n");
      for (int i = 0; i < run.n(); i++)
        for (int c = 0; c < 9; c++)    // what plane strain has
          if (dim == 3 || c == 0 || c == 1 || c == 3 || c == 4 || (axis && c == 8))
            run.points().F[i][c] += 0.15 * std::sin(1.3 * (9 * i + c));
      auto *const field = MPMField::find(run.lmp, "grid");
      if (field->domains->corners)
        for (int i = 0; i < run.n(); i++)
          for (int k = 0; k < field->domains->size(); k++)
            field->domains->corners[i][k] += 0.03 * std::sin(2.1 * k + i);
      field->plan->find_blocks_now();
      field->domains->update();
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
      const double eps = 1e-6;
      double carried;
      ASSERT_TRUE(tangent.forces(u.data(), 1.0, f.data(), carried)) << shape;
      tangent.linearize(u.data(), 1.0);
      tangent.change_of_forces(du.data(), df.data());
      auto shifted = u;
      for (std::size_t k = 0; k < n; k++) shifted[k] = u[k] + eps * du[k];
      tangent.forces(shifted.data(), 1.0, high.data(), carried);
      for (std::size_t k = 0; k < n; k++) shifted[k] = u[k] - eps * du[k];
      tangent.forces(shifted.data(), 1.0, low.data(), carried);
      double worst = 0.0, most = 0.0;
      for (std::size_t k = 0; k < n; k++) {
        worst = std::max(worst, std::fabs((high[k] - low[k]) / (2.0 * eps) - df[k]));
        most = std::max(most, std::fabs(df[k]));
      }
      EXPECT_GT(most, 0.0);
      EXPECT_LT(measured(std::string(shape) + options, worst / most), 1e-6);
      if (std::string(options) == " locking pressure") continue;
      std::vector<double> blocks;
      tangent.diagonal(blocks);
      for (std::size_t node = 0; node < n / dim; node += 5)
        for (int d = 0; d < dim; d++) {
          std::fill(du.begin(), du.end(), 0.0);
          du[dim * node + d] = 1.0;
          tangent.change_of_forces(du.data(), df.data());
          for (int e = 0; e < dim; e++)
            EXPECT_NEAR(-df[dim * node + e], blocks[dim * dim * node + dim * e + d], 1e-9 * most)
                << shape << options;
        }
    }
}

// any uniform strain is found exactly, and walls bear the force of the law
SERIAL_TEST(Patch, UniformStrain)
{
  const double mu = 1e6 / 2.6, lambda = 1e6 * 0.3 / 1.3 / 0.4;
  for (const int dim : {2, 3})
    for (const char *shape : SHAPES)
      for (const char *transfer : {"apic", "pic"}) {
        const char *const top = dim == 2 ? "y" : "z";
        Scene run(box(dim, "si", dim == 2 ? "p f p" : "p p f",
                      dim == 2 ? "0 0.4 0 1 0 0" : "0 0.4 0 0.4 0 1", 1, 0.03) +
                  body("box", "density 1000 neohookean 1e6 0.3",
                       strprintf("0.1 %s transfer %s", shape, transfer)) +
                  strprintf("fix floor all mpm/boundary %slo stick\n"
                            "fix push all mpm/boundary %shi stick velocity 0.05 %s\n",
                            top, top, dim == 2 ? "-0.1 NULL" : "0 -0.1") +
                  "fix solve all mpm/implicit static tolerance 1e-12\ntimestep 1.0\nrun 1\n");
        const int normal = dim - 1;
        for (int i = 0; i < run.n(); i++) {
          EXPECT_NEAR(run.points().F[i][4 * normal], 0.9, 1e-9) << shape;
          EXPECT_NEAR(run.points().F[i][normal], 0.05, 1e-9) << shape;
        }
        EXPECT_NEAR(run.fix("push")->compute_vector(normal) / (dim == 2 ? 0.4 : 0.16),
                    -(mu * (0.9 - 1.0 / 0.9) + lambda * std::log(0.9) / 0.9), 1e-3)
            << shape;
      }
}

// the exact solution for large strains, with a stretch of up to 2.9 in the last case, where points of other shapes have come apart
SERIAL_TEST(Bar, HangsUnderItsWeight)
{
  for (const char *shape : SHAPES)
    for (const double g : {100.0, 500.0, 1500.0}) {
      double error[2];
      for (const int n : {10, 20}) {
        Scene run(hanging(n, shape, g, 4) + "run 4\n");
        const double exact = hangs(g, 0.25 / n);
        error[n / 20] = -run.compute_scalar("low") / exact - 1.0;
        measured(strprintf("g %g %s, %d cells: exact %g, error", g, shape, n, exact),
                 error[n / 20]);
      }
      EXPECT_LT(std::fabs(error[1]), 5e-4) << shape;
      EXPECT_GT(error[0] / error[1], 3.4) << shape;
    }
}

// a beam that bends by more than a third of its length, in the updated frame, in which points with other functions find no balance: as in the
// total frame; the wall bears the weight
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
    EXPECT_GE(run.fix("solve")->compute_vector(5), 30.0);
  }
}

// forces out of balance fall as their square, for a block that sinks and leans by a tenth of its height
SERIAL_TEST(Block, ConvergesQuadratically)
{
  for (const char *shape : SHAPES) {
    std::vector<double> r;
    for (const auto &line : lines_that_say(
             plane("si", "p f", "0 1.5 0 1.5", 1, 0.03) +
                 body("block 0.2 0.8 0 0.713 INF INF", "density 1000 neohookean 1e6 0.3",
                      std::string("0.1 ") + shape) +
                 "fix floor all mpm/boundary ylo stick\nfix g all gravity 200 vector 0.3 -1 0\n"
                 "fix solve all mpm/implicit static tolerance 1e-14 accuracy 1e-10 report yes\n"
                 "timestep 1.0\nrun 1\n",
             "  implicit step")) {
      std::istringstream words(line.substr(line.find("forces") + 6));
      for (double force; words >> force;) r.push_back(force);
    }
    std::size_t last = r.size() - 1;
    ASSERT_GT(last, 3u);
    while (last > 3 && r[last] < 1e-9 * r[0]) last--;    // round-off
    const double order = std::log(r[last] / r[last - 1]) / std::log(r[last - 1] / r[last - 2]);
    EXPECT_GE(measured(std::string(shape) + ": order", order), 1.8);
    EXPECT_LE(r.size(), 8u);
  }
}

// the elastica with P L^2/EI = 1, 3, in as many steps; forces on the last two columns of points, the mean of which is at the length 1
SERIAL_TEST(Cantilever, IsAnElastica)
{
  for (const int n : {4, 8}) {
    const double h = 0.05 / n;
    Scene run(plane("si", "f f", "0 1.2 -1.2 0.4", 1, 0.3 * h) +
              body(strprintf("block 0 %.17g 0 0.05 INF INF", 1.0 + 0.5 * h),
                   "density 1000 neohookean 1.2e8 0.3", strprintf("%.17g shape cpdi2", h)) +
              "fix clamp all mpm/boundary xlo stick\n" +
              strprintf("region tip block %.17g INF INF INF INF INF\ngroup tip region tip\n",
                        1.0 - 0.5 * h) +
              "variable n equal count(tip)\nvariable force equal "
              "-(step+1)*1.2e8/(1-0.09)*0.05^3/12\nvariable f equal v_force/v_n\n"
              "fix load tip addforce 0 v_f 0\n"
              "fix solve all mpm/implicit static solver multigrid\ncompute u all displace/atom\n"
              "compute w tip reduce ave c_u[2]\ncompute along tip reduce ave c_u[1]\n"
              "thermo_style custom step c_w c_along\ntimestep 1.0\n");
    for (const auto &[steps, w, u] : {std::array<double, 3>{1, 0.301721, 0.056433},
                                      std::array<double, 3>{2, 0.603254, 0.254422}}) {
      run.commands(strprintf("run %g\n", steps));
      const std::string name =
          strprintf("%d cells, step %d: ", n, (int) run.lmp->update->ntimestep);
      EXPECT_NEAR(measured(name + "w over exact", -run.compute_scalar("w") / w), 1.0,
                  n == 4 ? 0.0125 : 0.005);
      EXPECT_NEAR(measured(name + "u over exact", -run.compute_scalar("along") / u), 1.0,
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
  for (const char *shape : SHAPES)
    for (const char *options : {"", " axisymmetric yes", " 3d"}) {
      const bool space = std::string(options) == " 3d";
      std::vector<double> x[2];
      double iterations[2];
      for (const bool levels : {false, true}) {
        Scene run(box(space ? 3 : 2, "si", "f f f", "0 2.5 0 0.8 0 0.8", 1, 0.02) +
                  body("block 1.013 2.013 INF INF INF INF", "density 1000 neohookean 1e6 0.3",
                       std::string("0.1 ") + shape + (space ? "" : options)) +
                  "fix sides all mpm/boundary xlo slip\nfix floor all mpm/boundary ylo stick\n"
                  "fix g all gravity 20 vector 0.3 -1 0\n"
                  "fix solve all mpm/implicit static tolerance 1e-11 solver " +
                  (levels ? "multigrid" : "blocks") + "\ntimestep 1.0\nrun 1\n");
        for (int i = 0; i < run.n(); i++)
          x[levels].insert(x[levels].end(), run.x()[i], run.x()[i] + 3);
        iterations[levels] = run.fix("solve")->compute_vector(1);
      }
      double difference = 0.0;
      for (std::size_t k = 0; k < x[0].size(); k++)
        difference = std::max(difference, std::fabs(x[0][k] - x[1][k]));
      const auto name = std::string(shape) + options;
      EXPECT_LT(measured(name + ": difference", difference), 1e-8);
      EXPECT_GT(measured(name + ": times fewer iterations", iterations[0] / iterations[1]), 4.0);
    }
}

// the lowest vibration of a bar in the plane, by Newmark's method: the frequency of the method, and no damping
SERIAL_TEST(Vibration, HasTheNumbersOfTheMethod)
{
  const double L = 25.0, k = 0.5 * PI / L, omega = 10.0 * k, h = L / 32;
  for (const char *shape : SHAPES)
    for (const char *implicit : {"newmark", "euler", "alpha"}) {
      Scene run(plane("lj", "f p", strprintf("0 30 0 %.17g", 2 * h), 1, 0.3 * h) +
                body("block 0 25 INF INF INF INF", "density 1 linear 100 0",
                     strprintf("%.17g %s transfer flip 1.0", h, shape)) +
                "fix clamp all mpm/boundary xlo stick\nfix solve all mpm/implicit " + implicit +
                strprintf(" tolerance 1e-11\ntimestep %.17g\nrun 0\n", 0.5 / omega));
      run.set_reference();
      run.set_velocity([&](const double *x, double *v) {
        v[0] = 1e-5 * std::sin(k * x[0]);
      });
      std::vector<std::array<double, 2>> mode;
      const int skip = implicit[0] == 'a' ? 20 : 0, steps = 6;
      for (int n = 0; n <= skip + steps; n++) {
        double q = 0.0, p = 0.0;
        for (int i = 0; i < run.n(); i++) {
          const double X = run.reference(i)[0], s = std::sin(k * X);
          q += (run.x()[i][0] - X) * s;
          p += run.v()[i][0] * s / omega;
        }
        mode.push_back({q, p});
        run.commands("run 1\n");
      }
      double next[2][2] = {{0.0}}, last[2][2] = {{0.0}};
      for (int n = skip; n < skip + steps; n++)
        for (int i = 0; i < 2; i++)
          for (int j = 0; j < 2; j++) {
            next[i][j] += mode[n + 1][i] * mode[n][j];
            last[i][j] += mode[n][i] * mode[n][j];
          }
      const auto det = [](const double A[2][2]) {
        return A[0][0] * A[1][1] - A[0][1] * A[1][0];
      };
      const double trace = (next[0][0] * last[1][1] - next[0][1] * last[1][0] +
                            next[1][1] * last[0][0] - next[1][0] * last[0][1]) /
          det(last);
      const double factor = std::sqrt(det(next) / det(last)),
                   frequency = std::acos(0.5 * trace / factor) / 0.5;
      const auto name = std::string(shape) + " " + implicit;
      const bool euler = implicit[0] == 'e';
      EXPECT_NEAR(measured(name + ": frequency", frequency),
                  euler                    ? std::atan(0.5) / 0.5
                      : implicit[0] == 'a' ? 0.978834
                                           : 0.979915,
                  5e-3);
      EXPECT_NEAR(measured("factor of a step", factor), euler ? 0.894427 : 1.0, 5e-3);
    }
}

// a free body that turns in large steps keeps its momentum, and its ledger closes
SERIAL_TEST(Disk, KeepsItsMomentum)
{
  for (const char *shape : SHAPES)
    for (const char *implicit : {"newmark", "euler"}) {
      Scene run(plane("si", "f f", "-0.5 0.5 -0.5 0.5", 1, 0.01) +
                body("cylinder z 0.0037 0.0023 0.25 INF INF", "density 1000 neohookean 1e6 0.3",
                     strprintf("0.05 %s transfer flip 1.0", shape)) +
                strprintf("fix solve all mpm/implicit %s tolerance 1e-12\n", implicit) +
                "compute e all mpm/energy\nthermo_style custom step c_e\ntimestep 0.005\n");
      run.set_velocity([](const double *x, double *v) {
        v[0] = -10.0 * x[1] + 0.3;
        v[1] = 10.0 * x[0] - 0.2;
      });
      run.commands("run 0\n");
      const auto before = run.sums();
      run.commands("run 20\n");
      const auto after = run.sums();
      for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d] / before.p[d], 1.0, 1e-8);
      const auto name = std::string(shape) + " " + implicit;
      measured(name + ": angular momentum", after.L[2] / before.L[2]);
      const double *const e = run.compute_vector();
      EXPECT_LT(measured(name + ": residual", std::fabs(e[10]) / before.kinetic), 1e-7);
    }
}

TEST(Domains, RanksAndRestart)
{
  for (const char *shape : SHAPES)
    for (const std::string implicit : {"static", "euler solver multigrid"}) {
      const auto scene = replaced(beam(4, shape, 20.0, implicit + " tolerance 1e-11"),
                                  "timestep 1.0", "timestep 0.01");
      const auto next = "neighbor 0.0075 bin\n" + scene.substr(scene.find("fix grid"));
      Twins(scene, 2,
            replaced(replaced(next, "region body block 0 1 0 0.1 INF INF\n", ""),
                     "create_points 1 region body ppc 2\n", ""),
            2, 1e-9);
    }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_IMPLICIT_TESTING_H
#define MPM_IMPLICIT_TESTING_H

// Bodies for tests of fix mpm/implicit (ID solve), and checks of its tangents and residuals.

#include "mpm_lammps.h"

#include "field/mpm_plan.h"
#include "implicit/mpm_tangent.h"

namespace MPM_TEST {

/** A value of the vector of fix mpm/implicit. */
inline double solved(Scene &run, int k)
{
  return run.fix("solve")->compute_vector(k);
}
/** Iterations of the linear solver in each of Newton's method, in the last step. */
inline double linear_in_each(Scene &run)
{
  return measured("linear iterations in each", solved(run, 1) / solved(run, 0));
}

/** Sums of forces before each Newton iteration of a step, as the log has them. */
inline std::vector<std::vector<double>> residuals(const std::string &scene)
{
  std::vector<std::vector<double>> steps;
  for (const auto &line : lines_that_say(scene, "  implicit step")) {
    std::istringstream words(line.substr(line.find("forces") + 6));
    steps.emplace_back();
    for (double r; words >> r;) steps.back().push_back(r);
  }
  return steps;
}

/** Expects Newton's method to be of second order in the only step of a scene. most: iterations. */
inline void expect_quadratic(const std::string &name, const std::string &scene,
                             std::size_t most = 100)
{
  const auto steps = residuals(scene);
  ASSERT_EQ(steps.size(), 1u);
  const auto &r = steps[0];
  ASSERT_GT(r.size(), 4u);
  EXPECT_LE(r.size(), most);
  std::size_t last = r.size() - 1;
  while (last > 3 && r[last] < 1e-9 * r[0]) last--;
  const double order = std::log(r[last] / r[last - 1]) / std::log(r[last - 1] / r[last - 2]);
  EXPECT_GE(measured(name + ": order", order), 1.8);
}

/** Makes deformation gradients and corners of domains uneven, as they may be in this dimension. */
inline void distort(Scene &run, double size, bool axisymmetric)
{
  const bool space = run.dim() == 3;
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 9; c++)    // what plane strain has
      if (space || c == 0 || c == 1 || c == 3 || c == 4 || (axisymmetric && c == 8))
        run.points().F[i][c] += size * std::sin(1.3 * (9 * i + c));
  auto *const domains = MPMField::find(run.lmp, "grid")->domains.get();
  if (domains && domains->corners)
    for (int i = 0; i < run.n(); i++)
      for (int k = 0; k < domains->size(); k++)
        domains->corners[i][k] += 0.03 * std::sin(2.1 * k + i);
}

/** Expects the change of forces in a direction to be that of differences of forces, at
 *  displacements of this size, and the diagonal of each stride-th node (0: none) to be that of the
 *  same matrix. Returns the part that loads have in the largest change. */
inline double expect_tangent(Scene &run, const std::string &name, double size, double dt,
                             int stride)
{
  auto *const field = MPMField::find(run.lmp, "grid");
  field->plan->find_blocks_now();
  if (field->domains) field->domains->update();
  MPMTangent tangent(run.lmp, *field);
  tangent.init();
  const int dim = run.dim();
  const std::size_t n = field->grid.nnodes() * dim;
  std::vector<double> u(n), du(n), f(n), df(n), shifted, forces[2], loads[2];
  tangent.external_forces(f.data());
  for (std::size_t k = 0; k < n; k++) {
    u[k] = size * std::sin(1.7 * k);
    du[k] = std::sin(2.9 * k + 1.0);
  }
  field->nodes.complete(u.data(), dim, dim);
  const double eps = 1e-6;
  double carried, worst = 0.0, most = 0.0, of_loads = 0.0;
  EXPECT_TRUE(tangent.forces(u.data(), dt, f.data(), carried)) << name;
  tangent.linearize(u.data(), dt);
  tangent.change_of_forces(du.data(), df.data());
  for (const int side : {0, 1}) {
    shifted = u;
    for (std::size_t k = 0; k < n; k++) shifted[k] += (side ? eps : -eps) * du[k];
    forces[side].resize(n);
    loads[side].resize(n);
    EXPECT_TRUE(tangent.forces(shifted.data(), dt, forces[side].data(), carried)) << name;
    if (tangent.has_loads()) tangent.loads(shifted.data(), loads[side].data());
  }
  for (std::size_t k = 0; k < n; k++) {
    worst = std::max(worst, std::fabs((forces[1][k] - forces[0][k]) / (2.0 * eps) - df[k]));
    most = std::max(most, std::fabs(df[k]));
    of_loads = std::max(of_loads, std::fabs(loads[1][k] - loads[0][k]) / (2.0 * eps));
  }
  EXPECT_GT(most, 0.0);
  EXPECT_LT(measured(name, worst / most), 1e-6);

  std::vector<double> blocks;
  if (stride) tangent.diagonal(blocks);
  for (std::size_t node = 0; stride && node < n / dim; node += stride)
    for (int d = 0; d < dim; d++) {
      std::fill(du.begin(), du.end(), 0.0);
      du[dim * node + d] = 1.0;
      tangent.change_of_forces(du.data(), df.data());
      for (int e = 0; e < dim; e++)
        EXPECT_NEAR(-df[dim * node + e], blocks[dim * dim * node + dim * e + d], 1e-9 * most)
            << name;
    }
  return of_loads / most;
}

/** A block of 3 cells to a side of this material: options are those of fix mpm, or "3d". */
inline std::string block_of_3(const std::string &material, const std::string &options)
{
  const bool space = options.find("3d") != std::string::npos;
  return box(space ? 3 : 2, "si", "f f f", "0 6 0 6 0 6", 1, 0.3) +
      (options.find("axisymmetric") != std::string::npos ? "fix axis all mpm/boundary xlo slip\n"
                                                         : "") +
      body(space ? "block 1 4 1 4 1 4" : "block 1 4 1 4 INF INF", "density 1000 " + material,
           "1.0 " + replaced(options, "3d", "")) +
      "timestep 1e-3\nrun 0\n";
}

/** Shear modulus, Lame's constant, and nominal stress in uniaxial strain of neohookean 1e6 0.3. */
constexpr double MU = 1e6 / 2.6, LAMBDA = 1e6 * 0.3 / 1.3 / 0.4;
inline double nominal_stress(double F)
{
  return MU * (F - 1.0 / F) + LAMBDA * std::log(F) / F;
}

/** Expects rubber between two walls, of which the upper one shears and compresses it, to have a
 *  uniform strain, and the wall to bear the force of the law. */
inline void expect_uniform_strain(int dim, const std::string &options)
{
  const int normal = dim - 1;
  const char *const up = dim == 2 ? "y" : "z";
  Scene run(box(dim, "si", dim == 2 ? "p f p" : "p p f",
                dim == 2 ? "0 0.4 0 1 0 0" : "0 0.4 0 0.4 0 1", 1, 0.03) +
            body("box", "density 1000 neohookean 1e6 0.3", "0.1 " + options) +
            strprintf("fix floor all mpm/boundary %slo stick\n"
                      "fix push all mpm/boundary %shi stick velocity 0.05 %s\n",
                      up, up, dim == 2 ? "-0.1 NULL" : "0 -0.1") +
            "fix solve all mpm/implicit static tolerance 1e-12\ntimestep 1.0\nrun 1\n");
  for (int i = 0; i < run.n(); i++) {
    EXPECT_NEAR(run.points().F[i][4 * normal], 0.9, 1e-9) << options;
    EXPECT_NEAR(run.points().F[i][normal], 0.05, 1e-9) << options;
  }
  // on the wall, -P n with P_xy = mu F_xy
  const double area = dim == 2 ? 0.4 : 0.16;
  EXPECT_NEAR(run.fix("push")->compute_vector(normal) / area, -nominal_stress(0.9), 1e-3)
      << options;
  EXPECT_NEAR(run.fix("push")->compute_vector(0) / area, -MU * 0.05, 1e-3) << options;
}

/** A bar of length 1 of that rubber, n cells, hangs between rollers; weight g in equal steps. */
inline std::string hanging(int n, const std::string &options, double density, double g, int steps)
{
  const double h = 1.0 / n;
  return plane("si", "f f", strprintf("0 %.17g -3.2 1", 2 * h), 1, 0.3 * h) +
      body("block INF INF 0 1 INF INF", strprintf("density %g neohookean 1e6 0.3", density),
           strprintf("%.17g ", h) + options) +
      "fix top all mpm/boundary yhi stick\nfix sides all mpm/boundary xlo xhi slip\n" +
      strprintf("variable g equal %.17g*(step+1)/%d\n", g, steps) +
      "fix g all gravity v_g vector 0 -1 0\ncompute u all displace/atom\n"
      "compute low all reduce min c_u[2]\nfix solve all mpm/implicit static\ntimestep 1.0\n"
      "thermo_style custom step c_low\n";
}

/** A beam of length 1 and depth 0.1, clamped at x = 0, n cells deep, under its weight.
 *  implicit: what follows "fix mpm/implicit"; there is no such fix if it is empty. */
inline std::string beam(int n, const std::string &options, double g, const std::string &implicit,
                        const std::string &material = "neohookean 1e8 0.3")
{
  const double h = 0.1 / n;
  return plane("si", "f f", "0 1.2 -1.1 0.4", 1, 0.3 * h) +
      body("block 0 1 0 0.1 INF INF", "density 1000 " + material,
           strprintf("%.17g ", h) + options) +
      "fix clamp all mpm/boundary xlo stick\n" +
      strprintf("fix g all gravity %g vector 0 -1 0\n", g) +
      (implicit.empty() ? "" : "fix solve all mpm/implicit " + implicit + "\n") +
      "compute u all displace/atom\ncompute low all reduce min c_u[2]\ntimestep 1.0\n" +
      (implicit.empty() ? "" : "compute e all mpm/energy\nthermo_style custom step c_low c_e\n");
}

/** A cantilever of length 1 and depth 1/20, n cells, in plane strain, with a load at its end. */
inline std::string elastica(int n, const std::string &load,
                            const std::string &options = "frame total",
                            const std::string &ppc = "2")
{
  const double h = 0.05 / n;
  return plane("si", "f f", "0 1.2 -1.2 0.4", 1, 0.3 * h) +
      body(strprintf("block 0 %.17g 0 0.05 INF INF", 1.0 + 0.5 * h),
           "density 1000 neohookean 1.2e8 0.3", strprintf("%.17g ", h) + options, ppc) +
      "fix clamp all mpm/boundary xlo stick\n" +
      strprintf("region tip block %.17g INF INF INF INF INF\ngroup tip region tip\n",
                1.0 - 0.5 * h) +
      strprintf("variable n equal count(tip)\nvariable force equal "
                "-(step+1)*1.2e8/(1-0.09)*0.05^3/12\nvariable h equal %.17g\n",
                h) +
      load +
      "\nfix solve all mpm/implicit static solver multigrid\ncompute u all displace/atom\n"
      "compute w tip reduce ave c_u[2]\ncompute along tip reduce ave c_u[1]\n"
      "thermo_style custom step c_w c_along\ntimestep 1.0\n";
}
/** A dead load on its tip. */
const char *const DEAD_LOAD = "variable each equal v_force/v_n\nfix load tip addforce 0 v_each 0";

/** Expects the displacements of the tip to be those of theory to within the errors. */
inline void expect_tip(Scene &run, const std::string &name, double w, double u, double error_w,
                       double error_u)
{
  const std::string step = name + strprintf(", step %d: ", (int) run.lmp->update->ntimestep);
  EXPECT_NEAR(measured(step + "w over exact", -run.compute_scalar("w") / w), 1.0, error_w);
  EXPECT_NEAR(measured(step + "u over exact", -run.compute_scalar("along") / u), 1.0, error_u);
}

/** Cook's membrane on cells of size h, in steps of a traction on its end, whose sum is 100. */
inline std::string cooks_membrane(double h, const std::string &options, const std::string &material,
                                  int steps, const std::string &ppc = "2")
{
  return plane("si", "f f", "0 60 0 90", 1, 0.4 * h) + strprintf("fix grid all mpm %.17g ", h) +
      options +
      "\nregion lower plane 0 0 0 -44 48 0\nregion upper plane 0 44 0 16 -48 0\n"
      "region span block 0 48 0 60 INF INF\nregion plate intersect 3 span lower upper\n"
      "create_points 1 region plate ppc " +
      ppc + " outside ignore\nfix m all mpm/material density 1 " + material +
      "\nfix clamp all mpm/boundary xlo stick\nregion edge plane 48 0 0 -1 0 0\n" +
      strprintf("variable t equal 100/16*(step+1)/%d\n", steps) +
      "fix load all mpm/traction region edge traction 0 v_t 0 area 16\ntimestep 1.0\n";
}

/** A bar of length 25 that vibrates in its first mode, of frequency 0.1 pi/5 c with c = 10:
 *  benchmark A2. Displacement of the mode in each step, and velocity over the frequency. */
inline std::vector<std::array<double, 2>>
vibration(const std::string &options, const std::string &implicit, double omega_dt, int steps)
{
  const double L = 25.0, k = 0.5 * PI / L, omega = 10.0 * k, h = L / 32;
  Scene run(plane("lj", "f p", strprintf("0 30 0 %.17g", 2 * h), 1, 0.3 * h) +
            body("block 0 25 INF INF INF INF", "density 1 linear 100 0",
                 strprintf("%.17g ", h) + options) +
            "fix clamp all mpm/boundary xlo stick\nfix solve all mpm/implicit " + implicit +
            strprintf("\ntimestep %.17g\nrun 0\n", omega_dt / omega));
  run.set_reference();
  run.set_velocity([&](const double *x, double *v) {
    v[0] = 1e-5 * std::sin(k * x[0]);
  });
  std::vector<std::array<double, 2>> mode;
  for (int n = 0; n <= steps; n++) {
    if (n) run.commands("run 1\n");
    mode.push_back({0.0, 0.0});
    for (int i = 0; i < run.n(); i++) {
      const double X = run.reference(i)[0], s = std::sin(k * X);
      mode.back()[0] += (run.x()[i][0] - X) * s;
      mode.back()[1] += run.v()[i][0] * s / omega;
    }
  }
  return mode;
}

/** Expects frequency (over that of the mode) and factor of a step of that vibration, by the matrix
 *  of a step and its pair of roots. */
inline void expect_vibration(const std::string &options, const std::string &implicit,
                             double omega_dt, double frequency, double factor)
{
  // methods that remember an acceleration have a third root, which goes first
  const int skip = implicit[0] == 'a' || implicit[0] == 'h' ? 20 : 0, steps = 6;
  const auto mode = vibration(options, implicit + " tolerance 1e-11", omega_dt, skip + steps);
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
      det(last),
               found = std::sqrt(det(next) / det(last));
  EXPECT_NEAR(measured(implicit + " " + options + ": frequency over that of the method",
                       std::acos(0.5 * trace / found) / omega_dt / frequency),
              1.0, 5e-3);
  EXPECT_NEAR(measured("factor of a step", found / factor), 1.0, 5e-3);
}

/** A free disk of rubber that turns, and flies, in steps of dt. */
inline void spin(Scene &run, const std::string &options, const std::string &implicit, double dt)
{
  run.commands(
      plane("si", "f f", "-0.5 0.5 -0.5 0.5", 1, 0.01) +
      body("cylinder z 0.0037 0.0023 0.25 INF INF", "density 1000 neohookean 1e6 0.3",
           "0.05 " + options) +
      "fix solve all mpm/implicit " + implicit +
      strprintf("\ncompute e all mpm/energy\nthermo_style custom step c_e\ntimestep %g\n", dt));
  run.set_velocity([](const double *x, double *v) {
    v[0] = -10.0 * x[1] + 0.3;
    v[1] = 10.0 * x[0] - 0.2;
  });
  run.commands("run 0\n");
}

/** Positions of all points of this rank, in their order; the largest difference of such. */
inline std::vector<double> places(Scene &run)
{
  std::vector<double> x;
  for (int i = 0; i < run.n(); i++) x.insert(x.end(), run.x()[i], run.x()[i] + 3);
  return x;
}
inline double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  if (a.size() != b.size() || a.empty()) return 1e300;
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); k++) most = std::max(most, std::fabs(a[k] - b[k]));
  return most;
}

/** Expects levels of cells to change the way of the linear solver, not where it comes to. scene:
 *  but for solver and run; fewer: least iterations with blocks over those with levels. */
inline void expect_same_with_levels(const std::string &name, const std::string &scene,
                                    const std::string &method, double fewer)
{
  std::vector<double> x[2];
  double iterations[2];
  for (const bool levels : {false, true}) {
    Scene run(scene + "fix solve all mpm/implicit " + method + " tolerance 1e-11 solver " +
              (levels ? "multigrid" : "blocks") +
              strprintf("\ntimestep %g\nrun 1\n", method == "static" ? 1.0 : 0.1));
    x[levels] = places(run);
    iterations[levels] = solved(run, 1);
  }
  measured(name + " " + method + ": iterations with blocks", iterations[0]);
  EXPECT_LT(largest_difference(x[0], x[1]), 1e-8) << name;
  EXPECT_GE(iterations[0], fewer * measured("with levels", iterations[1])) << name;
}

}    // namespace MPM_TEST
#endif

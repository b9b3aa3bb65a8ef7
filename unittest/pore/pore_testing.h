// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_PORE_TESTING_H
#define MPM_PORE_TESTING_H

// Columns and blocks of soil with pore water, for tests of fix mpm/pore.

#include "pore/pore_bodies_testing.h"

namespace MPM_TEST {

/** Pressures of the pore water at the points, from a compute mpm/atom. */
struct Water {
  Scene &run;
  explicit Water(Scene &run) : run(run) { run.commands("compute pore all mpm/atom pore\n"); }

  const double *pressures()
  {
    auto *compute = run.per_atom("pore");
    return compute->vector_atom;
  }
  /** Mean pressure of the points of this rank in a range of y. */
  double mean(double low, double high)
  {
    const double *const p = pressures();
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][1] > low && run.x()[i][1] < high) {
        sum += p[i];
        n++;
      }
    return sum / n;
  }
  /** Mass of all points. */
  double mass()
  {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += run.mass()[i];
    return over_ranks(sum);
  }
};

// load per area; constrained modulus of SOIL, which has E = 1e7 and nu = 0.3
constexpr double LOAD = 1.0e4, PI2 = 0.5 * PI, MODULUS = 1e7 * 0.7 / (1.3 * 0.4);

/** Input of a column of soil from y = 0 to y = 1, with n cells, on a smooth floor. It is four cells
 *  wide and periodic along x. water, material: arguments of fix mpm/pore and fix mpm/material; top:
 *  upper face of the box; offset: of the floor from nodes, in cells; floor: walls. */
inline std::string column(int n, const std::string &water, const std::string &material,
                          double top = 1.2, double offset = 0.0, const std::string &floor = "ylo")
{
  const double h = 1.0 / n;
  return plane("si", "p f", strprintf("0 %.17g 0 %.17g", 4 * h, top), 1, 0.3 * h) +
      strprintf("region soil block 0 %.17g 0 1 INF INF\n", 4 * h) +
      strprintf("create_points 1 region soil spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin 0 %.17g\n", h, offset * h) +
      "fix m all mpm/material " + material + "\nfix floor all mpm/boundary " + floor + " slip\n" +
      "fix water all mpm/pore " + water + "\n";
}
constexpr const char *SOIL = "density 2002 linear 1e7 0.3";

/** Input of a load q per area on the topmost row of points of column(n). It grows for ramp. */
inline std::string load(int n, double q, double ramp)
{
  const double h = 1.0 / n;
  return strprintf("region top block INF INF %.17g INF INF INF\ngroup top region top\n",
                   1.0 - 0.5 * h) +
      strprintf("variable q equal %.17g*0.5*(1-cos(PI*((time<%g)*time/%g+(time>=%g))))\n", q, ramp,
                ramp, ramp) +
      "variable fy equal -v_q*lx/count(top)\nfix load top addforce 0 v_fy 0\n";
}
/** Terzaghi's pressure at depth z below the drained top of a column of height 1, over the first. */
inline double terzaghi(double z, double T)
{
  double sum = 0.0;
  for (int m = 0; m < 2000; m++) {
    const double M = (2 * m + 1) * PI2;
    sum += 2.0 / M * std::sin(M * z) * std::exp(-M * M * T);
  }
  return sum;
}

/** Rms difference of pressures from Terzaghi's at the time factor T. p0: first pressure. Top: 1. */
inline double difference_from_terzaghi(Scene &run, Water &water, double p0, double T, int axis = 1)
{
  const double *const p = water.pressures();
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double d = p[i] - p0 * terzaghi(1.0 - run.x()[i][axis], T);
    sum += d * d / run.n();
  }
  return std::sqrt(sum);
}

/** Rms difference of pressures over the load from Terzaghi's at T = 0.2 in a column of this width
 *  along z, whose surface is within a cell. Kf, more: modulus and options of the water. */
inline double terzaghi_in_space(const char *shape, double width, double Kf, const std::string &more)
{
  const double c = 1e-3 / 9810.0 / (1.0 / MODULUS + 0.4 / Kf);
  Scene run(
      space("si", "p p f", strprintf("0 %g 0 %g 0 1.25", width, width), 1, 0.03) +
      strprintf("region soil block 0 %g 0 %g 0 1\ncreate_points 1 region soil spacing 0.05\n"
                "fix grid all mpm 0.1 shape %s origin 0 0 0.03\n",
                width, width, shape) +
      "fix m all mpm/material density 2002 linear 1e7 0.3\n"
      "fix floor all mpm/boundary zlo slip\n" +
      strprintf("fix water all mpm/pore %g 1000 9810 soil m 0.4 constant 1e-3 free pressure 0 ",
                Kf) +
      more +
      "\nregion top block INF INF INF INF 0.95 INF\ngroup top region top\n"
      "variable ramp equal (time<0.01)*time/0.01+(time>=0.01)\n"
      "variable load equal -1e4*0.5*(1-cos(PI*v_ramp))*lx*ly/count(top)\n"
      "fix load top addforce 0 0 v_load\n");
  Water water(run);
  run_until(run, 0.2 / c + 0.005);
  return measured(strprintf("%s, rms", shape),
                  difference_from_terzaghi(run, water, LOAD / (1.0 + MODULUS * 0.4 / Kf), 0.2, 2) /
                      LOAD);
}

/** Scatter of the pressure in a column of 20 cells, as a part of the load: the standard deviation
 *  from Terzaghi's solution below the uppermost three cells after 60 ms. The load grows in 30 ms,
 *  too short for flow. Kf, k: bulk modulus and conductivity; options: of mpm/pore. */
inline double scatter_of_pressure(double Kf, double k, const std::string &options)
{
  const int n = 20;
  Scene run(
      column(n, strprintf("%g 1000 9810 soil m 0.4 constant %g free pressure 0 ", Kf, k) + options,
             SOIL) +
      load(n, LOAD, 0.03));
  Water water(run);
  run_until(run, 0.06);
  const double c = k / 9810.0 / (1.0 / MODULUS + 0.4 / Kf), p0 = LOAD / (1 + MODULUS * 0.4 / Kf);
  const double *const p = water.pressures();
  double sum = 0.0, square = 0.0, count = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double z = 1.0 - run.x()[i][1];
    if (z < 3.0 / n) continue;
    const double d = p[i] - p0 * terzaghi(z, 0.045 * c);
    sum += d;
    square += d * d;
    count++;
  }
  const double mean = sum / count;
  return measured(strprintf("Kf %g, k %g, scatter", Kf, k),
                  std::sqrt(square / count - mean * mean) / LOAD);
}

/** Expects that the mass of the points of a column changes by the water that comes through its
 *  surface, whose volume the fix counts. least: bound of its size; 0: not checked. */
inline void expect_water_is_kept(const std::string &scene, int steps, double least)
{
  Scene run(scene + load(10, LOAD, 0.01));
  Water water(run);
  const double before = water.mass();
  run.commands(strprintf("timestep 1e-5\nrun %d\n", steps));
  const double came = run.fix("water")->compute_scalar();
  if (least > 0.0) EXPECT_GT(std::fabs(came), least);
  EXPECT_NEAR((water.mass() - before - 1000.0 * came) / before, 0.0, 1e-13);
}
/** Expects this for a closed column, for one that is drained at a free surface, and for one with
 *  inflow and outflow. permeability, options: words of fix mpm/pore. */
inline void expect_water_is_kept_by(const std::string &permeability, const std::string &options)
{
  for (const char *drained : {"", "free pressure 0", "yhi pressure 100 free flux 1e-3"})
    expect_water_is_kept(
        column(10, "2.2e9 1000 9810 soil m 0.4 " + permeability + " " + options + drained, SOIL,
               drained[0] == 'y' ? 1.0 : 1.2, 0.2),
        2000, drained[0] ? 1e-7 : 0.0);
}

/** Expects the flux through seeping_column() and the mean effective stress to agree with the
 *  gradient i of the water from below and with the conductivity k. */
inline void expect_seepage(Scene &run, double i, double k)
{
  run_until(run, 1.0);
  const double *const flows = run.fix_vector("water", 7);
  EXPECT_NEAR(measured(strprintf("gradient %g, flux", i), flows[2] / (0.4 * k * i)), 1.0, 0.002);
  EXPECT_NEAR(flows[6] / flows[2], -1.0, 1e-4);
  double sum = 0.0, n = 0.0;
  for (int p = 0; p < run.n(); p++) {
    const double y = run.x()[p][1];
    if (y < 0.2 || y > 0.8) continue;
    const auto sigma = run.cauchy(p);
    sum -= sigma[1] / ((990.0 - 1000.0 * i) * 9.81 * (1.0 - y));
    n++;
  }
  EXPECT_NEAR(measured("effective stress", sum / n), 1.0, 0.006);
}
/** Input of a column of 10 cells under its weight. The pressure at the bottom grows in 0.1 s to the
 *  value of the hydraulic gradient i. k: conductivity; options: of fix mpm/pore. */
inline std::string seeping_column(double i, double k, const std::string &options)
{
  const auto water = strprintf("2.2e8 1000 9810 soil m 0.4 constant %g ylo pressure v_bottom "
                               "free pressure 0 initial v_p ",
                               k) +
      options;
  return replaced(
      replaced(column(10, water, "density 1990 linear 1e7 0.3"), "fix water",
               "fix g all gravity 9.81 vector 0 -1 0\nvariable p atom 9810*(1-y)\n" +
                   strprintf(
                       "variable bottom equal 9810*(1+%g*((time<0.1)*time/0.1+(time>=0.1)))\n", i) +
                   "fix water"),
      "origin", "gain error 0.02 origin");
}

/** Rms error of the pressures as a part of the load, and degree of consolidation U. */
struct Consolidation {
  double rms, U;
};
/** Consolidation of a column of n cells under the load q, at the time factor 0.2. Kf: bulk modulus
 *  of the water; density: of the soil, twice the density of the water; others: as for column(). */
inline Consolidation consolidate(int n, const std::string &options, double top, double offset,
                                 double Kf, double q = LOAD, double density = 2002.0)
{
  const double storage = 0.4 / Kf, c = 1e-3 / 9810.0 / (1.0 / MODULUS + storage), ramp = 0.01;
  Scene run(column(n,
                   strprintf("%g %g 9810 soil m 0.4 constant 1e-3 %s", Kf, 0.5 * density,
                             options.c_str()),
                   strprintf("density %g linear 1e7 0.3", density), top, offset) +
            load(n, q, ramp));
  Water water(run);
  const double T = 0.2, p0 = q / (1.0 + MODULUS * storage);
  run_until(run, T / c + 0.5 * ramp);
  const double rms = difference_from_terzaghi(run, water, p0, T);
  double all = 0.0;
  for (int i = 0; i < run.n(); i++) all += water.pressures()[i] / run.n();
  return {rms / q, 1.0 - all / p0};
}

/** Variables of blocks(). */
constexpr const char *OF_BLOCKS = "variable p atom 0.1*x\nvariable k atom 0.01*(1+y)\n";
/** Input of bodies of two soils and a dry one, which collide. more: words of fix mpm/pore. */
inline std::string blocks(const std::string &more)
{
  return colliding(
      OF_BLOCKS, "20.0 0.5 2.0 soil m 0.4 kozeny 0.1 soil n 0.3 formula v_k biot 0.9 200 " + more);
}

}    // namespace MPM_TEST

#endif

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_PORE_TESTING_H
#define MPM_PORE_TESTING_H

// Columns and blocks of soil with pore water, for tests of fix mpm/pore.

#include "mpm_lammps.h"

#include "compute_mpm_atom.h"

namespace MPM_TEST {

/** Pressures of points, by a compute mpm/atom. */
struct Water {
  Scene &run;
  explicit Water(Scene &run) : run(run) { run.commands("compute pore all mpm/atom pore\n"); }

  const double *pressures()
  {
    auto *compute = run.lmp->modify->get_compute_by_id("pore");
    compute->compute_peratom();
    return compute->vector_atom;
  }
  /** Mean over the points in a range of y. */
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
  double mass()
  {
    double sum = 0.0;
    for (int i = 0; i < run.n(); i++) sum += run.mass()[i];
    return over_ranks(sum);
  }
};

constexpr double LOAD = 1.0e4, PI2 = 0.5 * PI, MODULUS = 1e7 * 0.7 / (1.3 * 0.4);

/** A column of 1 m with the top at y = 1, four cells wide, on a smooth floor, with n cells. offset: of the floor from
 *  nodes, in cells. */
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

/** The row of points at the top carries q, which grows over a time. */
inline std::string load(int n, double q, double ramp)
{
  const double h = 1.0 / n;
  return strprintf("region top block INF INF %.17g INF INF INF\ngroup top region top\n",
                   1.0 - 0.5 * h) +
      strprintf("variable q equal %.17g*0.5*(1-cos(PI*((time<%g)*time/%g+(time>=%g))))\n", q, ramp,
                ramp, ramp) +
      "variable fy equal -v_q*lx/count(top)\nfix load top addforce 0 v_fy 0\n";
}
inline void run_to(Scene &run, double end)
{
  run.commands(strprintf("fix dt all mpm/dt 0.5 until %.17g\nrun 1000000\n", end));
}

/** Terzaghi: pressure over the initial one at a depth z below the drained top of a column of 1. */
inline double terzaghi(double z, double T)
{
  double sum = 0.0;
  for (int m = 0; m < 2000; m++) {
    const double M = (2 * m + 1) * PI2;
    sum += 2.0 / M * std::sin(M * z) * std::exp(-M * M * T);
  }
  return sum;
}

/** Consolidation by the load: rms error of the pressures in parts of the load at a time factor, and the degree of
 *  consolidation. density: of the soil, with half of it that of the water. */
struct Consolidation {
  double rms, U;
};
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
  run_to(run, T / c + 0.5 * ramp);
  const double *const p = water.pressures();
  double sum = 0.0, all = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double d = p[i] - p0 * terzaghi(1.0 - run.x()[i][1], T);
    sum += d * d / run.n();
    all += p[i] / run.n();
  }
  return {std::sqrt(sum) / q, 1.0 - all / p0};
}

/** A block of two soils and one that is dry, which collide across ranks and periodic faces. */
inline std::string blocks(const std::string &more)
{
  return plane("lj", "p p", "0 8 0 8", 3, 0.4) + "fix grid all mpm 0.5\n" +
      bodies({{"one", "sphere 3 4 0 1.6 side in"},
              {"two", "block 5 6.6 3 5 -0.5 0.5"},
              {"dry", "block 3 5 0.8 2 -0.5 0.5"}}) +
      "fix m one mpm/material density 1.0 eos linear 20.0 strength j2 8.0 0.4\n"
      "fix n two mpm/material density 2.0 eos linear 30.0 strength j2 8.0 0.4\n"
      "fix o dry mpm/material density 1.0 neohookean 10.0 0.3\n"
      "velocity all set 0.8 0.5 0\nvelocity two set -0.7 0.5 0\n"
      "variable p atom 0.1*x\nvariable k atom 0.01*(1+y)\n"
      "fix water all mpm/pore 20.0 0.5 2.0 soil m 0.4 kozeny 0.1 soil n 0.3 formula v_k biot 0.9 "
      "200 " +
      more + "\ntimestep 0.005\n";
}
struct Named {
  double tag, p;
};
inline std::vector<Named> pressures(Scene &run)
{
  const double *const p = [&]() {
    auto *compute = run.lmp->modify->get_compute_by_id("pore");
    compute->compute_peratom();
    return compute->vector_atom;
  }();
  std::vector<Named> mine;
  for (int i = 0; i < run.n(); i++) mine.push_back({(double) run.lmp->atom->tag[i], p[i]});
  return all_by_tag(mine, run.lmp->world);
}
constexpr const char *PORE = "compute pore all mpm/atom pore\n";

}    // namespace MPM_TEST

#endif

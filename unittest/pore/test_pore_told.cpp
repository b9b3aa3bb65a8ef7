// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics input
// timeout: 300

// Fix mpm/pore: what it tells of input that is likely to be wrong, and what it must not.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

/** A column at 1 kPa, which the load bears, and 300 Pa outside. options: of fix mpm; more: pore. */
std::string jump(const std::string &options, const std::string &more)
{
  return replaced(column(10,
                         "2.2e9 1000 9810 soil m 0.4 constant 1e-3 initial 1e3 free pressure 300 " +
                             more,
                         SOIL, 1.2, 0.3),
                  "origin", options + " origin") +
      "region top block INF INF 0.95 INF INF INF\ngroup top region top\n"
      "variable fy equal -1e3*lx/count(top)\nfix load top addforce 0 v_fy 0\n";
}

// Water leaves with the pressure outside, however far that at the surface is from it: what is left
// of its energy is dissipated. Where the pressure jumps at the surface both are far apart for a
// while with u-v-p, and the watch of energies called that numerical errors
SERIAL_TEST(Energy, OfWaterThatLeaves)
{
  for (const std::string formulation : {"formulation u-p", "formulation u-v-p"}) {
    const std::string scene = jump("", formulation) + "fix dt all mpm/dt 0.5\n";
    EXPECT_EQ(times_said(scene + "run 1000\n", "Numerical errors"), 0) << formulation;
    Scene run(scene + "compute e all mpm/energy\nvariable came equal c_e[16]\nrun 300\n");
    const double volume = run.fix("water")->compute_scalar();
    EXPECT_LT(volume, 0.0);
    EXPECT_NEAR(measured(formulation + ": energy over that of the pressure outside",
                         run.variable("came") / (300.0 * volume)),
                1.0, 1e-12);
  }
}

// With every K points take the same steps. The surface was looked for before there were mean forces
SERIAL_TEST(Every, IsTheSame)
{
  double mean[2], out[2];
  for (const bool every : {false, true}) {
    Scene run(jump(every ? "every 4" : "", "") + (every ? "timestep 1e-5\n" : "timestep 4e-5\n"));
    Water water(run);
    run.commands(every ? "run 2000\n" : "run 500\n");
    mean[every] = water.mean(0.0, 1.0);
    out[every] = run.fix("water")->compute_scalar();
  }
  EXPECT_LT(out[0], 0.0);
  EXPECT_NEAR(measured("pressure with every 4 over that without", mean[1] / mean[0]), 1.0, 1e-12);
  EXPECT_NEAR(measured("water that left", out[1] / out[0]), 1.0, 1e-12);
}

// a material without points, or a density that grains cannot have: ground dry, or too light
SERIAL_TEST(Soils, WithoutPointsOrTooLightAreTold)
{
  const auto told = [](const char *soil, const char *density, const char *weight,
                       const char *what) {
    return times_said(plane("si", "p f", "0 0.2 0 1.2", 1, 0.03) +
                          "region soil block INF INF 0 1 INF INF\n"
                          "create_points 1 region soil spacing 0.05\nfix grid all mpm 0.1\n"
                          "group none empty\nfix m all mpm/material density " +
                          density +
                          " linear 1e7 0.3\nfix dry none mpm/material density 2000 linear 1e7 0.3\n"
                          "fix floor all mpm/boundary ylo slip\n" +
                          weight +
                          "fix water all mpm/pore 2.2e8 1000 9810 soil m 0.4 constant 1e-4 " +
                          soil + "\ntimestep 1e-6\nrun 1\n",
                      what);
  };
  const char *const gravity = "fix g all gravity 9.81 vector 0 -1 0\n";
  EXPECT_EQ(told("", "2000", gravity, "WARNING: Fix mpm/pore"), 0);
  EXPECT_EQ(told("soil dry 0.4 constant 1e-4", "2000", gravity, "has no points of soil dry"), 1);
  EXPECT_EQ(told("", "400", gravity, "grains have a weight below zero"), 1);
  EXPECT_EQ(told("", "401", gravity, "WARNING: Fix mpm/pore"), 0);
  EXPECT_EQ(told("", "399", "", "grains would have a mass below zero"), 1);
}

// grains that are softer than the soil that they make, which is the same as a coefficient of Biot
// below the porosity, and a coefficient that is not that of both moduli
SERIAL_TEST(Grains, ThatDoNotGoWithTheirSoil)
{
  // bulk modulus 1e10, porosity 0.2
  const auto rock = [](const char *biot, const char *law) {
    return plane("si", "p f", "0 4 0 4", 1, 0.3) +
        "create_points 1 box spacing 0.5\nfix grid all mpm 1.0\n" +
        strprintf("fix m all mpm/material density 2300 %s\n", law) +
        strprintf("fix water all mpm/pore 2.2e9 1000 9810 soil m 0.2 constant 1e-7 %s\n", biot) +
        "timestep 1e-6\nrun 1\n";
  };
  for (const char *law : {"linear 1.8e10 0.2", "neohookean 1.8e10 0.2",
                          "linear 1.8e10 0.2 viscosity newtonian 1e6"}) {
    for (const char *soft : {"biot 0.9 1.24e10", "biot 1 1e9"})
      expect_error(rock(soft, law), "grains with the bulk modulus");
    const auto told = [&](const char *biot) {
      return times_said(rock(biot, law), "WARNING: Fix mpm/pore");
    };
    EXPECT_EQ(told("biot 0.7 3.333e10"), 0);
    EXPECT_EQ(told("biot 0.75 3.333e10"), 0);
    EXPECT_EQ(told("biot 0.21 1.25e10"), 0);
    EXPECT_EQ(told("biot 1 3.333e10"), 1);
    EXPECT_EQ(told("biot 0.5 1e12"), 1);
    EXPECT_EQ(told(""), 0);
  }
}

// what relax, and every, take from smooth pressures while the flow takes next to nothing, in soil
// as stiff as its water; not so where water flows, or with little relax, or before it counts
SERIAL_TEST(Relax, ThatSmoothsIsTold)
{
  const auto told = [](const char *k, const char *more, int steps) {
    return times_said(
        column(10, strprintf("5.4e6 1000 9810 soil m 0.4 %s free pressure 0 %s", k, more), SOIL) +
            strprintf("timestep 4e-4\nrun %d\n", steps),
        "become too even in a long run");
  };
  EXPECT_EQ(told("constant 1e-5", "", 2000), 1);
  EXPECT_EQ(told("kozeny 1e-5", "", 2000), 1);
  EXPECT_EQ(told("constant 1e-5", "formulation u-v-p", 2000), 1);
  EXPECT_EQ(told("constant 1e-5", "every auto", 2000), 1);
  EXPECT_EQ(told("constant 1e-5", "", 500), 0);
  EXPECT_EQ(told("constant 1e-5", "relax 0.02", 2000), 0);
  EXPECT_EQ(told("constant 1e-3", "", 2000), 0);
  EXPECT_EQ(told("constant 1e-3", "every auto", 2000), 0);
}

// u-p leaves out the acceleration of the water: fast waves, and gravel under a load that comes at
// once, need u-v-p. Slow flow after such a load does not, nor waves that water in fine soil goes
// with, nor ground at rest
SERIAL_TEST(Inertia, ThatCountsIsTold)
{
  const auto told = [](const std::string &scene, const char *more) {
    return times_said(scene + more, "leaves out the acceleration of the water");
  };
  const auto water = [](const char *k, const char *more) {
    return strprintf("2.2e8 1000 9810 soil m 0.4 constant %s %s", k, more);
  };
  const auto wave = [&](const char *k, const char *more) {
    return told(column(10, water(k, more), SOIL, 1.0, 0.0, "ylo yhi"),
                "variable v atom 1e-4*sin(PI*y)\nvelocity all set NULL v_v NULL\n"
                "fix dt all mpm/dt 0.5\nrun 200\n");
  };
  EXPECT_EQ(wave("1e-3", ""), 1);
  EXPECT_EQ(wave("3e-2", ""), 1);    // which u-p, and not the soil, damps at once
  EXPECT_EQ(wave("1e-3", "every auto"), 1);
  EXPECT_EQ(wave("1e-3", "formulation u-v-p"), 0);
  EXPECT_EQ(wave("1e-5", ""), 0);
  EXPECT_EQ(wave("1e-5", "every auto"), 0);
  // loaded at once, up to a time factor of 0.2
  const auto loaded = [&](const char *k, const char *more, int steps) {
    return told(column(10, water(k, "free pressure 0 ") + more, SOIL) + load(10, LOAD, 1e-9),
                strprintf("fix dt all mpm/dt 0.5\nrun %d\n", steps).c_str());
  };
  EXPECT_EQ(loaded("1e-2", "", 160), 1);
  EXPECT_EQ(loaded("1e-2", "formulation u-v-p", 160), 0);
  EXPECT_EQ(loaded("1e-3", "", 1600), 0);
  EXPECT_EQ(loaded("1e-3", "", 10), 0);
  EXPECT_EQ(told(column(10, water("1e-3", "free pressure 0"), SOIL) + load(10, LOAD, 1e-9),
                 "fix rest all mpm/relax 1e-4\nfix dt all mpm/dt 0.5\nrun 1000\n"),
            0);
  EXPECT_EQ(loaded("1e-3", "every auto", 1600), 0);
  EXPECT_EQ(told(column(10, water("1e-2", "free pressure 0 geostatic 0.5 1"), SOIL),
                 "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5\nrun 500\n"),
            0);
}

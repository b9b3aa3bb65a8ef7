/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// labels: physics extreme
// timeout: 300

// Stability at the extremes: a fast subset of bench/extremes, on one rank. Each number is also in the
// tables of Howto_mpm_stability.rst.

#include "mpm_lammps.h"

#include "gtest/gtest.h"

#include <cmath>

using namespace MPM_TEST;

/* ----------------------------------------------------------------------
   nodes with next to no mass: a slab with the pressure p = 0.01 K is let go; acoustics gives points
   the speed p/(rho c) at its faces. They are anywhere in their cell, one layer of points at the
   distance shift - 1/4 from the face of a cell.
------------------------------------------------------------------------- */

static double release(const std::string &options, double shift)
{
  Scene run;
  const std::string error =
      run.error(strprintf("units lj\ndimension 2\nboundary f p p\natom_style mpm\nneighbor 0.5 bin\n"
                          "region box block 0 16 0 2 -0.5 0.5\ncreate_box 1 box\n"
                          "fix grid all mpm 1.0 %s\nregion body block 3 13 0 2 -0.5 0.5\n"
                          "create_points 1 region body ppc 2\n"
                          "displace_atoms all move %.17g 0 0\n"
                          "fix m all mpm/material density 1.0 eos stiffened/gas 2.0 0.49 "
                          "pressure 0.01\ntimestep 0.2\nrun 0\n",
                          options.c_str(), shift));
  EXPECT_EQ(error, "");
  const double momentum = run.sums().p[0];
  double fastest = 0.0;
  for (int k = 0; k < 40; k++) {
    if (!run.error("run 1 post no\n").empty()) return INFINITY;
    for (int i = 0; i < run.n(); i++) fastest = std::max(fastest, std::abs(run.v()[i][0]) / 0.01);
  }
  EXPECT_NEAR(run.sums().p[0], momentum, 1.0e-12) << options;
  return fastest;
}

class LightNodes : public ::testing::TestWithParam<const char *> {};

TEST_P(LightNodes, DoNotKickPoints)
{
  double worst = 0.0;
  for (double shift : {0.0, 0.1, 0.2, 0.25, 0.25 + 1e-3, 0.25 + 1e-6, 0.25 + 1e-9, 0.25 + 1e-12, 0.4,
                       0.6, 0.75 + 1e-3, 0.75 + 1e-6, 0.75 + 1e-9, 0.9})
    worst = std::max(worst, release(GetParam(), shift));
  EXPECT_LT(measured(std::string(GetParam()) + ": largest speed of a point in p/(rho c)", worst), 2.0);
}

INSTANTIATE_TEST_SUITE_P(
    Options, LightNodes,
    ::testing::Values("transfer apic", "transfer flip 1.0", "transfer flip 1.0 scheme musl",
                      "shape cubic transfer apic", "shape cpgimp transfer apic",
                      "shape linear transfer flip 1.0 scheme musl",
                      "shape linear transfer flip 1.0 scheme usl light 0.5",
                      "shape linear transfer apic scheme usl light 0.5",
                      "shape linear transfer apic scheme musl light 0.5",
                      "shape linear transfer apic scheme usf light 0.5",
                      "shape linear transfer aflip 1.0 scheme usl light 0.5",
                      "shape linear transfer xpic 2 scheme usl light 0.5"));

TEST(LightNodesWithout, LinearFunctionsBreak)
{
  EXPECT_GT(release("shape linear transfer flip 1.0 scheme usl", 0.25 + 1e-6), 2.0);
  EXPECT_GT(release("shape linear transfer apic scheme usl", 0.25 + 1e-6), 2.0);
}

/* a free ball in flight, which falls to pieces without */

TEST(LightNodes3d, BallInFlight)
{
  for (const char *options : {"transfer flip 1.0 scheme usl", "transfer apic", "transfer apic scheme musl"}) {
    SCOPED_TRACE(options);
    Scene run;
    run.commands(strprintf("units si\nboundary f f f\natom_style mpm\nneighbor 0.3 bin\n"
                           "region box block 0 20 0 20 0 20\ncreate_box 1 box\n"
                           "fix grid all mpm 1.0 shape linear %s light 0.5\n"
                           "region body sphere 4.3 5.2 5 1.9\ncreate_points 1 region body ppc 2\n"
                           "displace_atoms all move 0.137 0.211 0.173\n"
                           "fix elastic all mpm/material density 2.0 linear 1000 0.3\n"
                           "velocity all set 1.7 0.9 1.1\ntimestep 0.01\ncompute e all mpm/energy\n"
                           "thermo_style custom step c_e\nrun 0\n",
                           options));
    const double start = run.evaluate("c_e");
    const auto before = run.sums();
    run.commands("run 500\n");
    const auto after = run.sums();
    for (int d = 0; d < 3; d++)
      EXPECT_NEAR(after.p[d], before.p[d], 1.0e-12 * before.mass);
    EXPECT_NEAR(run.evaluate("c_e"), start, 1.0e-10 * start);
  }
}

TEST(LightNodesInput, IsRefusedWhereItIsOfNoUse)
{
  const std::string scene = "units lj\nboundary p p p\natom_style mpm\n"
                            "region box block 0 8 0 8 0 8\ncreate_box 1 box\n"
                            "create_points 1 box spacing 1.0\n";
  const std::string material = "fix m all mpm/material density 1.0 linear 1.0 0.3\nrun 0\n";
  for (const char *options :
       {"light 0.5", "shape linear transfer flip 1.0 scheme musl light 0.5",
        "shape linear frame total light 0.5", "shape gimp light 0.5"}) {
    Scene run;
    EXPECT_THAT(run.error(scene + "fix grid all mpm 1.0 " + options + "\n" + material),
                ::testing::HasSubstr("remove light"));
  }
  Scene run;
  EXPECT_THAT(run.error(scene + "fix grid all mpm 1.0 shape linear light 1.5\n"),
              ::testing::HasSubstr("within 0 and 1"));
}

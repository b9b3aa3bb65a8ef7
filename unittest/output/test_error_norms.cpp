// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics input
// mpi: 1 2
// timeout: 900

// compute mpm/error

#include "mpm_lammps.h"

#include <sstream>

using namespace MPM_TEST;

static const std::string block = space("lj", "p p p", "0 4 0 4 0 4") + R"(
fix grid all mpm 1.0
region part block 1 3 0 4 0 4
create_points 1 region part ppc 2
fix m all mpm/material density 1 neohookean 10 0.3
velocity all set 0.3 -0.4 0
timestep 0.01
variable one atom 0.3+0.0*x
variable two atom -0.4+0.1*(x>2)
variable right atom 1.5*x
variable number equal 3
compute s all mpm/atom stress/*
compute d all displace/atom
)";

TEST(ErrorNorms, AreThoseOfTheDefinition)
{
  Scene run(block +
            "compute e all mpm/error vx v_one vy v_two\ncompute x all mpm/error x v_right\n"
            "thermo_style custom step c_e c_e[1] c_e[2] c_e[3] c_e[4] c_e[5] c_x\nrun 0\n");
  EXPECT_NEAR(run.evaluate("c_e"), 0.1 * std::sqrt(0.5), 1e-14);    // half of the points are off
  EXPECT_NEAR(run.evaluate("c_e[2]"), 0.1, 1e-14);
  EXPECT_NEAR(run.evaluate("c_e[3]"), std::sqrt(0.09 + 0.5 * (0.16 + 0.09)), 1e-14);
  // x from 1.25 to 2.75 in four layers: 0.5 * rms of x
  const double rms = std::sqrt((1.25 * 1.25 + 1.75 * 1.75 + 2.25 * 2.25 + 2.75 * 2.75) / 4);
  EXPECT_NEAR(run.evaluate("c_x"), 0.5 * rms, 1e-13);

  // the largest so far stays when the error becomes smaller
  run.commands("velocity all set NULL -0.35 NULL\nrun 0\n");
  EXPECT_NEAR(run.evaluate("c_e"), 0.05, 1e-14);
  EXPECT_NEAR(run.evaluate("c_e[4]"), 0.1 * std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(run.evaluate("c_e[5]"), 0.1, 1e-14);
}

// points of the group, by volume, at unwrapped positions; an error that is no number stays one
TEST(ErrorNorms, VolumesGroupsAndImages)
{
  Scene run(space("lj", "p p p", "0 4 0 4 0 4", 3) + R"(
fix grid all mpm 1.0
region left block 0 1 0 4 0 4
region middle block 1 2 0 4 0 4
region right block 3 4 0 4 0 4
create_points 1 region left ppc 2
create_points 2 region middle ppc 1
create_points 3 region right ppc 1
group some type 1 2
fix m all mpm/material density 1 neohookean 10 0.3
velocity some set 0.3 0 0
velocity all set 0.2 NULL NULL sum yes
variable v atom 0.2+0.1*(type==1)
variable zero atom 0.0*x
variable bad atom (0.5-(id==7))^0.5
compute v some mpm/error vx v_v
compute all all mpm/error vx v_v
compute b some mpm/error vx v_bad
compute x some mpm/error x v_zero
thermo_style custom step c_v c_v[2] c_all c_b c_b[2] c_x
run 0
)");
  // vx - v: 0.2 in a volume of 16 (128 points) and 0.3 in one of 16 (16 points)
  EXPECT_NEAR(run.evaluate("c_v"), std::sqrt((0.04 + 0.09) / 2), 1e-14);
  EXPECT_NEAR(run.evaluate("c_v[2]"), 0.3, 1e-14);
  EXPECT_NEAR(run.evaluate("c_all"), std::sqrt((0.04 + 0.09) / 3), 1e-14);
  EXPECT_TRUE(std::isnan(run.evaluate("c_b")));
  EXPECT_TRUE(std::isnan(run.evaluate("c_b[2]")));
  // x at first, and after the points have crossed the periodic face: 3 further to the right
  const double left = (0.25 * 0.25 + 0.75 * 0.75) / 2, middle = 1.5 * 1.5;
  EXPECT_NEAR(run.evaluate("c_x"), std::sqrt((left + middle) / 2), 1e-13);
  run.commands("displace_atoms all move 3 0 0\nrun 0\n");
  const double moved = (3.25 * 3.25 + 3.75 * 3.75) / 2;
  EXPECT_NEAR(run.evaluate("c_x"), std::sqrt((moved + 4.5 * 4.5) / 2), 1e-13);
}

/** The example, n cells across the ring: largest error of the positions. */
static double vortex(int n, const std::string &settings = "", double angle = 0.1)
{
  std::ifstream file(std::string(MPM_SOURCE_DIR) + "/examples/vortex/in.vortex");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_GT(text.str().size(), 100u);
  Scene run("variable n index " + std::to_string(n) + "\nvariable G index " +
            std::to_string(angle) + "\n");
  if (!settings.empty()) run.commands("variable options index \"" + settings + "\"\n");
  std::string line;
  while (std::getline(text, line))
    if (line.rfind("dump", 0) != 0) run.commands(line + "\n");
  return measured("vortex " + settings + ", n = " + std::to_string(n), run.evaluate("c_u[4]"));
}

// B2: 1.94e-2 and 6.83e-3 with 5 and 10 cells by another code, second order in the end. With the
// sign of (g' s)^2 that is found in several codes, the error does not become smaller than 5e-3.
TEST(ErrorNorms, GeneralizedVortex)
{
  LONG_CASE();
  const double coarse = vortex(5), fine = vortex(8);
  EXPECT_NEAR(coarse, 1.94e-2, 0.1 * 1.94e-2);
  EXPECT_GT(std::log(coarse / fine) / std::log(8.0 / 5.0), 1.4);
}

TEST(BadInput, IsRefused)
{
  expect_refused(block,
                 {
                     {"compute e all mpm/error", "Illegal compute mpm/error"},
                     {"compute e all mpm/error vx", "Illegal compute mpm/error"},
                     {"compute e all mpm/error vx v_one vy", "come in pairs"},
                     {"compute e all mpm/error velocity v_one", "must be x, y, z, vx"},
                     {"compute e all mpm/error vx 1.0", "must be an atom-style variable"},
                     {"compute e all mpm/error vx v_none", "variable none does not exist"},
                     {"compute e all mpm/error vx v_number", "variable number is not atom-style"},
                     {"compute e all mpm/error c_none v_one", "compute none does not exist"},
                     {"compute e all mpm/error c_s v_one", "has 6 columns: choose one"},
                     {"compute e all mpm/error c_s[7] v_one", "has no column 7"},
                     {"compute e all mpm/error c_thermo_temp v_one", "is not per atom"},
                     {"compute e all mpm/error f_m v_one", "is not per atom"},
                 });
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi input ranks
// mpi: 1 3

// Stress by the gradients of the shape functions together with the affine matrix of moving least
// squares (fix mpm stress gradient). Convergence: test_physics_mms.

#include "mpm_lammps.h"

using namespace MPM_TEST;

static std::string text(int dim, const std::string &options)
{
  const bool flat = dim == 2;
  return box(dim, "lj", "p p p", "-3 13 -3 13 -8 8") + "fix g all mpm 1.0 origin 0.1 0.2 " +
      (flat ? "" : "0.3 ") + options + R"(
region body sphere 5 5 0 3.9
create_points 1 region body spacing 0.5 jitter 0.3 817
fix m all mpm/material density 2 neohookean 3 0.3
)";
}

static const char *const cases[] = {
    "shape quadratic transfer apic", "shape quadratic transfer aflip 0.95",
    "shape cubic transfer apic", "shape quadratic transfer apic locking fbar",
    "shape quadratic transfer apic scheme musl"};

// patch: a linear field of velocities deforms points inside the body by exactly that gradient, with
// either
TEST(Stress, LinearField)
{
  for (const int dim : {2, 3})
    for (const std::string options : cases)
      for (const char *stress : {" stress mls", " stress gradient"}) {
        SCOPED_TRACE(options + stress);
        if (dim == 3 && options.find("locking") != std::string::npos) continue;
        Scene run(text(dim, options + stress) +
                  "variable vx atom 0.3*(x-5)-0.2*(y-5)\nvariable vy atom 0.1*(x-5)+0.4*(y-5)\n"
                  "velocity all set v_vx v_vy 0\ntimestep 1e-6\nrun 1\n");
        const double L[2][2] = {{0.3, -0.2}, {0.1, 0.4}};
        int n = 0;
        for (const auto &s : run.gather()) {
          if (hypot(s.x[0] - 5.0, s.x[1] - 5.0) > 1.0 || std::fabs(s.x[2]) > 0.4) continue;
          n++;
          for (int a = 0; a < 2; a++)
            for (int b = 0; b < 2; b++)
              EXPECT_NEAR((s.F[3 * a + b] - (a == b)) / 1e-6, L[a][b], 1e-8);
        }
        EXPECT_GT(n, 5);
      }
}

// momentum, that the ledger closes, and that force and strain belong together: the integration entry
// is the difference of their works
TEST(Stress, Conservation)
{
  for (const std::string options : cases) {
    if (options.find("locking") != std::string::npos) continue;
    SCOPED_TRACE(options);
    Scene run(text(2, options + " stress gradient"));
    run.commands(R"(
compute e all mpm/energy
variable vx atom -0.3*(y-5)+0.1*(x-5)
variable vy atom 0.3*(x-5)
velocity all set v_vx v_vy 0
velocity all zero linear
timestep 0.0005
thermo_style custom step c_e c_e[*]
run 4000
)");
    EXPECT_GT(run.evaluate("c_e[2]"), 0.02 * run.evaluate("c_e"));
    const double scale = run.evaluate("c_e");
    EXPECT_LT(std::fabs(run.evaluate("c_e[11]")), 1e-12 * scale);
    EXPECT_LT(measured("integration", std::fabs(run.evaluate("c_e[10]")) / scale),
              options.find("musl") == std::string::npos ? 2e-5
                                                        : 2e-4);    // with other forces: 4e-5
    const Totals all(run.gather());
    for (int d = 0; d < 2; d++) EXPECT_NEAR(all.p[d] / all.mass, 0.0, 1e-14);
  }
}

// the two differ, and are close: a rod between walls under its weight
TEST(Stress, DifferenceIsSmall)
{
  std::vector<double> bottom;
  for (const char *stress : {"stress mls", "stress gradient"}) {
    Scene run(replaced(plane("lj", "p f", "0 4 0 16") + R"(
fix g all mpm 1.0 OPTIONS
region r block INF INF 0 10 INF INF
create_points 1 region r ppc 2
fix m all mpm/material density 1 eos linear 100 strength elastic 60
fix w all mpm/boundary ylo slip
fix f all viscous 0.1
fix gr all gravity 0.5 vector 0 -1 0
timestep 0.02
run 3000
)",
                       "OPTIONS", stress));
    double lowest = 0.0;
    for (const auto &s : run.gather()) lowest = std::min(lowest, s.stress[1]);
    bottom.push_back(lowest);
  }
  // the weight above the lowest points, at 1/4
  EXPECT_NEAR(bottom[0], -0.5 * 9.75, 0.2);
  EXPECT_NEAR(bottom[1], -0.5 * 9.75, 0.2);
  EXPECT_NE(bottom[0], bottom[1]);
  measured("mls", bottom[0]);
  measured("gradient", bottom[1]);
}

TEST(Stress, Refused)
{
  const std::string head =
      "units lj\ndimension 2\natom_style mpm\nregion b block 0 4 0 4 -0.5 0.5\n"
      "create_box 1 b\nfix g all mpm 1.0 ";
  for (const char *options : {"transfer flip 1.0", "shape linear", "transfer tpic", "shape gimp"}) {
    Scene run;
    expect_error(run, head + options + " stress mls", "needs shape quadratic or cubic");
    Scene other;
    EXPECT_EQ(other.error(head + options + " stress gradient"), "");
  }
  Scene run;
  expect_error(run, head + "frame total stress gradient", "frame total needs");
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics

// Thin strips and plates of material points, a few cells through their thickness, on lattices, by
// implicit steps: benchmark U5. In plane strain E' = E/(1 - nu^2).

#include "implicit/implicit_testing.h"

using namespace MPM_TEST;

constexpr double E = 1e6, NU = 0.3, RHO = 1000.0, STIFF = E / (1.0 - NU * NU);

/** A strip of length 1 and thickness t, clamped at x = 0, with room above and below. */
static std::string strip(double t, int cells, double room, double length,
                         const std::string &transfer)
{
  const double h = t / cells;
  return strprintf(
             "units si\ndimension 2\nboundary f f p\natom_style mpm\nneighbor %g bin\n"
             "region box block 0 %.17g %.17g %.17g -0.1 0.1\ncreate_box 1 box\n"
             "region strip block 0 1 0 %.17g INF INF\nfix grid all mpm %.17g frame total %s\n",
             0.3 * h, length, -room, room + t, t, h, transfer.c_str()) +
      strprintf("create_points 1 region strip ppc 2\nfix m all mpm/material density %g linear %g "
                "%g\nfix clamp all mpm/boundary xlo stick\nregion tip block %.17g INF INF INF INF "
                "INF\ngroup tip region tip\ncompute u all displace/atom\ncompute w tip reduce ave "
                "c_u[2]\nthermo_style custom step c_w\n",
                RHO, E, NU, 1.0 - h);
}

/** Deflection of the tip of a cantilever under a load there, in parts of F L^3/3 E'I; work: blocks
 *  of nodes, and iterations of the linear solver in two steps. */
static double cantilever(double t, int cells, double room, std::array<double, 2> *work = nullptr)
{
  const double F = 0.03 * STIFF * t * t * t / 12.0;
  Scene run(strip(t, cells, room, 1.0 + 4.0 * t / cells, "") +
            strprintf("fix load tip addforce 0 $(%.17g/count(tip)) 0\n", F) +
            "fix solve all mpm/implicit static solver multigrid\ntimestep 1\nrun 2\n");
  if (work) *work = {(double) run.grid().blocks.size(), solved(run, 5)};
  return run.compute_scalar("w") / 0.01;
}

SERIAL_TEST(ThinStrip, TipLoad)
{
  EXPECT_NEAR(measured("length 100, 2 cells", cantilever(0.01, 2, 0.02)), 1.0, 0.06);
  EXPECT_NEAR(measured("length 100, 4 cells", cantilever(0.01, 4, 0.02)), 1.0, 0.015);
  EXPECT_NEAR(measured("length 100, 6 cells", cantilever(0.01, 6, 0.02)), 1.0, 0.01);
  EXPECT_NEAR(measured("length 200, 4 cells", cantilever(0.005, 4, 0.02)), 1.0, 0.015);
}

// what a strip costs does not depend on the size of the box around it, here one 200 times as large
SERIAL_TEST(ThinStrip, BoxAroundIt)
{
  std::array<double, 2> small, large;
  const double w = cantilever(0.01, 4, 0.02, &small);
  EXPECT_NEAR(cantilever(0.01, 4, 5.0, &large), w, 1e-9);
  EXPECT_LE(large[0], 1.1 * small[0]) << "blocks of nodes";
  EXPECT_LE(large[1], 1.1 * small[1] + 1.0) << "iterations";
}

// q L^4/384 D between two clamps
SERIAL_TEST(ThinStrip, TwoClamps)
{
  const double t = 0.01, w0 = 0.1 * t, D = STIFF * t * t * t / 12.0, q = 384.0 * D * w0;
  for (const int cells : {2, 4}) {
    Scene run(strip(t, cells, 0.01, 1.0, "") + "fix other all mpm/boundary xhi stick\n" +
              strprintf("fix g all gravity %.17g vector 0 -1 0\n", q / (RHO * t)) +
              "compute least all reduce min c_u[2]\nthermo_style custom step c_least\n"
              "fix solve all mpm/implicit static solver multigrid\ntimestep 1\nrun 1\n");
    EXPECT_NEAR(
        measured(strprintf("two clamps, %d cells", cells), -run.compute_scalar("least") / w0), 1.0,
        cells == 2 ? 0.07 : 0.02);
  }
}

// the lowest mode, 3.516015 sqrt(E't^2/12 rho)/L^2, from a velocity to the first time without, by
// the trapezoidal rule in 48 steps for a period, which makes it slower by 0.14 %
SERIAL_TEST(ThinStrip, Frequency)
{
  const double t = 0.01, exact = 3.516015 * t * sqrt(STIFF / (12.0 * RHO)),
               dt = 2.0 * PI / exact / 48;
  for (const int cells : {2, 4}) {
    Scene run(
        strip(t, cells, 0.02, 1.0 + 4.0 * t / cells, "transfer flip 1.0") +
        "variable k atom x*1.8751041\n"
        "variable q atom 0.5*(exp(v_k)+exp(-v_k))-cos(v_k)-0.7340955*(0.5*(exp(v_k)-exp(-v_k))-"
        "sin(v_k))\n" +
        strprintf("variable v atom %.17g*v_q\n", 0.001 * exact) +
        "velocity all set NULL v_v NULL\nvariable e atom vy*v_q\ncompute q all reduce ave v_e\n"
        "thermo_style custom step c_q\nfix solve all mpm/implicit newmark solver multigrid\n" +
        strprintf("timestep %.17g\nrun 0\n", dt));
    double before = run.compute_scalar("q"), found = 0.0;
    for (int n = 0; n < 20 && found == 0.0; n++) {
      run.commands("run 1 post no\n");
      const double now = run.compute_scalar("q");
      if (now <= 0.0) found = PI / 2.0 / ((n + before / (before - now)) * dt);
      before = now;
    }
    EXPECT_NEAR(measured(strprintf("frequency, %d cells", cells), found / exact), 1.0,
                cells == 2 ? 0.05 : 0.015);
  }
}

// q a^4/64 D, around an axis. Shear adds 0.05 % at a radius of 100, and 0.7 % at one of 25
SERIAL_TEST(ThinPlate, ClampedAtItsRim)
{
  for (const auto &[ratio, cells, gate] :
       {std::tuple{25, 2, 0.07}, std::tuple{25, 8, 0.01}, std::tuple{100, 4, 0.02}}) {
    const double t = 1.0 / ratio, h = t / cells, D = STIFF * t * t * t / 12.0, w0 = 0.05 * t;
    Scene run(
        strprintf("units si\ndimension 2\nboundary f f p\natom_style mpm\nneighbor %g bin\n"
                  "region box block 0 1 %.17g %.17g -0.1 0.1\ncreate_box 1 box\n"
                  "region plate block 0 1 0 %.17g INF INF\nfix grid all mpm %.17g frame total "
                  "axisymmetric yes\ncreate_points 1 region plate ppc 2\n",
                  0.3 * h, -4.0 * h, 4.0 * h + t, t, h) +
        strprintf("fix m all mpm/material density %g linear %g %g\n"
                  "fix axis all mpm/boundary xlo slip\nfix clamp all mpm/boundary xhi stick\n"
                  "fix g all gravity %.17g vector 0 -1 0\n",
                  RHO, E, NU, 64.0 * D * w0 / (RHO * t)) +
        "compute u all displace/atom\ncompute w all reduce min c_u[2]\n"
        "thermo_style custom step c_w\nfix solve all mpm/implicit static solver multigrid\n"
        "timestep 1\nrun 1\n");
    EXPECT_NEAR(
        measured(strprintf("radius %d, %d cells", ratio, cells), -run.compute_scalar("w") / w0),
        1.0, gate);
  }
}

// a quarter of a square on supports, 0.00406235 q L^4/D in 3d, on faces of the box that hold what
// is across the plate and along its rim, times 1 + 5.18 (t/L)^2 (Reissner)
SERIAL_TEST(ThinPlate, SquareOnSupports)
{
  for (const auto &[ratio, cells, gate] :
       first_of(2, {std::tuple{10, 2, 0.08}, std::tuple{10, 4, 0.02}, std::tuple{20, 4, 0.02}})) {
    const double t = 1.0 / ratio, h = t / cells, D = E * t * t * t / (12.0 * (1.0 - NU * NU)),
                 w0 = 0.01 * t, q = w0 * D / 0.00406235, thick = 1.0 + 5.18 * t * t;
    Scene run(
        strprintf("units si\nboundary f f f\natom_style mpm\nneighbor %g bin\n"
                  "region box block 0 0.5 0 0.5 %.17g %.17g\ncreate_box 1 box\n"
                  "region plate block 0 0.5 0 0.5 0 %.17g\nfix grid all mpm %.17g frame total\n"
                  "create_points 1 region plate ppc 2\n",
                  0.3 * h, -2.0 * h, 2.0 * h + t, t, h) +
        strprintf("fix m all mpm/material density %g linear %g %g\n"
                  "fix middle all mpm/boundary xlo ylo slip\n"
                  "fix rx all mpm/boundary xhi stick velocity NULL 0 0\n"
                  "fix ry all mpm/boundary yhi stick velocity 0 NULL 0\n"
                  "fix g all gravity %.17g vector 0 0 -1\n",
                  RHO, E, NU, q / (RHO * t)) +
        "compute u all displace/atom\ncompute w all reduce min c_u[3]\n"
        "thermo_style custom step c_w\nfix solve all mpm/implicit static solver multigrid\n"
        "timestep 1\nrun 1\n");
    EXPECT_NEAR(measured(strprintf("length %d, %d cells", ratio, cells),
                         -run.compute_scalar("w") / (w0 * thick)),
                1.0, gate);
  }
}

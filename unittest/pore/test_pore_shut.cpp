// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi
// mpi: 1 4

// Fix mpm/pore: soil that is pressed together until grains alone would fill it.

#include "pore/pore_testing.h"

#include "error.h"

using namespace MPM_TEST;

/** A block, 0.6 of it grains, between a floor and a lid that comes down with this speed. */
std::string pressed(const std::string &law, double speed)
{
  return plane("si", "p f", "0 0.4 0 1", 1, 0.03) + "create_points 1 box spacing 0.05\n" +
      "fix grid all mpm 0.1\nfix m all mpm/material density 2002 neohookean 1e7 0.3\n" +
      "fix ends all mpm/boundary ylo slip\n" +
      strprintf("fix lid all mpm/boundary yhi slip velocity 0 %g 0\n", -speed) +
      "fix water all mpm/pore 2.2e6 1000 9810 soil m 0.4 " + law + "\nfix dt all mpm/dt 0.3\n";
}

// one warning tells of it; nothing negative and no NaN comes out, and water is kept
TEST(Shut, IsTold)
{
  for (const char *law :
       {"kozeny 1e-2 ylo pressure 0", "squared 1e-2 ylo pressure 0",
        "kozeny 1e-2 ylo pressure 0 every 3", "kozeny 1e-2 ylo pressure 0 formulation u-v-p",
        "kozeny 1e-2 ylo pressure 0 forchheimer ergun 1e-3"}) {
    // that u-p leaves out the inertia of water that flows at two meters in a second is told first
    const double fast = std::string(law).find("u-v-p") == std::string::npos;
    Scene run(pressed(law, 2.0));
    Water water(run);
    run.commands("compute n all mpm/atom porosity\n");
    run.commands("fix dt all mpm/dt 0.3 until 0.05\nrun 100000\n");
    EXPECT_EQ(over_ranks(run.lmp->error->get_numwarn(), MPI_SUM), fast) << law;
    const double before = water.mass(), came = run.fix("water")->compute_scalar();
    run.commands("fix dt all mpm/dt 0.3 until 0.225\nrun 100000\n");
    EXPECT_EQ(over_ranks(run.lmp->error->get_numwarn(), MPI_SUM), fast + 1.0) << law;
    auto *compute = run.per_atom("n");
    const double *const p = water.pressures();
    double least = 1.0, lowest = 1.0;
    for (int i = 0; i < run.n(); i++) {
      lowest = std::min(lowest, run.points().jacobian(i));
      least = std::min(least, compute->vector_atom[i]);
      EXPECT_TRUE(std::isfinite(p[i])) << law;
      EXPECT_TRUE(std::isfinite(run.v()[i][1])) << law;
    }
    EXPECT_LT(over_ranks(lowest, MPI_MIN), 0.6) << law;
    EXPECT_EQ(over_ranks(least, MPI_MIN), 0.0) << law;
    const double now = run.fix("water")->compute_scalar();
    EXPECT_NEAR((water.mass() - before - 1000.0 * (now - came)) / before, 0.0, 1e-12) << law;
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics extreme ranks
// mpi: 2 4
// timeout: 300

// Stability at the extremes, on ranks: at speed, points on corners, nodes of next to no mass.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** A body flies along the diagonal of a periodic box at half its wave speed, three times around. */
PARAMETER_TEST(AtSpeed, AcrossPeriodicFacesAndCorners, const char *,
               Values("transfer apic", "transfer flip 1.0 scheme musl",
                      "shape cpgimp transfer apic scheme usavg",
                      "shape linear transfer pic scheme musl",
                      "shape linear transfer apic light 0.5",
                      "shape linear transfer apic scheme usf light 0.5"))
{
  OnRanks both(
      plane("lj", "p p", "0 16 0 16", 1, 0.4) +
          strprintf("fix grid all mpm 1.0 %s\nregion b block 3 7 3 7 INF INF\n"
                    "create_points 1 region b ppc 2\ndisplace_atoms all move 0.25 0.25 0\n"
                    "fix m all mpm/material density 1 neohookean 0.742857142857 0.3\n"
                    "variable vx atom 0.35+0.02*(y-5.25)\nvariable vy atom 0.35-0.02*(x-5.25)\n"
                    "velocity all set v_vx v_vy NULL\ntimestep 0.25\n",
                    GetParam()),
      "run 550\n");
  EXPECT_LT(measured(std::string(GetParam()) + ": difference to one rank", both.difference()),
            1.0e-9);
  const Totals all(both.parallel.gather());
  for (int d = 0; d < 2; d++) EXPECT_NEAR(all.p[d], 0.35 * all.mass, 1.0e-12 * all.mass);
}

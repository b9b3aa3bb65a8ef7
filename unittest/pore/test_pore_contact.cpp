// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi
// mpi: 1 4
// timeout: 300

// Soil with pore water in contact (fix mpm/contact): grains and water share what is between bodies.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

constexpr double SUBMERGED = 990.0 / 1990.0;    // weight in water over that of soil and water

/** A layer of saturated soil, 1 m high with 10 cells, periodic along x, in a box from y = -0.4 on;
 *  water has the pressure of rest across the layer, and seeps along it. slope: tangent of the angle
 *  of gravity; offset: of y = 0 from nodes, in cells; dim: 2, or 3, where y is up, too. */
std::string layer(double slope, double offset, int dim)
{
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
  return (dim == 2 ? plane("si", "p f", "0 0.4 -0.4 1", 2, 0.03)
                   : space("si", "p f p", "0 0.4 -0.4 1 0 0.4", 2, 0.03)) +
      "region soil block INF INF 0 1 INF INF\nregion base block INF INF -0.4 0 INF INF\n"
      "group soil empty\ngroup base empty\n" +
      strprintf("fix grid soil mpm 0.1 origin 0 %.17g%s\n", 0.1 * offset, dim == 2 ? "" : " 0") +
      "create_points 1 region soil spacing 0.05 fix grid group soil\n"
      "fix m soil mpm/material density 1990 linear 1e7 0.3\n" +
      strprintf("fix g all gravity 9.81 vector %.17g -1 0\nvariable p atom 9810*%.17g*(1-y)\n",
                slope, cosine) +
      "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-2 yhi pressure 0 initial "
      "v_p\n";
}

/** The same on a body that is held, in a field of its own. */
std::string on_body(const std::string &law, double slope, double offset, int dim = 2,
                    const char *order = "grid lower")
{
  return layer(slope, offset, dim) +
      strprintf("fix lower base mpm 0.1 origin 0 %.17g%s\n", 0.1 * offset, dim == 2 ? "" : " 0") +
      "create_points 2 region base spacing 0.05 fix lower group base\n"
      "fix b base mpm/material density 2500 linear 1e8 0.3\n"
      "fix hold all mpm/boundary ylo stick\nfix touch all mpm/contact " +
      order + " law " + law + "\n";
}

struct Motion {
  double v[2] = {0.0, 0.0}, lowest = 1e300, highest = -1e300;
};
/** Mean of the points of the soil. */
Motion of_soil(Scene &run)
{
  Motion m;
  double n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    if (run.lmp->atom->type[i] != 1) continue;
    for (int d = 0; d < 2; d++) m.v[d] += run.v()[i][d];
    m.lowest = std::min(m.lowest, run.x()[i][1]);
    m.highest = std::max(m.highest, run.x()[i][1]);
    n++;
  }
  for (double &v : m.v) v /= n;
  return m;
}

/** Friction of the layer when it has come to rest on what is below, over that of its grains: what
 *  its weight is above the pressure of the water at its lower side, which may be a part of a cell
 *  off the surface of the other body. The pressure is zero at the upper end of the soil, which may
 *  be as much below the face of the box. */
double friction(Scene &run, double slope, double coefficient)
{
  run_to(run, 0.6);
  const auto before = of_soil(run);
  run_to(run, 0.7);
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope), low = before.lowest - 0.025,
               high = before.highest + 0.025;
  EXPECT_LT(std::fabs(low), 0.03);
  EXPECT_LT(std::fabs(high - 1.0), 0.03);
  const double held = 9.81 * cosine * slope - (of_soil(run).v[0] - before.v[0]) / 0.1;
  return held / (9.81 * cosine * coefficient * (1990.0 - 1000.0 * (high - low)) / 1990.0);
}

// an infinite slope with seepage: friction is that of the submerged weight, not half of the total
SERIAL_TEST(Contact, FrictionIsThatOfGrains)
{
  for (const double offset : {0.0, 0.3}) {
    Scene run(on_body("coulomb 0.5", 0.35, offset));
    EXPECT_NEAR(measured(strprintf("offset %g, friction", offset), friction(run, 0.35, 0.5)), 1.0,
                0.005);
  }
  Scene other(on_body("coulomb 0.5", 0.35, 0.5, 2, "lower grid"));
  EXPECT_NEAR(measured("soil is the second body", friction(other, 0.35, 0.5)), 1.0, 0.005);
  // a stiff one, which the layer does not press into
  Scene stiff(replaced(on_body("coulomb 0.5", 0.35, 0.0), "linear 1e8", "linear 1e9"));
  EXPECT_NEAR(measured("stiff, friction", friction(stiff, 0.35, 0.5)), 1.0, 0.005);
  Scene run(on_body("coulomb 0.5", 0.35, 0.2, 3));
  EXPECT_NEAR(measured("3d", friction(run, 0.35, 0.5)), 1.0, 0.005);
}

// the layer is held below the angle with tan = friction times the share of submerged weight
SERIAL_TEST(Contact, SlopeHolds)
{
  Scene run(on_body("coulomb 0.5", 0.9 * 0.5 * SUBMERGED, 0.0));
  run_to(run, 0.7);
  EXPECT_NEAR(measured("velocity over that of sliding freely",
                       of_soil(run).v[0] / (9.81 * 0.45 * SUBMERGED * 0.7)),
              0.0, 0.005);
}

// where water presses with more than the weight of the layer, grains leave and do not hold it back
SERIAL_TEST(Contact, WaterPartsBodies)
{
  for (const double offset : {0.0, 0.3})
    for (const auto &[law, order] :
         {std::pair{"coulomb 0.5", "grid lower"}, {"frictionless", "lower grid"}}) {
      Scene run(
          replaced(replaced(on_body(law, 0.0, offset, 2, order), "constant 1e-2", "constant 1e-9"),
                   "atom 9810", "atom 2.2*9810"));
      const double low = of_soil(run).lowest - 0.025;
      run.commands("timestep 1e-6\nrun 1\n");
      const double push = std::fabs(run.fix("touch")->compute_array(0, 1));
      EXPECT_NEAR(measured(strprintf("offset %g, force", offset),
                           push / (2.2 * 9810.0 * (1.0 - low) * 0.4)),
                  1.0, 1e-3);
    }
}

// two layers with water of different pressure: between them is the mean of both, less than which no
// node bears. In the row of nodes below the interface, which has an eighth of its area, the lower
// one follows the pressure of the upper one
SERIAL_TEST(Contact, OfTwoSoils)
{
  Scene run(replaced(replaced(on_body("coulomb 0.5", 0.0, 0.0), "density 2500", "density 1990"),
                     "fix hold",
                     "unfix water\nvariable p atom 9810*(1-y)*(2.2*(y>0)+1.2*(y<0))\n"
                     "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-9 soil b 0.4 "
                     "constant 1e-9 yhi pressure 0 initial v_p\nfix hold") +
            "timestep 1e-6\nrun 1\n");
  const double mean = 0.5 * (2.2 + 1.2);
  const double force =
      measured("force over that of the mean",
               std::fabs(run.fix("touch")->compute_array(0, 1)) / (mean * 9810.0 * 0.4));
  EXPECT_GT(force, 0.999);
  EXPECT_LT(force, 1.0 + 0.125 * (2.2 - mean) / mean);
}

// water at nodes that are not in contact: the left half of the lower body is off by h/14
SERIAL_TEST(Contact, MissedWaterIsTold)
{
  for (const bool off : {false, true})
    EXPECT_EQ(times_said(
                  on_body("coulomb 0.5", 0.0, 0.0) +
                      (off ? "region left block 0 0.2 INF INF INF INF\ngroup left region left\n"
                             "group part intersect left base\ndisplace_atoms part move 0 -0.007 0\n"
                           : "") +
                      "timestep 1e-6\nrun 60\n",
                  "counts as one of grains"),
              off ? 1 : 0);
}

TEST(Ranks, Agree)
{
  OnRanks run(on_body("coulomb 0.5", 0.35, 0.3) + "velocity soil set 0.1 0 0\ntimestep 1e-4\n",
              "run 100\n");
  EXPECT_LT(run.difference(), 1e-11);
}

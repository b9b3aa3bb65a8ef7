// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 3
// timeout: 200

// Heat of friction between bodies on different lattices (fix mpm/heat penalty), and warnings.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** A block slides on another one, which has other nodes and a fourth of its effusivity. */
static std::string sliding(const std::string &heat = "penalty yes")
{
  return plane("lj", "p f", "0 7 0 8", 2, 0.3) + "comm_modify vel yes\n" +
      fields({{"one", "block INF INF 0 4 INF INF", "1.0"},
              {"two", "block INF INF 4 6.8 INF INF", "0.7 origin 0 4"}}) +
      R"(
fix m one mpm/material density 1 neohookean 1000 0.3 thermal conducting 1.0 0.0 1.0
fix n two mpm/material density 1 neohookean 1000 0.3 thermal conducting 4.0 0.0 4.0
fix w all mpm/boundary ylo stick field F1
fix g two gravity 2.0 vector 0 -1 0
pair_style mpm/penalty
pair_coeff 1 2 1000 friction 0.3 0.05 damping 0.5
fix heat all mpm/heat )" +
      heat + R"(
compute e all mpm/energy
compute p all pair mpm/penalty
fix sum all vector 1 c_p[2]
variable taken equal dt*sum(f_sum)
velocity two set 1.2 0 0
thermo_style custom step c_e pe
timestep 0.005
)";
}

static double heat_of(Scene &run, const char *id)
{
  return Warm(run, id).heat();
}

// what the motion loses is heat, which the two have as their effusivities
SERIAL_TEST(Sliding, WarmsBoth)
{
  Scene run(sliding() + "run 0\n");
  const double M = run.evaluate("mass(two)"), y = run.evaluate("xcm(two,y)");
  // the power of friction is that of the start of a step, and the work of its force that of the
  // mean velocity: 0.0044 of it is missing with steps of 0.005
  run.commands("timestep 0.00125\nrun 1200\n");
  const double *const e = run.compute_vector();
  const double made = e[17], left = e[0] + e[1] - e[8] - e[9] + run.evaluate("pe*atoms"),
               lost = 0.5 * M * 1.44 + 2.0 * M * (y - run.evaluate("xcm(two,y)")) - left;
  EXPECT_GT(measured("heat/energy of the motion", made / (0.5 * M * 1.44)), 0.7);
  EXPECT_NEAR(measured("heat/energy lost", made / lost), 1.0, 0.002);
  EXPECT_NEAR(heat_of(run, "m") / made, 0.2, 1e-12);
  EXPECT_NEAR(heat_of(run, "n") / made, 0.8, 1e-12);
  EXPECT_NEAR(e[14] / made, 1.0, 1e-12);
  EXPECT_NEAR(e[10], 0.0, 1e-11);
  EXPECT_NEAR(run.fix("heat")->compute_scalar() / made, 1.0, 1e-14);
  // each power is that of the start of its step: the last one warms in the next step
  const double last = run.lmp->update->dt * run.evaluate("c_p[2]");
  EXPECT_NEAR((run.evaluate("v_taken") - last) / made, 1.0, 1e-10);
}

// a body that does not conduct leaves all of it to the other
SERIAL_TEST(Sliding, OnWhatDoesNotConduct)
{
  Scene run(replaced(sliding(), "thermal conducting 4.0 0.0 4.0", "") + "run 100\n");
  const double made = run.compute_vector()[17];
  EXPECT_GT(made, 1.0);
  EXPECT_NEAR(heat_of(run, "m") / made, 1.0, 1e-12);
}

PARAMETER_TEST(PenaltyRanks, Agree, const char *, Values("on", "off"))
{
  OnRanks run("newton " + std::string(GetParam()) + "\n" + sliding(), "run 60\n");
  const double made = run.serial.compute_vector()[17];
  EXPECT_GT(made, 1.0);
  EXPECT_NEAR(run.parallel.compute_vector()[17] / made, 1.0, 1e-11);
  EXPECT_NEAR(heat_of(run.parallel, "m") / made, 0.2, 1e-11);
  EXPECT_NEAR(heat_of(run.parallel, "n") / made, 0.8, 1e-11);
  EXPECT_LT(run.difference(), 1e-11);
}

TEST(Restart, Continues)
{
  const std::string scene = sliding();
  Continued run(scene, 60, lines_again(scene), 40);
  // to round-off, as the order of points in neighbor lists is another one
  EXPECT_LT(measured("difference", difference(run.whole.gather(), run.again.gather())), 1e-12);
  const double made = heat_in(run.whole);
  EXPECT_GT(made, 1.0);
  EXPECT_NEAR(heat_in(run.again) / made, 1.0, 1e-12);
  EXPECT_NEAR(heat_of(run.again, "m") / made, 0.2, 1e-12);
  EXPECT_NEAR(heat_of(run.again, "n") / made, 0.8, 1e-12);
}

// friction of which the input does not say what becomes of it
TEST(Friction, ThatWarmsNothingIsSaid)
{
  const auto said = [](const std::string &scene) {
    return lines_that_say(scene + "run 0\nrun 0\n", "warms nothing of fix mpm/heat heat").size();
  };
  EXPECT_EQ(said(sliding("")), 1);
  EXPECT_EQ(said(sliding("penalty no")), 0);
  EXPECT_EQ(said(sliding()), 0);
  EXPECT_EQ(said(replaced(sliding(""), " friction 0.3 0.05 damping 0.5", "")), 0);

  const std::string one = replaced(
      replaced(sliding(""), "0.7 origin 0 4", "1.0"),
      "pair_style mpm/penalty\npair_coeff 1 2 1000 friction 0.3 0.05 damping 0.5\n", "TOUCH\n");
  const std::string bare = replaced(replaced(replaced(one, "compute p all pair mpm/penalty\n", ""),
                                             "fix sum all vector 1 c_p[2]\n", ""),
                                    "variable taken equal dt*sum(f_sum)\n", "");
  for (const char *touch : {"fix c all mpm/contact F1 F2 law coulomb 0.3",
                            "fix c all mpm/boundary yhi slip friction 0.2"}) {
    EXPECT_EQ(said(replaced(bare, "TOUCH", touch)), 1) << touch;
    EXPECT_EQ(said(replaced(bare, "TOUCH", std::string(touch) + " heat no")), 0) << touch;
    EXPECT_EQ(said(replaced(bare, "TOUCH", std::string(touch) + " heat yes")), 0) << touch;
  }
  EXPECT_EQ(said(replaced(bare, "TOUCH", "fix c all mpm/contact F1 F2")), 0);
}

SERIAL_TEST(BadInput, IsRefused)
{
  expect_error(replaced(sliding(), " friction 0.3 0.05 damping 0.5", "") + "run 0\n",
               "no pair style mpm/penalty with friction or damping");
  expect_error(bar(4, "penalty yes") + "run 0\n",
               "no pair style mpm/penalty with friction or damping");
  expect_error(replaced(sliding(), "penalty yes", "penalty maybe") + "run 0\n", "maybe");
}

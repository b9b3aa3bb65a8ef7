// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 200

// Heat between grains and material points: fix mpm/heat grains yes.

#include "mpm_lammps.h"

using namespace MPM_TEST;

constexpr double GRAIN_CAPACITY = 500.0;

const std::string head = R"(
units si
newton NEWTON
atom_modify map array
boundary p p f
atom_style hybrid sphere mpm
neighbor 0.004 bin
comm_modify vel yes
region box block 0 0.08 0 0.08 0 0.12
create_box 2 box
fix prop all property/atom temperature heatflow ghost yes
)";

/** What a run needs, also after a restart. */
static std::string fixes(const std::string &contact, const std::string &material,
                         const std::string &hot)
{
  return "fix grid all mpm 0.008\nfix m block mpm/material density 1000 neohookean 1.0e5 0.3 " +
      material + "\npair_style granular\npair_coeff * * " + contact +
      "\nfix skin block mpm/surface lists grains\nfix hf grains heat/flow constant 500\n" +
      "fix heat all mpm/heat " + hot + "\n";
}

/** Heat of the grains, above the temperature 0. */
static double heat_of_grains(Scene &run)
{
  auto *const atom = run.lmp->atom;
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (atom->vfrac[i] == 0.0) sum += run.mass()[i] * GRAIN_CAPACITY * atom->temperature[i];
  return over_ranks(sum);
}

static double heat_of_points(Scene &run, double &capacity)
{
  auto *fix = run.material("m");
  const int column = fix->find_history("temperature");
  const double c = fix->material->conduction(nullptr).capacity;
  double sum = 0.0, all = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.lmp->atom->vfrac[i] > 0.0) {
      sum += run.mass()[i] * c * fix->history[i][column];
      all += run.mass()[i] * c;
    }
  capacity = over_ranks(all);
  return over_ranks(sum);
}

/** Heat that came to points in the last step, and goes to their nodes in the next one. */
static double waiting_heat(Scene &run)
{
  auto *const atom = run.lmp->atom;
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (atom->vfrac[i] > 0.0) sum += run.lmp->update->dt * atom->heatflow[i];
  return over_ranks(sum);
}

/** Four hot grains fall on a block, across all ranks. */
static std::string falling(const std::string &newton = "on",
                           const std::string &step = "timestep 1e-4\n")
{
  return replaced(head, "NEWTON", newton) + R"(
fix grid all mpm 0.008
region block block INF INF INF INF 0 0.032
create_points 1 region block ppc 2
group block type 1
create_atoms 2 single 0.02 0.02 0.0425
create_atoms 2 single 0.06 0.02 0.043
create_atoms 2 single 0.02 0.06 0.044
create_atoms 2 single 0.06 0.058 0.046
group grains type 2
set type 2 diameter 0.02 density 2500
set group grains temperature 800
velocity grains set 0.05 0.1 -0.5
)" +
      replaced(fixes("hertz/material 1e5 0.5 0.3 tangential linear_nohistory 0 0.4 heat radius 50",
                     "thermal conducting 400 300 20", "grains yes zlo convection 100 300"),
               "fix grid all mpm 0.008\n", "") +
      R"(
fix floor all mpm/boundary zlo stick
fix move grains nve/sphere
fix g all gravity 9.81 vector 0 0 -1
compute e all mpm/energy
)" + step;
}

// A grain and a block that conducts well are two lumps: exp(-hA (1/C1 + 1/C2) t)
SERIAL_PARAMETER_TEST(TwoLumps, Exponential, const char *, Values("on", "off"))
{
  {
    Scene run(replaced(head, "NEWTON", GetParam()) + R"(
fix grid all mpm 0.008
region block block 0.024 0.056 0.024 0.056 0.016 0.032
create_points 1 region block ppc 2
group block type 1
create_atoms 2 single 0.04 0.04 0.0415
group grains type 2
set type 2 diameter 0.02 density 2500
set group grains temperature 800
)" +
              replaced(fixes("hertz 1e-9 0 tangential linear_nohistory 0 0 heat area 4e6",
                             "thermal conducting 400 300 4e6", "grains yes stages 99"),
                       "fix grid all mpm 0.008\n", "") +
              strprintf("timestep %g\nrun 0\n", 2e-4));
    double mine = 0.0;    // power at the start
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->vfrac[i] == 0.0) mine = -run.lmp->atom->heatflow[i];
    double block;
    const double start = heat_of_grains(run) + heat_of_points(run, block);
    const double grain = 2500.0 * PI / 6.0 * 8e-6 * GRAIN_CAPACITY;
    const double rate = mine / 500.0 * (1.0 / grain + 1.0 / block);
    run.commands("run 1000\n");
    const double T = heat_of_grains(run) / grain, U = heat_of_points(run, block) / block;
    EXPECT_GT(rate * 0.2, 0.5);
    const double error = measured("difference, over the exact one - 1",
                                  (T - U) / 500.0 / std::exp(-0.2 * rate) - 1.0);
    EXPECT_NEAR(error, 0.0, 5e-4);
    // of the last step, points have not got theirs yet
    run.commands("compute e all mpm/energy\n");
    const double waiting = run.compute_vector()[14];
    EXPECT_GT(waiting, 0.0);
    EXPECT_GT(waiting_heat(run), 0.0);
    EXPECT_NEAR((heat_of_grains(run) + heat_of_points(run, block) + waiting_heat(run)) / start, 1.0,
                1e-12);
    EXPECT_NEAR(
        measured("heat that came, over what grains lost - 1",
                 run.fix("heat")->compute_scalar() / (800.0 * grain - heat_of_grains(run)) - 1.0),
        0.0, 1e-12);
  }
}

// what grains lose, points get, in steps of changing length, with Newton's third law and without
PARAMETER_TEST(Falling, KeepsHeat, const char *, Values("on", "off"))
{
  // mpm/dt changes the step at its start, dt/reset at its end, here before heat is taken
  const std::string reset = "fix r grains dt/reset 5 1e-5 2e-4 3e-5 units box\nfix heat all";
  for (const int kind : {0, 1, 2}) {
    std::string scene =
        falling(GetParam(),
                kind == 1 ? "fix dt all mpm/dt 0.3 max 2e-4\ntimestep 1e-5\n" : "timestep 1e-4\n");
    if (kind == 2) scene = replaced(scene, "fix heat all", reset);
    Scene run(scene + "run 0\n");
    double capacity;
    const double grains = heat_of_grains(run), points = heat_of_points(run, capacity);
    run.commands("run 400\n");
    const double *const e = run.compute_vector();
    const double lost = grains - heat_of_grains(run);
    EXPECT_GT(measured("heat that grains have lost", lost), 1.0);
    EXPECT_NEAR((e[18] - lost) / grains, 0.0, 1e-13);
    EXPECT_NEAR((e[14] - e[15] - e[18]) / lost, 0.0, 1e-10);
    EXPECT_NEAR(e[10] / lost, 0.0, 1e-10);
    // what waits is of the last step, whose length fix dt/reset has changed already
    const double waiting = kind < 2 ? waiting_heat(run) : 0.0;
    EXPECT_NEAR(heat_of_points(run, capacity) + waiting - points - e[15], lost,
                kind < 2 ? 1e-13 * points : 0.02 * lost);
    EXPECT_LT(e[15], 0.0);
  }
}

TEST(Ranks, Agree)
{
  OnRanks run(falling(), "run 200\n");
  EXPECT_LT(run.difference(), 1e-12);
  for (const int k : {14, 15, 18})
    EXPECT_NEAR(run.serial.compute_vector()[k], run.parallel.compute_vector()[k], 1e-10);
  EXPECT_NEAR(run.parallel.fix("heat")->compute_vector(8) /
                  run.serial.fix("heat")->compute_vector(8),
              1.0, 1e-12);
}

TEST(Restart, Continues)
{
  const std::string scene = falling();
  const std::string again = "comm_modify vel yes\nneighbor 0.004 bin\n" +
      fixes("hertz/material 1e5 0.5 0.3 tangential linear_nohistory 0 0.4 heat radius 50",
            "thermal conducting 400 300 20", "grains yes zlo convection 100 300") +
      scene.substr(scene.find("fix floor"));
  const std::string first = replaced(
      again, "fix skin", "fix prop all property/atom temperature heatflow ghost yes\nfix skin");
  Continued run(scene, 200, first, 100);
  EXPECT_LT(difference(run.whole.gather(), run.again.gather()), 1e-13);
  EXPECT_NEAR(run.whole.compute_vector()[18], run.again.compute_vector()[18], 1e-12);
  EXPECT_GT(run.whole.compute_vector()[18], 0.5);
  EXPECT_NEAR(heat_of_grains(run.whole), heat_of_grains(run.again), 1e-11);
}

// points have the temperature of their material, whatever the command set says
SERIAL_TEST(BadInput, IsToldOfTemperaturesThatAreSet)
{
  const auto told = [](const std::string &before, const std::string &between) {
    return times_said(replaced(falling(), "velocity grains", before + "velocity grains") +
                          "run 2\n" + between + "run 2\nrun 2\n",
                      "points have the temperature of their material");
  };
  EXPECT_EQ(told("", ""), 0);
  EXPECT_EQ(told("set group block temperature 300\n", ""), 0);    // as in the material
  EXPECT_EQ(told("set group block temperature 600\n", ""), 1);
  EXPECT_EQ(told("", "set group block temperature 600\n"), 1);
  EXPECT_EQ(told("", "set group grains temperature 600\n"), 0);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = falling();
  expect_error(replaced(scene, "grains yes", "") + "run 1\n", "say grains yes");
  expect_error(replaced(scene, "fix hf grains", "fix hf all") + "run 1\n", "group of the grains");
  expect_error(replaced(scene, "fix hf grains heat/flow constant 500\n", "") + "run 1\n",
               "define a fix heat/flow");
  expect_error(replaced(scene, "heat radius 50", "") + "run 1\n",
               "no heat goes through contacts: give pair_coeff of pair style granular the keyword "
               "heat");
  // atoms of molecular dynamics have no radius
  expect_error(replaced(scene, "diameter 0.02 density", "diameter 0 density") + "run 1\n",
               "none with atoms of molecular dynamics");
  expect_error(plane("lj", "p p", "0 10 0 20", 2, 0.3) +
                   "fix prop all property/atom temperature heatflow ghost yes\n"
                   "fix grid all mpm 1.0\nregion low block INF INF 0 8 INF INF\n"
                   "create_points 1 region low ppc 2\ncreate_atoms 2 single 5 10 0\n"
                   "set type 2 mass 1.0\ngroup one type 1\ngroup two type 2\n"
                   "fix m one mpm/material density 1 neohookean 40 0.3 thermal conducting 1 1 1\n"
                   "pair_style lj/cut 2.5\npair_coeff * * 1.0 1.0\npair_coeff 1 1 0.0 1.0\n"
                   "fix hf two heat/flow constant 1\nfix heat all mpm/heat grains yes\nrun 1\n",
               "none with atoms of molecular dynamics");
  const std::string without =
      replaced(replaced(scene, "heat radius 50", ""),
               "fix prop all property/atom temperature heatflow ghost yes\n", "");
  expect_error(replaced(replaced(without, "set group grains temperature 800\n", ""),
                        "fix hf grains heat/flow constant 500\n", "") +
                   "run 1\n",
               "fix ID all property/atom");
  // a material that does not conduct, next to one that does
  const std::string two = replaced(scene, "fix skin",
                                   "group low id 1\nfix n low mpm/material density 1000 neohookean "
                                   "1e5 0.3 thermal conducting 400 300 20\nfix skin");
  expect_error(replaced(replaced(two,
                                 "fix m block mpm/material density 1000 neohookean 1.0e5 0.3 "
                                 "thermal conducting 400 300 20\n",
                                 ""),
                        "fix skin",
                        "group rest subtract block low\nfix m rest mpm/material density 1000 "
                        "neohookean 1e5 0.3\nfix skin") +
                   "run 300\n",
               "does not conduct");
}

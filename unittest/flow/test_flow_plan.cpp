// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// The step of an incompressible flow without a fix: what stages read and write; points of the fix.

#include "mpm_lammps.h"

#include "base/mpm_rows.h"
#include "flow/mpm_flow.h"

using namespace MPM_TEST;

constexpr double H = 0.1;

/** Water in the lower part of a box, with a velocity that has a divergence. */
std::string water()
{
  return box(2, "si", "f f", "0 1 0 1", 1, 0.02) + "region wet block 0 1 0 0.6 INF INF\n" +
      strprintf("create_points 1 region wet spacing %.17g\n", 0.5 * H) +
      "variable vx atom sin(7*x+3*y)\nvariable vy atom cos(5*x*y)\n"
      "velocity all set v_vx v_vy 0.0\ntimestep 0.01\n";
}

MPMIncompressibleOptions options()
{
  MPMIncompressibleOptions chosen;
  chosen.h = H;
  chosen.density = 1000.0;
  chosen.transfer = MPMIncompressibleOptions::PIC;
  chosen.transfer_is_given = true;
  return chosen;
}

/** A flow that is ready for its first step. */
void start(MPMFlow &flow)
{
  flow.init();
  flow.checks.check_points();
  flow.parts.cells.sort();
  flow.start();
}

// a stage reads points, or what an earlier stage has written
TEST(Plan, StagesReadWhatOthersWrote)
{
  for (const bool gas : {false, true}) {
    Scene scene(water() + "run 0\n");
    auto chosen = options();
    chosen.has_gas = gas;
    chosen.gas_law.p = 1.0e5;
    const MPMRows none;
    MPMFlow flow(scene.lmp, chosen, 1, "w", none);
    start(flow);
    std::set<std::string> known = {"points"}, names;
    for (const auto &stage : flow.plan().list()) {
      EXPECT_TRUE(names.insert(stage.name).second) << stage.name;
      for (const auto &read : stage.reads)
        EXPECT_TRUE(known.count(read)) << stage.name << " " << read;
      EXPECT_FALSE(stage.writes.empty()) << stage.name;
      known.insert(stage.writes.begin(), stage.writes.end());
    }
    EXPECT_EQ(names.count("gas"), gas);
    EXPECT_EQ(flow.plan().list().back().name, "faces to points");
  }
}

TEST(Plan, MovesPointsAsTheFixDoes)
{
  constexpr int STEPS = 4;
  Scene one(water() + "run 0\n"),
      two(water() + "fix w all mpm/incompressible 0.1 1000 transfer pic\n");
  const MPMRows none;
  MPMFlow flow(one.lmp, options(), 1, "w", none);
  start(flow);
  for (int step = 0; step < STEPS; step++) flow.step();
  two.commands(strprintf("run %d\n", STEPS));
  const auto *const mine = one.lmp->atom, *const its = two.lmp->atom;
  ASSERT_EQ(mine->nlocal, its->nlocal);
  ASSERT_GT(mine->natoms, 0);
  std::map<tagint, int> place;
  for (int j = 0; j < its->nlocal; j++) place[its->tag[j]] = j;
  for (int i = 0; i < mine->nlocal; i++) {
    const int j = place.at(mine->tag[i]);
    for (int d = 0; d < 2; d++) {
      EXPECT_NEAR(mine->x[i][d], its->x[j][d], 1e-10);
      EXPECT_NEAR(mine->v[i][d], its->v[j][d], 1e-10);
    }
  }
  EXPECT_LT(flow.results.residual, 1e-8);
}

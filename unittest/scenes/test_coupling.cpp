// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 600

// Bodies in contact, walls, and grains in one run: the same on any number of ranks, after a
// restart, and in any order of the fixes; what is out of reach changes nothing.

#include "mpm_lammps.h"

using namespace MPM_TEST;

static const std::string head = R"(
units lj
boundary p p f
atom_style hybrid sphere mpm
neighbor 0.3 multi
comm_modify vel yes mode multi
region box block 0 10 0 10 0 14
create_box 3 box
)" +
    bodies({{"low", "block 1.5 8.5 1.5 8.5 0 3"}, {"high", "cylinder z 5.1 4.8 2.4 3 6"}},
           "spacing 0.5") +
    R"(
create_atoms 3 single 4.2 4.3 7.1
create_atoms 3 single 6.4 5.7 7.3
create_atoms 3 single 4.9 6.6 7.6
group body type 1 2
group grain type 3
set group grain diameter 2 density 2
velocity high set 0.2 0.1 -0.1
velocity grain set 0.3 0 -0.8
timestep 0.01
)";

static const std::string pair =
    "pair_style granular\npair_coeff * * hooke 50.0 0.5 tangential linear_history 20.0 0.5 0.4\n"
    "neigh_modify exclude group body body\n";

static const std::vector<std::string> fixes = {
    "fix F1 low mpm 1.0\n",
    "fix F2 high mpm 1.0\n",
    "fix m1 low mpm/material density 1.0 neohookean 40.0 0.3\n",
    "fix m2 high mpm/material density 1.0 neohookean 30.0 0.3\n",
    "fix c all mpm/contact F1 F2 law coulomb 0.3\n",
    "fix floor all mpm/boundary zlo stick\n",
    "fix surf body mpm/surface\n",
    "fix move grain nve/sphere\n",
    "fix g all gravity 0.05 vector 0 0 -1\n",
};

static std::string all_fixes()
{
  std::string text;
  for (const auto &fix : fixes) text += fix;
  return text;
}

TEST(Coupling, IsTheSameOnAnyNumberOfRanks)
{
  OnRanks both(head + all_fixes() + pair, "run 200\n");
  EXPECT_LT(measured("difference", both.difference()), 1.0e-10);
  auto &run = both.serial;
  EXPECT_NE(run.evaluate("f_c[1][3]"), 0.0);        // the bodies push on each other
  EXPECT_GT(run.evaluate("vcm(grain,z)"), -0.3);    // the grains have hit
}

// without history of the contacts, which has its own test: test_restart_grains.py
TEST(Coupling, GoesOnFromARestartFile)
{
  const std::string no_history = replaced(pair, "linear_history 20.0", "linear_nohistory");
  Continued run(head + all_fixes() + no_history, 120,
                "neighbor 0.3 multi\ncomm_modify vel yes mode multi\n" + all_fixes() + no_history,
                80);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

// the fixes in their order, reversed, and rotated: sums may be in another order, no more
TEST(Coupling, OrderOfFixesDoesNotMatter)
{
  std::vector<Scene::State> reference;
  const int n = (int) fixes.size();
  for (int shift = -1; shift < n; shift += 2) {
    std::string text = head;
    for (int k = 0; k < n; k++)
      text += shift < 0 ? fixes[n - 1 - k] : fixes[(k + shift + n - 1) % n];
    Scene run(text + pair + "run 150\n");
    const auto state = run.gather();
    if (reference.empty()) reference = state;
    EXPECT_LT(measured("difference", difference(state, reference)), 1.0e-10) << text;
  }
}

// grains that bounce out of reach: bodies and grains move as without the others, to the last bit
SERIAL_TEST(Coupling, OutOfReachIsNoCoupling)
{
  const std::string away = "displace_atoms grain move 0 0 5\nvelocity grain set 0 0 0\n"
                           "velocity grain ramp vx 0.5 -0.5 x 4 7\n";
  // lists renewed, and with them points sorted, at the same steps
  const auto state = [&](const std::string &text, int steps) {
    Scene run(text + "neigh_modify every 5 delay 0 check no\nrun " + std::to_string(steps) + "\n");
    return run.gather();
  };
  std::string bodies = head, without;
  for (const auto &fix : fixes)
    if (fix.find("gravity") == std::string::npos && fix.find("nve/sphere") == std::string::npos)
      without += fix;
  auto both = state(head + without + "fix move grain nve/sphere\n" + pair + away, 150);
  auto alone = state(head + without + "delete_atoms group grain compress no\n", 150);
  std::vector<Scene::State> grains, points;
  for (const auto &s : both) (s.type == 3 ? grains : points).push_back(s);
  ASSERT_EQ(grains.size(), 3u);
  EXPECT_TRUE(identical(points, alone));
  auto dem = state(
      head + "delete_atoms group body compress no\nfix move grain nve/sphere\n" + pair + away, 150);
  ASSERT_EQ(dem.size(), 3u);
  bool met = false;
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 3; d++) {
      EXPECT_EQ(dem[i].x[d], grains[i].x[d]);
      EXPECT_EQ(dem[i].v[d], grains[i].v[d]);
      met = met || (d == 1 && grains[i].v[d] != 0.0);
    }
  EXPECT_TRUE(met);
}

// A block on a plane, on a spring: Coulomb friction takes 2 mu m g/k from the amplitude in each
// half cycle, whatever the amplitude, and leaves the block within mu m g/k of the rest position.
SERIAL_TEST(Friction, OscillationDecaysLinearly)
{
  const double mass = 500.0, gravity = 9.81, mu = 0.1, omega = 2.0 * M_PI / 0.4;
  const double k = mass * omega * omega, drop = 2.0 * mu * mass * gravity / k;
  for (const char *transfer : first_of(1, {"apic", "flip 1.0"})) {
    SCOPED_TRACE(transfer);
    Scene run(plane("si", "f f", "0 2 0 1.5 -0.05 0.05", 2) +
              fields({{"plane", "block 0 2 0 0.5 -0.05 0.05"},
                      {"body", "block 0.5 1.5 0.5 1.0 -0.05 0.05"}},
                     std::string("0.1 transfer ") + transfer) +
              R"(
fix m1 plane mpm/material density 1000 neohookean 4.2e7 0.4
fix m2 body mpm/material density 1000 neohookean 4.2e6 0.4
fix floor all mpm/boundary ylo stick field F1
fix sides all mpm/boundary xlo xhi slip field F1
fix c all mpm/contact F1 F2 law coulomb 0.1
fix g body gravity 9.81 vector 0 -1 0
fix dt all mpm/dt 0.5
variable x equal xcm(body,x)
run 3000
)");
    run.commands(strprintf("variable rest equal %.17g\n", run.evaluate("v_x") - 0.05) +
                 strprintf("variable f equal %.17g*(v_rest-xcm(body,x))\n", k / 200.0) +
                 "fix spring body addforce v_f 0 0\nrun 0\n");
    ASSERT_EQ(run.evaluate("count(body)"), 200.0);
    std::vector<double> turns;
    double before = run.evaluate("v_x-v_rest"), last = 0.0;
    for (int n = 0; n < 450; n++) {
      run.commands("run 20 pre no post no\n");
      const double u = run.evaluate("v_x-v_rest");
      if ((u - before) * last < 0.0 && fabs(before) > 1.2 * drop) turns.push_back(before);
      last = u - before;
      before = u;
    }
    ASSERT_GE(turns.size(), 3u);
    double sum = fabs(turns[0]) - fabs(turns.back());
    EXPECT_NEAR(measured("first turn, loss/exact", (0.05 - fabs(turns[0])) / drop), 1.0, 0.06);
    EXPECT_NEAR(measured("loss per half cycle/exact", sum / (turns.size() - 1) / drop), 1.0, 0.06);
    EXPECT_LT(turns[0] * turns[1], 0.0);
    EXPECT_LT(fabs(before), 0.55 * drop);    // at rest
    EXPECT_LT(fabs(last), 1.0e-5);
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi ranks
// mpi: 1 4
// timeout: 300

// Walls that move in each way that they can: force, torque, and work are what the material gets.

#include "mpm_lammps.h"

#include "stl_testing.h"

using namespace MPM_TEST;

/** What a wall is expected to work: with the velocity V that all of it has, without or with
 *  friction, or by its torque about an axis along z through a point. */
enum Work { TRANSLATES, RUBS, TURNS, OTHER };

struct Motion {
  const char *name, *options, *walls;
  Work work;
  double V[3];             ///< velocity of the wall w; the others are at rest
  double rate = 0.0;       ///< its angular velocity about an axis along z
  double o[2] = {0, 0};    ///< place of this axis
  friend void PrintTo(const Motion &m, std::ostream *out) { *out << m.name; }
};

const Motion motions[] = {
    {"face", "", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"components", "", "w xlo stick velocity 0.4 NULL NULL", TRANSLATES, {0.4, 0, 0}},
    {"linear", "shape linear", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"cubic", "shape cubic", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"slip", "", "w xlo slip velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"cut",
     "origin 0.3 0.4 0.2",
     "w xlo stick velocity 0.4 0.1 -0.2",
     TRANSLATES,
     {0.4, 0.1, -0.2}},
    {"cut-turns",
     "origin 0.3 0.4 0.2",
     "w xlo stick rotate 0 3 4 0 0 1 0.1",
     TURNS,
     {0, 0, 0},
     0.1,
     {0, 3}},
    {"face-turns", "", "w xlo stick rotate 0 3 4 0 0 1 0.1", TURNS, {0, 0, 0}, 0.1, {0, 3}},
    {"displaced", "", "w xlo stick displacement v_way NULL NULL", TRANSLATES, {0.4, 0, 0}},
    {"flip",
     "transfer flip 1.0",
     "w xlo stick velocity 0.4 0.1 -0.2",
     TRANSLATES,
     {0.4, 0.1, -0.2}},
    {"musl", "scheme musl", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"total", "frame total", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"total-region",
     "frame total",
     "w region held stick displacement v_way NULL NULL",
     TRANSLATES,
     {0.4, 0, 0}},
    {"total-turns",
     "frame total",
     "w region held stick rotate 0 3 4 0 0 1 0.1",
     TURNS,
     {0, 0, 0},
     0.1,
     {0, 3}},
    {"region", "", "w region grip stick", TRANSLATES, {0.4, 0, -0.2}},
    {"region-slip", "", "w region ball slip", TRANSLATES, {0.4, 0, -0.2}},
    {"region-rubs", "", "w region ball slip friction 0.2", RUBS, {0.4, 0, -0.2}},
    {"region-separate", "", "w region ball separate", TRANSLATES, {0.4, 0, -0.2}},
    {"region-grates", "", "w region ball separate friction 0.2", RUBS, {0.4, 0, -0.2}},
    {"region-velocity",
     "",
     "w region held stick velocity 0.4 0.1 -0.2",
     TRANSLATES,
     {0.4, 0.1, -0.2}},
    {"region-rotate",
     "",
     "w region held stick rotate 0 3 4 0 0 1 0.1",
     TURNS,
     {0, 0, 0},
     0.1,
     {0, 3}},
    {"turning", "", "w region paddle stick", TURNS, {0, 0, 0}, 0.3, {1, 3}},
    {"turning-slip", "", "w region paddle slip", TURNS, {0, 0, 0}, 0.3, {1, 3}},
    {"turning-separate", "", "w region paddle separate", TURNS, {0, 0, 0}, 0.3, {1, 3}},
    {"tool", "", "w region tool stick", TRANSLATES, {0.4, 0, -0.2}},
    {"tool-slip", "", "w region tool slip", TRANSLATES, {0.4, 0, -0.2}},
    {"tool-separate", "", "w region tool separate friction 0.2", RUBS, {0.4, 0, -0.2}},
    {"tool-velocity",
     "",
     "w region still stick velocity 0.4 0.1 -0.2",
     TRANSLATES,
     {0.4, 0.1, -0.2}},
    {"metal", "", "w xlo stick velocity 0.4 0.1 -0.2", TRANSLATES, {0.4, 0.1, -0.2}},
    {"metal-region", "", "w region ball slip", TRANSLATES, {0.4, 0, -0.2}},
    {"grows", "", "w region swelling slip", OTHER, {0, 0, 0}},
    {"two",
     "",
     "w region grip stick\nfix w2 all mpm/boundary ylo slip friction 0.1",
     TRANSLATES,
     {0.4, 0, -0.2}},
};

// Force and torque are the changes of momentum and angular momentum, and work is that of the force
// along the way of the wall, not the sums of the fix over nodes. The ledger has the same work
PARAMETER_TEST(Balance, OfMovingWalls, Motion, ValuesIn(motions))
{
  const auto &c = GetParam();
  const std::string options = c.options, name = c.name;
  const ScratchFile ball("ball.stl", ball_stl(8));
  const double dt = 0.02;
  const bool flip = options.find("flip") != std::string::npos;
  Scene run(space(name.find("metal") == 0 ? "metal" : "lj", "f f f", "0 10 0 8 0 8", 1, 0.3) +
            body("block 0.5 5 0.5 4 2 6", "density 1.5 neohookean 10.0 0.3",
                 "1.0 " + (flip ? options : "transfer apic " + options)) +
            "variable way equal 0.4*time\nvariable sink equal -0.2*time\n"
            "variable turn equal 0.3*time\nvariable r equal 1.2+0.3*time\n"
            "region held block 0 2 0 8 0 8\n"
            "region grip block -1 1.6 -1 9 -1 9 move v_way NULL v_sink\n"
            "region ball sphere 0.2 2.2 4.1 1.3 move v_way NULL v_sink\n"
            "region paddle block -1 1.6 -1 9 -1 9 rotate v_turn 1 3 4 0 0 1\n"
            "region swelling sphere 0.2 2.2 4.1 v_r\nregion tool mpm/mesh " +
            ball.name + " 1.3 0.2 2.2 4.1 move v_way NULL v_sink\nregion still mpm/mesh " +
            ball.name + " 1.3 1.2 2.2 4.1\nfix " + replaced(c.walls, "w ", "w all mpm/boundary ") +
            "\nvelocity all set -0.3 -0.2 0.1\nvelocity all ramp vx -0.2 0.2 y 0 4 sum yes\n" +
            strprintf("timestep %g\n", dt) +
            "compute e all mpm/energy\nthermo_style custom step c_e\nrun 0\n");
  const double per_force = dt * run.lmp->force->ftm2v;
  auto *const wall = run.fix("w");
  const auto walls = run.lmp->modify->get_fix_by_style("^mpm/boundary$");
  const auto momenta = [&] {
    const auto s = run.sums();
    return over_ranks({s.p[0], s.p[1], s.p[2], s.L[0], s.L[1], s.L[2]});
  };
  auto expected = momenta();
  double work = 0.0, impulse = 0.0;
  for (int step = 0; step < 50; step++) {
    run.commands("run 1\n");
    for (auto *fix : walls)
      for (int d = 0; d < 6; d++) expected[d] -= per_force * fix->compute_vector(d);
    const double *const f = run.fix_vector("w", 6);
    for (int d = 0; d < 3; d++) {
      work -= dt * f[d] * c.V[d];
      impulse += per_force * std::fabs(f[d]);
    }
    work -= dt * c.rate * (f[5] - c.o[0] * f[1] + c.o[1] * f[0]);
  }
  EXPECT_GT(impulse, 10.0);
  const auto end = momenta();
  // FLIP, linear functions, MUSL, and the total frame keep no angular momentum by themselves
  for (int d = 0; d < (options.empty() || options[0] == 'o' || options == "shape cubic" ? 6 : 3);
       d++)
    EXPECT_NEAR(end[d], expected[d], 1e-11 * impulse) << d;

  const double told = wall->compute_scalar();
  if (c.work == TRANSLATES) EXPECT_NEAR(told, work, 1e-11 * std::fabs(work));
  // a step is along the chord of an arc
  if (c.work == TURNS) EXPECT_NEAR(told, work, 0.002 * std::fabs(work));
  // friction takes from it
  if (c.work == RUBS) EXPECT_LT(told, 0.97 * work);
  double all = 0.0;
  for (auto *fix : walls) all += fix->compute_scalar();
  const double *const e = run.compute_vector();
  EXPECT_NEAR(e[6], all, 1e-11 * std::fabs(all));
  EXPECT_NEAR(e[10], 0.0, 1e-11 * std::fabs(all));
}

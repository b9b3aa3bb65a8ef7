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

using Vector = std::array<double, 3>;
constexpr Vector GIVEN = {0.4, 0.1, -0.2}, ALONG_X = {0.4, 0, 0}, MOVED = {0.4, 0, -0.2}, NONE = {};
/** Angular velocity about an axis along z, and the place of this axis. */
struct Turn {
  double rate = 0.0, o[2] = {0, 0};
};
constexpr Turn SLOWLY = {0.1, {0, 3}}, WITH_REGION = {0.3, {1, 3}};

/** walls: VELOCITY and ROTATE are the options of GIVEN and SLOWLY. V, turn: of w; others are
 *  at rest. */
struct Motion {
  const char *name, *options, *walls;
  Work work;
  Vector V;
  Turn turn = {};
  friend void PrintTo(const Motion &m, std::ostream *out) { *out << m.name; }
};

const Motion motions[] = {
    {"face", "", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"components", "", "w xlo stick velocity 0.4 NULL NULL", TRANSLATES, ALONG_X},
    {"linear", "shape linear", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"cubic", "shape cubic", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"slip", "", "w xlo slip VELOCITY", TRANSLATES, GIVEN},
    {"cut", "origin 0.3 0.4 0.2", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"cut-turns", "origin 0.3 0.4 0.2", "w xlo stick ROTATE", TURNS, NONE, SLOWLY},
    {"face-turns", "", "w xlo stick ROTATE", TURNS, NONE, SLOWLY},
    {"displaced", "", "w xlo stick displacement v_way NULL NULL", TRANSLATES, ALONG_X},
    {"flip", "transfer flip 1.0", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"musl", "scheme musl", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"total", "frame total", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"total-region", "frame total", "w region held stick displacement v_way NULL NULL", TRANSLATES,
     ALONG_X},
    {"total-turns", "frame total", "w region held stick ROTATE", TURNS, NONE, SLOWLY},
    {"region", "", "w region grip stick", TRANSLATES, MOVED},
    {"region-slip", "", "w region ball slip", TRANSLATES, MOVED},
    {"region-rubs", "", "w region ball slip friction 0.2", RUBS, MOVED},
    {"region-separate", "", "w region ball separate", TRANSLATES, MOVED},
    {"region-grates", "", "w region ball separate friction 0.2", RUBS, MOVED},
    {"region-velocity", "", "w region held stick VELOCITY", TRANSLATES, GIVEN},
    {"region-rotate", "", "w region held stick ROTATE", TURNS, NONE, SLOWLY},
    {"turning", "", "w region paddle stick", TURNS, NONE, WITH_REGION},
    {"turning-slip", "", "w region paddle slip", TURNS, NONE, WITH_REGION},
    {"turning-separate", "", "w region paddle separate", TURNS, NONE, WITH_REGION},
    {"tool", "", "w region tool stick", TRANSLATES, MOVED},
    {"tool-slip", "", "w region tool slip", TRANSLATES, MOVED},
    {"tool-separate", "", "w region tool separate friction 0.2", RUBS, MOVED},
    {"tool-velocity", "", "w region still stick VELOCITY", TRANSLATES, GIVEN},
    {"metal", "", "w xlo stick VELOCITY", TRANSLATES, GIVEN},
    {"metal-region", "", "w region ball slip", TRANSLATES, MOVED},
    {"grows", "", "w region swelling slip", OTHER, NONE},
    {"two", "", "w region grip stick\nfix w2 all mpm/boundary ylo slip friction 0.1", TRANSLATES,
     MOVED},
};

// Force and torque are the changes of momentum and angular momentum, and work is that of the force
// along the way of the wall, not the sums of the fix over nodes. The ledger has the same work
PARAMETER_TEST(RegionBalance, OfMovingWalls, Motion, ValuesIn(motions))
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
            ball.name + " 1.3 1.2 2.2 4.1\nfix " +
            replaced(replaced(replaced(c.walls, "w ", "w all mpm/boundary "), "VELOCITY",
                              "velocity 0.4 0.1 -0.2"),
                     "ROTATE", "rotate 0 3 4 0 0 1 0.1") +
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
    work -= dt * c.turn.rate * (f[5] - c.turn.o[0] * f[1] + c.turn.o[1] * f[0]);
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

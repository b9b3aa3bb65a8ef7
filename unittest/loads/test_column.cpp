// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/column, and the free field that fix mpm/dashpot takes from it: level ground that is
// shaken moves as in one dimension everywhere, also next to its sides.

#include "mpm_lammps.h"

#include <regex>

using namespace MPM_TEST;

// soil of 200 m/s, and of a quarter of its stiffness above 12 m, on rock of 3.5 times the speed
const std::string GROUND = "variable E equal 2000*200^2*2.5\n";
const std::string SIDE = " 346.41 200 ";

/** Level ground, 20 m high, from -10 to 10 m, a column of this width at 14 m; waves at the base. */
std::string site(const std::string &options, bool shear, double width = 2.0)
{
  return plane("si", "f f", "-20 20 0 24", 2, 0.3) + "group soil empty\ngroup column empty\n" +
      "fix grid soil mpm 1.0 " + options + "\nfix far column mpm 1.0 " + options +
      "\nregion ground block -10 10 0 20 INF INF\n" +
      strprintf("region strip block 14 %.17g 0 20 INF INF\n", 14.0 + width) +
      "create_points 1 region ground ppc 2 fix grid group soil\n"
      "create_points 1 region strip ppc 2 fix far group column\n"
      "region upper block INF INF 12 INF INF INF\nset region upper type 2\n"
      "group upper type 2\ngroup lower type 1\n" +
      GROUND + "fix free all mpm/column far y\nregion base plane 0 0 0 0 1 0\n" +
      "variable v equal 0.01*sin(5*PI*time)*(1-exp(-10.0*time*time))\n"
      "fix rock all mpm/dashpot region base 1212 700 density 2286 incoming " +
      (shear ? "v_v 0 0\n" : "0 v_v 0\n") +
      "region left plane -10 0 0 1 0 0\nregion right plane 10 0 0 -1 0 0\n";
}
const std::string LAYERS = "fix m lower mpm/material density 2000 linear $E 0.25\n"
                           "fix m2 upper mpm/material density 1800 linear $(v_E/4) 0.25\n";
const std::string FREE = "fix left soil mpm/dashpot region left" + SIDE + "column free\n" +
    "fix right soil mpm/dashpot region right" + SIDE + "column free\n";
const std::string PLAIN = "fix left soil mpm/dashpot region left" + SIDE + "\n" +
    "fix right soil mpm/dashpot region right" + SIDE + "\n";
const std::string FIXED =
    "region l block INF -10 INF INF INF INF\nregion r block 10 INF INF INF INF INF\n"
    "fix left all mpm/boundary region l stick field grid\n"
    "fix right all mpm/boundary region r stick field grid\n";

/** Mean velocity along an axis of points between two places along x, above a height. */
double velocity(Scene &run, int axis, double low, double high, double above)
{
  double sum = 0.0, n = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *const x = run.x()[i];
    if (x[0] < low || x[0] > high || x[1] < above) continue;
    sum += run.v()[i][axis];
    n += 1.0;
  }
  return sum / n;
}

/** Largest difference of ground and column at the surface: sides and middle, relative. */
double difference(Scene &run, int axis, int steps, double top = 19.0)
{
  double most = 0.0, off = 0.0;
  for (int k = 0; k < steps / 10; k++) {
    run.commands("run 10 post no\n");
    const double free = velocity(run, axis, 13.0, 30.0, top);
    grow(most, free);
    for (const double x : {-10.0, -0.5, 9.0})
      grow(off, velocity(run, axis, x, x + 1.0, top) - free);
  }
  return off / most;
}

// Level ground in two layers moves like its column to 1 %, but not with a far side at rest or walls
struct Sides {
  const char *options;
  bool shear;
  friend void PrintTo(const Sides &s, std::ostream *out)
  {
    *out << s.options << (s.shear ? " shear" : " pressure");
  }
};
PARAMETER_TEST(Level, MovesInOneDimension, Sides,
               Values(Sides{"transfer aflip 1.0", true}, Sides{"transfer aflip 1.0", false},
                      Sides{"", true}, Sides{"frame total transfer flip 1.0", true},
                      Sides{"shape cubic", true}, Sides{"scheme musl", false}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &p = GetParam();
  const int axis = p.shear ? 0 : 1;
  Scene run(site(p.options, p.shear) + LAYERS + FREE + "timestep 1e-3\n");
  EXPECT_LT(measured("ground against column", difference(run, axis, 1500)), 0.01);
}
SERIAL_TEST(Level, NeedsTheFreeField)
{
  for (const auto &sides : {PLAIN, FIXED}) {
    Scene run(site("transfer aflip 1.0", true) + LAYERS + sides + "timestep 1e-3\n");
    EXPECT_GT(measured("ground against column", difference(run, 0, 1500)), 0.5);
  }
}

// The column is a periodic strip of ground of any width and laws; walls see single lines of nodes
SERIAL_TEST(Column, IsAStripWithoutEnd)
{
  const std::string free = "velocity all ramp vx 0 1 y 0 20\n"
                           "velocity all ramp vy 0 0.5 y 0 20 sum yes\ntimestep 1e-3\n";
  const std::string held =
      "variable v equal 0.5*sin(5*PI*time)\nvariable w equal 0.2*sin(3*PI*time)\n"
      "fix base all mpm/boundary ylo stick velocity v_v v_w 0\ntimestep 1e-3\n";
  const std::string rock = "region base plane 0 0 0 0 1 0\nvariable v equal 0.5*sin(5*PI*time)\n"
                           "variable w equal 0.2*sin(3*PI*time)\ntimestep 1e-3\n"
                           "fix rock all mpm/dashpot region base 1212 700 incoming v_v v_w 0\n";
  for (const auto &rest : {free, held, rock}) {
    for (const char *options : {"", "transfer flip 1.0", "transfer flip 1.0 scheme musl"}) {
      const std::string extent = rest == free ? "-4 24" : "0 24";
      const std::string soil = "fix m all mpm/material density 2000 linear 2e8 0.25\n" + rest;
      Scene strip(
          plane("si", "p f", "0 4 " + extent, 1, 0.3) + "fix far all mpm 1.0 " + options +
          "\nregion strip block INF INF 0 20 INF INF\ncreate_points 1 region strip ppc 2\n" + soil);
      // at another place in its cells
      Scene column(plane("si", "f f", "0 24 " + extent, 1, 0.3) + "fix far all mpm 1.0 " + options +
                   "\nregion strip block 14 15.5 0 20 INF INF\ncreate_points 1 region strip ppc 2\n"
                   "displace_atoms all move 0.3 0 0\nfix free all mpm/column far y\n" +
                   soil);
      double off = 0.0, most = 0.0;
      for (int k = 0; k < 20; k++) {
        strip.commands("run 20 post no\n");
        column.commands("run 20 post no\n");
        for (int d = 0; d < 2; d++) {
          const double v = velocity(strip, d, -1.0, 30.0, 18.0);
          grow(most, v);
          grow(off, v - velocity(column, d, -1.0, 30.0, 18.0));
        }
      }
      EXPECT_GT(most, 0.1);
      EXPECT_LT(measured("column against strip", off / most),
                rest == free       ? 1e-9
                    : rest == held ? 1e-5
                                   : 1e-3);
    }
  }
}

// One layer on rock, in the steady state, against the exact amplification: everywhere
SERIAL_TEST(Level, AmplifiesTheRock)
{
  const double z = 0.25, H = 20.0, c = 200.0, kH = 10.0 * H / c;
  Scene run(replaced(site("transfer aflip 1.0", true), "5*PI", "10") +
            "fix m all mpm/material density 2000 linear $E 0.25\n" + FREE +
            "timestep 1e-3\nrun 2000\n");
  double most[4] = {};
  for (int k = 0; k < 130; k++) {
    run.commands("run 5 post no\n");
    const double x[4] = {-10.0, -0.5, 9.0, 14.0};
    for (int j = 0; j < 4; j++)
      grow(most[j], velocity(run, 0, x[j], x[j] + (j < 3 ? 1.0 : 2.0), 19.0));
  }
  // the mean over the first cell is that of points 1/4 and 3/4 below the surface
  const double k = kH / H, mean = 0.5 * (cos(0.25 * k) + cos(0.75 * k));
  const double exact = 0.02 * mean / sqrt(cos(kH) * cos(kH) + z * z * sin(kH) * sin(kH));
  for (const double v : most) EXPECT_NEAR(measured("top over exact", v / exact), 1.0, 0.02);
}

// Ground that yields, under its weight: the stress of the column comes to the sides
SERIAL_TEST(Level, YieldsLikeItsColumn)
{
  Scene run(replaced(site("transfer aflip 1.0", true), "0.01*", "0.5*") +
            "fix m all mpm/material density 2000 mohr/coulomb 2e8 0.25 30 1e4\n"
            "fix g all gravity 9.81 vector 0 -1 0\n" +
            "region lw block INF -10 INF INF INF INF\nregion rw block 10 INF INF INF INF INF\n"
            "fix floor all mpm/boundary ylo stick\n"
            "fix lw all mpm/boundary region lw slip field grid\n"
            "fix rw all mpm/boundary region rw slip field grid\nmpm_geostatic grid 0.5\n"
            "mpm_geostatic far 0.5\ntimestep 1e-3\nunfix floor\nunfix lw\nunfix rw\n" +
            FREE + "compute p all mpm/atom eplastic\ncompute most all reduce max c_p\n");
  EXPECT_LT(measured("ground against column", difference(run, 0, 800)), 0.02);
  EXPECT_GT(measured("plastic strain", run.compute_scalar("most")), 1e-3);
}

// Layers of points of the column are not at the heights of those of the ground
SERIAL_TEST(Level, OtherPointsInTheColumn)
{
  Scene run(replaced(site("transfer aflip 1.0", true), "strip ppc 2", "strip ppc 3") + LAYERS +
            FREE + "timestep 1e-3\n");
  EXPECT_LT(measured("ground against column", difference(run, 0, 1000)), 0.01);
}

// Forces of the free field hold the ground: those of both sides cancel but for the moment
SERIAL_TEST(Level, ForcesAndWork)
{
  Scene run(site("transfer aflip 1.0 gain error 0.05", true) + LAYERS + FREE +
            "compute e all mpm/energy\nthermo_style custom step c_e\ntimestep 1e-3\nrun 300\n");
  // shear stress of the column times the height
  double stress = 0.0;
  for (int i = 0; i < run.n(); i++)
    if (run.x()[i][0] > 12.0) stress += run.points().tau[i][3] * 0.25 / 2.0;
  const double *const left = run.fix_vector("left", 7), on_left = left[1];
  const double *const right = run.fix_vector("right", 7), on_right = right[1];
  EXPECT_GT(std::fabs(stress), 1e4);
  EXPECT_NEAR(measured("force over that of the column", on_right / stress), 1.0, 0.001);
  EXPECT_NEAR(measured("left over right", on_left / on_right), -1.0, 2e-5);
  run.lmp->modify->get_compute_by_id("e")->compute_scalar();
  const double *const e = run.compute_vector();
  EXPECT_NEAR(measured("residual", e[10] / (e[0] + e[1])), 0.0, 1e-11);
  // the energy watch knows the work at the sides: it tells transfer and integration of the ledger
  const double before = e[8] + e[9];
  const auto text = log_of(run, "run 1200\n");
  run.lmp->modify->get_compute_by_id("e")->compute_scalar();
  const std::regex energy("friction took ([-+.e0-9]+) .*numerical errors added ([-+.e0-9]+)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found, energy));
  const double added = std::stod(found[2]) - std::stod(found[1]);
  EXPECT_NEAR(measured("watch less ledger", (added - (e[8] + e[9] - before)) / (e[0] + e[1])), 0.0,
              0.015);
  // all that came in came through the base
  EXPECT_NEAR(measured("work over energy", e[6] / (e[0] + e[1])), 1.0, 0.03);
}

// In 3d, with numbers in other units: shear along y of ground that stands along z
SERIAL_TEST(Level, InSpaceAndOtherUnits)
{
  const auto ground = [](const std::string &units) {
    return space(units, "f p f", "-5 9 0 2 0 12", 1, 0.3) +
        "group soil empty\ngroup column empty\nfix grid soil mpm 1.0 transfer aflip 1.0\n"
        "fix far column mpm 1.0 transfer aflip 1.0\nregion ground block -3 3 INF INF 0 10\n"
        "region strip block 6 7 INF INF 0 10\n"
        "create_points 1 region ground ppc 2 fix grid group soil\n"
        "create_points 1 region strip ppc 2 fix far group column\n"
        "fix free all mpm/column far z\nregion base plane 0 0 0 0 0 1\n"
        "region left plane -3 0 0 1 0 0\nregion right plane 3 0 0 -1 0 0\n";
  };
  Scene probe(
      ground("metal"));    // mass density and stress in its units, for speeds 1 and 1.7 A/ps
  const double unit = probe.lmp->force->mvv2e, rho = 2.0,
               E = 2.5 * rho * unit * probe.lmp->force->nktv2p;
  Scene run(ground("metal") +
            strprintf("fix m all mpm/material density %.17g linear %.17g 0.25\n", rho, E) +
            "variable v equal 1e-4*sin(0.15*time)*(1-exp(-0.01*time*time))\n"
            "fix rock all mpm/dashpot region base 3.5 2.0 incoming 0 v_v 0\n"
            "fix left soil mpm/dashpot region left 1.7320508 1.0 column free\n"
            "fix right soil mpm/dashpot region right 1.7320508 1.0 column free\ntimestep 0.25\n");
  double most = 0.0, off = 0.0;
  for (int k = 0; k < 12; k++) {
    run.commands("run 20 post no\n");
    const auto mean = [&](double low, double high) {
      double sum = 0.0, n = 0.0;
      for (int i = 0; i < run.n(); i++)
        if (run.x()[i][0] > low && run.x()[i][0] < high && run.x()[i][2] > 9.0) {
          sum += run.v()[i][1];
          n += 1.0;
        }
      return sum / n;
    };
    grow(most, mean(5.0, 8.0));
    grow(off, mean(-3.0, -2.0) - mean(5.0, 8.0));
    grow(off, mean(2.0, 3.0) - mean(5.0, 8.0));
  }
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(measured("ground against column", off / most), 1e-10);
}

TEST(Column, RanksAndRestart)
{
  for (const char *options : {"", "frame total transfer flip 1.0"}) {
    const auto scene = site(options, true);
    const auto fixes = scene.substr(scene.find("fix rock")) + LAYERS + FREE;
    const auto start = scene.substr(0, scene.find("fix rock")) + "timestep 1e-3\n";
    OnRanks run(start + fixes, "run 100\n");
    EXPECT_LT(measured("difference to one rank", run.difference()), 1e-10);
    OnRanks even(start + fixes, "run 100\n", "comm_style tiled\nfix even all balance 20 1.0 rcb\n");
    EXPECT_LT(measured("difference to one rank, balanced", even.difference()), 1e-10);
    // what a restart file does not keep
    std::string next = "neighbor 0.3 bin\n" + start.substr(start.find("fix grid"));
    for (const char *line : {"create_points 1 region ground ppc 2 fix grid group soil\n",
                             "create_points 1 region strip ppc 2 fix far group column\n",
                             "set region upper type 2\ngroup upper type 2\ngroup lower type 1\n"})
      next = replaced(next, line, "");
    Continued again(start + fixes, 40, next + fixes, 60);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    for (const char *id : {"left", "right", "rock"})
      for (int k = 0; k < 7; k++)
        EXPECT_EQ(again.whole.fix(id)->compute_vector(k), again.again.fix(id)->compute_vector(k));
  }
}

SERIAL_TEST(Column, BadInput)
{
  const auto all = site("", true);
  const auto start = all.substr(0, all.find("fix free")) + LAYERS +
      "region left plane -10 0 0 1 0 0\nregion slope plane -10 0 0 1 0.2 0\n";
  const std::string free = "fix free all mpm/column far y\n",
                    side = "fix left soil mpm/dashpot region left" + SIDE;
  expect_refused(
      start,
      {{"fix free all mpm/column", "missing argument"},
       {"fix free all mpm/column far z", "must be one of x y"},
       {"fix free soil mpm/column far y", "use group all"},
       {"fix free all mpm/column none y", "no fix mpm with the ID none"},
       {side + "column free", "no fix mpm/column with the ID free before it"},
       {side + "column free\n" + free, "no fix mpm/column with the ID free before it"},
       {"fix free all mpm/dt 0.5\n" + side + "column free", "no fix mpm/column with the ID free"},
       {free + side + "column free incoming 0.1 0 0", "remove incoming here"},
       {free + "fix left soil mpm/dashpot region slope" + SIDE + "column free area 20",
        "not parallel to the column"},
       {"fix free all mpm/column far x\n" + side + "column free", "not parallel to the column"},
       {free + "displace_atoms column move 0 2 0\n" + side + "column free",
        "as high as the column"},
       {free + "unfix far", "no fix mpm with the ID far"},
       {"delete_atoms group column compress no\n" + free, "no material points"}},
      "timestep 1e-4\nrun 1\n");
  expect_refused(replaced(start, "fix far column mpm 1.0", "fix far column mpm 1.0 frame total"),
                 {{free + side + "column free", "use the same frame"}}, "timestep 1e-4\nrun 1\n");
  expect_refused(replaced(start, "boundary f f p", "boundary p f p"),
                 {{"fix free all mpm/column far x", "where the box is periodic"}},
                 "timestep 1e-4\nrun 1\n");
}

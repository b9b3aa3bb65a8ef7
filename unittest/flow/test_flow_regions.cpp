// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/incompressible with regions that are solid: floors, containers, bodies that move.

#include "mpm_lammps.h"

#include "flow/fix_mpm_incompressible.h"
#include "flow/mpm_flow_cut_cell.h"

using namespace MPM_TEST;

/** Entries of the vector of the fix; from REGIONS on three for each region. */
enum { FILLED = 3, KINETIC = 5, FASTEST, WALLS, REGIONS = 14 };

double entry(Scene &run, int k)
{
  return run.fix("w")->compute_vector(k);
}

/** Water up to the height 0.7 over an inclined floor, around a ball that is at rest. */
std::string floor_and_ball(int dim, int n, const std::string &options)
{
  const double h = 1.0 / n;
  return box(dim, "si", "f f f", "0 1 0 1 0 1", 1, 0.02) +
      (dim == 3
           ? "region ramp plane 0.5 0.2131 0.5 0.3 -1 0.1\nregion ball sphere 0.6 0.46 0.47 0.143\n"
           : "region ramp plane 0.5 0.2131 0 0.3 -1 0\nregion ball sphere 0.6 0.46 0 0.143\n") +
      "region solid union 2 ramp ball side out\nregion water block INF INF INF 0.7 INF INF\n"
      "region fluid intersect 2 water solid\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 * h) +
      strprintf("fix w all mpm/incompressible %.17g 1000 region ramp region ball ", h) + options +
      "\nfix g all gravity 9.81 vector 0 -1 0\n";
}

/** Water between a cylinder or sphere of radius 0.2, which begins to move with the speed 0.1, and a
 *  container of radius 0.47. */
std::string gap(int dim, int n, double dt)
{
  const char *const center = dim == 3 ? "0.503 0.511 0.49" : "0.503 0.511 0";
  return box(dim, "si", "f f f", "0 1 0 1 0 1", 1, 0.02) +
      strprintf("variable dx equal vdisplace(0,0.1)\nregion out sphere %s 0.47 side out\n",
                center) +
      strprintf("region in sphere %s 0.2 move v_dx NULL NULL\n", center) +
      strprintf("region a sphere %s 0.2 side out\nregion b sphere %s 0.47\n", center, center) +
      "region fluid intersect 2 a b\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 / n) +
      strprintf("fix w all mpm/incompressible %.17g 1000 spread 0 tolerance 1e-10 region out "
                "region in\n",
                1.0 / n) +
      strprintf("timestep %g\n", dt);
}

/** A half-full canal of radius 0.45, whose water is turned by some degrees. */
std::string canal(int n, double angle)
{
  return plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region canal sphere 0.5 0.51 0 0.45 side out\nregion round sphere 0.5 0.51 0 0.45\n"
      "region low block INF INF INF 0.51 INF INF\nregion fluid intersect 2 round low\n" +
      strprintf("create_points 1 region fluid spacing %.17g\n", 0.5 / n) +
      strprintf("displace_atoms all rotate 0.5 0.51 0 0 0 1 %g units box\n", angle) +
      strprintf("fix w all mpm/incompressible %.17g 1000 region canal\n", 1.0 / n) +
      "fix g all gravity 9.81 vector 0 -1 0\n";
}

// water over a floor that is no plane of nodes stays at rest, with its pressure; Archimedes
SERIAL_TEST(Regions, AtRest)
{
  for (const int dim : {2, 3}) {
    const int n = dim == 2 ? 40 : 20;
    Scene run(floor_and_ball(dim, n, "tolerance 1e-12 spread 0") + "timestep 0.01\n" +
              (dim == 2 ? "run 300\n" : "run 5\n"));
    EXPECT_LT(measured("speed", entry(run, FASTEST)), 1e-12);
    double worst = 0.0;
    for (int i = 0; i < run.n(); i++)
      worst = std::max(worst,
                       std::fabs(-run.points().tau[i][1] / 9810.0 - (0.7 - run.x()[i][1])) / 0.7);
    EXPECT_LT(measured("pressure", worst), 1e-12);
    const double above = 0.7 - 0.2131;    // the middle of the floor
    EXPECT_NEAR(entry(run, REGIONS + 1) / (-9810.0 * above), 1.0, dim == 2 ? 1e-10 : 1e-4);
    const double r = 0.143, ball = dim == 3 ? 4.0 / 3.0 * PI * r * r * r : PI * r * r;
    EXPECT_NEAR(measured("buoyancy", entry(run, REGIONS + 4) / (9810.0 * ball)), 1.0,
                dim == 2 ? 0.01 : 0.05);
    EXPECT_NEAR(entry(run, REGIONS + 3) / (9810.0 * ball), 0.0, 1e-12);
  }
}

// a cylinder or sphere that begins to move: potential flow in the gap, and its added mass
SERIAL_TEST(Regions, PotentialFlow)
{
  constexpr double a = 0.2, b = 0.47, U = 0.1, dt = 1e-6;
  double error[3], largest[3];
  for (int k = 0; k < 3; k++) {
    Scene run(gap(2, 20 << k, dt) + "run 1\n");
    const double A = -U * a * a / (b * b - a * a), B = A * b * b;
    double sum = 0.0, square = 0.0;
    largest[k] = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double x = run.x()[i][0] - 0.503, y = run.x()[i][1] - 0.511, r2 = x * x + y * y;
      const double du = run.v()[i][0] - A - B * (r2 - 2.0 * x * x) / (r2 * r2),
                   dv = run.v()[i][1] + 2.0 * B * x * y / (r2 * r2);
      sum += du * du + dv * dv;
      square += std::pow(run.v()[i][0], 2) + std::pow(run.v()[i][1], 2);
      largest[k] = std::max(largest[k], std::hypot(du, dv) / U);
    }
    error[k] = measured("error of the velocity", std::sqrt(sum / square));
    measured("largest error", largest[k]);
    const double added = 1000.0 * PI * a * a * (b * b + a * a) / (b * b - a * a);
    EXPECT_NEAR(measured("added mass", -entry(run, REGIONS + 3) * dt / (U * added)), 1.0, 0.005);
  }
  EXPECT_LT(error[2], 0.006);
  EXPECT_GT(measured("order", 0.5 * std::log2(error[0] / error[2])), 1.4);
  EXPECT_GT(measured("order of the largest one", 0.5 * std::log2(largest[0] / largest[2])), 0.9);

  Scene run(gap(3, 20, dt) + "run 1\n");
  const double a3 = a * a * a, b3 = b * b * b;
  const double added = 2000.0 / 3.0 * PI * a3 * (b3 + 2.0 * a3) / (b3 - a3);
  EXPECT_NEAR(measured("added mass of a sphere", -entry(run, REGIONS + 3) * dt / (U * added)), 1.0,
              0.03);
}

// a half-full canal: frequency of Budiansky (1960), volume, and energy, over 6 s
SERIAL_TEST(Regions, Canal)
{
  Scene run(canal(30, 4.0) + "timestep 0.004\nrun 0\n");
  std::vector<double> zeros;
  double before = 0.0, t = 0.0, first = 0.0, last = 0.0, least = 1e9, most = 0.0;
  run.each_step([&](double **) {
    double x = 0.0;
    for (int i = 0; i < run.n(); i++) x += (run.x()[i][0] - 0.5) / run.n();
    const double volume = entry(run, FILLED), kinetic = entry(run, KINETIC);
    least = std::min(least, volume);
    most = std::max(most, volume);
    if (x * before < 0.0 && (zeros.empty() || run.time() > zeros.back() + 0.3))
      zeros.push_back(t + (run.time() - t) * before / (before - x));
    if (run.time() < 1.0) first = std::max(first, kinetic);
    if (run.time() > 5.0) last = std::max(last, kinetic);
    before = x;
    t = run.time();
  });
  run.commands("run 1500\n");
  const double omega = PI * (zeros.size() - 1) / (zeros.back() - zeros.front());
  EXPECT_NEAR(measured("frequency over theory", omega / std::sqrt(1.35573 * 9.81 / 0.45)), 1.0,
              0.01);
  EXPECT_LT(measured("change of the volume", most / least - 1.0), 0.005);
  EXPECT_NEAR(measured("energy", last / first), 1.0, 0.12);
}

// A wall between two pools that is just one spacing thick, with its surfaces in planes of nodes,
// holds the water, wherever it is: distances of nodes are round-off there, of either sign. The
// force on it is that of both depths
SERIAL_TEST(Regions, PlateInPlanesOfNodes)
{
  for (const int dim : {2, 3})
    for (const double origin : {0.0, -2.0, -1.0})
      for (const int k : {3, 6, 7, 9}) {
        const double low = origin + 0.1 * k, high = low + 0.1, thick = dim == 3 ? 0.2 : 1.0;
        const auto name = strprintf("%dd, origin %g, %d cells", dim, origin, k);
        Scene run(
            box(dim, "si", dim == 3 ? "f f f" : "f f",
                strprintf("%g %g 0 1 0 0.2", origin, origin + 2.0), 1, 0.05) +
            strprintf("region left block INF %.10g 0 0.8 INF INF\n"
                      "region right block %.10g INF 0 0.2 INF INF\n",
                      low, high) +
            "region pools union 2 left right\ncreate_points 1 region pools spacing 0.05\n" +
            strprintf("region plate block %.10g %.10g INF INF INF INF\n", low, high) +
            "fix w all mpm/incompressible 0.1 1 region plate\nfix g all gravity 1 vector 0 -1 0\n"
            "timestep 0.01\nrun 10\n");
        EXPECT_NEAR(entry(run, REGIONS) / (0.5 * (0.64 - 0.04) * thick), 1.0, 1e-8) << name;
        EXPECT_LT(entry(run, FASTEST), 1e-9) << name;
      }
}

// what water below a plane fills of a whole cell, from what it fills of the part above a floor
SERIAL_TEST(Regions, ShareWithoutWall)
{
  const auto full = [](double depth) {
    return depth < 0.0 ? 0.5 * (1.0 + depth) * (1.0 + depth)
                       : 1.0 - 0.5 * (1.0 - depth) * (1.0 - depth);
  };
  double worst = 0.0;
  for (const int dim : {2, 3})
    for (const double floor : {-1.5, -0.9, -0.48, -0.2, 0.1})
      for (const double surface : {-0.3, 0.02, 0.3, 0.7}) {
        if (surface < floor + 0.05) continue;
        const double up[3] = {0.0, 1.0, 0.0}, down[3] = {0.0, -1.0, 0.0};
        const double below = std::max(-1.0, floor);
        const double share = (full(surface) - full(below)) / (1.0 - full(below));
        grow(worst,
             MPMFlowCutCell::share_without_wall(dim, -floor, up, down, share) - full(surface));
      }
  EXPECT_LT(measured("error of horizontal floors", worst), 0.01);
  // with a vertical wall, both shares are the same
  for (const double wall : {-0.4, 0.0, 0.4}) {
    const double out[3] = {1.0, 0.0, 0.0}, down[3] = {0.0, -1.0, 0.0};
    EXPECT_NEAR(MPMFlowCutCell::share_without_wall(2, wall, out, down, 0.3), 0.3, 1e-5);
  }
}

// Shores, where what is left of cells is small: nothing but a creep of points, and no point goes up
// the shore. No energy is told that numerical errors would have added, not even where the water is
// so shallow everywhere that it has to spread a little at first
SERIAL_TEST(Regions, Shore)
{
  for (const double slope : first_of(2, {0.5, 0.2, 0.1, 1.3})) {
    Scene run(plane("si", "f f", "0 2 0 1", 1, 0.02) +
              strprintf("region ramp plane 1.2 0.4131 0 %g -1 0\n", slope) +
              strprintf("region dry plane 1.2 0.4131 0 %g -1 0 side out\n", slope) +
              "region water block INF INF INF 0.513 INF INF\nregion fluid intersect 2 water dry\n"
              "create_points 1 region fluid spacing 0.0125\n"
              "fix w all mpm/incompressible 0.025 1000 region ramp\n"
              "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.005\nrun 0\n");
    double fastest = 0.0, highest = 0.0;
    const double volume = entry(run, FILLED);
    run.each_step([&](double **) {
      fastest = std::max(fastest, entry(run, KINETIC));
    });
    const auto said = log_of(run, "run 400\n");
    for (int i = 0; i < run.n(); i++) highest = std::max(highest, run.x()[i][1]);
    // the waves of one cell would have more than 1 J
    EXPECT_LT(measured(strprintf("slope %g: kinetic energy", slope), fastest), 0.003);
    EXPECT_LT(measured("highest point, in spacings", (highest - 0.5125) / 0.025), 0.1);
    EXPECT_NEAR(entry(run, FILLED) / volume, 1.0, slope > 0.1 ? 0.002 : 0.003);
    EXPECT_EQ(said.find("numerical errors have added"), std::string::npos);
  }
}

// a ball that swings in a tank, on four ranks, and from restart files
TEST(Regions, RanksAndRestart)
{
  for (const int dim : {2, 3}) {
    const double h = dim == 2 ? 0.05 : 0.1;
    const std::string ball = dim == 2 ? "0.5 0.3 0 0.17" : "0.5 0.3 0.2 0.17";
    const auto scene = box(dim, "si", "f f p", "0 1 0 1 0 0.4", 1, 0.02) + "region dry sphere " +
        ball + " side out\nregion water block INF INF INF 0.53 INF INF\n" +
        "region slope plane 0.5 0.05 0 0.1 -1 0 side out\nregion fluid intersect 3 water dry "
        "slope\n" +
        strprintf("create_points 1 region fluid spacing %g\n", 0.5 * h);
    const auto fixes = "variable d equal 0.1*sin(5*step*0.004)\nregion ball sphere " + ball +
        " move v_d NULL NULL\nregion ramp plane 0.5 0.05 0 0.1 -1 0\n" +
        strprintf("fix w all mpm/incompressible %g 1000 ", h) +
        "region ball region ramp reflect 0.5 tolerance 1e-11\n"
        "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.004\n";
    OnRanks run(scene + fixes, "run 30\n", "fix b all balance 5 1.05 shift xy 10 1.05\n");
    EXPECT_LT(measured("difference", run.difference()), 1e-10);
    for (int k = REGIONS; k < REGIONS + 6; k++) {
      const double one = run.serial.fix("w")->compute_vector(k);
      EXPECT_NEAR(run.parallel.fix("w")->compute_vector(k), one, 1e-9 * (std::fabs(one) + 1.0));
    }
    Continued again(scene + fixes, 12, "neighbor 0.02 bin\n" + fixes, 20);
    EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
    for (int k = REGIONS; k < REGIONS + 6; k++)
      EXPECT_EQ(entry(again.again, k), entry(again.whole, k));
    // also in the first step, whose forces are by the motion in the one before
    Continued next(scene + fixes, 12, "neighbor 0.02 bin\n" + fixes, 1);
    EXPECT_EQ(entry(next.again, REGIONS), entry(next.whole, REGIONS));
  }
}

// The energy that a region gives does not count as that of numerical errors at the start of a run,
// either, when it has not moved in it so far. Points would keep less of their velocities
SERIAL_TEST(Regions, GiveEnergyInRunsOfParts)
{
  const std::string told = "numerical errors have added",
                    fixes = "variable up equal -0.2*time\n"
                            "region ball sphere 0.5 0.4 0 0.12 move NULL v_up NULL\n"
                            "fix w all mpm/incompressible 0.04 1000 region ball\n"
                            "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.005\n",
                    scene = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region hole sphere 0.5 0.4 0 0.12 side out\nregion low block INF INF INF 0.6 INF INF\n"
      "region water intersect 2 low hole\ncreate_points 1 region water spacing 0.02\n" +
      fixes;
  const ScratchFile file("parts");
  const auto first = scene + "run 10\n";
  Scene whole(scene + "run 20\n"), parts(first + "run 10\n");
  EXPECT_LT(difference(whole.gather(), parts.gather()), 1e-11);
  EXPECT_EQ(times_said(first + "write_restart " + file.name + "\nrun 10\n", told), 0);
  EXPECT_EQ(
      times_said("read_restart " + file.name + "\nneighbor 0.02 bin\n" + fixes + "run 10\n", told),
      0);
}

// A container that is moved pushes on its water with the force that accelerates it, wherever walls
// are in their cells: full, and with an inclined surface
SERIAL_TEST(Regions, MovedTank)
{
  struct Case {
    const char *shape;
    bool full;
    double acceleration, speed;
  };
  constexpr double x = 0.51, y = 0.41, D = 0.4;    // middle, width
  for (const auto &one : {Case{"sphere", true, 1.0, 0.4},
                          {"sphere", false, 1.0, 0.0},
                          {"block", false, 1.0, 0.0},
                          {"block", false, 4.0, 0.0},
                          {"block", false, 0.0, 1.0}}) {
    const double n = 20.0, dt = 0.005, a = one.acceleration;
    const auto name =
        strprintf("%s, full %d, acceleration %g, speed %g: ", one.shape, one.full, a, one.speed);
    const bool round = one.shape[0] == 's';
    const auto args = round
        ? strprintf("sphere %g %g 0 %g", x, y, 0.5 * D)
        : strprintf("block %g %g %g %g INF INF", x - 0.5 * D, x + 0.5 * D, y - 0.155, y + 0.155);
    Scene run(plane("si", "f f", "0 3.2 0 0.8", 1, 0.02) +
              strprintf("variable s equal %g*time+%g*time*time\n", one.speed, 0.5 * a) +
              "region tank " + args + " side out move v_s NULL NULL\nregion inner " + args +
              strprintf("\nregion low plane %g %g 0 %g -9.81 0\n", x, one.full ? 2.0 : y, -a) +
              strprintf("region water intersect 2 inner low\ncreate_points 1 region water spacing "
                        "%.17g\n",
                        0.5 * D / n) +
              strprintf("velocity all set %g 0 0\n", one.speed) +
              strprintf("fix w all mpm/incompressible %.17g 1000 region tank\n", D / n) +
              "fix g all gravity 9.81 vector 0 -1 0\n" + strprintf("timestep %g\nrun 2\n", dt));
    // a full one holds what fits in, whatever points were created
    double mass = one.full ? 1000.0 * 0.25 * M_PI * D * D : 0.0;
    for (int i = 0; i < run.n() && !one.full; i++) mass += run.mass()[i];
    std::vector<double> ahead, up;
    double least = 1e9, most = -1e9;
    run.each_step([&](double **) {
      ahead.push_back(-entry(run, REGIONS) / mass);
      up.push_back(-entry(run, REGIONS + 1) / mass);
      least = std::min(least, ahead.back());
      most = std::max(most, ahead.back());
    });
    run.commands("run 150\n");
    double mean = 0.0, lift = 0.0;
    for (std::size_t k = 0; k < ahead.size(); k++) {
      mean += ahead[k] / ahead.size();
      lift += up[k] / up.size();
    }
    const double whole = std::max(a, 1.0);
    const double bound = one.full ? 0.001 : 0.02;
    EXPECT_NEAR(measured(name + "force over acceleration, mean", mean / whole), a / whole, bound);
    EXPECT_NEAR(measured(name + "weight", lift / 9.81), 1.0, bound);
    // what is left of it in single steps is that of a surface that is not quite even
    const double scatter = one.full ? 1e-5 : a > 0.0 ? 0.08 : 0.005;
    EXPECT_LT(measured(name + "least and most", (most - least) / whole), scatter);
  }
}

// no point ends in a solid, however this turns and moves
SERIAL_TEST(Regions, PointsStayOutside)
{
  Scene run(plane("si", "f f", "0 1 0 1", 1, 0.02) +
            "region dry block 0.35 0.65 0.2 0.3 INF INF side out\n"
            "region water block INF INF INF 0.6 INF INF\nregion fluid intersect 2 water dry\n"
            "create_points 1 region fluid spacing 0.0125\nvariable angle equal ramp(0,3)\n"
            "region blade block 0.35 0.65 0.2 0.3 INF INF rotate v_angle 0.5 0.25 0 0 0 1\n"
            "fix w all mpm/incompressible 0.025 1000 region blade\n"
            "fix g all gravity 9.81 vector 0 -1 0\ntimestep 0.002\n");
  const double volume = 0.57;
  int inside = 0;
  run.each_step([&](double **) {
    const double turned = 3.0 * run.lmp->update->ntimestep / 500.0;
    for (int i = 0; i < run.n(); i++) {
      const double x = run.x()[i][0] - 0.5, y = run.x()[i][1] - 0.25;
      const double u = std::cos(turned) * x + std::sin(turned) * y,
                   v = std::cos(turned) * y - std::sin(turned) * x;
      if (std::fabs(u) < 0.15 && std::fabs(v) < 0.05) inside++;
    }
  });
  run.commands("run 500\n");
  EXPECT_EQ(inside, 0);
  EXPECT_NEAR(measured("volume", entry(run, FILLED) / volume), 1.0, 0.003);
}

SERIAL_TEST(Regions, BadInput)
{
  const auto plain = plane("si", "f f", "0 1 0 1", 1, 0.02) + "create_points 1 box spacing 0.05\n";
  const std::string fix = "fix w all mpm/incompressible 0.1 1000 ";
  expect_refused(
      plain,
      {{fix + "region", "missing"},
       {fix + "region none", "region none does not exist"},
       {"region b sphere 0.5 0.5 0 0.2\n" + fix + "region b", "points are in a region"},
       {"region b block 0.9 1 0.9 1 INF INF open 1\n" + fix + "region b", "open faces"},
       {"region b sphere 0.5 0.5 0 0.001\n" + fix + "region b region b", "has region b twice"},
       {"region b sphere 0.5 0.5 0 0.001\n" + fix + "region b viscosity 1",
        "cannot be used with viscosity"},
       {"region b sphere 0.5 0.5 0 0.001\n" + fix + "region b viscosity 1 implicit yes",
        "cannot be used with viscosity: use the keyword stick"},
       {"region b sphere 0.5 0.5 0 0.001\n" + fix + "tension 1 region b",
        "cannot be used with tension"},
       {"variable r equal 0.01\nregion b sphere 0.5 0.5 0 v_r\n" + fix + "region b",
        "must not change"},
       {"variable d equal 0.0\nregion a sphere 0.51 0.51 0 0.01 move v_d NULL NULL\n"
        "region c sphere 0.41 0.41 0 0.01\nregion b union 2 a c\n" +
            fix + "region b",
        "must not move"}},
      "timestep 0.001\nrun 1\n");
  const auto plate = plane("si", "f f", "0 1 0 1", 1, 0.02) +
      "region plate block 0.41 0.43 0.2 0.8 INF INF\nregion dry block 0.41 0.43 0.2 0.8 INF INF "
      "side out\ncreate_points 1 region dry spacing 0.05\n" +
      fix + "region plate\ntimestep 0.001\nrun 1\n";
  EXPECT_EQ(times_said(plate, "thinner than a node spacing"), 1);
  // a corner ends in a cell, but no flow goes through a block
  for (const double x : {0.515, 0.535, 0.555, 0.575}) {
    std::string turned = plane("si", "f f", "0 1 0 1", 1, 0.02);
    for (int k = 0; k < 4; k++) {
      const double c = k < 2 ? 1.0 : -1.0, s = k % 2 ? 1.0 : -1.0;
      turned += strprintf("region p%d plane %.17g %.17g 0 %g %g 0\n", k, x + 0.2 * c,
                          0.55 + 0.2 * s, -c, -s);
    }
    turned += "region turned intersect 4 p0 p1 p2 p3\nregion dry intersect 4 p0 p1 p2 p3 side "
              "out\ncreate_points 1 region dry spacing 0.05\n" +
        fix + "region turned\ntimestep 0.001\nrun 1\n";
    EXPECT_EQ(times_said(turned, "thinner than a node spacing"), 0) << x;
  }
  for (const double gap : {0.07, 0.2}) {
    const auto blocks =
        plane("si", "f f", "0 1 0 1", 1, 0.02) +
        strprintf(
            "region a block 0.15 0.4 0.2 0.8 INF INF\nregion b block %g 0.9 0.2 0.8 INF INF\n",
            0.4 + gap) +
        "region u union 2 a b side out\ncreate_points 1 region u spacing 0.05\n" + fix +
        "region a region b\ntimestep 0.001\nrun 1\n";
    EXPECT_EQ(times_said(blocks, "gaps of less than a node spacing"), gap < 0.1 ? 1 : 0);
  }
}

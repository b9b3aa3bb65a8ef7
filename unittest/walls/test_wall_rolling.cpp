// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi
// mpi: 1 2
// timeout: 900

// Elastic disks and spheres that roll or slip on walls that separate, with Coulomb friction. A
// rigid one (disk: k = 1/2, sphere: 2/5) rolls when tan(theta) <= mu (1 + 1/k), with a = g sin/(1 +
// k); else a = g (sin - mu cos) and alpha R = mu g cos/k. In place of the plane gravity is tilted.
//
// A disk cut out of a lattice of points is a polygon: its lowest row is 3.6 h long. It jumps from
// edge to edge, and where nearly all of the friction is needed (60 degrees) every jump makes it
// slip. Disks of points in rings, settled on the wall before they are let go, are round: the error
// of the wall is seen.

#include "mpm_lammps.h"

using namespace MPM_TEST;

struct Incline {
  double theta, mu;
};
const std::vector<Incline> INCLINES = {{30, 0.1}, {30, 0.3}, {45, 0.495}, {60, 0.6}};
constexpr double R = 0.5, g = 9.81;

/** What is measured after 0.6 s from rest, over what a rigid body does. */
struct Motion {
  double way, spin;    // ratios
  double lowest;       // distance of the lowest point from the wall, over the run
  double offset;       // slipping: of the normal force from the center of the body
};

/** wall: its fix, with friction MU and any region; turned: angle between plane and lattice (2d),
 *  whose surface then goes through (0.75, 2); points: arguments of ppc. */
Motion roll(const Incline &incline, double h, const std::string &wall, int dim = 2,
            double turned = 0.0, const std::string &points = "")
{
  const double theta = incline.theta * M_PI / 180, turn = turned * M_PI / 180;
  const double t[2] = {std::cos(turn), -std::sin(turn)}, n[2] = {-t[1], t[0]};
  const double foot[2] = {0.75, turned ? 2.0 : 0.0};
  const double k = dim == 2 ? 0.5 : 0.4;
  const std::string at = strprintf("%.15g %.15g", foot[0] + R * n[0], foot[1] + R * n[1]);
  const std::string shape = dim == 2 ? "cylinder z " + at + " 0.5 INF INF"
                                     : "sphere " + at + " 0.75 0.5";
  std::string scene =
      box(dim, "si", "f f f", strprintf("0 3 0 %g 0 1.5", turned ? 3.2 : 1.5), 1, 0.5 * h) +
      body(shape, "density 1000 neohookean 4.2e6 0.4", std::to_string(h),
           !points.empty() ? points
               : dim == 2  ? "3"
                           : "2") +
      replaced(wall, "MU", std::to_string(incline.mu)) + "\n" +
      strprintf("fix g all gravity %g vector %.15g %.15g 0\nfix dt all mpm/dt 0.5\n", g,
                std::sin(theta) * t[0] - std::cos(theta) * n[0],
                std::sin(theta) * t[1] - std::cos(theta) * n[1]) +
      strprintf("variable x equal xcm(all,x)*%.15g+xcm(all,y)*%.15g\n", t[0], t[1]) +
      "variable w equal -angmom(all,z)/inertia(all,zz)\n" +
      strprintf("variable d atom (x-%.15g)*%.15g+(y-%.15g)*%.15g\ncompute d all reduce min v_d\n",
                foot[0], n[0], foot[1], n[1]) +
      "variable low equal c_d\nvariable done equal \"time >= 0.6\"\n"
      "fix halt all halt 1 v_done == 1 error continue\nrun 0\n";
  Scene run(scene);
  const double x0 = run.variable("x");
  Motion m = {0.0, 0.0, 1.0, 0.0};
  while (run.evaluate("time") < 0.6) {
    run.commands("run 200 post no\n");
    m.lowest = std::min(m.lowest, run.variable("low"));
  }
  const bool rolls = std::tan(theta) <= incline.mu * (1.0 + 1.0 / k);
  const double a = rolls ? g * std::sin(theta) / (1.0 + k)
                         : g * (std::sin(theta) - incline.mu * std::cos(theta));
  const double alphaR = rolls ? a : incline.mu * g * std::cos(theta) / k;
  const double time = run.evaluate("time");
  m.way = (run.variable("x") - x0) / (0.5 * a * time * time);
  m.spin = run.variable("w") * R / (alphaR * time);
  m.offset = (1.0 - m.spin) * incline.mu * R;    // torque mu N R - N offset
  return m;
}

/** The benchmark asks for the way within a share; the normal force must act below the center of a
 *  body that slips, as well as nodes can tell, and nothing must get into the wall. */
void expect_rigid(const Incline &incline, const Motion &m, double share, double h, double depth)
{
  const std::string name = strprintf("%g degrees, mu %g, h %g: ", incline.theta, incline.mu, h);
  EXPECT_NEAR(measured(name + "way", m.way), 1.0, share);
  EXPECT_GE(measured(name + "lowest point", m.lowest), -depth);
  measured(name + "spin", m.spin);
  if (incline.mu == 0.1) {
    EXPECT_LT(measured(name + "offset of the force", std::abs(m.offset)), 0.25 * h);
  }
}

class RollingDisk : public ::testing::TestWithParam<double> {};

TEST_P(RollingDisk, OnAFace)
{
  LONG_AFTER(1);
  for (const auto &incline : INCLINES) {
    if (GetParam() < 0.05 && (incline.mu == 0.1 || incline.theta == 45)) continue;
    expect_rigid(incline,
                 roll(incline, GetParam(), "fix w all mpm/boundary ylo separate friction MU"), 0.02,
                 GetParam(), 0.0);
  }
}

// At an angle to the lattice the benchmark allows 5 %.
TEST_P(RollingDisk, OnATurnedPlane)
{
  if (GetParam() < 0.05) GTEST_SKIP() << "a round disk is enough";
  constexpr double turned = 30.0, turn = turned * M_PI / 180;
  const std::string wall = strprintf("region p plane 0.75 2 0 %.15g %.15g 0\n"
                                     "fix w all mpm/boundary region p separate friction MU",
                                     -std::sin(turn), -std::cos(turn));
  for (const Incline incline : {Incline{30, 0.3}, {60, 0.6}})
    expect_rigid(incline, roll(incline, GetParam(), wall, 2, turned), 0.05, GetParam(),
                 0.25 * GetParam());
}

// With parts of points at the surface a disk is no polygon, and friction gives it its spin.
TEST_P(RollingDisk, OfPartsOfPoints)
{
  LONG_AFTER(1);
  for (const auto &incline : INCLINES) {
    // one that is put down with nearly all of the friction slips at first
    if (incline.theta == 60 || (GetParam() < 0.05 && incline.mu != 0.1)) continue;
    const auto m = roll(incline, GetParam(), "fix w all mpm/boundary ylo separate friction MU", 2,
                        0.0, "2 cut yes");
    expect_rigid(incline, m, 0.02, GetParam(), 0.0);
    EXPECT_NEAR(m.spin, 1.0, GetParam() < 0.05 ? 0.02 : 0.08);
  }
}

INSTANTIATE_TEST_SUITE_P(Spacings, RollingDisk, ::testing::Values(0.05, 0.025));

SERIAL_TEST(RollingSphere, OfPartsOfPoints)
{
  LONG_CASE();
  const auto m =
      roll({30, 0.1}, 0.05, "fix w all mpm/boundary ylo separate friction MU", 3, 0.0, "2 cut yes");
  expect_rigid({30, 0.1}, m, 0.02, 0.05, 0.0);
  EXPECT_LT(std::abs(m.offset), 0.15 * 0.05);    // what the warning says
}

SERIAL_TEST(RollingSphere, OnAFace)
{
  LONG_CASE();
  expect_rigid({30, 0.3},
               roll({30, 0.3}, 0.05, "fix w all mpm/boundary ylo separate friction MU", 3), 0.02,
               0.05, 0.0);
}

/** Points in n/2 rings, n along the diameter: squares of the same area around each, as a mesh. */
std::string rings(const double *center, int n)
{
  std::vector<std::array<double, 2>> points;
  for (int k = 0; k < n / 2; k++) {
    const int number = (int) std::lround(M_PI * (2 * k + 1));
    const double r = (k + 0.5) * 2 * R / n;
    for (int j = 0; j < number; j++) {
      const double angle = 2 * M_PI * (j + 0.5 * (k % 2)) / number;
      points.push_back({center[0] + r * std::cos(angle), center[1] + r * std::sin(angle)});
    }
  }
  const int size = (int) points.size();
  const double half = 0.5 * std::sqrt(M_PI * R * R / size);
  std::string text = strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", 4 * size);
  for (int k = 0; k < 4 * size; k++) {
    const auto &p = points[k / 4];
    const int corner = k % 4;
    text += strprintf("%d %.15g %.15g 0\n", k + 1, p[0] + (corner % 3 ? half : -half),
                      p[1] + (corner / 2 ? half : -half));
  }
  text += strprintf("$EndNodes\n$Elements\n%d\n", size);
  for (int k = 0; k < size; k++)
    text +=
        strprintf("%d 3 2 1 1 %d %d %d %d\n", k + 1, 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4);
  return text + "$EndElements\n";
}

/** A wall: a region, none: the face ylo at this height. */
struct Wall {
  std::string name, region;
  double turned = 0.0;    // angle to the lattice, about the foot (0.75, height)
  double height = 0.4;
  double velocity[2] = {0.0, 0.0};
};

/** The disk settles, damped, without friction, and is let go. contact: on a plate, a body. */
Motion roll_round(const Incline &incline, double h, const Wall &wall, bool contact = false)
{
  const double theta = incline.theta * M_PI / 180, turn = wall.turned * M_PI / 180;
  const double t[2] = {std::cos(turn), -std::sin(turn)}, n[2] = {-t[1], t[0]};
  const double foot[2] = {0.75, wall.height};
  const double center[2] = {foot[0] + R * n[0], foot[1] + R * n[1]};
  const ScratchFile mesh("rings.msh",
                         rings(center, (int) std::lround(2 * R / h) * (contact ? 2 : 3)));
  const double gn = g * std::cos(theta), *const V = wall.velocity;
  const auto between = [&](const char *mu) {
    return contact ? strprintf("fix w all mpm/contact plate disk law coulomb %s\n", mu)
                   : strprintf("fix w all mpm/boundary %s separate friction %s\n",
                               wall.region.empty() ? "ylo" : "region wall", mu);
  };
  const std::string below = contact ? "0"
      : wall.region.empty()         ? strprintf("%.15g", wall.height)
                                    : "-0.4";
  Scene run(
      plane("si", "f f", "0 3.2 " + below + strprintf(" %g", wall.height + 1.2), 2, 0.5 * h) +
      "group disk type 2\ngroup plate type 1\n" +
      strprintf("fix disk disk mpm %g origin 0 0\n", h) +
      (contact ? strprintf("fix plate plate mpm %g origin 0 0\n", h) : "") +
      (contact
           ? "region slab block " + wall.region + " INF INF\ncreate_points 1 region slab ppc 2\n" +
               strprintf("displace_atoms all rotate %.15g %.15g 0 0 0 1 %.15g units box\n", foot[0],
                         foot[1], -wall.turned)
           : "") +
      "create_points 2 elements " + mesh.name +
      "\ngroup disk type 2\ngroup plate type 1\n"
      "fix soft disk mpm/material density 1000 neohookean 4.2e6 0.4\n" +
      (contact ? strprintf("fix hard plate mpm/material density 1000 neohookean 4.2e7 0.4\n"
                           "region hold plane %.15g %.15g 0 %.15g %.15g 0\n"
                           "fix hold all mpm/boundary region hold stick field plate\n",
                           foot[0] - 0.2 * n[0], foot[1] - 0.2 * n[1], -n[0], -n[1])
               : "") +
      strprintf("variable X equal %g*time\nvariable Y equal %g*time\n", V[0], V[1]) +
      (contact || wall.region.empty() ? "" : "region wall " + wall.region + "\n") + between("0") +
      strprintf("fix g disk gravity %.15g vector %.15g %.15g 0\nfix dt all mpm/dt 0.5\n", gn, -n[0],
                -n[1]) +
      (V[0] == 0.0 ? "fix damp disk viscous $(100*mass(disk)/count(disk))\n" : "") +
      strprintf("velocity disk set %g %g 0\n", V[0], V[1]) +
      "variable done equal \"time >= 0.2\"\nfix halt all halt 1 v_done == 1 error continue\n"
      "run 100000\nunfix g\nunfix w\nunfix halt\n" +
      (V[0] == 0.0 ? "unfix damp\n" : "") + strprintf("velocity disk set %g %g 0\n", V[0], V[1]) +
      between(std::to_string(incline.mu).c_str()) +
      strprintf("fix g disk gravity %g vector %.15g %.15g 0\n", g,
                std::sin(theta) * t[0] - std::cos(theta) * n[0],
                std::sin(theta) * t[1] - std::cos(theta) * n[1]) +
      strprintf("variable x equal (xcm(disk,x)-v_X)*%.15g+(xcm(disk,y)-v_Y)*%.15g\n", t[0], t[1]) +
      strprintf("variable y equal (xcm(disk,x)-v_X)*%.15g+(xcm(disk,y)-v_Y)*%.15g\n", n[0], n[1]) +
      "variable w equal -angmom(disk,z)/inertia(disk,zz)\nrun 0\n");
  const double x0 = run.variable("x"), y0 = run.variable("y"), start = run.evaluate("time");
  Motion m = {0.0, 0.0, 1.0, 0.0};
  while (run.evaluate("time") - start < 0.6) {
    run.commands("run 200 post no\n");
    m.lowest = std::min(m.lowest, run.variable("y") - y0);
  }
  const bool rolls = std::tan(theta) <= incline.mu * 3.0;
  const double a = rolls ? g * std::sin(theta) / 1.5
                         : g * (std::sin(theta) - incline.mu * std::cos(theta));
  const double time = run.evaluate("time") - start;
  m.way = (run.variable("x") - x0) / (0.5 * a * time * time);
  m.spin = run.variable("w") * R / ((rolls ? a : 2.0 * incline.mu * gn) * time);
  return m;
}

/** A plate with its surface through the foot, as a file. */
std::string turned_plate(double turned, double height)
{
  const double t[2] = {std::cos(turned * M_PI / 180), -std::sin(turned * M_PI / 180)};
  const double along[4] = {-2.0, 4.0, 4.0, -2.0}, up[4] = {-1.5, -1.5, 0.0, 0.0};
  double corner[8][3];
  for (int k = 0; k < 8; k++) {
    const double a = along[k % 4], b = up[k % 4];
    corner[k][0] = 0.75 + a * t[0] - b * t[1];
    corner[k][1] = height + a * t[1] + b * t[0];
    corner[k][2] = k / 4 ? 2.0 : -1.0;
  }
  const int face[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                           {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  std::string text = "solid plate\n";
  for (const auto &f : face) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : f)
      text += strprintf("vertex %.12g %.12g %.12g\n", corner[k][0], corner[k][1], corner[k][2]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid plate\n";
}

/** A cylinder or a sphere that is so large that its surface at the foot is as good as a plane. */
std::string large(const std::string &style, double turned, double height, double z = 0.0)
{
  const double turn = turned * M_PI / 180, r = 200.0;
  const double x = 0.75 - r * std::sin(turn), y = height - r * std::cos(turn);
  return style == "sphere" ? strprintf("sphere %.15g %.15g %g %g", x, y, z, r)
                           : strprintf("cylinder z %.15g %.15g %g INF INF", x, y, r);
}

std::string turned_plane(double turned, double height, const std::string &motion = "")
{
  const double turn = turned * M_PI / 180;
  return strprintf("plane 0.75 %g 0 %.15g %.15g 0", height, -std::sin(turn), -std::cos(turn)) +
      motion;
}

/** The benchmark asks for the way. What friction there was follows from it, and with the spin the
 *  place of the normal force, which must act below the center as well as nodes can tell: k alpha
 *  R^2 = f R - N offset. */
void expect_round(const Incline &incline, const Motion &m, const std::string &wall, double h)
{
  const std::string name =
      strprintf("%s, %g degrees, mu %g, h %g: ", wall.c_str(), incline.theta, incline.mu, h);
  const double theta = incline.theta * M_PI / 180, N = g * std::cos(theta);
  const double f = std::min(incline.mu * N, g * std::sin(theta) / 3.0);
  const double a = g * std::sin(theta) - f;
  EXPECT_NEAR(measured(name + "way", m.way), 1.0, 0.02);
  const double offset = R * (f - (m.way - 1.0) * a - measured(name + "spin", m.spin) * f) / N;
  EXPECT_LT(measured(name + "offset of the force", std::abs(offset)), 0.25 * h);
  EXPECT_GE(measured(name + "sinks by", m.lowest), -0.15 * h);
}

// Planes that are regions, at any angle and place in a cell, are as good as faces.
SERIAL_TEST(RoundDisk, OnRegions)
{
  LONG_CASE();
  constexpr double h = 0.05;
  const ScratchFile plate("plate.stl", turned_plate(30, 2.0));
  std::vector<Wall> walls = {
      {"face between nodes", "", 0.0, 0.4125},
      {"plane of 30 degrees", turned_plane(30, 2.0), 30.0, 2.0},
      {"plane of 45 degrees", turned_plane(45, 2.6), 45.0, 2.6},
      {"mesh of 30 degrees", "mpm/mesh " + plate.name + " 1 0 0 0", 30.0, 2.0},
      {"cylinder", large("cylinder", 30, 2.0), 30.0, 2.0},
      {"moving plane", turned_plane(30, 1.6, " move v_X v_Y NULL"), 30.0, 1.6, {0.1, 0.5}},
  };
  for (const auto &wall : walls)
    expect_round(INCLINES[3], roll_round(INCLINES[3], h, wall), wall.name, h);
  for (int k = 0; k < 3; k++)
    expect_round(INCLINES[k], roll_round(INCLINES[k], h, walls[1]), walls[1].name, h);
  expect_round(INCLINES[3], roll_round(INCLINES[3], 0.5 * h, walls[1]), walls[1].name, 0.5 * h);
}

// fix mpm/contact, bodies on the lattice and turned.
SERIAL_TEST(RoundDisk, OnABody)
{
  LONG_CASE();
  constexpr double h = 0.05;
  expect_round(INCLINES[3], roll_round(INCLINES[3], h, {"body", "0 3.2 0 0.5", 0.0, 0.5}, true),
               "body", h);
  expect_round(INCLINES[3],
               roll_round(INCLINES[3], h, {"turned body", "0.25 3.15 1.6 2", 30.0, 2.0}, true),
               "turned body", h);
}

SERIAL_TEST(RollingSphere, OnATurnedPlane)
{
  LONG_CASE();
  const double turn = M_PI / 6;
  const std::string wall = strprintf("region p plane 0.75 2 0 %.15g %.15g 0\n"
                                     "fix w all mpm/boundary region p separate friction MU",
                                     -std::sin(turn), -std::cos(turn));
  expect_rigid({60, 0.6}, roll({60, 0.6}, 0.05, wall, 3, 30.0), 0.02, 0.05, 0.25 * 0.05);
}

/** The way along the wall in this time, after settling. begin: field, body, and material. */
double way_from_rest(const std::string &begin, int dim, const Incline &incline, double h,
                     const Wall &wall, const std::string &kind, double time)
{
  const double theta = incline.theta * M_PI / 180, turn = wall.turned * M_PI / 180;
  const double t[2] = {std::cos(turn), -std::sin(turn)}, n[2] = {-t[1], t[0]};
  const auto friction = [&](double mu) {
    return "fix w all mpm/boundary region wall " + kind + " friction " + std::to_string(mu) + "\n";
  };
  constexpr double settled = 0.2;
  const auto run_until = [](double end) {
    return strprintf("fix dt all mpm/dt 0.5 until %.15g\nrun 100000\n", end);
  };
  Scene run(
      box(dim, "si", "f f f", strprintf("0 3.2 -0.4 %g 0 1.5", wall.height + 1.2), 1, 0.5 * h) +
      begin + "region wall " + wall.region + "\n" + friction(0.0) +
      strprintf("fix g all gravity %.15g vector %.15g %.15g 0\n", g * std::cos(theta), -n[0],
                -n[1]) +
      "fix damp all viscous $(100*mass(all)/count(all))\n" + run_until(settled) +
      "unfix g\nunfix w\nunfix damp\nvelocity all set 0 0 0\n" + friction(incline.mu) +
      strprintf("fix g all gravity %g vector %.15g %.15g 0\n", g,
                std::sin(theta) * t[0] - std::cos(theta) * n[0],
                std::sin(theta) * t[1] - std::cos(theta) * n[1]) +
      strprintf("variable x equal xcm(all,x)*%.15g+xcm(all,y)*%.15g\nrun 0\n", t[0], t[1]));
  const double x0 = run.variable("x");
  run.commands(run_until(settled + time));
  return run.variable("x") - x0;
}

/** Of an elastic block of this height and shear wave speed whose foot sticks until its wave has the
 *  stress of friction: this grows, density c g sin t, up to mu density g height cos. */
double way_of_block(const Incline &incline, double height, double c, double time)
{
  const double theta = incline.theta * M_PI / 180, gt = g * std::sin(theta),
               f = incline.mu * g * std::cos(theta), sticks = f * height / (c * gt);
  return 0.5 * (gt - f) * time * time + 0.5 * f * sticks * time - f * sticks * sticks / 6.0;
}

/** A block, 0.8 wide and 0.3 high, of a material that damps its vibrations: without, it is the
 *  block that is measured, which begins to hop or, with slip, to brake by itself. */
double expect_block(const Incline &incline, double h, const Wall &wall, const std::string &kind)
{
  constexpr double height = 0.3, time = 0.4;
  const std::string begin = strprintf("fix grid all mpm %g origin 0 0\n", h) +
      strprintf("region body block 0.35 1.15 %.15g %.15g INF INF\n", wall.height,
                wall.height + height) +
      "create_points 1 region body ppc 2\n" +
      strprintf("displace_atoms all rotate 0.75 %.15g 0 0 0 1 %.15g units box\n", wall.height,
                -wall.turned) +
      "fix m all mpm/material density 1000 neohookean 4.2e6 0.4 viscosity newtonian " +
      (kind == "slip" ? "300\n" : "1000\n");
  const double way = way_from_rest(begin, 2, incline, h, wall, kind, time);
  const double exact = way_of_block(incline, height, std::sqrt(1.5e6 / 1000), time);
  EXPECT_NEAR(measured(strprintf("%s %s, %g degrees, mu %g, h %g: way", kind.c_str(),
                                 wall.name.c_str(), incline.theta, incline.mu, h),
                       way / exact),
              1.0, 0.02);
  return way;
}

/** A round ball: points in shells, n of them along the diameter, as cubes in a mesh. */
std::string ball_of_shells(const double *center, int n)
{
  std::vector<std::array<double, 3>> points;
  for (int k = 0; k < n / 2; k++) {
    const int number = (int) std::lround(4.0 * M_PI / 3.0 * (3 * k * k + 3 * k + 1));
    const double r = (k + 0.5) * 2 * R / n;
    for (int j = 0; j < number; j++) {    // a spiral from pole to pole
      const double z = 1.0 - (2.0 * j + 1.0) / number,
                   angle = j * M_PI * (3.0 - std::sqrt(5.0)) + k;
      const double s = r * std::sqrt(1.0 - z * z);
      points.push_back(
          {center[0] + s * std::cos(angle), center[1] + s * std::sin(angle), center[2] + r * z});
    }
  }
  const int size = (int) points.size();
  const double half = 0.5 * std::cbrt(4.0 / 3.0 * M_PI * R * R * R / size);
  std::string text = strprintf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", 8 * size);
  for (int k = 0; k < 8 * size; k++) {
    const auto &p = points[k / 8];
    const int corner = k % 4;
    text += strprintf("%d %.15g %.15g %.15g\n", k + 1,
                      p[0] + (corner == 1 || corner == 2 ? half : -half),
                      p[1] + (corner / 2 ? half : -half), p[2] + (k % 8 / 4 ? half : -half));
  }
  text += strprintf("$EndNodes\n$Elements\n%d\n", size);
  for (int k = 0; k < size; k++) {
    text += strprintf("%d 5 2 1 1", k + 1);
    for (int c = 1; c <= 8; c++) text += strprintf(" %d", 8 * k + c);
    text += "\n";
  }
  return text + "$EndElements\n";
}

void expect_ball(const Incline &incline, double h, const Wall &wall)
{
  constexpr double time = 0.3, k = 0.4;
  const double theta = incline.theta * M_PI / 180, turn = wall.turned * M_PI / 180;
  const double center[3] = {0.75 + R * std::sin(turn), wall.height + R * std::cos(turn), 0.75};
  const ScratchFile mesh("shells.msh", ball_of_shells(center, (int) std::lround(2 * R / h) * 2));
  const std::string begin = strprintf("fix grid all mpm %.15g origin 0 0 0\n", h) +
      "create_points 1 elements " + mesh.name +
      "\nfix m all mpm/material density 1000 neohookean 4.2e6 0.4\n";
  const double way = way_from_rest(begin, 3, incline, h, wall, "separate", time);
  const double a = std::tan(theta) <= incline.mu * (1.0 + 1.0 / k)
      ? g * std::sin(theta) / (1.0 + k)
      : g * (std::sin(theta) - incline.mu * std::cos(theta));
  EXPECT_NEAR(measured(strprintf("ball on %s, %g degrees, mu %g, h %g: way", wall.name.c_str(),
                                 incline.theta, incline.mu, h),
                       way / (0.5 * a * time * time)),
              1.0, 0.02);
}

SERIAL_TEST(SlidingBlock, OnRegions)
{
  LONG_CASE();
  const ScratchFile plate("plate.stl", turned_plate(30, 2.0));
  const Wall plane15 = {"plane of 15 degrees", turned_plane(15, 1.3), 15.0, 1.3},
             plane30 = {"plane of 30 degrees", turned_plane(30, 2.0), 30.0, 2.0},
             block = {"block", "block -5 20 -5 0.42 INF INF", 0.0, 0.42},
             mesh = {"mesh of 30 degrees", "mpm/mesh " + plate.name + " 1 0 0 0", 30.0, 2.0},
             cylinder = {"cylinder", large("cylinder", 30, 2.0), 30.0, 2.0},
             sphere = {"sphere", large("sphere", 30, 2.0), 30.0, 2.0};
  constexpr double h = 0.05;
  const double on_mesh = expect_block({30, 0.3}, h, mesh, "separate");
  // far from the edges of its triangles a mesh is a plane
  EXPECT_NEAR(on_mesh, expect_block({30, 0.3}, h, plane30, "separate"), 1.0e-8);
  expect_block({45, 0.6}, h, block, "separate");
  expect_block({45, 0.3}, h, cylinder, "separate");
  expect_block({60, 0.6}, h, sphere, "separate");
  expect_block({60, 0.3}, h, plane15, "separate");
  expect_block({45, 0.6}, 0.5 * h, plane15, "separate");

  // a body that cannot leave the wall, and is damped enough that it does not brake by itself
  for (const auto &wall : {plane15, plane30, block, mesh}) expect_block({30, 0.3}, h, wall, "slip");
  expect_block({30, 0.3}, 0.5 * h, plane15, "slip");
}

// Balls that are round, as RoundDisk; R/6.
SERIAL_TEST(RoundBall, OnRegions)
{
  LONG_CASE();
  constexpr double h = 0.5 / 6;
  const ScratchFile plate("plate.stl", turned_plate(30, 2.0));
  expect_ball({30, 0.6}, h, {"mesh of 30 degrees", "mpm/mesh " + plate.name + " 1 0 0 0", 30, 2.0});
  expect_ball({45, 0.6}, h, {"block", "block -5 20 -5 0.42 INF INF", 0.0, 0.42});
  expect_ball({60, 0.3}, h, {"cylinder", large("cylinder", 30, 2.0), 30.0, 2.0});
  expect_ball({30, 0.3}, h, {"sphere", large("sphere", 30, 2.0, 0.75), 30.0, 2.0});
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi
// mpi: 1 2
// timeout: 900

// Elastic disks and spheres that roll or slip on walls that separate, with Coulomb friction. A rigid one
// (disk: k = 1/2, sphere: 2/5) rolls when tan(theta) <= mu (1 + 1/k), with a = g sin/(1 + k); else a =
// g (sin - mu cos) and alpha R = mu g cos/k. In place of the plane gravity is tilted.

#include "mpm_lammps.h"

using namespace MPM_TEST;

namespace {

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

/** wall: its fix, with friction MU and any region; turned: angle between plane and lattice (2d), whose
 *  surface then goes through (0.75, 2). */
Motion roll(const Incline &incline, double h, const std::string &wall, int dim = 2,
            double turned = 0.0)
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
      body(shape, "density 1000 neohookean 4.2e6 0.4", std::to_string(h), dim == 2 ? "3" : "2") +
      replaced(wall, "MU", std::to_string(incline.mu)) + "\n" +
      strprintf("fix g all gravity %g vector %.15g %.15g 0\nfix dt all mpm/dt 0.5\n", g,
                std::sin(theta) * t[0] - std::cos(theta) * n[0],
                std::sin(theta) * t[1] - std::cos(theta) * n[1]) +
      strprintf("variable x equal xcm(all,x)*%.15g+xcm(all,y)*%.15g\n", t[0], t[1]) +
      "variable w equal -angmom(all,z)/inertia(all,zz)\n" +
      strprintf("variable d atom (x-%.15g)*%.15g+(y-%.15g)*%.15g\ncompute d all reduce min v_d\n",
                foot[0], n[0], foot[1], n[1]) +
      "variable low equal c_d\n"
      "variable done equal \"time >= 0.6\"\nfix halt all halt 1 v_done == 1 error continue\nrun "
      "0\n";
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
}    // namespace

class RollingDisk : public ::testing::TestWithParam<double> {};

TEST_P(RollingDisk, OnAFace)
{
  for (const auto &incline : INCLINES)
    expect_rigid(incline,
                 roll(incline, GetParam(), "fix w all mpm/boundary ylo separate friction MU"), 0.02,
                 GetParam(), 0.0);
}

// At an angle to the lattice the benchmark allows 5 %. At 60 degrees, where 96 % of the friction is needed,
// a disk that bounces on the nodes of a region is 3 to 6 % too fast.
TEST_P(RollingDisk, OnATurnedPlane)
{
  constexpr double turned = 30.0, turn = turned * M_PI / 180;
  const std::string wall = strprintf("region p plane 0.75 2 0 %.15g %.15g 0\n"
                                     "fix w all mpm/boundary region p separate friction MU",
                                     -std::sin(turn), -std::cos(turn));
  for (const Incline incline : {Incline{30, 0.1}, {30, 0.3}, {45, 0.495}})
    expect_rigid(incline, roll(incline, GetParam(), wall, 2, turned), 0.05, GetParam(),
                 0.25 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Spacings, RollingDisk, ::testing::Values(0.05, 0.025));

SERIAL_TEST(RollingSphere, OnAFace)
{
  for (const Incline incline : {Incline{30, 0.3}, {60, 0.6}})
    expect_rigid(incline, roll(incline, 0.05, "fix w all mpm/boundary ylo separate friction MU", 3),
                 0.02, 0.05, 0.0);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// mpi: 1 2

// B-splines that are modified next to fixed faces (fix mpm ... edges modified).

#include "mpm_lammps.h"

using namespace MPM_TEST;
using MPM_NS::NODES_PER_BLOCK;

static const std::string full = space("lj", "f p f", "0 6 0 5 0 4") +
    body("box", "density 1.0 neohookean 10.0 0.3", "1.0 OPTIONS edges modified") +
    "timestep 0.001\n";

/** B-spline of a node at the place i next to a face at 0, at the distance x from the face. */
static double modified(int order, int i, double x)
{
  const double range = order == 2 ? 0.5 : 1.0;
  if (i == 0 && x < range) return order == 2 ? 1.0 - x : 1.0 - x + x * x * x / 6.0;
  if (i == 1 && x < range) return order == 2 ? x : x - x * x * x / 3.0;
  return bspline(order, x - i);
}

// The mass of the nodes is that of these functions, and there is none outside.
SERIAL_TEST(Edges, FunctionsAreModified)
{
  for (int order : {2, 3}) {
    Scene run(
        replaced(full, "OPTIONS",
                 order == 2 ? "transfer flip 1.0" : "shape cubic transfer flip 1.0 scheme musl") +
        "displace_atoms all random 0.1 0.1 0.1 4711 units box\nrun 1 post no\n");
    auto *atom = run.lmp->atom;
    double total = 0.0;
    run.each_node([&](const Scene::Node &node) {
      if (!node.owned) return;
      const int *index = node.index;
      total += node.mass;
      if (index[0] < 0 || index[0] > 6 || index[2] < 0 || index[2] > 4) {
        EXPECT_EQ(node.mass, 0.0);
        return;
      }
      double exact = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double *x = atom->x[i];    // the body is at rest
        const double wx = index[0] < 3 ? modified(order, index[0], x[0])
                                       : modified(order, 6 - index[0], 6.0 - x[0]);
        const double wz = index[2] < 2 ? modified(order, index[2], x[2])
                                       : modified(order, 4 - index[2], 4.0 - x[2]);
        double wy = 0.0;
        for (int image = -5; image <= 5; image += 5)
          wy += modified(order, 100, 100.0 + x[1] + image - index[1]);
        exact += atom->rmass[i] * wx * wy * wz;
      }
      EXPECT_NEAR(node.mass, exact, 1.0e-12);
    });
    EXPECT_NEAR(total, 120.0, 1.0e-11);
  }
}

// Linear fields are exact next to the faces, although only nodes inside and on them count: a turn
// by an angle a that all nodes are given is that of all points, and F is its matrix.
SERIAL_TEST(Edges, LinearFieldsAreExact)
{
  for (const char *options :
       {"transfer flip 1.0", "transfer pic scheme musl", "shape cubic transfer flip 1.0"}) {
    Scene run;
    const double a = 0.02, dt = 0.01;
    run.commands(
        replaced(full, "OPTIONS", options) +
        "displace_atoms all random 0.2 0.2 0.2 4711 units box\n" +
        strprintf("region everything block EDGE EDGE EDGE EDGE EDGE EDGE\n"
                  "fix turn all mpm/boundary region everything stick rotate 3 0 2 0 1 0 %g\n"
                  "timestep %g\n",
                  a / dt, dt));
    run.set_reference();
    run.commands("run 1\n");
    const double tolerance = 1.0e-14;
    for (int i = 0; i < run.n(); i++) {
      const double *X = run.reference(i), *x = run.x()[i], *F = run.points().F[i];
      const double r[2] = {X[0] - 3.0, X[2] - 2.0};
      EXPECT_NEAR(x[0] - 3.0, cos(a) * r[0] + sin(a) * r[1], tolerance) << options;
      EXPECT_NEAR(x[2] - 2.0, cos(a) * r[1] - sin(a) * r[0], tolerance) << options;
      const double R[9] = {cos(a), 0, sin(a), 0, 1, 0, -sin(a), 0, cos(a)};
      for (int c = 0; c < 9; c++) EXPECT_NEAR(F[c], R[c], tolerance) << options;
    }
  }
}

// A body that moves along its faces keeps its velocity, old and new ones of the nodes alike.
SERIAL_TEST(Edges, UniformMotionIsKept)
{
  for (const char *options : {"transfer flip 1.0", "transfer flip 1.0 scheme musl", "transfer pic",
                              "shape cubic transfer flip 0.5 scheme usf"}) {
    Scene run(replaced(full, "OPTIONS", options) + "velocity all set 0 0.5 0\nrun 5\n");
    for (int i = 0; i < run.n(); i++) {
      EXPECT_NEAR(run.v()[i][0], 0.0, 1.0e-14) << options;
      EXPECT_NEAR(run.v()[i][1], 0.5, 1.0e-14) << options;
      EXPECT_NEAR(run.v()[i][2], 0.0, 1.0e-14) << options;
    }
  }
}

// A body that fills a closed box under uniform pressure stays at rest: the sum over points of V
// grad N of a node inside is zero. That of two points per cell is exact for quadratic functions,
// whose gradients are linear in between.
SERIAL_TEST(Edges, UniformPressureMakesNoForce)
{
  for (const char *options : {"transfer flip 1.0", "transfer flip 1.0 scheme usf",
                              "transfer flip 1.0 locking pressure"}) {
    Scene run(replaced(full, "OPTIONS", options) +
              "fix box all mpm/boundary xlo xhi zlo zhi slip\n");
    for (int i = 0; i < run.n(); i++)
      for (int c = 0; c < 3; c++) run.points().tau[i][c] = -1.0;
    run.commands("run 1\n");
    for (int i = 0; i < run.n(); i++)
      for (int d = 0; d < 3; d++) EXPECT_NEAR(run.v()[i][d], 0.0, 1.0e-15) << options;
  }
}

// What nodes give to points has the same functions as what points give to nodes: a body that
// touches all faces keeps its momentum, and even velocities and gradients stay.
SERIAL_TEST(Edges, KeepMomentum)
{
  for (const char *options :
       {"transfer pic", "transfer flip 1.0", "transfer flip 1.0 scheme usavg",
        "transfer flip 1.0 frame total", "shape cubic transfer flip 1.0 scheme musl",
        "shape cubic transfer pic scheme usf"}) {
    SCOPED_TRACE(options);
    Scene run(replaced(replaced(full, "OPTIONS", options), "0.001", "0.05") +
              "displace_atoms all random 0.05 0.05 0.05 4711 units box\n"
              "variable v atom random(-0.1,0.1,4711)\nvelocity all set v_v v_v v_v\n");
    const auto before = run.sums();
    run.commands("run 20\n");
    const auto after = run.sums();
    for (int d = 0; d < 3; d++) EXPECT_NEAR(after.p[d], before.p[d], 1.0e-12 * before.mass);
    double stress = 0.0;
    for (int i = 0; i < run.n(); i++) stress = std::max(stress, std::abs(run.points().tau[i][0]));
    EXPECT_GT(stress, 0.01);
  }
  Scene run(replaced(full, "OPTIONS", "transfer flip 1.0 scheme usavg") +
            "displace_atoms all random 0.05 0.05 0.05 4711 units box\nvelocity all set 0.3 0.2 "
            "0.1\nrun 20\n");
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 6; c++) ASSERT_NEAR(run.points().tau[i][c], 0.0, 1.0e-12);
}

// Walls, rank boundaries, periodic faces, and a restart.
static const std::string moving = "fix w1 all mpm/boundary xlo xhi stick\n"
                                  "fix w2 all mpm/boundary zlo zhi slip\n"
                                  "velocity all ramp vy 0.0 1.0 x 0 6 units box\n"
                                  "velocity all ramp vz 0.0 0.5 y 0 5 units box\n";

PARAMETER_TEST(EdgesRun, AgreesOnRanksAndAfterARestart, const char *,
               Values("transfer flip 1.0 scheme musl", "shape cubic transfer flip 1.0 scheme musl",
                      "transfer flip 0.99 scheme usf", "transfer flip 1.0 frame total"))
{
  const std::string scene =
      replaced(replaced(full, "OPTIONS", GetParam()) + moving, "0.001", "0.05");
  Twins(scene, 50, lines_again(scene), 50, 1.0e-11);
}

TEST(Edges, RefuseMistakes)
{
  const std::string scene = space("lj", "f f f", "0 6 0 6 0 6");
  for (const char *options : {"shape linear transfer flip 1.0", "shape gimp transfer flip 1.0",
                              "transfer xpic 3", "transfer polypic", "transfer apic"})
    expect_error(scene + "fix grid all mpm 1.0 edges modified " + options + "\n",
                 "edges modified is for shape quadratic and cubic");
  expect_error(scene +
                   "fix grid all mpm 1.0 edges modified transfer flip 1.0 origin 0.5 0 0\n"
                   "create_points 1 box ppc 2\nfix m all mpm/material density 1 neohookean "
                   "10 0.3\ntimestep 0.01\nrun 0\n",
               "the fixed face xlo must be in a plane of nodes");
}

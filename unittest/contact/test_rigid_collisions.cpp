// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics ranks restart
// mpi: 1 2
// timeout: 300

// Bodies of fix mpm/rigid that meet walls, and each other: collisions, friction, rest.

#include "mesh/stl_testing.h"

using namespace MPM_TEST;

/** A box with a block of material in a corner, which nothing touches, and one body. file: an STL
 *  file with its shape; place: of the origin of the file. */
static std::string one_body(const std::string &file, const std::string &place,
                            const std::string &words)
{
  return space("lj", "p p f", "0 10 0 10 0 12") +
      body("block 8 9 8 9 8 9", "density 1.0 neohookean 30.0 0.3", "0.5") +
      "region shape mpm/mesh " + file + " 1.0 " + place +
      "\nfix tool all mpm/rigid shape density 2.0 separate " + words + "\n";
}

/** Gravity of size 1, turned from -z by an angle towards x. */
static std::string tilted(double angle)
{
  return strprintf("gravity %.15g 0 %.15g ", sin(angle), -cos(angle));
}

static Soup moved(Soup soup, const Point &by)
{
  for (auto &t : soup)
    for (auto &x : t)
      for (int d = 0; d < 3; d++) x[d] += by[d];
  return soup;
}

static Soup cube(double size = 1.0)
{
  const double a = 0.5 * size;
  return box({-a, -a, -a}, {a, a, a});
}

/** A disk of n sides with its axis along y, of radius and thickness 1. */
static Soup disk(int n)
{
  Soup soup = moved(cylinder(n, 1.0), {0.0, 0.0, -0.5});
  for (auto &t : soup)
    for (auto &x : t) x = {x[1], x[2], x[0]};
  return soup;
}

static const std::string floor_with = "fix floor all mpm/boundary zlo ";

// A ball that falls rises to e^2 of its height, and as often as it likes. Energy is that lost by
// the work of the floor.
SERIAL_TEST(RigidCollision, OfABallWithAFloor)
{
  const ScratchFile file("ball.stl", text_of(ball(0.5, 2)));
  for (const double e : {0.0, 0.7, 1.0}) {
    double error[2];
    for (int k = 0; k < 2; k++) {
      Scene run(one_body(file.name, "3 3 2.5", strprintf("gravity 0 0 -1 restitution %g", e)) +
                floor_with + strprintf("slip\ntimestep %g\n", 0.004 / (1 << k)));
      auto *fix = run.fix("tool");
      double apex[3] = {0.0, 0.0, 0.0}, before = 0.0;
      int bounces = 0;
      run.each_step([&](double **) {
        const double v = fix->compute_vector(5);
        if (before < 0.0 && v >= 0.0 && bounces < 2) bounces++;
        apex[bounces] = std::max(apex[bounces], fix->compute_vector(2) - 0.5);
        before = v;
      });
      run.commands(strprintf("run %d post no\n", 2200 << k));
      error[k] = std::max(fabs(apex[1] / 2.0 - e * e), fabs(apex[2] / 2.0 - e * e * e * e));
      const double mass =
          2.0 * MPM_NS::SurfaceMesh(text_of(ball(0.5, 2)), "ball", 1.0, {0, 0, 0}).volume;
      const double energy = fix->compute_scalar() + mass * (fix->compute_vector(2) - 2.5);
      EXPECT_NEAR(energy, fix->compute_vector(30), 0.005 * mass) << e;
      if (e == 0.0) EXPECT_LT(fabs(fix->compute_vector(5)), 1.0e-12);
      for (const int d : {6, 7, 8}) EXPECT_LT(fabs(fix->compute_vector(d)), 1.0e-9);
    }
    EXPECT_LT(measured(strprintf("height, e = %g", e), error[1]), 0.003);
    EXPECT_LT(error[1], 0.6 * error[0] + 1.0e-9);
  }
}

// A block slides down a plane with g (sin - mu cos), or not at all; the floor bears its weight.
SERIAL_TEST(RigidCollision, BlockSlides)
{
  const ScratchFile file("cube.stl", text_of(cube()));
  for (const double mu : {0.0, 0.2, 0.7}) {
    const double angle = PI / 6.0, a = std::max(0.0, sin(angle) - mu * cos(angle)), t = 2.0;
    Scene run(one_body(file.name, "3 3 0.5", tilted(angle)) + floor_with +
              strprintf("separate friction %g\ntimestep 0.004\nrun 500 post no\n", mu));
    auto *fix = run.fix("tool");
    EXPECT_NEAR(measured("velocity/exact", fix->compute_vector(3)), a * t, 1e-12);
    EXPECT_NEAR(fix->compute_vector(2), 0.5, 1e-12);
    EXPECT_NEAR(fix->compute_vector(26), 2.0 * cos(angle), 1e-11);
    const double along = -2.0 * (sin(angle) - a);
    EXPECT_NEAR(fix->compute_vector(24), along, 1e-12);
    EXPECT_NEAR(run.fix("floor")->compute_vector(2), -2.0 * cos(angle), 1e-11);
    EXPECT_NEAR(run.fix("floor")->compute_vector(0), -along, 1e-12);
    EXPECT_NEAR(fix->compute_vector(30), along * 0.5 * a * t * t, 1e-12 * t);
    for (const int d : {6, 7, 8}) EXPECT_LT(fabs(fix->compute_vector(d)), 1e-12);
  }
}

// Balls and disks of triangles roll as round ones: m r^2/I = 5/2 and 2; with little friction they
// slip, and spin up by mu g cos m r/I.
SERIAL_TEST(RigidCollision, RoundBodiesRoll)
{
  const double angle = PI / 6.0, t = 4.0, mus[2] = {1.0, 0.05};
  for (const bool sphere : {true, false})
    for (const double mu : mus) {
      double error[2];
      for (int k = 0; k < 2; k++) {
        const Soup soup = sphere ? ball(1.0, 2 + k) : disk(32 << k);
        const ScratchFile file("round.stl", text_of(soup));
        Scene run(one_body(file.name, "3 3 1", tilted(angle)) + floor_with +
                  strprintf("separate friction %g\ntimestep 0.004\nrun 1000 post no\n", mu));
        const double n = sphere ? 2.5 : 2.0;
        const bool rolls = mu == 1.0;
        const double a = rolls ? sin(angle) / (1.0 + 1.0 / n) : sin(angle) - mu * cos(angle);
        const double spin = rolls ? a : n * mu * cos(angle);
        auto *fix = run.fix("tool");
        error[k] = std::max(fabs(fix->compute_vector(3) / (a * t) - 1.0),
                            fabs(fix->compute_vector(7) / (spin * t) - 1.0));
        EXPECT_NEAR(fix->compute_vector(2), 1.0, 5e-8);
      }
      measured(strprintf("error, %s, mu = %g", sphere ? "ball" : "disk", mu), error[0]);
      EXPECT_LT(measured("finer", error[1]), 0.01);
      EXPECT_LT(error[1], 0.5 * error[0] + 1.0e-3);
    }
}

// A block on a rough plane falls over where tan > b/h, with the angular acceleration about its edge
SERIAL_TEST(RigidCollision, BlockTips)
{
  const ScratchFile file("tall.stl", text_of(box({-0.5, -0.5, -1.0}, {0.5, 0.5, 1.0})));
  for (const double slope : {0.49, 0.55}) {
    const double angle = atan(slope), t = 0.4;
    Scene run(one_body(file.name, "3 3 1", tilted(angle)) + floor_with +
              "stick\ntimestep 0.002\nrun 200 post no\n");
    auto *fix = run.fix("tool");
    const double moment = sin(angle) - 0.5 * cos(angle), inertia = (1.0 + 4.0) / 3.0;
    const double exact = slope > 0.5 ? moment / inertia * t : 0.0;
    EXPECT_NEAR(measured("angular velocity", fix->compute_vector(7)), exact, 1.0e-9 + 0.02 * exact);
    EXPECT_NEAR(fix->compute_vector(4), 0.0, 1e-12);
  }
}

// A ball that comes aslant and turns: the impulses of friction are mu times those across, or stop
// the sliding.
SERIAL_TEST(RigidCollision, ObliqueBounce)
{
  const double R = 0.5;
  const ScratchFile file("ball.stl", text_of(ball(R, 2)));
  const MPM_NS::SurfaceMesh mesh(text_of(ball(R, 2)), "ball", 1.0, {0.0, 0.0, 0.0});
  const double per_mass = mesh.inertia[0] / mesh.volume, e = 0.6, vn = 1.0;
  for (const double mu : {0.1, 0.8})
    for (const double omega : {0.0, 3.0}) {
      Scene run(one_body(file.name, "3 3 0.7",
                         strprintf("velocity 1 0 %g omega 0 %g 0 restitution %g", -vn, omega, e)) +
                floor_with +
                strprintf("separate friction %g\ntimestep 0.01\nrun 60 post no\n", mu));
      const double w = 1.0 - omega * R, stop = -w / (1.0 + R * R / per_mass),
                   most = mu * (1.0 + e) * vn;
      const double J = fabs(stop) < most ? stop : std::copysign(most, stop);
      auto *fix = run.fix("tool");
      EXPECT_NEAR(fix->compute_vector(5), e * vn, 1.0e-9);
      EXPECT_NEAR(fix->compute_vector(3), 1.0 + J, 3e-9) << mu << omega;
      EXPECT_NEAR(fix->compute_vector(7), omega - R * J / per_mass, 1e-8) << mu << omega;
    }
}

// Two bodies of unequal masses meet: momentum stays to round-off, and their relative speed is e
SERIAL_TEST(RigidCollision, OfTwoBodies)
{
  const ScratchFile one("one.stl", text_of(cube())), two("two.stl", text_of(ball(0.5, 2)));
  for (const auto &[file, turn] : {std::make_pair(&one, false), std::make_pair(&two, true)})
    for (const double e : {0.0, 0.5, 1.0}) {
      const std::string more = strprintf(" restitution %g friction 0.3", e);
      Scene run(one_body(one.name, "3 3 5", "velocity 1 0 0.1" + more) + "region other mpm/mesh " +
                file->name + " 1.0 5 3.1 5.2\nfix other all mpm/rigid other mass 3 separate " +
                (turn ? "omega 0.3 0.4 -0.2 " : "") + "velocity -0.5 0 0" + more +
                "\ntimestep 0.01\nrun 0 post no\n");
      auto *a = run.fix("tool"), *b = run.fix("other");
      const auto momentum = [&](int d) {
        return 2.0 * a->compute_vector(3 + d) + 3.0 * b->compute_vector(3 + d);
      };
      const double start[3] = {momentum(0), momentum(1), momentum(2)},
                   energy = a->compute_scalar() + b->compute_scalar();
      run.commands("run 120 post no\n");
      for (int d = 0; d < 3; d++) EXPECT_NEAR(momentum(d), start[d], 1.0e-12);
      EXPECT_GT(fabs(a->compute_vector(3) - 1.0), 0.5);
      EXPECT_LT(a->compute_scalar() + b->compute_scalar(), energy * (1.0 + 1.0e-9));
      const double work = a->compute_vector(30) + b->compute_vector(30);
      EXPECT_NEAR(a->compute_scalar() + b->compute_scalar() - energy, work, 1e-12 * energy);
    }
  // head-on, without turning: the relative velocity is -e times that before
  for (const double e : {0.0, 0.5, 1.0}) {
    const std::string more = strprintf(" restitution %g", e);
    Scene run(one_body(one.name, "3 3 5", "velocity 1 0 0" + more) + "region other mpm/mesh " +
              two.name +
              " 1.0 5 3 5\nfix other all mpm/rigid other mass 3 separate velocity -0.5 0 0" + more +
              "\ntimestep 0.01\nrun 100 post no\n");
    auto *a = run.fix("tool"), *b = run.fix("other");
    EXPECT_NEAR(b->compute_vector(3) - a->compute_vector(3), 1.5 * e, 1e-12);
    EXPECT_NEAR(2.0 * a->compute_vector(3) + 3.0 * b->compute_vector(3), 0.5, 1.0e-12);
  }
}

// A block at rest on a floor, and in a corner of tilted gravity, stays, for many steps
SERIAL_TEST(RigidCollision, BlocksRest)
{
  LONG_CASE();
  const ScratchFile file("cube.stl", text_of(cube()));
  const std::string scenes[2] = {
      one_body(file.name, "3 3 0.5", "gravity 0.1 0 -1 restitution 0.5") + floor_with +
          "separate friction 0.3\n",
      one_body(file.name, "0.5 3 0.5", "gravity -0.5 0 -1 restitution 0.5") + floor_with +
          "separate friction 0.3\nregion wall block INF 0 INF INF INF INF\n"
          "fix wall all mpm/boundary region wall slip\n"};
  for (const auto &text : scenes) {
    Scene run(text + "timestep 0.01\nrun 0 post no\n");
    auto *fix = run.fix("tool");
    const double x = fix->compute_vector(0);
    run.commands("run 20000 post no\n");
    EXPECT_NEAR(fix->compute_vector(0), x, 1.0e-8);
    EXPECT_NEAR(fix->compute_vector(2), 0.5, 1.0e-8);
    EXPECT_LT(fix->compute_scalar(), 1.0e-20);
    EXPECT_LT(fabs(fix->compute_vector(17)), 1.0e-8);
    EXPECT_LT(fabs(fix->compute_vector(16)), 1.0e-8);
  }
}

// A block slides down a plane that is a region, and a ball rolls down a block and a mesh
SERIAL_TEST(RigidCollision, RegionsAreWalls)
{
  const ScratchFile cubes("cube.stl", text_of(cube())), balls("ball.stl", text_of(ball(0.5, 3))),
      slab("slab.stl", text_of(box({-1.0, 0.0, -1.0}, {11.0, 10.0, 1.0})));
  const double angle = PI / 6.0, t = 2.0;
  const std::string regions[3] = {"plane 0 0 1 0 0 1 side out", "block INF INF INF INF INF 1",
                                  "mpm/mesh " + slab.name + " 1.0 0 0 0"};
  for (const auto &region : regions)
    for (const bool rolls : {false, true}) {
      const double mu = rolls ? 1.0 : 0.2;
      Scene run(one_body(rolls ? balls.name : cubes.name, "3 3 1.5", tilted(angle)) +
                "region slope " + region +
                strprintf("\nfix slope all mpm/boundary region slope separate friction %g\n"
                          "timestep 0.004\nrun 500 post no\n",
                          mu));
      const double a = rolls ? sin(angle) / 1.4 : sin(angle) - mu * cos(angle);
      EXPECT_NEAR(measured(region, run.fix("tool")->compute_vector(3) / (a * t)), 1.0,
                  rolls ? 0.01 : 1.0e-6);
      EXPECT_NEAR(run.fix("tool")->compute_vector(2), 1.5, 2e-9);
    }
}

// Walls that move: a region that rises lifts a block, which then has its velocity; a belt drags it
// by mu g until it has the speed of the belt; a wall that comes hits it with e
SERIAL_TEST(RigidCollision, WallsMove)
{
  const ScratchFile file("cube.stl", text_of(cube()));
  {
    Scene run(one_body(file.name, "3 3 1.5", "gravity 0 0 -1") +
              "variable up equal 0.05*step*dt*(step*dt<2)+(step*dt>=2)*(0.2*(step*dt-2)+0.1)\n"
              "region lift block 1 5 1 5 -1 1 move NULL NULL v_up\n"
              "fix lift all mpm/boundary region lift slip\ntimestep 0.01\nrun 400 post no\n");
    EXPECT_NEAR(run.fix("tool")->compute_vector(2), 2.0, 1e-11);
    EXPECT_NEAR(run.fix("tool")->compute_vector(5), 0.2, 1e-12);
    EXPECT_NEAR(run.fix("lift")->compute_vector(2), -2.0, 1e-9);
  }
  for (const double t : {1.0, 4.0}) {
    Scene run(one_body(file.name, "3 3 0.5", "gravity 0 0 -1") + floor_with +
              strprintf("separate friction 0.2 velocity 0.5 0 0\ntimestep 0.01\nrun %d post no\n",
                        (int) (100 * t)));
    EXPECT_NEAR(run.fix("tool")->compute_vector(3), std::min(0.5, 0.2 * t), 1e-12);
    EXPECT_NEAR(run.fix("tool")->compute_scalar(), run.fix("tool")->compute_vector(30), 1e-10);
  }
  Scene run(one_body(file.name, "3 3 3", "restitution 0.5") +
            "variable up equal 0.5*step*dt\nregion bat block 1 5 1 5 0 2 move NULL NULL v_up\n"
            "fix bat all mpm/boundary region bat slip\ntimestep 0.01\nrun 200 post no\n");
  EXPECT_NEAR(run.fix("tool")->compute_vector(5), 0.75, 1e-12);
}

// Where edges cross, the normal is that of both: a block on the ridge of another one does not slide
// off, and a block on an equal one rests on it
SERIAL_TEST(RigidCollision, EdgesMeet)
{
  Soup ridge = moved(cube(2.0), {0.0, 0.0, 0.0});
  for (auto &t : ridge)
    for (auto &x : t) x = {x[0], (x[1] - x[2]) / sqrt(2.0), (x[1] + x[2]) / sqrt(2.0)};
  const ScratchFile cubes("cube.stl", text_of(cube())), ridges("ridge.stl", text_of(ridge));
  const double top = 3.0 + sqrt(2.0);
  {
    Scene run(one_body(cubes.name, strprintf("3 3 %.15g", top + 0.5), "gravity 0 0 -1 hold rx ry") +
              "region edge mpm/mesh " + ridges.name +
              " 1.0 3 3 3\nfix edge all mpm/rigid edge density 1 slip hold x y z rx ry rz\n"
              "timestep 0.01\nrun 500 post no\n");
    EXPECT_NEAR(run.fix("tool")->compute_vector(2), top + 0.5, 2e-8);
    EXPECT_NEAR(run.fix("tool")->compute_vector(1), 3.0, 1e-11);
  }
  Scene run(one_body(cubes.name, "3 3 0.5", "gravity 0 0 -1") + floor_with +
            "slip\nregion more mpm/mesh " + cubes.name +
            " 1.0 3 3 1.5\nfix more all mpm/rigid more density 2 separate gravity 0 0 -1\n"
            "timestep 0.01\nrun 1000 post no\n");
  EXPECT_NEAR(run.fix("more")->compute_vector(2), 1.5, 1e-11);
  EXPECT_NEAR(run.fix("tool")->compute_vector(26), 2.0, 1e-11);
  EXPECT_NEAR(run.fix("floor")->compute_vector(2), -4.0, 1e-11);
}

// The tip of a cone is sharp, however small the angles between the faces that meet there: a cone
// that leans by 20 degrees stands with its tip on the floor
SERIAL_TEST(RigidCollision, ConeStandsOnItsTip)
{
  for (const int n : {8, 16, 64}) {
    Soup cone;
    const auto rim = [n](int k) {
      return Point{1.5 * cos(2.0 * PI * k / n), 1.5 * sin(2.0 * PI * k / n), 2.0};
    };
    for (int k = 0; k < n; k++) {
      cone.push_back({Point{0.0, 0.0, 0.0}, rim(k + 1), rim(k)});
      cone.push_back({Point{0.0, 0.0, 2.0}, rim(k), rim(k + 1)});
    }
    const ScratchFile file("cone.stl", text_of(cone));
    Scene run(one_body(file.name, "3 3 0.1 turn 20 0 1 0", "gravity 0 0 -1 hold rx ry rz") +
              floor_with + "slip\ntimestep 0.01\nrun 300 post no\n");
    auto *fix = run.fix("tool");
    EXPECT_NEAR(fix->compute_vector(2), 1.5 * cos(PI / 9.0), 1e-8) << n;
    EXPECT_LT(fabs(fix->compute_vector(5)), 1e-12) << n;
    const double mass = MPM_NS::SurfaceMesh(text_of(cone), "cone", 1.0, {0, 0, 0}).volume * 2.0;
    EXPECT_NEAR(run.fix("floor")->compute_vector(2), -mass, 1e-9 * mass) << n;
  }
}

// Edges of walls that intersections of regions make bear bodies: a ball on the rim of a round hole,
// whose cylinder is longer than the plate is thick, or ends with it
SERIAL_TEST(RigidCollision, BallOnAHole)
{
  const ScratchFile file("ball.stl", text_of(ball(1.0, 3)));
  const double z = 3.0 + sqrt(1.0 - 0.7 * 0.7);
  const double weight =
      2.0 * MPM_NS::SurfaceMesh(text_of(ball(1.0, 3)), "ball", 1.0, {0, 0, 0}).volume;
  for (const char *ends : {"INF INF", "2 3"}) {
    SCOPED_TRACE(ends);
    Scene run(one_body(file.name, strprintf("3 3 %.15g", z + 0.01), "gravity 0 0 -1") +
              "region slab block 0 6 0 6 2 3\nregion hole cylinder z 3 3 0.7 " + ends +
              " side out\nregion plate intersect 2 slab hole\n"
              "fix plate all mpm/boundary region plate separate friction 0.3\n"
              "timestep 0.005\nrun 600 post no\n");
    auto *fix = run.fix("tool");
    EXPECT_NEAR(measured("height/exact", fix->compute_vector(2) / z), 1.0, 2e-3);
    EXPECT_NEAR(run.fix("plate")->compute_vector(2), -weight, 0.01 * weight);
    EXPECT_NEAR(fix->compute_vector(0), 3.0, 2e-3);
  }
}

// A light plate on an elastic block next to a wall bears what the block presses on it
SERIAL_TEST(RigidCollision, WallsHoldAPlateAgainstMaterial)
{
  const ScratchFile file("plate.stl", text_of(box({0.0, 0.0, 0.0}, {4.0, 4.0, 2.0})));
  for (const double density : {1.0e-4, 1.0}) {
    Scene run(
        space("lj", "p p f", "0 4 0 4 0 8") +
        body("block 0 4 0 4 0 6", "density 1.0 linear 100.0 0.3", "1.0") +
        "fix floor all mpm/boundary zlo stick\nregion shape mpm/mesh " + file.name +
        strprintf(" 1.0 0 0 6\nfix tool all mpm/rigid shape density %g stick hold x y rx ry rz\n"
                  "fix roof all mpm/boundary zhi slip\nfix push all addforce 0 0 0.01\n"
                  "fix damp all viscous 0.1\ntimestep 0.02\nrun 1500 post no\n",
                  density));
    const double all = 0.01 * run.lmp->atom->natoms;
    const double by_roof = run.fix("roof")->compute_vector(2),
                 below = run.fix("floor")->compute_vector(2);
    EXPECT_NEAR(measured("force of walls/load", (by_roof + below) / all), 1.0, 6e-6);
    EXPECT_GT(by_roof, 0.3 * all);
    EXPECT_NEAR(run.fix("tool")->compute_vector(2), 7.0, 1e-11);
  }
}

// A body at a plane of symmetry goes through it where it is held; one that begins inside of a wall
// is told, and comes out of it at rest
SERIAL_TEST(RigidCollision, SymmetryAndOverlap)
{
  const ScratchFile balls("ball.stl", text_of(ball(1.5, 2))), cubes("cube.stl", text_of(cube(3.0)));
  const std::string plane = "region half block INF 2 INF INF INF INF\n"
                            "fix half all mpm/boundary region half slip\n",
                    told = "node spacings inside of ";
  const auto held = one_body(balls.name, "2 3 9", "gravity 0 0 -1 hold x ry rz") + plane +
      "timestep 0.01\nrun 100 post no\n";
  EXPECT_TRUE(lines_that_say(held, told).empty());
  Scene free_fall(held);
  EXPECT_NEAR(free_fall.fix("tool")->compute_vector(5), -1.0, 1e-12);
  EXPECT_EQ(free_fall.fix("tool")->compute_vector(30), 0.0);
  const auto inside = one_body(cubes.name, "3 3 1.1", "gravity 0 0 -1") + floor_with +
      "slip\ntimestep 0.01\nrun 300 post no\n";
  EXPECT_EQ(lines_that_say(replaced(inside, "3 3 1.1", "3 3 1.0"), told).size(), 1u);
  Scene out(inside);
  EXPECT_NEAR(out.fix("tool")->compute_vector(2), 1.5, 3e-6);
  EXPECT_LT(out.fix("tool")->compute_scalar(), 1e-12);
}

// Tumbling bodies that meet walls and each other are the same on all ranks, and after a restart
TEST(RigidBodies, AreTheSameOnRanksAndAfterARestart)
{
  const ScratchFile one("cube.stl", text_of(cube())), two("ball.stl", text_of(ball(0.5, 2)));
  const std::string text = one_body(one.name, "3 3 1",
                                    "friction 0.3 restitution 0.4 gravity 0 0 -1 "
                                    "velocity 0.5 0.1 -0.5 omega 0.2 1 0.3") +
      floor_with + "separate friction 0.4\nregion other mpm/mesh " + two.name +
      " 1.0 4.4 3.2 0.9\nfix other all mpm/rigid other density 1 separate friction 0.2 restitution "
      "0.6 "
      "gravity 0 0 -1\nregion wall block 5.5 6 INF INF INF INF\n"
      "fix wall all mpm/boundary region wall slip\ntimestep 0.01\n";
  Twins run(text, 180, lines_again(text), 90, 1.0e-9);
  for (const char *fix : {"tool", "other"}) {
    const double *a = run.serial.fix_vector(fix, 31), *b = run.whole.fix_vector(fix, 31);
    const double *c = run.again.fix_vector(fix, 31);
    EXPECT_LT(a[30], -0.01) << fix;    // it has met something
    for (int k = 0; k < 31; k++) {
      EXPECT_NEAR(a[k], b[k], 1e-11) << fix << k;
      EXPECT_EQ(b[k], c[k]) << fix << k;
    }
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics ranks
// mpi: 1 2

// Fix mpm/rigid: free bodies with the shape of an STL file.

#include "mesh/stl_testing.h"

using namespace MPM_TEST;

static const std::string head = space("lj", "p p f", "0 10 0 10 0 12") +
    "fix grid all mpm 0.5 GRID\nregion body block 3 7 3 7 2 5\n"
    "create_points 1 region body ppc 2\n";

/** tool: its density and the options of fix mpm/rigid. */
static std::string fixes(const std::string &file, const std::string &tool,
                         const std::string &place = "4.2 5.7 6.4")
{
  return "fix m all mpm/material density 1.0 neohookean 30.0 0.3\nregion shape mpm/mesh " + file +
      " 1.0 " + place + "\nfix tool all mpm/rigid shape density " + tool + "\ntimestep 0.01\n";
}

static std::string scene(const std::string &file, const std::string &tool, const std::string &place)
{
  return replaced(head, "GRID", "") + fixes(file, tool, place);
}

static std::string thrown(const std::string &contact)
{
  return "2.0 " + contact + " velocity 0.1 -0.2 -1.0 omega 0.3 0.8 0.5";
}

class Rigid : public ::testing::TestWithParam<const char *> {};

// A body that turns hits a block: momentum and angular momentum of both stay, to round-off.
TEST_P(Rigid, KeepsMomentum)
{
  if (nranks() > 1) GTEST_SKIP() << "sums are those of one rank";
  const ScratchFile file("torus.stl", binary_of(torus(1.0, 0.5, 24)));
  for (const char *grid : {"", "scheme musl"}) {
    Scene run(replaced(head, "GRID", grid) + fixes(file.name, thrown(GetParam())));
    const MPM_NS::SurfaceMesh mesh(binary_of(torus(1.0, 0.5, 24)), "torus", 1.0, {0.0, 0.0, 0.0});
    const double mass = 2.0 * mesh.volume;
    std::array<double, 3> p, L;
    double moved[3] = {}, pushed = 0.0, worst = 0.0;
    const auto total = [&]() {
      const auto s = run.sums();
      const double *x = run.fix_vector("tool", 24), *v = x + 3, *w = x + 6, *Q = x + 15;
      double l[3] = {};
      const double *J = mesh.inertia;
      const double I[3][3] = {{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}};
      for (int d = 0; d < 3; d++)
        for (int a = 0; a < 3; a++)
          for (int b = 0; b < 3; b++)
            for (int e = 0; e < 3; e++) l[d] += 2.0 * Q[3 * d + a] * I[a][b] * Q[3 * e + b] * w[e];
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        p[d] = s.p[d] + mass * v[d];
        L[d] = s.L[d] + l[d] + mass * (x[e] * v[f] - x[f] * v[e]);
      }
      pushed = std::min(pushed, s.p[2]);
    };
    total();
    const auto p_start = p, L_start = L;
    run.set_reference();
    run.each_step([&](double **) {
      total();
      run.add_angular_momentum_of_motion(moved);    // of musl
      for (int d = 0; d < 3; d++)
        worst =
            std::max({worst, fabs(p[d] - p_start[d]), fabs(L[d] - moved[d] - L_start[d]) / 10.0});
    });
    run.commands("run 300\n");
    EXPECT_LT(measured(std::string("momentum, ") + GetParam() + " " + grid, worst / mass), 1.0e-12);
    EXPECT_LT(pushed, -0.3 * mass);    // it did hit
  }
}

TEST_P(Rigid, IsTheSameOnAnyNumberOfRanksAndAfterARestart)
{
  const ScratchFile file("torus.stl", binary_of(torus(1.0, 0.5, 24)));
  const auto text = replaced(head, "GRID", "") + fixes(file.name, thrown(GetParam()));
  Twins run(text, 80, lines_again(text), 70, 1.0e-9);
  const double *a = run.serial.fix_vector("tool", 24), *b = run.whole.fix_vector("tool", 24);
  for (int k = 0; k < 24; k++) EXPECT_NEAR(a[k], b[k], 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Contact, Rigid,
                         Values("stick", "slip", "separate", "separate friction 0.3"));

// A face of the box that is no wall holds no body: told once, also where it is a corner that turns
SERIAL_TEST(RigidBody, TellsWhatItGoesThrough)
{
  const ScratchFile file("box.stl", text_of(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})));
  const std::string told = "the body goes through ", fall = "2.0 separate gravity 0 0 -1",
                    place = "1.5 1.5 2.0";
  const auto with = [&](const std::string &tool, const std::string &where) {
    return replaced(scene(file.name, tool, where), "block 3 7 3 7 2 5", "block 6 7 6 7 4 5");
  };
  const auto through = [&](const std::string &more, const std::string &tool,
                           const std::string &where) {
    return lines_that_say(with(tool, where) + more + "run 250\nrun 10\n", told);
  };
  const auto floor = through("", fall, place);
  ASSERT_EQ(floor.size(), 1u);
  EXPECT_THAT(floor[0], HasSubstr("face zlo of the box"));
  EXPECT_TRUE(through("", "2.0 separate", place).empty());
  EXPECT_TRUE(through("", "2.0 separate omega 1 0 0", "1.5 1.5 0.75").empty());
  EXPECT_TRUE(through("", "2.0 separate omega 0 0 1", "1.5 1.5 0.55").empty());
  EXPECT_EQ(through("", "2.0 separate omega 1 0 0", "1.5 1.5 0.55").size(), 1u);
  EXPECT_TRUE(through("", "2.0 separate velocity 1 0 0", place).empty());    // a periodic face
  EXPECT_TRUE(through("", fall + " collide no", place).empty());
  EXPECT_TRUE(through("fix floor all mpm/boundary zlo stick\n", fall, place).empty());
}

// Without contact an unequal box turns about no fixed axis: its energy stays, to second order.
SERIAL_TEST(RigidBody, TurnsFreely)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {0.5, 1.0, 1.5})));
  double drift[2];
  for (int k = 0; k < 2; k++) {
    Scene run(scene(file.name, "2.0 slip omega 0.2 2.0 0.1", "4.2 5.7 9.0") +
              strprintf("timestep %g\n", 0.02 / (1 << k)));
    auto *body = run.fix("tool");
    const double start = body->compute_scalar();
    double worst = 0.0, most = 0.0;
    for (int n = 0; n < 20; n++) {
      run.commands(strprintf("run %d post no\n", 25 << k));
      worst = std::max(worst, fabs(body->compute_scalar() / start - 1.0));
      most = std::max(most, fabs(body->compute_vector(8)));
    }
    EXPECT_GT(most, 0.5);    // about the middle axis it tumbles
    drift[k] = worst;
  }
  EXPECT_LT(measured("drift of the energy", drift[1]), 4e-5);
  EXPECT_NEAR(measured("order", log2(drift[0] / drift[1])), 2.0, 0.1);
}

// A body on the end of an elastic column: beta tan beta = m/M with beta = omega l/c.
SERIAL_TEST(RigidBody, SwingsOnAColumn)
{
  LONG_CASE();
  const ScratchFile file("box.stl", text_of(box({-1.0, -1.0, 0.0}, {3.0, 3.0, 3.0})));
  const double length = 10.0, M = 25.0, column = length;
  double beta = 0.5;
  const double end = M + 0.5;    // with the material inside of it
  for (int k = 0; k < 100; k++) beta = atan2(column / end, beta) * 0.5 + 0.5 * beta;
  const double c = sqrt(100.0 * 0.7 / (1.3 * 0.4));    // E = 100, nu = .3, density 1
  const double period = 2.0 * PI * length / (beta * c);
  double error[2];
  for (int k = 0; k < 2; k++) {
    const double h = 0.5 / (1 << k), dt = 0.04 * h;
    Scene run(
        space("lj", "f f f", "0 1 0 1 0 14") +
        body("block 0 1 0 1 0 10.5", "density 1.0 linear 100.0 0.3",
             strprintf("%g transfer flip 1.0 scheme musl", h)) +
        strprintf("fix floor all mpm/boundary zlo stick\n"
                  "fix sides all mpm/boundary xlo xhi ylo yhi slip\n"
                  "region shape mpm/mesh %s 1.0 0 0 9.99\n"
                  "fix tool all mpm/rigid shape mass %g stick velocity 0 0 0.02 hold x y rx ry rz\n"
                  "timestep %g\n",
                  file.name.c_str(), M, dt));
    auto *body = run.fix("tool");
    std::vector<double> crossings;
    double before = 0.0;
    const double z = body->compute_vector(2);
    run.each_step([&](double **) {
      const double u = body->compute_vector(2) - z;
      if (before * u < 0.0) crossings.push_back(run.time() - dt * u / (u - before));
      before = u;
    });
    run.commands(strprintf("run %d post no\n", (int) (2.1 * period / dt)));
    ASSERT_GE(crossings.size(), 4u);
    error[k] = fabs(measured("period/exact", (crossings[3] - crossings[1]) / period) - 1.0);
  }
  EXPECT_LT(error[1], 0.3 * error[0]);    // second order
  EXPECT_LT(error[1], 0.006);
}

// A body that weighs nothing goes with the material.
TEST(RigidBody, MayBeLight)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {1.2, 1.2, 1.2})));
  Scene run(scene(file.name, "1.0e-9 stick", "4.4 4.4 2.9") +
            "velocity all set 0.1 0.2 0.3\nrun 200\n");
  auto *body = run.fix("tool");
  for (int d = 0; d < 3; d++) EXPECT_NEAR(body->compute_vector(3 + d), 0.1 * (d + 1), 5e-7);
}

// What moves away from a block is let go, unless contact holds the normal direction both ways.
TEST(RigidBody, LetsGo)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {8.0, 8.0, 3.0})));
  for (const std::string kind : {"separate", "separate friction 0.3", "slip"}) {
    Scene run(scene(file.name, "2.0 " + kind + " velocity 0 0 0.3", "1 1 4.8") + "run 30\n");
    const double v = run.fix("tool")->compute_vector(5);
    if (kind == "slip")
      EXPECT_LT(v, 0.29);    // it did touch
    else
      EXPECT_NEAR(v, 0.3, 1.0e-14) << kind;
  }
}

// Weight, forces, and held directions.
TEST(RigidBody, FallsAndIsHeld)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0})));
  Scene run("variable f equal 3.0\n" +
            scene(file.name, "2.0 slip gravity 0 0 -0.5 force v_f 1.0 0 torque 0 0 0.1 hold y",
                  "4.4 4.4 8.0") +
            "run 100\n");
  auto *body = run.fix("tool");
  EXPECT_NEAR(body->compute_vector(3), 1.5, 1.0e-12);
  EXPECT_EQ(body->compute_vector(4), 0.0);
  EXPECT_NEAR(body->compute_vector(5), -0.5, 1.0e-12);
  EXPECT_NEAR(body->compute_vector(8), 0.1 / (2.0 / 6.0), 1e-12);
}

// A body that is held in its turns about x and y turns about z as its moment of inertia about z
// says, also if the axis is none of its principal axes
SERIAL_TEST(RigidBody, TurnsAboutAHeldAxis)
{
  const Soup soup = sheared(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), 0.8);
  const ScratchFile file("sheared.stl", text_of(soup));
  Scene run(scene(file.name, "2.0 slip omega 0 0 0.3 torque 0 0 0.5 hold rx ry", "4.4 4.4 8.0") +
            "run 300\n");
  auto *body = run.fix("tool");
  const double inertia = 2.0 * (2.0 + 1.25 * 0.64) / 12.0, t = 3.0;
  EXPECT_EQ(body->compute_vector(6), 0.0);
  EXPECT_EQ(body->compute_vector(7), 0.0);
  EXPECT_NEAR(body->compute_vector(8), 0.3 + 0.5 * t / inertia, 1e-11);
  const double angle = 0.3 * t + 0.25 * (t * t + 0.01 * t) / inertia;    // semi-implicit steps
  EXPECT_NEAR(body->compute_vector(15), cos(angle), 1e-12);
  EXPECT_NEAR(body->compute_vector(18), sin(angle), 1e-12);
  EXPECT_NEAR(body->compute_vector(23), 1.0, 1.0e-12);
}

// With MUSL, the velocities that are mapped back for the gradient are those of the body, too, as
// far as it has decided about them: at all nodes inside, and with slip along its face only
TEST(RigidBody, HoldsWhatIsMappedBack)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {6.0, 6.0, 3.0})));
  for (const char *contact : {"stick", "slip"}) {
    Scene run(replaced(head, "GRID", "transfer flip 1.0 scheme musl") +
              fixes(file.name,
                    strprintf("2.0 %s velocity 0.1 -0.2 -1.0 omega 0 0 0.4 hold rx ry", contact),
                    "2 2 4.7") +
              "run 1\n");
    const double *state = run.fix_vector("tool", 24), *V = state + 3;
    int found = 0;
    double slides = 0.0;
    run.each_node([&](const Scene::Node &node) {
      if (node.alias || node.mass == 0.0 || fabs(node.x[2] - 5.0) > 1.0e-9) return;
      const double x = node.x[0] - (state[0] - 0.01 * V[0]),
                   y = node.x[1] - (state[1] - 0.01 * V[1]);
      EXPECT_NEAR(node.v[2], V[2], 1.0e-12) << contact;
      slides = std::max(
          slides, hypot(node.v[0] - (V[0] - state[8] * y), node.v[1] - (V[1] + state[8] * x)));
      found++;
    });
    EXPECT_GT(over_ranks(found), 60);
    EXPECT_LT(V[2], -0.1);
    if (!strcmp(contact, "stick"))
      EXPECT_LT(over_ranks(slides, MPI_MAX), 1.0e-12);
    else
      EXPECT_GT(over_ranks(slides, MPI_MAX), 0.1);
  }
}

// A thick plate that lies on a block, which is smaller than it, with friction
static std::string plate(double h, const std::string &file, const std::string &words,
                         double timestep)
{
  return space("lj", "p p f", "0 8 0 8 0 4") +
      body("block 2.5 5.5 2.5 5.5 0 1", "density 1.0 neohookean 2000.0 0.3", strprintf("%g", h)) +
      strprintf("fix floor all mpm/boundary zlo stick\n"
                "region shape mpm/mesh %s 1.0 1.0 1.0 0.95\nfix tool all mpm/rigid shape %s\n"
                "timestep %g\n",
                file.c_str(), words.c_str(), timestep);
}

// As long as it slides, each impulse along the block is the coefficient times the one across, also
// when the plate weighs less than the nodes below it. In the end it sticks.
SERIAL_TEST(RigidBody, SlidesUntilItSticks)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {6.0, 6.0, 3.0})));
  const double mu = 0.4, v0 = 0.5, g = 0.5;
  for (const double density : {0.4, 0.01}) {
    Scene run(plate(0.5, file.name,
                    strprintf("density %g separate friction %g velocity %g 0 0 gravity 0 0 %g "
                              "hold rx ry rz",
                              density, mu, v0, -g),
                    0.002));
    auto *body = run.fix("tool");
    double worst = 0.0, largest = 0.0;
    run.each_step([&](double **) {
      if (body->compute_vector(3) < 0.5 * v0) return;
      const double along = v0 - body->compute_vector(3);
      worst = std::max(worst, fabs(along - mu * (body->compute_vector(5) + g * run.time())));
      largest = std::max(largest, along);
    });
    run.commands("run 2000 post no\n");
    EXPECT_GT(largest, 0.45 * v0);
    EXPECT_LT(measured("friction - mu times push", worst / v0), 1e-4);
    EXPECT_LT(fabs(measured("last velocity", body->compute_vector(3) / v0)), 0.02);
    EXPECT_LT(fabs(body->compute_vector(4) / v0), 1.0e-6);
  }
}

// When it spins, the moment of friction is mu N times the mean distance of a square from its
// center, which is (sqrt(2) + asinh(1)) / 6 of its side for a uniform pressure.
SERIAL_TEST(RigidBody, SpinsUntilItSticks)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {6.0, 6.0, 3.0})));
  const double mu = 0.8, g = 2.0, omega = 0.5;
  Scene run(plate(0.25, file.name,
                  strprintf("density 1.0 separate friction %g omega 0 0 %g gravity 0 0 %g "
                            "hold x y rx ry",
                            mu, omega, -g),
                  0.001));
  auto *body = run.fix("tool");
  const double arm = 3.0 * (sqrt(2.0) + asinh(1.0)) / 6.0, inertia = 36.0 / 6.0;    // per mass
  double along = 0.0, across = 0.0;
  run.each_step([&](double **) {
    if (body->compute_vector(8) < 0.5 * omega) return;
    along = inertia * (omega - body->compute_vector(8));
    across = body->compute_vector(5) + g * run.time();
  });
  run.commands("run 2000 post no\n");
  EXPECT_GT(along, 0.45 * inertia * omega);
  EXPECT_NEAR(measured("moment/exact", along / (mu * arm * across)), 1.0, 0.05);
  EXPECT_LT(fabs(measured("last spin", body->compute_vector(8) / omega)), 0.02);
}

// Each step by itself: with the velocity that the body has after the step, no node goes through its
// surface, and friction is at its limit and against the sliding, or there is none. A light plate on
// a block that comes up and turns, so that nodes stick and slide into all directions.
static std::map<std::array<int, 3>, Scene::Node> nodes_of(Scene &run)
{
  std::map<std::array<int, 3>, Scene::Node> all;
  run.each_node([&](const Scene::Node &node) {
    if (node.owned && node.mass > 0.0) all[{node.index[0], node.index[1], node.index[2]}] = node;
  });
  return all;
}

SERIAL_TEST(RigidBody, FrictionIsThatOfTheVelocityAfterTheStep)
{
  const Soup soup = box({0.0, 0.0, 0.0}, {6.0, 6.0, 3.0});
  const ScratchFile file("box.stl", text_of(soup));
  const MPM_NS::SurfaceMesh mesh(binary_of(soup), "box", 1.0, {0.0, 0.0, 0.0});
  const double mu = 0.4, bottom = 0.95;
  int sliding = 0, sticking = 0;
  for (const double density : {1.0, 0.01, 1.0e-4})
    for (const char *hold : {"hold rx ry rz", ""}) {
      SCOPED_TRACE(strprintf("density %g %s", density, hold));
      const auto prepare = [&](Scene &run) {
        run.commands(plate(
            0.5, file.name,
            strprintf("density %g separate friction %g velocity 0.1 0.05 -0.2 ", density, mu) +
                hold,
            0.002));
        run.set_velocity([](const double *x, double *v) {
          v[0] = -0.3 * (x[1] - 3.6);
          v[1] = 0.3 * (x[0] - 4.1);
          v[2] = 0.2 + 0.02 * (x[0] - 4.0);
        });
      };
      Scene alone, run;
      prepare(alone);
      alone.commands("unfix tool\nrun 1 post no\n");
      auto before = nodes_of(alone);
      prepare(run);
      const double center[3] = {4.0, 4.0, 2.45};
      run.commands("run 1 post no\n");
      // its angular momentum is known at the end of the step; the inertia here, that of the start
      const double *state = run.fix_vector("tool", 24), *Q = state + 15, *I = mesh.inertia;
      double spin[3] = {0.0};
      for (int d = 0; d < 3; d++)
        for (int a = 0; a < 3; a++)
          for (int e = 0; e < 3; e++)
            spin[d] += Q[3 * d + a] * I[a] * Q[3 * e + a] * state[6 + e] / I[d];
      for (const auto &[index, node] : nodes_of(run)) {
        if (node.x[2] < bottom) continue;
        double r[3], w[3], push[3];
        for (int d = 0; d < 3; d++) r[d] = node.x[d] - center[d];
        for (int d = 0; d < 3; d++) {
          const int e = (d + 1) % 3, f = (d + 2) % 3;
          w[d] = state[3 + d] + spin[e] * r[f] - spin[f] * r[e] - node.v[d];
          push[d] = node.v[d] - before.at(index).v[d];
        }
        if (push[2] == 0.0) {
          EXPECT_GT(w[2], -1.0e-9);    // the body leaves it
          continue;
        }
        EXPECT_LT(push[2], 0.0);
        EXPECT_NEAR(w[2], 0.0, 1.0e-9);
        const double along = hypot(push[0], push[1]), slide = hypot(w[0], w[1]),
                     most = -mu * push[2];
        if (slide > 1.0e-9) {
          EXPECT_NEAR(along, most, 1e-12);
          EXPECT_NEAR(push[0] * w[0] + push[1] * w[1], along * slide, 1e-12 * slide);
          sliding++;
        } else {
          EXPECT_LT(along, most + 1.0e-9);
          sticking++;
        }
      }
    }
  EXPECT_GT(sliding, 100);
  EXPECT_GT(sticking, 10);
}

// Fix mpm/dt follows a body that is much faster than waves: it does not pass the block unseen.
SERIAL_TEST(RigidBody, IsNotTooFastForTheBlock)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0})));
  Scene run(scene(file.name, "2.0 slip velocity 0 0 -1000", "4.5 4.5 6.5") +
            "fix step all mpm/dt 0.5 every 1\nrun 0\n");
  EXPECT_NEAR(run.lmp->update->dt, 0.5 * 0.5 / 1000.0, 1e-13);
  EXPECT_EQ(run.fix("step")->compute_vector(0), 0.0);    // no point
  run.commands("run 12\n");
  EXPECT_LT(run.sums().p[2], -10.0);
}

// A body that swings on elastic material gives this the kinetic energy that it loses, with any time
// step: to round-off, and where it turns up to what its inertia has turned by in a step
TEST(RigidBody, GivesWhatItLoses)
{
  const ScratchFile file("box.stl", text_of(box({-1.0, -1.0, 5.0}, {5.0, 5.0, 9.0})));
  for (const std::string motion : {"velocity 0 0 -0.3 hold x y rx ry rz", "omega 0 0 0.05"})
    for (const double dt : first_of(1, {0.4, 0.1})) {
      Scene run(space("lj", "p p p", "-2 6 -2 6 -1 12") +
                body("block 0 4 0 4 0 6", "density 1 linear 100 0.2", "1.0 transfer apic") +
                "region low block INF INF INF INF INF 0.4\n"
                "fix w all mpm/boundary region low stick\nregion tool mpm/mesh " +
                file.name + " 1 0 0 0\nfix body all mpm/rigid tool mass 400 stick " + motion +
                strprintf("\nfix dt all mpm/dt %g until 40\n", dt) +
                "compute e all mpm/energy\nthermo_style custom step c_e\nrun 0\n");
      const double start = run.fix("body")->compute_scalar();
      run.commands("run 100000\n");
      const double lost = start - run.fix("body")->compute_scalar();
      const double *const e = run.compute_vector();
      EXPECT_GT(lost, 0.1 * start) << motion;
      EXPECT_NEAR(measured("contact over lost", e[7] / lost), 1.0, motion[0] == 'v' ? 1e-10 : 1e-5)
          << motion << dt;
      EXPECT_LT(e[8], 0.0) << motion << dt;    // transfers lose
      EXPECT_LT(std::fabs(e[10]), 1e-12 * start);
    }
}

TEST(RigidBody, RefusesMistakes)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0})));
  const std::string fix = "fix t all mpm/rigid shape density 2.0 ";
  expect_refused(
      replaced(head, "GRID", "") + "fix m all mpm/material density 1.0 neohookean 30.0 0.3\n" +
          "region shape mpm/mesh " + file.name +
          " 1.0 4 4 8\ntimestep 0.01\nvariable a atom x\nvariable z equal 0\n" +
          "variable big equal 1e308*10\n" + "region turned mpm/mesh " + file.name +
          " 1.0 4 4 8 rotate v_z 0 0 0 0 0 1\n",
      {{"fix t all mpm/rigid body density 1.0 slip", "needs a region of style mpm/mesh: body"},
       {"fix t all mpm/rigid shape density 1.0 slip force 1 0 0 force 0 1 0",
        "force is given twice"},
       {"fix t all mpm/rigid shape density 0.0 slip", "density must be positive: 0.0"},
       {"fix t all mpm/rigid shape weight 1.0 slip", "must be one of density mass"},
       {fix + "glue", "Unknown fix mpm/rigid contact glue"},
       {"fix t all mpm/rigid turned density 2.0 slip", "at rest and with side in"},
       {fix + "stick friction 0.1", "friction is for slip and separate"},
       {fix + "slip friction -0.1", "must not be negative: -0.1"},
       {fix + "slip restitution 1.5", "restitution must be within 0 and 1: 1.5"},
       {fix + "slip hold w", "one or more of x y z rx ry rz"},
       {fix + "slip velocity 1 0 0 hold x", "cannot hold x"},
       {fix + "slip sharp", "Unknown fix mpm/rigid keyword: sharp"},
       {fix + "slip force v_a 0 0", "Variable a for fix mpm/rigid force is not equal-style"},
       {fix + "slip force v_big 0 0", "Variable big is inf"},
       {"unfix grid\nfix grid all mpm 0.5 dtcheck no\n" + fix +
            "slip gravity 0 1e308 0\ntimestep 1e9",
        "position or velocity of the body is not finite at step 1"},
       {fix + "slip velocity 0 0 -100", "the body crosses 2 cells of fix mpm grid in step 1"},
       {fix + "slip omega 0 0 100", "the body crosses 1.73 cells of fix mpm grid in step 1"},
       {fix + "slip\nfix t2 all mpm/rigid shape density 1.0 slip", "have the same region shape"},
       {"unfix grid\nfix grid all mpm 1e-4\n" + fix + "slip",
        "of area 6, goes through 6.0e+08 cells of the node spacing 0.0001"},
       {"unfix grid\nfix grid all mpm 0.5 frame total\n" + fix + "slip", "use frame updated"},
       {"unfix grid\nfix grid all mpm 0.5 scheme usf\n" + fix + "slip", "use usl or musl"}},
      "run 1\n");
}

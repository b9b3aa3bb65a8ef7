// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/mesh/contact: bodies on one mesh that touch, slide, and part, against Coulomb's law, the
// exact motion of bars that collide, and the weights of what lies on what.

#include "meshgrid/mesh_grid_testing.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

/** A mesh of cells of size h from the origin, inside bent by a part of these. */
std::string cells(Kind kind, double h, std::array<int, 3> n, double bent = 0.0)
{
  return gmsh(kind, n, [=](double x, double y, double z) {
    const double X = x * n[0], Y = y * n[1];
    const bool inside =
        x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0 && (kind < TETRAHEDRA || (z > 0.0 && z < 1.0));
    const double d = inside ? bent : 0.0;
    return std::array<double, 3>{h * (X + d * sin(3.1 * X + 1.7 * Y)),
                                 h * (Y + d * cos(2.3 * X - 4.1 * Y)), h * n[2] * z};
  });
}

/** The part of a block of points, 2d: without its extent along z. */
std::string block(int type, const std::string &xy, const std::string &z, double spacing)
{
  const std::string name = "r" + std::to_string(type);
  return "region " + name + " block " + xy + " " + z + "\ncreate_points " + std::to_string(type) +
      " region " + name + strprintf(" spacing %.17g\ngroup b%d type %d\n", spacing, type, type);
}

double row(Scene &run, int pair, int column)
{
  return run.lmp->modify->get_fix_by_id("touch")->compute_array(pair, column);
}

/** A block of 1 x 0.5 with a velocity of 1 on a floor, both elastic; gravity 1. */
std::string slide(Kind kind, const std::string &mesh, const std::string &law,
                  const std::string &units = "lj")
{
  const bool solid = kind >= TETRAHEDRA;
  return box(solid ? 3 : 2, units.c_str(), solid ? "f f f" : "f f p",
             solid ? "0 2.4 0 1.3 0 0.4" : "0 2.4 0 1.3 -0.5 0.5", 2, 0.1) +
      block(1, "0 2.4 0 0.5", solid ? "0 0.4" : "-0.5 0.5", 0.05) +
      block(2, "0.35 1.35 0.5 1", solid ? "0.1 0.3" : "-0.5 0.5", 0.05) +
      "fix m all mpm/material density 1 neohookean 1000 0.3\nfix g all mpm/mesh " + mesh +
      " velocity ylo 0 0 " + (solid ? "0 slip zlo slip zhi" : "") +
      " slip xlo slip xhi\nfix touch all mpm/mesh/contact g b1 b2 " + law +
      "\nfix down all gravity 1 vector 0 -1 0\nvelocity b2 set 1 0 0\nfix d all mpm/dt 0.4 until "
      "0.9\nvariable v equal vcm(b2,x)\n";
}

// Coulomb's law; without friction the block keeps its velocity, as nothing is in its way
SERIAL_TEST(MeshContact, BlockThatSlides)
{
  struct Case {
    Kind kind;
    double bent;
  };
  for (const auto &[kind, bent] :
       first_of(2, {Case{QUADS, 0.0}, Case{TRIANGLES, 0.2}, Case{TETRAHEDRA, 0.0}})) {
    const ScratchFile file("slide.msh", cells(kind, 0.1, {24, 13, 4}, bent));
    for (const double mu : first_of(1, {0.3, 0.0})) {
      const std::string law = kind == QUADS ? "law coulomb 0.3 0.4" : "law coulomb 0.3";
      Scene run(slide(kind, file.name, mu > 0.0 ? law : "") + "run 100000\n");
      const double left = 0.9 * mu, v = run.variable("v");
      if (mu == 0.0) {
        EXPECT_NEAR(measured("velocity without friction", v), 1.0, 5e-4);
        EXPECT_EQ(run.lmp->modify->get_fix_by_id("touch")->compute_scalar(), 0.0);
      } else {
        EXPECT_NEAR(measured("loss of velocity by friction", (1.0 - v) / left), 1.0, 0.02);
        const double work = run.lmp->modify->get_fix_by_id("touch")->compute_scalar();
        const double energy = 0.5 * (kind == TETRAHEDRA ? 0.1 : 0.5) * (1.0 - v * v);
        EXPECT_NEAR(measured("work of friction", -work / energy), 1.0, 0.02);    // of the block
      }
    }
  }
}

// Static friction holds up to its coefficient; what is above slides with the kinetic one; stick
// does not slide. The block has settled before it is pulled, more and more for a time of 0.3
SERIAL_TEST(MeshContact, BlockThatIsPulled)
{
  const ScratchFile file("slide.msh", cells(QUADS, 0.1, {24, 13, 0}));
  const auto way = [&](const std::string &law, double pull, double until) {
    Scene run(replaced(slide(QUADS, file.name, law), "set 1 0 0", "set 0 0 0") +
              "fix slow all viscous 0.02\nfix d all mpm/dt 0.4 until 0.3\n"
              "variable x equal xcm(b2,x)\nrun 100000\n");
    const double x = run.variable("x");
    run.commands(strprintf("variable pull equal "
                           "%g*0.0025*((time<0.6)*(time-0.3)/0.3+(time>=0.6))\n",
                           pull));
    run.commands(strprintf("unfix d\nfix d all mpm/dt 0.4 until %g\nfix pull b2 addforce v_pull 0 "
                           "0\nrun 100000\n",
                           until));
    return run.variable("x") - x;
  };
  // what is held moves by rho a H (H/2 + H_floor)/G: the floor is longer, and moves less
  const double shear = 0.5 / 385 * (0.5 / 2 + 0.5);
  EXPECT_LT(measured("way of a block that is held", way("law coulomb 0.4", 0.3, 1.0)), 0.3 * shear);
  EXPECT_LT(measured("by static friction only", way("law coulomb 0.1 0.4", 0.15, 1.0)),
            0.15 * shear);
  EXPECT_LT(measured("way of one that sticks", way("law stick", 1.0, 1.0)), shear);
}

// Two equal bars that meet exchange their velocities: they touch when they should, part when the
// waves are back, and their momentum is what it was to the last digit
SERIAL_TEST(MeshContact, BarsThatCollide)
{
  double lost[2];
  for (const Kind kind : {QUADS, TRIANGLES, HEXAHEDRA}) {
    const bool solid = kind == HEXAHEDRA;
    for (const int n : {10, 20}) {
      if (n == 20 && kind != QUADS) continue;
      const double h = 1.0 / n;
      const ScratchFile file("bars.msh", cells(kind, h, {6 * n, 2, 2}));
      const std::string side = strprintf(" 0 %g", 2 * h);
      Scene run(box(solid ? 3 : 2, "lj", solid ? "f f f" : "f f p",
                    "0 6" + side + (solid ? side : " -0.5 0.5"), 2, h) +
                block(1, "0.8 2.8" + side, solid ? side : "-0.5 0.5", 0.5 * h) +
                block(2, "2.8 4.8" + side, solid ? side : "-0.5 0.5", 0.5 * h) +
                "displace_atoms b2 move 0.02 0 0 units box\n"
                "fix m all mpm/material density 1 neohookean 1 0\nfix g all mpm/mesh " +
                file.name + " transfer flip 1 slip ylo slip yhi" +
                (solid ? " slip zlo slip zhi" : "") +
                "\nfix touch all mpm/mesh/contact g b1 b2\nvelocity b1 set 0.01 0 0\n"
                "velocity b2 set -0.01 0 0\ntimestep " +
                strprintf("%g", 0.25 * h) +
                "\nvariable a equal vcm(b1,x)\nvariable b equal vcm(b2,x)\nrun 0\n");
      double first = 0.0, worst = 0.0, impulse = 0.0, mean = 0.0;
      while (run.evaluate("time") < 6.5) {
        run.commands("run 1 post no\n");
        const double now = run.evaluate("time"), force = std::fabs(row(run, 0, 0));
        if (force > 0.0 && first == 0.0) first = now;
        impulse += force;
        mean += now * force;
        worst = std::max(worst, std::fabs(run.variable("a") + run.variable("b")) / 0.01);
      }
      EXPECT_LT(measured("momentum", worst), 1e-13);
      EXPECT_NEAR(measured("first touch", first), 1.0, 0.03);    // rounding and one step
      EXPECT_NEAR(measured("mean time of the force", mean / impulse), 1.0 + 2.0,
                  n == 20 ? 0.06 : 0.15);
      const double left = measured("velocity after", -run.variable("a") / 0.01);
      if (kind == QUADS) lost[n == 20] = 1.0 - left;
      EXPECT_GT(left, n == 20 ? 0.95 : 0.9);
    }
  }
  EXPECT_GT(lost[0] / lost[1], 1.25);    // a wave front, which is never smooth
}

// At rest each bears the weight above; the upper two are side by side: three bodies at a node
SERIAL_TEST(MeshContact, BlocksAtRest)
{
  for (const Kind kind : {QUADS, TRIANGLES}) {
    const ScratchFile file("rest.msh", cells(kind, 0.1, {16, 13, 0}));
    Scene run(
        box(2, "lj", "f f p", "0 1.6 0 1.3 -0.5 0.5", 3, 0.1) +
        block(1, "0 1.6 0 0.5", "-0.5 0.5", 0.05) + block(2, "0.2 0.8 0.5 1", "-0.5 0.5", 0.05) +
        block(3, "0.8 1.3 0.5 0.8", "-0.5 0.5", 0.05) +
        "fix m all mpm/material density 1 neohookean 100 0.3\nfix g all mpm/mesh " + file.name +
        " velocity ylo 0 0 slip xlo slip xhi\n"
        "fix touch all mpm/mesh/contact g b1 b2 b3 law coulomb 0.3\n"
        "fix down all gravity 1 vector 0 -1 0\nfix slow all viscous 0.02\n"
        "variable one equal f_touch[1][2]\nvariable two equal f_touch[2][2]\n"
        "variable side equal f_touch[3][1]+f_touch[2][1]\n"
        "fix mean all ave/time 1 400 400 v_one v_two v_side\nfix d all mpm/dt 0.4\nrun 1200\n");
    auto *mean = run.lmp->modify->get_fix_by_id("mean");
    EXPECT_NEAR(measured("weight of the first", mean->compute_vector(0) / 0.3), 1.0, 0.02);
    EXPECT_NEAR(measured("weight of the second", mean->compute_vector(1) / 0.15), 1.0, 0.02);
    EXPECT_NEAR(measured("forces on the second to the side", mean->compute_vector(2)), 0.0,
                1e-4 * 0.15);
  }
}

/** A block on a block between smooth walls, a load on top of the mesh. parts: two upper blocks. */
std::string pressed(const std::string &mesh, const std::string &load, bool parts)
{
  return box(2, "lj", "f f p", "0 1.6 0 1 -0.5 0.5", 3, 0.1) +
      block(1, "0 1.6 0 0.5", "-0.5 0.5", 0.05) +
      block(2, parts ? "0 0.8 0.5 1" : "0 1.6 0.5 1", "-0.5 0.5", 0.05) +
      (parts ? block(3, "0.8 1.6 0.5 1", "-0.5 0.5", 0.05) : "") +
      "fix m all mpm/material density 1 neohookean 1000 0.3\nfix g all mpm/mesh " + mesh +
      " velocity ylo 0 0 slip xlo slip xhi " + load + "\nfix touch all mpm/mesh/contact g b1 b2" +
      (parts ? " b3" : "") + "\ntimestep 5e-4\nthermo_modify norm no\n";
}

// A load on a side of the mesh is of the body that is there: the force of contact becomes the load,
// and each step changes the momentum of the upper block by load and contact
SERIAL_TEST(MeshContact, PressedBlock)
{
  for (const Kind kind : {QUADS, TRIANGLES})
    for (const char *load : {"pressure yhi 5", "traction yhi 0 -5"}) {
      const ScratchFile file("pressed.msh", cells(kind, 0.1, {16, 10, 0}));
      Scene run(pressed(file.name, load, false));
      run.commands("run 0 post no\n");
      const auto momentum = [&] {
        return run.evaluate("mass(b2)*vcm(b2,y)");
      };
      for (int k = 0; k < 20; k++) {
        const double before = momentum();
        run.commands("run 1 post no\n");
        const double force = row(run, 0, 1) - 8.0;
        EXPECT_NEAR(momentum() - before, run.lmp->update->dt * force, 1e-12);
      }
      EXPECT_NEAR(run.evaluate("f_g[15]"), -8.0, 1e-12);    // of the load
      run.commands("fix slow all viscous 0.05\nvariable f equal f_touch[1][2]\n"
                   "fix mean all ave/time 1 400 400 v_f\nrun 2000\n");
      const double mean = run.lmp->modify->get_fix_by_id("mean")->compute_scalar();
      EXPECT_NEAR(measured(std::string(load) + ": contact over load", mean / 8.0), 1.0, 1.5e-4);
      // uniaxial strain; points on sides of triangles make bodies softer, without contact, too
      if (kind != QUADS) continue;
      double top = 0.0, n = 0.0;
      for (int i = 0; i < run.n(); i++)
        if (run.x()[i][1] > 0.95) {
          top += run.x()[i][1] - 0.975;
          n++;
        }
      const double M = 1000.0 * 0.7 / (1.3 * 0.4);
      EXPECT_NEAR(measured("settlement", -top / n / (0.975 * 5.0 / M)), 1.0, 0.03);
    }
}

// Where two bodies meet at the side, each has its share of the load: none is lost or there twice
SERIAL_TEST(MeshContact, LoadOfTwoBodies)
{
  const ScratchFile file("pressed.msh", cells(QUADS, 0.1, {16, 10, 0}));
  Scene run(pressed(file.name, "pressure yhi 5", true));
  run.commands("run 0 post no\nvariable p equal mass(all)*vcm(all,y)\nrun 1 post no\n");
  EXPECT_NEAR(run.evaluate("v_p") / (-8.0 * run.lmp->update->dt), 1.0, 1e-12);
  for (const char *body : {"b2", "b3"})
    EXPECT_NEAR(run.evaluate(strprintf("mass(%s)*vcm(%s,y)", body, body)) /
                    (-4.0 * run.lmp->update->dt),
                1.0, 1e-12);
  EXPECT_NEAR(run.evaluate("f_g[15]"), -8.0, 1e-12);
  // the second body is part of the upper side, which bears all of the load
  EXPECT_EQ(times_said(pressed(file.name, "pressure yhi 5", true) + "run 1\n", "acts on nothing"),
            0);
}

TEST(MeshContact, LoadOnRanksAndAfterARestart)
{
  const ScratchFile file("pressed.msh", cells(TRIANGLES, 0.1, {16, 10, 0}, 0.1));
  const std::string scene = pressed(file.name, "pressure yhi 5 traction xhi 0 1", true);
  const std::string next =
      "neighbor 0.1 bin\nfix m all" + scene.substr(scene.find(" mpm/material"));
  Twins twins(scene, 40, next, 40, 1e-11);
  OnRanks ranks(scene, "run 80\n", "");
  EXPECT_LT(measured("difference", ranks.difference()), 1e-11);
  for (int k = 0; k < 5; k++)
    EXPECT_NEAR(row(ranks.parallel, 0, k), row(ranks.serial, 0, k), 1e-9) << k;
}

TEST(MeshContact, RanksAndRestart)
{
  // bent, as points on the sides between triangles are in either by rounding
  for (const Kind kind : {TRIANGLES, HEXAHEDRA}) {
    const ScratchFile file("ranks.msh", cells(kind, 0.1, {24, 13, 4}, kind == TRIANGLES ? 0.1 : 0));
    const std::string scene = slide(kind, file.name, "law coulomb 0.3 0.5");
    const std::string fixes = "fix m all" + scene.substr(scene.find(" mpm/material"));
    const std::string next = "neighbor 0.1 bin\n" + replaced(fixes, "velocity b2 set 1 0 0", "");
    Twins twins(scene, 40, next, 40, 1e-11);
    const double work = twins.whole.lmp->modify->get_fix_by_id("touch")->compute_scalar();
    EXPECT_LT(work, -1e-3);
    EXPECT_DOUBLE_EQ(twins.again.lmp->modify->get_fix_by_id("touch")->compute_scalar(), work);
    OnRanks balanced(scene, "run 80\n", "fix b all balance 20 1.0 shift xy 5 1.1\n");
    EXPECT_LT(measured("difference with balance", balanced.difference()), 1e-11);
    for (int k = 0; k < 5; k++)
      EXPECT_NEAR(row(balanced.parallel, 0, k), row(balanced.serial, 0, k), 1e-9) << k;
    EXPECT_LT(row(balanced.serial, 0, 4), -1e-3);
  }
}

// The force in the output is what changes the momentum of a body, in all units
SERIAL_TEST(MeshContact, Units)
{
  const ScratchFile file("units.msh", cells(QUADS, 0.1, {24, 13, 0}));
  for (const std::string units : {"lj", "real", "metal"}) {
    Scene run(slide(QUADS, file.name, "law coulomb 0.3", units) + "unfix d\nunfix down\n");
    const auto *update = run.lmp->update;
    const double to_velocity = run.lmp->force->ftm2v;
    run.lmp->update->dt = 1e-9;
    run.commands("velocity b2 set 0 0 0\nfix d all mpm/dt 0.4\nrun 1 post no\n");
    const double v0 = 0.002 * 0.1 / update->dt;
    run.commands(strprintf("unfix d\nvelocity all set 0 0 0\nvelocity b2 set %g %g 0\n", v0, -v0));
    double impulse[2] = {0.0, 0.0}, before[2], after[2];
    const auto momentum = [&](double *p) {
      for (int d = 0; d < 2; d++)
        p[d] = run.evaluate("mass(b2)") * run.evaluate(d ? "vcm(b2,y)" : "vcm(b2,x)");
    };
    momentum(before);
    for (int k = 0; k < 30; k++) {
      run.commands("run 1 post no\n");
      for (int d = 0; d < 2; d++) impulse[d] += row(run, 0, d) * update->dt * to_velocity;
    }
    momentum(after);
    EXPECT_GT(measured("part of the momentum", (after[1] - before[1]) / -before[1]), 0.1);
    for (int d = 0; d < 2; d++)
      EXPECT_NEAR(impulse[d], after[d] - before[d], 1e-10 * std::fabs(before[1]));
    EXPECT_NEAR((after[0] - before[0]) / (after[1] - before[1]), -0.3, 4e-6);
  }
}

SERIAL_TEST(MeshContact, BadInput)
{
  const ScratchFile file("bad.msh", cells(TRIANGLES, 0.1, {24, 13, 0}));
  std::string good = slide(TRIANGLES, file.name, "law coulomb 0.3");
  good.erase(good.find("fix touch"));
  good += "fix d all mpm/dt 0.4\n";
  const std::string fix = "fix touch all mpm/mesh/contact ";
  expect_refused(
      good,
      {{fix, "needs the ID of a fix mpm/mesh"},
       {fix + "g b1", "needs two or more groups"},
       {fix + "g b1 none", "there is no group none"},
       {fix + "g b1 b2 b1", "group b1 is named twice"},
       {fix + "none b1 b2\nrun 1", "none is not the ID of a fix mpm/mesh"},
       {fix + "m b1 b2\nrun 1", "m is not the ID of a fix mpm/mesh"},
       {fix + "g b1 b2 law glue", "law"},
       {fix + "g b1 b2 law coulomb -1", "law coulomb"},
       {fix + "g b1 b2 law coulomb 0.3 0.2", "must not be below that of friction"},
       {"fix touch b1 mpm/mesh/contact g b1 b2", "use group all"},
       {"group some id 1 2 3\n" + fix + "g some b2\nrun 1", "is in none of the groups"},
       {fix + "g all b2\nrun 1", "is in several of the groups"},
       {fix + "g b1 b2\nfix more all mpm/mesh/contact g b1 b2\nrun 1",
        "are of the same fix mpm/mesh"},
       {"unfix g\nfix g all mpm/mesh " + file.name + " frame total\n" + fix + "g b1 b2\nrun 1",
        "use frame updated"},
       {"unfix g\nfix g all mpm/mesh " + file.name + " transfer apic\n" + fix + "g b1 b2\nrun 1",
        "use transfer flip"}});
  EXPECT_EQ(times_said(good + "displace_atoms b2 move 0 -0.1 0\n" + fix + "g b1 b2\nrun 1\n",
                       "bodies overlap at the start of the run"),
            1);
  EXPECT_EQ(times_said(good + fix + "g b1 b2\nrun 1\n", "bodies overlap"), 0);
}

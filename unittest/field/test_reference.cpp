// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 2 4
// timeout: 900

// fix mpm frame total with reference update: what is exact remains so, nothing jumps, and the frame
// without updates comes out where there are none.

#include "mpm_lammps.h"

#include "error.h"

using namespace MPM_TEST;

static std::string body(int dim, const std::string &options, const std::string &law)
{
  return box(dim, "lj", "f f f", "-10 30 -10 20 -10 20", 1, 0.2) +
      MPM_TEST::body(strprintf("block 2 6 2 5 %s", dim == 2 ? "INF INF" : "2 4"),
                     strprintf("density 1.0 %s", law.c_str()),
                     strprintf("0.5 frame total %s", options.c_str()));
}

// a body without stiffness in simple shear to 3, spinning, and stretched: F = (I + dt L)^n to
// round-off whenever the reference is made anew, and stress is that of F
SERIAL_TEST(ReferenceUpdate, AffineMotionIsExact)
{
  for (const int dim : {2, 3})
    for (const char *rest :
         {"transfer apic", "transfer apic scheme musl", "shape cubic transfer apic",
          "shape linear transfer apic scheme usf", "transfer apic locking both"}) {
      Scene run(body(dim, std::string(rest) + " reference update 1.5", "neohookean 1.0e-9 0.3") +
                "timestep 0.02\n");
      run.set_reference();
      run.set_velocity([](const double *x, double *v) {
        v[0] = 1.0 * x[1] + 0.1 * x[0];
        v[1] = -0.1 * x[0];
      });
      run.commands("run 150\n");
      double worst = 0.0, shear = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double *F = run.points().F[i], *x = run.x()[i], *X = run.reference(i);
        const double y[2] = {1.0 + 3.0 * 0.1, 1.0};    // points keep their velocities
        worst = std::max({worst, std::abs(F[0] - y[0]), std::abs(F[1] - 3.0), std::abs(F[3] + 0.3),
                          std::abs(F[4] - y[1]), std::abs(x[0] - (1.3 * X[0] + 3.0 * X[1]))});
        shear = std::max(shear, F[1]);
      }
      EXPECT_LT(worst, 1e-7) << rest;
      EXPECT_GT(shear, 2.9);
      double R = 0.0;
      for (int i = 0; i < run.n(); i++) R = std::max(R, run.reference_F()[i][1]);
      EXPECT_GT(R, 1.0) << rest;    // there were updates
    }
}

// The same for points that are deformed already when they get their reference configuration, in a
// way that does not commute with what follows: F = (I + t A) F0
SERIAL_TEST(ReferenceUpdate, DeformedAtTheStart)
{
  const double F0[4] = {1.3, 0.5, 0.0, 0.8}, A[4] = {0.1, 1.0, -0.1, 0.0};
  for (const int dim : {2, 3}) {
    Scene run(body(dim, "transfer apic reference update 1.5", "neohookean 1.0e-9 0.3") +
              "timestep 0.02\n");
    run.set_reference();
    for (int i = 0; i < run.n(); i++)
      for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) run.points().F[i][3 * a + b] = F0[2 * a + b];
    run.set_velocity([&](const double *x, double *v) {
      for (int a = 0; a < 2; a++) v[a] = A[2 * a] * x[0] + A[2 * a + 1] * x[1];
    });
    run.commands("run 150\n");
    double worst = 0.0;
    int updates = 0;
    for (int i = 0; i < run.n(); i++) {
      const double *F = run.points().F[i], *x = run.x()[i], *X = run.reference(i);
      for (int a = 0; a < 2; a++) {
        double expected = X[a];
        for (int b = 0; b < 2; b++) {
          expected += 3.0 * A[2 * a + b] * X[b];
          double G = F0[2 * a + b];
          for (int k = 0; k < 2; k++) G += 3.0 * A[2 * a + k] * F0[2 * k + b];
          worst = std::max(worst, std::abs(F[3 * a + b] - G));
        }
        worst = std::max(worst, std::abs(x[a] - expected));
      }
      updates += std::abs(run.reference_F()[i][1] - F0[1]) > 0.5;
    }
    EXPECT_LT(worst, 1e-7);
    EXPECT_EQ(updates, run.n());
  }
}

// a threshold that is never met changes nothing but round-off
SERIAL_TEST(ReferenceUpdate, NoneIsTheTotalFrame)
{
  for (const char *rest :
       {"transfer apic", "transfer flip 1.0 scheme musl", "transfer apic locking fbar"}) {
    const auto state = [&](const std::string &more) {
      Scene run(body(3, rest + more, "neohookean 10.0 0.3") +
                "velocity all ramp vx 0.0 1.0 y 2 5\ntimestep 0.02\nrun 100\n");
      return run.gather();
    };
    EXPECT_LT(difference(state(""), state(" reference update 1000")), 1e-12) << rest;
  }
}

// The lattice sees a body of the volume V0 det R: inside, its share of the volume of a node is one,
// however much the body has expanded since the start.
SERIAL_TEST(ReferenceUpdate, VolumeOnTheLattice)
{
  Scene run(body(2, "reference update 1.2", "neohookean 1.0e-9 0.3") + "timestep 0.02\n");
  run.set_velocity([](const double *x, double *v) {
    v[0] = 0.5 * (x[0] - 4.0);
  });
  run.commands("run 50\n");
  const std::vector<double> share = run.volume_shares();
  double least = 10.0, most = 0.0, volume = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference_positions()[i];
    volume = std::max(volume, MPMPoints::det(run.reference_F()[i]));
    if (std::abs(X[0] - 4.0) > 1.0 || std::abs(X[1] - 3.5) > 0.2) continue;
    least = std::min(least, share[i]);
    most = std::max(most, share[i]);
  }
  EXPECT_GT(volume, 1.3);
  EXPECT_NEAR(least, 1.0, 0.03);
  EXPECT_NEAR(most, 1.0, 0.03);
}

// a block that is thrown with a shear and vibrates: momentum is exact, energy does not jump, and
// the motion is that of a frame without updates up to the error of both
SERIAL_TEST(ReferenceUpdate, MomentumAndEnergy)
{
  double angle[2], energy[2];
  for (const bool updates : {false, true}) {
    Scene run(body(2, std::string("transfer apic") + (updates ? " reference update 1.15" : ""),
                   "neohookean 10.0 0.3") +
              "velocity all set 0.5 0.2 0.0\nvelocity all ramp vx 0.0 2.0 y 2 5 sum yes\n"
              "compute e all mpm/energy\nthermo_style custom step c_e\ntimestep 0.01\nrun 0\n");
    const auto before = run.sums();
    const double start = run.compute_scalar();
    double last = start, jump = 0.0;
    for (int k = 0; k < 60; k++) {
      run.commands("run 10 post no\n");
      const double now = run.compute_scalar();
      jump = std::max(jump, std::abs(now - last));
      last = now;
    }
    const auto after = run.sums();
    for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d], before.p[d], 1e-11 * before.mass);
    EXPECT_LT(jump, 0.03 * start);
    angle[updates] = measured("angular momentum", after.L[2]);
    energy[updates] = measured("energy, share that is left", last / start);
  }
  EXPECT_NEAR(angle[1], angle[0], 0.002 * std::abs(angle[0]));
  EXPECT_NEAR(energy[1], energy[0], 0.002);
}

// Linear functions: after an update points are anywhere in their cells, as in the updated frame.
// Where all nodes are full, keyword light changes nothing: a periodic box that is sheared
SERIAL_TEST(ReferenceUpdate, NoLightNodesNoChange)
{
  for (const char *rest : {"transfer apic", "transfer apic scheme musl", "transfer apic scheme usf",
                           "transfer flip 1.0", "transfer flip 1.0 locking fbar"}) {
    const auto state = [&](const std::string &more) {
      Scene run(plane("lj", "p p", "0 8 0 8", 1, 0.4) +
                MPM_TEST::body("box", "density 1.0 neohookean 10.0 0.3",
                               "1.0 frame total reference update 1.2 shape linear " +
                                   std::string(rest) + more) +
                "variable vx atom 1.5*sin(2*PI*y/8)\nvariable vy atom 0.7*sin(2*PI*x/8)\n"
                "velocity all set v_vx v_vy 0\n"
                "timestep 0.05\nrun 60\n");
      double R = 0.0;
      for (int i = 0; i < run.n(); i++) R = std::max(R, std::abs(run.reference_F()[i][1]));
      EXPECT_GT(R, 0.1);    // there were updates
      return run.gather();
    };
    EXPECT_LT(difference(state(" light 0.2"), state("")), 1.0e-11) << rest;
  }
}

// A block hits a wall: it stays whole with light nodes, or where linear functions are sound without
SERIAL_TEST(ReferenceUpdate, ImpactWithLinearFunctions)
{
  const struct {
    const char *options;
    bool sound;
  } cases[] = {{"transfer apic light 0.5", true},
               {"transfer flip 1.0 light 0.5", true},
               {"transfer apic scheme musl light 0.5", true},
               {"transfer flip 1.0 scheme musl", true},
               {"transfer apic", false},
               {"transfer flip 1.0", false},
               {"transfer apic scheme musl", false}};
  for (const auto &[options, sound] : cases) {
    SCOPED_TRACE(options);
    Scene run(plane("lj", "f f", "-8 24 0 16", 1, 0.4) +
              MPM_TEST::body(
                  "block 4.3 9.3 0 8 INF INF", "density 1.0 eos linear 20.0 strength j2 10.0 1.0",
                  "1.0 frame total reference update 1.2 shape linear " + std::string(options)) +
              "fix floor all mpm/boundary ylo slip\nvelocity all set 0 -1.5 0\n"
              "compute e all mpm/energy\nthermo_style custom step c_e\nfix dt all mpm/dt 0.5\n");
    const int before = run.lmp->error->get_numwarn();
    run.commands("run 0\n");
    const double start = run.compute_scalar();
    const std::string error = run.error("run 300\n");
    EXPECT_EQ(run.lmp->error->get_numwarn() > before, !sound);
    EXPECT_EQ(error.empty(), sound) << error;
    if (error.empty()) { EXPECT_LT(run.compute_scalar(), 1.01 * start); }
  }
}

// any number of ranks, and after a restart
static const char *const thrown = "velocity all ramp vx 0.0 2.0 y 2 5\ntimestep 0.01\n";

TEST(ReferenceUpdate, Ranks)
{
  for (const char *rest : {"transfer apic", "transfer flip 0.99 scheme musl locking fbar",
                           "shape linear transfer apic light 0.5"}) {
    OnRanks run(body(3, std::string(rest) + " reference update 1.2", "neohookean 10.0 0.3") +
                    thrown,
                "run 150\n", "");
    EXPECT_LT(run.difference(), 1e-12) << rest;
    double R = 0.0;
    for (int i = 0; i < run.serial.n(); i++)
      R = std::max(R, std::abs(run.serial.reference_F()[i][1]));
    EXPECT_GT(R, 0.1);
  }
}

// steps at which the distortion is looked at do not depend on where a run starts
TEST(ReferenceUpdate, Restart)
{
  const auto scene = body(3, "transfer apic reference update 1.2", "neohookean 10.0 0.3") + thrown;
  const ScratchFile file("85.bin");
  Scene whole(scene + "restart 85 " + replaced(file.name, "85", "*") + "\nrun 145\n"),
      again("read_restart " + file.name + "\n" + lines_again(scene) + "run 60\n");
  EXPECT_TRUE(identical(whole.gather(), again.gather()));
}

TEST(ReferenceUpdate, Refused)
{
  const std::string head = space("lj", "f f f", "0 8 0 8 0 8");
  expect_error(head + "fix grid all mpm 1.0 reference update 2.0\n", "is for frame total");
  expect_error(head + "fix grid all mpm 1.0 frame total reference update 1.0\n", "above 1");
  expect_error(head +
                   "fix grid all mpm 1.0 frame total reference update 2.0\n"
                   "create_points 1 box ppc 2\nfix m all mpm/material density 1 linear 1 0.3\n"
                   "fix w all mpm/boundary xlo stick velocity 1 0 0\nrun 0\n",
               "would leave it");
}

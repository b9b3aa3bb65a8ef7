// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 600

// Fix mpm/mesh: points on a mesh of any cells. Benchmark S2, Lame's solution of a thick tube.

#include "meshgrid/fix_mpm_mesh.h"
#include "meshgrid/mesh_grid_testing.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Quarter of a tube from radius 1 to 2: faces xlo and xhi are the bore and the outside. */
std::string tube(Kind kind, int n)
{
  return gmsh(kind, {n, 3 * n / 2, 0}, [](double s, double t, double) {
    const double r = pow(2.0, s), phi = 0.5 * PI * t;
    return std::array<double, 3>{t < 1.0 ? r * cos(phi) : 0.0, r * sin(phi), 0.0};
  });
}

/** A bar of 4 x 1 x 1. */
std::string bar(Kind kind, int n)
{
  return gmsh(kind, {4 * n, n, n}, [](double x, double y, double z) {
    return std::array<double, 3>{4.0 * x, y, z};
  });
}

/** A grid around these bodies. */
std::string surroundings(Kind kind, int n)
{
  return gmsh(kind, {7 * n, 7 * n, 7 * n}, [](double x, double y, double z) {
    return std::array<double, 3>{7.0 * x - 1.0, 7.0 * y - 1.0, 7.0 * z - 1.0};
  });
}

std::string scene(int dim, const std::string &file, const std::string &material,
                  const std::string &options, int halve = 1, const std::string &grid = "")
{
  return box(dim, "lj", "f f f", "-1 6 -1 6 -1 6", 1, 0.1) + "create_points 1 elements " + file +
      " halve " + std::to_string(halve) + "\nfix m all mpm/material density 1 " + material +
      "\nfix g all mpm/mesh " + (grid.empty() ? file : grid) + " " + options + "\n";
}

double entry(Scene &run, int k)
{
  return run.lmp->modify->get_fix_by_id("g")->compute_vector(k - 1);
}

// a stage reads the state of points, or what an earlier stage has written
SERIAL_TEST(MeshGrid, StagesReadWhatOthersWrote)
{
  const ScratchFile file("tube.msh", tube(QUADS, 2));
  for (const bool total : {false, true}) {
    Scene run(scene(2, file.name, "linear 1 0.3", total ? "frame total" : "frame updated") +
              "run 0\n");
    const auto *const fix = dynamic_cast<FixMPMMesh *>(run.lmp->modify->get_fix_by_id("g"));
    std::set<std::string> known = {"x", "v", "C", "F", "tau", "history", "mass", "f", "own"};
    if (total) known.insert("cells");    // those of the start
    for (const auto &stage : fix->plan().list()) {
      for (const auto &read : stage.reads.list())
        EXPECT_TRUE(known.count(read)) << stage.name << " " << read;
      EXPECT_FALSE(stage.writes.list().empty()) << stage.name;
      known.insert(stage.writes.list().begin(), stage.writes.list().end());
    }
    EXPECT_EQ(fix->plan().list().back().name, "motion and strain");
  }
}

// Lame's solution of a tube under pressure: order 2, both frames
SERIAL_TEST(MeshGrid, TubeUnderPressure)
{
  const double p = 1e-5, E = 1.0, nu = 0.3;
  for (const Kind kind : {TRIANGLES, QUADS})
    for (const std::string &frame : first_of<std::string>(1, {"updated", "total"})) {
      double error[2];
      for (const int n : {6, 12}) {
        const ScratchFile file("tube.msh", tube(kind, n));
        Scene run(scene(2, file.name, "linear 1 0.3",
                        "frame " + frame + " slip ylo slip yhi pressure xlo 1e-5"));
        const auto start = run.gather();
        run.commands("fix v all viscous " + strprintf("%.17g", 3.3 / start.size()) +
                     "\nfix d all mpm/dt 0.5 until 60\nrun 100000\n");
        const auto end = run.gather();
        double square = 0.0, all = 0.0;
        for (std::size_t k = 0; k < start.size(); k++) {
          const double *const X = start[k].x, r = hypot(X[0], X[1]);
          const double u = (1 + nu) / E * p / 3.0 * ((1 - 2 * nu) * r + 4.0 / r);
          for (int d = 0; d < 2; d++) {
            square += pow(end[k].x[d] - X[d] - u * X[d] / r, 2);
            all += pow(u * X[d] / r, 2);
          }
        }
        error[n == 12] =
            measured(strprintf("error with %d cells, %s", n, frame.c_str()), sqrt(square / all));
        // pressure on the bore holds the quarter, in the total frame that of the body by now
        const double u = (1 + nu) / E * p / 3.0 * ((1 - 2 * nu) + 4.0);
        const double bore = frame == "total" ? 1.0 + u : 1.0;
        for (const int k : {6, 8}) EXPECT_NEAR(entry(run, k), -p * bore, 1e-6 * p);
      }
      EXPECT_LT(error[1], 0.005);
      EXPECT_GT(log2(error[0] / error[1]), 1.7);
    }
}

// S2: pressure that follows at finite strain
SERIAL_TEST(MeshGrid, TubeAtFiniteStrain)
{
  const double exact[2][3] = {{0.2, 1.183161, 2.120533}, {0.4, 1.502870, 2.347360}};
  for (const auto &[p, a, b] : exact)
    for (const Kind kind : {TRIANGLES, QUADS}) {
      const ScratchFile file("tube.msh", tube(kind, 10));
      Scene run(scene(2, file.name, "neohookean 2.6 0.3",
                      "frame total slip ylo slip yhi pressure xlo v_p", 0)
                    .insert(0, strprintf("variable p equal %g*(1-exp(-time/4))\n", p)));
      const auto start = run.gather();
      run.commands("fix v all viscous 0.02\nfix d all mpm/dt 0.5 until 60\nrun 100000\n");
      const auto end = run.gather();

      // points are off the surfaces: a and b from the area of their circles, linear next to these

      double low[4] = {0.0}, high[4] = {0.0};    // of the fits of r^2 by R^2: sums of x, y, xx, xy
      int n[2] = {0, 0};
      for (std::size_t k = 0; k < start.size(); k++) {
        const double R = pow(start[k].x[0], 2) + pow(start[k].x[1], 2),
                     r = pow(end[k].x[0], 2) + pow(end[k].x[1], 2);
        double *const s = R < 1.3 ? low : R > 3.2 ? high : nullptr;
        if (!s) continue;
        n[s == high]++;
        s[0] += R;
        s[1] += r;
        s[2] += R * R;
        s[3] += R * r;
      }
      const auto at = [](const double *s, int m, double R) {
        const double slope = (m * s[3] - s[0] * s[1]) / (m * s[2] - s[0] * s[0]);
        return sqrt(s[1] / m + slope * (R - s[0] / m));
      };
      EXPECT_NEAR(measured("a", at(low, n[0], 1.0)) / a, 1.0, 0.004);
      EXPECT_NEAR(measured("b", at(high, n[1], 4.0)) / b, 1.0, 0.004);
    }
}

// A bar pulled by its ends has one stress. Linear functions have its strain exactly on any mesh;
// the forces of points in bent quadrangles and hexahedra are those of a midpoint rule
SERIAL_TEST(MeshGrid, PatchOfAnyCells)
{
  for (const Kind kind : first_of(3, {TRIANGLES, QUADS, TETRAHEDRA, HEXAHEDRA})) {
    const int dim = kind < TETRAHEDRA ? 2 : 3;
    const auto distorted = gmsh(kind, {6, 3, 3}, [&](double x, double y, double z) {
      const double bump = 0.1 * sin(PI * x) * sin(PI * y) * (dim == 3 ? sin(PI * z) : 1.0);
      return std::array<double, 3>{2.0 * x + bump, y + 0.3 * bump, dim == 3 ? z - 0.2 * bump : 0.0};
    });
    const ScratchFile file("patch.msh", distorted);
    const bool exact = kind == TRIANGLES || kind == TETRAHEDRA;
    double worst[3] = {0.0, 0.0, 0.0};
    for (const int k : {1, 2}) {
      // uniform volume ratios are their own means
      const int halve = exact ? 1 : k;
      const std::string locking = exact && k == 2 ? " locking fbar" : "";
      Scene run(scene(dim, file.name, "neohookean 1 0.3",
                      "frame total slip xlo slip ylo traction xhi 0.05 0" +
                          std::string(dim == 3 ? " 0 slip zlo" : "") + locking,
                      halve));
      const double damping = 2.0 / run.gather().size();
      run.commands(strprintf(
          "fix v all viscous %.17g\nfix d all mpm/dt 0.5 until 100\nrun 100000\n", damping));
      const auto all = run.gather();
      for (const auto &s : all) {
        auto &most = worst[k];
        const double J = MPMPoints::det(s.F);
        grow(most, J * s.stress[0] / s.F[0] / 0.05 - 1.0);
        for (int c = 1; c < (dim == 3 ? 6 : 2); c++)
          most = std::max(most, std::fabs(s.stress[c]) / 0.05);
        for (int c = 0; c < 9; c++) most = std::max(most, std::fabs(s.F[c] - all[0].F[c]) / 0.05);
      }
      measured("stress that is not that of the ends", worst[k]);
      EXPECT_NEAR(entry(run, 11), 0.05, 1e-14);    // of the end
    }
    if (exact) {
      EXPECT_LT(std::max(worst[1], worst[2]), 1e-8) << kind;
    } else {
      EXPECT_LT(worst[1], 0.011) << kind;
      EXPECT_GT(worst[1] / worst[2], 3.0) << kind;
    }
  }
}

// A bar that swings keeps its energy, and what a force does to it is in the work
SERIAL_TEST(MeshGrid, EnergyAndMomentum)
{
  for (const std::string frame : {"total", "updated"})
    for (const std::string transfer : {"flip 1", "apic", "flip 1 locking fbar"}) {
      const ScratchFile file("bar.msh", bar(TRIANGLES, 3)),
          grid("grid.msh", surroundings(TRIANGLES, 3));
      Scene run(
          scene(2, file.name, "neohookean 1 0.3", "frame " + frame + " transfer " + transfer, 1,
                frame == "total" ? "" : grid.name) +
          "velocity all set 0.1 0.1 0\nfix f all addforce 0 1e-4 0\nvariable v atom 0.05*(x-2)^2\n"
          "velocity all set NULL v_v NULL sum yes\nfix d all mpm/dt 0.2 until 10\n");
      const auto p0 = run.sums();
      run.commands("run 0\n");
      const double before = entry(run, 1);
      run.commands("run 10000\n");
      const double now = entry(run, 1) + entry(run, 2), work = entry(run, 3);
      measured("energy that is lost", (before + work - now) / before);
      EXPECT_NEAR(before + work - now, 0.0, 0.01 * before);
      const auto p1 = run.sums();
      EXPECT_NEAR(p1.p[0], p0.p[0], 1e-12);
      EXPECT_NEAR(p1.p[1], p0.p[1] + 10.0 * 1e-4 * run.gather().size(), 1e-11);
    }
}

// Points that have failed keep no stress in the next run: a broken piece flies on

SERIAL_TEST(MeshGrid, BrokenPiecesFlyOn)
{
  const ScratchFile file("bar.msh", bar(TRIANGLES, 3));
  Scene run(scene(2, file.name,
                  "eos linear 1 strength elastic 0.5 damage rankine 0.01 thermal adiabatic 1 0",
                  "frame total transfer flip 1") +
            "velocity all set 0.1 0.2 0\nvelocity all ramp vx -0.1 0.1 x 0 4 sum yes\n"
            "timestep 0.05\nrun 100\n");
  const auto before = run.gather();
  run.commands("run 20\n");
  const auto after = run.gather();
  double stress = 0.0, change = 0.0;
  for (std::size_t p = 0; p < before.size(); p++)
    for (int d = 0; d < 2; d++) {
      stress = std::max(stress, std::fabs(before[p].stress[d]));
      change = std::max(change, std::fabs(after[p].v[d] - before[p].v[d]));
    }
  EXPECT_LT(stress, 1e-12);    // all of them have failed
  EXPECT_LT(measured("change of velocity", change), 1e-13);
}

// A fluid that spins between curved walls keeps to its circles: the only force is m v^2/r
SERIAL_TEST(MeshGrid, SlipAlongACurve)
{
  const auto ring = gmsh(QUADS, {6, 48, 0}, [](double s, double t, double) {
    const double phi = 0.5 * PI * t, r = 1.0 + 0.5 * s;
    return std::array<double, 3>{t < 1.0 ? r * cos(phi) : 0.0, r * sin(phi), 0.0};
  });
  const ScratchFile file("ring.msh", ring);
  Scene run(scene(2, file.name, "linear 1 0.3", "frame total transfer flip 1 slip xlo slip xhi") +
            "variable vx atom -0.01*y\nvariable vy atom 0.01*x\nvelocity all set v_vx v_vy NULL\n"
            "timestep 0.005\n");
  const double spin = run.sums().L[2];
  run.commands("run 400\n");    // 0.02 of the radius
  // walls push along their normals only, which are right to the second order of the angle of a side
  EXPECT_NEAR(measured("spin that is left", run.sums().L[2] / spin), 1.0, 2e-3);
}

// Sides of one group that meet at a right angle hold their corner along both normals
SERIAL_TEST(MeshGrid, SlipInACorner)
{
  auto text = bar(QUADS, 2);
  for (std::size_t at = 0; (at = text.find(" 1 2 4 1 ", at)) != std::string::npos; at++)
    text.replace(at, 9, " 1 2 2 1 ");    // ylo is a part of xlo
  const ScratchFile file("corner.msh", text);
  Scene run(scene(2, file.name, "neohookean 1 0.3", "frame total transfer flip 1 slip xlo") +
            "velocity all set -0.2 -0.1 0\ntimestep 0.01\nrun 1\n");
  for (const auto &s : run.gather())
    if (s.x[0] < 0.15 && s.x[1] < 0.15) {
      // a fourth of the way into the cell, whose corner has no velocity, two nodes one along a wall
      EXPECT_NEAR(s.v[0], -0.2 * 0.25, 1e-12);
      EXPECT_NEAR(s.v[1], -0.1 * 0.25, 1e-12);
    }
}

// Creeping flow: a cylinder of radius 1 that moves in the middle of one of radius 4 feels a drag of
// 4 pi mu U/(ln 4 - 15/17) per length. One point per quadrangle, as these lock with more
SERIAL_TEST(MeshGrid, CreepingFlowAroundACylinder)
{
  const double exact = 4.0 * PI / (log(4.0) - 15.0 / 17.0), U = 1e-3;
  double error[2];
  for (const int n : {6, 12}) {
    const auto half =
        gmsh(QUADS, {n, (int) lround(n * PI / log(4.0)), 0}, [](double s, double t, double) {
          const double r = pow(4.0, s), y = t < 1.0 ? r * sin(PI * t) : 0.0;
          return std::array<double, 3>{r * cos(PI * t), y, 0.0};
        });
    const ScratchFile file("flow.msh", half);
    Scene run(box(2, "lj", "f f p", "-4.2 4.2 -0.2 4.2 -0.5 0.5", 1, 0.3) +
              "create_points 1 elements " + file.name +
              " halve 0\nfix m all mpm/material density 1 eos linear 25 viscosity newtonian 1\n"
              "fix g all mpm/mesh " +
              file.name +
              " transfer flip 1 slip ylo slip yhi velocity xlo 1e-3 0 velocity xhi 0 0\n"
              "fix d all mpm/dt 0.4 until 5\nrun 100000\n");
    error[n == 12] = measured("error of the drag", 2.0 * entry(run, 11) / U / exact - 1.0);
  }
  EXPECT_LT(std::fabs(error[1]), 0.05);
  EXPECT_GT(error[0] / error[1], 2.5);
}

TEST(MeshGrid, RanksAndRestart)
{
  for (const bool total : {true, false})
    for (const Kind kind : {TRIANGLES, HEXAHEDRA, QUADS}) {
      const int dim = kind == HEXAHEDRA ? 3 : 2;
      const std::string mesh = dim == 2 ? tube(kind, 8) : bar(kind, 3);
      const ScratchFile file("ranks.msh", mesh), grid("grid.msh", surroundings(kind, 2));
      const std::string name = total ? file.name : grid.name;
      const std::string options = total
          ? "frame total slip ylo pressure xlo v_p"
          : "transfer apic slip ylo traction xlo v_p 0" + std::string(dim == 3 ? " 0" : "");
      const std::string locking = kind == QUADS ? " locking fbar" : "";
      const std::string variable = "variable p equal 0.02*sin(time)\n";
      const std::string others = "fix v all viscous 1e-4\ntimestep 0.01\n";
      const std::string fixes =
          "fix m all mpm/material density 1 neohookean 1 0.3\nfix g all mpm/mesh " + name + " " +
          options + locking + "\n" + others;
      const std::string first = variable +
          replaced(scene(dim, file.name, "neohookean 1 0.3", options + locking, 1, name),
                   "-1 6 -1 6", "-0.5 4.5 -0.9 2.9") +
          "velocity all set 0.05 0.1 0\nvelocity all ramp vx 0.05 -0.05 x 0 4 sum yes\n" + others;
      Twins(first, 60, "neighbor 0.1 bin\n" + variable + fixes, 60, 1e-11);
      OnRanks balanced(first, "run 120\n", "fix b all balance 20 1.0 shift xy 5 1.1\n");
      EXPECT_LT(measured("difference with balance", balanced.difference()), 1e-11);
      for (int k = 1; k < 11; k++) {
        const double one = entry(balanced.serial, k);
        EXPECT_NEAR(entry(balanced.parallel, k), one, 1e-11 + 1e-9 * std::fabs(one)) << k;
      }
    }
}

// A pressure or means against locking after a restart know where nodes are; another frame fails
SERIAL_TEST(MeshGrid, MoreOptionsAfterARestart)
{
  const ScratchFile file("tube.msh", tube(QUADS, 4)), restart("restart");
  const std::string material = "neohookean 1 0.3",
                    load = "frame total slip ylo slip yhi traction xhi 0.1 0.03 ",
                    others = "fix v all viscous 0.01\ntimestep 0.03\n",
                    variable = "variable p equal 0.2*(step>100)\n",
                    fixes = "fix m all mpm/material density 1 " + material +
      "\nfix g all mpm/mesh " + file.name + " ";
  Scene whole(variable + scene(2, file.name, material, load + "pressure xlo v_p") + others +
              "run 100\nrun 60\n");
  Scene first(scene(2, file.name, material, load) + others + "run 100\nwrite_restart " +
              restart.name + "\n");
  Scene again("read_restart " + restart.name + "\nneighbor 0.1 bin\n" + variable + fixes + load +
              "pressure xlo v_p\n" + others + "run 60\n");
  EXPECT_LT(measured("difference", difference(whole.gather(), again.gather())), 1e-12);
  Scene fbar("read_restart " + restart.name + "\nneighbor 0.1 bin\n" + fixes + load +
             "locking fbar\n" + others + "run 1\n");
  EXPECT_LT(measured("one step with means", difference(first.gather(), fbar.gather())), 0.05);
  expect_error("read_restart " + restart.name + "\n" + fixes + "slip ylo\n",
               "has another frame or mesh than in the restart file");
}

// Output sees history variables and energies of points on a mesh
SERIAL_TEST(MeshGrid, Output)
{
  const ScratchFile file("bar.msh", bar(QUADS, 2));
  Scene run(scene(2, file.name, "eos linear 1 strength j2 0.4 0.01",
                  "frame total velocity xlo 0 0 velocity xhi 0.01 0"));
  run.commands("compute p all mpm/atom eplastic energy\ncompute sum all reduce sum c_p[1] c_p[2]\n"
               "thermo_style custom step c_sum[1] c_sum[2]\ntimestep 0.01\nrun 1000\n");
  auto *sum = run.lmp->modify->get_compute_by_id("sum");
  sum->compute_vector();
  EXPECT_GT(sum->vector[0], 0.01 * run.gather().size());    // of 2.5 %
  EXPECT_NEAR(sum->vector[1], entry(run, 2), 1e-12);
}

SERIAL_TEST(MeshGrid, BadInput)
{
  const ScratchFile file("bad.msh", tube(TRIANGLES, 4));
  const std::string good = box(2, "lj", "f f f", "-1 6 -1 6 -1 6", 1, 0.1) +
      "create_points 1 elements " + file.name +
      "\nfix m all mpm/material density 1 neohookean 1 0.3\ntimestep 0.01\n";
  const std::string fix = "fix g all mpm/mesh " + file.name + " ";
  expect_refused(
      good,
      {{"fix g all mpm/mesh", "Illegal fix mpm/mesh command: missing argument"},
       {"fix g all mpm/mesh none.msh", "none.msh"},
       {fix + "part core", "no elements in a physical group or set 'core'"},
       {fix + "slip body", "is not the side of a cell"},
       {fix + "slip top", "no elements in a physical group or set 'top'"},
       {fix + "velocity xlo 1", "velocity"},
       {fix + "velocity xlo 1 NULL velocity xlo 2 0", "twice for group xlo: give it once"},
       {fix + "slip xlo pressure ylo 1 slip xlo", "twice for group xlo: give it once"},
       {fix + "pressure xlo 1 pressure xlo 2", "twice for group xlo: give the sum once"},
       {fix + "traction xlo 1 0 traction xlo 0 1", "twice for group xlo: give the sum once"},
       {fix + "pressure xlo v_none\nrun 1", "Variable none for fix mpm/mesh g does not exist"},
       {fix + "pressure xlo NULL", "NULL"},
       {fix + "frame lagrangian", "frame"},
       {fix + "transfer flip 2", "transfer flip"},
       {fix + "scheme usf", "scheme"},
       {fix + "frame total\nunfix m\nrun 1", "has no material"},
       {fix + "\nfix n all nve\nrun 1", "are also integrated by fix n"},
       {fix + "\nfix grid all mpm 0.5\nrun 1", "cannot be in one run"},
       {fix + "\nfix d all deform 1 x erate 0.1\nrun 1", "requires a box of constant size"},
       {fix + "\nfix h all mpm/heat\nrun 1", "acts on points of a fix mpm only"},
       {fix + "\ncompute e all mpm/energy\nrun 1", "has its energies in its own vector"},
       {fix + "\ndisplace_atoms all move 3 0 0\nrun 1", "is outside of the mesh"},
       {fix + "\ntimestep 10\nrun 1", "is above the limit"},
       {fix + "\nrun 4 every 2 \"run 0\"", "mpm/mesh has not been set up"},
       {fix + "\ngroup none empty\nunfix g\nfix g none mpm/mesh " + file.name + "\nrun 1",
        "no material points"},
       {fix + "\nmin_style cg\nminimize 0 0 1 1", "cannot be used with minimize"}});
  expect_error(replaced(good, "boundary f f p", "boundary p f p") + fix + "\nrun 1\n",
               "has no periodic images of its mesh: use boundary f, s, or m along x");
  EXPECT_EQ(times_said(good + fix + "transfer apic\nrun 1\n", "gain energy"), 1);
  EXPECT_EQ(times_said(good + fix + "transfer apic frame total\nrun 1\n", "gain energy"), 0);
}

// Linear cells that lock as the material keeps its volume are told of, but no others, nor fluids
SERIAL_TEST(MeshGrid, Locking)
{
  const ScratchFile triangles("triangles.msh", tube(TRIANGLES, 4)),
      quads("quads.msh", tube(QUADS, 4));
  const auto warnings = [](const ScratchFile &file, const std::string &material, int halve,
                           const std::string &options = "frame total") {
    return times_said(scene(2, file.name, material, options, halve) + "timestep 1e-4\nrun 1\n",
                      "linear cells lock");
  };
  EXPECT_EQ(warnings(triangles, "neohookean 1 0.49", 0), 1);
  EXPECT_EQ(warnings(quads, "linear 1 0.49", 1), 1);
  EXPECT_EQ(warnings(quads, "linear 1 0.49", 1, "frame updated"), 1);
  EXPECT_EQ(warnings(quads, "linear 1 0.49", 0), 0);
  EXPECT_EQ(warnings(triangles, "linear 1 0.45", 0), 0);
  EXPECT_EQ(warnings(triangles, "eos linear 1 viscosity newtonian 0.01", 0, "frame updated"), 0);
  // plastic flow keeps the volume at any Poisson ratio
  const std::string metal = "eos linear 1 strength j2 0.46 1e-3", sand = "drucker/prager 1 0.3 30";
  EXPECT_EQ(warnings(triangles, metal, 0), 1);
  EXPECT_EQ(warnings(quads, metal, 1, "frame updated"), 1);
  EXPECT_EQ(warnings(quads, metal, 0), 0);
  EXPECT_EQ(warnings(triangles, sand, 0), 1);
  EXPECT_EQ(warnings(triangles, metal, 0, "frame total locking fbar"), 0);
  EXPECT_EQ(warnings(triangles, "neohookean 1 0.499", 0, "locking fbar"), 0);
}

// Lame's tube, Poisson ratio 0.499, widens as it should with means, quadrangles by half without
SERIAL_TEST(MeshGrid, FbarDoesNotLock)
{
  const double p = 1e-5, nu = 0.499;
  for (const Kind kind : {TRIANGLES, QUADS})
    for (const std::string frame : {"total", "updated"}) {
      double error[2];
      for (const bool fbar : {false, true}) {
        const ScratchFile file("tube.msh", tube(kind, 4));
        Scene run(scene(2, file.name, "linear 1 0.499",
                        "frame " + frame + " slip ylo slip yhi pressure xlo 1e-5" +
                            (fbar ? " locking fbar" : ""),
                        kind == QUADS));
        const auto start = run.gather();
        run.commands("fix v all viscous " + strprintf("%.17g", 3.3 / start.size()) +
                     "\nfix d all mpm/dt 0.5 until 40\nrun 100000\n");
        const auto end = run.gather();
        double sum = 0.0, all = 0.0;
        for (std::size_t k = 0; k < start.size(); k++) {
          const double *const X = start[k].x, r = hypot(X[0], X[1]);
          sum += hypot(end[k].x[0], end[k].x[1]) - r;
          all += (1 + nu) * p / 3.0 * ((1 - 2 * nu) * r + 4.0 / r);
        }
        error[fbar] =
            measured("mean displacement, " + frame + (fbar ? " fbar" : ""), sum / all) - 1.0;
      }
      if (kind == QUADS) {
        EXPECT_LT(error[0], -0.4);
        EXPECT_LT(std::fabs(error[1]), 0.02);
      } else
        EXPECT_LT(std::fabs(error[1]), std::fabs(error[0]));
    }
}

// Cells that turn inside out end the run with the determinant, which is a number
SERIAL_TEST(MeshGrid, FbarTellsOfInsideOut)
{
  for (const Kind kind : {QUADS, HEXAHEDRA}) {
    const ScratchFile file("bar.msh", bar(kind, 3));
    const int dim = kind == QUADS ? 2 : 3;
    Scene run(scene(dim, file.name, "neohookean 1 0.3",
                    "frame total locking fbar velocity xlo 0 NULL" +
                        std::string(dim == 3 ? " NULL" : "")));
    run.commands("velocity all ramp vx 0 -40 x 0 4\ntimestep 0.001\n");
    expect_error(run, "run 1000\n", "has a deformation gradient of determinant -0");
  }
}

// In the updated frame a body can be elsewhere than the sides that are loaded
SERIAL_TEST(MeshGrid, LostLoads)
{
  const auto square = [](double x, double y, double) {
    return std::array<double, 3>{4.0 * x, 4.0 * y, 0.0};
  };
  const ScratchFile grid("grid.msh", gmsh(QUADS, {8, 8, 0}, square));
  const auto warnings = [&](const std::string &body, const std::string &options) {
    return lines_that_say(box(2, "lj", "f f f", "-1 6 -1 6 -1 6", 1, 0.1) + "region body block " +
                              body +
                              " INF INF\ncreate_points 1 region body spacing 0.25\n"
                              "fix m all mpm/material density 1 linear 1 0.3\nfix g all mpm/mesh " +
                              grid.name + " " + options + "\ntimestep 1e-4\nrun 1\nrun 1\n",
                          "acts on nothing in");
  };
  EXPECT_EQ(warnings("0 4 0 4", "pressure xhi 1").size(), 0);
  EXPECT_EQ(warnings("0 3.75 0 4", "pressure xhi 1").size(), 0);    // in the same cells
  EXPECT_EQ(warnings("0 2 0 4", "slip xhi").size(), 0);
  const auto all = warnings("0 2 0 4", "pressure xhi 1"),
             half = warnings("0 4 0 2", "traction xhi 1 0 frame total");
  ASSERT_EQ(all.size(), 2u);    // at the start of each run
  EXPECT_THAT(all[0], HasSubstr("pressure on xhi acts on nothing in 100 % of its area"));
  ASSERT_EQ(half.size(), 2u);
  EXPECT_THAT(half[0], HasSubstr("traction on xhi acts on nothing in 43.8 % of its area"));
}

// LAMMPS takes the cutoff of communication from the lengths of bonds, as without the fix: two
// beads, 0.42 apart, of two ranks
TEST(MeshGrid, BondsReachAcrossRanks)
{
  const ScratchFile grid("grid.msh", gmsh(QUADS, {4, 4, 0}, [](double x, double y, double) {
                           return std::array<double, 3>{0.8 + 0.4 * x, 0.2 + 0.4 * y, 0.0};
                         }));
  Scene run("units si\ndimension 2\nboundary f f p\natom_style hybrid bond mpm\n"
            "neighbor 0.02 bin\nregion box block 0 2 0 1 -0.1 0.1\n"
            "create_box 2 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 8\n"
            "region block block 0.8 1.2 0.2 0.6 INF INF\nmass * 1\n"
            "create_points 1 region block spacing 0.05\ngroup points type 1\n"
            "create_atoms 2 single 0.79 0.81 0\ncreate_atoms 2 single 1.21 0.81 0\n"
            "group beads type 2\nset group beads mass 10\n"
            "fix m points mpm/material density 1000 neohookean 1.0e5 0.3\nfix g points mpm/mesh " +
            grid.name +
            "\nfix move beads nve\nbond_style harmonic\nbond_coeff 1 200 0.3\n"
            "variable n equal count(points)\ncreate_bonds single/bond 1 $(v_n+1) $(v_n+2)\n"
            "timestep 1e-5\nthermo_style custom step ebond\nrun 0\n");
  EXPECT_NEAR(run.evaluate("ebond"), 200.0 * (0.42 - 0.3) * (0.42 - 0.3), 1.0e-12);
}

// Points on sides of triangles have the strain of one by rounding: too soft, which is told
SERIAL_TEST(MeshGrid, PointsOnSides)
{
  // a column whose points are on the diagonals, or moved off these
  const auto column = [](double x, double y, double) {
    return std::array<double, 3>{0.5 * x, y, 0.0};
  };
  const auto scene = [&](const std::string &grid, const std::string &ppc,
                         const std::string &frame) {
    return box(2, "lj", "f f f", "0 0.5 0 1", 1, 0.1) +
        "region body block INF INF INF INF INF INF\ncreate_points 1 region body spacing " + ppc +
        "\nfix m all mpm/material density 1 neohookean 1000 0.3\nfix g all mpm/mesh " + grid +
        " velocity ylo 0 0 slip xlo slip xhi pressure yhi 5 " + frame +
        "\nfix slow all viscous 0.05\ntimestep 5e-4\ncompute u all displace/atom\n"
        "region top block INF INF 0.9 INF INF INF\ngroup top region top\n"
        "compute low top reduce ave c_u[2]\ncompute high top reduce ave y\n"
        "thermo_style custom step c_low c_high\n";
  };
  const double M = 1000.0 * 0.7 / (1.3 * 0.4);
  const ScratchFile triangles("triangles.msh", gmsh(TRIANGLES, {5, 10, 0}, column)),
      quads("quads.msh", gmsh(QUADS, {5, 10, 0}, column));
  for (const char *frame : {"frame updated", "frame total"})
    for (const bool moved : {false, true})
      for (const auto *grid : {&triangles, &quads}) {
        const bool on_sides = grid == &triangles && !moved;
        auto input = scene(grid->name, "0.05", frame);
        if (moved)
          input = replaced(input, "fix m all", "displace_atoms all move 0.01 0 0\nfix m all");
        Scene run(input + "run 1500\n");
        const double settlement =
            -run.compute_scalar("low") / (run.compute_scalar("high") * 5.0 / M);
        measured(strprintf("%s, %s, %s", frame, moved ? "moved" : "on diagonals",
                           grid == &triangles ? "triangles" : "quads"),
                 settlement);
        EXPECT_EQ(times_said(input + "run 1\n", "are on sides of cells"), on_sides ? 1 : 0);
        if (on_sides)
          EXPECT_GT(settlement, 1.05);
        else
          EXPECT_NEAR(settlement, 1.0, grid == &quads ? 0.01 : 0.05);
      }
}

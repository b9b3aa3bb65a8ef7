// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4

// Fix mpm/mesh/heat: conduction on a mesh; temperatures, fluxes, and convection at its groups.

#include "bad_input_testing.h"
#include "meshgrid/mesh_grid_testing.h"

using namespace MPM_TEST;

using Map = std::function<std::array<double, 3>(double, double, double)>;

/** A block of 1 x 1 x 1 (2d: 1 x 1) of rectangles, inner nodes are moved by a part of a cell. */
std::string block(Kind kind, int n)
{
  if (kind == QUADS || kind == HEXAHEDRA)
    return gmsh(kind, {n, n, n}, [](double x, double y, double z) {
      return std::array<double, 3>{x * (1.4 - 0.4 * x), y, z * (0.6 + 0.4 * z)};
    });
  const double bend = 0.2;
  return gmsh(kind, {n, n, n}, [=](double x, double y, double z) {
    const double s =
        bend / n * sin(PI * x) * sin(PI * y) * (kind == TETRAHEDRA ? sin(PI * z) : 1.0);
    return std::array<double, 3>{x + s * cos(7.0 * x + 5.0 * y), y - s * sin(11.0 * x + 3.0 * z),
                                 z + (kind == TETRAHEDRA ? 0.7 * s : 0.0)};
  });
}

/** Quarter of a ring from radius 1 to 2: groups xlo and xhi are its circles. */
std::string ring(Kind kind, int n)
{
  return gmsh(kind, {n, 2 * n, 0}, [](double s, double t, double) {
    const double r = 1.0 + s, phi = 0.5 * PI * t;
    return std::array<double, 3>{r * cos(phi), r * sin(phi), 0.0};
  });
}

/** Density, specific heat, and conductivity 1, and next to no stiffness. */
std::string scene(int dim, const std::string &file, const std::string &heat,
                  const std::string &conducting = "1 0 1", const std::string &mesh = "")
{
  return box(dim, "lj", "f f f", "-1 4 -1 4 -1 4", 1, 0.1) + "create_points 1 elements " + file +
      " halve 1\nfix m all mpm/material density 1 linear 1e-8 0.3 thermal conducting " +
      conducting + "\nfix g all mpm/mesh " + file + " frame total " + mesh +
      "\nfix h all mpm/mesh/heat g " + heat + "\ncompute T all mpm/atom temperature\n";
}

/** [local atom] */
const double *temperatures(Scene &run)
{
  auto *compute = run.per_atom("T");
  return compute->vector_atom;
}
double out(Scene &run, int k)
{
  return run.lmp->modify->get_fix_by_id("h")->compute_vector(k);
}

// A temperature that is linear in x is that of any mesh of triangles and tetrahedra, exactly, and
// so is its flux; of quadrangles and hexahedra where they are not bent, as points integrate over
// bent ones with an error of second order in their distance
SERIAL_TEST(MeshHeat, Patch)
{
  for (const Kind kind : {TRIANGLES, QUADS, TETRAHEDRA, HEXAHEDRA}) {
    const int dim = kind < TETRAHEDRA ? 2 : 3;
    const ScratchFile file("block.msh", block(kind, 3));
    Scene run(scene(dim, file.name, "temperature xlo 1 temperature xhi 3") +
              "timestep 0.05\nrun 80\n");
    const double *const T = temperatures(run);
    double most = 0.0;
    for (int i = 0; i < run.n(); i++) grow(most, T[i] - 1.0 - 2.0 * run.x()[i][0]);
    EXPECT_LT(measured("error of the temperature", most), 1e-12);
    EXPECT_NEAR(out(run, 0), -2.0, 1e-11);
    EXPECT_NEAR(out(run, 2), 2.0, 1e-11);
  }
}

// Between two circles the temperature is log r: order 2. What came in is what points have got
SERIAL_TEST(MeshHeat, Ring)
{
  for (const Kind kind : {TRIANGLES, QUADS}) {
    double error[2];
    for (const int n : {5, 10}) {
      const ScratchFile file("ring.msh", ring(kind, n));
      Scene run(scene(2, file.name, "temperature xlo 1 temperature xhi 0") +
                "timestep 0.05\nrun 80\n");
      const double *const T = temperatures(run);
      double square = 0.0;
      for (int i = 0; i < run.n(); i++)
        square += pow(T[i] - 1.0 + log(hypot(run.x()[i][0], run.x()[i][1])) / log(2.0), 2);
      error[n == 10] = measured("error of the temperature", sqrt(square / run.n()));
      const double exact = 0.5 * PI / log(2.0);    // of a quarter
      EXPECT_NEAR(measured("flux", out(run, 0) / exact), 1.0, n == 10 ? 0.005 : 0.02);
      EXPECT_NEAR(out(run, 2), -out(run, 0), 1e-11);
      double stored = 0.0;
      for (int i = 0; i < run.n(); i++) stored += run.lmp->atom->rmass[i] * T[i];
      const double got = run.fix("h")->compute_scalar();
      EXPECT_NEAR(got, stored, 1e-13 * out(run, 1));
      EXPECT_NEAR(got, out(run, 1) + out(run, 3), 1e-13 * out(run, 1));
    }
    EXPECT_LT(error[1], 2e-3);
    EXPECT_GT(log2(error[0] / error[1]), 1.8);
  }
}

// A slab cooled by convection, Bi = 1 (M2a), in steps below and above the explicit limit
SERIAL_TEST(MeshHeat, Slab)
{
  const ScratchFile file("slab.msh", gmsh(QUADS, {20, 2, 0}, [](double x, double y, double) {
                           return std::array<double, 3>{x, 0.1 * y, 0.0};
                         }));
  for (const double dt : {0.0005, 0.01}) {
    Scene run(scene(2, file.name, "convection xhi 1.0 v_outside", "1 1 1", "slip ylo slip yhi")
                  .insert(0, "variable outside equal 0\n") +
              strprintf("timestep %g\nrun %ld\n", dt, std::lround(0.5 / dt)));
    const double *const T = temperatures(run);
    double ends[2] = {0.0, 0.0}, all = 0.0, n[2] = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++) {
      all += run.lmp->atom->rmass[i] * T[i];
      for (const int k : {0, 1})
        if (std::fabs(run.x()[i][0] - k) < 0.03) {
          ends[k] += T[i];
          n[k] += 1.0;
        }
    }
    // at a quarter of a cell from the ends: cos(0.86033 x) is flat at the one, and has a slope of
    // -0.4 at the other
    EXPECT_NEAR(measured("insulated side", ends[0] / n[0]), 0.772526, 0.001);
    EXPECT_NEAR(measured("cooled side", ends[1] / n[1] - 0.0125 * 0.504522), 0.504522, 0.001);
    EXPECT_NEAR(all - 0.1, out(run, 1), 1e-14);    // mass 0.1
  }
}

// Heat in on one side, convection on the other: T = T_0 + q/h + q (1 - x)/k, k of a turned material
SERIAL_TEST(MeshHeat, FluxAndConvection)
{
  const ScratchFile file("block.msh", block(TETRAHEDRA, 2));
  Scene run(scene(3, file.name, "flux xlo 2 convection xhi 4 3",
                  "1 3 9 orthotropic 1 5 axes 0 1 0 1 0 0") +
            "timestep 0.02\nrun 800\n");
  const double *const T = temperatures(run);
  for (int i = 0; i < run.n(); i++) EXPECT_NEAR(T[i], 3.5 + 2.0 * (1.0 - run.x()[i][0]), 1e-10);
  EXPECT_NEAR(out(run, 0), 2.0, 1e-12);
  EXPECT_NEAR(out(run, 2), -2.0, 1e-10);
}

// A body stretched by 1.5 along the flow conducts less, by that factor, across it more
SERIAL_TEST(MeshHeat, OfAStretchedBody)
{
  for (const bool along : {true, false}) {
    const ScratchFile file("block.msh", block(TRIANGLES, 3));
    const std::string move = along ? "velocity xlo 0 0 velocity xhi v_v 0 slip ylo slip yhi"
                                   : "velocity ylo 0 0 velocity yhi 0 v_v slip xlo slip xhi";
    Scene run(replaced(scene(2, file.name, "temperature xlo 1 temperature xhi 0", "1 0 1", move),
                       "linear 1e-8 0.3", "neohookean 1 0")
                  .insert(0, "variable v equal 0.25*(time<2)\n") +
              "fix v all viscous 0.03\ntimestep 0.01\nrun 1500\n");
    double stretch = 0.0;
    for (int i = 0; i < run.n(); i++) stretch += run.points().F[i][along ? 0 : 4] / run.n();
    EXPECT_NEAR(stretch, 1.5, 0.005);
    EXPECT_NEAR(measured("flow", out(run, 0) * (along ? stretch : 1.0 / stretch)), 1.0, 2e-6);
  }
}

TEST(MeshHeat, RanksAndRestart)
{
  const ScratchFile file("ring.msh", ring(TRIANGLES, 6));
  const std::string heat = "temperature xlo v_hot flux ylo 0.5 convection xhi 2 -1",
                    variable = "variable hot equal sin(time)\n", others = "velocity xhi 0 0\n";
  const std::string first = variable +
      replaced(scene(2, file.name, heat, "1 0 0.1 expansion 0.02", others), "linear 1e-8 0.3",
               "neohookean 1 0.3") +
      "velocity all set 0.05 0.1 0\ntimestep 0.01\n";
  const auto at = first.find("fix m all"), end = first.find("compute T");
  Twins(first, 40, "neighbor 0.1 bin\n" + variable + first.substr(at, end - at) + "timestep 0.01\n",
        40, 1e-11);
  OnRanks balanced(first, "run 80\n", "fix b all balance 20 1.0 shift xy 5 1.1\n");
  EXPECT_LT(measured("difference with balance", balanced.difference()), 1e-11);
  for (int k = 0; k < 6; k++)
    EXPECT_NEAR(out(balanced.parallel, k), out(balanced.serial, k), 1e-12) << k;
  Continued run(first, 40,
                "neighbor 0.1 bin\n" + variable + first.substr(at, end - at) + "timestep 0.01\n",
                40);
  for (int k = 0; k < 6; k++) EXPECT_EQ(out(run.whole, k), out(run.again, k)) << k;
  EXPECT_EQ(run.whole.fix("h")->compute_scalar(), run.again.fix("h")->compute_scalar());
}

// Two layers of conductivities 1 and 10, from x = 0.5 or in the middle of the next cells: 8 and 4 %
// too much heat with those of points, not so with means
SERIAL_TEST(MeshHeat, LayersThatCutCells)
{
  for (const Kind kind : {QUADS, TRIANGLES})
    for (const bool cut : {false, true})
      for (const int n : {8, 16}) {
        // turned: the sides of cells and the interface are not along the axes of the box
        for (const bool turned : {false, true}) {
          if (turned && (kind == TRIANGLES || n == 16 || !cut)) continue;
          const double c = turned ? 0.8 : 1.0, s = turned ? 0.6 : 0.0;
          const ScratchFile file(
              "block.msh", gmsh(kind, {n, 2, 0}, [=](double x, double y, double) {
                return std::array<double, 3>{c * x - 0.2 * s * y, s * x + 0.2 * c * y, 0.0};
              }));
          const double at = 0.5 + (cut ? 0.5 / n : 0.0);
          const auto layers = [&](const char *behind) {
            const char *const conducting =
                "mpm/material density 1 linear 1e-8 0.3 thermal conducting";
            return box(2, "lj", "f f f", "-1 4 -1 4 -1 4", 2, 0.1) +
                strprintf("create_points 1 elements %s halve 1\n"
                          "region behind plane %.17g %.17g 0 %g %g 0\nset region behind type 2\n"
                          "group front type 1\ngroup behind type 2\nfix m front %s 1 0 1\n"
                          "fix m2 behind %s 1 0 %s\nfix g all mpm/mesh %s frame total\n"
                          "fix h all mpm/mesh/heat g temperature xlo 1 temperature xhi 0\n"
                          "timestep 0.002\n",
                          file.name.c_str(), c * at, s * at, c, s, conducting, conducting, behind,
                          file.name.c_str());
          };
          const auto told = [&](const char *behind) {
            return times_said(layers(behind) + "run 1\n", "interfaces that are not along sides");
          };
          EXPECT_EQ(told("10"), 0);
          EXPECT_EQ(told("10 orthotropic 10 10"), cut ? 1 : 0);
          EXPECT_EQ(told("2 orthotropic 2 2"), 0);
          for (const int axis : {0, 1, 2}) {
            if (axis && (kind == TRIANGLES || n == 16)) continue;
            Scene run(layers("10"));
            if (axis) {
              const double along = axis == 1 ? 1.25 : 1.0, across = axis == 2 ? 1.25 : 1.0;
              for (int i = 0; i < run.n(); i++) {
                double *const F = run.points().F[i];
                F[0] = along * c * c + across * s * s;
                F[1] = F[3] = (along - across) * c * s;
                F[4] = along * s * s + across * c * c;
              }
            }
            run.commands("run 1000\n");
            const double width = axis == 1 ? 0.8 : axis == 2 ? 1.25 : 1.0;
            const double q = measured("heat over what ought to go through",
                                      out(run, 0) / (0.2 * width / (at + (1.0 - at) / 10)));
            EXPECT_NEAR(q, 1.0, kind == QUADS || !cut ? 1e-4 : n == 8 ? 0.035 : 0.028);
          }
        }
      }
}

// Water of 10 degrees freezes below a wall of -20, and ice of -10 melts on one of 20, for an hour
// (Neumann: 27.765 mm, 12.823 mm), wherever the table of the conductivity has its jump next to the
// melting temperature. Partly molten points had that of one phase: 24.2 and 15.2 mm
SERIAL_TEST(MeshHeat, FrontsDoNotSeeTheSideOfTheJump)
{
  const int n = 100;
  const ScratchFile file("bar.msh", gmsh(QUADS, {n, 1, 0}, [](double x, double y, double) {
                           return std::array<double, 3>{0.4 * x, 0.02 * y, 0.0};
                         }));
  for (const bool melts : {false, true}) {
    double front[2];
    for (const bool above : {false, true}) {
      Scene run(
          box(2, "si", "f f f", "-0.1 0.5 -0.1 0.1 -0.1 0.1", 1, 0.005) +
          "create_points 1 elements " + file.name +
          " halve 1\nfix m all mpm/material density 1000 linear 1e-8 0.3 " +
          strprintf("thermal conducting 4226 %g 0.556 melt 273.15 333400 vary thermal.K "
                    "table %s 3.99281 %s 1 vary CP table 273.15 0.485092 273.16 1\n",
                    melts ? 263.15 : 283.15, above ? "273.15" : "273.14",
                    above ? "273.16" : "273.15") +
          "fix g all mpm/mesh " + file.name + " frame total\n" +
          strprintf("fix h all mpm/mesh/heat g temperature xlo %g\n", melts ? 293.15 : 253.15) +
          "timestep 3.0\ncompute f all mpm/atom molten volume\nrun 1200\n");
      auto *const compute = run.per_atom("f");
      double molten = 0.0;
      for (int i = 0; i < run.n(); i++)
        molten += compute->array_atom[i][0] * compute->array_atom[i][1] / 0.02;
      front[above] = measured(strprintf("%s, jump %s, front [mm]", melts ? "melts" : "freezes",
                                        above ? "above" : "below"),
                              1e3 * (melts ? molten : 0.4 - molten));
      EXPECT_NEAR(front[above], melts ? 12.823 : 27.765, 0.3);
    }
    EXPECT_NEAR(front[0], front[1], 0.03);
  }
}

SERIAL_TEST(MeshHeat, BadInput)
{
  const ScratchFile file("block.msh", block(QUADS, 3));
  std::string good = scene(2, file.name, "");
  good = good.substr(0, good.find("fix h all")) + "timestep 0.01\n";
  const std::string fix = "fix h all mpm/mesh/heat ";
  expect_refused(
      good,
      {{fix, "needs the ID of a fix mpm/mesh"},
       {fix + "none\nrun 1",
        "none is not the ID of a fix mpm/mesh; for bodies on lattices use fix mpm/heat"},
       {"group some id 1 2\nfix h some mpm/mesh/heat g", "use group all"},
       {fix + "g temperature top 1\nrun 1", "no elements in a physical group or set 'top'"},
       {fix + "g flux body 1\nrun 1", "is not the side of a cell"},
       {fix + "g flux xlo v_none\nrun 1", "Variable none for fix mpm/mesh/heat h does not exist"},
       {fix + "g convection xlo 1", "convection"},
       {fix + "g convection xlo -1 0", "coefficient that is not negative"},
       {"variable H equal -1\n" + fix + "g convection xlo v_H 0\nrun 1",
        "variable H = -1, but it must not be negative"},
       {"fix h all mpm/heat\nrun 1", "use fix mpm/mesh/heat"},
       {fix + "g flux xlo 1 flux ylo 1 flux xlo 2", "twice for group xlo: give it once"},
       {fix + "g cooling xlo 1", "cooling"},
       {fix + "g\nfix more all mpm/mesh/heat g\nrun 1", "are of the same fix mpm/mesh"},
       {fix + "g\nunfix g\nfix g all mpm/mesh " + file.name + "\nrun 1", "use frame total"},
       {fix + "g\nunfix m\nfix m all mpm/material density 1 linear 1e-8 0.3\nrun 1",
        "has a part thermal conducting"},
       {fix + "g\ntimestep 100\nrun 1", "use a smaller time step"}});
}

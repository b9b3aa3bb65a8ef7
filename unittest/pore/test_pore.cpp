// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 400

// Fix mpm/pore: pore water in soils, with one velocity for both.

#include "pore/pore_testing.h"

#include "field/mpm_physics.h"
#include "pore/fix_mpm_pore.h"

using namespace MPM_TEST;

// Terzaghi's column at T = 0.2, drained at a face of the box or at a free surface
SERIAL_TEST(Consolidation, Terzaghi)
{
  for (const double Kf : first_of(1, {2.2e8, 2.2e9})) {
    double rms[2];
    for (const int n : {10, 20}) {
      const auto result = consolidate(n, "yhi pressure 0", 1.0, 0.0, Kf);
      rms[n == 20] = measured(strprintf("Kf %g, %d cells, rms", Kf, n), result.rms);
      if (n == 20) EXPECT_NEAR(measured("U", result.U) / 0.504088, 1.0, 0.01);
    }
    EXPECT_LT(rms[1], 0.002);
  }
  for (const double offset : first_of(1, {0.3, 0.0, 0.5})) {
    const auto result =
        consolidate(20, "free pressure 0", 1.2, offset, first_of(1, {2.2e8, 2.2e9}).back());
    EXPECT_LT(measured(strprintf("free, offset %g, rms", offset), result.rms), 0.002);
    EXPECT_NEAR(measured("U", result.U) / 0.504088, 1.0, 0.01);
  }
}

// Terzaghi's equation has no inertia and small strains: pressures of light soil and load are of an
// order above one. (With 2 g/cm^3 inertia shifts them by 0.05 % of the load)
SERIAL_TEST(Consolidation, Converges)
{
  LONG_CASE();
  struct Surface {
    const char *options;
    double top, offset;
  };
  for (const auto &at : {Surface{"yhi pressure 0", 1.0, 0.0}, {"free pressure 0", 1.2, 0.3}}) {
    double rms[2];
    for (const bool fine : {false, true})
      rms[fine] = consolidate(fine ? 20 : 10, at.options, at.top, at.offset, 2.2e8, 10.0, 80.0).rms;
    measured(strprintf("%s, 10 cells, rms", at.options), rms[0]);
    measured("20 cells", rms[1]);
    EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 0.9);
  }
}

// A pressure with a wave of 20 cells, in soil as stiff as its water, which does not flow: what is
// left where the soil bears its slope stays for 4000 steps. Relax, or every, would take 0.056 (k
// h)^4 of it again and again
SERIAL_TEST(Relax, KeepsSmoothPressures)
{
  constexpr double STIFF = 100.0 * MODULUS, WATER = 4.0e8;
  for (const char *more : {"", "every auto", "formulation u-v-p"}) {
    Scene run(plane("si", "p p", "0 2 0 0.2", 1, 0.03) +
              "create_points 1 box spacing 0.05\nfix grid all mpm 0.1\n"
              "fix m all mpm/material density 2000 linear 1e9 0.3\n"
              "variable p atom cos(PI*x)\nfix damp all viscous 2e4\n" +
              strprintf("fix water all mpm/pore %g 1000 9810 soil m 0.4 constant 1e-12 initial v_p "
                        "%s\nfix dt all mpm/dt 0.5\n",
                        WATER, more));
    Water water(run);
    run.commands("run 4000\n");
    const double *const p = water.pressures();
    double sums[2] = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++) {
      const double wave = std::cos(PI * run.x()[i][0]);
      sums[0] += p[i] * wave;
      sums[1] += wave * wave;
    }
    EXPECT_NEAR(measured(std::string(more) + ": pressure over that which is left",
                         sums[0] / sums[1] * (1.0 + WATER / 0.4 / STIFF)),
                1.0, 0.015);
  }
}

// Where water has no time to flow through a cell, the pressure below the drained top is even
SERIAL_TEST(Undrained, PressureIsEven)
{
  for (const double Kf : {2.2e8, 2.2e9})
    for (const double k : first_of(2, {1e-4, 1e-8, 1e-5, 1e-6, 1e-7}))
      EXPECT_LT(scatter_of_pressure(Kf, k, ""), 0.01);
}

/** A block of stiff soil of 1 m, a cell of 0.1 m from the sides of its box or between them, that
 *  loses water through faces; pressures at first are anything up to 1e4. */
std::string leaking(const std::string &box, double spacing, double origin, const std::string &faces,
                    double k)
{
  return plane("si", "f f", box, 1, 0.03) + "region soil block 0 1 0 1 INF INF\n" +
      strprintf("create_points 1 region soil spacing %g\n", spacing) +
      strprintf("fix grid all mpm 0.1 origin %g 0\n", origin) +
      "fix m all mpm/material density 2002 linear 1e10 0.3\nvariable p atom 1e4*random(0,1,482)\n" +
      strprintf("fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant %g initial v_p %s\n", k,
                faces.c_str()) +
      "fix dt all mpm/dt 0.5\n";
}
/** Greatest pressure of points in these runs of some steps. */
double greatest_pressure(Scene &run, Water &water, int runs, int steps)
{
  double most = 0.0;
  for (int k = 0; k < runs; k++) {
    run.commands(strprintf("run %d\n", steps));
    const double *const p = water.pressures();
    for (int i = 0; i < run.n(); i++)
      most = std::max(most, std::isfinite(p[i]) ? std::fabs(p[i]) : 1e300);
  }
  return most;
}
// what the motion of so stiff a soil can add: twice K_f/(n M)
const double NEVER_ABOVE = 1e4 * (1.0 + 2.0 * 2.2e7 / 0.4 / (1e3 * MODULUS));

// Nodes beside a body have next to nothing of it where points are in the middle of cells: a side
// that moves through cells, or is there by the place of nodes or with one point for each cell
SERIAL_TEST(Surface, NextToASide)
{
  for (const double k : {1e-3, 1e-2, 1e-1}) {
    Scene run(leaking("-1 3 0 1.5", 0.05, 0.0, "ylo pressure 0", k) +
              "fix floor all mpm/boundary ylo slip\nvelocity all set 100 0 0\n");
    Water water(run);
    EXPECT_LT(measured(strprintf("moving, k %g", k), greatest_pressure(run, water, 20, 10)),
              NEVER_ABOVE);
  }
  for (const auto &[spacing, origin] :
       {std::pair{0.05, 0.075}, std::pair{0.05, 0.0751}, std::pair{0.1, 0.0}})
    for (const double k : {1e-3, 1e-2, 1e-1}) {
      Scene run(leaking("0 1 0 1.5", spacing, origin, "ylo pressure 0 free pressure 0", k) +
                "fix walls all mpm/boundary xlo xhi ylo slip\n");
      Water water(run);
      EXPECT_LT(measured(strprintf("spacing %g, origin %g, k %g", spacing, origin, k),
                         greatest_pressure(run, water, 10, 5)),
                NEVER_ABOVE);
    }
  for (const auto &[faces, k] : {std::pair{"xlo pressure 0", 1e-2},
                                 std::pair{"xlo pressure 0 ylo pressure 0 zhi pressure 0", 1e-2},
                                 std::pair{"xlo pressure 0 xhi pressure 0 ylo pressure 0 yhi "
                                           "pressure 0 zlo pressure 0 zhi pressure 0",
                                           1.0}}) {
    Scene run(
        space("si", "f f f", "0 0.5 0 0.5 0 0.5", 1, 0.03) +
        "create_points 1 box spacing 0.1\nfix grid all mpm 0.1\n"
        "fix m all mpm/material density 2002 linear 1e10 0.3\n"
        "fix w all mpm/boundary xlo xhi ylo yhi zlo zhi slip\n"
        "variable p atom 1e4*random(0,1,482)\n" +
        strprintf("fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant %g initial v_p %s\n",
                  k, faces) +
        "fix dt all mpm/dt 0.5\n");
    Water water(run);
    EXPECT_LT(measured(faces, greatest_pressure(run, water, 10, 5)), NEVER_ABOVE);
  }
}

/** Water that has come into soil below a free surface with this slope, over the flux times area and
 *  time; above the height bottom if this is not 0, with a surface there, too. */
double came_in(double degrees, double h, double origin, double bottom = 0.0,
               const std::string &more = "")
{
  const double d = 0.5 * h, slope = degrees * PI / 180.0, surfaces = bottom > 0.0 ? 2.0 : 1.0;
  std::string table = "x,y,volume\n";
  for (double x = 0.5 * d; x < 2.0; x += d)
    for (double y = bottom + 0.5 * d; y < 1.0 + tan(slope) * x; y += d)
      table += strprintf("%.15g,%.15g,%.15g\n", x, y, d * d);
  const ScratchFile file("slope.csv", table);
  Scene run(plane("si", "f f", "0 2 0 4", 1, d) + "create_points 1 table " + file.name +
            strprintf("\nfix grid all mpm %g origin %g %g\n", h, origin, origin) +
            "fix m all mpm/material density 2000 linear 1e8 0.0\n"
            "fix sides all mpm/boundary xlo xhi ylo slip\n"
            "fix water all mpm/pore 1e7 1000 1 soil m 0.4 constant 1e-7 free flux 1e-6 " +
            more + "\nfix dt all mpm/dt 0.3\nrun 20\n");
  return run.fix("water")->compute_scalar() / (surfaces * 1e-6 * 2.0 / cos(slope) * run.time());
}

// Water of a flux: times the area of the free surface, which was up to 9 % too small
SERIAL_TEST(Surface, AreaOfAFlux)
{
  for (const double origin : {0.0, 0.03, 0.07}) {
    for (const double bottom : {0.0, 0.8})
      EXPECT_NEAR(measured("with inertia", came_in(0.0, 0.1, origin, bottom, "formulation u-v-p")),
                  1.0, 2e-9);
    EXPECT_NEAR(measured("10 degrees", came_in(10.0, 0.1, origin, 0.0, "formulation u-v-p")), 1.0,
                0.03);
    EXPECT_NEAR(came_in(0.0, 0.1, origin), 1.0, 2e-9);
    EXPECT_NEAR(came_in(0.0, 0.1, origin, 0.8), 1.0, 1e-9);
    for (const double degrees : {10.0, 30.0, 45.0}) {
      const double coarse =
                       measured(strprintf("%g degrees", degrees), came_in(degrees, 0.2, origin)),
                   fine = measured("half the spacing", came_in(degrees, 0.1, origin));
      EXPECT_NEAR(coarse, 1.0, 0.08);
      EXPECT_NEAR(fine, 1.0, 0.03);
    }
  }
}

// Water through a face of the box: flux times area, wherever nodes are; 1.9 % were missing
SERIAL_TEST(Surface, AreaOfAFace)
{
  for (const char *shape : {"quadratic", "cubic"})
    for (int k = 0; k < 10; k++) {
      Scene run(replaced(column(4, "2.2e8 1000 9810 soil m 0.4 constant 1e-5 ylo flux 1e-4 every 1",
                                SOIL, 1.2, 0.1 * k),
                         "origin", strprintf("shape %s origin", shape)) +
                "timestep 1e-5\nrun 20\n");
      EXPECT_NEAR(measured(strprintf("%s, %d", shape, k),
                           run.fix("water")->compute_scalar() / (1.0 * 1e-4 * 20e-5)),
                  1.0, 1e-8);
    }
  for (const double shift : {0.0, 0.3, 0.7}) {
    const double h = 0.125;
    Scene run(space("si", "f f f", "0 1 0 1 0 1", 1, 0.3 * h) +
              strprintf("create_points 1 box spacing %g\n", 0.5 * h) +
              strprintf("fix grid all mpm %g origin %g %g %g\n", h, shift * h, 0.4 * h, 0.6 * h) +
              "fix m all mpm/material " + SOIL +
              "\nfix water all mpm/pore 2.2e8 1000 9810 soil m 0.4 constant 1e-5 xhi flux 1e-4 "
              "every 1\ntimestep 1e-5\nrun 20\n");
    EXPECT_NEAR(
        measured(strprintf("3d, %g", shift), run.fix("water")->compute_scalar() / (1e-4 * 20e-5)),
        1.0, 2e-8);
  }
}

// what comes to points is what comes through the surface, as volume of water and as mass
TEST(Water, IsKept)
{
  expect_water_is_kept_by("kozeny 1e-3", "");
}

// Consolidation by half of the modulus, Kirchhoff stress logarithmic in the stretch, permeability
// with its square, T = 0.2: table of the benchmark, the row of the logarithmic law (hencky) for a
// linear relation of stress and logarithmic strain; the points cross up to 4 cells
SERIAL_TEST(LargeStrain, Consolidation)
{
  const int n = 20;
  Scene run(column(n, "200 1e-9 1.0 soil m 0.5 squared 1.0 free pressure 0",
                   "density 1e-3 linear 1.0 0.0") +
            load(n, 0.5, 0.004));
  Water water(run);
  run.commands("compute n all mpm/atom porosity\n");
  run_until(run, 0.202);
  double volume = 0.0;
  auto *compute = run.per_atom("n");
  for (int i = 0; i < run.n(); i++) {
    const double J = run.points().jacobian(i);
    volume += J * run.lmp->atom->vfrac[i];
    EXPECT_NEAR(compute->vector_atom[i], 1.0 - 0.5 / J, 1e-14);
  }
  EXPECT_NEAR(measured("settlement", 1.0 - volume * n / 4.0) / 0.183627, 1.0, 0.02);
  EXPECT_NEAR(measured("pressure at the base", 2.0 * water.mean(0.0, 0.5 / n)) / 0.742959, 1.0,
              0.005);
}

// A column that vibrates between closed ends: frequency and damping of the equations without the
// inertia of the water's own motion, s^3 + d s^2 + (a + b) s + d a = 0
SERIAL_TEST(Modes, FrequencyAndDamping)
{
  for (const double Kf : {2.2e8, 2.2e9}) {
    const double density = 0.6 * 2650.0 + 400.0, k = 1e-3;
    const double a = MODULUS * PI * PI / density, b = Kf / 0.4 * PI * PI / density,
                 d = Kf / 0.4 * PI * PI * k / 9810.0;
    const double period = 2.0 * PI / std::sqrt(a + b);
    const int n = 40;
    Scene run(column(n, strprintf("%g 1000 9810 soil m 0.4 constant 1e-3", Kf),
                     "density 1990 linear 1e7 0.3", 1.0, 0.0, "ylo yhi"));
    run.set_velocity([](const double *x, double *v) {
      v[1] = 1e-4 * std::sin(PI * x[1]);
    });
    const int steps = 400;
    const double dt = period / steps;
    // v' = pi (p - s)/rho, s' = M pi v, p' = -K/n pi v - d p in units where these are a and b
    double v = 1.0, s = 0.0, p = 0.0;
    double sum = 0.0, square = 0.0;
    run.commands(strprintf("timestep %.17g\nrun 0\n", dt));
    for (int k = 0; k < 30; k++) {
      run.commands("run 20\n");
      for (int j = 0; j < 20 * 20; j++) {
        const double e = dt / 20;
        v += e * (p - s);
        s += e * a * v;
        p = (p - e * b * v) / (1.0 + e * d);
      }
      double mine = 0.0, norm = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double w = std::sin(PI * run.x()[i][1]);
        mine += 1e4 * w * run.v()[i][1];
        norm += w * w;
      }
      sum += (mine / norm - v) * (mine / norm - v);
      square += v * v;
    }
    EXPECT_LT(measured(strprintf("Kf %g, difference", Kf), std::sqrt(sum / square)), 0.03);
  }
}

// a wave of undrained soil gains no energy, and the ledger closes
SERIAL_TEST(Energy, Wave)
{
  Scene run(replaced(column(20, "2.2e8 1000 9810 soil m 0.4 constant 1e-9",
                            "density 1990 linear 1e7 0.3", 1.0, 0.0, "ylo yhi"),
                     "origin", "gain error 0.01 origin"));
  run.set_velocity([](const double *x, double *v) {
    v[1] = 1e-2 * std::sin(PI * x[1]);
  });
  const double h = 0.05;
  run.commands("compute e all mpm/energy\nfix dt all mpm/dt 0.2\nrun 0\n");
  const double before = run.compute_scalar();
  run.commands("run 2000\n");
  EXPECT_NEAR(before / (0.5 * 1990 * 1e-4 * 0.5 * 4 * h), 1.0, 1e-12);
  EXPECT_LT(measured("energy", run.compute_scalar() / before), 1.001);
  EXPECT_GT(run.compute_scalar() / before, 0.8);
  EXPECT_NEAR(measured("residual", run.compute_vector()[10] / before), 0.0, 1e-12);
}

// flow through a column under its weight, up and down: flux, effective stress, no gain of energy
SERIAL_TEST(Flow, SeepageChangesTheEffectiveStress)
{
  for (const double i : first_of(2, {0.9, -0.5, 0.5})) {
    Scene run(seeping_column(i, 1e-3, ""));
    expect_seepage(run, i, 1e-3);
  }
}

// Sand without cohesion lifts as a plug above the critical gradient, 0.99, as fast as water comes
// in: by the head above the critical one over half a node spacing
SERIAL_TEST(Flow, LiftsAboveTheCriticalGradient)
{
  const auto rate = [](double i) {
    Scene run(replaced(column(10,
                              "2.2e7 1000 9810 soil m 0.4 constant 1e-3 geostatic 0.5 1 "
                              "ylo pressure v_bottom free pressure 0",
                              "density 1990 mohr/coulomb 1e7 0.3 35 0", 1.3),
                       "fix water",
                       "fix g all gravity 9.81 vector 0 -1 0\n" +
                           strprintf("variable bottom equal "
                                     "9810*(1+%g*((time<0.1)*time/0.1+(time>=0.1)))\n",
                                     i) +
                           "fix water"));
    double place[2];
    for (const bool late : {false, true}) {
      run_until(run, late ? 0.6 : 0.4);
      place[late] = 0.0;
      for (int k = 0; k < run.n(); k++) place[late] += run.x()[k][1] / run.n();
    }
    return measured(strprintf("gradient %g, rate over permeability", i),
                    (place[1] - place[0]) / 0.2 / 1e-3);
  };
  EXPECT_NEAR(rate(0.9), 0.0, 0.02);
  const double low = rate(1.02), high = rate(1.05);
  EXPECT_NEAR(low, (1.02 - 0.99) / 0.05, 0.2);
  EXPECT_NEAR(high, (1.05 - 0.99) / 0.05, 0.2);
  EXPECT_NEAR(measured("critical gradient", 1.02 - 0.03 * low / (high - low)) / 0.99, 1.0, 0.008);
}

// walls that let go make sums over points of their own between the stages of the flow
SERIAL_TEST(Walls, ThatSeparate)
{
  Scene run(replaced(column(10, "2.2e8 1000 9810 soil m 0.4 constant 1e-3 free pressure 0", SOIL),
                     "ylo slip", "ylo separate") +
            "fix g all gravity 9.81 vector 0 -1 0\nfix dt all mpm/dt 0.5\nrun 400\n");
  double fastest = 0.0;
  for (int i = 0; i < run.n(); i++) grow(fastest, run.v()[i][1]);
  EXPECT_LT(measured("fastest", fastest), 0.002);
}

/** A column of 1 m with 10 cells on a floor of this kind, under its weight; water has the pressure
 *  of rest and this gradient, and leaves at the top. offset: of the floor from nodes, in cells. */
std::string above_floor(const std::string &wall, double gradient, double offset,
                        const std::string &material, const std::string &axes)
{
  return plane("si", "p f", axes, 1, 0.03) +
      "region soil block 0 0.4 0 1 INF INF\nregion ground block INF INF -1 0 INF INF\n"
      "create_points 1 region soil spacing 0.05\n" +
      strprintf("fix grid all mpm 0.1 origin 0 %g\n", 0.1 * offset) + "fix m all mpm/material " +
      material + "\nfix floor all mpm/boundary " + wall +
      "\nfix g all gravity 9.81 vector 0 -1 0\n" +
      strprintf("variable p atom 9810*(1-y)*(1+%g)\n", gradient) +
      "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 1e-2 yhi pressure 0 initial v_p ";
}
double mean_velocity(Scene &run, int d)
{
  double sum = 0.0;
  for (int i = 0; i < run.n(); i++) sum += run.v()[i][d] / run.n();
  return sum;
}

// friction of walls is that of grains: a saturated column slides as one of its submerged weight
SERIAL_TEST(Walls, FrictionIsThatOfGrains)
{
  const double slower = 0.3 * 9.81 * 990.0 / 1990.0;
  for (const auto &[wall, offset] : first_of(4,
                                             {std::pair{"ylo slip friction 0.3", 0.0},
                                              {"ylo separate friction 0.3", 0.4},
                                              {"region ground separate friction 0.3", 0.3},
                                              {"region ground slip friction 0.3", 0.2},
                                              {"ylo slip friction 0.3", 0.3},
                                              {"ylo separate friction 0.3", 0.0},
                                              {"region ground separate friction 0.3", 0.0}})) {
    const bool face = wall[0] == 'y';
    Scene run(above_floor(wall, 0.0, offset, "density 1990 linear 1e7 0.3",
                          face ? "0 0.4 0 1" : "0 0.4 -0.5 1") +
              "\n");
    run_until(run, 0.6);
    run.set_velocity([](const double *, double *v) {
      v[0] = 5.0;
    });
    run_until(run, 0.7);
    EXPECT_NEAR(measured(strprintf("%s, offset %g", wall, offset),
                         (5.0 - mean_velocity(run, 0)) / (0.1 * slower)),
                1.0, 0.01);
  }
}

// flow upward lifts a column from a wall that separates: critical gradient (G_s - 1)(1 - n) = 0.99
SERIAL_TEST(Walls, HeaveAtTheCriticalGradient)
{
  for (const double offset : {0.0, 0.3})
    for (const double i : {0.9, 0.96, 1.02, 1.05}) {
      if (offset > 0.0 && std::fabs(i - 0.99) > 0.05) continue;
      Scene run(above_floor("ylo separate", i, offset, "density 1990 linear 1e8 0.3", "0 0.4 0 1") +
                strprintf("ylo pressure %.17g\n", 9810 * (1.0 + i)));
      run_until(run, 0.4);
      double lowest = 1.0;
      for (int k = 0; k < run.n(); k++) lowest = std::min(lowest, run.x()[k][1] - 0.025);
      measured(strprintf("offset %g, gradient %g, gap", offset, i), lowest);
      if (i < 0.99)
        EXPECT_LT(lowest, 1e-4);
      else
        EXPECT_GT(lowest, 1e-3);
    }
}

// flow by a difference of pressures, and water at rest under its weight
SERIAL_TEST(Flow, Darcy)
{
  for (const double offset : {0.0, 0.25, 0.4}) {
    const auto scene = [&](const char *modulus, const char *bottom) {
      const auto water =
          strprintf("2.2e7 1000 1e4 soil m 0.4 constant 1e-3 initial v_p yhi pressure "
                    "0 ylo pressure %s",
                    bottom);
      return replaced(column(10, water, strprintf("density 2000 linear %s 0.0", modulus), 1.0,
                             offset, "ylo yhi"),
                      "fix water",
                      "fix g all gravity 10.0 vector 0 -1 0\nvariable p atom 1e4*(1-y)\n"
                      "variable bottom equal 15000\nfix water");
    };
    Scene still(scene("1e12", "10000") + "timestep 1e-9\nrun 1\n");
    const double *flows = still.fix_vector("water", 7);
    EXPECT_LT(measured("still", std::max(std::fabs(flows[2]), std::fabs(flows[3])) / (0.4 * 1e-3)),
              1e-11);
    Scene flow(scene("1e8", "v_bottom") + "timestep 1.5e-4\nrun 5000\n");
    flows = flow.fix_vector("water", 7);
    EXPECT_NEAR(measured("in", flows[2] / (0.4 * 0.5e-3)), 1.0, 4e-4);
    EXPECT_NEAR(measured("out", flows[3] / (0.4 * 0.5e-3)), -1.0, 4e-4);
  }
}

// the time step is that of the wave in soil and water
SERIAL_TEST(TimeStep, IsUndrained)
{
  Scene run(column(10, "2.2e9 1000 9810 soil m 0.4 constant 1e-9", SOIL) + "run 0\n");
  EXPECT_NEAR(run.stable_dt() / (0.1 / std::sqrt((MODULUS + 2.2e9 / 0.4) / 2002.0)), 1.0, 1e-12);
  Scene biot(column(10, "2.2e9 1000 9810 soil m 0.4 constant 1e-9 biot 0.8 3e10", SOIL) +
             "run 0\n");
  const double storage = 0.4 / 2.2e9 + 0.4 / 3e10;
  EXPECT_NEAR(biot.stable_dt() / (0.1 / std::sqrt((MODULUS + 0.64 / storage) / 2002.0)), 1.0,
              1e-12);
}

// Pressure puts water into the pores, which have taken all of the change of volume, and makes room
// as grains become smaller. Many points at once have it per initial volume
SERIAL_TEST(Storage, OfDeformedSoil)
{
  MPMPoreWater water;
  water.bulk = 2.0e9;
  MPMPoreSoil soil;
  soil.porosity = 0.4;
  soil.biot = 0.8;
  soil.grains = 3.0e10;
  const double J[] = {0.7, 1.0, 1.25};
  double storage[3];
  soil.storage_at(3, J, water, storage);
  for (int p = 0; p < 3; p++) {
    const double pores = J[p] - 0.6;
    const double exact = pores / 2.0e9 + (0.8 * J[p] - pores) / 3.0e10;
    EXPECT_NEAR(storage[p] / exact, 1.0, 1e-12);
    EXPECT_NEAR(J[p] * soil.storage_at(J[p], water) / exact, 1.0, 1e-12);
  }
}

// units in which mass, energy, pressure do not fit together: period of a wave, water at rest
SERIAL_TEST(Units, Metal)
{
  const double mvv2e = 1.0364269e-4, nktv2p = 1.6021765e6, h = 5.0;
  const auto scene = [&](const std::string &more, const char *top) {
    return plane("metal", "p f", "0 20 0 100 -2.5 2.5", 1, 1.5) +
        "region soil block 0 20 0 100 INF INF\ncreate_points 1 region soil spacing 2.5\n"
        "fix grid all mpm 5.0\nfix m all mpm/material density 1.0 linear 1e5 0.0\n"
        "fix floor all mpm/boundary ylo yhi slip\n" +
        more + "fix water all mpm/pore 2e5 0.5 1.0 soil m 0.4 constant 1e-9 " + top;
  };
  const double c = std::sqrt((1e5 + 5e5) / (mvv2e * nktv2p));
  Scene run(scene("", "") + "\n");
  run.set_velocity([](const double *x, double *v) {
    v[1] = 1e-3 * std::sin(PI * x[1] / 100.0);
  });
  run.commands(strprintf("timestep %.17g\nrun 100\n", 100.0 / c / 100));
  EXPECT_NEAR(run.stable_dt() / (h / c), 1.0, 5e-5);
  double mine = 0.0, norm = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double w = std::sin(PI * run.x()[i][1] / 100.0);
    mine += w * run.v()[i][1];
    norm += w * w;
  }
  EXPECT_NEAR(measured("half a period later", 1e3 * mine / norm), -1.0, 0.004);
  const double gradient = 0.5 * 2.0 * nktv2p;
  Scene still(scene(
      strprintf("fix g all gravity 2.0 vector 0 -1 0\nvariable p atom %.17g*(100-y)\n", gradient),
      "initial v_p yhi pressure 0\ntimestep 1e-9\nrun 1\n"));
  EXPECT_NEAR(measured("still", still.fix_vector("water", 7)[3] / (20.0 * 5.0 * 1e-9 * gradient)),
              0.0, 1e-11);
}

// with a density that is the same mass times velocity squared per volume, all numbers are those of
// other units: of a wave, and of pressures that alternate from point to point, which relax
SERIAL_TEST(Units, NumbersAreThoseOfOtherUnits)
{
  std::vector<double> of[2];
  for (const bool metal : {false, true}) {
    const double unit = metal ? 1.0364269e-4 * 1.6021765e6 : 1.0;
    Scene run(plane(metal ? "metal" : "si", "p f", "0 20 0 100 -2.5 2.5", 1, 1.5) +
              "create_points 1 box spacing 2.5\nfix grid all mpm 5.0\n" +
              strprintf("fix m all mpm/material density %.17g linear 1e5 0.2\n", 2.0 / unit) +
              "fix floor all mpm/boundary ylo yhi slip\nvariable p atom 100*sin(2*PI*y/5)\n" +
              strprintf("fix water all mpm/pore 2e5 %.17g 1.0 soil m 0.4 constant 1e-3 every 1 "
                        "initial v_p\ntimestep 2e-3\n",
                        1.0 / unit));
    run.set_velocity([](const double *x, double *v) {
      v[1] = 1e-3 * std::sin(PI * x[1] / 100.0);
    });
    Water water(run);
    run.commands("run 12\n");
    of[metal].assign(water.pressures(), water.pressures() + run.n());
  }
  double size = 0.0, most = 0.0;
  for (std::size_t i = 0; i < of[0].size(); i++) {
    grow(size, of[0][i]);
    grow(most, of[1][i] - of[0][i]);
  }
  EXPECT_NEAR(measured("what remains of 100", size), 50.0, 30.0);
  EXPECT_LT(measured("difference", most / size), 1e-11);
}

// friction by effective stress in these units and in 3d, with a floor in a plane of nodes or not
SERIAL_TEST(Units, FrictionInMetal)
{
  for (const double origin : {0.0, 1.5}) {
    Scene run(space("metal", "p f p", "0 20 0 100 0 15", 1, 1.5) +
              "create_points 1 box spacing 2.5\n" +
              strprintf("fix grid all mpm 5.0 origin 0 %g 0\n", origin) +
              "fix m all mpm/material density 1.0 linear 2e7 0.0\n"
              "fix floor all mpm/boundary ylo separate friction 0.3\n"
              "fix g all gravity 0.002 vector 0 -1 0\n"
              "fix water all mpm/pore 2e5 0.5 1.0 soil m 0.4 constant 1e-9 yhi pressure 0 "
              "geostatic 0.5 100\nvelocity all set 5 0 0\n");
    run_until(run, 1.0);
    const double slower = 0.3 * 0.5 * 0.002 / 1.0364269e-4;
    EXPECT_NEAR(measured("deceleration", (5.0 - mean_velocity(run, 0)) / slower), 1.0, 0.002);
  }
}

// the same in three dimensions, where the surface is anywhere in a cell, with either shape
SERIAL_TEST(Consolidation, InThreeDimensions)
{
  LONG_CASE();
  for (const char *shape : {"quadratic", "cubic"})
    EXPECT_LT(terzaghi_in_space(shape, 0.4, 2.2e8, ""), 0.004);
}

// With other physics, which might look at the points before they move, the gradients of the motion
// are found apart from it: a fix mpm/heat without points that conduct makes no other difference
TEST(Motion, IsTheSameWithOtherPhysics)
{
  const auto scene = between_walls(blocks("free pressure 0 ylo flux 0.01 initial v_p")) + PORE;
  Scene first(scene),
      apart(scene +
            "group none empty\nfix unused none mpm/material density 1.0 neohookean 10.0 0.3 "
            "thermal conducting 1.0 300.0 0.5\nfix heat all mpm/heat\n");
  for (auto *run : {&first, &apart}) run->commands("run 100\n");
  EXPECT_LT(measured("water", water_difference(first, apart)), 1e-10);
  double most = 0.0;
  for (int i = 0; i < first.n(); i++)
    for (int d = 0; d < 2; d++) grow(most, first.x()[i][d] - apart.x()[i][d]);
  EXPECT_LT(measured("places", over_ranks(most)), 1e-12);
}

// where no point has water, mechanics are the same to the last bit
TEST(Idle, ChangesNothing)
{
  const std::string water = "20.0 0.5 2.0 soil unused 0.4 constant 0.01";
  const std::string idle = colliding(
      "group none empty\nfix unused none mpm/material density 1.0 neohookean 10.0 0.3\n", water);
  Scene with(idle + "run 60\n"),
      without(replaced(idle, "fix water all mpm/pore " + water + "\n", "") + "run 60\n");
  EXPECT_TRUE(identical(with.gather(), without.gather()));
}

TEST(Ranks, Agree)
{
  const auto scene = blocks("initial v_p xlo pressure 1.0 free pressure 0 ylo flux 0.01");
  for (const auto &one : {blocks("initial v_p"), between_walls(scene),
                          replaced(between_walls(scene), "yhi slip", "yhi separate friction 0.3")})
    expect_same_on_ranks(one, 1e-10);
}

TEST(Restart, Continues)
{
  expect_continues(blocks("free pressure 0 initial v_p"), OF_BLOCKS);
}

// a restart file from before the first run: points have not got yet what they have at first
TEST(Restart, BeforeTheFirstRun)
{
  for (const char *at_first : {"geostatic 0.5 1", "initial v_p"}) {
    const std::string water = std::string("2.2e8 1000 9810 soil m 0.4 constant 1e-3 ") + at_first;
    const std::string fixes =
        "neighbor 0.03 bin\nfix grid all mpm 0.1 origin 0 0.03\nfix m all mpm/material " +
        std::string(SOIL) +
        "\nfix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
        "variable p atom 9810*(1-y)\nfix water all mpm/pore " +
        water + "\n";
    const std::string scene = plane("si", "p f", "0 0.4 0 1.2", 1) +
        "region soil block 0 0.4 0 1 INF INF\ncreate_points 1 region soil spacing 0.05\n" + fixes;
    const std::string last = "timestep 1e-5\nrun 20\n";
    const ScratchFile file("restart");
    Scene whole(scene + "write_restart " + file.name + "\n" + last);
    Scene again("read_restart " + file.name + "\n" + fixes + last);
    EXPECT_TRUE(identical(whole.gather(), again.gather())) << at_first;
    double fastest = 0.0;
    for (int i = 0; i < again.n(); i++) grow(fastest, again.v()[i][1]);
    fastest = over_ranks(fastest, MPI_MAX);
    if (at_first[0] == 'g') EXPECT_LT(measured("at rest", fastest / (9.81 * 2e-4)), 1e-10);
  }
}

// the time step knows at once what flows through the surface and by a formula, also in later runs
TEST(TimeStep, KnowsTheFlowAtOnce)
{
  const auto scene = [](const std::string &law, const std::string &more, const char *fraction) {
    return plane("si", "p f", "0 0.4 0 1.2", 1, 0.03) +
        "region soil block 0 0.4 0 1 INF INF\ncreate_points 1 region soil spacing 0.05\n"
        "fix grid all mpm 0.1\nfix m all mpm/material density 2002 linear 1e7 0.3\n"
        "fix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
        "variable k atom 0.05\nfix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 " +
        law + " free pressure 0 " + more + "\nfix dt all mpm/dt " + fraction + "\n";
  };
  Scene one(scene("kozeny 0.05", "stages 1", "0.9") + "run 1\n");
  Scene formula(replaced(scene("formula v_k", "", "0.5"), "atom 0.05", "atom 50") + "run 1\n");
  for (const char *law : {"kozeny 0.05", "formula v_k"}) {
    const auto plain = scene(law, "stages 3", "0.5");
    Scene whole(plain + "run 60\n"), parts(plain + "run 40\nrun 20\n");
    EXPECT_TRUE(identical(whole.gather(), parts.gather())) << law;
    EXPECT_EQ(whole.lmp->update->dt, parts.lmp->update->dt);
    const auto fixes = "neighbor 0.03 bin\n" + plain.substr(plain.find("fix grid"));
    Continued run(plain, 40, fixes, 20);
    EXPECT_TRUE(identical(run.whole.gather(), run.again.gather())) << law;
    EXPECT_EQ(run.whole.lmp->update->dt, run.again.lmp->update->dt);
  }
  OnRanks ranks(scene("kozeny 0.05", "stages 3", "0.5"), "run 60\n");
  EXPECT_LT(ranks.difference(), 1e-11);
}

// a body without water has no part in it, and a point of the soil limits the time step
SERIAL_TEST(DryField, PaysNothing)
{
  Scene run(
      plane("si", "p f", "0 0.4 0 2", 2, 0.03) +
      "region soil block 0 0.4 0 1 INF INF\nregion dry block 0 0.4 1.2 1.6 INF INF\n"
      "create_points 2 region dry spacing 0.05\ncreate_points 1 region soil spacing 0.05\n"
      "group soil type 1\ngroup dry type 2\nfix one soil mpm 0.1\n"
      "fix two dry mpm 0.1 shape linear\nfix m soil mpm/material density 2002 linear 1e7 0.3\n"
      "fix n dry mpm/material density 2002 linear 1e7 0.3\nfix floor all mpm/boundary ylo slip\n"
      "fix water all mpm/pore 2.2e7 1000 9810 soil m 0.4 constant 0.01 free pressure 0 stages 1\n"
      "timestep 1e-5\nrun 1\n");
  const auto *const water = dynamic_cast<FixMPMPore *>(run.fix("water"));
  const auto all = MPMField::all(run.lmp);
  EXPECT_NE(water->pressure_in_forces(*all[0]), nullptr);
  EXPECT_EQ(water->pressure_in_forces(*all[1]), nullptr);
  tagint tag = 0;
  EXPECT_LT(water->stable_dt(*all[0], tag), 5e-5);
  const auto *const atom = run.lmp->atom;
  const auto *const found = std::find(atom->tag, atom->tag + atom->nlocal, tag);
  ASSERT_LT(found, atom->tag + atom->nlocal);
  EXPECT_EQ(atom->type[found - atom->tag], 1);
  EXPECT_GT(water->stable_dt(*all[1], tag), 1e300);
}

const char *const GEOSTATIC = "2.2e8 1000 9810 soil m 0.4 constant 1e-3 geostatic 0.5 1";
std::string ground(int n, const std::string &water, const std::string &material, double offset)
{
  return replaced(column(n, water, material, 1.2, offset), "fix water",
                  "fix g all gravity 9.81 vector 0 -1 0\nfix water");
}

// level ground of 20 cells is at rest wherever nodes are, with stresses of the weight above
SERIAL_TEST(Geostatic, StaysAtRest)
{
  const int n = 20;
  const double dt = 4e-5, cell = 2002 * 9.81 / n;
  for (const char *options : {"", "stress gradient ", "shape cubic "})
    for (const double offset : {0.0, 0.1, 0.3, 0.5}) {
      if (options[0] == 's' && options[1] == 'h' && offset > 0.0) continue;
      Scene run(
          replaced(ground(n, GEOSTATIC, SOIL, offset), "origin", std::string(options) + "origin") +
          "run 0\n");
      Water water(run);
      const double *const p = water.pressures();
      double most = 0.0, inside = 0.0;
      for (int i = 0; i < run.n(); i++) {
        const double z = 1.0 - run.x()[i][1];
        EXPECT_NEAR(p[i] / 9810.0, z, 1e-13);
        const auto sigma = run.cauchy(i);
        EXPECT_DOUBLE_EQ(sigma[0], 0.5 * sigma[1]);
        EXPECT_DOUBLE_EQ(sigma[2], sigma[0]);
        const double error = std::fabs(sigma[1] + 1002 * 9.81 * z) / cell;
        most = std::max(most, error);
        if (std::fabs(z - 0.5) < 0.35) inside = std::max(inside, error);
      }
      const auto name = strprintf("%s%g: ", options, offset);
      EXPECT_LT(measured(name + "stress at the ends", most), 0.3);
      EXPECT_LT(measured(name + "inside", inside), 0.02);
      run.commands(strprintf("timestep %g\nrun 1\n", dt));
      EXPECT_LT(measured(name + "force over weight", fall(run, dt)), 1e-10);
      run.commands("run 500\n");
      EXPECT_LT(measured(name + "velocity", fall(run, 501 * dt)), 1e-10);
    }
}

// laws for soils keep elastic strain: sand without cohesion, clay whose modulus follows pressure
SERIAL_TEST(Geostatic, Soils)
{
  for (const char *law : {"mohr/coulomb 1e7 0.3 35 0", "drucker/prager 1e7 0.3 35",
                          "camclay 5e6 0.888 0.161 0.062 0.92 1e5 1.5e5"}) {
    Scene run(ground(20, GEOSTATIC, std::string("density 2002 ") + law, 0.1) + "run 0\n");
    for (int i = 0; i < run.n(); i++) {
      const double z = 1.0 - run.x()[i][1];
      const auto sigma = run.cauchy(i);
      EXPECT_NEAR(sigma[0] / sigma[1], 0.5, 1e-12);
      if (std::fabs(z - 0.5) < 0.35) EXPECT_NEAR(sigma[1] / (-1002 * 9.81 * z), 1.0, 0.02);
    }
    run.commands("timestep 4e-5\nrun 1\n");
    EXPECT_LT(measured(strprintf("%s, force over weight", law), fall(run, 4e-5)), 1e-10);
    run.commands("run 500\n");
    EXPECT_LT(measured("velocity", fall(run, 501 * 4e-5)), 1e-10);
  }
  const auto loose =
      ground(20, GEOSTATIC, "density 2002 mohr/coulomb 1e7 0.3 15 0", 0.0) + "run 0\n";
  expect_error(loose, "K0 within its yield surface");
}

// two soils, soft grains, a table below the surface, weight to the other side, and 3d
SERIAL_TEST(Geostatic, LayersInThreeDimensions)
{
  Scene run(space("si", "p p f", "0 0.4 0 0.4 0 1.15", 2, 0.03) +
            "region low block INF INF INF INF 0.55 1.15\nregion high block INF INF INF INF 0.15 "
            "0.55\n"
            "create_points 1 region low spacing 0.05\ncreate_points 2 region high spacing 0.05\n"
            "group low type 1\ngroup high type 2\n"
            "fix grid all mpm 0.1 origin 0 0 0.03\n"
            "fix m low mpm/material density 2200 linear 1e7 0.3\n"
            "fix n high mpm/material density 1700 linear 1e6 0.2\n"
            "fix floor all mpm/boundary zhi slip\nfix g all gravity 9.81 vector 0 0 1\n"
            "fix water all mpm/pore 2.2e8 1000 9810 soil m 0.4 constant 1e-3 "
            "soil n 0.5 constant 1e-4 biot 0.8 1e10 geostatic 0.7 -0.3\nrun 0\n");
  Water water(run);
  const double *const p = water.pressures();
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double z = run.x()[i][2];
    EXPECT_NEAR(p[i], 9810.0 * (z - 0.3), 1e-9);
    if (z < 0.3 || z > 1.0 || std::fabs(z - 0.55) < 0.1) continue;
    const double total = 9.81 * (z < 0.55 ? 1700 * (z - 0.15) : 1700 * 0.4 + 2200 * (z - 0.55));
    const auto sigma = run.cauchy(i);
    grow(most, sigma[2] - (z < 0.55 ? 0.8 : 1.0) * p[i] + total);
    EXPECT_NEAR(sigma[0] / sigma[2], 0.7, 1e-13);
  }
  EXPECT_LT(measured("total stress over the weight of a cell", most / (2200 * 9.81 * 0.1)), 0.05);
  run.commands("timestep 4e-5\nrun 1\n");
  EXPECT_LT(measured("force over weight", fall(run, 4e-5)), 1e-10);
  run.commands("run 500\n");
  EXPECT_LT(measured("velocity", fall(run, 501 * 4e-5)), 1e-10);
}

TEST(Geostatic, RanksAndRestart)
{
  const std::string water = std::string(GEOSTATIC) + " free pressure 0";
  const std::string scene = ground(20, water, SOIL, 0.3) + "timestep 4e-5\n";
  OnRanks run(scene, "velocity all set 0 0.01 0\nrun 200\n");
  EXPECT_LT(run.difference(), 1e-11);
  const std::string fixes = "neighbor 0.015 bin\nfix grid all mpm 0.05 origin 0 0.015\n"
                            "fix m all mpm/material " +
      std::string(SOIL) +
      "\nfix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
      "fix water all mpm/pore " +
      water + "\ntimestep 4e-5\n";
  Continued again(scene + "velocity all set 0 0.01 0\n", 50, fixes, 50);
  EXPECT_TRUE(identical(again.whole.gather(), again.again.gather()));
}

SERIAL_TEST(Geostatic, BadInput)
{
  const auto plain = ground(10, GEOSTATIC, SOIL, 0.0);
  const auto refused = [&](const char *what, const std::string &with, const char *why) {
    expect_error(replaced(plain, what, with) + "timestep 1e-5\nrun 0\n", why);
  };
  refused("geostatic 0.5 1", "geostatic -0.5 1", "K0");
  refused("geostatic 0.5 1", "geostatic 0.5", "geostatic");
  refused("geostatic 0.5 1", "geostatic 0.5 1 initial 5.0", "leave out initial");
  refused("geostatic 0.5 1", "geostatic 0.5 1.05", "above the surface");
  refused("linear 1e7", "hencky 1e7", "does not keep the stress");
  refused("fix g all gravity 9.81 vector 0 -1 0", "", "needs a weight along an axis");
  refused("origin 0 0", "shape cubic origin 0 0.04", "in a plane of nodes");
  refused("vector 0 -1 0", "vector 0.1 -1 0", "needs a weight along an axis");
  refused("vector 0 -1 0", "vector 1 0 0", "use boundary f along gravity");
  refused("fix g all", "region cut block 0 0.2 0.7 1 INF INF\ndelete_atoms region cut\nfix g all",
          "needs level ground");
  refused("fix g all", "displace_atoms all move 0 0.15 0\nfix g all", "needs level ground");
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = plane("si", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0 MPM_OPTIONS\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 2000.0 linear 1e7 0.3\ntimestep 1e-4\n";
  const std::string plain = replaced(scene, "MPM_OPTIONS", "");
  const std::string water = "fix water all mpm/pore 2e7 1000 9810 ",
                    soil = "soil m 0.4 constant 1e-5 ";
  expect_refused(
      plain,
      {{"fix water all mpm/pore", "mpm/pore"},
       {"fix water all mpm/pore 2e7 1000", "mpm/pore"},
       {"fix water all mpm/pore -2e7 1000 9810 " + soil, "K"},
       {"fix water all mpm/pore 2e7 1000 0 " + soil, "G"},
       {water, "needs a soil"},
       {water + "soil m 1.4 constant 1e-5", "n0"},
       {water + "soil m 0.4 clay 1e-5", "must be one of constant kozeny squared formula"},
       {water + "soil m 0.4 constant -1e-5", "k"},
       {water + "soil m 0.4 formula k", "needs a variable"},
       {water + "soil m 0.4 formula v_none", "does not exist"},
       {water + "soil sand 0.4 constant 1e-5", "there is no fix mpm/material sand"},
       {water + soil + soil, "soil m twice"},
       {water + "biot 0.9 1e10 " + soil, "biot"},
       {water + soil + "biot 0.3 1e10", "below the porosity"},
       {water + soil + "xlo wet", "must be one of closed pressure head flux"},
       {water + soil + "zlo pressure 0", "zlo does not exist in 2d"},
       {water + soil + "free pressure 0 free rain 1e-6", "free is given twice"},
       {water + soil + "ylo pressure 0", "periodic axis: use boundary f"},
       {water + soil + "xlo head 1.0", "needs a fix gravity"},
       {water + soil + "xlo pressure v_none", "does not exist"},
       {water + soil + "initial v_none", "does not exist"},
       {"variable p atom sqrt(-1-x)\n" + water + soil + "initial v_p", "Sqrt of negative"},
       {"variable p atom exp(800)*exp(800+x)\n" + water + soil + "initial v_p", "at point"},
       {water + soil + "stages 0", "stages"},
       {water + soil + "bodies shut", "must be one of open closed"},
       {water + soil + "bodies closed", "needs a free surface that is open elsewhere"},
       {"group a type 1\nfix water a mpm/pore 2e7 1000 9810 " + soil, "use group all"},
       {water + soil + "\nfix more all mpm/pore 2e7 1000 9810 " + soil, "more than one"},
       {"group a type 1\nfix g a gravity 9.81 vector 0 -1 0\n" + water + soil, "of group all"}},
      "run 1\n");
  for (const auto &[options, remedy] :
       {std::pair{"shape linear", "use shape quadratic"}, std::pair{"frame total", "frame updated"},
        std::pair{"scheme musl", "use scheme usl"}, std::pair{"locking pressure", "locking none"}})
    expect_error(replaced(scene, "MPM_OPTIONS", options) + water + soil + "\nrun 1\n", remedy);
  expect_error(plain + water + "soil m 0.4 constant 10 stages 3\nrun 1\n", "fix mpm/pore water");
}

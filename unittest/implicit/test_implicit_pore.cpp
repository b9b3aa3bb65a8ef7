// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/implicit with fix mpm/pore: consolidation of soil and water in steps of any length.

#include "pore/pore_testing.h"

using namespace MPM_TEST;

/** Terzaghi's column of n cells, loaded at once by two rows of points around the surface. */
static std::string loaded(int n, double Kf, double k,
                          const std::string &options = "free pressure 0",
                          const std::string &solve = "static", double top = 1.2,
                          double offset = 0.0)
{
  return column(n, strprintf("%.17g 1000 9810 soil m 0.4 constant %g ", Kf, k) + options, SOIL, top,
                offset) +
      strprintf("region top block INF INF %.17g INF INF INF\ngroup top region top\n"
                "region next block INF INF %.17g %.17g INF INF\ngroup next region next\n",
                1.0 - 0.5 / n, 1.0 - 1.0 / n, 1.0 - 0.5 / n) +
      strprintf("variable fy equal -%.17g*lx/count(top)\nfix load top addforce 0 $(1.5*v_fy) 0\n"
                "fix less next addforce 0 $(-0.5*v_fy) 0\n",
                LOAD) +
      "fix solve all mpm/implicit " + solve + "\n";
}
static double consolidation_rate(double Kf, double k)
{
  return k / 9810.0 / (1.0 / MODULUS + 0.4 / Kf);
}
static double settlement(Scene &run)
{
  double V = 0.0, L = run.lmp->domain->prd[0];
  for (int i = 0; i < run.n(); i++) V += run.lmp->atom->vfrac[i] * run.points().jacobian(i);
  return 1.0 - V / L;
}
/** Lines for steps of this length. */
static std::string steps(double dt, int n)
{
  return strprintf("timestep %.17g\nrun %d\n", dt, n);
}

// Terzaghi in 40 steps to each of the times of the table, 10 to 10^9 times as long as explicit
// ones: settlement and pressure at the base, with faces at nodes and off these
struct Column {
  double Kf, k;
  const char *options;
  double top, offset;
};
SERIAL_TEST(Terzaghi, Consolidates)
{
  for (const auto &at : {Column{2.2e8, 1e-3, "yhi pressure 0", 1.0, 0.0},
                         Column{2.2e9, 1e-9, "free pressure 0", 1.2, 0.3}}) {
    const double c = consolidation_rate(at.Kf, at.k), p0 = LOAD / (1.0 + MODULUS * 0.4 / at.Kf);
    Scene run(loaded(20, at.Kf, at.k, at.options, "static solver multigrid", at.top, at.offset));
    Water water(run);
    const double undrained = 1.0 - p0 / LOAD, end = LOAD / MODULUS;
    double T = 0.0;
    for (const auto &[next, n, U, base] :
         {std::array{0.05, 40.0, 0.252313, 0.996869}, std::array{0.2, 40.0, 0.504088, 0.772312},
          std::array{0.5, 40.0, 0.763950, 0.370777}, std::array{1.0, 40.0, 0.931260, 0.107977}}) {
      run.commands(steps((next - T) / n / c, (int) n));
      T = next;
      const double p = water.mean(0.0, 0.5 / 20) / p0, S = settlement(run) / end,
                   expected = undrained + (1.0 - undrained) * U;
      const auto name = strprintf("T %g: ", T);
      EXPECT_NEAR(measured(name + "settlement", S / expected), 1.0, 0.01);
      EXPECT_NEAR(measured(name + "pressure at the base", p), base, 0.01);
    }
    // what has come out is what the soil has settled, less what pressure has taken from the water
    const double out = -run.fix("water")->compute_scalar() / run.lmp->domain->prd[0],
                 taken = 0.4 / at.Kf * water.mean(0.0, 1.0);
    EXPECT_NEAR(measured("water that came out", (out + taken) / settlement(run)), 1.0, 1e-4);
  }
}

// first order in time
SERIAL_TEST(Terzaghi, FirstOrder)
{
  const double Kf = 2.2e8, k = 1e-3, c = consolidation_rate(Kf, k);
  double S[3];
  for (int i = 0; i < 3; i++) {
    const int n = 10 << i;
    Scene run(loaded(10, Kf, k, "free pressure 0", "static solver multigrid") +
              steps(0.2 / n / c, n));
    S[i] = settlement(run);
  }
  EXPECT_NEAR(measured("order", std::log2((S[1] - S[0]) / (S[2] - S[1]))), 1.0, 0.1);
}

// a load at once on water that cannot flow: all of it is in the pressure, which must not alternate,
// whatever the permeability and the water, also of water that is all but incompressible
SERIAL_TEST(Undrained, WithoutOscillation)
{
  const int n = 20;
  for (const double Kf : {2.2e8, 2.2e9, 2.2e13})
    for (const double k : {1e-5, 1e-8, 1e-12}) {
      Scene run(loaded(n, Kf, k) + steps(1e-3, 1));
      Water water(run);
      const double p0 = 1.0 / (1.0 + MODULUS * 0.4 / Kf), *const p = water.pressures();
      double sum = 0.0, square = 0.0, count = 0.0;
      for (int i = 0; i < run.n(); i++) {
        if (run.x()[i][1] > 1.0 - 3.0 / n) continue;
        const double d = p[i] / LOAD - p0;
        sum += d;
        square += d * d;
        count++;
      }
      const auto name = strprintf("Kf %g, k %g: ", Kf, k);
      EXPECT_NEAR(measured(name + "mean error", sum / count), 0.0, 0.003);
      const double mean = sum / count;
      EXPECT_LT(measured(name + "scatter", std::sqrt(square / count - mean * mean)), 0.01);
    }
}

// steps that are far longer than consolidation: the end at once, and nothing after that
SERIAL_TEST(Drained, AtOnce)
{
  Scene run(loaded(20, 2.2e9, 1e-3, "free pressure 0", "static solver multigrid") + steps(1e9, 8));
  EXPECT_LT(run.fix("solve")->compute_scalar(), 1e-8);
  Water water(run);
  const double *const p = water.pressures();
  for (int i = 0; i < run.n(); i++) EXPECT_NEAR(p[i] / LOAD, 0.0, 1e-10);
  // as without water, with the same form of the stress
  Scene dry(replaced(loaded(20, 2.2e9, 1e-3, "free pressure 0", "static solver multigrid"),
                     " origin ", " stress mls origin "));
  dry.commands("unfix water\ntimestep 1.0\nrun 1\n");
  EXPECT_NEAR(measured("settlement", settlement(run) / settlement(dry)), 1.0, 1e-6);
  EXPECT_NEAR(settlement(run) / (LOAD / MODULUS), 1.0, 0.002);
}

// steady flow through a column under its weight, in one step: flux and pressure
SERIAL_TEST(Drained, Seeps)
{
  for (const double i : {-0.5, 0.5}) {
    const std::string water =
        strprintf("2.2e9 1000 9810 soil m 0.4 constant 1e-6 ylo pressure %.17g yhi pressure 0",
                  9810 * (1.0 + i));
    Scene run(replaced(column(20, water, SOIL, 1.0), "fix water",
                       "fix g all gravity 9.81 vector 0 -1 0\nfix water") +
              "fix solve all mpm/implicit static\n" + steps(1e12, 2));
    Water pore(run);
    const double area = run.lmp->domain->prd[0], *const flows = run.fix_vector("water", 7);
    EXPECT_NEAR(measured("flux in", flows[2] / (area * 1e-6 * i)), 1.0, 1e-3);
    EXPECT_NEAR(measured("and out", flows[3] / flows[2]), -1.0, 1e-9);
    const double *const p = pore.pressures();
    for (int k = 0; k < run.n(); k++) {
      const double depth = 1.0 - run.x()[k][1];
      EXPECT_NEAR(p[k] / 9810.0, (1.0 + i) * depth, 1e-3);
    }
  }
}

// Soil through which water flows bears a load that comes later, whatever the unit of length: forces
// that are negligible next to those of the water are as small as these in any unit
SERIAL_TEST(Drained, BearsALoadInAnyUnitOfLength)
{
  constexpr double PRESSURE = 100.0;
  for (const double l : {1.0, 1e-6}) {
    Scene run(plane("si", "p f", strprintf("0 %.17g 0 %.17g", 0.4 * l, l), 1, 0.03 * l) +
              strprintf("create_points 1 box spacing %.17g\nfix grid all mpm %.17g\n", 0.05 * l,
                        0.1 * l) +
              "fix m all mpm/material " + SOIL + "\nfix floor all mpm/boundary ylo slip\n" +
              strprintf("fix water all mpm/pore 2.2e9 1000 9810 soil m 0.4 constant 1e-6 "
                        "ylo pressure %g yhi pressure 0\n",
                        PRESSURE) +
              "fix solve all mpm/implicit static\n" + steps(1e12 * l * l, 2));
    const auto strain = [&] {
      double sum = 0.0, n = 0.0;
      for (int i = 0; i < run.n(); i++) {
        if (run.x()[i][1] > 0.5 * l) continue;
        sum += run.points().F[i][4] - 1.0;
        n += 1.0;
      }
      return measured("strain", sum / n / (PRESSURE / MODULUS));
    };
    const double swollen = strain();    // by what the water does not bear in the lower half
    EXPECT_NEAR(swollen, 0.75, 1e-3);
    run.commands(strprintf("region top block INF INF %.17g INF INF INF\ngroup top region top\n"
                           "variable fy equal -%g*lx/count(top)\nfix load top addforce 0 v_fy 0\n",
                           0.95 * l, PRESSURE) +
                 steps(1e12 * l * l, 1));
    EXPECT_NEAR(strain() - swollen, -1.0, 1e-3);
  }
}

// Mandel's strip between smooth plates: these move as they do under a constant force (A. Cheng, E.
// Detournay, Int. J. Numer. Anal. Methods Geomech. 12 (1988) 551), and the pressure in the middle
// rises first; the force is that
SERIAL_TEST(Mandel, PressureRisesFirst)
{
  const double nu = 0.2, nu_u = 0.5, E = (1 + nu) * (1 - 2 * nu) / (1 - nu), G = E / (2 * (1 + nu)),
               F = 1e-3;
  const int n = 20;
  const double h = 1.0 / n, H = 3 * h;
  std::vector<double> roots;
  for (int m = 0; m < 200; m++) {
    double low = m * M_PI + 1e-9, high = m * M_PI + PI2 - 1e-12;
    if (m == 0) low = 0.1;
    for (int k = 0; k < 100; k++) {
      const double a = 0.5 * (low + high);
      (std::sin(a) - (1 - nu) / (nu_u - nu) * a * std::cos(a) < 0.0 ? low : high) = a;
    }
    roots.push_back(0.5 * (low + high));
  }
  const auto moved = [&](double T) {
    double sum = 0.0;
    for (const double a : roots)
      sum += std::sin(a) * std::cos(a) / (a - std::sin(a) * std::cos(a)) * std::exp(-a * a * T);
    return H * F / G * (-0.5 * (1 - nu) + (1 - nu_u) * sum);
  };
  Scene run(plane("lj", "f f", strprintf("0 1 0 %.17g", H), 1, 0.3 * h) +
            strprintf("fix grid all mpm %.17g\ncreate_points 1 box ppc 2\n", h) +
            strprintf("fix m all mpm/material density 1.0 linear %.17g %g\n", E, nu) +
            "fix sides all mpm/boundary xlo ylo slip\nvariable v equal 0\n"
            "fix plate all mpm/boundary yhi slip velocity 0 v_v 0\n"
            "fix water all mpm/pore 1e5 1e-9 1.0 soil m 0.5 constant 1.0 xhi pressure 0\n"
            "fix solve all mpm/implicit static solver multigrid\n");
  Water water(run);
  double T = 0.0, peak = 0.0, at_peak = 0.0;
  const auto step = [&](double dT) {
    run.commands(
        strprintf("variable v equal %.17g\n", (moved(T + dT) - (T > 0.0 ? moved(T) : 0.0)) / dT) +
        steps(dT, 1));
    T += dT;
    double sum = 0.0, points = 0.0;
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][0] < 0.5 * h) {
        sum += water.pressures()[i];
        points++;
      }
    const double p = sum / points / (0.5 * F);
    if (p > peak) {
      peak = p;
      at_peak = T;
    }
    return p;
  };
  for (const auto &[end, n, p] :
       {std::array{0.01, 10.0, 1.043761}, std::array{0.05, 16.0, 1.098883},
        std::array{0.1, 16.0, 1.095414}, std::array{0.2, 20.0, 0.968114},
        std::array{0.5, 40.0, 0.592785}}) {
    const double dT = (end - T) / n;
    double now = 0.0;
    for (int k = 0; k < n; k++) now = step(dT);
    measured(strprintf("T %g", T), now / p);
    if (T < 0.04) continue;
    EXPECT_NEAR(now / p, 1.0, 0.02);
    EXPECT_NEAR(measured("force on the plate", run.fix_vector("plate", 2)[1] / F), 1.0, 0.02);
  }
  EXPECT_NEAR(measured("peak", peak) / 1.106897, 1.0, 0.01);
  EXPECT_NEAR(measured("at", at_peak), 0.072, 0.01);
}

// Cryer's problem in the plane: a cylinder under pressure from all sides, drained at its curved
// surface, less the state in which all pressures are the same. Soil and water are at rest, without
// stress, when the pressure around them falls, and the water is all but incompressible. The numbers
// are by Laplace inversion, as those of the sphere in the benchmark
SERIAL_TEST(Cryer, PressureRisesFirst)
{
  const int n = 16;
  const double nu = 0.2, E = (1 + nu) * (1 - 2 * nu) / (1 - nu), h = 1.0 / n, L = 1.0 + 1.5 * h,
               P = 1e-3;
  Scene run(
      plane("lj", "f f", strprintf("0 %.17g 0 %.17g", L, L), 1, 0.3 * h) +
      "region ball cylinder z 0 0 1 INF INF\n" + strprintf("fix grid all mpm %.17g\n", h) +
      "create_points 1 region ball ppc 2 outside ignore\n" +
      strprintf("fix m all mpm/material density 1.0 linear %.17g %g\n", E, nu) +
      "fix sides all mpm/boundary xlo ylo slip\n" +
      strprintf("fix water all mpm/pore 1e5 1e-9 1.0 soil m 0.5 constant 1.0 free pressure %g\n",
                -P) +
      "fix solve all mpm/implicit static solver multigrid\n");
  Water water(run);
  double T = 0.0, peak = 0.0, iterations = 0.0, steps_taken = 0.0;
  for (const auto &[end, count, p] :
       {std::array{0.01, 10.0, 1.086305}, std::array{0.05, 16.0, 1.182255},
        std::array{0.1, 16.0, 1.107317}, std::array{0.2, 20.0, 0.776137}}) {
    const double dT = (end - T) / count;
    double now = 0.0;
    for (int k = 0; k < count; k++) {
      run.commands(steps(dT, 1));
      double sum = 0.0, points = 0.0;
      for (int i = 0; i < run.n(); i++) {
        if (run.x()[i][0] > 0.5 * h || run.x()[i][1] > 0.5 * h) continue;
        sum += water.pressures()[i];
        points++;
      }
      now = 1.0 + sum / points / P;
      peak = std::max(peak, now);
      iterations += run.fix_vector("solve", 2)[1];
      steps_taken++;
    }
    T = end;
    EXPECT_NEAR(measured(strprintf("T %g", T), now / p), 1.0, 0.02);
  }
  EXPECT_NEAR(measured("peak", peak / 1.184067), 1.0, 0.03);
  EXPECT_LT(measured("iterations in a step", iterations / steps_taken), 50.0);
}

/** Settlement at 0.05 of a column under half of its modulus, put on at once. how: steps. */
static double settlement_of_large_load(int n, const std::string &permeability,
                                       const std::string &how)
{
  const double q = 0.5, h = 1.0 / n;
  Scene run(
      column(n, "200 1e-9 1.0 soil m 0.5 " + permeability + " 1.0 free pressure 0",
             "density 1e-3 linear 1.0 0.0") +
      strprintf("region top block INF INF %.17g INF INF INF\ngroup top region top\n"
                "region next block INF INF %.17g %.17g INF INF\ngroup next region next\n",
                1.0 - 0.5 * h, 1.0 - h, 1.0 - 0.5 * h) +
      strprintf("variable f equal %.17g*lx/count(top)\nfix load top addforce 0 $(-1.5*v_f) 0\n"
                "fix less next addforce 0 $(0.5*v_f) 0\n",
                q) +
      "fix solve all mpm/implicit static solver multigrid\n");
  run.commands(how);
  return settlement(run);
}

// a load at once of as much as the shear modulus of the soil: with the pressure that it makes at
// first, and nothing else, soil would not stand still, and solutions for its motion alone have to
// do without. Short steps, in which water has no time to flow through a cell, show that. The
// settlement is that of finite volumes in test_pore_consolidation.cpp
SERIAL_TEST(LargeLoad, InShortSteps)
{
  double error[2];
  for (const int k : {0, 1}) {
    const int n = 10 << k;
    const double S =
        settlement_of_large_load(n, "squared", steps(2e-5, 2) + steps(0.04996 / 40, 40)) / 0.092878;
    error[k] = std::fabs(measured(strprintf("%d cells, settlement", n), S) - 1.0);
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_LT(error[1], 0.015);
}

// the same, with a permeability that falls to 1/10 within a cell of the surface: that of a step is
// that at its start, so that steps are short at first
SERIAL_TEST(LargeLoad, KozenyCarman)
{
  std::string how;
  double dt = 1e-5, t = 0.0;
  for (; dt < 1e-3; dt *= 2.0, t += 4 * 0.5 * dt) how += steps(dt, 4);
  how += steps((0.05 - t) / 36, 36);
  const double limits[] = {0.04, 0.02, 0.01};
  for (const int k : {0, 1, 2}) {
    const int n = 10 << k;
    const double S = settlement_of_large_load(n, "kozeny", how) / 0.061043;
    EXPECT_NEAR(measured(strprintf("%d cells, settlement", n), S), 1.0, limits[k]);
  }
}

// with inertia, which dies away
SERIAL_TEST(Euler, Consolidates)
{
  const double Kf = 2.2e8, k = 1e-3, c = consolidation_rate(Kf, k),
               p0 = LOAD / (1.0 + MODULUS * 0.4 / Kf);
  Scene run(loaded(10, Kf, k, "free pressure 0", "euler solver multigrid") +
            steps(0.2 / 60 / c, 60));
  const double undrained = 1.0 - p0 / LOAD;
  EXPECT_NEAR(measured("settlement", settlement(run) / (LOAD / MODULUS)) /
                  (undrained + (1.0 - undrained) * 0.504088),
              1.0, 0.01);
}

// a column in space, with the floor off the nodes
SERIAL_TEST(Space, Consolidates)
{
  const double Kf = 2.2e9, k = 1e-7, c = consolidation_rate(Kf, k);
  Scene run(space("si", "p p f", "0 0.2 0 0.2 0 1.25", 1, 0.03) +
            "region soil block 0 0.2 0 0.2 0 1\ncreate_points 1 region soil spacing 0.05\n"
            "fix grid all mpm 0.1 origin 0 0 0.03\n"
            "fix m all mpm/material density 2002 linear 1e7 0.3\n"
            "fix floor all mpm/boundary zlo slip\n"
            "fix water all mpm/pore 2.2e9 1000 9810 soil m 0.4 constant 1e-7 free pressure 0\n"
            "region top block INF INF INF INF 0.95 INF\ngroup top region top\n"
            "variable load equal -1e4*lx*ly/count(top)\nfix load top addforce 0 0 v_load\n"
            "fix solve all mpm/implicit static\n" +
            steps(0.2 / 25 / c, 25));
  Water water(run);
  const double rms =
      difference_from_terzaghi(run, water, LOAD / (1.0 + MODULUS * 0.4 / Kf), 0.2, 2);
  EXPECT_LT(measured("rms", rms / LOAD), 0.01);
}

// layers of ten times different permeability, one behind the other, and a head outside: steady
// flow, in which the gradients are those of the layers
SERIAL_TEST(Layers, Seep)
{
  const int n = 20;
  const double h = 1.0 / n, k1 = 1e-6, k2 = 1e-7;
  Scene run(plane("si", "p f", strprintf("0 %.17g 0 1", 4 * h), 2, 0.3 * h) +
            strprintf("fix grid all mpm %.17g\n", h) +
            "region low block INF INF 0 0.5 INF INF\nregion high block INF INF 0.5 1 INF INF\n" +
            strprintf("create_points 1 region low spacing %.17g\n", 0.5 * h) +
            strprintf("create_points 2 region high spacing %.17g\n", 0.5 * h) +
            "group low type 1\ngroup high type 2\n"
            "fix m low mpm/material density 2000 linear 1e7 0.3\n"
            "fix o high mpm/material density 2000 linear 3e6 0.2\n"
            "fix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n" +
            strprintf("fix water all mpm/pore 2.2e9 1000 9810 soil m 0.4 constant %g soil o 0.5 "
                      "kozeny %g ylo head 1.5 yhi head 1.0\n",
                      k1, k2) +
            "fix solve all mpm/implicit static\n" + steps(1e11, 3));
  const double flux = 0.5 / (0.5 / k1 + 0.5 / k2), *const flows = run.fix_vector("water", 7);
  EXPECT_NEAR(measured("flux", flows[2] / (4 * h * flux)), 1.0, 6e-5);
  EXPECT_NEAR(flows[3] / flows[2], -1.0, 1e-10);
}

/** A block of two soils, pressed in a part of its surface, with water from below to the top. */
static std::string pressed(const std::string &solve)
{
  return plane("si", "f f", "0 2 0 1.2", 2, 0.02) + "fix grid all mpm 0.1 origin 0 0.02\n" +
      bodies({{"low", "block 0 2 0 0.45 INF INF"}, {"high", "block 0 2 0.5 1 INF INF"}}) +
      "fix m low mpm/material density 2000 linear 1e7 0.3\n"
      "fix o high mpm/material density 1900 mohr/coulomb 5e6 0.3 25 5e3\n"
      "fix walls all mpm/boundary xlo xhi ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
      "fix water all mpm/pore 2.2e9 1000 9810 soil m 0.4 kozeny 1e-7 soil o 0.5 constant 1e-8 "
      "biot 0.9 1e10 free head 1.0 ylo flux 1e-10\n"
      "region foot block 0.5 1.0 0.94 INF INF INF\ngroup foot region foot\n"
      "fix load foot addforce 0 -100 0\n"
      "fix solve all mpm/implicit " +
      solve + "\ntimestep 2000\n";
}

// the mass of points changes by what comes through the surface, however accurate the solution is
SERIAL_TEST(Water, IsKept)
{
  for (const char *solve : {"static", "euler tolerance 1e-4"}) {
    Scene run(pressed(solve));
    Water water(run);
    const double before = water.mass();
    run.commands("run 5\n");
    const double came = run.fix("water")->compute_scalar();
    EXPECT_LT(came, -1e-5);
    EXPECT_NEAR(measured("lost", (water.mass() - before - 1000.0 * came) / before), 0.0, 1e-13);
  }
}

// each point has the water that explicit steps of the same length give it: it had what nodes make
// of the change of volumes, up to .8 % of the mass after 24 steps of an impact
SERIAL_TEST(Water, OfEachPointIsThatOfExplicitSteps)
{
  const auto change = [](const std::string &solve) {
    Scene run(plane("lj", "f f", "0 8 0 8", 1, 0.5) +
              "region soil block 2 6 2 6 INF INF\nfix grid all mpm 1\n"
              "create_points 1 region soil ppc 2\nfix m all mpm/material density 1 linear 10 0.3\n"
              "fix water all mpm/pore 20 0.5 1.0 soil m 0.4 constant 0.01 every 1\n" +
              solve + "timestep 0.01\nrun 0\n");
    run.set_velocity([](const double *x, double *v) {
      v[0] = -0.02 * (x[0] - 4.0);
      v[1] = 0.01 * (x[1] - 4.0);
    });
    const auto start = run.gather();
    run.commands("run 20\n");
    const auto end = run.gather();
    std::vector<double> more;
    for (std::size_t k = 0; k < end.size(); k++) more.push_back(end[k].mass - start[k].mass);
    return more;
  };
  const auto exact = change(""),
             found = change("fix solve all mpm/implicit euler tolerance 1e-8\n");
  double most = 0.0, error = 0.0;
  for (std::size_t k = 0; k < exact.size(); k++) {
    grow(most, exact[k]);
    grow(error, exact[k] - found[k]);
  }
  EXPECT_GT(measured("largest change", most), 1e-6);
  EXPECT_LT(measured("error", error / most), 0.1);
}

TEST(Ranks, AgreeAndRestartContinues)
{
  const std::string scene = pressed("static tolerance 1e-11 solver multigrid");
  Twins runs(scene + PORE, 2, lines_again(scene) + PORE, 2, 1e-9);
  EXPECT_LT(water_difference(runs.serial, runs.whole), 1e-9 * 1e4);
  EXPECT_EQ(water_difference(runs.whole, runs.again), 0.0);
  const double came = runs.serial.fix("water")->compute_scalar();
  EXPECT_NEAR(runs.whole.fix("water")->compute_scalar() / came, 1.0, 1e-9);
  EXPECT_EQ(runs.whole.fix("water")->compute_scalar(), runs.again.fix("water")->compute_scalar());
}

SERIAL_TEST(BadInput, Refused)
{
  const auto scene = column(4, "2.2e9 1000 9810 soil m 0.4 constant 1e-5 OPTIONS", SOIL);
  for (const auto &[solve, options, words] :
       {std::array{"newmark", "", "use static or euler"},
        std::array{"midpoint", "", "use static or euler"},
        std::array{"static", "formulation u-v-p", "use formulation u-p"},
        std::array{"static", "relax 0.1", "of the waves of explicit steps"},
        std::array{"static", "stages 8", "implicit step has none"},
        std::array{"static", "forchheimer number 1e4", "use explicit steps"},
        std::array{"static", "retention gardner 1e-4", "use explicit steps"}})
    expect_error(replaced(scene, "OPTIONS", options) + "fix solve all mpm/implicit " + solve +
                     "\nrun 1\n",
                 words);
}

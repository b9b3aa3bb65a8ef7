// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/heat time euler and sdirk2: implicit steps of the conduction of heat.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

// The amplitude of a cosine is that of the scheme to the errors of the lattice, R(z)^n with
// z = -4 pi^2 dt, and comes to the exact one, 0.139
PARAMETER_TEST(Order, InTime, const char *, Values("euler", "sdirk2"))
{
  const std::string time = GetParam();
  const double end = 0.05, g = 1.0 - std::sqrt(0.5);
  double rms[3];
  for (int k = 0; k < 3; k++) {
    const int steps = 2 << k;
    const double z = -4.0 * PI * PI * end / steps,
                 R = time == "euler"
        ? 1.0 / (1.0 - z)
        : (1.0 + (1.0 - 2.0 * g) * z) / ((1.0 - g * z) * (1.0 - g * z));
    Scene run(bar(80, "time " + time));
    Warm warm(run);
    warm.set(cosine(1.0, 0.5));
    run_to(run, end, end / steps);
    rms[k] = measured(strprintf("%s, %d steps, rms", GetParam(), steps),
                      warm.rms(cosine(std::exp(-4.0 * PI * PI * end), 0.5)));
    EXPECT_LT(measured("from the scheme", warm.rms(cosine(std::pow(R, steps), 0.5))), 4.0e-4);
  }
  EXPECT_GT(measured("order", std::log2(rms[1] / rms[2])), time == "euler" ? 0.9 : 1.9);
}

// the end of a bar is heated suddenly: no scheme swings, second order needs few steps
SERIAL_TEST(Ends, HaveTheirTemperature)
{
  for (const double offset : {0.0, 0.25, 0.5}) {
    double rms[2];
    for (int k = 0; k < 2; k++)
      rms[k] = measured(
          strprintf("offset %g, %d cells, rms", offset, 20 << k),
          error_of_wall(bar(20 << k, "xlo temperature 1.0 xhi temperature 0.0 time sdirk2", offset),
                        0.1 / (10 << k)));
    EXPECT_LT(rms[1], 3.0e-4);
    EXPECT_LT(rms[1], 0.5 * rms[0]);
  }
}

// steps of any length: the steady state at once, with levels and GMRES where they are needed
SERIAL_TEST(Long, StepsAreSteady)
{
  for (const char *time : {"time euler", "time sdirk2"}) {
    Scene run(bar(40, std::string("xlo temperature 1.0 xhi convection 4.0 0.0 ") + time, 0.25,
                  "dtcheck no"));
    run.commands("timestep 1e6\nrun 3\n");
    const double flux = run.fix("heat")->compute_vector(0) / (4.0 / 40);
    EXPECT_NEAR(measured("flux", flux), 0.8, 1e-12);
    EXPECT_NEAR(run.fix("heat")->compute_vector(1) / (4.0 / 40), -flux, 1e-12);
  }
}

// free surfaces and regions, slowly and fast, where the surface is in a cell: M2 a
struct Slab {
  double Bi, t, face;
};
SERIAL_PARAMETER_TEST(ImplicitConvection, CoolsASlab, Slab,
                      Values(Slab{1.0, 0.5, 0.504522}, Slab{10.0, 0.1, 0.170574}))
{
  const Slab slab = GetParam();
  for (const char *where : {"surface", "region wall"})
    for (const double shift : {0.0, 0.5}) {
      const int n = 40;
      Scene run(
          bar_in_box(n, shift, strprintf("%s convection %g 0.0 time sdirk2", where, slab.Bi), 1.0));
      Warm warm(run);
      const double before = warm.heat();
      run_to(run, slab.t, slab.t / 20);
      EXPECT_NEAR(measured(where, warm.at_face(1.0, -1, 1.0 / n)) / slab.face, 1.0, 2e-4);
      EXPECT_NEAR((warm.heat() - before) / heat_in(run), 1.0, 1e-12);
    }
}

// a region with a temperature, in short and long steps: equations that are not symmetric
SERIAL_TEST(Temperature, OfARegion)
{
  for (const int steps : {10, 100, 1000}) {
    Scene run(
        bar_in_box(20, 0.25, "region wall temperature 1.0 xlo temperature 0.0 time sdirk2", 0.0));
    run_to(run, 0.1, 0.1 / steps);
    const double rms = Warm(run).rms([](const double *x) {
      return wall_heats(1.0 - x[0], 0.1);
    });
    EXPECT_LT(measured(strprintf("%d steps, rms", steps), rms), 2.0e-3);
  }
}

// two bars with a conductance between them; as with explicit steps
SERIAL_TEST(Contact, SteadyFlux)
{
  for (const char *H : {"2.0", "1e12"}) {
    const double h = 0.05;
    Scene run(
        plane("lj", "f p", strprintf("0 2 0 %g", 4 * h), 2, 0.1 * h) +
        "region a block 0 1 INF INF INF INF\nregion b block 1 2 INF INF INF INF\n"
        "create_points 1 region a spacing 0.025\ncreate_points 2 region b spacing 0.025\n"
        "group a type 1\ngroup b type 2\nfix ga a mpm 0.05 origin 0.9875 0 dtcheck no\n"
        "fix gb b mpm 0.05 origin 0.9875 0 dtcheck no\n" +
        conductor("1.0", 0.0, "ma a") + conductor("4.0", 0.0, "mb b") +
        "fix touch all mpm/contact ga gb\nfix heat all mpm/heat xlo temperature 1 xhi temperature "
        "0 time euler contact ga gb conductance " +
        H + "\ntimestep 1e4\nrun 3\n");
    const double exact = H[0] == '2' ? 0.571429 : 0.8;
    EXPECT_NEAR(measured("flux", run.fix("heat")->compute_vector(9) / (4 * h)), exact,
                5e-6 * exact);
  }
}

// a plate that radiates at both sides for 600 s, in 20 steps (see test_heat_surface)
SERIAL_TEST(Plate, Radiates)
{
  Scene run(plane("si", "f p", "-0.01 0.02 0 0.004", 1, 0.0001) +
            "region plate block 0 0.01 INF INF INF INF\n"
            "create_points 1 region plate spacing 0.0005\nfix grid all mpm 0.001 origin 0.0003 0 "
            "dtcheck no\n"
            "fix m all mpm/material density 2700 eos linear 1e-5 thermal conducting 900 1000 200\n"
            "fix heat all mpm/heat surface radiation 1.0 300 time sdirk2\ntimestep 30.0\n"
            "run 20\n");
  const double T = Warm(run).heat() / over_ranks(run.n() * run.mass()[0] * 900.0);
  EXPECT_NEAR(measured("T", T), 484.5102, 0.5);
}

// NAFEMS T2, the steady state, in steps of weeks; also where only Newton's method finds it
SERIAL_TEST(Radiation, SteadyState)
{
  for (const double k : {55.6, 0.556}) {
    double low = 300.0, high = 1000.0;    // k (1000 - T)/L = eps sigma (T^4 - 300^4)
    for (int i = 0; i < 100; i++) {
      const double T = 0.5 * (low + high),
                   more = k * (1000.0 - T) / 0.1 -
          0.98 * 5.670374419e-8 * (std::pow(T, 4) - std::pow(300.0, 4));
      (more > 0.0 ? low : high) = T;
    }
    if (k > 1.0) EXPECT_NEAR(low, 927.0040, 3e-4);
    const double h = 0.005;
    Scene run(plane("si", "f p", strprintf("0 0.1 0 %g", 4 * h), 1, 0.1 * h) +
              body("box",
                   strprintf("density 7850 eos linear 1e-16 thermal conducting 460 1000 %g", k),
                   strprintf("%g", h)) +
              "fix heat all mpm/heat xlo temperature 1000 xhi radiation 0.98 300 time euler\n"
              "timestep 1e7\nrun 4\n");
    EXPECT_NEAR(measured("face", Warm(run).at_face(0.1, -1, h)), low, 4e-5);
    const double *power = run.fix_vector("heat", 7);
    EXPECT_NEAR(power[0] / power[1], -1.0, 1e-10);
  }
}

// the same with Bernstein polynomials, at a free end and at a region, but next to a side of a cell
SERIAL_TEST(Radiation, SteadyStateOfBernstein)
{
  constexpr double h = 0.005, flux = 55.6 * (1000.0 - 927.0040) / 0.1;
  for (const char *kind : {"surface", "region wall"})
    for (const double shift : {0.0, 0.5, 1.0, 1.6}) {
      Scene run(plane("si", "f p", "0 0.15 0 0.02", 1, 0.1 * h) +
                "region bar block 0 0.1 INF INF INF INF\n"
                "region wall block 0.1 0.2 INF INF INF INF\n"
                "create_points 1 region bar spacing 0.0025\n" +
                strprintf("fix grid all mpm %g origin %.17g 0 shape bernstein frame total\n", h,
                          0.1 - shift * h) +
                "fix m all mpm/material density 7850 eos linear 1e-16 thermal conducting 460 1000 "
                "55.6\nfix heat all mpm/heat xlo temperature 1000 " +
                kind + " radiation 0.98 300 time euler\ntimestep 1e7\nrun 4\n");
      const double power = run.fix_vector("heat", 10)[9];
      EXPECT_NEAR(measured(strprintf("%s, %g", kind, shift), power / (-0.02 * flux)), 1.0, 0.0005);
    }
}

// heat is kept to round-off while bodies collide, however inexact solutions are
PARAMETER_TEST(ImplicitClosed, KeepsHeat, const char *,
               Values("time euler tolerance 1e-2", "time sdirk2 tolerance 1e-2",
                      "time sdirk2 transfer xpic 4"))
{
  Scene run(disk(GetParam()));
  expect_disk_keeps_heat(run, "run 100\n");
}

// Stefan's problem in steps of 100 explicit limits: the latent heat
SERIAL_TEST(Front, Moves)
{
  const int n = 50;
  Scene run(replaced(bar(n, "xlo temperature 1.0 time sdirk2"), "1.0 0 1.0", "1.0 0 1.0 melt 0 1"));
  run_to(run, 0.1, 100 * 0.3267 / (n * n));
  EXPECT_NEAR(measured("molten", Warm(run).melt()[0]), 0.392162, 3e-4);
}

// a body around a hot cylinder, and a ring around a hot ring, free outside: surfaces that lines of
// both axes cross share conditions; explicit steps are the reference
SERIAL_TEST(Hole, AsInExplicitSteps)
{
  for (const char *grid : {"shape gimp", "shape cubic axisymmetric yes"}) {
    const auto heat = [&](const std::string &time, int steps) {
      Scene run(plane("lj", "f f", "0 1.7 0 1.3", 1, 0.05) +
                "region hole cylinder z 0.6 0.7 0.3 INF INF\n"
                "region rest cylinder z 0.6 0.7 0.3 INF INF side out\n"
                "region block block 0.1 1.43 0.2 1.17 INF INF\nregion body intersect 2 block rest\n"
                "fix grid all mpm 0.08 origin 0.01 0.02 dtcheck no " +
                std::string(grid) +
                "\ncreate_points 1 region body ppc 2 outside ignore\n"
                "fix m all mpm/material density 1 eos linear 1e-9 thermal conducting 1 0 1\n"
                "fix axis all mpm/boundary xlo slip\n"
                "fix heat all mpm/heat surface convection 3 0.5 region hole temperature 1 " +
                time + strprintf("\ntimestep %.17g\nrun %d\n", 0.16 / steps, steps));
      return run.fix("heat")->compute_scalar();
    };
    const double exact = heat("stages 64", 80);
    EXPECT_NEAR(measured("short steps", heat("time sdirk2", 80) / exact), 1.0, 2e-3);
    EXPECT_NEAR(measured("long steps", heat("time sdirk2", 8) / exact), 1.0, 0.01);
  }
}

TEST(Ranks, Agree)
{
  const std::string walls =
      replaced(
          disk("xlo temperature 3.0 xhi convection 0.5 0.0 ylo flux 0.3 surface convection 0.2 "
               "0.0 time sdirk2 tolerance 1e-12"),
          "boundary p p p", "boundary f f p") +
      "fix b all mpm/boundary xlo xhi ylo yhi slip\n";
  for (const auto &scene : {disk("time euler tolerance 1e-12"), walls}) {
    OnRanks run(scene, "run 60\n");
    EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-11);
    EXPECT_NEAR(heat_in(run.serial), heat_in(run.parallel), 1e-10);
  }
}

PARAMETER_TEST(ImplicitRestart, Continues, const char *, Values("time euler", "time sdirk2"))
{
  expect_disk_continues(disk(std::string("surface convection 0.3 0.0 ") + GetParam()));
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene = plane("lj", "f p", "0 4 0 4", 1, 0.1) +
      "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n"
      "fix m all mpm/material density 1.0 eos linear 1.0 thermal conducting 1 0 1\n"
      "timestep 0.01\n";
  expect_refused(scene,
                 {{"fix heat all mpm/heat time implicit", "must be one of explicit euler sdirk2"},
                  {"fix heat all mpm/heat time euler stages 8", "stages is of explicit steps"},
                  {"fix heat all mpm/heat tolerance 1e-8", "tolerance is of implicit steps"},
                  {"fix heat all mpm/heat time euler tolerance 0", "tolerance"},
                  {"fix heat all mpm/heat time euler tolerance 2", "tolerance"},
                  {"fix heat all mpm/heat time", "time"}});
}

// sources in points are known before the step, and come with the rates of each stage
SERIAL_TEST(Source, GivesItsIntegral)
{
  for (const char *time : {"time euler", "time sdirk2"}) {
    Scene run(bar(20, std::string("source v_q ") + time, 0.25, "dtcheck no") +
              "variable q atom 1.0+x\n");
    Warm warm(run);
    const double before = warm.heat();
    run.commands("timestep 0.5\nrun 4\n");
    const double whole = 2.0 * 0.2 * 1.5;    // time, width, integral of 1 + x
    EXPECT_NEAR(measured("came over whole", heat_in(run) / whole), 1.0, 1e-12) << time;
    EXPECT_NEAR(measured("got over whole", (warm.heat() - before) / whole), 1.0, 1e-12) << time;
  }
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// Fix mpm/heat with all shape functions, in all frames, and around an axis of symmetry.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** The error of a bar that nothing heats, after it has decayed from 1 + cos(pi x). */
static double cosine_error(int n, const std::string &options, double offset = 0.0)
{
  return error_of_cosine(bar(n, "stages 64", offset, options), 0.3 / (n * n));
}

// order and conservation with all of them
PARAMETER_TEST(Functions, CosineDecays, const char *,
               Values("shape linear", "shape gimp", "shape cpgimp", "shape cpdi", "shape cpdi2",
                      "shape bernstein frame total transfer apic", "shape cubic", "frame total",
                      "frame total shape linear", "frame total shape cubic"))
{
  const std::string options = GetParam();
  double rms[2];
  for (int k = 0; k < 2; k++)
    rms[k] =
        measured(options + strprintf(", %d cells, rms", 10 << k), cosine_error(10 << k, options));
  EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 1.8) << options;
  EXPECT_LT(rms[1], 1.0e-3) << options;
}

// wherever the cells begin
SERIAL_TEST(Functions, AnywhereInACell)
{
  for (const char *options : {"shape linear", "shape gimp", "shape cpdi", "frame total"})
    for (const double offset : {0.15, 0.5})
      EXPECT_LT(measured(strprintf("%s, offset %g, rms", options, offset),
                         cosine_error(20, options, offset)),
                3.0e-3);
}

// points at nodes: linear functions give some nodes next to no capacity; it is stable, heat is kept
SERIAL_TEST(Functions, PointsAtNodes)
{
  for (const double offset : {0.25, 0.2500001})
    EXPECT_LT(measured("rms", cosine_error(20, "shape linear", offset)), 0.05);
}

// fix mpm/dt knows how fast they conduct before the first step, and when points change cells
SERIAL_PARAMETER_TEST(FunctionsOfLightNodes, HaveATimeStep, const char *,
                      Values("shape linear", "shape bernstein frame total transfer apic",
                             "shape linear axisymmetric yes"))
{
  const std::string options = GetParam();
  for (const double offset : {0.0, 0.013, 0.03, 0.05, 0.071})
    for (const int stages : {1, 32})
      for (const double v : {0.0, 0.3}) {
        Scene run(
            plane("lj", "f f", "0 1 0 20", 1, 0.05) +
            "region body block 0 1 0 1 -0.5 0.5\ncreate_points 1 region body spacing 0.05\n" +
            strprintf("fix grid all mpm 0.1 origin %g %g %s\n", offset, offset, options.c_str()) +
            conductor("1e-2", 1.0) + "fix side all mpm/boundary xlo slip\n" +
            strprintf("fix heat all mpm/heat xhi convection 100 0 ylo convection 100 0 stages %d\n"
                      "velocity all set 0 %g 0\nfix dt all mpm/dt 0.95\n",
                      stages, v));
        const double before = Warm(run).heat();
        EXPECT_EQ(run.error("run 12\n"), "") << options << " " << offset << " " << stages;
        const double after = Warm(run).heat();
        EXPECT_LT(after, before);
        EXPECT_GT(after, 0.0);
        EXPECT_GT(run.lmp->update->dt, v > 0.0 ? 1e-3 : 0.019);
      }
}

// steady heat through a bar between faces of the box, anywhere in a cell: sums over points balance
SERIAL_PARAMETER_TEST(EndsOfShapes, LetThroughAll, const char *,
                      Values("", "shape cubic", "shape gimp", "shape cpgimp", "shape cpdi",
                             "shape cpdi2", "frame total"))
{
  for (const double offset : {0.0, 0.1, 0.25, 0.5, 0.8}) {
    Scene run(bar(10, "xlo temperature 1.0 xhi temperature 0.0 stages 64", offset, GetParam()));
    run_to(run, 4.0, 0.02);
    const double *const power = run.fix_vector("heat", 7);
    EXPECT_NEAR(measured(strprintf("%s, offset %g", GetParam(), offset), power[0] / 0.4), 1.0,
                1e-12);
    EXPECT_NEAR(power[1] / power[0], -1.0, 1e-12);
  }
}

// faces of the box have their area with Bernstein polynomials, whose nodes are of two kinds
SERIAL_TEST(AreaOfFaces, OfBernstein)
{
  for (const int dim : {2, 3})
    for (const double offset : {0.0, 0.5, 1.0}) {
      const double h = 0.1;
      Scene run((dim == 2 ? plane("lj", "f p", "0 1 0 0.4", 1, 0.01)
                          : space("lj", "f p p", "0 1 0 0.4 0 0.6", 1, 0.01)) +
                strprintf("create_points 1 box spacing %g\n"
                          "fix grid all mpm %g origin %g 0 %s shape bernstein frame total\n",
                          0.5 * h, h, -offset * h, dim == 3 ? "0" : "") +
                conductor() +
                "fix heat all mpm/heat xlo flux 1.0 xhi flux 2.0\ntimestep 1e-4\nrun 1\n");
      const double *const power = run.fix_vector("heat", 7), area = dim == 2 ? 0.4 : 0.24;
      EXPECT_NEAR(measured(strprintf("%dd, %g", dim, offset), power[0] / area), 1.0, 1e-12);
      EXPECT_NEAR(power[1] / area, 2.0, 1e-11);
    }
}

// where points lie on sides of cells, at the ends of a body, too, nodes in the middle of cells have
// next to no capacity, or none: nothing flows there, and the temperatures stay in their range
SERIAL_TEST(Bernstein, PointsOnSidesOfCells)
{
  for (const int n : {20, 40})
    for (const double shift : {0.25, 0.75, 1.25, 1.75})
      EXPECT_LT(measured(strprintf("%d, %g", n, shift),
                         error_of_cosine(
                             bar_in_box(n, shift, "stages 64", 1.0, "shape bernstein frame total"),
                             0.3 / (n * n))),
                n == 20 ? 2e-3 : 5e-4);
}

// sides of cells divide the rooms of points, which are parts in both cells: a slab that is cooled
// at a face of the box loses its heat wherever they are
SERIAL_TEST(Bernstein, RoomsInTwoCells)
{
  for (const double shift : {0.25, 0.4, 0.6, 1.1})
    for (const char *time : {"stages 64", "time sdirk2"}) {
      constexpr int n = 20;
      Scene run(bar(n, std::string("xlo convection 10 0.0 ") + time, shift,
                    "shape bernstein frame total", 1.0));
      const double before = Warm(run).heat();
      run_to(run, 0.1, (*time == 't' ? 2.0 : 0.3) / (n * n));
      const double lost = 1.0 - Warm(run).heat() / before;
      EXPECT_NEAR(measured(strprintf("%g, %s", shift, time), lost / (1.0 - slab_mean(10.0, 0.1))),
                  1.0, 0.005);
    }
}

// One end is heated, the other one held
PARAMETER_TEST(EndsInSpace, HaveTheirTemperature, const char *,
               Values("shape linear", "shape gimp", "shape cpdi", "shape cubic", "frame total"))
{
  for (const double offset : {0.0, 0.5})
    EXPECT_LT(measured(strprintf("%s, offset %g, rms", GetParam(), offset),
                       error_of_wall(bar(40, "xlo temperature 1.0 xhi temperature 0.0 stages 64",
                                         offset, GetParam()),
                                     0.3 / (40 * 40))),
              8e-4);
}

// A bar that was stretched: the length is 1.5, and so is the diffusivity, as the density has fallen
PARAMETER_TEST(StretchedBar, CosineDecays, const char *,
               Values("frame updated", "frame total", "frame total shape linear",
                      "frame total reference update 1.2", "shape cpdi", "shape cpgimp"))
{
  const int n = 20;
  const double h = 1.0 / n;
  Scene run(plane("lj", "f p", strprintf("0 2 0 %.17g", 4 * h), 1, 0.1 * h) +
            "region body block 0 1 INF INF INF INF\n" +
            strprintf("create_points 1 region body spacing %.17g\n", 0.5 * h) +
            strprintf("fix grid all mpm %.17g %s\n", h, GetParam()) +
            "fix m all mpm/material density 1.0 eos linear 1e-8 thermal conducting 1.0 0.0 1.0\n"
            "velocity all ramp vx 0 0.5 x 0 1\ntimestep 0.01\nrun 100\n"
            "velocity all set 0 0 0\nfix heat all mpm/heat stages 64\n");
  Warm warm(run);
  const double L = 1.5;
  warm.set(cosine(1.0, L));
  const double before = warm.heat();
  run_to(run, 0.15, 0.3 * h * h);
  EXPECT_NEAR(warm.heat() / before, 1.0, 1e-13);
  EXPECT_LT(measured(GetParam(), warm.rms(cosine(std::exp(-PI * PI / L * 0.15), L))), 3.0e-3);
}

/** A disk or an annulus from r = low to high, with n cells in a unit, four of them high. */
static std::string ring(int n, double low, double high, const std::string &grid,
                        const std::string &heat)
{
  const double h = 1.0 / n;
  return plane("lj", "f p", strprintf("%g %g 0 %.17g", low, high, 4 * h), 1, 0.1 * h) +
      strprintf("fix grid all mpm %.17g origin %g 0 axisymmetric yes %s\n", h, low, grid.c_str()) +
      strprintf("create_points 1 box spacing %.17g\n", 0.5 * h) +
      "fix b all mpm/boundary xlo slip\n" + conductor() + "fix heat all mpm/heat stages 64 " +
      heat + "\n";
}

// T = 1 + J0(j r) exp(-j^2 t), J1(j) = 0
PARAMETER_TEST(AxisInSpace, BesselFunctionDecays, const char *,
               Values("", "shape cubic", "shape linear", "shape gimp", "frame total"))
{
  const double j = 3.83170597020751, t = 0.05;
  const auto wave = [=](double amplitude) {
    return [=](const double *x) {
      return 1.0 + amplitude * std::cyl_bessel_j(0.0, j * x[0]);
    };
  };
  double rms[2];
  for (int k = 0; k < 2; k++) {
    const int n = 10 << k;
    Scene run(ring(n, 0.0, 1.0, GetParam(), ""));
    Warm warm(run);
    warm.set(wave(1.0));
    const double before = warm.heat();
    run_to(run, t, 0.3 / (n * n));
    EXPECT_NEAR(warm.heat() / before, 1.0, 1e-13);
    rms[k] = measured(strprintf("%s, %d cells, rms", GetParam(), n),
                      warm.rms(wave(std::exp(-j * j * t))));
  }
  EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 1.7);
  EXPECT_LT(rms[1], 2.0e-3);
}

// heat through the wall of a tube: T = 1 - ln r/ln 2, power 2 pi H/ln 2
PARAMETER_TEST(AxisOfATube, HeatThroughItsWall, const char *,
               Values("", "shape linear", "frame total"))
{
  const int n = 20;
  Scene run(ring(n, 1.0, 2.0, GetParam(), "xlo temperature 1.0 xhi temperature 0.0"));
  Warm warm(run);
  run_to(run, 2.0, 2.0 / (n * n));
  const double rms = warm.rms([](const double *x) {
    return 1.0 - std::log(x[0]) / std::log(2.0);
  });
  EXPECT_LT(measured("rms", rms), 1.0e-3);
  const double *const power = run.fix_vector("heat", 7);
  const double exact = 2.0 * PI * (4.0 / n) / std::log(2.0);
  EXPECT_NEAR(measured("in", power[0]) / exact, 1.0, 4e-4);
  EXPECT_NEAR(power[1] / -exact, 1.0, 4e-4);
}

// power through the faces of a cylinder is the flux times their area
SERIAL_TEST(AxisOfACylinder, AreasOfFaces)
{
  for (const char *options : {"", "shape linear", "frame total"}) {
    const double h = 0.1;
    Scene run(plane("lj", "f f", "0 1 0 1", 1, 0.1 * h) +
              strprintf("fix grid all mpm %g axisymmetric yes %s\n", h, options) +
              strprintf("create_points 1 box spacing %g\n", 0.5 * h) +
              "fix b all mpm/boundary xlo slip\n" + conductor() +
              "fix heat all mpm/heat xhi flux 2.0 yhi flux 3.0 stages 64\ntimestep 0.001\nrun 1\n");
    const double *const power = run.fix_vector("heat", 7);
    EXPECT_NEAR(measured("xhi", power[1]) / (2.0 * 2.0 * PI), 1.0, 0.01) << options;
    EXPECT_NEAR(measured("yhi", power[3]) / (3.0 * PI), 1.0, 0.01) << options;
  }
}

// colliding bodies that cross all ranks and periodic faces
PARAMETER_TEST(Moving, KeepsHeatOnAnyRanks, const char *,
               Values("shape gimp", "shape cpdi", "shape cpdi2", "shape cubic transfer flip 0.99",
                      "shape linear", "frame total"))
{
  OnRanks run(disk("stages 64", "0.8 0.5 0", GetParam()), "run 60\n");
  EXPECT_LT(run.difference(), 1e-12);
  EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-12);
}

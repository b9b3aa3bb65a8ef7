// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Fix mpm/heat region and surface: heat through surfaces of regions, and free surfaces.

#include "heat/heat_testing.h"
#include "stl_testing.h"

using namespace MPM_TEST;

// a slab that is cooled by convection at its end, which is free, or touches a region: M2 a
struct Slab {
  double Bi, t, face;
};

/** Error of its temperature at that end, in steps of share/n^2; heat out is missing in points. */
static double error_of_slab(const Slab &slab, int n, double shift, const char *where,
                            const std::string &grid, double share)
{
  Scene run(
      bar_in_box(n, shift, strprintf("%s convection %g 0.0 stages 64", where, slab.Bi), 1.0, grid));
  Warm warm(run);
  const double before = warm.heat();
  run_to(run, slab.t, share / (n * n));
  EXPECT_NEAR((warm.heat() - before) / heat_in(run), 1.0, 1e-10);
  return std::fabs(measured(strprintf("%s, %g, %d %s", where, shift, n, grid.c_str()),
                            warm.at_face(1.0, -1, 1.0 / n) / slab.face) -
                   1.0);
}

SERIAL_PARAMETER_TEST(SurfaceConvection, CoolsASlab, Slab,
                      Values(Slab{1.0, 0.5, 0.504522}, Slab{10.0, 0.1, 0.170574}))
{
  const Slab slab = GetParam();
  for (const char *where : {"surface", "region wall"})
    for (const double shift : first_of(1, {0.25, 0.0, 0.5})) {
      double error[2];
      for (const int n : {20, 40}) error[n == 40] = error_of_slab(slab, n, shift, where, "", 0.3);
      EXPECT_LT(error[1], 0.01);
      EXPECT_LT(error[1], error[0] + 1e-4);
    }
}

// the same with all shape functions, and where nodes belong to the reference configuration. Points
// that lie on the sides of cells are too much for linear functions (shift 0.25)
SERIAL_PARAMETER_TEST(ConvectionWithShapes, CoolsASlab, const char *,
                      Values("frame total", "frame total shape cubic", "shape linear",
                             "frame total shape linear", "shape gimp", "shape cpgimp", "shape cpdi",
                             "shape cpdi2"))
{
  const std::string options = GetParam();
  const bool linear = options.find("linear") != std::string::npos;
  for (const Slab &slab : first_of(1, {Slab{10.0, 0.1, 0.170574}, Slab{1.0, 0.5, 0.504522}}))
    for (const char *where : {"surface", "region wall"})
      for (const double shift : first_of(2, {0.0, linear ? 0.4 : 0.25, 0.5}))
        EXPECT_LT(error_of_slab(slab, 40, shift, where, options, 1.0), 0.01);
}

/** The same bar on Bernstein polynomials, whose cells have two node spacings. */
static std::string bernstein_bar(int n, double shift, const std::string &heat, double side = 0.0)
{
  return replaced(bar_in_box(n, shift, heat, 1.0), " 0 \nfix m",
                  strprintf(" %.17g frame total shape bernstein\nfix m", side / n));
}

// Bernstein polynomials, also where sides of cells divide the volumes of points: of second order,
// and of first where the surface is next to a side and the cell beyond has no points
struct BernsteinSlab {
  double shift, error, least_order;
};
SERIAL_PARAMETER_TEST(ConvectionOfBernstein, CoolsASlab, BernsteinSlab,
                      Values(BernsteinSlab{0.0, 0.002, 1.4}, BernsteinSlab{0.5, 0.002, 1.4},
                             BernsteinSlab{0.75, 0.002, 1.4}, BernsteinSlab{1.0, 0.002, 1.4},
                             BernsteinSlab{1.6, 0.002, 1.4}, BernsteinSlab{1.75, 0.002, 1.4},
                             BernsteinSlab{0.1, 0.01, 0.9}, BernsteinSlab{0.25, 0.02, 0.9}))
{
  LONG_AFTER(1);
  const auto slab = GetParam();
  for (const char *kind : {"surface", "region wall"}) {
    double error[2];
    for (const int n : {20, 40}) {
      Scene run(
          bernstein_bar(n, slab.shift, strprintf("%s convection 10 0.0 stages 64", kind), 0.3));
      const double before = Warm(run).heat();
      run_to(run, 0.1, 0.3 / (n * n));
      const double lost = 1.0 - Warm(run).heat() / before;
      error[n == 40] = measured(strprintf("%s, %g, %d", kind, slab.shift, n),
                                std::fabs(lost / (1.0 - slab_mean(10.0, 0.1)) - 1.0));
      EXPECT_NEAR((Warm(run).heat() - before) / heat_in(run), 1.0, 1e-10);
    }
    EXPECT_LT(error[1], slab.error);
    EXPECT_GT(std::log2(error[0] / error[1]), slab.least_order);
  }
}

// a last cell with next to no capacity neither insulates nor takes heat: a wall of ten node
// spacings that ends a little beyond a side of cells: at most 0.37 are missing
SERIAL_TEST(WallOfBernstein, LightNodes)
{
  for (const double beyond : {0.0, 0.1, 0.25, 0.26, 0.28, 0.3, 0.32, 0.35, 0.38, 0.45}) {
    constexpr int n = 10;
    Scene run(
        bernstein_bar(n, beyond, "region wall temperature 0.0 xlo temperature 1.0 time sdirk2"));
    run_to(run, 2.0, 0.1);
    EXPECT_NEAR(measured(strprintf("%g", beyond), run.fix_vector("heat", 10)[9]) / -0.4, 1.0, 0.04);
  }
}

// a region or a face of the box need not be where the body ends, which can be in a cell with one
// layer of points: all heat gets out but what a gap before a face takes of the area, and but for a
// cell with next to no capacity (0.3)
SERIAL_TEST(WallOfBernstein, EndsNextToIt)
{
  constexpr int n = 20;
  constexpr double h = 1.0 / n, exact = 1.0 / 1.1;
  for (const bool face : {false, true})
    for (const double off : first_of(1, {-0.2, -0.1, 0.1, 0.2}))
      for (const double beyond : {0.3, 0.4, 0.5, 0.75, 1.5}) {
        const std::string end = strprintf("%.17g", 1.0 + off * h);
        std::string scene =
            replaced(bernstein_bar(n, beyond,
                                   std::string("xlo temperature 1.0 time sdirk2 ") +
                                       (face ? "xhi" : "region wall") + " convection 10 0.0"),
                     "block 1 2", "block " + end + " 2");
        if (face) scene = replaced(scene, "block 0 1.5", "block 0 " + end);
        Scene run(scene);
        run_to(run, 20.0, 1.0);
        const double power = run.fix_vector("heat", 10)[face ? 1 : 9];
        EXPECT_NEAR(measured(strprintf("%s, %g, %g", face ? "face" : "region", off, beyond),
                             power / (-4.0 * h * exact)),
                    1.0,
                    beyond < 0.35 ? 0.015
                        : face    ? 0.008
                                  : 0.003);
      }
}

// linear functions with points at nodes, by rounding on either side: nodes behind the surface have
// next to no capacity, but lose no heat, and the error is one of first order
SERIAL_TEST(ConvectionOfLinear, PointsAtNodes)
{
  for (const char *kind : {"surface", "region wall"})
    for (const double shift : first_of(1, {0.25 - 1e-7, 0.25, 0.25 + 1e-7, 0.26})) {
      constexpr int n = 40;
      Scene run(bar_in_box(n, shift, std::string(kind) + " convection 1 0.0 stages 64", 1.0,
                           "shape linear"));
      const double before = Warm(run).heat();
      run_to(run, 0.5, 1.0 / (n * n));
      const double mean =
          measured(strprintf("%s, %g, mean", kind, shift), Warm(run).heat() / before);
      EXPECT_NEAR(mean / slab_mean(1.0, 0.5), 1.0, 1.0 / n);
      EXPECT_NEAR((Warm(run).heat() - before) / heat_in(run), 1.0, 1e-10);
    }
}

// one end is heated by a region with a temperature, the other one held at a face of the box: A6 a
SERIAL_TEST(Temperature, OfARegion)
{
  for (const double shift : first_of(1, {0.25, 0.0, 0.5})) {
    double rms[2];
    for (const int n : {20, 40}) {
      Scene run(bar_in_box(n, shift, "region wall temperature 1.0 xlo temperature 0.0", 0.0));
      run_to(run, 0.1, 0.1 / (n * n));
      rms[n == 40] = measured(strprintf("%g, %d", shift, n), Warm(run).rms([](const double *x) {
        return wall_heats(1.0 - x[0], 0.1);
      }));
    }
    EXPECT_GT(measured("order", std::log2(rms[0] / rms[1])), 0.9);
    EXPECT_LT(rms[1], 3e-4);
  }
}

/** A disk or sphere of radius 1, with n cells in it. grid: options of fix mpm. */
static std::string round(int n, double offset, int dim, const std::string &heat, double T0,
                         const std::string &grid = "")
{
  const double h = 1.0 / n;
  return box(dim, "lj", "f f f", "-1.5 1.5 -1.5 1.5 -1.5 1.5", 1, 0.1 * h) +
      "region body sphere 0 0 0 1\nregion around sphere 0 0 0 1 side out\n" +
      strprintf("create_points 1 region body spacing %.17g\n", 0.5 * h) +
      strprintf("fix grid all mpm %.17g origin %.17g %.17g ", h, offset * h, 0.7 * offset * h) +
      (dim == 3 ? strprintf("%.17g ", 0.4 * offset * h) : "") + grid + "\n" + conductor("1.0", T0) +
      "fix heat all mpm/heat " + heat + strprintf("\ntimestep %.17g\n", 0.05 * h * h);
}

/** Power through the free surface of a body, or that of a region, after one step. */
static double power_of(const std::string &scene)
{
  Scene run(scene + "run 1\n");
  EXPECT_NEAR(Warm(run).heat() / heat_in(run), 1.0, 1e-10);
  return run.fix_vector("heat", 10)[9];
}

// surfaces have their area
SERIAL_TEST(Area, OfDisksAndSpheres)
{
  for (const int dim : {2, 3})
    for (const int n : {10, 20})
      for (const double offset : first_of(1, {0.25, 0.0, 0.5}))
        for (const char *kind : {"surface", "region around"})
          EXPECT_NEAR(
              measured(strprintf("%dd %s %d %g", dim, kind, n, offset),
                       power_of(round(n, offset, dim, std::string(kind) + " flux 1.0", 0.0)) /
                           (2.0 * (dim - 1) * PI)),
              1.0, n == 20 ? 0.01 : 0.02);
}

// Bernstein polynomials have nodes of two kinds, but the same surfaces
SERIAL_TEST(Area, OfBernstein)
{
  for (const auto &[dim, n] : {std::pair{2, 10}, {2, 20}, {3, 10}})
    for (const double offset : first_of(1, {0.25, 0.0, 0.5, 1.0}))
      for (const char *kind : {"surface", "region around"}) {
        const auto power = [&, dim = dim, n = n](const std::string &grid) {
          return power_of(round(n, offset, dim, std::string(kind) + " flux 1.0", 0.0, grid));
        };
        const double bernstein = power("shape bernstein frame total");
        EXPECT_NEAR(measured(strprintf("%dd %s %d %g", dim, kind, n, offset),
                             bernstein / (2.0 * (dim - 1) * PI)),
                    1.0, n == 20 ? 0.01 : 0.02);
        EXPECT_NEAR(bernstein / power("frame total"), 1.0, 0.003);
      }
}

// a mold of triangles around a ball warms it as one that is a sphere does; heat is in the points
SERIAL_TEST(Area, OfBodiesOfTriangles)
{
  const ScratchFile ball("ball.stl", ball_stl(40));
  for (const std::string kind : {"flux 1.0", "convection 1.0 1.0"})
    for (const char *shape : {"", "shape bernstein frame total"})
      for (const double offset : first_of(1, {0.25, 0.0}))
        EXPECT_NEAR(measured(kind + strprintf("%s, offset %g", shape, offset),
                             power_of(replaced(
                                 round(12, offset, 3, "region around " + kind, 0.0, shape),
                                 "region around sphere 0 0 0 1 side out",
                                 "region around mpm/mesh " + ball.name + " 1 0 0 0 side out")) /
                                 (4.0 * PI)),
                    1.0, 0.02);
}

/** Mean temperature of a cylinder that cools by convection, Bi = 1, at t = 0.5, by the series. */
static double mean_of_cylinder()
{
  // roots of b J1(b) = Bi J0(b) for Bi = 1
  double mean = 0.0;
  for (int k = 0; k < 6; k++) {
    const auto f = [](double b) {
      return b * std::cyl_bessel_j(1, b) - std::cyl_bessel_j(0, b);
    };
    double low = k * PI + 0.1, high = low;
    while (f(low) * f(high) > 0.0) high += 0.01;
    for (int i = 0; i < 60; i++) {
      const double middle = 0.5 * (low + high);
      (f(low) * f(middle) > 0.0 ? low : high) = middle;
    }
    mean += 4.0 / (low * low * (low * low + 1.0)) * std::exp(-low * low * 0.5);
  }
  return mean;
}

SERIAL_TEST(Cylinder, Cools)
{
  for (const std::string kind : {"surface", "region around"}) {
    constexpr int n = 16;
    Scene run(round(n, 0.3, 2, kind + " convection 1.0 0.0", 1.0));
    const double before = Warm(run).heat();
    run_to(run, 0.5, 0.2 / (n * n));
    EXPECT_NEAR(measured(kind, Warm(run).heat() / before) / mean_of_cylinder(), 1.0, 0.01);
  }
}

/** A body in the plane of an axis of symmetry, with n cells in a unit, whose material touches
 *  nothing but the axis; nodes at the axis, or offset node spacings beyond. */
static std::string around_axis(int n, double offset, const std::string &body,
                               const std::string &heat, double T0, const std::string &options,
                               const std::string &sides = "f f")
{
  const double h = 1.0 / n;
  return plane("lj", sides, strprintf("0 1.6 0 %g", sides == "f f" ? 3.2 : 4.0 * h), 1, 0.1 * h) +
      body +
      strprintf("fix grid all mpm %.17g origin %.17g 0 axisymmetric yes %s\n", h, -offset * h,
                options.c_str()) +
      strprintf("create_points 1 region body spacing %.17g\n", 0.5 * h) +
      "fix b all mpm/boundary xlo slip\n" + conductor("1.0", T0) +
      "fix heat all mpm/heat stages 64 " + heat + strprintf("\ntimestep %.17g\n", 0.05 * h * h);
}

static const char *const LONG_CYLINDER = "region body block 0 1 INF INF INF INF\n"
                                         "region around block 1 2 INF INF INF INF\n";
static const char *const SPHERE =
    "region whole sphere 0 1.6 0 1\nregion half block 0 2 INF INF INF INF\n"
    "region body intersect 2 whole half\n"
    "region around sphere 0 1.6 0 1 side out\n";

// a long cylinder around an axis of symmetry cools as in the plane, and a sphere: mean temperatures
// at t = 0.5 and 0.1 with Bi = 1. Nodes are at the axis; points of the sphere stand like steps
SERIAL_PARAMETER_TEST(SurfaceAxis, BodiesCool, const char *,
                      Values("", "shape bernstein frame total", "shape cubic", "shape linear",
                             "shape gimp", "frame total"))
{
  LONG_AFTER(2);
  double sphere = 0.0;
  for (int k = 0; k < 40; k++) {
    const double b = (k + 0.5) * PI;    // b cot(b) = 1 - Bi
    sphere += 6.0 / (b * b * b * b) * std::exp(-b * b * 0.1);
  }
  for (const char *kind : {"surface", "region around"}) {
    const std::string heat = std::string(kind) + " convection 1.0 0.0";
    constexpr int n = 16;
    Scene cylinder(around_axis(n, 0.0, LONG_CYLINDER, heat, 1.0, GetParam(), "f p"));
    const double before = Warm(cylinder).heat();
    EXPECT_NEAR(before / (PI * 4.0 / n), 1.0, 1e-10);
    run_to(cylinder, 0.5, 0.4 / (n * n));
    EXPECT_NEAR(measured(strprintf("cylinder, %s", kind), Warm(cylinder).heat() / before),
                mean_of_cylinder(), 0.01 * mean_of_cylinder());
    EXPECT_NEAR((Warm(cylinder).heat() - before) / heat_in(cylinder), 1.0, 1e-10);

    Scene ball(around_axis(n, 0.0, SPHERE, heat, 1.0, GetParam()));
    const double warm = Warm(ball).heat();
    run_to(ball, 0.1, 0.4 / (n * n));
    EXPECT_NEAR(measured("sphere", Warm(ball).heat() / warm) / sphere, 1.0, 0.01);
    EXPECT_NEAR((Warm(ball).heat() - warm) / heat_in(ball), 1.0, 1e-10);
  }
}

// surfaces around an axis have their area, also off the nodes: a sphere, a cylinder with its ends
SERIAL_PARAMETER_TEST(AxisOfBodies, AreaOfTheirSurfaces, const char *,
                      Values("", "shape cubic", "frame total", "shape bernstein frame total"))
{
  for (const double offset : first_of(1, {0.3, 0.0, 0.5}))
    for (const char *kind : {"surface", "region around"}) {
      const std::string heat = std::string(kind) + " flux 1.0";
      constexpr int n = 20;
      Scene ball(around_axis(n, offset, SPHERE, heat, 0.0, GetParam()) + "run 1\n");
      EXPECT_NEAR(measured(strprintf("%s, offset %g, sphere", kind, offset),
                           ball.fix_vector("heat", 10)[9]) /
                      (4.0 * PI),
                  1.0, 0.015);
      Scene cylinder(around_axis(n, offset,
                                 "region body block 0 1 0.6 2.6 INF INF\n"
                                 "region around block -2 1 0.6 2.6 INF INF side out\n",
                                 heat, 0.0, GetParam()) +
                     "run 1\n");
      // edges lose cells as in the plane: 0.5, and 1 in a container
      const double area = measured("cylinder", cylinder.fix_vector("heat", 10)[9]);
      const double lost = (kind[0] == 's' ? 0.5 : 1.0) / n;
      EXPECT_LT(area, 6.0 * PI * 1.005);
      EXPECT_GT(area, 6.0 * PI * 0.995 - 4.0 * PI * lost);
    }
}

/** A square of 1 x 1 with 10 cells along its sides in a box with room around it, conductivity 1e-2.
 *  Points do not relax, which smoothes edges by what depends on the time step. */
static std::string square(double offset, const std::string &heat, const std::string &grid = "")
{
  const std::string at = strprintf(" %g", offset);
  return plane("lj", "f f", "-0.5 1.5 -0.5 1.5", 1, 0.02) +
      "region body block 0 1 0 1 INF INF\nregion left block -1 0 -1 2 INF INF\n"
      "region low block -1 2 -1 0 INF INF\nregion right block 1 2 -1 2 INF INF\n"
      "region top block -1 2 1 2 INF INF\ncreate_points 1 region body spacing 0.05\n"
      "fix grid all mpm 0.1 dtcheck no origin" +
      at + at + " " + grid + "\n" + conductor("1e-2", 1.0) +
      "fix heat all mpm/heat stages 9 transfer relax 0 " + heat + "\n";
}

// surfaces with large coefficients and different temperatures that cross: the power at the end is
// the same with short steps, in which no rate is limited, and with long ones
SERIAL_PARAMETER_TEST(Edge, DoesNotDependOnTheTimeStep, const char *,
                      Values("region left convection 1e3 0.0 region low convection 1.0 1.0",
                             "region left temperature 0.0 region low convection 1e3 1.0",
                             "region left temperature 0.0 surface convection 1e3 1.0",
                             "region left convection 5.0 0.0 surface radiation 0.9 1e3"))
{
  LONG_CASE();
  std::string heat = GetParam();
  const bool radiates = heat.find("radiation") != std::string::npos;
  // long steps limit rates of a free surface at edges, too
  const double bound = heat.find("surface convection") != std::string::npos ? 0.016 : 0.005;
  if (heat.find("surface") == std::string::npos)
    heat += " region right convection 0.01 0.5 region top convection 0.01 0.5";
  for (const char *shape : {"", "shape bernstein frame total"})
    for (const double offset : first_of(1, {0.03, 0.0})) {
      std::vector<double> power[2];
      for (const bool is_long : {false, true}) {
        std::string scene = square(offset, heat, shape);
        if (*shape) scene = replaced(scene, "stages 9", "stages 40");
        if (radiates) scene = replaced(replaced(scene, "units lj", "units si"), " 1e-2", " 20.0");
        Scene run(scene);
        const double unit = radiates ? 20.0 / 1e-2 : 1.0;
        run_to(run, 200.0 / unit, (is_long ? 2.0 : 0.05) / unit);
        const double *const all = run.fix_vector("heat", 11);
        power[is_long] = {measured("power", all[9]), measured("power", all[10])};
      }
      for (int k = 0; k < 2; k++)
        EXPECT_NEAR(power[1][k] / power[0][k], 1.0, bound) << offset << shape;
    }
}

// the same, and faces of the box that cross regions
SERIAL_TEST(EdgeOfTheBox, DoesNotDependOnTheTimeStep)
{
  for (const char *face : {"xlo temperature 0.0", "xlo convection 1e3 0.0"}) {
    double power[2][2];
    for (const bool is_long : {false, true}) {
      Scene run(replaced(
          square(0.0, std::string(face) + " region low convection 1e3 1.0 region top flux -0.01"),
          "box block -0.5 1.5", "box block 0 1.5"));
      run_to(run, 300.0, is_long ? 2.0 : 0.4);
      const double *const all = run.fix_vector("heat", 11);
      power[is_long][0] = measured(face, all[0]);
      power[is_long][1] = measured("region", all[9]);
    }
    for (int k = 0; k < 2; k++) EXPECT_NEAR(power[1][k] / power[0][k], 1.0, 0.02) << face;
  }
}

// a thin plate that radiates from both sides, from 1000 K to 300 K: 484.5102 K after 600 s (M2 b)
SERIAL_TEST(Plate, Radiates)
{
  Scene run(plane("si", "f p", "-0.01 0.02 0 0.004", 1, 0.0001) +
            "region plate block 0 0.01 INF INF INF INF\n"
            "create_points 1 region plate spacing 0.0005\nfix grid all mpm 0.001 origin 0.0003 0\n"
            "fix m all mpm/material density 2700 eos linear 1e-5 thermal conducting 900 1000 200\n"
            "fix heat all mpm/heat surface radiation 1.0 300 stages 64\ntimestep 1.0\nrun 600\n");
  const double T = Warm(run).heat() / over_ranks(run.n() * run.mass()[0] * 900.0);
  EXPECT_NEAR(measured("T", T), 484.5102, 0.3);
}

// a region hides free surfaces, also if it is insulated
SERIAL_TEST(Surface, IsNotWhereARegionTouches)
{
  for (const char *heat : {"surface flux 1.0", "surface flux 1.0 region wall insulated"}) {
    Scene run(bar_in_box(10, 0.2, heat, 0.0) + "timestep 1e-3\nrun 1\n");
    const bool covered = std::strstr(heat, "insulated") != nullptr;
    EXPECT_NEAR(run.fix_vector("heat", 10)[9], covered ? 0.0 : 0.4, 1e-12);
    if (covered) EXPECT_EQ(run.fix_vector("heat", 11)[10], 0.0);
  }
}

// a turned plate of so many cells across: heat is missing if it is thin, and that is said once
PARAMETER_TEST(Thin, IsSaid, const char *,
               Values("surface", "region wall", "surface cubic", "region wall cubic",
                      "surface bernstein", "region wall bernstein"))
{
  std::string kind = GetParam();
  const bool cubic = kind.find("cubic") != std::string::npos;
  const bool bernstein = kind.find("bernstein") != std::string::npos;
  kind = replaced(replaced(kind, " cubic", ""), " bernstein", "");
  for (const double angle : {0.0, 30.0})
    for (const double offset : first_of(1, {0.25, 0.0, 0.6}))
      for (const double cells : {1.0, 2.0, 3.0, 4.0, 6.0}) {
        if (cubic && cells == 3.0) continue;
        const std::string scene = plane("lj", "f f", "-20 20 -20 20", 1, 0.4) +
            strprintf("region plate block 0 %g -12 12 INF INF\n", cells) +
            strprintf("variable a equal %.17g\n", angle * PI / 180.0) +
            "region wall block -6 0 -12 12 INF INF rotate v_a 0 0 0 0 0 1\n" +
            "create_points 1 region plate spacing 0.5\n" +
            strprintf("displace_atoms all rotate 0 0 0 0 0 1 %g\n", angle) +
            strprintf("fix grid all mpm 1.0 origin %g 0%s\n", offset,
                      cubic           ? " shape cubic"
                          : bernstein ? " shape bernstein frame total"
                                      : "") +
            conductor() + "fix heat all mpm/heat " + kind +
            " flux 1.0\ntimestep 0.01\nrun 60\nrun 60\n";
        const bool thin = cells < (cubic ? 3.5 : 2.5);
        EXPECT_EQ(said_thin(scene), thin) << angle << " " << offset << " " << cells;
      }
}

// a thin layer that does not conduct, at any place in a cell: what comes in is what points have
PARAMETER_TEST(Layer, LosesNoHeat, const char *,
               Values("xlo flux 1.0", "xlo temperature 1.0", "xlo convection 5.0 1.0",
                      "region wall flux 1.0", "region wall convection 1e9 1.0", "surface flux 1.0"))
{
  const std::string kind = GetParam();
  const bool of_box = kind[0] == 'x';
  for (const int k : first_of(3, {1, 7, 18, 2, 3, 4, 5, 6, 8, 9, 10}))
    for (const double thickness : {0.0, 0.12})
      for (const char *shape : {"", " shape bernstein frame total"}) {
        Scene run(plane("lj", "f p", of_box ? "0 4 0 2" : "-2 4 0 2", 1, 0.1) +
                  "region body block 0 4 INF INF INF INF\nregion wall block -2 0 INF INF INF INF\n"
                  "create_points 1 region body spacing 0.125\n" +
                  strprintf("region skin block -1 %g INF INF INF INF\n", thickness) +
                  "group skin region skin\ngroup rest subtract all skin\n" +
                  strprintf("fix grid all mpm 0.5 origin %g 0%s\n", -0.05 * k, shape) +
                  conductor("1.0", 0.0, "m rest") +
                  "fix n skin mpm/material density 1.0 eos linear 1e-6\n"
                  "fix heat all mpm/heat " +
                  kind + "\ntimestep 0.01\nrun 20\n");
        const double heat = Warm(run).heat(), in = heat_in(run);
        const std::string where = strprintf("%g %g%s", 0.05 * k, thickness, shape);
        if (thickness > 0.0) EXPECT_GT(measured(where, in), 0.2);
        if (thickness == 0.0 && kind.find("flux") != std::string::npos)
          EXPECT_NEAR(in, 0.4, 1e-12) << where;
        EXPECT_NEAR(heat / in, 1.0, 1e-12) << where;
      }
}

// corners, edges, faces of the box behind a layer, and small round bodies are not thin
TEST(Thin, IsNotSaidOfCorners)
{
  for (const int dim : {2, 3})
    for (const double offset : {0.0, 0.3})
      for (const char *kind : {"surface flux 1.0", "region around flux 1.0"})
        EXPECT_EQ(said_thin(round(3, offset, dim, kind, 0.0) + "run 2\n"), 0) << dim << kind;
  for (const int dim : {2, 3})
    for (const double angle : {0.0, 20.0, 45.0}) {
      const std::string scene = box(dim, "lj", "f f f", "-5 5 -5 5 -5 5", 1, 0.4) +
          "region cube block -2 2 -2 2 -2 2\ncreate_points 1 region cube spacing 0.5\n" +
          strprintf("displace_atoms all rotate 0 0 0 %s %g\n", dim == 2 ? "0 0 1" : "1 1 0.3",
                    angle) +
          "fix grid all mpm 1.0 origin 0.2 0.1" + (dim == 2 ? "\n" : " 0\n") + conductor() +
          "fix heat all mpm/heat surface flux 1.0\ntimestep 0.01\nrun 2\n";
      EXPECT_EQ(said_thin(scene), 0) << dim << " " << angle;
    }
  for (const char *shape : {"", "shape linear"})
    for (const double cells : {1.0, 2.0}) {
      const std::string layer = plane("lj", "f p", "0 12 0 8", 1, 0.4) +
          strprintf("region low block 0 %g INF INF INF INF\n", cells) +
          "create_points 1 region low spacing 0.5\nfix grid all mpm 1.0 " + shape + "\n" +
          conductor() + "fix heat all mpm/heat surface flux 1.0\ntimestep 0.01\nrun 2\n";
      EXPECT_EQ(said_thin(layer), 0) << shape << cells;
      Scene run(layer);
      if (cells == 2.0 || *shape)    // nothing is missing
        EXPECT_NEAR(run.fix_vector("heat", 10)[9], 8.0, 1e-11) << shape << cells;
    }
}

/** A scene of round() with a warm region in it, in motion. */
static std::string moving_disk(const std::string &heat, const std::string &grid = "")
{
  return replaced(round(6, 0.2, 2, heat, 1.0, grid), "region around",
                  "region hot sphere 0 1.6 0 0.63\nregion around") +
      "velocity all set 0.2 0.3 0\n";
}
static void expect_same_heat_on_ranks(const std::string &scene)
{
  OnRanks run(scene, "run 40\n");
  EXPECT_LT(run.difference(), 1e-12);
  EXPECT_GT(std::fabs(heat_in(run.serial)), 1e-3);
  EXPECT_NEAR(heat_in(run.parallel) / heat_in(run.serial), 1.0, 1e-11);
}
static const char *const COOLS = "surface convection 2.0 0.3 region hot temperature 3.0";

TEST(Ranks, Agree)
{
  expect_same_heat_on_ranks(moving_disk(COOLS));
}

PARAMETER_TEST(RanksWithShapes, Agree, const char *,
               Values("", "shape linear", "shape gimp", "shape cpdi", "frame total",
                      "shape bernstein frame total"))
{
  expect_same_heat_on_ranks(moving_disk(std::string(COOLS) + " stages 64", GetParam()));
}

TEST(Ranks, AgreeAroundAnAxis)
{
  const std::string hot = "region hot sphere 0 2.9 0 0.4\n";
  for (const char *options : {"", "shape linear", "frame total"}) {
    OnRanks run(around_axis(8, 0.0, SPHERE + hot, COOLS, 1.0, options) +
                    "velocity all set 0 0.3 0\n",
                "run 20\n");
    EXPECT_LT(run.difference(), 1e-12);
    EXPECT_GT(std::fabs(heat_in(run.serial)), 1e-3);
    EXPECT_NEAR(heat_in(run.parallel) / heat_in(run.serial), 1.0, 1e-11);
  }
}

/** Two blocks of 4 x 4 that touch, with a free perimeter of 24. */
static std::string two_blocks(const std::string &heat, const std::string &grid = "")
{
  return plane("lj", "f f", "-1 9 -1 9", 2, 0.1) +
      "region a block 0 4 0 4 INF INF\nregion b block 4 8 0 4 INF INF\n"
      "create_points 1 region a spacing 0.125\ncreate_points 2 region b spacing 0.125\n"
      "group a type 1\ngroup b type 2\nfix ga a mpm 0.25 " +
      grid + "\nfix gb b mpm 0.25 " + grid + "\n" + conductor("1.0", 0.0, "ma a") +
      conductor("1.0", 0.0, "mb b") + "fix heat all mpm/heat " + heat + "\ntimestep 0.001\n";
}

// bodies hide the surfaces where they touch if they have a contact, and only then
PARAMETER_TEST(TwoBlocks, HideWhereTheyTouch, const char *,
               Values("", "shape cubic", "origin 0.1 0.05"))
{
  for (const bool contact : {true, false}) {
    Scene run(two_blocks("surface flux 1.0", GetParam()) +
              (contact ? "fix touch all mpm/contact ga gb\n" : "") + "run 1\n");
    // edges lose up to 0.5 cells each
    const double perimeter = contact ? 24.0 : 32.0, edges = (contact ? 4.0 : 8.0) * 0.5 * 0.25;
    const double power = measured("power", run.fix_vector("heat", 10)[9]);
    EXPECT_LT(power, perimeter + 0.01);
    EXPECT_GT(power, perimeter - edges);
    if (contact) continue;
    Scene alone(two_blocks("surface flux 1.0", GetParam()) +
                "delete_atoms group b\nunfix gb\nunfix mb\nrun 1\n");
    EXPECT_NEAR(power / (2.0 * alone.fix_vector("heat", 10)[9]), 1.0, 1e-10);
  }
}

// on ranks of which some know only one of the bodies
TEST(Ranks, AgreeOnBodiesThatTouch)
{
  for (const char *layout : {"", "processors * 1 1\n", "processors 1 * 1\n"})
    for (const char *contact : {"fix touch all mpm/contact ga gb\n", ""}) {
      OnRanks run(two_blocks("surface flux 1.0") + contact, "run 1\n", layout);
      const double one = run.serial.fix_vector("heat", 10)[9];
      EXPECT_NEAR(run.parallel.fix_vector("heat", 10)[9] / one, 1.0, 1e-12) << layout << contact;
    }
}

// a disk slides on a block through periodic faces, with friction, contact, and balanced ranks
TEST(Ranks, AgreeWhileBalanced)
{
  const std::string scene = plane("lj", "p f", "0 9 -1 9", 2, 0.1) +
      "region a block 0 9 0 2.1 INF INF\nregion b sphere 6.95 4.12 0 2\n"
      "create_points 1 region a spacing 0.125\ncreate_points 2 region b spacing 0.125\n"
      "group a type 1\ngroup b type 2\nfix ga a mpm 0.25\nfix gb b mpm 0.25\n"
      "fix ma a mpm/material density 1.0 neohookean 100.0 0.3 thermal conducting 1.0 0.0 1.0\n"
      "fix mb b mpm/material density 1.0 neohookean 100.0 0.3 thermal conducting 1.0 1.0 4.0\n"
      "fix touch all mpm/contact ga gb law coulomb 0.3 heat yes\n"
      "fix heat all mpm/heat surface convection 1.0 0.0 contact ga gb conductance 50.0\n"
      "velocity b set 2 -1 0\ntimestep 0.004\n";
  OnRanks run(scene, "run 60\n", "comm_style tiled\nfix even all balance 10 1.0 rcb\n");
  EXPECT_LT(run.difference(), 1e-11);
  const double *const one = run.serial.fix_vector("heat", 11),
                      *const all = run.parallel.fix_vector("heat", 11);
  for (const int k : {7, 9, 10}) {
    EXPECT_GT(std::fabs(one[k]), 1e-3) << k;
    EXPECT_NEAR(all[k] / one[k], 1.0, 1e-12) << k;
  }
}

// where a surface goes through nodes, round-off decides between which of them it is found, on ranks
// that sum in another order, or when it moves a little: the area must be the same
TEST(SurfaceInNodes, HasOneArea)
{
  double power[3];
  for (const int k : {0, 1, 2}) {
    const double at = 0.01 + (k - 1) * 1e-12;
    Scene run(plane("si", "f f", "0 0.14 0 0.12", 1, 0.005) +
              strprintf("region r1 block %.17g %.17g %.17g %.17g INF INF\n", at, at + 0.05,
                        0.02 + (k - 1) * 1e-12, 0.07 + (k - 1) * 1e-12) +
              "create_points 1 region r1 spacing 0.005\nfix grid all mpm 0.01 origin 0 0\n"
              "fix m all mpm/material density 2000 eos linear 1e-6 thermal conducting 2 300 33\n"
              "fix heat all mpm/heat surface flux 3e4\ntimestep 1e-6\nrun 1\n");
    power[k] = run.fix_vector("heat", 10)[9];
  }
  measured("power", power[1]);
  EXPECT_NEAR(power[0] / power[1], 1.0, 1e-12);
  EXPECT_NEAR(power[2] / power[1], 1.0, 1e-12);
}
// functions of gimp end in planes of nodes, where round-off gave nodes a capacity
TEST(SurfaceInNodes, IsTheSameOnALatticeMovedByRoundOff)
{
  const auto temperatures = [](double origin, double spacing) {
    Scene run(plane("si", "f f", "0 12 0 8", 1, 0.5) + "region b block 2 6 2 6 INF INF\n" +
              strprintf("create_points 1 region b spacing %.17g\nfix grid all mpm 1 shape gimp "
                        "origin %g %g\n",
                        spacing, origin, origin) +
              "fix m all mpm/material density 2 linear 5e4 0.3 thermal conducting 1 300 1\n"
              "fix heat all mpm/heat surface flux 100 every 1\ntimestep 1e-3\n"
              "compute T all mpm/atom temperature\nrun 20\n");
    std::vector<double> T(run.lmp->atom->natoms, 0.0);
    const double *const mine = run.per_atom("T")->vector_atom;
    for (int i = 0; i < run.n(); i++) T[run.lmp->atom->tag[i] - 1] = mine[i];
    return over_ranks(T);
  };
  for (const double spacing : {1.0, 0.5, 1.0 / 3.0})
    for (const double origin : {3e-15, -3e-15}) {
      const auto plain = temperatures(0.0, spacing), moved = temperatures(origin, spacing);
      ASSERT_EQ(plain.size(), moved.size());
      double most = 0.0;
      for (std::size_t k = 0; k < plain.size(); k++) grow(most, plain[k] - moved[k]);
      EXPECT_LT(measured(strprintf("%.3g, %g", spacing, origin), most), 1e-11);    // of 1.5 to 1.9
    }
}
TEST(SurfaceInNodes, IsTheSameOnRanks)
{
  const std::string scene = plane("si", "f f", "0 0.14 0 0.12", 1, 0.005) +
      "fix grid all mpm 0.01 frame total\nregion r1 block 0.01 0.06 0 0.05 INF INF\n"
      "create_points 1 region r1 ppc 2\nvelocity all set -1.4 -1.9 0\n"
      "fix m all mpm/material density 2000 neohookean 1e7 0.4 thermal conducting 2 300 33\n"
      "fix w all mpm/boundary xlo slip\nfix heat all mpm/heat surface flux 3e4\n"
      "fix dt all mpm/dt 0.2\n";
  OnRanks run(scene, "run 20\n", "fix even all balance 4 1.0 shift xy 3 1.05\n");
  EXPECT_LT(run.difference(), 1e-11);
  EXPECT_NEAR(heat_in(run.parallel) / heat_in(run.serial), 1.0, 1e-11);
}

// two blocks touch and stay in planes of nodes, where round-off leaves gradients at nodes without
// capacity: these have no part in the response, without bounds, of a surface to its heat
TEST(SurfaceInNodes, RespondsByNodesWithHeat)
{
  const std::string law =
      " mpm/material density 1000 linear 1e7 0.3 thermal conducting 100 300 5e4";
  const std::string scene = space("si", "f p f", "0 0.12 0 0.08 0 0.07", 2, 0.005) +
      "group one type 1\ngroup two type 2\n"
      "fix a one mpm 0.01 shape cpdi2 transfer flip 1.0 scheme musl\n"
      "fix b two mpm 0.01 shape cpdi2 transfer flip 1.0 scheme musl\n"
      "region a block 0.01 0.05 0.02 0.06 0.01 0.05\ncreate_points 1 region a ppc 2 fix a\n"
      "region b block 0.05 0.09 0.03 0.06 0.01 0.04\ncreate_points 2 region b ppc 2 fix a\n"
      "group one type 1\ngroup two type 2\nvelocity one set 3 1 0\nvelocity two set -3 1 0\n"
      "fix ma one" +
      law + "\nfix mb two" + law +
      "\nfix c all mpm/contact a b law frictionless\n"
      "fix heat all mpm/heat surface convection 1e6 280 every 1\ntimestep 1.68e-5\n";
  double power[4] = {0.0}, alone = 0.0;
  Scene run(scene + "run 0\n"), serial(scene + "run 0\n", MPI_COMM_SELF);
  for (int k = 1; k < 4; k++) {
    run.commands("run 1\n");
    serial.commands("run 1\n");
    power[k] = run.fix_vector("heat", 10)[9];
    alone = serial.fix_vector("heat", 10)[9];
    EXPECT_NEAR(power[k] / alone, 1.0, 1e-8) << k;
  }
  EXPECT_NEAR(measured("step 2", 2.0 * power[2] / (power[1] + power[3])), 1.0, 0.01);
}

// the area of a disk is the same wherever it crosses periodic faces, on any number of ranks
TEST(Ranks, AgreeAcrossPeriodicFaces)
{
  double first = 0.0;
  for (const double x : {0.0, 4.0, 4.5, 5.25, 5.5}) {
    OnRanks run(plane("lj", "p p", "0 8 0 8", 1, 0.1) +
                    "region disk sphere 4 4 0 1.5\ncreate_points 1 region disk spacing 0.125\n" +
                    strprintf("displace_atoms all move %g 5.5 0\n", x) + "fix grid all mpm 0.25\n" +
                    conductor() + "fix heat all mpm/heat surface flux 1.0\ntimestep 0.001\n",
                "run 1\n");
    const double one = run.serial.fix_vector("heat", 10)[9];
    EXPECT_NEAR(run.parallel.fix_vector("heat", 10)[9] / one, 1.0, 1e-12) << x;
    EXPECT_NEAR(measured("area", one / (3.0 * PI)), 1.0, 0.003) << x;
    if (first == 0.0) first = one;
    EXPECT_NEAR(one / first, 1.0, 1e-10) << x;
  }
}

// a region moves through a periodic block in 3d, with lines beyond the nodes that points reach
TEST(Ranks, AgreeOnMovingRegions)
{
  const std::string scene = space("si", "f p f", "0 0.2 0 0.08 0 0.2", 1, 0.001) +
      "region body block 0.05 0.15 INF INF 0 0.1\nvariable dx equal 0.5*time\n"
      "region ball sphere 0.1 0.04 0.125 0.03 move v_dx NULL NULL\n"
      "create_points 1 region body spacing 0.005\nfix grid all mpm 0.01 origin 0.002 0 0\n"
      "fix m all mpm/material density 2700 eos linear 1e3 thermal conducting 900 300 200\n"
      "fix heat all mpm/heat surface convection 500 273 region ball temperature 800 "
      "zlo temperature 300\ntimestep 0.002\n";
  OnRanks run(scene, "run 10\n");
  EXPECT_GT(heat_in(run.serial), 100.0);
  EXPECT_NEAR(heat_in(run.parallel) / heat_in(run.serial), 1.0, 1e-11);
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string scene =
      replaced(bar_in_box(4, 0.0, "", 0.0), "fix heat all mpm/heat \n", "") + "timestep 0.001\n";
  expect_refused(scene,
                 {{"fix heat all mpm/heat region none flux 1.0", "region none does not exist"},
                  {"fix heat all mpm/heat region wall", "region"},
                  {"fix heat all mpm/heat region wall hot 1.0", "must be one of insulated"},
                  {"fix heat all mpm/heat region wall convection -1.0 0.0", "not negative"},
                  {"fix heat all mpm/heat surface radiation 0.5 300", "use units si"},
                  {"fix heat all mpm/heat surface flux v_none", "does not exist"},
                  {"variable H equal -1.0\nfix heat all mpm/heat surface convection v_H 0.0",
                   "surface: variable H = -1, but it must not be negative"},
                  {"variable H equal -1.0\nfix heat all mpm/heat region wall convection v_H 0.0",
                   "region wall: variable H = -1, but it must not be negative"},
                  {"fix heat all mpm/heat surface flux 1.0 surface flux 2.0", "surface"},
                  {"fix heat all mpm/heat region wall flux 1 region wall flux 2", "given twice"},
                  {"region open block 1 2 INF INF INF INF open 1\n"
                   "fix heat all mpm/heat region open flux 1.0",
                   "open faces"}},
                 "run 1\n");
}

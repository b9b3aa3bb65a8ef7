// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: smoke unit
// mpi: 1 2

// Terrains from rasters and columns of heights, and distances from surfaces in cells.

#include "mesh/stl_testing.h"
#include "mesh/surface_cells.h"
#include "mesh/terrain_file.h"

#include <random>

using namespace MPM_TEST;
using MPM_NS::SurfaceCells;
using MPM_NS::SurfaceMesh;

// Distances from a ball, of 20480 triangles: up to the size of the triangles they are those of a
// sphere, on which the cells have no part.
SERIAL_TEST(SurfaceCells, KnowDistancesFromABall)
{
  const double R = 3.0, size = 0.25;
  const SurfaceMesh mesh(text_of(ball(R, 5)), "ball", 1.0, {0.0, 0.0, 0.0});
  SurfaceCells cells(mesh, size, false), backward(mesh, size, false);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-6.5, 6.5);
  std::vector<Point> places(4000);
  for (auto &x : places) x = {any(random), any(random), any(random)};
  std::vector<double> found;
  int known = 0, far = 0;
  for (const auto &x : places) {
    Point closest, up;
    double d = 0.0;
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]),
                 exact = mesh.distance(x, closest);
    const auto answer = cells.find(x, d, &up);
    found.push_back(d);
    if (answer == SurfaceCells::FAR) {
      far++;
      EXPECT_LE(fabs(d), fabs(exact));
      EXPECT_GT(d * exact, 0.0);
    }
    if (answer != SurfaceCells::KNOWN) continue;
    known++;
    EXPECT_NEAR(d, exact, 2.0 * SurfaceCells::TOLERANCE * size);
    EXPECT_NEAR(d, r - R, 0.005 * size + 0.002);    // the arrow of the triangles is .0014
    for (int k = 0; k < 3; k++) EXPECT_NEAR(up[k], x[k] / r, 0.02);
  }
  EXPECT_GT(known, 1500);
  EXPECT_GT(far, 800);
  // values do not depend on what was asked for before
  for (std::size_t n = places.size(); n-- > 0;) {
    double d = 0.0;
    backward.find(places[n], d, nullptr);
    EXPECT_EQ(d, found[n]);
  }
}

// Beside faces of a box the distance is linear; next to edges and to the middle planes the cells
// say that they do not know it.
SERIAL_TEST(SurfaceCells, LeaveEdgesToTheMesh)
{
  const Point lo = {-1.0, -1.0, -1.0}, hi = {1.0, 1.0, 1.0};
  const SurfaceMesh mesh(text_of(box(lo, hi)), "box", 1.0, {0.0, 0.0, 0.0});
  for (const bool flat : {false, true}) {
    SurfaceCells cells(mesh, 0.1, flat);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> any(-1.9, 1.9);
    int known = 0, unknown = 0;
    for (int n = 0; n < 4000; n++) {
      const Point x = {any(random), any(random), flat ? 0.0 : any(random)};
      double inner = -1.0e300, outer = 0.0, d;
      for (int k = 0; k < 3; k++) {
        const double q = fabs(x[k]) - 1.0;
        inner = std::max(inner, q);
        outer += q > 0.0 ? q * q : 0.0;
      }
      const double exact = inner > 0.0 ? sqrt(outer) : inner;
      const auto answer = cells.find(x, d, nullptr);
      if (answer == SurfaceCells::UNKNOWN) unknown++;
      if (answer != SurfaceCells::KNOWN) continue;
      known++;
      EXPECT_NEAR(d, exact, 0.002);
      if (std::max(fabs(x[0]), fabs(x[1])) < 0.7 && fabs(x[2]) > 0.85 && !flat)
        EXPECT_NEAR(d, exact, 1.0e-7);
    }
    EXPECT_GT(known, 2000);
    EXPECT_GT(unknown, 100);
  }
}

// Across a blunt ridge, normals have nearly the same direction, and the cells leave it to the mesh,
// too.
SERIAL_TEST(SurfaceCells, LeaveRidgesToTheMesh)
{
  const double slope = 0.25, size = 0.1;    // 28 degrees between the normals
  std::string heights;
  for (const double x : {-4.0, 0.0, 4.0})
    for (const double y : {-4.0, 4.0}) heights += strprintf("%g %g %g\n", x, y, -slope * fabs(x));
  MPM_NS::SurfaceOptions open;
  open.open = true;
  const SurfaceMesh mesh(heights, "ridge.xyz", 1.0, {0.0, 0.0, 0.0}, open);
  SurfaceCells cells(mesh, size, false);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int known = 0, unknown = 0;
  for (int n = 0; n < 3000; n++) {
    const Point x = {0.2 * any(random), any(random), 0.3 * any(random)};
    Point closest;
    double d;
    const auto answer = cells.find(x, d, nullptr);
    if (answer == SurfaceCells::UNKNOWN) unknown++;
    if (answer != SurfaceCells::KNOWN) continue;
    known++;
    EXPECT_NEAR(d, mesh.distance(x, closest), 2.0 * SurfaceCells::TOLERANCE * size);
  }
  EXPECT_GT(known, 1000);
  EXPECT_GT(unknown, 100);
}

/** Heights z = f(x, y) as an ESRI ASCII grid, whose lower left cell has this middle. */
template <class F>
static std::string raster(int columns, int rows, double x, double y, double cell, const F &f)
{
  std::string text =
      strprintf("NCOLS %d\nnrows %d\nxllcenter %.12g\nyllcenter %.12g\ncellsize %.12g\n", columns,
                rows, x, y, cell);
  for (int j = rows - 1; j >= 0; j--)
    for (int i = 0; i < columns; i++)
      text += strprintf("%.12g%c", f(x + i * cell, y + j * cell), i + 1 < columns ? ' ' : '\n');
  return text;
}

static double hill(double x, double y)
{
  return 3.0 + 0.5 * x - 0.25 * y + 0.125 * x * y;
}

// All corners are on the terrain; the triangles look up, and cover the rectangle between the
// heights.
SERIAL_TEST(Terrain, RastersAndColumnsAreTheSameSurface)
{
  const std::string grid = raster(5, 4, 10.0, -2.0, 0.5, hill);
  std::string columns = "# x y z\n";
  for (int i = 4; i >= 0; i--)
    for (int j = 0; j < 4; j++) {
      const double x = 10.0 + 0.5 * i, y = -2.0 + 0.5 * j;
      columns += strprintf("%.12g,%.12g;%.12g\r\n", x, y, hill(x, y));
    }
  std::string corner = grid;
  corner.replace(corner.find("xllcenter 10"), 12, "xllcorner 9.75");
  corner.replace(corner.find("yllcenter -2"), 12, "yllcorner -2.25");
  const auto of_grid = MPM_NS::read_terrain(grid, "a.asc");
  EXPECT_EQ(of_grid, MPM_NS::read_terrain(columns, "a.XYZ"));
  EXPECT_EQ(of_grid, MPM_NS::read_terrain(corner, "a.ASC"));
  ASSERT_EQ(of_grid.size(), 3u * 2 * 4 * 3);
  double area = 0.0;
  for (std::size_t k = 0; k < of_grid.size(); k += 3) {
    const auto *p = &of_grid[k];
    for (int c = 0; c < 3; c++) EXPECT_NEAR(p[c][2], hill(p[c][0], p[c][1]), 1.0e-10);
    const double up =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    EXPECT_GT(up, 0.0);
    area += 0.5 * up;
  }
  EXPECT_NEAR(area, 2.0 * 1.5, 1.0e-12);
}

// A missing height takes the four cells around it, but for the triangles that do not need it.
SERIAL_TEST(Terrain, MissingHeightsLeaveHoles)
{
  for (const char *none : {"-9999", "nan", "-9999.0"}) {
    const std::string text =
        std::string("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ndx 1\ndy 2\n") + "0 0 0\n0 " +
        none + " 0\n0 0 0\n";
    EXPECT_EQ(MPM_NS::read_terrain(text, "a.asc").size(), 3u * 4);
  }
  EXPECT_EQ(
      MPM_NS::read_terrain("ncols 2 nrows 2 xllcorner 0 yllcorner 0 cellsize 1 NODATA_value 7\n"
                           "7 1 1 1",
                           "a.asc")
          .size(),
      3u);
  EXPECT_EQ(MPM_NS::read_terrain("0 0 1\n1 0 1\n0 1 1\n", "a.xyz").size(), 3u);
}

SERIAL_TEST(Terrain, RefusesMistakes)
{
  const std::string place = "xllcorner 0\nyllcorner 0\ncellsize 1\n",
                    head = "ncols 2\nnrows 2\n" + place;
  const std::vector<std::array<std::string, 3>> mistakes = {
      {"a.asc", "ncols 2\nnrow 2\n", "'nrow' is no key"},
      {"a.asc", "ncols two\n", "ncols needs a number"},
      {"a.asc", "nrows 2\n" + place + "1 2 3 4", "has no ncols in its head"},
      {"a.asc", "ncols 2\nnrows 2\nyllcorner 0\ncellsize 1\n1 2 3 4",
       "no xllcorner and no xllcenter"},
      {"a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3 4", "has no cellsize and no dx"},
      {"a.asc", "ncols 2\nnrows 1\n" + place + "1 2", "nrows must be two or more"},
      {"a.asc", "ncols 2.5\nnrows 2\n" + place + "1 2 3 4", "ncols must be two or more"},
      {"a.asc", "ncols 1e9\nnrows 1e9\n" + place + "1 2 3 4", "not more than there are heights"},
      {"a.asc", "ncols 40\nnrows 40\n" + place + "1 2 3 4", "too short for ncols times nrows"},
      {"a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1 2 3 4",
       "must be positive"},
      {"a.asc", head + "1 2 3", "height 2 of row 2 (from the north) is missing"},
      {"a.asc", head + "1 2 x 4", "height 1 of row 2 (from the north) is no finite number"},
      {"a.asc", head + "1 2 3 1e999", "is no finite number"},
      {"a.asc", head + "1 2 3 4 5", "more heights than"},
      {"a.asc", head + "1 2 -9999 -9999", "no three heights next to each other"},
      {"a.asc", "", "is empty"},
      {"a.xyz", "# x y z\n", "has no heights"},
      {"a.xyz", "8\natoms\n", "line 1: needs three finite numbers"},
      {"a.xyz", "0 0 1\n1 0 1 5\n", "line 2: needs three finite numbers"},
      {"a.xyz", "0 0 1\n1 0 inf\n", "line 2: needs three finite numbers"},
      {"a.xyz", "0 0 1\n1 0 1\n2 0 1\n", "two columns and rows at least"},
      {"a.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n1 1 2\n", "has two heights at 1 1: 1 and 2"}};
  for (const auto &[name, text, says] : mistakes) {
    try {
      SurfaceMesh mesh(text, name, 1.0, {0.0, 0.0, 0.0});
      ADD_FAILURE() << says;
    } catch (const std::runtime_error &problem) {
      EXPECT_THAT(problem.what(), AllOf(HasSubstr(name), HasSubstr(says)));
    }
  }
  std::string scattered;
  for (int k = 0; k < 20; k++) scattered += strprintf("%d.%d %d %d\n", k, k * k, k * k % 19, k);
  EXPECT_THROW(MPM_NS::read_terrain(scattered, "a.xyz"), std::runtime_error);
}

// A block slides down a raster: the acceleration is g (sin a - mu cos a).
TEST(Terrain, HoldsABlockThatSlides)
{
  const double slope = 0.75, mu = 0.3, g = 1.0;    // sin a = .6, cos a = .8
  const ScratchFile file("slope.asc", raster(9, 5, 998.0, -2.0, 2.0, [&](double x, double) {
                           return 100.0 - slope * (x - 1000.0);
                         }));
  const std::string region = "mpm/mesh " + file.name + " 1.0 -1000 0 -92";
  const std::string input = space("lj", "f f f", "0 12 0 6 -2 12") + R"(
fix grid all mpm 0.5
region body block 1 4 1 4 0 12
region ground GROUND
region air GROUND side out
region top plane 0 0 9.5 -0.75 0 -1
region start intersect 3 body air top
create_points 1 region start ppc 2
fix m all mpm/material density 1.0 neohookean 500.0 0.3
fix w all mpm/boundary region ground separate friction 0.3
fix g all gravity 1.0 vector 0 0 -1
variable vx equal vcm(all,x)
timestep 0.005
run 200
)";
  Scene scene;
  scene.commands(replaced(input, "GROUND", region));
  const double before = scene.evaluate("v_vx");
  scene.commands("run 400");
  const double along = g * (0.6 - mu * 0.8), gained = scene.evaluate("v_vx") - before;
  EXPECT_LT(measured("acceleration", fabs(gained / (along * 0.8 * 2.0) - 1.0)), 0.004);
}

// Two blocks slide side by side, one on the patch: on a face of the box under tilted gravity, and
// on a raster.
TEST(Terrain, PatchesHaveTheirOwnFriction)
{
  const ScratchFile flat("flat.asc", raster(9, 9, -2.0, -2.0, 2.0, [](double, double) {
                           return 0.6;
                         }));
  const std::string input = space("lj", "f f f", "0 12 0 8 0 6") + R"(
fix grid all mpm 0.5
region one block 1 4 0.5 3 LOW
region two block 1 4 5 7.5 LOW
group one empty
group two empty
create_points 1 region one ppc 2 group one
create_points 1 region two ppc 2 group two
fix m all mpm/material density 1.0 neohookean 500.0 0.3
region wood block INF INF 4 INF INF INF
region ground mpm/mesh FILE 1.0 0 0 0
fix w all mpm/boundary WALL separate friction 0.5 patch wood 0.2
fix g all gravity 1.0 vector 0.6 0 -0.8
timestep 0.01
variable one equal vcm(one,x)
variable two equal vcm(two,x)
run 100
)";
  for (const bool on_raster : {false, true}) {
    Scene scene;
    scene.commands(replaced(replaced(replaced(input, "WALL", on_raster ? "region ground" : "zlo"),
                                     "LOW", on_raster ? "0.6 3.1" : "0 2.5"),
                            "FILE", flat.name));
    const double from[2] = {scene.evaluate("v_one"), scene.evaluate("v_two")};
    scene.commands("run 400");    // after the blocks have settled
    const double one = (scene.evaluate("v_one") - from[0]) / (0.6 - 0.5 * 0.8),
                 two = (scene.evaluate("v_two") - from[1]) / (0.6 - 0.2 * 0.8);
    EXPECT_LT(measured("with 0.5", fabs(one / 4.0 - 1.0)), 0.025);
    EXPECT_LT(measured("with 0.2", fabs(two / 4.0 - 1.0)), 0.025);
  }
  expect_refused(
      space("lj", "f f f", "0 4 0 4 0 4") +
          "fix grid all mpm 0.5\nfix m all mpm/material density 1.0 neohookean 500.0 0.3\n"
          "variable d equal 0.1*time\nregion moves block 0 1 0 1 0 1 move v_d NULL NULL\n",
      {{"fix w all mpm/boundary zlo separate patch none 0.2\nrun 0", "Region none"},
       {"fix w all mpm/boundary zlo separate patch moves 0.2\nrun 0", "must not move"},
       {"fix w all mpm/boundary zlo stick patch moves 0.2", "slip or separate"},
       {"fix w all mpm/boundary zlo separate patch moves -0.2", "patch"}});
}

// A patch where the wall cannot be is a mistake in a coordinate.
TEST(Terrain, PatchesThatMeetNoWall)
{
  const ScratchFile file("hill.asc", raster(5, 4, 10.0, -2.0, 0.5, hill));
  const std::string start = space("lj", "f f f", "0 1 0 1 0 10") +
      "fix grid all mpm 0.5\nregion top block 0 1 0 1 9 9.5\ncreate_points 1 region top ppc 1\n"
      "fix m all mpm/material density 1.0 neohookean 500.0 0.3\nregion hill mpm/mesh " +
      file.name + " 1.0 -10.5 1.5 0\n",
                    words = "its wall is nowhere in region";
  for (const auto &[region, on_face, on_hill] : {std::tuple{"block 0 0.5 INF INF INF INF", 0, 0},
                                                 {"block 2 3 INF INF INF INF", 1, 1},
                                                 {"block INF INF INF INF 1 2", 1, 1},
                                                 {"block INF INF INF INF 7 9", 1, 0},
                                                 {"block INF INF INF INF -1 0.1", 0, 1}})
    for (const bool hills : {false, true})
      EXPECT_EQ(times_said(start + "region part " + region + "\nfix w all mpm/boundary " +
                               (hills ? "region hill" : "zlo") +
                               " separate patch part 0.2\nrun 0\n",
                           words),
                hills ? on_hill : on_face)
          << region << hills;
}

// The solver of implicit steps knows the coefficients, too.
TEST(Terrain, PatchesInImplicitSteps)
{
  Scene scene;
  scene.commands(plane("lj", "f f", "0 24 0 4") + R"(
fix grid all mpm 0.5
region one block 1 4 0 1.5 INF INF
region two block 13 16 0 1.5 INF INF
group one empty
group two empty
create_points 1 region one ppc 2 group one
create_points 1 region two ppc 2 group two
fix m all mpm/material density 1.0 neohookean 500.0 0.3
region wood block 12 INF INF INF INF INF
fix w all mpm/boundary ylo separate friction 0.5 patch wood 0.2
fix g all gravity 1.0 vector 0.6 -0.8 0
fix i all mpm/implicit euler
timestep 0.05
variable one equal vcm(one,x)
variable two equal vcm(two,x)
run 10
)");
  EXPECT_NEAR(scene.evaluate("v_one"), (0.6 - 0.5 * 0.8) * 0.5, 0.004);
  EXPECT_NEAR(scene.evaluate("v_two"), (0.6 - 0.2 * 0.8) * 0.5, 0.004);
}

TEST(Terrain, SaysWhereItIs)
{
  const ScratchFile file("hill.asc", raster(5, 4, 10.0, -2.0, 0.5, hill));
  const std::string box = space("lj", "f f f", "0 1 0 1 0 10"),
                    region = "region r mpm/mesh " + file.name;
  EXPECT_EQ(times_said(box + region + " 1.0 -10.5 1.5 0\nrun 0\n", "outside of the box"), 0);
  EXPECT_EQ(
      times_said(box + region + " 1.0 0 2 0\nrun 0\n",
                 "outside of the box: along x it goes from 10 to 12, and the box from 0 to 1"),
      1);
  EXPECT_EQ(times_said(box + region + " 1.0 -10.5 1.5 0\nrun 0\n", "x -0.5 to 1.5, y -0.5 to 1"),
            1);
  expect_refused(box,
                 {{region + " 1.0 0 0 0 surface closed", "has heights, whose surface is open"},
                  {region + " 1.0 0 0 0 surface leaky", "has heights, whose surface is open"}});
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit
// mpi: 1 4

// create_points ... cut yes: points at the surface of a region have the inner part of their cell.

#include "body_testing.h"
#include "mesh/stl_testing.h"

using namespace MPM_TEST;

static std::string cut(double spacing, const std::string &more = "cut yes")
{
  return strprintf("create_points 1 region body spacing %.17g %s\n", spacing, more.c_str());
}

// Ten cells across, two points to a cell, where no face is at a face of cells.
TEST(RegionCut, SolidsHaveTheirVolumeAndInertia)
{
  for (const auto &solid : solids()) {
    const ScratchFile file("solid.stl", text_of(solid.soup));
    const double width = std::string(solid.name) == "L" ? 3.0 : solid.volume < 1.0 ? 1.0 : 2.0;
    const double size = width / 20.0;
    Scene run(box_of_3d + "region body mpm/mesh " + file.name + " 1.0 0.037 0.02 -0.011\n" +
              cut(size));
    const Sum sum(run);
    EXPECT_NEAR(sum.volume, solid.volume, 2e-9 * solid.volume) << solid.name;    // nine digits
    const auto moments = sum.moments(size);
    for (int d = 0; d < 3; d++)
      EXPECT_NEAR(moments[d], solid.moment[d], 1.0e-3 * solid.moment[d]) << solid.name;
    EXPECT_GE(sum.least, 0.1 * pow(size, 3) * (1.0 - 1.0e-9)) << solid.name;
  }
}

// far from the diagonal of the box
TEST(RegionCut, OfABodyAtASide)
{
  const ScratchFile file("ball.stl", text_of(ball(1.0, 3)));
  Scene run(box_of_3d + "region body mpm/mesh " + file.name + " 1.0 -2.5 2.1 0.3\n" + cut(0.1));
  EXPECT_NEAR(Sum(run).volume, 4.1527408171, 1e-7);
}

TEST(RegionCut, OutsideOfASurface)
{
  const ScratchFile file("ball.stl", text_of(ball(1.0, 3)));
  const std::string mesh = "region ball mpm/mesh " + file.name + " 1.0 0.037 0.02 -0.011",
                    block = "region block block -1.5 1.5 -1.5 1.5 -1.5 1.5\n";
  Scene run(space("lj", "f f f", "-1.5 1.5 -1.5 1.5 -1.5 1.5") + mesh + " side out\n" +
            "create_points 1 region ball spacing 0.1 cut yes\n");
  EXPECT_NEAR(Sum(run).volume, 27.0 - 4.1527408171, 1.0e-7);
  // in another region only what is inside is known
  Scene rest(box_of_3d + block + mesh + " side out\nregion body intersect 2 block ball\n" +
             cut(0.1));
  EXPECT_NEAR(Sum(rest).volume, 27.0 - 4.1527408171, 3e-6 * 22.8);
}

// Regions of LAMMPS, of which only is known what is inside.
TEST(RegionCut, RegionsHaveTheirVolume)
{
  const struct {
    const char *region;
    int dim;
    double volume, width;
  } cases[] = {{"sphere 0.037 0.02 0.01 1", 3, 4.0 / 3.0 * PI, 2.0},
               {"cylinder z 0.037 0.02 1 -0.513 0.777", 3, 1.29 * PI, 2.0},
               {"block -0.513 0.487 -0.511 0.489 -0.523 0.477", 3, 1.0, 1.0},
               {"prism -0.5 0.5 -0.5 0.5 -0.5 0.5 0.3 0.2 0.1", 3, 1.0, 1.0},
               {"cone z 0 0.03 1 0.2 -1 0.7", 3, PI * 1.7 / 3.0 * 1.24, 2.0},
               {"sphere 0.037 0.02 0 1", 2, PI, 2.0},
               {"sphere 0.137 -0.32 0 0.3", 2, 0.09 * PI, 0.6},
               {"block -0.513 0.487 -0.511 0.489 -1 1", 2, 1.0, 1.0}};
  for (const auto &c : cases) {
    const double size = c.width / 20.0 * 1.0137;
    Scene run((c.dim == 3 ? box_of_3d : box_of_2d) + "region body " + c.region + "\n" + cut(size));
    const Sum sum(run);
    EXPECT_NEAR(measured(c.region, sum.volume / c.volume), 1.0, 3e-4) << c.region;
    EXPECT_GE(sum.least, 0.1 * pow(size, c.dim) * (1.0 - 1.0e-9)) << c.region;
  }
}

TEST(RegionCut, CentersAreThoseOfTheRegion)
{
  Scene run(box_of_3d + "region body sphere 0.037 0.02 0.01 1\n" + cut(0.1));
  const Sum sum(run);
  const double center[3] = {0.037, 0.02, 0.01};
  for (int d = 0; d < 3; d++) EXPECT_NEAR(sum.center[d], center[d], 3e-5);
  const auto moments = sum.moments(0.1);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(moments[d], 8.0 / 15.0 * PI, 3e-4 * 8.0 / 15.0 * PI);
}

// A row that ends somewhere in its last cell: no point below a tenth of a cell, no volume lost.
TEST(RegionCut, LightPartsGoToANeighbor)
{
  const struct {
    double end;
    int points;
    double last;    // volume of the outermost points, in cells
  } cases[] = {
      {1.0, 10, 1.0}, {1.005, 10, 1.05}, {1.02, 11, 0.2}, {1.05, 11, 0.5}, {1.095, 11, 0.95}};
  for (const auto &c : cases) {
    Scene run(plane("lj", "f f", "0 4 0 4") +
              strprintf("region body block 0 %g 0 0.1 -1 1\n", c.end) + cut(0.1));
    const auto points = run.gather();
    ASSERT_EQ((int) points.size(), c.points) << c.end;
    EXPECT_NEAR(Sum(run).volume, 0.1 * c.end, 0.1 * 0.1 * 6e-4) << c.end;
    EXPECT_NEAR(Sum(run).center[0], 0.5 * c.end, 3e-5) << c.end;
    EXPECT_NEAR(points.back().vol, 0.01 * c.last, 3e-4 * 0.02) << c.end;    // IDs go along x
  }
}

// Faces that are those of cells: the same as without, to the last bit.
TEST(RegionCut, WholeCellsAreTheSame)
{
  const std::string scene =
      space("lj", "f f f", "0 4 0 4 0 4") + "region body block 1 2.2 0.4 1.8 2 4\n";
  Scene with(scene + cut(0.2)), without(scene + cut(0.2, "cut no"));
  EXPECT_TRUE(identical(with.gather(), without.gather()));
}

// An inclusion and what is around it share cells, and have all of the volume together.
TEST(RegionCut, TwoRegionsShareCells)
{
  Scene run(plane("lj", "f f", "0 2 0 2", 2) +
            "region ball sphere 1.03 0.98 0 0.61\nregion rest sphere 1.03 0.98 0 0.61 side out\n"
            "create_points 1 region ball spacing 0.1 cut yes\n"
            "create_points 2 region rest spacing 0.1 cut yes\n");
  EXPECT_NEAR(Sum(run).volume, 4.0, 1e-12 * 4.0);
  EXPECT_THAT(run.error("create_points 2 region rest spacing 0.1 cut yes"), HasSubstr("overlap"));
}

TEST(RegionCut, AroundAnAxis)
{
  Scene run(plane("lj", "f f", "0 2 -2 2") + "fix g all mpm 0.2 axisymmetric yes\n" +
            "region body sphere 0 0.03 0 1\ncreate_points 1 region body ppc 2 cut yes\n");
  EXPECT_NEAR(Sum(run).volume, 4.0 / 3.0 * PI, 1.0e-3 * 4.0 / 3.0 * PI);
}

TEST(RegionCut, AnyNumberOfRanks)
{
  const ScratchFile file("torus.stl", text_of(torus(1.0, 0.4, 24)));
  for (const std::string region : {"sphere 0.037 0.02 0.01 1", "mpm/mesh"}) {
    const std::string where =
        region == "mpm/mesh" ? region + " " + file.name + " 1.0 0.037 0.02 0.01" : region;
    OnRanks both(box_of_3d, "region body " + where + "\n" + cut(0.13) + "run 0\n");
    EXPECT_TRUE(identical(both.serial.gather(), both.parallel.gather()));
  }
}

// A ball hits a wall: steps as with whole points, it comes back as fast, and energy does not grow.
TEST(RegionCut, LightPointsAreStable)
{
  double speed[2], step[2];
  for (const bool on : {false, true}) {
    Scene run(plane("lj", "f f", "-2 2 0 4") +
              "region body sphere 0.037 1.3 0 1\nfix grid all mpm 0.1\n" +
              (on ? "create_points 1 region body ppc 2 cut yes\n"
                  : "create_points 1 region body ppc 2\n") +
              "fix m all mpm/material density 1.0 neohookean 100.0 0.3\n"
              "fix w all mpm/boundary ylo separate\nvelocity all set 0 -1 0\n"
              "fix dt all mpm/dt 0.5 until 2.5\ncompute e all mpm/energy\n"
              "thermo_style custom step c_e[1] c_e[2]\nthermo_modify norm no\nrun 0\n");
    const double before = run.evaluate("c_e[1]+c_e[2]");
    step[on] = run.evaluate("dt");
    run.commands("run 5000\n");
    speed[on] = run.evaluate("vcm(all,y)");
    EXPECT_LE(run.evaluate("c_e[1]+c_e[2]"), before);
  }
  EXPECT_NEAR(step[true], step[false], 1e-12 * step[false]);
  EXPECT_NEAR(measured("speed with cut", speed[true]), measured("without", speed[false]),
              0.02 * speed[false]);
}

// A surface a thousand times as large as the box, as one in millimeters: its 1e9 cells outside are
// not looked at. In the box are its corner, or its oblique face, x + y + z = 1/2.
TEST(RegionCut, OfALargeBodyOnlyThePartInTheBox)
{
  const std::array<double, 3> o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
  const ScratchFile file("large.stl", text_of({{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}}));
  const std::string corner = "1000 0.3 0.2 0.1",
                    oblique = "1000 -333.1666666666667 -333.1666666666667 -333.1666666666667";
  // below the face: sums of three even numbers from 0 to 1 below t (J.O. Irwin, P. Hall, 1927)
  const double t = 12.5 / 8.0;
  const struct {
    const std::string &where;
    double volume;
  } cases[] = {{corner, 3.7 * 3.8 * 3.9},
               {oblique, 512.0 * (((-2.0 * t + 9.0) * t - 9.0) * t + 3.0) / 6.0}};
  for (const auto &c : cases) {
    const std::string scene =
        box_of_3d + "region body mpm/mesh " + file.name + " " + c.where + "\n";
    Scene run(scene + cut(0.2, "cut yes outside ignore"));
    EXPECT_NEAR(Sum(run).volume, c.volume, 1e-11 * c.volume);
    Scene other;
    EXPECT_THAT(other.error(scene + cut(0.2)), HasSubstr("reaches beyond the simulation box"));
  }
}

TEST(RegionCut, RefusesMistakes)
{
  const std::string region = "region body sphere 0 0 0 1\n",
                    points = "create_points 1 region body spacing 0.1 ";
  expect_refused(box_of_3d + region,
                 {{points + "cut maybe", "cut"},
                  {points + "cut yes jitter 0.2 123", "cut"},
                  {"create_points 1 box spacing 0.1 cut yes", "use style region"}});
}

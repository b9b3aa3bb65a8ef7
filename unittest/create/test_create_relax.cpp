// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit
// mpi: 1 4

// create_points ... relax: points that follow the surface of a region, with equal volumes.

#include "body_testing.h"
#include "mesh/stl_testing.h"

using namespace MPM_TEST;

static std::string relaxed(double spacing, int times, const std::string &more = "")
{
  return strprintf("create_points 1 region body spacing %.17g relax %d %s\n", spacing, times,
                   more.c_str());
}

/** Least and largest volume over the mean. */
static std::array<double, 2> extremes(const std::vector<Scene::State> &points)
{
  double least = 1e300, most = 0.0, sum = 0.0;
  for (const auto &p : points) {
    least = std::min(least, p.vol);
    most = std::max(most, p.vol);
    sum += p.vol;
  }
  return {least / sum * points.size(), most / sum * points.size()};
}

// benchmark T1: ten cells across with two points each, where no face is at a face of cells
SERIAL_TEST(Relax, SolidsHaveTheirVolumeAndInertia)
{
  LONG_CASE();
  for (const auto &solid : solids()) {
    const ScratchFile file("solid.stl", text_of(solid.soup));
    const double width = std::string(solid.name) == "L" ? 3.0 : solid.volume < 1.0 ? 1.0 : 2.0;
    const double size = width / 20.0;
    Scene run(box_of_3d + "region body mpm/mesh " + file.name + " 1.0 0.037 0.02 -0.011\n" +
              relaxed(size, 3));
    const Sum sum(run);
    EXPECT_NEAR(measured(solid.name, sum.volume / solid.volume), 1.0, 1.0e-5) << solid.name;
    const auto moments = sum.moments(std::cbrt(sum.volume / sum.points));
    for (int d = 0; d < 3; d++)
      EXPECT_NEAR(measured("moment", moments[d] / solid.moment[d]), 1.0, 1.0e-3) << solid.name;
  }
}

// of regions of which only is known what is inside; volumes become equal
SERIAL_TEST(Relax, VolumesOfADiskAreEqual)
{
  double before = 1.0;
  for (const int times : {10, 100}) {
    Scene run(box_of_2d + "region body sphere 0.037 0.02 0 1\n" + relaxed(0.1, times));
    const Sum sum(run);
    EXPECT_NEAR(sum.volume, PI, 1.0e-3 * PI);
    EXPECT_NEAR(sum.center[0], 0.037, 4.0e-4);
    EXPECT_NEAR(sum.center[1], 0.02, 4.0e-4);
    // about the axis, with that of the squares
    EXPECT_NEAR(sum.second[0][0] + sum.second[1][1] + PI * 0.01 / 6.0, PI / 2, 1.0e-3 * PI / 2);
    const auto [least, most] = extremes(run.gather());
    const double scatter = std::max(1.0 - least, most - 1.0);
    EXPECT_LT(measured("scatter", scatter), before);
    before = scatter;
  }
  EXPECT_LT(before, 0.05);
}

// the outer points are a layer: none is closer to the surface than 0.35 of the spacing, where the
// parts of cells are as close as 0.07, and their distances scatter by less than 0.05
TEST(Relax, PointsFollowTheSurface)
{
  const auto closest = [](const std::string &how, double &scatter) {
    Scene run(box_of_2d +
              "region body sphere 0.037 0.02 0 1\ncreate_points 1 region body spacing 0.1 " + how +
              "\n");
    double least = 1.0, sum[3] = {0.0, 0.0, 0.0};
    for (const auto &p : run.gather()) {
      const double depth = (1.0 - std::hypot(p.x[0] - 0.037, p.x[1] - 0.02)) / 0.1;
      least = std::min(least, depth);
      for (int k = 0; k < 3 && depth < 1.0; k++) sum[k] += std::pow(depth, k);
    }
    scatter = std::sqrt(sum[2] / sum[0] - sum[1] * sum[1] / sum[0] / sum[0]);
    return least;
  };
  double scatter;
  EXPECT_LT(measured("cut", closest("cut yes", scatter)), 0.1);
  EXPECT_GT(measured("scatter", scatter), 0.2);
  EXPECT_GT(measured("relaxed", closest("relax 50", scatter)), 0.35);
  EXPECT_LT(measured("scatter", scatter), 0.05);
}

// whole cells alone: nothing moves
TEST(Relax, BlocksOfWholeCellsStay)
{
  const std::string scene =
      space("lj", "f p f", "0 4 0 4 0 4") + "region body block 1 2.2 INF INF 2 4\n";
  Scene with(scene + relaxed(0.2, 4)), without(scene + "create_points 1 region body spacing 0.2\n");
  const auto a = with.gather(), b = without.gather();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); k++) {
    EXPECT_EQ(a[k].tag, b[k].tag);
    EXPECT_NEAR(a[k].vol, b[k].vol, 1e-14);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(a[k].x[d], b[k].x[d], 1e-13);
  }
}

// points keep their distance across a periodic face; two rows of a band of 2.6 spacings are equal
TEST(Relax, PeriodicBand)
{
  for (const double length : {0.3, 2.0}) {
    Scene run(plane("lj", "p f", strprintf("0 %g 0 2", length), 1, 0.01) +
              "region body block INF INF 0.513 0.773 INF INF\n" + relaxed(0.1, 60));
    const auto points = run.gather();
    EXPECT_NEAR(Sum(run).volume, 0.26 * length, 1e-3 * 0.26 * length);
    const auto [least, most] = extremes(points);
    EXPECT_LT(most - least, 0.02);
    const int rows = (int) std::lround(points.size() / (length / 0.1));
    for (const auto &p : points) {
      const double at = (p.x[1] - 0.513) / 0.26 * rows - 0.5;
      EXPECT_NEAR(at, std::round(at), 0.02);
    }
  }
}

// divided sites: volumes are in proportion to those of the parts, and all of them that of the body
SERIAL_TEST(Relax, Graded)
{
  Scene run(box_of_2d +
            "region body sphere 0.037 0.02 0 1\nvariable px internal 0\n"
            "variable py internal 0\nvariable n equal 1+(v_px>0)\n" +
            relaxed(0.1, 200, "split v_n v_px v_py"));
  const auto points = run.gather();
  EXPECT_NEAR(Sum(run).volume, PI, 1.0e-3 * PI);
  double fine = 0.0, coarse = 0.0;
  for (const auto &p : points) (p.vol < 0.005 ? fine : coarse) += 1.0;
  const double part = PI / (fine + 4.0 * coarse);
  double worst = 0.0;
  for (const auto &p : points) {
    worst = std::max(worst, std::fabs(p.vol / (p.vol < 0.005 ? part : 4.0 * part) - 1.0));
    if (p.x[0] > 0.2) EXPECT_LT(p.vol, 0.005);
    if (p.x[0] < -0.2) EXPECT_GT(p.vol, 0.005);
  }
  EXPECT_LT(measured("volumes", worst), 0.1);
}

TEST(Relax, AroundAnAxis)
{
  Scene run(plane("lj", "f f", "0 2 -2 2") + "fix g all mpm 0.2 axisymmetric yes\n" +
            "region body sphere 0 0.03 0 1\ncreate_points 1 region body ppc 2 relax 20\n");
  EXPECT_NEAR(Sum(run).volume, 4.0 / 3.0 * PI, 1.0e-3 * 4.0 / 3.0 * PI);
}

TEST(Relax, AnyNumberOfRanks)
{
  const ScratchFile file("torus.stl", text_of(torus(1.0, 0.4, 24)));
  const std::string place = file.name + " 1.0 0.037 0.02 0.01\n";
  for (const auto &[box, region] :
       {std::pair<std::string, std::string>{box_of_2d, "sphere 0.037 0.02 0 1\n"},
        {box_of_3d, "mpm/mesh " + place}}) {
    OnRanks both(box, "region body " + region + relaxed(0.17, 7) + "run 0\n");
    EXPECT_TRUE(identical(both.serial.gather(), both.parallel.gather()));
  }
}

// a body that reaches beyond the box ends there, at a face of sites or within sites
TEST(Relax, OutsideIgnored)
{
  Scene run(plane("lj", "f f", "-1.03 3 0.013 3") + "region body sphere 0 0 0 1\n" +
            relaxed(0.1, 10, "outside ignore"));
  EXPECT_NEAR(Sum(run).volume, 0.5 * PI - 2.0 * 0.013, 0.001);
  for (const auto &p : run.gather()) EXPECT_GT(p.x[1], 0.013);
  const double end = 0.563;    // beyond the centers of sites
  Scene other(plane("lj", "f f", strprintf("-2 2 -2 %g", end)) + "region body sphere 0 0 0 1\n" +
              relaxed(0.1, 10, "outside ignore"));
  EXPECT_NEAR(measured("area", Sum(other).volume),
              0.5 * PI + end * std::sqrt(1.0 - end * end) + std::asin(end), 0.003);
  for (const auto &p : other.gather()) EXPECT_LT(p.x[1], end);
}

TEST(Relax, RefusesMistakes)
{
  const std::string region =
                        "region body sphere 0 0 0 1\nregion all block INF INF INF INF INF INF\n"
                        "region sheet block -2 2 -2 2 0.04 0.06\n"
                        "region both union 2 body sheet\n",
                    points = "create_points 1 region body spacing 0.1 ";
  expect_refused(box_of_3d + region,
                 {{points + "relax -1", "relax"},
                  {points + "relax 2.5", "relax"},
                  {points + "relax 3 jitter 0.2 123", "relax"},
                  {"create_points 1 box spacing 0.1 relax 3", "use style region"},
                  {"create_points 1 region both spacing 0.1 relax 3", "too thin"}});
  expect_refused(space("lj", "p f f", "-2 2 -2 2 -2 2") + region,
                 {{"create_points 1 region body spacing 0.13 relax 3", "does not divide"}});
  expect_refused(space("lj", "f f f", "-2 2 -2 2 -2 2") + region +
                     "variable px internal 0\nvariable py internal 0\nvariable pz internal "
                     "0\nvariable n equal 20\n",
                 {{points + "relax 3 split v_n v_px v_py v_pz", "at most 16"}});
}

// points can be next to faces of cells
TEST(Relax, LinearShapeIsSaid)
{
  for (const std::string shape : {"linear", "quadratic"})
    EXPECT_EQ(lines_that_say(box_of_2d + "fix g all mpm 0.2 shape " + shape +
                                 "\nregion body sphere 0.037 0.02 0 1\n"
                                 "create_points 1 region body ppc 2 relax 3\n",
                             "WARNING: Create_points relax")
                  .size(),
              shape == "linear" ? 1u : 0u);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input physics ranks
// mpi: 1 4

// create_points ... split: points whose distance is a function of the place.

#include "bad_input_testing.h"
#include "mpm_lammps.h"

using namespace MPM_TEST;

const std::string place =
    "variable px internal 0\nvariable py internal 0\nvariable pz internal 0\n";
const std::string axes_2 = " v_px v_py", axes_3 = " v_px v_py v_pz";

static std::vector<Scene::State> made(const std::string &scene)
{
  Scene run(scene);
  return run.gather();
}

static double total(const std::vector<Scene::State> &points)
{
  double sum = 0.0;
  for (const auto &p : points) sum += p.vol;
  return sum;
}

// cells at x < 0.5 have 3 x 3 points, the others 1
TEST(Split, PlacesAndVolumes)
{
  auto points = made(plane("si", "p f", "0 1 0 1") + place +
                     "variable n equal 1+2*(v_px<0.5)\nfix grid all mpm 0.25\n"
                     "create_points 1 box ppc 1 split v_n" +
                     axes_2 + "\n");
  ASSERT_EQ(points.size(), 8u * 9 + 8);
  EXPECT_NEAR(total(points), 1.0, 1e-14);
  EXPECT_NEAR(points[0].vol, 0.0625 / 9, 1e-17);
  EXPECT_NEAR(points[0].x[0], 0.25 / 6, 1e-15);
  EXPECT_NEAR(points[4].x[0], 0.125, 1e-15);
  EXPECT_NEAR(points[4].x[1], 0.125, 1e-15);
  EXPECT_NEAR(points[18].vol, 0.0625, 1e-17);
  EXPECT_NEAR(points[18].x[0], 0.625, 1e-15);
  auto deep = made(space("si", "f f f", "0 1 0 1 0 1") + place +
                   "variable n equal 1+(v_pz>0.5)\nfix grid all mpm 0.5\n"
                   "create_points 1 box ppc 1 split v_n" +
                   axes_3 + "\n");
  EXPECT_EQ(deep.size(), 4u + 4 * 8);
  EXPECT_NEAR(total(deep), 1.0, 1e-14);
}

// parts of cells whose center is outside of the region are there, too: 10 of 16 along each axis
TEST(Split, PartsOfCellsAtAFace)
{
  const auto points =
      made(plane("si", "f f", "0 1 0 1") + place +
           "variable n equal 4\nregion b block 0.2 0.8 0.2 0.8 INF INF\nfix grid all mpm 0.25\n"
           "create_points 1 region b ppc 1 split v_n" +
           axes_2 + "\n");
  EXPECT_EQ(points.size(), 100u);
  EXPECT_NEAR(total(points), 100.0 / 256.0, 1e-14);
}

// sites that are divided at the surface follow it: the volume of a ball
TEST(Split, SurfaceOfABall)
{
  const double exact = 4.0 / 3.0 * 3.14159265358979323846 * 0.4 * 0.4 * 0.4;
  const std::string scene = space("si", "f f f", "0 1 0 1 0 1") + place +
      "variable r equal sqrt((v_px-0.5)^2+(v_py-0.5)^2+(v_pz-0.5)^2)\nregion b sphere 0.503 0.498 "
      "0.501 0.4\n"
      "fix grid all mpm 0.1\n";
  const double whole =
      measured("ppc 2", total(made(scene + "create_points 1 region b ppc 2\n")) / exact - 1.0);
  const double graded = measured("graded",
                                 total(made(scene +
                                            "variable n equal 1+3*(v_r>0.3)\n"
                                            "create_points 1 region b ppc 2 split v_n" +
                                            axes_3 + "\n")) /
                                         exact -
                                     1.0);
  const double fine =
      measured("ppc 8", total(made(scene + "create_points 1 region b ppc 8\n")) / exact - 1.0);
  EXPECT_NEAR(graded, fine, 1e-12);    // the same points where there is a surface
  EXPECT_LT(std::fabs(graded), 1e-3);
  EXPECT_LT(std::fabs(graded), std::fabs(whole));
}

TEST(Split, IsTheSameOnAllRanks)
{
  const std::string scene = plane("si", "p p", "0 1 0 1") + place +
      "variable n equal 1+round(2*v_px)\n"
      "region b sphere 0.5 0.5 0 0.33\nfix grid all mpm 0.05\ncreate_points 1 region b split v_n" +
      axes_2 + "\n";
  Scene one(scene, MPI_COMM_SELF), all(scene);
  EXPECT_TRUE(identical(one.gather(), all.gather()));
}

// a free bar swings in its first mode: change of its velocities in a period
static double error_after_period(const std::string &n)
{
  const int cells = 64;
  Scene run(
      plane("si", "f p", strprintf("-0.25 1.25 0 %.17g", 4.0 / cells)) + place +
      "variable n equal " + n +
      strprintf(
          "\nregion bar block 0 1 INF INF INF INF\nfix grid all mpm %.17g transfer flip 1.0\n",
          1.0 / cells) +
      "create_points 1 region bar ppc 1 split v_n" + axes_2 +
      "\nfix m all mpm/material density 1 linear 1 0\nvariable v atom 1e-4*cos(PI*x)\n"
      "velocity all set v_v 0 NULL\ntimestep 0.002\n");
  const auto before = run.gather();
  run.commands("run 1000\n");
  const auto after = run.gather();
  double sum = 0.0, scale = 0.0;
  for (std::size_t k = 0; k < before.size(); k++) {
    const double d = after[k].v[0] - before[k].v[0];
    sum += before[k].vol * d * d;
    scale += before[k].vol * before[k].v[0] * before[k].v[0];
  }
  return std::sqrt(sum / scale);
}

// waves go through a change of the distance of points as through the bar with the larger one
SERIAL_TEST(Split, WavesPass)
{
  const double two = measured("2 points per axis", error_after_period("2"));
  const double four = measured("4 points per axis", error_after_period("4"));
  const double graded = measured("2 to 4", error_after_period("2+2*(v_px>0.5)"));
  EXPECT_LT(two, 0.001);
  EXPECT_LT(four, 0.002);
  EXPECT_LT(graded, 1.5 * std::max(two, four));
}

TEST(Split, Mistakes)
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const std::string scene = plane("si", "f f", "0 1 0 1") + place +
      "variable n equal 2\nvariable half equal 1.5\nvariable none equal 0\n"
      "region b block 0 1 0 1 INF INF\nfix grid all mpm 0.1\ncreate_points 1 region b split ";
  const std::vector<std::array<std::string, 2>> cases = {
      {"v_n", "missing|expects"},
      {"v_no v_px v_py", "split v_no: there is no such variable"},
      {"n v_px v_py", "split n: there is no such variable; expected v_name"},
      {"v_px v_px v_py", "variable px is .*, but must be an integer"},
      {"v_n v_n v_py", "v_n: variable must be of style internal"},
      {"v_half v_px v_py", "variable half is 1.5 at .*, but must be an integer"},
      {"v_none v_px v_py", "must be an integer from 1 to 1000"},
      {"v_n v_px v_py cut yes", "use one of the two"},
      {"v_n v_px v_py jitter 0.1 4", "use one of the two"},
  };
  for (const auto &[words, expected] : cases)
    EXPECT_TRUE(contains(answer(scene + words + "\n"), expected)) << words << "\n"
                                                                  << answer(scene + words + "\n");
  // the box ends within a cell
  EXPECT_TRUE(contains(answer(plane("si", "f f", "0 0.96 0 1") + place +
                              "variable n equal 2\nfix grid all mpm 0.1\n"
                              "create_points 1 box ppc 1 split v_n v_px v_py\n"),
                       "10 points of sites at faces of the box|20 points of sites"));
}

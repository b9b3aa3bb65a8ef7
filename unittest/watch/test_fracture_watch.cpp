// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics ranks
// mpi: 1 2

// Keyword apart of fix mpm: a solid whose points share too few nodes is told of, nothing else.

#include "bad_input_testing.h"

#include <regex>

using namespace MPM_TEST;

constexpr const char *SOFT = "neohookean 1e-4 0.3";

struct Told {
  int warnings = 0;
  double cells = 0.0;    ///< between points
};

/** A block of points, two per cell and axis, flies apart along an axis with a linear velocity; it
 *  is so soft that nothing slows it, but its strain is that of the stretch. */
Told told_by(double stretch, const std::string &grid = "", const std::string &material = SOFT,
             double direction = 0.1, int axis = 0)
{
  const char *const extents[] = {"-16 16 0 4", "0 4 -16 16", "0 3 0 3 -16 16"};
  const char *const regions[] = {"block -4 4 INF INF INF INF", "block INF INF -4 4 INF INF",
                                 "block INF INF INF INF -4 4"};
  const ScratchFile file("log");
  Scene run("log " + file.name + "\n" +
            (axis < 2 ? plane("lj", "p p", extents[axis], 1, 0.5)
                      : space("lj", "p p p", extents[axis], 1, 0.5)) +
            body(regions[axis], "density 1 " + material, "1.0 " + grid) +
            strprintf("variable pull atom %.17g*%c\nvelocity all set %s\ntimestep 0.02\n"
                      "run %.0f\nlog none\n",
                      direction, "xyz"[axis],
                      axis == 0       ? "v_pull 0 0"
                          : axis == 1 ? "0 v_pull 0"
                                      : "0 0 v_pull",
                      (stretch - 1.0) / (0.02 * direction)));
  Told told;
  MPI_Barrier(MPI_COMM_WORLD);    // the first rank writes the file
  const std::string text = file_text(file.name);
  const std::regex message(
      "WARNING: .* under tension .* ([-+.e0-9]+) node spacings \\(([-+.e0-9]+)\\) apart");
  for (std::sregex_iterator at(text.begin(), text.end(), message), end; at != end; ++at) {
    told.warnings++;
    told.cells = std::stod((*at)[1]);
    EXPECT_NEAR(std::stod((*at)[2]), told.cells, 0.006);    // the spacing is 1
  }
  return told;
}

TEST(FractureWatch, TellsHowFarPointsAreApart)
{
  // half a spacing at the start; the limit is 1.2, or 1.0 for gimp
  EXPECT_EQ(told_by(2.3).warnings, 0);
  const Told told = told_by(2.5);
  EXPECT_EQ(told.warnings, 1);
  EXPECT_NEAR(told.cells, 1.25, 0.05);    // points at the free ends are stretched a little more
  EXPECT_EQ(told_by(1.9, "shape gimp").warnings, 0);
  EXPECT_EQ(told_by(2.1, "shape gimp").warnings, 1);
  EXPECT_EQ(told_by(2.2, "shape cubic").warnings, 0);
  EXPECT_EQ(told_by(2.4, "shape cubic").warnings, 1);
}

TEST(FractureWatch, LooksAlongAllAxes)
{
  for (const int axis : {1, 2}) {
    const Told told = told_by(2.5, "", SOFT, 0.1, axis);
    EXPECT_EQ(told.warnings, 1) << axis;
    EXPECT_NEAR(told.cells, 1.25, 0.05) << axis;
  }
}

TEST(FractureWatch, IsSilentWhereNothingBreaks)
{
  EXPECT_EQ(told_by(2.5, "apart ignore").warnings, 0);
  for (const char *grid : {"frame total", "shape cpdi", "shape cpdi2"})
    EXPECT_EQ(told_by(2.5, grid).warnings, 0) << grid;
  // fluids and grains without cohesion part, and nearly molten metal: all its tension is pressure
  for (const char *material :
       {"eos linear 1e-4", "eos tait 1e-4 7 viscosity newtonian 1e-4", "drucker/prager 1e-4 0.3 30",
        "eos linear 1e-4 strength j2 1e-4 1e-9"})
    EXPECT_EQ(told_by(2.5, "", material).warnings, 0) << material;
  EXPECT_EQ(told_by(0.35, "", SOFT, -0.1).warnings, 0);    // pressed together
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input smoke
// timeout: 900

// Mistakes in scenes with several bodies and grains: each gives an error, or a warning where the
// scene may be meant, that says what is wrong. A case is the good scene with one thing changed.

#include "bad_input_testing.h"
#include "mesh/stl_testing.h"

#include <regex>
#include <sstream>

using namespace MPM_TEST;

/** Two blocks (fields F1 and F2), one on the other, and a grain above them. */
static const std::string good_scene = R"(
units lj
boundary f f f
atom_style hybrid sphere mpm
neighbor 0.3 multi
comm_modify vel yes mode multi
region box block 0 8 0 8 0 12
create_box 3 box
region b1 block 1 7 1 7 0 3
region b2 block 2 6 2 6 3 5
create_points 1 region b1 spacing 0.5
create_points 2 region b2 spacing 0.5
create_atoms 3 single 4 4 6.05
group low type 1
group high type 2
group body type 1 2
group grain type 3
set group grain diameter 2 density 2
fix F1 low mpm 1.0
fix F2 high mpm 1.0
fix m1 low mpm/material density 1.0 neohookean 30.0 0.3
fix m2 high mpm/material density 1.0 neohookean 20.0 0.3
fix c all mpm/contact F1 F2 law coulomb 0.3
fix floor all mpm/boundary zlo stick
fix surf body mpm/surface
pair_style granular
pair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4
neigh_modify exclude group body body
velocity grain set 0 0 -0.5
fix move grain nve/sphere
timestep 0.01
thermo 5
run 3
)";

// what stands in the scene and is replaced
static const char *const STYLE = "atom_style hybrid sphere mpm\n";
static const char *const VEL = "comm_modify vel yes mode multi\n";
static const char *const F1 = "fix F1 low mpm 1.0\n";
static const char *const F2 = "fix F2 high mpm 1.0\n";
static const char *const M1 = "fix m1 low mpm/material density 1.0 neohookean 30.0 0.3\n";
static const char *const CONTACT = "fix c all mpm/contact F1 F2 law coulomb 0.3\n";
static const char *const FLOOR = "fix floor all mpm/boundary zlo stick\n";
static const char *const SURFACE = "fix surf body mpm/surface\n";
static const char *const PAIR =
    "pair_style granular\n"
    "pair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4\n";
static const char *const RUN = "run 3\n";

class BadCoupling : public ::testing::TestWithParam<Change> {};

TEST(GoodCoupling, Runs)
{
  EXPECT_EQ(error_of(good_scene), "");
}

TEST_P(BadCoupling, IsExplained)
{
  expect_explained(good_scene, GetParam());
}

static const Change field_mistakes[] = {
    {"LatticesDiffer", F2, "fix F2 high mpm 0.5\n",
     "F1 and F2 must have the same lattice.*pair style"},
    {"OriginsDiffer", F2, "fix F2 high mpm 1.0 origin 0.5 0 0\n",
     "F1 and F2 must have the same lattice"},
    {"ShapesDiffer", F2, "fix F2 high mpm 1.0 shape cubic\n",
     "must have the same lattice.*shape function"},
    {"TotalFrame", F2, "fix F2 high mpm 1.0 frame total\n",
     "frame total of fix mpm F2.*pair style"},
    {"EveryDiffers", F2, "fix F2 high mpm 1.0 every 5\n", "the same every: F1 and F2 differ"},
    {"SchemesDiffer", F2, "fix F2 high mpm 1.0 scheme musl\n", "the same scheme: F1 and F2 differ"},
    {"FieldUnknown", CONTACT, "fix c all mpm/contact F1 F3\n",
     "F3 is not the ID of a fix mpm: define one"},
    {"FieldIsAGroup", CONTACT, "fix c all mpm/contact low high\n",
     "low is not the ID of a fix mpm"},
    {"FieldTwice", CONTACT, "fix c all mpm/contact F1 F1\n", "field F1 is named twice"},
    {"ContactOfAGroup", CONTACT, "fix c body mpm/contact F1 F2\n", "use group all"},
    {"ContactTwice", RUN, "fix d all mpm/contact F2 F1\nrun 3\n", "counted twice"},
    {"FieldRemoved", RUN, "run 1\nunfix F2\nrun 1\n", "F2 is not the ID of a fix mpm"},
    {"FieldOfGrains", F1, "fix F1 grain mpm 1.0\n",
     "F1 has no material points: its group grain has no atoms with a volume"},
    {"FieldsShareTheirPoints", F1, "fix F1 body mpm 1.0\n",
     "256 material points of fix F[12] \\(style mpm\\) are also integrated by fix F[12] \\(style "
     "mpm\\)"},
    {"MaterialsShareTheirPoints", M1, "fix m1 body mpm/material density 1.0 neohookean 30.0 0.3\n",
     "256 material points have more than one material, for instance point"},
    {"MaterialOfTheGrains", M1, "fix m1 grain mpm/material density 1.0 neohookean 30.0 0.3\n",
     "864 material points have no material, for instance point"},
    {"WallOfAnUnknownField", FLOOR, "fix floor all mpm/boundary zlo stick field F9\n",
     "field F9 is not the ID of a fix mpm"},
    {"WallTwice", RUN, "fix w all mpm/boundary zlo slip\nrun 3\n",
     "Face zlo belongs to.*floor and w"},
    {"WallOfADeletedRegion", RUN,
     "region w block 0 8 0 8 0 1\nfix w all mpm/boundary region w stick\nregion w delete\nrun 3\n",
     "Region w for fix mpm/boundary does not exist"},
    {"WallBeforeItsRegion", RUN,
     "fix w all mpm/boundary region w stick\nregion w block 0 8 0 8 0 1\nrun 3\n",
     "Region w for fix mpm/boundary does not exist: define it before"},
};
INSTANTIATE_TEST_SUITE_P(Fields, BadCoupling, ValuesIn(field_mistakes), case_name);

static const Change grains[] = {
    {"NoVelocitiesOfGhosts", VEL, "comm_modify mode multi\n",
     "requires ghost atoms store velocity"},
    {"NoRadii", STYLE, "atom_style mpm\n", "diameter for atom style mpm"},
    {"MpmBeforeSphere", STYLE, "atom_style hybrid mpm sphere\n", "mpm must come after sphere"},
    {"PointsWithoutRadius", SURFACE, "set group body diameter 0\n",
     "Points of fix mpm F1 have no radius.*pair style granular.*fix mpm/surface"},
    {"RadiusOfOtherUnits", SURFACE, "set type 2 diameter 20\n",
     "256 points of fix mpm F2 have a radius of more than two node spacings, for instance point"},
    {"CutoffBelowTheRadii", PAIR,    // as after read_restart, which knows none: then it is mostly 0
     "pair_style granular\npair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4 "
     "cutoff 1.2\n",
     "Cutoff 1\\.2 of pair style granular between points of type 1 and grains of type 3 is below "
     "the "
     "sum 1\\.3 of their largest radii.*give pair_style and pair_coeff again"},
    {"GrainsWithoutRadius", RUN, "set group grain diameter 0\nrun 3\n",
     "requires extended particles"},
    {"NveOfPoints", RUN, "fix more all nve\nrun 3\n",
     "864 material points of fix F1 .* also integrated by fix more \\(style nve\\): give the fixes "
     "disjoint"},
    {"NveSphereOfPoints", "fix move grain nve/sphere", "fix move all nve/sphere",
     "also integrated by fix move \\(style nve/sphere\\)"},
    {"RigidPoints", RUN, "fix more high rigid single\nrun 3\n",
     "256 material points of fix F2 .* also integrated by fix more \\(style rigid\\)"},
    {"SurfaceOfGrains", SURFACE, "fix surf grain mpm/surface\n",
     "surf has no material points: its group grain has no atoms with a volume"},
    {"SurfaceTwice", SURFACE, "fix surf body mpm/surface\nfix more body mpm/surface\n",
     "(surf|more) and (surf|more) have points in common: give them disjoint groups"},
    {"SurfacesShareTheirPoints", SURFACE, "fix surf body mpm/surface\nfix more low mpm/surface\n",
     "have points in common"},
    {"RadiusSetAfterTheSurface", RUN, "set type 1 diameter 0.1\nrun 3\n",
     "define the fix after them"},
    {"PairsWithoutCoefficients", PAIR,
     "pair_style granular\npair_coeff 3 3 hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4\n",
     "All pair coeffs are not set"},
    {"PenaltyWithoutCoefficients", RUN,
     "unfix c\npair_style mpm/penalty\npair_coeff 1 1 50\nrun 3\n",
     "no pair_coeff for types 1 and 2"},
    {"TimeStepOfTheBodies", "timestep 0.01\n", "timestep 0.5\n",
     "Time step 0\\.5 is above the limit"},
    {"Respa", RUN, "run_style respa 2 2\nrun 3\n", "requires run_style verlet"},
    {"Minimize", RUN, "minimize 0 0 10 10\n", "minimize before the fix is defined"},
};
INSTANTIATE_TEST_SUITE_P(Grains, BadCoupling, ValuesIn(grains), case_name);

// material files of two bodies: each must be in the units of the input
TEST(MaterialFiles, OfMixedUnits)
{
  const ScratchFile file("steel.mpm", "# UNITS: si\ndensity 7850 linear 200e9 0.3\n");
  const std::string text =
      error_of(changed(good_scene, M1, "fix m1 low mpm/material file " + file.name + "\n"));
  EXPECT_THAT(text, HasSubstr("is in si units but the input uses lj units"));
}

// rigid bodies
TEST(RigidBodies, Refused)
{
  const ScratchFile file("box.stl", text_of(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0})));
  const std::string shape = "region shape mpm/mesh " + file.name + " 1.0 4 4 8\n";
  const std::string rigid = shape + "fix tool all mpm/rigid shape density 2.0 slip\n";
  for (const auto &mistake : {
           Mistake{rigid + "region shape delete\nrun 3\n", "shape"},
           Mistake{shape + "fix tool grain mpm/rigid shape density 2.0 slip\nrun 3\n",
                   "use group all"},
           Mistake{"fix tool all mpm/rigid shape density 2.0 slip\n" + shape + "run 3\n",
                   "region shape does not exist"},
           Mistake{
               "region ball sphere 4 4 8 1\nfix tool all mpm/rigid ball density 2.0 slip\nrun 3\n",
               "mpm/mesh"},
           Mistake{rigid + "unfix c\nunfix floor\nunfix F1\nunfix F2\nunfix surf\nrun 3\n",
                   "Fix mpm/rigid needs a fix mpm"},
       })
    EXPECT_THAT(error_of(changed(good_scene, RUN, mistake.lines)), HasSubstr(mistake.message))
        << mistake.lines;
  const std::string flat = plane("lj", "p p", "0 8 0 8") + "fix grid all mpm 1.0\n";
  expect_error(flat + rigid, "in 2d, move a region with fix mpm/boundary");
}

// -------------------------------------------- bodies that overlap at the start

/** What the good scene says with this before its run. */
static std::string said(const std::string &lines)
{
  ::testing::internal::CaptureStdout();
  {
    const char *args[] = {"mpm_test", "-log", "none", "-nocite"};
    LAMMPS_NS::LAMMPS lmp(4, const_cast<char **>(args), MPI_COMM_WORLD);
    std::istringstream text(changed(good_scene, RUN, lines + RUN));
    for (std::string line; std::getline(text, line);)
      if (!line.empty()) lmp.input->one(line);
  }
  return ::testing::internal::GetCapturedStdout();
}

TEST(Overlap, IsReported)
{
  const std::string words =
      "bodies F1 and F2 overlap at the start of the run, for instance points ";
  EXPECT_THAT(said(""), ::testing::Not(HasSubstr("overlap")));
  // touching bodies may be compressed, and interlock by less than half a cell
  EXPECT_THAT(said("displace_atoms high move 0 0 -0.25\n"), ::testing::Not(HasSubstr("overlap")));
  for (const char *lines :
       {"displace_atoms high move 0 0 -1.0\n", "displace_atoms high move 0.3 0.2 -2.0\n",
        "unfix c\nfix c all mpm/contact F1 F2 gap no\n"
        "displace_atoms high move 0 0 -1.0\n"}) {
    const std::string text = said(lines);
    const auto found = std::regex_search(
        text,
        std::regex(
            "Fix mpm/contact c: bodies F[12] and F[12] overlap at the start of the run, for "
            "instance points [1-9][0-9]* and [1-9][0-9]* near [0-9. ]+: .*does not part them"));
    EXPECT_TRUE(found) << lines << text;
  }
  // create_points does not let it happen
  expect_error(changed(good_scene, "b2 block 2 6 2 6 3 5", "b2 block 2 6 2 6 2 4"), "overlap yes");
}

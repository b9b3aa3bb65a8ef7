// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: input smoke
// timeout: 900

// Every mistake in an input gives an error that says what is wrong, and no crash and no endless
// loop; where the scene may be meant, a warning. A case is a good scene with one thing changed.

#include "bad_input_testing.h"
#include "mesh/stl_testing.h"

#include "error.h"
#include "exceptions.h"

#include <regex>

using namespace MPM_TEST;

static const std::string good_scene = space("lj", "f f f", "0 8 0 8 0 8", 2) + R"(
fix grid all mpm 1.0
region body block 2 5 2 5 2 5
create_points 1 region body ppc 2
fix soft all mpm/material density 1.0 neohookean 10.0 0.3
velocity all set 0.1 0 0
timestep 0.01
thermo 5
run 10
)";

/** The scene with this before its run. */
static std::string before_run(const std::string &lines, const std::string &run = "run 10\n")
{
  return changed(good_scene, "run 10\n", lines + "\n" + run);
}

// the word that is wrong is marked in the line of the input
TEST(Message, MarksTheWord)
{
  for (const std::string wrong : {"-1.5", "sliip", "NULL"}) {
    const std::string line = "fix w all mpm/boundary zlo slip friction " + wrong + " heat no";
    Scene run;
    std::istringstream lines(run.error(before_run(line)));
    std::string shown, marks;
    while (std::getline(lines, marks) && marks.find('^') == std::string::npos) shown = marks;
    ASSERT_NE(marks.find('^'), std::string::npos) << wrong;
    EXPECT_EQ(marks.find('^'), shown.find(wrong)) << shown << "\n" << marks;
    EXPECT_EQ(std::count(marks.begin(), marks.end(), '^'), (int) wrong.size());
  }
}

class BadInput : public ::testing::TestWithParam<Change> {};

TEST_P(BadInput, IsExplained)
{
  expect_explained(good_scene, GetParam());
}

TEST(GoodInput, Runs)
{
  EXPECT_EQ(answer(good_scene), "");
  EXPECT_EQ(answer(before_run("")), "");
}

// what stands in the scene and is replaced
static const char *const FIX = "fix grid all mpm 1.0\n";
static const char *const BOUNDARY = "boundary f f f\n";
static const char *const STYLE = "atom_style mpm\n";
static const char *const BOX = "region box block 0 8 0 8 0 8\ncreate_box 2 box\n";
static const char *const POINTS = "create_points 1 region body ppc 2\n";
static const char *const MATERIAL = "fix soft all mpm/material density 1.0 neohookean 10.0 0.3\n";
static const char *const TIMESTEP = "timestep 0.01\n";
static const char *const RUN = "run 10\n";

static const auto keywords = mistakes_in(
    FIX, "fix grid all mpm",
    {
        {"HMissing", "", "Illegal fix mpm command: missing argument"},
        {"HText", "coarse", "[Ee]xpected floating.point.*coarse"},
        {"HZero", "0", "node spacing must be positive: 0"},
        {"HNegative", "-1.0", "node spacing must be positive: -1"},
        {"HNan", "nan", "nan"},
        {"HInfinite", "1e999", "positive|out of range"},
        {"HLargerThanBox", "8.5", "spacing 8\\.5 is larger than the box length 8 along x"},
        {"HTiny", "1e-12", "spacing 1e-12 is too small for the box length 8"},
        {"KeywordTypo", "1.0 shap linear", "Unknown fix mpm keyword: shap"},
        {"KeywordExtra", "1.0 shape linear 3", "Unknown fix mpm keyword: 3"},
        {"ShapeMissing", "1.0 shape", "Illegal fix mpm shape command: missing argument"},
        {"ShapeUnknown", "1.0 shape quintic",
         "Unknown fix mpm shape quintic: must be one of linear quadratic cubic"},
        {"TransferMissing", "1.0 transfer", "Illegal fix mpm transfer command: missing argument"},
        {"TransferUnknown", "1.0 transfer xflip",
         "Unknown fix mpm transfer xflip: must be one of pic flip apic"},
        {"FlipShareMissing", "1.0 transfer flip",
         "Illegal fix mpm transfer flip command: missing argument.*needs share"},
        {"FlipShareText", "1.0 transfer flip shape linear", "[Ee]xpected floating.point.*shape"},
        {"FlipShareTooLarge", "1.0 transfer flip 1.5", "flip share must be within 0 and 1: 1\\.5"},
        {"FlipShareNegative", "1.0 transfer flip -0.1",
         "flip share must be within 0 and 1: -0\\.1"},
        {"SchemeMissing", "1.0 scheme", "Illegal fix mpm scheme command: missing argument"},
        {"SchemeUnknown", "1.0 scheme verlet",
         "Unknown fix mpm scheme verlet: must be one of usl usf musl"},
        {"OriginMissing", "1.0 origin 0 0", "Illegal fix mpm origin command: missing argument"},
        {"OriginText", "1.0 origin 0 0 middle", "[Ee]xpected floating.point.*middle"},
        {"OriginFarAway", "1.0 origin 1e30 0 0", "its origin 1e\\+?30 is too far away"},
        {"PolicyMissing", "1.0 bad", "Illegal fix mpm bad command: missing argument"},
        {"PolicyUnknown", "1.0 bad ignore",
         "Unknown fix mpm bad ignore: must be one of error warn delete"},
        {"DtcheckMissing", "1.0 dtcheck", "Illegal fix mpm dtcheck command: missing argument"},
        {"DtcheckNoBoolean", "1.0 dtcheck maybe", "[Ee]xpected boolean.*maybe"},
        {"KernelsMissing", "1.0 kernels", "Illegal fix mpm kernels command: missing argument"},
        {"KernelsUnknown", "1.0 kernels sse9",
         "Unknown fix mpm kernels sse9: must be one of auto reference baseline avx2 avx512"},
    });
INSTANTIATE_TEST_SUITE_P(Keywords, BadInput, ValuesIn(keywords), case_name);

static const Change boxes[] = {
    {"NoBox", BOX, "region box block 0 8 0 8 0 8\n", "before simulation box is defined"},
    {"PeriodicLengthNoMultiple", FIX, "change_box all boundary p f f\nfix grid all mpm 0.3\n",
     "Length 8 of the box along periodic axis x must be a multiple of the node spacing 0\\.3: "
     "the nearest valid spacing is 0\\.29629629629629"},
    {"ShrinkWrapped", BOUNDARY, "boundary f s f\n",
     "periodic or fixed boundaries \\(p or f\\), but axis y is shrink-wrapped"},
    {"ShrinkWrappedWithMinimum", BOUNDARY, "boundary f f fm\n", "but axis z is shrink-wrapped"},
    {"Triclinic", BOX, "region box prism 0 8 0 8 0 8 1 0 0\ncreate_box 2 box\n",
     "requires an orthogonal box"},
    {"WrongAtomStyle", STYLE, "atom_style atomic\n", "use atom_style mpm, or hybrid with mpm"},
    {"HybridWithoutMpm", STYLE, "atom_style hybrid sphere\n",
     "use atom_style mpm, or hybrid with mpm"},
    {"NoIds", STYLE, "atom_style mpm\natom_modify id no\n",
     "by their IDs: remove atom_modify id no"},
    {"TriclinicLater", RUN, "run 1\nchange_box all triclinic\nrun 1\n",
     "requires an orthogonal box"},
    {"ShrinkWrappedLater", RUN, "run 1\nchange_box all boundary f f s\nrun 1\n",
     "but axis z is shrink-wrapped"},
    {"PeriodicLater", RUN,
     "run 1\nchange_box all x final 0 8.4\nchange_box all boundary p f f\nrun 1\n",
     "Length 8\\.4 of the box along periodic axis x must be a multiple"},
    {"BoxDeforms", "", "fix d all deform 1 x scale 1.1",
     "box of constant size and shape: remove the fix"},
    {"Barostat", "",
     "change_box all boundary p p p\ngroup none empty\nfix b none nph iso 1.0 1.0 1.0",
     "box of constant size and shape: remove the fix"},
    {"Respa", "", "run_style respa 2 2", "requires run_style verlet"},
    {"RunWithinARun", RUN, "run 4 every 2 \"run 0\"\n",
     "Fix mpm has not been set up for this step: .*use a loop of runs"},
    {"Minimize", RUN, "minimize 0 0 10 10\n", "[Ff]ix mpm.*minimiz"},
};
INSTANTIATE_TEST_SUITE_P(Boxes, BadInput, ValuesIn(boxes), case_name);

static const auto materials = mistakes_in(
    MATERIAL, "fix soft all mpm/material",
    {
        {"DensityZero", "density 0 linear 10.0 0.3", "RHO = 0 .*out of range: 0 < VALUE"},
        {"DensityNegative", "density -1 linear 10.0 0.3", "RHO = -1 .*out of range: 0 < VALUE"},
        {"DensityMissing", "linear 10.0 0.3", "density is missing: add 'density RHO'"},
        {"ParameterMissing", "density 1.0 linear 10.0",
         "linear: NU is missing \\(Poisson's ratio\\)"},
        {"ParameterOutOfRange", "density 1.0 linear 10.0 0.5",
         "NU = 0\\.5 .*out of range: -1 < VALUE < 0\\.5"},
        {"RandomOutOfRange", "density 1.0 linear 10.0 0.3 random E normal 0.9 0.5 7",
         "random(: .*FFTW| E is -.*out of range: use lognormal)"},
        {"RandomTooShort", "density 1.0 linear 10.0 0.3 random E lognormal 0.3 1e-20 7",
         "random: (.*FFTW|the correlation length is too short)"},
        {"LawUnknown", "density 1.0 cheese 10.0 0.3",
         "unknown keyword 'cheese': expected density, "},
        {"MaterialFileMissing", "file nothing.mpm",
         "cannot read file nothing\\.mpm: .*LAMMPS_POTENTIALS"},
    });
INSTANTIATE_TEST_SUITE_P(Materials, BadInput, ValuesIn(materials), case_name);

static const Change definitions[] = {
    {"GroupUnknown", FIX, "fix grid nobody mpm 1.0\n", "group ID.*nobody"},
    {"GroupDynamic", FIX, "group moving dynamic all every 10\nfix grid moving mpm 1.0\n",
     "dynamic group"},

    {"NoMaterial", MATERIAL, "", "found no material: define one with fix mpm/material"},
    {"MaterialRemoved", RUN, "run 1\nunfix soft\nrun 1\n", "found no material"},
    {"NoMaterialForSome", MATERIAL,
     "group half id <= 100\nfix soft half mpm/material density 1.0 linear 10.0 0.3\n",
     "116 material points have no material, for instance point [0-9]+: "
     "define a fix mpm/material for their group"},
    {"TwoMaterials", "",
     "group half id <= 100\nfix hard half mpm/material density 1.0 linear 99.0 0.3",
     "100 material points have more than one material, for instance point [0-9]+: .*disjoint"},
    {"MassNotFinite", "", "variable big atom 1e308*10\nset group all mass v_big",
     "216 material points have no positive mass, for instance point [0-9]+: "
     "check the density of their material or their set mass"},
    {"FixNveOnPoints", "", "fix move all nve",
     "216 material points of fix grid \\(style mpm\\) are also integrated by fix move \\(style "
     "nve\\): give the fixes disjoint groups"},
    {"RigidPoints", "", "fix move all rigid single",
     "also integrated by fix move \\(style rigid\\): give the fixes disjoint groups"},
    {"TwoFixMpmOnPoints", "", "fix more all mpm 1.0",
     "also integrated by fix (more|grid) \\(style mpm\\): give the fixes disjoint groups"},
    {"SchemesDiffer", POINTS,
     "create_points 1 region body ppc 2 fix grid\ngroup one type 1\nunfix grid\n"
     "region other block 6 7 6 7 6 7\nfix a one mpm 1.0\n"
     "create_points 2 region other ppc 2\ngroup two type 2\nfix b two mpm 1.0 scheme musl\n",
     "must have the same scheme: a and b differ"},
    {"NoPoints", "", "delete_atoms group all",
     "no material points.* make points with create_points"},
    {"GroupWithoutPoints", "", "group none empty\nfix more none mpm 1.0",
     "Fix mpm more has no material points: its group none .* make points with create_points"},
    {"AtomsAreNoPoints", POINTS, "create_atoms 1 random 10 4711 body\n",
     "no material points.*set \\.\\.\\. volume"},
};
INSTANTIATE_TEST_SUITE_P(Definitions, BadInput, ValuesIn(definitions), case_name);

static const Change steps[] = {
    {"TimeStepZero", TIMESTEP, "timestep 0.0\n", "positive time step: 0"},
    {"TimeStepNegative", TIMESTEP, "timestep -0.01\n", "positive time step: -0\\.01"},
    {"TimeStepTooLarge", TIMESTEP, "timestep 0.3\n",
     "Time step 0\\.3 is above the limit h/\\(c\\+\\|v\\|\\) = 0\\.265[0-9]* at step 0: "
     "Material point [0-9]+ at .*wave speed 3\\.66[0-9]*; use timestep, fix mpm/dt"},
    {"TimeStepTooLargeLater", RUN,
     "change_box all boundary p p p\ntimestep 0.1\nfix kick all addforce 1.0 0 0\nrun 100\n",
     "Time step 0\\.1 is above the limit .* at step 20: Material point [0-9]+ at .*velocity 16"},
    {"VelocityNotFinite", "", "variable big atom 1e308*10\nvelocity all set v_big 0 0",
     "216 material points have a position, velocity, .* not finite .* for instance point [0-9]+"},
    {"ForceNotFinite", "", "variable big equal 1e308*10\nfix kick all addforce v_big 0 0",
     "Material point [0-9]+ at .*velocity .*J = .* at step 1"},
    {"PointOutsideAtStart", "", "set atom 7 x 9.5",
     "Material point 7 at 9\\.5 .*with velocity .*J = 1 has left the box.* fixed face; enlarge the "
     "box, put a fix mpm/boundary there, or let it go with fix mpm \\.\\.\\. bad delete"},
    {"PointLeavesTheBox", RUN, "velocity all set 3 0 0\nrun 200\n",
     "Material point [0-9]+ at 8\\.0.* with velocity 3 (-?0|-?[0-9.]+e-1[0-9]) .* and J = .* has "
     "left the box"},
    {"PointInverted", "",
     "fix grid all mpm 1.0 dtcheck no\nvelocity all ramp vx 5 -5 x 2 5\ntimestep 0.5",
     "Material point [0-9]+ at .*has a deformation gradient of determinant -.* at step 1: try a "
     "smaller time step \\(fix mpm/dt\\)"},
};
INSTANTIATE_TEST_SUITE_P(Steps, BadInput, ValuesIn(steps), case_name);

static const Change companions[] = {
    {"PointsOutside", POINTS, "region far block 6 9 2 5 2 5\ncreate_points 1 region far ppc 2\n",
     "reaches beyond the simulation box: [0-9]+ points.*outside ignore"},
    {"PointsOverlap", "", "create_points 2 region body ppc 2",
     "refuses overlapping bodies: .*overlap yes"},
    {"DtBelowMinimum", "", "fix dt all mpm/dt 0.5 min 0.2",
     "time step 0\\.13[0-9]* needed by point [0-9]+ .*below min 0\\.2"},
    {"DtTooSmall", "", "fix dt all mpm/dt 1e-200",
     "time step [0-9.e-]+ is below the smallest one of fix mpm, 1e-150"},
    {"TimestepTooSmall", "", "timestep 1e-200",
     "Time step 1e-200 is below the smallest one of fix mpm, 1e-150"},
    {"ComputeQuantityUnknown", "", "compute p all mpm/atom presure",
     "Unknown quantity presure in compute p.*known are:.* pressure"},
    {"ComputeEnergyOfGroup", "", "group some type 1\ncompute e some mpm/energy",
     "requires group all"},
    {"ThermoColumnUnknown", "", "compute e all mpm/energy\nthermo_style custom step c_e[99]",
     "c_e.*99|Thermo compute vector is accessed out-of-range"},
    {"DumpWithoutWildcard", "", "dump d all mpm/vtk 5 points.vtp pressure",
     "one file per snapshot: put a \\* into the file name"},
    {"DumpOfUnknownFix", "", "dump d all mpm/grid/vtk 5 nodes.*.vtu grud mass",
     "fix ID grud does not exist"},
};
INSTANTIATE_TEST_SUITE_P(Companions, BadInput, ValuesIn(companions), case_name);

// What runs but does nothing, or harm: one warning in each run; and inputs like it that are fine.
static const char *const SKIN = "neighbor 0.5 bin\n";
static const Change doubts[] = {
    {"None", RUN, RUN, ""},
    {"NoTimeStep", TIMESTEP, "",
     "time step 1e-08, which no command has set since units si or read_restart, .* limit "
     "0\\.26[0-9]* .*: use fix mpm/dt 0\\.5"},
    {"SmallTimeStep", TIMESTEP, "timestep 1e-8\n",
     "time step 1e-08 is far below the limit 0\\.26[0-9]* of .* would take 1[0-9]{7} times fewer"},
    {"SmallTimeStepForHeat", TIMESTEP,
     "unfix soft\nfix soft all mpm/material density 1.0 neohookean 10.0 0.3 thermal conducting 1.0 "
     "0.0 1.0\nfix heat all mpm/heat\ntimestep 1e-8\n",
     ""},
    {"TimeStepOfFix", TIMESTEP, "fix dt all mpm/dt 0.5\n", ""},
    {"SmallTimeStepOfFix", TIMESTEP, "fix dt all mpm/dt 0.5 max 1e-8\n", ""},
    {"SmallTimeStepOfLAMMPS", TIMESTEP, "fix dt all dt/reset 1 1e-9 1e-8 1.0\n", ""},
    {"NoSkin", SKIN, "",
     "skin 0\\.001 is small for the node spacing 1, .*: use neighbor 0\\.5 bin"},
    {"NoSkinButRareLists", SKIN, "neigh_modify every 10\n", ""},
    {"LargeSkin", "", "neighbor 3.0 bin\npair_style zero 0.4\npair_coeff * *",
     "skin 3 is large for the cutoff 0\\.4 .* 1[0-9][0-9] pairs per atom .*, 0 of them within the "
     "cutoff, .*: use neighbor 0\\.2 bin"},
    {"LargeSkinAndCutoff", "", "neighbor 3.0 bin\npair_style zero 1.7\npair_coeff * *", ""},
    {"LargeSkinWithoutPairs", "", "neighbor 3.0 bin", ""},
    {"SetForce", "", "fix hold all setforce 0 0 0",
     "Fix hold \\(style setforce\\) has 216 material points in its group .*use fix mpm/boundary"},
    {"LineForce", "", "fix hold all lineforce 1 0 0", "use fix mpm/boundary"},
    {"SetForceOnOthers", "", "group others type 2\nfix hold others setforce 0 0 0", ""},
    {"AddForce", "", "fix push all addforce 0.1 0 0", ""},
    {"Thermostat", "", "fix heat all langevin 1 1 1 4711",
     "Fix heat \\(style langevin\\) has 216 .* they have no temperature: give it a group without"},
};

class DoubtfulInput : public ::testing::TestWithParam<Change> {};

TEST_P(DoubtfulInput, HasAWarning)
{
  const auto &[name, from, to, warning] = GetParam();
  const auto scene = changed(good_scene, "units lj\n", "units si\n" + std::string(SKIN));
  const auto found = lines_that_say(changed(scene, from, to), "WARNING");
  EXPECT_EQ(found.size(), warning.empty() ? 0 : 1) << ::testing::PrintToString(found);
  if (!warning.empty() && !found.empty()) {
    EXPECT_TRUE(contains(found[0], warning)) << "expected: " << warning << "\nfound: " << found[0];
  }
}
INSTANTIATE_TEST_SUITE_P(All, DoubtfulInput, ValuesIn(doubts), case_name);

// files: what takes the place of a line of the scene, with FILE, and what the file has in it
TEST(Files, AreExplained)
{
  const std::string material = "fix soft all mpm/material file FILE\n",
                    header = "# DATE: 2026-07-04 UNITS: lj CONTRIBUTOR: nobody\n";
  const struct {
    Change change;
    std::string text;
  } cases[] = {
      {{"bad_units.mpm", MATERIAL, material,
        "bad_units\\.mpm is in si units but the input uses lj units: convert the file or use units "
        "si"},
       replaced(header, "lj", "si") + "density 1.0 linear 10.0 0.3\n"},
      {{"no_units.mpm", MATERIAL, material,
        "first line of file .*no_units\\.mpm must give its units"},
       "# a material\ndensity 1.0 linear 10.0 0.3\n"},
      {{"bad_line.mpm", MATERIAL, material, "file .*bad_line\\.mpm line 4: .*NU = 0\\.7"},
       header + "density 1.0\n\nlinear 10.0 0.7\n"},
      {{"empty.mpm", MATERIAL, material, "density is missing"}, header},
      {{"bad.data", BOX, "read_data FILE\n", "Invalid volume -0\\.1 of atom 1 in Atoms section"},
       "negative volume\n\n1 atoms\n2 atom types\n0 8 xlo xhi\n0 8 ylo yhi\n0 8 zlo zhi\n\n"
       "Atoms # mpm\n\n1 1 1.0 -0.1 1 1 1\n"}};
  for (auto [change, text] : cases) {
    const ScratchFile file(change.name, text);
    change.to = replaced(change.to, "FILE", file.name);
    expect_explained(good_scene, change);
  }
}

// A force that is not finite reaches all nodes of a point. Transfers other than that of the motion
// take from these nodes before anybody has looked at the velocities of points: they must not move
// points, not even in no time, or the next one looks for nodes that do not exist. A point that is
// nowhere ends the run also when bad points are kept.
PARAMETER_TEST(InfiniteForce, EndsTheRun, const char *,
               Values("shape gimp scheme musl locking both",
                      "shape cubic transfer pic scheme usavg locking both",
                      "shape gimp transfer fmpm 2 locking both",
                      "shape linear transfer pic bad warn",
                      "shape cubic transfer xpic 3 scheme musl locking both",
                      "shape cpdi2 transfer xpic 3 scheme usavg locking both"))
{
  const std::string rings = plane("lj", "f p", "0 12 0 8", 1, 0.5) +
      "fix grid all mpm 1.0 axisymmetric yes " + GetParam() +
      "\nregion body block 0 5 2 6 INF INF\ncreate_points 1 region body ppc 2\n"
      "fix m all mpm/material density 2.0 neohookean 10.0 0.3\nfix axis all mpm/boundary xlo slip\n"
      "velocity all ramp vx -0.5 0.5 y 2 6\nvariable q atom (x<3)*1e308*10\n"
      "fix kick all addforce v_q 0 0\nfix dt all mpm/dt 0.3\nrun 6\n";
  EXPECT_THAT(error_of(rings), ::testing::ContainsRegex("Material point [0-9]+ at "));
}

// A force that is finite, but whose velocities have squares that are not: domains get sizes that
// are none, and corners without weights, while their points still have places
PARAMETER_TEST(HugeForce, EndsTheRun, const char *, Values("(x<3)*1e200", "1e170*(id==5)"))
{
  const std::string scene = space("lj", "p p p", "0 8 0 8 0 8", 1, 0.5) +
      "fix grid all mpm 1.0 shape cpdi2 transfer flip 1.0 scheme musl locking both bad warn "
      "dtcheck no\nregion body block 2 5 2 5 1 4\ncreate_points 1 region body ppc 2\n"
      "fix m all mpm/material density 2.0 neohookean 10.0 0.3\nvariable q atom " +
      GetParam() + "\nfix kick all addforce v_q 0 0\ntimestep 0.01\nrun 20\n";
  EXPECT_THAT(error_of(scene),
              ::testing::ContainsRegex("Material point [0-9]+ at .* has lost its position"));
}

// policies for points that go bad
class Policy : public ::testing::Test {
 protected:
  static std::string scene(const std::string &policy)
  {
    return changed(good_scene, "mpm 1.0", "mpm 1.0 dtcheck no bad " + policy);
  }
  const ScratchFile log_file{"policy.log"};
  std::string compressing(const std::string &policy)
  {
    return changed(scene(policy), RUN,
                   "velocity all ramp vx 5 -5 x 4 5\ntimestep 0.5\nlog " + log_file.name +
                       "\nrun 1\nlog none\n");
  }
};

TEST_F(Policy, WarnGoesOnAndCounts)
{
  Scene run(compressing("warn"));
  const std::string log = file_text(log_file.name);
  EXPECT_TRUE(contains(log,
                       "WARNING: Material point [0-9]+ at .*has a deformation gradient of "
                       "determinant -.* at step 1: it keeps its previous deformation"))
      << log;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(log, found,
                                std::regex("([0-9]+) bad point updates so far \\(policy warn\\)")))
      << log;
  const auto points = run.gather();
  ASSERT_EQ(points.size(), 216u);
  int kept = 0;
  for (const auto &p : points) {
    const double J = MPMPoints::det(p.F);
    EXPECT_GT(J, 0.0);
    EXPECT_GT(p.vol, 0.0);
    kept += J == 1.0 && p.F[0] == 1.0;
  }
  EXPECT_EQ(kept, std::stoi(found[1]));
  EXPECT_GT(kept, 0);
}

// an inverted point does not keep others of its block and batch from their plastic strain
TEST(PolicyWarn, OtherPointsGoOn)
{
  const auto strain = [](const std::string &fast) {
    Scene run(
        space("lj", "f f f", "0 8 0 8 0 8") +
        "fix grid all mpm 1.0 shape linear transfer flip 1.0 scheme musl dtcheck no bad warn\n"
        "region left block 4 5 4 5 4 5\nregion right block 7 8 4 5 4 5\n"
        "create_points 1 region left ppc 2\ncreate_points 1 region right ppc 2\n"
        "group left region left\ngroup right subtract all left\n"
        "fix m all mpm/material density 1.0 eos linear 20.0 strength j2 10.0 0.1\n"
        "velocity left ramp vx -0.5 0.5 y 4 5\n" +
        fast + "timestep 0.05\nrun 1\n");
    auto *material = run.material();
    const int column = material->find_history("eplastic");
    std::map<tagint, double> found;
    for (int i = 0; i < run.n(); i++)
      if (run.lmp->atom->tag[i] <= 8) found[run.lmp->atom->tag[i]] = material->history[i][column];
    int kept = 0;    // deformation of points that are inverted
    for (const auto &p : run.gather())
      kept += p.tag > 8 && p.F[0] == 1.0 && p.F[4] == 1.0 && p.v[0] != 0.0;
    return std::make_pair(found, kept);
  };
  const auto alone = strain(""), next_to = strain("velocity right ramp vx 100 -100 x 7 8\n");
  ASSERT_EQ(alone.first.size(), 8u);
  for (const auto &[tag, value] : alone.first) {
    EXPECT_GT(value, 1e-3);
    EXPECT_EQ(next_to.first.at(tag), value);
  }
  EXPECT_EQ(alone.second, 0);
  EXPECT_EQ(next_to.second, 8);
}

TEST_F(Policy, DeleteReportsMassAndMomentum)
{
  Scene warned(compressing("warn"));
  double lost_momentum = 0.0;
  int lost = 0;
  for (const auto &p : warned.gather())
    if (p.F[0] == 1.0) {    // kept: the point was bad
      lost++;
      lost_momentum += p.mass * p.v[0];
    }
  ASSERT_GT(lost, 0);
  ASSERT_LT(lost, 216);

  Scene run(compressing("delete"));
  const std::string log = file_text(log_file.name);
  EXPECT_EQ(run.gather().size(), 216u - lost);
  EXPECT_EQ(run.lmp->atom->natoms, 216 - lost);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(log, found,
                                std::regex("WARNING: Fix mpm grid deleted ([0-9]+) points of mass "
                                           "([^ ]+) and momentum ([^ ]+) ([^ ]+) "
                                           "([^ ]+) at step 1")))
      << log;
  EXPECT_EQ(std::stoi(found[1]), lost);
  EXPECT_NEAR(std::stod(found[2]), lost * 0.125, 1.0e-9);
  EXPECT_NEAR(std::stod(found[3]), lost_momentum, 1.0e-5 * std::max(1.0, std::abs(lost_momentum)));
  run.commands("timestep 0.001\nrun 10\n");    // and the run can go on
}

TEST_F(Policy, DeleteLetsPointsLeaveTheBox)
{
  Scene run(changed(changed(scene("delete"), "velocity all set 0.1", "velocity all set 3"), RUN,
                    "log " + log_file.name + "\nrun 150\nlog none\n"));
  const std::string log = file_text(log_file.name);
  double mass = 0.0, left = 0.0;
  const std::regex line("deleted ([0-9]+) points of mass ([^ ]+) and momentum ([^ ]+) ");
  for (std::sregex_iterator k(log.begin(), log.end(), line), end; k != end; ++k) {
    mass += std::stod((*k)[2]);
    EXPECT_NEAR(std::stod((*k)[3]), 3.0 * std::stod((*k)[2]), 1.0e-12);
  }
  for (const auto &p : run.gather()) {
    left += p.mass;
    EXPECT_LT(p.x[0], 8.0);
  }
  EXPECT_GT(mass, 5.0);
  EXPECT_NEAR(mass + left, 27.0, 1.0e-5);
}

TEST_F(Policy, WarnDoesNotLetPointsLeaveTheBox)
{
  const std::string text = answer(changed(scene("warn"), RUN, "velocity all set 3 0 0\nrun 200\n"));
  EXPECT_TRUE(contains(text, "has left the box")) << text;
}

// an error leaves LAMMPS usable: scripts in Python catch it and go on
TEST(AfterAnError, TheInstanceCanGoOn)
{
  Scene run(changed(good_scene, RUN, ""));
  EXPECT_THROW(run.commands("timestep 5.0\nrun 1\n"), LAMMPSException);
  run.commands("timestep 0.01\nrun 10\n");
  for (const auto &p : run.gather()) EXPECT_NEAR(p.v[0], 0.1, 1.0e-12);
}

// points that were made after their group, or whose group was not renewed; atoms without volume,
// and points that another fix moves, are meant to be what they are
TEST(PointsInNoField, HaveAWarning)
{
  const std::string scene = space("lj", "p p p", "0 8 0 8 0 8", 2) +
      "region b1 block 2 4 2 4 2 4\nregion b2 block 5 7 5 7 5 7\n"
      "create_points 1 region b1 spacing 0.5\ngroup body type 1 2\nfix grid body mpm 1.0\nMORE"
      "fix soft body mpm/material density 1.0 neohookean 10.0 0.3\ntimestep 0.01\n";
  const std::string points = "create_points 2 region b2 spacing 0.5\n";
  const std::pair<std::string, bool> cases[] = {
      {"", false},
      {points, true},
      {points + "group body type 1 2\n", false},
      {points + "group rest subtract all body\nfix move rest nve\n", false},
      {"create_atoms 2 single 6 6 6\n", false}};
  for (const auto &[more, expected] : cases) {
    Scene run(replaced(scene, "MORE", more));
    const int before = run.lmp->error->get_numwarn();
    run.commands("run 0\n");
    EXPECT_EQ(run.lmp->error->get_numwarn() - before, rank() == 0 && expected) << more;
  }
}

// -------------------------------------------- scenes with several bodies and grains

namespace Coupling {

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
    "pair_style granular\npair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4\n";
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
    {"FieldIsAGroup", CONTACT, "fix c all mpm/contact low high\n",
     "low is not the ID of a fix mpm"},
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
    {"WallTwice", "", "fix w all mpm/boundary zlo slip", "Face zlo belongs to.*floor and w"},
    {"WallOfADeletedRegion", "",
     "region w block 0 8 0 8 0 1\nfix w all mpm/boundary region w stick\nregion w delete",
     "Region w for fix mpm/boundary does not exist"},
    {"WallBeforeItsRegion", "", "fix w all mpm/boundary region w stick\nregion w block 0 8 0 8 0 1",
     "Region w for fix mpm/boundary does not exist: define it before"},
};
INSTANTIATE_TEST_SUITE_P(Fields, BadCoupling, ValuesIn(field_mistakes), case_name);

static const Change grains[] = {
    {"NoVelocitiesOfGhosts", VEL, "comm_modify mode multi\n",
     "requires ghost atoms store velocity"},
    {"NoRadii", STYLE, "atom_style mpm\n", "diameter for atom style mpm"},
    {"PointsWithoutRadius", SURFACE, "set group body diameter 0\n",
     "Points of fix mpm F1 have no radius.*pair style granular.*fix mpm/surface"},
    {"RadiusOfOtherUnits", SURFACE, "set type 2 diameter 20\n",
     "256 points of fix mpm F2 have a radius of more than two node spacings, for instance point"},
    {"CutoffBelowTheRadii", PAIR,    // as after read_restart, which knows none: then it is mostly 0
     "pair_style granular\npair_coeff * * hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4 "
     "cutoff 1.2\n",
     "Cutoff 1\\.2 of pair style granular between points of type 1 and grains of type 3 is below "
     "the sum 1\\.3 of their largest radii.*give pair_style and pair_coeff again"},
    {"GrainsWithoutRadius", "", "set group grain diameter 0", "requires extended particles"},
    {"NveOfPoints", "", "fix more all nve",
     "864 material points of fix F1 .* also integrated by fix more \\(style nve\\): give the fixes "
     "disjoint"},
    {"NveSphereOfPoints", "fix move grain nve/sphere", "fix move all nve/sphere",
     "also integrated by fix move \\(style nve/sphere\\)"},
    {"RigidPoints", "", "fix more high rigid single",
     "256 material points of fix F2 .* also integrated by fix more \\(style rigid\\)"},
    {"SurfaceOfGrains", SURFACE, "fix surf grain mpm/surface\n",
     "surf has no material points: its group grain has no atoms with a volume"},
    {"SurfaceTwice", SURFACE, "fix surf body mpm/surface\nfix more body mpm/surface\n",
     "(surf|more) and (surf|more) have points in common: give them disjoint groups"},
    {"SurfacesShareTheirPoints", SURFACE, "fix surf body mpm/surface\nfix more low mpm/surface\n",
     "have points in common"},
    {"PairsWithoutCoefficients", PAIR,
     "pair_style granular\npair_coeff 3 3 hooke 50.0 0.5 tangential linear_nohistory 0.5 0.4\n",
     "All pair coeffs are not set"},
    {"PenaltyWithoutCoefficients", "", "unfix c\npair_style mpm/penalty\npair_coeff 1 1 50",
     "no pair_coeff for types 1 and 2"},
    {"TimeStepOfTheBodies", "timestep 0.01\n", "timestep 0.5\n",
     "Time step 0\\.5 is above the limit"},
    {"Minimize", RUN, "minimize 0 0 10 10\n", "minimize before the fix is defined"},
};
INSTANTIATE_TEST_SUITE_P(Grains, BadCoupling, ValuesIn(grains), case_name);

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

/** What the good scene says of bodies that overlap, with this before its run. */
static std::vector<std::string> overlaps(const std::string &lines)
{
  return lines_that_say(changed(good_scene, "", lines), "overlap");
}

TEST(Overlap, IsReported)
{
  EXPECT_TRUE(overlaps("").empty());
  // touching bodies may be compressed, and interlock by less than half a cell
  EXPECT_TRUE(overlaps("displace_atoms high move 0 0 -0.25").empty());
  for (const char *lines :
       {"displace_atoms high move 0 0 -1.0", "displace_atoms high move 0.3 0.2 -2.0",
        "unfix c\nfix c all mpm/contact F1 F2 gap no\ndisplace_atoms high move 0 0 -1.0"}) {
    const auto found = overlaps(lines);
    ASSERT_FALSE(found.empty()) << lines;
    EXPECT_TRUE(
        contains(found[0],
                 "Fix mpm/contact c: bodies F[12] and F[12] overlap at the start of the run, for "
                 "instance points [1-9][0-9]* and [1-9][0-9]* near [0-9. ]+: .*does not part them"))
        << lines << found[0];
  }
  // create_points does not let it happen; sites on the face between two bodies belong to the first
  for (const char *spacing : {"spacing 0.5", "spacing 0.8"}) {
    const auto touch = space("lj", "f f f", "0 8 0 8 0 8", 2) +
        "region one block 0 4.4 0 4 0 4\nregion two block 4.4 8 0 4 0 4\n" +
        strprintf("create_points 1 region one %s\ncreate_points 2 region two %s\n", spacing,
                  spacing);
    const double whole = 8.0 * 4.0 * 4.0;
    Scene run(touch);
    double volume = 0.0;
    for (int i = 0; i < run.n(); i++) volume += run.lmp->atom->vfrac[i];
    EXPECT_NEAR(over_ranks(volume), whole, 1e-12 * whole) << spacing;
    expect_error(replaced(touch, "two block 4.4", "two block 3.6"), "overlap yes");
  }
  expect_error(changed(good_scene, "b2 block 2 6 2 6 3 5", "b2 block 2 6 2 6 2 4"), "overlap yes");
}
}    // namespace Coupling

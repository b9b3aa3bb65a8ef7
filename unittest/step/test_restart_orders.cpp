// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: restart

// What stands before and after read_restart, in any order, forgotten, or changed: the run goes on
// bit by bit (to round-off with materials in another order), or says what has changed.

#include "mpm_lammps.h"

#include "neighbor.h"

using namespace MPM_TEST;
using ::testing::ContainsRegex;

static const std::vector<std::string> fixes = {
    "fix grid all mpm 1.0\n",
    "fix m1 one mpm/material density 1.0 neohookean 10.0 0.3\n",
    "fix m2 two mpm/material density 2.0 eos linear 20.0 strength j2 5.0 0.05 hardening linear "
    "0.5\n",
    "fix floor all mpm/boundary ylo slip\n",
    "fix g all gravity 0.3 vector 0 -1 0\n",
    "fix step all mpm/dt 0.3\n",
    "compute e all mpm/energy\nthermo_style custom step c_e\n"};

static std::string all_fixes()
{
  std::string text;
  for (const auto &fix : fixes) text += fix;
  return text;
}

static const std::string points =
    bodies({{"one", "sphere 2.6 3 0 1.5"}, {"two", "block 4.5 7 2 5 INF INF"}});
static const std::string head = plane("lj", "f f", "0 8 0 8", 2);
static const std::string pair = "pair_style zero 1.0\npair_coeff * *\n";

/** The run that writes the file, its next 20 steps, and what another input makes of the file. */
struct Continuations {
  const ScratchFile file{"bin"};
  std::vector<Scene::State> expected;
  double dt;

  explicit Continuations(const std::string &scene, const std::string &before = "run 40\n")
  {
    Scene whole(scene + before + "write_restart " + file.name + "\nrun 20\n");
    expected = whole.gather();
    dt = whole.lmp->update->dt;
  }

  struct Result {
    std::string error, warnings;
    bool identical;
    double difference, dt;
  };
  Result go_on(const std::string &before, const std::string &after) const
  {
    const ScratchFile log("log");
    Scene run("log " + log.name + "\n");
    Result result{run.error(before + "read_restart " + file.name + "\n" + after + "run 20\n"), "",
                  false, 1.0, 0.0};
    if (result.error.empty()) {
      result.identical = identical(expected, run.gather());
      result.difference = difference(expected, run.gather());
      result.dt = run.lmp->update->dt;
    }
    run.error("log none\n");
    std::ifstream text(log.name);
    for (std::string line; std::getline(text, line);)
      if (line.compare(0, 7, "WARNING") == 0 &&
          line.find("Per-atom field rmass") == std::string::npos)
        result.warnings += line + "\n";
    return result;
  }
};

static Continuations basic(const std::string &step = fixes[5])
{
  return Continuations(head + fixes[0] + points +
                       replaced(replaced(all_fixes(), fixes[0], ""), fixes[5], step) +
                       "velocity one set 0.6 -0.3 0\nvelocity two set -0.5 -0.3 0\n");
}

TEST(RestartOrders, AnyOrderAfterTheFileIsRight)
{
  const auto run = basic();
  std::vector<std::string> order = fixes;
  for (std::size_t turn = 0; turn < fixes.size(); turn++) {
    std::rotate(order.begin(), order.begin() + 1, order.end());
    for (const bool backwards : {false, true}) {
      std::string text;
      for (const auto &fix : order) text = backwards ? fix + text : text + fix;
      const auto found = run.go_on("", text);
      EXPECT_EQ(found.error, "") << text;
      EXPECT_EQ(found.warnings, "") << text;
      // points are sorted by materials in their order
      if (text.find("fix m1") < text.find("fix m2")) EXPECT_TRUE(found.identical) << text;
      EXPECT_LT(found.difference, 1.0e-12) << text;
    }
  }
}

struct Change {
  const char *name;
  std::string before, after;    // read_restart is between them
  const char *error, *warning;
};

static std::string with(int k, const std::string &other)
{
  return replaced(all_fixes(), fixes[k], other);
}

static const std::vector<Change> changes = {
    // what is written before: LAMMPS refuses it, or the file overrules it, or it stays
    {"fix_before", fixes[0], all_fixes(), "before simulation box is defined", ""},
    {"material_before", "fix m all mpm/material density 1 neohookean 1 0.3\n", all_fixes(),
     "before simulation box is defined", ""},
    {"points_before", "create_points 1 box\n", all_fixes(), "box is defined", ""},
    {"box_before", "region b block 0 1 0 1 0 1\ncreate_box 1 b\n", all_fixes(),
     "after simulation box is defined", ""},
    {"units_before", "units si\nboundary p p p\natom_style atomic\n", all_fixes(), "", ""},
    {"compute_before", "atom_style mpm\ncompute v all mpm/atom vonmises\n", all_fixes(), "", ""},
    {"communication_before", "comm_modify vel yes\n", all_fixes(), "", ""},
    {"pair_style_before", "pair_style mpm/penalty\n", all_fixes(),
     "coeffs are not set|[Ii]ncorrect args|pair_coeff", ""},

    // what is forgotten
    {"no_lattice", "", with(0, ""), "requires a fix mpm", ""},
    {"no_material", "", with(1, ""), "28 material points have no material", ""},
    {"no_floor", "", with(3, ""), "has left the box",
     "had fix floor .style mpm/boundary., and what is in the file"},
    {"no_gravity", "", with(4, ""), "", "had fix g .style gravity., which this one has not"},
    {"no_time_step", "", with(5, ""), "", "had fix step .style mpm/dt."},

    // what has changed
    {"other_ID", "", with(0, replaced(fixes[0], "grid", "lattice")), "",
     "had fix grid .style mpm., and what"},
    {"other_ID_of_material", "", with(2, replaced(fixes[2], "m2", "metal")), "",
     "had fix m2 .style mpm/material., and what"},
    {"other_spacing", "", with(0, "fix grid all mpm 0.5\n"), "spacing 1 .now 0.5.", ""},
    {"other_origin", "", with(0, "fix grid all mpm 1.0 origin 0 0.25\n"),
     "origin 0 along y .now 0.25.", ""},
    {"other_scheme", "", with(0, "fix grid all mpm 1.0 scheme musl\n"), "scheme usl .now musl.",
     ""},
    {"other_group", "", with(0, "fix grid one mpm 1.0\n"), "",
     "mass .* in the restart file and .* now|belong to no fix mpm"},
    {"other_law", "", with(1, "fix m1 one mpm/material density 1.0 linear 10.0 0.3\n"), "",
     "Material m1 is .*linear.* now, but was .*neohookean"},
    {"other_modulus", "", with(1, replaced(fixes[1], "10.0", "12.0")), "",
     "Material m1 is .*12.* now, but was .*10"},
    {"other_density", "", with(1, replaced(fixes[1], "1.0", "1.5")), "", "keep a mass that is not"},
    {"other_history", "", with(2, replaced(fixes[1], "m1 one", "m2 two")),
     "have the history variables", ""},
    {"other_exclusions", "", all_fixes() + pair + "neigh_modify exclude type 1 1\n", "",
     "had 0 exclusions .* have 1 now"},

    // what is repeated
    {"velocities_again", "", all_fixes() + "velocity one set 0.6 -0.3 0\n", "",
     "velocities of points are not those of the restart file"},
    {"points_again", "",
     all_fixes() + "region one sphere 2.6 3 0 1.5\ncreate_points 1 region one\n",
     "Cannot create_points after reading a restart file", ""},
    {"points_again_later", "",
     all_fixes() + "run 0\nregion one sphere 2.6 3 0 1.5\ncreate_points 1 region one\n",
     "refuses overlapping bodies", ""},
    {"points_deleted", "", all_fixes() + "group few id 1 2\ndelete_atoms group few compress no\n",
     "", "mass .* in the restart file and .* now"},

    // what makes LAMMPS forget the file before the fixes have seen it
    {"run_before_the_fixes", "", "run 0\n" + all_fixes(), "",
     "had fix grid .*, fix m1 .*, fix m2 .*, fix floor .*, fix step .* directly after "
     "read_restart"},
    {"balance_before_the_fixes", "", "balance 1.0 shift x 5 1.1\n" + all_fixes(), "",
     "directly after read_restart, before commands"},
};

class RestartChanges : public ::testing::TestWithParam<Change> {};
INSTANTIATE_TEST_SUITE_P(All, RestartChanges, ValuesIn(changes), [](const auto &info) {
  return std::string(info.param.name);
});

TEST_P(RestartChanges, AreRightOrNoticed)
{
  const auto &change = GetParam();
  const auto run = basic();
  const auto found = run.go_on(change.before, change.after);
  if (*change.error)
    EXPECT_THAT(found.error, ContainsRegex(change.error));
  else
    EXPECT_EQ(found.error, "");
  if (*change.warning)
    EXPECT_THAT(found.warnings, ContainsRegex(change.warning));
  else if (!*change.error) {
    EXPECT_EQ(found.warnings, "");
    EXPECT_TRUE(found.identical);
  }
}

// also of a single point, whichever it is
SERIAL_TEST(RestartChanges, OfAnyPointAreNoticed)
{
  const auto run = basic();
  for (int id = 1; id <= 28; id++)
    EXPECT_THAT(
        run.go_on("",
                  all_fixes() + strprintf("group single id %d\nvelocity single set 0.7 0 0\n", id))
            .warnings,
        ContainsRegex("velocities of points are not those of the restart file"));
}

// the time step of the file goes on only with the same options
TEST(RestartOrders, OtherTimeStepIsSetAtOnce)
{
  const auto run = basic();
  for (const char *options : {"0.15", "0.3 max 0.01"}) {
    const auto found = run.go_on("", with(5, std::string("fix step all mpm/dt ") + options + "\n"));
    EXPECT_EQ(found.error, "");
    if (std::string(options) == "0.15")
      EXPECT_NEAR(found.dt / run.dt, 0.5, 0.05);
    else
      EXPECT_EQ(found.dt, 0.01);
  }
  Scene first("read_restart " + run.file.name + "\n" + with(5, "fix step all mpm/dt 0.15\n") +
              "run 1\n");
  EXPECT_NEAR(first.lmp->update->dt / run.dt, 0.5, 0.05);    // from the first step on
  const double fresh = 2.0 * first.lmp->update->dt;

  // a largest time step that is gone or larger, and a growth by looks that are others
  const std::string step = "fix step all mpm/dt 0.3 max 0.01\n";
  const auto bound = basic(step);
  EXPECT_EQ(bound.go_on("", with(5, step)).dt, 0.01);
  for (const char *options : {"", " max 0.02", " max 0.01"}) {
    Scene next("read_restart " + bound.file.name + "\n" +
               with(5, std::string("fix step all mpm/dt 0.3") + options + "\n") + "run 1\n");
    const double most = *options ? std::stod(std::string(options).substr(5)) : 1.0;
    EXPECT_NEAR(next.lmp->update->dt, std::min(most, fresh), 0.1 * fresh) << options;
  }
  const auto slow = basic("fix step all mpm/dt 0.3 grow 1.0001 every 5\n");
  for (const char *options : {"grow 1.0002 every 5", "grow 1.0001 every 7"}) {
    Scene next("read_restart " + slow.file.name + "\n" +
               with(5, std::string("fix step all mpm/dt 0.3 ") + options + "\n") + "run 0\n");
    Scene same("read_restart " + slow.file.name + "\n" +
               with(5, "fix step all mpm/dt 0.3 grow 1.0001 every 5\n") + "run 0\n");
    EXPECT_GT(next.lmp->update->dt, 1.001 * same.lmp->update->dt) << options;
  }
}

// forces from outside are forces
TEST(RestartOrders, ForcesOfADriverAreMissed)
{
  const std::string start = head + fixes[0] + points + replaced(all_fixes(), fixes[0], ""),
                    push = "fix push all external pf/array 1\n";
  const Continuations run(start + push);
  const auto right = run.go_on("", all_fixes() + push);
  EXPECT_EQ(right.error + right.warnings, "");
  EXPECT_TRUE(right.identical);
  EXPECT_THAT(run.go_on("", all_fixes()).warnings,
              HasSubstr("had fix push (style external), which this one has not"));
}

// squares of velocities that are smaller than the smallest normal number
TEST(RestartOrders, TinyVelocitiesAreRead)
{
  const Continuations run(head + fixes[0] + points + fixes[1] + fixes[2] + fixes[5] +
                          "velocity all set 1.0e-158 0 0\n");
  const auto found = run.go_on("", fixes[0] + fixes[1] + fixes[2] + fixes[5]);
  EXPECT_EQ(found.error + found.warnings, "");
  EXPECT_TRUE(found.identical);
}

// exclusions that keep grains and points of a body apart; and fixes without a state
TEST(RestartOrders, GrainsGoOnAsTheyWere)
{
  const std::string lists = "neighbor 0.3 bin\ncomm_modify vel yes\n";
  const std::string law = "hooke 20 0 tangential linear_nohistory 0 0\n";
  const std::string grains = "pair_style granular\npair_coeff * * " + law,
                    exclude = "neigh_modify exclude type 1 1\n";
  const std::string mine = "fix grid all mpm 1.0\n"
                           "fix m solid mpm/material density 1 neohookean 10 0.3\n"
                           "fix skin solid mpm/surface\n";
  const std::string move = "fix move balls nve/sphere\n",
                    wall = "fix w balls wall/gran hooke 20 NULL 0 NULL 0 0 zplane 0 8\n";
  const std::string scene = "units lj\nboundary p p f\natom_style hybrid sphere mpm\n" + lists +
      "region box block 0 4 0 4 0 8\ncreate_box 2 box\nfix grid all mpm 1.0\n"
      "region solid block INF INF INF INF 0 2\ncreate_points 1 region solid ppc 2\n"
      "group solid type 1\ncreate_atoms 2 single 2 2 2.6\nset type 2 diameter 1 density 2\n"
      "group balls type 2\nvelocity balls set 0 0 -0.5\ntimestep 0.02\nunfix grid\n" +
      mine + move + wall;
  const Continuations run(scene + grains + exclude);
  const auto right = run.go_on("", lists + mine + move + wall + grains + exclude);
  EXPECT_EQ(right.error + right.warnings, "");
  EXPECT_TRUE(right.identical);
  const auto renamed =
      run.go_on("", lists + mine + replaced(move, "move", "m2") + wall + grains + exclude);
  EXPECT_EQ(renamed.error + renamed.warnings, "");
  EXPECT_TRUE(renamed.identical);

  const std::vector<std::array<std::string, 2>> forgotten = {
      {lists + mine + move + wall + grains, "had 1 exclusions .* have 0 now"},
      {lists + mine + wall + grains + exclude, "had fix move .style nve/sphere., which"},
      {lists + mine + move + grains + exclude, "had fix w .style wall/gran., which"},
      {lists + replaced(mine, "fix skin solid mpm/surface\n", "") + move + wall + grains + exclude,
       "had fix skin .style mpm/surface., which"},
      {lists + mine + move + wall + exclude +
           "pair_style hybrid/overlay granular zero 1.0\npair_coeff * * zero\n"
           "pair_coeff * * granular " +
           law,
       ""}};
  for (const auto &[text, warning] : forgotten) {
    const auto found = run.go_on("", text);
    if (warning.empty())
      EXPECT_EQ(found.error + found.warnings, "") << text;
    else
      EXPECT_THAT(found.error + found.warnings, ContainsRegex(warning)) << text;
  }

  // LAMMPS's files lack the cutoffs of granular, which may be too small, large enough, or huge
  const auto no_pair = run.go_on("", lists + mine + move + wall + exclude);
  if (!no_pair.identical)
    EXPECT_THAT(no_pair.error, ContainsRegex("give pair_style and pair_coeff again|<< cutoff"));

  // a hybrid, which LAMMPS refuses without its coefficients
  const std::string hybrid = "pair_style hybrid/overlay granular zero 0.1\npair_coeff * * zero\n"
                             "pair_coeff 1*2 2 granular " +
      law;
  const Continuations mixed(scene + hybrid);
  const auto again = mixed.go_on("", lists + mine + move + wall + hybrid);
  EXPECT_EQ(again.error + again.warnings, "");
  EXPECT_TRUE(again.identical);
  const auto lost = mixed.go_on("", lists + mine + move + wall);
  EXPECT_THAT(lost.error, HasSubstr("pair coeffs are not set"));
}

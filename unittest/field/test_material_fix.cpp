// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit input restart
// mpi: 1 2

// fix mpm/material: definition in the input and in files, masses, and history variables that move
// with their points, through restart files and to new points. The laws:
// material/test_materials.cpp.

#include "mpm_lammps.h"

#include "group.h"

#include <Eigen/Dense>

#include <cstdlib>
#include <filesystem>

using namespace MPM_TEST;

const std::string STEEL = "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 "
                          "0.168 0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9";

/** Two blocks of points, types 1 and 2, and no material yet. */
const std::string scene = space("si", "p p p", "0 8 0 8 0 8", 2, 0.3) + R"(
fix grid all mpm 1.0
region one block 1 3 1 3 1 3
region two block 5 7 5 7 5 7
create_points 1 region one ppc 2
create_points 2 region two ppc 2
group one type 1
group two type 2
timestep 1.0e-9
)";

/** The error that a definition gives: what follows "fix m one mpm/material". */
static std::string error_of_material(const std::string &definition)
{
  return error_of(scene + "fix m one mpm/material " + definition + "\n");
}

static bool contains(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

TEST(MaterialFix, ErrorsNameValueAndRemedy)
{
  const Mistake cases[] = {
      {"", "Illegal fix mpm/material command: missing argument"},
      {"density -1 linear 1e6 0.3",
       "density: RHO = -1 (reference density) is out of range: 0 < VALUE"},
      {"linear 1e6 0.3", "density is missing: add 'density RHO'"},
      {"density 1000 linear 1e6 0.6", "linear: NU = 0.6 (Poisson's ratio) is out of range"},
      {"density 1000 lineal 1e6 0.3",
       "unknown keyword 'lineal': expected density, linear, neohookean"},
      {"density 1000 eos linear -3",
       "eos linear: K = -3 (bulk modulus) is out of range: 0 < VALUE"},
      {"density 1000 eos linear", "eos linear: K is missing (bulk modulus)"},
      {"density 1000 strength j2 1 1", "add an equation of state, such as 'eos linear K'"},
      {"density 1000 linear 1 0 neohookean 1 0", "the material has 'linear' already"},
      {"density 1000 eos gas 1.4", "unknown eos 'gas': choose linear, shock, tait"},
      {"density 1000 linear 1e6 0.3 range", "range: name of the quantity is missing"},
      {"density 1000 linear 1e6 0.3 range pressure -1e6", "range pressure: HIGH is missing"},
      {"density 1000 linear 1e6 0.3 range pressure 1e6 -1e6",
       "range pressure: LOW must be less than HIGH"},
      {"density 1000 linear 1e6 0.3 range temperature 0 INF",
       "this material has no 'temperature': choose pressure, rate, density"},
      {"density 1000 linear 1e6 0.3 range rate 0 1 range rate 0 2", "'rate' is given twice"},
      {"density 1000 linear 1e6 0.3 file x.mpm", "the 'file' of a material must come first"},
      {"file", "Illegal fix mpm/material file command: missing argument"},
      {"file nowhere.mpm", "cannot read file nowhere.mpm: it is not here, nor in"},
      {"file Cu_OFHC_J2.mpm density 8000", "after file Cu_OFHC_J2.mpm: density is given twice"},
  };
  for (const auto &c : cases)
    EXPECT_THAT(error_of_material(c.lines), HasSubstr(c.message)) << c.lines;
}

TEST(MaterialFix, NeedsMaterialPoints)
{
  expect_refused("units si\natom_style atomic\nregion box block 0 8 0 8 0 8\ncreate_box 1 box\n",
                 {{"fix m all mpm/material density 1000 linear 1e6 0.3", "use atom_style mpm"}});
}

TEST(MaterialFix, FilesOfThePackage)
{
  int files = 0;
  for (const auto &entry :
       std::filesystem::directory_iterator(std::string(MPM_SOURCE_DIR) + "/potentials")) {
    SCOPED_TRACE(entry.path().string());
    ASSERT_EQ(entry.path().extension(), ".mpm");
    files++;
    Scene run(scene + "fix m one mpm/material file " + entry.path().string() + "\n");
    auto *m = run.material("m");
    std::vector<MPM_NS::HistoryVariable> history = m->material->history();
    EXPECT_EQ(m->nhistory, (int) history.size());
    const std::string text = m->material->describe();
    if (contains(text, "strength ") && !contains(text, "strength elastic")) {
      EXPECT_GE(m->find_history("eplastic"), 0);
    }
    EXPECT_EQ(m->find_history("unknown"), -1);
  }
  EXPECT_GE(files, 28);
  // found in the folders of LAMMPS_POTENTIALS, same as in the input
  setenv("LAMMPS_POTENTIALS", (std::string(MPM_SOURCE_DIR) + "/potentials").c_str(), 1);
  Scene run(scene +
            "fix m one mpm/material file Water_Tait.mpm\n"
            "fix n two mpm/material density 998.2 eos tait 2.192e9 7 cutoff -9.9e4 &\n"
            "viscosity newtonian 1.002e-3 range pressure -INF 2.5e9\n");
  EXPECT_EQ(run.material("m")->material->describe(), run.material("n")->material->describe());
}

TEST(MaterialFix, BadFiles)
{
  const std::string header = "# DATE: 2026-01-01 UNITS: si CONTRIBUTOR: a CITATION: b\n",
                    good = header + "density\n 1000\n\n  linear 1e6\n0.3",
                    gas = header + "density 1.2\neos ideal/gas 1.4\n";
  const struct {
    std::string text, more, message;    // more: after the name of the file
  } cases[] = {
      {header + "\ndensity 1000 # fine\n\nlinear 1e6 0.7\n", "",
       "file FILE line 5: linear: NU = 0.7"},
      {"# DATE: 2026-01-01 UNITS: lj\ndensity 1 linear 1 0.3\n", "",
       "FILE is in lj units but the input uses si units"},
      {"density 1000\nlinear 1e6 0.3\n", "", "the first line of file FILE must give its units"},
      {header, "", "file FILE line 1: density is missing"},
      {good, "", ""},
      // parts of the input are added to those of the file
      {good, " thermal constant 300", ""},
      {good, " thermal constant hot", "after file FILE: thermal constant: T0 must be a number"},
      // and options to the last part in the file
      {gas, "", "file FILE line 3: eos ideal/gas: give"},
      {gas, " pressure 1e5 viscosity artificial 2 1", ""},
      {header.substr(2) + "density 1000 linear 1e6 0.3\n", "", ""},
      // lines of any length
      {header + "density 1000 linear 1e6" + std::string(5000, ' ') + "0.7", "",
       "file FILE line 2: linear: NU = 0.7"}};
  for (const auto &c : cases) {
    const ScratchFile file("made.mpm", c.text);
    const auto found = error_of_material("file " + file.name + c.more);
    EXPECT_THAT(found, HasSubstr(replaced(c.message, "FILE", file.name))) << c.text << c.more;
    EXPECT_EQ(found.empty(), c.message.empty()) << found;
  }
}

/** sqrt(2/3 D:D) of the step that took F0 to F1, from the velocity gradient of its middle. */
double strain_rate(const double *F0, const double *F1, double dt)
{
  Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> f0(F0), f1(F1);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity(), A = f1 * f0.inverse() - I;
  const Eigen::Matrix3d G = A * (I + 0.5 * A).inverse();
  return std::sqrt(2.0 / 3.0) * (0.5 * (G + G.transpose())).norm() / dt;
}

// Two blocks, on two ranks when there are two, change their shape. Each warning names the first
// step, and its first point outside: found here from the state of all points.
TEST(MaterialFix, LeavingARangeWarnsOnce)
{
  const double dt = 1.0e-6;
  const std::string start = scene +
      "timestep 1.0e-6\ncomm_modify cutoff 1.0\nthermo 100\n"
      "variable vx atom 1.0e3*(x-2.0)*(x-1.0)\n"
      "variable vy atom -1.0e3*x*(y-2.0)\n"
      "velocity all set v_vx v_vy 0\n"
      "fix a all mpm/material density 1000 eos linear 1e6 &\n"
      "strength elastic 1e5 ";
  constexpr int STEPS = 40;
  enum { PRESSURE, RATE, DENSITY, N };
  std::vector<std::array<double, N>> reference;    // of all points of all steps
  int npoints = 0;
  {
    Scene run(start + "\nrun 0 post no\n");
    auto before = run.gather();
    for (int step = 1; step <= STEPS; step++) {
      run.commands("run 1 post no\n");
      const auto after = run.gather();
      npoints = 0;
      for (std::size_t i = 0; i < after.size(); i++) {
        ASSERT_EQ(after[i].tag, ++npoints);
        const double *s = after[i].stress;
        reference.push_back({-(s[0] + s[1] + s[2]) / 3, strain_rate(before[i].F, after[i].F, dt),
                             after[i].mass / after[i].vol});
      }
      before = after;
    }
  }
  const auto message = [&](int quantity, double low, double high) -> std::string {
    static const char *const name[N] = {"pressure", "rate", "density"};
    for (std::size_t n = 0; n < reference.size(); n++) {
      const double value = reference[n][quantity];
      if (value >= low && value <= high) continue;
      return strprintf(
          "Fix mpm/material a: %s %.6g of point %d at step %d is out of the range of this "
          "material, %.6g to %.6g",
          name[quantity], value, int(n % npoints + 1), int(n / npoints + 1), low, high);
    }
    return "";
  };
  const auto warnings = [&](const std::string &ranges) {
    return lines_that_say(start + ranges + "\nrun 20 post no\nrun 20 post no\n",
                          "out of the range");
  };

  // limits that are reached in the middle of the run
  double density = INFINITY, pressure = -INFINITY;
  for (int n = 0; n < 25 * npoints; n++) {
    density = std::min(density, reference[n][DENSITY]);
    pressure = std::max(pressure, reference[n][PRESSURE]);
  }
  density = std::round(density);
  pressure = std::round(pressure) + 0.5;
  const auto text = [](double x) {
    return std::to_string(x);
  };

  EXPECT_EQ(warnings("range rate 0 1e5 range density 100 INF range pressure -1e9 1e9").size(), 0);

  const auto found = warnings("range pressure -INF " + text(pressure) + " range density " +
                              text(density) + " INF range rate 0 1000");
  const std::string expected[] = {message(PRESSURE, -INFINITY, pressure),
                                  message(DENSITY, density, INFINITY), message(RATE, 0.0, 1000.0)};
  for (const auto &e : expected) {
    EXPECT_NE(e, "");
    int hits = 0;
    for (const auto &line : found) hits += contains(line, e);
    EXPECT_EQ(hits, 1) << e << "\n" << (found.empty() ? "nothing" : found[0]);
  }
  EXPECT_EQ(found.size(), 3);
}

TEST(MaterialFix, MassIsDensityTimesVolumeUnlessSet)
{
  Scene run(scene + "fix a one mpm/material density 1000 linear 1e6 0.3\n");
  for (int i = 0; i < run.n(); i++)
    EXPECT_EQ(run.mass()[i], run.lmp->atom->type[i] == 1 ? 1000 * 0.125 : 0.0);
  run.commands("set type 2 mass 7.5\nfix b two mpm/material density 1000 linear 1e6 0.3\n");
  const auto check = [&]() {
    auto *atom = run.lmp->atom;
    for (int i = 0; i < atom->nlocal; i++)
      EXPECT_EQ(atom->rmass[i], atom->type[i] == 1 ? 1000 * 0.125 : 7.5);
    EXPECT_EQ(over_ranks(atom->nlocal), run.lmp->atom->natoms);
  };
  check();
  // points that come later get theirs before the run
  run.commands("region late block 1 3 5 7 1 3\ncreate_points 1 region late ppc 2\n"
               "group one type 1\nrun 0 post no\n");
  EXPECT_EQ(run.lmp->atom->natoms, 192);
  check();
}

// points whose pores have water in them have another mass, for as long as there is a fix mpm/pore
TEST(MaterialFix, MassFollowsTheWaterOfAFixPoreOnly)
{
  Scene run(plane("si", "f p", "0 4 0 4", 1, 0.1) +
            "fix grid all mpm 1.0\ncreate_points 1 box ppc 2\n"
            "fix m all mpm/material density 2000.0 linear 1e7 0.3\ntimestep 1e-4\n"
            "fix water all mpm/pore 2e7 1000 9810 soil m 0.4 constant 1e-5\nrun 1\n");
  EXPECT_TRUE(run.material()->mass_varies);
  run.commands("unfix water\nrun 1\n");
  EXPECT_FALSE(run.material()->mass_varies);
}

TEST(MaterialFix, NewPointsStartWithInitialHistory)
{
  Scene run(scene + "fix m all mpm/material " + STEEL + "\nregion late block 1 3 5 7 1 3\n" +
            "create_points 1 region late ppc 2\nrun 0 post no\n");
  auto *m = run.material("m");
  ASSERT_EQ(m->nhistory, 2);
  EXPECT_EQ(run.lmp->atom->natoms, 192);
  for (int i = 0; i < run.n(); i++) {
    EXPECT_EQ(m->history[i][m->find_history("eplastic")], 0.0);
    EXPECT_EQ(m->history[i][m->find_history("temperature")], 20.0);
  }
}

TEST(MaterialFix, HistoryMovesWithThePoints)
{
  Scene run(scene + "fix a one mpm/material " + STEEL +
            "\nfix b all mpm/material density 1 eos shock 1 1 1\n" + "atom_modify sort 1 1.0\n");
  auto *a = run.material("a"), *b = run.material("b");
  run.commands("group half type 1\n");
  const auto value = [&](int i, int k) {
    return 1000.0 * k + run.lmp->atom->tag[i];
  };
  for (int i = 0; i < run.n(); i++)
    for (int k = 0; k < 2; k++) {
      a->history[i][k] = value(i, k);
      b->history[i][k] = -value(i, k);
    }
  const int before = run.n();
  const auto check = [&]() {
    for (int i = 0; i < run.n(); i++)
      for (int k = 0; k < 2; k++) {
        ASSERT_EQ(a->history[i][k], value(i, k));
        ASSERT_EQ(b->history[i][k], -value(i, k));
      }
  };
  // to other ranks and to other places in memory, without a change of state: setup only
  run.commands("unfix grid\n");
  for (const char *shift : {"3 0 0", "0 3 0", "0 0 3", "-5 2 1"}) {
    run.commands("displace_atoms all move " + std::string(shift) + "\nrun 0 post no\n");
    check();
  }
  run.commands("group odd id 1:64:2\ndelete_atoms group odd compress no\nrun 0 post no\n");
  check();
  EXPECT_GT(before, 0);
}

// a point that turns inside out keeps its history, and those next to it have theirs as without it
SERIAL_TEST(MaterialFix, HistoryNextToABadPoint)
{
  const auto hardened = [](const char *crushed, double v) {
    const ScratchFile log("bad.log");
    Scene run("log " + log.name + "\n" + plane("lj", "p f", "0 8 0 8", 1, 0.3) +
              "fix grid all mpm 1.0 dtcheck no bad warn\nregion low block 1 2 1 2 INF INF\n"
              "region high block 5 6 5 6 INF INF\ncreate_points 1 region low ppc 2\n"
              "create_points 1 region high ppc 2\n"
              "fix m all mpm/material density 2 eos linear 30 strength j2 10 0.05 hardening "
              "linear 3\ngroup bad region " +
              crushed +
              "\ngroup good subtract all bad\nvariable v atom 0.4*(y-xcm(good,y))\n"
              "velocity good set v_v 0 NULL\n" +
              strprintf("variable w atom %g*(xcm(bad,x)-x)\nvelocity bad set v_w 0 NULL\n", v) +
              "timestep 0.5\nrun 1\nlog none\n");
    const auto *const m = run.material("m");
    const int k = m->find_history("eplastic"), bad = run.lmp->group->find("bad");
    std::map<tagint, double> found;
    for (int i = 0; i < run.n(); i++) {
      const bool is_bad = run.lmp->atom->mask[i] & run.lmp->group->bitmask[bad];
      if (is_bad) EXPECT_EQ(m->history[i][k], 0.0);
      if (!is_bad) found[run.lmp->atom->tag[i]] = m->history[i][k];
    }
    EXPECT_EQ(contains(file_text(log.name), "has a deformation gradient of determinant"), v > 0.0);
    return found;
  };
  for (const char *crushed : {"low", "high"}) {
    const auto with = hardened(crushed, 20.0), without = hardened(crushed, 0.0);
    EXPECT_EQ(with, without);
    for (const auto &point : without) EXPECT_GT(point.second, 0.01);
  }
}

// as many history variables, but others
TEST(MaterialFix, RestartRefusesOtherHistory)
{
  const ScratchFile file("restart");
  const std::string law = "fix m all mpm/material density 1 eos linear 10 strength ";
  Scene(scene + law + "j2 5 0.02\nrun 0 post no\nwrite_restart " + file.name + "\n");
  expect_refused("read_restart " + file.name + "\nneighbor 0.3 bin\n",
                 {{law + "elastic 5 thermal adiabatic 1 300",
                   "have the history variables eplastic, those of this material are temperature"}});
}

TEST(MaterialFix, RestartKeepsHistoryAndWork)
{
  const std::string fixes = "group one type 1\ngroup two type 2\nfix grid all mpm 1.0\n"
                            "fix a one mpm/material " +
      STEEL + "\nfix b two mpm/material density 1 linear 1 0\n";
  const ScratchFile file("restart");
  {
    Scene run(scene + "unfix grid\n" + fixes);
    auto *a = run.material("a");
    EXPECT_FALSE(run.material("b")->history);
    for (int i = 0; i < run.n(); i++)
      for (int k = 0; k < 2; k++) a->history[i][k] = 0.1 * run.lmp->atom->tag[i] + 1000 * k;
    for (int k = 0; k < MPM_NS::NWORK; k++) a->work[k] = (k + 1) * (rank() + 1);
    run.commands("run 0 post no\nwrite_restart " + file.name + "\n");
  }
  Scene run("read_restart " + file.name + "\nneighbor 0.3 bin\n" + fixes + "run 0 post no\n");
  auto *a = run.material("a");
  EXPECT_EQ(over_ranks(run.n()), 128);
  for (int i = 0; i < run.n(); i++)
    for (int k = 0; k < 2; k++) ASSERT_EQ(a->history[i][k], 0.1 * run.lmp->atom->tag[i] + 1000 * k);
  for (int k = 0; k < MPM_NS::NWORK; k++)
    EXPECT_EQ(over_ranks(a->work[k]), (k + 1) * (nranks() == 1 ? 1 : 3));
}

// A material that is defined again for deformed points begins with a new history, and says so; what
// comes from a restart file, and laws without a history, do not
TEST(Material, ThatIsDefinedAgainSaysWhatIsLost)
{
  const auto scene = [](const std::string &law) {
    return plane("si", "f f", "0 0.4 0 0.6", 1, 0.01) + "region b block 0 0.4 0 0.4 INF INF\n" +
        "fix grid all mpm 0.1\ncreate_points 1 region b ppc 2\n"
        "fix m all mpm/material density 1000 " +
        law +
        "\nfix floor all mpm/boundary ylo slip\nfix g all gravity 9.81 vector 0 -1 0\n"
        "timestep 1e-4\n";
  };
  const std::string sand = "drucker/prager 1e6 0.3 30", says = "were deformed before";
  const std::string again = "unfix m\nfix m all mpm/material density 1000 ";
  EXPECT_EQ(lines_that_say(scene(sand) + "run 10\n" + again + sand + "\nrun 1\n", says).size(), 1u);
  EXPECT_EQ(lines_that_say(scene(sand) + again + sand + "\nrun 10\nrun 1\n", says).size(), 0u);
  const std::string rubber = "neohookean 1e6 0.3";
  EXPECT_EQ(lines_that_say(scene(rubber) + "run 10\n" + again + rubber + "\nrun 1\n", says).size(),
            0u);
  const ScratchFile file("sand.restart");
  Scene run(scene(sand) + "run 10\nwrite_restart " + file.name + "\n");
  EXPECT_EQ(lines_that_say(
                "read_restart " + file.name + "\n" + lines_again(scene(sand)) + "run 1\n", says)
                .size(),
            0u);
}

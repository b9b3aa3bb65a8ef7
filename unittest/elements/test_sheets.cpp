// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input ranks
// mpi: 1 4
// timeout: 300

// Surfaces and lines without a lattice, moved by fix nve, which touch themselves by pair style
// mpm/sheet: folds part, layers do not pass each other (benchmarks R and V).

#include "elements/fix_mpm_elements.h"
#include "elements/thin_testing.h"

using namespace MPM_TEST;

/** A box with one type of atoms and a body without a lattice. */
static std::string free_body(int dim, double low, double high, double skin, const std::string &file,
                             const std::string &thin, const std::string &material,
                             const std::string &more = "")
{
  const std::string range = strprintf("%g %g ", low, high);
  return MPM_TEST::box(dim, "si", dim == 2 ? "f f p" : "f f f",
                       range + range + (dim == 2 ? "-0.01 0.01" : range), 1, skin) +
      thin_body(file, thin, material, more);
}

/** A strip of n x m squares with edges a, cut in triangles, folded to layers of n squares. */
static std::string folded(int layers, int n, int m, double a, double gap)
{
  std::vector<Node> line, x;
  for (int k = 0; k < layers; k++)
    for (int i = 0; i <= n; i++) line.push_back({a * (k % 2 ? n - i : i), 0.0, gap * k});
  std::vector<std::vector<int>> f;
  for (const Node &at : line)
    for (int j = 0; j <= m; j++) x.push_back({at[0], a * j, at[2]});
  for (int i = 0; i + 1 < (int) line.size(); i++)
    for (int j = 0; j < m; j++) {
      const int p = i * (m + 1) + j, q = p + m + 1;
      f.push_back({p, q, p + 1});
      f.push_back({q, q + 1, p + 1});
    }
  return gmsh(2, x, f);
}

// R3: a chain that is folded in the middle, and released at one end, which falls faster than
// freely: its two arms hang beside each other, closer than any lattice would let them part. x/L of
// the falling arm at times of sqrt(L/g), by a node five lines from its end: the very end is ahead
// by the speed that the wave of its release, g L/c, gives it
SERIAL_TEST(Sheets, FoldedChainFallsFasterThanFreely)
{
  const int n = 100;
  const double a = 1.0 / n, gap = 0.012;
  std::vector<Node> x;
  std::vector<std::vector<int>> lines;
  for (int i = 0; i <= n; i++)
    x.push_back({i <= n / 2 ? 0.0 : gap, -a * (i <= n / 2 ? i : n - i) - 1e-3, 0.0});
  for (int i = 0; i < n; i++) lines.push_back({i, i + 1});
  ScratchFile file("chain.msh", gmsh(1, x, lines));
  Scene run(MPM_TEST::box(2, "si", "f f p", "-0.5 0.5 -1.2 0.2 -0.01 0.01", 1, 0.01) +
            thin_body(file.name, "thickness 0.001", "neohookean 2e7 0", "compression no") +
            "pair_style mpm/sheet 0.009\npair_coeff * * 100.0\n"
            "group top id 1\ngroup rest subtract all top\nfix move rest nve\n"
            "fix g all gravity 9.81 vector 0 -1 0\ntimestep 1e-5\n");
  const double unit = 1.0 / sqrt(9.81);
  double time = 0.0;
  for (const auto &[at, exact] :
       {std::pair(0.5, 0.127870), std::pair(0.8, 0.342171), std::pair(1.0, 0.567356)}) {
    run.commands(strprintf("run %d\n", (int) lround((at * unit - time) / 1e-5)));
    time = run.evaluate("time");
    double end = 0.0;
    for (const auto &s : run.gather())
      if (s.tag == n - 4) end = -0.05 - 1e-3 - s.x[1];
    EXPECT_NEAR(measured("fallen", end) / exact, 1.0, 0.02);
    EXPECT_GE(end, 0.5 * at * at);
  }
}

// a strip that lies in three layers on a table, which is its lowest one: the others stay above it
// under their weight, which it bears. It is then lifted by its end, and unfolds. Without the pair
// style the layers fall through the table
SERIAL_TEST(Sheets, LayersDoNotPassEachOther)
{
  const int n = 6, m = 3;
  const double a = 0.05, gap = 0.045;
  ScratchFile file("strip.msh", folded(3, n, m, a, gap));
  for (const double k : {40.0, 0.0}) {
    Scene run(free_body(3, -0.6, 1.2, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
              strprintf("pair_style mpm/sheet 0.045\npair_coeff * * %g damping 0.02\n"
                        "comm_modify vel yes\n",
                        k) +
              strprintf("group table id <= %d\ngroup rest subtract all table\nfix move rest nve\n",
                        (n + 1) * (m + 1)) +
              "fix v rest viscous 0.02\nfix g all gravity 9.81 vector 0 0 -1\n"
              "compute w table reduce sum fz\ntimestep 5e-4\nthermo_style custom step c_w\n" +
              (k > 0.0 ? "run 3000\n" : "run 600\n"));
    double least[3] = {1.0, 1.0, 1.0}, most[3] = {-1.0, -1.0, -1.0};
    for (const auto &s : run.gather()) {
      const int layer = (int) (s.tag - 1) / ((n + 1) * (m + 1));
      least[layer] = std::min(least[layer], s.x[2]);
      most[layer] = std::max(most[layer], s.x[2]);
    }
    if (k == 0.0) {
      EXPECT_LT(least[1], -0.1);
      continue;
    }
    EXPECT_GT(measured("lowest node of the second layer", least[1]), 0.2 * gap);
    EXPECT_GT(measured("lowest node of the third layer", least[2]), 0.8 * gap);
    EXPECT_LT(most[1], 1.5 * gap);
    const double weight = 9.81 * 1000.0 * 0.001 * (3 * n * m * a * a + 2 * m * a * gap);
    EXPECT_NEAR(measured("weight on the table", -run.evaluate("c_w")) / weight, 1.0, 0.006);

    // pulled up by its end, it hangs from there, all of it
    run.commands(strprintf("group end id > %d\ngroup inner subtract rest end\nunfix move\n"
                           "fix move inner nve\nvelocity end set 0 0 1\nfix lift end move linear 0 "
                           "0 1.0\nrun 1000\n",
                           3 * (n + 1) * (m + 1) - (m + 1)));
    double high = 0.0;
    for (const auto &s : run.gather()) high = std::max(high, s.x[2]);
    EXPECT_GT(high, 0.5);
    for (const auto &s : run.gather()) EXPECT_GT(s.x[2], -1e-9);
  }
}

// nodes of a sheet with edges below the distance leave each other alone, but for folds
SERIAL_TEST(Sheets, NearNodesDoNotTouch)
{
  ScratchFile file("strip.msh", folded(1, 8, 3, 0.05, 0.0));
  Scene run(free_body(3, -0.6, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
            "pair_style mpm/sheet 0.08\npair_coeff * * 1.0\nfix move all nve\n"
            "compute touch all pair mpm/sheet\ntimestep 1e-5\n"
            "thermo_style custom step pe c_touch[1]\nrun 0\n");
  EXPECT_EQ(run.evaluate("c_touch[1]"), 0.0);
  EXPECT_EQ(run.evaluate("pe"), 0.0);
  // bent to three quarters of a cylinder, and then to a fold whose halves lie on each other
  for (const bool folds : {false, true}) {
    for (int i = 0; i < run.n(); i++) {
      const int k = (int) (run.lmp->atom->tag[i] - 1) / 4;
      const double angle = 1.5 * PI * (k - 4) / 8.0, R = 0.4 / (1.5 * PI);
      run.x()[i][0] = folds ? 0.05 * std::abs(k - 4) : R * sin(angle);
      run.x()[i][2] = folds ? (k < 4 ? 0.03 : 0.0) : R * cos(angle);
    }
    run.commands("run 0\n");
    if (folds)
      EXPECT_GT(run.evaluate("c_touch[1]"), 10.0);
    else
      EXPECT_EQ(run.evaluate("c_touch[1]"), 0.0);
  }
}

// two layers that approach, part, or part so fast that damping would hold them together: the force
// on each node above another one, and the power that damping takes
SERIAL_TEST(Sheets, DampingActsAgainstApproach)
{
  const double k = 40.0, c = 10.0, distance = 0.045, gap = 0.03, elastic = k * (distance - gap);
  ScratchFile file("strip.msh", folded(2, 4, 2, 0.1, gap));
  for (const double v : {-0.02, 0.02, 0.1}) {
    Scene run(free_body(3, -0.6, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
              strprintf("pair_style mpm/sheet %g\npair_coeff * * %g damping %g\n", distance, k, c) +
              "comm_modify vel yes\ngroup upper id > 15\n" +
              strprintf("velocity upper set 0 0 %g\n", v) +
              "compute touch all pair mpm/sheet\nthermo_style custom step c_touch[1] c_touch[2]\n"
              "timestep 1e-5\nrun 0\n");
    const double force = std::max(0.0, elastic - c * v);
    int touching = 0;
    for (int i = 0; i < run.n(); i++) {
      const double *const f = run.lmp->atom->f[i];
      const bool upper = run.x()[i][2] > 0.5 * gap, fold = run.x()[i][0] > 0.35;
      touching += upper && !fold;
      EXPECT_NEAR(f[2], fold ? 0.0 : (upper ? force : -force), 1e-12 * elastic);
      for (int d = 0; d < 2; d++) EXPECT_NEAR(f[d], 0.0, 1e-12 * elastic);
    }
    EXPECT_EQ(run.evaluate("c_touch[1]"), touching);
    EXPECT_NEAR(run.evaluate("c_touch[2]") / (touching * (elastic - force) * v), 1.0, 1e-12);
  }
}

// V4: a bag between two plates, of lines that hardly stretch, with a gas of 1.1e5 against 1e5
// outside: the force on a plate at half of the height, with constant temperature or entropy
SERIAL_TEST(Sheets, BagBetweenPlates)
{
  const int n = 120;
  const double R = 0.1;
  std::vector<Node> x;
  std::vector<std::vector<int>> lines;
  for (int i = 0; i < n; i++) {
    x.push_back({R * cos(2.0 * PI * i / n), R * sin(2.0 * PI * i / n), 0.0});
    lines.push_back({i, (i + 1) % n});
  }
  ScratchFile file("bag.msh", gmsh(1, x, lines));
  for (const auto &[gamma, force] : {std::pair(1.0, 7330.383), std::pair(1.4, 10140.028)}) {
    Scene run(free_body(2, -0.2, 0.2, 0.01, file.name, "thickness 0.001", "neohookean 1e10 0") +
              strprintf("fix b all mpm/airbag e gas 1.1e5 %g outside 1e5\n", gamma) +
              "fix move all nve\nvariable up equal 0.1-0.05*ramp(0,1)\nvariable down equal -v_up\n"
              "fix top all indent 1e13 plane y v_up hi\nfix low all indent 1e13 plane y v_down lo\n"
              "fix v all viscous 10.0\ntimestep 1e-6\nrun 8000\nvariable up equal 0.05\n"
              "run 9000\n");
    EXPECT_NEAR(measured("force", std::fabs(run.evaluate("f_top[2]"))) / force, 1.0, 0.03);
  }
}

TEST(Sheets, RanksAndRestart)
{
  const ScratchFile file("ranks.msh", folded(3, 6, 3, 0.05, 0.045)),
      own("serial.msh", folded(3, 6, 3, 0.05, 0.045));
  for (const std::string faces : {"no", "yes"}) {
    const std::string pair = "pair_style mpm/sheet 0.045 faces " + faces + "\npair_coeff * * 40\n";
    const std::string start =
        free_body(3, -0.3, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
        "comm_modify vel yes\n" + pair +
        strprintf("group rest id > %d\nfix move rest nve\n", 7 * 4) +
        "fix g all gravity 9.81 vector 0 0.3 -1\ntimestep 2e-4\n";
    Scene serial(replaced(start, file.name, own.name) + "run 200\n", MPI_COMM_SELF);
    Continued run(start, 100, lines_again(start) + pair, 100);
    const auto state = run.whole.gather();
    EXPECT_LT(measured("ranks", difference(serial.gather(), state)), 1e-9);
    EXPECT_TRUE(identical(state, run.again.gather()));
  }
}

// ghosts reach as far as faces need them, whatever the pair style has needed before
TEST(Sheets, GhostsAfterALargerDistance)
{
  const ScratchFile file("ghosts.msh", folded(3, 6, 3, 0.05, 0.045));
  Scene run(
      free_body(3, -0.3, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
      "pair_style mpm/sheet 0.3\npair_coeff * * 1e-9\nfix move all nve\ntimestep 1e-5\nrun 1\n"
      "pair_style mpm/sheet 0.045 faces yes\npair_coeff * * 40\n");
  EXPECT_EQ(run.error("run 1\n"), "");
}

// layers in the mesh that are closer than the distance are told once, and not after a restart
TEST(Sheets, WarnsOfLayersThatAreTooClose)
{
  const auto warnings = [&](double gap, double k, bool again) {
    ScratchFile file("close.msh", folded(3, 6, 3, 0.05, gap));
    const std::string fixes = "fix m all mpm/material density 1000 neohookean 1e5 0.3\n"
                              "fix e all mpm/elements " +
        file.name + " thickness 0.001\nfix move all nve\ntimestep 1e-5\n";
    const std::string pair = strprintf("pair_style mpm/sheet 0.045\npair_coeff * * %g\n", k);
    const ScratchFile kept("close.restart");
    std::string commands = MPM_TEST::box(3, "si", "f f f", "-0.3 0.6 -0.3 0.6 -0.3 0.6", 1, 0.02) +
        "create_points 1 mesh " + file.name + " thickness 0.001\n" + fixes + pair +
        "run 1\nrun 1\n";
    for (const bool repeated : {false, true})
      if (again)
        commands += "write_restart " + kept.name + "\nclear\nread_restart " + kept.name +
            "\nneighbor 0.02 bin\n" + fixes + (repeated ? pair : "") + "run 1\n";
    return lines_that_say(commands, "closer than the distance");
  };
  // of two pairs of layers with 28 nodes each, four at a fold are near along the sheet
  const auto close = warnings(0.04, 8.0, true);
  ASSERT_EQ(close.size(), 1u);
  EXPECT_THAT(close[0], HasSubstr(" 48 pairs of nodes"));
  EXPECT_THAT(close[0], HasSubstr("the closest by 0.04"));
  EXPECT_THAT(close[0], HasSubstr(strprintf("an energy of %.6g", 48 * 0.5 * 8.0 * 25e-6)));
  EXPECT_EQ(warnings(0.045, 8.0, false).size(), 0u);
  EXPECT_EQ(warnings(0.04, 0.0, false).size(), 0u);
}

// nodes at the same place have no direction to push each other to
SERIAL_TEST(Sheets, WarnsOfNodesAtTheSamePlace)
{
  const double gap = 0.03;
  for (const bool moved : {false, true}) {
    ScratchFile file("same.msh", folded(2, 6, 3, 0.05, gap));
    const auto lines = lines_that_say(
        free_body(3, -0.3, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
            "pair_style mpm/sheet 0.045\npair_coeff * * 8\nfix move all nve\ntimestep 1e-5\n" +
            (moved ? strprintf("set atom 10 z %.17g\n", gap) : "") + "run 0\n",
        "they may pass each other");
    EXPECT_EQ(lines.size(), moved ? 1u : 0u);    // onto node 46
  }
}

// what keeps less than D from all nodes can be in the middle of a triangle where the nodes around
// are farther than D, also when this has been stretched
TEST(Sheets, WarnsOfMeshesThatAreTooCoarse)
{
  const double a = 0.05;
  const auto warnings = [&](double D, double k, const std::string &run) {
    ScratchFile file("coarse.msh", folded(1, 6, 3, a, 0.0));
    return lines_that_say(
        free_body(3, -0.3, 0.8, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") +
            strprintf("pair_style mpm/sheet %g\npair_coeff * * %g\n", D, k) +
            "fix move all nve\ntimestep 1e-5\n" + run,
        "can pass between these");
  };
  const auto coarse = warnings(0.99 * a / sqrt(2.0), 1.0, "run 1\nrun 0\n");
  ASSERT_EQ(coarse.size(), 2u);    // once in each run
  EXPECT_THAT(
      coarse[0],
      HasSubstr(strprintf("fix mpm/elements e has places that are %.4g from", a / sqrt(2.0))));
  EXPECT_EQ(warnings(0.99 * a / sqrt(2.0), 0.0, "run 1\n").size(), 0u);
  const std::string stretch = "run 1\nvariable x atom 1.2*x\nset group all x v_x\n";
  EXPECT_EQ(warnings(1.01 * a / sqrt(2.0), 1.0, stretch).size(), 0u);
  EXPECT_EQ(warnings(1.01 * a / sqrt(2.0), 1.0, stretch + "run 1\n").size(), 1u);

  // lines: half of their length
  for (const double D : {0.024, 0.026}) {
    ScratchFile file("lines.msh", hanging(20, 0.9, 2));
    EXPECT_EQ(lines_that_say(
                  free_body(3, -0.6, 1.2, 0.02, file.name, "section 1e-6", "neohookean 1e5 0.3") +
                      strprintf("pair_style mpm/sheet %g\npair_coeff * * 1\n", D) +
                      "fix move all nve\ntimestep 1e-5\nrun 1\n",
                  "can pass between these")
                  .size(),
              D < 0.025 ? 1u : 0u);
  }
}

// a sheet whose nodes are over the middles of triangles of another one, which is held, and that is
// moved through it: told once, with the node, the element, and its fix. Not told: away from it, and
// around its rim to the other side
TEST(Sheets, WarnsOfNodesThatGoThrough)
{
  const double a = 0.05, h = 0.058;
  const ScratchFile file("strip.msh", folded(1, 6, 3, a, 0.0));
  const auto two_sheets = [&](double k) {
    const std::string mesh = "create_points 1 mesh " + file.name + " thickness 0.001";
    return MPM_TEST::box(3, "si", "f f f", "-0.4 0.9 -0.4 0.9 -0.4 0.4", 1, 0.02) + mesh + "\n" +
        mesh + strprintf(" move %.17g %.17g %g\n", a / 3.0, a / 3.0, h) +
        "group low id <= 28\ngroup up id > 28\n"
        "fix m all mpm/material density 1000 neohookean 1e5 0.3\n"
        "fix a low mpm/elements " +
        file.name + " thickness 0.001\nfix b up mpm/elements " + file.name +
        " thickness 0.001\npair_style mpm/sheet 0.045\n" +
        strprintf("pair_coeff * * %g\ntimestep 1e-3\n", k);
  };
  const std::string words = "has gone through element";
  const auto warnings = [&](const std::vector<Node> &velocities, double k) {
    std::string commands = two_sheets(k);
    for (const Node &v : velocities)
      commands += strprintf("fix go up move linear %g %g %g\nrun 200\nrun 200\nunfix go\n", v[0],
                            v[1], v[2]);
    return lines_that_say(commands, words);
  };
  const double down = -2.0 * h / 0.4, away = 0.5 / 0.4;
  const auto through = warnings({{0.0, 0.0, down}, {0.0, 0.0, -down}}, 1.0);
  ASSERT_EQ(through.size(), 2u);    // in one of the two runs of each way
  EXPECT_THAT(through[0], HasSubstr("of fix mpm/elements"));
  EXPECT_EQ(warnings({{0.0, 0.0, down}}, 0.0).size(), 0u);
  EXPECT_EQ(warnings({{0.0, 0.0, -down}}, 1.0).size(), 0u);
  EXPECT_EQ(warnings({{away, 0.0, 0.0}, {0.0, 0.0, down}, {-away, 0.0, 0.0}}, 1.0).size(), 0u);

  // all go to other ranks meanwhile
  for (const double z : {0.0, -2.0 * h})
    EXPECT_EQ(lines_that_say(two_sheets(1.0) +
                                 strprintf("displace_atoms all move -0.35 0 0\nrun 0\n"
                                           "displace_atoms all move 0.75 0 0\n"
                                           "displace_atoms up move 0 0 %.17g\nrun 0\n",
                                           z),
                             words)
                  .size(),
              z < 0.0 ? 1u : 0u);
}

// two sheets of triangles in no order, with a distance of a fifth of an edge, that come together
// with up to 0.4 of it in a step: none of their nodes goes through, which those that touch nodes
// only do at once; momentum is kept, and energy the better the shorter the steps, by their square
TEST(Sheets, FacesHoldNodes)
{
  const double a = 0.05, D = 0.01, dt = 1e-4, h = 1.2 * D,
               k = 0.2 * 1000.0 * 0.001 * a * a / 2.0 / dt / dt;
  const auto mesh = [&](int seed, double angle) {
    const int n = 8;
    unsigned state = (unsigned) seed;
    const auto random = [&]() {    // -1 to 1
      state = 1664525u * state + 1013904223u;
      return state / 2147483648.0 - 1.0;
    };
    std::vector<Node> x;
    std::vector<std::vector<int>> f;
    for (int j = 0; j <= n; j++)
      for (int i = 0; i <= n; i++) {
        const bool inner = i > 0 && i < n && j > 0 && j < n;
        const double p = a * (i - 0.5 * n + (inner ? 0.2 * random() : 0.0)),
                     q = a * (j - 0.5 * n + (inner ? 0.2 * random() : 0.0));
        x.push_back({cos(angle) * p - sin(angle) * q, sin(angle) * p + cos(angle) * q, 0.0});
      }
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) {
        const int p = j * (n + 1) + i, q = p + n + 1;
        f.push_back((i + j) % 2 ? std::vector<int>{p, p + 1, q}
                                : std::vector<int>{p, p + 1, q + 1});
        f.push_back((i + j) % 2 ? std::vector<int>{p + 1, q + 1, q}
                                : std::vector<int>{p, q + 1, q});
      }
    return gmsh(2, x, f);
  };
  const ScratchFile low("low.msh", mesh(1, 0.0)), up("up.msh", mesh(2, 0.37));
  const auto scene = [&](double speed, double step, const std::string &faces, double share = 1.0) {
    return MPM_TEST::box(3, "si", "f f f", "-0.6 0.6 -0.6 0.6 -0.5 0.5", 1, 0.5 * D) +
        "create_points 1 mesh " + low.name + " thickness 0.001\ncreate_points 1 mesh " + up.name +
        strprintf(" thickness 0.001 move 0.007 0.011 %g\n", h) +
        "group low id <= 81\ngroup up id > 81\n"
        "fix m all mpm/material density 1000 neohookean 1e5 0.3\n"
        "fix a low mpm/elements " +
        low.name + " thickness 0.001\nfix b up mpm/elements " + up.name + " thickness 0.001\n" +
        strprintf("pair_style mpm/sheet %g %s\npair_coeff * * %g\n", D, faces.c_str(), share * k) +
        strprintf("fix n all nve\nvelocity up set 0 0 %g\ntimestep %g\n", -speed, step) +
        "compute ke all ke\nthermo_modify norm no\n"
        "variable e equal c_ke+f_a[1]+f_b[1]+pe\nvariable p equal mass(all)*vcm(all,z)\n"
        "variable l equal vcm(low,z)\nvariable u equal vcm(up,z)\n"
        "thermo_style custom step pe v_e v_p v_l v_u\n";
  };
  const std::string words = "to the other side of element";
  for (const double part : first_of(3, {0.4, 0.1, 0.04, 0.01})) {    // of D in a step
    const double speed = part * D / dt;
    const std::string commands = scene(speed, dt, "faces yes");
    const int steps = (int) (3.5 * h / speed / dt);
    EXPECT_EQ(lines_that_say(commands + strprintf("run %d\nrun 0\n", steps), words).size(), 0u);
    Scene run(commands + "run 0\n");
    const double p = run.evaluate("v_p");
    run.commands(strprintf("run %d\n", steps));
    EXPECT_NEAR(run.evaluate("v_p") / p, 1.0, 1e-12);
    EXPECT_NEAR(measured("speed of the lower one", run.evaluate("v_l") / speed), -0.92, 0.03);
  }

  // energy: the same speed with steps of a half and a quarter

  double change[2];
  for (const int n : {1, 2}) {
    Scene run(scene(5.0, dt / (2 * n), "faces yes") + "run 0\n");
    const double e = run.evaluate("v_e");
    run.commands(strprintf("run %d\n", 170 * n));
    change[n - 1] = measured("energy", run.evaluate("v_e") / e - 1.0);
  }
  EXPECT_LT(std::fabs(change[1]), 0.003);
  EXPECT_NEAR(change[0] / change[1], 4.0, 1.0);

  // a low stiffness lets nodes go through by less than the distance and the skin: they come back

  const std::string weak = scene(20.0, dt, "faces yes", 0.1);
  EXPECT_EQ(lines_that_say(weak + "run 60\nrun 0\n", words).size(), 1u);
  Scene run(weak + "run 60\n");
  EXPECT_LT(run.evaluate("v_l"), 0.8 * -20.0);
  EXPECT_EQ(run.evaluate("pe"), 0.0);

  // flat sheets that are moved into each other: above and below, each contact has the energy of its
  // distance on its side, and a little less next to rims

  Scene moved(scene(1.0, dt, "faces yes") +
              "unfix n\ncompute touch all pair mpm/sheet\nthermo_style custom step pe c_touch[1]\n"
              "fix go up move linear 0 0 -1.0\n");
  for (const double gap : {0.5 * D, -0.4 * D}) {
    moved.commands(strprintf("run %d\n", (int) lround((gap > 0.0 ? h - gap : 0.9 * D) / dt)));
    const double contacts = moved.evaluate("c_touch[1]");
    EXPECT_GT(contacts, 100.0);
    EXPECT_NEAR(moved.evaluate("pe") / (0.5 * k * contacts * (D - gap) * (D - gap)), 1.0, 0.05);
  }

  // and so far that they do not

  EXPECT_EQ(lines_that_say(scene(20.0, dt, "faces yes", 0.01) + "run 60\nrun 0\n",
                           "it stays on the wrong side")
                .size(),
            1u);

  // nodes that touch nodes go through where these are not

  Scene nodes(scene(5.0, dt, "faces no") + "run 80\n");
  EXPECT_GT(nodes.evaluate("v_l"), -0.5 * 5.0);
}

SERIAL_TEST(Sheets, BadInput)
{
  ScratchFile file("strip.msh", folded(3, 6, 3, 0.05, 0.045));
  const auto failure = [&](const std::string &pair, const std::string &moves = "fix n all nve\n",
                           const std::string &step = "1e-5") {
    Scene run;
    return run.error(
        free_body(3, -0.6, 0.6, 0.02, file.name, "thickness 0.001", "neohookean 1e5 0.3") + pair +
        moves + "timestep " + step + "\nrun 1\n");
  };
  const std::string good = "pair_style mpm/sheet 0.045\npair_coeff 1 1 1.0\n";
  EXPECT_THAT(failure(good), "");
  EXPECT_THAT(failure("pair_style mpm/sheet\n"), HasSubstr("missing argument"));
  EXPECT_THAT(failure("pair_style mpm/sheet 0\n"), HasSubstr("0"));
  EXPECT_THAT(failure("pair_style mpm/sheet 0.045\npair_coeff 1 1 -1\n"), HasSubstr("-1"));
  EXPECT_THAT(failure("pair_style mpm/sheet 0.045\npair_coeff 1 1\n"), HasSubstr("pair_coeff"));
  EXPECT_THAT(failure("pair_style mpm/sheet 0.045\npair_coeff 1 1 1 damping 1\n"),
              HasSubstr("comm_modify vel yes"));
  EXPECT_THAT(failure("pair_style mpm/sheet 0.045 faces maybe\n"), HasSubstr("maybe"));
  Scene no_newton;
  EXPECT_THAT(no_newton.error("newton off\n" +
                              free_body(3, -0.6, 0.6, 0.02, file.name, "thickness 0.001",
                                        "neohookean 1e5 0.3") +
                              "pair_style mpm/sheet 0.045 faces yes\npair_coeff 1 1 1.0\n"
                              "fix n all nve\ntimestep 1e-5\nrun 1\n"),
              HasSubstr("newton on"));
  EXPECT_THAT(failure(good, "fix n all mpm 0.05\n"), HasSubstr("move them with fix nve"));
  EXPECT_THAT(failure(good, "unfix e\nfix n all nve\n"), HasSubstr("needs a fix mpm/elements"));
  EXPECT_THAT(failure("", "fix n all nve\n", "1.0"), HasSubstr("above the limit"));
  EXPECT_THAT(failure("", "fix n all nve\nrun 4 every 2 \"run 0\"\n"),
              HasSubstr("mpm/elements has not been set up"));
}

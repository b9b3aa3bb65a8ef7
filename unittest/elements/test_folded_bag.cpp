// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart
// mpi: 1 4
// timeout: 300

// A folded bag in 2d, without a lattice, that a gas blows up: its layers part without passing each
// other, the energy of the gas is found again, the shape is that of a bag which was never folded,
// and it pushes a body on a lattice.

#include "elements/thin_testing.h"
#include "error.h"

using namespace MPM_TEST;

constexpr double A = 0.01, GAP = 1.1 * A, WIDTH = 0.2, THICK = 4.0e-4, R_GAS = 287.0;

/** Half of a sheet of the bag, left of its middle line: out along the bottom, back, out again. */
static std::vector<Node> half_sheet(double offset)
{
  const int N = 200;
  const double out = WIDTH / 2 - 1.5 * GAP, back = 2.0 * GAP;
  std::vector<Node> line = {{0.0, offset, 0.0}};
  for (int k = 0; k <= N; k++) {
    const double t = -0.5 * PI + PI * k / N, r = GAP - offset;
    line.push_back({out + r * cos(t), GAP + r * sin(t), 0.0});
  }
  for (int k = 0; k <= N; k++) {
    const double t = -0.5 * PI - PI * k / N, r = GAP + offset;
    line.push_back({back + r * cos(t), 3.0 * GAP + r * sin(t), 0.0});
  }
  line.push_back({WIDTH / 2, 4.0 * GAP + offset, 0.0});
  return line;
}

/** Nodes around a bag whose sides are folded twice; each side has three panels of two layers. */
static std::vector<Node> folded()
{
  auto line = half_sheet(-0.5 * GAP);
  const auto upper = half_sheet(0.5 * GAP);
  line.insert(line.end(), upper.rbegin(), upper.rend());
  std::vector<double> s = {0.0};
  for (std::size_t k = 1; k < line.size(); k++)
    s.push_back(s.back() + hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]));
  const int n = (int) lround(s.back() / A);
  std::vector<Node> x;
  for (int i = 0; i <= n; i++) {
    const double at = s.back() * i / n;
    std::size_t k = 1;
    while (k + 1 < s.size() && s[k] < at) k++;
    const double w = (at - s[k - 1]) / (s[k] - s[k - 1]);
    x.push_back({line[k - 1][0] + w * (line[k][0] - line[k - 1][0]),
                 line[k - 1][1] + w * (line[k][1] - line[k - 1][1]), 0.0});
  }
  for (int i = n - 1; i > 0; i--) x.push_back({-x[i][0], x[i][1], 0.0});
  return x;
}

static double edge(const std::vector<Node> &x, int i)
{
  const int n = (int) x.size(), j = (i + 1) % n;
  return hypot(x[j][0] - x[i][0], x[j][1] - x[i][1]);
}

static double area(const std::vector<Node> &x)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); i++) {
    const Node &p = x[i], &q = x[(i + 1) % x.size()];
    sum += 0.5 * (p[0] * q[1] - q[0] * p[1]);
  }
  return sum;
}

/** The same lines in a circle. */
static std::vector<Node> in_a_circle(const std::vector<Node> &x)
{
  double length = 0.0, s = 0.0;
  for (int i = 0; i < (int) x.size(); i++) length += edge(x, i);
  const double R = length / (2.0 * PI);
  std::vector<Node> to;
  for (int i = 0; i < (int) x.size(); i++) {
    to.push_back({R * cos(s / R), R * sin(s / R), 0.0});
    s += edge(x, i);
  }
  return to;
}

static std::string mesh_of(const std::vector<Node> &x)
{
  std::vector<std::vector<int>> lines;
  for (int i = 0; i < (int) x.size(); i++) lines.push_back({i, (i + 1) % (int) x.size()});
  return gmsh(1, x, lines);
}

static std::string bag(const std::string &file, double k)
{
  return "units si\ndimension 2\nboundary f f p\nneighbor 0.008 bin\natom_style mpm\n"
         "region box block -0.5 0.5 -0.5 0.9 -0.01 0.01\ncreate_box 2 box\n"
         "create_points 1 mesh " +
      file + strprintf(" thickness %g\ngroup bag type 1\n", THICK) +
      "fix fabric bag mpm/material density 800 neohookean 3e8 0.3\nfix skin bag mpm/elements " +
      file + strprintf(" thickness %g compression no\n", THICK) +
      strprintf("pair_style mpm/sheet %g\npair_coeff * * 0\npair_coeff 1 1 %g\n", A, k) +
      "fix move bag nve\n";
}

/** How many lines cross another one that is not near along the bag. */
static int crossings(Scene &run, int n)
{
  const auto s = run.gather();
  const auto turn = [&](int a, int b, int c) {
    const double *p = s[a].x, *q = s[b].x, *r = s[c].x;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  };
  int found = 0;
  for (int i = 0; i < n; i++)
    for (int j = i + 4; j < n && j - i < n - 3; j++) {
      const int k = (i + 1) % n, l = (j + 1) % n;
      found += turn(i, k, j) * turn(i, k, l) < 0.0 && turn(j, l, i) * turn(j, l, k) < 0.0;
    }
  return found;
}

// 4 kg/s of gas come in, and the drag of the air outside takes energy: work of the gas = what it
// has lost, and = kinetic + stored + drag. Without contact (k = 0) layers pass each other
SERIAL_TEST(FoldedBag, Unfolds)
{
  const auto x = folded();
  const double V0 = area(x);
  ScratchFile file("folded.msh", mesh_of(x));
  for (const double k : {5.0e7, 0.0}) {
    Scene run(bag(file.name, k) +
              "variable flow equal 4*(time<0.02)\n"
              "fix gas all mpm/airbag skin gas 1e5 1.4 outside 1e5 temperature 300 287 inflow "
              "v_flow 600\nfix air bag viscous 0.32\ntimestep 3e-6\ncompute ke bag ke\n"
              "variable drag equal 2*c_ke*0.32*count(bag)/mass(bag)*dt\n"
              "fix drag all vector 1 v_drag\nvariable taken equal trap(f_drag)\n"
              "thermo_style custom step pe c_ke f_gas[1] f_skin[1] v_taken\nthermo 500\n");
    int passed = 0;
    for (int part = 0; part < (k > 0.0 ? 20 : 5); part++) {
      run.commands("run 500\n");
      passed += crossings(run, (int) x.size());
    }
    if (k == 0.0) {
      EXPECT_GT(measured("crossings without contact", passed), 4);
      continue;
    }
    EXPECT_EQ(measured("crossings", passed), 0);
    const double p = run.evaluate("f_gas[1]"), V = run.evaluate("f_gas[2]"),
                 m = run.evaluate("f_gas[4]"), T = run.evaluate("f_gas[5]"),
                 in = run.evaluate("f_gas[6]"), U = run.evaluate("f_gas[8]"),
                 work = run.evaluate("f_skin[3]");
    EXPECT_NEAR(in, 0.08, 2e-5);
    EXPECT_NEAR((m - in) * R_GAS * 300.0 / (1.0e5 * V0), 1.0, 1e-11);
    EXPECT_NEAR(p * V / (m * R_GAS * T), 1.0, 1e-12);
    EXPECT_GT(measured("work", work), 600.0);
    const double lost = 2.5 * (1.0e5 * V0) + in * 3.5 * R_GAS * 600.0 - U - 1.0e5 * (V - V0);
    EXPECT_NEAR(measured("work over what the gas has lost", work / lost), 1.0, 0.01);
    const double found = run.evaluate("c_ke") + run.evaluate("f_skin[1]") + run.evaluate("pe") +
        run.evaluate("v_taken");
    EXPECT_NEAR(measured("found of the work", found / work), 1.0, 0.01);
  }
}

// at constant temperature, folded or not, the bag comes to rest with one volume and pressure, round
SERIAL_TEST(FoldedBag, HasTheShapeOfOneThatWasNotFolded)
{
  const auto x = folded();
  const double M = 0.13, RT = R_GAS * 400.0;
  double volume[2], pressure[2];
  for (const bool folds : {true, false}) {
    const auto start = folds ? x : in_a_circle(x);
    const double first = folds ? 1.0e5 : M * RT / area(start);    // pressure
    const double comes = M - first * area(start) / RT;
    ScratchFile file("bag.msh", mesh_of(start));
    Scene run(bag(file.name, 5e7) +
              strprintf("variable flow equal %.15g*(time<0.015)\nfix gas all mpm/airbag skin gas "
                        "%.15g 1 outside 1e5 temperature 400 287 inflow v_flow 400\n",
                        folds ? comes / 0.015 : 0.0, first) +
              "fix air bag viscous 0.32\ntimestep 3e-6\nrun 6000\nunfix air\n"
              "fix air bag viscous 1.6\nrun 8000\n");
    double most[2] = {-1.0, -1.0}, least[2] = {1.0, 1.0};
    for (const auto &s : run.gather())
      for (int d = 0; d < 2; d++) {
        most[d] = std::max(most[d], s.x[d]);
        least[d] = std::min(least[d], s.x[d]);
      }
    EXPECT_NEAR(measured("width/height", (most[0] - least[0]) / (most[1] - least[1])), 1.0, 5e-4);
    EXPECT_NEAR(run.evaluate("f_gas[4]"), M, 2e-4 * M);
    volume[folds] = run.evaluate("f_gas[2]");
    pressure[folds] = run.evaluate("f_gas");
  }
  EXPECT_NEAR(measured("volume/that without folds", volume[1] / volume[0]), 1.0, 8e-4);
  EXPECT_NEAR(measured("pressure/that without folds", pressure[1] / pressure[0]), 1.0, 0.005);
}

// a blown up bag and a soft body on a lattice that hits it: momentum goes from one to the other;
// the ledger of the lattices has nothing of the bag, and is balanced; together with the energy of
// bag and gas, nothing is lost but what transfers take
TEST(FoldedBag, PushesABody)
{
  const auto x = in_a_circle(folded());
  ScratchFile file("round.msh", mesh_of(x));
  Scene run(bag(file.name, 5e7) +
            "region head sphere 0 0.26 0 0.05\ngroup head type 2\nfix grid head mpm 0.0125\n"
            "create_points 2 region head ppc 2 fix grid\ngroup head type 2\nfix foam head "
            "mpm/material density 200 neohookean 1e6 0.3\nvelocity head set 0 -20 0\n"
            "pair_coeff 1 2 1e7\nfix gas all mpm/airbag skin gas 1.3e5 1.4 outside 1e5\n"
            "timestep 3e-6\ncompute e all mpm/energy\ncompute ke bag ke\ncompute kh head ke\n"
            "compute eh head mpm/atom energy\ncompute sh head reduce sum c_eh\n"
            "variable P equal mass(all)*vcm(all,y)\nvariable H equal mass(head)*vcm(head,y)\n"
            "variable all equal c_ke+f_skin[1]-f_skin[3]+pe+c_e\n"
            "thermo_style custom step pe c_e c_e[1] c_ke c_kh c_sh v_P v_H f_skin[1] v_all\n"
            "run 0\n");
  const double P = run.evaluate("v_P"), H = run.evaluate("v_H"), E = run.evaluate("v_all");
  run.commands("run 4000\n");
  EXPECT_GT(measured("momentum", run.evaluate("v_H") / H), -1.0);
  EXPECT_LT(run.evaluate("v_H") / H, 0.7);
  EXPECT_NEAR(run.evaluate("v_P") / P, 1.0, 1e-11);
  EXPECT_NEAR(run.evaluate("c_e[1]") / run.evaluate("c_kh"), 1.0, 1e-12);
  EXPECT_NEAR(run.evaluate("c_e[2]") / run.evaluate("c_sh"), 1.0, 1e-12);
  EXPECT_LT(std::fabs(run.evaluate("c_e[11]")) / E, 1e-12);
  EXPECT_NEAR(measured("energy", (run.evaluate("v_all") - run.evaluate("c_e[9]")) / E), 1.0, 0.002);
  EXPECT_EQ(run.lmp->error->get_numwarn(), 0);
}

// large steps gain energy where slack lines become taut: there is a warning in each run
SERIAL_TEST(FoldedBag, LargeStepsAreReported)
{
  ScratchFile file("folded.msh", mesh_of(folded()));
  for (const auto &[fraction, warnings] : {std::pair(0.8, 2), std::pair(0.5, 0)}) {
    Scene run(
        bag(file.name, 5e7) +
        strprintf("fix gas all mpm/airbag skin gas 1.1e5 1.4 outside 1e5\nfix dt all mpm/dt %g\n"
                  "run 100\nrun 0\n",
                  fraction));
    EXPECT_EQ(run.lmp->error->get_numwarn(), warnings);
  }
  // lines that resist being pushed together have no jump
  Scene run(replaced(bag(file.name, 5e7), " compression no", "") +
            "fix dt all mpm/dt 0.8\nrun 100\n");
  EXPECT_EQ(run.lmp->error->get_numwarn(), 0);
}

// pairs of nodes of the bag are wanted: no advice to exclude them where there are many points
SERIAL_TEST(FoldedBag, NeedsPairsOfItsNodes)
{
  ScratchFile file("round.msh", mesh_of(in_a_circle(folded())));
  Scene run(bag(file.name, 5e7) +
            "region head sphere 0 0.4 0 0.1\ngroup head type 2\nfix grid head mpm 0.01\n"
            "create_points 2 region head ppc 2 fix grid\ngroup head type 2\nfix foam head "
            "mpm/material density 200 neohookean 1e6 0.3\ntimestep 1e-6\nrun 0\n");
  EXPECT_GT(run.n(), 1100);
  EXPECT_EQ(run.lmp->error->get_numwarn(), 0);
}

// a strip of metal without a lattice flies apart, and yields: what it spends is in fix mpm/elements
// and in restart files, and not in the ledger of a lattice
TEST(FoldedBag, StripThatYields)
{
  ScratchFile file("strip.msh", line(20, {-0.1, 0, 0}, {0.1, 0, 0}).text());
  const std::string scene = plane("si", "f f", "-0.5 0.5 -0.5 0.5 -0.01 0.01", 2, 0.01) +
      "create_points 1 mesh " + file.name +
      " thickness 0.001\ngroup strip type 1\nregion other block 0.2 0.3 0.2 0.3 INF INF\n"
      "group other type 2\nfix grid other mpm 0.05\ncreate_points 2 region other ppc 2 fix grid\n"
      "group other type 2\nvelocity all zero linear\nvariable v atom 1000*x*(type==1)\n"
      "velocity strip set v_v 0 0\n"
      "fix steel all mpm/material density 1000 eos linear 2e8 strength j2 1e8 1e6\n"
      "fix e strip mpm/elements " +
      file.name +
      " thickness 0.001\nfix move strip nve\ncompute e all mpm/energy\ncompute ke strip ke\n"
      "thermo_style custom step c_ke c_e f_e[1] f_e[2] f_e[3]\ntimestep 2e-6\n";
  Continued run(scene + "run 0\n", 60, lines_again(scene), 40);
  const double mass = 0.2, E = 0.5 * mass * 1.0e6 * 0.04 / 12.0;
  const double kinetic = run.whole.evaluate("c_ke"), stored = run.whole.evaluate("f_e[1]"),
               spent = run.whole.evaluate("f_e[2]");
  EXPECT_NEAR(measured("energy", (kinetic + stored + spent) / E), 1.0, 0.02);
  EXPECT_GT(measured("spent", spent / E), 0.1);
  EXPECT_EQ(run.whole.evaluate("f_e[3]"), 0.0);
  EXPECT_EQ(run.whole.evaluate("c_e[3]"), 0.0);
  EXPECT_NEAR(run.whole.evaluate("c_e"), 0.0, 1e-12);
  EXPECT_NEAR(run.again.evaluate("f_e[2]") / spent, 1.0, 1e-13);
  EXPECT_TRUE(identical(run.whole.gather(), run.again.gather()));
}

// The neighbor of a node across a periodic face that no longer has its copy here is not the atom at
// the other end of the box: with a greater cutoff the strip goes on as in a larger box
SERIAL_TEST(Strip, StretchesAcrossAPeriodicFace)
{
  ScratchFile file("strip.msh", line(10, {0.5, 0.5, 0}, {0.9, 0.5, 0}).text());
  const auto flight = [&](const char *length, const char *more) {
    return box(2, "lj", "p p p", std::string("0 ") + length + " 0 1 -0.1 0.1", 1, 0.01) +
        "fix grid all mpm 0.05\ncreate_points 1 mesh " + file.name +
        " thickness 0.01\nfix rubber all mpm/material density 1 neohookean 0.05 0.3\n"
        "fix skin all mpm/elements " +
        file.name + " thickness 0.01\n" + more +
        "variable v atom 3+6*(x-0.7)\nvelocity all set v_v 0 0\ntimestep 0.002\n"
        "thermo_modify lost ignore\nrun 160\n";
  };
  expect_error(flight("2", ""), "was stretched and needs a larger comm_modify cutoff");
  Scene small(flight("2", "comm_modify cutoff 0.2\n")), large(flight("8", ""));
  EXPECT_NEAR(small.fix("skin")->compute_vector(0), large.fix("skin")->compute_vector(0),
              1e-9 * large.fix("skin")->compute_vector(0));
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4

// Fix mpm/refine: one body on lattices of different spacing.

#include "mpm_lammps.h"

using namespace MPM_TEST;

namespace {

/** Origin of a lattice that is so many levels finer than one with spacing 1 and its origin at zero. */
double origin(const std::string &shape, int level)
{
  double at = 0.0;
  for (int k = 0; k < level; k++)
    if (shape == "quadratic") at += 0.25 / (1 << k);
  return at;
}

/** Fields F0, F1, ... of points of types 1, 2, ... with half the spacing each; regions: what the points of each fill, in box. */
std::string lattices(int dim, const std::string &shape, const std::string &options,
                     const std::vector<std::string> &regions)
{
  std::string head, points, all;
  for (int k = 0; k < (int) regions.size(); k++) {
    const double o = origin(shape, k);
    head += strprintf("group g%d type %d\nfix F%d g%d mpm %.17g shape %s %s origin %.17g %.17g", k,
                      k + 1, k, k, 1.0 / (1 << k), shape.c_str(), options.c_str(), o, o) +
        (dim == 3 ? strprintf(" %.17g\n", o) : "\n");
    std::string inner;
    if (k + 1 < (int) regions.size()) {    // without what is finer
      points += strprintf("region h%d %s side out\nregion b%d %s\nregion r%d intersect 2 b%d h%d\n",
                          k, regions[k + 1].c_str(), k, regions[k].c_str(), k, k, k);
    } else {
      points += strprintf("region r%d %s\n", k, regions[k].c_str());
    }
    points += strprintf("create_points %d region r%d ppc 2 fix F%d\ngroup g%d type %d\n", k + 1, k,
                        k, k, k + 1);
    all += strprintf(" F%d", k);
  }
  return head + "fix one all mpm/refine" + all + "\n" + points;
}

std::string nested(int dim, int levels, const std::string &shape, const std::string &options)
{
  std::vector<std::string> all = {"block 0 12 0 11 ", "block 3 10 3 9 ", "block 4 8 5 8 "};
  static const char *const along_z[] = {"0 9", "2 7", "3 6"};
  for (int k = 0; k < 3; k++) all[k] += dim == 3 ? along_z[k] : "INF INF";
  all.resize(levels);
  return lattices(dim, shape, options, all);
}

const char *const law = "fix m all mpm/material density 1 linear 1 0.25\n";

}    // namespace

// A velocity that is linear in space stays so at all kinds of rims, faces, edges, and corners: nothing but points between that move
// apart changes it, and in the total frame nothing at all
struct Patch {
  int dim, levels;
  const char *shape;
  friend void PrintTo(const Patch &p, std::ostream *out)
  {
    *out << p.dim << "d " << p.levels << " levels " << p.shape;
  }
};
PARAMETER_TEST(Velocity, StaysLinear, Patch,
               Values(Patch{2, 2, "linear"}, Patch{2, 3, "linear"}, Patch{2, 2, "quadratic"},
                      Patch{2, 3, "quadratic"}, Patch{2, 3, "cubic"}, Patch{3, 3, "quadratic"},
                      Patch{3, 2, "cubic"}, Patch{3, 2, "linear"}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &p = GetParam();
  Scene run(MPI_COMM_SELF);
  run.commands(box(p.dim, "lj", "f f f", "-1 13 -1 12 -1 10", p.levels, 0.2) +
               nested(p.dim, p.levels, p.shape, "frame total") +
               "fix m all mpm/material density 1 linear 1e-12 0.25\n"
               "variable vx atom 0.3+0.02*x-0.05*y+0.01*z\nvariable vy atom 0.1+0.05*x-0.01*y\n"
               "variable vz atom 0.03*x-0.02*z\nvelocity all set v_vx v_vy " +
               (p.dim == 3 ? "v_vz" : "0") + "\ntimestep 0.05\nrun 0\n");
  const auto before = run.gather();
  run.commands("run 10\n");
  EXPECT_GT(run.fix("one")->compute_vector(0), 20.0);    // tied
  EXPECT_GT(run.fix("one")->compute_vector(1), 20.0);    // free
  const auto after = run.gather();
  double worst = 0.0;
  for (std::size_t k = 0; k < after.size(); k++)
    for (int d = 0; d < 3; d++) worst = std::max(worst, std::fabs(after[k].v[d] - before[k].v[d]));
  EXPECT_LT(measured("change of velocity", worst), 1e-13);
}

// Uniform pressure in a box full of points gives no force on any node with linear functions, and next to none with others
PARAMETER_TEST(Pressure, IsInBalance, Patch,
               Values(Patch{2, 2, "linear"}, Patch{2, 3, "quadratic"}, Patch{3, 2, "quadratic"},
                      Patch{2, 2, "cubic"}))
{
  if (nranks() > 1) GTEST_SKIP() << "one rank is enough";
  const auto &p = GetParam();
  Scene run(MPI_COMM_SELF);
  const std::string stress = p.shape == std::string("linear") ? "" : "stress gradient";
  run.commands(box(p.dim, "lj", "p p p", "0 12 0 11 0 9", p.levels, 0.2) +
               nested(p.dim, p.levels, p.shape, stress) + law + "timestep 0.001\nrun 0\n");
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 3; c++) run.points().tau[i][c] = -1.0;
  run.commands("run 1\n");
  double worst = 0.0;
  for (const auto &point : run.gather())
    for (int d = 0; d < 3; d++) worst = std::max(worst, std::fabs(point.v[d]));
  // products of a linear and a quadratic function along two axes have another integral by coarse points than by fine ones
  EXPECT_LT(measured("velocity over that of pressure on a cell", worst / 0.001),
            p.shape == std::string("linear") ? 1e-12 : 1e-2);
}

// The finest points touch the coarsest ones, so that nodes between are tied to tied ones: linear velocities stay, also by their change
// (aflip), which takes the old velocities of tied nodes, and uniform pressure gives no force
SERIAL_TEST(Skip, ALatticeBetweenIsLeftOut)
{
  const std::vector<std::string> regions = {"block 0 12 0 11 INF INF", "block 3 10 3 9 INF INF",
                                            "block 3 8 5 8 INF INF"};
  for (const std::string shape : {"linear", "quadratic", "cubic"})
    for (const std::string options : {"frame total", "transfer aflip 1.0"}) {
      Scene run(plane("lj", "f f", "-1 13 -1 12", 3, 0.2) + lattices(2, shape, options, regions) +
                "fix m all mpm/material density 1 linear 1e-12 0.25\n"
                "variable vx atom 0.3+0.02*x-0.05*y\nvariable vy atom 0.1+0.05*x-0.01*y\n"
                "velocity all set v_vx v_vy 0\ntimestep 0.05\nrun 0\n");
      const auto before = run.gather();
      // where points move over the lattice, their gradients are later those of the step before
      run.commands(options == "frame total" ? "run 10\n" : "run 1\n");
      for (int n = 0; n < 4; n++) EXPECT_GT(run.fix("one")->compute_vector(n), 20.0) << n;
      const auto after = run.gather();
      double worst = 0.0;
      for (std::size_t k = 0; k < after.size(); k++)
        for (int d = 0; d < 2; d++)
          worst = std::max(worst, std::fabs(after[k].v[d] - before[k].v[d]));
      EXPECT_LT(measured("change of velocity", worst), 1e-13);
    }

  Scene run(plane("lj", "p p", "0 12 0 11", 3, 0.2) + lattices(2, "linear", "", regions) + law +
            "timestep 0.001\nrun 0\n");
  for (int i = 0; i < run.n(); i++)
    for (int c = 0; c < 3; c++) run.points().tau[i][c] = -1.0;
  run.commands("run 1\n");
  double worst = 0.0;
  for (const auto &point : run.gather())
    for (int d = 0; d < 2; d++) worst = std::max(worst, std::fabs(point.v[d]));
  EXPECT_LT(measured("velocity over that of pressure on a cell", worst / 0.001), 1e-12);
}

// A spinning body whose finer part crosses cells and periodic faces: momentum to round-off, energy as on one lattice
SERIAL_TEST(Momentum, OfABodyThatSpins)
{
  Scene run(plane("lj", "p p", "0 16 0 16", 2, 0.3) +
            lattices(2, "quadratic", "", {"block 4 12 5 11 INF INF", "block 8 12 5 11 INF INF"}) +
            "fix m all mpm/material density 1 neohookean 100 0.3\n"
            "variable vx atom 2-0.3*(y-8)\nvariable vy atom 1+0.3*(x-8)\n"
            "velocity all set v_vx v_vy 0\ncompute e all mpm/energy\n"
            "thermo_style custom step c_e\ntimestep 0.01\nrun 0\n");
  const Totals before(run.gather());
  const double energy = run.compute_scalar();
  double tied = run.fix("one")->compute_vector(0);
  run.commands("run 1000\n");
  const Totals after(run.gather());
  for (int d = 0; d < 2; d++) EXPECT_NEAR(after.p[d] / before.p[d], 1.0, 1e-12);
  EXPECT_NE(run.fix("one")->compute_vector(0), tied);    // other nodes than at first
  EXPECT_NEAR(measured("energy", run.compute_scalar() / energy), 1.0, 3e-3);
  EXPECT_LT(std::fabs(run.compute_vector()[10] / energy), 1e-10);    // residual of the ledger
}

/** Velocities of points of a strip after a packet of waves has left x0, sorted by place. */
static std::vector<std::array<double, 2>> wave(const std::string &points, double length, double x0)
{
  Scene run(plane("lj", "f p", "0 200 0 2", 2, 0.2) + points + law +
            strprintf("variable v atom 1e-6*cos(2*PI*(x-%g)/%g)*exp(0-((x-%g)/%g)^2)\n"
                      "velocity all set v_v 0 0\ntimestep 0.1\nrun 700\n",
                      x0, length, x0, length));
  std::vector<std::array<double, 2>> rows;
  for (const auto &point : run.gather())
    if (point.x[1] < 0.5) rows.push_back({point.x[0], point.v[0]});
  std::sort(rows.begin(), rows.end());
  return rows;
}

// Waves that come to a jump of the spacing: what comes back is the difference to a strip with the one lattice. Lumped
// linear functions have a known reflection, the same from both sides: 0.030253 for 8 coarse cells in a wave
SERIAL_TEST(Wave, IsHardlyReflected)
{
  const double length = 8.0;
  for (const std::string shape : {"linear", "quadratic"}) {
    const std::string o = shape == "linear" ? "" : strprintf(" origin %g %g", 0.25, 0.25);
    const auto jump = [&]() {
      return lattices(2, shape, "frame total",
                      {"block 0 200 0 2 INF INF", "block 100 200 0 2 INF INF"});
    };
    const auto uniform = [&](const std::string &lattice) {
      return "fix F all mpm " + lattice + " frame total shape " + shape +
          "\ncreate_points 1 box ppc 2\n";
    };
    for (const bool from_coarse : {true, false}) {
      const double x0 = from_coarse ? 60.0 : 140.0;
      const auto with = wave(jump(), length, x0),
                 without = wave(uniform(from_coarse ? "1.0" : "0.5" + o), length, x0);
      double back = 0.0, arrived = 0.0;
      std::size_t k = 0;
      for (const auto &row : without) {
        const bool near = (row[0] < 100.0) == from_coarse;
        if (!near) {
          arrived += row[1] * row[1];
          continue;
        }
        while (k < with.size() && with[k][0] < row[0] - 1e-3) k++;
        ASSERT_LT(k, with.size());
        ASSERT_NEAR(with[k][0], row[0], 1e-3);
        back += (with[k][1] - row[1]) * (with[k][1] - row[1]);
      }
      const double share = measured("share of the energy that comes back", back / arrived);
      EXPECT_GT(share, 1e-6);
      if (shape == "linear")
        EXPECT_LT(std::sqrt(share), 1.2 * 0.030253);
      else
        EXPECT_LT(share, 0.02);
    }
  }
}

TEST(Refine, RanksAndRestart)
{
  for (const bool total : {false, true}) {
    const int dim = total ? 2 : 3;
    const std::string head = box(dim, "lj", "p f p", "0 14 -1 12 0 9", 3, 0.3),
                      fields = nested(dim, 3, total ? "cubic" : "quadratic",
                                      total ? "frame total" : "locking fbar scheme musl");
    const std::string fixes = "fix m all mpm/material density 1 neohookean 1 0.3\n"
                              "fix w all mpm/boundary ylo slip\ntimestep 0.05\n";
    const std::string start = "variable vx atom 0.5+0.05*y\nvariable vy atom 0.02*(x-6)\n"
                              "velocity all set v_vx v_vy 0\n";
    const std::string run = "run 16\n";
    OnRanks ranks(head + fields + fixes + start, run);
    EXPECT_LT(measured("difference to one rank", ranks.difference()), 1e-10);
    OnRanks even(head + fields + fixes + start, run,
                 "comm_style tiled\nfix even all balance 4 1.0 rcb\n");
    EXPECT_LT(measured("difference to one rank, balanced", even.difference()), 1e-10);
    // after the restart, what creates points is left out
    std::string again;
    for (std::size_t at = 0, end; at < fields.size(); at = end + 1) {
      end = fields.find('\n', at);
      const std::string line = fields.substr(at, end - at);
      if (line.find("fix ") == 0) again += line + "\n";
    }
    Continued restart(head + fields + fixes + start, 8, "neighbor 0.3 bin\n" + again + fixes, 8);
    EXPECT_TRUE(identical(restart.whole.gather(), restart.again.gather()));
  }
}

SERIAL_TEST(BadInput, IsRefused)
{
  const std::string head = plane("lj", "f f", "0 8 0 8", 2, 0.2) +
      "region l block 0 4 0 8 INF INF\nregion r block 4 8 0 8 INF INF\n"
      "group a type 1\ngroup b type 2\n";
  const auto scene = [&](const std::string &coarse, const std::string &fine) {
    return head + "fix a a mpm 1.0 " + coarse + "\nfix b b mpm " + fine +
        "\ncreate_points 1 region l ppc 2 fix a\ncreate_points 2 region r ppc 2 fix b\n"
        "group a type 1\ngroup b type 2\n" +
        law;
  };
  const std::string fix = "fix one all mpm/refine a b", run = "\nrun 0\n";
  const struct {
    const char *coarse, *fine, *words;
  } fields[] = {
      {"", "0.5 origin 0.25 0.25 transfer flip 0.9", "use transfer apic"},
      {"", "0.25 origin 0.25 0.25", "node spacings in the ratio 2"},
      {"", "0.5", "origin 0.25 0.25"},
      {"shape linear", "0.5 shape linear origin 0.25 0.25", "origin 0 0"},
      {"shape cubic", "0.5 origin 0.25 0.25", "the same shape"},
      {"frame total", "0.5 origin 0.25 0.25", "the same frame"},
      {"shape gimp transfer apic", "0.5 shape gimp transfer apic", "use shape linear, quadratic"},
      {"frame total reference update 1.1", "0.5 origin 0.25 0.25 frame total reference update 1.1",
       "frame updated"},
      {"axisymmetric yes\nfix ax all mpm/boundary xlo slip",
       "0.5 origin 0.25 0.25 axisymmetric yes", "use a plane"},
      {"scheme usf", "0.5 origin 0.25 0.25 scheme usf", "use usl or musl"},
  };
  for (const auto &f : fields) expect_error(scene(f.coarse, f.fine) + fix + run, f.words);
  expect_refused(scene("", "0.5 origin 0.25 0.25"),
                 {{"fix one a mpm/refine a b", "use group all"},
                  {"fix one all mpm/refine a", "missing"},
                  {"fix one all mpm/refine a a", "named twice"},
                  {"fix one all mpm/refine a c" + run, "not the ID of a fix mpm"},
                  {fix + "\nfix two all mpm/refine a b" + run, "in common"},
                  {fix + "\nfix c all mpm/contact a b" + run, "leave one of them out"},
                  {fix + "\nfix i all mpm/implicit static" + run, "remove one of them"}});
  const std::string apart = head +
      "region m block 6 8 0 8 INF INF\nfix a a mpm 1.0\nfix b b mpm 0.5 "
      "origin 0.25 0.25\ncreate_points 1 region l ppc 2 fix a\n"
      "create_points 2 region m ppc 2 fix b\ngroup a type 1\n"
      "group b type 2\n";
  EXPECT_EQ(lines_that_say(apart + law + fix + "\nrun 1\n", "do not meet").size(), 1u);
  const std::string touching = replaced(apart, "block 6 8", "block 4 7") + law + fix +
      "\nregion t block 7 8 0 8 INF INF\ncreate_points 1 region t ppc 2 fix a group t\n"
      "fix t t mpm 1.0\ngroup a subtract a t\nfix c all mpm/contact a t\nrun 1\n";
  EXPECT_EQ(lines_that_say(touching, "let them meet through pair_style").size(), 1u);
}

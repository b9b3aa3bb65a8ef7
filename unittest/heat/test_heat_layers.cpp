// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi
// mpi: 1 4
// timeout: 200

// Fix mpm/heat in materials of different conductivity that share a lattice.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

struct Layer {
  std::string region;
  double k, capacity = 1.0;
};

/** A plate of length 1 along x between faces of the box at 1 and 0, whose parts have these
 *  conductivities, n cells long; offset: of its faces from nodes, in cells. */
static std::string
plate(int n, const std::vector<Layer> &layers, double width, double offset,
      const std::string &heat = "xlo temperature 1.0 xhi temperature 0.0 stages 100")
{
  const double h = 1.0 / n;
  std::string text =
      plane("lj", "f p", strprintf("0 1 0 %.17g", width), (int) layers.size(), 0.1 * h);
  std::string materials;
  for (std::size_t k = 0; k < layers.size(); k++) {
    const int type = (int) k + 1;
    text +=
        strprintf("region r%d %s\ncreate_points %d region r%d spacing %.17g\ngroup g%d type %d\n",
                  type, layers[k].region.c_str(), type, type, 0.5 * h, type, type);
    materials += strprintf("fix m%d g%d mpm/material density 1.0 eos linear 1e-6 thermal "
                           "conducting %g 0.5 %g\n",
                           type, type, layers[k].capacity, layers[k].k);
  }
  return text + strprintf("fix grid all mpm %.17g origin %.17g 0\n", h, -offset * h) + materials +
      "fix heat all mpm/heat " + heat + "\n";
}

/** Power through the plate in its steady state. */
static double power(Scene &run, double dt, double end)
{
  run_to(run, end, dt);
  const double *const flows = run.fix_vector("heat", 9);
  EXPECT_NEAR(flows[0] / flows[1], -1.0, 1e-10);
  return flows[0];
}

// three layers one behind the other: the resistance is that of all
SERIAL_TEST(Layers, InSeries)
{
  for (const double offset : {0.0, 0.25, 0.5}) {
    double error[2];
    for (const int n : {12, 24}) {
      Scene run(plate(n,
                      {{"block 0 0.25 INF INF INF INF", 1.0},
                       {"block 0.25 0.5 INF INF INF INF", 0.2},
                       {"block 0.5 1 INF INF INF INF", 4.0}},
                      4.0 / n, offset));
      const double q = power(run, 5.0 / (n * n), 6.0) * n / 4.0 * (0.25 + 0.25 / 0.2 + 0.5 / 4.0);
      error[n == 24] = std::fabs(measured(strprintf("offset %g, %d cells", offset, n), q) - 1.0);
    }
    EXPECT_LT(error[0], 0.01);
    EXPECT_LT(error[1], 0.005);
    EXPECT_GT(measured("order", std::log2(error[0] / error[1])), 0.9);
  }
}

// also if one of them is a single cell thick
SERIAL_TEST(Layers, ThinOneInSeries)
{
  for (const int n : {12, 24})
    for (const double offset : {0.0, 0.3, 0.5}) {
      const double h = 1.0 / n;
      Scene run(plate(n,
                      {{"block 0 0.25 INF INF INF INF", 1.0},
                       {strprintf("block 0.25 %.17g INF INF INF INF", 0.25 + h), 0.2},
                       {strprintf("block %.17g 1 INF INF INF INF", 0.25 + h), 4.0}},
                      4.0 * h, offset));
      const double q =
          power(run, 5.0 * h * h, 4.0) / (4.0 * h) * (0.25 + 5.0 * h + (0.75 - h) / 4.0);
      EXPECT_NEAR(measured(strprintf("offset %g, %d cells", offset, n), q), 1.0, 0.02);
    }
}

// the steady state does not depend on capacities
SERIAL_TEST(Layers, OfDifferentCapacity)
{
  for (const int n : {12, 24}) {
    Scene run(plate(n,
                    {{"block 0 0.25 INF INF INF INF", 100.0, 100.0},
                     {"block 0.25 0.5 INF INF INF INF", 1.0, 1.0},
                     {"block 0.5 1 INF INF INF INF", 100.0, 100.0}},
                    4.0 / n, 0.0));
    const double q = power(run, 5.0 / (n * n), 60.0) * n / 4.0 * (0.75 / 100.0 + 0.25);
    EXPECT_NEAR(measured(strprintf("%d cells", n), q), 1.0, 0.03);
  }
}

// layers beside each other let through what each of them does, also those that have so little
// capacity that the mean of conductivities would be too fast for them
SERIAL_TEST(Layers, InParallel)
{
  for (const double capacity : {1.0, 0.05}) {
    Scene run(plate(
        12, {{"block INF INF 0 0.5 INF INF", 10.0}, {"block INF INF 0.5 1 INF INF", 1.0, capacity}},
        1.0, 0.25));
    EXPECT_NEAR(measured(strprintf("capacity %g", capacity), power(run, 0.005, 2.0)) / 5.5, 1.0,
                1e-12);
  }
}

// a checkerboard of 1 and 10 conducts as the root of 10 (J. B. Keller, J. Math. Phys. 5 (1964) 548)
SERIAL_TEST(Layers, Checkerboard)
{
  double error[2];
  for (const int n : {16, 32}) {
    // the faces go through the middle of tiles
    Scene run(plate(n,
                    {{"block 0 0.25 0 0.5 INF INF", 1.0},
                     {"block 0.25 0.75 0 0.5 INF INF", 10.0},
                     {"block 0.75 1 0 0.5 INF INF", 1.0},
                     {"block 0 0.25 0.5 1 INF INF", 10.0},
                     {"block 0.25 0.75 0.5 1 INF INF", 1.0},
                     {"block 0.75 1 0.5 1 INF INF", 10.0}},
                    1.0, 0.0));
    error[n == 32] = std::fabs(
        measured(strprintf("%d cells", n), power(run, 10.0 / (n * n), 1.0) / std::sqrt(10.0)) -
        1.0);
  }
  EXPECT_LT(error[1], 0.02);
  EXPECT_GT(measured("order", std::log2(error[0] / error[1])), 0.6);
}

// a disk in a closed body that conducts less: heat is kept, no extreme grows
SERIAL_TEST(Layers, KeepHeat)
{
  for (const double capacity : {1.0, 1e-3}) {
    Scene run(replaced(
        plate(16, {{"sphere 0.5 1 0 0.4", 50.0}, {"intersect 2 whole around", 0.5, capacity}}, 2.0,
              0.2, ""),
        "region r1 sphere",
        "region whole block 0 1 0 2 INF INF\nregion around sphere 0.5 1 0 0.4 side out\n"
        "region r1 sphere"));
    for (const char *id : {"m1", "m2"})
      Warm(run, id).set([](const double *x) {
        return x[0] < 0.4 ? 1.0 : 0.0;
      });
    const auto heat = [&]() {
      return Warm(run, "m1").heat() + Warm(run, "m2").heat();
    };
    const double before = heat();
    run.commands("timestep 1e-6\nrun 200\n");
    EXPECT_NEAR(heat() / before, 1.0, 1e-13);
    for (const char *id : {"m1", "m2"}) {
      const auto [least, most] = Warm(run, id).range();
      EXPECT_LT(measured(strprintf("capacity %g, %s, most", capacity, id), most), 1.1);
      EXPECT_GT(measured("least", least), -0.1);
    }
  }
}

// a material without points in this field changes no bit, and no time step; here it is that of
// another field, which would need 100 times shorter steps, has axes, or does not conduct
TEST(Unused, ChangesNothing)
{
  const std::string scene =
      replaced(plate(12,
                     {{"block 0 0.5 INF INF INF INF", 1.0}, {"block 0.5 1 INF INF INF INF", 0.1}},
                     4.0 / 12, 0.3, "xlo temperature 1.0 xhi convection 2.0 0.0 stages 5"),
               "fix grid all", "group points type 1 2\ngroup none empty\nfix grid points") +
      "fix dt all mpm/dt 0.9\n";
  Scene plain(scene + "run 30\n");
  for (const std::string other :
       {"conducting 1.0 0.5 100.0", "conducting 1.0 0.5 1.0 orthotropic 2.0 3.0", ""}) {
    Scene run(replaced(scene, "fix heat all",
                       "fix m3 none mpm/material density 0.1 eos linear 1e-6 " +
                           (other.empty() ? "" : "thermal " + other) + "\nfix heat all") +
              "run 30\n");
    EXPECT_EQ(run.lmp->update->dt, plain.lmp->update->dt) << other;
    ASSERT_EQ(run.n(), plain.n());
    for (const char *m : {"m1", "m2"}) {
      Warm a(plain, m), b(run, m);
      for (int i = 0; i < run.n(); i++)
        if (b.has(i)) ASSERT_EQ(b.T(i), a.T(i)) << other;
    }
  }
}

// fix mpm/dt knows conductivities that temperatures have raised, also in what is next to them
SERIAL_TEST(Vary, HasATimeStep)
{
  for (const double capacity : {0.25, 1.0}) {
    Scene run(replaced(plate(12,
                             {{"block 0 0.5 INF INF INF INF", 1.0, capacity},
                              {"block 0.5 1 INF INF INF INF", 1.0}},
                             4.0 / 12, 0.3, "stages 1"),
                       "1 0.5 1\nfix heat",
                       "1 0.5 1 vary thermal.K table 0.0 1.0 0.4 20.0\nfix heat") +
              "fix dt all mpm/dt 0.9\nrun 20\n");
    // not far below the limit of quadratic functions, 0.33 h^2 rho c/K
    EXPECT_GT(measured("dt", run.lmp->update->dt), 0.9 * 0.1 * capacity / (20.0 * 144.0));
  }
}

// no means across interfaces of orthotropic materials: this is said where conductivities differ
SERIAL_TEST(Orthotropic, IsWarnedOf)
{
  for (const bool orthotropic : {false, true}) {
    const std::string scene = replaced(
        plate(12, {{"block 0 0.5 INF INF INF INF", 1.0}, {"block 0.5 1 INF INF INF INF", 0.1}},
              4.0 / 12, 0.0),
        "0.5 0.1\n", orthotropic ? "0.5 0.1 orthotropic 0.2 0.3\n" : "0.5 0.1\n");
    EXPECT_EQ(lines_that_say(scene + "timestep 1e-3\nrun 1\n", "one of them is orthotropic").size(),
              orthotropic ? 1u : 0u);
  }
}

// nor with functions that are not smooth, or in the total frame
SERIAL_TEST(Shapes, WithoutMeansAreWarnedOf)
{
  const std::string scene =
      plate(12, {{"block 0 0.5 INF INF INF INF", 1.0}, {"block 0.5 1 INF INF INF INF", 0.1}},
            4.0 / 12, 0.0) +
      "timestep 1e-3\nrun 1\nrun 1\n";
  for (const std::string options :
       {"", " shape cubic", " shape linear", " shape gimp", " frame total"}) {
    const auto warnings = lines_that_say(replaced(scene, " 0\nfix m1", " 0" + options + "\nfix m1"),
                                         "no means across");
    EXPECT_EQ(warnings.size(), options.empty() || options == " shape cubic" ? 0u : 1u) << options;
    for (const auto &line : warnings)    // with functions that end at faces of cells
      EXPECT_EQ(line.find("unless they are in planes of nodes") != std::string::npos,
                options.find("shape") != std::string::npos)
          << options;
    EXPECT_EQ(lines_that_say(replaced(replaced(scene, " 0\nfix m1", " 0" + options + "\nfix m1"),
                                      "0.5 0.1\n", "0.5 0.7\n"),
                             "no means across")
                  .size(),
              0u);
  }
}

TEST(Ranks, Agree)
{
  const std::string scene =
      plate(16, {{"block 0 0.3 0 1 INF INF", 1.0}, {"sphere 0.6 0.5 0 0.25", 20.0}}, 1.0, 0.3,
            "xlo temperature 1.0 xhi convection 2.0 0.0") +
      "velocity g2 set -0.4 0.1 0\ntimestep 1e-3\n";
  OnRanks run(scene, "run 60\n");
  EXPECT_LT(run.difference(), 1e-12);
  EXPECT_NEAR(heat_in(run.parallel) / heat_in(run.serial), 1.0, 1e-11);
}

/** Two bars 10 mm long that touch at x = 10 mm, at 300 and 100 K: the first one of aluminum, the
 *  other one of a light material. */
struct TouchingBars {
  double h;
  std::string grid = "", heat = "";    // options of fix mpm and fix mpm/heat
  std::array<double, 2> k = {237, 23.7}, C = {9.03e6, 6.03e5};
  bool fields = false;    // has each bar a field of its own?

  std::string text() const
  {
    const auto mpm = strprintf(" mpm %.17g ", h) + grid + "\n";
    return plane("si", "f p", strprintf("0 0.02 0 %.17g", 8 * h), 2, 0.5 * h) +
        "region r1 block 0 0.01 INF INF INF INF\nregion r2 block 0.01 0.02 INF INF INF INF\n" +
        strprintf("create_points 1 region r1 spacing %.17g\ncreate_points 2 region r2 spacing "
                  "%.17g\ngroup g1 type 1\ngroup g2 type 2\n",
                  0.5 * h, 0.5 * h) +
        (fields ? "fix A g1" + mpm + "fix B g2" + mpm + "fix touch all mpm/contact A B law stick\n"
                : "fix grid all" + mpm) +
        strprintf("fix m1 g1 mpm/material density 1e4 eos linear 1e-5 thermal conducting %.17g 300 "
                  "%.17g\nfix m2 g2 mpm/material density 1e3 eos linear 1e-5 thermal conducting "
                  "%.17g 100 %.17g\n",
                  1e-4 * C[0], k[0], 1e-3 * C[1], k[1]) +
        "fix heat all mpm/heat " + heat +
        (fields ? strprintf(" contact A B conductance %.17g\n", 1000 * k[0] / h) : "\n");
  }
  /** Temperature there after a time (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids
   *  (1959), 2.15): the interface has the mean by effusivities. */
  double exact(double x, double t) const
  {
    const double T[2] = {300, 100};
    const double b[2] = {std::sqrt(k[0] * C[0]), std::sqrt(k[1] * C[1])},
                 at_interface = (b[0] * T[0] + b[1] * T[1]) / (b[0] + b[1]);
    const int side = x > 0.01;
    return at_interface +
        (T[side] - at_interface) *
        std::erf(std::fabs(x - 0.01) / std::sqrt(4.0 * k[side] / C[side] * t));
  }
  /** Largest errors of points at a time, in steps of at most dt: of all, and of those three cells
   *  from the interface. Heat is kept. */
  std::array<double, 2> errors(double t, double dt) const
  {
    Scene run(text());
    Warm bars[2] = {Warm(run, "m1"), Warm(run, "m2")};
    const double before = bars[0].heat() + bars[1].heat();
    run_to(run, t, dt);
    EXPECT_NEAR((bars[0].heat() + bars[1].heat()) / before, 1.0, 1e-13);
    std::array<double, 2> most = {0.0, 0.0};
    for (int i = 0; i < run.n(); i++) {
      const double x = run.x()[i][0], error = std::fabs(bars[x > 0.01].T(i) - exact(x, t));
      most[0] = std::max(most[0], error);
      if (std::fabs(std::fabs(x - 0.01) / h - 3.0) < 0.5) most[1] = std::max(most[1], error);
    }
    return most;
  }
};

// points next to the interface take its temperature at the rate of their own material. In the total
// frame there are no means of conductivities
SERIAL_PARAMETER_TEST(Touching, HaveTheTemperatureOfTheInterface, const char *,
                      Values("", "shape cubic", "frame total"))
{
  const bool total = strcmp(GetParam(), "frame total") == 0;
  for (const char *heat : {"", "time sdirk2"})
    for (const double h : {1e-3, 5e-4}) {
      const bool coarse = h > 6e-4;
      const auto error = TouchingBars{h, GetParam(), heat}.errors(0.1, h);
      const auto name = strprintf("%s %s, %g mm: ", GetParam(), heat, 1e3 * h);
      EXPECT_LT(measured(name + "all", error[0]), total ? 4.5 : coarse ? 17.0 : 6.5);
      EXPECT_LT(measured(name + "at 3 cells", error[1]), total ? 4.5 : coarse ? 2.4 : 0.75);
    }
}

// what follows fast smooths the kink of a steady temperature: not much in short steps, either, and
// for capacities of very different size a warning tells what does not follow
SERIAL_TEST(Touching, SteadyFlowInShortSteps)
{
  for (const double capacity : {15.0, 100.0}) {
    const auto scene = plate(12,
                             {{"block 0 0.25 INF INF INF INF", 10.0, capacity},
                              {"block 0.25 0.5 INF INF INF INF", 1.0},
                              {"block 0.5 1 INF INF INF INF", 10.0, capacity}},
                             4.0 / 12, 0.0);
    EXPECT_EQ(lines_that_say(scene + "timestep 1e-4\nrun 0\n", "conductance of 1e+05").size(),
              capacity > 16 ? 1u : 0u);
    if (capacity > 16) continue;
    Scene run(scene);
    const double q = power(run, 0.25 / 144, 8.0) * 12 / 4.0 * (0.75 / 10.0 + 0.25);
    EXPECT_NEAR(measured("flow", q), 1.0, 0.02);
  }
}

// what the warning advises: with a field for each material, capacities may have any ratio, and the
// interface any place between nodes, in short steps and in the steady state, too
SERIAL_TEST(Touching, BodiesOfTheirOwnFields)
{
  constexpr double h = 1e-3;
  for (const double ratio : {16.0, 100.0, 1000.0})
    for (const double slower : {10.0, ratio})
      for (const double shift : {0.0, 0.3}) {
        TouchingBars bars{h, strprintf("origin %.17g 0", -shift * h)};
        bars.k[1] = bars.k[0] / slower;
        bars.C[1] = bars.C[0] / ratio;
        bars.fields = true;
        const double D = bars.k[1] / bars.C[1];
        const auto error = bars.errors(4e-6 / D, 0.1 * h * h / std::max(D, bars.k[0] / bars.C[0]));
        const auto name = strprintf("capacities %g, conductivities %g, %g: ", ratio, slower, shift);
        EXPECT_LT(measured(name + "all", error[0]), 0.01 * 200);
        EXPECT_LT(measured(name + "at 3 cells", error[1]), 0.007 * 200);
      }
}
SERIAL_TEST(Touching, SteadyFlowThroughALayerOfItsOwnField)
{
  for (const double ratio : {100.0, 1000.0}) {
    auto scene = plate(12,
                       {{"block 0 0.25 INF INF INF INF", ratio, ratio},
                        {"block 0.25 0.5 INF INF INF INF", 1.0},
                        {"block 0.5 1 INF INF INF INF", ratio, ratio}},
                       4.0 / 12, 0.3);
    const auto at = scene.find("fix grid all");
    const auto options = scene.substr(at + 12, scene.find('\n', at) - at - 12);
    scene.replace(at, 12 + options.size(),
                  "group outer union g1 g3\nfix A outer" + options + "\nfix B g2" + options +
                      "\nfix touch all mpm/contact A B law stick");
    Scene run(replaced(scene, "stages 100",
                       strprintf("stages 100 contact A B conductance %g", 12000 * ratio)));
    const double q = power(run, 0.25 / 144, 4.0) * 12 / 4.0 * (0.75 / ratio + 0.25);
    EXPECT_NEAR(measured(strprintf("%g", ratio), q), 1.0, 4e-5);
  }
}

// the same on several ranks, and on two lattices
TEST(Touching, OnRanks)
{
  OnRanks run(TouchingBars{1e-3, "", "xlo temperature 300 xhi temperature 300"}.text() +
                  "timestep 0.001\n",
              "run 50\n");
  EXPECT_LT(run.difference(), 1e-13);
  for (const char *id : {"m1", "m2"}) {
    Warm one(run.serial, id), all(run.parallel, id);
    EXPECT_NEAR(all.heat() / one.heat(), 1.0, 1e-12);
    EXPECT_NEAR(all.range()[0] / one.range()[0], 1.0, 1e-11);
    EXPECT_NEAR(all.range()[1] / one.range()[1], 1.0, 1e-11);
  }
}

SERIAL_TEST(Touching, OnTwoLattices)
{
  const double h = 5e-4;
  const TouchingBars touching{h};
  const auto whole = touching.text();
  const auto at = whole.find("fix grid");
  // the interface is on the finer lattice
  Scene run(whole.substr(0, at) +
            "region fine block 0.009 1 INF INF INF INF\ngroup fine region fine\n"
            "group coarse subtract all fine\n" +
            strprintf("fix C coarse mpm %.17g\nfix F fine mpm %.17g origin %.17g %.17g\nfix R all "
                      "mpm/refine C F\n",
                      2 * h, h, 0.5 * h, 0.5 * h) +
            whole.substr(whole.find("fix m1")));
  Warm bars[2] = {Warm(run, "m1"), Warm(run, "m2")};
  const double before = bars[0].heat() + bars[1].heat();
  run_to(run, 0.1, h);
  EXPECT_NEAR((bars[0].heat() + bars[1].heat()) / before, 1.0, 1e-13);
  double most = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double x = run.x()[i][0];
    most = std::max(most, std::fabs(bars[x > 0.01].T(i) - touching.exact(x, 0.1)));
  }
  EXPECT_LT(measured("all", most), 10.0);
}

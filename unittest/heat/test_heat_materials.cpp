// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics mpi restart input
// mpi: 1 4
// timeout: 300

// Conduction with axes, with properties that depend on the temperature, with a range of melting.

#include "heat/heat_testing.h"

using namespace MPM_TEST;

/** The bar of heat_testing.h of another material. */
static std::string bar_of(const std::string &thermal, int n, const std::string &heat,
                          const std::string &grid = "")
{
  return replaced(bar(n, heat, 0.0, grid), "conducting 1.0 0 1.0", thermal);
}

/** A periodic square of 20 x 20 cells. thermal: what follows the specific heat of 1. */
static std::string square(const std::string &thermal, const std::string &grid = "")
{
  return plane("lj", "p p", "0 1 0 1", 1, 0.005) +
      "create_points 1 box spacing 0.025\nfix grid all mpm 0.05 " + grid +
      "\nfix m all mpm/material density 1 eos linear 1e-6 thermal conducting 1 0 " + thermal +
      "\nfix heat all mpm/heat stages 64\n";
}

constexpr double WAVE = 2.0 * PI, SOON = 0.01;    // wave number, time

// A plane wave across an orthotropic body decays by the conductivity along its direction
SERIAL_TEST(Orthotropic, WavesDecayByTheirDirection)
{
  struct Case {
    const char *thermal;
    double expected[2];    // along x and y
  };
  for (const Case &c : {Case{"3 orthotropic 1 2", {3.0, 1.0}},
                        Case{"3 orthotropic 1 2 axes 0 1 0 1 0 0", {1.0, 3.0}},
                        Case{"3 orthotropic 1 2 angle 90", {1.0, 3.0}},
                        Case{"3 orthotropic 1 2 axes 0 0 1 1 0 0", {1.0, 2.0}},
                        Case{"3 orthotropic 1 2 angle 45", {2.0, 2.0}}})
    for (const int axis : {0, 1}) {
      Scene run(square(c.thermal));
      Warm warm(run);
      warm.set(cosine(1.0, 0.5, axis));
      run_to(run, SOON, 0.0005);
      const double rms =
          warm.rms(cosine(std::exp(-WAVE * WAVE * c.expected[axis] * SOON), 0.5, axis));
      EXPECT_LT(measured(std::string(c.thermal) + (axis ? ", y, rms" : ", x, rms"), rms), 0.02);
    }
}

// with axes at 45 degrees a wave cos(k x) cos(k y) sends heat along both, as two plane waves do
PARAMETER_TEST(OrthotropicDiagonal, TwoWaves, const char *,
               Values("", "frame total", "shape linear"))
{
  Scene run(square("2 orthotropic 0.5 1 angle 45", GetParam()));
  Warm warm(run);
  // cos a cos b = (cos(a + b) + cos(a - b))/2 with the wave numbers k (1, 1) and k (1, -1)
  const auto waves = [](double along, double across) {
    return [=](const double *x) {
      return 0.5 *
          (along * std::cos(WAVE * (x[0] + x[1])) + across * std::cos(WAVE * (x[0] - x[1])));
    };
  };
  warm.set(waves(1.0, 1.0));
  const double before = warm.heat();
  run_to(run, SOON, 0.0002);
  EXPECT_NEAR(warm.heat(), before, 1e-12);
  const double decay = -2.0 * WAVE * WAVE * SOON;
  EXPECT_LT(measured("rms", warm.rms(waves(std::exp(2.0 * decay), std::exp(0.5 * decay)))), 0.01);
}

// the axes turn with the body: F is a rotation by 45 degrees
SERIAL_TEST(Orthotropic, AxesTurn)
{
  Scene run(square("2 orthotropic 0.5 1"));
  const double s = std::sqrt(0.5), turned[9] = {s, -s, 0.0, s, s, 0.0, 0.0, 0.0, 1.0};
  for (int i = 0; i < run.n(); i++) std::copy_n(turned, 9, run.points().F[i]);
  Warm warm(run);
  const auto wave = [](double amplitude) {
    return [=](const double *x) {
      return amplitude * std::cos(WAVE * (x[0] + x[1]));
    };
  };
  warm.set(wave(1.0));
  run_to(run, SOON, 0.0002);
  EXPECT_LT(measured("rms", warm.rms(wave(std::exp(-2.0 * WAVE * WAVE * 2.0 * SOON)))), 0.01);
}

// K = 1 + T between two ends: the integral of K is linear
PARAMETER_TEST(Table, OfTheConductivity, const char *, Values("", "frame total"))
{
  Scene run(bar_of("conducting 1.0 0 1.0 vary thermal.K table 0 1 1 2", 20,
                   "xlo temperature 1.0 xhi temperature 0.0 stages 64", GetParam()));
  Warm warm(run);
  run_to(run, 1.5, 0.005);
  const double rms = warm.rms([](const double *x) {
    return std::sqrt(1.0 + 3.0 * (1.0 - x[0])) - 1.0;
  });
  EXPECT_LT(measured("rms", rms), 2.0e-4);
  EXPECT_NEAR(measured("flux", run.fix_vector("heat", 7)[0] / 0.2), 1.5, 3e-4);
}

/** Expects that the enthalpy of a bar, heat(T) of its temperatures, is kept while its specific heat
 *  varies, with one stage and with many; and that temperatures have the heat of a source. */
template <class Heat>
static void expect_enthalpy(const char *varies, const Heat &heat, double kept, double of_source)
{
  for (const double dt : {0.25, 20.0}) {
    const int n = 20;
    Scene run(bar_of(varies, n, "stages 64"));
    Warm warm(run);
    warm.set([](const double *x) {
      return 0.9 + 0.8 * std::cos(PI * x[0]);
    });
    const auto enthalpy = [&] {
      double sum = 0.0;
      for (int i = 0; i < run.n(); i++) sum += run.mass()[i] * heat(warm.T(i));
      return over_ranks(sum);
    };
    const double before = enthalpy();
    run_to(run, 0.1, dt / (n * n));
    EXPECT_NEAR(measured("enthalpy", enthalpy() / before), 1.0, kept);
  }
  Scene run(bar_of(varies, 10, "source v_s") + "variable s equal 2.0\n");
  run_to(run, 0.7, 0.01);
  Warm warm(run);
  for (int i = 0; i < run.n(); i++) EXPECT_NEAR(heat(warm.T(i)), 1.4, of_source);
}

// Enthalpy is kept to round-off while properties change; so are temperatures by sources
SERIAL_TEST(Table, OfTheSpecificHeat)
{
  const std::vector<double> T = {0.0, 0.4, 0.5, 2.0}, C = {1.0, 3.0, 1.5, 4.0};
  // the integral of straight lines between the entries, without the code that is tested
  const auto heat = [&](double at) {
    double H = std::min(at, 0.0);
    for (std::size_t k = 1; k < T.size(); k++) {
      const double width = std::min(at, T[k]) - T[k - 1];
      if (width > 0.0)
        H += width * (C[k - 1] + 0.5 * width * (C[k] - C[k - 1]) / (T[k] - T[k - 1]));
    }
    return H;
  };
  expect_enthalpy("conducting 1.0 0 1.0 vary CP table 0 1 0.4 3 0.5 1.5 2 4", heat, 1e-13, 1e-6);
}

// The same by a formula, whose heat is that of the integral
SERIAL_TEST(Formula, OfTheSpecificHeat)
{
  const char *const formula = "conducting 1.0 0 1.0 vary CP exponential 0.5 0 0 3";
  const auto heat = [](double T) {
    return std::expm1(0.5 * T) / 0.5;
  };
  for (const double dt : {0.25, 20.0}) {
    const int n = 20;
    Scene run(bar_of(formula, n, "stages 64"));
    Warm warm(run);
    warm.set([](const double *x) {
      return 0.9 + 0.8 * std::cos(PI * x[0]);
    });
    const auto enthalpy = [&] {
      double sum = 0.0;
      for (int i = 0; i < run.n(); i++) sum += run.mass()[i] * heat(warm.T(i));
      return over_ranks(sum);
    };
    const double before = enthalpy();
    run_to(run, 0.1, dt / (n * n));
    EXPECT_NEAR(measured("enthalpy", enthalpy() / before), 1.0, 1e-6);
  }
  Scene run(bar_of(formula, 10, "source v_s"));
  run.commands("variable s equal 2.0\n");
  run_to(run, 0.7, 0.01);
  Warm warm(run);
  for (int i = 0; i < run.n(); i++) EXPECT_NEAR(heat(warm.T(i)), 1.4, 5e-6);
}

// Melting over a range: heat that comes evenly, and the front of a wide range against a narrow one
SERIAL_TEST(MeltingRange, TemperatureFollowsHeat)
{
  Scene run(bar_of("conducting 2.0 0 1.0 melt 0.5 3.0 over 0.5", 10, "source v_s"));
  run.commands("variable s equal 1.0\n");
  Warm warm(run);
  const int molten = warm.material->find_history("molten");
  // 1 to melt, 3 + 1 to melt it, and then 2 for each degree
  double at = 0.0;
  for (const auto &[time, T, f] : {std::array<double, 3>{0.5, 0.25, 0.0},
                                   {1.0, 0.5, 0.0},
                                   {3.0, 0.75, 0.5},
                                   {5.0, 1.0, 1.0},
                                   {7.0, 2.0, 1.0}}) {
    run_to(run, time - at, 0.01);
    at = time;
    for (int i = 0; i < run.n(); i++) {
      EXPECT_NEAR(warm.T(i), T, 1e-11);
      EXPECT_NEAR(warm.material->history[i][molten], f, 1e-11);
    }
  }
}

// Stefan's problem, St = 1, and the same with a range of 0.02, whose mush is a second similarity
// solution: the heat of fusion over that of all, and its order
SERIAL_PARAMETER_TEST(Front, Moves, const char *, Values("melt 0.0 1.0", "melt 0.0 1.0 over 0.02"))
{
  const std::string melting = GetParam();
  const double exact = melting.find("over") == std::string::npos ? 0.392162 : 0.391924;
  double error[3];
  for (const int k : {0, 1, 2}) {
    const int n = 25 << k;
    Scene run(bar_of("conducting 1.0 0 1.0 " + melting, n, "xlo temperature 1.0 stages 1"));
    run_to(run, 0.1, 0.3 / (n * n));
    const auto [liquid, enthalpy] = Warm(run).melt();
    error[k] = measured(strprintf("%s, %d cells, error", GetParam(), n), liquid - exact);
    EXPECT_LT(std::fabs(error[k]), 1.0 / n);
    EXPECT_NEAR(enthalpy / heat_in(run), 1.0, 1e-11);
  }
  EXPECT_LT(std::fabs(error[2]), 0.003 * exact);
  EXPECT_GT(measured("order", 0.5 * std::log2(std::fabs(error[0] / error[2]))), 0.9);
}

// in steps of 30 explicit limits, too
SERIAL_PARAMETER_TEST(FrontInStages, Moves, const char *,
                      Values("melt 0.0 1.0", "melt 0.0 1.0 over 0.02"))
{
  const int n = 50;
  Scene run(bar_of(std::string("conducting 1.0 0 1.0 ") + GetParam(), n,
                   "xlo temperature 1.0 stages 20"));
  run_to(run, 0.1, 30 * 0.3267 / (n * n));
  const auto [liquid, enthalpy] = Warm(run).melt();
  EXPECT_NEAR(measured("molten", liquid), 0.392, 0.01 * 0.392);
  EXPECT_NEAR(enthalpy / heat_in(run), 1.0, 1e-11);
}

// A line sink in liquid at its melting point: radius of the front 2 * 0.5 sqrt(t), Q = 4.033885
SERIAL_TEST(FrontIn2d, IsRound)
{
  const int n = 40;
  const double h = 1.0 / n, reach = 2.0 * h;
  Scene run(
      plane("lj", "f f", "0 1 0 1", 1, 0.1 * h) +
      strprintf("create_points 1 box spacing %.17g\nfix grid all mpm %.17g\n", 0.5 * h, h) +
      conductor("1.0 melt 0.0 1.0", 1e-9) +
      strprintf("variable s atom -4.033885/4*(sqrt(x*x+y*y)<%.17g)/v_area\n", reach) +
      strprintf(
          "variable inside atom (sqrt(x*x+y*y)<%.17g)*%.17g\ncompute area all reduce sum v_inside\n"
          "variable area equal c_area\nfix heat all mpm/heat source v_s stages 1\n",
          reach, 0.25 * h * h));
  Warm warm(run);
  const double end = 0.36;
  run_to(run, end, 0.3 * h * h);
  const int molten = warm.material->find_history("molten");
  double ice = 0.0, low = 10.0, high = 0.0, all = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double f = warm.material->history[i][molten], *const x = run.x()[i];
    const double r = std::hypot(x[0], x[1]);
    ice += (1.0 - f) * 0.25 * h * h;
    all += run.mass()[i] * (warm.T(i) - 1e-9 - (1.0 - f));
    if (f < 0.5) high = std::max(high, r);
    if (f >= 0.5) low = std::min(low, r);
  }
  EXPECT_NEAR(measured("radius", std::sqrt(4.0 * ice / PI)), std::sqrt(end), 0.01 * std::sqrt(end));
  EXPECT_LT(measured("roundness in cells", (high - low) / h), 1.5);
  EXPECT_NEAR(all / run.fix("heat")->compute_scalar(), 1.0, 1e-10);
}

// a hot half of a bar melts the cold one: just as much when the bar moves across the lattice
SERIAL_TEST(FrontInABar, DoesNotSeeItsMotion)
{
  const int n = 50;
  const double h = 1.0 / n;
  double liquid[2];
  for (const bool moves : {false, true}) {
    Scene run(plane("lj", "p p", strprintf("0 4 0 %.17g", 4 * h), 1, 0.1 * h) +
              "region body block 0 1 INF INF INF INF\n" +
              strprintf("create_points 1 region body spacing %.17g\nfix grid all mpm %.17g\n",
                        0.5 * h, h) +
              conductor("1.0 melt 0.0 0.5") + "fix heat all mpm/heat stages 1\n");
    Warm warm(run);
    const int molten = warm.material->find_history("molten");
    for (int i = 0; i < run.n(); i++)
      if (run.x()[i][0] < 0.5) warm.T(i) = warm.material->history[i][molten] = 1.0;
    run.commands(strprintf("velocity all set %g 0 0\n", moves ? 7.3 : 0.0));
    run_to(run, 0.05, 0.3 * h * h);
    liquid[moves] = measured(moves ? "moving, molten" : "at rest, molten", warm.melt()[0]);
  }
  EXPECT_NEAR(liquid[1] / liquid[0], 1.0, 1e-4);
  EXPECT_GT(liquid[0], 0.6);
}

/** Water on a bar of 0.1 m, with n cells, of this temperature [C], whose end xlo has another one,
 *  after an hour. Specific heat changes to that of water from 0 to width, conductivity from low to
 *  high. */
struct Water {
  static constexpr double LATENT = 333400.0, ICE = 2050.0, WATER = 4226.0;
  Scene run;
  double molten = 0.0;      // mean fraction
  double enthalpy = 0.0;    // above that of the start, if that is liquid

  Water(int n, int start, int end, double width, double low, double high, const char *stages = "") :
      run(plane("si", "f p", strprintf("0 0.1 0 %.17g", 0.4 / n), 1, 0.01 / n) +
          body("box",
               strprintf("density 1000 eos linear 1e-3 thermal conducting 2050 %d 2.22 melt 0 "
                         "333400 vary CP table 0 1 %g 2.0614634146341464 vary thermal.K "
                         "table %g 1 %g 0.2504504504504505",
                         start, width, low, high),
               strprintf("%.17g", 0.1 / n)) +
          strprintf("fix heat all mpm/heat xlo temperature %d %s\n", end, stages))
  {
    Warm warm(run);
    // nine tenths of the explicit limit of ice
    run_to(run, 3600.0, 0.9 * 0.98 * 2.0 / 6.0 * 0.01 / (n * n) * 1000.0 * ICE / 2.22);
    const int column = warm.material->find_history("molten");
    for (int i = 0; i < run.n(); i++) {
      const double f = warm.material->history[i][column], T = warm.T(i);
      molten += f / run.n();
      enthalpy +=
          run.mass()[i] * ((T < 0.0 ? ICE : WATER) * T + LATENT * f - WATER * start - LATENT);
    }
  }
};

// Neumann: water of 10 degrees freezes below a wall of -20: 27.765 mm of ice after an hour
SERIAL_TEST(Neumann, WaterFreezes)
{
  for (const int n : first_of(1, {50, 100})) {
    Water water(n, 10, -20, 1e-6, 0.0, 1e-6, "stages 1");
    const double front = measured("front [m]", 0.1 * (1.0 - water.molten));
    EXPECT_NEAR(front / 0.0277650, 1.0, n > 50 ? 0.01 : 0.03);
    EXPECT_NEAR(water.enthalpy / heat_in(water.run), 1.0, 2e-8);    // 1e-6 degrees of the table
    if (n > 50) EXPECT_LT(std::fabs(front - 0.0277650), 0.1 / n);
  }
}

// The same in both directions, with the jump of the conductivity on either side of the temperature
// of melting: what is partly molten belongs to neither phase. Where the liquid grows it is 12.823
// mm thick (a root of Neumann's equation by bisection)
SERIAL_TEST(Neumann, DoesNotSeeTheSideOfTheJump)
{
  for (const bool melts : first_of(1, {false, true})) {
    double front[2];
    for (const bool above : {false, true}) {
      const Water water(50, melts ? -10 : 10, melts ? 20 : -20, 1e-3, above ? 0.0 : -1e-3,
                        above ? 1e-3 : 0.0);
      front[above] = measured(strprintf("%s, jump %s, front [m]", melts ? "melts" : "freezes",
                                        above ? "above" : "below"),
                              0.1 * (melts ? water.molten : 1.0 - water.molten));
      EXPECT_NEAR(front[above] / (melts ? 0.0128229 : 0.0277650), 1.0, 0.02);
    }
    EXPECT_NEAR(front[1] / front[0], 1.0, 2e-4);
  }
}

// long steps, at whose end the heat of fusion is taken, are told of
SERIAL_TEST(Neumann, LongStepsWarn)
{
  const int n = 20;
  for (const double limits : {0.9, 3.0, 5.0})
    EXPECT_EQ(lines_that_say(bar_of("conducting 1.0 0.1 1.0 melt 0.0 10.0", n,
                                    "xlo temperature -1.0 stages 20") +
                                 strprintf("timestep %.17g\nrun 40\n", limits * 0.3267 / (n * n)),
                             "material melts or freezes")
                  .size(),
              limits > 4.0 ? 1u : 0u)
        << limits;
}

// plastic work with a specific heat by temperature, and melting over a range: the same heat
TEST(Adiabatic, TakesTheSameHeat)
{
  double heat[2];
  for (const bool varies : {false, true}) {
    const std::string scene = varies
        ? replaced(replaced(disk(""), "conducting 1.5 1.0 0.4",
                            "conducting 1.5 1.0 0.4 melt 1.02 0.5 over 0.1"),
                   "eos linear 30.0 thermal conducting 0.7 2.0 0.1",
                   "eos linear 30.0 strength j2 10.0 0.2 thermal conducting 0.7 2.0 0.1 vary CP "
                   "table 2 1 2.004 1.5")
        : disk("");
    Scene run(scene + "compute e all mpm/energy\nrun 100\n");
    heat[varies] = run.compute_vector()[4];
    if (!varies) continue;
    Warm one(run, "m"), two(run, "n");
    const int molten = one.material->find_history("molten");
    double sum = 0.0, first = 0.0, most_molten = 0.0, warmest = 0.0, of_two = 0.0;
    for (int i = 0; i < run.n(); i++) {
      if (two.has(i)) {
        // 0.7 below 2, 1.05 above 2.004, and a straight line between them
        const double above = two.T(i) - 2.0, inside = std::min(std::max(above, 0.0), 0.004);
        const double gained =
            0.7 * (above + 0.5 * inside * inside / 0.008 + 0.5 * std::max(above - 0.004, 0.0));
        sum += run.mass()[i] * (0.7 * 2.0 + gained);
        first += run.mass()[i] * 0.7 * 2.0;
        warmest = std::max(warmest, above);
        of_two = std::max(of_two, two.material->history[i][two.material->find_history("eplastic")]);
      }
      if (!one.has(i)) continue;
      sum += run.mass()[i] * (1.5 * one.T(i) + 0.5 * one.material->history[i][molten]);
      first += run.mass()[i] * 1.5;
      most_molten = std::max(most_molten, one.material->history[i][molten]);
    }
    sum = over_ranks(sum), first = over_ranks(first);
    EXPECT_NEAR((sum - first - heat[1]) / first, 0.0, 1e-13);
    EXPECT_GT(measured("most molten", over_ranks(most_molten, MPI_MAX)), 0.3);
    EXPECT_GT(measured("warmest, specific heat varies", over_ranks(warmest, MPI_MAX)), 0.004);
    EXPECT_GT(measured("plastic strain there", over_ranks(of_two, MPI_MAX)), 0.01);
  }
  EXPECT_GT(heat[1], 0.1);
}

// any number of ranks, and restarts
TEST(Materials, RanksAgree)
{
  const std::string scene = replaced(disk(""), "conducting 1.5 1.0 0.4",
                                     "conducting 1.5 1.0 0.4 melt 1.05 0.5 over 0.2 orthotropic "
                                     "0.1 0.2 angle 30 vary thermal.K table 1 1 2 2 "
                                     "vary CP table 1 1 2 1.5");
  OnRanks run(scene, "run 60\n");
  EXPECT_LT(measured("difference", temperature_difference(run.serial, run.parallel)), 1e-12);
}

SERIAL_TEST(BadInput, IsRefused)
{
  for (const auto &[thermal, message] :
       {Mistake{"over 0.5", "add 'melt TMELT LATENT'"},
        {"melt 1 1 over -0.5", "over"},
        {"angle 30", "add it"},
        {"orthotropic 1", "orthotropic"},
        {"orthotropic 1 -1", "K3"},
        {"orthotropic 1 1 axes 1 0 0 2 0 0", "not parallel"},
        {"vary thermal.K table 0 1 1 -1", "out of range"},
        {"vary CP linear -1.5 0 0 1", "out of range"},
        {"vary CP table 0 1 1 0", "out of range"},
        {"vary T0 table 0 1 1 0.5", "can vary"},
        {"vary CP table 0 1 1 2 random CP normal 0.1 1 7", "random CP"}})
    expect_error(bar_of("conducting 1 0 1 " + thermal, 10, "") + "run 0\n", message);
  expect_error(replaced(bar_of("conducting 1 0 1", 10, ""), "mpm/heat",
                        "mpm/heat region wl temperature 4 region wl flux 1") +
                   "run 0\n",
               "is given twice for the same region: wl");
}

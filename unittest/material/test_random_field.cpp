// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit physics restart ranks
// mpi: 1 2

// Random fields: moments, correlation, and that they depend on nothing but position, length, and
// seed; materials with random parameters, point by point, and through the fix.

#include "material/material_testing.h"
#include "material/random_field.h"
#include "mpm_lammps.h"

using namespace material_testing;
using MPM_NS::RandomField;
using MPM_TEST::Scene;

/** Needs FFTW: where the build lacks it, only the error is tested. */
class Random : public ::testing::Test {
  void SetUp() override
  {
    if (!RandomField::available()) GTEST_SKIP() << "built without FFTW";
  }
};

const std::string STEEL =
    "density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening linear 2e9 ";

/** Mean and standard deviation of values; expect() allows for multiples of deviation/sqrt(n). */
struct Moments {
  double n = 0.0, sum = 0.0, square = 0.0;
  void add(double x)
  {
    n++;
    sum += x;
    square += x * x;
  }
  void expect(double mean, double deviation, double means = 4.0, double deviations = 5.0) const
  {
    const double m = sum / n;
    EXPECT_NEAR(m, mean, means * deviation / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(square / n - m * m), deviation, deviations * deviation / std::sqrt(n));
  }
};

/** check(x) at the places of a lattice of 11^3 points. */
template <class Check> void at_places(double spacing, const Check &check)
{
  const int side = 11;
  for (int i = 0; i < side * side * side; i++) {
    const double x[3] = {spacing * (i % side), spacing * (i / side % side),
                         spacing * (i / side / side)};
    check(x);
  }
}

TEST(RandomDefinition, Errors)
{
  if (!RandomField::available()) {
    expect_refused({{STEEL + "random SIGMAY normal 0.1 1 1", "without FFTW"}});
    return;
  }
  expect_refused(
      {{"random", "random: name of the parameter is missing"},
       {"random SIGMA normal 0.1 1 1",
        "random SIGMA: no such parameter: choose one of density, eos.K, strength.G, "
        "strength.SIGMAY"},
       {"random SIGMAY weibull 0.1 1 1", "the distribution must be lognormal or normal"},
       {"random SIGMAY normal -0.1 1 1", "COV = -0.1 (coefficient of variation) is out of range"},
       {"random SIGMAY normal 0.1 0 1", "LENGTH = 0 (correlation length) is out of range"},
       {"random SIGMAY normal 0.1 1", "random SIGMAY: SEED is missing"},
       {"random SIGMAY normal 0.1 1 1.5", "SEED must be an integer"},
       {"random SIGMAY normal 0.1 1 1 random strength.SIGMAY normal 0.1 1 2", "is given twice"},
       {"random strength.H normal 0.1 1 1 random K normal 0.1 1 1 random eos.K normal 0.1 1 1",
        "random eos.K: is given twice"},
       {"random B normal 0.1 1 1", "its value is 0, which a factor does not change"},
       {"thermal adiabatic 460 300 random LATENT normal 0.1 1 1", "its value is 0"},
       {"random density normal 0.1 1 1 random density normal 0.1 1 2", "is given twice"},
       {"viscosity maxwell term 1e9 1 term 2e9 2 random G3 normal 0.1 1 1",
        "no such parameter: choose one of density, eos.K, strength.G, strength.SIGMAY"},
       {"viscosity maxwell term 1e9 1 term 2e9 2 random G2 normal 0.1 1 1 random maxwell.G2 normal "
        "0.1 1 1",
        "random maxwell.G2: is given twice"}},
      STEEL);
  expect_refused({{"density 1000 eos tait 2.2e9 7 random PMIN normal 0.1 1 1",
                   "PMIN: its value is -"}});    // no limit
  // the same name in two laws
  const std::string two = "density 1 eos linear 1e9 viscosity newtonian 1 bulk 2 "
                          "viscosity bingham 1 1 10 ";
  expect_refused({{"random viscosity.MU normal 0.1 1 1",
                   "several laws of this material have it: choose density, eos.K, "
                   "newtonian.MU, newtonian.ZETA, bingham.MU"}},
                 two);
  EXPECT_NO_THROW(make(two +
                       "random newtonian.MU normal 0.1 1 1 random viscosity.ZETA normal 0.1 1 1 "
                       "random bingham.MU normal 0.1 1 1 random TAUY normal 0.1 1 1"));
  // the same parameter of two terms
  EXPECT_NO_THROW(make(STEEL +
                       "viscosity maxwell term 1e9 1 term 2e9 2 random G1 normal 0.1 1 1 "
                       "random G2 normal 0.1 1 1"));
}

// points far apart: mean, variance, and distribution; pairs at a distance: correlation
TEST_F(Random, MomentsAndCorrelation)
{
  const double length = 0.1;
  const RandomField field(length, 7);
  const int side = 11;    // a value each 2.1 lengths, where the correlation is 0.012
  double mean = 0.0, square = 0.0, fourth = 0.0, n = side * side * side;
  int inside = 0;
  const double distance[] = {0.25, 0.5, 1.0, 1.5};
  double pair[4][2] = {};
  for (int i = 0; i < side; i++)
    for (int j = 0; j < side; j++)
      for (int k = 0; k < side; k++) {
        const double x[3] = {2.1 * length * i - 1.5, 2.1 * length * j + 0.77, 2.1 * length * k};
        const double f = field.value(x);
        mean += f / n;
        square += f * f / n;
        fourth += f * f * f * f / n;
        inside += std::fabs(f) < 1.0;
        for (int d = 0; d < 4; d++) {
          const double along[3] = {x[0] + length * distance[d], x[1], x[2]};
          const double a = length * distance[d] / std::sqrt(3.0);
          const double across[3] = {x[0] + a, x[1] - a, x[2] + a};
          pair[d][0] += f * field.value(along) / n;
          pair[d][1] += f * field.value(across) / n;
        }
      }
  // of 1331 values nearly independent of each other: four standard errors
  const double e = 4.0 / std::sqrt(n);
  EXPECT_NEAR(mean, 0.0, e);
  EXPECT_NEAR(square, 1.0, 1.5 * e);
  EXPECT_NEAR(fourth, 3.0, 10.0 * e);
  EXPECT_NEAR(inside / n, 0.6827, 0.5 * e);
  for (int d = 0; d < 4; d++)
    for (double c : pair[d]) EXPECT_NEAR(c, std::exp(-distance[d] * distance[d]), 1.5 * e);

  // three times as many values along each axis: the squares of neighbors correlate by exp(-2
  // (1.05)^2), of all neighbors of a value in sum by 0.83, which leaves 1/1.83 of them as
  // independent values
  const int dense = 3 * side;
  double variance = 0.0;
  for (int i = 0; i < dense * dense * dense; i++) {
    const double x[3] = {1.05 * length * (i % dense) - 1.5,
                         1.05 * length * (i / dense % dense) + 0.77,
                         1.05 * length * (i / dense / dense)};
    variance += std::pow(field.value(x), 2) / (dense * dense * dense);
  }
  EXPECT_NEAR(variance, 1.0, 4.0 * std::sqrt(2.0 * 1.83 / (dense * dense * dense)));
}

TEST_F(Random, IsSmoothAndTheSameFromAnywhere)
{
  const RandomField a(1.0, 99), b(1.0, 99);
  std::vector<std::array<double, 3>> points;
  for (int n = 0; n < 200; n++)
    points.push_back(
        {11.0 * std::sin(n * 1.3), 10.0 * std::sin(n * 2.1), 6.0 + 5.0 * std::cos(n * 0.7)});
  std::vector<double> values;
  double same = 0.0;
  for (const auto &x : points) {
    values.push_back(a.value(x.data()));
    same += values.back() * values.back();
  }
  for (int n = 199; n >= 0; n--) {    // in another order
    EXPECT_EQ(b.value(points[n].data()), values[n]);
    if (n == 100) b.release();
  }

  // another seed, another field: a correlation of 200 pairs, of which some are neighbors
  for (const uint64_t seed : {98, 100, 2147483647}) {
    const RandomField c(1.0, seed);
    double other = 0.0;
    for (int n = 0; n < 200; n++) other += c.value(points[n].data()) * values[n];
    EXPECT_LT(std::fabs(other), 5.0 / std::sqrt(200.0) * same) << seed;
  }

  // across the face between two tiles, of 12 lengths: smooth, with the slope of both sides
  for (const double y : {0.3, 5.7, 11.9}) {
    const auto f = [&](double x) {
      const double p[3] = {x, y, 0.4 * y};
      return a.value(p);
    };
    const double h = 1e-3;
    EXPECT_NEAR(f(12.0 - 1e-12), f(12.0 + 1e-12), 1e-8);
    EXPECT_NEAR(f(12.0 + h) - f(12.0), f(12.0) - f(12.0 - h), 10 * h * h);
    EXPECT_NE(f(12.0 + h), f(12.0 - h));
  }

  // and along each axis, across what lies between the nodes of its splines
  for (int axis = 0; axis < 3; axis++) {
    const double h = 1e-3;
    double last[2] = {};
    for (int n = 0; n < 1000; n++) {
      double x[3] = {3.1, 4.3, 5.7};
      x[axis] += n * h;
      const double f = a.value(x);
      if (n > 1) EXPECT_NEAR(f - last[0], last[0] - last[1], 20 * h * h) << axis << ' ' << n;
      last[1] = last[0];
      last[0] = f;
    }
  }
}

// factors have mean 1 and the coefficient of variation that was asked for
TEST_F(Random, FactorsOfAMaterial)
{
  const RandomField field(0.1, 7);
  for (const char *kind : {"lognormal", "normal"}) {
    const auto material = make(STEEL + "random strength.SIGMAY " + kind + " 0.2 0.1 7");
    ASSERT_EQ(material->history().size(), 2);
    EXPECT_EQ(material->history()[1].name, "random/strength.SIGMAY");
    EXPECT_NE(
        material->describe().find(std::string("random strength.SIGMAY ") + kind + " 0.2 0.1 7"),
        std::string::npos);
    SCOPED_TRACE(kind);
    Moments factors;
    double lowest = 1.0;
    at_places(0.21, [&](const double *x) {
      double history[2];
      material->initialize(x, history);
      const double s2 = std::log(1.04), g = field.value(x);    // 1.04: 1 + 0.2^2
      EXPECT_NEAR(history[1], kind[0] == 'l' ? std::exp(std::sqrt(s2) * g - 0.5 * s2) : 1 + 0.2 * g,
                  1e-12);
      factors.add(history[1]);
      lowest = std::min(lowest, history[1]);
    });
    factors.expect(1.0, 0.2);
    EXPECT_GT(lowest, kind[0] == 'l' ? 0.4 : 0.0);
  }
  // a value that its law cannot have
  const auto error_at_points = [](const std::string &text) -> std::string {
    const auto wild = make(text);
    std::vector<double> history(wild->history().size());
    try {
      for (int i = 0; i < 100; i++) {
        const double x[3] = {0.3 * i, 0.0, 0.0};
        wild->initialize(x, history.data());
      }
    } catch (const std::runtime_error &e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error_at_points(STEEL + "random strength.G normal 2.0 0.1 7")
                .find("which is out of range: use lognormal"),
            std::string::npos);
  // values that do not go together
  EXPECT_NE(error_at_points("density 1800 drucker/prager 1e7 0.3 30 dilatancy 25 "
                            "random PHI normal 0.2 0.1 7")
                .find("PSI must not exceed PHI"),
            std::string::npos);
}

// each point of a batch is as with a material that has its value for all
TEST_F(Random, EveryPointHasItsOwnMaterial)
{
  const struct {
    const char *law, *value, *name;
  } cases[] = {
      {"density 7830 eos shock 4570 1.49 1.93 strength johnson/cook 79.6e9 806e6 VALUE 0.168 "
       "0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9 viscosity artificial 1.5 0.06",
       "614e6", "B"},
      {"density 1000 neohookean VALUE 0.3 viscosity artificial 1.5 0.06", "1e6", "neohookean.E"},
      {"density 1000 eos tait VALUE 7 viscosity newtonian 1e-3", "2.2e9", "K"},
      {"density 7850 eos linear 1.6e11 strength j2 8e10 VALUE hardening linear 1e9 "
       "damage cockcroft/latham 2e7 soften energy 6e6 viscosity artificial 1.5 0.06",
       "3e8", "SIGMAY"},
      {"density 7850 eos linear 1.6e11 strength j2 8e10 3e8 hardening linear 1e9 "
       "damage cockcroft/latham VALUE soften energy 6e6 viscosity artificial 1.5 0.06",
       "2e7", "damage.WC"},
      // parameters of terms
      {"density 1000 ogden 1e8 term VALUE 1.3 term 2e5 5 term -1e4 -2", "4e5", "MU1"},
      {"density 1000 ogden 1e8 term 4e5 1.3 term 2e5 VALUE", "5", "ogden.ALPHA2"},
      {"density 1000 neohookean 1e6 0.4 viscosity maxwell term 3e5 0.2 term 1e6 VALUE", "0.1",
       "maxwell.TAU2"},
      {"density 7850 eos linear 1.6e11 strength j2 8e10 3e8 point 0.1 VALUE point 1 2e9", "6e8",
       "SIGMA1"},
      // what other parts know of: the density, and the heat of a thermal part
      {"density VALUE eos shock 4570 1.49 1.93 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
       "0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9 viscosity artificial 1.5 0.06",
       "7830", "density"},
      {"density 7830 eos shock 4570 1.49 1.93 strength johnson/cook 79.6e9 806e6 614e6 0.168 "
       "0.0089 1 1.1 1540 20 thermal adiabatic VALUE 20 0.9 viscosity artificial 1.5 0.06",
       "460", "CP"},
      {"density 7830 eos linear 1.6e11 strength johnson/cook 79.6e9 806e6 614e6 0.168 0.0089 1 1.1 "
       "1540 20 damage johnson/cook 0.5 3.4 -2.1 thermal adiabatic 460 20 VALUE",
       "0.45", "thermal.CHI"},
      {"density 7830 eos linear 1.6e11 strength j2 79.6e9 806e6 thermal adiabatic 460 20 0.9 melt "
       "VALUE 2e4",
       "60", "TMELT"},
      // the time of the step: all burns from t = 0.1 on, at the rate D/(3 h)
      {"density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.30 7.0e9 VALUE detonate 0 0 0 0.1", "3",
       "D"},
  };
  for (const auto &c : cases) {
    const double mean = std::stod(c.value);
    const auto definition = [&](const std::string &value) {
      return MPM_TEST::replaced(c.law, "VALUE", value);
    };
    const auto random = make(definition(c.value) + " random " + c.name + " lognormal 0.3 1.0 5");
    const int row = random->history().size() - 1;
    ASSERT_EQ(random->history()[row].name, std::string("random/") + c.name);
    MaterialPoint all(*random, 5);
    const double factor[5] = {0.5, 0.9, 1.0, 1.3, 2.0};
    for (int i = 0; i < 5; i++) all.batch.history[row][i] = factor[i];
    const auto motion = [](double t) -> Matrix {
      return {-0.3 * std::cos(t), 0.4, 0, 0.1, 0.2, -0.3, 0, 0, 0.1};
    };
    follow(all, motion, 0.5, 20);
    double c0[MPM_NS::BATCH], w0[MPM_NS::BATCH], work[MPM_NS::NWORK] = {};
    random->wave_speed(all.batch, c0);
    random->stored_energy(all.batch, w0);
    for (int i = 0; i < 5; i++) {
      Point p(definition(joined(mean * factor[i])));
      follow(p, motion, 0.5, 20);
      for (int k = 0; k < 6; k++)
        EXPECT_NEAR(all.batch.stress[k][i], p.stress(k), 1e-11 * (mean + std::fabs(p.stress(k))));
      for (int k = 0; k < row; k++)
        EXPECT_NEAR(all.batch.history[k][i], p.history(k), 1e-10 * std::fabs(p.history(k)));
      EXPECT_NEAR(c0[i], p.wave_speed(), 1e-11 * p.wave_speed());
      EXPECT_NEAR(w0[i], p.stored_energy(), 1e-10 * std::fabs(p.stored_energy()));
      EXPECT_EQ(all.batch.history[row][i], factor[i]);
      for (int k = 0; k < MPM_NS::NWORK; k++) work[k] += p.work[k] / 5;
    }
    for (int k = 0; k < MPM_NS::NWORK; k++)
      EXPECT_NEAR(all.work[k], work[k], 1e-10 * std::fabs(work[k]));
  }
}

// the initial temperature, which is the start of a history variable
TEST_F(Random, InitialTemperature)
{
  for (const char *thermal : {"constant 300", "adiabatic 460 300 0.9"}) {
    const auto material = make(STEEL + "thermal " + thermal + " random T0 normal 0.1 0.1 3");
    const int at = row(*material, "temperature");
    Moments temperatures;
    std::vector<double> history(material->history().size());
    at_places(0.21, [&](const double *x) {
      material->initialize(x, history.data());
      temperatures.add(history[at]);
      EXPECT_NEAR(history[at], 300.0 * history.back(), 1e-10);
    });
    temperatures.expect(300.0, 30.0);
  }
}

// laws that make their initial state themselves do so with the parameters of the point
TEST_F(Random, InitialStateOfALaw)
{
  const auto gas = make("density 1.2 eos ideal/gas 1.4 pressure 1e5 random P0 lognormal 0.3 1.0 5");
  const std::string glass = "density 2500 eos linear 43e9 strength elastic 30e9 damage rankine 5e7 "
                            "weibull 7 1e-6 4711 ";
  const auto random = make(glass + "random SIGMA lognormal 0.3 1.0 5"), plain = make(glass);
  const size_t row = 3;
  ASSERT_EQ(plain->history()[row].name, "random");
  std::vector<double> of_gas(gas->history().size()), of_random(random->history().size()),
      of_plain(plain->history().size());
  for (int i = 0; i < 20; i++) {
    const double x[3] = {0.7 * i, -0.3 * i, 0.1};
    gas->initialize(x, of_gas.data());
    EXPECT_NE(of_gas.back(), 1.0);
    EXPECT_NEAR(of_gas[0], 1e5 * of_gas.back() / 0.4, 1e-6);
    random->initialize(x, of_random.data());
    plain->initialize(x, of_plain.data());
    EXPECT_GT(of_plain[row], 0.0);
    EXPECT_EQ(of_random[row], of_plain[row]);
  }
}

// as well behind other laws: what starts above its melting temperature is molten
TEST_F(Random, InitialStateBehindOtherLaws)
{
  const auto material =
      make(STEEL + "thermal adiabatic 460 300 0.9 melt 300 1e4 random T0 normal 0.1 0.1 3");
  const int T = row(*material, "temperature"), molten = row(*material, "molten");
  ASSERT_GT(T, 0);
  int n = 0, above = 0;
  std::vector<double> history(material->history().size());
  at_places(0.21, [&](const double *x) {
    material->initialize(x, history.data());
    n++;
    above += history[T] > 300.0;
    EXPECT_EQ(history[molten], history[T] > 300.0 ? 1.0 : 0.0);
  });
  EXPECT_GT(above, n / 4);
  EXPECT_LT(above, 3 * n / 4);
}

// a range of the density looks at that of the point, and so does whoever asks for it
TEST_F(Random, DensityOfAPoint)
{
  const auto material =
      make("density 2000 eos linear 1e9 range density 1900 2100 random density normal 0.1 1 1");
  MaterialPoint p(*material, 3);
  const double factor[3] = {0.9, 1.0, 1.1}, J[3] = {0.92, 1.08, 1.1};
  for (int i = 0; i < 3; i++) {
    p.batch.history[0][i] = factor[i];
    p.batch.J[i] = J[i];
  }
  double value[MPM_NS::BATCH];
  EXPECT_EQ(material->outside(p.batch, 0, value), 1);
  for (int i = 0; i < 3; i++) EXPECT_NEAR(value[i], 2000 * factor[i] / J[i], 1e-9);
  EXPECT_EQ(p.density(), 1800.0);
  EXPECT_EQ(material->density(), 2000.0);
}

/* ---------------------------------------------------------------------- through the fix */

// lengths far below the distance of points: each value would take a Fourier transform
TEST_F(Random, TooShortLengths)
{
  const auto message = [](double length, double spacing) {
    const RandomField field(length, 17);
    try {
      at_places(spacing, [&](const double *x) {
        field.value(x);
      });
    } catch (const std::runtime_error &e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(0.02, 0.5),
              ::testing::HasSubstr("the correlation length is too short: with"));
  EXPECT_THAT(message(1e-20, 1.0), ::testing::HasSubstr("too short for the coordinates"));
  EXPECT_EQ(message(0.25, 0.5), "");
}

// factors are those of the field where points are made, on any ranks, and stay after a restart
TEST_F(Random, FixAndRestart)
{
  const std::string scene = MPM_TEST::space("si", "f f f", "0 8 0 8 0 8", 1, 0.3) +
      "fix grid all mpm 1.0\nregion body block 1 7 1 7 1 7\ncreate_points 1 region body ppc 2\n";
  const std::string material =
      "fix m all mpm/material density 7800 eos linear 160e9 strength j2 80e9 "
      "300e6 random SIGMAY lognormal 0.3 1.5 11\n";
  const RandomField field(1.5, 11);
  const auto expected = [&](const double *x) {
    const double s2 = std::log(1.09);
    return std::exp(std::sqrt(s2) * field.value(x) - 0.5 * s2);
  };
  const MPM_TEST::ScratchFile file("restart");
  const auto row = [](Scene &run, int i) {
    auto *fix = run.material();
    return fix->history[i][fix->find_history("random/SIGMAY")];
  };
  const auto gather = [&](Scene &run) {
    std::vector<double> mine(20000, 0.0), all(20000);
    for (int i = 0; i < run.lmp->atom->nlocal; i++) mine[run.lmp->atom->tag[i]] = row(run, i);
    MPI_Allreduce(mine.data(), all.data(), 20000, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return all;
  };
  std::vector<double> before;
  {
    Scene run(scene + material);
    double low = 10, high = 0;
    for (int i = 0; i < run.lmp->atom->nlocal; i++) {
      ASSERT_NEAR(row(run, i), expected(run.lmp->atom->x[i]), 1e-14);
      low = std::min(low, row(run, i));
      high = std::max(high, row(run, i));
    }
    EXPECT_LT(low, 0.75);
    EXPECT_GT(high, 1.25);
    before = gather(run);
    // yield along x: the weak points flow first, and much
    run.commands("timestep 1e-5\nvariable v atom 10*(x-4)\nvelocity all set v_v 0 0\nrun 20\n"
                 "compute c all mpm/atom random/SIGMAY eplastic\n"
                 "compute max all reduce max c_c[1] c_c[2]\nthermo_style custom step c_max[*]\n"
                 "run 0\nwrite_restart " +
                 file.name + "\n");
    EXPECT_EQ(gather(run), before);
    EXPECT_DOUBLE_EQ(run.evaluate("c_max[1]"), *std::max_element(before.begin(), before.end()));
  }
  {
    Scene run("read_restart " + file.name + "\nneighbor 0.3 bin\nfix grid all mpm 1.0\n" +
              material + "run 0\n");
    EXPECT_EQ(gather(run), before);
    // points that come later are in the same field
    const LAMMPS_NS::bigint n = run.lmp->atom->natoms;
    run.commands("region late block 2 4 2 4 7.2 8\ncreate_points 1 region late ppc 2\n");
    EXPECT_GT(run.lmp->atom->natoms, n);
    for (int i = 0; i < run.lmp->atom->nlocal; i++)
      if (run.lmp->atom->tag[i] > n) ASSERT_NEAR(row(run, i), expected(run.lmp->atom->x[i]), 1e-14);
  }
}

// the stiffest point limits the time step: its modulus is the last variable of a point
TEST_F(Random, LimitOfTheStep)
{
  Scene run(MPM_TEST::space("si", "f f f", "0 10 0 10 0 10", 1, 0.3) +
            MPM_TEST::body("block 1 9 1 9 1 9",
                           "density 2000 linear 1e7 0.3 random E lognormal 0.3 2 1") +
            "fix dt all mpm/dt 1.0 every 1\ncompute c all mpm/atom wavespeed\n"
            "compute most all reduce max c_c\nthermo_style custom step c_most\nrun 2\n");
  EXPECT_NEAR(run.lmp->update->dt * run.evaluate("c_most"), 1.0, 1e-12);
}

// parameters of all kinds, each point with its own: temperature, stress of a term, mass
TEST_F(Random, FixWithEveryKindOfParameter)
{
  Scene run(MPM_TEST::space("si", "f f f", "0 10 0 10 0 10", 1, 0.3) +
            MPM_TEST::body(
                "block 1 9 1 9 1 9",
                "density 2000 ogden 1e7 term 1e6 2 thermal adiabatic 500 300 random density "
                "lognormal 0.1 0.5 1 random MU1 lognormal 0.2 0.5 2 random T0 normal 0.05 0.5 3"));
  const RandomField density(0.5, 1), modulus(0.5, 2), temperature(0.5, 3);
  const auto lognormal = [](double g, double c) {
    return std::exp(std::sqrt(std::log1p(c * c)) * g - 0.5 * std::log1p(c * c));
  };
  Moments mass, warmth, stiffness;
  // neighboring points are one length apart: as good as one in six independent ones
  const double means = 8.0, deviations = 10.0;
  const auto before = run.gather();
  ASSERT_EQ(before.size(), 4096);
  for (const auto &p : before) {
    mass.add(p.mass / p.vol / 2000.0);
    ASSERT_NEAR(p.mass / p.vol / 2000.0, lognormal(density.value(p.x), 0.1), 1e-13);
  }
  mass.expect(1.0, 0.1, means, deviations);

  run.commands("compute t all mpm/atom temperature\ncompute low all reduce min c_t\n"
               "compute high all reduce max c_t\ncompute mean all reduce ave c_t\n"
               "thermo_style custom step c_low c_high c_mean\nrun 0\n");
  for (const auto &p : before) warmth.add(300 * (1 + 0.05 * temperature.value(p.x)));
  warmth.expect(300.0, 15.0, means, deviations);
  EXPECT_NEAR(run.evaluate("c_mean"), warmth.sum / warmth.n, 1e-9);
  EXPECT_LT(run.evaluate("c_low"), 255);
  EXPECT_GT(run.evaluate("c_high"), 345);

  // shear so fast that no wave has come far: sigma_xy = G gamma, G = MU1 for ALPHA = 2
  run.commands("timestep 1e-8\nvariable v atom 1000*y\nvelocity all set v_v 0 0\nrun 2\n");
  for (const auto &p : run.gather()) {
    if (*std::min_element(p.x, p.x + 3) < 3 || *std::max_element(p.x, p.x + 3) > 7) continue;
    stiffness.add(p.stress[3] / (1e6 * 2e-5));
    ASSERT_NEAR(p.stress[3] / (1e6 * 2e-5), lognormal(modulus.value(p.x), 0.2), 1e-3);
  }
  stiffness.expect(1.0, 0.2, means, deviations);
}

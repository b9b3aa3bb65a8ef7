// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Stress that depends on the temperature, point by point: thermal expansion of all laws, parameters
// that vary with the temperature, and the heat that comes of compression.

#include "material/material_testing.h"
#include "material/random_field.h"
#include "material/temperature_factor.h"

#include <regex>

using namespace MPM_NS;
using namespace material_testing;

/** Sets the temperature of a point, as conduction does. */
void warm_to(MaterialPoint &p, double T)
{
  const int k = row(p.material, "temperature");
  for (int i = 0; i < p.batch.n; i++) p.batch.history[k][i] = T;
}

bool has(const std::string &text, const std::string &word)
{
  return text.find(word) != std::string::npos;
}

/** A definition with another thermal part. */
std::string with_thermal(const std::string &text, const std::string &thermal)
{
  return std::regex_replace(text,
                            std::regex(" thermal [a-z]+( -?[0-9][0-9.e]*)*"
                                       "( gruneisen [0-9.]+| melt [0-9.]+ [0-9.]+)*"),
                            "") +
      " thermal " + thermal;
}

/** Samples that can have an expansion: all but those whose energy expands them. */
std::vector<Sample> expandable()
{
  std::vector<Sample> list;
  for (const auto &sample : samples)
    if (!std::regex_search(sample.text,
                           std::regex("eos (shock|polynomial|ideal|stiffened|jwl)|weibull")))
      list.push_back(sample);
  return list;
}

constexpr const char *NO_HEAT = "adiabatic 1e30 300 0";    // a point whose own heat is nothing

/** Expects the power of the stress to be what laws store and dissipate, while warm(p, t, n) changes
 *  the temperature in a motion of n steps: of second order, unless it is within this part of the
 *  largest power. Returns the part of it that the thermal strain has taken. */
template <class Warm>
double expect_balance(const Material &material, double within, const Warm &warm)
{
  double scale = 0.0, taken = 0.0;
  const auto error = refined(250, [&](int n) {
    MaterialPoint p(material, 1, 0.01);
    double worst = 0.0;
    const double start = p.stored_energy();
    for (int i = 0; i < n; i++) {
      const double t = (i + 0.5) / n;
      warm(p, t, n);
      steps(p, Matrix{0.1, 0.1 * std::cos(7 * t), 0, 0, -0.2 * t, 0.05, 0.1, 0, 0.08}, 1.0 / n);
      const double energy = p.stored_energy() - start + p.work[PLASTIC] + p.work[VISCOUS] +
          p.work[FRACTURE] + p.work[THERMOELASTIC];
      worst = std::max(worst, std::fabs(energy - p.power));
      scale = std::max(scale, std::fabs(p.power));
      taken = std::max(taken, std::fabs(p.work[THERMOELASTIC]));
    }
    return worst;
  });
  EXPECT_LT(error[2], 1e-2 * scale);
  if (!(error[2] <= within * scale))
    EXPECT_GT(std::log2(error[0] / error[2]), 2 * 0.85)
        << error[0] / scale << " " << error[2] / scale;
  return taken / scale;
}

// with an expansion, a law has the stress, speed, and energy that it has without it at F/theta
TEST(Expansion, IsTakenOutOfTheMotionOfAnyLaw)
{
  constexpr double ALPHA = 1e-3;
  RandomMatrix random(3);
  int n = 0;
  for (const auto &sample : expandable()) {
    SCOPED_TRACE(sample.name);
    const double T0 = has(sample.text, " 20 ") ? 20 : 300;
    const std::string none = joined("adiabatic 1e30 ", T0, " 0");
    Point p(joined(with_thermal(sample.text, none), " expansion ", ALPHA), 1, 0.01);
    Point q(with_thermal(sample.text, none), 1, 0.01);
    Matrix F = IDENTITY;
    // laws that depend on the temperature get the same one
    const bool depends = has(sample.text, "thermal") || has(sample.text, "temperature");
    for (int i = 1; i <= 40; i++, n++) {
      Matrix A = random(0.002);
      for (int k = 0; k < 9; k++) A[k] += IDENTITY[k];
      F = A * F;
      const double T = T0 + 200 * std::sin(0.1 * i), theta = std::exp(ALPHA * (T - T0));
      warm_to(p, T);
      if (depends) warm_to(q, T);
      move_to(p, isotropic(theta) * F);
      move_to(q, F);
      const double size_of = size(stress_of(q)) + 1e-6 * q.wave_speed() * q.wave_speed() * 1000;
      ASSERT_LT(distance(stress_of(p), stress_of(q)), 1e-10 * size_of);
      ASSERT_NEAR(p.stored_energy(), q.stored_energy() * theta * theta * theta,
                  1e-9 * std::fabs(q.stored_energy()) + 1e-12 * size_of);
    }
    if (!has(sample.text, "viscosity"))
      EXPECT_NEAR(p.wave_speed(), q.wave_speed() * std::exp(1.5 * ALPHA * 200 * std::sin(4.0)),
                  1e-8 * q.wave_speed());
  }
  EXPECT_GT(n, 30 * 40);
}

// no stress when nothing hinders expansion, at small and at 30 % strain, in one step and in many
TEST(Expansion, FreeBodyHasNoStress)
{
  for (const char *law :
       {"neohookean 1e6 0.3", "hencky 1e6 0.3", "linear 1e6 0.3",
        "orthotropic 11e6 0.9e6 0.5e6 0.4 0.45 0.5 0.7e6 0.65e6 0.05e6 axes 1 2 0 0 1 1 angle 20",
        "eos linear 1e6 strength j2 5e5 1e3 hardening linear 1e4",
        "eos linear 1e6 strength johnson/cook 5e5 1e3 1e3 0.3 0.01 1 1 1e4 0", "eos linear 1e6",
        "eos tait 1e6 7", "drucker/prager 1e6 0.3 30 cohesion 1e3", "gurson 1e6 0.3 1e3 0.01"})
    for (const double strain : {1e-6, 0.3})
      for (const int n : {1, 50}) {
        SCOPED_TRACE(joined(law, " ", strain, " ", n));
        Point p(joined("density 1000 ", law, " thermal adiabatic 1e30 300 0 expansion ",
                       std::log1p(strain) / 100));
        for (int i = 1; i <= n; i++) {
          warm_to(p, 300 + 100.0 * i / n);
          move_to(p, isotropic(std::pow(1 + strain, double(i) / n)));
        }
        for (int k = 0; k < 6; k++) EXPECT_NEAR(p.stress(k), 0.0, 1e-8 * strain * 1e6 + 1e-9);
        EXPECT_NEAR(p.stored_energy(), 0.0, 1e-12);
      }
}

// a bar between walls, free sides: -E ALPHA dT, and for 30 % the stress of compression to 1/1.3
TEST(Expansion, ClampedBar)
{
  MixedControl clamped;
  clamped.stress_given[1] = clamped.stress_given[2] = true;
  for (const char *law : {"neohookean 1e6 0.3", "hencky 1e6 0.3", "linear 1e6 0.3",
                          "eos linear 833333.333333333 strength elastic 384615.384615385",
                          "orthotropic 1e6 1e6 1e6 0.3 0.3 0.3 384615.384615385 384615.384615385 "
                          "384615.384615385"}) {
    SCOPED_TRACE(law);
    const std::string text = joined("density 1000 ", law, " thermal ", NO_HEAT, " expansion ");
    Point p(text + "1e-6");
    warm_to(p, 301);
    p.step(clamped, 1.0);
    EXPECT_NEAR(p.stress(0), -1.0, 1e-5);
    Point q(joined(text, std::log(1.3) / 100)), r(joined("density 1000 ", law));
    for (int i = 1; i <= 100; i++) {
      warm_to(q, 300 + i);
      q.step(clamped, 1.0);
      r.step_uniaxial_stress(-std::log(1.3) / 100, 1.0);
    }
    EXPECT_NEAR(q.stress(0), r.stress(0), 1e-11 * std::fabs(r.stress(0)));
    EXPECT_NEAR(q.stress(1), 0.0, 3e-8);
  }
}

// the power of the stress is what laws store and dissipate and what the thermal strain has taken
TEST(Expansion, EnergyBalance)
{
  for (const char *law :
       {"neohookean 1e6 0.3", "linear 1e6 0.3", "eos linear 1e6 strength j2 5e5 1e3",
        "eos tait 1e6 7 viscosity newtonian 10", "hencky 1e6 0.3 viscosity maxwell term 2e5 0.1",
        "drucker/prager 1e6 0.3 35 cohesion 2e4",
        "eos linear 1e6 strength j2 5e5 1e4 damage cockcroft/latham 2e3 soften from 0.1"}) {
    SCOPED_TRACE(law);
    const auto material =
        make(joined("density 1000 ", law, " thermal ", NO_HEAT, " expansion 1e-3"));
    const double taken = expect_balance(*material, 0.0, [](MaterialPoint &p, double t, int) {
      warm_to(p, 300 + 100 * std::sin(5 * t));
    });
    EXPECT_GT(taken, 0.05);
  }
}

// GAMMA = 3 K ALPHA/(density CP): compression warms, stiffer by 1 + (3 ALPHA)^2 K T/(density CP)
TEST(Expansion, ConsistentCoupling)
{
  const double K = 70e9 / (3 * (1 - 2 * 0.33)), alpha = 23e-6, capacity = 2700.0 * 900;
  const double gamma = 3 * K * alpha / capacity;
  for (const std::string law :
       {std::string("linear 70e9 0.33"), std::string("hencky 70e9 0.33"),
        joined("eos linear ", K, " strength j2 26e9 1e8"), joined("eos tait ", K, " 4")}) {
    SCOPED_TRACE(law);
    const std::string text =
        joined("density 2700 ", law, " thermal adiabatic 900 293 0.9 expansion ", alpha);
    Point p(text + " gruneisen consistent"), q(text);
    const double J = 1 - 1e-5;
    for (MaterialPoint *point : {(MaterialPoint *) &p, (MaterialPoint *) &q})
      move_to(*point, isotropic(std::cbrt(J)));
    const double dT = value(p, "temperature") - 293;
    EXPECT_NEAR(dT / (293 * gamma * 1e-5), 1.0, 6e-5);
    EXPECT_EQ(value(q, "temperature"), 293);
    const double stiffer = 1 + 9 * alpha * alpha * K * 293 / capacity;
    EXPECT_NEAR(p.pressure() / q.pressure(), stiffer, 1e-4 * (stiffer - 1) + 1e-7);
    EXPECT_GT(p.wave_speed(), q.wave_speed() * (1 + 1e-3));
    EXPECT_LE(p.wave_speed(), q.wave_speed() * std::sqrt(stiffer) * (1 + 1e-6));
    // back again
    move_to(p, IDENTITY);
    EXPECT_NEAR(value(p, "temperature"), 293, 1e-10);
    EXPECT_NEAR(p.pressure(), 0.0, 1e-12 * K);
  }
}

// constant at constant volume is dp/dT = 3 K ALPHA: if CP depends on T, the integral of CP/T dT is
// -3 K ALPHA/density (J - 1), there and back; with ALPHA that depends on T it is the coupling of
// its value at T0
TEST(Expansion, ConsistentCouplingOfWhatVaries)
{
  const double K = 1e6, alpha = 1e-3, rho = 1000, cp = 5, T0 = 300;
  const std::string start = joined("density ", rho, " eos linear ", K, " thermal adiabatic ", cp,
                                   " ", T0, " 0 expansion ", alpha, " gruneisen consistent ");
  const double a = 0.5, b = 0.5 / 300;    // factor of the table: 1 at 300, 2 at 900
  double error[2];
  for (const int n : {100, 200}) {
    Point p(start + "vary CP table 0 0.5 900 2");
    for (const double J : {0.7, 1.1, 1.0}) {
      const double from = p.batch.J[0];
      for (int i = 1; i <= n; i++) move_to(p, isotropic(std::cbrt(from + (J - from) * i / n)));
      const double T = value(p, "temperature");
      EXPECT_NEAR(a * std::log(T / T0) + b * (T - T0), -3 * K * alpha / (rho * cp) * (J - 1),
                  J == 1.0 ? 1e-6 : 1e-5);
      error[n == 200] = std::fabs(T / T0 - 1);
      // the adiabatic modulus
      Point r(start + "vary CP table 0 0.5 900 2");
      if (J == 1.0) continue;
      move_to(r, isotropic(std::cbrt(J)));
      MaterialPoint q = r;
      move_to(q, isotropic(std::cbrt(J * (1 + 1e-6))));
      const double slope = -(q.pressure() - r.pressure()) / 1e-6;    // -J dp/dJ = density c^2
      EXPECT_NEAR(r.wave_speed() / std::sqrt(slope * J / rho), 1.0, 4e-6);
    }
  }
  EXPECT_LT(error[1], 5e-8);
  Point p(start + "vary ALPHA table 0 0.5 900 2 vary eos.K table 0 0.5 900 2");
  const double given = 3 * 1.0 * K * alpha / (rho * cp);
  move_to(p, isotropic(std::cbrt(1 - 1e-6)));
  EXPECT_NEAR((value(p, "temperature") / T0 - 1) / (given * 1e-6), 1.0, 2e-6);
  for (const auto &[vary, factor] : {std::pair{"vary ALPHA table 200 1 400 2", 1.5},
                                     std::pair{"vary eos.K table 200 1 400 2", 1.5},
                                     std::pair{"vary CP table 200 1 400 2", 1 / 1.5}}) {
    SCOPED_TRACE(vary);
    Point q(start + vary);
    move_to(q, isotropic(std::cbrt(1 - 1e-6)));
    EXPECT_NEAR((value(q, "temperature") / T0 - 1) / (given * factor * 1e-6), 1.0, 3e-6);
  }
  if (!RandomField::available()) return;
  for (const char *parameter : {"CP", "ALPHA", "density", "eos.K"})
    expect_refused(
        {{start + "random " + parameter + " lognormal 0.1 0.1 5", "give 'gruneisen GAMMA'"}});
  make(std::regex_replace(start, std::regex("thermal"), "strength j2 1e5 1e3 thermal") +
       "random SIGMAY lognormal 0.1 0.1 5");
  make(start + "random T0 lognormal 0.1 0.1 5");
}

TEST(Expansion, EachPointStartsFromItsOwnTemperature)
{
  if (!RandomField::available()) GTEST_SKIP() << "no FFTW";
  Point p("density 1000 linear 1e6 0.3 thermal adiabatic 1e30 300 0 expansion 1e-3 "
          "random T0 lognormal 0.1 0.1 5 random ALPHA lognormal 0.3 0.1 6");
  const double T0 = value(p, "temperature"), alpha = 1e-3 * value(p, "random/ALPHA");
  EXPECT_GT(std::fabs(T0 - 300), 0.1);
  move_to(p, IDENTITY);
  EXPECT_EQ(p.pressure(), 0.0);
  warm_to(p, T0 + 100);
  move_to(p, isotropic(std::exp(100 * alpha)));
  EXPECT_NEAR(p.pressure(), 0.0, 1e-8);
}

// aluminum warmed by 100 K, or strained by 1e-3: free strain, stress between walls and in a die,
// elastic cooling, and the adiabatic bulk modulus; linear, so that a small part is done
TEST(Expansion, Aluminum)
{
  constexpr double PART = 1e-4;
  const std::string text =
      "density 2700 linear 70e9 0.33 thermal adiabatic 900 293 0 expansion 23e-6";
  MixedControl free, clamped, confined;
  for (int d = 0; d < 3; d++) free.stress_given[d] = true;
  clamped.stress_given[1] = clamped.stress_given[2] = true;
  Point p(text), q(text), r(text);
  for (MaterialPoint *point : {(MaterialPoint *) &p, (MaterialPoint *) &q, (MaterialPoint *) &r})
    warm_to(*point, 293 + 100 * PART);
  p.step(free, 1.0);
  q.step(clamped, 1.0);
  r.step(confined, 1.0);
  EXPECT_NEAR((std::cbrt(p.batch.J[0]) - 1) / PART, 2.3e-3, 1e-6 * 2.3e-3);
  EXPECT_NEAR(q.stress(0) / PART, -1.61e8, 5e-7 * 1.61e8);
  EXPECT_NEAR(r.stress(0) / PART, -4.735294118e8, 1e-6 * 4.73529e8);

  Point s(text + " gruneisen consistent"), t(text);
  for (MaterialPoint *point : {(MaterialPoint *) &s, (MaterialPoint *) &t})
    move_to(*point, isotropic(std::cbrt(1 + 1e-3 * PART)));
  EXPECT_NEAR((value(s, "temperature") - 293) / PART, -0.570963, 1e-6);
  EXPECT_NEAR(s.pressure() / t.pressure(), 1.039396, 1e-6);
}

TEST(Expansion, BadInputIsRefused)
{
  expect_refused(
      {{"eos shock 1 1 1 thermal adiabatic 1 1 expansion 1", "makes it expand already", 8},
       {"eos jwl 1 1 1 1 1 1 1 thermal adiabatic 1 1 expansion 1", "makes it expand already"},
       {"eos ideal/gas 1.4 pressure 1 thermal conducting 1 1 1 expansion 1", "leave it out"},
       {"linear 1 0 thermal adiabatic 1 1 gruneisen consistent", "add 'expansion ALPHA'"},
       {"linear 1 0 thermal adiabatic 1 1 gruneisen 1 gruneisen consistent", "given twice"},
       {"eos ideal/gas 1.4 pressure 1 thermal constant 300", "with fix mpm/heat", 8},
       {"eos jwl 1 1 1 1 1 1 1 thermal constant 300", "with fix mpm/heat"},
       {"linear 1 0 thermal constant 1 expansion 1", "unknown keyword 'expansion'"},
       {"linear 1 0 thermal adiabatic 1 1 expansion", "ALPHA is missing"},
       {"orthotropic 11 0.9 0.5 0.4 0.45 0.5 0.7 0.65 0.05 thermal adiabatic 1 1 expansion 1 "
        "gruneisen consistent",
        "not isotropic"},
       {"eos linear 1 strength elastic 1 damage rankine 1 weibull 5 1 7 thermal adiabatic 1 1 "
        "expansion 1",
        "random SIGMA"},
       {"eos shock 1 1 1 strength elastic 1 thermal adiabatic 1 1 fracture 1", "add a part damage"},
       {"eos linear 1 strength elastic 1 thermal adiabatic 1 1 fracture 1", "add a part damage"},
       {"linear 1 0 thermal conducting 1 1 1 fracture 0.5", "add a part damage"},
       {"linear 1 0 thermal adiabatic 1 -40 gruneisen 1", "T0 above zero"},
       {"eos linear 1 thermal conducting 1 0 1 gruneisen 1", "T0 above zero"},
       {"linear 1 0 thermal adiabatic 1 0 expansion 1 gruneisen consistent", "T0 above zero"}},
      "density 1 ");
}

/** Equations of state with internal energy, dp/dE at J = 1, and bulk modulus without energy. */
struct WithEnergy {
  const char *eos;
  double density, gamma, K;
};
const WithEnergy with_energy[] = {
    {"shock 5350 1.34 2", 2703, 2, 2703 * 5350.0 * 5350.0},
    {"polynomial 7e10 8e10 5e10 2 1.5 6e10 0", 2700, 2, 6e10},
    {"ideal/gas 1.4 pressure 1e5", 1.2, 0.4, 0},
    {"stiffened/gas 4.4 6e8 pressure 1e5", 1000, 3.4, 0},
};

// what conduction brings between steps is in the internal energy, and so in the pressure, whatever
// the temperature has to do with the heat; without motion it is no stored energy
TEST(Conducted, HeatRaisesThePressure)
{
  for (const auto &w : with_energy)
    for (const std::string more : {"", " melt 400 5e4", " melt 400 5e4 over 50",
                                   " vary CP table 300 1 700 3", " gruneisen 2"}) {
      SCOPED_TRACE(w.eos + more);
      if (has(w.eos, "ideal") && !more.empty()) continue;    // refused
      Point p(
          joined("density ", w.density, " eos ", w.eos, " thermal conducting 900 300 50", more));
      move_to(p, IDENTITY);
      const double start = p.pressure(), stored = p.stored_energy();
      for (const double T : {310.0, 650.0, 200.0, 300.0}) {
        const bool melts = more.find("melt") != std::string::npos, molten = melts && T > 400;
        warm_to(p, T);
        if (melts) p.batch.history[row(p.material, "molten")][0] = molten;
        move_to(p, IDENTITY);
        double heat = 900 * (T - 300) + 5e4 * molten;
        if (more.find("CP") != std::string::npos && T > 300)
          heat += 900 * (T - 300) * (T - 300) / 400;
        EXPECT_NEAR((p.pressure() - start) / (w.density * w.gamma * 900 * 300), heat / (900 * 300),
                    1e-11);
        EXPECT_NEAR(p.stored_energy(), stored, 1e-9 * w.density * 900 * 300);
        EXPECT_EQ(value(p, "temperature"), T);
        EXPECT_EQ(value(p, "energy_temperature"), T);
        if (melts) EXPECT_EQ(value(p, "energy_molten"), molten);
      }
      EXPECT_EQ(p.work[VISCOUS], 0.0);
      EXPECT_EQ(p.work[PLASTIC], 0.0);
    }
  // a perfect gas: p/p0 = T/T0, each point with its own density
  const std::string gas = joined("density 1.2 eos ideal/gas 1.4 pressure 1e5 thermal conducting ",
                                 1e5 / (0.4 * 1.2 * 300), " 300 0.03");
  Point p(gas);
  warm_to(p, 600);
  move_to(p, IDENTITY);
  EXPECT_NEAR(p.pressure(), 2e5, 1e-6);
  if (!RandomField::available()) return;
  Point q(gas + " random density lognormal 0.5 1 5 random CP lognormal 0.5 1 6");
  warm_to(q, 600);
  move_to(q, IDENTITY);
  const double factor = value(q, "random/density") * value(q, "random/CP");
  EXPECT_GT(std::fabs(factor - 1), 0.01);
  EXPECT_NEAR(q.pressure(), 1e5 * (1 + factor), 1e-6);
}

// the temperature of an ideal gas is that of its energy: along an isentrope T J^(GAMMA - 1) is
// constant, and a bath of constant temperature makes p J constant
TEST(Conducted, TemperatureOfAnIdealGas)
{
  const double cv = 1e5 / (0.4 * 1.2 * 300);
  const std::string gas = "density 1.2 eos ideal/gas 1.4 pressure 1e5 thermal ";
  for (const char *kind : {"adiabatic", "conducting"}) {
    SCOPED_TRACE(kind);
    const bool conducts = std::string(kind) == "conducting";
    Point p(joined(gas, kind, " ", cv, " 300", conducts ? " 0.03" : ""));
    for (const double J : {0.9, 0.5, 0.1, 1.0, 3.0}) {
      move_to(p, isotropic(std::cbrt(J)));
      EXPECT_NEAR(value(p, "temperature") / 300, std::pow(J, -0.4), 1e-12);
      EXPECT_NEAR(p.pressure() / 1e5, std::pow(J, -1.4), 1e-12);
    }
    if (!conducts) continue;
    for (int n : {100, 200}) {
      Point bath(joined(gas, "conducting ", cv, " 300 0.03"));
      for (int k = 1; k <= n; k++) {
        move_to(bath, isotropic(std::cbrt(1.0 + 2.0 * k / n)));
        warm_to(bath, 300);
      }
      move_to(bath, isotropic(std::cbrt(3.0)));    // takes what the last step brought
      EXPECT_NEAR(bath.pressure() / 1e5 * 3.0, 1.0, 1e-12);
      EXPECT_NEAR(value(bath, "temperature"), 300.0, 1e-9);
    }
  }
  expect_refused({{"eos ideal/gas 1.4 pressure 1 thermal adiabatic 1 1 gruneisen 1",
                   "without 'gruneisen' and 'melt'"},
                  {"eos ideal/gas 1.4 pressure 1 thermal conducting 1 1 1 melt 2 3",
                   "without 'gruneisen' and 'melt'"},
                  {"eos ideal/gas 1.4 pressure 1 thermal conducting 1 1 1 vary CP table 1 1 2 2",
                   "with a constant CP"}},
                 "density 1 ");
}

// a free body expands by 3 ALPHA dT with ALPHA = GAMMA density CP/(3 K), to first order
TEST(Conducted, HeatExpandsAFreeBody)
{
  MixedControl free;
  for (int k = 0; k < 3; k++) free.stress_given[k] = true;
  for (const auto &w : with_energy) {
    if (w.K == 0) continue;
    SCOPED_TRACE(w.eos);
    Point p(joined("density ", w.density, " eos ", w.eos,
                   " strength elastic 26e9 thermal conducting 900 300 50"));
    warm_to(p, 300.1);
    p.step(free, 1.0);
    const double alpha = w.gamma * w.density * 900 / (3 * w.K);
    EXPECT_NEAR((p.batch.J[0] - 1) / (3 * alpha * 0.1), 1.0, 5e-5);
  }
}

// the power of the stress is what is stored and dissipated while heat comes and goes
TEST(Conducted, EnergyBalance)
{
  for (const auto &w : with_energy) {
    SCOPED_TRACE(w.eos);
    const bool gas = w.K == 0;
    const auto material = make(joined("density ", w.density, " eos ", w.eos,
                                      gas ? " viscosity newtonian 1" : " strength j2 26e9 1e8",
                                      " thermal conducting 900 300 50 0.9",
                                      gas ? "" : " vary SIGMAY linear -1e-3 300 300 900"));
    expect_balance(*material, 1e-6, [](MaterialPoint &p, double t, int n) {
      warm_to(p, value(p, "temperature") + 500 * std::cos(5 * t) / n);
    });
  }
}

/* ---------------------------------------------------------------------- parameters */

// with a parameter that varies, a law is at each temperature the one with that value
TEST(Vary, IsTheLawWithThatValue)
{
  struct {
    std::string law, other, vary;
  } cases[] = {
      {"neohookean 1e6 0.3", "neohookean 0.5e6 0.3", "vary E table 300 1 500 1e-10"},
      {"neohookean 1e6 0.3", "neohookean 1e6 0.15", "vary NU linear -0.005 300 250 500"},
      {"eos tait 1e6 7", "eos tait 2e6 7",
       "vary eos.K exponential 0.00693147180559945 300 200 700"},
      {"ogden 2e6 term 0.63e6 2", "ogden 2e6 term 0.315e6 2", "vary MU1 table 0 1 400 0.5 500 0.4"},
      {"hencky 1e6 0.3", "hencky 1777777.77777778 0.3", "vary E power 2 300 200 700"},
      {"eos linear 1e6 viscosity newtonian 10",
       "eos linear 1e6 viscosity newtonian 4.345982085070782",
       "vary newtonian.MU arrhenius 1000 300 200 700"}};
  for (const auto &c : cases) {
    SCOPED_TRACE(c.vary);
    Point p(joined("density 1000 ", c.law, " thermal ", NO_HEAT, " ", c.vary));
    Point q("density 1000 " + c.other);
    warm_to(p, 400);
    const Matrix F = {1.1, 0.2, 0, 0, 0.95, 0.1, 0, 0, 1};
    move_to(p, F);
    move_to(q, F);
    EXPECT_LT(distance(stress_of(p), stress_of(q)), 1e-9 * size(stress_of(q)));
    EXPECT_NEAR(p.stored_energy(), q.stored_energy(), 1e-9 * q.stored_energy() + 1e-12);
    EXPECT_NEAR(p.wave_speed(), q.wave_speed(), 1e-9 * q.wave_speed());
  }
}

TEST(Vary, TableIsConstantOutside)
{
  const TemperatureFactor table({100, 200, 400}, {1, 0.5, 2});
  EXPECT_EQ(table.at(-1e9), 1);
  EXPECT_EQ(table.at(100), 1);
  EXPECT_DOUBLE_EQ(table.at(150), 0.75);
  EXPECT_EQ(table.at(200), 0.5);
  EXPECT_DOUBLE_EQ(table.at(300), 1.25);
  EXPECT_EQ(table.at(400), 2);
  EXPECT_EQ(table.at(1e9), 2);
  const TemperatureFactor line(TemperatureFactor::LINEAR, -0.001, 300, 200, 900);
  EXPECT_DOUBLE_EQ(line.at(0), 1.1);
  EXPECT_DOUBLE_EQ(line.at(400), 0.9);
  EXPECT_DOUBLE_EQ(line.at(2000), 0.4);
}

// a rate-form law keeps its stress when its moduli change, an elastic potential its strain: what
// that adds to the stored energy or takes from it is accounted for
TEST(Vary, EnergyBalance)
{
  for (const char *law :
       {"neohookean 1e6 0.3", "linear 1e6 0.3", "eos tait 1e6 7 strength j2 1e6 1e3"}) {
    SCOPED_TRACE(law);
    const bool fluid = has(law, "eos");
    const auto material = make(joined("density 1000 ", law, " thermal ", NO_HEAT, " vary ",
                                      fluid ? "strength.G" : "E", " table 300 1 400 0.5",
                                      fluid ? " vary SIGMAY linear -0.004 300 300 400" : ""));
    expect_balance(*material, 1e-5, [](MaterialPoint &p, double t, int) {
      warm_to(p, 350 - 50 * std::cos(5 * t));
    });
  }
  Point p(joined("density 1000 linear 1e6 0.3 thermal ", NO_HEAT, " vary E table 300 1 400 0.5"));
  move_to(p, uniaxial_stretch(1.01));
  const double stress = p.stress(0), stored = p.stored_energy();
  warm_to(p, 400);
  move_to(p, uniaxial_stretch(1.01));
  EXPECT_DOUBLE_EQ(p.stress(0), stress);
  EXPECT_NEAR(p.stored_energy(), 2 * stored, 1e-10 * stored);
  EXPECT_NEAR(p.work[THERMOELASTIC], -stored, 1e-10 * stored);
}

// the coefficient of expansion, too: it is the mean one from T0 on
TEST(Vary, CoefficientOfExpansion)
{
  Point p(joined("density 1000 linear 1e6 0.3 thermal ", NO_HEAT,
                 " expansion 1e-4 vary ALPHA table 300 1 500 2"));
  for (const double T : {350, 450, 600}) {
    const double factor = T < 500 ? 1 + (T - 300) / 200 : 2;
    warm_to(p, T);
    move_to(p, isotropic(std::exp(1e-4 * factor * (T - 300))));
    EXPECT_NEAR(p.pressure(), 0.0, 1e-8);
  }
}

// adiabatic shear of a metal that softens by what its own work heats it (G.I. Taylor, H. Quinney
// 1934): dT = DTM [1 - exp(-CHI tau0 gamma/(density CP DTM))], tau0 = sigma0/sqrt(3)
TEST(Vary, AdiabaticShear)
{
  const double rho = 7830, cp = 477, chi = 0.9, DTM = 1500, sigma0 = 500e6;
  const std::string start = "density 7830 eos linear 162.7e9 strength ",
                    thermal = " thermal adiabatic 477 293 0.9";
  for (const std::string law :
       {"j2 79.46e9 500e6" + thermal + " vary SIGMAY linear -0.000666666666666667 293 293 1792",
        "johnson/cook 79.46e9 500e6 0 1 0 1 1 1793 293" + thermal}) {
    SCOPED_TRACE(law);
    Point p(start + law);
    const auto strain = [&] {
      return std::sqrt(3.0) * value(p, "eplastic");
    };
    const auto shear = [&](double by) {
      steps(p, {0, by, 0, 0, 0, 0, 0, 0, 0}, 1.0);
    };
    for (const auto &[gamma, dT, tau] :
         {std::array{1.0, 67.97364, 275.5936e6}, std::array{5.0, 310.4299, 228.9329e6}}) {
      const double by =
          1e-3;    // what varies is that of the start of a step: tau lags by 1.4e-4 with 4e-3
      while (strain() < gamma - by) shear(by);
      shear(gamma - strain());    // nearly all of it is plastic
      EXPECT_NEAR(strain() / gamma, 1.0, 1e-6);
      EXPECT_NEAR(DTM * (1 - std::exp(-chi * sigma0 / std::sqrt(3.0) * gamma / (rho * cp * DTM))),
                  dT, 1e-6 * dT);
      EXPECT_NEAR((value(p, "temperature") - 293) / dT, 1.0, 1e-4);
      EXPECT_NEAR(p.vonmises() / std::sqrt(3.0) / tau, 1.0, 1e-4);
    }
    // what is not heat is stored in the metal
    EXPECT_NEAR(p.work[HEAT], chi * p.work[PLASTIC], 1e-12 * p.work[PLASTIC]);
    EXPECT_NEAR(rho * cp * (value(p, "temperature") - 293), p.work[HEAT], 1e-11 * p.work[HEAT]);
  }
  Point cold(start + "j2 79.46e9 500e6 thermal adiabatic 477 293 0");
  steps(cold, {0, 1e-3, 0, 0, 0, 0, 0, 0, 0}, 1.0, 1000);
  EXPECT_EQ(value(cold, "temperature"), 293);
}

// the share of plastic work that is heat: of each step, that at the temperature with which it
// begins, whoever makes the heat, and whatever else varies; the stress does not know of it
TEST(Vary, ShareOfPlasticWork)
{
  const std::string start = "density 7830 eos ", thermal = " thermal adiabatic 477 293 0.5";
  const double C = 7830 * 477.0;
  for (const std::string &law : std::vector<std::string>{
           "linear 162.7e9 strength j2 79.46e9 500e6", "shock 4600 1.4 2 strength j2 79.46e9 500e6",
           "linear 162.7e9 strength johnson/cook 79.46e9 500e6 510e6 0.26 0.014 1 1 1793 293",
           "linear 162.7e9 strength j2 79.46e9 500e6 damage johnson/cook 2 0 0 soften from 0",
           "linear 162.7e9 strength j2 79.46e9 500e6 damage johnson/cook 2 0 0 soften energy 1e6"})
    for (const std::string more : {"", " expansion 1e-5", " vary strength.G table 293 1 900 0.5"})
      for (const std::string share :
           {" vary CHI linear 0.002 293 293 750", " vary CHI table 293 1 350 1.6 500 0.4"}) {
        if (has(law, "shock") && has(more, "expansion")) continue;
        SCOPED_TRACE(law + more + share);
        const bool table = has(share, "table"), broken = has(law, "damage");
        const std::string all = start + law + thermal + (broken ? " fracture 0.5" : "") + more;
        Point p(all + share + (broken ? std::regex_replace(share, std::regex("CHI"), "SHARE") : ""),
                1, 0.01);
        EXPECT_EQ(p.material.is_thermoelastic(), !more.empty());
        const auto factor = [&](double T) {
          if (!table) return 1 + 0.002 * (std::min(T, 750.0) - 293);
          return T < 350 ? 1 + 0.6 * (T - 293) / 57 : T < 500 ? 1.6 - 1.2 * (T - 350) / 150 : 0.4;
        };
        double heat = 0.0, scale = 1e-3;
        for (int i = 0; i < 3000; i++) {
          const double T = value(p, "temperature"), work = p.work[PLASTIC] + p.work[FRACTURE];
          steps(p, {0, 1e-3, 0, 0, 0, 0, 0, 0, 0}, 1.0);
          heat += 0.5 * factor(T) * (p.work[PLASTIC] + p.work[FRACTURE] - work);
          scale = std::max(scale, heat);
          ASSERT_NEAR(p.work[HEAT], heat, 1e-11 * scale) << i;
          ASSERT_NEAR(C * (value(p, "temperature") - 293), heat, 1e-9 * scale);
        }
        EXPECT_GT(value(p, "temperature"), broken ? 360 : 390);
        if (has(law, "shock")) EXPECT_NEAR(value(p, "heat"), heat, 1e-11 * heat);
        if (broken || !more.empty() || has(law, "cook")) continue;
        // dT/dW = CHI(T)/(density CP)
        if (!table)
          EXPECT_NEAR((value(p, "temperature") - 293) /
                          (500 * std::expm1(0.5 * 0.002 * p.work[PLASTIC] / C)),
                      1.0, 2e-4);
        Point q(all, 1, 0.01);
        steps(q, {0, 1e-3, 0, 0, 0, 0, 0, 0, 0}, 1.0, 3000);
        if (!has(law, "shock")) EXPECT_EQ(distance(stress_of(p), stress_of(q)), 0.0);
      }
}

// specific heat by a formula: the temperature has the heat that is its integral, also in melting
TEST(Vary, SpecificHeatByFormula)
{
  struct {
    std::string formula;
    std::function<double(double)> factor, integral;
  } cases[] = {{"linear 0.001 300 200 900",
                [](double T) {
                  return 1 + 0.001 * (T - 300);
                },
                [](double T) {
                  return T + 0.0005 * (T - 300) * (T - 300);
                }},
               {"power 2 300 200 900",
                [](double T) {
                  return T * T / 9e4;
                },
                [](double T) {
                  return T * T * T / 27e4;
                }},
               {"exponential -0.003 300 200 900",
                [](double T) {
                  return std::exp(-0.003 * (T - 300));
                },
                [](double T) {
                  return std::exp(-0.003 * (T - 300)) / -0.003;
                }},
               {"arrhenius -500 300 200 900",
                [](double T) {
                  return std::exp(-500 * (1 / T - 1 / 300.0));
                },
                {}}};
  for (auto &c : cases) {
    // without a closed form: by the rule of Simpson
    if (!c.integral)
      c.integral = [f = c.factor](double T) {
        constexpr int N = 20000;
        double sum = 0.0;
        for (int k = 0; k <= N; k++)
          sum += f(200 + k * (T - 200) / N) * (k == 0 || k == N ? 1 : k % 2 ? 4 : 2);
        return sum * (T - 200) / (3 * N);
      };
    for (const std::string melts : {"", " melt 500 2e5", " melt 500 2e5 over 100"}) {
      SCOPED_TRACE(c.formula + melts);
      const std::string end = melts + " vary CP " + c.formula;
      Point p("density 1000 eos linear 1e9 thermal conducting 900 300 50" + end);
      std::vector<double> first, h;
      for (std::size_t k = 0; k < p.material.history().size(); k++) first.push_back(p.history(k));
      const int at = row(p.material, "temperature");
      const auto sensible = [&](double T) {
        const double inside = std::min(std::max(T, 200.0), 900.0);
        return 900 * (c.integral(inside) - c.integral(200) + c.factor(inside) * (T - inside));
      };
      const auto heat = [&](double T) {
        const double share = has(melts, "over") ? (T - 500) / 100 : T > 500;
        return sensible(T) + (melts.empty() ? 0.0 : 2e5 * std::min(std::max(share, 0.0), 1.0));
      };
      // the curve is exact at the limits, and at some temperatures between them
      first[at] = 200;
      for (const double T : {120.0, 250.0, 310.0, 499.0, 550.0, 700.0, 900.0, 950.0}) {
        const bool outside = T < 200 || T >= 900;
        h = first;
        p.material.warm(h.data(), heat(T));
        EXPECT_NEAR(h[at] / T, 1.0, outside ? 1e-9 : 1e-5) << T;
        EXPECT_NEAR(p.material.conduction(h.data()).capacity /
                        (900 * c.factor(std::min(std::max(T, 200.0), 900.0))),
                    1.0, T > 900 ? 1e-9 : 1e-3);
        p.material.warm(h.data(), -heat(T));
        EXPECT_NEAR(h[at], 200, 1e-12 * 200);
      }
      // by its own work
      Point q("density 1000 eos linear 1e9 viscosity newtonian 1e12 thermal adiabatic 900 200" +
              end);
      for (int i = 0; i < 100; i++) {
        steps(q, {0, 0.03, 0, 0.03, 0, 0, 0, 0, 0}, 0.001);
        const double molten = melts.empty() ? 0.0 : 2e5 * value(q, "molten");
        EXPECT_NEAR((sensible(value(q, "temperature")) + molten) * 1000, q.work[VISCOUS],
                    1e-5 * 3.6e8);
      }
      EXPECT_NEAR(q.work[VISCOUS], 3.6e8, 1e-12 * 3.6e8);
    }
  }
}

TEST(Vary, BadInputIsRefused)
{
  const std::string bad = "linear 1 0.3 thermal adiabatic 1 300 vary ";
  expect_refused(
      {{"linear 1 0.3 vary E table 1 1 2 1", "add 'thermal adiabatic'", 6},
       {bad + "G table 1 1 2 1", "no such parameter: choose one of linear.E"},
       {bad + "E cubic 1 1 2 1", "expected table, linear, power"},
       {bad + "E table 1 1", "T is missing"},
       {bad + "E table 1 1 1 1", "must increase"},
       {bad + "E table 1 1 2 0", "vary E: it is 0 at the temperature 2, which is out"},
       {bad + "E linear -0.01 300 200 400", "it is 0 at the temperature 400"},
       {bad + "NU table 1 1 2 2", "vary NU: it is 0.6 at the temperature 2"},
       {bad + "E linear 1 300 400 200", "TLOW must be less"},
       {bad + "E power 1 0 200 400", "absolute temperatures"},
       {bad + "E arrhenius 1 300 -1 400", "absolute temperatures"},
       {bad + "E table 1 1 2 1 vary E table 1 1 2 1", "given twice"},
       {bad + "T0 table 1 1 2 1", "the coefficient of expansion can vary"},
       {bad + "CHI linear 0.01 300 300 400", "it is 1.8 at the temperature 400"},
       {bad + "SHARE table 1 1 2 1", "its value is 0"},
       {bad + "CP linear -0.01 300 300 400", "it is 0 at the temperature 400"},
       {bad + "CP exponential 1 300 300 310", "too much between its limits"},
       {bad + "CP power 30 300 200 400", "too much between its limits"},
       {bad + "ALPHA table 1 1 2 1", "its value is 0"},
       {"eos tait 1 7 cutoff -0.1 thermal adiabatic 1 300 vary K table 1 1 2 0.5",
        "at the temperature 2, tait: PMIN is never reached"},
       // fits at all knots, but not between them
       {"camclay 1 1 0.11 0.1 1 1 2 thermal adiabatic 1 1 vary LAMBDA exponential 2.113 0 0 1 "
        "vary KAPPA linear 8 0 0 1",
        "at the temperature 0.[0-9]*, camclay: LAMBDA must be above KAPPA"},
       // what only new points have
       {"gurson 1 0.3 1 0.1 thermal adiabatic 1 1 vary F0 table 1 1 2 2",
        "new points.*choose one of gurson.E, gurson.NU, gurson.SIGMAY, gurson.E0"},
       {"camclay 1 1 0.2 0.1 1 1 2 thermal adiabatic 1 1 vary PC table 1 1 2 2", "new points"},
       {"eos linear 1 strength elastic 1 damage rankine 1 weibull 5 1 7 thermal "
        "adiabatic 1 1 vary SEED table 1 1 2 2",
        "new points"},
       {"eos jwl 1 1 1 1 1 1 1 detonate 1 1 1 1 thermal adiabatic 1 1 vary X1 table 1 1 2 2",
        "new points"},
       {"eos ideal/gas 1.4 energy 1 thermal adiabatic 1 1 vary E0 table 1 1 2 2", "new points"},
       // the list of what can vary has nothing that cannot
       {"eos linear 1 thermal adiabatic 1 1 expansion 1 vary X table 1 1 2 1",
        "choose one of eos.K, thermal.CP, thermal.CHI, thermal.ALPHA, thermal.SHARE$"}},
      "density 1 ");
}

// the work of damage becomes heat as far as one says so
TEST(Sources, WorkOfDamage)
{
  for (const double share : {0.0, 0.4, 1.0})
    for (const char *damage : {"strength j2 26e9 1e8 damage cockcroft/latham 2e6 soften from 0.1",
                               "strength elastic 26e9 damage rankine 1e7 soften energy 1e2"}) {
      SCOPED_TRACE(joined(damage, " ", share));
      Point p(joined("density 2700 eos linear 70e9 ", damage,
                     " thermal adiabatic 900 293 0.8 fracture ", share),
              1, 0.01);
      double energy = 0.0;
      for (int i = 0; i < 2000; i++) {
        steps(p, diagonal(2e-5, -4e-6, -4e-6), 1.0);
        energy = std::max(energy, p.stored_energy());
      }
      EXPECT_EQ(value(p, "damage"), 1.0);
      EXPECT_GT(p.work[FRACTURE], 0.1 * energy);
      const double heat = 0.8 * p.work[PLASTIC] + share * p.work[FRACTURE];
      EXPECT_NEAR(p.work[HEAT], heat, 1e-9 * (heat + 1));
      EXPECT_NEAR(2700 * 900 * (value(p, "temperature") - 293), heat, 1e-6 * (heat + 1));
    }
}

// the heat of a damage is in the internal energy as it is in the temperature, and raises the
// pressure. A point is torn apart and pushed together: work is what is stored and set free
TEST(Sources, WorkOfDamageRaisesThePressure)
{
  constexpr double SHARE = 0.6, CP = 900;
  const struct {
    std::string eos;
    double density, gamma;
  } cases[] = {{"shock 5000 1.4 2", 2700, 2},
               {"polynomial 7e10 8e10 5e10 2 1.5 6e10 0", 2700, 2},
               {"stiffened/gas 4.4 3e10", 1000, 3.4}};
  for (const auto &c : cases)
    for (const std::string kind : {"adiabatic 900 300 0.8", "conducting 900 300 50 0.8"})
      for (const std::string soft : {"", " soften energy 5e5"}) {
        SCOPED_TRACE(c.eos + " " + kind + soft);
        // a gas follows the isentrope: no work by the trapezoidal rule
        const bool gas = has(c.eos, "gas"), conducts = has(kind, "conducting");
        Point p(joined("density ", c.density, " eos ", c.eos,
                       " strength elastic 26e9 damage rankine 2e9", soft, " thermal ", kind,
                       " fracture ", SHARE),
                1, 0.01);
        const auto heat = [&p] {
          return value(p, "heat") + value(p, "unspent_heat");
        };
        move_to(p, IDENTITY);
        const double stored0 = p.stored_energy();
        double work = 0.0, brought = 0.0;
        const auto steps_to = [&](double J) {
          const double from = p.batch.J[0];
          for (int i = 1; i <= 50; i++) {
            const double Jold = p.batch.J[0], old = p.pressure();
            if (conducts && value(p, "damage") == 1.0) {
              warm_to(p, value(p, "temperature") + 0.1);
              brought += c.density * CP * 0.1;
            }
            move_to(p, isotropic(std::cbrt(from + i * (J - from) / 50)));
            work -= 0.5 * (old + p.pressure()) * (p.batch.J[0] - Jold);
            const double q = SHARE * p.work[FRACTURE] + brought;
            if (!gas && (soft.empty() || value(p, "damage") == 0.0))
              EXPECT_NEAR(p.stored_energy() - stored0 + p.work[FRACTURE], work, 1e-11 * 2e7);
            EXPECT_NEAR(heat(), q, 1e-10 * 2e7);
            EXPECT_NEAR(c.density * CP * (value(p, "temperature") - 300), q, 1e-10 * 2e7);
          }
        };
        steps_to(1.08);
        EXPECT_EQ(value(p, "damage"), 1.0);
        const double set_free = p.work[FRACTURE];
        EXPECT_GT(set_free, 1e7);
        EXPECT_NEAR(p.pressure(), 0.0, 1e-6);
        const double before = work - p.stored_energy();
        steps_to(1.0);
        steps_to(0.97);
        steps_to(1.0);
        move_to(p, IDENTITY);
        if (!gas) EXPECT_NEAR(work - p.stored_energy(), before, 1e-11 * 2e7);
        EXPECT_EQ(p.work[FRACTURE], set_free);
        EXPECT_NEAR(p.work[HEAT], SHARE * set_free, 1e-12 * set_free);
        EXPECT_EQ(value(p, "unspent_heat"), 0.0);
        const double thermal = SHARE * set_free + brought;
        EXPECT_NEAR(p.pressure() / (c.gamma * thermal), 1.0, 0.05);
      }
}

// the same in any motion, of second order; no plastic work in tension, which has its own error
TEST(Sources, WorkOfDamageWithPlasticWork)
{
  const std::string start = "density 7850 eos shock 4600 1.4 2 strength j2 77e9 490e6 damage ";
  for (const char *damage : {"johnson/cook 0.004 0.002 -1.5 soften from 0.2 after friction 0.4",
                             "johnson/cook 0.004 0.002 -1.5 after none", "rankine 4e8",
                             "rankine 4e8 soften energy 1e4 after friction 0.4"})
    for (const double chi : {0.0, 0.8}) {
      SCOPED_TRACE(joined(damage, " ", chi));
      const auto material =
          make(joined(start, damage, " thermal adiabatic 460 293 ", chi, " fracture 0.7"));
      double error[3] = {}, scale = 0.0;
      for (int level = 0; level < 3; level++) {
        MaterialPoint p(*material, 1, 0.01);
        const int n = 500 << 2 * level;
        for (int i = 0; i < n; i++) {
          const double t = 2 * M_PI * (i + 0.5) / n, c = std::cos(t), s = std::sin(t);
          steps(p, {0.03 * c, 0.05 * c, 0, 0.01 * c, -0.002 * s, 0.02 * s, 0, 0, 0.01 * c},
                1.0 / n);
          const double accounted = p.stored_energy() + p.work[PLASTIC] + p.work[FRACTURE];
          error[level] = std::max(error[level], std::fabs(accounted - p.power));
          scale = std::max(scale, p.power);
          const double heat = chi * p.work[PLASTIC] + 0.7 * p.work[FRACTURE];
          ASSERT_NEAR(value(p, "heat") + value(p, "unspent_heat"), heat, 1e-12 * scale);
          ASSERT_NEAR(7850 * 460 * (value(p, "temperature") - 293), heat, 1e-10 * scale);
        }
        EXPECT_EQ(value(p, "damage"), 1.0);
        EXPECT_GT(p.work[FRACTURE], 0.01 * scale);
      }
      for (int level = 0; level < 3 && chi == 0.0; level++)
        EXPECT_LT(error[level], 6e-5 / (1 << 4 * level) * scale) << level;
    }
  // detonation products bear no tension, but break by shear: temperature follows from energy
  Point p(
      "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 strength j2 3e9 1e8 damage "
      "johnson/cook 0.05 0 0 thermal conducting 1000 293 1 0.9 fracture 0.5");
  move_to(p, IDENTITY);
  const double start_T = value(p, "temperature"), E = value(p, "energy");
  steps(p, {0, 1e-3, 0, 1e-3, 0, 0, 0, 0, 0}, 1.0, 100);
  EXPECT_EQ(value(p, "damage"), 1.0);
  const double heat = 0.9 * p.work[PLASTIC] + 0.5 * p.work[FRACTURE];
  EXPECT_GT(0.5 * p.work[FRACTURE], 1e-3 * heat);
  EXPECT_NEAR(value(p, "heat"), heat, 1e-12 * heat);
  const double J = p.batch.J[0];
  EXPECT_NEAR(J, 1.0, 1e-12);
  const auto cold = [](double J) {
    return 371.2e9 / 4.15 * std::exp(-4.15 * J) + 3.231e9 / 0.95 * std::exp(-0.95 * J);
  };
  EXPECT_NEAR(1630 * 1000 * (value(p, "temperature") - start_T),
              value(p, "energy") - E - cold(J) + cold(1.0), 1e-12 * E);
}

// all that any law dissipates warms its point: the share CHI of plastic work, and all viscous work
TEST(Sources, AllDissipation)
{
  int n = 0;
  for (const auto &sample : samples) {
    SCOPED_TRACE(sample.name);
    if (has(sample.text, "constant") || has(sample.text, "snow")) continue;
    if (has(sample.text, "jwl")) continue;          // see DetonationProducts
    if (has(sample.text, "ideal/gas")) continue;    // see TemperatureOfAnIdealGas
    Point p(with_thermal(sample.text, "adiabatic 1e6 20 0.7"), 1, 0.01);
    const double rho = std::strtod(sample.text + strlen("density "), nullptr);
    RandomMatrix random(5);
    for (int i = 0; i < 100; i++) steps(p, random(0.02), 1.0);
    const double heat = 0.7 * p.work[PLASTIC] + p.work[VISCOUS];
    EXPECT_NEAR(rho * 1e6 * (value(p, "temperature") - 20), heat, 1e-6 * heat + 1e-7 * rho);
    n += heat > 0.0;
  }
  EXPECT_GT(n, 30);
}

// temperature of detonation products is of thermal energy, falling as J^-OMEGA; half burnt, half
TEST(Sources, DetonationProducts)
{
  const double A = 371.2e9, B = 3.231e9, R1 = 4.15, R2 = 0.95, omega = 0.3, E0 = 7e9;
  const std::string tnt = "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 ",
                    thermal = "thermal adiabatic 1000 293";
  const double hot = (E0 - A / R1 * std::exp(-R1) - B / R2 * std::exp(-R2)) / (1630 * 1000);
  EXPECT_GT(hot, 2000);
  Point p(tnt + thermal);
  move_to(p, IDENTITY);
  EXPECT_NEAR(value(p, "temperature"), hot, 1e-12 * hot);
  for (const double l : {0.9, 1.5, 3.0}) {
    compress(p, l, 2000);
    EXPECT_NEAR(value(p, "temperature") / (hot * std::pow(l, -omega)), 1.0, 8e-7);
  }
  // three cells of 1 m burn in 3/6930 s
  Point q(tnt + "detonate 0 0 0 0 " + thermal, 1, 1.0);
  for (int i = 1; i <= 12; i++) {
    move_to(q, IDENTITY, 0.1 * 3 / 6930);
    const double burn = std::min(0.1 * i, 1.0);
    EXPECT_NEAR(value(q, "temperature"), burn * hot + (1 - burn) * 293, 1e-12 * hot);
  }
  // viscous heat, once
  Point v(tnt + "viscosity newtonian 1e9 " + thermal);
  move_to(v, IDENTITY);
  steps(v, {0, 1, 0, 1, 0, 0, 0, 0, 0}, 1e-3, 100);
  const double J = v.batch.J[0];
  const double thermal_energy =
      value(v, "energy") - A / R1 * std::exp(-R1 * J) - B / R2 * std::exp(-R2 * J);
  EXPECT_NEAR(value(v, "temperature"), thermal_energy / (1630 * 1000), 1e-11 * hot);
  EXPECT_NEAR(thermal_energy / (1630 * 1000),
              hot * std::pow(J, -omega) + v.work[VISCOUS] / (1630 * 1000), 1e-11 * hot);
  EXPECT_GT(v.work[VISCOUS] / (1630 * 1000), 100);
  expect_refused(
      {{tnt + "thermal conducting 1000 293 1 0.9 gruneisen 1", "follows from the internal energy"},
       {tnt + "thermal adiabatic 1000 293 gruneisen 1", "without 'gruneisen'"},
       {tnt + "thermal adiabatic 1000 293 melt 400 1e5", "without 'gruneisen' and 'melt'"},
       {tnt + "thermal adiabatic 1000 293 melt 400 1e5 over 20", "and 'melt'"},
       {tnt + "thermal adiabatic 1000 293 vary CP table 200 1 4000 2", "constant CP"}});
}

// heat that is conducted into detonation products counts once, before, while, and after they burn
TEST(Sources, DetonationProductsConduct)
{
  const double A = 371.2e9, B = 3.231e9, R1 = 4.15, R2 = 0.95, omega = 0.3, E0 = 7e9,
               C = 1630 * 1000;
  const std::string tnt =
      "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 detonate 0 "
      "0 0 0 thermal conducting 1000 293 1";
  const double cold = A / R1 * std::exp(-R1) + B / R2 * std::exp(-R2), hot = (E0 - cold) / C;
  Point p(tnt, 1, 1.0);
  double brought = 0.0;
  for (int i = 1; i <= 15; i++) {
    warm_to(p, value(p, "temperature") + 10.0 * i);
    brought += 10.0 * i;
    move_to(p, IDENTITY, 0.1 * 3 / 6930);
    const double burn = std::min(0.1 * i, 1.0);
    EXPECT_NEAR(value(p, "temperature"), burn * hot + (1 - burn) * 293 + brought, 1e-11 * hot);
    EXPECT_NEAR(value(p, "energy") - E0, C * brought, 1e-12 * E0);
    EXPECT_NEAR(value(p, "heat"), C * brought, 1e-12 * E0);
  }
  const double E = E0 + C * brought;
  EXPECT_NEAR(-p.stress(0),
              A * (1 - omega / R1) * std::exp(-R1) + B * (1 - omega / R2) * std::exp(-R2) +
                  omega * E,
              1e-11 * E);
  // expanded, it is as if all had been there from the start
  compress(p, 2.0, 2000);
  EXPECT_NEAR(value(p, "temperature") / ((E - cold) / C * std::pow(2.0, -omega)), 1.0, 6e-7);
  // what had burnt from the start is warm, and nothing was conducted to it
  Point all("density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930 thermal conducting 1000 "
            "293 1");
  for (int i = 0; i < 3; i++) {
    move_to(all, IDENTITY);
    EXPECT_NEAR(value(all, "temperature"), hot, 1e-12 * hot);
    EXPECT_EQ(value(all, "heat"), 0.0);
  }
  // together with viscous heat, once
  const auto viscous =
      std::regex_replace(tnt, std::regex("thermal"), "viscosity newtonian 1e9 thermal");
  Point v(viscous, 1, 1.0), w(viscous, 1, 1.0);
  for (auto *q : {&v, &w}) move_to(*q, IDENTITY, 1.0);
  for (int i = 0; i < 100; i++) {
    warm_to(v, value(v, "temperature") + 3.0);
    for (auto *q : {&v, &w}) steps(*q, {0, 1, 0, 1, 0, 0, 0, 0, 0}, 1e-3);
  }
  EXPECT_GT(w.work[VISCOUS], 1e8);
  EXPECT_NEAR(value(v, "temperature") - value(w, "temperature"), 300.0, 1e-9);
}

const std::string METAL =
    "density 1000 eos linear 1e6 strength j2 5e5 1e3 hardening linear 1e4 "
    "viscosity newtonian 10 liquid thermal adiabatic 1e30 300 0 melt 400 1e30";

/** Sets the molten fraction at the melting point. */
void melt(MaterialPoint &p, double f)
{
  warm_to(p, 400);
  p.batch.history[row(p.material, "molten")][0] = f;
}

// a melt is Newtonian, whatever the solid was; what solidifies is a new solid without shear stress
TEST(Melting, IsALiquidThenANewSolid)
{
  const Matrix shear = {0, 0.01, 0, 0.01, 0, 0, 0, 0, 0};
  Point p(METAL), fluid("density 1000 eos linear 1e6 viscosity newtonian 10"),
      metal("density 1000 eos linear 1e6 strength j2 5e5 1e3 hardening linear 1e4");
  steps(p, shear, 1.0, 20);
  EXPECT_GT(value(p, "eplastic"), 0.1);
  EXPECT_GT(p.vonmises(), 1e3);
  melt(p, 1.0);
  steps(p, shear, 1.0);
  steps(fluid, shear, 1.0, 21);
  EXPECT_LT(distance(stress_of(p), stress_of(fluid)), 1e-12);
  EXPECT_EQ(value(p, "eplastic"), 0.0);
  EXPECT_NEAR(p.wave_speed(), fluid.wave_speed(), 1e-12 * fluid.wave_speed());
  melt(p, 0.0);
  steps(p, {}, 1.0);
  EXPECT_NEAR(p.vonmises(), 0.0, 1e-12);
  steps(p, shear, 1.0, 20);
  steps(metal, shear, 1.0, 20);
  EXPECT_NEAR(p.vonmises(), metal.vonmises(), 1e-12 * metal.vonmises());
  EXPECT_NEAR(value(p, "eplastic"), value(metal, "eplastic"), 1e-12);
}

// half of it is solid: half of the strength, and half of the viscosity
TEST(Melting, PartsShareTheStress)
{
  Point p(METAL);
  melt(p, 0.5);
  steps(p, {0, 1e-4, 0, 1e-4, 0, 0, 0, 0, 0}, 1.0);
  EXPECT_NEAR(p.stress(3), 0.5 * 2 * 5e5 * 1e-4 + 0.5 * 2 * 10 * 1e-4, 1e-9);
  const double stored = p.stored_energy(), elastic = 0.5 * 100.0;    // of the points
  EXPECT_NEAR(stored, 0.5 * 2 * 100.0 * 100.0 / (4 * 5e5), 1e-13);
  // melting takes its share away, and its energy becomes heat
  melt(p, 0.75);
  steps(p, {}, 1.0);
  EXPECT_NEAR(p.stress(3), 0.5 * elastic, 1e-9);
  EXPECT_NEAR(p.stored_energy(), 0.5 * stored, 1e-12 * stored);
  EXPECT_NEAR(p.work[PLASTIC], 0.5 * stored, 1e-12 * stored);
  EXPECT_NEAR(p.work[HEAT], 0.5 * stored, 1e-12 * stored);
  // solidification does not change the stress
  melt(p, 0.5);
  steps(p, {}, 1.0);
  EXPECT_NEAR(p.stress(3), 0.5 * elastic, 1e-9);
  EXPECT_NEAR(p.stored_energy() + p.work[PLASTIC], stored, 1e-12 * stored);
}

// Warming takes energy of a shear that a softer modulus no longer stores, also where a damage keeps
// that energy: with half of it lost, half as much
TEST(Damage, KeepsTheEnergyOfWarming)
{
  const std::string metal = "density 8930 eos linear 130e9 strength elastic 45e9 ",
                    thermal = "thermal adiabatic 383 298 0.9 vary strength.G table 298 1 498 0.5";
  Point plain(metal + thermal), whole(metal + "damage rankine 1e13 " + thermal),
      half(metal + "damage rankine 1e13 " + thermal);
  half.batch.history[row(half.material, "damage")][0] = 0.5;
  for (auto *p : {&plain, &whole, &half}) {
    steps(*p, {0, 0.01, 0, 0.01, 0, 0, 0, 0, 0}, 1.0);
    p->batch.history[row(p->material, "temperature")][0] = 398.0;
    steps(*p, {}, 1.0);
  }
  EXPECT_GT(std::fabs(plain.work[THERMOELASTIC]), 1e5);
  EXPECT_NEAR(whole.work[THERMOELASTIC], plain.work[THERMOELASTIC],
              1e-9 * std::fabs(plain.work[THERMOELASTIC]));
  EXPECT_NEAR(half.work[THERMOELASTIC], 0.5 * plain.work[THERMOELASTIC],
              1e-9 * std::fabs(plain.work[THERMOELASTIC]));
}

// Two parts that take the energy of one tension, or release one energy again and again
TEST(Damage, PairsThatCountTwiceAreRefused)
{
  const std::string end = " thermal adiabatic 383 298 0.9";
  expect_refused({{"eos shock 3940 1.49 1.96 spall -1e9 strength elastic 45e9 damage rankine 4e8",
                   "spall and damage both take the tension"},
                  {"eos linear 130e9 strength j2 45e9 1e8 kinematic 1e9 10 damage johnson/cook 0.5 "
                   "1 -1 after friction 0.3",
                   "leave 'after friction' out"}},
                 "density 8930 ");
  for (const char *words :
       {"eos shock 3940 1.49 1.96 cutoff -1e9 strength elastic 45e9 damage rankine 4e8",
        "eos linear 130e9 strength j2 45e9 1e8 kinematic 1e9 10 damage johnson/cook 0.5 1 -1"})
    EXPECT_NO_THROW(make(std::string("density 8930 ") + words + end));
}

TEST(Melting, EnergyBalance)
{
  const auto material = make(METAL);
  double scale = 0.0;
  const auto error = refined(500, [&](int n) {
    MaterialPoint p(*material, 1, 0.01);
    double worst = 0.0;
    for (int i = 0; i < n; i++) {
      const double t = (i + 0.5) / n;
      melt(p, std::min(std::max(0.5 - 0.8 * std::cos(9 * t), 0.0), 1.0));
      steps(p, Matrix{0.1, 0.1 * std::cos(7 * t), 0, 0, -0.2 * t, 0.05, 0.1, 0, 0.08}, 1.0 / n);
      worst = std::max(worst,
                       std::fabs(p.stored_energy() + p.work[PLASTIC] + p.work[VISCOUS] - p.power));
      scale = std::max(scale, std::fabs(p.power));
    }
    return worst;
  });
  EXPECT_LT(error[2], 8e-5 * scale);
  EXPECT_GT(std::log2(error[0] / error[2]), 2 * 0.85)
      << error[0] / scale << " " << error[2] / scale;
}

// what solid and liquid dissipate melts more of the solid
TEST(Melting, TakesUpItsOwnHeat)
{
  Point p("density 1000 eos linear 1e6 strength j2 5e5 1e3 viscosity newtonian 1e3 liquid "
          "thermal adiabatic 1000 400 0.9 melt 400 10");
  p.batch.history[row(p.material, "molten")][0] = 0.3;
  for (int i = 0; i < 30; i++) {
    steps(p, {0, 0.05, 0, 0.01, 0, 0, 0, 0, 0.01}, 1.0);
    const double taken = 10 * (value(p, "molten") - 0.3) + 1000 * (value(p, "temperature") - 400);
    const double heat = p.work[HEAT] + p.work[VISCOUS];
    ASSERT_NEAR(1000 * taken, heat, 1e-9 * heat + 1e-8);
  }
  EXPECT_GT(value(p, "molten"), 0.35);
  EXPECT_LT(value(p, "molten"), 1.0);
  EXPECT_GT(p.work[VISCOUS], 10.0);
}

TEST(Melting, BadInputIsRefused)
{
  expect_refused(
      {{"eos linear 1 strength j2 1 1 viscosity newtonian 1 liquid", "add 'melt TMELT LATENT'", 10},
       {"eos linear 1 viscosity newtonian 1 liquid thermal adiabatic 1 1 melt 2 1",
        "with a strength"},
       {"linear 1 0 viscosity newtonian 1 liquid thermal adiabatic 1 1 melt 2 1",
        "with a strength"},
       {"eos linear 1 strength j2 1 1 viscosity maxwell term 1 1 liquid thermal adiabatic 1 1 melt "
        "2 1",
        "a melt forgets"},
       {"eos linear 1 strength j2 1 1 viscosity newtonian 1 liquid damage cockcroft/latham 1 "
        "thermal adiabatic 1 1 melt 2 1",
        "cannot have a damage"}},
      "density 1 ");
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit physics input
// mpi: 1 2

// Mixed control of a point against closed forms; the command mpm_point: paths, table, errors.

#include "material/material_testing.h"
#include "mpm_lammps.h"

using namespace material_testing;
using MPM_NS::MixedControl;
using MPM_TEST::Scene;

// neo-Hookean solid of the tests: principal Cauchy stress along a stretch

constexpr double E = 2e6, NU = 0.3, MU = E / (2 * (1 + NU)),
                 LAMBDA = E * NU / ((1 + NU) * (1 - 2 * NU));
const std::string RUBBER = "density 1000 neohookean 2e6 0.3";

double neohookean(double stretch, double J)
{
  return (MU * (stretch * stretch - 1.0) + LAMBDA * std::log(J)) / J;
}

/** Lateral stretch and axial stress in uniaxial stress with this lateral stress. */
std::array<double, 2> uniaxial(double stretch, double lateral = 0.0)
{
  const double side = root_of(0.2, 3.0, [=](double s) {
    return neohookean(s, stretch * s * s) - lateral;
  });
  return {side, neohookean(stretch, stretch * side * side)};
}

/** A table that mpm_point wrote: columns by name. */
std::map<std::string, std::vector<double>> read_table(const std::string &name)
{
  std::map<std::string, std::vector<double>> table;
  std::vector<std::string> names;
  std::ifstream file(name);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    if (names.empty()) {
      for (std::string word; in >> word;) names.push_back(word);
      continue;
    }
    for (const auto &column : names) {
      double x = NAN;
      in >> x;
      table[column].push_back(x);
    }
  }
  return table;
}

/** The table of a command, everything behind the name of the file. */
std::map<std::string, std::vector<double>> drive(const std::string &path,
                                                 const std::string &before = "units si\n")
{
  const MPM_TEST::ScratchFile file("table");
  {
    Scene run(before + "mpm_point " + file.name + " " + path + "\n");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  auto table = read_table(file.name);
  return table;
}

TEST(MixedControl, NeoHookeanInUniaxialStress)
{
  const auto material = make(RUBBER);
  for (const double end : {0.3, 3.0}) {
    MaterialPoint p(*material);
    MixedControl c;
    const int n = 7;
    c.L[0] = std::log(end) / n;
    c.stress_given[1] = c.stress_given[2] = true;
    for (int i = 0; i < n; i++) p.step(c, 1.0);
    const auto [side, stress] = uniaxial(end);
    EXPECT_NEAR(p.batch.F[0][0], end, 1e-13 * end);
    EXPECT_NEAR(p.batch.F[4][0], side, 1e-12);
    EXPECT_NEAR(p.batch.F[8][0], side, 1e-12);
    EXPECT_NEAR(p.stress(0), stress, 1e-11 * E);
    EXPECT_NEAR(p.stress(1), 0.0, 1e-11 * E);

    // the same state from the stress alone, also with shear components free
    MaterialPoint q(*material);
    c.L[0] = 0.0;
    for (bool &given : c.stress_given) given = true;
    for (int i = 1; i <= 40; i++) {
      c.stress[0] = stress * i / 40;
      q.step(c, 0.1);
    }
    EXPECT_NEAR(q.batch.F[0][0], end, 1e-10);
    EXPECT_NEAR(q.batch.F[4][0], side, 1e-10);
    EXPECT_NEAR(q.batch.F[1][0], 0.0, 1e-10);
  }
}

// shear stress at given shear rate is free: simple shear with free normal stress
TEST(MixedControl, ShearWithFreeFaces)
{
  Point p(RUBBER);
  MixedControl c;
  c.L[1] = 0.1;
  c.stress_given[1] = c.stress_given[2] = true;
  for (int i = 0; i < 10; i++) p.step(c, 1.0);
  EXPECT_NEAR(p.stress(1), 0.0, 1e-11 * E);
  EXPECT_NEAR(p.stress(2), 0.0, 1e-11 * E);
  EXPECT_GT(p.stress(3), 0.5 * MU);
  EXPECT_NEAR(p.power, p.stored_energy(), 1e-12 * E);    // P is linear in the shear
}

// a rotation of the frame changes nothing in it, for any path
TEST(MixedControl, SuperposedRotation)
{
  Point p(RUBBER), q(RUBBER);
  MixedControl c;
  c.L[0] = 0.4;
  c.L[1] = 0.3;
  c.stress_given[1] = true;
  c.stress[1] = -1e5;
  const int n = 60;
  for (int i = 1; i <= n; i++) {
    const auto R = rotation({0.6, 0.0, 0.8}, 10 * 2 * M_PI * i / n);
    p.step(c, 1.0 / n);
    q.step(c, 1.0 / n, R.data());
  }
  double F[2][9], stress[2][6];
  p.frame_state(F[0], stress[0]);
  q.frame_state(F[1], stress[1]);
  for (int k = 0; k < 9; k++) EXPECT_NEAR(F[1][k], F[0][k], 1e-12);
  for (int k = 0; k < 6; k++) EXPECT_NEAR(stress[1][k], stress[0][k], 1e-11 * E);
  EXPECT_NEAR(stress[0][1], -1e5, 1e-13 * E);
}

TEST(MixedControl, ViscousFluidUnderShearStress)
{
  const double viscosity = 3.0, tau = 12.0;
  Point p("density 1000 eos linear 1e6 viscosity newtonian 3");
  MixedControl c;
  c.stress_given[3] = true;
  c.stress[3] = tau;
  for (int i = 0; i < 10; i++) p.step(c, 1e-3);
  EXPECT_NEAR(p.batch.A[1][0] / 1e-3, tau / (2 * viscosity), 2e-5);
  EXPECT_NEAR(p.stress(3), tau, 1e-10);
}

// all unknowns at once, far in the plastic range, and a strength that ends
TEST(MixedControl, PlasticFlow)
{
  Point p("density 7800 eos linear 160e9 strength j2 80e9 300e6 hardening linear 2e9");
  MixedControl c;
  for (bool &given : c.stress_given) given = true;
  const int n = 50;
  for (int i = 1; i <= n; i++) {
    c.stress[3] = 500e6 / std::sqrt(3.0) * i / n;    // pure shear: q = sqrt(3) tau
    c.stress[0] = c.stress[1] = c.stress[2] = -1e9 * i / n;
    p.step(c, 1.0 / n);
  }
  EXPECT_NEAR(p.vonmises(), 500e6, 1e-2);
  EXPECT_NEAR(p.pressure(), 1e9, 1e-2);
  EXPECT_NEAR(p.history(0), (500e6 - 300e6) / 2e9, 1e-13);

  Point q("density 7800 eos linear 160e9 strength j2 80e9 300e6");
  MixedControl tension;
  tension.stress_given[0] = tension.stress_given[1] = tension.stress_given[2] = true;
  tension.stress[0] = 299e6;
  q.step(tension, 1.0);
  EXPECT_NEAR(q.stress(0), 299e6, 1e-2);
  tension.stress[0] = 301e6;
  EXPECT_THROW(q.step(tension, 1.0), std::runtime_error);
}

TEST(Point, UniaxialStress)
{
  auto t = drive("uniaxial/stress 2 time 0.25 steps 50 every 10 material " + RUBBER);
  ASSERT_EQ(t["step"].size(), 6);
  for (size_t k = 0; k < t["step"].size(); k++) {
    const double stretch = std::exp(2.0 * t["time"][k]);
    const auto [side, stress] = uniaxial(stretch);
    EXPECT_EQ(t["step"][k], 10.0 * k);
    EXPECT_NEAR(t["time"][k], 0.05 * k, 1e-15);
    EXPECT_NEAR(t["Fxx"][k], stretch, 1e-12);
    EXPECT_NEAR(t["exx"][k], 2.0 * t["time"][k], 1e-12);
    EXPECT_NEAR(t["eyy"][k], std::log(side), 1e-12);
    EXPECT_NEAR(t["sxx"][k], stress, 1e-12 * E);
    EXPECT_NEAR(t["vonmises"][k], stress, 1e-12 * E);
    EXPECT_NEAR(t["pressure"][k], -stress / 3, 1e-12 * E);
    EXPECT_NEAR(t["lode"][k], k == 0 ? 0.0 : 1.0, 1e-10);
    EXPECT_NEAR(t["work"][k], t["stored"][k], 2e-5 * E);
  }
  t = drive("uniaxial/stress -2 strain 0.5 yy stress -3e5 zz stress -3e5 material " + RUBBER);
  EXPECT_NEAR(t["exx"].back(), -0.5, 1e-12);
  EXPECT_NEAR(t["sxx"].back(), uniaxial(std::exp(-0.5), -3e5)[1], 1e-12 * E);
  EXPECT_NEAR(t["lode"].back(), -1.0, 1e-10);
}

TEST(Point, PathsOfGivenMotion)
{
  auto t = drive("uniaxial/strain -1 strain 0.3 material " + RUBBER);
  EXPECT_NEAR(t["sxx"].back(), neohookean(std::exp(-0.3), std::exp(-0.3)), 1e-12 * E);
  EXPECT_NEAR(t["Fyy"].back(), 1.0, 1e-15);
  t = drive("volumetric 1 strain 0.3 material " + RUBBER);
  EXPECT_NEAR(t["J"].back(), std::exp(0.3), 1e-12);
  EXPECT_NEAR(-t["pressure"].back(), neohookean(std::exp(0.1), std::exp(0.3)), 1e-12 * E);
  t = drive("shear 3 strain 1.5 steps 13 material " + RUBBER);
  EXPECT_EQ(t["step"].size(), 14);
  EXPECT_NEAR(t["Fxy"].back(), 1.5, 1e-13);
  EXPECT_NEAR(t["sxy"].back(), MU * 1.5, 1e-12 * E);
  EXPECT_NEAR(t["sxx"].back() - t["syy"].back(), MU * 1.5 * 1.5, 1e-12 * E);
}

TEST(Point, BiaxialAndTriaxial)
{
  auto t = drive("biaxial 1 strain 0.4 material " + RUBBER);
  const double a = std::exp(0.4);
  const double thick = root_of(0.1, 2.0, [=](double s) {
    return neohookean(s, a * a * s);
  });
  EXPECT_NEAR(t["Fzz"].back(), thick, 1e-12);
  EXPECT_NEAR(t["sxx"].back(), neohookean(a, a * a * thick), 1e-12 * E);
  EXPECT_NEAR(t["syy"].back(), t["sxx"].back(), 1e-12 * E);

  const double P = 4e5;
  t = drive("triaxial -1 4e5 strain 0.5 steps 200 every 200 material " + RUBBER);
  ASSERT_EQ(t["step"].size(), 3);
  EXPECT_EQ(t["step"][0], -100);
  EXPECT_EQ(t["time"][1], 0.0);
  const double start = root_of(0.2, 1.0, [=](double s) {
    return neohookean(s, s * s * s) + P;
  });
  EXPECT_NEAR(t["Fxx"][1], start, 1e-11);
  EXPECT_NEAR(t["sxx"][1], -P, 1e-12 * E);
  EXPECT_NEAR(t["Fxx"][2], start * std::exp(-0.5), 1e-11);
  EXPECT_NEAR(t["sxx"][2], uniaxial(start * std::exp(-0.5), -P)[1], 1e-12 * E);
  EXPECT_NEAR(t["syy"][2], -P, 1e-12 * E);
}

// tension first, then compression, and back to no strain; the plastic strain goes on
TEST(Point, Cycle)
{
  auto t = drive("uniaxial/stress 1 cycle 0.01 2 steps 800 every 100 material density 7800 "
                 "eos linear 160e9 strength j2 80e9 300e6 hardening linear 2e9");
  const double strain[] = {0, 0.01, 0, -0.01, 0, 0.01, 0, -0.01, 0};
  ASSERT_EQ(t["step"].size(), 9);
  EXPECT_NEAR(t["time"].back(), 0.08, 1e-15);
  for (int k = 0; k < 9; k++) {
    EXPECT_NEAR(t["exx"][k], strain[k], 1e-12);
    const double flow = 300e6 + 2e9 * t["eplastic"][k];
    if (k % 4 == 1) EXPECT_NEAR(t["sxx"][k], flow, 1e-12 * flow);
    if (k % 4 == 3) EXPECT_NEAR(t["sxx"][k], -flow, 1e-11 * flow);
    if (k > 0) EXPECT_GT(t["eplastic"][k], t["eplastic"][k - 1]);
  }
}

// the Hugoniot that the equation of state was made from; energy by the jump condition
TEST(Point, Shock)
{
  auto t = drive("shock -1e6 strain 0.3 steps 30 material density 8930 eos shock 3940 1.49 1.96");
  ASSERT_EQ(t["step"].size(), 31);
  EXPECT_NEAR(t["us"][0], 3940, 1e-9);
  for (size_t k = 0; k < 31; k++) {
    EXPECT_NEAR(t["us"][k], 3940 + 1.49 * t["up"][k], 1e-11 * 3940);
    EXPECT_NEAR(t["energy"][k], t["jump"][k], 1e-12 * t["jump"].back());
    EXPECT_NEAR(t["J"][k], std::exp(-0.01 * k), 1e-13);
  }
}

// Gases have other Hugoniots than isentropes: (p + PINF)/(p0 + PINF) = [(G+1) - (G-1) J]/[(G+1) J -
// (G-1)], with the pressure ahead in all jump conditions
TEST(Point, ShockInGas)
{
  struct Gas {
    const char *words;
    double density, gamma, p0, pinf;
  };
  for (const Gas &gas : {Gas{"ideal/gas 1.4 pressure 1e5", 1.2, 1.4, 1e5, 0.0},
                         Gas{"stiffened/gas 4.4 6e8", 1000.0, 4.4, 0.0, 6e8},
                         Gas{"stiffened/gas 4.4 6e8 pressure 1e8", 1000.0, 4.4, 1e8, 6e8}}) {
    SCOPED_TRACE(gas.words);
    auto t = drive(fmt::format("shock -1e6 strain 0.4 steps 20 material density {} eos {}",
                               gas.density, gas.words));
    for (size_t k = 1; k < 21; k++) {
      const double J = std::exp(-0.02 * k), up = gas.gamma + 1.0, down = gas.gamma - 1.0;
      const double p = (gas.p0 + gas.pinf) * (up - down * J) / (up * J - down) - gas.pinf;
      const double us = std::sqrt((p - gas.p0) / (gas.density * (1.0 - J)));
      EXPECT_NEAR(-t["sxx"][k], p, 1e-9 * p) << k;
      EXPECT_NEAR(t["us"][k], us, 1e-9 * us) << k;
      EXPECT_NEAR(t["up"][k], us * (1.0 - J), 1e-9 * us) << k;
      EXPECT_NEAR(t["jump"][k], 0.5 * (p + gas.p0) * (1.0 - J), 1e-9 * t["jump"].back()) << k;
    }
  }
  // that of an ideal gas is its pressure times its volume
  auto t = drive("shock -1e6 strain 1 steps 1 material density 1.2 eos ideal/gas 1.4 pressure 1e5 "
                 "thermal adiabatic 694.444444444444 300");
  const double J = std::exp(-1.0), p = 1e5 * (2.4 - 0.4 * J) / (2.4 * J - 0.4);
  EXPECT_NEAR(t["temperature"][1], 300.0 * p * J / 1e5, 1e-6 * 300.0);
}

// What a shock dissipates warms the solid: its temperature is that of the isentrope, T0 exp(GAMMA0
// (1 - J)), and of the energy between the isentrope and the Hugoniot. A strength sees that.
TEST(Point, ShockWarms)
{
  const double rho = 8930.0, c0 = 3940.0, s = 1.49, gamma = 1.96, cp = 383.0, T0 = 300.0;
  const std::string copper = "density 8930 eos shock 3940 1.49 1.96 ";
  const std::string thermal = "thermal adiabatic 383 300 0.9 gruneisen 1.96";
  auto t = drive("shock -1e6 strain 0.3 steps 10 material " + copper + thermal);
  double energy = 0.0, eta = 0.0;    // of the isentrope, by the rule of Heun
  constexpr int PARTS = 2000;
  const auto hugoniot = [=](double x) {
    return rho * c0 * c0 * x / ((1.0 - s * x) * (1.0 - s * x));
  };
  for (int k = 1; k <= 10; k++) {
    const double step = (1.0 - std::exp(-0.03 * k) - eta) / PARTS;
    for (int m = 0; m < PARTS; m++) {
      const auto pressure = [&](double x, double e) {
        return hugoniot(x) * (1.0 - 0.5 * gamma * x) + gamma * e;
      };
      const double first = pressure(eta, energy);
      energy += 0.5 * step * (first + pressure(eta + step, energy + step * first));
      eta += step;
    }
    const double jump = 0.5 * hugoniot(eta) * eta;
    const double T = T0 * std::exp(gamma * eta) + (jump - energy) / (rho * cp);
    EXPECT_NEAR(t["temperature"][k], T, 1e-3 * (T - T0)) << k;
    EXPECT_NEAR(t["jump"][k], jump, 1e-9 * t["jump"].back()) << k;
  }
  EXPECT_GT(t["temperature"][10], 900.0);
  // Y0 (1 + A p/(1 - eta)^(-1/3) - B (T - 300)) without hardening
  auto hard = drive("shock -1e6 strain 0.2 steps 2 material " + copper +
                    "strength steinberg 47.7e9 0.12e9 0 1 0.64e9 2.83e-11 3.77e-4 " + thermal);
  const double p = hard["pressure"][2], J = hard["J"][2];
  const double Y =
      0.12e9 * (1.0 + 2.83e-11 * p * std::cbrt(J) - 3.77e-4 * (hard["temperature"][2] - 300.0));
  EXPECT_NEAR(hard["vonmises"][2], Y, 0.003 * Y);
  EXPECT_GT(Y, 1.5 * 0.12e9);
}

// An energy that the equation of state has at the start is none of tension, which damage releases
TEST(Point, DamageOfWhatHasEnergyAtTheStart)
{
  const std::string path = "uniaxial/strain 1e2 strain 0.01 steps 2000 length 0.01 material "
                           "density 8930 ",
                    rest = " strength elastic 45e9 damage rankine 4e8 soften energy 1e5";
  for (const char *eos : {"eos linear 132e9", "eos stiffened/gas 4.4 30e9",
                          "eos polynomial 132e9 0 0 1.5 1.5 energy 1e7"}) {
    auto t = drive(path + eos + rest);
    const double most = *std::max_element(t["sxx"].begin(), t["sxx"].end());
    EXPECT_NEAR(most, 4e8, 0.003 * 4e8) << eos;
  }
}

// An elastic energy that is kept as a sum, such as that of Steinberg and Guinan, is no number that
// may have a root where it vanishes
TEST(Point, DamageOfSteinberg)
{
  auto t = drive("mixed time 2e-4 steps 400 clock t xx rate v_rate yy rate 0 zz rate 0 material "
                 "density 8930 eos shock 3940 1.49 1.96 strength steinberg 47.7e9 0.12e9 36 0.45 "
                 "0.64e9 2.83e-11 3.77e-4 damage rankine 1e13 thermal adiabatic 383 300 0.9",
                 "units si\nvariable t internal 0\nvariable rate equal 1000*cos(5e4*v_t)\n");
  for (const double T : t["temperature"]) EXPECT_TRUE(std::isfinite(T));
}

TEST(Point, RotationAndTemperature)
{
  const std::string steel =
      "density 7830 eos linear 172e9 strength johnson/cook 79.6e9 806e6 614e6 "
      "0.168 0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9";
  const std::string path = "uniaxial/stress 1e3 strain 0.2 steps 400 ";
  auto plain = drive(path + "material " + steel);
  auto turned = drive(path + "rotate 1 2 3 2 material " + steel);
  auto hot = drive(path + "temperature 700 material " + steel);
  for (const char *column : {"exx", "eyy", "Fxx", "Fyy", "Fxy"})
    EXPECT_NEAR(turned[column].back(), plain[column].back(), 1e-5);
  EXPECT_NEAR(turned["sxx"].back(), plain["sxx"].back(), 4e-5 * plain["sxx"].back());
  EXPECT_NEAR(turned["sxy"].back(), 0.0, 4e-5 * plain["sxx"].back());
  EXPECT_EQ(plain["temperature"][0], 20.0);
  EXPECT_EQ(hot["temperature"][0], 700.0);
  EXPECT_LT(hot["sxx"].back(), 0.7 * plain["sxx"].back());
}

TEST(Point, FormulasOfTime)
{
  const std::string formulas = "units si\nvariable t internal 0\n"
                               "variable rate equal 40*cos(100*v_t)\n"
                               "variable load equal 2.0e5*sin(100*v_t)\n";
  double old = 0.0;
  for (const int n : {100, 200}) {
    auto t = drive(fmt::format("mixed time 0.01 steps {} clock t xx rate v_rate yy stress v_load "
                               "zz stress 0 material {}",
                               n, RUBBER),
                   formulas);
    EXPECT_NEAR(t["syy"].back(), 2e5 * std::sin(1.0), 1e-13 * E);
    EXPECT_NEAR(t["szz"].back(), 0.0, 1e-12 * E);
    const double error = std::fabs(t["exx"].back() - 0.4 * std::sin(1.0));
    EXPECT_LT(error, 1e-5);
    if (old > 0.0) EXPECT_NEAR(std::log2(old / error), 2.0, 2e-5);
    old = error;
  }
  // a spin: one turn about z
  auto t = drive("mixed time 1 steps 100 spin 0 0 $(2*PI) material " + RUBBER);
  EXPECT_NEAR(t["Fxx"].back(), 1.0, 1e-12);
  EXPECT_NEAR(t["Fxy"][25], -1.0, 1e-12);
}

// density in mass/distance^3: here g/mol/Angstrom^3, velocity in Angstrom/ps, stress in bar
TEST(Point, Units)
{
  auto si = drive("uniaxial/strain -1e9 strain 0.1 material density 2700 eos shock 5350 1.34 2");
  auto metal =
      drive("uniaxial/strain -1e-3 strain 0.1 material density 1.62597815 eos shock 53.5 1.34 2",
            "units metal\n");
  EXPECT_NEAR(metal["sxx"].back() * 1e5, si["sxx"].back(), 4e-7 * std::fabs(si["sxx"].back()));
  EXPECT_NEAR(metal["wavespeed"].back() * 100, si["wavespeed"].back(), 1e-11 * 5350);
  EXPECT_NEAR(metal["energy"].back() * 1e5, si["energy"].back(), 4e-7 * si["energy"].back());
}

// a path that leaves two ranges, one in many steps: one warning each, with the first step; shear
// that leaves the principal stretches 10^15 apart has the strain of the closed form
TEST(Point, StrainOfLargeShear)
{
  for (const std::string path : {"shear 1 strain 100 steps 50", "shear 1 strain 8.2e7 steps 20"}) {
    const auto table =
        drive(path + " material density 1000 eos tait 2e9 7 viscosity newtonian 1e-3");
    for (size_t i = 0; i < table.at("time").size(); i++) {
      const double half = 0.5 * table.at("Fxy")[i], e = std::asinh(half),
                   size = std::sqrt(1.0 + half * half);
      EXPECT_NEAR(table.at("exx")[i], e * half / size, 1e-9 * e) << path << " " << i;
      EXPECT_NEAR(table.at("eyy")[i], -e * half / size, 1e-9 * e);
      EXPECT_NEAR(table.at("exy")[i], e / size, 1e-9 * e);
      EXPECT_NEAR(table.at("ezz")[i], 0.0, 1e-9 * (1.0 + e));
    }
  }
}

// the Lode parameter of stress whose cube is no number
TEST(Point, LodeParameterOfAnySize)
{
  for (const std::string modulus : {"1e-110", "1e110"}) {
    const auto table = drive("uniaxial/strain 1 time 0.1 steps 5 material density 1000 linear " +
                             modulus + " 0.3");
    for (size_t i = 1; i < table.at("lode").size(); i++)
      EXPECT_NEAR(table.at("lode")[i], 1.0, 1e-12) << modulus;
  }
}

TEST(Point, LeavingARangeWarnsOnce)
{
  const std::string material = " material density 1000 eos linear 1e9 strength elastic 1e8 "
                               "range density 950 1020 range pressure -1e12 3.05e7";
  const auto warnings = [&](const std::string &path) {
    return MPM_TEST::lines_that_say("units si\nmpm_point NULL " + path + material + "\n",
                                    "out of the range");
  };
  EXPECT_EQ(warnings("uniaxial/strain -1 strain 0.01 steps 100").size(), 0);
  // true strain 0.001 a step: density above 1020 from step 20, K (1/J - 1) above 30.5 MPa from 31
  const auto found = warnings("uniaxial/strain -1 strain 0.05 steps 50");
  ASSERT_EQ(found.size(), 2);
  EXPECT_NE(found[0].find("density 1020.2 at step 20"), std::string::npos) << found[0];
  EXPECT_NE(found[1].find("pressure"), std::string::npos) << found[1];
  EXPECT_NE(found[1].find("at step 31 "), std::string::npos) << found[1];
}

// Behind a shock in a body that bears the stress of another temperature than T0: its speed begins
// with that of waves ahead, and rises; its heat is positive
TEST(Point, ShockInABodyUnderThermalStress)
{
  const std::string thermal = " thermal adiabatic 1000 300 expansion 1e-4";
  for (const std::string law : {"hencky 1e6 0.3", "eos linear 1e6 strength elastic 1e5"})
    for (const double T : {300.0, 400.0}) {
      auto t = drive("shock -1e3 strain 0.02 steps 5 temperature " + MPM_TEST::strprintf("%g", T) +
                     " material density 1000 " + law + thermal);
      EXPECT_EQ(t["time"][0], 0.0);
      EXPECT_EQ(t["sxx"][0]<-1e4, T> 300.0) << law;
      for (int k = 1; k <= 5; k++) {
        EXPECT_GT(t["us"][k], t["us"][k - 1]) << law << " " << T << " " << k;
        EXPECT_GT(t["temperature"][k], T - 1e-3) << law << " " << k;
      }
      EXPECT_NEAR(t["us"][1], t["wavespeed"][0], 0.005 * t["us"][1]) << law << " " << T;
    }
}

TEST(Point, ErrorsNameTheRemedy)
{
  const std::string rubber = " material " + RUBBER;
  const MPM_TEST::Mistake cases[] = {
      {"mpm_point", "Illegal mpm_point command: missing argument"},
      {"mpm_point NULL tension 1 time 1" + rubber,
       "Unknown mpm_point path tension: must be one of uniaxial/stress uniaxial/strain shear"},
      {"mpm_point NULL shear", "missing argument(s), needs rate"},
      {"mpm_point NULL shear 0 time 1" + rubber, "rate that is different from zero"},
      {"mpm_point NULL shock 1 time 1" + rubber, "Mpm_point shock rate must be below 0: 1"},
      {"mpm_point NULL shear x time 1" + rubber, "Expected floating point"},
      {"mpm_point NULL triaxial 1 -5 time 1" + rubber, "confining pressure must not be negative"},
      {"mpm_point NULL shear 1" + rubber, "needs one of the keywords time, strain and cycle"},
      {"mpm_point NULL shear 1 time 1 strain 1" + rubber, "needs only one of the keywords"},
      {"mpm_point NULL mixed strain 1" + rubber, "mixed has no strain of its own"},
      {"mpm_point NULL shear 1 time 0" + rubber, "Mpm_point time must be positive"},
      {"mpm_point NULL shear 1 time 1 steps 0" + rubber, "Mpm_point steps must be positive"},
      {"mpm_point NULL shear 1 time 1 speed 3" + rubber, "Unknown mpm_point keyword: speed"},
      {"mpm_point NULL shear 1 time 1", "end the command with 'material density"},
      {"mpm_point NULL shear 1 time 1 xx" + rubber,
       "Unknown mpm_point xx material: must be one of rate stress"},
      {"mpm_point NULL shear 1 time 1 xx force 1" + rubber,
       "Unknown mpm_point xx force: must be one of rate stress"},
      {"mpm_point NULL shear 1 time 1 xx rate 1 xx stress 1" + rubber, "xx is given twice"},
      {"mpm_point NULL shear 1 time 1 xx rate v_no" + rubber, "Variable no for mpm_point does not"},
      {"mpm_point NULL shear 1 time 1 xx rate v_atomic" + rubber, "is not equal-style"},
      {"mpm_point NULL shear 1 time 1 clock t" + rubber, "'variable t internal 0'"},
      {"mpm_point NULL shear 1 time 1 rotate 0 0 0 1" + rubber, "needs an axis that is not zero"},
      {"mpm_point NULL shear 1 time 1 temperature 300" + rubber, "add 'thermal adiabatic'"},
      {"mpm_point NULL shock -1 strain 0.1 cycle 1 1" + rubber, "needs only one of"},
      {"mpm_point NULL shock -1 strain 0.1 rotate 0 0 1 1" + rubber, "cycle and rotate do not go"},
      {"mpm_point NULL shock -1 strain 0.1 yy stress 0" + rubber, "use uniaxial/strain"},
      {"mpm_point NULL uniaxial/strain -1 strain 0.1 temperature 2000 material density 1 eos "
       "linear "
       "9 strength elastic 3 thermal adiabatic 1 300 0.9 melt 1000 200",
       "give T0 of its thermal part instead"},
      {"mpm_point NULL shear 1 time 1 material", "density is missing"},
      {"mpm_point NULL shear 1 time 1 material density 1 linear 1e6 0.6",
       "Mpm_point: linear: NU = 0.6 (Poisson's ratio) is out of range"},
      {"mpm_point NULL shear 1 time 1 material file nowhere.mpm", "cannot read file nowhere.mpm"},
      {"mpm_point no/such/folder/table shear 1 time 1" + rubber, "Cannot write table no/such"},
      {"mpm_point NULL mixed time 1 xx stress 1e9 yy stress 0 zz stress 0 material density 7800 "
       "eos linear 160e9 strength j2 80e9 300e6",
       "no motion gives the prescribed stress"},
      {"mpm_point NULL shear 1e160 time 1 steps 10" + rubber, "the motion is not finite"},
      {"mpm_point NULL mixed time 1 spin 0 0 1e200" + rubber, "the motion is not finite"},
      {"mpm_point NULL mixed time 1 xx stress 0 yy rate 1e160" + rubber,
       "the motion is not finite"},
      {"variable big equal 1e308*10\nmpm_point NULL shear 1 time 1 zz rate v_big" + rubber,
       "Variable big is inf"},
      {"mpm_point NULL shear 1 time 1 length 1e-300 material density 1000 eos tait 2e9 7 "
       "viscosity newtonian 1e-3",
       "wavespeed is not finite"},
      {"mpm_point NULL shear 1 time 1" + rubber + " random E normal 5 1 7", "Mpm_point: random"},
  };
  for (const auto &c : cases) {
    if (MPM_TEST::nranks() > 1 && c.lines.find("no/such") != std::string::npos)
      continue;    // rank 0
    MPM_TEST::expect_refused("units si\nvariable atomic atom id\n", {c});
  }
}

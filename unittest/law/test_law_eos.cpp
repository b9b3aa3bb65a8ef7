// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// Equations of state, point by point: shock states, isentropes, detonation, tension, energy.

#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

// behind a shock of particle speed u: P = density U u, J = 1 - u/U, E = density u^2/2
TEST(Shock, SymmetricImpactStates)
{
  // density, c0, s, Gamma, speed of impact, P (GPa), density ratio: symmetric impact, u = V/2;
  // LASL and common Hugoniot data, evaluated with U = c0 + s u
  const double table[][7] = {{2703, 5350, 1.34, 2, 7000, 94.98342, 1.5351682},
                             {2707, 5392, 1.341, 2.25, 7000, 95.5550698, 1.53147066},
                             {8930, 3940, 1.489, 1.99, 7000, 286.030132, 1.61930461},
                             {11350, 2092, 1.45, 2, 6580, 256.256044, 1.92092372},
                             {7850, 3574, 1.92, 1.69, 7000, 282.82765, 1.51516044}};
  for (const auto &m : table) {
    const auto material = make(joined("density ", m[0], " eos shock ", m[1], " ", m[2], " ", m[3]));
    for (const double u : {10.0, 300.0, 1000.0, 0.5 * m[4]}) {
      const double U = m[1] + m[2] * u;
      MaterialPoint p(*material);
      compress(p, 1.0 - u / U, 1);
      EXPECT_NEAR(p.pressure(), m[0] * U * u, 1e-11 * p.pressure());
      EXPECT_NEAR(p.history(0) / m[0], 0.5 * u * u, 1e-11 * u * u);
      EXPECT_NEAR(p.power, p.history(0), 1e-10 * p.power);
      if (u < 0.5 * m[4]) continue;
      EXPECT_NEAR(p.pressure() / GPa, m[5], 2e-8 * m[5]);
      EXPECT_NEAR(1.0 / p.batch.J[0], m[6], 1e-8 * m[6]);
    }
  }
}

// slow compression: the isentrope, integrated independently, below the Hugoniot; second order
TEST(Shock, Isentrope)
{
  const double rho = 8930, c0 = 3940, s = 1.489, g = 1.99, K = rho * c0 * c0;
  const auto slope = [&](double t, const State &E) {    // p where J = 1 - t
    return State{K * t / ((1 - s * t) * (1 - s * t)) * (1 - 0.5 * g * t) + g * E[0]};
  };
  const double E = runge_kutta(slope, {0.0}, 0.3, 10000)[0];
  const auto material = make("density 8930 eos shock 3940 1.489 1.99");
  MaterialPoint hugoniot(*material);
  compress(hugoniot, 0.7, 1);
  const auto error = refined(50, [&](int n) {
    MaterialPoint p(*material);
    compress(p, 0.7, n);
    EXPECT_LT(p.pressure(), 0.99 * hugoniot.pressure());
    return p.history(0) / E - 1;
  });
  EXPECT_LT(std::fabs(error[2]), 2e-5);
  expect_order(error, 2.0, 0.02);

  // and back: the body returns all of the work
  MaterialPoint p(*material);
  compress(p, 0.7, 4000);
  EXPECT_NEAR(p.stored_energy(), p.power, 1e-11 * p.power);
  compress(p, 1.0, 4000);
  EXPECT_NEAR(p.pressure(), 0.0, 1e-12 * hugoniot.pressure());
  EXPECT_NEAR(p.stored_energy(), 0.0, 1e-11 * hugoniot.stored_energy());
}

TEST(Shock, CutoffHoldsThePressureAndDoesItsWork)
{
  const double pmin = -1e9;
  Point p("density 8930 eos shock 3940 1.489 1.99 cutoff -1e9");
  compress(p, 1.1, 1000);
  EXPECT_DOUBLE_EQ(p.pressure(), pmin);
  const double open = p.history(0);
  EXPECT_NEAR(open, p.power, 1e-12 * p.power);
  // pmin * (volume opened at pmin) and the elastic part
  const double K = 8930.0 * 3940 * 3940, Jc = 1.0 / (1.0 - 1e9 / K);
  EXPECT_NEAR(open, 1e9 * (1.1 - Jc) + 1e9 * (Jc - 1) / 2, 3e-4 * open);
  compress(p, 1.0, 1000);
  EXPECT_NEAR(p.history(0), 0.0, 1e-12 * open);
  EXPECT_NEAR(p.history(0), p.power, 1e-12 * open);
  EXPECT_GT(p.wave_speed(), 3900.0);
}

TEST(Shock, SpallBreaksOnceAndForAll)
{
  const auto material = make("density 8930 eos shock 3940 1.489 1.99 spall -1e9");
  ASSERT_EQ(material->history().size(), 3u);
  MaterialPoint p(*material);
  compress(p, 1.005, 100);
  EXPECT_LT(p.pressure(), -0.6e9);
  EXPECT_EQ(p.history(2), 0.0);
  compress(p, 1.02, 300);
  EXPECT_EQ(p.history(2), 1.0);
  EXPECT_DOUBLE_EQ(p.pressure(), 0.0);
  EXPECT_NEAR(p.history(0), p.power, 1e-11 * p.power);
  EXPECT_GT(p.wave_speed(), 3900.0);    // ready to close
  // closes without tension, and bears pressure again; the elastic energy has become heat
  compress(p, 1.003, 300);
  EXPECT_DOUBLE_EQ(p.pressure(), 0.0);
  compress(p, 0.99, 1000);
  EXPECT_GT(p.pressure(), 1.3e9);
  EXPECT_NEAR(p.history(0), p.power, 1e-11 * p.power);
  compress(p, 1.005, 1000);
  EXPECT_DOUBLE_EQ(p.pressure(), 0.0);
}

/* ---------------------------------------------------------------------- gases */

// A8: V2/V1 = 1/2, also in one step
TEST(IdealGas, AdiabaticCompression)
{
  const auto material = make("density 1.2 eos ideal/gas 1.4 pressure 1e5");
  for (const int n : {1, 1000}) {
    MaterialPoint p(*material);
    for (int k = 0; k < 3; k++) EXPECT_DOUBLE_EQ(p.stress(k), -1e5);
    EXPECT_NEAR(p.wave_speed(), std::sqrt(1.4 * 1e5 / 1.2), 1e-10);
    const double start = p.stored_energy();
    EXPECT_NEAR(start, 2.5e5, 1e-9);
    compress(p, 0.5, n);
    EXPECT_NEAR(p.pressure() / 1e5, 2.639016, 1e-6);
    EXPECT_NEAR(p.pressure() / 1e5 * 0.5, 1.319508, 1e-6);    // temperature ratio
    EXPECT_NEAR((p.stored_energy() - start) / 1e5, 0.798770, 1e-6);
    EXPECT_NEAR(p.wave_speed(), std::sqrt(1.4 * p.pressure() * 0.5 / 1.2), 1e-10);
    if (n > 1) EXPECT_NEAR(p.power / 1e5, 0.798770, 1e-6);
  }
}

TEST(IdealGas, InitialStateByEnergy)
{
  Point p("density 1.2 eos ideal/gas 1.4 pressure 1e5"),
      q(joined("density 1.2 eos ideal/gas 1.4 energy ", 1e5 / 0.4 / 1.2));
  EXPECT_NEAR(p.history(0), q.history(0), 1e-10 * p.history(0));
  EXPECT_NEAR(q.pressure(), 1e5, 1e-7);
}

TEST(IdealGas, ExpandsAsFarAsItIsAsked)
{
  Point p("density 1.2 eos ideal/gas 1.4 pressure 1e5");
  const double J = 50.0;
  compress(p, J, 1);
  EXPECT_NEAR(p.pressure(), 1e5 * std::pow(J, -1.4), 1e-9);
  compress(p, 0.02, 1);
  EXPECT_NEAR(p.pressure() / 1e5, std::pow(0.02, -1.4), 1e-9);
  compress(p, 1.0, 1);
  EXPECT_NEAR(p.pressure(), 1e5, 1e-6);
}

// heat of a viscosity, against the energy equation d(E) = -(p + q) dJ integrated independently
TEST(IdealGas, ViscousHeatIsKept)
{
  const double cq = 1.5, gamma = 1.4, rho = 1.2, h = 0.1, T = 1e-3;
  const auto material =
      make("density 1.2 eos ideal/gas 1.4 pressure 1e5 viscosity artificial 1.5 0");
  const auto J = [&](double t) {
    return 1 - 0.5 * t / T;
  };
  const double rate = 0.5 / T;
  const auto slope = [&](double t, const State &E) {
    const double q = rho / J(t) * cq * h * h * std::pow(rate / J(t), 2);
    return State{((gamma - 1) * E[0] / J(t) + q) * rate};
  };
  const double E = runge_kutta(slope, {1e5 / (gamma - 1)}, T, 20000)[0];
  const auto error = refined<2>(100, [&](int n) {
    MaterialPoint p(*material, 1, h);
    for (int i = 1; i <= n; i++) move_to(p, uniaxial_stretch(J(T * i / n)), T / n);
    EXPECT_GT(p.work[VISCOUS], 1e3);
    EXPECT_NEAR(p.history(1), p.work[VISCOUS], 1e-10 * p.work[VISCOUS]);
    return p.history(0) / E - 1;
  });
  EXPECT_LT(std::fabs(error[1]), 1e-6);
  expect_order(error, 2.0, 0.05);
}

TEST(StiffenedGas, IsentropeAndSoundSpeed)
{
  const double gamma = 4.4, pinf = 6e8, p0 = 1e5, rho = 1000;
  const auto material = make("density 1000 eos stiffened/gas 4.4 6e8 pressure 1e5");
  for (const double J : {0.5, 0.9, 0.999, 1.001, 1.1, 3.0})
    for (const int n : {1, 10}) {
      MaterialPoint p(*material);
      EXPECT_NEAR(p.pressure(), p0, 1e-6);
      EXPECT_NEAR(p.wave_speed(), std::sqrt(gamma * (p0 + pinf) / rho), 1e-9);
      const double start = p.stored_energy();
      compress(p, J, n);
      const double whole = (p0 + pinf) * std::pow(J, -gamma);
      EXPECT_NEAR(p.pressure(), whole - pinf, 1e-12 * (whole + pinf));
      EXPECT_NEAR(p.wave_speed(), std::sqrt(gamma * whole * J / rho), 1e-9);
      const double work = (p0 + pinf) / (gamma - 1) * (std::pow(J, 1 - gamma) - 1) + pinf * (J - 1);
      EXPECT_NEAR(p.stored_energy() - start, work, 1e-12 * (std::fabs(start) + work));
    }
}

// the pressure is that of the formula down to the limit, and the limit beyond
TEST(Tait, CavitatesAtTheLimit)
{
  const double K = 2e9, gamma = 7, limit = -1e6;
  const auto material = make("density 1000 eos tait 2e9 7 cutoff -1e6");
  MaterialPoint p(*material);
  for (const double share : {0.5, 0.99, 1.01, 1.5, 3.0}) {
    const double J = std::pow(1 + gamma * share * limit / K, -1 / gamma);
    move_to(p, isotropic(std::cbrt(J)));
    EXPECT_NEAR(p.pressure(), std::max(share * limit, limit), 1e-10 * std::fabs(limit)) << share;
  }
}

TEST(StiffenedGas, Cavitates)
{
  const auto material = make("density 1000 eos stiffened/gas 4.4 6e8 pressure 1e5 cutoff -1e6");
  MaterialPoint p(*material);
  const double start = p.stored_energy();
  compress(p, 1.2, 2000);
  EXPECT_DOUBLE_EQ(p.pressure(), -1e6);
  EXPECT_NEAR(p.stored_energy() - start, 1e6 * 0.2, 2e-3 * 1e6);
  EXPECT_NEAR(p.stored_energy() - start, p.power, 2e-7 * p.power);
  EXPECT_NEAR(p.wave_speed(), std::sqrt(4.4 * (6e8 - 1e6) * 1.2 / 1000), 1e-8);
  compress(p, 1.0, 2000);
  EXPECT_NEAR(p.pressure(), 1e5, 200.0);
  // in one large step the mean of both pressures does the work
  MaterialPoint once(*material);
  compress(once, 1.2, 1);
  EXPECT_NEAR(once.stored_energy() - start, 0.5 * (1e6 - 1e5) * 0.2, 1e-7);
}

TEST(Polynomial, PressureIsTheFormula)
{
  const double A1 = 7e10, A2 = 8e10, A3 = 5e10, B0 = 2, B1 = 1.5, T1 = 6e10, T2 = 1e10, E0 = 1e9;
  const auto material =
      make("density 2700 eos polynomial 7e10 8e10 5e10 2 1.5 6e10 1e10 energy 1e9");
  MaterialPoint start(*material);
  EXPECT_NEAR(start.pressure(), B0 * E0, 1e-3);
  for (const double J : {0.6, 0.9, 1.02, 1.3}) {
    MaterialPoint p(*material);
    compress(p, J, 100);
    const double mu = 1 / J - 1, E = p.history(0);
    const double expected = mu > 0 ? A1 * mu + A2 * mu * mu + A3 * mu * mu * mu + (B0 + B1 * mu) * E
                                   : T1 * mu + T2 * mu * mu + B0 * E;
    EXPECT_NEAR(p.pressure(), expected, 1e-10 * std::fabs(expected));
    EXPECT_NEAR(p.stored_energy() - E0, p.power, 1e-10 * std::fabs(p.power));
  }
  // T1 is A1 when it is not given
  Point p("density 2700 eos polynomial 7e10 8e10 5e10 0 0");
  compress(p, 1.1, 1);
  EXPECT_NEAR(p.pressure(), A1 * (1 / 1.1 - 1), 1e-3);
}

TEST(Polynomial, CutoffAndSpall)
{
  Point p("density 2700 eos polynomial 7e10 8e10 5e10 2 1.5 cutoff -1e9"),
      q("density 2700 eos polynomial 7e10 8e10 5e10 2 1.5 spall -1e9");
  compress(p, 1.1, 100);
  compress(q, 1.1, 100);
  EXPECT_DOUBLE_EQ(p.pressure(), -1e9);
  EXPECT_DOUBLE_EQ(q.pressure(), 0.0);
  EXPECT_EQ(q.history(2), 1.0);
}

// TNT (B.M. Dobratz, P.C. Crawford, LLNL Explosives Handbook, UCRL-52997, 1985)
const double A = 371.2e9, B = 3.231e9, R1 = 4.15, R2 = 0.95, OMEGA = 0.30, E0 = 7.0e9, D = 6930,
             RHO = 1630;
const char *const TNT = "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930";

TEST(JWL, IsentropeOfTheProducts)
{
  const auto material = make(TNT);
  // all burnt at the reference volume: C of the isentrope A e^-R1V + B e^-R2V + C V^-(1+OMEGA)
  const double C = OMEGA * (E0 - A / R1 * std::exp(-R1) - B / R2 * std::exp(-R2));
  const auto isentrope = [&](double V) {
    return A * std::exp(-R1 * V) + B * std::exp(-R2 * V) + C * std::pow(V, -1 - OMEGA);
  };
  const auto error = refined<2>(200, [&](int n) {
    MaterialPoint p(*material);
    EXPECT_NEAR(p.pressure(), isentrope(1.0), 1e-3);
    compress(p, 0.5, n);
    compress(p, 8.0, 10 * n);
    EXPECT_NEAR(p.stored_energy() - E0, p.power, 1e-12 * E0);
    return p.pressure() / isentrope(8.0) - 1;
  });
  EXPECT_LT(std::fabs(error[1]), 5e-5);
  expect_order(error, 2.0, 0.1);
}

// a point that burns while the front squeezes it lands on the Hugoniot of the products, which the
// Rayleigh line touches in the Chapman-Jouguet state; explosives in potentials/
TEST(JWL, ChapmanJouguetState)
{
  struct {
    const char *name, *text;
    double rho, D, pcj;
  } explosives[] = {
      {"TNT", "371.2e9 3.231e9 4.15 0.95 0.30 7.0e9 6930", 1630, 6930, 21.0e9},
      {"Composition B", "524.23e9 7.678e9 4.2 1.1 0.34 8.5e9 7980", 1717, 7980, 29.5e9},
      {"PBX-9404", "852.4e9 18.02e9 4.6 1.3 0.38 10.2e9 8800", 1840, 8800, 37.0e9},
      {"C-4", "609.77e9 12.95e9 4.5 1.4 0.25 9.0e9 8193", 1601, 8193, 28.0e9}};
  for (const auto &x : explosives) {
    SCOPED_TRACE(x.name);
    const auto material =
        make(joined("density ", x.rho, " eos jwl ", x.text, " width 1 detonate 0 0 0 0"));
    double least = 1e300, at = 0.0, pcj = 0.0;    // smallest slope of a line to the Hugoniot
    for (double J = 0.70; J < 0.78; J += 1e-4) {
      MaterialPoint p(*material);
      move_to(p, uniaxial_stretch(J), 1.0);    // time 1 s: burns at once
      EXPECT_EQ(p.history(2), 1.0);
      const double slope = p.pressure() / (1 - J);
      if (slope >= least) continue;
      least = slope;
      at = J;
      pcj = p.pressure();
    }
    EXPECT_NEAR(std::sqrt(least / x.rho), x.D, 2e-4 * x.D);
    EXPECT_NEAR(pcj, x.pcj, 5e-4 * x.pcj);
    // there the wave moves with D in the lattice of the reference state: c/J = D
    MaterialPoint p(*material);
    move_to(p, uniaxial_stretch(at), 1.0);
    EXPECT_NEAR(p.wave_speed() / at, x.D, 1e-3 * x.D);
  }
}

TEST(JWL, BurnsOnTime)
{
  const double h = 1e-3, width = 3;
  Point p(std::string(TNT) + " detonate 0.0693 0 0 0 detonate 0 0.0693 0.0 -2e-6", 1,
          h);    // at the origin: 10 us from the first, 8 us from the second
  EXPECT_NEAR(p.history(3), 8e-6, 1e-15);
  EXPECT_EQ(p.pressure(), 0.0);
  EXPECT_NEAR(p.wave_speed(), D, 1e-12 * D);
  const double dt = 1e-8;
  const auto burnt = make(TNT);
  const double whole = MaterialPoint(*burnt).pressure();
  double largest = 0.0;
  for (int i = 1; i <= 1000; i++) {
    move_to(p, IDENTITY, dt);
    const double f = std::min(std::max((i * dt - 8e-6) * D / (width * h), 0.0), 1.0);
    EXPECT_NEAR(p.history(2), f, 1e-11);
    EXPECT_NEAR(p.pressure(), f * whole, 1e-11 * whole);
    largest = std::max(largest, p.pressure());
    EXPECT_DOUBLE_EQ(p.stored_energy(), E0);    // nothing gained or lost at constant volume
  }
  EXPECT_NEAR(largest, whole, 1e-12 * whole);
}

TEST(JWL, EnergyIsReleasedOnce)
{
  Point p(std::string(TNT) + " detonate 0 0 0 0", 1, 1e-3);
  // burns while it is squeezed, then expands by 1000: all of E0 has become work
  compress(p, 0.75, 200, 5e-7 / 200);
  EXPECT_EQ(p.history(2), 1.0);
  EXPECT_NEAR(p.stored_energy() - E0, p.power, 1e-12 * E0);
  double stretch = 0.75;
  for (int i = 0; i < 4000; i++) {
    stretch *= std::pow(1000.0 / 0.75, 1.0 / 4000);
    move_to(p, uniaxial_stretch(stretch), 1e-9);
  }
  EXPECT_NEAR(p.stored_energy() - E0, p.power, 1e-11 * E0);
  EXPECT_GT(p.stored_energy(), 0.0);
  EXPECT_LT(p.stored_energy(), 0.15 * E0);
}

/* ---------------------------------------------------------------------- all of them */

const char *const all[] = {"density 8930 eos shock 3940 1.489 1.99",
                           "density 2700 eos polynomial 7e10 8e10 5e10 2 1.5 6e10 1e10 energy 1e9",
                           "density 1.2 eos ideal/gas 1.4 pressure 1e5",
                           "density 1000 eos stiffened/gas 4.4 6e8 pressure 1e5",
                           "density 1630 eos jwl 371.2e9 3.231e9 4.15 0.95 0.3 7.0e9 6930",
                           "density 1000 eos tait 2.2e9 7",
                           "density 1000 eos linear 2.2e9"};

// density_0 c^2 = -J^2 dp/dJ along the isentrope
TEST(EveryEos, WaveSpeedIsTheSlopeOfTheIsentrope)
{
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    for (const double J : {0.5, 0.7, 0.95, 1.05, 1.15}) {
      MaterialPoint p(*material);
      compress(p, J, 300);
      MaterialPoint less(p), more(p);
      const double d = 1e-5 * J;
      compress(less, J - d, 1);
      compress(more, J + d, 1);
      const double slope = -J * J * (more.pressure() - less.pressure()) / (2 * d);
      EXPECT_NEAR(p.wave_speed(), std::sqrt(slope / material->density()), 5e-9 * p.wave_speed())
          << "J " << J;
    }
  }
}

// the work of the pressure is in the energy, and closed cycles give nothing
TEST(EveryEos, EnergyIsTheWorkOfThePressure)
{
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    double cycle[2], work[2];
    for (int level = 0; level < 2; level++) {
      MaterialPoint p(*material);
      const double start = p.stored_energy();
      const int n = 500 << level;
      double largest = 0.0, error = 0.0;
      for (int i = 1; i <= n; i++) {
        const double a = 2 * M_PI * i / n;
        move_to(p, {1 + 0.2 * std::sin(a), 0.3 * std::sin(a), 0, 0, 1, 0, 0, 0, 1});
        largest = std::max(largest, std::fabs(p.stored_energy() - start));
        error = std::max(error, std::fabs(p.stored_energy() - start - p.power));
      }
      cycle[level] = std::fabs(p.stored_energy() - start) / largest;
      work[level] = error / largest;
    }
    EXPECT_LT(work[1], 1e-4);
    EXPECT_LT(work[1], 0.3 * work[0] + 1e-12);
    EXPECT_LT(cycle[1], 1e-12);
    EXPECT_LT(cycle[1], 0.3 * cycle[0] + 1e-12);
  }
}

TEST(EveryEos, FiniteInHugeSteps)
{
  for (const char *text : all)
    for (const char *more : {"", " viscosity artificial 1.5 0.06"}) {
      const auto material = make(std::string(text) + more);
      for (const double J : {0.2, 0.5, 0.9, 1.1, 2.0, 50.0})
        for (const double next : {0.2, 0.5, 1.0, 2.0, 50.0})
          for (const double dt : {1e-8, 1.0}) {
            MaterialPoint p(*material, 1, 1e-3);
            compress(p, J, 1, dt);
            compress(p, next, 1, dt);
            SCOPED_TRACE(joined(text, more, " J ", J, " then ", next));
            expect_finite(p);
          }
    }
}

TEST(Definition, BadInputIsRefused)
{
  expect_refused(
      {{"density 1 eos shock 1 1 1 cutoff -1 spall -1", "exclude each other", 3},
       {"density 1 eos shock 1 1 1 cutoff 1", "VALUE <= 0", 8},
       {"density 1 eos polynomial 1 0 0 0 0 cutoff -1 spall -1", "exclude each other", 3},
       {"density 1 eos polynomial 1 0 0 0 0 1", "T2 is missing", 10},
       {"density 1 eos ideal/gas 1 pressure 1", "GAMMA = 1", 4},
       {"density 1 eos ideal/gas 1.4", "give the initial state", 3},
       {"density 1 eos ideal/gas 1.4 pressure 1 energy 1", "give the initial state", 3},
       {"density 1 eos ideal/gas 1.4 pressure 0", "out of range", 6},
       {"density 1 eos stiffened/gas 4 1 cutoff -2", "never reached", 3},
       {"density 1 eos jwl 1 1 1 1 1 1", "D is missing", 10},
       {"density 1 eos jwl 1 1 1 1 1 1 1 detonate 0 0 0", "T is missing", 15}});
}

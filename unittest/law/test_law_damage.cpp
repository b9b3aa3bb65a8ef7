// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit physics

// Damage at a single point: failure strains and stresses against closed forms, energy balance.

#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

double mean(const MaterialPoint &p)
{
  return -p.pressure();
}

double accounted(const MaterialPoint &p)
{
  return p.stored_energy() + p.work[PLASTIC] + p.work[VISCOUS] + p.work[FRACTURE];
}

/** Pure shear by an equivalent strain e in one step: keeps the volume. */
void shear(MaterialPoint &p, double e, double dt = 1.0)
{
  const double g = 0.5 * std::sqrt(3.0) * e / dt;
  steps(p, {0, g, 0, g, 0, 0, 0, 0, 0}, dt);
}

const double SIGMAY = 490e6, BULK = 170e9;
const std::string STEEL = "density 7850 eos linear 170e9 strength j2 77e9 490e6 ";

double failure_strain(double triaxiality)    // Weldox 460 E, benchmark E1(e)
{
  return 0.636 + 1.936 * std::exp(-2.969 * triaxiality);
}

/** Changes the volume so that the mean stress is this times the yield stress. */
void set_triaxiality(MaterialPoint &p, double triaxiality)
{
  const double J = 1.0 / (1.0 - triaxiality * SIGMAY / BULK);
  moves(p, isotropic(std::cbrt(J / p.batch.J[0]) - 1.0), 1.0);
}

TEST(JohnsonCookDamage, FailureStrainAtConstantTriaxiality)
{
  const auto material = make(STEEL + "damage johnson/cook 0.636 1.936 -2.969");
  struct {
    double triaxiality, strain;
  } known[] = {{1.0 / 3.0, 1.355612}, {0.0, 2.572}, {1.0, 0.735423}, {-1.0 / 3.0, 5.8447}};
  for (const auto &k : known) {
    EXPECT_NEAR(failure_strain(k.triaxiality), k.strain, 1e-4 * k.strain);
    const double wanted = failure_strain(k.triaxiality);
    MaterialPoint p(*material);
    set_triaxiality(p, k.triaxiality);
    int steps = 0;
    while (value(p, "damage") < 1.0 && steps++ < 2000) {
      const double before = value(p, "eplastic");
      shear(p, 0.005);
      const double e = value(p, "eplastic");
      if (value(p, "damage") < 1.0) {
        EXPECT_NEAR(value(p, "used"), e / wanted, 1e-9);
        EXPECT_NEAR(p.vonmises(), SIGMAY, 1e-12 * SIGMAY);
        if (k.triaxiality != 0.0) EXPECT_NEAR(mean(p) / SIGMAY / k.triaxiality, 1.0, 1e-7);
      } else {
        EXPECT_LT(before, wanted * (1 + 1e-8));
        EXPECT_GE(e, wanted * (1 - 1e-8));
        EXPECT_EQ(p.vonmises(), 0.0);
        EXPECT_NEAR(p.pressure(), k.triaxiality < 0.0 ? -k.triaxiality * SIGMAY : 0.0,
                    3e-8 * SIGMAY);
      }
    }
    EXPECT_LT(steps, 2000);
  }
}

// damage adds up along a path, and compression neither heals nor resets it
TEST(JohnsonCookDamage, TriaxialityPaths)
{
  Point p(STEEL + "damage johnson/cook 0.636 1.936 -2.969");
  double expected = 0.0, before = 0.0, e = 0.0;
  for (const double triaxiality : {0.3, -30.0, 1.2, -3.0, -300.0, 0.0, 2.5, 1e-6, -1.0}) {
    SCOPED_TRACE(triaxiality);
    set_triaxiality(p, triaxiality);
    for (int i = 0; i < 10; i++) {
      const double ratio = mean(p) / SIGMAY;
      shear(p, 0.005);
      EXPECT_NEAR(ratio, triaxiality, 1e-8 * (1 + std::fabs(triaxiality)));
      expected += (value(p, "eplastic") - e) / failure_strain(std::min(triaxiality, 1.5));
      EXPECT_NEAR(value(p, "used"), expected, 1e-12);
      EXPECT_GE(value(p, "used"), before);
      before = value(p, "used");
      e = value(p, "eplastic");
    }
  }
  EXPECT_GT(expected, 0.05);
  EXPECT_EQ(value(p, "damage"), 0.0);
}

TEST(JohnsonCookDamage, RateAndTemperature)
{
  for (const double T : {200.0, 293.0, 600.0, 1500.0, 3000.0})
    for (const double rate : {1e-6, 0.5, 10.0, 1e4, 1e8}) {
      Point p(
          joined(STEEL, "thermal constant ", T,
                 " damage johnson/cook 0.05 3.44 -2.12 rate 0.002 0.5 temperature 0.61 1793 293"));
      const double yield = SIGMAY / (3 * 77e9);
      shear(p, 0.01 + yield, 0.01 / rate);
      const double e = value(p, "eplastic");
      EXPECT_NEAR(e, 0.01, 1e-13);
      const double fast = 1 + 0.002 * std::log(std::max(e / 0.01 * rate / 0.5, 1.0));
      const double hot = 1 + 0.61 * std::min(std::max((T - 293) / 1500, 0.0), 1.0);
      EXPECT_NEAR(value(p, "used"), e / (3.49 * fast * hot), 1e-12 * e);
    }
  EXPECT_THROW(make(STEEL + "damage johnson/cook 1 1 -1 temperature 0.6 1793 293"), MaterialError);
}

// Armco iron: D1 < 0, the formula gives a negative strain at high triaxiality
TEST(JohnsonCookDamage, NegativeFailureStrain)
{
  for (const char *option : {"", "minimum 0.02"}) {
    Point p(STEEL + "damage johnson/cook -2.2 3 -1 " + option);
    set_triaxiality(p, 1.4);    // e_f = -1.46
    shear(p, 1.1 * SIGMAY / (3 * 77e9));
    const double e = value(p, "eplastic");
    ASSERT_GT(e, 1e-5);
    EXPECT_NEAR(value(p, "used"), *option ? e / 0.02 : 1.0, 1e-12);
  }
}

TEST(JohnsonCookDamage, SofteningIsLinearInWhatIsUsed)
{
  Point p(STEEL + "damage johnson/cook 0.1 0 0 soften from 0.4");
  for (int i = 0; i < 60; i++) {
    shear(p, 0.002);
    const double e = value(p, "eplastic");
    const double D = std::min(std::max((e / 0.1 - 0.4) / 0.6, 0.0), 1.0);
    EXPECT_NEAR(value(p, "damage"), D, 1e-10);
    if (e > 0.0) EXPECT_NEAR(p.vonmises(), (1 - D) * SIGMAY, 1e-12 * SIGMAY);
  }
  EXPECT_EQ(value(p, "damage"), 1.0);
}

TEST(CockcroftLathamDamage, FailureStrain)
{
  const auto material = make(STEEL + "damage cockcroft/latham 2e8");
  // uniaxial stress sigma_y: e_f = WC/sigma_y; pure shear: sigma_1 = sigma_y/sqrt(3)
  MaterialPoint a(*material), b(*material);
  double ea = 0.0, eb = 0.0;
  while (value(a, "used") < 1.0 - 2 * 5e-4 * SIGMAY / 2e8) {
    a.step_uniaxial_stress(1.0, 5e-4);
    EXPECT_NEAR(value(a, "used"), value(a, "eplastic") * SIGMAY / 2e8, 1e-12);
  }
  while (value(a, "damage") < 1.0) {    // no motion keeps the lateral stress zero at the end
    ea = value(a, "eplastic");
    steps(a, diagonal(1, -0.5, -0.5), 5e-4);
  }
  for (int i = 0; i < 2000 && value(b, "damage") < 1.0; i++) {
    eb = value(b, "eplastic");
    shear(b, 5e-4);
  }
  EXPECT_NEAR(ea, 2e8 / SIGMAY, 6e-4);
  EXPECT_NEAR(eb, std::sqrt(3.0) * 2e8 / SIGMAY, 6e-4);
  // in compression nothing happens
  MaterialPoint c(*material);
  for (int i = 0; i < 1000; i++) c.step_uniaxial_stress(-1.0, 5e-4);
  EXPECT_NEAR(value(c, "used"), 0.0, 1e-12);
  // nor does flow under high pressure give back what was used before
  MaterialPoint d(*material);
  for (int i = 0; i < 100; i++) shear(d, 1e-3);
  const double used = value(d, "used"), strain = value(d, "eplastic");
  EXPECT_GT(used, 0.1);
  set_triaxiality(d, -1.0);
  for (int i = 0; i < 100; i++) shear(d, 1e-3);
  EXPECT_GT(value(d, "eplastic"), strain + 0.09);
  EXPECT_NEAR(value(d, "used"), used, 1e-12);
}

/** Out, back into compression, and shear again. */
Matrix through_failure(double t)
{
  const double c = std::cos(2.0 * M_PI * t), s = std::sin(2.0 * M_PI * t);
  return {0.03 * c, 0.05 * c, 0, 0.01 * c, -0.002 * s, 0.02 * s, 0, 0, 0.01 * c};
}

// stored + plastic + fracture = stress power through failure, to second order, with a coefficient
// that depends on where failure lies in its step, hence a bound.
TEST(DamageEnergy, BalanceThroughFailure)
{
  const std::string soft = STEEL + "damage johnson/cook 0.004 0.002 -1.5 soften from 0.2 ";
  const std::string sudden = STEEL + "damage johnson/cook 0.004 0.002 -1.5 ";
  const std::string brittle = "density 2400 eos shock 3000 1.4 1.5 strength elastic 1.5e10 damage "
                              "rankine 1e8 ";
  // whose elastic energy is a sum over the steps
  const std::string summed = "density 8930 eos linear 138e9 strength steinberg 47.7e9 "
                             "0.12e9 36 0.45 0.64e9 0 0 damage johnson/cook 0.004 0.002 -1.5 ";
  for (const auto &law : {soft, sudden, brittle, brittle + "soften energy 2e3 ", summed})
    for (const char *after : {"after none", "", "after friction 0.4"}) {
      SCOPED_TRACE(law + after);
      const auto material = make(law + after);
      double error[3] = {}, scale = 0.0, fracture = 0.0;
      for (int level = 0; level < 3; level++) {
        MaterialPoint p(*material, 1, 0.01);
        const int n = 500 << 2 * level;
        for (int i = 0; i < n; i++) {
          steps(p, through_failure((i + 0.5) / n), 1.0 / n);
          error[level] = std::max(error[level], std::fabs(accounted(p) - p.power));
          scale = std::max(scale, p.power);
          EXPECT_GE(p.batch.work[FRACTURE], 0.0);
        }
        EXPECT_EQ(value(p, "damage"), 1.0);
        fracture = p.work[FRACTURE];
      }
      EXPECT_GT(fracture, 0.01 * scale);
      for (int level = 0; level < 3; level++)
        EXPECT_LT(error[level], (law == summed ? 7.5e-5 : 6e-5) / (1 << 4 * level) * scale)
            << level;
    }
}

// heat is that of the plastic work that is left
TEST(DamageEnergy, HeatFollowsTheReducedPlasticWork)
{
  Point p("density 7850 eos shock 4600 1.4 2 strength j2 77e9 490e6 thermal adiabatic 460 293 0.8 "
          "damage johnson/cook 0.2 0 0 soften from 0");
  const int n = 400;
  for (int i = 0; i < n; i++) shear(p, 0.3 / n);
  EXPECT_EQ(value(p, "damage"), 1.0);
  // integral of (1 - e/0.2) sigma_y de
  EXPECT_NEAR(p.work[PLASTIC], 0.1 * SIGMAY, 3e-5 * 0.1 * SIGMAY);
  EXPECT_NEAR(p.work[HEAT], 0.8 * p.work[PLASTIC], 1e-12 * p.work[PLASTIC]);
  EXPECT_NEAR(7850 * 460 * (value(p, "temperature") - 293), p.work[HEAT], 1e-12 * p.work[HEAT]);
  EXPECT_NEAR(value(p, "heat"), p.work[HEAT], 1e-2 * p.work[HEAT]);    // of the start of steps
  // the rest: elastic energy, released in proportion
  const double tau = SIGMAY / std::sqrt(3.0);
  EXPECT_NEAR(p.work[FRACTURE], tau * tau / (2 * 77e9), 6e-4 * tau * tau / (2 * 77e9));
}

TEST(DamageEnergy, FailedPointsSlideWithFriction)
{
  const double mu = 0.4;
  Point p("density 2400 eos linear 2e10 strength elastic 1.5e10 "
          "damage rankine 1e6 after friction 0.4");
  const Matrix pull = diagonal(1e-3, 0, 0), slide = {0, 1e-4, 0, 0, 0, 0, 0, 0, 0};
  steps(p, pull, 1.0);
  ASSERT_EQ(value(p, "damage"), 1.0);
  EXPECT_NEAR(p.vonmises(), 0.0, 1e-6);
  EXPECT_NEAR(p.pressure(), 0.0, 1e-6);
  steps(p, diagonal(-4e-3, -3e-3, -3e-3), 1.0);
  const double pressure = p.pressure();
  ASSERT_GT(pressure, 1e8);
  steps(p, slide, 1.0, 200);
  const double work = p.work[FRACTURE], power = p.power;
  steps(p, slide, 1.0, 100);
  EXPECT_NEAR(p.pressure(), pressure, 1e-12 * pressure);
  EXPECT_NEAR(p.vonmises() / std::sqrt(3.0), mu * pressure, 1e-12 * pressure);
  EXPECT_NEAR(p.stress(3), mu * pressure, 2e-5 * pressure);    // sliding has turned the deviator
  EXPECT_NEAR(p.work[FRACTURE] - work, p.power - power, 5e-9 * (p.power - power));
  // pulled apart it bears nothing, pressed again it bears pressure
  steps(p, pull, 1.0, 20);
  EXPECT_NEAR(p.vonmises() + std::fabs(p.pressure()), 0.0, 1e-6);
  for (int i = 0; i < 60; i++) {
    steps(p, diagonal(-1e-3, 0, 0), 1.0);
    EXPECT_LE(p.vonmises() / std::sqrt(3.0), mu * std::max(p.pressure(), 0.0) * (1 + 1e-10));
  }
  EXPECT_GT(p.pressure(), pressure);
}

const double E_CONCRETE = 30e9, NU_CONCRETE = 0.2;
const std::string CONCRETE =
    "density 2400 eos linear 1.66666666666666667e10 strength elastic 1.25e10 ";

TEST(RankineDamage, TensileStrength)
{
  const auto material = make(CONCRETE + "damage rankine 3e6");
  MaterialPoint p(*material);
  double last = 0.0;
  for (int i = 0; i < 1200 && value(p, "damage") < 1.0; i++) {
    last = p.stress(0);
    const double e = 1e-7, lateral = -NU_CONCRETE * e;
    steps(p, diagonal(e, lateral, lateral), 1.0);    // uniaxial stress
  }
  EXPECT_NEAR(last, 3e6, E_CONCRETE * 3e-8);
  EXPECT_NEAR(p.stress(0), 0.0, 1e-8);
  // compression: no largest principal stress
  MaterialPoint q(*material);
  for (int i = 0; i < 1000; i++) q.step_uniaxial_stress(-1e-5, 1.0);
  EXPECT_EQ(value(q, "damage"), 0.0);
}

// the work that a point of a crack takes is GC/h, in any state of stress
TEST(RankineDamage, FractureEnergyDoesNotDependOnTheSpacing)
{
  const double GC = 100.0, ft = 3e6;
  const auto material = make(joined(CONCRETE, "damage rankine ", ft, " soften energy ", GC));
  const double limit = 2 * GC * E_CONCRETE / (ft * ft);    // 0.667: larger cells snap back
  const double shapes[][3] = {{1, 0, 0}, {1, 1, 0}, {1, -0.3, 0.2}};
  for (const double h : {0.003, 0.01, 0.1, 2.0})
    for (const auto &d : shapes) {
      SCOPED_TRACE(h);
      MaterialPoint p(*material, 1, h);
      const double strain = 4 * GC / (ft * h) + 2 * ft / E_CONCRETE;
      const int n = 20000;
      double peak = 0.0;
      for (int i = 0; i < n; i++) {
        const double r = strain / n;
        steps(p, diagonal(r * d[0], r * d[1], r * d[2]), 1.0);
        peak = std::max(peak, p.stress(0));
      }
      EXPECT_EQ(value(p, "damage"), 1.0);
      EXPECT_NEAR(p.work[FRACTURE] * h / GC, 1.0, 1e-3);
      EXPECT_NEAR(p.power * h / GC, 1.0, 1e-3);
      if (h < 0.5 * limit)
        EXPECT_NEAR(peak, ft, 8e-4 * ft);
      else
        EXPECT_LT(peak, 0.9 * ft);
    }
}

// pressure stores energy that a crack does not set free: shear alone makes it grow
TEST(RankineDamage, GrowsUnderPressureByTheEnergyOfShear)
{
  const double GC = 100.0, ft = 3e6, h = 0.01;
  Point p(joined(CONCRETE, "damage rankine ", ft, " soften energy ", GC), 1, h);
  const double K = E_CONCRETE / (3 - 6 * NU_CONCRETE), G = E_CONCRETE / (2 + 2 * NU_CONCRETE);
  const double volume = -1.2 * ft / K / 3.0, angle = 3.0 * ft / G / 2.0;
  steps(p, {volume, angle, 0, angle, volume, 0, 0, 0, volume}, 1.0);
  const double r = value(p, "opening"), rf = value(p, "ductility");
  EXPECT_LT(mean(p), -ft);
  EXPECT_NEAR(r, 1.8, 0.002);    // (3 - 1.2) ft over the strength
  // at the strength the energy of shear is 1/r^2 of this one
  EXPECT_NEAR(rf, GC / (h * value(p, "shear_energy") / (r * r)), 1e-10 * rf);
  EXPECT_NEAR(value(p, "shear_energy"), 9.0 * ft * ft / (2.0 * G), 1e-12 * 9.0 * ft * ft / G);
  EXPECT_NEAR(value(p, "damage"), 1.0 - (rf - r) / (r * (rf - 1.0)), 1e-12);
}

TEST(CockcroftLathamDamage, FractureEnergyDoesNotDependOnTheSpacing)
{
  const double GC = 2e4;
  const auto material =
      make(joined(STEEL, "hardening linear 300e6 damage cockcroft/latham 5e7 soften energy ", GC));
  for (const double h : {1e-4, 3e-4, 1e-3}) {
    MaterialPoint p(*material, 1, h);
    double plastic = -1.0, stored = 0.0;
    for (int i = 0; i < 20000 && value(p, "damage") < 1.0; i++) {
      shear(p, 2.0 * (GC / h / SIGMAY + 0.3) / 20000);
      if (plastic < 0.0 && value(p, "used") >= 1.0) {
        plastic = p.work[PLASTIC];
        stored = p.stored_energy();
      }
    }
    EXPECT_EQ(value(p, "damage"), 1.0);
    EXPECT_NEAR((p.work[PLASTIC] - plastic) * h / GC, 1.0, 2e-3);
    EXPECT_LT(stored * h, 0.1 * GC);
  }
}

TEST(RankineDamage, StrengthsAreWeibullDistributed)
{
  const double sigma = 5e6, m = 8.0, V0 = 2.0;
  const std::string text = joined(CONCRETE, "damage rankine ", sigma, " weibull ", m, " ", V0, " ");
  const auto material = make(text + "12345"), other = make(text + "12346");
  const int at = row(*material, "random"), n = 10000;
  std::vector<double> history(material->history().size()), u(n);
  double differ = 0.0;
  for (int i = 0; i < n; i++) {
    const double x[3] = {0.01 * (i % 25), 0.01 * (i / 25 % 20), 0.01 * (i / 500) - 0.1};
    material->initialize(x, history.data());
    u[i] = history[at];
    ASSERT_GT(u[i], 0.0);
    ASSERT_LT(u[i], 1.0);
    other->initialize(x, history.data());
    differ += std::fabs(history[at] - u[i]) / n;
  }
  EXPECT_NEAR(differ, 1.0 / 3.0, 8e-4);    // independent of each other
  for (int lag : {1, 25, 500}) {           // and of their neighbours
    double c = 0.0;
    for (int i = 0; i + lag < n; i++) c += 12 * (u[i] - 0.5) * (u[i + lag] - 0.5) / n;
    EXPECT_NEAR(c, 0.0, 0.035);
  }

  // the stress at which points of different volumes fail, by pulling them
  for (const double volume : {2.0, 0.002}) {
    std::vector<double> strength;
    const double modulus = 1.66666666666666667e10 + 4.0 / 3.0 * 1.25e10;
    for (int first = 0; first < n; first += BATCH) {
      const int size = std::min(BATCH, n - first);
      MaterialPoint p(*material, size);
      std::vector<double> reached(size, 0.0);
      for (int i = 0; i < size; i++) {
        p.batch.history[at][i] = u[first + i];
        p.batch.vol0[i] = volume;
      }
      for (int k = 0; k < 700; k++) {
        steps(p, diagonal(0.04e6 / modulus, 0, 0), 1.0);
        for (int i = 0; i < size; i++)
          if (p.batch.history[0][i] == 0.0) reached[i] = k + 1.5;
      }
      for (const double k : reached) strength.push_back(0.04e6 * k);
    }
    double sum = 0.0, logs = 0.0;
    for (const double s : strength) sum += s / n;
    const double scale = sigma * std::pow(V0 / volume, 1 / m);
    EXPECT_NEAR(sum, scale * std::tgamma(1 + 1 / m), 6e-4 * scale);
    // modulus by maximum likelihood
    double k = 5.0;
    for (const double s : strength) logs += std::log(s / scale) / n;
    for (int it = 0; it < 50; it++) {
      double c[2] = {};
      for (const double s : strength) {
        const double power = std::pow(s / scale, k);
        c[0] += power;
        c[1] += power * std::log(s / scale);
      }
      k += 0.7 * (1.0 / (c[1] / c[0] - logs) - k);
    }
    EXPECT_NEAR(k, m, 0.03 * m) << "volume " << volume;
  }
}

// constant strain rate: D = alpha rate^m t^(m+3), and what follows from that
TEST(GradyKippDamage, ConstantStrainRate)
{
  const double K = 1.7e27, m = 8.0, cg = 1300.0, rho = 2680.0;    // oil shale, rounded
  const double bulk = 5e9, G = 3e9, M = bulk + 4.0 / 3.0 * G;
  const auto material = make(joined("density ", rho, " eos linear ", bulk, " strength elastic ", G,
                                    " damage grady/kipp ", K, " ", m, " ", cg, " ", M));
  const double alpha = 8 * M_PI * cg * cg * cg * K / ((m + 1) * (m + 2) * (m + 3));
  std::vector<double> strengths;
  for (const double rate : {1.0, 100.0, 1e4}) {
    const double tf = std::pow(alpha * std::pow(rate, m), -1 / (m + 3));
    const double tm = std::pow((m + 4) * alpha * std::pow(rate, m), -1 / (m + 3));
    for (int n = 500; n <= 2000; n *= 2) {
      MaterialPoint p(*material);
      double peak = 0.0, when = 0.0;
      for (int i = 0; i < 1.2 * n; i++) {
        steps(p, diagonal(rate, 0, 0), tf / n);
        if (p.stress(0) > peak) {
          peak = p.stress(0);
          when = p.time;
        }
      }
      EXPECT_EQ(value(p, "damage"), 1.0);
      if (n < 2000) continue;
      const double known = M * rate * tm * (m + 3) / (m + 4);
      EXPECT_NEAR(peak, known, 4e-3 * known);
      EXPECT_NEAR(when, tm, 0.01 * tm);
      EXPECT_NEAR(value(p, "fragment"), 6 * cg * tf / (m + 2), 4e-3 * 6 * cg * tf / (m + 2));
      strengths.push_back(peak);
    }
  }
  // strength ~ rate^(3/(m+3))
  EXPECT_NEAR(std::log(strengths[2] / strengths[1]) / std::log(100.0), 3 / (m + 3), 1e-3);
  EXPECT_NEAR(std::log(strengths[1] / strengths[0]) / std::log(100.0), 3 / (m + 3), 3e-4);
}

struct Gurson {
  double K, sigmay, e0, n, q1, q2, fn, en, sn, fc, ff;
  double y(double e) const { return sigmay * std::pow(1 + e / e0, n); }
  double star(double f) const { return f > fc ? fc + (1 / q1 - fc) / (ff - fc) * (f - fc) : f; }
  double A(double e) const
  {
    return fn / (sn * std::sqrt(2 * M_PI)) * std::exp(-0.5 * (e - en) * (e - en) / (sn * sn));
  }
  /** Yield function of Cauchy mean and equivalent stress. */
  double phi(double m, double q, double e, double f) const
  {
    const double fs = star(f), s = y(e);
    return q * q / (s * s) + 2 * q1 * fs * std::cosh(1.5 * q2 * m / s) - 1 - q1 * q1 * fs * fs;
  }
};
const Gurson GTN = {2e11 / 1.2, 400e6, 0.004, 0.1, 1.5, 1.0, 0.04, 0.1, 0.05, 0.15, 0.25};
const std::string GTN_TEXT = "density 7800 gurson 2e11 0.3 4e8 0.01 hardening 0.004 0.1 tvergaard "
                             "1.5 1 nucleation 0.04 0.1 0.05 coalescence 0.15 0.25";

// On the surface without shear, m = y 2/(3 Q2) ln(1/(Q1 f*)): an explicit ordinary differential
// equation for matrix strain and porosity over the plastic volume strain.
TEST(GursonLaw, HydrostaticTension)
{
  const auto material = make(GTN_TEXT);
  const auto mean_stress = [](double e, double f) {
    return GTN.y(e) * 2 / (3 * GTN.q2) * std::log(1 / (GTN.q1 * GTN.star(f)));
  };
  std::vector<std::array<double, 4>> path;    // volume strain, mean stress, porosity, matrix strain
  const double dv = 2e-5;
  State state = {0.0, 0.01};    // matrix strain and porosity
  const auto rate = [&](double, const State &s) {
    const double de = mean_stress(s[0], s[1]) / ((1 - s[1]) * GTN.y(s[0]));
    return State{de, (1 - s[1]) + GTN.A(s[0]) * de};
  };
  for (int i = 0; GTN.star(state[1]) < 0.6; i++) {
    double volume = i * dv, m = mean_stress(state[0], state[1]);
    for (int k = 0; k < 50; k++) volume = i * dv + std::exp(volume) * m / GTN.K;
    path.push_back({volume, m, state[1], state[0]});
    state = runge_kutta(rate, state, dv, 1);
  }
  ASSERT_GT(state[1], 0.2);
  const size_t last = path.size() - 1;
  double error[3][3] = {};
  for (int level = 0; level < 3; level++) {
    const int n = 400 << level;
    MaterialPoint p(*material);
    size_t at = 0;
    for (int i = 1; i <= n; i++) {
      const double volume = path[last][0] * i / n;
      move_to(p, isotropic(std::exp(volume / 3)));
      while (at < last && path[at + 1][0] < volume) at++;
      if (volume < path[0][0] || at == last) continue;
      const double t = (volume - path[at][0]) / (path[at + 1][0] - path[at][0]);
      const double now[3] = {mean(p) / 4e8, value(p, "porosity"), value(p, "eplastic")};
      for (int k = 0; k < 3; k++) {
        const double known = (1 - t) * path[at][k + 1] + t * path[at + 1][k + 1];
        error[level][k] = std::max(error[level][k], std::fabs(now[k] - known / (k ? 1 : 4e8)));
      }
    }
    EXPECT_NEAR(p.vonmises(), 0.0, 1e-12 * 4e8);
  }
  const double tolerance[3] = {1e-2, 1e-4, 1e-3};
  for (int k = 0; k < 3; k++) {
    EXPECT_LT(error[2][k], tolerance[k]) << k;
    EXPECT_NEAR(std::log2(error[1][k] / error[2][k]), 1.0, 0.02) << k;
  }
}

// a point that has failed bears no tension; what has opened must close before it bears pressure
TEST(GursonLaw, FailedPointsCloseBeforeTheyBearPressure)
{
  Point p(GTN_TEXT);
  double volume = 0.0;    // logarithmic
  const auto change = [&](double by, int n) {
    for (int i = 0; i < n; i++) {
      volume += by / n;
      move_to(p, isotropic(std::exp(volume / 3)));
    }
  };
  while (value(p, "damage") < 1.0 && volume < 2.0) change(2e-3, 1);
  ASSERT_EQ(value(p, "damage"), 1.0);
  const double opened = value(p, "gap");
  change(0.05, 5);
  EXPECT_EQ(p.pressure(), 0.0);
  EXPECT_NEAR(value(p, "gap"), opened + 0.05, 1e-12);
  change(-0.04, 4);
  EXPECT_EQ(p.pressure(), 0.0);
  EXPECT_NEAR(value(p, "gap"), opened + 0.01, 1e-12);
  change(-opened - 0.011, 4);
  EXPECT_EQ(value(p, "gap"), 0.0);
  EXPECT_NEAR(std::exp(volume) * p.pressure(), GTN.K * 0.001, 1e-12 * GTN.K);
}

TEST(GursonLaw, ReturnEndsOnTheYieldSurface)
{
  RandomMatrix random(5);
  int plastic = 0, failed = 0;
  for (const double f0 : {0.0, 1e-4, 0.01, 0.1, 0.3})
    for (const double scale : {1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.3}) {
      const bool joins = f0 < GTN.fc;
      Gurson law = GTN;
      if (!joins) law.fc = 1.0;
      const auto material =
          make(joined("density 7800 gurson 2e11 0.3 4e8 ", f0,
                      " hardening 0.004 0.1 tvergaard 1.5 1 nucleation 0.04 0.1 0.05",
                      joins ? " coalescence 0.15 0.25" : ""));
      for (int repeat = 0; repeat < 40; repeat++) {
        MaterialPoint p(*material);
        // small steps: begin near the yield surface
        if (scale < 1e-3) steps(p, random(3e-3), 1.0);
        for (int i = 0; i < 5; i++) {
          const double before = value(p, "eplastic");
          steps(p, random(scale), 1.0);
          ASSERT_TRUE(std::isfinite(p.vonmises()) && std::isfinite(p.pressure())) << scale;
          ASSERT_GE(p.batch.work[PLASTIC], 0.0);
          if (value(p, "damage") >= 1.0) {
            EXPECT_NEAR(p.vonmises(), 0.0, 0.05);
            EXPECT_GE(p.pressure(), -1.0);
            failed++;
            continue;
          }
          // below 1e-7 porosity the yield function is the difference of huge numbers
          if (value(p, "porosity") < 1e-7) {
            EXPECT_LE(p.vonmises(), law.y(value(p, "eplastic")) * (1 + 1e-9));
            continue;
          }
          const double phi =
              law.phi(mean(p), p.vonmises(), value(p, "eplastic"), value(p, "porosity"));
          if (value(p, "eplastic") > before) {
            EXPECT_NEAR(phi, 0.0, 1e-9) << "strain " << scale << " f " << value(p, "porosity");
            plastic++;
          } else
            EXPECT_LE(phi, 1e-12);
        }
      }
    }
  EXPECT_GT(plastic, 2000);
  EXPECT_GT(failed, 20);
}

// without voids it is a von Mises solid, also under high pressure
TEST(GursonLaw, NoVoids)
{
  const auto material = make("density 7800 gurson 2e11 0.3 4e8 0 hardening 0.004 0.1");
  for (const double squeeze : {-0.05, 0.0}) {
    MaterialPoint p(*material);
    move_to(p, isotropic(1 + squeeze / 3));
    for (int i = 0; i < 100; i++) {
      shear(p, 0.003);
      const double e = value(p, "eplastic");
      if (e > 0.0) EXPECT_NEAR(p.vonmises() / GTN.y(e), 1.0, 4e-9);
    }
    EXPECT_NEAR(value(p, "eplastic"), 0.3 - p.vonmises() / (3 * 2e11 / 2.6), 4e-4);
    EXPECT_LT(value(p, "porosity"), 1e-10);
  }
}

// what voids it had are closed by 20 to 200 times the yield stress, in one step or many
TEST(GursonLaw, ShearOfClosedVoids)
{
  const double G3 = 3 * 2e11 / 2.6;
  for (const double f0 : {1e-4, 0.01, 0.1})
    for (const double squeeze : {0.05, 0.1, 0.25, 0.5})
      for (const int n : {1, 20}) {
        Point p(joined("density 7800 gurson 2e11 0.3 4e8 ", f0, " hardening 0.004 0.1"));
        for (int i = 1; i <= n; i++)
          move_to(p, isotropic(std::exp(-(squeeze + 1.5 * f0) * i / n / 3)));
        const std::string where = joined(f0, " squeezed by ", squeeze, " in ", n);
        EXPECT_GT(p.pressure(), 20 * 4e8) << where;
        EXPECT_LT(value(p, "porosity"), 1e-11) << where;
        for (int i = 0; i < 20; i++) shear(p, 0.003);
        const double e = value(p, "eplastic"), elastic = p.batch.J[0] * p.vonmises() / G3;
        EXPECT_NEAR(p.vonmises() / GTN.y(e), 1.0, 2e-9) << where;
        for (int i = 0; i < 20; i++) shear(p, 0.003);
        EXPECT_NEAR(p.vonmises() / GTN.y(value(p, "eplastic")), 1.0, 2e-9) << where;
        // what is not elastic; directions of a simple shear turn a little
        const double more = p.batch.J[0] * p.vonmises() / G3 - elastic;
        EXPECT_NEAR(value(p, "eplastic") - e + more, 0.06, 3e-7) << where;
      }
}

// voids close under pressure; the work of the matrix is all plastic work
TEST(GursonLaw, CompactionAndWork)
{
  Point p("density 7800 gurson 2e11 0.3 4e8 0.1 hardening 0.004 0.1");
  double matrix = 0.0;
  const int n = 4000;
  for (int i = 1; i <= n; i++) {
    const double e = value(p, "eplastic"), f = value(p, "porosity");
    move_to(p, isotropic(1 - 0.05 * i / n));
    const double e1 = value(p, "eplastic"), f1 = value(p, "porosity");
    matrix += p.batch.J[0] * (1 - 0.5 * (f + f1)) * 0.5 * (GTN.y(e) + GTN.y(e1)) * (e1 - e);
    EXPECT_LE(f1, f);
  }
  EXPECT_LT(value(p, "porosity"), 1e-9);
  EXPECT_GT(p.pressure(), 10 * 4e8);
  EXPECT_NEAR(matrix, p.work[PLASTIC], 2e-3 * matrix);
  EXPECT_NEAR(p.power, accounted(p), 3e-8 * p.power);
}

/* ---------------------------------------------------------------------- robustness */

TEST(Damage, FiniteAtExtremes)
{
  RandomMatrix random(11);
  for (const char *damage :
       {"johnson/cook 0.05 3.44 -2.12 rate 0.002 1 temperature 0.61 1793 293",
        "johnson/cook -2.2 5.43 -0.47 rate 0.016 1 temperature 0.63 1793 293 soften from 0",
        "johnson/cook 0.1 1 300 soften energy 1e3", "cockcroft/latham 1e6",
        "cockcroft/latham 1e9 soften energy 1e-3", "rankine 1", "rankine 1e9 soften energy 1e-6",
        "rankine 1e9 soften energy 1e9 weibull 0.1 1e-30 1", "rankine 1e9 weibull 60 1 0",
        "grady/kipp 1e60 9.5 3000 200e9", "grady/kipp 1e-30 1 1e-3 1"})
    for (const char *after : {"after none", "after pressure", "after friction 1.5"})
      for (const double dt : {1e-12, 1e-3, 1e6})
        for (const double scale : {1e-4, 0.1, 1.0}) {
          const std::string text =
              std::string(
                  "density 7850 eos shock 4600 1.5 2 strength johnson/cook 77e9 792e6 510e6 "
                  "0.26 0.014 1 1.03 1793 293 thermal adiabatic 477 293 damage ") +
              damage + " " + after;
          SCOPED_TRACE(text);
          const auto material = make(text);
          MaterialPoint p(*material, 3, 1e-3);
          double D = 0.0;
          for (int i = 0; i < 20; i++) {
            steps(p, random(0.3 * scale / dt), dt);
            for (int k = 0; k < 6; k++) ASSERT_TRUE(std::isfinite(p.stress(k)));
            for (size_t k = 0; k < material->history().size(); k++)
              ASSERT_TRUE(std::isfinite(p.history(k))) << material->history()[k].name;
            ASSERT_TRUE(std::isfinite(accounted(p)));
            ASSERT_GE(value(p, "damage"), D);
            // what an equation of state stores apart from heat may be negative
            if (after != std::string("after none")) ASSERT_GE(p.batch.work[FRACTURE], 0.0);
            ASSERT_GE(p.batch.work[PLASTIC], -1e-9 * p.work[PLASTIC]);
            D = value(p, "damage");
          }
        }
}

// a damage that never grows changes nothing but round-off
TEST(Damage, NeutralWithoutGrowth)
{
  const std::string text = "density 7830 eos shock 4600 1.5 2 strength johnson/cook 79.6e9 806e6 "
                           "614e6 0.168 0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9 ";
  const auto plain = make(text), damaged = make(text + "damage johnson/cook 1e9 0 0");
  MaterialPoint p(*plain), q(*damaged);
  RandomMatrix random(3);
  for (int i = 0; i < 100; i++) {
    const Matrix L = random(10.0);
    for (auto *point : {&p, &q}) steps(*point, L, 1e-3);
    EXPECT_LT(distance(stress_of(p), stress_of(q)), 1e-12 * (1e9 + size(stress_of(p))));
    EXPECT_NEAR(p.stored_energy(), q.stored_energy(), 1e-12 * p.work[PLASTIC]);
    EXPECT_NEAR(value(p, "temperature"), value(q, "temperature"), 1e-10);
  }
  for (int k = 0; k < NWORK; k++) EXPECT_NEAR(p.work[k], q.work[k], 1e-12 * p.work[PLASTIC]);
  EXPECT_GT(value(q, "used"), 0.0);
}

TEST(Damage, BadInputIsRefused)
{
  expect_refused(
      {{"damage rankine 1", "add a strength, such as 'strength elastic G'"},
       {"strength elastic 1 damage foo 1",
        "unknown damage 'foo': choose johnson/cook, cockcroft/latham, rankine, grady/kipp"},
       {"strength elastic 1 damage rankine 1 after foo",
        "followed by none or pressure or friction"},
       {"strength elastic 1 damage rankine 1 after none after pressure", "'after' is given twice"},
       {"strength elastic 1 damage rankine 1 after none 1", "too many values"},
       {"strength elastic 1 damage rankine 1 damage rankine 1", "has 'damage rankine' already"}},
      "density 1 eos linear 1 ");
  expect_refused({{"density 1 linear 1 0 damage rankine 1", "'linear' is a complete law"}});
  EXPECT_EQ(
      make("density 1 eos linear 1 strength elastic 1 damage rankine 7 after none")->describe(),
      "density 1, eos linear K=1, strength elastic G=1, damage rankine SIGMA=7 after none");
}

// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// Strengths and thermal parts, point by point, against closed forms and equations solved here.

#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

const double ROOT3 = std::sqrt(3.0);

/** n steps of pure shear, together an equivalent strain; the stress is along one direction. */
void shear(MaterialPoint &p, double strain, double time, int n = 1)
{
  const double g = 0.5 * ROOT3 * strain / time;
  steps(p, {0, g, 0, g, 0, 0, 0, 0, 0}, time / n, n);
}

/** Equivalent stress in pure shear, with sign. */
double shear_stress(const MaterialPoint &p)
{
  return ROOT3 * p.stress(3);
}

const std::string J2 = "density 7800 eos linear 160e9 strength j2 80e9 300e6 ";
constexpr double G = 80e9, SIGMAY = 300e6;

/** A strength j2 with the flow stress that its options give. */
struct Hardening {
  const char *text;
  double H = 0.0, B = 0.0, N = 1.0, Q = 0.0, b = 0.0;    ///< linear, power, and Voce
  double (*other)(double) = nullptr;

  double Y(double e) const
  {
    if (other) return other(e);
    return SIGMAY + H * e + B * std::pow(e, N) + Q * (1 - std::exp(-b * e));
  }
};

double swift(double e)
{
  return SIGMAY * std::pow(1 + e / 0.002, 0.2);
}

double table(double e)
{
  const double E[] = {0, 0.01, 0.1, 0.3, 1e30}, S[] = {300e6, 420e6, 500e6, 480e6, 480e6};
  int k = 0;
  while (e > E[k + 1]) k++;
  return S[k] + (S[k + 1] - S[k]) * (e - E[k]) / (E[k + 1] - E[k]);
}

const Hardening hardenings[] = {
    {""},
    {"hardening linear 2e9", 2e9},
    {"hardening power 5e8 0.3", 0, 5e8, 0.3},
    {"hardening voce 2e8 15 1e8", 1e8, 0, 1, 2e8, 15},
    {"hardening voce 0 15 1e8", 1e8},
    {"hardening swift 0.002 0.2", 0, 0, 1, 0, 0, swift},
    {"point 0.01 420e6 point 0.1 500e6 point 0.3 480e6", 0, 0, 1, 0, 0, table},
    {"point 0.01 420e6 point 0.02 428888888.88888889 point 0.03 437777777.77777778 "
     "point 0.04 446666666.66666667 point 0.05 455555555.55555556 point 0.06 464444444.44444444 "
     "point 0.07 473333333.33333333 point 0.08 482222222.22222222 point 0.1 500e6 point 0.3 480e6",
     0, 0, 1, 0, 0, table}};

TEST(J2Hardening, ReturnEndsOnTheYieldSurface)
{
  std::mt19937 random(2);
  for (const auto &h : hardenings) {
    SCOPED_TRACE(h.text);
    random_steps(*make(J2 + h.text), random, {1e-6, 1e-3, 1e-2, 0.1, 1.0}, {1.0}, 20, 4,
                 [&](const MaterialPoint &p, double, double) {
                   expect_on_surface(p, h.Y(p.history(0)));
                   EXPECT_EQ(p.batch.plastic[0] > 0, p.batch.work[PLASTIC] > 0);
                 });
  }
}

// one step or many on a straight path; stress, plastic strain and plastic work in closed form
TEST(J2Hardening, StraightPath)
{
  for (const auto &h : hardenings) {
    SCOPED_TRACE(h.text);
    const auto material = make(J2 + h.text);
    for (const double strain : {0.01, 0.1, 1.0}) {
      MaterialPoint one(*material), many(*material);
      shear(one, strain, 1.0);
      shear(many, strain, 1.0, 2000);
      const double e = one.history(0), Y = h.Y(e);
      EXPECT_NEAR(e, strain - Y / (3 * G), 1e-12 * strain);
      EXPECT_NEAR(shear_stress(one), Y, 1e-10 * Y);
      EXPECT_NEAR(shear_stress(many), Y, 1e-12 * Y);
      double work = 0.0;    // integral of Y
      const int n = 20000;
      for (int i = 0; i < n; i++) work += h.Y((i + 0.5) * e / n) * e / n;
      EXPECT_NEAR(many.work[PLASTIC], work, 3e-5 * work);
      EXPECT_NEAR(many.stored_energy() + many.work[PLASTIC], many.power, 1e-4 * work);
    }
  }
}

// Considere: a bar carries most when the slope of the flow stress equals it (Weldox 460 E)
TEST(J2Hardening, ConsidereLoad)
{
  const double E = 211e9, nu = 0.33;
  Point p(joined("density 7750 eos linear ", E / (3 * (1 - 2 * nu)), " strength j2 ",
                 E / (2 * (1 + nu)), " 499e6 hardening power 382e6 0.458"));
  double load = 0.0, at = 0.0, e = 0.0, J = 0.0;
  for (int i = 0; i < 3000; i++) {
    p.step_uniaxial_stress(1.0, 5e-5);
    const double nominal = p.stress(0) * p.batch.J[0] / p.batch.F[0][0];
    if (nominal > load) {
      load = nominal;
      at = p.batch.F[0][0] - 1.0;
      e = p.history(0);
      J = p.batch.J[0];
    }
  }
  EXPECT_NEAR(e, 0.09444, 5e-4);
  EXPECT_NEAR(load, 570.3e6 * J, 0.1e6);
  EXPECT_NEAR(at, 0.1023, 3e-4);
}

TEST(J2Hardening, BadInputIsRefused)
{
  expect_refused(
      {{"hardening voce 1e8 1", "HVOCE is missing"},
       {"hardening swift 0 0.2", "out of range"},
       {"point 0.1 5e8 hardening linear 1e9", "points of the flow stress do not go with"},
       {"point 0.1 5e8 point 0.1 6e8", "must increase"},
       {"point 0 3e8", "out of range"},
       {"point 0.001 1e8", "must not fall faster than G/2"},
       {"rate perzyna 1e8 1 0.5", "out of range"},
       {"rate perzyna 1e8 1 1 rate cowper/symonds 40 5", "'rate' is given twice"},
       {"kinematic 0 1", "out of range"}},
      J2);
}

// Bauschinger effect: forward, backward, forward again, in closed form, in any number of steps.
// Back stress from x0 at plastic strain 0, forward: x = c - (c - x0) exp(-gamma e), c = C/gamma
TEST(J2Kinematic, LoopInClosedForm)
{
  const double C = 20e9;
  for (const double gamma : {0.0, 50.0, 300.0})
    for (const char *isotropic : {"", "hardening linear 1e9"}) {
      const double H = *isotropic ? 1e9 : 0.0;
      const auto material = make(joined(J2, isotropic, " kinematic ", C, " ", gamma));
      ASSERT_EQ(material->history().size(), 7u);
      for (const int n : {1, 7, 200}) {
        MaterialPoint p(*material);
        double x = 0.0, total = 0.0, e = 0.0;
        for (const double amount : {0.02, -0.05, 0.04, -0.3}) {
          SCOPED_TRACE(joined("gamma ", gamma, " H ", H, " n ", n, " strain ", amount));
          const double sign = amount > 0 ? 1 : -1;
          shear(p, amount, 1.0, n);
          total += amount;
          const double de = p.history(0) - e;
          e = p.history(0);
          x = gamma > 0 ? sign * C / gamma - (sign * C / gamma - x) * std::exp(-gamma * de)
                        : x + sign * C * de;
          const double stress = x + sign * (SIGMAY + H * e);
          EXPECT_NEAR(shear_stress(p), stress, 1e-10 * SIGMAY);
          EXPECT_NEAR(ROOT3 * p.history(4), x, 1e-10 * C * 0.1);    // backxy
          EXPECT_GE(p.batch.work[PLASTIC], 0.0);
        }
        // plastic strain with sign is what remains of the total
        if (gamma == 0.0 && H == 0.0) {
          EXPECT_NEAR(x / C, total - shear_stress(p) / (3 * G), 1e-12);
        }
      }
    }
}

// the reverse yield stress of linear kinematic hardening is 2 SIGMAY below
TEST(J2Kinematic, ReverseYieldInTension)
{
  Point p(J2 + "kinematic 5e9 0");
  for (int i = 0; i < 500; i++) p.step_uniaxial_stress(1.0, 1e-4);
  const double top = p.stress(0), e = p.history(0);
  EXPECT_NEAR(top, SIGMAY + 5e9 * e / p.batch.J[0], 1e-12 * top);
  double reverse = 0.0;
  for (int i = 0; i < 2000 && p.history(0) == e; i++) {
    p.step_uniaxial_stress(-1.0, 5e-6);
    reverse = p.stress(0);
  }
  EXPECT_NEAR(reverse, top - 2 * SIGMAY, 0.005 * SIGMAY);
}

// stabilized cycle of plastic strain amplitude a: stress amplitude SIGMAY + C/gamma tanh(gamma a)
TEST(J2Kinematic, StabilizedCycle)
{
  const double C = 40e9, gamma = 200;
  Point p(joined(J2, "kinematic ", C, " ", gamma));
  const double strain = 0.01;
  double e = 0.0, range = 0.0, top = 0.0;
  for (int half = 0; half < 40; half++) {
    shear(p, (half == 0 ? 1 : half % 2 ? -2 : 2) * strain, 1.0, 20);
    range = p.history(0) - e;
    e = p.history(0);
    top = std::fabs(shear_stress(p));
  }
  const double expected = SIGMAY + C / gamma * std::tanh(0.5 * gamma * range);
  EXPECT_NEAR(top, expected, 1e-12 * expected);
  EXPECT_NEAR(range, 2 * strain - 2 * top / (3 * G), 1e-13);
}

// the back stress turns with the point: reversed loading after any rotation is the same
TEST(J2Kinematic, TurnsWithThePoint)
{
  const auto material = make(J2 + "hardening voce 1e8 20 0 kinematic 20e9 100");
  const auto shear = [](double t) {
    return Matrix{1, 0.1 * std::sin(2 * M_PI * t), 0, 0, 1 + 0.02 * t, 0, 0, 0, 1};
  };
  const auto error = refined(100, [&](int n) {
    double worst = 0.0;
    turn_on_top(*material, shear, 4.0 * M_PI, n, [&](auto &, auto &, double difference) {
      worst = std::max(worst, difference);
    });
    return worst / SIGMAY;
  });
  EXPECT_LT(error[2], 2e-3);
  EXPECT_GT(std::log2(error[0] / error[1]), 0.8);
  EXPECT_GT(std::log2(error[1] / error[2]), 0.8);

  // a rotation alone, between loading and unloading: exact
  MaterialPoint a(*material), b(*material);
  const Matrix L = {0.1, 0.4, 0, -0.1, -0.2, 0.1, 0, 0.2, 0.1};
  for (auto *p : {&a, &b}) steps(*p, L, 0.1);
  const double angle = 2 * M_PI / 7;
  const Matrix R = rotation(AXIS, angle), back = isotropic(-1) * L;
  steps(b, spin(angle), 1.0);
  steps(a, back, 0.15);
  steps(b, R * back * transpose(R), 0.15);
  EXPECT_LT(distance(stress_of(b), R * stress_of(a) * transpose(R)), 1e-12 * SIGMAY);
}

// xi = s - X/J is on the yield surface after any step
TEST(J2Kinematic, ReturnEndsOnTheYieldSurface)
{
  std::mt19937 random(3);
  for (const auto &h : hardenings)
    for (const double gamma : {0.0, 10.0, 1000.0}) {
      SCOPED_TRACE(std::string(h.text) + " " + std::to_string(gamma));
      random_steps(*make(joined(J2, h.text, " kinematic 30e9 ", gamma)), random,
                   {1e-6, 1e-3, 1e-2, 0.1, 1.0}, {1.0}, 10, 4,
                   [&](const MaterialPoint &p, double, double) {
                     double xi2 = 0.0;
                     for (int k = 0; k < 6; k++) {
                       const double s = p.stress(k) + (k < 3 ? p.pressure() : 0.0);
                       const double d = s - p.history(1 + k) / p.batch.J[0];
                       xi2 += (k < 3 ? 1.5 : 3.0) * d * d;
                     }
                     const double Y = h.Y(p.history(0)), q = std::sqrt(xi2);
                     ASSERT_TRUE(std::isfinite(q));
                     const double sum = std::max(p.vonmises(), Y);    // digits of s and X
                     if (p.batch.plastic[0] > 0)
                       EXPECT_NEAR(q, Y, 1e-10 * sum);
                     else
                       EXPECT_LE(q, Y + 1e-12 * sum);
                     EXPECT_GE(p.batch.work[PLASTIC], 0.0);
                   });
    }
}

/** Overstress over strain rate: Y (r/rate)^n (Cowper and Symonds), or S (r/rate)^n (Perzyna). */
struct Rate {
  const char *text;
  double rate, n, S;    ///< S: 0 for Y
  double stress(double Y, double r) const { return Y + (S > 0 ? S : Y) * std::pow(r / rate, n); }
};
const Rate rates[] = {{"rate cowper/symonds 40.4 5", 40.4, 0.2, 0},
                      {"rate cowper/symonds 6500 1", 6500, 1, 0},
                      {"rate perzyna 2e8 10 4", 10, 0.25, 2e8},
                      {"rate perzyna 1e3 10 1", 10, 1, 1e3},
                      {"rate perzyna 5e7 1e-3 40", 1e-3, 0.025, 5e7}};

// steady flow of a perfectly plastic material, where the plastic strain rate is the strain rate
TEST(J2Rate, SteadyOverstress)
{
  for (const auto &c : rates) {
    SCOPED_TRACE(c.text);
    const auto material = make(J2 + c.text);
    for (double rate = 1e-6; rate < 3e8; rate *= 100) {
      const double expected = c.stress(SIGMAY, rate);
      if (expected > G) continue;
      MaterialPoint p(*material);
      const double strain = 3 * (0.1 + expected / (3 * G));
      shear(p, 10 * strain, 10 * strain / rate, 200);
      EXPECT_NEAR(shear_stress(p), expected, 2e-9 * expected) << "rate " << rate;
    }
  }
}

TEST(J2Rate, ReturnEndsOnTheYieldSurface)
{
  std::mt19937 random(4);
  for (const auto &c : rates)
    for (const auto &h : hardenings) {
      const std::string text = J2 + h.text + " " + c.text;
      SCOPED_TRACE(text);
      for (const double rate : {1e-6, 1.0, 1e4, 1e8})
        for (const double scale : {1e-4, 1e-2, 0.1, 1.0})
          random_steps(*make(text), random, {scale}, {scale / rate}, 1, 3,
                       [&](const MaterialPoint &p, double e, double dt) {
                         EXPECT_NEAR(p.history(0) - e, p.batch.plastic[0], 1e-12);
                         expect_on_surface(p, c.stress(h.Y(p.history(0)), p.batch.plastic[0] / dt));
                       });
    }
}

// transient under changing strain rate against the differential equation; first order in dt
TEST(J2Rate, AgainstDifferentialEquation)
{
  const double rate = 50.0, time = 0.01 / rate;
  const auto speed = [=](double t) {
    return rate * (1 + 0.9 * std::sin(20 * t / time));
  };
  struct {
    const char *text;
    std::function<double(double, double)> flow;    // plastic strain rate of q and e
  } cases[] = {{"hardening linear 5e9 rate cowper/symonds 1000 1",
                [](double q, double e) {
                  return 1000 * std::max(q / (SIGMAY + 5e9 * e) - 1, 0.0);
                }},
               {"hardening voce 2e8 200 0 rate perzyna 2e8 10 2", [](double q, double e) {
                  const double Y = SIGMAY + 2e8 * (1 - std::exp(-200 * e));
                  return 10 * std::pow(std::max(q - Y, 0.0) / 2e8, 2);
                }}};
  for (const auto &c : cases) {
    SCOPED_TRACE(c.text);
    const State exact = runge_kutta(
        [&](double t, const State &y) {
          const double r = c.flow(y[0], y[1]);
          return State{3 * G * (speed(t) - r), r};
        },
        {0.0, 0.0}, time, 200000);
    const auto material = make(J2 + c.text);
    const auto error = refined(400, [&](int n) {
      MaterialPoint p(*material);
      for (int i = 0; i < n; i++) shear(p, speed((i + 0.5) * time / n) * time / n, time / n);
      if (n == 1600) EXPECT_NEAR(p.history(0), exact[1], 3e-4 * exact[1]);
      return std::fabs(shear_stress(p) / exact[0] - 1.0);
    });
    EXPECT_LT(error[2], 5e-4);
    expect_order(error, 1.0, 0.15);
  }
}

// relaxation at constant strain: linear overstress decays like exp(-3 G RATE t/S)
TEST(J2Rate, Relaxation)
{
  const double S = 1e8, rate = 10;
  Point p(joined(J2, "rate perzyna ", S, " ", rate, " 1"));
  shear(p, 0.01, 1e-9);    // too fast for plastic strain
  const double start = shear_stress(p);
  EXPECT_GT(start, 5 * SIGMAY);
  const double tau = S / (3 * G * rate);
  steps(p, {}, 3 * tau / 4000, 4000);
  EXPECT_NEAR(shear_stress(p) - SIGMAY, (start - SIGMAY) * std::exp(-3.0), 3e-3 * SIGMAY);
}

// the rate-independent limit is exact: no overstress is left when it is slow, or S is small
TEST(J2Rate, RateIndependentLimit)
{
  for (const char *text : {"hardening power 5e8 0.3 rate cowper/symonds 1e40 1",
                           "hardening power 5e8 0.3 rate perzyna 1e-30 1 3"}) {
    const auto slow = make(J2 + text), plain = make(J2 + "hardening power 5e8 0.3");
    MaterialPoint p(*slow), q(*plain);
    for (const double strain : {0.01, -0.5, 0.1}) {
      shear(p, strain, 1.0, 3);
      shear(q, strain, 1.0, 3);
      EXPECT_NEAR(shear_stress(p), shear_stress(q), 1e-12 * SIGMAY);
      EXPECT_NEAR(p.history(0), q.history(0), 1e-12);
    }
  }
}

struct ZerilliArmstrong {
  const char *form;
  double C0, C1, C2, C3, C4, C5, N;
  double operator()(double e, double rate, double T) const
  {
    const double x = T > 0 ? T * (C4 * std::log(rate) - C3) : 0.0;
    return C0 + (C1 + C2 * std::sqrt(e)) * std::exp(std::min(x, 0.0)) + C5 * std::pow(e, N);
  }
  std::string text(double cp, double T0, double chi) const
  {
    const std::string form = C1 > 0 ? joined("bcc ", C1, " ", C3, " ", C4, " ", C5, " ", N)
                                    : joined("fcc ", C2, " ", C3, " ", C4);
    return joined("density 7870 eos linear 165e9 strength zerilli/armstrong 80e9 ", C0, " form ",
                  form, " thermal adiabatic ", cp, " ", T0, " ", chi);
  }
};
const ZerilliArmstrong iron = {"bcc", 65e6, 1033e6, 0, 0.00698, 0.000415, 266e6, 0.289};
const ZerilliArmstrong copper = {"fcc", 65e6, 0, 890e6, 0.0028, 0.000115, 0, 1};

// one step that must end at a known plastic strain, rate and temperature
TEST(ZerilliArmstrongLaw, FlowStress)
{
  const double e[] = {0.1, 0.1, 0.3, 0.3}, rate[] = {1, 1e3, 1e4, 1e4}, T[] = {300, 300, 300, 600};
  const struct {
    const ZerilliArmstrong &law;
    double known[4];    // MPa
  } sets[] = {{iron, {328.9944, 502.4732, 653.4106, 408.1691}},
              {copper, {186.5018, 219.1994, 354.1634, 236.5283}}};
  for (const auto &set : sets)
    for (int k = 0; k < 4; k++) {
      const double Y = set.law(e[k], rate[k], T[k]), D = 1e-3;
      EXPECT_NEAR(Y, set.known[k] * MPa, 3e-4 * MPa);
      Point p(set.law.text(450, T[k], 0.0));
      p.batch.history[0][0] = e[k] - D;
      shear(p, D + Y / (3 * 80e9), D / rate[k]);
      EXPECT_NEAR(shear_stress(p), Y, 1e-12 * Y);
      EXPECT_NEAR(p.history(0), e[k], 1e-11);
    }
}

TEST(ZerilliArmstrongLaw, ReturnEndsOnTheYieldSurface)
{
  std::mt19937 random(5);
  for (const auto &law : {iron, copper})
    for (const double T : {0.0, 1.0, 77.0, 300.0, 1000.0, 4000.0}) {
      SCOPED_TRACE(law.form + std::string(" T ") + std::to_string(T));
      const auto material = make(law.text(450, T, 0.9));
      for (const double rate : {1e-6, 1.0, 1e4, 1e8})
        for (const double scale : {1e-4, 1e-2, 0.1, 1.0})
          random_steps(*material, random, {scale}, {scale / rate}, 1, 3,
                       [&](const MaterialPoint &p, double, double dt) {
                         ASSERT_TRUE(std::isfinite(p.history(1)));
                         const double r = p.batch.plastic[0] / dt;
                         const double Y = law(p.history(0), r, p.history(1));
                         if (r > 0) EXPECT_NEAR(p.vonmises() / Y, 1.0, 1e-10);
                         EXPECT_GE(p.history(1), T);
                       });
    }
}

// adiabatic shear against the differential equation, first order in dt
TEST(ZerilliArmstrongLaw, AgainstDifferentialEquation)
{
  const double G = 80e9, rate = 1e3, time = 0.3 / rate, chi = 0.9, cp = 450, rho = 7870;
  const auto flow = [](double q, double e, double T) {
    const double thermal = q - iron.C0 - iron.C5 * std::pow(e, iron.N);
    if (thermal <= 0) return 0.0;
    return std::exp((std::log(thermal / iron.C1) / T + iron.C3) / iron.C4);
  };
  const State exact = runge_kutta(
      [&](double, const State &y) {
        const double r = flow(y[0], std::max(y[1], 0.0), y[2]);
        return State{3 * G * (rate - r), r, chi * y[0] * r / (rho * cp)};
      },
      {0.0, 0.0, 300.0}, time, 200000);
  const auto material = make(iron.text(cp, 300, chi));
  const auto error = refined(100, [&](int n) {
    MaterialPoint p(*material);
    shear(p, 0.3, time, n);
    EXPECT_NEAR(p.history(1) - 300, exact[2] - 300, 0.01 * (exact[2] - 300));
    EXPECT_NEAR(p.history(0), exact[1], 6e-6 * exact[1]);
    EXPECT_NEAR(p.work[HEAT], rho * cp * (p.history(1) - 300), 1e-10 * p.work[HEAT]);
    return std::fabs(shear_stress(p) / exact[0] - 1.0);
  });
  EXPECT_LT(error[2], 5e-5);
  EXPECT_GT(std::log2(error[0] / error[2]), 2 * 0.85);
}

TEST(ZerilliArmstrongLaw, Melting)
{
  const std::string text =
      "density 8960 eos linear 137e9 strength zerilli/armstrong 46e9 65e6 form fcc 890e6 2.8e-3 "
      "1.15e-4 melt 1356 thermal constant ";
  for (const char *T : {"1355", "1357"}) {
    Point p(text + T);
    for (int i = 0; i < 5; i++) shear(p, 0.02, 1.0);
    if (T == std::string("1355"))
      EXPECT_GT(p.vonmises(), 65e6);
    else
      EXPECT_LT(p.vonmises(), 1e-3);
  }
}

TEST(ZerilliArmstrongLaw, BadInputIsRefused)
{
  const std::string start = "density 1 eos linear 1 strength zerilli/armstrong 1 1 ";
  for (const char *text : {"thermal constant 300", "form bcc 0 1 1 0 1 thermal constant 300",
                           "form hcp 1 thermal constant 300", "form fcc 1 1 1"})
    EXPECT_THROW(make(start + text), MaterialError) << text;
}

const double SCG_G0 = 47.7e9, SCG_A = 2.83e-11, SCG_B = 3.77e-4;
const std::string SCG = "density 8930 eos linear 137e9 strength steinberg 47.7e9 0.12e9 36 0.45 "
                        "0.64e9 2.83e-11 3.77e-4 melt 1790 1.5 2.02 thermal adiabatic 385 300 0 ";

double scg_factor(double P, double J, double T)
{
  return std::max(1 + SCG_A * P * std::cbrt(J) - SCG_B * (T - 300), 0.01);
}
double scg_yield(double e)
{
  return std::min(0.12e9 * std::pow(1 + 36 * e, 0.45), 0.64e9);
}
double scg_melt(double J)
{
  return 1790 * std::exp(2 * 1.5 * (1 - J)) * std::pow(1 / J, 2 * (2.02 - 1.5 - 1.0 / 3));
}

// shear at constant volume and temperature: modulus, flow stress and wave speed at any pressure
TEST(SteinbergLaw, ModulusAndFlowStress)
{
  const auto material = make(SCG);
  for (const double J : {0.12, 0.3, 0.7, 0.95, 1.0, 1.02})
    for (const double T : {0.0, 300.0, 1000.0, 1500.0}) {
      SCOPED_TRACE(joined("J ", J, " T ", T));
      MaterialPoint p(*material);
      p.batch.history[2][0] = T;
      move_to(p, isotropic(std::cbrt(J)));
      const double P = p.pressure(), f = scg_factor(P, J, T), G = SCG_G0 * f;
      EXPECT_NEAR(P, 137e9 * (1 / J - 1), 1e-11 * 137e9);
      EXPECT_NEAR(p.wave_speed(), std::sqrt((137e9 + 4.0 / 3 * G) / 8930), 1e-11 * p.wave_speed());
      MaterialPoint q(p);
      steps(q, {0, 1e-6, 0, 1e-6, 0, 0, 0, 0, 0}, 1.0);
      EXPECT_NEAR(q.stress(3), 2e-6 * G / J, 1e-12 * G);
      for (int i = 0; i < 5; i++) {
        shear(p, i ? 0.2 : 0.02, 1.0);
        const double Y = f * scg_yield(p.history(0));
        EXPECT_NEAR(shear_stress(p), Y, 1e-10 * Y);
      }
      EXPECT_EQ(p.history(2), T);    // no heat
      EXPECT_NEAR(p.stored_energy() - 137e9 * (J - 1 - std::log(J)),
                  std::pow(J * p.vonmises(), 2) / (6 * G), 1e-7 * 137e9 * 1e-6);
    }
  EXPECT_GT(137e9 * (1 / 0.12 - 1), 1e12);    // TPa are reached
}

// the flow stress begins where earlier strain has left it, and TREF is where G0 and Y0 are meant
TEST(SteinbergLaw, PrestrainAndReferenceTemperature)
{
  Point p("density 8930 eos linear 137e9 strength steinberg 47.7e9 0.12e9 36 0.45 0.64e9 0 3.77e-4 "
          "prestrain 0.05 tref 400 thermal constant 300");
  const double f = 1 + 3.77e-4 * 100;
  MaterialPoint q(p);
  steps(q, {0, 1e-6, 0, 1e-6, 0, 0, 0, 0, 0}, 1.0);
  EXPECT_NEAR(q.stress(3), 2e-6 * 47.7e9 * f, 1e-12 * 47.7e9);
  for (int i = 0; i < 5; i++) {
    shear(p, 0.01, 1.0);
    const double Y = f * 0.12e9 * std::pow(1 + 36 * (p.history(0) + 0.05), 0.45);
    EXPECT_NEAR(shear_stress(p), Y, 1e-10 * Y);
  }
}

TEST(SteinbergLaw, Melting)
{
  const auto material = make(SCG);
  for (const double J : {0.5, 0.8, 1.0}) {
    const double melt = scg_melt(J);
    EXPECT_GT(melt, J < 1 ? 1791 : 1789);
    for (const double T : {melt - 0.01, melt + 0.01, 5 * melt}) {
      MaterialPoint p(*material);
      move_to(p, isotropic(std::cbrt(J)));
      shear(p, 0.02, 1.0);
      EXPECT_GT(p.vonmises(), 0.12e9);
      p.batch.history[2][0] = T;
      for (int i = 0; i < 3; i++) shear(p, 0.02, 1.0);
      ASSERT_TRUE(std::isfinite(p.history(0)));
      if (T < melt)
        EXPECT_GT(p.vonmises(), 1e6);
      else
        EXPECT_LT(p.vonmises(), 1e-3);
      EXPECT_LT(p.history(0), 1.0);
    }
  }
}

// shock and release with yielding, melting and heat: energy of second order, all finite
TEST(SteinbergLaw, EnergyOnAPathThroughHighPressure)
{
  const auto material =
      make("density 8930 eos shock 3940 1.489 2.02 strength steinberg 47.7e9 0.12e9 36 0.45 0.64e9 "
           "2.83e-11 3.77e-4 thermal adiabatic 385 300 0.9 gruneisen 2.02");
  double scale = 0.0;
  const auto error = refined(2000, [&](int n) {
    MaterialPoint p(*material);
    double worst = 0.0;
    for (int i = 1; i <= n; i++) {
      const double s = std::sin(M_PI * i / n);
      move_to(p, {1 - 0.4 * s, 0.3 * s * s, 0, 0, 1, 0, 0, 0, 1 - 0.05 * s});
      const double energy = p.stored_energy() + p.work[PLASTIC];
      worst = std::max(worst, std::fabs(energy - p.power));
      scale = std::max(scale, energy);
    }
    return worst;
  });
  EXPECT_LT(error[2], 4e-8 * scale);
  EXPECT_GT(std::log2(error[0] / error[2]), 2 * 1.7);
}

TEST(SteinbergLaw, BadInputIsRefused)
{
  const std::string start = "density 1 eos linear 1 strength steinberg ";
  EXPECT_NO_THROW(make(start + "1 1 1 1 1 0 0"));
  EXPECT_THROW(make(start + "1 2 1 1 1 0 0"), MaterialError);               // YMAX < Y0
  EXPECT_THROW(make(start + "1 1 1 1 1 0 1e-3"), MaterialError);            // no temperature
  EXPECT_THROW(make(start + "1 1 1 1 1 0 0 melt 1 1 1"), MaterialError);    // nor here
  EXPECT_NO_THROW(make(start + "1 1 1 1 1 0 1e-3 tref 0 thermal constant 300"));
}

// tension with free sides: the equivalent stress is the axial one, and the flow stress of the
// strain, rate, temperature (and pressure of the step before) there; small strain by hand
TEST(Strengths, UniaxialStress)
{
  const double rate = 2e3;
  struct {
    std::string text;
    int temperature;                                                    // its row in the history
    std::function<double(double, double, double, double, double)> Y;    // e, rate, T, P, J
  } cases[] = {{J2 + "hardening swift 0.002 0.2 rate cowper/symonds 40.4 5", -1,
                [](double e, double r, double, double, double) {
                  return rates[0].stress(swift(e), r);
                }},
               {iron.text(450, 200, 0.9), 1,
                [](double e, double r, double T, double, double) {
                  return iron(e, r, T);
                }},
               {copper.text(450, 500, 0.9), 1,
                [](double e, double r, double T, double, double) {
                  return copper(e, r, T);
                }},
               {SCG, 2, [](double e, double, double T, double P, double J) {
                  return scg_yield(e) * scg_factor(P, J, T);
                }}};
  for (const auto &c : cases) {
    SCOPED_TRACE(c.text);
    const auto material = make(c.text);
    for (const double sign : {1.0, -1.0}) {
      MaterialPoint p(*material);
      const int n = 400;
      for (int i = 0; i < n; i++) {
        const double P = p.pressure(), J = p.batch.J[0];
        p.step_uniaxial_stress(sign * rate, 0.3 / rate / n);
        const double T = c.temperature < 0 ? 0.0 : p.history(c.temperature);
        const double r = p.batch.plastic[0] * n / 0.3 * rate;
        if (r < 0.5 * rate) continue;
        const double Y = c.Y(p.history(0), r, T, P, J);
        ASSERT_NEAR(sign * p.stress(0), Y, 1e-10 * Y) << "step " << i;
        ASSERT_NEAR(p.stress(1), 0.0, 1e-10 * Y);
      }
      EXPECT_GT(p.history(0), 0.28);
    }
  }
}

// uniaxial strain: the deviator is at the flow stress, the pressure that of the equation of state
TEST(Strengths, UniaxialStrain)
{
  Point p(J2 + "hardening voce 2e8 15 1e8 kinematic 20e9 0");
  compress(p, 0.8, 200);
  const double e = p.history(0), J = 0.8;
  EXPECT_NEAR(p.batch.J[0], J, 1e-12);
  // the back stress is linear in e, and J times the Cauchy stress
  const double Y = SIGMAY + 2e8 * (1 - std::exp(-15 * e)) + 1e8 * e + 20e9 * e / J;
  EXPECT_NEAR(p.pressure(), 160e9 * (1 / J - 1), 1e-12 * 160e9);
  EXPECT_NEAR(p.stress(1) - p.stress(0), Y, 1e-10 * Y);
  EXPECT_NEAR(-2.0 / 3 * std::log(J), e + (p.stress(1) - p.stress(0)) * J / (3 * G), 8e-7 * e);
}

// shear with a superposed rotation of two turns: rate forms are objective for small steps
TEST(Strengths, RotationOnTopOfShear)
{
  const auto shear = [](double t) {
    return Matrix{1, 0.1 * t, 0, 0, 1 - 0.01 * t, 0, 0, 0, 1};
  };
  for (const auto &sample : samples) {
    const std::string text = sample.text;
    if (text.find("strength") == std::string::npos) continue;
    SCOPED_TRACE(sample.name);
    const auto material = make(text);
    double error[2];
    for (int level = 0; level < 2; level++) {
      double worst = 0.0, scale = 0.0;
      turn_on_top(*material, shear, 4.0 * M_PI, 400 << (2 * level),
                  [&](const MaterialPoint &plain, auto &, double difference) {
                    worst = std::max(worst, difference);
                    scale = std::max(scale, size(stress_of(plain)));
                  });
      error[level] = worst / scale;
    }
    EXPECT_LT(error[1], 4e-5);
    EXPECT_GT(std::log2(error[0] / error[1]), 2 * 0.8) << error[0] << " " << error[1];
  }
}

TEST(Thermal, PlasticWorkHeats)
{
  const double rho = 7800, cp = 460, chi = 0.85;
  Point p(joined(J2, "thermal adiabatic ", cp, " 293 ", chi)), q(J2 + "thermal constant 293");
  for (MaterialPoint *point : {&p, &q}) shear(*point, 0.5, 1.0, 50);
  const double e = 0.5 - SIGMAY / (3 * G);
  EXPECT_NEAR(p.history(1), 293 + chi * SIGMAY * e / (rho * cp), 1e-11 * 293);
  EXPECT_NEAR(p.work[HEAT], chi * p.work[PLASTIC], 1e-12 * p.work[PLASTIC]);
  EXPECT_EQ(q.history(1), 293);
  EXPECT_EQ(q.work[HEAT], q.work[PLASTIC]);
}

// T = T0 exp(gamma (1 - J)) along an isentrope, in one step or many; small strain:
// dT = -gamma T0 eps_v, with gamma = 3 alpha K/(rho cp) the elastic cooling -0.570963 K of A7
TEST(Thermal, IsentropicCompression)
{
  const double K = 70e9 / (3 * (1 - 2 * 0.33)), gamma = 3 * 23e-6 * K / (2700 * 900);
  const auto material = make(
      joined("density 2700 eos linear ", K, " thermal adiabatic 900 293 0.9 gruneisen ", gamma));
  MaterialPoint p(*material);
  move_to(p, uniaxial_stretch(1 + 1e-3));
  EXPECT_NEAR(p.history(0) - 293, -0.570963, 1e-3);
  for (const int n : {1, 100})
    for (const double J : {0.2, 0.7, 1.3, 5.0}) {
      MaterialPoint q(*material);
      compress(q, J, n);
      EXPECT_NEAR(q.history(0), 293 * std::exp(gamma * (1 - J)), 1e-12 * 293);
    }
}

// at the melting temperature heat goes into the molten fraction, on cooling back
TEST(Thermal, HeatOfFusion)
{
  const double rho = 7800, cp = 500, latent = 1e4, melt = 320, gamma = 2;
  Point p(joined(J2, "thermal adiabatic ", cp, " 300 1 melt ", melt, " ", latent, " gruneisen ",
                 gamma));
  ASSERT_EQ(p.material.history().size(), 3u);
  double fraction = 0.0, T = 0.0;
  const auto expect = [&](double all, double tolerance) {    // temperature if there were no fusion
    fraction = std::min(std::max((all - melt) * cp / latent, 0.0), 1.0);
    T = all - fraction * latent / cp;
    EXPECT_NEAR(p.history(2), fraction, tolerance);
    EXPECT_NEAR(p.history(1), T, 1.0 * tolerance);
  };
  for (const double strain : {0.2, 0.1, 0.1, 0.1, 0.2}) {
    shear(p, strain, 1.0, 20);
    expect(300 + SIGMAY * p.history(0) / (rho * cp), 1e-9);
  }
  EXPECT_EQ(p.history(2), 1.0);
  // expansion cools until some of it is solid again: T falls to melt, then the fraction falls
  T = p.history(1);
  double all = T + latent / cp;
  for (int i = 0; i < 12; i++) {
    const double J = p.batch.J[0];
    moves(p, isotropic(1e-3), 1.0);
    all += T * std::expm1(-gamma * (p.batch.J[0] - J));
    expect(all, 1e-6);
  }
  EXPECT_LT(fraction, 0.9);
  EXPECT_GT(fraction, 0.0);
  // what is above the melting temperature at first is a melt
  const auto liquid = make("density 1 eos linear 1 thermal adiabatic 1 500 melt 400 1");
  double x[3] = {0.0, 0.0, 0.0}, history[2] = {500.0, 0.0};
  liquid->initialize(x, history);
  EXPECT_EQ(liquid->history()[1].name, "molten");
  EXPECT_EQ(history[0], 500.0);
  EXPECT_EQ(history[1], 1.0);
}

// all viscous work becomes heat, whatever CHI
TEST(Thermal, ViscousWorkHeats)
{
  Point p("density 1000 eos linear 1e9 viscosity newtonian 1000 thermal adiabatic 4000 300 0.9");
  const double rate = 1e3, time = 1e-3;
  steps(p, {0, 0.5 * rate, 0, 0.5 * rate, 0, 0, 0, 0, 0}, time / 10, 10);
  const double heat = 1000 * rate * rate * time;    // mu (2 D12)^2
  EXPECT_NEAR(p.work[VISCOUS], heat, 1e-12 * heat);
  EXPECT_NEAR(p.history(0) - 300, heat / (1000 * 4000), 1e-11);
}

/** Flow stress in MPa after shear at a rate, from the temperature of the file. */
double flow_stress(const std::string &name, double strain, double rate)
{
  Point p(definition(name));
  shear(p, strain, strain / rate, 200);
  return shear_stress(p) / MPa;
}

// fits of different laws by different people to the same metal agree where both were fitted
TEST(MaterialFiles, FitsOfTheSameMetalAgree)
{
  struct {
    const char *one, *other;
    double strain, rate, tolerance;
  } pairs[] = {{"Cu_OFHC_JC", "Cu_OFHC_ZA", 0.2, 1e3, 0.15},
               {"Iron_Armco_JC", "Iron_Armco_ZA", 0.2, 1e3, 0.2},
               {"Iron_Armco_JC", "Steel_1006_JC", 0.2, 1e3, 0.2},
               {"Al_6061_T6_JC", "Al_6061_T6_SCG", 0.1, 1e5, 0.2},
               {"W_alloy_JC", "W_alloy_SCG", 0.1, 1e5, 0.25},
               {"Cu_OFHC_JC", "Cu_OFHC_SCG", 0.3, 1e5, 0.35}};
  for (const auto &p : pairs) {
    const double a = flow_stress(p.one, p.strain, p.rate),
                 b = flow_stress(p.other, p.strain, p.rate);
    EXPECT_NEAR(a / b, 1.0, p.tolerance) << p.one << " " << a << " " << p.other << " " << b;
  }
}

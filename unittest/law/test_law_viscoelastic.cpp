// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit physics

// Laws that depend on the rate of strain: viscosity of fluids, and solids with damping or memory.

#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

const char *const SOLIDS[] = {"linear 1e6 0.3",
                              "neohookean 1e6 0.3",
                              "hencky 1e6 0.3",
                              "ogden 2e6 term 0.63e6 1.3 term 0.0012e6 5 term -0.01e6 -2",
                              "orthotropic 1e6 2e6 3e6 0.1 0.2 0.3 1e6 2e6 3e6 angle 30",
                              "eos linear 1e6 strength elastic 3e5",
                              "eos linear 1e6 strength j2 3e5 1e4"};

Matrix some_motion(double t)
{
  return {0.3, 1.2 * std::cos(3 * t), 0.2, 0.1, -0.4, 0.3 * std::sin(2 * t), 0.5 * t, -0.1, 0.2};
}

const Matrix STILL{};

// the sum of the elastic stress, which does not notice, and the viscous one
TEST(KelvinVoigt, AddsToAnyLaw)
{
  const double eta = 300, bulk = 500;
  for (const std::string solid : SOLIDS) {
    SCOPED_TRACE(solid);
    Point p("density 1000 " + solid),
        q("density 1000 " + solid + " viscosity newtonian 300 bulk 500");
    const double dt = 0.01;
    for (int i = 0; i < 200; i++) {
      const Matrix L = some_motion(i * dt);
      for (auto *point : {&p, &q}) steps(*point, L, dt);
      const double trace = L[0] + L[4] + L[8];
      Matrix sum = stress_of(p);
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          const double D = 0.5 * (L[3 * a + b] + L[3 * b + a]), mean = a == b ? trace / 3 : 0.0;
          sum[3 * a + b] += 2 * eta * (D - mean) + (a == b ? bulk * trace : 0.0);
        }
      ASSERT_LT(distance(stress_of(q), sum), 1e-12 * (i + 1) * (size(sum) + 1e4)) << i;
    }
    EXPECT_NEAR(q.stored_energy(), p.stored_energy(), 1e-10 * p.stored_energy());
    for (auto *point : {&p, &q}) steps(*point, STILL, dt);
    EXPECT_LT(distance(stress_of(q), stress_of(p)), 1e-10 * size(stress_of(p)));
  }
}

TEST(KelvinVoigt, InitialStressIsKept)
{
  Point p("density 1000 linear 1e6 0.3 viscosity newtonian 300");
  for (int k = 0; k < 6; k++) p.batch.stress[k][0] = 100.0 * (k + 1);
  steps(p, {0, 0.1, 0, 0.1, 0, 0, 0, 0, 0}, 1e-9);
  EXPECT_NEAR(p.stress(3), 400 + 2 * 300 * 0.1, 5e-4);
  EXPECT_NEAR(p.stress(4), 500, 1e-9);
  steps(p, STILL, 1e-9);
  EXPECT_NEAR(p.stress(3), 400, 5e-4);
}

// forced shear: loss angle tan(delta) = ETA omega / G, and the work of a cycle
TEST(KelvinVoigt, OscillatingShear)
{
  const double G = 1e6 / 2.6, eta = 2e4, omega = 7.0, g0 = 1e-4;
  for (const std::string solid : {"linear 1e6 0.3", "neohookean 1e6 0.3"}) {
    Point p("density 1000 " + solid + " viscosity newtonian 2e4");
    const int n = 2000;
    const double dt = 2 * M_PI / omega / n;
    double in_phase = 0.0, out_of_phase = 0.0;
    for (int i = 1; i <= n; i++) {
      const double dg = g0 * (std::sin(omega * i * dt) - std::sin(omega * (i - 1) * dt));
      steps(p, {0, dg / dt, 0, 0, 0, 0, 0, 0, 0}, dt);
      in_phase += 2.0 / n * p.stress(3) / g0 * std::sin(omega * i * dt);
      out_of_phase += 2.0 / n * p.stress(3) / g0 * std::cos(omega * i * dt);
    }
    EXPECT_NEAR(in_phase, G, 2e-3 * G);
    EXPECT_NEAR(out_of_phase, eta * omega, 1e-5 * eta * omega);
    const double cycle = M_PI * eta * omega * g0 * g0;
    EXPECT_NEAR(p.work[VISCOUS], cycle, 5e-6 * cycle);
  }
}

// h/c is the limit of explicit steps: an oscillator with the highest frequency of the lattice
TEST(KelvinVoigt, StableTimeStep)
{
  const double M = 1e6 * 0.7 / (1.3 * 0.4), rho = 1000, h = 0.1;
  for (const double eta : {10.0, 1e3, 1e5}) {
    Point p("density 1000 linear 1e6 0.3 viscosity newtonian " + std::to_string(eta) + " bulk 5", 1,
            h);
    for (const bool stable : {true, false}) {
      const double dt = (stable ? 0.999 : 1.001) * h / p.wave_speed();
      const double k2 = 4 / (h * h) / rho, damping = 4.0 / 3 * eta + 5;
      double strain = 1e-6, v = 0.0;
      for (int i = 0; i < 40000; i++) {
        v -= dt * k2 * (M * strain + damping * v);
        strain += dt * v;
      }
      EXPECT_EQ(std::fabs(strain) < 1e-5, stable) << eta;
    }
  }
}

const std::string FLUID = "density 1000 eos linear 1e6 viscosity maxwell ";

// large sudden shear: every component decays with its own time, at any time step
TEST(Maxwell, Relaxation)
{
  const double g = 2.0, G1 = 3e5, tau1 = 0.2, G2 = 1e5, tau2 = 0.05;
  const auto material = make(FLUID + "term 3e5 0.2 term 1e5 0.05");
  for (const double dt : {0.01, 0.3}) {
    MaterialPoint p(*material);
    move_to(p, {1, g, 0, 0, 1, 0, 0, 0, 1}, 1e-12);
    EXPECT_NEAR(p.stress(3), (G1 + G2) * g, 1e-9 * (G1 + G2) * g);
    const double stored = p.stored_energy();
    EXPECT_NEAR(stored, 0.5 * (G1 + G2) * g * g, 1e-9 * stored);    // neo-Hookean
    for (int i = 1; i <= 20; i++) {
      steps(p, STILL, dt);
      const double shear = g * (G1 * std::exp(-i * dt / tau1) + G2 * std::exp(-i * dt / tau2));
      EXPECT_NEAR(p.stress(3), shear, 1e-9 * shear + 1e-9);
      EXPECT_NEAR(p.stress(0) - p.stress(1), g * shear, 1e-9 * g * shear + 1e-9);
    }
    if (dt < 0.1) {
      while (p.time < 5.0) steps(p, STILL, dt);
      EXPECT_NEAR(p.work[VISCOUS], stored, 6e-3 * stored);    // all that was stored
    }
  }
}

// without relaxation: the neo-Hookean solid, stress and energy, at any motion
TEST(Maxwell, FastMotionIsNeoHookean)
{
  Point p(FLUID + "term 3e5 1e20"), q("density 1000 mooney/rivlin 1.5e5 0 1e6");
  for (int i = 0; i < 300; i++) {
    for (auto *point : {&p, &q}) steps(*point, some_motion(0.01 * i), 0.01);
    const double mean_p = -p.pressure(), mean_q = -q.pressure();
    for (int k = 0; k < 6; k++)
      ASSERT_NEAR(p.stress(k) - (k < 3) * mean_p, q.stress(k) - (k < 3) * mean_q,
                  1e-10 * (q.vonmises() + 1e5));
  }
  EXPECT_EQ(p.work[VISCOUS] < 1e-10 * p.stored_energy(), true);
}

// start of steady shear, upper convected Maxwell fluid (R.B. Bird, R.C. Armstrong, O. Hassager,
// Dynamics of Polymeric Liquids 1, 1987, ch. 7.2); order of convergence in the time step
TEST(Maxwell, StartOfSteadyShear)
{
  const double G = 3e5, tau = 0.2, rate = 8.0, eta = G * tau;    // Weissenberg number 1.6
  const auto material = make(FLUID + "term 3e5 0.2");
  const Matrix L = {0, rate, 0, 0, 0, 0, 0, 0, 0};
  const auto error = refined(50, [&](int n) {
    MaterialPoint p(*material);
    const double dt = 1.0 / n;
    double worst = 0.0;
    for (int i = 1; i <= n; i++) {
      steps(p, L, dt);
      const double s = i * dt / tau, decay = std::exp(-s);
      const double shear = eta * rate * (1 - decay);
      const double normal = 2 * eta * tau * rate * rate * (1 - decay * (1 + s));
      worst =
          std::max({worst, std::fabs(p.stress(3) - shear) / (eta * rate),
                    std::fabs(p.stress(0) - p.stress(1) - normal) / (2 * eta * tau * rate * rate)});
      EXPECT_NEAR(p.stress(1), p.stress(2), 1e-11 * eta * rate);    // no second difference
    }
    // in steady flow all power is dissipated
    const double before = p.work[VISCOUS];
    steps(p, L, dt, n);
    EXPECT_NEAR(p.work[VISCOUS] - before, eta * rate * rate, 2e-2 * eta * rate * rate);
    return worst;
  });
  EXPECT_LT(error[2], 1e-4);
  EXPECT_GT(std::log2(error[0] / error[2]), 2 * 1.9) << error[0] << " " << error[2];
}

// small strain at constant rate: exact for steps of any length, and a viscosity for long ones
TEST(Maxwell, ConstantRateIsExact)
{
  const double G = 3e5, tau = 0.2, rate = 1e-9;
  const auto material = make(FLUID + "term 3e5 0.2");
  for (const double dt : {1e-3, 0.1, 1.0, 1e6}) {
    MaterialPoint p(*material);
    for (int i = 1; i <= (dt > 1e3 ? 3 : 20); i++) {
      steps(p, {0, rate, 0, 0, 0, 0, 0, 0, 0}, dt);
      const double expected = G * tau * rate * -std::expm1(-i * dt / tau);
      // linear for a strain, within a relaxation time, of up to 1e-6
      EXPECT_NEAR(p.stress(3), expected, (1e-12 + 1e-8) * expected) << dt;
    }
  }
}

// storage and loss modulus of a Prony series with a solid
TEST(Maxwell, OscillatingShear)
{
  const double G0 = 1e6 / 2.6, G[2] = {3e5, 2e5}, tau[2] = {1.0, 0.02}, g0 = 1e-4;
  for (const std::string solid : {"linear 1e6 0.3", "hencky 1e6 0.3"}) {
    const auto material =
        make("density 1000 " + solid + " viscosity maxwell term 3e5 1 term 2e5 0.02");
    for (const double omega : {0.3, 1.0, 10.0, 50.0, 1000.0}) {
      MaterialPoint p(*material);
      const int n = 400, cycles = 2 + static_cast<int>(2 * omega);    // six relaxation times
      const double dt = 2 * M_PI / omega / n;
      double storage = 0.0, loss = 0.0, work = 0.0;
      for (int i = 1; i <= std::min(cycles, 60) * n; i++) {
        const double a = omega * i * dt, dg = g0 * (std::sin(a) - std::sin(a - omega * dt));
        steps(p, {0, dg / dt, 0, 0, 0, 0, 0, 0, 0}, dt);
        if (i <= (std::min(cycles, 60) - 1) * n) {
          work = p.work[VISCOUS];
          continue;
        }
        storage += 2.0 / n * p.stress(3) / g0 * std::sin(a);
        loss += 2.0 / n * p.stress(3) / g0 * std::cos(a);
      }
      double expected_storage = G0, expected_loss = 0.0;
      for (int k = 0; k < 2; k++) {
        const double x = omega * tau[k];
        expected_storage += G[k] * x * x / (1 + x * x);
        expected_loss += G[k] * x / (1 + x * x);
      }
      EXPECT_NEAR(storage, expected_storage, 8e-5 * expected_storage) << omega;
      EXPECT_NEAR(loss, expected_loss, 2e-5 * expected_storage) << omega;
      const double cycle = M_PI * expected_loss * g0 * g0;
      EXPECT_NEAR(p.work[VISCOUS] - work, cycle, 5e-7 * cycle) << omega;
    }
  }
}

// stable and dissipative where a step is much longer than the relaxation time, or shorter
TEST(Maxwell, AnyTimeStep)
{
  for (const char *tau : {"1e-12", "1e-3", "1", "1e12"}) {
    Point p(FLUID + "term 3e5 " + tau);
    for (int i = 0; i < 12; i++) {
      steps(p, some_motion(0.1 * i), 0.5);
      expect_finite(p);
      ASSERT_GE(p.stored_energy(), 0.0) << tau;
      ASSERT_GE(p.batch.work[VISCOUS], 0.0) << tau;
    }
  }
}

// what an element has stored becomes heat when it relaxes, in many steps or in one
TEST(Maxwell, DissipatesWhatItHasStored)
{
  const auto material = make("density 1000 neohookean 1e5 0.45 viscosity maxwell term 5e4 1e-3");
  for (const int n : {1, 10, 1000}) {
    MaterialPoint p(*material);
    move_to(p, {1, 1e-3, 0, 0, 1, 0, 0, 0, 1}, 1e-9);
    const double stored = p.stored_energy(), viscous = p.work[VISCOUS];
    steps(p, STILL, 0.02 / n, n);
    EXPECT_NEAR(stored - p.stored_energy(), 0.5 * 5e4 * 1e-6, 4e-6 * stored) << n;
    // in steps as long as the relaxation time the rule of integration shows
    EXPECT_NEAR(p.work[VISCOUS] - viscous, 0.5 * 5e4 * 1e-6, (n == 10 ? 0.2 : 1e-3) * stored) << n;
  }
}

// a rotation on top of the motion turns the stress and changes nothing else
TEST(Maxwell, Objectivity)
{
  const auto material = make("density 1000 hencky 1e6 0.3 viscosity maxwell term 3e5 0.2");
  const auto shear = [](double t) {
    return Matrix{1 + 0.3 * t, 2 * t, 0, 0, 1, -t, 0, 0, 1 - 0.4 * t};
  };
  expect_objective(*material, shear, 30.0, 1e-11,
                   [](const MaterialPoint &plain, const MaterialPoint &turned) {
                     const double work = plain.work[VISCOUS];
                     EXPECT_NEAR(turned.work[VISCOUS], work, 1e-11 * work);
                   });
}

// the instantaneous modulus, and a step that is stable for any relaxation time
TEST(Maxwell, WaveSpeed)
{
  for (const char *tau : {"1e-9", "1e-3", "1e9"}) {
    Point p(joined("density 1000 linear 1e6 0.25 viscosity maxwell term 4e5 ", tau));
    EXPECT_NEAR(p.wave_speed(), std::sqrt((1.2e6 + 4.0 / 3 * 4e5) / 1000), 1e-9);
  }
  // never slower than the solid that it becomes in fast motion, at large strain too
  for (const Matrix &F :
       {diagonal(4, 0.5, 0.5), diagonal(0.25, 2, 2), Matrix{1, 3, 0, 0, 1, 0, 0, 0, 1}}) {
    Point p(FLUID + "term 3e5 1e20"), q("density 1000 mooney/rivlin 1.5e5 0 1e6");
    for (auto *point : {&p, &q}) move_to(*point, F);
    EXPECT_GE(p.wave_speed(), (1 - 1e-6) * q.wave_speed());
    // parts add up their fastest waves, which need not be the same
    EXPECT_LE(p.wave_speed(), 1.3 * q.wave_speed());
  }
}

/** Equivalent shear stress of a fluid in simple shear, and in a mixed flow, of the same rate. */
struct Flow {
  double shear, mixed, viscous, apparent;
};

Flow flow(const Material &material, double rate, double dt = 1e-9)
{
  Flow f;
  MaterialPoint p(material), q(material);
  steps(p, {0, rate, 0, 0, 0, 0, 0, 0, 0}, dt);
  f.shear = p.stress(3);
  f.viscous = p.work[VISCOUS] / dt;
  f.apparent = p.history(0);
  // plane extension, turned, with spin: sqrt(2 D:D) is the rate
  const double e = 0.3 * rate, s = 0.4 * rate, w = 7.0 * rate;
  steps(q, {e, s + w, 0, s - w, -e, 0, 0, 0, 0}, dt);
  f.mixed = q.vonmises() / std::sqrt(3.0);
  return f;
}

// flow curves over fourteen decades of the rate

void expect_curve(const std::string &text, const std::function<double(double)> &tau)
{
  SCOPED_TRACE(text);
  const auto material = make("density 1000 eos linear 1e9 viscosity " + text);
  for (double rate = 1e-6; rate < 2e8; rate *= 3.0) {
    const double dt = 1e-4 / rate, expected = tau(rate);
    const Flow f = flow(*material, rate, dt);
    EXPECT_NEAR(f.shear, expected, 1e-8 * expected) << "rate " << rate;
    EXPECT_NEAR(f.mixed, expected, 1e-6 * expected) << "rate " << rate;
    EXPECT_NEAR(f.viscous, expected * rate, 1e-8 * expected * rate) << "rate " << rate;
    EXPECT_NEAR(f.apparent, expected / rate, 1e-8 * expected / rate) << "rate " << rate;
  }
}

struct Fluid {
  double k, n, yield, limit;    ///< consistency, exponent, yield stress, viscosity at rest
};

TEST(FlowCurve, WithAYieldStress)
{
  for (const Fluid &f : {Fluid{0.5, 1, 20, 1000},
                         {0, 1, 20, 1000},
                         {0.5, 1, 0, 1000},
                         {3, 0.4, 20, 1000},
                         {3, 0.4, 0, 1000},
                         {3, 1.5, 20, 1e9}})
    expect_curve(joined(f.n == 1 ? "bingham " : "herschel/bulkley ", f.k, " ",
                        f.n == 1 ? "" : joined(f.n, " "), f.yield, " ", f.limit),
                 [&](double g) {
                   return std::min(f.limit * g, f.yield + f.k * std::pow(g, f.n));
                 });
}

TEST(FlowCurve, PowerLaw)
{
  struct {
    double n, low;
  } fluids[] = {{0.6, 1e-2}, {1.4, 1e-2}, {1, 0}};
  for (const auto &f : fluids)
    expect_curve(joined("power 2 ", f.n, " ", f.low, " 1e2"), [&](double g) {
      return g * std::min(std::max(2 * std::pow(g, f.n - 1), f.low), 1e2);
    });
}

// below yield next to nothing moves; beyond yield the stress is on the surface
TEST(Yield, StressStaysBelowTheYieldStress)
{
  const auto material = make("density 1000 eos linear 1e9 viscosity bingham 0.5 20 1e5");
  const double critical = 20 / (1e5 - 0.5);
  EXPECT_LT(flow(*material, 0.999 * critical).shear, 20 * 1.00001);
  EXPECT_NEAR(flow(*material, 1.001 * critical).shear, 20, 0.001);
}

TEST(Rest, NothingMovesNothingHeats)
{
  for (const char *text : {"newtonian 1 bulk 1", "bingham 0.5 20 1000", "power 2 0.6 1e-2 1e2",
                           "herschel/bulkley 3 0.4 0 1000", "artificial 1.5 0.06"})
    for (const double dt : {0.0, 1e-3}) {
      Point p(std::string("density 1000 eos linear 1e9 viscosity ") + text);
      move_to(p, IDENTITY, dt);
      EXPECT_EQ(size(stress_of(p)), 0.0) << text;
      EXPECT_EQ(p.work[VISCOUS], 0.0) << text;
      EXPECT_TRUE(std::isfinite(p.wave_speed())) << text;
    }
}

// a rigid turn has no rate, whatever its speed
TEST(Rest, RotationIsNoFlow)
{
  Point p("density 1000 eos linear 1e9 viscosity bingham 0.5 20 1000");
  for (int i = 1; i <= 20; i++) {
    move_to(p, rotation(AXIS, 0.7 * i), 1e-3);
    EXPECT_LT(p.vonmises(), 1e-8);
  }
}

TEST(Newtonian, BulkViscosity)
{
  Point p("density 1000 eos linear 1e9 viscosity newtonian 2 bulk 5"),
      q("density 1000 eos linear 1e9");
  for (auto *point : {&p, &q}) steps(*point, {-3, 1, 0, 1, 1, 0, 0, 0, 0.5}, 1e-6);
  const double tr = -1.5;
  EXPECT_NEAR(p.pressure() - q.pressure(), -5 * tr, 1e-11);
  EXPECT_NEAR(p.stress(3), 2 * 2 * 1.0, 1e-11);
  EXPECT_NEAR(p.stress(0) - p.stress(1), 2 * 2 * (-4.0), 1e-10);
  const double D2 = 9 + 1 + 0.25 + 2 - tr * tr / 3;
  EXPECT_NEAR(p.work[VISCOUS] / 1e-6, 2 * 2 * D2 + 5 * tr * tr, 1e-4);
}

// h/c is the central-difference limit of a damped wave, a = (4/3 mu + zeta)/(density h)
TEST(StableStep, FollowsTheApparentViscosity)
{
  const double rho = 1000, h = 0.01, c0 = std::sqrt(1e6 / rho);
  const auto limit = [&](double viscosity) {
    const double a = viscosity / (rho * h);
    return std::sqrt(c0 * c0 + a * a) + a;
  };
  const auto speed = [&](const std::string &text, double rate) {
    Point p("density 1000 eos linear 1e6 viscosity " + text, 1, h);
    if (rate > 0.0) steps(p, {0, rate, 0, 0, 0, 0, 0, 0, 0}, 1e-9);
    return p.wave_speed();
  };
  EXPECT_NEAR(speed("newtonian 200 bulk 100", 0), limit(4.0 / 3 * 200 + 100), 1e-9);
  EXPECT_NEAR(speed("bingham 5 1000 400", 0), limit(4.0 / 3 * 400), 1e-9);
  EXPECT_NEAR(speed("bingham 5 1000 400", 10), limit(4.0 / 3 * 105), 1e-10);
  EXPECT_NEAR(speed("herschel/bulkley 3 0.5 1000 400", 100), limit(4.0 / 3 * 10.3), 1e-10);
  EXPECT_NEAR(speed("power 3 0.5 0.1 400", 100), limit(4.0 / 3 * 0.3), 1e-10);
  // thickening: the slope of the flow curve counts
  EXPECT_NEAR(speed("power 3 2 0.1 4000", 100), limit(4.0 / 3 * 2 * 300), 1e-9);
}

TEST(Extremes, AreFinite)
{
  for (const char *text : {"newtonian 1 bulk 1", "bingham 0.5 20 1000", "power 2 0.6 1e-2 1e2",
                           "herschel/bulkley 3 0.4 0 1000", "herschel/bulkley 3 3 1e9 1e12"})
    for (const double rate : {1e-6, 1.0, 1e8})
      for (const double strain : {1e-12, 0.1, 1.0}) {
        Point p(std::string("density 1000 eos tait 1e9 7 viscosity ") + text, 1, 1e-3);
        moves(p, {0.3 * strain, strain, 0, 0.2 * strain, -0.4 * strain, 0, 0, strain, 0},
              strain / rate);
        expect_finite(p);
        EXPECT_GE(p.work[VISCOUS], 0.0);
      }
}

TEST(Definition, BadInputIsRefused)
{
  expect_refused({{"density 1 eos linear 1 viscosity bingham 1 1 1", "MUMAX must be above MU"},
                  {"density 1 eos linear 1 viscosity bingham 1 1", "MUMAX is missing"},
                  {"density 1 eos linear 1 viscosity power 1 1 2 1", "must not be below MUMIN"},
                  {"density 1 eos linear 1 viscosity herschel/bulkley 1 0 0 1", "N = 0"},
                  {"density 1 eos linear 1 viscosity newtonian 1 bulk -1", "ZETA = -1"}});
}

// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// Viscosities of fluids, point by point: flow curves, yield, dissipation, stable time step.

#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

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
  EXPECT_NEAR(p.pressure() - q.pressure(), -5 * tr, 1e-6);
  EXPECT_NEAR(p.stress(3), 2 * 2 * 1.0, 1e-9);
  EXPECT_NEAR(p.stress(0) - p.stress(1), 2 * 2 * (-4.0), 1e-8);
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
  EXPECT_NEAR(speed("bingham 5 1000 400", 10), limit(4.0 / 3 * 105), 1e-6);
  EXPECT_NEAR(speed("herschel/bulkley 3 0.5 1000 400", 100), limit(4.0 / 3 * 10.3), 1e-6);
  EXPECT_NEAR(speed("power 3 0.5 0.1 400", 100), limit(4.0 / 3 * 0.3), 1e-6);
  // thickening: the slope of the flow curve counts
  EXPECT_NEAR(speed("power 3 2 0.1 4000", 100), limit(4.0 / 3 * 2 * 300), 1e-6);
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

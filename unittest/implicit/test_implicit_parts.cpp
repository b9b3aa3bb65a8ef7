// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Parts of implicit steps and of relaxation that need neither points nor nodes: methods of time
// integration, kinetic damping, and the mean deformation of a periodic cell.

#include "implicit/mpm_kinetic_damping.h"
#include "implicit/mpm_mean_deformation.h"
#include "implicit/mpm_time_method.h"

#include "gtest/gtest.h"

#include <cmath>

using namespace LAMMPS_NS;

struct Oscillator {
  double x = 1.0, v = 0.0, a = 0.0;
};

/** A step of duration dt of an oscillator with the frequency w and the mass 1. */
static void step(const MPMTimeMethod &method, double w, double dt, Oscillator &at)
{
  const auto with = method.coefficients();
  const double f0 = -w * w * at.x, c = method.inertia_factor(dt), end = method.force_share(),
               s = method.displacement_share();
  if (method.kind == MPMTimeMethod::NEWMARK) at.a = f0;
  double predictor = dt * at.v;
  if (method.uses_acceleration()) predictor += with.predictor_factor(dt) * at.a;
  // c (u - u*) = end f(x + s u) + (1 - end) f0
  const double u = (c * predictor + f0) / (c + end * s * w * w), pull = c * (u - predictor);
  at.x += u;
  if (method.kind == MPMTimeMethod::EULER) {
    at.v = u / dt;
  } else if (method.kind == MPMTimeMethod::MIDPOINT) {
    at.v = 2.0 * u / dt - at.v;
  } else {
    const double a1 = with.end_acceleration(pull, at.a);
    at.v += with.velocity_change(dt, at.a, a1);
    at.a = a1;
  }
}

/** Error of the position after a quarter more than a period, in n steps. */
static double error(const MPMTimeMethod &method, int n)
{
  const double w = 2.0, time = 4.0, dt = time / n;
  Oscillator at;
  at.a = -w * w;
  for (int k = 0; k < n; k++) step(method, w, dt, at);
  return std::fabs(at.x - std::cos(w * time));
}

/** What is left in a step of an oscillation that is much faster. */
static double left_of_fast_ones(const MPMTimeMethod &method)
{
  const double w = 1.0e4;
  Oscillator at;
  at.a = -w * w;
  const auto size = [&]() {
    return std::hypot(std::hypot(at.x, at.v), at.a / (w * w));
  };
  for (int k = 0; k < 100; k++) step(method, w, 1.0, at);
  const double before = size();
  for (int k = 0; k < 100; k++) step(method, w, 1.0, at);
  return std::pow(size() / before, 0.01);
}

TEST(TimeMethod, OrderOfAccuracy)
{
  struct {
    MPMTimeMethod method;
    double order;
  } const cases[] = {
      {{MPMTimeMethod::EULER, 0.5, 0.8}, 1.0},   {{MPMTimeMethod::NEWMARK, 0.5, 0.8}, 2.0},
      {{MPMTimeMethod::NEWMARK, 0.6, 0.8}, 1.0}, {{MPMTimeMethod::MIDPOINT, 0.5, 0.8}, 2.0},
      {{MPMTimeMethod::ALPHA, 0.5, 0.6}, 2.0},   {{MPMTimeMethod::HHT, 0.5, 0.8}, 2.0}};
  for (const auto &one : cases)
    EXPECT_NEAR(std::log2(error(one.method, 400) / error(one.method, 800)), one.order, 0.1)
        << one.method.kind << " " << one.method.gamma;
}

TEST(TimeMethod, MidpointAndNewmarkKeepTheEnergy)
{
  for (const auto kind : {MPMTimeMethod::NEWMARK, MPMTimeMethod::MIDPOINT}) {
    const MPMTimeMethod method{kind, 0.5, 0.8};
    const double w = 3.0;
    Oscillator at;
    at.a = -w * w;
    for (int k = 0; k < 1000; k++) step(method, w, 0.4, at);
    EXPECT_NEAR(at.v * at.v + w * w * at.x * at.x, w * w, 1.0e-10) << kind;
  }
}

TEST(TimeMethod, AlphaLeavesRhoOfTheHighestFrequencies)
{
  for (const double rho : {0.2, 0.6, 0.9})
    EXPECT_NEAR(left_of_fast_ones({MPMTimeMethod::ALPHA, 0.5, rho}), rho, 0.03 * rho);
  for (const double rho : {0.5, 0.8})
    EXPECT_NEAR(left_of_fast_ones({MPMTimeMethod::HHT, 0.5, rho}), rho, 0.03 * rho);
}

TEST(TimeMethod, StaticsHaveNoInertia)
{
  const MPMTimeMethod method;
  EXPECT_TRUE(method.is_static());
  EXPECT_EQ(method.inertia_factor(0.1), 0.0);
  EXPECT_EQ(method.force_share(), 1.0);
  EXPECT_EQ(method.end_velocity_share(), 1.0);
}

/** Two oscillators that share their energy come to rest in some hundred steps. */
TEST(KineticDamping, BringsModesToRest)
{
  const double w[2] = {1.0, 3.3}, dt = 0.1;
  double x[2] = {1.0, 0.4}, v[2] = {0.0, 0.0};
  MPMKineticDamping damping;
  for (int step = 0; step < 200; step++) {
    for (int i = 0; i < 2; i++) v[i] -= dt * w[i] * w[i] * x[i];
    const bool falls = damping.advance(0.5 * (v[0] * v[0] + v[1] * v[1]));
    for (int i = 0; i < 2; i++) x[i] += dt * v[i];
    if (!falls) continue;
    v[0] = v[1] = 0.0;
    damping.rest();
  }
  EXPECT_LT(std::fabs(x[0]) + std::fabs(x[1]), 1.0e-5);
  EXPECT_EQ(damping.nsteps, 200.0);
  EXPECT_EQ(damping.grows, 0.0);
}

/** A mode with omega dt = 1.2 passes its maximum too far away, and needs starts by half. */
TEST(KineticDamping, FastModeAlone)
{
  double x = 1.0, v = 0.0, most = 0.0;
  MPMKineticDamping damping;
  for (int step = 0; step < 400; step++) {
    const bool half = damping.starts_by_half();
    v -= (half ? 0.5 : 1.0) * 1.2 * 1.2 * x;
    const bool falls = damping.advance(0.5 * v * v);
    x += v;
    most = std::fmax(most, std::fabs(x));
    if (!falls) continue;
    v = 0.0;
    damping.rest();
  }
  EXPECT_GT(most, 2.0);
  EXPECT_EQ(damping.grows, 1.0);
  EXPECT_LT(std::fabs(x), 1.0e-12);
}

TEST(MeanDeformation, FollowsStrains)
{
  using M = MPMMeanDeformation;
  const M::Drive drive[6] = {M::ERATE, M::TRATE, M::STRAIN, M::HELD, M::ERATE, M::HELD};
  const double wanted[6] = {0.1, -0.2, 0.05, 7.0, 0.3, 7.0}, none[9] = {};
  M cell;
  for (int k = 0; k < 10; k++) {
    EXPECT_EQ(cell.advance(0.1, drive, wanted, 1.0), -1);
    cell.end_step(none, none);
  }
  const double F[9] = {1.1, 0.0, 0.3, 0.0, std::exp(-0.2), 0.0, 0.0, 0.0, 1.05};
  for (int c = 0; c < 9; c++) EXPECT_NEAR(cell.past.F[c], F[c], 1.0e-14) << c;
  const double too_much[6] = {-20.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(cell.advance(0.1, drive, too_much, 1.0), 0);
}

/** A linear bar that is pulled by a stress comes to it without a coefficient of damping. */
TEST(MeanDeformation, ComesToAStress)
{
  using M = MPMMeanDeformation;
  const M::Drive drive[6] = {M::STRESS, M::HELD, M::HELD, M::HELD, M::HELD, M::HELD};
  const double E = 1.0e6, wanted[6] = {1.0e4, 0.0, 0.0, 0.0, 0.0, 0.0};
  M cell;
  double work = 0.0;
  for (int k = 0; k < 400; k++) {
    ASSERT_EQ(cell.advance(1.0e-4, drive, wanted, 1.0), -1);
    const double F = cell.next[0], tau[6] = {E * (F - 1.0)}, P[9] = {E * (F - 1.0) / F};
    work += cell.end_step(tau, P);
  }
  EXPECT_NEAR(cell.stress(0), 1.0e4, 1.0e-5);
  // integral of E (F - 1)/F
  const double F = cell.past.F[0];
  EXPECT_NEAR(work, E * (F - 1.0 - std::log(F)), 1.0e-4 * work);
}

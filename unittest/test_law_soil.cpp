// labels: unit physics
/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Laws of soil, rock and snow at a single point: strength in the tests of a soil laboratory, flow,
// critical states, and what holds for all of them.

#include "material_testing.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

using namespace MPM_NS;
using namespace material_testing;

namespace {

constexpr double DEG = M_PI / 180.0;

/* ---------------------------------------------------------------------- laboratory tests */

/** One step with an axial rate along x and lateral rates along y (and z, unless that is held) such
 *  that the stress along y is the given one. */
void step_lateral(MaterialPoint &p, double axial, double lateral_stress, double dt,
                  bool plane = false)
{
  const auto motion = [&](double rate) {
    return Matrix{axial, 0, 0, 0, rate, 0, 0, 0, plane ? 0.0 : rate};
  };
  const auto residual = [&](double rate) {
    MaterialPoint trial(p);
    trial.step(motion(rate).data(), dt);
    return trial.stress(1) - lateral_stress;
  };
  const double size = std::fabs(axial) + 1e-300;
  double low = -5.0 * size, high = 5.0 * size, f_low = residual(low), f_high = residual(high);
  ASSERT_LT(f_low, 0.0);
  ASSERT_GT(f_high, 0.0);
  double rate = 0.0;
  for (int it = 0; it < 200 && high - low > 1e-16 * size; it++) {    // regula falsi (Illinois)
    rate = it % 4 == 3 ? 0.5 * (low + high) : low - f_low * (high - low) / (f_high - f_low);
    const double f = residual(rate);
    if (std::fabs(f) <= 1e-13 * std::fabs(lateral_stress)) break;
    if (f < 0.0) {
      low = rate;
      f_low = f;
      if (it % 2) f_high *= 0.5;
    } else {
      high = rate;
      f_high = f;
      if (it % 2) f_low *= 0.5;
    }
  }
  p.step(motion(rate).data(), dt);
}

/** Isotropic compression until the Cauchy pressure is reached. */
void consolidate(MaterialPoint &p, double pressure, int n = 20)
{
  const MaterialPoint start(p);
  const auto compress = [&](double strain) {
    MaterialPoint q(start);
    const Matrix L = {-strain / 3, 0, 0, 0, -strain / 3, 0, 0, 0, -strain / 3};
    for (int i = 0; i < n; i++) q.step(L.data(), 1.0 / n);
    return q;
  };
  double low = 0.0, high = 1e-6;
  while (compress(high).pressure() < pressure) high *= 2.0;
  for (int it = 0; it < 100; it++) {
    const double half = 0.5 * (low + high);
    (compress(half).pressure() < pressure ? low : high) = half;
  }
  const Matrix L = {-high / 3, 0, 0, 0, -high / 3, 0, 0, 0, -high / 3};
  for (int i = 0; i < n; i++) p.step(L.data(), 1.0 / n);
  EXPECT_NEAR(p.pressure(), pressure, 1e-9 * pressure);
}

int row(const Material &material, const std::string &name)
{
  for (size_t k = 0; k < material.history().size(); k++)
    if (material.history()[k].name == name) return k;
  ADD_FAILURE() << "no history " << name;
  return 0;
}

double value(const MaterialPoint &p, const std::string &name)
{
  return p.history(row(p.material, name));
}

/** Kirchhoff pressure and equivalent stress. */
double pressure(const MaterialPoint &p)
{
  return p.pressure() * p.batch.J[0];
}
double shear(const MaterialPoint &p)
{
  return p.vonmises() * p.batch.J[0];
}

/* ---------------------------------------------------------------------- all laws */

const char *const all[] = {
    "density 1600 drucker/prager 1e6 0.3 30",
    "density 1600 drucker/prager 1e6 0.3 35 cohesion 2e4 dilatancy 10 tension 5e3 plane",
    "density 1900 mohr/coulomb 1e6 0.3 30 1e4 dilatancy 10",
    "density 1900 mohr/coulomb 1e6 0.3 30 3e4 residual 1e4 20 20",
    "density 1900 mohr/coulomb 1e6 0.3 0 1e4",
    "density 1500 mui 1e6 0.3 0.38 0.64 0.3 1e-3",
    "density 400 snow 1.4e5 0.2 0.025 0.0075 5",
    "density 1900 camclay 5e6 0.9 0.2 0.04 0 1e5 1.5e5",
    "density 1900 camclay 5e6 0.9 0.2 0.02 1.0 1e5 8e5",
    "density 250 nacc 1e6 0.3 1.85 0.3 3 -0.05",
    "density 250 nacc 1e6 0.3 1.85 1 30 -0.005",
};

// the trial state follows any rotation exactly: same stress, history, work
TEST(SoilLaws, RotationOnTopOfShear)
{
  const std::array<double, 3> axis = {0.48, 0.6, 0.64};
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    MaterialPoint plain(*material), turned(*material);
    for (int i = 1; i <= 50; i++) {
      const double t = 0.02 * i;
      const Matrix F = {1 - 0.3 * t, 0.8 * t, 0, 0, 1 + 0.1 * t, 0, 0, 0, 1 - 0.05 * t};
      const Matrix R = rotation(axis, 12.6 * t);
      move_to(plain, F, 0.02);
      move_to(turned, R * F, 0.02);
      const Matrix expected = R * stress_of(plain) * transpose(R);
      EXPECT_LT(distance(stress_of(turned), expected), 1e-9 * size(expected));
      EXPECT_NEAR(turned.stored_energy(), plain.stored_energy(), 1e-9 * plain.stored_energy());
      for (size_t k = 6; k < material->history().size(); k++)
        EXPECT_NEAR(turned.history(k), plain.history(k), 1e-10 * (1 + std::fabs(plain.history(k))));
    }
  }
}

// steps of any size and direction: finite, and dissipation is never negative
TEST(SoilLaws, LargeSteps)
{
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    for (const double scale : {1e-8, 1e-4, 1e-2, 0.1, 1.0})
      for (const double dt : {1e-8, 1.0, 1e6})
        for (int repeat = 0; repeat < 20; repeat++) {
          MaterialPoint p(*material);
          double grown;
          for (int i = 0; i < 6; i++) {
            Matrix A;
            do {
              for (double &x : A) x = 0.4 * scale * normal(random);
              Matrix f = A;
              for (int k = 0; k < 9; k += 4) f[k] += 1.0;
              grown = det(f);
            } while (grown < 0.2);
            if (p.batch.J[0] * grown < 0.02 || p.batch.J[0] * grown > 50) break;
            p.move(A.data(), dt);

            ASSERT_TRUE(std::isfinite(p.vonmises()) && std::isfinite(p.pressure()))
                << "strain " << scale << " dt " << dt;
            ASSERT_TRUE(std::isfinite(p.wave_speed()) && p.wave_speed() >= 0.0);
            ASSERT_TRUE(std::isfinite(p.stored_energy()));
            for (size_t k = 0; k < material->history().size(); k++)
              ASSERT_TRUE(std::isfinite(p.history(k))) << material->history()[k].name;
            if (!strstr(text, "snow")) ASSERT_GE(p.batch.work[PLASTIC], 0.0);
          }
        }
  }
}

/* ---------------------------------------------------------------------- Drucker-Prager */

// equal to Mohr-Coulomb in triaxial compression, sigma_1 = N sigma_3 + 2 c sqrt(N), and there the
// volume grows by M_psi per shear strain
TEST(DruckerPrager, TriaxialCompression)
{
  for (const double c : {0.0, 2e4})
    for (const double psi : {0.0, 12.0}) {
      const double phi = 33.0, s = std::sin(phi * DEG), N = (1 + s) / (1 - s), confining = 1e5;
      const auto material = make("density 1600 drucker/prager 5e7 0.25 33 cohesion " +
                                 std::to_string(c) + " dilatancy " + std::to_string(psi));
      MaterialPoint p(*material);
      consolidate(p, confining);
      EXPECT_EQ(value(p, "eplastic"), 0.0);
      for (int i = 0; i < 40; i++) step_lateral(p, -1e-3, -confining, 1.0);
      const double J = p.batch.J[0];
      EXPECT_NEAR(-p.stress(0), N * confining + 2 * c / J * std::sqrt(N), 1e-9 * N * confining);
      const double e0 = value(p, "eplastic"), t = std::sin(psi * DEG);
      const auto plastic_volume = [&]() {
        return std::log(p.batch.J[0]) + pressure(p) * 3 * 0.5 / 5e7;
      };
      const double before = plastic_volume();
      step_lateral(p, -1e-3, -confining, 1.0);
      EXPECT_NEAR((plastic_volume() - before) / (value(p, "eplastic") - e0), 6 * t / (3 - t), 1e-9);
      EXPECT_EQ(value(p, "gap"), 0.0);
    }
}

// with "plane" the same in plane strain, whatever the dilatancy angle
TEST(DruckerPrager, PlaneStrainCompression)
{
  for (const double c : {0.0, 2e4})
    for (const double psi : {0.0, 12.0, 33.0}) {
      const double s = std::sin(33.0 * DEG), N = (1 + s) / (1 - s), confining = 1e5;
      const auto material =
          make("density 1600 drucker/prager 5e7 0.25 33 cohesion " + std::to_string(c) +
               " dilatancy " + std::to_string(psi) + " plane");
      MaterialPoint p(*material);
      consolidate(p, confining);
      for (int i = 0; i < 60; i++) step_lateral(p, -1e-3, -confining, 1.0, true);
      const double J = p.batch.J[0];
      EXPECT_NEAR(-p.stress(0), N * confining + 2 * c / J * std::sqrt(N), 1e-3 * N * confining);
      const double x = std::log(p.batch.F[0][0]), y = std::log(p.batch.F[4][0]);
      step_lateral(p, -1e-3, -confining, 1.0, true);
      const double dx = std::log(p.batch.F[0][0]) - x, dy = std::log(p.batch.F[4][0]) - y;
      EXPECT_NEAR((dx + dy) / (dy - dx), std::sin(psi * DEG), 0.01);    // elastic part
    }
}

// sand without cohesion: separated grains feel nothing until they have closed up again
TEST(DruckerPrager, SeparatedSandDoesNotGainVolume)
{
  const double K = 1e6 / (3 * 0.4);
  const auto material = make("density 1600 drucker/prager 1e6 0.3 30");
  MaterialPoint p(*material);
  const double a = 0.1;
  for (int i = 1; i <= 20; i++) {
    const double F = 1 + a * i / 20;
    move_to(p, {F, 0.3 * i / 20, 0, 0, F, 0, 0, 0, F});
    EXPECT_NEAR(p.vonmises() + std::fabs(p.pressure()), 0.0, 1e-6);
    EXPECT_NEAR(value(p, "gap"), 3 * std::log(F), 1e-12);
  }
  for (int i = 19; i >= 1; i--) {
    const double F = 1 + a * i / 20;
    move_to(p, {F, 0.3 * i / 20, 0, 0, F, 0, 0, 0, F});
    EXPECT_NEAR(p.vonmises() + std::fabs(p.pressure()), 0.0, 1e-6);
  }
  move_to(p, {1.001, 0, 0, 0, 1.001, 0, 0, 0, 1.001});
  move_to(p, {0.998, 0, 0, 0, 0.998, 0, 0, 0, 0.998});
  EXPECT_NEAR(pressure(p), -3 * K * std::log(0.998), 1e-9 * K);
  EXPECT_NEAR(value(p, "gap"), 0.0, 1e-15);
  EXPECT_NEAR(p.work[PLASTIC], 0.0, 1e-7 * K);
}

// tension: to the apex c cot(phi) of the cone, or to the cutoff; opening dissipates, closing does not
TEST(DruckerPrager, Tension)
{
  const double c = 2e4, phi = 35 * DEG;
  struct {
    const char *text;
    double limit;
  } cases[] = {{"", c / std::tan(phi)}, {" tension 5e3", 5e3}, {" tension 1e6", c / std::tan(phi)}};
  for (const auto &k : cases) {
    const auto material =
        make(std::string("density 1600 drucker/prager 1e7 0.3 35 cohesion 2e4") + k.text);
    MaterialPoint p(*material);
    for (int i = 1; i <= 100; i++) {
      const double F = 1 + 1e-3 * i;
      move_to(p, {F, 0, 0, 0, F, 0, 0, 0, F});
    }
    EXPECT_NEAR(-pressure(p), k.limit, 1e-9 * k.limit) << k.text;
    const double gap = value(p, "gap"), K = 1e7 / 1.2;
    EXPECT_NEAR(gap, 3 * std::log(1.1) - k.limit / K, 1e-12);
    EXPECT_NEAR(p.work[PLASTIC], k.limit * gap, 0.01 * k.limit * gap);
    const double work = p.work[PLASTIC];
    for (int i = 99; i >= 0; i--) {
      const double F = 1 + 1e-3 * i;
      move_to(p, {F, 0, 0, 0, F, 0, 0, 0, F});
    }
    EXPECT_NEAR(p.work[PLASTIC], work, 1e-9 * work);
    EXPECT_NEAR(p.pressure(), 0.0, 1e-6);
  }
}

TEST(DruckerPrager, ReturnEndsOnTheYieldSurface)
{
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const double s = std::sin(35 * DEG), M = 6 * s / (3 - s),
               k = 6 * 2e4 * std::cos(35 * DEG) / (3 - s);
  const auto material =
      make("density 1600 drucker/prager 1e7 0.3 35 cohesion 2e4 dilatancy 20 tension 1e4");
  int cone = 0, plane = 0, corner = 0;
  for (const double scale : {1e-4, 1e-3, 1e-2, 0.1, 1.0})
    for (int repeat = 0; repeat < 100; repeat++) {
      MaterialPoint p(*material);
      for (int i = 0; i < 3; i++) {
        Matrix A;
        for (double &x : A) x = (repeat % 2 ? 0.2 : 0.02) * scale * normal(random);
        if (repeat % 4 == 0)
          for (int d = 0; d < 9; d += 4) A[d] += 0.1 * scale;
        p.move(A.data(), 1.0);
        if (p.batch.J[0] < 0.05) break;
        const double q = shear(p), pr = pressure(p), size = k + std::fabs(pr);
        EXPECT_LE(q - M * pr - k, 1e-10 * size);
        EXPECT_LE(-pr - 1e4, 1e-10 * size);
        const bool on_cone = q - M * pr - k > -1e-10 * size, on_plane = -pr - 1e4 > -1e-10 * size;
        cone += on_cone && !on_plane;
        plane += on_plane && !on_cone;
        corner += on_plane && on_cone;
        if (p.batch.work[PLASTIC] > 1e-9 * size) EXPECT_TRUE(on_cone || on_plane);
      }
    }
  EXPECT_GT(cone, 50);
  EXPECT_GT(plane, 50);
  EXPECT_GT(corner, 50);
}

// exact on straight paths; of first order where the direction of flow turns
TEST(DruckerPrager, OrderOfTheReturn)
{
  const auto material = make("density 1600 drucker/prager 1e7 0.3 30 dilatancy 10");
  const auto sheared = [&](int n, bool turning) {
    MaterialPoint p(*material);
    consolidate(p, 1e5);
    for (int i = 0; i < n; i++) {
      const double t = (i + 0.5) / n;
      const double a = turning ? 0.5 * M_PI * t : 0.0;
      const double x = 0.05 * std::cos(a), y = 0.05 * std::sin(a);
      const Matrix L = {-x, y, 0, y, x, 0, 0, 0, 0};
      p.step(L.data(), 1.0 / n);
    }
    return stress_of(p);
  };
  const Matrix straight = sheared(1000, false);
  // Cayley steps of a stretch differ from the exponential in third order
  EXPECT_LT(distance(sheared(1, false), straight), 1e-3 * size(straight));
  EXPECT_LT(distance(sheared(10, false), straight), 1e-5 * size(straight));
  const Matrix exact = sheared(20000, true);
  double error[3];
  for (int level = 0; level < 3; level++)
    error[level] = distance(sheared(100 << level, true), exact);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 1.0, 0.1);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 1.0, 0.1);
  EXPECT_LT(error[0], 0.02 * size(exact));
}

}    // namespace

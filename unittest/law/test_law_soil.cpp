// labels: unit physics
// This file is part of the MPM package for LAMMPS, distributed under the GNU
// General Public License, version 2; see the file LICENSE.

// Laws of soil, rock and snow at a point: laboratory tests, flow, critical states, common traits.

#include "law/spectral.h"
#include "material/material_testing.h"

using namespace MPM_NS;
using namespace material_testing;

constexpr double DEG = M_PI / 180.0;

/* ---------------------------------------------------------------------- laboratory tests */

/** One step with an axial rate along x and lateral rates that give this stress along y. */
void step_lateral(MaterialPoint &p, double axial, double lateral_stress, double dt,
                  bool plane = false)
{
  const auto motion = [&](double rate) {
    return diagonal(axial, rate, plane ? 0.0 : rate);
  };
  const auto residual = [&](double rate) {
    MaterialPoint trial(p);
    steps(trial, motion(rate), dt);
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
  steps(p, motion(rate), dt);
}

/** Isotropic compression until the Cauchy pressure is reached. */
void consolidate(MaterialPoint &p, double pressure, int n = 20)
{
  const MaterialPoint start(p);
  const auto compress = [&](double strain) {
    MaterialPoint q(start);
    steps(q, isotropic(-strain / 3), 1.0 / n, n);
    return q;
  };
  double high = 1e-6;
  while (compress(high).pressure() < pressure) high *= 2.0;
  const double strain = root_of(0.0, high, [&](double strain) {
    return compress(strain).pressure() - pressure;
  });
  steps(p, isotropic(-strain / 3), 1.0 / n, n);
  EXPECT_NEAR(p.pressure(), pressure, 1e-9 * pressure);
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
  const auto shear = [](double t) {
    return Matrix{1 - 0.3 * t, 0.8 * t, 0, 0, 1 + 0.1 * t, 0, 0, 0, 1 - 0.05 * t};
  };
  for (const char *text : all) {
    SCOPED_TRACE(text);
    expect_objective(*make(text), shear, 12.6, 1e-9,
                     [](const MaterialPoint &plain, const MaterialPoint &turned) {
                       for (size_t k = 6; k < plain.material.history().size(); k++)
                         EXPECT_NEAR(turned.history(k), plain.history(k),
                                     1e-10 * (1 + std::fabs(plain.history(k))));
                     });
  }
}

// steps of any size and direction: finite, and dissipation is never negative
TEST(SoilLaws, LargeSteps)
{
  RandomMatrix random(7);
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
              A = random(0.4 * scale);
              Matrix f = A;
              for (int k = 0; k < 9; k += 4) f[k] += 1.0;
              grown = det(f);
            } while (grown < 0.2);
            if (p.batch.J[0] * grown < 0.02 || p.batch.J[0] * grown > 50) break;
            moves(p, A, dt);
            expect_finite(p);
            ASSERT_GE(p.wave_speed(), 0.0) << "strain " << scale << " dt " << dt;
            ASSERT_FALSE(HasFailure());
            if (!strstr(text, "snow")) ASSERT_GE(p.batch.work[PLASTIC], 0.0);
          }
        }
  }
}

// batches that stay elastic go a short way: the same result as beside a point that yields
TEST(SoilLaws, ElasticBatches)
{
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    RandomMatrix random(3);
    MaterialPoint alone(*material, 8), beside(*material, 9);
    for (int step = 0; step < 4; step++) {
      for (int i = 0; i < 9; i++) {
        // under pressure, as some have no strength without
        Matrix A = random(1e-5);
        for (int k = 0; k < 9; k += 4) A[k] -= step == 0 ? 1e-3 : 0.0;
        if (i == 8) A = {0, 0.3, 0, 0, 0, 0, 0, 0, 0};
        for (MaterialPoint *p : {&alone, &beside})
          if (i < p->batch.n) displace(p->batch, i, A);
      }
      for (MaterialPoint *p : {&alone, &beside}) {
        std::fill_n(p->batch.plastic, p->batch.n, 0.0);
        material->update(p->batch);
      }
      EXPECT_GT(beside.batch.plastic[8], 0.0);
      const double scale = alone.batch.stress[0][0];
      for (int i = 0; i < 8; i++) {
        EXPECT_EQ(alone.batch.plastic[i], 0.0);
        EXPECT_EQ(beside.batch.plastic[i], 0.0);
        for (int k = 0; k < 6; k++)
          EXPECT_NEAR(alone.batch.stress[k][i], beside.batch.stress[k][i],
                      1e-12 * std::fabs(scale));
        for (size_t k = 0; k < material->history().size(); k++)
          EXPECT_NEAR(alone.batch.history[k][i], beside.batch.history[k][i],
                      1e-14 * std::max(1.0, std::fabs(beside.batch.history[k][i])));
      }
      EXPECT_EQ(alone.batch.work[PLASTIC], 0.0);
    }
  }
}

// equal to Mohr-Coulomb in triaxial compression; there the volume grows by M_psi per shear strain
TEST(DruckerPrager, TriaxialCompression)
{
  for (const double c : {0.0, 2e4})
    for (const double psi : {0.0, 12.0}) {
      const double phi = 33.0, s = std::sin(phi * DEG), N = (1 + s) / (1 - s), confining = 1e5;
      Point p("density 1600 drucker/prager 5e7 0.25 33 cohesion " + std::to_string(c) +
              " dilatancy " + std::to_string(psi));
      consolidate(p, confining);
      EXPECT_EQ(value(p, "eplastic"), 0.0);
      for (int i = 0; i < 40; i++) step_lateral(p, -1e-3, -confining, 1.0);
      const double J = p.batch.J[0];
      EXPECT_NEAR(-p.stress(0), N * confining + 2 * c / J * std::sqrt(N), 1e-11 * N * confining);
      const double e0 = value(p, "eplastic"), t = std::sin(psi * DEG);
      const auto plastic_volume = [&]() {
        return std::log(p.batch.J[0]) + pressure(p) * 3 * 0.5 / 5e7;
      };
      const double before = plastic_volume();
      step_lateral(p, -1e-3, -confining, 1.0);
      EXPECT_NEAR((plastic_volume() - before) / (value(p, "eplastic") - e0), 6 * t / (3 - t),
                  1e-11);
      EXPECT_EQ(value(p, "gap"), 0.0);
    }
}

/** Volume per shear strain in a step of plane compression. */
double plane_dilatancy(MaterialPoint &p, double confining)
{
  const double x = std::log(p.batch.F[0][0]), y = std::log(p.batch.F[4][0]);
  step_lateral(p, -1e-3, -confining, 1.0, true);
  const double dx = std::log(p.batch.F[0][0]) - x, dy = std::log(p.batch.F[4][0]) - y;
  return (dx + dy) / (dy - dx);
}

// with "plane" the same in plane strain, whatever the dilatancy angle
TEST(DruckerPrager, PlaneStrainCompression)
{
  for (const double c : {0.0, 2e4})
    for (const double psi : {0.0, 12.0, 33.0}) {
      const double s = std::sin(33.0 * DEG), N = (1 + s) / (1 - s), confining = 1e5;
      Point p("density 1600 drucker/prager 5e7 0.25 33 cohesion " + std::to_string(c) +
              " dilatancy " + std::to_string(psi) + " plane");
      consolidate(p, confining);
      for (int i = 0; i < 60; i++) step_lateral(p, -1e-3, -confining, 1.0, true);
      const double J = p.batch.J[0];
      EXPECT_NEAR(-p.stress(0), N * confining + 2 * c / J * std::sqrt(N), 1e-3 * N * confining);
      EXPECT_NEAR(plane_dilatancy(p, confining), std::sin(psi * DEG), 0.01);    // elastic part
    }
}

// sand without cohesion: separated grains feel nothing until they have closed up again
TEST(DruckerPrager, SeparatedSandDoesNotGainVolume)
{
  const double K = 1e6 / (3 * 0.4);
  Point p("density 1600 drucker/prager 1e6 0.3 30");
  const double a = 0.1;
  for (int i = 1; i < 40; i++) {    // out and back
    const int k = std::min(i, 40 - i);
    const double F = 1 + a * k / 20;
    move_to(p, {F, 0.3 * k / 20, 0, 0, F, 0, 0, 0, F});
    EXPECT_NEAR(p.vonmises() + std::fabs(p.pressure()), 0.0, 1e-9);
    if (i <= 20) EXPECT_NEAR(value(p, "gap"), 3 * std::log(F), 1e-12);
  }
  for (const double F : {1.001, 0.998}) move_to(p, isotropic(F));
  EXPECT_NEAR(pressure(p), -3 * K * std::log(0.998), 1e-12 * K);
  EXPECT_NEAR(value(p, "gap"), 0.0, 1e-15);
  EXPECT_NEAR(p.work[PLASTIC], 0.0, 1e-7 * K);
}

// tension: to the apex c cot(phi) of the cone, or the cutoff; opening dissipates, closing does not
TEST(DruckerPrager, Tension)
{
  const double c = 2e4, phi = 35 * DEG;
  struct {
    const char *text;
    double limit;
  } cases[] = {{"", c / std::tan(phi)}, {" tension 5e3", 5e3}, {" tension 1e6", c / std::tan(phi)}};
  for (const auto &k : cases) {
    Point p(std::string("density 1600 drucker/prager 1e7 0.3 35 cohesion 2e4") + k.text);
    for (int i = 1; i <= 100; i++) move_to(p, isotropic(1 + 1e-3 * i));
    EXPECT_NEAR(-pressure(p), k.limit, 1e-12 * k.limit) << k.text;
    const double gap = value(p, "gap"), K = 1e7 / 1.2;
    EXPECT_NEAR(gap, 3 * std::log(1.1) - k.limit / K, 1e-12);
    EXPECT_NEAR(p.work[PLASTIC], k.limit * gap, 0.01 * k.limit * gap);
    const double work = p.work[PLASTIC];
    for (int i = 99; i >= 0; i--) move_to(p, isotropic(1 + 1e-3 * i));
    EXPECT_NEAR(p.work[PLASTIC], work, 1e-12 * work);
    EXPECT_NEAR(p.pressure(), 0.0, 1e-6);
  }
}

TEST(DruckerPrager, ReturnEndsOnTheYieldSurface)
{
  RandomMatrix random(4);
  const double s = std::sin(35 * DEG), M = 6 * s / (3 - s),
               k = 6 * 2e4 * std::cos(35 * DEG) / (3 - s);
  const auto material =
      make("density 1600 drucker/prager 1e7 0.3 35 cohesion 2e4 dilatancy 20 tension 1e4");
  int cone = 0, plane = 0, corner = 0;
  for (const double scale : {1e-4, 1e-3, 1e-2, 0.1, 1.0})
    for (int repeat = 0; repeat < 100; repeat++) {
      MaterialPoint p(*material);
      for (int i = 0; i < 3; i++) {
        Matrix A = random((repeat % 2 ? 0.2 : 0.02) * scale);
        if (repeat % 4 == 0)
          for (int d = 0; d < 9; d += 4) A[d] += 0.1 * scale;
        moves(p, A, 1.0);
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

// A trial stress beyond the limit of tension is within it again when it has dilated on its way to
// the cone: then the cone alone decides, with the multiplier of its own return
TEST(DruckerPrager, DilationOutOfTensionIsAReturnToTheCone)
{
  Point p("density 1600 drucker/prager 1e7 0.3 35 cohesion 2e4 dilatancy 20 tension 1e4");
  const double a = 5e-3, v = 1.8e-3, K = 1e7 / 1.2, G = 1e7 / 2.6;
  move_to(p, {std::exp(a + v / 3), 0, 0, 0, std::exp(-a + v / 3), 0, 0, 0, std::exp(v / 3)});
  const double s = std::sin(35 * DEG), t = std::sin(20 * DEG), M = 6 * s / (3 - s),
               flow = 6 * t / (3 - t);
  const double k = 6 * 2e4 * std::cos(35 * DEG) / (3 - s);
  const double q = 3 * G * 2 * a / std::sqrt(3.0);
  const double D = (q + M * K * v - k) / (3 * G + K * M * flow);
  EXPECT_GT(K * v, 1e4);    // beyond, and back
  EXPECT_LT(K * (v - flow * D), 1e4);
  EXPECT_NEAR(pressure(p), K * (flow * D - v), 1e-12 * q);
  EXPECT_NEAR(shear(p), q - 3 * G * D, 1e-12 * q);
}

// exact on straight paths; of first order where the direction of flow turns
TEST(DruckerPrager, OrderOfTheReturn)
{
  const auto material = make("density 1600 drucker/prager 1e7 0.3 30 dilatancy 10");
  const auto sheared = [&](int n, bool turning) {
    MaterialPoint p(*material);
    consolidate(p, 1e5);
    const auto L = [turning](double t) {
      const double a = turning ? 0.5 * M_PI * t : 0.0;
      const double x = 0.05 * std::cos(a), y = 0.05 * std::sin(a);
      return Matrix{-x, y, 0, y, x, 0, 0, 0, 0};
    };
    follow(p, L, 1.0, n);
    return stress_of(p);
  };
  const Matrix straight = sheared(1000, false);
  // Cayley steps of a stretch differ from the exponential in third order
  EXPECT_LT(distance(sheared(1, false), straight), 1e-3 * size(straight));
  EXPECT_LT(distance(sheared(10, false), straight), 1e-5 * size(straight));
  const Matrix exact = sheared(20000, true);
  const auto error = refined(100, [&](int n) {
    return distance(sheared(n, true), exact);
  });
  expect_order(error, 1.0, 0.1);
  EXPECT_LT(error[0], 0.02 * size(exact));
}

/** Principal Kirchhoff stresses, largest first. */
std::array<double, 3> principal(const MaterialPoint &p)
{
  const law::Spectral s(1, p.batch.stress);
  std::array<double, 3> v;
  for (int k = 0; k < 3; k++) v[k] = p.batch.J[0] * s.value[k][0];
  std::sort(v.begin(), v.end(), std::greater<>());
  return v;
}

double mohr_coulomb(const std::array<double, 3> &s, double phi, double c)
{
  return s[0] - s[2] + (s[0] + s[2]) * std::sin(phi) - 2 * c * std::cos(phi);
}

// compression and extension are on the two edges, plane strain is on the plane
TEST(MohrCoulomb, TriaxialAndPlaneStrength)
{
  for (const double c : {0.0, 2e4})
    for (const double psi : {0.0, 12.0}) {
      const double s = std::sin(33.0 * DEG), N = (1 + s) / (1 - s), confining = 1e5;
      Point p("density 1900 mohr/coulomb 5e7 0.25 33 " + std::to_string(c) + " dilatancy " +
              std::to_string(psi));
      MaterialPoint q(p), r(p);
      for (auto *x : std::vector<MaterialPoint *>{&p, &q, &r}) consolidate(*x, confining);
      for (int i = 0; i < 60; i++) {
        step_lateral(p, -1e-3, -confining, 1.0);
        step_lateral(q, 1e-3, -confining, 1.0);
        step_lateral(r, -1e-3, -confining, 1.0, true);
      }
      const double k = 2 * c * std::sqrt(N), tolerance = 1e-8 * N * confining;
      EXPECT_NEAR(-p.stress(0), N * confining + k / p.batch.J[0], tolerance);
      EXPECT_NEAR(-q.stress(0), (confining - k / q.batch.J[0]) / N, tolerance);
      EXPECT_NEAR(-r.stress(0), N * confining + k / r.batch.J[0], tolerance);
      EXPECT_NEAR(plane_dilatancy(r, confining), std::sin(psi * DEG), 0.01);    // elastic part
    }
}

// associated flow: the plastic strain is in the normal cone of the surface at the returned stress,
// wherever that is, so that no admissible stress would dissipate more
TEST(MohrCoulomb, ReturnMaximizesDissipation)
{
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  const double phi = 30 * DEG, c = 1e4, K = 1e7 / (3 * 0.5), G = 1e7 / 2.5;
  const auto material = make("density 1900 mohr/coulomb 1e7 0.25 30 1e4 dilatancy 30");
  int plane = 0, edge = 0, apex = 0;
  for (int repeat = 0; repeat < 500; repeat++) {
    MaterialPoint p(*material);
    const double scale = std::pow(10.0, -2.5 + normal(random));
    double e[3];
    Matrix F{};
    for (int a = 0; a < 3; a++) {
      e[a] = std::max(std::min(scale * normal(random), 1.0), -1.0);
      F[4 * a] = std::exp(e[a]);
    }
    move_to(p, F);
    double tau[3], flow[3];
    const double J = p.batch.J[0];
    for (int a = 0; a < 3; a++) tau[a] = J * p.stress(a);
    const double mean = (tau[0] + tau[1] + tau[2]) / 3;
    for (int a = 0; a < 3; a++) flow[a] = e[a] - ((tau[a] - mean) / (2 * G) + mean / (3 * K));
    const auto s = principal(p);
    const double size = c + std::fabs(s[0]) + std::fabs(s[2]), f = mohr_coulomb(s, phi, c);
    EXPECT_LE(f, 1e-10 * size);
    if (p.batch.plastic[0] == 0.0) continue;
    EXPECT_GE(f, -1e-10 * size);
    const bool upper = s[0] - s[1] < 1e-9 * size, lower = s[1] - s[2] < 1e-9 * size;
    (upper && lower ? apex : upper || lower ? edge : plane)++;
    for (int other = 0; other < 200; other++) {
      std::array<double, 3> t;
      for (double &x : t) x = size * normal(random) - 0.5 * size;
      auto sorted = t;
      std::sort(sorted.begin(), sorted.end(), std::greater<>());
      if (mohr_coulomb(sorted, phi, c) > 0.0) continue;
      double more = 0.0, strain = 0.0;
      for (int a = 0; a < 3; a++) {
        more += (t[a] - tau[a]) * flow[a];
        strain += std::fabs(flow[a]);
      }
      EXPECT_LE(more, 1e-9 * size * strain);
    }
  }
  EXPECT_GT(plane, 30);
  EXPECT_GT(edge, 30);
  EXPECT_GT(apex, 30);
}

TEST(MohrCoulomb, Softening)
{
  std::mt19937 random(9);
  for (const double rate : {2.0, 50.0, 1e3, 1e5}) {
    const auto material =
        make("density 1900 mohr/coulomb 1e7 0.3 30 3e4 residual 5e3 18 " + std::to_string(rate));
    const auto excess = [&](const MaterialPoint &p) {
      const double left = std::exp(-rate * value(p, "eplastic"));
      return mohr_coulomb(principal(p), (18 + 12 * left) * DEG, 5e3 + 2.5e4 * left);
    };
    int plastic = 0;
    random_steps(*material, random, {1e-5, 1e-3, 1e-2, 0.1, 1.0}, {1.0}, 50, 4,
                 [&](const MaterialPoint &p, double, double) {
                   const auto s = principal(p);
                   const double size = 1e4 + std::fabs(s[0]) + std::fabs(s[2]);
                   EXPECT_LE(excess(p), 1e-10 * size);
                   if (p.batch.plastic[0] <= 0.0) return;
                   EXPECT_NEAR(excess(p), 0.0, 1e-10 * size);
                   plastic++;
                 });
    EXPECT_GT(plastic, 100);
  }
  // constant normal stress, far beyond the peak
  const auto material = make("density 1900 mohr/coulomb 1e7 0.3 30 3e4 residual 5e3 18 20");
  const double N = (1 + std::sin(18 * DEG)) / (1 - std::sin(18 * DEG));
  MaterialPoint p(*material);
  consolidate(p, 1e5);
  double peak = 0.0;
  for (int i = 0; i < 500; i++) {
    step_lateral(p, -1e-3, -1e5, 1.0);
    peak = std::max(peak, -p.stress(0));
  }
  const double residual = N * 1e5 + 2 * 5e3 / p.batch.J[0] * std::sqrt(N);
  EXPECT_NEAR(-p.stress(0), residual, 2e-4 * residual);
  EXPECT_GT(peak, 1.2 * residual);
}

// parts that separated carry no pressure before they meet, also where nothing yields
TEST(MohrCoulomb, SeparatedPartsCloseWithoutPressure)
{
  const double K = 1e6 / (3 * 0.4), tip = 1e4 / std::tan(30 * DEG);
  Point p("density 1900 mohr/coulomb 1e6 0.3 30 1e4");
  move_to(p, isotropic(1.05));
  EXPECT_NEAR(pressure(p), -tip, 1e-12 * tip);
  const double gap = 3 * std::log(1.05) - tip / K;
  EXPECT_NEAR(value(p, "gap"), gap, 1e-12);
  move_to(p, isotropic(1.02));
  EXPECT_NEAR(pressure(p), 0.0, 1e-12 * tip);
  EXPECT_NEAR(value(p, "gap"), 3 * std::log(1.02), 1e-12);
  move_to(p, isotropic(0.99));
  EXPECT_NEAR(pressure(p), -3 * K * std::log(0.99), 1e-11 * tip);
  EXPECT_NEAR(value(p, "gap"), 0.0, 1e-12);
}

// in one step or many: pressure stays, as there is no plastic volume, and tension is lost
TEST(MohrCoulomb, SofteningToNothing)
{
  const double K = 1e9 / (3 * 0.4), G = 1e9 / 2.6;
  for (const double rate : {1e2, 1e4, 1e6})
    for (const double strain : {1e-5, 1e-3, 0.1, 1.0}) {
      Point p(joined("density 1900 mohr/coulomb 1e9 0.3 40 1e6 residual 0 0 ", rate));
      SCOPED_TRACE(joined("rate ", rate, ", strain ", strain));
      move_to(p, isotropic(0.999));
      for (int i = 0; i < 40; i++)    // until nothing is left, then on
        for (const double size : {80.0 / rate + 0.02, strain}) {
          moves(p, {0, i % 2 ? size : -size, 0, 0, 0, 0, 0, 0, 0}, 1.0);
          EXPECT_NEAR(pressure(p), -3 * K * std::log(0.999), 1e-12 * K);
        }
      EXPECT_LT(p.vonmises(), 1e-12 * G);
      moves(p, isotropic(0.002), 1.0);
      EXPECT_NEAR(pressure(p), 0.0, 1e-12 * K);
      EXPECT_NEAR(value(p, "gap"), 3 * std::log(0.999 * 1.002), 1e-13);
    }
}

constexpr double CC_G = 5e6, CC_M = 0.9, CC_LAMBDA = 0.2 / 1.8, CC_KAPPA = 0.04 / 1.8;
const char *const clay = "density 1900 camclay 5e6 0.9 0.2 0.04 0.8 1e5 ";

TEST(CamClay, IsotropicCompressionAndSwelling)
{
  Point p(clay + std::string("2e5"));
  const auto squeeze = [&](double J) {
    move_to(p, isotropic(std::cbrt(J)));
    EXPECT_LT(p.vonmises(), 1e-6 * p.pressure());
  };
  const auto expect_pressure = [&](double exact) {
    EXPECT_NEAR(pressure(p), exact, 1e-11 * exact);
  };
  squeeze(std::pow(1.5, -CC_KAPPA));
  expect_pressure(1.5e5);
  const double J1 = std::pow(2.0, -CC_KAPPA);
  for (const double factor : {1.01, 1.5, 4.0}) {    // on the normal compression line
    squeeze(J1 * std::pow(factor, -CC_LAMBDA));
    expect_pressure(2e5 * factor);
    EXPECT_NEAR(value(p, "preconsolidation"), 2e5 * factor, 1e-6);
  }
  squeeze(J1 * std::pow(4.0, -CC_LAMBDA) * std::pow(4.0, CC_KAPPA));
  expect_pressure(2e5);
}

/** n steps in which the length along x shrinks by the share a, and the volume stays exactly. */
void shorten(MaterialPoint &p, double a, int n)
{
  const double lateral = 1 / std::sqrt(1 - a) - 1;
  moves(p, diagonal(-a, lateral, lateral), 1.0, n);
}

// closed form of the strength at constant volume: p = P0 (OCR/2)^(1 - kappa/lambda), q = M p
TEST(CamClay, UndrainedStrength)
{
  for (const double ocr : {1.0, 1.5, 2.0, 4.0, 10.0}) {
    Point p(clay + std::to_string(1e5 * ocr));
    shorten(p, 1e-4, 4000);
    const double exact = 1e5 * std::pow(ocr / 2, 1 - CC_KAPPA / CC_LAMBDA);
    EXPECT_NEAR(p.pressure(), exact, 8e-8 * exact) << ocr;
    EXPECT_NEAR(p.vonmises(), CC_M * exact, 2e-8 * exact) << ocr;
  }
}

/** Pressure, equivalent stress, preconsolidation on a straight path from the yield surface. */
State clay_ode(const State &start, double volume, double strain, int n)
{
  const auto rate = [&](double, const State &s) {
    const double p = s[0], q = s[1], pc = s[2], K = p / CC_KAPPA;
    const double fp = 2 * p - pc, fq = 2 * q / (CC_M * CC_M), H = pc / (CC_LAMBDA - CC_KAPPA);
    const double flow = (fp * K * volume + fq * 3 * CC_G * strain) /
        (fp * fp * K + fq * fq * 3 * CC_G + p * H * fp);
    return State{K * (volume - flow * fp), 3 * CC_G * (strain - flow * fq), H * flow * fp};
  };
  return runge_kutta(rate, start, 1.0, n);
}

// undrained, drained-like (wet side) and dilating (dry side) paths, first order in the step
TEST(CamClay, PathsFollowTheRateEquations)
{
  for (const auto &[ocr, volume] :
       {std::pair{1.0, 0.0}, {1.0, 0.04}, {3.0, 0.0}, {3.0, -0.02}, {1.2, 0.02}}) {
    SCOPED_TRACE(std::to_string(ocr) + " " + std::to_string(volume));
    const auto material = make(clay + std::to_string(1e5 * ocr));
    // elastic shear at constant volume up to the yield surface
    const double q0 = CC_M * 1e5 * std::sqrt(ocr - 1.0), strain = 0.1;
    const auto shear_by = [](MaterialPoint &p, double v, double e, int n) {
      const double lateral = std::expm1((-v / 3 + e / 2) / n);
      moves(p, diagonal(std::expm1((-v / 3 - e) / n), lateral, lateral), 1.0, n);
    };
    const auto exact = clay_ode({1e5, q0, 1e5 * ocr}, volume, strain, 4000);
    const auto error = refined(200, [&](int n) {
      MaterialPoint p(*material);
      shear_by(p, 0.0, q0 / (3 * CC_G), 1);
      EXPECT_NEAR(shear(p), q0, 1e-9 * q0 + 1e-6);
      shear_by(p, volume, strain, n);
      return std::fabs(pressure(p) / exact[0] - 1) + std::fabs(shear(p) / exact[1] - 1) +
          std::fabs(value(p, "preconsolidation") / exact[2] - 1);
    });
    EXPECT_LT(error[2], 3e-4);
    expect_order(error, 1.0, 0.25);
  }
}

// triaxial compression at constant lateral stress ends on the critical state line, volume at rest
TEST(CamClay, DrainedTriaxialReachesCriticalState)
{
  for (const double ocr : {1.1, 5.0}) {
    Point p(clay + std::to_string(1e5 * ocr));
    steps(p, {}, 1.0);
    EXPECT_NEAR(p.pressure(), 1e5, 1e-6);
    for (int i = 0; i < 600; i++) step_lateral(p, -2e-3, -1e5, 1.0);
    EXPECT_NEAR(p.vonmises() / p.pressure(), CC_M, 2e-4 * CC_M) << ocr;
    const double J = p.batch.J[0];
    step_lateral(p, -2e-3, -1e5, 1.0);
    EXPECT_NEAR(p.batch.J[0], J, 6e-7) << ocr;
    EXPECT_GT(ocr > 2.0 ? J - 1.0 : 1.0 - J, 0.01) << ocr;    // dilates or contracts
  }
}

// returned stress on the ellipse, plastic strain normal to it
TEST(CriticalState, ReturnIsOnTheSurfaceAndAssociated)
{
  std::mt19937 random(10);
  std::normal_distribution<double> normal;
  const double nuK = 1e6 / (3 * 0.4);
  struct {
    const char *text;
    double M, beta, xi = 0.0;
  } cases[] = {{"density 250 nacc 1e6 0.3 1.85 0.3 3 -0.05", 1.85, 0.3, 3},
               {"density 250 nacc 1e6 0.3 1.2 0 10 -0.02", 1.2, 0.0, 10},
               {"density 250 nacc 1e6 0.3 2.36 1 1 -0.5", 2.36, 1.0, 1},
               {"density 1900 camclay 5e6 0.9 0.2 0.04 0.8 1e5 1.5e5", 0.9, 0.0},
               {"density 1900 camclay 5e6 1.4 0.1 0.005 0 1e5 2e6", 1.4, 0.0}};
  for (const auto &k : cases) {
    SCOPED_TRACE(k.text);
    const auto material = make(k.text);
    const bool cc = strstr(k.text, "camclay");
    int wet = 0, dry = 0;
    for (const double scale : {1e-4, 1e-3, 1e-2, 0.1, 0.5})
      for (int repeat = 0; repeat < 60; repeat++) {
        MaterialPoint p(*material);
        for (int i = 0; i < 4; i++) {
          const double mean = 0.3 * scale * normal(random);
          Matrix A{};
          for (int a = 0; a < 3; a++) A[4 * a] = std::expm1(0.5 * scale * normal(random) + mean);
          const double hard = cc ? std::log(value(p, "preconsolidation")) : value(p, "alpha");
          const double made = value(p, "eplastic");
          moves(p, A, 1.0);
          const double pr = pressure(p), q = shear(p);
          const double p0 = cc ? value(p, "preconsolidation")
                               : nuK * std::sinh(k.xi * std::max(-value(p, "alpha"), 0.0));
          const double f = q * q * (1 + 2 * k.beta) + k.M * k.M * (pr + k.beta * p0) * (pr - p0);
          const double size = p0 * p0 + 1e-12 * nuK * nuK;
          EXPECT_LE(f, 1e-10 * size);
          const double D = value(p, "eplastic") - made;
          if (p.batch.work[PLASTIC] < 1e-9 * p0 || p0 < 1e-6 * nuK || D < 1e-9) continue;
          EXPECT_GE(f, -1e-10 * size);
          if (p0 - pr < 1e-5 * p0 || pr + k.beta * p0 < 1e-5 * p0) continue;    // q of round-off
          // plastic compression from the change of the hardening variable
          const double x = cc ? (std::log(p0) - hard) * (strstr(k.text, "0.8") ? 0.16 / 1.8 : 0.095)
                              : -(value(p, "alpha") - hard);
          const double normal_p = k.M * k.M * (2 * pr - (1 - k.beta) * p0),
                       normal_q = 2 * q * (1 + 2 * k.beta);
          const double length = std::hypot(normal_p, normal_q), flow = std::hypot(x, D);
          EXPECT_NEAR(x * normal_q - D * normal_p, 0.0, 8e-9 * length * flow)
              << "scale " << scale << " p/p0 " << pr / p0;
          EXPECT_GE(x * normal_p + D * normal_q, 0.0);
          (normal_p > 0 ? wet : dry)++;
        }
      }
    EXPECT_GT(wet, 50);
    EXPECT_GT(dry, 10);
  }
}

// hydrostatic tension: strength BETA p0, then nothing until it is compressed again
TEST(Nacc, BreaksInTension)
{
  const double K = 1e6 / 1.2, p0 = K * std::sinh(3 * 0.05);
  Point p("density 250 nacc 1e6 0.3 1.85 0.3 3 -0.05");
  double strongest = 0.0;
  for (int i = 1; i <= 2000; i++) {
    move_to(p, isotropic(std::exp(1e-4 * i)));
    strongest = std::max(strongest, -pressure(p));
    if (3e-4 * i * K < 0.299 * p0) EXPECT_EQ(value(p, "alpha"), -0.05);
  }
  EXPECT_NEAR(strongest, 0.3 * p0, 0.01 * p0);
  EXPECT_NEAR(pressure(p), 0.0, 1e-12 * K);
  EXPECT_NEAR(value(p, "alpha"), 0.6 - 0.05, 1e-12);
  move_to(p, isotropic(std::exp(0.2 - 0.5 / 3)));
  EXPECT_NEAR(pressure(p), 0.0, 1e-12 * K);
  EXPECT_NEAR(value(p, "alpha"), 0.05, 1e-12);
  // beyond the volume at which it has no strength
  move_to(p, isotropic(std::exp(-0.02)));
  EXPECT_GT(pressure(p), 1e-3 * K);
  EXPECT_NEAR(pressure(p), K * std::sinh(3 * -value(p, "alpha")), 1e-13 * K);
}

TEST(MuI, SteadyShear)
{
  const double mus = std::tan(20.9 * DEG), mu2 = std::tan(32.76 * DEG), I0 = 0.279, d = 5e-4;
  const std::string text =
      "density 1500 mui 1e6 0.3 " + std::to_string(mus) + " " + std::to_string(mu2) + " 0.279 5e-4";
  const auto common = make(text), dense = make(text + " fraction 0.9");
  for (const double rate :
       {1e-3, 1.0, 30.0, -30.0, 300.0, 1e5}) {    // negative: the other material
    const auto &material = rate > 0.0 ? common : dense;
    const double density = 1500 / (rate > 0.0 ? 0.6 : 0.9);
    MaterialPoint p(*material);
    consolidate(p, 500.0);
    steps(p, {0, rate, 0, 0, 0, 0, 0, 0, 0}, 1e-3 / std::fabs(rate), 4000);
    const double t = p.vonmises() / std::sqrt(3.0), pr = p.pressure();
    const double I = std::fabs(rate) * d / std::sqrt(pr / density);
    EXPECT_NEAR(t / pr, mus + (mu2 - mus) * I / (I0 + I), 3e-6) << rate;
    EXPECT_NEAR(value(p, "inertial"), I, 5e-6 * I);
    EXPECT_NEAR(pr, 500.0, 1e-8);
    EXPECT_GT(std::fabs(p.stress(3)), 0.99 * t);    // and nearly all of it in the shear plane
  }
}

// the inertial number does not depend on units: mm, ms, g/cm3, MPa
TEST(MuI, OtherUnits)
{
  const auto si = make("density 1500 mui 1e6 0.3 0.38 0.64 0.3 5e-4");
  const auto small = make("density 1.5 mui 1 0.3 0.38 0.64 0.3 0.5");
  ASSERT_TRUE(small->configure(nullptr, 1e-3, 1e-3));
  MaterialPoint p(*si), q(*small);
  const Matrix A = {-1e-6, 1e-3, 0, 0, -1e-6, 0, 0, 0, 0};
  moves(p, A, 1e-5, 500);
  moves(q, A, 1e-2, 500);
  EXPECT_GT(value(p, "inertial"), 0.05);
  EXPECT_NEAR(value(q, "inertial"), value(p, "inertial"), 1e-13);
  EXPECT_NEAR(1e6 * q.stress(3), p.stress(3), 1e-12 * p.stress(3));
  EXPECT_NEAR(q.wave_speed(), p.wave_speed(), 1e-12 * p.wave_speed());
}

TEST(Snow, HardensInCompressionAndFallsApartInTension)
{
  const double E = 1.4e5, nu = 0.2, mu = E / 2.4, lambda = E * nu / (1.2 * 0.6);
  const auto material = make("density 400 snow 1.4e5 0.2 0.025 0.0075 10");
  for (const bool tension : {false, true}) {
    MaterialPoint p(*material);
    const double s = tension ? 1.0075 : 0.975;
    for (int i = 1; i <= 50; i++) {
      const double J = 1 + (tension ? 0.01 : -0.01) * i;
      move_to(p, uniaxial_stretch(J));
      const double stretch = tension ? std::min(J, s) : std::max(J, s), JP = J / stretch;
      const double h = std::exp(10 * (1 - JP));
      const double exact =
          h * (2 * mu * stretch * (stretch - 1) + lambda * stretch * (stretch - 1));
      EXPECT_NEAR(J * p.stress(0), exact, 1e-9 * std::fabs(exact));
      EXPECT_NEAR(value(p, "jplastic"), JP, 1e-12);
      EXPECT_NEAR(p.stored_energy(), h * (mu + lambda / 2) * (stretch - 1) * (stretch - 1),
                  1e-9 * p.stored_energy());
    }
    EXPECT_GT(p.work[PLASTIC], 0.0);
  }
  // energy that hardening adds to the strain comes from the plastic work
  MaterialPoint p(*material);
  compress(p, 0.7, 3000);
  EXPECT_GT(p.stored_energy(), 0.1 * p.power);
  EXPECT_NEAR(p.stored_energy() + p.work[PLASTIC], p.power, 3e-7 * p.power);
}

// first order in the step where the flow turns, for all laws
TEST(SoilLaws, FirstOrderOnACurvedPath)
{
  for (const char *text : all) {
    SCOPED_TRACE(text);
    const auto material = make(text);
    const auto path = [&](int n) {
      MaterialPoint p(*material);
      follow(
          p,
          [](double t) {
            const double c = std::cos(3.0 * t), s = std::sin(3.0 * t);
            return Matrix{-0.03 + 0.04 * c, 0.05 * s, 0, 0.02, -0.02 - 0.05 * c,
                          0.01 * c,         0,        0, -0.01};
          },
          1.0, n);
      return stress_of(p);
    };
    const Matrix exact = path(12800);
    const auto error = refined(100, [&](int n) {
      return distance(path(n), exact) / size(exact);
    });
    EXPECT_LT(error[2], 5e-3);
    if (error[2] > 1e-6)
      EXPECT_GT(std::log2(error[0] / error[2]) / 2, 0.85) << error[0] << " " << error[2];
  }
}

// what the numbers in the files were made from comes out again
TEST(SoilFiles, GiveThePublishedStrength)
{
  const auto uniaxial = [](const char *name, double strain) {
    Point p(definition(name));
    for (int i = 0; i < 200; i++) p.step_uniaxial_stress(strain / 200, 1.0);
    return p.stress(0) * p.batch.J[0];
  };
  EXPECT_NEAR(uniaxial("Concrete_C30_MC", -0.005), -38 * MPa, 0.01 * MPa);
  EXPECT_NEAR(uniaxial("Concrete_C30_MC", 0.001), 2.9 * MPa, 0.002 * MPa);
  EXPECT_NEAR(uniaxial("Sandstone_Berea_MC", -0.02), -90.18 * MPa, 6e-4 * MPa);

  // undrained strength ratio q/(2 p0) = M/2 (1/2)^(1 - kappa/lambda) of normally consolidated clay
  struct {
    const char *name;
    double M, lambda, kappa;
  } clays[] = {{"Clay_Weald_CC", 0.95, 0.093, 0.035}, {"Clay_London_CC", 0.888, 0.161, 0.062}};
  for (const auto &k : clays) {
    Point p(definition(k.name));
    shorten(p, 1e-3, 600);
    const double q = k.M * 1e5 * std::pow(0.5, 1 - k.kappa / k.lambda);
    EXPECT_NEAR(p.vonmises(), q, 1e-11 * q) << k.name;
  }

  Point p(definition("Sand_dry_DP"));
  consolidate(p, 1e3);
  for (int i = 0; i < 40; i++) step_lateral(p, -1e-3, -1e3, 1.0);
  EXPECT_NEAR(-p.stress(0), 1e3 * std::pow(std::tan((45 + 35 / 2.0) * DEG), 2), 1e-8);
}

TEST(SoilLaws, BadDefinitionsAreRefused)
{
  expect_refused({{"drucker/prager 1 0 30 dilatancy 31", "PSI must not exceed PHI"},
                  {"drucker/prager 1 0 90", "out of range"},
                  {"drucker/prager 1 0 30 plane 1", "too many values"},
                  {"drucker/prager 1 0 30 plane plane", "given twice"},
                  {"mohr/coulomb 1 0 30", "C is missing"},
                  {"mohr/coulomb 1 0 30 1 residual 2 20 1", "CR and PHIR must not exceed"},
                  {"mohr/coulomb 1 0 30 1 residual 0.5", "PHIR is missing"},
                  {"mohr/coulomb 1 0 30 1 dilatancy 25 residual 0.5 20 1", "PSI must not exceed"},
                  {"mui 1 0 0.5 0.4 0.3 1", "MU2 must not be below"},
                  {"camclay 1 1 0.1 0.1 1 1 1", "LAMBDA must be above"},
                  {"camclay 1 1 0.2 0.1 1 2 1", "PC must not be below"},
                  {"nacc 1 0 1 1.5 1 0", "out of range"},
                  {"nacc 1 0 1 1 1 0.1", "out of range"},
                  {"snow 1 0 1 0 1", "out of range"}},
                 "density 1 ");
}

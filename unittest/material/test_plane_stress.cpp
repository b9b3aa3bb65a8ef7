// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit

// Surfaces and lines: the stretch across them, and what does not resist compression. The
// neo-Hookean law against its own equations, solved here; balloons: benchmark R2.

#include "material/plane_stress_testing.h"
#include "math/bag_gas.h"

using namespace MPM_NS;
using namespace material_testing;

constexpr double E = 1000.0;

std::string rubber(double nu)
{
  return joined("density 1 neohookean ", E, " ", nu);
}

/** sigma_k of the neo-Hookean law with principal stretches. */
double neohookean(double nu, int k, double a, double b, double c)
{
  const double mu = 0.5 * E / (1.0 + nu), lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
               J = a * b * c;
  const double l[3] = {a, b, c};
  return (mu * (l[k] * l[k] - 1.0) + lambda * std::log(J)) / J;
}

Matrix diagonal(double a, double b)
{
  return {a, 0, 0, 0, b, 0, 0, 0, 1};
}

// stretches along both axes: nothing acts across, the rest is the law with that thickness
TEST(PlaneStress, Surface)
{
  for (const double nu : {0.0, 0.3, 0.45})
    for (const bool compression : {true, false})
      for (const auto &[a, b] : {std::pair(1.3, 1.1), std::pair(1.2, 1.2), std::pair(2.5, 1.9)}) {
        const double c = root_of(1e-3, 10.0, [nu = nu, a = a, b = b](double x) {
          return neohookean(nu, 2, a, b, x);
        });
        Surface s(rubber(nu), 3, 2, compression);
        const auto stress = s.go(diagonal(a, b));
        EXPECT_NEAR(s.batch.F[8][0] / c, 1.0, 1e-9);
        EXPECT_NEAR(stress[0] / neohookean(nu, 0, a, b, c), 1.0, 1e-9);
        EXPECT_NEAR(stress[4] / neohookean(nu, 1, a, b, c), 1.0, 1e-9);
        EXPECT_NEAR(stress[8] / E, 0.0, 1e-9);
      }
}

// pressure of a balloon in parts of mu t/R
TEST(PlaneStress, Balloon)
{
  const struct {
    double nu, stretch, pressure;
  } cases[] = {{0.3, 1.1, 0.552132},  {0.3, 1.2, 0.844962},  {0.3, 1.4, 1.061088},
               {0.3, 2.0, 0.953695},  {0.45, 1.1, 0.727410}, {0.45, 1.2, 1.047711},
               {0.45, 1.4, 1.207100}, {0.45, 2.0, 0.980817}};
  for (const auto &c : cases) {
    Surface s(rubber(c.nu), 3, 2, false);
    const auto stress = s.go(diagonal(c.stretch, c.stretch));
    const double mu = 0.5 * E / (1.0 + c.nu);
    EXPECT_NEAR(2.0 * stress[0] * s.batch.F[8][0] / (c.stretch * mu), c.pressure, 1e-6);
  }
}

// stvenant/kirchhoff stretched alike along both axes: 1 - c^2 = 2 nu/(1 - nu) (a^2 - 1). There is
// no such c from some a on, but its stress vanishes with c, and states of c = 1e-8 were taken
TEST(PlaneStress, WithoutAnyState)
{
  for (const double nu : {0.3, 0.45})
    for (double a = 1.05; a < 3.0; a += 0.01) {
      Surface s(joined("density 1 stvenant/kirchhoff ", E, " ", nu), 3, 2, true);
      const double square = 1.0 - 2.0 * nu / (1.0 - nu) * (a * a - 1.0);
      if (std::fabs(square) < 0.01) continue;
      const Matrix F = diagonal(a, a);
      std::copy(F.begin(), F.end(), s.point.along);
      s.point.along[8] = 0.0;
      const int bad = s.state.update(s.batch, &s.point, [&](Batch &b) {
        s.material->update(b);
      });
      EXPECT_EQ(bad, square > 0.0 ? -1 : 0) << nu << " " << a << ": " << s.batch.F[8][0];
      if (square > 0.0 && bad < 0) { EXPECT_NEAR(s.batch.F[8][0] / std::sqrt(square), 1.0, 1e-9); }
    }
}

// what is narrower than it would be by itself wrinkles, in uniaxial tension however narrow it is
TEST(PlaneStress, Wrinkles)
{
  const double nu = 0.3, a = 1.5;
  const double width = root_of(1e-3, 2.0, [&](double x) {
    return neohookean(nu, 1, a, x, x);
  });
  const double force = neohookean(nu, 0, a, width, width) * width * width;
  double energy = 0.0;
  for (const double b : {1.0, 0.999, 0.5, 0.01, 0.0}) {
    Surface s(rubber(nu), 3, 2, false);
    const auto stress = s.go(diagonal(a, b * width));
    EXPECT_NEAR(s.batch.F[4][0], width, 1e-12);
    EXPECT_NEAR(stress[0] * width * width / force, 1.0, 1e-12);
    EXPECT_NEAR(stress[4] / E, 0.0, 1e-12);
    if (b == 1.0) energy = s.energy();
    EXPECT_NEAR(s.energy() / energy, 1.0, 1e-12);
  }
  // one that resists compression does not
  Surface stiff(rubber(nu), 3, 2, true);
  EXPECT_LT(stiff.go(diagonal(a, 0.9 * width))[4] / E, -0.05);

  // slack, also when it has been taut
  Surface slack(rubber(nu), 3, 2, false);
  slack.go(diagonal(1.3, 1.2));
  for (const double c : slack.go(diagonal(0.99, 0.4))) EXPECT_NEAR(c / E, 0.0, 1e-12);
  EXPECT_NEAR(slack.energy() / E, 0.0, 1e-12);
  EXPECT_GT(slack.go(diagonal(1.1, 0.4))[0] / E, 0.05);
}

// Energy is that of the motion alone, and stress its gradient, along any direction and turned
TEST(PlaneStress, StressIsTheGradientOfEnergy)
{
  const double c = cos(0.8), s = sin(0.8);
  const Matrix turn = {c, -0.6 * s, 0.8 * s, s, 0.6 * c, -0.8 * c, 0.0, 0.8, 0.6};
  const Matrix motions[] = {{1.3, 0.2, 0, -0.1, 1.2, 0, 0, 0, 1},    // taut
                            {1.3, 0.4, 0, 0.3, 0.8, 0, 0, 0, 1},     // wrinkled
                            {0.9, 0.2, 0, 0.2, 1.4, 0, 0, 0, 1}};
  for (const auto &motion : motions)
    for (const bool compression : {true, false}) {
      Matrix F;
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) F[3 * i + j] = product(turn.data(), motion.data(), i, j);
      for (const int k : {0, 1, 3, 4, 6, 7}) {
        double energy[2];
        for (int side = 0; side < 2; side++) {
          Surface surface(rubber(0.3), 3, 2, compression);
          Matrix G = F;
          G[k] += side ? 1e-5 : -1e-5;
          surface.go(G);
          energy[side] = surface.energy();
        }
        Surface surface(rubber(0.3), 3, 2, compression);
        const auto stress = surface.go(F);
        // P = J sigma F^-T; its columns along the surface are those of the motion
        const double *const f = surface.old;
        const double cofactors[9] = MPM_COFACTORS(f);
        const int row = 3 * (k / 3);
        const double P = stress[row] * cofactors[k % 3] + stress[row + 1] * cofactors[3 + k % 3] +
            stress[row + 2] * cofactors[6 + k % 3];
        EXPECT_NEAR(P / E, (energy[1] - energy[0]) / (2e-5 * E), 1e-9);
      }
    }
}

// lines: in space free along two axes, in the plane along one
TEST(PlaneStress, Lines)
{
  const double nu = 0.3, a = 1.4;
  const double both = root_of(1e-3, 2.0, [&](double x) {
    return neohookean(nu, 1, a, x, x);
  });
  const double one = root_of(1e-3, 2.0, [&](double x) {
    return neohookean(nu, 1, a, x, 1.0);
  });
  Surface cable(rubber(nu), 3, 1, false), strip(rubber(nu), 2, 1, false);
  const auto of_cable = cable.go(diagonal(a, 1.0)), of_strip = strip.go(diagonal(a, 1.0));
  EXPECT_NEAR(of_cable[0] / neohookean(nu, 0, a, both, both), 1.0, 1e-12);
  EXPECT_NEAR(of_strip[0] / neohookean(nu, 0, a, one, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(strip.batch.F[8][0], 1.0, 0.0);
  // turned by a right angle in one step, as elements of a chain are
  const auto turned = cable.go({0, -1, 0, a, 0, 0, 0, 0, 1});
  EXPECT_NEAR(turned[4] / of_cable[0], 1.0, 1e-12);
  EXPECT_NEAR(turned[0] / E, 0.0, 1e-12);
  // pushed together
  for (auto *line : {&cable, &strip})
    for (const double c : line->go(diagonal(0.7, 1.0))) EXPECT_NEAR(c / E, 0.0, 1e-12);
  Surface truss(rubber(nu), 3, 1, true);
  const double more = root_of(0.5, 3.0, [&](double x) {
    return neohookean(nu, 1, 0.7, x, x);
  });
  EXPECT_NEAR(truss.go(diagonal(0.7, 1.0))[0] / neohookean(nu, 0, 0.7, more, more), 1.0, 1e-12);
}

// a metal sheet in uniaxial tension beyond yield: strength of the law, no stress across in any step
TEST(PlaneStress, PlasticStrip)
{
  Surface s("density 1 eos linear 1000 strength j2 400 1 hardening linear 0", 3, 1, true);
  double stress = 0.0;
  for (int k = 1; k <= 400; k++) stress = s.go(diagonal(1.0 + 1e-4 * k, 1.0))[0];
  EXPECT_NEAR(stress, 1.0, 1e-11);
}

// metals, rubber, concrete, glass, ice, snow, whose stress has kinks and steps, go through a random
// motion with nothing across, up to what a stretch found to 1e-11 leaves
TEST(PlaneStress, AnyLaw)
{
  for (const std::string name :
       {"Cu_OFHC_J2", "Cu_OFHC_SCG", "Cu_OFHC_ZA", "Steel_4340_JC_failure", "Weldox_460E_failure",
        "Gelatin_10_ballistic", "PMMA_elastic", "Rubber_Treloar_Ogden", "Concrete_C30_MC",
        "Concrete_C30_brittle", "Glass_soda_lime", "Ice", "Snow_Stomakhin"})
    for (const int along : {1, 2})
      for (const double strain : {1e-5, 1e-3}) {
        SCOPED_TRACE(joined(name, " along ", along, " strain ", strain));
        Surface s(definition(name), 3, along, true);
        const double origin[3] = {0.0, 0.0, 0.0};
        std::vector<double> start(s.history.size());
        s.material->initialize(origin, start.data());
        for (std::size_t k = 0; k < s.material->history().size(); k++)
          s.history[k * BATCH] = start[k];
        for (int d = 0; d < 9; d += 4) s.batch.F[d][0] = 1.0;
        s.batch.J[0] = s.batch.Jold[0] = 1.0;
        s.batch.dt = 1e-5;
        s.batch.h = 0.01;
        s.material->initial_stress(s.batch);
        double c[BATCH], largest = 0.0;
        s.material->wave_speed(s.batch, c);
        RandomMatrix random(7);
        Matrix F = IDENTITY;
        for (int k = 0; k < 300 && !HasFailure(); k++) {
          Matrix step = random(0.3 * strain);
          step[0] += 0.5 * strain * std::sin(0.03 * k);
          for (int d = 0; d < 9; d += 4) step[d] += 1.0;
          F = step * F;
          const Matrix stress = s.go(F);
          largest = std::max(largest, size(stress));
          double n[2][3], across[3], along_it = 0.0, mean = 0.0;
          for (int m = 0; m < along; m++)
            for (int d = 0; d < 3; d++) n[m][d] = dot(&s.point.along[3 * d], s.point.frame[m]);
          if (along == 2)
            cross(n[0], n[1], across);
          else
            std::copy_n(n[0], 3, across);
          for (int i = 0; i < 3; i++) {
            mean += stress[4 * i];
            for (int j = 0; j < 3; j++)
              along_it += across[i] * across[j] * stress[3 * i + j] / dot(across, across);
          }
          EXPECT_NEAR(along == 2 ? along_it : 0.5 * (mean - along_it), 0.0,
                      1e-9 * largest + 4e-11 * s.material->density() * c[0] * c[0]);
        }
      }
}

TEST(PlaneStress, Refuses)
{
  const auto message = [](const std::string &text, bool compression) -> std::string {
    try {
      const auto material = make(text);
      PlaneStress state(*material, 3, 2, compression);
    } catch (const std::runtime_error &e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(rubber(0.3), true), "");
  EXPECT_EQ(message("density 1 eos linear 1000 strength j2 400 1", true), "");
  EXPECT_EQ(message(definition("Glass_soda_lime"), true), "");
  EXPECT_EQ(message(definition("Wood_Sitka_spruce"), true), "it must be isotropic");
  EXPECT_NE(message("density 1 eos linear 1000 strength j2 400 1", false).find("elastic"),
            std::string::npos);
  EXPECT_NE(message("density 1 linear 1000 0.3 viscosity newtonian 1", false).find("elastic"),
            std::string::npos);
}

/** rho_0 c^2 of the fastest wave along a body in this state: derivatives of its stress by any l = m
 *  n^T with unit vectors m and n along it, or its tension, which is that of a string. */
double fastest(Surface &s, const Matrix &F)
{
  constexpr double STEP = 1e-5;
  constexpr int N = 24;
  double frame[2][3];    // along the body, in space
  for (int k = 0; k < s.along; k++)
    for (int d = 0; d < 3; d++) frame[k][d] = dot(&F[3 * d], s.point.frame[k]);
  for (int k = 0; k < s.along; k++) {
    const double part = k ? dot(frame[0], frame[1]) : 0.0;
    for (int d = 0; d < 3; d++) frame[k][d] -= k ? part * frame[0][d] : 0.0;
    const double length = std::sqrt(dot(frame[k], frame[k]));
    for (double &v : frame[k]) v /= length;
  }
  const auto direction = [&](int k, double *n) {
    for (int d = 0; d < 3; d++)
      n[d] = s.along == 1
          ? frame[0][d]
          : std::cos(M_PI * k / N) * frame[0][d] + std::sin(M_PI * k / N) * frame[1][d];
  };
  double largest = 0.0;
  for (int k = 0; k < (s.along == 1 ? 1 : N * N); k++) {
    double m[3], n[3], force[2], pull = 0.0;
    direction(k % N, m);
    direction(k / N, n);
    for (const int side : {0, 1}) {
      const double e = side ? STEP : -STEP;
      Matrix change = IDENTITY;
      for (int c = 0; c < 9; c++) change[c] += e * m[c / 3] * n[c % 3];
      const Matrix stress = s.go(change * F);
      force[side] = pull = 0.0;
      for (int c = 0; c < 9; c++) {
        force[side] += s.batch.J[0] * m[c / 3] * stress[c] * n[c % 3] / (1.0 + e * dot(m, n));
        pull += s.batch.J[0] * n[c / 3] * stress[c] * n[c % 3];
      }
    }
    largest = std::max({largest, (force[1] - force[0]) / (2.0 * STEP), pull});
  }
  return largest;
}

double squared_speed(Surface &s, const Matrix &F)
{
  s.go(F);
  const double *const motion = s.point.along;
  double c[BATCH];
  s.state.wave_speed(s.batch, &motion, c);
  return c[0] * c[0];
}

// waves along surfaces, cables, and strips of elastic materials, also where these are all but
// incompressible and stretched: by differences of their stress, and at rest as in textbooks
TEST(PlaneStress, SpeedOfWaves)
{
  const Matrix states[] = {diagonal(1.0, 1.0),
                           diagonal(1.5, 1.0),
                           diagonal(2.0, 1.6),
                           {1.3, 0.4, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0}};
  for (const std::string law : {"neohookean 1000 ", "hencky 1000 ", "linear 1000 "})
    for (const double nu : {0.0, 0.3, 0.49, 0.499})
      for (const auto &[dim, along] : {std::pair(3, 2), std::pair(3, 1), std::pair(2, 1)})
        for (const auto &F : states) {
          SCOPED_TRACE(joined(law, nu, " dim ", dim, " along ", along, " F ", F[0], " ", F[1]));
          Surface s(joined("density 1 ", law, nu), dim, along, true);
          const double squared = squared_speed(s, F), exact = fastest(s, F);
          EXPECT_GT(squared, (1.0 - 1e-3) * exact);
          // the bound of waves in the material itself is less sharp for others
          EXPECT_LT(squared, (law[0] == 'n' ? 1.03 : 1.25) * exact);
          if (&F == states)
            EXPECT_NEAR(squared, along == 1 && dim == 3 ? E : E / (1.0 - nu * nu), 1e-3 * E);
        }
  // what relaxes in time has its stiffness at once
  for (const auto &F : states) {
    Surface s("density 1 neohookean 1000 0.499 viscosity maxwell term 300 10", 3, 2, true);
    s.batch.dt = 0.0;
    const double squared = squared_speed(s, F), exact = fastest(s, F);
    EXPECT_GT(squared, (1.0 - 1e-3) * exact);
    EXPECT_LT(squared, 1.25 * exact);
  }
  // with two axes, with a law of history, and with a viscosity, which raises it
  Surface foil("density 1 orthotropic 2000 1000 500 0.2 0.1 0.1 300 200 100", 3, 2, true, true);
  const double squared = squared_speed(foil, diagonal(1.0, 1.0)),
               exact = fastest(foil, diagonal(1.0, 1.0));
  EXPECT_GT(squared, (1.0 - 1e-3) * exact);
  EXPECT_LT(squared, 1.03 * exact);
  const std::string metal = "density 1 eos linear 1000 strength j2 400 1";
  const double young = 9.0 * 1000.0 * 400.0 / (3.0 * 1000.0 + 400.0),
               nu = 0.5 * young / 400.0 - 1.0;
  Surface sheet(metal, 3, 2, true), damped(metal + " viscosity artificial 0 0.5", 3, 2, true);
  EXPECT_NEAR(squared_speed(sheet, diagonal(1.0, 1.0)), young / (1.0 - nu * nu), 1e-3 * young);
  EXPECT_NEAR(std::sqrt(squared_speed(damped, diagonal(1.0, 1.0)) /
                        squared_speed(sheet, diagonal(1.0, 1.0))),
              std::sqrt(1.25) + 0.5, 1e-6);
}

// gas: blow-down through a choked nozzle (V2); filling of an empty bag, and of a full one
TEST(BagGas, BlowDownAndFilling)
{
  const double gamma = 1.4, R = 287.0, T = 300.0, V = 0.1, p = 1e6, area = 1e-4;
  const double factor =
      BagGas::flow(p, 0.0, R * T, gamma) * std::sqrt(R * T) / (p * std::sqrt(gamma));
  EXPECT_NEAR(factor, 0.578704, 1e-6);
  EXPECT_NEAR(BagGas::flow(p, 0.52828178 * p, R * T, gamma) / BagGas::flow(p, 0.0, R * T, gamma),
              1.0, 1e-12);
  EXPECT_EQ(BagGas::flow(p, p, R * T, gamma), 0.0);
  EXPECT_NEAR(BagGas::flow(p, 0.8 * p, R * T, 1.0 + 1e-7) / BagGas::flow(p, 0.8 * p, R * T, 1.0),
              1.0, 2e-7);

  for (const auto &[tau, pressure, temperature] :
       {std::tuple(0.5, 0.513158, 0.0), std::tuple(1.0, 0.279082, 0.694444)}) {
    BagGas gas{gamma, R, p * V / (R * T), V, T};
    const double end = tau * V / (factor * area * std::sqrt(gamma * R * T));
    const int n = 20000;
    for (int k = 0; k < n; k++) {
      const double out =
          area * BagGas::flow(gas.pressure(), 0.0, R * gas.temperature, gamma) * end / n;
      gas.add(-out, gas.temperature);
    }
    EXPECT_NEAR(gas.pressure() / p, pressure, 1e-4);
    if (temperature > 0.0) EXPECT_NEAR(gas.temperature / T, temperature, 1e-4);
  }
  BagGas empty{gamma, R, 1e-12, V, T}, half{gamma, R, 1.0, V, T};
  empty.add(1.0, T);
  half.add(1.0, T);
  EXPECT_NEAR(empty.temperature / T, 1.4, 1e-10);
  EXPECT_NEAR(half.temperature / T, 1.2, 1e-12);
  const double before = half.pressure() * std::pow(half.volume, gamma);
  for (int k = 0; k < 100; k++) half.expand(V * (1.0 + 0.5 * std::sin(k)));
  EXPECT_NEAR(half.pressure() * std::pow(half.volume, gamma) / before, 1.0, 1e-12);
}

// V4: a piston of 10 kg falls at 5 m/s on a cylinder of gas: how deep it comes, when, and the
// pressure there, with the time step of an explicit run; the energy of piston and gas is kept
TEST(BagGas, Piston)
{
  const double mass = 10.0, area = 0.01, length = 0.5, p0 = 1e5, g = 9.81, dt = 1e-5;
  BagGas gas{1.4, 287.0, p0 * area * length / (287.0 * 300.0), area * length, 300.0};
  double x = 0.0, v = 5.0, time = 0.0, deepest = 0.0, at = 0.0, highest = 0.0;
  const auto acceleration = [&] {
    return g - (gas.pressure() - p0) * area / mass;
  };
  const auto energy = [&] {
    return 0.5 * mass * v * v - mass * g * x - p0 * area * x + gas.energy();
  };
  const double start = energy();
  while (v > -3.0) {
    v += 0.5 * dt * acceleration();
    x += dt * v;
    gas.expand(area * (length - x));
    v += 0.5 * dt * acceleration();
    time += dt;
    if (x <= deepest) continue;
    deepest = x;
    at = time;
    highest = gas.pressure();
  }
  EXPECT_NEAR(deepest, 0.25009089, 8e-9);
  EXPECT_NEAR(highest / 264035.96, 1.0, 2e-8);
  EXPECT_NEAR(at, 0.0697498, 2e-6);
  EXPECT_NEAR(energy() / start, 1.0, 2e-9);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics
// timeout: 900

// Plastic flow in structures and waves that have solutions in closed form.

#include "mpm_lammps.h"

using namespace MPM_TEST;

// E1(f): a bar in uniaxial strain hits a wall at 100 m/s. An elastic precursor, then the plastic
// wave. J2, E = 70 GPa, nu = 0.33, yield stress 0.3 GPa; velocities in the frame of the bar.
TEST(PlasticWave, TwoWaveStructure)
{
  const double E = 70e9, nu = 0.33, sigmay = 0.3e9, rho = 2700.0, up = 100.0;
  const double K = E / (3.0 * (1.0 - 2.0 * nu)), G = E / (2.0 * (1.0 + nu));
  const int cells = 400;
  const double L = 0.4, h = L / cells;

  // small strain, and both waves for finite strain: stress over volume ratio J behind them
  const double hel = sigmay * (1.0 - nu) / (1.0 - 2.0 * nu), cl = sqrt((K + 4.0 / 3.0 * G) / rho);
  EXPECT_NEAR(hel, 591.176e6, 1.0e3);
  double strain = sigmay / (2.0 * G);
  for (int i = 0; i < 50; i++) strain = sigmay * exp(-strain) / (2.0 * G);
  const double J1 = exp(-strain), s1 = K * (1.0 / J1 - 1.0) + 2.0 / 3.0 * sigmay;
  const double C1 = sqrt(s1 / (rho * (1.0 - J1))), u1 = s1 / (rho * C1);
  double low = 0.9, high = J1;    // rho (up - u1)^2 = (s2 - s1) (J1 - J2)
  double J2 = 0.0, s2 = 0.0;
  for (int i = 0; i < 60; i++) {
    J2 = 0.5 * (low + high);
    s2 = K * (1.0 / J2 - 1.0) + 2.0 / 3.0 * sigmay;
    ((s2 - s1) * (J1 - J2) > rho * (up - u1) * (up - u1) ? low : high) = J2;
  }
  const double C2 = (up - u1) / (J1 - J2);
  EXPECT_NEAR(s2, 1471.52e6, 0.02 * 1471.52e6);
  EXPECT_NEAR(C1, 6197.82, 0.01 * 6197.82);

  Scene run(plane("si", "f p", strprintf("0 %.17g 0 %.17g", L + 10 * h, h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer apic\n"
                      "region bar block 0 %.17g INF INF INF INF\ncreate_points 1 region bar ppc 2\n"
                      "fix m all mpm/material density %.17g eos linear %.17g strength j2 %.17g "
                      "%.17g viscosity artificial 1.5 0.06\n"
                      "velocity all set -%.17g 0 0\nfix wall all mpm/boundary xlo slip\n",
                      h, L, rho, K, G, sigmay, up));
  run.set_reference();
  const double time = 0.75 * L / cl, dt = 0.4 * h / cl;
  const int steps = (int) std::lround(time / dt);
  run.commands(strprintf("timestep %.17g\nrun %d\n", time / steps, steps));

  // means over parts of the plateaus, and positions where the stress is half-way
  double mean[2] = {0.0, 0.0}, speed = 0.0, front[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  const double X2 = C2 * time, X1 = C1 * time;
  std::vector<std::array<double, 3>> profile;
  for (int i = 0; i < run.n(); i++) {
    const auto sigma = run.cauchy(i);
    const double X = run.reference(i)[0], s = -sigma[0];
    const int k = X < 0.9 * X2 && X > 0.3 * X2                 ? 0
        : X > X2 + 0.3 * (X1 - X2) && X < X2 + 0.8 * (X1 - X2) ? 1
                                                               : -1;
    if (k >= 0) {
      mean[k] += s;
      count[k]++;
    }
    if (k == 1) speed += run.v()[i][0] + up;
    profile.push_back({X, s, 0.0});
  }
  std::sort(profile.begin(), profile.end());
  for (size_t i = 1; i < profile.size(); i++)
    for (int k = 0; k < 2; k++) {
      const double half = k == 0 ? 0.5 * (s1 + s2) : 0.5 * s1;
      const double a = profile[i - 1][1], b = profile[i][1];
      if (a > half && b <= half)
        front[k] = profile[i - 1][0] + (a - half) / (a - b) * (profile[i][0] - profile[i - 1][0]);
    }
  EXPECT_NEAR(measured("E1f stress behind the plastic wave, MPa", mean[0] / count[0] / 1e6),
              s2 / 1e6, 0.02 * s2 / 1e6);
  EXPECT_NEAR(measured("E1f stress of the precursor, MPa", mean[1] / count[1] / 1e6), s1 / 1e6,
              0.02 * s1 / 1e6);
  EXPECT_NEAR(measured("E1f velocity behind the precursor", speed / count[1]), u1, 0.02 * u1);
  EXPECT_NEAR(measured("E1f speed of the plastic wave", front[0] / time), C2, 0.01 * C2);
  EXPECT_NEAR(measured("E1f speed of the precursor", front[1] / time), C1, 0.01 * C1);
}

// Thick-walled tube under internal pressure, plane strain, ideally plastic (R. Hill, The
// Mathematical Theory of Plasticity, 1950, ch. V): plastic for r < c with
//   p = k [2 ln(c/a) + 1 - c^2/b^2],  k = SIGMAY/sqrt(3)  (von Mises, exact for nu = 1/2)
// and at the outer surface u = 2 (1 - nu^2) k c^2/(E b). A quarter, points on circles.
struct Tube {
  double outer, plastic;    // displacement of the outer surface, radius of the plastic zone
};

static Tube tube(double h, double p, double nu, double yield)
{
  const double a = 1.0, b = 2.0, G = 1.0, K = 2.0 * G * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
  const double d = 0.5 * h;
  const int nr = std::lround((b - a) / d), nt = std::lround(0.5 * PI * 1.5 / d);
  const double time = 100.0, c = sqrt(K + 4.0 / 3.0 * G);
  Scene run(plane("lj", "f f", strprintf("0 %.17g 0 %.17g", 2.0 + 4 * h, 2.0 + 4 * h), 1, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer apic\n"
                      "region strip block 0 %.17g 0 %.17g INF INF\n"
                      "create_points 1 region strip spacing %.17g %.17g outside ignore\n"
                      "fix m all mpm/material density 1 eos linear %.17g strength j2 %.17g %.17g\n"
                      "fix walls all mpm/boundary xlo ylo slip\ncompute e all mpm/atom eplastic\n",
                      h, nr * 0.01, nt * 0.01, 0.01, 0.01, K, G, yield));
  EXPECT_EQ(run.n(), nr * nt);
  auto *atom = run.lmp->atom;
  for (int i = 0; i < run.n(); i++) {
    const int ir = atom->x[i][0] / 0.01, it = atom->x[i][1] / 0.01;
    const double r = a + (ir + 0.5) * (b - a) / nr, t = (it + 0.5) * 0.5 * PI / nt;
    atom->x[i][0] = r * cos(t);
    atom->x[i][1] = r * sin(t);
    atom->vfrac[i] = r * (b - a) / nr * 0.5 * PI / nt;
    atom->rmass[i] = atom->vfrac[i];
  }
  run.set_reference();
  run.each_step([&](double **force) {
    const double s = std::min(1.0, run.time() / (0.8 * time)), ramp = s * s * (3.0 - 2.0 * s);
    for (int i = 0; i < run.n(); i++) {
      const double *X = run.reference(i), R = sqrt(X[0] * X[0] + X[1] * X[1]);
      if (R > a + 0.9 * (b - a) / nr) continue;
      const double *x = run.x()[i], r = sqrt(x[0] * x[0] + x[1] * x[1]);
      for (int k = 0; k < 2; k++) force[i][k] = ramp * p * a * 0.5 * PI / nt * x[k] / r;
    }
  });
  const double dt = 0.4 * h / c;
  run.commands(strprintf("timestep %.17g\nrun %d\n", dt, (int) (time / dt)));
  Tube t = {0.0, 0.0};
  int n = 0;
  auto *eplastic = run.per_atom("e");
  for (int i = 0; i < run.n(); i++) {
    const double *X = run.reference(i), *x = run.x()[i];
    const double R = sqrt(X[0] * X[0] + X[1] * X[1]), u = sqrt(x[0] * x[0] + x[1] * x[1]) - R;
    if (eplastic->vector_atom[i] > 0.0) t.plastic = std::max(t.plastic, R);
    if (R < b - (b - a) / nr) continue;
    t.outer += u;
    n++;
  }
  t.outer /= n;
  return t;
}

TEST(Tube, InternalPressure)
{
  LONG_CASE();
  const double k = 0.005, b = 2.0;
  for (const double nu : {0.3, 0.45}) {
    const double E = 2.0 * (1.0 + nu), factor = 2.0 * (1.0 - nu * nu) * b / E;
    // elastic
    const double half = 0.5 * k;
    const Tube elastic = tube(0.1, half, nu, k * sqrt(3.0));
    EXPECT_EQ(elastic.plastic, 0.0);
    EXPECT_NEAR(
        measured("tube elastic u(b)/exact", elastic.outer / (factor * half / (b * b - 1.0))), 1.0,
        0.04);
    // plastic up to the middle, at 90 % of the limit load 2 k ln(b/a)
    const double c = 1.5, p = k * (2.0 * log(c) + 1.0 - c * c / b / b);
    double error[2];
    for (int level = 0; level < 2; level++) {
      const double h = level ? 0.05 : 0.1;
      const Tube t = tube(h, p, nu, k * sqrt(3.0));
      const double ratio = t.outer / (factor * k * c * c / (b * b));
      measured(strprintf("tube nu %g h %g u(b)/exact", nu, h), ratio);
      EXPECT_NEAR(measured("radius of the plastic zone", t.plastic), c, h);
      error[level] = std::abs(ratio - 1.0);
    }
    EXPECT_LT(error[0], 0.06);
    EXPECT_LT(error[1], 0.03);
    EXPECT_LT(error[1], 0.7 * error[0]);
  }
}

// E4: Taylor bar of the steel 42CrMo4 (O. Pantale, DynELA), 32.4 mm long, radius 3.2 mm, 287 m/s,
// 80 microseconds, Johnson-Cook with heating; a quarter of it. Axisymmetric finite elements (own,
// 16 x 160, frictionless): length 26.525 mm, diameter 11.237 mm, plastic strain 1.884, 608 C;
// DynELA and Abaqus in 3d: 26.52 to 26.55, 11.18 to 11.22, 1.84, 597.
TEST(TaylorBar, SteelThatHeats)
{
  LONG_CASE();
  const double h = 0.0004, d = 0.25 * h;    // d: half the spacing of points
  Scene run(
      space("si", "f f f", strprintf("0 %.17g 0 %.17g 0 %.17g", 19 * h, 19 * h, 86 * h), 1,
            0.5 * h) +
      strprintf(
          "fix grid all mpm %.17g\nregion bar cylinder z 0 0 0.0032 0 0.0324\n"
          "create_points 1 region bar ppc 2 outside ignore\n"
          "fix steel all mpm/material density 7830 eos linear 172.41667e9 strength johnson/cook "
          "79.5769e9 806e6 614e6 0.168 0.0089 1 1.1 1540 20 thermal adiabatic 460 20 0.9\n"
          "velocity all set 0 0 -287\nfix anvil all mpm/boundary zlo xlo ylo slip\n"
          "fix step all mpm/dt 0.5\nvariable t equal time\n"
          "fix end all halt 1 v_t > 8.0e-5 error continue\n"
          "compute p all mpm/atom eplastic temperature\nrun 20000\n",
          h));
  EXPECT_NEAR(run.time(), 8.0e-5, 1.0e-7);
  auto *history = run.per_atom("p");
  double top = 0.0, foot = 0.0, eplastic = 0.0, temperature = 0.0;
  for (int i = 0; i < run.n(); i++) {
    const double *x = run.x()[i];
    top = std::max(top, x[2]);
    foot = std::max(foot, sqrt(x[0] * x[0] + x[1] * x[1]));
    eplastic = std::max(eplastic, history->array_atom[i][0]);
    temperature = std::max(temperature, history->array_atom[i][1]);
  }
  EXPECT_NEAR(measured("E4 length", 1.0e3 * (top + d)), 26.525, 0.005 * 26.525);
  EXPECT_NEAR(measured("E4 diameter", 2.0e3 * (foot + d)), 11.237, 0.03 * 11.237);
  EXPECT_NEAR(measured("E4 plastic strain", eplastic), 1.86, 0.05 * 1.86);
  EXPECT_NEAR(measured("E4 temperature", temperature), 600.0, 0.05 * 600.0);
}

// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: physics

// Standing waves in damped solids, one cell across: amplitude over two periods; energy.

#include "mpm_lammps.h"

using namespace MPM_TEST;

/** Displacement u, velocity v, strains q of Maxwell elements of the mode exp(i k x): density v' =
 *  -k^2 (M u + eta v + sum 4/3 G q), q' = v - q/tau, by the classical Runge-Kutta method. */
struct Mode {
  double M, eta, G[2], tau[2], k;
  double y[4] = {0.0, 1.0, 0.0, 0.0};

  void slope(const double *y, double *d) const
  {
    d[0] = y[1];
    d[1] = -k * k * (M * y[0] + eta * y[1] + 4.0 / 3.0 * (G[0] * y[2] + G[1] * y[3]));
    for (int e = 0; e < 2; e++) d[2 + e] = y[1] - y[2 + e] / tau[e];
  }
  void advance(double dt)
  {
    double a[4], b[4], c[4], d[4], z[4];
    slope(y, a);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * dt * a[i];
    slope(z, b);
    for (int i = 0; i < 4; i++) z[i] = y[i] + 0.5 * dt * b[i];
    slope(z, c);
    for (int i = 0; i < 4; i++) z[i] = y[i] + dt * c[i];
    slope(z, d);
    for (int i = 0; i < 4; i++) y[i] += dt / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  }
};

struct Case {
  const char *name, *law;    // density 1, length 1; M = 100 without damping
  double eta, G[2], tau[2];
  friend void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }
};

static const Case cases[] = {
    {"elastic", "hencky 100 0", 0.0, {0.0, 0.0}, {1.0, 1.0}},
    {"KelvinVoigt", "linear 100 0 viscosity newtonian 0.15 bulk 0.1", 0.3, {0.0, 0.0}, {1.0, 1.0}},
    {"newtonian", "neohookean 100 0 viscosity newtonian 0.15", 0.2, {0.0, 0.0}, {1.0, 1.0}},
    {"Maxwell",
     "hencky 100 0 viscosity maxwell term 30 0.02 term 15 0.003",
     0.0,
     {30, 15},
     {0.02, 0.003}},
    {"MaxwellLinear",
     "linear 100 0 viscosity maxwell term 30 0.02 term 15 0.003",
     0.0,
     {30, 15},
     {0.02, 0.003}},
};

PARAMETER_TEST(StandingWave, AmplitudeAndEnergy, Case, ValuesIn(cases))
{
  const Case &c = GetParam();
  const double h = 1.0 / 96.0, k = 2.0 * PI, v0 = 1.0e-3;
  Scene run(plane("si", "p p", strprintf("0 1 0 %.17g", h), 2, 0.4 * h) +
            strprintf("fix grid all mpm %.17g shape quadratic transfer flip 1.0 scheme musl\n"
                      "create_points 1 box ppc 2\nfix solid all mpm/material density 1 %s\n",
                      h, c.law));
  run.set_reference();
  const int n = run.n();
  for (int i = 0; i < n; i++) run.v()[i][0] = v0 * std::sin(k * run.x()[i][0]);
  const double energy0 = run.sums().kinetic;

  Mode mode{100.0, c.eta, {c.G[0], c.G[1]}, {c.tau[0], c.tau[1]}, k};
  double worst = 0.0;
  const double dt = 1.0e-4;
  run.each_step([&](double **) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += 2.0 / n * run.v()[i][0] / v0 * std::sin(k * run.x()[i][0]);
    worst = std::max(worst, std::abs(sum - mode.y[1]));
    mode.advance(dt);
  });
  run.commands(strprintf("timestep %.17g\nrun 2000\n", dt));
  measured(std::string(c.name) + " error of the amplitude", worst);
  measured(std::string(c.name) + " amplitude left", std::hypot(mode.y[1], 10.0 * k * mode.y[0]));
  EXPECT_LT(worst, 0.02);

  const auto *material = run.material("solid");
  const double left = run.sums().kinetic + run.stored_energy(),
               viscous = material->work[MPM_NS::VISCOUS];
  measured(std::string(c.name) + " viscous work", viscous / energy0);
  EXPECT_NEAR((left + viscous) / energy0, 1.0, 0.01);
}

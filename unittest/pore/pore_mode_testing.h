// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_PORE_MODE_TESTING_H
#define MPM_PORE_MODE_TESTING_H

// Waves of saturated soil between closed ends, for tests of fix mpm/pore.

#include "pore/pore_testing.h"
#include "wave_testing.h"

namespace MPM_TEST {

// porosity, density of the saturated soil, weight of the water per volume
constexpr double N = 0.4, RHO = 0.6 * 2650.0 + N * 1000.0, G = 9810.0;
/** First mode of vibration of a column of soil between closed ends. */
struct Mode {
  double K, k;             ///< bulk modulus of water, hydraulic conductivity
  std::string transfer;    ///< options of fix mpm
};

/** Velocity of the soil at the given times, in units of its initial value. The velocity v of the
 *  soil, the flow w, the stress s, and the pressure p of the mode are integrated by RK4, with v = 1
 *  and the others 0 at the start. moves: false for u-p, without inertia of w. */
inline std::vector<double> exact(const Mode &mode, const std::vector<double> &times,
                                 bool moves = true)
{
  using State = std::array<double, 4>;
  const double wave = PI, rhof = 1000.0, R = G / mode.k;
  const auto rate = [&](const State &y) {
    // rho v' + rhof w' = F, rhof v' + rhof/n w' = D
    const double F = wave * (y[3] - y[2]), D = wave * y[3] - R * y[1];
    if (!moves) {    // u-p: w follows the pressure
      const double w = wave * y[3] / R;
      return State{F / RHO, 0.0, MODULUS * wave * y[0], -mode.K / N * wave * (y[0] + w)};
    }
    const double a = (F - N * D) / (RHO - N * rhof), w = N * (D / rhof - a);
    return State{a, w, MODULUS * wave * y[0], -mode.K / N * wave * (y[0] + y[1])};
  };
  State y = {1.0, 0.0, 0.0, 0.0};
  std::vector<double> result;
  double now = 0.0;
  for (const double at : times) {
    const int steps = 1 + (int) ((at - now) * (5e4 + R * N / rhof));
    const double dt = (at - now) / steps;
    for (int k = 0; k < steps; k++) {
      const auto add = [&](const State &r, double by) {
        State sum = y;
        for (int j = 0; j < 4; j++) sum[j] += by * r[j];
        return sum;
      };
      const auto a = rate(y), b = rate(add(a, 0.5 * dt)), c = rate(add(b, 0.5 * dt)),
                 d = rate(add(c, dt));
      for (int j = 0; j < 4; j++) y[j] += dt / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
    }
    now = at;
    result.push_back(y[0]);
  }
  return result;
}

/** Runs the mode for about this many periods. Appends times of steps to t, and to y the amplitude
 *  of the velocity of points in units of the initial one. formulation: options of fix mpm/pore. */
inline void vibrate(const Mode &mode, const std::string &formulation, double periods,
                    std::vector<double> &t, std::vector<double> &y)
{
  const int n = 40;
  Scene run(
      replaced(
          column(n, strprintf("%g 1000 9810 soil m 0.4 constant %g ", mode.K, mode.k) + formulation,
                 "density 1990 linear 1e7 0.3", 1.0, 0.0, "ylo yhi"),
          "origin", mode.transfer + " origin") +
      "fix dt all mpm/dt 0.2\n");
  run.set_velocity([](const double *x, double *v) {
    v[1] = 1e-4 * std::sin(PI * x[1]);
  });
  run.each_step([&](double **) {
    double sum = 0.0, norm = 0.0;
    for (int i = 0; i < run.n(); i++) {
      const double w = std::sin(PI * run.x()[i][1]);
      sum += 1e4 * w * run.v()[i][1];
      norm += w * w;
    }
    t.push_back(run.time());
    y.push_back(sum / norm);
  });
  const double end = periods * 2.0 * PI / (1690.0 * std::sqrt(mode.K / 2.2e8));
  run.commands(strprintf("variable t equal time\nfix end all halt 1 v_t > %.17g error continue\n"
                         "run 100000\n",
                         end));
}

}    // namespace MPM_TEST

#endif

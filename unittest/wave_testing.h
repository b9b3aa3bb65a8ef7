// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_WAVE_TESTING_H
#define MPM_WAVE_TESTING_H

// When a signal is zero; frequency and decay of a standing wave.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Times at which a signal changes its sign. */
class Crossings {
  double t_old = 0.0, s_old = 0.0;

 public:
  std::vector<double> times;
  void add(double t, double s)
  {
    if (s * s_old < 0.0) times.push_back(t_old + (t - t_old) * s_old / (s_old - s));
    t_old = t;
    s_old = s;
  }
  /** Mean of full periods: crossings of one direction. */
  double period() const
  {
    const int n = ((int) times.size() - 1) / 2;
    return n > 0 ? (times[2 * n] - times[0]) / n : 0.0;
  }
  /** Circular frequency by all crossings. */
  double frequency() const
  {
    return times.size() > 1 ? PI * (times.size() - 1.0) / (times.back() - times.front()) : 0.0;
  }
};

/** Times at which y(t) is zero. */
inline std::vector<double> zeros_of(const std::vector<double> &t, const std::vector<double> &y)
{
  Crossings zeros;
  for (std::size_t k = 0; k < y.size(); k++) zeros.add(t[k], y[k]);
  return zeros.times;
}

/** Angular frequency and decay rate of a signal y(t), from its first and last zeros and peaks. */
inline std::array<double, 2> frequency_and_decay(const std::vector<double> &t,
                                                 const std::vector<double> &y)
{
  const auto zeros = zeros_of(t, y);
  std::vector<double> when, peaks;
  for (std::size_t k = 1; k + 1 < y.size(); k++) {
    const double a = fabs(y[k - 1]), b = fabs(y[k]), c = fabs(y[k + 1]);
    if (b > a && b >= c && k > 3) {
      const double u = 0.5 * (a - c) / (a - 2.0 * b + c);
      peaks.push_back(b - 0.25 * (a - c) * u);
      when.push_back(t[k] + u * (t[k + 1] - t[k]));
    }
  }
  return {PI * (zeros.size() - 1.0) / (zeros.back() - zeros.front()),
          log(peaks.front() / peaks.back()) / (when.back() - when.front())};
}

}    // namespace MPM_TEST

#endif

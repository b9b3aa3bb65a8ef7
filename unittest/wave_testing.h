// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_WAVE_TESTING_H
#define MPM_WAVE_TESTING_H

// Frequency and decay of a standing wave, for tests of soil and water.

#include "mpm_lammps.h"

namespace MPM_TEST {

/** Angular frequency and decay rate of a signal y(t), from its first and last zeros and peaks. */
inline std::array<double, 2> frequency_and_decay(const std::vector<double> &t,
                                                 const std::vector<double> &y)
{
  std::vector<double> zeros, when, peaks;
  for (std::size_t k = 1; k + 1 < y.size(); k++) {
    if (y[k] * y[k + 1] < 0.0) zeros.push_back(t[k] + (t[k + 1] - t[k]) * y[k] / (y[k] - y[k + 1]));
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

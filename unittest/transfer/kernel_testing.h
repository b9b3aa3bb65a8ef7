/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_KERNEL_TESTING_H
#define MPM_KERNEL_TESTING_H

// Random numbers and comparisons for tests of the kernels.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace MPM_TEST {

using Reals = std::vector<double>;

inline std::mt19937 generator(20260704);

inline double uniform(double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(generator);
}
inline void fill(Reals &a, double size = 1.0)
{
  for (double &x : a) x = uniform(-size, size);
}

/** Largest difference, relative to the largest value. */
inline double difference(const Reals &a, const Reals &b)
{
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double diff = 0.0, scale = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < a.size(); i++) {
    if (!(std::abs(a[i] - b[i]) <= diff)) diff = std::abs(a[i] - b[i]);
    scale = std::max(scale, std::abs(b[i]));
  }
  return diff / scale;
}

}    // namespace MPM_TEST
#endif

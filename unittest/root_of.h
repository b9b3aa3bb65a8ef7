// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_ROOT_OF_H
#define MPM_ROOT_OF_H

namespace MPM_TEST {

/** Where a function changes its sign between low and high, by bisection down to round-off. */
template <class F> double root_of(double low, double high, const F &f)
{
  const bool positive = f(low) > 0.0;
  for (int k = 0; k < 100; k++) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == positive ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}    // namespace MPM_TEST
#endif

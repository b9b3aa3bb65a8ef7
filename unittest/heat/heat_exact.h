// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_HEAT_EXACT_H
#define MPM_HEAT_EXACT_H

// Exact solutions for tests of fix mpm/heat.

#include "heat/heat_testing.h"

namespace MPM_TEST {

/** The root k = 0, 1, ... of x tan(x) = Bi. */
inline double slab_root(double Bi, int k)
{
  double low = k * PI, high = (k + 0.5) * PI;
  for (int i = 0; i < 100; i++) {
    const double x = 0.5 * (low + high);
    (x * std::tan(x) > Bi ? high : low) = x;
  }
  return low;
}

/** Mean temperature at the Fourier number Fo of a slab of initial temperature 1. One side loses heat by
 *  convection (Biot number Bi) to surroundings of temperature 0; the other side is insulated. */
inline double slab_mean(double Bi, double Fo)
{
  double sum = 0.0;
  for (int k = 0; k < 50; k++) {
    const double b = slab_root(Bi, k);
    sum += 2.0 * std::sin(b) * std::sin(b) / (b * (b + std::sin(b) * std::cos(b))) *
        std::exp(-b * b * Fo);
  }
  return sum;
}

}    // namespace MPM_TEST
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pore/mpm_retention.h"

#include <cmath>

using namespace LAMMPS_NS;

MPMRetention::State MPMRetention::at(double p) const
{
  State state;
  if (!can_dry() || !(p < 0.0)) {
    state.effective = state.relative = 1.0;
    state.saturation = most;
    state.slope = 0.0;
  } else if (law == VAN_GENUCHTEN) {
    const double m = 1.0 - 1.0 / n, x = pow(-alpha * p, n);
    state.effective = exp(-m * log1p(x));
    state.slope = state.effective * (n - 1.0) * x / ((1.0 + x) * -p);
    if (flow != POWER) {
      const double open = x > 0.0 ? -expm1(-m * log1p(1.0 / x)) : 1.0;
      state.relative = sqrt(state.effective) * open * open;
    }
  } else {
    state.effective = exp(alpha * p);
    state.slope = alpha * state.effective;
    if (flow != POWER) state.relative = state.effective;
  }
  if (can_dry() && p < 0.0) {
    if (flow == POWER) state.relative = pow(state.effective, power);
    state.saturation = least + (most - least) * state.effective;
    state.slope *= most - least;
  }
  state.bishop = bishop_effective ? state.effective : state.saturation;
  return state;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_time_method.h"

using namespace LAMMPS_NS;

MPMTimeMethod::Coefficients MPMTimeMethod::coefficients() const
{
  double m = 0.0, f = 0.0, end = gamma;
  if (keeps_acceleration()) {
    f = kind == ALPHA ? rho / (1.0 + rho) : (1.0 - rho) / (1.0 + rho);
    m = kind == ALPHA ? (2.0 * rho - 1.0) / (1.0 + rho) : 0.0;
    end = 0.5 - m + f;
  }
  return {0.25 * (end + 0.5) * (end + 0.5), end, m, f};
}

double MPMTimeMethod::inertia_factor(double dt) const
{
  if (is_static()) return 0.0;
  const double factor = 1.0 / (displacement_share() * dt * dt);
  if (!uses_acceleration()) return factor;
  const auto with = coefficients();
  return factor * ((1.0 - with.alpha_m) / with.beta);
}

double MPMTimeMethod::end_velocity_share() const
{
  if (!moves_by_mean()) return 1.0;
  if (kind == MIDPOINT) return 0.5;
  const auto with = coefficients();
  return with.beta / with.gamma;
}

double MPMTimeMethod::reaction_share() const
{
  if (kind == MIDPOINT) return 1.0;
  const auto with = coefficients();
  return 2.0 * with.beta / (1.0 - with.alpha_m);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Contact in the methods of second order. Their forces are means of those at both ends of a step: walls that
   pressed at the start would go on pushing when a body leaves, and give it energy. Here the forces f of all
   walls are those of the end alone (C. Kane, E.A. Repetto, M. Ortiz, J.E. Marsden, Comput. Methods Appl.
   Mech. Eng. 180 (1999) 1):

     u = dt v0 + dt^2 [(1/2 - beta) a0 + beta a1] + dt^2 f/(2 m),    v = v0 + dt [(1 - gamma) a0 + gamma a1] + dt f/m

   where accelerations are those by all other forces. With beta = 1/4 and gamma = 1/2, u = dt (v0 + v)/2, and
   a wall changes the energy by its force times the gap that it closes, which takes energy. The reactions that
   Newton's method finds for beta m a1 are larger than f by the factor (1 - of_inertia)/(2 beta).

   Nodes that come to a wall would leave it with the opposite velocity, and bounce in each step. An impulse at
   the end of the step gives them the velocity of the wall, as in RATTLE in comparison to SHAKE (H.C.
   Andersen, J. Comput. Phys. 52 (1983) 24), and as in the contact of explicit steps. This takes the energy
   with which they come, that of half a cell of the body, and nothing from nodes that stay.

   Friction acts against the velocity v of the end, not against u, for the same reason: what sticks has v = 0.
   Where points keep accelerations, these contain the friction by the pressing force f: without it, nodes at
   the surface would have large accelerations, which points would bring to their neighbors. Otherwise friction
   is a part of f, and a term dt^2 (beta/gamma - 1/2) (a0 + f/m) of (beta/gamma) dt v is left out, which is
   zero where bodies stick or slip steadily, and for gamma = 1/2. Between bodies friction acts against u: what
   sticks there has u = 0, exactly, and then v = 0 by the impulse at the end. With v for what slides, neither
   would be right where slip ends within a step. The work of friction, with this force and u, takes energy,
   too.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit.h"

#include "field/mpm_field.h"
#include "field/mpm_trial_contact.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

double MPMImplicitOptions::share_of_end() const
{
  if (!moves_by_mean()) return 1.0;
  if (time == MIDPOINT) return 0.5;
  const auto with = coefficients();
  return with.beta / with.gamma;
}

/** Share of the reactions in the balance of forces that changes the momentum in the step. */
double MPMImplicit::share_of_contact() const
{
  if (options.time == MPMImplicitOptions::MIDPOINT) return 1.0;
  const auto with = options.coefficients();
  return 2.0 * with.beta / (1.0 - with.of_inertia);
}

/** Is friction part of the accelerations at both ends? In the first step the friction at its start is
 *  unknown. */
bool MPMImplicit::accelerates_by_friction() const
{
  return impacts && options.keeps_acceleration() && kept.known;
}

/** Called when velocities and accelerations of the start, and u*, are known. */
void MPMImplicit::begin_impacts()
{
  const double share = options.share_of_end();
  offset.resize(nreals());
  for (int64_t k = 0; k < nreals(); k++) offset[k] = dt * (share - 1.0) * start[k];
  if (accelerates_by_friction())
    for (int64_t k = 0; k < nreals(); k++) offset[k] += dt * dt * (share - 0.5) * acceleration[k];
}

/** Velocity at the end after the motion u, times dt and scaled so that u has the factor one. */
const double *MPMImplicit::slide_of(const std::vector<double> &u)
{
  if (!impacts) return u.data();
  slide.resize(u.size());
  for (std::size_t k = 0; k < u.size(); k++) slide[k] = u[k] + offset[k];
  return slide.data();
}

/** Sets velocities, and accelerations that are kept, at the end of the step. Collective. */
void MPMImplicit::end_impacts(const std::vector<double> &u)
{
  const bool midpoint = options.time == MPMImplicitOptions::MIDPOINT,
             keeps = options.keeps_acceleration(), with_friction = accelerates_by_friction();
  const auto with = options.coefficients();
  const double of_contact = share_of_contact();
  ending.assign(nreals(), 0.0);
  if (keeps) next.assign(nreals(), 0.0);
  for (int64_t k = 0; k < nreals(); k++) {
    const double m = mass[k / width];
    if (!(m > 0.0)) continue;
    if (midpoint) {
      ending[k] = 2.0 * u[k] / dt - start[k];
      continue;
    }
    const double rubbing = rubs ? friction[k] / m : 0.0,
                 contact = (free[k] - residual[k]) / m - (with_friction ? rubbing : 0.0),
                 end = (inertia * (u[k] - from[k]) - contact - with.of_inertia * acceleration[k]) /
        (1.0 - with.of_inertia);
    ending[k] = start[k] + dt * ((1.0 - with.gamma) * acceleration[k] + with.gamma * end) +
        dt * of_contact * contact;
    if (keeps) next[k] = end + (with_friction ? 0.0 : of_contact * rubbing);
  }
  stopped = ending;
  act(stopped.data());
  for (auto *contact : contacts) contact->take_stop();
  if (keeps) project(next.data());
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Contact in the methods of second order, in which forces are means of those of both ends of a step. Forces of walls that were there at the start push on
   when a body leaves, and give it energy. Here those of all walls are forces f of the end alone (C. Kane, E.A. Repetto, M. Ortiz, J.E. Marsden, Comput.
   Methods Appl. Mech. Eng. 180 (1999) 1):

     u = dt v0 + dt^2 [(1/2 - beta) a0 + beta a1] + dt^2 f/(2 m),    v = v0 + dt [(1 - gamma) a0 + gamma a1] + dt f/m

   with accelerations by all other forces. With beta = 1/4 and gamma = 1/2, u = dt (v0 + v)/2, and what a wall adds to the energy is its force times the gap
   that it closes, with the sign that takes energy. The reactions that Newton's method finds for beta m a1 are larger than f by the factor (1 - of_inertia)/(2 beta).

   Nodes that come to a wall would have minus their velocity after that, and bounce in each step. They get that of the wall, by an impulse at the end of the
   step, as SHAKE becomes RATTLE by it (H.C. Andersen, J. Comput. Phys. 52 (1983) 24), and as in the contact of explicit steps: this takes the energy
   with which they come, that of half a cell of the body, and nothing from what stays.

   Friction is against the velocity v of the end, not against u, for the same reason: what sticks has v = 0. Where accelerations are kept by points it is in
   these, with the force f that presses, as nodes at the surface would have large ones without it, which points would bring to their neighbors. Else it is a
   part of f, and a term dt^2 (beta/gamma - 1/2) (a0 + f/m) of (beta/gamma) dt v is left out, which is zero in what sticks, what slips steadily, and gamma = 1/2.
   Between bodies it is against u: what sticks there has u = 0, exactly, and then v = 0 by the impulse at the end. With v for what slides, neither would be right
   where slip comes to its end within a step. Its work, with this force and u, takes energy, too.
------------------------------------------------------------------------- */

#include "mpm_implicit.h"

#include "mpm_field.h"
#include "mpm_trial_contact.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

double MPMImplicitOptions::share_of_end() const
{
  if (!moves_by_mean()) return 1.0;
  if (time == MIDPOINT) return 0.5;
  const auto with = coefficients();
  return with.beta / with.gamma;
}

/** Of the reactions in the balance of forces, what changes the momentum in the step. */
double MPMImplicit::share_of_contact() const
{
  if (options.time == MPMImplicitOptions::MIDPOINT) return 1.0;
  const auto with = options.coefficients();
  return 2.0 * with.beta / (1.0 - with.of_inertia);
}

/** Is friction in the accelerations of both ends? In the first step nothing is known of that of its start. */
bool MPMImplicit::accelerates_by_friction() const
{
  return impacts && options.keeps_acceleration() && kept.known;
}

/** Velocities and accelerations of the start are known, and u*. */
void MPMImplicit::begin_impacts()
{
  const double share = options.share_of_end();
  offset.resize(nreals());
  for (int64_t k = 0; k < nreals(); k++) offset[k] = dt * (share - 1.0) * start[k];
  if (accelerates_by_friction())
    for (int64_t k = 0; k < nreals(); k++) offset[k] += dt * dt * (share - 0.5) * acceleration[k];
}

/** The velocity of the end after the motion u, in parts of what u changes it by, times dt. */
const double *MPMImplicit::slide_of(const std::vector<double> &u)
{
  if (!impacts) return u.data();
  slide.resize(u.size());
  for (std::size_t k = 0; k < u.size(); k++) slide[k] = u[k] + offset[k];
  return slide.data();
}

/** Velocities, and accelerations that are kept, of the end of the step. Collective. */
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

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Contact in the methods of second order. Their forces are means of those at both ends of a step:
   walls that pressed at the start would go on pushing when a body leaves, and give it energy. Here
   the forces f of all walls are those of the end alone (C. Kane, E.A. Repetto, M. Ortiz, J.E.
   Marsden, Comput. Methods Appl. Mech. Eng. 180 (1999) 1):

     u = dt v0 + dt^2 [(1/2 - beta) a0 + beta a1] + dt^2 f/(2 m),
     v = v0 + dt [(1 - gamma) a0 + gamma a1] + dt f/m

   where accelerations are those by all other forces. With beta = 1/4 and gamma = 1/2, u = dt (v0 +
   v)/2, and a wall changes the energy by its force times the gap that it closes, which takes
   energy. The reactions that Newton's method finds for beta m a1 are larger than f by the factor (1
   - alpha_m)/(2 beta).

   Nodes that come to a wall would leave it with the opposite velocity, and bounce in each step. An
   impulse at the end of the step gives them the velocity of the wall, as in RATTLE in comparison to
   SHAKE (H.C. Andersen, J. Comput. Phys. 52 (1983) 24), and as in the contact of explicit steps.
   This takes the energy with which they come, that of half a cell of the body, and nothing from
   nodes that stay.

   Friction acts against the velocity v of the end, not against u, for the same reason: what sticks
   has v = 0. Where points keep accelerations, these contain the friction by the pressing force f:
   without it, nodes at the surface would have large accelerations, which points would bring to
   their neighbors. Otherwise friction is a part of f, and a term dt^2 (beta/gamma - 1/2) (a0 + f/m)
   of (beta/gamma) dt v is left out, which is zero where bodies stick or slip steadily, and for
   gamma = 1/2. Between bodies friction acts against u: what sticks there has u = 0, exactly, and
   then v = 0 by the impulse at the end. With v for what slides, neither would be right where slip
   ends within a step. The work of friction, with this force and u, takes energy, too.
------------------------------------------------------------------------- */

#include "implicit/mpm_step_motion.h"

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_newton.h"
#include "implicit/mpm_solved_nodes.h"

using namespace LAMMPS_NS;

/** Is friction part of the accelerations at both ends? In the first step the friction at its start
 *  is unknown. */
bool MPMStepMotion::accelerates_by_friction() const
{
  return impacts && time.keeps_acceleration() && kept.known;
}

/** Called when velocities and accelerations of the start are known. With contact, what slips is the
 *  velocity at the end after the motion u, times dt and scaled so that u has the factor one. */
void MPMStepMotion::set_friction()
{
  if (!impacts) return constraints.set_friction(1.0, {});
  const double share = time.end_velocity_share();
  std::vector<double> offset(nodes.nreals());
  for (int64_t k = 0; k < nodes.nreals(); k++) offset[k] = dt * (share - 1.0) * start[k];
  if (accelerates_by_friction())
    for (int64_t k = 0; k < nodes.nreals(); k++)
      offset[k] += dt * dt * (share - 0.5) * acceleration[k];
  constraints.set_friction(accelerates_by_friction() ? time.reaction_share() : 1.0,
                           std::move(offset));
}

/** Sets velocities, and accelerations that are kept, at the end of the step. Collective. */
void MPMStepMotion::end_contact(const std::vector<double> &u)
{
  const bool midpoint = time.kind == MPMTimeMethod::MIDPOINT, keeps = time.keeps_acceleration(),
             with_friction = accelerates_by_friction(), rubs = constraints.rubs();
  const auto with = time.coefficients();
  const double share = time.reaction_share();
  const auto &residual = newton.residual(), &free = newton.free_forces(),
             &friction = constraints.friction_forces();
  ending.assign(nodes.nreals(), 0.0);
  if (keeps) end_acceleration.assign(nodes.nreals(), 0.0);
  for (int64_t k = 0; k < nodes.nreals(); k++) {
    const double m = nodes.mass[k / nodes.width];
    if (!(m > 0.0)) continue;
    if (midpoint) {
      ending[k] = 2.0 * u[k] / dt - start[k];
      continue;
    }
    const double rubbing = rubs ? friction[k] / m : 0.0,
                 contact = (free[k] - residual[k]) / m - (with_friction ? rubbing : 0.0),
                 pull = balance.inertia_per_mass() * (u[k] - balance.predictor[k]),
                 end = with.end_acceleration(pull - contact, acceleration[k]);
    ending[k] = start[k] + with.velocity_change(dt, acceleration[k], end) + dt * share * contact;
    if (keeps) end_acceleration[k] = end + (with_friction ? 0.0 : share * rubbing);
  }
  stopped = ending;
  constraints.act(stopped.data());
  constraints.take_stop();
  if (keeps) constraints.project(end_acceleration.data());
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_step_motion.h"

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_newton.h"
#include "implicit/mpm_solved_nodes.h"

#include "force.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

MPMStepMotion::MPMStepMotion(MPMSolvedNodes &nodes, MPMForceBalance &balance,
                             MPMConstraints &constraints, MPMNewton &newton,
                             const MPMTimeMethod &time, MPMPointAccelerations &kept) :
    nodes(nodes),
    balance(balance), constraints(constraints), newton(newton), time(time), kept(kept),
    affine(nodes)
{
}

void MPMStepMotion::begin_step(double step_dt, std::vector<double> &u)
{
  dt = step_dt;
  u.assign(nodes.nreals(), 0.0);
  impacts = !constraints.are_bilateral() && time.moves_by_mean();
  if (time.is_static()) return set_friction();

  // velocities and accelerations by the forces of the start of the step, with those of walls

  start = nodes.start_velocity;
  if (constraints.any() && constraints.are_bilateral()) constraints.act(start.data());
  for (int64_t k = 0; k < nodes.nreals(); k++) u[k] = dt * start[k];
  balance.predictor = u;
  if (time.uses_acceleration()) {
    acceleration = nodes.explicit_velocity;
    if (constraints.any() && !impacts) constraints.act(acceleration.data());
    for (int64_t k = 0; k < nodes.nreals(); k++)
      acceleration[k] = (acceleration[k] - start[k]) / dt;
    if (time.keeps_acceleration() && kept.known) find_accelerations();
    const double factor = time.coefficients().predictor_factor(dt);
    for (int64_t k = 0; k < nodes.nreals(); k++) balance.predictor[k] += factor * acceleration[k];
    balance.find_start_forces();
  }
  set_friction();
}

/** Accelerations of nodes from those that points have kept, with walls. */
void MPMStepMotion::find_accelerations()
{
  // walls with contact hold by forces of the end of the step alone: until then, nodes have
  // accelerations of the body there
  std::vector<double> borne;
  if (impacts) {
    std::vector<double> rest = acceleration;
    constraints.project(rest.data());
    borne = acceleration;
    for (int64_t k = 0; k < nodes.nreals(); k++) borne[k] -= rest[k];
  }
  kept.to_nodes(nodes, acceleration);
  if (impacts) mapped = acceleration;
  constraints.project(acceleration.data());
  for (std::size_t k = 0; k < borne.size(); k++) acceleration[k] += borne[k];
}

/** Gives points the change of the accelerations of nodes, in the first step all of them. */
void MPMStepMotion::keep_accelerations()
{
  const auto &had = impacts ? mapped : acceleration;
  if (kept.known)
    for (int64_t k = 0; k < nodes.nreals(); k++) end_acceleration[k] -= had[k];
  kept.add_from_nodes(nodes, end_acceleration);
}

/* ----------------------------------------------------------------------
   Velocities that node actions turn into those of the step, and with which reactions and works are
   counted as always: the part of the residual that is left is no impulse.

   Points move with the value in the place of the new velocity, u/dt. With FLIP, their velocity
   changes by the difference from the value in the place of the old one. In statics both are the
   same, so that forces work with the displacement. The ledger counts the work of forces with the
   stress at the start of the step and the mean of old and new velocity; account() adds the
   difference.
------------------------------------------------------------------------- */

std::vector<double> MPMStepMotion::end_step(const std::vector<double> &u)
{
  std::vector<double> kinetic;
  if (time.keeps_acceleration() && !impacts) end_acceleration.assign(nodes.nreals(), 0.0);
  impulse.assign(nodes.nreals(), 0.0);
  velocity.resize(nodes.nreals());
  if (impacts) end_contact(u);
  constraints.set_final_velocities(velocity.data(), impacts ? time.reaction_share() : 1.0);
  const bool rests = time.is_static();
  nodes.each_record([&](const auto &body, int64_t n, double *record) {
    if (n == body.first) kinetic.push_back(0.0);
    set_record(n, record, u);
    for (int d = 0; d < nodes.width; d++) {
      const int64_t k = nodes.width * n + d;
      const double m = nodes.mass[n], v = velocity[k];
      impulse[k] =
          m * (record[d] - record[4 + d] - nodes.explicit_velocity[k] + nodes.start_velocity[k]);
      if (m > 0.0 && rests && body.owns(n)) kinetic.back() += 0.5 * m * v * v;
    }
  });
  kinetic.resize(nodes.bodies.size());    // also of fields without nodes
  return kinetic;
}

/** The velocity that points move with, and both velocities in the record of a node. */
void MPMStepMotion::set_record(int64_t n, double *record, const std::vector<double> &u)
{
  const auto with = time.coefficients();
  const auto &residual = newton.residual(), &free = newton.free_forces();
  const double m = nodes.mass[n];
  for (int d = 0; d < nodes.width; d++) {
    const int64_t k = nodes.width * n + d;
    const double v = velocity[k] = u[k] / dt, before = nodes.start_velocity[k];
    record[d] = m > 0.0 ? v + dt * (residual[k] - free[k]) / m : 0.0;
    record[4 + d] = time.is_static() ? v : before;
    if (!(m > 0.0)) continue;
    if (impacts) {
      const double share = time.reaction_share(),
                   rubbing = constraints.rubs() ? constraints.friction_forces()[k] : 0.0,
                   borne = share * (free[k] - residual[k] - rubbing) +
          share / constraints.friction_factor() * rubbing;
      record[d] = v - dt * borne / m + ending[k] - stopped[k];
      record[4 + d] = v - (stopped[k] - before);
      continue;
    }
    if (time.kind == MPMTimeMethod::MIDPOINT) record[4 + d] = v - (2.0 * v - start[k] - before);
    if (!time.uses_acceleration()) continue;
    const double pull = balance.inertia_per_mass() * (u[k] - balance.predictor[k]),
                 end = with.end_acceleration(pull, acceleration[k]),
                 gained = with.velocity_change(dt, acceleration[k], end);
    if (time.keeps_acceleration()) {
      // momentum also changes by accelerations that are not those of the forces of this step
      end_acceleration[k] = end;
      record[4 + d] = v - (start[k] - before + gained);
    } else {
      // with the reactions of the start and the end of the step
      const double reaction = acceleration[k] - (nodes.explicit_velocity[k] - before) / dt;
      record[d] = v + with.gamma * (record[d] - v) - (1.0 - with.gamma) * dt * reaction;
      record[4 + d] = v - (start[k] + gained - before);
    }
  }
}

/* ----------------------------------------------------------------------
   For a while, the reactions of walls are velocities of the size dt f/m, which can be large in
   statics with its time steps of any length. What node actions make of them is v with a rounding
   error of that size. Points therefore get v itself. So does the ledger in statics: it would have
   that error times the impulses of forces, which are proportional to the length of the step.
------------------------------------------------------------------------- */

void MPMStepMotion::set_velocities()
{
  nodes.each_record([&](const auto &, int64_t n, double *record) {
    for (int d = 0; d < nodes.width && nodes.mass[n] > 0.0; d++)
      record[d] = velocity[nodes.width * n + d];
  });
}

void MPMStepMotion::finish()
{
  if (nodes.field.ledger.on) account();
  set_velocities();
  if (time.kind == MPMTimeMethod::MIDPOINT) {
    std::vector<double> rest(nodes.nreals());
    for (int64_t k = 0; k < nodes.nreals(); k++)
      rest[k] = impacts ? stopped[k] - velocity[k] : velocity[k] - start[k];
    affine.find_changes(dt, velocity, rest);
  }
  if (time.keeps_acceleration()) keep_accelerations();
}

void MPMStepMotion::account()
{
  const bool by_mean = time.moves_by_mean();
  // share of the forces of the end of the step
  const double share = time.kind == MPMTimeMethod::NEWMARK ? time.gamma : balance.force_share();
  const double unit = nodes.lmp->force->mvv2e;
  nodes.each_record([&](const auto &body, int64_t n, const double *record) {
    if (!(nodes.mass[n] > 0.0) || !body.owns(n)) return;
    double internal = 0.0, external = 0.0, transfer = 0.0;
    for (int d = 0; d < nodes.width; d++) {
      const int64_t k = nodes.width * n + d;
      const double v = velocity[k], old = record[4 + d];
      const double of_loads = share * dt * balance.load_changes[k] * 0.5 * (v + old);
      external += of_loads;
      internal -= impulse[k] * 0.5 * (v + old) - of_loads;
      if (balance.is_stabilized()) {    // this is no energy of points
        const double stabilizing = dt * balance.stabilizing_forces[k] * 0.5 * (v + old);
        internal += stabilizing;
        transfer += stabilizing;
      }
      if (!by_mean) continue;
      // points move with v, which is the mean velocity of the step already
      const double half = 0.5 * (v - old),
                   of_forces = dt *
          (balance.external[k] + balance.loads[k] + share * balance.load_changes[k]),
                   of_stress =
                       nodes.mass[n] * (nodes.explicit_velocity[k] - nodes.start_velocity[k]) -
          of_forces + impulse[k];
      external += of_forces * half;
      internal -= of_stress * half;
      transfer -= (of_forces + of_stress) * half;
    }
    auto &ledger = body.field.ledger;
    ledger.internal += internal * unit;
    ledger.external += external * unit;
    ledger.transfer += transfer * unit;
  });
}

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
double MPMStepMotion::memory_usage() const
{
  return affine.memory_usage() +
      bytes_of(start, acceleration, end_acceleration, velocity, impulse, mapped, ending, stopped);
}

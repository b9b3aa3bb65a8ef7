/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_implicit.h"

#include "field/mpm_forces.h"
#include "field/mpm_plan.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double SLIP = 1.0e-5;    // of friction, in node spacings

MPMImplicit::MPMImplicit(LAMMPS *lmp, const std::vector<MPMField *> &fields,
                         const MPMImplicitOptions &options, MPMPointAccelerations &kept) :
    options(options),
    stabilize(options.stabilize), nodes(lmp, fields), balance(nodes, options.time),
    constraints(nodes),
    free_bodies(nodes), parts{nodes, balance, constraints, free_bodies, options, now, times},
    system(parts), newton(parts, system), factors(parts, system, newton),
    motion(nodes, balance, constraints, newton, options.time, kept)
{
}

MPMImplicit::~MPMImplicit() = default;

void MPMImplicit::init()
{
  nodes.init();
  balance.init();
  pressure.reset();
  for (auto *water : nodes.field.plan->pore_pressures)
    if (auto *const of_nodes = water->node_pressure(nodes.field))
      pressure = std::make_unique<MPMCoupledPressure>(parts, system, *of_nodes);
}

/** Can factors of tangents serve several steps of this run? */
bool MPMImplicit::can_keep() const
{
  return options.preconditioner == MPMImplicitOptions::MULTIGRID && !options.time.is_static() &&
      !pressure && !constraints.has_contacts();
}

/** Finds points that walls carry as a whole; true if there may be any, on any rank. There are none
 *  with averages of stress, a pressure of nodes, or forces of the start of the step, which do not
 *  account for them. */
bool MPMImplicit::find_carried_points()
{
  std::vector<MPMTangent::CarriedPoint> carried;
  bool any = false;
  if (!pressure && !nodes.field.options.averages_stress() && !options.time.moves_by_mean()) {
    std::vector<double> left;
    any = constraints.find_carried_points(left);
    for (std::size_t i = 0; i < left.size(); i++)
      if (left[i] < 1.0) carried.push_back({(bigint) i, left[i]});
  }
  balance.tangent().set_carried(std::move(carried));
  return any;
}

/** Finds constraints and external forces. False where it is clear that there is no balance.
 *  Collective. */
bool MPMImplicit::begin_step(double dt)
{
  const bool rests = options.time.is_static();
  now = MPMImplicitReport();
  system.use_levels(false);
  nodes.begin_step();
  balance.begin_step(dt);
  newton.begin_step(dt, pressure.get());
  constraints.begin_step(dt, dt * options.time.end_velocity_share(),
                         options.slip > 0.0 ? options.slip : SLIP * nodes.spacing(), rests);
  const bool carries = find_carried_points();
  if (!constraints.find()) now.failure = MPMConstraints::CONTRADICTION;
  if (pressure) pressure->begin_step(dt);
  balance.find_external_forces();
  if (carries) {    // walls bear the loads on these points
    std::vector<double> on_them(nodes.nreals());
    auto &external = balance.external;
    balance.tangent().forces_on_carried(on_them.data());
    for (int64_t k = 0; k < nodes.nreals(); k++) external[k] -= on_them[k];
    constraints.carry(on_them.data());
    for (int64_t k = 0; k < nodes.nreals(); k++) external[k] += on_them[k];
  }
  if (stabilize > 0.0) balance.stabilize(stabilize);
  if (now.failure.empty()) now.failure = newton.find_free_bodies();
  return now.failure.empty();
}

std::vector<double> MPMImplicit::step(double dt)
{
  if (!begin_step(dt)) return std::vector<double>(nodes.bodies.size(), 0.0);
  std::vector<double> u;
  motion.begin_step(dt, u);
  if (!can_keep() || !factors.solve(u, dt)) newton.solve_in_parts(u);
  if (!now.converged && options.stabilize_if_stuck && stabilize == 0.0 &&
      !constraints.has_contacts()) {
    const MPMImplicitReport alone = now;
    stabilize = MPMImplicitOptions::ENOUGH_TO_STABILIZE;
    forget();
    nodes.restore_records();
    const auto energies = step(dt);
    now.stuck = true;
    now.add_counts(alone);
    return energies;
  }
  if (can_keep()) factors.store(u);
  if (pressure) pressure->end_step();
  if (now.converged && nodes.field.ledger.on) balance.find_loads(u);
  if (stabilize > 0.0) now.stabilizing = balance.find_stabilizing_forces(u);
  return motion.end_step(u);
}

double MPMImplicit::memory_usage() const
{
  return nodes.memory_usage() + balance.memory_usage() + constraints.memory_usage() +
      system.memory_usage() + newton.memory_usage() + factors.memory_usage() +
      motion.memory_usage() + (pressure ? pressure->memory_usage() : 0.0);
}

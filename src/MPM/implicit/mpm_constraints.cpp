/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_constraints.h"

#include "contact/mpm_ties.h"
#include "field/mpm_node_action.h"
#include "field/mpm_plan.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double PROJECTED = 1.0e-12;    // relative change by one more action
static constexpr int MOST_REPEATS = 200;
static constexpr double AT_ONCE = 0.1;    // node spacings up to which walls move their nodes alone
static constexpr int ROUNDS = 2;    // in which friction of walls that press on each other is found

MPMConstraints::MPMConstraints(MPMSolvedNodes &nodes) : nodes(nodes) {}

MPMConstraints::~MPMConstraints() = default;

void MPMConstraints::begin_step(double step_dt, double slip_time, double slip_width, bool rests)
{
  dt = step_dt;
  slip = slip_width;
  contacts.clear();
  rubbing = with_friction = false;
  bilateral = true;
  bodies = nullptr;
  touching = false;
  for (auto *action : nodes.field.plan->actions)
    if (auto *contact = action->trial_contact()) {
      if (auto *const between = dynamic_cast<MPMBodyContact *>(contact)) {
        bodies = between;
        ties = std::make_unique<MPMTies>(nodes.lmp);
        bodies->place_bodies([this](const MPMField &of) {
          return nodes.first_of(of);
        });
      }
      contact->begin_trials(nodes.field, dt, slip_time, slip, rests);
      contacts.push_back(contact);
      bilateral = bilateral && action->is_projection();
      with_friction = with_friction || contact->has_friction();
    }
}

void MPMConstraints::set_friction(double factor, std::vector<double> offset)
{
  friction_share = factor;
  slip_offset = std::move(offset);
}

/* ----------------------------------------------------------------------
   Walls that meet act one after the other, and the last one may undo part of what the first one
   did. When they are repeated, orthogonal projections converge to the projection onto what all of
   them leave free (J. von Neumann, 1933).
------------------------------------------------------------------------- */

bool MPMConstraints::find()
{
  constrained = !nodes.field.plan->actions.empty();
  wall.assign(nodes.nreals(), 0.0);
  gap_closure.clear();
  wall_speed = 0.0;
  if (!constrained) return true;
  if (with_friction)
    rubbing = nodes.any(std::any_of(contacts.begin(), contacts.end(), [](const auto *contact) {
      return contact->rubs();
    }));
  for (repeats = 1; repeats <= MOST_REPEATS; repeats *= 2) {
    find_touching();
    std::fill(wall.begin(), wall.end(), 0.0);
    act(wall.data());
    for (auto *contact : contacts) contact->take_base();
    wall_speed = nodes.norm(wall.data());
    if (!is_projection()) continue;
    find_gap_closure();
    return true;
  }
  return false;
}

/** Is P P = P for an arbitrary vector, which is the same on all ranks? */
bool MPMConstraints::is_projection()
{
  std::vector<double> once(nodes.nreals()), twice;
  const int width = nodes.width;
  int index[3];
  for (std::size_t k = 0; k < nodes.bodies.size(); k++) {
    const auto &body = nodes.bodies[k];
    for (const int64_t n : nodes.active) {
      if (n < body.first || n >= body.end()) continue;
      body.field.grid.node_index(n - body.first, index);
      for (int d = 0; d < width; d++)
        once[width * n + d] =
            std::sin(1.0 + 3.1 * index[0] + 5.3 * index[1] + 7.7 * index[2] + 2.3 * d + 4.1 * k);
    }
  }
  project(once.data());
  twice = once;
  project(twice.data());
  const double size = nodes.norm(once.data());
  for (int64_t k = 0; k < nodes.nreals(); k++) twice[k] -= once[k];
  return nodes.norm(twice.data()) <= PROJECTED * size;
}

void MPMConstraints::act(double *v)
{
  for (auto *contact : contacts) contact->clear_impulses();
  act_by_walls(v);
  if (touching) ties->close(v);
}

void MPMConstraints::act_by_walls(double *v)
{
  const std::size_t n = nodes.active.size();
  const int width = nodes.width;
  for (std::size_t i = 0; i < n; i++)
    for (int d = 0; d < width; d++) nodes.active_records[i][d] = v[width * nodes.active[i] + d];
  for (int k = 0; k < repeats; k++) nodes.field.plan->act_on_nodes(MPMNodeAction::TRIAL);
  for (std::size_t i = 0; i < n; i++)
    for (int d = 0; d < width; d++) v[width * nodes.active[i] + d] = nodes.active_records[i][d];
}

/** Finds whether bodies touch, and what walls do by themselves. */
void MPMConstraints::find_touching()
{
  touching = false;
  if (!bodies) return;
  touching = nodes.any(bodies->touches());
  const int acts = repeats;
  velocity_of_walls.assign(nodes.nreals(), 0.0);
  act_by_walls(velocity_of_walls.data());
  speed_of_walls = nodes.norm(velocity_of_walls.data());
  if (!touching) return;
  if (!ties->known_for(acts))
    ties->begin(*bodies, nodes.mass, nodes.width, acts, nodes.field.plan->actions.size() > 1,
                [this](double *v) {
                  project_by_walls(v);
                });
  ties->factorize();
}

/** x <- P x by an action x -> P x + w. Where walls move, x is scaled to the size of their velocity,
 *  so that the difference keeps its digits. */
template <class Action>
void MPMConstraints::apply_linear(double *x, const std::vector<double> &w, double speed,
                                  const Action &action)
{
  double scale = 1.0;
  if (speed > 0.0) {
    const double size = nodes.norm(x);
    if (size > 0.0) scale = speed / size;
    nodes.each_entry([&](int64_t, int64_t k) {
      x[k] *= scale;
    });
  }
  action(scale);
  if (speed > 0.0)
    nodes.each_entry([&](int64_t, int64_t k) {
      x[k] = (x[k] - w[k]) / scale;
    });
}

/** v <- P_w v with the projection of the walls alone. */
void MPMConstraints::project_by_walls(double *v)
{
  apply_linear(v, velocity_of_walls, speed_of_walls, [&](double) {
    act_by_walls(v);
  });
}

void MPMConstraints::project(double *x)
{
  if (!constrained) return;
  apply_linear(x, wall, wall_speed, [&](double scale) {
    reaction_scale = scale;
    act(x);
  });
}

void MPMConstraints::project_forces(double *f)
{
  if (!constrained) return;
  nodes.each_entry([&](int64_t n, int64_t k) {
    f[k] /= nodes.mass[n];
  });
  project(f);
  nodes.each_entry([&](int64_t n, int64_t k) {
    f[k] *= nodes.mass[n];
  });
}

/** Displacements that bring nodes to the walls that hold them, where they were not at the start of
 *  the step. */
void MPMConstraints::find_gap_closure()
{
  if (contacts.empty()) return;
  bool mine = false;
  for (auto *contact : contacts)
    if (contact->close_gaps(true)) mine = true;
  if (nodes.any(mine)) {
    gap_closure.assign(nodes.nreals(), 0.0);
    act(gap_closure.data());
    for (int64_t k = 0; k < nodes.nreals(); k++) gap_closure[k] = dt * (gap_closure[k] - wall[k]);
  }
  for (auto *contact : contacts) contact->close_gaps(false);
}

bool MPMConstraints::meet_walls(std::vector<double> &u, double share,
                                std::vector<double> &prescribed)
{
  std::vector<double> trial = u;
  project(trial.data());
  for (int64_t k = 0; k < nodes.nreals(); k++) trial[k] += share * dt * wall[k];
  if (!gap_closure.empty())
    for (int64_t k = 0; k < nodes.nreals(); k++) trial[k] += gap_closure[k];
  double most = 0.0;
  for (int64_t k = 0; k < nodes.nreals(); k++) most = std::max(most, std::fabs(trial[k] - u[k]));
  if (nodes.largest(most) <= AT_ONCE * nodes.spacing()) {
    u = trial;
    return false;
  }
  for (int64_t k = 0; k < nodes.nreals(); k++) prescribed[k] += trial[k] - u[k];
  return true;
}

/* ----------------------------------------------------------------------
   friction
------------------------------------------------------------------------- */

bool MPMConstraints::has_regularized_friction() const
{
  return std::any_of(contacts.begin(), contacts.end(), [](const MPMTrialContact *contact) {
    return contact->has_friction() && contact->is_regularised();
  });
}

const double *MPMConstraints::slip_of(const std::vector<double> &u)
{
  if (slip_offset.empty()) return u.data();
  slipped.resize(u.size());
  for (std::size_t k = 0; k < u.size(); k++) slipped[k] = u[k] + slip_offset[k];
  return slipped.data();
}

/** Friction after the motion u, from the pressing forces in the residual, which contains the
 *  friction of other walls. */
void MPMConstraints::find_friction(const std::vector<double> &u,
                                   const std::vector<double> &residual)
{
  friction.assign(nodes.nreals(), 0.0);
  room.resize(nodes.nreals());
  for (int round = 0; round < ROUNDS; round++) {
    for (int64_t k = 0; k < nodes.nreals(); k++) room[k] = residual[k] + friction[k];
    project_forces(room.data());
    std::fill(friction.begin(), friction.end(), 0.0);
    for (auto *contact : contacts) {
      contact->take_forces(reaction_scale);
      // bodies that stick have no slip in u, so the slip of sliding ones has to be measured in the
      // same way
      contact->add_friction(contact->is_regularised() ? slip_of(u) : u.data(), friction.data());
    }
    for (double &force : friction) force *= friction_share;
  }
}

void MPMConstraints::find_free_forces(const std::vector<double> &u,
                                      const std::vector<double> &residual,
                                      std::vector<double> &free)
{
  if (rubbing) find_friction(u, residual);
  nodes.each_entry([&](int64_t, int64_t k) {
    free[k] = rubbing ? residual[k] + friction[k] : residual[k];
  });
  project_forces(free.data());
  for (auto *contact : contacts) contact->take_forces(reaction_scale);
}

void MPMConstraints::subtract_friction_change(const double *du, double asymmetry, double *dforce)
{
  if (!rubbing) return;
  friction.assign(nodes.nreals(), 0.0);
  if (fixes_pressing_forces(asymmetry)) {
    bodies->add_friction_turn(du, friction.data());
    for (int64_t k = 0; k < nodes.nreals(); k++) dforce[k] -= friction_share * friction[k];
    return;
  }
  room.resize(nodes.nreals());
  for (int round = 0; round < ROUNDS; round++) {
    for (int64_t k = 0; k < nodes.nreals(); k++) room[k] = friction[k] - dforce[k];
    project_forces(room.data());
    std::fill(friction.begin(), friction.end(), 0.0);
    for (auto *contact : contacts)
      contact->add_friction_change(du, reaction_scale, friction.data());
    for (double &force : friction) force *= friction_share;
  }
  for (int64_t k = 0; k < nodes.nreals(); k++) dforce[k] -= friction[k];
}

/* ----------------------------------------------------------------------
   contact
------------------------------------------------------------------------- */

bool MPMConstraints::update_active_set(const std::vector<double> &u, double unbalanced)
{
  bool changed = false;
  for (auto *contact : contacts)
    if (contact->decide(u.data(), unbalanced)) changed = true;
  return nodes.any(changed);
}

bool MPMConstraints::find_carried_points(std::vector<double> &left) const
{
  bool any = false;
  for (auto *contact : contacts)
    if (contact->find_carried(nodes.field, left)) any = true;
  return any;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "implicit/mpm_newton.h"

#include "implicit/mpm_constraints.h"
#include "implicit/mpm_coupled_pressure.h"
#include "implicit/mpm_force_balance.h"
#include "implicit/mpm_free_bodies.h"
#include "implicit/mpm_motion_system.h"
#include "implicit/mpm_solved_nodes.h"

#include "force.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

using Clock = MPMImplicitTimes::Clock;

static constexpr double ENOUGH = 0.9;    // share of the slope that may be left, with the other sign
static constexpr int MOST_CUTS = 12;
static constexpr double MOST_ACCURATE = 1.0e-10;    // linear solution
// Newton iterations in a part of a step that failed as a whole
static constexpr int IN_A_PART = 15;
// width of the slip of friction at first, in node spacings, and the factor by which it decreases
static constexpr double SOFT = 0.1, HARDER = 0.1;
static constexpr double NEARLY = 1.0e-3;    // residual over all forces at which the slip decreases
// growth of the residual that is accepted where lines of nodes begin to stick or slip
static constexpr double MAY_GROW = 100.0;
// share of the residual left after an iteration that counts as slow
static constexpr double STALLS = 0.5;
// such iterations, until bodies update what touches and slides
static constexpr int MOST_SLOW = 2;
static constexpr double LOST = 1.0e12;    // growth over the first residual at which an attempt ends
static constexpr int MOST_SHORTER = 5;    // halvings of a joint correction
// growth of the residual with a joint correction that is taken all the same
static constexpr double LARGER = 2.0;

void MPMNewton::begin_step(double step_dt, MPMCoupledPressure *of_nodes)
{
  dt = step_dt;
  pressure = of_nodes;
  for (auto *list : {&unbalanced, &free, &du, &correction, &trial, &prescribed, &inertia_forces})
    list->assign(nodes.nreals(), 0.0);
}

MPMNewton::Outcome MPMNewton::fail(const char *why, Outcome outcome)
{
  report.failure = why;
  return outcome;
}

bool MPMNewton::find_residual(const std::vector<double> &u, double &size,
                              const std::vector<double> *vector, double *along)
{
  const Clock timed(times, MPMImplicitTimes::FORCES);
  double stress;
  if (pressure) pressure->set_pressure();
  if (!balance.find_residual(u, unbalanced, inertia_forces, stress)) return false;
  constraints.find_free_forces(u, unbalanced, free);
  // all sums in one message
  double mine[5] = {nodes.sum_of_residuals(free), nodes.sum_of_lengths(balance.external),
                    nodes.sum_of_lengths(inertia_forces), stress, 0.0},
         all[5];
  if (vector)
    nodes.each_owned([&](int64_t n) {
      for (int64_t k = nodes.width * n; k < nodes.width * (n + 1); k++)
        mine[4] += (*vector)[k] * free[k];
    });
  nodes.sum_in_order(5, mine, all);
  report.unbalanced = all[0];
  if (vector) *along = all[4];
  if (pressure) report.water = pressure->find_residual(u, all[3]);
  size = all[3] + all[1] + all[2];
  report.ratio = report.unbalanced == 0.0 ? 0.0 : report.unbalanced / size;
  return std::isfinite(report.unbalanced) && std::isfinite(report.water);
}

/* ----------------------------------------------------------------------
   A step s du is too long if the forces along it have changed sign and are as large as before.
   Forces that grow without a change of sign are accepted: this happens where a solid softens first
   (P2 of the benchmarks).
------------------------------------------------------------------------- */

bool MPMNewton::line_search(std::vector<double> &u, double &size)
{
  const double slope = nodes.product(du.data(), free.data()), before = report.unbalanced;
  correction.swap(du);
  double s = 1.0, end;
  for (int cut = 0; cut <= MOST_CUTS; cut++, report.cuts++) {
    nodes.each_entry([&](int64_t, int64_t k) {
      trial[k] = u[k] + s * correction[k];
    });
    double factor = 0.25;
    if (find_residual(trial, size, &correction, &end)) {
      if (slope <= 0.0 || end >= -ENOUGH * slope ||
          (constraints.rubs() && report.unbalanced <= MAY_GROW * before)) {
        u.swap(trial);
        share = s;
        return true;
      }
      factor = std::max(0.1, std::min(slope / (slope - end), 0.7));
    }
    s *= factor;
  }
  report.failure =
      "no part of the last correction gives points that are not inside out, or forces that "
      "are smaller";
  return false;
}

/* ----------------------------------------------------------------------
   u and p <- u + s du, p + s dp. Motion and pressure have no common energy with a minimum, so the
   residual has to decrease. Where it does not for any share s, because soil yields, the share that
   leaves least is taken if this is not much more than before.
------------------------------------------------------------------------- */

bool MPMNewton::search_jointly(std::vector<double> &u, double &size)
{
  const double before = pressure->excess();
  double best = 0.0, best_share = 0.0, at = 0.0;
  const auto go_to = [&](double s) {
    for (int64_t k = 0; k < nodes.nreals(); k++) trial[k] = u[k] + s * du[k];
    pressure->move(s - at);
    at = s;
    return find_residual(trial, size);
  };
  double s = 1.0;
  for (int cut = 0; cut <= MOST_SHORTER; cut++, report.cuts++, s *= 0.5) {
    if (!go_to(s)) continue;
    const double left = pressure->excess();
    if (best_share == 0.0 || left < best) {
      best = left;
      best_share = s;
    }
    if (left < before) {
      u = trial;
      return true;
    }
  }
  if (best_share > 0.0 && best < LARGER * before && go_to(best_share)) {
    u = trial;
    return true;
  }
  report.failure = "no part of the last correction leaves less of forces and volumes";
  return false;
}

/** Moves what is prescribed along its way, and all the rest with it, by the largest of the shares
 *  1, 1/2, ... after which no point is inside out. False if there is none. */
bool MPMNewton::close_gaps(std::vector<double> &u, double &size, double &reached)
{
  const std::vector<double> begin = u;
  reached = 1.0;
  for (int cut = 0; cut <= MOST_CUTS; cut++, report.cuts++, reached *= 0.5) {
    for (int64_t k = 0; k < nodes.nreals(); k++)
      u[k] = begin[k] + reached * (prescribed[k] + du[k]);
    if (find_residual(u, size)) return true;
  }
  u = begin;
  return false;
}

/** Friction begins soft, so that what slips and what sticks changes little at a time, and walls do
 *  not tear what they drag. */
void MPMNewton::soften_friction(Progress &at)
{
  if (!constraints.has_regularized_friction()) return;
  double most = SOFT * nodes.spacing();
  for (int64_t k = 0; k < nodes.nreals(); k++) most = std::max(most, std::fabs(prescribed[k]));
  at.softness = nodes.largest(most);
  constraints.soften(at.softness);
}

/** True if friction has become harder. */
bool MPMNewton::harden_friction(const std::vector<double> &u, Progress &at)
{
  if (!(at.softness > 0.0) || at.wall_moves ||
      !(report.unbalanced <= std::max(at.enough, NEARLY * at.size)))
    return false;
  at.softness *= HARDER;
  if (at.softness <= constraints.slip_width()) at.softness = 0.0;
  constraints.soften(at.softness);
  find_residual(u, at.size);
  at.last = 0.0;
  return true;
}

std::string MPMNewton::find_free_bodies()
{
  free_bodies.clear();
  // elements hold nodes together that have no point in common
  if (!options.time.is_static() || pressure || constraints.has_friction() ||
      constraints.between_bodies() || !nodes.field.elements.empty())
    return "";
  const auto pushed = free_bodies.find(constraints, system.lattice_ranks(), balance.external);
  // a body may go to a wall that bears it; loads are not in these forces
  return constraints.has_contacts() || balance.tangent().has_loads() ? "" : pushed;
}

/** Updates the active set where forces are in balance; bodies do so early, as long as it
 *  changes. */
MPMNewton::Contact MPMNewton::update_contact(std::vector<double> &u, Progress &at)
{
  const bool converged = at.left <= at.enough, bodies = constraints.between_bodies();
  const bool stalls =
      bodies && at.last > 0.0 && at.left > STALLS * at.last && ++at.slow > MOST_SLOW;
  if (at.wall_moves) return UNCHANGED;
  if (!converged && !stalls && !(bodies && report.unbalanced <= NEARLY * at.size)) return UNCHANGED;
  if (!constraints.update_active_set(u, converged || stalls ? 0.0 : report.ratio))
    return converged ? BALANCED : UNCHANGED;
  if (!constraints.find()) report.failure = MPMConstraints::CONTRADICTION;
  find_free_bodies();
  system.use_levels(false);
  at.slow = 0;
  at.last = at.first = 0.0;
  std::fill(prescribed.begin(), prescribed.end(), 0.0);
  at.closes = at.wall_moves = constraints.meet_walls(u, aim, prescribed);
  return find_residual(u, at.size) ? CHANGED : INSIDE_OUT;
}

/** Forcing of S.C. Eisenstat, H.F. Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2: quadratic
 *  convergence without linear solutions that are more accurate than the tangent is worth. */
void MPMNewton::choose_accuracy(Progress &at) const
{
  if (at.last > 0.0) {
    const double ratio = at.left / at.last, next = 0.9 * ratio * ratio,
                 safe = 0.9 * at.accuracy * at.accuracy;
    at.accuracy = std::min(options.least_accuracy, safe > 0.1 ? std::max(next, safe) : next);
  }
  at.accuracy = std::max(at.accuracy, MOST_ACCURATE);
  at.last = at.left;
}

/** At first, walls bring what they hold to its place, and all the rest goes with it. */
void MPMNewton::add_prescribed_forces()
{
  if (pressure)
    pressure->move_walls(prescribed, du.data());
  else
    balance.change_of_forces(prescribed.data(), du.data());
  for (int64_t k = 0; k < nodes.nreals(); k++) {
    const int64_t n = k / nodes.width;
    free[k] = nodes.mass[n] > 0.0 ? unbalanced[k] + du[k] - balance.inertia(n) * prescribed[k]
                                  : 0.0;
  }
  constraints.project_forces(free.data());
}

SolveReport MPMNewton::find_correction(const std::vector<double> &u, Progress &at)
{
  {
    const Clock timed(times, MPMImplicitTimes::TANGENTS);
    at.stiffness = balance.linearize(u, report.asymmetry);
  }
  if (at.wall_moves) add_prescribed_forces();
  free_bodies.balance(free.data());
  SolveGoal goal;
  goal.relative = at.accuracy;
  if (at.left > 0.0) goal.relative = std::max(at.accuracy, 0.1 * at.enough / at.left);
  goal.relative = std::min(goal.relative, options.least_accuracy);
  goal.most_iterations = (int) options.most_linear;
  goal.natural = nodes.has_domains();
  const auto solved = pressure ? pressure->solve(u, free, du, goal)
                               : system.solve(free.data(), du.data(), goal);
  report.linear += solved.iterations;
  report.iterations++;
  // the energy has no minimum along some direction, for example near an unstable state: the
  // solution goes as far as it had one, and at least down the slope (T. Steihaug, SIAM J. Numer.
  // Anal. 20 (1983) 626)
  if (solved.outcome == SolveReport::INDEFINITE) {
    report.indefinite++;
    if (solved.iterations == 0) system.precondition(free.data(), du.data());
  }
  free_bodies.hold(du.data());
  return solved;
}

bool MPMNewton::make_correction(std::vector<double> &u, Progress &at)
{
  constraints.correct(du.data());
  if (at.closes) {
    double reached;
    if (!close_gaps(u, at.size, reached)) {
      report.failure = "points are inside out when they come to walls";
      return false;
    }
    at.closes = at.wall_moves = reached < 1.0;
    for (int64_t k = 0; k < nodes.nreals(); k++) prescribed[k] *= 1.0 - reached;
    return true;
  }
  if (at.wall_moves) {
    at.wall_moves = false;
    for (int64_t k = 0; k < nodes.nreals(); k++) u[k] += prescribed[k] + du[k];
    if (pressure) pressure->move(1.0);
    if (find_residual(u, at.size)) return true;
    report.failure = "points are inside out when walls have moved";
    return false;
  }
  return pressure ? search_jointly(u, at.size) : line_search(u, at.size);
}

MPMNewton::Outcome MPMNewton::iterate(std::vector<double> &u, int most_iterations)
{
  Progress at;
  at.most = most_iterations;
  at.before = report.iterations;
  at.accuracy = options.least_accuracy;
  report.residuals.clear();
  soften_friction(at);
  const bool rests = options.time.is_static();
  if (!rests) std::fill(prescribed.begin(), prescribed.end(), 0.0);
  at.closes = constraints.has_contacts() && constraints.meet_walls(u, reached_by_walls, prescribed);
  if (!find_residual(u, at.size))
    return fail("points are inside out or have no finite stress at the start of the step",
                HOPELESS);
  at.wall_moves = at.closes || (rests && constraints.speed() > 0.0);
  at.first = at.wall_moves ? 0.0 : report.unbalanced;
  while (true) {
    report.residuals.push_back(report.unbalanced);
    at.enough = std::max({options.tolerance * at.size, options.absolute * nodes.lmp->force->ftm2v,
                          balance.negligible_forces(u, at.stiffness),
                          pressure ? pressure->negligible_forces() : 0.0});
    at.left = report.unbalanced;
    // with a pressure, the larger one of the residuals of forces and volumes, relative to what may
    // be left
    if (pressure) {
      pressure->allow_force(at.enough);
      at.left = pressure->excess() * at.enough;
    }
    if (harden_friction(u, at)) continue;
    const Contact contact = update_contact(u, at);
    if (contact == BALANCED) return CONVERGED;
    if (contact == INSIDE_OUT) return fail("points are inside out when they touch walls");
    if (contact == CHANGED) continue;
    if (report.iterations - at.before == at.most) return fail("it did not converge");
    if (!at.wall_moves && at.first == 0.0) at.first = report.unbalanced;
    if (!pressure && report.unbalanced > LOST * at.first && !at.wall_moves && at.first > 0.0)
      return fail("it diverges");
    choose_accuracy(at);
    const auto solved = find_correction(u, at);
    if (!solved.converged() && solved.outcome != SolveReport::INDEFINITE) {
      report.failure = "the linear system " + solved.describe();
      if (!system.levels() && !constraints.between_bodies())
        report.failure += " (use solver multigrid)";
      return report.iterations == at.before + 1 ? HOPELESS : FAILED;
    }
    if (!make_correction(u, at)) return FAILED;
  }
}

/* ----------------------------------------------------------------------
   Where Newton's method does not find the end of the step at once, it goes there in parts: for
   shares s that grow to one, it solves r(u) = (1 - s) r0, where r0 is the residual at the start,
   and walls go a share of their way. Changes by loads, gravity, ramps, and walls then come in small
   portions. The laws see one step from its start to u as always, so that parts lead to the same end
   where they are not needed.
------------------------------------------------------------------------- */

void MPMNewton::solve_in_parts(std::vector<double> &u)
{
  std::vector<double> &external = balance.external;
  const std::vector<double> whole = external;
  const bool rests = options.time.is_static();
  std::vector<double> from_here = u, first;
  double part = 1.0, size;
  bool in_parts = false;    // the same on ranks without nodes
  if (pressure) pressure->keep();
  while (true) {
    aim = std::min(1.0, report.reached + part);
    external = whole;
    if (aim < 1.0)
      for (int64_t k = 0; k < nodes.nreals(); k++) external[k] -= (1.0 - aim) * first[k];
    if (pressure && in_parts) pressure->set_part(aim);
    reached_by_walls = rests ? report.reached : 1.0;
    for (int64_t k = 0; k < nodes.nreals() && rests; k++)
      prescribed[k] = (aim - report.reached) * dt * constraints.velocities()[k];
    const int most = (int) options.most_iterations,
              fewer = (constraints.has_friction() ? 3 : 1) * IN_A_PART;
    const Outcome outcome = iterate(u, in_parts ? std::min(most, fewer) : most);
    system.use_levels(system.uses_levels() && outcome == CONVERGED);
    if (outcome == CONVERGED) {
      report.parts++;
      report.reached = aim;
      report.converged = aim == 1.0;
      if (report.converged) return;
      from_here = u;
      if (pressure) pressure->keep();
      part *= 2.0;
      continue;
    }
    part = 0.5 * (aim - report.reached);
    if (outcome == HOPELESS || part * options.most_parts < 1.0) return;
    u = from_here;
    if (pressure) pressure->go_back();
    if (!in_parts) {
      in_parts = true;
      external = whole;
      find_residual(u, size);
      first = unbalanced;
      if (pressure) pressure->set_first();
    }
  }
}

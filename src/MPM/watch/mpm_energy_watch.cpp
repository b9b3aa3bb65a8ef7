/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "watch/mpm_energy_watch.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "field/mpm_every.h"
#include "field/mpm_field.h"
#include "field/mpm_guard.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_locking.h"
#include "field/mpm_physics.h"
#include "field/mpm_plan.h"
#include "field/mpm_point_map.h"
#include "field/mpm_smoothing.h"
#include "fix.h"
#include "force.h"
#include "math/matrix.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"
#include "watch/mpm_point_summary.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// Each step looks at the forces on all points that do much of the work, such as those under a load,
// and on a part of the others, in the next step on another part. Whose turn it is
// follows from the ID alone: with parts by the place in memory, points would be looked at twice or
// not at all when their order changes, and in water at rest forces are so large that this is as
// much as the energy in play
static constexpr int SAME_TURN = 16;    // consecutive IDs, which are mostly neighbors
static constexpr int MOST_BITS = 7,
                     PAIR_BITS = 4;    // one in 128, of those with contacts one in 16
static constexpr int ENOUGH = 512;     // points in a step
static constexpr double MUCH = 4.0;    // power of a point over the mean, that is looked at always
// steps between looks at all energies: then all had their turn
static constexpr int CHECK_EVERY = 7 << MOST_BITS;
static constexpr int PLAY_EVERY = 64;    // the same for what is in play, before the first of these
static constexpr int SHORTEST = 200;     // run in which the work is known well enough
static constexpr double AT_REST =
    1.0e-9;    // cells per step: with less than that nothing is in play
static constexpr double UNSTRAINED = 1.0e-6;    // stored energy over that after the first step
static constexpr double ROUND_OFF = 1.0e-13;    // of a sum of the heat of all points in a step
// of all heat: what steps leave of the work of expansion
static constexpr double HEAT_ERROR = 1.0e-6;

/** The step of 2^bits in which a point is looked at. Multiples of the golden ratio are spread
 *  evenly for any range of IDs, and are no wave through a lattice of points. */
static int turn_of(tagint tag, int bits)
{
  const auto number = (uint32_t) (tag / SAME_TURN);
  return (int) ((uint64_t) (uint32_t) (number * UINT32_C(2654435769)) >> (32 - bits));
}

void MPMEnergyWatch::start()
{
  run = {};
  loads = kind_of_loads();
  mean_power = 0.0;
}

void MPMEnergyWatch::step()
{
  const bool centers = strain_follows();
  if (run.steps == 1 && centers) center_start();
  if (run.steps % CHECK_EVERY == 0)
    check();
  else if (run.steps < CHECK_EVERY && run.steps % PLAY_EVERY == 0)
    note_play(sums());
  if (centers && ((run.steps + 1) % CHECK_EVERY == 0 || is_last_step())) {
    run.elastic = sums().elastic;
    run.noted = run.steps + 1;
  }
  seen.clear();
  const int met = number_met();
  if (loads != NO_LOADS) {
    find_forces();
    note_loaded(loads == PAIRS ? met : atom->nlocal);
  }
  note_points(parts[0], 0, met);
  note_points(parts[1], met, atom->nlocal);
}

/** Gravity acts on all points alike, and needs no search. */
MPMEnergyWatch::Loads MPMEnergyWatch::kind_of_loads() const
{
  for (auto *fix : modify->get_fix_list())
    if ((modify->get_fix_mask(fix) & FixConst::POST_FORCE) &&
        !utils::strmatch(fix->style, "^gravity"))
      return ANY_LOADS;
  return force->pair ? PAIRS : NO_LOADS;
}

/** On points in this step. */
void MPMEnergyWatch::find_forces()
{
  forces.clear();
  for (const auto *field : fields) forces.push_back(field->rows().f);
}

/** Energy that the force on a point gives or takes in a unit of time; from rest, the mean over the
 *  step. */
double MPMEnergyWatch::power_on(int field, int i, double half) const
{
  double f[3];
  fields[field]->outer_force(forces[field], i, f);
  return fabs(dot(f, atom->v[i])) + half * force->ftm2v * dot(f, f) / atom->rmass[i];
}

/** A load on a few points may do all of the work. Which power is much follows from the mean of the
 *  step before. */
void MPMEnergyWatch::note_loaded(int end)
{
  much = MUCH * mean_power;
  const double half = 0.5 * fields[0]->step_dt();
  double sum = 0.0;
  bigint n = 0;
  for (int k = 0; k < (int) fields.size(); k++) {
    const double *const f = forces[k];
    n += fields[k]->map->npoints();
    for (int i = 0; i < end; i++) {
      if (f[3 * (bigint) i] == 0.0 && f[3 * (bigint) i + 1] == 0.0 && f[3 * (bigint) i + 2] == 0.0)
        continue;    // most points of a body on which a load acts
      if (!fields[k]->is_point(i)) continue;
      const double power = power_on(k, i, half);
      sum += power;
      if (power > much) note(k, i, 1);
    }
  }
  mean_power = n ? sum / (double) n : 0.0;
}

void MPMEnergyWatch::note(int field, int i, int turns)
{
  const double *const x = atom->x[i], *const v = atom->v[i];
  seen.push_back({field, i, turns, {x[0], x[1], x[2]}, {v[0], v[1], v[2]}});
}

/** Work of forces from the middle of the step before to that of this one, where their velocities
 *  belong, see MPMLedger::work_on_points(). Points' own velocities would not do for the way: those
 *  of flip and aflip differ from what moves points. Forces that elements have added are
 *  internal. */
void MPMEnergyWatch::moved()
{
  const double half = 0.5 * fields[0]->step_dt(), half_before = 0.5 * fields[0]->step_dt_before();
  const int dim = fields[0]->lattice.dim;
  find_forces();
  const double *const places = seen.empty() ? nullptr : atom->x[0],
                      *const velocities = seen.empty() ? nullptr : atom->v[0];
  for (const auto &[field, i, turns, x, v] : seen) {
    const bigint row = 3 * (bigint) i;
    const double *const x_now = places + row, *const v_now = velocities + row;
    double now[3], work = 0.0;
    fields[field]->outer_force(forces[field], i, now);
    for (int d = 0; d < dim; d++)
      work += now[d] * (x_now[d] - x[d] - half * v_now[d] + half_before * v[d]);
    // around an axis of symmetry
    if (dim < 3) work += now[2] * (half * v_now[2] + half_before * v[2]);
    run.force_work += turns * work;
  }
  run.steps++;
}

void MPMEnergyWatch::finish()
{
  if (run.steps >= SHORTEST) check();
  for (auto &part : parts) part.list = -1;    // commands may move atoms before the run goes on
}

/** Pair styles act on atoms in neighbor lists, which may be those of a group that is first in
 *  memory; with every, on those of several lists. */
int MPMEnergyWatch::number_met() const
{
  const bool first_met = neighbor->includegroup && !fields[0]->every;
  return !force->pair ? 0 : first_met ? atom->nfirst : atom->nlocal;
}

void MPMEnergyWatch::note_points(Part &part, int begin, int end)
{
  const int turns = 1 << part.bits, turn = (int) (run.steps % turns);
  const auto ahead = [&]() {
    return (turn - part.first) & (turns - 1);
  };
  // atoms change their places when lists are made
  if (part.begin != begin || part.end != end || part.list != neighbor->lastcall ||
      ahead() >= AHEAD) {
    part.begin = begin;
    part.end = end;
    part.list = neighbor->lastcall;
    part.first = turn;
    find_places(part);
  }

  const double half = 0.5 * fields[0]->step_dt();
  const bool searched = loads == ANY_LOADS || (loads == PAIRS && &part == parts);
  for (const auto &[field, i] : part.places[ahead()])
    if (!searched || !(power_on(field, i, half) > much)) note(field, i, turns);
}

void MPMEnergyWatch::find_places(Part &part) const
{
  const int turns = 1 << part.bits;
  for (auto &places : part.places) places.clear();
  for (int i = part.begin; i < part.end; i++) {
    const int ahead = (turn_of(atom->tag[i], part.bits) - part.first) & (turns - 1);
    if (ahead >= AHEAD) continue;
    for (std::size_t k = 0; k < fields.size(); k++)
      if (fields[k]->is_point(i)) part.places[ahead].push_back({(int) k, i});
  }
}

/** Enough points in each step, of all ranks. */
void MPMEnergyWatch::choose_turns(const Sums &now)
{
  const double npoints[2] = {now.met, now.points - now.met};
  const int most[2] = {PAIR_BITS, MOST_BITS};
  for (int k = 0; k < 2; k++) {
    parts[k] = Part();
    while (parts[k].bits < most[k] && npoints[k] >= 2.0 * ENOUGH * (1 << parts[k].bits))
      parts[k].bits++;
  }
}

MPMEnergyWatch::Sums MPMEnergyWatch::sums() const
{
  const MPMPointEnergies points = point_energies(lmp);
  Sums mine = {};
  mine.kinetic = points.kinetic;
  mine.stored = mine.elastic = points.stored;
  mine.spent = points.taken() - points.stored;
  mine.work = run.force_work;
  const int met = number_met();
  for (const auto *field : fields) {
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      mine.points++;
      mine.met += i < met;
      mine.mass += atom->rmass[i];
    }
    const auto &ledger = field->ledger;
    mine.work += ledger.driven + ledger.deleted_kinetic + ledger.deleted_stored;
    if (field->smoothing) mine.work += field->smoothing->energy_given();
    if (field->locking) mine.work += field->locking->unseen_energy();
  }

  std::vector<double> values;
  for (const auto *other : fields[0]->plan->physics) {
    const auto accounts = other->accounts();
    values.assign(accounts.size(), 0.0);
    other->account(values.data());
    for (std::size_t k = 0; k < accounts.size(); k++) {
      (accounts[k].stored ? mine.stored : mine.work) += values[k];
      if (accounts[k].heat) mine.heat += values[k];
    }
  }
  Sums all;
  MPI_Allreduce(&mine, &all, sizeof(Sums) / sizeof(double), MPI_DOUBLE, MPI_SUM, world);
  for (const auto *field : fields)
    all.points += field->guard->deleted.points - field->guard->brought;
  return all;
}

/** Velocities, and work, belong to the middle of the last step, see moved(). With usl and musl
 *  stored energy belongs to its end: the mean of stored energies before and after the step belongs
 *  to its middle, and with it the sum is that of a leapfrog, which is constant. With usf stress is
 *  a step behind, with usavg in the middle. */
bool MPMEnergyWatch::strain_follows() const
{
  return std::none_of(fields.begin(), fields.end(), [](const MPMField *field) {
    return field->options.stress_before();
  });
}

/** Of a run or of its part; with every, of the cycle that has it. */
bool MPMEnergyWatch::is_last_step() const
{
  return update->ntimestep + fields[0]->options.every > update->laststep;
}

/** A run may begin in the middle of a vibration: the step before it had about as much as the first
 *  one, in proportion to the velocities. Bodies that start with velocities and without strain have
 *  least stored energy: as much a step before as a step later. */
void MPMEnergyWatch::center_start()
{
  const Sums now = sums();
  const bool least = fabs(run.start.elastic) < UNSTRAINED * fabs(now.elastic);
  const double share = now.kinetic > 0.0 ? sqrt(std::min(1.0, run.start.kinetic / now.kinetic))
                                         : 0.0,
               change = (least ? -0.5 : 0.5) * share * (now.elastic - run.start.elastic);
  run.start.stored -= change;
  run.lowest -= change;
}

void MPMEnergyWatch::begin(const Sums &now)
{
  run.start = now;
  run.lowest = now.unexplained();
  run.in_play = run.mechanical = 0.0;
}

/** Heat that bodies have, of which accounts hold the changes. Collective. */
double MPMEnergyWatch::energy_at_hand() const
{
  double mine = 0.0, all;
  for (const auto *other : fields[0]->plan->physics) mine += other->energy_at_hand();
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/** Heat that goes through a body at rest is in accounts as changes of all the heat that it has,
 *  whose round-off adds up over steps; nothing else may be in play. Collective. */
bool MPMEnergyWatch::is_round_off(double energy) const
{
  return energy < ROUND_OFF * sqrt((double) run.steps + 1.0) * energy_at_hand();
}

/** Short runs may end where a load has returned what it gave. */
void MPMEnergyWatch::note_play(const Sums &now)
{
  const double spent = fabs(now.spent - run.start.spent);
  run.in_play = std::max(run.in_play, now.kinetic + fabs(now.stored) + spent);
  run.mechanical = std::max(run.mechanical, now.kinetic + fabs(now.stored - now.heat) + spent);
}

/** Points that other commands have added or removed bring or take energy that is in no account;
 *  that of points which fixes of this package emit and absorb is in the ledger. */
void MPMEnergyWatch::check()
{
  const Sums now = sums();
  if (run.steps == 0 || now.points != run.start.points) begin(now);
  if (run.steps % CHECK_EVERY == 0) choose_turns(now);
  const double ahead = run.noted > 0 && run.noted == run.steps ? 0.5 * (now.elastic - run.elastic)
                                                               : 0.0,
               unexplained = now.unexplained() - ahead;
  run.last = now;
  run.lowest = std::min(run.lowest, unexplained);
  note_play(now);
  const double gained = run.gained = unexplained - run.lowest;
  const auto &options = fields[0]->options;
  look_for_loss(now.mass);
  if (run.warned || !(gained > options.most_gain * run.mechanical) || !is_much_in_play(now.mass) ||
      gained < HEAT_ERROR * energy_at_hand())
    return;
  run.warned = true;
  const std::string text =
      fmt::format("Numerical errors have added the energy {:.4g} to the material points by step {} "
                  "of this run, {:.3g} % of the energy in play ({:.4g}): results are not to be "
                  "trusted. Try a smaller time step (fix mpm/dt), shape quadratic or cubic, "
                  "transfer apic, more points per cell; compute mpm/energy tells where energy goes",
                  gained, update->ntimestep, 100.0 * gained / run.mechanical, run.mechanical);
  if (options.gain == MPMFieldOptions::GAIN_ERROR)
    error->all(FLERR, Error::NOLASTLINE, "{}; fix mpm ... gain warn|ignore goes on", text);
  if (comm->me == 0)
    error->warning(FLERR, "{}; fix mpm ... gain sets what is done, and from which share on", text);
}

bool MPMEnergyWatch::is_much_in_play(double mass) const
{
  const double speed = AT_REST * fields[0]->lattice.h / update->dt;
  return run.in_play > 0.5 * force->mvv2e * mass * speed * speed;
}

/** Friction, contact, and fixes that bring bodies to rest take energy as they should, and so does
 *  transfer pic. Under loads, bodies come to rest, as they mostly should. */
bool MPMEnergyWatch::only_transfers_take() const
{
  const auto &plan = *fields[0]->plan;
  for (auto *fix : modify->get_fix_list())
    if (modify->get_fix_mask(fix) & FixConst::POST_FORCE) return false;
  return !force->pair &&
      std::all_of(plan.actions.begin(), plan.actions.end(),
                  [](const auto *action) {
                    return action->is_projection();
                  }) &&
      std::none_of(plan.physics.begin(), plan.physics.end(),
                   [](const auto *other) {
                     return other->brings_to_rest();
                   }) &&
      std::none_of(fields.begin(), fields.end(), [](const auto *field) {
        return field->options.transfer == PIC;
      });
}

/** Transfers damp motion that the lattice hardly resolves, such as that of bodies of a few cells
 *  that collide. */
void MPMEnergyWatch::look_for_loss(double mass)
{
  constexpr double MOST_LOSS = 0.2;
  const double took = run.start.unexplained() - run.lowest;
  if (run.warned_of_loss || !(took > MOST_LOSS * run.in_play) || !is_much_in_play(mass) ||
      is_round_off(took) || !only_transfers_take())
    return;
  run.warned_of_loss = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Transfers have taken {:.3g} % of the energy in play ({:.4g}) by step {} of this "
        "run: motion is damped. Use a smaller spacing, {}; fix mpm ... gain ignore accepts it",
        100.0 * took / run.in_play, run.in_play, update->ntimestep,
        fields[0]->options.total ? "or transfer apic"
                                 : "transfer aflip 0.99, shape linear transfer flip 1.0 scheme "
                                   "musl, or fewer steps (fix mpm/dt 0.4)");
}

std::string MPMEnergyWatch::report() const
{
  if (run.steps < SHORTEST) return "";
  const double took = run.start.unexplained() - run.lowest;
  return fmt::format(
      "  energy {}at the end: kinetic {:.6g}, stored {:.6g}; since the start transfers and "
      "friction took {:.3g} ({:.3g} % of the energy in play), and numerical errors added {:.3g}\n",
      fields.size() > 1 ? "of all fields " : "", run.last.kinetic, run.last.stored, took,
      run.in_play > 0.0 ? 100.0 * took / run.in_play : 0.0, run.gained);
}

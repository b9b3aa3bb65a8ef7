/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_energy_watch.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_mpm_elements.h"
#include "force.h"
#include "math/matrix.h"
#include "mpm_every.h"
#include "mpm_field.h"
#include "mpm_guard.h"
#include "mpm_physics.h"
#include "mpm_plan.h"
#include "mpm_point_energies.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// each step looks at the forces on one in so many blocks of consecutive points, others in the next step
static constexpr int BLOCK = 16;
static constexpr int MOST_STRIDE = 128, PAIR_STRIDE = 16;    // contacts with grains are few points
static constexpr int ENOUGH = 512;                           // points of a rank in a step
static constexpr int CHECK_EVERY = 800;                      // steps between looks at all energies
static constexpr int SHORTEST = 200;    // run in which the work is known well enough
static constexpr double AT_REST =
    1.0e-9;    // cells per step: with less than that nothing is in play

/* ---------------------------------------------------------------------- */

void MPMEnergyWatch::step()
{
  if (run.steps % CHECK_EVERY == 0) check();
  add_force_work();
  run.steps++;
}

void MPMEnergyWatch::finish()
{
  if (run.steps >= SHORTEST) check();
}

/* ----------------------------------------------------------------------
   work of forces in this step. To take all points in some steps costs the same, but is wrong where a body of a
   few cells vibrates: its period is a few of these steps. Forces that elements have added are internal
------------------------------------------------------------------------- */

void MPMEnergyWatch::add_force_work()
{
  // pair styles act on atoms in neighbor lists, which may be those of a group that is first in memory; with
  // every, on those of several lists
  const int end = atom->nlocal;
  const bool first_met = neighbor->includegroup && !fields[0]->every;
  const int met = !force->pair ? 0 : first_met ? atom->nfirst : end;
  add_force_work(0, met, PAIR_STRIDE);
  add_force_work(met, end, MOST_STRIDE);
}

void MPMEnergyWatch::add_force_work(int begin, int end, int most)
{
  const int stride = std::max(1, std::min(most, (end - begin) / ENOUGH));
  double power = 0.0;
  for (const auto *field : fields) {
    const double *const f = field->rows().f;
    for (int first = begin + BLOCK * (int) (run.steps % stride); first < end;
         first += BLOCK * stride)
      for (int i = first; i < std::min(first + BLOCK, end); i++) {
        if (!field->is_point(i)) continue;
        double now[3] = {f[3 * (bigint) i], f[3 * (bigint) i + 1], f[3 * (bigint) i + 2]};
        for (const auto *ifix : field->elements)
          for (int d = 0; d < 3; d++) now[d] -= ifix->forces()[3 * (bigint) i + d];
        power += dot(now, atom->v[i]);
      }
  }
  run.force_work += stride * power * fields[0]->step_dt();
}

/* ---------------------------------------------------------------------- */

MPMEnergyWatch::Sums MPMEnergyWatch::sums() const
{
  const MPMPointEnergies points = point_energies(lmp);
  Sums mine = {0.0,           0.0, points.kinetic, points.stored, points.taken() - points.stored,
               run.force_work};
  for (const auto *field : fields) {
    for (int i = 0; i < atom->nlocal; i++) {
      if (!field->is_point(i)) continue;
      mine.points++;
      mine.mass += atom->rmass[i];
    }
    const auto &ledger = field->ledger;
    mine.work += ledger.driven + ledger.deleted_kinetic + ledger.deleted_stored;
  }

  std::vector<double> values;
  for (const auto *other : fields[0]->plan->physics) {
    const auto accounts = other->accounts();
    values.resize(accounts.size());
    other->account(values.data());
    for (std::size_t k = 0; k < accounts.size(); k++)
      (accounts[k].stored ? mine.stored : mine.work) += values[k];
  }
  Sums all;
  MPI_Allreduce(&mine, &all, sizeof(Sums) / sizeof(double), MPI_DOUBLE, MPI_SUM, world);
  for (const auto *field : fields) all.points += field->guard->deleted.points;
  return all;
}

/* ---------------------------------------------------------------------- */

void MPMEnergyWatch::begin(const Sums &now)
{
  run.start = now;
  run.lowest = now.unexplained();
  run.in_play = 0.0;
}

/* ----------------------------------------------------------------------
   points that other commands have added or removed bring or take energy that is in no account
------------------------------------------------------------------------- */

void MPMEnergyWatch::check()
{
  const Sums now = sums();
  if (run.steps == 0 || now.points != run.start.points) begin(now);
  const double spent = now.spent - run.start.spent, unexplained = now.unexplained();
  run.last = now;
  run.lowest = std::min(run.lowest, unexplained);
  run.in_play = std::max(run.in_play, now.kinetic + fabs(now.stored) + fabs(spent));
  const double gained = run.gained = unexplained - run.lowest;
  const double speed = AT_REST * fields[0]->lattice.h / update->dt;
  const auto &options = fields[0]->options;
  if (run.told || !(gained > options.most_gain * run.in_play) ||
      !(run.in_play > 0.5 * force->mvv2e * now.mass * speed * speed))
    return;
  run.told = true;
  const std::string text =
      fmt::format("Numerical errors have added the energy {:.4g} to the material points by step {} "
                  "of this run, {:.3g} % of the energy in play ({:.4g}): results are not to be "
                  "trusted. Try a smaller time step (fix mpm/dt), shape quadratic or cubic, "
                  "transfer apic, more points per cell; compute mpm/energy tells where energy goes",
                  gained, update->ntimestep, 100.0 * gained / run.in_play, run.in_play);
  if (options.gain == MPMFieldOptions::GAIN_ERROR)
    error->all(FLERR, Error::NOLASTLINE, "{}; fix mpm ... gain warn|ignore goes on", text);
  if (comm->me == 0)
    error->warning(FLERR, "{}; fix mpm ... gain sets what is done, and from which share on", text);
}

/* ---------------------------------------------------------------------- */

std::string MPMEnergyWatch::report() const
{
  if (run.steps < SHORTEST) return "";
  const double took = run.start.unexplained() - run.lowest;
  return fmt::format("  energy {}at the end: kinetic {:.6g}, stored {:.6g}; since the start "
                     "transfers and friction took {:.3g} ({:.3g} % of the energy in play), and "
                     "numerical errors added {:.3g}\n",
                     fields.size() > 1 ? "of all fields " : "", run.last.kinetic, run.last.stored,
                     took, run.in_play > 0.0 ? 100.0 * took / run.in_play : 0.0, run.gained);
}

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
#include "mpm_field.h"
#include "mpm_guard.h"
#include "mpm_physics.h"
#include "mpm_plan.h"
#include "mpm_point_energies.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int POWER_EVERY = 20;     // steps between values of the power of forces
static constexpr int CHECK_EVERY = 400;    // and between looks at all energies, a multiple of it
static constexpr double AT_REST =
    1.0e-9;    // cells per step: with less than that nothing is in play

/* ---------------------------------------------------------------------- */

void MPMEnergyWatch::step()
{
  if (run.steps % POWER_EVERY == 0) add_force_work();
  if (run.steps % CHECK_EVERY == 0) check();
  run.steps++;
  run.elapsed += fields[0]->step_dt();
}

void MPMEnergyWatch::finish()
{
  if (run.steps == 0) return;
  add_force_work();
  check();
}

/* ----------------------------------------------------------------------
   forces that elements have added are internal
------------------------------------------------------------------------- */

void MPMEnergyWatch::add_force_work()
{
  double now = 0.0;
  for (const auto *field : fields) {
    const PointRows r = field->rows();
    for (int i = 0; i < atom->nlocal; i++)
      if (field->is_point(i)) now += dot(r.f + 3 * (bigint) i, atom->v[i]);
    for (const auto *ifix : field->elements)
      for (int i = 0; i < atom->nlocal; i++)
        if (field->is_point(i)) now -= dot(ifix->forces() + 3 * (bigint) i, atom->v[i]);
  }
  if (run.steps > 0) run.force_work += 0.5 * (run.elapsed - run.power_time) * (run.power + now);
  run.power = now;
  run.power_time = run.elapsed;
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
    mine.work += ledger.boundary + ledger.contact + ledger.deleted_kinetic + ledger.deleted_stored;
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
  run.lowest = std::min(run.lowest, unexplained);
  run.in_play = std::max(run.in_play, now.kinetic + fabs(now.stored) + fabs(spent));
  const double gained = unexplained - run.lowest,
               speed = AT_REST * fields[0]->lattice.h / update->dt;
  const auto &options = fields[0]->options;
  if (run.told || !(gained > options.most_gain * run.in_play) ||
      !(run.in_play > 0.5 * force->mvv2e * now.mass * speed * speed))
    return;
  run.told = true;
  const std::string text = fmt::format(
      "Numerical errors have added the energy {:.4g} to the material points by step {} of this "
      "run, {:.3g} % "
      "of the energy in play ({:.4g}): results are not to be trusted. Try a smaller time step (fix "
      "mpm/dt), "
      "shape quadratic or cubic, transfer apic, more points per cell; compute mpm/energy tells "
      "where energy goes",
      gained, update->ntimestep, 100.0 * gained / run.in_play, run.in_play);
  if (options.gain == MPMFieldOptions::GAIN_ERROR)
    error->all(FLERR, Error::NOLASTLINE, "{}; fix mpm ... gain warn|ignore goes on", text);
  if (comm->me == 0)
    error->warning(FLERR, "{}; fix mpm ... gain sets what is done, and from which share on", text);
}

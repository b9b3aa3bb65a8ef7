/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Affine matrices (APIC, AFLIP, TPIC) apart from the transfers: torques on points, and first values.

// Steps of LAMMPS between the steps of the cycle (keyword every of fix mpm): grains and atoms that
// need a smaller time step take several under one of the material points.
//
// Between two steps of the cycle, points move with their constant velocity, so that what they touch
// sees them move smoothly, and their forces add up. The cycle then starts from where they were, with
// the mean of these forces: it gives them the impulse that they have received, to round-off.

#include "fix_mpm.h"

#include "atom.h"
#include "update.h"

#include <cstring>

using namespace LAMMPS_NS;

int FixMPM::waiting_size() const
{
  return every == 1 ? 0 : (atom->torque_flag ? 9 : 6);
}

/* ----------------------------------------------------------------------
   all steps of the cycle so far have ended when waited is 0
------------------------------------------------------------------------- */

double FixMPM::step_dt() const
{
  return elapsed + (every - waited) * update->dt;
}

/* ----------------------------------------------------------------------
   all fields: true when it is not yet time for the cycle
------------------------------------------------------------------------- */

bool FixMPM::wait()
{
  if (every == 1) return false;
  for (auto *field : fields) field->add_waiting();
  return waited < every;
}

/* ----------------------------------------------------------------------
   add forces, and move the points on, or back to the start when it is time for the cycle
------------------------------------------------------------------------- */

void FixMPM::add_waiting()
{
  const double dt = update->dt;
  waited++;
  elapsed += dt;
  const bool last = waited == every, turns = atom->torque_flag;
  if (last) {
    mean_force.resize(3 * (std::size_t) atom->nmax);
    if (turns) mean_torque.resize(3 * (std::size_t) atom->nmax);
  }
  const double inverse = 1.0 / elapsed;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!is_point(i)) continue;
    double *const w = waiting[i], *const x = atom->x[i];
    const double *const v = atom->v[i], *const f = atom->f[i];
    for (int d = 0; d < 3; d++) {
      w[d] += dt * f[d];
      if (turns) w[6 + d] += dt * atom->torque[i][d];
      if (last) {
        x[d] -= w[3 + d];
        mean_force[3 * (std::size_t) i + d] = inverse * w[d];
        if (turns) mean_torque[3 * (std::size_t) i + d] = inverse * w[6 + d];
      } else {
        w[3 + d] += dt * v[d];
        x[d] += dt * v[d];
      }
    }
  }
}

/* ---------------------------------------------------------------------- */

void FixMPM::end_waiting()
{
  for (int i = 0; i < atom->nlocal; i++)
    if (is_point(i)) memset(waiting[i], 0, waiting_size() * sizeof(double));
  waited = 0;
  elapsed = 0.0;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Grains and atoms may take several steps under one of the material points. Between two steps of
// the cycle points move with constant velocity, and their forces add up. The cycle starts from
// where they were in the middle of these steps, with the mean of the forces, which keeps the energy
// of a spring as leapfrog does: from the place at their start, (K - 1)/(2 K) (omega dt)^2 of it
// would be lost.

#include "field/mpm_every.h"

#include "base/mpm_state.h"

#include <cstring>

using namespace LAMMPS_NS;

MPMEvery::MPMEvery(LAMMPS *lmp, MPMField &field, MPMPointState &state) : Pointers(lmp), field(field)
{
  state.declare(waiting, "mpm:waiting", width());
}

/** Add forces, and move the points on, or to their place on the lattice when it is time for the
 *  cycle. Points that have not waited before are where they are at the start of these steps. */
bool MPMEvery::wait()
{
  const int every = field.options.every;
  const double dt = update->dt, before = 0.5 * (every - 1) * dt;
  const bool first = progress.waited == 0, last = progress.waited == every - 1;
  const bool turns = atom->torque_flag;
  progress.waited++;
  progress.elapsed += dt;
  if (last) {
    mean_force.resize(3 * (std::size_t) atom->nmax);
    if (turns) mean_torque.resize(3 * (std::size_t) atom->nmax);
  }
  const double inverse = 1.0 / progress.elapsed;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double *const w = waiting[i], *const x = atom->x[i];
    const double *const v = atom->v[i], *const f = atom->f[i];
    const bool is_new = first && w[3] == 0.0 && w[4] == 0.0 && w[5] == 0.0;
    for (int d = 0; d < 3; d++) {
      if (is_new) w[3 + d] = -before * v[d];
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
  return progress.waited < every;
}

/** From their new place on the lattice, which they pass in the middle of the next forces to be
 *  added up, to where they are when the first of these acts. */
void MPMEvery::finish()
{
  const double before = 0.5 * (progress.elapsed - update->dt);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    double *const w = waiting[i];
    memset(w, 0, width() * sizeof(double));
    for (int d = 0; d < 3; d++) {
      w[3 + d] = -before * atom->v[i][d];
      atom->x[i][d] += w[3 + d];
    }
  }
  progress = {};
}

/** It has left points on the lattice or near to it: they go on from there like new ones. */
void MPMEvery::forget_broken_step()
{
  if (progress.waited < field.options.every) return;
  for (int i = 0; i < atom->nlocal; i++) memset(waiting[i], 0, width() * sizeof(double));
  progress = {};
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Steps between two flows of pore water, in which no water leaves its point (keyword every of fix mpm/pore).

   The motion changes the pressure of a point by dp = - alpha dV/C, with the change dV of its volume since the last flow and what it
   stores, C = S V. That needs no nodes, and forces have p + dp. The step with the flow takes dp to nodes with the weights of each step
   that does not wait (mpm_pore.cpp), so that nodes see the same of the motion, and points get the pressure of nodes: what these
   cannot see of dp, with which points would lock, is lost before it is more than what waves make of it in so many steps.

   The flow begins with all of dp but that of its own step. With what the motion squeezes out spread over the time of the flow, forces would
   have the flow half of that time too late, and waves a frequency that is too high by a quarter of what flow takes of their pressure in
   that time.
------------------------------------------------------------------------- */

#include "mpm_pore.h"

#include "atom.h"
#include "mpm_field.h"
#include "mpm_points.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Of a point with this J, since the last flow. */
double MPMPore::undrained(const Soil &s, int i, double J) const
{
  const double last = (*waiting)[i];
  return last > 0.0 ? s.of.biot * (last / J - 1.0) / s.of.storage_at(J, water) : 0.0;
}

double MPMPore::undrained(int i) const
{
  const Soil *const s = waiting ? soil(field.material_of(i)) : nullptr;
  return s ? undrained(*s, i, field.points->jacobian(i)) : 0.0;
}

/** The flow begins: it is the pressure of points. */
void MPMPore::gather(const MPMRows &state)
{
  double room[BATCH];
  for (const auto &run : field.map->runs) {
    const Soil *const s = soil(run.material);
    for (int first = run.first; s && first < run.last; first += BATCH) {
      const int n = std::min(BATCH, run.last - first);
      const double *const J = field.jacobians.get(field, first, n, room);
      for (int p = 0; p < n; p++) {
        state[first + p][0] += undrained(*s, first + p, J[p]);
        (*waiting)[first + p] = J[p];
      }
    }
  }
}

void MPMPore::begin_wait(const MPMRows &state)
{
  in_forces.resize(atom->nmax);
  const int width = 1 + field.lattice.dim;
  double room[BATCH], p_old[BATCH];
  for (const auto &run : field.map->runs) {
    const Soil *const s = soil(run.material);
    if (!s) {
      std::fill(&in_forces[run.first], &in_forces[run.first] + (run.last - run.first), 0.0);
      continue;
    }
    const double alpha = s->of.biot;
    for (int first = run.first; first < run.last; first += BATCH) {
      const int n = std::min(BATCH, run.last - first);
      double *const part = in_forces.data() + first, *const last = *waiting + first;
      const double *const J = field.jacobians.get(field, first, n, room), *row = state[first];
      for (int p = 0; p < n; p++, row += width) p_old[p] = row[0];
      for (int p = 0; p < n; p++) last[p] = last[p] > 0.0 ? last[p] : J[p];
      // apart from the rest, where the compiler has vectors for divisions
      for (int p = 0; p < n; p++)
        part[p] =
            alpha * (J[p] * p_old[p] + alpha * (last[p] - J[p]) / s->of.storage_at(J[p], water));
    }
  }
}

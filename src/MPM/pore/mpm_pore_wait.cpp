/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Steps between two flows of pore water, in which no water leaves its point (keyword every of fix
   mpm/pore).

   The motion changes the pressure of a point by dp = - alpha dV/C, with the change dV of its volume
   since the last flow and its storage C = S V. This needs no nodes, and forces have p + dp. The
   step with the flow takes dp to nodes with the same weights as each step that does not wait
   (mpm_pore.cpp), so that nodes see the same part of the motion, and points get the pressure of
   nodes. The part of dp that nodes cannot see, with which points would lock, is lost before it
   exceeds the effect of waves in so many steps.

   A flow right after a step with flow is the same as without waits, to the last bit.

   The flow starts with all of dp except that of its own step. If the squeezed volume were spread
   over the time of the flow, the flow would act in forces half of that time too late, and waves
   would have a frequency that is too high by a quarter of the share of their pressure that flow
   takes in that time.
------------------------------------------------------------------------- */

#include "pore/mpm_pore.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Change of the pressure of a point with this J since the last flow. */
double MPMPore::undrained(const Soil &s, int i, double J) const
{
  const double last = (*waiting)[i];
  return last > 0.0 ? s.of.undrained(last, J, water) : 0.0;
}

double MPMPore::undrained(int i) const
{
  const Soil *const s = waiting ? soil(field.material_of(i)) : nullptr;
  return s ? undrained(*s, i, field.points->jacobian(i)) : 0.0;
}

/** Starts a flow: all changes go into the pressure of points, and into forces. squeezed has the
 *  volumes of points, and capacity their storage. */
void MPMPore::gather(const Soil &s, int first, int n, const double *J, const MPMRows &state)
{
  const int width = 1 + field.lattice.dim;
  const double alpha = s.of.biot;
  const double *const V = squeezed.data() + first, *const C = capacity.data() + first,
                      *const initial = atom->vfrac + first;
  double *const last = *waiting + first, *const part = in_forces.data() + first,
                *const value = mean.data() + first, *row = state[first];
  if (after_wait) {
    double change[BATCH];
    for (int p = 0; p < n; p++) {
      const double since = last[p] > 0.0 ? last[p] : J[p];
      change[p] = alpha * (since - J[p]) * initial[p] / C[p];
    }
    for (int p = 0; p < n; p++, row += width) value[p] = row[0] += change[p];
    for (int p = 0; p < n; p++) part[p] *= value[p];
  }
  for (int p = 0; p < n; p++) largest = std::max(largest, V[p]);
  look_at_layers(lie[&s - soils.data()], first, n, V);
  std::copy_n(J, n, last);
}

/** Measures how much points lie in layers. With quadratic functions, velocities of nodes that
 *  alternate between 1 and -1 along an axis have the slope 0 at nodes, and 2 per cell in the middle
 *  between them; in between the slope is linear. */
void MPMPore::look_at_layers(Layers &sum, int first, int n, const double *V) const
{
  double volume = 0.0;
  for (int p = 0; p < n; p++) volume += V[p];
  sum.volume += volume;
  for (int d = 0; d < field.lattice.dim; d++) {
    const double *const x = atom->x[first] + d;
    const double origin = field.lattice.origin[d], cells = 1.0 / field.lattice.h;
    double steep = 0.0;
    for (int p = 0; p < n; p++) {
      const double at = cells * (x[3 * p] - origin), slope = 4.0 * (at - std::floor(at + 0.5));
      steep += V[p] * slope * slope;
    }
    sum.steep[d] += steep;
  }
}

void MPMPore::add_slopes(const MPMRows &state, Slopes &sum) const
{
  const int dim = field.lattice.dim;
  const double along[3] = {weight(0), weight(1), dim == 3 ? weight(2) : 0.0};
  for (const auto &run : field.map->runs) {
    if (!soil(run.material)) continue;
    const double *row = state[run.first];
    double steepest = sum.steepest, highest = sum.highest, less = sum.less;
    for (int i = run.first; i < run.last; i++, row += 1 + dim) {
      double square = 0.0;
      for (int d = 0; d < dim; d++) square += (row[1 + d] - along[d]) * (row[1 + d] - along[d]);
      if (square * conductance[i] > steepest * capacity[i])
        steepest = square * conductance[i] / capacity[i];
      highest = std::max(highest, row[0]);
      less = std::max(less, -row[0]);
    }
    sum = {steepest, highest, less};
  }
}

void MPMPore::begin_wait(const MPMRows &state)
{
  in_forces.resize(atom->nmax);
  const int width = 1 + field.lattice.dim;
  double buffer[BATCH], p_old[BATCH], storage[BATCH];
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
      const double *const J = field.jacobians.get(field, first, n, buffer), *row = state[first];
      int unknown = 0;
      for (int p = 0; p < n; p++) unknown += !(last[p] > 0.0);
      for (int p = 0; unknown && p < n; p++) last[p] = last[p] > 0.0 ? last[p] : J[p];
      for (int p = 0; p < n; p++, row += width) p_old[p] = row[0];
      // a loop of its own, which the compiler can vectorize with its divisions
      s->of.storage_at(n, J, water, storage);
      for (int p = 0; p < n; p++)
        part[p] = alpha * (J[p] * p_old[p] + alpha * J[p] * (last[p] - J[p]) / storage[p]);
    }
  }
}

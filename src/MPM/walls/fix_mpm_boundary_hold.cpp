/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/fix_mpm_boundary.h"

#include "field/mpm_field.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Is the action of the wall known before a step? It is not where it depends on the impulses that the wall gets, or
 *  where the region moves and takes other nodes. */
bool FixMPMBoundary::is_foreseen() const
{
  return !decides() && !region_moves();
}

bool FixMPMBoundary::holds(const double *normal, int d) const
{
  return kind == STICK ? velocity[d].given : std::fabs(normal[d]) == 1.0;
}

/* ----------------------------------------------------------------------
   A node outside of a mirror is held if its image inside is
------------------------------------------------------------------------- */

void FixMPMBoundary::mark_held(const MPMField &field, std::vector<char> &held) const
{
  if (!is_foreseen()) return;
  const int dim = field.lattice.dim;
  for (const auto &list : nodes) {
    if (list.field != &field) continue;
    const auto outside = [&](int64_t node) {
      int index[3];
      field.grid.node_index(node, index);
      return std::any_of(list.faces.begin(), list.faces.end(), [&](const Face &face) {
        return !face.cut && (index[face.axis] - face.plane) * face.inward < 0;
      });
    };
    for (const auto &orbit : list.orbits)
      for (int k = orbit.first; k < orbit.last; k++) {
        const int64_t node = list.members[k].node;
        if (!orbit.fixed && !outside(node)) continue;
        for (int d = 0; d < dim; d++)
          if (orbit.prescribed[d]) held[node] |= (orbit.fixed ? 1 : 8) << d;
      }
    for (const auto &single : list.singles)
      for (int d = 0; d < dim; d++)
        if (holds(single.normal, d)) held[single.node] |= 1 << d;
    for (const auto &c : list.crossings)
      for (int k = 0; k < c.inside; k++)
        for (int d = 0; d < dim && c.node[k] >= 0; d++)
          if (holds(c.normal, d)) held[c.node[k]] |= 1 << d;
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::Foreseen::reset(int64_t nnodes)
{
  held.assign(3 * nnodes, 0.0);
  mirrored.assign(3 * nnodes, 0);
  mirrors.clear();
}

/* ---------------------------------------------------------------------- */

void FixMPMBoundary::foresee(MPMField &field, const std::vector<char> &near, Foreseen &foreseen)
{
  if (!is_foreseen()) return;
  update_motion(field.step_dt());
  Grid &grid = field.grid;
  const int dim = grid.lattice.dim;
  double V[3];
  const auto hold = [&](int64_t node, int d) {
    if (!near[node / NODES_PER_BLOCK]) return;
    wall.velocity(field, node, V);
    foreseen.held[3 * node + d] = V[d];
  };
  for (const auto &list : nodes) {
    if (list.field != &field) continue;
    for (const auto &orbit : list.orbits) {
      const Member *const first = &list.members[orbit.first],
                          *const last = first + orbit.last - orbit.first;
      if (orbit.fixed) {
        for (const Member *m = first; m < last; m++)
          for (int d = 0; d < dim; d++)
            if (orbit.prescribed[d]) hold(m->node, d);
        continue;
      }
      if (std::none_of(first, last, [&](const Member &m) {
            return near[m.node / NODES_PER_BLOCK];
          }))
        continue;
      Foreseen::Mirror mirror = {};
      wall.velocity(field, orbit.wall, mirror.wall);
      for (const Member *m = first; m < last; m++) {
        const double *const r = grid.record(m->node);
        mirror.mass += r[3];
        for (int d = 0; d < dim; d++) mirror.odd[d] += m->sign * r[3] * (r[d] - mirror.wall[d]);
      }
      if (!(mirror.mass > 0.0)) continue;
      for (int d = 0; d < dim; d++) mirror.odd[d] /= mirror.mass;
      foreseen.mirrors.push_back(mirror);
      const int place = (int) foreseen.mirrors.size();
      for (const Member *m = first; m < last; m++)
        for (int d = 0; d < dim; d++)
          if (orbit.prescribed[d]) foreseen.mirrored[3 * m->node + d] = m->sign * place;
    }
    for (const auto &single : list.singles)
      for (int d = 0; d < dim; d++)
        if (holds(single.normal, d)) hold(single.node, d);
    for (const auto &c : list.crossings)
      for (int k = 0; k < c.inside; k++)
        for (int d = 0; d < dim && c.node[k] >= 0; d++)
          if (holds(c.normal, d)) hold(c.node[k], d);
  }
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Grips: regions that move with stick, in implicit steps, where material goes through their surface. If a grip held whole nodes,
// the length between two grips would be wrong by part of a node spacing. Instead, the grip cuts the body: points inside move with
// it and have no part in the balance of forces, and the line of nodes through the surface holds the material there, as a plate in
// front of a body does. The nodes of the line are not held beyond that, so that the strain in front of the grip continues behind
// the surface, where the material has no stress.
//
// Lines along one axis share no nodes. Where lines along two axes do, at edges and on curved surfaces, nodes are held one by one.

#include "walls/fix_mpm_boundary.h"

#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"

#include "atom.h"
#include "region.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double FAR = 1.0e8;          // node spacings
static constexpr double STRAIGHT = 0.9999;    // cosine between a line and the normal

void FixMPMBoundary::find_lines_alone(FieldNodes &list) const
{
  std::unordered_map<int64_t, int> lines;
  for (const auto &c : list.crossings)
    for (int k = 0; k < c.n; k++)
      if (c.node[k] >= 0) lines[c.node[k]]++;
  for (auto &c : list.crossings)
    c.alone = std::all_of(c.node, c.node + c.n, [&](int64_t node) {
      return node >= 0 && lines[node] == 1;
    });

  // on a curved surface, successive projections on lines that share nodes converge slowly if at all: nodes are held one by one there

  list.crossings.erase(std::remove_if(list.crossings.begin(), list.crossings.end(),
                                      [](const Crossing &c) {
                                        return !c.alone && std::fabs(c.normal[c.axis]) < STRAIGHT;
                                      }),
                       list.crossings.end());
}

/** Is there material on both sides of the surface, and can the line hold it? */
bool FixMPMBoundary::goes_through(Grid &grid, const Crossing &c)
{
  return c.alone && std::all_of(c.node, c.node + c.n, [&](int64_t node) {
           return grid.record(node)[3] > 0.0;
         });
}

/** Finds the share of each point that is outside of the grip (left); a point that the surface cuts is divided by its width. */
bool FixMPMBoundary::find_carried(MPMField &field, std::vector<double> &left)
{
  carrying = follows && kind == STICK && acts_across();
  if (!carrying) return false;
  left.resize(atom->nmax, 1.0);
  const int dim = field.lattice.dim;
  const double h = field.lattice.h;
  const auto away = distance_from_region(field, trial_dt);
  for (const auto &run : field.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const x = atom->x[i], distance = away(x), *const F = field.points->F[i];
      if (distance > h) continue;
      double width = 0.0;
      if (distance > -h) {
        double y[3], v[3], n[3];
        wall.velocity(x, v);
        for (int d = 0; d < 3; d++) y[d] = x[d] + trial_dt * v[d];
        surface->normal(y, FAR * h, 1.0e-4 * h, n);
        for (int c = 0; c < dim; c++) {
          double along = 0.0;
          for (int d = 0; d < dim; d++) along += F[3 * d + c] * n[d];
          width += along * along;
        }
        width = std::sqrt(width) * std::pow(atom->vfrac[i], 1.0 / dim);
      }
      const double share = width > 0.0 ? 0.5 + distance / width : (double) (distance > 0.0);
      if (share < 1.0) left[i] = std::min(left[i], std::max(share, 0.0));
    }
  return true;
}

/** Spreads the force on each line over its nodes, in the shares of the constraint. */
void FixMPMBoundary::bear_carried(MPMField &field, double *force)
{
  if (!carrying) return;
  const int dim = field.lattice.dim;
  for (const auto &list : nodes) {
    if (list.field != &field) continue;
    for (const auto &c : list.crossings) {
      if (!goes_through(field.grid, c)) continue;
      for (int d = 0; d < dim; d++) {
        double all = 0.0, shares = 0.0;
        for (int k = 0; k < c.n; k++) {
          all += force[dim * c.node[k] + d];
          shares += c.weight[k];
        }
        for (int k = 0; k < c.n; k++) force[dim * c.node[k] + d] = all * c.weight[k] / shares;
      }
    }
  }
}

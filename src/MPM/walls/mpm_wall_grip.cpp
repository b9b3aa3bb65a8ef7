/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Grips: regions that move with stick, in implicit steps, where material goes through their
// surface. If a grip held whole nodes, the length between two grips would be wrong by part of a
// node spacing. Instead, the grip cuts the body: points inside move with it and have no part in the
// balance of forces, and the line of nodes through the surface holds the material there, as a plate
// in front of a body does. The nodes of the line are not held beyond that, so that the strain in
// front of the grip continues behind the surface, where the material has no stress.
//
// Lines along one axis share no nodes. Where lines along two axes do, at edges and on curved
// surfaces, nodes are held one by one.

#include "walls/mpm_wall_trial.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "walls/mpm_wall.h"
#include "walls/mpm_wall_nodes.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Finds the share of each point that is outside of the grip (left); a point that the surface cuts
 *  is divided by its width. */
bool MPMWallTrial::find_carried(MPMField &of, std::vector<double> &left)
{
  wall.is_grip = wall.moves_and_holds && wall.kind == MPMWall::STICK && wall.acts_across();
  if (!wall.is_grip) return false;
  left.resize(atom->nmax, 1.0);
  const int dim = of.lattice.dim;
  const double h = of.lattice.h;
  const auto away = wall.distance_from_region(of, dt);
  for (const auto &run : of.map->runs)
    for (bigint i = run.first; i < run.last; i++) {
      const double *const x = atom->x[i], distance = away(x), *const F = of.points->F[i];
      if (distance > h) continue;
      double width = 0.0;
      if (distance > -h) {
        double y[3], v[3], n[3];
        wall.motion.velocity(x, v);
        for (int d = 0; d < 3; d++) y[d] = x[d] + dt * v[d];
        wall.normal(of, y, n);
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
void MPMWallTrial::constrain_carried(MPMField &of, double *force)
{
  if (!wall.is_grip) return;
  const int dim = of.lattice.dim;
  for (const auto &list : fields) {
    if (&list.field != &of) continue;
    for (const auto &c : list.crossings.lines) {
      if (!c.goes_through(of.grid)) continue;
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

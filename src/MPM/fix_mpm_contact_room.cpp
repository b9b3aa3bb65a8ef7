/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Volumes of bodies at nodes next to fixed faces of the box, and to an axis of symmetry, where there are no
// points in a part of the volume that belongs to a node: bodies that touch there fill the rest. A node in
// the plane of a face has room for half of its volume. Nodes outside are images of those inside
// (fix_mpm_boundary.cpp), and in contact when these are.

#include "fix_mpm_contact.h"

#include "domain.h"
#include "mpm_field.h"
#include "mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void FixMPMContact::find_room()
{
  constexpr int FIXED = 1, SAMPLES = 48;    // boundary f; places per cell
  const MPMField &field = *bodies[0].field;
  for (int d = 0; d < field.lattice.dim; d++) {
    double face[2] = {-1.0e300, 1.0e300};    // in node spacings
    const double h = field.lattice.h, origin = field.lattice.origin[d];
    if (domain->boundary[d][0] == FIXED) face[0] = (domain->boxlo[d] - origin) / h;
    if (domain->boundary[d][1] == FIXED) face[1] = (domain->boxhi[d] - origin) / h;

    // share of the function of a node that is between the faces. Points with a size fill the cells, and
    // have the mean of the linear function

    const auto inside = [&](int node) {
      int first;
      double w[4], sum = 0.0;
      for (int k = -REACH * SAMPLES; k < REACH * SAMPLES; k++) {
        const double t = node + (k + 0.5) / SAMPLES;
        if (t < face[0] || t > face[1]) continue;
        if (field.options.has_size()) {
          sum += std::max(0.0, 1.0 - std::fabs(t - node)) / SAMPLES;
          continue;
        }
        const int n = MPMStencil(field).weights(t, first, w);
        if (node >= first && node < first + n) sum += w[node - first] / SAMPLES;
      }
      return sum;
    };
    for (int side = 0; side < 2; side++) {
      Room &near = room[d][side];
      near.fixed = domain->boundary[d][side] == FIXED;
      if (!near.fixed) continue;
      near.plane = (int) std::lround(face[side]);
      const int inward = side ? -1 : 1;
      for (int k = 0; k <= REACH; k++) near.share[k] = inside(near.plane + inward * k);
      if (!field.options.modified_edges) continue;
      const double outside = inside(near.plane - inward);    // see MPMEdges::fold()
      near.share[0] += 2.0 * outside;
      near.share[1] -= outside;
    }
  }
}

/* ----------------------------------------------------------------------
   share of the volume of node n, as far as it is inside of the box, that all bodies fill
------------------------------------------------------------------------- */

double FixMPMContact::filled(const Common &c, int n) const
{
  int any = 0, index[3];
  while (c.slot[any] < 0) any++;
  const Grid &grid = bodies[any].field->grid;
  grid.node_index(grid.blocks[c.slot[any]], n, index);
  double most = 1.0;
  bool image = false;
  for (int d = 0; d < grid.lattice.dim; d++) {
    double least = 1.0;    // a narrow box: two faces are near
    for (int side = 0; side < 2; side++) {
      const Room &near = room[d][side];
      if (!near.fixed) continue;
      int depth = (side ? -1 : 1) * (index[d] - near.plane);
      if (depth < 0) {
        index[d] = 2 * near.plane - index[d];
        depth = -depth;
        image = true;
      }
      if (depth <= REACH) least = std::min(least, near.share[depth]);
    }
    most *= least;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < bodies.size(); k++) {
    int64_t node = c.slot[k] < 0 ? -1 : (int64_t) c.slot[k] * NODES_PER_BLOCK + n;
    if (image) node = bodies[k].field->grid.locate(index);
    if (node >= 0) sum += bodies[k].share[node];
  }
  return most > 0.0 ? sum / most : 0.0;
}

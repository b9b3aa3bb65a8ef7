/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "contact/mpm_inside_fraction.h"

#include "domain.h"
#include "field/mpm_field.h"
#include "field/mpm_stencil.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

void MPMInsideFraction::find(const MPMField &field, const Domain &box)
{
  constexpr int FIXED = 1, SAMPLES = 48;    // boundary f; places per cell
  for (int d = 0; d < field.lattice.dim; d++) {
    double face[2] = {-1.0e300, 1.0e300};    // in node spacings
    const double h = field.lattice.h, origin = field.lattice.origin[d];
    if (box.boundary[d][0] == FIXED) face[0] = (box.boxlo[d] - origin) / h;
    if (box.boundary[d][1] == FIXED) face[1] = (box.boxhi[d] - origin) / h;

    // fraction of the function of a node that is between the faces. Points with a size fill the
    // cells, and have the mean of the linear function
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
      Side &near = sides[d][side];
      near.fixed = box.boundary[d][side] == FIXED;
      near.mirror = false;
      if (!near.fixed) continue;
      near.plane = (int) std::lround(face[side]);
      // an axis of symmetry is no mirror: volumes at its nodes are those of rings
      near.mirror =
          std::fabs(face[side] - near.plane) < 1.0e-6 && !(field.options.axisymmetric && d == 0);
      const int inward = side ? -1 : 1;
      for (int k = 0; k <= REACH; k++) near.fraction[k] = inside(near.plane + inward * k);
      if (!field.options.modified_edges) continue;
      const double outside = inside(near.plane - inward);    // see MPMEdges::fold()
      near.fraction[0] += 2.0 * outside;
      near.fraction[1] -= outside;
    }
  }
}

double MPMInsideFraction::at(int *index, int dim, bool &mirrored) const
{
  double most = 1.0;
  for (int d = 0; d < dim; d++) {
    double least = 1.0;    // a narrow box: two faces are near
    for (int side = 0; side < 2; side++) {
      const Side &near = sides[d][side];
      if (!near.fixed) continue;
      int depth = (side ? -1 : 1) * (index[d] - near.plane);
      if (depth < 0) {
        index[d] = 2 * near.plane - index[d];
        depth = -depth;
        mirrored = true;
      }
      if (depth <= REACH) least = std::min(least, near.fraction[depth]);
    }
    most *= least;
  }
  return most;
}

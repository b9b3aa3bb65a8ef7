/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_MPM_VISIT_H
#define LMP_FIX_MPM_VISIT_H

// The nodes that a point of fix mpm reaches, one by one: for sums apart from the step, where the fast
// kernels do not have what is needed.

#include "fix_mpm.h"
#include "transfer/shape.h"

namespace LAMMPS_NS {

/** Calls f(node, weight, r) for all nodes of point i, which is in the given block; node: slot * 64 +
 *  number in the block, r: from the node to the point, in node spacings. */
template <class F>
void FixMPM::visit_nodes(const MPM_NS::Grid::Block &block, int i, const F &f) const
{
  if (!has_domains()) {
    visit_nodes(block, i, place(i), 1.0, f);
    return;
  }
  const int dim = lattice.dim;
  double corner[24], share[8];
  domain_corners(i, corner, share);
  for (int c = 0; c < 1 << dim; c++) {
    double x[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) x[d] = place(i)[d] + corner[dim * c + d];
    visit_nodes(block, i, x, share[c], f);
  }
}

/** The same for the functions at x, with weights times share. */
template <class F>
void FixMPM::visit_nodes(const MPM_NS::Grid::Block &block, int i, const double *x, double share,
                         const F &f) const
{
  using namespace MPM_NS;
  const int dim = lattice.dim;
  int base[3];
  double at[3], w[3][4] = {{0.0}, {0.0}, {1.0}};
  for (int d = 0; d < dim; d++) {
    const double t = (x[d] - lattice.origin[d]) / lattice.h;
    at[d] = (place(i)[d] - lattice.origin[d]) / lattice.h;
    shape_weights(t, base[d], w[d]);
    if (has_boxes()) Gimp::weights(t - Gimp::shift - base[d], sizes[3 * (std::size_t) i + d], w[d]);
  }
  int k[3];
  for (k[0] = 0; k[0] <= shape; k[0]++)
    for (k[1] = 0; k[1] <= shape; k[1]++)
      for (k[2] = 0; k[2] <= (dim == 3 ? (int) shape : 0); k[2]++) {
        int side[3] = {1, 1, 1}, in[3] = {0, 0, 0};
        double r[3] = {0.0, 0.0, 0.0};
        for (int d = 0; d < dim; d++) {
          const int node = base[d] + k[d];
          side[d] = (node >> grid->shift_bits) - block.b[d] + 1;
          in[d] = node & (grid->side - 1);
          r[d] = at[d] - node;
        }
        const int slot = block.slot[9 * side[0] + 3 * side[1] + side[2]];
        const int n = dim == 3 ? (in[0] * 4 + in[1]) * 4 + in[2] : in[0] * 8 + in[1];
        f((int64_t) slot * NODES_PER_BLOCK + n, share * w[0][k[0]] * w[1][k[1]] * w[2][k[2]], r);
      }
}

}    // namespace LAMMPS_NS
#endif

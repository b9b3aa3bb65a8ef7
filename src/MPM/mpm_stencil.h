/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STENCIL_H
#define LMP_MPM_STENCIL_H

// The nodes that a point reaches, one by one: for sums that the fast transfers do not make. These are
// the only loops over the nodes of a point outside of transfer/.

#include "mpm_field.h"

#include <cstdint>

namespace LAMMPS_NS {

/** Functions of a point along each axis: their number, nodes and weights. */
class MPMStencil {
 public:
  explicit MPMStencil(const MPMField &field) : field(field) {}

  /** Nodes along one axis that a position reaches (in node spacings from the origin): their number,
   *  the first one, and the weights. Points of finite size: those of the spline with their stencil. */
  int weights(double t, int &first, double w[4]) const;

  /** Calls f(node, weight, r) for all nodes of point i, which is in the given block; node: slot * 64 +
   *  number in the block, r: from the node to the point, in node spacings. */
  template <class F> void visit(const MPM_NS::Grid::Block &block, int i, const F &f) const
  {
    double corner[24], share[8];
    const int n = corners(i, corner, share), dim = field.lattice.dim;
    const double *const place = field.place(i);
    for (int c = 0; c < n; c++) {
      double x[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < dim; d++) x[d] = n > 1 ? place[d] + corner[dim * c + d] : place[d];
      visit_at(block, i, x, share[c], f);
    }
  }

 private:
  const MPMField &field;

  /** Corners of the domain of a point relative to it, and their weights; a point without domain is
   *  the only one. */
  int corners(int i, double *x, double *w) const;
  void weights_of_size(int i, int axis, double t, int first, double w[4]) const;

  template <class F>
  void visit_at(const MPM_NS::Grid::Block &block, int i, const double *x, double share,
                const F &f) const
  {
    const auto &lattice = field.lattice;
    const auto &grid = field.grid;
    int base[3] = {0, 0, 0}, count[3] = {1, 1, 1};
    double at[3] = {0.0, 0.0, 0.0}, w[3][4] = {{0.0}, {0.0}, {1.0}};
    for (int d = 0; d < lattice.dim; d++) {
      const double t = (x[d] - lattice.origin[d]) / lattice.h;
      at[d] = (field.place(i)[d] - lattice.origin[d]) / lattice.h;
      count[d] = weights(t, base[d], w[d]);
      if (field.boxes) weights_of_size(i, d, t, base[d], w[d]);
    }
    int k[3];
    for (k[0] = 0; k[0] < count[0]; k[0]++)
      for (k[1] = 0; k[1] < count[1]; k[1]++)
        for (k[2] = 0; k[2] < count[2]; k[2]++) {
          int side[3] = {1, 1, 1}, in[3] = {0, 0, 0};
          double r[3] = {0.0, 0.0, 0.0};
          for (int d = 0; d < lattice.dim; d++) {
            const int node = base[d] + k[d];
            side[d] = (node >> grid.shift_bits) - block.b[d] + 1;
            in[d] = node & (grid.side - 1);
            r[d] = at[d] - node;
          }
          const int slot = block.slot[9 * side[0] + 3 * side[1] + side[2]];
          const int n = lattice.dim == 3 ? (in[0] * 4 + in[1]) * 4 + in[2] : in[0] * 8 + in[1];
          f((int64_t) slot * MPM_NS::NODES_PER_BLOCK + n,
            share * w[0][k[0]] * w[1][k[1]] * w[2][k[2]], r);
        }
  }
};

}    // namespace LAMMPS_NS
#endif

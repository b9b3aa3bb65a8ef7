/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STENCIL_H
#define LMP_MPM_STENCIL_H

// The nodes that a point reaches, one by one, for sums that the fast transfers do not make. These
// are the only loops over the nodes of a point outside of transfer/.

#include "field/mpm_cpdi.h"
#include "field/mpm_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace LAMMPS_NS {

/** Visits the nodes of points, one point at a time. */
class MPMStencil {
 public:
  /** A node as a point sees it. A domain (CPDI) sees a node once from each of its corners. */
  struct Node {
    int64_t number;        ///< slot * 64 + number in the block
    double weight;         ///< N_ip
    double gradient[3];    ///< of N_ip with respect to the position of the point [1/distance]
    double r[3];           ///< from the node to the point, in node spacings
  };

  /** Share of a cell that a node without points may have by round-off. Where quadratic functions
   *  end at the distance e behind a node, in node spacings, it has the mass e^2, and the force e
   *  and stiffness e^2: it moves by 1/e, and gives points in reach a strain that does not depend on
   *  e. Whether such a node is there must not depend on round-off, as in regular arrays of points,
   *  where functions end in planes of nodes. */
  static constexpr double ROUND_OFF = 1.0e-20;

  explicit MPMStencil(const MPMField &field) : field(field) {}

  /** Nodes along one axis that a position t reaches (in node spacings from the origin). Returns
   *  their number, the first node, the weights, and, if asked for, their slopes per node spacing.
   *  For points of finite size these are the values of the spline with the same stencil. */
  int weights(double t, int &first, double w[4], double *slopes = nullptr) const
  {
    const MPM_NS::Shape shape = field.options.shape;
    if (shape == MPM_NS::BERNSTEIN) return evaluate<MPM_NS::Bernstein>(t, first, w, slopes);
    const int order = MPM_NS::stencil_order(shape);
    if (order == 1) return evaluate<MPM_NS::BSpline<1>>(t, first, w, slopes);
    if (order == 2) return evaluate<MPM_NS::BSpline<2>>(t, first, w, slopes);
    return evaluate<MPM_NS::BSpline<3>>(t, first, w, slopes);
  }

  /** As weights(), but always for the quadratic B-splines on these nodes. */
  static int quadratic(double t, int &first, double w[4])
  {
    return evaluate<MPM_NS::BSpline<2>>(t, first, w, nullptr);
  }

  /** Nodes along the axes that a place x reaches, and the functions there of point i or, if points
   *  have domains, of a corner: the first node, their number, weights, and their slopes per node
   *  spacing. */
  void along_axes(int i, const double *x, int first[3], int count[3], double w[3][4],
                  double dw[3][4]) const
  {
    for (int d = 0; d < 3; d++) {
      first[d] = 0;
      count[d] = 1;
      w[d][0] = 1.0;
      dw[d][0] = 0.0;
    }
    for (int d = 0; d < field.lattice.dim; d++) {
      const double t = (x[d] - field.lattice.origin[d]) / field.lattice.h;
      count[d] = weights(t, first[d], w[d], dw[d]);
      if (!field.boxes) continue;
      const double size = field.boxes->sizes[3 * (std::size_t) i + d];
      MPM_NS::Gimp::weights(t - MPM_NS::Gimp::shift - first[d], size, w[d]);
      MPM_NS::Gimp::gradients(t - MPM_NS::Gimp::shift - first[d], size, dw[d]);
    }
  }

  /** Finds the nodes of point i without a domain, which is in the given block, and the gradients
   *  of their functions, [n][dim] [1/distance]. The lists may be empty or those of another point,
   *  whose numbers stay if they are the same. */
  void find_gradients(const MPM_NS::Grid::Block &block, int i, std::vector<int64_t> &nodes,
                      std::vector<double> &gradients) const
  {
    const int dim = field.lattice.dim;
    const double per_spacing = 1.0 / field.lattice.h;
    int first[3], n[3];
    double w[3][4], dw[3][4];
    along_axes(i, field.frame->places()[i], first, n, w, dw);
    const std::size_t count = (std::size_t) n[0] * n[1] * n[2];
    const bool same = nodes.size() == count && nodes[0] == field.grid.locate_near(block, first);
    nodes.resize(count);
    gradients.resize(dim * count);
    int64_t *number = nodes.data();
    double *at = gradients.data();
    for (int i0 = 0; i0 < n[0]; i0++)
      for (int i1 = 0; i1 < n[1]; i1++) {
        const double across = per_spacing * w[0][i0] * w[1][i1],
                     along_0 = per_spacing * dw[0][i0] * w[1][i1],
                     along_1 = per_spacing * w[0][i0] * dw[1][i1];
        for (int i2 = 0; i2 < n[2]; i2++, at += dim, number++) {
          at[0] = along_0 * w[2][i2];
          at[1] = along_1 * w[2][i2];
          if (dim == 3) at[2] = across * dw[2][i2];
          if (same) continue;
          const int index[3] = {first[0] + i0, first[1] + i1, first[2] + i2};
          *number = field.grid.locate_near(block, index);
        }
      }
  }

  /** Calls f(Node) for all nodes of point i, which is in the given block. */
  template <class F> void visit(const MPM_NS::Grid::Block &block, int i, const F &f) const
  {
    const auto &lattice = field.lattice;
    const int dim = lattice.dim;
    const double *const place = field.frame->places()[i];

    // corners of the domain of the point relative to it, their shares, and the gradients of the
    // shares; a point without domain is its only corner

    const int ncorner = field.domains ? 1 << dim : 1;
    double corner[24] = {0.0}, share[8] = {1.0}, slope[24];
    if (field.domains) field.domains->corners_of(i, corner, share, slope);

    for (int c = 0; c < ncorner; c++) {
      int base[3], count[3], k[3];
      double x[3] = {0.0, 0.0, 0.0}, at[3] = {0.0, 0.0, 0.0}, w[3][4], dw[3][4];
      for (int d = 0; d < dim; d++) {
        x[d] = field.domains ? place[d] + corner[dim * c + d] : place[d];
        at[d] = (place[d] - lattice.origin[d]) / lattice.h;
      }
      along_axes(i, x, base, count, w, dw);
      Node node;
      for (k[0] = 0; k[0] < count[0]; k[0]++)
        for (k[1] = 0; k[1] < count[1]; k[1]++)
          for (k[2] = 0; k[2] < count[2]; k[2]++) {
            int index[3] = {0, 0, 0};
            const double N = w[0][k[0]] * w[1][k[1]] * w[2][k[2]];
            for (int d = 0; d < 3; d++) {
              node.r[d] = node.gradient[d] = 0.0;
              if (d >= dim) continue;
              const int e = (d + 1) % 3, other = (d + 2) % 3;
              index[d] = base[d] + k[d];
              node.r[d] = at[d] - index[d];
              node.gradient[d] = field.domains
                  ? slope[dim * c + d] * N
                  : dw[d][k[d]] * w[e][k[e]] * w[other][k[other]] / lattice.h;
            }
            node.number = field.grid.locate_near(block, index);
            node.weight = share[c] * w[0][k[0]] * w[1][k[1]] * w[2][k[2]];
            f(node);
          }
    }
  }

  /** Values along the axes for a point without domain. The node with the indices k along the axes
   *  has the number number(k), its weight is the product of w[d][k[d]], and its r consists of
   *  r[d][k[d]]. */
  struct Axes {
    int count[3];
    double w[3][4], r[3][4];

    int64_t number(int k0, int k1, int k2) const
    {
      const int slot = slots[neighbor[0][k0] + neighbor[1][k1] + neighbor[2][k2]];
      return (int64_t) slot * MPM_NS::NODES_PER_BLOCK + inside[0][k0] + inside[1][k1] +
          inside[2][k2];
    }

   private:
    friend class MPMStencil;
    const int *slots;
    int neighbor[3][4],
        inside[3][4];    // contributions to the index in slots, and to the number in the block
  };

  /** Finds the axes of point i, which is in the given block, for loops that are written out. */
  void find_axes(const MPM_NS::Grid::Block &block, int i, Axes &axes) const
  {
    const double *const place = field.frame->places()[i];
    axes.slots = block.slot;
    for (int d = 0; d < 3; d++) {
      const double t = (place[d] - field.lattice.origin[d]) / field.lattice.h;
      int base = 0;
      if (d < field.lattice.dim) axes.count[d] = weights(t, base, axes.w[d]);
      if (d < field.lattice.dim && field.boxes)
        MPM_NS::Gimp::weights(t - MPM_NS::Gimp::shift - base,
                              field.boxes->sizes[3 * (std::size_t) i + d], axes.w[d]);
      number_axis(block, d, t, base, axes);
    }
  }

  /** The same for a position, such as that of an atom that is not a point. Requires
   *  reaches_blocks(). */
  void find_axes(const double *x, Axes &axes)
  {
    const auto &grid = field.grid;
    int base[3] = {0, 0, 0};
    double t[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < field.lattice.dim; d++) {
      t[d] = (x[d] - field.lattice.origin[d]) / field.lattice.h;
      axes.count[d] = weights(t[d], base[d], axes.w[d]);
    }
    find_slot(base);
    const auto &block = grid.blocks[slot];
    axes.slots = block.slot;
    for (int d = 0; d < 3; d++) number_axis(block, d, t[d], base[d], axes);
  }

  /** Are all nodes that a position reaches active? The blocks must not change while this object is
   *  used, because it remembers the last one. */
  bool reaches_blocks(const double *x)
  {
    const auto &grid = field.grid;
    int base[3] = {0, 0, 0}, more[3] = {0, 0, 0};
    for (int d = 0; d < field.lattice.dim; d++) {
      double w[4];
      const int n = weights((x[d] - field.lattice.origin[d]) / field.lattice.h, base[d], w);
      more[d] = ((base[d] + n - 1) >> grid.shift_bits) - (base[d] >> grid.shift_bits);
    }
    if (!find_slot(base)) return false;
    const int *const neighbors = grid.blocks[slot].slot + 13;
    for (int a = 0; a <= more[0]; a++)
      for (int b = 0; b <= more[1]; b++)
        for (int c = 0; c <= more[2]; c++)
          if (neighbors[9 * a + 3 * b + c] < 0) return false;
    return true;
  }

  /** Calls f(number, weight, r) for the nodes that a position reaches, such as that of an atom that
   *  is not a point; r: from the node to the position, in node spacings. Returns false if not all
   *  nodes are active. The blocks must not change while this object is used, because it remembers
   *  the last one. */
  template <class F> bool visit_around(const double *x, const F &f)
  {
    const auto &grid = field.grid;
    int base[3] = {0, 0, 0}, count[3] = {1, 1, 1}, k[3];
    double t[3] = {0.0, 0.0, 0.0}, w[3][4] = {{0.0}, {0.0}, {1.0}};
    for (int d = 0; d < field.lattice.dim; d++) {
      t[d] = (x[d] - field.lattice.origin[d]) / field.lattice.h;
      count[d] = weights(t[d], base[d], w[d]);
    }
    if (!find_slot(base)) return false;
    for (k[0] = 0; k[0] < count[0]; k[0]++)
      for (k[1] = 0; k[1] < count[1]; k[1]++)
        for (k[2] = 0; k[2] < count[2]; k[2]++) {
          const int index[3] = {base[0] + k[0], base[1] + k[1], base[2] + k[2]};
          const double r[3] = {t[0] - index[0], t[1] - index[1], t[2] - index[2]};
          const int64_t node = grid.locate_near(grid.blocks[slot], index);
          if (node < 0) return false;
          f(node, w[0][k[0]] * w[1][k[1]] * w[2][k[2]], r);
        }
    return true;
  }

 private:
  const MPMField &field;
  int slot = -1;    // of the last block that was found

  /** Finds the block of a node. */
  bool find_slot(const int base[3])
  {
    const auto &grid = field.grid;
    int b[3];
    for (int d = 0; d < 3; d++) b[d] = base[d] >> grid.shift_bits;
    if (slot < 0 || !std::equal(b, b + 3, grid.blocks[slot].b)) slot = grid.find(b);
    return slot >= 0;
  }

  /** Sets the members of Axes along one axis, except for the weights. */
  void number_axis(const MPM_NS::Grid::Block &block, int d, double t, int base, Axes &axes) const
  {
    const auto &grid = field.grid;
    const int dim = field.lattice.dim, stride = d == 0 ? 9 : (d == 1 ? 3 : 1);
    if (d >= dim) {
      axes.count[d] = 1;
      axes.w[d][0] = 1.0;
      axes.r[d][0] = 0.0;
      axes.neighbor[d][0] = stride;
      axes.inside[d][0] = 0;
      return;
    }
    const int step = d == dim - 1 ? 1 : (d == dim - 2 ? grid.side : grid.side * grid.side);
    for (int k = 0; k < axes.count[d]; k++) {
      const int index = base + k;
      axes.r[d][k] = t - index;
      axes.neighbor[d][k] = stride * ((index >> grid.shift_bits) - block.b[d] + 1);
      axes.inside[d][k] = step * (index & (grid.side - 1));
    }
  }

  template <class Functions> static int evaluate(double t, int &first, double w[4], double *slopes)
  {
    const double cell = std::floor(t / Functions::cell - Functions::shift);
    const double f = t / Functions::cell - Functions::shift - cell;
    first = Functions::cell * (int) cell;
    Functions::weights(f, w);
    if (slopes) Functions::gradients(f, slopes);
    return Functions::nodes;
  }
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_BOXES_H
#define LMP_MPM_FLOW_BOXES_H

#include "flow/mpm_flow_stencil.h"
#include "lattice/grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace LAMMPS_NS {

/** Shares of a point of some width in boxes of one spacing, which are cells or are around their
 *  corners, edges, and faces: weights along each axis, and gradients of the velocity as means of
 *  those of boxes. The gradient of a box is the difference of two faces: a normal gradient that of
 *  its cell, a shear that of the faces on both sides of a corner (in 3d an edge). */
template <int dim> struct MPMFlowBoxes {
  enum Place { CELL, NODE };

  /** Kinds of boxes, by the axes of one of their gradients: cells, and boxes of the shears xy, xz,
   *  yz. */
  static constexpr int KINDS = dim == 2 ? 2 : 4, AXES[4][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 2}};
  static constexpr int kind_of(int c, int d) { return c == d ? 0 : c + d; }

  int first[2][3];    // [place][axis]: first one of two adjacent boxes
  double share[2][3][2];

  /** Finds the boxes and shares of a point at t, in spacings from node 0. width: of the point, in
   *  spacings, at most 1. */
  void find(const double *t, double width)
  {
    for (int place = CELL; place <= NODE; place++)
      for (int d = 0; d < dim; d++) {
        // from the lower end of the cell with its number to that of a box
        const double shift = place == NODE ? 0.5 : 0.0;
        const double low = t[d] + shift - 0.5 * width, box = std::floor(low);
        first[place][d] = (int) box;
        share[place][d][0] = std::min(1.0, (box + 1.0 - low) / width);
        share[place][d][1] = 1.0 - share[place][d][0];
      }
  }

  /** The same with the boxes that a point of the width reach, at least width, would have. */
  void find(const double *t, double width, double reach)
  {
    find(t, reach);
    for (int place = CELL; place <= NODE; place++)
      for (int d = 0; d < dim; d++) {
        const double low = t[d] + (place == NODE ? 0.5 : 0.0) - 0.5 * width;
        const double first_share = (first[place][d] + 1.0 - low) / width;
        share[place][d][0] = std::max(0.0, std::min(1.0, first_share));
        share[place][d][1] = 1.0 - share[place][d][0];
      }
  }

  /** Calls f(number of the cell that is a box, or has it at its lower side; share) for the boxes at
   *  these places along each axis. */
  template <class F>
  void visit_boxes(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &block, const Place *places,
                   const F &f) const
  {
    int base[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) base[d] = first[places[d]][d];
    const MPMFlowStencil<dim> reach(grid, block, base);
    for_each_index<dim>({2, 2, 2}, [&](const int *k) {
      double weight = 1.0;
      for (int d = 0; d < dim; d++) weight *= share[places[d]][d][k[d]];
      if (weight > 0.0) f(reach.number(k), weight);
    });
  }

  /** Places of the boxes of the gradient along d of velocities along c. */
  static void places_of(int c, int d, Place *places)
  {
    for (int e = 0; e < dim; e++) places[e] = c != d && (e == c || e == d) ? NODE : CELL;
  }

  /** Calls f(number of a cell, coefficient of the velocity of its face normal to c in the gradient
   *  along d, in 1/spacing). */
  template <class F>
  void visit_gradients(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &block, int c, int d,
                       const F &f) const
  {
    Place places[3];
    places_of(c, d, places);
    int base[3] = {0, 0, 0}, n[3] = {2, 2, 2};
    n[d] = 3;
    for (int e = 0; e < dim; e++) base[e] = first[places[e]][e] - (e == d && c != d ? 1 : 0);
    const MPMFlowStencil<dim> reach(grid, block, base);
    const double *const along = share[places[d]][d];
    const double slope[3] = {-along[0], along[0] - along[1], along[1]};
    for_each_index<dim>(n, [&](const int *k) {
      double g = 1.0;
      for (int e = 0; e < dim; e++) g *= e == d ? slope[k[e]] : share[places[e]][e][k[e]];
      f(reach.number(k), g);
    });
  }

  /** Calls f(k, low, high) for the boxes of the gradient along d of velocities along c; k: place of
   *  a box along each axis, low and high: numbers of the cells of the faces of its difference. */
  template <class F>
  void visit_differences(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &block, int c, int d,
                         const F &f) const
  {
    Place places[3];
    places_of(c, d, places);
    int base[3] = {0, 0, 0};
    for (int e = 0; e < dim; e++) base[e] = first[places[e]][e] - (e == d && c != d ? 1 : 0);
    const MPMFlowStencil<dim> reach(grid, block, base);
    for_each_index<dim>({2, 2, 2}, [&](const int *k) {
      int above[3] = {k[0], k[1], k[2]};
      above[d]++;
      f(k, reach.number(k), reach.number(above));
    });
  }
  /** Share in box k of the gradient along d of velocities along c. */
  double share_in(int c, int d, const int *k) const
  {
    Place places[3];
    places_of(c, d, places);
    double of_box = 1.0;
    for (int e = 0; e < dim; e++) of_box *= share[places[e]][e][k[e]];
    return of_box;
  }

  /** The same as visit_gradients() for a mean over boxes with other weights, weight(low, high). No
   *  calls where these are all zero. */
  template <class W, class F>
  void visit_gradients_by(const MPM_NS::Grid &grid, const MPM_NS::Grid::Block &block, int c, int d,
                          const W &weight, const F &f) const
  {
    int64_t low[8], high[8];
    double weights[8], sum = 0.0;
    int n = 0;
    visit_differences(grid, block, c, d, [&](const int *k, int64_t at_low, int64_t at_high) {
      low[n] = at_low;
      high[n] = at_high;
      weights[n] = weight(at_low, at_high) * share_in(c, d, k);
      sum += weights[n++];
    });
    for (int j = 0; j < n && sum > 0.0; j++) {
      f(high[j], weights[j] / sum);
      f(low[j], -weights[j] / sum);
    }
  }
};

/** Coordinates of points in spacings from node 0, and their widths in spacings: those of cubes of
 *  their volumes, at most 1. */
template <int dim> struct MPMFlowPlace {
  const MPM_NS::Lattice &lattice;
  double per_cell, volume = 0.0, width = 0.0;

  explicit MPMFlowPlace(const MPM_NS::Lattice &lattice) :
      lattice(lattice), per_cell(1.0 / lattice.cell_volume())
  {
  }
  void find(const double *x, double point_volume, double *t)
  {
    for (int d = 0; d < dim; d++) t[d] = (x[d] - lattice.origin[d]) / lattice.h;
    if (point_volume == volume) return;
    volume = point_volume;
    width = std::min(1.0, std::pow(volume * per_cell, 1.0 / dim));
  }
};

}    // namespace LAMMPS_NS
#endif

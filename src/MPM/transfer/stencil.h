/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_STENCIL_H
#define MPM_TRANSFER_STENCIL_H

// The nodes that a point reaches in plain loops, for transfers that are written that way: the
// statement of what the fast ones do. All names are local to the including file.

#include "transfer/cpdi.h"
#include "transfer/kernels_isa.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace {

/** A node of a tile as seen from one point. */
struct Node {
  int index;         ///< in the tile, in nodes
  double w;          ///< weight
  double grad[3];    ///< gradient of the weight
  double d[3];    ///< position of the node minus that of the point, or of the center of its domain
};

/** Position relative to tile node 0 in cells, minus the shift. Its floor is the cell of a point. */
template <Shape SHAPE>
double tile_position(double x, const TransferStep &step, const int *base, int axis)
{
  using F = FunctionOf<SHAPE>;
  return (x - step.origin[axis]) * (step.inv_h / F::cell) -
      (F::shift + (base[axis] - (base[axis] & (F::cell - 1))) / F::cell);
}

/** The nodes that a point reaches with its functions along the axes. */
template <int DIM, Shape SHAPE> struct PointStencil {
  using F = FunctionOf<SHAPE>;
  static constexpr int N = F::nodes, count = DIM == 3 ? N * N * N : N * N;
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};    ///< lowest and highest tile index of base nodes
  bool good = true;
  Node node[count];

  PointStencil(const PointRows &points, int p, const TransferStep &step, const int *tilebase)
  {
    // in 2d the z axis has a single node of weight one at distance zero
    double w[3][4] = {{1.0}, {1.0}, {1.0}}, dw[3][4] = {}, d[3][4] = {};
    for (int a = 0; a < DIM; a++) {
      double t = tile_position<SHAPE>(points.x[3 * p + a], step, tilebase, a);
      // by rounding in the cell before the first one of the tile
      if (F::cell > 1 && (tilebase[a] & (F::cell - 1)) && t < 1.0) t = 1.0;
      const int cell = static_cast<int>(std::floor(t));
      const double f = SHAPE == LINEAR ? std::max(t - cell, SMALLEST_FRACTION) : t - cell;
      low[a] = high[a] = F::cell * cell - (tilebase[a] & (F::cell - 1));
      if constexpr (F::has_size) {
        F::weights(f, points.size[3 * p + a], w[a]);
        F::gradients(f, points.size[3 * p + a], dw[a]);
      } else {
        F::weights(f, w[a]);
        F::gradients(f, dw[a]);
      }
      for (int i = 0; i < N; i++) {
        dw[a][i] *= step.inv_h;
        d[a][i] = (i - (F::shift + F::cell * f)) * step.h;
      }
    }
    Node *n = node;
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++)
        for (int k = 0; k < (DIM == 3 ? N : 1); k++)
          *n++ = {(low[0] + i) * stride<DIM, SHAPE>(0) + (low[1] + j) * stride<DIM, SHAPE>(1) +
                      low[2] + k,
                  w[0][i] * w[1][j] * w[2][k],
                  {dw[0][i] * w[1][j] * w[2][k], w[0][i] * dw[1][j] * w[2][k],
                   w[0][i] * w[1][j] * dw[2][k]},
                  {d[0][i], d[1][j], d[2][k]}};
  }
};

/** The nodes that the corners of a domain reach with linear functions. */
template <int DIM, Shape SHAPE> struct DomainStencil {
  static constexpr int N = 1 << DIM, count = N * N;
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  bool good;                       ///< size and weights of corners are positive
  double center[3], x[N * DIM];    ///< corners: relative to the center
  double part[count];              ///< weight of a node at its corner
  Node node[count];                ///< those of corner c from N c on

  DomainStencil(const PointRows &points, int p, const TransferStep &step, const int *tilebase)
  {
    double shift[3] = {0.0, 0.0, 0.0}, w[N], g[N * DIM], size;
    if (SHAPE == CPDI) {
      size = PointDomain<DIM>::box(points.domain + DIM * DIM * p, x, g);
      for (double &a : w) a = 1.0 / N;
    } else {
      std::copy(points.domain + N * DIM * p, points.domain + N * DIM * (p + 1), x);
      size = PointDomain<DIM>::free(x, w, g);
      for (int k = 0; k < N * DIM; k++) shift[k % DIM] += w[k / DIM] * x[k];
      for (double &s : shift)    // a domain without size has no weights
        if (!(std::fabs(s) < 1.0e5 * step.h)) s = 0.0;
      for (int k = 0; k < N * DIM; k++) x[k] -= shift[k % DIM];
    }
    good = size > 0.0 && *std::min_element(w, w + N) >= 0.0;
    for (int d = 0; d < 3; d++) center[d] = points.x[3 * p + d] + shift[d];

    for (int c = 0; c < N; c++) {
      int base[3] = {0, 0, 0};
      double f[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < DIM; d++) {
        const double t = tile_position<SHAPE>(center[d] + x[DIM * c + d], step, tilebase, d);
        base[d] = static_cast<int>(std::floor(t));
        f[d] = t - base[d];
        low[d] = c ? std::min(low[d], base[d]) : base[d];
        high[d] = c ? std::max(high[d], base[d]) : base[d];
      }
      for (int n = 0; n < N; n++) {
        Node &a = node[N * c + n] = {};
        double &weight = part[N * c + n] = 1.0;
        for (int d = 0; d < DIM; d++) {
          const int i = n >> d & 1;
          weight *= i ? f[d] : 1.0 - f[d];
          a.d[d] = x[DIM * c + d] + (i - f[d]) * step.h;
          a.index += (base[d] + i) * stride<DIM, SHAPE>(d);
        }
        a.w = w[c] * weight;
        for (int d = 0; d < DIM; d++) a.grad[d] = g[DIM * c + d] * weight;
      }
    }
  }
};

template <int DIM, Shape SHAPE>
using Stencil =
    std::conditional_t<has_domain(SHAPE), DomainStencil<DIM, SHAPE>, PointStencil<DIM, SHAPE>>;

enum TileMove { FLUSH, LOAD, LOAD_MEAN };

/** Adds the nodes of the box to the nodes of the blocks and clears them (FLUSH), loads them from
 *  there (LOAD), or loads the mean of their velocities (LOAD_MEAN). */
template <int DIM, Shape SHAPE, int NREAL, TileMove MOVE>
void move_box(double *tile, double *nodes, const int slot[27], const int box[6])
{
  constexpr int side = block_side(DIM);
  constexpr int order = stencil_order(SHAPE), before = margin<DIM, SHAPE>();
  const int zlow = DIM == 3 ? box[2] : 0, zhigh = DIM == 3 ? box[5] + order : 0;
  for (int i = box[0]; i <= box[3] + order; i++)
    for (int j = box[1]; j <= box[4] + order; j++)
      for (int k = zlow; k <= zhigh; k++) {
        const int n[3] = {i, j, k};
        int block = 0, index = 0, entry = 0;
        for (int a = 0; a < 3; a++) {
          // the first nodes of the tile are the last ones of the block before
          const int shifted = a < DIM ? n[a] + side - before : side;
          block = 3 * block + shifted / side;
          if (a < DIM) index = side * index + shifted % side;
          entry += n[a] * stride<DIM, SHAPE>(a);
        }
        double *mine = tile + NREAL * entry;
        double *node = nodes + (64 * static_cast<std::ptrdiff_t>(slot[block]) + index) * NREAL;
        for (int r = 0; r < (MOVE == LOAD_MEAN ? 4 : NREAL); r++)
          if (MOVE == FLUSH) {
            node[r] += mine[r];
            mine[r] = 0.0;
          } else {
            mine[r] = MOVE == LOAD ? node[r] : 0.5 * (node[r] + node[4 + r]);
          }
      }
}

}    // namespace
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_SCALAR_H
#define MPM_TRANSFER_SCALAR_H

#include "transfer/kernels.h"

#include <cstddef>

namespace MPM_NS {

/** Kinds of slopes of the weights w of a point. */
enum SlopeKind {
  GRADIENT_SLOPES,    ///< grad N, with respect to the place of the point
  DISTANCE_SLOPES,    ///< N (x_i - x_p), the first moment about the point
  /** D^-1 times DISTANCE_SLOPES: moving least squares, for shapes with an inv_moment */
  FIT_SLOPES,
  ABSOLUTE_SLOPES,    ///< |dN/dx| along each axis, for bounds; not with domains
  NO_SLOPES           ///< for values alone
};

/** Number of rows behind those of a batch that transfers may read and write. */
constexpr int SPARE_ROWS = 8;

/** The nodes that a batch of points reaches, made once for any number of transfers. */
struct ScalarStencil {
  int n = 0;
  int place[BATCH];    ///< first node in the tile
  // Weights along each axis, and the factors that replace them in slopes; for the last axis also a
  // row for each point. All entries must be numbers, also behind the last point.

  alignas(64) double w[3][4][BATCH + SPARE_ROWS] = {};
  alignas(64) double slope[3][4][BATCH + SPARE_ROWS] = {};
  alignas(64) double last_w[BATCH][4];
  alignas(64) double last_slope[BATCH][4];

  SlopeKind kind;

  // for the plain loops, which read the points again

  PointRows points;
  TransferStep step;
  int base[3];
};

/** Rows in memory that points give to nodes: slopes, one real for each axis, and values, both to be
 *  multiplied by a factor of the point. Widths: reals from one point to the next. */
struct ScalarSource {
  const double *slopes;
  int slope_width;
  const double *values;
  int value_width;
  const double *factors;
};

/** Transfers of one number between the points of a batch and the tile of their block. Tiles are
 *  those of the other transfers, see kernels.h, except that an entry is one real. Each entry of a
 *  tile must be a number, whether or not a point reaches it.
 *
 *  Points have rows of four reals: one for the slopes along each axis (z is not used in 2d), and
 *  one for the weights. */
struct ScalarKernels {
  /** The stencils of the points [0,n), n <= BATCH. box: as for P2G, or null. */
  void (*prepare)(const PointRows &, const TransferStep &, int n, const int base[3], SlopeKind,
                  ScalarStencil &, int *box);
  /** tile += sum over points of N_ip q[4p+3] + slope_ip . q[4p ... 4p+2]. */
  void (*add)(const ScalarStencil &, const double *q, double *tile);
  /** The same with rows of points in memory, and times their factors. */
  void (*add_times)(const ScalarStencil &, const ScalarSource &, double *tile);
  /** tile += sum over points of N_ip q[p]. */
  void (*add_values)(const ScalarStencil &, const double *q, double *tile);
  /** q[4p+3] = sum over nodes of N_ip tile_i, and q[4p ... 4p+2] = sum over nodes of slope_ip
   *  tile_i. There must be memory for SPARE_ROWS rows behind the last one, which receive arbitrary
   *  values; the same holds for get_values(). */
  void (*get)(const ScalarStencil &, const double *tile, double *q);
  void (*get_values)(const ScalarStencil &, const double *tile, double *q);
  /** As TileIO, with one real for each node. */
  TileIO flush, load;
  /** Divides the sums of n nodes by their weights; zero where the weight is zero. */
  void (*divide)(double *sums, const double *weights, std::size_t n);

  /** The kernels that belong to a table of transfers. Shapes with domains (CPDI) use the plain
   *  loops in all tables. */
  static ScalarKernels select(const MPMKernels &, int dim, Shape);
};

}    // namespace MPM_NS
#endif

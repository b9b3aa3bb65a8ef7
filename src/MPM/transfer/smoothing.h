/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_SMOOTHING_H
#define MPM_TRANSFER_SMOOTHING_H

#include "transfer/kernels.h"

namespace MPM_NS {

/** Linear fits around nodes of a number q of points, for smooth volumes (mpm_smoothing.cpp). For
 *  each node they use sums over points, with weights N V, of products of the functions 1, x, y,
 *  (z), and of these functions times q. x, y, z are from the node to the point, in node spacings.
 *  Tiles are those of transfers, with other records:
 *
 *      2d: x y - 1 | x^2 y^2 xy - | q (x y - 1)
 *      3d: x y z 1 | x^2 y^2 z^2 - | xy yz zx - | q (x y z 1)
 *
 *  In a tile, x, y, z are from its middle to the point, so that the products of a point are the
 *  same for all nodes. */
struct SmoothingKernels {
  /** Adds to the tile, and widens the box. */
  void (*fit)(const PointRows &, const double *q, const TransferStep &, int first, int last,
              const int base[3], double *tile, int box[6]);
  /** Adds the tile to the sums of the nodes of a block (slot: with its neighbors) and empties
   *  it. */
  void (*flush)(double *tile, double *sums, const int slot[27], const int box[6]);
  /** Loads the fits into a tile: [4] coefficients of x, y, z, 1, stored in nodes in place of the
   *  sums with q. */
  void (*load)(double *tile, const double *sums, const int slot[27], const int box[6]);
  /** Sets q of each point to the mean of the fits there with the weights N. */
  void (*evaluate)(const PointRows &, double *q, const TransferStep &, int first, int last,
                   const int base[3], const double *tile);

  /** The kernels that belong to a table of transfers. Null pointers for the plain loops and for
   *  shapes other than B-splines, which have none. */
  static SmoothingKernels select(const MPMKernels &, int dim, Shape);
};

/** Number of reals of a record of sums. */
constexpr int fit_width(int dim)
{
  return dim == 3 ? 16 : 12;
}
/** Place of the sums with q in a record. */
constexpr int fit_place(int dim)
{
  return dim == 3 ? 12 : 8;
}

}    // namespace MPM_NS
#endif

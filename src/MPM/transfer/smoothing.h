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

/** Linear fits around nodes of a number q that points have, of smooth volumes (mpm_smoothing.cpp): for each node, sums
 *  over points of the products of the functions 1, x, y, (z), and of them times q, with weights N V. x, y, z: from the
 *  node to the point, in node spacings. Tiles are those of transfers, with other records:
 *
 *    2d: x y - 1 | x^2 y^2 xy - | q (x y - 1)
 *    3d: x y z 1 | x^2 y^2 z^2 - | xy yz zx - | q (x y z 1)
 *
 *  In a tile, x, y, z are from its middle to the point, so that a point's products are the same for all nodes.
 */
struct SmoothingKernels {
  /** Adds to the tile, and widens the box. */
  void (*fit)(const PointRows &, const double *q, const TransferStep &, int first, int last,
              const int base[3], double *tile, int box[6]);
  /** Adds the tile to the sums of the nodes of a block (slot: with its neighbors) and empties it. */
  void (*flush)(double *tile, double *sums, const int slot[27], const int box[6]);
  /** Brings the fits, [4] coefficients of x, y, z, 1 in the place of the sums with q, to a tile of them. */
  void (*load)(double *tile, const double *sums, const int slot[27], const int box[6]);
  /** The mean of the fits at each point with the weights N, to q. */
  void (*evaluate)(const PointRows &, double *q, const TransferStep &, int first, int last,
                   const int base[3], const double *tile);

  /** Those that go with a table of transfers; null pointers: there are none, for the plain loops and shapes that are
   *  no B-splines. */
  static SmoothingKernels select(const MPMKernels &, int dim, Shape);
};

/** Reals of a record of sums, and the place of those times q in it. */
constexpr int fit_width(int dim)
{
  return dim == 3 ? 16 : 12;
}
constexpr int fit_place(int dim)
{
  return dim == 3 ? 12 : 8;
}

}    // namespace MPM_NS
#endif

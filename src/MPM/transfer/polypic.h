/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_POLYPIC_H
#define MPM_TRANSFER_POLYPIC_H

// Transfers of the modes of a velocity field around a point that are products of two or three
// coordinates: polynomial particle in cell (C. Fu, Q. Guo, T. Gast, C. Jiang, J. Teran, ACM Trans.
// Graph. 36 (2017) 222) with 4 modes in 2d, 8 in 3d. The constant and the linear ones are those of
// APIC.
//
// With weights w of quadratic or cubic B-splines and distances d of nodes from the point, moments along
// each axis are sum w = 1, sum w d = 0, sum w d^2 = D, whatever the position. Products of 1 and d over
// the axes are therefore orthogonal, and the best coefficient of a mode s is sum_i w_i s(d_i) v_i
// over sum_i w_i s(d_i)^2 = D or D^2 or D^3.

#include "transfer/kernels.h"

namespace MPM_NS {

/** Numbers per point: modes xy, in 3d xy, xz, yz, xyz, each a vector of dim components. */
constexpr int poly_size(int dim)
{
  return dim == 3 ? 12 : 2;
}

struct PolyKernels {
  /** Adds the momentum of the modes Q [n][poly_size] to the tile, to which P2G has gone. */
  void (*p2g)(const PointRows &, const double *Q, const TransferStep &, int first, int last,
              const int base[3], double *tile);
  /** Fits the modes to the velocities of the nodes; to be called before G2P moves the points. */
  void (*g2p)(const PointRows &, double *Q, const TransferStep &, int first, int last,
              const int base[3], const double *tile);
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_FAST_H
#define MPM_TRANSFER_KERNELS_FAST_H

// The fast transfers as templates, for the files that the build writes, each of which makes those
// of a shape, once for each instruction set with MPM_ISA = base, v3 or v4 (x86-64 levels). Nothing
// but their tables may be visible outside, see transfer/vector.h.
//
// What a transfer does is written plainly in transfer/kernels_reference.cpp. These headers do the
// same in fewer operations:
//  - A point's contribution to a node is a product over axes, plus one term per axis (affine part
//    or stress gradient). Summed axis by axis this costs two multiply-adds per node and vector,
//    see Scatter. The way back sums z rows first, then y, then x, see Gather.
//  - Vectors hold the four reals of a node (x, y, z, mass), for one or two points side by side.
//    Two points that share the base node are added up before they go to the tile.
//  - Points are prepared (loaded, weighted) in stages of several, then scattered or gathered: the
//    long latency of the preparation of one point hides behind the others.

#include "transfer/kernels_g2p.h"
#include "transfer/kernels_p2g.h"

using namespace MPM_NS;

namespace {

// ---------------------------------------------------------------------- nodes

enum TileMove { FLUSH, LOAD, LOAD_MEAN, PREFETCH };

/** Adds N reals of a tile to nodes and clears them, loads them or, of each eight, the mean of both
 *  fours into the first, or brings the nodes near. Goes on with half the WIDTH for the rest. */
template <int N, TileMove MOVE, int WIDTH = 4>
MPM_INLINE void move_reals(double *tile, double *nodes)
{
  if constexpr (MOVE == PREFETCH) {
    // to the second-level cache: the first has no room for another tile yet
    constexpr int line = 8;
    MPM_UNROLL
    for (int i = 0; i < N; i += line) __builtin_prefetch(nodes + i, 1, 2);
  } else if constexpr (WIDTH == 1) {
    if (MOVE == FLUSH) *nodes += *tile;
    *tile = MOVE == FLUSH ? 0.0 : *nodes;
  } else {
    using V = Vec<WIDTH>;
    MPM_UNROLL
    for (int i = 0; i + WIDTH <= N; i += MOVE == LOAD_MEAN ? 8 : WIDTH) {
      if constexpr (MOVE == LOAD_MEAN) {
        (0.5 * (V::load(nodes + i) + V::load(nodes + i + 4))).store(tile + i);
      } else if constexpr (MOVE == LOAD) {
        V::load(nodes + i).store(tile + i);
      } else {
        (V::load(nodes + i) + V::load(tile + i)).store(nodes + i);
        V{}.store(tile + i);
      }
    }
    constexpr int done = N / WIDTH * WIDTH;
    if constexpr (done < N) move_reals<N - done, MOVE, WIDTH / 2>(tile + done, nodes + done);
  }
}

/** Flush, load or prefetch, a row of nodes along the last axis at a time. A row has one node in the
 *  block before, all of its own block and ORDER + 1 nodes in the block after; with domains it has
 *  all nodes of the three blocks. Each of these parts is moved whole if the box touches it. */
template <int DIM, Shape SHAPE, int NREAL, TileMove MOVE>
void tile_io(double *tile, double *nodes, const int slot[27], const int box[6])
{
  constexpr int ORDER = stencil_order(SHAPE), side = block_side(DIM);
  constexpr int before = margin<DIM, SHAPE>(), after = ORDER + 1;
  constexpr int sx = stride<DIM, SHAPE>(0), sy = stride<DIM, SHAPE>(1);
  const int low = box[DIM - 1], high = box[3 + DIM - 1] + ORDER;

  const int ylow = DIM == 3 ? box[1] : 0;
  const int yhigh = DIM == 3 ? box[4] + ORDER : 0;
  for (int i = box[0]; i <= box[3] + ORDER; i++)
    for (int j = ylow; j <= yhigh; j++) {
      // the first nodes of the tile are the last ones of the block before
      const int x = i + side - before, y = j + side - before;
      double *row = tile + NREAL * (DIM == 3 ? i * sx + j * sy : i * sx);
      const int *block = slot + (DIM == 3 ? 9 * (x / side) + 3 * (y / side) : 9 * (x / side));
      const int index = DIM == 3 ? (x % side * side + y % side) * side : x % side * side;
      // in 3d slots of a row are neighbors, in 2d three apart, the middle one of three in z
      constexpr int next = DIM == 3 ? 1 : 3, middle = DIM == 3 ? 0 : 1;
      const auto record = [&](int which, int node) {
        return nodes + (Index(64) * block[which * next + middle] + node) * NREAL;
      };
      if constexpr (has_domain(SHAPE)) {
        for (int b = low / side; b <= high / side; b++)
          move_reals<side * NREAL, MOVE>(row + NREAL * side * b, record(b, index));
      } else {
        if (low == 0) move_reals<NREAL, MOVE>(row, record(0, index + side - 1));
        if (low <= side) move_reals<side * NREAL, MOVE>(row + NREAL, record(1, index));
        if (high > side)
          move_reals<after * NREAL, MOVE>(row + NREAL * (side + 1), record(2, index));
      }
    }
}

// ---------------------------------------------------------------------- table

/** The same with the functions that move tiles. */
template <class C> TransferKernels table_with_tiles()
{
  TransferKernels k = table_of<C>();
  k.flush = tile_io<C::dim, C::shape, C::nreal, FLUSH>;
  k.load = tile_io<C::dim, C::shape, C::nreal, LOAD>;
  if constexpr (C::nreal == 8) k.load_mean = tile_io<C::dim, C::shape, 8, LOAD_MEAN>;
  k.prefetch = tile_io<C::dim, C::shape, C::nreal, PREFETCH>;
  return k;
}

/** The table of the transfers above. */
template <class C> TransferKernels kernels()
{
  TransferKernels k = table_with_tiles<C>();
  k.p2g = PointsToNodesOf<C, ALL>::template p2g<C::total>;
  k.p2g_momentum = PointsToNodesOf<C, MOMENTUM>::template p2g<false>;
  k.p2g_force = PointsToNodesOf<C, FORCE>::template p2g<C::total>;
  // one name for each of those that are the same
  constexpr bool mls = is_mls(C::shape, C::transfer);
  constexpr Transfer like = C::transfer == APIC && !mls ? TPIC : C::transfer;
  k.g2p = NodesToPoints<C::dim, C::shape, like, C::nreal>::template g2p<C::total>;
  k.g2p_gradient = NodesToPoints < C::dim, C::shape, mls ? APIC : PIC, C::nreal > ::gradient;
  return k;
}

/** Those of a shape. */
template <Shape SHAPE> TransferKernels kernels_of_shape(const KernelChoice &choice)
{
  return choose(choice, [](auto c) {
    if constexpr (c.shape == SHAPE && c.fast())
      return kernels<decltype(c)>();
    else
      return TransferKernels();
  });
}

}    // namespace

/** Defines mpm_kernels_<name>_<isa>(), which makes the kernels of a shape. */
#define MPM_KERNELS_OF_SHAPE(name, SHAPE)                                            \
  TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_##name)(const KernelChoice &choice) \
  {                                                                                  \
    return kernels_of_shape<SHAPE>(choice);                                          \
  }

#endif

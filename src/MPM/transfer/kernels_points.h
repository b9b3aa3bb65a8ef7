/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_POINTS_H
#define MPM_TRANSFER_KERNELS_POINTS_H

// Points as the fast transfers take them, several at once: their rows, places, and weights.

#include "transfer/kernels_isa.h"
#include "transfer/vector.h"

#include <cstddef>
#include <cstdint>

using namespace MPM_NS;

namespace {

// measured: see bench/bench_kernels.cpp
constexpr int POINTS = REGISTER > 4 ? REGISTER / 4 : 1;    ///< points side by side in a vector
constexpr int STAGE = 8;     ///< points prepared before they are transferred
constexpr int AHEAD = 32;    ///< distance of prefetches, in points

using Index = std::ptrdiff_t;

/** Brings STAGE rows from the given one on into the cache, to be written when WRITE is 1. STAGE
 *  rows are a whole number of lines, so that no line is left out between one call and the next. */
template <int WIDTH, int WRITE = 0> MPM_INLINE void prefetch(const double *rows, Index first)
{
  // no pointer arithmetic: the rows ahead may not exist, which prefetches do not mind
  constexpr int line = 64 / sizeof(double);
  static_assert(STAGE % line == 0);
  const std::uintptr_t start =
      reinterpret_cast<std::uintptr_t>(rows) + WIDTH * sizeof(double) * first;
  MPM_UNROLL
  for (int k = 0; k < WIDTH * STAGE / line; k++)
    __builtin_prefetch(reinterpret_cast<const void *>(start + 64 * k), WRITE);
}

/** Four reals for each of L points: the axes x, y, z, and one more. */
template <int L> using Quads = Vec<4 * L>;

/** Four reals of each of L consecutive rows, from a column on. */
template <int L, int WIDTH> MPM_INLINE Quads<L> load_rows(const double *column, Index row)
{
  if constexpr (L == 1 || (WIDTH == 4 && L == 2))
    return Quads<L>::load(column + WIDTH * row);
  else
    return join(load_rows<L / 2, WIDTH>(column, row), load_rows<L / 2, WIDTH>(column, row + L / 2));
}

/** One number for each of L consecutive points times a factor, in all four lanes. */
template <int L> MPM_INLINE Quads<L> load_numbers(const double *number, Index row, double factor)
{
  if constexpr (L == 1)
    return Vec<4>::all(number[row]) * factor;
  else
    return join(Vec<4>::all(number[row]), Vec<4>::all(number[row + 1])) * factor;
}

/** Where points are in a tile; lanes that are no axis stay zero. Positions are in cells, which may
 *  have several nodes, from the last first node of a cell up to tile node 0. */
template <int DIM, Shape SHAPE, int L> struct Frame {
  using Function = FunctionOf<SHAPE>;
  static constexpr int ORDER = Function::order, CELL = Function::cell;
  Quads<L> origin, inv_h, low;
  Quads<L> first;               ///< lowest position in the tile
  int before[3] = {0, 0, 0};    ///< nodes from there to tile node 0

  MPM_INLINE Frame(const TransferStep &step, const int *base)
  {
    alignas(32) double o[4] = {}, i[4] = {}, b[4] = {}, f[4] = {};
    for (int a = 0; a < DIM; a++) {
      o[a] = step.origin[a];
      i[a] = step.inv_h / CELL;
      before[a] = base[a] & (CELL - 1);
      b[a] = Function::shift + (base[a] - before[a]) / CELL;
      f[a] = before[a] ? 1.0 : 0.0;
    }
    origin = repeat<4 * L>(Vec<4>::load(o));
    inv_h = repeat<4 * L>(Vec<4>::load(i));
    low = repeat<4 * L>(Vec<4>::load(b));
    if (CELL > 1) first = repeat<4 * L>(Vec<4>::load(f));
  }

  /** Position in units of h from tile node 0, less the shift: its whole part is the base node. */
  MPM_INLINE Quads<L> position(Quads<L> x) const { return (x - origin) * inv_h - low; }

  /** The same for a point that is known to be in the tile. With cells of several nodes, rounding
   *  may put a point at the low side of its block into the previous cell, whose first node is not
   *  in the tile. */
  MPM_INLINE Quads<L> position_inside(Quads<L> x) const
  {
    if constexpr (CELL == 1)
      return position(x);
    else
      return max(position(x), first);
  }

  /** Base node of a cell along an axis. */
  MPM_INLINE int node(int axis, int cell) const { return CELL * cell - before[axis]; }

  /** Distance of points from their base nodes in node spacings. */
  static MPM_INLINE Quads<L> distance(Quads<L> fraction)
  {
    static_assert(CELL == 1 || Function::shift == 0.0);
    if constexpr (CELL == 1)
      return fraction + Function::shift;
    else
      return double(CELL) * fraction;
  }

  /** Base nodes' places in the tile, in nodes; returns the fractions. */
  MPM_INLINE Quads<L> locate(Quads<L> t, int *place) const
  {
    constexpr int sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
    int index[4 * L];
    const Quads<L> whole = truncate(t, index);
    MPM_UNROLL
    for (int l = 0; l < L; l++)
      place[l] = node(0, index[4 * l]) * sx + node(1, index[4 * l + 1]) * sy +
          (DIM == 3 ? node(2, index[4 * l + 2]) : 0);
    if constexpr (ORDER == 1)
      return max(t - whole, Quads<L>::all(SMALLEST_FRACTION));
    else
      return t - whole;
  }
};

/** Weights of L points along the axes, in memory: [node][point][axis]. */
template <int ORDER, int L> struct AxisWeights {
  static constexpr int S = ORDER + 1;
  alignas(32) double w[S][4 * L];

  MPM_INLINE void set(const Quads<L> *weight)
  {
    MPM_UNROLL
    for (int k = 0; k < S; k++) weight[k].store(w[k]);
  }

  /** Weights along axis A in all lanes of the point, WIDTH lanes for each point. */
  template <int A, int WIDTH> MPM_INLINE void get(Vec<WIDTH * L> *weight) const
  {
    MPM_UNROLL
    for (int k = 0; k < S; k++) {
      if constexpr (L == 1)
        weight[k] = Vec<WIDTH>::all(w[k][A]);
      else if constexpr (WIDTH == 4)
        weight[k] = broadcast<A>(Quads<L>::load(w[k]));
      else
        weight[k] = join(Vec<WIDTH>::all(w[k][A]), Vec<WIDTH>::all(w[k][4 + A]));
    }
  }
};

/** Copies reals; not inlined, as it is for a few points only. */
__attribute__((noinline)) void copy_reals(double *to, const double *from, Index n)
{
  for (Index i = 0; i < n; i++) to[i] = from[i];
}

/** Copies of the last points of a range, with room behind the rows, because vectors of four reals
 *  read and write past a row of three or nine. Points are added up to a whole vector; they are
 *  copies of the first one, with some rows set to zero. */
struct LastPoints {
  static constexpr int ROOM = POINTS + 1;
  double x[3 * ROOM], v[3 * ROOM], f[3 * ROOM], C[9 * ROOM], tau[6 * ROOM], vol0[ROOM], mass[ROOM],
      xnew[3 * ROOM], L[9 * ROOM], from[3 * ROOM], P[9 * ROOM], size[3 * ROOM];
  PointRows rows{x, v, f, C, tau, vol0, mass, xnew, nullptr, 0, from, P, size};
  Index first, n;    ///< the points

  LastPoints(Index first, Index last) : first(first), n(last - first) {}

  void load(double *to, const double *all, int width) const
  {
    copy_reals(to, all + width * first, width * n);
    if (n < POINTS) copy_reals(to + width, to, width);
  }
  void store(const double *mine, double *all, int width) const
  {
    copy_reals(all + width * first, mine, width * n);
  }
};

/** Prefetches the rows that P2G of PARTS reads, except the positions of points. */
template <int DIM, int PARTS, bool AFFINE>
MPM_INLINE void prefetch_momentum_and_force(const PointRows &points, Index ahead, bool total)
{
  if (PARTS & MOMENTUM) {
    prefetch<3>(points.v, ahead);
    prefetch<1>(points.mass, ahead);
    if (AFFINE) prefetch<DIM * DIM>(points.C, ahead);
  }
  if (PARTS & FORCE) {
    prefetch<3>(points.f, ahead);
    if (!total) prefetch<6>(points.tau, ahead);    // P has just been made
    prefetch<1>(points.vol0, ahead);
  }
}

/** Weights of the nodes for the fractions of L points and, if asked for, their gradients. */
template <Shape SHAPE, bool GRADIENT, int L, class Weights>
MPM_INLINE void axis_weights(const PointRows &points, Index p, Quads<L> fraction, Weights &weights,
                             Weights &gradients)
{
  using Function = FunctionOf<SHAPE>;
  Quads<L> w[Function::nodes];
  if constexpr (Function::has_size) {
    const Quads<L> size = load_rows<L, 3>(points.size, p);
    Function::weights(fraction, size, w);
    weights.set(w);
    if constexpr (GRADIENT) {
      Function::gradients(fraction, size, w);
      gradients.set(w);
    }
  } else {
    Function::weights(fraction, w);
    weights.set(w);
    if constexpr (GRADIENT && Function::order > 1) {    // linear ones are known
      Function::gradients(fraction, w);
      gradients.set(w);
    }
  }
}

}    // namespace

#endif

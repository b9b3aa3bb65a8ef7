/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_FAST_H
#define MPM_TRANSFER_KERNELS_FAST_H

// The fast transfers as templates, for the files transfer/*_isa.cpp, each of which makes those of
// some shapes and transfers, once for each instruction set with MPM_ISA = base, v3 or v4 (x86-64
// levels). Nothing but their tables may be visible outside, see transfer/vector.h.
//
// What a transfer does is written plainly in transfer/kernels_reference.cpp; this file does the same
// in fewer operations:
//  - A point's contribution to a node is a product over axes, plus one term per axis (affine part
//    or stress gradient). Summed axis by axis this costs two multiply-adds per node and vector,
//    see Scatter. The way back sums z rows first, then y, then x, see Gather.
//  - Vectors hold the four reals of a node (x, y, z, mass), for one or two points side by side.
//    Two points that share the base node are added up before they go to the tile.
//  - In mixed precision (MPM_MIXED_PRECISION) tiles and arithmetic are floats, positions and the
//    state of points doubles, see MixedHeader for what keeps small differences. Points to nodes
//    has the nodes of a row side by side, see RowScatter.
//  - Points are prepared (loaded, weighted) in stages of several, then scattered or gathered: the
//    long latency of the preparation of one point hides behind the others.

#include "transfer/kernels.h"

#include "transfer/shape.h"
#include "transfer/vector.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

using namespace MPM_NS;

namespace {

// measured: see bench/bench_kernels.cpp
constexpr int POINTS = REGISTER > 4 ? REGISTER / 4 : 1;    ///< points side by side in a vector
constexpr bool MIXED = sizeof(Real) < sizeof(double);
constexpr int STAGE = MIXED ? 16 : 8;    ///< points prepared before they are transferred
constexpr int AHEAD = 32;                ///< distance of prefetches, in points

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
template <int L> using WideQuads = Vec<4 * L, double>;

/** Four reals of each of L consecutive rows, from a column on. */
template <int L, int WIDTH> MPM_INLINE WideQuads<L> load_wide(const double *column, Index row)
{
  if constexpr (L == 1 || (WIDTH == 4 && L == 2))
    return WideQuads<L>::load(column + WIDTH * row);
  else
    return join(load_wide<L / 2, WIDTH>(column, row), load_wide<L / 2, WIDTH>(column, row + L / 2));
}
template <int L, int WIDTH> MPM_INLINE Quads<L> load_rows(const double *column, Index row)
{
  return convert<Real>(load_wide<L, WIDTH>(column, row));
}

/** One number for each of L consecutive points times a factor, in all four lanes. Products with
 *  factors that may be far from one are taken in double precision. */
template <int L> MPM_INLINE Quads<L> load_numbers(const double *number, Index row, double factor)
{
  if constexpr (!MIXED) {
    if constexpr (L == 1)
      return Vec<4>::all(number[row]) * factor;
    else
      return join(Vec<4>::all(number[row]), Vec<4>::all(number[row + 1])) * factor;
  } else if constexpr (L == 4) {
    return spread<16>(convert<Real>(WideQuads<1>::load(number + row) * factor));
  } else {
    const Vec<4> first = Vec<4>::all(static_cast<Real>(number[row] * factor));
    if constexpr (L == 1)
      return first;
    else
      return join(first, Vec<4>::all(static_cast<Real>(number[row + 1] * factor)));
  }
}

/** Products of weights over the axes are too large by the inverse of this, see SixfoldCubic. Double
 *  precision makes good for it, on the way into a tile with the unit of masses. */
template <int DIM, int ORDER> constexpr double weight_scale()
{
  if (!MIXED || ORDER < 3) return 1.0;
  constexpr double one = 1.0 / SixfoldCubic::multiple;
  return DIM == 3 ? one * one * one : one * one;
}

/** What stands before the entries of a tile in mixed precision: numbers of 4 bytes need a
 *  reference. Velocities, and with them momenta, are relative to a velocity v from within the tile,
 *  so that what all points have in common is kept in double precision, and masses relative to one
 *  of them. FLIP gathers changes of velocities, which on load are differences of doubles. A tile
 *  that is zero has no reference: the first transfer to it takes one. */
struct MixedHeader {
  double v[4];    ///< zero where there is no axis
  double mass;    ///< of a point, times weight_scale()
  double room[3];

  template <int DIM, int ORDER>
  static MPM_INLINE void first(double *tile, const PointRows &points, Index p)
  {
    MixedHeader *const header = reinterpret_cast<MixedHeader *>(tile);
    if (header->mass != 0.0) return;
    header->mass = weight_scale<DIM, ORDER>() * points.mass[p];
    for (int a = 0; a < DIM; a++) header->v[a] = points.v[3 * p + a];
  }
};

/** Entries of a tile. */
MPM_INLINE Real *entries(double *tile)
{
  if constexpr (MIXED)
    return reinterpret_cast<Real *>(tile + sizeof(MixedHeader) / sizeof(double));
  else
    return reinterpret_cast<Real *>(tile);
}
MPM_INLINE const Real *entries(const double *tile)
{
  return entries(const_cast<double *>(tile));
}

/** Reals from one tile entry to the next, and from the first four reals of an entry to the others:
 *  in mixed precision these are in a second tile behind the first. */
constexpr int entry_stride(int nreal)
{
  return MIXED ? 4 : nreal;
}
constexpr int second_half(int dim, int order)
{
  return MIXED ? 4 * tile_nodes(dim, order) : 4;
}

/** Where points are in a tile; lanes that are no axis stay zero. BERNSTEIN: positions are in cells of
 *  two node spacings from the last even node up to tile node 0. */
template <int DIM, Shape SHAPE, int L> struct Frame {
  static constexpr int ORDER = stencil_order(SHAPE);
  static constexpr int STEP = SHAPE == BERNSTEIN ? 2 : 1;    ///< node spacings of a cell
  WideQuads<L> origin, inv_h, low;
  int before[3] = {0, 0, 0};    ///< nodes from there to tile node 0

  MPM_INLINE Frame(const TransferStep &step, const int *base)
  {
    alignas(64) double o[4 * L] = {}, i[4 * L] = {}, b[4 * L] = {};
    for (int l = 0; l < L; l++)
      for (int a = 0; a < DIM; a++) {
        o[4 * l + a] = step.origin[a];
        i[4 * l + a] = step.inv_h / STEP;
        if (SHAPE == BERNSTEIN) before[a] = base[a] & 1;
        b[4 * l + a] = SHAPE == BERNSTEIN ? (base[a] - before[a]) / 2
                                          : BSpline<ORDER>::shift + base[a];
      }
    origin = WideQuads<L>::load(o);
    inv_h = WideQuads<L>::load(i);
    low = WideQuads<L>::load(b);
  }

  /** Position in units of h from tile node 0, less the shift: its whole part is the base node. */
  MPM_INLINE WideQuads<L> position(WideQuads<L> x) const { return (x - origin) * inv_h - low; }

  /** Base node of a cell along an axis. */
  MPM_INLINE int node(int axis, int cell) const { return STEP * cell - before[axis]; }

  /** Distance of points from their base nodes in node spacings. */
  static MPM_INLINE Quads<L> distance(Quads<L> fraction)
  {
    if constexpr (SHAPE == BERNSTEIN)
      return 2.0 * fraction;
    else
      return fraction + BSpline<ORDER>::shift;
  }

  /** Base nodes' places in the tile, in nodes; returns the fractions. Floats are rounded to multiples
   *  of 2^-23, for which the distances from all nodes are exact. */
  MPM_INLINE Quads<L> locate(WideQuads<L> t, int *place) const
  {
    constexpr int sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
    int index[4 * L];
    const WideQuads<L> whole = truncate(t, index);
    MPM_UNROLL
    for (int l = 0; l < L; l++)
      place[l] = node(0, index[4 * l]) * sx + node(1, index[4 * l + 1]) * sy +
          (DIM == 3 ? node(2, index[4 * l + 2]) : 0);
    if constexpr (ORDER == 1)
      return max(convert<Real>(t - whole), Quads<L>::all(SMALLEST_FRACTION));
    else if constexpr (MIXED)
      return (convert<Real>(t - whole) + 1.0) - 1.0;
    else
      return convert<Real>(t - whole);
  }
};

/** Weights of L points along the axes, in memory: [node][point][axis]. */
template <int ORDER, int L> struct AxisWeights {
  static constexpr int S = ORDER + 1;
  static constexpr bool linear_gradients = false;    ///< gradients of linear functions are known
  alignas(32) Real w[S][4 * L];

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

/** Copies of the last points of a range, with room behind the rows: vectors of four reals read and
 *  write past a row of three or nine. */
struct LastPoints {
  static constexpr int ROOM = POINTS + 1;
  double x[3 * ROOM], v[3 * ROOM], f[3 * ROOM], C[9 * ROOM], tau[6 * ROOM], vol0[ROOM], mass[ROOM],
      xnew[3 * ROOM], L[9 * ROOM], from[3 * ROOM], P[9 * ROOM], size[3 * ROOM];
  PointRows rows{x, v, f, C, tau, vol0, mass, xnew, nullptr, 0, from, P, size};

  template <int WIDTH>
  static MPM_INLINE void load(double *to, const double *from, Index first, Index last)
  {
    for (Index i = 0; i < WIDTH * (last - first); i++) to[i] = from[WIDTH * first + i];
  }
  template <int WIDTH>
  static MPM_INLINE void store(const double *from, double *to, Index first, Index last)
  {
    for (Index i = 0; i < WIDTH * (last - first); i++) to[WIDTH * first + i] = from[i];
  }
};

/** Weights of the nodes for the fractions of L points and, if asked for, their gradients. */
template <Shape SHAPE, bool GRADIENT, int L, class Weights>
MPM_INLINE void axis_weights(const PointRows &points, Index p, Quads<L> fraction, Weights &weights,
                             Weights &gradients)
{
  constexpr int ORDER = stencil_order(SHAPE);
  Quads<L> w[ORDER + 1];
  if constexpr (SHAPE == GIMP) {
    const Quads<L> size = load_rows<L, 3>(points.size, p);
    Gimp::weights(fraction, size, w);
    weights.set(w);
    if constexpr (GRADIENT) {
      Gimp::gradients(fraction, size, w);
      gradients.set(w);
    }
  } else if constexpr (SHAPE == BERNSTEIN) {
    Bernstein::weights(fraction, w);
    weights.set(w);
    if constexpr (GRADIENT) {
      Bernstein::gradients(fraction, w);
      gradients.set(w);
    }
  } else {
    using Spline = std::conditional_t<MIXED && ORDER == 3, SixfoldCubic, BSpline<ORDER>>;
    Spline::weights(fraction, w);
    weights.set(w);
    if constexpr (GRADIENT && (ORDER > 1 || Weights::linear_gradients)) {
      Spline::gradients(fraction, w);
      gradients.set(w);
    }
  }
}

// ---------------------------------------------------------------------- points to nodes

/** Contributions of L points to their nodes, WIDTH reals per node:
 *
 *   node(i,j,k) = wx_i wy_j wz_k (q + i Ax + j Ay + k Az)
 *                 + gx_i wy_j wz_k Sx + wx_i gy_j wz_k Sy + wx_i wy_j gz_k Sz
 *
 *  with weights w, gradients g and node numbers i, j, k from the base node; A is there if AFFINE,
 *  S if GRADIENT. With K_a[n] = n w_a[n] A_a + g_a[n] S_a along each axis a this is
 *
 *   X_i = wx_i q + Kx_i,   XY_ij = wy_j X_i + wx_i Ky_j,   node = wz_k XY_ij + wx_i wy_j Kz_k.
 */
template <int DIM, int ORDER, int WIDTH, int L, bool AFFINE, bool GRADIENT> struct Scatter {
  using V = Vec<WIDTH * L>;
  using Weights = AxisWeights<ORDER, L>;
  static constexpr int N = ORDER + 1;

  V q;
  V A[DIM];
  V S[DIM];

  /** Node n along an axis has a term K. */
  static constexpr bool has_K(int n) { return GRADIENT || (AFFINE && n > 0); }

  /** Weights along axis AXIS, and K. */
  template <int AXIS>
  MPM_INLINE void along(const Weights &weights, const Weights &gradients, V *w, V *K) const
  {
    weights.template get<AXIS, WIDTH>(w);
    V g[N];
    if constexpr (GRADIENT && ORDER > 1) gradients.template get<AXIS, WIDTH>(g);
    MPM_UNROLL
    for (int n = 0; n < N; n++) {
      if constexpr (GRADIENT && ORDER == 1)
        K[n] = n ? S[AXIS] : -S[AXIS];
      else if constexpr (GRADIENT)
        K[n] = g[n] * S[AXIS];
      if constexpr (AFFINE && GRADIENT)
        if (n) K[n] += double(n) * A[AXIS] * w[n];
      if constexpr (AFFINE && !GRADIENT)
        if (n) K[n] = double(n) * A[AXIS] * w[n];
    }
  }

  /** Adds a row of nodes along the last axis, w_n row + factor K_n; SAME: points share nodes. */
  template <bool SAME, int NREAL>
  static MPM_INLINE void add_row(Real *const *base, Index offset, V row, V factor, const V *w,
                                 const V *K)
  {
    MPM_UNROLL
    for (int n = 0; n < N; n++) {
      Real *node = base[0] + offset + NREAL * n;
      if constexpr (L == 1) {
        V sum = V::load(node) + w[n] * row;
        if (has_K(n)) sum += factor * K[n];
        sum.store(node);
      } else {
        V sum = w[n] * row;
        if (has_K(n)) sum += factor * K[n];
        if constexpr (SAME) {
          (Vec<WIDTH>::load(node) + (half<0>(sum) + half<1>(sum))).store(node);
        } else {
          (Vec<WIDTH>::load(node) + half<0>(sum)).store(node);
          node = base[1] + offset + NREAL * n;
          (Vec<WIDTH>::load(node) + half<1>(sum)).store(node);
        }
      }
    }
  }

  /** Adds to all nodes; base: the record of each point's base node. */
  template <bool SAME, int NREAL>
  MPM_INLINE void add(const Weights &weights, const Weights &gradients, Real *const *base) const
  {
    constexpr int sx = NREAL * tile_stride_x(DIM, ORDER), sy = NREAL * tile_stride_y(DIM, ORDER);
    V wx[N], wy[N], Kx[N], Ky[N];
    along<0>(weights, gradients, wx, Kx);
    along<1>(weights, gradients, wy, Ky);
    V wz[N], Kz[N];
    if constexpr (DIM == 3) along<2>(weights, gradients, wz, Kz);

    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V X = wx[i] * q;
      if (has_K(i)) X += Kx[i];
      if constexpr (DIM == 2) {
        add_row<SAME, NREAL>(base, sx * i, X, wx[i], wy, Ky);
      } else {
        MPM_UNROLL
        for (int j = 0; j < N; j++) {
          V XY = wy[j] * X;
          if (has_K(j)) XY += wx[i] * Ky[j];
          add_row<SAME, NREAL>(base, sx * i + sy * j, XY, wx[i] * wy[j], wz, Kz);
        }
      }
    }
  }
};

/** L times four reals in memory. */
template <int L> struct Stored {
  alignas(64) Real real[4 * L];
  MPM_INLINE void operator=(Quads<L> a) { a.store(real); }
};

/** Weights of L points along the axes, in memory: [axis][point][node], zero for nodes that a point
 *  does not reach. */
template <int ORDER, int L> struct AxisRows {
  static constexpr bool linear_gradients = true;
  alignas(64) Real row[3][4 * L];

  template <int A> MPM_INLINE void set_axis(const Quads<L> *weight)
  {
    const Quads<L> low = shuffle<A, A, A + 4, A + 4>(weight[0], weight[1]);
    Quads<L> high = {};
    if constexpr (ORDER == 2) high = shuffle<A, A, 4, 4>(weight[2], high);
    if constexpr (ORDER == 3) high = shuffle<A, A, A + 4, A + 4>(weight[2], weight[3]);
    shuffle<0, 2, 4, 6>(low, high).store(row[A]);
  }
  MPM_INLINE void set(const Quads<L> *weight)
  {
    set_axis<0>(weight);
    set_axis<1>(weight);
    set_axis<2>(weight);
  }
};

/** Products of weights and gradients along x and y for each of L points, [4 i + j]. */
template <int L> struct PlaneProducts {
  alignas(64) Real ww[L][16], gw[L][16], wg[L][16];

  template <int l, bool GRADIENT, class Rows>
  MPM_INLINE void set_point(const Rows &w, const Rows &g)
  {
    const Vec<16> x = rows_x<l>(w), y = rows_y<l>(w);
    (x * y).store(ww[l]);
    if constexpr (GRADIENT) {
      (rows_x<l>(g) * y).store(gw[l]);
      (x * rows_y<l>(g)).store(wg[l]);
    }
  }
  template <bool GRADIENT, class Rows> MPM_INLINE void set(const Rows &w, const Rows &g)
  {
    set_point<0, GRADIENT>(w, g);
    if constexpr (L > 1) set_point<1, GRADIENT>(w, g);
    if constexpr (L > 2) {
      set_point<2, GRADIENT>(w, g);
      set_point<3, GRADIENT>(w, g);
    }
  }

 private:
  template <int l, class Rows> static MPM_INLINE Vec<16> rows_x(const Rows &w)
  {
    if constexpr (L == 4)
      return spread_group<l>(Vec<16>::load(w.row[0]));
    else
      return spread<16>(Vec<4>::load(w.row[0] + 4 * l));
  }
  template <int l, class Rows> static MPM_INLINE Vec<16> rows_y(const Rows &w)
  {
    if constexpr (L == 4)
      return repeat_group<l>(Vec<16>::load(w.row[1]));
    else
      return repeat<16>(Vec<4>::load(w.row[1] + 4 * l));
  }
};

/** What Scatter does, with the nodes of a row along the last axis side by side in a vector, four
 *  reals for each, and one point after the other. With the weights z and gradients z' along the
 *  last axis
 *
 *    row(i,j) = wx_i wy_j [z (q + k Az) + z' Sz + i z Ax + j z Ay] + gx_i wy_j z Sx + wx_i gy_j z Sy,
 *
 *  where the bracket takes one addition from one row to the next. Points with the same base node are
 *  summed in registers, so that the tile is read and written once for all of them. */
template <int DIM, int ORDER, bool AFFINE, bool GRADIENT, int L> struct RowScatter {
  static constexpr int N = ORDER + 1, LAST = DIM - 1;
  static constexpr int LANES = ORDER == 1 ? 8 : 16;
  static constexpr int ROWS = DIM == 3 ? N * N : N;
  using Row = Vec<LANES>;
  using Weights = AxisRows<ORDER, L>;

  Stored<L> q, A[DIM], S[DIM];

  static MPM_INLINE Row fours(const Stored<L> &from, int l)
  {
    return repeat<LANES>(Vec<4>::load(from.real + 4 * l));
  }

  /** Adds what point l gives to the sums. */
  MPM_INLINE void add(const Weights &w, const Weights &g, const PlaneProducts<L> &products, int l,
                      Row *sum) const
  {
    const Row z = spread<LANES>(Vec<4>::load(w.row[LAST] + 4 * l));
    Row B = z * fours(q, l), Ux, Uy, Tx, Ty;
    if constexpr (AFFINE) {
      constexpr Real number[4] = {0, 1, 2, 3};
      B += (z * spread<LANES>(Vec<4>::load(number))) * fours(A[LAST], l);
      Ux = z * fours(A[0], l);
      if constexpr (DIM == 3) Uy = z * fours(A[1], l);
    }
    if constexpr (GRADIENT) {
      B += spread<LANES>(Vec<4>::load(g.row[LAST] + 4 * l)) * fours(S[LAST], l);
      Tx = z * fours(S[0], l);
      if constexpr (DIM == 3) Ty = z * fours(S[1], l);
    }
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      if (AFFINE && i) B += Ux;
      if constexpr (DIM == 2) {
        sum[i] += Row::all(w.row[0][4 * l + i]) * B;
        if constexpr (GRADIENT) sum[i] += Row::all(g.row[0][4 * l + i]) * Tx;
      } else {
        Row Bj = B;
        MPM_UNROLL
        for (int j = 0; j < N; j++) {
          if (AFFINE && j) Bj += Uy;
          sum[N * i + j] += Row::all(products.ww[l][4 * i + j]) * Bj;
          if constexpr (GRADIENT) {
            sum[N * i + j] += Row::all(products.gw[l][4 * i + j]) * Tx;
            sum[N * i + j] += Row::all(products.wg[l][4 * i + j]) * Ty;
          }
        }
      }
    }
  }

  static MPM_INLINE void clear(Row *sum)
  {
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < ROWS / N; j++) sum[ROWS / N * i + j] = Row{};
    }
  }

  /** Adds the sums to the tile and clears them. */
  static MPM_INLINE void flush(Row *sum, Real *base)
  {
    constexpr int sx = 4 * tile_stride_x(DIM, ORDER), sy = 4 * tile_stride_y(DIM, ORDER);
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < ROWS / N; j++) {
        Real *const node = base + sx * i + (DIM == 3 ? sy * j : 0);
        (Row::load(node) + sum[ROWS / N * i + j]).store(node);
      }
    }
    clear(sum);
  }
};

enum Parts { MOMENTUM = 1, FORCE = 2, ALL = 3 };

/** P2G of what PARTS says; AFFINE: uses C; MLS: stress as an affine term; TOTAL: first
 *  Piola-Kirchhoff instead of Kirchhoff stress. */
template <int DIM, Shape SHAPE, bool AFFINE, bool MLS, int NREAL, int PARTS, bool TOTAL>
struct PointsToNodes {
  static constexpr int ORDER = stencil_order(SHAPE);
  static constexpr bool momentum = PARTS & MOMENTUM;
  static constexpr bool force = PARTS & FORCE;
  static constexpr bool gradient = force && !MLS;    // stress with gradients

  // A record of 8 reals has momentum and force apart. One long vector can hold both; else, and for
  // linear functions where it is faster, the force is scattered after the momentum.
  static constexpr bool both = NREAL == 8 && PARTS == ALL;
  static constexpr bool wide = !MIXED && both && REGISTER == 8 && ORDER > 1;
  static constexpr int N = ORDER + 1;

  /** L points ready to be scattered. */
  static constexpr bool affine = (AFFINE && momentum) || (MLS && force && !(both && !wide));
  static constexpr bool sloped = gradient && (wide || !both);
  template <int L> struct Prepared {
    Scatter<DIM, ORDER, wide ? 8 : 4, L, affine, sloped> main;
    Scatter<DIM, ORDER, 4, L, MLS, !MLS> apart;    // the force, if it is not in main
    AxisWeights<ORDER, L> weights, gradients;
    int place[L];
  };
  template <int L> struct PreparedRows {
    using Main = RowScatter<DIM, ORDER, affine, sloped, L>;
    using Apart = RowScatter<DIM, ORDER, MLS, !MLS, L>;
    Main main;
    Apart apart;
    AxisRows<ORDER, L> weights, gradients;
    PlaneProducts<L> products;
    int place[L];
  };

  /** What momenta and masses in the tile are relative to, see MixedHeader. */
  template <int L> struct Reference {
    WideQuads<L> v;
    double inv_mass = 1.0;

    Reference(const double *tile)
    {
      if constexpr (MIXED) {
        const auto *header = reinterpret_cast<const MixedHeader *>(tile);
        v = repeat<4 * L>(WideQuads<1>::load(header->v));
        inv_mass = weight_scale<DIM, ORDER>() / header->mass;
      }
    }
  };

  /** Columns of a full matrix; lanes that are no axis are arbitrary. */
  template <int L>
  static MPM_INLINE void matrix_columns(const double *matrix, Index p, Quads<L> *column)
  {
    if constexpr (DIM == 2) {
      column[0] = load_rows<L, 4>(matrix, p);
      column[1] = shuffle<2, 3, 2, 3>(column[0], column[0]);
    } else {
      MPM_UNROLL
      for (int a = 0; a < 3; a++) column[a] = load_rows<L, 9>(matrix + 3 * a, p);
    }
  }

  /** Columns of the stress tensor; lanes that are no axis are arbitrary. */
  template <int L>
  static MPM_INLINE void stress_columns(const double *tau, Index p, Quads<L> *column)
  {
    const Quads<L> a = load_rows<L, 6>(tau, p);    // xx yy zz xy
    if constexpr (DIM == 2) {
      column[0] = shuffle<0, 3, 3, 3>(a, a);
      column[1] = shuffle<3, 1, 1, 1>(a, a);
    } else {
      const Quads<L> b = load_rows<L, 6>(tau + 2, p);                   // zz xy xz yz
      column[0] = shuffle<0, 5, 6, 7>(a, b);                            // xx xy xz
      column[1] = shuffle<4, 1, 6, 7>(a, shuffle<1, 1, 3, 3>(b, b));    // xy yy yz
      column[2] = shuffle<2, 3, 0, 0>(b, b);                            // xz yz zz
    }
  }

  /** Momentum and force of each point side by side. */
  template <int N4> static MPM_INLINE Vec<2 * N4> side_by_side(Vec<N4> m, Vec<N4> f)
  {
    if constexpr (N4 == 4)
      return join(m, f);
    else
      return join(join(half<0>(m), half<0>(f)), join(half<1>(m), half<1>(f)));
  }

  /** Momentum and mass: value at the point and affine matrix per node spacing. */
  template <int L>
  static MPM_INLINE void momentum_terms(const PointRows &points, Index p, double h,
                                        const Reference<L> &reference, Quads<L> &q, Quads<L> *A)
  {
    const Quads<L> mass = load_numbers<L>(points.mass, p, reference.inv_mass);
    WideQuads<L> v = load_wide<L, 3>(points.v, p);
    if constexpr (MIXED) v -= reference.v;
    q = blend<DIM>(convert<Real>(v), repeat<4 * L>(0.0, 0.0, 0.0, 1.0)) * mass;
    if constexpr (AFFINE) {
      if constexpr (DIM == 2) {
        const Quads<L> C = (h * mass) * load_rows<L, 4>(points.C, p);
        A[0] = C;
        A[1] = shuffle<2, 3, 2, 3>(C, C);
      } else {
        MPM_UNROLL
        for (int a = 0; a < 3; a++) A[a] = (h * mass) * load_rows<L, 9>(points.C + 3 * a, p);
      }
    }
  }

  /** Force times scale: external, and columns of -stress that an affine or gradient term takes. */
  template <int L>
  static MPM_INLINE void force_terms(const PointRows &points, Index p, const TransferStep &step,
                                     double scale, Quads<L> &q, Quads<L> *A)
  {
    q = (scale * step.force_scale) * blend<DIM>(load_rows<L, 3>(points.f, p), Quads<L>{});
    const double factor =
        -scale * step.stress_scale * step.inv_h * (MLS ? BSpline<ORDER>::inv_moment : 1.0);
    const Quads<L> volume = load_numbers<L>(points.vol0, p, factor);
    if constexpr (TOTAL)
      matrix_columns<L>(points.P, p, A);
    else
      stress_columns<L>(points.tau, p, A);
    MPM_UNROLL
    for (int a = 0; a < DIM; a++) A[a] = volume * A[a];
  }

  /** Clears the lanes that are no axis. */
  template <int N4> static MPM_INLINE void clear_lanes(Vec<N4> *A)
  {
    MPM_UNROLL
    for (int a = 0; a < DIM; a++) A[a] = blend<DIM>(A[a], Vec<N4>{});
  }

  /** Moves the origin of an affine field from the point to its base node. */
  template <int N4>
  static MPM_INLINE void to_base_node(Vec<N4> &q, const Vec<N4> *A, Vec<N4> fraction)
  {
    const Vec<N4> distance = Frame<DIM, SHAPE, N4 / 4>::distance(fraction);
    q -= broadcast<0>(distance) * A[0] + broadcast<1>(distance) * A[1];
    if constexpr (DIM == 3) q -= broadcast<2>(distance) * A[2];
  }

  /** Loads L points and computes what scatter needs; notes their extent. */
  template <int L, class Out>
  static MPM_INLINE void prepare(const PointRows &points, Index p, const TransferStep &step,
                                 const Frame<DIM, SHAPE, L> &frame, const Reference<L> &reference,
                                 Out &out, WideQuads<L> &lowest, WideQuads<L> &highest)
  {
    using P = Quads<L>;

    const WideQuads<L> t = frame.position(load_wide<L, 3>(points.x, p));
    lowest = min(lowest, t);
    highest = max(highest, t);
    const P fraction = frame.locate(t, out.place);
    axis_weights<SHAPE, gradient, L>(points, p, fraction, out.weights, out.gradients);
    if constexpr (MIXED && DIM == 3)
      out.products.template set<gradient>(out.weights, out.gradients);

    // Am is an affine term, Af an affine or a gradient term
    P qm, qf, Am[DIM], Af[DIM];
    if constexpr (momentum) momentum_terms<L>(points, p, step.h, reference, qm, Am);
    if constexpr (force)
      force_terms<L>(points, p, step, (NREAL == 4 ? step.dt : 1.0) * reference.inv_mass, qf, Af);

    if constexpr (both) {
      if constexpr (AFFINE) {
        clear_lanes(Am);
        to_base_node(qm, Am, fraction);
      }
      clear_lanes(Af);
      if constexpr (MLS) to_base_node(qf, Af, fraction);
      if constexpr (wide) {
        out.main.q = side_by_side(qm, qf);
        MPM_UNROLL
        for (int a = 0; a < DIM; a++) {
          if constexpr (AFFINE) out.main.A[a] = side_by_side(Am[a], MLS ? Af[a] : P{});
          if constexpr (!MLS) out.main.S[a] = side_by_side(P{}, Af[a]);
        }
      } else {
        out.main.q = qm;
        out.apart.q = qf;
        MPM_UNROLL
        for (int a = 0; a < DIM; a++) {
          if constexpr (AFFINE) out.main.A[a] = Am[a];
          (MLS ? out.apart.A[a] : out.apart.S[a]) = Af[a];
        }
      }
    } else {
      if constexpr (MLS && momentum && force) {
        MPM_UNROLL
        for (int a = 0; a < DIM; a++) Am[a] += Af[a];
      }
      P q = momentum ? qm : qf;
      if constexpr (momentum && force) q += qf;
      if constexpr (AFFINE && (momentum || MLS)) {
        P *A = momentum ? Am : Af;
        clear_lanes(A);
        to_base_node(q, A, fraction);
        MPM_UNROLL
        for (int a = 0; a < DIM; a++) out.main.A[a] = A[a];
      }
      if constexpr (gradient) {
        clear_lanes(Af);
        MPM_UNROLL
        for (int a = 0; a < DIM; a++) out.main.S[a] = Af[a];
      }
      out.main.q = q;
    }
  }

  /** Adds to the tile; SAME: the points have one base node. */
  template <bool SAME, int L>
  static MPM_INLINE void scatter(const Prepared<L> &in, Real *const *base)
  {
    in.main.template add<SAME, NREAL>(in.weights, in.gradients, base);
    if constexpr (both && !wide) {
      Real *forces[L];
      MPM_UNROLL
      for (int l = 0; l < L; l++) forces[l] = base[l] + 4;
      in.apart.template add<SAME, NREAL>(in.weights, in.gradients, forces);
    }
  }

  /** Adds n vectors of points to the tile, row by row. Rows: RowScatter, MEMBER: which one. */
  template <int L, class Rows, class Member>
  static __attribute__((noinline)) void scatter_rows(const PreparedRows<L> *in, Index n,
                                                     Real *entry, Member member)
  {
    typename Rows::Row sum[Rows::ROWS];
    Rows::clear(sum);
    int place = in[0].place[0];
    for (Index i = 0; i < n; i++) {
      MPM_UNROLL
      for (int l = 0; l < L; l++) {
        if (__builtin_expect(in[i].place[l] != place, 0)) {
          Rows::flush(sum, entry + 4 * place);
          place = in[i].place[l];
        }
        (in[i].*member).add(in[i].weights, in[i].gradients, in[i].products, l, sum);
      }
    }
    Rows::flush(sum, entry + 4 * place);
  }

  /** Points [first,last), L at a time. */
  template <int L>
  static __attribute__((noinline)) void range(const PointRows &rows, const TransferStep &transfer,
                                              Index first, Index last, const int *base,
                                              double *tile, int *box)
  {
    // copies, so that the compiler knows that no store changes them
    const PointRows points = rows;
    const TransferStep step = transfer;
    const Frame<DIM, SHAPE, L> frame(step, base);
    const Reference<L> reference(tile);
    Real *const entry =
        entries(tile) + (NREAL == 8 && PARTS == FORCE ? second_half(DIM, ORDER) : 0);
    WideQuads<L> lowest = WideQuads<L>::all(1.0e6), highest = WideQuads<L>::all(-1.0e6);
    constexpr int ENTRIES = STAGE / L;
    std::conditional_t<MIXED, PreparedRows<L>, Prepared<L>> stage[ENTRIES];

    for (Index p = first; p < last;) {
      const Index n = (last - p) / L < ENTRIES ? (last - p) / L : ENTRIES;
      const Index ahead = p + AHEAD;
      prefetch<3>(points.x, ahead);
      if (SHAPE == GIMP) prefetch<3>(points.size, ahead);
      if (momentum) {
        prefetch<3>(points.v, ahead);
        prefetch<1>(points.mass, ahead);
        if (AFFINE) prefetch<DIM * DIM>(points.C, ahead);
      }
      if (force) {
        prefetch<3>(points.f, ahead);
        if (!TOTAL) prefetch<6>(points.tau, ahead);    // P has just been made
        prefetch<1>(points.vol0, ahead);
      }
      for (Index i = 0; i < n; i++, p += L)
        prepare<L>(points, p, step, frame, reference, stage[i], lowest, highest);
      if constexpr (MIXED) {
        using Rows = PreparedRows<L>;
        scatter_rows<L, typename Rows::Main>(stage, n, entry, &Rows::main);
        if constexpr (both)
          scatter_rows<L, typename Rows::Apart>(stage, n, entry + second_half(DIM, ORDER),
                                                &Rows::apart);
        continue;
      } else {
        for (Index i = 0; i < n; i++) {
          const Prepared<L> &in = stage[i];
          Real *node[L];
          MPM_UNROLL
          for (int l = 0; l < L; l++) node[l] = entry + NREAL * in.place[l];
          if (L == 1 || __builtin_expect(node[0] == node[L - 1], 1)) {
            scatter<true>(in, node);
          } else {
            // barrier: otherwise GCC moves what both branches have in common above them, and spills
            asm volatile("" ::: "memory");
            scatter<false>(in, node);
          }
        }
      }
    }

    for (int l = 0; l < L; l++)
      for (int a = 0; a < DIM; a++) {
        const int low = frame.node(a, static_cast<int>(lowest.lane(4 * l + a)));
        const int high = frame.node(a, static_cast<int>(highest.lane(4 * l + a)));
        if (low < box[a]) box[a] = low;
        if (high > box[3 + a]) box[3 + a] = high;
      }
  }

  /** All points; the last of all through padded copies. */
  static void p2g(const PointRows &points, const TransferStep &step, int first, int last,
                  const int base[3], double *tile, int box[6])
  {
    if (first >= last) return;
    if constexpr (MIXED) MixedHeader::first<DIM, ORDER>(tile, points, first);
    const bool guarded = last <= points.guarded;
    const int rest = first + (last - first - !guarded) / POINTS * POINTS;
    if (rest > first) range<POINTS>(points, step, first, rest, base, tile, box);
    if (guarded) {
      if (rest < last) range<1>(points, step, rest, last, base, tile, box);
      return;
    }

    LastPoints copy;
    copy.load<3>(copy.x, points.x, rest, last);
    if (SHAPE == GIMP) copy.load<3>(copy.size, points.size, rest, last);
    if (momentum) {
      copy.load<3>(copy.v, points.v, rest, last);
      copy.load<1>(copy.mass, points.mass, rest, last);
      if (AFFINE) copy.template load<DIM * DIM>(copy.C, points.C, rest, last);
    }
    if (force) {
      copy.load<3>(copy.f, points.f, rest, last);
      if (TOTAL)
        copy.template load<DIM * DIM>(copy.P, points.P, rest, last);
      else
        copy.load<6>(copy.tau, points.tau, rest, last);
      copy.load<1>(copy.vol0, points.vol0, rest, last);
    }
    if (last - rest == POINTS)
      range<POINTS>(copy.rows, step, 0, POINTS, base, tile, box);
    else
      range<1>(copy.rows, step, 0, last - rest, base, tile, box);
  }
};

// ---------------------------------------------------------------------- nodes to points

/** Sums of weight times node vector for L points. GRADIENT: with the derivatives along each axis,
 *  by the gradients or, if MLS, as first moments with node numbers (from the base node). */
template <int DIM, int ORDER, int NREAL, int L, bool MLS, bool GRADIENT> struct Gather {
  using V = Quads<L>;
  using Weights = AxisWeights<ORDER, L>;
  static constexpr int N = ORDER + 1;

  V value, derivative[DIM];

  /** Node vector of each point; SAME: points share the node. */
  template <bool SAME> static MPM_INLINE V node(const Real *const *base, Index offset)
  {
    const Vec<4> first = Vec<4>::load(base[0] + offset);
    if constexpr (L == 1)
      return first;
    else if constexpr (SAME)
      return repeat<4 * L>(first);
    else if constexpr (L == 2)
      return join(first, Vec<4>::load(base[1] + offset));
    else
      return join(join(first, Vec<4>::load(base[1] + offset)),
                  join(Vec<4>::load(base[2] + offset), Vec<4>::load(base[3] + offset)));
  }

  static MPM_INLINE void accumulate(bool first, V &sum, V a, V b)
  {
    if (first)
      sum = a * b;
    else
      sum += a * b;
  }

  /** Sums a row of nodes along the last axis. */
  template <bool SAME>
  static MPM_INLINE void row(const Real *const *base, Index offset, const V *w, const V *d,
                             V &value, V &derivative)
  {
    MPM_UNROLL
    for (int n = 0; n < N; n++) {
      const V a = node<SAME>(base, offset + NREAL * n);
      accumulate(n == 0, value, w[n], a);
      if (GRADIENT && !(MLS && n == 0)) accumulate(n == MLS, derivative, d[n], a);
    }
  }

  /** Weights along AXIS and what takes their place in derivatives. */
  template <int AXIS>
  static MPM_INLINE void along(const Weights &weights, const Weights &gradients, V *w, V *d)
  {
    weights.template get<AXIS, 4>(w);
    if constexpr (MLS) {
      MPM_UNROLL
      for (int n = 1; n < N; n++) d[n] = n == 1 ? w[n] : double(n) * w[n];
    } else if constexpr (GRADIENT) {
      gradients.template get<AXIS, 4>(d);
    }
  }

  /** Value and derivatives; base: the record of each point's base node. */
  template <bool SAME>
  MPM_INLINE void sum(const Weights &weights, const Weights &gradients, const Real *const *base)
  {
    constexpr int sx = NREAL * tile_stride_x(DIM, ORDER), sy = NREAL * tile_stride_y(DIM, ORDER);
    V wx[N], wy[N], wz[N], dx[N], dy[N], dz[N];
    along<0>(weights, gradients, wx, dx);
    along<1>(weights, gradients, wy, dy);
    if constexpr (DIM == 3) along<2>(weights, gradients, wz, dz);

    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V plane, plane_y, plane_z;
      if constexpr (DIM == 2) {
        row<SAME>(base, sx * i, wy, dy, plane, plane_y);
      } else {
        MPM_UNROLL
        for (int j = 0; j < N; j++) {
          V line, line_z;
          row<SAME>(base, sx * i + sy * j, wz, dz, line, line_z);
          accumulate(j == 0, plane, wy[j], line);
          if (GRADIENT) {
            if (!(MLS && j == 0)) accumulate(j == MLS, plane_y, dy[j], line);
            accumulate(j == 0, plane_z, wy[j], line_z);
          }
        }
      }
      accumulate(i == 0, value, wx[i], plane);
      if (GRADIENT) {
        if (!(MLS && i == 0)) accumulate(i == MLS, derivative[0], dx[i], plane);
        accumulate(i == 0, derivative[1], wx[i], plane_y);
        if constexpr (DIM == 3) accumulate(i == 0, derivative[2], wx[i], plane_z);
      }
    }
  }

  /** The same for linear functions with the fraction f: interpolation takes fewer operations. */
  template <bool SAME> MPM_INLINE void interpolate(V f, const Real *const *base)
  {
    constexpr int sx = NREAL * tile_stride_x(DIM, ORDER), sy = NREAL * tile_stride_y(DIM, ORDER);
    const V fx = broadcast<0>(f), fy = broadcast<1>(f), fz = broadcast<2>(f);
    V plane[2], plane_y[2], plane_z[2];
    MPM_UNROLL
    for (int i = 0; i < 2; i++) {
      V line[2], line_z[2];
      MPM_UNROLL
      for (int j = 0; j < 2; j++) {
        line[j] = node<SAME>(base, sx * i + sy * j);
        if constexpr (DIM == 3) {
          line_z[j] = node<SAME>(base, sx * i + sy * j + NREAL) - line[j];
          line[j] += fz * line_z[j];
        }
      }
      plane_y[i] = line[1] - line[0];
      plane[i] = line[0] + fy * plane_y[i];
      if constexpr (DIM == 3) plane_z[i] = line_z[0] + fy * (line_z[1] - line_z[0]);
    }
    derivative[0] = plane[1] - plane[0];
    value = plane[0] + fx * derivative[0];
    derivative[1] = plane_y[0] + fx * (plane_y[1] - plane_y[0]);
    if constexpr (DIM == 3) derivative[2] = plane_z[0] + fx * (plane_z[1] - plane_z[0]);
  }
};

/** G2P and velocity gradient; TOTAL: places on the lattice are not the positions that change. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool TOTAL> struct NodesToPoints {
  static constexpr int ORDER = stencil_order(SHAPE);
  static constexpr bool affine = is_affine(TRANSFER);
  static constexpr bool increment = adds_change(TRANSFER);
  static constexpr bool mls = is_mls(SHAPE, TRANSFER);    // gradient from first moments
  static constexpr int STRIDE = entry_stride(NREAL), OLD = second_half(DIM, ORDER);

  /** L points ready to be gathered. */
  template <int L> struct Prepared {
    alignas(64) double x[4 * L];
    alignas(64) Real fraction[4 * L];
    AxisWeights<ORDER, L> weights, gradients;
    int place[L];
  };

  /** L points have the same base node. */
  template <int L> static MPM_INLINE bool same(const int (&place)[L])
  {
    if constexpr (L == 4)
      return ((place[0] ^ place[1]) | (place[0] ^ place[2]) | (place[0] ^ place[3])) == 0;
    else
      return place[0] == place[L - 1];
  }

  /** Loads L points and computes what gather needs. */
  template <bool UPDATE, bool GRADIENT, int L>
  static MPM_INLINE void prepare(const PointRows &points, Index p,
                                 const Frame<DIM, SHAPE, L> &frame, Prepared<L> &out)
  {
    const WideQuads<L> x = load_wide<L, 3>(points.x, p);
    const Quads<L> fraction = frame.locate(frame.position(x), out.place);
    if constexpr (TOTAL && UPDATE)
      load_wide<L, 3>(points.from, p).store(out.x);
    else
      x.store(out.x);
    fraction.store(out.fraction);
    if constexpr (ORDER > 1)
      axis_weights<SHAPE, GRADIENT && !mls, L>(points, p, fraction, out.weights, out.gradients);
  }

  /** Value and derivatives of the node vector at OFFSET in the records. */
  template <bool SAME, bool GRADIENT, int OFFSET, int L>
  static MPM_INLINE void gather(const Prepared<L> &in, const Real *const *node, Quads<L> &value,
                                Quads<L> *derivative)
  {
    const Real *base[L];
    MPM_UNROLL
    for (int l = 0; l < L; l++) base[l] = node[l] + OFFSET;
    Gather<DIM, ORDER, STRIDE, L, mls && GRADIENT, GRADIENT> field;
    if constexpr (ORDER == 1)
      field.template interpolate<SAME>(Quads<L>::load(in.fraction), base);
    else
      field.template sum<SAME>(in.weights, in.gradients, base);
    value = field.value;
    if constexpr (GRADIENT) {
      MPM_UNROLL
      for (int a = 0; a < DIM; a++) derivative[a] = field.derivative[a];
    }
  }

  /** Stores the first K reals of each point's four in rows of three. */
  template <int K, int L> static MPM_INLINE void store_rows(double *rows, Index p, WideQuads<L> a)
  {
    if constexpr (L == 1) {
      store_lanes<K>(rows + 3 * p, a);
    } else {
      store_rows<K, L / 2>(rows, p, half<0>(a));
      store_rows<K, L / 2>(rows, p + L / 2, half<1>(a));
    }
  }

  /** Stores the columns of matrices in rows of nine (2d: four), from the first row to the last. In
   *  3d a column also writes one real behind it, which the next one overwrites; not so the last. */
  template <int L>
  static MPM_INLINE void store_columns(double *rows, Index p, const WideQuads<L> *column)
  {
    if constexpr (DIM == 2) {
      shuffle<0, 1, 4, 5>(column[0], column[1]).store(rows + 4 * p);
    } else if constexpr (L == 1) {
      column[0].store(rows + 9 * p);
      column[1].store(rows + 9 * p + 3);
      store_lanes<3>(rows + 9 * p + 6, column[2]);
    } else {
      const WideQuads<L / 2> low[3] = {half<0>(column[0]), half<0>(column[1]), half<0>(column[2])};
      const WideQuads<L / 2> high[3] = {half<1>(column[0]), half<1>(column[1]), half<1>(column[2])};
      store_columns<L / 2>(rows, p, low);
      store_columns<L / 2>(rows, p + L / 2, high);
    }
  }

  /** Points [first,last), L at a time. UPDATE: velocity, position and C; GRADIENT: the velocity
   *  gradient, which goes to C and to the rows of gradients, the first of them for point first. */
  template <int L, bool UPDATE, bool GRADIENT>
  static __attribute__((noinline)) int range(const PointRows &rows, const TransferStep &transfer,
                                             Index first, Index last, const int *base,
                                             const double *tile, double *gradients)
  {
    using P = Quads<L>;
    // copies, so that the compiler knows that no store changes them
    const PointRows points = rows;
    const TransferStep step = transfer;
    const Frame<DIM, SHAPE, L> frame(step, base);
    const Real *const entry = entries(tile);
    WideQuads<L> reference = {};    // velocity that those in the tile are relative to
    if constexpr (MIXED) reference = repeat<4 * L>(WideQuads<1>::load(tile));
    WideQuads<L> outside = {};
    constexpr double range_of_bases = block_side(DIM) + 2;
    constexpr int ENTRIES = STAGE / L;
    Prepared<L> stage[ENTRIES];

    for (Index p = first; p < last;) {
      const Index n = (last - p) / L < ENTRIES ? (last - p) / L : ENTRIES;
      const Index ahead = p + AHEAD;
      if (SHAPE == GIMP) prefetch<3>(points.size, ahead);
      if (UPDATE) {
        prefetch<3, 1>(points.x, ahead);
        if (TOTAL) prefetch<3, 1>(points.from, ahead);
        prefetch<3, 1>(points.v, ahead);
        if (affine) prefetch<DIM * DIM, 1>(points.C, ahead);
      } else {
        prefetch<3>(points.x, ahead);
      }
      if (GRADIENT) {
        // the constitutive law comes next
        if (points.F) prefetch<9, 1>(points.F, ahead);
        prefetch<6, 1>(points.tau, ahead);
        prefetch<1>(points.vol0, ahead);
      }
      for (Index i = 0; i < n; i++)
        prepare<UPDATE, GRADIENT, L>(points, p + L * i, frame, stage[i]);
      for (Index i = 0; i < n; i++, p += L) {
        const Prepared<L> &in = stage[i];
        const Real *node[L];
        MPM_UNROLL
        for (int l = 0; l < L; l++) node[l] = entry + STRIDE * in.place[l];
        P v, D[DIM], v_old;
        if (__builtin_expect(same(in.place), 1)) {
          gather<true, GRADIENT, 0>(in, node, v, D);
          if constexpr (UPDATE && increment) gather<true, false, OLD>(in, node, v_old, D);
        } else {
          // barrier: otherwise GCC moves what both branches have in common above them, and spills
          asm volatile("" ::: "memory");
          gather<false, GRADIENT, 0>(in, node, v, D);
          if constexpr (UPDATE && increment) gather<false, false, OLD>(in, node, v_old, D);
        }

        if constexpr (GRADIENT) {
          const double factor = weight_scale<DIM, ORDER>() *
              (mls ? BSpline<ORDER>::inv_moment * step.inv_h : step.inv_h);
          if constexpr (mls) {
            // moments about the point instead of the base node
            const P distance = P::load(in.fraction) + BSpline<ORDER>::shift;
            D[0] -= broadcast<0>(distance) * v;
            D[1] -= broadcast<1>(distance) * v;
            if constexpr (DIM == 3) D[2] -= broadcast<2>(distance) * v;
          }
          WideQuads<L> column[DIM];
          MPM_UNROLL
          for (int a = 0; a < DIM; a++) column[a] = factor * convert<double>(D[a]);
          if (UPDATE && affine) store_columns<L>(points.C, p, column);
          if (!affine || gradients) store_columns<L>(gradients, p - first, column);
        }

        if constexpr (UPDATE) {
          WideQuads<L> v_new = convert<double>(v);
          if constexpr (MIXED) v_new = reference + v_new * weight_scale<DIM, ORDER>();
          if constexpr (DIM == 2) v_new = blend<2>(v_new, WideQuads<L>{});
          const WideQuads<L> x = WideQuads<L>::load(in.x) + step.dt * v_new;
          outside = flag_outside(outside, TOTAL ? x - x : frame.position(x), range_of_bases);
          store_rows<3, L>(points.xnew, p, x);
          if constexpr (increment) {
            WideQuads<L> old = convert<double>(v_old);
            if constexpr (MIXED)    // the tile has changes
              old = v_new - old * weight_scale<DIM, ORDER>();
            v_new += step.flip * (load_wide<L, 3>(points.v, p) - old);
          }
          store_rows<DIM, L>(points.v, p, v_new);
        }
      }
    }

    bool left = false;
    for (int l = 0; l < L; l++)
      for (int a = 0; a < DIM; a++) left = left || outside.lane(4 * l + a) != 0.0;
    return left;
  }

  /** All points; the last of all through padded copies. */
  template <bool UPDATE, bool GRADIENT>
  static int run(const PointRows &points, const TransferStep &step, int first, int last,
                 const int *base, const double *tile, double *gradients)
  {
    if (first >= last) return 0;
    const bool guarded = last <= points.guarded;
    const int rest = first + (last - first - !guarded) / POINTS * POINTS;
    int left = 0;
    if (rest > first)
      left = range<POINTS, UPDATE, GRADIENT>(points, step, first, rest, base, tile, gradients);
    if (guarded) {
      if (rest < last)
        left |= range<1, UPDATE, GRADIENT>(points, step, rest, last, base, tile,
                                           gradients ? gradients + DIM * DIM * (rest - first)
                                                     : nullptr);
      return left;
    }

    LastPoints copy;
    copy.load<3>(copy.x, points.x, rest, last);
    if (SHAPE == GIMP) copy.load<3>(copy.size, points.size, rest, last);
    if (UPDATE) copy.load<3>(copy.v, points.v, rest, last);
    if (UPDATE && TOTAL) copy.load<3>(copy.from, points.from, rest, last);
    if (last - rest == POINTS)
      left |= range<POINTS, UPDATE, GRADIENT>(copy.rows, step, 0, POINTS, base, tile, copy.L);
    else
      left |= range<1, UPDATE, GRADIENT>(copy.rows, step, 0, last - rest, base, tile, copy.L);
    if (UPDATE) {
      copy.store<3>(copy.xnew, points.xnew, rest, last);
      copy.store<3>(copy.v, points.v, rest, last);
      if (affine) copy.template store<DIM * DIM>(copy.C, points.C, rest, last);
    }
    if (GRADIENT && gradients)
      copy.template store<DIM * DIM>(copy.L, gradients, rest - first, last - first);
    return left;
  }

  static int g2p(const PointRows &points, const TransferStep &step, int first, int last,
                 const int base[3], const double *tile, double *L)
  {
    if (affine || L) return run<true, true>(points, step, first, last, base, tile, L);
    if constexpr (!affine) return run<true, false>(points, step, first, last, base, tile, L);
    return 0;
  }

  static int g2p_gradient(const PointRows &points, const TransferStep &step, int first, int last,
                          const int base[3], const double *tile, double *L)
  {
    run<false, true>(points, step, first, last, base, tile, L);
    return 0;
  }
};

// ---------------------------------------------------------------------- nodes

enum TileMove { FLUSH, LOAD, PREFETCH };

/** Adds N reals of a tile in double precision to nodes and clears them, loads them, or brings the nodes
 *  near. */
template <int N, TileMove MOVE> MPM_INLINE void move_reals(double *tile, double *nodes)
{
  if constexpr (MOVE == PREFETCH) {
    // to the second-level cache: the first has no room for another tile yet
    constexpr int line = 8;
    MPM_UNROLL
    for (int i = 0; i < N; i += line) __builtin_prefetch(nodes + i, 1, 2);
    return;
  }
  MPM_UNROLL
  for (int i = 0; i < N; i += 4) {
    if constexpr (MOVE == LOAD) {
      WideQuads<1>::load(nodes + i).store(tile + i);
    } else {
      (WideQuads<1>::load(nodes + i) + WideQuads<1>::load(tile + i)).store(nodes + i);
      WideQuads<1>{}.store(tile + i);
    }
  }
}

/** The same for COUNT entries, in either precision. */
template <int COUNT, int NREAL, int SECOND, TileMove MOVE>
MPM_INLINE void move_nodes(Real *entry, double *nodes, const double *header)
{
  if constexpr (MOVE == PREFETCH || !MIXED) {
    move_reals<COUNT * NREAL, MOVE>(reinterpret_cast<double *>(entry), nodes);
  } else {
    using W = WideQuads<1>;
    const W v = W::load(header);
    const double mass = header[4];
    MPM_UNROLL
    for (int i = 0; i < COUNT; i++, entry += 4, nodes += NREAL) {
      if constexpr (MOVE == LOAD) {
        const W now = W::load(nodes);
        convert<Real>(blend<3>(now - v, W{})).store(entry);
        if constexpr (NREAL == 8)
          convert<Real>(blend<3>(now - W::load(nodes + 4), W{})).store(entry + SECOND);
      } else {
        const W a = mass * convert<double>(Vec<4>::load(entry));
        (W::load(nodes) + a + broadcast<3>(a) * v).store(nodes);
        Vec<4>{}.store(entry);
        if constexpr (NREAL == 8) {
          (W::load(nodes + 4) + mass * convert<double>(Vec<4>::load(entry + SECOND)))
              .store(nodes + 4);
          Vec<4>{}.store(entry + SECOND);
        }
      }
    }
  }
}

/** Mixed precision: the reference for velocities of nodes is that of the one in the middle of the
 *  box or, if it has no mass, of the heaviest one. */
template <int DIM, int ORDER, int NREAL>
void take_reference(double *tile, const double *nodes, const int slot[27], const int box[6])
{
  constexpr int side = block_side(DIM);
  const double *heaviest = nullptr;
  const auto look = [&](int i, int j, int k) {
    const int x = i + side - 1, y = j + side - 1, z = DIM == 3 ? k + side - 1 : 1;
    const int block = slot[9 * (x / side) + 3 * (y / side) + (DIM == 3 ? z / side : 1)];
    const int index = DIM == 3 ? (x % side * side + y % side) * side + z % side
                               : x % side * side + y % side;
    const double *const node = nodes + (Index(64) * block + index) * NREAL;
    if (!heaviest || node[3] > heaviest[3]) heaviest = node;
  };
  const auto middle = [&](int a) {
    return (box[a] + box[3 + a] + ORDER) / 2;
  };
  look(middle(0), middle(1), DIM == 3 ? middle(2) : 0);
  if (!(heaviest[3] > 0.0))
    for (int i = box[0]; i <= box[3] + ORDER; i++)
      for (int j = box[1]; j <= box[4] + ORDER; j++)
        for (int k = DIM == 3 ? box[2] : 0; k <= (DIM == 3 ? box[5] + ORDER : 0); k++)
          look(i, j, k);
  for (int a = 0; a < 3; a++) tile[a] = heaviest[a];
}

/** Flush, load or prefetch, a row of nodes along the last axis at a time. A row has one node in the block
 *  before, all of its own block and ORDER + 1 nodes in the block after; each of these parts is
 *  moved whole if the box touches it. */
template <int DIM, int ORDER, int NREAL, TileMove MOVE>
void tile_io(double *tile, double *nodes, const int slot[27], const int box[6])
{
  constexpr int side = block_side(DIM), last = DIM - 1, after = ORDER + 1;
  constexpr int sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  constexpr int STRIDE = entry_stride(NREAL), SECOND = second_half(DIM, ORDER);
  const bool touches_before = box[last] == 0;
  const bool touches_own = box[last] <= side;
  const bool touches_after = box[3 + last] + ORDER > side;
  if constexpr (MIXED && MOVE == LOAD) take_reference<DIM, ORDER, NREAL>(tile, nodes, slot, box);

  const int ylow = DIM == 3 ? box[1] : 0;
  const int yhigh = DIM == 3 ? box[4] + ORDER : 0;
  for (int i = box[0]; i <= box[3] + ORDER; i++)
    for (int j = ylow; j <= yhigh; j++) {
      // tile node 0 is the last node of the block before
      const int x = i + side - 1, y = j + side - 1;
      Real *row = entries(tile) + STRIDE * (DIM == 3 ? i * sx + j * sy : i * sx);
      const int *block = slot + (DIM == 3 ? 9 * (x / side) + 3 * (y / side) : 9 * (x / side));
      const int index = DIM == 3 ? (x % side * side + y % side) * side : x % side * side;
      // in 3d slots of a row are neighbours, in 2d three apart, the middle one of three in z
      constexpr int next = DIM == 3 ? 1 : 3, middle = DIM == 3 ? 0 : 1;
      const auto record = [&](int which, int node) {
        return nodes + (Index(64) * block[which * next + middle] + node) * NREAL;
      };
      if (touches_before)
        move_nodes<1, NREAL, SECOND, MOVE>(row, record(0, index + side - 1), tile);
      if (touches_own) move_nodes<side, NREAL, SECOND, MOVE>(row + STRIDE, record(1, index), tile);
      if (touches_after)
        move_nodes<after, NREAL, SECOND, MOVE>(row + STRIDE * (side + 1), record(2, index), tile);
    }
  if constexpr (MIXED && MOVE == FLUSH)    // the next transfer takes another reference
    for (int k = 0; k < 5; k++) tile[k] = 0.0;
}

// ---------------------------------------------------------------------- table

/** All of one dimension, shape, transfer, size of records, and frame. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool TOTAL> TransferKernels kernels()
{
  constexpr int ORDER = stencil_order(SHAPE);
  constexpr bool affine = is_affine(TRANSFER), mls = is_mls(SHAPE, TRANSFER);
  using G2P = NodesToPoints<DIM, SHAPE, TRANSFER, NREAL, TOTAL>;
  TransferKernels k;
  k.nreal = NREAL;
  k.margin = 1;
  k.affine = affine;
  k.gradient_in_C = is_gradient(SHAPE, TRANSFER);
  k.p2g = PointsToNodes<DIM, SHAPE, affine, mls, NREAL, ALL, TOTAL>::p2g;
  k.p2g_momentum = PointsToNodes<DIM, SHAPE, affine, mls, NREAL, MOMENTUM, false>::p2g;
  k.p2g_force = PointsToNodes<DIM, SHAPE, affine, mls, NREAL, FORCE, TOTAL>::p2g;
  k.g2p = G2P::g2p;
  k.g2p_gradient = NodesToPoints<DIM, SHAPE, TRANSFER, NREAL, false>::g2p_gradient;
  k.flush = tile_io<DIM, ORDER, NREAL, FLUSH>;
  k.load = tile_io<DIM, ORDER, NREAL, LOAD>;
  k.prefetch = tile_io<DIM, ORDER, NREAL, PREFETCH>;
  return k;
}

}    // namespace
#endif

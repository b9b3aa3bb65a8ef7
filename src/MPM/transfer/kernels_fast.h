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
// What a transfer does is written plainly in transfer/kernels_reference.cpp; this file does the
// same in fewer operations: - A point's contribution to a node is a product over axes, plus one
// term per axis (affine part
//    or stress gradient). Summed axis by axis this costs two multiply-adds per node and vector,
//    see Scatter. The way back sums z rows first, then y, then x, see Gather.
//  - Vectors hold the four reals of a node (x, y, z, mass), for one or two points side by side.
//    Two points that share the base node are added up before they go to the tile.
//  - Points are prepared (loaded, weighted) in stages of several, then scattered or gathered: the
//    long latency of the preparation of one point hides behind the others.

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
  static MPM_INLINE void add_row(double *const *base, Index offset, V row, V factor, const V *w,
                                 const V *K)
  {
    MPM_UNROLL
    for (int n = 0; n < N; n++) {
      double *node = base[0] + offset + NREAL * n;
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
  MPM_INLINE void add(const Weights &weights, const Weights &gradients, double *const *base) const
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

/** P2G of the quantities PARTS. AFFINE: uses C. MLS: stress as an affine term. Each of these two is
 *  false where it makes no difference, see PointsToNodesOf. */
template <int DIM, Shape SHAPE, bool AFFINE, bool MLS, int NREAL, int PARTS> struct PointsToNodes {
  static constexpr int ORDER = FunctionOf<SHAPE>::order;
  static constexpr bool momentum = PARTS & MOMENTUM;
  static constexpr bool force = PARTS & FORCE;
  static constexpr bool gradient = force && !MLS;    // stress with gradients

  // A record of 8 reals has momentum and force apart. One long vector can hold both; else, and for
  // linear functions where it is faster, the force is scattered after the momentum.
  static constexpr bool both = NREAL == 8 && PARTS == ALL;
  static constexpr bool wide = both && REGISTER == 8 && ORDER > 1;

  /** L points ready to be scattered. */
  static constexpr bool affine = (AFFINE && momentum) || (MLS && force && !(both && !wide));
  static constexpr bool sloped = gradient && (wide || !both);
  template <int L> struct Prepared {
    Scatter<DIM, ORDER, wide ? 8 : 4, L, affine, sloped> main;
    Scatter<DIM, ORDER, 4, L, MLS, !MLS> apart;    // the force, if it is not in main
    AxisWeights<ORDER, L> weights, gradients;
    int place[L];
  };
  /** Columns of a full matrix times a factor; lanes that are no axis are arbitrary. */
  template <int L>
  static MPM_INLINE void matrix_columns(const double *matrix, Index p, Quads<L> factor,
                                        Quads<L> *column)
  {
    if constexpr (DIM == 2) {
      column[0] = factor * load_rows<L, 4>(matrix, p);
      column[1] = shuffle<2, 3, 2, 3>(column[0], column[0]);
    } else {
      MPM_UNROLL
      for (int a = 0; a < 3; a++) column[a] = factor * load_rows<L, 9>(matrix + 3 * a, p);
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
  static MPM_INLINE void momentum_terms(const PointRows &points, Index p, double h, Quads<L> &q,
                                        Quads<L> *A)
  {
    const Quads<L> mass = load_numbers<L>(points.mass, p, 1.0);
    const Quads<L> v = load_rows<L, 3>(points.v, p);
    q = blend<DIM>(v, repeat<4 * L>(quad(0.0, 0.0, 0.0, 1.0))) * mass;
    if constexpr (AFFINE) matrix_columns<L>(points.C, p, h * mass, A);
  }

  /** Force times scale: external, and columns of -stress that an affine or gradient term takes;
   *  total: of the first Piola-Kirchhoff instead of the Kirchhoff stress. */
  template <int L>
  static MPM_INLINE void force_terms(const PointRows &points, Index p, const TransferStep &step,
                                     bool total, double scale, Quads<L> &q, Quads<L> *A)
  {
    q = (scale * step.force_scale) * blend<DIM>(load_rows<L, 3>(points.f, p), Quads<L>{});
    const double factor =
        -scale * step.stress_scale * step.inv_h * (MLS ? FunctionOf<SHAPE>::inv_moment : 1.0);
    const Quads<L> volume = load_numbers<L>(points.vol0, p, factor);
    if (total)
      matrix_columns<L>(points.P, p, Quads<L>::all(1.0), A);
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
  template <int L>
  static MPM_INLINE void prepare(const PointRows &points, Index p, const TransferStep &step,
                                 bool total, const Frame<DIM, SHAPE, L> &frame, Prepared<L> &out,
                                 Quads<L> &lowest, Quads<L> &highest)
  {
    const Quads<L> t = frame.position_inside(load_rows<L, 3>(points.x, p));
    lowest = min(lowest, t);
    highest = max(highest, t);
    const Quads<L> fraction = frame.locate(t, out.place);
    axis_weights<SHAPE, gradient, L>(points, p, fraction, out.weights, out.gradients);

    // Am is an affine term, Af an affine or a gradient term
    Quads<L> qm, qf, Am[DIM], Af[DIM];
    if constexpr (momentum) momentum_terms<L>(points, p, step.h, qm, Am);
    if constexpr (force) force_terms<L>(points, p, step, total, NREAL == 4 ? step.dt : 1.0, qf, Af);

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
          if constexpr (AFFINE) out.main.A[a] = side_by_side(Am[a], MLS ? Af[a] : Quads<L>{});
          if constexpr (!MLS) out.main.S[a] = side_by_side(Quads<L>{}, Af[a]);
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
      Quads<L> q = momentum ? qm : qf;
      if constexpr (momentum && force) q += qf;
      if constexpr (AFFINE && (momentum || MLS)) {
        Quads<L> *A = momentum ? Am : Af;
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
  static MPM_INLINE void scatter(const Prepared<L> &in, double *const *base)
  {
    in.main.template add<SAME, NREAL>(in.weights, in.gradients, base);
    if constexpr (both && !wide) {
      double *forces[L];
      MPM_UNROLL
      for (int l = 0; l < L; l++) forces[l] = base[l] + 4;
      in.apart.template add<SAME, NREAL>(in.weights, in.gradients, forces);
    }
  }

  /** Points [first,last), L at a time. */
  template <int L>
  static __attribute__((noinline)) void range(const PointRows &rows, const TransferStep &transfer,
                                              bool total, Index first, Index last, const int *base,
                                              double *tile, int *box)
  {
    // copies, so that the compiler knows that no store changes them
    const PointRows points = rows;
    const TransferStep step = transfer;
    const Frame<DIM, SHAPE, L> frame(step, base);
    double *const entry = tile + (NREAL == 8 && PARTS == FORCE ? 4 : 0);
    Quads<L> lowest = Quads<L>::all(1.0e6), highest = Quads<L>::all(-1.0e6);
    constexpr int ENTRIES = STAGE / L;
    Prepared<L> stage[ENTRIES];

    for (Index p = first; p < last;) {
      const Index n = (last - p) / L < ENTRIES ? (last - p) / L : ENTRIES;
      const Index ahead = p + AHEAD;
      prefetch<3>(points.x, ahead);
      if (has_size(SHAPE)) prefetch<3>(points.size, ahead);
      prefetch_momentum_and_force<DIM, PARTS, AFFINE>(points, ahead, total);
      for (Index i = 0; i < n; i++, p += L)
        prepare<L>(points, p, step, total, frame, stage[i], lowest, highest);
      for (Index i = 0; i < n; i++) {
        const Prepared<L> &in = stage[i];
        double *node[L];
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

    for (int l = 0; l < L; l++)
      for (int a = 0; a < DIM; a++) {
        const int low = frame.node(a, static_cast<int>(lowest.lane(4 * l + a)));
        const int high = frame.node(a, static_cast<int>(highest.lane(4 * l + a)));
        if (low < box[a]) box[a] = low;
        if (high > box[3 + a]) box[3 + a] = high;
      }
  }

  /** The last points, which are no whole vector or have no memory behind them, through padded
   *  copies. */
  static __attribute__((noinline)) void end(const PointRows &points, const TransferStep &step,
                                            bool total, Index rest, Index last, const int *base,
                                            double *tile, int *box)
  {
    LastPoints copy(rest, last);
    copy.load(copy.x, points.x, 3);
    if (has_size(SHAPE)) copy.load(copy.size, points.size, 3);
    if (momentum) {
      copy.load(copy.v, points.v, 3);
      copy.load(copy.mass, points.mass, 1);
      if (AFFINE) copy.load(copy.C, points.C, DIM * DIM);
    }
    if (force) {
      copy.load(copy.f, points.f, 3);
      if (total)
        copy.load(copy.P, points.P, DIM * DIM);
      else
        copy.load(copy.tau, points.tau, 6);
      copy.load(copy.vol0, points.vol0, 1);
    }
    for (Index i = copy.n; i < POINTS; i++) {
      copy.mass[i] = copy.vol0[i] = 0.0;
      for (int a = 0; a < 3; a++) copy.f[3 * i + a] = 0.0;
    }
    range<POINTS>(copy.rows, step, total, 0, POINTS, base, tile, box);
  }

  /** All points. */
  template <bool TOTAL>
  static void p2g(const PointRows &points, const TransferStep &step, int first, int last,
                  const int base[3], double *tile, int box[6])
  {
    if (first >= last) return;
    const int rest = first + (last - first - (last > points.guarded)) / POINTS * POINTS;
    if (rest > first) range<POINTS>(points, step, TOTAL, first, rest, base, tile, box);
    if (rest < last) end(points, step, TOTAL, rest, last, base, tile, box);
  }
};

/** The kernels of a combination. */
template <class C, int PARTS, bool MLS = (PARTS & FORCE) && is_mls(C::shape, C::transfer)>
using PointsToNodesOf =
    PointsToNodes<C::dim, C::shape, is_affine(C::transfer) && ((PARTS & MOMENTUM) || MLS), MLS,
                  C::nreal, PARTS>;

// ---------------------------------------------------------------------- nodes to points

/** Sums of weight times node vector for L points. GRADIENT: with the derivatives along each axis,
 *  by the gradients or, if MLS, as first moments with node numbers (from the base node). */
template <int DIM, int ORDER, int NREAL, int L, bool MLS, bool GRADIENT> struct Gather {
  using V = Quads<L>;
  using Weights = AxisWeights<ORDER, L>;
  static constexpr int N = ORDER + 1;

  V value, derivative[DIM];

  /** Node vector of each point; SAME: points share the node. */
  template <bool SAME> static MPM_INLINE V node(const double *const *base, Index offset)
  {
    const Vec<4> first = Vec<4>::load(base[0] + offset);
    if constexpr (L == 1)
      return first;
    else if constexpr (SAME)
      return repeat<4 * L>(first);
    else
      return join(first, Vec<4>::load(base[1] + offset));
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
  static MPM_INLINE void row(const double *const *base, Index offset, const V *w, const V *d,
                             V &value, V &derivative)
  {
    MPM_UNROLL
    for (int n = 0; n < N; n++) {
      const V a = node<SAME>(base, offset + NREAL * n);
      accumulate(n == 0, value, w[n], a);
      if (GRADIENT && !(MLS && n == 0)) accumulate(n == MLS, derivative, d[n], a);
    }
  }

  /** Weights along AXIS and the factors that replace them in derivatives. */
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
  MPM_INLINE void sum(const Weights &weights, const Weights &gradients, const double *const *base)
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
  template <bool SAME> MPM_INLINE void interpolate(V f, const double *const *base)
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

/** G2P and velocity gradient; total: places on the lattice are not the positions that change. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL> struct NodesToPoints {
  static constexpr int ORDER = FunctionOf<SHAPE>::order;
  static constexpr bool affine = is_affine(TRANSFER);
  static constexpr bool increment = adds_change(TRANSFER);
  static constexpr bool mls = is_mls(SHAPE, TRANSFER);    // gradient from first moments

  /** L points ready to be gathered. */
  template <int L> struct Prepared {
    alignas(64) double x[4 * L];
    alignas(64) double fraction[4 * L];
    AxisWeights<ORDER, L> weights, gradients;
    int place[L];
  };

  /** Loads L points and computes what gather needs; from: the positions that change. */
  template <bool UPDATE, bool GRADIENT, int L>
  static MPM_INLINE void prepare(const PointRows &points, const double *from, Index p,
                                 const Frame<DIM, SHAPE, L> &frame, Prepared<L> &out)
  {
    const Quads<L> x = load_rows<L, 3>(points.x, p);
    const Quads<L> fraction = frame.locate(frame.position_inside(x), out.place);
    if constexpr (UPDATE) load_rows<L, 3>(from, p).store(out.x);
    fraction.store(out.fraction);
    if constexpr (ORDER > 1)
      axis_weights<SHAPE, GRADIENT && !mls, L>(points, p, fraction, out.weights, out.gradients);
  }

  /** Value and derivatives of the node vector at OFFSET in the records. */
  template <bool SAME, bool GRADIENT, int OFFSET, int L>
  static MPM_INLINE void gather(const Prepared<L> &in, const double *const *node, Quads<L> &value,
                                Quads<L> *derivative)
  {
    const double *base[L];
    MPM_UNROLL
    for (int l = 0; l < L; l++) base[l] = node[l] + OFFSET;
    Gather<DIM, ORDER, NREAL, L, mls && GRADIENT, GRADIENT> field;
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
  template <int K, int L> static MPM_INLINE void store_rows(double *rows, Index p, Quads<L> a)
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
  static MPM_INLINE void store_columns(double *rows, Index p, const Quads<L> *column)
  {
    if constexpr (DIM == 2) {
      shuffle<0, 1, 4, 5>(column[0], column[1]).store(rows + 4 * p);
    } else if constexpr (L == 1) {
      column[0].store(rows + 9 * p);
      column[1].store(rows + 9 * p + 3);
      store_lanes<3>(rows + 9 * p + 6, column[2]);
    } else {
      const Quads<L / 2> low[3] = {half<0>(column[0]), half<0>(column[1]), half<0>(column[2])};
      const Quads<L / 2> high[3] = {half<1>(column[0]), half<1>(column[1]), half<1>(column[2])};
      store_columns<L / 2>(rows, p, low);
      store_columns<L / 2>(rows, p + L / 2, high);
    }
  }

  /** Points [first,last), L at a time. UPDATE: velocity, position and C; GRADIENT: the velocity
   *  gradient, which goes to C and to the rows of gradients, the first of them for point first. */
  template <int L, bool UPDATE, bool GRADIENT>
  static __attribute__((noinline)) int range(const PointRows &rows, const TransferStep &transfer,
                                             bool total, Index first, Index last, const int *base,
                                             const double *tile, double *gradients)
  {
    // copies, so that the compiler knows that no store changes them
    const PointRows points = rows;
    const TransferStep step = transfer;
    const Frame<DIM, SHAPE, L> frame(step, base);
    const double *const from = total ? points.from : points.x;
    Frame<DIM, SHAPE, L> tile_range = frame;
    if (total) tile_range.inv_h = tile_range.low = Quads<L>{};    // no more than to be finite
    Quads<L> outside = {};
    constexpr double range_of_bases = block_side(DIM) + 2;
    constexpr int ENTRIES = STAGE / L;
    Prepared<L> stage[ENTRIES];

    for (Index p = first; p < last;) {
      const Index n = (last - p) / L < ENTRIES ? (last - p) / L : ENTRIES;
      const Index ahead = p + AHEAD;
      if (has_size(SHAPE)) prefetch<3>(points.size, ahead);
      if (UPDATE) {
        prefetch<3, 1>(points.x, ahead);
        if (total) prefetch<3, 1>(from, ahead);
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
        prepare<UPDATE, GRADIENT, L>(points, from, p + L * i, frame, stage[i]);
      for (Index i = 0; i < n; i++, p += L) {
        const Prepared<L> &in = stage[i];
        const double *node[L];
        MPM_UNROLL
        for (int l = 0; l < L; l++) node[l] = tile + NREAL * in.place[l];
        Quads<L> v, D[DIM], v_old;
        if (__builtin_expect(in.place[0] == in.place[L - 1], 1)) {
          gather<true, GRADIENT, 0>(in, node, v, D);
          if constexpr (UPDATE && increment) gather<true, false, 4>(in, node, v_old, D);
        } else {
          // barrier: otherwise GCC moves what both branches have in common above them, and spills
          asm volatile("" ::: "memory");
          gather<false, GRADIENT, 0>(in, node, v, D);
          if constexpr (UPDATE && increment) gather<false, false, 4>(in, node, v_old, D);
        }

        if constexpr (GRADIENT) {
          const double factor = mls ? FunctionOf<SHAPE>::inv_moment * step.inv_h : step.inv_h;
          if constexpr (mls) {
            // moments about the point instead of the base node
            const Quads<L> distance = Quads<L>::load(in.fraction) + FunctionOf<SHAPE>::shift;
            D[0] -= broadcast<0>(distance) * v;
            D[1] -= broadcast<1>(distance) * v;
            if constexpr (DIM == 3) D[2] -= broadcast<2>(distance) * v;
          }
          Quads<L> column[DIM];
          MPM_UNROLL
          for (int a = 0; a < DIM; a++) column[a] = factor * D[a];
          if (UPDATE && affine) store_columns<L>(points.C, p, column);
          if (!affine || gradients) store_columns<L>(gradients, p - first, column);
          if (!UPDATE && points.velocity) store_rows<DIM, L>(points.velocity, p, v);
        }

        if constexpr (UPDATE) {
          Quads<L> v_new = v;
          if constexpr (DIM == 2) v_new = blend<2>(v_new, Quads<L>{});
          const Quads<L> x = Quads<L>::load(in.x) + step.dt * v_new;
          outside = flag_outside(outside, tile_range.position(x), range_of_bases);
          store_rows<3, L>(points.xnew, p, x);
          if constexpr (increment) v_new += step.flip * (load_rows<L, 3>(points.v, p) - v_old);
          store_rows<DIM, L>(points.v, p, v_new);
        }
      }
    }

    bool left = false;
    for (int l = 0; l < L; l++)
      for (int a = 0; a < DIM; a++) left = left || outside.lane(4 * l + a) != 0.0;
    return left;
  }

  /** The last points, which are no whole vector or have no memory behind them, through padded
   *  copies. */
  template <bool UPDATE, bool GRADIENT>
  static __attribute__((noinline)) int end(const PointRows &points, const TransferStep &step,
                                           bool total, Index rest, Index last, const int *base,
                                           const double *tile, double *gradients)
  {
    LastPoints copy(rest, last);
    copy.load(copy.x, points.x, 3);
    if (has_size(SHAPE)) copy.load(copy.size, points.size, 3);
    if (UPDATE) copy.load(copy.v, points.v, 3);
    if (UPDATE && total) copy.load(copy.from, points.from, 3);
    if (!UPDATE && points.velocity) copy.rows.velocity = copy.v;
    const int left =
        range<POINTS, UPDATE, GRADIENT>(copy.rows, step, total, 0, POINTS, base, tile, copy.L);
    if (UPDATE) {
      copy.store(copy.xnew, points.xnew, 3);
      copy.store(copy.v, points.v, 3);
      if (affine) copy.store(copy.C, points.C, DIM * DIM);
    }
    for (Index p = rest; !UPDATE && points.velocity && p < last; p++)
      for (int a = 0; a < DIM; a++) points.velocity[3 * p + a] = copy.v[3 * (p - rest) + a];
    if (GRADIENT && gradients) copy_reals(gradients, copy.L, DIM * DIM * copy.n);
    return left;
  }

  /** All points. Without UPDATE none has left its tile. */
  template <bool UPDATE, bool GRADIENT>
  static int run(const PointRows &points, const TransferStep &step, bool total, int first, int last,
                 const int *base, const double *tile, double *gradients)
  {
    if (first >= last) return 0;
    const int rest = first + (last - first - (last > points.guarded)) / POINTS * POINTS;
    int left = 0;
    if (rest > first)
      left =
          range<POINTS, UPDATE, GRADIENT>(points, step, total, first, rest, base, tile, gradients);
    if (rest < last)
      left |= end<UPDATE, GRADIENT>(points, step, total, rest, last, base, tile,
                                    gradients ? gradients + DIM * DIM * (rest - first) : nullptr);
    return left;
  }

  template <bool TOTAL>
  static int g2p(const PointRows &points, const TransferStep &step, int first, int last,
                 const int base[3], const double *tile, double *L)
  {
    if constexpr (!affine)
      if (!L) return run<true, false>(points, step, TOTAL, first, last, base, tile, L);
    return run<true, true>(points, step, TOTAL, first, last, base, tile, L);
  }

  static int gradient(const PointRows &points, const TransferStep &step, int first, int last,
                      const int base[3], const double *tile, double *L)
  {
    return run<false, true>(points, step, false, first, last, base, tile, L);
  }
};

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

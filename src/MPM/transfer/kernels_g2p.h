/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_G2P_H
#define MPM_TRANSFER_KERNELS_G2P_H

// Fast transfers from nodes to points, see transfer/kernels_fast.h.

#include "transfer/kernels_points.h"

using namespace MPM_NS;

namespace {

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

}    // namespace

#endif

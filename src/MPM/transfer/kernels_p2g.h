/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_P2G_H
#define MPM_TRANSFER_KERNELS_P2G_H

// Fast transfers from points to nodes, see transfer/kernels_fast.h.

#include "transfer/kernels_points.h"

using namespace MPM_NS;

namespace {

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

}    // namespace

#endif

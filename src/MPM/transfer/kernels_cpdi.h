/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_KERNELS_CPDI_H
#define MPM_TRANSFER_KERNELS_CPDI_H

// Fast transfers of points with convected domains (CPDI, CPDI2), see transfer/kernels_fast.h and
// transfer/cpdi.h. What they do is written plainly in transfer/kernels_reference.cpp.
//
// Corners and their weights are made for a group of points side by side, then each corner is
// scattered or gathered as a point with a linear function would be.

#include "transfer/cpdi.h"
#include "transfer/kernels_fast.h"

namespace {

constexpr int GROUP = 8;    ///< points whose domains are prepared together
static_assert(GROUP % REGISTER == 0 && GROUP == STAGE);

/** DIM reals that are STRIDE apart, and zeros. */
template <int DIM, int STRIDE> MPM_INLINE Vec<4> strided(const double *p)
{
  return quad(p[0], p[STRIDE], DIM == 3 ? p[2 * STRIDE] : 0.0, 0.0);
}

/** The first four reals. */
template <int N> MPM_INLINE Vec<4> first_four(Vec<N> a)
{
  if constexpr (N == 4)
    return a;
  else
    return half<0>(a);
}

/** Places in the tile in node spacings from its first node. */
struct TileFrame {
  double origin[3], low[3], inv_h;

  TileFrame(const TransferStep &step, const int *base) : inv_h(step.inv_h)
  {
    for (int d = 0; d < 3; d++) origin[d] = step.origin[d];
    for (int d = 0; d < 3; d++) low[d] = base[d];
  }
};

/** a, but 0 where the flag is set. */
MPM_INLINE Vec<REGISTER> unless(Vec<REGISTER> flag, Vec<REGISTER> a)
{
  return {flag.r == 0.0 ? a.r : Vec<REGISTER>{}.r};
}

/** The domains of up to GROUP points; [.][point]. STENCIL: also what Stencil needs; MOMENT: what
 *  the fit of an affine field needs. */
template <int DIM, Shape SHAPE, bool STENCIL, bool MOMENT> struct Domains {
  using V = Vec<REGISTER>;
  using Domain = PointDomain<DIM>;
  static constexpr int N = 1 << DIM;
  static constexpr int ROW = SHAPE == CPDI ? DIM * DIM : N * DIM;
  alignas(64) double in[ROW][GROUP];
  alignas(64) double center[DIM][GROUP];    ///< in space
  alignas(64) double place[DIM][GROUP];     ///< and in the tile
  alignas(64) double x[N * DIM][GROUP];     ///< corners relative to the center
  alignas(64) double wg[N][GROUP][4];       ///< weight and its gradient
  alignas(64) double f[N * DIM][GROUP];     ///< of corners from their base nodes, in node spacings
  int corner[N][GROUP];                     ///< base node of the corner, index in the tile
  alignas(64) double low[DIM][GROUP], high[DIM][GROUP];    ///< extreme base nodes of corners

  // Stencil: its first node, index of that in the tile, index of base nodes of corners in it;
  // weights of nodes along the last axis, and their products along the others
  alignas(64) double start[DIM][GROUP];
  int place_of_start[GROUP], number[N][GROUP];
  alignas(64) double line[N][2][GROUP], plane[N][N / 2][GROUP];
  alignas(64) double wide[GROUP];    ///< 1: a corner reaches other nodes

  // Moment: base nodes of corners relative to the center, and the inverse of the second moment of
  // the weights, in node spacings
  static constexpr int OFFSETS = MOMENT ? N * DIM : 1, MOMENTS = MOMENT ? Domain::symmetric : 1;
  alignas(64) double offset[OFFSETS][GROUP], inverse[MOMENTS][GROUP];

  /** The n points from p on. Returns true when weights are not positive. */
  __attribute__((noinline)) bool set(const PointRows &points, Index p, int n,
                                     const TileFrame &frame)
  {
    for (int l = 0; l < GROUP; l++) {
      const Index i = p + (l < n ? l : n - 1);
      const double *row = points.domain + ROW * i;
      MPM_UNROLL
      for (int k = 0; k < ROW; k++) in[k][l] = row[k];
      MPM_UNROLL
      for (int d = 0; d < DIM; d++) center[d][l] = points.x[3 * i + d];
    }
    V bad{};
    for (int l = 0; l < GROUP; l += REGISTER) {
      V a[ROW], g[N * DIM], w[N], size;
      MPM_UNROLL
      for (int k = 0; k < ROW / DIM; k++) {
        MPM_UNROLL
        for (int d = 0; d < DIM; d++) a[DIM * k + d] = V::load(in[DIM * k + d] + l);
      }
      if constexpr (SHAPE == CPDI) {
        V corners[N * DIM];
        size = PointDomain<DIM>::box(a, corners, g);
        MPM_UNROLL
        for (int k = 0; k < N; k++) {
          w[k] = V::all(1.0 / N);
          MPM_UNROLL
          for (int d = 0; d < DIM; d++) corners[DIM * k + d].store(x[DIM * k + d] + l);
        }
      } else {
        size = PointDomain<DIM>::free(a, w, g);
        MPM_UNROLL
        for (int d = 0; d < DIM; d++) {
          V shift = w[0] * a[d];
          MPM_UNROLL
          for (int k = 1; k < N; k++) shift += w[k] * a[DIM * k + d];
          // a domain without size has no weights: its corners stay where they are
          const V cells = frame.inv_h * shift;
          shift = unless(flag_outside(V{}, cells * cells, 1.0e10), shift);
          (V::load(center[d] + l) + shift).store(center[d] + l);
          MPM_UNROLL
          for (int k = 0; k < N; k++) (a[DIM * k + d] - shift).store(x[DIM * k + d] + l);
        }
        V least = w[0];
        MPM_UNROLL
        for (int k = 1; k < N; k++) least = min(least, w[k]);
        bad = flag_outside(bad, least, 1.0e300);
      }
      bad = flag_outside(bad, size, 1.0e300);
      MPM_UNROLL
      for (int k = 0; k < N; k++)
        store_as_rows<REGISTER>(
            {w[k], g[DIM * k], g[DIM * k + 1], DIM == 3 ? g[DIM * k + DIM - 1] : V{}}, wg[k][l]);
      locate(l, frame);
      if constexpr (MOMENT) find_moment(l, w, frame.inv_h);
    }
    double sum = 0.0;
    for (int l = 0; l < REGISTER; l++) sum += bad.lane(l);
    return sum != 0.0;
  }

 private:
  /** The moment D = sum_c w_c (x_c x_c^T + diag of f (1 - f)): that of linear functions about the
   *  corner x_c is f (1 - f) with its place f in the cell. */
  MPM_INLINE void find_moment(int l, const V *w, double inv_h)
  {
    V D[Domain::symmetric], inv[Domain::symmetric];
    MPM_UNROLL
    for (int k = 0; k < Domain::symmetric; k++) D[k] = V{};
    MPM_UNROLL
    for (int c = 0; c < N; c++) {
      V at[DIM];
      MPM_UNROLL
      for (int d = 0; d < DIM; d++) {
        const V place = V::load(f[DIM * c + d] + l);
        at[d] = inv_h * V::load(x[DIM * c + d] + l);
        (at[d] - place).store(offset[DIM * c + d] + l);
        D[d] += w[c] * (at[d] * at[d] + place * (1.0 - place));
        MPM_UNROLL
        for (int e = 0; e < d; e++) D[Domain::component(e, d)] += w[c] * (at[e] * at[d]);
      }
    }
    Domain::invert_symmetric(D, inv);
    MPM_UNROLL
    for (int k = 0; k < Domain::symmetric; k++) inv[k].store(inverse[k] + l);
  }

  /** Where the corners of a vector of points are. */
  MPM_INLINE void locate(int l, const TileFrame &frame)
  {
    constexpr double in_tile[3] = {domain_stride_x(DIM), domain_stride_y(DIM), 1.0};
    constexpr double in_stencil[3] = {DIM == 3 ? 48.0 : 16.0, DIM == 3 ? 16.0 : 8.0, 8.0};
    V index[N], near[N], first{}, reach{};
    int ints[REGISTER];
    MPM_UNROLL
    for (int d = 0; d < DIM; d++) {
      const V at = (V::load(center[d] + l) - frame.origin[d]) * frame.inv_h - frame.low[d];
      at.store(place[d] + l);
      V whole[N], least, most;
      MPM_UNROLL
      for (int k = 0; k < N; k++) {
        const V t = at + frame.inv_h * V::load(x[DIM * k + d] + l);
        whole[k] = truncate(t, ints);
        (t - whole[k]).store(f[DIM * k + d] + l);
        least = k ? min(least, whole[k]) : whole[k];
        most = k ? max(most, whole[k]) : whole[k];
        index[k] = d ? index[k] + in_tile[d] * whole[k] : in_tile[d] * whole[k];
      }
      least.store(low[d] + l);
      most.store(high[d] + l);
      if constexpr (STENCIL) {
        // three nodes from the start on are in the tile
        const V begin = min(least, V::all(domain_tile_side(DIM) - 3));
        MPM_UNROLL
        for (int k = 0; k < N; k++) {
          const V there = in_stencil[d] * (whole[k] - begin);
          near[k] = d ? near[k] + there : there;
        }
        first += in_tile[d] * begin;
        reach = max(reach, most - begin);
        begin.store(start[d] + l);
      }
    }
    MPM_UNROLL
    for (int k = 0; k < N; k++) truncate(index[k], corner[k] + l);
    if constexpr (STENCIL) {
      truncate(first, place_of_start + l);
      flag_outside(V{}, reach, 1.5).store(wide + l);
      MPM_UNROLL
      for (int k = 0; k < N; k++) {
        truncate(near[k], number[k] + l);
        const V fx = V::load(f[DIM * k] + l), last = V::load(f[DIM * k + DIM - 1] + l);
        (1.0 - last).store(line[k][0] + l);
        last.store(line[k][1] + l);
        if constexpr (DIM == 2) {
          (1.0 - fx).store(plane[k][0] + l);
          fx.store(plane[k][1] + l);
        } else {
          const V fy = V::load(f[DIM * k + 1] + l), gx = 1.0 - fx, gy = 1.0 - fy;
          (gx * gy).store(plane[k][0] + l);
          (gx * fy).store(plane[k][1] + l);
          (fx * gy).store(plane[k][N / 2 - 2] + l);
          (fx * fy).store(plane[k][N / 2 - 1] + l);
        }
      }
    }
  }
};

/** Adds w_n (q + i A_x + j A_y + k A_z) to the nodes n of a cell, i, j, k = 0, 1; fractions are a
 *  group apart. */
template <int DIM, bool AFFINE, int NREAL, int WIDTH>
MPM_INLINE void add_to_cell(double *node, const double *fraction, Vec<WIDTH> q, const Vec<WIDTH> *A)
{
  constexpr int sx = NREAL * domain_stride_x(DIM), sy = NREAL * domain_stride_y(DIM);
  const double f[3] = {fraction[0], fraction[GROUP], DIM == 3 ? fraction[2 * GROUP] : 0.0};
  MPM_UNROLL
  for (int i = 0; i < 2; i++) {
    const double wx = i ? f[0] : 1.0 - f[0];
    Vec<WIDTH> X = q;
    if (AFFINE && i) X += A[0];
    MPM_UNROLL
    for (int j = 0; j < 2; j++) {
      const double wy = wx * (j ? f[1] : 1.0 - f[1]);
      Vec<WIDTH> XY = X;
      if (AFFINE && j) XY += A[1];
      double *row = node + sx * i + sy * j;
      if constexpr (DIM == 2) {
        (Vec<WIDTH>::load(row) + wy * XY).store(row);
      } else {
        (Vec<WIDTH>::load(row) + (wy * (1.0 - f[2])) * XY).store(row);
        if (AFFINE) XY += A[2];
        row += NREAL;
        (Vec<WIDTH>::load(row) + (wy * f[2]) * XY).store(row);
      }
    }
  }
}

/** Interpolation between the nodes of a cell; fractions are a group apart. FACES: also on its upper
 *  faces. */
template <int DIM, int NREAL, bool FACES, int WIDTH>
MPM_INLINE Vec<WIDTH> in_cell(const double *node, const double *fraction, Vec<WIDTH> *face)
{
  using V = Vec<WIDTH>;
  const double f[3] = {fraction[0], fraction[GROUP], DIM == 3 ? fraction[2 * GROUP] : 0.0};
  constexpr int sx = NREAL * domain_stride_x(DIM), sy = NREAL * domain_stride_y(DIM);
  V plane[2], side[2], top[2];
  MPM_UNROLL
  for (int i = 0; i < 2; i++) {
    V line[2], above[2];
    MPM_UNROLL
    for (int j = 0; j < 2; j++) {
      const double *row = node + sx * i + sy * j;
      line[j] = V::load(row);
      if constexpr (DIM == 3) {
        above[j] = V::load(row + NREAL);
        line[j] += f[2] * (above[j] - line[j]);
      }
    }
    plane[i] = line[0] + f[1] * (line[1] - line[0]);
    if constexpr (FACES) {
      side[i] = line[1];
      if constexpr (DIM == 3) top[i] = above[0] + f[1] * (above[1] - above[0]);
    }
  }
  if constexpr (FACES) {
    face[0] = plane[1];
    face[1] = side[0] + f[0] * (side[1] - side[0]);
    if constexpr (DIM == 3) face[2] = top[0] + f[0] * (top[1] - top[0]);
  }
  return plane[0] + f[0] * (plane[1] - plane[0]);
}

/** Weights W and gradients G of a domain that reaches at most three nodes along each axis, at these
 *  nodes: what corners have in common is added up before it goes to the tile. A row of nodes along
 *  the last axis is two cells of two nodes: CPUs are slow to load what was just stored in two
 *  pieces. */
template <int DIM> struct Stencil {
  static constexpr int ROWS = DIM == 3 ? 9 : 3;
  alignas(64) double real[ROWS][16];    ///< [row][8 * cell + 4 * node + (W, G_x, G_y, G_z)]

  MPM_INLINE void clear()
  {
    for (int r = 0; r < ROWS; r++) {
      Vec<8>{}.store(real[r]);
      Vec<8>{}.store(real[r] + 8);
    }
  }

  /** Adds corner c of point l. */
  template <class Domains> MPM_INLINE void add(const Domains &domains, int c, int l)
  {
    double *const cell = real[0] + domains.number[c][l];
    const Vec<4> wg = Vec<4>::load(domains.wg[c][l]);
    const Vec<8> pair = join(domains.line[c][0][l] * wg, domains.line[c][1][l] * wg);
    MPM_UNROLL
    for (int n = 0; n < 1 << (DIM - 1); n++) {
      double *const node = cell + 16 * (DIM == 3 ? 3 * (n >> 1) + (n & 1) : n);
      (Vec<8>::load(node) + domains.plane[c][n][l] * pair).store(node);
    }
  }

  /** To the nodes from the lowest on: W (q + i A_x + j A_y + k A_z) + G_x S_x + G_y S_y + G_z
   *  S_z. */
  template <bool AFFINE, bool GRADIENT, int NREAL, int WIDTH>
  MPM_INLINE void scatter(double *lowest, Vec<WIDTH> q, const Vec<WIDTH> *A, const Vec<WIDTH> *S)
  {
    using V = Vec<WIDTH>;
    constexpr int tx = NREAL * domain_stride_x(DIM), ty = NREAL * domain_stride_y(DIM);
    MPM_UNROLL
    for (int r = 0; r < ROWS; r++)    // the node that both cells have
      (Vec<4>::load(real[r] + 4) + Vec<4>::load(real[r] + 8)).store(real[r] + 8);
    MPM_UNROLL
    for (int i = 0; i < 3; i++) {
      MPM_UNROLL
      for (int j = 0; j < ROWS / 3; j++) {
        const double *row = real[ROWS / 3 * i + j];
        double *node = lowest + tx * i + (DIM == 3 ? ty * j : 0);
        V Q = q;
        if (AFFINE && i) Q += double(i) * A[0];
        if (AFFINE && j) Q += double(j) * A[1];
        MPM_UNROLL
        for (int k = 0; k < 3; k++, node += NREAL) {
          const double *wg = row + (k ? 4 + 4 * k : 0);
          if (AFFINE && k) Q += A[DIM - 1];
          V sum = V::load(node) + wg[0] * Q;
          if constexpr (GRADIENT) {
            MPM_UNROLL
            for (int a = 0; a < DIM; a++) sum += wg[1 + a] * S[a];
          }
          sum.store(node);
        }
      }
    }
  }
};

/** P2G of the quantities PARTS. AFFINE: uses C. PIOLA: with P in place of tau. */
template <int DIM, Shape SHAPE, bool AFFINE, int NREAL, int PARTS, bool PIOLA = false>
void p2g(const PointRows &rows, const TransferStep &transfer, int first, int last,
         const int base[3], double *tile, int box[6])
{
  constexpr bool momentum = PARTS & MOMENTUM, force = PARTS & FORCE;
  constexpr bool both = NREAL == 8 && PARTS == ALL;
  constexpr int WIDTH = both ? 8 : 4;
  using V = Vec<WIDTH>;
  // copies, so that the compiler knows that no store changes them
  const PointRows points = rows;
  const TransferStep step = transfer;
  const TileFrame frame(step, base);
  double *const entry = tile + (NREAL == 8 && PARTS == FORCE ? 4 : 0);
  const double scale = NREAL == 4 ? step.dt : 1.0;
  Domains<DIM, SHAPE, true, false> domains;
  Stencil<DIM> stencil[GROUP];
  constexpr int N = domains.N;
  Vec<GROUP> lowest[DIM], highest[DIM];
  for (int d = 0; d < DIM; d++) {
    lowest[d] = Vec<GROUP>::all(1.0e6);
    highest[d] = Vec<GROUP>::all(-1.0e6);
  }

  for (Index p = first; p < last; p += GROUP) {
    const int n = last - p < GROUP ? last - p : GROUP;
    const Index ahead = p + AHEAD;
    prefetch<domains.ROW>(points.domain, ahead);
    prefetch<3>(points.x, ahead);
    prefetch_momentum_and_force<DIM, PARTS, AFFINE>(points, ahead, false);
    domains.set(points, p, n, frame);
    for (int d = 0; d < DIM; d++) {
      lowest[d] = min(lowest[d], Vec<GROUP>::load(domains.low[d]));
      highest[d] = max(highest[d], Vec<GROUP>::load(domains.high[d]));
    }
    // corner by corner: one addition to a stencil must not wait for the one before
    for (int l = 0; l < n; l++) stencil[l].clear();
    for (int c = 0; c < N; c++)
      for (int l = 0; l < n; l++)
        if (__builtin_expect(domains.wide[l] == 0.0, 1)) stencil[l].add(domains, c, l);
    for (int l = 0; l < n; l++) {
      const Index i = p + l;

      // momentum and force of the point, and their changes from node to node
      Vec<4> q{}, C[DIM] = {}, fq{}, T[DIM] = {};
      if constexpr (momentum) {
        const double m = points.mass[i], *v = points.v + 3 * i;
        q = quad(m * v[0], m * v[1], DIM == 3 ? m * v[2] : 0.0, m);
        if constexpr (AFFINE)
          for (int a = 0; a < DIM; a++)
            C[a] = (m * step.h) * strided<DIM, 1>(points.C + DIM * (DIM * i + a));
      }
      if constexpr (force) {
        fq = (scale * step.force_scale) * strided<DIM, 1>(points.f + 3 * i);
        const double factor = -scale * step.stress_scale * points.vol0[i];
        if constexpr (PIOLA) {
          MPM_UNROLL
          for (int a = 0; a < DIM; a++)
            T[a] = factor * strided<DIM, 1>(points.P + DIM * (DIM * i + a));
        } else {
          const double *t = points.tau + 6 * i;
          T[0] = factor * quad(t[0], t[3], DIM == 3 ? t[4] : 0.0, 0.0);
          T[1] = factor * quad(t[3], t[1], DIM == 3 ? t[5] : 0.0, 0.0);
          if constexpr (DIM == 3) T[2] = factor * quad(t[4], t[5], t[2], 0.0);
        }
      }
      V value, A[DIM], S[DIM];
      if constexpr (both)
        value = join(q, fq);
      else if constexpr (momentum && force)
        value = q + fq;
      else
        value = momentum ? q : fq;
      MPM_UNROLL
      for (int a = 0; a < DIM; a++) {
        if constexpr (both)
          A[a] = join(C[a], Vec<4>{}), S[a] = join(Vec<4>{}, T[a]);
        else
          A[a] = C[a], S[a] = T[a];
      }

      if (__builtin_expect(domains.wide[l] == 0.0, 1)) {
        if constexpr (AFFINE) {
          MPM_UNROLL
          for (int a = 0; a < DIM; a++) value += (domains.start[a][l] - domains.place[a][l]) * A[a];
        }
        stencil[l].template scatter<AFFINE, force, NREAL>(entry + NREAL * domains.place_of_start[l],
                                                          value, A, S);
        continue;
      }
      for (int c = 0; c < N; c++) {
        const double *const wg = domains.wg[c][l];
        V corner = value, wA[DIM];
        if constexpr (AFFINE)
          for (int a = 0; a < DIM; a++) {
            const int k = DIM * c + a;
            corner += (frame.inv_h * domains.x[k][l] - domains.f[k][l]) * A[a];
            wA[a] = wg[0] * A[a];
          }
        corner = wg[0] * corner;
        if constexpr (force)
          for (int a = 0; a < DIM; a++) corner += wg[1 + a] * S[a];
        add_to_cell<DIM, AFFINE, NREAL>(entry + NREAL * domains.corner[c][l],
                                        domains.f[DIM * c] + l, corner, wA);
      }
    }
  }

  for (int d = 0; d < DIM && first < last; d++)
    for (int l = 0; l < GROUP; l++) {
      const int low = static_cast<int>(lowest[d].lane(l)),
                high = static_cast<int>(highest[d].lane(l));
      if (low < box[d]) box[d] = low;
      if (high > box[3 + d]) box[3 + d] = high;
    }
}

/** Velocity gradient and, if UPDATE, G2P. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool UPDATE>
int g2p(const PointRows &rows, const TransferStep &transfer, int first, int last, const int base[3],
        const double *tile, double *L)
{
  constexpr bool increment = UPDATE && adds_change(TRANSFER),
                 affine = UPDATE && is_affine(TRANSFER);
  constexpr bool fit = affine && !is_gradient(SHAPE, TRANSFER);
  constexpr int WIDTH = increment ? 8 : 4;
  const PointRows points = rows;
  const TransferStep step = transfer;
  const TileFrame frame(step, base);
  Domains<DIM, SHAPE, false, fit> domains;
  constexpr int N = domains.N;
  bool bad = false;
  Vec<4> outside{};

  for (Index p = first; p < last; p += GROUP) {
    const int n = last - p < GROUP ? last - p : GROUP;
    const Index ahead = p + AHEAD;
    prefetch<domains.ROW, UPDATE && SHAPE == CPDI2>(points.domain, ahead);
    prefetch<3, UPDATE>(points.x, ahead);
    if (UPDATE) {
      prefetch<3, 1>(points.v, ahead);
      if (is_affine(TRANSFER)) prefetch<DIM * DIM, 1>(points.C, ahead);
    }
    if (points.F) {    // the constitutive law comes next
      prefetch<9, 1>(points.F, ahead);
      prefetch<6, 1>(points.tau, ahead);
      prefetch<1>(points.vol0, ahead);
    }
    bad |= domains.set(points, p, n, frame);
    for (int l = 0; l < n; l++) {
      const Index i = p + l;
      Vec<WIDTH> v{};
      Vec<4> gradient[DIM] = {}, B[DIM] = {}, at[N];
      MPM_UNROLL
      for (int c = 0; c < N; c++) {
        Vec<WIDTH> face[DIM];
        const Vec<WIDTH> here = in_cell<DIM, NREAL, fit>(tile + NREAL * domains.corner[c][l],
                                                         domains.f[DIM * c] + l, face);
        at[c] = first_four(here);
        const double *const wg = domains.wg[c][l];
        v += wg[0] * here;
        for (int a = 0; a < DIM; a++) gradient[a] += wg[1 + a] * at[c];
        if constexpr (fit) {    // B = sum_i N_ip v_i (x_i - x_p)^T
          MPM_UNROLL
          for (int a = 0; a < DIM; a++) {
            const int k = DIM * c + a;
            const Vec<4> upper = first_four(face[a]);
            B[a] += wg[0] * (domains.offset[k][l] * at[c] + domains.f[k][l] * upper);
          }
        }
      }

      if constexpr (fit) {
        for (int a = 0; a < DIM; a++) {
          Vec<4> C{};
          MPM_UNROLL
          for (int b = 0; b < DIM; b++)
            C += (frame.inv_h * domains.inverse[PointDomain<DIM>::component(a, b)][l]) * B[b];
          store_lanes<DIM>(points.C + DIM * (DIM * i + a), C);
        }
      } else if constexpr (affine) {
        for (int a = 0; a < DIM; a++) store_lanes<DIM>(points.C + DIM * (DIM * i + a), gradient[a]);
      }
      if (L)
        for (int a = 0; a < DIM; a++)
          store_lanes<DIM>(L + DIM * (DIM * (i - first) + a), gradient[a]);

      const Vec<4> mean = first_four(v);
      if (!UPDATE && points.velocity) store_lanes<DIM>(points.velocity + 3 * i, mean);
      Vec<4> add{};
      if constexpr (increment) add = step.flip * (strided<DIM, 1>(points.v + 3 * i) - half<1>(v));
      if constexpr (UPDATE) {
        // the point goes to its center if its corners may move along
        const bool stays = SHAPE == CPDI2 && !points.corners_new;
        const Vec<4> xnew = (stays ? strided<DIM, 1>(points.x + 3 * i)
                                   : strided<DIM, GROUP>(domains.center[0] + l)) +
            step.dt * mean;
        outside = flag_outside(outside, blend<DIM>(xnew - xnew, Vec<4>{}), 1.0);
        if (DIM == 2) points.xnew[3 * i + 2] = points.x[3 * i + 2];
        store_lanes<DIM>(points.xnew + 3 * i, xnew);
        store_lanes<DIM>(points.v + 3 * i, mean + add);
        if (SHAPE == CPDI2 && points.corners_new) {
          double *corner = points.corners_new + DIM * N * i;
          for (int c = 0; c < N; c++, corner += DIM)
            store_lanes<DIM>(
                corner, strided<DIM, GROUP>(domains.x[DIM * c] + l) + step.dt * (at[c] - mean));
        }
      }
    }
  }
  for (int a = 0; a < DIM; a++) bad = bad || outside.lane(a) != 0.0;
  return UPDATE && bad;
}

template <class C> TransferKernels domain_kernels()
{
  constexpr bool affine = is_affine(C::transfer);
  TransferKernels k = table_with_tiles<C>();
  k.p2g = p2g<C::dim, C::shape, affine, C::nreal, ALL>;
  k.p2g_momentum = p2g<C::dim, C::shape, affine, C::nreal, MOMENTUM>;
  k.p2g_force = p2g<C::dim, C::shape, false, C::nreal, FORCE>;
  k.g2p = g2p<C::dim, C::shape, C::transfer, C::nreal, true>;
  k.g2p_gradient = g2p<C::dim, C::shape, PIC, C::nreal, false>;
  return k;
}

/** Kernels for trial motions: forces from P, and gradients, with domains that do not change. */
template <class C> TransferKernels domain_trial_kernels()
{
  TransferKernels k = table_with_tiles<C>();
  k.p2g_force = p2g<C::dim, C::shape, false, C::nreal, FORCE, true>;
  k.g2p_gradient = g2p<C::dim, C::shape, PIC, C::nreal, false>;
  return k;
}

/** Those of a shape. */
template <Shape SHAPE> TransferKernels domain_kernels_of_shape(const KernelChoice &choice)
{
  return choose(choice, [](auto c) {
    if constexpr (c.shape == SHAPE && !c.total)
      return domain_kernels<decltype(c)>();
    else if constexpr (c.shape == SHAPE && c.nreal == 8)
      return domain_trial_kernels<decltype(c)>();
    else
      return TransferKernels();
  });
}

}    // namespace

/** Defines mpm_kernels_<name>_<isa>(), which makes the kernels of a shape. */
#define MPM_DOMAIN_KERNELS_OF_SHAPE(name, SHAPE)                                     \
  TransferKernels MPM_NS::MPM_OF_ISA(mpm_kernels_##name)(const KernelChoice &choice) \
  {                                                                                  \
    return domain_kernels_of_shape<SHAPE>(choice);                                   \
  }

#endif

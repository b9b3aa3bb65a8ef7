/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Fast transfers of points with convected domains (CPDI, CPDI2), see mpm_kernels_isa.cpp and
// mpm_domain.h. What they do is written plainly in mpm_kernels_domain_reference.cpp.
//
// Corners and their weights are made for a group of points side by side, then each corner is
// scattered or gathered as a point with a linear function would be.

#include "mpm_kernels_others.h"

#if !defined(__has_builtin)
#define __has_builtin(x) 0
#endif
#if __has_builtin(__builtin_shufflevector)

#include "mpm_kernels_transfer.h"

#include "mpm_domain.h"

namespace {

constexpr int GROUP = 8;    ///< points whose domains are prepared together
static_assert(GROUP % REGISTER == 0);

/** Four reals in a vector. */
MPM_INLINE Vec<4> quad(double a, double b, double c, double d)
{
  Vec<2> low, high;
  low.r = Raw<2, double>::Reals{a, b};
  high.r = Raw<2, double>::Reals{c, d};
  return join(low, high);
}

/** DIM reals that are STRIDE apart, and zeros. */
template <int DIM, int STRIDE> MPM_INLINE Vec<4> strided(const double *p)
{
  return quad(p[0], p[STRIDE], DIM == 3 ? p[2 * STRIDE] : 0.0, 0.0);
}

/** The domains of up to GROUP points; [.][point]. */
template <int DIM, Shape SHAPE> struct Domains {
  static constexpr int N = 1 << DIM;
  static constexpr int ROW = SHAPE == CPDI ? DIM * DIM : N * DIM;
  alignas(64) double in[ROW][GROUP];
  alignas(64) double shift[DIM][GROUP];    ///< of the center from the place of the point
  alignas(64) double x[N * DIM][GROUP];    ///< corners relative to the center
  alignas(64) double w[N][GROUP];
  alignas(64) double g[N * DIM][GROUP];

  /** The n points from p on. Returns true when weights are not positive. */
  __attribute__((noinline)) bool set(const double *domain, Index p, int n)
  {
    using V = Vec<REGISTER>;
    for (int l = 0; l < GROUP; l++) {
      const double *row = domain + ROW * (p + (l < n ? l : n - 1));
      for (int k = 0; k < ROW; k++) in[k][l] = row[k];
    }
    V bad{};
    for (int l = 0; l < GROUP; l += REGISTER) {
      V a[N * DIM], b[N * DIM], c[N];
      for (int k = 0; k < ROW; k++) a[k] = V::load(in[k] + l);
      if constexpr (SHAPE == CPDI) {
        V corner[N * DIM];
        bad = flag_outside(bad, PointDomain<DIM>::box(a, corner, b), 1.0e300);
        for (int k = 0; k < N * DIM; k++) corner[k].store(x[k] + l);
      } else {
        bad = flag_outside(bad, PointDomain<DIM>::free(a, c, b), 1.0e300);
        for (int d = 0; d < DIM; d++) {
          V center = c[0] * a[d];
          for (int k = 1; k < N; k++) center += c[k] * a[DIM * k + d];
          center.store(shift[d] + l);
          for (int k = 0; k < N; k++) (a[DIM * k + d] - center).store(x[DIM * k + d] + l);
        }
        for (int k = 0; k < N; k++) {
          bad = flag_outside(bad, c[k], 1.0e300);
          c[k].store(w[k] + l);
        }
      }
      for (int k = 0; k < N * DIM; k++) b[k].store(g[k] + l);
    }
    double sum = 0.0;
    for (int l = 0; l < REGISTER; l++) sum += bad.lane(l);
    return sum != 0.0;
  }

  MPM_INLINE double weight(int c, int l) const { return SHAPE == CPDI ? 1.0 / N : w[c][l]; }

  /** Place of the center of point l. */
  MPM_INLINE Vec<4> center(const double *row, int l) const
  {
    const Vec<4> place = strided<DIM, 1>(row);
    return SHAPE == CPDI ? place : place + strided<DIM, GROUP>(shift[0] + l);
  }
};

/** Where points and corners are in a tile, in node spacings from its first node. */
template <int DIM> struct TileFrame {
  Vec<4> origin, low;
  double inv_h;

  MPM_INLINE TileFrame(const TransferStep &step, const int *base) :
      origin(strided<DIM, 1>(step.origin)),
      low(quad(base[0], base[1], DIM == 3 ? base[2] : 0.0, 0.0)), inv_h(step.inv_h)
  {
  }

  MPM_INLINE Vec<4> position(Vec<4> x) const { return (x - origin) * inv_h - low; }
};

/** Index of a corner's base node in the tile; t becomes the whole part, fraction the rest. */
template <int DIM> MPM_INLINE Index base_index(Vec<4> &t, double *fraction)
{
  int index[4];
  const Vec<4> whole = truncate(t, index);
  (t - whole).store(fraction);
  t = whole;
  return index[0] * domain_stride_x(DIM) + index[1] * domain_stride_y(DIM) +
      (DIM == 3 ? index[2] : 0);
}

/** Adds w_n (q + i A_x + j A_y + k A_z) to the nodes n of a cell, i, j, k = 0, 1. */
template <int DIM, bool AFFINE, int NREAL, int WIDTH>
MPM_INLINE void add_to_cell(double *node, const double *f, Vec<WIDTH> q, const Vec<WIDTH> *A)
{
  constexpr int sx = NREAL * domain_stride_x(DIM), sy = NREAL * domain_stride_y(DIM);
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

/** Interpolation between the nodes of a cell. */
template <int DIM, int NREAL, int WIDTH>
MPM_INLINE Vec<WIDTH> in_cell(const double *node, const double *f)
{
  using V = Vec<WIDTH>;
  constexpr int sx = NREAL * domain_stride_x(DIM), sy = NREAL * domain_stride_y(DIM);
  V plane[2];
  MPM_UNROLL
  for (int i = 0; i < 2; i++) {
    V line[2];
    MPM_UNROLL
    for (int j = 0; j < 2; j++) {
      const double *row = node + sx * i + sy * j;
      line[j] = V::load(row);
      if constexpr (DIM == 3) line[j] += f[2] * (V::load(row + NREAL) - line[j]);
    }
    plane[i] = line[0] + f[1] * (line[1] - line[0]);
  }
  return plane[0] + f[0] * (plane[1] - plane[0]);
}

/** P2G of what PARTS says. */
template <int DIM, Shape SHAPE, bool AFFINE, int NREAL, int PARTS>
void p2g(const PointRows &rows, const TransferStep &transfer, int first, int last,
         const int base[3], double *tile, int box[6])
{
  constexpr bool momentum = PARTS & MOMENTUM, force = PARTS & FORCE, affine = AFFINE && momentum;
  constexpr bool both = NREAL == 8 && PARTS == ALL;
  constexpr int WIDTH = both ? 8 : 4;
  using V = Vec<WIDTH>;
  // copies, so that the compiler knows that no store changes them
  const PointRows points = rows;
  const TransferStep step = transfer;
  const TileFrame<DIM> frame(step, base);
  double *const entry = tile + (NREAL == 8 && PARTS == FORCE ? 4 : 0);
  const double scale = NREAL == 4 ? step.dt : 1.0;
  Domains<DIM, SHAPE> domains;
  constexpr int N = domains.N;
  Vec<4> lowest = Vec<4>::all(1.0e6), highest = Vec<4>::all(-1.0e6);

  for (Index p = first; p < last; p += GROUP) {
    const int n = last - p < GROUP ? last - p : GROUP;
    domains.set(points.domain, p, n);
    for (int l = 0; l < n; l++) {
      const Index i = p + l;
      const Vec<4> center = frame.position(domains.center(points.x + 3 * i, l));

      Vec<4> q{}, C[DIM], fq{}, T[DIM];
      if constexpr (momentum) {
        const double m = points.mass[i], *v = points.v + 3 * i;
        q = quad(m * v[0], m * v[1], DIM == 3 ? m * v[2] : 0.0, m);
        if constexpr (AFFINE)
          for (int a = 0; a < DIM; a++)
            C[a] = (m * step.h) * strided<DIM, 1>(points.C + DIM * (DIM * i + a));
      }
      if constexpr (force) {
        fq = (scale * step.force_scale) * strided<DIM, 1>(points.f + 3 * i);
        const double *t = points.tau + 6 * i;
        const double factor = -scale * step.stress_scale * points.vol0[i];
        T[0] = factor * quad(t[0], t[3], DIM == 3 ? t[4] : 0.0, 0.0);
        T[1] = factor * quad(t[3], t[1], DIM == 3 ? t[5] : 0.0, 0.0);
        if constexpr (DIM == 3) T[2] = factor * quad(t[4], t[5], t[2], 0.0);
      }

      for (int c = 0; c < N; c++) {
        double f[4];
        Vec<4> t = center + frame.inv_h * strided<DIM, GROUP>(domains.x[DIM * c] + l);
        lowest = min(lowest, t);
        highest = max(highest, t);
        double *const node = entry + NREAL * base_index<DIM>(t, f);

        const double w = domains.weight(c, l);
        Vec<4> corner = q, fc = w * fq;
        V A[DIM];
        if constexpr (affine) {
          const Vec<4> distance = t - center;
          corner += broadcast<0>(distance) * C[0] + broadcast<1>(distance) * C[1];
          if constexpr (DIM == 3) corner += broadcast<2>(distance) * C[2];
          for (int a = 0; a < DIM; a++) {
            if constexpr (both)
              A[a] = join(w * C[a], Vec<4>{});
            else
              A[a] = w * C[a];
          }
        }
        if constexpr (force)
          for (int a = 0; a < DIM; a++) fc += domains.g[DIM * c + a][l] * T[a];
        if constexpr (both)
          add_to_cell<DIM, affine, NREAL>(node, f, join(w * corner, fc), A);
        else if constexpr (momentum && force)
          add_to_cell<DIM, affine, NREAL>(node, f, w * corner + fc, A);
        else if constexpr (momentum)
          add_to_cell<DIM, affine, NREAL>(node, f, w * corner, A);
        else
          add_to_cell<DIM, affine, NREAL>(node, f, fc, A);
      }
    }
  }

  for (int a = 0; a < DIM && first < last; a++) {
    const int low = static_cast<int>(lowest.lane(a)), high = static_cast<int>(highest.lane(a));
    if (low < box[a]) box[a] = low;
    if (high > box[3 + a]) box[3 + a] = high;
  }
}

/** G2P and velocity gradient. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool UPDATE>
int gather(const PointRows &rows, const TransferStep &transfer, int first, int last,
           const int base[3], const double *tile, double *L)
{
  constexpr bool increment = UPDATE && adds_change(TRANSFER);
  constexpr int WIDTH = increment ? 8 : 4;
  const PointRows points = rows;
  const TransferStep step = transfer;
  const TileFrame<DIM> frame(step, base);
  Domains<DIM, SHAPE> domains;
  constexpr int N = domains.N;
  bool bad = false;
  Vec<4> outside{};

  for (Index p = first; p < last; p += GROUP) {
    const int n = last - p < GROUP ? last - p : GROUP;
    bad |= domains.set(points.domain, p, n);
    for (int l = 0; l < n; l++) {
      const Index i = p + l;
      const Vec<4> center = domains.center(points.x + 3 * i, l);
      const Vec<4> place = frame.position(center);
      Vec<WIDTH> v{};
      Vec<4> D[DIM] = {}, at[N];
      MPM_UNROLL
      for (int c = 0; c < N; c++) {
        double f[4];
        Vec<4> t = place + frame.inv_h * strided<DIM, GROUP>(domains.x[DIM * c] + l);
        const double *node = tile + NREAL * base_index<DIM>(t, f);
        const Vec<WIDTH> here = in_cell<DIM, NREAL, WIDTH>(node, f);
        if constexpr (increment)
          at[c] = half<0>(here);
        else
          at[c] = here;
        v += domains.weight(c, l) * here;
        for (int a = 0; a < DIM; a++) D[a] += domains.g[DIM * c + a][l] * at[c];
      }

      if (UPDATE && is_affine(TRANSFER))
        for (int a = 0; a < DIM; a++) store_lanes<DIM>(points.C + DIM * (DIM * i + a), D[a]);
      if (L)
        for (int a = 0; a < DIM; a++) store_lanes<DIM>(L + DIM * (DIM * (i - first) + a), D[a]);

      if constexpr (UPDATE) {
        Vec<4> mean, add{};
        if constexpr (increment) {
          mean = half<0>(v);
          add = step.flip * (strided<DIM, 1>(points.v + 3 * i) - half<1>(v));
        } else
          mean = v;
        // the point goes to its center if its corners may move along
        const bool stays = SHAPE == CPDI2 && !points.corners_new;
        const Vec<4> xnew = (stays ? strided<DIM, 1>(points.x + 3 * i) : center) + step.dt * mean;
        outside = flag_outside(outside, blend<DIM>(xnew - xnew, Vec<4>{}), 1.0);
        if (DIM == 2) points.xnew[3 * i + 2] = points.x[3 * i + 2];
        store_lanes<DIM>(points.xnew + 3 * i, xnew);
        store_lanes<DIM>(points.v + 3 * i, mean + add);
        if (SHAPE == CPDI2 && points.corners_new) {
          double *corner = points.corners_new + DIM * N * i;
          for (int c = 0; c < N; c++, corner += DIM)
            store_lanes<DIM>(corner, strided<DIM, GROUP>(domains.x[DIM * c] + l) +
                                 step.dt * (at[c] - mean));
        }
      }
    }
  }
  for (int a = 0; a < DIM; a++) bad = bad || outside.lane(a) != 0.0;
  return bad;
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL>
int g2p_gradient(const PointRows &points, const TransferStep &step, int first, int last,
                 const int base[3], const double *tile, double *L)
{
  gather<DIM, SHAPE, TRANSFER, NREAL, false>(points, step, first, last, base, tile, L);
  return 0;
}

/** Flush, load or prefetch, see tile_io(): whole sides of those blocks that the box touches. */
template <int DIM, int NREAL, TileMove MOVE>
void domain_tile_io(double *tile, double *nodes, const int slot[27], const int box[6])
{
  constexpr int side = block_side(DIM), last = DIM - 1;
  const int first = box[last] / side, end = (box[3 + last] + 1) / side;
  const int ylow = DIM == 3 ? box[1] : 0, yhigh = DIM == 3 ? box[4] + 1 : 0;
  for (int i = box[0]; i <= box[3] + 1; i++)
    for (int j = ylow; j <= yhigh; j++) {
      double *row = tile + NREAL * (i * domain_stride_x(DIM) + (DIM == 3 ? j * domain_stride_y(DIM) : 0));
      const int *block = slot + 9 * (i / side) + (DIM == 3 ? 3 * (j / side) : 1);
      const int index = DIM == 3 ? (i % side * side + j % side) * side : i % side * side;
      for (int b = first; b <= end; b++)
        move_reals<side * NREAL, MOVE>(row + NREAL * side * b,
                                       nodes + (Index(64) * block[DIM == 3 ? b : 3 * b] + index) * NREAL);
    }
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL> TransferKernels domain_kernels()
{
  constexpr bool affine = is_affine(TRANSFER);
  TransferKernels k;
  k.nreal = NREAL;
  k.margin = block_side(DIM);
  k.affine = affine;
  k.mls = false;
  k.p2g = p2g<DIM, SHAPE, affine, NREAL, ALL>;
  k.p2g_momentum = p2g<DIM, SHAPE, affine, NREAL, MOMENTUM>;
  k.p2g_force = p2g<DIM, SHAPE, affine, NREAL, FORCE>;
  k.g2p = gather<DIM, SHAPE, TRANSFER, NREAL, true>;
  k.g2p_gradient = g2p_gradient<DIM, SHAPE, TRANSFER, NREAL>;
  k.flush = domain_tile_io<DIM, NREAL, FLUSH>;
  k.load = domain_tile_io<DIM, NREAL, LOAD>;
  k.prefetch = domain_tile_io<DIM, NREAL, PREFETCH>;
  return k;
}

template <int DIM, Shape SHAPE> TransferKernels choose(Transfer transfer, bool split)
{
  switch (transfer) {
    case PIC:
      return domain_kernels<DIM, SHAPE, PIC, 8>();
    case FLIP:
      return domain_kernels<DIM, SHAPE, FLIP, 8>();
    case AFLIP:
      return domain_kernels<DIM, SHAPE, AFLIP, 8>();
    case APIC:    // the affine matrix is the gradient
    case TPIC:
      return split ? domain_kernels<DIM, SHAPE, TPIC, 8>() :
                     domain_kernels<DIM, SHAPE, TPIC, 4>();
  }
  return TransferKernels();
}

}    // namespace

TransferKernels MPM_NS::MPM_CONCAT(mpm_kernels_domain_, MPM_ISA)(int dim, Shape shape,
                                                                 Transfer transfer, bool split)
{
  if (dim == 3)
    return shape == CPDI ? choose<3, CPDI>(transfer, split) : choose<3, CPDI2>(transfer, split);
  return shape == CPDI ? choose<2, CPDI>(transfer, split) : choose<2, CPDI2>(transfer, split);
}

#endif

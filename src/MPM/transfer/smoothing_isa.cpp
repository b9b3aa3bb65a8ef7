/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Sums and values of linear fits around nodes, see SmoothingKernels; compiled once for each
// instruction set.

#include "transfer/kernels_isa.h"
#include "transfer/smoothing.h"

namespace MPM_NS {
SmoothingKernels MPM_OF_ISA(mpm_kernels_smoothing)(int dim, Shape);
}

#if !defined(MPM_HAVE_VECTORS)

MPM_NS::SmoothingKernels MPM_NS::MPM_OF_ISA(mpm_kernels_smoothing)(int, Shape)
{
  return {};
}

#else

#include "transfer/vector.h"

#include <algorithm>
#include <cstddef>

using namespace MPM_NS;

namespace {

using V = Vec<4>;

constexpr int POINTS_AT_A_TIME = 16;

/** Lanes x y z 1 become y z x 1. */
MPM_INLINE V turn(V a)
{
  return shuffle<1, 2, 0, 3>(a, a);
}

/** Lanes x y x 1, x y y 1. */
MPM_INLINE V xyx(V a)
{
  return shuffle<0, 1, 0, 3>(a, a);
}
MPM_INLINE V xyy(V a)
{
  return shuffle<0, 1, 1, 3>(a, a);
}

/** Places in a tile. Lanes that are no axis are zero. */
template <int DIM, int ORDER> struct FitFrame {
  static constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER),
                       sy = tile_stride_y(DIM, ORDER);
  /** Node about which places are taken: of the order of half a tile, so that sums of their squares
   *  about a node keep their digits. */
  static constexpr double middle = block_side(DIM) / 2 + 1,
                          from_middle = middle - BSpline<ORDER>::shift;
  V origin, inv_h, low;

  MPM_INLINE FitFrame(const TransferStep &step, const int *base)
  {
    alignas(32) double o[4] = {}, i[4] = {}, b[4] = {};
    for (int a = 0; a < DIM; a++) {
      o[a] = step.origin[a];
      i[a] = step.inv_h;
      b[a] = BSpline<ORDER>::shift + base[a];
    }
    origin = V::load(o);
    inv_h = V::load(i);
    low = V::load(b);
  }

  /** Weights w[node] of a point along the axes, in lanes; its base node in the tile, and its place
   *  x y z 1. Returns the place from the first node, less the shift of the functions. */
  MPM_INLINE V locate(const PointRows &points, int p, double (*w)[4], int *node, V &x) const
  {
    const double *const at = points.x + 3 * static_cast<std::ptrdiff_t>(p);
    const V position = p < points.guarded ? V::load(at) : quad(at[0], at[1], at[2], 0.0);
    // not negative: a tile begins one node before its block
    const V t = (position - origin) * inv_h - low;
    const V f = t - truncate(t, node);
    V weights[N];
    BSpline<ORDER>::weights(f, weights);
    MPM_UNROLL
    for (int k = 0; k < N; k++) weights[k].store(w[k]);
    x = blend<3>(t - quad(from_middle, from_middle, DIM == 3 ? from_middle : 0.0, 0.0),
                 V::all(1.0));
    return t;
  }
  static MPM_INLINE int place(const int *node)
  {
    return node[0] * sx + node[1] * sy + (DIM == 3 ? node[2] : 0);
  }
};

/** A point ready to be added: its products, and the weights of rows of nodes along the last
 *  axis. */
template <int DIM, int ORDER> struct FitPoint {
  static constexpr int N = ORDER + 1, NROW = DIM == 3 ? N * N : N, VECTORS = fit_width(DIM) / 4;
  alignas(32) double m[4 * VECTORS];
  alignas(32) double w[NROW][4];
  int place;

  /** Of the weights along axis a. */
  static MPM_INLINE V along(const double (*weight)[4], int a)
  {
    return quad(weight[0][a], weight[1][a], N > 2 ? weight[2][a] : 0.0, N > 3 ? weight[3][a] : 0.0);
  }

  /** Returns what FitFrame::locate() does. */
  MPM_INLINE V prepare(const PointRows &points, double q, int p, const FitFrame<DIM, ORDER> &frame)
  {
    alignas(32) double weight[4][4], plane[4];
    int node[4];
    V x;
    const V t = frame.locate(points, p, weight, node, x);
    place = frame.place(node);
    if constexpr (DIM == 2) {
      const V last = along(weight, 1);
      MPM_UNROLL
      for (int i = 0; i < N; i++) (weight[i][0] * last).store(w[i]);
    } else {
      const V middle = along(weight, 1), last = along(weight, 2);
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        (weight[i][0] * middle).store(plane);
        MPM_UNROLL
        for (int j = 0; j < N; j++) (plane[j] * last).store(w[N * i + j]);
      }
    }
    const V first = points.vol0[p] * x;
    first.store(m);
    if constexpr (DIM == 2) {
      (xyx(first) * xyy(x)).store(m + 4);
    } else {
      (first * x).store(m + 4);
      (first * turn(x)).store(m + 8);
    }
    (q * first).store(m + fit_place(DIM));
    return t;
  }
};

/** Adds points with one base node; vectors [BEGIN,END) of the records, as many as there are
 *  registers for. */
template <int DIM, int ORDER, int BEGIN, int END>
MPM_INLINE void add_row(const FitPoint<DIM, ORDER> *point, int n, int row, double *at)
{
  constexpr int N = ORDER + 1, WIDTH = fit_width(DIM);
  V sum[N][END - BEGIN];
  MPM_UNROLL
  for (int k = 0; k < N; k++) {
    MPM_UNROLL
    for (int v = BEGIN; v < END; v++) sum[k][v - BEGIN] = V::load(at + WIDTH * k + 4 * v);
  }
  for (int p = 0; p < n; p++) {
    const double *const w = point[p].w[row];
    MPM_UNROLL
    for (int v = BEGIN; v < END; v++) {
      const V m = V::load(point[p].m + 4 * v);
      MPM_UNROLL
      for (int k = 0; k < N; k++) sum[k][v - BEGIN] += w[k] * m;
    }
  }
  MPM_UNROLL
  for (int k = 0; k < N; k++) {
    MPM_UNROLL
    for (int v = BEGIN; v < END; v++) sum[k][v - BEGIN].store(at + WIDTH * k + 4 * v);
  }
}

template <int DIM, int ORDER>
void fit(const PointRows &rows, const double *q, const TransferStep &step, int first, int last,
         const int base[3], double *tile, int *box)
{
  constexpr int N = ORDER + 1, WIDTH = fit_width(DIM), VECTORS = WIDTH / 4;
  const PointRows points = rows;
  const FitFrame<DIM, ORDER> frame(step, base);
  FitPoint<DIM, ORDER> point[POINTS_AT_A_TIME];
  V low = V::all(1.0e300), high = V::all(-1.0e300);
  for (int start = first; start < last; start += POINTS_AT_A_TIME) {
    const int n = std::min(POINTS_AT_A_TIME, last - start);
    for (int p = 0; p < n; p++) {
      const V t = point[p].prepare(points, q[start + p], start + p, frame);
      low = min(low, t);
      high = max(high, t);
    }
    for (int p = 0, next; p < n; p = next) {
      for (next = p + 1; next < n && point[next].place == point[p].place;) next++;
      double *const at = tile + WIDTH * point[p].place;
      for (int row = 0; row < FitPoint<DIM, ORDER>::NROW; row++) {
        const int to = DIM == 3 ? row / N * frame.sx + row % N * frame.sy : row * frame.sx;
        if constexpr (N * VECTORS > 9) {
          add_row<DIM, ORDER, 0, VECTORS / 2>(point + p, next - p, row, at + WIDTH * to);
          add_row<DIM, ORDER, VECTORS / 2, VECTORS>(point + p, next - p, row, at + WIDTH * to);
        } else
          add_row<DIM, ORDER, 0, VECTORS>(point + p, next - p, row, at + WIDTH * to);
      }
    }
  }
  if (first >= last) return;
  int node[4];
  truncate(low, node);
  for (int a = 0; a < DIM; a++) box[a] = std::min(box[a], node[a]);
  truncate(high, node);
  for (int a = 0; a < DIM; a++) box[3 + a] = std::max(box[3 + a], node[a]);
}

template <int DIM, int ORDER>
void evaluate(const PointRows &rows, double *q, const TransferStep &step, int first, int last,
              const int base[3], const double *tile)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  const PointRows points = rows;
  const FitFrame<DIM, ORDER> frame(step, base);
  for (int p = first; p < last; p++) {
    alignas(32) double w[4][4];
    int node[4];
    V x;
    frame.locate(points, p, w, node, x);
    const double *const at = tile + 4 * frame.place(node);
    V sum = V{};
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V line = V{};
      MPM_UNROLL
      for (int j = 0; j < N; j++) {
        const double *const row = at + 4 * (i * sx + j * sy);
        if constexpr (DIM == 3) {
          V cells = V{};
          MPM_UNROLL
          for (int k = 0; k < N; k++) cells += w[k][2] * V::load(row + 4 * k);
          line += w[j][1] * cells;
        } else {
          line += w[j][1] * V::load(row);
        }
      }
      sum += w[i][0] * line;
    }
    sum = sum * x;
    q[p] = sum.lane(0) + sum.lane(1) + sum.lane(2) + sum.lane(3);
  }
}

/** Calls f(place in the tile, record, distance from the middle) for the nodes that base nodes in
 *  the box reach; record: negative where the block is not active, as nothing in the tile is
 *  there. */
template <int DIM, int ORDER, class F>
MPM_INLINE void visit_tile(const int *slot, const int *box, const F &f)
{
  using Frame = FitFrame<DIM, ORDER>;
  using Index = std::ptrdiff_t;
  constexpr int side = block_side(DIM), NODES = 64, LAST = DIM - 1;
  // of the three blocks along an axis, and the place in it; a tile begins one node before its block
  const auto part = [](int node) {
    return (node - 1 + side) / side;
  };
  const auto inside = [](int node) {
    return (node - 1 + side) % side;
  };
  const int ylow = DIM == 3 ? box[1] : 0, yhigh = DIM == 3 ? box[4] + ORDER : 0;
  const int first = box[LAST], last = box[3 + LAST] + ORDER;
  const V along_last = DIM == 3 ? quad(0.0, 0.0, 1.0, 0.0) : quad(0.0, 1.0, 0.0, 0.0);
  for (int x = box[0]; x <= box[3] + ORDER; x++)
    for (int y = ylow; y <= yhigh; y++) {
      const int *const blocks = slot + 9 * part(x) + (DIM == 3 ? 3 * part(y) : 0);
      const int node = (DIM == 3 ? inside(x) * side + inside(y) : inside(x)) * side;
      const int row = x * Frame::sx + y * Frame::sy;
      V r = DIM == 3 ? quad(x - Frame::middle, y - Frame::middle, first - Frame::middle, 0.0)
                     : quad(x - Frame::middle, first - Frame::middle, 0.0, 0.0);
      for (int z = first; z <= last;) {
        const int which = DIM == 3 ? blocks[part(z)] : blocks[3 * part(z) + 1];
        const int end = std::min(last, part(z) * side);
        const Index record = static_cast<Index>(NODES) * which + node + inside(z) - z;
        for (; z <= end; z++, r += along_last) f(row + z, which < 0 ? -1 : record + z, r);
      }
    }
}

/** From sums about the middle to sums about the node at r from it. */
template <int DIM, int ORDER>
void flush(double *tile, double *sums, const int slot[27], const int box[6])
{
  constexpr int WIDTH = fit_width(DIM), FIT = fit_place(DIM);
  visit_tile<DIM, ORDER>(slot, box, [=](int place, std::ptrdiff_t record, V r) {
    double *const from = tile + WIDTH * static_cast<std::ptrdiff_t>(place);
    if (record < 0) return;
    double *const to = sums + WIDTH * record;
    const V old = V::load(from), first = old - broadcast<3>(old) * r;
    const V fit = V::load(from + FIT), fitted = fit - broadcast<3>(fit) * r;
    V squares = V::load(from + 4);
    if constexpr (DIM == 2) {
      squares = squares - xyx(r) * xyy(old) - xyy(r) * xyx(first);
    } else {
      squares = squares - r * (old + first);
      const V products = V::load(from + 8) - r * turn(old) - turn(r) * first;
      (V::load(to + 8) + products).store(to + 8);
      V{}.store(from + 8);
    }
    (V::load(to) + first).store(to);
    (V::load(to + 4) + squares).store(to + 4);
    (V::load(to + FIT) + fitted).store(to + FIT);
    V{}.store(from);
    V{}.store(from + 4);
    V{}.store(from + FIT);
  });
}

/** The value of a fit at the middle in place of that at its node. */
template <int DIM, int ORDER>
void load(double *tile, const double *sums, const int slot[27], const int box[6])
{
  constexpr int WIDTH = fit_width(DIM), FIT = fit_place(DIM);
  visit_tile<DIM, ORDER>(slot, box, [=](int place, std::ptrdiff_t record, V r) {
    V fit = V{};
    if (record >= 0) {
      fit = V::load(sums + WIDTH * record + FIT);
      const V change = fit * r;
      const double by = change.lane(0) + change.lane(1) + (DIM == 3 ? change.lane(2) : 0.0);
      fit = fit - quad(0.0, 0.0, 0.0, by);
    }
    fit.store(tile + 4 * static_cast<std::ptrdiff_t>(place));
  });
}

}    // namespace

SmoothingKernels MPM_NS::MPM_OF_ISA(mpm_kernels_smoothing)(int dim, Shape shape)
{
  if (shape != LINEAR && shape != QUADRATIC && shape != CUBIC) return {};
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC>(shape, [&](auto s) {
      constexpr int ORDER = stencil_order(decltype(s)::value);
      return SmoothingKernels{fit<DIM, ORDER>, flush<DIM, ORDER>, load<DIM, ORDER>,
                              evaluate<DIM, ORDER>};
    });
  });
}

#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Transfers of one number, see ScalarKernels; compiled once for each instruction set.
//
// To nodes, a vector holds up to four nodes along the last axis. To points, it holds points in a
// row that share their first node, and each node is a number for all of them: as many instructions
// for four or eight points as for one.

#include "transfer/kernels_isa.h"
#include "transfer/scalar.h"

namespace MPM_NS {
ScalarKernels MPM_OF_ISA(mpm_kernels_scalar)(int dim, Shape);
}

#if !defined(MPM_HAVE_VECTORS)

MPM_NS::ScalarKernels MPM_NS::MPM_OF_ISA(mpm_kernels_scalar)(int, Shape)
{
  return {};
}

#else

#include "transfer/kernels_fast.h"

namespace {

using V = Vec<4>;

/** Brings rows of three reals of four points into the cache, which may not exist. */
MPM_INLINE void prefetch_points(const double *rows, Index p)
{
  const std::uintptr_t start = reinterpret_cast<std::uintptr_t>(rows) + 3 * sizeof(double) * p;
  __builtin_prefetch(reinterpret_cast<const void *>(start));
  __builtin_prefetch(reinterpret_cast<const void *>(start + 64));
}

/** Three reals of rows of four points from the given one on, axis by axis. Behind the last point
 *  there are others like it, and there may be no memory behind the last row. */
MPM_INLINE void load_points(const double *rows, Index p, Index n, Index guarded, V *axis)
{
  if (p + 4 <= n && p + 4 <= guarded) {
    MPM_UNROLL
    for (int k = 0; k < 4; k++) axis[k] = V::load(rows + 3 * (p + k));
  } else {
    MPM_UNROLL
    for (int k = 0; k < 4; k++) {
      const Index q = p + k < n ? p + k : n - 1;
      const double *const at = rows + 3 * q;
      axis[k] = q < guarded ? V::load(at) : quad(at[0], at[1], at[2], 0.0);
    }
  }
  transpose(axis);
}

/** Node MIDDLE along an axis, whose weight is never small, has what the others leave: weights sum
 *  to one, and slopes to zero. Points that share their nodes then have one node less, and the
 *  gradient of a constant is exactly zero. Linear functions and Bernstein polynomials have no such
 *  node. */
constexpr int MIDDLE = 1;
template <Shape SHAPE>
constexpr bool has_middle = SHAPE == QUADRATIC || SHAPE == CUBIC || SHAPE == GIMP;

/** Weights of all points at a node along an axis. */
using Columns = double (*)[BATCH + SPARE_ROWS];

/** Stores the weights of four points along an axis; LESS: none of node MIDDLE but in the rows of
 *  the last one. */
template <int N, bool LAST, bool LESS>
MPM_INLINE void store_weights(const V *weight, Index p, double (*rows)[4], Columns columns)
{
  if constexpr (LAST) {
    V w[4] = {};
    MPM_UNROLL
    for (int k = 0; k < N; k++) w[k] = weight[k];
    transpose(w);
    MPM_UNROLL
    for (int k = 0; k < 4; k++) w[k].store(rows[p + k]);
  }
  MPM_UNROLL
  for (int k = 0; k < N; k++)
    if (!LESS || k != MIDDLE) weight[k].store(columns[k] + p);
}

/** unit: what a node spacing is in distances. */
template <int DIM, Shape SHAPE, SlopeKind KIND, bool BOX>
void prepare_kind(const PointRows &rows, const TransferStep &transfer, int n, const int base[3],
                  double unit, ScalarStencil &out, int *box)
{
  using Function = FunctionOf<SHAPE>;
  constexpr bool less = has_middle<SHAPE> && KIND != ABSOLUTE_SLOPES;
  constexpr int N = Function::nodes, CELL = Function::cell;
  constexpr int strides[3] = {stride<DIM, SHAPE>(0), stride<DIM, SHAPE>(1), 1};
  const PointRows points = rows;
  const TransferStep step = transfer;
  double lowest[3] = {1.0e6, 1.0e6, 1.0e6}, highest[3] = {-1.0e6, -1.0e6, -1.0e6};
  V low[DIM], high[DIM];
  int before[3] = {0, 0, 0};
  double shift[3];
  for (int a = 0; a < DIM; a++) {
    low[a] = V::all(1.0e6);
    high[a] = V::all(-1.0e6);
    before[a] = base[a] & (CELL - 1);
    shift[a] = Function::shift + (base[a] - before[a]) / CELL;
  }
  out.n = n;
  out.kind = KIND;
  for (Index p = 0; p < n; p += 4) {
    V x[4], size[4];
    prefetch_points(points.x, p + AHEAD);
    if constexpr (Function::has_size) prefetch_points(points.size, p + AHEAD);
    load_points(points.x, p, n, points.guarded, x);
    if constexpr (Function::has_size) load_points(points.size, p, n, points.guarded, size);
    int place[4] = {0, 0, 0, 0};
    const auto along = [&](auto which) {
      constexpr int a = decltype(which)::value;
      constexpr bool is_last = a == DIM - 1;
      V t = (x[a] - V::all(step.origin[a])) * (step.inv_h / CELL) - shift[a];
      // as position_inside() of kernels_points.h
      if constexpr (CELL > 1) t = max(t, V::all(before[a] ? 1.0 : 0.0));
      if constexpr (BOX) {
        low[a] = min(low[a], t);
        high[a] = max(high[a], t);
      }
      int cell[4];
      V fraction = t - truncate(t, cell);
      if constexpr (Function::order == 1) fraction = max(fraction, V::all(SMALLEST_FRACTION));
      MPM_UNROLL
      for (int k = 0; k < 4; k++) place[k] += (CELL * cell[k] - before[a]) * strides[a];
      V w[N];
      [[maybe_unused]] V d[N];
      if constexpr (Function::has_size)
        Function::weights(fraction, size[a], w);
      else
        Function::weights(fraction, w);
      store_weights<N, is_last, less>(w, p, out.last_w, out.w[a]);
      if constexpr (KIND == DISTANCE_SLOPES) {
        const V distance = CELL == 1 ? unit * (fraction + Function::shift)
                                     : (CELL * unit) * fraction;
        MPM_UNROLL
        for (int k = 0; k < N; k++) d[k] = w[k] * (V::all(k * unit) - distance);
      } else if constexpr (KIND != NO_SLOPES) {
        if constexpr (Function::has_size)
          Function::gradients(fraction, size[a], d);
        else
          Function::gradients(fraction, d);
        MPM_UNROLL
        for (int k = 0; k < N; k++) {
          d[k] = step.inv_h * d[k];
          if constexpr (KIND == ABSOLUTE_SLOPES) d[k] = max(d[k], -d[k]);
        }
      }
      if constexpr (KIND != NO_SLOPES)
        store_weights<N, is_last, less>(d, p, out.last_slope, out.slope[a]);
    };
    along(std::integral_constant<int, 0>());
    along(std::integral_constant<int, 1>());
    if constexpr (DIM == 3) along(std::integral_constant<int, 2>());
    MPM_UNROLL
    for (int k = 0; k < 4; k++) out.place[p + k] = place[k];
  }
  for (int a = 0; BOX && n > 0 && a < DIM; a++) {
    for (int k = 0; k < 4; k++) {
      lowest[a] = low[a].lane(k) < lowest[a] ? low[a].lane(k) : lowest[a];
      highest[a] = high[a].lane(k) > highest[a] ? high[a].lane(k) : highest[a];
    }
    const int first = CELL * static_cast<int>(lowest[a]) - before[a];
    const int last = CELL * static_cast<int>(highest[a]) - before[a];
    if (first < box[a]) box[a] = first;
    if (last > box[3 + a]) box[3 + a] = last;
  }
}

template <int DIM, Shape SHAPE, bool BOX>
void prepare_box(const PointRows &rows, const TransferStep &step, int n, const int base[3],
                 SlopeKind kind, ScalarStencil &out, int *box)
{
  const double unit = kind == FIT_SLOPES ? shape_constants[SHAPE].inv_moment * step.inv_h : step.h;
  if (kind == DISTANCE_SLOPES || kind == FIT_SLOPES)
    prepare_kind<DIM, SHAPE, DISTANCE_SLOPES, BOX>(rows, step, n, base, unit, out, box);
  else if (kind == GRADIENT_SLOPES)
    prepare_kind<DIM, SHAPE, GRADIENT_SLOPES, BOX>(rows, step, n, base, unit, out, box);
  else if (kind == NO_SLOPES)
    prepare_kind<DIM, SHAPE, NO_SLOPES, BOX>(rows, step, n, base, unit, out, box);
  else
    prepare_kind<DIM, SHAPE, ABSOLUTE_SLOPES, BOX>(rows, step, n, base, unit, out, box);
}

template <int DIM, Shape SHAPE>
void prepare(const PointRows &rows, const TransferStep &step, int n, const int base[3],
             SlopeKind kind, ScalarStencil &out, int *box)
{
  if (box)
    prepare_box<DIM, SHAPE, true>(rows, step, n, base, kind, out, box);
  else
    prepare_box<DIM, SHAPE, false>(rows, step, n, base, kind, out, box);
}

/** The rows of nodes of points that share the first one. Lanes without a node hold whatever follows
 *  in the tile. LESS: along the axes but the last one, nodes count as their difference from
 *  MIDDLE. */
template <int DIM, Shape SHAPE, bool LESS> struct NodeRows {
  static constexpr int N = FunctionOf<SHAPE>::nodes, M = DIM == 3 ? N : 1, LAST = DIM - 1;
  static constexpr int sx = stride<DIM, SHAPE>(0), sy = DIM == 3 ? stride<DIM, SHAPE>(1) : 0;
  static constexpr int X = MIDDLE, Y = DIM == 3 ? MIDDLE : 0;
  V row[N][M];

  /** Has node k no factor of its own? Constant where loops are unrolled. */
  static constexpr MPM_INLINE bool middle(int k) { return LESS && k == MIDDLE; }

  MPM_INLINE void load(const double *tile)
  {
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < M; j++) row[i][j] = V::load(tile + sx * i + sy * j);
    }
    if constexpr (LESS) {
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        MPM_UNROLL
        for (int j = 0; j < M; j++)
          if (j != Y) row[i][j] = row[i][j] - row[i][Y];
      }
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        MPM_UNROLL
        for (int j = 0; j < M; j++)
          if (i != X) row[i][j] = row[i][j] - row[X][j];
      }
    }
  }
  MPM_INLINE void clear()
  {
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < M; j++) row[i][j] = V{};
    }
  }
  MPM_INLINE void add_to(double *tile)
  {
    if constexpr (LESS) {
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        MPM_UNROLL
        for (int j = 0; j < M; j++)
          if (i != X) row[X][j] = row[X][j] - row[i][j];
      }
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        MPM_UNROLL
        for (int j = 0; j < M; j++)
          if (j != Y) row[i][Y] = row[i][Y] - row[i][j];
      }
    }
    // one after the other: lanes without a node are zero, and belong to other rows
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < M; j++) {
        double *const at = tile + sx * i + sy * j;
        (V::load(at) + row[i][j]).store(at);
      }
    }
  }
};

/** Calls f(first, last) for points in a row with the same first node. */
template <class F> MPM_INLINE void visit_same(const ScalarStencil &in, const F &f)
{
  for (int p = 0, next; p < in.n; p = next) {
    for (next = p + 1; next < in.n && in.place[next] == in.place[p];) next++;
    f(p, next);
  }
}

/** TIMES: all of a point counts times its factor. */
template <int DIM, Shape SHAPE, bool LESS, bool TIMES>
void add_rows(const ScalarStencil &in, const ScalarSource &source, double *tile)
{
  using Rows = NodeRows<DIM, SHAPE, LESS>;
  constexpr int N = Rows::N, M = Rows::M;
  const ScalarSource from = source;
  visit_same(in, [&](int first, int last) {
    Rows nodes;
    nodes.clear();
    for (int p = first; p < last; p++) {
      const double *const mine = from.slopes + from.slope_width * Index(p);
      const double value = from.values[from.value_width * Index(p)];
      V w = V::load(in.last_w[p]), s = V::load(in.last_slope[p]);
      if constexpr (TIMES) {
        w = from.factors[p] * w;
        s = from.factors[p] * s;
      }
      const V straight = value * w + mine[Rows::LAST] * s, along_x = mine[0] * w,
              along_y = mine[1] * w;
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        V plane = straight, aside = along_y;
        if (!Rows::middle(i)) {
          const double wx = in.w[0][i][p], sx = in.slope[0][i][p];
          plane = wx * straight + sx * along_x;
          aside = wx * along_y;
        }
        if constexpr (DIM == 2) {
          nodes.row[i][0] += plane;
        } else {
          MPM_UNROLL
          for (int j = 0; j < M; j++) {
            if (Rows::middle(j)) {
              nodes.row[i][j] += plane;
            } else {
              nodes.row[i][j] += in.w[1][j][p] * plane;
              nodes.row[i][j] += in.slope[1][j][p] * aside;
            }
          }
        }
      }
    }
    nodes.add_to(tile + in.place[first]);
  });
}

template <int DIM, Shape SHAPE> void add(const ScalarStencil &in, const double *q, double *tile)
{
  const ScalarSource from = {q, 4, q + 3, 4, nullptr};
  if (has_middle<SHAPE> && in.kind != ABSOLUTE_SLOPES)
    add_rows<DIM, SHAPE, has_middle<SHAPE>, false>(in, from, tile);
  else
    add_rows<DIM, SHAPE, false, false>(in, from, tile);
}

template <int DIM, Shape SHAPE>
void add_times(const ScalarStencil &in, const ScalarSource &from, double *tile)
{
  if (has_middle<SHAPE> && in.kind != ABSOLUTE_SLOPES)
    add_rows<DIM, SHAPE, has_middle<SHAPE>, true>(in, from, tile);
  else
    add_rows<DIM, SHAPE, false, true>(in, from, tile);
}

template <int DIM, Shape SHAPE>
void add_values(const ScalarStencil &in, const double *q, double *tile)
{
  using Rows = NodeRows<DIM, SHAPE, has_middle<SHAPE>>;
  constexpr int N = Rows::N, M = Rows::M;
  visit_same(in, [&](int first, int last) {
    Rows nodes;
    nodes.clear();
    for (int p = first; p < last; p++) {
      const V w = q[p] * V::load(in.last_w[p]);
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        const V plane = Rows::middle(i) ? w : in.w[0][i][p] * w;
        MPM_UNROLL
        for (int j = 0; j < M; j++) {
          if (DIM == 2 || Rows::middle(j))
            nodes.row[i][j] += plane;
          else
            nodes.row[i][j] += in.w[1][j][p] * plane;
        }
      }
    }
    nodes.add_to(tile + in.place[first]);
  });
}

/** Points in a vector, for a given number that is left: those that there are not have weights of
 *  other points, and anything comes out of them. */
template <int LANES, class F> MPM_INLINE void visit_lanes(int first, int last, const F &f)
{
  if constexpr (LANES > 4) {
    for (; last - first > 4; first += LANES) f(std::integral_constant<int, LANES>(), first);
  }
  for (; first < last; first += 4) f(std::integral_constant<int, 4>(), first);
}
constexpr int LANES = REGISTER > 4 ? REGISTER : 4;

/** The nodes of points that share the first one, one by one; LESS: along all axes as their
 *  difference from MIDDLE. */
template <int DIM, Shape SHAPE, bool LESS> struct NodeNumbers {
  using Rows = NodeRows<DIM, SHAPE, LESS>;
  static constexpr int N = Rows::N, M = Rows::M;
  alignas(32) double number[N][M][4];

  MPM_INLINE void load(const double *tile)
  {
    Rows rows;
    rows.load(tile);
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < M; j++) {
        const V row = rows.row[i][j];
        if constexpr (LESS)
          shuffle<0, 5, 2, 3>(row - broadcast<MIDDLE>(row), row).store(number[i][j]);
        else
          row.store(number[i][j]);
      }
    }
  }
};

/** Sums over the nodes of a line, of the weights (value) and slopes of points from p on. */
template <bool SLOPES, int N, bool LESS, int L>
MPM_INLINE void sum_line(const double *number, const ScalarStencil &in, int axis, int p,
                         Vec<L> &value, Vec<L> &slope)
{
  value = LESS ? Vec<L>::all(number[MIDDLE]) : Vec<L>{};
  slope = Vec<L>{};
  MPM_UNROLL
  for (int k = 0; k < N; k++) {
    if (LESS && k == MIDDLE) continue;
    value += number[k] * Vec<L>::load(in.w[axis][k] + p);
    if constexpr (SLOPES) slope += number[k] * Vec<L>::load(in.slope[axis][k] + p);
  }
}

/** Values at the points from p on, and SLOPES. */
template <int DIM, Shape SHAPE, bool LESS, bool SLOPES, int L>
MPM_INLINE void get_points(const NodeNumbers<DIM, SHAPE, LESS> &nodes, const ScalarStencil &in,
                           int p, Vec<L> &value, Vec<L> *slope)
{
  using Numbers = NodeNumbers<DIM, SHAPE, LESS>;
  using Rows = typename Numbers::Rows;
  using W = Vec<L>;
  constexpr int N = Numbers::N, M = Numbers::M, LAST = DIM - 1;
  // barrier: numbers are operands in memory, otherwise GCC has each of them in all lanes of a
  // register, and spills
  asm volatile("" : : "r"(nodes.number) : "memory");
  value = slope[0] = slope[1] = slope[2] = W{};
  MPM_UNROLL
  for (int i = 0; i < N; i++) {
    W plane = {}, aside = {}, up = {};
    if constexpr (DIM == 2) {
      sum_line<SLOPES, N, LESS>(nodes.number[i][0], in, LAST, p, plane, up);
    } else {
      MPM_UNROLL
      for (int j = 0; j < M; j++) {
        W line, along;
        sum_line<SLOPES, N, LESS>(nodes.number[i][j], in, LAST, p, line, along);
        if (Rows::middle(j)) {
          plane += line;
          up += along;
        } else {
          const W w = W::load(in.w[1][j] + p);
          plane += w * line;
          if constexpr (SLOPES) {
            up += w * along;
            aside += W::load(in.slope[1][j] + p) * line;
          }
        }
      }
    }
    if (Rows::middle(i)) {
      value += plane;
      slope[1] += aside;
      slope[2] += up;
    } else {
      const W w = W::load(in.w[0][i] + p);
      value += w * plane;
      if constexpr (SLOPES) {
        slope[0] += W::load(in.slope[0][i] + p) * plane;
        slope[1] += w * aside;
        slope[2] += w * up;
      }
    }
  }
  if constexpr (DIM == 2) {
    slope[1] = slope[2];
    slope[2] = W{};
  }
}

/** Points that share their nodes, where these are less than this number, are done one by one: what
 *  it takes to have nodes as numbers is for all of them. */
constexpr int FEW = 3;

/** Calls many(nodes, p, lanes) for points that share their nodes, several at a time, and few(first,
 *  last) for those that are too few for that, in the order of points: the lanes behind the last
 *  point of many() are of those that come next. The nodes of some groups of points come first, as
 *  those of a group would have to be waited for. */
template <int DIM, Shape SHAPE, bool LESS, class Many, class Few>
MPM_INLINE void visit_groups(const ScalarStencil &in, const double *tile, const Many &many,
                             const Few &few)
{
  constexpr int GROUPS = 8;
  NodeNumbers<DIM, SHAPE, LESS> nodes[GROUPS];
  int first[GROUPS + 1];
  for (int p = 0; p < in.n;) {
    int n = 0;
    for (; n < GROUPS && p < in.n; n++) {
      const int start = first[n] = p;
      for (p++; p < in.n && in.place[p] == in.place[start];) p++;
      if (p - start >= FEW) nodes[n].load(tile + in.place[start]);
    }
    first[n] = p;
    for (int g = 0; g < n; g++)
      if (first[g + 1] - first[g] < FEW)
        few(first[g], first[g + 1]);
      else
        visit_lanes<LANES>(first[g], first[g + 1], [&](auto lanes, int of) {
          many(nodes[g], of, lanes);
        });
  }
}

/** Sums of the lanes of four vectors. */
MPM_INLINE V sums(V a, V b, V c, V d)
{
  const V ab = shuffle<0, 4, 2, 6>(a, b) + shuffle<1, 5, 3, 7>(a, b);
  const V cd = shuffle<0, 4, 2, 6>(c, d) + shuffle<1, 5, 3, 7>(c, d);
  return shuffle<0, 1, 4, 5>(ab, cd) + shuffle<2, 3, 6, 7>(ab, cd);
}

template <int DIM, Shape SHAPE, bool LESS>
MPM_INLINE void get_rows_of_few(const ScalarStencil &in, const double *tile, int first, int last,
                                double *q)
{
  using Rows = NodeRows<DIM, SHAPE, LESS>;
  constexpr int N = Rows::N, M = Rows::M;
  Rows nodes;
  nodes.load(tile + in.place[first]);
  for (int p = first; p < last; p++) {
    V value = {}, along_x = {}, along_y = {};
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V plane = {}, aside = {};
      if constexpr (DIM == 2) {
        plane = nodes.row[i][0];
      } else {
        if (LESS) plane = nodes.row[i][Rows::Y];
        MPM_UNROLL
        for (int j = 0; j < M; j++)
          if (!Rows::middle(j)) {
            plane += in.w[1][j][p] * nodes.row[i][j];
            aside += in.slope[1][j][p] * nodes.row[i][j];
          }
      }
      if (Rows::middle(i)) {
        value += plane;
        along_y += aside;
      } else {
        value += in.w[0][i][p] * plane;
        along_x += in.slope[0][i][p] * plane;
        along_y += in.w[0][i][p] * aside;
      }
    }
    const V w = V::load(in.last_w[p]), s = V::load(in.last_slope[p]);
    if constexpr (DIM == 2)
      sums(along_x * w, value * s, V{}, value * w).store(q + 4 * p);
    else
      sums(along_x * w, along_y * w, value * s, value * w).store(q + 4 * p);
  }
}

template <int DIM, Shape SHAPE, bool LESS>
void get_rows(const ScalarStencil &in, const double *tile, double *q)
{
  const auto many = [&](const NodeNumbers<DIM, SHAPE, LESS> &nodes, int p, auto lanes) {
    constexpr int L = decltype(lanes)::value;
    Vec<L> value, slope[3];
    get_points<DIM, SHAPE, LESS, true>(nodes, in, p, value, slope);
    store_as_rows<L>({slope[0], slope[1], slope[2], value}, q + 4 * p);
  };
  const auto few = [&](int first, int last) {
    get_rows_of_few<DIM, SHAPE, LESS>(in, tile, first, last, q);
  };
  visit_groups<DIM, SHAPE, LESS>(in, tile, many, few);
}

template <int DIM, Shape SHAPE> void get(const ScalarStencil &in, const double *tile, double *q)
{
  if (has_middle<SHAPE> && in.kind != ABSOLUTE_SLOPES)
    get_rows<DIM, SHAPE, has_middle<SHAPE>>(in, tile, q);
  else
    get_rows<DIM, SHAPE, false>(in, tile, q);
}

template <int DIM, Shape SHAPE, bool LESS>
MPM_INLINE void get_values_of_few(const ScalarStencil &in, const double *tile, int first, int last,
                                  double *q)
{
  using Rows = NodeRows<DIM, SHAPE, LESS>;
  constexpr int N = Rows::N, M = Rows::M;
  Rows nodes;
  nodes.load(tile + in.place[first]);
  for (int p = first; p < last; p++) {
    V value = {};
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V plane = {};
      MPM_UNROLL
      for (int j = 0; j < M; j++) {
        if (DIM == 2 || Rows::middle(j))
          plane += nodes.row[i][j];
        else
          plane += in.w[1][j][p] * nodes.row[i][j];
      }
      if (Rows::middle(i))
        value += plane;
      else
        value += in.w[0][i][p] * plane;
    }
    const V sum = value * V::load(in.last_w[p]);
    const Vec<2> two = half<0>(sum) + half<1>(sum);
    q[p] = two.lane(0) + two.lane(1);
    // barrier: GCC 12 puts points together into vectors, wrongly (AVX2, cubic, 3d)
    asm volatile("" ::: "memory");
  }
}

template <int DIM, Shape SHAPE, bool LESS>
void get_numbers(const ScalarStencil &in, const double *tile, double *q)
{
  const auto many = [&](const NodeNumbers<DIM, SHAPE, LESS> &nodes, int p, auto lanes) {
    Vec<decltype(lanes)::value> value, slope[3];
    get_points<DIM, SHAPE, LESS, false>(nodes, in, p, value, slope);
    value.store(q + p);
  };
  const auto few = [&](int first, int last) {
    get_values_of_few<DIM, SHAPE, LESS>(in, tile, first, last, q);
  };
  visit_groups<DIM, SHAPE, LESS>(in, tile, many, few);
}

template <int DIM, Shape SHAPE>
void get_values(const ScalarStencil &in, const double *tile, double *q)
{
  if (has_middle<SHAPE> && in.kind != ABSOLUTE_SLOPES)
    get_numbers<DIM, SHAPE, has_middle<SHAPE>>(in, tile, q);
  else
    get_numbers<DIM, SHAPE, false>(in, tile, q);
}

/** Nothing over nothing is zero over one. */
void divide(double *sums, const double *weights, std::size_t n)
{
  using W = Vec<REGISTER>;
  const W none = {}, one = W::all(1.0);
  std::size_t k = 0;
  for (; k + REGISTER <= n; k += REGISTER) {
    const W weight = W::load(weights + k), sum = W::load(sums + k);
    const auto has = weight.r > none.r;
    const W above = {has ? sum.r : none.r}, below = {has ? weight.r : one.r};
    (above / below).store(sums + k);
  }
  for (; k < n; k++) sums[k] = weights[k] > 0.0 ? sums[k] / weights[k] : 0.0;
}

}    // namespace

ScalarKernels MPM_NS::MPM_OF_ISA(mpm_kernels_scalar)(int dim, Shape shape)
{
  if (shape == CPGIMP) shape = GIMP;
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC, GIMP, BERNSTEIN>(shape, [](auto s) {
      constexpr Shape SHAPE = decltype(s)::value;
      return ScalarKernels{prepare<DIM, SHAPE>,
                           add<DIM, SHAPE>,
                           add_times<DIM, SHAPE>,
                           add_values<DIM, SHAPE>,
                           get<DIM, SHAPE>,
                           get_values<DIM, SHAPE>,
                           tile_io<DIM, SHAPE, 1, FLUSH>,
                           tile_io<DIM, SHAPE, 1, LOAD>,
                           divide};
    });
  });
}

#endif

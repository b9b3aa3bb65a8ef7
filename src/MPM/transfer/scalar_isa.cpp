/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Transfers of one number, see ScalarKernels; compiled once for each instruction set.
//
// A vector holds up to four nodes along the last axis. Points in a row that share their first node have all rows of
// nodes in registers, from the first of them to the last.

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

/** Transposes vectors with a lane for each axis to one for each axis with a lane for each node. */
template <int N> MPM_INLINE void store_axes(const V *node, double (*axis)[4])
{
  const V third = N > 2 ? node[N > 2 ? 2 : 0] : V{}, last = N > 3 ? node[N > 3 ? 3 : 0] : V{};
  const V a = shuffle<0, 4, 2, 6>(node[0], node[1]);    // x0 x1 z0 z1
  const V b = shuffle<1, 5, 3, 7>(node[0], node[1]);    // y0 y1
  const V c = shuffle<0, 4, 2, 6>(third, last);
  const V d = shuffle<1, 5, 3, 7>(third, last);
  join(half<0>(a), half<0>(c)).store(axis[0]);
  join(half<0>(b), half<0>(d)).store(axis[1]);
  join(half<1>(a), half<1>(c)).store(axis[2]);
}

/** Three reals of a row; there may be no memory behind the last row. */
MPM_INLINE V load_three(const double *rows, Index p, Index guarded)
{
  const double *const at = rows + 3 * p;
  return p < guarded ? V::load(at) : quad(at[0], at[1], at[2], 0.0);
}

template <int DIM, Shape SHAPE>
void prepare(const PointRows &rows, const TransferStep &transfer, int n, const int base[3],
             SlopeKind kind, ScalarStencil &out, int *box)
{
  using Function = FunctionOf<SHAPE>;
  constexpr int N = Function::nodes;
  const PointRows points = rows;
  const TransferStep step = transfer;
  const ::Frame<DIM, SHAPE, 1> frame(step, base);
  V lowest = V::all(1.0e6), highest = V::all(-1.0e6);
  out.n = n;
  for (Index p = 0; p < n; p++) {
    const V t = frame.position(load_three(points.x, p, points.guarded));
    lowest = min(lowest, t);
    highest = max(highest, t);
    const V fraction = frame.locate(t, &out.place[p]);
    V w[N], d[N], size = {};
    if constexpr (Function::has_size) {
      size = load_three(points.size, p, points.guarded);
      Function::weights(fraction, size, w);
    } else {
      Function::weights(fraction, w);
    }
    store_axes<N>(w, out.w[p]);
    if (kind == DISTANCE_SLOPES) {
      const V distance = frame.distance(fraction);
      MPM_UNROLL
      for (int k = 0; k < N; k++) d[k] = step.h * (w[k] * (V::all(k) - distance));
    } else {
      if constexpr (Function::has_size)
        Function::gradients(fraction, size, d);
      else
        Function::gradients(fraction, d);
      MPM_UNROLL
      for (int k = 0; k < N; k++) d[k] = step.inv_h * d[k];
    }
    if (kind == ABSOLUTE_SLOPES) {
      MPM_UNROLL
      for (int k = 0; k < N; k++) d[k] = max(d[k], -d[k]);
    }
    store_axes<N>(d, out.slope[p]);
  }
  for (int a = 0; box && n > 0 && a < DIM; a++) {
    const int low = frame.node(a, static_cast<int>(lowest.lane(a)));
    const int high = frame.node(a, static_cast<int>(highest.lane(a)));
    if (low < box[a]) box[a] = low;
    if (high > box[3 + a]) box[3 + a] = high;
  }
}

/** The rows of nodes of points that share the first one. Lanes without a node hold whatever follows in the tile. */
template <int DIM, Shape SHAPE> struct NodeRows {
  static constexpr int N = FunctionOf<SHAPE>::nodes, M = DIM == 3 ? N : 1, LAST = DIM - 1;
  static constexpr int sx = stride<DIM, SHAPE>(0), sy = DIM == 3 ? stride<DIM, SHAPE>(1) : 0;
  V row[N][M];

  MPM_INLINE void load(const double *tile)
  {
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      MPM_UNROLL
      for (int j = 0; j < M; j++) row[i][j] = V::load(tile + sx * i + sy * j);
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
  MPM_INLINE void add_to(double *tile) const
  {
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

template <int DIM, Shape SHAPE> void add(const ScalarStencil &in, const double *q, double *tile)
{
  using Rows = NodeRows<DIM, SHAPE>;
  constexpr int N = Rows::N, M = Rows::M;
  visit_same(in, [&](int first, int last) {
    Rows nodes;
    nodes.clear();
    for (int p = first; p < last; p++) {
      const double *const mine = q + 4 * p;
      const V w = V::load(in.w[p][Rows::LAST]), s = V::load(in.slope[p][Rows::LAST]);
      const V across = mine[Rows::LAST] * s;
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        const double wx = in.w[p][0][i], sx = in.slope[p][0][i];
        const V plane = (mine[3] * wx + mine[0] * sx) * w + wx * across;
        if constexpr (DIM == 2) {
          nodes.row[i][0] += plane;
        } else {
          const V aside = (mine[1] * wx) * w;
          MPM_UNROLL
          for (int j = 0; j < M; j++)
            nodes.row[i][j] += in.w[p][1][j] * plane + in.slope[p][1][j] * aside;
        }
      }
    }
    nodes.add_to(tile + in.place[first]);
  });
}

template <int DIM, Shape SHAPE>
void add_values(const ScalarStencil &in, const double *q, double *tile)
{
  using Rows = NodeRows<DIM, SHAPE>;
  constexpr int N = Rows::N, M = Rows::M;
  visit_same(in, [&](int first, int last) {
    Rows nodes;
    nodes.clear();
    for (int p = first; p < last; p++) {
      const V w = q[p] * V::load(in.w[p][Rows::LAST]);
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        const V plane = in.w[p][0][i] * w;
        MPM_UNROLL
        for (int j = 0; j < M; j++) {
          if constexpr (DIM == 2)
            nodes.row[i][j] += plane;
          else
            nodes.row[i][j] += in.w[p][1][j] * plane;
        }
      }
    }
    nodes.add_to(tile + in.place[first]);
  });
}

/** Sums of the lanes of four vectors. */
MPM_INLINE V sums(V a, V b, V c, V d)
{
  const V ab = shuffle<0, 4, 2, 6>(a, b) + shuffle<1, 5, 3, 7>(a, b);
  const V cd = shuffle<0, 4, 2, 6>(c, d) + shuffle<1, 5, 3, 7>(c, d);
  return join(half<0>(ab) + half<1>(ab), half<0>(cd) + half<1>(cd));
}

template <int DIM, Shape SHAPE> void get(const ScalarStencil &in, const double *tile, double *q)
{
  using Rows = NodeRows<DIM, SHAPE>;
  constexpr int N = Rows::N, M = Rows::M;
  visit_same(in, [&](int first, int last) {
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
          MPM_UNROLL
          for (int j = 0; j < M; j++) {
            plane += in.w[p][1][j] * nodes.row[i][j];
            aside += in.slope[p][1][j] * nodes.row[i][j];
          }
          along_y += in.w[p][0][i] * aside;
        }
        value += in.w[p][0][i] * plane;
        along_x += in.slope[p][0][i] * plane;
      }
      const V w = V::load(in.w[p][Rows::LAST]), s = V::load(in.slope[p][Rows::LAST]);
      if constexpr (DIM == 2)
        sums(along_x * w, value * s, V{}, value * w).store(q + 4 * p);
      else
        sums(along_x * w, along_y * w, value * s, value * w).store(q + 4 * p);
    }
  });
}

template <int DIM, Shape SHAPE>
void get_values(const ScalarStencil &in, const double *tile, double *q)
{
  using Rows = NodeRows<DIM, SHAPE>;
  constexpr int N = Rows::N, M = Rows::M;
  visit_same(in, [&](int first, int last) {
    Rows nodes;
    nodes.load(tile + in.place[first]);
    for (int p = first; p < last; p++) {
      V value = {};
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        V plane = {};
        MPM_UNROLL
        for (int j = 0; j < M; j++) {
          if constexpr (DIM == 2)
            plane = nodes.row[i][j];
          else
            plane += in.w[p][1][j] * nodes.row[i][j];
        }
        value += in.w[p][0][i] * plane;
      }
      const V sum = value * V::load(in.w[p][Rows::LAST]);
      const Vec<2> two = half<0>(sum) + half<1>(sum);
      q[p] = two.lane(0) + two.lane(1);
    }
  });
}

/** Adds a tile's reals to those of the nodes and clears them, or loads them. */
template <int COUNT, bool FLUSHES> MPM_INLINE void move_some(double *mine, double *theirs)
{
  for (int k = 0; k < COUNT; k++)
    if (FLUSHES) {
      theirs[k] += mine[k];
      mine[k] = 0.0;
    } else {
      mine[k] = theirs[k];
    }
}

/** As tile_io() of other transfers. */
template <int DIM, Shape SHAPE, bool FLUSHES>
void move_tile(double *tile, double *nodes, const int slot[27], const int box[6])
{
  constexpr int ORDER = stencil_order(SHAPE), side = block_side(DIM);
  constexpr int sx = stride<DIM, SHAPE>(0), sy = stride<DIM, SHAPE>(1);
  const int low = box[DIM - 1], high = box[3 + DIM - 1] + ORDER;
  const int ylow = DIM == 3 ? box[1] : 0, yhigh = DIM == 3 ? box[4] + ORDER : 0;
  for (int i = box[0]; i <= box[3] + ORDER; i++)
    for (int j = ylow; j <= yhigh; j++) {
      const int x = i + side - 1, y = j + side - 1;
      double *const row = tile + (DIM == 3 ? i * sx + j * sy : i * sx);
      const int *const block = slot + (DIM == 3 ? 9 * (x / side) + 3 * (y / side) : 9 * (x / side));
      const int index = DIM == 3 ? (x % side * side + y % side) * side : x % side * side;
      constexpr int next = DIM == 3 ? 1 : 3, middle = DIM == 3 ? 0 : 1;
      const auto record = [&](int which, int node) {
        return nodes + Index(64) * block[which * next + middle] + node;
      };
      if (low == 0) move_some<1, FLUSHES>(row, record(0, index + side - 1));
      if (low <= side) move_some<side, FLUSHES>(row + 1, record(1, index));
      if (high > side) move_some<ORDER + 1, FLUSHES>(row + side + 1, record(2, index));
    }
}

}    // namespace

ScalarKernels MPM_NS::MPM_OF_ISA(mpm_kernels_scalar)(int dim, Shape shape)
{
  if (shape == CPGIMP) shape = GIMP;
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC, GIMP, BERNSTEIN>(shape, [](auto s) {
      constexpr Shape SHAPE = decltype(s)::value;
      return ScalarKernels{prepare<DIM, SHAPE>,         add<DIM, SHAPE>,
                           add_values<DIM, SHAPE>,      get<DIM, SHAPE>,
                           get_values<DIM, SHAPE>,      move_tile<DIM, SHAPE, true>,
                           move_tile<DIM, SHAPE, false>};
    });
  });
}

#endif

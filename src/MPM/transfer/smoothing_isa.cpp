/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Sums and values of linear fits around nodes, see SmoothingKernels; compiled once for each instruction set.

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

/** Place of a point in the tile, weights w of its nodes along each axis, distances r from the nodes to it in node
 *  spacings, and their squares. */
template <int DIM, int ORDER> struct FitAxes {
  static constexpr int N = ORDER + 1;
  int node[3] = {0, 0, 0};
  double w[3][4], r[3][4], rr[3][4];

  MPM_INLINE FitAxes(const double *x, const TransferStep &step, const int *base)
  {
    MPM_UNROLL
    for (int a = 0; a < DIM; a++) {
      // not negative: a tile begins one node before its block
      const double t = (x[a] - step.origin[a]) * step.inv_h - (BSpline<ORDER>::shift + base[a]);
      node[a] = static_cast<int>(t);
      const double f = t - node[a];
      BSpline<ORDER>::weights(f, w[a]);
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        r[a][i] = f + BSpline<ORDER>::shift - i;
        rr[a][i] = r[a][i] * r[a][i];
      }
    }
  }
  MPM_INLINE int place() const
  {
    return node[0] * tile_stride_x(DIM, ORDER) + node[1] * tile_stride_y(DIM, ORDER) +
        (DIM == 3 ? node[2] : 0);
  }
  /** Factors along an axis of node i: weight times 1, or the distance in lanes with a bit in R. */
  template <int R> MPM_INLINE V factor(int a, int i) const
  {
    return w[a][i] * mask<~R>() + (w[a][i] * r[a][i]) * mask<R>();
  }
  /** The same with squares of distances. */
  template <int R> MPM_INLINE V square(int a, int i) const
  {
    return w[a][i] * mask<~R>() + (w[a][i] * rr[a][i]) * mask<R>();
  }
  template <int R> static MPM_INLINE V mask()
  {
    return quad(R & 1, R >> 1 & 1, R >> 2 & 1, R >> 3 & 1);
  }
};

constexpr int X = 1, Y = 2, Z = 4, W = 8;    // lanes

template <int DIM, int ORDER>
void fit(const PointRows &points, const double *q, const TransferStep &transfer, int first,
         int last, const int base[3], double *tile, int *box)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER),
                WIDTH = fit_width(DIM);
  const TransferStep step = transfer;
  for (int p = first; p < last; p++) {
    const FitAxes<DIM, ORDER> axes(points.x + 3 * static_cast<std::ptrdiff_t>(p), step, base);
    for (int a = 0; a < DIM; a++) {
      box[a] = std::min(box[a], axes.node[a]);
      box[3 + a] = std::max(box[3 + a], axes.node[a]);
    }
    double *const at = tile + WIDTH * axes.place();
    const double volume = points.vol0[p], moment = volume * q[p];
    if constexpr (DIM == 2) {
      V y[N];          // 1 1 y y
      Vec<2> yy[N];    // 1 y^2
      MPM_UNROLL
      for (int j = 0; j < N; j++) {
        y[j] = axes.template factor<Z | W>(1, j);
        yy[j] = half<0>(axes.template square<Y>(1, j));
      }
      MPM_UNROLL
      for (int i = 0; i < N; i++) {
        const V x = axes.template factor<Y | W>(0, i);    // 1 x 1 x
        const V xV = volume * x, xq = moment * x;
        const Vec<2> xx = volume * half<0>(axes.template square<X>(0, i));    // x^2 1
        MPM_UNROLL
        for (int j = 0; j < N; j++) {
          double *const node = at + WIDTH * (i * sx + j * sy);
          (V::load(node) + xV * y[j]).store(node);
          (Vec<2>::load(node + 4) + xx * yy[j]).store(node + 4);
          (V::load(node + 8) + xq * y[j]).store(node + 8);
        }
      }
    } else {
      V y[N], yy[N], yc[N];    // 1 1 y 1;  1 y^2 1 -;  y 1 y -
      V z[N], zz[N], zc[N];    // 1 1 1 z;  1 1 z^2 -;  1 z z -
      MPM_UNROLL
      for (int k = 0; k < N; k++) {
        y[k] = axes.template factor<Z>(1, k);
        yy[k] = axes.template square<Y>(1, k);
        yc[k] = axes.template factor<X | Z>(1, k);
        z[k] = axes.template factor<W>(2, k);
        zz[k] = axes.template square<Z>(2, k);
        zc[k] = axes.template factor<Y | Z>(2, k);
      }
      for (int i = 0; i < N; i++) {
        const V x = axes.template factor<Y>(0, i);                  // 1 x 1 1
        const V xx = volume * axes.template square<X>(0, i);        // x^2 1 1 -
        const V xc = volume * axes.template factor<X | Y>(0, i);    // x x 1 -
        for (int j = 0; j < N; j++) {
          const V xy = x * y[j];    // 1 x y 1
          const V xyV = volume * xy, xyq = moment * xy;
          const V xxyy = xx * yy[j];    // x^2 y^2 1 -
          const V xyc = xc * yc[j];     // xy x y -
          double *const row = at + WIDTH * (i * sx + j * sy);
          MPM_UNROLL
          for (int k = 0; k < N; k++) {
            double *const node = row + WIDTH * k;
            (V::load(node) + xyV * z[k]).store(node);
            (V::load(node + 4) + xxyy * zz[k]).store(node + 4);
            (V::load(node + 8) + xyc * zc[k]).store(node + 8);
            (V::load(node + 12) + xyq * z[k]).store(node + 12);
          }
        }
      }
    }
  }
}

template <int DIM, int ORDER>
void evaluate(const PointRows &points, double *q, const TransferStep &transfer, int first, int last,
              const int base[3], const double *tile)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  const TransferStep step = transfer;
  for (int p = first; p < last; p++) {
    const FitAxes<DIM, ORDER> axes(points.x + 3 * static_cast<std::ptrdiff_t>(p), step, base);
    const double *const at = tile + 4 * axes.place();
    V sum = V{};
    V y[N], z[N];
    MPM_UNROLL
    for (int k = 0; k < N; k++) {
      y[k] = axes.template factor<Z>(1, k);
      if constexpr (DIM == 3) z[k] = axes.template factor<W>(2, k);
    }
    MPM_UNROLL
    for (int i = 0; i < N; i++) {
      V line = V{};
      MPM_UNROLL
      for (int j = 0; j < N; j++) {
        const double *const row = at + 4 * (i * sx + j * sy);
        if constexpr (DIM == 3) {
          V cells = V{};
          MPM_UNROLL
          for (int k = 0; k < N; k++) cells += z[k] * V::load(row + 4 * k);
          line += y[j] * cells;
        } else {
          line += y[j] * V::load(row);
        }
      }
      sum += axes.template factor<Y>(0, i) * line;
    }
    q[p] = sum.lane(0) + sum.lane(1) + sum.lane(2) + (DIM == 3 ? sum.lane(3) : 0.0);
  }
}

}    // namespace

SmoothingKernels MPM_NS::MPM_OF_ISA(mpm_kernels_smoothing)(int dim, Shape shape)
{
  if (shape != LINEAR && shape != QUADRATIC && shape != CUBIC) return {};
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC>(shape, [&](auto s) {
      constexpr int ORDER = stencil_order(decltype(s)::value);
      return SmoothingKernels{fit<DIM, ORDER>, evaluate<DIM, ORDER>};
    });
  });
}

#endif

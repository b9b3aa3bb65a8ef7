/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// The modes of polypic, see PolyKernels; compiled once for each instruction set.

#include "transfer/kernels_isa.h"

#if defined(MPM_HAVE_VECTORS)

#include "transfer/vector.h"

#include <cstddef>

using namespace MPM_NS;

namespace {

/** Place in the tile, weights w, and w times distance of a point along each axis. */
template <int DIM, int ORDER> struct Axes {
  static constexpr int N = ORDER + 1;
  int place;
  double w[3][4], b[3][4];

  MPM_INLINE Axes(const double *x, const TransferStep &step, const int *base)
  {
    int node[3] = {0, 0, 0};
    MPM_UNROLL
    for (int a = 0; a < DIM; a++) {
      // not negative: a tile begins one node before its block
      const double t = (x[a] - step.origin[a]) * step.inv_h - (BSpline<ORDER>::shift + base[a]);
      node[a] = static_cast<int>(t);
      const double f = t - node[a];
      BSpline<ORDER>::weights(f, w[a]);
      for (int i = 0; i < N; i++) b[a][i] = w[a][i] * (i - BSpline<ORDER>::shift - f) * step.h;
    }
    place = node[0] * tile_stride_x(DIM, ORDER) + node[1] * tile_stride_y(DIM, ORDER) +
        (DIM == 3 ? node[2] : 0);
  }
};

using V = Vec<4>;    // like the momentum and mass of a node; the last one is zero in P2G

template <int DIM, int ORDER, int NREAL>
void p2g(const PointRows &points, const double *Q, const TransferStep &step, int first, int last,
         const int base[3], double *tile)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  for (int p = first; p < last; p++) {
    const Axes<DIM, ORDER> axes(points.x + 3 * static_cast<std::ptrdiff_t>(p), step, base);
    const double *const q = Q + poly_size(DIM) * static_cast<std::ptrdiff_t>(p);
    const double mass = points.mass[p];
    double *const at = tile + NREAL * axes.place;
    alignas(32) double c[4][4] = {{0.0}};
    for (int m = 0; m < (DIM == 3 ? 4 : 1); m++)
      for (int d = 0; d < DIM; d++) c[m][d] = mass * q[DIM * m + d];
    const V xy = V::load(c[0]);
    if constexpr (DIM == 2) {
      for (int i = 0; i < N; i++) {
        const V x = axes.b[0][i] * xy;
        MPM_UNROLL
        for (int j = 0; j < N; j++) {
          double *const node = at + NREAL * (i * sx + j * sy);
          (V::load(node) + axes.b[1][j] * x).store(node);
        }
      }
    } else {
      const V xz = V::load(c[1]), yz = V::load(c[2]), xyz = V::load(c[3]);
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          const double bb = axes.b[0][i] * axes.b[1][j], bw = axes.b[0][i] * axes.w[1][j],
                       wb = axes.w[0][i] * axes.b[1][j];
          const V A = bb * xy, B = bw * xz + wb * yz + bb * xyz;
          double *const row = at + NREAL * (i * sx + j * sy);
          MPM_UNROLL
          for (int k = 0; k < N; k++) {
            double *const node = row + NREAL * k;
            (V::load(node) + axes.w[2][k] * A + axes.b[2][k] * B).store(node);
          }
        }
    }
  }
}

template <int DIM, int ORDER, int NREAL>
void g2p(const PointRows &points, double *Q, const TransferStep &step, int first, int last,
         const int base[3], const double *tile)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  const double moment = BSpline<ORDER>::inv_moment * step.inv_h * step.inv_h;    // 1/D
  for (int p = first; p < last; p++) {
    const Axes<DIM, ORDER> axes(points.x + 3 * static_cast<std::ptrdiff_t>(p), step, base);
    double *const q = Q + poly_size(DIM) * static_cast<std::ptrdiff_t>(p);
    const double *const at = tile + NREAL * axes.place;
    alignas(32) double c[4][4];
    V xy = V{};
    if constexpr (DIM == 2) {
      for (int i = 0; i < N; i++) {
        V x = V{};
        MPM_UNROLL
        for (int j = 0; j < N; j++) x += axes.b[1][j] * V::load(at + NREAL * (i * sx + j * sy));
        xy += axes.b[0][i] * x;
      }
    } else {
      V xz = V{}, yz = V{}, xyz = V{};
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          const double *const row = at + NREAL * (i * sx + j * sy);
          V A = V{}, B = V{};
          MPM_UNROLL
          for (int k = 0; k < N; k++) {
            const V node = V::load(row + NREAL * k);
            A += axes.w[2][k] * node;
            B += axes.b[2][k] * node;
          }
          const double bb = axes.b[0][i] * axes.b[1][j], bw = axes.b[0][i] * axes.w[1][j],
                       wb = axes.w[0][i] * axes.b[1][j];
          xy += bb * A;
          xz += bw * B;
          yz += wb * B;
          xyz += bb * B;
        }
      (moment * moment * xz).store(c[1]);
      (moment * moment * yz).store(c[2]);
      (moment * moment * moment * xyz).store(c[3]);
    }
    (moment * moment * xy).store(c[0]);
    for (int m = 0; m < (DIM == 3 ? 4 : 1); m++)
      for (int d = 0; d < DIM; d++) q[DIM * m + d] = c[m][d];
  }
}

}    // namespace

PolyKernels MPM_NS::MPM_OF_ISA(mpm_kernels_poly)(int dim, Shape shape, int nreal)
{
  return choose_poly(dim, shape, nreal, [](auto c) {
    return PolyKernels{p2g<c.dim, stencil_order(c.shape), c.nreal>,
                       g2p<c.dim, stencil_order(c.shape), c.nreal>};
  });
}

#endif

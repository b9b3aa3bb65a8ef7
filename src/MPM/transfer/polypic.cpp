/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "transfer/polypic.h"

#include "transfer/shape.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace MPM_NS {
PolyKernels mpm_kernels_poly_base(int dim, Shape, int nreal);
#if defined(MPM_HAVE_V3)
PolyKernels mpm_kernels_poly_v3(int dim, Shape, int nreal);
#endif
#if defined(MPM_HAVE_V4)
PolyKernels mpm_kernels_poly_v4(int dim, Shape, int nreal);
#endif
}    // namespace MPM_NS

using namespace MPM_NS;

namespace {

/** Place in the tile, weights w, and w times distance of a point along each axis. */
template <int DIM, int ORDER> struct Axes {
  static constexpr int N = ORDER + 1;
  int place;
  double w[3][4], b[3][4];

  Axes(const double *x, const TransferStep &step, const int *base)
  {
    int node[3] = {0, 0, 0};
    for (int a = 0; a < DIM; a++) {
      const double t = (x[a] - step.origin[a]) * step.inv_h - (BSpline<ORDER>::shift + base[a]);
      node[a] = static_cast<int>(std::floor(t));
      const double f = t - node[a];
      BSpline<ORDER>::weights(f, w[a]);
      for (int i = 0; i < N; i++) b[a][i] = w[a][i] * (i - BSpline<ORDER>::shift - f) * step.h;
    }
    place = node[0] * tile_stride_x(DIM, ORDER) + node[1] * tile_stride_y(DIM, ORDER) +
        (DIM == 3 ? node[2] : 0);
  }
};

// vectors have four components like the momentum and mass of a node; the last one is zero

template <int DIM, int ORDER, int NREAL>
void p2g(const PointRows &points, const double *Q, const TransferStep &step, int first, int last,
         const int base[3], double *tile)
{
  constexpr int N = ORDER + 1, sx = tile_stride_x(DIM, ORDER), sy = tile_stride_y(DIM, ORDER);
  for (int p = first; p < last; p++) {
    const Axes<DIM, ORDER> axes(points.x + 3 * p, step, base);
    const double *const q = Q + poly_size(DIM) * static_cast<std::ptrdiff_t>(p);
    const double mass = points.mass[p];
    double *const at = tile + NREAL * axes.place;
    if constexpr (DIM == 2) {
      const double xy[2] = {mass * q[0], mass * q[1]};
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          double *const node = at + NREAL * (i * sx + j * sy);
          const double s = axes.b[0][i] * axes.b[1][j];
          for (int d = 0; d < 2; d++) node[d] += s * xy[d];
        }
    } else {
      double c[4][4] = {{0.0}};
      for (int m = 0; m < 4; m++)
        for (int d = 0; d < 3; d++) c[m][d] = mass * q[3 * m + d];
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          const double bb = axes.b[0][i] * axes.b[1][j], bw = axes.b[0][i] * axes.w[1][j],
                       wb = axes.w[0][i] * axes.b[1][j];
          double A[4], B[4];
          for (int d = 0; d < 4; d++) {
            A[d] = bb * c[0][d];
            B[d] = bw * c[1][d] + wb * c[2][d] + bb * c[3][d];
          }
          double *const row = at + NREAL * (i * sx + j * sy);
          for (int k = 0; k < N; k++)
            for (int d = 0; d < 4; d++)
              row[NREAL * k + d] += axes.w[2][k] * A[d] + axes.b[2][k] * B[d];
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
    const Axes<DIM, ORDER> axes(points.x + 3 * p, step, base);
    double *const q = Q + poly_size(DIM) * static_cast<std::ptrdiff_t>(p);
    const double *const at = tile + NREAL * axes.place;
    if constexpr (DIM == 2) {
      double xy[2] = {0.0, 0.0};
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          const double *const node = at + NREAL * (i * sx + j * sy);
          const double s = axes.b[0][i] * axes.b[1][j];
          for (int d = 0; d < 2; d++) xy[d] += s * node[d];
        }
      for (int d = 0; d < 2; d++) q[d] = moment * moment * xy[d];
    } else {
      double c[4][4] = {{0.0}};
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
          const double *const row = at + NREAL * (i * sx + j * sy);
          double A[4] = {0.0}, B[4] = {0.0};
          for (int k = 0; k < N; k++)
            for (int d = 0; d < 4; d++) {
              A[d] += axes.w[2][k] * row[NREAL * k + d];
              B[d] += axes.b[2][k] * row[NREAL * k + d];
            }
          const double bb = axes.b[0][i] * axes.b[1][j], bw = axes.b[0][i] * axes.w[1][j],
                       wb = axes.w[0][i] * axes.b[1][j];
          for (int d = 0; d < 4; d++) {
            c[0][d] += bb * A[d];
            c[1][d] += bw * B[d];
            c[2][d] += wb * B[d];
            c[3][d] += bb * B[d];
          }
        }
      for (int m = 0; m < 4; m++)
        for (int d = 0; d < 3; d++)
          q[3 * m + d] = moment * moment * (m == 3 ? moment : 1.0) * c[m][d];
    }
  }
}

template <int DIM, int ORDER> PolyKernels choose(int nreal)
{
  if (nreal == 8) return {p2g<DIM, ORDER, 8>, g2p<DIM, ORDER, 8>};
  return {p2g<DIM, ORDER, 4>, g2p<DIM, ORDER, 4>};
}

}    // namespace

PolyKernels PolyKernels::reference(int dim, Shape shape, int nreal)
{
  if (dim == 3) return shape == CUBIC ? choose<3, 3>(nreal) : choose<3, 2>(nreal);
  return shape == CUBIC ? choose<2, 3>(nreal) : choose<2, 2>(nreal);
}

PolyKernels PolyKernels::select(const MPMKernels &kernels, int dim, Shape shape, int nreal)
{
  const std::string isa = kernels.isa;
#if defined(MPM_HAVE_V4)
  if (isa == "AVX-512") return mpm_kernels_poly_v4(dim, shape, nreal);
#endif
#if defined(MPM_HAVE_V3)
  if (isa == "AVX2") return mpm_kernels_poly_v3(dim, shape, nreal);
#endif
  if (isa == "baseline") return mpm_kernels_poly_base(dim, shape, nreal);
  return reference(dim, shape, nreal);
}

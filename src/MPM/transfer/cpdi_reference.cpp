/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Transfers of points with convected domains (CPDI, CPDI2) in plain loops, see
// transfer/kernels_reference.cpp and transfer/cpdi.h.

#include "transfer/kernels_isa.h"

#include "transfer/cpdi.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

using namespace MPM_NS;

namespace {

/** Node of a tile as a corner of a domain sees it. */
struct Node {
  int index;      ///< in the tile, in nodes
  double w;       ///< weight of the linear function
  double d[3];    ///< position minus that of the center of the domain
};

/** The corners of a domain and their nodes. */
template <int DIM, Shape SHAPE> struct Corners {
  static constexpr int N = 1 << DIM;
  double center[DIM], x[N * DIM], w[N], g[N * DIM];    ///< x: relative to the center
  int base[N][3];
  Node node[N][N];
  bool good;

  Corners(const PointRows &points, int p, const TransferStep &step, const int *tilebase)
  {
    double shift[3] = {0.0, 0.0, 0.0}, size;
    if (SHAPE == CPDI) {
      size = PointDomain<DIM>::box(points.domain + DIM * DIM * p, x, g);
      for (double &a : w) a = 1.0 / N;
    } else {
      std::copy(points.domain + N * DIM * p, points.domain + N * DIM * (p + 1), x);
      size = PointDomain<DIM>::free(x, w, g);
      for (int c = 0; c < N; c++)
        for (int d = 0; d < DIM; d++) shift[d] += w[c] * x[DIM * c + d];
      for (int c = 0; c < N; c++)
        for (int d = 0; d < DIM; d++) x[DIM * c + d] -= shift[d];
    }
    good = size > 0.0 && *std::min_element(w, w + N) >= 0.0;
    for (int d = 0; d < DIM; d++) center[d] = points.x[3 * p + d] + shift[d];

    for (int c = 0; c < N; c++) {
      double f[3] = {0.0, 0.0, 0.0}, low[3] = {0.0, 0.0, 0.0};
      base[c][2] = 0;
      for (int d = 0; d < DIM; d++) {
        const double t = (center[d] + x[DIM * c + d] - step.origin[d]) * step.inv_h - tilebase[d];
        base[c][d] = static_cast<int>(std::floor(t));
        f[d] = t - base[c][d];
        low[d] = x[DIM * c + d] - f[d] * step.h;
      }
      for (int n = 0; n < N; n++) {
        Node &a = node[c][n];
        const int i[3] = {n & 1, n >> 1 & 1, n >> 2 & 1};
        a.w = 1.0;
        for (int d = 0; d < DIM; d++) {
          a.w *= i[d] ? f[d] : 1.0 - f[d];
          a.d[d] = low[d] + i[d] * step.h;
        }
        a.index = (base[c][0] + i[0]) * domain_stride_x(DIM) +
            (base[c][1] + i[1]) * domain_stride_y(DIM) + (DIM == 3 ? base[c][2] + i[2] : 0);
      }
    }
  }
};

constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};    // in rows of stress

enum Parts { MOMENTUM = 1, FORCE = 2, ALL = 3 };

template <int DIM, Shape SHAPE, bool AFFINE, int NREAL, int PARTS>
void p2g(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
         double *tile, int box[6])
{
  constexpr int N = 1 << DIM;
  for (int p = first; p < last; p++) {
    const Corners<DIM, SHAPE> corners(points, p, step, base);
    for (int c = 0; c < N; c++) {
      for (int d = 0; d < DIM; d++) {
        box[d] = std::min(box[d], corners.base[c][d]);
        box[3 + d] = std::max(box[3 + d], corners.base[c][d]);
      }
      double f[3];
      for (int i = 0; i < DIM; i++) {
        f[i] = step.force_scale * corners.w[c] * points.f[3 * p + i];
        for (int j = 0; j < DIM; j++)
          f[i] -= step.stress_scale * points.vol0[p] * points.tau[6 * p + place[i][j]] *
              corners.g[DIM * c + j];
      }
      const double mass = corners.w[c] * points.mass[p];
      for (const Node &node : corners.node[c]) {
        double *real = tile + NREAL * node.index;
        if (PARTS & MOMENTUM) {
          for (int i = 0; i < DIM; i++) {
            double v = points.v[3 * p + i];
            if (AFFINE)
              for (int j = 0; j < DIM; j++) v += points.C[DIM * (DIM * p + j) + i] * node.d[j];
            real[i] += node.w * mass * v;
          }
          real[3] += node.w * mass;
        }
        if (PARTS & FORCE)
          for (int i = 0; i < DIM; i++)
            real[(NREAL == 8 ? 4 : 0) + i] += (NREAL == 8 ? 1.0 : step.dt) * node.w * f[i];
      }
    }
  }
}

/** Velocity of the nodes, or the old one, at a corner. */
template <int DIM, int NREAL>
void at_corner(const Node *nodes, const double *tile, int offset, double *v)
{
  for (int i = 0; i < DIM; i++) v[i] = 0.0;
  for (int n = 0; n < 1 << DIM; n++)
    for (int i = 0; i < DIM; i++) v[i] += nodes[n].w * tile[NREAL * nodes[n].index + offset + i];
}

template <int DIM, Shape SHAPE, int NREAL>
int g2p_gradient(const PointRows &points, const TransferStep &step, int first, int last,
                 const int base[3], const double *tile, double *L)
{
  for (int p = first; p < last; p++, L += DIM * DIM) {
    const Corners<DIM, SHAPE> corners(points, p, step, base);
    std::fill(L, L + DIM * DIM, 0.0);
    constexpr int N = 1 << DIM;
    double at[N][3], v[3] = {0.0, 0.0, 0.0};
    for (int c = 0; c < N; c++) {
      at_corner<DIM, NREAL>(corners.node[c], tile, 0, at[c]);
      for (int i = 0; i < DIM; i++) {
        v[i] += corners.w[c] * at[c][i];
        for (int j = 0; j < DIM; j++) L[DIM * j + i] += at[c][i] * corners.g[DIM * c + j];
      }
    }
    if (SHAPE == CPDI2 && points.corners_new)
      for (int c = 0; c < N; c++)
        for (int i = 0; i < DIM; i++)
          points.corners_new[DIM * (N * p + c) + i] =
              corners.x[DIM * c + i] + step.dt * (at[c][i] - v[i]);
  }
  return 0;
}

/** C = B D^-1 with B = sum_i N_ip v_i (x_i - x_p)^T, D = sum_i N_ip (x_i - x_p) (x_i - x_p)^T: of all
 *  affine fields the one nearest to the nodes' velocities, so that no field gains energy on its way from
 *  the nodes to the points and back, and angular momentum is conserved (C. Jiang et al., ACM Trans.
 *  Graph. 34(4) (2015) 51). */
template <int DIM, Shape SHAPE, int NREAL>
void affine_fit(const Corners<DIM, SHAPE> &corners, const double *tile, double *C)
{
  using Domain = PointDomain<DIM>;
  double B[DIM][DIM] = {}, D[Domain::symmetric] = {}, inverse[Domain::symmetric];
  for (int c = 0; c < 1 << DIM; c++)
    for (const Node &node : corners.node[c]) {
      const double w = corners.w[c] * node.w, *v = tile + NREAL * node.index;
      for (int j = 0; j < DIM; j++) {
        for (int i = 0; i < DIM; i++) B[i][j] += w * v[i] * node.d[j];
        for (int k = 0; k <= j; k++) D[Domain::component(k, j)] += w * node.d[j] * node.d[k];
      }
    }
  Domain::invert_symmetric(D, inverse);
  for (int j = 0; j < DIM; j++)
    for (int i = 0; i < DIM; i++) {
      double &sum = C[DIM * j + i] = 0.0;
      for (int k = 0; k < DIM; k++) sum += B[i][k] * inverse[Domain::component(k, j)];
    }
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL>
int g2p(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
        const double *tile, double *L)
{
  constexpr int N = 1 << DIM;
  bool bad = false;
  for (int p = first; p < last; p++) {
    const Corners<DIM, SHAPE> corners(points, p, step, base);
    bad = bad || !corners.good;
    double v[3] = {0.0, 0.0, 0.0}, old[3] = {0.0, 0.0, 0.0}, xnew[3];
    for (int c = 0; c < N; c++) {
      double a[3];
      at_corner<DIM, NREAL>(corners.node[c], tile, 0, a);
      for (int i = 0; i < DIM; i++) v[i] += corners.w[c] * a[i];
      if (!adds_change(TRANSFER)) continue;
      at_corner<DIM, NREAL>(corners.node[c], tile, 4, a);
      for (int i = 0; i < DIM; i++) old[i] += corners.w[c] * a[i];
    }
    double grad[DIM * DIM];
    g2p_gradient<DIM, SHAPE, NREAL>(points, step, p, p + 1, base, tile, grad);
    if (is_gradient(SHAPE, TRANSFER))
      std::copy(grad, grad + DIM * DIM, points.C + DIM * DIM * p);
    else if (is_affine(TRANSFER))
      affine_fit<DIM, SHAPE, NREAL>(corners, tile, points.C + DIM * DIM * p);
    if (L) std::copy(grad, grad + DIM * DIM, L + DIM * DIM * (p - first));

    xnew[2] = points.x[3 * p + 2];
    for (int i = 0; i < DIM; i++) {
      double &vp = points.v[3 * p + i];
      vp = adds_change(TRANSFER) ? v[i] + step.flip * (vp - old[i]) : v[i];
      // the point goes to its center if its corners may move along
      const bool stays = SHAPE == CPDI2 && !points.corners_new;
      xnew[i] = (stays ? points.x[3 * p + i] : corners.center[i]) + step.dt * v[i];
      bad = bad || !std::isfinite(xnew[i]);
    }
    for (int i = 0; i < 3; i++) points.xnew[3 * p + i] = xnew[i];
  }
  return bad;
}

/** Calls action(index in tile, block slot, index in block) for the nodes of the box. */
template <int DIM, class Action> void for_box(const int *box, Action action)
{
  constexpr int side = block_side(DIM);
  const int zlo = DIM == 3 ? box[2] : 0, zhi = DIM == 3 ? box[5] + 1 : 0;
  for (int i = box[0]; i <= box[3] + 1; i++)
    for (int j = box[1]; j <= box[4] + 1; j++)
      for (int k = zlo; k <= zhi; k++) {
        const int n[3] = {i, j, DIM == 3 ? k : side};
        int slot = 0, index = 0;
        for (int a = 0; a < 3; a++) {
          slot = 3 * slot + n[a] / side;
          if (a < DIM) index = side * index + n[a] % side;
        }
        action(i * domain_stride_x(DIM) + j * domain_stride_y(DIM) + k, slot, index);
      }
}

template <int DIM, int NREAL, bool FLUSH>
void move_box(double *tile, double *nodes, const int slot[27], const int box[6])
{
  for_box<DIM>(box, [=](int t, int s, int n) {
    for (int i = 0; i < NREAL; i++) {
      double &node = nodes[(64 * static_cast<std::ptrdiff_t>(slot[s]) + n) * NREAL + i];
      double &mine = tile[NREAL * t + i];
      if (FLUSH) {
        node += mine;
        mine = 0.0;
      } else
        mine = node;
    }
  });
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL> TransferKernels kernels()
{
  constexpr bool affine = is_affine(TRANSFER);
  TransferKernels k;
  k.nreal = NREAL;
  k.margin = block_side(DIM);
  k.affine = affine;
  k.gradient_in_C = is_gradient(SHAPE, TRANSFER);
  k.p2g = p2g<DIM, SHAPE, affine, NREAL, ALL>;
  k.p2g_momentum = p2g<DIM, SHAPE, affine, NREAL, MOMENTUM>;
  k.p2g_force = p2g<DIM, SHAPE, affine, NREAL, FORCE>;
  k.g2p = g2p<DIM, SHAPE, TRANSFER, NREAL>;
  k.g2p_gradient = g2p_gradient<DIM, SHAPE, NREAL>;
  k.flush = move_box<DIM, NREAL, true>;
  k.load = move_box<DIM, NREAL, false>;
  k.prefetch = [](double *, double *, const int *, const int *) {
  };
  return k;
}

template <int DIM, Shape SHAPE> TransferKernels choose(Transfer transfer, bool split)
{
  return choose_transfer(transfer, split, [](auto constants) {
    return kernels<DIM, SHAPE, constants.transfer, constants.nreal>();
  });
}

}    // namespace

TransferKernels MPM_NS::mpm_kernels_domain_reference(int dim, Shape shape, Transfer transfer,
                                                     bool split)
{
  if (dim == 3)
    return shape == CPDI ? choose<3, CPDI>(transfer, split) : choose<3, CPDI2>(transfer, split);
  return shape == CPDI ? choose<2, CPDI>(transfer, split) : choose<2, CPDI2>(transfer, split);
}

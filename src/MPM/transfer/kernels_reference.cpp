/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Kernels in plain scalar loops: the statement of what a transfer is. The tests compare every
// instruction set with them, and they run where nothing else does.

#include "transfer/kernels_isa.h"

#include "transfer/shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

using namespace MPM_NS;

namespace {

/** Node of a tile as one point sees it. */
struct Node {
  int index;         ///< in the tile, in nodes
  double w;          ///< weight
  double grad[3];    ///< gradient of the weight
  double d[3];       ///< position of the node minus that of the point
};

/** Position in units of h from tile node 0, less the shift: its floor is the base node (but for
 *  BERNSTEIN). */
template <int ORDER>
double tile_position(double x, const TransferStep &step, const int *base, int axis)
{
  return (x - step.origin[axis]) * step.inv_h - (BSpline<ORDER>::shift + base[axis]);
}

/** Nodes, weights and gradients of the point at x; size: of GIMP. */
template <int DIM, Shape SHAPE> struct Stencil {
  static constexpr int ORDER = stencil_order(SHAPE);
  static constexpr int count = DIM == 3 ? (ORDER + 1) * (ORDER + 1) * (ORDER + 1)
                                        : (ORDER + 1) * (ORDER + 1);
  int base[3] = {0, 0, 0};    ///< tile index of the base node
  Node node[count];

  Stencil(const double *x, const double *size, const TransferStep &step, const int *tilebase)
  {
    constexpr int nz = DIM == 3 ? ORDER + 1 : 1;
    // in 2d the z axis has a single node of weight one at distance zero
    double w[3][4] = {{1.0}, {1.0}, {1.0}}, dw[3][4] = {}, d[3][4] = {};
    for (int a = 0; a < DIM; a++) {
      const double t = tile_position<ORDER>(x[a], step, tilebase, a);
      base[a] = static_cast<int>(std::floor(t));
      double f = ORDER == 1 ? std::max(t - base[a], SMALLEST_FRACTION) : t - base[a];
      if constexpr (SHAPE == BERNSTEIN) {
        const double cell = 0.5 * (x[a] - step.origin[a]) * step.inv_h, first = std::floor(cell);
        f = cell - first;
        base[a] = 2 * static_cast<int>(first) - tilebase[a];
        Bernstein::weights(f, w[a]);
        Bernstein::gradients(f, dw[a]);
      } else if constexpr (SHAPE == GIMP) {
        Gimp::weights(f, size[a], w[a]);
        Gimp::gradients(f, size[a], dw[a]);
      } else {
        BSpline<ORDER>::weights(f, w[a]);
        BSpline<ORDER>::gradients(f, dw[a]);
      }
      for (int i = 0; i <= ORDER; i++) {
        dw[a][i] *= step.inv_h;
        d[a][i] = (i - (SHAPE == BERNSTEIN ? 2.0 * f : BSpline<ORDER>::shift + f)) * step.h;
      }
    }
    int n = 0;
    for (int i = 0; i <= ORDER; i++)
      for (int j = 0; j <= ORDER; j++)
        for (int k = 0; k < nz; k++, n++) {
          node[n].index = (base[0] + i) * tile_stride_x(DIM, ORDER) +
              (base[1] + j) * tile_stride_y(DIM, ORDER) + (DIM == 3 ? base[2] + k : 0);
          node[n].w = w[0][i] * w[1][j] * w[2][k];
          node[n].grad[0] = dw[0][i] * w[1][j] * w[2][k];
          node[n].grad[1] = w[0][i] * dw[1][j] * w[2][k];
          node[n].grad[2] = w[0][i] * w[1][j] * dw[2][k];
          node[n].d[0] = d[0][i];
          node[n].d[1] = d[1][j];
          node[n].d[2] = d[2][k];
        }
  }
};

/** Full matrix, column-major, times a vector. */
template <int DIM> void matrix_times(const double *m, const double *a, double *b)
{
  for (int i = 0; i < DIM; i++) {
    b[i] = 0.0;
    for (int j = 0; j < DIM; j++) b[i] += m[DIM * j + i] * a[j];
  }
}

/** Symmetric tensor (xx yy zz xy xz yz) times a vector. */
template <int DIM> void stress_times(const double *s, const double *a, double *b)
{
  b[0] = s[0] * a[0] + s[3] * a[1];
  b[1] = s[3] * a[0] + s[1] * a[1];
  b[2] = 0.0;
  if (DIM == 3) {
    b[0] += s[4] * a[2];
    b[1] += s[5] * a[2];
    b[2] = s[4] * a[0] + s[5] * a[1] + s[2] * a[2];
  }
}

enum Parts { MOMENTUM = 1, FORCE = 2, ALL = 3 };

/** Points to nodes; PARTS says what is transferred. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, int PARTS, bool TOTAL>
void p2g(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
         double *tile, int box[6])
{
  constexpr bool affine = is_affine(TRANSFER), mls = is_mls(SHAPE, TRANSFER);
  const double inv_moment = BSpline<stencil_order(SHAPE)>::inv_moment * step.inv_h * step.inv_h;

  for (int p = first; p < last; p++) {
    const Stencil<DIM, SHAPE> stencil(points.x + 3 * p,
                                      SHAPE == GIMP ? points.size + 3 * p : nullptr, step, base);
    for (int a = 0; a < DIM; a++) {
      if (stencil.base[a] < box[a]) box[a] = stencil.base[a];
      if (stencil.base[a] > box[3 + a]) box[3 + a] = stencil.base[a];
    }
    for (const Node &node : stencil.node) {
      double *real = tile + NREAL * node.index;
      if (PARTS & MOMENTUM) {
        const double wm = node.w * points.mass[p];
        for (int i = 0; i < DIM; i++) {
          double v = points.v[3 * p + i];
          if (affine)
            for (int j = 0; j < DIM; j++) v += points.C[DIM * (DIM * p + j) + i] * node.d[j];
          real[i] += wm * v;
        }
        real[3] += wm;
      }
      if (PARTS & FORCE) {
        double internal[3];
        const double *a = mls ? node.d : node.grad;
        if (TOTAL)
          matrix_times<DIM>(points.P + DIM * DIM * p, a, internal);
        else
          stress_times<DIM>(points.tau + 6 * p, a, internal);
        const double scale =
            -step.stress_scale * points.vol0[p] * (mls ? inv_moment * node.w : 1.0);
        for (int i = 0; i < DIM; i++) {
          const double f = scale * internal[i] + step.force_scale * node.w * points.f[3 * p + i];
          if (NREAL == 8)
            real[4 + i] += f;
          else
            real[i] += step.dt * f;
        }
      }
    }
  }
}

/** Velocity gradient at a point, which is the affine matrix, too. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL>
void velocity_gradient(const Stencil<DIM, SHAPE> &stencil, const TransferStep &step,
                       const double *tile, double *L)
{
  constexpr bool mls = is_mls(SHAPE, TRANSFER);
  const double inv_moment = BSpline<stencil_order(SHAPE)>::inv_moment * step.inv_h * step.inv_h;
  for (int i = 0; i < DIM * DIM; i++) L[i] = 0.0;
  for (const Node &node : stencil.node) {
    const double *v = tile + NREAL * node.index;
    for (int j = 0; j < DIM; j++) {
      const double g = mls ? inv_moment * node.w * node.d[j] : node.grad[j];
      for (int i = 0; i < DIM; i++) L[DIM * j + i] += v[i] * g;
    }
  }
}

/** Nodes to points: velocity, position, affine matrix, velocity gradient. */
template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool TOTAL>
int g2p(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
        const double *tile, double *L)
{
  int left = 0;
  for (int p = first; p < last; p++) {
    const Stencil<DIM, SHAPE> stencil(points.x + 3 * p,
                                      SHAPE == GIMP ? points.size + 3 * p : nullptr, step, base);
    double v[3] = {0.0, 0.0, 0.0}, v_old[3] = {0.0, 0.0, 0.0};
    for (const Node &node : stencil.node) {
      const double *real = tile + NREAL * node.index;
      for (int i = 0; i < DIM; i++) {
        v[i] += node.w * real[i];
        if (adds_change(TRANSFER)) v_old[i] += node.w * real[4 + i];
      }
    }
    double grad[DIM * DIM];
    velocity_gradient<DIM, SHAPE, TRANSFER, NREAL>(stencil, step, tile, grad);
    if (is_affine(TRANSFER))
      for (int i = 0; i < DIM * DIM; i++) points.C[DIM * DIM * p + i] = grad[i];
    if (L)
      for (int i = 0; i < DIM * DIM; i++) L[DIM * DIM * (p - first) + i] = grad[i];

    const double *from = TOTAL ? points.from : points.x;
    points.xnew[3 * p + 2] = from[3 * p + 2];
    for (int i = 0; i < DIM; i++) {
      double &vp = points.v[3 * p + i];
      vp = adds_change(TRANSFER) ? v[i] + step.flip * (vp - v_old[i]) : v[i];
      const double xnew = from[3 * p + i] + step.dt * v[i];
      points.xnew[3 * p + i] = xnew;
      const double t = TOTAL ? xnew - xnew
                             : tile_position<stencil_order(SHAPE)>(xnew, step, base, i);
      if (!(t >= 0.0 && t < block_side(DIM) + 2)) left = 1;    // also when t is not a number
    }
  }
  return left;
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL>
int g2p_gradient(const PointRows &points, const TransferStep &step, int first, int last,
                 const int base[3], const double *tile, double *L)
{
  for (int p = first; p < last; p++) {
    const Stencil<DIM, SHAPE> stencil(points.x + 3 * p,
                                      SHAPE == GIMP ? points.size + 3 * p : nullptr, step, base);
    velocity_gradient<DIM, SHAPE, TRANSFER, NREAL>(stencil, step, tile,
                                                   L + DIM * DIM * (p - first));
  }
  return 0;
}

/** Calls action(index in tile, block slot, index in block) for the nodes of the box. */
template <int DIM, int ORDER, class Action> void for_box(const int *box, Action action)
{
  constexpr int side = block_side(DIM);
  int n[3] = {0, 0, 0};
  const int zlo = DIM == 3 ? box[2] : 0;
  const int zhi = DIM == 3 ? box[5] + ORDER : 0;
  for (n[0] = box[0]; n[0] <= box[3] + ORDER; n[0]++)
    for (n[1] = box[1]; n[1] <= box[4] + ORDER; n[1]++)
      for (n[2] = zlo; n[2] <= zhi; n[2]++) {
        int slot = 0, index = 0, tile = 0;
        for (int a = 0; a < 3; a++) {
          // tile node 0 is the last node of the block before
          const int shifted = a < DIM ? n[a] + side - 1 : side;
          slot = 3 * slot + shifted / side;
          if (a < DIM) index = side * index + shifted % side;
        }
        tile = n[0] * tile_stride_x(DIM, ORDER) + n[1] * tile_stride_y(DIM, ORDER) + n[2];
        action(tile, slot, index);
      }
}

template <int DIM, int ORDER, int NREAL>
void flush(double *tile, double *nodes, const int slot[27], const int box[6])
{
  for_box<DIM, ORDER>(box, [=](int t, int s, int n) {
    for (int i = 0; i < NREAL; i++) {
      nodes[(64 * static_cast<std::ptrdiff_t>(slot[s]) + n) * NREAL + i] += tile[NREAL * t + i];
      tile[NREAL * t + i] = 0.0;
    }
  });
}

template <int DIM, int ORDER, int NREAL>
void load(double *tile, double *nodes, const int slot[27], const int box[6])
{
  for_box<DIM, ORDER>(box, [=](int t, int s, int n) {
    for (int i = 0; i < NREAL; i++)
      tile[NREAL * t + i] = nodes[(64 * static_cast<std::ptrdiff_t>(slot[s]) + n) * NREAL + i];
  });
}

void solve_nodes(double *nodes, int nnodes, int nreal, double dt)
{
  for (int n = 0; n < nnodes; n++) {
    double *node = nodes + static_cast<std::ptrdiff_t>(nreal) * n;
    const double m = node[3];
    const bool has_mass = m > std::numeric_limits<double>::min();
    for (int i = 0; i < 3; i++) {
      const double v = has_mass ? node[i] / m : 0.0;
      if (nreal == 8) {
        node[i] = has_mass ? (node[i] + dt * node[4 + i]) / m : 0.0;
        node[4 + i] = v;
      } else {
        node[i] = v;
      }
    }
  }
}

template <int DIM, Shape SHAPE, Transfer TRANSFER, int NREAL, bool TOTAL> TransferKernels kernels()
{
  constexpr int ORDER = stencil_order(SHAPE);
  TransferKernels k;
  k.nreal = NREAL;
  k.margin = 1;
  k.affine = is_affine(TRANSFER);
  k.gradient_in_C = is_gradient(SHAPE, TRANSFER);
  k.p2g = p2g<DIM, SHAPE, TRANSFER, NREAL, ALL, TOTAL>;
  k.p2g_momentum = p2g<DIM, SHAPE, TRANSFER, NREAL, MOMENTUM, false>;
  k.p2g_force = p2g<DIM, SHAPE, TRANSFER, NREAL, FORCE, TOTAL>;
  k.g2p = g2p<DIM, SHAPE, TRANSFER, NREAL, TOTAL>;
  k.g2p_gradient = g2p_gradient<DIM, SHAPE, TRANSFER, NREAL>;
  k.flush = flush<DIM, ORDER, NREAL>;
  k.load = load<DIM, ORDER, NREAL>;
  k.prefetch = [](double *, double *, const int *, const int *) {
  };
  return k;
}

template <bool TOTAL, int DIM, Shape SHAPE> TransferKernels choose(Transfer transfer, bool split)
{
  switch (transfer) {
    case PIC:
      return kernels<DIM, SHAPE, PIC, 8, TOTAL>();
    case FLIP:
      return kernels<DIM, SHAPE, FLIP, 8, TOTAL>();
    case APIC:
      return split ? kernels<DIM, SHAPE, APIC, 8, TOTAL>() : kernels<DIM, SHAPE, APIC, 4, TOTAL>();
    case AFLIP:
      return kernels<DIM, SHAPE, AFLIP, 8, TOTAL>();
    case TPIC:
      return split ? kernels<DIM, SHAPE, TPIC, 8, TOTAL>() : kernels<DIM, SHAPE, TPIC, 4, TOTAL>();
  }
  return TransferKernels();
}

template <bool TOTAL, int DIM> TransferKernels choose(Shape shape, Transfer transfer, bool split)
{
  switch (shape) {
    case LINEAR:
      return choose<TOTAL, DIM, LINEAR>(transfer, split);
    case QUADRATIC:
      return choose<TOTAL, DIM, QUADRATIC>(transfer, split);
    case CUBIC:
      return choose<TOTAL, DIM, CUBIC>(transfer, split);
    case GIMP:
    case CPGIMP:
      return choose<TOTAL, DIM, GIMP>(transfer, split);
    case CPDI:
    case CPDI2:
      if (TOTAL) return TransferKernels();
      return mpm_kernels_domain_reference(DIM, shape, transfer, split);
    case BERNSTEIN:
      return choose<true, DIM, BERNSTEIN>(transfer, split);
  }
  return TransferKernels();
}

template <bool TOTAL> TransferKernels transfer(int dim, Shape shape, Transfer transfer, bool split)
{
  return dim == 3 ? choose<TOTAL, 3>(shape, transfer, split)
                  : choose<TOTAL, 2>(shape, transfer, split);
}

}    // namespace

const MPMKernels *MPM_NS::mpm_kernels_reference()
{
  const auto none = [](int, Shape, Transfer, bool, bool) {
    return TransferKernels();
  };
  static const MPMKernels table = {"reference", transfer<false>, transfer<true>, none, solve_nodes};
  return &table;
}

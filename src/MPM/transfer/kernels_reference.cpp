/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Kernels in plain scalar loops: the statement of what a transfer is. The tests compare every
// instruction set with them, and they run where nothing else does.

#include "transfer/stencil.h"

namespace {

/** What is the same for all points, and no constant: that would be four times as much to
 *  compile. */
struct Way {
  int parts, nreal;
  bool affine, mls, gradient, increment, total;
};
template <class C> constexpr Way way_of(int parts = 0)
{
  return {parts,
          C::nreal,
          is_affine(C::transfer),
          is_mls(C::shape, C::transfer),
          is_gradient(C::shape, C::transfer),
          adds_change(C::transfer),
          C::total};
}

/** Points to nodes. */
template <int DIM, Shape SHAPE>
void scatter(const Way way, const PointRows &points, const TransferStep &step, int first, int last,
             const int base[3], double *tile, int box[6])
{
  const double inv_moment = FunctionOf<SHAPE>::inv_moment * step.inv_h * step.inv_h;

  for (int p = first; p < last; p++) {
    const Stencil<DIM, SHAPE> stencil(points, p, step, base);
    const auto stress = [&](int i, int j) {
      constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
      return way.total ? points.P[DIM * DIM * p + DIM * j + i] : points.tau[6 * p + place[i][j]];
    };
    for (int a = 0; a < DIM; a++) {
      box[a] = std::min(box[a], stencil.low[a]);
      box[3 + a] = std::max(box[3 + a], stencil.high[a]);
    }
    for (const Node &node : stencil.node) {
      double *real = tile + way.nreal * node.index;
      if (way.parts & MOMENTUM) {
        const double wm = node.w * points.mass[p];
        for (int i = 0; i < DIM; i++) {
          double affine = 0.0;
          for (int j = 0; way.affine && j < DIM; j++)
            affine += points.C[DIM * DIM * p + DIM * j + i] * node.d[j];
          real[i] += wm * (points.v[3 * p + i] + affine);
        }
        real[3] += wm;
      }
      if (way.parts & FORCE) {
        const double *a = way.mls ? node.d : node.grad;
        const double scale =
            -step.stress_scale * points.vol0[p] * (way.mls ? inv_moment * node.w : 1.0);
        for (int i = 0; i < DIM; i++) {
          double internal = 0.0;
          for (int j = 0; j < DIM; j++) internal += stress(i, j) * a[j];
          const double f = scale * internal + step.force_scale * node.w * points.f[3 * p + i];
          if (way.nreal == 8)
            real[4 + i] += f;
          else
            real[i] += step.dt * f;
        }
      }
    }
  }
}

template <class C, int PARTS>
void p2g(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
         double *tile, int box[6])
{
  scatter<C::dim, C::shape>(way_of<C>(PARTS), points, step, first, last, base, tile, box);
}

template <int DIM, Shape SHAPE>
void velocity_gradient(const Way &way, const Stencil<DIM, SHAPE> &stencil, const TransferStep &step,
                       const double *tile, double *L)
{
  const double inv_moment = FunctionOf<SHAPE>::inv_moment * step.inv_h * step.inv_h;
  std::fill(L, L + DIM * DIM, 0.0);
  for (const Node &node : stencil.node) {
    const double *v = tile + way.nreal * node.index;
    for (int j = 0; j < DIM; j++) {
      const double g = way.mls ? inv_moment * node.w * node.d[j] : node.grad[j];
      for (int i = 0; i < DIM; i++) L[DIM * j + i] += v[i] * g;
    }
  }
}

/** A = B D^-1 with B = sum_i N_ip v_i (x_i - x_p)^T, D = sum_i N_ip (x_i - x_p) (x_i - x_p)^T: of
 *  all affine fields the one nearest to the nodes' velocities, so that no field gains energy on its
 *  way from the nodes to the points and back, and angular momentum is conserved (C. Jiang et al.,
 *  ACM Trans. Graph. 34(4) (2015) 51). */
template <int DIM, Shape SHAPE>
void affine_fit(const Way &way, const Stencil<DIM, SHAPE> &stencil, const double *tile, double *A)
{
  using Domain = PointDomain<DIM>;
  double B[DIM][DIM] = {}, D[Domain::symmetric] = {}, inverse[Domain::symmetric];
  for (const Node &node : stencil.node) {
    const double *v = tile + way.nreal * node.index;
    for (int j = 0; j < DIM; j++) {
      for (int i = 0; i < DIM; i++) B[i][j] += node.w * v[i] * node.d[j];
      for (int k = 0; k <= j; k++) D[Domain::component(k, j)] += node.w * node.d[j] * node.d[k];
    }
  }
  Domain::invert_symmetric(D, inverse);
  for (int j = 0; j < DIM; j++)
    for (int i = 0; i < DIM; i++) {
      double &sum = A[DIM * j + i] = 0.0;
      for (int k = 0; k < DIM; k++) sum += B[i][k] * inverse[Domain::component(k, j)];
    }
}

/** The corners move with the velocities there, relative to that of the point. */
template <int DIM, Shape SHAPE>
void move_corners(const Way &way, const Stencil<DIM, SHAPE> &stencil, const TransferStep &step,
                  const double *tile, double *corner)
{
  constexpr int N = 1 << DIM;
  double at[N * DIM] = {}, v[DIM] = {};
  for (int n = 0; n < N * N; n++)
    for (int i = 0; i < DIM; i++) {
      const double real = tile[way.nreal * stencil.node[n].index + i];
      at[DIM * (n / N) + i] += stencil.part[n] * real;
      v[i] += stencil.node[n].w * real;
    }
  for (int k = 0; k < N * DIM; k++) corner[k] = stencil.x[k] + step.dt * (at[k] - v[k % DIM]);
}

/** Nodes to points: velocity, position, corners and affine matrix if update; velocity gradient. */
template <int DIM, Shape SHAPE>
int gather(const Way way, bool update, const PointRows &points, const TransferStep &step, int first,
           int last, const int base[3], const double *tile, double *L)
{
  constexpr bool domain = has_domain(SHAPE);
  bool left = false;
  for (int p = first; p < last; p++) {
    const Stencil<DIM, SHAPE> stencil(points, p, step, base);
    double grad[DIM * DIM];
    velocity_gradient<DIM, SHAPE>(way, stencil, step, tile, grad);
    if (L) std::copy(grad, grad + DIM * DIM, L + DIM * DIM * (p - first));
    if (!update) {
      for (int i = 0; points.velocity && i < DIM; i++) {
        double &v = points.velocity[3 * p + i] = 0.0;
        for (const Node &node : stencil.node) v += node.w * tile[way.nreal * node.index + i];
      }
      continue;
    }
    if constexpr (SHAPE == CPDI2)
      if (points.corners_new)
        move_corners<DIM, SHAPE>(way, stencil, step, tile, points.corners_new + (DIM << DIM) * p);

    if (way.gradient)
      std::copy(grad, grad + DIM * DIM, points.C + DIM * DIM * p);
    else if constexpr (domain) {
      if (way.affine) affine_fit<DIM, SHAPE>(way, stencil, tile, points.C + DIM * DIM * p);
    }

    double v[3] = {0.0, 0.0, 0.0}, v_old[3] = {0.0, 0.0, 0.0};
    for (const Node &node : stencil.node) {
      const double *real = tile + way.nreal * node.index;
      for (int i = 0; i < DIM; i++) {
        v[i] += node.w * real[i];
        if (way.increment) v_old[i] += node.w * real[4 + i];
      }
    }
    const double *from = (way.total ? points.from : points.x) + 3 * p;
    if constexpr (domain)    // the point goes to its center if its corners may move along
      if (SHAPE == CPDI || points.corners_new) from = stencil.center;
    left = left || !stencil.good;
    points.xnew[3 * p + 2] = from[2];
    for (int i = 0; i < DIM; i++) {
      double &vp = points.v[3 * p + i];
      vp = way.increment ? v[i] + step.flip * (vp - v_old[i]) : v[i];
      const double xnew = from[i] + step.dt * v[i];
      points.xnew[3 * p + i] = xnew;
      const double t = way.total || domain ? xnew - xnew
                                           : tile_position<SHAPE>(xnew, step, base, i);
      left = left || !(t >= 0.0 && t < block_side(DIM) + 2);    // also when t is not a number
    }
  }
  return left;
}

template <class C, bool UPDATE>
int g2p(const PointRows &points, const TransferStep &step, int first, int last, const int base[3],
        const double *tile, double *L)
{
  return gather<C::dim, C::shape>(way_of<C>(), UPDATE, points, step, first, last, base, tile, L);
}

/** The shape of mode m of polypic: the product of the coordinates whose bits are set in xy, xz, yz,
 *  xyz. */
double mode(const Node &node, int m)
{
  constexpr int bits[4] = {3, 5, 6, 7};
  double product = 1.0;
  for (int a = 0; a < 3; a++)
    if (bits[m] >> a & 1) product *= node.d[a];
  return product;
}

template <class C>
void poly_p2g(const PointRows &points, const double *Q, const TransferStep &step, int first,
              int last, const int base[3], double *tile)
{
  constexpr int DIM = C::dim;
  for (int p = first; p < last; p++)
    for (const Node &node : Stencil<DIM, C::shape>(points, p, step, base).node)
      for (int k = 0; k < poly_size(DIM); k++)
        tile[C::nreal * node.index + k % DIM] +=
            points.mass[p] * node.w * mode(node, k / DIM) * Q[poly_size(DIM) * p + k];
}

template <class C>
void poly_g2p(const PointRows &points, double *Q, const TransferStep &step, int first, int last,
              const int base[3], const double *tile)
{
  constexpr int DIM = C::dim;
  const double inv_moment = FunctionOf<C::shape>::inv_moment * step.inv_h * step.inv_h;
  for (int p = first; p < last; p++) {
    const Stencil<DIM, C::shape> stencil(points, p, step, base);
    for (int k = 0; k < poly_size(DIM); k++) {
      double &q = Q[poly_size(DIM) * p + k] = 0.0;
      for (const Node &node : stencil.node)
        q += node.w * mode(node, k / DIM) * tile[C::nreal * node.index + k % DIM];
      q *= inv_moment * inv_moment * (k / DIM == 3 ? inv_moment : 1.0);
    }
  }
}

void solve_nodes(double *nodes, int nnodes, int nreal, double dt, double least)
{
  for (int n = 0; n < nnodes; n++) {
    double *node = nodes + static_cast<std::ptrdiff_t>(nreal) * n;
    const double m = node[3];
    const bool has_mass = m > least;
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

template <bool TOTAL>
TransferKernels choose_plain(int dim, Shape shape, Transfer transfer, bool split)
{
  return choose({dim, shape, transfer, split, TOTAL}, [](auto c) {
    constexpr bool trials = c.total && has_domain(c.shape);
    if constexpr (trials && c.nreal == 4) {
      return TransferKernels();
    } else {
      using C = decltype(c);
      TransferKernels k = table_of<C>();
      if constexpr (!trials) {
        k.p2g = p2g<C, ALL>;
        k.p2g_momentum = p2g<C, MOMENTUM>;
        k.g2p = g2p<C, true>;
      }
      k.p2g_force = p2g<C, FORCE>;
      k.g2p_gradient = g2p<C, false>;
      k.flush = move_box<C::dim, C::shape, C::nreal, FLUSH>;
      k.load = move_box<C::dim, C::shape, C::nreal, LOAD>;
      if constexpr (C::nreal == 8) k.load_mean = move_box<C::dim, C::shape, 8, LOAD_MEAN>;
      k.prefetch = [](double *, double *, const int *, const int *) {
      };
      return k;
    }
  });
}

PolyKernels choose_plain_poly(int dim, Shape shape, int nreal)
{
  return choose_poly(dim, shape, nreal, [](auto c) {
    return PolyKernels{poly_p2g<decltype(c)>, poly_g2p<decltype(c)>};
  });
}

}    // namespace

const MPMKernels *MPM_NS::mpm_kernels_reference()
{
  static const MPMKernels table = {"reference", choose_plain<false>, choose_plain<true>,
                                   choose_plain_poly, solve_nodes};
  return &table;
}

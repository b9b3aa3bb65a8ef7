/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Transfers of one number in plain loops, see ScalarKernels.

#include "transfer/scalar.h"
#include "transfer/stencil.h"

using namespace MPM_NS;

namespace MPM_NS {
ScalarKernels mpm_kernels_scalar_reference(int dim, Shape);
}

namespace {

template <int DIM, Shape SHAPE>
void prepare(const PointRows &points, const TransferStep &step, int n, const int base[3],
             SlopeKind kind, ScalarStencil &out, int *box)
{
  out.n = n;
  out.points = points;
  out.step = step;
  out.kind = kind;
  std::copy_n(base, DIM, out.base);
  for (int p = 0; box && p < n; p++) {
    const Stencil<DIM, SHAPE> stencil(points, p, step, base);
    for (int a = 0; a < DIM; a++) {
      box[a] = std::min(box[a], stencil.low[a]);
      box[3 + a] = std::max(box[3 + a], stencil.high[a]);
    }
  }
}

/** Calls f(p, node, slopes) for all nodes of the points. */
template <int DIM, Shape SHAPE, class F> void visit(const ScalarStencil &in, const F &f)
{
  const double fit = shape_constants[SHAPE].inv_moment / (in.step.h * in.step.h);
  for (int p = 0; p < in.n; p++) {
    const Stencil<DIM, SHAPE> stencil(in.points, p, in.step, in.base);
    for (const Node &node : stencil.node) {
      double slope[3] = {};
      for (int a = 0; a < DIM; a++)
        slope[a] = in.kind == DISTANCE_SLOPES ? node.w * node.d[a]
            : in.kind == FIT_SLOPES           ? fit * (node.w * node.d[a])
            : in.kind == ABSOLUTE_SLOPES      ? std::fabs(node.grad[a])
                                              : node.grad[a];
      f(p, node, slope);
    }
  }
}

template <int DIM, Shape SHAPE> ScalarKernels table()
{
  ScalarKernels k;
  k.prepare = prepare<DIM, SHAPE>;
  k.add = [](const ScalarStencil &in, const double *q, double *tile) {
    visit<DIM, SHAPE>(in, [&](int p, const Node &node, const double *slope) {
      double sum = node.w * q[4 * p + 3];
      for (int a = 0; a < DIM; a++) sum += slope[a] * q[4 * p + a];
      tile[node.index] += sum;
    });
  };
  k.add_times = [](const ScalarStencil &in, const ScalarSource &from, double *tile) {
    visit<DIM, SHAPE>(in, [&](int p, const Node &node, const double *slope) {
      double sum = node.w * from.values[from.value_width * p];
      for (int a = 0; a < DIM; a++) sum += slope[a] * from.slopes[from.slope_width * p + a];
      tile[node.index] += from.factors[p] * sum;
    });
  };
  k.add_values = [](const ScalarStencil &in, const double *q, double *tile) {
    visit<DIM, SHAPE>(in, [&](int p, const Node &node, const double *) {
      tile[node.index] += node.w * q[p];
    });
  };
  k.get = [](const ScalarStencil &in, const double *tile, double *q) {
    std::fill_n(q, 4 * in.n, 0.0);
    visit<DIM, SHAPE>(in, [&](int p, const Node &node, const double *slope) {
      for (int a = 0; a < DIM; a++) q[4 * p + a] += slope[a] * tile[node.index];
      q[4 * p + 3] += node.w * tile[node.index];
    });
  };
  k.get_values = [](const ScalarStencil &in, const double *tile, double *q) {
    std::fill_n(q, in.n, 0.0);
    visit<DIM, SHAPE>(in, [&](int p, const Node &node, const double *) {
      q[p] += node.w * tile[node.index];
    });
  };
  k.flush = move_box<DIM, SHAPE, 1, FLUSH>;
  k.load = move_box<DIM, SHAPE, 1, LOAD>;
  k.divide = [](double *sums, const double *weights, std::size_t n) {
    for (std::size_t i = 0; i < n; i++) sums[i] = weights[i] > 0.0 ? sums[i] / weights[i] : 0.0;
  };
  return k;
}

}    // namespace

ScalarKernels MPM_NS::mpm_kernels_scalar_reference(int dim, Shape shape)
{
  if (shape == CPGIMP) shape = GIMP;
  return with<int, 2, 3>(dim, [&](auto d) {
    constexpr int DIM = decltype(d)::value;
    return with<Shape, LINEAR, QUADRATIC, CUBIC, GIMP, CPDI, CPDI2, BERNSTEIN>(shape, [](auto s) {
      return table<DIM, decltype(s)::value>();
    });
  });
}

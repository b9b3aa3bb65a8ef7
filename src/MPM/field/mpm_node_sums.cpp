/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "field/mpm_node_sums.h"

#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_frame.h"
#include "field/mpm_nodes.h"
#include "field/mpm_passes.h"
#include "field/mpm_plan.h"
#include "field/mpm_stencil.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Can points of a block reach nodes of blocks that are marked? */
static bool reaches(const Grid::Block &block, const std::vector<char> &near)
{
  return std::any_of(block.slot, block.slot + 27, [&](int slot) {
    return slot >= 0 && near[slot];
  });
}

/** A sum over points at the nodes of some blocks. weigh(point) sets what the kernel reads of a
 *  point. */
template <class Weigh>
static void map_some(MPMField &field, const TransferKernels &with, const PointRows &r,
                     const TransferStep &s, P2G p2g, const std::vector<char> &near, int lane,
                     int nlane, const Weigh &weigh)
{
  points_to(field.work.nodes, field, with,
            [&](const MPMPointMap::Run &run, const int *base, int *box) {
              if (!reaches(field.grid.blocks[run.slot], near)) return;
              for (int i = run.first; i < run.last; i++) weigh(i);
              p2g(r, s, run.first, run.last, base, field.map->tile, box);
            });
  field.nodes.sum(field.work.nodes.data(), with.nreal, lane, nlane);
}

/** The internal force of the Cauchy stress -I is the gradient of the volume; with an axis of
 *  symmetry, that of the area in the plane, times the length of the circle through the node. */
static void map_gradient_with(const TransferKernels &with, MPMField &field, Weight content,
                              const std::vector<char> &near, std::vector<double> &gradient)
{
  const MPMFrame &frame = *field.frame;
  field.work.stress.resize(6 * (std::size_t) field.atom->nmax);
  PointRows r = field.rows();
  r.tau = field.work.stress.data();
  TransferStep s = field.step_data(1.0);
  s.force_scale = 0.0;
  s.stress_scale = 1.0;

  const int nreal = with.nreal, lane = nreal == 8 ? 4 : 0;
  const MPMRows places = frame.places();
  map_some(field, with, r, s, with.p2g_force, near, lane, 3, [&](int i) {
    double *const tau = r.tau + 6 * (std::size_t) i;
    const double weight =
        (content == Weight::MASS ? r.mass[i] / r.vol0[i] : frame.lattice_jacobian(i)) /
        frame.circle(places[i][0]);
    for (int k = 0; k < 6; k++) tau[k] = k < 3 ? -weight : 0.0;
  });
  gradient.resize(3 * field.grid.nnodes());
  for (int64_t n = 0; n < field.grid.nnodes(); n++) {
    const double length =
        frame.node_circle((int) (n / NODES_PER_BLOCK), (int) (n % NODES_PER_BLOCK));
    for (int d = 0; d < 3; d++)
      gradient[3 * n + d] = length * field.work.nodes[n * nreal + lane + d];
  }
}

void LAMMPS_NS::map_gradient(MPMField &field, Weight content, const std::vector<char> &near,
                             std::vector<double> &gradient)
{
  map_gradient_with(field.kernel, field, content, near, gradient);
}

void LAMMPS_NS::map_surface(MPMField &field, const std::vector<char> &near,
                            std::vector<double> &gradient)
{
  map_gradient_with(field.pic, field, Weight::VOLUME, near, gradient);
}

/** The B-spline of an order around 0 at x (power: its order), or its integral up to x (power: one
 *  more), as a sum of truncated powers. */
static double spline_sum(int order, int power, double x)
{
  double sum = 0.0, binomial = 1.0, factorial = 1.0;
  for (int k = 2; k <= power; k++) factorial *= k;
  for (int k = 0; k <= order + 1; k++) {
    const double t = x + 0.5 * (order + 1) - k;
    if (t <= 0.0) break;
    double term = binomial;
    for (int p = 0; p < power; p++) term *= t;
    sum += k % 2 ? -term : term;
    binomial *= (double) (order + 1 - k) / (k + 1);
  }
  return sum / factorial;
}

void LAMMPS_NS::map_boxes(MPMField &field, const std::vector<MPMField *> &bodies, Weight content,
                          const std::vector<char> &near, std::vector<double> &gradient,
                          std::vector<double> &share)
{
  constexpr int NREAL = 4, MOST = 7;    // gradient, volume; nodes along an axis
  const Grid &grid = field.grid;
  const Lattice &lattice = field.lattice;
  const int dim = lattice.dim, order = stencil_order(field.options.shape);
  const double reach = 0.5 * (order + 1);
  auto &sums = field.work.nodes;
  sums.assign(NREAL * grid.nnodes(), 0.0);
  for (const auto *body : bodies)
    for (const auto &run : body->map->runs)
      for (int i = run.first; i < run.last; i++) {
        const double *const x = body->frame->places()[i];
        double t[3];
        int center[3] = {0, 0, 0}, b[3] = {0, 0, 0};
        for (int d = 0; d < dim; d++) {
          t[d] = (x[d] - lattice.origin[d]) / lattice.h;
          center[d] = (int) std::floor(t[d] + 0.5);
          b[d] = center[d] >> grid.shift_bits;
        }
        const int slot = grid.find(b);
        if (slot < 0 || !reaches(grid.blocks[slot], near)) continue;

        const double circle = body->frame->circle(x[0]),
                     volume = field.atom->vfrac[i] * body->frame->lattice_jacobian(i) / circle,
                     weight = content == Weight::MASS ? field.atom->rmass[i] / circle : volume,
                     size = std::min(1.0, std::pow(volume, 1.0 / dim) / lattice.h);
        double w[3][MOST] = {{0.0}, {0.0}, {1.0}}, dw[3][MOST] = {{0.0}};
        int first[3] = {0, 0, 0}, count[3] = {1, 1, 1}, k[3];
        for (int d = 0; d < dim; d++) {
          const double low = t[d] - 0.5 * size, high = t[d] + 0.5 * size;
          first[d] = (int) std::ceil(low - reach);
          count[d] = (int) std::floor(high + reach) - first[d] + 1;
          for (int n = 0; n < count[d]; n++) {
            const double at = first[d] + n;
            w[d][n] =
                (spline_sum(order, order + 1, high - at) - spline_sum(order, order + 1, low - at)) /
                size;
            dw[d][n] = (spline_sum(order, order, high - at) - spline_sum(order, order, low - at)) /
                (size * lattice.h);
          }
        }
        for (k[0] = 0; k[0] < count[0]; k[0]++)
          for (k[1] = 0; k[1] < count[1]; k[1]++)
            for (k[2] = 0; k[2] < count[2]; k[2]++) {
              const int index[3] = {first[0] + k[0], first[1] + k[1], first[2] + k[2]};
              const int64_t node = grid.locate_near(grid.blocks[slot], index);
              if (node < 0) continue;
              double *const to = &sums[NREAL * node];
              const double wx = w[0][k[0]], wy = w[1][k[1]], wz = w[2][k[2]];
              to[0] += weight * dw[0][k[0]] * wy * wz;
              to[1] += weight * wx * dw[1][k[1]] * wz;
              to[2] += weight * wx * wy * dw[2][k[2]];
              to[3] += volume * wx * wy * wz;
            }
      }
  field.nodes.sum(sums.data(), NREAL, 0, NREAL);
  const double inverse = 1.0 / lattice.cell_volume();
  gradient.resize(3 * grid.nnodes());
  share.resize(grid.nnodes());
  for (int64_t n = 0; n < grid.nnodes(); n++) {
    const double length =
        field.frame->node_circle((int) (n / NODES_PER_BLOCK), (int) (n % NODES_PER_BLOCK));
    for (int d = 0; d < 3; d++) gradient[3 * n + d] = length * sums[NREAL * n + d];
    share[n] = inverse * sums[NREAL * n + 3];
  }
}

void LAMMPS_NS::map_forces(MPMField &field, const std::vector<char> &near,
                           const std::function<void(int, double *, double *)> &give,
                           std::vector<double> &force)
{
  auto &work = field.work;
  const std::size_t nmax = field.atom->nmax;
  work.stress.resize(6 * nmax);
  work.vectors.resize(3 * nmax);
  PointRows r = field.rows();
  r.tau = work.stress.data();
  r.f = work.vectors.data();
  TransferStep s = field.step_data(1.0);
  s.force_scale = s.stress_scale;
  const int nreal = field.kernel.nreal, lane = nreal == 8 ? 4 : 0;
  map_some(field, field.kernel, r, s, field.kernel.p2g_force, near, lane, 3, [&](int i) {
    give(i, r.tau + 6 * (std::size_t) i, work.vectors.data() + 3 * (std::size_t) i);
  });
  field.nodes.complete(work.nodes.data(), nreal, nreal);
  force.resize(3 * field.grid.nnodes());
  for (int64_t n = 0; n < field.grid.nnodes(); n++)
    for (int d = 0; d < 3; d++) force[3 * n + d] = work.nodes[n * nreal + lane + d];
}

void LAMMPS_NS::map_volume(MPMField &field, const std::vector<char> &near,
                           std::vector<double> &share)
{
  auto &volumes = field.work.weights;
  volumes.resize(std::max(volumes.size(), (std::size_t) field.atom->nmax));
  PointRows r = field.rows();
  r.mass = volumes.data();
  const MPMFrame &frame = *field.frame;
  const MPMRows places = frame.places();
  const TransferKernels &with = frame.is_total() ? field.pic : field.kernel;
  map_some(field, with, r, field.step_data(), with.p2g_momentum, near, 3, 1, [&](int i) {
    volumes[i] = field.atom->vfrac[i] * frame.lattice_jacobian(i) / frame.circle(places[i][0]);
  });
  const double inverse = 1.0 / field.lattice.cell_volume();
  share.resize(field.grid.nnodes());
  for (int64_t n = 0; n < field.grid.nnodes(); n++)
    share[n] = inverse * field.work.nodes[n * with.nreal + 3];
}

void LAMMPS_NS::visit_points(const MPMField &field, const std::vector<int> &wanted,
                             const std::function<void(int, int, double, const double *)> &f)
{
  const MPMStencil stencil(field);
  std::vector<char> near(field.grid.blocks.size(), 0);
  for (std::size_t n = 0; n < wanted.size(); n++)
    if (wanted[n] >= 0) near[n / NODES_PER_BLOCK] = 1;
  for (const auto &run : field.map->runs) {
    const auto &block = field.grid.blocks[run.slot];
    if (!reaches(block, near)) continue;
    for (int i = run.first; i < run.last; i++)
      stencil.visit(block, i, [&](const MPMStencil::Node &node) {
        const int which = wanted[node.number];
        if (node.weight != 0.0 && which >= 0) f(i, which, node.weight, node.r);
      });
  }
}

/** Volumes on the lattice: in the total frame those of the reference configuration. */
void LAMMPS_NS::volume_at_points(MPMField &field, std::vector<double> &share)
{
  field.plan->find_blocks_now();
  const auto &pic = field.pic;
  MPMPointMap &map = *field.map;
  auto &nodes = field.work.nodes;
  const std::size_t nmax = field.atom->nmax;
  std::vector<double> values(3 * nmax), weights(nmax);
  const PointRows r = field.rows_at_rest(values.data(), weights.data());
  const TransferStep s = field.step_data(0.0);

  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    const int damage = run.material ? run.material->damage : -1;
    for (int i = run.first; i < run.last; i++) {
      const bool failed = damage >= 0 && run.material->history[i][damage] >= 1.0;
      weights[i] = failed ? 0.0 : r.vol0[i] * field.frame->lattice_jacobian(i);
    }
    pic.p2g_momentum(r, s, run.first, run.last, base, map.tile, box);
  });

  // behind a fixed face, the mirror image: nothing can get between it and the body
  const int nreal = pic.nreal;
  double *const volume = nodes.data() + 3;
  MPMEdges faces(field.lmp, field);
  if (!field.frame->is_total() && !field.nodes.edges) faces.find(true);
  for (int a = field.lattice.dim - 1; a >= 0; a--)
    for (const auto &e : faces.lists[a]) {
      volume[e.face * nreal] *= 2.0;
      if (e.outside >= 0) volume[e.inside * nreal] += volume[e.outside * nreal];
    }
  field.nodes.sum(nodes.data(), nreal, 3, 1);
  for (int a = 0; a < field.lattice.dim; a++)
    for (const auto &e : faces.lists[a])
      if (e.outside >= 0) volume[e.outside * nreal] = volume[e.inside * nreal];
  const double inverse = 1.0 / field.lattice.cell_volume();
  for (int64_t n = 0; n < field.grid.nnodes(); n++)
    nodes[n * nreal] = inverse * nodes[n * nreal + 3];
  field.nodes.complete(nodes.data(), nreal, 1);
  points_from(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base) {
    pic.g2p(r, s, run.first, run.last, base, map.tile_load, nullptr);
  });

  share.resize(nmax);
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    share[i] = values[3 * (std::size_t) i];
  });
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "diffusion/mpm_node_scalar.h"

#include "atom.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"

#include <algorithm>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

void MPMNodeScalar::init(bool with_slopes, bool with_volumes)
{
  slopes = with_slopes;
  volumes = with_volumes;
  const int dim = field.lattice.dim;
  const Shape shape = field.options.shape;
  kernels = ScalarKernels::select(*field.kernels, dim, shape);
  moments = shape_constants[shape].inv_moment > 0.0;
  const int nodes = has_domain(shape) ? domain_tile_nodes(dim)
                                      : tile_nodes(dim, stencil_order(shape));
  for (auto &tile : tiles) tile.assign(nodes + MORE, 0.0);
}

/** Calls f(run, first, n, prepare) for batches of the points of a block that have a part; prepare()
 *  makes their stencil. f returns false for a run that has none. */
template <class F>
void MPMNodeScalar::visit(const MPMPointMap::ActiveBlock &block, SlopeKind kind, int *box,
                          const F &f)
{
  int base[3];
  field.map->tile_base(block, base);
  const PointRows rows = field.rows();
  const TransferStep step = field.step_data(0.0);
  for (int k = block.first_run; k < block.last_run; k++) {
    const auto &run = field.map->runs[k];
    for (int i = run.first; has_part[k] && i < run.last; i += BATCH) {
      const int n = std::min(BATCH, run.last - i);
      has_part[k] = f(run, i, n, [&] {
        kernels.prepare(rows_from(field, rows, i), step, n, base, kind, stencil, box);
      });
    }
  }
}

int *MPMNodeScalar::box_of(const MPMPointMap::ActiveBlock &block)
{
  return boxes[&block - field.map->active.data()].data();
}

/** Calls use(run, first, n) for all batches of points that have a part, with their stencil, and
 *  with the values of nodes from[k] in tiles[k + 1]. What use() adds to tiles[0] goes to the nodes
 *  to (null: nothing), without the sum over ranks. */
template <class Use>
void MPMNodeScalar::pass(SlopeKind kind, std::initializer_list<std::vector<double> *> from,
                         std::vector<double> *to, const Use &use)
{
  for (auto *nodes : from) field.nodes.complete(nodes->data(), 1, 1);
  if (to) to->assign(field.grid.nnodes(), 0.0);
  each_block(field, [&](const auto &block) {
    const int *const box = box_of(block);
    if (box[0] > box[3]) return;
    const int *const slot = field.grid.blocks[block.slot].slot;
    auto *tile = tiles;
    for (auto *nodes : from) kernels.load((++tile)->data(), nodes->data(), slot, box);
    visit(block, kind, nullptr, [&](const auto &run, int first, int n, const auto &prepare) {
      prepare();
      use(run, first, n);
      return true;
    });
    if (to) kernels.flush(tiles[0].data(), to->data(), slot, box);
  });
  for (std::size_t k = 1; k <= from.size(); k++) std::fill(tiles[k].begin(), tiles[k].end(), 0.0);
}

void MPMNodeScalar::sum(std::vector<double> &nodes) const
{
  field.nodes.sum(nodes.data(), 1, 0, 1);
}

void MPMNodeScalar::points_to_nodes(const Fill &fill, bool keeps)
{
  const std::size_t nnodes = field.grid.nnodes();
  capacity.assign(nnodes, 0.0);
  value.assign(nnodes, 0.0);
  rate.resize(nnodes);
  if (volumes) volume.assign(nnodes, 0.0);
  has_part.assign(field.map->runs.size(), 1);
  Points points = {};    // numbers in z in 2d, too
  double q[BATCH];
  double *const of_value = tiles[0].data(), *const of_capacity = tiles[1].data(),
                *const of_volume = tiles[2].data();
  boxes.resize(field.map->active.size());
  const auto kind = slopes ? DISTANCE_SLOPES : NO_SLOPES;
  each_block(field, [&](const auto &block) {
    int *const box = box_of(block);
    reset_box(box);
    visit(block, kind, box, [&](const auto &run, int first, int n, const auto &prepare) {
      auto &at = points.at;
      at = {points.row[0], 4, points.row[0] + 3, 4, points.capacity};
      if (!fill(run, first, n, points)) return false;
      prepare();
      if (slopes) {
        kernels.add_times(stencil, at, of_value);
      } else {
        for (int p = 0; p < n; p++) q[p] = at.factors[p] * at.values[at.value_width * p];
        kernels.add_values(stencil, q, of_value);
      }
      kernels.add_values(stencil, at.factors, of_capacity);
      if (volumes) kernels.add_values(stencil, points.volume, of_volume);
      return true;
    });
    if (box[0] > box[3]) return;
    const int *const slot = field.grid.blocks[block.slot].slot;
    kernels.flush(of_value, value.data(), slot, box);
    kernels.flush(of_capacity, capacity.data(), slot, box);
    if (volumes) kernels.flush(of_volume, volume.data(), slot, box);
  });
  if (is_level) return;
  sum_nodes();
  if (keeps) keep();
}

void MPMNodeScalar::sum_nodes()
{
  sum(value);
  sum(capacity);
  if (volumes) sum(volume);
  kernels.divide(value.data(), capacity.data(), value.size());
}

void MPMNodeScalar::add_terms(int terms, const GiveValues &capacities, std::vector<double> &u)
{
  first_term = u;
  std::vector<double> &mapped = rate;    // has nothing yet that is needed
  double values[BATCH], of_points[BATCH + SPARE_ROWS];
  for (int term = 2; term <= terms; term++) {
    pass(NO_SLOPES, {&u}, &mapped, [&](const auto &run, int first, int n) {
      kernels.get_values(stencil, tiles[1].data(), of_points);
      capacities(run, first, n, values);
      for (int p = 0; p < n; p++) values[p] *= of_points[p];
      kernels.add_values(stencil, values, tiles[0].data());
    });
    sum(mapped);
    for (std::size_t k = 0; k < u.size(); k++)
      if (capacity[k] > 0.0) u[k] += first_term[k] - mapped[k] / capacity[k];
  }
}

void MPMNodeScalar::sum_rates()
{
  sum(rate);
  divide(rate);
}

void MPMNodeScalar::find_rates(const Conduct &conduct, const std::function<void()> &more)
{
  double q[BATCH + SPARE_ROWS][4];
  pass(GRADIENT_SLOPES, {&value}, &rate, [&](const auto &run, int first, int n) {
    kernels.get(stencil, tiles[1].data(), q[0]);
    conduct(run, first, n, q);
    kernels.add(stencil, q[0], tiles[0].data());
  });
  if (more) more();
  if (!is_level) sum_rates();
}

void MPMNodeScalar::find_rates_along(const Factors &find)
{
  static constexpr double NONE = 0.0;
  double q[BATCH + SPARE_ROWS][4], factors[BATCH];
  pass(GRADIENT_SLOPES, {&value}, &rate, [&](const auto &run, int first, int n) {
    kernels.get(stencil, tiles[1].data(), q[0]);
    find(run, first, n, q, factors);
    kernels.add_times(stencil, {q[0], 4, &NONE, 0, factors}, tiles[0].data());
  });
  if (!is_level) sum_rates();
}

void MPMNodeScalar::add_rows(const Conduct &bound)
{
  double q[BATCH + SPARE_ROWS][4];
  pass(ABSOLUTE_SLOPES, {}, &rate, [&](const auto &run, int first, int n) {
    bound(run, first, n, q);
    for (int p = 0; p < n; p++) {
      for (int d = 0; d < 3; d++) q[p][d] *= 2.0 / field.lattice.h;
      q[p][3] = 0.0;
    }
    kernels.add(stencil, q[0], tiles[0].data());
  });
}

double MPMNodeScalar::greatest_row()
{
  sum(rate);
  double most = 0.0;
  for (std::size_t k = 0; k < rate.size(); k++) {
    // points on a side of a cell give the node in its middle a gradient, but no capacity at all
    if (rate[k] > 0.0)
      rate[k] = capacity[k] > 0.0 ? rate[k] / capacity[k] : std::numeric_limits<double>::max();
    // images have a part of the sums only, which depends on the ranks
    if (field.grid.owns(k)) most = std::max(most, rate[k]);
  }
  return most;
}

void MPMNodeScalar::nodes_to_points(const Take &take, bool changes)
{
  double q[BATCH + SPARE_ROWS][4], old[BATCH + SPARE_ROWS];
  const auto kind = moments ? FIT_SLOPES : GRADIENT_SLOPES;
  const auto use = [&](const auto &run, int first, int n) {
    kernels.get(stencil, tiles[1].data(), q[0]);
    if (changes) kernels.get_values(stencil, tiles[2].data(), old);
    take(run, first, n, q, changes ? old : nullptr);
  };
  if (changes)
    pass(kind, {&value, &before}, nullptr, use);
  else
    pass(kind, {&value}, nullptr, use);
}

void MPMNodeScalar::values_to_points(const TakeValues &take)
{
  double values[BATCH + SPARE_ROWS];
  pass(NO_SLOPES, {&value}, nullptr, [&](const auto &run, int first, int n) {
    kernels.get_values(stencil, tiles[1].data(), values);
    take(run, first, n, values);
  });
}

void MPMNodeScalar::values_to_points_and_back(const GiveValues &exchange,
                                              std::vector<double> &nodes)
{
  double values[BATCH + SPARE_ROWS];
  pass(NO_SLOPES, {&value}, &nodes, [&](const auto &run, int first, int n) {
    kernels.get_values(stencil, tiles[1].data(), values);
    exchange(run, first, n, values);
    kernels.add_values(stencil, values, tiles[0].data());
  });
  sum(nodes);
}

void MPMNodeScalar::gradients_to_points(const Conduct &take)
{
  double q[BATCH + SPARE_ROWS][4];
  pass(GRADIENT_SLOPES, {&value}, nullptr, [&](const auto &run, int first, int n) {
    kernels.get(stencil, tiles[1].data(), q[0]);
    take(run, first, n, q);
  });
}

void MPMNodeScalar::add_up(const GiveValues &give, std::vector<double> &nodes)
{
  double values[BATCH];
  pass(NO_SLOPES, {}, &nodes, [&](const auto &run, int first, int n) {
    give(run, first, n, values);
    kernels.add_values(stencil, values, tiles[0].data());
  });
  if (!is_level) sum(nodes);
}

double MPMNodeScalar::memory_usage() const
{
  double bytes = 0.0;
  for (const auto *list :
       {&capacity, &volume, &value, &before, &rate, &first_term, &tiles[0], &tiles[1], &tiles[2]})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

void LAMMPS_NS::activate_blocks_around(MPMField &field,
                                       const std::function<bool(const int *)> &wanted)
{
  Grid &grid = field.grid;
  const bool space = field.lattice.dim == 3;
  const std::size_t nblocks = grid.blocks.size();
  for (std::size_t ib = 0; ib < nblocks; ib++) {
    const int b[3] = {grid.blocks[ib].b[0], grid.blocks[ib].b[1], grid.blocks[ib].b[2]};
    if (wanted && !wanted(b)) continue;
    for (int k = 0; k < (space ? 27 : 9); k++) {
      const int next[3] = {b[0] + k % 3 - 1, b[1] + k / 3 % 3 - 1, b[2] + k / 9 - space};
      grid.activate(next);
    }
  }
}

double LAMMPS_NS::steepest_function(const MPMField &field)
{
  const MPMStencil stencil(field);
  constexpr int SAMPLES = 4096;
  double steepest = 0.0;
  for (int k = 0; k < SAMPLES; k++) {
    int node;
    double w[4], slope[4], sum = 0.0;
    const int n = stencil.weights((k + 1.0e-3) / SAMPLES, node, w, slope);
    for (int j = 0; j < n; j++)
      if (w[j] > 0.0) sum += slope[j] * slope[j] / w[j];
    steepest = std::max(steepest, sum);
  }
  return steepest;
}

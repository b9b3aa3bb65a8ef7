/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "diffusion/mpm_node_scalar.h"

#include "field/mpm_field.h"
#include "field/mpm_passes.h"

#include <algorithm>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/* ---------------------------------------------------------------------- */

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

void MPMNodeScalar::sum(std::vector<double> &nodes) const
{
  field.nodes.sum(nodes.data(), 1, 0, 1);
}

/* ---------------------------------------------------------------------- */

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
  for (auto &block : field.map->active) {
    int *const box = box_of(block);
    reset_box(box);
    const auto kind = slopes ? DISTANCE_SLOPES : NO_SLOPES;
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
    if (box[0] > box[3]) continue;
    const int *const slot = field.grid.blocks[block.slot].slot;
    kernels.flush(of_value, value.data(), slot, box);
    kernels.flush(of_capacity, capacity.data(), slot, box);
    if (volumes) kernels.flush(of_volume, volume.data(), slot, box);
  }
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

/* ---------------------------------------------------------------------- */

void MPMNodeScalar::add_terms(int terms, const GiveValues &capacities, std::vector<double> &u)
{
  first_term = u;
  std::vector<double> &mapped = rate;    // has nothing yet that is needed
  double values[BATCH], of_points[BATCH + SPARE_ROWS];
  double *const tile = tiles[0].data(), *const from = tiles[1].data();
  for (int term = 2; term <= terms; term++) {
    field.nodes.complete(u.data(), 1, 1);
    std::fill(mapped.begin(), mapped.end(), 0.0);
    for (const auto &block : field.map->active) {
      if (box_of(block)[0] > box_of(block)[3]) continue;
      const int *const slot = field.grid.blocks[block.slot].slot;
      kernels.load(from, u.data(), slot, box_of(block));
      visit(block, NO_SLOPES, nullptr, [&](const auto &run, int first, int n, const auto &prepare) {
        prepare();
        kernels.get_values(stencil, from, of_points);
        capacities(run, first, n, values);
        for (int p = 0; p < n; p++) values[p] *= of_points[p];
        kernels.add_values(stencil, values, tile);
        return true;
      });
      kernels.flush(tile, mapped.data(), slot, box_of(block));
    }
    sum(mapped);
    for (std::size_t k = 0; k < u.size(); k++)
      if (capacity[k] > 0.0) u[k] += first_term[k] - mapped[k] / capacity[k];
  }
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
}

/* ---------------------------------------------------------------------- */

template <class F>
void MPMNodeScalar::find_rates_by(const F &give, const std::function<void()> &more)
{
  std::fill(rate.begin(), rate.end(), 0.0);
  field.nodes.complete(value.data(), 1, 1);
  double q[BATCH + SPARE_ROWS][4];
  double *const tile = tiles[0].data(), *const from = tiles[1].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    const int *const slot = field.grid.blocks[block.slot].slot;
    kernels.load(from, value.data(), slot, box_of(block));
    visit(block, GRADIENT_SLOPES, nullptr,
          [&](const auto &run, int first, int n, const auto &prepare) {
            prepare();
            kernels.get(stencil, from, q[0]);
            give(run, first, n, q);
            return true;
          });
    kernels.flush(tile, rate.data(), slot, box_of(block));
  }
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
  if (more) more();
  if (!is_level) sum_rates();
}

void MPMNodeScalar::sum_rates()
{
  sum(rate);
  kernels.divide(rate.data(), capacity.data(), rate.size());
}

void MPMNodeScalar::find_rates(const Conduct &conduct, const std::function<void()> &more)
{
  find_rates_by(
      [&](const auto &run, int first, int n, Rows q) {
        conduct(run, first, n, q);
        kernels.add(stencil, q[0], tiles[0].data());
      },
      more);
}

void MPMNodeScalar::find_rates_along(const Factors &find)
{
  static constexpr double NONE = 0.0;
  double factors[BATCH];
  find_rates_by(
      [&](const auto &run, int first, int n, Rows q) {
        find(run, first, n, q, factors);
        kernels.add_times(stencil, {q[0], 4, &NONE, 0, factors}, tiles[0].data());
      },
      nullptr);
}

/* ---------------------------------------------------------------------- */

void MPMNodeScalar::add_rows(const Conduct &bound)
{
  std::fill(rate.begin(), rate.end(), 0.0);
  double q[BATCH + SPARE_ROWS][4];
  double *const tile = tiles[0].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    visit(block, ABSOLUTE_SLOPES, nullptr,
          [&](const auto &run, int first, int n, const auto &prepare) {
            prepare();
            bound(run, first, n, q);
            for (int p = 0; p < n; p++) {
              for (int d = 0; d < 3; d++) q[p][d] *= 2.0 / field.lattice.h;
              q[p][3] = 0.0;
            }
            kernels.add(stencil, q[0], tile);
            return true;
          });
    kernels.flush(tile, rate.data(), field.grid.blocks[block.slot].slot, box_of(block));
  }
}

double MPMNodeScalar::greatest_row()
{
  sum(rate);
  double most = 0.0;
  for (std::size_t k = 0; k < rate.size(); k++) {
    // points on a side of a cell give the node in its middle a gradient, but no capacity at all
    if (rate[k] > 0.0)
      rate[k] = capacity[k] > 0.0 ? rate[k] / capacity[k] : std::numeric_limits<double>::max();
    most = std::max(most, rate[k]);
  }
  return most;
}

/* ---------------------------------------------------------------------- */

void MPMNodeScalar::nodes_to_points(const Take &take, bool changes)
{
  field.nodes.complete(value.data(), 1, 1);
  if (changes) field.nodes.complete(before.data(), 1, 1);
  double q[BATCH + SPARE_ROWS][4], old[BATCH + SPARE_ROWS];
  double *const now = tiles[1].data(), *const then = tiles[2].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    const int *const slot = field.grid.blocks[block.slot].slot;
    kernels.load(now, value.data(), slot, box_of(block));
    if (changes) kernels.load(then, before.data(), slot, box_of(block));
    visit(block, moments ? FIT_SLOPES : GRADIENT_SLOPES, nullptr,
          [&](const auto &run, int first, int n, const auto &prepare) {
            prepare();
            kernels.get(stencil, now, q[0]);
            if (changes) kernels.get_values(stencil, then, old);
            take(run, first, n, q, changes ? old : nullptr);
            return true;
          });
  }
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
  std::fill(tiles[2].begin(), tiles[2].end(), 0.0);
}

void MPMNodeScalar::values_to_points(const TakeValues &take)
{
  field.nodes.complete(value.data(), 1, 1);
  double values[BATCH + SPARE_ROWS];
  double *const tile = tiles[1].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    kernels.load(tile, value.data(), field.grid.blocks[block.slot].slot, box_of(block));
    visit(block, NO_SLOPES, nullptr, [&](const auto &run, int first, int n, const auto &prepare) {
      prepare();
      kernels.get_values(stencil, tile, values);
      take(run, first, n, values);
      return true;
    });
  }
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
}

void MPMNodeScalar::values_to_points_and_back(const Exchange &exchange, std::vector<double> &nodes)
{
  field.nodes.complete(value.data(), 1, 1);
  nodes.assign(field.grid.nnodes(), 0.0);
  double values[BATCH + SPARE_ROWS];
  double *const tile = tiles[0].data(), *const from = tiles[1].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    const int *const slot = field.grid.blocks[block.slot].slot;
    kernels.load(from, value.data(), slot, box_of(block));
    visit(block, NO_SLOPES, nullptr, [&](const auto &run, int first, int n, const auto &prepare) {
      prepare();
      kernels.get_values(stencil, from, values);
      exchange(run, first, n, values);
      kernels.add_values(stencil, values, tile);
      return true;
    });
    kernels.flush(tile, nodes.data(), slot, box_of(block));
  }
  sum(nodes);
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
}

void MPMNodeScalar::gradients_to_points(const Conduct &take)
{
  field.nodes.complete(value.data(), 1, 1);
  double q[BATCH + SPARE_ROWS][4];
  double *const tile = tiles[1].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    kernels.load(tile, value.data(), field.grid.blocks[block.slot].slot, box_of(block));
    visit(block, GRADIENT_SLOPES, nullptr,
          [&](const auto &run, int first, int n, const auto &prepare) {
            prepare();
            kernels.get(stencil, tile, q[0]);
            take(run, first, n, q);
            return true;
          });
  }
  std::fill(tiles[1].begin(), tiles[1].end(), 0.0);
}

void MPMNodeScalar::add_up(const GiveValues &give, std::vector<double> &nodes)
{
  nodes.assign(field.grid.nnodes(), 0.0);
  double values[BATCH];
  double *const tile = tiles[0].data();
  for (const auto &block : field.map->active) {
    if (box_of(block)[0] > box_of(block)[3]) continue;
    visit(block, NO_SLOPES, nullptr, [&](const auto &run, int first, int n, const auto &prepare) {
      prepare();
      give(run, first, n, values);
      kernels.add_values(stencil, values, tile);
      return true;
    });
    kernels.flush(tile, nodes.data(), field.grid.blocks[block.slot].slot, box_of(block));
  }
  sum(nodes);
}

double MPMNodeScalar::memory_usage() const
{
  double bytes = 0.0;
  for (const auto *list :
       {&capacity, &volume, &value, &before, &rate, &first_term, &tiles[0], &tiles[1], &tiles[2]})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_wetting.h"

#include "flow/mpm_flow_regions.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// depth in regions up to which values are continued; longest way along a wall, in regions
// [spacings]
static constexpr double DEEPEST = 1.6, FARTHEST = 3.0;
// least slope of values that gives a direction, per spacing
static constexpr double LEAST_SLOPE = 1.0e-6;
// passes that find values behind walls that depend on each other
static constexpr int PASSES = 3;

void MPMFlowWetting::find_walls()
{
  at_walls.clear();
  hidden.clear();
  const double h = cells.lattice.h;
  for (int k = 0; k < (int) cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    for (int s = 0; cotangent != 0.0 && s < 2 * cells.lattice.dim; s++)
      if (cell.walls >> s & 1) at_walls.push_back({k, s / 2, s % 2, {}});
  }
  if (!regions) return;
  behind.assign(cells.size(), 0);
  for (int64_t number = 0; number < cells.size(); number++)
    behind[number] = regions->level(number) <= 0.0;
  for (int k = 0; k < (int) cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    if (!behind[cell.number] || regions->level(cell.number) < -DEEPEST * h) continue;
    Hidden one = {k, {}, 0.0, {}};
    one.depth = regions->find_way_out(cell, one.out) / h;
    hidden.push_back(one);
  }
}

void MPMFlowWetting::complete(std::vector<double> &values, bool find, bool skip_zero)
{
  cells.publish(values.data(), 1);
  cells.reflect_cells(values.data());
  if (regions) fill_regions(values, find, skip_zero);
  if (cotangent != 0.0 && !skip_zero) fill_walls(values, find);
}

/* ----------------------------------------------------------------------
   Linear function between the middles of cells, at a place that is way from the middle of a cell
   [spacings].
------------------------------------------------------------------------- */

double MPMFlowWetting::value_at(const std::vector<double> &values, const MPMFlowLattice::Cell &cell,
                                const double *way, bool skip_zero) const
{
  const auto &lattice = cells.lattice;
  const int dim = lattice.dim;
  double share[3], sum = 0.0, weight = 0.0;
  int base[3] = {0, 0, 0};
  for (int d = 0; d < dim; d++) {
    const double low = std::floor(way[d]);
    share[d] = way[d] - low;
    base[d] = cell.index[d] + (int) low;
  }
  for (int k = 0; k < 1 << dim; k++) {
    int index[3] = {0, 0, 0};
    double w = 1.0;
    for (int d = 0; d < dim; d++) {
      index[d] = base[d] + (k >> d & 1);
      w *= k >> d & 1 ? share[d] : 1.0 - share[d];
      if (!lattice.periodic[d]) index[d] = std::max(0, std::min(index[d], lattice.ncell[d] - 1));
    }
    const int number = w > 0.0 ? cells.canonical(index) : -1;
    if (number < 0 || (skip_zero && values[number] == 0.0)) continue;
    sum += w * values[number];
    weight += w;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

void MPMFlowWetting::fill_regions(std::vector<double> &values, bool find, bool skip_zero)
{
  const int dim = cells.lattice.dim;
  for (int pass = 0; pass < PASSES; pass++) {
    next = values;
    for (auto &one : hidden) {
      const auto &cell = cells.cells[one.cell];
      double way[3];
      for (int d = 0; d < 3; d++) way[d] = 2.0 * one.depth * one.out[d];
      if (find &&
          cotangent !=
              0.0) {    // direction along the wall in which values at the mirror image decrease
        double slope[3] = {0.0, 0.0, 0.0}, normal = 0.0, square = 0.0;
        for (int d = 0; d < dim; d++) {
          double up[3] = {way[0], way[1], way[2]}, down[3] = {way[0], way[1], way[2]};
          up[d] += 0.5;
          down[d] -= 0.5;
          slope[d] = value_at(values, cell, up, false) - value_at(values, cell, down, false);
          normal += slope[d] * one.out[d];
        }
        for (int d = 0; d < dim; d++) {
          slope[d] -= normal * one.out[d];
          square += slope[d] * slope[d];
        }
        for (int d = 0; d < 3; d++)
          one.along[d] = square > LEAST_SLOPE * LEAST_SLOPE ? -slope[d] / std::sqrt(square) : 0.0;
      }
      const double far = std::max(-FARTHEST, std::min(2.0 * one.depth * cotangent, FARTHEST));
      for (int d = 0; d < dim; d++) way[d] -= far * one.along[d];
      next[cell.number] = value_at(values, cell, way, skip_zero);
    }
    cells.keep_owned(next.data(), 1);
    cells.publish(next.data(), 1);
    cells.reflect_cells(next.data());
    values.swap(next);
  }
}

/** Value at the next cell along a wall, in a layer at walls of an axis. */
double MPMFlowWetting::along_wall(const std::vector<double> &layer, const AtWall &at, int axis,
                                  int side) const
{
  const auto &cell = cells.cells[at.cell];
  const int64_t next = cell.walls >> (2 * axis + side) & 1 ? cell.number
                                                           : cell.near[2 * axis + side];
  return layer[next * cells.lattice.dim + at.axis];
}

/* ----------------------------------------------------------------------
   The one layer behind walls of the box has the values at the wall, shifted by the cotangent, in
   steps of at most a spacing.
------------------------------------------------------------------------- */

void MPMFlowWetting::fill_walls(std::vector<double> &values, bool find)
{
  const int dim = cells.lattice.dim;
  for (int side = 0; side < 2; side++) {
    layers[side].assign(cells.size() * dim, 0.0);
    for (const auto &at : at_walls) {
      const int64_t number = cells.cells[at.cell].number;
      if (at.side == side) layers[side][number * dim + at.axis] = values[number];
    }
    cells.publish(layers[side].data(), dim);
  }
  const int steps = std::max(1, (int) std::ceil(std::fabs(cotangent) - 1.0e-9));
  const double step = cotangent / steps;
  for (int k = 0; k < steps; k++)
    for (int side = 0; side < 2; side++) {
      auto &layer = layers[side];
      next.assign(cells.size() * dim, 0.0);
      for (auto &at : at_walls) {
        if (at.side != side) continue;
        const int64_t here = (int64_t) cells.cells[at.cell].number * dim + at.axis;
        double slope[3] = {0.0, 0.0, 0.0}, curve[3] = {0.0, 0.0, 0.0}, square = 0.0;
        for (int d = 0; d < dim; d++) {
          if (d == at.axis) continue;
          const double up = along_wall(layer, at, d, 1), down = along_wall(layer, at, d, 0);
          slope[d] = 0.5 * (up - down);
          curve[d] = up - 2.0 * layer[here] + down;
          square += slope[d] * slope[d];
        }
        for (int d = 0; find && k == 0 && d < 3; d++)
          at.along[d] = square > LEAST_SLOPE * LEAST_SLOPE ? -slope[d] / std::sqrt(square) : 0.0;
        double value = layer[here];
        for (int d = 0; d < dim; d++) {
          const double way = -step * at.along[d];
          value += way * slope[d] + 0.5 * way * way * curve[d];
        }
        if (dim == 3) {
          const int c = at.axis == 0 ? 1 : 0, d = at.axis == 2 ? 1 : 2;
          const auto &cell = cells.cells[at.cell];
          if (!(cell.walls >> 2 * c & 3) && !(cell.walls >> 2 * d & 3)) {
            constexpr int STRIDE[3] = {9, 3, 1};
            const int *const around = cells.around.data() + (int64_t) at.cell * 27 + 13;
            const auto corner = [&](int a, int b) {
              return layer[(int64_t) around[a * STRIDE[c] + b * STRIDE[d]] * dim + at.axis];
            };
            value += step * step * at.along[c] * at.along[d] * 0.25 *
                (corner(1, 1) - corner(1, -1) - corner(-1, 1) + corner(-1, -1));
          }
        }
        next[here] = value;
      }
      cells.publish(next.data(), dim);
      layer.swap(next);
    }
  cells.fill_images(values.data(), [this, dim](int64_t of, int axis, int side, double value) {
    return cells.is_inside(of) ? layers[side][of * dim + axis] : value;
  });
}

double MPMFlowWetting::memory_usage() const
{
  double bytes =
      hidden.capacity() * sizeof(Hidden) + at_walls.capacity() * sizeof(AtWall) + behind.capacity();
  for (const auto *list : {&layers[0], &layers[1], &next})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

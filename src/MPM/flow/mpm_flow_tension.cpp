/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_tension.h"

#include "flow/mpm_flow_regions.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// least slope of smoothed shares, per spacing, that gives a normal; that of a surface is 0.28
static constexpr double LEAST_SLOPE = 0.02;
// depth in regions up to which values are continued; longest way along a wall, in regions
// [spacings]
static constexpr double DEEPEST = 1.6, FARTHEST = 3.0;
// least slope of values that gives a direction along a wall, per spacing
static constexpr double LEAST_DIRECTION = 1.0e-6;
// passes that find values behind walls that depend on each other
static constexpr int WALL_PASSES = 3;

/** Exactly zero for a right angle. */
static double cotangent(double angle)
{
  const double c = std::cos(angle);
  return std::fabs(c) < 1.0e-12 ? 0.0 : c / std::sin(angle);
}

MPMFlowTension::MPMFlowTension(const MPMFlowLattice &cells, const MPMFlowPressure &water,
                               double angle) :
    cells(cells),
    water(water), wetting(cells, water.regions, cotangent(angle))
{
}

/** Smoothed shares. Cells below the surface count as full: there, only unevenly spaced points would
 *  be seen, as if they were curvature. */
void MPMFlowTension::find_smooth(const std::vector<double> &share)
{
  smooth.assign(cells.size(), 0.0);
  for (const auto &cell : cells.cells)
    smooth[cell.number] = water.is_deep(cell) ? 1.0 : std::min(1.0, share[cell.number]);
  wetting.complete(smooth, true);
  // along all axes at once: values behind walls depend on those at walls, so that one axis after
  // the other would not be the same in another order
  const int dim = cells.lattice.dim, naround = dim == 2 ? 9 : 27;
  double weights[27];
  for (int j = 0; j < naround; j++) {
    weights[j] = 1.0;
    for (int d = 0, rest = j; d < dim; d++, rest /= 3) weights[j] *= rest % 3 == 1 ? 0.5 : 0.25;
  }
  for (int pass = 0; pass < PASSES; pass++) {
    other.assign(cells.size(), 0.0);
    const int *at = cells.around.data();
    for (const auto &cell : cells.cells)
      for (int j = 0; j < naround; j++) other[cell.number] += weights[j] * smooth[*at++];
    wetting.complete(other, true);
    smooth.swap(other);
  }
}

/** div n at the middles of cells, in 1/spacing; zero where there is no normal. */
void MPMFlowTension::find_curvature()
{
  const int dim = cells.lattice.dim;
  for (int d = 0; d < dim; d++) {
    second[d].assign(cells.size(), 0.0);
    for (const auto &cell : cells.cells)
      second[d][cell.number] =
          smooth[cell.near[2 * d]] - 2.0 * smooth[cell.number] + smooth[cell.near[2 * d + 1]];
    wetting.complete(second[d], false);
  }
  curvature.assign(cells.size(), 0.0);
  const int here = dim == 2 ? 4 : 13, naround = dim == 2 ? 9 : 27;
  for (std::size_t k = 0; k < cells.cells.size(); k++) {
    const auto &cell = cells.cells[k];
    if (wetting.is_behind(cell.number)) continue;
    const int *const at = cells.around.data() + k * naround + here;
    const auto corners = [&](const std::vector<double> &of, int c, int d) {
      const int a = MPMFlowLattice::STRIDE[dim - 2][c], b = MPMFlowLattice::STRIDE[dim - 2][d];
      return 0.25 * (of[at[a + b]] - of[at[a - b]] - of[at[b - a]] + of[at[-a - b]]);
    };
    double slope[3], H[3][3], square = 0.0, trace = 0.0, along = 0.0;
    for (int d = 0; d < dim; d++) {
      const int lower = cell.near[2 * d], upper = cell.near[2 * d + 1];
      const auto &curve = second[d];
      slope[d] = 0.5 * (smooth[upper] - smooth[lower]) - (curve[upper] - curve[lower]) / 12.0;
      H[d][d] =
          curve[cell.number] - (curve[upper] - 2.0 * curve[cell.number] + curve[lower]) / 12.0;
      square += slope[d] * slope[d];
      trace += H[d][d];
      for (int c = 0; c < d; c++)
        H[c][d] = H[d][c] =
            corners(smooth, c, d) - (corners(second[c], c, d) + corners(second[d], c, d)) / 6.0;
    }
    if (square < LEAST_SLOPE * LEAST_SLOPE) continue;
    for (int c = 0; c < dim; c++)
      for (int d = 0; d < dim; d++) along += slope[c] * H[c][d] * slope[d];
    const double unclamped = (along / square - trace) / std::sqrt(square);
    curvature[cell.number] = std::max(1.0 - dim, std::min(unclamped, dim - 1.0));
  }
  wetting.complete(curvature, false, true);
}

void MPMFlowTension::find(const std::vector<double> &share, double factor,
                          std::vector<double> &at_faces)
{
  const int dim = cells.lattice.dim;
  wetting.find_walls();
  find_smooth(share);
  find_curvature();
  at_faces.assign(cells.size() * dim, 0.0);
  factor /= cells.lattice.h;
  for (const auto &cell : cells.cells)
    for (int d = 0; d < dim; d++) {
      const int here = cell.number, lower = cell.near[2 * d];
      if (cell.walls >> 2 * d & 1 || water.is_wet(here) == water.is_wet(lower)) continue;
      const int in = water.is_wet(here) ? here : lower, out = in == here ? lower : here;
      double place = water.distance(in, out);
      if (curvature[out] == 0.0) place = 0.0;
      if (curvature[in] == 0.0) place = 1.0;
      at_faces[(int64_t) here * dim + d] =
          factor * ((1.0 - place) * curvature[in] + place * curvature[out]);
    }
  cells.publish(at_faces.data(), dim);
}

/* ---------------------------------------------------------------------- */

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
  for (int pass = 0; pass < WALL_PASSES; pass++) {
    next = values;
    for (auto &one : hidden) {
      const auto &cell = cells.cells[one.cell];
      double way[3];
      for (int d = 0; d < 3; d++) way[d] = 2.0 * one.depth * one.out[d];
      // direction along the wall in which values at the mirror image decrease
      if (find && cotangent != 0.0) {
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
          one.along[d] = square > LEAST_DIRECTION * LEAST_DIRECTION ? -slope[d] / std::sqrt(square)
                                                                    : 0.0;
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
          at.along[d] = square > LEAST_DIRECTION * LEAST_DIRECTION ? -slope[d] / std::sqrt(square)
                                                                   : 0.0;
        double value = layer[here];
        for (int d = 0; d < dim; d++) {
          const double way = -step * at.along[d];
          value += way * slope[d] + 0.5 * way * way * curve[d];
        }
        if (dim == 3) {
          const int c = at.axis == 0 ? 1 : 0, d = at.axis == 2 ? 1 : 2;
          const auto &cell = cells.cells[at.cell];
          if (!(cell.walls >> 2 * c & 3) && !(cell.walls >> 2 * d & 3)) {
            const int *const STRIDE = MPMFlowLattice::STRIDE[1];
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
  cells.fill_images(values.data(), [this, dim](int64_t of, int axis, int side) {
    return layers[side][of * dim + axis];
  });
}

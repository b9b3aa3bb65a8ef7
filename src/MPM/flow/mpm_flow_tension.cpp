/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_tension.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// least slope of smoothed shares, per spacing, that gives a normal; that of a surface is 0.28
static constexpr double LEAST_SLOPE = 0.02;
// strides of neighbors among the cells around one
static constexpr int STRIDE[2][3] = {{3, 1, 0}, {9, 3, 1}};

double MPMFlowTension::stable_dt(double tension, double h)
{
  return std::sqrt(h * h * h / (4.0 * 3.14159265358979323846 * tension));
}

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
  for (int pass = 0; pass < PASSES; pass++)
    for (int d = 0; d < cells.lattice.dim; d++) {
      other.assign(cells.size(), 0.0);
      for (const auto &cell : cells.cells)
        other[cell.number] = 0.5 * smooth[cell.number] +
            0.25 * (smooth[cell.near[2 * d]] + smooth[cell.near[2 * d + 1]]);
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
      const int a = STRIDE[dim - 2][c], b = STRIDE[dim - 2][d];
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

double MPMFlowTension::memory_usage() const
{
  double bytes = wetting.memory_usage();
  for (const auto *list : {&smooth, &other, &second[0], &second[1], &second[2], &curvature})
    bytes += list->capacity() * sizeof(double);
  return bytes;
}

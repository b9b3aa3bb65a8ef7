/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Values of cells and faces next to regions: filled shares, velocities of closed faces, and
// pressures of closed cells

#include "flow/mpm_flow_regions.h"

#include "flow/mpm_flow_cut_cell.h"

#include "math_extra.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// open share of the surroundings of a cell below which the cells around count, too
static constexpr double LITTLE_VOLUME = 0.3;
// open share from which on that of water shows the depth of a cell; open share from which on a cell
// is whole; share of water from which on it is full but for round-off
static constexpr double ENOUGH = 0.4, WHOLE = 0.75, FULL = 1.0 - 1.0e-9;
// least cosine between a floor and the surface; a cell has a surface with a share of water above
// SURFACE and below 1 - SURFACE; least slope of shares that shows the direction of the surface, and
// what keeps its equations regular
static constexpr double FLOOR = 0.3, SURFACE = 0.1, LEAST_SLOPE = 0.3, REGULAR = 1.0e-3;
// layers of closed cells that points near walls reach
static constexpr int LAYERS = 2;

void MPMFlowRegions::normalize(std::vector<double> &share) const
{
  values.assign(cells.size(), 0.0);
  for (int64_t number = 0; number < cells.size(); number++)
    if (volume_fractions[number] < 1.0 && volume_fractions[number] >= LITTLE_VOLUME)
      share[number] /= volume_fractions[number];
  for (const auto &cell : cells.cells) {
    double &mine = values[cell.number];
    mine = share[cell.number];
    if (volume_fractions[cell.number] >= LITTLE_VOLUME) continue;
    double sum = 0.0, weight = 0.0;
    for (int s = 0; s < 2 * dim; s++) {
      const int other = cell.near[s];
      const double a = aperture(s % 2 ? other : cell.number, s / 2);
      if (cell.walls >> s & 1 || volume_fractions[other] < LITTLE_VOLUME) continue;
      sum += a * share[other];
      weight += a;
    }
    if (weight > 0.0)
      mine =
          (mine + (LITTLE_VOLUME - volume_fractions[cell.number]) * sum / weight) / LITTLE_VOLUME;
    else
      mine = volume_fractions[cell.number] > 0.0 ? mine / volume_fractions[cell.number] : 0.0;
  }
  cells.publish(values.data(), 1);
  cells.reflect_cells(values.data());
  share.swap(values);
  continue_surface(share);
}

/* ----------------------------------------------------------------------
   Only a part of the surroundings of a cell next to a wall is open, above a floor the upper part.
   Their filled share therefore does not show how deep the middle of the cell is below a surface.
   Where enough is open, it shows the depth together with the direction of the surface around. Where
   less is open, the surface of cells around is continued as a plane.
------------------------------------------------------------------------- */

void MPMFlowRegions::continue_surface(std::vector<double> &share) const
{
  double down[3], normal[3];
  const auto change = [&](const auto &f) {
    values.assign(cells.size(), 0.0);
    for (std::size_t k = 0; k < cells.cells.size(); k++) {
      const int number = cells.cells[k].number;
      values[number] = share[number];
      if (volume_fractions[number] < 1.0 && !closed[number]) f(k, number, values[number]);
    }
    cells.publish(values.data(), 1);
    cells.reflect_cells(values.data());
    share.swap(values);
  };

  change([&](std::size_t k, int number, double &mine) {
    if (volume_fractions[number] < ENOUGH || mine <= 0.0 || mine >= FULL ||
        !find_surface(k, share, WHOLE, down, normal))
      return;
    mine = MPMFlowCutCell::share_without_wall(dim, levels[number] / cells.lattice.h, normal, down,
                                              mine);
  });

  change([&](std::size_t k, int number, double &mine) {
    if (volume_fractions[number] >= ENOUGH || !find_surface(k, share, ENOUGH, down, normal)) return;
    double depth = 0.0, weight = 0.0;
    visit_around(k, ENOUGH, [&](int other, const double *offset) {
      const double s = share[other];
      if (s < SURFACE || s > 1.0 - SURFACE) return;
      const double of = s < 0.5 ? std::sqrt(2.0 * s) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - s));
      depth += of - MathExtra::dot3(down, offset);
      weight += 1.0;
    });
    if (weight == 0.0) return;
    depth = std::max(-1.0, std::min(depth / weight, 1.0));
    mine = std::max(mine,
                    depth < 0.0 ? 0.5 * (1.0 + depth) * (1.0 + depth)
                                : 1.0 - 0.5 * (1.0 - depth) * (1.0 - depth));
  });
}

/** Calls f(number, offset[3]) for the cells around a cell, and for itself, whose surroundings are
 *  open by this share at least. */
template <class F> void MPMFlowRegions::visit_around(std::size_t k, double open, const F &f) const
{
  const int naround = dim == 2 ? 9 : 27;
  const int *const at = cells.around.data() + (int64_t) k * naround;
  for (int j = 0; j < naround; j++) {
    if (at[j] < 0 || volume_fractions[at[j]] < open) continue;
    const int plain = dim == 2 ? 3 * j : j;    // as if there were three layers
    const double offset[3] = {(double) (plain / 9 - 1), (double) (plain / 3 % 3 - 1),
                              dim == 2 ? 0.0 : (double) (plain % 3 - 1)};
    f(at[j], offset);
  }
}

/** Direction into the water and out of the wall at a cell above a floor. The former is that in
 *  which the shares of cells around grow, by least squares. Returns false if there is no surface,
 *  or no floor. */
bool MPMFlowRegions::find_surface(std::size_t k, const std::vector<double> &share, double open,
                                  double *down, double *normal) const
{
  double n = 0.0, mean = 0.0, middle[3] = {0.0, 0.0, 0.0};
  visit_around(k, open, [&](int other, const double *offset) {
    n += 1.0;
    mean += std::min(1.0, share[other]);
    for (int d = 0; d < dim; d++) middle[d] += offset[d];
  });
  if (n == 0.0) return false;
  double A[3][3] = {{REGULAR, 0.0, 0.0}, {0.0, REGULAR, 0.0}, {0.0, 0.0, REGULAR}};
  double b[3] = {0.0, 0.0, 0.0}, inverse[3][3], x[3];
  visit_around(k, open, [&](int other, const double *offset) {
    for (int d = 0; d < dim; d++) {
      b[d] += (std::min(1.0, share[other]) - mean / n) * (offset[d] - middle[d] / n);
      for (int e = 0; e < dim; e++)
        A[d][e] += (offset[d] - middle[d] / n) * (offset[e] - middle[e] / n);
    }
  });
  MathExtra::invert3(A, inverse);
  MathExtra::matvec(inverse, b, down);
  const double slope = MathExtra::len3(down);
  int wall;
  place(cells.cells[k].index, MIDDLE, x);
  distance(x, FAR * cells.lattice.h, wall);
  normal_at(wall, x, normal);
  if (slope < LEAST_SLOPE * std::min(1.0, 2.0 * mean / n))    // equal depths: a film along the wall
    for (int d = 0; d < 3; d++) down[d] = -normal[d];
  else
    for (int d = 0; d < 3; d++) down[d] /= slope;
  return -MathExtra::dot3(down, normal) >= FLOOR;
}

void MPMFlowRegions::hold(std::vector<double> &velocity, bool moving) const
{
  const int here = dim == 2 ? 4 : 13, naround = dim == 2 ? 9 : 27;
  const int *const stride = MPMFlowLattice::STRIDE[dim - 2];
  changed.resize(helds.size());
  for (std::size_t k = 0; k < helds.size(); k++) {
    const auto &held = helds[k];
    const int *const at = cells.around.data() + (int64_t) held.cell * naround + here;
    const int c = held.axis;
    double into = 0.0;
    for (int d = 0; d < dim; d++) {
      const auto v = [&](int offset) {
        return velocity[(int64_t) at[offset] * dim + d];
      };
      const double u =
          d == c ? v(0) : 0.25 * (v(0) + v(stride[d]) + v(-stride[c]) + v(stride[d] - stride[c]));
      into += held.normal[d] * (moving ? u - held.velocity[d] : u);
    }
    const int64_t face = (int64_t) cells.cells[held.cell].number * dim + c;
    changed[k] = velocity[face] - into * held.normal[c];
  }
  for (std::size_t k = 0; k < helds.size(); k++)
    velocity[(int64_t) cells.cells[helds[k].cell].number * dim + helds[k].axis] = changed[k];
  cells.keep_owned(velocity.data(), dim);
  cells.publish(velocity.data(), dim);
}

/* ----------------------------------------------------------------------
   Owners of wet cells have the slopes of psi away from closed neighbors; the next layer has the
   same slopes.
------------------------------------------------------------------------- */

void MPMFlowRegions::extrapolate(std::vector<double> &psi, const std::vector<double> &wet) const
{
  const int width = dim + 2;    // psi, slopes per spacing, and whether these are known
  std::vector<double> &all = slopes;
  all.assign(cells.size() * width, 0.0);
  for (const auto &cell : cells.cells) {
    double *const mine = all.data() + (int64_t) cell.number * width;
    mine[0] = psi[cell.number];
    if (!(wet[cell.number] > 0.0)) continue;
    mine[dim + 1] = 1.0;
    for (int d = 0; d < dim; d++) {
      double sum = 0.0;
      int n = 0;
      for (int s = 0; s < 2; s++) {
        const int other = cell.near[2 * d + s];
        if (cell.walls >> (2 * d + s) & 1 || !(wet[other] > 0.0)) continue;
        sum += (s ? 1.0 : -1.0) * (psi[other] - psi[cell.number]);
        n++;
      }
      if (n) mine[1 + d] = sum / n;
    }
  }
  cells.publish(all.data(), width);
  for (int layer = 0; layer < LAYERS; layer++) {
    std::vector<double> next(all.size(), 0.0);
    for (const auto &cell : cells.cells) {
      const double *const from = all.data() + (int64_t) cell.number * width;
      double *const mine = next.data() + (int64_t) cell.number * width;
      std::copy_n(from, width, mine);
      if (from[dim + 1] > 0.0 || !closed[cell.number]) continue;
      double sum[4] = {0.0, 0.0, 0.0, 0.0};
      int n = 0;
      for (int s = 0; s < 2 * dim; s++) {
        if (cell.walls >> s & 1) continue;
        const double *const other = all.data() + (int64_t) cell.near[s] * width;
        if (!(other[dim + 1] > 0.0)) continue;
        sum[0] += other[0] + (s % 2 ? -1.0 : 1.0) * other[1 + s / 2];
        for (int d = 0; d < dim; d++) sum[1 + d] += other[1 + d];
        n++;
      }
      if (n == 0) continue;
      for (int k = 0; k <= dim; k++) mine[k] = sum[k] / n;
      mine[dim + 1] = 1.0;
    }
    cells.publish(next.data(), width);
    all.swap(next);
  }
  for (int64_t number = 0; number < cells.size(); number++)
    if (closed[number]) psi[number] = all[number * width];
}

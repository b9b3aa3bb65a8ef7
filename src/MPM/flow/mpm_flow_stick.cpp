/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "flow/mpm_flow_stick.h"

#include "flow/mpm_flow_regions.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// distance up to which walls are looked at; least open share of an edge, and shortest distance from
// a face to a wall; the same for velocities continued into walls [spacings]
static constexpr double FAR = 2.5, NEAREST = 0.02, NEAREST_HELD = 0.25;
// places along an axis at which open shares are found
static constexpr int PLACES = 8;
// open share of a face whose middle is in a wall that shows a thin wall
static constexpr double MOST_BEHIND = 0.6;
// open share below which a face has the velocity of the wall: the pressure of cells behind such
// openings would hardly be determined, and take thousands of iterations
static constexpr double LEAST_OPEN = 0.1;
// least open share of a cell
static constexpr double LEAST_VOLUME = 0.01;
// where rounding decides whether the middle of a face is in a wall, it is [spacings]
static constexpr double ROUNDING = 1.0e-6;
// area below which a wall drags at a face itself, and this drag (times viscosity and mass)
static constexpr double NO_AREA = 0.2, DRAG = 3.0;
// layers of faces in walls that points next to the walls reach
static constexpr int LAYERS = 2;

namespace {
/** Share of a segment of length one, and of a square or box with such sides, in which a linear
 *  function with these slopes is positive. middle: its value there. Exact along the steepest
 *  axis. */
double positive(double middle, double slope)
{
  const double most = middle + 0.5 * std::fabs(slope), least = middle - 0.5 * std::fabs(slope);
  if (most <= 0.0) return 0.0;
  return least >= 0.0 ? 1.0 : most / (most - least);
}

double positive(double middle, double a, double b, double c = 0.0)
{
  double slope[3] = {a, b, c};
  std::sort(slope, slope + 3, [](double one, double other) {
    return std::fabs(one) > std::fabs(other);
  });
  const double reach = 0.5 * (std::fabs(slope[0]) + std::fabs(slope[1]) + std::fabs(slope[2]));
  if (std::fabs(middle) >= reach) return middle > 0.0 ? 1.0 : 0.0;
  const int m = slope[1] == 0.0 ? 1 : PLACES, n = slope[2] == 0.0 ? 1 : PLACES;
  double sum = 0.0;
  for (int j = 0; j < m; j++)
    for (int k = 0; k < n; k++)
      sum += positive(middle + slope[1] * ((j + 0.5) / m - 0.5) + slope[2] * ((k + 0.5) / n - 0.5),
                      slope[0]);
  return sum / (m * n);
}
}    // namespace

void MPMFlowStick::find(bool again)
{
  if (!again && !regions.any_move() && nbuild == cells.nbuild) return;
  nbuild = cells.nbuild;
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  level.resize(cells.size() * dim);
  carried.assign(cells.size() * dim, 0.0);
  masses.assign(cells.size() * dim, 1.0);
  drags.assign(cells.size() * dim, 0.0);
  areas.assign(cells.size() * dim * dim, 1.0);
  volume_fractions.assign(cells.size(), 1.0);
  edge_volume_fractions.assign(cells.size() * npair(), 1.0);
  nearest.assign(cells.size() * npair(), -1);
  for (int64_t number = 0; number < cells.size(); number++) {
    for (int c = 0; c < dim; c++) {
      const int64_t face = number * dim + c;
      level[face] = regions.level_of_face(number, c, FAR * h, carried[face]) / h;
      if (regions.aperture(number, c) == 0.0) level[face] = std::min(level[face], 0.0);
    }
    if (regions.level(number) > FAR * h) continue;
    for (int c = 0; c < dim; c++) {
      find_face(number * dim + c, regions.aperture(number, c));
      for (int d = c + 1; d < dim; d++) find_edge(number, c, d);
    }
    constexpr double middle[3] = {0.5, 0.5, 0.5};
    double slope[3];
    int wall;
    const double in_middle = plane_at(number, middle, slope, wall);
    volume_fractions[number] =
        std::max(LEAST_VOLUME, positive(in_middle, slope[0], slope[1], slope[2]));
  }
}

/** Wall next to a place in a cell, as a plane: distance from it, and slopes of this distance
 *  [spacings]. */
double MPMFlowStick::plane_at(int64_t cell, const double *offset, double *slope, int &wall) const
{
  const double h = cells.lattice.h;
  std::fill_n(slope, 3, 0.0);
  const double distance = regions.plane_at(cell, offset, FAR * h, slope, wall) / h;
  if (cells.lattice.dim == 2) slope[2] = 0.0;
  return distance;
}

void MPMFlowStick::find_face(int64_t face, double open)
{
  const int dim = cells.lattice.dim, c = face % dim;
  double *const area = &areas[face * dim];
  double offset[3] = {0.5, 0.5, 0.5}, slope[3];
  offset[c] = 0.0;
  int wall;
  const double middle = plane_at(face / dim, offset, slope, wall);
  double most = open, least = 1.0;
  for (int d = 0; d < dim; d++) {
    if (d == c) continue;
    area[d] = positive(middle - ROUNDING, slope[c], dim == 3 ? slope[3 - c - d] : 0.0);
    most = std::max(most, area[d]);
    least = std::min(least, area[d]);
  }
  // a wall that is thinner than a spacing has no plane
  const bool is_thin = middle <= 0.0 && open > MOST_BEHIND;
  if (open < LEAST_OPEN || is_thin) {
    std::fill_n(area, dim, 0.0);
    masses[face] = 0.0;
    return;
  }
  // of its surroundings, two spacings wide, shear takes up the forces; a part of them is right for
  // velocities of points
  masses[face] =
      most * 0.25 * (3.0 + positive(middle, 2.0 * slope[0], 2.0 * slope[1], 2.0 * slope[2]));
  drags[face] = DRAG * open * std::pow(std::max(0.0, 1.0 - least / NO_AREA), 4) / masses[face];
}

void MPMFlowStick::find_edge(int64_t cell, int c, int d)
{
  const int64_t edge = cell * npair() + c + d - 1;
  double offset[3] = {0.5, 0.5, 0.5}, slope[3];
  offset[c] = offset[d] = 0.0;
  int wall;
  const double middle = plane_at(cell, offset, slope, wall);
  if (middle >= FAR) return;
  nearest[edge] = wall;
  edge_volume_fractions[edge] = std::max(NEAREST, positive(middle, slope[0], slope[1], slope[2]));
}

double MPMFlowStick::velocity_near(int64_t cell, int pair, int64_t face) const
{
  const int wall = nearest[cell * npair() + pair], dim = cells.lattice.dim;
  return wall < 0 || !regions.any_move() ? 0.0
                                         : regions.velocity_at_face(wall, face / dim, face % dim);
}

MPMFlowStick::Gap MPMFlowStick::between(int64_t upper, int64_t lower) const
{
  const bool up = is_wall(upper), down = is_wall(lower);
  if (!up && !down) return {1.0, 0.0};
  if (up && down) return {1.0, carried[upper] - carried[lower]};
  const int64_t in = up ? lower : upper, wall = up ? upper : lower;
  const double share = std::max(NEAREST, level[in] / std::max(level[in] - level[wall], 1.0e-10));
  const double v = (1.0 - share) * carried[in] + share * carried[wall];
  return {share, up ? v : -v};
}

/* ----------------------------------------------------------------------
   Owners of faces in walls take velocities from the faces around that are farther out.
------------------------------------------------------------------------- */

void MPMFlowStick::hold(std::vector<double> &velocity)
{
  constexpr double OUTWARDS = 0.1;
  const int dim = cells.lattice.dim;
  known.assign(velocity.size(), 0.0);
  for (std::size_t k = 0; k < velocity.size(); k++) known[k] = is_wall(k) ? 0.0 : 1.0;
  for (int layer = 0; layer < LAYERS; layer++) {
    other = velocity;
    other_known = known;
    for (const auto &cell : cells.cells)
      for (int c = 0; c < dim; c++) {
        const int64_t face = (int64_t) cell.number * dim + c;
        if (known[face] > 0.0) continue;
        double sum = 0.0, n = 0.0;
        for (int s = 0; s < 2 * dim; s++) {
          const int64_t next = (int64_t) cell.near[s] * dim + c;
          const double out = level[next] - level[face];
          if (cells.ends_at_wall(cell, c, s) || !(known[next] > 0.0) || out < OUTWARDS) continue;
          const double from =
              std::copysign(std::max(NEAREST_HELD, std::fabs(level[next])), level[next]);
          const double ratio = std::max(-1.0, std::min(level[face] / from, 1.5));
          sum += out * out * ratio * (velocity[next] - carried[next]);
          n += out * out;
        }
        if (n == 0.0) {
          other[face] = carried[face];
          continue;
        }
        other[face] = carried[face] + sum / n;
        other_known[face] = 1.0;
      }
    cells.keep_owned(other.data(), dim);
    cells.keep_owned(other_known.data(), dim);
    cells.publish(other.data(), dim);
    cells.publish(other_known.data(), dim);
    velocity.swap(other);
    known.swap(other_known);
  }
}

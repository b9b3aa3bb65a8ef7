/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_flow_stick.h"

#include "mpm_flow_regions.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

// distance up to which walls are looked at; shortest distance from a face to a wall that stresses use;
// the same for velocities continued into walls [spacings]
static constexpr double FAR = 2.5, NEAREST = 0.05, NEAREST_HELD = 0.25;
// layers of faces in walls that points next to the walls reach
static constexpr int LAYERS = 2;

void MPMFlowStick::find(bool again)
{
  if (!again && !regions.any_move() && nbuild == cells.nbuild) return;
  nbuild = cells.nbuild;
  const int dim = cells.lattice.dim;
  const double h = cells.lattice.h;
  level.resize(cells.size() * dim);
  carried.assign(cells.size() * dim, 0.0);
  for (int64_t number = 0; number < cells.size(); number++)
    for (int c = 0; c < dim; c++) {
      const int64_t face = number * dim + c;
      level[face] = regions.level_of_face(number, c, FAR * h, carried[face]) / h;
      if (regions.open(number, c) == 0.0) level[face] = std::min(level[face], 0.0);
    }
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
          if (cell.walls >> s & 1 || !(known[next] > 0.0) || out < OUTWARDS) continue;
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

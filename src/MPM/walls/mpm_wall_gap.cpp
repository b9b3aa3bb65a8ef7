/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* The mean distance of the points that a node at the wall sees, for material in front of a plane
 *  wall,
 *
 *    d_0 = int_0^inf x M(x) dx / int_0^inf M(x) dx     (0.406 h, quadratic, node in the wall)
 *
 *  is greater when there is a gap, by about 0.6 of its width. Points at the centers of cells of
 *  size s stand for the integrals as the midpoint rule does, whose error at the wall is (Euler,
 *  Maclaurin)
 *
 *    sum_p s f(x_p) - int_0^inf f dx = s^2/24 f'(0) + O(s^4)
 *
 *  Points with a size (GIMP, CPDI) integrate M, which is linear for them, exactly, but x is that of
 *  their center: - s^2/12 M'.
 *  Points that are about to cross the wall count as deep inside, so that single ones do not
 *  pass. */

#include "walls/mpm_wall_gap.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int REACH = 3, SAMPLES = 64;    // cells from the wall, places per cell
static constexpr double FARTHEST = 4.0;          // more than a node at the wall sees

// what the positions of points do not tell about the surface of a body, in node spacings
static constexpr double TOLERANCE = 0.01;

// points nearer to the wall than this part of their spacing (undeformed: 0.5) are about to cross
// it: they count as this many cells behind it when they are right at it, and more beyond
static constexpr double NEAR = 0.25, BEHIND = 100.0;

MPMContactDistance::MPMContactDistance(const MPMField &field, const double *positions,
                                       const double *weights, int n) :
    sized(field.options.has_size()),
    dim(field.lattice.dim)
{
  const MPMStencil stencil(field);
  constexpr double origin = 16.0;    // of the wall, away from zero
  const auto M = [&](double x) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
      if (sized) {    // the functions of nodes, of which such points see means
        sum += weights[k] * std::max(0.0, 1.0 - fabs(x - positions[k]));
        continue;
      }
      // N_k depends on the distance from the node: here node 16, and the place is shifted
      int first;
      double w[4];
      const int m = stencil.weights(origin + x - positions[k], first, w);
      const int node = (int) origin - first;
      if (node >= 0 && node < m) sum += weights[k] * w[node];
    }
    return sum;
  };
  for (int k = 0; k < REACH * SAMPLES; k++) {
    const double x = (k + 0.5) / SAMPLES, m = M(x);
    volume += m / SAMPLES;
    moment += m * x / SAMPLES;
  }
  const double step = 0.5 / SAMPLES;
  at_wall = M(0.0);
  slope = (M(step) - M(0.0)) / step;
}

double MPMContactDistance::distance(double size) const
{
  if (volume <= 0.0) return 0.0;
  const double edge = dim == 3 ? std::cbrt(size) : std::sqrt(size), size2 = edge * edge;
  const double all = volume + (sized ? 0.0 : size2 / 24.0 * slope);
  return (moment + size2 / (sized ? 12.0 : 24.0) * at_wall) / std::max(all, 0.5 * volume);
}

void MPMWallGap::Sums::add(double weight, const Sums &other)
{
  volume += weight * other.volume;
  distance += weight * other.distance;
  size += weight * other.size;
}

bool MPMWallGap::Sums::touches(const MPMContactDistance &full, double near) const
{
  return volume > 0.0 &&
      distance <= (full.distance(size / volume) + std::max(near, TOLERANCE)) * volume;
}

double MPMWallGap::Sums::beyond(const MPMContactDistance &full) const
{
  if (!(volume > 0.0)) return std::numeric_limits<double>::infinity();
  return distance / volume - full.distance(size / volume);
}

/** Of places as far from points that are out of reach as the middle of their block. */
double MPMWallGap::farthest(const MPMField &field, double more)
{
  const auto &lattice = field.lattice;
  const double radius = (0.5 * field.grid.side + 1.0) * sqrt((double) lattice.dim);
  return (FARTHEST + more + radius) * lattice.h;
}

/** Points that no node at the wall sees are left out, most of them by the distance of the middle of
 *  their cell: the distance of another place is less by no more than their distance from
 *  each other. The domains of points with a size can reach far. */
void MPMWallGap::map(MPMField &field, const std::vector<char> &near, double reach,
                     const MPMDistanceFrom &away, double more)
{
  constexpr int CHUNK = 8;
  const auto &pic = field.pic;
  const auto &lattice = field.lattice;
  const auto nmax = (std::size_t) field.atom->nmax;
  const double h = lattice.h;
  const bool sized = field.options.has_size(), cubes = lattice.dim == 3;
  const double limit = FARTHEST + more, per_h = 1.0 / h, per_cell = 1.0 / lattice.cell_volume(),
               most_near = cubes ? NEAR * NEAR * NEAR : NEAR * NEAR;
  const double seen_from = std::min(reach, limit) + 0.01, cutoff = (limit + 1.0) * h;
  if (volumes.size() < nmax) {
    volumes.resize(nmax);
    values.resize(3 * nmax);
  }
  const PointRows r = field.rows_at_rest(values.data(), volumes.data());
  const TransferStep s = field.step_data(0.0);
  const MPMRows x = field.frame->places();

  // the middle of a cell tells of the points in it; cells are counted from one before the block
  enum Sight : char { NOT_KNOWN, IN_SIGHT, OUT_OF_SIGHT };
  const int side = field.grid.side, count = side + 2, layers = cubes ? count : 1;
  const double radius = 0.5 * std::sqrt((double) lattice.dim) * h;
  std::vector<char> cells(sized ? 0 : count * count * layers);
  double corner[3] = {0.0, 0.0, 0.0};
  const auto out_of_sight = [&](const double *place) {
    if (sized) return false;
    const double at[3] = {(place[0] - corner[0]) * per_h, (place[1] - corner[1]) * per_h,
                          cubes ? (place[2] - corner[2]) * per_h : 0.5};
    const int k[3] = {(int) at[0], (int) at[1], (int) at[2]};
    if (!(at[0] >= 0.0 && at[1] >= 0.0 && at[2] >= 0.0) || k[0] >= count || k[1] >= count ||
        k[2] >= layers)
      return false;
    char &sight = cells[(k[0] * count + k[1]) * layers + k[2]];
    if (sight == NOT_KNOWN) {
      double middle[3];
      for (int d = 0; d < 3; d++) middle[d] = corner[d] + (k[d] + 0.5) * h;
      if (!cubes) middle[2] = 0.0;
      sight = away(middle, cutoff) - radius >= seen_from * h ? OUT_OF_SIGHT : IN_SIGHT;
    }
    return sight == OUT_OF_SIGHT;
  };

  points_to(nodes, field, pic, [&](const MPMPointMap::Run &run, const int *base, int *box) {
    const auto &block = field.grid.blocks[run.slot];
    if (std::none_of(block.slot, block.slot + 27, [&](int slot) {
          return slot >= 0 && near[slot];
        }))
      return;
    if (!sized) {
      const int first[3] = {block.b[0] * side - 1, block.b[1] * side - 1,
                            cubes ? block.b[2] * side - 1 : 0};
      lattice.node_position(first, corner);
      std::fill(cells.begin(), cells.end(), (char) NOT_KNOWN);
    }
    for (int begin = run.first; begin < run.last; begin += CHUNK) {
      const int end = std::min(begin + CHUNK, run.last);
      double distance[CHUNK];
      bool seen = sized;
      for (int i = begin; i < end; i++) {
        double &d = distance[i - begin];
        d = out_of_sight(x[i]) ? limit : away(x[i], cutoff) * per_h;
        seen = seen || d < seen_from;
      }
      if (!seen) continue;
      for (int i = begin; i < end; i++) {
        const double d = distance[i - begin];
        volumes[i] = r.vol0[i] * field.points->jacobian(i) / field.frame->circle(x[i][0]);
        const double size = volumes[i] * per_cell;
        double *const value = &values[3 * (std::size_t) i];
        value[0] = std::min(d, limit);
        value[1] = size;
        value[2] = 0.0;    // in 2d there is no third one
        if (d > 0.0 && d * d * (cubes ? d : 1.0) >= most_near * size) continue;
        const double crossing =
            std::max(0.0, 1.0 - d / (NEAR * (cubes ? std::cbrt(size) : std::sqrt(size))));
        value[0] -= BEHIND * crossing * crossing;
      }
      pic.p2g_momentum(r, s, begin, end, base, field.map->tile, box);
    }
  });
  nreal = pic.nreal;
  field.nodes.sum(nodes.data(), nreal, 0, 4);
}

MPMWallGap::Sums MPMWallGap::at(int64_t node) const
{
  const double *const n = nodes.data() + node * nreal;
  return {n[3], n[0], n[1]};
}

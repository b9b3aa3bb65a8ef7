/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/surface_cells.h"

#include "mesh/vector3.h"

#include <cmath>
#include <limits>

using namespace MPM_NS;
using namespace MPM_NS::vector3;
using Point = SurfaceMesh::Point;

static constexpr double SAME = 0.95;      // least cosine between a gradient and the mean one
static constexpr double FLAT = 1.0e-3;    // largest component along z if only a section counts
static constexpr std::size_t MOST = 1 << 14;    // bricks in memory

SurfaceCells::SurfaceCells(Distance exact, const Point &origin, double size, bool flat) :
    exact(std::move(exact)), origin(origin), size(size), per_size(1.0 / size), flat(flat)
{
}

SurfaceCells::SurfaceCells(const SurfaceMesh &mesh, double size, bool flat) :
    SurfaceCells(
        [&mesh](const Point &x, double limit, Point *gradient) {
          const double bound = mesh.bound(x);
          if (std::fabs(bound) > limit) return bound;
          Point closest;
          return gradient ? mesh.distance_and_normal(x, *gradient) : mesh.distance(x, closest);
        },
        mesh.lo, size, flat)
{
}

/** The brick with this index; null if it is out of range. */
SurfaceCells::Brick *SurfaceCells::brick_at(const int64_t *brick)
{
  constexpr int BITS = 21;
  constexpr int64_t HALF = 1 << (BITS - 1);
  uint64_t key = 0;
  for (int d = 0; d < 3; d++) {
    if (brick[d] < -HALF || brick[d] >= HALF) return nullptr;
    key = key << BITS | (uint64_t) (brick[d] + HALF);
  }
  if (last_brick && key == last_key) return last_brick;
  const auto found = bricks.find(key);
  Brick *known = found == bricks.end() ? nullptr : found->second.get();
  if (!known) {
    if (bricks.size() >= MOST) bricks.clear();
    known = (bricks[key] = std::make_unique<Brick>()).get();
    known->known.fill(0);
    known->kinds.fill(NEW);
  }
  last_key = key;
  return last_brick = known;
}

static int number(const int *at, int side)
{
  return at[0] + side * (at[1] + side * at[2]);
}

const SurfaceCells::Corner &SurfaceCells::corner(Brick &brick, const int64_t *index, const int *at)
{
  const int k = number(at, CORNERS);
  Corner &c = brick.corners[k];
  Point gradient = {0.0, 0.0, 0.0};
  if (brick.known[k]) return c;
  brick.known[k] = 1;
  Point x = {0.0, 0.0, height};
  for (int d = 0; d < (flat ? 2 : 3); d++) x[d] = origin[d] + size * (SIDE * index[d] + at[d]);
  double distance = exact(x, FARTHEST * size, &gradient);
  if (std::fabs(distance) > FARTHEST * size)
    distance = std::copysign(std::numeric_limits<double>::infinity(), distance);
  c = {(float) (distance * per_size), (float) gradient[0], (float) gradient[1],
       (float) gradient[2]};
  return c;
}

/** Distance [cells] and gradient at the place t in the cell, from 0 to 1 along each axis. With the
 *  corners k = 0, 1 along each axis, the sum of w_k g_k (x - x_k) is the sum over the axes of g t
 *  less that over the corners with k = 1 of w_k g_k, in cells. The gradient is not normalized. */
std::array<double, 4> SurfaceCells::blend(const Brick &brick, const int *cell,
                                          const double *t) const
{
  const Corner *const first = &brick.corners[number(cell, CORNERS)];
  const int layers = flat ? 1 : 2;
  double d = 0.0, x = 0.0, y = 0.0, z = 0.0, ahead = 0.0;
  for (int k = 0; k < layers; k++)
    for (int j = 0; j < 2; j++) {
      const double w = (flat ? 1.0 : (k ? t[2] : 1.0 - t[2])) * (j ? t[1] : 1.0 - t[1]),
                   w1 = w * t[0], w0 = w - w1;
      const float *const a = first[CORNERS * (j + CORNERS * k)].data(), *const b = a + 4;
      const double gy = w0 * a[2] + w1 * b[2], gz = w0 * a[3] + w1 * b[3];
      d += w0 * a[0] + w1 * b[0];
      x += w0 * a[1] + w1 * b[1];
      y += gy;
      z += gz;
      ahead += w1 * b[1] + j * gy + k * gz;
    }
  return {d + 0.5 * (x * t[0] + y * t[1] + z * t[2] - ahead), x, y, z};
}

/** Can the cell be used? */
SurfaceCells::Kind SurfaceCells::judge(Brick &brick, const int64_t *index, const int *cell)
{
  Point mean = {0.0, 0.0, 0.0};
  const int n = flat ? 4 : 8;
  Point gradients[8];
  for (int k = 0; k < n; k++) {
    const int place[3] = {cell[0] + (k & 1), cell[1] + (k >> 1 & 1), cell[2] + (k >> 2)};
    const Corner &c = corner(brick, index, place);
    if (std::isinf(c[0])) return c[0] > 0.0 ? FAR_IN_FRONT : FAR_BEHIND;
    if (flat && std::fabs(c[3]) > FLAT) return ROUGH;
    gradients[k] = {c[1], c[2], c[3]};
    mean = mean + gradients[k];
  }
  const double length = norm(mean);
  if (!(length > 0.0)) return ROUGH;
  for (int k = 0; k < n; k++)
    if (!(dot(mean, gradients[k]) >= SAME * length)) return ROUGH;
  Point x = {0.0, 0.0, height};
  for (int d = 0; d < (flat ? 2 : 3); d++)
    x[d] = origin[d] + size * (SIDE * index[d] + cell[d] + 0.5);
  const double middle[3] = {0.5, 0.5, 0.5};
  const double error =
      size * blend(brick, cell, middle)[0] - exact(x, (FARTHEST + 1.0) * size, nullptr);
  return std::fabs(error) <= TOLERANCE * size ? SMOOTH : ROUGH;
}

SurfaceCells::Answer SurfaceCells::find(const Point &x, double &distance, Point *gradient)
{
  if (flat && x[2] != height) {
    bricks.clear();
    last_brick = nullptr;
    height = x[2];
  }
  int64_t index[3] = {0, 0, 0};
  int cell[3] = {0, 0, 0};
  double t[3] = {0.0, 0.0, 0.0};
  for (int d = 0; d < (flat ? 2 : 3); d++) {
    const double at = (x[d] - origin[d]) * per_size;
    if (!(std::fabs(at) < 1.0e9)) return UNKNOWN;
    auto whole = (int64_t) at;
    if ((double) whole > at) whole--;
    t[d] = at - (double) whole;
    index[d] = whole >= 0 ? whole / SIDE : -((SIDE - 1 - whole) / SIDE);
    cell[d] = (int) (whole - SIDE * index[d]);
  }
  Brick *const brick = brick_at(index);
  if (!brick) return UNKNOWN;
  Kind &kind = brick->kinds[number(cell, SIDE)];
  if (kind == NEW) kind = judge(*brick, index, cell);
  if (kind == ROUGH) return UNKNOWN;
  if (kind != SMOOTH) {
    distance = (FARTHEST - std::sqrt(3.0)) * size * (kind == FAR_BEHIND ? -1.0 : 1.0);
    return FAR;
  }
  const auto here = blend(*brick, cell, t);
  distance = size * here[0];
  if (gradient) {
    const Point up = {here[1], here[2], flat ? 0.0 : here[3]};
    *gradient = (1.0 / norm(up)) * up;
  }
  return KNOWN;
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mesh/cell_volumes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace MPM_NS;
using Point = CellVolumes::Point;
using Polygon = std::vector<Point>;

/** The part of a convex polygon with sign * (x[d] - at) <= 0. */
static void clip(const Polygon &from, int d, double at, double sign, Polygon &to)
{
  to.clear();
  for (std::size_t n = 0; n < from.size(); n++) {
    const Point &a = from[n], &b = from[(n + 1) % from.size()];
    const double da = sign * (a[d] - at), db = sign * (b[d] - at);
    if (da <= 0.0) to.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
      const double t = da / (da - db);
      Point x;
      for (int e = 0; e < 3; e++) x[e] = a[e] + t * (b[e] - a[e]);
      x[d] = at;
      to.push_back(x);
    }
  }
}

/** Cells that a polygon is in along an axis; coordinates are in cells. */
static void range(const Polygon &p, int d, int64_t &first, int64_t &last)
{
  double lo = p[0][d], hi = p[0][d];
  for (const auto &x : p) {
    lo = std::min(lo, x[d]);
    hi = std::max(hi, x[d]);
  }
  first = (int64_t) std::floor(lo);
  last = std::max(first, (int64_t) std::ceil(hi) - 1);
}

CellVolumes::CellVolumes(const std::vector<std::array<Point, 3>> &triangles, const double *origin,
                         const double *size, const Range *ranges)
{
  constexpr double MOST = 1.0e9;
  std::copy_n(origin, 3, this->origin);
  std::copy_n(size, 3, this->size);
  std::copy_n(ranges, 3, this->ranges);
  Polygon all, slab, rest, strip, above;
  for (const auto &t : triangles) {
    all.assign(t.begin(), t.end());
    for (auto &x : all)
      for (int d = 0; d < 3; d++) {
        x[d] = (x[d] - origin[d]) / size[d];
        if (!(std::fabs(x[d]) < MOST))
          throw std::runtime_error("the surface has more than 1e9 cells along an axis");
      }
    for (int d = 1; d < 3; d++) {    // columns that nobody asks for
      clip(all, d, (double) ranges[d].first, -1.0, rest);
      clip(rest, d, (double) (ranges[d].last + 1), 1.0, all);
    }
    if (all.size() < 3) continue;
    int64_t j, jlast, k, klast;
    for (range(all, 1, j, jlast); j <= jlast; j++) {
      clip(all, 1, (double) (j + 1), 1.0, slab);
      clip(all, 1, (double) (j + 1), -1.0, rest);
      all.swap(rest);
      if (slab.size() < 3) continue;
      for (range(slab, 2, k, klast); k <= klast; k++) {
        clip(slab, 2, (double) (k + 1), 1.0, strip);
        clip(slab, 2, (double) (k + 1), -1.0, above);
        slab.swap(above);
        if (strip.size() >= 3) add(strip, j, k);
        if (slab.size() < 3) break;
      }
      if (all.size() < 3) break;
    }
  }
  for (auto &[key, column] : columns) {
    std::sort(column.begin(), column.end(), [](const Entry &a, const Entry &b) {
      return a.cell < b.cell;
    });
    // what all of those above have below them
    for (auto n = (int) column.size() - 2; n >= 0; n--)
      for (int m = 0; m < 3; m++) column[n].below[m] += column[n + 1].below[m];
  }
}

/** A part of a triangle in the column (j,k). */
void CellVolumes::add(const Polygon &polygon, int64_t j, int64_t k)
{
  Polygon rest = polygon, piece, above;
  for (auto &x : rest) {
    x[1] -= (double) j;
    x[2] -= (double) k;
  }
  // what is below the cells that are asked for counts in none of them, and what is above is below
  // no other
  const int64_t above_all = ranges[0].last + 1;
  clip(rest, 0, (double) ranges[0].first, -1.0, piece);
  rest.swap(piece);
  if (rest.size() < 3) return;
  Column &column = columns[key(j, k)];
  int64_t i, ilast;
  for (range(rest, 0, i, ilast); i <= ilast && rest.size() >= 3; i++) {
    if (i >= above_all) {
      i = above_all;
      piece.swap(rest);
      rest.clear();
    } else {
      clip(rest, 0, (double) (i + 1), 1.0, piece);
      clip(rest, 0, (double) (i + 1), -1.0, above);
      rest.swap(above);
    }
    if (piece.size() < 3) continue;
    for (auto &x : piece) x[0] -= (double) i;
    auto there = std::find_if(column.begin(), column.end(), [i](const Entry &e) {
      return e.cell == i;
    });
    if (there == column.end()) there = column.insert(there, Entry{i});
    add_piece(piece, *there);
  }
}

/** Integrals over the projection of a polygon, x relative to the lower corner of its cell, onto the
 *  plane of y and z: of the height x over it, and of its moments. */
void CellVolumes::add_piece(const Polygon &piece, Entry &entry)
{
  for (std::size_t n = 1; n + 1 < piece.size(); n++) {
    const Point &a = piece[0], &b = piece[n], &c = piece[n + 1];
    const double area = 0.5 * ((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
    Point sum;
    for (int d = 0; d < 3; d++) sum[d] = a[d] + b[d] + c[d];
    const auto product = [&](int d) {    // mean of x times the coordinate
      return (sum[0] * sum[d] + a[0] * a[d] + b[0] * b[d] + c[0] * c[d]) / 12.0;
    };
    entry.part[0] += area * sum[0] / 3.0;
    entry.part[1] += area * 0.5 * product(0);
    entry.part[2] += area * product(1);
    entry.part[3] += area * product(2);
    entry.below[0] += area;
    entry.below[1] += area * sum[1] / 3.0;
    entry.below[2] += area * sum[2] / 3.0;
  }
}

CellVolumes::Sums CellVolumes::operator()(int64_t i, int64_t j, int64_t k) const
{
  Sums sums;
  const auto found = columns.find(key(j, k));
  if (found == columns.end()) return sums;
  const Column &column = found->second;
  auto next = std::lower_bound(column.begin(), column.end(), i, [](const Entry &e, int64_t cell) {
    return e.cell < cell;
  });
  const double cell = size[0] * size[1] * size[2];
  double part[4] = {0.0};
  if (next != column.end() && next->cell == i) {
    std::copy_n(next->part, 4, part);
    ++next;
  }
  if (next != column.end()) {
    part[0] += next->below[0];
    part[1] += 0.5 * next->below[0];
    part[2] += next->below[1];
    part[3] += next->below[2];
  }
  sums.volume = cell * part[0];
  for (int d = 0; d < 3; d++) sums.moment[d] = cell * size[d] * part[1 + d];
  return sums;
}

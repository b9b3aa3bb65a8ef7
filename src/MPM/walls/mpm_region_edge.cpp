/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_region_edge.h"

#include "math_const.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <queue>

using namespace LAMMPS_NS;

static constexpr double STEP = 1.0e-5;    // of a distance

MPMRegionEdge::MPMRegionEdge(const MPMRegionSurface &surface, const double *x, double far,
                             double least) :
    x(x),
    dim(surface.dim), far(far), side(surface.is_union ? -1.0 : 1.0),
    step(STEP * MPMRegionSurface::scale_at(x, least))
{
  order.reserve(surface.parts.size());
  for (const bool first : {true, false}) {
    for (const auto &part : surface.parts)
      if (part.is_convex(!surface.is_union) == first) order.push_back(&part);
    if (first) convex = (int) order.size();
  }
}

MPMRegionEdge::Answer MPMRegionEdge::find(double limit, Place &place)
{
  constexpr double WIDER = 8.0;                       // than a distance that is too short
  constexpr double SAME = 3.0e-5, ENOUGH = 1.0e-3;    // a bound is less by a few STEP
  nearest = limit;
  double least = 0.0;
  if (!all_convex()) {
    least = bound(x, limit);
    if (least >= (1.0 - SAME) * limit) return Answer::NONE;
    step = std::max(step, STEP * least);
  }
  const bool found = search_from(x);
  bool complete = found && (all_convex() || nearest <= (1.0 + ENOUGH) * least);
  double inner = 0.0, outer = WIDER / STEP * step;
  // parts that have parts of their own search for their edges in each cell
  const bool are_simple = std::all_of(order.begin(), order.end(), [](const auto *part) {
    return part->parts.empty();
  });
  for (int budget = are_simple ? 500 : 20; !complete && budget > 0; outer *= WIDER) {
    outer = std::min(outer, nearest);
    if (!search_cells(inner, outer, budget)) break;
    complete = outer >= std::min(nearest, far);
    inner = outer;
  }
  if (nearest < limit) {
    place = edge;
    return Answer::FOUND;
  }
  return complete ? Answer::NONE : Answer::UNKNOWN;
}

void MPMRegionEdge::view_from(const double *place)
{
  constexpr double OFF = 0.1;    // so that the place is in no plane across
  MathExtra::copy3(place, view.from);
  for (int d = 0; d < dim; d++) view.from[d] += OFF * step * (d + 1);
  view.planes.clear();
}

/** Is the surface of a part flat, with this normal at this place? */
bool MPMRegionEdge::is_flat(const MPMRegionSurface &part, const Place &place, const double *n) const
{
  constexpr double ROUND_OFF = 1.0e-12;
  if (part.is_plane) return true;
  if (part.has_axis)
    for (int d = 0; d < 3; d++)
      if (fabs(n[d]) > 1.0 - ROUND_OFF) {
        if (part.flat[d] < 0) part.flat[d] = goes_on_flat(part, place, n);
        return part.flat[d];
      }
  return goes_on_flat(part, place, n);
}

/** Is it flat around? At edges of its own it goes on only in some directions, not all of them
 *  opposite. */
bool MPMRegionEdge::goes_on_flat(const MPMRegionSurface &part, const Place &place,
                                 const double *n) const
{
  constexpr int DIRECTIONS = 8;
  double off = std::max(1.0e3 * step, 1.0e-5 * MPMRegionSurface::size_of(x));
  for (const auto &other : part.places)
    if (other.distance > 10.0 * place.distance) off = std::min(off, 0.01 * other.distance);
  const double same = 1.0e-6 * off;
  double across[3] = {0.0, 0.0, 0.0}, along[3];
  if (dim == 2) {
    across[2] = 1.0;
  } else {
    const double axis[3] = {fabs(n[0]) < 0.6 ? 1.0 : 0.0, fabs(n[0]) < 0.6 ? 0.0 : 1.0, 0.0};
    MathExtra::cross3(n, axis, across);
    MathExtra::norm3(across);
  }
  MathExtra::cross3(n, across, along);
  const auto goes_on = [&](double angle) {
    double beside[3];
    for (int d = 0; d < 3; d++)
      beside[d] = view.from[d] + off * (cos(angle) * along[d] + (dim - 2) * sin(angle) * across[d]);
    part.find_places(beside, far);
    return std::any_of(part.places.begin(), part.places.end(), [&](const auto &other) {
      double way[3];
      MathExtra::sub3(other.x, place.x, way);
      return fabs(MathExtra::dot3(way, n)) < same && MathExtra::len3(way) < 2.0 * off;
    });
  };
  int first = -1;
  for (int k = 0; k < DIRECTIONS; k += dim == 2 ? DIRECTIONS / 2 : 1) {
    if (!goes_on(2.0 * MathConst::MY_PI * k / DIRECTIONS)) continue;
    if (dim == 2 || (first >= 0 && k - first != DIRECTIONS / 2)) return true;
    if (first < 0) first = k;
  }
  return false;
}

/** Does a plane with this normal and height of y face one of the view, with nothing between? */
bool MPMRegionEdge::is_facing(const double *n, double height) const
{
  return std::any_of(view.planes.begin(), view.planes.end(), [&](const Plane &other) {
    return MathExtra::dot3(n, other.n) < -1.0 + 1.0e-6 && height + other.height > -step;
  });
}

/** The surface of a part as a plane at the place that is nearest to y of those that are seen, and
 *  the distance of what is seen, far if it is nothing, negative in the part. A flat end that faces
 *  a plane of the view, with nothing between them, does not count, as that of a cylinder that is a
 *  hole in a plate: what is next to nearest does. */
bool MPMRegionEdge::find_plane(const MPMRegionSurface &part, const double *y, Plane &plane,
                               double &distance)
{
  const double outward = part.match(view.from) ? -side : side;
  double nearest_to_y = far;
  part.find_places(view.from, far);
  distance = far;
  seen = part.places;
  for (const auto &place : seen) {
    double n[3];
    MathExtra::sub3(view.from, place.x, n);
    const double length = MathExtra::len3(n);
    if (!(length > 0.99 * place.distance && length > 0.0)) continue;
    MathExtra::scale3(outward / length, n);
    double height = outward * place.distance;
    for (int d = 0; d < 3; d++) height += n[d] * (y[d] - view.from[d]);
    if (is_facing(n, height) && is_flat(part, place, n)) continue;
    distance = std::min(distance, place.distance);
    const double way = sqrt(MathExtra::distsq3(y, place.x));
    if (way >= nearest_to_y) continue;
    nearest_to_y = way;
    MathExtra::copy3(n, plane.n);
    plane.height = height;
  }
  distance *= outward;
  return nearest_to_y < far;
}

void MPMRegionEdge::go_behind(const double *y, const Plane &plane)
{
  double height = plane.height + step;
  for (int d = 0; d < 3; d++) height += plane.n[d] * (view.from[d] - y[d]);
  if (height > 0.0)
    for (int d = 0; d < 3; d++) view.from[d] -= height * plane.n[d];
  view.planes.push_back(plane);
}

/** The same for a convex part, from whose inside all of its surfaces are seen, as those that meet
 *  at an edge of its own: all of them are planes that the part is behind. */
void MPMRegionEdge::go_into(const MPMRegionSurface &part, const double *y, const Plane &plane)
{
  go_behind(y, plane);
  const double *const from = view.from;
  if (part.match(from) != (side > 0.0)) return;
  view.planes.pop_back();
  part.find_places(from, far);
  for (const auto &place : part.places) {
    Plane face;
    MathExtra::sub3(place.x, from, face.n);
    const double length = MathExtra::len3(face.n);
    if (!(length > 0.99 * place.distance && length > 0.0)) continue;
    MathExtra::scale3(1.0 / length, face.n);
    face.height = -place.distance;
    for (int d = 0; d < 3; d++) face.height += face.n[d] * (y[d] - from[d]);
    view.planes.push_back(face);
  }
}

/** Way from y to the place nearest to y + to that is behind all planes, in no more than three of
 *  which it lies: all choices of these are tried. Returns false where there is none. */
bool MPMRegionEdge::nearest_behind(const double *to, double *way)
{
  double out = 0.0;
  for (const auto &plane : planes) out = std::max(out, plane.height);
  const double tolerance = 1.0e-9 * (MathExtra::len3(to) + step);
  const double reach = 2.0 * (MathExtra::len3(to) + out) + step;
  planes.erase(std::remove_if(planes.begin(), planes.end(),
                              [reach](const Plane &plane) {
                                return plane.height < -reach;
                              }),
               planes.end());
  const int n = (int) planes.size();
  const auto attempt = [&](const int *chosen, int m) {
    // multipliers of the planes: of n_k . n_l, by Cramer's rule
    double A[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, b[3] = {}, push[3];
    for (int k = 0; k < m; k++) {
      for (int l = 0; l < m; l++)
        A[k][l] = MathExtra::dot3(planes[chosen[k]].n, planes[chosen[l]].n);
      b[k] = planes[chosen[k]].height + MathExtra::dot3(planes[chosen[k]].n, to);
    }
    const double determinant = MathExtra::det3(A);
    if (!(determinant > 1.0e-12)) return false;
    double end[3] = {to[0], to[1], to[2]};
    for (int k = 0; k < m; k++) {
      double with_b[3][3];
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) with_b[i][j] = j == k ? b[i] : A[i][j];
      push[k] = MathExtra::det3(with_b) / determinant;
      if (push[k] < 0.0) return false;
      for (int d = 0; d < 3; d++) end[d] -= push[k] * planes[chosen[k]].n[d];
    }
    for (const auto &plane : planes)
      if (plane.height + MathExtra::dot3(plane.n, end) > tolerance) return false;
    MathExtra::copy3(end, way);
    return true;
  };
  // the place is one, so that the first choice that fits is right
  if (attempt(nullptr, 0)) return true;
  for (int k = 0; k < n; k++)
    if (attempt(&k, 1)) return true;
  for (int k = 0; k < n; k++)
    for (int l = 0; l < k; l++) {
      const int two[] = {k, l};
      if (attempt(two, 2)) return true;
    }
  for (int k = 0; k < n; k++)
    for (int l = 0; l < k; l++)
      for (int i = 0; i < l; i++) {
        const int three[] = {k, l, i};
        if (attempt(three, 3)) return true;
      }
  return false;
}

/** Local search. Is what it finds an edge, and nearer than the nearest one so far? */
bool MPMRegionEdge::search_from(const double *start)
{
  constexpr int ROUNDS = 30;
  const double converged = 1.0e-3 * step;
  double y[3] = {start[0], start[1], start[2]};
  double share = 1.0, before[3] = {};
  for (int round = 0;; round++) {
    // from a little toward x, where the parts are seen as from x
    double q[3], out = 0.0;
    MathExtra::sub3(x, y, q);
    const double length = MathExtra::len3(q);
    for (int d = 0; d < 3; d++) q[d] = y[d] + (length > 0.0 ? step / length * q[d] : 0.0);
    view_from(q);
    for (int k = 0; k < (int) order.size(); k++) {
      Plane plane;
      double distance;
      if (find_plane(*order[k], y, plane, distance)) {
        if (k < convex)
          go_into(*order[k], y, plane);
        else
          go_behind(y, plane);
      } else if (distance > 0.0)
        return false;
    }
    planes = view.planes;
    for (const auto &plane : planes) out = std::max(out, plane.height);
    // where an edge bends, its places are about as near, and the last steps are short
    if (out <= converged && round >= ROUNDS) break;
    if (round > 2 * ROUNDS) return false;
    double to[3], way[3];
    for (int d = 0; d < 3; d++) to[d] = share * (x[d] - y[d]);
    if (!nearest_behind(to, way)) return false;
    if (out <= converged && MathExtra::len3(way) <= converged * share) break;
    if (MathExtra::dot3(way, before) < 0.0) share *= 0.5;
    MathExtra::copy3(way, before);
    MathExtra::add3(y, way, y);
  }
  const double distance = sqrt(MathExtra::distsq3(x, y));
  if (distance >= nearest || !(all_convex() || is_on_edge(y))) return false;
  nearest = distance;
  edge = {{y[0], y[1], y[2]}, distance};
  return true;
}

bool MPMRegionEdge::is_on_edge(const double *y) const
{
  return std::all_of(order.begin(), order.end(), [&](const auto *part) {
    return side * part->find(y, far, false) <= step;
  });
}

/** A distance within which the set has no place, or more than enough. Behind planes of parts that
 *  are convex, no place of the set is further away, by the theorem of Pythagoras. A place outside
 *  of a body with plane faces is behind one of them, and then the same holds. */
double MPMRegionEdge::bound(const double *center, double enough)
{
  view_from(center);
  return sqrt(bound_by(0, center, enough * enough));
}

/** The same by the parts from this one on, as seen now, of squares of distances. */
double MPMRegionEdge::bound_by(int first, const double *center, double enough)
{
  double greatest = 0.0, moved = 0.0;
  for (int k = first; k < (int) order.size(); k++) {
    Plane plane;
    double distance;
    const bool is_seen = find_plane(*order[k], center, plane, distance);
    const double square = distance > 0.0 ? moved + distance * distance : 0.0;
    if (k >= convex && order[k]->is_plane && square > greatest && square < enough)
      return std::max(greatest, moved + bound_by_faces(k, center, enough - moved));
    greatest = std::max(greatest, square);
    if (greatest >= enough) return greatest;
    if (!is_seen || k >= convex) continue;
    go_into(*order[k], center, plane);
    if (distance > 0.0) moved = square;
  }
  return greatest;
}

double MPMRegionEdge::bound_by_faces(int k, const double *center, double enough)
{
  const View from_here = view;
  const std::vector<Place> faces = seen;
  double least = enough;
  for (const auto &face : faces) {
    Plane plane;
    const double square = face.distance * face.distance;
    if (!(square < least && square > 0.0)) continue;
    MathExtra::sub3(view.from, face.x, plane.n);
    MathExtra::scale3(1.0 / face.distance, plane.n);
    plane.height = face.distance;
    for (int d = 0; d < 3; d++) plane.height += plane.n[d] * (center[d] - view.from[d]);
    if (is_facing(plane.n, plane.height)) continue;
    go_behind(center, plane);
    least = std::min(least, square + bound_by(k + 1, center, least - square));
    view = from_here;
  }
  return least;
}

double MPMRegionEdge::distance_of(const Cell &cell, bool farthest) const
{
  double sum = 0.0;
  for (int d = 0; d < dim; d++) {
    const double off = fabs(x[d] - cell.center[d]);
    const double way = farthest ? off + cell.half : std::max(off - cell.half, 0.0);
    sum += way * way;
  }
  return sqrt(sum);
}

/** Cells between two distances from x. Is the search complete? */
bool MPMRegionEdge::search_cells(double inner, double outer, int &budget)
{
  constexpr double NEARER = 0.95, THINNEST = 0.02;
  std::priority_queue<Cell> cells;
  cells.push({0.0, {x[0], x[1], x[2]}, outer});
  while (!cells.empty()) {
    const Cell cell = cells.top();
    cells.pop();
    if (cell.lower >= NEARER * std::min(nearest, outer)) break;
    if (budget-- <= 0) return false;
    const double reach = cell.half * sqrt((double) dim) + step;
    if (bound(cell.center, 1.01 * reach) > reach) continue;
    search_from(cell.center);
    if (cell.half < THINNEST * std::max(cell.lower, step / STEP)) continue;
    for (int k = 0; k < (1 << dim); k++) {
      Cell part = cell;
      part.half *= 0.5;
      for (int d = 0; d < dim; d++) part.center[d] += (k >> d & 1) ? part.half : -part.half;
      part.lower = distance_of(part, false);
      if (part.lower < nearest && part.lower < outer && distance_of(part, true) > inner)
        cells.push(part);
    }
  }
  return true;
}

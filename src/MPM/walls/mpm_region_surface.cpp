/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Region::surface() of LAMMPS answers for one side of the surface, and not for all regions:
 *
 *  From outside of unions it finds nothing, so that their parts are asked here. Outside of all
 *  parts of a union, and inside of all parts of an intersection, the distance is the least of
 *  theirs. Inside of a union, and outside of an intersection, a part counts whose own side this is,
 *  with those of its places that are not hidden by others. Where all are hidden, an edge between
 *  parts is the nearest surface.
 *
 *  On the axis of cones zero is divided by zero: a place next to it is taken. From outside, an end
 *  with a radius of zero gives not-a-number: it is declared open, as its point belongs to the
 *  side. */

#include "walls/mpm_region_surface.h"

#include "math_extra.h"
#include "region.h"
#include "walls/region_mpm_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

MPMRegionSurface::MPMRegionSurface(Region *region, int dim) :
    region(region), mesh(dynamic_cast<RegMPMMesh *>(region)), dim(dim),
    is_cone(strcmp(region->style, "cone") == 0), is_union(strcmp(region->style, "union") == 0)
{
  if (mesh) mesh->need_distance();
  if (is_union || strcmp(region->style, "intersect") == 0)
    for (int k = 0; k < region->nregion; k++) parts.emplace_back(region->reglist[k], dim);
  left_out = {-1};
  if (is_cone) find_sharp_end();
}

bool MPMRegionSurface::is_open() const
{
  return region->openflag || std::any_of(parts.begin(), parts.end(), [](const auto &part) {
           return part.is_open();
         });
}

bool MPMRegionSurface::match(const double *x) const
{
  return region->match(x[0], x[1], x[2]);
}

/** An end is sharp when LAMMPS does not find it alone. When radii are variables, there can be one
 *  later: then both ends are left out, one after the other, which finds all that there is. */
void MPMRegionSurface::find_sharp_end()
{
  constexpr int SIDE = 2;
  left_out = {0, 1};
  if (region->varshape) return;
  // a place outside, far away and on no axis; cones can be infinite, but not in all directions
  double x[3] = {1.1, 1.2, 1.3};
  for (int k = 0; k < 9 && region->inside(x[0], x[1], x[2]); k++)
    for (double &coordinate : x) coordinate *= 10.0;
  if (region->inside(x[0], x[1], x[2])) return;
  int *const open = region->open_faces;
  int blunt = 0;
  for (const int end : {0, 1}) {
    const int was[3] = {open[0], open[1], open[SIDE]};
    open[1 - end] = open[SIDE] = 1;
    if (region->surface_exterior(x, 1.0e10) > 0) {
      left_out.erase(std::find(left_out.begin(), left_out.end(), end));
      blunt++;
    }
    std::copy_n(was, 3, open);
  }
  if (blunt == 2) left_out = {-1};
}

/** What LAMMPS tells of a simple region: calls f(distance, vector from the surface to x). */
template <class F>
void MPMRegionSurface::each_contact(const double *x, double far, bool inside, const F &f) const
{
  const auto each = [&](const double *place) {
    const int n = region->surface(place[0], place[1], place[2], far);
    for (int i = 0; i < n; i++) {
      const auto &c = region->contact[i];
      if (dim == 3 || !(fabs(c.delz) > 0.5 * c.r)) f(c.r, c.delx, c.dely, c.delz);
    }
    return n > 0;
  };
  const int interior = region->interior;
  if (!inside) region->interior = !interior;
  if (is_cone) {
    const double off = 1.0e-12 * (fabs(x[0]) + fabs(x[1]) + fabs(x[2])) + 1.0e-20 * far;
    const double next[3] = {x[0] + off, x[1] + off, x[2] + off};
    for (const int end : left_out) {
      const bool leave_out = end >= 0 && !region->interior;
      if (leave_out) region->open_faces[end] = 1;
      if (!each(next)) each(x);
      if (leave_out) region->open_faces[end] = 0;
      if (!leave_out) break;
    }
  } else if (!each(x) && region->interior) {
    // centers and axes have no nearest place
    const double off = 1.0e-9 * far;
    const double next[3] = {x[0] + off, x[1] + off, x[2] + off};
    each(next);
  }
  region->interior = interior;
}

bool MPMRegionSurface::find_in_cells(const double *x, double far, double &distance,
                                     double *gradient) const
{
  return cells && mesh->distance_in_cells(*cells, x, far, distance, gradient);
}

void MPMRegionSurface::use_cells(double size)
{
  if (mesh) cells = &mesh->cells_of_size(size);
  for (auto &part : parts) part.use_cells(size);
}

bool MPMRegionSurface::has(const double *x) const
{
  constexpr double SIGN = 1.0e-300;    // only the sign is needed
  double d;
  if (!find_in_cells(x, SIGN, d, nullptr)) return match(x);
  return region->interior ? d <= 0.0 : d < 0.0;
}

double MPMRegionSurface::find(const double *x, double far, bool in_cells) const
{
  double d, up;
  if (in_cells && find_in_cells(x, far, d, nullptr)) return d;
  if (mesh) {
    d = mesh->distance(x, far, up);
    // in 2d the section has another closest point
    if (dim == 3 || up <= 0.5 * fabs(d)) return d;
  }
  const bool inside = match(x);
  d = far;
  if (parts.empty()) {
    each_contact(x, far, inside, [&](double r, double, double, double) {
      d = std::min(d, r);
    });
  } else if ((inside == (region->interior != 0)) != is_union) {
    for (const auto &part : parts) d = std::min(d, fabs(part.find(x, far, in_cells)));
  } else {
    find_places(x, far);
    for (const auto &place : places) d = std::min(d, place.distance);
  }
  return inside ? -d : d;
}

/** Places on the surface that are nearest to x, each on its own smooth part of it. */
void MPMRegionSurface::find_places(const double *x, double far) const
{
  places.clear();
  if (!parts.empty()) return find_places_of_parts(x, far);
  each_contact(x, far, match(x), [&](double r, double dx, double dy, double dz) {
    places.push_back({{x[0] - dx, x[1] - dy, x[2] - dz}, r});
  });
}

void MPMRegionSurface::find_places_of_parts(const double *x, double far) const
{
  const bool in_body = match(x) == (region->interior != 0);
  for (const auto &part : parts) {
    // of a union inside of it, and of an intersection outside: parts whose side this is
    if (in_body == is_union && part.match(x) != in_body) continue;
    part.find_places(x, far);
    for (const auto &place : part.places) {
      const bool hidden = std::any_of(parts.begin(), parts.end(), [&](const auto &other) {
        return &other != &part &&
            (other.match(place.x) == is_union || (!is_union && other.faces(place, x, far)));
      });
      if (!hidden) places.push_back(place);
    }
  }
  if (places.empty() && in_body == is_union) find_edge(x, far);
}

/** Is a place, seen from x, on the surface of this region, which faces the other way there, so that
 *  there is nothing between both? */
bool MPMRegionSurface::faces(const Place &place, const double *x, double far) const
{
  constexpr double SAME = 1.0e-9, STEP = 1.0e-5;    // of far
  if (!(fabs(find(place.x, SAME * far, false)) < SAME * far)) return false;
  double n[3], d[3];
  normal(place.x, far, STEP * far, n);
  MathExtra::sub3(x, place.x, d);
  return MathExtra::dot3(n, d) < -0.99 * place.distance;
}

/** The surface of a part near y as a plane: its normal, outward for side = 1, and the height of y
 *  above it. Where it faces the plane of another part, as the end of a cylinder that is a hole in a
 *  plate, the place is taken that is next to nearest. Returns false where there is none. */
bool MPMRegionSurface::find_plane(const double *y, double far, double side,
                                  const std::vector<Plane> &others, Plane &plane) const
{
  constexpr double STEP = 1.0e-5;    // of far
  const auto facing = [&](const double *n) {
    return std::find_if(others.begin(), others.end(), [n](const Plane &other) {
      return MathExtra::dot3(n, other.n) < -0.99;
    });
  };
  plane.push = 0.0;
  plane.height = side * find(y, far, false);
  normal(y, far, STEP * far, plane.n);
  MathExtra::scale3(side, plane.n);
  const auto other = facing(plane.n);
  if (other == others.end()) return fabs(plane.height) < far;
  double behind[3], nearest = far;
  for (int d = 0; d < 3; d++) behind[d] = y[d] - (STEP * far + other->height) * other->n[d];
  const double outward = match(behind) ? -side : side;
  find_places(behind, far);
  for (const auto &place : places) {
    double n[3];
    MathExtra::sub3(behind, place.x, n);
    if (!(place.distance < nearest && place.distance > 0.0)) continue;
    MathExtra::scale3(outward / place.distance, n);
    if (facing(n) != others.end()) continue;
    nearest = place.distance;
    MathExtra::copy3(n, plane.n);
    plane.height = outward * place.distance;
    for (int d = 0; d < 3; d++) plane.height += n[d] * (y[d] - behind[d]);
  }
  return nearest < far;
}

/** The place that is nearest to x of those that lie on the far side of all parts, or on their
 *  surfaces: by steps toward x, from which all surfaces, as planes, send back to the nearest place
 *  that they allow (dual variables are found one by one: C. Hildreth, Nav. Res. Logist. Q. 4 (1957)
 *  79). Steps become shorter where an edge bends so that they overshoot. Where parts face each
 *  other, what is found depends on their order, and the last one has a choice. If this does not
 *  converge, the largest distance from a part, which is less. */
void MPMRegionSurface::find_edge(const double *x, double far) const
{
  const double side = is_union ? -1.0 : 1.0;
  double least = 0.0;
  for (const auto &part : parts) least = std::max(least, side * part.find(x, far, false));
  if (least >= far) return;
  for (const bool backward : {false, true}) {
    double y[3];
    if (!find_edge_in_order(x, far, side, backward, y)) continue;
    const double distance = sqrt(MathExtra::distsq3(x, y));
    if (distance < far) places.push_back({{y[0], y[1], y[2]}, distance});
    return;
  }
  places.push_back({{x[0], x[1], x[2]}, least});
}

bool MPMRegionSurface::find_edge_in_order(const double *x, double far, double side, bool backward,
                                          double *y) const
{
  constexpr int ROUNDS = 100, SWEEPS = 200;
  constexpr double CONVERGED = 1.0e-9, ROUND_OFF = 1.0e-14;    // of far
  const int n = (int) parts.size();
  double change = far, share = 1.0;
  std::copy_n(x, 3, y);
  for (int round = 0; round < ROUNDS; round++) {
    std::vector<Plane> planes;
    double out = 0.0;
    for (int k = 0; k < n; k++) {
      Plane plane;
      const auto &part = parts[backward ? n - 1 - k : k];
      if (part.find_plane(y, far, side, planes, plane)) {
        planes.push_back(plane);
        out = std::max(out, plane.height);
      } else if (plane.height > -far)
        return false;
    }
    if (change <= CONVERGED * far && out <= CONVERGED * far) return true;
    double way[3];
    for (int d = 0; d < 3; d++) way[d] = share * (x[d] - y[d]);
    double most = far;
    for (int sweep = 0; sweep < SWEEPS && most > ROUND_OFF * far; sweep++) {
      most = 0.0;
      for (auto &plane : planes) {
        const double more = std::max(plane.height + MathExtra::dot3(plane.n, way), -plane.push);
        most = std::max(most, fabs(more));
        plane.push += more;
        for (int d = 0; d < 3; d++) way[d] -= more * plane.n[d];
      }
    }
    const double before = change;
    change = MathExtra::len3(way);
    if (round > 0 && change > 0.7 * before) share *= 0.5;
    MathExtra::add3(y, way, y);
  }
  return false;
}

/** The direction to the nearest place on the surface is the gradient, unless x is on the surface,
 *  or about as far from another place, as at an edge inside. At centers and axes LAMMPS tells one
 *  place of many: further in there the distance does not grow. */
bool MPMRegionSurface::find_normal_at_once(const double *x, double far, double step,
                                           double *normal) const
{
  if (mesh) return false;
  const bool inside = match(x), in_body = inside == (region->interior != 0);
  double nearest = far, next = far;
  find_places(x, far);
  for (const auto &place : places) {
    next = std::min(next, std::max(place.distance, nearest));
    if (place.distance >= nearest) continue;
    nearest = place.distance;
    MathExtra::sub3(x, place.x, normal);
  }
  if (nearest >= far || nearest < 100.0 * step || next - nearest < 4.0 * step) return false;
  if (dim == 2) normal[2] = 0.0;
  const double length = MathExtra::len3(normal);
  if (!(fabs(length - nearest) < 1.0e-6 * nearest)) return false;
  MathExtra::scale3((inside ? -1.0 : 1.0) / length, normal);
  if (!in_body) return true;
  double further[3];
  for (int d = 0; d < 3; d++) further[d] = x[d] - (inside ? 1.0 : -1.0) * step * normal[d];
  return fabs(distance(further, far)) - nearest > 0.99 * step;
}

void MPMRegionSurface::normal(const double *x, double far, double step, double *normal) const
{
  double here;
  if (find_in_cells(x, far, here, normal) || find_normal_at_once(x, far, step, normal)) return;
  here = find(x, far, false);
  MathExtra::zero3(normal);
  for (int d = 0; d < dim; d++) {
    double y[3] = {x[0], x[1], x[2]};
    y[d] = x[d] + step;
    const double up = find(y, far, false);
    y[d] = x[d] - step;
    const double down = find(y, far, false);
    const bool knows_up = fabs(up) < far, knows_down = fabs(down) < far;
    if (knows_up && knows_down)
      normal[d] = up - down;
    else if (knows_up && fabs(here) < far)
      normal[d] = 2.0 * (up - here);
    else if (knows_down && fabs(here) < far)
      normal[d] = 2.0 * (here - down);
  }
  const double length = MathExtra::len3(normal);
  for (int d = 0; d < 3; d++) normal[d] = length > 0.2 * step ? normal[d] / length : 0.0;
}

const Region &MPMRegionSurface::part_near(const double *x, double far) const
{
  if (!is_union || !region->interior) return *region;
  const MPMRegionSurface *nearest = &parts[0];
  double least = nearest->distance(x, far);
  for (const auto &part : parts) {
    const double d = part.distance(x, far);
    if (d >= least) continue;
    least = d;
    nearest = &part;
  }
  return nearest->part_near(x, far);
}

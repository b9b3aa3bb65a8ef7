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
 *  On the axis of cones zero is divided by zero, and on that of cylinders the side is not found: a
 *  place next to it is taken. From outside, an end
 *  with a radius of zero gives not-a-number: it is declared open, as its point belongs to the
 *  side. */

#include "walls/mpm_region_surface.h"

#include "math_extra.h"
#include "mesh/surface_cells.h"
#include "region.h"
#include "walls/mpm_region_edge.h"
#include "walls/region_mpm_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static bool is_convex_body(const char *style)
{
  static const char *const CONVEX[] = {"block", "cone",  "cylinder", "ellipsoid",
                                       "plane", "prism", "sphere"};
  return std::any_of(std::begin(CONVEX), std::end(CONVEX), [style](const char *convex) {
    return strcmp(style, convex) == 0;
  });
}

MPMRegionSurface::MPMRegionSurface(Region *region, int dim) :
    region(region), mesh(dynamic_cast<RegMPMMesh *>(region)), dim(dim),
    is_cone(strcmp(region->style, "cone") == 0),
    has_axis(is_cone || strcmp(region->style, "cylinder") == 0),
    is_union(strcmp(region->style, "union") == 0), is_body(is_convex_body(region->style)),
    is_plane(strcmp(region->style, "block") == 0 || strcmp(region->style, "prism") == 0 ||
             strcmp(region->style, "plane") == 0)
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

double MPMRegionSurface::size_of(const double *x)
{
  return fabs(x[0]) + fabs(x[1]) + fabs(x[2]);
}

double MPMRegionSurface::scale_at(const double *x, double distance)
{
  constexpr double ROUND_OFF = 1.0e-7;
  return std::max(distance, ROUND_OFF * size_of(x));
}

/** Parts count their surfaces, so that an intersection has all places where two of them only touch,
 *  as where a hole ends with its plate. It is as all around such a place. */
bool MPMRegionSurface::match(const double *x) const
{
  const bool here = region->match(x[0], x[1], x[2]);
  if (parts.empty()) return here;
  const double off = 1.0e-11 * size_of(x);
  for (int k = 0; k < (1 << dim); k++) {
    double y[3] = {x[0], x[1], x[2]};
    for (int d = 0; d < dim; d++) y[d] += ((k >> d & 1) ? off : -off) * (1.0 + 0.3 * d);
    if (region->match(y[0], y[1], y[2]) == here) return here;
  }
  return !here;
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
  const double off = 1.0e-12 * size_of(x) + 1.0e-20 * far;
  const double next[3] = {x[0] + off, x[1] + off, x[2] + off};
  if (has_axis) {
    for (const int end : left_out) {
      const bool leave_out = end >= 0 && !region->interior;
      if (leave_out) region->open_faces[end] = 1;
      if (!each(next)) each(x);
      if (leave_out) region->open_faces[end] = 0;
      if (!leave_out) break;
    }
  } else if (!each(x) && region->interior) {
    each(next);    // centers have no nearest place
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
  if (parts.empty() || region->dynamic_check()) return;
  cells_of_all = std::make_shared<SurfaceCells>(
      [this, size](const SurfaceMesh::Point &x, double limit, SurfaceMesh::Point *gradient) {
        if (gradient) normal(x.data(), limit, 1.0e-4 * size, gradient->data());
        return distance(x.data(), 1.001 * limit);
      },
      SurfaceMesh::Point{}, size, dim == 2);
}

double MPMRegionSurface::distance_in_cells(const double *x, double far) const
{
  double d;
  if (!cells_of_all) return distance(x, far);
  const auto answer = cells_of_all->find({x[0], x[1], x[2]}, d, nullptr);
  if (answer == SurfaceCells::UNKNOWN || (answer == SurfaceCells::FAR && fabs(d) < far))
    return distance(x, far);
  return fabs(d) < far ? d : std::copysign(far, d);
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
  constexpr double SAME = 1.0e-9;
  const bool in_body = match(x) == (region->interior != 0), with_edges = in_body == is_union;
  double least = 0.0, nearest = far;    // no place is nearer than that of any part
  for (const auto &part : parts) {
    // of a union inside of it, and of an intersection outside: parts whose side this is
    if (with_edges && part.match(x) != in_body) continue;
    part.find_places(x, far);
    double of_part = far;
    for (const auto &place : std::vector<Place>(part.places)) {
      of_part = std::min(of_part, place.distance);
      const bool hidden = std::any_of(parts.begin(), parts.end(), [&](const auto &other) {
        return &other != &part &&
            (other.match(place.x) == is_union || (!is_union && other.faces(part, place, far)));
      });
      if (hidden) continue;
      places.push_back(place);
      nearest = std::min(nearest, place.distance);
    }
    least = std::max(least, of_part);
  }
  if (!with_edges || least >= far || nearest <= (1.0 + SAME) * least) return;
  Place edge;
  const auto answer = MPMRegionEdge(*this, x, far, least).find(nearest, edge);
  if (answer == MPMRegionEdge::Answer::FOUND)
    places.push_back(edge);
  else if (answer == MPMRegionEdge::Answer::UNKNOWN && nearest >= far)
    places.push_back({{x[0], x[1], x[2]}, least});    // rather too near than too far
}

/** Does this region end at a place of a part, on the other side of it? There is nothing between
 *  both. */
bool MPMRegionSurface::faces(const MPMRegionSurface &part, const Place &place, double far) const
{
  constexpr double SAME = 1.0e-7, STEP = 1.0e-5;
  const double scale = scale_at(place.x, place.distance);
  if (!(fabs(find(place.x, SAME * scale, false)) < SAME * scale)) return false;
  double n[3], of_part[3];
  normal(place.x, far, STEP * scale, n);
  part.normal(place.x, far, STEP * scale, of_part);
  return MathExtra::dot3(n, of_part) < -0.99;
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

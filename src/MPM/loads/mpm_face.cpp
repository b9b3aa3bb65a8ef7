/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "loads/mpm_face.h"

#include "base/mpm_points.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_passes.h"
#include "field/mpm_stencil.h"
#include "math/matrix.h"
#include "walls/mpm_region_surface.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "region.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr double DEEPEST = 3.0;    // point with a share

// what is refused: center of the force below a plane, and below other surfaces, in spacings;
// difference of the areas of two layers below a plane; and what is told of these
static constexpr double TOO_DEEP = 0.25, TOO_DEEP_CURVED = 0.6;
static constexpr double TOO_UNEQUAL = 0.05, UNEQUAL = 0.01;
// share of the area of a plane that has points above it, which is told
static constexpr double CUT = 0.1;
// ratio of a given area and that of the points from which on it is told
static constexpr double OTHER_AREA = 1.5;

// least variance of the places of points along the surface, in squares of node spacings: fewer than
// three points have less
static constexpr double LEAST_SPREAD = 1.0e-4;

void MPMFace::declare(Options &o, double &spacing, double &area)
{
  using namespace option;
  o.add("spacing",
        {number(spacing, "s", POSITIVE, "distance",
                "spacing of the layers of points along the normal of the region")})
      .standard("cube root of the volume of a point, in 2d square root of its area");
  o.add("area",
        {number(area, "A", POSITIVE, "distance^2 (2d: distance)",
                "area of the surface of the region, if it is known; the shares of points are "
                "scaled to it")})
      .standard("the sum of the shares of points");
}

MPMFace::MPMFace(LAMMPS *lmp, Region *region, double spacing) :
    Pointers(lmp), region(region), spacing(spacing)
{
}

static double hat(double d)
{
  return std::max(0.0, 1.0 - std::fabs(d));
}

double MPMFace::force_share(double depth)
{
  return 2.0 * hat(depth - 1.0) - hat(depth - 2.0);
}

double MPMFace::stress_share(double depth)
{
  if (depth < 0.0 || depth > DEEPEST) return 0.0;
  const auto area = [depth](double center) {    // of the hat up to here
    const double d = std::clamp(depth - center, -1.0, 1.0);
    return d < 0.0 ? 0.5 * (1.0 + d) * (1.0 + d) : 1.0 - 0.5 * (1.0 - d) * (1.0 - d);
  };
  return 1.0 - 2.0 * area(1.0) + area(2.0);
}

/** One down to this depth, and a spacing below it zero. */
static double down_to(double bottom, double depth)
{
  return std::clamp(bottom + 1.0 - depth, 0.0, 1.0);
}

double MPMFace::force_share_cut(double depth)
{
  return (19.0 * down_to(1.0, depth) - 7.0 * down_to(2.0, depth)) / 11.0;
}

double MPMFace::stress_share_cut(double depth)
{
  if (depth < 0.0 || depth > DEEPEST) return 0.0;
  const auto sum = [depth](double bottom) {    // of the above, from the surface on
    const double below = std::clamp(depth - bottom, 0.0, 1.0);
    return std::min(depth, bottom) + below - 0.5 * below * below;
  };
  return 1.0 - (19.0 * sum(1.0) - 7.0 * sum(2.0)) / 11.0;
}

/** Whole points have all the same volume, or the same over that of a division of their edges
 *  (split). The spacing of whole points, if at the surface others have more than a share PARTS of
 *  the volume, else 0: also where those below it have more than UNLIKE of theirs (relaxed points,
 *  elements of a mesh), as their volumes tell nothing of the surface. */
double MPMFace::spacing_of_parts(const MPMField &field, int groupbit,
                                 const MPMRegionSurface &surface) const
{
  constexpr int NBIN = 512;         // for edges within a factor of 16
  constexpr double SAME = 0.005;    // edges that differ by less are the same
  constexpr double PARTS = 0.05, UNLIKE = 0.2;
  const int dim = field.lattice.dim;
  struct Found {
    double edge, volume, distance;
  };
  std::vector<Found> found;
  double mine = 0.0, longest;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !field.is_point(i) || field.is_element_node(i)) continue;
    const double *const x = atom->x[i];
    if (!is_inside(x)) continue;
    const double now = atom->vfrac[i] * field.points->jacobian(i) / field.frame->circle(x[0]);
    const double apart = std::pow(now, 1.0 / dim), far = 1.01 * DEEPEST * apart;
    const double distance = std::fabs(surface.distance(x, far));
    if (distance >= DEEPEST * apart) continue;
    const double stretched =    // around an axis, by as much as the circle
        field.options.axisymmetric ? field.points->F[i][8] : 1.0;
    const double edge = std::pow(atom->vfrac[i] * stretched / field.frame->circle(x[0]), 1.0 / dim);
    found.push_back({edge, now, distance});
    mine = std::max(mine, edge);
  }
  MPI_Allreduce(&mine, &longest, 1, MPI_DOUBLE, MPI_MAX, world);
  if (!(longest > 0.0)) return 0.0;

  // the edge that most of the volume has

  std::vector<double> bins(2 * NBIN, 0.0), all(2 * NBIN);
  for (const auto &one : found) {
    const int bin =
        std::min(NBIN - 1, (int) (NBIN * std::log(longest / one.edge) / std::log(16.0)));
    bins[2 * bin] += one.volume;
    bins[2 * bin + 1] += one.volume * one.edge;
  }
  MPI_Allreduce(bins.data(), all.data(), 2 * NBIN, MPI_DOUBLE, MPI_SUM, world);
  int fullest = 0;
  for (int bin = 0; bin < NBIN; bin++)
    if (all[2 * bin] > all[2 * fullest]) fullest = bin;
  const double whole = all[2 * fullest + 1] / all[2 * fullest];

  // volume: of parts, and all, at the surface and below; present edges
  double volume[4] = {0.0, 0.0, 0.0, 0.0}, volume_of_all[4], present = 0.0, present_of_all;
  for (const auto &one : found) {
    const double n = whole / one.edge;
    const bool part = std::fabs(n - std::max(1.0, std::round(n))) > SAME * n;
    if (!part) present = std::max(present, std::pow(one.volume, 1.0 / dim) / one.edge);
    double *const sum = volume + (one.distance > whole ? 2 : 0);
    sum[0] += part ? one.volume : 0.0;
    sum[1] += one.volume;
  }
  MPI_Allreduce(volume, volume_of_all, 4, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&present, &present_of_all, 1, MPI_DOUBLE, MPI_MAX, world);
  const double *const below = volume_of_all + 2;
  if (!(volume_of_all[0] > PARTS * volume_of_all[1]) || below[0] > UNLIKE * below[1]) return 0.0;
  return spacing > 0.0 ? spacing : whole * present_of_all;
}

/** A region with open faces matches all of space. */
bool MPMFace::is_inside(const double *x) const
{
  if (!region->openflag) return region->match(x[0], x[1], x[2]);
  return (region->inside(x[0], x[1], x[2]) != 0) == (region->interior != 0);
}

void MPMFace::find(const MPMField &field, int groupbit,
                   const std::function<void(int, const Share &)> &f)
{
  const int dim = field.lattice.dim;
  const MPMRegionSurface surface(region, dim);
  region->prematch();
  const double whole = spacing_of_parts(field, groupbit, surface);
  const bool parts = whole > 0.0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !field.is_point(i) || field.is_element_node(i)) continue;
    const double *const x = atom->x[i];
    if (!is_inside(x)) continue;
    const double volume = atom->vfrac[i] * field.points->jacobian(i);
    const double apart = parts ? whole
        : spacing > 0.0        ? spacing
                               : std::pow(volume / field.frame->circle(x[0]), 1.0 / dim);
    const double far = 1.01 * DEEPEST * apart, depth = std::fabs(surface.distance(x, far)) / apart;
    if (depth >= DEEPEST) continue;
    Share share;
    surface.normal(x, far, 1.0e-4 * apart, share.normal);
    share.area = (parts ? force_share_cut(depth) : force_share(depth)) * volume / apart;
    share.stress = parts ? stress_share_cut(depth) : stress_share(depth);
    share.depth = depth * apart;
    share.layer = depth;
    // deeper layers of a straight side around an axis are rings of another length: take that at the
    // surface
    const double ring = field.options.axisymmetric
        ? field.frame->circle(x[0] + share.normal[0] * share.depth) / field.frame->circle(x[0])
        : 1.0;
    const double layers[2] = {parts ? down_to(1.0, depth) / 1.5 : hat(depth - 1.0),
                              parts ? down_to(2.0, depth) / 2.5 : hat(depth - 2.0)};
    share.covered = ring * layers[0] * volume / apart;
    sums[0] += share.area;
    sums[1] += ring * share.area * depth;
    sums[2] += volume;
    for (int d = 0; d < 3; d++) sums[3 + d] += volume * share.normal[d];
    for (int k = 0; k < 2; k++) sums[6 + k] += ring * layers[k] * volume / apart;
    sums[8] += ring * share.area;
    f(i, share);
  }
}

MPMFace::Judgement MPMFace::judge() const
{
  double all[9];
  MPI_Allreduce(sums, all, 9, MPI_DOUBLE, MPI_SUM, world);
  const double *const n = all + 3, area = all[8] != 0.0 ? all[8] : 1.0;
  return {std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) > (1.0 - 1.0e-6) * all[2],
          all[1] / area, std::fabs((all[6] - all[7]) / area)};
}

/** The surface of a region that goes through a body is no surface there: the force acts on the
 *  section. Points outside of the region, within a layer from it, would cover an area; area: that
 *  of the points below it. */
void MPMFace::tell_of_cut(const std::string &user, int igroup, double area) const
{
  double mine = 0.0, beyond;
  for (const auto *field : MPMField::all(lmp)) {
    const int dim = field->lattice.dim;
    const MPMRegionSurface surface(region, dim);
    for (int i = 0; i < atom->nlocal; i++) {
      if (!(atom->mask[i] & group->bitmask[igroup]) || !field->is_point(i) ||
          field->is_element_node(i))
        continue;
      const double *const x = atom->x[i];
      if (is_inside(x)) continue;
      const double volume = atom->vfrac[i] * field->points->jacobian(i);
      const double apart = spacing > 0.0 ? spacing
                                         : std::pow(volume / field->frame->circle(x[0]), 1.0 / dim);
      if (std::fabs(surface.distance(x, 1.01 * apart)) < apart) mine += volume / apart;
    }
  }
  MPI_Allreduce(&mine, &beyond, 1, MPI_DOUBLE, MPI_SUM, world);
  if (beyond > CUT * std::fabs(area) && comm->me == 0)
    error->warning(
        FLERR,
        "{}: points of group {} are right outside of region {}, too, next to {:.3g} of its {:.3g} "
        "of "
        "area: there its surface goes through the inside of a body, and the load acts on that "
        "section; use a region that contains the body, or a group of points that it contains",
        user, group->names[igroup], region->id, beyond, area);
}

void MPMFace::check(const std::string &user, int igroup, double known_area) const
{
  double all[3];    // as in sums
  MPI_Allreduce(sums, all, 3, MPI_DOUBLE, MPI_SUM, world);
  if (all[2] == 0.0 && region->nregion > 1 && MPMRegionSurface(region, domain->dimension).is_open())
    error->all(FLERR, Error::NOLASTLINE,
               "{}: region {} is made of regions with open faces, which have no inside by which "
               "they could be put together: use a fix of this style for each of them, or close "
               "their faces",
               user, region->id);
  if (all[2] == 0.0)
    error->all(
        FLERR, Error::NOLASTLINE,
        "{} finds no points of group {} below the surface of region {}: the body must be inside "
        "of the region, next to its surface",
        user, group->names[igroup], region->id);
  const Judgement layers = judge();
  const double unequal = layers.flat && known_area == 0.0 ? layers.unequal : 0.0;
  if (!(all[0] > 0.0) || unequal > TOO_UNEQUAL ||
      std::fabs(layers.depth) > (layers.flat ? TOO_DEEP : TOO_DEEP_CURVED))
    error->all(
        FLERR, Error::NOLASTLINE,
        "{}: the points below the surface of region {} are not in layers of "
        "the spacing that is expected, or in less than three of them: the force would act {:.3g} "
        "spacings below it, and the areas of two layers differ by {:.3g} %; use the keywords "
        "spacing and area, more points across the body, or points A nx ny nz",
        user, region->id, layers.depth, 100.0 * unequal);
  if (unequal > UNEQUAL && comm->me == 0)
    error->warning(
        FLERR,
        "{}: the areas of two layers of points below region {} differ by "
        "{:.3g} %, and what is found may be wrong by more: use the keywords spacing or area",
        user, region->id, 100.0 * unequal);
  if (known_area > 0.0 && comm->me == 0 &&
      (known_area > OTHER_AREA * all[0] || all[0] > OTHER_AREA * known_area))
    error->warning(FLERR,
                   "{}: the area {:.5g} is given, and that of the points below region {} is about "
                   "{:.5g}: the force is that of the area which is given",
                   user, known_area, region->id, all[0]);
  tell_of_cut(user, igroup, all[0]);
}

void MPMFace::add_stress(const double *T, const double *n, double share, double *tau)
{
  static constexpr int ROW[6] = {0, 1, 2, 0, 0, 1}, COLUMN[6] = {0, 1, 2, 1, 2, 2};
  const double along = T[0] * n[0] + T[1] * n[1] + T[2] * n[2];
  for (int c = 0; c < 6; c++) {
    const int a = ROW[c], b = COLUMN[c];
    tau[c] -= share * (T[a] * n[b] + n[a] * T[b] - along * n[a] * n[b]);
  }
}

void MPMFace::note_lost(LAMMPS *lmp, const std::string &user, int here, double &known)
{
  const double mine = here;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, lmp->world);
  if (all < known && lmp->comm->me == 0)
    lmp->error->warning(FLERR,
                        "{}: {:.0f} of the {:.0f} points of its surface are gone, and with them "
                        "their share of it",
                        user, known - all, known);
  known = all;
}

/** Displacements U = u + (A - 1) (X - X0) with the scatter C = <(X - X0) (X - X0)^T> of places and
 *  B = <(U - u) (X - X0)^T> have A = 1 + B C^-1. Each node has those around itself, relative to its
 *  own means, so that they do not depend on an origin; a point takes the mean of its nodes. What
 *  points of one layer tell of the derivative along the normal does not matter for the area |cof(A)
 *  n|, and it is made nothing by a large scatter along the normal. */
void MPMFaceGrowth::find(MPMField &field, const std::function<Member(int)> &member,
                         const std::function<void(int, double)> &use)
{
  const int dim = field.lattice.dim, square = dim * dim;
  const double h = field.lattice.h;
  // of nodes: weight, displacement, place, and their products
  const int U = 1, X = U + dim, UX = X + dim, XX = UX + square, width = XX + square;
  const MPMStencil stencil(field);
  struct Found {
    int i, slot;
    Member is;
  };
  std::vector<Found> found;
  each_point(field, [&](const auto &run, int i) {
    const Member is = member(i);
    if (is.layer >= 0) found.push_back({i, run.slot, is});
  });

  for (int layer = 0; layer < LAYERS; layer++) {
    sums.assign((std::size_t) field.grid.nnodes() * width, 0.0);
    for (const auto &point : found) {
      if (point.is.layer != layer) continue;
      const double *const u = point.is.moved;
      stencil.visit(field.grid.blocks[point.slot], point.i, [&](const MPMStencil::Node &node) {
        double *const sum = &sums[node.number * width];
        const double w = node.weight;
        sum[0] += w;
        for (int a = 0; a < dim; a++) {
          const double place = h * node.r[a] - u[a];
          sum[U + a] += w * u[a];
          sum[X + a] += w * place;
          for (int b = 0; b < dim; b++) {
            sum[UX + dim * b + a] += w * u[b] * place;
            sum[XX + dim * b + a] += w * (h * node.r[b] - u[b]) * place;
          }
        }
      });
    }
    field.nodes.sum(sums.data(), width, 0, width);
    field.nodes.complete(sums.data(), width, width);

    for (const auto &point : found) {
      if (point.is.layer != layer) continue;
      double C[9] = {0.0}, B[9] = {0.0}, total = 0.0;
      stencil.visit(field.grid.blocks[point.slot], point.i, [&](const MPMStencil::Node &node) {
        const double *const sum = &sums[node.number * width], w = node.weight;
        if (!(sum[0] > 0.0)) return;
        total += w * sum[0];
        for (int a = 0; a < dim; a++)
          for (int b = 0; b < dim; b++) {
            B[3 * a + b] += w * (sum[UX + dim * a + b] - sum[U + a] * sum[X + b] / sum[0]);
            C[3 * a + b] += w * (sum[XX + dim * a + b] - sum[X + a] * sum[X + b] / sum[0]);
          }
      });
      if (!(total > 0.0)) continue;
      const double *const n = point.is.normal, unit = 1.0 / (total * h * h);
      for (int k = 0; k < 9; k++) {
        B[k] *= unit;
        C[k] = unit * C[k] + n[k / 3] * n[k % 3];
      }
      if (dim == 2) C[8] = 1.0;
      const double spread = determinant(C);
      if (!(spread > (dim == 2 ? LEAST_SPREAD : LEAST_SPREAD * LEAST_SPREAD))) continue;
      const double inverse[9] = MPM_COFACTORS(C);    // times the determinant; C is symmetric
      double A[9];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          A[3 * a + b] = a == b ? 1.0 : 0.0;
          for (int k = 0; k < 3; k++) A[3 * a + b] += B[3 * a + k] * inverse[3 * k + b] / spread;
        }
      if (field.options.axisymmetric) {
        const double r = field.frame->places()[point.i][0], before = r - point.is.moved[0];
        if (before > 0.0) A[8] = r / before;
      }
      const double cofactors[9] = MPM_COFACTORS(A);
      double area = 0.0;
      for (int a = 0; a < 3; a++) {
        const double component = dot(cofactors + 3 * a, n);
        area += component * component;
      }
      if (area > 0.0) use(point.i, std::sqrt(area));
    }
  }
}

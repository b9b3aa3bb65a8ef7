/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Domains of cpdi have the half edges F r_0; those of cpdi2 are corners that move with the nodes.
// Only those blocks are active that corners can reach soon, which each step checks.

#include "field/mpm_cpdi.h"

#include "atom.h"
#include "base/mpm_points.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_every.h"
#include "field/mpm_frame.h"
#include "field/mpm_guard.h"
#include "field/mpm_passes.h"
#include "field/mpm_point_map.h"
#include "transfer/cpdi.h"
#include "utils.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// half sizes of boxes, in node spacings: more would reach more nodes than the stencil has
static constexpr double MAX_SIZE = 0.5;
// boxes are smaller by this share of their distance from the origin: in regular arrays, round-off
// would decide otherwise whether they reach the next nodes, which would have forces of the order of
// its root, but no mass
static constexpr double OF_PLACES = 32.0 * std::numeric_limits<double>::epsilon();
// boxes end before fixed faces, by this share of the distance of their center
static constexpr double OF_FACES = 1.0e-12;
// of the places of corners, in node spacings
static constexpr double ROUND_OFF = 1.0e-9;

double LAMMPS_NS::half_size(const MPMField &field, int i)
{
  const double section = field.frame->section(i);
  return 0.5 * (field.lattice.dim == 3 ? cbrt(section) : sqrt(section)) / field.lattice.h;
}

/** A contiguous box of half sizes l has the second moments F diag(l^2) F^T/3, which along axis d
 *  are those of an interval with the half size [sum_e (F_de l_e)^2]^1/2. */
void MPMBoxes::update()
{
  sizes.resize(3 * (std::size_t) atom->nmax, MAX_SIZE);
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    size_of(i, &sizes[3 * (std::size_t) i]);
  });
}

void MPMBoxes::size_of(int i, double *size) const
{
  constexpr double MIN_SIZE = 1.0e-4;
  const int dim = field.lattice.dim;
  const double *const aspect = field.options.aspect;
  const double half = half_size(field, i), *F = field.points->F[i], *x = atom->x[i];
  for (int d = 0; d < dim; d++, F += 3) {
    double edge = aspect[d];
    if (field.options.shape == CPGIMP) {
      double square = 0.0;
      for (int e = 0; e < dim; e++) square += F[e] * F[e] * aspect[e] * aspect[e];
      edge = std::min(sqrt(square), inside(i, d) / half);
    }
    const double place = fabs(x[d] - field.lattice.origin[d]) / field.lattice.h;
    size[d] = std::max(MIN_SIZE, std::min(MAX_SIZE, half * edge) - OF_PLACES * (1.0 + place));
  }
}

/** Distance of a point to the nearest fixed face of the box along an axis, a little shorter, in
 *  node spacings. Deformed boxes end there: those next to an axis of symmetry or a wall have their
 *  edge there as long as their strain is that of the point. */
double MPMBoxes::inside(int i, int d) const
{
  if (domain->periodicity[d]) return MAX_SIZE;
  const double x = atom->x[i][d];
  return (1.0 - OF_FACES) * std::min(x - domain->boxlo[d], domain->boxhi[d] - x) / field.lattice.h;
}

/** A ring has its initial size at x/F_zz, which is its initial radius until it moves only: with
 *  stress apart from the motion (scheme) or averages of strain (locking), F_zz is not quite r/R any
 *  more. */
bool MPMBoxes::is_too_large(int i) const
{
  const bool waits = field.every && field.every->displacement(i, 0) != 0.0;
  if (field.options.axisymmetric && (waits || field.points->F[i][8] != 1.0)) return false;
  const double half = half_size(field, i);
  for (int d = 0; d < field.lattice.dim; d++)
    if (half * field.options.aspect[d] > MAX_SIZE * (1.0 + 1.0e-6)) return true;
  return false;
}

double MPMBoxes::smallest() const
{
  double least = MAX_SIZE;
  for (int i = 0; i < atom->nlocal; i++)
    if (field.is_point(i)) least = std::min(least, half_size(field, i));
  return least;
}

MPMCpdi::MPMCpdi(LAMMPS *lmp, MPMField &field, MPMPointState &state) : Pointers(lmp), field(field)
{
  if (field.options.shape == CPDI2)
    state.declare(corners, "mpm:corners", field.lattice.dim << field.lattice.dim,
                  [](int, double *row) {
                    row[0] = NAN;
                  });    // not known, for update()
}

double *MPMCpdi::moved(bool late)
{
  if (!corners) return nullptr;
  if (!late) return &corners[0][0];
  corners_late.resize(size() * (std::size_t) atom->nmax);
  return corners_late.data();
}

void MPMCpdi::take_late(int first, int last)
{
  if (corners)
    memcpy(corners[first], &corners_late[size() * (std::size_t) first],
           size() * sizeof(double) * (last - first));
}

/** Half edges of the box that an undeformed point is, after the deformation F. */
template <int DIM>
static void half_edges(double half, const double *aspect, const double *F, double *edge)
{
  for (int k = 0; k < DIM; k++)
    for (int d = 0; d < DIM; d++) edge[DIM * k + d] = half * aspect[k] * F[3 * d + k];
}

void MPMCpdi::box(int i, double *edge) const
{
  const double half = half_size(field, i) * field.lattice.h, *F = field.points->F[i],
               *aspect = field.options.aspect;
  field.lattice.dim == 2 ? half_edges<2>(half, aspect, F, edge)
                         : half_edges<3>(half, aspect, F, edge);
}

/** The box that the point was at first; returns how far it reaches, in node spacings. */
double MPMCpdi::make_undeformed(int i)
{
  const int dim = field.lattice.dim;
  const double half = half_size(field, i);
  double *const domain = row(i);
  double far = 0.0;
  for (int k = 0; k < size(); k++) {
    const int d = k % dim, c = k / dim;
    const double sign = follows_F() ? (c == d ? 1.0 : 0.0) : (c >> d & 1 ? 1.0 : -1.0);
    domain[k] = sign * half * field.options.aspect[d] * field.lattice.h;
    far = std::max(far, half * field.options.aspect[d]);
  }
  return far;
}

void MPMCpdi::corners_of_box(int i, double *x) const
{
  double edge[9], gradient[24];
  box(i, edge);
  field.lattice.dim == 2 ? PointDomain<2>::box(edge, x, gradient)
                         : PointDomain<3>::box(edge, x, gradient);
}

/** How far a domain with these half edges or corners reaches from its point. */
template <int DIM> static void reach_of_edges(const double *edge, double *low, double *high)
{
  for (int d = 0; d < DIM; d++) {
    high[d] = 0.0;
    for (int k = 0; k < DIM; k++) high[d] += std::fabs(edge[DIM * k + d]);
    low[d] = -high[d];
  }
}

template <int DIM> static void reach_of_corners(const double *x, double *low, double *high)
{
  for (int d = 0; d < DIM; d++) {
    double sum = 0.0;
    low[d] = high[d] = 0.0;
    for (int k = 0; k < 1 << DIM; k++) {
      low[d] = std::min(low[d], x[DIM * k + d]);
      high[d] = std::max(high[d], x[DIM * k + d]);
      sum += x[DIM * k + d];
    }
    if (!(sum - sum == 0.0)) low[d] = high[d] = NAN;    // which min and max do not see
  }
}

double MPMCpdi::corners_of(int i, double *x, double *w, double *g) const
{
  const int n = 1 << field.lattice.dim;
  double unused[24];
  if (!g) g = unused;
  if (follows_F()) {
    std::fill(w, w + n, 1.0 / n);
    return field.lattice.dim == 2 ? PointDomain<2>::box(row(i), x, g)
                                  : PointDomain<3>::box(row(i), x, g);
  }
  std::copy(corners[i], corners[i] + size(), x);
  return field.lattice.dim == 2 ? PointDomain<2>::free(x, w, g) : PointDomain<3>::free(x, w, g);
}

void MPMCpdi::reach(int i, double low[3], double high[3]) const
{
  const int dim = field.lattice.dim;
  low[2] = high[2] = 0.0;
  if (follows_F())
    (dim == 2 ? reach_of_edges<2> : reach_of_edges<3>) (row(i), low, high);
  else
    (dim == 2 ? reach_of_corners<2> : reach_of_corners<3>) (row(i), low, high);
  for (int d = 0; d < dim; d++) {
    low[d] /= field.lattice.h;
    high[d] /= field.lattice.h;
  }
}

/** A corner may be one block side less one cell away from its point, or else it may be beyond the
 *  tile wherever the point is in its block; one that is nowhere is at no distance. */
void MPMCpdi::limit(int i)
{
  const int room = field.grid.side - 1;
  const double limit = room - 2.0 * ROUND_OFF;
  double *const domain = row(i);
  const bool known = std::all_of(domain, domain + size(), [](double x) {
    return std::isfinite(x);
  });
  double low[3], high[3], far = known ? 0.0 : NAN;
  reach(i, low, high);
  for (int d = 0; d < field.lattice.dim && known; d++)
    far = std::max(far, std::max(-low[d], high[d]));
  if (far <= limit) return;
  field.guard->point_is_bad(
      i, fmt::format("has a domain with a corner {:.4g} node spacings away", far),
      "it is made smaller",
      fmt::format(", the limit is {}: use smaller points or a larger node spacing; with fix mpm "
                  "... bad warn the domain is made smaller, with bad delete the point is removed",
                  room));
  if (!std::isfinite(far)) far = make_undeformed(i);
  const double scale = std::min(1.0, limit / far);
  for (int k = 0; k < size(); k++) domain[k] *= scale;
}

void MPMCpdi::check_corners()
{
  const int n = 1 << field.lattice.dim;
  each_point(field, [&](const MPMPointMap::Run &, int i) {
    double x[24], w[8];
    const double size = corners_of(i, x, w);
    if (size > 0.0 && *std::min_element(w, w + n) >= 0.0) return;
    field.guard->point_is_bad(i, "has a domain that is turned inside out",
                              "it becomes the parallelogram of F");
    if (field.options.bad == MPMFieldOptions::WARN) corners_of_box(i, corners[i]);
  });
}

void MPMCpdi::update()
{
  MPMPointMap &map = *field.map;
  const Grid &grid = field.grid;
  const double *const aspect = field.options.aspect;
  if (follows_F()) edges.resize(size() * (std::size_t) atom->nmax);

  if (map.valid) {
    int outside = 0, all;
    const auto look = [&](auto dimension) {
      constexpr int DIM = dimension;
      double volume = 0.0, half = 0.0;    // of the point before: most have the same
      for (const auto &a : map.active) {
        double first[DIM], end[DIM], low[DIM], high[DIM];
        for (int d = 0; d < DIM; d++) {
          const int b = grid.blocks[a.slot].b[d], n = grid.side;
          first[d] = field.lattice.origin[d] + field.lattice.h * (n * (b + a.low[d]) + ROUND_OFF);
          end[d] = field.lattice.origin[d] +
              field.lattice.h * (n * (b + a.high[d] + 1) - 1.0 - ROUND_OFF);
        }
        for (int k = a.first_run; k < a.last_run; k++)
          for (int i = map.runs[k].first; i < map.runs[k].last; i++) {
            if (follows_F()) {
              if (field.options.axisymmetric || atom->vfrac[i] != volume) {
                volume = atom->vfrac[i];
                half = half_size(field, i) * field.lattice.h;
              }
              double *edge = &edges[DIM * DIM * (std::size_t) i];
              half_edges<DIM>(half, aspect, field.points->F[i], edge);
              reach_of_edges<DIM>(edge, low, high);
            } else {
              reach_of_corners<DIM>(corners[i], low, high);
            }
            const double *x = atom->x[i];
            for (int d = 0; d < DIM; d++)
              outside |= !(x[d] + low[d] >= first[d]) | !(x[d] + high[d] < end[d]);
          }
      }
    };
    if (field.lattice.dim == 2)
      look(std::integral_constant<int, 2>());
    else
      look(std::integral_constant<int, 3>());
    MPI_Allreduce(&outside, &all, 1, MPI_INT, MPI_BOR, world);
    if (!all) return;
    map.valid = false;
  }

  bigint nboxes = 0, ndeformed = 0;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    if (follows_F()) {
      box(i, row(i));
    } else if (std::isnan(corners[i][0])) {    // has not moved yet
      corners_of_box(i, corners[i]);
      nboxes++;
      ndeformed += std::fabs(field.points->jacobian(i) - 1.0) > 1.0e-6;
    }
    limit(i);
  }
  if (field.options.shape == CPDI2 && !warned) tell_of_boxes(nboxes, ndeformed);
  warned = true;
}

/** Points have corners if create_points elements gave them or the fix has moved them before; they
 *  go with the fix, when it is defined again. */
void MPMCpdi::tell_of_boxes(bigint nboxes, bigint ndeformed)
{
  const bigint mine[2] = {nboxes, ndeformed};
  bigint all[2];
  MPI_Allreduce(mine, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  if (comm->me || all[0] == 0) return;
  utils::logmesg(lmp, "Fix mpm {}: {} points begin with boxes of their volume as domains\n",
                 field.id(), all[0]);
  if (all[1])
    error->warning(
        FLERR,
        "Fix mpm {} shape cpdi2: {} of these points have been deformed before: domains that they "
        "had, with a fix mpm that is gone, are lost, and become boxes with the deformation F",
        field.id(), all[1]);
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Domains of the points of fix mpm (shapes cpdi and cpdi2), see transfer/cpdi.h.
//
// Those of cpdi are made from F in each step, half edges F r_0; those of cpdi2 are corners that move
// with the nodes' velocities. Domains stay the same throughout a step. A tile has the neighbors of
// its block on all sides, but only those blocks are active that corners can reach soon: whether
// they still do is checked at the start of each step.

#include "mpm_cpdi.h"

#include "atom.h"
#include "error.h"
#include "mpm_boxes.h"
#include "mpm_field.h"
#include "mpm_guard.h"
#include "mpm_point_map.h"
#include "mpm_points.h"
#include "transfer/cpdi.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// of the places of corners, in node spacings
static constexpr double ROUND_OFF = 1.0e-9;

/* ---------------------------------------------------------------------- */

MPMCpdi::MPMCpdi(LAMMPS *lmp, MPMField &field, MPMPointState &state) :
    Pointers(lmp), corners(nullptr), field(field)
{
  if (field.options.shape == CPDI2)
    state.declare(corners, "mpm:corners", field.lattice.dim << field.lattice.dim,
                  [](int, double *row) {
                    row[0] = NAN;
                  });    // not known, for update()
}

int MPMCpdi::size() const
{
  const int dim = field.lattice.dim;
  return field.options.shape == CPDI2 ? dim << dim : dim * dim;
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

double MPMCpdi::memory_usage() const
{
  return (edges.capacity() + corners_late.capacity()) * sizeof(double);
}

double MPMCpdi::bytes_per_point() const
{
  return corners ? 0.0 : size() * sizeof(double);
}

/* ----------------------------------------------------------------------
   half edges of the box that an undeformed point is, after the deformation F
------------------------------------------------------------------------- */

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

/* ----------------------------------------------------------------------
   how far a domain with these half edges or corners reaches from its point
------------------------------------------------------------------------- */

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
    low[d] = high[d] = 0.0;
    for (int k = 0; k < 1 << DIM; k++) {
      low[d] = std::min(low[d], x[DIM * k + d]);
      high[d] = std::max(high[d], x[DIM * k + d]);
    }
  }
}

/* ----------------------------------------------------------------------
   cpdi2: the corners of that box
------------------------------------------------------------------------- */

void MPMCpdi::reset_corners(int i)
{
  double edge[9], gradient[24];
  box(i, edge);
  if (field.lattice.dim == 2)
    PointDomain<2>::box(edge, corners[i], gradient);
  else
    PointDomain<3>::box(edge, corners[i], gradient);
}

/* ----------------------------------------------------------------------
   corners of the domain relative to the point, and their weights; returns the size
------------------------------------------------------------------------- */

double MPMCpdi::corners_of(int i, double *x, double *w, double *g) const
{
  const int n = 1 << field.lattice.dim;
  double unused[24];
  if (!g) g = unused;
  if (follows_F()) {
    const double *edge = &edges[size() * (std::size_t) i];
    std::fill(w, w + n, 1.0 / n);
    return field.lattice.dim == 2 ? PointDomain<2>::box(edge, x, g)
                                  : PointDomain<3>::box(edge, x, g);
  }
  std::copy(corners[i], corners[i] + size(), x);
  return field.lattice.dim == 2 ? PointDomain<2>::free(x, w, g) : PointDomain<3>::free(x, w, g);
}

/* ----------------------------------------------------------------------
   how far a domain reaches from its point along each axis, in node spacings
------------------------------------------------------------------------- */

void MPMCpdi::reach(int i, double low[3], double high[3]) const
{
  const double *row = follows_F() ? &edges[size() * (std::size_t) i] : corners[i];
  low[2] = high[2] = 0.0;
  if (follows_F())
    field.lattice.dim == 2 ? reach_of_edges<2>(row, low, high) : reach_of_edges<3>(row, low, high);
  else
    field.lattice.dim == 2 ? reach_of_corners<2>(row, low, high)
                           : reach_of_corners<3>(row, low, high);
  for (int d = 0; d < field.lattice.dim; d++) {
    low[d] /= field.lattice.h;
    high[d] /= field.lattice.h;
  }
}

/* ----------------------------------------------------------------------
   a corner may be one block side less one cell away from its point, or else it may be beyond the
   tile wherever the point is in its block
------------------------------------------------------------------------- */

void MPMCpdi::limit(int i)
{
  const int room = field.grid.side - 1;
  const double limit = room - 2.0 * ROUND_OFF;
  double low[3], high[3], far = 0.0;
  reach(i, low, high);
  for (int d = 0; d < field.lattice.dim; d++) far = std::max(far, std::max(-low[d], high[d]));
  if (far <= limit) return;
  field.guard->point_is_bad(
      i, fmt::format("has a domain with a corner {:.4g} node spacings away", far),
      "it is made smaller",
      fmt::format(
          ", the limit is {}: use smaller points or a larger node spacing; with fix mpm ... bad "
          "warn the domain is made smaller, with bad delete the point is removed",
          room));
  const int n = size();
  double *row = corners ? corners[i] : &edges[n * (std::size_t) i];
  const double scale = std::isfinite(far) ? limit / far : 0.0;
  for (int k = 0; k < n; k++) row[k] = scale > 0.0 ? scale * row[k] : 0.0;
}

/* ----------------------------------------------------------------------
   cpdi2: points whose domain is inverted; with policy warn it becomes that of F
------------------------------------------------------------------------- */

void MPMCpdi::check_corners()
{
  const int n = 1 << field.lattice.dim;
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      double x[24], w[8];
      const double size = corners_of(i, x, w);
      if (size > 0.0 && *std::min_element(w, w + n) >= 0.0) continue;
      field.guard->point_is_bad(i, "has a domain that is turned inside out",
                                "it becomes the parallelogram of F");
      if (field.options.bad == MPMFieldOptions::WARN) reset_corners(i);
    }
}

/* ----------------------------------------------------------------------
   the domains of this step; new lists of blocks if corners are beyond those that are active
------------------------------------------------------------------------- */

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

  for (int i = 0; i < atom->nlocal; i++) {
    if (!field.is_point(i)) continue;
    if (follows_F())
      box(i, &edges[size() * (std::size_t) i]);
    else if (std::isnan(corners[i][0]))    // has not moved yet
      reset_corners(i);
    limit(i);
  }
}

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "walls/mpm_region_body.h"

#include "region.h"

#include <cmath>

using namespace LAMMPS_NS;

// samples along each axis
static constexpr int SAMPLES_2D = 2000, SAMPLES_3D = 160;

static void box_of(const Region &region, double *lo, double *hi)
{
  lo[0] = region.extent_xlo;
  hi[0] = region.extent_xhi;
  lo[1] = region.extent_ylo;
  hi[1] = region.extent_yhi;
  lo[2] = region.extent_zlo;
  hi[2] = region.extent_zhi;
}

bool MPMRegionBody::is_bounded(const Region &region, int dim)
{
  constexpr double FAR = 1.0e19;    // infinite edges are at 1e20
  double lo[3], hi[3];
  box_of(region, lo, hi);
  bool is = region.bboxflag;
  for (int d = 0; d < dim; d++) is = is && lo[d] > -FAR && hi[d] < FAR && hi[d] > lo[d];
  return is;
}

MPMRegionBody::MPMRegionBody(Region &region, int dim)
{
  const int n = dim == 2 ? SAMPLES_2D : SAMPLES_3D;
  box_of(region, lo, hi);
  double step[3] = {1.0, 1.0, 1.0};
  for (int d = 0; d < dim; d++) step[d] = (hi[d] - lo[d]) / n;
  if (dim == 2) lo[2] = hi[2] = 0.0;
  const double piece = step[0] * step[1] * (dim == 3 ? step[2] : 1.0);

  // sums about the middle of the box

  double first[3] = {}, second[3][3] = {};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < (dim == 3 ? n : 1); k++) {
        const int place[3] = {i, j, k};
        double x[3] = {0.0, 0.0, 0.0}, r[3] = {0.0, 0.0, 0.0};
        for (int d = 0; d < dim; d++) {
          r[d] = (place[d] + 0.5 - 0.5 * n) * step[d];
          x[d] = 0.5 * (lo[d] + hi[d]) + r[d];
        }
        if (!region.match(x[0], x[1], x[2])) continue;
        volume += piece;
        for (int d = 0; d < dim; d++) {
          first[d] += piece * r[d];
          for (int e = 0; e < dim; e++) second[d][e] += piece * r[d] * r[e];
        }
      }
  if (volume == 0.0) return;
  for (int d = 0; d < dim; d++) center[d] = 0.5 * (lo[d] + hi[d]) + first[d] / volume;
  double trace = 0.0;
  for (int d = 0; d < dim; d++) {
    for (int e = 0; e < dim; e++) second[d][e] -= first[d] * first[e] / volume;
    second[d][d] += volume * step[d] * step[d] / 12.0;    // of the piece that a sample stands for
    trace += second[d][d];
  }
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++) inertia[d][e] = (d == e ? trace : 0.0) - second[d][e];
}

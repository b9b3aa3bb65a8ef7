/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "mpm_face.h"

#include "mpm_field.h"
#include "mpm_frame.h"
#include "mpm_points.h"
#include "mpm_region_surface.h"

#include "atom.h"
#include "region.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

static constexpr double DEEPEST = 3.0;    // point with a share

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
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || !field.is_point(i) || field.is_element_node(i)) continue;
    const double *const x = atom->x[i];
    if (!is_inside(x)) continue;
    const double volume = atom->vfrac[i] * field.points->jacobian(i);
    const double apart = spacing > 0.0 ? spacing
                                       : std::pow(volume / field.frame->circle(x[0]), 1.0 / dim);
    const double far = 1.01 * DEEPEST * apart, depth = std::fabs(surface.distance(x, far)) / apart;
    if (depth >= DEEPEST) continue;
    Share share;
    surface.normal(x, far, 1.0e-4 * apart, share.normal);
    share.area = force_share(depth) * volume / apart;
    share.stress = stress_share(depth);
    sums[0] += share.area;
    sums[1] += share.area * depth;
    sums[2] += volume;
    for (int d = 0; d < 3; d++) sums[3 + d] += volume * share.normal[d];
    for (int k = 0; k < 2; k++) sums[6 + k] += hat(depth - 1 - k) * volume / apart;
    f(i, share);
  }
}

MPMFace::Judgement MPMFace::judge() const
{
  double all[8];
  MPI_Allreduce(sums, all, 8, MPI_DOUBLE, MPI_SUM, world);
  const double *const n = all + 3, area = all[0] != 0.0 ? all[0] : 1.0;
  return {std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) > (1.0 - 1.0e-6) * all[2],
          all[1] / area, std::fabs((all[6] - all[7]) / area)};
}

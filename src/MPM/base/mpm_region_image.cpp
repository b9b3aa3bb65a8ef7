/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "base/mpm_region_image.h"

#include "domain.h"
#include "region.h"

#include <cstring>

using namespace LAMMPS_NS;

static constexpr double INFINITE = 1.0e19;    // LAMMPS has 1e20 for INF in regions

double LAMMPS_NS::image_shift(const Domain &domain, const Region &region, int d)
{
  if (!domain.periodicity[d] || !region.bboxflag || !region.interior || region.rotateflag ||
      region.nregion > 1)
    return 0.0;
  double lo = d == 0 ? region.extent_xlo
      : d == 1       ? region.extent_ylo
                     : region.extent_zlo,
         hi = d == 0 ? region.extent_xhi
      : d == 1       ? region.extent_yhi
                     : region.extent_zhi;
  if (region.dynamic && strcmp(region.style, "mpm/mesh") == 0) {    // others move their bounds
    const double moved = d == 0 ? region.dx : d == 1 ? region.dy : region.dz;
    lo += moved;
    hi += moved;
  }
  const double length = domain.prd[d], least = 1.0e-6 * length;
  const bool below = lo < domain.boxlo[d] - least;
  const bool above = hi > domain.boxhi[d] + least;
  // one that is as long as the box needs no images, and INF means the face of the box
  if (below == above || hi - lo > length - least || lo < -INFINITE || hi > INFINITE ||
      hi < domain.boxlo[d] || lo > domain.boxhi[d])
    return 0.0;
  return below ? length : -length;
}

bool LAMMPS_NS::matches_with_images(const Domain &domain, Region &region, const double *x)
{
  double shift[3];
  for (int d = 0; d < 3; d++) shift[d] = image_shift(domain, region, d);
  for (int image = 0; image < 8; image++) {
    double at[3];
    bool is_new = true;
    for (int d = 0; d < 3; d++) {
      const bool far = image >> d & 1;
      is_new = is_new && !(far && shift[d] == 0.0);
      at[d] = x[d] - (far ? shift[d] : 0.0);
    }
    if (is_new && region.match(at[0], at[1], at[2])) return true;
  }
  return false;
}

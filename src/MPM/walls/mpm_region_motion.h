/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_MOTION_H
#define LMP_MPM_REGION_MOTION_H

#include "region.h"

#include <array>

namespace LAMMPS_NS {

/** Present position of a region that moves. It gives access to protected members of Region. */
struct MPMRegionMotion : public Region {
  /** Center and unit axis of the rotation of a region. */
  static const double *point_of(const Region *r) { return r->*(&MPMRegionMotion::point); }
  static const double *axis_of(const Region *r) { return r->*(&MPMRegionMotion::runit); }

  /** Pointers to the shift and the angle of a region, as restart files keep them. */
  static std::array<double *, 4> of(Region *r) { return {&r->dx, &r->dy, &r->dz, &r->theta}; }
};

}    // namespace LAMMPS_NS

#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_BODY_H
#define LMP_MPM_REGION_BODY_H

namespace LAMMPS_NS {
class Region;

/** The inside of a region as a body of density 1; in 2d an area, and its inertia about the axis z alone. */
struct MPMRegionBody {
  double volume = 0.0;
  double center[3] = {};
  double inertia[3][3] = {};    ///< about the center
  double lo[3] = {}, hi[3] = {};

  /** By samples in the box around the region, with an error of some 1e-4; blocks have none. The region must have such a box,
   *  see is_bounded(), and be at rest. */
  MPMRegionBody(Region &region, int dim);

  static bool is_bounded(const Region &region, int dim);
};

}    // namespace LAMMPS_NS
#endif

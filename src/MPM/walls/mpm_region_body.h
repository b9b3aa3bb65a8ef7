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

/** The inside of a region as a body of density 1. In 2d the volume is an area, and the inertia is
 *  that about the z axis only. */
struct MPMRegionBody {
  double volume = 0.0;
  double center[3] = {};
  double inertia[3][3] = {};    ///< about the center
  double lo[3] = {}, hi[3] = {};

  /** Integrates by samples in the box around the region, with an error of some 1e-4; blocks are
   *  exact. The region must have such a box, see is_bounded(), and be at rest. */
  MPMRegionBody(Region &region, int dim);

  /** Is there a box around the region with finite edges, as the constructor needs it? */
  static bool is_bounded(const Region &region, int dim);
};

}    // namespace LAMMPS_NS
#endif

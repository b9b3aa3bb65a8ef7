/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_IMAGE_H
#define LMP_MPM_REGION_IMAGE_H

namespace LAMMPS_NS {
class Domain;
class Region;

/** How far along an axis the image is away that a region, which reaches across a periodic face,
 *  needs at the other end of the box; 0 if it needs none, or if its extent is not known. Regions
 *  themselves know nothing of periodic images. A region that moves must be up to date. */
double image_shift(const Domain &, const Region &, int axis);

/** Has the region, or one of these images, x inside? */
bool matches_with_images(const Domain &, Region &, const double *x);

}    // namespace LAMMPS_NS
#endif

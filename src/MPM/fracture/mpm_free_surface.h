/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FREE_SURFACE_H
#define LMP_MPM_FREE_SURFACE_H

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Finds which points are next to no others on one side, as if there were only those that
 *  counts(i) accepts, and sets their unit vectors out of the body, normal[3i...]; those of other
 *  points stay. The volume around such a point, smoothed on a lattice as fine as the points are,
 *  fills less of space than inside of a body: next to a plane surface .83, next to a gap of a
 *  fifth of the distance of points .92. A fixed face of the box in a plane of nodes is no
 *  surface. Updated frame, no axis of symmetry. Finds the blocks if necessary. Collective. */
void find_free_surface(MPMField &, const std::function<bool(int)> &counts,
                       std::vector<double> &normal);

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_PATCH_SUMS_H
#define LMP_MPM_PATCH_SUMS_H

#include <array>
#include <map>
#include <mpi.h>
#include <vector>

namespace LAMMPS_NS {

/** Weighted sums of two values over patches of a surface. The patch around a place consists of the
 *  places of the same part that are closer than a radius and whose normals point to the same side.
 *  All ranks hold the places of all ranks. */
class MPMPatchSums {
 public:
  struct Place {
    double part;    ///< places of different parts lie on different surfaces
    double at[3], normal[3];
    double value[2];
  };

  MPMPatchSums(MPI_Comm world, double radius) : world(world), radius(radius) {}

  /** Collects the places of all ranks; mine: those of this rank. Collective. */
  void gather(const std::vector<Place> &mine);
  /** Sums over the patch around a place. The weights fall from one at the place to zero at the
   *  radius, and are multiplied by the cosine between the normals. */
  std::array<double, 2> around(double part, const double *at, const double *normal) const;

 private:
  using Cell = std::array<int, 3>;

  MPI_Comm world;
  double radius;
  std::map<Cell, std::vector<Place>> cells;

  Cell cell_of(const double *at) const;
};

}    // namespace LAMMPS_NS
#endif

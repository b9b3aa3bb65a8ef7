/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_FBAR_H
#define LMP_MPM_MESH_FBAR_H

#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_conditions.h"
#include "meshgrid/mpm_mesh_means.h"

#include <vector>

namespace LAMMPS_NS {
class MPMMeshBody;

/** Averages of volume changes and of the mean stress over the points around, against volumetric
 *  locking (F-bar). */
class MPMMeshFbar {
 public:
  explicit MPMMeshFbar(MPMMeshBody &);

  /** Finds the mean stresses for the forces of this step. Collective. */
  void find_stress();
  double mean_stress(int i) const { return volumetric[i].stress; }
  /** Finds the mean volume changes for the strain by these velocities; nodes of the total frame
   *  have moved. Collective. */
  void find_strain(const std::vector<MPM_NS::MeshVector> &velocities);
  /** Makes the velocity gradient L of a point, column-major, that of the motion with the mean
   *  change of volume. */
  void scale(int i, double *L) const;
  double memory_usage() const;

 private:
  struct Volumetric {
    int group;        // number of the group of points with means of their own
    double weight;    // weight in the means of this step
    double stress;    // mean Kirchhoff stress for the force
    double own,
        all;    // volume ratio at the start: by the motion of the point; mean; updated frame: 1
    double scale;    // factor on the motion in each direction
  };
  MPMMeshBody &body;
  MPMMeshMeans means;
  std::vector<Volumetric> volumetric;    // [point]
};

}    // namespace LAMMPS_NS
#endif

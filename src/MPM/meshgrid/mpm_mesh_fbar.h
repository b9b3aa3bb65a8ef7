/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_FBAR_H
#define LMP_MPM_MESH_FBAR_H

#include "base/mpm_lists.h"
#include "mesh/background_mesh.h"
#include "meshgrid/mpm_mesh_conditions.h"

#include <vector>

namespace LAMMPS_NS {
class MPMMeshBody;
class MPMMeshRanks;

/** Means over the points around each point of a mesh,
 *      <q>_p = sum_i N_ip (sum_q N_iq w_q q_q)/(sum_q N_iq w_q)
 *  separately for groups of points that do not influence each other. */
class MPMMeshMeans {
 public:
  MPMMeshMeans(const MPM_NS::BackgroundMesh &mesh, MPMMeshRanks &ranks) : mesh(mesh), ranks(ranks)
  {
  }

  /** Resets the sums, for this number of groups and of values. */
  void clear(int ngroup, int nvalue);
  /** Adds the values of a point of a group with this weight. */
  void add(int group, const MPM_NS::BackgroundMesh::Place &, double weight, const double *values);
  /** Sums over ranks. Collective. */
  void sum();
  /** Mean of value k at a point. */
  double mean(int group, const MPM_NS::BackgroundMesh::Place &, int k) const;
  double memory_usage() const { return bytes_of(sums); }

 private:
  const MPM_NS::BackgroundMesh &mesh;
  MPMMeshRanks &ranks;
  int width = 1, groups = 0;
  // [group][node][width]: sum of weights, then sums of weight times value
  std::vector<double> sums;

  std::size_t row(int group, int node) const { return width * (group * mesh.nodes.size() + node); }
};

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
  double memory_usage() const { return means.memory_usage() + bytes_of(volumetric); }

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

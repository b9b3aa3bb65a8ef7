/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_MEANS_H
#define LMP_MPM_MESH_MEANS_H

#include "mesh/background_mesh.h"

#include <vector>

namespace LAMMPS_NS {
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
  double memory_usage() const { return (double) (sums.capacity() * sizeof(double)); }

 private:
  const MPM_NS::BackgroundMesh &mesh;
  MPMMeshRanks &ranks;
  int width = 1, groups = 0;
  // [group][node][width]: sum of weights, then sums of weight times value
  std::vector<double> sums;

  std::size_t row(int group, int node) const { return width * (group * mesh.nodes.size() + node); }
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAYER_MEAN_H
#define LMP_MPM_LAYER_MEAN_H

#include "diffusion/mpm_node_scalar.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

/** Conductivities of points next to interfaces between materials that conduct heat, or water in
 *  their pores, differently: the harmonic mean across an interface and, if requested, the
 *  arithmetic mean along it, over about a node spacing. */
class MPMLayerMean {
 public:
  /** Fills in conductivities k [n] > 0 and volumes [n] of points. Returns false if this run does
   *  not conduct. */
  using Fill =
      std::function<bool(const MPMPointMap::Run &, int first, int n, double *k, double *volume)>;

  /** Upper limit of a mean across an interface, relative to the conductivity of the point
   *  itself. */
  static constexpr double MOST = 4.0;
  /** Smaller conductivities are replaced by this value; the square of its inverse must be
   *  representable. */
  static constexpr double LEAST = 1.0e-100;

  /** along: use means along interfaces, too, which may be much above the conductivity of the
   *  point. */
  MPMLayerMean(MPMField &field, bool along) : field(field), nodes(field), means_along(along) {}

  /** Start of a run. */
  void init() { nodes.init(false, means_along); }
  /** Finds the means at this rank's points in this step. Collective. */
  void find(const Fill &);
  /** Finds means of other values over about a node spacing, [n]. fill: as in find(), with a value
   *  of any kind. Collective. */
  void find_means(const Fill &, std::vector<double> &values);
  /** Is point i next to an interface? If so, the following functions return its unit normal, and
   *  the conductivities along and across it. */
  bool at_interface(int i) const { return means[i].less != 0.0; }
  const double *normal(int i) const { return means[i].normal; }
  double along(int i) const { return means[i].along; }
  double across(int i) const { return means[i].along - means[i].less; }
  /** The greatest conductivity of a point. */
  double most(int i) const { return means[i].along + std::max(0.0, -means[i].less); }
  /** Upper bound of most() relative to the conductivity of the point itself. ratio: the same for
   *  the greatest conductivity of all points. */
  double most_over_own(double ratio) const { return means_along ? ratio : std::min(ratio, MOST); }
  /** Multiplies the vector q by the conductivity of a point, in place. */
  void multiply(int i, double *q) const
  {
    const Mean &m = means[i];
    const double part = m.less * (m.normal[0] * q[0] + m.normal[1] * q[1] + m.normal[2] * q[2]);
    for (int d = 0; d < 3; d++) q[d] = m.along * q[d] - part * m.normal[d];
  }

  double memory_usage() const { return nodes.memory_usage() + means.capacity() * sizeof(Mean); }

 private:
  struct Mean {
    double along, less;    // conductivity along an interface, and by how much it is less across it
    double normal[3];
  };
  MPMField &field;
  MPMNodeScalar nodes;
  const bool means_along;
  std::vector<Mean> means;    // [n]
};

}    // namespace LAMMPS_NS
#endif

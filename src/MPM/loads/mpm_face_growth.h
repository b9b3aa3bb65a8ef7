/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FACE_GROWTH_H
#define LMP_MPM_FACE_GROWTH_H

#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Growth of the area of a surface, from the displacements of the points below it.
 *
 *  In the updated frame the deformation gradients of single points at a free surface do not measure
 *  this growth. Where the lattice of points cuts a curved surface, points that stick out are
 *  stretched less than the body, and gaps open between them, which a mean over points leaves out.
 *  The places of points include the gaps. So in each layer of points below the surface, an affine
 *  motion is fitted to the displacements of the points around each one, by least squares with the
 *  shape functions of nodes as weights. It gives the ratio of the areas.
 */
class MPMFaceGrowth {
 public:
  /** A point that may be below the surface. */
  struct Member {
    int layer;    ///< number of its layer, from 0 on; negative: the point is not below the surface
    const double *moved;     ///< displacement since the surface was found [3, distance]
    const double *normal;    ///< unit normal at that time [3]
  };
  static constexpr int LAYERS = 3;

  /** Calls use(i, growth) for the points i for which member(i) has a layer and that have enough
   *  other points around them. growth: present area over the area before the displacements. The
   *  nodes in reach of the points must be known. Collective. */
  void find(MPMField &, const std::function<Member(int i)> &member,
            const std::function<void(int i, double growth)> &use);
  double memory_usage() const { return sums.capacity() * sizeof(double); }

 private:
  std::vector<double> sums;    // of nodes
};

}    // namespace LAMMPS_NS
#endif

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

/** How much larger a surface has become, by where the points below it have come to.
 *
 *  In the updated frame the deformation gradients of single points at a free surface are no measure of that. Where a curved surface is cut
 *  by the lattice of points, those that stick out are stretched less than the body, and gaps open between them: a mean
 *  over points leaves out the gaps. Places of points do know of them. In each layer of points below the surface, an affine motion is fitted to
 *  the displacements of the points around each one, by least squares with the functions of nodes as weights, and gives the
 *  ratio of the areas.
 */
class MPMFaceGrowth {
 public:
  /** A point below the surface. */
  struct Member {
    int layer;    ///< number of its layer, from 0 on; negative: the point has no part in it
    const double *moved;     ///< displacement since areas were one [3, distance]
    const double *normal;    ///< unit normal at that time [3]
  };
  static constexpr int LAYERS = 3;

  /** Calls use(i, growth) for the points i for which member(i) has a layer, and enough other points around them: growth is the present
   *  area for each one before. The nodes in reach of the points must be known. Collective. */
  void find(MPMField &, const std::function<Member(int i)> &member,
            const std::function<void(int i, double growth)> &use);
  double memory_usage() const { return sums.capacity() * sizeof(double); }

 private:
  std::vector<double> sums;    // of nodes
};

}    // namespace LAMMPS_NS
#endif

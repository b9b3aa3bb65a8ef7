/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_INSIDE_FRACTION_H
#define LMP_MPM_INSIDE_FRACTION_H

#include "lattice/grid.h"

#include <algorithm>

namespace LAMMPS_NS {
class Domain;
class MPMField;

/** Fraction of the volume of a node that is inside of the fixed faces of the box. Bodies that touch
 *  there fill this part: a node in the plane of a face has half of its volume inside. Nodes outside
 *  are mirror nodes of those inside. */
class MPMInsideFraction {
 public:
  static constexpr int REACH = 2;    ///< of the function of a node [node spacings]
  struct Side {
    int plane;                     ///< index of the plane of nodes at the face
    bool fixed;                    ///< is the face fixed? else it does not count
    bool mirror;                   ///< does a fixed face lie in that plane?
    double fraction[REACH + 1];    ///< of the nodes from the plane inward
  };

  /** Prepares a run on the lattice of this field. */
  void find(const MPMField &, const Domain &);
  /** Fraction of a node. Replaces the index of a node outside by that of its mirror node inside;
   *  mirrored: was it replaced? */
  double at(int *index, int dim, bool &mirrored) const;
  using Sides = Side[2];
  /** The faces across an axis. */
  const Sides &across(int axis) const { return sides[axis]; }
  /** Calls use(block) for each block with mirror nodes of the nodes of a block. */
  template <class Use> void mirrors(const MPM_NS::Grid &, const int *block, const Use &use) const;

 private:
  Side sides[3][2];    // [axis][side]
};

template <class Use>
void MPMInsideFraction::mirrors(const MPM_NS::Grid &grid, const int *block, const Use &use) const
{
  for (int d = 0; d < grid.lattice.dim; d++)
    for (const auto &near : sides[d]) {
      if (!near.mirror) continue;
      const int first = std::max(block[d] * grid.side, near.plane - REACH);
      const int last = std::min(block[d] * grid.side + grid.side - 1, near.plane + REACH);
      if (first > last) continue;
      for (const int node : {first, last}) {
        int image[3] = {block[0], block[1], block[2]};
        image[d] = (2 * near.plane - node) >> grid.shift_bits;
        use(image);
      }
    }
}

}    // namespace LAMMPS_NS
#endif

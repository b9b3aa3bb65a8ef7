/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_WETTING_H
#define LMP_MPM_FLOW_WETTING_H

#include "mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowRegions;

/** Values in the middle of cells, such as smooth shares of a fluid, go on into walls such that their contours meet these at a
 *  contact angle: what is at the depth d behind a wall with the normal m (into the flow) is what is
 *  at the height d above it, at a place that is farther along the wall, to where there is more fluid, by 2 d cot(angle). This maps planes
 *  that meet the wall at the angle to themselves, and curved surfaces to such ones with the same curvature, as an image at a mirror
 *  does for 90 degrees. The direction along the wall is that of the slope of the values at the wall.
 *
 *  Behind walls of the box there is one layer of cells. In regions these are all cells next to the flow whose middle is inside. */
class MPMFlowWetting {
 public:
  /** Layers of cells around its own ones that a rank needs. */
  static int overlap(bool with_regions) { return with_regions ? 5 : 2; }

  /** cotangent: of the contact angle, in the fluid; regions: null, none. */
  MPMFlowWetting(const MPMFlowLattice &cells, const MPMFlowRegions *regions, double cotangent) :
      cells(cells), regions(regions), cotangent(cotangent)
  {
  }

  /** Where walls are now. */
  void find_walls();
  /** Values [cell] of owners to all ranks, and behind walls. find: directions along walls are those of these values, otherwise those found
   *  before; those of others than zero alone count, if skip_zero. */
  void complete(std::vector<double> &values, bool find, bool skip_zero = false);
  /** Is the middle of a cell in a region? */
  bool is_behind(int64_t cell) const { return regions && behind[cell]; }

  double memory_usage() const;

 private:
  struct Hidden {            // owned cell whose middle is in a region
    int cell;                // in the list of cells
    double out[3], depth;    // direction out of it, and distance to its surface [spacings]
    double along[3];         // direction along the wall to where there is less fluid, or zero
  };
  struct AtWall {    // owned cell at a wall of the box
    int cell, axis, side;
    double along[3];
  };
  const MPMFlowLattice &cells;
  const MPMFlowRegions *const regions;
  const double cotangent;
  std::vector<Hidden> hidden;
  std::vector<AtWall> at_walls;
  std::vector<char> behind;
  std::vector<double> layers[2], next;    // [2][cell][dim] at walls of the box

  double value_at(const std::vector<double> &values, const MPMFlowLattice::Cell &cell,
                  const double *way, bool skip_zero) const;
  void fill_regions(std::vector<double> &values, bool find, bool skip_zero);
  void fill_walls(std::vector<double> &values, bool find);
  double along_wall(const std::vector<double> &layer, const AtWall &, int axis, int side) const;
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_STICK_H
#define LMP_MPM_FLOW_STICK_H

#include "mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowRegions;

/** Regions without slip: distances of the faces of cells from walls, and velocities of walls there. A face whose middle is in
 *  a wall has the velocity of the wall. Between it and a face in the flow, the velocity at the wall is that of the wall.
 *  Faces are numbered cell*dim + axis. */
class MPMFlowStick {
 public:
  MPMFlowStick(const MPMFlowLattice &cells, const MPMFlowRegions &regions) :
      cells(cells), regions(regions)
  {
  }

  /** Finds distances and velocities for the present state of regions, after MPMFlowRegions::find(). again: at the start of a
   *  run, even if nothing moves. */
  void find(bool again);
  /** Is the middle of a face in a wall, or the face closed? */
  bool is_wall(int64_t face) const { return !(level[face] > 0.0); }
  /** Component of the velocity of the nearest wall, extended rigidly to the middle of a face; 0 far from walls. */
  double velocity(int64_t face) const { return carried[face]; }
  /** Effect of a wall between two faces, one spacing apart, on the difference of their velocities. */
  struct Gap {
    /** Distance over which the velocity changes: from a face to the wall, or to the other face [spacings]. */
    double length;
    /** To be added to the difference of velocities in the flow, in which those of faces in walls count as zero. */
    double wall;
  };
  /** The difference is that of upper less lower. */
  Gap between(int64_t upper, int64_t lower) const;

  /** Sets velocities [cell][dim] of faces in walls, for points next to walls: extrapolated linearly, with the velocity of the
   *  wall at its surface. Of all cells before and afterwards. Collective. */
  void hold(std::vector<double> &velocity);

  double memory_usage() const { return (level.capacity() + carried.capacity()) * sizeof(double); }

 private:
  const MPMFlowLattice &cells;
  const MPMFlowRegions &regions;
  bigint nbuild = -1;
  // [face] distance of the middle from walls, positive in the flow [spacings]; see velocity()
  std::vector<double> level, carried;
  std::vector<double> known, other, other_known;
};

}    // namespace LAMMPS_NS
#endif

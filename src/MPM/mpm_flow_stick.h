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

/** Regions without slip: where the faces of cells are to the walls, and what moves there. A face whose middle is in a wall has
 *  the velocity of the wall, and between it and a face in the flow the velocity is that of the wall where the wall is. Faces
 *  are numbers cell*dim + axis. */
class MPMFlowStick {
 public:
  MPMFlowStick(const MPMFlowLattice &cells, const MPMFlowRegions &regions) :
      cells(cells), regions(regions)
  {
  }

  /** For the places and velocities that regions have now, which have been found; again: at the start of a run. */
  void find(bool again);
  /** Is the middle of a face in a wall, or nothing of it open? */
  bool is_wall(int64_t face) const { return !(level[face] > 0.0); }
  /** Component of the velocity of the nearest wall, as if it went on to the middle of a face; 0 far from walls. */
  double velocity(int64_t face) const { return carried[face]; }
  /** What a wall in between makes of the difference of the velocities of two faces one spacing apart. */
  struct Gap {
    double
        length;    ///< between what both are: from a face to the wall or to the other face [spacings]
    double
        wall;    ///< to be added to the difference of velocities in the flow, those of walls being zero
  };
  Gap between(int64_t upper, int64_t lower) const;

  /** Velocities [cell][dim] of faces in walls, for points next to these: linear functions, with the velocity of the wall in the
   *  wall. Complete before and afterwards. */
  void hold(std::vector<double> &velocity);

  double memory_usage() const { return (level.capacity() + carried.capacity()) * sizeof(double); }

 private:
  const MPMFlowLattice &cells;
  const MPMFlowRegions &regions;
  bigint nbuild = -1;
  std::vector<double> level,
      carried;    // distance of the middle of faces from walls; see velocity()
  std::vector<double> known, other, other_known;
};

}    // namespace LAMMPS_NS
#endif

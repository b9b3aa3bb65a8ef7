/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_STICK_H
#define LMP_MPM_FLOW_STICK_H

#include "flow/mpm_flow_lattice.h"

#include <vector>

namespace LAMMPS_NS {
class MPMFlowRegions;

/** Regions without slip: what is open of the faces, edges, and cells of viscous stresses, and
 *  velocities of walls there. Faces are numbered cell*dim + axis.
 *
 *  Next to a wall, strains are means over the open part of cells and of boxes around edges, by what
 *  flows through their sides (Gauss). The middle of a face is in one side of these boxes for each
 *  axis along it: area() is the open share of that side. Forces are the transpose, so that a stress
 *  that is the same everywhere has none. */
class MPMFlowStick {
 public:
  MPMFlowStick(const MPMFlowLattice &cells, const MPMFlowRegions &regions) :
      cells(cells), regions(regions)
  {
  }

  /** Finds distances and velocities for the present state of regions, after MPMFlowRegions::find().
   *  again: at the start of a run, even if nothing moves. */
  void find(bool again);
  /** Is the middle of a face in a wall, or the face closed? */
  bool is_wall(int64_t face) const { return !(level[face] > 0.0); }
  /** Does a face have the velocity of the wall? */
  bool holds(int64_t face) const { return masses[face] == 0.0; }
  /** Mass of a face; 1 far from walls. */
  double mass(int64_t face) const { return masses[face]; }
  /** Drag of the wall on a face that no shear stress holds, over its mass and the viscosity. */
  double drag(int64_t face) const { return drags[face]; }
  /** Open share of a face for the shear along another axis; 1 far from walls. */
  double area(int64_t face, int axis) const { return areas[face * cells.lattice.dim + axis]; }
  /** Open share of a cell. */
  double volume_fraction(int64_t cell) const { return volume_fractions[cell]; }
  /** Open share of the box around the lower edge of a cell that is normal to two axes; pair: their
   *  sum less one. */
  double volume_fraction_at_edge(int64_t cell, int pair) const
  {
    return edge_volume_fractions[cell * npair() + pair];
  }
  /** Component at a face of the velocity of the wall that is nearest to such an edge; 0 far from
   *  walls. */
  double velocity_near(int64_t cell, int pair, int64_t face) const;
  /** Component of the velocity of the nearest wall, extended rigidly to the middle of a face; 0 far
   *  from walls. */
  double velocity(int64_t face) const { return carried[face]; }
  /** Effect of a wall between two faces, one spacing apart, on the difference of their
   *  velocities. */
  struct Gap {
    /** Distance over which the velocity changes: from a face to the wall, or to the other face
     *  [spacings]. */
    double length;
    /** To be added to the difference of velocities in the flow, in which those of faces in walls
     *  count as zero. */
    double wall;
  };
  /** The difference is that of upper less lower. */
  Gap between(int64_t upper, int64_t lower) const;

  /** Sets velocities [cell][dim] of faces in walls, for points next to walls: extrapolated
   *  linearly, with the velocity of the wall at its surface. Of all cells before and afterwards.
   *  Collective. */
  void hold(std::vector<double> &velocity);

  double memory_usage() const
  {
    return MPM_NS::bytes_of(nearest, level, carried, masses, drags, areas, volume_fractions,
                            edge_volume_fractions, known, other, other_known);
  }

 private:
  int npair() const { return cells.lattice.dim == 2 ? 1 : 3; }
  double plane_at(int64_t cell, const double *offset, double *slope, int &wall) const;
  void find_face(int64_t face, double open);
  void find_edge(int64_t cell, int c, int d);

  const MPMFlowLattice &cells;
  const MPMFlowRegions &regions;
  bigint nbuild = -1;
  // [face] distance of the middle from walls, positive in the flow [spacings]; see velocity()
  std::vector<double> level, carried;
  // see the functions
  std::vector<double> masses, drags, areas, volume_fractions, edge_volume_fractions;
  std::vector<int> nearest;    // [edge] wall, or -1
  std::vector<double> known, other, other_known;
};

}    // namespace LAMMPS_NS
#endif

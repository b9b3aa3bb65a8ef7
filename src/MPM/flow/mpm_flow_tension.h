/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_FLOW_TENSION_H
#define LMP_MPM_FLOW_TENSION_H

#include "flow/mpm_flow_pressure.h"

#include <cmath>
#include <vector>

namespace LAMMPS_NS {
class MPMFlowRegions;

/** Continues values at the middle of cells, such as smoothed shares of a fluid, into walls so that
 *  their contours meet the walls at a contact angle. The value at the depth d behind a wall with
 *  the normal m (into the flow) is the value at the height d above it, at a place shifted along the
 *  wall by 2 d cot(angle) towards more fluid. This maps planes that meet the wall at the angle to
 *  themselves, and curved surfaces to surfaces with the same curvature, as a mirror image does for
 *  90 degrees. The direction along the wall is that of the slope of the values at the wall.
 *
 *  There is one layer of cells behind walls of the box. In regions, values are set in all cells
 *  next to the flow whose middle is inside. */
class MPMFlowWetting {
 public:
  /** Number of layers of cells that a rank needs around its own cells. */
  static int overlap(bool with_regions) { return with_regions ? 5 : 2; }

  /** cotangent: of the contact angle, measured in the fluid. regions: null if there are none. */
  MPMFlowWetting(const MPMFlowLattice &cells, const MPMFlowRegions *regions, double cotangent) :
      cells(cells), regions(regions), cotangent(cotangent)
  {
  }

  /** Updates the list of cells at walls and in regions to the present positions of these. */
  void find_walls();
  /** Copies values [cell] from their owners to all ranks and continues them behind walls. find:
   *  take the directions along walls from these values; otherwise use the directions found before.
   *  skip_zero: ignore values that are zero. */
  void complete(std::vector<double> &values, bool find, bool skip_zero = false);
  /** Is the middle of this cell inside a region? */
  bool is_behind(int64_t cell) const { return regions && behind[cell]; }

  double memory_usage() const
  {
    return MPM_NS::bytes_of(hidden, at_walls, behind, layers[0], layers[1], next);
  }

 private:
  struct Hidden {            // owned cell whose middle is in a region
    int cell;                // index in the list of cells
    double out[3], depth;    // direction out of the region, and distance to its surface [spacings]
    double along[3];         // direction along the wall towards less fluid, or zero
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

/** Curvature of the free surface of a flow, from the share of each cell that points fill.
 *
 *  The shares are smoothed PASSES times with the weights 1/4, 1/2, 1/4 along each axis, which acts
 *  like a normal distribution with a deviation of sqrt(PASSES/2) spacings and hides steps of the
 *  size of a point. The level sets of a smoothed disk or ball are circles or spheres about the same
 *  center. Their curvature div(n), with the normal n out of the fluid, is that of the surface
 *  between them. A surface wave with the wave number k loses the share k^2 PASSES/4 h^2 of its
 *  curvature. Derivatives are of fourth order. Surfaces meet walls at the contact angle, because
 *  MPMFlowWetting continues the shares into the walls accordingly. */
class MPMFlowTension {
 public:
  static constexpr int PASSES = 4;

  /** angle: contact angle between walls and the surface, measured in the fluid [radians]. */
  MPMFlowTension(const MPMFlowLattice &cells, const MPMFlowPressure &water, double angle);

  /** Stable time step: one over the frequency of the shortest capillary wave (J.U. Brackbill, D.B.
   *  Kothe, C. Zemach, J. Comput. Phys. 100 (1992) 335). tension: surface tension over the density
   *  [length^3/time^2]. */
  static double stable_dt(double tension, double h)
  {
    return std::sqrt(h * h * h / (4.0 * 3.14159265358979323846 * tension));
  }

  /** Finds at_faces [cell][dim] for all cells: the curvature times factor where the surface lies
   *  between the cell and the one before it along an axis. */
  void find(const std::vector<double> &share, double factor, std::vector<double> &at_faces);

  double memory_usage() const
  {
    return wetting.memory_usage() +
        MPM_NS::bytes_of(smooth, other, second[0], second[1], second[2], curvature);
  }

 private:
  const MPMFlowLattice &cells;
  const MPMFlowPressure &water;
  MPMFlowWetting wetting;
  std::vector<double> smooth, other, second[3], curvature;

  void find_smooth(const std::vector<double> &share);
  void find_curvature();
};

}    // namespace LAMMPS_NS
#endif

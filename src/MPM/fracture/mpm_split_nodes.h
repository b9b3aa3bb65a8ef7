/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SPLIT_NODES_H
#define LMP_MPM_SPLIT_NODES_H

#include "fracture/mpm_surface_gaps.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Both sides of the nodes between two surfaces of one field: mass, momentum, and velocity of
 *  each, and the motion of the points next to them. The sums of a side are those of its points
 *  with the kernels of the step, point by point, so that all transfers are the same on sides as
 *  elsewhere. */
class MPMSplitNodes : protected Pointers {
 public:
  MPMSplitNodes(class LAMMPS *, MPMField &);

  std::vector<MPMSurfaceGaps::Node> &list() { return gaps.list; }

  /** Finds the nodes, and mass and momentum of the sides; then their velocities after the
   *  momentum equation, as records of the nodes have them. Nodes must have had the momentum
   *  equation. Returns whether there are any on this rank. Collective. */
  bool find(const MPMSurfaceGaps::Surface &);
  /** Record of a side (0 or 1) of a node in the list: as those of nodes that keep their velocity of
   *  the start of the step. */
  double *record(int k, int side) { return &records[((std::size_t) 2 * k + side) * NREAL]; }
  /** Velocities of the records of nodes at this moment; see follow(). */
  void remember();
  /** Gives both sides what has changed the nodes since remember(); held: bits of the components
   *  that are given to a node, [node], which both sides have then. */
  void follow(const std::vector<char> &held);
  /** Finds new velocities, places, affine matrices, and gradients of the points next to split
   *  nodes, before points move. */
  void find_motion();
  /** Sets them, after points have moved. */
  void set_motion();
  /** Changes of the opening of points, by those of nodes. */
  void open_points(double *opening, double most) const;
  /** Has any of n points from first on a gradient of its own? */
  bool has_points(int first, int n) const;
  /** Sets these gradients, [n][dim*dim], column-major. */
  void set_gradients(int first, int n, double *L) const;

  double memory_usage() const;

 private:
  struct Point {    // next to a split node
    int i, run;
  };

  MPMSurfaceGaps gaps;
  MPMField &field;
  const int dim;
  static constexpr int NREAL = 8;    // of a record of a side
  int nreal = 0;                     // of one of the nodes
  std::vector<double> sums;          // [node][...]
  std::vector<double> records, remembered;
  std::vector<Point> points;     // in the order of blocks
  std::vector<int> rising;       // their indices, by rising i
  std::vector<double> motion;    // [points][...] velocity 3, place 3, affine matrix 9, gradient 9
  static constexpr int MOTION = 24;

  void find_records(const double *opening);
  std::vector<int>::const_iterator first_from(int i) const;
  double *tile_entry(double *tile, int width, const int *base, const int *index) const;
};

}    // namespace LAMMPS_NS
#endif

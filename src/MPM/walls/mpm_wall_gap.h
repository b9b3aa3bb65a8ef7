/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_WALL_GAP_H
#define LMP_MPM_WALL_GAP_H

// Has the surface of the material reached a wall? Nodes see points at a distance of 1 to 2 cells.

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Reference for contact: material that fills the space in front of a plane wall up to its surface,
 *  as seen with a weight function M of the nodes at the wall. x: distance from the wall in node
 *  spacings. */
class MPMContactDistance {
 public:
  MPMContactDistance() = default;
  /** M = sum of weights[k] N_k, where N_k is the function of a node at positions[k] relative to the
   *  wall (node spacings, positive inside the material). */
  MPMContactDistance(const MPMField &, const double *positions, const double *weights, int n);

  /** Largest mean distance (weight M, in node spacings) of the points of material that touches the
   *  wall. size: mean volume of the points, in cells. */
  double distance(double size) const;

 private:
  double volume = 0.0, moment = 0.0;    // integrals of M and of x M over x > 0
  double at_wall = 0.0, slope = 0.0;    // M and its derivative at the wall
  bool sized = false;                   // points have a size
  int dim = 3;
};

/** Signed distance of the position x from something, or the cutoff if that is less. */
using MPMDistanceFrom = std::function<double(const double *x, double cutoff)>;

/** Sums over the points in front of a wall, at the nodes of a field. */
class MPMWallGap {
 public:
  struct Sums {
    double volume = 0.0;      // sum of V N over the points
    double distance = 0.0;    // of V N times the distance from the wall, in node spacings
    double size = 0.0;        // of V N times the volume of the point, in cells

    /** Adds other sums, times a weight. */
    void add(double weight, const Sums &);
    /** Does the material touch the wall, or is its distance from it at most near (node
     *  spacings)? */
    bool touches(const MPMContactDistance &, double near = 0.0) const;
    /** Mean distance of the points that are seen, minus that of material that touches the wall
     *  (node spacings). Not finite if no points are seen. */
    double beyond(const MPMContactDistance &) const;
  };

  /** Finds the sums at the nodes of the blocks [slot] that are marked in near (and may find
   *  others). away: distance of a position from the wall, positive on the side of the material.
   *  It changes by no more than the position. reach: greatest distance that a node of the wall sees
   *  (node spacings). more: distance beyond the range of nodes at the wall up to which distances
   *  are needed (node spacings). Collective. */
  void map(MPMField &, const std::vector<char> &near, double reach, const MPMDistanceFrom &away,
           double more = 0.0);

  /** Distances beyond this one are not needed. */
  static double farthest(const MPMField &, double more = 0.0);

  /** The sums at a node, after map(). */
  Sums at(int64_t node) const;

 private:
  std::vector<double> nodes, values, volumes;
  int nreal = 0;
};

}    // namespace LAMMPS_NS
#endif

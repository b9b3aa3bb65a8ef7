/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_EDGE_H
#define LMP_MPM_REGION_EDGE_H

#include "walls/mpm_region_surface.h"

#include <vector>

namespace LAMMPS_NS {

/** The place nearest to x of a set that is the intersection of parts, where it is on no part alone:
 *  an edge or a corner. The set is an intersection of regions, or the complement of their union,
 *  and x is outside of it.
 *
 *  A local search takes the surfaces of all parts as planes, and the place behind them that is
 *  nearest to x, again and again. Steps become shorter where an edge bends so that they overshoot.
 *
 *  If the parts are convex this is the place. Otherwise it depends on the start, and cells around x
 *  are searched, nearest first. A cell is empty if a part is further from its center than its
 *  corners; the others are halved, and local searches begin in them. Nothing is missed that is
 *  nearer by a twentieth, and thicker than a fiftieth of its distance, unless parts have parts of
 *  their own, with which few cells are searched. */
class MPMRegionEdge {
 public:
  using Place = MPMRegionSurface::Place;
  enum class Answer { NONE, FOUND, UNKNOWN };    ///< UNKNOWN: the search was too long

  /** least: a distance that the place has at least, within which lengths are round-off. */
  MPMRegionEdge(const MPMRegionSurface &, const double *x, double far, double least);

  /** Is there a place nearer than this? */
  Answer find(double nearest, Place &);

 private:
  using Plane = MPMRegionSurface::Plane;
  struct Cell {
    double lower, center[3], half;    // lower: distance of the cell from x
    bool operator<(const Cell &other) const { return lower > other.lower; }
  };
  /** A place from which the next part is looked at: behind the planes of those before. */
  struct View {
    double from[3];
    std::vector<Plane> planes;
  };

  const double *const x;
  const int dim;
  const double far, side;
  double step;    // for differences
  double nearest = 0.0;
  Place edge = {};
  std::vector<const MPMRegionSurface *> order;    // first those that are convex
  int convex;                                     // number of them
  View view;
  std::vector<Plane> planes;    // of all parts
  std::vector<Place> seen;      // of a part

  bool all_convex() const { return convex == (int) order.size(); }
  void view_from(const double *);
  bool is_flat(const MPMRegionSurface &part, const Place &, const double *n) const;
  bool goes_on_flat(const MPMRegionSurface &part, const Place &, const double *n) const;
  bool find_plane(const MPMRegionSurface &part, const double *y, Plane &, double &distance);
  void go_behind(const double *y, const Plane &);
  void go_into(const MPMRegionSurface &part, const double *y, const Plane &);
  bool nearest_behind(const double *to, double *way);
  bool search_from(const double *start);
  bool is_on_edge(const double *y) const;
  double bound(const double *center, double enough);
  double bound_by(int first, const double *center, double enough);
  double bound_by_faces(int k, const double *center, double enough);
  bool is_facing(const double *n, double height) const;
  bool search_cells(double inner, double outer, int &budget);
  double distance_of(const Cell &, bool farthest) const;
};

}    // namespace LAMMPS_NS
#endif

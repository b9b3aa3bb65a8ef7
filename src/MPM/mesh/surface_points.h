/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_POINTS_H
#define MPM_MESH_SURFACE_POINTS_H

// Points of a surface of triangles at which it can touch other surfaces. Nothing here knows about
// LAMMPS.

#include <array>
#include <vector>

namespace MPM_NS {

/** Points on a closed surface of triangles: its corners, and others between them such that no two
 *  neighbors are further apart than a spacing.
 *
 *  Triangles stand for a curved surface where their normals differ by less than 30 degrees. A ball
 *  of triangles would otherwise roll from corner to corner and lose energy at each of them. The
 *  surface at such a corner is a quadric that fits the adjacent corners, which is exact for balls
 *  and cylinders. */
class SurfacePoints {
 public:
  using Point = std::array<double, 3>;

  /** Corners of triangles, which look outward. Corners of adjacent triangles must be equal. */
  SurfacePoints(const std::vector<std::array<Point, 3>> &soup, double spacing);

  std::size_t size() const { return places.size(); }
  const Point &operator[](std::size_t i) const { return places[i]; }

  /** Is it a corner of the triangles? */
  bool is_corner(std::size_t i) const { return corner[i]; }

  /** Calls f(j) for the neighbors j of point i. */
  template <class F> void each_neighbor(std::size_t i, const F &f) const
  {
    for (int k = first[i]; k < first[i + 1]; k++) f((std::size_t) neighbors[k]);
  }

  /** Finds the point of the curved surface near point i that is farthest in a direction [unit
   *  vector]. False: it is point i itself, as the surface has an edge there, or is plane. */
  bool farthest(std::size_t i, const Point &direction, Point &x) const;

  /** Points first to last, all in a ball. */
  struct Cluster {
    int first, last;
    Point center;
    double radius;
  };
  /** The points in clusters of some tens, in this order. */
  const std::vector<Cluster> &clusters() const { return groups; }

 private:
  struct Curved {        // a smooth part of the surface at a corner
    Point normal;        // mean of its triangles
    Point axis[2];       // of the principal curvatures
    double radius[2];    // of curvature, 0: plane or concave
    double reach[2];     // distance of the adjacent corners along the axes
  };
  using Triangle = std::array<int, 3>;

  std::vector<Point> places;
  std::vector<char> corner;
  std::vector<int> first, neighbors;
  std::vector<int> first_curved;    // of the corners, which come first before the points are sorted
  std::vector<Curved> curved;
  std::vector<Cluster> groups;

  std::vector<Triangle> merge(const std::vector<std::array<Point, 3>> &soup);
  void find_curved(const std::vector<Triangle> &);
  bool fit(Curved &, const Point &at, const std::vector<int> &around) const;
  void divide(std::vector<Triangle> &, double spacing);
  void link(const std::vector<Triangle> &);
  void split(std::vector<int> &order, int first, int last);
  void sort();
};

}    // namespace MPM_NS
#endif

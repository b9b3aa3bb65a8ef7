/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_MESH_H
#define MPM_MESH_SURFACE_MESH_H

// Surfaces of triangles, closed or open: signed distance, volume, inertia. Nothing here knows about
// LAMMPS.

#include "mesh/surface_holes.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace MPM_NS {

class WindingNumber;

/** Options for reading a surface. */
struct SurfaceOptions {
  /** Accept surfaces with holes, with triangles that face the wrong way, and of parts that
   *  intersect: see patch_surface(). The inside is where the winding number is above one half. Only
   *  inside() and the properties of the surface as a whole are available then. */
  bool leaky = false;
  /** Accept a surface that has a rim, as of terrain: inside is what is behind its triangles, and
   *  beyond the rim, what is behind the planes of the triangles there. Volume, center, and inertia
   *  are not available then. */
  bool open = false;
  double turn[3][3] = {
      {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};    ///< rotation applied to the positions in the file
};

/** Surface of a body, made of triangles.
 *
 *  Distances come from the closest triangle, found in a tree of boxes, with the sign of the normal
 *  there; at edges and corners that is the mean normal weighted with angles (J.A. Baerentzen, H.
 *  Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243). A coarse grid of distances, made once,
 *  answers most questions without a search: a point is no closer to the surface than the distance
 *  at the center of its cell less its distance from that center. */
class SurfaceMesh {
 public:
  using Point = std::array<double, 3>;

  /** Reads a surface from the bytes of a file, see read_surface(). Positions are turned, multiplied
   *  by scale, and moved by shift. Corners closer than 1e-6 of the size of the body are merged.
   *  Throws std::runtime_error, with name in the message, if the file is invalid, if the surface is
   *  not closed (with open: if neighbors look to different sides), or if its closed parts have no
   *  volume, intersect, or face the wrong way (inward, except for walls of cavities). A surface
   *  that is inside out as a whole is turned. */
  SurfaceMesh(const std::string &bytes, const std::string &name, double scale, const Point &shift,
              const SurfaceOptions &options = SurfaceOptions());
  ~SurfaceMesh();

  /** Distance of x from the surface, negative inside. closest: the closest point of the surface. */
  double distance(const Point &x, Point &closest) const;

  /** As distance() if the surface is nearer than the cutoff. Otherwise the cutoff, negative inside,
   *  and closest is not set. start: a triangle that may be near (-1: none), replaced by the closest
   *  one. It shortens the search and does not change the result. */
  double distance_within(const Point &x, double cutoff, Point &closest, int &start) const;

  /** As distance(), with the outward unit normal along the line through x and the closest point; on
   *  the surface it is the mean normal. If several points are equally close (to 1e-6 of the size of
   *  the body), it is the mean of their directions, so that it has the symmetry of the body and
   *  does not depend on rounding errors. It is zero if that leaves no direction, as at the center
   *  of a ball. */
  double distance_and_normal(const Point &x, Point &normal) const;

  /** Closest point of a part of the surface. */
  struct ClosestPoint {
    Point point;
    double distance;    // negative inside of the body
    int part;
  };

  /** For each part of the surface (see nparts), finds the closest point that is seen from the side
   *  of x, within the cutoff, unless an adjacent point beyond the edge of the part is closer. The
   *  list has no more than most entries and begins with the closest one. Returns their number. */
  int closest_points(const Point &x, double cutoff, ClosestPoint *list, int most) const;

  /** Lower bound of the distance, without a search: positive outside, negative inside; 0:
   *  unknown. */
  double bound(const Point &x) const;

  /** Is x inside of the body or on its surface? */
  bool inside(const Point &x) const;

  Point lo, hi;         ///< box around the body
  bool open = false;    ///< Has the surface a rim? Then the next three are not a number
  double volume;        ///< volume of the body
  Point center;         ///< centroid of the volume
  double inertia[6];    ///< moments of inertia about the center for unit density: xx yy zz xy xz yz
  /** Number of parts between sharp edges, where normals are more than 45 degrees apart */
  int nparts;
  std::size_t size() const { return triangles.size(); }
  std::vector<Point> rim;    ///< centers of the edges at the rim of an open surface
  /** Corners of all triangles, including patches. */
  std::vector<std::array<Point, 3>> soup() const;
  SurfaceHoles holes;    ///< repairs of a leaky surface
  /** Does a leaky surface wind twice, or backward, around some places? Its volume counts them
   *  so. */
  bool overlaps = false;

 private:
  struct Triangle {
    std::array<int, 3> corner;
    Point normal;            // unit
    Point edge_normal[3];    // of the edges 01, 12, 20: sum of the two triangles' normals
    int part;
  };
  struct Shell {    // a closed part of the surface
    Point lo, hi;
    double volume = 0.0, area = 0.0;    // volume: negative when it looks inward
    std::vector<int> triangles;
  };
  struct Node {    // node of the tree of boxes
    Point lo, hi;
    int first, last;    // triangles of a leaf; otherwise last < 0 and the children are used
    int child[2];
    int part;    // part of all triangles in it; -1: of several
  };

  std::vector<Point> corners, corner_normals;
  std::vector<Triangle> triangles;
  std::vector<int> shell_of;    // the closed part that a part between sharp edges belongs to
  std::vector<std::vector<int>> around;    // triangles at each corner
  std::vector<Node> tree;
  std::unique_ptr<WindingNumber> winding;    // of a leaky surface, else null
  std::vector<float> coarse;                 // distances at the centers of cells
  int ncells[3];
  double cell;
  double near;    // points closer than this are merged

  void weld(const std::vector<Point> &soup, const std::string &name);
  void check_edges(const std::string &name, bool may_be_open);
  void patch();
  void find_winding(const std::string &name);
  void integrate();
  void normals();
  void find_parts();
  int build(int first, int last);
  void make_coarse();
  std::vector<Shell> find_shells() const;
  void check_shells(const std::string &name) const;
  bool is_inside(const Shell &, const Shell &other, const std::string &name) const;
  std::array<Point, 3> places(const Triangle &) const;
  Point closest_on(const Triangle &, const Point &x, int &feature) const;
  template <class Skip, class Visit>
  void search(const Point &x, double &limit, Skip &&skip, Visit &&visit) const;
  template <class Skip>
  double distance_to(const Point &x, double limit, Point &closest, Skip &&skip) const;
  int coarse_cell(const Point &x, Point &center) const;
  double most(const Point &x) const;
  const Point &mean_normal(const Triangle &t, int feature) const;
  bool is_closest_around(const Point &x, const Triangle &t, int feature, double square) const;
};

}    // namespace MPM_NS
#endif

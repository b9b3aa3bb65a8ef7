/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_SURFACE_H
#define LMP_MPM_REGION_SURFACE_H

#include "region.h"

#include <array>
#include <memory>
#include <vector>

namespace MPM_NS {
class SurfaceCells;
}

namespace LAMMPS_NS {
class RegMPMMesh;
class Region;

/** The surface of a region in its present state: signed distances and normals. */
class MPMRegionSurface {
  friend class MPMRegionEdge;    // asks parts

 public:
  /** The region must have been initialized for the run. */
  MPMRegionSurface(Region *, int dim);

  /** Has the region, or a part of it, open faces? Then all of space counts as inside. */
  bool is_open() const;

  /** Signed distance of x, negative in the region. Returns far or -far if it is greater. */
  double distance(const double *x, double far) const { return find(x, far, true); }

  /** Distances and normals of a mesh come from SurfaceCells of this size from now on, where these
   *  know them. This is much faster, and wrong by at most 0.01 of the size. The same for
   *  distance_in_cells() of a region that is made of others and does not move. */
  void use_cells(double size);

  /** The same as distance(), but it may be that of cells. */
  double distance_in_cells(const double *x, double far) const;

  /** Is x in the region, or on its surface? It agrees with the sign of the distance. */
  bool has(const double *x) const;

  /** Unit normal out of the region, the gradient of the distance. If necessary, it is found from
   *  differences with this step (one-sided where the distance is not known). Zero at centers and
   *  where it is not known. */
  void normal(const double *x, double far, double step, double *normal) const;

  /** The simple region, or intersection, that is nearest to a place outside of unions. */
  const Region &part_near(const double *x, double far) const;

 private:
  struct Place {    // on the surface
    double x[3], distance;
  };

  struct Plane {
    double n[3], height;    // outward normal, height of a place above it
  };

  Region *region;
  RegMPMMesh *mesh;
  int dim;
  bool is_cone, has_axis, is_union, is_body,
      is_plane;                             // convex, or the outside of that; with plane faces
  MPM_NS::SurfaceCells *cells = nullptr;    // of the mesh, if they are in use
  std::shared_ptr<MPM_NS::SurfaceCells> cells_of_all;    // parts
  // of a cylinder or cone: are its surfaces with normals along the axes x, y, z flat?
  mutable std::array<int, 3> flat = {-1, -1, -1};    // -1: not known yet
  std::vector<int> left_out;    // ends of a cone that are left out, one after the other; -1: none
  std::vector<MPMRegionSurface> parts;    // of unions and intersections
  mutable std::vector<Place> places;

  static double size_of(const double *x);    // for round-off
  /** Length that steps near x are made of: a distance, unless it is close to round-off. */
  static double scale_at(const double *x, double distance);
  /** Is the region a convex body, or the outside of one? */
  bool is_convex(bool inside) const { return is_body && (region->interior != 0) == inside; }
  bool match(const double *x) const;
  double find(const double *x, double far, bool in_cells) const;
  bool find_in_cells(const double *x, double far, double &distance, double *gradient) const;
  bool find_normal_at_once(const double *x, double far, double step, double *normal) const;
  void find_sharp_end();
  void find_places(const double *x, double far) const;
  void find_places_of_parts(const double *x, double far) const;
  bool faces(const MPMRegionSurface &part, const Place &, double far) const;
  template <class F> void each_contact(const double *x, double far, bool inside, const F &f) const;
};

/** Present position of a region that moves. It gives access to protected members of Region. */
struct MPMRegionMotion : public Region {
  /** Center and unit axis of the rotation of a region. */
  static const double *point_of(const Region *r) { return r->*(&MPMRegionMotion::point); }
  static const double *axis_of(const Region *r) { return r->*(&MPMRegionMotion::runit); }

  /** Pointers to the shift and the angle of a region, as restart files keep them. */
  static std::array<double *, 4> of(Region *r) { return {&r->dx, &r->dy, &r->dz, &r->theta}; }
};

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_REGION_SURFACE_H
#define LMP_MPM_REGION_SURFACE_H

#include <vector>

namespace LAMMPS_NS {
class Region;
class RegMPMMesh;

/** The surface of a region, in the state that the region has when it is asked: distances, and the normal. */
class MPMRegionSurface {
 public:
  /** The region must have been initialized for the run. */
  MPMRegionSurface(Region *, int dim);

  /** Has the region, or a part of it, open faces? Then all of space counts as inside. */
  bool is_open() const;

  /** Signed distance of x, negative in the region; far or -far where it is more, or not known. It is known but in a union
   *  and outside of an intersection, where the nearest surface can be an edge between two parts. */
  double distance(const double *x, double far) const { return find(x, far, 0.0); }

  /** The same for material in front of the surface, where it need not be known as exactly: with errors of
   *  less than 0.03 h^2/R of a surface of radius R beyond a node spacing h. A mesh is much faster then. */
  double gap(const double *x, double far, double h) const { return find(x, far, h); }

  /** Direction out of the region: gradient of the distance, where need be from differences with this step (one-sided
   *  where the distance is not known). Zero at centers and where it is not known. */
  void normal(const double *x, double far, double step, double *normal) const;

  /** The simple region, or intersection, that is nearest to a place outside of unions. */
  const Region &part_near(const double *x, double far) const;

 private:
  struct Place {    // on the surface
    double x[3], distance;
  };

  Region *region;
  RegMPMMesh *mesh;
  int dim;
  bool is_cone, is_union;
  std::vector<int> left_out;              // ends of a cone, one after the other; -1: none
  std::vector<MPMRegionSurface> parts;    // of unions and intersections
  mutable std::vector<Place> places;

  bool match(const double *x) const;
  double find(const double *x, double far, double h) const;
  bool find_normal_at_once(const double *x, double far, double step, double *normal) const;
  void find_sharp_end();
  void find_places(const double *x, double far) const;
  void find_places_of_parts(const double *x, double far) const;
  template <class F> void each_contact(const double *x, double far, bool inside, const F &f) const;
};

}    // namespace LAMMPS_NS
#endif

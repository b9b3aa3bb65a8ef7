/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef REGION_CLASS
// clang-format off
RegionStyle(mpm/mesh,RegMPMMesh);
// clang-format on
#else

#ifndef LMP_REGION_MPM_MESH_H
#define LMP_REGION_MPM_MESH_H

#include "declare/option.h"
#include "mesh/surface_cells.h"
#include "region.h"

#include <map>
#include <memory>

namespace LAMMPS_NS {

/** Keywords of region mpm/mesh, besides those of all regions. */
struct MPMRegionMeshOptions {
  enum { CLOSED, OPEN, LEAKY };
  int surface = CLOSED;
  double angle = 0.0, axis[3] = {0.0, 0.0, 0.0};

  MPM_NS::Options declare();
};

/** The body inside of, or behind, a surface of triangles from an STL or OBJ file. */
class RegMPMMesh : public Region {
 public:
  RegMPMMesh(class LAMMPS *, int, char **);
  ~RegMPMMesh() override;
  void init() override;
  int inside(double, double, double) override;
  int surface_interior(double *x, double cutoff) override { return touch(x, cutoff, -1.0); }
  int surface_exterior(double *x, double cutoff) override { return touch(x, cutoff, 1.0); }

  /** The surface after scale, shift, and turn, but without the motion of the region. */
  const MPM_NS::SurfaceMesh &surface_mesh() const { return *mesh; }

  /** Stops with an error if the surface is leaky, because only inside() is known then. */
  void need_distance() const;

  /** Stops with an error if the surface is open, because there is no body then. */
  void need_body() const;

  /** Signed distance of x from the present surface of the region, negative in the region; the
   *  cutoff or minus the cutoff if it is greater. along_z: distance along z of the closest point
   *  from x. The result agrees with match() and surface(), but takes a fraction of their time if
   *  places near each other are asked for one after the other. */
  double distance(const double *x, double cutoff, double &along_z);

  /** Cells of distances with this size, in the coordinates of the mesh. */
  MPM_NS::SurfaceCells &cells_of_size(double size);

  /** Distance of x as these cells have it, at most the cutoff, and its gradient. Returns false if
   *  they do not know it. */
  bool distance_in_cells(MPM_NS::SurfaceCells &, const double *x, double cutoff, double &distance,
                         double *gradient);

 private:
  std::unique_ptr<MPM_NS::SurfaceMesh> mesh;
  bool leaky = false;
  bool warned = false;     // that it ends in the box
  bool placing = false;    // inside() only stores its argument, in the coordinates of the mesh
  double place[3];
  int last_closest = -1;    // index of a triangle, see SurfaceMesh::distance_within()
  std::map<double, MPM_NS::SurfaceCells> cells;    // by their size

  void report(const char *file) const;
  void find_place(const double *x);

  int touch(const double *x, double cutoff, double side);
};

}    // namespace LAMMPS_NS
#endif
#endif

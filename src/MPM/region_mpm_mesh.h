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
#include "region.h"

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>

namespace MPM_NS {
class SurfaceMesh;
}

namespace LAMMPS_NS {

/** Keywords of region mpm/mesh, besides those of all regions. */
struct MPMRegionMeshOptions {
  bool leaky = false;
  double angle = 0.0, axis[3] = {0.0, 0.0, 0.0};

  MPM_NS::Options declare();
};

/** The body inside of a surface of triangles from an STL or OBJ file. */
class RegMPMMesh : public Region {
 public:
  RegMPMMesh(class LAMMPS *, int, char **);
  ~RegMPMMesh() override;
  int inside(double, double, double) override;
  int surface_interior(double *x, double cutoff) override { return touch(x, cutoff, -1.0); }
  int surface_exterior(double *x, double cutoff) override { return touch(x, cutoff, 1.0); }

  const MPM_NS::SurfaceMesh &surface_mesh() const { return *mesh; }

  /** Stops with an error if the surface is leaky: only inside() is known then. */
  void need_distance() const;

  /** Signed distance of x from the surface where the region is now, negative in the region; the cutoff or minus the
   *  cutoff farther away. along_z: how far the closest point is from x along z. It is what match() and surface() tell,
   *  for a fraction of their time when places near each other are asked for one after the other. */
  double distance(const double *x, double cutoff, double &along_z);

  /** As distance() for places nearer to the surface than exact, linear in cells of this size farther away: then a search
   *  is needed once for each cell, and not for each place. The value does not depend on what was asked before.
   *  False where the closest point is along z of x (2d: another one of the section is meant). */
  bool distance_by_cells(const double *x, double cutoff, double exact, double size,
                         double &distance);

 private:
  struct Linear {    // distance in a cell: value at its center, and gradient
    double value, gradient[3];
  };
  using Cells = std::unordered_map<uint64_t, Linear>;    // keys: see distance_by_cells()
  std::unique_ptr<MPM_NS::SurfaceMesh> mesh;
  bool leaky = false;
  bool placing = false;    // inside() is called only for its place, in the coordinates of the mesh
  double place[3];
  int last_closest = -1;            // triangle, see SurfaceMesh::distance_within()
  std::map<double, Cells> cells;    // by their size

  void report(const char *file) const;
  void find_place(const double *x);

  int touch(const double *x, double cutoff, double side);
};

}    // namespace LAMMPS_NS
#endif
#endif

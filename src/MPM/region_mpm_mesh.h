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

#include "region.h"

#include <memory>

namespace MPM_NS {
class SurfaceMesh;
}

namespace LAMMPS_NS {

/** The body inside of a closed surface of triangles from an STL file. */
class RegMPMMesh : public Region {
 public:
  RegMPMMesh(class LAMMPS *, int, char **);
  ~RegMPMMesh() override;
  int inside(double, double, double) override;
  int surface_interior(double *x, double cutoff) override { return touch(x, cutoff, -1.0); }
  int surface_exterior(double *x, double cutoff) override { return touch(x, cutoff, 1.0); }

  const MPM_NS::SurfaceMesh &surface_mesh() const { return *mesh; }

  int most_touches;    ///< that surface() looks for: tmax, or 1 for the closest point alone

 private:
  std::unique_ptr<MPM_NS::SurfaceMesh> mesh;

  int touch(const double *x, double cutoff, double side);
};

}    // namespace LAMMPS_NS
#endif
#endif

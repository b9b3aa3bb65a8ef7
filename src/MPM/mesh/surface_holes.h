/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_HOLES_H
#define MPM_MESH_SURFACE_HOLES_H

// Surfaces of triangles that are not quite closed: what is wrong with them, and patches on their
// holes. Nothing here knows about LAMMPS.

#include <array>
#include <cstddef>
#include <vector>

namespace MPM_NS {

/** Result of patch_surface(). */
struct SurfaceHoles {
  std::size_t edges = 0;         ///< number of edges of holes
  std::size_t holes = 0;         ///< number of holes, that is of connected groups of edges
  double widest = 0.0;           ///< diagonal of the box around the largest hole
  std::array<double, 3> at{};    ///< center of that box
  double area = 0.0;             ///< area of the patches relative to the area of the surface before
  std::size_t turned = 0;        ///< number of triangles that faced the wrong way
  std::size_t repeated = 0;      ///< number of repeated triangles
  bool none() const { return edges + turned + repeated == 0; }
};

/** Closes a surface: along each edge, as many triangles run forward as backward afterward, so that
 *  its winding number is an integer everywhere. Repeated triangles are removed. Triangles that face
 *  another side than their neighbors are turned; among connected triangles, the side with the
 *  larger area decides. The edges of a hole are joined to its center. triangles: indices of
 *  corners. Patches and their centers are appended. */
SurfaceHoles patch_surface(std::vector<std::array<double, 3>> &corners,
                           std::vector<std::array<int, 3>> &triangles);

}    // namespace MPM_NS
#endif

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

/** What patch_surface() found and did. */
struct SurfaceHoles {
  std::size_t edges = 0;         ///< edges of holes
  std::size_t holes = 0;         ///< of edges that hang together
  double widest = 0.0;           ///< diagonal of the box around the largest one
  std::array<double, 3> at{};    ///< center of that
  double area = 0.0;             ///< of the patches, as a share of the area of the surface before
  std::size_t turned = 0;        ///< triangles that looked the wrong way
  std::size_t repeated = 0;      ///< triangles that were there twice
  bool none() const { return edges + turned + repeated == 0; }
};

/** Makes a surface one without boundary, that is, one along each of whose edges as many triangles run
 *  forward as backward, so that its winding number is an integer everywhere: triangles that are there twice go;
 *  those that look to another side than their neighbors are turned, the larger area of those that hang together
 *  decides; the edges of a hole are joined to its center. triangles: numbers of corners, patches and their
 *  centers are appended. */
SurfaceHoles patch_surface(std::vector<std::array<double, 3>> &corners,
                           std::vector<std::array<int, 3>> &triangles);

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_FILE_H
#define MPM_MESH_SURFACE_FILE_H

// Files with surfaces of triangles: STL and OBJ. Nothing here knows about LAMMPS.

#include <array>
#include <string>
#include <vector>

namespace MPM_NS {

/** Corners of the triangles in the bytes of a file, three in a row, as they are in the file. A name
 *  that ends in .obj, in whatever case, is that of a Wavefront OBJ file, of which vertices and faces are read;
 *  its polygons must be convex and become triangles. Any other one is that of an STL file, text or binary.
 *  Throws std::runtime_error, with the name in the message, for a file that is not of this kind, is cut short, or
 *  has numbers that are none or not finite. */
std::vector<std::array<double, 3>> read_surface(const std::string &bytes, const std::string &name);

}    // namespace MPM_NS
#endif

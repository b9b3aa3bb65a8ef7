/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SURFACE_FILE_H
#define MPM_MESH_SURFACE_FILE_H

// Files with surfaces of triangles: STL, OBJ, and terrains. Nothing here knows about LAMMPS.

#include <array>
#include <string>
#include <vector>

namespace MPM_NS {

/** Reads the corners of triangles, three in a row for each, in the order of the file, from the
 *  bytes of the file. If the name ends in .obj, in upper or lower case, it is a Wavefront OBJ file,
 *  of which vertices and faces are read; its polygons must be convex and are divided into
 *  triangles. Heights become triangles, see read_terrain(). Any other file is an STL file, text or
 *  binary. Throws std::runtime_error, with the name in the message, if the file is not of this
 *  kind, is truncated, or contains invalid or infinite numbers. */
std::vector<std::array<double, 3>> read_surface(const std::string &bytes, const std::string &name);

/** The text in lower case. */
std::string lower_case(std::string text);

}    // namespace MPM_NS
#endif

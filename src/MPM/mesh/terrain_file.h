/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_TERRAIN_FILE_H
#define MPM_MESH_TERRAIN_FILE_H

// Files with heights over a plane: ESRI ASCII grids and columns of x, y, z. Nothing here knows
// about LAMMPS.

#include <array>
#include <string>
#include <vector>

namespace MPM_NS {

/** Does a file with this name have heights? Its name ends in .asc or .xyz, in any case. */
bool is_terrain(const std::string &name);

/** Reads heights, and returns the corners of triangles between them, three in a row for each,
 *  counterclockwise as seen from above. Heights of an .asc file belong to the middles of the cells
 *  of the raster, or to the places that its head gives as centers; those of an .xyz file have one
 *  line each and must be at the crossings of columns and rows. There are no triangles where heights
 *  are missing: NODATA_value or nan in an .asc file, places without a line in an .xyz file. A
 *  quadrangle is divided along the diagonal whose ends differ less in height. Throws
 *  std::runtime_error, with the name in the message, if the file is not of this kind or is
 *  incomplete. */
std::vector<std::array<double, 3>> read_terrain(const std::string &bytes, const std::string &name);

}    // namespace MPM_NS
#endif

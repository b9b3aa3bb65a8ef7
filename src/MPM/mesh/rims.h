/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_RIMS_H
#define MPM_MESH_RIMS_H

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

// Where triangles, or lines, of a surface meet. Nothing here knows about LAMMPS.

namespace MPM_NS {
struct Mesh;

/** Two nodes of triangles, or one of lines, twice; the elements that are there, and which of their nodes is across from it (of lines: at it). */
using Rims = std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, int>>>;

/** Throws std::runtime_error where there are other elements, or more than two at a rim. */
Rims find_rims(const Mesh &);

/** Append an EDGE for two triangles that meet, nodes as in SharedStrain, and a CORNER for two lines, nodes along these. */
void add_edges(Mesh &, const Rims &);

}    // namespace MPM_NS
#endif

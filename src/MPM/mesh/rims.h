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

// Rims at which triangles, or lines, of a surface meet. Nothing here knows about LAMMPS.

namespace MPM_NS {
struct Mesh;

/** Maps the two nodes of an edge of triangles, or twice the end node of lines, to the elements
 *  there: the index of each element, and which of its nodes is opposite to the edge (lines: which
 *  node is at it). */
using Rims = std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, int>>>;

/** Finds all rims of a surface. Throws std::runtime_error if there are other elements than
 *  triangles or lines, or more than two elements at a rim. */
Rims find_rims(const Mesh &);

/** Appends an EDGE for each pair of triangles that meet, with nodes as in SharedStrain, and a
 *  CORNER for each pair of lines, with nodes in order along the lines. */
void add_edges(Mesh &, const Rims &);

}    // namespace MPM_NS
#endif

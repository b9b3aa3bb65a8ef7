/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_CURVED_SURFACE_H
#define MPM_MESH_CURVED_SURFACE_H

#include <functional>
#include <vector>

// A surface that is curved between the nodes of its triangles (in 2d: lines) according to the
// angles at their edges. Nothing here knows about LAMMPS.

namespace MPM_NS {
struct Mesh;

/** Volume between the triangles of an edge and the surface of second order with the angle of the
 *  edge. Nodes as in SharedStrain (in 2d: 0 1 2 along the lines). The curvature k across the edge
 *  is the angle over a third of the sum of the heights. A triangle of area A and height H has the
 *  share k A H^2/12 of the volume (a line of length l: k l^3/24), which is exact to second order
 *  for cylinders of squares and for spheres of equal triangles. Sharp edges have no such volume:
 *  the angle has a factor that is 0 above 60 degrees. The volume is positive where the surface is
 *  convex on the side from which the nodes of elements go around counterclockwise (in 2d: on the
 *  right of lines). Adds factor times the gradient to gradient, unless it is null. */
double curved_volume(int dim, const double (*x)[3], double factor, double (*gradient)[3]);

/** Ratio of the area of the curved surface to the area of the element, for each triangle or line of
 *  a Mesh with edges (mesh/rims.h). to(a, b, d) sets d to the vector from node a to node b. */
std::vector<double> curved_areas(int dim, const Mesh &,
                                 const std::function<void(int, int, double *)> &to);

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_ELEMENT_H
#define MPM_MESH_ELEMENT_H

// Linear finite elements: shape functions and their integration points. Nothing here knows about
// LAMMPS.

#include "mesh/gmsh.h"

namespace MPM_NS {

constexpr int MAX_ELEMENT_NODES = 8, MAX_ELEMENT_POINTS = 8;

/** Corners of a square and a cube in the order of Gmsh. */
constexpr int CUBE_CORNER[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
/** Shape functions of a square or cube and their derivatives at xi, from -1 to 1 along each
 *  axis. */
void cube_functions(int dim, const double *xi, double *N, double (*dN)[3]);

/** Gauss points of an element in its own coordinates: one for lines, triangles, and tetrahedra, 2x2
 *  and 2x2x2 for quadrangles and hexahedra (full integration). */
struct ElementRule {
  int nnode, npoint, dim;
  double weight[MAX_ELEMENT_POINTS];
  double N[MAX_ELEMENT_POINTS][MAX_ELEMENT_NODES];        ///< shape functions at the points
  double dN[MAX_ELEMENT_POINTS][MAX_ELEMENT_NODES][3];    ///< their derivatives

  /** Gradients g[nnode][3] of the shape functions at point q with respect to the positions
   *  x[nnode][3] of the nodes. Returns the weight of the point as area or volume, negative for an
   *  inverted element. */
  double gradients(int q, const double (*x)[3], double (*g)[3]) const;

  /** The same for a surface or a line in space (a line also in the plane): gradients along it;
   *  returns area or length. */
  double gradients_along(int q, const double (*x)[3], double (*g)[3]) const;

  /** Largest eigenvalue of the sum over the nodes of g x g, with the gradients g[nnode][3]. */
  double largest_eigenvalue(const double (*g)[3]) const;

  /** The rule of an element type. */
  static const ElementRule &of(ElementType);
};

}    // namespace MPM_NS
#endif

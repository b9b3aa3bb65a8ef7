/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_BENDING_H
#define MPM_MESH_BENDING_H

// Bending of surfaces of triangles and of lines, by the positions of their nodes alone. Nothing here knows about LAMMPS.

namespace MPM_NS {

/** Curvature of a triangle by those next to it: the change of the normal along each axis is the mean, over the edges, of what the triangles
 *  on the other side have, unfolded to the plane of this one (basic shell triangle: E. Onate, F. Zarate, Int. J. Numer. Methods Eng. 47
 *  (2000) 557). With coefficients h_k it is b = n . sum_k h_k x_k, where n is the present normal, which is zero for a plane, and does not
 *  change by rotations. Nodes are 0 1 2 of the triangle, and 3 4 5 of its neighbors across the edges opposite to these; an edge
 *  without a neighbor is free, and node 0 takes the place of its node. */
struct BentTriangle {
  double h
      [6]
      [3];    ///< coefficients of curvatures xx, yy, xy along axes in the plane of the triangle [1/length^2]
  double rest[3];    ///< curvatures without moment
  double area;

  /** From the positions without moment; has: is there a neighbor across the edge opposite to node k? */
  void define(const double (*X)[3], const bool *has);

  /** Energy of bending of a plate with stiffness D and Poisson's ratio nu; adds forces on the nodes to f[6]. */
  double bend(double D, double nu, const double (*x)[3], double (*f)[3]) const;

  /** Bounds of the sums, for each node, of the absolute second derivatives of the energy, without moment and for D = 1. */
  void stiffness_sums(double nu, double *sum) const;
};

/** Bending of two lines that meet: the angle between them, over their mean length (M. Bergou et al., ACM Trans. Graph. 27 (2008)
 *  63, with angles in the place of their tangents). Nodes are 0 1 2 along the line. In the plane the angle has a sign. */
struct BentLine {
  double rest;         ///< angle without moment
  double length[2];    ///< of both lines, without moment

  void define(int dim, const double (*X)[3]);
  /** As above, with the stiffness D [force length^2]. */
  double bend(double D, int dim, const double (*x)[3], double (*f)[3]) const;
  void stiffness_sums(double *sum) const;

 private:
  double mean() const { return 0.5 * (length[0] + length[1]); }
};

}    // namespace MPM_NS
#endif

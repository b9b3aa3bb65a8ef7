/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MESH_SHARED_STRAIN_H
#define MPM_MESH_SHARED_STRAIN_H

// Strains along a surface that triangles share at their edges. Nothing here knows about LAMMPS.

namespace MPM_NS {

/** Correction of the energy of two triangles of constant strain that share the mean of their
 *  strains at their common edge.
 *
 *  In a third of each triangle, the strain is the mean of both strains, which belongs to the edge
 *  (G.R. Liu, T. Nguyen-Thoi, K.Y. Lam, J. Sound Vib. 320 (2009) 1100). This removes a third of V1
 *  V2/(V1 + V2) times the energy of the difference of their strains. Only the fraction PART of that
 *  is removed here, so that the rest is positive also where the material is softer than at rest.
 *  Strains are Green strains in axes of the edge, with the second triangle unfolded to the plane of
 *  the first one, so that rotations, and folds along the edge, cause no strain. The correction
 *  fades to zero as strains approach SMALL. Nodes 0 and 1 are at the edge; node 2 belongs to the
 *  triangle with the edge from 0 to 1, and node 3 to the triangle with the edge from 1 to 0. */
struct SharedStrain {
  static constexpr double PART = 0.7, SMALL = 0.05;
  /** Gradients of the shape functions of both triangles: nodes 0 1 2 and 1 0 3 */
  double g[2][3][2];
  /** PART of a third of A1 A2/(A1 + A2); 0: the triangles do not form one smooth surface */
  double weight;

  /** Sets gradients and weight from the positions X[4] in the reference configuration. */
  void define(const double (*X)[3]);

  /** Energy of the correction, which is never positive, for a sheet with the stiffness K = E t/(1 -
   *  nu^2) and Poisson's ratio nu at the positions x[4]. Adds the forces on the nodes to f[4]. */
  double energy(double K, double nu, const double (*x)[3], double (*f)[3]) const;
};

}    // namespace MPM_NS
#endif

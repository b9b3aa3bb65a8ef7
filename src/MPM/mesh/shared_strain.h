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

/** Two triangles of constant strain take, in a third of each, the mean of their strains, which belongs to their common edge (G.R. Liu,
 *  T. Nguyen-Thoi, K.Y. Lam, J. Sound Vib. 320 (2009) 1100): of their energy, a third of V1 V2/(V1 + V2) times that of the difference of their strains goes, of
 *  which this takes PART, so that what is left is positive also where the material is softer than at rest. Strains are those of Green in axes of the
 *  edge, with the second triangle unfolded to the plane of the first one, so that rotations, and folds along the edge, are no strains. For
 *  strains toward SMALL this ends. Nodes are 0 and 1 of the edge, 2 of the triangle with the edge from 0 to 1, and 3 of that with the
 *  edge from 1 to 0. */
struct SharedStrain {
  static constexpr double PART = 0.7, SMALL = 0.05;
  double g[2][3][2];    ///< gradients of the functions of both triangles: nodes 0 1 2 and 1 0 3
  double weight;    ///< PART of a third of A1 A2/(A1 + A2); 0: they are not of one smooth surface

  /** From the positions in the reference configuration. */
  void define(const double (*X)[3]);

  /** Energy, which is not positive, of a sheet with the stiffness K = E t/(1 - nu^2) and Poisson's ratio nu; adds forces on the nodes to f[4]. */
  double energy(double K, double nu, const double (*x)[3], double (*f)[3]) const;
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINTS_H
#define LMP_MPM_POINTS_H

#include "math/matrix.h"

namespace LAMMPS_NS {
class Atom;

/** Per-point state owned by atom style mpm, one instance for each Atom object.
 *
 *  The arrays live in a block that no AtomVec owns, because a hybrid style and a repeated
 *  atom_style command free arrays through the addresses given to Atom::add_peratom().
 *  Initial volume is atom->vfrac (0: the atom is not a material point), mass is atom->rmass.
 */
struct MPMPoints {
  double **F = nullptr;      ///< [n][9] deformation gradient, row-major (must stay first)
  double **tau = nullptr;    ///< [n][6] Kirchhoff stress J sigma, tension > 0, xx yy zz xy xz yz

  /** Volume over initial volume, J = det F. */
  double jacobian(int i) const { return det(F[i]); }

  /** The Cauchy stress, which is what laws and users see. */
  void cauchy(int i, double sigma[6]) const
  {
    const double J = jacobian(i);
    for (int c = 0; c < 6; c++) sigma[c] = tau[i][c] / J;
  }

  static double det(const double *F) { return MPM_NS::determinant(F); }

  /** State of the points of this Atom object; with create = true it is made when absent. */
  static MPMPoints *get(Atom *atom, bool create = false);
};
}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_POINTS_H
#define LMP_MPM_POINTS_H

#include "atom.h"
#include "base/mpm_rows.h"
#include "math/matrix.h"

#include <algorithm>
#include <vector>

namespace LAMMPS_NS {
class Atom;
class Memory;

/** Per-point state owned by atom style mpm, one instance for each Atom object.
 *
 *  The arrays live in a block that no AtomVec owns, so that each Atom object finds its own through
 *  an entry of Atom::add_peratom(). AtomVec would add a table of rows to each of them; atom style
 *  mpm grows them instead. The initial volume is atom->vfrac (0: the atom is not a material point),
 *  the mass is atom->rmass. */
struct MPMPoints {
  static constexpr int size = 9 + 6;    ///< reals of a point
  MPMRows F;                            ///< [n][9] deformation gradient, row-major
  MPMRows tau;    ///< [n][6] Kirchhoff stress J sigma, tension > 0, xx yy zz xy xz yz

  /** A body that a region has made round. */
  struct Round {
    double radius = 0.0;       ///< half of its least width; zero: it is not round
    bool has_steps = false;    ///< do whole points of a lattice make its surface?
  };
  std::vector<Round> round;    ///< [type]; empty: none. Not in restart files

  /** Volume over initial volume, J = det F. */
  double jacobian(int i) const { return det(F[i]); }

  /** The Cauchy stress, which material laws and users see. */
  void cauchy(int i, double sigma[6]) const
  {
    const double J = jacobian(i);
    for (int c = 0; c < 6; c++) sigma[c] = tau[i][c] / J;
  }

  /** Allocates rows for nmax atoms; nmax = 0 frees the memory. */
  void grow(Memory *, int nmax);

  /** Sets the state to no strain and no stress. */
  void reset(int i)
  {
    for (int k = 0; k < 9; k++) F[i][k] = k % 4 == 0 ? 1.0 : 0.0;
    for (int c = 0; c < 6; c++) tau[i][c] = 0.0;
  }

  /** Determinant of a row of F. */
  static double det(const double *F) { return MPM_NS::determinant(F); }

  /** State of the points of this Atom object, or null if there is none; create = true creates it if
   *  it is absent. */
  static MPMPoints *get(Atom *atom, bool create = false);
};

/** Gives a list room for all points, with zeros for those of this rank and its ghosts. LAMMPS has
 *  room for 16384 points or more: to clear all of it would take a fifth of the step of a small
 *  body. */
inline void clear_points(std::vector<double> &list, const Atom *atom, int width = 1)
{
  const std::size_t w = width;
  list.resize(w * atom->nmax);
  std::fill_n(list.begin(), w * (atom->nlocal + atom->nghost), 0.0);
}

}    // namespace LAMMPS_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_AFFINE_H
#define LMP_MPM_AFFINE_H

#include "base/mpm_rows.h"
#include "field/mpm_field.h"
#include "transfer/kernels.h"

namespace LAMMPS_NS {

/** Affine velocity matrices of the points (transfers apic, aflip, tpic, polypic). */
class MPMAffine : protected Pointers {
 public:
  MPMRows C;    ///< [n][dim*dim] column-major: C[dim*j+i] = d v_i / d x_j
  /** [n][poly_size(dim)] bilinear modes of the velocity; null: the transfer has none. */
  MPMRows Q;
  MPM_NS::PolyKernels modes;    ///< transfers of Q

  /** Between runs, and in restart files: the velocities that the matrices belong to. */
  struct Velocities {
    uint64_t hash, known;    // without padding, as this is written to restart files
  } velocities = {0, 0};

  /** Declares the arrays of points in the state. */
  MPMAffine(class LAMMPS *, MPMField &, MPMPointState &);

  /** The matrices of all points, [n][size()], as kernels read them. */
  double *rows() const { return &C[0][0]; }
  /** Number of reals of a matrix. */
  int size() const { return field.lattice.dim * field.lattice.dim; }

  /** Note the velocities that the matrices belong to: at the end of a run, and for restart
   *  files. */
  void remember_velocities() { velocities = {velocity_hash(), 1}; }
  /** Start of a run: forget the matrices if velocities have changed since. */
  void check_velocities();
  /** Fit the matrices of points that have none to the velocities around these points. */
  void fit();

  /** Do torques change the affine motion with the present shape functions? */
  bool takes_torques() const;
  /** Add the torques of pair styles on points to their affine velocity. */
  void add_torques();
  /** Angular momentum of the affine motion of a point about itself [mass distance velocity]:
   *  zero before the first step. */
  void angular_momentum(int i, double L[3]) const;

 private:
  MPMField &field;

  uint64_t velocity_hash() const;
};

}    // namespace LAMMPS_NS
#endif

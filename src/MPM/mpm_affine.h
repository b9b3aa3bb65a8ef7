/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_AFFINE_H
#define LMP_MPM_AFFINE_H

#include "mpm_field.h"
#include "mpm_rows.h"
#include "transfer/kernels.h"

namespace LAMMPS_NS {

/** Affine matrices of the points (transfers apic, aflip, tpic, polypic). */
class MPMAffine : protected Pointers {
 public:
  MPMRows C;    ///< [n][dim*dim] column-major: C[dim*j+i] = d v_i / d x_j
  /** [n][poly_size(dim)] bilinear modes of the velocity; null: transfer without. */
  MPMRows Q;
  MPM_NS::PolyKernels modes;    ///< transfers of Q

  /** Which velocities the matrices belong to, between runs; as in restart files. */
  struct Velocities {
    uint64_t hash, known;    // no padding, which would go to the file
  } velocities = {0, 0};

  MPMAffine(class LAMMPS *, MPMField &, MPMPointState &);

  /** Row of a point in the arrays that kernels read. */
  double *rows() const { return &C[0][0]; }
  int size() const { return field.lattice.dim * field.lattice.dim; }

  /** Between runs: note the velocities that the matrices belong to; forget matrices of others. */
  void remember_velocities() { velocities = {velocity_hash(), 1}; }
  void check_velocities();
  /** Matrices of points that have none. */
  void fit();

  /** Do torques change the affine motion with these functions? */
  bool takes_torques() const;
  /** Torques of pair styles on points change their affine velocity. */
  void add_torques();
  /** Angular momentum of the affine motion of a point about itself (mass distance velocity units):
   *  zero before the first step. */
  void angular_momentum(int i, double L[3]) const;

 private:
  MPMField &field;

  uint64_t velocity_hash() const;
};

}    // namespace LAMMPS_NS
#endif

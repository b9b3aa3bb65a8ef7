/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_BATCH_KERNELS_H
#define MPM_MATERIAL_BATCH_KERNELS_H

#include "material/material.h"

namespace MPM_NS {

/** Functions that copy points between LAMMPS rows and a batch; compiled per instruction set. */
struct BatchKernels {
  /** Loads the kinematics of n points, A = dt L, F <- (I + A) F, J, Jold, and the stress at the
   *  start of the step. L: [n][dim*dim] column-major velocity gradient, F: [n][9] row-major, tau:
   *  [n][6] Kirchhoff stress, vol0: [n]. In 2d (plane strain) the entries of A and F that are
   *  always zero are not written, so the batch must have been zeroed when it was made. hoop: [n]
   *  hoop strain A_zz of the step, which multiplies F_zz by 1 + A_zz; used by the axisymmetric
   *  table only. */
  void (*load)(Batch &, int n, double dt, const double *L, const double *F, const double *tau,
               const double *vol0, const double *hoop);

  /** As load(), in the total frame, where L is the gradient with respect to the reference position:
   *  F <- F + dt L, and A = dt L F_old^-1. */
  void (*load_total)(Batch &, int n, double dt, const double *L, const double *F, const double *tau,
                     const double *vol0, const double *hoop);

  /** For materials that use only the determinant of F: where |F| > FORGET J^(1/3), F becomes
   *  J^(1/3) I; in 2d its part in the plane becomes (J/F_zz)^(1/2) I. An isolated fluid point can
   *  shear without bound, and J would be lost to round-off in the canceling products of entries of
   *  F. */
  void (*forget_shape)(Batch &);
  static constexpr double FORGET = 100.0;

  /** P: [n][dim*dim] first Piola-Kirchhoff stress tau F^-T, column-major; F, tau as in load(). */
  void (*first_piola)(int n, const double *F, const double *tau, double *P);

  /** Adds the Kirchhoff stress, J times the stress, to sum; J: at the start or the end of the
   *  step. */
  void (*add_kirchhoff)(const Batch &, const double *J, double (*sum)[BATCH]);

  /** Work of the stress in the step, summed over the points. twice_tau: the sum of the Kirchhoff
   *  stress at the start and the end of the step, half of which works on the gradient at mid-step,
   *  A (I + A/2)^-1 (skew if A belongs to a rotation). Points whose J is not positive do not
   *  count. */
  double (*stress_work)(const Batch &, const double (*twice_tau)[BATCH]);

  /** Copy history variables from rows [n][width] to columns of the batch, and back. */
  void (*load_history)(Batch &, int width, const double *rows);
  void (*store_history)(const Batch &, int width, double *rows);

  /** det F of n points. */
  void (*jacobians)(const double (*F)[BATCH], int n, double *J);

  /** Writes F and tau (2d: only the entries that can change). Returns the number of points whose J
   *  is not positive (NaN included); nothing is written for these. */
  int (*store)(const Batch &, double *F, double *tau);

  /** The functions for dimension 2 or 3. isa: as for LawTable::select(). hoop: dimension 2 with an
   *  axis of symmetry, where F_zz changes, too. */
  static const BatchKernels *select(int dim, const char *isa = nullptr, bool hoop = false);
};

}    // namespace MPM_NS
#endif

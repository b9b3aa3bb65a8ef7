/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATERIAL_BATCH_H
#define MPM_MATERIAL_BATCH_H

#include "material/material.h"

namespace MPM_NS {

/** Moves points between LAMMPS rows and a batch; compiled per instruction set. */
struct BatchKernels {
  /** Kinematics of n points: A = dt L, F <- (I + A) F, J, Jold; stress of the start of the step.
   *  L: [n][dim*dim] column-major velocity gradient, F: [n][9] row-major, tau: [n][6] Kirchhoff
   *  stress, vol0: [n].  In 2d (plane strain) the entries of A and F that are always zero are left
   *  alone: the batch must have been zero when it was made. hoop: [n] strain of the step around the
   *  axis, A_zz and factor 1 + A_zz of F_zz; for the axisymmetric table only, else not looked at. */
  void (*load)(Batch &, int n, double dt, const double *L, const double *F, const double *tau,
               const double *vol0, const double *hoop);

  /** The same in the total frame, where L is the gradient with respect to the reference position:
   *  F <- F + dt L, and A = dt L F_old^-1. */
  void (*load_total)(Batch &, int n, double dt, const double *L, const double *F, const double *tau,
                     const double *vol0, const double *hoop);

  /** For materials that know F by its determinant only: where |F| > FORGET J^(1/3), F becomes
   *  J^(1/3) I; in 2d in the plane, with (J/F_zz)^(1/2). A fluid point that flies alone shears for
   *  ever, and J would be lost in the round-off of products of entries of F that cancel. */
  void (*forget_shape)(Batch &);
  static constexpr double FORGET = 100.0;

  /** P: [n][dim*dim] first Piola-Kirchhoff stress tau F^-T, column-major; F, tau as in load. */
  void (*first_piola)(int n, const double *F, const double *tau, double *P);

  /** Adds J times the stress, the Kirchhoff stress, to sum; J: that of the start or of the end. */
  void (*add_kirchhoff)(const Batch &, const double *J, double (*sum)[BATCH]);

  /** Work of the stress in the step, all points together, from the sum of the Kirchhoff stress at its
   *  start and end: half of it with the gradient at mid-step, A (I + A/2)^-1, which is skew if A belongs to
   *  a rotation. Points whose J is not positive do not count. */
  double (*stress_work)(const Batch &, const double (*twice_tau)[BATCH]);

  /** History variables: rows [n][width] to columns, and back. */
  void (*load_history)(Batch &, int width, const double *rows);
  void (*store_history)(const Batch &, int width, double *rows);

  /** det F of n points. */
  void (*jacobians)(const double (*F)[BATCH], int n, double *J);

  /** Write F and tau (2d: only what can change). Returns the number of points whose J is not
   *  positive (NaN included); nothing is written for these. */
  int (*store)(const Batch &, double *F, double *tau);

  /** The table for dimension 2 or 3; hoop: for dimension 2 with an axis of symmetry, where F_zz
   *  changes, too. */
  static const BatchKernels *select(int dim, const char *isa = nullptr, bool hoop = false);
};

}    // namespace MPM_NS
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_BATCH_H
#define LMP_MPM_BATCH_H

#include "mpm_material.h"

namespace MPM_NS {

/** Moves points between LAMMPS rows and a batch; compiled per instruction set. */
struct BatchKernels {
  /** Kinematics of n points: A = dt L, F <- (I + A) F, J, Jold; stress of the start of the step.
   *  L: [n][9] column-major velocity gradient, F: [n][9] row-major, stress: [n][6], vol0: [n]. */
  void (*load)(Batch &, int n, double dt, const double *L, const double *F, const double *stress,
               const double *vol0);

  /** Write F, stress and vol = vol0 J. Returns the number of points whose J is not positive
   *  (NaN included); nothing is written for these. */
  int (*store)(const Batch &, double *F, double *stress, double *vol);

  static const BatchKernels *select(const char *isa = nullptr);
};

}    // namespace MPM_NS
#endif

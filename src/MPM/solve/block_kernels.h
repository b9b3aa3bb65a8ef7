/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_SOLVE_BLOCK_KERNELS_H
#define MPM_SOLVE_BLOCK_KERNELS_H

#include <cstdint>

namespace MPM_NS {

/** Rows and columns of the blocks of EnvelopeFactors. */
constexpr int FACTOR_BLOCK = 16;

/** Products of dense blocks, compiled for each instruction set.  a and b are n columns of FACTOR_BLOCK reals, one column after the
 *  other: blocks that stand side by side in a row of blocks are one such list. */
struct BlockKernels {
  /** S -= a b^T, S: [FACTOR_BLOCK] columns. */
  void (*subtract)(double *S, const double *a, const double *b, int64_t n);
  /** y -= a x, x: [n], y: [FACTOR_BLOCK] */
  void (*subtract_from_rows)(double *y, const double *a, const double *x, int64_t n);
  /** y -= a^T x, x: [FACTOR_BLOCK], y: [n] */
  void (*subtract_from_columns)(double *y, const double *a, const double *x, int64_t n);

  /** Those of the best set that runs here, or that the environment variable MPM_ISA names. */
  static BlockKernels select();
};

}    // namespace MPM_NS
#endif

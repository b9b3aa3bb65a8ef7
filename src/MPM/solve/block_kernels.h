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

/** Number of rows and of columns of the blocks of EnvelopeFactors. */
constexpr int FACTOR_BLOCK = 16;

/** Products of dense blocks, compiled for each instruction set. a and b consist of n columns of
 *  FACTOR_BLOCK reals, one column after the other; blocks side by side in a row of blocks form one
 *  such list. */
struct BlockKernels {
  /** S -= a b^T, with FACTOR_BLOCK columns in S. */
  void (*subtract)(double *S, const double *a, const double *b, int64_t n);
  /** Products with a vector; sums are in double precision for a in single precision, too. */
  template <class Real> struct WithVector {
    /** y -= a x, x: [n], y: [FACTOR_BLOCK] */
    void (*subtract_from_rows)(double *y, const Real *a, const double *x, int64_t n);
    /** y -= a^T x, x: [FACTOR_BLOCK], y: [n] */
    void (*subtract_from_columns)(double *y, const Real *a, const double *x, int64_t n);
  };
  WithVector<double> of_doubles;
  WithVector<float> of_floats;

  /** The kernels of the best instruction set of this CPU, or of the set in the environment variable
   *  MPM_ISA. */
  static BlockKernels select();
};

}    // namespace MPM_NS
#endif

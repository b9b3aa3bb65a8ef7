/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_MATH_MATRIX_H
#define MPM_MATH_MATRIX_H

// Vectors of three and matrices of 3x3 reals, row by row in plain arrays. T is a number or a SIMD
// vector with one entry per point. The functions must be inlined: files that are compiled for
// different instruction sets share this header, and an out-of-line copy made for one CPU must not
// run on another.

namespace MPM_NS {

/** c = a x b; c must be another array than a and b. */
template <class T> [[gnu::always_inline]] inline void cross(const T *a, const T *b, T *c)
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

template <class T> [[gnu::always_inline]] inline T dot(const T *a, const T *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T> [[gnu::always_inline]] inline T determinant(const T *m)
{
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
      m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/** Initializer {...} of the cofactors c of m: m c^T = (det m) I. This is no function, because a
 *  loop with omp simd stays scalar if it takes the address of an array. */
#define MPM_COFACTORS(m)                                                                 \
  {                                                                                      \
    m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],     \
        m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7], \
        m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]  \
  }

/** Entry (i, j) of the matrix product a b: row i of a times column j of b. */
template <class T> [[gnu::always_inline]] inline T product(const T *a, const T *b, int i, int j)
{
  return a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

}    // namespace MPM_NS
#endif

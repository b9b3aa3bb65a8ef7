/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_SPECTRAL_H
#define MPM_LAW_SPECTRAL_H

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Spectral decomposition of a symmetric tensor: s = sum_a value[a] n_a x n_a, with the unit
   *  vectors n_a = (vector[0][a], vector[1][a], vector[2][a]); values in no particular order. */
  struct Spectral {
    double value[3];
    double vector[3][3];
  };

  MPM_INLINE void rotate_pair(double &v, double &w, double c, double n)
  {
    const double old = v;
    v = c * v - n * w;
    w = n * old + c * w;
  }

  /** One Jacobi rotation that makes the entry pq zero; r is the third index. */
  MPM_INLINE void jacobi_rotation(double &pp, double &qq, double &pq, double &pr, double &qr,
                                  Spectral &s, int p, int q)
  {
    const double d = qq - pp, root = std::sqrt(d * d + 4.0 * pq * pq);
    // tangent of the smaller angle; the tiny number makes 0/0 a zero
    const double t = 2.0 * pq * (d < 0.0 ? -1.0 : 1.0) / ((d < 0.0 ? -d : d) + root + 1e-300);
    const double c = 1.0 / std::sqrt(1.0 + t * t), n = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    rotate_pair(pr, qr, c, n);
    rotate_pair(s.vector[0][p], s.vector[0][q], c, n);
    rotate_pair(s.vector[1][p], s.vector[1][q], c, n);
    rotate_pair(s.vector[2][p], s.vector[2][q], c, n);
  }

  /** Decomposition by cyclic Jacobi rotations (G.H. Golub, C.F. Van Loan, Matrix Computations,
   *  ch. 8.5): no branches, accurate to round-off also when eigenvalues coincide. Four sweeps
   *  leave off-diagonal entries below 1e-20 of the deviator for any 3x3 matrix. */
  MPM_INLINE Spectral spectral(const Sym &a)
  {
    double xx = a.xx, yy = a.yy, zz = a.zz, xy = a.xy, xz = a.xz, yz = a.yz;
    Spectral s = {{0.0, 0.0, 0.0}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    // loops over points vectorize only when no inner loop is left
#pragma GCC unroll 4
    for (int sweep = 0; sweep < 4; sweep++) {
      jacobi_rotation(xx, yy, xy, xz, yz, s, 0, 1);
      jacobi_rotation(xx, zz, xz, xy, yz, s, 0, 2);
      jacobi_rotation(yy, zz, yz, xy, xz, s, 1, 2);
    }
    s.value[0] = xx;
    s.value[1] = yy;
    s.value[2] = zz;
    return s;
  }

  /** r += v n x n, n = (x, y, z) */
  MPM_INLINE void add_dyad(Sym &r, double x, double y, double z, double v)
  {
    r.xx += v * x * x;
    r.yy += v * y * y;
    r.zz += v * z * z;
    r.xy += v * x * y;
    r.xz += v * x * z;
    r.yz += v * y * z;
  }

  /** The symmetric tensor with the same eigenvectors and other eigenvalues. */
  MPM_INLINE Sym recompose(const Spectral &s, const double value[3])
  {
    Sym r = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add_dyad(r, s.vector[0][0], s.vector[1][0], s.vector[2][0], value[0]);
    add_dyad(r, s.vector[0][1], s.vector[1][1], s.vector[2][1], value[1]);
    add_dyad(r, s.vector[0][2], s.vector[1][2], s.vector[2][2], value[2]);
    return r;
  }

  /** Principal logarithmic strain, from a principal value of b - I. */
  MPM_INLINE double log_strain(double value)
  {
    return 0.5 * log1p(max(value, -1.0 + 1e-15));
  }

  /** sum_a value_a n_a x n_a, with the axes n_a of point i as [component][axis][point]. */
  MPM_INLINE Sym along_axes(const double (&axes)[3][3][BATCH], int i, double value0, double value1,
                            double value2)
  {
    Sym r = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add_dyad(r, axes[0][0][i], axes[1][0][i], axes[2][0][i], value0);
    add_dyad(r, axes[0][1][i], axes[1][1][i], axes[2][1][i], value1);
    add_dyad(r, axes[0][2][i], axes[1][2][i], axes[2][2][i], value2);
    return r;
  }

  /** f b f^T with f = I + A of this step: how a left Cauchy-Green tensor (or its elastic part, as
   *  trial state) follows the motion; exact and objective. */
  MPM_INLINE Sym push_forward(const Batch &batch, int i, const Sym &b)
  {
    const double f[9] = {1.0 + batch.A[0][i], batch.A[1][i],       batch.A[2][i],
                         batch.A[3][i],       1.0 + batch.A[4][i], batch.A[5][i],
                         batch.A[6][i],       batch.A[7][i],       1.0 + batch.A[8][i]};
    return congruence(f, b);
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

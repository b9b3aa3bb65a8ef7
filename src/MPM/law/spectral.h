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

  /** Symmetric tensors of the points of a batch, by component. */
  struct Tensors {
    alignas(64) double row[6][BATCH];
  };

  /** Spectral decomposition of the symmetric tensors of a batch: sum_a value[a] n_a x n_a, with the unit
   *  vectors n_a = (vector[0][a], vector[1][a], vector[2][a]); values in no particular order. */
  struct Spectral {
    alignas(64) double value[3][BATCH];
    alignas(64) double vector[3][3][BATCH];    ///< [component][axis][point]

    MPM_INLINE Spectral(int n, const double (*tensors)[BATCH]);

    /** The symmetric tensor of point i with the same axes and other values. */
    MPM_INLINE Sym recompose(int i, double value0, double value1, double value2) const;

    /** n . s . n for axis a of point i. */
    MPM_INLINE double along(int a, int i, const Sym &s) const
    {
      const double x = vector[0][a][i], y = vector[1][a][i], z = vector[2][a][i];
      return s.xx * x * x + s.yy * y * y + s.zz * z * z +
          2.0 * (s.xy * x * y + s.xz * x * z + s.yz * y * z);
    }
  };

  MPM_INLINE void rotate_pair(double &v, double &w, double c, double n)
  {
    const double old = v;
    v = c * v - n * w;
    w = n * old + c * w;
  }

  /** One Jacobi rotation that makes the entry pq zero; r is the third index, i the point. */
  MPM_INLINE void jacobi_rotation(double &pp, double &qq, double &pq, double &pr, double &qr,
                                  Spectral &s, int p, int q, int i)
  {
    const double d = qq - pp, root = std::sqrt(d * d + 4.0 * pq * pq);
    // tangent of the smaller angle; the tiny number makes 0/0 a zero
    const double t = 2.0 * pq * (d < 0.0 ? -1.0 : 1.0) / ((d < 0.0 ? -d : d) + root + 1e-300);
    const double c = 1.0 / std::sqrt(1.0 + t * t), n = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    rotate_pair(pr, qr, c, n);
    rotate_pair(s.vector[0][p][i], s.vector[0][q][i], c, n);
    rotate_pair(s.vector[1][p][i], s.vector[1][q][i], c, n);
    rotate_pair(s.vector[2][p][i], s.vector[2][q][i], c, n);
  }

  /** Decomposition by cyclic Jacobi rotations (G.H. Golub, C.F. Van Loan, Matrix Computations,
   *  ch. 8.5): no branches on points, accurate to round-off also when eigenvalues coincide. Four sweeps
   *  leave off-diagonal entries below 1e-20 of the deviator for any 3x3 matrix. Where z is a principal
   *  axis of all points, as in plane strain, one rotation is all that there is to do: others would leave
   *  every bit as it is. */
  MPM_INLINE Spectral::Spectral(int n, const double (*tensors)[BATCH])
  {
    alignas(64) double xy[BATCH], xz[BATCH], yz[BATCH];
    double out_of_plane = 0.0;
    MPM_SIMD_SUM(out_of_plane)
    for (int i = 0; i < n; i++) {
      value[0][i] = tensors[0][i];
      value[1][i] = tensors[1][i];
      value[2][i] = tensors[2][i];
      xy[i] = tensors[3][i];
      xz[i] = tensors[4][i];
      yz[i] = tensors[5][i];
      vector[0][0][i] = vector[1][1][i] = vector[2][2][i] = 1.0;
      vector[0][1][i] = vector[0][2][i] = vector[1][0][i] = 0.0;
      vector[1][2][i] = vector[2][0][i] = vector[2][1][i] = 0.0;
      out_of_plane += xz[i] == 0.0 && yz[i] == 0.0 ? 0.0 : 1.0;
    }
    if (out_of_plane == 0.0) {
      MPM_SIMD
      for (int i = 0; i < n; i++)
        jacobi_rotation(value[0][i], value[1][i], xy[i], xz[i], yz[i], *this, 0, 1, i);
      return;
    }
    for (int sweep = 0; sweep < 4; sweep++) {
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        jacobi_rotation(value[0][i], value[1][i], xy[i], xz[i], yz[i], *this, 0, 1, i);
        jacobi_rotation(value[0][i], value[2][i], xz[i], xy[i], yz[i], *this, 0, 2, i);
        jacobi_rotation(value[1][i], value[2][i], yz[i], xy[i], xz[i], *this, 1, 2, i);
      }
    }
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

  MPM_INLINE Sym Spectral::recompose(int i, double value0, double value1, double value2) const
  {
    Sym r = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add_dyad(r, vector[0][0][i], vector[1][0][i], vector[2][0][i], value0);
    add_dyad(r, vector[0][1][i], vector[1][1][i], vector[2][1][i], value1);
    add_dyad(r, vector[0][2][i], vector[1][2][i], vector[2][2][i], value2);
    return r;
  }

  /** Principal logarithmic strain, from a principal value of b - I. */
  MPM_INLINE double log_strain(double value)
  {
    return 0.5 * log1p(max(value, -1.0 + 1e-15));
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

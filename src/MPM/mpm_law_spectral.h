/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_LAW_SPECTRAL_H
#define LMP_MPM_LAW_SPECTRAL_H

#include "mpm_law_kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Spectral decomposition of a symmetric tensor: s = sum_a value[a] n_a x n_a, with the unit
   *  vectors n_a = (vector[0][a], vector[1][a], vector[2][a]); values in no particular order. */
  struct Spectral {
    double value[3];
    double vector[3][3];
  };

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
    const double a = pr, b = qr;
    pr = c * a - n * b;
    qr = n * a + c * b;
    for (int k = 0; k < 3; k++) {
      const double v = s.vector[k][p], w = s.vector[k][q];
      s.vector[k][p] = c * v - n * w;
      s.vector[k][q] = n * v + c * w;
    }
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

  /** The symmetric tensor with the same eigenvectors and other eigenvalues. */
  MPM_INLINE Sym recompose(const Spectral &s, const double value[3])
  {
    Sym r = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (int a = 0; a < 3; a++) {
      const double x = s.vector[0][a], y = s.vector[1][a], z = s.vector[2][a], v = value[a];
      r.xx += v * x * x;
      r.yy += v * y * y;
      r.zz += v * z * z;
      r.xy += v * x * y;
      r.xz += v * x * z;
      r.yz += v * y * z;
    }
    return r;
  }

  /** f b f^T with f = I + A of this step: how a left Cauchy-Green tensor (or its elastic part, as
   *  trial state) follows the motion; exact and objective. */
  MPM_INLINE Sym push_forward(const Batch &batch, int i, const Sym &b)
  {
    const double fxx = 1.0 + batch.A[0][i], fxy = batch.A[1][i], fxz = batch.A[2][i];
    const double fyx = batch.A[3][i], fyy = 1.0 + batch.A[4][i], fyz = batch.A[5][i];
    const double fzx = batch.A[6][i], fzy = batch.A[7][i], fzz = 1.0 + batch.A[8][i];
    const double txx = fxx * b.xx + fxy * b.xy + fxz * b.xz;
    const double txy = fxx * b.xy + fxy * b.yy + fxz * b.yz;
    const double txz = fxx * b.xz + fxy * b.yz + fxz * b.zz;
    const double tyx = fyx * b.xx + fyy * b.xy + fyz * b.xz;
    const double tyy = fyx * b.xy + fyy * b.yy + fyz * b.yz;
    const double tyz = fyx * b.xz + fyy * b.yz + fyz * b.zz;
    const double tzx = fzx * b.xx + fzy * b.xy + fzz * b.xz;
    const double tzy = fzx * b.xy + fzy * b.yy + fzz * b.yz;
    const double tzz = fzx * b.xz + fzy * b.yz + fzz * b.zz;
    return {txx * fxx + txy * fxy + txz * fxz, tyx * fyx + tyy * fyy + tyz * fyz,
            tzx * fzx + tzy * fzy + tzz * fzz, txx * fyx + txy * fyy + txz * fyz,
            txx * fzx + txy * fzy + txz * fzz, tyx * fzx + tyy * fzy + tyz * fzz};
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_TANGENT_H
#define MPM_LAW_TANGENT_H

// Functions for tangents that laws share; see Tangent in law/batch.h. Loops over the
// columns of a tangent enclose the loops over the points, so that their indices cost nothing.
// Functions that contain loops over points are not forced inline: a named tensor in such a loop
// would then become an array in memory, and the loop would not vectorize.

#include "law/kinematics.h"

namespace MPM_NS::law {
namespace {

  /** Component of a symmetric tensor, in the order of Sym, from its indices. */
  constexpr int COMPONENT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  /** First and second index of a component of a symmetric tensor. */
  constexpr int FIRST[6] = {0, 1, 2, 0, 0, 1}, SECOND[6] = {0, 1, 2, 1, 2, 2};

  /** Adds a factor times one row to another row. */
  inline void add_rows(int n, double factor, const double *from, double *to)
  {
    MPM_SIMD
    for (int i = 0; i < n; i++) to[i] += factor * from[i];
  }

  /** Adds the derivative value[i] tr(l) I of a mean stress. */
  inline void add_mean(int n, const double *value, Tangent &t)
  {
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 9; k += 4) add_rows(n, 1.0, value, t.stress[c][k]);
  }

  /** Adds l s + s l^T, the change of a tensor s that is convected with the material. */
  inline void add_convected(int n, const double (*s)[BATCH], Tangent &t)
  {
    for (int c = 0; c < 6; c++)
      for (int m = 0; m < 3; m++) {
        const int left = 3 * FIRST[c] + m, right = 3 * SECOND[c] + m;
        const double *const s_left = s[COMPONENT[m][SECOND[c]]];
        const double *const s_right = s[COMPONENT[FIRST[c]][m]];
        if (!t.skips(left)) add_rows(n, 1.0, s_left, t.stress[c][left]);
        if (!t.skips(right)) add_rows(n, 1.0, s_right, t.stress[c][right]);
      }
  }

  /** Adds w s - s w with the skew part w of l, the change of a tensor s that rotates with the
   *  material. */
  inline void add_turned(int n, const double (*s)[BATCH], Tangent &t)
  {
    for (int c = 0; c < 6; c++)
      for (int m = 0; m < 3; m++) {
        const int i = FIRST[c], j = SECOND[c];
        const double *const s_left = s[COMPONENT[m][j]], *const s_right = s[COMPONENT[i][m]];
        if (m != i && !t.skips(3 * i + m)) {
          add_rows(n, 0.5, s_left, t.stress[c][3 * i + m]);
          add_rows(n, -0.5, s_left, t.stress[c][3 * m + i]);
        }
        if (m != j && !t.skips(3 * j + m)) {
          add_rows(n, 0.5, s_right, t.stress[c][3 * j + m]);
          add_rows(n, -0.5, s_right, t.stress[c][3 * m + j]);
        }
      }
  }

  /** Derivatives, in the frame of three vectors, of a stress that depends only on the symmetric
   *  part of the motion. */
  struct FrameModuli {
    alignas(64) double A[6][BATCH];    ///< of component aa by l_bb, for ab = 11 22 33 12 13 23
    alignas(64) double m[3][BATCH];    ///< of component ab by l_ab + l_ba, for ab = 12 13 23
  };

  /** Adds the tangent
   *
   *    sum_ab A_ab (v_a v_a) (v_b v_b) + sum_(a < b) m_ab (v_a v_b + v_b v_a) (v_a v_b + v_b v_a)
   *
   *  with the three vectors v_a of each point, v[component][vector][point]. */
  inline void add_frame_tangent(int n, const double (*v)[3][BATCH], const FrameModuli &moduli,
                                Tangent &t)
  {
    alignas(64) double dyad[6][6][BATCH], sum[6][BATCH];
    for (int c = 0; c < 6; c++)
      for (int m = 0; m < 6; m++) {
        const double *const pa = v[FIRST[c]][FIRST[m]], *const qb = v[SECOND[c]][SECOND[m]];
        const double *const pb = v[FIRST[c]][SECOND[m]], *const qa = v[SECOND[c]][FIRST[m]];
        const double twice = m < 3 ? 0.5 : 1.0;
        double *const row = dyad[m][c];
        MPM_SIMD
        for (int i = 0; i < n; i++) row[i] = twice * (pa[i] * qb[i] + pb[i] * qa[i]);
      }
    const auto &A = moduli.A, &d = dyad[0], &e = dyad[1], &f = dyad[2];
    const auto &x = dyad[3], &y = dyad[4], &z = dyad[5];
    const auto &m = moduli.m;
    for (int k = 0; k < 6; k++) {
      const int column = 3 * FIRST[k] + SECOND[k], other = 3 * SECOND[k] + FIRST[k];
      if (t.skips(column)) continue;
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        const double d0 = d[k][i], d1 = e[k][i], d2 = f[k][i];
        const double r0 = A[0][i] * d0 + A[3][i] * d1 + A[4][i] * d2;
        const double r1 = A[3][i] * d0 + A[1][i] * d1 + A[5][i] * d2;
        const double r2 = A[4][i] * d0 + A[5][i] * d1 + A[2][i] * d2;
        const double r3 = m[0][i] * x[k][i], r4 = m[1][i] * y[k][i], r5 = m[2][i] * z[k][i];
#pragma GCC unroll 6
        for (int c = 0; c < 6; c++)
          sum[c][i] = d[c][i] * r0 + e[c][i] * r1 + f[c][i] * r2 + x[c][i] * r3 + y[c][i] * r4 +
              z[c][i] * r5;
      }
      for (int c = 0; c < 6; c++) {
        add_rows(n, 1.0, sum[c], t.stress[c][column]);
        if (other != column) add_rows(n, 1.0, sum[c], t.stress[c][other]);
      }
    }
  }

  /** Spin with the angular velocity (x, y, z). of(s): rate of a tensor s that rotates with it. */
  struct Spin {
    double x, y, z;

    MPM_INLINE Sym of(const Sym &s) const
    {
      return {2.0 * (y * s.xz - z * s.xy),
              2.0 * (z * s.xy - x * s.yz),
              2.0 * (x * s.yz - y * s.xz),
              y * s.yz - z * s.yy + z * s.xx - x * s.xz,
              y * s.zz - z * s.yz + x * s.xy - y * s.xx,
              z * s.xz - x * s.zz + x * s.yy - y * s.xy};
    }
  };

  /** Motion of a step in rate form, and its derivatives. The increment at the middle of the step,
   *  G = A (I + A/2)^-1, with strain e and rotation W, has the derivative
   *
   *    dG = (I - G/2) l (I + G/2).
   *
   *  The rotation Q = (I - W/2)^-1 (I + W/2) changes by dQ Q^T = (I - W/2)^-1 dW (I + W/2)^-1, the
   *  skew matrix of the vector (dw + w x dw/2)/(1 + w.w/4), where w is the axial vector of W. */
  struct StepMotion {
    alignas(64) double G[9][BATCH], Q[9][BATCH];
    alignas(64) double QM[9][BATCH], QN[9][BATCH];    ///< Q (I - G/2), Q (I + G/2)^T
    alignas(64) double w[3][BATCH];

    explicit StepMotion(const Batch &b)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        const Rotation R(inc);
        w[0][i] = inc.wx;
        w[1][i] = inc.wy;
        w[2][i] = inc.wz;
        G[0][i] = inc.strain.xx;
        G[1][i] = inc.strain.xy - inc.wz;
        G[2][i] = inc.strain.xz + inc.wy;
        G[3][i] = inc.strain.xy + inc.wz;
        G[4][i] = inc.strain.yy;
        G[5][i] = inc.strain.yz - inc.wx;
        G[6][i] = inc.strain.xz - inc.wy;
        G[7][i] = inc.strain.yz + inc.wx;
        G[8][i] = inc.strain.zz;
        for (int k = 0; k < 9; k++) Q[k][i] = R.Q[k];
      }
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
          MPM_SIMD
          for (int i = 0; i < b.n; i++) {
            const double x = Q[3 * r][i], y = Q[3 * r + 1][i], z = Q[3 * r + 2][i];
            QM[3 * r + c][i] =
                Q[3 * r + c][i] - 0.5 * (x * G[c][i] + y * G[3 + c][i] + z * G[6 + c][i]);
            QN[3 * r + c][i] = Q[3 * r + c][i] +
                0.5 * (x * G[3 * c][i] + y * G[3 * c + 1][i] + z * G[3 * c + 2][i]);
          }
        }
    }

    MPM_INLINE Sym strain(int i) const
    {
      return {G[0][i],
              G[4][i],
              G[8][i],
              0.5 * (G[1][i] + G[3][i]),
              0.5 * (G[2][i] + G[6][i]),
              0.5 * (G[5][i] + G[7][i])};
    }

    /** Derivatives with respect to l_kl for one point. */
    struct Column {
      Sym strain;     ///< of e
      Sym both;       ///< de + Q de Q^T
      double mean;    ///< a third of the trace of de
      Spin spin;      ///< of Q
    };

    /** Derivatives with respect to l_kl for any point i. */
    struct Columns {
      const StepMotion &step;
      const int k, l;
      const double kx, ky, kz, lx, ly, lz;    ///< unit vectors

      MPM_INLINE Column operator()(int i) const
      {
        const auto &G = step.G, &QM = step.QM, &QN = step.QN;
        const auto &w = step.w;
        // dG is a dyad a b, and Q dG Q^T is the dyad c d
        const double ax = kx - 0.5 * G[k][i], ay = ky - 0.5 * G[3 + k][i];
        const double az = kz - 0.5 * G[6 + k][i], bx = lx + 0.5 * G[3 * l][i];
        const double by = ly + 0.5 * G[3 * l + 1][i], bz = lz + 0.5 * G[3 * l + 2][i];
        const double cx = QM[k][i], cy = QM[3 + k][i], cz = QM[6 + k][i];
        const double dx = QN[l][i], dy = QN[3 + l][i], dz = QN[6 + l][i];
        const double x = w[0][i], y = w[1][i], z = w[2][i];
        const double vx = 0.5 * (by * az - bz * ay), vy = 0.5 * (bz * ax - bx * az);
        const double vz = 0.5 * (bx * ay - by * ax);
        const double q = 1.0 / (1.0 + 0.25 * (x * x + y * y + z * z));
        return {{ax * bx, ay * by, az * bz, 0.5 * (ax * by + ay * bx), 0.5 * (ax * bz + az * bx),
                 0.5 * (ay * bz + az * by)},
                {ax * bx + cx * dx, ay * by + cy * dy, az * bz + cz * dz,
                 0.5 * (ax * by + ay * bx + cx * dy + cy * dx),
                 0.5 * (ax * bz + az * bx + cx * dz + cz * dx),
                 0.5 * (ay * bz + az * by + cy * dz + cz * dy)},
                (1.0 / 3.0) * (ax * bx + ay * by + az * bz),
                {q * (vx + 0.5 * (y * vz - z * vy)), q * (vy + 0.5 * (z * vx - x * vz)),
                 q * (vz + 0.5 * (x * vy - y * vx))}};
      }
    };

    MPM_INLINE Columns columns(int k, int l) const
    {
      return {*this,
              k,
              l,
              1.0 * (k == 0),
              1.0 * (k == 1),
              1.0 * (k == 2),
              1.0 * (l == 0),
              1.0 * (l == 1),
              1.0 * (l == 2)};
    }
  };

  /** Deviator of the Kirchhoff stress after an elastic step in rate form with the shear modulus G
   *  (see jaumann()), and its derivative. Only the rotated part of the stress depends on the
   *  rotation of the step. */
  struct ElasticStep : StepMotion {
    double shear;
    alignas(64) double turned[6][BATCH];    ///< Q (old + G dev(e)) Q^T

    /** old: Kirchhoff stress at the start of the step, or its deviator. */
    ElasticStep(const Batch &b, double shear, const double (*old)[BATCH]) :
        StepMotion(b), shear(shear)
    {
      MPM_SIMD
      for (int i = 0; i < b.n; i++) {
        const Increment inc = increment(b, i);
        store_rows(turned, i, rotate(inc, load_rows(old, i) + shear * deviator(inc.strain)));
      }
    }

    MPM_INLINE Sym trial(int i) const { return load_rows(turned, i) + shear * deviator(strain(i)); }

    /** Derivatives of trial() with respect to l_kl. */
    void column(int n, int k, int l, double (*out)[BATCH]) const
    {
      const Columns columns = StepMotion::columns(k, l);
      const double G = shear;
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        const Column d = columns(i);
        store_rows(out, i,
                   G * add_diagonal(d.both, -2.0 * d.mean) + d.spin.of(load_rows(turned, i)));
      }
    }
  };

  /** Adds the derivatives of the stress of point i to a column of the tangent. */
  MPM_INLINE void add_column(Tangent &t, int column, int i, const Sym &s)
  {
    t.stress[0][column][i] += s.xx;
    t.stress[1][column][i] += s.yy;
    t.stress[2][column][i] += s.zz;
    t.stress[3][column][i] += s.xy;
    t.stress[4][column][i] += s.xz;
    t.stress[5][column][i] += s.yz;
  }

  /** Adds the tangent of an elastic step. */
  inline void add_elastic_step(int n, const ElasticStep &step, Tangent &t)
  {
    alignas(64) double column[6][BATCH];
    for (int k = 0; k < 9; k++) {
      if (t.skips(k)) continue;
      step.column(n, k / 3, k % 3, column);
      MPM_SIMD
      for (int i = 0; i < n; i++) add_column(t, k, i, load_rows(column, i));
    }
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

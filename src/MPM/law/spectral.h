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

  /** Symmetric tensors of the points of a batch, [component][point]. */
  struct Tensors {
    alignas(64) double row[6][BATCH];
  };

  /** Spectral decomposition of the symmetric tensors of a batch: sum_a value[a] n_a x n_a, with the
   *  unit vectors n_a = (vector[0][a], vector[1][a], vector[2][a]). The values are in no particular
   *  order. */
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

  /** Vector of a point. */
  struct Direction {
    double x, y, z;
  };

  /** a . b */
  MPM_INLINE double product(const Direction &a, const Direction &b)
  {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  /** a x b */
  MPM_INLINE Direction cross(const Direction &a, const Direction &b)
  {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  /** s v */
  MPM_INLINE Direction product(const Sym &s, const Direction &v)
  {
    return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
            s.xz * v.x + s.yz * v.y + s.zz * v.z};
  }

  /** Unit vector along the principal axis whose value is farthest from the mean; this axis is well
   *  defined whatever the other values are. It is normal to the rows of s minus this value; the
   *  largest of their three cross products is taken. The result is z if z is a principal axis or if
   *  all values are equal. */
  MPM_INLINE Direction distinct_axis(const Sym &s)
  {
    const Sym d = deviator(s);
    const double size = std::sqrt((1.0 / 6.0) * norm2(d)), inv = size > 0.0 ? 1.0 / size : 0.0;
    const Sym n = inv * d;
    const double value = DeviatorRoots(n).first;
    const Direction x = {n.xx - value, n.xy, n.xz}, y = {n.xy, n.yy - value, n.yz};
    const Direction z = {n.xz, n.yz, n.zz - value};
    const Direction u = cross(x, y), v = cross(y, z), w = cross(z, x);
    const double uu = product(u, u), vv = product(v, v), ww = product(w, w);
    const double vx = vv > ww ? v.x : w.x, vy = vv > ww ? v.y : w.y, vz = vv > ww ? v.z : w.z;
    const double rest = vv > ww ? vv : ww, largest = max(uu, rest);
    const double ux = uu > rest ? u.x : vx, uy = uu > rest ? u.y : vy, uz = uu > rest ? u.z : vz;
    const double scale = 1.0 / std::sqrt(max(largest, 1e-300));
    const double tilt = s.xz * s.xz + s.yz * s.yz > 0.0 ? scale : 0.0;
    return {tilt * ux, tilt * uy, tilt > 0.0 ? tilt * uz : 1.0};
  }

  /** Decomposition by one axis that is well defined and a Jacobi rotation (C.G.J. Jacobi) of the
   *  plane normal to it. There are no branches on points, and the result is accurate to round-off
   *  even when values coincide. Where z is a principal axis of all points, as in plane strain, the
   *  rotation is the only step. */
  MPM_INLINE Spectral::Spectral(int n, const double (*tensors)[BATCH])
  {
    alignas(64) double xx[BATCH], yy[BATCH], xy[BATCH];    // in the plane
    double out_of_plane = 0.0;
    MPM_SIMD_SUM(out_of_plane)
    for (int i = 0; i < n; i++) {
      xx[i] = tensors[0][i];
      yy[i] = tensors[1][i];
      value[2][i] = tensors[2][i];
      xy[i] = tensors[3][i];
      vector[0][0][i] = vector[1][1][i] = vector[2][2][i] = 1.0;
      vector[0][1][i] = vector[0][2][i] = vector[1][0][i] = 0.0;
      vector[1][2][i] = vector[2][0][i] = vector[2][1][i] = 0.0;
      const double square = tensors[4][i] * tensors[4][i] + tensors[5][i] * tensors[5][i];
      out_of_plane += square > 0.0 ? 1.0 : 0.0;
    }
    if (out_of_plane > 0.0) {
      MPM_SIMD
      for (int i = 0; i < n; i++) {
        const Sym s = load_rows(tensors, i);
        const Direction w = distinct_axis(s);
        // two unit vectors normal to it (T. Duff et al., J. Comput. Graph. Tech. 6 (2017) 1)
        const double sign = w.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + w.z), c = w.x * w.y * a;
        const Direction u = {1.0 + sign * w.x * w.x * a, sign * c, -sign * w.x};
        const Direction v = {c, sign + w.y * w.y * a, -w.y};
        const Direction su = product(s, u), sv = product(s, v), sw = product(s, w);
        xx[i] = product(u, su);
        yy[i] = product(v, sv);
        xy[i] = product(u, sv);
        value[2][i] = product(w, sw);
        vector[0][0][i] = u.x;
        vector[1][0][i] = u.y;
        vector[2][0][i] = u.z;
        vector[0][1][i] = v.x;
        vector[1][1][i] = v.y;
        vector[2][1][i] = v.z;
        vector[0][2][i] = w.x;
        vector[1][2][i] = w.y;
        vector[2][2][i] = w.z;
      }
    }
    MPM_SIMD
    for (int i = 0; i < n; i++) {
      const double d = yy[i] - xx[i], o = xy[i], root = std::sqrt(d * d + 4.0 * o * o);
      // tangent of the smaller angle; the tiny number turns 0/0 into zero
      const double t = 2.0 * o * (d < 0.0 ? -1.0 : 1.0) / ((d < 0.0 ? -d : d) + root + 1e-300);
      const double c = 1.0 / std::sqrt(1.0 + t * t), sine = t * c;
      value[0][i] = xx[i] - t * o;
      value[1][i] = yy[i] + t * o;
      const double x = vector[0][0][i], y = vector[1][0][i], z = vector[2][0][i];
      vector[0][0][i] = c * x - sine * vector[0][1][i];
      vector[1][0][i] = c * y - sine * vector[1][1][i];
      vector[2][0][i] = c * z - sine * vector[2][1][i];
      vector[0][1][i] = sine * x + c * vector[0][1][i];
      vector[1][1][i] = sine * y + c * vector[1][1][i];
      vector[2][1][i] = sine * z + c * vector[2][1][i];
    }
  }

  /** r += v n x n with n = (x, y, z). */
  MPM_INLINE void add_dyad(Sym &r, double x, double y, double z, double v)
  {
    r.xx += v * x * x;
    r.yy += v * y * y;
    r.zz += v * z * z;
    r.xy += v * x * y;
    r.xz += v * x * z;
    r.yz += v * y * z;
  }

  /** Equal values give a multiple of the identity to the last digit. */
  MPM_INLINE Sym Spectral::recompose(int i, double value0, double value1, double value2) const
  {
    Sym r = {value2, value2, value2, 0.0, 0.0, 0.0};
    add_dyad(r, vector[0][0][i], vector[1][0][i], vector[2][0][i], value0 - value2);
    add_dyad(r, vector[0][1][i], vector[1][1][i], vector[2][1][i], value1 - value2);
    return r;
  }

  /** Principal logarithmic strain from a principal value of b - I. */
  MPM_INLINE double log_strain(double value)
  {
    return 0.5 * log1p(max(value, -1.0 + 1e-15));
  }

  /** f b f^T with f = I + A of this step: the left Cauchy-Green tensor b (or its elastic part, as
   *  trial state) after the motion of the step. It is exact and objective. */
  MPM_INLINE Sym push_forward(const Batch &batch, int i, const Sym &b)
  {
    const double f[9] = {1.0 + batch.A[0][i], batch.A[1][i],       batch.A[2][i],
                         batch.A[3][i],       1.0 + batch.A[4][i], batch.A[5][i],
                         batch.A[6][i],       batch.A[7][i],       1.0 + batch.A[8][i]};
    return congruence(f, b);
  }

  // Logarithm and exponential of symmetric tensors, a batch at a time. Near the identity, where the
  // elastic strains of solids lie, they are polynomials of the tensor: whole laws are several times
  // faster this way than with principal axes.

  /** c g(c) for a polynomial g; coefficients from the highest power down. By the theorem of Cayley
   *  and Hamilton, c^3 = I1 c^2 - I2 c + I3, so that Horner's scheme needs only three numbers: the
   *  factors of I, c, and c^2. */
  template <int N> MPM_INLINE Sym tensor_polynomial(const double (&g)[N], const Sym &c)
  {
    const double I1 = trace(c), I2 = minors(c), I3 = determinant(c);
    double k0 = g[0], k1 = 0.0, k2 = 0.0;    // of I, c, c^2
    // loops over points vectorize only when no inner loop is left
#pragma GCC unroll 32
    for (int n = 1; n <= N; n++) {
      const double highest = k2;
      k2 = k1 + I1 * highest;
      k1 = k0 - I2 * highest;
      k0 = I3 * highest + (n < N ? g[n] : 0.0);
    }
    return add_diagonal(k1 * c + k2 * square(c), k0);
  }

  // Chebyshev fits of log(1 + x)/(2 x) and (exp(x) - 1)/x made with mpmath (chebyfit); their error
  // is below 5e-17 up to these norms
  constexpr double HALF_LOG_RANGE = 0.2, EXP_RANGE = 0.5;
  constexpr double HALF_LOG[] = {-0.036101456703228674,
                                 0.03846750749568118,
                                 -0.035389973540378664,
                                 0.038118382286119565,
                                 -0.04167779328733498,
                                 0.045466317670629836,
                                 -0.04999978976150806,
                                 0.05555533312825894,
                                 -0.06250000215062684,
                                 0.0714285737038226,
                                 -0.08333333332255015,
                                 0.09999999998859213,
                                 -0.12500000000002057,
                                 0.16666666666668842,
                                 -0.25,
                                 0.5};
  constexpr double EXP_MINUS_ONE[] = {2.0962955815976076e-09,
                                      2.517282043357941e-08,
                                      2.7557076636642725e-07,
                                      2.7556979476271894e-06,
                                      2.4801587616145414e-05,
                                      0.00019841270281832442,
                                      0.001388888888870455,
                                      0.008333333333075146,
                                      0.04166666666666706,
                                      0.1666666666666722,
                                      0.5,
                                      1.0};

  /** f(c) for the points of a batch: by the polynomial c g(c) where the norm of c is at most range,
   *  by principal axes elsewhere. c and out may be the same. */
  template <int N, class Function>
  MPM_INLINE void tensor_function(int n, const double (&g)[N], double range, Function f,
                                  const double (*c)[BATCH], double (*out)[BATCH])
  {
    Tensors far;
    double nfar = 0.0;
    MPM_SIMD_SUM(nfar)
    for (int i = 0; i < n; i++) {
      const Sym x = load_rows(c, i);
      // not a number counts as far, too
      nfar += norm2(x) <= range * range ? 0.0 : 1.0;
      store_rows(far.row, i, x);
      store_rows(out, i, tensor_polynomial(g, x));
    }
    if (nfar == 0.0) return;
    const Spectral s(n, far.row);
    MPM_SIMD
    for (int i = 0; i < n; i++) {
      const Sym near = load_rows(out, i);
      const Sym exact = s.recompose(i, f(s.value[0][i]), f(s.value[1][i]), f(s.value[2][i]));
      const bool is_near = norm2(load_rows(far.row, i)) <= range * range;
      store_rows(out, i,
                 {is_near ? near.xx : exact.xx, is_near ? near.yy : exact.yy,
                  is_near ? near.zz : exact.zz, is_near ? near.xy : exact.xy,
                  is_near ? near.xz : exact.xz, is_near ? near.yz : exact.yz});
    }
  }

  /** Logarithmic strains ln(I + c)/2 of the points of a batch; c and strain may be the same. */
  MPM_INLINE void log_strains(int n, const double (*c)[BATCH], double (*strain)[BATCH])
  {
    tensor_function(
        n, HALF_LOG, HALF_LOG_RANGE,
        [](double x) {
          return log_strain(x);
        },
        c, strain);
  }

  /** exp(x) - I for the points of a batch; x and out may be the same. */
  MPM_INLINE void exp_minus_identity(int n, const double (*x)[BATCH], double (*out)[BATCH])
  {
    tensor_function(
        n, EXP_MINUS_ONE, EXP_RANGE,
        [](double value) {
          return expm1(value);
        },
        x, out);
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

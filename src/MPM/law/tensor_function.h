/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_TENSOR_FUNCTION_H
#define MPM_LAW_TENSOR_FUNCTION_H

// Logarithm and exponential of symmetric tensors, a batch at a time. Near the identity, where the
// elastic strains of solids lie, they are computed as polynomials of the tensor. Whole laws are
// several times faster this way than with principal axes.

#include "law/spectral.h"

namespace MPM_NS::law {
namespace {

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

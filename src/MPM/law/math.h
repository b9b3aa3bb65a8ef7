/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_LAW_MATH_H
#define MPM_LAW_MATH_H

// Elementary functions without branches and library calls, so that loops over them vectorize.
// The polynomials are Chebyshev fits made with mpmath (chebyfit); their error is below 2e-17.

#include "law/law.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace MPM_NS::law {
namespace {

  MPM_INLINE uint64_t to_bits(double x)
  {
    uint64_t u;
    memcpy(&u, &x, sizeof(u));
    return u;
  }

  MPM_INLINE double from_bits(uint64_t u)
  {
    double x;
    memcpy(&x, &u, sizeof(x));
    return x;
  }

  /** Larger of two numbers; b if either is not a number. */
  MPM_INLINE double max(double a, double b)
  {
    return a > b ? a : b;
  }

  MPM_INLINE double min(double a, double b)
  {
    return a < b ? a : b;
  }

  /** Polynomial of x by Horner's scheme; coefficients from the highest power down. */
  template <class... Rest> MPM_INLINE double polynomial(double x, double first, Rest... rest)
  {
    double sum = first;
    ((sum = sum * x + rest), ...);
    return sum;
  }

  /** x = 2^k (1 + f) with 1 + f between sqrt(1/2) and sqrt(2), and log(1 + f) = 2 s + tail. */
  struct LogParts {
    double k, f, s, tail;
  };

  MPM_INLINE LogParts log_parts(double x)
  {
    constexpr uint64_t SQRT_HALF = 0x3fe6a09e667f3bcd;
    constexpr uint64_t MANTISSA = 0x000fffffffffffff;
    constexpr uint64_t TWO52 =
        0x4330000000000000;    // 2^52: an integer in the low bits of a double
    const uint64_t u = to_bits(x) + (0x3ff0000000000000 - SQRT_HALF);
    LogParts p;
    p.k = from_bits((u >> 52) | TWO52) - (4503599627370496.0 + 1023.0);
    p.f = from_bits((u & MANTISSA) + SQRT_HALF) - 1.0;
    p.s = p.f / (2.0 + p.f);
    const double z = p.s * p.s;    // log(1 + f) = 2 atanh(s)
    const double g = polynomial(z, 0.073082248425217029, 0.076658608002780206, 0.090914445626308610,
                                0.111111055673975399, 0.142857143129877425, 0.199999999999497522,
                                0.333333333333333485);
    p.tail = 2.0 * p.s * z * g;
    return p;
  }

  /** Natural logarithm of a normal positive number, to 2 ulp. */
  MPM_INLINE double log(double x)
  {
    const LogParts p = log_parts(x);
    return p.k * 0.69314718055994530942 + (2.0 * p.s + p.tail);
  }

  /** log(1 + x) without cancellation near x = 0. */
  MPM_INLINE double log1p(double x)
  {
    const double u = 1.0 + x;
    return log(u) + (x - (u - 1.0)) / u;
  }

  /** x - 1 - log(x) without cancellation near x = 1. */
  MPM_INLINE double minus1_minus_log(double x)
  {
    const LogParts p = log_parts(x);
    const double near = p.f * p.s - p.tail;
    return p.k == 0.0 ? near : (x - 1.0) - (p.k * 0.69314718055994530942 + (2.0 * p.s + p.tail));
  }

  /** exp(x) = scale (1 + rest), rest = r + tail; x is clamped to [-708, 708]. */
  struct ExpParts {
    double scale, rest, tail;
  };

  MPM_INLINE ExpParts exp_parts(double x)
  {
    constexpr double ROUND = 6755399441055744.0;    // 1.5 * 2^52: adding it rounds to an integer
    x = max(min(x, 708.0), -708.0);
    const double t = x * 1.44269504088896340736 + ROUND;
    const double k = t - ROUND;
    const double r = (x - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10;
    const double h = polynomial(r, 2.5100385495510319e-8, 2.7620088445409748e-7,
                                2.7557268459997065e-6, 2.4801521295954375e-5, 1.9841269863053617e-4,
                                1.3888888917213717e-3, 8.3333333333300618e-3, 4.1666666666624128e-2,
                                1.6666666666666667e-1, 5.0000000000000010e-1);
    ExpParts p;
    p.scale = from_bits((to_bits(t) << 52) + 0x3ff0000000000000);
    p.tail = r * r * h;
    p.rest = r + p.tail;
    return p;
  }

  /** Exponential, to 2 ulp. */
  MPM_INLINE double exp(double x)
  {
    const ExpParts p = exp_parts(x);
    return p.scale + p.scale * p.rest;
  }

  /** Exponential of a number below 700 by linear interpolation between powers of two; at most 7
   *  percent too large. */
  MPM_INLINE double rough_exp(double x)
  {
    constexpr double SHIFT = 1.5 * 1048576.0 + 1023.0;    // leaves 32 bits behind the point
    return from_bits(to_bits(max(x, -700.0) * 1.44269504088896340736 + SHIFT) << 20);
  }

  /** exp(x) - 1 without cancellation near x = 0. */
  MPM_INLINE double expm1(double x)
  {
    const ExpParts p = exp_parts(x);
    return p.scale * p.rest + (p.scale - 1.0);
  }

  /** exp(x) - 1 - x without cancellation near x = 0. */
  MPM_INLINE double expm1_minus(double x)
  {
    const ExpParts p = exp_parts(x);
    return p.scale == 1.0 ? p.tail : p.scale * p.rest + (p.scale - 1.0) - x;
  }

  /** Sine for |x| <= pi/2, by its Taylor series. */
  MPM_INLINE double sin(double x)
  {
    const double z = -x * x;
    const double h =
        polynomial(z, 1.0 / 51090942171709440000.0, 1.0 / 121645100408832000.0,
                   1.0 / 355687428096000.0, 1.0 / 1307674368000.0, 1.0 / 6227020800.0,
                   1.0 / 39916800.0, 1.0 / 362880.0, 1.0 / 5040.0, 1.0 / 120.0, 1.0 / 6.0);
    return x + x * z * h;
  }

  /** x^y for x >= 0 and y > 0. */
  MPM_INLINE double pow(double x, double y)
  {
    const double p = exp(y * log(x));
    return x > 0.0 ? p : 0.0;
  }

}    // namespace
}    // namespace MPM_NS::law
#endif

/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_CPDI_H
#define MPM_TRANSFER_CPDI_H

#include "math/matrix.h"

namespace MPM_NS {

/** Domain of a point in convected particle domain interpolation: the image of a square or cube
 *  [-1,1]^DIM under the (bi- or tri-) linear map that has given corners.
 *
 *  Corner c has the coordinate sign(c, k) = -1, 1 along axis k, bit k of c. With the linear
 *  functions M_c of the corners and <.> the mean over the domain, a function N of the nodes is
 *  replaced inside of the domain by sum_c N(x_c) M_c, hence
 *
 *    N_ip = sum_c w_c N_i(x_c),   grad N_ip = sum_c g_c N_i(x_c),   w_c = <M_c>,   g_c = <grad M_c>
 *
 *  (A. Sadeghirad, R.M. Brannon, J. Burghardt, Int. J. Numer. Methods Eng. 86 (2011) 1435 for
 *  parallelograms; A. Sadeghirad, R.M. Brannon, J.E. Guilkey, ibid. 95 (2013) 928 for domains with
 *  free corners). Sum w_c = 1, sum g_c = 0, and sum x_c g_c = I, so that linear fields are exact.
 *  Domains may be degenerate: with coinciding corners the functions of these add up to one linear
 *  function. So triangles are quadrilaterals (a, b, c, c), tetrahedra and other bodies hexahedra
 *  (a, b, c, c, d, d, d, d).
 *
 *  As in transfer/shape.h functions take numbers or vectors of points T, and must be inlined.
 */
template <int DIM> struct PointDomain {
  static constexpr int corners = 1 << DIM;
  static constexpr double sign(int c, int axis) { return (c >> axis & 1) ? 1.0 : -1.0; }

  /** Half edges r[DIM*k+d] of a parallelogram or parallelepiped to corners x[DIM*c+d] relative to
   *  the center, and g[DIM*c+d]; all w_c are 1/corners. Returns the size (area, volume). */
  template <class T> [[gnu::always_inline]] static T box(const T *r, T *x, T *g)
  {
    T dual[DIM * DIM], det;
    if constexpr (DIM == 2) {
      det = r[0] * r[3] - r[1] * r[2];
      dual[0] = r[3], dual[1] = -r[2];
      dual[2] = -r[1], dual[3] = r[0];
    } else {
      for (int k = 0; k < 3; k++) cross(r + 3 * ((k + 1) % 3), r + 3 * ((k + 2) % 3), dual + 3 * k);
      det = dot(r, dual);
    }
    const T factor = (T{} + 1.0 / corners) / det;
    for (T &a : dual) a = factor * a;
    for (int d = 0; d < DIM; d++) {
      signed_sums(r + d, x + d);
      signed_sums(dual + d, g + d);
    }
    return double(corners) * det;
  }

  /** Corners x[DIM*c+d], relative to any place, to w[c] and g[DIM*c+d]. Returns the size. */
  template <class T> [[gnu::always_inline]] static T free(const T *x, T *w, T *g)
  {
    if constexpr (DIM == 2)
      return quadrilateral(x, w, g);
    else
      return hexahedron(x, w, g);
  }

  /** Number of components of a symmetric matrix (xx yy xy, xx yy zz xy xz yz), and the index of its
   *  component a, b. */
  static constexpr int symmetric = DIM * (DIM + 1) / 2;
  static constexpr int component(int a, int b) { return a == b ? a : a + b + DIM - 1; }

  template <class T> [[gnu::always_inline]] static void invert_symmetric(const T *m, T *inverse)
  {
    if constexpr (DIM == 2) {
      const T factor = (T{} + 1.0) / (m[0] * m[1] - m[2] * m[2]);
      inverse[0] = factor * m[1], inverse[1] = factor * m[0];
      inverse[2] = -(factor * m[2]);
    } else {
      T c[6] = {m[1] * m[2] - m[5] * m[5], m[0] * m[2] - m[4] * m[4], m[0] * m[1] - m[3] * m[3],
                m[4] * m[5] - m[3] * m[2], m[3] * m[5] - m[4] * m[1], m[3] * m[4] - m[0] * m[5]};
      const T factor = (T{} + 1.0) / (m[0] * c[0] + m[3] * c[3] + m[4] * c[4]);
      for (int k = 0; k < 6; k++) inverse[k] = factor * c[k];
    }
  }

 private:
  /** sum[DIM*c] = sum over axes k of sign(c,k) a[DIM*k]; opposite corners have opposite sums. */
  template <class T> [[gnu::always_inline]] static void signed_sums(const T *a, T *sum)
  {
    const T plus = a[0] + a[DIM], minus = a[0] - a[DIM];
    if constexpr (DIM == 2) {
      sum[2 * DIM] = -minus;
      sum[3 * DIM] = plus;
      sum[DIM] = minus;
      sum[0] = -plus;
    } else {
      sum[4 * DIM] = a[2 * DIM] - plus;
      sum[5 * DIM] = a[2 * DIM] + minus;
      sum[6 * DIM] = a[2 * DIM] - minus;
      sum[7 * DIM] = a[2 * DIM] + plus;
      for (int c = 0; c < 4; c++) sum[c * DIM] = -sum[(7 - c) * DIM];
    }
  }
  /** x = m + a xi + b eta + c xi eta has the Jacobian a x b + xi a x c + eta c x b, the area
   *  4 a x b, and w_c = (1 + [s_0 a x c + s_1 c x b]/[3 a x b])/4. The sum of area g_c is the
   *  derivative of the area with respect to x_c. */
  template <class T> [[gnu::always_inline]] static T quadrilateral(const T *x, T *w, T *g)
  {
    T a[2], b[2], c[2];
    for (int d = 0; d < 2; d++) {
      const T s = x[6 + d] - x[d], t = x[4 + d] - x[2 + d];    // diagonals
      a[d] = 0.25 * (s - t);
      b[d] = 0.25 * (s + t);
      c[d] = 0.25 * ((x[d] + x[6 + d]) - (x[2 + d] + x[4 + d]));
    }
    const T J = a[0] * b[1] - a[1] * b[0], inv = (T{} + 0.25) / J;
    const T J0 = (1.0 / 3.0) * inv * (a[0] * c[1] - a[1] * c[0]);
    const T J1 = (1.0 / 3.0) * inv * (c[0] * b[1] - c[1] * b[0]);
    for (int k = 0; k < 4; k++) {
      const double s0 = sign(k, 0), s1 = sign(k, 1);
      w[k] = 0.25 + s0 * J0 + s1 * J1;
      g[2 * k] = inv * (s0 * b[1] - s1 * a[1]);
      g[2 * k + 1] = inv * (s1 * a[0] - s0 * b[0]);
    }
    return 4.0 * J;
  }

  /** Sum and difference of the numbers of corners along one axis. */
  template <int BIT, class T> [[gnu::always_inline]] static void to_modes(T *mode)
  {
    for (int c = 0; c < 8; c++)
      for (int d = 0; d < 3 && !(c & BIT); d++) {
        const T low = mode[3 * c + d], high = mode[3 * (c + BIT) + d];
        mode[3 * c + d] = low + high;
        mode[3 * (c + BIT) + d] = high - low;
      }
  }
  /** The inverse: sums of the values of modes with the signs of the corners. */
  template <int BIT, int WIDTH, class T> [[gnu::always_inline]] static void to_corners(T *corner)
  {
    for (int c = 0; c < 8; c++)
      for (int d = 0; d < WIDTH && !(c & BIT); d++) {
        const T even = corner[WIDTH * c + d], odd = corner[WIDTH * (c + BIT) + d];
        corner[WIDTH * c + d] = even - odd;
        corner[WIDTH * (c + BIT) + d] = even + odd;
      }
  }

  /** a x b + c x d */
  template <class T>
  [[gnu::always_inline]] static void crosses(const T *a, const T *b, const T *c, const T *d, T *sum)
  {
    T first[3], second[3];
    cross(a, b, first);
    cross(c, d, second);
    for (int k = 0; k < 3; k++) sum[k] = first[k] + second[k];
  }

  /** The map is x = .. + a xi + b eta + c zeta + d eta zeta + e zeta xi + f xi eta + g xi eta zeta.
   *  Along axis k, J grad M_c = sum_k M_c,k (x,k+1 x x,k+2) with the columns x,k of the map's
   *  gradient, and J is their triple product. Odd powers of a coordinate have no mean, even ones
   *  1/3. */
  template <class T> [[gnu::always_inline]] static T hexahedron(const T *x, T *w, T *grad)
  {
    // coefficients of 1, xi, eta, xi eta, zeta, xi zeta, ...: bits of the number are the powers
    T mode[24];
    for (int k = 0; k < 8; k++)
      for (int i = 0; i < 3; i++) mode[3 * k + i] = 0.125 * x[3 * k + i];
    to_modes<1>(mode), to_modes<2>(mode), to_modes<4>(mode);
    const T *a = mode + 3, *b = mode + 6, *f = mode + 9, *c = mode + 12, *e = mode + 15,
            *d = mode + 18, *g = mode + 21;

    T ab[3], bc[3], ca[3], fe[3], df[3], ed[3], xy[3], zx[3], yz[3];
    cross(a, b, ab), cross(b, c, bc), cross(c, a, ca);
    cross(f, e, fe), cross(d, f, df), cross(e, d, ed);
    crosses(b, d, e, a, xy), crosses(d, c, a, f, zx), crosses(c, e, f, b, yz);

    // means of J times powers, and of cofactors times the derivatives of powers
    constexpr double third = 1.0 / 3.0, ninth = 1.0 / 9.0, n27 = 1.0 / 27.0;
    T moment[8], flux[24];
    moment[0] = dot(a, bc) + third * (dot(a, fe) + dot(b, df) + dot(c, ed));
    moment[1] = third * (dot(e, ab) + dot(f, ca)) + ninth * dot(g, yz);
    moment[2] = third * (dot(d, ab) + dot(f, bc)) + ninth * dot(g, zx);
    moment[4] = third * (dot(d, ca) + dot(e, bc)) + ninth * dot(g, xy);
    moment[3] = ninth * (dot(g, ab) - dot(a, df) - dot(b, fe)) - n27 * dot(g, ed);
    moment[5] = ninth * (dot(g, ca) - dot(a, ed) - dot(c, fe)) - n27 * dot(g, df);
    moment[6] = ninth * (dot(g, bc) - dot(b, ed) - dot(c, df)) - n27 * dot(g, fe);
    moment[7] = (-2.0 * n27) * dot(d, fe);
    for (int k = 0; k < 3; k++) {
      flux[k] = flux[21 + k] = T{};
      flux[3 + k] = bc[k] + third * fe[k];
      flux[6 + k] = ca[k] + third * df[k];
      flux[12 + k] = ab[k] + third * ed[k];
      flux[9 + k] = third * xy[k];
      flux[15 + k] = third * zx[k];
      flux[18 + k] = third * yz[k];
    }

    // M_c = sum over powers of the product of signs, / 8
    const T inv = (T{} + 0.125) / moment[0];
    for (int k = 0; k < 8; k++) {
      w[k] = inv * moment[k];
      for (int i = 0; i < 3; i++) grad[3 * k + i] = inv * flux[3 * k + i];
    }
    to_corners<1, 1>(w), to_corners<2, 1>(w), to_corners<4, 1>(w);
    to_corners<1, 3>(grad), to_corners<2, 3>(grad), to_corners<4, 3>(grad);
    return 8.0 * moment[0];
  }
};

}    // namespace MPM_NS
#endif

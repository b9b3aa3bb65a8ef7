/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_DOMAIN_H
#define LMP_MPM_DOMAIN_H

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
 *  As in mpm_shape.h functions take numbers or vectors of points T, and must be inlined.
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
    for (int c = 0; c < corners; c++)
      for (int d = 0; d < DIM; d++) {
        T a = sign(c, 0) * r[d], b = sign(c, 0) * dual[d];
        for (int k = 1; k < DIM; k++) {
          a = a + sign(c, k) * r[DIM * k + d];
          b = b + sign(c, k) * dual[DIM * k + d];
        }
        x[DIM * c + d] = a;
        g[DIM * c + d] = factor * b;
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

 private:
  template <class T> [[gnu::always_inline]] static void cross(const T *a, const T *b, T *c)
  {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
  }
  template <class T> [[gnu::always_inline]] static T dot(const T *a, const T *b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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

  /** The product of the coordinates whose bit is set in m. */
  [[gnu::always_inline]] static double power(int m, const double *at)
  {
    return ((m & 1) ? at[0] : 1.0) * ((m & 2) ? at[1] : 1.0) * ((m & 4) ? at[2] : 1.0);
  }

  /** By two Gauss points along each axis, which are exact: with the columns x,k of the map's
   *  gradient, J grad M_c = sum_k M_c,k (x,k+1 x x,k+2), and integrands are cubic along each axis. */
  template <class T> [[gnu::always_inline]] static T hexahedron(const T *x, T *w, T *g)
  {
    constexpr double GAUSS = 0.57735026918962576451;

    // coefficients of 1, xi, eta, xi eta, zeta, xi zeta, ...: bits of the number are the powers
    T mode[24];
    for (int k = 0; k < 24; k++) mode[k] = 0.125 * x[k];
    for (int bit = 1; bit < 8; bit *= 2)
      for (int c = 0; c < 8; c++)
        if (!(c & bit))
          for (int d = 0; d < 3; d++) {
            const T low = mode[3 * c + d], high = mode[3 * (c + bit) + d];
            mode[3 * c + d] = low + high;
            mode[3 * (c + bit) + d] = high - low;
          }

    // integrals of J times these powers; of cofactors times those of their derivatives
    T moment[8], flux[24];
    for (T &m : moment) m = T{};
    for (T &f : flux) f = T{};
    for (int q = 0; q < 8; q++) {
      const double at[3] = {GAUSS * sign(q, 0), GAUSS * sign(q, 1), GAUSS * sign(q, 2)};
      T column[9], cofactor[9];
      for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3, K = 1 << k, I = 1 << i, B = 1 << j;
        for (int d = 0; d < 3; d++)
          column[3 * k + d] = mode[3 * K + d] + at[i] * mode[3 * (K + I) + d] +
              at[j] * mode[3 * (K + B) + d] + (at[i] * at[j]) * mode[21 + d];
      }
      for (int k = 0; k < 3; k++)
        cross(column + 3 * ((k + 1) % 3), column + 3 * ((k + 2) % 3), cofactor + 3 * k);
      const T J = dot(column, cofactor);
      for (int m = 0; m < 8; m++) {
        moment[m] = moment[m] + power(m, at) * J;
        for (int k = 0; k < 3; k++)    // d power / d xi_k
          if (m >> k & 1)
            for (int d = 0; d < 3; d++)
              flux[3 * m + d] = flux[3 * m + d] + power(m - (1 << k), at) * cofactor[3 * k + d];
      }
    }

    // M_c = sum over powers of the product of signs, / 8
    const T volume = moment[0], inv = (T{} + 0.125) / volume;
    for (int c = 0; c < 8; c++) {
      w[c] = inv * moment[c];
      for (int d = 0; d < 3; d++) g[3 * c + d] = inv * flux[3 * c + d];
    }
    for (int bit = 1; bit < 8; bit *= 2)
      for (int c = 0; c < 8; c++)
        if (!(c & bit)) {
          const T low = w[c], high = w[c + bit];
          w[c] = low - high;
          w[c + bit] = low + high;
          for (int d = 0; d < 3; d++) {
            const T l = g[3 * c + d], h = g[3 * (c + bit) + d];
            g[3 * c + d] = l - h;
            g[3 * (c + bit) + d] = l + h;
          }
        }
    return volume;
  }
};

}    // namespace MPM_NS
#endif

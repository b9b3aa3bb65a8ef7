/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TRANSFER_BERNSTEIN_H
#define MPM_TRANSFER_BERNSTEIN_H

namespace MPM_NS {

/** Quadratic Bernstein polynomials along one axis (V.P. Nguyen, A. de Vaucorbeil, S. Bordas, The
 *  Material Point Method, Springer 2023). A cell has two node spacings, from an even node over an
 *  odd one to the next even one, and these are the nodes that its points reach: the base node is
 *  2 floor(x/2), and the fraction f = x/2 - floor(x/2). The functions are not negative and sum to
 *  one; with the nodes as control points, sum w_i x_i = x. Gradients jump from cell to cell. Members
 *  are those of BSpline; the second moment depends on the position. */
struct Bernstein {
  static constexpr int order = 2, nodes = 3;
  static constexpr int cell = 2;
  static constexpr double shift = 0.0, inv_moment = 0.0;
  static constexpr bool has_size = false, has_domain = false;

  template <class T> [[gnu::always_inline]] static constexpr void weights(const T &f, T *w)
  {
    const T g = 1.0 - f;
    w[0] = g * g;
    w[1] = 2.0 * f * g;
    w[2] = f * f;
  }

  /** Derivatives with respect to the position in node spacings. */
  template <class T> [[gnu::always_inline]] static constexpr void gradients(const T &f, T *dw)
  {
    dw[0] = f - 1.0;
    dw[1] = 1.0 - 2.0 * f;
    dw[2] = f;
  }
};

}    // namespace MPM_NS
#endif
